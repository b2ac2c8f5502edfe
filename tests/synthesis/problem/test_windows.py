"""Values and windows of a, b, c, j: kept on the whole interval, mirrored where symmetric, named in a contradiction."""

from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from optlaws import Chebyshev, InfeasibleProblem, InputError, Pieces, Problem, Window, at_most, synthesize, via
from tests.synthesis.grids import polynomials

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
    law = synthesize(problem).law
    for window in problem.windows:
        k = np.linspace(window.start, window.stop, 2001)
        values = law(k, window.nu)
        assert np.all(values <= window.high + 1e-8)
        assert np.all(values >= window.low - 1e-8)


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


def test_a_window_can_only_make_the_objective_greater() -> None:
    plain = synthesize(Problem(B=1.8, order=3, basis=Chebyshev(15)))
    narrowed = [
        synthesize(Problem(B=1.8, order=3, basis=Chebyshev(15), windows=(Window("b", high=h, start=0.2, stop=0.3),)))
        for h in (1.3, 1.2, 1.1, 1.0)
    ]
    objectives = [plain.objective, *(one.objective for one in narrowed)]
    assert all(before <= after * (1.0 + 1e-13) for before, after in pairwise(objectives))
    assert all(one.status == "optimal" for one in narrowed)
    wide = Problem(B=1.8, order=3, basis=Chebyshev(15), windows=(Window("b", high=2.0),))
    assert synthesize(wide).objective == pytest.approx(plain.objective, rel=1e-10)


def test_a_contradiction_names_the_window() -> None:
    problem = Problem(B=1.8, order=3, basis=Chebyshev(7), monotone=True, windows=(via("a", 0.4, at=0.2),))
    with pytest.raises(InfeasibleProblem, match=r"via\('a', 0.4, at=0.2\)") as caught:
        synthesize(problem)
    assert caught.value.proof.proves_infeasible  # type: ignore[attr-defined] # it is a certificate
    upper = Window("b", high=0.3, start=0.3, stop=0.4)
    with pytest.raises(InfeasibleProblem, match=r"Window\('b', high=0.3, start=0.3, stop=0.4\)"):
        synthesize(Problem(B=1.5, order=4, basis=Chebyshev(5), windows=(upper,)))


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


@pytest.mark.parametrize("high", [0.2, 0.12])
def test_highs_agrees_on_forbidden_zones(high: float) -> None:
    windows = (Window("a", high=high, start=0.0, stop=0.4), Window("a", low=0.75, start=0.6))
    solution = synthesize(Problem(order=3, symmetric=False, windows=windows, basis=Chebyshev(9)))
    assert solution.status == "optimal"
    motion = polynomials(3, 9)
    c = motion.rows(2)
    zone = np.vstack([motion.rows(0, 0.0, 0.4), motion.row(0, 0.4)])
    other = -np.vstack([motion.rows(0, 0.6, 1.0), motion.row(0, 0.6)])
    expected = motion.least([(c, None), (-c, None), (zone, high), (other, -0.75)])
    assert expected is not None
    assert expected * (1 - 1e-9) <= solution.objective <= expected * (1 + 2e-5)


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
