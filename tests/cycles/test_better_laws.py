"""Better laws in the moves of old cams: against a linear program, with moving ends, at crests, in small tolerances."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.optimize import linprog

from optlaws import Cycle, Dwell, InputError, MotionLaw, Return, Rise, catalogue, read_cycle_table, split_table
from tests.cycles.test_cam_files import units_of
from tests.cycles.test_old_motions import valve_lift
from tests.internals.cycles import law_of_move

QUINTIC = np.polynomial.Polynomial([0, 0, 0, 10, -15, 6])


def least_acceleration(old: MotionLaw, share: float, ends: np.ndarray, jerk: float, degree: int) -> float:
    """The least C of polynomials near a law, with a, b and c given at both ends: a linear program at 601 places."""
    k = np.linspace(0.0, 1.0, 601)
    series = [np.polynomial.Chebyshev.basis(n, [0.0, 1.0]) for n in range(degree + 1)]
    a, c, j = (np.column_stack([one.deriv(nu)(k) if nu else one(k) for one in series]) for nu in (0, 2, 3))
    at_ends = np.vstack([[one.deriv(nu)(k[[0, -1]]) if nu else one(k[[0, -1]]) for one in series] for nu in range(3)])
    equations = at_ends.reshape(3, degree + 1, 2).transpose(0, 2, 1).reshape(6, degree + 1)
    rows, right, no = [], [], np.zeros((len(k), 1))
    for matrix, low, high, peak in (
        (a, np.asarray(old(k)) - share, np.asarray(old(k)) + share, no),
        (c, np.zeros(len(k)), np.zeros(len(k)), no + 1.0),
        (j, np.full(len(k), -jerk), np.full(len(k), jerk), no),
    ):
        rows += [np.hstack([matrix, -peak]), np.hstack([-matrix, -peak])]
        right += [high, -low]
    answer = linprog(
        [*np.zeros(degree + 1), 1.0],
        A_ub=np.vstack(rows), b_ub=np.concatenate(right),
        A_eq=np.hstack([equations, np.zeros((6, 1))]), b_eq=ends.T.ravel(),
        bounds=(None, None), method="highs",
    )  # fmt: skip
    assert answer.status == 0
    assert answer.fun is not None
    return float(answer.fun)


def two_movers() -> tuple[np.ndarray, np.ndarray]:
    """The second of two movers on a track of 750 mm: it keeps 60 mm in curves and 100 mm on straights."""
    master = np.arange(0, 750.1, 5.0)
    gap = np.full_like(master, 60.0)
    for start, step in ((0, 40), (250, -40)):
        gap += step * QUINTIC(np.clip((master - start) / 100, 0, 1))
    return 0.48 * master, master - gap


def test_moves_that_run_on_in_constant_velocity_are_bettered() -> None:
    old = split_table(*two_movers())
    new = old.bettered(0.2)
    pairs = zip(new.moves, old.moves, strict=True)
    better = [(part, was) for part, was in pairs if part.solution is not None]
    assert len(better) == 2
    for part, was in better[:1]:
        law, before = law_of_move(part), law_of_move(was)
        share = 0.2 / abs(part.stroke)
        ends = np.array(law.boundary_values(3))
        ends[:, 2] = 0.0
        least = least_acceleration(before, share, ends, 1.2 * before.constants.J.value, 21)
        assert least * (1 - 1e-5) <= law.constants.C.value <= least * (1 + 1e-3)
    for gain in new.gains(old):
        assert gain.deviation <= 0.2
        assert not gain.share(2) > -0.1
        assert gain.status == "optimal"
        assert gain.new[1] * (1.0 - 1e-6) <= gain.lower_bound <= gain.new[1]
    cycle = new.cycle(speed="12 rpm")
    for part in new.stretches:
        beside = part.start + np.array([-1e-7, 1e-7])
        assert np.ptp(cycle.at_angle(beside % 360.0, 1)) <= 1e-6 * cycle.peak(1)
        assert np.ptp(cycle.at_angle(beside % 360.0, 2)) <= 1e-4 * cycle.peak(2)


def test_moves_that_turn_without_a_dwell_are_bettered_and_meet() -> None:
    x = np.arange(361.0)
    turn = np.radians(x)
    lift = np.round(10.0 * (1.0 - np.cos(turn)) + 1.5 * (1.0 - np.cos(2.0 * turn)), 3)
    old = split_table(x, lift.tolist(), digit=1e-3)
    new = old.bettered(0.05)
    assert [part.kind for part in new.stretches] == ["rise", "return"]
    assert all(part.solution is not None and part.solution.status.value == "optimal" for part in new.moves)
    for gain in new.gains(old):
        assert gain.share(2) < -0.05
        assert gain.deviation <= 0.05
    up, down = (law_of_move(part) for part in new.moves)
    assert up.c(1.0) < 0.0
    assert up.c(1.0) == pytest.approx(-down.c(0.0), rel=1e-9)


def test_a_corner_stays_and_the_move_at_it_is_bettered() -> None:
    u = np.arange(361.0) % 180.0 / 2.0
    lift = np.where(u <= 60.0, 3.05 * np.sin(np.pi / 2.0 * u / 60.0), np.where(u < 80.0, 3.05 * (80.0 - u) / 20.0, 0.0))
    old = split_table(np.arange(361.0).tolist(), lift.tolist(), tolerance=0.001)
    new = old.bettered(0.1, degree=9)
    rises = [part for part in new.moves if part.line is None and part.corner is None]
    assert len(rises) == 2
    for part, was in zip(rises, (part for part in old.moves if part.line is None), strict=True):
        law = law_of_move(part)
        assert law.b(0.0) == pytest.approx(np.pi / 2.0, rel=1e-3)
        assert abs(law.b(1.0)) < 1e-9
        # of any law from that velocity to rest over its stroke
        assert 1.0 <= law.constants.C.value < 0.92 * law_of_move(was).constants.C.value
    assert new.corners == pytest.approx([0.0, 120.0, 180.0, 300.0])
    with pytest.raises(InputError, match=r"jumps at 0 deg, 120 deg.*: a corner stays, as no law .* is so near"):
        new.cycle(speed="60 rpm")


def test_a_corner_between_a_line_and_a_move_is_taken_away_within_the_tolerance_that_is_named() -> None:
    x, law = np.arange(0.0, 360.1, 0.5), catalogue["3-4-5 polynomial"].law
    y = np.clip((x - 30.0) / 20.0, 0.0, 1.0) + 30.0 * law(np.clip((x - 50.0) / 80.0, 0.0, 1.0))
    old = split_table(x, np.round(y - 31.0 * QUINTIC(np.clip((x - 180.0) / 110.0, 0.0, 1.0)), 4), digit=1e-4)
    small = old.bettered(0.02, degree=9)
    lift = next(part for part in small.moves if part.reason and part.solution is not None)
    assert small.corners == pytest.approx([50.0], abs=1e-2)
    with pytest.raises(InputError, match=r"jumps at 50 deg.* mm none stays"):
        small.cycle(speed="60 rpm")
    smooth = old.bettered(lift.sufficient_tolerance, degree=9)
    assert smooth.corners == ()
    at = np.linspace(0.0, 360.0, 36001)
    assert 0.02 < np.abs(smooth.at(at) - old.at(at)).max() <= lift.sufficient_tolerance * (1.0 + 1e-9)
    rise, _ = smooth.gains(old)
    assert np.isnan(rise.shares(2)[0])  # it was infinite at the corner
    assert rise.new[2] <= 1.2 * rise.old[2] * (1.0 + 1e-9)
    assert smooth.cycle(speed="60 rpm").peak(1) > 0.0


def test_a_tolerance_that_is_too_small_is_named_with_one_that_is_enough() -> None:
    x = np.arange(361.0)
    law = catalogue["simple harmonic"].law
    y = 35.0 * (law(np.clip(x / 120.0, 0, 1)) - law(np.clip((x - 180.0) / 120.0, 0, 1)))
    old = split_table(x, np.round(y, 3), digit=1e-3)
    small = old.bettered(0.02)
    assert [part.law for part in small.moves] == ["simple harmonic"] * 2
    for part in small.moves:
        assert part.reason == "no law of order 3 and degree 15 is so near"
        assert 0.02 < part.sufficient_tolerance < 35.0 / 4.0
        assert "within" in small.reason_in_words(part)
    enough = old.bettered(max(part.sufficient_tolerance for part in small.moves))
    assert all(gain.share(2) < 0.0 for gain in enough.gains(old))


def test_a_valve_without_a_dwell_is_bettered_within_the_tolerance_that_is_named() -> None:
    """Its acceleration jumps at the foot, where new laws begin without: that takes some of the lift."""
    old = split_table(*valve_lift(9.0, 335.0, 575.0))
    small = old.bettered(0.05)
    assert all(part.solution is None and part.reason for part in small.moves)
    (needs,) = [part.sufficient_tolerance for part in small.moves if part.sufficient_tolerance]
    enough = old.bettered(needs)
    assert all(-0.1 < gain.share(2) < 0.0 and gain.deviation <= needs for gain in enough.gains(old))
    cycle = enough.cycle(speed="2000 rpm")
    assert cycle.peak(2) < 1776.53
    for part in enough.stretches:
        beside = part.start + np.array([-1e-7, 1e-7])
        assert np.ptp(cycle.at_angle(beside % 360.0, 2)) <= 1e-4 * cycle.peak(2)


@pytest.mark.sample(3)
@pytest.mark.parametrize("name", ["c99", "codesys-xyva", "codesys-cambuilder", "iec-st", "twincat-nc2", "kas"])
def test_a_cycle_of_least_acceleration_has_no_better_one_after_its_export(name: str, tmp_path: Path) -> None:
    cycle = Cycle(
        [Rise("35 mm", "120 deg"), Dwell("90 deg"), Return("35 mm", "100 deg"), Dwell()],
        speed="200 rpm", minimise="acceleration", order=3, degree=15,
    )  # fmt: skip
    made = cycle.export(name, master="360 deg", unit="mm")
    file = tmp_path / f"cam{made.format.extension}"
    file.write_text(made.text, "utf-8")
    said: dict[str, Any] = {**units_of(made)}
    old = read_cycle_table(file, **said)
    new = old.bettered(0.1)
    assert all(part.solution is None for part in new.moves)
    at = np.linspace(0.0, 360.0, 721)
    assert old.at(at) == pytest.approx(1e3 * np.asarray(cycle.at_angle(at % 360.0)), abs=1e-3)


@pytest.mark.parametrize(("begin", "order"), [(40.0, 3), (0.0, 2)])
def test_corners_between_lines_are_taken_away(begin: float, order: int) -> None:
    """Of a rest, two ramps of other velocity, a crest between lines and a fall, also where the table begins."""
    x = np.arange(0.0, 360.1, 0.5)
    nodes = begin + np.array([0.0, 60.0, 100.0, 160.0])
    y = np.interp(x, nodes, [0.0, 8.0, 18.0, 2.0]) - 2.0 * QUINTIC(np.clip((x - nodes[-1] - 40.0) / 80.0, 0.0, 1.0))
    table = split_table(x, np.round(y, 4), digit=1e-4)
    assert table.corners == pytest.approx(nodes, abs=1e-2)
    with pytest.raises(InputError, match="modernise it within a tolerance"):
        table.cycle(speed="100 rpm")
    smooth = table.bettered(0.05, order=order)
    assert smooth.corners == ()
    at = np.linspace(0.0, 360.0, 36001)
    apart = np.abs(smooth.at(at) - table.at(at))
    assert apart.max() == pytest.approx(0.05, rel=1e-4)
    # each corner is in the middle of its width, as far off as the tolerance allows
    assert np.interp(table.corners, at, apart) == pytest.approx(0.05, rel=1e-2)
    jumps = np.abs(np.diff([0.0, 8.0 / 60.0, 0.25, -16.0 / 60.0, 0.0]))
    most = jumps.max() ** 2 / 0.05 * (1.0 / 8.0 if order == 2 else 9.0 / 64.0)
    blends = [part for part in smooth.moves if part.corner is not None]
    found = max(
        abs(part.stroke) / (part.stop - part.start) ** 2 * law_of_move(part).constants.C.value for part in blends
    )
    assert found == pytest.approx(most, rel=1e-3)
    cycle = smooth.cycle(speed="100 rpm")
    values = cycle.at_angle(at % 360.0, 1)
    assert np.abs(np.diff(values)).max() <= 1.1 * cycle.peak(2) * 0.6 / 36000
    kinds = [gain.kind for gain in smooth.gains(table)]
    assert kinds == ["return"]
