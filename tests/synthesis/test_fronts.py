"""Fronts: every point is the optimum of its own problem, and what is proven between points."""

import json
from dataclasses import replace
from time import perf_counter
from typing import Any

import numpy as np
import pytest

from optlaws import (
    BoundaryConditions,
    BSplines,
    Chebyshev,
    Front,
    InfeasibleProblem,
    InputError,
    Problem,
    ProvenFront,
    Range,
    Solution,
    SolverFailure,
    Status,
    at_least,
    limit,
    pareto_front,
    proven_front,
    synthesize,
)
from tests.internals.synthesis import HEADINGS, evaluate, named, undominated, value_of
from tests.sampling import sampled

L4 = Problem(order=4)


@pytest.fixture(scope="module")
def velocity() -> Front:
    return pareto_front(L4, points=20)


@pytest.fixture(scope="module")
def power() -> Front:
    return pareto_front(Problem(B=1.641, order=4), over=("C", "D"), points=5)


def falls(front: Front) -> bool:
    first, second = np.diff(front.values, axis=0).T
    return bool((first > 0.0).all() and (second < 0.0).all())


def test_convex_points_are_the_optima_of_their_problems(velocity: Front) -> None:
    assert len(velocity) == 20
    assert falls(velocity)
    for solution in velocity:
        alone = synthesize(solution.problem)
        assert solution.status == "optimal"
        assert solution.objective == pytest.approx(alone.objective, rel=1e-8)
        assert value_of(solution, "B") == pytest.approx(solution.problem.B, rel=1e-12)


def test_ends_are_the_least_of_either_constant(velocity: Front) -> None:
    free = synthesize(L4)
    assert velocity[-1].objective == pytest.approx(free.objective, rel=1e-10)
    assert value_of(velocity[-1], "B") == pytest.approx(value_of(free, "B"), rel=1e-9)
    assert velocity.values[0, 0] == pytest.approx(1.1296908, rel=1e-6)


def test_the_curve_of_a_convex_problem_is_convex_and_above_the_limit(velocity: Front) -> None:
    B, C = velocity.values.T
    slopes = np.diff(C) / np.diff(B)
    assert (np.diff(slopes) >= -1e-6 * np.abs(slopes[1:])).all()
    assert all(c > limit("C", b) for b, c in zip(B, C, strict=True))


def test_points_lie_evenly(velocity: Front) -> None:
    logs = np.log(velocity.values)
    steps = np.diff((logs - logs[0]) / (logs[-1] - logs[0]), axis=0)
    lengths = np.hypot(*steps.T)
    assert lengths.max() < 5.0 * lengths.min()


@pytest.mark.long
def test_points_with_power_agree_with_single_problems(power: Front) -> None:
    assert len(power) == 5
    assert falls(power)
    for solution in power:
        assert solution.objective == pytest.approx(synthesize(solution.problem).objective, rel=1e-8)
        assert value_of(solution, "B") == pytest.approx(1.641, rel=1e-12)
        assert solution.lower_bound <= solution.objective
    least = synthesize(Problem(B=1.641, order=4))
    assert power.values[0] == pytest.approx([least.objective, value_of(least, "D")], rel=1e-4)
    assert power[-1].objective == pytest.approx(synthesize(Problem(B=1.641, order=4, minimise="D")).objective, rel=1e-8)


@pytest.mark.sample(3)
@pytest.mark.parametrize(
    ("problem", "over", "between"),
    [
        (Problem(order=2, basis=Chebyshev(3)), ("B", "C"), None),
        (Problem(order=3, basis=Chebyshev(9)), ("B", "J"), (1.4, 3.0)),
        (Problem(B=1.641, order=4), ("C", "J"), None),
        (Problem(order=4, monotone=True), ("B", "rms_c"), (1.3, 2.0)),
        (Problem(order=4, symmetric=False, basis=Chebyshev(5)), ("B", "C"), (1.75, 1.9)),
        (Problem(order=4, J=Range(0.0, 150.0)), ("B", "C"), None),
    ],
)
def test_other_constants_and_conditions(
    problem: Problem, over: tuple[str, ...], between: tuple[float, float] | None
) -> None:
    front = pareto_front(problem, over, points=6, between=between)
    assert len(front) == 6
    assert falls(front)
    assert max(solution.gap for solution in front) < 1e-7
    assert front.failed == ()


def test_the_first_constant_keeps_between_its_values_and_where_it_pays() -> None:
    front = pareto_front(L4, points=4, between=(1.5, 1.8))
    assert front.values[[0, -1], 0] == pytest.approx([1.5, 1.8], rel=1e-12)
    wide = pareto_front(L4, points=4, between=(1.0, 3.0))
    assert wide.values[[0, -1], 0] == pytest.approx([1.1296908, 1.9029423], rel=1e-6)
    with pytest.raises(InputError, match=r"C is least at B = 1\.90294"):
        pareto_front(L4, between=(2.0, 3.0))


def test_three_constants_give_a_surface() -> None:
    problem = Problem(order=3, basis=Chebyshev(5))
    front = pareto_front(problem, ("B", "C", "J"), points=16, between=(1.4, 2.0))
    assert front.values.shape == (len(front), 3)
    assert len(front) >= 8
    assert len(undominated(list(front), front.over)) == len(front)
    assert max(solution.gap for solution in front) < 1e-7


@pytest.mark.sample(2)
@pytest.mark.parametrize(("problem", "over"), [(Problem(B=1.641, order=4), ("C", "D")), (Problem(order=3), ("B", "D"))])
def test_fronts_of_power_are_proven(problem: Problem, over: tuple[str, str]) -> None:
    proven = pareto_front(problem, over=over, points=4, bound="tight")
    assert len(proven) == 4
    assert falls(proven)
    assert max(solution.gap for solution in proven) < 1e-8
    assert [solution.status for solution in proven] == [Status.OPTIMAL] * 4
    for solution in proven:
        alone = synthesize(solution.problem, bound="tight")
        assert solution.objective == pytest.approx(alone.objective, rel=1e-9)


def test_fronts_of_power_are_ordered_and_as_many_as_given(power: Front) -> None:
    assert len(power) == 5
    assert falls(power)
    data = power.to_xarray()
    assert data.D.dims == ("C",)
    assert data.C.values.tolist() == pytest.approx(power.values[:, 0].tolist(), rel=1e-12)
    assert data.D.values.tolist() == pytest.approx(power.values[:, 1].tolist(), rel=1e-12)


def test_worse_laws_are_left_out() -> None:
    solutions = [synthesize(Problem(B=B, order=4)) for B in (1.7, 2.4, 1.6, 1.6)]
    kept = undominated(solutions, ("B", "C"))
    assert [one.problem.B for one in kept] == [1.6, 1.7]


@pytest.mark.parametrize(
    ("problem", "options", "match"),
    [
        (L4, {"over": ("B",)}, "two or three constants"),
        (L4, {"over": ("B", "B")}, "each once"),
        (L4, {"over": ("B", "X")}, "'X'"),
        (L4, {"over": ("snap + C", "C")}, "is no constant of a law but an expression"),
        (L4, {"over": ("B", 3)}, "over names constants"),
        (Problem(B=1.6, order=4), {}, "B is exchanged"),
        (Problem(order=4, C=6.0), {}, "C is exchanged"),
        ("L4", {}, "takes a Problem"),
        *(
            (L4, {"between": wrong}, "between must be two numbers")
            for wrong in [(2.0, 1.0), (1.5,), (0.0, 2.0), (1.5, float("inf")), (True, 2.0)]
        ),
        *((L4, {"points": wrong}, "points") for wrong in (1, 2.5, "9")),
    ],
)
def test_wrong_questions_are_refused(problem: Problem, options: dict[str, Any], match: str) -> None:
    with pytest.raises(InputError, match=match):
        pareto_front(problem, **{"over": ("B", "C"), **options})


def test_a_front_tells_itself(velocity: Front) -> None:
    assert repr(velocity).startswith("Front(over=('B', 'C'), 20 points, B 1.12969 to 1.90294")
    assert "<table>" in velocity._repr_html_()
    content = json.loads(json.dumps(velocity.to_dict()))
    assert content["over"] == ["B", "C"]
    assert len(content["points"]) == 20
    assert [len(row) for row in velocity.rows] == [len(HEADINGS)] * 20
    assert isinstance(velocity[3], Solution)


def test_neighbours_are_continued(velocity: Front) -> None:
    assert any(solution.iterations == 0 for solution in velocity)


@pytest.mark.long
def test_fifty_points_are_quick() -> None:
    began = perf_counter()
    pareto_front(L4, ("B", "D"), points=50)
    assert perf_counter() - began < 10.0


def test_many_points_are_put_in_together_and_lie_as_evenly() -> None:
    front = pareto_front(Problem(order=4, basis=Chebyshev(5)), points=200, between=(1.4, 1.8))
    assert len(front) == 200
    assert all(point.status == "optimal" for point in front)
    B, C = front.values.T
    assert (np.diff(B) > 0.0).all()
    assert (np.diff(C) < 0.0).all()
    logs = np.log(front.values)
    lengths = np.hypot(*(np.diff(logs, axis=0) / np.ptp(logs, axis=0)).T)
    assert lengths.max() < 4.0 * lengths.mean()
    alone = synthesize(front[77].problem)
    assert front[77].objective == pytest.approx(alone.objective, rel=1e-11)


@pytest.mark.parametrize(
    "over",
    [
        ("residual(frequency=20.0)", "C"),
        pytest.param(("peak(c + 0.2*b)", "J"), marks=pytest.mark.long),
        pytest.param(("rms_c", "C_cam(frequency=20.0)"), marks=pytest.mark.long),
    ],
)
def test_any_constants_are_exchanged(over: tuple[str, str]) -> None:
    front = pareto_front(Problem(B=1.8, order=4), over=over, points=4)
    first, last = front.values.T
    assert (first[1:] > first[:-1]).all()
    assert (last[1:] < last[:-1]).all()
    assert set(over) <= set(front.headings)
    assert [len(row) for row in front.rows] == [len(front.headings)] * len(front)
    for point, value in zip(front, first, strict=True):
        assert named(over[0]).value(point.law) == value
        assert synthesize(point.problem).objective == pytest.approx(point.objective, rel=1e-8)
    same = pareto_front(Problem(B=1.8, order=4), over=tuple(named(name) for name in over), points=4)
    assert same.values == pytest.approx(front.values, rel=1e-9)


def test_a_constant_that_can_vanish_is_exchanged_from_near_nothing_on() -> None:
    front = pareto_front(Problem(order=3, basis=Chebyshev(9)), over=("residual(frequency=20)", "C"), points=4)
    residuals, accelerations = front.values.T
    assert 1e-5 < residuals[0] / residuals[-1] < 1e-3
    assert (np.diff(accelerations) < 0.0).all()
    assert all(point.status is Status.OPTIMAL for point in front)


# --- proven fronts ---


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


def test_unless_given_a_front_lies_where_it_pays() -> None:
    front = proven_front(REST, gap=1e-2)
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
