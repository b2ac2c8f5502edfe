"""Checks of the numbers that describe a follower."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from optlaws.errors import InputError
from optlaws.laws import MotionLaw
from optlaws.laws.segments import number, numbers


def positive(value: Any, name: str) -> float:  # noqa: ANN401 - whatever a caller hands over
    """The value as a float above 0.

    Raises
    ------
    InputError
        If it is not one.

    Examples
    --------
    >>> positive(20, "nu")
    20.0
    """
    found = _finite(value, name)
    if found <= 0.0:
        raise InputError(f"{name} must be above 0, got {value!r}")
    return found


def not_negative(value: Any, name: str) -> float:  # noqa: ANN401 - whatever a caller hands over
    """The value as a float of at least 0.

    Raises
    ------
    InputError
        If it is not one.

    Examples
    --------
    >>> not_negative(0, "damping")
    0.0
    """
    found = _finite(value, name)
    if found < 0.0:
        raise InputError(f"{name} must be at least 0, got {value!r}")
    return found


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
    found = numbers(value, "initial")
    if len(found) != 2:
        raise InputError(f"initial must be displacement and velocity of the mass, got {value!r}")
    return found[0], found[1]


def motion_law(value: Any, name: str = "law") -> MotionLaw:  # noqa: ANN401 - whatever a caller hands over
    """The value, if it is a motion law.

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
    if not isinstance(value, MotionLaw):
        raise InputError(f"{name} must be a motion law such as smoothstep(4) or savin('III', 7.2), got {value!r}")
    return value


def real_times(k: Any) -> NDArray[np.float64]:  # noqa: ANN401 - whatever a caller hands over
    """Finite times of any shape.

    Raises
    ------
    InputError
        If one is not a finite real number.

    Examples
    --------
    >>> real_times([0, 1.5]).tolist()
    [0.0, 1.5]
    """
    try:
        given = np.asarray(k)
    except ValueError:
        given = np.array(None)
    real = given.dtype.kind in "fiu" or not given.size
    if not real or not np.isfinite(given.astype(np.float64)).all():
        raise InputError(f"k must be finite real numbers, got {k!r}")
    return given.astype(np.float64)


def _finite(value: Any, name: str) -> float:  # noqa: ANN401 - whatever a caller hands over
    try:
        return number(value, name)
    except InputError:
        raise InputError(f"{name} must be a finite real number, got {value!r}") from None
