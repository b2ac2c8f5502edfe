"""Polynomial laws, stored as the Chebyshev series of their acceleration."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from math import comb, factorial
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from optlaws.kept import kept_property
from optlaws.laws.law import MotionLaw
from optlaws.numbers import MAGNITUDE_LIMIT, MOST_ORDER, MOST_TERMS, Array, fractions, whole
from optlaws.numerics import chebyshev, exact
from optlaws.numerics.peaks import polished


@dataclass(frozen=True, init=False, repr=False)
class PolynomialLaw(MotionLaw, kind="polynomial"):
    """A polynomial law: acceleration c(k) = sum acceleration[n] T_n(2k - 1), with a(0) and b(0).

    Displacement and velocity come from integration and jerk from one differentiation, which stays accurate at
    degree 60 and more, where powers of k lose every digit.

    Parameters
    ----------
    acceleration
        Chebyshev coefficients of c in 2k - 1, dimensionless, shape (n,); zeros at the end are dropped.
    a0, b0
        Displacement and velocity at k = 0, dimensionless.

    Raises
    ------
    InputError
        If a number is not real and finite.

    Examples
    --------
    >>> law = PolynomialLaw([0.0, -6.0])
    >>> law
    PolynomialLaw(degree=3, B=1.5, C=6, D=3.4641, J=12)
    >>> law == PolynomialLaw.from_powers([0, 0, 3, -2])
    True
    """

    acceleration: tuple[float, ...]
    a0: float
    b0: float

    def __init__(self, acceleration: Sequence[float] | NDArray[Any], a0: float = 0.0, b0: float = 0.0) -> None:
        series = list(_numbers(acceleration, "acceleration"))
        while series and series[-1] == 0.0:
            series.pop()
        object.__setattr__(self, "acceleration", tuple(series))
        object.__setattr__(self, "a0", _numbers([a0], "a0")[0])
        object.__setattr__(self, "b0", _numbers([b0], "b0")[0])

    @classmethod
    def from_powers(cls, coefficients: Iterable[Any]) -> Self:
        """The law a(k) = sum coefficients[n] k^n, converted by exact arithmetic and rounded once.

        Parameters
        ----------
        coefficients
            Ints, floats or Fractions in ascending powers; ints stay exact however large.

        Raises
        ------
        InputError
            If a coefficient is not a finite real number.

        Examples
        --------
        >>> PolynomialLaw.from_powers([0, 0, 3, -2]).b(0.5)
        1.5
        """
        powers = fractions(coefficients, "coefficients")
        a0, b0 = ([*powers, Fraction(0), Fraction(0)])[:2]
        second = [n * (n - 1) * value for n, value in enumerate(powers)][2:]
        return cls(exact.rounded(exact.exact_chebyshev(second)), float(a0), float(b0))

    @classmethod
    def from_chebyshev(cls, coefficients: Iterable[Any]) -> Self:
        """The law a(k) = sum coefficients[n] T_n(2k - 1), differentiated exactly and rounded once.

        Raises
        ------
        InputError
            If a coefficient is not a finite real number.

        Examples
        --------
        >>> PolynomialLaw.from_chebyshev([0.5, 0.5]) == smoothstep(1)
        True
        """
        displacement = fractions(coefficients, "coefficients")
        velocity = _exact_derivative(displacement)
        a0, b0 = (
            float(sum((-1) ** n * value for n, value in enumerate(values))) for values in (displacement, velocity)
        )
        return cls(exact.rounded(_exact_derivative(velocity)), a0, b0)

    def to_powers(self) -> tuple[float, ...]:
        """Coefficients of a in ascending powers of k, each the float nearest to the exact coefficient of this law.

        Above degree 15 or so, rounded powers do not describe the law to full accuracy: use `to_dict` to keep
        a law and `exact_powers` to compute with its powers.

        Examples
        --------
        >>> smoothstep(2).to_powers()
        (0.0, 0.0, 3.0, -2.0)
        """
        return exact.rounded(self.exact_powers())

    def exact_powers(self) -> tuple[Fraction, ...]:
        """Coefficients of a in ascending powers of k, exact; `from_powers` gives back an equal law.

        Examples
        --------
        >>> PolynomialLaw.from_powers(smoothstep(30).exact_powers()) == smoothstep(30)
        True
        """
        second = exact.exact_powers([Fraction(value) for value in self.acceleration])
        powers = [Fraction(self.a0), Fraction(self.b0)]
        powers += [value / ((n + 1) * (n + 2)) for n, value in enumerate(second)]
        while len(powers) > 1 and powers[-1] == 0:
            powers.pop()
        return tuple(powers)

    @property
    def degree(self) -> int:
        """The degree of a(k) as a polynomial."""
        return len(self.acceleration) + 1 if self.acceleration else int(self.b0 != 0.0)

    @kept_property
    def _cache(self) -> dict[int, Array]:
        return {2: np.array(self.acceleration or (0.0,))}

    def _series(self, nu: int) -> Array:
        if nu > self.degree:
            return np.zeros(1)
        if nu not in self._cache:
            if nu > 2:
                self._cache[nu] = chebyshev.derivative(self._series(nu - 1))
            else:
                self._cache[nu] = chebyshev.integral(self._series(nu + 1), self.b0 if nu else self.a0)
        return self._cache[nu]

    @kept_property
    def _tables(self) -> dict[int, Array]:
        return {}

    def _all_series(self, count: int) -> Array:
        """The series of derivatives of the orders below a count, a column each, zeros behind the shorter ones."""
        if count not in self._tables:
            columns = [self._series(nu) for nu in range(count)]
            table = np.zeros((max(map(len, columns)), count))
            for nu, column in enumerate(columns):
                table[: len(column), nu] = column
            self._tables[count] = table
        return self._tables[count]

    def _derivative(self, k: Array, nu: int) -> Array:
        return chebyshev.value(self._series(nu), 2.0 * k - 1.0)

    def _candidates(self, nu: int) -> Array:
        slope = self._series(nu + 1)
        columns = self._columns(nu + 1, nu + 2)

        def residual(x: Array) -> tuple[Array, Array]:
            values = chebyshev.basis_values(x, len(columns)) @ columns
            return values[:, 0], 2.0 * values[:, 1]

        return _with_ends(polished(chebyshev.real_parts_of_roots(slope), residual))

    def _sides(self, nu: int) -> tuple[Array, Array]:
        if nu not in self._known_sides:
            k = self._candidates(nu)
            self._known_sides[nu] = _fixed(k, self._derivative(k, nu))
        return self._known_sides[nu]

    @kept_property
    def _known_sides(self) -> dict[int, tuple[Array, Array]]:
        return {}

    def _power_sides(self) -> tuple[Array, Array]:
        return self._known_power_sides

    @kept_property
    def _known_power_sides(self) -> tuple[Array, Array]:
        k = self._power_candidates()
        return _fixed(k, self._power(k))

    def _power_candidates(self) -> Array:
        b, c, j = (self._series(nu) for nu in (1, 2, 3))
        slope = chebyshev.product(b, j)
        square = chebyshev.product(c, c)
        slope[: len(square)] += square[: len(slope)]
        columns = self._columns(1, 2, 3, 4)

        def residual(x: Array) -> tuple[Array, Array]:
            b, c, j, s = (chebyshev.basis_values(x, len(columns)) @ columns).T
            return c * c + b * j, 2.0 * (3.0 * c * j + b * s)

        return _with_ends(polished(chebyshev.real_parts_of_roots(slope), residual))

    def _columns(self, *orders: int) -> Array:
        parts = [self._series(nu) for nu in orders]
        columns = np.zeros((max(map(len, parts)), len(parts)))
        for i, part in enumerate(parts):
            columns[: len(part), i] = part
        return columns

    def _mean_square(self, nu: int) -> float:
        return chebyshev.mean_product(self._series(nu), self._series(nu))

    def _summary(self) -> str:
        return f"degree={self.degree}"


def smoothstep(order: int) -> PolynomialLaw:
    """S_l, of least degree from 0 to 1 with order - 1 derivatives zero at both ends (eq. 8).

    Its degree is 2l - 1 and b = (2l-1)!/((l-1)!)² (k(1-k))^(l-1), l being `order`; built by exact arithmetic.

    Raises
    ------
    InputError
        If `order` is not an integer of at least 1.

    Examples
    --------
    >>> smoothstep(4)
    PolynomialLaw(degree=7, B=2.1875, C=7.51319, D=10.7502, J=52.5)
    """
    return _smoothstep(whole(order, "order", least=1, most=MOST_ORDER))


def _fixed(k: Array, values: Array) -> tuple[Array, Array]:
    """Places and values as read-only arrays, cached for the next call."""
    k.flags.writeable = values.flags.writeable = False
    return k, values


@lru_cache(maxsize=128)
def _smoothstep(order: int) -> PolynomialLaw:
    factor = factorial(2 * order - 1) // factorial(order - 1) ** 2
    powers = [Fraction((-1) ** i * factor * comb(order - 1, i), order + i) for i in range(order)]
    return PolynomialLaw.from_powers([0] * order + powers)


def _exact_derivative(values: list[Fraction]) -> list[Fraction]:
    result = [Fraction(0)] * (len(values) + 1)
    for n in range(len(values) - 1, 0, -1):
        result[n - 1] = result[n + 1] + 4 * n * values[n]
    result[0] /= 2
    return result[: len(values) - 1]


def _numbers(values: Any, name: str) -> tuple[float, ...]:
    try:
        array = np.asarray(values)
        right = array.ndim == 1 and array.dtype.kind in "fiu"
    except (ValueError, RecursionError, OverflowError):
        right = False
    if right and array.size <= MOST_TERMS and np.all(np.abs(array) <= MAGNITUDE_LIMIT):
        return tuple(array.astype(np.float64).tolist())
    return exact.rounded(fractions(values, name))


def _with_ends(x: Array) -> Array:
    return np.concatenate(([0.0, 1.0], 0.5 * (x + 1.0)))
