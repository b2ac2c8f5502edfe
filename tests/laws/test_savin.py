"""Savin's families: printed and recomputed constants, closed forms, the chain, members by their peaks."""

from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from optlaws import InputError, SavinFamily, savin, smoothstep
from tests.internals.laws import alpha_range
from tests.sampling import examples
from tests.tables import rows

PEAKS, LEAST, START = (rows(f"savin_{name}") for name in ("peaks", "least", "start"))
families = pytest.mark.parametrize("u", [0, 1, 2, 3, 4, 7, 11])


def named(row: dict[str, str]) -> str:
    return f"{row['family']} {row.get('alpha', '')}"


@pytest.mark.parametrize("row", PEAKS, ids=named)
@pytest.mark.parametrize("name", "BCD")
def test_peaks_are_the_reference_s(row: dict[str, str], name: str) -> None:
    alpha, family = float(row["alpha"]), SavinFamily.of(row["family"])
    for peak in (getattr(family, name)(alpha), getattr(savin(row["family"], alpha).constants, name)):
        assert peak.value == pytest.approx(float(row[name]), rel=1e-9)
        # where y(1/2) = 0 the velocity is flat to the fourth order at its peak
        assert peak.k == pytest.approx(float(row[f"k{name}"]), abs=1e-7 if name == "B" else 1e-9)


@pytest.mark.parametrize("row", LEAST, ids=named)
def test_the_best_members_are_the_reference_s(row: dict[str, str]) -> None:
    family = SavinFamily.of(row["family"])
    for name, (alpha, peak) in (("C", family.least_C), ("D", family.least_D)):
        assert alpha == pytest.approx(float(Fraction(row[f"alpha_min{name}"])), rel=1e-9)
        assert peak.value == pytest.approx(float(row[f"min{name}"]), rel=1e-9)
        assert peak.k == pytest.approx(float(row[f"k_min{name}"]), rel=1e-9)
        assert getattr(savin(row["family"], alpha).constants, name).value == pytest.approx(peak.value, rel=1e-14)


@pytest.mark.parametrize("row", START, ids=named)
def test_start_values_are_the_reference_s(row: dict[str, str]) -> None:
    alpha = float(row["alpha"])
    order, value = SavinFamily.of(row["family"]).start(alpha)
    assert order == int(row["first_nonzero_order"])
    assert value == pytest.approx(float(Fraction(row["first_nonzero_exact"])), rel=1e-14)
    start, _ = savin(row["family"], alpha).boundary_values(order + 1)
    assert start[order] == pytest.approx(value, rel=1e-9)
    # a rounding error of c counts n² times as much in each further derivative
    assert start[:order] == pytest.approx([0.0] * order, abs=1e-10)
    if order > 2:
        assert float(row["c_k0"]) == 0.0


@families
def test_closed_forms_are_the_constants_of_the_law_to_rounding(u: int) -> None:
    family = SavinFamily(u)
    low, high = map(float, family.range)
    for alpha in [*np.linspace(low, high, 13).tolist(), 1e-12, -1e-7, low + 1e-9, high - 1e-9]:
        constants = family.law(alpha).constants
        for name in "BCD":
            found, exact = getattr(constants, name), getattr(family, name)(alpha)
            assert found.value == pytest.approx(exact.value, rel=1e-14)
            assert found.k == pytest.approx(exact.k, abs=1e-7 if name == "B" else 1e-10)


@pytest.mark.sample(3)
@families
def test_the_best_members_are_the_best(u: int) -> None:
    family = SavinFamily(u)
    low, high = map(float, family.range)
    alphas = np.linspace(low, high, 161).tolist()
    for name, (best, peak) in (("C", family.least_C), ("D", family.least_D)):
        heights = [getattr(family, name)(alpha).value for alpha in alphas]
        nearest = alphas[int(np.argmin(heights))]
        assert abs(best - nearest) <= (high - low) / 160
        assert peak.value <= min(heights) * (1 + 1e-15)
        signs = np.sign(np.diff(heights))
        assert (np.diff(signs[signs != 0]) >= 0).all()  # falls, then rises


def test_beyond_family_iv_least_power_is_at_the_end_of_the_range() -> None:
    inside = [SavinFamily(u).least_D[0] < float(SavinFamily(u).range[1]) for u in range(7)]
    assert inside == [True] * 4 + [False] * 3


@families
def test_each_family_ends_in_the_base_law_of_the_next(u: int) -> None:
    family = SavinFamily(u)
    low, high = family.range
    assert family.law(float(low)) == family.next.law(0.0) == smoothstep(u + 3)
    assert family.next.H == family.H / family.M
    assert family.law(0.0) == smoothstep(family.order)
    multiplier = [1 + alpha * (family.M - Fraction(1, 4)) for alpha in (low, high)]  # y at k = 1/2
    assert multiplier[0] > 0
    assert multiplier[1] == 0


@given(st.integers(0, 15), st.floats(0.0, 1.0))
def test_members_rise_and_are_symmetric(u: int, share: float) -> None:
    low, high = alpha_range(u)
    law = savin(u, min(max(low + share * (high - low), low), high))
    k = np.linspace(0.0, 1.0, 101)
    assert law.a(1.0) == pytest.approx(1.0, abs=1e-13)
    assert law.a(k) + law.a(1.0 - k) == pytest.approx(np.ones(101), abs=1e-13)
    assert law.c(k[:51]).min() >= -1e-12 * law.peak(2).value


@examples(40)
@given(st.integers(0, 8), st.floats(0.0, 1.0), st.sampled_from("BCD"))
def test_members_are_found_by_their_peaks(u: int, share: float, name: str) -> None:
    family = SavinFamily(u)
    low, high = map(float, family.range)
    alpha = min(max(low + share * (high - low), low), high)
    value = getattr(family, name)(alpha).value
    alphas = family.alphas(**{name: value})
    assert len(alphas) in ((1,) if name == "B" else (1, 2))
    assert [getattr(family, name)(one).value for one in alphas] == pytest.approx([value] * len(alphas), rel=1e-14)
    # near the least of C or D its peak hardly depends on alpha
    assert min(abs(one - alpha) for one in alphas) <= 1e-6 * (high - low)


def test_two_members_are_told_apart() -> None:
    lower, upper = SavinFamily(2).alphas(C=7.0)
    assert lower < 6.0 < upper
    assert savin("III", C=7.0, branch="lower") == savin("III", lower)
    assert savin("III", C=7.0, branch="upper") == savin("III", upper)
    assert savin("III", D=9.0) == savin("III", *SavinFamily(2).alphas(D=9.0))
    assert savin("III", B=1.75).constants.B.value == pytest.approx(1.75, rel=1e-15)


def test_names_are_exponents() -> None:
    assert [SavinFamily.of(name) for name in ("I", "II", "III", "IV")] == [SavinFamily(u) for u in range(4)]
    assert savin(2, 7.2) == savin("III", 7.2)
    assert (str(SavinFamily(2)), str(SavinFamily(4))) == ("family III", "the family of u = 4")


@pytest.mark.parametrize(
    ("keywords", "message"),
    [
        ({"alpha": 12.1}, "alpha of family III must be between -6 and 12"),
        ({"alpha": -6.0001}, "between -6 and 12"),
        ({"alpha": float("nan")}, "alpha"),
        ({"alpha": "7"}, "alpha"),
        ({}, "one of alpha, B, C and D, got none"),
        ({"alpha": 1.0, "B": 1.75}, "got alpha and B"),
        ({"alpha": 1.0, "branch": "lower"}, "branch selects one of two members"),
        ({"B": 3.0}, "B of family III reaches from 1.640625 to 2.4609375, got 3.0"),
        ({"C": 6.7}, "C of family III reaches from 6.7357.* to 9.3719"),
        ({"D": 1.0}, "D of family III reaches from 6.78262"),
        ({"C": float("inf")}, "C"),
        ({"C": 7.0}, r"two members of this C, alpha = 2.489\d* and 10.244\d*; say branch='lower' or branch='upper'"),
        ({"C": 7.0, "branch": "left"}, "'lower' or 'upper', got 'left'"),
    ],
)
def test_wrong_members_are_refused(keywords: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        savin("III", **keywords)


@pytest.mark.parametrize("family", ["V", "iii", -1, 2.5, None])
def test_wrong_families_are_refused(family: Any) -> None:
    for call in (lambda: savin(family, 0.0), lambda: alpha_range(family)):
        with pytest.raises(InputError, match="family"):
            call()


@pytest.mark.parametrize("u", range(4))
@pytest.mark.parametrize("name", ["C", "D"])
def test_a_peak_at_an_end_of_the_range_gives_that_end(u: int, name: str) -> None:
    family = SavinFamily(u)
    for end in map(float, family.range):
        assert end in family.alphas(**{name: getattr(family, name)(end).value})
