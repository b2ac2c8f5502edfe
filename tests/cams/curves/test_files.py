"""Files that cut a cam: read back by readers of their own, and shapes that are proven to be within their tolerances."""

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import ezdxf.filemanagement
import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.interpolate import BPoly

from optlaws import CamMotion, DiscCam, InputError, TranslatingRoller
from tests.cams.curves import readers
from tests.cams.outlines import Bumped, Ellipse
from tests.cams.placed import cam_of
from tests.internals.cams import ENDINGS, FORMATS, Arcs, PlaneCurve, arcs, even, polygon, spline, through, write_outline

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


# --- formats ---


LARGE_ELLIPSE = Ellipse(0.06, 0.03, (0.0, 1.0, 2 * np.pi))
FEWER_ANGLES = np.linspace(0.0, 2 * np.pi, 1501)
POINTS = 1e3 * LARGE_ELLIPSE(FEWER_ANGLES)
#: of a millimetre: the tolerance asked for, and the rounding of coordinates
NEAR = 2e-3 + 1e-4


def test_a_dxf_spline_is_read_back_with_all_its_digits(tmp_path: Path) -> None:
    for degree in (3, 5):
        file = write_outline(LARGE_ELLIPSE, tmp_path / f"profile{degree}.dxf", tolerance="0.01 um", degree=degree)
        found = readers.dxf_spline(file)
        assert found.k == degree
        assert ezdxf.filemanagement.readfile(file).header["$INSUNITS"] == 4
        assert float(np.linalg.norm(found(FEWER_ANGLES) - POINTS, axis=1).max()) < 1.0001e-5
        assert np.abs(found(0.0, 1) - found(2 * np.pi - 1e-13, 1)).max() < 1e-6


def nearest(chain: Sequence[readers.Arc | readers.Line]) -> float:
    return float(np.min([one.distances(POINTS) for one in chain], axis=0).max())


def test_a_dxf_polyline_is_within_its_tolerance(tmp_path: Path) -> None:
    corners = readers.dxf_corners(
        write_outline(LARGE_ELLIPSE, tmp_path / "p.dxf", "dxf polyline", tolerance="2 um", decimals=4)
    )
    chain = [readers.Line(*ends) for ends in zip(corners, np.roll(corners, -1, axis=0), strict=True)]
    assert 1e-3 < nearest(chain) < NEAR


def test_dxf_arcs_touch_and_are_within_their_tolerance(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    chain = readers.dxf_arcs(write_outline(LARGE_ELLIPSE, tmp_path / "p.dxf", "dxf arcs", tolerance="2 um"))
    assert caplog.messages == []
    assert nearest(chain) < NEAR
    for one, other in zip(chain, [*chain[1:], chain[0]], strict=True):
        assert isinstance(one, readers.Arc)
        assert isinstance(other, readers.Arc)
        assert np.abs(one.stop - other.start).max() < 1e-9
        assert np.abs(one.arrives() - other.leaves()).max() < 1e-7


def test_an_svg_is_at_scale(tmp_path: Path) -> None:
    beziers = readers.svg_beziers(write_outline(LARGE_ELLIPSE, tmp_path / "p.svg", tolerance="2 um", decimals=4))
    curve = BPoly(beziers.transpose(1, 0, 2), np.arange(len(beziers) + 1.0))(np.linspace(0, len(beziers), 4001))
    assert np.abs((curve[:, 0] / 60.0) ** 2 + (curve[:, 1] / 30.0) ** 2 - 1.0).max() * 30.0 < 2 * NEAR
    assert curve[:, 1].max() == pytest.approx(30.0, abs=NEAR)


def test_points_are_rounded_to_the_decimals_asked_for(tmp_path: Path) -> None:
    rows = readers.table(write_outline(LARGE_ELLIPSE, tmp_path / "p.csv", points=361, decimals=3))
    exact = 1e3 * LARGE_ELLIPSE(np.radians(rows[:, 0]))
    assert len(rows) == 361
    assert (rows[:, 1:] == np.round(rows[:, 1:], 3)).all()
    assert 2e-4 < np.abs(rows[:, 1:] - exact).max() <= 5.01e-4


def test_radii_are_those_at_even_polar_angles(tmp_path: Path) -> None:
    bearings, radii = readers.table(
        write_outline(LARGE_ELLIPSE, tmp_path / "p.csv", "csv polar", points=73, decimals=9)
    ).T
    x, y = np.cos(np.radians(bearings)) / 60.0, np.sin(np.radians(bearings)) / 30.0
    assert radii == pytest.approx(1.0 / np.hypot(x, y), abs=1e-9)


@pytest.mark.parametrize("name", ["g-code", "g-code arcs"])
def test_moves_lead_around_within_their_tolerance(tmp_path: Path, name: str) -> None:
    file = write_outline(LARGE_ELLIPSE, tmp_path / "p.nc", name, tolerance="2 um", decimals=4, feed="300 mm/min")
    chain = readers.moves(file)
    assert nearest(chain) < NEAR
    assert (chain[-1].stop == chain[0].start).all()
    assert file.read_text("utf-8").splitlines()[3].endswith(" F300")
    for one in chain:
        if isinstance(one, readers.Arc):
            # controllers refuse arcs whose ends are not equally far from their centre
            assert float(np.linalg.norm(one.stop - one.centre)) == pytest.approx(one.radius, abs=3e-4)


def test_arcs_take_fewer_moves(tmp_path: Path) -> None:
    lines, turns = (
        len(readers.moves(write_outline(LARGE_ELLIPSE, tmp_path / f"{name}.nc", name)))
        for name in ("g-code", "g-code arcs")
    )
    assert turns < 0.3 * lines


@pytest.mark.parametrize("name", sorted(FORMATS))
def test_files_are_the_same_whenever_they_are_written_and_replaced_whole(tmp_path: Path, name: str) -> None:
    ending = next(key for key in ENDINGS if key[1:] == name[:3] or name.startswith("g-code"))
    file = write_outline(LARGE_ELLIPSE, tmp_path / f"p{ending}", name, decimals=5, about="x <b> (\n) made")
    first = file.read_bytes()
    assert write_outline(LARGE_ELLIPSE, file, name, decimals=5, about="x <b> (\n) made").read_bytes() == first
    # every digit counts: a file that says the same in fewer of them is another
    fewer: dict[str, Any] = {"decimals": 4, "tolerance": "1.1 um", "about": "x"}
    with pytest.raises(InputError, match="with other contents"):
        write_outline(LARGE_ELLIPSE, file, name, **fewer)
    assert file.read_bytes() == first
    assert write_outline(LARGE_ELLIPSE, file, name, force=True, **fewer).read_bytes() != first
    assert [one.name for one in tmp_path.iterdir()] == [file.name]


def test_wrong_entries_name_themselves(tmp_path: Path) -> None:
    for arguments, match in (
        ({"tolerance": "1 s"}, "tolerance must be a length"),
        ({"tolerance": "0 mm"}, "tolerance must be above 0"),
        ({"tolerence": "1 um"}, "did you mean 'tolerance'"),
        ({"decimals": 2.5}, "decimals must be an integer"),
        ({"degree": 4}, "degree must be 3 or 5"),
        ({"as_": "dxf splines"}, "did you mean 'dxf spline'"),
    ):
        with pytest.raises(InputError, match=match):
            write_outline(LARGE_ELLIPSE, tmp_path / "profile.dxf", **arguments)
    with pytest.raises(InputError, match="names no format"):
        write_outline(LARGE_ELLIPSE, tmp_path / "profile.iges")
    with pytest.raises(InputError, match="turns back as seen from the centre"):
        write_outline(aside(), tmp_path / "p.csv", "csv polar")
    assert list(tmp_path.iterdir()) == []


def aside() -> Ellipse:
    class Aside(Ellipse):
        def __call__(self, angle: np.ndarray, nu: int = 0) -> np.ndarray:
            return super().__call__(angle, nu) + (0.07 if nu == 0 else 0.0)

    return Aside(0.06, 0.03)


def test_without_ezdxf_the_error_says_what_to_install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "ezdxf", None)
    with pytest.raises(InputError, match=r"pip install 'optlaws\[cad\]'"):
        write_outline(LARGE_ELLIPSE, tmp_path / "p.dxf")


# --- curves of a cam ---


def test_each_curve_of_a_cam_is_exported(tmp_path: Path) -> None:
    cam = cam_of("translating roller")
    angles = np.linspace(0.0, 2 * np.pi, 91)
    curves: list[tuple[dict[str, Any], PlaneCurve]] = [
        ({}, cam.profile),
        ({"curve": "pitch"}, cam.pitch_curve),
        ({"cutter_radius": "8 mm"}, cam.cutter_path("8 mm")),
    ]
    for number, (arguments, curve) in enumerate(curves):
        rows = readers.table(cam.export(tmp_path / f"cam{number}.csv", points=91, decimals=7, **arguments))
        assert rows[:, 1:] == pytest.approx(1e3 * curve(angles), abs=1e-7)
    spline = readers.dxf_spline(cam.export(tmp_path / "cam.dxf"))
    assert spline(angles) == pytest.approx(1e3 * cam.profile(angles), abs=1.1e-3)


def test_what_cannot_be_exported_says_why(tmp_path: Path) -> None:
    cam = cam_of("translating roller")
    wrong: list[tuple[dict[str, Any], str]] = [
        ({"curve": "pich"}, "did you mean 'pitch'"),
        ({"curve": "cutter"}, "cutter_radius='10 mm'"),
        ({"curve": "pitch", "cutter_radius": "8 mm"}, "go together"),
        ({"cutter_radius": "0 mm"}, "cutter_radius must be above 0"),
    ]
    for arguments, match in wrong:
        with pytest.raises(InputError, match=match):
            cam.export(tmp_path / "cam.dxf", **arguments)
    motion = CamMotion.of_law("cycloidal", "40 mm", "120 deg")
    with pytest.raises(InputError, match="whole turn"):
        DiscCam(motion, "80 mm", TranslatingRoller("12 mm")).export(tmp_path / "cam.dxf")
    assert list(tmp_path.iterdir()) == []
