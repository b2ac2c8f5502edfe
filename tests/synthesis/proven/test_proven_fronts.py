"""Proven fronts: at every value a law of the problem there, a bound that stands by itself, and the gap as stated."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from optlaws import (
    BoundaryConditions,
    BSplines,
    InfeasibleProblem,
    InputError,
    Problem,
    ProvenFront,
    SolverFailure,
    at_least,
    proven_front,
    smoothstep,
    synthesize,
)
from tests.internals.laws import law_between
from tests.internals.synthesis import evaluate
from tests.sampling import sampled

REST = Problem(order=4)
FIXED = Problem(order=4, B=1.9)
MIXED = Problem(order=4, B=1.8, minimise="C/4 + rms_c/3.4641")
TILTED = Problem(order=2, boundary=BoundaryConditions((0, 0.5), (1, 0)), symmetric=False, inflexion=0.4)
SPLINES = Problem(order=4, B=1.9, basis=BSplines(6, 3))

CASES: dict[str, tuple[Problem, Any, tuple[float, float], float]] = {
    "B": (REST, ("B", "C"), (1.42, 2.6), 1e-4),
    "a steep end": (REST, ("B", "C"), (1.1297, 1.2), 1e-4),
    "a bound of C": (REST, ("C", "J"), (4.7, 5.0), 1e-4),
    "a bound of J": (REST, ("J", "C"), (60.0, 300.0), 1e-4),
    "a bound of an RMS": (FIXED, ("rms_c", "C"), (3.98, 4.3), 1e-5),
    "splines": (SPLINES, ("rms_c", "C"), (4.1, 4.4), 1e-5),
    "an RMS over B": (replace(REST, minimise="rms_c"), "B", (1.6, 1.9), 1e-5),
    "a maximum": (replace(REST, minimise="max(C/4, J/40)"), "B", (1.5, 1.7), 1e-5),
    "all laws": (replace(REST, symmetric=False), ("B", "C"), (1.5, 1.6), 1e-5),
    "other ends": (TILTED, "B", (1.5, 1.7), 1e-4),
    "a weight": (MIXED, "weight of rms_c", (0.05, 0.6), 1e-5),
}


@pytest.mark.sample(2)
@pytest.mark.parametrize("case", sampled(CASES))
def test_between_the_laws_too_the_gap_is_as_stated(case: str) -> None:
    problem, over, between, gap = CASES[case]
    front = proven_front(problem, over, between=between, gap=gap)
    assert front.gap <= gap
    assert front.between == between
    random = np.random.default_rng(12)
    middles = (np.array(front.values[1:]) + np.array(front.values[:-1])) / 2.0
    for value in [*between, *random.uniform(*between, 4).tolist(), *random.choice(middles, 2).tolist()]:
        point, best = front(value), synthesize(front.number.at(value))
        assert evaluate(point.problem, point.law).excess <= 1e-12
        assert point.objective == evaluate(point.problem, point.law).objective
        assert point.gap <= front.gap + 1e-15
        # each side is on its side of what synthesize proves of the same problem
        assert point.lower_bound <= best.objective * (1.0 + 1e-12)
        assert point.objective >= best.lower_bound * (1.0 - 1e-12)
        assert front.lower(value) <= point.lower_bound + 1e-12
        assert point.objective <= front.upper(value) + 1e-12
        assert 0.0 <= front.upper(value) - front.lower(value) <= gap * point.objective * (1.0 + 1e-9)


def test_where_places_stay_two_laws_prove_everything_between() -> None:
    front = proven_front(REST, between=(1.5, 1.52), gap=1e-11)
    assert len(front) == 17
    ends = ProvenFront(
        front.number, front.between, (front.laws[0], front.laws[-1]), front.certificates[:: len(front) - 1]
    )
    assert ends.gap < 1e-11


def test_sides_of_many_values_at_once_are_those_of_each() -> None:
    for case in ("B", "a weight"):
        problem, over, between, _ = CASES[case]
        front = proven_front(problem, over, between=between, gap=1e-3)
        values = np.random.default_rng(3).uniform(*between, (4, 5))
        for side in (front.upper, front.lower):
            assert side(values).shape == values.shape
            assert side(values)[1, 2] == side(float(values[1, 2]))
        turns, heights = front.curve
        assert np.interp(values, turns, heights) == pytest.approx(front.upper(values), rel=1e-14)


def test_a_front_is_read_as_it_was_written() -> None:
    for case in ("a bound of an RMS", "a weight", "splines"):
        problem, over, between, gap = CASES[case]
        front = proven_front(problem, over, between=between, gap=100.0 * gap)
        again = ProvenFront.from_dict(front.to_dict())
        assert again == front
        assert again.gap == front.gap
        assert again(between[0]) == front(between[0])


def test_unless_given_a_front_lies_where_it_pays() -> None:
    front = proven_front(REST, gap=1e-3)
    low, high = front.between
    assert low == pytest.approx(1.1297, abs=1e-4)
    assert high == pytest.approx(synthesize(REST).constants.B.value)
    assert repr(front).startswith("ProvenFront(B 1.12969 to 1.90294, C, gap at most ")


@pytest.mark.parametrize(
    ("problem", "options", "message"),
    [
        (REST, {"over": ("B", "D")}, "D is not convex, so that two laws prove nothing"),
        (REST, {"over": ("D", "C")}, "D is not convex"),
        (REST, {"over": ("Q", "C")}, "unknown constant 'Q'"),
        (REST, {"over": ("B", "C", "J")}, "over must name what runs and what is minimised"),
        (FIXED, {}, "B runs: leave it out of the problem, got 1.9"),
        (replace(REST, J=at_least(50.0)), {}, "J is bounded from below"),
        (replace(TILTED, inflexion=None), {"over": "B"}, "give inflexion, or at_most"),
        (MIXED, {"over": "weight of J"}, "unknown term of the objective 'J'"),
        (REST, {"over": "weight of C"}, "a weight runs in an objective of several terms"),
        (MIXED, {"over": "weight of C", "between": None}, "give between"),
        (REST, {"between": (1.9, 1.5)}, "between must be two numbers above 0 in ascending order"),
        (REST, {"between": (1.5, float("nan"))}, "between must be two numbers"),
        (REST, {"gap": 0.0}, "gap"),
        (REST, {"between": (0.5, 1.5)}, "B"),
        ("a problem", {}, "proven_front takes a Problem, got str"),
    ],
)
def test_what_is_not_convex_or_no_range_is_said(problem: Any, options: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        proven_front(problem, **{"between": (1.5, 1.7), "gap": 1e-3, **options})


def test_an_end_without_a_law_is_named_with_the_least_value() -> None:
    with pytest.raises(InfeasibleProblem, match=r"no law has B = 1\.05, .* is 1\.12969059") as caught:
        proven_front(REST, between=(1.05, 1.7), gap=1e-3)
    assert caught.value.proof is not None
    with pytest.raises(InfeasibleProblem, match=r"least rms_c of these problems is 3\.6259"):
        proven_front(REST, ("rms_c", "J"), between=(3.0, 3.8), gap=1e-3)


def test_a_gap_below_that_of_the_laws_is_refused() -> None:
    with pytest.raises(SolverFailure, match=r"has a gap of .* itself"):
        proven_front(REST, between=(1.5, 1.7), gap=1e-16)


def test_beyond_the_ends_nothing_is_known() -> None:
    front = proven_front(REST, between=(1.5, 1.7), gap=1e-3)
    wrong: list[Any] = [1.4999, 1.7001, float("nan"), "1.6", None]
    for value in wrong:
        with pytest.raises(InputError, match=r"proven for B from 1\.5 to 1\.7, not at"):
            front(value)
    with pytest.raises(InputError, match="not at NaN"):
        front.upper([1.6, float("nan")])


def test_certificates_of_other_problems_are_refused() -> None:
    front = proven_front(REST, between=(1.5, 1.7), gap=1e-3)
    with pytest.raises(InputError, match="is not of the problem there"):
        replace(front, certificates=front.certificates[::-1])
    with pytest.raises(InputError, match="ascending"):
        replace(front, values=front.values[::-1])


def test_laws_between_are_weighted_means() -> None:
    mean = law_between(smoothstep(2), smoothstep(5), 0.25)
    k = np.linspace(0.0, 1.0, 11)
    assert mean.c(k) == pytest.approx(0.75 * smoothstep(2).c(k) + 0.25 * smoothstep(5).c(k), abs=1e-13)
    with pytest.raises(InputError, match="polynomials with the same breaks"):
        law_between(smoothstep(2), synthesize(SPLINES).law, 0.5)
