"""The motion that is exported: the law's and the cycle's own values, in the units of master and slave."""

from math import inf, isinf

import numpy as np
import pytest

from optlaws import Cycle, Dwell, InputError, Return, Rise, catalogue, smoothstep
from tests.internals.exports import iec_name
from tests.internals.motion import Motion, motion_of_law


def press(law: str = "cycloidal") -> Cycle:
    return Cycle(
        [Rise("35 mm", "120 deg", law=law), Dwell("90 deg"), Return(duration="100 deg", law=law), Dwell()],
        speed="200 rpm",
    )


@pytest.fixture
def cycle() -> Motion:
    return press().motion()


def test_a_law_has_the_values_of_its_formula() -> None:
    law = catalogue["modified sine"].law
    motion = motion_of_law(law, stroke="-20 deg", master="120 deg", duration="0.1 s", start="50 deg")
    x = np.linspace(0.0, 120.0, 50)
    for nu in range(4):
        expected = -20.0 / 120.0**nu * law(x / 120.0, nu) + (50.0 if nu == 0 else 0.0)
        np.testing.assert_allclose(motion(x, nu), expected, rtol=1e-13, atol=1e-13 * np.abs(expected).max())
        assert motion.peak(nu) == pytest.approx(np.abs(expected).max(), rel=0.02)


def test_a_cycle_has_its_own_values_by_the_angle(cycle: Motion) -> None:
    own, x = press(), np.linspace(0.0, 360.0, 200)
    for nu in range(3):
        expected = 1e3 * own.at_angle(x, nu) / 1200.0**nu
        np.testing.assert_allclose(cycle(x, nu)[:-1], expected[:-1], rtol=1e-9, atol=1e-12 * np.abs(expected).max())
        assert cycle.peak(nu) == pytest.approx(1e3 * own.peak(nu) / 1200.0**nu, rel=1e-12)
    starts = [*(piece.start for piece in cycle.pieces), cycle.stop]
    assert starts == pytest.approx([0.0, 120.0, 210.0, 310.0, 360.0], rel=1e-12)
    assert cycle.repeats
    assert cycle.advance == pytest.approx(0.0, abs=1e-12)
    assert cycle.rms(2) == pytest.approx(cycle.over_time().rms(2) / 1200.0**2, rel=1e-12)


def test_time_is_a_master_too(cycle: Motion) -> None:
    seconds = cycle.over_time()
    assert (seconds.units.master, seconds.units.rate, round(seconds.stop, 12)) == ("s", 1.0, 0.3)
    assert seconds.peak(2) == pytest.approx(1e3 * press().peak(2), rel=1e-12)
    assert seconds.over_time() is seconds


def test_jumps_are_told_at_joints_and_within_laws() -> None:
    motion = press("parabolic").motion()
    assert motion.jump(2) == pytest.approx((8.0 * 35.0 / 100.0**2, 260.0))
    at_joint = Motion(motion.pieces[:2], motion.units, repeats=False)
    assert at_joint.jump(2) == pytest.approx((8.0 * 35.0 / 120.0**2, 60.0))
    cubic = press("cubic").motion()
    assert cubic.jump(2) == pytest.approx((6.0 * 35.0 / 100.0**2, 210.0))
    assert motion.jump(1) == (0.0, 0.0)
    assert isinf(motion.peak(3))
    uniform = motion_of_law(smoothstep(1), stroke="1 m", duration="1 s")
    assert (uniform.jump(1)[0], uniform.peak(1), uniform.peak(2)) == (0.0, 1.0, 0.0)


def test_breaks_are_those_of_joints_and_laws() -> None:
    law = catalogue["parabolic"].law
    motion = motion_of_law(law, stroke="1 m", duration="2 s")
    assert motion.breaks == tuple(2.0 * k for k in law.breaks)
    assert motion.peak(3) == inf


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({}, ["stroke", "35 mm"]),
        ({"stroke": 35.0, "duration": "0.1 s"}, ["stroke", "without a unit"]),
        ({"stroke": "0 mm", "duration": "0.1 s"}, ["stroke", "give how far the slave moves"]),
        ({"stroke": "35 mm"}, ["duration='0.1 s'", "master='120 deg'"]),
        ({"stroke": "35 mm", "duration": "-1 s"}, ["duration", "above 0"]),
        ({"stroke": "35 mm", "master": "0.1 s"}, ["master", "angle", "length"]),
        ({"stroke": "35 mm", "master": "0 deg"}, ["master", "above 0"]),
        ({"stroke": "35 mm", "duration": "1 s", "start": "3 deg"}, ["start", "length"]),
    ],
)
def test_what_is_missing_or_wrong_is_named(arguments: dict[str, object], words: list[str]) -> None:
    with pytest.raises(InputError) as caught:
        motion_of_law(smoothstep(3), **arguments)  # type: ignore[arg-type]
    assert all(word in str(caught.value) for word in words)


def test_beyond_the_motion_there_are_no_values(cycle: Motion) -> None:
    with pytest.raises(InputError, match="from 0 to 360 deg"):
        cycle([0.0, 361.0])
    with pytest.raises(InputError, match=r"how fast the master goes is not known.*duration="):
        motion_of_law(smoothstep(3), stroke="1 mm", master="90 deg").over_time()
    with pytest.raises(InputError, match="unit must be a length"):
        press().motion(unit="deg")


@pytest.mark.parametrize("name", ["press 1", "1st", "a__b", "end_if", "IF", "x_", "", "ä", None, 5, "x" * 41])
def test_a_refused_name_comes_with_one_that_is_taken(name: object) -> None:
    with pytest.raises(InputError) as caught:
        iec_name(name, "CODESYS")
    proposed = str(caught.value).rpartition("take ")[2].strip("'")
    assert iec_name(proposed, "CODESYS") == proposed
