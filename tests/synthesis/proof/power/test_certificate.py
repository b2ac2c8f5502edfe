"""Tight bounds of problems with D in them: proofs checked by other means, false ones refused, better laws found."""

from dataclasses import replace
from itertools import pairwise
from math import inf, isfinite

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from optlaws import (
    BoundaryConditions,
    Certificate,
    Chebyshev,
    Contact,
    InfeasibleProblem,
    InputError,
    Leaf,
    Problem,
    Solution,
    Split,
    at_most,
    between,
    synthesize,
)
from tests.internals.synthesis import Anchors, Box, PowerRows, RowName, model_of, searched, velocity_brackets
from tests.sampling import examples

FIRST = Problem(B=1.641, order=4, basis=Chebyshev(9), minimise="D")
MIXED = Problem(order=4, basis=Chebyshev(5), minimise="0.6*C/4 + 0.4*D/2.25")
TURNING = Problem(order=4, symmetric=False, minimise="D", boundary=BoundaryConditions((0, 0.5, 0, 0), (1, 0.2, 0, 0)))


@pytest.fixture(scope="module")
def first() -> Solution:
    return synthesize(FIRST, bound="tight")


def certificate(solution: Solution) -> Certificate:
    power_certificate = solution.power_certificate
    assert power_certificate is not None
    return power_certificate


@pytest.mark.sample(4)
@pytest.mark.parametrize("degree", [3, 9])
@pytest.mark.parametrize("B", [1.53, 2.297])
def test_least_power_is_proven_optimal(B: float, degree: int) -> None:
    problem = replace(FIRST, B=B, basis=Chebyshev(degree))
    quick, tight = synthesize(problem), synthesize(problem, bound="tight")
    assert quick.status.value == "local"
    assert tight.status.value == "optimal"
    assert tight.objective == pytest.approx(quick.objective, rel=1e-12)
    assert tight.lower_bound == certificate(tight).bound >= tight.objective * (1 - 1e-8)
    assert tight.lower_bound <= tight.objective


@pytest.mark.sample(6)
@pytest.mark.parametrize(
    "problem",
    [
        MIXED,
        replace(MIXED, minimise="max(C/4, D/2.25)", B=1.641),
        replace(MIXED, minimise="rms_c + D", B=1.641),
        replace(FIRST, basis=Chebyshev(5), minimise="C", D=4.0, B=None),
        replace(FIRST, basis=Chebyshev(5), B=between(1.5, 1.8), J=at_most(90)),
        replace(FIRST, basis=Chebyshev(5), B=2.5, monotone=True),
        pytest.param(replace(FIRST, symmetric=False), marks=pytest.mark.long),
        TURNING,
    ],
    ids=str,
)
def test_other_problems_with_power_are_proven_optimal(problem: Problem) -> None:
    solution = synthesize(problem, bound="tight")
    assert solution.status.value == "optimal"
    assert solution.gap < 1e-8


@pytest.mark.long
def test_a_degree_of_many_coordinates_still_gets_a_narrow_bound() -> None:
    solution = synthesize(replace(FIRST, basis=Chebyshev(25)), bound="tight")
    assert solution.gap < 0.011 < synthesize(solution.problem).gap


def test_quick_solutions_and_convex_ones_have_no_power_certificate() -> None:
    assert synthesize(FIRST).power_certificate is None
    convex = synthesize(replace(FIRST, minimise="C"), bound="tight")
    assert convex.power_certificate is None
    assert convex.to_dict()["power_certificate"] is None


@pytest.mark.parametrize("factor", [1 + 1e-7, 1.01, 2.0])
def test_no_claim_above_a_law_is_proven(first: Solution, factor: float) -> None:
    proof = certificate(first)
    assert replace(proof, claim=first.objective * factor).bound == -inf


def test_a_proof_that_is_cut_short_or_goes_on_proves_nothing(first: Solution) -> None:
    proof = certificate(first)
    last = proof.tree[-1]
    assert not replace(proof, tree=proof.tree[:-1]).proven
    assert not replace(proof, tree=(*proof.tree, last)).proven
    assert not replace(proof, tree=()).proven
    assert not replace(proof, tree=(Split(0, 1.0), *proof.tree)).proven, "two boxes are left, one is emptied"


def test_every_multiplier_counts_as_it_is_or_as_zero(first: Solution) -> None:
    proof = certificate(first)
    wrong = replace(last_step(proof), contacts=tuple(replace(c, multiplier=-1.0) for c in last_step(proof).contacts))
    assert not replace(proof, tree=(*proof.tree[:-1], wrong)).proven
    unknown = replace(last_step(proof), contacts=tuple(replace(c, constraint="J") for c in last_step(proof).contacts))
    assert not replace(proof, tree=(*proof.tree[:-1], unknown)).proven


def last_step(proof: Certificate) -> Leaf:
    last = proof.tree[-1]
    assert isinstance(last, Leaf)
    return last


@pytest.mark.parametrize("points", [(), (0.1, 0.2), (0.1, 0.1, 0.2, 0.3, 0.5), (0.0, 0.1, 0.2, 0.3, 0.5)])
def test_points_that_do_not_determine_the_law_prove_nothing(first: Solution, points: tuple[float, ...]) -> None:
    assert replace(certificate(first), points=points).bound == -inf


def test_a_proof_of_another_problem_proves_nothing_here(first: Solution) -> None:
    proof = certificate(first)
    for other in (replace(FIRST, B=1.6), replace(FIRST, B=None), replace(FIRST, minimise="C")):
        assert replace(proof, problem=other).bound == -inf
    assert replace(proof, problem=replace(FIRST, monotone=True)).bound == first.lower_bound, "fewer laws"


@pytest.mark.parametrize(
    "broken",
    [
        {"claim": -1.0},
        {"claim": float("nan")},
        {"points": [2.0]},
        {"steps": [{"variable": 0}]},
        {"steps": [{"variable": 0, "at": inf}]},
        {"steps": [{"variable": 0, "side": 0, "contacts": [], "equations": [], "claim": 0.0}]},
        {"steps": [{"variable": 0, "side": 1, "contacts": [], "equations": [], "claim": 0.0, "at": 0.5}]},
        {"problem": {"order": 0}},
    ],
)
def test_broken_proofs_are_refused(first: Solution, broken: dict[str, object]) -> None:
    with pytest.raises(InputError):
        Certificate.from_dict(certificate(first).to_dict() | broken)


def test_peaks_of_one_sign_that_may_be_negative_are_left_alone() -> None:
    braking = BoundaryConditions((0.0, 1.5), (1.0, 0.5))
    problem = Problem(symmetric=False, boundary=braking, basis=Chebyshev(5), minimise="D/2.25 + C_plus/4")
    solution = synthesize(problem, bound="tight")
    assert solution.power_certificate is None
    assert solution.lower_bound <= solution.objective


def test_an_unknown_bound_is_refused() -> None:
    with pytest.raises(InputError, match="did you mean 'tight'"):
        synthesize(FIRST, bound="tigth")  # type: ignore[arg-type] # the wrong one is the point


def test_the_search_comes_upon_a_better_law_than_it_was_given(first: Solution) -> None:
    poor = synthesize(replace(FIRST, minimise="C"))
    seen: list[float] = []

    def explore(x: np.ndarray) -> bool:
        seen.append(model_of(FIRST).space.law(x[:5]).power_peak().value)
        return False

    x = np.append(poor.active_set.x[:5], poor.law.power_peak().value)
    search = searched(FIRST, first.objective * 1.05, x, 120, explore)
    assert search.certificate is None
    assert min(seen) < first.objective * 1.05 < poor.law.power_peak().value


@given(seed=st.integers(0, 10**6))
@examples(30)
def test_laws_in_a_box_obey_its_rows(seed: int) -> None:
    random = np.random.default_rng(seed)
    space = model_of(MIXED).space
    law = space.law(random.normal(size=space.terms) * random.choice([0.1, 0.5, 2.0]))
    C, D = law.peak(2).value, law.power_peak().value
    problem = replace(MIXED, minimise="C + D")
    rows = PowerRows(problem, (C + D) * 1.1, (0.15, 0.3, 0.5))
    at = np.array([*law.b(rows.points), *([C, D] if rows.place == 4 else [D, C])])
    root = rows.root()
    assert np.all(root.low <= at + 1e-12)
    assert np.all(at <= root.high + 1e-12)
    low, high = (at + random.random(5) * (end - at) * random.random() for end in (root.low, root.high))
    box = Box(np.minimum(low, at), np.maximum(high, at))
    k = random.random(20) / 2
    contacts = [
        Contact(name, s, one, 1.0)
        for name in (RowName.POWER, RowName.POWER_FROM_LEAST, "C")
        for s in (1.0, -1.0)
        for one in k
    ]
    assert (rows.of_contacts(contacts, box) @ np.append(at, 1.0)).max() <= 1e-9 * (1 + C)
    assert abs(rows.derivative(1, k) @ np.append(at, 1.0) - law.b(k)).max() < 1e-10
    least, greatest = rows.brackets(box, k, rows.derivative(1, k))
    assert np.all(least <= law.b(k) + 1e-10)
    assert np.all(law.b(k) <= greatest + 1e-10)


@given(seed=st.integers(0, 10**6))
@examples(30)
def test_velocities_known_at_some_k_bracket_those_at_others(seed: int) -> None:
    random = np.random.default_rng(seed)
    law = model_of(MIXED).space.law(random.normal(size=3))
    D = law.power_peak().value
    at = random.random(3)
    anchors = Anchors(at, law.b(at) - random.random(3), law.b(at) + random.random(3))
    k = np.linspace(0, 1, 101)
    low, high = velocity_brackets(anchors, D, k)
    assert np.all(low <= law.b(k) + 1e-12)
    assert np.all(law.b(k) <= high + 1e-12)


def test_brackets_are_those_of_constant_power() -> None:
    # from velocity 1 back to rest and beyond: b |b| falls by 2 D k
    anchors = Anchors(np.zeros(1), np.ones(1), np.ones(1))
    low, high = velocity_brackets(anchors, 2.0, np.array([0.0, 0.25, 0.5]))
    assert low.tolist() == [1.0, 0.0, -1.0]
    assert high == pytest.approx(np.sqrt([1, 2, 3]))


@pytest.mark.long
def test_the_bound_of_fewer_conditions_is_no_higher() -> None:
    chain = [
        synthesize(replace(MIXED, B=B, minimise="D", basis=Chebyshev(3)), bound="tight").lower_bound
        for B in (None, between(1.4, 1.8), 1.641)
    ]
    assert all(one <= other * (1 + 1e-8) for one, other in pairwise(chain))
    assert all(map(isfinite, chain))


@pytest.mark.long
@pytest.mark.parametrize("minimise", ["C", "J"])
def test_a_power_below_the_least_is_refused_with_proof(minimise: str, first: Solution) -> None:
    least = first.objective
    assert (
        synthesize(replace(FIRST, minimise=minimise, D=at_most(least * 1.001))).law.constants.D.value <= least * 1.002
    )
    with pytest.raises(InfeasibleProblem, match=r"D is at least 3\.45827") as refused:
        synthesize(replace(FIRST, minimise=minimise, D=at_most(least * 0.99)))
    assert isinstance(refused.value.proof, Certificate)
    assert refused.value.proof.bound > least * 0.99
