"""Bases of Z(k) that are polynomials between breaks: B-splines, and what others of the kind must offer."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from math import comb
from typing import Any

import numpy as np

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.numbers import MOST_PIECE_DEGREE, Array, fractions, whole
from optlaws.numerics.exact import chebyshev_from_powers
from optlaws.synthesis.spaces.bases import Basis, mirrored, order_of_continuity, places


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
