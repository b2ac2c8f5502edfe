"""What every motion of a follower's mass can be asked."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import Any, overload

import numpy as np
from numpy.typing import NDArray

from optlaws.laws import Peak
from optlaws.numbers import derivative, real_times
from optlaws.series import peaks

Array = NDArray[np.float64]
Many = NDArray[Any] | Sequence[Any]


class MassMotion(ABC):
    """Displacement a_m of the mass with its derivatives, dimensionless like a law."""

    @overload
    def __call__(self, k: float, nu: int = 0) -> float: ...
    @overload
    def __call__(self, k: Many, nu: int = 0) -> Array: ...
    def __call__(self, k: float | Many, nu: int = 0) -> float | Array:
        """Derivative of order `nu` of a_m at `k`.

        Parameters
        ----------
        k
            Time in durations of the rise; a number or an array of any shape.
        nu
            Order of the derivative, at least 0 (not the frequency).

        Raises
        ------
        InputError
            If `k` is not finite or lies before the motion, or `nu` is not an integer of at least 0.
        """
        return self._at(k, derivative(nu))

    @overload
    def a(self, k: float) -> float: ...
    @overload
    def a(self, k: Many) -> Array: ...
    def a(self, k: float | Many) -> float | Array:
        """Displacement a_m at k."""
        return self._at(k, 0)

    @overload
    def b(self, k: float) -> float: ...
    @overload
    def b(self, k: Many) -> Array: ...
    def b(self, k: float | Many) -> float | Array:
        """Velocity of the mass at k."""
        return self._at(k, 1)

    @overload
    def c(self, k: float) -> float: ...
    @overload
    def c(self, k: Many) -> Array: ...
    def c(self, k: float | Many) -> float | Array:
        """Acceleration of the mass at k."""
        return self._at(k, 2)

    @overload
    def j(self, k: float) -> float: ...
    @overload
    def j(self, k: Many) -> Array: ...
    def j(self, k: float | Many) -> float | Array:
        """Jerk of the mass at k."""
        return self._at(k, 3)

    def peak(self, nu: int) -> Peak:
        """Greatest magnitude of the derivative of order `nu`, at the smallest k where several tie.

        Raises
        ------
        InputError
            If `nu` is not an integer of at least 0.
        """
        return peaks.peak(*self._candidates(derivative(nu)))

    def extrema(self, nu: int) -> tuple[Peak, Peak]:
        """Minimum and maximum, signed, of the derivative of order `nu`.

        Raises
        ------
        InputError
            If `nu` is not an integer of at least 0.
        """
        return peaks.extremes(*self._candidates(derivative(nu)))

    def _at(self, k: float | Many, order: int) -> float | Array:
        found = self._derivative(real_times(k), order)
        return found if np.ndim(found) else float(found)

    @abstractmethod
    def _derivative(self, k: Array, order: int) -> Array:
        """Derivative of order `order` at finite k."""

    @abstractmethod
    def _candidates(self, order: int) -> tuple[Array, Array]:
        """Times, and values there, among which the extremes of the derivative of order `order` are."""
