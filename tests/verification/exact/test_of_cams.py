"""Constants of cams in balls, against cams that mpmath differentiates, and claims that are tampered with."""

from dataclasses import replace
from fractions import Fraction
from functools import cache
from math import perm

import mpmath  # type: ignore[import-untyped] # ships no types
import pytest

from optlaws import Chebyshev, Functional, InputError, Problem, Solution, cam_constant, maximum, smoothstep, synthesize
from optlaws.verification import exact_bound, verify
from tests.internals.verification import ExactLaw, enclosed

NU, DAMPING = 12.0, 0.25


@cache
def damped() -> Solution:
    return synthesize(Problem(order=4, minimise=cam_constant("C", frequency=NU, damping=DAMPING), basis=Chebyshev(7)))


def cam(k: mpmath.mpf | float, order: int) -> mpmath.mpf | float:
    """A derivative of the cam of 35 k^4 - 84 k^5 + 70 k^6 - 20 k^7, by hand, in the arithmetic of k."""
    mass = [0, 0, 0, 0, 35, -84, 70, -20]

    def derivative(nu: int) -> mpmath.mpf | float:
        return sum(a * perm(i, nu) * k ** (i - nu) for i, a in enumerate(mass) if i >= nu)

    return derivative(order) + (2 * DAMPING * NU * derivative(order + 1) + derivative(order + 2)) / NU**2


def greatest(order: int, sign: int) -> mpmath.mpf:
    """By Newton's method from the highest of a thousand points, to 30 digits."""
    k = mpmath.mpf(max(range(1001), key=lambda i: sign * cam(i / 1000, order))) / 1000
    if 0 < k < 1:
        k = mpmath.findroot(lambda k: cam(k, order + 1), k)
    return sign * cam(k, order)


@pytest.mark.parametrize(
    ("name", "order", "signs"),
    [("B", 1, (1, -1)), ("C", 2, (1, -1)), ("C_plus", 2, (1,)), ("C_minus", 2, (-1,)), ("J", 3, (1, -1))],
)
def test_peaks_of_cams_are_those_by_hand(name: str, order: int, signs: tuple[int, ...]) -> None:
    with mpmath.workdps(40):
        expected = max(greatest(order, sign) for sign in signs)
        low, high = enclosed(ExactLaw(smoothstep(4)).term(cam_constant(name, frequency=NU, damping=DAMPING)))
        assert low <= expected <= high
        assert high - low < 1e-14 * high


def test_the_power_of_a_cam_is_that_by_hand() -> None:
    with mpmath.workdps(40):
        peak = mpmath.mpf(max(range(1001), key=lambda i: abs(cam(i / 1000, 1) * cam(i / 1000, 2)))) / 1000
        k = mpmath.findroot(lambda k: cam(k, 2) ** 2 + cam(k, 1) * cam(k, 3), peak)
        low, high = enclosed(ExactLaw(smoothstep(4)).term(cam_constant("D", frequency=NU, damping=DAMPING)))
        assert low <= abs(cam(k, 1) * cam(k, 2)) <= high


def test_tampered_claims_are_refused() -> None:
    solution = damped()
    data = solution.to_dict()
    assert verify(data).proven
    for key, change in (("objective", 1e-8), ("objective", -1e-8), ("lower_bound", 1e-7)):
        assert not verify({**data, key: data[key] + change}).proven, key
    # the problem of a stiffer follower
    other = {**data["problem"], "minimise": repr(cam_constant("C", frequency=NU + 0.001, damping=DAMPING))}
    assert not verify({**data, "problem": other}).proven
    assert not verify({**data, "problem": other, "certificate": {**data["certificate"], "problem": other}}).proven


@pytest.mark.parametrize("factor", [0.999, 1.001])
def test_no_bound_of_other_multipliers_exceeds_the_optimum(factor: float) -> None:
    solution = damped()
    first, *others = solution.certificate.contacts
    moved = (replace(first, multiplier=factor * first.multiplier), *others)
    bound = exact_bound(solution.certificate.with_leaf(contacts=moved))
    assert bound is None or bound <= Fraction(solution.objective) * (1 + Fraction(1, 10**12))


def test_a_cam_that_is_not_smooth_enough_has_no_rows() -> None:
    constant = cam_constant("C", frequency=NU)
    asked = replace(damped().certificate, problem=Problem(order=3, minimise=constant, basis=Chebyshev(7)))
    with pytest.raises(InputError, match="needs mass laws of order 4 at least"):
        exact_bound(asked)


def test_a_constant_that_only_looks_like_a_cams_is_refused() -> None:
    constant = cam_constant("C", frequency=NU)
    other: Functional = replace(constant, weights=(Fraction(1),))  # type: ignore[call-arg]
    with pytest.raises(InputError, match="as optlaws defines them, not C_cam"):
        ExactLaw(smoothstep(4)).sum(maximum(other, other).expression())
