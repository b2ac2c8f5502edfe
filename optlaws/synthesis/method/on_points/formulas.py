"""Rows of formulas as CasADi expressions, whose numbers are parameters: built once per formula and number of places."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from optlaws.formulas.arithmetic import casadi_arithmetic, evaluate
from optlaws.formulas.branches import rounded
from optlaws.formulas.tree import Formula
from optlaws.synthesis.families.curved import CurvedFamily, IntegralFamily, OfFormula
from optlaws.synthesis.families.family import Points
from optlaws.synthesis.families.kinked import KinkedIntegralFamily

Array = NDArray[np.float64]

_LEAST_ROOT = 1e-24
_RADIUS = 0.003


@dataclass(frozen=True)
class FormulaShape:
    """What the rows of a formula look like.

    Attributes
    ----------
    formula, names
        The formula, and the names in it but k.
    places
        At how many it is asked.
    rows
        How many rows that makes: one for each place, or one for the sum over all.
    root
        Whether the root of the sum is meant.
    """

    formula: Formula
    names: tuple[str, ...]
    places: int
    rows: int
    root: bool = False


def shape_of(family: OfFormula, points: Points) -> FormulaShape:
    """The shape of a family's rows at points."""
    if isinstance(family, IntegralFamily):
        # interior points need slopes that do not leap
        formula = rounded(family.formula, _RADIUS) if isinstance(family, KinkedIntegralFamily) else family.formula
        return FormulaShape(formula, family.names, len(family.places), 1, family.root)
    assert isinstance(family, CurvedFamily)  # noqa: S101 - there are no others
    return FormulaShape(family.formula, family.names, len(points.u), len(points.u))


def numbers_of(family: OfFormula, points: Points) -> list[Array]:
    """The columns of each name, the places, their signs or weights, and the slack."""
    if isinstance(family, IntegralFamily):
        return [*family.columns, family.places[:, None], family.weights[:, None], family.slack[None]]
    assert isinstance(family, CurvedFamily)  # noqa: S101 - there are no others
    columns = family.columns(points.u)[:, 0]
    return [*columns, family.k(points.u)[:, None], points.s[:, None], family.slack[None]]


def symbols_of(size: int, shape: FormulaShape) -> list[Any]:
    """Symbols for these numbers."""
    import casadi as ca

    columns = [ca.MX.sym(name, shape.places, size + 1) for name in shape.names]
    return [*columns, ca.MX.sym("k", shape.places), ca.MX.sym("weights", shape.places), ca.MX.sym("room", 1, size)]


def expression_of(x: Any, symbols: list[Any], shape: FormulaShape) -> Any:  # noqa: ANN401 - casadi's, imported late
    """The rows less their slack."""
    import casadi as ca

    *columns, k, weights, room = symbols
    point = ca.vertcat(x, 1)
    names = {name: column @ point for name, column in zip(shape.names, columns, strict=True)}
    values = weights * evaluate(shape.formula, {**names, "k": k}, casadi_arithmetic())
    if shape.rows == shape.places and not shape.root and shape.rows != 1:
        return values - ca.repmat(room @ x, shape.places, 1)
    total = ca.sum1(values)
    return (ca.sqrt(total + _LEAST_ROOT) if shape.root else total) - room @ x
