"""One swing of the driven link, out and back, and the motion laws in it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import acos, pi, sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.laws import PolynomialLaw
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.laws.segments.segment import PolynomialSegment
from optlaws.numbers import Array, derivative, finite, numbers, positive
from optlaws.numerics import chebyshev
from optlaws.tolerances import EPSILON, OPERATIONS_ROUNDING

_SAMPLES = 129
_STEPS = 50


@dataclass(frozen=True)
class LeverMotion:
    """Free swing of the driven link from chi01 over 0 to chi02 and back: chi(t) = sum amplitudes[i] cos(2 pi i t / T).

    Parameters
    ----------
    amplitudes
        Radians, shape (n,).
    period
        T in units of sqrt(I / c1), I being the moment of inertia and c1 the stiffness of the first bar.

    Raises
    ------
    InputError
        If the link turns back on its way, or does not pass the position of rest.

    Examples
    --------
    >>> from math import pi
    >>> motion = LeverMotion((0.0, 0.5), 2 * pi)
    >>> motion.chi01, motion.chi02, round(motion.B1, 6), round(motion.C3, 6)
    (0.5, -0.5, 1.570796, -4.934802)
    """

    amplitudes: tuple[float, ...]
    period: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "amplitudes", numbers(self.amplitudes, "amplitudes"))
        object.__setattr__(self, "period", finite(self.period, "period"))
        if self.period <= 0.0 or len(self.amplitudes) < 2:
            raise InputError(f"a motion needs period > 0 and at least two amplitudes, got {shortened(self)}")
        rate = chebyshev.value(chebyshev.derivative(self._series), np.linspace(-1.0, 1.0, _SAMPLES))
        if rate.min() <= 0.0 or self.chi01 <= 0.0 or self.chi02 >= 0.0:
            raise InputError(
                f"the motion turns back between its ends or does not pass chi = 0: chi01 = {self.chi01:.6g}, "
                f"chi02 = {self.chi02:.6g}; reduce the swing"
            )

    @kept_property
    def chi01(self) -> float:
        """The extreme beyond rest, at t = 0, radians; eq. (9)."""
        return float(sum(self.amplitudes))

    @kept_property
    def chi02(self) -> float:
        """The extreme before rest, at t = period / 2, radians; eq. (10)."""
        return float(sum(self.amplitudes[::2]) - sum(self.amplitudes[1::2]))

    @property
    def swing(self) -> float:
        """The swing between both extremes, chi01 - chi02, radians."""
        return self.chi01 - self.chi02

    @kept_property
    def zeta(self) -> float:
        """Share of the period from chi01 to the position of rest, chi = 0; eq. (17)."""
        return acos(self._z) / (2.0 * pi)

    @kept_property
    def _series(self) -> Array:
        # cos(i phi) = T_i(z), z = cos(phi): chi is a Chebyshev series in z
        return np.array(self.amplitudes)

    @kept_property
    def _z(self) -> float:
        slope = chebyshev.derivative(self._series)
        z = 0.0
        for _ in range(_STEPS):
            # the series derives with respect to (z + 1) / 2
            step = chebyshev.value(self._series, z) / (0.5 * chebyshev.value(slope, z))
            z = min(max(z - step, -1.0), 1.0)
            if abs(step) <= EPSILON:
                break
        return z

    def chi(self, t: float | Sequence[float] | NDArray[Any], nu: int = 0) -> Array:
        """Derivative of order `nu` of the deviation with respect to time, radians per unit of time to the nu.

        Parameters
        ----------
        t
            Time since the extreme chi01 in units of sqrt(I / c1), of any shape.
        nu
            Order of the derivative, at least 0.
        """
        turn = 2.0 * pi / self.period
        return turn**nu * self._turned(np.asarray(t, dtype=np.float64) * turn, derivative(nu))

    @property
    def B1(self) -> float:
        """|b| at the end of the run-up, where chi = 0, the run-up's own extreme and time being its units; eq. (18)."""
        return -float(self.chi(self.zeta * self.period, 1)) * self.zeta * self.period / self.chi01

    @property
    def B3(self) -> float:
        """|b| at the start of the run-out, in the run-out's own units; eq. (19)."""
        return float(self.chi(self.zeta * self.period, 1)) * (0.5 - self.zeta) * self.period / self.chi02

    @property
    def C1(self) -> float:
        """Value of c at the start of the run-up, k = 0, in its own units; eq. (20)."""
        return -float(self.chi(0.0, 2)) * 2.0 * (self.zeta * self.period) ** 2 / self.chi01

    @property
    def C3(self) -> float:
        """Value of c at the end of the run-out, k = 1, in its own units, negative; eq. (21)."""
        return float(self.chi(0.5 * self.period, 2)) * 2.0 * ((0.5 - self.zeta) * self.period) ** 2 / self.chi02

    @kept_property
    def law(self) -> PolynomialLaw:
        """The stroke from chi01 to chi02 as it runs: k = 2t/T, a = (chi01 - chi)/(chi01 - chi02).

        Its halves are unlike: a(2 zeta) = chi01/(chi01 - chi02).
        """
        return PolynomialLaw(_fitted(lambda x: self._c(0.5 * (x + 1.0) * pi, pi, self.swing), self._count))

    @kept_property
    def halves(self) -> PiecewiseLaw:
        """Run-up and run-out, each in units of its own extreme and its own time: a(1/2) = 1/2; eq. (14) to (21).

        The units change at k = 1/2, and with them b, from B1 to B3: a jump that the motion itself does not make.
        """
        up, out = 2.0 * pi * self.zeta, pi * (1.0 - 2.0 * self.zeta)
        first = _fitted(lambda x: self._c(0.5 * (x + 1.0) * up, 2.0 * up, 2.0 * self.chi01), self._count)
        second = _fitted(lambda x: self._c(up + 0.5 * (x + 1.0) * out, 2.0 * out, -2.0 * self.chi02), self._count)
        return PiecewiseLaw([0.0, 0.5, 1.0], [PolynomialSegment(first), PolynomialSegment(second, b0=self.B3)])

    def seconds(self, stiffness: float, inertia: float) -> float:
        """The period in seconds, of stiffness c1 in N m/rad and moment of inertia I in kg m².

        Raises
        ------
        InputError
            If one is not positive.

        Examples
        --------
        >>> LeverMotion((0.0, 0.5), 6.0).seconds(stiffness=400.0, inertia=0.01)
        0.03
        """
        return self.period * sqrt(positive(inertia, "inertia") / positive(stiffness, "stiffness"))

    def stiffness(self, seconds: float, inertia: float) -> float:
        """Stiffness c1 of the first bar in N m/rad that gives the period in seconds, of moment of inertia I in kg m².

        Raises
        ------
        InputError
            If one is not positive.

        Examples
        --------
        >>> round(LeverMotion((0.0, 0.5), 6.0).stiffness(seconds=0.03, inertia=0.01), 9)
        400.0
        """
        return positive(inertia, "inertia") * (self.period / positive(seconds, "seconds")) ** 2

    def _turned(self, phi: Array, nu: int) -> Array:
        order = np.arange(len(self.amplitudes), dtype=np.float64)
        weights = order**nu * self._series
        function = (np.cos, lambda x: -np.sin(x), lambda x: -np.cos(x), np.sin)[nu % 4]
        return np.asarray(function(np.multiply.outer(phi, order)) @ weights)

    def _c(self, phi: Array, turn: float, stroke: float) -> Array:
        """Acceleration of a law whose k from 0 to 1 would take phi through `turn` and whose a would be one stroke."""
        return -(turn**2) / stroke * self._turned(phi, 2)

    @property
    def _count(self) -> int:
        return 2 * len(self.amplitudes) + 24


def _fitted(function: Callable[[Array], Array], count: int) -> tuple[float, ...]:
    """Chebyshev series of an entire function on [-1, 1], without the coefficients that are only rounding."""
    series = chebyshev.from_values(function(chebyshev.nodes(count)))
    return tuple(chebyshev.shortened(series, OPERATIONS_ROUNDING * float(np.abs(series).max())).tolist())
