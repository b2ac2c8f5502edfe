import numpy as np
import pytest

from optlaws.cams.loads.forces import CamForces
from optlaws.errors import InputError
from optlaws.jobs.cam.pictures import draw_forces
from tests.cams.placed import FOLLOWERS, cam_of


@pytest.mark.parametrize("kind", sorted(FOLLOWERS))
def test_a_cam_is_drawn_to_scale_with_its_follower_around_it(kind: str) -> None:
    cam = cam_of(kind)
    profile, *curves = cam.plot(color="black")
    assert profile.axes.get_aspect() == 1.0
    drawn = np.array(profile.get_xydata())
    assert drawn[[0, -1]] == pytest.approx(1e3 * cam.profile(np.array([0.0, 2 * np.pi])))
    labels = [curve.axes.get_ylabel() for curve in curves]
    assert labels[1:] == ["pressure angle, deg", "curvature, 1/mm"]
    followers = len(profile.axes.patches if cam.contact.roller else profile.axes.lines)
    assert followers >= 8
    assert profile.get_color() == "black"


def test_a_cam_is_drawn_into_one_pair_of_axes_or_four() -> None:
    cam = cam_of("translating roller")
    axes = cam.plot()[0].axes.figure.subplots(1, 3)
    assert len(cam.plot(axes[0])) == 1
    with pytest.raises(InputError, match="one pair of axes or into four, got 3"):
        cam.plot(axes)


def test_forces_are_drawn_with_the_pressure_where_it_is_known() -> None:
    cam = cam_of("translating roller")
    drive = {"mass": "2 kg", "preload": "200 N"}
    for width, panels in ((None, 2), ("20 mm", 3)):
        figure = draw_forces(CamForces(cam, speed="200 rpm", drive=drive, width=width), "Forces")
        assert len(figure.axes) == panels
