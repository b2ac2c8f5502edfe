"""Motions of limits by integration beside closed forms: near rest, with drag, and where bounds change places."""

from collections.abc import Callable

import mpmath as mp  # type: ignore[import-untyped]
import pytest

from optlaws import drive_limit

EXACT = 1e-8


def least_time_against_waves(P: float, height: float, waves: float) -> float:
    """The least time for |c + height sin(waves a)| <= P: first at P, then at -P."""
    mp.mp.dps = 40

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
@pytest.mark.parametrize("slope", [20.0, 60.0, 200.0])
def test_no_motion_comes_to_rest_against_a_spring_by_less_than_its_mean(slope: float) -> None:
    # at half the spring's greatest torque the motion is a half wave of a cosine, that takes less than the time 1
    limit = drive_limit(f"c + {slope}*a", "peak torque")
    assert limit.value <= 0.5 * slope
    assert 0.5 * slope * (1.0 - 1e-12) <= limit.attained <= 0.5 * slope * (1.0 + 1e-9)


def least_peak_with_drag(drag: float) -> float:
    """The least P within which c + drag b moves from rest to rest in the time 1: first at P, then at -P."""
    mp.mp.dps = 30
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
    mp.mp.dps = 30
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
