"""The linear program on finitely many points as a CasADi NLP, solved by IPOPT; built once per shape."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_QUIET = {"print_time": False, "ipopt.print_level": 0, "ipopt.sb": "yes"}
_LINEAR = {
    "ipopt.mehrotra_algorithm": "yes",
    "ipopt.jac_c_constant": "yes",
    "ipopt.jac_d_constant": "yes",
    "ipopt.hessian_constant": "yes",
    "ipopt.max_iter": 200,
    # the order of elimination is fixed so that every platform takes the same steps
    "ipopt.mumps_permuting_scaling": 0,
    "ipopt.mumps_pivot_order": 2,
}


@dataclass(frozen=True, eq=False)
class Answer:
    """What IPOPT returned: never reported, only a start for the exact active set."""

    x: Array
    multipliers: Array
    success: bool
    status: str
    iterations: int

    @property
    def usable(self) -> bool:
        """Whether x is a start for the exact active set: an answer that is nearly one is, it is polished anyway."""
        return self.success or self.status == "Solved_To_Acceptable_Level"


def solve_rows(rows: Array, right: Array, equalities: int, objective: Array, *, careful: bool = False) -> Answer:
    """Minimise objective . x subject to rows . x <= right, the last `equalities` rows as equations.

    `careful` goes without the quick steps for linear programs, which may diverge.

    Rows are scaled to unit length before IPOPT sees them; the multipliers returned belong to the rows as given.
    """
    length = np.linalg.norm(rows, axis=1)
    length[length == 0.0] = 1.0
    scaled, upper = rows / length[:, None], right / length
    lower = np.full(len(right), -np.inf)
    if equalities:
        lower[-equalities:] = upper[-equalities:]
    solver = _solver(rows.shape[1], rows.shape[0], careful=careful)
    parameters = np.concatenate([scaled.ravel(order="F"), objective])
    start = np.zeros(rows.shape[1])
    start[-1] = 10.0
    result = solver(x0=start, p=parameters, lbg=lower, ubg=upper)
    stats = solver.stats()
    status = str(stats["return_status"])
    return Answer(
        x=np.asarray(result["x"], dtype=float).ravel(),
        multipliers=np.asarray(result["lam_g"], dtype=float).ravel() / length,
        success=bool(stats["success"]) and status == "Solve_Succeeded",
        status=status,
        iterations=int(stats["iter_count"]),
    )


@lru_cache(maxsize=512)
def _solver(size: int, count: int, *, careful: bool) -> Any:  # noqa: ANN401 - a casadi Function, imported late
    import casadi as ca

    x = ca.MX.sym("x", size)
    rows = ca.MX.sym("rows", count, size)
    objective = ca.MX.sym("objective", size)
    p = ca.vertcat(ca.vec(rows), objective)
    no_curvature = ca.Function(
        "hessian",
        [x, ca.MX.sym("p", p.numel()), ca.MX.sym("f"), ca.MX.sym("g", count)],
        [ca.MX(size, size)],
        ["x", "p", "lam_f", "lam_g"],
        ["triu_hess_gamma_x_x"],
    )
    options: Any = {**_QUIET, **_LINEAR, "ipopt.tol": 1e-9, "hess_lag": no_curvature}
    if careful:
        options["ipopt.mehrotra_algorithm"] = "no"
    program: Any = {"x": x, "p": p, "f": ca.dot(objective, x), "g": rows @ x}
    return ca.nlpsol("program", "ipopt", program, options)
