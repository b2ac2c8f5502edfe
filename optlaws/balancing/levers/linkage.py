"""The four-bar linkage of the torsion lever: rocker, coupler and driven link, at right angles at rest."""

from __future__ import annotations

from dataclasses import dataclass
from math import acos, atan2, pi, sqrt
from typing import NamedTuple

import numpy as np

from optlaws.numbers import Array

_SAMPLES = 33  # enough to see a link that passes its dead point and comes back


class Linkage(NamedTuple):
    """The position of the linkage; arrays of the shape of chi.

    Attributes
    ----------
    rocker
        Deviation gamma - gamma0 of the rocker, radians.
    ratio, slope
        dgamma/dpsi and its derivative with respect to psi.
    at_rocker, at_link
        Transmission angles: between the coupler and the rocker, and between the coupler and the driven link, radians.
    """

    rocker: Array
    ratio: Array
    slope: Array
    at_rocker: Array
    at_link: Array


@dataclass(frozen=True)
class FourBar:
    """Rocker O1A = 1, coupler AB = lam and driven link O2B = beta, which at rest are both at right angles to AB.

    Lengths are in units of the rocker, angles in radians. psi and gamma are the directions of O2B and O1A against
    O2O1, equal at rest, and chi = psi - psi0.

    Examples
    --------
    >>> linkage = FourBar(0.75, 1.0)
    >>> round(linkage.alpha, 7), round(linkage.psi0, 7)
    (1.0307764, 1.8157750)
    """

    beta: float
    lam: float

    @property
    def alpha(self) -> float:
        """Distance of the pivots, sqrt(lam² + (beta - 1)²)."""
        return sqrt(self.lam**2 + (self.beta - 1.0) ** 2)

    @property
    def psi0(self) -> float:
        """Direction of both links at rest, radians: obtuse for beta < 1."""
        return atan2(self.lam, self.beta - 1.0)

    @property
    def Q(self) -> float:
        """Coefficient of chi² in the moment, eq. (5)."""
        return self.beta * (1.0 - self.beta**2)

    @property
    def P(self) -> float:
        """Coefficient of chi³ in the moment that does not depend on the pre-twist, eq. (5)."""
        return 4.0 * self.beta**2 * (self.beta**2 - 1.0)

    @property
    def S(self) -> float:
        """Coefficient of chi³ in gamma - gamma0, eq. (12)."""
        return self.beta * (self.beta**2 - 1.0) / 6.0

    @property
    def R(self) -> float:
        """Coefficient of chi³ in the moment that the pre-twist multiplies, eq. (5)."""
        return 3.0 * self.beta**2 * (self.beta - 1.0) ** 2 / self.lam

    @property
    def range(self) -> tuple[float, float]:
        """Deviations chi between which the linkage moves without a dead point of the rocker, radians."""
        # there the rocker and the coupler are in line, O1B = |lam - 1| or lam + 1; the second try is beyond psi = 0, pi
        inner, outer = ((self.beta**2 - self.beta + side * self.lam) / (self.alpha * self.beta) for side in (1.0, -1.0))
        low = acos(inner) if inner < 1.0 else -acos(outer) if outer > -1.0 else -pi
        high = acos(outer) if outer > -1.0 else 2.0 * pi - acos(inner) if inner < 1.0 else 2.0 * pi
        return low - self.psi0, high - self.psi0

    def rocker(self, chi: Array | float) -> Array:
        """Deviation gamma - gamma0 of the rocker at deviations chi of the driven link, radians; eq. (11).

        Written for the tangent of half the angle, which keeps its digits at small chi and its branch at large ones.

        Examples
        --------
        >>> float(FourBar(1.0, 2.0).rocker(0.25))
        0.25
        """
        return self._rocker(*self._joint(chi))

    def at(self, chi: Array | float) -> Linkage:
        """The linkage at deviations chi of the driven link inside `range`, not at its ends.

        Examples
        --------
        >>> float(FourBar(0.75, 1.0).at(0.0).ratio)
        0.75
        """
        sine, versed = self._joint(chi)
        rocker = self._rocker(sine, versed)
        gx, gy = np.cos(rocker), np.sin(rocker)
        bx, by = self.beta - self.beta * versed, self.beta * sine
        # the coupler AB, and how it turns and is carried as psi grows
        cx, cy = 1.0 - self.beta * versed - gx, self.lam + by - gy
        drive, lift = cy * bx - cx * by, cy * gx - cx * gy
        ratio = drive / lift
        dx, dy = ratio * gy - by, bx - ratio * gx
        drive_slope = dy * bx - dx * by - (cx * bx + cy * by)
        lift_slope = dy * gx - dx * gy - ratio * (cx * gx + cy * gy)
        return Linkage(
            rocker=rocker,
            ratio=ratio,
            slope=(drive_slope - ratio * lift_slope) / lift,
            at_rocker=np.arctan2(lift, -(cx * gx + cy * gy)),
            at_link=np.arctan2(drive, cx * bx + cy * by),
        )

    def _joint(self, chi: Array | float) -> tuple[Array, Array]:
        """Sine and versed sine of chi."""
        angle = np.asarray(chi, dtype=np.float64)
        return np.sin(angle), 2.0 * np.sin(0.5 * angle) ** 2

    def _rocker(self, sine: Array, versed: Array) -> Array:
        # O1 is the origin, A at rest (1, 0) and B at rest (1, lam); B moves to (1 - beta versed, lam + beta sine)
        across = self.lam + self.beta * sine
        less = self.beta * (self.lam * sine + self.beta * versed)
        more = less + 2.0 * (1.0 - self.beta * versed)
        root = np.sqrt(np.maximum(across**2 - less * more, 0.0))
        # two forms of one quotient: each would cancel where the other does not
        return 2.0 * np.where(across < 0.0, np.arctan2(across - root, more), np.arctan2(less, across + root))

    def transmission(self, low: float, high: float) -> tuple[tuple[float, float], tuple[float, float]]:
        """Least and greatest transmission angle at the rocker and at the driven link from chi = low to high, radians.

        Examples
        --------
        >>> [[round(angle, 4) for angle in pair] for pair in FourBar(1.0, 2.0).transmission(-0.5, 0.5)]
        [[1.0708, 2.0708], [1.0708, 2.0708]]
        """
        path = self.at(np.linspace(low, high, _SAMPLES))
        at_rocker, at_link = path.at_rocker.tolist(), path.at_link.tolist()
        # a distance across the linkage, and with it the opposite angle, is extreme where a link passes the line O1O2
        first, last = (self.psi0 + chi for chi in (low, high))
        for place, side in ((0.0, self.alpha - self.beta), (pi, self.alpha + self.beta)):
            if first < place < last:
                at_rocker.append(_opposite(side, 1.0, self.lam))
        first, last = (self.psi0 + turn for turn in path.rocker[[0, -1]].tolist())
        for place, side in ((0.0, self.alpha + 1.0), (pi, self.alpha - 1.0)):
            if first < place < last:
                at_link.append(_opposite(side, self.beta, self.lam))
        return (min(at_rocker), max(at_rocker)), (min(at_link), max(at_link))


def _opposite(side: float, first: float, second: float) -> float:
    """Angle of a triangle opposite to `side`."""
    return acos((first**2 + second**2 - side**2) / (2.0 * first * second))
