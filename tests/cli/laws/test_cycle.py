"""`optlaws cycle FILE --fastest`: a table, exit codes, results whose proofs are verified, errors that name the axis."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from optlaws import catalogue
from optlaws.verification import verify_all
from tests.documents import ROOT
from tests.internals.cli import exit_code
from tests.internals.explorer import start
from tests.jobs.examples import SOLUTIONS, SOLUTIONS_PRINTED

FASTEST = ROOT / "problems" / "cycle_fastest.toml"
PRESS = ROOT / "problems" / "cycle_press.toml"

Capture = pytest.CaptureFixture[str]


def test_the_greatest_speed_is_printed(capsys: Capture) -> None:
    assert exit_code(["cycle", str(PRESS), "--fastest"]) == 0
    out = capsys.readouterr().out
    assert re.search(r"^greatest speed +271\.4497\d+ rpm$", out, re.MULTILINE)
    assert "10 % more velocity: 298.595 rpm, 10 % faster" in out


@pytest.mark.long
def test_the_proofs_of_the_results_are_verified(tmp_path: Path) -> None:
    assert exit_code(["cycle", str(FASTEST), "--fastest", "--out", str(tmp_path)]) == 0
    proofs = json.loads((tmp_path / "fastest.json").read_text("utf-8"))
    assert [entry.infeasible for entry in verify_all(proofs).values()] == [True, True]
    page = (tmp_path / "cycle.md").read_text("utf-8")
    assert "no time left, by deceleration 15 m/s^2" in page
    assert "| whole cycle | 0        | 384.3548  | 360" in page


def test_it_is_one_json_object(capsys: Capture) -> None:
    assert exit_code(["cycle", str(PRESS), "--fastest", "--json"]) == 0
    slide = json.loads(capsys.readouterr().out)["slide"]
    assert slide["status"] == "optimal"
    assert slide["rpm"] == pytest.approx(60.0 / slide["period"])
    assert slide["lower_bound"] < slide["period"]
    assert [each["binding"] for each in slide["segments"]] == [False, True]


@pytest.mark.parametrize(
    ("limits", "code", "says"),
    [
        ('{ velocity = "616 mm/s" }', 0, ""),
        pytest.param(
            '{ power = "30 W" }', 1, "axis slide: no proof that no law is faster was found", marks=pytest.mark.long
        ),
        ("{ }", 2, "axis slide: no limit bounds the motions"),
        ('{ force = "10 N" }', 3, "axis slide: segment 1 (Rise): at its start"),
    ],
)
def test_exit_codes(limits: str, code: int, says: str, capsys: Capture, tmp_path: Path) -> None:
    text = PRESS.read_text("utf-8").replace('{ velocity = "616 mm/s" }', limits)
    file = tmp_path / "press.toml"
    file.write_text(text, "utf-8")
    assert exit_code(["cycle", str(file), "--fastest"]) == code
    assert says in capsys.readouterr().err


@pytest.mark.long
def test_a_machine_is_as_fast_as_its_slowest_axis(capsys: Capture, tmp_path: Path) -> None:
    text = PRESS.read_text("utf-8")
    start = text.index("[[axis]]")
    slow = text[start:].replace('"slide"', '"slow"').replace("616 mm/s", "308 mm/s")
    file = tmp_path / "two.toml"
    file.write_text("fastest = true\n" + text + "\n" + slow, "utf-8")
    assert exit_code(["cycle", str(file), "--out", str(tmp_path / "out")]) == 0
    capsys.readouterr()
    page = (tmp_path / "out" / "cycle.md").read_text("utf-8")
    assert "The machine is as fast as its slowest axis, slow: 135.72" in page
    facts = json.loads((tmp_path / "out" / "cycle.json").read_text("utf-8"))["axes"]
    assert facts["slide"]["period"] == pytest.approx(facts["slow"]["period"], rel=1e-12)


@pytest.mark.parametrize("law", ["better.json", "old.csv(tolerance=0.001)"])
def test_files_that_a_file_names_are_beside_it(
    law: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    """Its results and exports are those of the law, and need the law's file no more."""
    drawing, elsewhere = tmp_path / "drawing", tmp_path / "elsewhere"
    drawing.mkdir()
    elsewhere.mkdir()
    (drawing / "better.json").write_text(catalogue["modified sine"].law.to_json(), "utf-8")
    rows = [f"{k / 64};{catalogue['modified sine'].law.a(k / 64)!r}\n" for k in range(65)]
    (drawing / "old.csv").write_text("".join(rows), "utf-8")
    rise = f'kind = "rise"\nby = "35 mm"\nduration = "120 deg"\nlaw = "{law}"'
    head = 'job = "cycle"\ntitle = "Press"\nspeed = "200 rpm"\n[[axis]]\nname = "slide"\n'
    rest = '[[axis.segment]]\nkind = "return"\nlaw = "cycloidal"\n'
    (drawing / "press.toml").write_text(f"{head}[[axis.segment]]\n{rise}\n{rest}", "utf-8")
    monkeypatch.chdir(elsewhere)
    for command in ("export {} --to csv --output slide.csv", "cycle {} --out results"):
        assert exit_code(command.format("../drawing/press.toml").split()) == 0
    data = json.loads(Path("results", "cycle.json").read_text("utf-8"))
    assert data["axes"]["slide"]["segments"][0]["velocity"] == pytest.approx(0.35 * 1.759603, rel=5e-3)
    (shown,) = start("../drawing/press.toml")["machine"]["axis"]
    assert shown["segment"][0]["law"].startswith("{")
    (drawing / "better.json").unlink()
    (drawing / "old.csv").unlink()
    capsys.readouterr()
    exit_code(["verify", "results/cycle.json"])
    assert "cannot read" not in capsys.readouterr().err


def test_without_matplotlib_there_are_all_results_but_pictures(tmp_path: Path) -> None:
    program = (
        "import sys; sys.modules['matplotlib'] = None; from optlaws.cli import exit_code, main\n"
        f"assert exit_code(['cycle', {str(PRESS)!r}, '--out', 'results']) == 0\n"
        f"print('drawn', flush=True); main(['cycle', {str(PRESS)!r}, '--plot', 'x.svg'])"
    )
    command = [sys.executable, "-c", program]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout.rpartition("drawn")[2]) == (2, "\n")
    results, drawn = (" ".join(part.split()) for part in done.stderr.split("optlaws: drawing needs"))
    assert "the results have no pictures: drawing needs matplotlib: pip install matplotlib" in results
    assert drawn.startswith("matplotlib: pip install")
    assert {file.name for file in (tmp_path / "results").iterdir()} == {"cycle.md", "cycle.json", "slide.csv"}
    assert ".svg" not in (tmp_path / "results" / "cycle.md").read_text("utf-8")


def test_a_reader_who_has_seen_enough_leaves_the_results_of_all_files(tmp_path: Path) -> None:
    """As `| head` does: the pipe is closed before the first line."""
    for name in ("a", "b"):
        (tmp_path / f"{name}.toml").write_text(SOLUTIONS, "utf-8")
    (tmp_path / "printed.csv").write_text(SOLUTIONS_PRINTED, "utf-8")
    read, write = os.pipe()
    os.close(read)
    command = [sys.executable, "-m", "optlaws", "run", "a.toml", "b.toml"]
    done = subprocess.run(command, cwd=tmp_path, stdout=write, stderr=subprocess.PIPE, text=True, check=False)
    os.close(write)
    assert (done.returncode, done.stderr) == (0, "")
    assert all((tmp_path / "results" / name / "laws.json").exists() for name in "ab")
