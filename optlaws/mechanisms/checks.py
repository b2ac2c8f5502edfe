"""Checks of the numbers that describe a follower."""

from __future__ import annotations

from typing import Any

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.laws import MotionLaw
from optlaws.numbers import numbers
from optlaws.numerics.tolerances import CLOSURE


def state(value: Any) -> tuple[float, float]:  # noqa: ANN401 - whatever a caller hands over
    """Displacement and velocity of a mass as two floats.

    Raises
    ------
    InputError
        If they are not two finite numbers.

    Examples
    --------
    >>> state([0, 1])
    (0.0, 1.0)
    """
    pair = numbers(value, "initial")
    if len(pair) != 2:
        raise InputError(f"initial must be displacement and velocity of the mass, got {shortened(value)}")
    return pair[0], pair[1]


def motion_law(value: Any, name: str = "law") -> MotionLaw:  # noqa: ANN401 - whatever a caller hands over
    """The value, if it is a motion law; of an entry of the catalogue or a solution, its law.

    Raises
    ------
    InputError
        If it is not one.

    Examples
    --------
    >>> from optlaws.laws import smoothstep
    >>> motion_law(smoothstep(3)) == smoothstep(3)
    True
    """
    if isinstance(value, MotionLaw):
        return value
    law = getattr(value, "law", None)
    if not isinstance(law, MotionLaw):
        raise InputError(
            f"{name} must be a motion law, a MotionLaw such as smoothstep(4) or savin('III', 7.2), "
            f"got {shortened(value)}"
        )
    return law


def leads_back(rise: MotionLaw, fall: MotionLaw) -> None:
    """Refuse a return whose stroke is not that of the rise.

    Raises
    ------
    InputError
        Naming both strokes.

    Examples
    --------
    >>> from optlaws.laws import smoothstep
    >>> leads_back(smoothstep(3), smoothstep(4))
    """
    strokes = [float(law.a(1.0)) - float(law.a(0.0)) for law in (rise, fall)]
    if abs(strokes[1] - strokes[0]) > CLOSURE * max(1.0, abs(strokes[0])):
        raise InputError(f"fall must lead back over the rise's stroke {strokes[0]:g}, but has {strokes[1]:g}")
