"""Standard laws as points, and Savin's families as lines, in the picture of a front."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

from optlaws import MotionLaw, SavinFamily, catalogue
from optlaws.explorer.answers.asked import value
from optlaws.explorer.answers.law_view import digits, drawn
from optlaws.laws.savin import FAMILIES
from optlaws.numbers import bounded

#: those that the picture names without being asked
NAMED = {"cycloidal", "modified sine", "modified trapezoid", "3-4-5 polynomial", "4-5-6-7 polynomial", "cubic"}
_MEMBERS = 33


@cache
def points(x: str, y: str) -> list[dict[str, Any]]:
    """Each standard law whose two constants are finite, with what a reader is told of it.

    Examples
    --------
    >>> next(entry["text"] for entry in points("B", "C") if entry["name"] == "cycloidal")
    'cycloidal: B = 2, C = 6.28319'
    """
    points = []
    for name in catalogue:
        law = catalogue[name].law
        place = _place(law, x, y)
        if place is not None:
            text = f"{name}: {x} = {digits(place[0], 6)}, {y} = {digits(place[1], 6)}"
            points.append({"name": name, "at": place, "text": text, "named": name in NAMED})
    return points


def _place(law: MotionLaw, x: str, y: str) -> tuple[float, float] | None:
    pair = value(law, x), value(law, y)
    return pair if all(bounded(number) is not None for number in pair) and pair[1] > 0.0 else None


@cache
def families(x: str, y: str) -> list[dict[str, Any]]:
    """Savin's families I to IV over their alpha; family I begins where its J is finite.

    Examples
    --------
    >>> [entry["name"] for entry in families("B", "C")]
    ['I', 'II', 'III', 'IV']
    """
    lines = []
    for name in FAMILIES:
        family = SavinFamily.of(name)
        low, high = map(float, family.range)
        laws = [family.law(alpha) for alpha in np.linspace(low, high, _MEMBERS).tolist()]
        columns = [drawn(np.array([value(law, constant) for law in laws]), 5) for constant in (x, y)]
        lines.append({"name": name, "line": [list(column) for column in zip(*columns, strict=True)]})
    return lines
