"""Particular solutions of u'' + 2 n u' + nu² u = -(c + 2 n b), u = a_m - a, the mass's deviation from its cam.

The closed form, (1.25) in Chebyshev series or the transfer function of a sine, sums derivatives of the law divided by
powers of nu. Where these grow instead of falling, because nu is small for the law, the closed form is a large number
that the free vibration must cancel; there u is sought as the Chebyshev series that starts from rest, from the integral
equation for u'', on stretches of a few radians each. Both are exact but for rounding.
"""

from __future__ import annotations

import cmath
from dataclasses import dataclass
from math import ceil
from typing import Protocol

import numpy as np

from optlaws.mechanisms.forcing import Forcing, PolynomialMotion
from optlaws.mechanisms.vibration import Oscillator
from optlaws.numbers import Array
from optlaws.numerics import chebyshev

GROWTH = 100.0  # the closed form may be this much larger than the forcing: it costs two digits of sixteen
RADIANS = 10.0  # length of the stretches where the integral equation is solved
WAVE_TERMS = 41
SPARE = 31  # coefficients beyond those of the forcing that resolve the vibration on such a stretch


class Particular(Protocol):
    """A particular solution over a stretch."""

    def derivative(self, s: Array, nu: int) -> Array:
        """Derivative of order `nu` of u, s counted from the stretch's start."""
        ...


@dataclass(frozen=True, eq=False)
class ForcedStretch:
    """A part of a forcing from an offset on, with a particular solution, `closed` where that is the closed form."""

    forcing: Forcing
    offset: float
    length: float
    particular: Particular
    closed: bool

    @property
    def start(self) -> float:
        """Time at which it begins."""
        return self.forcing.start + self.offset

    def cam(self, s: Array, nu: int) -> Array:
        """Derivative of order `nu` of the cam's displacement, s counted from the stretch's start."""
        return self.forcing.derivative(np.minimum(self.offset + s, self.forcing.length), nu)


@dataclass(frozen=True, eq=False)
class SineSolution:
    """A polynomial and the real parts of amplitude exp(i frequency s)."""

    steady: PolynomialMotion
    waves: tuple[tuple[complex, float], ...]

    def derivative(self, s: Array, nu: int) -> Array:
        """Derivative of order `nu` at s."""
        values = self.steady.derivative(s, nu)
        for amplitude, frequency in self.waves:
            turned = amplitude * (1j * frequency) ** nu
            values += turned.real * np.cos(frequency * s) - turned.imag * np.sin(frequency * s)
        return values


def stretches(forcing: Forcing, oscillator: Oscillator) -> list[ForcedStretch]:
    """A forcing with particular solutions: the closed form, or short stretches where that would cancel."""
    closed = _closed(forcing, oscillator)
    if closed is not None:
        return [ForcedStretch(forcing, 0.0, forcing.length, closed, closed=True)]
    return _solved(forcing, oscillator)


def closed_form(load: Array, oscillator: Oscillator, length: float) -> PolynomialMotion | None:
    """The polynomial u with u'' + 2 n u' + nu² u = -load (1.25); None where it is large beside the load.

    >>> closed_form(np.array([8.0]), Oscillator(2.0, 0.0), 1.0).series[0].tolist()
    [-2.0]
    """
    size = len(load)
    u, v, w = np.zeros(size + 2), np.zeros(size + 2), np.zeros(size + 2)
    steps = 4.0 / length * np.arange(size + 2)
    twice, square = 2.0 * oscillator.n, oscillator.frequency**2
    most = GROWTH * float(np.abs(load).sum())
    sum_of_u = 0.0
    for i in range(size - 1, -1, -1):
        v[i] = v[i + 2] + steps[i + 1] * u[i + 1]
        w[i] = w[i + 2] + steps[i + 1] * v[i + 1]
        if i == 0:
            v[0], w[0] = 0.5 * v[0], 0.5 * w[0]
        u[i] = -(load[i] + twice * v[i] + w[i]) / square
        sum_of_u += abs(float(u[i]))
        if square * sum_of_u > most:
            return None
    return PolynomialMotion(length, (u[:size], v[:size], w[:size]))


def _load(acceleration: Array, velocity: Array, oscillator: Oscillator) -> Array:
    load = 2.0 * oscillator.n * velocity
    load[: len(acceleration)] += acceleration
    return load


def _closed(forcing: Forcing, oscillator: Oscillator) -> Particular | None:
    n, square = oscillator.n, oscillator.frequency**2
    waves: list[tuple[complex, float]] = []
    b0 = forcing.b0
    for sine in forcing.sines:
        w = sine.frequency
        # c is the real part of amplitude exp(i w s) and a polynomial, and b its integral from b0
        amplitude = -1j * sine.amplitude * cmath.exp(1j * sine.phase)
        velocity = amplitude / (1j * w)
        b0 -= velocity.real
        stiffness = complex(square - w * w, 2.0 * n * w)
        if abs(stiffness) * GROWTH < square:
            return None
        waves.append((-(amplitude + 2.0 * n * velocity) / stiffness, w))
    velocities = chebyshev.integral(forcing.length * forcing.acceleration, b0)
    steady = closed_form(_load(forcing.acceleration, velocities, oscillator), oscillator, forcing.length)
    return SineSolution(steady, tuple(waves)) if steady is not None and waves else steady


def _solved(forcing: Forcing, oscillator: Oscillator) -> list[ForcedStretch]:
    fastest = max(oscillator.fastest, *(sine.frequency for sine in forcing.sines), 0.0)
    terms = max(len(forcing.acceleration) + 1, WAVE_TERMS if forcing.sines else 0)
    count = max(1, ceil(fastest * forcing.length / RADIANS))
    length = forcing.length / count
    size = terms + SPARE
    x = chebyshev.nodes(terms)
    offsets = length * np.arange(count)
    s = np.minimum(offsets + 0.5 * length * (x[:, None] + 1.0), forcing.length)
    values = forcing.derivative(s, 2) + 2.0 * oscillator.n * forcing.derivative(s, 1)
    load = np.zeros((size, count))
    load[:terms] = chebyshev.from_values(values)
    integral = length * _integration(size)
    matrix = np.eye(size) + 2.0 * oscillator.n * integral + oscillator.frequency**2 * (integral @ integral)
    coefficients: Array = np.asarray(np.linalg.solve(matrix, -load), dtype=np.float64)
    solved = []
    for i in range(count):
        w = coefficients[:, i]
        v = chebyshev.integral(length * w, 0.0)
        solution = PolynomialMotion(length, (chebyshev.integral(length * v, 0.0), v, w))
        solved.append(ForcedStretch(forcing, float(offsets[i]), length, solution, closed=False))
    return solved


def _integration(size: int) -> Array:
    """Matrix of the integral over [0, 1] from 0 of a Chebyshev series, cut to `size` coefficients."""
    return np.array([chebyshev.integral(row, 0.0)[:size] for row in np.eye(size)]).T
