"""Process forces on followers: against forces by hand, over angle, time and way, with jumps, in any unit."""

from math import pi
from typing import Any

import numpy as np
import pytest

from optlaws import CamForces, CamMotion, DiscCam, InputError, TranslatingRoller, least_spring
from tests.cams.placed import FOLLOWERS, cam_of
from tests.internals.formulas import NUMPY, evaluate, read

MOVED = {"mass": "2 kg", "stiffness": "3 N/mm", "preload": "90 N", "dry": "4 N"}
SWUNG = {"inertia": "0.02 kg m^2", "stiffness": "30 N m/rad", "preload": "6 N m"}
ANGLES = np.linspace(0.0, 2 * pi, 3601)[:-1] + 1e-4


def lines(pairs: list[tuple[float, float]]) -> list[tuple[str, str]]:
    return [(f"{place!r} deg", f"{value!r} N") for place, value in pairs]


def taken(process: dict[str, Any], kind: str = "translating roller", **given: Any) -> np.ndarray:
    """The force that a process takes off what moves the follower."""
    cam, drive = cam_of(kind), SWUNG if FOLLOWERS[kind][0].axis == "angle" else MOVED
    moved = {"speed": "60 rpm", "drive": drive, **given}
    with_process = CamForces(cam, process=process, **moved).follower_force(ANGLES)
    return np.asarray(CamForces(cam, **moved).follower_force(ANGLES) - with_process)


TABLE = [(0.0, 0.0), (40.0, 0.0), (150.0, 80.0), (150.0, -200.0), (222.0, -120.0), (222.0, 0.0), (360.0, 0.0)]


def stepped(places: np.ndarray) -> np.ndarray:
    ramps = [0.0 * places, 80.0 * (places - 40.0) / 110.0, -200.0 + 80.0 * (places - 150.0) / 72.0]
    return np.select([places < 40.0, places < 150.0, places < 222.0], ramps, 0.0)


def test_tables_over_the_angle_and_the_time_jump_where_a_place_stands_twice() -> None:
    by_angle = taken({"force": lines(TABLE), "over": "master"})
    assert by_angle == pytest.approx(stepped(np.degrees(ANGLES)), abs=1e-9)
    seconds = [(f"{place / 180.0!r} s", f"{value!r} N") for place, value in TABLE]
    by_time = taken({"force": seconds}, speed="30 rpm")
    assert by_time == pytest.approx(stepped(np.degrees(ANGLES)), abs=1e-9)


@pytest.mark.parametrize("kind", FOLLOWERS)
def test_a_formula_or_a_quantity_acts_on_every_follower(kind: str) -> None:
    name, size = ("torque", 3.0) if FOLLOWERS[kind][0].axis == "angle" else ("force", 50.0)
    unit = {"torque": "N m", "force": "N"}[name]
    assert taken({name: f"-{size} {unit}"}, kind) == pytest.approx(np.full(ANGLES.shape, -size))
    wave = taken({name: f"{size}*sin(m)^2 - abs({size}*cos(m))", "over": "master"}, kind)
    assert wave == pytest.approx(size * np.sin(ANGLES) ** 2 - np.abs(size * np.cos(ANGLES)), abs=1e-9)
    assert taken({name: f"{size}*exp(-2*t)"}, kind) == pytest.approx(size * np.exp(-ANGLES / pi), abs=1e-9)


def test_a_force_over_the_way_and_a_spline() -> None:
    cam = cam_of("translating roller")
    places, values = [0.0, 5.0, 12.0, 21.0, 30.0], [10.0, -40.0, 20.0, -60.0, -70.0]
    pairs = [(f"{place} mm", f"{value} N") for place, value in zip(places, values, strict=True)]
    way = 1e3 * np.asarray(cam.displacement(ANGLES))
    assert taken({"force": pairs, "over": "driven"}) == pytest.approx(np.interp(way, places, values), abs=1e-9)
    smooth = taken({"force": pairs, "over": "driven", "interpolation": "spline"})
    table = ", ".join(f"{1e-3 * place!r}:{value!r}" for place, value in zip(places, values, strict=True))
    curve = evaluate(read(f"monotone(s, {table})"), {"s": 1e-3 * way}, NUMPY)
    assert smooth == pytest.approx(curve, abs=1e-9)


@pytest.mark.sample(3)
@pytest.mark.parametrize(
    "process",
    [
        {"force": lines(TABLE), "over": "master"},
        {"force": [("0 mm", "0 N"), ("9 mm", "-30 N"), ("30 mm", "-90 N")], "over": "driven"},
        {"force": "60*cos(2*m) - abs(40*sin(m))", "over": "master"},
    ],
    ids=["jumps", "way", "kinks"],
)
def test_forces_are_enclosed_over_the_turn(process: dict[str, Any]) -> None:
    friction = {"contact": 0.01, "guide": 0.1, "overhang": "60 mm", "length": "80 mm"}
    forces = CamForces(cam_of("translating roller"), "120 rpm", MOVED, friction, process=process)
    for extremes, values in ((forces.contact, forces.contact_force), (forces.torque, forces.shaft_torque)):
        beside = np.concatenate([forces.edges[:-1] + 1e-9, forces.edges[1:] - 1e-9, np.linspace(0.0, 2 * pi, 20011)])
        known = np.asarray(values(beside))
        assert extremes.low <= known.min() <= extremes.least + 1e-5
        assert extremes.most - 1e-5 <= known.max() <= extremes.high
        assert extremes.high - extremes.most < 1e-6
    low, high = forces.mean_torque
    middles = (np.arange(400000) + 0.5) * (2 * pi / 400000)
    assert 0.5 * (low + high) == pytest.approx(float(np.mean(forces.shaft_torque(middles))), abs=2e-5)


@pytest.mark.parametrize("unit", [1e-12, 1e9])
def test_other_units_of_forces_and_lengths(unit: float) -> None:
    """Lengths and forces in another unit, at the same angles: forces in proportion."""
    base = cam_of("translating roller")
    motion = base.displacement

    def least(size: float) -> tuple[float, float]:
        rise = CamMotion.of_law("cycloidal", f"{30 * size!r} mm", "140 deg")
        follower = TranslatingRoller(f"{12 * size!r} mm", offset=f"{9 * size!r} mm")
        cam = DiscCam(rise, f"{70 * size!r} mm", follower)
        drive = {"stiffness": "3 N/mm", "preload": f"{90 * size!r} N", "mass": "2 kg"}
        table = [(f"{place} deg", f"{value * size!r} N") for place, value in [(0, 0), (60, 50), (60, -80), (140, 0)]]
        forces = CamForces(cam, "60 rpm", drive, process={"force": table, "over": "master"})
        return forces.contact.least / size, forces.contact.most / size

    assert motion.closed
    assert least(unit) == pytest.approx(least(1.0), rel=1e-9)


def test_a_spring_under_a_process_holds_at_every_speed_and_no_lesser_does() -> None:
    cam, process = cam_of("translating roller"), {"force": lines(TABLE), "over": "master"}
    drive, speeds = {"mass": "2 kg", "dry": "4 N"}, ("30 rpm", "200 rpm")
    spring = least_spring(cam, drive=drive, speeds=speeds, process=process, greatest="contact", force="10 N")
    assert spring.objective == "contact"
    assert spring.value == spring.greatest == pytest.approx(spring.lower_bound, rel=1e-7)
    near = np.concatenate([ANGLES, np.radians([149.9999999, 150.0, 221.9999999])])

    def contact(stiffness: float, preload: float) -> tuple[float, float]:
        moved = drive | {"stiffness": f"{stiffness!r} N/m", "preload": f"{preload!r} N"}
        at = [CamForces(cam, f"{rpm} rpm", moved, process=process) for rpm in (30, 90, 200)]
        follower = min(float(np.min(forces.follower_force(near))) for forces in at)
        return follower, max(float(np.max(forces.contact_force(near))) for forces in at)

    least, greatest = contact(spring.stiffness, spring.preload)
    assert least == pytest.approx(10.0, abs=1e-4)
    assert greatest == pytest.approx(spring.greatest, rel=1e-6)
    for more, less in ((1.05, 0.97), (0.95, 1.03), (1.0, 0.99)):
        least, greatest = contact(more * spring.stiffness, less * spring.preload)
        assert least < 10.0 - 1e-3 or greatest > spring.greatest * (1 - 1e-9)


@pytest.mark.parametrize(
    ("process", "says"),
    [
        ("3 N", "process: a process must be a table of force"),
        ({}, "give a force or a torque"),
        ({"force": "3 N", "torque": "1 N m"}, "not both"),
        ({"torque": "1 N m"}, "give force in place of torque"),
        ({"force": "3 N", "ovr": "time"}, "did you mean 'over'"),
        ({"force": "3 N", "over": "input"}, "process: unknown over 'input'"),
        ({"force": "3 N", "on": "slider"}, "process: .*on.* takes|process: .*'on'"),
        ({"force": "3 N", "interpolation": "line"}, "did you mean 'lines'"),
        ({"force": "3 N m"}, "force must be a force"),
        ({"force": "3*x"}, "x"),
        ({"force": [("0 deg", "0 N")], "over": "master"}, "needs 2 pairs"),
        ({"force": [("0 deg", "0 N"), ("9 deg", "1 N"), ("9 deg", "2 N")], "over": "master"}, "needs 2 pairs"),
        ({"force": [("0 deg", "0 N"), ("400 deg",)], "over": "master"}, "pairs of a place and a value"),
        ({"force": [("0 deg", "0 N"), ("360 deg", "1 m")], "over": "master"}, "value 2"),
        ({"force": [("0 deg", "0 N"), ("360 deg", "1 N")]}, "place 2|place 1"),
        ({"force": [("90 deg", "0 N"), ("0 deg", "1 N"), ("360 deg", "0 N")], "over": "master"}, "must ascend"),
        ({"force": [("0 deg", "0 N"), ("300 deg", "1 N")], "over": "master"}, "goes from 0 to 300 deg"),
        ({"force": [("0 mm", "0 N"), ("9 mm", "1 N"), ("9 mm", "2 N"), ("30 mm", "0 N")], "over": "driven"}, "twice"),
        ({"force": float("nan")}, "finite"),
        ({"force": "3 N", "interpolation": []}, "interpolation"),
    ],
)
def test_wrong_processes_say_why(process: Any, says: str) -> None:
    with pytest.raises(InputError, match=says):
        CamForces(cam_of("translating roller"), "60 rpm", MOVED, process=process)


def test_a_spring_over_a_range_of_speeds_takes_no_force_over_time() -> None:
    cam, drive = cam_of("translating roller"), {"mass": "2 kg"}
    process = {"force": [("0 s", "0 N"), ("1 s", "-9 N")]}
    with pytest.raises(InputError, match="another at each speed"):
        least_spring(cam, drive=drive, speeds=("30 rpm", "60 rpm"), process=process)
    assert least_spring(cam, drive=drive, speeds=("60 rpm", "60 rpm"), process=process).margin > -1e-9
    with pytest.raises(InputError, match="greatest"):
        least_spring(cam, drive=drive, speeds=("0 rpm", "60 rpm"), greatest="contacts")  # type: ignore[arg-type]
