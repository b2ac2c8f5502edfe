"""The inertial loader: closed forms, reference tables, exchange of energy, and its trapezium substitute."""

import json
from math import asinh, inf, isfinite, pi, sqrt

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

from optlaws import (
    InputError,
    Loader,
    MotionLaw,
    PiecewiseLaw,
    PolynomialLaw,
    TrapeziumSubstitute,
    catalogue,
    inertial_loader,
    mirrored_law,
    reversed_law,
    smoothstep,
)
from tests.internals.balancing import closed_form_Y
from tests.internals.laws import PolynomialSegment, PowerSegment
from tests.laws.examples import free_function_law, random_law
from tests.sampling import examples
from tests.tables import rows

TABLE = rows("loader_table12")
K = np.linspace(0.0, 1.0, 501)


def coded(code: str) -> MotionLaw:
    return catalogue["3-4-5 polynomial" if code == "Shun" else code].law


def energy_error(one: Loader) -> float:
    """Greatest departure of b_l² + Y² b² from its constant value, relative to it."""
    whole = (one.Y * one.executive.peak(1).value) ** 2
    return float(np.abs(one.law.b(K) ** 2 + one.Y**2 * one.executive.b(K) ** 2 - whole).max()) / whole


@pytest.mark.parametrize(
    ("name", "Y"),
    [("K", 1.0), ("Co", pi / 2 / (sqrt(2) + asinh(1))), ("0050", 2 / pi), ("0000", 2 / (2 * sqrt(2) - 1))],
)
def test_energy_parameters_in_closed_form(name: str, Y: float) -> None:
    assert pytest.approx(Y, abs=1e-12) == inertial_loader(coded(name)).Y


@pytest.mark.parametrize(("name", "D"), [("Co", 1.5 * sqrt(3) * pi), ("0000", 2 * sqrt(3))])
def test_powers_in_closed_form(name: str, D: float) -> None:
    balanced = inertial_loader(coded(name))
    assert pytest.approx(balanced.Y**2 * D, rel=1e-12) == balanced.D


def test_the_loader_of_a_harmonic_law_is_harmonic() -> None:
    law = inertial_loader(coded("K")).law
    for nu, expected in enumerate(
        [np.sin(pi * K) / 2, pi / 2 * np.cos(pi * K), -(pi**2) / 2 * np.sin(pi * K), -(pi**3) / 2 * np.cos(pi * K)]
    ):
        assert np.abs(law(K, nu) - expected).max() < 1e-13 * pi**nu


@pytest.mark.sample(2)
@pytest.mark.parametrize("row", TABLE, ids=[row["code"] for row in TABLE])
def test_the_table_of_twelve_laws(row: dict[str, str]) -> None:
    balanced = inertial_loader(coded(row["code"]))
    peaks = balanced.executive.constants
    found = {
        "B": peaks.B.value,
        "C": peaks.C.value,
        "D": peaks.D.value,
        "Y_exact": balanced.Y,
        "Bbcm_exact": balanced.B,
        "Cbcm_exact_max": balanced.C,
        "Dbcm_exact": balanced.D,
        "Cbcm_formula_j05": balanced.C_at_turn,
    }
    for name, value in found.items():
        assert value == pytest.approx(float(row[name]), rel=1e-8, abs=1e-12), name
    if isfinite(balanced.C):
        assert balanced.law.peak(2).k == pytest.approx(float(row["k_of_Cbcm"]), abs=1e-7)
    assert balanced.peaks_at_turn == (row["k_of_Cbcm"] == "0.5")


@pytest.mark.sample(2)
@pytest.mark.parametrize("name", [row["code"] for row in TABLE])
def test_the_law_integrates_its_own_derivatives(name: str) -> None:
    law = inertial_loader(coded(name)).law
    nodes, weights = np.polynomial.legendre.leggauss(40)
    turn = 0.5
    for start, end in zip(law.breaks, law.breaks[1:], strict=False):
        if turn in (start, end):
            # from the far end: k = turn ± s^8, in which fractional powers are smooth
            reach = (end - start) ** 0.125
            s = 0.5 * reach * (nodes + 1.0)
            k, factor = (turn - s**8 if end == turn else turn + s**8), 0.5 * reach * weights * 8.0 * s**7
        else:
            k, factor = start + 0.5 * (end - start) * (nodes + 1.0), 0.5 * (end - start) * weights
        assert law(end) - law(start) == pytest.approx(float(factor @ law.b(k)), abs=1e-13)
        last = 0.0 if end == turn else law.b(np.nextafter(end, start))
        if isfinite(law.peak(2).value):
            assert last - law.b(start) == pytest.approx(float(factor @ law.c(k)), abs=1e-12)


def test_the_turn_is_smooth_and_signed() -> None:
    law = inertial_loader(coded("Co")).law
    near = 0.5 + np.array([-1e-9, 0.0, 1e-9])
    assert law.b(near) == pytest.approx(np.array([1e-9, 0.0, -1e-9]) * -law.c(0.5), rel=1e-6, abs=1e-20)
    assert law.c(near) == pytest.approx(np.full(3, -law.peak(2).value), rel=1e-9)
    assert law.continuity >= 4


def test_acceleration_without_bound_is_said_to_be_so() -> None:
    balanced = inertial_loader(coded("0050"))
    assert (balanced.C, balanced.C_at_turn, balanced.law.c(0.5), balanced.law.constants.rms_c) == (inf, inf, -inf, inf)
    assert balanced.law.d(0.5) == pytest.approx(-(balanced.Y**2) * balanced.executive.d(0.5), rel=1e-14)
    assert json.loads(json.dumps(balanced.to_dict()))["constants"]["C"] == {"value": None, "k": 0.5}


def test_a_stretch_of_uniform_velocity_is_a_standstill() -> None:
    balanced = inertial_loader(catalogue["trapezoidal velocity in thirds"].law)
    assert (balanced.turn, balanced.law.a(0.6)) == pytest.approx((1 / 3, 0.5), rel=1e-13)
    assert balanced.law.b([0.34, 0.5, 0.66]).tolist() == balanced.law.c([0.34, 0.5, 0.66]).tolist() == [0.0, 0.0, 0.0]
    assert energy_error(balanced) < 1e-14


def test_constant_power_is_exchanged_for_constant_power() -> None:
    balanced = inertial_loader(PiecewiseLaw([0, 0.5, 1], [PowerSegment(0.0, 1.5), PowerSegment(1.5, 0.0)]))
    assert balanced.law.d(K[1:250]) == pytest.approx(np.full(249, -balanced.D), rel=1e-13)
    assert pytest.approx(1.0, rel=1e-14) == balanced.Y


def test_several_tops_reverse_the_loader_at_each() -> None:
    # b = 1 - (k - 1/5)² (k - 1/2)² (k - 4/5)² touches its peak three times
    touching = np.polynomial.Polynomial.fromroots([0.2, 0.5, 0.8]) ** 2
    law = PolynomialLaw.from_powers((1.0 - 100.0 * touching).integ().coef)
    balanced = inertial_loader(law)
    assert np.sign(balanced.law.b([0.1, 0.3, 0.6, 0.9])).tolist() == [1.0, -1.0, 1.0, -1.0]
    assert balanced.law.jumps(2) == ()
    assert energy_error(balanced) < 1e-13
    assert balanced.law.a(0.5) == pytest.approx(0.5, abs=1e-13)
    two = np.polynomial.Polynomial.fromroots([0.3, 0.7]) ** 2
    with pytest.raises(InputError, match=r"odd number of times.*0\.3, 0\.7"):
        inertial_loader(PolynomialLaw.from_powers((1.0 - 10.0 * two).integ().coef))


@pytest.mark.parametrize(
    ("law", "reason"),
    [
        (smoothstep(1), "inside the motion.*0 to 1"),
        (PolynomialLaw([]), "must move"),
        (PolynomialLaw.from_powers([0, 0, 1]), "inside the motion.*k = 1"),
        (catalogue["K"].law.to_dict(), "MotionLaw"),
        (inertial_loader(smoothstep(3)).law, "inside the motion"),
        (PiecewiseLaw([0, 0.5, 1], [PolynomialSegment((2.0,)), PolynomialSegment((), b0=1.0)]), "inside the motion"),
    ],
)
def test_what_has_no_loader_is_refused(law: MotionLaw, reason: str) -> None:
    with pytest.raises(InputError, match=reason):
        inertial_loader(law)


def random_executive(seed: int) -> MotionLaw:
    numbers = np.random.default_rng(seed)
    kind = seed % 4
    if kind == 0:  # symmetric, from rest to rest
        odd = np.zeros(2 * int(numbers.integers(1, 5)))
        odd[1::2] = numbers.normal(size=len(odd) // 2)
        return PolynomialLaw(odd)
    if kind == 1:  # unsymmetric, from rest to rest
        return free_function_law(seed, int(numbers.integers(2, 6)), int(numbers.integers(1, 5)))
    if kind == 2:  # whatever begins and ends anyhow
        return random_law(seed, int(numbers.integers(2, 30)), 0.9, b0=float(numbers.normal()))
    lengths = numbers.dirichlet(np.ones(4))
    breaks = [0.0, *np.cumsum(lengths)[:-1].tolist(), 1.0]
    segments, b = [], 0.0
    for length in lengths.tolist():
        c = numbers.normal(size=3) * 5
        segment = PolynomialSegment(tuple(c.tolist()), b)
        segments.append(segment)
        b = float(segment.derivative(np.ones(1), length, 1)[0])
    return PiecewiseLaw(breaks, segments)


def without_loader(law: MotionLaw) -> str:
    """Why a law has no loader, judged from samples of its velocity."""
    b = np.abs(law.b(np.linspace(0.0, 1.0, 4001)))
    highest = (b[1:-1] >= b[:-2]) & (b[1:-1] > b[2:]) & (b[1:-1] > b.max() * (1.0 - 1e-5))
    if np.argmax(b) in {0, 4000}:
        return r"inside the motion.*k = "
    return "" if np.count_nonzero(highest) % 2 else r"odd number of times.*k = "


@pytest.mark.parametrize(("first", "last"), [(0, 60), pytest.param(60, 200, marks=pytest.mark.long)])
def test_two_hundred_random_laws(first: int, last: int) -> None:
    refused = 0
    for seed in range(first, last):
        law = random_executive(seed)
        if reason := without_loader(law):
            with pytest.raises(InputError, match=reason):
                inertial_loader(law)
            refused += 1
            continue
        balanced = inertial_loader(law)
        assert energy_error(balanced) < 1e-10
        swing = balanced.law.extrema(0)[1].value - min(0.0, balanced.law.a(1.0))
        assert isfinite(swing)
        if seed % 10 == 1:
            B, turn = law.peak(1).value, balanced.turn

            def root(k: float, law: MotionLaw = law, B: float = B) -> float:
                return sqrt(max(B * B - law.b(k) ** 2, 0.0))

            whole = quad(root, 0.0, turn, epsabs=1e-11)[0] + quad(root, turn, 1.0, epsabs=1e-11)[0]
            assert pytest.approx(1.0 / whole, rel=1e-8) == balanced.Y
    assert 0.1 < refused / (last - first) < 0.6


symmetric_laws = st.lists(st.floats(-1.0, 1.0), min_size=1, max_size=4).map(
    lambda z: PolynomialLaw([x for one in (-6.0, *z) for x in (0.0, one)])
)


@examples(25)
@given(law=symmetric_laws, scale=st.floats(0.1, 10.0))
def test_scaling_the_executive_stroke_leaves_the_loader_as_it_is(law: PolynomialLaw, scale: float) -> None:
    law = PolynomialLaw(law.acceleration, b0=-float(np.asarray(law.b(1.0))) / 2 + 3.0)
    try:
        balanced = inertial_loader(law)
    except InputError:
        return
    larger = inertial_loader(PolynomialLaw([scale * c for c in law.acceleration], b0=scale * law.b0))
    assert pytest.approx(balanced.Y / scale, rel=1e-9) == larger.Y
    assert larger.law(K) == pytest.approx(balanced.law(K), abs=1e-9)
    assert larger.law.d(K) == pytest.approx(balanced.law.d(K), abs=1e-7 * balanced.D)


@settings(max_examples=15)
@given(seed=st.integers(0, 2**20))
def test_powers_cancel_and_reversal_reverses(seed: int) -> None:
    law = free_function_law(seed, 4, 3)
    try:
        balanced = inertial_loader(law)
    except InputError:
        return
    assert balanced.law.d(K) == pytest.approx(-(balanced.Y**2) * law.d(K), abs=1e-9 * balanced.D)
    # backwards in time: b(1 - k); the loader runs backwards too, b_l(k) -> -b_l(1 - k)
    back = inertial_loader(reversed_law(law))
    assert pytest.approx(balanced.Y, rel=1e-10) == back.Y
    assert back.law.b(K) == pytest.approx(-balanced.law.b(1.0 - K), abs=1e-8 * balanced.B)
    assert pytest.approx(balanced.Y, rel=1e-10) == inertial_loader(mirrored_law(law)).Y


def test_unsymmetric_laws_swing_by_1_over_rise_and_return() -> None:
    balanced = inertial_loader(free_function_law(3, 4, 6))
    assert not balanced.symmetric
    reached = balanced.law.a(balanced.turn)
    assert reached != pytest.approx(0.5, abs=1e-4)
    # up during the rise, down to the turn of a return that runs the same law: the swing is 1
    assert reached - (balanced.law.a(1.0) - reached) == pytest.approx(1.0, abs=1e-13)


def test_masses_and_strokes() -> None:
    balanced = inertial_loader(smoothstep(3))
    mass = balanced.mass(executive_mass=2.0, executive_stroke=0.05, stroke=0.03)
    assert pytest.approx(balanced.Y**2 * mass * 0.03**2) == 2.0 * 0.05**2
    assert balanced.stroke(executive_mass=2.0, executive_stroke=0.05, mass=mass) == pytest.approx(0.03)
    # kinetic energies add up to one number
    energy = 2.0 * (0.05 * balanced.executive.b(K)) ** 2 + mass * (0.03 * balanced.law.b(K)) ** 2
    assert np.ptp(energy) < 1e-15 * energy[0] * 100
    for wrong in (0.0, -1.0, inf, float("nan")):
        with pytest.raises(InputError, match="stroke must be positive"):
            balanced.mass(executive_mass=1.0, executive_stroke=1.0, stroke=wrong)
        with pytest.raises(InputError, match=r"^mass must be positive"):
            balanced.stroke(executive_mass=1.0, executive_stroke=1.0, mass=wrong)


def test_an_entry_of_the_catalogue_stands_for_its_law() -> None:
    assert inertial_loader(catalogue["cycloidal"]) == inertial_loader(catalogue["cycloidal"].law)  # type: ignore[arg-type] # it has one


# --- the trapezium substitute ---


NOMOGRAM = rows("loader_nomogram")


@pytest.mark.sample(6)
@pytest.mark.parametrize("row", NOMOGRAM[::4], ids=[f"{row['e13']}-{row['gamma_w']}" for row in NOMOGRAM[::4]])
def test_the_nomogram(row: dict[str, str]) -> None:
    substitute = TrapeziumSubstitute(float(row["e13"]), float(row["gamma_w"]))
    exact = inertial_loader(substitute.law)
    half_a_digit = 5.1e-6
    assert (substitute.m, substitute.n) == pytest.approx((float(row["m"]), float(row["n"])), rel=1e-5, abs=1e-9)
    assert pytest.approx(float(row["Y_formula25"]), rel=half_a_digit) == substitute.Y
    assert substitute.Y / substitute.e13 == pytest.approx(float(row["B_bcm"]), rel=half_a_digit)
    peaks = substitute.law.constants
    assert (peaks.B.value, peaks.C.value) == pytest.approx((float(row["B"]), float(row["C"])), rel=half_a_digit)
    assert peaks.D.value == pytest.approx(float(row["D"]), rel=half_a_digit)
    assert pytest.approx(float(row["C_bcm_j05"]), rel=half_a_digit) == substitute.Y / exact.Y * exact.C
    assert substitute.Y**2 * peaks.D.value == pytest.approx(float(row["D_bcm"]), rel=half_a_digit)


def test_eq_25_is_off_by_the_terms_that_its_series_leaves_out() -> None:
    worst = 0.0
    for row in NOMOGRAM[::3]:
        substitute = TrapeziumSubstitute(float(row["e13"]), float(row["gamma_w"]))
        exact = inertial_loader(substitute.law).Y
        x = (3.0 * substitute.m * substitute.e13 / substitute.A) ** 2
        left_out = (
            sum(c * x**i / (4 * i + 1) for i, c in ((4, 5 / 128), (5, 7 / 256), (6, 21 / 1024), (7, 33 / 2048)))
            + (729 / 208 - 3.5) * (substitute.m * substitute.e13 / substitute.A) ** 6
        )
        off = 2.0 * exact * substitute.m / substitute.e13 * left_out
        assert substitute.Y / exact - 1.0 == pytest.approx(-off, abs=2e-8)
        if substitute.m <= 0.2:
            assert pytest.approx(exact, rel=1e-6) == substitute.Y
        worst = max(worst, abs(substitute.Y / exact - 1.0))
    assert 7e-6 < worst < 8e-6  # the triangle m = 1/4, n = 0, whose ramp is the longest


def test_the_formulas_of_velocity_hold_on_each_part() -> None:
    substitute = TrapeziumSubstitute(0.58, 0.3)
    m, n, area = substitute.m, substitute.n, substitute.e13 * substitute.gamma_w
    for k, b in (
        (0.5 * m, (0.5 * m) ** 2 / (2 * area * m)),  # eq. 4
        (m + 0.5 * n, (2 * (m + 0.5 * n) - m) / (2 * area)),  # eq. 5
        (0.4, (0.4 - 0.16 - n * n - m * n - 0.5 * m) / (area * (1 - 2 * m - 2 * n))),  # eq. 6
    ):
        assert substitute.law.b(k) == pytest.approx(b, rel=1e-13)
    arm = (
        2
        * quad(lambda k: substitute.law.c(k) * (0.5 - k), 0.0, 0.5, points=[m, m + n])[0]
        / substitute.law.peak(1).value
    )
    assert arm == pytest.approx(substitute.e13, rel=1e-9)


def test_Y_grows_with_e13_and_falls_with_gamma_w() -> None:
    values = [closed_form_Y(0.6, g) for g in (0.26, 0.28, 0.30, 0.32)]
    assert [round(value, 4) for value in values] == [0.9222, 0.9214, 0.9197, 0.9170]
    assert closed_form_Y(0.61, 0.3) > closed_form_Y(0.6, 0.3)


@pytest.mark.parametrize(
    ("e13", "gamma_w", "reason"),
    [
        (0.6, 0.2, "gamma_w.*0.25 to 0.5"),
        (0.6, 0.51, "gamma_w"),
        (0.7, 0.25, "e13 may be from 0.333333 to 0.666667"),
        (0.3, 0.25, "e13 may be from"),
        (float("nan"), 0.3, "e13|gamma_w"),
    ],
)
def test_outside_the_domain_is_refused(e13: float, gamma_w: float, reason: str) -> None:
    with pytest.raises(InputError, match=reason):
        TrapeziumSubstitute(e13, gamma_w)


def test_substitutes_of_laws() -> None:
    for code in ("0510", "0000", "0040"):  # trapezia are their own substitutes
        law = catalogue[code].law
        assert TrapeziumSubstitute.of(law).law.constants.D.value == pytest.approx(law.constants.D.value, rel=1e-9)
    one = TrapeziumSubstitute.of(smoothstep(3))
    assert (one.e13, one.gamma_w) == pytest.approx((1 / 1.875, 0.3247595264))
    with pytest.raises(InputError, match="no trapezium"):
        TrapeziumSubstitute.of(catalogue["KC05"].law)
    with pytest.raises(InputError, match="gamma_w"):
        TrapeziumSubstitute.of(catalogue["KC00"].law)
