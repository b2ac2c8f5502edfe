"""What is kept for the next problem, and many threads at once: answers are those of one thread, to the last bit."""

import os
import subprocess
import sys

import numpy as np
import pytest
from numpy.typing import NDArray

from optlaws import Chebyshev, Problem
from tests.documents import ROOT
from tests.internals.synthesis import KINDS, RowShape, ipopt, writer


@pytest.mark.parametrize("rounds", [2, pytest.param(60, marks=pytest.mark.long)])
def test_threads_and_children_answer_as_one_thread_does(rounds: int) -> None:
    command = [sys.executable, "-X", "faulthandler", "-m", "tests.synthesis.concurrent_work", "8", str(rounds)]
    answer = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False, timeout=60 * rounds)
    assert answer.returncode == 0, answer.stderr
    assert f"and {rounds} children" in answer.stdout


NESTED = """
import os, threading
from optlaws.lazy import process_lock

outer, inner, held = process_lock(), process_lock(), threading.Event()

def nested():
    with outer:
        held.set()
        threading.Event().wait(0.2)
        with inner:
            pass

thread = threading.Thread(target=nested)
thread.start()
held.wait()
child = os.fork()
if child == 0:
    os._exit(0 if outer.acquire(blocking=False) and inner.acquire(blocking=False) else 1)
thread.join()
raise SystemExit(os.waitpid(child, 0)[1])
"""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="nothing forks here")
def test_a_fork_waits_for_no_lock_with_another_in_hand() -> None:
    """A thread that holds one lock waits for a second one meanwhile."""
    assert subprocess.run([sys.executable, "-c", NESTED], cwd=ROOT, check=False, timeout=30).returncode == 0


def test_solvers_are_kept_as_many_as_their_rows_allow(monkeypatch: pytest.MonkeyPatch) -> None:
    counts = [ipopt._Shapes(4, 333, (RowShape(count, KINDS[0], (), None),), fine=False) for count in range(5)]
    monkeypatch.setattr(ipopt, "_solvers", {})
    monkeypatch.setattr(ipopt, "_build", lambda counts, **_: counts)
    for one in (0, 1, 0, 2, 0, 3, 4):
        assert ipopt._solver(counts[one]) == counts[one]
    # those used last; the rows of all kinds count
    assert list(ipopt._solvers) == [counts[3], counts[4]]
    ipopt._solver(ipopt._Shapes(4, 10_000, (), fine=False))
    assert len(ipopt._solvers) == 1


def test_a_grid_of_forty_shapes_writes_each_program_once() -> None:
    shapes = [(order, degree) for order in range(3, 7) for degree in range(3, 23, 2)]
    before = writer._model.cache_info().misses
    for B in (1.7, 1.8):
        for order, degree in shapes:
            writer.model_of(Problem(order=order, B=B, basis=Chebyshev(degree)))
    assert writer._model.cache_info().misses - before <= len(shapes)


def test_of_what_a_space_makes_the_last_32_are_kept() -> None:
    space = writer.model_of(Problem(B=1.8, order=3, basis=Chebyshev(5))).space
    made: list[int] = []

    def make(key: int) -> NDArray[np.float64]:
        def anew() -> NDArray[np.float64]:
            made.append(key)
            return np.full(1, float(key))

        return space.cached(("mine", key), anew)

    space._cache.clear()
    for key in range(32):
        assert make(key) == float(key)
    assert [make(key)[0] for key in range(32)] == list(range(32))
    assert made == list(range(32))
    assert make(32) == 32.0
    assert len(space._cache) == 32
    # the first one had to go, and no other
    assert [make(key)[0] for key in range(1, 33)] == list(range(1, 33))
    assert made == list(range(33))
    make(0)
    assert made == [*range(33), 0]
    assert make(0) is make(0)
