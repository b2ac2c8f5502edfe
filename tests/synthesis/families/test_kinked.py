"""Integrals of formulas with kinks: slopes and second derivatives are differences, tangents are nowhere above."""

import numpy as np
import pytest

from optlaws import Chebyshev, Problem
from tests.internals.synthesis import KinkedIntegralFamily, model_of

KINDS = ("integral(abs(c - 2*a))", "integral(max((c + 0.5*b)*b, 0))", "integral(max(c, 0.5*b, 0)^2)", "rms(max(c, 0))")


def family_of(text: str, *, symmetric: bool) -> KinkedIntegralFamily:
    problem = Problem(B=1.8, order=4, basis=Chebyshev(5), minimise=text, symmetric=symmetric)
    [family] = [one for one in model_of(problem).program.families if isinstance(one, KinkedIntegralFamily)]
    return family


@pytest.mark.sample(3)
@pytest.mark.parametrize("symmetric", [True, False])
@pytest.mark.parametrize("text", KINDS)
def test_derivatives_are_differences(text: str, symmetric: bool) -> None:  # noqa: FBT001 - a parameter
    family = family_of(text, symmetric=symmetric)
    x = np.random.default_rng(2).normal(size=len(family.slack)) * 0.2
    one, step = np.ones(1), 1e-5
    gradient = family.jet(x, one, one).gradient[0] + family.slack
    bend = family.hessian(x, one, one)
    assert bend is not None
    for i, way in enumerate(step * np.eye(len(x))):
        ahead, back = (family.jet(x + sign * way, one, one) for sign in (1.0, -1.0))
        rise = family.value(x + way, one)[0] - family.value(x - way, one)[0]
        assert rise / (2.0 * step) == pytest.approx(gradient[i], rel=1e-6, abs=1e-7)
        assert (ahead.gradient - back.gradient)[0] / (2.0 * step) == pytest.approx(bend[i], rel=1e-4, abs=1e-5)


@pytest.mark.parametrize("text", [KINDS[0], *KINDS[2:]])
def test_tangents_are_nowhere_above(text: str) -> None:
    family, numbers = family_of(text, symmetric=True), np.random.default_rng(3)
    ones = np.ones(1)
    for _ in range(4):
        x, other = numbers.normal(size=(2, len(family.slack))) * 0.3
        row = family.tangent_row(1.0, 1.0, family.touching(x, 1.0))
        assert row is not None
        assert row @ np.append(x, 1.0) == pytest.approx(family.value(x, ones)[0], rel=1e-10)
        assert row @ np.append(other, 1.0) <= family.value(other, ones)[0] * (1.0 + 1e-10)


@pytest.mark.parametrize("text", ["integral(abs(c - 2*a))", "rms(max(c, 0))"])
def test_derivatives_by_the_law_and_its_kinks_are_differences(text: str) -> None:
    family = family_of(text, symmetric=False)
    x = np.random.default_rng(5).normal(size=len(family.slack))
    # of a neighbour, so that the formulas beside a kink differ there
    stretches = family.split(x + 1e-3).stretches
    kinks, step = family.kinks_of(stretches), 1e-5
    at = family.free_kinks(x, stretches)
    assert len(kinks)
    for i, way in enumerate(step * np.eye(len(x))):
        ahead, back = (family.free_kinks(x + sign * way, stretches) for sign in (1.0, -1.0))
        assert (ahead.value - back.value) / (2.0 * step) == pytest.approx(at.slope[i], rel=1e-6, abs=1e-7)
        assert (ahead.slope - back.slope) / (2.0 * step) == pytest.approx(at.bend[i], rel=1e-4, abs=1e-5)
        assert (ahead.rise - back.rise) / (2.0 * step) == pytest.approx(at.across[:, i], rel=1e-5, abs=1e-7)
    for i, way in enumerate(step * np.eye(len(kinks))):
        ahead, back = (family.free_kinks(x, family.with_kinks(stretches, kinks + s * way)) for s in (1.0, -1.0))
        assert (ahead.value - back.value) / (2.0 * step) == pytest.approx(at.share * at.rise[i], rel=1e-4, abs=1e-7)
        assert ((ahead.rise - back.rise) / (2.0 * step))[i] == pytest.approx(at.along[i], rel=1e-4, abs=1e-7)


def test_a_formula_that_touches_0_in_the_middle_has_its_sign_beside() -> None:
    """The jerk of these symmetric laws rises to 0 at k = 1/2, where rounding gives it any sign."""
    family = family_of("integral(abs(j))", symmetric=True)
    middle = family.columns_at(np.array([0.5]))[0, 0]
    places = (np.arange(20000) + 0.5) / 20000
    for seed in range(20):
        x = np.random.default_rng(seed).normal(size=len(family.slack)) * 0.1
        x -= middle[:-1] * (middle @ np.append(x, 1.0)) / (middle[:-1] @ middle[:-1])
        plain = np.abs(family.columns_at(places)[0] @ np.append(x, 1.0)).mean()
        # the objective is in units of its scale, 1/32 of a jerk
        assert family.value(x, np.ones(1))[0] == pytest.approx(plain / 32.0, rel=1e-6)


@pytest.mark.parametrize("text", [*KINDS, "rms(spline(a, 0:1, 0.3:2, 0.6:1, 1:3)*c)"])
def test_each_kink_is_a_simple_root_of_its_switch(text: str) -> None:
    """Even at knots of a spline, where the formulas beside a kink are the same, and where a square begins."""
    family = family_of(text, symmetric=False)
    x = np.random.default_rng(6).normal(size=len(family.slack)) * 0.1
    stretches = family.split(x).stretches
    kinks, step = family.kinks_of(stretches), 1e-6
    switches = family.switches_of(x, stretches)
    at = family.at_kinks(x, stretches, switches)
    assert len(kinks)
    assert np.abs(at.value / at.along) == pytest.approx(np.zeros(len(kinks)), abs=1e-12)
    ways = np.eye(len(x)) * step
    for way, across in zip(ways, at.across.T, strict=True):
        moved = family.kinks_of(family.split(x + way).stretches) - family.kinks_of(family.split(x - way).stretches)
        assert moved / (2.0 * step) == pytest.approx(-across / at.along, rel=1e-5, abs=1e-6)
