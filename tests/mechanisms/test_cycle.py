"""Steady motion under a cycle: periodic, and what any transient settles to."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from optlaws import CycleResponse, Follower, InputError, PolynomialLaw, catalogue, polydyne, savin, smoothstep
from tests.mechanisms.response_cases import exact_cycle, random_case
from tests.sampling import examples

SHORT = st.one_of(st.just(0.0), st.floats(0.01, 2.0))


def transient(one: CycleResponse, periods: int) -> np.ndarray:
    """State of the mass after whole cycles from rest, each part by a response of its own."""
    state = (0.0, 0.0)
    parts = [
        (one.rise, 1.0, 0.0, 1.0),
        (PolynomialLaw([], a0=1.0), one.dwell, 0.0, 1.0),
        (one.fall, one.fall_duration, 1.0, -1.0),
        (PolynomialLaw([]), one.rest, 0.0, 1.0),
    ]
    for _, (law, duration, a0, sign) in itertools.product(range(periods), parts):
        if duration:
            follower = Follower(one.frequency * duration, one.damping)
            initial = (sign * (state[0] - a0), sign * state[1] * duration)
            a, b = follower.response(law, initial=initial).final
            state = (a0 + sign * a, sign * b / duration)
    return np.array(state)


@settings(max_examples=15)
@given(st.floats(8.0, 80.0), st.floats(0.1, 1.5), SHORT, SHORT, st.floats(0.3, 2.0))
def test_a_transient_settles_to_the_cycle(nu: float, damping: float, dwell: float, rest: float, fall: float) -> None:
    steady = Follower(nu, damping).cycle(savin("III", 7.2), smoothstep(3), dwell=dwell, fall_duration=fall, rest=rest)
    slowest = nu * (damping if damping < 1 else damping - (damping**2 - 1) ** 0.5)
    periods = int(30.0 / (slowest * steady.period)) + 1
    assert [steady.a(0.0), steady.b(0.0) / nu] == pytest.approx(
        (transient(steady, periods) / [1.0, nu]).tolist(), abs=1e-10
    )


@examples(25)
@given(st.integers(0, 500), st.floats(2.0, 80.0), st.floats(1e-6, 1.5), st.floats(0.0, 2.0), st.floats(0.0, 2.0))
def test_it_is_periodic_and_obeys_the_equation(seed: int, nu: float, damping: float, dwell: float, rest: float) -> None:
    law = random_case(2 * seed + 1).law
    steady = Follower(nu, damping).cycle(law, dwell=dwell, rest=rest)
    k = np.linspace(0.0, steady.period, 24, endpoint=False) + 1e-3
    a, b, c = (steady(k, order) for order in range(3))
    place = np.select([k < 1, k < 1 + dwell, k < 2 + dwell], [k, 1.0, 1.0 - (k - 1 - dwell)], 0.0)
    falling = (k >= 1 + dwell) & (k < 2 + dwell)
    run = law.a(np.clip(np.where(falling, k - 1 - dwell, place), 0.0, 1.0))
    cam = np.where(falling, law.a(1.0) - run, run)
    size = max(float(np.abs(a).max()), float(np.abs(cam).max()))
    assert c + 2 * damping * nu * b + nu**2 * a == pytest.approx(nu**2 * cam, abs=1e-11 * nu**2 * size)
    assert steady(k + steady.period) == pytest.approx(a, abs=1e-9 * size)
    assert steady(-1e-12) == pytest.approx(steady(0.0), abs=1e-9 * size)
    assert steady.peak(0).value >= np.abs(a).max() - 1e-12 * size


@pytest.mark.sample(3)
@pytest.mark.parametrize(
    ("nu", "damping"), [(0.5, 0.3), (20.0, 0.0), (20.0, 0.05), (200.0, 0.01), (60.0, 1.0), (90.0, 2.0)]
)
@pytest.mark.parametrize("law", [smoothstep(3), savin("IV", 11.0)], ids=["S3", "IV"])
def test_a_cycle_to_a_dozen_digits(law: PolynomialLaw, nu: float, damping: float) -> None:
    pauses = (0.375, 0.8125)
    steady = Follower(nu, damping).cycle(law, dwell=pauses[0], rest=pauses[1])
    for k in (0.0, 0.29, 1.2, 1.71, 2.9):
        expected = exact_cycle(law, nu, damping, pauses, k)
        for order, value in enumerate(expected):
            size = max(1.0, law.constants.C.value * max(nu, 8.0) ** (order - 2))
            assert steady(k, order) == pytest.approx(value, abs=2e-13 * size), (k, order)


def test_a_cycle_of_a_polydyne_cam_at_rest_leaves_nothing() -> None:
    law = savin("IV", 11.0)
    steady = Follower(20.0, 0.05).cycle(polydyne(law, 20, 0.05), dwell=0.4, rest=0.7)
    k = np.linspace(0.0, 1.0, 21)
    assert steady.a(k) == pytest.approx(law.a(k), abs=1e-12)
    # the return runs the cam's law, so the mass runs the mass law
    assert steady.a(1.4 + k) == pytest.approx(1.0 - law.a(k), abs=1e-12)
    assert steady.peak(2).value == pytest.approx(law.constants.C.value, rel=1e-9)


def test_repeating_makes_a_residual_worse_near_resonance() -> None:
    law = catalogue["simple harmonic"].law
    period = 3.0
    resonant = Follower(frequency=2 * np.pi * 9 / period, damping=0.002)
    once, again = resonant.response(law), resonant.cycle(law, dwell=0.5, rest=0.5)
    assert again.peak(2).value > 1.5 * once.peak(2).value


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"dwell": -0.1}, "dwell must be at least 0"),
        ({"fall_duration": 0.0}, "fall_duration must be above 0"),
        ({"rest": float("nan")}, "rest must be a finite real number"),
        ({"fall": PolynomialLaw.from_powers([0, 0, 1.5])}, "fall must lead back over the rise's stroke 1, but has 1.5"),
    ],
)
def test_nonsense_is_refused(change: dict[str, float], says: str) -> None:
    with pytest.raises(InputError, match=says):
        Follower(20.0, 0.1).cycle(smoothstep(4), **{"dwell": 0.5, "rest": 0.5, **change})  # type: ignore[arg-type]


def test_an_undamped_cycle_in_resonance_has_no_steady_motion() -> None:
    with pytest.raises(InputError, match="in resonance"):
        Follower(frequency=4 * np.pi).cycle(smoothstep(4), dwell=0.5, rest=0.5)
    assert Follower(frequency=4 * np.pi, damping=1e-3).cycle(smoothstep(4), dwell=0.5, rest=0.5).period == 3.0
