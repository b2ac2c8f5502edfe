"""Data that come with optlaws, in a checkout and in a wheel."""

from io import StringIO
from pathlib import Path

import pytest
from hatchling.builders.wheel import WheelBuilder

from optlaws import InputError, catalogue
from tests.documents import ROOT
from tests.internals.cli import exit_code, show
from tests.internals.explorer import start
from tests.internals.files import packaged
from tests.internals.jobs import job


def test_a_wheel_holds_the_package_the_problems_and_nothing_else() -> None:
    inside = {file.distribution_path for file in WheelBuilder(str(ROOT)).recurse_included_files()}
    assert {name.partition("/")[0] for name in inside} == {"optlaws"}
    for folder in ("problems", "optlaws"):
        names = [file.relative_to(ROOT).as_posix() for file in (ROOT / folder).rglob("*") if file.is_file()]
        before = "" if folder == "optlaws" else "optlaws/packaged/"
        held = {before + name for name in names if "__pycache__" not in name}
        assert held <= inside, held - inside
    assert not any("packaged/results" in name for name in inside)


def test_what_is_installed_is_found_beside_the_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "packaged" / "problems").mkdir(parents=True)
    (tmp_path / "packaged" / "problems" / "own.toml").write_text("", "utf-8")
    monkeypatch.setattr(packaged, "_ROOTS", (tmp_path / "packaged", tmp_path))
    assert packaged.problem_names() == ["own"]
    with pytest.raises(InputError, match="did not come with"):
        packaged.packaged("problems/atlas.toml")


def test_files_of_the_user_come_first(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert packaged.problem_file(Path("problems/ledger.toml")) == ROOT / "problems" / "ledger.toml"
    Path("problems").mkdir()
    Path("problems/ledger.toml").write_text("", "utf-8")
    assert packaged.problem_file(Path("problems/ledger.toml")) == Path("problems/ledger.toml")
    Path("optimal_table").write_text("", "utf-8")
    assert packaged.problem_file(Path("optimal_table")) == Path("optimal_table")
    assert packaged.problem_file(Path("lever_tables.toml")) == Path("lever_tables.toml")


def test_a_packaged_problem_is_run_by_its_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert exit_code(["run", "savin_families"]) == 0
    assert "results/savin_families/table.csv" in capsys.readouterr().out
    assert (tmp_path / "results" / "savin_families" / "figure.svg").is_file()


def test_commands_of_a_job_take_packaged_problems_by_name_and_by_place(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    for given in ("cycle_savin_design", "problems/cycle_savin_design.toml"):
        assert exit_code(["cycle", given, "--json"]) == 0
        assert exit_code(["export", given, "--to", "csv", "--points", "9"]) == 0
    assert exit_code(["cycle", "problems/cycle_savin_design.toml"]) == 0
    assert (tmp_path / "results" / "cycle_savin_design" / "cycle.md").is_file()
    capsys.readouterr()
    for command in (["cycle", "problems/cam_press.toml"], ["export", "cam_press", "--to", "csv"]):
        assert exit_code(command) == 2
        assert f"`optlaws run {command[1]}` does it" in capsys.readouterr().err
    assert [file.name for file in tmp_path.rglob("*.md")] == ["cycle.md"]
    assert start("cam_press")["view"] == "cam"


def test_no_packaged_problem_hides_a_law() -> None:
    assert not set(packaged.problem_names()) & set(catalogue)


def test_words_that_a_problem_file_may_not_hold_are_told_with_the_right_ones(tmp_path: Path) -> None:
    file = tmp_path / "own.toml"
    text = packaged.packaged("problems/cycle_savin_design.toml").read_text("utf-8")
    file.write_text(text.replace('kind = "rise"', 'kind = "rize"', 1), "utf-8")
    with pytest.raises(InputError, match="segment 1: unknown kind of a segment 'rize'; did you mean 'rise'"):
        job.done(file).write(tmp_path / "results")
    assert not (tmp_path / "results").exists()


def test_what_answers_leaves_a_closed_pipe_to_the_command(monkeypatch: pytest.MonkeyPatch) -> None:
    class Closed(StringIO):
        def write(self, _: str) -> int:
            raise BrokenPipeError

    monkeypatch.setattr("sys.stdout", Closed())
    with pytest.raises(BrokenPipeError):
        show("an answer")


@pytest.mark.parametrize(
    ("named", "message"),
    [
        ('["cycle"]', r"unknown job \['cycle'\]; known are cam, cycle"),
        ('"cicle"', "unknown job 'cicle'; did you mean 'cycle'"),
        ('"fronts"', "there is no job 'fronts' any more: take `optlaws front`"),
        ('"cam"', "is of the job 'cam', not 'cycle': `optlaws run .*own.toml` does it"),
    ],
)
def test_a_file_of_another_job_is_refused_with_a_remedy_that_helps(tmp_path: Path, named: str, message: str) -> None:
    file = tmp_path / "own.toml"
    file.write_text(f"job = {named}", "utf-8")
    with pytest.raises(InputError, match=message):
        job.problem_of_job(file, "cycle")
