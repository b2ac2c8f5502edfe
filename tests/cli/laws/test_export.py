"""The command `optlaws export`: what it writes and says, and what it refuses."""

import json
from pathlib import Path

import pytest

from tests.documents import ROOT
from tests.internals.cli import exit_code
from tests.internals.exports import FORMATS

Capture = pytest.CaptureFixture[str]
LAW = ["cycloidal", "--stroke", "35 mm", "--master", "120 deg", "--time", "0.1 s"]
TABLE = str(ROOT / "problems" / "cycle_rotary_table.toml")


def test_the_file_goes_to_stdout_and_the_report_to_stderr(capsys: Capture) -> None:
    assert exit_code(["export", *LAW, "--to", "csv", "--points", "37", "--counts", "65536"]) == 0
    out, err = capsys.readouterr()
    assert out.startswith(
        "# table: master in deg from 0 to 120, 1200 deg/s, slave in mm; made by optlaws\nx deg,y mm\n0,0\n"
    )
    assert out.count("\n") == 39
    assert "37 points" in err
    assert "rounding adds at most" in err


def test_a_file_is_written_and_never_lost(tmp_path: Path, capsys: Capture) -> None:
    file = tmp_path / "cam.csv"
    file.write_text("mine\n", "utf-8")
    command = ["export", *LAW, "--to", "sew", "--points", "13", "--output", str(file)]
    assert exit_code(command) == 2
    assert file.read_text("utf-8") == "mine\n"
    assert "--force" in capsys.readouterr().err
    assert exit_code([*command, "--force"]) == 0
    assert "cubics whose acceleration jumps" in capsys.readouterr().out
    written = file.read_bytes()
    assert exit_code(command) == 0
    assert file.read_bytes() == written
    assert [one.name for one in tmp_path.iterdir()] == ["cam.csv"]


def test_an_axis_of_a_problem_file(capsys: Capture) -> None:
    assert exit_code(["export", TABLE, "--to", "csv", "--axis", "table", "--points", "30", "--json"]) == 0
    output = json.loads(capsys.readouterr().out)
    assert (output["points"], output["IsPeriodic"], output["units"]["slave"]) == (30, True, "deg")
    assert output["text"].count("\n") == 32


def test_the_formats_are_listed(capsys: Capture) -> None:
    assert exit_code(["export", "--list", "--json"]) == 0
    assert [load["name"] for load in json.loads(capsys.readouterr().out)] == sorted(FORMATS)
    assert exit_code(["export", "--list"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines[1:]] == sorted(FORMATS)
    assert max(map(len, lines)) < 100
    assert exit_code(["export", "--list", "--to", "csv"]) == 0
    assert "as asked: linear, cubic, akima" in capsys.readouterr().out
