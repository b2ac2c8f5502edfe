"""The same problems as a competent user would put them to CasADi's Opti or to scipy: points and rows.

Minimise C with |c| <= C, 0 <= b <= B at 200 points of the half interval and b(1/2) = B, over laws
S_l + k^l (k-1)^l Z(k), Z a sum of odd Chebyshev polynomials in 2k - 1 scaled so that each moves c by at most 10. Or
minimise D with |b c| <= D and b <= B in place of these, from Z = 0.
"""

from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np
from numpy.polynomial import Chebyshev
from numpy.typing import NDArray
from scipy.optimize import linprog, minimize

from optlaws import Problem
from tests.synthesis.independent import polynomial

Array = NDArray[np.float64]

POINTS = 200
UNIT = (0.0, 1.0)


@dataclass(frozen=True)
class Answer:
    """What the solver claims C or D to be, and the true peaks of |c|, |b c| and b, and the least b, of its law."""

    claimed: float
    acceleration: float
    power: float
    velocity: float
    backward: float


@dataclass(frozen=True)
class Claim:
    """Coefficients and C or D as a solver gave them."""

    x: Array
    value: float


class Rows:
    """Velocities of the base law and of the free functions, as series and on the grid; the same for every B."""

    def __init__(self, problem: Problem) -> None:
        k = Chebyshev([0.5, 0.5], domain=UNIT)
        edge = k * (k - 1)
        whole = (edge ** (problem.order - 1)).integ(lbnd=0.0)
        self.velocities = [edge ** (problem.order - 1) / whole(1.0)]
        dense = np.linspace(0.0, 0.5, 1000)
        for i in range(1, polynomial(problem).degree + 1, 2):
            z = Chebyshev.basis(i, domain=UNIT)
            one = (edge**problem.order * z).deriv()
            self.velocities.append(one * (10.0 / np.abs(one.deriv()(dense)).max()))
        grid = np.linspace(0.0, 0.5, POINTS)
        self.b0, self.b = self._columns([v(grid) for v in self.velocities])
        self.c0, self.c = self._columns([v.deriv()(grid) for v in self.velocities])

    @staticmethod
    def _columns(values: list[Array]) -> tuple[Array, Array]:
        return values[0], np.column_stack(values[1:])

    def judged(self, claim: Claim) -> Answer:
        """The claim with the true extremes of its law."""
        b = sum((w * v for w, v in zip(claim.x, self.velocities[1:], strict=True)), self.velocities[0])
        low, high = _extremes(b)
        c, d = (max(map(abs, _extremes(one))) for one in (b.deriv(), b * b.deriv()))
        return Answer(claim.value, c, d, high, -low)

    def read(self, claim: Claim) -> tuple[Array, float, float]:
        """The law's Chebyshev series and its peaks of |c| and |b c| on the grid, as a user would look at them."""
        b = sum((w * v for w, v in zip(claim.x, self.velocities[1:], strict=True)), self.velocities[0])
        c = self.c0 + self.c @ claim.x
        d = (self.b0 + self.b @ claim.x) * c
        return np.asarray(b.integ(lbnd=0.0).coef, dtype=float), float(np.abs(c).max()), float(np.abs(d).max())


def _extremes(series: Chebyshev) -> tuple[float, float]:
    roots = np.real(series.deriv().roots())
    k = np.concatenate([[0.0, 0.5, 1.0], roots[(roots > 0.0) & (roots < 1.0)]])
    return float(series(k).min()), float(series(k).max())


def opti(rows: Rows, B: float) -> Claim:
    """CasADi's Opti with IPOPT and its default tolerances."""
    program = ca.Opti()
    x, C = program.variable(rows.b.shape[1]), program.variable()
    c, b = (ca.DM(fixed) + ca.mtimes(ca.DM(free), x) for fixed, free in ((rows.c0, rows.c), (rows.b0, rows.b)))
    program.minimize(C)
    program.subject_to(c <= C)
    program.subject_to(c >= -C)
    program.subject_to(b[:-1] >= 0.0)
    program.subject_to(b[:-1] <= B)
    program.subject_to(b[-1] == B)
    program.solver("ipopt", {"print_time": False}, {"print_level": 0, "sb": "yes"})
    optimum = program.solve()
    return Claim(np.asarray(optimum.value(x), dtype=float).reshape(-1), float(optimum.value(C)))


def highs(rows: Rows, B: float) -> Claim:
    """scipy's linprog with HiGHS and its default tolerances."""
    one, none = np.ones((POINTS, 1)), np.zeros((POINTS - 1, 1))
    b = rows.b[:-1]
    upper = np.block([[rows.c, -one], [-rows.c, -one], [-b, none], [b, none]])
    right = np.concatenate([-rows.c0, rows.c0, rows.b0[:-1], B - rows.b0[:-1]])
    objective = np.append(np.zeros(rows.b.shape[1]), 1.0)
    optimum = linprog(
        objective,
        A_ub=upper,
        b_ub=right,
        A_eq=np.append(rows.b[-1], 0.0)[None],
        b_eq=[B - rows.b0[-1]],
        bounds=(None, None),
        method="highs",
    )
    if optimum.x is None:
        raise RuntimeError(f"HiGHS gave no answer: {optimum.message}")
    return Claim(np.asarray(optimum.x[:-1], dtype=float), float(optimum.x[-1]))


def power_by_opti(rows: Rows, B: float) -> Claim:
    """D by CasADi's Opti with IPOPT and its default tolerances."""
    program = ca.Opti()
    x, D = program.variable(rows.b.shape[1]), program.variable()
    c, b = (ca.DM(fixed) + ca.mtimes(ca.DM(free), x) for fixed, free in ((rows.c0, rows.c), (rows.b0, rows.b)))
    program.minimize(D)
    program.subject_to(b * c <= D)
    program.subject_to(b * c >= -D)
    program.subject_to(b[:-1] <= B)
    program.subject_to(b[-1] == B)
    program.set_initial(D, 10.0)
    program.solver("ipopt", {"print_time": False}, {"print_level": 0, "sb": "yes"})
    optimum = program.solve()
    return Claim(np.asarray(optimum.value(x), dtype=float).reshape(-1), float(optimum.value(D)))


def power_by_slsqp(rows: Rows, B: float) -> Claim:
    """D by scipy's SLSQP with exact slopes."""
    size = rows.b.shape[1]
    one, none = np.ones((POINTS, 1)), np.zeros((POINTS - 1, 1))
    below = np.hstack([-rows.b[:-1], none])
    middle = np.append(rows.b[-1], 0.0)[None]

    def room(x: Array) -> Array:
        d = (rows.b0 + rows.b @ x[:-1]) * (rows.c0 + rows.c @ x[:-1])
        return np.concatenate([x[-1] - d, x[-1] + d])

    def slope(x: Array) -> Array:
        b, c = rows.b0 + rows.b @ x[:-1], rows.c0 + rows.c @ x[:-1]
        d = b[:, None] * rows.c + c[:, None] * rows.b
        return np.vstack([np.hstack([-d, one]), np.hstack([d, one])])

    constraints: Any = [
        {"type": "ineq", "fun": room, "jac": slope},
        {"type": "ineq", "fun": lambda x: B - rows.b0[:-1] + below @ x, "jac": lambda _: below},
        {"type": "eq", "fun": lambda x: middle @ x + rows.b0[-1] - B, "jac": lambda _: middle},
    ]
    goal = np.append(np.zeros(size), 1.0)
    solve: Any = minimize
    start = np.append(np.zeros(size), 10.0)
    optimum = solve(
        lambda x: float(x[-1]),
        start,
        jac=lambda _: goal,
        constraints=constraints,
        method="SLSQP",
        options={"maxiter": 500, "ftol": 1e-9},
    )
    return Claim(np.asarray(optimum.x[:-1], dtype=float), float(optimum.x[-1]))
