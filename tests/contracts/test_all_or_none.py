"""On an error nothing new lies in the folder: whichever of its files a command or a job was about to write."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from optlaws import InputError
from tests.contracts.test_commands import CALLS, STUDY
from tests.documents import ROOT
from tests.internals.cli import exit_code
from tests.internals.files import writing
from tests.internals.jobs import job
from tests.jobs.examples import EXAMPLES

#: what each writes when all goes well; a study resumes, and keeps what is done
COMMANDS = {
    "advise": "--output proofs.json --plot picture.svg",
    "cycle": "--out deep/results --plot picture.svg",
    "follower": "--plot picture.svg",
    "law": "--csv law.csv --plot picture.svg",
    "run": "--out results",
    "solve": "--output answer.json --plot picture.svg",
}
TABLE = "cycle table.txt --speed 100rpm --save cam.toml --export csv --plot picture.svg"
JOBS = [name for name in EXAMPLES if name != "machine laws"]


def contents(folder: Path) -> dict[Path, bytes | None]:
    return {place: place.read_bytes() if place.is_file() else None for place in folder.rglob("*")}


def failing(monkeypatch: pytest.MonkeyPatch, after: int, error: BaseException) -> Callable[[], int]:
    """Let the write after so many fail, as where a computation between them does; how many were done."""
    put, done = writing._put, 0

    def counted(*arguments: Any, **options: Any) -> Any:
        nonlocal done
        if done == after:
            raise error
        done += 1
        return put(*arguments, **options)

    monkeypatch.setattr(writing, "_put", counted)
    return lambda: done


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "study.toml").write_text(STUDY, "utf-8")
    (tmp_path / "cycle.toml").write_bytes((ROOT / "problems" / "cycle_press.toml").read_bytes())
    small = EXAMPLES["solutions"]
    for name, text in {"problem.toml": small.text, **small.beside}.items():
        (tmp_path / name).write_text(text, "utf-8")
    x = np.arange(361.0)
    up, down = np.clip(x / 120.0, 0.0, 1.0), np.clip((x - 180.0) / 120.0, 0.0, 1.0)
    law = [10.0 * u**4 * (35.0 - 84.0 * u + 70.0 * u**2 - 20.0 * u**3) for u in (up, down)]
    rows = [f"{place:g} {height:.4f}" for place, height in zip(x, law[0] - law[1], strict=True)]
    (tmp_path / "table.txt").write_text("\n".join(rows), "utf-8")
    return tmp_path


@pytest.mark.sample(6)
@pytest.mark.parametrize(
    "error", [InputError("no"), OSError(28, "No space left on device"), KeyboardInterrupt()], ids=type
)
@pytest.mark.parametrize("call", [*(f"{name} {CALLS[name]} {extra}" for name, extra in COMMANDS.items()), TABLE])
def test_a_command_that_fails_leaves_nothing_behind(
    folder: Path, monkeypatch: pytest.MonkeyPatch, call: str, error: BaseException
) -> None:
    before = contents(folder)
    done = failing(monkeypatch, 1, error)
    if exit_code(call.split()):
        assert contents(folder) == before
    assert done() == 1


@pytest.mark.sample(4)
@pytest.mark.parametrize("name", JOBS)
def test_a_job_that_fails_leaves_nothing_behind(folder: Path, monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    for other, content in EXAMPLES[name].beside.items():
        (folder / other).write_text(content, "utf-8")
    file = folder / "small.toml"
    file.write_text(EXAMPLES[name].text, "utf-8")
    out = folder / "deep" / "out"
    before = contents(folder)
    failing(monkeypatch, 1, RuntimeError("interrupted"))
    with pytest.raises(RuntimeError, match="interrupted"):
        job.done(file).write(out)
    assert contents(folder) == before


def test_a_file_that_was_there_is_put_back(tmp_path: Path) -> None:
    kept, new = tmp_path / "kept.txt", tmp_path / "deep" / "new.txt"
    writing.write(kept, f"first; {writing.MARK}")
    before = contents(tmp_path)

    def refused() -> None:
        with writing.all_or_none():
            writing.write(new, f"new; {writing.MARK}")
            writing.write(kept, f"another 12.5; {writing.MARK}")
            assert contents(tmp_path) != before
            raise InputError("no")

    with pytest.raises(InputError):
        refused()
    assert contents(tmp_path) == before


def test_a_table_at_constant_velocity_is_refused_and_leaves_nothing(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A quarter sine up and a line down: the moves that have laws of their own are not saved for a cycle that jumps."""
    turn = np.arange(0.0, 361.0, 2.0)
    u = turn % 180.0 / 2.0
    lift = np.where(u <= 60.0, 3.05 * np.sin(np.pi / 2.0 * u / 60.0), np.where(u < 80.0, 3.05 * (80.0 - u) / 20.0, 0.0))
    rows = [f"{at!r} {height!r}" for at, height in zip(turn.tolist(), lift.tolist(), strict=True)]
    (folder / "pump.txt").write_text("\n".join(rows), "utf-8")
    before = contents(folder)
    arguments = ["cycle", "pump.txt", "--speed", "200rpm", "--tolerance", "0.001", "--save", "pump.toml"]
    assert exit_code([*arguments, "--modernise", "0.1mm"]) == 2
    assert "the velocity jumps at" in capsys.readouterr().err
    assert contents(folder) == before
    assert exit_code([*arguments[:2], "--tolerance", "0.001", "--modernise", "0.1mm"]) == 0
    assert "keeps its law: it is at constant velocity" in capsys.readouterr().out


def test_a_tolerance_in_which_no_move_is_bettered_is_said_and_leaves_nothing(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A harmonic rise and return: laws without jumps of the acceleration are not within a micron of them."""
    turn = np.arange(0.0, 361.0)
    lift = 10.0 * (1.0 - np.cos(np.pi * np.clip(turn / 90.0, 0.0, 1.0)))
    lift -= 10.0 * (1.0 - np.cos(np.pi * np.clip((turn - 180.0) / 90.0, 0.0, 1.0)))
    (folder / "harmonic.txt").write_text("\n".join(f"{x:g} {y:.3f}" for x, y in zip(turn, lift, strict=True)), "utf-8")
    before = contents(folder)
    arguments = ["cycle", "harmonic.txt", "--speed", "200rpm", "--modernise", "0.01mm"]
    assert exit_code([*arguments, "--save", "new.toml", "--export", "csv"]) != 0
    assert "no law of order 3 and degree 15 is so near; within" in capsys.readouterr().err
    assert contents(folder) == before
    assert exit_code(arguments) == 0
    assert "keeps its law: no law of order 3 and degree 15 is so near; within" in capsys.readouterr().out
