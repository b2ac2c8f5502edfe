"""Disc cams: their curves against rollers and faces that are put where they belong by trigonometry."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from optlaws import (
    CamMotion,
    Cycle,
    DiscCam,
    InputError,
    OscillatingFlat,
    OscillatingRoller,
    PiecewiseLaw,
    Return,
    Rise,
    TranslatingFlat,
    TranslatingRoller,
)
from tests.cams.placed import FOLLOWERS, TURNINGS, cam_of, cycle_of, face_lines, points, roller_centres
from tests.internals.cams import CamFollower
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


def test_an_eccentric_circle_gives_its_motion_and_its_radius() -> None:
    # s = e (1 - cos theta) under a flat face is a circle of radius r0 + e about a point at e from the centre
    rise = CamMotion.of_law("simple harmonic", "20 mm", "180 deg")
    cam, angles = DiscCam(rise, "40 mm", TranslatingFlat()), np.linspace(0.0, np.pi, 50)
    assert np.allclose(cam.radius_of_curvature(angles), 0.05, atol=1e-15)
    assert np.allclose(np.abs(points(cam.profile(angles)) + 0.01j), 0.05, atol=1e-15)


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
