"""Tests and values do not depend on what came before: any files in one call, any order, any process."""

import copy
import pickle
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from optlaws import (
    Chebyshev,
    Follower,
    Pieces,
    Problem,
    balanced_law,
    pareto_front,
    response_spectrum,
    savin,
    synthesize,
)
from tests.documents import ROOT
from tests.imports import modules

VALUES: dict[str, Callable[[], Any]] = {
    "solution": lambda: synthesize(Problem(B=1.7, order=3)),
    "solution of pieces": lambda: synthesize(Problem(B=1.7, order=3, basis=Pieces(4))),
    "solution of power": lambda: synthesize(Problem(B=1.7, order=3, minimise="D", basis=Chebyshev(3)), bound="tight"),
    "front": lambda: pareto_front(Problem(order=4), over=("B", "C"), points=3, between=(1.5, 1.8)),
    "balanced law": lambda: balanced_law(1.8, order=2, basis=Chebyshev(5), minimise="B_loader"),
    "spectrum": lambda: response_spectrum(savin("III", 7.2), [18.0, 20.0]),
    "response": lambda: Follower(frequency=20, damping=0.05).response(savin("III", 7.2)),
}


@pytest.mark.parametrize("name", VALUES)
def test_a_value_is_equal_to_its_copies_and_to_the_same_asked_again(name: str) -> None:
    value = VALUES[name]()
    for other in (pickle.loads(pickle.dumps(value)), copy.deepcopy(value), VALUES[name]()):  # noqa: S301
        assert other == value
        assert hash(other) == hash(value)
    assert value != name


def test_values_of_other_problems_are_not_equal() -> None:
    one, other = (synthesize(Problem(B=B, order=3)) for B in (1.7, 1.8))
    assert one != other
    laws = savin("III", 7.2), savin("III", 7.3)
    assert response_spectrum(laws[0], [18.0]) != response_spectrum(laws[1], [18.0])
    assert response_spectrum(laws[0], [18.0]) != response_spectrum(laws[0], [19.0])


@pytest.mark.long
def test_a_module_and_the_tests_of_its_laws_run_in_one_call() -> None:
    # pytest must not import a module that its package has imported a second time
    files = ["optlaws/laws/polynomial.py", "tests/contracts/test_laws.py"]
    arguments = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-k", "equal_law", *files]
    process = subprocess.run(
        arguments, cwd=Path(__file__).parent.parent, capture_output=True, text=True, check=False, timeout=120
    )
    assert process.returncode == 0, process.stdout[-2000:]


#: eight threads use or import optlaws for the first time at once; what fails is printed. Threads that take turns
#: 500 times as often as usual meet sooner, so half of the uses are tried so
FIRST_USE = """
import random, sys, threading, importlib, optlaws
mode, seed = sys.argv[1], int(sys.argv[2])
uses = [
    lambda: optlaws.synthesize(optlaws.Problem(B=1.8, order=3)).objective,
    lambda: optlaws.savin("III", 7.2).constants,
    lambda: optlaws.smoothstep(3).export("csv", stroke="35 mm", duration="0.1 s", points=21).text,
    lambda: optlaws.read_law("0317(1,5)").constants,
    lambda: optlaws.Follower(frequency=19, damping=0.05).response(optlaws.smoothstep(4)).peak(2),
    lambda: optlaws.catalogue["cycloidal"].law.constants,
    lambda: optlaws.Cycle([optlaws.Rise("1 mm", "0.1 s"), optlaws.Return(duration="0.1 s")], period="0.2 s"),
    lambda: optlaws.MotionLaw.from_json('{"format":1,"kind":"polynomial","acceleration":[],"a0":0.0,"b0":1.0}'),
]
def modules(thread):
    names = sys.argv[3].split()
    random.Random(8 * seed + thread).shuffle(names)
    for name in names:
        importlib.import_module(name)
def first(thread):
    barrier.wait()
    try:
        modules(thread) if mode == "modules" else uses[(seed if mode == "same" else seed + thread) % 8]()
    except BaseException as error:
        print(mode, seed, thread, repr(error))
if mode == "modules" or seed // 8 % 2:
    import numpy, numpy.polynomial
    sys.setswitchinterval(1e-5)
barrier = threading.Barrier(8)
threads = [threading.Thread(target=first, args=(thread,)) for thread in range(8)]
[thread.start() for thread in threads]
[thread.join() for thread in threads]
"""


@pytest.mark.parametrize(
    ("mode", "rounds"),
    [
        ("modules", 1),
        ("mixed", 1),
        pytest.param("modules", 60, marks=pytest.mark.long),
        pytest.param("mixed", 48, marks=pytest.mark.long),
        pytest.param("same", 64, marks=pytest.mark.long),
    ],
)
def test_threads_may_use_optlaws_first_at_once(mode: str, rounds: int) -> None:
    rooms = ("optlaws.cli", "optlaws.explorer", "optlaws.__main__")
    names = " ".join(name for name in modules(ROOT / "optlaws") if not name.startswith(rooms))
    for seed in range(rounds):
        process = subprocess.run(
            [sys.executable, "-c", FIRST_USE, mode, str(seed), names],
            capture_output=True,
            text=True,
            check=False,
            timeout=300,
            cwd=ROOT,
        )
        assert (process.returncode, process.stdout) == (0, ""), process.stdout + process.stderr[-2000:]
