"""The follower's response: against DOP853 and 120 digits, free, steady under a cycle, and with units."""

import itertools
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from optlaws import (
    CycleResponse,
    Follower,
    InputError,
    Machine,
    MotionLaw,
    PolynomialLaw,
    catalogue,
    driving_law,
    dwell_mechanism,
    mass_law,
    off_design,
    polydyne,
    residual_phasor,
    savin,
    smoothstep,
)
from tests.internals.mechanisms import Oscillator
from tests.laws.examples import EXAMPLES, cut, cut_power, cut_sine, random_law
from tests.mechanisms.response_cases import CRITICAL, Case, exact, exact_cycle, integrated, random_case
from tests.sampling import examples

K = np.linspace(0.0, 1.0, 41)
NUS, DAMPINGS = (0.5, 2.0, 7.3, 41.0, 200.0, 2000.0), (0.0, 0.05, 0.9, 1.0, 1.0 + 1e-9, 1.5, 2.0)


def misses(case: Case) -> tuple[float, float]:
    """Greatest differences of displacement and velocity from DOP853, relative to their size, rise and dwell."""
    k = np.linspace(0.0, 1.3, 27)[1:]
    follower = Follower(case.nu, case.damping).response(case.law, initial=case.initial)
    expected = integrated(case, k.tolist())
    a, b = (np.abs(follower(k, order) - expected[:, order]).max() for order in (0, 1))
    size = max(1.0, float(np.abs(expected[:, 0]).max()))
    return a / size, b / (size * case.nu)


@pytest.mark.sample(100)
@pytest.mark.parametrize("seed", range(200))
def test_random_laws_against_an_integrator(seed: int) -> None:
    assert max(misses(random_case(seed))) < 1e-9


@pytest.mark.sample(15)
@pytest.mark.parametrize("damping", DAMPINGS)
@pytest.mark.parametrize("nu", NUS)
@pytest.mark.parametrize("law", [smoothstep(2), savin("IV", 11.0), random_law(2, 30, 0.95)], ids=["S2", "IV", "30"])
def test_every_order_to_a_dozen_digits(law: PolynomialLaw, nu: float, damping: float) -> None:
    follower = Follower(nu, damping).response(law)
    for k in (0.013, 0.37, 1.0):
        expected = exact(law, nu, damping, k)
        for order in range(4):
            size = law.constants.C.value * max(nu, 8.0) ** (order - 2)
            rounding = 1e-15 * max(1.0, abs(expected[order]))
            miss = max(2e-13, 2e-16 * nu)  # the phase nu k is rounded
            assert follower(k, order) == pytest.approx(expected[order], abs=miss * size + rounding), (k, order)


@pytest.mark.parametrize("damping", [0.0, 0.05])
def test_rounding_of_the_drive_does_not_shake_the_mass(damping: float) -> None:
    """What a smooth law leaves at a high frequency is a millionth of what it accelerates."""
    law, nu = savin("IV", 11.0), 2000.0
    expected = nu**2 * abs(residual_phasor(law, nu, damping)[0])
    assert Follower(nu, damping).response(law).residual_acceleration == pytest.approx(expected, abs=2e-13)
    machine = Machine.from_follower(Follower(nu, damping)).response(law, dwell=0.005)
    assert nu**2 * machine.dwell_peak("deflection").value <= expected + 1e-12


@pytest.mark.sample(6)
@pytest.mark.parametrize("name", EXAMPLES)
@pytest.mark.parametrize(("nu", "damping"), [(4.0, 0.1), (33.0, 0.0), (20.0, 1.0)])
def test_the_equation_of_motion_holds(name: str, nu: float, damping: float) -> None:
    law = EXAMPLES[name]
    follower = Follower(nu, damping).response(law)
    a, b, c, j = (follower(K, order) for order in range(4))
    size = max(1.0, float(np.abs(law.a(K)).max()))
    assert c + 2 * damping * nu * b + nu**2 * a == pytest.approx(nu**2 * law.a(K), abs=1e-12 * nu**2 * size)
    step = 1e-5
    inside = K[1:-1] + 1e-4
    middle = (follower.c(inside + step) - follower.c(inside - step)) / (2 * step)
    assert middle == pytest.approx(follower.j(inside), abs=1e-5 * max(1.0, float(np.abs(j).max())) * max(1.0, nu / 10))


class Disguised(MotionLaw):
    """A law as one of a kind unknown here."""

    def __init__(self, law: MotionLaw) -> None:
        self.law = law

    def _derivative(self, k: np.ndarray, nu: int) -> np.ndarray:
        return np.asarray(self.law(k, nu))

    def _sides(self, nu: int) -> tuple[np.ndarray, np.ndarray]:
        raise NotImplementedError(nu)

    def _power_sides(self) -> tuple[np.ndarray, np.ndarray]:
        raise NotImplementedError

    def _mean_square(self, nu: int) -> float:
        raise NotImplementedError(nu)

    def _summary(self) -> str:
        return ""


CYCLOID = PolynomialLaw(np.polynomial.Chebyshev.interpolate(cut_sine().c, 40, [0, 1]).coef)
SAME = {
    "a cycloid as a series": (CYCLOID, cut_sine()),
    "in pieces": (smoothstep(4), cut(smoothstep(4), 0.2, 0.7)),
    **{
        f"{name} of a kind unknown here": (catalogue[name].law, Disguised(catalogue[name].law))
        for name in ("cycloidal", "modified trapezoid", "0317(1,5)", "double harmonic")
    },
}


@pytest.mark.sample(3)
@pytest.mark.parametrize("name", SAME)
@pytest.mark.parametrize("nu", [2.5, 25.0, 40.0, 300.0, 2 * np.pi, 2 * np.pi * (1 + 1e-9), 6 * np.pi])
@pytest.mark.parametrize("damping", [0.0, 1e-3, 0.03, 1.0])
def test_a_law_is_the_same_drive_in_whatever_form_and_in_resonance(name: str, nu: float, damping: float) -> None:
    first, second = (Follower(nu, damping).response(law) for law in SAME[name])
    for order in range(4):
        assert second(K, order) == pytest.approx(first(K, order), abs=2e-12 * max(nu, 8.0) ** order)
    assert second.peak(2).value == pytest.approx(first.peak(2).value, rel=1e-11)


@examples(30)
@given(
    st.integers(0, 1000),
    st.floats(2.0, 200.0),
    st.one_of(st.sampled_from([0.0, *CRITICAL]), st.floats(0.0, 1.5)),
    st.integers(0, 3),
)
def test_no_value_exceeds_the_extrema(seed: int, nu: float, damping: float, order: int) -> None:
    follower = Follower(nu, damping).response(random_case(seed).law)
    low, high = follower.extrema(order)
    values = follower(np.linspace(0.0, 1.0, 1501), order)
    size = float(np.abs(values).max())
    assert low.value <= values.min() + 1e-10 * size
    assert high.value >= values.max() - 1e-10 * size
    # where the motion jumps, the law has its right-hand value, and the extreme may be the left-hand one
    for extreme in (low, high):
        sides = follower(np.array([max(extreme.k - 1e-13, 0.0), extreme.k]), order)
        assert np.abs(sides - extreme.value).min() <= 1e-9 * size + 1e-12
    assert follower.peak(order).value == pytest.approx(max(-low.value, high.value), rel=1e-12)


@examples(30)
@given(st.integers(0, 1000), st.floats(2.0, 200.0), st.floats(0.0, 1.5), st.floats(-1.0, 1.0), st.floats(-1.0, 1.0))
def test_responses_add(seed: int, nu: float, damping: float, displacement: float, speed: float) -> None:
    """The response to a law from a state is that from rest plus the free vibration of the state."""
    law, follower = random_case(seed).law, Follower(nu, damping)
    whole = follower.response(law, initial=(displacement, speed * nu))
    resting, free = follower.response(law), follower.response(PolynomialLaw([]), initial=(displacement, speed * nu))
    k = np.linspace(0.0, 2.0, 15)
    assert whole.a(k) == pytest.approx(resting.a(k) + free.a(k), abs=1e-12 * max(1.0, float(np.abs(whole.a(k)).max())))


def test_the_dwell_begins_where_the_rise_ends_and_dies_out() -> None:
    for damping in (0.02, 1.0, 1.4):
        follower = Follower(30.0, damping).response(smoothstep(3))
        for order in range(3):
            assert follower(1.0 + 1e-13, order) == pytest.approx(follower(1.0, order), abs=1e-9)
        assert follower(40.0) == pytest.approx(1.0, abs=1e-9)
        assert follower.final == (follower.a(1.0), follower.b(1.0))


def test_a_law_that_still_moves_at_its_end_strikes() -> None:
    """The cam stops at once; the mass goes on."""
    follower = Follower(10.0).response(smoothstep(1))
    assert follower.b(1.0 + 1e-12) == pytest.approx(follower.b(1.0), abs=1e-9)
    # a ramp started from rest and stopped: two free vibrations of amplitude 1/nu, a phase nu apart
    assert follower.residual_displacement == pytest.approx(2 / 10.0 * abs(np.sin(10.0 / 2)), rel=1e-12)


def test_the_residual_is_the_amplitude_of_the_dwell() -> None:
    follower = Follower(17.0).response(smoothstep(3))
    k = np.linspace(1.0, 2.0, 20001)
    assert follower.residual_displacement == pytest.approx(np.abs(follower.a(k) - 1.0).max(), rel=1e-6)
    assert follower.residual_acceleration == pytest.approx(follower.dwell_peak(2).value, rel=1e-12)
    assert follower.residual_acceleration == pytest.approx(np.abs(follower.c(k)).max(), rel=1e-6)
    past = Follower(17.0, 1.2).response(smoothstep(3))
    assert past.residual_displacement == pytest.approx(np.abs(past.a(k) - 1.0).max(), rel=1e-12)


def test_constant_power_has_a_response_although_its_acceleration_is_infinite() -> None:
    law = cut_power(0.0, 1.5)
    follower = Follower(12.0, 0.1).response(law)
    case = Case(law, lambda k: float(law.a(k)), 12.0, 0.1, (law.a(0.0), 0.0))
    k = [0.2, 0.6, 1.0]
    assert follower.a(k) == pytest.approx(integrated(case, k)[:, 0], abs=1e-9)
    assert np.isfinite(follower.c(K)).all()


def test_a_machine_is_a_dimensionless_follower() -> None:
    machine = Follower.from_units(mass=3.0, stiffness=1.2e5, duration=0.08, damping=120.0)
    assert (machine.frequency, machine.n) == pytest.approx((0.08 * 200.0, 120.0 * 0.08 / (2 * 3.0)))
    turning = Follower.from_speed(speed_rpm=105, rise_angle_deg=150, natural_period=0.05, damping=0.1)
    duration = 150 / 360 * 60 / 105
    assert (turning.frequency, turning.damping) == pytest.approx((2 * np.pi * duration / 0.05, 0.1))
    assert turning.speed_rpm(rise_angle_deg=150, natural_period=0.05) == pytest.approx(105)
    # 105 rpm and nu = 20 belong together where phi/T is 35 rad/s
    assert Follower(20.0).speed_rpm(rise_angle_deg=np.degrees(35.0 * 0.06), natural_period=0.06) == pytest.approx(105)


# --- steady motion under a cycle ---


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


def test_an_undamped_cycle_in_resonance_has_no_steady_motion() -> None:
    with pytest.raises(InputError, match="in resonance"):
        Follower(frequency=4 * np.pi).cycle(smoothstep(4), dwell=0.5, rest=0.5)
    assert Follower(frequency=4 * np.pi, damping=1e-3).cycle(smoothstep(4), dwell=0.5, rest=0.5).period == 3.0


# --- free vibration ---


NEAR_ONE = [1.0, 1.0 - 1e-15, 1.0 + 1e-15, 1.0 - 1e-9, 1.0 + 1e-9, 1.0 - 1e-4, 1.0 + 1e-4]
NEAR_CRITICAL = st.one_of(st.sampled_from([0.0, *NEAR_ONE]), st.floats(0.0, 1.5))


@given(st.floats(0.5, 30.0), NEAR_CRITICAL, st.floats(-1.0, 1.0), st.floats(-1.0, 1.0), st.integers(0, 3))
def test_no_later_value_exceeds_the_peak(nu: float, damping: float, h0: float, speed: float, order: int) -> None:
    one, v0 = Oscillator(nu, damping), speed * nu
    peak = one.peak(h0, v0, order)
    s = np.linspace(0.0, 20.0 / nu, 4001)
    size = np.abs(one.motion(h0, v0, s, order))
    scale = (abs(h0) + abs(speed)) * nu**order
    assert peak.value >= size.max() - 1e-12 * scale
    assert peak.value <= size.max() + 1e-4 * scale
    at_peak = abs(float(one.motion(h0, v0, np.array([peak.k]), order)[0]))
    assert at_peak == pytest.approx(peak.value, abs=1e-12 * scale)


# --- units ---


OSCILLATOR = Machine([[0, 1], [-400, -2]], [[0], [400]], [[1, 0]], outputs=["position"])
TIMES = {"speed": "105 rpm", "rise": "120 deg"}


def test_answers_are_those_of_the_follower_in_units() -> None:
    follower = Follower.from_vibration("16.7 Hz", **TIMES, damping=0.05)
    assert follower == Follower.from_vibration(f"{1 / 16.7!r} s", **TIMES, damping=0.05)
    same = Follower.from_speed(speed_rpm=105, rise_angle_deg=120, natural_period=1 / 16.7, damping=0.05)
    assert follower.frequency == pytest.approx(same.frequency, rel=1e-14)
    response = follower.response(catalogue["modified sine"].law)
    answers = response.in_units("35 mm", **TIMES)
    time = answers["time, s"]
    assert time == pytest.approx(120 / 360 * 60 / 105, rel=1e-14)
    size = 0.035 / time**2
    assert answers == pytest.approx(
        {
            "stroke, m": 0.035,
            "time, s": time,
            "dynamic factor": response.dynamic_factor(),
            "peak velocity, m/s": 0.035 / time * response.peak(1).value,
            "peak acceleration, m/s²": size * response.peak(2).value,
            "acceleration in the dwell, m/s²": size * response.dwell_peak(2).value,
            "residual displacement, m": 0.035 * response.residual_displacement,
            "residual acceleration, m/s²": size * response.residual_acceleration,
        },
        rel=1e-14,
    )
    turning = response.in_units("20 deg", duration="0.2 s")
    assert (turning["stroke, rad"], turning["time, s"]) == pytest.approx((0.349065850, 0.2))


def test_entries_of_the_catalogue_stand_for_their_laws() -> None:
    entry = catalogue["4-5-6-7"]
    assert Follower(20).response(entry) == Follower(20).response(entry.law)  # type: ignore[arg-type] # what people give
    cam = polydyne(entry, 20)  # type: ignore[arg-type]
    assert cam == polydyne(entry.law, 20)
    assert mass_law(entry, 20) == mass_law(entry.law, 20)  # type: ignore[arg-type]
    assert off_design(cam, entry, Follower(20))[0].dynamic_factor > 1  # type: ignore[arg-type]
    assert driving_law(OSCILLATOR, entry) == driving_law(OSCILLATOR, entry.law)  # type: ignore[arg-type]
    angles = {"dwell": 1.5, "rise": 1.5, "swing": 0.3, "radius_ratio": 1.0, "inertia_ratio": 0.1}
    assert dwell_mechanism("I", law=entry, **angles) == dwell_mechanism("I", law=entry.law, **angles)  # type: ignore[arg-type]


def cycled(**change: Any) -> Any:
    return Follower(20.0, 0.1).cycle(smoothstep(4), **{"dwell": 0.5, "rest": 0.5, **change})


def vibrating(**change: Any) -> Any:
    return Follower.from_vibration(**{"vibration": "16.7 Hz", **TIMES, **change})


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (lambda: Follower(frequency=0.0), "frequency must be above 0"),
        (lambda: Follower(frequency=float("nan")), "frequency must be a finite real number"),
        (lambda: Follower(frequency=20, damping=-0.1), "damping must be at least 0"),
        (lambda: Follower(20).response("IV"), "law must be a motion law"),  # type: ignore[arg-type]
        (lambda: Follower(20).response(smoothstep(3), initial=(1.0,)), "initial"),  # type: ignore[arg-type]
        (lambda: Follower(20).response(smoothstep(3)).a(-0.1), "k must be at least 0"),
        (lambda: Follower(20).response(smoothstep(3)).a(float("inf")), "k must be finite"),
        (lambda: Follower(20).response(smoothstep(3))(0.5, nu=-1), "nu must be an integer of at least 0"),
        (lambda: Follower(20).response(smoothstep(1)).dynamic_factor(), "finite C above 0"),
        (lambda: Follower(20).response(cut_power(0.0, 1.5)).dynamic_factor(), "finite C above 0"),
        (lambda: Follower.from_units(mass=-1, stiffness=1, duration=1), "mass must be above 0"),
        (lambda: Follower.from_speed(speed_rpm=0, rise_angle_deg=90, natural_period=0.1), "speed_rpm must be above 0"),
        (lambda: cycled(dwell=-0.1), "dwell must be at least 0"),
        (lambda: cycled(fall_duration=0.0), "fall_duration must be above 0"),
        (lambda: cycled(rest=float("nan")), "rest must be a finite real number"),
        (lambda: cycled(fall=PolynomialLaw.from_powers([0, 0, 1.5])), "over the rise's stroke 1, but has 1.5"),
        (lambda: vibrating(vibration="16.7"), "vibration must be a frequency such as .* without a unit"),
        (lambda: vibrating(vibration="0 Hz"), "vibration must be above 0"),
        (lambda: vibrating(vibration="3 kg"), "vibration must be a frequency"),
        (lambda: vibrating(duration="1 s"), "give duration"),
        (lambda: vibrating(rise=None), "give duration"),
        (lambda: vibrating(speed="3 Hz"), "is a frequency"),
        (lambda: Follower(20).response(smoothstep(4)).in_units("35 kg", duration="1 s"), "stroke must be a length"),
        (lambda: Follower("20 Hz"), r"frequency is dimensionless, .* got '20 Hz': .*Follower\.from_vibration"),  # type: ignore[arg-type]
    ],
)
def test_nonsense_is_refused(call: object, says: str) -> None:
    with pytest.raises(InputError, match=says):
        call()  # type: ignore[operator]
