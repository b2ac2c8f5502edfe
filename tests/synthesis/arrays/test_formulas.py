"""Formulas that are not affine in the law, many laws at once: what each alone has, by the walk along the line."""

import numpy as np
import pytest

from optlaws import Chebyshev, Problem, ProblemArray, synthesize, synthesize_array
from tests.internals.synthesis import FormulaFamily, between, model_of
from tests.sampling import sampled

KINDS = (
    "integral(c^2 + (1 + k)*b^2)",
    "rms(c^2 + b^2)",
    "peak(c^2 + 9*b^2)",
    "peak(norm(c, 3*b))",
    "peak(exp(c/5), side=high)",
    "peak(c^2 + k*b^2, start=0.1, stop=0.7)",
)


@pytest.mark.parametrize("text", sampled(KINDS, 3))
def test_many_laws_of_a_formula_are_those_of_each_alone(text: str) -> None:
    asked = ProblemArray(B=np.linspace(1.65, 1.85, 140), order=4, basis=Chebyshev(5), minimise=text)
    laws = synthesize_array(asked)
    assert [len(part.places) for part in laws.parts] == [140]  # all by the walk, none alone
    assert float(laws.gap.max()) < 1e-10
    for place in (0, 77, 139):
        alone = synthesize(asked.problem(place))
        assert laws.objective[place] == pytest.approx(alone.objective, rel=1e-10)


@pytest.mark.parametrize("text", KINDS)
def test_planes_touch_and_second_derivatives_are_differences_of_slopes(text: str) -> None:
    program = model_of(Problem(B=1.8, order=4, basis=Chebyshev(5), minimise=text)).program
    [family] = [one for one in program.families if isinstance(one, FormulaFamily)][:1]
    assert family.continuable
    numbers = np.random.default_rng(1)
    x = numbers.normal(size=(3, program.size)) * 0.3
    u = np.tile(np.mean(family.domain) + np.array([0.0, 0.1]), (3, 1))
    value, slope, bend = family.planes(u, np.column_stack([x, np.ones(3)]))
    weights = np.array([[1.0, 0.5]] * 3)
    hessian = family.hessians(u, np.column_stack([x, np.ones(3)]), weights)
    for law in range(3):
        jet = family.jet(x[law], u[law], np.ones(2))
        room = family.right_side(x[law])
        point = np.append(x[law], 1.0)
        assert value[law] @ point - room == pytest.approx(jet.value, rel=1e-9, abs=1e-9)
        assert value[law][:, :-1] - family.slack == pytest.approx(jet.gradient, rel=1e-9, abs=1e-9)
        assert slope[law] @ point == pytest.approx(jet.slope, rel=1e-9, abs=1e-7)
        assert slope[law][:, :-1] == pytest.approx(jet.slope_gradient, rel=1e-9, abs=1e-7)
        assert bend[law] == pytest.approx(jet.curvature, rel=1e-9, abs=1e-6)
        own = family.hessian(x[law], u[law], weights[law])
        assert own is not None
        assert hessian[law] == pytest.approx(own, rel=1e-9, abs=1e-9)


def test_kinks_over_k_are_left_to_each_law_alone() -> None:
    first, last = (
        Problem(B=B, order=4, basis=Chebyshev(3), minimise="peak(c + table(k, 0:0, 0.5:1, 1:0)*b)")
        for B in (1.75, 1.85)
    )
    assert between(first, last) is None
