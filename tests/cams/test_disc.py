"""Disc, conjugate and barrel cams: their curves against followers that are put where they belong by trigonometry."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from optlaws import (
    BarrelCam,
    CamMotion,
    Cycle,
    DiscCam,
    Dwell,
    InputError,
    OscillatingFlat,
    OscillatingRoller,
    PiecewiseLaw,
    Return,
    Rise,
    TranslatingFlat,
    TranslatingRoller,
    conjugate_cam,
)
from tests.cams.placed import FOLLOWERS, TURNINGS, cam_of, cycle_of, face_lines, points, roller_centres
from tests.internals.cams import FREE, UNDERCUT, CamFollower
from tests.internals.laws import PolynomialSegment

ANGLES = np.linspace(0.0, 2 * np.pi, 241)[:-1] + 0.003
BOTH = [(kind, turning) for kind in FOLLOWERS for turning in TURNINGS]
ROLLERS = [(kind, turning) for kind, turning in BOTH if "roller" in kind]
FACES = [(kind, turning) for kind, turning in BOTH if "flat" in kind]


@pytest.mark.parametrize(("kind", "turning"), ROLLERS)
def test_a_roller_touches_the_profile_and_never_cuts_it(kind: str, turning: str) -> None:
    cam = cam_of(kind, turning)
    centres, profile = roller_centres(cam, ANGLES), points(cam.profile(ANGLES))
    assert np.allclose(points(cam.pitch_curve(ANGLES)), centres, atol=1e-15)
    distances = np.abs(profile[:, None] - centres[None, :])
    assert np.allclose(np.diag(distances), 0.012, atol=1e-15)
    assert distances.min() >= 0.012 - 1e-15
    assert np.abs(profile).max() < np.abs(centres).max()


@pytest.mark.parametrize(("kind", "turning"), FACES)
def test_a_face_touches_the_profile_and_never_cuts_it(kind: str, turning: str) -> None:
    cam = cam_of(kind, turning)
    normals, far = face_lines(cam, ANGLES)
    heights = (points(cam.profile(ANGLES))[:, None] * normals.conj()[None, :]).real
    assert np.allclose(np.diag(heights), far, atol=1e-15)
    assert (heights <= far[None, :] + 1e-15).all()


@pytest.mark.parametrize(("kind", "turning"), BOTH)
def test_the_base_circle_touches_the_profile_from_inside(kind: str, turning: str) -> None:
    cam = cam_of(kind, turning)
    radii = [np.hypot(*curve(np.linspace(0.0, 2 * np.pi, 2881)).T).min() for curve in (cam.profile, cam.pitch_curve)]
    assert radii[0] == pytest.approx(cam.base_radius, rel=1e-9)
    if "roller" in kind:  # the prime circle touches the pitch curve likewise
        assert radii[1] == pytest.approx(cam.base_radius + 0.012, rel=1e-9)


@pytest.mark.parametrize(("kind", "turning"), ROLLERS)
def test_the_pressure_angle_is_between_the_normal_and_the_way_of_the_roller(kind: str, turning: str) -> None:
    cam, step = cam_of(kind, turning), 1e-6
    still = TURNINGS[turning] * 1j * ANGLES
    beside = [
        roller_centres(cam, ANGLES + side) * np.exp(still + TURNINGS[turning] * 1j * side) for side in (-step, step)
    ]
    way = (beside[1] - beside[0]) / (2 * step)
    outward = points(cam.profile.normal(ANGLES)) * np.exp(still)
    moving = np.abs(way) > 1e-3
    between = np.angle(outward[moving] / way[moving])
    folded = np.abs(np.where(np.abs(between) > np.pi / 2, np.pi - np.abs(between), np.abs(between)))
    assert moving.sum() > 100
    assert np.allclose(np.abs(cam.pressure_angle(ANGLES))[moving], folded, atol=2e-7)


def test_the_pressure_angle_of_a_slide_has_the_textbooks_formula() -> None:
    cam = cam_of("translating roller")
    s, slope = cam.displacement(ANGLES), cam.displacement(ANGLES, 1)
    expected = (slope - 0.009) / (np.sqrt(0.07**2 - 0.009**2) + s)
    assert np.allclose(np.tan(cam.pressure_angle(ANGLES)), expected, rtol=1e-13, atol=1e-15)
    other = np.tan(cam_of("translating roller", "clockwise").pressure_angle(ANGLES))
    assert np.allclose(other, (slope + 0.009) / (np.sqrt(0.07**2 - 0.009**2) + s), rtol=1e-13, atol=1e-15)


def test_the_radius_under_a_flat_face_is_that_of_the_textbooks() -> None:
    cam = cam_of("translating flat")
    expected = 0.07 + cam.displacement(ANGLES) + cam.displacement(ANGLES, 2)
    assert np.allclose(cam.radius_of_curvature(ANGLES), expected, rtol=1e-13)
    assert np.allclose(cam.profile.radius_of_curvature(ANGLES), expected, rtol=1e-10)


@pytest.mark.sample(3)
@pytest.mark.parametrize("law", ["cycloidal", "polynomial 4-5-6-7", "modified sine"])
@pytest.mark.parametrize(("kind", "turning"), BOTH)
def test_curvature_and_derivatives_are_those_of_the_curves(kind: str, turning: str, law: str) -> None:
    cam, step = cam_of(kind, turning, law), 1e-5
    inner = ANGLES[np.abs(ANGLES[:, None] - np.array(cam.profile.breaks)).min(axis=1) > 3 * step]
    for curve in (cam.pitch_curve, cam.profile, cam.cutter_path("20 mm")):
        for nu in (1, 2, 3):
            differences = (curve(inner + step, nu - 1) - curve(inner - step, nu - 1)) / (2 * step)
            assert np.allclose(curve(inner, nu), differences, atol=2e-6)
        first, second = points(curve(inner, 1)), points(curve(inner, 2))
        expected = -TURNINGS[turning] * (first.conj() * second).imag / np.abs(first) ** 3
        assert np.allclose(curve.curvature(inner), expected, rtol=1e-8)
    assert np.allclose(cam.radius_of_curvature(inner), cam.profile.radius_of_curvature(inner), rtol=1e-8)


def test_profile_and_cutter_path_are_parallel_curves() -> None:
    cam = cam_of("oscillating roller")
    cutter, profile = cam.cutter_path("25 mm"), cam.profile
    assert np.allclose(cutter(ANGLES) - profile(ANGLES), 0.025 * profile.normal(ANGLES), atol=1e-15)
    assert np.allclose(cutter.radius_of_curvature(ANGLES), profile.radius_of_curvature(ANGLES) + 0.025, rtol=1e-10)
    assert np.allclose(cutter(ANGLES + 2 * np.pi), cutter(ANGLES), atol=1e-14)


@pytest.mark.parametrize(
    ("follower", "stroke", "radius", "message"),
    [
        (TranslatingRoller("12 mm", offset="90 mm"), "30 mm", "80 mm", "offset 90 mm is beyond the prime circle"),
        (TranslatingRoller("90 mm"), "30 mm", "80 mm", "make the roller smaller or the prime circle larger"),
        (OscillatingRoller("5 mm", "30 mm", "120 mm"), "20 deg", "80 mm", "too short: .* make it longer than 40 mm"),
        (OscillatingRoller("5 mm", "230 mm", "120 mm"), "20 deg", "80 mm", "too long: .* shorter than 200 mm"),
        (OscillatingRoller("5 mm", "100 mm", "150 mm"), "170 deg", "80 mm", "dead centre"),
        (OscillatingFlat("50 mm"), "6 deg", "80 mm", "put it farther than 80 mm"),
        (OscillatingFlat("150 mm"), "80 deg", "80 mm", "make the swing smaller or pivot_distance greater"),
        (OscillatingFlat("150 mm"), "20 mm", "80 mm", "take a translating follower"),
        (TranslatingFlat(), "20 mm", "0 mm", "prime_radius must be above 0"),
        (TranslatingFlat(), "20 mm", "80", "without a unit"),
    ],
)
def test_what_cannot_be_built_is_refused(follower: CamFollower, stroke: str, radius: object, message: str) -> None:
    with pytest.raises(InputError, match=message):
        DiscCam(cycle_of(stroke), radius, follower)  # type: ignore[arg-type]


def test_wrong_motions_and_words_are_refused() -> None:
    roller: Any = TranslatingRoller("12 mm")
    wrong: Any = "roller"
    kinked = PiecewiseLaw([0, 0.5, 1], [PolynomialSegment((), b0) for b0 in (0.5, 1.5)])
    with pytest.raises(InputError, match="unknown turning"):
        DiscCam(cycle_of("20 mm"), "80 mm", roller, turning="anticlockwise")  # type: ignore[arg-type]
    with pytest.raises(InputError, match="TranslatingRoller, TranslatingFlat"):
        DiscCam(cycle_of("20 mm"), "80 mm", wrong)
    with pytest.raises(InputError, match=r"CamMotion\.of_law"):
        DiscCam(wrong, "80 mm", roller)
    with pytest.raises(InputError, match="velocity jumps at 40 deg"):
        DiscCam(CamMotion.of_law(kinked, "20 mm", "80 deg"), "80 mm", roller)
    with pytest.raises(InputError, match="direction"):
        CamMotion.of_law("cycloidal", "20 mm", "90 deg", "down")  # type: ignore[arg-type]
    with pytest.raises(InputError, match="take a Cycle for the whole of it"):
        DiscCam(CamMotion.of_law("cycloidal", "20 mm", "90 deg"), "80 mm", roller).profile(3.0)


def test_a_textbooks_harmonic_cam_is_an_eccentric_circle() -> None:
    """A much used exercise: a flat face, 50 mm of simple harmonic motion out and back in a turn, least radius 25 mm.

    Its contour is a circle of 50 mm about a point 25 mm off, and the face is touched up to 25 mm to both sides.
    """
    moves = [kind("50 mm", "180 deg", law="simple harmonic") for kind in (Rise, Return)]
    cam = DiscCam(Cycle(moves, period="1 s"), "25 mm", TranslatingFlat())
    assert np.allclose(np.abs(points(cam.profile(ANGLES)) + 0.025j), 0.05, atol=1e-15)
    assert cam.extremes.least_convex_radius.low <= 0.05 <= cam.extremes.least_convex_radius.high
    assert cam.extremes.undercut.simple
    assert cam.displacement.slopes == pytest.approx((-0.025, 0.025), rel=1e-12)


# --- conjugate cams ---


@pytest.mark.parametrize("turning", TURNINGS)
def test_a_second_roller_on_the_slide_keeps_its_distance(turning: str) -> None:
    first = cam_of("translating roller", turning)
    second = conjugate_cam(first, TranslatingRoller("9 mm", offset="-4 mm"), distance="180 mm")
    still = np.exp(1j * TURNINGS[turning] * ANGLES)
    above, beneath = (points(one.pitch_curve(ANGLES)) * still for one in (first, second))
    assert np.allclose(above - beneath, 0.013 + 0.18j, atol=1e-15)
    distances = np.abs(points(second.profile(ANGLES))[:, None] - (beneath / still)[None, :])
    assert np.allclose(np.diag(distances), 0.009, atol=1e-15)
    assert distances.min() >= 0.009 - 1e-15
    assert second.extremes.undercut.free


@pytest.mark.parametrize("turning", TURNINGS)
def test_a_second_roller_on_the_pivot_keeps_its_angle(turning: str) -> None:
    first = cam_of("oscillating roller", turning)
    second = conjugate_cam(first, OscillatingRoller("9 mm", "80 mm", "120 mm"), angle="85 deg")
    still = np.exp(1j * TURNINGS[turning] * ANGLES)
    arms = [points(one.pitch_curve(ANGLES)) * still - 0.12 for one in (first, second)]
    assert np.allclose(np.abs(arms[1]), 0.08, atol=1e-15)
    assert np.allclose(np.degrees(np.angle(arms[1] / arms[0])), 85.0, atol=1e-11)
    distances = np.abs(points(second.profile(ANGLES))[:, None] - points(second.pitch_curve(ANGLES))[None, :])
    assert np.allclose(np.diag(distances), 0.009, atol=1e-15)
    assert distances.min() >= 0.009 - 1e-15
    assert (second.profile.curvature(ANGLES) > 0).any()


@pytest.mark.parametrize("turning", TURNINGS)
def test_faces_hold_a_cam_between_them(turning: str) -> None:
    first = cam_of("translating flat", turning)
    second = conjugate_cam(first, distance="170 mm")
    normals, far = face_lines(first, ANGLES)
    heights = (points(second.profile(ANGLES))[:, None] * -normals.conj()[None, :]).real
    assert np.allclose(np.diag(heights), 0.17 - far, atol=1e-15)
    assert (heights <= 0.17 - far[None, :] + 1e-15).all()
    swung = cam_of("oscillating flat", turning)
    third = conjugate_cam(swung, angle="55 deg")
    normals, _ = face_lines(swung, ANGLES)
    turned = normals * np.exp(1j * np.radians(55.0 + 180.0))
    heights = (points(third.profile(ANGLES))[:, None] * turned.conj()[None, :]).real
    assert np.allclose(heights.max(axis=0), np.diag(heights), atol=1e-12)


def test_the_return_cam_of_a_return_cam_is_the_first() -> None:
    first = cam_of("oscillating roller")
    again = conjugate_cam(conjugate_cam(first, angle="85 deg"), angle="85 deg")
    assert np.allclose(again.profile(ANGLES), first.profile(ANGLES), atol=1e-14)
    slide = cam_of("translating roller")
    again = conjugate_cam(conjugate_cam(slide, distance="200 mm"), distance="200 mm")
    assert np.allclose(again.profile(ANGLES), slide.profile(ANGLES), atol=1e-14)


def test_pairs_that_cannot_be_are_refused_with_a_remedy() -> None:
    first, swung = cam_of("translating roller"), cam_of("oscillating roller")
    with pytest.raises(InputError, match=r"distance 80 mm is too short: .* make it longer"):
        conjugate_cam(first, distance="80 mm")
    with pytest.raises(InputError, match="must be a TranslatingRoller, as the first"):
        conjugate_cam(first, TranslatingFlat(), distance="180 mm")
    with pytest.raises(InputError, match="is given by its distance alone"):
        conjugate_cam(first, angle="80 deg")
    with pytest.raises(InputError, match="give it its pivot_distance"):
        conjugate_cam(swung, OscillatingRoller("9 mm", "80 mm", "130 mm"), angle="85 deg")
    with pytest.raises(InputError, match="give more than"):
        conjugate_cam(swung, angle="20 deg")


# --- barrel cams: the roller as a cylinder in space ---


Array = NDArray[np.float64]
CLOSE_ANGLES = np.linspace(0.0, 2.0 * np.pi, 401)[:-1] + 0.002


def barrel(turning: str = "counterclockwise", roller: str = "8 mm", stroke: str = "40 mm") -> BarrelCam:
    return BarrelCam(cycle_of(stroke), "60 mm", "12 mm", roller, turning=turning)  # type: ignore[arg-type]


def distances(points: Array, cam: BarrelCam, angles: Array) -> Array:
    """How far places on the cam are from the axis of the roller at angles of the cam; a row a place."""
    turned = TURNINGS[cam.turning] * angles
    axis = np.stack([np.sin(turned), np.cos(turned), np.zeros(len(angles))], axis=-1)
    away = points[:, None, :] - np.stack([0 * angles, 0 * angles, cam.displacement(angles)], axis=-1)[None]
    along = (away * axis[None]).sum(axis=-1)
    return np.asarray(np.where(along > 0, np.linalg.norm(away - along[..., None] * axis[None], axis=-1), np.inf))


@pytest.mark.parametrize("turning", TURNINGS)
@pytest.mark.parametrize("side", ["upper", "lower"])
def test_a_roller_touches_the_flank_and_never_cuts_it(turning: str, side: str) -> None:
    cam = barrel(turning)
    for radius in (0.048, 0.053, 0.06):
        flank = cam.flank(side, radius)  # type: ignore[arg-type]
        found = distances(flank(CLOSE_ANGLES), cam, CLOSE_ANGLES)
        assert np.allclose(np.diag(found), 0.008, atol=1e-15)
        assert found.min() >= 0.008 - 1e-15
        above = flank(CLOSE_ANGLES)[:, 2] - cam.displacement(CLOSE_ANGLES)
        assert (above > 0).all() if side == "upper" else (above < 0).all()


def test_derivatives_are_those_of_the_curves() -> None:
    cam, step = barrel(), 1e-5
    inner = CLOSE_ANGLES[np.abs(CLOSE_ANGLES[:, None] - np.array(cam.displacement.breaks)).min(axis=1) > 3 * step]
    for curve in (cam.pitch_curve, cam.flank("lower", 0.05), cam.cutter_path("5 mm")):
        for nu in (1, 2):
            differences = (curve(inner + step, nu - 1) - curve(inner - step, nu - 1)) / (2 * step)
            assert np.allclose(curve(inner, nu), differences, atol=2e-6)
    assert np.allclose(cam.cutter_path("8 mm")(CLOSE_ANGLES), cam.pitch_curve(CLOSE_ANGLES), atol=1e-15)
    differences = (cam.pressure_angle(inner + step) - cam.pressure_angle(inner - step)) / (2 * step)
    assert np.allclose(cam.pressure_angle(inner, 1), differences, atol=1e-6)


def test_a_table_that_advances_is_refused_by_its_own_reason() -> None:
    for by in ("45 deg", "40 mm"):
        indexing = Cycle([Rise(by, "120 deg"), Dwell()], speed="60 rpm", advance=by)
        with pytest.raises(InputError, match=r"several rollers on a circle.*run the motion of the table as a cycle"):
            BarrelCam(indexing, "60 mm", "12 mm", "8 mm")


def test_the_pressure_angle_is_that_of_the_developed_groove() -> None:
    cam = barrel()
    assert np.allclose(np.tan(cam.pressure_angle(CLOSE_ANGLES)), cam.displacement(CLOSE_ANGLES, 1) / 0.048, rtol=1e-13)
    least, greatest = cam.pressure_angles
    assert np.tan(greatest.value) == pytest.approx(0.04 * 2.0 / np.radians(140.0) / 0.048, rel=1e-11)
    assert np.tan(-least.value) == pytest.approx(0.04 * 2.0 / np.radians(120.0) / 0.048, rel=1e-11)


def test_undercut_is_proven_where_the_roller_cuts_and_nowhere_else() -> None:
    sharp = Cycle(
        [
            Rise("20 mm", "60 deg", law="cycloidal"),
            Dwell("60 deg"),
            Return("20 mm", "60 deg", law="cycloidal"),
            Dwell(),
        ],
        period="1 s",
    )
    statuses = []
    for millimetres in np.linspace(4.0, 30.0, 7):
        cam = BarrelCam(sharp, "60 mm", "12 mm", f"{millimetres:.3f} mm")
        inner = [
            distances(cam.flank(side, 0.048)(CLOSE_ANGLES), cam, CLOSE_ANGLES).min() for side in ("upper", "lower")
        ]
        depth = cam.roller - float(min(inner))
        statuses.append(cam.undercut)
        assert depth < 1e-12 or cam.undercut != FREE
        if cam.undercut == UNDERCUT:
            assert depth > 1e-9
    assert statuses[0] == FREE
    assert statuses[-1] == UNDERCUT


def test_steep_grooves_are_proven_free_of_cusps_at_every_depth() -> None:
    """Above 45 deg the bottom is no longer worst: flanks go on at every depth where they are said to."""
    statuses = []
    for roller in ("4 mm", "9 mm", "18 mm"):
        cam = BarrelCam(cycle_of("75 mm"), "60 mm", "30 mm", roller)
        assert np.degrees(cam.pressure_angles[1].value) > 50.0
        slope, bend = (np.asarray(cam.displacement(CLOSE_ANGLES, nu)) for nu in (1, 2))
        radius = np.linspace(0.03, 0.06, 61)[:, None]
        way = np.hypot(radius, slope)
        rest = way - cam.roller * radius * np.abs(bend) / way**2 - cam.roller**2 * slope**2 / way**3
        statuses.append(cam.undercut)
        assert rest.min() > 0.0 or cam.undercut != FREE
    assert statuses[0] == FREE


def test_grooves_that_cannot_be_are_refused_with_a_remedy() -> None:
    with pytest.raises(InputError, match="make the groove shallower"):
        BarrelCam(cycle_of("40 mm"), "60 mm", "70 mm", "8 mm")
    with pytest.raises(InputError, match="make the roller smaller"):
        barrel(roller="50 mm")
    with pytest.raises(InputError, match="take a smaller one"):
        barrel().cutter_path("9 mm")
    with pytest.raises(InputError, match="within the groove"):
        barrel().flank("upper", 0.07)
    with pytest.raises(InputError, match="side"):
        barrel().flank("left")  # type: ignore[arg-type]
    with pytest.raises(InputError, match="take an oscillating follower"):
        BarrelCam(CamMotion.of_law("cycloidal", "40 deg", "90 deg"), "60 mm", "12 mm", "8 mm")
