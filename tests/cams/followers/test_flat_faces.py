"""Flat faces: the inclined one beside the square one, and how long a face must be."""

import json
from math import cos, pi, radians, tan
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.optimize import brentq

from optlaws import (
    CamForces,
    Cycle,
    DiscCam,
    Dwell,
    InclinedFlat,
    InfeasibleProblem,
    InputError,
    OscillatingFlat,
    Return,
    Rise,
    TranslatingFlat,
    as_made,
    best_cam,
    best_prime_circle,
    conjugate_cam,
    least_prime_circle,
    least_spring,
)
from tests.cams.placed import TURNINGS, face_lines, points
from tests.internals.explorer import CycleRequest, cam_view
from tests.internals.jobs import job, read_of_cam

Array = NDArray[np.float64]
ANGLES = np.linspace(0.0, 2.0 * np.pi, 241)[:-1] + 0.003
DRIVE = {"mass": "2 kg", "stiffness": "3 N/mm", "preload": "150 N"}
FRICTION = {"contact": 0.1, "guide": 0.15, "overhang": "20 mm", "length": "80 mm"}
VALVE = Cycle([Rise("10 mm", "70 deg"), Return("10 mm", "70 deg"), Dwell()], speed="3000 rpm", degree=5)


def cycle_of(stroke: float) -> Cycle:
    moves = [Rise(f"{stroke!r} mm", "140 deg", law="cycloidal"), Dwell("40 deg"), Return(None, "120 deg", law="3-4-5")]
    return Cycle([*moves, Dwell()], speed="240 rpm")


def cam_of(inclination: float, turning: str = "counterclockwise", stroke: float = 12.0) -> DiscCam:
    return DiscCam(cycle_of(stroke), "70 mm", InclinedFlat(f"{inclination!r} deg"), turning=turning)  # type: ignore[arg-type]


@pytest.mark.parametrize("turning", TURNINGS)
def test_without_inclination_it_is_the_square_face(turning: str) -> None:
    cam = cam_of(0.0, turning)
    square = DiscCam(cam.motion, "70 mm", TranslatingFlat(), turning=turning)  # type: ignore[arg-type]
    for nu in range(4):
        assert np.abs(cam.profile(ANGLES, nu) - square.profile(ANGLES, nu)).max() < 1e-12
    assert np.abs(cam.pressure_angle(ANGLES)).max() == 0.0
    assert np.abs(np.asarray(cam.radius_of_curvature(ANGLES)) - square.radius_of_curvature(ANGLES)).max() < 1e-12
    assert cam.extremes.least_convex_radius.value == pytest.approx(square.extremes.least_convex_radius.value, rel=1e-12)
    one, two = (CamForces(disc, drive=DRIVE, friction=FRICTION, width="20 mm") for disc in (cam, square))
    for curve in ("contact_force", "shaft_torque", "contact_pressure"):
        assert getattr(one, curve)(ANGLES) == pytest.approx(getattr(two, curve)(ANGLES), rel=1e-12, abs=1e-12)
    assert one.rms_torque == pytest.approx(two.rms_torque, rel=1e-9)
    pairs = [conjugate_cam(disc, distance="170 mm").profile(ANGLES) for disc in (cam, square)]
    assert np.abs(pairs[0] - pairs[1]).max() < 1e-12
    assert as_made(cam, points=91).to_dict() == pytest.approx(as_made(square, points=91).to_dict(), rel=1e-6)


@pytest.mark.parametrize("turning", TURNINGS)
@pytest.mark.parametrize("inclination", [-35.0, 10.0])
def test_its_cam_is_that_of_a_square_face_with_a_shorter_stroke(inclination: float, turning: str) -> None:
    cosine, cam = cos(radians(inclination)), cam_of(inclination, turning)
    square = DiscCam(cycle_of(12.0 * cosine), "70 mm", TranslatingFlat(), turning=turning)  # type: ignore[arg-type]
    turned = points(square.profile(ANGLES)) * np.exp(1j * radians(inclination))
    assert np.abs(points(cam.profile(ANGLES)) - turned).max() < 1e-15
    assert cam.pressure_angle(ANGLES) == pytest.approx(TURNINGS[turning] * radians(inclination), abs=1e-15)
    worst = cam.extremes.greatest_pressure_angle
    assert worst.low <= abs(radians(inclination)) <= worst.high
    least, other = cam.extremes.least_convex_radius, square.extremes.least_convex_radius
    assert least.low <= other.high
    assert other.low <= least.high
    assert cam.extremes.undercut.simple


@pytest.mark.parametrize("turning", TURNINGS)
@pytest.mark.parametrize("inclination", [-25.0, 15.0])
def test_forces_are_those_of_statics(inclination: float, turning: str) -> None:
    """Cam, guide at two places, and inertia in balance, with the contact where the dense profile meets the face."""
    cam = cam_of(inclination, turning)
    forces = CamForces(cam, drive=DRIVE, friction=FRICTION)
    side, tilt = TURNINGS[turning], np.exp(1j * radians(inclination))
    overhang, length, grip, guide = 0.02, 0.08, 0.1, 0.15
    profile = points(cam.profile(np.linspace(0.0, 2.0 * np.pi, 40_001)))
    for angle in (0.5, 1.1, 1.9, 3.6, 4.4):
        seen = profile * np.exp(1j * side * angle)
        touched = seen[int(np.argmax((seen * np.conj(1j * tilt)).real))]
        up = float(np.sign(cam.displacement(angle, 1)))
        slip = ((1j * side * touched - 1j * cam.displacement(angle, 1)) * np.conj(tilt)).real
        pushed = 1j * tilt + grip * np.sign(slip) * tilt  # for a normal force of 1 N
        moments = [touched.real * pushed.imag + far * pushed.real for far in (overhang, overhang + length)]
        driven = pushed.imag - up * guide * sum(map(abs, moments)) / length
        taken = forces.follower_force(angle)
        normal = brentq(lambda force, driven=driven, taken=taken: force * driven - taken, 0.0, 1e5, xtol=1e-12)
        assert forces.contact_force(angle) == pytest.approx(normal, rel=1e-4)
        torque = side * (touched.conjugate() * pushed).imag * normal
        assert forces.shaft_torque(angle) == pytest.approx(torque, abs=3e-5 * abs(normal))
    dense = np.asarray(forces.contact_force(ANGLES))
    assert forces.contact.low <= dense.min()
    assert dense.max() <= forces.contact.high


def test_a_face_touched_below_the_shaft_is_dragged_the_other_way() -> None:
    swift = Cycle(
        [Rise("60 mm", "100 deg", law="cycloidal"), Return(None, "100 deg", law="cycloidal"), Dwell()], period="1 s"
    )
    cam = DiscCam(swift, "40 mm", InclinedFlat("-70 deg"))
    forces = CamForces(cam, drive=DRIVE | {"preload": "2000 N"}, friction={"contact": 0.05})
    angles = np.linspace(0.02, 6.2, 2001)
    level = (points(cam.profile(angles)) * np.exp(1j * angles)).imag
    assert level.min() < 0.0 < level.max()
    driven = np.asarray(forces.follower_force(angles)) / np.asarray(forces.contact_force(angles))
    tilt = radians(-70.0)
    assert driven == pytest.approx(cos(tilt) - 0.05 * np.sign(level) * np.sin(tilt), rel=1e-9)
    dense = np.asarray(forces.contact_force(angles))
    assert forces.contact.low <= dense.min()
    assert dense.max() <= forces.contact.high <= 1.01 * dense.max()


def test_a_pair_holds_its_faces_at_their_distance() -> None:
    first = cam_of(10.0)
    second = conjugate_cam(first, distance="170 mm")
    normals, far = face_lines(first, ANGLES)
    apart = 0.17 * cos(radians(10.0))
    heights = (points(second.profile(ANGLES))[:, None] * -normals.conj()[None, :]).real
    assert np.allclose(np.diag(heights), apart - far, atol=1e-15)
    assert (heights <= apart - far[None, :] + 1e-15).all()


def test_least_sizes_and_best_laws_are_those_of_the_shorter_stroke() -> None:
    cosine, turns = cos(radians(20.0)), np.linspace(0.0, 2.0 * np.pi, 200_001)
    motion = cam_of(20.0).displacement
    needed = 0.02 - cosine * float(np.min(motion(turns) + motion(turns, 2)))
    least = least_prime_circle(motion, InclinedFlat("20 deg"), radius_of_curvature="20 mm")
    assert least.radius == pytest.approx(needed, rel=1e-7)
    assert least.proven
    with pytest.raises(InfeasibleProblem, match="no prime circle keeps a pressure angle of 15 deg"):
        least_prime_circle(motion, InclinedFlat("20 deg"), pressure_angle="15 deg")
    for reached in ("20 deg", f"{radians(20.0)!r} rad"):
        within = least_prime_circle(motion, InclinedFlat("20 deg"), pressure_angle=reached, radius_of_curvature="20 mm")
        assert within.radius == least.radius
    square = best_prime_circle(VALVE, TranslatingFlat(), radius_of_curvature="3 mm")
    inclined = best_prime_circle(VALVE, InclinedFlat("20 deg"), radius_of_curvature="3 mm")
    assert inclined.lower_bound == pytest.approx(0.003 + cosine * (square.lower_bound - 0.003), rel=1e-6)
    assert inclined.least.radius == pytest.approx(inclined.lower_bound, rel=1e-6)
    base = f"{1.05 * inclined.lower_bound!r} m"
    bound = best_cam(VALVE, base, InclinedFlat("20 deg"), radius_of_curvature="3 mm")
    assert bound.status.value == "optimal"
    assert bound.cam.extremes.least_convex_radius.low == pytest.approx(0.003, rel=1e-6)
    with pytest.raises(InputError, match="20 deg, whatever the law"):
        best_cam(VALVE, "11 mm", InclinedFlat("20 deg"), pressure_angle="10 deg")


def test_what_depends_on_the_square_of_forces_and_springs_is_enclosed() -> None:
    forces = CamForces(cam_of(15.0), drive=DRIVE, width="20 mm")
    low, high = forces.mean_torque
    assert low <= 0.0 <= high
    # without friction the normal's part along the way carries the follower
    assert forces.contact_force(1.0) * cos(radians(15.0)) == pytest.approx(forces.follower_force(1.0), rel=1e-12)
    assert np.asarray(forces.contact_pressure(ANGLES)).max() <= forces.pressure.high
    spring = least_spring(cam_of(15.0), drive={"mass": "2 kg"}, speeds=("0 rpm", "300 rpm"), preload="20 N")
    assert spring.margin >= -1e-6


@pytest.mark.parametrize("inclination", ["90 deg", "-100 deg", "5 mm"])
def test_inclinations_that_lift_nothing_are_refused(inclination: str) -> None:
    with pytest.raises(InputError, match="inclination"):
        DiscCam(cycle_of(12.0), "70 mm", InclinedFlat(inclination))


FILE = """
job = "cam"
title = "Small"
speed = "200 rpm"
prime_radius = "60 mm"
pressure_angle = "30 deg"
radius_of_curvature = "20 mm"
cutter_radius = "10 mm"
rows = 13
animation = true
forces = { width = "20 mm", friction = { contact = 0.05 } }
as_made = { points = [181], decimals = [4] }
pair = { distance = "190 mm" }
follower = { kind = "inclined flat", inclination = "10 deg" }
[[file]]
name = "cam.dxf"
[[file]]
name = "cam.nc"
curve = "cutter"
cutter_radius = "8 mm"
[motion]
name = "slide"
drive = { mass = "2 kg", stiffness = "3 N/mm", preload = "150 N" }
[[motion.segment]]
kind = "rise"
by = "12 mm"
duration = "120 deg"
law = "3-4-5"
[[motion.segment]]
kind = "return"
duration = "100 deg"
law = "3-4-5"
[[motion.segment]]
kind = "dwell"
"""


def run(folder: Path, text: str) -> tuple[dict[str, Any], set[str]]:
    file = folder / "inclined.toml"
    file.write_text(text, "utf-8")
    written = job.done(file).write(folder / "out")
    return json.loads((folder / "out" / "cam.json").read_text("utf-8")), {path.name for path in written}


def test_problem_files_take_it_with_all_that_a_cam_has(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("optlaws.plots.style.rendered", lambda *_: b"")
    values, names = run(tmp_path, FILE)
    assert {"cam.dxf", "cam.nc", "return-cam.dxf", "pair.svg", "forces.svg", "animation.svg"} <= names
    assert tan(values["greatest_pressure_angle"]["high"]) == pytest.approx(tan(radians(10.0)), rel=1e-12)
    assert values["least_prime_circle"]["proven"]
    assert "greatest_roller" not in values
    assert values["forces"]["contact"]["least"] > 0.0
    assert all(abs(peaks["acceleration_ratio"] - 1.0) < 0.1 for peaks in values["as_made"].values())
    with pytest.raises(InputError, match="an inclined flat needs its inclination, such as inclination = '10 deg'"):
        run(tmp_path, FILE.replace(', inclination = "10 deg"', ""))
    with pytest.raises(InputError, match="of an inclined flat 'radius'; known are face_length, inclination"):
        run(tmp_path, FILE.replace('inclination = "10 deg"', 'radius = "10 mm"'))


# --- length of the face ---


STUDY = {
    "job": "cam",
    "title": "A flat face",
    "period": "1 s",
    "prime_radius": "80 mm",
    "follower": {"kind": "translating flat", "face_length": "40 mm"},
    "motion": {
        "name": "slide",
        "segment": [
            {"kind": "rise", "by": "50 mm", "duration": "180 deg", "law": "simple harmonic"},
            {"kind": "return", "law": "simple harmonic"},
        ],
    },
}


def harmonic(stroke: float, rise: float, back: float) -> Cycle:
    """A harmonic rise and return over angles in degrees, with a dwell for the rest of the turn."""
    moves = [
        Rise(f"{stroke!r} mm", f"{rise!r} deg", law="simple harmonic"),
        Dwell(f"{0.5 * (360.0 - rise - back)!r} deg"),
        Return(duration=f"{back!r} deg", law="simple harmonic"),
        Dwell(),
    ]
    return Cycle(moves, period="1 s")


@given(
    stroke=st.floats(1e-3, 1e6),
    rise=st.floats(60.0, 170.0),
    back=st.floats(60.0, 170.0),
    inclination=st.floats(-40.0, 40.0),
    turning=st.sampled_from(["counterclockwise", "clockwise"]),
)
def test_a_harmonic_motion_needs_the_sum_of_its_steepest_slopes(
    stroke: float, rise: float, back: float, inclination: float, turning: str
) -> None:
    follower = InclinedFlat(f"{inclination!r} deg", face_length="1 m")
    cam = DiscCam(harmonic(stroke, rise, back), f"{9.0 * stroke!r} mm", follower, turning=turning)  # type: ignore[arg-type]
    needed = 0.5e-3 * stroke * (180.0 / rise + 180.0 / back) * cos(radians(inclination))
    *ends, length = (size.extreme for size in cam.extremes.sizes)
    assert length.value == pytest.approx(needed, rel=1e-8)
    assert length.low <= ends[1].value - ends[0].value <= length.high


@pytest.mark.parametrize("turning", ["counterclockwise", "clockwise"])
def test_a_swinging_face_is_touched_where_the_profile_is(turning: str) -> None:
    moves = [Rise("15 deg", "120 deg", law="cycloidal"), Return(duration="150 deg", law="cycloidal"), Dwell()]
    follower = OscillatingFlat("120 mm", face_offset="8 mm", face_length="90 mm")
    cam = DiscCam(Cycle(moves, period="1 s"), "40 mm", follower, turning=turning)  # type: ignore[arg-type]
    angles = np.linspace(0.0, 2.0 * pi, 20_001)
    x, y = cam.profile(angles).T
    turn = {"counterclockwise": 1.0, "clockwise": -1.0}[turning] * angles
    contact = np.column_stack([np.cos(turn) * x - np.sin(turn) * y, np.sin(turn) * x + np.cos(turn) * y])
    # the face is square to the offset from the pivot, so that its way from there is what is left of the distance
    along = np.sqrt(np.sum((contact - [0.12, 0.0]) ** 2, axis=1) - 0.008**2)
    least, greatest, length = (size.extreme for size in cam.extremes.sizes)
    assert least.value == pytest.approx(along.min(), rel=1e-7)
    assert greatest.value == pytest.approx(along.max(), rel=1e-7)
    assert length.value == pytest.approx(np.ptp(along), rel=1e-6)


@pytest.mark.parametrize(("given_length", "kept"), [("50 mm", True), ("49.999 mm", False)])
def test_a_harmonic_of_50_mm_over_half_turns_needs_50_mm(given_length: str, *, kept: bool) -> None:
    moves = [Rise("50 mm", "180 deg", law="simple harmonic"), Return(law="simple harmonic")]
    cam = DiscCam(Cycle(moves, period="1 s"), "80 mm", TranslatingFlat(face_length=given_length))
    assert cam.extremes.sizes[-1].within == kept
    assert ("beyond what is allowed" in str(cam.summary())) != kept


def test_a_face_that_is_too_short_is_reported_by_job_and_page() -> None:
    length = read_of_cam(STUDY, Path("flat.toml")).data["length_of_face"]
    assert length["low"] == pytest.approx(0.05, rel=1e-9)
    assert (length["limit"], length["kept"]) == (0.04, False)
    trust = cam_view.answer(CycleRequest(study=STUDY))["trust"]
    assert trust["word"] == "beyond a limit"
    assert "the length of face, 50 mm of 40 mm" in trust["advice"]
    kinds = next(entry for entry in cam_view.form()["entries"] if entry["name"] == "follower")["kinds"]
    offered = {kind for kind, entries in kinds.items() if any(entry["name"] == "face_length" for entry in entries)}
    assert offered == {"translating flat", "inclined flat", "oscillating flat"}


def test_no_length_is_said_where_none_is_given() -> None:
    assert DiscCam(harmonic(50.0, 150.0, 150.0), "80 mm", TranslatingFlat()).extremes.sizes == ()
    with pytest.raises(InputError, match="face_length must be above 0, got '0 mm'"):
        TranslatingFlat(face_length="0 mm")
