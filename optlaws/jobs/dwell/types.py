"""The job "dwell types": criteria, ways and tooth counts of the three types over the dwell, nomograms and a map."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from math import degrees
from pathlib import Path
from typing import Any

from optlaws.files import tables, writing
from optlaws.files.problem_file import convert
from optlaws.jobs.dwell import figure_map, figure_types
from optlaws.jobs.dwell.cases import Case, Types
from optlaws.laws.catalogue.catalogue import catalogue
from optlaws.mechanisms.dwell.clutch import Clutch

GIVEN = ("scenario", "swing", "clutch angle", "dwell", "rise")
CRITERIA = ("a I", "a II", "a III", "b II", "b III", "S1 I", "S2 II", "S2 III")
TEETH = ("type", "scenario", "swing", "clutch angle", "dwell", "p/N", "N for p = 1", "nearest p", "N", "off by")


def run(data: Mapping[str, Any], file: Path, out: Path) -> list[Path]:
    """Do the job and return the files written."""
    spec = convert(data, Types, file)
    cases = list(_cases(spec))
    about = f"{spec.title}; from {file.name}; angles in degrees"
    rows = [[*one.given, *_criteria(one)] for one in cases]
    teeth = [row for one in cases for row in _teeth(one, spec.teeth)]
    drawings = {
        "size_of_type_I": figure_types.draw_first(spec),
        "nomograms": figure_types.draw_all(spec),
        "map": figure_map.draw(catalogue[spec.law].law, spec.map.limits, spec.map.clutch_angles),
    }
    return [
        writing.write(out / "criteria.csv", tables.to_csv((*GIVEN, *CRITERIA), rows, about=about)),
        writing.write(out / "teeth.csv", tables.to_csv(TEETH, teeth, about=about)),
        writing.write(out / "dwell_types.md", _markdown(spec, rows, teeth)),
        *(
            writing.write(out / f"{name}.{kind}", content)
            for name, drawing in drawings.items()
            for kind, content in drawing.items()
        ),
    ]


def _cases(spec: Types) -> Iterator[Case]:
    for scenario, swing, clutch, dwell in product(spec.scenario, spec.swings, spec.clutch_angles, spec.dwells):
        types = spec.types(scenario, swing, clutch, dwell)
        yield Case(scenario.name, swing, clutch, dwell, scenario.angle(dwell), types)


def _criteria(one: Case) -> list[tables.Cell]:
    wanted = [name.split() for name in CRITERIA]
    return [getattr(one.types[kind], name) if kind in one.types else None for name, kind in wanted]


def _teeth(one: Case, most: int) -> Iterator[list[tables.Cell]]:
    for kind in ("II", "III"):
        if kind in one.types:
            clutch = Clutch(one.types[kind])
            best = clutch.nearest(most)
            yield [kind, *one.given[:4], clutch.ratio, 1.0 / clutch.ratio, best.p, best.N, degrees(best.error)]


def _markdown(spec: Types, rows: Sequence[Sequence[tables.Cell]], teeth: Sequence[Sequence[tables.Cell]]) -> str:
    said = (
        f"Law {spec.law} throughout; least radius {spec.radius_over_length:g} rocker lengths, inertia ratio "
        f"{spec.inertia_ratio:g} (b is proportional to it). Angles in degrees, ways in strokes of the executive link. "
        "b of type I is 0. A cell is empty where the clutch leaves no room."
    )
    pictures = (
        ("The cam of type I grows with the dwell", "size_of_type_I"),
        ("Criteria a and b of the three types", "nomograms"),
        ("The type with the smallest cam", "map"),
    )
    text = [f"# {spec.title}", "", f"<!-- {writing.MARK} -->", "", said, ""]
    for title, name in pictures:
        text += [f"![{title}]({name}.svg)", ""]
    text += ["## Criteria and ways", "", tables.to_markdown((*GIVEN, *CRITERIA), rows, digits=6)]
    text += [
        "## Tooth counts",
        "",
        f"The nearest p/N with at most {spec.teeth} teeth; the angle it is off in degrees.",
        "",
    ]
    return "\n".join([*text, tables.to_markdown(TEETH, teeth, digits=6)])
