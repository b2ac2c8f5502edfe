"""Least times and trapezoids of others: laws that keep the limits in their time, and none in less."""

from typing import Any

import numpy as np
import pytest

from optlaws import InfeasibleProblem, Pieces, Problem, at_most, limit, synthesize, trapezoid
from tests.external.published import cases
from tests.internals.exports import segment_times

NAMES = ("velocity", "acceleration", "jerk")


def of_dimensionless(case: dict[str, float], time: float) -> dict[str, float]:
    """Limits of velocity, acceleration and jerk over a stroke in a time as limits of B, C and J."""
    shares = (case[name] * time**nu / case["stroke"] for nu, name in enumerate(NAMES, start=1))
    return dict(zip("BCJ", shares, strict=True))


def problem(case: dict[str, float], time: float) -> Problem:
    """Least C under the limits, of cubics between the places where the quickest move's jerk jumps."""
    move = segment_times(case["stroke"], *(case[name] for name in NAMES))
    ends = np.cumsum([move.jerk_time, move.acceleration_time, move.jerk_time]) / move.duration
    breaks = tuple(sorted({0.0, 0.5, 1.0, *ends.round(12).tolist(), *(1.0 - ends).round(12).tolist()}))
    B, C, J = (at_most(value) for value in of_dimensionless(case, time).values())
    return Problem(order=3, basis=Pieces(breaks, degree=3, continuity=2), minimise="C", B=B, C=C, J=J)


@pytest.mark.parametrize("case", cases("ruckig"))
def test_least_times_of_ruckig(case: dict[str, float]) -> None:
    """In its time a law keeps all limits, in a thousandth less no law does; seven segments take just it."""
    assert segment_times(case["stroke"], *(case[name] for name in NAMES)).duration == pytest.approx(
        case["time"], rel=1e-10
    )
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
    move = segment_times(stroke, 1e3 * peak, acceleration, jerk)
    assert move.cruise_time == pytest.approx(0.0, abs=1e-9 * move.duration)
    assert move.motion().peak(1).value == pytest.approx(peak, rel=1e-9)
