"""Free motions of least root mean square: the splines of scipy through the same points, and of no other space."""

from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.interpolate import BSpline, make_interp_spline

from optlaws import Cycle, Dwell, Free, Move, Return, Rise

Array = NDArray[np.float64]
NAMES = {2: "rms acceleration", 3: "rms jerk", 4: "rms snap"}
ALL = "all motions through the joints"


def spline(times: Array, places: Array, nu: int, *, periodic: bool) -> BSpline:
    """The motion of least RMS of the derivative of order nu, at rest at both ends or periodic."""
    ends: Any = "periodic" if periodic else ([(order, 0.0) for order in range(1, nu)],) * 2
    made: BSpline = make_interp_spline(times, places, k=2 * nu - 1, bc_type=ends)
    return made


def rms(curve: BSpline, nu: int, times: Array) -> float:
    """Root mean square of a derivative, exactly: Gauss points between all knots."""
    knots = np.unique(curve.t)
    knots = knots[(knots >= times[0]) & (knots <= times[-1])]
    x, weights = np.polynomial.legendre.leggauss(8)
    middles, halves = 0.5 * (knots[1:] + knots[:-1]), 0.5 * np.diff(knots)
    values = curve.derivative(nu)(middles[:, None] + halves[:, None] * x) ** 2
    return float(np.sqrt(halves @ values @ weights / (times[-1] - times[0])))


def motions(times: Array, places: Array, joints: set[int]) -> list[Free]:
    """Free motions from joint to joint; points between are on the way of one."""
    ends = [0, *sorted(joints), len(times) - 1]
    return [
        Free(
            to=f"{places[last]:.17g} m",
            duration=f"{times[last] - times[first]:.17g} s",
            via=[(f"{times[i] - times[first]:.17g} s", f"{places[i]:.17g} m") for i in range(first + 1, last)],
        )
        for first, last in pairwise(ends)
    ]


def between_rests(segments: list[Any], time: float, nu: int) -> Cycle:
    """A cycle in which free motions, which take a time, begin after a second at rest."""
    back = [Dwell("1 s"), Move(to="0 m", duration="2 s", law="3-4-5")]
    return Cycle([Dwell("1 s"), *segments, *back], period=f"{time + 4:.17g} s", minimise=NAMES[nu], order=nu)


@pytest.mark.sample(2)
@pytest.mark.parametrize("seed", range(18))
def test_the_least_rms_of_random_points_is_the_spline_through_them(seed: int) -> None:
    random = np.random.default_rng(seed)
    nu, periodic, count = (2, 3, 4)[seed % 3], seed % 2 == 1, int(random.integers(2, 9))
    times = np.concatenate([[0.0], np.cumsum(random.uniform(0.05, 1.0, count))])
    places = np.concatenate([[0.0], random.normal(size=count)]) * 10.0 ** random.uniform(-3.0, 1.0)
    if periodic:
        places[-1] = 0.0
    joints = {i for i in range(1, count) if random.integers(2)}
    segments, time = motions(times, places, joints), float(times[-1])
    cycle = Cycle(segments, period=f"{time:.17g} s", minimise=NAMES[nu], order=nu) if periodic else (
        between_rests(segments, time, nu)
    )  # fmt: skip
    curve = spline(times, places, nu, periodic=periodic)
    places_between = np.linspace(0.0, time, 41)[1:-1]
    size = float(np.abs(curve(places_between)).max())
    first = 0.0 if periodic else 1.0
    assert cycle(first + places_between) == pytest.approx(curve(places_between), abs=1e-9 * size)
    (solution,) = cycle.solutions
    piece = next(piece for piece in cycle.pieces if piece.law is solution.law)
    assert solution.objective * abs(piece.stroke) / time**nu == pytest.approx(rms(curve, nu, times), rel=1e-9)
    assert cycle.status == "optimal"
    assert cycle.search_space == ALL


@pytest.mark.parametrize("nu", [3, 4])
def test_dwells_on_the_way_part_a_motion_that_repeats(nu: int) -> None:
    """Wherever a cycle begins, what it does is the same: in one law or in two."""
    ways = [Free("20 mm", "0.15 s"), Free("-50 mm", "0.25 s"), Free("30 mm", "0.2 s"), Dwell("0.2 s")]
    parted = Cycle(ways, period="0.8 s", minimise=NAMES[nu], order=nu)
    whole = Cycle([*ways[1:], ways[0]], period="0.8 s", minimise=NAMES[nu], order=nu)
    assert whole.solutions[0].problem.basis.name == "periodic"
    assert whole.objective == pytest.approx(parted.objective, rel=1e-10)
    assert whole.search_space == parted.search_space == ALL


def test_limits_that_do_not_bind_change_nothing_and_those_that_do_are_of_a_space() -> None:
    steps = [("30 mm", "0.2 s"), ("20 mm", "0.2 s"), ("-50 mm", "0.3 s"), ("25 mm", "0.1 s"), ("-25 mm",)]
    ways = [Free(*step) for step in steps]
    free = Cycle(ways, period="1 s", minimise="rms jerk")
    wide, narrow = (
        Cycle(ways, period="1 s", minimise="rms jerk", limits={"velocity": f"{share * free.peak(1)!r} m/s"})
        for share in (1.01, 0.99)
    )
    assert wide.objective == pytest.approx(free.objective, rel=1e-9)
    assert wide.search_space == ALL
    assert free.objective < narrow.objective < 1.01 * free.objective
    assert narrow.search_space == "splines of degree 3 in 120 pieces"


@pytest.mark.parametrize(
    ("order", "space"),
    [(2, ALL), (3, "laws of order 3 with Z of degree 9")],
)
def test_an_acceleration_that_must_end_with_0_has_no_least_rms(order: int, space: str) -> None:
    """What no law attains, laws of a space come near: the root of 12 of order 2."""
    segments = [Rise("1 m", "1 s"), Return("1 m", "1 s")]
    cycle = Cycle(segments, period="2 s", minimise="rms acceleration", order=order)
    assert cycle.search_space == space
    assert cycle.objective == pytest.approx(12**0.5, rel=1e-9 if order == 2 else 0.2)
    assert cycle.objective >= 12**0.5 * (1.0 - 1e-12)


def test_positions_that_come_back_but_for_rounding_are_measured_by_their_way() -> None:
    ways = [Free("20 mm", "0.15 s"), Free("-50 mm", "0.25 s"), Free("30 mm", "0.2 s")]
    assert sum((0.02, -0.05, 0.03)) != 0.0
    for minimise in ("acceleration", "rms jerk"):
        cycle = Cycle([*ways, Dwell()], period="0.8 s", minimise=minimise)
        assert cycle.status == "optimal"
        assert cycle([0.15, 0.4]) == pytest.approx([0.02, -0.03], abs=1e-12)
