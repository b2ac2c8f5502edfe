"""The greatest values of polynomials, enclosed, and how far functions are apart: against fractions and mpmath."""

from fractions import Fraction
from math import comb

import mpmath  # type: ignore[import-untyped] # ships no types
import numpy as np
import pytest

from optlaws import InputError
from tests.internals.numerics import bernstein, greatest_difference, nodes


@pytest.mark.parametrize("degree", [0, 1, 5, 9])
def test_bernstein_coefficients_are_those_of_the_definition(degree: int) -> None:
    powers = np.random.default_rng(degree).integers(-9, 9, size=(3, degree + 1)).astype(float)
    exact = [
        [
            float(sum(Fraction(comb(i, n), comb(degree, n)) * int(row[n]) for n in range(i + 1)))
            for i in range(degree + 1)
        ]
        for row in powers
    ]
    assert bernstein.from_powers(powers) == pytest.approx(np.array(exact), rel=1e-14, abs=1e-13)
    u = (nodes(degree + 1) + 1.0) / 2.0
    values = np.array([np.polynomial.polynomial.polyval(u, row) for row in powers])
    assert bernstein.from_values(values) == pytest.approx(np.array(exact), rel=0, abs=1e-10)


def test_a_top_is_enclosed_and_found_where_it_is() -> None:
    for place in (0.1234567, 0.5, 1 / 3, 0.999):
        powers = np.array([[2.0 - place**2, 2.0 * place, -1.0, 0.0], [0.0, 0.0, 0.0, 1.9]])  # 2 - (u - place)²
        highest = bernstein.top(bernstein.from_powers(powers))
        assert highest.row == 0
        assert highest.value == pytest.approx(2.0, rel=0, abs=1e-15)
        assert highest.u == pytest.approx(place, abs=1e-7)


def test_the_greatest_difference_is_that_of_many_digits() -> None:
    value, x = greatest_difference(np.exp, lambda x: 1.0 + x + x * x / 2.0, np.array([-1.0, 0.3, 1.0]))
    with mpmath.workdps(30):
        assert value == pytest.approx(float(mpmath.e - mpmath.mpf(5) / 2), rel=1e-14)
    assert x == 1.0
    with pytest.raises(InputError, match=r"not smooth near x = .*: name its breaks"):
        greatest_difference(np.sign, lambda x: x * 0.0, np.array([-1.0, 0.7]))
    with pytest.raises(InputError, match="finite values"):
        greatest_difference(np.abs, lambda x: x + np.inf, np.array([-1.0, 0.7]))
