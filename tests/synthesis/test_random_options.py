"""The random problems use every public option, and what becomes of them is counted."""

from collections.abc import Iterator
from dataclasses import fields
from math import inf

import pytest

from optlaws import FUNCTIONALS, Basis, Expression, Functional, Problem, Range
from optlaws.synthesis import Maximum
from tests.internals.synthesis import MAKERS
from tests.synthesis.judge import Judged, as_range
from tests.synthesis.random_options import BASES, CONSTANTS, Drawn, every_option

pytestmark = [pytest.mark.long, pytest.mark.filterwarnings("ignore::optlaws.errors.NotNormalised")]
#: constants of formulas and of machines, whose own tests draw them at random
FORMULAS = {"integral", "peak", "rms", "value"}
MACHINES = {"mode_residual", "output_peak", "output_rms"}
EVERY_CONSTANT = {*FUNCTIONALS, *MAKERS} - FORMULAS - MACHINES


@pytest.fixture(scope="module")
def drawn() -> list[Drawn]:
    return every_option(18, 400)


@pytest.fixture(scope="module")
def problems(drawn: list[Drawn]) -> list[Problem]:
    return [one.problem for one in drawn]


def called(constant: object) -> str:
    return repr(constant).partition("(")[0]


def functionals(expression: Expression) -> Iterator[Functional]:
    for _, term in expression.terms:
        if isinstance(term, Maximum):
            for part in term.parts:
                yield from functionals(part)
        else:
            assert isinstance(term, Functional)
            yield term


def manner(asked: float | Range | None) -> str | None:
    expected = as_range(asked)
    if expected is None:
        return None
    if expected.fixed:
        return "number"
    if expected.high == inf:
        return "at_least"
    return "at_most" if expected.low == 0.0 else "between"


def test_every_entry_of_a_problem_is_drawn(problems: list[Problem]) -> None:
    plain = Problem(order=4)
    for entry in fields(Problem):
        values = {repr(getattr(problem, entry.name)) for problem in problems}
        assert len(values) >= 2, f"random problems never use {entry.name}"
        assert values - {repr(getattr(plain, entry.name))}, f"random problems never use {entry.name}"


def test_every_constant_is_minimised_and_bounded(problems: list[Problem]) -> None:
    assert set(CONSTANTS) == EVERY_CONSTANT, "a new constant needs an entry in random_options.CONSTANTS"
    assert {
        called(functional) for problem in problems for functional in functionals(problem.objective)
    } == EVERY_CONSTANT
    bounded = {called(one) for problem in problems for one, _ in problem.bounded}
    assert bounded == EVERY_CONSTANT - {"B"}


def test_every_basis_is_drawn(problems: list[Problem]) -> None:
    # laws that repeat have no conditions at ends and are drawn with random cycles
    with_ends = set(Basis.kinds) - {"periodic"}
    assert set(BASES) == with_ends, "a new basis needs an entry in random_options.BASES"
    assert {problem.basis.name for problem in problems} == with_ends
    for name in with_ends:
        chosen = [problem.basis for problem in problems if problem.basis.name == name]
        for entry in fields(chosen[0]):  # type: ignore[arg-type] # each basis is a dataclass
            assert len({getattr(basis, entry.name) for basis in chosen}) >= 3, f"{name} never varies {entry.name}"


def test_a_constant_by_quadrature_is_the_laws_own(drawn: list[Drawn]) -> None:
    # the judge's own values of the constants of cams and followers
    for one in drawn[:60]:
        if one.witness is not None:
            judged = Judged(one.witness)
            for constant in one.problem.constants:
                own = constant.value(one.witness)
                assert judged.value(constant) == pytest.approx(own, rel=1e-8, abs=1e-9), constant
