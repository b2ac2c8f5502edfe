"""Formulas in Taylor arithmetic against mpmath's Taylor series."""

import mpmath as mp  # type: ignore[import-untyped]
import numpy as np
import pytest

from tests.internals.formulas import formula_jet, read
from tests.internals.numerics import Interval, Jet, exact

FORMULAS = {
    "exp(2*x)": lambda x: mp.exp(2 * x),
    "log(1 + x)^3": lambda x: mp.log(1 + x) ** 3,
    "tan(x)/(1 + x^2)": lambda x: mp.tan(x) / (1 + x**2),
    "tanh(x)^0.5*sqrt(2 + x)": lambda x: mp.sqrt(mp.tanh(x)) * mp.sqrt(2 + x),
    "atan(x)^1.3": lambda x: mp.atan(x) ** mp.mpf(1.3),
    "max(x, 0.2)*abs(x - 2)": lambda x: max(x, mp.mpf("0.2")) * abs(x - 2),
    "2^x*sin(pi*x)": lambda x: mp.mpf(2) ** x * mp.sin(mp.pi * x),
    "norm(x, 1 - x)": lambda x: mp.sqrt(x**2 + (1 - x) ** 2),
    "cos(x)^-2": lambda x: mp.cos(x) ** -2,
}


@pytest.mark.parametrize("text", FORMULAS)
def test_the_terms_of_a_jet_enclose_those_of_the_function(text: str) -> None:
    places = np.array([0.3, 0.6])
    zero = exact(np.zeros(2))
    jet = formula_jet(read(text, ("x",)), "x", Jet((exact(places), zero + 1.0, zero, zero)))
    with mp.workdps(30):
        for i, x in enumerate(places):
            for term, known in zip(jet.terms, mp.taylor(FORMULAS[text], mp.mpf(x), 3), strict=True):
                assert float(term.low[i]) <= known <= float(term.high[i])
                assert float(term.radius[i]) <= 1e-11 * (1.0 + abs(known))


@pytest.mark.parametrize("text", ["spline(x, 0:1, 0.3:1.1, 0.7:1.4, 1:1.3)", "table(x, 0:1, 0.5:2, 1:0)"])
def test_over_a_cell_a_table_has_all_its_slopes(text: str) -> None:
    cell = Interval(np.array([0.5]), np.array([0.1]))
    jet = formula_jet(read(text, ("x",)), "x", Jet((cell, exact(np.array([1.0])))))
    x = np.linspace(0.4, 0.6, 41)
    values = np.concatenate(
        [formula_jet(read(text, ("x",)), "x", Jet((exact(np.array([at])),))).terms[0].middle for at in x]
    )
    slopes = np.diff(values) / np.diff(x)
    for term, own in zip(jet.terms, (values, slopes), strict=True):
        assert term.low[0] <= own.min() + 1e-12
        assert own.max() - 1e-12 <= term.high[0]
