"""Many threads at once, and forks among them: answers are those of one thread, to the last bit."""

import subprocess
import sys

import pytest

from tests.documents import ROOT


@pytest.mark.parametrize("rounds", [2, pytest.param(60, marks=pytest.mark.long)])
def test_threads_and_children_answer_as_one_thread_does(rounds: int) -> None:
    command = [sys.executable, "-X", "faulthandler", "-m", "tests.synthesis.concurrent_work", "8", str(rounds)]
    answer = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False, timeout=60 * rounds)
    assert answer.returncode == 0, answer.stderr
    assert f"and {rounds} children" in answer.stdout
