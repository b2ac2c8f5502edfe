"""Least times, trapezoids, torques, constants and timing diagrams of others."""

from collections.abc import Callable
from fractions import Fraction
from math import pi
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose
from numpy.typing import NDArray
from scipy.optimize import brentq

from optlaws import (
    BoundaryConditions,
    Chebyshev,
    Cycle,
    Dwell,
    Follower,
    Functional,
    InfeasibleProblem,
    InputError,
    Pieces,
    Problem,
    Return,
    Rise,
    at_most,
    catalogue,
    drive_torque,
    fastest,
    law_from_z,
    limit,
    peak,
    rms,
    shaped_law,
    smoothstep,
    synthesize,
    trapezoid,
)
from tests.external.published import cases, numbers
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


# --- torques ---


@pytest.mark.parametrize("name", ["peak", "rms"])
def test_torque_under_a_load_is_above_its_infimum(name: str) -> None:
    """The least over all monotone laws with B and C bounded is convex in b² over a, and was computed so."""
    case = numbers()["loads"]
    torque = drive_torque(inertia="1", load="3*a")
    functional: Functional = {"peak": peak, "rms": rms}[name](torque)
    B, C = at_most(case["B"]), at_most(case["C"])
    problem = Problem(order=3, basis=Chebyshev(11), symmetric=False, monotone=True, minimise=functional, B=B, C=C)
    solution = synthesize(problem)
    assert solution.status == "optimal"
    assert case[name] <= solution.objective < 1.06 * case[name]


# --- timing diagrams ---


def test_a_die_that_moves_while_its_table_does_needs_a_fifth_of_the_acceleration() -> None:
    """Its ways within the table and its dwell fill the time for which the table rests."""
    case, law = numbers()["timing_diagram"], catalogue["cycloidal"].law
    assert law(0.1) == pytest.approx(case["share_at_a_tenth"], abs=5e-5)
    enters = brentq(lambda k: float(law(k)) - case["above"] / 50, 0.0, 1.0)
    rest = 360 - case["table"]
    longest = (rest - 100) / (2 * (1 - enters))

    def acceleration(way: float) -> float:
        angle = f"{way} deg"
        moves = [Rise("50 mm", angle, law="cycloidal"), Dwell("100 deg"), Return("50 mm", angle, law="cycloidal")]
        return Cycle([*moves, Dwell()], speed="60 rpm").peak(2)

    assert rest == 100 + 2 * case["way"]
    assert acceleration(case["way"]) / acceleration(longest) == pytest.approx(case["gain"], rel=0.04)


# --- standard laws ---


Array = NDArray[np.float64]


@pytest.mark.parametrize("case", cases("constants"))
def test_constants_in_tables_of_others(case: dict[str, Any]) -> None:
    constants = catalogue[case["law"]].law.constants
    for name in "BCDJ":
        # the jerk of a law with impulses is that of its print without them
        if name in case and np.isfinite(getattr(constants, name).value):
            assert getattr(constants, name).value == pytest.approx(case[name], rel=case["rtol"]), name
    if "rms_c" in case:
        assert constants.rms_c == pytest.approx(case["rms_c"], rel=case["rtol"])


def test_peaks_of_the_polynomial_of_least_jerk() -> None:
    case, law = numbers()["minimum_jerk"], catalogue["3-4-5"].law
    assert law.constants.B.value == pytest.approx(case["B"], rel=1e-14)
    assert law.constants.C.value == pytest.approx(case["C"], abs=5e-3)
    assert law.constants.C.k == pytest.approx((3 - 3**0.5) / 6, abs=1e-12)
    assert law.constants.J.value == pytest.approx(case["J"], rel=1e-14)
    assert law.j(0.5) == pytest.approx(case["middle"], rel=1e-13)


@pytest.mark.parametrize("case", cases("exercise"), ids=lambda case: f"{case['law']} {case['stroke']}")
def test_exercises_of_textbooks(case: dict[str, Any]) -> None:
    """Rise, dwell and return by one law, with the peaks of both moves as printed; m/s, m/s²."""
    (rise, fall), law, stroke = case["angles"], case["law"], case["stroke"]
    moves = [Rise(stroke, rise, law=law), Dwell("30 deg"), Return(stroke, fall, law=law), Dwell()]
    peaks = Cycle(moves, speed=case["speed"]).peaks
    assert_allclose([peaks[0].peak(2), peaks[2].peak(2)], case["accelerations"], rtol=1e-3)
    if "velocities" in case:
        assert_allclose([peaks[0].peak(1), peaks[2].peak(1)], case["velocities"], atol=7e-3)


def _sine(x: Array) -> Array:
    early = 0.43990085 * x - 0.0350062 * np.sin(4 * pi * x)
    later = 0.28004957 + 0.43990085 * x - 0.31505577 * np.cos(4 * pi * x / 3 - pi / 6)
    return np.where(x <= 1 / 8, early, later)


def _trapezoid(x: Array) -> Array:
    early = 0.38898448 * x - 0.0309544 * np.sin(4 * pi * x)
    plateau = 2.44406184 * x**2 - 0.22203097 * x + 0.00723407
    later = 1.6110154 * x - 0.0309544 * np.sin(4 * pi * x - pi) - 0.3055077
    return np.select([x <= 1 / 8, x <= 3 / 8], [early, plateau], later)


@pytest.mark.parametrize(
    ("name", "theirs", "stop"), [("modified sine", _sine, 7 / 8), ("modified trapezoid", _trapezoid, 1 / 2)]
)
def test_coefficients_of_saltire(name: str, theirs: Callable[[Array], Array], stop: float) -> None:
    """The page saltire.com/CamDesign/Cam%20Functions.html, to the eight digits that it prints."""
    places = np.linspace(0.0, stop, 201)
    assert_allclose(catalogue[name].law(places), theirs(places), atol=2e-8)


# --- shapers ---


FREQUENCY = 60.0
#: by how many per cent of the frequency a band may be wider than its table says, in round numbers
COARSE = 12


def left(case: dict[str, Any], damping: float, per_cent: float) -> float:
    """What a shaped law leaves beside what the law alone leaves, as fast as it runs within the shaped one."""
    law, nu = smoothstep(3), FREQUENCY * (1.0 + per_cent / 100.0)
    shaped = shaped_law(law, FREQUENCY, damping, case["name"])
    period = 2.0 * np.pi / (FREQUENCY * (1.0 - damping**2) ** 0.5)
    alone = Follower(nu * (1.0 - case["duration"] * period), damping).response(law)
    return Follower(nu, damping).response(shaped).residual_displacement / alone.residual_displacement


@pytest.mark.parametrize("case", cases("shapers"), ids=lambda case: case["name"])
def test_shapers_leave_as_little_and_take_as_long_as_their_table_says(case: dict[str, Any]) -> None:
    for band, share in (("five", 0.05), ("ten", 0.10)):
        if band in case:
            low, high = case[band]
            assert max(left(case, case["damping"], off) for off in np.linspace(low, high, 13)) <= share
            assert min(left(case, case["damping"], off) for off in (low - COARSE, high + COARSE)) > share
    with pytest.raises(InputError, match=f"takes {case['duration']:g} of a period"):
        shaped_law(smoothstep(3), 2.0 * np.pi * case["duration"], 0.0, case["name"])


@pytest.mark.parametrize("case", cases("insensitivity"), ids=lambda case: case["name"])
def test_extra_insensitive_shapers_are_as_wide_as_their_authors_say(case: dict[str, Any]) -> None:
    half = 50.0 * (case["width"] - 0.006)  # printed to two digits
    assert max(left(case, 0.0, off) for off in np.linspace(-half, half, 17)) <= 0.0501
    assert min(left(case, 0.0, off) for off in (-half - 3.0, half + 3.0)) > 0.05
