"""Straight lines above functions of one variable in a range, for rows of boxes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from optlaws.numbers import Array
from optlaws.numerics.tolerances import FLAT_SECANT, SECANT_SERIES

#: X² (1 - X) is nowhere above
_MOST = 4.0 / 27.0
_STEPS = 4


@dataclass(frozen=True, eq=False)
class SecantOverestimator:
    """A straight line that a function is nowhere above in a range, and the function's least and greatest values."""

    slope: Array
    height: Array
    least: Array
    greatest: Array

    def where(self, good: NDArray[np.bool_]) -> SecantOverestimator:
        """The lines where they are good, zero elsewhere."""
        return SecantOverestimator(
            *(np.where(good, part, 0.0) for part in (self.slope, self.height, self.least, self.greatest))
        )


def secant_over_inverse(low: Array, high: Array) -> SecantOverestimator:
    """The chord of 1/b between positive numbers.

    Examples
    --------
    >>> line = secant_over_inverse(np.ones(1), np.full(1, 2.0))
    >>> line.slope.tolist(), line.height.tolist()
    ([-0.5], [1.5])
    """
    return SecantOverestimator(-1.0 / (low * high), 1.0 / low + 1.0 / high, 1.0 / high, 1.0 / low)


def secant_over_root(B: float, square: Array, low: Array, high: Array) -> SecantOverestimator:
    """A line above h(q) = sqrt(q (2 B - t² q)) / (B - t² q), which is first concave in q, then convex.

    With b = B - t² q that is sqrt(B² - b²) / (t b). Where b is not positive throughout the line means nothing, and its
    `greatest` is inf.

    Parameters
    ----------
    B
        The peak velocity.
    square
        t², for each place.
    low, high
        The ranges of q, at least 0.

    Examples
    --------
    >>> line = secant_over_root(2.0, np.zeros(1), np.zeros(1), np.ones(1))  # h is the root of q
    >>> line.slope.tolist(), line.height.tolist()
    ([1.0], [0.25])
    """
    ends = [_root(B, square, q) for q in (low, high)]
    width = high - low
    flat = width <= FLAT_SECANT * np.maximum(high, FLAT_SECANT)
    rise = np.where(np.isfinite(ends[1]), ends[1], 0.0) - np.where(np.isfinite(ends[0]), ends[0], 0.0)
    slope = np.where(flat, 0.0, rise / np.where(flat, 1.0, width))
    turn = _turn(B, square, slope)
    between = np.where((turn > low) & (turn < high), turn, low)
    height = np.maximum(ends[0] - slope * low, ends[1] - slope * high)
    height = np.maximum(height, _root(B, square, between) - slope * between)
    return SecantOverestimator(slope, height, ends[0], ends[1])


def _root(B: float, square: Array, q: Array) -> Array:
    fall = square * q
    with np.errstate(divide="ignore", invalid="ignore"):
        values: Array = np.sqrt(q * np.maximum(2.0 * B - fall, 0.0)) / (B - fall)
    return np.where(fall < B, values, np.inf)


def _turn(B: float, square: Array, slope: Array) -> Array:
    """Where h has a slope, on the side of small q, on which it is concave; inf where nowhere."""
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        eta = 1.0 / (B * slope) ** 2
        kappa = square * eta
        # with X = 1 - t² x it is X² (1 - X) = kappa, of which the greatest root has a closed form
        X = 1.0 / 3.0 + 2.0 / 3.0 * np.cos(np.arccos(np.clip(1.0 - 2.0 * kappa / _MOST, -1.0, 1.0)) / 3.0)
        x = np.where(kappa < SECANT_SERIES, eta * (1.0 + 2.0 * kappa), (1.0 - X) / square)
        for _ in range(_STEPS):
            rest = 1.0 - square * x
            x = x - (x * rest**2 - eta) / (rest * (1.0 - 3.0 * square * x))
        turn = B * x / (1.0 + np.sqrt(np.maximum(1.0 - square * x, 0.0)))
    return np.where(np.isfinite(turn) & (slope > 0.0) & (kappa < _MOST), turn, np.inf)
