"""Wrong numbers and geometries of levers are refused with the reason, and levers with wanted constants are found."""

from math import pi, radians

import numpy as np
import pytest

from optlaws import InputError, TorsionLever, deg, find_torsion_levers
from tests.internals.balancing import QUANTITIES, FourBar, LeverMotion

GIVEN = {"beta": 0.75, "lam": 1.0, "rho": 0.15, "nu": 0.15, "swing": deg(60)}


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"beta": 0.0}, "beta must be above 0, got 0.0"),
        ({"lam": -1}, "lam must be above 0"),
        ({"rho": -0.1}, "rho must be at least 0, or the bar goes slack"),
        ({"nu": float("nan")}, "nu"),
        ({"swing": 60.0}, 'swing must be above 0 and below 180 deg, in radians, got 60.0; write "60 deg"'),
        ({"swing": 0.0}, "swing must be above 0"),
        ({"least_transmission": 2.0}, "least_transmission must be above 0 and below 90 deg"),
        ({"beta": "long"}, "beta"),
        ({"beta": 1.5}, r"between coupler and rocker is 151\.9\d* deg .* limit is 150 deg \(least_transmission\)"),
        ({"beta": 1.2}, r"the rocker swings by 73\.\d* deg .* the limit is 60 deg \(most_rocker_swing\); reduce"),
        ({"beta": 3.0, "lam": 0.5}, "passes a dead point"),
        ({"beta": 3.0, "lam": 1.0, "swing": deg(130)}, r"eq\. \(13\) has no root chi01"),
    ],
)
def test_what_is_refused(changed: dict[str, float], message: str) -> None:
    with pytest.raises(InputError, match=message):
        TorsionLever(**{**GIVEN, **changed})


def test_limits_can_be_moved() -> None:
    wide = TorsionLever(**{**GIVEN, "beta": 1.2}, most_rocker_swing=deg(77))
    low, high = wide.exact.chi02, wide.exact.chi01
    assert deg(70) < float(np.diff(wide.linkage.rocker(np.array([low, high])))[0]) < deg(77)
    with pytest.raises(InputError, match="the limit is 65 deg"):
        TorsionLever(**GIVEN, least_transmission=deg(65))


def test_a_limit_reached_is_not_exceeded() -> None:
    assert TorsionLever(1.0, 2.0, 0.1, 0.1, deg(60)).exact.swing == pytest.approx(deg(60), rel=1e-14)
    with pytest.raises(InputError, match="rocker swings by"):
        TorsionLever(1.0, 2.0, 0.1, 0.1, deg(60) + 1e-6)


@pytest.mark.parametrize(("beta", "lam"), [(0.25, 0.5), (0.75, 1.0), (1.0, 3.0), (1.5, 0.7), (2.5, 10.0), (0.5, 0.5)])
def test_dead_points_are_the_ends_of_the_range(beta: float, lam: float) -> None:
    linkage = FourBar(beta, lam)
    for end in linkage.range:
        length = np.hypot(
            beta * np.cos(linkage.psi0 + end) - linkage.alpha, beta * np.sin(linkage.psi0 + end)
        )  # O1B: the linkage closes between |lam - 1| and lam + 1
        if abs(end) < pi:
            assert min(abs(length - abs(lam - 1.0)), abs(length - lam - 1.0)) < 1e-7


@pytest.mark.parametrize(("beta", "lam"), [(0.25, 1.0), (0.75, 1.0), (1.5, 2.0), (2.5, 5.0)])
def test_transmission_angles_are_those_on_the_way(beta: float, lam: float) -> None:
    linkage = FourBar(beta, lam)
    low, high = -radians(20), radians(20)
    way = linkage.at(np.linspace(low, high, 20001))
    transmission = linkage.transmission(low, high)
    expected = [(angles.min(), angles.max()) for angles in (way.at_rocker, way.at_link)]
    assert np.array(transmission) == pytest.approx(np.array(expected), abs=1e-7)


def test_ratio_and_slope_are_derivatives() -> None:
    linkage = FourBar(0.6, 1.4)
    chi, step = np.linspace(-0.6, 0.6, 13), 1e-5
    ahead, behind, here = (linkage.at(chi + side * step) for side in (1, -1, 0))
    assert (ahead.rocker - behind.rocker) / (2 * step) == pytest.approx(here.ratio, abs=1e-9)
    assert (ahead.ratio - behind.ratio) / (2 * step) == pytest.approx(here.slope, abs=1e-9)


def test_what_is_left_of_the_twists() -> None:
    lever = TorsionLever(**GIVEN)
    planned = 0.15 * lever.gamma01, 0.15 * (lever.swing - lever.chi01)
    assert lever.twists_left == pytest.approx(planned, abs=2e-3)
    slack = TorsionLever(**{**GIVEN, "nu": 0.0})
    assert slack.twists_left[1] < 0.0 < slack.twists_left[0]


def test_seconds_and_stiffness_are_inverse() -> None:
    motion = TorsionLever(**GIVEN).exact
    first = motion.stiffness(seconds=0.1, inertia=0.02)
    assert motion.seconds(first, inertia=0.02) == pytest.approx(0.1, rel=1e-14)
    with pytest.raises(InputError, match="inertia must be above 0"):
        motion.seconds(1.0, inertia=0.0)


@pytest.mark.parametrize("amplitudes", [(0.0,), (1.0, 0.5), (0.0, 0.5, 0.4), (0.0, -0.5)])
def test_a_motion_that_is_no_swing_is_refused(amplitudes: tuple[float, ...]) -> None:
    with pytest.raises(InputError):
        LeverMotion(amplitudes, 6.0)


# --- wanted constants ---


ALL_BUT_LENGTHS = {"rho": 0.15, "nu": 0.15, "swing": deg(60)}


@pytest.mark.sample(9)
@pytest.mark.parametrize("name", QUANTITIES)
def test_a_known_lever_is_found_again(name: str) -> None:
    known = TorsionLever(beta=0.8, lam=1.7, **ALL_BUT_LENGTHS)
    value = QUANTITIES[name](known)
    levers = find_torsion_levers({name: value}, lam=1.7, **ALL_BUT_LENGTHS)
    assert min(abs(lever.beta - 0.8) for lever in levers) < 1e-6
    for lever in levers:
        assert QUANTITIES[name](lever) == pytest.approx(value, rel=1e-10)


def test_the_coupler_is_found_for_a_period() -> None:
    (one,) = find_torsion_levers({"T": 6.1}, beta=0.75, **ALL_BUT_LENGTHS)
    assert one.exact.period == pytest.approx(6.1, rel=1e-11)
    assert one.lam == pytest.approx(1.1196914, rel=1e-6)


def test_all_levers_are_found_where_there_are_several() -> None:
    # B3 rises from beta = 0.02 to 0.13 or so and falls again
    levers = find_torsion_levers({"B3": 1.585}, lam=1.0, beta=(0.02, 1.0), rho=0.15, nu=0.15, swing=deg(40))
    assert [lever.exact.B3 for lever in levers] == pytest.approx([1.585, 1.585], rel=1e-11)
    assert levers[0].beta < 0.13 < levers[1].beta


def test_both_lengths_are_found_for_two_constants() -> None:
    known = TorsionLever(beta=0.7, lam=2.5, **ALL_BUT_LENGTHS).exact
    levers = find_torsion_levers({"T": known.period, "B1/B3": known.B1 / known.B3}, **ALL_BUT_LENGTHS)
    assert any((lever.beta, lever.lam) == pytest.approx((0.7, 2.5), rel=1e-5) for lever in levers)
    for lever in levers:
        assert (lever.exact.period, lever.exact.B1 / lever.exact.B3) == pytest.approx(
            (known.period, known.B1 / known.B3), rel=1e-8
        )


def test_a_value_at_the_very_limit_is_reached() -> None:
    # the rocker swings by 60 degrees at beta = 1, where the range ends
    (one,) = find_torsion_levers({"B1/B3": 1.0 - 1e-9}, lam=1.0, **ALL_BUT_LENGTHS)
    assert one.beta == pytest.approx(1.0, abs=1e-5)


@pytest.mark.sample(3)
@pytest.mark.parametrize(
    ("expected", "lengths", "message"),
    [
        ({"B1/B3": 1.2}, {"lam": 1.0}, r"B1/B3 = 1\.2 is out of reach: for beta from 0\.25 to 1, .* to 1 \(at 1\)"),
        ({"T": 9.0}, {"beta": 0.75}, r"T = 9 is out of reach: for lam from 0\.5 to 10"),
        (
            {"T": 6.1, "B1/B3": 0.9},
            {},
            r"no lever has T = 6\.1 and B1/B3 = 0\.9: the nearest has .* alone each reaches",
        ),
        ({"B2": 1.0}, {"lam": 1.0}, "unknown constant of the lever 'B2'"),
        ({"T": 6.1}, {}, r"1 targets \(T\), 2 sought \(beta, lam\)"),
        ({}, {}, r"0 targets \(none\)"),
        ({"T": float("inf")}, {"lam": 1.0}, "T"),
        ({"T": 6.1}, {"lam": 1.0, "beta": (1.0, 0.5)}, "beta must be a number above 0 or a range"),
        ({"T": 6.1}, {"lam": 1.0, "beta": (2.0, 2.5)}, "passes a dead point"),
    ],
)
def test_what_is_out_of_reach_is_said(expected: dict[str, float], lengths: dict[str, float], message: str) -> None:
    with pytest.raises(InputError, match=message):
        find_torsion_levers(expected, **lengths, **ALL_BUT_LENGTHS)
