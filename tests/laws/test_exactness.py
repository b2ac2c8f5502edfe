"""Peaks against 60-digit arithmetic on the very law that is stored."""

from functools import cache

import numpy as np
import pytest
from mpmath import mp, mpf  # type: ignore[import-untyped]

from optlaws import PolynomialLaw, smoothstep
from tests.laws.examples import free_function_law, random_law
from tests.laws.many_digits import DENSE, Exact

DIGITS = 110  # powers of k lose 45 digits at degree 61

LAWS: dict[str, PolynomialLaw] = {
    **{f"S_{order}": smoothstep(order) for order in (2, 3, 4, 5, 7, 9, 12, 17, 25, 30)},
    **{
        f"random {count + 1} x {decay}": random_law(count, count, decay)
        for count in (2, 3, 5, 8, 13, 16, 24, 37, 48, 59)
        for decay in (1.0, 0.8, 0.3)
    },
    **{
        f"Z of {terms} terms on S_{order}": free_function_law(terms, order, terms)
        for order, terms in ((1, 3), (2, 4), (3, 6), (4, 10), (5, 12), (8, 20), (10, 30))
    },
}


@cache
def built(name: str) -> tuple[PolynomialLaw, Exact]:
    with mp.workdps(DIGITS):
        law = LAWS[name]
        return law, Exact(law)


@pytest.mark.sample(3)
@pytest.mark.parametrize("name", LAWS)
def test_peak_constants_are_right_to_12_digits(name: str) -> None:
    law, exact = built(name)
    constants = law.constants
    with mp.workdps(DIGITS):
        for nu, peak in ((1, constants.B), (2, constants.C), (3, constants.J)):
            assert abs(peak.value / exact.peak(nu, law(DENSE, nu)) - 1) < 1e-12
        assert abs(constants.D.value / exact.power_peak(law.d(DENSE)) - 1) < 1e-12


@pytest.mark.parametrize("name", LAWS)
def test_peaks_sit_where_the_slope_vanishes(name: str) -> None:
    law, exact = built(name)
    with mp.workdps(DIGITS):
        for nu in (1, 2, 3):
            k = law.peak(nu).k
            if 0 < k < 1:
                assert abs(exact(mpf(k), nu + 1) / exact(mpf(k), nu + 2)) < 1e-13
        k = law.power_peak().k
        b, c, j, s = (exact(mpf(k), nu) for nu in (1, 2, 3, 4))
        assert k in {0, 1} or abs((c * c + b * j) / (3 * c * j + b * s)) < 1e-13


@pytest.mark.sample(2)
@pytest.mark.parametrize("name", LAWS)
def test_values_are_right_to_12_digits_of_the_peak(name: str) -> None:
    law, exact = built(name)
    places = np.random.default_rng(5).uniform(size=15).tolist()
    with mp.workdps(DIGITS):
        for nu in range(4):
            scale = law.peak(nu).value
            assert max(abs(exact(mpf(k), nu) - law(k, nu)) for k in places) < 1e-12 * scale


def test_no_peak_is_missed_in_many_random_laws() -> None:
    rng = np.random.default_rng(11)
    k = DENSE[::10]
    for _ in range(250):
        count = int(rng.integers(1, 60))
        shapes = (
            rng.uniform(0.2, 1.0) ** np.arange(count),
            10.0 ** rng.uniform(-18, 0, size=count),
            rng.random(count) < 0.2,
            np.exp(-(((np.arange(count) - rng.uniform(0, count)) / rng.uniform(0.5, 10)) ** 2)),
        )
        law = PolynomialLaw(rng.normal(size=count) * shapes[rng.integers(4)], b0=rng.normal())
        constants = law.constants
        for peak, values in (
            (constants.B, law.b(k)),
            (constants.C, law.c(k)),
            (constants.D, law.d(k)),
            (constants.J, law.j(k)),
        ):
            assert peak.value >= np.abs(values).max() * (1 - 1e-13)
