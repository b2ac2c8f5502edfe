"""The command: one JSON object or one clear text, and an exit code that says what happened."""

import json
import re
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from unittest.mock import patch

import pytest

import optlaws
from optlaws import BoundaryConditions, MotionLaw, Problem, Solution, SolverFailure, law_from_z
from tests.documents import ROOT
from tests.internals.cli import app_of_cli as app
from tests.internals.cli import exit_code
from tests.internals.cycles import Candidates
from tests.jobs.examples import SOLUTIONS, SOLUTIONS_PRINTED

KEYS = ["status", "objective", "lower_bound", "gap", "best_possible", "constants", "z", "law", "iterations", "seconds"]
SOLVE = ["solve", "--peak-velocity", "1.641", "--order", "4", "--degree", "3"]
ROW_1_53 = "148.4156 -553.8533 771.0667 -514.0444"

Capture = pytest.CaptureFixture[str]


def called(capsys: Capture, *arguments: object) -> tuple[int, str, str]:
    code = app.exit_code([str(argument) for argument in arguments])
    return code, *capsys.readouterr()


def refused(capsys: Capture, *arguments: object, code: int = 2) -> str:
    found, out, err = called(capsys, *arguments)
    assert (found, out) == (code, "")
    assert err.startswith("optlaws: ")
    assert "Traceback" not in err
    assert err.endswith("\n")
    return err


# --- solve ---


@pytest.mark.parametrize("extra", [[], ["--basis", "chebyshev"], ["--monotone"], ["--minimise", "C"]])
def test_solve_prints_one_json_object(capsys: Capture, extra: list[str]) -> None:
    code, out, err = called(capsys, *SOLVE, *extra, "--json")
    assert (code, err) == (0, "")
    assert out.count("\n") == 1
    data = json.loads(out)
    assert list(data) == KEYS
    assert {name: sorted(peak) for name, peak in data["constants"].items()} == {name: ["k", "value"] for name in "BCDJ"}
    assert data["status"] == "optimal"
    assert data["objective"] == pytest.approx(6.872529, abs=1e-6)
    assert data["objective"] == data["constants"]["C"]["value"]
    assert data["lower_bound"] <= data["objective"]
    assert data["gap"] <= 1e-8
    assert data["best_possible"] == pytest.approx(1.641**2 / 0.641)
    assert isinstance(data["iterations"], int)
    assert data["seconds"] > 0.0


@pytest.mark.parametrize("basis", ["powers", "chebyshev"])
def test_z_and_the_law_of_the_json_are_the_same_law(capsys: Capture, basis: str) -> None:
    _, out, _ = called(capsys, *SOLVE, "--basis", basis, "--json")
    data = json.loads(out)
    law = MotionLaw.from_dict(data["law"])
    assert law.peak(2).value == data["objective"]
    again = law_from_z(BoundaryConditions.rest(4), data["z"])
    assert again.peak(2).value == pytest.approx(data["objective"], rel=1e-11)


def test_solve_without_json_says_what_was_found(capsys: Capture) -> None:
    code, out, err = called(capsys, *SOLVE)
    assert (code, err) == (0, "")
    best = "no law of order 4 with this B is below it, whatever its degree"
    for part in ("optimal", "6.87252932", "lower bound", best, "Problem(B=1.641, order=4"):
        assert part in out


def test_solve_writes_the_whole_solution(capsys: Capture, tmp_path: Path) -> None:
    target = tmp_path / "new folder" / "solution.json"
    assert called(capsys, *SOLVE, "--json", "--output", target)[0] == 0
    whole = json.loads(target.read_text("utf-8"))
    assert {*KEYS, "problem", "certificate", "versions"} <= whole.keys()
    assert Problem.from_dict(whole["problem"]) == Problem(B=1.641, order=4, basis=optlaws.Chebyshev(3))
    assert optlaws.Certificate.from_dict(whole["certificate"]).bound == whole["lower_bound"]


@pytest.mark.parametrize("json_", [[], ["--json"]])
def test_an_infeasible_problem_ends_with_3(capsys: Capture, json_: list[str]) -> None:
    text = refused(capsys, "solve", "--peak-velocity", 1.53, "--order", 4, "--degree", 1, *json_, code=3)
    assert text.startswith("optlaws: infeasible: ")
    assert "of order 4 with Z of degree 1 has b(1/2) = B = 1.53" in text
    (places,) = re.findall(r"the constraints contradict each other at k = ([\d., ]+)", text)
    known = [float(place) for place in places.split(", ")]
    assert known == sorted(set(known))
    assert "Problem(" not in text


def test_a_solver_that_fails_ends_with_4(capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    def fails(problem: Problem, **_: object) -> Solution:
        raise SolverFailure("no law was found", problem=problem, tried="IPOPT said 'Restoration_Failed'")

    monkeypatch.setattr(optlaws, "synthesize", fails)
    text = refused(capsys, *SOLVE, "--json", code=4)
    assert "Restoration_Failed" in text
    assert "Problem(B=1.641" in text


def test_an_interrupt_ends_with_130(capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*_: object, **__: object) -> Solution:
        raise KeyboardInterrupt

    monkeypatch.setattr(optlaws, "synthesize", interrupted)
    assert refused(capsys, *SOLVE, code=130) == "optlaws: interrupted\n"


def test_advice_and_a_front_that_are_stopped_show_what_there_is(
    capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    solve, counted = optlaws.synthesize, iter(range(7))

    def stopped(*given: Any, **options: Any) -> Solution:
        if next(counted, None) is None:
            raise KeyboardInterrupt
        return solve(*given, **options)

    monkeypatch.setattr("optlaws.synthesis.pareto.synthesize", stopped)
    assert exit_code(["front", "--points", "9", "--order", "4", "--degree", "5", "--over", "C,D"]) == 130
    shown = capsys.readouterr()
    assert "optlaws: the front was stopped after" in shown.err
    assert len([line for line in shown.out.splitlines() if line.endswith("local")]) >= 3
    within, named = Candidates._within, iter(range(3))

    def beyond(*given: Any) -> Any:
        if next(named, None) is None:
            raise KeyboardInterrupt
        return within(*given)

    monkeypatch.setattr(Candidates, "_within", beyond)
    assert exit_code(["advise", "--stroke", "35mm", "--duration", "0.1s", "--degree", "9"]) == 130
    shown = capsys.readouterr()
    assert "was stopped after" in shown.err
    assert "least acceleration" in shown.out


MOVE = ["solve", "--order", "3", "--fastest", "--stroke", "100 mm", "--limit", "jerk=300 m/s^3"]


def test_the_least_time_is_that_of_the_library(capsys: Capture, tmp_path: Path) -> None:
    file, pair = tmp_path / "move.json", "acceleration=-8 m/s^2, 12 m/s^2"
    code, out, err = called(capsys, *MOVE, "--limit", pair, "--end-velocity", "-0.1 m/s", "--json", "--output", file)
    assert (code, err) == (0, "")
    limits = {"jerk": "300 m/s^3", "acceleration": ("-8 m/s^2", "12 m/s^2")}
    move = optlaws.fastest(Problem(order=3), stroke="100 mm", limits=limits, end_velocity="-0.1 m/s")
    assert json.loads(out)["duration"] == move.duration
    assert json.loads(out)["limits"] == {"acceleration": 12.0, "deceleration": 8.0, "jerk": 300.0}
    assert called(capsys, "verify", file)[0] == 0


# --- a law by its Z ---


def test_a_printed_row(capsys: Capture) -> None:
    code, out, err = called(capsys, "law", "--z", ROW_1_53, "--order", 4, "--json")
    assert (code, err) == (0, "")
    data = json.loads(out)["constants"]
    assert list(data) == ["B", "C", "D", "J", "rms_c"]
    assert [round(data[name]["value"], 4) for name in "BCD"] == [1.53, 7.3618, 6.0604]
    assert round(data["J"]["value"], 3) == 85.783
    assert data["C"]["k"] == pytest.approx(0.1398, abs=5e-5)


@pytest.mark.parametrize("z", ["-3 6", "-3, 6", "-3,6", " -3   6 ", "-3\n6"])
def test_a_z_is_read_with_blanks_and_commas(capsys: Capture, z: str) -> None:
    code, out, _ = called(capsys, "law", f"--z={z}", "--order", 2, "--json")
    assert code == 0
    assert json.loads(out)["constants"]["B"] == {"value": 1.875, "k": 0.5}


def test_a_z_without_json_is_a_table(capsys: Capture) -> None:
    code, out, _ = called(capsys, "law", "--z", ROW_1_53, "--order", 4)
    assert code == 0
    assert "7.36175954" in out
    assert "RMS" in out


# --- run ---


def workspace(folder: Path) -> Path:
    """A problem that is solved quickly, with printed numbers beside it."""
    (folder / "problems").mkdir()
    (folder / "problems" / "printed.csv").write_text(SOLUTIONS_PRINTED, "utf-8")
    file = folder / "problems" / "small.toml"
    file.write_text(SOLUTIONS, "utf-8")
    return file


def replaced(file: Path, old: str, new: str) -> Path:
    text = file.read_text("utf-8")
    assert old in text
    file.write_text(text.replace(old, new, 1), "utf-8")
    return file


def test_run_writes_beside_the_problem_file_and_says_what(
    capsys: Capture, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    file = workspace(tmp_path)
    code, out, err = called(capsys, "run", file)
    assert (code, err) == (0, "")
    written = sorted(path.name for path in (tmp_path / "results" / "small").iterdir())
    assert written == ["laws.json", "table.csv", "table.md"]
    for name in written:
        assert str(Path("results") / "small" / name) in out
    assert "Few words." in out


def test_run_writes_over_other_contents_by_force_alone(capsys: Capture, tmp_path: Path) -> None:
    file = workspace(tmp_path)
    out = tmp_path / "results"
    out.mkdir()
    (out / "table.csv").write_text("mine\n", "utf-8")
    code, _, err = called(capsys, "run", file, "--out", out)
    assert code == 2
    assert "table.csv with other contents" in err
    assert "--force" in err
    assert {path.name: path.read_text("utf-8") for path in out.iterdir()} == {"table.csv": "mine\n"}
    for force in (["--force"], []):
        assert called(capsys, *force, "run", file, "--out", out)[0] == 0
    assert "made by optlaws" in (out / "table.csv").read_text("utf-8").splitlines()[0]
    assert not [path for path in out.iterdir() if path.name.startswith(".")]


@pytest.mark.parametrize(
    "content", [b"job = ", b"= 3", b"[a\n", b"job = 'solutions'\njob = 'twice'\n", b"\xff\xfe\x00job"]
)
def test_run_of_what_is_not_toml(capsys: Capture, tmp_path: Path, content: bytes) -> None:
    file = tmp_path / "bad.toml"
    file.write_bytes(content)
    assert ("is not TOML" if content.isascii() else "is not a text file") in refused(capsys, "run", file)
    assert "cannot read" in refused(capsys, "run", tmp_path)


# --- as a command ---


def command(*arguments: str) -> Any:
    return subprocess.run(
        [sys.executable, "-m", "optlaws", *arguments], capture_output=True, text=True, check=False, timeout=60
    )


def test_as_a_command_it_ends_with_3_and_no_traceback() -> None:
    done = command("solve", "--peak-velocity", "1.53", "--order", "4", "--degree", "1", "--json")
    assert (done.returncode, done.stdout) == (3, "")
    assert done.stderr.startswith("optlaws: infeasible: ")
    assert "Traceback" not in done.stderr


def test_version_and_help(capsys: Capture) -> None:
    expected = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]["version"]
    assert called(capsys, "--version") == (0, f"{expected}\n", "")
    code, out, _ = called(capsys, "--help")
    assert code == 0
    assert all(name in out for name in ("run", "solve", "law"))


def test_solve_takes_splines_bounds_and_an_inflexion(capsys: Capture) -> None:
    shape = ["solve", "--order", "3", "--degree", "3"]
    bounds = ["--inflexion", "0.4", "--most", "C_minus=6", "--most", "rms_c=4.2"]
    code, out, _ = called(capsys, *shape, "--basis", "bsplines", "--breaks", "8", *bounds, "--json")
    data = json.loads(out)
    assert (code, data["status"], len(data["z"])) == (0, "optimal", 11)
    law = MotionLaw.from_dict(data["law"])
    assert law.c(0.4) == pytest.approx(0.0, abs=1e-9)
    assert -law.extrema(2)[0].value <= 6.0 + 1e-8
    assert law.rms(2) <= 4.2 + 1e-8
    code, out, _ = called(capsys, *shape, "--basis", "pieces", "--breaks", "0 .1 .3 .5 .7 .9 1", "--continuity", "2")
    assert code == 0
    assert "Z(k)" not in out


def test_an_interrupt_while_starting_is_no_traceback() -> None:
    script = (
        "import sys\n"
        "class Interrupt:\n"
        "    def find_spec(self, name, *_):\n"
        "        if name == 'cyclopts': raise KeyboardInterrupt\n"
        "sys.meta_path.insert(0, Interrupt())\n"
        "from optlaws.cli import main\n"
        "main(['catalogue'])\n"
    )
    done = subprocess.run([sys.executable, "-c", script], check=False, capture_output=True, text=True)
    assert (done.returncode, done.stdout, done.stderr) == (130, "", "optlaws: interrupted\n")


def test_what_the_least_acceleration_alone_costs_is_said(capsys: Capture) -> None:
    alone = ["solve", "--order", "3", "--peak-velocity", "1.7596", "--basis", "chebyshev", "--degree", "41"]
    _, out, _ = called(capsys, *alone)
    assert "times that of modified sine" in out
    assert "--most-jerk" in out
    _, out, _ = called(capsys, *alone, "--most-jerk", "69.4664")
    assert "modified sine" not in out


def test_ipopt_solves_what_is_given_to_it(capsys: Capture) -> None:
    _, usual, _ = called(capsys, *SOLVE, "--json")
    _, other, _ = called(capsys, *SOLVE, "--method", "ipopt", "--json")
    assert json.loads(other)["objective"] == pytest.approx(json.loads(usual)["objective"], rel=1e-9)
    assert json.loads(other)["iterations"] > 0


# --- front ---


def test_the_points_of_a_front_are_proven_as_asked(capsys: Capture) -> None:
    front = optlaws.pareto_front(Problem(order=2, basis=optlaws.Chebyshev(3)), points=2)
    with patch("optlaws.pareto_front", return_value=front) as solved:
        for given in ([], ["--bound", "tight"]):
            assert called(capsys, "front", "--order", "2", *given)[0] == 0
    assert [call.kwargs["bound"] for call in solved.mock_calls if "bound" in call.kwargs] == ["quick", "tight"]


def test_a_front_is_written_as_functions_of_a_controller(capsys: Capture, tmp_path: Path) -> None:
    of_front = ["front", "--order", "4", "--between", "1.6", "1.8", "--within", "1e-2", "--name", "lift"]
    code, out, err = called(capsys, *of_front, "--to", "c99")
    assert (code, "certified laws of degree 17" in err) == (0, True)
    assert "static inline int lift_least_time(" in out
    file = tmp_path / "lift.st"
    code, out, _ = called(capsys, *of_front, "--to", "iec-st", "--output", str(file), "--json")
    results = json.loads(out)
    assert (code, results["format"], results["gap"] <= 1e-2) == (0, "iec-st", True)
    assert "FUNCTION_BLOCK lift" in file.read_text("utf-8")


def test_verify_ends_with_3_where_something_could_not_be_checked_and_with_0_where_all_is_computed_again(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "laws.json"
    file.write_text(optlaws.synthesize_array(optlaws.ProblemArray(B=[1.6, 1.8], order=4)).to_json(), encoding="utf8")
    assert exit_code(["verify", str(file)]) == 0
    assert capsys.readouterr().out.endswith(" proven, 1 recomputed in doubles, 0 not checked\n")
    cam = json.loads((ROOT / "results/cam_press/cam.json").read_text("utf-8"))
    del cam["usual_law"]
    file.write_text(json.dumps(cam), encoding="utf8")
    assert exit_code(["verify", str(file)]) == 3
    shown = capsys.readouterr()
    assert shown.out.endswith(", 1 not checked\n")
    assert "1 claim is not checked" in shown.err


def test_what_nobody_wrote_and_what_lost_its_proof_is_refused(tmp_path: Path, capsys: Capture) -> None:
    file = tmp_path / "stripped.json"
    stored = optlaws.synthesize(Problem(order=4, B=1.7)).to_dict()
    del stored["certificate"]
    for data in ({"a": 1}, {"about": "made by optlaws", **stored}):
        file.write_text(json.dumps(data), "utf-8")
        assert exit_code(["verify", str(file)]) == 2
        capsys.readouterr()


@pytest.mark.sample(3)
@pytest.mark.parametrize("file", ["cam_rocker/cam.json", "fronts/fronts.json", "loader_optimal/laws.json"])
def test_a_false_solution_inside_results_without_proofs_is_not_passed_over(
    file: str, tmp_path: Path, capsys: Capture
) -> None:
    stored = optlaws.synthesize(Problem(order=4, B=1.7)).to_dict()
    false = {**stored, "lower_bound": 1.1 * stored["objective"]}
    halved = {name: value for name, value in false.items() if name != "law"}
    for planted in (false, halved):
        data = json.loads((ROOT / "results" / file).read_text("utf-8"))
        data["deep"] = [{"in": planted}]
        changed = tmp_path / "changed.json"
        changed.write_text(json.dumps(data), "utf-8")
        assert exit_code(["verify", str(changed)]) in {1, 2}
        capsys.readouterr()


def test_false_constants_inside_results_without_proofs_are_found(tmp_path: Path, capsys: Capture) -> None:
    law = optlaws.smoothstep(2)
    constants: dict[str, Any] = law.constants.to_dict()
    constants["C"]["value"] *= 1.1
    data = json.loads((ROOT / "results/cam_rocker/cam.json").read_text("utf-8"))
    del data["cam"], data["solutions"]  # as earlier versions wrote it
    data["deep"] = [{"radius": 0.1, "law": law.to_dict(), "constants": constants}]
    changed = tmp_path / "changed.json"
    changed.write_text(json.dumps(data), "utf-8")
    assert exit_code(["verify", str(changed)]) == 1
    assert "deep[0]" in capsys.readouterr().out


def test_results_without_proofs_name_what_is_not_checked_and_what_contradicts_itself(
    tmp_path: Path, capsys: Capture
) -> None:
    data = json.loads((ROOT / "results" / "cam_rocker" / "cam.json").read_text("utf-8"))
    del data["cam"], data["solutions"]  # as earlier versions wrote it
    (tmp_path / "cam.json").write_text(json.dumps(data), "utf-8")
    assert exit_code(["verify", str(tmp_path / "cam.json")]) == 3
    text = capsys.readouterr().out
    assert all(name in text for name, value in data.items() if name not in {"about", "unit"} and value is not None)
    changed = tmp_path / "changed.json"
    pairs = {"low": "high", "lower_bound": "objective", "too_small": "radius", "radius": "too_large"}
    places = [(place, pair) for place in objects(data) for pair in pairs.items() if within(place, pair)]
    assert places
    for place, (less, more) in places:
        before = place[less]
        for wrong in (place[more] + 0.01 * max(1.0, abs(place[more])), "no number"):
            place[less] = wrong
            changed.write_text(json.dumps(data), "utf-8")
            assert exit_code(["verify", str(changed)]) == 1, (less, more, wrong)
            capsys.readouterr()
        place[less] = before


def test_a_cycle_to_solve_claims_nothing_and_verify_says_so(tmp_path: Path, capsys: Capture) -> None:
    file = tmp_path / "cycle.json"
    cycle = optlaws.Cycle([optlaws.Rise("35 mm", "120 deg"), optlaws.Return()], speed="200 rpm")
    for entries in (cycle, optlaws.Axes({"slide": cycle})):
        file.write_text(entries.to_json(), "utf-8")
        assert exit_code(["verify", str(file)]) == 2
        assert "claims nothing of their laws" in capsys.readouterr().err


def objects(data: object) -> Iterator[dict[str, Any]]:
    """Every object of a file, however deep."""
    if isinstance(data, dict):
        yield data
    for value in data.values() if isinstance(data, dict) else data if isinstance(data, list) else ():
        yield from objects(value)


def within(data: dict[str, Any], names: tuple[str, str]) -> bool:
    return all(isinstance(data.get(name), int | float) for name in names)
