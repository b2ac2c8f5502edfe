"""Constants, coefficients and peaks of standard laws as others print them."""

from collections.abc import Callable
from math import pi
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose
from numpy.typing import NDArray

from optlaws import Cycle, Dwell, Return, Rise, catalogue
from tests.external.published import cases, numbers

Array = NDArray[np.float64]


@pytest.mark.parametrize("case", cases("constants"))
def test_constants_in_tables_of_others(case: dict[str, Any]) -> None:
    constants = catalogue[case["law"]].law.constants
    for name in "BCDJ":
        # the jerk of a law with impulses is that of its print without them
        if name in case and np.isfinite(getattr(constants, name).value):
            assert getattr(constants, name).value == pytest.approx(case[name], rel=case["rtol"]), name
    if "rms_c" in case:
        assert constants.rms_c == pytest.approx(case["rms_c"], rel=case["rtol"])


def test_peaks_of_the_polynomial_of_least_jerk() -> None:
    case, law = numbers()["minimum_jerk"], catalogue["3-4-5"].law
    assert law.constants.B.value == pytest.approx(case["B"], rel=1e-14)
    assert law.constants.C.value == pytest.approx(case["C"], abs=5e-3)
    assert law.constants.C.k == pytest.approx((3 - 3**0.5) / 6, abs=1e-12)
    assert law.constants.J.value == pytest.approx(case["J"], rel=1e-14)
    assert law.j(0.5) == pytest.approx(case["middle"], rel=1e-13)


@pytest.mark.parametrize("case", cases("exercise"), ids=lambda case: f"{case['law']} {case['stroke']}")
def test_exercises_of_textbooks(case: dict[str, Any]) -> None:
    """Rise, dwell and return by one law, with the peaks of both moves as printed; m/s, m/s²."""
    (rise, fall), law, stroke = case["angles"], case["law"], case["stroke"]
    moves = [Rise(stroke, rise, law=law), Dwell("30 deg"), Return(stroke, fall, law=law), Dwell()]
    peaks = Cycle(moves, speed=case["speed"]).peaks
    assert_allclose([peaks[0].peak(2), peaks[2].peak(2)], case["accelerations"], rtol=1e-3)
    if "velocities" in case:
        assert_allclose([peaks[0].peak(1), peaks[2].peak(1)], case["velocities"], atol=7e-3)


def _sine(x: Array) -> Array:
    early = 0.43990085 * x - 0.0350062 * np.sin(4 * pi * x)
    later = 0.28004957 + 0.43990085 * x - 0.31505577 * np.cos(4 * pi * x / 3 - pi / 6)
    return np.where(x <= 1 / 8, early, later)


def _trapezoid(x: Array) -> Array:
    early = 0.38898448 * x - 0.0309544 * np.sin(4 * pi * x)
    plateau = 2.44406184 * x**2 - 0.22203097 * x + 0.00723407
    later = 1.6110154 * x - 0.0309544 * np.sin(4 * pi * x - pi) - 0.3055077
    return np.select([x <= 1 / 8, x <= 3 / 8], [early, plateau], later)


@pytest.mark.parametrize(
    ("name", "theirs", "stop"), [("modified sine", _sine, 7 / 8), ("modified trapezoid", _trapezoid, 1 / 2)]
)
def test_coefficients_of_saltire(name: str, theirs: Callable[[Array], Array], stop: float) -> None:
    """The page saltire.com/CamDesign/Cam%20Functions.html, to the eight digits that it prints."""
    places = np.linspace(0.0, stop, 201)
    assert_allclose(catalogue[name].law(places), theirs(places), atol=2e-8)
