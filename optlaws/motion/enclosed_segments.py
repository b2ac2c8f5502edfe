"""Segments of laws with every derivative enclosed in cells, by Taylor's formula with its remainder.

What is known of a segment's derivatives everywhere bounds the remainder: of a Chebyshev series the sum of its
coefficients' sizes, of a sine its amplitude times a power of its frequency. Sums of real powers are monotone term by
term. Segments of other kinds are those of their interpolants, which are them to rounding.
"""

from __future__ import annotations

from functools import lru_cache
from math import factorial

import numpy as np

from optlaws.laws.segments.constant_power import PowerSegment
from optlaws.laws.segments.fractional import FractionalSegment
from optlaws.laws.segments.segment import Segment, Waves
from optlaws.numbers import Array
from optlaws.numerics import chebyshev, real_powers
from optlaws.numerics.interval import Interval, between, exact, stacked
from optlaws.numerics.taylor import Jet
from optlaws.tolerances import ROUNDOFF

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
        powers = {exponent: rate * factor for exponent, factor in real_powers.derivative(powers).items()}
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
