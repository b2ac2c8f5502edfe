"""The inverse task: levers with wanted constants, or the reason why there is none."""

import pytest

from optlaws import InputError, TorsionLever, deg, find_torsion_levers
from tests.internals.balancing import QUANTITIES

GIVEN = {"rho": 0.15, "nu": 0.15, "swing": deg(60)}


@pytest.mark.sample(9)
@pytest.mark.parametrize("name", QUANTITIES)
def test_a_known_lever_is_found_again(name: str) -> None:
    known = TorsionLever(beta=0.8, lam=1.7, **GIVEN)
    value = QUANTITIES[name](known)
    levers = find_torsion_levers({name: value}, lam=1.7, **GIVEN)
    assert min(abs(lever.beta - 0.8) for lever in levers) < 1e-6
    for lever in levers:
        assert QUANTITIES[name](lever) == pytest.approx(value, rel=1e-10)


def test_the_coupler_is_found_for_a_period() -> None:
    (one,) = find_torsion_levers({"T": 6.1}, beta=0.75, **GIVEN)
    assert one.exact.period == pytest.approx(6.1, rel=1e-11)
    assert one.lam == pytest.approx(1.1196914, rel=1e-6)


def test_all_levers_are_found_where_there_are_several() -> None:
    # B3 rises from beta = 0.02 to 0.13 or so and falls again
    levers = find_torsion_levers({"B3": 1.585}, lam=1.0, beta=(0.02, 1.0), rho=0.15, nu=0.15, swing=deg(40))
    assert [lever.exact.B3 for lever in levers] == pytest.approx([1.585, 1.585], rel=1e-11)
    assert levers[0].beta < 0.13 < levers[1].beta


def test_both_lengths_are_found_for_two_constants() -> None:
    known = TorsionLever(beta=0.7, lam=2.5, **GIVEN).exact
    levers = find_torsion_levers({"T": known.period, "B1/B3": known.B1 / known.B3}, **GIVEN)
    assert any((lever.beta, lever.lam) == pytest.approx((0.7, 2.5), rel=1e-5) for lever in levers)
    for lever in levers:
        assert (lever.exact.period, lever.exact.B1 / lever.exact.B3) == pytest.approx(
            (known.period, known.B1 / known.B3), rel=1e-8
        )


def test_a_value_at_the_very_limit_is_reached() -> None:
    # the rocker swings by 60 degrees at beta = 1, where the range ends
    (one,) = find_torsion_levers({"B1/B3": 1.0 - 1e-9}, lam=1.0, **GIVEN)
    assert one.beta == pytest.approx(1.0, abs=1e-5)


@pytest.mark.sample(3)
@pytest.mark.parametrize(
    ("expected", "lengths", "message"),
    [
        ({"B1/B3": 1.2}, {"lam": 1.0}, r"B1/B3 = 1\.2 is out of reach: for beta from 0\.25 to 1, .* to 1 \(at 1\)"),
        ({"T": 9.0}, {"beta": 0.75}, r"T = 9 is out of reach: for lam from 0\.5 to 10"),
        (
            {"T": 6.1, "B1/B3": 0.9},
            {},
            r"no lever has T = 6\.1 and B1/B3 = 0\.9: the nearest has .* alone each reaches",
        ),
        ({"B2": 1.0}, {"lam": 1.0}, "unknown constant of the lever 'B2'"),
        ({"T": 6.1}, {}, r"1 targets \(T\), 2 sought \(beta, lam\)"),
        ({}, {}, r"0 targets \(none\)"),
        ({"T": float("inf")}, {"lam": 1.0}, "T"),
        ({"T": 6.1}, {"lam": 1.0, "beta": (1.0, 0.5)}, "beta must be a number above 0 or a range"),
        ({"T": 6.1}, {"lam": 1.0, "beta": (2.0, 2.5)}, "passes a dead point"),
    ],
)
def test_what_is_out_of_reach_is_said(expected: dict[str, float], lengths: dict[str, float], message: str) -> None:
    with pytest.raises(InputError, match=message):
        find_torsion_levers(expected, **lengths, **GIVEN)
