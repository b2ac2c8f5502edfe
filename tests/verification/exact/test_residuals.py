"""Residual vibration in complex balls, against integrals by mpmath, and claims that are tampered with."""

from dataclasses import replace
from fractions import Fraction
from functools import cache
from typing import Any

import mpmath  # type: ignore[import-untyped] # ships no types
import pytest

from optlaws import (
    Certificate,
    Chebyshev,
    Contact,
    Pieces,
    Problem,
    Solution,
    at_most,
    residual_vibration,
    smoothstep,
    synthesize,
)
from optlaws.verification import exact_bound
from tests.internals.verification import ExactLaw, ExactRows, enclosed

INTERVAL = "residual(frequency=(9, 12), damping=0.03)"


@cache
def robust() -> Solution:
    return synthesize(Problem(order=4, minimise=INTERVAL, B=1.8, C=at_most(7), basis=Chebyshev(7)))


def velocity(k: mpmath.mpf) -> mpmath.mpf:
    return 140 * k**3 * (1 - k) ** 3


def amplitude(
    frequency: float, damping: float, design: float | None = None, design_damping: float = 0.0, of: str = "acceleration"
) -> mpmath.mpf:
    """Of 35 k^4 - 84 k^5 + 70 k^6 - 20 k^7, by Duhamel's integral."""
    n, ratio = mpmath.mpf(damping) * frequency, mpmath.mpf(damping)
    w = mpmath.mpc(-n, frequency * mpmath.sqrt(1 - ratio**2))
    size = (
        frequency ** (2 if of == "acceleration" else 0)
        * abs(w)
        / w.imag
        * abs(mpmath.quad(lambda k: mpmath.exp(w * (1 - k)) * velocity(k), [0, 0.5, 1]))
    )
    if design is None:
        return size
    n0 = mpmath.mpf(design_damping) * design
    return size * abs(1 - (frequency / mpmath.mpf(design)) ** 2 + 2 * (n0 - n) * w / mpmath.mpf(design) ** 2)


@pytest.mark.parametrize(
    "asked",
    [
        {"frequency": 18.0, "damping": 0.0},
        {"frequency": 7.5, "damping": 0.25},
        {"frequency": 7.5, "damping": 0.25, "of": "displacement"},
        {"frequency": 12.0, "damping": 0.0625, "design": 10.0, "design_damping": 0.125},
    ],
)
def test_a_residual_is_that_by_hand(asked: dict[str, Any]) -> None:
    with mpmath.workdps(40):
        low, high = enclosed(ExactLaw(smoothstep(4)).term(residual_vibration(**asked)))
        assert low <= amplitude(**asked) <= high
        assert high - low < 1e-14 * high


def test_the_greatest_over_an_interval_is_that_by_hand() -> None:
    # between two frequencies that leave nothing
    with mpmath.workdps(30):
        nu = mpmath.findroot(lambda nu: mpmath.diff(lambda x: amplitude(x, 0.0) ** 2, nu), 24)
        low, high = enclosed(ExactLaw(smoothstep(4)).term(residual_vibration(frequency=(22.0, 26.0))))
        expected = max(amplitude(place, 0.0) for place in (22.0, 26.0, nu))
        assert low <= expected <= high
        assert high - low < 1e-11 * high


def test_rows_of_all_bases_give_the_amplitude_of_their_base_law() -> None:
    contact = Contact("residual(frequency=(9.0, 12.0), damping=0.03)", 1.0, 0.25, 1.0, (0.6, 0.8))
    for symmetric in (True, False):
        pieces = Problem(order=4, minimise=INTERVAL, symmetric=symmetric, basis=Pieces([0, 0.5, 1], 7, 3))
        whole = replace(pieces, basis=Chebyshev(3))
        first, second = (ExactRows(Certificate.of_leaf(one, (), ())).row(contact) for one in (whole, pieces))
        assert first is not None
        assert second is not None
        # k^4, k^5, k^6 and k^7 with the weights of the smoothstep, then nothing from the middle on
        weights = [35, -84, 70, -20]
        of_pieces = sum(
            (w * function for w, function in zip(weights, second.functions, strict=False)), second.functions[-1]
        )
        if not symmetric:
            assert first.functions[-1].overlaps(of_pieces)
        assert float(first.functions[-1].rad()) < 1e-10


@pytest.mark.parametrize("stretch", [0.5, 3.0])
def test_no_longer_direction_proves_more(stretch: float) -> None:
    solution = robust()
    longer = tuple(
        replace(contact, direction=tuple(stretch * value for value in contact.direction))
        for contact in solution.certificate.contacts
    )
    bound = exact_bound(solution.certificate.with_leaf(contacts=longer))
    assert bound is None or bound <= Fraction(solution.objective) * (1 + Fraction(1, 10**10))
