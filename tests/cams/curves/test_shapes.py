import numpy as np
import pytest
from numpy.typing import NDArray

from optlaws import InputError
from tests.cams.outlines import Bumped, Ellipse
from tests.internals.cams import Arcs, arcs, even, polygon, spline, through

Array = NDArray[np.float64]

CIRCLE, ELLIPSE = Ellipse(0.05, 0.05), Ellipse(0.06, 0.03, (0.0, 1.0, 2 * np.pi))
ANGLES = np.linspace(0.0, 2 * np.pi, 7001)


def test_a_polygon_in_a_circle_has_as_few_corners_as_its_tolerance_allows() -> None:
    made = polygon(CIRCLE, 1e-5)
    fewest = np.pi / np.arccos(1.0 - 1e-5 / 0.05)
    assert fewest <= len(made.corners) <= 1.02 * fewest + 1
    versed = 0.05 * (1.0 - np.cos(np.pi / len(made.corners)))
    assert versed <= made.deviation <= 1.02 * versed


@pytest.mark.parametrize("tolerance", [1e-4, 1e-6])
def test_no_place_is_farther_from_its_chord_than_is_proven(tolerance: float) -> None:
    made = polygon(ELLIPSE, tolerance)
    points, corners = ELLIPSE(ANGLES), np.append(made.corners, made.corners[:1], axis=0)
    which = np.searchsorted(made.angles, ANGLES, side="right") - 1
    chords = corners[which + 1] - corners[which]
    off = chords[:, 0] * (points - corners[which])[:, 1] - chords[:, 1] * (points - corners[which])[:, 0]
    seen = float(np.abs(off / np.linalg.norm(chords, axis=1)).max())
    assert seen <= made.deviation <= tolerance
    assert made.deviation < 1.05 * seen


def test_a_circle_is_made_of_arcs_of_its_own() -> None:
    made = arcs(CIRCLE, 1e-6)
    assert made.radii == pytest.approx(0.05, rel=1e-12)
    assert np.abs(made.centres).max() < 1e-14
    assert made.deviation < 1e-14


def test_arcs_touch_each_other_and_stay_within_their_tolerance() -> None:
    made = arcs(ELLIPSE, 1e-6)
    turn = 2.0 * np.arctan(made.bulges)
    chords = made.ends - made.points
    heading = np.arctan2(chords[:, 1], chords[:, 0])
    corner = np.roll(heading - turn, -1) - (heading + turn)
    assert np.abs(np.angle(np.exp(1j * corner))).max() < 1e-9
    assert made.deviation <= 1e-6
    # as few as the cube root says: a hundredth of the tolerance takes 4.6 times as many
    assert 4.0 < len(arcs(ELLIPSE, 1e-8).points) / len(made.points) < 5.2


def crossed(first: Array, second: Array) -> Array:
    return np.asarray(first[..., 0] * second[..., 1] - first[..., 1] * second[..., 0])


def off_chain(made: Arcs, points: Array) -> Array:
    """How far points are from the nearest arc of a chain that they are in the sector of."""
    towards = points[:, None, :] - made.centres[None]
    off = np.abs(np.linalg.norm(towards, axis=2) - made.radii)
    turned = np.stack([crossed(made.points - made.centres, towards), crossed(towards, made.ends - made.centres)])
    within = (turned * np.sign(made.bulges) >= -1e-9 * made.radii**2).all(axis=0)
    return np.asarray(np.where(within, off, np.inf).min(axis=1))


@pytest.mark.parametrize("outline", [ELLIPSE, Bumped(0.05, 9e-7, 2.0, 1e-4), Bumped(0.05, 9e-7, 0.3137, 3e-5)])
def test_what_is_proven_holds_at_a_bump_that_no_grid_sees(outline: Ellipse | Bumped) -> None:
    centre = outline.centre if isinstance(outline, Bumped) else 1.0
    angles = np.sort(np.concatenate([np.linspace(0.0, 6.28, 3001), centre + 2e-4 * np.linspace(-1.0, 1.0, 2001)]))
    points = outline(angles)
    chords = polygon(outline, 1e-6)
    ends = np.append(chords.corners, chords.corners[:1], axis=0)
    which = np.searchsorted(chords.angles, angles, side="right") - 1
    along = np.diff(ends, axis=0)[which]
    seen = float(np.abs(crossed(along, points - ends[which]) / np.linalg.norm(along, axis=1)).max())
    assert 0.9 * chords.deviation < seen <= chords.deviation <= 1e-6
    chain = arcs(outline, 1e-6)
    assert 0.5 * chain.deviation < off_chain(chain, points).max() <= chain.deviation <= 1e-6 + 1e-12
    curve = spline(outline, 1e-6)
    seen = float(np.linalg.norm(curve(angles) - points, axis=1).max())
    assert 0.9 * curve.deviation < seen <= curve.deviation <= 1e-6


@pytest.mark.parametrize("degree", [3, 5])
def test_a_spline_is_where_it_is_proven_to_be(degree: int) -> None:
    made = spline(ELLIPSE, 1e-8, degree)
    seen = float(np.linalg.norm(made(ANGLES) - ELLIPSE(ANGLES), axis=1).max())
    assert seen <= made.deviation <= 1e-8
    for nu in (1, 2):
        first, last = made(np.array([0.0, 2 * np.pi - 1e-13]), nu)
        assert np.abs(first - last).max() < 1e-9
        assert np.abs(first - ELLIPSE(np.zeros(1), nu)).max() < 1e-4


def test_splines_get_nearer_with_the_power_of_their_degree() -> None:
    for degree in (3, 5):
        coarse, fine = (through(ELLIPSE, even(ELLIPSE, parts), degree).deviation for parts in (60, 120))
        assert coarse / fine == pytest.approx(2.0 ** (degree + 1), rel=0.2)


def test_what_cannot_be_cut_says_why() -> None:
    with pytest.raises(InputError, match="whole turn"):
        polygon(Ellipse(0.06, 0.03, (0.0, 2.0)), 1e-6)
    with pytest.raises(InputError, match="tolerance requires"):
        polygon(CIRCLE, 1e-15)
    with pytest.raises(InputError, match="degree"):
        spline(CIRCLE, 1e-6, 4)
