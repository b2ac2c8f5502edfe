from typing import Any

import numpy as np
import pytest

from optlaws import Cycle, Dwell, Return, Rise
from optlaws.cams.disc import DiscCam
from optlaws.cams.followers.follower import Follower
from optlaws.cams.followers.oscillating_flat import OscillatingFlat
from optlaws.cams.followers.oscillating_roller import OscillatingRoller
from optlaws.cams.followers.translating_flat import TranslatingFlat
from optlaws.cams.followers.translating_roller import TranslatingRoller
from optlaws.cams.made.following import Following

FOLLOWERS: list[tuple[Follower, str]] = [
    (TranslatingRoller("12 mm", offset="10 mm"), "40 mm"),
    (TranslatingFlat(), "20 mm"),
    (OscillatingRoller("12 mm", arm="90 mm", pivot_distance="120 mm"), "20 deg"),
    (OscillatingFlat(pivot_distance="120 mm", face_offset="8 mm"), "10 deg"),
]
PLACES = np.linspace(0.01, 6.27, 301)


def cam(follower: Follower, stroke: str, **others: Any) -> DiscCam:  # noqa: ANN401 - as DiscCam takes them
    moves = [Rise(stroke, "120 deg", law="3-4-5"), Dwell("60 deg"), Return(None, "120 deg", law="cycloidal"), Dwell()]
    return DiscCam(Cycle(moves, speed="200 rpm"), base_radius="70 mm", follower=follower, **others)


@pytest.mark.parametrize("turning", ["counterclockwise", "clockwise"])
@pytest.mark.parametrize(("follower", "stroke"), FOLLOWERS)
def test_a_follower_does_on_its_profile_what_was_meant(follower: Follower, stroke: str, turning: str) -> None:
    disc = cam(follower, stroke, turning=turning, phase="30 deg")
    curves = [(disc.profile, 0.0), (disc.pitch_curve, disc.contact.roller), (disc.cutter_path("25 mm"), 0.025)]
    for curve, outside in curves:
        following = Following(disc.contact, curve, np.radians(30.0), outside)
        for nu in range(4):
            angle, values = following.at(PLACES, nu)
            assert np.abs(np.angle(np.exp(1j * (angle - PLACES)))).max() < 1e-12
            assert values == pytest.approx(disc.displacement(PLACES, nu), abs=1e-11)
