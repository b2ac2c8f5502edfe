import re

import numpy as np
import pytest

from optlaws import CamForces, InputError, conjugate_cam
from tests.cams.placed import FOLLOWERS, cam_of
from tests.internals.cams import PairForces
from tests.internals.plots import animated, forces_figure


@pytest.mark.parametrize("kind", sorted(FOLLOWERS))
def test_a_cam_is_drawn_to_scale_with_its_follower_around_it(kind: str) -> None:
    cam = cam_of(kind)
    profile, *curves = cam.plot(color="black")
    assert profile.axes.get_aspect() == 1.0
    drawn = np.array(profile.get_xydata())
    assert drawn[[0, -1]] == pytest.approx(1e3 * cam.profile(np.array([0.0, 2 * np.pi])))
    labels = [curve.axes.get_ylabel() for curve in curves]
    # a face that is square to its way has none
    pressure = [] if kind == "translating flat" else ["pressure angle, deg"]
    assert labels[1:] == [*pressure, "curvature, 1/mm"]
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
        figure = forces_figure(CamForces(cam, speed="200 rpm", drive=drive, width=width), "Forces")
        assert len(figure.axes) == panels
    usual = CamForces(cam, speed="100 rpm", drive=drive)
    contact, torque = forces_figure(CamForces(cam, speed="200 rpm", drive=drive), "F", usual=("slow", usual)).axes
    for axes, curve in ((contact, usual.contact_force), (torque, usual.shaft_torque)):
        (beside,) = (line for line in axes.lines if line.get_label() == "slow")
        degrees, values = (np.asarray(part, dtype=float) for part in beside.get_data())
        assert values == pytest.approx(curve(np.radians(degrees)), abs=1e-6 * np.abs(values).max())


def test_forces_of_a_pair_are_drawn_for_the_return_cam_too() -> None:
    cam = cam_of("translating roller")
    pair = PairForces(
        cam, speed="200 rpm", drive={"mass": "2 kg"}, width="20 mm", second=conjugate_cam(cam, distance="220 mm")
    )
    contact, torque, _, of_return, pressure = forces_figure(pair, "F").axes
    assert [axes.lines[0].get_color() for axes in (contact, torque)] == [of_return.lines[0].get_color(), "#d95f02"]
    for axes, curve in ((of_return, pair.contact_of_return), (pressure, pair.pressure_of_return)):
        drawn = max(float(np.max(np.asarray(line.get_ydata(), dtype=float))) for line in axes.lines)
        assert drawn == pytest.approx(curve.most * (1e-6 if axes is pressure else 1.0), rel=1e-4)


@pytest.mark.parametrize("kind", ["translating roller", "oscillating roller"])
@pytest.mark.parametrize("turning", ["counterclockwise", "clockwise"])
def test_in_an_animation_the_roller_touches_the_cam_in_every_frame(kind: str, turning: str) -> None:
    cam = cam_of(kind, turning)
    text = animated(cam)
    x, y, radius = centre(text)
    match = re.search(r'type="(translate|rotate)" values="([^"]*)"', text)
    turn = re.search(r'to="(-?[.0-9]+)"', text)
    assert match is not None
    assert turn is not None
    frames = [[float(one) for one in frame.split()] for frame in match[2].split(";")]
    profile = 1e3 * cam.profile(np.linspace(0.0, 2 * np.pi, 4001)) @ np.array([1.0, -1j])
    for i in range(0, len(frames), 24):
        turned = profile * np.exp(1j * np.radians(float(turn[1]) * i / (len(frames) - 1)))
        at = complex(x, y)
        if match[1] == "translate":
            at += complex(*frames[i])
        else:
            at = frames[i][1] + (at - frames[i][1]) * np.exp(1j * np.radians(frames[i][0]))
        assert float(np.abs(turned - at).min()) == pytest.approx(radius, abs=0.02)


def centre(text: str) -> list[float]:
    match = re.search(r'cx="(-?[.0-9]+)" cy="(-?[.0-9]+)" r="([.0-9]+)"', text)
    assert match is not None
    return [float(group) for group in match.groups()]
