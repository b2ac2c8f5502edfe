"""The smooth stretches of a motion: parts of laws in their places, enclosed with their derivatives in intervals.

Taylor's formula with its remainder encloses a segment in cells. What is known of its derivatives everywhere bounds the
remainder: of a Chebyshev series the sum of its coefficients' sizes, of a sine its amplitude times a power of its
frequency. Sums of real powers are monotone term by term. Segments of other kinds are those of their interpolants,
which are them to rounding.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from math import factorial
from typing import Any, TypeVar

import numpy as np

from optlaws.laws import MotionLaw, PolynomialLaw
from optlaws.laws.segments.fractional import FractionalSegment, PowerSegment
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.laws.segments.segment import PolynomialSegment, Segment, Waves
from optlaws.motion.piece import Piece, factor
from optlaws.numbers import Array
from optlaws.numerics import chebyshev
from optlaws.numerics.interval import Interval, between, exact, stacked
from optlaws.numerics.taylor import Jet
from optlaws.tolerances import ROUNDOFF

StretchT = TypeVar("StretchT", bound="EnclosedStretch")


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
        # what derivatives by k are multiplied with for Taylor terms by the master, and its rounding
        factors = [self.stroke / self.duration**i / factorial(i) for i in range(nu + 1)]
        blur = [abs(each) * (i + 3) * ROUNDOFF for i, each in enumerate(factors)]
        shape = (nu + 1, *(1,) * place.middle.ndim)
        return Jet.of_rows(values * Interval(np.reshape(factors, shape), np.reshape(blur, shape))) + self.offset

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
    stretches: Sequence[Any], jet: Callable[[Any, Any], Jet], at: Array | Interval, *, before: bool = False
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
    jets = [(which == i, jet(stretches[i], at[which == i])) for i in present]
    blocks = [each.block for _, each in jets]
    count = len(jets[0][1].terms) if blocks[0] is None else len(blocks[0].middle)
    whole = Interval(np.empty((count, *middle.shape)), np.empty((count, *middle.shape)))
    for (here, each), block in zip(jets, blocks, strict=True):
        if block is None:
            whole.middle[:, here] = each.terms
        else:
            whole.middle[:, here], whole.radius[:, here] = block.middle, block.radius
    return Jet(tuple(whole.middle)) if blocks[0] is None else Jet.of_rows(whole)


def _segments(law: MotionLaw) -> Sequence[Segment]:
    """The law between its breaks: exact for segments or a polynomial, else interpolated to rounding."""
    if isinstance(law, PiecewiseLaw):
        return law.segments
    if isinstance(law, PolynomialLaw):
        return (PolynomialSegment(law.acceleration, law.b0),)
    return [_series(law, start, stop - start) for start, stop in pairwise(law.breaks)]


def _series(law: MotionLaw, start: float, length: float) -> Segment:
    def c(x: Array) -> Array:
        return law.c(start + 0.5 * length * (x + 1.0))

    series = chebyshev.interpolated(c, "acceleration of a law")
    return PolynomialSegment(tuple(series.tolist()), float(law.b(start)))


_MORE = 4  # derivatives that Taylor's formula takes beyond those that are asked


def enclosed_derivatives(segment: Segment, length: float, middle: Array, half: Array, order: int) -> Interval:
    """The derivatives of a segment's displacement by k, from order 0 to one given, anywhere in cells: a row each.

    Cells are given by their middles and half lengths, as shares of the segment; 0 long for single places.

    >>> from optlaws.laws.segments import SineSegment
    >>> slope = enclosed_derivatives(SineSegment(1.0, 3.0), 0.5, np.array([0.5]), np.array([0.01]), 1)[1]
    >>> bool(slope.low[0] < SineSegment(1.0, 3.0).derivative(np.array([0.505]), 0.5, 1)[0] < slope.high[0])
    True
    """
    if isinstance(segment, PowerSegment) and segment.b0 != segment.b1:
        segment = segment.fractional(length)
    if isinstance(segment, FractionalSegment):
        return stacked(_of_powers(segment, length, middle, half, order))
    known = segment if segment.waves(length) is not None else _interpolated(segment, length)
    return _by_taylor(known, length, middle, half, order)


def enclosed_power(segment: Segment, length: float, middle: Array, half: Array, order: int) -> Jet:
    """The Taylor terms by k of the kinetic power d = b c anywhere in cells, finite where c is not.

    >>> power = enclosed_power(PowerSegment(0.0, 2.0), 0.5, np.array([0.0]), np.array([0.0]), 0).terms[0]
    >>> bool(power.low[0] <= 4.0 <= power.high[0]), bool(power.radius[0] < 1e-12)
    (True, True)
    """
    if isinstance(segment, PowerSegment) and segment.b0 != segment.b1:
        segment = segment.fractional(length)
    if not isinstance(segment, FractionalSegment):
        values = enclosed_derivatives(segment, length, middle, half, order + 2)
        velocity = Jet([values[nu + 1] / factorial(nu) for nu in range(order + 2)])
        return velocity * velocity.slope()
    powers, rate = segment.power_powers(length), (segment.last - segment.first) / length
    sums: list[Interval] = []
    for _ in range(order + 1):
        sums.append(_power_sum(powers, *_inside(segment, middle, half)))
        powers = powers.slope(rate)
    return Jet(tuple(value / factorial(nu) for nu, value in enumerate(sums)))


@lru_cache(maxsize=256)
def _interpolated(segment: Segment, length: float) -> Segment:
    return segment.interpolated(length)


def _by_taylor(segment: Segment, length: float, middle: Array, half: Array, order: int) -> Interval:
    last = order + _MORE
    sizes, share = _sizes(segment, length, last)
    with np.errstate(over="ignore", invalid="ignore"):
        values = segment.derivatives(middle, length, last)
        steps, known = half * length * (1.0 + 4.0 * ROUNDOFF), np.empty((last + 1, *middle.shape))
        errors = share * np.array(sizes).reshape(-1, *(1,) * middle.ndim)
        np.add(np.abs(values), errors[:-1], out=known[:-1])
        known[last] = sizes[last]
        powers = np.empty((last, *middle.shape))
        powers[0] = steps
        for i in range(1, last):
            np.multiply(powers[i - 1], steps / (i + 1), out=powers[i, ...])
        radius = np.empty((order + 1, *middle.shape))
        for nu in range(order + 1):
            np.add.reduce(known[nu + 1 :] * powers[: last - nu], out=radius[nu, ...])
    return Interval(values[: order + 1], (radius + errors[: order + 1]) * (1.0 + 64.0 * ROUNDOFF))


@lru_cache(maxsize=512)
def _sizes(segment: Segment, length: float, last: int) -> tuple[tuple[float, ...], float]:
    """Upper bounds of derivatives up to an order and of the sums behind them, and the share that rounding is off."""
    waves = segment.waves(length)
    assert waves is not None  # noqa: S101 - such segments are asked for
    sizes = tuple(_size(waves, length, nu) for nu in range(last + 1))
    swiftest = max((wave.frequency + abs(wave.phase) for wave in waves.sines), default=0.0)
    return sizes, (4.0 * (len(waves.acceleration) + last) + 32.0 * (1.0 + swiftest)) * ROUNDOFF


def _size(waves: Waves, length: float, nu: int) -> float:
    """Sum of the magnitudes of the terms in the derivative of order nu."""
    series = np.abs(np.array(waves.acceleration))
    total = float(series.sum())
    if nu >= 2:
        for _ in range(nu - 2):
            series = chebyshev.derivative(series)
        swings = sum(abs(wave.amplitude) * wave.frequency ** (nu - 2) for wave in waves.sines)
        return float(series.sum()) / length ** (nu - 2) + swings
    # an integral from the start is no more than the length times the greatest value
    swings = sum(2.0 * abs(wave.amplitude) / wave.frequency * (1.0 + 1.0 / wave.frequency) for wave in waves.sines)
    velocity = abs(waves.b0) + 2.0 * length * total + swings
    return velocity if nu else velocity * length + swings


def _of_powers(segment: FractionalSegment, length: float, middle: Array, half: Array, order: int) -> list[Interval]:
    """Sums of real powers, each monotone."""
    inside = _inside(segment, middle, half)
    derivatives = [_power_sum(segment.powers(length, nu), *inside) for nu in range(1, order + 1)]
    at = np.asarray(segment.derivative(middle, length, 0))
    size = abs(segment.steady) * length + float(np.abs(segment.derivative(np.array([0.0, 1.0]), length, 0)).max())
    swiftest = np.abs(derivatives[0].middle) + derivatives[0].radius if order else np.asarray(0.0)
    return [Interval(at, swiftest * half * length * (1.0 + 16.0 * ROUNDOFF) + 64.0 * ROUNDOFF * size), *derivatives]


def _inside(segment: FractionalSegment, middle: Array, half: Array) -> tuple[Array, Array]:
    """The least and the greatest v in cells."""
    ends = [segment.first * (1.0 - u) + segment.last * u for u in (middle - half, middle + half)]
    low, high = np.maximum(np.minimum(*ends), 0.0), np.maximum(*ends)
    slack = 4.0 * ROUNDOFF * max(segment.first, segment.last)
    return np.maximum(low - np.where(low > 0.0, slack, 0.0), 0.0), high + np.where(half > 0.0, slack, 0.0)


def _power_sum(powers: dict[float, float], low: Array, high: Array) -> Interval:
    total = exact(np.zeros(low.shape))
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        for exponent, factor in powers.items():
            first, last = factor * low**exponent, factor * high**exponent
            blurred = 8.0 * ROUNDOFF * (np.abs(first) + np.abs(last))
            total = total + between(np.minimum(first, last) - blurred, np.maximum(first, last) + blurred)
    return total
