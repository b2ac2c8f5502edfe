"""Interpolations as controllers make them, what a drive hears of them, and bounds of their rounding."""

from functools import cache
from typing import Any

import numpy as np
import pytest
from scipy.interpolate import Akima1DInterpolator, BPoly, CubicHermiteSpline, CubicSpline

from optlaws import InputError, MotionLaw, PiecewiseMotion, catalogue, smoothstep
from tests.exports.interpolations import akima, cubic_spline, hermite, linear, sampled
from tests.exports.motions import random_motion
from tests.exports.samples import one_shot, optimal, press, shearing, turning
from tests.internals.exports import export_motion, task_sampling, travel_of_run
from tests.internals.motion import Motion, motion_of_law
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
        "clamped": (cubic_spline(x, values[0], slopes=(2.0, -1.0)), CubicSpline(x, values[0], bc_type=slopes)),
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


# --- rounding ---


FORMATS = ("csv", "rockwell-cam", "rockwell-cam-extended", "lenze", "kas")


@cache
def laws() -> tuple[MotionLaw, ...]:
    names = ("cycloidal", "modified sine", "modified trapezoid", "parabolic")
    return (optimal(), *(smoothstep(order) for order in (2, 3, 5)), *(catalogue[name].law for name in names))


def drawn(rng: np.random.Generator) -> tuple[Motion, str, dict[str, int]]:
    """A motion with its format and what is asked of it."""
    law = laws()[rng.integers(len(laws()))]
    stroke, master = float(10.0 ** rng.uniform(-1, 3)) * float(rng.choice([-1, 1])), float(10.0 ** rng.uniform(-1, 3))
    start = f"{stroke * rng.uniform(-2, 2)!r} mm"
    motion = motion_of_law(law, stroke=f"{stroke!r} mm", master=f"{master!r} deg", start=start)
    to = FORMATS[rng.integers(len(FORMATS))]
    asked = {"points": int(10.0 ** rng.uniform(0.9, 3.0))}
    if to in {"csv", "rockwell-cam", "rockwell-cam-extended"} and rng.random() < 0.7:
        asked["counts"] = int(2.0 ** rng.uniform(8, 22))
    elif to != "rockwell-cam":
        # as many that the points of the master are told apart
        asked["digits"] = int(np.ceil(-np.log10(master / asked["points"]))) + int(rng.integers(1, 5))
        asked["digits"] = max(asked["digits"], 0)
    return motion, to, asked


def breaks_the_bound(motion: Motion, to: str, asked: dict[str, int]) -> bool:
    made = export_motion(motion, to, **asked)  # type: ignore[arg-type]
    x = np.array(made.run.breaks)
    places = np.clip(x, motion.start, motion.stop)
    first, last = motion.ends(1)
    exact = cubic_spline(x, np.asarray(motion(places)), slopes=(first, last))
    added = made.run.minus(exact).peak(2).value
    noise = 1e-12 * exact.peak(0).value / float(np.diff(x).min()) ** 2
    return added > made.written.bound * (1.0 + 1e-6) + noise


def test_a_sample_keeps_the_bound() -> None:
    rng = np.random.default_rng(20)
    assert [one for one in (drawn(rng) for _ in range(25)) if breaks_the_bound(*one)] == []


@pytest.mark.long
def test_ten_thousand_keep_the_bound() -> None:
    rng = np.random.default_rng(21)
    assert [one for one in (drawn(rng) for _ in range(10_000)) if breaks_the_bound(*one)] == []


def test_the_bound_is_near() -> None:
    """Alternating errors of eps/2 reach it within a few per cent, so that no smaller rule would do."""
    x = np.linspace(0.0, 1.0, 101)
    eps = 1e-4
    y = np.asarray(smoothstep(3)(x))
    wrong = cubic_spline(x, y + 0.5 * eps * (-1.0) ** np.arange(101))
    added = wrong.minus(cubic_spline(x, y)).peak(2).value
    assert 0.9 < added / (6.0 * eps * 100.0**2) <= 1.0 + 1e-9


def test_the_rule_of_the_page() -> None:
    """With 65,536 counts a stroke of the law with C = 4.6478, 361 points may run with 3.55 C and 721 with 11.2 C."""
    for points, most in ((361, 2.55), (721, 10.2)):
        motion = motion_of_law(optimal(), stroke="1 m", duration="1 s")
        made = export_motion(motion, "csv", points=points, counts=65536)
        assert made.written.bound / motion.peak(2) == pytest.approx(most, rel=0.01)
        assert made.report.ratio(2) <= 1.001 + most


# --- a drive's task ---


def test_straight_lines_are_heard_as_in_the_table() -> None:
    """1000 ticks a stroke: 37 points are heard with 26.9 C, 361 with 2.8 C, 3601 with 1.02 C."""
    motion = motion_of_law(optimal(), stroke="1 m", duration="1 s")
    for points, ratio in ((37, 26.9), (361, 2.78), (3601, 1.0185)):
        x = np.linspace(0.0, 1.0, points)
        assert task_sampling(linear(x, motion(x)), motion, "1 ms").acceleration / motion.peak(2) == pytest.approx(
            ratio, rel=3e-3
        )


def test_smooth_runs_are_heard_as_they_are() -> None:
    made = export_motion(one_shot(), "codesys-xyva", task="10 us")
    assert made.task is not None
    assert made.task.acceleration == pytest.approx(made.report.run.peak(2), rel=1e-3)
    assert "acceleration by positions every 0.01 ms, mm/s²" in str(made)
    assert made.results()["task"] == {"seconds": made.task.seconds, "acceleration": made.task.acceleration}


@pytest.mark.parametrize("cycle", [press(), turning()])
def test_a_cycle_goes_on_with_itself(cycle: object) -> None:
    """Nothing is heard at the seam that is not in the motion: no jump by which a cycle advances or returns."""
    made = cycle.export("codesys-xyva", task="0.7 ms")  # type: ignore[attr-defined]
    assert made.task.acceleration == pytest.approx(made.report.run.peak(2), rel=0.02)


@pytest.mark.parametrize(("task", "words"), [("1 mm", "time"), ("0.1 s", "task"), ("-1 ms", "task"), ("1 ns", "task")])
def test_a_wrong_task_is_named(task: str, words: str) -> None:
    with pytest.raises(InputError, match=words):
        export_motion(one_shot(), "csv", points=20, task=task)
    with pytest.raises(InputError, match="how fast the master goes"):
        export_motion(motion_of_law(smoothstep(3), stroke="1 mm", master="90 deg"), "csv", points=20, task="1 ms")


# --- travel ---


def by_roots(motion: PiecewiseMotion) -> float:
    total = 0.0
    for low, high, row in zip(motion.breaks, motion.breaks[1:], motion.coefficients, strict=False):
        length, piece = high - low, np.polynomial.Polynomial(list(row))
        roots = [complex(root) for root in piece.deriv().roots().tolist()]
        inside = sorted(root.real for root in roots if abs(root.imag) < 1e-9 and 0.0 < root.real < length)
        total += float(np.abs(np.diff(piece(np.array([0.0, *inside, length])))).sum())
    return total


@pytest.mark.parametrize("number", range(12))
def test_a_run_travels_from_turn_to_turn(number: int) -> None:
    motion = random_motion(number, pieces=1 + number, degree=1 + number % 9)
    assert travel_of_run(motion) == pytest.approx(by_roots(motion), rel=1e-12)


@pytest.mark.parametrize("motion", [one_shot(), press().motion(), shearing().motion()])
def test_a_law_travels_as_far_as_a_run_that_is_near_it(motion: Motion) -> None:
    report = export_motion(motion, "csv", interpolation="quintic", points=400).report
    assert report.law.mean_absolute_velocity == pytest.approx(report.run.mean_absolute_velocity, rel=1e-7)
