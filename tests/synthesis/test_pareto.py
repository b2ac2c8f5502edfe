"""Fronts: every point is the optimum of its own problem, and none is better than another in every constant."""

import json
from time import perf_counter

import numpy as np
import pytest

from optlaws import Chebyshev, Front, InputError, Problem, Range, Solution, Status, limit, pareto_front, synthesize
from tests.internals.synthesis import HEADINGS, named, undominated, value_of

L4 = Problem(order=4)


@pytest.fixture(scope="module")
def velocity() -> Front:
    return pareto_front(L4, points=20)


@pytest.fixture(scope="module")
def power() -> Front:
    return pareto_front(Problem(B=1.641, order=4), over=("C", "D"), points=8)


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
    assert len(power) == 8
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
    assert len(power) == 8
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
    ("problem", "over", "match"),
    [
        (L4, ("B",), "two or three constants"),
        (L4, ("B", "B"), "each once"),
        (L4, ("B", "X"), "'X'"),
        (L4, ("snap + C", "C"), "is no constant of a law but an expression"),
        (L4, ("B", 3), "over names constants"),
        (Problem(B=1.6, order=4), ("B", "C"), "B is exchanged"),
        (Problem(order=4, C=6.0), ("B", "C"), "C is exchanged"),
        ("L4", ("B", "C"), "takes a Problem"),
    ],
)
def test_wrong_questions_are_refused(problem: Problem, over: tuple[str, ...], match: str) -> None:
    with pytest.raises(InputError, match=match):
        pareto_front(problem, over)


@pytest.mark.parametrize("between", [(2.0, 1.0), (1.5,), (0.0, 2.0), (1.5, float("inf")), (True, 2.0)])
def test_wrong_ranges_are_refused(between: tuple[float, float]) -> None:
    with pytest.raises(InputError, match="between must be two numbers"):
        pareto_front(L4, between=between)


@pytest.mark.parametrize("points", [1, 2.5, "9"])
def test_too_few_points_are_refused(points: int) -> None:
    with pytest.raises(InputError, match="points"):
        pareto_front(L4, points=points)


def test_a_front_tells_itself(velocity: Front) -> None:
    assert repr(velocity).startswith("Front(over=('B', 'C'), 20 points, B 1.12969 to 1.90294")
    assert "<table>" in velocity._repr_html_()
    content = json.loads(json.dumps(velocity.to_dict()))
    assert content["over"] == ["B", "C"]
    assert len(content["points"]) == 20
    assert [len(row) for row in velocity.rows] == [len(HEADINGS)] * 20
    assert isinstance(velocity[3], Solution)


def test_the_same_question_gives_the_same_front(velocity: Front) -> None:
    assert (pareto_front(L4, points=20).values == velocity.values).all()


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
