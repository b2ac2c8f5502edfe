"""What formulas are worth: numpy, CasADi, mpmath, balls, Taylor arithmetic and Python agree; slopes are differences."""

import math
from random import Random

import mpmath  # type: ignore[import-untyped]
import mpmath as mp
import numpy as np
import pytest
from flint import arb
from scipy.interpolate import CubicSpline

from optlaws import InputError
from tests.formulas.by_python import by_python
from tests.formulas.mpmath_numbers import MPMATH
from tests.formulas.trees import NAMES, text
from tests.internals.formulas import (
    NUMPY,
    Endpoints,
    Formula,
    affine,
    casadi_arithmetic,
    degree,
    derivative,
    enclosed,
    evaluate,
    formula_jet,
    quadratic,
    read,
)
from tests.internals.numerics import Interval, Jet, exact
from tests.internals.verification import BALLS


def drawn(seed: int, depth: int = 4) -> tuple[str, Formula, dict[str, float]]:
    numbers = Random(seed)  # noqa: S311
    written = text(numbers, depth)
    return written, read(written), {name: numbers.uniform(-1.5, 1.5) for name in (*NAMES, "k")}


@pytest.mark.parametrize("batch", range(4))
def test_every_arithmetic_agrees_with_python(batch: int) -> None:
    import casadi

    for seed in range(40 * batch, 40 * batch + 40):
        written, formula, values = drawn(seed)
        expected = float(by_python(written, values))
        close = pytest.approx(expected, rel=1e-11, abs=1e-12)
        assert float(evaluate(formula, values, NUMPY)) == close, written
        assert float(evaluate(formula, {n: mpmath.mpf(v) for n, v in values.items()}, MPMATH)) == close
        assert float(casadi.DM(evaluate(formula, values, casadi_arithmetic()))) == close
        value = evaluate(formula, {n: arb(v) for n, v in values.items()}, BALLS)
        assert float(value.mid()) == close
        boxes = {n: Endpoints(np.array(v - 1e-3), np.array(v + 1e-3)) for n, v in values.items()}
        around = enclosed(formula, boxes)
        assert around.low <= expected <= around.high


@pytest.mark.parametrize("written", ["k + 1e17 - 1e17", "k*1e-9*1e9", "sin(3e5*k)", "cos(1e12*k)", "k*3/3 - k/7*7"])
@pytest.mark.parametrize("k", [0.1, 0.7, 1.0])
def test_bounds_hold_what_rounding_loses(written: str, k: float) -> None:
    formula, box = read(written), Endpoints(np.array(k), np.array(k))
    around = enclosed(formula, {"k": box})
    with mpmath.workdps(60):
        value = evaluate(formula, {"k": mpmath.mpf(k)}, MPMATH)
        assert mpmath.mpf(float(around.low)) <= value <= mpmath.mpf(float(around.high))


def test_slopes_are_those_of_differences() -> None:
    checked = 0
    for seed in range(200):
        _, formula, values = drawn(seed, 3)
        for name in ("b", "k"):
            try:
                slope = derivative(formula, name)
            except InputError:
                continue
            h = 1e-6
            ends = [float(evaluate(formula, {**values, name: values[name] + s * h}, NUMPY)) for s in (1, -1)]
            expected = (ends[0] - ends[1]) / (2 * h)
            assert float(evaluate(slope, values, NUMPY)) == pytest.approx(expected, rel=1e-5, abs=1e-6)
            checked += 1
    assert checked > 150


@pytest.mark.parametrize("written", ["abs(b)", "max(b, c)"])
def test_what_has_kinks_has_no_slope(written: str) -> None:
    with pytest.raises(InputError, match="has no derivative"):
        derivative(read(written), "b")


@pytest.mark.parametrize(
    "written",
    [
        "sin(2*b)", "cos(2*b)", "tan(b)", "atan(2*b)", "tanh(2*b)", "exp(2*b)", "log(b + 2)", "sqrt(b + 2)",
        "norm(b, 2, k*b)", "1/(b + 2)", "-(b^2)", "b*k*b", "b - b*k", "(b + 2)^1", "(b + 2)^2", "(b + 2)^3",
        "(b + 2)^-2", "(b + 2)^0", "(b + 2)^k", "2^b", "(b + 2)^b", "(k + 2)^(b*k)", "spline(b, -2:1, 0:3, 1:0, 2:1)",
        "spline1(2*b, -4:1, 0:3, 1:0, 2:1)", "table(k, 0:1, 1:3)*b^3", "pi*b",
    ],
)  # fmt: skip
def test_every_kind_of_part_has_the_slope_of_differences(written: str) -> None:
    formula = read(written)
    for name, b, k in (("b", 0.4, 0.7), ("b", 0.9, 0.2), ("k", 0.4, 0.7)):
        values, h = {"b": b, "k": k}, 1e-5
        ends = [float(evaluate(formula, {**values, name: values[name] + s * h}, NUMPY)) for s in (1, -1)]
        slope = float(evaluate(derivative(formula, name), values, NUMPY))
        assert slope == pytest.approx((ends[0] - ends[1]) / (2 * h), rel=1e-8, abs=1e-9)


@pytest.mark.parametrize(
    ("written", "slope"),
    [
        ("b", "1"),
        ("c", "0"),
        ("-b", "-1"),
        ("3*b", "3"),
        ("b^2", "2*b"),
        ("b^3", "3*b^2"),
        ("b + c", "1"),
        ("2*(-b)", "-2"),
        ("0*b", "0"),
        ("1*b*c", "c"),
    ],
)
def test_slopes_are_written_without_what_is_0_or_1(written: str, slope: str) -> None:
    assert str(derivative(read(written), "b")) == slope


def test_tables_and_splines_are_those_of_numpy_and_scipy() -> None:
    places, heights = (0.0, 0.2, 0.55, 0.7, 1.0), (1.0, -2.0, 0.5, 3.0, 2.0)
    pairs = ", ".join(f"{x}:{y}" for x, y in zip(places, heights, strict=True))
    k = np.linspace(0.0, 1.0, 301)
    line, spline = (read(f"{kind}(k, {pairs})") for kind in ("table", "spline"))
    assert evaluate(line, {"k": k}, NUMPY) == pytest.approx(np.interp(k, places, heights), abs=1e-14)
    expected = CubicSpline(places, heights)
    assert evaluate(spline, {"k": k}, NUMPY) == pytest.approx(expected(k), abs=1e-12)
    for order in (1, 2):
        spline = derivative(spline, "k")
        assert evaluate(spline, {"k": k}, NUMPY) == pytest.approx(expected(k, order), abs=1e-10)
    for x in np.linspace(0.01, 0.99, 30):
        for one in (line, read(f"spline(k, {pairs})")):
            value = float(evaluate(one, {"k": x}, NUMPY))
            assert abs(float(evaluate(one, {"k": arb(x)}, BALLS).mid()) - value) < 1e-13
            assert float(evaluate(one, {"k": x}, casadi_arithmetic())) == pytest.approx(value, abs=1e-13)
    # boxes of a point, in a piece, over several, and beyond the table on one side
    low, high = np.array([0.2, 0.3, 0.1, 0.6, -np.inf]), np.array([0.2, 0.4, 0.9, 1.5, 0.1])
    around = enclosed(line, {"k": Endpoints(low, high)})
    assert around.low == pytest.approx([-2.0, -2.0 + 0.25 / 0.35, -2.0, 2.0 - 0.5 / 0.3, -0.5], abs=1e-12)
    assert around.high == pytest.approx([-2.0, -2.0 + 0.5 / 0.35, 3.0, 3.0, np.inf], abs=1e-12)


def test_affine_quadratic_and_polynomial_parts_make_up_the_formula() -> None:
    numbers = Random(7)  # noqa: S311
    found = {"affine": 0, "quadratic": 0, "degree": 0}
    for seed in range(400):
        _, formula, values = drawn(seed, 3)
        expected = float(evaluate(formula, values, NUMPY))
        straight, square = affine(formula, NAMES), quadratic(formula, NAMES)
        if straight is not None:
            terms = [float(evaluate(one, values, NUMPY)) * values[name] for name, one in straight.factors]
            assert sum(terms) + float(evaluate(straight.rest, values, NUMPY)) == pytest.approx(expected, abs=1e-9)
            assert not straight.rest.names() & set(NAMES)
            found["affine"] += 1
        if square is not None:
            total = 0.0
            for names, one in square.items():
                total += float(evaluate(one, values, NUMPY)) * math.prod(values[name] for name in names)
            assert total == pytest.approx(expected, abs=1e-9)
            found["quadratic"] += 1
        known = degree(formula, {name: numbers.randint(0, 2) for name in NAMES} | {"k": 1})
        if known is not None:
            found["degree"] += 1
    assert min(found.values()) > 20


# --- Taylor arithmetic ---


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
