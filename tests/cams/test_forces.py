"""Forces of cams: at the contact and the shaft, under processes, and the springs that they need."""

from dataclasses import replace
from math import pi, radians
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import linprog

from optlaws import (
    CamForces,
    CamMotion,
    Cycle,
    DiscCam,
    Dwell,
    InfeasibleProblem,
    InputError,
    OscillatingFlat,
    Return,
    Rise,
    TranslatingFlat,
    TranslatingRoller,
    conjugate_cam,
    least_spring,
)
from tests.cams.placed import FOLLOWERS, TURNINGS, cam_of
from tests.internals.cams import PairForces, Surfaces
from tests.internals.formulas import NUMPY, evaluate, read
from tests.internals.numerics import Jet

Array = NDArray[np.float64]
ANGLES = np.linspace(0.001, 6.28, 401)
SLIDES = {"mass": "2 kg", "stiffness": "3 N/mm", "preload": "120 N", "gravity": "10 N", "viscous": "5 N s/m"}
TABLES = {"inertia": "0.02 kg m^2", "stiffness": "30 N m/rad", "preload": "9 N m"}


def forces(kind: str, turning: str = "counterclockwise", **arguments: Any) -> CamForces:
    cam = cam_of(kind, turning)
    drive = SLIDES if cam.displacement.axis == "length" else TABLES
    asked: dict[str, Any] = {"speed": "240 rpm", "drive": drive, **arguments}
    return CamForces(cam, **asked)


def moment(one: CamForces, drag: float = 0.0) -> Array:
    """The torque that the contact force asks of the cam, by statics in the cam's own coordinates."""
    point, normal = one.cam.profile(ANGLES), one.cam.profile.normal(ANGLES)
    # of a cam that turns, the surface runs past the face to the side where its turning takes the normal's foot
    side = TURNINGS[one.cam.turning] * np.stack([-normal[:, 1], normal[:, 0]], axis=1)
    runs = np.sign(np.sum(point * normal, axis=1))[:, None]
    pushed = np.asarray(one.contact_force(ANGLES))[:, None] * (normal + drag * runs * side)
    return np.asarray(TURNINGS[one.cam.turning] * (point[:, 0] * pushed[:, 1] - point[:, 1] * pushed[:, 0]))


@pytest.mark.parametrize("turning", sorted(TURNINGS))
@pytest.mark.parametrize("kind", sorted(FOLLOWERS))
def test_the_torque_is_that_of_the_contact_force_around_the_centre(kind: str, turning: str) -> None:
    """A face that is dragged along takes its torque from the cam too."""
    for drag in (0.0, 0.1) if "flat" in kind else (0.0,):
        forces_of_cam = forces(kind, turning, friction={"contact": drag})
        assert forces_of_cam.shaft_torque(ANGLES) == pytest.approx(moment(forces_of_cam, drag), abs=1e-9)


@pytest.mark.parametrize("kind", sorted(FOLLOWERS))
def test_without_friction_a_turn_takes_no_energy(kind: str) -> None:
    own = SLIDES if cam_of(kind).displacement.axis == "length" else TABLES
    forces_of_cam = forces(kind, drive={key: value for key, value in own.items() if key != "viscous"})
    low, high = forces_of_cam.mean_torque
    assert low <= 0.0 <= high
    assert high - low < 1e-7 * forces_of_cam.torque.most
    assert forces(kind, friction={"contact": 0.02}).mean_torque[0] > 1e-3 * forces_of_cam.torque.most


def test_what_friction_takes_is_the_energy_of_a_turn() -> None:
    forces_of_cam = forces("translating roller", drive=SLIDES | {"dry": "6 N"})
    stroke, rate = 0.03, forces_of_cam.rate
    angles = np.linspace(0.0, 2 * pi, 200_001)
    viscous = np.trapezoid(5.0 * rate * np.asarray(forces_of_cam.cam.displacement(angles, 1)) ** 2, angles)
    taken = 2.0 * 6.0 * stroke + float(viscous)
    low, high = forces_of_cam.mean_torque
    assert low * 2 * pi <= taken <= high * 2 * pi + 1e-9
    assert high - low < 1e-6


@pytest.mark.parametrize("kind", sorted(FOLLOWERS))
def test_extremes_with_friction_are_enclosed_and_near(kind: str) -> None:
    slides = cam_of(kind).displacement.axis == "length"
    friction = {"contact": 0.06} | ({"guide": 0.05, "overhang": "20 mm", "length": "60 mm"} if slides else {})
    drive = (SLIDES if slides else TABLES) | {"dry": "3 N" if slides else "0.4 N m"}
    forces_of_cam = forces(kind, friction=friction, drive=drive, speed="300 rpm", width="20 mm")
    angles = np.linspace(0.0, 2 * pi, 200_001)
    for found, values in (
        (forces_of_cam.contact, forces_of_cam.contact_force(angles)),
        (forces_of_cam.torque, forces_of_cam.shaft_torque(angles)),
        (forces_of_cam.pressure, forces_of_cam.contact_pressure(angles)),
    ):
        slack = 1e-12 * found.peak
        assert found.low - slack <= np.min(values) <= found.low + 1e-4 * found.peak
        assert found.high - 1e-4 * found.peak <= np.max(values) <= found.high + slack
        assert max(found.high - found.most, found.least - found.low) < 2e-8 * found.peak
    torque = np.asarray(forces_of_cam.shaft_torque(0.5 * (angles[1:] + angles[:-1])))
    assert forces_of_cam.mean_torque == pytest.approx([torque.mean()] * 2, rel=1e-4)
    assert forces_of_cam.rms_torque == pytest.approx([np.sqrt((torque**2).mean())] * 2, rel=1e-4)


def test_a_guide_with_friction_needs_more_and_jams_in_the_end() -> None:
    friction = {"guide": 0.15, "overhang": "60 mm", "length": "50 mm"}
    forces_of_cam = forces("translating roller", friction=friction)
    angle, tangent = 1.0, np.tan(forces_of_cam.cam.pressure_angle(1.0))
    cosine = 1.0 / np.hypot(1.0, tangent)
    # the guide bears sin(alpha) (a + b)/b at its near end and sin(alpha) a/b at its far one
    held = 0.15 * (2 * 0.06 + 0.05) / 0.05 * abs(tangent) * cosine
    assert forces_of_cam.contact_force(angle) == pytest.approx(
        forces_of_cam.follower_force(angle) / (cosine - held), rel=1e-12
    )
    jammed = forces("translating roller", friction={"guide": 0.5, "overhang": "100 mm", "length": "20 mm"})
    with pytest.raises(InputError, match=r"jams in its guide at .* deg of the cam: lessen the pressure angle"):
        jammed.contact  # noqa: B018


def test_a_light_follower_stays_and_a_heavy_one_lifts_off() -> None:
    assert not forces("translating flat").lifts_off
    assert forces("translating flat", drive={"mass": "8 kg", "preload": "10 N"}).lifts_off


def test_a_cycle_brings_its_speed_and_its_drive() -> None:
    cam = cam_of("translating flat")
    assert isinstance(cam.motion, Cycle)
    driven = replace(cam, motion=replace(cam.motion, drive={"mass": "1 kg"}))
    assert CamForces(driven).rate == pytest.approx(2 * pi)
    assert CamForces(driven).load.inertia == 1.0


def test_hertz_pressure_of_known_bodies() -> None:
    # two steel rollers, radii 20 mm and 30 mm, 10 mm wide, 1 kN: p = sqrt(F E / (2 pi (1 - nu²) L R))
    one = Surfaces(width="10 mm").line(0.02)
    assert one is not None
    radius = 1.0 / (1.0 / 0.02 + 1.0 / 0.03)
    known = np.sqrt(1000.0 * 210e9 / (2.0 * pi * (1.0 - 0.09) * 0.01 * radius))
    squared = one.squared(Jet((np.array([1000.0, -1.0]),)), Jet((1.0 / 0.03,))).terms[0]
    assert np.sqrt(squared[0]) == pytest.approx(known, rel=1e-12)
    assert squared[1] < 0.0
    with pytest.raises(InputError, match="concave"):
        one.squared(Jet((1.0,)), Jet((-1.0 / 0.01,)))


def test_wrong_entries_name_themselves_and_the_remedy() -> None:
    partial = DiscCam(
        CamMotion.of_law("cycloidal", "40 mm", "120 deg"), prime_radius="80 mm", follower=TranslatingRoller("12 mm")
    )
    for arguments, match in (
        ({"speed": "0 rpm"}, "speed must be above 0"),
        ({"speed": "3 mm"}, "speed must be an angular velocity"),
        ({"drive": {"inertia": "2 kg m^2"}}, "drive: unknown key 'inertia'"),
        ({"friction": {"contacts": 0.1}}, "did you mean 'contact'"),
        ({"friction": {"guide": 0.1}}, "needs overhang and length"),
        ({"friction": {"contact": -0.1}}, "contact must be at least 0"),
        ({"width": "0 mm"}, "width must be above 0"),
        ({"width": "1 mm", "materials": ("steel", "stee")}, "did you mean 'steel'"),
        ({"width": "1 mm", "materials": "steel"}, "materials must be a list of two, each steel, .* got 'steel'"),
    ):
        with pytest.raises(InputError, match=match):
            forces("translating roller", **arguments)
    with pytest.raises(InputError, match="give one, such as speed"):
        CamForces(partial, drive=SLIDES)
    with pytest.raises(InputError, match="give a drive, such as"):
        CamForces(cam_of("translating flat"))
    with pytest.raises(InputError, match="needs the width"):
        forces("translating flat").contact_pressure(1.0)


def test_the_pressure_is_told_where_the_follower_lifts_off() -> None:
    """Next to where the force vanishes the pressure is a root: its square is enclosed, and is smooth."""
    drive = {"mass": "20 kg", "stiffness": "3 N/mm", "preload": "60 N"}
    lifted = forces("translating roller", drive=drive, speed="300 rpm", width="20 mm")
    assert lifted.lifts_off
    pressed = lifted.contact_pressure(np.linspace(0.0, 2 * np.pi, 20_001))
    assert lifted.pressure.least == lifted.pressure.low == pressed.min() == 0.0
    assert pressed.max() <= lifted.pressure.high
    assert lifted.pressure.most == pytest.approx(pressed.max(), rel=1e-6)
    assert lifted.pressure.high == pytest.approx(lifted.pressure.most, rel=1e-7)


@pytest.mark.parametrize("turning", sorted(TURNINGS))
def test_an_arm_is_dragged_as_the_surfaces_slide(turning: str) -> None:
    """Where the face is touched beyond the line from the pivot to the shaft, the cam drags it the other way."""
    moves = [Rise("20 deg", "60 deg", law="cycloidal"), Return(None, "60 deg", law="cycloidal"), Dwell()]
    motion = Cycle(moves, period="1 s")
    cam = DiscCam(motion, "40 mm", OscillatingFlat("200 mm", face_offset="-100 mm"), turning=turning)  # type: ignore[arg-type]
    forces_of_cam = CamForces(cam, drive=TABLES | {"preload": "90 N m"}, friction={"contact": 0.1})
    side, s = TURNINGS[turning], np.asarray(cam.displacement(ANGLES))
    touched = (cam.profile(ANGLES) @ np.array([1.0, 1j])) * np.exp(1j * side * ANGLES)
    normal, arm = 1j * np.exp(-1j * (np.arcsin(0.7) + s)), touched - 0.2
    along = normal / 1j
    slip = ((1j * side * touched + 1j * np.asarray(cam.displacement(ANGLES, 1)) * arm) * along.conj()).real
    assert slip.min() < 0.0 < slip.max()
    pushed = normal + 0.1 * np.sign(slip) * along
    driven = -(arm.conj() * pushed).imag
    force = np.asarray(forces_of_cam.contact_force(ANGLES))
    assert force * driven == pytest.approx(np.asarray(forces_of_cam.follower_force(ANGLES)), rel=1e-9)
    assert forces_of_cam.contact.low <= force.min()
    assert force.max() <= forces_of_cam.contact.high


def test_surfaces_are_written_and_read_again() -> None:
    friction = {"contact": 0.05, "guide": 0.1, "overhang": "80 mm", "length": "120 mm"}
    own = {"young": "3 GPa", "poisson": 0.4}
    surfaces = Surfaces(friction, "20 mm", ("bronze", own))  # type: ignore[arg-type] # tables are read
    assert surfaces.to_dict() == {"friction": friction, "width": "20 mm", "materials": ["bronze", own]}
    assert Surfaces.from_dict(surfaces.to_dict()) == replace(surfaces, width="20 mm") == surfaces
    assert replace(surfaces.friction, contact=0.2).guide == 0.1


# --- process forces: by hand, over angle, time and way ---


MOVED = {"mass": "2 kg", "stiffness": "3 N/mm", "preload": "90 N", "dry": "4 N"}
SWUNG = {"inertia": "0.02 kg m^2", "stiffness": "30 N m/rad", "preload": "6 N m"}
EVERY_ANGLE = np.linspace(0.0, 2 * pi, 3601)[:-1] + 1e-4


def lines(pairs: list[tuple[float, float]]) -> list[tuple[str, str]]:
    return [(f"{place!r} deg", f"{value!r} N") for place, value in pairs]


def taken(process: dict[str, Any], kind: str = "translating roller", **given: Any) -> np.ndarray:
    """The force that a process takes off what moves the follower."""
    cam, drive = cam_of(kind), SWUNG if FOLLOWERS[kind][0].axis == "angle" else MOVED
    moved = {"speed": "60 rpm", "drive": drive, **given}
    with_process = CamForces(cam, process=process, **moved).follower_force(EVERY_ANGLE)
    return np.asarray(CamForces(cam, **moved).follower_force(EVERY_ANGLE) - with_process)


TABLE = [(0.0, 0.0), (40.0, 0.0), (150.0, 80.0), (150.0, -200.0), (222.0, -120.0), (222.0, 0.0), (360.0, 0.0)]


def stepped(places: np.ndarray) -> np.ndarray:
    ramps = [0.0 * places, 80.0 * (places - 40.0) / 110.0, -200.0 + 80.0 * (places - 150.0) / 72.0]
    return np.select([places < 40.0, places < 150.0, places < 222.0], ramps, 0.0)


def test_tables_over_the_angle_and_the_time_jump_where_a_place_stands_twice() -> None:
    by_angle = taken({"force": lines(TABLE), "over": "master"})
    assert by_angle == pytest.approx(stepped(np.degrees(EVERY_ANGLE)), abs=1e-9)
    seconds = [(f"{place / 180.0!r} s", f"{value!r} N") for place, value in TABLE]
    by_time = taken({"force": seconds}, speed="30 rpm")
    assert by_time == pytest.approx(stepped(np.degrees(EVERY_ANGLE)), abs=1e-9)


@pytest.mark.parametrize("kind", FOLLOWERS)
def test_a_formula_or_a_quantity_acts_on_every_follower(kind: str) -> None:
    name, size = ("torque", 3.0) if FOLLOWERS[kind][0].axis == "angle" else ("force", 50.0)
    unit = {"torque": "N m", "force": "N"}[name]
    assert taken({name: f"-{size} {unit}"}, kind) == pytest.approx(np.full(EVERY_ANGLE.shape, -size))
    wave = taken({name: f"{size}*sin(m)^2 - abs({size}*cos(m))", "over": "master"}, kind)
    assert wave == pytest.approx(size * np.sin(EVERY_ANGLE) ** 2 - np.abs(size * np.cos(EVERY_ANGLE)), abs=1e-9)
    assert taken({name: f"{size}*exp(-2*t)"}, kind) == pytest.approx(size * np.exp(-EVERY_ANGLE / pi), abs=1e-9)


def test_a_force_over_the_way_and_a_spline() -> None:
    cam = cam_of("translating roller")
    places, values = [0.0, 5.0, 12.0, 21.0, 30.0], [10.0, -40.0, 20.0, -60.0, -70.0]
    pairs = [(f"{place} mm", f"{value} N") for place, value in zip(places, values, strict=True)]
    way = 1e3 * np.asarray(cam.displacement(EVERY_ANGLE))
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
    near = np.concatenate([EVERY_ANGLE, np.radians([149.9999999, 150.0, 221.9999999])])

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


@pytest.mark.parametrize("over", ["master", "time", "driven", "input"])
def test_the_process_of_a_cycle_acts_on_the_cam_as_one_given_beside_it(over: str) -> None:
    places = {"master": ("0 deg", "360 deg"), "time": ("0 s", "1 s")}.get(over, ("0 mm", "40 mm"))
    load = {"over": over, "force": [(places[0], "0 N"), (places[1], "-250 N")]}
    moves = [Rise("40 mm", "150 deg", law="345"), Return(duration="150 deg", law="345"), Dwell()]
    bare, loaded = (
        DiscCam(Cycle(moves, speed="60 rpm", drive=MOVED, load=of), "50 mm", TranslatingFlat()) for of in (None, load)
    )
    process = load | {"over": "driven"} if over == "input" else load
    beside, own = CamForces(bare, process=process), CamForces(loaded)
    assert own.contact == beside.contact
    assert own.contact.most > CamForces(bare).contact.most + 50.0
    assert own.torque == beside.torque
    at_speed: dict[str, Any] = {"drive": {"mass": "2 kg"}, "speeds": ("60 rpm", "60 rpm"), "preload": "20 N"}
    assert least_spring(loaded, **at_speed) == least_spring(bare, process=process, **at_speed)


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


# --- springs ---


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
        ({"speeds": "300 rpm"}, r"speeds must be a list of two, each an angular velocity .*, got"),
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


# --- pairs ---


@pytest.mark.parametrize("drive", [{"mass": "2 kg"}, {"mass": "2 kg", "stiffness": "1 N/mm", "preload": "5 N"}])
@pytest.mark.parametrize("law", ["3-4-5", "modified trapezoid"])
def test_one_cam_of_a_pair_presses_with_what_the_follower_takes(drive: dict[str, str], law: str) -> None:
    moves = [Rise("40 mm", "100 deg", law=law), Dwell("50 deg"), Return("40 mm", "110 deg", law=law), Dwell()]
    cam = DiscCam(Cycle(moves, speed="350 rpm"), "70 mm", TranslatingRoller("15 mm", "5 mm"))
    second = conjugate_cam(cam, distance="220 mm")
    pair = PairForces(cam, drive=drive, width="15 mm", second=second)
    taken = np.asarray(CamForces(cam, drive=drive).follower_force(ANGLES))
    angles = np.where(taken >= 0.0, cam.pressure_angle(ANGLES), second.pressure_angle(ANGLES))
    np.testing.assert_allclose(pair.contact_force(ANGLES) * np.cos(angles), np.abs(taken), rtol=1e-9, atol=1e-9)
    # without friction the work is that of the follower, whichever cam does it
    np.testing.assert_allclose(pair.shaft_torque(ANGLES), taken * cam.displacement(ANGLES, 1), rtol=1e-9, atol=1e-9)
    of_return = np.abs(taken) / np.cos(angles) * (taken < 0.0)
    assert pair.contact_of_return.low <= of_return.max() <= pair.contact_of_return.high
    assert of_return.max() == pytest.approx(pair.contact_of_return.most, rel=2e-3)
    assert pair.contact.least >= -1e-6
    assert not pair.lifts_off
    pressed = [(low <= ANGLES) & (high >= ANGLES) for low, high in pair.pressed_by_return]
    np.testing.assert_array_equal(np.any(pressed, axis=0), taken < -1e-9)
    # a roller of 15 mm, and the pitch curve's curvature of the return cam
    curvature = 1.0 / np.asarray(second.radius_of_curvature(ANGLES))
    squared = of_return * (curvature + 1.0 / 15e-3) * 210e9 / (2.0 * (1.0 - 0.09)) / (pi * 15e-3)
    assert np.sqrt(squared.max()) == pytest.approx(pair.pressure_of_return.most, rel=2e-3)


def test_friction_of_a_pair_takes_power_on_both_cams() -> None:
    moves = [Rise("40 mm", "100 deg", law="3-4-5"), Dwell("50 deg"), Return("40 mm", "110 deg", law="3-4-5"), Dwell()]
    cam = DiscCam(Cycle(moves, speed="350 rpm"), "70 mm", TranslatingRoller("15 mm"))
    pair = PairForces(
        cam, drive={"mass": "2 kg"}, friction={"contact": 0.1}, second=conjugate_cam(cam, distance="220 mm")
    )
    smooth = PairForces(cam, drive={"mass": "2 kg"}, second=conjugate_cam(cam, distance="220 mm"))
    more = np.asarray(pair.shaft_torque(ANGLES)) - np.asarray(smooth.shaft_torque(ANGLES))
    assert more.min() > -1e-9
    for low, high in pair.pressed_by_return:
        assert np.interp(np.linspace(low, high, 9)[1:-1], ANGLES, more).max() > 0.1
    assert pair.mean_torque[0] > 0.1
