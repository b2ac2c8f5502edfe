"""Limits and bounds are rounded outward: none is above the exact value, checked in exact and 60-digit arithmetic."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from functools import partial
from math import inf
from sys import float_info
from typing import Any

import mpmath  # type: ignore[import-untyped]
import numpy as np
import pytest

from optlaws import BoundaryConditions, BSplines, Chebyshev, Pieces, Problem, at_least, at_most, limit, synthesize
from tests.internals.synthesis import (
    acceleration_limit_at_jerk,
    known_limit,
    not_above,
    root_rounded_down,
    rounded_down,
    rounded_up,
)
from tests.internals.verification import prove


@pytest.fixture(autouse=True)
def sixty_digits() -> Iterator[None]:
    with mpmath.workdps(60):
        yield


GENERATOR = np.random.default_rng(11)
NEAR = [1.0 + 2.0**-40, 1.1, 1.5 - 2e-9, 1.5, 1.5 + 2.0**-52, 1.5 + 1e-7, 2.0, 2.0 + 1e-12, 1e6]
VELOCITIES = [*NEAR, *(1.0 + GENERATOR.exponential(1.0, 40)).tolist()]


def _root(cubic: Any, low: Any, high: Any) -> mpmath.mpf:
    """By halving; the cubic changes its sign once between the two."""
    low, high = mpmath.mpf(low), mpmath.mpf(high)
    rising = cubic(high) > 0
    for _ in range(200):
        middle = (low + high) / 2
        low, high = (low, middle) if (cubic(middle) > 0) == rising else (middle, high)
    return (low + high) / 2


def _acceleration(b: mpmath.mpf, *, monotone: bool) -> mpmath.mpf:
    high = b * b if monotone else 2 * (b - 2 + mpmath.hypot(b - 2, b))
    return b * b / (b - 1) if b <= 2 else high


def _rms(b: mpmath.mpf, *, monotone: bool) -> mpmath.mpf:
    high = 4 * b / 3 * mpmath.sqrt(b) if monotone and b >= 3 else 4 * mpmath.sqrt(b * b - 3 * b + 3)
    return 4 * b / 3 * mpmath.sqrt(b / (b - 1)) if b <= 1.5 else high


def _power(b: mpmath.mpf, *, monotone: bool) -> mpmath.mpf:
    if b <= 1.5 or monotone:
        return b**3 / (3 * (b - 1)) if b <= 1.5 else 2 * b**3 / 3
    return b * b + 2 * _root(lambda u: 2 * u**3 + 3 * u**2 - b * b * (b - 1.5), 0, b) ** 2


def _jerk(b: mpmath.mpf, *, monotone: bool) -> mpmath.mpf:
    if monotone and b >= 2:
        return 4 * b**3
    return 4 * b**3 / (b - 1) ** 2 if b <= 2 else 16 * (2 * (b - 2) + mpmath.hypot(2 * (b - 2), b))


def _jerk_of_free_ends(b: mpmath.mpf, *, monotone: bool) -> mpmath.mpf:
    if monotone and b >= 2:
        return 4 * b**3
    if b <= 1.5:
        return 8 * b**3 / (9 * (b - 1) ** 2)
    return 8 * b / (1 - 2 * _root(lambda r: 2 * b * r**3 - 6 * (b - 1) * r**2 + 2 * b - 3, 0, 0.70711) ** 2)


EXACT = {("C", 3): _acceleration, ("D", 3): _power, ("RMS", 3): _rms, ("J", 2): _jerk_of_free_ends, ("J", 3): _jerk}


@pytest.mark.sample(4)
@pytest.mark.parametrize("monotone", [False, True])
@pytest.mark.parametrize(("constant", "order"), EXACT, ids=str)
def test_limits_are_just_below_the_exact_values(constant: str, order: int, *, monotone: bool) -> None:
    for B in VELOCITIES:
        stated = limit(constant, B, order=order, monotone=monotone)
        exact = EXACT[constant, order](mpmath.mpf(B), monotone=monotone)
        assert stated <= exact
        assert stated >= exact * (1 - mpmath.mpf(10) ** -13)


@pytest.mark.sample(2)
@pytest.mark.parametrize("share", [1.0, 1.0001, 1.3, 12.0, 1e6])
def test_limits_at_a_given_jerk_are_just_below_the_exact_values(share: float) -> None:
    for B in VELOCITIES:
        J = share * limit("J", B)
        b, j = mpmath.mpf(B), mpmath.mpf(J)
        stated = acceleration_limit_at_jerk(B, J)
        if b <= 2:
            w = (b - 1) / b
            root = mpmath.sqrt(max(w * w - 4 * b / j, 0))
            exact = 2 * b / (w + root)
        else:
            t = (b - 2) / (b + mpmath.sqrt(b * b + j * (b - 2) / 4))
            rise, w = b + j * t * t / 4, mpmath.mpf(1) / 2 - t
            exact = 2 * rise / (w + mpmath.sqrt(max(w * w - 4 * rise / j, 0)))
            if j * t / 2 > exact:
                least = _acceleration(b, monotone=False)
                cubic = partial(lambda b, j, x: x * x - 4 * (b - 2) * x - 4 * b * b - 4 * x**3 / j, b, j)
                exact = _root(cubic, least, stated * (1 + 1e-6))
        # at the least jerk itself the root is double: half the digits are lost in J, not in the limit
        assert stated <= exact * (1 + (mpmath.mpf(10) ** -7 if share == 1.0 else 0))
        assert stated >= exact * (1 - mpmath.mpf(10) ** (-6 if share == 1.0 else -11))


def test_exact_numbers_are_rounded_down() -> None:
    assert rounded_down(Fraction(9, 4)) == 2.25
    assert Fraction(rounded_down(Fraction(1, 3))) <= Fraction(1, 3) < Fraction(float(np.nextafter(1 / 3, 1)))
    assert root_rounded_down(Fraction(0), Fraction(1), Fraction(2)) ** 2 < 2.0000000000000001
    assert not_above(1.1, lambda x: x <= 1) <= 1.0


@pytest.mark.parametrize("beyond", [1, 2**969, 2**970, 2**1100])
def test_numbers_beyond_the_greatest_double_are_rounded_outward_too(beyond: int) -> None:
    greatest = float_info.max
    value = Fraction(greatest) + beyond
    assert (rounded_down(value), rounded_up(value)) == (greatest, inf)
    assert (rounded_down(-value), rounded_up(-value)) == (-inf, -greatest)


def test_the_limit_of_a_sum_is_not_above_the_sum_of_the_limits() -> None:
    for B in VELOCITIES[:20]:
        parts = [limit(name, B, order=4) for name in ("C", "D", "RMS")]
        stated = known_limit(Problem(B=B, order=4, minimise="0.1*C + 0.7*D + 0.3*rms_c"))
        exact = sum(Fraction(w) * Fraction(x) for w, x in zip((0.1, 0.7, 0.3), parts, strict=True))
        assert stated is not None
        assert Fraction(stated) <= exact


KINDS: list[dict[str, Any]] = [
    *({"order": 1, "B": B} for B in (None, 1.6, at_most(1.6))),
    {"order": 1, "B": at_least(1.3), "inflexion": 0.5},
    {"order": 1, "minimise": "max(C_plus, C_minus/2)", "symmetric": False},
    {"B": 1.859, "basis": Chebyshev(15)},
    {"B": at_most(1.6), "minimise": "J"},
    {"minimise": "C/4 + J/32", "basis": Pieces(6)},
    {"minimise": "rms_c", "basis": BSplines(6, 3)},
    {"boundary": BoundaryConditions((0, 1), (1, -1)), "minimise": "C_plus + J/30", "symmetric": False},
    {"boundary": BoundaryConditions((0, 0), (0, 0)), "symmetric": False},
]


@pytest.mark.sample(2)
@pytest.mark.parametrize("kind", KINDS, ids=str)
def test_no_bound_is_above_its_objective(kind: dict[str, Any]) -> None:
    solution = synthesize(Problem(**{"order": 3, **({} if "boundary" not in kind else {"order": 2}), **kind}))
    assert solution.status == "optimal"
    assert solution.certificate.bound <= solution.objective
    assert solution.lower_bound <= solution.objective
    assert solution.best_possible is None or solution.best_possible <= solution.objective


@pytest.mark.parametrize("degree", [3, 9, 15])
def test_a_bound_in_doubles_is_not_above_what_its_contacts_prove_exactly(degree: int) -> None:
    for B in (1.6, 1.859, 2.4):
        certificate = synthesize(Problem(B=B, order=4, basis=Chebyshev(degree))).certificate
        exact = prove(certificate).value
        assert exact is not None
        assert Fraction(certificate.bound) <= exact
