"""The program on finitely many points as a CasADi NLP, solved by IPOPT; built once per shape.

Rows that are not affine in the law are CasADi expressions, whose numbers are parameters: `KINDS` is the table of them.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable
from dataclasses import dataclass
from typing import Any

import numpy as np

from optlaws.formulas.arithmetic import casadi_arithmetic, evaluate
from optlaws.lazy import casadi_lock
from optlaws.numbers import Array
from optlaws.synthesis.families.cone import ConeFamily
from optlaws.synthesis.families.curved import FormulaFamily, IntegralFamily
from optlaws.synthesis.families.energy import EnergyFamily
from optlaws.synthesis.families.family import ConstraintFamily, LinearFamily, NormFamily, Points, ProductFamily, Program
from optlaws.synthesis.method.discretised.on_points import Answer
from optlaws.tolerances import BARRIER, EMPTY_ROW, LEAST_ENERGY

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
    return [family.matrix, np.append(family.slack, family.bound)[None], np.zeros((1, len(family.slack)))]


def _norm(point: Any, symbols: list[Any], _: Hashable) -> Any:
    import casadi as ca

    # like a cone's: the root of the squares bends so sharply that IPOPT goes in circles
    right = symbols[1] @ point
    return ca.sumsqr(symbols[0] @ point) / right - right


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
    return family.formula, family.names, True, family.root


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
    RowKind(NormFamily, _norm_numbers, _norm, bounded=False, share=2.0),
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


_QUIET = {"print_time": False, "show_eval_warnings": False, "ipopt.print_level": 0, "ipopt.sb": "yes"}
# nobody asks how the optimum depends on the parameters, which are all the rows
_LEAN = {"calc_lam_p": False}
_REPEATABLE = {
    "ipopt.max_iter": 200,
    # the order of elimination is fixed so that every platform takes the same steps
    "ipopt.mumps_permuting_scaling": 0,
    "ipopt.mumps_pivot_order": 2,
}
_LINEAR = {
    "ipopt.mehrotra_algorithm": "yes",
    "ipopt.jac_c_constant": "yes",
    "ipopt.jac_d_constant": "yes",
    "ipopt.hessian_constant": "yes",
}


_FINE = {"ipopt.tol": 1e-12, "ipopt.compl_inf_tol": 1e-12, "ipopt.dual_inf_tol": 1e-6}
_USUAL = {"ipopt.tol": 1e-9}


# the lock is held during a solve, so that nothing is lost by waiting: the interpreter's is held too
# a solver that was called holds 20 kB a row, most of it IPOPT's and MUMPS's: together some 20 MB; building takes 3 ms
_MOST_ROWS = 1000


@dataclass(frozen=True)
class _Shapes:
    """Numbers of variables and of affine rows, the shapes of the others, and whether tolerances are small."""

    size: int
    linear: int
    curved: tuple[RowShape, ...]
    fine: bool

    @property
    def rows(self) -> int:
        return self.linear + sum(shape.count for shape in self.curved)


_solvers: dict[_Shapes, Any] = {}


def solve_on_points(program: Program, points: list[Points], start: Array | None, *, fine: bool = False) -> Answer:
    """Solve the program with its families enforced at the points only.

    `fine` sets smaller tolerances, which separate contacts of little weight from points that are merely near.

    Linear rows are scaled to unit length before IPOPT sees them; multipliers returned belong to the rows unscaled.
    """
    pairs = list(zip(program.families, points, strict=True))
    order = sorted(range(len(pairs)), key=lambda i: order_of(program.families[i]))
    linear = [family.rows(p.u, p.s) for family, p in pairs if isinstance(family, LinearFamily)]
    rows = np.vstack([*(a for a, _ in linear), program.equalities])
    right = np.concatenate([*(h for _, h in linear), program.right])
    length = np.linalg.norm(rows, axis=1)
    equations = slice(len(rows) - len(program.right), len(rows))
    # a row such as b >= 0 at rest says nothing, and IPOPT would have no room to say it in
    empty = length < EMPTY_ROW
    empty[equations] = False
    length[length < EMPTY_ROW] = 1.0
    right = np.where(empty, np.inf, right)

    curved = [program.families[i] for i in order[len(linear) :]]
    known = [shape_and_numbers(*pairs[i]) for i in order[len(linear) :]]
    shapes = [shape for shape, _ in known]
    parts = [rows / length[:, None], *(part for _, numbers in known for part in numbers)]
    parameters = np.concatenate([*(part.ravel(order="F") for part in parts), program.objective])
    bounds = (
        np.full(shape.count, family.bound if shape.kind.bounded else 0.0)
        for shape, family in zip(shapes, curved, strict=True)
    )
    upper = np.concatenate([right / length, *bounds])
    lower = np.full(len(upper), -np.inf)
    lower[equations] = upper[equations]
    if start is None:
        start = np.zeros(program.size)
        start[-1] = 10.0
    shape = _Shapes(program.size, len(rows), tuple(shapes), fine)
    result = _solved(shape, x0=start, p=parameters, lbg=lower, ubg=upper)
    if any(family.right_side(result.x) < 0.0 for family in curved if isinstance(family, ConeFamily | NormFamily)):
        # the square of an amplitude does not tell its bound from the opposite, and a norm nearly vanishes there
        least = _least_of_variables(curved, program.size)
        result = _solved(shape, x0=np.maximum(start, least), p=parameters, lbg=lower, ubg=upper, lbx=least)
    weights = result.weights
    weights[: len(rows)] /= length
    return Answer(
        x=result.x,
        multipliers=[*_split(np.delete(weights, equations), points, order, shapes), weights[equations]],
        success=result.success and result.status == "Solve_Succeeded",
        status=result.status,
        iterations=result.iterations,
        weightless=BARRIER,
    )


def _least_of_variables(families: list[ConstraintFamily], size: int) -> Array:
    """Lower bounds of variables that keep the right sides of cones at least 0, if a single variable decides that."""
    least = np.full(size, -np.inf)
    for family in families:
        if isinstance(family, ConeFamily | NormFamily) and np.count_nonzero(family.slack) == 1:
            [place] = np.flatnonzero(family.slack > 0.0).tolist() or [0]
            if family.slack[place] > 0.0:
                least[place] = max(least[place], -family.bound / family.slack[place])
    return least


def _split(weights: Array, points: list[Points], order: list[int], shapes: list[RowShape]) -> list[Array]:
    """The multipliers of each family, which stand in an order."""
    parts = np.split(weights, np.cumsum([len(points[i].u) for i in order])[:-1])
    shares = [1.0] * (len(order) - len(shapes)) + [shape.kind.share for shape in shapes]
    return [shares[place] * parts[place] for place in np.argsort(order).tolist()]


@dataclass(frozen=True, eq=False)
class _Result:
    """A solver's result as plain numbers; no object of CasADi leaves its lock."""

    x: Array
    weights: Array
    success: bool
    status: str
    iterations: int


def _solved(shape: _Shapes, **numbers: Array) -> _Result:
    with casadi_lock:
        solver = _solver(shape)
        result = solver(**numbers)
        stats = solver.stats()
        answer = _Result(
            # copies: a view would keep CasADi's matrix, and give it back outside the lock
            x=np.array(result["x"], dtype=float).ravel(),
            weights=np.array(result["lam_g"], dtype=float).ravel(),
            success=bool(stats["success"]),
            status=str(stats["return_status"]),
            # where IPOPT ends before its first iteration CasADi's count is memory that nobody set
            iterations=int(stats["iter_count"]) if "iterations" in stats else 0,
        )
        # what they refer to is counted, and the last reference must go while the lock is held
        del result, stats, solver
    return answer


def _solver(shape: _Shapes) -> Any:
    """The solver of a shape; recent solvers are cached up to a limit of rows. The caller must hold the lock."""
    solver = _solvers.pop(shape, None)
    if solver is None:
        solver = _build(shape)
    _solvers[shape] = solver
    rows = sum(known.rows for known in _solvers)
    while rows > _MOST_ROWS and len(_solvers) > 1:
        oldest = next(iter(_solvers))
        rows -= oldest.rows
        del _solvers[oldest]
    return solver


def _build(shapes: _Shapes) -> Any:
    import casadi as ca

    size, linear = shapes.size, shapes.linear
    x, rows, objective = ca.MX.sym("x", size), ca.MX.sym("rows", linear, size), ca.MX.sym("objective", size)
    symbols = [shape.symbols() for shape in shapes.curved]
    p = ca.vertcat(
        *(ca.vec(symbol) for symbol in (rows, *(symbol for several in symbols for symbol in several), objective))
    )
    curved = [shape.expression(x, several) for shape, several in zip(shapes.curved, symbols, strict=True)]
    program: Any = {"x": x, "p": p, "f": ca.dot(objective, x), "g": ca.vertcat(rows @ x, *curved)}
    options: Any = {**_QUIET, **_LEAN, **_REPEATABLE, **(_FINE if shapes.fine else _USUAL)}
    if not curved:
        flat = ca.Function(
            "hessian",
            [x, ca.MX.sym("p", p.numel()), ca.MX.sym("f"), ca.MX.sym("g", linear)],
            [ca.MX(size, size)],
            ["x", "p", "lam_f", "lam_g"],
            ["triu_hess_gamma_x_x"],
        )
        options |= {**_LINEAR, "hess_lag": flat}
    if shapes.fine and any(shape.kind is CONES for shape in shapes.curved):
        # such an answer may be the last word, and then it must keep to its bounds
        options["ipopt.bound_relax_factor"] = 0.0
    return ca.nlpsol("program", "ipopt", program, options)
