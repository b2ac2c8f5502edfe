from dataclasses import replace
from math import pi
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from optlaws import (
    CamForces,
    CamMotion,
    Cycle,
    DiscCam,
    Dwell,
    InputError,
    OscillatingFlat,
    Return,
    Rise,
    TranslatingRoller,
)
from tests.cams.placed import FOLLOWERS, TURNINGS, cam_of
from tests.internals.cams import Surfaces
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
    forces_of_cam = forces(kind, turning)
    assert forces_of_cam.shaft_torque(ANGLES) == pytest.approx(moment(forces_of_cam), abs=1e-9)


@pytest.mark.parametrize("kind", ["translating flat", "inclined flat", "oscillating flat"])
def test_a_face_that_is_dragged_along_takes_its_torque_from_the_cam(kind: str) -> None:
    forces_of_cam = forces(kind, friction={"contact": 0.1})
    assert forces_of_cam.shaft_torque(ANGLES) == pytest.approx(moment(forces_of_cam, 0.1), abs=1e-9)


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
def test_extremes_are_enclosed_over_the_turn(kind: str) -> None:
    forces_of_cam = forces(kind, width="20 mm")
    for found, values in (
        (forces_of_cam.contact, forces_of_cam.contact_force(ANGLES)),
        (forces_of_cam.torque, forces_of_cam.shaft_torque(ANGLES)),
        (forces_of_cam.pressure, forces_of_cam.contact_pressure(ANGLES)),
    ):
        assert found.low <= np.min(values)
        assert np.max(values) <= found.high
        assert found.most - np.max(values) < 1e-2 * found.peak
        assert found.high - found.most < 1e-6 * found.peak
    squares = np.trapezoid(np.asarray(forces_of_cam.shaft_torque(ANGLES)) ** 2, ANGLES) / (2 * pi)
    assert forces_of_cam.rms_torque[0] == pytest.approx(np.sqrt(squares), rel=1e-3)


@pytest.mark.sample(4)
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
        ({"width": "1 mm", "materials": "steel"}, "materials must be a list of steel, .* got 'steel'"),
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
