"""A mass on a spring: its free vibration by one formula for all damping ratios, and its equation on a moving cam."""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, atanh, hypot, pi, sqrt

import numpy as np

from optlaws.kept import kept_property
from optlaws.laws import Peak
from optlaws.mechanisms.machine.dynamics import Dynamics
from optlaws.numbers import Array

_STIFF = 8.0  # radians in the rise: slower vibrations are slower than most laws


@dataclass(frozen=True)
class Oscillator:
    """The equation of a follower: frequency nu in radians in the rise's duration, ratio zeta = n/nu.

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

    @kept_property
    def lag(self) -> float:
        """The time by which damping makes a stiff mass lag its cam, 2 n/nu²; 0 of a soft one, which hardly follows."""
        return 2.0 * self.n / self.frequency**2 if self.frequency > _STIFF else 0.0

    @kept_property
    def on_cam(self) -> Dynamics:
        """The motion on a cam, by the states a_m - (a - lag b) and a_m' - b.

        They are as small as the acceleration of the mass, whatever the damping: displacements of cam and mass would
        cancel nu² times their rounding, and a_m - a and b n times theirs.
        """
        left = 0.0 if self.lag else -2.0 * self.n
        matrix = np.array([[0.0, 1.0], [-(self.frequency**2), -2.0 * self.n]])
        return Dynamics(matrix, np.array([[0.0, 0.0, self.lag], [0.0, left, -1.0]]))

    @property
    def orders(self) -> Array:
        """Rows that take the states on a cam, then a, b and c, to a_m and its derivatives up to the jerk."""
        square, twice = self.frequency**2, 2.0 * self.n
        left = 0.0 if self.lag else -twice
        acceleration = np.array([-square, -twice, 0.0, left, 0.0])
        jerk = np.array([0.0, -square, 0.0, 0.0, 0.0]) - twice * acceleration
        return np.array([[1.0, 0.0, 1.0, -self.lag, 0.0], [0.0, 1.0, 0.0, 1.0, 0.0], acceleration, jerk])
