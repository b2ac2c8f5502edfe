"""Constants bounded from below that rows cannot hold up: an RMS, and B where it is itself minimised."""

import numpy as np
import pytest

from optlaws import (
    FUNCTIONALS,
    Bernstein,
    BoundaryConditions,
    Chebyshev,
    Powers,
    Problem,
    Range,
    at_least,
    at_most,
    between,
    synthesize,
)
from tests.synthesis.judge import judge

ENDS = BoundaryConditions((0, 0, 0), (1, 1.357, 1.348))
ALONE = [
    (Problem(order=4, minimise="rms_c", bounds={"rms_c": at_least(5.0)}), 5.0),
    (Problem(order=2, minimise="rms_j", bounds={"rms_j": between(46.7, 58.4)}), 46.7),
    (Problem(order=3, minimise="rms_c", B=1.8, bounds={"rms_c": at_least(7), "C": at_least(9)}), 7.0),
    (
        Problem(
            boundary=BoundaryConditions((0, -0.846), (1, -0.446)),
            symmetric=False,
            B=2.0853,
            minimise="B",
            basis=Chebyshev(7),
        ),
        2.0853,
    ),
    (Problem(boundary=ENDS, symmetric=False, B=2.2108531, minimise="B", basis=Powers(9)), 2.2108531),
    (Problem(boundary=ENDS, symmetric=False, B=at_least(2.2), J=at_most(900), minimise="B", basis=Powers(9)), 2.2),
]


@pytest.mark.sample(3)
@pytest.mark.parametrize(("problem", "least"), ALONE, ids=range(len(ALONE)))
def test_what_is_minimised_is_proven_at_its_lower_bound(problem: Problem, least: float) -> None:
    solution = synthesize(problem)
    assert solution.status == "optimal"
    assert solution.objective == pytest.approx(least, rel=1e-9)
    judge(solution)


@pytest.mark.sample(4)
@pytest.mark.parametrize(
    ("problem", "name"),
    [
        (Problem(order=2, basis=Bernstein(5), minimise="J", J=at_most(119), bounds={"rms_j": at_least(77.7)}), "rms_j"),
        (Problem(order=2, basis=Bernstein(5), minimise="C+J/20", bounds={"rms_j": at_least(77.7)}), "rms_j"),
        (Problem(order=3, minimise="C", B=2, bounds={"rms_j": at_least(100)}), "rms_j"),
        (Problem(order=3, minimise="J", bounds={"rms_c": between(5, 6)}), "rms_c"),
    ],
)
def test_an_rms_held_up_beside_an_objective_is_kept_and_bounded(problem: Problem, name: str) -> None:
    solution = synthesize(problem)
    judge(solution)
    asked = problem.bounds[name]
    assert isinstance(asked, Range)
    value = FUNCTIONALS[name].value(solution.law)
    assert value >= asked.low * (1.0 - 1e-9)
    assert solution.status == "local"
    without = synthesize(Problem(B=problem.B, order=problem.order, basis=problem.basis, minimise=problem.minimise))
    assert without.lower_bound - 1e-9 <= solution.lower_bound <= solution.objective
    # no law beside it in any direction is better: the bound holds it up, and a greater one costs more
    more = synthesize(
        Problem(
            B=problem.B,
            order=problem.order,
            basis=problem.basis,
            minimise=problem.minimise,
            bounds={name: at_least(1.05 * asked.low)},
        )
    )
    assert more.objective > solution.objective
    assert np.isfinite(more.objective)
