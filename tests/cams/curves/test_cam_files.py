from pathlib import Path
from typing import Any

import numpy as np
import pytest

from optlaws import CamMotion, DiscCam, InputError, TranslatingRoller
from tests.cams.curves import readers
from tests.cams.placed import cam_of
from tests.internals.cams import PlaneCurve


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
