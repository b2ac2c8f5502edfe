"""Laws of drives from the motion of the phase plane, in every space, against those that all other starts lead to."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from optlaws import (
    Bernstein,
    BSplines,
    Chebyshev,
    Powers,
    Problem,
    Solution,
    at_most,
    drive_limit,
    drive_torque,
    integral,
    peak,
    rms,
    slider_crank,
    synthesize,
)
from tests.internals.synthesis import attempt, evaluate, limit_beside, model_of, search, starts

LOADED = drive_torque(inertia="1 + 0.6*a^2", load="3*a")
PRESS = slider_crank("0.1 m", "0.4 m", bodies={"crank": "0.02 kg m^2", "slider": "5 kg"})
CRANK = PRESS.dimensionless("0 deg", "180 deg", "0.3 s").torque
BOUNDS: dict[str, Any] = {"B": (0, 2.2), "C": (0, 9)}

PROBLEMS = {
    "polynomial": Problem(order=3, basis=Chebyshev(9), minimise=peak(LOADED), **BOUNDS),
    "symmetric": Problem(order=3, basis=Powers(9), minimise=peak(LOADED), symmetric=True, **BOUNDS),
    "Bernstein": Problem(order=3, basis=Bernstein(9), minimise=rms(LOADED), B=at_most(2.2)),
    "order 2": Problem(order=2, basis=Chebyshev(9), minimise=peak(LOADED), **BOUNDS),
    "splines": Problem(order=3, basis=BSplines(6, 5), minimise=rms(LOADED), **BOUNDS),
    "heat and energy": Problem(
        order=3, basis=Chebyshev(7), minimise=integral(f"0.2*({LOADED})^2 + max(({LOADED})*b, 0)"), **BOUNDS
    ),
    "slider-crank": Problem(order=3, basis=Chebyshev(7), minimise=peak(CRANK), C=at_most(12)),
}


def forward(problem: Problem) -> Problem:
    return replace(problem, monotone=True, symmetric=problem.symmetric is True and "Powers" in repr(problem.basis))


@pytest.mark.sample(6)
@pytest.mark.parametrize("name", PROBLEMS)
def test_no_other_start_leads_to_a_better_law(name: str) -> None:
    problem = forward(PROBLEMS[name])
    model, limit = model_of(problem), limit_beside(problem)
    assert limit is not None
    _, best = attempt(model, None, starts.in_phase_plane(model, limit))
    _, other = attempt(model, None, None)
    assert best is not None
    assert other is not None
    assert best.objective <= other.objective * (1.0 + 1e-9)
    assert synthesize(problem).objective == pytest.approx(best.objective, rel=1e-12)


@pytest.mark.sample(2)
@pytest.mark.parametrize("unit", ["1e-12", "1e9"])
def test_units_of_the_torque_change_nothing(unit: str) -> None:
    """The least energy and its limit, in units of the torque."""

    def least(factor: str) -> Solution:
        torque = drive_torque(inertia=f"{factor}*(1 + 0.6*a^2)", load=f"{factor}*3*a")
        energy = integral(f"max(({torque})*b, 0)")
        return synthesize(forward(Problem(order=3, basis=Chebyshev(3), minimise=energy, **BOUNDS)))

    plain, scaled = least("1"), least(unit)
    assert scaled.objective / float(unit) == pytest.approx(plain.objective, rel=1e-11)
    assert scaled.lower_bound / float(unit) == pytest.approx(plain.lower_bound, rel=1e-6)
    assert plain.gap > 0.0


def test_the_start_is_near_the_motion() -> None:
    problem = Problem(order=3, basis=Chebyshev(21), minimise=rms(LOADED), monotone=True, symmetric=False)
    model, limit = model_of(problem), limit_beside(problem)
    assert limit is not None
    law = model.law(starts.in_phase_plane(model, limit))
    k, a, b = limit.motion()
    assert np.abs(law.a(k) - a).max() < 2e-3
    assert np.abs(law.b(k) - b).max() < 0.12
    # at degree 21 the start itself is within some per cent of what no law can beat
    assert evaluate(problem, law).objective < 1.03 * limit.value


def test_times_of_a_motion_are_those_of_its_closed_form() -> None:
    """Least peak torque of a plain inertia: b = sqrt(8 a) up to the middle, so that a = 2 k^2."""
    k, a, b = drive_limit("c", "peak torque").motion()
    first = k < 0.5
    assert a[first] == pytest.approx(2.0 * k[first] ** 2, abs=1e-5)
    assert b[first] == pytest.approx(4.0 * k[first], abs=1e-4)
    assert (k[0], k[-1], a[0], a[-1]) == pytest.approx((0.0, 1.0, 0.0, 1.0), abs=1e-12)


def test_laws_near_the_limit_need_no_other_starts() -> None:
    near = synthesize(forward(PROBLEMS["Bernstein"]))
    assert len(near.starts) == 1
    # of so low a degree the limit leaves much room, and others are tried
    far = synthesize(replace(forward(PROBLEMS["symmetric"]), basis=Powers(1), B=None, C=None))
    assert far.drive_limit is not None
    assert far.objective > 1.25 * far.drive_limit.value
    assert len(far.starts) > 1


def test_solutions_say_of_which_laws_the_limit_is() -> None:
    problem = Problem(order=3, basis=Chebyshev(3), minimise=rms(LOADED), symmetric=False)
    free, ahead = synthesize(problem), synthesize(replace(problem, monotone=True))
    assert any("turn back" in note for note in free.notes)
    assert not any("turn back" in note for note in ahead.notes)
    [row] = [row for row in ahead.summary() if row.name == "cost of order and degree"]
    assert ahead.drive_limit is not None
    assert row.value == pytest.approx(100.0 * (ahead.objective / ahead.drive_limit.value - 1.0))


@pytest.mark.parametrize("monotone", [True, False])
def test_an_inertia_below_nothing_is_no_drive(monotone: bool) -> None:  # noqa: FBT001 - a parameter
    problem = Problem(order=3, basis=Chebyshev(3), minimise=rms("(a - 0.5)*c + b^2"), symmetric=False)
    solution = synthesize(replace(problem, monotone=monotone))
    assert solution.drive_limit is None
    assert solution.objective > 0.0


@pytest.mark.long
@pytest.mark.parametrize(
    ("lines", "ramps"),
    [
        ("table(a, 0:1, 1:3)", "1 + 2*a"),
        ("table(a, 0:0, 0.7:0, 0.8:-6, 1:-6)", "60*max(a - 0.8, 0) - 60*max(a - 0.7, 0)"),
    ],
    ids=["a line", "corners"],
)
def test_a_load_by_straight_lines_is_that_of_its_ramps(lines: str, ramps: str) -> None:
    def least(load: str) -> Solution:
        bounds: dict[str, Any] = {"monotone": True, "C": (0, 12), "symmetric": False}
        return synthesize(Problem(order=3, basis=Chebyshev(7), minimise=rms(f"c + {load}"), **bounds))

    table, formula = least(lines), least(ramps)
    assert table.objective == pytest.approx(formula.objective, rel=1e-6)
    assert 0.0 < table.lower_bound <= table.objective * (1.0 + 1e-9)


def test_starts_agree_where_their_laws_are_as_good() -> None:
    nothing: Any = None
    exact = search.Candidate(nothing, nothing, 1.0)
    assert search._agree(exact, search.Candidate(nothing, nothing, 1.0 + 1e-12))
    assert not search._agree(exact, search.Candidate(nothing, nothing, 1.0005))
    assert not search._agree(exact, None)
