"""Free vibration: h'' + 2 n h' + nu² h = 0, below, at and above critical damping by one formula."""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, atanh, hypot, pi, sqrt

import numpy as np

from optlaws.kept import kept_property
from optlaws.laws import Peak
from optlaws.numbers import Array


@dataclass(frozen=True)
class Oscillator:
    """The homogeneous equation of a follower: frequency nu in radians in the rise's duration, ratio zeta = n/nu.

    >>> Oscillator(5.0, 0.6).damped, Oscillator(5.0, 1.25).damped
    (4.0, 0.0)
    """

    frequency: float
    damping: float

    @property
    def n(self) -> float:
        """Decay n = zeta nu."""
        return self.damping * self.frequency

    @kept_property
    def damped(self) -> float:
        """lambda = nu sqrt(1 - zeta²) below critical damping, else 0."""
        return self.frequency * sqrt(max(0.0, (1.0 - self.damping) * (1.0 + self.damping)))

    @kept_property
    def _spread(self) -> float:
        return self.frequency * sqrt(max(0.0, (self.damping - 1.0) * (1.0 + self.damping)))

    @kept_property
    def fastest(self) -> float:
        """The largest magnitude of a root of the characteristic equation."""
        return max(self.frequency, self.n + self._spread)

    def even_odd(self, s: Array) -> tuple[Array, Array]:
        """exp(-n s) cos(lambda s) and exp(-n s) sin(lambda s) / lambda, or what becomes of them past critical."""
        if self.damping <= 1.0:
            decay, phase = np.exp(-self.n * s), self.damped * s
            return decay * np.cos(phase), decay * s * np.sinc(phase / pi)
        twice = 2.0 * self._spread * s
        slow = np.exp(-(self.frequency**2) / (self.n + self._spread) * s)
        safe = np.where(twice == 0.0, 1.0, twice)
        ratio = np.where(twice == 0.0, 1.0, -np.expm1(-safe) / safe)
        return 0.5 * slow * (1.0 + np.exp(-twice)), slow * s * ratio

    def motion(self, h0: float, v0: float, s: Array, nu: int) -> Array:
        """Derivative of order `nu` at s of the vibration with displacement h0 and velocity v0 at s = 0."""
        for _ in range(nu):
            h0, v0 = v0, -2.0 * self.n * v0 - self.frequency**2 * h0
        even, odd = self.even_odd(s)
        return h0 * even + (v0 + self.n * h0) * odd

    def amplitude(self, h0: float, v0: float) -> float:
        """Amplitude of the envelope at s = 0 below critical damping (1.21); else the greatest |h| from s = 0 on."""
        if self.damped > 0.0:
            return hypot(h0, (v0 + self.n * h0) / self.damped)
        return self.peak(h0, v0, 0).value

    def peak(self, h0: float, v0: float, nu: int) -> Peak:
        """Greatest magnitude of the derivative of order `nu` from s = 0 on, and its place s."""
        for _ in range(nu):
            h0, v0 = v0, -2.0 * self.n * v0 - self.frequency**2 * h0
        places = np.array([0.0, self._first_stop(h0, v0)])
        size = np.abs(self.motion(h0, v0, places, 0))
        best = int(np.argmax(size))
        return Peak(float(size[best]), float(places[best]))

    def _first_stop(self, h0: float, v0: float) -> float:
        """The first s > 0 of zero velocity; 0 without such an s."""
        pull = self.n * v0 + self.frequency**2 * h0
        if self.damped > 0.0:
            angle = atan2(self.damped * v0, pull) if pull else 0.5 * pi
            return (angle % pi) / self.damped
        if pull == 0.0 or v0 / pull <= 0.0:
            return 0.0
        if self._spread == 0.0:
            return v0 / pull
        ratio = self._spread * v0 / pull
        return atanh(ratio) / self._spread if ratio < 1.0 else 0.0
