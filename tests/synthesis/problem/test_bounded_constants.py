"""Bounds of any constant: kept by the law, proven, found again by HiGHS; a given ratio of the two accelerations."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest

from optlaws import (
    FUNCTIONALS,
    BSplines,
    C_minus,
    C_plus,
    Certificate,
    Chebyshev,
    Functional,
    InfeasibleProblem,
    InputError,
    Problem,
    at_least,
    at_most,
    between,
    rms_c,
    snap,
    synthesize,
)
from tests.internals.synthesis import Bounds, read_bounds
from tests.synthesis.grids import polynomials
from tests.synthesis.judge import Judged

BOUNDED: list[dict[str, Any]] = [
    {"B": 1.8, "bounds": {"rms_c": at_most(3.82)}},
    {"B": 1.8, "bounds": {"snap": at_most(900)}},
    {"B": 1.8, "bounds": {"rms_j": at_most(28.5)}, "minimise": "rms_c"},
    {"B": 1.8, "bounds": {"rms_c": at_most(4.2), "snap": at_most(5000)}, "minimise": "J"},
    {"symmetric": False, "bounds": {"C_minus": at_most(4)}, "minimise": "C_plus", "order": 3},
    {"symmetric": False, "bounds": {"C_minus": at_most(6), "C_plus": at_most(4)}, "minimise": "J", "order": 2},
    {"B": 1.8, "bounds": {"rms_c": at_most(4)}, "basis": BSplines(8, 3), "order": 3},
]


def problem(**given: Any) -> Problem:
    return Problem(**{"order": 4, "basis": Chebyshev(9), **given})


@pytest.mark.sample(3)
@pytest.mark.parametrize("given", BOUNDED, ids=str)
def test_bounds_hold_and_the_optimum_is_proven(given: dict[str, Any]) -> None:
    one = problem(**given)
    solution = synthesize(one)
    assert solution.status == "optimal"
    free = synthesize(replace(one, bounds={}))
    assert solution.objective >= free.objective * (1 - 1e-11)
    binding = False
    for constant, asked in one.bounds.items():
        value = constant.value(solution.law)
        assert value <= asked.high * (1 + 1e-9)
        binding |= value > asked.high * (1 - 1e-9)
    assert binding == (solution.objective > free.objective * (1 + 1e-9))
    assert Problem.from_dict(one.to_dict()) == one
    assert hash(Problem.from_dict(one.to_dict())) == hash(one)
    assert Certificate.from_dict(solution.certificate.to_dict()).bound == solution.certificate.bound


@pytest.mark.parametrize(("low", "degree"), [(4.0, 9), (3.5, 11)])
def test_highs_agrees_on_one_sided_bounds(low: float, degree: int) -> None:
    solution = synthesize(
        Problem(order=3, basis=Chebyshev(degree), symmetric=False, minimise="C_plus", bounds={"C_minus": at_most(low)})
    )
    motion = polynomials(3, degree)
    expected = motion.least([(motion.rows(2), None), (-motion.rows(2), low)])
    assert expected is not None
    assert solution.objective == pytest.approx(expected, rel=2e-5)
    assert solution.objective >= expected * (1 - 1e-9)


@pytest.mark.parametrize("high", [900.0, 2000.0])
def test_highs_agrees_on_a_bounded_snap(high: float) -> None:
    solution = synthesize(problem(order=3, minimise="C", bounds={snap: at_most(high)}))
    motion = polynomials(3, 9)
    c, fourth = motion.rows(2), motion.rows(4)
    expected = motion.least([(c, None), (-c, None), (fourth, high), (-fourth, high)])
    assert expected is not None
    assert solution.objective == pytest.approx(expected, rel=2e-5)
    assert solution.objective >= expected * (1 - 1e-9)


def test_a_law_that_cannot_be_is_refused_with_proof() -> None:
    with pytest.raises(InfeasibleProblem, match=r"rms_c <= 3\.7") as caught:
        synthesize(problem(B=1.8, bounds={"rms_c": at_most(3.7)}))
    assert isinstance(caught.value.proof, Certificate)
    assert caught.value.proof.proves_infeasible


def test_a_constant_can_be_held_up() -> None:
    solution = synthesize(problem(B=1.7, bounds={"rms_c": between(4.0, 4.2)}))
    assert Judged(solution.law).constant("rms_c") == pytest.approx(4.0, rel=1e-9)
    assert solution.status == "local"


def test_constants_of_ones_own_are_bounded_too() -> None:
    @dataclass(frozen=True, repr=False)
    class Snap(Functional):
        """Peak of the fourth derivative."""

        def value(self, law: Any) -> float:
            return float(law.peak(4).value)

        def families(self, space: Any, slack: Any, bound: float) -> Any:
            return (space.derivative(4, self.name, slack, bound),)

    own_snap = Snap("own_snap", np.nan, convex=True)
    own, known = (synthesize(problem(B=1.8, bounds={one: at_most(2000)})) for one in (own_snap, snap))
    assert own.objective == pytest.approx(known.objective, rel=1e-11)
    assert own.status == known.status == "optimal"
    assert "{own_snap: at_most(2000)}" in repr(own.problem)


@pytest.mark.sample(3)
@pytest.mark.parametrize("ratio", [0.5, 1.5, 2.0, 3.0])
def test_a_given_ratio_of_decelerations_is_met_by_the_best_law(ratio: float) -> None:
    asked = Problem(order=3, symmetric=False, minimise=f"max(C_plus, C_minus/{ratio})")
    solution = synthesize(asked)
    assert solution.status == "optimal"
    assert C_minus.value(solution.law) / C_plus.value(solution.law) == pytest.approx(ratio, rel=1e-9)
    # the same law bounds one side by the other
    motion = polynomials(3, 9)
    expected = motion.least([(motion.rows(2), None), (-motion.rows(2), ratio * solution.objective)])
    assert expected == pytest.approx(solution.objective, rel=2e-5)
    below = motion.least([(motion.rows(2), None), (-motion.rows(2), ratio * solution.objective * (1 - 1e-3))])
    assert below is not None
    assert below > solution.objective


def test_with_a_ratio_something_else_can_be_least() -> None:
    least = synthesize(Problem(order=3, symmetric=False, minimise="max(C_plus, C_minus/2)")).objective
    p = 1.1 * least
    gentle = synthesize(
        Problem(order=3, symmetric=False, minimise="J", bounds={C_plus: at_most(p), C_minus: at_most(2 * p)})
    )
    assert gentle.status == "optimal"
    assert C_minus.value(gentle.law) / C_plus.value(gentle.law) == pytest.approx(2.0, rel=1e-9)


def test_b_c_d_and_j_have_entries_of_their_own() -> None:
    assert problem(bounds={"C": at_most(6), "rms": 4.0}) == problem(C=at_most(6), bounds={rms_c: 4.0})
    with pytest.raises(InputError, match="given twice"):
        problem(C=5.0, bounds={"C": 6.0})


@pytest.mark.parametrize(
    ("bounds", "text"),
    [
        ({"rms_q": 3}, "did you mean"),
        ({3: 3}, "bounds are of constants"),
        ([("rms_c", 3)], "must be a dict"),
        ({"rms": 3, "rms_c": 4}, "twice"),
        ({"rms_c": "4"}, "finite number"),
        ({"rms_c": 0}, "excludes every law: it must be above 0"),
        ({"rms_c": -1}, "at least 0"),
    ],
)
def test_bounds_that_make_no_sense_are_refused(bounds: Any, text: str) -> None:
    with pytest.raises(InputError, match=text):
        problem(bounds=bounds)


def test_bounds_are_values() -> None:
    bounds = Bounds({"rms_c": at_most(4), "snap": at_least(3), "J": None})
    assert dict(bounds) == {rms_c: at_most(4), FUNCTIONALS["snap"]: at_least(3)}
    assert bounds["rms_c"] == bounds[rms_c] == at_most(4)
    assert bounds == Bounds({snap: at_least(3), rms_c: at_most(4)})
    assert Bounds(eval(repr(bounds), {"at_most": at_most, "at_least": at_least})) == bounds  # noqa: S307 - a repr of our own


def test_bounds_are_read_from_text() -> None:
    assert read_bounds(["rms_c = 4"], ["rms_c=3", "snap=9"]) == {"rms_c": between(3, 4), "snap": at_least(9)}
    for wrong in ("rms_c", "rms_c=", "rms_c=4=5", "=4x"):
        with pytest.raises(InputError, match="such as rms_c=4"):
            read_bounds([wrong])
    with pytest.raises(InputError, match="twice"):
        read_bounds(["rms_c=4", "rms_c=5"])
