import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import ezdxf.filemanagement
import numpy as np
import pytest
from scipy.interpolate import BPoly

from optlaws import InputError
from tests.cams.curves import readers
from tests.cams.outlines import Ellipse
from tests.internals.cams import ENDINGS, FORMATS, write_outline

ELLIPSE = Ellipse(0.06, 0.03, (0.0, 1.0, 2 * np.pi))
ANGLES = np.linspace(0.0, 2 * np.pi, 1501)
POINTS = 1e3 * ELLIPSE(ANGLES)
#: of a millimetre: the tolerance asked for, and the rounding of coordinates
NEAR = 2e-3 + 1e-4


def test_a_dxf_spline_is_read_back_with_all_its_digits(tmp_path: Path) -> None:
    for degree in (3, 5):
        file = write_outline(ELLIPSE, tmp_path / f"profile{degree}.dxf", tolerance="0.01 um", degree=degree)
        found = readers.dxf_spline(file)
        assert found.k == degree
        assert ezdxf.filemanagement.readfile(file).header["$INSUNITS"] == 4
        assert float(np.linalg.norm(found(ANGLES) - POINTS, axis=1).max()) < 1.0001e-5
        assert np.abs(found(0.0, 1) - found(2 * np.pi - 1e-13, 1)).max() < 1e-6


def nearest(chain: Sequence[readers.Arc | readers.Line]) -> float:
    return float(np.min([one.distances(POINTS) for one in chain], axis=0).max())


def test_a_dxf_polyline_is_within_its_tolerance(tmp_path: Path) -> None:
    corners = readers.dxf_corners(
        write_outline(ELLIPSE, tmp_path / "p.dxf", "dxf polyline", tolerance="2 um", decimals=4)
    )
    chain = [readers.Line(*ends) for ends in zip(corners, np.roll(corners, -1, axis=0), strict=True)]
    assert 1e-3 < nearest(chain) < NEAR


def test_dxf_arcs_touch_and_are_within_their_tolerance(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    chain = readers.dxf_arcs(write_outline(ELLIPSE, tmp_path / "p.dxf", "dxf arcs", tolerance="2 um"))
    assert caplog.messages == []
    assert nearest(chain) < NEAR
    for one, other in zip(chain, [*chain[1:], chain[0]], strict=True):
        assert isinstance(one, readers.Arc)
        assert isinstance(other, readers.Arc)
        assert np.abs(one.stop - other.start).max() < 1e-9
        assert np.abs(one.arrives() - other.leaves()).max() < 1e-7


def test_an_svg_is_at_scale(tmp_path: Path) -> None:
    beziers = readers.svg_beziers(write_outline(ELLIPSE, tmp_path / "p.svg", tolerance="2 um", decimals=4))
    curve = BPoly(beziers.transpose(1, 0, 2), np.arange(len(beziers) + 1.0))(np.linspace(0, len(beziers), 4001))
    assert np.abs((curve[:, 0] / 60.0) ** 2 + (curve[:, 1] / 30.0) ** 2 - 1.0).max() * 30.0 < 2 * NEAR
    assert curve[:, 1].max() == pytest.approx(30.0, abs=NEAR)


def test_points_are_rounded_to_the_decimals_asked_for(tmp_path: Path) -> None:
    rows = readers.table(write_outline(ELLIPSE, tmp_path / "p.csv", points=361, decimals=3))
    exact = 1e3 * ELLIPSE(np.radians(rows[:, 0]))
    assert len(rows) == 361
    assert (rows[:, 1:] == np.round(rows[:, 1:], 3)).all()
    assert 2e-4 < np.abs(rows[:, 1:] - exact).max() <= 5.01e-4


def test_radii_are_those_at_even_polar_angles(tmp_path: Path) -> None:
    bearings, radii = readers.table(write_outline(ELLIPSE, tmp_path / "p.csv", "csv polar", points=73, decimals=9)).T
    x, y = np.cos(np.radians(bearings)) / 60.0, np.sin(np.radians(bearings)) / 30.0
    assert radii == pytest.approx(1.0 / np.hypot(x, y), abs=1e-9)


@pytest.mark.parametrize("name", ["g-code", "g-code arcs"])
def test_moves_lead_around_within_their_tolerance(tmp_path: Path, name: str) -> None:
    file = write_outline(ELLIPSE, tmp_path / "p.nc", name, tolerance="2 um", decimals=4, feed="300 mm/min")
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
        len(readers.moves(write_outline(ELLIPSE, tmp_path / f"{name}.nc", name))) for name in ("g-code", "g-code arcs")
    )
    assert turns < 0.3 * lines


@pytest.mark.parametrize("name", sorted(FORMATS))
def test_files_are_the_same_whenever_they_are_written_and_replaced_whole(tmp_path: Path, name: str) -> None:
    ending = next(key for key in ENDINGS if key[1:] == name[:3] or name.startswith("g-code"))
    file = write_outline(ELLIPSE, tmp_path / f"p{ending}", name, decimals=5, about="x <b> (\n) made")
    first = file.read_bytes()
    assert write_outline(ELLIPSE, file, name, decimals=5, about="x <b> (\n) made").read_bytes() == first
    # every digit counts: a file that says the same in fewer of them is another
    fewer: dict[str, Any] = {"decimals": 4, "tolerance": "1.1 um", "about": "x"}
    with pytest.raises(InputError, match="with other contents"):
        write_outline(ELLIPSE, file, name, **fewer)
    assert file.read_bytes() == first
    assert write_outline(ELLIPSE, file, name, force=True, **fewer).read_bytes() != first
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
            write_outline(ELLIPSE, tmp_path / "profile.dxf", **arguments)
    with pytest.raises(InputError, match="names no format"):
        write_outline(ELLIPSE, tmp_path / "profile.iges")
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
        write_outline(ELLIPSE, tmp_path / "p.dxf")
