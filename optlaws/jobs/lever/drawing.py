"""The job "lever drawing": the torsion lever to scale, its moment and its motion."""

from __future__ import annotations

from collections.abc import Mapping
from math import degrees
from pathlib import Path
from typing import Any

import msgspec

from optlaws.files import tables, writing
from optlaws.files.problem_file import convert
from optlaws.jobs.lever import figure_mechanism, figure_motion
from optlaws.jobs.lever.cases import Degrees, Length, Text, Twist
from optlaws.mechanisms.angles import deg
from optlaws.mechanisms.lever.lever import TorsionLever

_ANGLES = ("chi01", "chi02")
_NAMES = (*_ANGLES, "period", "zeta", "B1", "B3", "C1", "C3")


class Drawing(msgspec.Struct, kw_only=True, forbid_unknown_fields=True, rename={"lam": "lambda"}):
    """The problem file; the swing in degrees."""

    job: str
    title: Text
    beta: Length
    lam: Length
    rho: Twist
    nu: Twist
    swing: Degrees
    text: str = ""


def run(data: Mapping[str, Any], file: Path, out: Path) -> list[Path]:
    """Do the job and return the files written."""
    spec = convert(data, Drawing, file)
    lever = TorsionLever(beta=spec.beta, lam=spec.lam, rho=spec.rho, nu=spec.nu, swing=deg(spec.swing))
    drawings = {"mechanism": figure_mechanism.draw(lever), "motion": figure_motion.draw(lever)}
    return [
        writing.write(out / "drawing.md", _markdown(spec, lever)),
        *(
            writing.write(out / f"{name}.{kind}", content)
            for name, drawing in drawings.items()
            for kind, content in drawing.items()
        ),
    ]


def _markdown(spec: Drawing, lever: TorsionLever) -> str:
    text = [f"# {spec.title}", "", f"<!-- {writing.MARK} -->", ""]
    if spec.text.strip():
        text += [spec.text.strip(), ""]
    held = ", ".join(
        f"{name} = {value:g}"
        for name, value in (("beta", spec.beta), ("lambda", spec.lam), ("rho", spec.rho), ("nu", spec.nu))
    )
    text += [f"{held}, swing {spec.swing:g} degrees; angles in degrees, the period in units of sqrt(I / c1).", ""]
    text += ["![The mechanism](mechanism.svg)", "", "![Moment and motion](motion.svg)", ""]
    rows = []
    for name in _NAMES:
        scale = degrees(1.0) if name in _ANGLES else 1.0
        exact, asymptotic = (scale * getattr(motion, name) for motion in (lever.exact, lever.asymptotic))
        rows.append([name, exact, asymptotic, f"{100 * (asymptotic / exact - 1):.3f}"])
    return "\n".join([*text, tables.to_markdown(["", "exact", "asymptotic", "off by, %"], rows)])
