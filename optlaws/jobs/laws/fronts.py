"""The job "fronts": exchanges between two constants, tabled and drawn beside known laws and limits."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec

from optlaws.errors import InputError
from optlaws.files import tables, writing
from optlaws.files.problem_file import convert
from optlaws.jobs.laws.beside_fronts import check_beside
from optlaws.jobs.laws.figure_fronts import draw
from optlaws.studies.points.problem_entries import Asked, Text, gap, problem
from optlaws.synthesis.front import HEADINGS, Front
from optlaws.synthesis.pareto import pareto_front

Points = Annotated[int, msgspec.Meta(ge=2, le=1000)]
Positive = Annotated[float, msgspec.Meta(gt=0.0, le=1e100)]
Pair = Annotated[list[Positive], msgspec.Meta(min_length=2, max_length=2)]
Constant = Literal["B", "C", "D", "J"]

_FEW = 5


class Curve(Asked, kw_only=True, forbid_unknown_fields=True):
    """One front: what its problem asks beyond the base problem, and its name in the legend."""

    label: Text
    points: Points | None = None
    between: Pair | None = None


class Picture(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """One figure: the constants exchanged, its fronts, what stands beside them, and the ranges of the axes."""

    name: Annotated[str, msgspec.Meta(pattern="^[a-z0-9-]+$")]
    title: Text
    over: Annotated[list[Constant], msgspec.Meta(min_length=2, max_length=2)]
    front: Annotated[list[Curve], msgspec.Meta(min_length=1, max_length=5)]
    between: Pair | None = None
    points: Points | None = None
    catalogue: list[Text] = []
    limits: bool = True
    x: Pair | None = None
    y: Pair | None = None


class Study(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """The problem file."""

    job: str
    title: Text
    problem: Asked
    figure: Annotated[list[Picture], msgspec.Meta(min_length=1)]
    points: Points = 50
    text: str = ""


Fronts = list[tuple[Picture, list[Front]]]


def run(data: Mapping[str, Any], file: Path, out: Path) -> list[Path]:
    """Do the job and return the files written."""
    spec = convert(data, Study, file)
    names = [picture.name for picture in spec.figure]
    if len(set(names)) != len(names):
        raise InputError(f"figure: names must differ, got {', '.join(names)}")
    for picture in spec.figure:
        check_beside(picture)
    found: Fronts = [(picture, [_front(spec, picture, one) for one in picture.front]) for picture in spec.figure]
    about = f"{spec.title}; from {file.name}"
    lines = [
        [picture.name, *line]
        for picture, fronts in found
        for curve, front in zip(picture.front, fronts, strict=True)
        for line in _lines(curve, front)
    ]
    written = [
        writing.write(out / "fronts.csv", tables.to_csv(("figure", "front", *HEADINGS), lines, about=about)),
        writing.write(out / "fronts.md", _markdown(spec, found)),
        writing.write(out / "fronts.json", _json(about, found)),
    ]
    for picture, fronts in found:
        drawing = draw(picture, fronts)
        written += [writing.write(out / f"{picture.name}.{kind}", content) for kind, content in drawing.items()]
    return written


def _front(spec: Study, picture: Picture, curve: Curve) -> Front:
    where = f"figure {picture.name}, {curve.label}"
    asked = problem(where, spec.problem.given(), curve.given())
    between = curve.between or picture.between
    points = curve.points or picture.points or spec.points
    try:
        pair = (between[0], between[1]) if between else None
        return pareto_front(asked, tuple(picture.over), points=points, between=pair)
    except InputError as error:
        raise InputError(f"{where}: {error}") from None


def _lines(curve: Curve, front: Front) -> list[list[tables.Cell]]:
    return [[curve.label, *row[:5], gap(point), *row[6:]] for row, point in zip(front.rows, front, strict=True)]


def _markdown(spec: Study, found: Fronts) -> str:
    text = [f"# {spec.title}", "", f"<!-- {writing.MARK} -->", ""]
    if spec.text.strip():
        text += [spec.text.strip(), ""]
    for picture, fronts in found:
        few = []
        for curve, front in zip(picture.front, fronts, strict=True):
            lines = _lines(curve, front)
            last = len(lines) - 1
            few += [lines[i] for i in sorted({round(last * step / (_FEW - 1)) for step in range(_FEW)})]
        table = tables.to_markdown(("front", *HEADINGS), few)
        text += [f"## {picture.title}", "", f"![{picture.title}]({picture.name}.svg)", "", table]
    return "\n".join(text)


def _json(about: str, found: Fronts) -> str:
    fronts = []
    for picture, some in found:
        for curve, front in zip(picture.front, some, strict=True):
            head = json.dumps({"figure": picture.name, "front": curve.label, "over": list(front.over)})
            points = ",\n".join(
                json.dumps(
                    {
                        "problem": point.problem.to_dict(),
                        "values": values,
                        "lower_bound": point.lower_bound,
                        "status": point.status.value,
                        "z": None if point.z_powers is None else list(point.z_powers),
                    }
                )
                for point, values in zip(front, front.values.tolist(), strict=True)
            )
            fronts.append(f'{head[:-1]}, "points": [\n{points}\n]}}')
    top = json.dumps({"about": f"{about}; {writing.MARK}"})[:-1]
    return f'{top}, "fronts": [\n' + ",\n".join(fronts) + "\n]}\n"
