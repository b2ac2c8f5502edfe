"""The fastest cycle, against a bisection over whole cycles, closed forms and a linear program over accelerations."""

import json
from dataclasses import replace
from math import sqrt
from typing import Any

import numpy as np
import pytest
from scipy.optimize import linprog

from optlaws import (
    ConstantVelocity,
    Cycle,
    Dwell,
    FastestCycle,
    Free,
    InfeasibleProblem,
    InputError,
    Problem,
    Return,
    Rise,
    SolverFailure,
    fastest,
)
from optlaws.verification import verify_all
from tests.internals.synthesis import time_search

LIMITS = {"velocity": "1 m/s", "acceleration": "20 m/s^2", "jerk": "2000 m/s^3"}
TURNING = [Rise("35 mm", "120 deg"), Dwell("60 deg"), Return("35 mm", "100 deg"), Dwell()]
NEAR = 1e-6


def cycle(**given: Any) -> Cycle:
    return Cycle(given.pop("segments", TURNING), **({"speed": "60 rpm", "limits": LIMITS} | given))


#: free motions that are one law, of which one has an acceleration of its own
JOINED = cycle(segments=[Dwell("72 deg"), Free("30 mm", "144 deg", limits={"acceleration": "8 m/s^2"}), Free("-30 mm")])


def possible(given: Cycle, period: float) -> bool:
    """Whether a cycle has laws within its limits at a period, by looking for them."""
    try:
        return bool(replace(given, speed=None, period=f"{period!r} s").solutions)
    except (InfeasibleProblem, SolverFailure, InputError):
        return False


def bisected(given: Cycle, low: float, high: float, rounds: int = 11) -> tuple[float, float]:
    """Two periods, of which the cycle has laws in the second alone."""
    assert possible(given, high)
    assert not possible(given, low)
    for _ in range(rounds):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if possible(given, middle) else (middle, high)
    return low, high


def keeps(fastest: FastestCycle, **limits: float) -> bool:
    """Whether the laws at the greatest speed keep limits over the whole cycle."""
    orders = {"velocity": 1, "acceleration": 2, "jerk": 3}
    return all(fastest.cycle.peak(orders[name]) <= most * (1.0 + 1e-9) for name, most in limits.items())


@pytest.mark.long
def test_a_turning_cycle_is_as_fast_as_a_bisection_finds() -> None:
    fastest = cycle().fastest()
    low, high = bisected(cycle(), 0.34, 0.35, rounds=4)
    assert low <= fastest.period * (1.0 + NEAR)
    assert fastest.period <= high * (1.0 + NEAR)
    assert fastest.status == "optimal"
    assert fastest.rpm == pytest.approx(60.0 / fastest.period)
    assert fastest.lower_bound == pytest.approx(fastest.period, rel=2e-6)
    assert keeps(fastest, velocity=1.0, acceleration=20.0, jerk=2000.0)
    assert fastest.binding == ("segment 3 (Return): acceleration 20 m/s^2, jerk 2000 m/s^3",)
    rise, back = fastest.segments
    assert rise.least == pytest.approx(back.least, rel=1e-9)
    assert rise.duration == pytest.approx(1.2 * back.duration, rel=1e-9)
    # what has time to spare is the best law, not the fastest
    assert fastest.cycle.peaks[0].peak(2) < 15.0


@pytest.mark.long
@pytest.mark.parametrize(
    ("given", "ends"),
    [
        (cycle(segments=[Rise("35 mm"), Dwell("50 ms"), Return(), Dwell("90 deg")]), (0.30, 0.40)),
        (cycle(segments=[Rise("35 mm", ("80 ms", "1 s")), Dwell("20 ms"), Return("35 mm", "120 deg"), Dwell("20 deg")]),
         (0.25, 0.45)),
        (cycle(segments=[Dwell("72 deg"), Free("30 mm", "144 deg"), Free("-30 mm")]), (0.18, 0.25)),
        (cycle(limits={"acceleration": "20 m/s^2", "deceleration": "12 m/s^2", "velocity": "1 m/s"}), (0.3, 0.4)),
        (JOINED, (0.24, 0.26)),
    ],
)  # fmt: skip
def test_other_cycles_are_as_fast_as_a_bisection_finds(given: Cycle, ends: tuple[float, float]) -> None:
    fastest = given.fastest()
    low, high = bisected(given, *ends)
    assert low * (1.0 - NEAR) <= fastest.period <= high * (1.0 + NEAR)
    assert fastest.status == "optimal"


@pytest.mark.long
def test_joined_motions_with_limits_of_their_own_are_proven() -> None:
    fastest = JOINED.fastest()
    assert fastest.status == "optimal"
    assert fastest.lower_bound == pytest.approx(fastest.period, rel=2e-6)
    assert keeps(fastest, velocity=1.0, acceleration=20.0, jerk=2000.0)
    forth, back = (
        np.abs(np.asarray(fastest.cycle(np.linspace(*ends, 4001) * fastest.period, 2))).max()
        for ends in ((0.2, 0.6 - 1e-9), (0.6 + 1e-9, 1.0))
    )
    assert forth == pytest.approx(8.0, rel=1e-6)
    assert back == pytest.approx(20.0, rel=1e-6)
    assert "acceleration 8 m/s^2" in fastest.binding[0]
    verified = verify_all(json.loads(json.dumps(fastest.claims())))
    assert verified
    assert all(each.proven for each in verified.values())
    # limits as one: 8 m/s² for both is slower, 20 m/s² for both is faster
    alone = replace(JOINED, segments=[Dwell("72 deg"), Free("30 mm", "144 deg"), Free("-30 mm")])
    assert alone.fastest().period < fastest.period


@pytest.mark.long
@pytest.mark.parametrize("steps", [1, 2])
def test_a_search_that_does_not_settle_gives_what_it_came_upon(steps: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Within the limits, no faster than the least, and said to be local; of a single move it is an error."""
    given = cycle(segments=[Dwell("72 deg"), Free("30 mm", "144 deg"), Free("-30 mm")])
    least = given.fastest()
    assert least.status == "optimal"
    monkeypatch.setattr(time_search, "_STEPS", steps)
    local = replace(given).fastest()
    assert (local.status, local.proofs) == ("local", {})
    assert local.period > least.period
    assert keeps(local, acceleration=20.0, jerk=2000.0, velocity=1.0)
    with pytest.raises(SolverFailure, match="did not settle"):
        fastest(Problem(order=3), stroke="100 mm", limits={"jerk": "300 m/s^3", "velocity": "0.6 m/s"})


@pytest.mark.long
def test_eight_free_motions_are_one_law_that_is_proven() -> None:
    ways = (10, -4, 15, -12, 20, -9, -14, -6)
    least = cycle(segments=[Dwell("40 deg"), *(Free(f"{way} mm", "40 deg") for way in ways)]).fastest()
    assert least.status == "optimal"
    assert least.period == pytest.approx(0.44823965, rel=1e-6)
    assert keeps(least, acceleration=20.0, jerk=2000.0)


def test_given_laws_have_closed_forms() -> None:
    """The least time of a law is the greatest root of its peak times the stroke over the limit."""
    segments = [
        Rise("35 mm", "120 deg", law="modified sine"),
        Dwell("60 deg"),
        Return("35 mm", "100 deg", law="cycloidal"),
        Dwell(),
    ]
    fastest = cycle(segments=segments).fastest()
    h = 0.035
    return_time = max(h * 2.0 / 1.0, sqrt(h * 2.0 * np.pi / 20.0), (h * 4.0 * np.pi**2 / 2000.0) ** (1 / 3))
    assert fastest.segments[1].least == pytest.approx(return_time, rel=1e-9)
    assert fastest.period == pytest.approx(max(return_time * 360 / 100, fastest.segments[0].least * 3.0), rel=1e-9)
    assert (fastest.status.value, fastest.proofs) == ("optimal", {})


def test_no_motion_beats_a_linear_program_over_accelerations() -> None:
    """The velocity that is reached on the way is bounded by all motions on a fine grid: a law of few pieces is near."""
    fastest = cycle(segments=[Rise("35 mm", "180 deg"), Return()], degree=19, order=3).fastest()
    least = 0.5 * fastest.period

    def reached(time: float, n: int = 400) -> float:
        """The greatest displacement in a time, of accelerations that are linear between grid points."""
        step = time / n
        weights = np.full(n + 1, step)
        weights[[0, -1]] *= 0.5
        times = np.linspace(0.0, time, n + 1)
        rows = np.eye(n + 1, k=1)[:-1] - np.eye(n + 1)[:-1]
        most = step * (np.tril(np.ones((n + 1, n + 1))) - 0.5 * np.eye(n + 1))
        most[:, 0] -= 0.5 * step
        ends = np.zeros((2, n + 1))
        ends[0, 0] = ends[1, -1] = 1.0
        result = linprog(
            -weights * (time - times),
            A_ub=np.vstack([rows, -rows, most]),
            b_ub=np.concatenate([np.full(2 * n, 2000.0 * step), np.full(n + 1, 1.0)]),
            A_eq=np.vstack([weights, ends]),
            b_eq=np.zeros(3),
            bounds=(-20.0, 20.0),
        )
        assert result.fun is not None
        return float(-result.fun)

    assert reached(least) >= 0.035 * (1.0 - 1e-4)
    assert reached(0.985 * least) < 0.035


def test_the_proofs_are_verified_from_their_file() -> None:
    fastest = cycle().fastest()
    claims = json.loads(json.dumps(fastest.claims()))
    verified = verify_all(claims)
    assert len(verified) == 1
    assert all(entry.infeasible and all(claim.proven for claim in entry.claims) for entry in verified.values())
    name = next(iter(fastest.proofs))
    assert name == "segment 3 (Return)"
    for problem in (claims[name]["asked"], claims[name]["proof"]["problem"]):
        assert problem["C"][1] > 3.0
        problem["C"] = [0.0, 1e6]
    assert not any(entry.infeasible for entry in verify_all(claims).values())


@pytest.mark.long
def test_gains_are_those_of_a_cycle_with_a_higher_limit() -> None:
    fastest = cycle().fastest()
    by_name = {gain.limit: gain for gain in fastest.gains}
    assert set(by_name) == {"acceleration", "jerk"}
    higher = cycle(limits=LIMITS | {"acceleration": "22 m/s^2"}).fastest()
    assert by_name["acceleration"].speed == pytest.approx(higher.speed, rel=1e-9)
    assert str(by_name["acceleration"]) == "10 % more acceleration: 178.809 rpm, 2.68 % faster"
    # to the first order a tenth of the multiplier over the mean power of the limits, of which each tenth gives less
    multipliers = {2: 0.7577, 3: 0.2423}
    first = 0.1 * multipliers[2] / sum(nu * share for nu, share in multipliers.items())
    assert 0.7 * first < by_name["acceleration"].ratio - 1.0 < first


def test_free_motions_need_their_time_search_beside_dwells_that_stay() -> None:
    segments = [Rise("35 mm"), Dwell("50 ms"), Return(), Dwell("90 deg")]
    fastest = cycle(segments=segments).fastest()
    least = fastest.segments[0].least
    assert fastest.period == pytest.approx((2.0 * least + 0.05) / 0.75, rel=1e-9)
    assert fastest.cycle.durations[1] == pytest.approx(0.05, rel=1e-12)
    assert len(fastest.binding) == len(fastest.proofs) == 2
    # a motion that turns with the master may need more, and the free ones share what is left
    slow = [Rise("35 mm", "60 deg"), Dwell("50 ms"), Return("20 mm"), Dwell("90 deg"), Return("15 mm")]
    shared = cycle(segments=slow).fastest()
    assert shared.binding[0].startswith("segment 1 (Rise)")
    assert shared.segments[1].duration / shared.segments[1].least == pytest.approx(
        shared.segments[2].duration / shared.segments[2].least, rel=1e-9
    )


def test_velocities_turn_with_the_master() -> None:
    shear = [ConstantVelocity("1.5 m/s", "72 deg"), Return()]
    fastest = cycle(segments=shear, limits={"velocity": "3 m/s"}, speed="150 rpm").fastest()
    # the web goes 120 mm in a fifth of the period
    assert fastest.cycle.peaks[0].peak(1) == pytest.approx(0.12 / (0.2 * fastest.period), rel=1e-9)
    assert fastest.cycle.peak(1) <= 3.0 * (1.0 + 1e-9)
    assert max(abs(joint["velocity"]) for joint in fastest.cycle.joints) < 1e-8


@pytest.mark.long
def test_other_units_say_the_same() -> None:
    small = cycle(segments=[Rise("35 um", "120 deg"), Dwell("60 deg"), Return("35 um", "100 deg"), Dwell()],
                  limits={"velocity": "1 mm/s", "acceleration": "20 mm/s^2", "jerk": "2000 mm/s^3"})  # fmt: skip
    assert small.fastest().period == pytest.approx(cycle().fastest().period, rel=1e-9)
    fast = cycle(limits={"velocity": "1e6 m/s", "acceleration": "20e12 m/s^2", "jerk": "2000e18 m/s^3"})
    assert fast.fastest().period == pytest.approx(1e-6 * cycle().fastest().period, rel=1e-9)


@pytest.mark.sample(2)
@pytest.mark.parametrize(
    ("given", "error", "says"),
    [
        ({"limits": {}}, InputError, "no limit bounds the motions"),
        ({"limits": LIMITS | {"load acceleration": "40 m/s^2"}, "load": {"period": "20 ms"}}, InputError,
         "not computed with a load that is minimised or limited"),
        ({"segments": [Rise("35 mm", "0.1 s"), Dwell("0.8 s"), Return("35 mm", "0.1 s")]}, InputError,
         "leave the duration of a segment out, or give angles"),
        ({"segments": [Rise("35 mm", "0.3 s"), Dwell(), Return("35 mm", "0.3 s")]}, InputError,
         r"segment 2 \(Dwell\) has no duration of its own, and would vanish.*give it a least duration"),
        ({"segments": [Rise("35 mm", "50 ms"), Dwell(), Return("35 mm", "120 deg")]}, InfeasibleProblem,
         r"segment 1 \(Rise\) takes 0\.05 s at any speed, but within its limits no law takes less than 0\.0957"),
        ({"segments": [ConstantVelocity("1 m/s", "50 ms"), Return()]}, InputError,
         "give all durations as angles, so that velocities turn with the master"),
        ({"segments": [Rise("35 mm", "120 deg", law="parabolic"), Return()]}, InfeasibleProblem,
         r"segment 1 \(Rise\): its law jumps, so that no speed keeps the jerk 2000 m/s\^3: take a smoother law"),
        ({"segments": [Dwell("10 ms"), Free("30 mm", "0.3 s"), Free("-30 mm")]}, InputError,
         "give all their durations as angles"),
    ],
)  # fmt: skip
def test_what_bounds_no_speed_is_named_with_the_remedy(
    given: dict[str, Any], error: type[Exception], says: str
) -> None:
    with pytest.raises(error, match=says):
        cycle(**given).fastest()


def test_it_is_stored_and_shown() -> None:
    fastest = cycle().fastest()
    again = Cycle.from_json(cycle().to_json()).fastest()
    assert again == fastest
    assert again.period == fastest.period
    text = str(fastest.summary())
    assert "no time left, by acceleration 20 m/s^2, jerk 2000 m/s^3" in text
    assert "20 % to spare" in text
    assert len(fastest.plot()) >= 4
    assert "174.136" in repr(fastest)
    assert "<table" in fastest._repr_html_()


def test_no_laws_of_any_degree_beat_the_limit_of_the_period() -> None:
    """From those of the moves, and by a law that comes near; not known within a drive's force and of ends that move."""
    uneven = {"velocity": "0.6 m/s", "acceleration": "25 m/s^2", "deceleration": "15 m/s^2", "jerk": "2500 m/s^3"}
    segments = [Rise("60 mm"), Dwell("40 ms"), Dwell("90 deg"), Return("60 mm", ("10 ms", "1 s"))]
    free = cycle(segments=segments, limits=uneven).fastest()
    move = fastest(Problem(order=3), stroke="60 mm", limits=uneven)
    assert move.best_possible is not None
    assert free.best_possible == pytest.approx((2.0 * move.best_possible + 0.04) / 0.75, rel=1e-12)
    assert move.best_possible < free.segments[0].least
    turning = cycle(order=3, degree=13).fastest()
    plain = fastest(Problem(order=3), stroke="35 mm", limits=LIMITS).best_possible
    assert plain is not None
    assert turning.best_possible is not None
    assert turning.best_possible == pytest.approx(plain * 3.6, rel=1e-12)
    assert 1.0 < turning.period / turning.best_possible < 1.02
    given = cycle(segments=[Rise("35 mm", "120 deg", law="cycloidal"), Return("35 mm", law="cycloidal")]).fastest()
    assert given.best_possible == given.period
    for unknown in (
        cycle(drive={"mass": "2 kg"}, limits={"force": "60 N"}),
        cycle(segments=[Dwell("72 deg"), Free("30 mm", "144 deg"), Free("-30 mm")], degree=3),
    ):
        row = next(row for row in unknown.fastest().proof_rows() if row.name == "best possible")
        assert row.value == "not known"
