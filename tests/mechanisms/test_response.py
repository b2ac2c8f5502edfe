"""The follower's response: against DOP853, against 120 digits, and what every response must obey."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from optlaws import (
    Follower,
    InputError,
    Machine,
    MotionLaw,
    PiecewiseLaw,
    PolynomialLaw,
    catalogue,
    residual_phasor,
    savin,
    smoothstep,
)
from tests.internals.laws import PolynomialSegment
from tests.laws.examples import EXAMPLES, cut, cut_power, cut_sine, random_law
from tests.mechanisms.response_cases import CRITICAL, Case, exact, integrated, random_case
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


@pytest.mark.sample(15)
@pytest.mark.parametrize("seed", range(30))
def test_random_laws_against_an_integrator(seed: int) -> None:
    assert max(misses(random_case(seed))) < 1e-9


@pytest.mark.long
@pytest.mark.parametrize("seed", range(200))
def test_two_hundred_random_laws_against_an_integrator(seed: int) -> None:
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


@pytest.mark.parametrize("nu", [3.0, 30.0, 300.0, 2 * np.pi, 2 * np.pi * (1 + 1e-9), 6 * np.pi])
@pytest.mark.parametrize("damping", [0.0, 1e-3, 1.0])
def test_a_cycloid_in_closed_form_also_in_resonance(nu: float, damping: float) -> None:
    follower = Follower(nu, damping).response(cut_sine())
    series = np.polynomial.Chebyshev.interpolate(lambda k: cut_sine().c(k), 40, [0, 1]).coef
    same = Follower(nu, damping).response(PolynomialLaw(series))
    for order in range(4):
        assert follower(K, order) == pytest.approx(same(K, order), abs=1e-12 * max(nu, 8.0) ** order)


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


@pytest.mark.parametrize("name", ["cycloidal", "modified trapezoid", "0317(1,5)", "double harmonic"])
def test_pieces_are_the_law(name: str) -> None:
    """Cutting a law, or passing it on as one of a kind unknown here, changes nothing."""

    class Disguised(MotionLaw):
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

    law = catalogue[name].law
    known, unknown = (Follower(25.0, 0.02).response(one) for one in (law, Disguised(law)))
    assert unknown.a(K) == pytest.approx(known.a(K), abs=1e-13)
    assert unknown.c(K) == pytest.approx(known.c(K), abs=1e-11)


def test_cutting_a_law_changes_nothing() -> None:
    for nu, damping in ((2.5, 0.0), (40.0, 0.03), (40.0, 1.0)):
        whole, pieces = (Follower(nu, damping).response(one) for one in (smoothstep(4), cut(smoothstep(4), 0.2, 0.7)))
        assert pieces.c(K) == pytest.approx(whole.c(K), abs=1e-12 * max(8.0, nu) ** 2)
        assert pieces.peak(2).value == pytest.approx(whole.peak(2).value, rel=1e-12)


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


def test_a_stiff_follower_does_what_the_cam_does() -> None:
    follower = Follower(1e5, 0.3).response(smoothstep(5))
    assert follower.c(K) == pytest.approx(smoothstep(5).c(K), abs=1e-2)
    assert follower.dynamic_factor() == pytest.approx(1.0, abs=1e-6)


def test_a_soft_follower_hardly_moves() -> None:
    follower = Follower(1e-3).response(smoothstep(4))
    mean = 1e-6 * 0.5  # nu² times the mean of a
    assert follower.b(1.0) == pytest.approx(mean, rel=1e-5)


def test_constant_power_has_a_response_although_its_acceleration_is_infinite() -> None:
    law = cut_power(0.0, 1.5)
    follower = Follower(12.0, 0.1).response(law)
    case = Case(law, lambda k: float(law.a(k)), 12.0, 0.1, (law.a(0.0), 0.0))
    k = [0.2, 0.6, 1.0]
    assert follower.a(k) == pytest.approx(integrated(case, k)[:, 0], abs=1e-9)
    assert np.isfinite(follower.c(K)).all()


def test_a_jump_of_velocity_is_an_impulse() -> None:
    law = PiecewiseLaw([0, 0.5, 1], [PolynomialSegment((), 0.5), PolynomialSegment((), 1.5)])
    follower = Follower(9.0).response(law)
    before, after = follower.b([0.5 - 1e-12, 0.5])
    assert after == pytest.approx(before, abs=1e-9)
    assert follower.j(0.5) - follower.j(0.5 - 1e-12) == pytest.approx(81.0, abs=1e-6)


def test_a_machine_is_a_dimensionless_follower() -> None:
    machine = Follower.from_units(mass=3.0, stiffness=1.2e5, duration=0.08, damping=120.0)
    assert (machine.frequency, machine.n) == pytest.approx((0.08 * 200.0, 120.0 * 0.08 / (2 * 3.0)))
    turning = Follower.from_speed(speed_rpm=105, rise_angle_deg=150, natural_period=0.05, damping=0.1)
    duration = 150 / 360 * 60 / 105
    assert (turning.frequency, turning.damping) == pytest.approx((2 * np.pi * duration / 0.05, 0.1))
    assert turning.speed_rpm(rise_angle_deg=150, natural_period=0.05) == pytest.approx(105)
    # 105 rpm and nu = 20 belong together where phi/T is 35 rad/s
    assert Follower(20.0).speed_rpm(rise_angle_deg=np.degrees(35.0 * 0.06), natural_period=0.06) == pytest.approx(105)


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
    ],
)
def test_nonsense_is_refused(call: object, says: str) -> None:
    with pytest.raises(InputError, match=says):
        call()  # type: ignore[operator]
