"""Data that come with optlaws, in a checkout and in a wheel."""

from pathlib import Path

import pytest
from hatchling.builders.wheel import WheelBuilder

from optlaws import InputError
from optlaws.cli.app import exit_code
from optlaws.files import packaged
from tests.documents import ROOT


def test_a_wheel_holds_the_package_the_problems_and_the_atlas_and_nothing_else() -> None:
    inside = {file.distribution_path for file in WheelBuilder(str(ROOT)).recurse_included_files()}
    assert {name.partition("/")[0] for name in inside} == {"optlaws"}
    for folder in ("problems", "optlaws"):
        names = [file.relative_to(ROOT).as_posix() for file in (ROOT / folder).rglob("*") if file.is_file()]
        before = "" if folder == "optlaws" else "optlaws/packaged/"
        held = {before + name for name in names if "__pycache__" not in name}
        assert held <= inside, held - inside
    assert "optlaws/packaged/results/atlas/atlas.csv" in inside
    assert sum("packaged/results" in name for name in inside) == 1


def test_what_is_installed_is_found_beside_the_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "packaged" / "problems").mkdir(parents=True)
    (tmp_path / "packaged" / "problems" / "own.toml").write_text("", "utf-8")
    monkeypatch.setattr(packaged, "_ROOTS", (tmp_path / "packaged", tmp_path))
    assert packaged.problem_names() == ["own"]
    with pytest.raises(InputError, match="did not come with"):
        packaged.packaged("results/atlas/atlas.csv")


def test_files_of_the_user_come_first(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert packaged.or_packaged(Path("problems/ledger.toml")) == ROOT / "problems" / "ledger.toml"
    Path("problems").mkdir()
    Path("problems/ledger.toml").write_text("", "utf-8")
    assert packaged.or_packaged(Path("problems/ledger.toml")) == Path("problems/ledger.toml")
    Path("optimal_table").write_text("", "utf-8")
    assert packaged.problem_file(Path("optimal_table")) == (Path("optimal_table"), None)
    assert packaged.problem_file(Path("lever_tables.toml")) == (Path("lever_tables.toml"), None)


def test_a_packaged_problem_is_run_by_its_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert exit_code(["run", "savin_families"]) == 0
    assert "results/savin_families/table.csv" in capsys.readouterr().out
    assert (tmp_path / "results" / "savin_families" / "figure.svg").is_file()
    assert exit_code(["run", "savin_familys"]) == 2
    assert "did you mean 'savin_families'?" in capsys.readouterr().err
    assert exit_code(["atlas", "--order", "4", "--peak-velocity", "1.8"]) == 0
