"""What a solution of a problem of least acceleration claims.

Nothing here uses optlaws.synthesis beyond Problem and Solution. Laws are judged by numpy.polynomial on their stored
Chebyshev series.
"""

import numpy as np
from numpy.polynomial import Chebyshev
from numpy.typing import NDArray

from optlaws import MotionLaw, Problem, Solution
from optlaws.synthesis import PolynomialBasis

Array = NDArray[np.float64]

UNIT = (0.0, 1.0)
DENSE = 0.5 - 0.5 * np.cos(np.linspace(0.0, np.pi, 4001))


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
