"""The displacement of a cam as exact pieces in time: polynomials and sines."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from optlaws.kept import kept_property
from optlaws.laws.segments.segment import Wave
from optlaws.laws.segments.sine import SineSegment
from optlaws.numbers import Array
from optlaws.numerics import chebyshev


@dataclass(frozen=True, eq=False)
class PolynomialMotion:
    """A polynomial over a stretch of time by the Chebyshev series of itself and of its first two derivatives."""

    length: float
    series: tuple[Array, Array, Array]

    def derivative(self, s: Array, order: int) -> Array:
        """Derivative of order `order` at s."""
        return chebyshev.value(self._series(order), 2.0 * s / self.length - 1.0)

    @kept_property
    def _known(self) -> dict[int, Array]:
        return dict(enumerate(self.series))

    def _series(self, order: int) -> Array:
        if order not in self._known:
            self._known[order] = chebyshev.derivative(self._series(order - 1)) / self.length
        return self._known[order]


@dataclass(frozen=True, eq=False)
class Forcing:
    """Displacement a over one stretch of time, s = time - start in [0, length]: a polynomial and sines.

    Parameters
    ----------
    start, length
        Where it lies, in units of the rise's duration.
    a0, b0
        Displacement and velocity at its start.
    acceleration
        Chebyshev series, in 2 s/length - 1, of what is no sine in c.
    sines
        The sines in c.

    Examples
    --------
    >>> rise = Forcing(0.0, 0.5, 0.0, 0.0, np.array([8.0]))
    >>> rise.derivative(np.array([0.5]), 0).tolist()
    [1.0]
    >>> rise = Forcing(0.0, 1.0, 0.0, 0.0, np.zeros(1), (Wave(2 * np.pi, 2 * np.pi, 0.0),))
    >>> rise.derivative(np.array([1.0]), 0).round(12).tolist()
    [1.0]
    """

    start: float
    length: float
    a0: float
    b0: float
    acceleration: Array
    sines: tuple[Wave, ...] = ()

    def derivative(self, s: Array, order: int) -> Array:
        """Derivative of order `order` of a at s."""
        if not self.sines:
            return self._polynomial.derivative(s, order)
        first, *others = (motion.derivative(s, 1.0, order) for motion in self._swings)
        swing: Array = sum(others, first)
        return swing if order > 1 and not self.acceleration.any() else swing + self._polynomial.derivative(s, order)

    @kept_property
    def _swings(self) -> tuple[SineSegment, ...]:
        return tuple(SineSegment(*sine) for sine in self.sines)

    @kept_property
    def _polynomial(self) -> PolynomialMotion:
        velocity = chebyshev.integral(self.length * self.acceleration, self.b0)
        series = chebyshev.integral(self.length * velocity, self.a0), velocity, self.acceleration
        return PolynomialMotion(self.length, series)


def rest(start: float, length: float, a0: float) -> Forcing:
    """The forcing of a cam that dwells.

    Examples
    --------
    >>> rest(1.0, 0.5, 1.0).derivative(np.array([0.25]), 0).tolist()
    [1.0]
    """
    return Forcing(start, length, a0, 0.0, np.zeros(1))
