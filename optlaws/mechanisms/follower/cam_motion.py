"""What a cam does to its follower: displacement as exact pieces in time, polynomials and sines."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from optlaws.kept import kept_property
from optlaws.laws.segments.sine import SineSegment
from optlaws.series import chebyshev

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Forcing(ABC):
    """Displacement a over one stretch of time, s = time - start in [0, length].

    Parameters
    ----------
    start, length
        Where it lies, in units of the rise's duration.
    a0
        Displacement at its start.
    """

    start: float
    length: float
    a0: float

    @abstractmethod
    def derivative(self, s: Array, order: int) -> Array:
        """Derivative of order `order` of a at s."""


@dataclass(frozen=True, eq=False)
class PolynomialForcing(Forcing):
    """Acceleration sum acceleration[i] T_i(2 s/length - 1); velocity b0 at the start.

    Examples
    --------
    >>> rise = PolynomialForcing(0.0, 0.5, 0.0, np.array([8.0]), 0.0)
    >>> rise.derivative(np.array([0.5]), 0).tolist()
    [1.0]
    """

    acceleration: Array
    b0: float

    @kept_property
    def velocity(self) -> Array:
        """Chebyshev series of b."""
        return chebyshev.integral(self.length * self.acceleration, self.b0)

    def derivative(self, s: Array, order: int) -> Array:  # noqa: D102
        return chebyshev.value(self._series(order), 2.0 * s / self.length - 1.0)

    @kept_property
    def _known(self) -> dict[int, Array]:
        return {0: chebyshev.integral(self.length * self.velocity, self.a0), 1: self.velocity, 2: self.acceleration}

    def _series(self, order: int) -> Array:
        if order not in self._known:
            self._known[order] = chebyshev.derivative(self._series(order - 1)) / self.length
        return self._known[order]


@dataclass(frozen=True, eq=False)
class SineForcing(Forcing):
    """A sum of sine segments, in units of time.

    Examples
    --------
    >>> rise = SineForcing(0.0, 1.0, 0.0, (SineSegment(amplitude=2 * np.pi, frequency=2 * np.pi),))
    >>> rise.derivative(np.array([1.0]), 0).round(12).tolist()
    [1.0]
    """

    sines: tuple[SineSegment, ...]

    @kept_property
    def steady(self) -> Array:
        """Chebyshev series of what is no sine in c."""
        h, total = 0.5 * self.length, np.zeros(3)
        for one in self.sines:
            p0, p1, p2 = (*one.powers, 0.0, 0.0, 0.0)[:3]
            total += [p0 + p1 * h + 1.5 * p2 * h * h, p1 * h + 2.0 * p2 * h * h, 0.5 * p2 * h * h]
        return total

    def derivative(self, s: Array, order: int) -> Array:  # noqa: D102
        found = np.full(np.shape(s), self.a0 if order == 0 else 0.0)
        for one in self.sines:
            found += one.derivative(s / self.length, self.length, order)
        return found


def rest(start: float, length: float, a0: float) -> PolynomialForcing:
    """A dwell.

    Examples
    --------
    >>> rest(1.0, 0.5, 1.0).derivative(np.array([0.25]), 0).tolist()
    [1.0]
    """
    return PolynomialForcing(start, length, a0, np.zeros(1), 0.0)
