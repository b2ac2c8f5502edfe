"""What no law changes, forces and velocities at joints: limits that cannot be kept, and peaks that many laws share."""

from typing import Any

import numpy as np
import pytest

from optlaws import Axes, ConstantVelocity, Cycle, Dwell, Free, InfeasibleProblem, Return, Rise

MOVES = [Rise("35 mm", "120 deg"), Dwell("60 deg"), Return("35 mm", "120 deg"), Dwell()]
SPRING = {"mass": "2 kg", "stiffness": "3 N/mm", "preload": "44.6 N"}
TOP = r"at its end, at 35 mm and 120 deg of the master, every law takes the force 149\.6 N, but its limit is the force"


def cycle(**given: Any) -> Cycle:
    return Cycle(given.pop("segments", MOVES), **({"speed": "200 rpm"} | given))


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: cycle(drive=SPRING, limits={"force": "140 N"}), rf"segment 1 \(Rise\): {TOP} 140 N: allow more"),
        (lambda: cycle(drive=SPRING, segments=[Rise("35 mm", "120 deg", limits={"force": "90 N"}), *MOVES[1:]]), TOP),
        (lambda: cycle(drive={"dry": "20 N", "mass": "2 kg"}, limits={"force": "15 N"}), r"takes the force 20 N"),
        (lambda: cycle(segments=[Rise("9 deg", "120 deg"), Return(), Dwell("9 deg")], drive={"gravity": "2 N m"},
                       limits={"torque": "1 N m"}), r"every law takes the torque 2 N m"),
        (lambda: Axes({"slide": {"segments": MOVES, "drive": SPRING, "limits": {"force": "9 N"}}}, speed="200 rpm"),
         r"axis slide: segment 1"),
        (lambda: cycle(segments=[Free("35 mm", "90 deg"), Dwell("90 deg"), Free("-35 mm")], drive=SPRING,
                       limits={"force": "140 N"}), r"at its end, at 35 mm and 90 deg of the master"),
    ],
)  # fmt: skip
def test_a_force_that_every_law_takes_at_a_joint_is_told_when_the_cycle_is_made(make: Any, says: str) -> None:
    with pytest.raises(InfeasibleProblem, match=says):
        make()


@pytest.mark.sample(3)
@pytest.mark.parametrize(
    ("limits", "least"),
    [({"force": "29 N"}, "the force 30.3942 N"), ({"velocity": "370 mm/s"}, "the velocity 378.216"),
     ({"velocity": "470 mm/s", "acceleration": "14 m/s^2"}, r"the acceleration 15.1971 m/s\^2")],
)  # fmt: skip
def test_limits_that_no_law_keeps_are_told_in_units_of_the_machine(limits: dict[str, str], least: str) -> None:
    made = cycle(drive={"mass": "2 kg"}, limits=limits)
    with pytest.raises(InfeasibleProblem, match=rf"among laws of order 3 with Z of degree 9 the least is {least}"):
        made.status  # noqa: B018 - laws are looked for when they are asked for


def test_limits_of_the_force_that_joints_need_no_more_than_are_kept() -> None:
    for most in ("149.6 N", "160 N"):
        kept = cycle(drive=SPRING, limits={"force": most})
        assert kept.status == "optimal"
        assert kept.effort.peak_force <= float(most[:-2]) * (1.0 + 1e-9)
    assert cycle(drive=SPRING, order=2, limits={"force": "149.6 N"}).status == "optimal"


def test_of_laws_with_one_peak_of_force_in_a_dwell_that_of_least_acceleration_is_taken() -> None:
    """The spring is pressed most in the dwell: half of all laws take no more force, whatever their acceleration."""
    pressed, calm = cycle(drive=SPRING, minimise="force"), cycle(drive=SPRING)
    assert pressed.objective == pytest.approx(149.6, rel=1e-9)
    assert pressed.status == "optimal"
    assert pressed.lower_bound == pytest.approx(149.6, rel=1e-9)
    assert pressed.peak(2) == pytest.approx(calm.peak(2), rel=1e-9)
    (remark,) = pressed.remarks
    assert remark.startswith("the force is greatest at 120 deg of the master, where no law changes it")
    heavy = cycle(drive=SPRING | {"mass": "20 kg"}, minimise="force")
    assert heavy.remarks == ()
    assert heavy.objective > 149.6


def test_of_laws_with_one_peak_of_velocity_beside_a_given_one_that_of_least_acceleration_is_taken() -> None:
    web = cycle(segments=[ConstantVelocity("500 mm/s", "0.1 s"), Return("50 mm", "0.2 s")], speed=None, period="0.3 s",
                minimise="velocity")  # fmt: skip
    assert web.objective == pytest.approx(0.5, rel=1e-9)
    assert web.status == "optimal"
    assert len(web.remarks) == 2
    other = cycle(segments=web.segments, speed=None, period="0.3 s", limits={"velocity": "500 mm/s"})
    assert web.peak(2) == pytest.approx(other.peak(2), rel=1e-7)
    assert np.abs(web(np.linspace(0.0, 0.3, 301), 1)).max() <= 0.5 * (1.0 + 1e-9)


def test_a_degree_that_is_raised_is_said() -> None:
    shear = [ConstantVelocity("1.5 m/s", "80 ms"), Return()]
    raised, asked = (cycle(segments=shear, speed=None, period="400 ms", degree=degree) for degree in (9, 15))
    assert raised.remarks == ("segment 2 (Return): Z has the degree 15, not 9, for the velocities at its ends",)
    assert asked.remarks == ()
    assert raised.search_space == asked.search_space == "laws of order 3 with Z of degree 15"
    assert "not 9" in raised._repr_html_()
    assert "segment 2 (Return): Z has the degree 15, not 9" in raised.export("codesys-xyva", points=41).text
