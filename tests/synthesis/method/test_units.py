"""Laws of great velocity: solved in units of their size, exact to the same digits as others."""

from itertools import pairwise

import numpy as np
import pytest

from optlaws import Chebyshev, Pieces, Problem, Solution, at_least, between, residual_vibration, synthesize
from optlaws.verification import exact_bound
from tests.internals.synthesis import ProductFamily, model_of, solve, units_of
from tests.synthesis.judge import Judged

GREAT = (1e4, 1e6, 1e9)


def asked(B: float) -> list[Problem]:
    return [
        Problem(order=3, B=B, minimise="J"),
        Problem(order=3, B=B, minimise="C", basis=Pieces(8, 5, 3)),
        Problem(order=3, B=B, minimise="C", symmetric=False, basis=Chebyshev(7)),
        Problem(order=3, B=between(B, 2.0 * B), inflexion=0.5, minimise="C/4 + J/32"),
        Problem(order=4, B=at_least(B), inflexion=0.5, minimise="max(C/4, rms_c/3)"),
    ]


def kept(solution: Solution, B: float) -> None:
    """What the problem asks holds to the digits that numbers of this size have."""
    law, rounding = solution.law, 1e-14 * B
    assert solution.constants.B.value == pytest.approx(B, rel=1e-9)
    assert float(law.b(0.5)) == pytest.approx(B, rel=1e-9)
    assert [float(law(k)) for k in (0.0, 0.5, 1.0)] == pytest.approx([0.0, 0.5, 1.0], abs=rounding)
    assert [float(law.b(k)) for k in (0.0, 1.0)] == pytest.approx([0.0, 0.0], abs=rounding)
    assert Judged(law).worth(solution.problem.objective) == pytest.approx(solution.objective, rel=1e-9)


@pytest.mark.sample(4)
@pytest.mark.parametrize("place", range(len(asked(1e4))))
def test_great_velocities_are_proven_to_nine_digits(place: int) -> None:
    ratios = []
    for B in GREAT:
        problem = asked(B)[place]
        solution = synthesize(problem)
        assert solution.status == "optimal"
        kept(solution, B)
        bound = exact_bound(solution.certificate)
        assert bound is not None
        assert abs(float(bound) / solution.objective - 1.0) < 1e-9
        ratios.append(solution.objective / B)
    # a stroke of 1 is nothing to great laws: what it changes falls with B
    assert all(
        abs(after / before - 1.0) < 20.0 / B for (before, after), B in zip(pairwise(ratios), GREAT, strict=False)
    )


def test_the_power_of_great_laws_is_bounded() -> None:
    ratios = []
    for B in GREAT:
        solution = synthesize(Problem(order=3, B=B, minimise="D"))
        kept(solution, B)
        assert solution.lower_bound >= B * B
        ratios.append(solution.objective / B**2)
    assert max(ratios) < 3.5
    assert all(
        abs(after / before - 1.0) < 20.0 / B for (before, after), B in zip(pairwise(ratios), GREAT, strict=False)
    )


@pytest.mark.sample(2)
@pytest.mark.parametrize(
    "problem",
    [
        Problem(order=3, B=1e6, minimise="max(C/4, D/2.25)", monotone=True),
        Problem(order=3, B=at_least(1e6), inflexion=0.5, minimise=residual_vibration(frequency=7.0, damping=0.1)),
        Problem(order=3, B=1e6, minimise="rms_j", symmetric=False, basis=Pieces(4, 6, 3)),
    ],
)
def test_rows_in_other_units_are_the_same_rows(problem: Problem) -> None:
    program = model_of(problem).program
    units = units_of(program)
    assert units is not None
    numbers = np.random.default_rng(5)
    x = numbers.normal(size=program.size) * units.variables
    for family, other, unit in zip(program.families, units.program.families, units.rows, strict=True):
        u = np.linspace(*family.domain, 7)
        s = np.full(7, family.signs[0])
        jets = family.jet(x, u, s), other.jet(x / units.variables, u, s)
        scale = np.abs(jets[0].value).max() + 1.0
        assert np.abs(jets[1].value * unit - jets[0].value).max() < 1e-12 * scale
        gradient = jets[1].gradient * unit / units.variables
        assert np.abs(gradient - jets[0].gradient).max() < 1e-9 * np.abs(jets[0].gradient).max()
        assert isinstance(family, ProductFamily) == (unit > 1e7)
    optimum = solve(program).optimum
    if optimum is not None:
        again = units.outward(units.inward(optimum))
        assert np.allclose(again.x, optimum.x, rtol=1e-14)
        assert np.allclose(again.multipliers, optimum.multipliers, rtol=1e-14)
        assert np.allclose(again.equality_multipliers, optimum.equality_multipliers, rtol=1e-14)


def test_laws_of_usual_size_are_solved_as_they_are() -> None:
    assert units_of(model_of(Problem(order=3, B=2.0)).program) is None
