"""Enclosed extremes: against closed forms, against searches of another kind, and 1,000 random cams against geometry."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

from optlaws import (
    CamMotion,
    Cycle,
    DiscCam,
    Dwell,
    InputError,
    OscillatingRoller,
    PiecewiseLaw,
    PolynomialLaw,
    Return,
    Rise,
    TranslatingFlat,
    TranslatingRoller,
)
from tests.cams.placed import FOLLOWERS, cam_of, cycle_of, face_lines, points, roller_centres
from tests.internals.cams import FREE, UNDERCUT, EnclosedExtreme, FaceContact, RollerContact, enclosed_extremes
from tests.internals.laws import FractionalSegment, PowerSegment
from tests.internals.numerics import Interval, chebyshev

Array = NDArray[np.float64]

LAWS = ["cycloidal", "modified sine", "0510", "modified trapezoid", "cubic", "IV(4.5)"]


def searched(values: Callable[[Any], Any], breaks: tuple[float, ...]) -> float:
    """The greatest value that a dense look and a search around the best places find."""
    angles = np.unique(np.concatenate([np.linspace(breaks[0], breaks[-1], 3001), breaks]))
    found = np.asarray(values(angles))
    best = float(found.max())
    for i in np.argsort(found)[-4:]:
        ends = angles[max(i - 1, 0)], angles[min(i + 1, len(angles) - 1)]
        result: Any = minimize_scalar(lambda x: -float(values(x)), bounds=ends, options={"xatol": 1e-11})
        best = max(best, -float(result.fun))
    return best


def signed(values: Callable[[Any], Any], sign: float, angle: Array) -> Any:
    return sign * np.asarray(values(angle))


@pytest.mark.sample(4)
@pytest.mark.parametrize("kind", FOLLOWERS)
@pytest.mark.parametrize("law", LAWS[:3])
def test_extremes_are_those_that_a_search_finds(kind: str, law: str) -> None:
    cam = cam_of(kind, law=law)
    least, greatest = cam.extremes.pressure_angles
    for extreme, sign in ((least, -1.0), (greatest, 1.0)):
        top = searched(partial(signed, cam.pressure_angle, sign), cam.profile.breaks)
        shown = extreme if sign > 0 else -extreme
        assert shown.low - 1e-12 <= top <= shown.high + 1e-12
        assert shown.high - shown.low <= 1e-9
    bulging = searched(lambda x: np.asarray(cam.profile.curvature(x)), cam.profile.breaks)
    before = float(np.max(cam.profile.curvature(np.array(cam.profile.breaks), before=True)))
    assert 1.0 / max(bulging, before) == pytest.approx(cam.extremes.least_convex_radius.value, rel=1e-8)


@pytest.mark.parametrize("law", LAWS)
def test_enclosed_jets_hold_the_displacement_in_every_cell(law: str) -> None:
    for stretch in CamMotion.of_law(law, "40 mm", "120 deg").stretches:
        span = stretch.stop - stretch.start
        middle, half = np.array([0.0, 0.3, 0.71, 1.0]), np.array([0.0, 0.05, 0.002, 0.0])
        jet = stretch.jet(Interval(stretch.start + middle * span, half * span), 4)
        for share in (-1.0, -0.4, 0.0, 0.6, 1.0):
            angles = stretch.start + (middle + share * half) * (stretch.stop - stretch.start)
            held = stretch.jet(angles, 4)
            for term, value in zip(jet.terms, held.terms, strict=True):
                assert ((term.low <= value) & (value <= term.high)).all()


def test_a_circle_about_another_centre_has_the_closed_forms() -> None:
    # the pitch curve is a circle of radius 60 mm whose centre is 20 mm off: sin(alpha) = 20/60 at most, no undercut
    radius, off = 0.06, 0.02

    def distance(x: Array) -> Array:
        angle = 0.5 * np.pi * (x + 1.0)
        return np.asarray(np.sqrt(radius**2 - (off * np.sin(angle)) ** 2) - off * np.cos(angle))

    series = chebyshev.interpolated(lambda x: (distance(x) - radius + off) / (2 * off), "distance")
    cam = DiscCam(
        CamMotion.of_law(PolynomialLaw.from_chebyshev(series), "40 mm", "180 deg"), "40 mm", TranslatingRoller("15 mm")
    )
    extremes = cam.extremes
    assert extremes.greatest_pressure_angle.value == pytest.approx(np.arcsin(1.0 / 3.0), rel=1e-11)
    assert extremes.least_convex_radius.value == pytest.approx(radius - 0.015, rel=1e-7)
    assert extremes.least_concave_radius is None
    assert extremes.undercut.free


def test_a_roller_just_too_large_is_proven_to_undercut_and_one_just_smaller_is_not() -> None:
    segments = [Rise("30 mm", "80 deg", law="cycloidal"), Dwell("40 deg"), Return(law="cycloidal")]
    cycle = Cycle(segments, period="1 s")
    pitch = DiscCam(cycle, "35 mm", TranslatingRoller("1 mm"))
    largest = 0.001 + pitch.extremes.least_convex_radius.value
    verdicts = [
        DiscCam(cycle, "35 mm", TranslatingRoller(f"{share * largest!r} m")).extremes.undercut
        for share in (1.0 - 1e-7, 1.0 + 1e-7)
    ]
    assert [verdict.status for verdict in verdicts] == [FREE, UNDERCUT]
    assert "make the prime circle larger or a roller smaller" in str(verdicts[1])


def test_a_hollow_profile_tells_how_small_its_cutter_must_be() -> None:
    cam = DiscCam(cycle_of("40 mm"), "45 mm", TranslatingRoller("8 mm"))
    hollow = cam.extremes.least_concave_radius
    assert hollow is not None
    assert -1.0 / hollow.value == pytest.approx(
        -searched(lambda x: -cam.profile.curvature(x), cam.profile.breaks), rel=1e-8
    )


def test_laws_without_a_bounded_acceleration_are_refused() -> None:
    with pytest.raises(InputError, match="take a law whose C is finite"):
        DiscCam(CamMotion.of_law(_impulsive(), "20 mm", "90 deg"), "80 mm", TranslatingRoller("5 mm"))


def _impulsive() -> PiecewiseLaw:
    return PiecewiseLaw([0, 0.5, 1], [PowerSegment(0.0, 1.5), PowerSegment(1.5, 0.0)])


def test_the_extremes_of_powers_of_time_are_enclosed_though_their_jerk_has_no_bound() -> None:
    rise = FractionalSegment(0.5, 0.0, 0.5, (1.0,))
    fall = FractionalSegment(0.5, 0.5, 0.0, (-1.0,))
    law = PiecewiseLaw([0, 0.5, 1], [rise, replace(fall, steady=0.0)])
    law = PiecewiseLaw([0, 0.5, 1], [segment.scaled(0.5, 1.0 / law.a(1.0)) for segment in law.segments])
    motion = CamMotion.of_law(law, "40 mm", "120 deg")
    least, greatest = enclosed_extremes(motion, lambda s: s.slope().slope(), 2)
    top = float(law.c(0.5 - 1e-12)) * 0.04 / (2 * np.pi / 3) ** 2
    assert greatest.low <= top * (1 + 1e-9)
    assert top * (1 - 1e-9) <= greatest.high <= top * (1 + 1e-6)
    assert least.value == pytest.approx(-top, rel=1e-6)


def random_cam(rng: np.random.Generator) -> DiscCam | None:
    """A cam of random sizes, many of them undercut; None where there is no such mechanism."""
    swings = bool(rng.integers(2))
    stroke = f"{rng.uniform(8, 30):.9f} deg" if swings else f"{rng.uniform(5, 50):.9f} mm"
    first, second = rng.uniform(40, 130, 2)
    laws = rng.choice(LAWS, 2)
    segments = [
        Rise(stroke, f"{first:.9f} deg", law=str(laws[0])),
        Dwell(f"{rng.uniform(5, 60):.9f} deg"),
        Return(duration=f"{second:.9f} deg", law=str(laws[1])),
        Dwell(),
    ]
    base, roller = rng.uniform(15, 60), rng.uniform(4, 25)
    turning = ("clockwise", "counterclockwise")[int(rng.integers(2))]
    try:
        if swings:
            distance = rng.uniform(1.1, 2.5) * base
            follower = OscillatingRoller(
                f"{roller:.9f} mm", f"{rng.uniform(0.6, 1.3) * distance:.9f} mm", f"{distance:.9f} mm"
            )
            return DiscCam(Cycle(segments, period="1 s"), f"{base:.9f} mm", follower, turning=turning)  # type: ignore[arg-type]
        if rng.integers(3) == 0:
            return DiscCam(Cycle(segments, period="1 s"), f"{base:.9f} mm", TranslatingFlat(), turning=turning)  # type: ignore[arg-type]
        sliding = TranslatingRoller(f"{roller:.9f} mm", f"{rng.uniform(-0.5, 0.5) * base:.9f} mm")
        return DiscCam(Cycle(segments, period="1 s"), f"{base:.9f} mm", sliding, turning=turning)  # type: ignore[arg-type]
    except InputError:
        return None


def depth_of_cut(cam: DiscCam, count: int) -> float:
    """How deep the follower, anywhere on its way, cuts into the profile, m."""
    angles = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)
    profile = points(cam.profile(angles))
    if isinstance(cam.contact, FaceContact):
        normals, far = face_lines(cam, angles)
        return float(((profile[:, None] * normals.conj()[None, :]).real - far[None, :]).max())
    return cam.contact.roller - float(np.abs(profile[:, None] - roller_centres(cam, angles)[None, :]).min())


def check_random_cams(count: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    statuses: list[str] = []
    while len(statuses) < count:
        cam = random_cam(rng)
        if cam is None:
            continue
        verdict, depth = cam.extremes.undercut, depth_of_cut(cam, 500)
        statuses.append(verdict.status)
        if verdict.simple:
            assert depth < 1e-12, (cam, depth)
        if depth > 1e-12 and verdict.status == FREE:
            assert not verdict.simple, (cam, depth)
        if verdict.status == UNDERCUT and isinstance(cam.contact, RollerContact):
            at = np.array(verdict.margin.angle)
            sides = [cam.contact.curvature(cam.displacement.jet(at, 2, before=side)) for side in (False, True)]
            assert 1.0 / max(one.terms[0] for one in sides) < cam.contact.roller
    assert min(statuses.count(FREE), statuses.count(UNDERCUT)) > count // 8


@pytest.mark.long
def test_no_undercut_is_missed_in_random_cams() -> None:
    check_random_cams(24, 17)


@pytest.mark.long
def test_no_undercut_is_missed_in_a_thousand_random_cams() -> None:
    check_random_cams(976, 18)


def test_an_extreme_with_the_other_sign_is_turned_over() -> None:
    assert -EnclosedExtreme(-2.0, -1.0, 0.3) == EnclosedExtreme(1.0, 2.0, 0.3)


def test_a_part_of_the_turn_is_proven_locally_alone() -> None:
    rise = DiscCam(CamMotion.of_law("cycloidal", "40 mm", "120 deg"), "60 mm", TranslatingRoller("5 mm"))
    assert str(rise.extremes.undercut) == "no undercut, locally"
    assert str(DiscCam(cycle_of("40 mm"), "60 mm", TranslatingRoller("5 mm")).extremes.undercut).endswith(
        "cross itself"
    )
