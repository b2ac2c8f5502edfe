"""The program on finitely many points as a CasADi NLP, solved by IPOPT; built once per shape."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from optlaws.synthesis.rows import LinearFamily, NormFamily, Points, ProductFamily, Program

Array = NDArray[np.float64]

# keeps the norm's slope finite where it vanishes; Newton's method on the exact active set goes without it
_SMOOTH = 1e-12
_EMPTY = 1e-13
_QUIET = {"print_time": False, "ipopt.print_level": 0, "ipopt.sb": "yes"}
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


def solve_on_points(program: Program, points: list[Points], start: Array | None, *, careful: bool = False) -> Answer:
    """Solve the program with its families held at the points only.

    `careful` goes without the quick steps for linear programs, which may diverge.

    Linear rows are scaled to unit length before IPOPT sees them; multipliers returned belong to the rows unscaled.
    """
    pairs = list(zip(program.families, points, strict=True))
    linear = [family.rows(p.u, p.s) for family, p in pairs if isinstance(family, LinearFamily)]
    rows = np.vstack([*(a for a, _ in linear), program.equalities])
    right = np.concatenate([*(h for _, h in linear), program.right])
    length = np.linalg.norm(rows, axis=1)
    # a row such as b >= 0 at rest says nothing, and IPOPT would have no room to say it in
    empty = length < _EMPTY
    empty[len(rows) - len(program.right) :] = False
    length[length < _EMPTY] = 1.0
    right = np.where(empty, np.inf, right)

    products = [(f, p) for f, p in pairs if isinstance(f, ProductFamily)]
    first, second, slack, bound = _product_rows(products, program.size)
    norms = [f for f in program.families if isinstance(f, NormFamily)]
    solver = _solver(program.size, len(rows), len(first), tuple(len(f.matrix) for f in norms), careful=careful)
    parts = [rows / length[:, None], first, second, slack, *(f.matrix for f in norms), *(f.slack[None] for f in norms)]
    parameters = np.concatenate([*(part.ravel(order="F") for part in parts), program.objective])
    upper = np.concatenate([right / length, bound, [f.bound for f in norms]])
    lower = np.full(len(upper), -np.inf)
    equations = slice(len(rows) - len(program.right), len(rows))
    lower[equations] = upper[equations]
    if start is None:
        start = np.zeros(program.size)
        start[-1] = 10.0
    result = solver(x0=start, p=parameters, lbg=lower, ubg=upper)
    stats = solver.stats()
    weights = np.asarray(result["lam_g"], dtype=float).ravel()
    weights[: len(rows)] /= length
    return Answer(
        x=np.asarray(result["x"], dtype=float).ravel(),
        multipliers=_split(pairs, weights, len(rows), len(program.right)),
        success=bool(stats["success"]) and str(stats["return_status"]) == "Solve_Succeeded",
        status=str(stats["return_status"]),
        iterations=int(stats["iter_count"]),
    )


def _product_rows(products: list[tuple[ProductFamily, Points]], size: int) -> tuple[Array, Array, Array, Array]:
    first, second, slack = (np.empty((0, size + 1)), np.empty((0, size + 1)), np.empty((0, size)))
    bound = np.empty(0)
    for family, points in products:
        first = np.vstack([first, family.first.columns(points.u)[0] * points.s[:, None]])
        second = np.vstack([second, family.second.columns(points.u)[0]])
        slack = np.vstack([slack, np.tile(family.slack, (len(points.u), 1))])
        bound = np.append(bound, np.full(len(points.u), family.bound))
    return first, second, slack, bound


def _split(pairs: list[tuple[Any, Points]], weights: Array, rows: int, equations: int) -> list[Array]:
    products = sum(len(p.u) for f, p in pairs if isinstance(f, ProductFamily))
    begins = [0, rows, rows + products]
    found = []
    for family, points in pairs:
        kind = 0 if isinstance(family, LinearFamily) else 1 if isinstance(family, ProductFamily) else 2
        begin = begins[kind]
        begins[kind] += len(points.u)
        found.append(weights[begin : begin + len(points.u)])
    return [*found, weights[rows - equations : rows]]


@lru_cache(maxsize=512)
def _solver(size: int, linear: int, products: int, norms: tuple[int, ...], *, careful: bool) -> Any:  # noqa: ANN401
    # a casadi Function, imported late
    import casadi as ca

    x = ca.MX.sym("x", size)
    point = ca.vertcat(x, 1)
    symbols: list[Any] = [
        ca.MX.sym("rows", linear, size),
        ca.MX.sym("first", products, size + 1),
        ca.MX.sym("second", products, size + 1),
        ca.MX.sym("slack", products, size),
        *(ca.MX.sym("norm", count, size + 1) for count in norms),
        *(ca.MX.sym("room", 1, size) for _ in norms),
        ca.MX.sym("objective", size),
    ]
    rows, first, second, slack = symbols[:4]
    matrices, rooms = symbols[4 : 4 + len(norms)], symbols[4 + len(norms) : -1]
    p = ca.vertcat(*(ca.vec(s) for s in symbols))
    curved = [(first @ point) * (second @ point) - slack @ x] if products else []
    curved += [ca.sqrt(ca.sumsqr(m @ point) + _SMOOTH) - room @ x for m, room in zip(matrices, rooms, strict=True)]
    program: Any = {"x": x, "p": p, "f": ca.dot(symbols[-1], x), "g": ca.vertcat(rows @ x, *curved)}
    options: Any = {**_QUIET, **_REPEATABLE, "ipopt.tol": 1e-9}
    if not curved:
        flat = ca.Function(
            "hessian",
            [x, ca.MX.sym("p", p.numel()), ca.MX.sym("f"), ca.MX.sym("g", linear)],
            [ca.MX(size, size)],
            ["x", "p", "lam_f", "lam_g"],
            ["triu_hess_gamma_x_x"],
        )
        options |= {**_LINEAR, "hess_lag": flat}
    if careful:
        options["ipopt.mehrotra_algorithm"] = "no"
    return ca.nlpsol("program", "ipopt", program, options)
