"""Displacements between two angles with every derivative enclosed, by Taylor's formula with its remainder.

What is known of a segment's derivatives everywhere bounds the remainder: of a Chebyshev series the sum of its
coefficients' sizes, of a sine its amplitude times a power of its frequency. Sums of real powers are monotone term by
term. Segments of other kinds are those of their interpolants, which are them to rounding.
"""

from __future__ import annotations

from functools import lru_cache
from math import factorial

import numpy as np
from numpy.typing import NDArray

from optlaws.cams.curves.jets import Jet
from optlaws.cams.curves.motion_by_angle import Stretch
from optlaws.cams.extremes.enclosure import ROUNDING, Enclosure, exact
from optlaws.laws.segments.constant_power import PowerSegment
from optlaws.laws.segments.fractional import FractionalSegment
from optlaws.laws.segments.segment import Segment, Waves
from optlaws.series import chebyshev

Array = NDArray[np.float64]

_MORE = 4  # derivatives that Taylor's formula takes beyond those that are asked


def enclosed_jet(stretch: Stretch, middle: Array, half: Array, order: int) -> Jet:
    """The jet of the displacement by the cam's angle, anywhere in cells of a stretch.

    Parameters
    ----------
    stretch
        A smooth part of a motion.
    middle, half
        The cells' middles and half lengths, as shares of the stretch; 0 long for single places.
    order
        How many derivatives.

    Examples
    --------
    >>> from optlaws.cams.curves.motion_by_angle import CamMotion
    >>> rise = CamMotion.of_law("cycloidal", "40 mm", "120 deg").stretches[0]
    >>> slope = enclosed_jet(rise, np.array([0.5]), np.array([0.01]), 1).terms[1]
    >>> bool(slope.low[0] < rise.values(np.array([1.05]), 1)[0] < slope.high[0])
    True
    """
    if stretch.stroke == 0.0:
        return Jet((exact(np.full(middle.shape, stretch.offset)), *(exact(np.zeros(middle.shape)),) * order))
    values = _of_segment(stretch.segment, stretch.length, middle, half, order)
    terms = [
        _scaled(value, stretch.stroke / stretch.duration**nu / factorial(nu), (nu + 3) * ROUNDING)
        for nu, value in enumerate(values)
    ]
    return Jet((terms[0] + stretch.offset, *terms[1:]))


def _scaled(enclosure: Enclosure, factor: float, rounding: float) -> Enclosure:
    return enclosure * Enclosure(np.array(factor), np.array(abs(factor) * rounding))


def _of_segment(segment: Segment, length: float, middle: Array, half: Array, order: int) -> list[Enclosure]:
    if isinstance(segment, PowerSegment) and segment.b0 != segment.b1:
        segment = segment.fractional(length)
    if isinstance(segment, FractionalSegment):
        return _of_powers(segment, length, middle, half, order)
    waves = segment.waves(length)
    known = segment if waves is not None else _interpolated(segment, length)
    return _by_taylor(known, length, middle, half, order)


@lru_cache(maxsize=256)
def _interpolated(segment: Segment, length: float) -> Segment:
    return segment.interpolated(length)


def _by_taylor(segment: Segment, length: float, middle: Array, half: Array, order: int) -> list[Enclosure]:
    last = order + _MORE
    sizes, share = _sizes(segment, length, last)
    with np.errstate(over="ignore"):
        values = [np.asarray(segment.derivative(middle, length, nu)) for nu in range(last)]
    errors = [share * size for size in sizes]
    steps = half * length * (1.0 + 4.0 * ROUNDING)
    enclosures = []
    for nu in range(order + 1):
        radius = sizes[last] * steps ** (last - nu) / factorial(last - nu)
        for i in range(last - nu - 1, 0, -1):
            radius = radius + (np.abs(values[nu + i]) + errors[nu + i]) * steps**i / factorial(i)
        enclosures.append(Enclosure(values[nu], (radius + errors[nu]) * (1.0 + 64.0 * ROUNDING)))
    return enclosures


@lru_cache(maxsize=512)
def _sizes(segment: Segment, length: float, last: int) -> tuple[tuple[float, ...], float]:
    """What no derivative up to an order exceeds, nor the sums behind it; and by which share of it rounding is off."""
    waves = segment.waves(length)
    assert waves is not None  # noqa: S101 - such segments are asked for
    sizes = tuple(_size(waves, length, nu) for nu in range(last + 1))
    swiftest = max((wave.frequency + abs(wave.phase) for wave in waves.sines), default=0.0)
    return sizes, (4.0 * (len(waves.acceleration) + last) + 32.0 * (1.0 + swiftest)) * ROUNDING


def _size(waves: Waves, length: float, nu: int) -> float:
    """Sum of the magnitudes of what the derivative of order nu is made of."""
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


def _of_powers(segment: FractionalSegment, length: float, middle: Array, half: Array, order: int) -> list[Enclosure]:
    """Sums of real powers, each monotone."""
    ends = [segment.first * (1.0 - u) + segment.last * u for u in (middle - half, middle + half)]
    low, high = np.maximum(np.minimum(*ends), 0.0), np.maximum(*ends)
    slack = 4.0 * ROUNDING * max(segment.first, segment.last)
    inside = np.maximum(low - np.where(low > 0.0, slack, 0.0), 0.0), high + np.where(half > 0.0, slack, 0.0)
    derivatives = [_power_sum(segment.powers(length, nu), *inside) for nu in range(1, order + 1)]
    at = np.asarray(segment.derivative(middle, length, 0))
    size = abs(segment.steady) * length + float(np.abs(segment.derivative(np.array([0.0, 1.0]), length, 0)).max())
    swiftest = np.abs(derivatives[0].middle) + derivatives[0].radius if order else np.asarray(0.0)
    return [Enclosure(at, swiftest * half * length * (1.0 + 16.0 * ROUNDING) + 64.0 * ROUNDING * size), *derivatives]


def _power_sum(powers: dict[float, float], low: Array, high: Array) -> Enclosure:
    total = exact(np.zeros(low.shape))
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        for exponent, factor in powers.items():
            one, two = factor * low**exponent, factor * high**exponent
            middle, radius = 0.5 * (one + two), 0.5 * np.abs(two - one) + 8.0 * ROUNDING * (np.abs(one) + np.abs(two))
            known = np.isfinite(middle) & np.isfinite(radius)
            total = total + Enclosure(np.where(known, middle, 0.0), np.where(known, radius, np.inf))
    return total
