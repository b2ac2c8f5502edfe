"""The job "lever nomogram": gamma01 and xi of the torsion lever over its swing and beta."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import degrees
from pathlib import Path
from typing import Annotated, Any

import msgspec
import numpy as np

from optlaws.errors import InputError
from optlaws.files import tables, writing
from optlaws.files.problem_file import convert
from optlaws.jobs.lever.cases import Length, Lengths, Swings, Text, Twist, levers
from optlaws.jobs.lever.figure_nomogram import draw
from optlaws.mechanisms.lever.lever import TorsionLever

HEADINGS = ("beta", "swing, deg", "chi01, deg", "chi02, deg", "gamma01, deg", "xi", "T", "exact T")


class Nomogram(msgspec.Struct, kw_only=True, forbid_unknown_fields=True, rename={"lam": "lambda"}):
    """The problem file; swings in degrees, `tabled` those of the table."""

    job: str
    title: Text
    beta: Annotated[Lengths, msgspec.Meta(max_length=12)]
    lam: Length
    rho: Twist
    nu: Twist
    tabled: Swings
    points: Annotated[int, msgspec.Meta(ge=2, le=1000)] = 81
    text: str = ""


def run(data: Mapping[str, Any], file: Path, out: Path) -> list[Path]:
    """Do the job and return the files written."""
    spec = convert(data, Nomogram, file)
    rows = [_row(one) for beta in spec.beta for swing in spec.tabled for one in _levers(spec, beta, [swing])]
    if not rows:
        raise InputError("no combination of beta and swing keeps to the limits")
    swings = np.linspace(min(spec.tabled), max(spec.tabled), spec.points).tolist()
    curves = {beta: found for beta in spec.beta if (found := _levers(spec, beta, swings))}
    about = f"{spec.title}; from {file.name}"
    drawing = draw(curves)
    return [
        writing.write(out / "nomogram.csv", tables.to_csv(HEADINGS, rows, about=about)),
        writing.write(out / "nomogram.md", _markdown(spec, rows)),
        *(writing.write(out / f"nomogram.{kind}", content) for kind, content in drawing.items()),
    ]


def _levers(spec: Nomogram, beta: float, swings: Sequence[float]) -> list[TorsionLever]:
    return [one for swing in swings for one in levers(beta, swing, [spec.lam], [spec.rho], [spec.nu])]


def _row(one: TorsionLever) -> list[tables.Cell]:
    motion = one.asymptotic
    angles = (one.swing, one.chi01, motion.chi02, one.gamma01)
    try:
        period = one.exact.period
    except InputError:  # the exact motion leaves the limits by a little
        period = None
    return [one.beta, *(round(degrees(angle), 9) for angle in angles), one.xi, motion.period, period]


def _markdown(spec: Nomogram, rows: Sequence[Sequence[tables.Cell]]) -> str:
    text = [f"# {spec.title}", "", f"<!-- {writing.MARK} -->", ""]
    if spec.text.strip():
        text += [spec.text.strip(), ""]
    held = f"lambda = {spec.lam:g}, rho = {spec.rho:g}, nu = {spec.nu:g}"
    text += ["![gamma01 and xi over swing and beta](nomogram.svg)", "", f"{held}; T in units of sqrt(I / c1).", ""]
    return "\n".join([*text, tables.to_markdown(HEADINGS, rows)])
