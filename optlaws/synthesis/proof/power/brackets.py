"""Between what values the velocity must lie where the power is bounded, from values that are known elsewhere.

As d = b c, the slope of b |b| / 2 is d in magnitude: |d| <= D bounds how fast b |b| can change, whatever b's sign.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Anchors:
    """Places k at which the velocity is known to lie between two values."""

    k: Array
    low: Array
    high: Array

    def joined(self, k: Array, low: Array, high: Array) -> Anchors:
        """With more of them."""
        return Anchors(*(np.concatenate(pair) for pair in ((self.k, k), (self.low, low), (self.high, high))))


def velocity_brackets(anchors: Anchors, D: float, k: Array) -> tuple[Array, Array]:
    """Least and greatest velocity at the places k of a law with peak power D (dimensionless).

    Examples
    --------
    >>> rest = Anchors(np.array([0.0]), np.zeros(1), np.zeros(1))
    >>> velocity_brackets(rest, 2.0, np.array([0.25]))[1].tolist()
    [1.0]
    """
    change = 2.0 * D * np.abs(k[:, None] - anchors.k)
    low = _signed_root(anchors.low * np.abs(anchors.low) - change).max(axis=1)
    high = _signed_root(anchors.high * np.abs(anchors.high) + change).min(axis=1)
    return low, high


def _signed_root(square: Array) -> Array:
    found: Array = np.copysign(np.sqrt(np.abs(square)), square)
    return found
