"""Checks of what callers hand over."""

from __future__ import annotations

import operator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from optlaws.errors import InputError


def whole(value: Any, name: str, least: int = 0) -> int:  # noqa: ANN401
    """The value as an int, if it is an integer of at least `least`; `name` is what an error calls it.

    Raises
    ------
    InputError
        If it is not.

    Examples
    --------
    >>> whole(3, "nu")
    3
    """
    try:
        number = None if isinstance(value, bool) else operator.index(value)
    except TypeError:
        number = None
    if number is None or number < least:
        msg = f"{name} must be an integer of at least {least}, got {value!r}"
        raise InputError(msg)
    return number


def times(k: Any) -> NDArray[np.float64]:  # noqa: ANN401
    """Dimensionless times as floats, of any shape.

    Raises
    ------
    InputError
        If one is outside [0, 1] or not a real number.

    Examples
    --------
    >>> times([0, 1])
    array([0., 1.])
    """
    try:
        given = np.asarray(k)
    except ValueError:
        given = np.array(None)
    if given.dtype.kind not in "fiu" and given.size:
        msg = f"k must be real numbers in [0, 1], got {k!r}"
        raise InputError(msg)
    found = given.astype(np.float64)
    inside = (found >= 0.0) & (found <= 1.0)
    if not inside.all():
        msg = f"k must be in [0, 1], got {float(found[~inside].flat[0])!r}"
        raise InputError(msg)
    return found
