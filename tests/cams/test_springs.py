from math import pi, radians
from typing import Any

import numpy as np
import pytest
from scipy.optimize import linprog

from optlaws import CamForces, InfeasibleProblem, InputError, least_spring
from tests.cams.placed import cam_of

MASS = {"mass": "2 kg", "viscous": "12 N s/m", "dry": "4 N", "gravity": "5 N"}
SPEEDS = ("60 rpm", "300 rpm")


@pytest.mark.sample(2)
@pytest.mark.parametrize("arguments", [{}, {"preload": "40 N"}, {"stiffness": "1 N/mm"}, {"force": "15 N"}])
def test_the_least_spring_keeps_the_follower_on_and_no_lesser_does(arguments: dict[str, Any]) -> None:
    cam = cam_of("translating roller")
    spring = least_spring(cam, drive=MASS, speeds=SPEEDS, **arguments)
    asked = 15.0 if "force" in arguments else 0.0
    assert spring.margin == pytest.approx(asked, abs=1e-6)
    assert spring.lower_bound <= spring.value * (1 + 1e-12)
    assert spring.value == pytest.approx(spring.lower_bound, rel=1e-6)

    def least(stiffness: float, preload: float, rpm: float) -> float:
        own = MASS | {"stiffness": f"{stiffness!r} N/m", "preload": f"{preload!r} N"}
        force = CamForces(cam, speed=f"{rpm!r} rpm", drive=own).follower_force(np.linspace(0.0, 2 * pi, 1441))
        return float(np.min(force))

    for rpm in np.linspace(60.0, 300.0, 9):
        assert least(spring.stiffness, spring.preload, float(rpm)) >= asked - 1e-6
    # the same spring made lesser by a hundredth presses less where it was critical
    rpm = spring.critical[1] * 30.0 / pi
    lesser = CamForces(
        cam, speed=f"{rpm!r} rpm", drive=MASS | {"stiffness": f"{0.99 * spring.stiffness!r} N/m",
                                                 "preload": f"{0.99 * spring.preload!r} N"},
    )  # fmt: skip
    assert lesser.follower_force(radians(spring.critical[0])) < asked


def test_without_stiffness_the_preload_is_that_of_the_greatest_deceleration() -> None:
    cam = cam_of("translating flat", law="cycloidal")
    spring = least_spring(cam, drive={"mass": "2 kg"}, speeds=("0 rpm", "300 rpm"), stiffness="0 N/m")
    # cycloid: C = 2 pi, on the shorter way of 120 deg
    known = 2.0 * (10.0 * pi) ** 2 * 2.0 * pi * 0.012 / radians(120.0) ** 2
    assert spring.preload == pytest.approx(known, rel=1e-8)
    assert spring.lower_bound == pytest.approx(known, rel=1e-6)


def test_a_damper_is_worst_at_a_speed_between() -> None:
    cam = cam_of("translating flat", law="3-4-5")
    drive = {"mass": "0.05 kg", "viscous": "60 N s/m"}
    spring = least_spring(cam, drive=drive, speeds=("1 rpm", "4000 rpm"), stiffness="0 N/m")
    for rpm in np.geomspace(1.0, 4000.0, 25).tolist():
        forces = CamForces(cam, speed=f"{rpm!r} rpm", drive=drive | {"preload": f"{spring.preload!r} N"})
        assert forces.follower_force(np.linspace(0.0, 2 * pi, 721)).min() > -1e-6


def test_wrong_springs_say_why() -> None:
    cam = cam_of("translating roller")
    for arguments, match in (
        ({"speeds": "300 rpm"}, r"speeds must be a list of an angular velocity .* and an angular velocity .*, got"),
        ({"speeds": ("300 rpm", "60 rpm")}, "speeds must rise"),
        ({"drive": MASS | {"stiffness": "1 N/mm"}}, "to fix it give stiffness"),
        ({"preload": "-1 N"}, "preload must be at least 0"),
        ({"force": "1 N m"}, "force must be a force"),
    ):
        asked: dict[str, Any] = {"drive": MASS, "speeds": SPEEDS, **arguments}
        with pytest.raises(InputError, match=match):
            least_spring(cam, **asked)
    with pytest.raises(InfeasibleProblem, match="are missing; give so much more preload"):
        least_spring(cam, drive={"mass": "2 kg"}, speeds=SPEEDS, force="20 N", preload="10 N")


def test_a_stiffness_or_a_preload_of_0_has_its_reason() -> None:
    cam = cam_of("translating flat", law="cycloidal")
    drive = {"mass": "2 kg"}
    enough = least_spring(cam, drive=drive, speeds=SPEEDS, preload="2 kN")
    assert enough.stiffness == 0.0
    assert enough.remark.startswith("no stiffness is needed: the preload alone")
    assert enough.margin > 0.0
    partly: tuple[dict[str, Any], ...] = ({"preload": "1 N"}, {"stiffness": "0 N/m"})
    for arguments in partly:
        assert least_spring(cam, drive=drive, speeds=SPEEDS, **arguments).remark == ""
    heavy = {"mass": "0.1 kg", "gravity": "1 kN"}
    for arguments in (*partly[1:], {"preload": "0 N"}, {}):
        spring = least_spring(cam, drive=heavy, speeds=("0 rpm", "10 rpm"), **arguments)
        assert (spring.stiffness, spring.preload) == (0.0, 0.0)
        assert spring.remark.startswith("no spring is needed")


@pytest.mark.parametrize("greatest", ["force", "contact"])
def test_the_greatest_force_is_that_of_a_linear_program(greatest: Any) -> None:
    """scipy's program over a grid of angles, of preload, stiffness and greatest force."""
    cam = cam_of("translating roller")
    spring = least_spring(cam, drive={"mass": "2 kg"}, speeds=("0 rpm", "300 rpm"), greatest=greatest)
    angles = np.linspace(0.0, 2.0 * pi, 2881)
    y, inertia = cam.displacement(angles), 2.0 * (10.0 * pi) ** 2 * cam.displacement(angles, 2)
    lever = np.cos(cam.pressure_angle(angles)) if greatest == "contact" else np.ones(len(angles))
    low, high = np.minimum(inertia, 0.0), np.maximum(inertia, 0.0)
    pressed = np.column_stack([-np.ones(len(y)), -y, 0.0 * y])
    within = np.column_stack([1.0 / lever, y / lever, -np.ones(len(y))])
    known: Any = linprog([0.0, 0.0, 1.0], np.vstack([pressed, within]), np.concatenate([low, -high / lever]))
    assert spring.greatest == pytest.approx(known.fun, rel=1e-5)
    assert spring.stiffness == pytest.approx(known.x[1], rel=1e-3)
