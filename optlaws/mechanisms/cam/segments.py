"""Segments of the cam from segments of the mass law, each kind in closed form (1.27)."""

from __future__ import annotations

import cmath
from dataclasses import replace
from functools import singledispatch

import numpy as np
from numpy.typing import NDArray

from optlaws.laws.segments.segment import PolynomialSegment, Segment
from optlaws.laws.segments.sine import HarmonicSegment, SineSegment
from optlaws.series import chebyshev, interpolation

Array = NDArray[np.float64]


@singledispatch
def cam_segment(segment: Segment, length: float, once: float, twice: float) -> Segment:
    """The segment with displacement a + once b + twice c; a kind unknown here becomes a polynomial.

    Parameters
    ----------
    segment
        A segment of the mass law.
    length
        Its length.
    once, twice
        2 n/nu² and 1/nu².

    Raises
    ------
    InputError
        If a segment of an unknown kind is not smooth.

    Examples
    --------
    >>> cam_segment(PolynomialSegment((0.0, 6.0)), 0.5, 0.0, 0.25)
    PolynomialSegment(acceleration=(0.0, 6.0), b0=6.0)
    """

    def c(x: Array) -> Array:
        u = 0.5 * (x + 1.0)
        orders = ((2, 1.0), (3, once), (4, twice))
        return np.asarray(sum(factor * segment.derivative(u, length, order) for order, factor in orders))

    found = interpolation.chebyshev_series(c, f"acceleration of the cam under the {segment.kind} segment")
    return PolynomialSegment(tuple(found.tolist()), _velocity(segment, length, once, twice))


@cam_segment.register
def _(segment: PolynomialSegment, length: float, once: float, twice: float) -> Segment:
    c = np.array(segment.acceleration or (0.0,))
    j = chebyshev.derivative(c) / length
    s = chebyshev.derivative(j) / length
    total = c.copy()
    total[: len(j)] += once * j
    total[: len(s)] += twice * s
    return PolynomialSegment(tuple(total.tolist()), _velocity(segment, length, once, twice))


@cam_segment.register
def _(segment: SineSegment, length: float, once: float, twice: float) -> Segment:
    p0, p1, p2 = (*segment.powers, 0.0, 0.0, 0.0)[:3]
    powers = (p0 + once * p1 + 2.0 * twice * p2, p1 + 2.0 * once * p2, p2)
    amplitude, phase = _wave(segment.amplitude, segment.frequency, segment.phase, (once, twice))
    return replace(
        segment,
        amplitude=amplitude,
        phase=phase,
        b0=_velocity(segment, length, once, twice),
        powers=powers if segment.powers else (),
    )


@cam_segment.register
def _(segment: HarmonicSegment, length: float, once: float, twice: float) -> Segment:
    waves = zip(segment.amplitudes, segment.frequencies, segment.phases, strict=True)
    made = [_wave(*one, (once, twice)) for one in waves]
    return replace(
        segment,
        amplitudes=tuple(amplitude for amplitude, _ in made),
        phases=tuple(phase for _, phase in made),
        b0=_velocity(segment, length, once, twice),
    )


def _wave(amplitude: float, frequency: float, phase: float, factors: tuple[float, float]) -> tuple[float, float]:
    once, twice = factors
    transfer = complex(1.0 - twice * frequency**2, once * frequency)
    if once == 0.0:  # keep the sign in the amplitude, so that the phase stays exact
        return amplitude * transfer.real, phase
    return amplitude * abs(transfer), phase + cmath.phase(transfer)


def _velocity(segment: Segment, length: float, once: float, twice: float) -> float:
    b, c, j = (float(segment.derivative(np.zeros(1), length, order)[0]) for order in (1, 2, 3))
    return b + once * c + twice * j
