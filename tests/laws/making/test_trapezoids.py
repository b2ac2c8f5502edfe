"""SCCA laws, trapezoids and coded laws: closed forms of their constants, joints and refusals."""

from math import pi
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from optlaws import InputError, scca, smoothstep, trapezoid
from tests.internals.laws import canonical, coded
from tests.sampling import examples

K = np.linspace(0.0, 1.0, 101)
# a stretch below 1e-12 is left out, which moves C by as much against a short total
shares = st.floats(0.0, 1.0).map(lambda share: share if share > 1e-9 else 0.0)


@examples(50)
@given(shares, shares, shares, st.floats(0.05, 1.0))
def test_scca_has_the_constants_of_its_closed_form(a: float, b: float, c: float, total: float) -> None:
    if a + b + c < 0.1:
        return
    a, b, c = (total * one / (a + b + c) for one in (a, b, c))
    # with C = 1: velocity and way of the accelerating part
    V = a / pi + b / 2 + c / pi
    ways = [
        (a / 2) * (a / pi) * (1 - 2 / pi),
        (a / pi) * (b / 2) + b * b / 8,
        (a / pi + b / 2) * (c / 2) + (c / pi) ** 2,
    ]
    C = 1 / (2 * sum(ways) + V * (1 - a - b - c))
    law = scca(a, b, c)
    assert law.a(1.0) == pytest.approx(1.0, abs=1e-13)
    assert law.constants.B.value == pytest.approx(V * C, rel=1e-11)
    assert law.constants.C.value == pytest.approx(C, rel=1e-11)
    assert law.a(K) + law.a(1.0 - K) == pytest.approx(np.ones(101), abs=1e-11)
    assert law.jumps(1) == ()


@examples(50)
@given(shares, shares, shares, st.floats(0.1, 0.5), st.sampled_from([0.5, 1.0, 1.5, 2.0, 1.75, 3.3]))
def test_trapezoids_have_the_constants_of_their_closed_form(
    ramp: float, plateau: float, fall: float, total: float, p: float
) -> None:
    if ramp + plateau + fall < 0.1:
        return
    m, n, L = (total * one / (ramp + plateau + fall) for one in (ramp, plateau, fall))
    V = m / 2 + n + L / (p + 1)
    way = m * m / 6 + m * n / 2 + n * n / 2 + V * L - L * L / ((p + 1) * (p + 2))
    C = 1 / (2 * way + V * (1 - 2 * (m + n + L)))
    law = trapezoid(m, n, L, exponent=p)
    assert law.constants.B.value == pytest.approx(V * C, rel=1e-11)
    assert law.constants.C.value == pytest.approx(C, rel=1e-11)
    assert law.a(K) + law.a(1.0 - K) == pytest.approx(np.ones(101), abs=1e-11)


def test_known_members() -> None:
    assert scca(0.5, 0, 0.5).a(K) == pytest.approx(K - np.sin(2 * pi * K) / (2 * pi), abs=1e-15)
    assert scca(0, 0, 1).a(K) == pytest.approx(0.5 * (1 - np.cos(pi * K)), abs=1e-15)
    assert scca(0.25, 0.5, 0.25).constants.C.value == pytest.approx(8 * pi / (2 + pi), rel=1e-14)
    modified_sine = scca(0.25, 0, 0.75).constants
    assert modified_sine.B.value == pytest.approx(4 * pi / (4 + pi), rel=1e-14)
    assert modified_sine.C.value == pytest.approx(4 * pi**2 / (4 + pi), rel=1e-14)
    assert modified_sine.J.value == pytest.approx(16 * pi**3 / (4 + pi), rel=1e-14)
    assert trapezoid(0, 0).a(K) == pytest.approx(smoothstep(2).a(K), abs=1e-15)
    assert trapezoid(0.25, 0).constants.J.value == pytest.approx(32.0, rel=1e-14)


@pytest.mark.parametrize(
    ("code", "ramp", "plateau", "p"),
    [
        ("0050", 0.0, 0.5, 1.0),
        ("0510", 0.05, 0.1, 1.0),
        ("0307(1,5)", 0.03, 0.07, 1.5),
        ("0317(1.5)", 0.03, 0.17, 1.5),
        ("0312 (1,75)", 0.03, 0.12, 1.75),
        ("0040", 0.0, 0.4, 1.0),
        ("0000", 0.0, 0.0, 1.0),
        ("1005(2)", 0.1, 0.05, 2.0),
    ],
)
def test_codes_are_trapezoids(code: str, ramp: float, plateau: float, p: float) -> None:
    law = coded(code)
    assert law == trapezoid(ramp, plateau, exponent=p)
    L, C = 0.5 - ramp - plateau, law.constants.C.value
    x = np.linspace(0.0, L, 20)[1:-1]
    if L:
        assert law.b(0.5 - x) == pytest.approx(law.b(0.5) - C * x ** (p + 1) / ((p + 1) * L**p), abs=1e-14)
        assert law.c(0.5 - x) == pytest.approx(C * (x / L) ** p, rel=1e-12)


@pytest.mark.parametrize("mm", [0, 5, 20])
def test_cosine_codes_have_their_closed_forms(mm: int) -> None:
    law, m = coded(f"KC{mm:02}"), mm / 100
    L = 0.5 - m
    C = 0.5 / ((2 / pi) * (1 - 2 / pi) * m * m + (2 * m / pi + L / 2) * L - L * L * (1 / 4 - 1 / pi**2))
    assert law.constants.C.value == pytest.approx(C, rel=1e-13)
    assert law.constants.B.value == pytest.approx(C * (2 * m / pi + L / 2), rel=1e-13)
    x = np.linspace(0.0, L, 20)[1:]
    fall = C * (x - (L / pi) * np.sin(pi * x / L)) / 2
    assert law.b(0.5) - law.b(0.5 - x) == pytest.approx(fall, abs=1e-13)
    if mm == 0:
        assert law.constants.B.value == pytest.approx(1 / (0.5 + 2 / pi**2), rel=1e-14)
        k = np.linspace(0.0, 0.5, 20)
        assert law.c(k) == pytest.approx(C * np.cos(pi * k) ** 2, abs=1e-14)


def test_codes_have_one_form() -> None:
    assert [canonical(text) for text in ("0317(1.50)", "0317 (1,5)", "kc05", "0510(1)", "0510(2)")] == [
        "0317(1,5)",
        "0317(1,5)",
        "KC05",
        "0510",
        "0510(2)",
    ]
    assert [canonical(text) for text in ("K", "031", "0317(x)", "0317()", "KC5", "modified sine")] == [None] * 6


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: scca(0.5, 0.5, 0.5), "at most 1 in all, got 0.5, 0.5, 0.5"),
        (lambda: scca(0, 0, 0), "not all 0"),
        (lambda: scca(-0.1, 0.5, 0.5), "at least 0"),
        (lambda: scca(float("nan"), 0.5, 0.5), "a"),
        (lambda: scca("x", 0.5, 0.5), "a"),  # type: ignore[arg-type]
        (lambda: trapezoid(0.3, 0.3), "lengths .* at most 1/2"),
        (lambda: trapezoid(-0.1, 0.3), "at least 0"),
        (lambda: trapezoid(0, 0, 0), "not all 0"),
        (lambda: trapezoid(0.1, 0.2, exponent=0.0), "exponent must be above 0"),
        (lambda: coded("0399"), "50 hundredths of the motion, not 102"),
        (lambda: coded("KC51"), "50 hundredths"),
        (lambda: coded("0317(0)"), "exponent must be above 0"),
        (lambda: coded("K"), "mmnn, mmnn"),
    ],
)
def test_wrong_shapes_are_refused(make: Any, message: str) -> None:
    with pytest.raises(InputError, match=message):
        make()
