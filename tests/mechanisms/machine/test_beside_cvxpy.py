"""Optimal laws for machines beside cvxpy's on grids: these ask less, so that no proven optimum is below them."""

from math import asin

import cvxpy as cp
import numpy as np
import pytest
from numpy.typing import NDArray

from optlaws import Chebyshev, Machine, MotionLaw, Problem, at_most, synthesize
from optlaws.typing import PeakSide
from tests.internals.synthesis import space_of
from tests.mechanisms.machine.test_optimal import chain
from tests.sampling import sampled

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

GRID = np.linspace(0.0, 1.0, 401)
X, WEIGHTS = np.polynomial.legendre.leggauss(80)
PLACES, MEASURE = 0.5 * (X + 1.0), 0.5 * WEIGHTS
SPREAD, DAMPINGS = 0.08, (0.0, 0.06)


def amplitudes(machine: Machine, output: str, laws: list[MotionLaw]) -> Complex:
    """What the first mode leaves of each law, over a grid of frequencies and damping ratios: shape (places, laws)."""
    values, right = np.linalg.eig(np.array(machine.A))
    upper = np.where(values.imag > 1e-6, np.abs(values), np.inf)
    i = int(np.argmin(upper))
    root, B = complex(values[i]), machine.load
    row = np.array(machine.C[machine.outputs.index(output)])
    driven = np.linalg.inv(right)[i] @ (B[:, 0] / root + B[:, 1] + root * B[:, 2])
    share = 2.0 * (row @ right[:, i]) * driven
    nu, angle = np.meshgrid(
        abs(root) * np.linspace(1.0 - SPREAD, 1.0 + SPREAD, 21), np.linspace(asin(DAMPINGS[0]), asin(DAMPINGS[1]), 5)
    )
    roots = (1j * nu * np.exp(1j * angle)).ravel()
    velocities = np.array([MEASURE * law.b(PLACES) for law in laws]).T
    found: Complex = share * (np.exp(np.outer(roots, 1.0 - PLACES)) @ velocities)
    return found


@pytest.mark.parametrize("seed", sampled(range(12), each=5))
def test_optima_are_never_beaten_by_cones_on_a_grid(seed: int) -> None:
    machine = chain(seed, masses=1 + seed % 3)
    basis, kind = Chebyshev(7 + seed % 3), ("both", "high", "rms")[seed % 3]
    side: PeakSide = "high" if kind == "high" else "both"
    goal = machine.rms("motor torque") if kind == "rms" else machine.peak("motor torque", side=side)
    residual = machine.residual(1, "last acceleration", spread=SPREAD, damping=DAMPINGS)
    free = synthesize(Problem(order=3, basis=basis, minimise=goal, symmetric=False, B=at_most(2.5)))
    allowed = 0.4 * residual.value(free.law)
    problem = Problem(
        order=3, basis=basis, minimise=goal, symmetric=False, B=at_most(2.5), bounds={residual: at_most(allowed)}
    )
    solution = synthesize(problem)
    assert solution.status.value == "optimal"

    space = space_of(basis, problem.conditions, symmetric=False)
    laws = [space.law(one) for one in np.vstack([np.eye(space.terms), np.zeros(space.terms)])]
    x, times = cp.Variable(space.terms), PLACES if kind == "rms" else GRID
    torque, velocity, left = (
        (columns[:, :-1] - columns[:, -1:]) @ x + columns[:, -1]
        for columns in (
            np.array([machine.response(law)["motor torque"](times) for law in laws]).T,
            np.array([law.b(GRID) for law in laws]).T,
            amplitudes(machine, "last acceleration", laws),
        )
    )
    goals = {
        "both": lambda: cp.norm(torque, "inf"),
        "high": lambda: cp.max(torque),
        "rms": lambda: cp.norm(cp.multiply(np.sqrt(MEASURE), torque), 2),
    }
    relaxed = cp.Problem(cp.Minimize(goals[kind]()), [cp.abs(velocity) <= 2.5, cp.abs(left) <= allowed])
    least = float(relaxed.solve(solver=cp.CLARABEL))
    assert least <= solution.objective * (1.0 + 1e-7)
    assert least >= solution.objective * 0.98
