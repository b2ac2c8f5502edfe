"""The space of laws of each kind of basis, one line for each kind."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from optlaws.errors import InputError
from optlaws.synthesis.spaces.bases import Basis, Chebyshev, Pieces, PolynomialBasis
from optlaws.synthesis.spaces.end_conditions import BoundaryConditions
from optlaws.synthesis.spaces.free_pieces import PeriodicPieces, PeriodicSpace, PieceSpace
from optlaws.synthesis.spaces.polynomial_space import PolynomialSpace
from optlaws.synthesis.spaces.space import LawSpace
from optlaws.synthesis.spaces.spline_space import SplineSpace
from optlaws.synthesis.spaces.splines import PiecewiseBasis

_CONVERSION_AGREES = 1e-8  # how near conversions between bases come, where even powers lose no digits

#: the greatest degree at which conversions are compared, where even powers lose no digits, and how near they come
_CHECKED = 6


#: the space of each kind of basis, of a special kind before those that it is one of
_SPACES: tuple[tuple[type[Basis], Callable[..., LawSpace]], ...] = (
    (PolynomialBasis, PolynomialSpace),
    (PeriodicPieces, PeriodicSpace),
    (Pieces, PieceSpace),
    (PiecewiseBasis, SplineSpace),
)


@lru_cache(maxsize=64)
def space_of(basis: Basis, boundary: BoundaryConditions, *, symmetric: bool) -> LawSpace:
    """The space of laws with the given basis and end conditions, cached for the next call.

    Raises
    ------
    InputError
        If there is none for this kind of basis, or its conversions contradict each other.

    Examples
    --------
    >>> space_of(Chebyshev(9), BoundaryConditions.rest(4), symmetric=True).terms
    5
    """
    if isinstance(basis, PolynomialBasis) and type(basis) is not Chebyshev:
        check_conversions(replace(basis, degree=min(basis.degree, _CHECKED)))
        return space_of(Chebyshev(basis.degree), boundary, symmetric=symmetric)
    for kind, space in _SPACES:
        if isinstance(basis, kind):
            return space(boundary, basis, symmetric=symmetric)
    raise InputError(f"there is no space of laws for {basis!r}: a basis is of polynomials, pieces or splines")


def check_conversions(basis: PolynomialBasis) -> None:
    """See that a basis leads from a Chebyshev series to its coefficients and back."""
    # any numbers do, and those of numpy.random take as long to import as a law takes to solve
    for turn in (1.0, 2.0):
        given = np.cos(turn * np.arange(1.0, basis.size + 1.0) ** 2)
        coefficients = np.asarray(basis.coefficients(given), dtype=np.float64)
        back = np.zeros(basis.size)
        series = np.asarray(basis.series(tuple(coefficients.tolist())), dtype=np.float64)
        if coefficients.shape == back.shape and series.ndim == 1 and len(series) <= len(back):
            back[: len(series)] = series
            if np.abs(back - given).max() <= _CONVERSION_AGREES:
                continue
        raise InputError(
            f"{type(basis).__name__}.coefficients and .series contradict each other at degree {basis.degree}: the "
            f"series {_shown(given)} comes back as {_shown(series)}. series(coefficients(s)) must be s, with "
            f"{basis.size} coefficients"
        )


def _shown(series: NDArray[np.float64]) -> str:
    return f"[{', '.join(f'{value:.4g}' for value in np.ravel(series)[: _CHECKED + 1])}]"
