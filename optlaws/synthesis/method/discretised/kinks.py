"""Linear programs that show where an integral's formula has its kinks.

What is the greatest of affine formulas is a variable above each: an integral of max(p, q) is a sum over places of the
least variables above both. Where p and q are affine that is the program itself but for the rule.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from optlaws.formulas.branches import switches
from optlaws.formulas.convexity import affine
from optlaws.formulas.of_motion import MotionFormula
from optlaws.formulas.slopes import added, multiplied, opposite
from optlaws.formulas.tree import Call, Formula, Name, Negative, Number, Product, Sum
from optlaws.numbers import Array
from optlaws.numerics.chebyshev import gauss
from optlaws.synthesis.families.family import ConstraintFamily, LinearFamily, Points, Program
from optlaws.synthesis.families.kinked import KinkedIntegralFamily
from optlaws.synthesis.method.discretised.on_points import Answer

_CELL, _PER_VARIABLE = 6, 10
_OPTIMAL = 0
#: how far the program may go, in times the greatest variable: beyond what laws of the field have
_REACH = 1e4


@dataclass(frozen=True, eq=False)
class _LinearRows:
    """Rows of variables and, in a sparse matrix, of the places' local variables, with their right sides."""

    matrix: Array
    local: Any
    most: Array
    weigh: Callable[[Array], Array]  #: multipliers of the family's own points from those of these rows


class _Epigraph:
    """A formula with kinks, as a name and local variables that bound its parts from above or below."""

    def __init__(self, formula: Formula, names: tuple[str, ...], k: Array) -> None:
        self.names, self.k = names, k
        self.local: list[str] = []
        self.negative: list[Formula] = []  #: what is at most 0
        self.whole = self._of(formula, 1)

    def _of(self, formula: Formula, sign: int) -> Formula:
        """The epigraph form of a formula times a signed factor; parts that are no sums of maxima stay."""
        if not switches(formula, self.names):
            return formula
        if isinstance(formula, Negative):
            return opposite(self._of(formula.of, -sign))
        if isinstance(formula, Sum):
            return added([self._of(term, sign) for term in formula.terms])
        if isinstance(formula, Product):
            kinked = next(factor for factor in formula.factors if switches(factor, self.names))
            weight = multiplied([factor for factor in formula.factors if factor is not kinked])
            if not weight.names() & set(self.names):
                values = _at(weight, self.k)
                if (values >= 0.0).all() or (values <= 0.0).all():
                    return multiplied([weight, self._of(kinked, sign if (values >= 0.0).all() else -sign)])
        if isinstance(formula, Call) and (formula.function, sign) in {("abs", 1), ("max", 1), ("min", -1)}:
            parts = (
                formula.arguments if formula.function != "abs" else (*formula.arguments, opposite(formula.arguments[0]))
            )
            local = Name(str(len(self.local)))
            self.local.append(local.name)
            for part in parts:
                above = added([self._of(part, sign), opposite(local)])
                self.negative.append(above if sign > 0 else opposite(above))
            return local
        return formula


def straight_optimum(program: Program, points: list[Points], x: Array, places: int) -> Answer | None:
    """The optimum near x of a program that is linear except for kinks of maxima, these between places.

    None where the program is another, or has no optimum.

    Parameters
    ----------
    program, points
        What is solved, and where its families but integrals are grid.
    x
        Where the step begins.
    places
        How many of each integral are looked at, at the least.
    """
    from scipy import sparse
    from scipy.optimize import linprog

    reach = _REACH * max(1.0, float(np.abs(x).max()))
    grid = [_rows(family, points, places) for family, points in zip(program.families, points, strict=True)]
    rows = [part for part in grid if part is not None]
    if len(rows) < len(grid):
        return None
    local = sparse.block_diag([part.local for part in rows], "csr")
    others = np.zeros(local.shape[1])
    equations = np.hstack([program.equalities, np.zeros((len(program.right), len(others)))])
    solve: Any = linprog
    optimum = solve(
        np.append(program.objective, others),
        A_ub=sparse.hstack([sparse.csr_matrix(np.vstack([part.matrix for part in rows])), local], "csr"),
        b_ub=np.concatenate([part.most - part.matrix @ x for part in rows]),
        A_eq=equations if len(program.right) else None,
        b_eq=program.right - program.equalities @ x if len(program.right) else None,
        bounds=[(-reach, reach)] * program.size + [(None, None)] * len(others),
        method="highs",
    )
    if optimum.status != _OPTIMAL:
        return None
    ends = np.cumsum([len(part.most) for part in rows])[:-1]
    marginals = np.split(-optimum.ineqlin.marginals, ends)
    weights = [part.weigh(multipliers) for part, multipliers in zip(rows, marginals, strict=True)]
    equations = -optimum.eqlin.marginals if len(program.right) else np.zeros(0)
    there = x + optimum.x[: program.size]
    return Answer(there, [*weights, equations], success=True, status="a linear program", iterations=int(optimum.nit))


def _rows(family: ConstraintFamily, points: Points, places: int) -> _LinearRows | None:
    """Linear rows of a family; None if it is not linear apart from kinks."""
    from scipy import sparse

    if isinstance(family, KinkedIntegralFamily):
        return _rows_of_integral(family, places)
    if not isinstance(family, LinearFamily):
        return None
    matrix, most = family.rows(points.u, points.s)
    length = np.linalg.norm(matrix, axis=1)
    used = np.isfinite(most) & (length > 0.0)

    def weigh(multipliers: Array) -> Array:
        weights = np.zeros(len(used))
        weights[used] = multipliers / length[used]
        return weights

    local = sparse.csr_matrix((used.sum(), 0))
    return _LinearRows(matrix[used] / length[used, None], local, most[used] / length[used], weigh)


def _rows_of_integral(family: KinkedIntegralFamily, places: int) -> _LinearRows | None:
    """The rows of its local variables and the integral's row; None unless it is convex and piecewise affine."""
    from scipy import sparse

    if not family.convex or family.root:
        return None
    k, weights = _rule(family, places)
    epigraph, columns = _Epigraph(family.formula, family.names, k), family.columns_at(k)
    names, matrices, shares = (*family.names, *epigraph.local), [], []
    for formula in (*epigraph.negative, epigraph.whole):
        form = affine(formula, names)
        if form is None:
            return None
        factors = dict(form.factors)
        at = np.array([_at(factors.get(name, Number(0.0)), k) for name in names])
        matrix = np.einsum("ip,ipn->pn", at[: len(columns)], columns)
        matrix[:, -1] += _at(form.rest, k)
        matrices.append(matrix)
        shares.append(sparse.hstack([sparse.diags(share) for share in at[len(columns) :]], "csr"))
    matrices[-1], shares[-1] = weights[None] @ matrices[-1], sparse.csr_matrix(weights[None] @ shares[-1])
    matrices[-1][0] -= np.append(family.slack, family.bound)
    rows = np.vstack(matrices)
    return _LinearRows(rows[:, :-1], sparse.vstack(shares), -rows[:, -1], lambda multipliers: multipliers[-1:])


def _at(formula: Formula, k: Array) -> Array:
    return np.broadcast_to(MotionFormula(formula).values({"k": k}), k.shape)


def _rule(family: KinkedIntegralFamily, places: int) -> tuple[Array, Array]:
    """Places and weights, enough to see where kinks are."""
    x, share = gauss(_CELL)
    cells = -(-max(places, _PER_VARIABLE * len(family.slack)) // (_CELL * (len(family.edges) - 1)))
    edges = np.concatenate(
        [
            *(np.linspace(a, b, cells + 1)[:-1] for a, b in zip(family.edges, family.edges[1:], strict=False)),
            family.edges[-1:],
        ]
    )
    low, width = edges[:-1, None], np.diff(edges)[:, None]
    return (low + width * (1.0 + x) / 2.0).ravel(), (share * width / 2.0).ravel()
