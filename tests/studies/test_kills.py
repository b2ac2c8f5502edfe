"""Runs and solver processes killed at random moments: the finished store is that of an undisturbed run."""

import json
import os
import signal
import subprocess
import sys
import time
import tomllib
from collections.abc import Iterator, Sequence
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest

from optlaws import open_study
from optlaws.cli import exit_code
from tests.documents import ROOT
from tests.internals.studies import StudyDirectory
from tests.studies.sweeping import rows, serially

pytestmark = pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="processes are found by Linux's /proc")

FILE = """
chunk = 10
[problem]
order = 4
degree = 7
[vary]
minimise = ["rms_j", "rms_c"]
B = { from = 1.5, to = 2.4, steps = 250 }
"""
#: lines that are solved as arrays, each in a chunk
FILE_OF_LINES = """
chunk = 150
[problem]
order = 4
degree = 5
[vary]
minimise = ["C", "D", "J"]
B = { from = 1.5, to = 2.4, steps = 150 }
"""


class Run:
    """The command, in a process of its own."""

    def __init__(self, file: Path, out: Path) -> None:
        command = [sys.executable, "-m", "optlaws", "study", str(file), "--out", str(out), "--workers", "2"]
        self.out = out
        # whoever runs the tests in the background may have Ctrl-C ignored, and with it all that is started from there
        signal.signal(signal.SIGINT, signal.default_int_handler)
        self.process = subprocess.Popen(command, cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)

    def size(self) -> int:
        chunks = StudyDirectory(self.out).chunks
        # the last ones may go while they are looked at
        with suppress(FileNotFoundError):
            return sum(file.stat().st_size for file in chunks.iterdir() if file.name.isdecimal())
        return 0

    def wait_for_rows(self, more: int) -> bool:
        """Whether the chunks grew by so many bytes before the run ended."""
        before = self.size()
        while self.process.poll() is None:
            if self.size() >= before + more:
                return True
            time.sleep(0.005)
        return False

    def solvers(self) -> list[int]:
        lists = Path(f"/proc/{self.process.pid}/task").glob("*/children")
        return [int(pid) for one in lists for pid in _text(one).split()]

    def finish(self) -> tuple[int, str]:
        """Exit status and what it said on stderr."""
        assert self.process.stderr is not None
        text = self.process.stderr.read().decode()
        self.process.stderr.close()
        return self.process.wait(), text


def _text(file: Path) -> str:
    try:
        return file.read_text()
    except OSError:
        return ""  # the thread has ended


def kill(pid: int) -> None:
    # it may have been quicker
    with suppress(ProcessLookupError):
        os.kill(pid, signal.SIGKILL)


def gone(pids: list[int]) -> bool:
    until = time.monotonic() + 20.0
    while time.monotonic() < until:
        if not any(_alive(pid) for pid in pids):
            return True
        time.sleep(0.02)
    return False


def _alive(pid: int) -> bool:
    return _text(Path(f"/proc/{pid}/stat")).rpartition(")")[2].split()[:1] not in ([], ["Z"])


def study_file(folder: Path, text: str = FILE) -> Path:
    file = folder / "swept.toml"
    file.write_text(text)
    return file


def disturbed(folder: Path, seed: int, victims: Sequence[str], text: str = FILE) -> Iterator[str]:
    """Run to the end through kills of the run itself or of a solver process at random moments; who was killed."""
    chance = np.random.default_rng(seed)
    file, out = study_file(folder, text), folder / "out"
    run = Run(file, out)
    for victim in victims:
        # the chunks are spread over the kills, and a kill falls anywhere within a chunk's work
        if not run.wait_for_rows(int(chance.integers(1, 20_000))):
            break
        time.sleep(chance.random() * 0.05)
        solvers = run.solvers()
        if victim == "solver":
            for pid in solvers[: chance.integers(1, 3)]:
                kill(pid)
        else:
            kill(run.process.pid)
            assert run.finish()[0] in {0, -signal.SIGKILL}
            assert gone(solvers)
            run = Run(file, out)
        yield victim
    status, message = run.finish()
    assert status == 0, message


@pytest.mark.long
def test_killed_within_an_array_it_ends_as_if_nothing_had_been(tmp_path: Path) -> None:
    assert list(disturbed(tmp_path, 2, ["run"], FILE_OF_LINES)) == ["run"]
    study = open_study(tmp_path / "out")
    assert study.counts == {"optimal": 300, "local": 150}
    assert rows(study) == rows(serially(tomllib.loads(FILE_OF_LINES), tmp_path / "undisturbed"))


@pytest.mark.long
def test_killed_twenty_times_it_ends_as_if_nothing_had_been(tmp_path: Path) -> None:
    undisturbed = rows(serially(tomllib.loads(FILE), tmp_path / "undisturbed"))
    victims = ["run", "solver"] * 10
    for seed in range(100):
        folder = tmp_path / str(seed)
        folder.mkdir()
        killed = list(disturbed(folder, seed, victims))
        del victims[: len(killed)]
        assert rows(open_study(folder / "out")) == undisturbed
        if not victims:
            return
    pytest.fail(f"{len(victims)} of the 20 kills came too late")


def test_ctrl_c_ends_with_130_and_the_command_goes_on(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file, out = study_file(tmp_path, FILE.replace("250", "60")), tmp_path / "out"
    run = Run(file, out)
    assert run.wait_for_rows(2000)
    solvers = run.solvers()
    run.process.send_signal(signal.SIGINT)
    status, text = run.finish()
    assert status == 130
    assert "optlaws: interrupted" in text
    assert gone(solvers)
    study = open_study(out)
    done = sum(study.counts.values())
    assert 0 < done < 120
    assert not study.running
    assert exit_code(["study", "--status", str(out), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["done"] == done
    again = Run(file, out)
    status, text = again.finish()
    assert status == 0
    assert f"{done} of 120 points done before" in text
    assert "120 of 120" in text
    assert rows(open_study(out)) == rows(serially(tomllib.loads(file.read_text()), tmp_path / "undisturbed"))
