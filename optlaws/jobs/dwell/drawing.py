"""The job "dwell drawing": cams of the three types for one executive motion, and the motion of their rockers."""

from __future__ import annotations

from collections.abc import Mapping
from math import degrees
from pathlib import Path
from typing import Annotated, Any

import msgspec

from optlaws.files import tables, writing
from optlaws.files.problem_file import convert
from optlaws.jobs.dwell import figure_drawing
from optlaws.laws.catalogue.catalogue import catalogue
from optlaws.mechanisms.angles import deg
from optlaws.mechanisms.dwell.checks import KINDS
from optlaws.mechanisms.dwell.making import dwell_mechanism

HEADINGS = ("type", "section", "from", "to", "way")

Text = Annotated[str, msgspec.Meta(min_length=1)]
Positive = Annotated[float, msgspec.Meta(gt=0)]
Degrees = Annotated[float, msgspec.Meta(gt=0, lt=360)]


class Drawing(msgspec.Struct, forbid_unknown_fields=True):
    """The problem file; angles in degrees."""

    job: str
    title: Text
    law: Text
    rise: Degrees
    dwell: Degrees
    clutch_angle: Degrees
    swing: Degrees
    radius_ratio: Positive
    inertia_ratio: Positive


def run(data: Mapping[str, Any], file: Path, out: Path) -> list[Path]:
    """Do the job and return the files written."""
    spec = convert(data, Drawing, file)
    law = catalogue[spec.law].law
    types = {
        kind: dwell_mechanism(
            kind,
            law=law,
            dwell=deg(spec.dwell),
            rise=deg(spec.rise),
            clutch_angle=deg(spec.clutch_angle),
            swing=deg(spec.swing),
            radius_ratio=spec.radius_ratio,
            inertia_ratio=spec.inertia_ratio,
        )
        for kind in KINDS
    }
    rows: list[list[tables.Cell]] = []
    for kind, one in types.items():
        place = 0.0
        for section in one.sections:
            rows.append(
                [kind, section.name, degrees(place), degrees(place + section.angle), round(section.travel, 12) + 0.0]
            )
            place += section.angle
    drawings = {"mechanism": figure_drawing.draw_cams(types), "motion": figure_drawing.draw_motions(types)}
    said = "; ".join(f"{kind}: a = {one.a:.5g}, b = {one.b:.5g}" for kind, one in types.items())
    text = [f"# {spec.title}", "", f"<!-- {writing.MARK} -->", "", f"Law {spec.law}; {said}.", ""]
    text += ["![The cams](mechanism.svg)", "", "![The motions](motion.svg)", ""]
    text += ["Cam angles in degrees, ways of the rocker in strokes of the executive link.", ""]
    return [
        writing.write(out / "drawing.md", "\n".join([*text, tables.to_markdown(HEADINGS, rows)])),
        *(
            writing.write(out / f"{name}.{kind}", content)
            for name, drawing in drawings.items()
            for kind, content in drawing.items()
        ),
    ]
