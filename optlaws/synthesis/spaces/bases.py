"""Basis functions W_i(k) of the free function Z(k) = sum z_i W_i(k) of eq. 8, and breaks between which they are one.

Those of pieces are B-splines, and others that offer what these do.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from inspect import signature
from itertools import pairwise
from math import comb
from numbers import Integral
from typing import Any, ClassVar, Self, cast

import numpy as np

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.files.reading import JsonText, entries_of
from optlaws.kept import kept_property
from optlaws.lazy import Registry
from optlaws.numbers import (
    MOST_DEGREE,
    MOST_PIECE_DEGREE,
    MOST_PIECES,
    Array,
    fractions,
    listed,
    numbers,
    positive,
    whole,
)
from optlaws.numerics.exact import chebyshev_from_powers, exact_powers, powers_from_chebyshev, rounded
from optlaws.tolerances import MIRROR


def places(breaks: int | Sequence[float]) -> tuple[float, ...]:
    """Breaks as floats; an integer means as many pieces of equal length.

    >>> places(4), places([0, 0.3, 1])
    ((0.0, 0.25, 0.5, 0.75, 1.0), (0.0, 0.3, 1.0))
    """
    if isinstance(breaks, Integral):
        number = whole(breaks, "number of pieces", least=1, most=MOST_PIECES)
        return tuple(i / number for i in range(number + 1))
    places = numbers(listed(breaks, "breaks", MOST_PIECES + 1), "breaks")
    if len(places) < 2 or places[0] != 0.0 or places[-1] != 1.0 or not all(a < b for a, b in pairwise(places)):
        raise InputError(f"breaks must increase from 0 to 1, got {shortened(places)}")
    return places


def mirrored(breaks: Sequence[float]) -> bool:
    """Whether the breaks are symmetric about 1/2.

    >>> mirrored((0.0, 0.3, 0.7, 1.0)), mirrored((0.0, 0.3, 1.0))
    (True, False)
    """
    return all(abs(place + other - 1.0) <= MIRROR for place, other in zip(breaks, reversed(breaks), strict=True))


def order_of_continuity(continuity: int, degree: int) -> int:
    """The order up to which derivatives are continuous at the breaks, checked."""
    order = whole(continuity, "continuity", least=1, most=MOST_DEGREE)
    if order >= degree:
        raise InputError(f"continuity must be below the degree {degree}, got {order}")
    return order


def read_breaks(text: str) -> int | list[float]:
    """Breaks from text: a number of equal pieces, or the places separated by blanks.

    >>> read_breaks("8"), read_breaks("0 0.3 1")
    (8, [0.0, 0.3, 1.0])
    """
    try:
        places = [float(word) for word in text.replace(",", " ").split()]
    except ValueError as error:
        raise InputError(f"breaks are a number of pieces or places separated by blanks: {error}") from None
    return int(places[0]) if len(places) == 1 and places[0].is_integer() else places


class Basis(JsonText, ABC):
    """Base class of bases of the free function Z; subclasses are frozen values, named `name` in problem files.

    Examples
    --------
    >>> sorted(Basis.kinds)
    ['bernstein', 'bsplines', 'chebyshev', 'periodic', 'pieces', 'powers']
    """

    _json_name = "a basis"

    name: ClassVar[str]
    kinds: ClassVar[Registry[type[Basis]]] = Registry("basis")

    def __init_subclass__(cls, **kwargs: Any) -> None:
        super().__init_subclass__(**kwargs)
        if "name" in cls.__dict__:
            Basis.kinds[cls.name] = cls

    @property
    def mirrored(self) -> bool:
        """Whether the basis contains the mirror image of every law from rest to rest."""
        return False

    @abstractmethod
    def check(self, *, symmetric: bool) -> None:
        """Refuse a basis without free coefficients, by an InputError."""

    @abstractmethod
    def to_dict(self) -> dict[str, Any]:
        """Its name and its parameters, plain."""

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Self:
        """The basis that `to_dict` described.

        Raises
        ------
        InputError
            If the name is unknown, that of another kind, or a parameter does not fit.

        Examples
        --------
        >>> Basis.from_dict(Chebyshev(9).to_dict())
        Chebyshev(degree=9)
        """
        known = entries_of(data, ("basis", "degree"), cls._json_name)
        others = {name: value for name, value in data.items() if name not in known}
        read = basis(known["basis"], known["degree"], **others)
        if not isinstance(read, cls):
            raise InputError(f"{shortened(data)} is no {cls.__name__}, but {read!r}")
        return read


@dataclass(frozen=True)
class PolynomialBasis(Basis):
    """A chosen basis W_0, ..., W_degree for Z(k), dimensionless; subclasses define it.

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

    def __post_init__(self) -> None:
        object.__setattr__(self, "degree", whole(self.degree, "degree of Z", most=MOST_DEGREE))

    @property
    def mirrored(self) -> bool:
        """Always: Z(1-k) has the degree of Z(k)."""
        return True

    @property
    def size(self) -> int:
        """Number of basis functions, degree + 1."""
        return self.degree + 1

    def check(self, *, symmetric: bool) -> None:
        """Refuse a degree that leaves no freedom."""
        if self.degree < (1 if symmetric else 0):
            raise InputError(
                f"degree {self.degree} leaves no freedom: b(1/2) = B takes the one coefficient of Z that is "
                "odd about k = 1/2, so the degree of Z must be at least 1 (3 or more to optimise)"
            )

    def to_dict(self) -> dict[str, Any]:
        """The name and the degree."""
        return {"basis": self.name, "degree": self.degree}

    @abstractmethod
    def coefficients(self, series: Array) -> tuple[float, ...]:
        """z_0, ..., z_degree of a Z given by its Chebyshev series in 2k - 1."""

    @abstractmethod
    def series(self, z: Sequence[float]) -> Array:
        """Chebyshev series in 2k - 1 of Z(k) = sum z_i W_i(k)."""


class Powers(PolynomialBasis):
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


class Chebyshev(PolynomialBasis):
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
        """The coefficients themselves: they are a series."""
        return np.asarray(_sized(z, self), dtype=float)


class Bernstein(PolynomialBasis):
    """W_i(k) = C(n, i) k^i (1-k)^(n-i), n the degree: Z lies within the hull of its coefficients.

    Examples
    --------
    >>> Bernstein(1).coefficients(np.array([0.0, 3.0]))
    (-3.0, 3.0)
    """

    name = "bernstein"

    def coefficients(self, series: Array) -> tuple[float, ...]:
        """Bernstein coefficients, converted by exact arithmetic and rounded once."""
        n = self.degree
        powers = exact_powers(fractions(_fitted(series, self.size), "series"))
        return rounded(
            sum((powers[j] * Fraction(comb(i, j), comb(n, j)) for j in range(i + 1)), Fraction(0)) for i in range(n + 1)
        )

    def series(self, z: Sequence[float]) -> Array:
        """Chebyshev series, converted by exact arithmetic and rounded once."""
        n = self.degree
        exact = fractions(_sized(z, self), "z")
        powers = [
            comb(n, j) * sum(((-1) ** (j - i) * comb(j, i) * exact[i] for i in range(j + 1)), Fraction(0))
            for j in range(n + 1)
        ]
        return np.asarray(chebyshev_from_powers(powers), dtype=float)


@dataclass(frozen=True)
class Pieces(Basis):
    """A free law, polynomial between breaks, in place of a Z: few pieces come near the limits.

    Parameters
    ----------
    breaks
        Dimensionless times from 0 to 1, increasing; an integer is the number of equal pieces. Symmetric
        laws need 1/2 among them and the breaks symmetric about it.
    degree
        Degree of a(k) on each piece, at least 2.
    continuity
        Order up to which the derivatives of a are continuous at the breaks, 1 to degree - 1: 2 for a continuous
        acceleration, 3 for a continuous jerk.

    Raises
    ------
    InputError
        If the breaks do not increase from 0 to 1 or the orders do not fit.

    Examples
    --------
    >>> Pieces(4).breaks
    (0.0, 0.25, 0.5, 0.75, 1.0)
    """

    breaks: tuple[float, ...]
    degree: int = 5
    continuity: int = 3
    name = "pieces"

    def __init__(self, breaks: int | Sequence[float], degree: int = 5, continuity: int = 3) -> None:
        object.__setattr__(self, "breaks", places(breaks))
        object.__setattr__(self, "degree", whole(degree, "degree of the pieces", least=2, most=MOST_PIECE_DEGREE))
        object.__setattr__(self, "continuity", order_of_continuity(continuity, self.degree))

    @classmethod
    def around(cls, switches: Sequence[float], width: float, degree: int = 4, continuity: int = 3) -> Pieces:
        """Pieces that allow quick changes of acceleration around the given switches, `width` each.

        Take the breaks of a limit law: the optimum then comes near the limit as the width goes to 0.

        Examples
        --------
        >>> Pieces.around((0.0, 0.5, 1.0), 0.02).breaks
        (0.0, 0.02, 0.49, 0.5, 0.51, 0.98, 1.0)
        """
        width = positive(width, "width")
        half = width / 2.0
        breaks = {0.0, 0.5, 1.0}
        for k in numbers(switches, "switches", MOST_PIECES):
            breaks |= {width} if k == 0.0 else {1.0 - width} if k == 1.0 else {k - half, k + half}
        return cls(sorted({round(k, 15) for k in breaks}), degree, continuity)

    @property
    def mirrored(self) -> bool:
        """Whether the breaks are symmetric about 1/2 and include 1/2."""
        return 0.5 in self.breaks and mirrored(self.breaks)

    def check(self, *, symmetric: bool) -> None:
        """Refuse breaks that are not symmetric where the law is to be."""
        if symmetric and not self.mirrored:
            raise InputError(
                f"a symmetric law needs breaks symmetric about 1/2 and 1/2 among them, got {shortened(self.breaks)}"
            )

    def to_dict(self) -> dict[str, Any]:
        """Name, breaks, degree and continuity."""
        return {"basis": self.name, "breaks": list(self.breaks), "degree": self.degree, "continuity": self.continuity}


_signature = cache(signature)  # which takes ten times as long as the basis itself


def basis(name: str, degree: int, **parameters: Any) -> Basis:
    """The basis called `name` with the given degree and, for B-splines and pieces, breaks and continuity.

    Raises
    ------
    InputError
        If the name is unknown or a parameter does not fit.

    Examples
    --------
    >>> basis("chebyshev", 9)
    Chebyshev(degree=9)
    """
    stated: object = name
    if not isinstance(stated, str) or stated not in Basis.kinds:
        raise InputError(f"basis {shortened(name)} is unknown; known are {', '.join(sorted(Basis.kinds))}")
    kind: Any = Basis.kinds[name]
    taken = _signature(kind).parameters
    for parameter in parameters.keys() - taken.keys():
        having = sorted(other for other, each in Basis.kinds.items() if parameter in _signature(each).parameters)
        raise InputError(f"the basis {name!r} has no {parameter}: leave it out, or take {' or '.join(having)}")
    if "breaks" in taken and "breaks" not in parameters:
        raise InputError(f"the basis {name!r} needs its breaks, such as breaks=8 or breaks=[0, 0.3, 1]")
    return cast("Basis", kind(degree=degree, **parameters))


def _sized(z: Sequence[float], chosen: PolynomialBasis) -> Sequence[float]:
    if len(z) != chosen.size:
        msg = f"{chosen!r} takes {chosen.size} coefficients z, got {len(z)}"
        raise InputError(msg)
    return z


def _fitted(values: Sequence[float] | Array, size: int) -> tuple[float, ...]:
    known = [float(v) for v in values[:size]]
    return tuple(known + [0.0] * (size - len(known)))


@dataclass(frozen=True, init=False)
class PiecewiseBasis(Basis):
    """A chosen basis W_i(k) for Z(k) of functions that are polynomials between breaks, dimensionless.

    A new basis is one subclass: give it a `name`, a `size` and `pieces`.

    Parameters
    ----------
    breaks
        Dimensionless times from 0 to 1, increasing; an integer is the number of equal pieces. Symmetric laws
        need breaks symmetric about 1/2.
    degree
        Degree of Z(k) on each piece, at least 2. The law's is 2l more.
    continuity
        Order up to which the derivatives of Z, and so those of the law, are continuous at the breaks: 1 to degree - 1,
        which it is unless given. 2 keeps the acceleration continuous, 3 the jerk.

    Raises
    ------
    InputError
        If the breaks do not increase from 0 to 1 or the orders do not fit.
    """

    breaks: tuple[float, ...]
    degree: int
    continuity: int

    def __init__(self, breaks: int | Sequence[float], degree: int = 3, continuity: int | None = None) -> None:
        object.__setattr__(self, "breaks", places(breaks))
        object.__setattr__(self, "degree", whole(degree, "degree of Z", least=2, most=MOST_PIECE_DEGREE))
        order = self.degree - 1 if continuity is None else continuity
        object.__setattr__(self, "continuity", order_of_continuity(order, self.degree))

    @property
    @abstractmethod
    def size(self) -> int:
        """The number of basis functions of Z."""

    @abstractmethod
    def pieces(self, z: Sequence[Any]) -> list[list[Any]]:
        """Z(k) = sum z_i W_i(k) on each piece: ascending powers of (k - start) / length, exact where they can be."""

    def check(self, *, symmetric: bool) -> None:
        """Refuse what leaves no freedom, and breaks that are not symmetric where the law is to be."""
        if self.size < (2 if symmetric else 1):
            raise InputError(f"{self!r} leaves no freedom: give more pieces or a higher degree")
        if symmetric and not mirrored(self.breaks):
            raise InputError(f"a symmetric law needs breaks symmetric about 1/2, got {shortened(self.breaks)}")

    def to_dict(self) -> dict[str, Any]:
        """Name, breaks, degree and continuity."""
        return {"basis": self.name, "breaks": list(self.breaks), "degree": self.degree, "continuity": self.continuity}

    def series(self, z: Sequence[float]) -> Array:
        """Chebyshev series of Z on each piece, in a variable from -1 to 1; shape (pieces, degree + 1)."""
        on_pieces = np.zeros((len(self.breaks) - 1, self.degree + 1))
        for row, powers in zip(on_pieces, self.pieces(self.sized(z)), strict=True):
            series = chebyshev_from_powers(powers)
            row[: len(series)] = series
        return on_pieces

    def coefficients(self, series: Array) -> tuple[float, ...]:
        """The z_i of a Z given by its Chebyshev series on each piece, in least squares."""
        values = np.reshape(np.asarray(series, dtype=np.float64), -1)
        return tuple(np.linalg.lstsq(self.functions.reshape(self.size, -1).T, values, rcond=None)[0].tolist())

    @kept_property
    def functions(self) -> Array:
        """Chebyshev series of every W_i on each piece; shape (size, pieces, degree + 1)."""
        return np.stack([self.series(unit) for unit in np.eye(self.size).tolist()])

    def sized(self, z: Sequence[Any]) -> list[Fraction]:
        """The exact values of as many coefficients as there are functions.

        Raises
        ------
        InputError
            If there are more or less, or one is not a finite number.
        """
        if len(z) != self.size:
            raise InputError(f"{self!r} takes {self.size} coefficients z, got {len(z)}")
        return fractions(z, "z")


class BSplines(PiecewiseBasis):
    """Z(k) in B-splines: W_i >= 0 live on a few pieces each and add up to 1, so the z_i enclose Z.

    Examples
    --------
    >>> BSplines(4, degree=3).size, BSplines((0, 0.2, 0.8, 1), degree=3, continuity=1).size
    (7, 8)
    >>> BSplines(2, degree=2).pieces([1, 1, 1, 1])[0]
    [Fraction(1, 1), Fraction(0, 1), Fraction(0, 1)]
    """

    name = "bsplines"

    @property
    def mirrored(self) -> bool:
        """Whether the breaks are symmetric about 1/2."""
        return mirrored(self.breaks)

    @property
    def size(self) -> int:
        """The number of the B-splines."""
        return (len(self.breaks) - 1) * (self.degree - self.continuity) + self.continuity + 1

    @kept_property
    def knots(self) -> tuple[float, ...]:
        """The breaks with their multiplicities, as `scipy.interpolate.BSpline` takes them."""
        inner = [k for k in self.breaks[1:-1] for _ in range(self.degree - self.continuity)]
        return (*[0.0] * (self.degree + 1), *inner, *[1.0] * (self.degree + 1))

    def pieces(self, z: Sequence[Any]) -> list[list[Fraction]]:
        """Ascending powers on each piece in exact arithmetic: Bernstein coefficients are values of the blossom."""
        exact, knots = fractions(z, "z"), fractions(self.knots, "knots")
        n, step = self.degree, self.degree - self.continuity
        powers = []
        for i, (low, high) in enumerate(pairwise(fractions(self.breaks, "breaks"))):
            first = i * step
            control, around = exact[first : first + n + 1], knots[first + 1 : first + 2 * n + 1]
            bernstein = [_blossom(control, around, [low] * (n - j) + [high] * j) for j in range(n + 1)]
            powers.append(
                [
                    comb(n, m) * sum(((-1) ** (m - j) * comb(m, j) * bernstein[j] for j in range(m + 1)), Fraction(0))
                    for m in range(n + 1)
                ]
            )
        return powers


def _blossom(values: Sequence[Fraction], knots: Sequence[Fraction], at: Sequence[Fraction]) -> Fraction:
    """The symmetric function, affine in each argument, whose diagonal is the piece; by de Boor's recurrence."""
    if not any(values):
        return Fraction(0)
    row, n = list(values), len(at)
    for level, k in enumerate(at):
        width = n - level
        row = [
            row[i] + (row[i + 1] - row[i]) * (k - knots[i + level]) / (knots[i + n] - knots[i + level])
            for i in range(width)
        ]
    return row[0]
