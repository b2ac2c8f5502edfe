"""How long a flat face must be: by closed forms, by the profile itself, and where reports and the page say it."""

from math import cos, pi, radians
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from optlaws import Cycle, DiscCam, Dwell, InclinedFlat, InputError, OscillatingFlat, Return, Rise, TranslatingFlat
from tests.internals.explorer import CycleRequest, cam_view
from tests.internals.jobs import read_of_cam

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
