"""The smoothness that a cam needs of a mass law: up to its jerk, within and at both ends."""

from __future__ import annotations

import numpy as np

from optlaws.errors import InputError
from optlaws.laws import MotionLaw
from optlaws.numerics.tolerances import JUMP

_NAMES = {1: ("velocity", "b"), 2: ("acceleration", "c"), 3: ("jerk", "j")}
_REMEDY = (
    "use a law whose b, c and j are zero at both ends, such as smoothstep(4), a member of Savin's family III or IV, "
    "or a solution of order 4"
)


def check_mass_law(law: MotionLaw) -> None:
    """Refuse a mass law whose cam would have to jump in displacement or velocity.

    The cam's displacement holds the mass's b and c, and its velocity c and j; in the rests before and after the motion
    all of them are zero.

    Raises
    ------
    InputError
        If a derivative up to the jerk jumps within the motion, or is not zero at an end.

    Examples
    --------
    >>> from optlaws.laws.savin import savin
    >>> check_mass_law(savin("III", 7.2))
    >>> check_mass_law(savin("I", 0.0))
    Traceback (most recent call last):
    optlaws.errors.InputError: the mass law has acceleration c(0) = 6, so the displacement of the cam would jump...
    """
    for order, (name, letter) in _NAMES.items():
        cam = "velocity" if order == 3 else "displacement"
        for k, value in zip((0.0, 1.0), law([0.0, 1.0], order).tolist(), strict=True):
            size = _size(law, order)
            if not abs(value) <= JUMP * size:
                raise InputError(
                    f"the mass law has {name} {letter}({k:g}) = {value:.6g}, so the {cam} of the cam would jump there; "
                    f"{_REMEDY}"
                )
        if leaps := law.jumps(order):
            k, height = leaps[0]
            raise InputError(
                f"the mass law has a jump of its {name} {letter} by {height:.6g} at k = {k:.6g}, so the {cam} of the "
                f"cam would jump there; {_REMEDY}"
            )


def _size(law: MotionLaw, order: int) -> float:
    size = np.abs(law(np.linspace(0.0, 1.0, 33), order))
    return max(1.0, float(size[np.isfinite(size)].max(initial=0.0)))
