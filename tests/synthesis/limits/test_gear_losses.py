"""Limits behind gears with losses, and motions of limits by integration, beside closed forms."""

from collections.abc import Callable, Iterator
from math import sqrt
from typing import Any

import mpmath as mp  # type: ignore[import-untyped]
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad, solve_ivp

from optlaws import (
    Drive,
    DriveLimit,
    InfeasibleProblem,
    Mechanism,
    Motor,
    Powers,
    Problem,
    at_most,
    catalogue,
    drive_limit,
    integral,
    rms,
)
from tests.internals.synthesis import limit_beside
from tests.sampling import examples


def behind(motor: str, load: str, to_load: float, back: float) -> str:
    return f"{motor} + max({to_load!r}*({load}), {back!r}*({load}))"


def of_two_inertias(driving: float, braking: float) -> dict[str, float]:
    """Least peak and RMS torque of an inertia that is another one while it brakes: parabolas, and cubics."""
    turn = driving / (driving + braking)
    mean = turn**3 / driving**2 + (1.0 - turn) ** 3 / braking**2
    way = turn**2 * (1.0 - turn / 3.0) / driving**2 - (1.0 - turn) ** 3 / 3.0 / braking**2
    return {"peak torque": 2.0 * (driving + braking), "rms torque": sqrt(mean / 3.0) / (way / 2.0)}


@pytest.mark.sample(2)
@pytest.mark.parametrize(
    ("minimise", "unit"), [("peak torque", 1.0), ("rms torque", 1.0), ("rms torque", 1e-9), ("peak torque", 1e9)]
)
def test_a_table_behind_a_gear_has_closed_forms(minimise: str, unit: float) -> None:
    known = of_two_inertias(0.3 + 1.0 / 0.85, 0.3 + 0.8)[minimise]
    torque = behind(f"{0.3 * unit!r}*c", f"{unit!r}*c", 1.0 / 0.85, 0.8)
    limit = drive_limit(torque, minimise)  # type: ignore[arg-type]
    assert known * (1.0 - 2e-6) <= limit.value / unit <= known * (1.0 + 1e-12)
    assert limit.attained / unit == pytest.approx(known, rel=2e-6)
    assert limit.bound == limit.value
    assert DriveLimit.from_json(limit.to_json()) == limit


def test_energy_behind_a_gear_is_that_of_the_least_greatest_velocity() -> None:
    """Of an inertia within an acceleration: what is left of the kinetic energy comes back, less the losses."""
    B = 2.5 - sqrt(2.5**2 - 5.0)
    torque = behind("0.3*c", "c", 1.0 / 0.85, 0.8)
    given, fed_back = (0.3 + 1.0 / 0.85) * B**2 / 2.0, (0.3 + 0.8) * B**2 / 2.0
    for share in (0.0, 0.6):
        limit = drive_limit(torque, "energy", C=5.0, recovered=share)
        assert limit.value == pytest.approx(given - share * fed_back, rel=3e-6)


def least_time_by_passes(P: float, motor: float, wave: float, shares: tuple[float, float]) -> float:
    """Of a motor and an inertia 1 + wave cos(2 pi a): the greatest w = b² from both ends, by an integrator.

    Where power flows back, the branch is looked for at every place and velocity, though the bound is not convex there.
    """

    def branches(a: float, w: float) -> list[tuple[float, float]]:
        inertia, square = 1.0 + wave * np.cos(2 * np.pi * a), -np.pi * wave * np.sin(2 * np.pi * a)
        return [(motor + share * inertia, share * square * w) for share in shares]

    def forward(a: float, w: np.ndarray) -> list[float]:
        return [2.0 * min((P - rest) / inertia for inertia, rest in branches(a, w[0]))]

    def backward(a: float, w: np.ndarray) -> list[float]:
        return [-2.0 * min((-P - rest) / inertia for inertia, rest in branches(1.0 - a, w[0]))]

    passes: list[Any] = [
        solve_ivp(slope, (0.0, 1.0), [0.0], rtol=1e-9, atol=1e-11, dense_output=True).sol
        for slope in (forward, backward)
    ]

    def pace(s: float) -> float:
        a = np.sin(0.5 * np.pi * s) ** 2
        return float(0.5 * np.pi * np.sin(np.pi * s) / np.sqrt(min(passes[0](a)[0], passes[1](1.0 - a)[0])))

    return float(quad(pace, 0.0, 1.0, limit=200, epsabs=1e-8)[0])


@pytest.mark.sample(2)
@pytest.mark.parametrize("wave", [0.5, 0.9])
def test_least_times_are_those_of_passes_though_the_bound_is_not_convex(wave: float) -> None:
    load = f"(1 + {wave}*cos(2*pi*a))*c - {wave}*pi*sin(2*pi*a)*b^2"
    limit = drive_limit(behind("0.5*c", load, 1.0 / 0.7, 0.7), "time", P=7.0)
    known = least_time_by_passes(7.0, 0.5, wave, (1.0 / 0.7, 0.7))
    assert known * (1.0 - 1e-5) <= limit.value <= known * (1.0 + 1e-7)
    assert limit.attained == pytest.approx(known, rel=1e-7)


@given(st.floats(0.1, 1.5), st.floats(0.1, 0.9), st.floats(0.5, 0.95), st.floats(0.5, 0.95))
@examples(4)
def test_motions_that_change_the_form_in_which_they_brake_are_found(
    motor: float, wave: float, driving: float, braking: float
) -> None:
    load = f"(1 + {wave!r}*cos(2*pi*a))*c - {wave!r}*pi*sin(2*pi*a)*b^2"
    shares = 1.0 / driving, braking
    limit = drive_limit(behind(f"{motor!r}*c", load, *shares), "time", P=7.0)
    assert limit.attained == pytest.approx(least_time_by_passes(7.0, motor, wave, shares), rel=1e-6)


@given(
    st.floats(0.0, 1.5),
    st.floats(0.0, 0.9),
    st.floats(-6.0, 6.0),
    st.floats(0.5, 1.0),
    st.sampled_from(["peak torque", "rms torque", "energy"]),
)
@examples(6)
def test_no_standard_law_beats_the_limit(motor: float, wave: float, lift: float, eta: float, minimise: str) -> None:
    load = f"(1 + {wave!r}*cos(2*pi*a))*c - {wave!r}*pi*sin(2*pi*a)*b^2 + 0.3*b + {lift!r}*a"
    k, laws = np.linspace(0.0, 1.0, 4001), [catalogue[name].law for name in ("345", "modified sine", "cycloidal")]
    C = max(float(np.abs(law.c(k)).max()) for law in laws) * 1.000001
    limit = drive_limit(behind(f"{motor!r}*c", load, 1.0 / eta, eta), minimise, C=C)  # type: ignore[arg-type]
    for law in laws:
        a, b, c = law.a(k), law.b(k), law.c(k)
        through = (1 + wave * np.cos(2 * np.pi * a)) * c - wave * np.pi * np.sin(2 * np.pi * a) * b**2
        through += 0.3 * b + lift * a
        values = motor * c + np.maximum(through / eta, through * eta)
        own = {
            "peak torque": float(np.abs(values).max()),
            "rms torque": sqrt(float(np.trapezoid(values**2, k))),
            "energy": float(np.trapezoid(np.maximum(values * b, 0.0), k)),
        }[minimise]
        assert 0.0 < limit.value <= own * (1.0 + 1e-6) + 1e-9


@pytest.mark.long
def test_a_table_that_turns_has_the_limit_of_its_drive() -> None:
    """0.8 kg m² by 45 deg in 0.25 s, ratio 20: the two inertias that the motor feels."""
    drive = Drive(Mechanism("0.8 kg m^2"), Motor("3e-4 kg m^2"), ratio=20, efficiency=0.85)
    moved = drive.dimensionless("0 deg", "45 deg", "0.25 s")
    sheet = drive.sheet("modified sine", "0 deg", "45 deg", "0.25 s")
    for minimise, of_law in (("peak torque", sheet.peak_torque), ("rms torque", sheet.rms_torque)):
        known = of_two_inertias(*(3e-4 + 0.8 / 400 * share for share in (1 / 0.85, 0.85)))[minimise]
        known *= 20 * np.pi / 4 / 0.25**2
        limit = drive_limit(moved.torque, minimise)  # type: ignore[arg-type]
        assert limit.value * moved.unit == pytest.approx(known, rel=3e-6)
        assert limit.value * moved.unit < of_law
    fed_back = Drive(Mechanism("0.8 kg m^2"), Motor("3e-4 kg m^2"), ratio=20, efficiency=0.85, regeneration=0.5)
    text = fed_back.dimensionless("0 deg", "45 deg", "0.25 s").energy
    beside = limit_beside(Problem(order=3, basis=Powers(7), monotone=True, C=at_most(9.0), minimise=integral(text)))
    assert beside is not None
    assert beside.value == pytest.approx(drive_limit(moved.torque, "energy", C=9.0, recovered=0.5).value, rel=3e-6)


@pytest.mark.long
def test_problems_of_the_greater_of_two_torques_have_limits() -> None:
    load = "c + 3*a"
    torque = behind("0.2*c", load, 1.25, 0.8)
    other = "0.2*c + max(1.25*c + 3.75*a, 0.8*c + 2.4*a)"
    known = drive_limit(torque, "rms torque", B=1.9).value
    for text in (torque, other):
        limit = limit_beside(Problem(order=3, basis=Powers(7), monotone=True, B=at_most(1.9), minimise=rms(text)))
        assert limit is not None
        assert limit.value == pytest.approx(known, rel=3e-6)


def test_a_motor_that_is_too_weak_is_proven_to_be() -> None:
    torque = behind("0.3*c", "c", 1.0 / 0.85, 0.8)
    with pytest.raises(InfeasibleProblem, match="the least time within them is 1\\.0") as error:
        drive_limit(torque, "rms torque", P=5.0)
    driving, braking = 0.3 + 1.0 / 0.85, 0.3 + 0.8
    proof = error.value.proof
    assert isinstance(proof, DriveLimit)
    assert proof.value == pytest.approx(sqrt(2.0 * (driving + braking) / 5.0), rel=3e-6)


# --- motions by integration ---


EXACT = 1e-8


@pytest.fixture(autouse=True)
def forty_digits() -> Iterator[None]:
    with mp.workdps(40):
        yield


def least_time_against_waves(P: float, height: float, waves: float) -> float:
    """The least time for |c + height sin(waves a)| <= P: first at P, then at -P."""

    def ahead(a: mp.mpf) -> mp.mpf:
        return 2 * P * a - 2 * height * (1 - mp.cos(waves * a)) / waves

    def back(rest: mp.mpf) -> mp.mpf:
        return 2 * P * rest + 2 * height * (mp.cos(waves * (1 - rest)) - mp.cos(waves)) / waves

    def time(law: Callable[[mp.mpf], mp.mpf], way: mp.mpf) -> mp.mpf:
        """The time of a way, over its root, in which the pace is smooth."""
        pieces = mp.linspace(0, mp.sqrt(way), 25)
        return mp.quad(lambda root: 2 * root / mp.sqrt(law(root**2)), pieces, method="gauss-legendre")

    meet = mp.findroot(lambda a: ahead(a) - back(1 - a), 0.5)
    return float(time(ahead, meet) + time(back, 1 - meet))


@pytest.mark.sample(3)
@pytest.mark.parametrize(
    ("P", "height", "waves"),
    [(9.0, 0.0, 1.0), (7.0, -6.0, 5.0), (7.0, 3.0, 10.0), (7.0, 3.0, 30.0), (7.0, -3.0, 30.0), (7.0, 3.0, 60.0)],
)
def test_loads_that_change_fast_near_rest_are_integrated_as_exactly_as_none(
    P: float, height: float, waves: float
) -> None:
    limit = drive_limit(f"c + {height}*sin({waves}*a)", "time", P=P)
    least = least_time_against_waves(P, height, waves)
    assert limit.value <= least
    assert least * (1.0 - 1e-10) <= limit.attained <= least * (1.0 + EXACT)


@pytest.mark.sample(3)
@pytest.mark.parametrize("slope", [60.0, 20.0, 200.0])
def test_no_motion_comes_to_rest_against_a_spring_by_less_than_its_mean(slope: float) -> None:
    # at half the spring's greatest torque the motion is a half wave of a cosine, that takes less than the time 1
    limit = drive_limit(f"c + {slope}*a", "peak torque")
    assert limit.value <= 0.5 * slope
    assert 0.5 * slope * (1.0 - 1e-12) <= limit.attained <= 0.5 * slope * (1.0 + 1e-9)


def least_peak_with_drag(drag: float) -> float:
    """The least P within which c + drag b moves from rest to rest in the time 1: first at P, then at -P."""
    R = mp.mpf(drag)

    def misses(P: mp.mpf, ahead: mp.mpf) -> list[mp.mpf]:
        b = P / R * (1 - mp.exp(-R * ahead))
        back = mp.log(1 + R * b / P) / R
        return [P / R * (ahead - back) - 1, ahead + back - 1]

    P, _ = mp.findroot(misses, (4 + R / 2 + R * R / 20, 0.55))
    return float(P)


@pytest.mark.sample(2)
@pytest.mark.parametrize("drag", [0.03, 0.3, 3.0, 10.0])
def test_drag_from_rest_is_integrated_as_exactly_as_without(drag: float) -> None:
    limit, least = drive_limit(f"c + {drag}*b", "peak torque"), least_peak_with_drag(drag)
    assert limit.value <= least
    assert least * (1.0 - 1e-12) <= limit.attained <= least * (1.0 + EXACT)


def least_time_with_drag(drag: float, P: float, C: float) -> float:
    """The least time for c + drag b <= P and abs(c) <= C: at C up to where both meet, then at P, then at -C."""
    change = (P - C) / drag

    def at(time: mp.mpf) -> tuple[mp.mpf, mp.mpf]:
        faded = 1 - mp.exp(-drag * time)
        more = change + (P / drag - change) * faded
        return change**2 / (2 * C) + P / drag * time + (change - P / drag) * faded / drag, more

    def misses(time: mp.mpf) -> mp.mpf:
        a, b = at(time)
        return a + b * b / (2 * C) - 1

    time = mp.findroot(misses, 0.3)
    return float(change / C + time + at(time)[1] / C)


@pytest.mark.sample(6)
@pytest.mark.parametrize("C", [5.0, 5.3, 5.513])
@pytest.mark.parametrize("drag", [0.8, 1.1])
def test_the_torque_takes_over_from_the_acceleration_where_it_does(drag: float, C: float) -> None:
    limit, least = drive_limit(f"c + {drag}*b", "time", P=6.0, C=C), least_time_with_drag(drag, 6.0, C)
    assert limit.value <= least
    assert least * (1.0 - 1e-12) <= limit.attained <= least * (1.0 + EXACT)
