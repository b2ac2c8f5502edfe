"""Interpolations as controllers make them: scipy's own curves, the golden spline of MCCP, the table of as-run peaks."""

from typing import Any

import numpy as np
import pytest
from scipy.interpolate import Akima1DInterpolator, BPoly, CubicHermiteSpline, CubicSpline

from optlaws import InputError, PiecewiseMotion, smoothstep
from tests.exports.interpolations import akima, cubic_spline, hermite, linear, sampled
from tests.exports.samples import optimal
from tests.tables import rows

ORDERS = {"c1": 2, "quintic": 3, "septic": 4}


def as_run(model: str, held: str, points: int) -> PiecewiseMotion:
    """The run over k of the optimal law, held as a controller holds it: REAL32 of 360 units, or 65,536 counts."""
    x, y = np.linspace(0.0, 360.0, points), optimal()(np.linspace(0.0, 1.0, points))
    if held == "single":
        x, y = x.astype(np.float32).astype(float), (360.0 * y).astype(np.float32).astype(float) / 360.0
    if held == "counts":
        y = np.rint(65536 * y) / 65536
    k = x / 360.0
    if model in ORDERS:
        return hermite(k, np.array([optimal()(k, nu) for nu in range(ORDERS[model])]))
    if model == "linear":
        return sampled(linear(k, y), 1000)
    return akima(k, y) if model == "akima" else cubic_spline(k, y)


@pytest.mark.parametrize("row", rows("as_run"), ids=lambda row: f"{row['model']}-{row['held']}-{row['points']}")
def test_the_table_of_peaks_as_run(row: dict[str, str]) -> None:
    run, constants = as_run(row["model"], row["held"], int(row["points"])), optimal().constants
    if row["model"] == "linear":  # what a task of 1000 ticks commands: second differences
        found = {"C": 1000.0 * float(np.abs(run.jumps(1)).max()) / constants.C.value}
    else:
        found = {"C": run.peak(2).value / constants.C.value, "J": run.peak(3).value / constants.J.value}
        found["jump"] = float(np.abs(run.jumps(2)).max()) / constants.C.value
    for name in ("C", "J", "jump"):
        if row[name]:
            digits = len(row[name].partition(".")[2])
            slack = 0.5 * 10.0**-digits if digits else 0.03 * float(row[name])
            assert found[name] == pytest.approx(float(row[name]), abs=max(1.01 * slack, 0.01 * (float(row[name]) > 2)))


def test_the_law_of_the_table() -> None:
    assert optimal().constants.C.value == pytest.approx(4.647776, abs=1e-6)
    assert optimal().constants.J.value == pytest.approx(124.4134, abs=1e-4)


def test_scipy_draws_the_same_curves() -> None:
    rng = np.random.default_rng(4)
    x = np.cumsum(rng.uniform(0.1, 1.0, 12))
    values = rng.normal(size=(4, 12))
    inside = np.linspace(x[0], x[-1], 300)
    slopes: Any = ((1, 2.0), (1, -1.0))
    theirs = {
        "clamped": (
            cubic_spline(x, values[0], slopes=(2.0, -1.0)),
            CubicSpline(x, values[0], bc_type=slopes),
        ),
        "natural": (cubic_spline(x, values[0], "natural"), CubicSpline(x, values[0], bc_type="natural")),
        "akima": (akima(x, values[0]), Akima1DInterpolator(x, values[0])),
        "c1": (hermite(x, values[:2]), CubicHermiteSpline(x, values[0], values[1])),
        "quintic": (hermite(x, values[:3]), BPoly.from_derivatives(x, values[:3].T)),
        "septic": (hermite(x, values), BPoly.from_derivatives(x, values.T)),
    }
    for run, other in theirs.values():
        for nu in range(3):
            expected = other(inside, nu)
            np.testing.assert_allclose(run(inside, nu), expected, rtol=1e-9, atol=1e-10 * np.abs(expected).max())


def test_a_periodic_spline_ends_where_it_begins() -> None:
    x = np.linspace(0.0, 1.0, 9)
    run = cubic_spline(x, np.cos(2 * np.pi * x).round(12), "periodic")
    assert [abs(run.seam(nu)) < 1e-12 for nu in range(3)] == [True] * 3
    with pytest.raises(InputError, match="ends at the position where it begins"):
        cubic_spline(x, x, "periodic")


def test_straight_lines_jump() -> None:
    law = smoothstep(2)
    run = linear(np.linspace(0.0, 1.0, 5), law(np.linspace(0.0, 1.0, 5)))
    assert run.peak(1).value == pytest.approx(4.0 * (law(0.5) - law(0.25)))
    assert run.degree == 1
