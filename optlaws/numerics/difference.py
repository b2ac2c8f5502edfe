"""The greatest difference of two functions: an estimate, by series of the difference on parts."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from optlaws.errors import InputError
from optlaws.numbers import Array
from optlaws.numerics import bernstein, chebyshev
from optlaws.numerics.tolerances import DIFFERENCE_ROUNDING, DIFFERENCE_SHARE

Function = Callable[[Array], Array]

_NODES = 10
_CUTS = 30


def greatest_difference(first: Function, second: Function, places: Array) -> tuple[float, float]:
    """An estimate of the greatest |first - second| and of where it is, between places among which both are smooth.

    Parts between the places are halved until a series of ten terms resolves the difference to rounding, or to 1e-10 of
    its greatest value; of the series the extremes are taken. It is an estimate: functions are asked at the nodes of
    parts alone, and a bump between these, narrower than any part, is not seen.

    Parameters
    ----------
    first, second
        Functions of arrays of places.
    places
        Increasing: both ends, and where one of the two is not smooth.

    Examples
    --------
    >>> value, x = greatest_difference(np.sin, lambda x: x, np.array([0.0, 1.0]))
    >>> round(value, 12) == round(1.0 - float(np.sin(1.0)), 12), x
    (True, 1.0)
    """
    low, high = places[:-1], places[1:]
    control: list[Array] = []
    lows: list[Array] = []
    highs: list[Array] = []
    size, greatest = 0.0, 0.0  # of all that has been met: what is rounding beside them is resolved
    for _ in range(_CUTS):
        values, met = _differences(first, second, low, high)
        size, greatest = max(size, met), max(greatest, float(np.abs(values).max()))
        tail = np.abs(chebyshev.from_values(values.T)[-2:]).max(axis=0)
        done = tail <= max(DIFFERENCE_ROUNDING * size, DIFFERENCE_SHARE * greatest)
        for gathered, fresh in ((control, bernstein.from_values(values)), (lows, low), (highs, high)):
            gathered.append(fresh[done])
        if done.all():
            return _top(*map(partial(np.concatenate, axis=0), (control, lows, highs)))
        low, high = low[~done], high[~done]
        middle = (low + high) / 2.0
        low, high = np.concatenate([low, middle]), np.concatenate([middle, high])
    raise InputError(f"the motion is not smooth near x = {float(low[0])!r}: name its breaks")


def _differences(first: Function, second: Function, low: Array, high: Array) -> tuple[Array, float]:
    """The difference at the nodes of parts, a row each, and the size of the second."""
    x = low[:, None] + (high - low)[:, None] * (chebyshev.nodes(_NODES) + 1.0) / 2.0
    theirs = np.asarray(second(x.ravel()), dtype=np.float64).reshape(x.shape)
    if not np.isfinite(theirs).all():
        raise InputError("the motion to compare with must have finite values on the whole interval")
    return first(x.ravel()).reshape(x.shape) - theirs, float(np.abs(theirs).max())


def _top(table: Array, start: Array, stop: Array) -> tuple[float, float]:
    order = np.argsort(start)
    highest = bernstein.top(np.stack([table[order], -table[order]], axis=1).reshape(-1, table.shape[1]))
    row = order[highest.row // 2]
    return highest.value, float(start[row] + (stop[row] - start[row]) * highest.u)
