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

VALUES: dict[str, Callable[[], Any]] = {
    "solution": lambda: synthesize(Problem(B=1.7, order=3)),
    "solution of pieces": lambda: synthesize(Problem(B=1.7, order=3, basis=Pieces(4))),
    "solution of power": lambda: synthesize(Problem(B=1.7, order=3, minimise="D", basis=Chebyshev(3)), bound="tight"),
    "front": lambda: pareto_front(Problem(order=4), over=("B", "C"), points=3, between=(1.5, 1.8)),
    "balanced law": lambda: balanced_law(1.8, order=2, basis=Chebyshev(5), minimise="B_loader"),
    "spectrum": lambda: response_spectrum(savin("III", 7.2), [18.0, 20.0]),
    "response": lambda: Follower(nu=20, damping=0.05).response(savin("III", 7.2)),
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


def test_a_module_and_the_tests_of_its_laws_run_in_one_call() -> None:
    # pytest must not import a module that its package has imported a second time
    files = ["optlaws/laws/polynomial.py", "tests/contracts/test_laws.py"]
    arguments = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-k", "equal_law", *files]
    process = subprocess.run(
        arguments, cwd=Path(__file__).parent.parent, capture_output=True, text=True, check=False, timeout=120
    )
    assert process.returncode == 0, process.stdout[-2000:]
