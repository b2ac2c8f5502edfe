from math import radians

import numpy as np
import pytest

from optlaws import DiscCam, InputError, LeverCam, OscillatingRoller, TorsionLever, rocker_law

LEVER = TorsionLever(beta=0.75, lam=1.0, rho=0.15, nu=0.15, swing=radians(60.0))


def test_the_rocker_s_law_is_the_linkage_s() -> None:
    law, exact, linkage = rocker_law(LEVER), LEVER.exact, LEVER.linkage
    high, low = (float(linkage.rocker(chi)) for chi in (exact.chi01, exact.chi02))
    k = np.linspace(0.0, 1.0, 101)
    rocker = linkage.rocker(exact.chi(0.5 * exact.period * k))
    assert law.a(k) == pytest.approx((high - rocker) / (high - low), abs=1e-12)
    assert (law.b(0.0), law.b(1.0)) == pytest.approx((0.0, 0.0), abs=1e-12)
    # and no law of the driven link: that of the lever itself differs
    assert abs(law.constants.B.value - LEVER.law().constants.B.value) > 1e-3


def test_at_its_own_speed_nothing_is_left_on_the_cam() -> None:
    cam = LeverCam(LEVER, inertia="0.05 kg m^2", stroke="120 deg", speed="150 rpm")
    seconds = 2.0 * radians(120.0) / cam.rate
    assert LEVER.exact.seconds(cam.stiffness, 0.05) == pytest.approx(seconds)
    without = cam.unbalanced().peak
    assert cam.torque().bound < 1e-7 * without
    # at another speed the difference of the squares of the speeds is left
    for ratio in (0.5, 1.1):
        assert cam.torque(ratio).peak == pytest.approx(abs(ratio**2 - 1.0) * without, rel=1e-6)
        values, known = cam.at(np.linspace(0.0, 1.0, 20_001), ratio), cam.torque(ratio)
        assert known.low - 1e-9 * without <= values.min() <= known.low + 1e-6 * without
        assert known.high - 1e-6 * without <= values.max() <= known.high + 1e-9 * without
    assert cam.unbalanced(1.1).peak == pytest.approx(1.21 * without)


def test_the_cam_of_the_rocker_is_cut_from_its_cycle() -> None:
    cycle = LeverCam(LEVER, inertia="0.05 kg m^2", stroke="120 deg", speed="150 rpm").cycle
    cam = DiscCam(cycle, "60 mm", OscillatingRoller("12 mm", arm="90 mm", pivot_distance="120 mm"))
    assert cam.extremes.undercut.status == "free"
    assert cycle.duration == pytest.approx(0.4)


def test_wrong_entries_say_why() -> None:
    for arguments, match in (
        ({"inertia": "0 kg m^2"}, "inertia must be above 0"),
        ({"stroke": "200 deg"}, "stroke must be above 0 and at most 180 deg"),
        ({"speed": "0 rpm"}, "speed must be above 0"),
    ):
        with pytest.raises(InputError, match=match):
            LeverCam(LEVER, **{"inertia": "0.05 kg m^2", "stroke": "120 deg", "speed": "150 rpm", **arguments})
    with pytest.raises(InputError, match="speed_ratio"):
        LeverCam(LEVER, "0.05 kg m^2", "120 deg", "150 rpm").torque(0.0)
