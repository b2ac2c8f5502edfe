"""Constants bounded from below: peaks, which are reached and proven; an RMS and B, which no row can hold up."""

import json
from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np
import pytest

from optlaws import (
    FUNCTIONALS,
    Bernstein,
    BoundaryConditions,
    Certificate,
    Chebyshev,
    InfeasibleProblem,
    Pieces,
    Powers,
    Problem,
    Range,
    at_least,
    at_most,
    between,
    limit,
    synthesize,
)
from tests.internals.verification import prove
from tests.synthesis.judge import Judged, judge

pytestmark = pytest.mark.filterwarnings("ignore::optlaws.errors.NotNormalised")


@pytest.mark.sample(3)
@pytest.mark.parametrize("order", [2, 3, 4])
@pytest.mark.parametrize("B", [None, 1.8, at_least(1.5)], ids=repr)
def test_the_least_c_of_at_least_6_is_6(order: int, B: Any) -> None:
    solution = synthesize(Problem(B=B, C=at_least(6), order=order))
    judge(solution)
    assert solution.status.value == "optimal"
    assert solution.objective == pytest.approx(6.0, rel=1e-9)
    # the bound is a row of the program, so the certificate alone proves it
    again = Certificate.from_dict(json.loads(json.dumps(solution.certificate.to_dict())))
    assert again.bound == pytest.approx(6.0, rel=1e-9)
    value = prove(again).value
    assert value is not None
    assert float(value) == pytest.approx(6.0, rel=1e-9)


@pytest.mark.sample(4)
@pytest.mark.parametrize("basis", [Bernstein(9), Pieces(8, 6, 4)], ids=repr)
@pytest.mark.parametrize("name", ["C", "J"])
def test_in_other_bases_too(basis: Any, name: str) -> None:
    free = synthesize(Problem(B=1.7, order=3, minimise="rms_c", basis=basis))
    own = Judged(free.law).constant(name)
    solution = synthesize(replace(free.problem, bounds={name: at_least(1.1 * own)}))
    judge(solution)
    assert Judged(solution.law).constant(name) == pytest.approx(1.1 * own, rel=1e-8)
    assert solution.objective > free.objective


def test_a_lower_bound_costs_the_more_the_higher_it_is() -> None:
    worths = [synthesize(Problem(B=1.7, order=4, minimise="rms_c", J=at_least(J))).objective for J in (90, 110, 140)]
    assert worths == sorted(worths)


@pytest.mark.sample(9)
@pytest.mark.parametrize(("minimise", "B"), list(product(["D", "rms_c", "C"], [1.3, 1.9, 2.5])))
def test_a_power_below_its_limit_is_refused_with_the_limit(minimise: str, B: float) -> None:
    least = limit("D", B)
    with pytest.raises(InfeasibleProblem, match="of all laws the least is"):
        synthesize(Problem(B=B, order=3, basis=Chebyshev(5), minimise=minimise, D=at_most(0.97 * least)))


def test_what_is_not_convex_does_not_hide_a_contradiction() -> None:
    with pytest.raises(InfeasibleProblem, match=r"\|c\| <= C") as caught:
        synthesize(Problem(B=1.7, order=4, C=at_most(4.8), D=at_most(9.0), minimise="J"))
    assert isinstance(caught.value.proof, Certificate)
    assert caught.value.proof.proves_infeasible


@pytest.mark.long
def test_a_peak_velocity_between_end_velocities_is_reached_where_it_costs_least() -> None:
    ends = BoundaryConditions((0, 0, 0), (1, 2.327, 0))
    solution = synthesize(
        Problem(boundary=ends, symmetric=False, B=2.434537605559302, monotone=True, basis=Chebyshev(17))
    )
    judge(solution)
    # letting the peak go from where it was asked led to 4.36222 only
    assert solution.objective < 4.36219


# --- an RMS, and B where it is minimised ---


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
