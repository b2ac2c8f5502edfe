"""What the laws of a basis look like: degree, breaks, continuity."""

from __future__ import annotations

from fractions import Fraction
from functools import singledispatch
from typing import NamedTuple

from optlaws.errors import InputError
from optlaws.synthesis.spaces.bases import Basis, Pieces, PolynomialBasis
from optlaws.synthesis.spaces.splines import PiecewiseBasis


class Shape(NamedTuple):
    """Degree of a(k) on each piece, the breaks, and up to which order its derivatives are continuous there."""

    degree: int
    breaks: list[Fraction]
    continuity: int


@singledispatch
def shape_of(basis: Basis, order: int) -> Shape:  # noqa: ARG001 - of a known basis
    """The shape of the laws of a basis and order.

    Raises
    ------
    InputError
        If the basis is of an unknown kind.

    Examples
    --------
    >>> shape_of(Pieces(2), 3)
    Shape(degree=5, breaks=[Fraction(0, 1), Fraction(1, 2), Fraction(1, 1)], continuity=3)
    """
    raise InputError(
        f"exact verification knows laws with Z in polynomials or in splines, and laws of pieces, not {basis!r}"
    )


@shape_of.register
def _(basis: PolynomialBasis, order: int) -> Shape:
    # without a Z there are 2l conditions, with one l more powers at either end
    return Shape(2 * order + basis.degree, [Fraction(0), Fraction(1)], 0)


@shape_of.register
def _(basis: PiecewiseBasis, order: int) -> Shape:
    return Shape(2 * order + basis.degree, [Fraction(k) for k in basis.breaks], basis.continuity)


@shape_of.register
def _(basis: Pieces, order: int) -> Shape:  # noqa: ARG001 - the end conditions are equations
    return Shape(basis.degree, [Fraction(k) for k in basis.breaks], basis.continuity)
