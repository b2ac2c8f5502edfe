"""Barrel cams: flanks against the roller as a cylinder in space, at places it can be anywhere on its way."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from optlaws import BarrelCam, CamMotion, Cycle, Dwell, InputError, Return, Rise
from tests.cams.placed import TURNINGS, cycle_of
from tests.internals.cams import FREE, UNDERCUT

Array = NDArray[np.float64]

ANGLES = np.linspace(0.0, 2.0 * np.pi, 401)[:-1] + 0.002


def barrel(turning: str = "counterclockwise", roller: str = "8 mm", stroke: str = "40 mm") -> BarrelCam:
    return BarrelCam(cycle_of(stroke), "60 mm", "12 mm", roller, turning=turning)  # type: ignore[arg-type]


def distances(points: Array, cam: BarrelCam, angles: Array) -> Array:
    """How far places on the cam are from the axis of the roller at angles of the cam; a row a place."""
    turned = TURNINGS[cam.turning] * angles
    axis = np.stack([np.sin(turned), np.cos(turned), np.zeros(len(angles))], axis=-1)
    away = points[:, None, :] - np.stack([0 * angles, 0 * angles, cam.displacement(angles)], axis=-1)[None]
    along = (away * axis[None]).sum(axis=-1)
    return np.asarray(np.where(along > 0, np.linalg.norm(away - along[..., None] * axis[None], axis=-1), np.inf))


@pytest.mark.parametrize("turning", TURNINGS)
@pytest.mark.parametrize("side", ["upper", "lower"])
def test_a_roller_touches_the_flank_and_never_cuts_it(turning: str, side: str) -> None:
    cam = barrel(turning)
    for radius in (0.048, 0.053, 0.06):
        flank = cam.flank(side, radius)  # type: ignore[arg-type]
        found = distances(flank(ANGLES), cam, ANGLES)
        assert np.allclose(np.diag(found), 0.008, atol=1e-15)
        assert found.min() >= 0.008 - 1e-15
        above = flank(ANGLES)[:, 2] - cam.displacement(ANGLES)
        assert (above > 0).all() if side == "upper" else (above < 0).all()


def test_derivatives_are_those_of_the_curves() -> None:
    cam, step = barrel(), 1e-5
    inner = ANGLES[np.abs(ANGLES[:, None] - np.array(cam.displacement.breaks)).min(axis=1) > 3 * step]
    for curve in (cam.pitch_curve, cam.flank("lower", 0.05), cam.cutter_path("5 mm")):
        for nu in (1, 2):
            differences = (curve(inner + step, nu - 1) - curve(inner - step, nu - 1)) / (2 * step)
            assert np.allclose(curve(inner, nu), differences, atol=2e-6)
    assert np.allclose(cam.cutter_path("8 mm")(ANGLES), cam.pitch_curve(ANGLES), atol=1e-15)
    differences = (cam.pressure_angle(inner + step) - cam.pressure_angle(inner - step)) / (2 * step)
    assert np.allclose(cam.pressure_angle(inner, 1), differences, atol=1e-6)


def test_a_table_that_advances_is_refused_by_its_own_reason() -> None:
    for by in ("45 deg", "40 mm"):
        indexing = Cycle([Rise(by, "120 deg"), Dwell()], speed="60 rpm", advance=by)
        with pytest.raises(InputError, match=r"several rollers on a circle.*run the motion of the table as a cycle"):
            BarrelCam(indexing, "60 mm", "12 mm", "8 mm")


def test_the_pressure_angle_is_that_of_the_developed_groove() -> None:
    cam = barrel()
    assert np.allclose(np.tan(cam.pressure_angle(ANGLES)), cam.displacement(ANGLES, 1) / 0.048, rtol=1e-13)
    least, greatest = cam.pressure_angles
    assert np.tan(greatest.value) == pytest.approx(0.04 * 2.0 / np.radians(140.0) / 0.048, rel=1e-11)
    assert np.tan(-least.value) == pytest.approx(0.04 * 2.0 / np.radians(120.0) / 0.048, rel=1e-11)


def test_undercut_is_proven_where_the_roller_cuts_and_nowhere_else() -> None:
    sharp = Cycle(
        [
            Rise("20 mm", "60 deg", law="cycloidal"),
            Dwell("60 deg"),
            Return("20 mm", "60 deg", law="cycloidal"),
            Dwell(),
        ],
        period="1 s",
    )
    statuses = []
    for millimetres in np.linspace(4.0, 30.0, 7):
        cam = BarrelCam(sharp, "60 mm", "12 mm", f"{millimetres:.3f} mm")
        inner = [distances(cam.flank(side, 0.048)(ANGLES), cam, ANGLES).min() for side in ("upper", "lower")]
        depth = cam.roller - float(min(inner))
        statuses.append(cam.undercut)
        assert depth < 1e-12 or cam.undercut != FREE
        if cam.undercut == UNDERCUT:
            assert depth > 1e-9
    assert statuses[0] == FREE
    assert statuses[-1] == UNDERCUT


def test_steep_grooves_are_proven_free_of_cusps_at_every_depth() -> None:
    """Above 45 deg the bottom is no longer worst: flanks go on at every depth where they are said to."""
    statuses = []
    for roller in ("4 mm", "9 mm", "18 mm"):
        cam = BarrelCam(cycle_of("75 mm"), "60 mm", "30 mm", roller)
        assert np.degrees(cam.pressure_angles[1].value) > 50.0
        slope, bend = (np.asarray(cam.displacement(ANGLES, nu)) for nu in (1, 2))
        radius = np.linspace(0.03, 0.06, 61)[:, None]
        way = np.hypot(radius, slope)
        rest = way - cam.roller * radius * np.abs(bend) / way**2 - cam.roller**2 * slope**2 / way**3
        statuses.append(cam.undercut)
        assert rest.min() > 0.0 or cam.undercut != FREE
    assert statuses[0] == FREE


def test_grooves_that_cannot_be_are_refused_with_a_remedy() -> None:
    with pytest.raises(InputError, match="make the groove shallower"):
        BarrelCam(cycle_of("40 mm"), "60 mm", "70 mm", "8 mm")
    with pytest.raises(InputError, match="make the roller smaller"):
        barrel(roller="50 mm")
    with pytest.raises(InputError, match="take a smaller one"):
        barrel().cutter_path("9 mm")
    with pytest.raises(InputError, match="within the groove"):
        barrel().flank("upper", 0.07)
    with pytest.raises(InputError, match="side"):
        barrel().flank("left")  # type: ignore[arg-type]
    with pytest.raises(InputError, match="take an oscillating follower"):
        BarrelCam(CamMotion.of_law("cycloidal", "40 deg", "90 deg"), "60 mm", "12 mm", "8 mm")
