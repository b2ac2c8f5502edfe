"""The command `optlaws follower`."""

import json
from math import pi
from typing import Any

import pytest

from optlaws import Follower, MotionLaw, catalogue, polydyne, savin
from tests.internals.cli import app_of_cli as app

Capture = pytest.CaptureFixture[str]
KEYS = [
    "frequency",
    "damping",
    "dynamic_factor",
    "peak_acceleration",
    "dwell_acceleration",
    "residual_displacement",
    "residual_acceleration",
    "off_design",
    "cam",
]


def called(capsys: Capture, *arguments: object) -> tuple[int, str, str]:
    code = app.exit_code(["follower", *(str(argument) for argument in arguments)])
    return code, *capsys.readouterr()


def printed(capsys: Capture, *arguments: object) -> dict[str, Any]:
    code, out, err = called(capsys, *arguments, "--json")
    assert (code, err, out.count("\n")) == (0, "", 1)
    data: dict[str, Any] = json.loads(out)
    assert list(data) == KEYS
    return data


def test_a_polydyne_cam_off_its_design(capsys: Capture) -> None:
    numbers = printed(capsys, "III", "--alpha", 7.2, "--frequency", 19, "--damping", 0.05, "--design-frequency", 20)
    law = savin("III", 7.2)
    cam = polydyne(law, 20, 0.05)
    response = Follower(19, 0.05).response(cam)
    assert MotionLaw.from_dict(numbers["cam"]["law"]) == cam
    assert numbers["dynamic_factor"] == response.dynamic_factor(law)
    assert numbers["residual_acceleration"] == response.residual_acceleration
    assert [one["percent"] for one in numbers["off_design"]] == [-10, -5, 0, 5, 10]
    assert numbers["off_design"][2]["dynamic_factor"] == numbers["dynamic_factor"]


def test_a_design_without_damping_on_a_damped_follower(capsys: Capture) -> None:
    options = ("--frequency", 20, "--damping", 0.05, "--design-frequency", 20, "--design-damping", 0)
    numbers = printed(capsys, "IV", "--alpha", 11, *options)
    assert numbers["dynamic_factor"] == pytest.approx(0.983268, abs=1e-6)


def test_a_law_of_the_catalogue_at_a_speed(capsys: Capture) -> None:
    numbers = printed(capsys, "BESTEHORN", "--speed", "105 rpm", "--rise", "120 deg", "--natural-period", "60 ms")
    response = Follower(numbers["frequency"]).response(catalogue["cycloidal"].law)
    assert numbers["frequency"] == pytest.approx(60 * 2.0943951 / (105 * 0.06))
    assert numbers["residual_displacement"] == response.residual_displacement


def test_what_a_person_reads(capsys: Capture) -> None:
    code, out, err = called(capsys, "IV", "--alpha", 11, "--frequency", 18, "--design-frequency", 20)
    assert (code, err) == (0, "")
    for part in ("dynamic factor", "1.185564348", "residual acceleration", "2.807512597", "6.292873872", "-10 %"):
        assert part in out


MACHINE = ("--natural-frequency", "16.7 Hz", "--speed", "105 rpm", "--rise", "120 deg")


def test_a_stroke_with_its_unit_gives_machine_units(capsys: Capture) -> None:
    code, out, _ = called(capsys, "modified sine", *MACHINE, "--stroke", "35mm", "--json")
    assert code == 0
    data = json.loads(out)
    times: dict[str, Any] = {"speed": "105 rpm", "rise": "120 deg"}
    response = Follower.from_vibration("16.7 Hz", **times).response(catalogue["modified sine"].law)
    assert data["machine"] == response.in_units("35 mm", **times)
    code, out, _ = called(
        capsys,
        "modified sine",
        "--speed",
        "105 rpm",
        "--rise",
        "120 deg",
        "--natural-period",
        "60 ms",
        "--stroke",
        "35mm",
    )
    assert code == 0
    assert "residual displacement, m" in out
    assert printed(capsys, "modified sine", *MACHINE)["frequency"] == data["frequency"]


def test_laws_are_compared_at_a_frequency_in_hertz_beside_the_duration(capsys: Capture) -> None:
    def compared(*options: str) -> dict[str, Any]:
        assert app.exit_code(["compare", "cycloidal", "345", "--json", *options]) == 0
        known: dict[str, Any] = json.loads(capsys.readouterr().out)
        return known

    band, nu = compared("--frequency", "12 Hz", "--frequency", "900 cpm", "--duration", "0.1 s"), [2.4 * pi, 3.0 * pi]
    assert band["frequency"] == pytest.approx(nu, rel=1e-14)
    alone = compared(*(part for each in band["frequency"] for part in ("--frequency", repr(each))))
    assert [row["residual"] for row in band["rows"]] == [row["residual"] for row in alone["rows"]]
