"""The smooth stretches of a motion: parts of laws in their places, enclosed with their derivatives in intervals."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import factorial
from typing import Any, Protocol, TypeVar

import numpy as np

from optlaws.laws import MotionLaw, PolynomialLaw
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.laws.segments.segment import PolynomialSegment, Segment
from optlaws.motion.enclosed_segments import enclosed_derivatives, enclosed_power
from optlaws.motion.piece import Piece, factor
from optlaws.numbers import Array
from optlaws.numerics import chebyshev
from optlaws.numerics.interval import Interval, exact
from optlaws.numerics.taylor import Jet
from optlaws.tolerances import ROUNDOFF

StretchT = TypeVar("StretchT", bound="EnclosedStretch")
PartT = TypeVar("PartT", bound="Started")


class Started(Protocol):
    """Protocol of values that hold from a place on."""

    @property
    def start(self) -> float:
        """The first place of it."""


@dataclass(frozen=True)
class EnclosedStretch:
    """A smooth part of a motion over a range of its master: offset + stroke times a segment of a law.

    `duration` is that of the whole law, of which the segment is a part `length` long in k.
    """

    start: float
    stop: float
    offset: float
    stroke: float
    duration: float
    segment: Segment
    length: float

    def values(self, place: Array, nu: int) -> Array:
        """The derivative of order nu by the master."""
        u = np.clip((place - self.start) / (self.stop - self.start), 0.0, 1.0)
        if self.stroke == 0.0:
            return np.full(np.shape(u), self.offset if nu == 0 else 0.0)
        values = factor(self.stroke, self.duration, nu) * self.segment.derivative(u, self.length, nu)
        return self.offset + values if nu == 0 else values

    def jet(self, place: Array | Interval, nu: int) -> Jet:
        """The displacement with its derivatives up to order nu; in intervals of places all that they may be."""
        if not isinstance(place, Interval):
            return Jet(tuple(self.values(place, i) / factorial(i) for i in range(nu + 1)))
        if self.stroke == 0.0:
            still = exact(np.zeros(place.middle.shape))
            return Jet((still + self.offset, *(still,) * nu))
        values = enclosed_derivatives(self.segment, self.length, *self._cells(place), nu)
        factors, blur = self._factors(nu)
        shape = (nu + 1, *(1,) * place.middle.ndim)
        return Jet.of_rows(values * Interval(factors.reshape(shape), blur.reshape(shape))) + self.offset

    def _factors(self, nu: int) -> tuple[Array, Array]:
        """What derivatives by k are multiplied with for Taylor terms by the master, and its rounding."""
        by = [self.stroke / self.duration**i / factorial(i) for i in range(nu + 1)]
        return np.array(by), np.array([abs(each) * (i + 3) * ROUNDOFF for i, each in enumerate(by)])

    def power(self, place: Interval, nu: int) -> Jet:
        """The velocity times the acceleration, by the master, in intervals of places: finite where d of the law is."""
        if self.stroke == 0.0:
            return Jet((exact(np.zeros(place.middle.shape)),) * (nu + 1))
        power = enclosed_power(self.segment, self.length, *self._cells(place), nu)
        by = self.stroke**2 / self.duration**3
        return Jet(
            tuple(
                term * Interval(np.array(by / self.duration**i), np.array(by / self.duration**i * (i + 6) * ROUNDOFF))
                for i, term in enumerate(power.terms)
            )
        )

    def _cells(self, place: Interval) -> tuple[Array, Array]:
        """Middles and half lengths of intervals as shares of the stretch, and of no more than it."""
        span = self.stop - self.start
        middle, half = (place.middle - self.start) / span, place.radius / span
        half = np.where(np.isfinite(half), half * (1.0 + 4.0 * ROUNDOFF), np.inf)
        low, high = (np.clip(middle + side * half, 0.0, 1.0) for side in (-1.0, 1.0))
        return 0.5 * (low + high), 0.5 * (high - low) + 8.0 * ROUNDOFF

    def extremes(self, nu: int) -> tuple[float, float]:
        """Least and greatest derivative of order nu."""
        inner = self.segment.candidates(self.length, nu) if self.stroke else np.empty(0)
        u = np.concatenate([[0.0, 1.0], inner])
        values = self.values(self.start + (self.stop - self.start) * u, nu)
        return float(values.min()), float(values.max())


def smooth_parts(piece: Piece, kind: type[StretchT]) -> tuple[StretchT, ...]:
    """The smooth parts of a law in its place, one after the other.

    >>> from optlaws import catalogue
    >>> parts = smooth_parts(Piece(0.0, 2.0, 0.0, 1.0, catalogue["modified sine"].law), EnclosedStretch)
    >>> [part.stop for part in parts]
    [0.25, 1.0, 1.75, 2.0]
    """
    first = float(piece.law.a(0.0))
    stretches = []
    for (start, stop), segment in zip(pairwise(piece.law.breaks), _segments(piece.law), strict=True):
        offset = piece.offset + piece.stroke * (float(piece.law.a(start)) - first)
        low, high = piece.start + start * piece.duration, piece.start + stop * piece.duration
        stretches.append(kind(low, high, offset, piece.stroke, piece.duration, segment, stop - start))
    return tuple(stretches)


def jet_of_parts(
    stretches: Sequence[PartT],
    jet: Callable[[PartT, Any], Jet],
    at: Array | Interval,
    *,
    before: bool = False,
) -> Jet:
    """A jet of each stretch at the places that lie in it, or in intervals by their middles; at a break just after it.

    >>> from optlaws import smoothstep
    >>> parts = smooth_parts(Piece(0.0, 2.0, 0.0, 1.0, smoothstep(2)), EnclosedStretch)
    >>> [float(term[0]) for term in jet_of_parts(parts, lambda part, at: part.jet(at, 1), np.array([1.0])).terms]
    [0.5, 0.75]
    """
    middle = at.middle if isinstance(at, Interval) else np.asarray(at)
    which = np.searchsorted([stretch.start for stretch in stretches[1:]], middle, side="left" if before else "right")
    present = np.unique(which)
    if len(present) == 1:
        return jet(stretches[present[0]], at)
    pieces = [(which == i, jet(stretches[i], at[which == i])) for i in present]
    return joined(middle.shape, pieces)


def _segments(law: MotionLaw) -> Sequence[Segment]:
    """The law between its breaks: exact for segments or a polynomial, else interpolated to rounding."""
    if isinstance(law, PiecewiseLaw):
        return law.segments
    if isinstance(law, PolynomialLaw):
        return (PolynomialSegment(law.acceleration, law.b0),)
    return [_interpolated(law, start, stop) for start, stop in pairwise(law.breaks)]


def joined(shape: tuple[int, ...], pieces: Sequence[tuple[Any, Jet]]) -> Jet:
    """The jet at places of which each piece has some.

    >>> here = np.array([True, False])
    >>> joined((2,), [(here, Jet([np.array([1.0])])), (~here, Jet([np.array([2.0])]))]).terms[0]
    array([1., 2.])
    """
    blocks = [(here, jet.block) for here, jet in pieces]
    count = len(pieces[0][1].terms) if blocks[0][1] is None else len(blocks[0][1].middle)
    whole = Interval(np.empty((count, *shape)), np.empty((count, *shape)))
    for here, block in blocks:
        if block is not None:
            whole.middle[:, here], whole.radius[:, here] = block.middle, block.radius
    if blocks[0][1] is not None:
        return Jet.of_rows(whole)
    for here, jet in pieces:
        whole.middle[:, here] = jet.terms
    return Jet(tuple(whole.middle))


def _interpolated(law: MotionLaw, start: float, stop: float) -> Segment:
    def c(x: Array) -> Array:
        return law.c(start + 0.5 * (stop - start) * (x + 1.0))

    series = chebyshev.interpolated(c, "acceleration of a law")
    return PolynomialSegment(tuple(series.tolist()), float(law.b(start)))
