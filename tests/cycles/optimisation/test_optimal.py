"""What is optimal of whole cycles: single optima where they decouple, closed forms where durations are free."""

import re
import time
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.optimize import minimize

from optlaws import (
    Chebyshev,
    ConstantVelocity,
    Cycle,
    Dwell,
    Free,
    InfeasibleProblem,
    InputError,
    Move,
    Problem,
    Return,
    Rise,
    at_most,
    synthesize,
)

FIVE: list[Any] = [Rise("35 mm"), Dwell("90 deg"), Rise("10 mm"), Dwell("20 deg"), Return()]


@pytest.mark.parametrize(
    ("minimise", "objective", "nu"), [("acceleration", "C", 2), ("jerk", "J", 3), ("rms acceleration", "rms_c", 2)]
)
def test_between_dwells_a_cycle_decouples_into_single_optima(minimise: str, objective: str, nu: int) -> None:
    segments = [Rise("35 mm", "120 deg"), Dwell("90 deg"), Return("35 mm", "100 deg"), Dwell()]
    cycle = Cycle(segments, speed="200 rpm", minimise=minimise, limits={"velocity": "616 mm/s"})
    limits = [0.616 * duration / 0.035 for duration in (0.1, 0.3 * 100 / 360)]
    single = [synthesize(Problem(order=3, B=at_most(b), minimise=objective)) for b in limits]
    assert [solution.objective for solution in cycle.solutions] == pytest.approx(
        [one.objective for one in single], rel=1e-9
    )
    sized = [0.035 / t**nu * one.objective for one, t in zip(single, (0.1, 0.3 * 100 / 360), strict=True)]
    if minimise == "rms acceleration":
        whole = np.sqrt((sized[0] ** 2 * 0.1 + sized[1] ** 2 * 0.3 * 100 / 360) / 0.3)
    else:
        whole = max(sized)
    assert cycle.objective == pytest.approx(whole, rel=1e-9)
    assert cycle.status == "optimal"
    assert cycle.lower_bound == pytest.approx(cycle.objective, rel=1e-8)
    assert cycle.peak(1) <= 0.616 * (1 + 1e-9)


def test_no_law_of_the_whole_cycle_is_better_than_the_decoupled_ones() -> None:
    """The same cycle as one law of its two moves, by another solver: quadratic, with the joints at rest."""
    cycle = Cycle([Rise("35 mm", "0.1 s"), Return("35 mm", "0.2 s")], period="0.3 s", minimise="rms acceleration")
    k = np.linspace(0.0, 1.0, 2001)
    base = 60 * k - 180 * k**2 + 120 * k**3
    powers = [
        np.polynomial.Polynomial([0, 0, 0, 1, -3, 3, -1]) * np.polynomial.Polynomial([0, 1]) ** n for n in range(4)
    ]
    bends = [shape.deriv(2)(k) for shape in powers]

    def cost(x: Any) -> float:
        both = (base + np.tensordot(half, bends, 1) for half in (x[:4], x[4:]))
        squares = [np.trapezoid(one**2, k) for one in both]
        return float((0.035 / 0.1**2) ** 2 * 0.1 * squares[0] + (0.035 / 0.2**2) ** 2 * 0.2 * squares[1]) / 0.3

    optimum = minimize(cost, np.zeros(8), method="BFGS", options={"maxiter": 300})
    assert np.sqrt(optimum.fun) > cycle.objective * (1 - 1e-6)
    assert np.sqrt(optimum.fun) < 1.05 * cycle.objective


@pytest.mark.parametrize(
    ("minimise", "power"),
    [("velocity", 1.0), ("acceleration", 0.5), ("jerk", 1 / 3), ("rms acceleration", 0.5), ("rms jerk", 1 / 3)],
)
@pytest.mark.parametrize("law", ["optimal", "cycloidal"])
def test_free_durations_are_powers_of_the_strokes(minimise: str, power: float, law: str) -> None:
    moves = [Move("35 mm", law=law), Move("10 mm", law=law), Move("-45 mm", law=law)]
    segments = [moves[0], Dwell("90 deg"), moves[1], Dwell("20 deg"), moves[2]]
    cycle = Cycle(segments, speed="200 rpm", minimise=minimise)
    shares = np.array([35.0, 10.0, 45.0]) ** power
    expected = 0.3 * (250 / 360) * shares / shares.sum()
    assert [cycle.durations[i] for i in (0, 2, 4)] == pytest.approx(expected.tolist(), rel=1e-6)
    assert sum(cycle.durations) == pytest.approx(0.3, rel=1e-14)
    assert cycle.status == "optimal"
    assert cycle.lower_bound == pytest.approx(cycle.objective, rel=1e-8)


def test_bounds_of_durations_are_kept_and_the_rest_is_level() -> None:
    segments = [Rise("35 mm", ("50 deg", "80 deg")), Dwell("90 deg"), Rise("10 mm"), Dwell("20 deg"), Return()]
    cycle = Cycle(segments, speed="200 rpm")
    assert cycle.durations[0] == pytest.approx(0.3 * 80 / 360)
    assert cycle.durations[4] / cycle.durations[2] == pytest.approx(np.sqrt(4.5), rel=1e-9)


def test_limits_bend_free_durations_and_no_others_are_better() -> None:
    limits = {"velocity": "0.8 m/s"}
    best = Cycle([Rise("35 mm"), Dwell("110 deg"), Return()], speed="200 rpm", limits=limits)
    uneven = Cycle(FIVE, speed="200 rpm", limits=limits)
    assert best.durations[0] == pytest.approx(best.durations[2], rel=1e-9)
    peaks = [uneven.peaks[i].peak(2) for i in (0, 2, 4)]
    assert peaks == pytest.approx([peaks[0]] * 3, rel=1e-8)
    assert uneven.peak(1) <= 0.8 * (1 + 1e-9)
    free = Cycle(FIVE, speed="200 rpm")
    assert uneven.objective > free.objective
    for i, j in ((0, 2), (2, 4), (4, 0)):
        moved = list(uneven.durations)
        moved[i] += 2e-4
        moved[j] -= 2e-4
        given = [replace(one, duration=f"{t!r} s") for one, t in zip(FIVE, moved, strict=True)]
        assert Cycle(given, period="0.3 s", limits=limits).objective > uneven.objective


def test_free_motions_that_meet_are_one_problem_and_better_than_stops() -> None:
    ways = [Free("30 mm", "0.2 s"), Free("20 mm", "0.2 s", via=[("0.1 s", "50 mm")]), Free("-50 mm", "0.3 s")]
    free = Cycle([Dwell("0.1 s"), *ways, Dwell()], period="1 s")
    stopped = Cycle([Dwell("0.1 s"), Move("30 mm", "0.2 s"), Move("20 mm", "0.2 s"), Move("-50 mm", "0.3 s"), Dwell()],
                    period="1 s")  # fmt: skip
    assert len(free.solutions) == 1
    assert free.status == "optimal"
    assert free.objective < 0.7 * stopped.objective
    assert free([0.3, 0.4, 0.5, 0.8]) == pytest.approx([0.03, 0.05, 0.05, 0.0], abs=1e-12)
    assert all(joint["velocity"] == joint["acceleration"] == 0.0 for joint in free.joints)


def test_limits_of_a_part_hold_there() -> None:
    ways = [Free("30 mm", "0.2 s", limits={"velocity": "170 mm/s"}), Free("20 mm", "0.2 s"), Free("-50 mm", "0.3 s")]
    cycle = Cycle([Dwell("0.1 s"), *ways, Dwell()], period="1 s", degree=5)
    assert cycle.status == "optimal"
    assert cycle.peaks[1].peak(1) <= 0.17 * (1 + 1e-9)
    assert cycle.peak(1) > 0.17


def test_a_flying_shear_matches_the_velocity_of_the_web() -> None:
    cycle = Cycle([ConstantVelocity("500 mm/s", "0.2 s"), Return(duration="0.3 s")], period="0.5 s")
    assert cycle.status == "optimal"
    assert all(joint["velocity"] == joint["acceleration"] == 0.0 for joint in cycle.joints)
    assert cycle([0.0, 0.1, 0.2, 0.5], 1) == pytest.approx([0.5] * 4, rel=1e-9)


@pytest.mark.parametrize("minimise", ["force", "rms force"])
def test_forces_are_least_and_proven(minimise: str) -> None:
    drive = {"mass": "2 kg", "stiffness": "1 N/mm", "dry": "5 N", "viscous": "3 N s/m"}
    segments = [Rise("35 mm", "120 deg"), Dwell("90 deg"), Return("35 mm", "100 deg"), Dwell()]
    best = Cycle(segments, speed="200 rpm", minimise=minimise, drive=drive)
    other = Cycle(segments, speed="200 rpm", drive=drive)
    assert best.status == "optimal"
    assert best.lower_bound == pytest.approx(best.objective, rel=1e-7)
    assert best.objective < getattr(other.effort, minimise.replace(" ", "_") if "rms" in minimise else "peak_force")


def test_five_segments_are_proven_within_a_second() -> None:
    Cycle(FIVE, speed="200 rpm").objective  # noqa: B018 - libraries are imported
    begun = time.process_time()
    cycle = Cycle(FIVE, speed="210 rpm")
    assert cycle.status == "optimal"
    assert cycle.objective > 0.0
    assert time.process_time() - begun < 1.0


def problem_of(*segments: Any, place: int = 0, **others: Any) -> Problem:
    return Cycle(list(segments), **{"period": "0.4 s", **others}).solutions[place].problem


def test_the_velocities_of_neighbours_are_end_conditions() -> None:
    cut = (ConstantVelocity("1.5 m/s", "80 ms"), Return())
    asked = problem_of(*cut)
    # -0.12 m in 0.32 s
    assert asked.conditions.start == pytest.approx((0.0, -4.0, 0.0))
    assert asked.conditions.end == pytest.approx((1.0, -4.0, 0.0))
    assert (asked.order, asked.symmetric, asked.monotone) == (3, False, False)
    bases = [problem_of(*cut, degree=degree).basis for degree in (9, 15, 21)]
    assert bases == [Chebyshev(15), Chebyshev(15), Chebyshev(21)]
    rise = (Rise("35 mm", "0.1 s"), Return())
    asked = problem_of(*rise, degree=11)
    assert (asked.boundary, asked.basis, asked.symmetric, asked.bounded) == (None, Chebyshev(11), True, ())
    assert problem_of(*rise, order=4).conditions.start == (0.0, 0.0, 0.0, 0.0)


def test_limits_of_a_motion_are_bounds_of_its_law() -> None:
    limits = {"velocity": "700 mm/s", "acceleration": "30 m/s^2", "jerk": "2000 m/s^3"}
    asked = problem_of(Rise("35 mm", "0.1 s"), Return(), limits=limits, minimise="rms jerk")
    highs = {name: asked.range(name).high for name in "BCJ"}  # type: ignore[union-attr]
    assert highs == pytest.approx({"B": 0.7 * 0.1 / 0.035, "C": 30 * 0.1**2 / 0.035, "J": 2000 * 0.1**3 / 0.035})
    assert str(asked.minimise) == "rms_j"
    assert asked.windows == ()
    back = problem_of(Rise("35 mm", "0.1 s"), Return(), limits=limits, place=1)
    assert back.range("B").high == pytest.approx(0.7 * 0.3 / 0.035)  # type: ignore[union-attr]


def test_limits_of_one_side_are_bounds_of_that_side_of_the_law() -> None:
    limits = {"velocity": ("-500 mm/s", "700 mm/s"), "acceleration": ("-20 m/s^2", "30 m/s^2")}
    for place, duration in enumerate((0.1, 0.3)):
        asked = problem_of(Rise("35 mm", "0.1 s"), Return(), limits=limits, place=place)
        low, high = ("low", "high") if place == 0 else ("high", "low")
        plus, minus = ("C_plus", "C_minus") if place == 0 else ("C_minus", "C_plus")
        assert {str(constant): best.high for constant, best in asked.bounded} == pytest.approx(
            {
                f"peak(b, side={low})": 0.5 * duration / 0.035,
                f"peak(b, side={high})": 0.7 * duration / 0.035,
                minus: 20.0 * duration**2 / 0.035,
                plus: 30.0 * duration**2 / 0.035,
            }
        )


def test_a_motion_backwards_is_measured_by_the_limit_backwards() -> None:
    ways = [Free("60 mm", "0.2 s"), ConstantVelocity("500 mm/s", "0.1 s"), Free(to="0 mm", duration="0.2 s")]
    with pytest.raises(InfeasibleProblem, match=r"110 mm in 0.2 s are 550 mm/s on average, .* at most 400 mm/s"):
        assert Cycle([*ways, Dwell()], period="0.6 s", limits={"velocity": ("-400 mm/s", "600 mm/s")}).status


@pytest.mark.parametrize(
    ("minimised", "given"),
    [
        (("velocity", "jerk"), {"limits": {"jerk": "1000 m/s^3"}}),
        (("force", "acceleration"), {"drive": {"mass": "2 kg"}}),
    ],
)
def test_the_space_is_that_of_the_greatest_derivative_that_counts(
    minimised: tuple[str, str], given: dict[str, Any]
) -> None:
    ways = [Free("30 mm", "0.2 s"), Free("20 mm", "0.2 s"), Free("-50 mm", "0.3 s"), Dwell()]
    first, second = (problem_of(*ways, period="1 s", minimise=name, degree=5, **given).basis for name in minimised)
    assert first == second


def test_a_snap_is_limited_in_the_whole_law_where_others_are_in_parts() -> None:
    ways = [Free("30 mm", "0.2 s", limits={"velocity": "250 mm/s"}), Free("-30 mm", "0.2 s")]
    cycle = Cycle([*ways, Dwell()], period="1 s", order=4, degree=5, limits={"snap": "1e7 mm/s^4"})
    (solution,), (piece, *_) = cycle.solutions, cycle.pieces
    assert [str(constant) for constant, _ in solution.problem.bounded] == ["snap"]
    snap = solution.problem.range("snap")
    assert snap is not None
    assert snap.high == pytest.approx(1e4 * piece.duration**4 / abs(piece.stroke))
    assert piece.law.peak(4).value <= snap.high * (1 + 1e-9)
    assert cycle.peaks[0].peak(1) <= 0.25 * (1 + 1e-9)


def test_a_motion_against_dry_friction_never_goes_back() -> None:
    rise = (Rise("35 mm", "0.1 s"), Return())
    for drive, forward in (({"mass": "2 kg"}, False), ({"mass": "2 kg", "dry": "3 N"}, True)):
        asked = problem_of(*rise, minimise="force", drive=drive)
        assert (asked.symmetric, asked.monotone) == (False, forward)
        asked = problem_of(*rise, minimise="rms force", drive=drive)
        assert (asked.symmetric, asked.monotone) == (False, forward)
        assert problem_of(*rise, minimise="acceleration", drive=drive).symmetric


def test_what_comes_back_is_measured_by_how_far_it_gets() -> None:
    way = Free("0 mm", "0.2 s", via=[("0.05 s", "10 mm"), ("0.15 s", "-30 mm")])
    cycle = Cycle([way, Dwell()], period="0.4 s")
    assert cycle.pieces[0].stroke == pytest.approx(0.03)
    assert cycle(0.05) == pytest.approx(0.01, abs=1e-9)
    assert cycle(0.15) == pytest.approx(-0.03, abs=1e-9)
    with pytest.raises(InputError, match=r"segment 1 \(Move\) has nothing to move: take a Dwell"):
        assert Cycle([Move("0 mm", "0.1 s"), Dwell()], period="0.4 s").status


def quick(most: str) -> Cycle:
    return Cycle([Rise("35 mm", "0.1 s", limits={"velocity": most}), Return(duration="0.2 s")], period="0.3 s")


def test_limits_that_cannot_be_kept_name_the_segment() -> None:
    with pytest.raises(InfeasibleProblem, match=r"segment 1 \(Rise\): 35 mm in 0.1 s are 350 mm/s on average"):
        assert quick("300 mm/s").status
    least = r"segment 1 \(Rise\): no law keeps its limits in 0.1 s: .* the least is the velocity 378.216123 mm/s, but"
    with pytest.raises(InfeasibleProblem, match=f"{least} its limit is the velocity 355 mm/s"):
        assert quick("355 mm/s").status
    with pytest.raises(InfeasibleProblem, match="no durations of the free moves keep the limits"):
        assert Cycle(FIVE, speed="200 rpm", limits={"velocity": "300 mm/s"}).durations
    with pytest.raises(InputError, match="limits: velocity must be a velocity"):
        Cycle(FIVE, speed="200 rpm", limits={"velocity": "300 mm"})


@pytest.mark.parametrize(
    ("limits", "least"),
    [
        ({"velocity": "0.5 m/s", "acceleration": "5 m/s^2"}, 0.1 / 0.5 + 0.5 / 5.0),
        ({"acceleration": ("-5 m/s^2", "10 m/s^2")}, (2.0 * 0.1 * (1.0 / 5.0 + 1.0 / 10.0)) ** 0.5),
        ({"jerk": "100 m/s^3"}, (32.0 * 0.1 / 100.0) ** (1.0 / 3.0)),
    ],
)
def test_all_moves_that_are_too_short_are_named_with_their_least_times(limits: dict[str, Any], least: float) -> None:
    moves = [Rise("100 mm", "60 deg", name="Up"), Dwell("30 deg"), Return("100 mm", "50 deg", name="Down"), Dwell()]
    with pytest.raises(InfeasibleProblem) as refused:
        Cycle(moves, speed="60 rpm", limits=limits).solve()
    number = rf"within its limits any law takes {least:.6g} s \({360.0 * least:.6g} deg\) or more, and it has"
    for move, has in (("1 \\(Up", "0.166667 s"), ("3 \\(Down", "0.138889 s")):
        assert re.search(rf"segment {move}\): {number} {has}", str(refused.value))
    slow = Cycle(moves, period=f"{least / (50.0 / 360.0) * 1.5} s", limits=limits)
    assert slow.solve().peaks


def test_richer_laws_are_better() -> None:
    assert Cycle(FIVE, speed="200 rpm", degree=15).objective < Cycle(FIVE, speed="200 rpm").objective
    assert Cycle(FIVE, speed="200 rpm").solutions[0].problem.basis == Chebyshev(9)


def test_a_cycle_within_modified_sines_jerk_has_less_acceleration_than_modified_sine() -> None:
    def programme(law: str) -> list[Any]:
        return [Rise("35 mm", "120 deg", law=law), Dwell("90 deg"), Return(duration="100 deg", law=law), Dwell()]

    cycle, usual = (Cycle(programme(law), speed="200 rpm") for law in ("optimal", "modified sine"))
    gentle = cycle.with_modified_sine_jerk()
    assert cycle.modified_sine_jerk == pytest.approx(usual.peak(3), rel=1e-12)
    assert gentle.status == "optimal"
    assert usual.peak(3) <= gentle.peak(3) * (1 + 1e-12) <= usual.peak(3) * (1 + 2e-6)
    assert cycle.objective < gentle.objective < 0.9 * usual.peak(2)
    rows = {row.name: row for row in cycle.summary()}
    beside = {row[0]: tuple(row[1:3]) for row in cycle.report().tables[1].rows}
    assert beside["jerk"] == (usual.peak(3), cycle.peak(3))
    assert beside["acceleration"] == (usual.peak(2), cycle.peak(2))
    offered = rows["least acceleration with no more jerk than modified sine"]
    assert offered.value == gentle.objective
    assert offered.note == f'limits={{"jerk": "{gentle.limits["jerk"]}"}}'


@pytest.mark.parametrize(
    "given",
    [
        {"limits": {"jerk": "9000 m/s^3"}},
        {"limits": {"snap": "9e6 m/s^4"}, "order": 4},
        {"minimise": "jerk"},
        {"segments": [ConstantVelocity("1.5 m/s", "80 ms"), Return()]},
    ],
)
def test_modified_sines_jerk_stands_beside_free_jerks_between_rests_alone(given: dict[str, Any]) -> None:
    segments = [Rise("35 mm", "120 deg"), Dwell("90 deg"), Return(duration="100 deg"), Dwell()]
    cycle = Cycle(**{"segments": segments, "period": "0.3 s", **given})
    assert cycle.modified_sine_jerk is None
    with pytest.raises(InputError, match=r"limits=\{.jerk."):
        cycle.with_modified_sine_jerk()


def test_a_cycle_whose_limits_leave_no_law_within_that_jerk_says_so() -> None:
    segments = [Rise("35 mm", "120 deg"), Dwell("90 deg"), Return(duration="100 deg"), Dwell()]
    rows = {row.name: row for row in Cycle(segments, speed="200 rpm", limits={"velocity": "480 mm/s"}).summary()}
    assert (
        rows["least acceleration with no more jerk than modified sine"].value
        == "none was found within the other limits"
    )
