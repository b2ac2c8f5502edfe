"""Laws made of laws: with an end velocity (1.17), reversed, mirrored, shaped, and given as formulas."""

from typing import Any

import mpmath  # type: ignore[import-untyped]
import numpy as np
import pytest

from optlaws import (
    Follower,
    InputError,
    MotionLaw,
    PiecewiseLaw,
    PolynomialLaw,
    catalogue,
    formula_law,
    mirrored_law,
    read_law,
    reversed_law,
    savin,
    scca,
    shaped_law,
    smoothstep,
    with_end_velocity,
)
from tests.internals.laws import PolynomialSegment, PowerSegment, Shaper, as_polynomial, law_between, section
from tests.laws.examples import cut

K = np.linspace(0.0, 1.0, 257)  # 1 - k is exact


def test_constant_power_stays_what_it_is_where_it_can() -> None:
    law = PiecewiseLaw([0, 0.5, 1], [PowerSegment(0.0, 1.5), PowerSegment(1.5, 0.0)])
    assert reversed_law(law) == law
    faster = with_end_velocity(law, 0.2)
    assert faster.b([0.0, 0.5, 1.0]) == pytest.approx([0.2, 1.4, 0.2], abs=1e-15)
    assert faster.constants.C.value == faster.constants.D.value == np.inf  # c is infinite where b is not 0


def test_other_smooth_laws_become_polynomials() -> None:
    law = scca(0.5, 0.0, 0.5)  # the cycloid
    found = as_polynomial(law)
    assert isinstance(found, PolynomialLaw)
    assert found.a(K) == pytest.approx(law.a(K), abs=1e-14)
    with pytest.raises(InputError, match="smooth"):
        as_polynomial(scca(0.25, 0.5, 0.25))


def test_laws_between_laws_in_pieces_are_weighted_means_where_the_breaks_agree() -> None:
    first, last = cut(smoothstep(3), 0.25, 0.5), cut(smoothstep(5), 0.25, 0.5)
    for one, other in ((first, last), (smoothstep(2), smoothstep(5))):
        mean = law_between(one, other, 0.25)
        for nu in range(4):
            room = 1e-14 * float(np.abs(other(K, nu)).max())
            assert mean(K, nu) == pytest.approx(0.75 * one(K, nu) + 0.25 * other(K, nu), abs=room)
    with pytest.raises(InputError, match="polynomials with the same breaks"):
        law_between(first, cut(smoothstep(5), 0.25, 0.625), 0.25)


def test_a_section_is_a_part_of_the_law_with_stroke_and_duration_1() -> None:
    rise = cut(smoothstep(3), 0.25, 0.5, 0.75)
    for law in (rise, mirrored_law(rise)):
        assert isinstance(law, PiecewiseLaw)
        part = section(law, 1, 3)
        start, stroke = law.a(0.25), law.a(0.75) - law.a(0.25)
        assert part.breaks == (0.0, 0.5, 1.0)
        assert part.a(K) == pytest.approx((law.a(0.25 + 0.5 * K) - start) / stroke, abs=1e-14)


def test_a_section_that_ends_where_it_begins_has_no_stroke() -> None:
    back = PiecewiseLaw([0, 0.5, 1], [PolynomialSegment((16.0,), -4.0), PolynomialSegment((-16.0,), 4.0)])
    with pytest.raises(InputError, match=r"from 0 to 0\.5 ends where it begins"):
        section(back, 0, 1)


@pytest.mark.parametrize("b0", [None, "1", float("nan")])
def test_wrong_velocities_are_refused(b0: Any) -> None:
    with pytest.raises(InputError, match="b0"):
        with_end_velocity(smoothstep(3), b0)


# --- shaped laws ---


LAWS: dict[str, MotionLaw] = {
    "polynomial": smoothstep(3),
    "sines": catalogue["modified sine"].law,
    "pieces": catalogue["constant acceleration"].law,
    "savin": savin("IV", 11.0),
}


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("shaper", ["ZV", "ZVD"])
@pytest.mark.parametrize(("nu", "damping"), [(9.0, 0.0), (14.0, 0.05), (60.0, 0.2)])
def test_nothing_is_left_of_the_vibration_and_the_law_is_a_sum(
    law: str, shaper: Shaper, nu: float, damping: float
) -> None:
    shaped = shaped_law(LAWS[law], nu, damping, shaper)
    assert Follower(nu, damping).response(shaped).residual_acceleration < 1e-9 * nu**2
    half = np.pi / (nu * np.sqrt(1.0 - damping**2))
    left = np.exp(-damping * nu * half)
    shares = np.array([1.0, left]) if shaper == "ZV" else np.array([1.0, 2.0 * left, left**2])
    duration = 1.0 - half * (len(shares) - 1)
    k = np.linspace(0.0, 1.0, 501)
    parts = [LAWS[law].a(np.clip((k - i * half) / duration, 0.0, 1.0)) for i in range(len(shares))]
    expected = np.array(shares / shares.sum()) @ np.array(parts)
    assert shaped.a(k) == pytest.approx(expected, abs=1e-12)


def test_three_repetitions_forgive_more_than_two() -> None:
    left = {}
    for shaper in ("ZV", "ZVD"):
        shaped = shaped_law(smoothstep(3), 20.0, 0.0, shaper)
        left[shaper] = [Follower(20.0 * off).response(shaped).residual_displacement for off in (0.98, 1.02)]
    assert max(left["ZVD"]) < 0.2 * max(left["ZV"])


@pytest.mark.parametrize(
    ("says", "arguments"),
    [
        ("leaves no time for the law", (3.0, 0.0, "ZV")),
        ("takes 1 of a period", (6.3, 0.0, "ZVD")),
        ("damping must be below 1", (20.0, 1.0, "ZV")),
        ("shaper", (20.0, 0.0, "E1")),
        ("one damping for all", ([20.0, 30.0], [0.0, 0.1, 0.2], "ZV")),
        ("frequency must be", (0.0, 0.0, "ZV")),
    ],
)
def test_wrong_shapers_are_named(says: str, arguments: tuple[float, float, Shaper]) -> None:
    with pytest.raises(InputError, match=says):
        shaped_law(smoothstep(3), *arguments)


@pytest.mark.parametrize("shaper", ["ZV", "MZV", "ZVD"])
def test_two_vibrations_are_shaped_one_after_the_other(shaper: Shaper) -> None:
    shaped = shaped_law(smoothstep(3), [25.0, 60.0], [0.02, 0.1], shaper)
    for nu, damping in ((25.0, 0.02), (60.0, 0.1)):
        assert Follower(nu, damping).response(shaped).residual_acceleration < 1e-9 * nu**2
    assert shaped.a(1.0) == pytest.approx(1.0, abs=1e-14)


# --- formulas ---


PLACES = np.linspace(0.0, 1.0, 41)


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("k - sin(2*pi*k)/(2*pi)", "cycloidal"),
        ("(1 - cos(pi*k))/2", "simple harmonic"),
        ("k^3*(10 - 15*k + 6*k^2)", "3-4-5 polynomial"),
        ("k + sin(pi*k)/pi", "C2"),
        ("2*k^2 - max(0, 2*k - 1)^2", None),
        ("k", "constant velocity"),
    ],
)
def test_formulas_of_standard_laws_are_these_laws(text: str, name: str | None) -> None:
    law = formula_law(text)
    known = catalogue[name or "constant acceleration"].law
    for nu in range(4 if name else 3):
        assert law(PLACES, nu) == pytest.approx(known(PLACES, nu), abs=1e-11 * 10**nu)
    for constant in "BCD":
        exact = getattr(known.constants, constant).value
        assert getattr(law.constants, constant).value == pytest.approx(exact, rel=1e-12)


def test_derivatives_are_those_of_mpmath() -> None:
    law = formula_law("(exp(2*k) - 1 + atan(3*k)*k^3)/(exp(2) - 1 + atan(3))")

    def exact(k: mpmath.mpf) -> mpmath.mpf:
        top = mpmath.exp(2 * k) - 1 + mpmath.atan(3 * k) * k**3
        return top / (mpmath.exp(2) - 1 + mpmath.atan(3))

    with mpmath.workdps(40):
        for k in (0.0, 0.3, 0.77, 1.0):
            for nu in range(4):
                value = float(mpmath.diff(exact, mpmath.mpf(k), nu))
                assert law(k, nu) == pytest.approx(value, rel=1e-11, abs=1e-11)


def test_kinks_are_where_parts_meet_whichever_they_are() -> None:
    law = formula_law("max(0, k - 0.3, 2*k - 0.8, 3*k - 1.6)")
    assert law(PLACES) == pytest.approx(
        np.max([0 * PLACES, PLACES - 0.3, 2 * PLACES - 0.8, 3 * PLACES - 1.6], axis=0), abs=1e-15
    )
    assert np.array(law.jumps(1)) == pytest.approx(np.array([(0.3, 1.0), (0.5, 1.0), (0.8, 1.0)]))
    swing = formula_law("abs(sin(3*pi*k))")
    assert [place for place, _ in swing.jumps(1)] == pytest.approx([1 / 3, 2 / 3])
    table = formula_law("table(k, 0:0, 0.5:0.25, 1:1)")
    assert table.jumps(1) == ((0.5, 1.0),)


@pytest.mark.parametrize(
    "shape", ["spline(k, 0:0, 0.2:0.1, 0.6:0.7, 0.8:0.9, 1:1)", "spline(2*k, 0:0, 1:0.4, 1.5:1, 2:1)"]
)
def test_splines_are_cubics_between_their_places(shape: str) -> None:
    law = formula_law(shape)
    assert isinstance(law, PiecewiseLaw)
    assert law.jumps(1) == law.jumps(2) == ()
    assert law(PLACES, 4) == pytest.approx(0.0, abs=1e-7)


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("k +", "expected a number"),
        ("k + b", "unknown name 'b'"),
        ("1/(k - 0.5)", "is divided by"),
        ("sqrt(k)", "acceleration of the law"),
        ("k^1.5", "acceleration of the law"),
        ("abs(k - 0.4)^1.5", "acceleration of the law"),
        ("log(k)", "no finite value"),
        ("", "expected a number"),
        (3, "must be a text"),
    ],
)
def test_what_is_no_law_is_refused(text: str, named: str) -> None:
    with pytest.raises(InputError, match=named):
        formula_law(text)


def test_a_formula_is_named_wherever_a_law_is() -> None:
    assert read_law("formula: k^2*(3 - 2*k)") == formula_law("k^2*(3 - 2*k)")
    with pytest.raises(InputError, match="a tolerance and columns are of a table"):
        read_law("formula: k", tolerance=0.1)
