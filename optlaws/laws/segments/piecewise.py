"""Piecewise laws: exact segments joined at breaks, with whatever jumps the joints have."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate, pairwise
from math import inf
from typing import Any, Self, overload

import numpy as np
from numpy.typing import NDArray

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.laws.html import page
from optlaws.laws.law import MotionLaw
from optlaws.laws.segments.segment import Segment
from optlaws.numbers import derivative, finite, numbers, times
from optlaws.series import peaks
from optlaws.series.peaks import Peak

Array = NDArray[np.float64]
Many = NDArray[Any] | Sequence[Any]

JUMP = 1e-9  # a difference at a break below this share of the derivative's size is rounding, not a jump
UNSEEN = 1e-13  # and so is one below this share of the size of a lower derivative: uniform motion has c = 0 but for it
HIGHEST = 9

_GAUSS = 24  # points a segment for the mean square of a, of which nothing asks more than curiosity


@dataclass(frozen=True, init=False, repr=False)
class PiecewiseLaw(MotionLaw, kind="piecewise"):
    """A law of exact segments between breaks 0 = k_0 < k_1 < ... < k_n = 1; displacement is continuous.

    At a break a derivative takes its right-hand value, at k = 1 the left-hand one; peaks and extrema look at both
    sides of every break. Where a derivative jumps inside (0, 1), those of higher order are impulses: J is inf at
    the first k where c jumps, C (and D) where b jumps, and `jumps` tells how much. What happens at k = 0 and k = 1
    is not counted, as for every law: rest before and after the motion is no part of it. Where c itself grows
    without limit (a constant-power segment that starts from rest), C, J and the RMS are inf.

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

    breaks: tuple[float, ...]
    segments: tuple[Segment, ...]
    a0: float

    def __init__(self, breaks: Many, segments: Sequence[Segment], a0: float = 0.0) -> None:
        places = numbers(breaks, "breaks")
        if len(places) < 2 or places[0] != 0.0 or places[-1] != 1.0 or any(b <= a for a, b in pairwise(places)):
            raise InputError(f"breaks must increase from 0 to 1, got {places}")
        kept = tuple(_listed(segments))
        if len(kept) != len(places) - 1 or not all(isinstance(one, Segment) for one in kept):
            raise InputError(
                f"segments must be {len(places) - 1} segments, one between breaks, got {shortened(segments)}"
            )
        object.__setattr__(self, "breaks", places)
        object.__setattr__(self, "segments", kept)
        object.__setattr__(self, "a0", finite(a0, "a0"))

    @overload
    def d(self, k: float) -> float: ...
    @overload
    def d(self, k: Many) -> Array: ...
    def d(self, k: float | Many) -> float | Array:
        """Kinetic power b c at k; finite at the ends of a constant-power segment, where c need not be."""
        inside = times(k)
        c = self._derivative(inside, 2)
        known = np.isfinite(c)
        values = self._derivative(inside, 1) * np.where(known, c, 0.0)
        if not known.all():
            values = np.where(known, values, self._pieces(inside, lambda segment, u, length: segment.power(u, length)))
        return values if np.ndim(values) else float(values)

    def jumps(self, nu: int) -> tuple[tuple[float, float], ...]:
        """Breaks k inside (0, 1) where the derivative of order nu jumps, each with right-hand less left-hand value.

        Differences below 1e-9 of the derivative's size, or 1e-13 of that of a lower one, are taken for rounding.

        Raises
        ------
        InputError
            If `nu` is not an integer of at least 0.

        Examples
        --------
        >>> from optlaws.laws.segments import PolynomialSegment
        >>> PiecewiseLaw([0, 0.5, 1], [PolynomialSegment([], b0=b) for b in (0.5, 1.5)]).jumps(1)
        ((0.5, 1.0),)
        """
        order = derivative(nu)
        if order == 0 or len(self.segments) == 1:
            return ()
        ends = np.array([0.0, 1.0])
        sides = np.array([one.derivative(ends, length, order) for one, length in self._lengths])
        left, right = sides[:-1, 1], sides[1:, 0]
        rounding = JUMP * self._size(order)
        leaps = tuple(
            (k, float(after - before))
            for k, before, after in zip(self.breaks[1:-1], left.tolist(), right.tolist(), strict=True)
            if before != after and not abs(after - before) <= rounding
        )
        unseen = max((UNSEEN * self._size(lower) for lower in range(1, order)), default=0.0) if leaps else 0.0
        return tuple((k, height) for k, height in leaps if not abs(height) <= unseen)

    def _size(self, nu: int) -> float:
        """The greatest finite magnitude of a derivative at nine places of every segment."""
        inside = [one.derivative(np.linspace(0.0, 1.0, 9), length, nu) for one, length in self._lengths]
        known = np.abs(np.concatenate(inside))
        return float(known[np.isfinite(known)].max(initial=0.0))

    @property
    def continuity(self) -> int:
        """The highest nu, up to 9, such that all derivatives up to order nu are finite and continuous on [0, 1].

        Examples
        --------
        >>> from optlaws.laws.segments import PowerSegment
        >>> PiecewiseLaw([0, 0.5, 1], [PowerSegment(0.0, 1.5), PowerSegment(1.5, 0.0)]).continuity
        1
        """
        for nu in range(1, HIGHEST + 1):
            if self.jumps(nu) or not self._is_finite(nu):
                return nu - 1
        return HIGHEST

    def _is_finite(self, nu: int) -> bool:
        """Whether the derivative of order nu is bounded; no kind of segment grows without limit but at its ends."""
        ends = np.array([0.0, 1.0])
        return all(np.isfinite(one.derivative(ends, length, nu)).all() for one, length in self._lengths)

    def peak(self, nu: int) -> Peak:  # noqa: D102
        k, values = self._sides(derivative(nu))
        return _top(k, np.abs(values))

    def extrema(self, nu: int, within: tuple[float, float] = (0.0, 1.0)) -> tuple[Peak, Peak]:  # noqa: D102
        k, values = self._sides(derivative(nu))
        if within != (0.0, 1.0):
            ends = times(within)
            inside = (k >= ends[0]) & (k <= ends[1])
            k = np.concatenate([ends, k[inside]])
            values = np.concatenate([self._derivative(ends, nu), values[inside]])
        low = _top(k, -values)
        return Peak(-low.value if low.value else 0.0, low.k), _top(k, values)

    def power_peak(self) -> Peak:  # noqa: D102
        k, values = self._gathered(
            lambda segment, length: segment.power_candidates(length),
            lambda segment, u, length: segment.power(u, length),
        )
        leaps = [place for place, _ in self.jumps(1)]
        return _top(np.append(k, leaps), np.append(np.abs(values), np.full(len(leaps), inf)))

    def _repr_html_(self) -> str:
        k = np.linspace(0.0, 1.0, 121)
        curves = {name: _finite(self._derivative(k, nu)).tolist() for nu, name in enumerate("abc")}
        return page(f"{type(self).__name__}, {self._summary()}", self.constants, curves)

    @kept_property
    def _lengths(self) -> tuple[tuple[Segment, float], ...]:
        return tuple((one, end - start) for one, (start, end) in zip(self.segments, pairwise(self.breaks), strict=True))

    @kept_property
    def _starts(self) -> tuple[float, ...]:
        whole_segment = np.ones(1)
        steps = (float(one.derivative(whole_segment, length, 0)[0]) for one, length in self._lengths)
        return tuple(accumulate(steps, initial=self.a0))

    def _pieces(self, k: Array, values: Any) -> Array:  # noqa: ANN401
        found = np.empty(k.shape)
        places = np.searchsorted(self.breaks[1:-1], k, side="right")
        for i, (segment, length) in enumerate(self._lengths):
            here = places == i
            if here.any():
                u = np.minimum((k[here] - self.breaks[i]) / length, 1.0)
                found[here] = values(segment, u, length)
        return found

    def _derivative(self, k: Array, nu: int) -> Array:
        found = self._pieces(k, lambda segment, u, length: segment.derivative(u, length, nu))
        if nu == 0:
            found += np.array(self._starts)[np.searchsorted(self.breaks[1:-1], k, side="right")]
        return found

    def _gathered(self, candidates: Any, values: Any) -> tuple[Array, Array]:  # noqa: ANN401
        """Candidate times with the values that their own segment has there, so that breaks appear twice."""
        places, found = [], []
        for (segment, length), (start, end) in zip(self._lengths, pairwise(self.breaks), strict=True):
            u = np.concatenate([[0.0], candidates(segment, length), [1.0]])
            places.append(np.where(u == 1.0, end, start + u * length))
            found.append(values(segment, u, length))
        return np.concatenate(places), np.concatenate(found)

    def _sides(self, nu: int) -> tuple[Array, Array]:
        """Candidates for extremes of the derivative of order nu, impulses among them as infinite values."""
        k, values = self._gathered(
            lambda segment, length: segment.candidates(length, nu),
            lambda segment, u, length: segment.derivative(u, length, nu),
        )
        if nu == 0:
            values = self._derivative(k, 0)
        leaps = [(place, height * inf) for place, height in self.jumps(nu - 1)] if nu > 1 else []
        # the derivative of an impulse has both signs
        leaps += [(place, side) for lower in range(1, nu - 1) for place, _ in self.jumps(lower) for side in (inf, -inf)]
        places, heights = np.array(leaps).reshape(-1, 2).T
        return np.append(k, places), np.append(values, heights)

    def _candidates(self, nu: int) -> Array:
        return self._sides(nu)[0]

    def _power_candidates(self) -> Array:
        return self._gathered(
            lambda segment, length: segment.power_candidates(length),
            lambda segment, u, length: segment.power(u, length),
        )[0]

    def _mean_square(self, nu: int) -> float:
        if nu == 0:
            u, weights = np.polynomial.legendre.leggauss(_GAUSS)
            ends = np.array(self.breaks)
            middles, halves = (ends[1:] + ends[:-1]) / 2.0, np.diff(ends) / 2.0
            values = self._derivative(middles[:, None] + halves[:, None] * u, 0)
            return float((values**2 @ weights) @ halves)
        if any(self.jumps(lower) for lower in range(nu)):
            return inf
        return sum(segment.square(length, nu) for segment, length in self._lengths)

    def _summary(self) -> str:
        return f"segments={len(self.segments)}"

    def _fields(self) -> dict[str, Any]:
        return {"breaks": list(self.breaks), "segments": [one.to_dict() for one in self.segments], "a0": self.a0}

    @classmethod
    def _from_fields(cls, fields: dict[str, Any]) -> Self:
        expected = ("breaks", "segments", "a0")
        if problems := [f"{key!r} is unknown" for key in fields if key not in expected] + [
            f"{key!r} is missing" for key in expected if key not in fields
        ]:
            raise InputError(f"a piecewise law has the keys {', '.join(expected)}; {', '.join(problems)}")
        if not isinstance(fields["segments"], list | tuple):
            raise InputError(f"segments must be a list, got {fields['segments']!r}")
        return cls(fields["breaks"], [Segment.from_dict(one) for one in fields["segments"]], fields["a0"])


def _listed(segments: object) -> Sequence[Any]:
    return segments if isinstance(segments, list | tuple) else ()


def _top(k: Array, values: Array) -> Peak:
    if values.max() == inf:
        return Peak(inf, float(k[values == inf].min()))
    return peaks.highest(k, values, peaks.TIE * float(np.abs(values[np.isfinite(values)]).max(initial=0.0)))


def _finite(values: Array) -> Array:
    known = values[np.isfinite(values)]
    return np.clip(values, known.min(), known.max())
