"""Slopes of formulas whose factors of the position are read from tables, against derivatives evaluated as they are."""

import numpy as np
import pytest
from numpy.typing import NDArray

from optlaws import drive_torque, four_bar, slider_crank
from tests.internals.formulas import NUMPY, derivative, evaluate, read
from tests.internals.synthesis import Slopes, tabulated

Array = NDArray[np.float64]

CRANK = slider_crank("0.1 m", "0.4 m", bodies={"crank": "0.02 kg m^2", "slider": "5 kg"})
LINKAGE = four_bar("0.1 m", "0.3 m", "0.25 m", "0.35 m", bodies={"crank": "0.005 kg m^2", "rocker": "0.05 kg m^2"})
TORQUES = {
    "slider-crank": CRANK.dimensionless("0 deg", "180 deg", "0.3 s").torque,
    "four-bar": LINKAGE.dimensionless("20 deg", "160 deg", "0.3 s").torque,
    "spline": drive_torque(inertia="spline(a, 0:1, 0.3:1.6, 0.7:1.2, 1:2)", load="2*sin(3*a)^2"),
}
NAMES = ("a", "b", "c", "k")


def places(low: float, high: float) -> dict[str, Array]:
    numbers = np.random.default_rng(5)
    a = numbers.uniform(low, high, 40)
    return {"a": a, "b": numbers.normal(size=40), "c": 3.0 * numbers.normal(size=40), "k": numbers.uniform(size=40)}


@pytest.mark.sample(2)
@pytest.mark.parametrize("name", TORQUES)
@pytest.mark.parametrize("wrapped", ["{}", "({})^2", "({})*b + sin(a)*b"])
def test_tables_say_what_formulas_say(name: str, wrapped: str) -> None:
    formula, at = read(wrapped.format(TORQUES[name])), places(0.0, 1.0)
    assert tabulated((formula,))[1] is not None
    slopes = Slopes(formula, NAMES)
    first = [derivative(formula, name) for name in NAMES]
    known = [evaluate(slope, at, NUMPY) for slope in first]
    bends = [[evaluate(derivative(slope, other), at, NUMPY) for other in NAMES] for slope in first]
    value, gradient = slopes.value_and_gradient(at)
    assert value == pytest.approx(evaluate(formula, at, NUMPY), rel=1e-12, abs=1e-12)
    assert np.array_equal(value, slopes.value(at))
    assert np.array_equal(gradient, slopes.gradient(at))
    hessian = slopes.hessian(at)
    for i in range(len(NAMES)):
        assert gradient[i] == pytest.approx(np.broadcast_to(known[i], 40), rel=1e-11, abs=1e-11)
        for j in range(len(NAMES)):
            assert hessian[i, j] == pytest.approx(np.broadcast_to(bends[i][j], 40), rel=1e-9, abs=1e-9)


def test_beyond_the_tables_formulas_go_on() -> None:
    formula, at = read(TORQUES["slider-crank"]), places(-0.6, 1.6)
    slopes = Slopes(formula, NAMES)
    assert slopes.value(at) == pytest.approx(evaluate(formula, at, NUMPY), rel=1e-13, abs=1e-13)
    assert slopes.gradient(at)[0] == pytest.approx(evaluate(derivative(formula, "a"), at, NUMPY), rel=1e-12, abs=1e-12)


def test_what_is_short_or_has_kinks_stays() -> None:
    for text in ("(1 + 0.6*a^2)*c + 3*a", "table(a, 0:1, 0.5:2, 1:1)*c", "sin(k)*cos(2*k)*exp(-k)*c + b"):
        assert tabulated((read(text),)) == ((read(text),), None)
    [formula], _ = tabulated((read("abs(sin(a)*cos(2*a) + exp(-a) - 0.5*a)*c"),))
    assert str(formula) == "abs(a0)*c"


def test_what_has_no_values_beyond_the_stroke_is_tabulated_on_it() -> None:
    formula = read("(2 + sqrt(a*(1 - a) + 0.1)*exp(sin(a)))*c + b^2")
    _, tables = tabulated((formula,))
    assert tables is not None
    assert tables.edges[[0, -1]].tolist() == [0.0, 1.0]
