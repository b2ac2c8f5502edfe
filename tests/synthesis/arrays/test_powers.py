"""Laws of least power solved together: locally best as each is alone, with the same bound, and on_global_branch."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from optlaws import (
    Chebyshev,
    Problem,
    ProblemArray,
    Solution,
    SolutionArray,
    at_most,
    map_arrays,
    synthesize,
    synthesize_array,
)
from optlaws.verification import verify
from tests.internals.synthesis import (
    LawSearch,
    ParametricContinuation,
    Path,
    SolvedBatch,
    States,
    between,
    laws_on,
    least_power,
    locally_optimal,
    on_global_branch,
    solve_many,
)

ENDS = (1.42, 2.6)
COUNT = 60


def check(laws: SolutionArray, places: list[int]) -> None:
    """What was solved together is what each is alone."""
    for place in places:
        alone, one = synthesize(laws.problems.problem(place)), laws.result(place)
        assert isinstance(one, Solution)
        assert place not in laws.others
        assert one.objective == pytest.approx(alone.objective, rel=1e-9)
        assert one.status is alone.status
        np.testing.assert_allclose(one.z_series, alone.z_series, rtol=1e-8, atol=1e-8)
        assert one.lower_bound == pytest.approx(alone.lower_bound, rel=1e-9)
        assert one.lower_bound == laws.lower_bound.reshape(-1)[place]
        assert one.certificate.bound <= one.objective
        assert one.constants.D.value == pytest.approx(laws.D.reshape(-1)[place], rel=1e-12)


KINDS: dict[str, dict[str, Any]] = {
    "B": {},
    "B of order 2, degree 5": {"order": 2, "basis": Chebyshev(5)},
    "B, no return": {"B": np.linspace(1.5, 2.5, COUNT), "monotone": True, "basis": Chebyshev(7)},
    "B, unsymmetric": {"B": np.linspace(1.6, 2.2, COUNT), "symmetric": False, "order": 3, "basis": Chebyshev(5)},
    "most C": {"B": 1.7, "C": (None, np.linspace(5.0, 5.9, COUNT))},
    "most C, any B": {"B": None, "C": (None, np.linspace(4.9, 5.6, COUNT)), "basis": Chebyshev(7)},
    "weights": {"B": 1.7, "minimise": map_arrays("{:.17g}*D".format, np.linspace(0.5, 2.0, COUNT))},
}


@pytest.mark.sample(6)
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.filterwarnings("ignore::optlaws.NotNormalised")
def test_laws_of_least_power_are_those_solved_alone(kind: str) -> None:
    entries = {"B": np.linspace(*ENDS, COUNT), "order": 4, "basis": Chebyshev(9), "minimise": "D"} | KINDS[kind]
    laws = synthesize_array(ProblemArray(**entries))
    assert (laws.status == "local").all()
    assert not laws.others
    check(laws, [2, 31, 58])


def test_laws_of_least_power_depend_neither_on_their_order_nor_on_their_company() -> None:
    B = np.linspace(*ENDS, 61)
    whole, turned, half = (
        synthesize_array(ProblemArray(B=some, order=3, basis=Chebyshev(5), minimise="D"))
        for some in (B, B[::-1], B[::2])
    )
    assert not {**whole.others, **turned.others, **half.others}
    np.testing.assert_allclose(turned.objective[::-1], whole.objective, rtol=1e-12)
    np.testing.assert_allclose(half.objective, whole.objective[::2], rtol=1e-12)
    np.testing.assert_allclose(half.z_series, whole.z_series[::2], rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(half.lower_bound, whole.lower_bound[::2], rtol=1e-10)


def test_power_among_laws_that_are_no_convex_set_is_not_solved_in_arrays() -> None:
    assert least_power(Problem(B=1.7, order=4, minimise="D", C=at_most(9.0)))
    for asked in ({"D": (None, 6.0)}, {"windows": ["b*c <= 3 @ 0.2..0.3"]}, {"minimise": "0.5*C/4 + 0.5*D/2.25"}):
        entries: dict[str, Any] = {"B": 1.7, "order": 4, "minimise": "D"} | asked
        assert not least_power(Problem.from_dict(entries))


def path_of(degree: int) -> Path:
    problem = Problem(order=4, basis=Chebyshev(degree), B=ENDS[0], minimise="D")
    path = between(problem, replace(problem, B=ENDS[1]))
    assert path is not None
    return path


@pytest.mark.long
def test_laws_of_least_power_where_their_structure_changes() -> None:
    path = path_of(9)
    segments = ParametricContinuation(path, 0.0, 1.0).whole(np.array([0.5]))
    edges = np.array([segment.end for segment in segments[:-1]])
    assert len(edges) == 4
    beside = np.concatenate([edges + away for away in (-1e-6, 0.0, 1e-6)])
    t = np.sort(np.concatenate([np.linspace(0.0, 1.0, 40), beside]))
    laws = laws_on(path, segments, t)
    assert laws.solved.all()
    for row in np.flatnonzero(np.isin(t, edges)):
        alone = synthesize(Problem(order=4, basis=Chebyshev(9), B=float(1.42 + 1.18 * t[row]), minimise="D"))
        assert laws.objective[row] == pytest.approx(alone.objective, rel=1e-9)


def test_where_another_branch_is_better_laws_are_sought_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    class Rival(LawSearch):
        def least(self, known: float) -> float | None:
            own = super().least(known)
            return own if own is None or ENDS[0] != self.problem.B else 0.99 * own

    monkeypatch.setattr(solve_many, "LawSearch", Rival)
    laws = synthesize_array(ProblemArray(B=np.linspace(*ENDS, 24), order=7, basis=Chebyshev(7), minimise="D"))
    assert sorted(laws.others) == list(range(6))
    assert (laws.status == "local").all()


def test_laws_between_two_that_agree_are_kept_and_no_others() -> None:
    changed = replace(SolvedBatch.none(25, 0, 0, 0), objective=np.ones(25))
    for answers, kept in (
        ({}, range(25)),
        ({12: 0.9}, [*range(7), *range(18, 25)]),
        ({0: None}, range(6, 25)),
        ({0: 0.9, 24: 1.1}, range(6, 19)),
    ):
        sought = on_global_branch(changed, np.arange(25), lambda place, answers=answers: answers.get(place, 1.0))  # type: ignore[misc]
        assert np.flatnonzero(sought).tolist() == list(kept)


def test_a_law_that_is_no_minimum_is_seen() -> None:
    path = path_of(5)
    segments = ParametricContinuation(path, 0.0, 1.0).whole(np.array([0.5]))
    assert {len(path.model.program.right) + one.structure.count for one in segments} == {3, 4}
    for segment in segments:
        states = States.unpacked(segment.rows, segment.structure)
        assert locally_optimal(segment.structure, states).all()
        # with as many rows as variables nothing is left free
        vertex = segment.structure.count == 3
        turned = replace(states, weights=-states.weights)
        assert locally_optimal(segment.structure, turned).tolist() == [vertex] * len(states)


@pytest.mark.long
def test_without_laws_and_with_tight_bounds_each_is_solved_alone() -> None:
    laws = synthesize_array(ProblemArray(B=np.linspace(1.05, 1.8, 60), order=4, basis=Chebyshev(3), minimise="D"))
    assert set(laws.status.tolist()) == {"infeasible", "local"}
    assert (np.diff((laws.status == "local").astype(int)) >= 0).all()
    tight = synthesize_array(
        ProblemArray(B=np.linspace(1.7, 1.8, 24), order=2, basis=Chebyshev(1), minimise="D"), bound="tight"
    )
    assert len(tight.others) == 24


def test_a_law_of_least_power_is_verified() -> None:
    laws = synthesize_array(ProblemArray(B=np.linspace(*ENDS, 24), order=4, basis=Chebyshev(5), minimise="D"))
    again = SolutionArray.from_dict(laws.to_dict())
    for place in (1, 20):
        assert again.result(place) == laws.result(place)
        assert verify(laws[place].to_dict()).proven
