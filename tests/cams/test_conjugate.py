"""Conjugate cams: both followers, put where they belong by trigonometry, touch their cams at every angle."""

from __future__ import annotations

import numpy as np
import pytest

from optlaws import InputError, OscillatingRoller, TranslatingFlat, TranslatingRoller, conjugate_cam
from tests.cams.placed import TURNINGS, cam_of, face_lines, points

ANGLES = np.linspace(0.0, 2.0 * np.pi, 121)[:-1] + 0.01


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
