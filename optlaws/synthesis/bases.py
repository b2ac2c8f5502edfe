"""Basis functions W_i(k) of the free function Z(k) = sum z_i W_i(k) of eq. 8."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from optlaws.errors import InputError
from optlaws.laws.chebyshev import chebyshev_from_powers, powers_from_chebyshev
from optlaws.laws.checks import whole

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Basis(ABC):
    """A chosen basis W_0, ..., W_degree for Z(k), dimensionless; subclasses say which.

    A new basis is one subclass: give it a `name` and the two conversions.

    Raises
    ------
    InputError
        If `degree` is not an integer of at least 0.

    Examples
    --------
    >>> Powers(3).degree, Chebyshev(3).size
    (3, 4)
    """

    degree: int
    name: ClassVar[str]
    kinds: ClassVar[dict[str, type[Basis]]] = {}

    def __init_subclass__(cls, **kwargs: Any) -> None:  # noqa: ANN401 - whatever a subclass declares
        super().__init_subclass__(**kwargs)
        Basis.kinds[cls.name] = cls

    def __post_init__(self) -> None:
        object.__setattr__(self, "degree", whole(self.degree, "degree of Z"))

    @property
    def size(self) -> int:
        """Number of basis functions, degree + 1."""
        return self.degree + 1

    @abstractmethod
    def coefficients(self, series: Array) -> tuple[float, ...]:
        """z_0, ..., z_degree of a Z given by its Chebyshev series in 2k - 1."""

    @abstractmethod
    def series(self, z: Sequence[float]) -> Array:
        """Chebyshev series in 2k - 1 of Z(k) = sum z_i W_i(k)."""


class Powers(Basis):
    """W_i(k) = k^i, the basis of the paper; coefficients in ascending powers.

    Examples
    --------
    >>> Powers(1).series([-3.0, 6.0]).tolist()
    [0.0, 3.0]
    """

    name = "powers"

    def coefficients(self, series: Array) -> tuple[float, ...]:
        """Ascending powers, converted by exact arithmetic and rounded once."""
        return _fitted(powers_from_chebyshev(series), self.size)

    def series(self, z: Sequence[float]) -> Array:
        """Chebyshev series, converted by exact arithmetic and rounded once."""
        return np.asarray(chebyshev_from_powers(_sized(z, self)), dtype=float)


class Chebyshev(Basis):
    """W_i(k) = T_i(2k - 1), well conditioned at any degree.

    Examples
    --------
    >>> Chebyshev(1).coefficients(np.array([0.0, 3.0]))
    (0.0, 3.0)
    """

    name = "chebyshev"

    def coefficients(self, series: Array) -> tuple[float, ...]:
        """The series itself, to degree + 1 terms."""
        return _fitted(series, self.size)

    def series(self, z: Sequence[float]) -> Array:
        """The coefficients themselves."""
        return np.asarray(_sized(z, self), dtype=float)


def basis(name: str, degree: int) -> Basis:
    """The basis called `name` with the given degree.

    Raises
    ------
    InputError
        If the name is unknown or the degree is not an integer of at least 0.

    Examples
    --------
    >>> basis("chebyshev", 9)
    Chebyshev(degree=9)
    """
    if name not in Basis.kinds:
        msg = f"basis {name!r} is unknown; known are {', '.join(sorted(Basis.kinds))}"
        raise InputError(msg)
    return Basis.kinds[name](degree)


def _sized(z: Sequence[float], chosen: Basis) -> Sequence[float]:
    if len(z) != chosen.size:
        msg = f"{chosen!r} takes {chosen.size} coefficients z, got {len(z)}"
        raise InputError(msg)
    return z


def _fitted(values: Sequence[float] | Array, size: int) -> tuple[float, ...]:
    kept = [float(v) for v in values[:size]]
    return tuple(kept + [0.0] * (size - len(kept)))
