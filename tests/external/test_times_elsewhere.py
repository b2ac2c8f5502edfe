"""Least times and trapezoids of others: laws that keep the limits in their time, and none in less."""

from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from optlaws import (
    BoundaryConditions,
    InfeasibleProblem,
    Pieces,
    Problem,
    at_most,
    fastest,
    law_from_z,
    limit,
    synthesize,
    trapezoid,
)
from tests.external.published import cases
from tests.internals.synthesis import LimitSegments, MoveLimits, segment_times

NAMES = ("velocity", "acceleration", "jerk")


def of_dimensionless(case: dict[str, float], time: float) -> dict[str, float]:
    """Limits of velocity, acceleration and jerk over a stroke in a time as limits of B, C and J."""
    shares = (case[name] * time**nu / case["stroke"] for nu, name in enumerate(NAMES, start=1))
    return dict(zip("BCJ", shares, strict=True))


def quickest(stroke: float, velocity: float, acceleration: float, jerk: float) -> LimitSegments:
    """The segments of the quickest move from rest to rest."""
    segments = segment_times(stroke, MoveLimits(velocity, acceleration, acceleration, jerk), 3)
    assert segments is not None
    return segments


def problem(case: dict[str, float], time: float) -> Problem:
    """Least C under the limits, of cubics between the places where the quickest move's jerk jumps."""
    move = quickest(case["stroke"], *(case[name] for name in NAMES))
    ends = np.cumsum(move.times[:3]) / move.duration
    breaks = tuple(sorted({0.0, 0.5, 1.0, *ends.round(12).tolist(), *(1.0 - ends).round(12).tolist()}))
    B, C, J = (at_most(value) for value in of_dimensionless(case, time).values())
    return Problem(order=3, basis=Pieces(breaks, degree=3, continuity=2), minimise="C", B=B, C=C, J=J)


@pytest.mark.parametrize("case", cases("ruckig"))
def test_least_times_of_ruckig(case: dict[str, float]) -> None:
    """In its time a law keeps all limits, in a thousandth less no law does; seven segments take just it."""
    move = quickest(case["stroke"], *(case[name] for name in NAMES))
    assert move.duration == pytest.approx(case["time"], rel=1e-10)
    constants = synthesize(problem(case, case["time"] * (1 + 1e-9))).law.constants
    for name, value in of_dimensionless(case, case["time"]).items():
        assert getattr(constants, name).value <= value * (1 + 1e-7)
    with pytest.raises(InfeasibleProblem):
        synthesize(problem(case, 0.999 * case["time"]))
    # and no law of any breaks: by the limits over all laws
    quicker = of_dimensionless(case, 0.999 * case["time"])
    assert quicker["J"] < limit("J") or limit("C", quicker["B"], J=quicker["J"]) > quicker["C"]


@pytest.mark.parametrize("case", cases("kdl"))
def test_trapezoids_of_kdl(case: dict[str, Any]) -> None:
    """Its velocity profile is the law of least acceleration for its peak velocity."""
    stroke, duration = case["stop"] - case["start"], case["duration"]
    B = case["velocity"] * duration / stroke
    law = trapezoid(0.0, 1 - 1 / min(B, 2.0), 0.0)
    assert law.constants.C.value == pytest.approx(case["acceleration"] * duration**2 / stroke, rel=1e-12)
    assert limit("C", min(B, 2.0)) == pytest.approx(law.constants.C.value, rel=1e-12)
    for time, place in case["places"]:
        assert case["start"] + stroke * law(time / duration) == pytest.approx(place, rel=1e-12)


@pytest.mark.parametrize(("stroke", "acceleration", "jerk"), [(1.0, 1e3, 1.0), (30.0, 2.0, 8.0), (1e-3, 5.0, 1e4)])
def test_peak_velocities_of_a_planner_from_rest_to_rest(stroke: float, acceleration: float, jerk: float) -> None:
    """Without a limit of the velocity: v³ = j s²/4, or v²/a + v a/j = s where the acceleration comes to its limit.

    The regimes that a look-ahead took the place of a solver by (LinuxCNC, issue 4149, where half of it had been taken).
    """
    peak = (jerk * stroke**2 / 4) ** (1 / 3)
    if (jerk * peak) ** 0.5 > acceleration:
        peak = max(np.roots([1 / acceleration, acceleration / jerk, -stroke]).real)
    move = quickest(stroke, 1e3 * peak, acceleration, jerk)
    assert move.times[3] == pytest.approx(0.0, abs=1e-9 * move.duration)
    assert jerk * move.times[0] * sum(move.times[:2]) == pytest.approx(peak, rel=1e-9)


@pytest.mark.parametrize("case", cases("profiles"), ids=lambda case: f"{case['stroke']:g} m")
def test_trapezoids_with_other_decelerations_take_the_least_time(case: dict[str, Any]) -> None:
    breaks = (0.0, *(time / case["time"] for time in case["breaks"]), 1.0)
    space = Problem(order=2, symmetric=False, basis=Pieces(breaks, degree=2, continuity=1))
    limits = {"velocity": f"{case['velocity']} m/s"}
    limits |= {name: f"{case[name]} m/s^2" for name in ("acceleration", "deceleration")}
    stroke, start = f"{case['stroke']} m", f"{case['start']} m/s"
    move = fastest(space, stroke=stroke, limits=limits, start_velocity=start)
    assert move.duration == pytest.approx(case["time"], rel=1e-6)
    assert move.none_below == pytest.approx(case["time"], rel=3e-6)
    for time, place in case["places"]:
        assert case["stroke"] * move.law(time / move.duration) == pytest.approx(place, abs=1e-6 * case["stroke"])


@pytest.mark.parametrize("case", cases("jerk_quintics"), ids=lambda case: f"{case['time']} s")
def test_the_smoothest_laws_are_the_quintics_of_least_jerk(case: dict[str, Any]) -> None:
    """Of any ends: in units of the stroke and of the time, from which both are brought back."""
    stroke, time = case["end"][0] - case["start"][0], case["time"]
    units = [stroke / time**nu for nu in range(3)]
    first, last = (
        tuple(Fraction(value) / Fraction(unit) for value, unit in zip(values, units, strict=True))
        for values in ((0, *case["start"][1:]), (stroke, *case["end"][1:]))
    )
    law = law_from_z(BoundaryConditions(start=first, end=last))
    at = np.linspace(0.0, time, 41)
    theirs = np.polynomial.Polynomial(case["powers"])
    for nu in range(4):
        ours = np.asarray(law(at / time, nu)) * stroke / time**nu + (case["start"][0] if nu == 0 else 0.0)
        assert ours == pytest.approx(theirs.deriv(nu)(at) if nu else theirs(at), abs=1e-9)
