"""The job "optimal polydyne": optimal and robust laws for elastic followers beside known ones, tabled and drawn."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec

from optlaws.errors import InputError
from optlaws.files import tables, writing
from optlaws.files.problem_file import convert
from optlaws.jobs.follower.figure_polydyne import draw
from optlaws.jobs.follower.polydyne_laws import Compared, Design, compared
from optlaws.studies.points.problem_entries import Text, gap
from optlaws.synthesis import Status

Positive = Annotated[float, msgspec.Meta(gt=0.0, le=1e3)]
Pair = Annotated[list[Positive], msgspec.Meta(min_length=2, max_length=2)]

HEADINGS = (
    "damping", "law", "B of the mass", "C of the mass", "B of the cam", "C of the cam", "D of the cam", "J of the cam",
    "lower bound of C", "gap", "status", "residual at nu", "greatest residual",
)  # fmt: skip


class Member(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """A member of one of Savin's families that a cam can be made from."""

    family: Literal["III", "IV"]
    alpha: float


class Study(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """The problem file."""

    job: str
    title: Text
    nu: Positive
    dampings: Annotated[list[Annotated[float, msgspec.Meta(ge=0.0, lt=1.0)]], msgspec.Meta(min_length=1, max_length=3)]
    between: Pair
    residual: Positive
    degree: Annotated[int, msgspec.Meta(ge=5, le=41)]
    member: Annotated[list[Member], msgspec.Meta(min_length=1, max_length=4)]
    catalogue: list[Text] = []
    figure: Pair
    text: str = ""


def run(data: Mapping[str, Any], file: Path, out: Path) -> list[Path]:
    """Do the job and return the files written."""
    spec = convert(data, Study, file)
    for name, (low, high) in (("between", spec.between), ("figure", spec.figure)):
        if not low < high:
            raise InputError(f"{name}: must be two frequencies in ascending order, got [{low:g}, {high:g}]")
    members = [(one.family, one.alpha) for one in spec.member]
    low, high = spec.between
    designs = [Design(spec.nu, one, (low, high), spec.residual, spec.degree) for one in spec.dampings]
    found = [list(compared(design, members, spec.catalogue)) for design in designs]
    lines = [_line(one) for laws in found for one in laws]
    about = f"{spec.title}; from {file.name}"
    written = [
        writing.write(out / "table.csv", tables.to_csv(HEADINGS, lines, about=about)),
        writing.write(out / "table.md", _markdown(spec, lines)),
    ]
    drawing = draw(spec.title, found, (spec.figure[0], spec.figure[1]))
    return written + [writing.write(out / f"figure.{kind}", content) for kind, content in drawing.items()]


def _line(one: Compared) -> list[tables.Cell]:
    mass, cam, solution = one.law.constants, one.cam.constants, one.solution
    bound: list[tables.Cell] = [None, None, None]
    if solution is not None:
        optimal = solution.status is Status.OPTIMAL
        bound = [solution.lower_bound, gap(solution), solution.status.value if not optimal else "optimal"]
    own: list[tables.Cell] = [mass.B.value, mass.C.value] if one.polydyne else [None, None]
    residuals = [0.0 if one.polydyne else one.at_design, one.worst]
    return [
        one.design.damping, one.name, *own, cam.B.value, cam.C.value, cam.D.value, cam.J.value, *bound, *residuals,
    ]  # fmt: skip


def _markdown(spec: Study, lines: list[list[tables.Cell]]) -> str:
    text = [spec.text.strip(), ""] if spec.text.strip() else []
    interval = f"Greatest residual over nu = {spec.between[0]:g} to {spec.between[1]:g}; nu = {spec.nu:g}."
    table = tables.to_markdown(HEADINGS, lines, digits=6)
    heading = [f"# {spec.title}", "", f"<!-- {writing.MARK} -->", ""]
    return "\n".join([*heading, *text, f"![{spec.title}](figure.svg)", "", interval, "", table])
