"""Sine segments of piecewise laws, for cycloids, modified sines and trapezoids; sums of sines, for harmonics."""

from __future__ import annotations

import cmath
from abc import abstractmethod
from dataclasses import dataclass, replace
from math import acos, asin, ceil, copysign, cos, hypot, pi, remainder, sqrt, tau

import numpy as np
from numpy.polynomial.polynomial import polyval

from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.laws.segments.segment import Segment, Wave, Waves
from optlaws.numbers import Array
from optlaws.numerics.panels import of_waves
from optlaws.tolerances import TOUCHING

_SLOWEST_FREQUENCY = 1e-150  # of a sine: below it the sides of a swing overflow


class SwingingSegment(Segment):
    """A segment with vibration, whose extremes are searched in panels shorter than its highest frequency's period."""

    @property
    @abstractmethod
    def _fastest(self) -> float:
        """The highest frequency, radians per unit of k."""

    def candidates(self, length: float, nu: int) -> Array:
        return of_waves(self._fastest, length).roots(
            lambda u: self.derivative(u, length, nu + 1), lambda u: length * self.derivative(u, length, nu + 2)
        )

    def power_candidates(self, length: float) -> Array:
        def slope(u: Array) -> Array:
            b, c, j = (self.derivative(u, length, nu) for nu in (1, 2, 3))
            return c * c + b * j

        def curvature(u: Array) -> Array:
            b, c, j, s = (self.derivative(u, length, nu) for nu in (1, 2, 3, 4))
            return length * (3.0 * c * j + b * s)

        return of_waves(self._fastest, length).roots(slope, curvature)

    def square(self, length: float, nu: int) -> float:
        return length * of_waves(self._fastest, length).square(lambda u: self.derivative(u, length, nu))


@dataclass(frozen=True)
class SineSegment(SwingingSegment, kind="sine"):
    """Acceleration c = p0 + p1 s + p2 s² + A sin(w s + phi) of s = k - start; velocity b0 at the start.

    Parameters
    ----------
    amplitude, frequency, phase
        A, w > 0 and phi; w in radians per unit of k.
    b0
        Velocity at the segment's start.
    powers
        Up to three numbers p0, p1, p2.

    Examples
    --------
    >>> segment = SineSegment(amplitude=2 * np.pi, frequency=2 * np.pi)
    >>> segment.derivative(np.array([0.5, 1.0]), 1.0, 0).round(12)
    array([0.5, 1. ])
    """

    amplitude: float
    frequency: float
    phase: float = 0.0
    b0: float = 0.0
    powers: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        self._check()
        if self.frequency < _SLOWEST_FREQUENCY or len(self.powers) > 3:
            raise InputError(f"a sine segment needs frequency > 0 and at most three powers, got {self}")

    def derivative(self, u: Array, length: float, nu: int) -> Array:
        s, w = u * length, self.frequency
        steady = polyval(s, self._steady[min(nu, len(self._steady) - 1)]) if self.powers else 0.0
        if nu >= 2:
            # a shift of the phase by quarter turns is a change of function: no rounding of multiples of pi
            turned = (np.sin, np.cos, lambda x: -np.sin(x), lambda x: -np.cos(x))[(nu - 2) % 4]
            return np.asarray(steady + self.amplitude * w ** (nu - 2) * turned(w * s + self.phase), dtype=np.float64)
        half = 0.5 * w * s
        if nu == 1:
            swing = 2.0 * np.sin(half + self.phase) * np.sin(half)
        else:
            swing = s * cos(self.phase) - 2.0 / w * np.cos(half + self.phase) * np.sin(half)
        start = self.b0 if nu else self.b0 * s
        return np.asarray(start + steady + self.amplitude / w * swing, dtype=np.float64)

    def candidates(self, length: float, nu: int) -> Array:
        if nu == 0 or self.amplitude == 0.0 or len(self.powers) > nu:
            return super().candidates(length, nu)
        # c and its derivatives are a sine and a constant
        level = -self._steady[nu + 1][0] if self.powers and nu + 1 < len(self._steady) else 0.0
        sine = level / (self.amplitude * self.frequency ** (nu - 1))
        if abs(sine) > 1.0 + TOUCHING:
            return np.empty(0)
        angle = asin(max(-1.0, min(1.0, sine)))
        return self._places(length, 0.5 * pi * (1 - nu) + angle, 0.5 * pi * (3 - nu) - angle)

    def power_candidates(self, length: float) -> Array:
        if self.powers or self.amplitude == 0.0:
            return super().power_candidates(length)
        # b = A / w (r - x), c² = A² (1 - x²) and j = A w x with x = cos(w s + phi): c² + b j = 0 is a quadratic in x
        r = self.b0 * self.frequency / self.amplitude + cos(self.phase)
        far = 0.25 * (r + copysign(hypot(r, sqrt(8.0)), r))
        angles = [acos(x) for x in (far, -0.5 / far) if abs(x) <= 1.0]
        return self._places(length, *angles, *(-angle for angle in angles))

    def _places(self, length: float, *phases: float) -> Array:
        """Every u inside the segment at which w s + phi is one of the phases, but for whole turns."""
        radians = self.frequency * length
        first = np.array([(phase - self.phase) % tau for phase in phases])
        u = (first[:, None] + tau * np.arange(ceil(radians / tau) + 1)).ravel() / radians
        inside: Array = u[u < 1.0]
        return inside

    def scaled(self, length: float, scale: float, drift: float = 0.0) -> Segment:  # noqa: ARG002 - others need it
        powers = tuple(scale * power for power in self.powers)
        return replace(self, amplitude=scale * self.amplitude, b0=scale * self.b0 + drift, powers=powers)

    def backwards(self, length: float) -> Segment:
        p0, p1, p2 = self._three_powers
        powers = (-(p0 + p1 * length + p2 * length * length), p1 + 2.0 * p2 * length, -p2)
        phase = _turned(self.frequency, self.phase, length)
        return replace(self, phase=phase, b0=self.velocity(length, last=True), powers=powers if self.powers else ())

    def plus_derivatives(self, length: float, once: float, twice: float) -> Segment:
        p0, p1, p2 = self._three_powers
        powers = (p0 + once * p1 + 2.0 * twice * p2, p1 + 2.0 * once * p2, p2)
        amplitude, phase = _transferred(self.amplitude, self.frequency, self.phase, (once, twice))
        return replace(
            self,
            amplitude=amplitude,
            phase=phase,
            b0=self._velocity_plus(length, once, twice),
            powers=powers if self.powers else (),
        )

    def waves(self, length: float) -> Waves:
        wave = Wave(self.amplitude, self.frequency, self.phase)
        if not self.powers:
            return Waves((0.0,), self.b0, (wave,))
        (p0, p1, p2), h = self._three_powers, 0.5 * length
        steady = (p0 + p1 * h + 1.5 * p2 * h * h, p1 * h + 2.0 * p2 * h * h, 0.5 * p2 * h * h)
        return Waves(steady, self.b0, (wave,))

    @property
    def _three_powers(self) -> tuple[float, float, float]:
        p0, p1, p2 = (*self.powers, 0.0, 0.0, 0.0)[:3]
        return p0, p1, p2

    @kept_property
    def _steady(self) -> tuple[Array, ...]:
        """The share of the powers in a, b, c and the derivatives above, to the first that is zero."""
        whole = np.polynomial.Polynomial([*self.powers, 0.0]).integ(2)
        return tuple(np.asarray(whole.deriv(nu).coef, dtype=np.float64) for nu in range(len(self.powers) + 3))

    @property
    def _fastest(self) -> float:
        return self.frequency


@dataclass(frozen=True)
class HarmonicSegment(SwingingSegment, kind="harmonics"):
    """Acceleration c = sum of A sin(w s + phi) of s = k - start; velocity b0 at the start.

    Parameters
    ----------
    amplitudes, frequencies, phases
        As many A as w > 0 and phi, at least one of each; w in radians per unit of k.
    b0
        Velocity at the segment's start.

    Examples
    --------
    >>> segment = HarmonicSegment(amplitudes=(6.0, 1.0), frequencies=(2 * np.pi, 6 * np.pi), phases=(0.0, 0.0))
    >>> segment.derivative(np.array([0.25]), 1.0, 2).round(12)
    array([5.])
    """

    amplitudes: tuple[float, ...]
    frequencies: tuple[float, ...]
    phases: tuple[float, ...]
    b0: float = 0.0

    def __post_init__(self) -> None:
        self._check()
        alike = len({len(numbers) for numbers in (self.amplitudes, self.frequencies, self.phases)}) == 1
        if not alike or not self.amplitudes or min(self.frequencies) <= 0.0:
            raise InputError(f"a harmonic segment needs as many amplitudes as frequencies > 0 and phases, got {self}")

    @kept_property
    def sines(self) -> tuple[SineSegment, ...]:
        """Sines whose sum the segment is; the first one has the velocity at the start."""
        waves = zip(self.amplitudes, self.frequencies, self.phases, strict=True)
        return tuple(SineSegment(*wave, b0=0.0 if i else self.b0) for i, wave in enumerate(waves))

    def derivative(self, u: Array, length: float, nu: int) -> Array:
        return np.asarray(sum(sine.derivative(u, length, nu) for sine in self.sines), dtype=np.float64)

    @property
    def _fastest(self) -> float:
        return max(self.frequencies)

    def scaled(self, length: float, scale: float, drift: float = 0.0) -> Segment:  # noqa: ARG002 - others need it
        amplitudes = tuple(scale * amplitude for amplitude in self.amplitudes)
        return replace(self, amplitudes=amplitudes, b0=scale * self.b0 + drift)

    def backwards(self, length: float) -> Segment:
        pairs = zip(self.frequencies, self.phases, strict=True)
        phases = tuple(_turned(frequency, phase, length) for frequency, phase in pairs)
        return replace(self, phases=phases, b0=self.velocity(length, last=True))

    def plus_derivatives(self, length: float, once: float, twice: float) -> Segment:
        transferred = [_transferred(*wave, (once, twice)) for wave in self._waves]
        return replace(
            self,
            amplitudes=tuple(amplitude for amplitude, _ in transferred),
            phases=tuple(phase for _, phase in transferred),
            b0=self._velocity_plus(length, once, twice),
        )

    def waves(self, length: float) -> Waves:  # noqa: ARG002 - what others of its kind need
        return Waves((0.0,), self.b0, self._waves)

    @property
    def _waves(self) -> tuple[Wave, ...]:
        return tuple(map(Wave, self.amplitudes, self.frequencies, self.phases))


def _turned(frequency: float, phase: float, length: float) -> float:
    # -sin(w (L - s) + phi) = sin(w s - (w L + phi))
    return remainder(-(frequency * length + phase), tau)


def _transferred(amplitude: float, frequency: float, phase: float, factors: tuple[float, float]) -> tuple[float, float]:
    """Amplitude and phase of a + once b + twice c where a is a sine."""
    once, twice = factors
    transfer = complex(1.0 - twice * frequency**2, once * frequency)
    if once == 0.0:  # keep the sign in the amplitude, so that the phase stays exact
        return amplitude * transfer.real, phase
    return amplitude * abs(transfer), phase + cmath.phase(transfer)
