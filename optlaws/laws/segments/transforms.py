"""Segments scaled, with a uniform velocity added, run backwards or multiplied; each kind keeps its closed form."""

from __future__ import annotations

from dataclasses import replace
from functools import singledispatch
from math import remainder, tau

import numpy as np
from numpy.typing import NDArray

from optlaws.laws.segments.fractional import FractionalSegment
from optlaws.laws.segments.segment import PolynomialSegment, PowerSegment, Segment
from optlaws.laws.segments.sine import HarmonicSegment, SineSegment
from optlaws.series import chebyshev, interpolation

Array = NDArray[np.float64]
END = np.ones(1)


@singledispatch
def scaled(segment: Segment, length: float, scale: float, drift: float = 0.0) -> Segment:
    """The segment whose velocity is scale b + drift; a kind unknown here becomes a polynomial, to machine accuracy.

    Examples
    --------
    >>> scaled(PowerSegment(0.0, 1.5), 0.5, 2.0)
    PowerSegment(b0=0.0, b1=3.0)
    """
    return scaled(interpolated(segment, length), length, scale, drift)


@singledispatch
def backwards(segment: Segment, length: float) -> Segment:
    """The segment whose velocity is b(length - s); a kind unknown here becomes a polynomial, to machine accuracy.

    Examples
    --------
    >>> backwards(PowerSegment(0.0, 1.5), 0.5)
    PowerSegment(b0=1.5, b1=0.0)
    """
    return backwards(interpolated(segment, length), length)


def interpolated(segment: Segment, length: float) -> PolynomialSegment:
    """The segment with its acceleration interpolated to machine accuracy.

    Raises
    ------
    InputError
        If the acceleration is not smooth on the segment.

    Examples
    --------
    >>> len(interpolated(SineSegment(1.0, 3.0), 0.5).acceleration)
    13
    """

    def c(x: Array) -> Array:
        return segment.derivative(0.5 * (x + 1.0), length, 2)

    found = interpolation.chebyshev_series(c, f"acceleration of the {segment.kind} segment")
    return PolynomialSegment(tuple(found.tolist()), float(segment.derivative(np.zeros(1), length, 1)[0]))


def multiplied(segment: Segment, length: float, y: Array) -> Segment:
    """The segment whose acceleration is c times the Chebyshev series y in 2u - 1, with the same velocity at first.

    Polynomials and fractional powers stay what they are; others are interpolated to machine accuracy.

    Examples
    --------
    >>> multiplied(PolynomialSegment((0.0, 2.0), 1.0), 0.5, np.array([3.0]))
    PolynomialSegment(acceleration=(0.0, 6.0), b0=1.0)
    """
    if isinstance(segment, PowerSegment):
        segment = fractional(segment, length)
    if isinstance(segment, FractionalSegment):
        return _multiplied_powers(segment, y)
    if isinstance(segment, PolynomialSegment):
        acceleration = np.array(segment.acceleration or (0.0,))
        return replace(segment, acceleration=tuple(chebyshev.product(acceleration, y).tolist()))

    def c(x: Array) -> Array:
        return segment.derivative(0.5 * (x + 1.0), length, 2) * chebyshev.value(y, x)

    found = interpolation.chebyshev_series(c, f"acceleration of the {segment.kind} segment times y")
    return PolynomialSegment(tuple(found.tolist()), float(segment.derivative(np.zeros(1), length, 1)[0]))


def fractional(segment: PowerSegment, length: float) -> FractionalSegment:
    """Constant kinetic power as a power -1/2 of time.

    Examples
    --------
    >>> fractional(PowerSegment(0.0, 2.0), 0.5)
    FractionalSegment(exponent=-0.5, first=0.0, last=4.0, coefficients=(4.0,), steady=0.0)
    """
    sign = 1.0 if segment.b0 + segment.b1 > 0.0 else -1.0
    first, last = segment.b0**2, segment.b1**2
    return FractionalSegment(-0.5, first, last, (sign * 0.5 * (last - first) / length,))


def _multiplied_powers(segment: FractionalSegment, y: Array) -> FractionalSegment:
    # x = 2u - 1 is straight in v: x = (2v - first - last) / (last - first)
    span = segment.last - segment.first
    place = np.polynomial.Polynomial([-(segment.first + segment.last) / span, 2.0 / span])
    factor = np.polynomial.Polynomial(np.polynomial.chebyshev.cheb2poly(y))(place)
    changed = np.polynomial.Polynomial(segment.coefficients) * factor
    return replace(segment, coefficients=tuple(changed.coef.tolist()))


@scaled.register
def _(segment: PolynomialSegment, length: float, scale: float, drift: float = 0.0) -> Segment:  # noqa: ARG001
    return PolynomialSegment(tuple(scale * one for one in segment.acceleration), scale * segment.b0 + drift)


@scaled.register
def _(segment: SineSegment, length: float, scale: float, drift: float = 0.0) -> Segment:  # noqa: ARG001
    powers = tuple(scale * one for one in segment.powers)
    return replace(segment, amplitude=scale * segment.amplitude, b0=scale * segment.b0 + drift, powers=powers)


@scaled.register
def _(segment: HarmonicSegment, length: float, scale: float, drift: float = 0.0) -> Segment:  # noqa: ARG001
    amplitudes = tuple(scale * one for one in segment.amplitudes)
    return replace(segment, amplitudes=amplitudes, b0=scale * segment.b0 + drift)


@scaled.register
def _(segment: FractionalSegment, length: float, scale: float, drift: float = 0.0) -> Segment:  # noqa: ARG001
    coefficients = tuple(scale * one for one in segment.coefficients)
    return replace(segment, coefficients=coefficients, steady=scale * segment.steady + drift)


@scaled.register
def _(segment: PowerSegment, length: float, scale: float, drift: float = 0.0) -> Segment:
    if drift == 0.0 and scale != 0.0:
        return PowerSegment(scale * segment.b0, scale * segment.b1)
    if segment.b0 == segment.b1:
        return PolynomialSegment((), scale * segment.b0 + drift)
    return scaled(fractional(segment, length), length, scale, drift)


@backwards.register
def _(segment: PolynomialSegment, length: float) -> Segment:
    turned = (one if n % 2 else -one for n, one in enumerate(segment.acceleration))
    return PolynomialSegment(tuple(turned), _last_velocity(segment, length))


@backwards.register
def _(segment: SineSegment, length: float) -> Segment:
    p0, p1, p2 = (*segment.powers, 0.0, 0.0, 0.0)[:3]
    powers = (-(p0 + p1 * length + p2 * length * length), p1 + 2.0 * p2 * length, -p2)
    phase = _turned(segment.frequency, segment.phase, length)
    return replace(segment, phase=phase, b0=_last_velocity(segment, length), powers=powers if segment.powers else ())


@backwards.register
def _(segment: HarmonicSegment, length: float) -> Segment:
    pairs = zip(segment.frequencies, segment.phases, strict=True)
    phases = tuple(_turned(frequency, phase, length) for frequency, phase in pairs)
    return replace(segment, phases=phases, b0=_last_velocity(segment, length))


@backwards.register
def _(segment: FractionalSegment, length: float) -> Segment:  # noqa: ARG001
    changed = tuple(-one for one in segment.coefficients)
    return replace(segment, first=segment.last, last=segment.first, coefficients=changed)


@backwards.register
def _(segment: PowerSegment, length: float) -> Segment:  # noqa: ARG001
    return PowerSegment(segment.b1, segment.b0)


def _turned(frequency: float, phase: float, length: float) -> float:
    # -sin(w (L - s) + phi) = sin(w s - (w L + phi))
    return remainder(-(frequency * length + phase), tau)


def _last_velocity(segment: Segment, length: float) -> float:
    return float(segment.derivative(END, length, 1)[0])
