"""The trapezium substitute: eq. 25 against exact loaders, the nomogram, its domain."""

import pytest
from scipy.integrate import quad

from optlaws import InputError, TrapeziumSubstitute, catalogue, inertial_loader, smoothstep
from tests.internals.balancing import closed_form_Y
from tests.tables import rows

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
