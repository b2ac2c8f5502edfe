"""The program on finitely many points as a CasADi NLP, solved by IPOPT; built once per shape."""

from __future__ import annotations

from dataclasses import astuple, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from optlaws.locks import casadi_lock
from optlaws.synthesis.families.cone import ConeFamily
from optlaws.synthesis.families.curved import OfFormula
from optlaws.synthesis.families.energy import LEAST_ROOT, EnergyFamily
from optlaws.synthesis.families.family import Family, LinearFamily, NormFamily, Points, ProductFamily, Program
from optlaws.synthesis.method.on_points.formulas import FormulaShape, expression_of, numbers_of, shape_of, symbols_of
from optlaws.synthesis.method.tolerances import EMPTY_ROW

Array = NDArray[np.float64]

# keeps the norm's slope finite where it vanishes; Newton's method on the exact active set goes without it
_SMOOTH = 1e-12
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


_KINDS: tuple[type[Family], ...] = (LinearFamily, ProductFamily, ConeFamily, NormFamily, EnergyFamily, OfFormula)
_CONE_SHARE = 2.0  # the cone's row as IPOPT sees it is twice as steep as the magnitude itself


# the lock is held during a solve, so that nothing is lost by waiting: the interpreter's is held too
# a solver that was called holds 20 kB a row, most of it IPOPT's and MUMPS's: together some 60 MB
_MOST_ROWS = 3000


@dataclass(frozen=True)
class _Counts:
    """Numbers of variables and of rows of each kind; of the norms, their lengths."""

    size: int
    linear: int
    products: int
    cones: int
    norms: tuple[int, ...]
    shared: tuple[_Shared, ...] = ()
    formulas: tuple[FormulaShape, ...] = ()

    @property
    def rows(self) -> int:
        """The rows of all kinds."""
        own = sum(shape.places for shape in self.shared) + sum(formula.rows for formula in self.formulas)
        return self.linear + self.products + self.cones + len(self.norms) + own


@dataclass(frozen=True)
class _Shared:
    """What the rows of a family of shared energy look like: places, factors, nodes of the integral, the power of Y."""

    places: int
    factors: int
    nodes: int
    degree: int
    divided: bool


_Shape = tuple[_Counts, bool, bool]
_solvers: dict[_Shape, Any] = {}


@dataclass(frozen=True, eq=False)
class Answer:
    """What IPOPT returned: never reported, only a start for the exact active set.

    `multipliers` has an array for each family, in the order of its points, and the equations' last.
    """

    x: Array
    multipliers: list[Array]
    success: bool
    status: str
    iterations: int

    @property
    def usable(self) -> bool:
        """Whether x is a start for the exact active set: an answer that is nearly one is, it is polished anyway."""
        return self.success or self.status == "Solved_To_Acceptable_Level"


def solve_on_points(
    program: Program, points: list[Points], start: Array | None, *, careful: bool = False, fine: bool = False
) -> Answer:
    """Solve the program with its families held at the points only.

    `careful` goes without the quick steps for linear programs, which may diverge; `fine` asks for smaller tolerances,
    by which contacts of little weight are told from points that are merely near.

    Linear rows are scaled to unit length before IPOPT sees them; multipliers returned belong to the rows unscaled.
    """
    pairs = list(zip(program.families, points, strict=True))
    linear = [family.rows(p.u, p.s) for family, p in pairs if isinstance(family, LinearFamily)]
    rows = np.vstack([*(a for a, _ in linear), program.equalities])
    right = np.concatenate([*(h for _, h in linear), program.right])
    length = np.linalg.norm(rows, axis=1)
    # a row such as b >= 0 at rest says nothing, and IPOPT would have no room to say it in
    empty = length < EMPTY_ROW
    empty[len(rows) - len(program.right) :] = False
    length[length < EMPTY_ROW] = 1.0
    right = np.where(empty, np.inf, right)

    products = [(f, p) for f, p in pairs if isinstance(f, ProductFamily)]
    first, second, slack, bound = _product_rows(products, program.size)
    norms = [f for f in program.families if isinstance(f, NormFamily)]
    shared = [(f, p) for f, p in pairs if isinstance(f, EnergyFamily)]
    real, imaginary, room = _cone_rows([(f, p) for f, p in pairs if isinstance(f, ConeFamily)], program.size)
    kinds = tuple(_shape(family, p) for family, p in shared)
    formulas = [(f, p) for f, p in pairs if isinstance(f, OfFormula)]
    shapes = tuple(shape_of(family, p) for family, p in formulas)
    lengths = tuple(len(f.matrix) for f in norms)
    counts = _Counts(program.size, len(rows), len(first), len(room), lengths, kinds, shapes)
    parts = [rows / length[:, None], first, second, slack, real, imaginary, room]
    parts += [*(f.matrix for f in norms), *(f.slack[None] for f in norms)]
    parts += [part for family, p in shared for part in _shared_rows(family, p)]
    parts += [part for family, p in formulas for part in numbers_of(family, p)]
    parameters = np.concatenate([*(part.ravel(order="F") for part in parts), program.objective])
    upper = np.concatenate([right / length, bound, np.zeros(len(room)), [f.bound for f in norms]])
    upper = np.concatenate([upper, *(np.full(len(p.u), f.bound) for f, p in (*shared, *formulas))])
    lower = np.full(len(upper), -np.inf)
    equations = slice(len(rows) - len(program.right), len(rows))
    lower[equations] = upper[equations]
    if start is None:
        start = np.zeros(program.size)
        start[-1] = 10.0
    result = _solved((counts, careful, fine), x0=start, p=parameters, lbg=lower, ubg=upper)
    weights = result.weights
    weights[: len(rows)] /= length
    return Answer(
        x=result.x,
        multipliers=_split(pairs, weights, len(rows), len(program.right)),
        success=result.success and result.status == "Solve_Succeeded",
        status=result.status,
        iterations=result.iterations,
    )


@dataclass(frozen=True, eq=False)
class _Result:
    """What a solver gave, as numbers of our own: nothing of CasADi's leaves its lock."""

    x: Array
    weights: Array
    success: bool
    status: str
    iterations: int


def _solved(shape: _Shape, **numbers: Array) -> _Result:
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


def _product_rows(products: list[tuple[ProductFamily, Points]], size: int) -> tuple[Array, Array, Array, Array]:
    first, second, slack = (np.empty((0, size + 1)), np.empty((0, size + 1)), np.empty((0, size)))
    bound = np.empty(0)
    for family, points in products:
        first = np.vstack([first, family.first.columns(points.u)[0] * points.s[:, None]])
        second = np.vstack([second, family.second.columns(points.u)[0]])
        slack = np.vstack([slack, np.tile(family.slack, (len(points.u), 1))])
        bound = np.append(bound, np.full(len(points.u), family.bound))
    return first, second, slack, bound


def _cone_rows(cones: list[tuple[ConeFamily, Points]], size: int) -> tuple[Array, Array, Array]:
    real, imaginary, room = (np.empty((0, size + 1)) for _ in range(3))
    for family, points in cones:
        columns = family.columns(points.u)[0]
        real, imaginary = np.vstack([real, columns.real]), np.vstack([imaginary, columns.imag])
        room = np.vstack([room, np.tile(np.append(family.slack, family.bound), (len(points.u), 1))])
    return real, imaginary, room


def _shape(family: EnergyFamily, points: Points) -> _Shared:
    nodes = len(family.energy.columns[0])
    return _Shared(len(points.u), len(family.factors), nodes, family.degree, family.divided)


def _shared_rows(family: EnergyFamily, points: Points) -> list[Array]:
    """Rows of the factors, of both parts of the energy, and of these at the nodes of its integral; the slack."""
    energy = family.energy
    first, *others = [factor.columns(points.u)[0] for factor in family.factors]
    columns = [first * (family.scale * points.s)[:, None], *others]
    if family.divided:
        columns += [part.columns(points.u)[0] for part in (energy.below, energy.above)]
    return [*columns, *energy.columns, family.slack[None]]


def _split(pairs: list[tuple[Any, Points]], weights: Array, rows: int, equations: int) -> list[Array]:
    products = sum(len(p.u) for f, p in pairs if isinstance(f, ProductFamily))
    cones = sum(len(p.u) for f, p in pairs if isinstance(f, ConeFamily))
    norms = sum(isinstance(f, NormFamily) for f, _ in pairs)
    energies = sum(len(p.u) for f, p in pairs if isinstance(f, EnergyFamily))
    begins = np.cumsum([0, rows, products, cones, norms, energies]).tolist()
    split = []
    for family, points in pairs:
        kind = next(i for i, kind_of_row in enumerate(_KINDS) if isinstance(family, kind_of_row))
        begin = begins[kind]
        begins[kind] += len(points.u)
        share = _CONE_SHARE if isinstance(family, ConeFamily) else 1.0
        split.append(share * weights[begin : begin + len(points.u)])
    return [*split, weights[rows - equations : rows]]


def _solver(shape: _Shape) -> Any:  # noqa: ANN401 - a casadi Function, imported late
    """The solver of a shape; those used last are kept, as many as their rows allow. The lock must be held."""
    counts, careful, fine = shape
    solver = _solvers.pop(shape, None)
    if solver is None:
        solver = _build(counts, careful=careful, fine=fine)
    _solvers[shape] = solver
    rows = sum(counts.rows for counts, _, _ in _solvers)
    while rows > _MOST_ROWS and len(_solvers) > 1:
        oldest = next(iter(_solvers))
        rows -= oldest[0].rows
        del _solvers[oldest]
    return solver


def _build(counts: _Counts, *, careful: bool, fine: bool) -> Any:  # noqa: ANN401 - a casadi Function, imported late
    import casadi as ca

    size, linear, products, cones, norms = astuple(counts)[:5]
    x = ca.MX.sym("x", size)
    point = ca.vertcat(x, 1)
    symbols: list[Any] = [
        ca.MX.sym("rows", linear, size),
        ca.MX.sym("first", products, size + 1),
        ca.MX.sym("second", products, size + 1),
        ca.MX.sym("slack", products, size),
        ca.MX.sym("real", cones, size + 1),
        ca.MX.sym("imaginary", cones, size + 1),
        ca.MX.sym("rooms", cones, size + 1),
        *(ca.MX.sym("norm", count, size + 1) for count in norms),
        *(ca.MX.sym("room", 1, size) for _ in norms),
    ]
    shared = [_energy_symbols(size, sharing) for sharing in counts.shared]
    formulas = [symbols_of(size, shape) for shape in counts.formulas]
    symbols += [symbol for of_family in (*shared, *formulas) for symbol in of_family]
    symbols.append(ca.MX.sym("objective", size))
    rows, first, second, slack, real, imaginary, room = symbols[:7]
    matrices, rooms = symbols[7 : 7 + len(norms)], symbols[7 + len(norms) : 7 + 2 * len(norms)]
    p = ca.vertcat(*(ca.vec(s) for s in symbols))
    curved = [(first @ point) * (second @ point) - slack @ x] if products else []
    if cones:
        # |p| <= r as |p|²/r <= r: convex as well, and smooth where p vanishes
        wide = room @ point
        curved.append(((real @ point) ** 2 + (imaginary @ point) ** 2) / wide - wide)
    curved += [ca.sqrt(ca.sumsqr(m @ point) + _SMOOTH) - room @ x for m, room in zip(matrices, rooms, strict=True)]
    curved += [_energy_rows(x, own, sharing) for own, sharing in zip(shared, counts.shared, strict=True)]
    curved += [expression_of(x, own, shape) for own, shape in zip(formulas, counts.formulas, strict=True)]
    program: Any = {"x": x, "p": p, "f": ca.dot(symbols[-1], x), "g": ca.vertcat(rows @ x, *curved)}
    options: Any = {**_QUIET, **_LEAN, **_REPEATABLE, **(_FINE if fine else _USUAL)}
    if not curved:
        flat = ca.Function(
            "hessian",
            [x, ca.MX.sym("p", p.numel()), ca.MX.sym("f"), ca.MX.sym("g", linear)],
            [ca.MX(size, size)],
            ["x", "p", "lam_f", "lam_g"],
            ["triu_hess_gamma_x_x"],
        )
        options |= {**_LINEAR, "hess_lag": flat}
    if cones and fine:
        # such an answer may be the last word, and then it must keep to its bounds
        options["ipopt.bound_relax_factor"] = 0.0
    if careful:
        options["ipopt.mehrotra_algorithm"] = "no"
    return ca.nlpsol("program", "ipopt", program, options)


def _energy_symbols(size: int, shape: _Shared) -> list[Any]:
    import casadi as ca

    wide = shape.factors + (2 if shape.divided else 0)
    rows = [ca.MX.sym("part", shape.places, size + 1) for _ in range(wide)]
    return [*rows, *(ca.MX.sym("energy", shape.nodes, size + 1) for _ in range(2)), ca.MX.sym("room", 1, size)]


def _energy_rows(x: Any, symbols: list[Any], shape: _Shared) -> Any:  # noqa: ANN401 - casadi's, imported late
    import casadi as ca

    point = ca.vertcat(x, 1)
    *parts, below, above, room = symbols

    def root(first: Any, second: Any) -> Any:  # noqa: ANN401
        top = second @ point
        return ca.sqrt(ca.fmax((first @ point) * top, LEAST_ROOT * top**2))

    Y = 0.5 / ca.sum1(root(below, above))
    product_of_roots = Y**shape.degree
    for factor in parts[: shape.factors]:
        product_of_roots = product_of_roots * (factor @ point)
    if shape.divided:
        product_of_roots = product_of_roots / root(*parts[shape.factors :])
    return product_of_roots - room @ x
