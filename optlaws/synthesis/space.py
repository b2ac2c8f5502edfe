"""What a set of laws must offer so that a program can be written over it: affine functions of k for coordinates."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Hashable
from functools import cache

import numpy as np
from numpy.polynomial import chebyshev, legendre
from numpy.typing import NDArray

from optlaws.laws import MotionLaw
from optlaws.synthesis.rows import Family, LinearFamily, NormFamily, ProductFamily

Array = NDArray[np.float64]


class LawSpace(ABC):
    """Laws base + sum x_i f_i; subclasses give their series. Variables beyond `terms` belong to the program."""

    terms: int
    domain: tuple[float, float]

    def __init__(self) -> None:
        self._kept: dict[Hashable, Array] = {}

    def cached(self, key: Hashable, make: Callable[[], Array]) -> Array:
        """What `make` gives, made once for each key."""
        if key not in self._kept:
            self._kept[key] = make()
        return self._kept[key]

    @abstractmethod
    def series(self, nu: int) -> Array:
        """Chebyshev series in u = 1 - 2k of the derivative of order nu: a column for each f_i, the base law last."""

    @abstractmethod
    def law(self, coordinates: Array) -> MotionLaw:
        """The law with the given coordinates."""

    @abstractmethod
    def z_series(self, coordinates: Array) -> Array:
        """Chebyshev series of Z in 2k - 1."""

    def widened(self, columns: Array, size: int) -> Array:
        """Columns for `size` variables: those beyond the coordinates are zero, the base law's stays last."""
        wide = np.zeros((len(columns), size + 1))
        wide[:, : self.terms] = columns[:, :-1]
        wide[:, -1] = columns[:, -1]
        return wide

    def derivative(
        self, nu: int, name: str, slack: Array, bound: float = 0.0, signs: tuple[float, ...] = (1.0, -1.0)
    ) -> LinearFamily:
        """Rows s a^(nu) <= slack . x + bound."""
        series = self.widened(self.series(nu), len(slack))
        return LinearFamily(name, slack, bound, signs, self.domain, series=series)

    def power(self, name: str, slack: Array, bound: float = 0.0) -> ProductFamily:
        """Rows |b c| <= slack . x + bound."""
        first, second = (self.derivative(nu, name, slack) for nu in (1, 2))
        return ProductFamily(name, slack, bound, (1.0, -1.0), self.domain, first=first, second=second)

    def norm(self, nu: int, name: str, slack: Array, bound: float = 0.0) -> NormFamily:
        """The row RMS of a^(nu) <= slack . x + bound."""
        series = self.series(nu)
        u, weights = _gauss(len(series) + 1)
        matrix = np.sqrt(weights / 2.0)[:, None] * chebyshev.chebvander(u, len(series) - 1) @ series
        return NormFamily(name, slack, bound, matrix=self.widened(matrix, len(slack)))

    @abstractmethod
    def below(self, slack: Array) -> Family:
        """Rows b <= b(1/2) of symmetric laws."""

    @abstractmethod
    def forward(self, slack: Array) -> Family:
        """Rows b >= 0."""


@cache
def _gauss(count: int) -> tuple[Array, Array]:
    u, weights = legendre.leggauss(count)
    return u, weights
