"""Peaks over the whole interval: their definition, selection and refinement."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import inf
from typing import Any, Self

import numpy as np

from optlaws.files.reading import JsonText, entries_of
from optlaws.numbers import Array, bounded, finite
from optlaws.tolerances import AGREEMENT, POLISHING_REACH, TIE

_NO_SLOPE = 1e-200  # by less a value is not divided, for it might overflow
_POLISHED = 1e-12  # a step of Newton's method that is the last

POLISH_STEPS = 3


@dataclass(frozen=True, slots=True)
class Peak(JsonText):
    """An extreme value and the smallest k at which it is reached, both dimensionless.

    Examples
    --------
    >>> Peak(1.875, 0.5)
    Peak(value=1.875, k=0.5)
    """

    _json_name = "a peak"

    value: float
    k: float

    def to_dict(self) -> dict[str, float | None]:
        """Value and place as plain data; a value without bound is None, because JSON has no infinite number.

        Examples
        --------
        >>> Peak(1.875, 0.5).to_dict()
        {'value': 1.875, 'k': 0.5}
        >>> Peak(float("inf"), 0.0).to_dict()
        {'value': None, 'k': 0.0}
        """
        return {"value": bounded(self.value), "k": self.k}

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Self:
        """The peak that `to_dict` described.

        Raises
        ------
        InputError
            If an entry is missing or no number.
        """
        value, k = entries_of(data, ("value", "k"), cls._json_name).values()
        return cls(inf if value is None else finite(value, "value"), finite(k, "k"))


def highest(k: Array, values: Array, tie: float) -> Peak:
    """The largest of `values`, with the smallest k whose value is within `tie` of it.

    >>> highest(np.array([0.75, 0.25, 0.5]), np.array([2.0, 2.0, 1.0]), 1e-10)
    Peak(value=2.0, k=0.25)
    """
    top = float(values.max())
    return Peak(top, float(k[values >= top - tie].min()))


def extremes(k: Array, values: Array) -> tuple[Peak, Peak]:
    """Minimum and maximum, signed, of values at candidate points; infinite where a value is.

    >>> extremes(np.array([0.0, 1.0]), np.array([-6.0, 6.0]))
    (Peak(value=-6.0, k=0.0), Peak(value=6.0, k=1.0))
    """
    tie = _tie(np.abs(values))
    lowest = highest(k, -values, tie)
    return Peak(-lowest.value if lowest.value else 0.0, lowest.k), highest(k, values, tie)


def peak(k: Array, values: Array) -> Peak:
    """Peak magnitude of values at candidate points; infinite where a value is.

    >>> peak(np.array([0.0, 1.0]), np.array([-6.0, 6.0]))
    Peak(value=6.0, k=0.0)
    """
    size = np.abs(values)
    return highest(k, size, _tie(size))


def _tie(size: Array) -> float:
    top = float(size.max())
    return TIE * (top if top < inf else float(size[np.isfinite(size)].max(initial=0.0)))


def polished(x: Array, residual: Callable[[Array], tuple[Array, Array]]) -> Array:
    """Candidates in [-1, 1] improved by Newton steps towards roots of a residual, where that reduces it.

    `residual(x)` gives the residual and its derivative with respect to x. A step is short and stays only
    where the residual shrinks, so that a candidate that is already good cannot be lost.

    >>> polished(np.array([0.4995]), lambda x: (x * x - 0.25, 2 * x)).round(12)
    array([0.5])
    """
    size, step = _step(*residual(x))
    for _ in range(POLISH_STEPS):
        if np.abs(step).max(initial=0.0) < _POLISHED:
            break
        trial = np.clip(x - step, -1.0, 1.0)
        trial_size, trial_step = _step(*residual(trial))
        better = trial_size < size
        x = np.where(better, trial, x)
        size = np.where(better, trial_size, size)
        step = np.where(better, trial_step, 0.0)
    return x


def _step(value: Array, slope: Array) -> tuple[Array, Array]:
    step = value / np.where(np.abs(slope) < _NO_SLOPE, np.inf, slope)
    return np.abs(value), np.clip(step, -POLISHING_REACH, POLISHING_REACH)


def is_kept(value: float, limit: float, rounding: float = AGREEMENT) -> bool:
    """Whether a value is within a limit from above: one that is reached is kept, up to the rounding of the value.

    `rounding` is a share of the limit. Of a limit from below both are given with the other sign.

    Examples
    --------
    >>> is_kept(25.0 + 1e-10, 25.0), is_kept(25.001, 25.0), is_kept(-14.9, -15.0)
    (True, False, False)
    """
    return value <= limit + rounding * abs(limit)
