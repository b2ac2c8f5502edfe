"""A follower does on its profile what was meant, also on profiles as they were made."""

from collections.abc import Callable
from math import tau
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from optlaws import (
    Chebyshev,
    Cycle,
    DiscCam,
    Dwell,
    InclinedFlat,
    InputError,
    OscillatingFlat,
    OscillatingRoller,
    Problem,
    Return,
    Rise,
    TranslatingFlat,
    TranslatingRoller,
    as_made,
    synthesize,
    with_profile_error,
)
from tests.cams.curves import readers
from tests.internals.cams import (
    ArcChain,
    CamFollower,
    Following,
    Outline,
    PlaneCurve,
    PolarSpline,
    Spline,
    arcs,
    polar,
    run_against,
    spline,
    spline_through,
    write_outline,
)

FOLLOWERS: list[tuple[CamFollower, str]] = [
    (TranslatingRoller("12 mm", offset="10 mm"), "40 mm"),
    (TranslatingFlat(), "20 mm"),
    (InclinedFlat("-20 deg"), "20 mm"),
    (OscillatingRoller("12 mm", arm="90 mm", pivot_distance="120 mm"), "20 deg"),
    (OscillatingFlat(pivot_distance="120 mm", face_offset="8 mm"), "10 deg"),
]
CURVES: dict[str, Callable[[PlaneCurve], Outline]] = {
    "csv": lambda profile: spline_through(np.round(profile(np.linspace(0.0, tau, 181) % tau), 6)),
    "csv polar": lambda profile: PolarSpline(np.round(polar(profile, 181), 6)),
    "dxf spline": lambda profile: spline(profile, 1e-6),
    "dxf arcs": lambda profile: ArcChain(arcs(profile, 1e-6)),
}
PLACES = np.linspace(0.01, 6.27, 301)


def cam(follower: CamFollower, stroke: str, **others: Any) -> DiscCam:
    moves = [Rise(stroke, "120 deg", law="3-4-5"), Dwell("60 deg"), Return(None, "120 deg", law="cycloidal"), Dwell()]
    return DiscCam(Cycle(moves, speed="200 rpm"), prime_radius="70 mm", follower=follower, **others)


@pytest.mark.parametrize("turning", ["counterclockwise", "clockwise"])
@pytest.mark.parametrize(("follower", "stroke"), FOLLOWERS)
def test_a_follower_does_on_its_profile_what_was_meant(follower: CamFollower, stroke: str, turning: str) -> None:
    disc = cam(follower, stroke, turning=turning, phase="30 deg")
    curves = [(disc.profile, 0.0), (disc.pitch_curve, disc.contact.roller), (disc.cutter_path("25 mm"), 0.025)]
    for curve, outside in curves:
        following = Following(disc.contact, curve, np.radians(30.0), outside)
        for nu in range(4):
            angle, values = following.at(PLACES, nu)
            assert np.abs(np.angle(np.exp(1j * (angle - PLACES)))).max() < 1e-12
            assert values == pytest.approx(disc.displacement(PLACES, nu), abs=1e-11)


@pytest.mark.sample(4)
@pytest.mark.parametrize("form", ["csv", "csv polar", "dxf spline", "dxf arcs"])
@pytest.mark.parametrize(("follower", "stroke"), FOLLOWERS)
def test_peaks_as_made_are_enclosed_and_near(follower: CamFollower, stroke: str, form: str) -> None:
    disc = cam(follower, stroke)
    curve = CURVES[form](disc.profile)
    made, following = run_against(disc, curve, jumps=False), Following(disc.contact, curve)
    edges = np.array(curve.breaks)
    places = (edges[:-1] + np.diff(edges) * np.linspace(1e-9, 1.0 - 1e-9, 101)[:, None]).ravel()
    angle, displacement = following.at(places, 0)
    off = float(np.abs(displacement - disc.displacement(angle)).max())
    assert off * (1.0 - 1e-9) <= made.deviation < 1.01 * off + 1e-14
    for nu, bound in ((2, made.acceleration), (3, made.jerk)):
        seen = float(np.abs(following.at(places, nu)[1]).max())
        assert seen * (1.0 - 1e-9) <= bound < (1.0 + 1e-4) * seen


# --- as manufactured ---


Array = NDArray[np.float64]


@pytest.fixture(scope="module")
def smooth_cam() -> DiscCam:
    law = synthesize(Problem(B=1.859, order=4, basis=Chebyshev(9))).law
    moves = [Rise("40 mm", "120 deg", law=law), Dwell("60 deg"), Return(None, "120 deg", law=law), Dwell()]
    return DiscCam(Cycle(moves, speed="200 rpm"), prime_radius="80 mm", follower=TranslatingRoller("12 mm"))


#: points and decimals of a table of radii, and what it makes of the peak acceleration
RADII = [
    (361, 3, 1.236), (361, 4, 1.023), (361, 6, 1.0009), (721, 3, 1.84), (721, 4, 1.09), (721, 6, 1.0003),
]  # fmt: skip


@pytest.mark.sample(2)
@pytest.mark.parametrize(("points", "decimals", "ratio"), RADII)
def test_digits_of_radii_raise_the_acceleration_as_measured(
    smooth_cam: DiscCam, points: int, decimals: int, ratio: float
) -> None:
    made = as_made(smooth_cam, "csv polar", curve="pitch", points=points, decimals=decimals)
    assert made.acceleration_ratio == pytest.approx(ratio, abs=5.5 * 10.0 ** -(5 if decimals == 6 else 3))
    # under a slide that points at the centre these are splined displacements: another spline says the same
    angles = np.linspace(0.0, 2.0 * np.pi, points)
    rounded = np.round(1e3 * (0.08 + smooth_cam.displacement(angles)), decimals)
    known = CubicSpline(angles, 1e-3 * np.append(rounded[:-1], rounded[0]), bc_type="periodic")
    assert made.acceleration == pytest.approx(float(np.abs(known(angles, 2)).max()), rel=1e-6)
    step = 2.0 * np.pi / (points - 1)
    exact = made.acceleration / made.acceleration_ratio
    # rounded values move the second derivative of a spline by no more than 6 eps/step²
    assert made.acceleration <= exact * 1.001 + 6e-3 * 10.0**-decimals / step**2


def test_digits_of_x_and_y_count_more(smooth_cam: DiscCam) -> None:
    ratios = [as_made(smooth_cam, points=points, decimals=3).acceleration_ratio for points in (181, 361, 721)]
    assert ratios == pytest.approx([1.0915, 1.308, 2.434], rel=1e-3)
    assert as_made(smooth_cam, points=721, decimals=3).deviation < 1e-6


def test_a_dxf_gives_the_motion_back_to_its_digits(smooth_cam: DiscCam, tmp_path: Path) -> None:
    for degree, near in ((3, 2e-3), (5, 5e-4)):
        asked = {"tolerance": "0.01 um", "degree": degree}
        curve = readers.dxf_spline(write_outline(smooth_cam.profile, tmp_path / f"{degree}.dxf", "dxf spline", **asked))  # type: ignore[arg-type]
        made = run_against(smooth_cam, Spline(degree, curve.t, 1e-3 * curve.c, 0.0))
        assert made.deviation < 1.2e-8
        assert made.jump == 0.0
        assert made.acceleration_ratio == pytest.approx(1.0, abs=near)
        assert made.jerk_ratio == pytest.approx(1.0, abs=0.02)


def test_a_table_read_back_moves_the_follower_as_was_foretold(smooth_cam: DiscCam, tmp_path: Path) -> None:
    rows = readers.table(write_outline(smooth_cam.profile, tmp_path / "p.csv", points=361, decimals=4))
    made = run_against(smooth_cam, spline_through(1e-3 * rows[:, 1:]))
    assert made.acceleration == pytest.approx(as_made(smooth_cam, points=361, decimals=4).acceleration, rel=1e-9)


def test_under_arcs_the_acceleration_jumps_and_is_nearly_kept(smooth_cam: DiscCam) -> None:
    made = as_made(smooth_cam, "dxf arcs", tolerance="1 um")
    assert made.jerk == np.inf
    assert made.to_dict()["jerk"] is None
    assert 0.1 < made.jump / made.acceleration < 0.5
    assert 1.0 < made.acceleration_ratio < 1.06
    assert made.deviation < 1.1e-6


def test_waves_of_the_profile_add_their_square(smooth_cam: DiscCam) -> None:
    made = with_profile_error(smooth_cam, "0.01 mm", waves=12)
    meant = made.acceleration / made.acceleration_ratio
    assert made.deviation == pytest.approx(1e-5, rel=0.1)
    assert made.acceleration - meant == pytest.approx(12**2 * 1e-5, rel=0.15)


def test_a_flat_face_is_run_as_well() -> None:
    moves = [Rise("10 mm", "120 deg", law="3-4-5"), Dwell("60 deg"), Return(None, "120 deg", law="3-4-5"), Dwell()]
    flat = DiscCam(Cycle(moves, speed="200 rpm"), prime_radius="60 mm", follower=TranslatingFlat())
    made = as_made(flat, points=181, decimals=6)
    assert made.deviation < 1e-6
    assert made.acceleration_ratio == pytest.approx(1.0, abs=0.02)


def test_what_cannot_be_run_says_why(smooth_cam: DiscCam) -> None:
    for arguments, match in (
        ({"form": "csv poler"}, "did you mean 'csv polar'"),
        ({"form": "g-code"}, "have corners"),
        ({"curve": "pitsch"}, "did you mean 'pitch'"),
        ({"decimals": -1}, "decimals must be"),
    ):
        with pytest.raises(InputError, match=match):
            as_made(smooth_cam, **arguments)
    with pytest.raises(InputError, match="narrower than the roller"):
        with_profile_error(smooth_cam, "0.1 mm", waves=100)
    with pytest.raises(InputError, match="error must be above 0"):
        with_profile_error(smooth_cam, "0 mm", waves=3)


def test_a_chain_of_arcs_and_lines_is_a_curve() -> None:
    from tests.internals.cams import Arcs

    stadium = ArcChain(Arcs(np.array([[1.0, -1], [1, 1], [-1, 1], [-1, -1]]), np.array([0.0, 1.0, 0.0, 1.0]), 0.0))
    assert stadium(np.array([0.5, 1.5, 3.5])) == pytest.approx(np.array([[1.0, 0], [0, 2], [0, -2]]))
    assert stadium(np.array([0.5, 1.5]), 2) == pytest.approx(np.array([[0.0, 0], [0, -(np.pi**2)]]), abs=1e-12)
