"""Sums of squares: what formulas that are quadratic in the law are, as cones take them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from optlaws.numbers import Array


class _Expanded(Protocol):
    """A formula's values and derivatives by its names."""

    def value(self, at: Mapping[str, Array]) -> Array: ...
    def gradient(self, at: Mapping[str, Array]) -> Array: ...
    def hessian(self, at: Mapping[str, Array]) -> Array: ...


@dataclass(frozen=True, eq=False)
class SumOfSquares:
    """The function |rows . (x, 1)|² + affine . (x, 1), or where `root` the norm |rows . (x, 1)|.

    Attributes
    ----------
    rows, affine
        Shapes (rows, variables + 1) and (variables + 1,).
    root
        Whether the root is meant; nothing affine is under it.
    """

    rows: Array
    affine: Array
    root: bool = False


def sum_of_squares(
    slopes: _Expanded, at: Mapping[str, Array], columns: Array, weights: Array, *, root: bool = False
) -> SumOfSquares:
    """The sum over places of a formula that is quadratic in its names, and convex, times weights above 0.

    Parameters
    ----------
    slopes
        The formula with its derivatives by the names.
    at
        Where it is expanded: every name 0, and k.
    columns
        What the names are in the variables, shape (names, places, variables + 1).
    weights
        Of the places.
    root
        Whether its root is meant.
    """
    sizes, axes = np.linalg.eigh(slopes.hessian(at).transpose(2, 0, 1) / 2.0)
    # it is convex: what is below 0 is rounding
    lengths = np.sqrt(np.maximum(sizes, 0.0) * weights[:, None])
    rows = np.einsum("pij,pj,ipn->pjn", axes, lengths, columns).reshape(-1, columns.shape[2])
    affine = np.einsum("ip,ipn->n", slopes.gradient(at) * weights, columns)
    affine[-1] += float(weights @ slopes.value(at))
    return SumOfSquares(rows, affine, root)
