"""Which space of laws belongs to a basis: one line for each kind."""

from __future__ import annotations

from functools import singledispatch

from optlaws.errors import InputError
from optlaws.synthesis.spaces.bases import Basis, Pieces, PolynomialBasis
from optlaws.synthesis.spaces.end_conditions import BoundaryConditions
from optlaws.synthesis.spaces.pieces.free import PieceSpace, piece_space
from optlaws.synthesis.spaces.pieces.periodic import PeriodicPieces, PeriodicSpace, periodic_space
from optlaws.synthesis.spaces.pieces.splines import SplineSpace, spline_space
from optlaws.synthesis.spaces.polynomials.space import PolynomialSpace, polynomial_space
from optlaws.synthesis.spaces.space import LawSpace
from optlaws.synthesis.spaces.splines import PiecewiseBasis


@singledispatch
def space_of(basis: Basis, boundary: BoundaryConditions, *, symmetric: bool) -> LawSpace:
    """The space of laws with the given basis and end conditions; register one for a new kind of basis.

    Raises
    ------
    InputError
        If none is registered.

    Examples
    --------
    >>> from optlaws.synthesis.spaces.bases import Chebyshev
    >>> space_of(Chebyshev(9), BoundaryConditions.rest(4), symmetric=True).terms
    5
    """
    raise InputError(f"no space of laws is registered for {basis!r} (boundary {boundary!r}, symmetric {symmetric!r})")


@space_of.register
def _(basis: PolynomialBasis, boundary: BoundaryConditions, *, symmetric: bool) -> PolynomialSpace:
    return polynomial_space(boundary, basis.degree, symmetric=symmetric)


@space_of.register
def _(basis: Pieces, boundary: BoundaryConditions, *, symmetric: bool) -> PieceSpace:
    return piece_space(boundary, basis.breaks, basis.degree, basis.continuity, symmetric=symmetric)


@space_of.register
def _(basis: PeriodicPieces, boundary: BoundaryConditions, *, symmetric: bool) -> PeriodicSpace:  # noqa: ARG001 - never
    return periodic_space(boundary, basis)


@space_of.register
def _(basis: PiecewiseBasis, boundary: BoundaryConditions, *, symmetric: bool) -> SplineSpace:
    return spline_space(boundary, basis, symmetric=symmetric)
