"""Ranges of places at which a law may have a peak."""

from __future__ import annotations

from typing import NamedTuple


class PlaceRange(NamedTuple):
    """Places from one to another, and the sign with which the peak is there.

    Examples
    --------
    >>> PlaceRange(1.0, 0.0, 0.5).parts(0.125)[0]
    PlaceRange(sign=1.0, low=0.125, high=0.5)
    """

    sign: float
    low: float
    high: float

    @property
    def k(self) -> float:
        """The middle."""
        return (self.low + self.high) / 2.0

    @property
    def reach(self) -> float:
        """How far the ends are from the middle."""
        return (self.high - self.low) / 2.0

    def holds(self, other: PlaceRange) -> bool:
        """Whether the other one is part of it: an end alone is part of no longer one."""
        inside = self.low <= other.low <= other.high <= self.high
        return inside and self.sign == other.sign and (self.low == self.high) == (other.low == other.high)

    def parts(self, at: float) -> list[PlaceRange]:
        """What is above a place, then what is below it."""
        return [self._replace(low=at), self._replace(high=at)]
