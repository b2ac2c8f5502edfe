"""The command `optlaws advise`: its table and sentences against the library's, its files, its exit codes."""

import json
from pathlib import Path

import pytest

from optlaws import Rise, advise
from tests.internals.cli import app_of_cli as app
from tests.internals.jobs import STARTERS

Capture = pytest.CaptureFixture[str]
MOVE = ("--stroke", "35mm", "--duration", "0.1s", "--degree", "9")


def called(capsys: Capture, *arguments: object) -> tuple[int, str, str]:
    code = app.exit_code(["advise", *(str(argument) for argument in arguments)])
    return code, *capsys.readouterr()


def test_a_move_is_advised_as_the_library_does(capsys: Capture, tmp_path: Path) -> None:
    proofs, picture = tmp_path / "proofs.json", tmp_path / "advice.svg"
    options = ("--frequency", "30Hz", "--mass", "2kg", "--limit", "velocity=640 mm/s", "--law", "cycloidal")
    code, out, err = called(
        capsys, *MOVE, *options, "--law", "modified sine", "--points", 2, "--output", proofs, "--plot", picture
    )
    known = advise(
        Rise("35 mm", "0.1 s"),
        follower={"frequency": "30 Hz"},
        drive={"mass": "2 kg"},
        limits={"velocity": "640 mm/s"},
        laws=["cycloidal", "modified sine"],
        degree=9,
        points=2,
    )
    assert (code, err) == (0, "")
    lines = out.splitlines()
    assert lines[0].split("  ")[0] == "law"
    assert "residual acceleration, m/s²" in lines[0]
    assert [line.split("  ")[0] for line in lines[1 : len(known) + 1]] == [law.name for law in known]
    facts = [(name, value.strip()) for name, _, value in (line.partition("  ") for line in lines[len(known) + 1 :])]
    assert facts[0] == ("recommended", known.recommendation.law.name)
    assert [value for name, value in facts if name == "why"] == list(known.recommendation.sentences)
    assert facts[-1] == ("rule", known.recommendation.rule)
    assert picture.read_text("utf-8").lstrip().startswith("<?xml")
    stored = json.loads(proofs.read_text("utf-8"))["move"]
    assert list(stored["laws"]) == [law.name for law in known if law.solutions]
    assert app.exit_code(["verify", str(proofs)]) == 0
    assert capsys.readouterr().out.count("proven") >= len(stored["laws"])


def test_an_axis_of_a_problem_file_is_chosen(capsys: Capture) -> None:
    code, out, err = called(capsys, "cycle_die_and_table", "--axis", "die", "--points", 0, "--json")
    assert (code, err) == (0, "")
    advice = json.loads(out)
    assert list(advice) == ["die"]
    assert all("solutions" not in law for law in advice["die"]["laws"])
    assert advice["die"]["recommendation"]["law"] in [law["name"] for law in advice["die"]["laws"]]


def test_a_cam_is_advised_by_its_own_file_and_by_its_degrees_and_speed(capsys: Capture, tmp_path: Path) -> None:
    file = tmp_path / "feed.toml"
    file.write_text(
        'job = "cam"\ntitle = "Feed"\nspeed = "180 rpm"\n[follower]\nkind = "translating roller"\nradius = "12 mm"\n'
        '[motion]\nname = "slide"\ndrive = { mass = "3 kg" }\n'
        + "".join(f'[[motion.segment]]\nkind = "{kind}"\n' for kind in ("rise", "dwell", "return", "dwell"))
        .replace('"rise"', '"rise"\nby = "40 mm"\nduration = "110 deg"')
        .replace('"return"', '"return"\nduration = "110 deg"')
        .replace('"dwell"', '"dwell"\nduration = "90 deg"', 1),
        "utf-8",
    )
    code, out, err = called(capsys, file, "--points", 0, "--json")
    assert (code, err) == (0, "")
    cam = json.loads(out)["slide"]["recommendation"]
    code, out, err = called(
        capsys, "--stroke", "40mm", "--duration", "110deg", "--speed", "180rpm", "--points", 0, "--json"
    )
    assert (code, err) == (0, "")
    move = json.loads(out)["recommendation"]
    assert (cam["law"], cam["rule"], cam["sentences"][0]) == (move["law"], move["rule"], move["sentences"][0])
    assert cam["gain"] == pytest.approx(move["gain"], rel=1e-6)


def test_advice_of_a_cam_says_what_of_its_file_is_no_part_of_it(capsys: Capture, tmp_path: Path) -> None:
    numbers = {"stroke": "40mm", "rise": "110deg", "return": "110deg", "speed": "180rpm"}
    file = tmp_path / "feed.toml"
    file.write_text(STARTERS["cam"].text(numbers, file), "utf-8")
    code, out, err = called(capsys, file, "--points", 0, "--degree", 5)
    assert (code, err) == (0, "")
    words = "without pressure_angle and radius_of_curvature of the cam: `optlaws run` counts them."
    assert out.splitlines()[-1] == f"The advice is of the motion by itself, {words}"


def test_limits_that_no_law_keeps_end_with_3(capsys: Capture) -> None:
    limits = ("--limit", "velocity=360 mm/s", "--limit", "acceleration=16 m/s^2", "--points", "0")
    code, _, err = called(capsys, *MOVE, *limits)
    assert code == 3
    assert "infeasible: " in err
