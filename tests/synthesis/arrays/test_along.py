"""Laws solved together against laws solved alone: across structures, at the places where they change, beside them."""

from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from optlaws import (
    BoundaryConditions,
    Certificate,
    Chebyshev,
    InfeasibleProblem,
    Problem,
    ProblemArray,
    Solution,
    SolutionArray,
    Window,
    at_most,
    map_arrays,
    residual_vibration,
    synthesize,
    synthesize_array,
)
from optlaws.verification import verify
from tests.bench.plain import Rows, highs
from tests.internals.synthesis import (
    ParametricContinuation,
    Path,
    StructureSegment,
    _event,
    between,
    converged,
    laws_along,
    laws_on,
)

ENDS = (1.42, 2.6)
COUNT = 400


def path_of(degree: int) -> Path:
    problem = Problem(order=4, basis=Chebyshev(degree), B=ENDS[0])
    path = between(problem, replace(problem, B=ENDS[1]))
    assert path is not None
    return path


def walked(path: Path) -> list[StructureSegment]:
    return ParametricContinuation(path, 0.0, 1.0).whole(np.array([0.0]))


def check(laws: SolutionArray, places: np.ndarray[Any, Any]) -> None:
    """What was solved together is what each is alone, and its certificate says so by itself."""
    for place in places.tolist():
        alone, one = synthesize(laws.problems.problem(place)), laws.result(place)
        assert not isinstance(one, Exception)
        assert one.objective == pytest.approx(alone.objective, rel=1e-9)
        assert one.status is alone.status
        np.testing.assert_allclose(one.z_series, alone.z_series, rtol=1e-9, atol=1e-8)
        assert one.certificate.bound >= one.objective * (1.0 - 1e-10)
        assert one.lower_bound <= one.certificate.bound + 1e-10 * one.objective
        assert abs(one.gap) <= 1e-10


@pytest.mark.sample(3)
@pytest.mark.parametrize(("degree", "changes"), [(5, 2), (9, 3), (19, 8)])
def test_structures_follow_each_other_without_a_gap(degree: int, changes: int) -> None:
    segments = walked(path_of(degree))
    assert len(segments) == changes + 1
    assert segments[0].begin == 0.0
    assert segments[-1].end == pytest.approx(1.0, abs=1e-8)
    for one, other in pairwise(segments):
        assert one.structure.signature != other.structure.signature
        assert abs(other.begin - one.end) < 1e-7


def test_states_that_are_nearly_one_do_not_spoil_what_is_interpolated() -> None:
    path = path_of(9)
    segment = max(walked(path), key=lambda one: one.end - one.begin)
    middle = (segment.begin + segment.end) / 2.0
    beside = np.asarray(middle + 1e-10 * np.arange(3), dtype=np.float64)
    states, done = converged(segment.structure, path.numbers(beside), segment.interpolated(beside))
    assert done.all()
    segment.joined(beside, np.asarray(states.packed + 1e-9 * np.arange(3)[:, None]))
    asked = np.array([middle + 1e-4])
    exact, done = converged(segment.structure, path.numbers(asked), segment.guessed(asked))
    assert done.all()
    np.testing.assert_allclose(segment.interpolated(asked).packed, exact.packed, rtol=1e-5, atol=1e-5)


def shortened(path: Path, segment: StructureSegment, begin: float, end: float) -> StructureSegment:
    """A segment of which less is known."""
    ends = np.array([begin, end])
    states, done = converged(segment.structure, path.numbers(ends), segment.interpolated(ends))
    assert done.all()
    kept = (segment.t > begin) & (segment.t < end)
    found = StructureSegment(segment.structure, segment.t[kept], segment.rows[kept])
    found.joined(ends, states.packed)
    return found


def test_laws_between_segments_that_are_known_less_far_are_tried_with_both() -> None:
    path = path_of(5)
    first, second, *others = walked(path)
    event, t = first.end, np.linspace(0.0, 1.0, 100)
    beside = np.sort(np.append(t, event + 1e-4 * np.arange(-2.0, 3.0)))
    known = laws_on(path, [first, second, *others], beside)
    less = [shortened(path, first, 0.0, event - 1e-3), shortened(path, second, event + 1e-3, second.end), *others]
    laws = laws_on(path, less, beside)
    assert known.solved.all()
    assert laws.solved.all()
    np.testing.assert_allclose(laws.objective, known.objective, rtol=1e-12)


def test_where_an_event_is_follows_from_what_is_broken_beyond_it() -> None:
    assert _event([(1.2, 0.2), (1.5, 0.5)]) == pytest.approx(1.0)
    curved = [(1.0 + off + off**2, off) for off in (0.1, 0.2, 0.4)]
    assert _event(curved) == pytest.approx(1.0, abs=1e-12)
    assert _event([(1.2, 0.2), (1.5, 0.1)]) is None
    assert _event([(1.2, 0.2), (1.5, 0.5), (2.0, 0.3)]) == pytest.approx(1.0)


@pytest.mark.sample(2)
@pytest.mark.parametrize("degree", [5, 9, pytest.param(19, marks=pytest.mark.long)])
def test_laws_where_the_structure_changes_and_beside_it_are_those_solved_alone(degree: int) -> None:
    edges = [segment.end for segment in walked(path_of(degree))[:-1]]
    beside = np.concatenate([[0.0, 1.0], *(np.array(edges) + away for away in (-1e-6, -1e-9, 0.0, 1e-9, 1e-6))])
    B = ENDS[0] + (ENDS[1] - ENDS[0]) * np.sort(np.concatenate([np.linspace(0.0, 1.0, 150), beside]))
    laws = synthesize_array(ProblemArray(B=B, order=4, basis=Chebyshev(degree)))
    assert (laws.status == "optimal").all()
    check(laws, np.flatnonzero(np.isin(np.arange(len(B)), np.searchsorted(B, ENDS[0] + 1.18 * np.array(edges)))))


KINDS: dict[str, dict[str, Any]] = {
    "B": {"B": np.linspace(1.45, 2.5, COUNT)},
    "B of order 2, degree 7": {"B": np.linspace(1.45, 2.5, COUNT), "order": 2, "basis": Chebyshev(7)},
    "B, no return": {"B": np.linspace(1.5, 2.5, COUNT), "monotone": True},
    "J": {"B": np.linspace(1.6, 1.9, COUNT), "order": 3, "minimise": "J", "basis": Chebyshev(7)},
    "C of one sign": {"B": np.linspace(1.6, 1.9, COUNT), "minimise": "C_minus"},
    "weights": {"B": 1.7, "minimise": map_arrays("{:.17g}*C/4 + J/32".format, np.linspace(0.5, 4.0, COUNT))},
    "windows": {
        "B": 1.7,
        "windows": map_arrays(lambda h: Window("b", high=h, start=0.2, stop=0.3), np.linspace(1.1, 1.5, COUNT)),
    },
    "most C": {"B": 1.7, "minimise": "J", "C": (None, np.linspace(4.9, 6.0, COUNT))},
    "most B": {"B": (None, np.linspace(1.6, 2.2, COUNT)), "minimise": "snap", "order": 3},
    "root mean square": {"B": np.linspace(1.45, 2.5, COUNT), "minimise": "rms_c"},
    "weights of a root mean square": {
        "B": 1.7,
        "minimise": map_arrays("{:.17g}*rms_c/3.4 + C/4".format, np.linspace(0.5, 4.0, COUNT)),
    },
    "most root mean square": {"B": 1.7, "bounds": {"rms_c": (None, np.linspace(3.8, 4.2, COUNT))}},
    "most residual": {
        "order": 3,
        "bounds": {residual_vibration(frequency=(18, 22)): (None, np.linspace(0.1, 0.4, COUNT // 2))},
    },
    "B with a residual": {
        "order": 3,
        "B": np.linspace(1.6, 2.2, COUNT // 2),
        "bounds": {residual_vibration(frequency=20): at_most(0.1)},
    },
    "least residual": {
        "order": 3,
        "B": np.linspace(1.6, 2.2, COUNT // 2),
        "minimise": residual_vibration(frequency=(18, 22), damping=0.02),
        "symmetric": False,
        "J": (None, 80.0),
    },
    "end velocity": {
        "minimise": "C",
        "symmetric": False,
        "boundary": map_arrays(lambda v: BoundaryConditions((0.0, 0.0, 0.0), (1.0, v, 0.0)), np.linspace(0.2, 0.6, 5)),
        "order": 3,
    },
}


@pytest.mark.sample(18)
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.filterwarnings("ignore::optlaws.NotNormalised")
def test_any_number_of_a_problem_may_vary(kind: str) -> None:
    entries = {"order": 4, "basis": Chebyshev(9)} | KINDS[kind]
    laws = synthesize_array(ProblemArray(**entries))
    assert (laws.status == "optimal").all()
    assert laws.gap.max() <= 1e-10
    check(laws, np.random.default_rng(7).choice(laws.size, 3, replace=False))


def test_laws_depend_neither_on_their_order_nor_on_their_company() -> None:
    B = np.linspace(*ENDS, COUNT)
    whole = synthesize_array(ProblemArray(B=B, order=4))
    turned = synthesize_array(ProblemArray(B=B[::-1], order=4))
    half = synthesize_array(ProblemArray(B=B[::2], order=4))
    np.testing.assert_allclose(turned.z_series[::-1], whole.z_series, rtol=1e-10, atol=1e-9)
    np.testing.assert_allclose(half.z_series, whole.z_series[::2], rtol=1e-10, atol=1e-9)
    np.testing.assert_allclose(half.objective, whole.objective[::2], rtol=1e-12)


@pytest.mark.sample(2)
@pytest.mark.parametrize("degree", [5, 19])
def test_no_law_breaks_a_row_anywhere(degree: int) -> None:
    path = path_of(degree)
    t = np.linspace(0.0, 1.0, COUNT)
    laws = laws_along(path, t)
    assert laws.excess.max() <= 1e-11
    rng = np.random.default_rng(3)
    for place in rng.choice(COUNT, 20, replace=False).tolist():
        for family in path.program(float(t[place])).families:
            _, _, residual = family.extremes(laws.x[place])
            assert residual.max() <= 1e-10


@pytest.mark.long
def test_beyond_the_first_problem_without_a_law_none_has_one() -> None:
    B = np.linspace(1.05, 1.6, 300)
    laws = synthesize_array(ProblemArray(B=B, order=3, basis=Chebyshev(5)))
    without = np.flatnonzero(laws.status == "infeasible")
    assert len(without) > 20
    assert (laws.status[without[-1] + 1 :] == "optimal").all()
    assert without[-1] == len(without) - 1
    nearest, farthest = laws.result(int(without[-1])), laws.result(0)
    assert isinstance(nearest, InfeasibleProblem)
    assert isinstance(farthest, InfeasibleProblem)
    assert isinstance(nearest.proof, Certificate)
    assert nearest.proof.proves_infeasible
    # the multipliers of the nearest prove it of the farthest, whose problem their certificate is of
    assert isinstance(farthest.proof, Certificate)
    assert farthest.proof.contacts == nearest.proof.contacts
    assert farthest.proof.problem == farthest.problem == laws.problems.problem(0)
    assert farthest.proof.proves_infeasible
    assert farthest.problem == laws.problems[0]
    with pytest.raises(InfeasibleProblem):
        synthesize(laws.problems[0])


def test_laws_next_to_the_least_velocity_whose_multipliers_are_great_are_proven_together() -> None:
    laws = synthesize_array(ProblemArray(B=np.linspace(1.1296918, 1.1304, 300), order=4))
    assert not laws.others
    for place in (0, 1, 40):
        alone, one = synthesize(laws.problems.problem(place)), laws.result(place)
        assert isinstance(one, Solution)
        assert one.objective == pytest.approx(alone.objective, rel=1e-9)
        assert one.status is alone.status
        assert one.gap <= 1.1 * alone.gap
        assert one.lower_bound <= one.certificate.bound + 1e-10 * one.objective


def judged_by_another_solver(laws: SolutionArray, place: int) -> None:
    """A linear program on points is a relaxation: what it claims is below the law's C, and not by much."""
    problem = laws.problems.problem(place)
    assert isinstance(problem.B, float)
    claimed = highs(Rows(problem), problem.B).value
    assert laws.objective[place] * 0.98 < claimed < laws.objective[place] * (1.0 + 1e-7)


def test_another_solver_finds_the_same() -> None:
    laws = synthesize_array(ProblemArray(B=np.linspace(1.5, 2.4, COUNT), order=4, monotone=True))
    for place in (3, 150, 390):
        judged_by_another_solver(laws, place)


@pytest.mark.long
@pytest.mark.parametrize("seed", range(25))
def test_many_laws_of_any_structure_are_those_solved_alone(seed: int) -> None:
    rng = np.random.default_rng(seed)
    order, degree = int(rng.integers(2, 6)), int(rng.choice([3, 5, 7, 9, 13, 19, 27]))
    monotone = bool(rng.integers(2))
    low = 1.42 if degree > 3 else 1.55
    B = np.sort(rng.uniform(low, 2.6, 4000))
    minimise = str(rng.choice(["C", "C", "C", "J", "0.6*C/4 + 0.4*J/32", "max(C/4, J/32)"]))
    entries = {"order": order, "basis": Chebyshev(degree), "monotone": monotone, "minimise": minimise}
    laws = synthesize_array(ProblemArray(B=B, **entries))
    places = np.flatnonzero(laws.status == "optimal")
    assert np.isin(laws.status, ["optimal", "infeasible"]).all()
    assert laws.gap[places].max() <= 1e-8
    together = np.setdiff1d(places, np.array(list(laws.others), dtype=np.intp))
    assert len(together) >= 0.9 * len(places)
    check(laws, rng.choice(together, 8, replace=False))
    if minimise == "C" and monotone:
        judged_by_another_solver(laws, int(rng.choice(together)))


def test_certificates_are_verified_with_every_rounding_enclosed() -> None:
    laws = synthesize_array(ProblemArray(B=np.linspace(1.5, 2.4, COUNT), order=4))
    assert not laws.others
    for place in (10, 200, 390):
        solution = laws.result(place)
        assert isinstance(solution, Solution)
        assert verify(solution.to_dict()).proven
