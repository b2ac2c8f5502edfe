"""The job "loader drawing": both cams of a mechanism with an inertial loader, and the energy they exchange."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any

import msgspec

from optlaws.files import tables, writing
from optlaws.files.problem_file import convert
from optlaws.jobs.loader import figure_drawing
from optlaws.laws.catalogue.catalogue import catalogue
from optlaws.mechanisms.angles import deg
from optlaws.mechanisms.loader.loader import loader

HEADINGS = ("link", "B", "C", "D", "J")

Text = Annotated[str, msgspec.Meta(min_length=1)]
Positive = Annotated[float, msgspec.Meta(gt=0)]


class Drawing(msgspec.Struct, forbid_unknown_fields=True):
    """The problem file; the angle shown in degrees."""

    job: str
    title: Text
    law: Text
    shown: Annotated[float, msgspec.Meta(ge=0, lt=360)]
    radius_ratio: Positive


def run(data: Mapping[str, Any], file: Path, out: Path) -> list[Path]:
    """Do the job and return the files written."""
    spec = convert(data, Drawing, file)
    one = loader(catalogue[spec.law].law)
    drawings = {
        "mechanism": figure_drawing.draw_mechanism(one, deg(spec.shown), spec.radius_ratio),
        "exchange": figure_drawing.draw_exchange(one, spec.title),
    }
    rows: list[list[tables.Cell]] = []
    for name, law in (("executive", one.executive), ("loader", one.law)):
        peaks = law.constants
        rows.append([name, peaks.B.value, peaks.C.value, peaks.D.value, peaks.J.value])
    text = [
        f"# {spec.title}",
        "",
        f"<!-- {writing.MARK} -->",
        "",
        f"Law {spec.law}, Y = {one.Y:.9g}.",
        "",
        "![Both cams](mechanism.svg)",
        "",
        "![What they exchange](exchange.svg)",
        "",
        tables.to_markdown(HEADINGS, rows),
    ]
    return [
        writing.write(out / "drawing.md", "\n".join(text)),
        *(
            writing.write(out / f"{name}.{kind}", content)
            for name, drawing in drawings.items()
            for kind, content in drawing.items()
        ),
    ]
