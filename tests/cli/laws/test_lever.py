"""The command `optlaws lever`."""

import json
from math import radians
from pathlib import Path

import pytest

from optlaws import MotionLaw
from tests.internals.cli import app_of_cli as app

Capture = pytest.CaptureFixture[str]
EXAMPLE = ["lever", "--beta", "0.75", "--lam", "1", "--swing", "60"]


def test_json_holds_the_worked_example(capsys: Capture) -> None:
    assert app.exit_code([*EXAMPLE, "--json"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert data["swing"] == pytest.approx(radians(60))
    assert data["xi"] == pytest.approx(0.53768926, rel=1e-7)
    assert data["exact"]["T"] == pytest.approx(6.1007472, rel=1e-7)
    assert data["asymptotic"]["C3"] == pytest.approx(-4.8528032, rel=1e-7)
    assert MotionLaw.from_dict(data["law"]).a(1.0) == pytest.approx(1.0)


def test_the_table_compares_both_motions(capsys: Capture) -> None:
    assert app.exit_code([*EXAMPLE, "--nu", "0"]) == 0
    out = capsys.readouterr().out
    assert "deg at least: slack" in out
    assert any(line.startswith("B3 ") for line in out.splitlines())


def test_stiffness_for_a_period(capsys: Capture) -> None:
    assert app.exit_code([*EXAMPLE, "--inertia", "0.02", "--period", "0.1", "--json"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert data["stiffness_1"] == pytest.approx(0.02 * (data["exact"]["T"] / 0.1) ** 2)
    assert data["stiffness_2"] == pytest.approx(data["xi"] * data["stiffness_1"])


def test_wanted_constants(capsys: Capture, tmp_path: Path) -> None:
    file = tmp_path / "law.json"
    assert app.exit_code(["lever", "--lam", "1", "--swing", "60", "--target", "B1/B3=0.99", "--output", str(file)]) == 0
    assert "0.7174349" in capsys.readouterr().out
    assert MotionLaw.from_dict(json.loads(file.read_text())["law"]).b(0.0) == pytest.approx(0.0, abs=1e-14)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["lever", "--swing", "60"], "give --beta and --lam, or with --target"),
        ([*EXAMPLE, "--inertia", "1"], "--inertia goes with --stiffness or --period"),
        ([*EXAMPLE, "--inertia", "1", "--period", "1", "--stiffness", "1"], "exclude each other"),
        ([*EXAMPLE, "--target", "B1"], "--target takes NAME=NUMBER"),
        (["lever", "--beta", "1.5", "--lam", "1", "--swing", "60"], "the limit is 150 deg (least_transmission)"),
        (
            ["lever", "--beta", "1", "--lam", "1", "--swing", "600"],
            "--swing must be above 0 and below 180 degrees, got 600",
        ),
    ],
)
def test_errors_are_one_clear_text(capsys: Capture, arguments: list[str], message: str) -> None:
    assert app.exit_code(arguments) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("optlaws: ")
    assert message in err
    assert "Traceback" not in err
