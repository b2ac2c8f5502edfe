"""What a problem says of the peak velocity: bounds from above are of the whole velocity, an inflexion places it."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from optlaws import (
    BoundaryConditions,
    BSplines,
    C_minus,
    C_plus,
    Chebyshev,
    InputError,
    Pieces,
    PolynomialLaw,
    Problem,
    at_least,
    at_most,
    between,
    synthesize,
)
from optlaws.verification import verify
from tests.internals.synthesis import evaluate
from tests.synthesis.judge import judge

K = np.linspace(0.0, 1.0, 4001)
# --- an inflexion says where b is greatest, be it above 0 or not ---
ENDS = [
    ((0.0, -1.0), (0.0, 1.0)),
    ((0.0, 1.0), (0.0, 0.0)),
    ((0.0, 0.0), (-1.0, 0.0)),
    ((0.0, 0.0, 0.0), (0.0, 0.5, 0.0)),
    ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0)),
    ((0.0, -2.0, 0.0), (-2.0, -1.5, 0.0)),
]


@pytest.mark.sample(12)
@pytest.mark.parametrize("minimise", ["C", "rms_c", "J", "max(C_plus, C_minus/2)"])
@pytest.mark.parametrize("ends", ENDS, ids=str)
def test_b_is_greatest_at_the_inflexion_whatever_its_sign(ends: Any, minimise: str) -> None:
    for inflexion in (0.36, 0.7):
        problem = Problem(
            boundary=BoundaryConditions(*ends),
            symmetric=False,
            inflexion=inflexion,
            minimise=minimise,
            basis=Chebyshev(7),
        )
        solution = synthesize(problem)
        assert solution.status == "optimal"
        assert solution.law.b(inflexion) >= solution.law.extrema(1)[1].value - 1e-9
        assert abs(solution.law.c(inflexion)) < 1e-8
        if solution.objective < 1e-12 or "plus" in minimise:
            continue
        proof = verify(solution.to_dict())
        assert proof.proven, [str(claim) for claim in proof.claims if not claim.proven]


@pytest.mark.parametrize("beside", [-1e-12, -1e-14, -(2.0**-54), 2.0**-53, 1e-13])
def test_a_peak_beside_a_break_by_rounding_is_at_the_break(beside: float) -> None:
    """Between them a velocity is below its peak by rounding alone, which no row may be divided by."""
    at_break = Problem(order=3, basis=Pieces((0.0, 0.3, 0.5, 1.0)), minimise="C", B=1.9, symmetric=False, inflexion=0.5)
    assert synthesize(at_break).status == "optimal"
    assert replace(at_break, inflexion=0.5 + beside) == at_break
    assert replace(at_break, inflexion=0.5 + 1e-9) != at_break


def test_a_law_that_is_faster_elsewhere_breaks_an_inflexion_with_a_peak_below_zero() -> None:
    ends = BoundaryConditions((0.0, -1.0), (-1.0, -1.0))
    even = Problem(boundary=ends, symmetric=False, minimise="rms_c")
    uniform = synthesize(even).law
    assert evaluate(replace(even, inflexion=0.3), uniform).excess < 1e-9  # b is -1 everywhere
    slower = synthesize(replace(even, inflexion=0.7, B=None, bounds={"J": between(50, 60)})).law
    assert slower.b(0.7) < 0.0
    assert evaluate(replace(even, inflexion=0.3), slower).excess > 1e-3


def test_the_b_that_an_inflexion_has_is_asked_of_it() -> None:
    ends = BoundaryConditions((0.0, -1.0), (0.0, 1.0))
    for B in (1.5, between(1.3, 1.6), at_least(1.4)):
        solution = synthesize(Problem(boundary=ends, symmetric=False, inflexion=0.4, B=B))
        at_peak = float(solution.law.b(0.4))
        assert solution.status == "optimal"
        assert at_peak == pytest.approx(solution.constants.B.value, rel=1e-9)
        assert at_peak > 1.3 - 1e-9


def test_a_symmetric_law_may_be_asked_to_have_its_peak_in_the_middle() -> None:
    free = synthesize(Problem(C=at_most(5.5), minimise="B", order=4))
    middle = synthesize(replace(free.problem, inflexion=0.5))
    assert free.constants.B.k < 0.45
    assert middle.constants.B.k == pytest.approx(0.5)
    assert middle.objective > free.objective
    assert verify(middle.to_dict()).proven


# --- an upper bound of B asks |b| <= B and nothing else ---
KINDS: list[dict[str, Any]] = [
    {"order": 4, "minimise": "B", "C": at_most(5.5)},
    {"order": 4, "minimise": "C", "C": at_most(50.0)},
    {"order": 3, "minimise": "J"},
    {"order": 3, "minimise": "0.3*C + 0.02*J", "monotone": True},
    {"order": 3, "minimise": "rms_c", "basis": Pieces(6)},
    {"order": 3, "minimise": "C", "basis": BSplines(6, 3)},
    {"order": 3, "minimise": "max(C_plus, C_minus/2)", "symmetric": False},
    {"order": 2, "minimise": "C", "boundary": BoundaryConditions((0, 0), (1, 1)), "symmetric": False},
    {"order": 3, "minimise": "J", "inflexion": 0.4, "symmetric": False},
]


@pytest.mark.sample(6)
@pytest.mark.parametrize("kind", KINDS, ids=str)
def test_a_bound_of_b_that_does_not_bind_changes_nothing(kind: dict[str, Any]) -> None:
    free = synthesize(Problem(**kind))
    for vacuous in (at_most(10.0), between(0.5, 10.0), at_least(0.5)):
        bounded = synthesize(Problem(**kind, B=vacuous))
        assert bounded.objective == pytest.approx(free.objective, rel=1e-9)
        assert bounded.lower_bound <= free.objective
        assert bounded.status == free.status


@pytest.mark.sample(4)
@pytest.mark.parametrize("kind", KINDS[1:], ids=str)
def test_a_bound_of_b_that_binds_is_kept_by_its_whole_velocity(kind: dict[str, Any]) -> None:
    free = synthesize(Problem(**kind))
    most = 1.0 + 0.85 * (free.constants.B.value - 1.0)
    solution = synthesize(Problem(**kind, B=at_most(most)))
    assert solution.status == "optimal"
    assert np.abs(solution.law.b(K)).max() <= most * (1.0 + 1e-9)
    assert solution.objective >= free.objective * (1.0 - 1e-9)
    assert verify(solution.to_dict()).proven


RANGES = [None, at_most(1.7), at_least(1.75), between(1.3, 1.8), 1.65]


@pytest.mark.sample(12)
@pytest.mark.parametrize("B", RANGES, ids=repr)
@pytest.mark.parametrize("given", [{}, {"monotone": True}, {"symmetric": False}], ids=str)
def test_no_law_that_keeps_the_conditions_is_better_than_what_is_proven(B: Any, given: dict[str, Any]) -> None:
    problem = Problem(**{"B": B, "order": 3, "basis": Chebyshev(7), **given})
    best = synthesize(problem)
    # optima of other objectives keep the conditions, and so do their means, for these are convex
    others = [synthesize(replace(problem, minimise=one)).law for one in ("J", "rms_c", "rms_j", "C + 2*B")]
    generator = np.random.default_rng(7)
    expected = problem.range("B")
    for weights in generator.dirichlet(np.full(len(others) + 1, 0.4), 20):
        law = _mean([best.law, *others], weights)
        speed = np.abs(law.b(K)).max()
        assert expected is None or expected.low * (1.0 - 1e-6) <= speed <= expected.high * (1.0 + 1e-9)
        assert law.peak(2).value >= best.lower_bound


def _mean(laws: list[Any], weights: Any) -> PolynomialLaw:
    """The law from rest whose c is the weighted mean."""
    series = np.zeros(max(len(law.acceleration) for law in laws))
    for law, weight in zip(laws, weights, strict=True):
        series[: len(law.acceleration)] += weight * np.array(law.acceleration)
    return PolynomialLaw(series)


@pytest.mark.sample(3)
@pytest.mark.parametrize("low", [1.9, 2.2, 4.0])
def test_a_lower_bound_of_b_says_nothing_of_the_place(low: float) -> None:
    problem = Problem(order=2, minimise="J", B=at_least(low), symmetric=False)
    solution, middle = synthesize(problem), synthesize(replace(problem, inflexion=0.5))
    judge(solution)
    # the peak in the middle is the best one for symmetric laws only
    assert solution.objective < 0.95 * middle.objective
    peak = solution.constants.B
    assert np.abs(solution.law.b(K)).max() <= peak.value == pytest.approx(low, rel=1e-9)
    there = synthesize(replace(problem, inflexion=peak.k))
    assert there.status == "optimal"
    assert there.objective == pytest.approx(solution.objective, rel=1e-6)
    assert solution.best_possible is not None
    assert solution.best_possible <= solution.objective
    assert verify(solution.to_dict()).proven


@pytest.mark.sample(4)
@pytest.mark.parametrize("minimise", ["C", "J", "rms_c", "D"])
def test_a_lower_bound_of_b_is_met_no_worse_than_in_the_middle(minimise: str) -> None:
    for symmetric in (True, False):
        problem = Problem(order=3, minimise=minimise, B=between(2.1, 3.0), symmetric=symmetric)
        solution = synthesize(problem)
        judge(solution)
        assert solution.objective <= synthesize(replace(problem, inflexion=0.5)).objective * (1.0 + 1e-9)
        assert solution.status == "local"


# --- inflexions ---


CASES: list[dict[str, Any]] = [
    {"B": 1.8},
    {"B": 1.8, "monotone": True, "order": 4},
    {"B": between(1.6, 1.9)},
    {"B": 1.7, "minimise": "J"},
    {"B": 1.7, "minimise": "rms_c"},
    {"minimise": "C"},
    {"minimise": "max(C_plus, C_minus/2)"},
    {"boundary": BoundaryConditions((0, 0, 0), (1, 0.5, 0)), "B": 1.7},
    {"B": 1.8, "basis": BSplines(8, 3)},
    {"B": 1.8, "basis": Pieces(10, 5, 3)},
    {"B": 1.8, "basis": Pieces((0.0, 0.1, 0.2, 0.35, 0.6, 0.8, 1.0), 5, 3)},
]


def problem(**given: Any) -> Problem:
    order = {} if "boundary" in given else {"order": 3}
    return Problem(**{"basis": Chebyshev(11), "symmetric": False, "inflexion": 0.4, **order, **given})


@pytest.mark.sample(9)
@pytest.mark.parametrize("given", CASES, ids=str)
def test_the_peak_velocity_stands_at_the_inflexion(given: dict[str, Any]) -> None:
    asked = problem(**given)
    solution = synthesize(asked)
    law = solution.law
    assert solution.status == "optimal"
    assert law.c(0.4) == pytest.approx(0.0, abs=1e-9)
    highest = law.extrema(1)[1]
    assert highest.k == pytest.approx(0.4, abs=1e-6)
    assert law.b(0.4) >= highest.value * (1 - 1e-12)
    if isinstance(asked.B, float):
        assert law.b(0.4) == pytest.approx(asked.B, rel=1e-11)
    if asked.boundary is None:
        mirror = synthesize(problem(**{**given, "inflexion": 0.6, **_mirrored(given)}))
        assert mirror.objective == pytest.approx(solution.objective, rel=1e-9)
    assert solution.best_possible is None or solution.best_possible <= solution.objective


def _mirrored(given: dict[str, Any]) -> dict[str, Any]:
    if "C_minus" in str(given.get("minimise")):
        return {"minimise": "max(C_minus, C_plus/2)"}
    basis = given.get("basis")
    if isinstance(basis, Pieces):
        return {"basis": Pieces([1.0 - k for k in reversed(basis.breaks)], basis.degree, basis.continuity)}
    return {}


def test_in_the_middle_it_is_the_law_without_it() -> None:
    plain = synthesize(Problem(B=1.8, order=3))
    same = synthesize(Problem(B=1.8, order=3, symmetric=False, inflexion=0.5))
    assert same.objective == pytest.approx(plain.objective, rel=1e-10)
    assert same.best_possible == plain.best_possible
    assert Problem(B=1.8, order=3, inflexion=0.5) == Problem(B=1.8, order=3)


@pytest.mark.sample(2)
@pytest.mark.parametrize(("k", "B"), [(0.1, 1.5), (0.2, 1.8), (0.4, 1.7), (0.35, 2.4)])
def test_the_limit_of_uneven_laws_is_not_that_of_even_ones_and_holds(k: float, B: float) -> None:
    solution = synthesize(problem(B=B, inflexion=k, basis=Chebyshev(25)))
    assert solution.best_possible is not None
    assert solution.best_possible >= B / k * (1 - 1e-12)
    assert solution.best_possible <= solution.objective <= 1.25 * solution.best_possible


def test_a_ratio_and_an_inflexion_together() -> None:
    solution = synthesize(problem(minimise="max(C_plus, C_minus/1.5)"))
    assert C_minus.value(solution.law) / C_plus.value(solution.law) == pytest.approx(1.5, rel=1e-9)
    assert solution.law.c(0.4) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(
    ("given", "text"),
    [
        ({"inflexion": 1.4}, "between 0 and 1"),
        ({"inflexion": 0.0}, "between 0 and 1"),
        ({"inflexion": "0.4"}, "between 0 and 1"),
        ({"inflexion": True}, "between 0 and 1"),
        ({"symmetric": True}, "give symmetric=False"),
    ],
)
def test_inflexions_that_make_no_sense_are_refused(given: dict[str, Any], text: str) -> None:
    with pytest.raises(InputError, match=text):
        problem(B=1.7, **given)
