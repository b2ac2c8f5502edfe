"""Whole cycles as one law that repeats: joints that are all free, dwells on the way, points and limits of parts."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from scipy.optimize import linprog

from optlaws import ConstantVelocity, Cycle, Dwell, Free, InputError, Move, PeriodicPieces
from tests.internals.cli import exit_code
from tests.internals.cycles import halved

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
    cycle = Cycle(WAYS, period="1 s", degree=15)
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
    cycle = Cycle(WAYS, period="1 s", minimise=minimise)
    (solution,) = cycle.solutions
    assert isinstance(solution.problem.basis, PeriodicPieces)
    assert cycle.status == "optimal"
    assert cycle(TIMES[:-1]) == pytest.approx(PLACES[:-1], abs=1e-11)
    assert len(cycle.joints) == len(WAYS)
    assert all(joint["velocity"] == joint["acceleration"] == 0.0 for joint in cycle.joints)
    turned = Cycle([*WAYS[2:], *WAYS[:2]], period="1 s", minimise=minimise, start="50 mm")
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


def test_halved_pieces_keep_what_is_straight() -> None:
    assert halved(PeriodicPieces((0.0, 0.5, 0.75, 1.0), 3, 2, (1,))) == PeriodicPieces(
        (0.0, 0.25, 0.5, 0.75, 0.875, 1.0), 3, 2, (2,)
    )
    assert halved(PeriodicPieces(400, 3, 2)) is None
