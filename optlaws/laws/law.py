"""What a motion law is: an immutable value with displacement a and its derivatives on [0, 1]."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from typing import Any, overload

import numpy as np
from numpy.typing import NDArray

from optlaws.kept import kept_property
from optlaws.laws.constants import Constants
from optlaws.laws.html import page
from optlaws.laws.storage import Stored
from optlaws.numbers import derivative, times
from optlaws.series import peaks
from optlaws.series.peaks import Peak

Array = NDArray[np.float64]
Many = NDArray[Any] | Sequence[Any]


class MotionLaw(Stored):
    """Displacement a(k) of k in [0, 1] with its derivatives; dimensionless (eq. 1).

    Velocity b = a', acceleration c = a'', jerk j = a''', kinetic power d = b c. With stroke h and duration T
    the motion is h a and its derivatives are (h/T) b, (h/T²) c, (h/T³) j. Laws are immutable, hashable, and
    equal where type and contents are equal.

    A new representation is one subclass, a frozen dataclass declared with its kind, for example
    ``class SplineLaw(MotionLaw, kind="spline")``, that supplies the abstract methods; storage, peaks and
    drawings follow.

    Examples
    --------
    >>> from optlaws.laws import smoothstep
    >>> law = smoothstep(3)
    >>> law(0.5), law.b(0.5), law([0.0, 1.0], nu=2).tolist()
    (0.5, 1.875, [0.0, 0.0])
    """

    @overload
    def __call__(self, k: float, nu: int = 0) -> float: ...
    @overload
    def __call__(self, k: Many, nu: int = 0) -> Array: ...
    def __call__(self, k: float | Many, nu: int = 0) -> float | Array:
        """Derivative of order `nu` of a at `k`.

        Parameters
        ----------
        k
            Dimensionless time in [0, 1]; a number or an array of any shape.
        nu
            Order of the derivative, at least 0.

        Returns
        -------
        A float for a number (or an array of shape ()), else an array of the shape of `k`.

        Raises
        ------
        InputError
            If `k` is outside [0, 1] or not a number, or `nu` is not an integer of at least 0.

        Examples
        --------
        >>> from optlaws.laws import smoothstep
        >>> smoothstep(3)([0.0, 0.5, 1.0], nu=1).tolist()
        [0.0, 1.875, 0.0]
        """
        return _plain(self._derivative(times(k), derivative(nu)))

    @overload
    def a(self, k: float) -> float: ...
    @overload
    def a(self, k: Many) -> Array: ...
    def a(self, k: float | Many) -> float | Array:
        """Displacement at k."""
        return _plain(self._derivative(times(k), 0))

    @overload
    def b(self, k: float) -> float: ...
    @overload
    def b(self, k: Many) -> Array: ...
    def b(self, k: float | Many) -> float | Array:
        """Velocity a' at k."""
        return _plain(self._derivative(times(k), 1))

    @overload
    def c(self, k: float) -> float: ...
    @overload
    def c(self, k: Many) -> Array: ...
    def c(self, k: float | Many) -> float | Array:
        """Acceleration a'' at k."""
        return _plain(self._derivative(times(k), 2))

    @overload
    def j(self, k: float) -> float: ...
    @overload
    def j(self, k: Many) -> Array: ...
    def j(self, k: float | Many) -> float | Array:
        """Jerk a''' at k."""
        return _plain(self._derivative(times(k), 3))

    @overload
    def d(self, k: float) -> float: ...
    @overload
    def d(self, k: Many) -> Array: ...
    def d(self, k: float | Many) -> float | Array:
        """Kinetic power b c at k."""
        inside = times(k)
        return _plain(self._derivative(inside, 1) * self._derivative(inside, 2))

    def boundary_values(self, count: int) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """The first `count` of a, b, c, c', ... at k = 0, and the same at k = 1.

        Raises
        ------
        InputError
            If `count` is not an integer of at least 0.

        Examples
        --------
        >>> from optlaws.laws import smoothstep
        >>> smoothstep(2).boundary_values(3)
        ((0.0, 0.0, 6.0), (1.0, 0.0, -6.0))
        """
        ends = np.array([0.0, 1.0])
        pairs = [self._derivative(ends, nu).tolist() for nu in range(derivative(count, "count"))]
        return tuple(pair[0] for pair in pairs), tuple(pair[1] for pair in pairs)

    def peak(self, nu: int) -> Peak:
        """Peak of |derivative of order nu| over the whole interval, at the smallest k where several tie.

        Raises
        ------
        InputError
            If `nu` is not an integer of at least 0.

        Examples
        --------
        >>> from optlaws.laws import smoothstep
        >>> smoothstep(2).peak(2)
        Peak(value=6.0, k=0.0)
        """
        return peaks.peak(*self._candidate_values(nu))

    def extrema(self, nu: int, within: tuple[float, float] = (0.0, 1.0)) -> tuple[Peak, Peak]:
        """Minimum and maximum, signed, of the derivative of order nu over the whole interval or a part of it.

        Parameters
        ----------
        nu
            Order of the derivative.
        within
            The part: its first and its last k.

        Raises
        ------
        InputError
            If `nu` is not an integer of at least 0, or the part is not in [0, 1].

        Examples
        --------
        >>> from optlaws.laws import smoothstep
        >>> smoothstep(2).extrema(2)
        (Peak(value=-6.0, k=1.0), Peak(value=6.0, k=0.0))
        """
        if within == (0.0, 1.0):
            return peaks.extremes(*self._candidate_values(nu))
        ends = times(within)
        k = self._candidates(derivative(nu))
        k = np.concatenate([ends, k[(k > ends[0]) & (k < ends[1])]])
        return peaks.extremes(k, self._derivative(k, nu))

    def power_peak(self) -> Peak:
        """Peak of |d| over the whole interval, d = b c.

        Examples
        --------
        >>> from optlaws.laws import smoothstep
        >>> round(smoothstep(2).power_peak().value, 6)
        3.464102
        """
        k = self._power_candidates()
        return peaks.peak(k, self._derivative(k, 1) * self._derivative(k, 2))

    def rms(self, nu: int) -> float:
        """Root mean square of the derivative of order nu over the interval.

        Raises
        ------
        InputError
            If `nu` is not an integer of at least 0.

        Examples
        --------
        >>> from optlaws.laws import smoothstep
        >>> round(smoothstep(2).rms(2) ** 2, 12)
        12.0
        """
        return float(np.sqrt(self._mean_square(derivative(nu))))

    @kept_property
    def constants(self) -> Constants:
        """B, C, D, J with their places, and the RMS of c; computed at the first use.

        Examples
        --------
        >>> from optlaws.laws import smoothstep
        >>> smoothstep(2).constants.J
        Peak(value=12.0, k=0.0)
        """
        return Constants(
            B=self.peak(1),
            C=self.peak(2),
            D=self.power_peak(),
            J=self.peak(3),
            rms_c=self.rms(2),
        )

    def __repr__(self) -> str:
        one = self.constants
        shown = f"B={one.B.value:g}, C={one.C.value:g}, D={one.D.value:g}, J={one.J.value:g}"
        return f"{type(self).__name__}({self._summary()}, {shown})"

    def _repr_html_(self) -> str:
        k = np.linspace(0.0, 1.0, 121)
        curves = {name: self._derivative(k, nu).tolist() for nu, name in enumerate("abc")}
        return page(f"{type(self).__name__}, {self._summary()}", self.constants, curves)

    def _candidate_values(self, nu: int) -> tuple[Array, Array]:
        order = derivative(nu)
        k = self._candidates(order)
        return k, self._derivative(k, order)

    @abstractmethod
    def _derivative(self, k: Array, nu: int) -> Array:
        """Derivative of order `nu` at valid `k` of any shape."""

    @abstractmethod
    def _candidates(self, nu: int) -> Array:
        """Points where the derivative of order `nu` may be extreme: stationary, breaks and both ends."""

    @abstractmethod
    def _power_candidates(self) -> Array:
        """Points where d may be extreme."""

    @abstractmethod
    def _mean_square(self, nu: int) -> float:
        """Integral over [0, 1] of the square of the derivative of order `nu`."""

    @abstractmethod
    def _summary(self) -> str:
        """What the repr says besides the constants."""


def _plain(values: Array) -> float | Array:
    return values if np.ndim(values) else float(values)
