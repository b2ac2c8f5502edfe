"""Programs with kinks as linear programs on points: each kink is a variable, what is smooth is straight near a law.

An integral of max(p, q) is a sum over places of the least variables above both. Where p and q are affine that is the
program itself, but for the rule; where they are not, it is so near the law at which they are made straight.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import reduce
from typing import Any

import numpy as np
from numpy.typing import NDArray

from optlaws.formulas.affine import affine
from optlaws.formulas.branches import branch_at, switches
from optlaws.formulas.of_motion import MotionFormula
from optlaws.formulas.slopes import opposite
from optlaws.formulas.tree import Call, Formula, Name, Negative, Product, Sum
from optlaws.numbers import Array
from optlaws.numerics.chebyshev import gauss
from optlaws.synthesis.families.curved import Slopes
from optlaws.synthesis.families.family import LinearFamily, Points, Program
from optlaws.synthesis.families.kinked import KinkedIntegralFamily

_CELL, _PER_VARIABLE, _FEWEST = 6, 10, 160
_OPTIMAL = 0


@dataclass(frozen=True, eq=False)
class _Straight:
    """Values at places as affine functions of a step, and of variables of which each place has its own."""

    value: Array
    slope: Array
    local: dict[int, Array] = field(default_factory=dict)

    def times(self, factor: Array | float) -> _Straight:
        spread = np.broadcast_to(factor, self.value.shape)
        local = {i: spread * weight for i, weight in self.local.items()}
        return _Straight(spread * self.value, spread[:, None] * self.slope, local)

    def __add__(self, other: _Straight) -> _Straight:
        nothing = np.zeros_like(self.value)
        local = {i: self.local.get(i, nothing) + other.local.get(i, nothing) for i in {*self.local, *other.local}}
        return _Straight(self.value + other.value, self.slope + other.slope, local)


class _Epigraph:
    """A formula with kinks near a law, at places: its own variables, and what each is at least."""

    def __init__(self, family: KinkedIntegralFamily, x: Array, k: Array) -> None:
        columns = family.columns_at(k)
        self.names, self.columns = family.names, columns[..., :-1]
        values = columns @ np.append(x, 1.0)
        self.at = {**dict(zip(family.names, values, strict=True)), "k": k}
        self.above: list[tuple[int, _Straight]] = []
        self.count = 0
        #: whether it is the formula itself, whatever the law
        self.exact = family.convex and not family.root
        self.whole = self._of(family.formula, 1)

    def _of(self, formula: Formula, sign: int) -> _Straight:
        """The formula, whose factor has a sign."""
        if not switches(formula, self.names):
            return self._smooth(formula)
        if isinstance(formula, Negative):
            return self._of(formula.of, -sign).times(-1.0)
        if isinstance(formula, Sum):
            return reduce(_Straight.__add__, [self._of(term, sign) for term in formula.terms])
        if isinstance(formula, Product):
            kinked = [factor for factor in formula.factors if switches(factor, self.names)]
            others = [factor for factor in formula.factors if factor is not kinked[0]]
            if not any(other.names() & set(self.names) for other in others):
                weight = np.prod([MotionFormula(other).values({"k": self.at["k"]}) for other in others], axis=0)
                if (weight >= 0.0).all() or (weight <= 0.0).all():
                    return self._of(kinked[0], sign if (weight >= 0.0).all() else -sign).times(weight)
        if isinstance(formula, Call) and (formula.function, sign) in {("abs", 1), ("max", 1), ("min", -1)}:
            return self._greatest(formula, sign)
        return self._as_it_is(formula)

    def _greatest(self, formula: Call, sign: int) -> _Straight:
        """A variable that is above every part, or below."""
        parts = formula.arguments if formula.function != "abs" else (*formula.arguments, opposite(formula.arguments[0]))
        variable, self.count = self.count, self.count + 1
        self.above += [(variable, self._of(part, sign).times(float(sign))) for part in parts]
        nothing = _Straight(np.zeros_like(self.at["k"]), np.zeros((len(self.at["k"]), self.columns.shape[-1])))
        return replace(nothing, local={variable: np.full(len(self.at["k"]), float(sign))})

    def _smooth(self, formula: Formula) -> _Straight:
        self.exact &= affine(formula, self.names) is not None
        return self._along(formula, np.arange(len(self.at["k"])))

    def _as_it_is(self, formula: Formula) -> _Straight:
        """The smooth formulas that it is at the places."""
        self.exact = False
        at = [{name: float(values[i]) for name, values in self.at.items()} for i in range(len(self.at["k"]))]
        formulas = [branch_at(formula, names) for names in at]
        whole = self._smooth(Name("k"))
        for branch in dict.fromkeys(formulas):
            places = np.array([i for i, other in enumerate(formulas) if other == branch])
            part = self._along(branch, places)
            whole.value[places], whole.slope[places] = part.value, part.slope
        return whole

    def _along(self, formula: Formula, places: NDArray[np.intp]) -> _Straight:
        slopes, at = Slopes(formula, self.names), {name: values[places] for name, values in self.at.items()}
        slope = np.einsum("ip,ipn->pn", slopes.gradient(at), self.columns[:, places])
        return _Straight(slopes.value(at).copy(), np.asarray(slope))


def is_straight(program: Program, x: Array) -> bool:
    """Whether a program is linear but for kinks that are those of a maximum."""
    kinked = [family for family in program.families if isinstance(family, KinkedIntegralFamily)]
    others = [family for family in program.families if not isinstance(family, KinkedIntegralFamily | LinearFamily)]
    return bool(kinked) and not others and all(_Epigraph(family, x, np.array([0.5])).exact for family in kinked)


def straight_step(program: Program, points: list[Points], x: Array, reach: float) -> Array | None:
    """The step from x to the optimum of the program made straight there; None where there is none.

    Parameters
    ----------
    program, points
        What is solved, and where its families but integrals are held.
    x
        Near what what is smooth is made straight.
    reach
        How far each variable may go.
    """
    from scipy import sparse
    from scipy.optimize import linprog

    size, blocks = program.size, _Blocks(program.size)
    for family, grid in zip(program.families, points, strict=True):
        if isinstance(family, KinkedIntegralFamily):
            blocks.integral(family, x)
        elif isinstance(family, LinearFamily):
            matrix, right = family.rows(grid.u, grid.s)
            blocks.rows(matrix, right - matrix @ x)
        else:
            jet = family.jet(x, grid.u, grid.s)
            blocks.rows(jet.gradient, -jet.value)
    matrix, right = blocks.joined()
    others = matrix.shape[1] - size
    equations = sparse.hstack([sparse.csr_matrix(program.equalities), sparse.csr_matrix((len(program.right), others))])
    solve: Any = linprog
    optimum = solve(
        np.append(program.objective, np.zeros(others)),
        A_ub=matrix,
        b_ub=right,
        A_eq=equations if len(program.right) else None,
        b_eq=program.right - program.equalities @ x if len(program.right) else None,
        bounds=[(-reach, reach)] * size + [(None, None)] * others,
        method="highs",
    )
    return np.asarray(optimum.x[:size]) if optimum.status == _OPTIMAL else None


class _Blocks:
    """Rows of a linear program whose variables beyond the step are the places' own."""

    def __init__(self, size: int) -> None:
        self.size, self.others = size, 0
        self._parts: list[tuple[Array, dict[int, Array], Array]] = []
        self._sums: list[tuple[Array, dict[int, Array], float]] = []

    def rows(self, matrix: Array, right: Array) -> None:
        """Take in rows: rows . step <= right."""
        length = np.linalg.norm(matrix, axis=1)
        finite = np.isfinite(right) & (length > 0.0)
        self._parts.append((matrix[finite] / length[finite, None], {}, right[finite] / length[finite]))

    def integral(self, family: KinkedIntegralFamily, x: Array) -> None:
        """The integral's row, and those of its own variables."""
        k, weights = _rule(family, len(x))
        epigraph = _Epigraph(family, x, k)
        begins = [self.others + i * len(k) for i in range(epigraph.count)]
        self.others += epigraph.count * len(k)
        for variable, part in epigraph.above:
            several = {begins[i]: weight for i, weight in part.local.items()}
            several[begins[variable]] = several.get(begins[variable], np.zeros_like(k)) - 1.0
            self._parts.append((part.slope, several, -part.value))
        whole = epigraph.whole
        total = family.split(x).total
        value, share = family.outer(np.array(total))
        row = share * (weights @ whole.slope) - family.slack
        right = family.right_side(x) - float(value) + float(share) * (total - float(weights @ whole.value))
        self._sums.append((row, {begins[i]: share * weights * local for i, local in whole.local.items()}, right))

    def joined(self) -> tuple[Any, Array]:
        """The rows of all families together."""
        from scipy import sparse

        matrices, rights = [], []
        for slope, local, right in self._parts:
            count = len(right)
            extra = sparse.lil_matrix((count, self.others))
            for begin, weight in local.items():
                extra[np.arange(count), begin + np.arange(count)] = weight
            matrices.append(sparse.hstack([sparse.csr_matrix(slope), extra.tocsr()]))
            rights.append(right)
        for row, local, most in self._sums:
            shares = np.zeros(self.others)
            for begin, weight in local.items():
                shares[begin : begin + len(weight)] += weight
            matrices.append(sparse.csr_matrix(np.append(row, shares)[None]))
            rights.append(np.array([most]))
        return sparse.vstack(matrices).tocsr(), np.concatenate(rights)


def _rule(family: KinkedIntegralFamily, size: int) -> tuple[Array, Array]:
    """Places and weights, enough to see where kinks are."""
    x, share = gauss(_CELL)
    cells = -(-max(_FEWEST, _PER_VARIABLE * size) // (_CELL * (len(family.edges) - 1)))
    edges = np.concatenate(
        [
            *(np.linspace(a, b, cells + 1)[:-1] for a, b in zip(family.edges, family.edges[1:], strict=False)),
            family.edges[-1:],
        ]
    )
    low, width = edges[:-1, None], np.diff(edges)[:, None]
    return (low + width * (1.0 + x) / 2.0).ravel(), (share * width / 2.0).ravel()
