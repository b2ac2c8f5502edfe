"""Executive laws made for their loaders: other methods, limits, proofs by tangents, what is refused."""

from dataclasses import replace
from functools import cache
from math import inf, pi, sqrt
from typing import Any

import casadi as ca
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

from optlaws import (
    BalancedLaw,
    Chebyshev,
    Contact,
    InfeasibleProblem,
    InputError,
    MotionLaw,
    Pieces,
    Problem,
    balanced_law,
    catalogue,
    inertial_loader,
    smoothstep,
    synthesize,
)
from tests.internals.balancing import (
    B_loader,
    C_loader,
    D_loader,
    loader_acceleration_limit,
    loader_power_limit,
    loader_velocity_limit,
)
from tests.internals.synthesis import EnergyFamily, model_of, relaxed, row_of

CODES = ("K", "Co", "3-4-5 polynomial", "0510", "0307(1,5)", "0317(1,5)", "KC00", "KC05", "0040", "0000")
MODEL = model_of(Problem(B=1.7, order=3, minimise="B_loader", monotone=True))


@cache
def gentle() -> BalancedLaw:
    return balanced_law(1.875, order=3, basis=Chebyshev(9))


def powers(B: float, order: int, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Symmetric velocities (1-t²)^(l-1) (h0 + h1 t² + ...) in another basis: those with stroke 1 and b(1/2) = B."""
    rows = np.zeros((2, count))
    for i in range(count):
        rows[0, i] = quad(lambda t, i=i: (1 - t * t) ** (order - 1) * t ** (2 * i), 0, 1)[0]
    rows[1, 0] = 1.0
    right = np.array([1.0, B])
    base = np.linalg.lstsq(rows, right, rcond=None)[0]
    return base, np.linalg.svd(rows)[2][2:].T


def on_grid(h: Any, k: np.ndarray, order: int) -> tuple[Any, Any]:
    """b and c at places k, from the powers."""
    t = 1 - 2 * k
    w = (1 - t * t) ** (order - 1)
    dw = (order - 1) * (1 - t * t) ** (order - 2) * (-2 * t)
    i = np.arange(h.shape[0])
    P = t[:, None] ** (2 * i)
    dP = np.where(i > 0, 2 * i * t[:, None] ** np.maximum(2 * i - 1, 0), 0.0)
    return (w[:, None] * P) @ h, -2 * (dw[:, None] * P + w[:, None] * dP) @ h


@pytest.mark.sample(2)
@pytest.mark.parametrize(
    ("B", "order", "minimise"), [(1.875, 3, "C_loader"), (1.6, 2, "C_loader"), (1.7, 3, "D_loader")]
)
def test_least_values_by_ipopt_on_a_grid(B: float, order: int, minimise: str) -> None:
    # Z of degree 5 leaves b three powers of t² more than the base law's one
    base, free = powers(B, order, 4)
    y, s = ca.SX.sym("y", free.shape[1]), ca.SX.sym("s")
    h = base + ca.mtimes(ca.DM(free), y)
    k = (np.arange(600) + 0.5) / 1200
    b, c = on_grid(h, k, order)
    root = ca.sqrt(B * B - b * b)
    size = 0.5 / (ca.sum1(root) / 1200)
    # the sum of h is b over the base law's at k = 0
    value = size * b * c / root if minimise == "C_loader" else size**2 * b * c
    rows = ca.vertcat(s - value, s + value, b, ca.sum1(h))
    solver = ca.nlpsol(
        "s",
        "ipopt",
        {"x": ca.vertcat(y, s), "f": s, "g": rows},
        {"ipopt.print_level": 0, "print_time": False, "ipopt.sb": "yes", "ipopt.tol": 1e-10},
    )
    start = synthesize(Problem(B=B, order=order, basis=Chebyshev(5), monotone=True)).law
    h0 = np.linalg.lstsq(on_grid(np.eye(4), k, order)[0], start.b(k), rcond=None)[0]
    found = solver(x0=np.append(free.T @ (h0 - base), 6.0), lbg=0.0, ubg=inf)
    least = balanced_law(B, order=order, basis=Chebyshev(5), minimise=minimise).objective
    assert float(found["f"]) == pytest.approx(least, rel=2e-5)


def test_what_is_returned_holds_on_the_whole_interval() -> None:
    k = np.linspace(0.0, 1.0, 20001)
    law, one = gentle().law, gentle().loader
    assert np.abs(one.law.d(k) + one.Y**2 * law.d(k)).max() < 1e-11
    assert np.abs(one.law.b(k) ** 2 + one.Y**2 * law.b(k) ** 2 - (one.Y * 1.875) ** 2).max() < 1e-12
    assert law.b(k).min() > -1e-9
    assert law.b(k).max() <= 1.875 * (1 + 1e-12)
    assert np.abs(one.law.c(k)).max() == pytest.approx(gentle().objective, rel=1e-6)
    assert np.abs(one.law.c(k)).max() <= gentle().objective * (1 + 1e-12)
    assert quad(lambda one: abs(gentle().loader.law.b(one)), 0.0, 1.0, points=[0.5])[0] == pytest.approx(1.0, abs=1e-9)


def test_more_freedom_is_no_worse_and_comes_near_the_limit() -> None:
    limit = loader_acceleration_limit(1.5)
    found = [balanced_law(1.5, order=2, basis=Chebyshev(n)).objective for n in (3, 5, 9)]
    assert found == sorted(found, reverse=True)
    assert limit < found[-1] < 1.03 * limit
    assert all(one > limit for one in found)


def test_a_bound_on_the_executive_acceleration_is_kept() -> None:
    law = smoothstep(3)
    own = law.constants.C.value
    found = balanced_law(1.875, order=3, basis=Chebyshev(9), most_C=own)
    assert found.law.constants.C.value <= own * (1 + 1e-9)
    assert gentle().objective < found.objective < 0.97 * inertial_loader(law).C
    mixed = balanced_law(1.875, order=3, basis=Chebyshev(9), minimise="0.5*C/4 + 0.5*C_loader/4")
    C, C_l = mixed.law.constants.C.value, mixed.loader.C
    assert mixed.objective == pytest.approx(0.125 * (C + C_l), rel=1e-12)
    assert mixed.objective < 0.125 * (found.law.constants.C.value + found.loader.C)
    assert mixed.objective < 0.125 * (gentle().law.constants.C.value + gentle().loader.C)


@pytest.mark.parametrize("B", [1.02, 1.15, 1.25, 4 / pi, 1.5, 2.0, 2.6])
def test_the_limits_belong_to_motions_that_exist(B: float) -> None:
    """Slope, even run, slope: the profile of the proof has its swing, its energy and its peak."""
    limit = loader_acceleration_limit(B)
    if 4 / pi <= B:
        rate, level = pi * B / 2, 1.0
    else:
        angles = np.linspace(np.arcsin(1 / B), pi / 2, 400001)[1:]
        rates = (2 * np.sin(angles) - pi / 2) / (np.sin(angles) - 1 / B)
        peaks = rates**2 / (1 + np.cos(angles) * (rates - 2))
        best = int(np.argmin(peaks))
        assert peaks[best] == pytest.approx(limit, rel=1e-8)
        rate, level = float(rates[best]), float(np.cos(angles[best]))
    turns = sorted({min((1 - level) / rate, 0.5), 0.5 - level / rate})

    def share(k: float) -> float:
        return max(1 - rate * k, min(level, rate * (0.5 - k)))

    swing = quad(share, 0.0, 0.5, points=turns, epsabs=1e-12)[0]
    stroke = quad(lambda k: sqrt(max(1 - share(k) ** 2, 0.0)), 0.0, 0.5, points=turns, epsabs=1e-12)[0]
    assert B * stroke == pytest.approx(0.5, abs=1e-7)
    assert rate / (2 * swing) == pytest.approx(limit, rel=1e-7)


@pytest.mark.parametrize("B", [1.05, 1.2, 1.4, 1.5, 1.875, 2.6])
def test_the_power_limit_belongs_to_motions_that_exist(B: float) -> None:
    """Constant power, even run, constant power: the profile of the proof has its stroke, its energy and its peak."""
    limit = loader_power_limit(B)
    if B >= 1.5:
        rate, level = 4.0 * B / 3.0, 0.0
    else:
        angles = np.linspace(np.arcsin(1 / B), pi / 2, 400001)[1:]
        rates = (2 * np.sin(angles) - 4 / 3) / (np.sin(angles) - 1 / B)
        peaks = 0.5 * rates**3 / (4 / 3 + (rates - 2) * np.cos(angles)) ** 2
        best = int(np.argmin(peaks))
        rate, level = float(rates[best]), float(np.sin(angles[best]) ** 2)
        assert peaks[best] == pytest.approx(limit, rel=1e-7)
    turns = sorted({level / rate, 0.5 - (1 - level) / rate})

    def share(k: float) -> float:
        return max(min(rate * k, level), 1 - rate * (0.5 - k), 0.0)

    stroke = quad(lambda k: sqrt(share(k)), 0.0, 0.5, points=turns, epsabs=1e-12)[0]
    swing = quad(lambda k: sqrt(max(1 - share(k), 0.0)), 0.0, 0.5, points=turns, epsabs=1e-12)[0]
    assert B * stroke == pytest.approx(0.5, abs=1e-6)
    assert rate / (8 * swing**2) == pytest.approx(limit, rel=1e-6)


@pytest.mark.sample(2)
@pytest.mark.parametrize(("minimise", "order"), [("C_loader", 2), ("D_loader", 3), ("0.5*C/4 + 0.5*C_loader/4", 3)])
def test_the_best_law_is_proven_on_request(minimise: str, order: int) -> None:
    quick, tight = (
        balanced_law(1.6, order=order, basis=Chebyshev(7), minimise=minimise, bound=bound)
        for bound in ("quick", "tight")
    )
    assert (quick.status.value, tight.status.value) == ("local", "optimal")
    assert quick.objective == pytest.approx(tight.objective, rel=1e-9)
    assert quick.lower_bound < tight.lower_bound <= tight.objective
    assert tight.solution is not None
    assert tight.solution.power_certificate is not None
    assert tight.solution.power_certificate.bound == tight.lower_bound


@cache
def corners() -> np.ndarray:
    """Laws with B = 1.7 at the corners, as it were, of all those."""
    least = [
        synthesize(Problem(B=1.7, order=3, minimise=name, monotone=True)).law for name in ("C", "rms_c", "J", "C + J")
    ]
    own = [balanced_law(1.7, order=3, minimise=name).law for name in ("C_loader", "B_loader")]
    return np.array([coordinates(law) for law in (*least, *own)])


def coordinates(law: MotionLaw) -> np.ndarray:
    """Those of a law of the model, from its velocity at some places."""
    family = MODEL.space.derivative(1, "b", np.zeros(MODEL.space.terms))
    u = np.linspace(0.0, 1.0, 41)
    columns = family.columns(u)[0]
    return np.asarray(np.linalg.lstsq(columns[:, :-1], law.b(family.k(u)) - columns[:, -1])[0])


SHARES = st.lists(st.floats(0.01, 1.0), min_size=6, max_size=6)


def mixed(shares: list[float]) -> np.ndarray:
    """A law between the corners: the laws with 0 <= b <= B are a convex set."""
    return np.asarray(np.array(shares) @ corners() / sum(shares))


@pytest.mark.long
@settings(max_examples=15)
@given(SHARES, SHARES)
def test_no_law_is_below_a_limit_or_a_tangent(first: list[float], second: list[float]) -> None:
    x = mixed(first)
    balanced = inertial_loader(MODEL.space.law(x))
    assert loader_acceleration_limit(1.7) < balanced.C
    assert loader_velocity_limit(1.7) < balanced.B
    assert loader_power_limit(1.7) < balanced.D
    program = relaxed(MODEL.problem, 0.0).program
    row, right = row_of(program, Contact("B_loader", 1.0, 0.0, 1.0, tuple(mixed(second).tolist())))
    assert row @ np.append(x, balanced.B) <= right


@pytest.mark.sample(2)
@pytest.mark.parametrize("name", CODES)
def test_printed_laws_are_above_the_limits(name: str) -> None:
    balanced = inertial_loader(catalogue[name].law)
    B = balanced.executive.constants.B.value
    assert loader_acceleration_limit(B) < balanced.C
    assert loader_velocity_limit(B) < balanced.B


def test_the_law_of_constant_acceleration_of_the_loader_attains_its_limit() -> None:
    """At B = 4/pi the loader may slow down evenly: b of the executive is then a quarter of an ellipse."""
    B = 4 / pi
    assert quad(lambda k: B * sqrt(1 - (1 - 2 * k) ** 2), 0.0, 0.5)[0] == pytest.approx(0.5, abs=1e-12)
    assert loader_acceleration_limit(B) == pytest.approx(4.0, abs=1e-12)


@settings(max_examples=10)
@given(SHARES)
def test_rows_know_the_loader(shares: list[float]) -> None:
    x = mixed(shares)
    law = MODEL.space.law(x)
    one, k = inertial_loader(law), 0.5 * (1.0 - np.linspace(0.05, 1.0, 20))
    expected = {B_loader: np.full(20, one.B), C_loader: -one.law.c(k), D_loader: -one.law.d(k)}
    for constant, values in expected.items():
        (family,) = constant.families(MODEL.space, np.zeros(len(x)), 0.0)
        assert isinstance(family, EnergyFamily)
        assert np.abs(family.value(x, family.u(k)) - values).max() < 1e-8 * np.abs(values).max()
        assert family.energy.value(x) == pytest.approx(0.5 / one.Y, rel=1e-10)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"B": 1.0}, "B must be above 1"),
        ({"B": float("nan")}, "B must be"),
        ({"order": 1}, "order must be at least 2"),
        ({"basis": Pieces(4)}, "basis must be one of polynomials"),
        ({"basis": Chebyshev(2)}, "degree of Z must be at least 3"),
        ({"minimise": "C"}, "C alone has no loader"),
        ({"minimise": "D"}, "known are|constant"),
        ({"minimise": "C_loder"}, "C_loader"),
        ({"minimise": "max(C, C_loader)"}, "sum of"),
        ({"minimise": 3}, "minimise must be"),
        ({"most_C": -1.0}, "most_C must be above 0"),
    ],
)
def test_what_is_refused(given: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        balanced_law(**{"B": 1.8, "order": 3} | given)


def test_no_law_has_so_small_an_acceleration() -> None:
    with pytest.raises(InfeasibleProblem):
        balanced_law(1.8, order=3, most_C=4.2)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"B": None}, "give B as a number above 1, or inflexion=0.5"),
        ({"symmetric": False}, "leave symmetric=True"),
        ({"basis": Pieces(4)}, "needs symmetric laws from rest to rest.*Chebyshev"),
        ({"order": 1}, "needs symmetric laws from rest to rest, order at least 2"),
    ],
)
def test_the_general_engine_says_what_has_a_loader(given: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        synthesize(replace(Problem(B=1.8, order=3, minimise="C_loader"), **given))


@pytest.mark.parametrize("least", ["C_loader", "D_loader"])
def test_a_bound_that_tells_nothing_is_not_shown_as_one(least: str) -> None:
    solution = synthesize(Problem(B=1.875, order=3, basis=Chebyshev(3), minimise=least))
    rows = {row.name: row.text(6) for row in solution.summary()}
    assert rows["lower bound"] == "none above 0 is known"
    bounded = synthesize(Problem(B=1.875, order=3, basis=Chebyshev(3), minimise=least, monotone=True))
    assert {row.name: row.text(6) for row in bounded.summary()}["lower bound"] == f"{bounded.lower_bound:.6g}"
    assert bounded.lower_bound > 0.0
