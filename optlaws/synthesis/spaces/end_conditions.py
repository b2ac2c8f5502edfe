"""The construction of eq. 8: end conditions -> a0, a1, and with any Z(k) -> a law."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from math import comb, factorial
from typing import Any, Self, overload

from optlaws.errors import InputError
from optlaws.laws import PolynomialLaw
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.laws.segments.segment import PolynomialSegment
from optlaws.numbers import MOST_ORDER, fractions, listed, whole
from optlaws.numerics.exact import Polynomial, chebyshev_from_powers, edge, exact_powers, plus, shifted, times
from optlaws.synthesis.spaces.bases import PiecewiseBasis, PolynomialBasis, Powers


def piecewise_law(
    base: Polynomial, order: int, breaks: Sequence[float], pieces: Sequence[Sequence[Any]]
) -> PiecewiseLaw:
    """The law base(k) + k^l (k-1)^l Z(k).

    Parameters
    ----------
    base
        Ascending powers of k of the law with Z = 0.
    order
        The order l.
    breaks
        Where the pieces of Z begin and end.
    pieces
        Z on each piece, ascending powers of (k - start) / length.

    Examples
    --------
    >>> from fractions import Fraction
    >>> law = piecewise_law([Fraction(n) for n in (0, 0, 3, -2)], 2, (0.0, 0.5, 1.0), [[0, 8], [8, -8]])
    >>> len(law.segments), law.a(0.5), law.c(0.0)
    (2, 1.0, 6.0)
    """
    segments = []
    for (low, high), z in zip(pairwise(fractions(breaks, "breaks")), pieces, strict=True):
        length = high - low
        around, local = (
            [value * length**i for i, value in enumerate(shifted(coefficients, low))]
            for coefficients in (edge(order), base)
        )
        a = plus(local, times(around, fractions(z, "Z")))
        c = [(i + 1) * (i + 2) * value / length**2 for i, value in enumerate(a[2:])]
        segments.append(PolynomialSegment(chebyshev_from_powers(c), b0=float(a[1] / length)))
    return PiecewiseLaw(breaks, segments, a0=float(base[0]))


@dataclass(frozen=True)
class BoundaryConditions:
    """Values of a, b, c, c', ... at k = 0 and at k = 1 (eq. 1, 2), as many at one end as at the other.

    Parameters
    ----------
    start, end
        The l values at each end, dimensionless; ints, floats or Fractions.

    Raises
    ------
    InputError
        If there is no value, a value is not a finite number, or the ends have not as many.

    Examples
    --------
    >>> BoundaryConditions.rest(2)
    BoundaryConditions(start=(0, 0), end=(1, 0))
    >>> BoundaryConditions(start=(0, 0), end=(1, 0.5)).order
    2
    """

    start: tuple[Any, ...]
    end: tuple[Any, ...]

    def __post_init__(self) -> None:
        object.__setattr__(self, "start", tuple(listed(self.start, "start", MOST_ORDER)))
        object.__setattr__(self, "end", tuple(listed(self.end, "end", MOST_ORDER)))
        if len(self.start) != len(self.end) or not self.start:
            raise InputError(
                "boundary conditions need as many values at the start as at the end, at least one; "
                f"got {len(self.start)} and {len(self.end)}"
            )
        fractions(self.start, "start")
        fractions(self.end, "end")

    @classmethod
    def rest(cls, order: int) -> Self:
        """Rest to rest: 0, 0, ... at k = 0 and 1, 0, ... at k = 1, `order` values each.

        Raises
        ------
        InputError
            If `order` is not an integer of at least 1.
        """
        count = whole(order, "order", least=1, most=MOST_ORDER)
        return cls((0,) * count, (1,) + (0,) * (count - 1))

    @property
    def order(self) -> int:
        """The number l of conditions at each end."""
        return len(self.start)

    def a0(self) -> Polynomial:
        """Ascending powers of the a0(k) of eq. 8, exact: the Taylor polynomial of the start."""
        return [value / factorial(i) for i, value in enumerate(fractions(self.start, "start"))]

    def a1(self) -> Polynomial:
        """Ascending powers of the a1(k) of eq. 8, exact.

        It is the Taylor polynomial at k = 1, of degree l - 1, of (prescribed end - a0(k)) / k^l.
        """
        order = self.order
        end = [value / factorial(i) for i, value in enumerate(fractions(self.end, "end"))]
        missing = [e - a for e, a in zip(end, shifted(self.a0(), 1), strict=True)]
        inverse = [Fraction((-1) ** i * comb(order + i - 1, i)) for i in range(order)]
        return shifted(times(missing, inverse)[:order], -1)


@overload
def law_from_z(
    boundary: BoundaryConditions, z: Iterable[Any] = (), basis: PolynomialBasis | None = None
) -> PolynomialLaw: ...
@overload
def law_from_z(boundary: BoundaryConditions, z: Iterable[Any], basis: PiecewiseBasis) -> PiecewiseLaw: ...
@overload
def law_from_z(
    boundary: BoundaryConditions, z: Iterable[Any], basis: PolynomialBasis | PiecewiseBasis
) -> PolynomialLaw | PiecewiseLaw: ...
def law_from_z(
    boundary: BoundaryConditions, z: Iterable[Any] = (), basis: PolynomialBasis | PiecewiseBasis | None = None
) -> PolynomialLaw | PiecewiseLaw:
    """The law a(k) = a0(k) + k^l [a1(k) + (k-1)^l Z(k)] (eq. 8), built in exact arithmetic and rounded once.

    Parameters
    ----------
    boundary
        End conditions; no choice of Z breaks them.
    z
        Coefficients of Z, dimensionless; ascending powers of k unless a basis is given.
    basis
        The basis that `z` belongs to. With B-splines the law is piecewise.

    Raises
    ------
    InputError
        If `z` does not fit the basis or is not finite.

    Examples
    --------
    >>> law_from_z(BoundaryConditions.rest(2), [-3, 6]) == law_from_z(BoundaryConditions.rest(3))
    True
    >>> law_from_z(BoundaryConditions(start=(0, 0), end=(1, 0.25))).b([0, 1]).tolist()
    [0.0, 0.25]
    """
    order = boundary.order
    a0, a1 = boundary.a0(), boundary.a1()
    if isinstance(basis, PiecewiseBasis):
        base = plus(a0, [Fraction(0)] * order + a1)
        return piecewise_law(base, order, basis.breaks, basis.pieces(basis.sized(list(z))))
    bracket = plus(a1, times(edge(order)[order:], _powers_of(list(z), basis)))
    return PolynomialLaw.from_powers(plus(a0, [Fraction(0)] * order + bracket))


def _powers_of(z: Sequence[Any], basis: PolynomialBasis | None) -> Polynomial:
    if basis is None or isinstance(basis, Powers):
        if basis is not None and len(z) != basis.size:
            raise InputError(f"{basis!r} takes {basis.size} coefficients z, got {len(z)}")
        return fractions(z, "z")
    return exact_powers(fractions(basis.series(z), "z"))
