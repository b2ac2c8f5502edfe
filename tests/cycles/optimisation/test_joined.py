"""Whole cycles as one law that repeats: splines through free joints, dwells on the way, and limits at joints."""

import json
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.interpolate import BSpline, CubicSpline, make_interp_spline
from scipy.optimize import linprog

from optlaws import (
    Axes,
    ConstantVelocity,
    Cycle,
    Dwell,
    Free,
    InfeasibleProblem,
    InputError,
    Move,
    PeriodicPieces,
    Return,
    Rise,
)
from tests.internals.cli import exit_code

WAYS = [Free("30 mm", "0.2 s"), Free("20 mm", "0.2 s"), Free("-50 mm", "0.3 s"), Free("25 mm", "0.1 s"), Free("-25 mm")]
TIMES = np.array([0.0, 0.2, 0.4, 0.7, 0.8, 1.0])
PLACES = np.array([0.0, 0.03, 0.05, 0.0, 0.025, 0.0])


def test_the_least_rms_of_the_acceleration_is_the_periodic_spline_of_the_joints() -> None:
    cycle = Cycle(WAYS, period="1 s", minimise="rms acceleration")
    spline = CubicSpline(TIMES, PLACES, bc_type="periodic")
    times = np.linspace(0.0, 0.9999, 101)
    for nu in range(3):
        size = float(np.abs(spline(times, nu)).max())
        assert cycle(times, nu) == pytest.approx(spline(times, nu), abs=1e-8 * size)
    assert cycle.status == "optimal"
    assert cycle.lower_bound == pytest.approx(cycle.objective, rel=1e-8)


def test_no_law_on_a_fine_grid_has_a_smaller_peak_acceleration() -> None:
    """Linear programming over accelerations that are constant in 200 steps."""
    cycle = Cycle(WAYS, period="1 s")
    count = 200
    step = 1.0 / count
    moved = np.tril(np.ones((count, count)), -1)  # velocity at the start of each step, in steps of acceleration
    position = step**2 * (np.cumsum(moved, axis=0) + 0.5 * np.tril(np.ones((count, count))))
    ends = np.round(TIMES[1:] * count).astype(int) - 1
    equations = [np.concatenate([position[end], [TIMES[i + 1], 0.0]]) for i, end in enumerate(ends)]
    equations.append(np.concatenate([np.full(count, step), [0.0, 0.0]]))
    above = np.hstack([np.vstack([np.eye(count), -np.eye(count)]), np.zeros((2 * count, 1)), -np.ones((2 * count, 1))])
    optimum: Any = linprog(
        [0.0] * (count + 1) + [1.0], above, np.zeros(2 * count), np.array(equations), [*PLACES[1:], 0.0],
        bounds=[(None, None)] * (count + 2),
    )  # fmt: skip
    assert cycle.status == "optimal"
    assert 0.999 * optimum.fun < cycle.objective < 1.03 * optimum.fun


@pytest.mark.sample(4)
@pytest.mark.parametrize("minimise", ["acceleration", "jerk", "rms jerk"])
def test_what_repeats_ends_as_it_begins(minimise: str) -> None:
    cycle = Cycle(WAYS, period="1 s", minimise=minimise, degree=5)
    (solution,) = cycle.solutions
    assert isinstance(solution.problem.basis, PeriodicPieces)
    assert cycle.status == "optimal"
    assert cycle(TIMES[:-1]) == pytest.approx(PLACES[:-1], abs=1e-11)
    assert len(cycle.joints) == len(WAYS)
    assert all(joint["velocity"] == joint["acceleration"] == 0.0 for joint in cycle.joints)
    turned = Cycle([*WAYS[2:], *WAYS[:2]], period="1 s", minimise=minimise, start="50 mm", degree=5)
    assert turned.objective == pytest.approx(cycle.objective, rel=1e-7)


def test_a_cycle_that_begins_within_a_motion_dwells_and_keeps_limits() -> None:
    ways = [Free("30 mm", "0.2 s", limits={"velocity": "250 mm/s"}), Dwell("0.2 s"), Free("-30 mm")]
    cycle = Cycle(ways, period="1 s")
    free = Cycle([Free("30 mm", "0.2 s"), *ways[1:]], period="1 s")
    assert cycle([0.2, 0.3, 0.4]) == pytest.approx([0.03] * 3, abs=1e-12)
    assert cycle.peaks[0].peak(1) <= 0.25 * (1 + 1e-9) < free.peaks[0].peak(1)
    assert [cycle.peaks[1].peak(nu) for nu in (1, 2, 3)] == [0.0, 0.0, 0.0]
    assert cycle.status == free.status == "optimal"
    assert cycle.objective > free.objective
    steady = Cycle([Free("30 mm", "0.2 s"), ConstantVelocity("100 mm/s", "0.2 s"), Free("-50 mm")], period="1 s")
    assert steady([0.2, 0.3, 0.4], 1) == pytest.approx([0.1] * 3, abs=1e-11)
    assert steady.status == "optimal"


def test_rest_between_moves_and_ways_that_go_on_are_kept() -> None:
    stops = Cycle(
        [Free("30 mm", "0.2 s"), Move("10 mm", "0.2 s"), Move("10 mm", "0.2 s"), Free("-50 mm")], period="1 s"
    )
    assert stops([0.4], 1) == pytest.approx([0.0], abs=1e-12)
    assert stops([0.4], 2) == pytest.approx([0.0], abs=1e-10)
    assert abs(stops(0.2, 1)) < 1e-12
    assert stops.status == "optimal"
    table = Cycle([Free("45 deg", "90 deg"), Free("0 deg")], speed="60 rpm", advance="45 deg")
    assert table(1.0) - table(0.0) == pytest.approx(np.pi / 4)
    assert table(1.0, 1) == pytest.approx(table(0.0, 1), abs=1e-9)


def test_the_proof_of_a_cycle_is_checked_with_every_rounding_enclosed(tmp_path: Path) -> None:
    ways = [Free("30 mm", "0.2 s"), Dwell("0.2 s"), Free("-30 mm")]
    for minimise in ("acceleration", "rms acceleration"):
        (solution,) = Cycle(ways, period="1 s", minimise=minimise, degree=3).solutions
        file = tmp_path / "solution.json"
        file.write_text(json.dumps(solution.to_dict()), "utf-8")
        assert exit_code(["verify", str(file)]) == 0
        law = solution.law.to_dict()
        law["segments"][-1]["acceleration"][0] += 1e-3
        file.write_text(json.dumps(solution.to_dict() | {"law": law}), "utf-8")
        assert exit_code(["verify", str(file)]) != 0


def test_points_on_the_way_of_one_motion_that_repeats() -> None:
    cycle = Cycle([Free("0 mm", via=[("0.25 s", "10 mm"), ("0.5 s", "4 mm")])], period="1 s")
    assert cycle([0.0, 0.25, 0.5]) == pytest.approx([0.0, 0.01, 0.004], abs=1e-12)
    assert cycle.status == "optimal"
    with pytest.raises(InputError, match="nothing to move"):
        Cycle([Free("0 mm")], period="1 s").status  # noqa: B018


@pytest.mark.long
def test_the_least_velocity_is_proven_where_few_pieces_met_badly() -> None:
    """The motion of 37 mm at its mean velocity; in six pieces the one before could not turn from it in time."""
    steps = [
        ("-26 mm", "0.193 s"),
        ("37 mm", "0.196 s"),
        ("-7 mm", "0.106 s"),
        ("5 mm", "0.102 s"),
        ("11 mm", "0.159 s"),
    ]
    turning = Cycle([*(Free(*step) for step in steps), Free(to="0 mm")], period="1 s", minimise="velocity")
    assert turning.status == "optimal"
    assert turning.objective == pytest.approx(0.037 / 0.196, rel=1e-9)
    assert turning.search_space == "all motions through the joints"


def test_velocities_are_the_least_of_their_space_alone_where_no_motion_has_the_least() -> None:
    """From 300 mm/s to -300 mm/s in no time: the more pieces, the nearer."""
    ways = [Free("30 mm", "0.1 s"), Free("-30 mm", "0.1 s"), Free("10 mm", "0.4 s"), Free("-10 mm")]
    few, many = (Cycle(ways, period="1 s", minimise="velocity", degree=degree) for degree in (3, 9))
    assert few.status == many.status == "optimal"
    assert few.objective > many.objective > 0.3
    assert many.search_space == "splines of degree 3 in 24 pieces"


# --- least root mean squares ---


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
    free = Cycle(ways, period="1 s", minimise="rms jerk", degree=5)
    wide, narrow = (
        Cycle(ways, period="1 s", minimise="rms jerk", degree=5, limits={"velocity": f"{share * free.peak(1)!r} m/s"})
        for share in (1.01, 0.99)
    )
    assert wide.objective == pytest.approx(free.objective, rel=1e-9)
    assert wide.search_space == ALL
    assert free.objective < narrow.objective < 1.01 * free.objective
    assert narrow.search_space == "splines of degree 3 in 80 pieces"


@pytest.mark.parametrize(("order", "space"), [(2, ALL), (3, "laws of order 3 with Z of degree 9")])
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


# --- limits at joints ---


MOVES = [Rise("35 mm", "120 deg"), Dwell("60 deg"), Return("35 mm", "120 deg"), Dwell()]
SPRING = {"mass": "2 kg", "stiffness": "3 N/mm", "preload": "44.6 N"}
TOP = r"at its end, at 35 mm and 120 deg of the master, every law takes the force 149\.6 N, but its limit is the force"


def cycle(**given: Any) -> Cycle:
    return Cycle(given.pop("segments", MOVES), **({"speed": "200 rpm"} | given))


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: cycle(drive=SPRING, limits={"force": "140 N"}), rf"segment 1 \(Rise\): {TOP} 140 N: allow more"),
        (lambda: cycle(drive=SPRING, segments=[Rise("35 mm", "120 deg", limits={"force": "90 N"}), *MOVES[1:]]), TOP),
        (lambda: cycle(drive={"dry": "20 N", "mass": "2 kg"}, limits={"force": "15 N"}), r"takes the force 20 N"),
        (lambda: cycle(segments=[Rise("9 deg", "120 deg"), Return(), Dwell("9 deg")], drive={"gravity": "2 N m"},
                       limits={"torque": "1 N m"}), r"every law takes the torque 2 N m"),
        (lambda: Axes({"slide": {"segments": MOVES, "drive": SPRING, "limits": {"force": "9 N"}}}, speed="200 rpm"),
         r"axis slide: segment 1"),
        (lambda: cycle(segments=[Free("35 mm", "90 deg"), Dwell("90 deg"), Free("-35 mm")], drive=SPRING,
                       limits={"force": "140 N"}), r"at its end, at 35 mm and 90 deg of the master"),
    ],
)  # fmt: skip
def test_a_force_that_every_law_takes_at_a_joint_is_told_when_the_cycle_is_made(make: Any, says: str) -> None:
    with pytest.raises(InfeasibleProblem, match=says):
        make()


@pytest.mark.sample(3)
@pytest.mark.parametrize(
    ("limits", "least"),
    [({"force": "29 N"}, "the force 30.3942 N"), ({"velocity": "370 mm/s"}, "the velocity 378.216"),
     ({"velocity": "470 mm/s", "acceleration": "14 m/s^2"}, r"the acceleration 15.1971 m/s\^2")],
)  # fmt: skip
def test_limits_that_no_law_keeps_are_told_in_units_of_the_machine(limits: dict[str, str], least: str) -> None:
    made = cycle(drive={"mass": "2 kg"}, limits=limits)
    with pytest.raises(InfeasibleProblem, match=rf"among laws of order 3 with Z of degree 9 the least is {least}"):
        made.status  # noqa: B018 - laws are looked for when they are asked for


def test_limits_of_the_force_that_joints_need_no_more_than_are_kept() -> None:
    for most in ("149.6 N", "160 N"):
        kept = cycle(drive=SPRING, limits={"force": most})
        assert kept.status == "optimal"
        assert kept.effort.peak_force <= float(most[:-2]) * (1.0 + 1e-9)
    assert cycle(drive=SPRING, order=2, limits={"force": "149.6 N"}).status == "optimal"


def test_of_laws_with_one_peak_of_force_in_a_dwell_that_of_least_acceleration_is_taken() -> None:
    """The spring is pressed most in the dwell: half of all laws take no more force, whatever their acceleration."""
    pressed, calm = cycle(drive=SPRING, minimise="force"), cycle(drive=SPRING)
    assert pressed.objective == pytest.approx(149.6, rel=1e-9)
    assert pressed.status == "optimal"
    assert pressed.lower_bound == pytest.approx(149.6, rel=1e-9)
    assert pressed.peak(2) == pytest.approx(calm.peak(2), rel=1e-9)
    (remark,) = pressed.remarks
    assert remark.startswith("the force is greatest at 120 deg of the master, where no law changes it")
    heavy = cycle(drive=SPRING | {"mass": "20 kg"}, minimise="force")
    assert heavy.remarks == ()
    assert heavy.objective > 149.6


def test_of_laws_with_one_peak_of_velocity_beside_a_given_one_that_of_least_acceleration_is_taken() -> None:
    web = cycle(segments=[ConstantVelocity("500 mm/s", "0.1 s"), Return("50 mm", "0.2 s")], speed=None, period="0.3 s",
                minimise="velocity")  # fmt: skip
    assert web.objective == pytest.approx(0.5, rel=1e-9)
    assert web.status == "optimal"
    assert len(web.remarks) == 2
    other = cycle(segments=web.segments, speed=None, period="0.3 s", limits={"velocity": "500 mm/s"})
    assert web.peak(2) == pytest.approx(other.peak(2), rel=1e-7)
    assert np.abs(web(np.linspace(0.0, 0.3, 301), 1)).max() <= 0.5 * (1.0 + 1e-9)


def test_a_degree_that_is_raised_is_said() -> None:
    shear = [ConstantVelocity("1.5 m/s", "80 ms"), Return()]
    raised, asked = (cycle(segments=shear, speed=None, period="400 ms", degree=degree) for degree in (9, 15))
    assert raised.remarks == ("segment 2 (Return): Z has the degree 15, not 9, for the velocities at its ends",)
    assert asked.remarks == ()
    assert raised.search_space == asked.search_space == "laws of order 3 with Z of degree 15"
    assert "not 9" in raised._repr_html_()
    assert "segment 2 (Return): Z has the degree 15, not 9" in raised.export("codesys-xyva", points=41).text
