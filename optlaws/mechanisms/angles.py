"""Angles: the library computes in radians."""

from __future__ import annotations

from math import radians


def deg(angle: float) -> float:
    """An angle given in degrees, in radians.

    Examples
    --------
    >>> deg(180)
    3.141592653589793
    """
    return radians(angle)
