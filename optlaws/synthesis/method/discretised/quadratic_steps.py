"""Programs on finitely many points by quadratic programs, one after the other, with exact second derivatives.

For families that are smooth only once, such as integrals of formulas with kinks: interior points need more. Each step
is the optimum of the program with straight constraints and the curvature of the Lagrangian, damped until it pays.

A linear program shows where an integral's formula has its kinks: what is the greatest of affine formulas is a variable
above each, so an integral of max(p, q) is a sum over places of the least variables above both. Where p and q are affine
that is the program itself but for the rule.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from optlaws.formulas.branches import switches
from optlaws.formulas.convexity import affine
from optlaws.formulas.of_motion import MotionFormula
from optlaws.formulas.slopes import added, multiplied, opposite
from optlaws.formulas.tree import Call, Formula, Name, Negative, Number, Product, Sum
from optlaws.numbers import Array
from optlaws.numerics.chebyshev import gauss
from optlaws.numerics.cones import INFEASIBLE, SparseColumns, conic_optimum, usable
from optlaws.synthesis.families.curved import CurvedFamily, IntegralFamily
from optlaws.synthesis.families.family import ConstraintFamily, LinearFamily, Points, Program
from optlaws.synthesis.families.kinked import KinkedIntegralFamily
from optlaws.synthesis.method.discretised.on_points import QUADRATIC, Answer
from optlaws.tolerances import EMPTY_ROW, STEP_SETTLED

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


_STEP_PAYS = 1e-4  # of what a quadratic step promises: the share that it must hold
_STEP_FEASIBILITY = 1e-9  # what a row may be exceeded by in a quadratic step
_LEFT_OVER = 1e-6  # by so much rows are exceeded in the last step where nothing near keeps them
_STEP_GAIN = 1e-13  # of the objective: a quadratic step that promises less is rounding
_FEW_ROWS = 8  # times the variables: rows of the first quadratic program of a step, and of those that join it
_ROW_EXCEEDED = 1e-12  # of a row of length 1: less is the solver's own error
_QUADRATIC_SOLVER = 1e-13  # what a solver of quadratic steps is told to leave of gap and feasibility

_STEPS = 80
#: of what a step promises: the share that it must keep, and that with which the damping falls
_AS_PROMISED = 0.25
_FIRST_DAMPING, _DAMPED, _EASED, _MOST_DAMPED = 1e-2, 8.0, 0.125, 1e12
#: a step that keeps less of its promise is corrected
_SHORT_OF = 0.5
#: what a row may be exceeded by in a step, and the price at which it may be by more
_MOST_DEAR = 1e7
#: what a residual costs beside the multipliers
_DEARER, _LEAST_PRICE = 2.0, 10.0
#: how many tangents are kept
_TANGENTS = 60


@dataclass(frozen=True, eq=False)
class _Rows:
    """All rows at some variables: residuals, unit gradients, and the gradients' original lengths."""

    residual: Array
    gradient: Array


@dataclass(frozen=True, eq=False)
class _Step:
    """A step of a quadratic program, the multipliers of rows and equations, and the greatest residual left."""

    x: Array
    rows: Array
    equations: Array
    left: float


def stepwise_on_points(program: Program, points: list[Points], start: Array, settled: float = STEP_SETTLED) -> Answer:
    """The end of a sequence of quadratic programs from a start, with rows at the points only.

    Parameters
    ----------
    program, points
        What is solved, and where its families are imposed.
    start
        Variables near which it begins; the equations need not hold.
    settled
        Of the greatest variable: a step that is less is the last.
    """
    if not np.isfinite(start).all():
        return Answer.missing(program, points, "a start that is not finite")
    return _Descent(program, points).answer(start, settled)


class _Descent:
    def __init__(self, program: Program, points: list[Points]) -> None:
        self.program, self.points = program, points
        self.pairs = list(zip(program.families, points, strict=True))
        #: rows of a family at corners of its tables, behind those at its points
        self.bent = [len(f.corners) * len(f.signs) if isinstance(f, CurvedFamily) else 0 for f in program.families]
        self.ends = np.cumsum([0, *(len(grid.u) + bent for grid, bent in zip(points, self.bent, strict=True))])
        places = [np.lexsort((grid.u, grid.s)) for grid in points]
        self.order = np.concatenate([begin + each for begin, each in zip(self.ends[:-1], places, strict=True)])
        self.raised = list(self._only_raised())
        self.price = _LEAST_PRICE
        #: tangents of convex integrals at earlier laws: rows, what is beside them, and whose row each is like
        self.tangents: list[tuple[Array, float, int]] = []

    def _only_raised(self) -> Iterator[tuple[int, float, NDArray[np.intp]]]:
        """Variables that cost and are only what some families are at most: their places, factors and families' rows."""
        program = self.program
        for i in np.flatnonzero(program.objective > 0.0):
            above = [family.slack[i] != 0.0 for family in program.families]
            factors = {float(family.slack[i]) for family, raises in zip(program.families, above, strict=True) if raises}
            alone = all(
                np.count_nonzero(f.slack) == 1 for f, raises in zip(program.families, above, strict=True) if raises
            )
            elsewhere = any(
                (family.rows(grid.u, grid.s)[0][:, i] != -family.slack[i]).any()
                for family, grid in self.pairs
                if isinstance(family, LinearFamily)
            )
            if (
                len(factors) == 1
                and min(factors) > 0.0
                and alone
                and not elsewhere
                and not program.equalities[:, i].any()
            ):
                rows = [np.arange(*self.ends[n : n + 2]) for n, raises in enumerate(above) if raises]
                yield int(i), min(factors), np.concatenate(rows)

    def answer(self, start: Array, least: float) -> Answer:
        """Step after step, until these are nothing."""
        program = self.program
        x = start + np.linalg.lstsq(program.equalities, program.right - program.equalities @ start, rcond=None)[0]
        damping, taken, settled, refused, last = _FIRST_DAMPING, 0, False, False, None
        x, rows = self._rows(x)
        multipliers = np.zeros(self.ends[-1])
        for i, factor, rows_above in self.raised:
            multipliers[rows_above[np.argmax(rows.residual[rows_above])]] = program.objective[i] / factor
        for taken in range(1, _STEPS + 1):  # noqa: B007 - it is said afterwards
            bend = self._bend(x, multipliers)
            step = self._step(x, rows, rows.residual, bend, damping)
            if damping > _MOST_DAMPED:
                break
            if step is None:
                damping *= _DAMPED
                continue
            if step.left > _STEP_FEASIBILITY and self.price < _MOST_DEAR:
                # rows that could be kept are too cheap: their costs are computed again
                self.price *= _DAMPED
                continue
            last, size = step, float(np.abs(step.x).max()) / max(1.0, float(np.abs(x).max()))
            self.price = max(self.price, min(_DEARER * float(step.rows.sum()), _DEARER * self.price))
            onward, ratio = self._tried(x, rows, step, bend, damping)
            settled = ratio is None or size <= least
            if ratio is None or settled:
                multipliers = step.rows
                x = x if ratio is None or ratio < _STEP_PAYS else onward[0]
                break
            if ratio < _STEP_PAYS:
                damping, refused = damping * _DAMPED, True
                continue
            multipliers = step.rows
            x, rows = onward
            if ratio > _AS_PROMISED and not refused:
                damping *= _EASED
            # what was too little damping just now mostly still is
            refused = False
        if last is None:
            return Answer.missing(program, self.points, "no quadratic step", taken)
        by_family = np.split(np.maximum(multipliers, 0.0), self.ends[1:-1])
        weights = [each[: len(grid.u)] for each, grid in zip(by_family, self.points, strict=True)]
        # however dear, no step keeps more of the rows near x, and further points only add some
        beyond = (settled or damping > _MOST_DAMPED) and last.left > _LEFT_OVER
        status = INFEASIBLE if beyond else QUADRATIC
        return Answer(x, [*weights, last.equations], settled and not beyond, status, iterations=taken)

    def _tried(
        self, x: Array, rows: _Rows, step: _Step, bend: Array, damping: float
    ) -> tuple[tuple[Array, _Rows], float | None]:
        """The result of a step, with a second-order correction if that is better, and its share of the predicted gain.

        None where it promises nothing.
        """
        before = self._merit(x, rows)
        promised = before - self.program.objective_at(x + step.x) - self.price * step.left
        there, onward = self._rows(x + step.x)
        best, gained = (there, onward), before - self._merit(there, onward)
        if gained < _SHORT_OF * promised:
            bent = onward.residual - rows.gradient @ (there - x)
            second = self._step(x, rows, bent, bend, damping)
            if second is not None:
                again = self._rows(x + second.x)
                better = before - self._merit(*again)
                if better > gained:
                    best, gained = again, better
        if promised <= _STEP_GAIN * max(1.0, abs(before)):
            return best, None
        return best, gained / promised

    def _merit(self, x: Array, rows: _Rows) -> float:
        return self.program.objective_at(x) + self.price * max(float(rows.residual.max(initial=0.0)), 0.0)

    def _rows(self, x: Array) -> tuple[Array, _Rows]:
        """The rows, and the variables with those that are only raised as small as the rows let them be."""
        values, gradients = [np.empty(0)], [np.empty((0, len(x)))]
        for family, grid in self.pairs:
            if isinstance(family, LinearFamily):
                matrix, right = family.rows(grid.u, grid.s)
                values.append(matrix @ x - right)
                gradients.append(matrix)
            else:
                jet = family.jet(x, grid.u, grid.s)
                if isinstance(family, IntegralFamily) and family.convex:
                    beside = float(jet.value[0] - jet.gradient[0] @ x)
                    self.tangents.append((jet.gradient[0], beside, int(sum(map(len, values)))))
                values.append(jet.value)
                gradients.append(jet.gradient)
            if isinstance(family, CurvedFamily) and family.corners:
                value, gradient = family.at_corners(x)
                values.append(value)
                gradients.append(gradient)
        del self.tangents[:-_TANGENTS]
        residual, x = np.concatenate(values), x.copy()
        for i, factor, rows_above in self.raised:
            excess = float(residual[rows_above].max())
            x[i] += excess / factor
            residual[rows_above] -= excess
        return x, _Rows(residual, np.vstack(gradients))

    def _tops(self, values: Array) -> NDArray[np.bool_]:
        """The rows with more than their neighbours on either side, along the places of a family and a side."""
        along = np.concatenate([[-np.inf], values[self.order], [-np.inf]])
        tops = np.ones(len(values), dtype=bool)
        tops[self.order] = (along[1:-1] >= along[:-2]) & (along[1:-1] >= along[2:])
        return tops

    def _bend(self, x: Array, multipliers: Array) -> Array:
        """The convex part of the Lagrangian's Hessian."""
        total = np.zeros((len(x), len(x)))
        for begin, (family, grid) in zip(self.ends, self.pairs, strict=False):
            weights = multipliers[begin : begin + len(grid.u)]
            bent = family.hessian(x, grid.u, weights * grid.s) if weights.any() else None
            if bent is not None:
                total += bent
        if not total.any():
            return total
        sizes, axes = np.linalg.eigh((total + total.T) / 2.0)
        return np.asarray((axes * np.maximum(sizes, 0.0)) @ axes.T)

    def _step(self, x: Array, rows: _Rows, residual: Array, bend: Array, damping: float) -> _Step | None:
        """The step of least cost, with one more variable: the allowed violation of all rows."""
        import clarabel

        program, size = self.program, self.program.size
        gradient, count = rows.gradient, len(residual)
        if self.tangents:
            slopes = np.array([row for row, _, _ in self.tangents])
            gradient = np.vstack([gradient, slopes])
            residual = np.append(residual, slopes @ x + [beside for _, beside, _ in self.tangents])
        length = np.linalg.norm(gradient, axis=1)
        finite = np.isfinite(residual) & (length > EMPTY_ROW)
        scale = np.divide(1.0, length, where=finite, out=np.zeros(len(length)))
        inner = np.column_stack([np.where(finite[:, None], gradient, 0.0) * scale[:, None], -scale])
        below = np.where(finite, -np.where(finite, residual, 0.0) * scale, np.inf)
        spare = np.zeros((1, size + 1))
        spare[0, -1] = -1.0
        equations = np.column_stack([program.equalities, np.zeros(len(program.right))])
        curvature = np.zeros((size + 1, size + 1))
        curvature[:size, :size] = bend + damping * np.eye(size)
        cost = np.append(program.objective, self.price)
        # of thousands of rows a few bind: those that the answer exceeds join them
        few, chosen = _FEW_ROWS * (size + 1), np.zeros(len(below), dtype=bool)
        chosen[np.argsort(below)[:few]] = True
        chosen &= finite
        while True:
            cones = [clarabel.ZeroConeT(len(program.right)), clarabel.NonnegativeConeT(int(chosen.sum()) + 1)]
            matrix = SparseColumns.of(np.vstack([equations, inner[chosen], spare]))
            right = np.concatenate([np.zeros(len(program.right)), below[chosen], [0.0]])
            optimum = conic_optimum(curvature, cost, matrix, right, cones, tolerance=_QUADRATIC_SOLVER)
            if not usable(optimum):
                return None
            over = np.where(chosen, -np.inf, inner @ np.asarray(optimum.x) - below)
            more = np.flatnonzero(self._tops(over) & (over > _ROW_EXCEEDED))
            if not len(more):
                break
            chosen[more[np.argsort(-over[more])[:few]]] = True
        duals, weights = np.asarray(optimum.z), np.zeros(len(residual))
        weights[chosen] = np.maximum(duals[len(program.right) : -1], 0.0) * scale[chosen]
        for weight, (_, _, row) in zip(weights[count:], self.tangents, strict=True):
            weights[row] += weight
        weights = weights[:count]
        x = np.asarray(optimum.x)
        return _Step(x[:-1], weights, duals[: len(program.right)], max(float(x[-1]), 0.0))
