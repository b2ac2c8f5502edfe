"""Bounds and windows: kept by the law on the whole interval, proven, found again by HiGHS."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

from optlaws import (
    FUNCTIONALS,
    C_minus,
    C_plus,
    Chebyshev,
    Functional,
    InputError,
    Pieces,
    Problem,
    Window,
    at_least,
    at_most,
    between,
    rms_c,
    snap,
    synthesize,
    via,
)
from tests.internals.synthesis import Bounds, read_bounds
from tests.synthesis.judge import judge
from tests.synthesis.reference import least


def problem(**given: Any) -> Problem:
    return Problem(**{"order": 4, "basis": Chebyshev(9), **given})


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
    bounded = Problem(order=3, symmetric=False, minimise=C_plus, bounds={C_minus: at_most(ratio * solution.objective)})
    assert least(bounded) == pytest.approx(solution.objective, rel=1e-8)


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


# --- windows ---


CASES = [
    Problem(B=1.7, order=3, windows=(via("a", 0.08, at=0.2),)),
    Problem(B=1.7, order=3, windows=(via("a", 0.92, at=0.8),)),
    Problem(B=1.8, order=3, windows=(Window("b", high=1.0, start=0.2, stop=0.3),), basis=Chebyshev(15)),
    Problem(B=1.8, order=3, windows=(Window("b", high=1.0, start=0.7, stop=0.8),), basis=Chebyshev(15)),
    Problem(B=1.8, order=2, windows=(Window("j", low=-20, high=20, start=0, stop=0),), basis=Chebyshev(15)),
    Problem(B=1.9, order=3, windows=(Window("a", low=0.2, high=0.8, start=0.3, stop=0.7),), basis=Chebyshev(11)),
    Problem(order=3, symmetric=False, windows=(via("a", 0.3, at=0.3), via("c", 0, at=0.4)), basis=Chebyshev(11)),
    Problem(order=3, minimise="J", symmetric=False, windows=(Window("c", high=5, start=0, stop=0.2),)),
    Problem(order=3, minimise="D", symmetric=False, windows=(via("a", 0.25, at=0.3),)),
    Problem(B=1.8, order=3, windows=(via("b", 0.9, at=0.2),), basis=Pieces(16, degree=3, continuity=2)),
    Problem(
        order=3,
        symmetric=False,
        windows=(Window("a", high=0.2, start=0.0, stop=0.4), Window("a", low=0.75, start=0.6)),
        basis=Chebyshev(15),
    ),
    Problem(B=1.8, order=3, windows=(Window("j", -60, 60, 0, 0), Window("j", -90, 90, 1, 1)), basis=Chebyshev(15)),
]


@pytest.mark.sample(3)
@pytest.mark.parametrize("problem", CASES, ids=range(len(CASES)))
def test_windows_hold_on_the_whole_of_their_interval(problem: Problem) -> None:
    judge(synthesize(problem))


def test_a_window_and_its_mirror_image_ask_the_same_of_a_symmetric_law() -> None:
    first, second = (synthesize(CASES[i]) for i in (0, 1))
    assert first.objective == pytest.approx(second.objective, rel=1e-11)
    third, fourth = (synthesize(CASES[i]) for i in (2, 3))
    assert third.objective == pytest.approx(fourth.objective, rel=1e-11)


@pytest.mark.parametrize("quantity", "abcj")
def test_mirroring_twice_changes_nothing(quantity: str) -> None:
    window = Window(quantity, -0.25, 0.5, 0.125, 0.375)
    assert window.mirrored().mirrored() == window
    assert window.first_half() == (window,)
    assert all(part.stop <= 0.5 for part in Window(quantity, -0.25, 0.5, 0.25, 0.875).first_half())


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        (("e", 0.0, 1.0), "unknown quantity"),
        (("a", 1.0, 0.0), "low <= high"),
        (("a",), "finite"),
        (("a", 0.0, 1.0, 0.6, 0.4), "start <= stop"),
        (("a", 0.0, 1.0, -0.1, 0.4), "0 <= start"),
        (("a", float("nan"), 1.0), "low must be a finite real number"),
        (("a", "0", 1.0), "low must be a finite real number"),
        (("a", True, 1.0), "low must be a finite real number"),
    ],
)
def test_windows_that_make_no_sense_are_refused(arguments: tuple[object, ...], text: str) -> None:
    with pytest.raises(InputError, match=text):
        Window(*arguments)  # type: ignore[arg-type] # that is the point


def test_other_windows_are_refused() -> None:
    with pytest.raises(InputError, match="Window values"):
        Problem(B=1.7, order=3, windows=((0.2, 0.3),))  # type: ignore[arg-type]
    with pytest.raises(InputError, match="did you mean 'start'"):
        Window.from_dict({"quantity": "a", "low": 0.1, "strat": 0.2})
    assert Window.from_dict({"quantity": "c", "value": 0, "at": 0.4}) == via("c", 0, at=0.4)


def test_jerk_at_the_ends_is_limited_at_both_ends_of_a_symmetric_law() -> None:
    free = synthesize(Problem(B=1.8, order=3, basis=Chebyshev(15)))
    ends = synthesize(Problem(B=1.8, order=3, basis=Chebyshev(15), windows=(Window("j", -60, 60, 0, 0),)))
    assert abs(free.law.j(0.0)) > 300
    assert ends.status == "optimal"
    assert max(abs(ends.law.j(0.0)), abs(ends.law.j(1.0))) == pytest.approx(60.0, rel=1e-9)
    assert ends.objective > free.objective


@pytest.mark.parametrize(
    ("place", "more"),
    [
        (0.12, {"minimise": "rms_j"}),
        (0.3, {"minimise": "J", "basis": Chebyshev(9)}),
        (0.2, {"minimise": "rms_c", "symmetric": False, "inflexion": 0.45}),
    ],
)
def test_the_peak_acceleration_is_where_it_is_asked(place: float, more: dict[str, Any]) -> None:
    peak = (via("c", 6.0, at=place), via("j", 0.0, at=place))
    asked: dict[str, Any] = {"B": 1.8, "C": at_most(6.0), "order": 3, "basis": Chebyshev(11), "windows": peak}
    solution = synthesize(Problem(**(asked | more)))
    assert solution.status == "optimal"
    highest = solution.law.extrema(2)[1]
    assert highest.value == pytest.approx(6.0, abs=1e-9)
    assert highest.k == pytest.approx(place, abs=1e-9)
    assert solution.law.peak(2).value <= 6.0 + 1e-9
    assert solution.constants.B.value == pytest.approx(1.8, abs=1e-8)
    assert solution.law.peak(1).k == pytest.approx(more.get("inflexion", 0.5), abs=1e-6)
