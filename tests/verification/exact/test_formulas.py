"""Formulas in balls: their values against mpmath, and laws of least such values not overstated."""

import copy
from dataclasses import replace
from itertools import pairwise
from typing import Any

import mpmath as mp  # type: ignore[import-untyped]
import pytest

from optlaws import (
    Chebyshev,
    Drive,
    Loads,
    Motor,
    Problem,
    at_most,
    integral,
    peak,
    rms,
    smoothstep,
    synthesize,
    toggle,
)
from optlaws.verification import verify
from tests.formulas.mpmath_numbers import MPMATH
from tests.internals.formulas import Formula, Table, evaluate, horner, of_text, pieces
from tests.internals.synthesis import evaluate as value_in_doubles
from tests.internals.verification import ExactLaw, enclosed, exact_limit
from tests.sampling import sampled
from tests.verification.problems import TABLE
from tests.verification.tampering import overstated

SPLINE = "spline(a, 0:0, 0.3:0.1, 0.6:0.5, 1:1.2)"
FORMULAS = (
    "abs(sin(4*k) - 0.5)*b + c",
    f"{TABLE}*sin(k)*b + c",
    f"{SPLINE}*2 + c",
    "exp(c/5)",
    "c/(1 + k)",
    "norm(1, b, c/20)",
    "abs(0.3 - k)*b + c",
    "max(k, 0.4)*c - b",
    "sqrt(k)*b",
    "k^2.5*c",
    "spline(1 - k, 0:0, 0.3:0.1, 0.6:0.5, 1:1.2)*c",
)
#: smoothstep(3)
HEIGHT = [0, 0, 0, 10, -15, 6]


def _derivatives(k: Any) -> dict[str, Any]:
    found, coefficients = {}, list(HEIGHT)
    for name in "abcj":
        found[name] = horner(coefficients, k)
        coefficients = [i * value for i, value in enumerate(coefficients)][1:]
    return found


def _table(table: Table, at: Any) -> Any:
    row = max((i for i, x in enumerate(table.places[:-1]) if at >= x), default=0)
    return horner([mp.mpf(value) for value in pieces(table)[row].tolist()], at - table.places[row])


def along(formula: Formula, k: Any) -> Any:
    """The value of a formula along smoothstep(3)."""
    return evaluate(formula, {**_derivatives(k), "k": k}, replace(MPMATH, table=_table))


def places(text: str) -> list[Any]:
    """Between these k the formulas above are smooth along smoothstep(3)."""
    crossings = [mp.findroot(lambda k, a=a: _derivatives(k)["a"] - a, 0.5) for a in (0.3, 0.6)] if "(a" in text else []
    kinks = [*of_text(text).kinks, *([mp.asin(0.5) / 4, (mp.pi - mp.asin(0.5)) / 4] if "sin(4" in text else [])]
    return [mp.mpf(0), *sorted([*map(mp.mpf, kinks), *crossings]), mp.mpf(1)]


@pytest.mark.parametrize("text", sampled(FORMULAS, each=2))
def test_integrals_hold_those_of_mpmath(text: str) -> None:
    formula = of_text(text).formula
    with mp.workdps(30):
        parts = [mp.quad(lambda k: along(formula, k), list(ends)) for ends in pairwise(places(text))]
        expected = sum(parts)
    found = ExactLaw(smoothstep(3)).term(integral(text))
    assert float(found.rad()) < 1e-17
    assert abs(float(found.mid()) - expected) < 1e-15


@pytest.mark.parametrize("text", sampled(FORMULAS, each=3))
def test_peaks_hold_the_values_of_mpmath(text: str) -> None:
    with mp.workdps(30):
        values = [along(of_text(text).formula, mp.mpf(i) / 400) for i in range(401)]
    found = ExactLaw(smoothstep(3)).term(peak(text, side="high"))
    assert float(found.rad()) < 1e-15
    greatest = float(max(values))
    assert greatest - 1e-14 <= float(found.mid()) < greatest + 2e-2 * abs(greatest)


@pytest.mark.parametrize(
    "minimise",
    sampled(["rms(sin(3*k)*b + c)", "integral(exp(c/5))", f"rms({TABLE}*exp(k)*c)", "integral(max(c^2, 9*b^2))"], 4),
)
def test_what_is_overstated_is_refused(minimise: str) -> None:
    data = synthesize(Problem(B=1.9, order=3, basis=Chebyshev(5), minimise=minimise)).to_dict()
    true = verify(data)
    assert true.proven
    for turned in (1.0 + 1e-3, 0.0, -1.0):
        tampered: dict[str, Any] = copy.deepcopy(data)
        contact = next(one for one in tampered["certificate"]["contacts"] if one["direction"])
        contact["direction"] = [turned * value if i % 2 else value for i, value in enumerate(contact["direction"])]
        assert overstated(tampered, true) == []
        tampered["lower_bound"] = tampered["objective"] = data["objective"] * (1 + 1e-6)
        assert not verify(tampered).proven
    contact["direction"] = contact["direction"][:-1]
    assert overstated(tampered, true) == []


@pytest.mark.parametrize("minimise", ["rms(max(c, 0))", "rms(abs(c) + abs(b))", "integral(max(c + 3*a - 2, 0)^2)"])
def test_a_bound_without_exact_rows_is_recomputed_in_doubles(minimise: str) -> None:
    problem = Problem(B=1.8, order=4, basis=Chebyshev(5), C=at_most(6.0), minimise=minimise)
    data = synthesize(problem).to_dict()
    checked = verify(data)
    assert checked.proven
    assert checked.bound is checked.gap is None
    assert [(claim.name, "no exact rows" in claim.detail) for claim in checked.unchecked] == [("sum of the rows", True)]
    assert {"the lower bound", "the gap", "optimal"} <= {claim.name for claim in checked.recomputed}
    alone = verify(data["certificate"])
    assert alone.proven
    assert [claim.name for claim in alone.recomputed] == ["the certificate's bound"]
    assert not verify(data | {"lower_bound": data["objective"] * (1.0 + 1e-6)}).proven
    data["certificate"]["bound"] = data["objective"] * (1.0 + 1e-6)
    assert not verify(data["certificate"]).proven


def test_a_peak_below_0_lets_no_limit_of_c_stand_for_the_sum() -> None:
    assert exact_limit(Problem(order=3, minimise='C + peak("b", side=high)')) == 4
    assert exact_limit(Problem(order=3, minimise='C + peak("b - 20", side=high)')) is None


def test_an_integral_is_enclosed_to_the_last_digits_of_a_float() -> None:
    """Tables over the displacement have corners that no law places: cells are cut there until they hardly matter."""
    load = "table(a, 0:0, 0.2:0, 0.3:-2, 0.5:-2, 0.6:0, 1:0)"
    law, problem = smoothstep(3), Problem(order=3, minimise=f"integral((c + {load})^2)", symmetric=False)
    low, high = enclosed(ExactLaw(law).sum(problem.objective))
    assert 0.0 <= high - low <= 8.0 * 2.0**-52 * high
    assert low * (1.0 - 1e-10) <= value_in_doubles(problem, law).objective <= high * (1.0 + 1e-10)


def test_long_torques_with_losses_are_enclosed_as_short_ones() -> None:
    """Where the direction of the power changes the torque has a kink, which is found however often x is in it."""
    lengths = {"crank": "60 mm", "rod": "250 mm", "upper": "200 mm", "lower": "200 mm", "frame": "280 mm"}
    press = toggle(lengths, bodies={"crank": "0.5 kg m^2", "ram": "12 kg"}, loads=Loads("-600 N"))
    drive = Drive(press, Motor("1e-3 kg m^2"), ratio=10, efficiency=0.95)
    moved = drive.dimensionless("0 deg", "360 deg", "0.5 s")
    law = smoothstep(3)
    for constant in (rms(moved.torque), peak(moved.torque, side="high"), peak(moved.branches[-1])):
        value = ExactLaw(law).term(constant)
        assert float(value.rad()) < 1e-15
        assert float(value) == pytest.approx(constant.value(law), rel=1e-12)
