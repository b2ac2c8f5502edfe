"""Structures that come with optlaws: quick, of no weight in the answer, and what the machinery computes."""

import subprocess
import sys
from dataclasses import replace
from unittest.mock import patch

import numpy as np
import pytest

from optlaws import Chebyshev, Problem, Solution, synthesize
from tests.internals.structure_table import structure_of_program, structures_along_velocity
from tests.internals.synthesis import (
    ActiveSet,
    Model,
    extreme_velocity,
    key_of,
    model_of,
    stored_guess,
    stored_structures,
)

USUAL = [
    Problem(B=1.641, order=4, basis=Chebyshev(3), monotone=True),
    Problem(B=1.641, order=4, basis=Chebyshev(9)),
    Problem(B=2.9, order=3, basis=Chebyshev(18), monotone=True),
    Problem(B=1.3, order=6, basis=Chebyshev(39)),
    Problem(B=1.8, order=2, basis=Chebyshev(5), minimise="2*C"),
    Problem(order=5, basis=Chebyshev(13)),
    Problem(B=1.7, order=4, basis=Chebyshev(9), minimise="J"),
    Problem(B=2.389, order=3, basis=Chebyshev(18), minimise="J", monotone=True),
    Problem(order=4, basis=Chebyshev(7), minimise="J"),
    Problem(B=1.641, order=4, basis=Chebyshev(9), minimise="D"),
    Problem(B=2.3, order=2, basis=Chebyshev(20), minimise="3*D", monotone=True),
    Problem(order=5, basis=Chebyshev(5), minimise="D"),
]


def none(_: Model) -> None:
    """No structure is known."""


def wrong(model: Model) -> ActiveSet | None:
    """A structure with a contact too few, far from where it belongs."""
    guess = stored_guess(model)
    assert guess is not None
    return replace(guess, x=1.7 * guess.x, u=0.3 * guess.u, multipliers=-guess.multipliers)


def solved_with(guess: object, problem: Problem) -> Solution:
    with patch("optlaws.synthesis.search.stored_guess", guess):
        return synthesize(problem)


@pytest.mark.sample(3)
@pytest.mark.parametrize("problem", USUAL, ids=repr)
def test_the_last_digit_is_that_of_the_general_way(problem: Problem) -> None:
    quick, general, misled = synthesize(problem), solved_with(none, problem), solved_with(wrong, problem)
    assert quick.iterations == 0 < general.iterations
    for other in (general, misled):
        # of a problem that is not convex several starts were tried when its structure was stored
        assert quick == replace(other, starts=quick.starts)
        assert quick.law == other.law
        assert quick.certificate == other.certificate


def least_velocity(problem: Problem) -> Model:
    """The program of the least B."""
    return extreme_velocity(problem, greatest=False)


@pytest.mark.sample(4)
@pytest.mark.parametrize("minimise", ["C", "J", "D"])
@pytest.mark.parametrize("monotone", [False, True])
def test_the_file_holds_what_is_computed(minimise: str, monotone: bool) -> None:  # noqa: FBT001
    problem = Problem(order=4, basis=Chebyshev(3), minimise=minimise, monotone=monotone)
    for computed, model in (
        (structures_along_velocity(problem), model_of(problem.at_velocity(2.0))),
        *((structure_of_program(single), single) for single in (model_of(problem), least_velocity(problem))),
    ):
        key = key_of(model)
        assert key is not None
        stored = stored_structures(key)
        assert len(stored) == len(computed)
        for first, last in zip(stored, computed, strict=True):
            for name in ("family", "sign", "free"):
                assert np.array_equal(getattr(first, name), getattr(last, name))
            # a structure ends between two samples of B, so that its polynomials are about not quite the same stretch
            assert (first.begin, first.end) == pytest.approx((last.begin, last.end), abs=1e-3)
            for B in np.linspace(max(first.begin, last.begin), min(first.end, last.end), 9 if first.end else 1):
                for mine, other in zip(first.at(B), last.at(B), strict=True):
                    assert mine == pytest.approx(other, abs=3e-3, rel=3e-2)


def test_a_flat_optimum_is_not_stored() -> None:
    problem = Problem(order=2, minimise="J")
    assert structure_of_program(model_of(problem)) == []
    assert stored_guess(model_of(problem)) is None


@pytest.mark.parametrize(
    "problem", [Problem(B=1.7, order=4, symmetric=False), Problem(B=1.7, order=4, J=80.0), Problem(order=7)], ids=repr
)
def test_other_problems_have_no_guess(problem: Problem) -> None:
    assert stored_guess(model_of(problem)) is None


def test_a_usual_law_needs_neither_casadi_nor_scipy() -> None:
    script = (
        "import sys, optlaws\n"
        "optlaws.synthesize(optlaws.Problem(B=1.641, order=4))\n"
        "print(sorted({name.partition('.')[0] for name in sys.modules} & {'casadi', 'scipy', 'clarabel'}))"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
