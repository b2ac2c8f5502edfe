"""Scripts of problems: over public names alone, run by name, with what results/ holds; no code of a user's is run."""

import ast
import os
import shutil
import subprocess
import sys
from importlib import import_module
from pathlib import Path
from zipfile import ZipFile

import pytest
from hatchling.builders.wheel import WheelBuilder

import optlaws
from optlaws import InputError, OptlawsError, problems
from optlaws.results import Entries, Results
from tests.documents import ROOT
from tests.internals.cli import exit_code
from tests.internals.files import writing
from tests.internals.jobs import job

SCRIPTS = sorted((ROOT / "problems").rglob("*.py"))
#: modules whose names are public without a list of them
OPEN = {"optlaws.plots.machine", "optlaws.plots.style"}


def imports(script: Path) -> list[tuple[str, str]]:
    """Modules of optlaws that a script imports from, each with a name; what lies beside the script is its own."""
    nodes = list(ast.walk(ast.parse(script.read_text("utf-8"))))
    found = [(a.name, "") for node in nodes if isinstance(node, ast.Import) for a in node.names]
    found += [
        (node.module or "", alias.name)
        for node in nodes
        if isinstance(node, ast.ImportFrom) and not node.level
        for alias in node.names
    ]
    return [(module, name) for module, name in found if module.partition(".")[0] == "optlaws"]


def is_public(module: str, name: str) -> bool:
    """Whether a module names it in its list of public names; modules themselves are public where they have one."""
    if module in OPEN:
        return True
    listed = getattr(import_module(module), "__all__", [])
    return name in listed or bool(getattr(getattr(optlaws, name, None), "__all__", []))


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda script: script.stem)
def test_a_script_uses_public_names_alone(script: Path) -> None:
    assert [(module, name) for module, name in imports(script) if not is_public(module, name)] == []


def test_a_name_that_is_not_public_is_seen() -> None:
    assert is_public("optlaws", "synthesize")
    assert not is_public("optlaws.jobs", "job")
    assert not is_public("optlaws.synthesis.method", "exchange")


@pytest.mark.parametrize("name", problems.names())
def test_a_script_asserts_its_numbers_and_is_short(name: str) -> None:
    script = (ROOT / "problems" / f"{name}.py").read_text("utf-8")
    nodes = list(ast.walk(ast.parse(script)))
    beside = [alias.name for node in nodes if isinstance(node, ast.ImportFrom) and node.level for alias in node.names]
    assert "run" in beside or any(isinstance(node, ast.Assert) for node in nodes)
    assert len(script.splitlines()) <= 320


def test_files_of_a_script_are_marked_and_named_and_those_that_say_the_same_stay(tmp_path: Path) -> None:
    kept = ROOT / "results" / "savin_families"
    shutil.copytree(kept, tmp_path / "out")
    written = problems.run("savin_families", tmp_path / "out")
    assert sorted(written) == sorted((tmp_path / "out").iterdir())
    assert {file.name: file.read_bytes() for file in written} == {
        file.name: file.read_bytes() for file in kept.iterdir()
    }
    assert all(writing.MARK.encode() in file.read_bytes() for file in written)


def test_a_script_is_run_by_its_name_or_by_its_own_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    # what a user has beside it is not what is run
    for name in ("lever_tables.py", "problems.py"):
        Path(name).write_text("raise SystemExit(7)\n", "utf-8")
    for given in (["lever_tables"], [str(ROOT / "problems" / "lever_tables.toml"), "--out", "results/lever_tables"]):
        assert exit_code(["run", *given]) == 0
        assert "results/lever_tables/verdicts.csv" in capsys.readouterr().out
    assert (tmp_path / "results/lever_tables/tables.md").read_bytes() == (
        ROOT / "results/lever_tables/tables.md"
    ).read_bytes()


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("mine.py", "raise SystemExit(7)\n", "optlaws runs no code but its own.*python mine.py"),
        ("mine.toml", 'job = "script"\ntitle = "Mine"\n', "by name: `optlaws run optimal_table`"),
        ("lever_tables.toml", 'job = "script"\ntitle = "Mine"\n', "by name: `optlaws run lever_tables`"),
        ("mine.toml", 'job = "lever tables"\ntitle = "Mine"\n', "unknown job 'lever tables'"),
        ("mine.toml", 'job = "fronts"\ntitle = "Mine"\n', "no job 'fronts' any more: take `optlaws front`"),
        ("mine.toml", 'job = "force loaded"\ntitle = "Mine"\n', "no job 'force loaded' any more: minimise peak"),
        ("mine.toml", 'job = "atlas"\ntitle = "Mine"\n', "no job 'atlas' any more: .*`optlaws study`"),
    ],
)
def test_a_file_of_a_user_s_is_never_code(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, content: str, message: str
) -> None:
    monkeypatch.chdir(tmp_path)
    Path(name).write_text(content, "utf-8")
    Path("mine.py").write_text("raise SystemExit(7)\n", "utf-8")
    with pytest.raises(InputError, match=message):
        job.done(Path(name)).write(tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_a_wheel_runs_its_scripts_by_name(tmp_path: Path) -> None:
    (wheel,) = WheelBuilder(str(ROOT)).build(directory=str(tmp_path), versions=["standard"])
    ZipFile(wheel).extractall(tmp_path / "site")
    program = "import sys; from optlaws.cli.app import exit_code; sys.exit(exit_code(sys.argv[1:]))"
    for arguments in (["run", "lever_tables"], ["run", "lever_drawing"]):
        environment = {**os.environ, "PYTHONPATH": str(tmp_path / "site")}
        subprocess.run([sys.executable, "-c", program, *arguments], cwd=tmp_path, env=environment, check=True)
    written = tmp_path / "results" / "lever_tables" / "verdicts.csv"
    assert written.read_bytes() == (ROOT / "results" / "lever_tables" / "verdicts.csv").read_bytes()


def test_a_name_without_a_script_is_refused() -> None:
    with pytest.raises(InputError, match="did you mean 'lever_tables'"):
        problems.run("lever_table")


def test_a_number_that_is_not_as_asserted_is_an_error_and_nothing_is_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    script = import_module("optlaws.problems.lever_tables")
    monkeypatch.setattr(script, "REPRODUCED", "nothing")
    with pytest.raises(OptlawsError, match=r"lever_tables: not as asserted in .*lever_tables\.py, line \d+: assert"):
        problems.run("lever_tables", tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_entries_are_known_needed_and_of_their_type(tmp_path: Path) -> None:
    class Peaks(Entries):
        laws: list[str]

    file = tmp_path / "peaks.toml"
    for content, message in (
        ('title = "Peaks"\nlaws = []\nlows = 3\n', "unknown key 'lows'; did you mean 'laws'"),
        ('title = "Peaks"\n', "laws"),
        ("title = 5\nlaws = []\n", "title"),
    ):
        file.write_text(content, "utf-8")
        with pytest.raises(InputError, match=rf"(?s)peaks\.toml.*{message}"):
            Results(file).read(Peaks)
