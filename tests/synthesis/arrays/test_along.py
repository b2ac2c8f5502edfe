"""Laws solved together against laws solved alone: along a line, of formulas and of power, whatever their structure."""

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
    FormulaFamily,
    LawSearch,
    Path,
    SolvedBatch,
    States,
    StructureSegment,
    between,
    converged,
    laws_along,
    least_power,
    locally_optimal,
    model_of,
    on_global_branch,
    solve_many,
)
from tests.sampling import sampled

ENDS = (1.42, 2.6)
COUNT = 400


def path_of(degree: int) -> Path:
    problem = Problem(order=4, basis=Chebyshev(degree), B=ENDS[0])
    path = between(problem, replace(problem, B=ENDS[1]))
    assert path is not None
    return path


def between_places(low: float = 0.0, high: float = 1.0) -> np.ndarray[Any, Any]:
    """Places of a path."""
    return np.linspace(low, high, 2001)


def segments_along(path: Path, t: np.ndarray[Any, Any]) -> list[StructureSegment]:
    """The structures of the optima at ascending t, in their order."""
    segments: list[StructureSegment] = []
    laws_along(path, t, segments)
    return sorted(segments, key=lambda segment: segment.begin)


def changes(path: Path, low: float = 0.0, high: float = 1.0) -> list[float]:
    """Where one structure gives way to the next, or both are the same but for rounding."""
    between = transitions(segments_along(path, between_places(low, high)))
    if not between or high - low < 1e-8:
        return [low]
    return [place for edge in between for place in changes(path, *edge)]


def transitions(segments: list[StructureSegment]) -> list[tuple[float, float]]:
    """The last known place of each structure, and the first one of the next; a structure may come again."""
    known = sorted((float(t), i) for i, segment in enumerate(segments) for t in segment.t)
    return [(low, high) for (low, one), (high, other) in pairwise(known) if one != other]


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
@pytest.mark.parametrize(("degree", "count"), [(5, 2), (9, 3), (19, 8)])
def test_structures_follow_each_other_without_a_gap(degree: int, count: int) -> None:
    t = between_places()
    segments = segments_along(path_of(degree), t)
    assert (min(each.begin for each in segments), max(each.end for each in segments)) == (0.0, 1.0)
    assert len({each.structure.signature for each in segments}) == len(segments)
    between = transitions(segments)
    assert len(between) == count
    assert [high - low for low, high in between] == pytest.approx([t[1]] * count)


def test_states_that_are_nearly_one_do_not_spoil_what_is_interpolated() -> None:
    path = path_of(9)
    segment = max(segments_along(path, between_places()), key=lambda one: one.end - one.begin)
    middle = (segment.begin + segment.end) / 2.0
    beside = np.asarray(middle + 1e-10 * np.arange(3), dtype=np.float64)
    states, done = converged(segment.structure, path.numbers(beside), segment.interpolated(beside))
    assert done.all()
    segment.joined(beside, np.asarray(states.packed + 1e-9 * np.arange(3)[:, None]))
    asked = np.array([middle + 1e-4])
    exact, done = converged(segment.structure, path.numbers(asked), segment.interpolated(asked))
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
    path, t = path_of(5), between_places()
    first, second, *others = segments_along(path, t)
    event = first.end
    less = [shortened(path, first, 0.0, event - 1e-3), shortened(path, second, event + 1e-3, second.end), *others]
    known, laws = laws_along(path, t), laws_along(path, t, less)
    assert known.solved.all()
    assert laws.solved.all()
    np.testing.assert_allclose(laws.objective, known.objective, rtol=1e-12)


@pytest.mark.sample(2)
@pytest.mark.parametrize("degree", [5, 9, pytest.param(19, marks=pytest.mark.long)])
def test_laws_where_the_structure_changes_and_beside_it_are_those_solved_alone(degree: int) -> None:
    edges = np.array(changes(path_of(degree)))
    beside = np.concatenate([edges + away for away in (-1e-5, 1e-5)])
    at = np.concatenate([edges + away for away in (-1e-9, 0.0, 1e-9)])
    t = np.unique(np.concatenate([np.linspace(0.0, 1.0, 150), beside, at]))
    laws = synthesize_array(ProblemArray(B=ENDS[0] + (ENDS[1] - ENDS[0]) * t, order=4, basis=Chebyshev(degree)))
    assert (laws.status == "optimal").all()
    check(laws, np.flatnonzero(np.isin(t, beside)))
    # where both structures are those of the law but for rounding, its value alone is settled
    for place in np.flatnonzero(np.isin(t, edges)).tolist():
        assert laws.objective[place] == pytest.approx(synthesize(laws.problems.problem(place)).objective, rel=1e-9)


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


@pytest.mark.filterwarnings("ignore::optlaws.NotNormalised")
def test_laws_with_less_and_less_residual_are_on_one_path_although_each_limit_is_a_unit() -> None:
    limits = np.linspace(0.2, 0.05, 40)
    problems = [Problem(B=1.8, order=4, bounds={residual_vibration(frequency=20): at_most(most)}) for most in limits]
    path = between(problems[0], problems[-1])
    assert path is not None
    assert laws_along(path, np.linspace(0.0, 1.0, len(problems))).solved.all()


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
    # of the first doubles prove 1.03e-9, hardly too little
    assert set(laws.others) <= {0}
    for place in (0, 1, 40):
        alone, one = synthesize(laws.problems.problem(place)), laws.result(place)
        assert isinstance(one, Solution)
        assert one.objective == pytest.approx(alone.objective, rel=1e-9)
        assert one.status is alone.status
        # the bounds of arrays are in doubles, those of certificates exact
        assert one.lower_bound <= one.certificate.bound
        assert one.certificate.bound >= one.objective * (1.0 - 1e-10)


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


# --- least power ---


FEWER = 60


def check_power(laws: SolutionArray, places: list[int]) -> None:
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


KINDS_OF_POWER: dict[str, dict[str, Any]] = {
    "B": {},
    "B of order 2, degree 5": {"order": 2, "basis": Chebyshev(5)},
    "B, no return": {"B": np.linspace(1.5, 2.5, FEWER), "monotone": True, "basis": Chebyshev(7)},
    "B, unsymmetric": {"B": np.linspace(1.6, 2.2, FEWER), "symmetric": False, "order": 3, "basis": Chebyshev(5)},
    "most C": {"B": 1.7, "C": (None, np.linspace(5.0, 5.9, FEWER))},
    "most C, any B": {"B": None, "C": (None, np.linspace(4.9, 5.6, FEWER)), "basis": Chebyshev(7)},
    "weights": {"B": 1.7, "minimise": map_arrays("{:.17g}*D".format, np.linspace(0.5, 2.0, FEWER))},
}


@pytest.mark.sample(6)
@pytest.mark.parametrize("kind", KINDS_OF_POWER)
@pytest.mark.filterwarnings("ignore::optlaws.NotNormalised")
def test_laws_of_least_power_are_those_solved_alone(kind: str) -> None:
    entries = {"B": np.linspace(*ENDS, FEWER), "order": 4, "basis": Chebyshev(9), "minimise": "D"} | KINDS_OF_POWER[
        kind
    ]
    laws = synthesize_array(ProblemArray(**entries))
    assert (laws.status == "local").all()
    assert not laws.others
    check_power(laws, [2, 31, 58])


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


def path_of_power(degree: int) -> Path:
    problem = Problem(order=4, basis=Chebyshev(degree), B=ENDS[0], minimise="D")
    path = between(problem, replace(problem, B=ENDS[1]))
    assert path is not None
    return path


@pytest.mark.long
def test_laws_of_least_power_where_their_structure_changes() -> None:
    path = path_of_power(9)
    edges = np.array(changes(path))
    assert len(edges) == 4
    beside = np.concatenate([edges + away for away in (-1e-6, 0.0, 1e-6)])
    t = np.sort(np.concatenate([np.linspace(0.0, 1.0, 40), beside]))
    laws = laws_along(path, t)
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
    path = path_of_power(5)
    segments = segments_along(path, between_places())
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


# --- formulas that are not affine in the law ---


FORMULAS = (
    "integral(c^2 + (1 + k)*b^2)",
    "rms(c^2 + b^2)",
    "peak(c^2 + 9*b^2)",
    "peak(norm(c, 3*b))",
    "peak(exp(c/5), side=high)",
    "peak(c^2 + k*b^2, start=0.1, stop=0.7)",
)


@pytest.mark.parametrize("text", sampled(FORMULAS, 3))
def test_many_laws_of_a_formula_are_those_of_each_alone(text: str) -> None:
    asked = ProblemArray(B=np.linspace(1.65, 1.85, 140), order=4, basis=Chebyshev(5), minimise=text)
    laws = synthesize_array(asked)
    assert [len(part.places) for part in laws.parts] == [140]  # all by the walk, none alone
    assert float(laws.gap.max()) < 1e-10
    for place in (0, 77, 139):
        alone = synthesize(asked.problem(place))
        assert laws.objective[place] == pytest.approx(alone.objective, rel=1e-10)


@pytest.mark.parametrize("text", FORMULAS)
def test_planes_touch_and_second_derivatives_are_differences_of_slopes(text: str) -> None:
    program = model_of(Problem(B=1.8, order=4, basis=Chebyshev(5), minimise=text)).program
    [family] = [one for one in program.families if isinstance(one, FormulaFamily)][:1]
    assert family.continuable
    numbers = np.random.default_rng(1)
    x = numbers.normal(size=(3, program.size)) * 0.3
    u = np.tile(np.mean(family.domain) + np.array([0.0, 0.1]), (3, 1))
    value, slope, bend = family.planes(u, np.column_stack([x, np.ones(3)]))
    weights = np.array([[1.0, 0.5]] * 3)
    hessian = family.hessians(u, np.column_stack([x, np.ones(3)]), weights)
    for law in range(3):
        jet = family.jet(x[law], u[law], np.ones(2))
        room = family.right_side(x[law])
        point = np.append(x[law], 1.0)
        assert value[law] @ point - room == pytest.approx(jet.value, rel=1e-9, abs=1e-9)
        assert value[law][:, :-1] - family.slack == pytest.approx(jet.gradient, rel=1e-9, abs=1e-9)
        assert slope[law] @ point == pytest.approx(jet.slope, rel=1e-9, abs=1e-7)
        assert slope[law][:, :-1] == pytest.approx(jet.slope_gradient, rel=1e-9, abs=1e-7)
        assert bend[law] == pytest.approx(jet.curvature, rel=1e-9, abs=1e-6)
        own = family.hessian(x[law], u[law], weights[law])
        assert own is not None
        assert hessian[law] == pytest.approx(own, rel=1e-9, abs=1e-9)


def test_kinks_over_k_are_left_to_each_law_alone() -> None:
    first, last = (
        Problem(B=B, order=4, basis=Chebyshev(3), minimise="peak(c + table(k, 0:0, 0.5:1, 1:0)*b)")
        for B in (1.75, 1.85)
    )
    assert between(first, last) is None
