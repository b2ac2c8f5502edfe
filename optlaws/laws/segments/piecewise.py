"""Piecewise laws: exact segments joined at breaks, with whatever jumps the joints have."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate, pairwise
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.laws.curve import Sides
from optlaws.laws.law import MotionLaw
from optlaws.laws.segments.segment import Segment
from optlaws.numbers import Array, finite, numbers

Many = NDArray[Any] | Sequence[Any]

_END = np.ones(1)
_GAUSS = 24  # points a segment for the mean square of a, of which nothing asks more than curiosity


@dataclass(frozen=True, init=False, repr=False)
class PiecewiseLaw(MotionLaw, kind="piecewise"):
    """A law of exact segments between breaks 0 = k_0 < k_1 < ... < k_n = 1; displacement is continuous.

    Where a derivative jumps at a break, those of higher order are impulses, and `jumps` gives the size. Where c itself
    grows without limit (a constant-power segment that starts from rest), C, J and the RMS are inf.

    Parameters
    ----------
    breaks
        Dimensionless times, shape (n + 1,), from 0 to 1 and increasing.
    segments
        n segments; each gives b on its own stretch.
    a0
        Displacement at k = 0.

    Raises
    ------
    InputError
        If the breaks do not increase from 0 to 1, or the segments do not fit them.

    Examples
    --------
    >>> from optlaws.laws.segments import PolynomialSegment
    >>> law = PiecewiseLaw([0, 0.5, 1], [PolynomialSegment([4.0]), PolynomialSegment([-4.0], b0=2.0)])
    >>> law
    PiecewiseLaw(segments=2, B=2, C=4, D=8, J=inf)
    >>> law.a(1.0), law.jumps(2), law.continuity
    (1.0, ((0.5, -8.0),), 1)
    """

    breaks: tuple[float, ...] = (0.0, 1.0)
    segments: tuple[Segment, ...] = ()
    a0: float = 0.0

    def __init__(self, breaks: Many, segments: Sequence[Segment], a0: float = 0.0) -> None:
        places = numbers(breaks, "breaks")
        if len(places) < 2 or places[0] != 0.0 or places[-1] != 1.0 or any(b <= a for a, b in pairwise(places)):
            raise InputError(f"breaks must increase from 0 to 1, got {places}")
        parts = tuple(segments if isinstance(segments, list | tuple) else ())
        if len(parts) != len(places) - 1 or not all(isinstance(segment, Segment) for segment in parts):
            raise InputError(
                f"segments must be {len(places) - 1} segments, one between breaks, got {shortened(segments)}"
            )
        object.__setattr__(self, "breaks", places)
        object.__setattr__(self, "segments", parts)
        object.__setattr__(self, "a0", finite(a0, "a0"))

    @kept_property
    def _lengths(self) -> tuple[tuple[Segment, float], ...]:
        return tuple(
            (segment, end - start) for segment, (start, end) in zip(self.segments, pairwise(self.breaks), strict=True)
        )

    @kept_property
    def _starts(self) -> tuple[float, ...]:
        steps = (float(segment.derivative(_END, length, 0)[0]) for segment, length in self._lengths)
        return tuple(accumulate(steps, initial=self.a0))

    def _pieces(self, k: Array, values: Any) -> Array:
        result = np.empty(k.shape)
        places = np.searchsorted(self.breaks[1:-1], k, side="right")
        for i in np.flatnonzero(np.bincount(np.ravel(places))).tolist():  # of many segments few have a place of k
            here, (segment, length) = places == i, self._lengths[i]
            result[here] = values(segment, np.minimum((k[here] - self.breaks[i]) / length, 1.0), length)
        return result

    def _derivative(self, k: Array, nu: int) -> Array:
        values = self._pieces(k, lambda segment, u, length: segment.derivative(u, length, nu))
        if nu == 0:
            values += np.array(self._starts)[np.searchsorted(self.breaks[1:-1], k, side="right")]
        return values

    def _gathered(self, candidates: Any, values: Any) -> tuple[Array, Array]:
        """Candidate times with the values that their own segment has there, so that breaks appear twice."""
        places, heights = [], []
        for (segment, length), (start, end) in zip(self._lengths, pairwise(self.breaks), strict=True):
            u = np.concatenate([[0.0], candidates(segment, length), [1.0]])
            places.append(np.where(u == 1.0, end, start + u * length))
            heights.append(values(segment, u, length))
        return np.concatenate(places), np.concatenate(heights)

    def _before_breaks(self, nu: int) -> Array:
        if nu == 0:
            return np.array(self._starts[1:-1])
        return np.array([float(segment.derivative(_END, length, nu)[0]) for segment, length in self._lengths[:-1]])

    def _power(self, k: Array) -> Array:
        c = self._derivative(k, 2)
        known = np.isfinite(c)
        values = self._derivative(k, 1) * np.where(known, c, 0.0)
        if known.all():
            return values
        return np.where(known, values, self._pieces(k, lambda segment, u, length: segment.power(u, length)))

    def _sides(self, nu: int) -> Sides:
        k, values = self._gathered(
            lambda segment, length: segment.candidates(length, nu),
            lambda segment, u, length: segment.derivative(u, length, nu),
        )
        return k, self._derivative(k, 0) if nu == 0 else values

    def _power_sides(self) -> Sides:
        return self._gathered(
            lambda segment, length: segment.power_candidates(length),
            lambda segment, u, length: segment.power(u, length),
        )

    def _mean_square(self, nu: int) -> float:
        if nu == 0:
            u, weights = np.polynomial.legendre.leggauss(_GAUSS)
            ends = np.array(self.breaks)
            middles, halves = (ends[1:] + ends[:-1]) / 2.0, np.diff(ends) / 2.0
            values = self._derivative(middles[:, None] + halves[:, None] * u, 0)
            return float((values**2 @ weights) @ halves)
        return sum(segment.square(length, nu) for segment, length in self._lengths)

    def _summary(self) -> str:
        return f"segments={len(self.segments)}"

    @classmethod
    def _read(cls, fields: dict[str, Any]) -> Self:
        if not isinstance(fields["segments"], list | tuple):
            raise InputError(f"segments must be a list, got {shortened(fields['segments'])}")
        return cls(fields["breaks"], [Segment.from_dict(entry) for entry in fields["segments"]], fields["a0"])
