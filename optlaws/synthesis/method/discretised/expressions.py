"""Rows that are not affine in the law as CasADi expressions, whose numbers are parameters: a table of their kinds.

A solver is built once per shape of its rows, and called with the numbers of any program of these shapes.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable
from dataclasses import dataclass
from typing import Any

import numpy as np

from optlaws.formulas.arithmetic import casadi_arithmetic, evaluate
from optlaws.formulas.branches import rounded
from optlaws.numbers import Array
from optlaws.synthesis.families.cone import ConeFamily
from optlaws.synthesis.families.curved import FormulaFamily, IntegralFamily
from optlaws.synthesis.families.energy import EnergyFamily
from optlaws.synthesis.families.family import ConstraintFamily, NormFamily, Points, ProductFamily
from optlaws.synthesis.families.kinked import KinkedIntegralFamily
from optlaws.tolerances import LEAST_ENERGY

_KINK_RADIUS = 0.003  # of hyperbolas in place of kinks, in units of the problem
_SMOOTH_NORM = 1e-12  # keeps a norm's slope finite where it vanishes; Newton's method goes without it
_LEAST_SUM = 1e-24  # under a root in IPOPT's expressions: its slope stays finite


def _product_numbers(family: ProductFamily, points: Points) -> list[Array]:
    first, second = (factor.columns(points.u)[0] for factor in (family.first, family.second))
    return [first * points.s[:, None], second, family.slack[None]]


def _product(point: Any, symbols: list[Any], _: Hashable) -> Any:
    return (symbols[0] @ point) * (symbols[1] @ point)


def _cone_numbers(family: ConeFamily, points: Points) -> list[Array]:
    columns, right = family.columns(points.u)[0], np.append(family.slack, family.bound)
    return [columns.real, columns.imag, np.tile(right, (len(points.u), 1)), np.zeros((1, len(family.slack)))]


def _cone(point: Any, symbols: list[Any], _: Hashable) -> Any:
    # |p| <= r as |p|²/r <= r: convex as well, and smooth where p vanishes
    real, imaginary, right = (symbol @ point for symbol in symbols)
    return (real**2 + imaginary**2) / right - right


def _norm_numbers(family: NormFamily, _: Points) -> list[Array]:
    return [family.matrix, family.slack[None]]


def _norm(point: Any, symbols: list[Any], _: Hashable) -> Any:
    import casadi as ca

    return ca.sqrt(ca.sumsqr(symbols[0] @ point) + _SMOOTH_NORM)


def _energy_numbers(family: EnergyFamily, points: Points) -> list[Array]:
    """Rows of the factors, of both parts of the energy, and of these at the nodes of its integral."""
    energy = family.energy
    first, *others = [factor.columns(points.u)[0] for factor in family.factors]
    columns = [first * (family.scale * points.s)[:, None], *others]
    if family.divided:
        columns += [part.columns(points.u)[0] for part in (energy.below, energy.above)]
    return [*columns, *energy.columns, family.slack[None]]


def _energy_detail(family: EnergyFamily) -> Hashable:
    return len(family.factors), family.degree, family.divided


def _energy(point: Any, symbols: list[Any], detail: Any) -> Any:
    import casadi as ca

    *parts, below, above = symbols
    factors, degree, divided = detail

    def root(first: Any, second: Any) -> Any:
        top = second @ point
        return ca.sqrt(ca.fmax((first @ point) * top, LEAST_ENERGY * top**2))

    Y = 0.5 / ca.sum1(root(below, above))
    product = Y**degree
    for factor in parts[:factors]:
        product = product * (factor @ point)
    return product / root(*parts[factors:]) if divided else product


def _formula_numbers(family: Any, points: Points) -> list[Array]:
    """The columns of each name, the places, and their signs or weights."""
    if isinstance(family, IntegralFamily):
        return [*family.columns, family.places[:, None], family.weights[:, None], family.slack[None]]
    return [*family.columns(points.u)[:, 0], family.k(points.u)[:, None], points.s[:, None], family.slack[None]]


def _formula_detail(family: Any) -> Hashable:
    """The formula, its names, whether it is summed over its places, and whether the root of that is meant."""
    if not isinstance(family, IntegralFamily):
        return family.formula, family.names, False, False
    formula = rounded(family.formula, _KINK_RADIUS) if isinstance(family, KinkedIntegralFamily) else family.formula
    return formula, family.names, True, family.root


def _formula(point: Any, symbols: list[Any], detail: Any) -> Any:
    import casadi as ca

    *columns, k, weights = symbols
    formula, names, summed, root = detail
    at = {name: column @ point for name, column in zip(names, columns, strict=True)}
    values = weights * evaluate(formula, {**at, "k": k}, casadi_arithmetic())
    total = ca.sum1(values) if summed else values
    return ca.sqrt(total + _LEAST_SUM) if root else total


@dataclass(frozen=True)
class RowKind:
    """The rows of one kind of family.

    Attributes
    ----------
    family
        The kind.
    numbers
        Of a family and points the matrices of numbers, the right side in the variables last.
    values
        The function at the points, of the variables and 1, of symbols for all matrices but the last, and of details.
    detail
        What the function of a family depends on beside numbers.
    bounded
        Whether the number on the right side stands there, not among the matrices.
    share
        What multipliers of these rows are times to be those of the family's own.
    """

    family: type[Any]
    numbers: Callable[[Any, Points], list[Array]]
    values: Callable[[Any, list[Any], Any], Any]
    detail: Callable[[Any], Hashable] = lambda _: None
    bounded: bool = True
    share: float = 1.0


#: in the order of their rows; a cone's row as IPOPT sees it is twice as steep as the magnitude itself
CONES = RowKind(ConeFamily, _cone_numbers, _cone, bounded=False, share=2.0)
KINDS = (
    RowKind(ProductFamily, _product_numbers, _product),
    CONES,
    RowKind(NormFamily, _norm_numbers, _norm),
    RowKind(EnergyFamily, _energy_numbers, _energy, _energy_detail),
    RowKind(FormulaFamily, _formula_numbers, _formula, _formula_detail),
)


def order_of(family: ConstraintFamily) -> int:
    """The rank of a family's rows among those of all kinds; 0 for affine ones."""
    return next((i for i, kind in enumerate(KINDS, 1) if isinstance(family, kind.family)), 0)


@dataclass(frozen=True)
class RowShape:
    """The shape of a family's rows without their numbers: how many, their kind, the sizes of matrices, and more."""

    count: int
    kind: RowKind
    sizes: tuple[tuple[int, ...], ...]
    detail: Hashable

    def symbols(self) -> list[Any]:
        """Symbols that stand for the numbers of the rows."""
        import casadi as ca

        return [ca.MX.sym("numbers", *size) for size in self.sizes]

    def expression(self, x: Any, symbols: list[Any]) -> Any:
        """The rows with their right sides subtracted."""
        import casadi as ca

        *numbers, slack = symbols
        return self.kind.values(ca.vertcat(x, 1), numbers, self.detail) - ca.repmat(slack @ x, self.count, 1)


def shape_and_numbers(family: ConstraintFamily, points: Points) -> tuple[RowShape, list[Array]]:
    """The shape of the rows of a family that is not affine, and their numbers."""
    kind = KINDS[order_of(family) - 1]
    numbers = kind.numbers(family, points)
    sizes = tuple(matrix.shape for matrix in numbers)
    return RowShape(len(points.u), kind, sizes, kind.detail(family)), numbers
