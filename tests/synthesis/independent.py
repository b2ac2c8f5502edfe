"""What the tests know of optimal laws without asking optlaws: random problems, checks of a law, and a linear program.

Nothing here uses optlaws.synthesis beyond Problem and Solution. Laws are judged by numpy.polynomial on their stored
Chebyshev series; optima are found again by HiGHS over all laws of eq. 8, symmetric or not, on the full interval.
"""

from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

import numpy as np
from numpy.polynomial import Chebyshev
from numpy.typing import NDArray
from scipy.optimize import linprog

from optlaws import Chebyshev as ChebyshevBasis
from optlaws import MotionLaw, Problem, Solution
from optlaws.synthesis import PolynomialBasis

Array = NDArray[np.float64]

UNIT = (0.0, 1.0)
DENSE = 0.5 - 0.5 * np.cos(np.linspace(0.0, np.pi, 4001))


def random_problems(seed: int, count: int, degrees: tuple[int, int] = (3, 21)) -> list[Problem]:
    """Problems of order 2 to 6 with B from 1.1 to 3, monotone where a coin says so."""
    numbers = np.random.default_rng(seed)
    return [
        Problem(
            B=round(float(numbers.uniform(1.1, 3.0)), 6),
            order=int(numbers.integers(2, 7)),
            basis=ChebyshevBasis(int(numbers.integers(degrees[0], degrees[1] + 1))),
            monotone=bool(numbers.integers(2)),
        )
        for _ in range(count)
    ]


def polynomial(problem: Problem) -> PolynomialBasis:
    """The basis of a problem with polynomial Z."""
    assert isinstance(problem.basis, PolynomialBasis)
    return problem.basis


def velocity_of(problem: Problem) -> float:
    """The B of a problem that gives it a value."""
    assert isinstance(problem.B, float)
    return problem.B


def z_of(solution: Solution) -> tuple[float, ...]:
    """Coefficients of Z of a law that has one."""
    assert solution.z is not None
    return solution.z


def z_powers_of(solution: Solution) -> tuple[float, ...]:
    """The same in ascending powers."""
    assert solution.z_powers is not None
    return solution.z_powers


def acceleration_of(law: MotionLaw) -> Chebyshev:
    """c(k) as a numpy series, from what the law stores."""
    return Chebyshev(np.array([*law.to_dict()["acceleration"], 0.0, 0.0]), domain=UNIT)


def extremes(series: Chebyshev) -> tuple[float, float]:
    """Least and greatest value on [0, 1]: a dense grid, the stationary points and the ends."""
    slope = series.deriv().trim()
    stationary = np.real(slope.roots()) if len(slope.coef) > 1 else np.empty(0)
    k = np.concatenate([DENSE, stationary[(stationary > 0.0) & (stationary < 1.0)]])
    values = series(k)
    return float(values.min()), float(values.max())


def check_solution(solution: Solution, *, of_array: bool = False) -> None:
    """Everything a solution claims, judged from the stored law alone."""
    problem, law = solution.problem, solution.law
    expected = velocity_of(problem)
    stored = law.to_dict()
    c = acceleration_of(law)
    b = c.integ(lbnd=0.0) + stored["b0"]
    a = b.integ(lbnd=0.0) + stored["a0"]

    lowest, highest = extremes(b)
    assert highest <= expected * (1 + 1e-10)
    if problem.monotone:
        assert lowest >= -1e-10 * expected
    assert abs(b(0.5) - expected) <= 1e-12 * expected
    assert abs(a(0.0)) <= 1e-12
    assert abs(a(1.0) - 1.0) <= 1e-12
    if problem.symmetric:
        assert np.abs(a(DENSE) + a(1.0 - DENSE) - 1.0).max() <= 1e-12
    derivative = b
    for nu in range(1, problem.order):
        size = np.abs(derivative(DENSE)).max()
        assert max(abs(derivative(0.0)), abs(derivative(1.0))) <= 1e-9 * size, f"derivative {nu}"
        derivative = derivative.deriv()

    peak = max(np.abs(extremes(c)))
    assert abs(peak - solution.objective) <= 1e-12 * peak
    assert solution.status.value == "optimal"
    assert 0.0 <= solution.gap + 1e-14 <= 1e-8
    assert solution.lower_bound <= peak * (1 + 1e-14)
    assert peak <= solution.lower_bound * (1 + 1e-8)
    assert solution.best_possible is not None
    assert peak >= solution.best_possible
    proven = max(solution.certificate.bound, solution.best_possible)
    # laws of an array have their bounds together: rounding takes a little more of each, and never less
    assert solution.lower_bound <= proven if of_array else solution.lower_bound == proven


@dataclass(frozen=True)
class Space:
    """Laws of eq. 8: columns of values on any points, the base law S_l first."""

    acceleration: tuple[Chebyshev, ...]
    chord: tuple[Chebyshev, ...]
    ratio: tuple[Chebyshev, ...]
    middle: Array
    mixture: Array

    def columns(self, functions: tuple[Chebyshev, ...], k: Array) -> tuple[Array, Array]:
        """Values of the base law and of orthogonal mixtures of the free functions."""
        values = np.column_stack([function(k) for function in functions])
        return values[:, 0], values[:, 1:] @ self.mixture


@lru_cache(maxsize=64)
def space(order: int, degree: int) -> Space:
    """All laws S_l + k^l (k-1)^l Z(k) with Z a Chebyshev series.

    Functions of each: c, (b(1/2) - b) / (1-2k)^2, and b / (k(1-k))^(l-1) in units of the base law's.
    """
    k = Chebyshev([0.5, 0.5], domain=UNIT)
    edge = k * (k - 1)
    smooth = (edge ** (order - 1)).integ(lbnd=0.0)
    base = edge ** (order - 1) / smooth(1.0)
    accelerations, chords, ratios, middles = [], [], [], []
    for i in range(-1, degree + 1):
        if i < 0:
            velocity, ratio = base, Chebyshev([1.0], domain=UNIT)
        else:
            z = Chebyshev.basis(i, domain=UNIT)
            rest = order * edge.deriv() * z + edge * z.deriv()
            velocity, ratio = edge ** (order - 1) * rest, rest * smooth(1.0)
        accelerations.append(velocity.deriv())
        # what the division leaves is c(1/2) times a function: an equation sets it to zero
        chords.append((velocity(0.5) - velocity) // (2 * k - 1) ** 2)
        ratios.append(ratio)
        middles.append(velocity(0.5))
    values = np.column_stack([c(DENSE) for c in accelerations[1:]])
    mixture = np.linalg.inv(np.linalg.qr(values)[1]) * 50.0
    return Space(tuple(accelerations), tuple(chords), tuple(ratios), np.array(middles), mixture)


def least_acceleration(problem: Problem, rounds: int = 60) -> float | None:
    """C of the optimal law by HiGHS on points that are exchanged until nothing is violated; None if infeasible."""
    law_space = space(problem.order, polynomial(problem).degree)
    size = polynomial(problem).degree + 1
    start = 0.5 - 0.5 * np.cos(np.linspace(0.0, np.pi, 4 * size + 12))
    points = {"c": start, "chord": start, "ratio": start}
    middle = np.array([0.5])
    slope0, slope = law_space.columns(law_space.acceleration, middle)
    equations = np.vstack([np.append(law_space.middle[1:] @ law_space.mixture, 0.0), np.append(slope[0], 0.0)])
    expected = np.array([velocity_of(problem) - law_space.middle[0], -slope0[0]])
    for _ in range(rounds):
        rows, right = [], []
        c0, c = law_space.columns(law_space.acceleration, points["c"])
        for sign in (1.0, -1.0):
            rows.append(np.column_stack([sign * c, -np.ones(len(c))]))
            right.append(-sign * c0)
        q0, q = law_space.columns(law_space.chord, points["chord"])
        rows.append(np.column_stack([-q, np.zeros(len(q))]))
        right.append(q0)
        if problem.monotone:
            r0, r = law_space.columns(law_space.ratio, points["ratio"])
            rows.append(np.column_stack([-r, np.zeros(len(r))]))
            right.append(r0)
        found = _highs(np.vstack(rows), np.concatenate(right), equations, expected)
        if found is None:
            return None
        x, C = found[:-1], float(found[-1])
        free = np.append(1.0, law_space.mixture @ x)
        worst = 0.0
        for name, functions, kind in (
            ("c", law_space.acceleration, 0),
            ("chord", law_space.chord, 1),
            ("ratio", law_space.ratio, 1),
        ):
            if name == "ratio" and not problem.monotone:
                continue
            series = sum(weight * function for weight, function in zip(free, functions, strict=True))
            places, excess = _peaks(series, C, two_sided=kind == 0)
            worst = max(worst, float(excess.max()) / max(C, 1.0))
            points[name] = np.concatenate([points[name], places[excess > -1e-3 * max(C, 1.0)]])
        if worst <= 1e-9:
            return C
    raise AssertionError(f"the exchange did not end: {worst:.1e} of {C} in {problem}")


def _peaks(series: Chebyshev, C: float, *, two_sided: bool) -> tuple[Array, Array]:
    roots = np.real(series.deriv().roots())
    k = np.concatenate([[0.0, 1.0], roots[(roots > 0.0) & (roots < 1.0)]])
    values = series(k)
    return k, np.abs(values) - C if two_sided else -values


def _highs(rows: Array, right: Array, equations: Array, expected: Array) -> Array | None:
    length = np.maximum(np.linalg.norm(rows, axis=1), 1e-300)
    objective = np.zeros(rows.shape[1])
    objective[-1] = 1.0
    bounds: list[tuple[float | None, float | None]] = [(None, None)] * (len(objective) - 1) + [(0.0, None)]
    said = ""
    ways: tuple[tuple[Literal["highs", "highs-ipm"], float], ...]
    ways = (("highs", 1e-10), ("highs", 1e-9), ("highs-ipm", 1e-9), ("highs", 1e-8))
    for method, tolerance in ways:
        answer = linprog(
            objective,
            A_ub=rows / length[:, None],
            b_ub=right / length,
            A_eq=equations,
            b_eq=expected,
            bounds=bounds,
            method=method,
            options={"primal_feasibility_tolerance": tolerance, "dual_feasibility_tolerance": tolerance},
        )
        if answer.status == 0:
            return np.asarray(answer.x, dtype=float)
        if answer.status == 2:
            return None
        said = answer.message
    raise AssertionError(f"HiGHS gave no answer: {said}")
