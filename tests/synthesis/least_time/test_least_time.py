"""The least time of a move by methods of its own: closed forms, the shares of limits by HiGHS, ruckig."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import ruckig
from scipy.optimize import linprog

from optlaws import B, C_minus, C_plus, Chebyshev, InfeasibleProblem, InputError, J, Pieces, Problem, Window, catalogue
from tests.internals.synthesis import FollowerResidual, LeastTime, MoveLimits, TimedMove, least_time, segment_times
from tests.synthesis.least_time.otg import fastest_motion
from tests.synthesis.reference import least_share

LIMITS = MoveLimits(velocity=5.0, acceleration=10.0, deceleration=10.0, jerk=30.0)
UNEVEN = MoveLimits(velocity=1.0, acceleration=12.0, deceleration=8.0, jerk=300.0)
CUBIC = {"degree": 3, "continuity": 2}


@pytest.mark.parametrize(
    ("stroke", "limits", "order", "duration"),
    [
        (1.0, MoveLimits(1.0, 1.0, 1.0, 1.0), 3, 32.0 ** (1.0 / 3.0)),
        (2.0, MoveLimits(1.0, 1.0, 1.0, 1.0), 3, 4.0),
        (10.0, LIMITS, 3, 17.0 / 6.0),  # h/v + v/a + a/j
        (3.0, MoveLimits(acceleration=2.0, deceleration=1.0), 2, 3.0),  # sqrt(2 h (1/a + 1/d))
        (3.0, MoveLimits(acceleration=6.0), 2, 1.0),  # it may stop at once
        (1.0, MoveLimits(jerk=12.0), 2, 1.0),  # J = 12 with free accelerations at the ends
        (2.0, MoveLimits(velocity=4.0, jerk=1e-3), 1, 0.5),
    ],
)
def test_the_time_of_all_laws_is_the_closed_form(
    stroke: float, limits: MoveLimits, order: int, duration: float
) -> None:
    segments = segment_times(stroke, limits, order)
    assert segments is not None
    assert segments.duration == pytest.approx(duration, rel=1e-14)
    assert TimedMove(Problem(order=order), stroke, limits).best_possible == segments.duration


def test_the_segments_of_order_2_cover_the_stroke() -> None:
    """Integrated step by step: accelerations that jump at the ends, a constant part and a ramp."""
    limits = MoveLimits(velocity=2.0, acceleration=4.0, deceleration=3.0, jerk=9.0)
    segments = segment_times(5.0, limits, 2)
    assert segments is not None
    signs = [(4.0, 0.0), (4.0, 0.0), (4.0, -9.0), (0.0, 0.0), (0.0, -9.0), (-3.0, 0.0), (-3.0, 0.0)]
    place = velocity = 0.0
    for time, (acceleration, jerk) in zip(segments.times, signs, strict=True):
        place += velocity * time + acceleration * time**2 / 2.0 + jerk * time**3 / 6.0
        velocity += acceleration * time + jerk * time**2 / 2.0
    assert place == pytest.approx(5.0)
    assert velocity == pytest.approx(0.0, abs=1e-12)


def test_pieces_between_the_segments_reach_the_time_of_all_laws() -> None:
    segments = segment_times(10.0, LIMITS, 3)
    assert segments is not None
    breaks = sorted({*segments.breaks, 0.5})
    reached = least_time(TimedMove(Problem(order=3, basis=Pieces(breaks, **CUBIC)), 10.0, LIMITS))
    assert reached.duration == pytest.approx(17.0 / 6.0, rel=1e-10)
    assert reached.price == pytest.approx(0.0, abs=1e-10)


@pytest.mark.long
def test_many_pieces_come_near_the_time_of_all_laws() -> None:
    many = least_time(TimedMove(Problem(order=3, basis=Pieces(64, **CUBIC)), 10.0, LIMITS))
    assert many.price is not None
    assert 0.0 < many.price < 1e-3


def test_in_the_least_time_the_limits_are_just_taken() -> None:
    duration = least_time(TimedMove(Problem(order=3, basis=Chebyshev(6)), 0.1, UNEVEN)).duration
    limits = {"B": 1.0, "C_plus": 12.0, "C_minus": 8.0, "J": 300.0}
    assert least_share(duration, 0.1, limits, order=3, basis=Chebyshev(6)) == pytest.approx(1.0, rel=1e-6)


@pytest.mark.parametrize(("start", "end"), [(0.0, 0.0), (0.4, -0.2)])
def test_the_law_keeps_the_limits_and_no_law_is_proven_faster(start: float, end: float) -> None:
    move = TimedMove(Problem(order=3), 0.1, UNEVEN, start, end)
    found = least_time(move)
    k = np.linspace(0.0, 1.0, 4001)
    velocity, acceleration, jerk = (0.1 * np.asarray(found.law(k, nu)) / found.duration**nu for nu in (1, 2, 3))
    assert np.abs(velocity).max() <= 1.0 + 1e-9
    assert acceleration.max() <= 12.0 * (1.0 + 1e-9)
    assert -acceleration.min() <= 8.0 * (1.0 + 1e-9)
    assert np.abs(jerk).max() <= 300.0 * (1.0 + 1e-9)
    assert velocity[0] == pytest.approx(start, abs=1e-12)
    assert velocity[-1] == pytest.approx(end, abs=1e-12)
    assert found.gap <= 1.001e-6
    assert all(proof.stands(move) for proof in found.proofs)
    assert [proof.longest for proof in found.proofs[:-1]] == [proof.shortest for proof in found.proofs[1:]]


def test_what_more_of_a_limit_saves_is_what_it_saves() -> None:
    move, more = TimedMove(Problem(order=3), 0.1, UNEVEN), 1e-5
    found = least_time(move)
    gains = {name: more * slope for name, slope in found.slopes.items()}
    assert found.binding == ("acceleration", "deceleration", "jerk")
    assert gains["velocity"] == 0.0
    for name in ("acceleration", "jerk"):
        further = least_time(replace(move, limits=move.limits.scaled(name, 1.0 + more)))
        assert 1.0 - further.duration / found.duration == pytest.approx(gains[name], rel=1e-3)


@pytest.mark.long
def test_the_gain_of_ends_that_move() -> None:
    move, more = TimedMove(Problem(order=3), 0.1, UNEVEN, 0.4), 1e-5
    found = least_time(move)
    name = max(found.binding, key=lambda each: found.slopes[each])
    further = least_time(replace(move, limits=move.limits.scaled(name, 1.0 + more)))
    assert 1.0 - further.duration / found.duration == pytest.approx(more * found.slopes[name], rel=1e-3)


@pytest.mark.sample(2)
@pytest.mark.parametrize("unit", [1e-12, 1e9])
def test_units_change_nothing(unit: float) -> None:
    """Metres and seconds in other units, one at a time."""
    plain = least_time(TimedMove(Problem(order=3), 0.1, UNEVEN))
    longer = MoveLimits(**{name: unit * value for name, value in UNEVEN.to_dict().items()})
    assert least_time(TimedMove(Problem(order=3), unit * 0.1, longer)).duration == pytest.approx(
        plain.duration, rel=1e-9
    )
    slower = MoveLimits(1.0 / unit, 12.0 / unit**2, 8.0 / unit**2, 300.0 / unit**3)
    assert least_time(TimedMove(Problem(order=3), 0.1, slower)).duration == pytest.approx(
        plain.duration * unit, rel=1e-9
    )


@pytest.mark.long
def test_a_window_and_motion_forward_alone_take_longer() -> None:
    """0.3 of the stroke at most until half of the time; from a start that is fast, never back."""
    free = least_time(TimedMove(Problem(order=3), 0.1, UNEVEN)).duration
    window = Window("a", high=0.3, stop=0.5)
    late = least_time(TimedMove(Problem(order=3, windows=(window,)), 0.1, UNEVEN))
    assert late.duration > free
    assert max(float(late.law(k)) for k in np.linspace(0.0, 0.5, 200)) <= 0.3 + 1e-9


def random_move(numbers: np.random.Generator, *, moving: bool) -> TimedMove:
    stroke, velocity, acceleration, deceleration, jerk = (10.0 ** numbers.uniform(-1.0, 1.0, 5)).tolist()
    limits = MoveLimits(velocity, acceleration, deceleration, jerk)
    start, end = (velocity * numbers.uniform(-1.0, 1.0, 2)).tolist() if moving else (0.0, 0.0)
    return TimedMove(Problem(order=3), stroke, limits, start, end)


def compare_with_ruckig(count: int, seed: int, *, moving: bool) -> None:
    numbers = np.random.default_rng(seed)
    for _ in range(count):
        move = random_move(numbers, moving=moving)
        duration, breaks = fastest_motion(move)
        space = Problem(order=3, basis=Pieces(breaks, **CUBIC), symmetric=False)
        found = least_time(replace(move, problem=space))
        # the fastest motion is of these pieces, and none is faster
        assert found.duration == pytest.approx(duration, rel=1e-8), move
        if not moving:
            assert move.best_possible == pytest.approx(duration, rel=1e-9)


@pytest.mark.sample(2)
@pytest.mark.parametrize("moving", [False, True])
def test_pieces_are_as_fast_as_ruckig(*, moving: bool) -> None:
    compare_with_ruckig(6, 4, moving=moving)


def test_a_time_far_too_short_is_proven_too_short() -> None:
    """In the first time that is tried as many limits meet as leave the multipliers of their points undetermined."""
    limits = MoveLimits(1.3013104182822175, 1.6301702831466822, 1.3625680854273423, 4.063621510732492)
    move = TimedMove(Problem(order=3), 1.010080648433649, limits, -0.6257313678518021, -0.4773690201320877)
    duration, breaks = fastest_motion(move)
    space = Problem(order=3, basis=Pieces(breaks, **CUBIC), symmetric=False)
    assert least_time(replace(move, problem=space)).duration == pytest.approx(duration, rel=1e-8)


def compare_moving_ends_with_ruckig(count: int, seed: int) -> None:
    """From rest to a velocity and an acceleration; ruckig refuses those that the limits cannot bring about."""
    numbers = np.random.default_rng(seed)
    done = 0
    while done < count:
        move = random_move(numbers, moving=True)
        limits = move.limits
        sides = -float(limits.deceleration or 0.0), float(limits.acceleration or 0.0)
        move = replace(move, start_velocity=0.0, end_acceleration=0.8 * numbers.uniform(*sides))
        try:
            duration, breaks = fastest_motion(move)
        except ruckig.RuckigError:
            continue
        done += 1
        space = Problem(order=3, basis=Pieces(breaks, **CUBIC), symmetric=False)
        found = least_time(replace(move, problem=space))
        assert found.duration == pytest.approx(duration, rel=1e-8), move
        assert found.gap <= 1.001e-6
        assert all(proof.stands(found.move) for proof in found.proofs)


def test_ends_with_an_acceleration_are_as_fast_as_ruckig() -> None:
    compare_moving_ends_with_ruckig(4, 11)


@pytest.mark.long
def test_ends_with_an_acceleration_are_as_fast_as_ruckig_in_many_cases() -> None:
    compare_moving_ends_with_ruckig(500, 12)


def test_an_acceleration_and_a_jerk_at_the_end_are_the_law_s_and_proven_for_every_time() -> None:
    ends: dict[str, Any] = {"end_velocity": 0.6, "end_acceleration": -3.0, "end_jerk": 150.0}
    found = least_time(TimedMove(Problem(order=4), 0.1, UNEVEN, **ends))
    values = [0.1 * float(found.law(1.0, nu)) / found.duration**nu for nu in (1, 2, 3)]
    assert values == pytest.approx(list(ends.values()))
    assert found.move.concave is False
    proof = found.proofs[-1]
    assert proof.stands(found.move)
    # one set of multipliers contradicts the limits at the times between, which are none of the control points
    for share in (0.21, 0.5, 0.83):
        time = proof.shortest + share * (proof.longest - proof.shortest)
        assert replace(proof.certificate, problem=found.move.within(time)).proves_infeasible
    assert not replace(proof, longest=found.duration * 1.01).stands(found.move)
    moved = replace(found.move, end_acceleration=-2.9)
    assert not any(each.stands(moved) for each in found.proofs)


@pytest.mark.parametrize(
    ("problem", "ends", "named"),
    [
        (Problem(order=4), {"end_acceleration": -9.0}, "end_acceleration is beyond the limit of the acceleration"),
        (Problem(order=4), {"end_acceleration": 1.0, "start_velocity": 0.1}, "begins at rest: give no start_velocity"),
        (Problem(order=4), {"end_jerk": 400.0}, "end_jerk is beyond the limit of the jerk"),
        (Problem(order=3), {"end_jerk": 1.0}, "end_jerk needs order >= 4, got order 3"),
        (Problem(order=4), {"end_acceleration": float("nan")}, "end_acceleration"),
        (Problem(order=3), {"start_velocity": 1.5}, "start_velocity is beyond the limit"),
        (Problem(order=1), {"start_velocity": 0.5}, "order >= 2"),
        (Problem(order=2), {"start_velocity": 0.5, "limits": MoveLimits(jerk=1.0)}, "order >= 3"),
        (Problem(order=3, B=1.8), {}, "leaves B free"),
        (Problem(order=3, bounds={"snap": (0.0, 9000.0)}), {}, "leaves snap free"),
        (Problem(order=3, minimise="J"), {}, "minimises nothing else"),
        (Problem(order=3, bounds={"rms_c": (4.0, None)}), {}, "rms_c is bounded from below"),
        (Problem(order=3, inflexion=0.4, symmetric=False), {}, "no inflexion"),
    ],
)
def test_what_no_move_has_is_refused(problem: Problem, ends: dict[str, Any], named: str) -> None:
    with pytest.raises(InputError, match=named):
        TimedMove(problem, 0.1, **{"limits": UNEVEN, **ends})


@pytest.mark.long
@pytest.mark.parametrize("moving", [False, True])
def test_pieces_are_as_fast_as_ruckig_in_many_cases(*, moving: bool) -> None:
    compare_with_ruckig(500, 5, moving=moving)


def compare_limits_with_ruckig(count: int, seed: int) -> None:
    """Velocities at the ends, also at their limit and equal; limits of both ways alike and not; any units."""
    numbers = np.random.default_rng(seed)
    for i in range(count):
        move = random_move(numbers, moving=i % 4 > 0)
        if numbers.uniform() < 0.3:
            move = replace(move, limits=replace(move.limits, deceleration=move.limits.acceleration))
        if numbers.uniform() < 0.1:
            move = replace(move, end_velocity=move.start_velocity)
        if numbers.uniform() < 0.1:
            move = replace(move, start_velocity=float(move.limits.velocity or 0.0))
        time = fastest_motion(move)[0]
        assert move.best_possible == pytest.approx(time, rel=1e-12), move
        far, long = (10.0 ** numbers.uniform(-12.0, 9.0, 2)).tolist()
        assert in_units(move, far, long).best_possible == pytest.approx(time * long, rel=1e-12), move


def in_units(move: TimedMove, far: float, long: float) -> TimedMove:
    """The same move in other units of length and time."""
    orders = {"velocity": 1, "acceleration": 2, "deceleration": 2, "jerk": 3}
    limits = {name: value * far / long ** orders[name] for name, value in move.limits.to_dict().items()}
    ends = (move.start_velocity * far / long, move.end_velocity * far / long)
    return TimedMove(move.problem, move.stroke * far, MoveLimits(**limits), *ends)


def test_the_limit_of_all_laws_is_that_of_ruckig() -> None:
    compare_limits_with_ruckig(300, 3)


@pytest.mark.long
def test_the_limit_of_all_laws_is_that_of_ruckig_in_many_cases() -> None:
    compare_limits_with_ruckig(10_000, 4)


@pytest.mark.sample(3)
@pytest.mark.parametrize("seed", range(12))
def test_pieces_with_the_breaks_of_the_limit_reach_it(seed: int) -> None:
    """Some limits alone, ends that move, also backwards."""
    numbers = np.random.default_rng(seed)
    move = random_move(numbers, moving=True)
    names = [name for name in ("velocity", "acceleration") if numbers.uniform() < 0.5]
    sides = {"velocity": ["velocity"], "acceleration": ["acceleration", "deceleration"]}
    left_out = {each: None for name in names for each in sides[name]}
    move = replace(move, limits=replace(move.limits, **left_out))
    found = least_time(move)
    assert found.best_possible is not None
    assert found.price is not None
    assert found.price > -1e-9
    space = replace(move.problem, basis=Pieces(move.limit_breaks, **CUBIC))
    assert least_time(replace(move, problem=space)).duration == pytest.approx(found.best_possible, rel=1e-9)


def linear_program(move: TimedMove, duration: float, steps: int) -> bool:
    """Whether velocities on a grid keep the limits of velocity and acceleration and cover the stroke."""
    limits, h = move.limits, duration / steps
    differences = np.diff(np.eye(steps + 1), axis=0) / h
    whole = np.full(steps + 1, h)
    whole[[0, -1]] *= 0.5
    ends = np.eye(steps + 1)[[0, -1]]
    found = linprog(
        np.zeros(steps + 1),
        A_ub=np.vstack([differences, -differences]),
        b_ub=np.repeat([limits.acceleration, limits.deceleration], steps),
        A_eq=np.vstack([whole, ends]),
        b_eq=[move.stroke, move.start_velocity, move.end_velocity],
        bounds=(0.0 if move.problem.monotone else -float(limits.velocity or 0.0), limits.velocity),
    )
    return bool(found.status == 0)


@pytest.mark.sample(3)
@pytest.mark.parametrize("forward", [False, True])
@pytest.mark.parametrize("seed", range(6))
def test_the_limit_without_a_jerk_is_that_of_a_linear_program(seed: int, *, forward: bool) -> None:
    """At order 2 and never turning back as well, for short strokes; with a jerk it is a lower bound there."""
    numbers = np.random.default_rng(seed)
    move = random_move(numbers, moving=True)
    ends = sorted((abs(move.start_velocity), abs(move.end_velocity)), reverse=seed % 2 == 0)
    plain, sides = replace(move.limits, jerk=None), (move.limits.deceleration, move.limits.acceleration)
    stopping = sum(0.5 * end**2 / float(side or 1.0) for end, side in zip(ends, sides, strict=True))
    stroke = (1.02 if forward else 0.6) * stopping
    problem = Problem(order=2, monotone=forward)
    move = TimedMove(problem, stroke, plain, ends[0], ends[1])
    known = move.best_possible
    assert known is not None
    assert linear_program(move, known * 1.001, 1000)
    assert not linear_program(move, known * 0.999, 1000)
    jerked = replace(move, limits=replace(plain, jerk=1e3))
    assert jerked.best_possible == known
    smooth = replace(jerked, problem=replace(problem, order=3)).best_possible
    assert smooth is not None
    assert smooth > known


def test_no_limit_is_known_of_an_acceleration_at_the_end() -> None:
    assert TimedMove(Problem(order=3), 1.0, UNEVEN, 0.0, 0.5, end_acceleration=1.0).best_possible is None


def test_a_file_from_before_the_limit_of_ends_that_move_is_read() -> None:
    move = least_time(TimedMove(Problem(order=3), 0.1, UNEVEN, 0.3))
    assert LeastTime.from_dict(move.to_dict() | {"best_possible": None}).best_possible == move.best_possible
    with pytest.raises(InputError, match="best possible"):
        LeastTime.from_dict(move.to_dict() | {"best_possible": 0.9 * float(move.best_possible or 0.0)})
    still = least_time(TimedMove(Problem(order=3), 0.1, UNEVEN))
    with pytest.raises(InputError, match="best possible"):
        LeastTime.from_dict(still.to_dict() | {"best_possible": None})


@pytest.mark.long
def test_polynomials_are_slower_than_ruckig() -> None:
    numbers = np.random.default_rng(6)
    for _ in range(2):
        move = random_move(numbers, moving=True)
        assert least_time(move).duration >= fastest_motion(move)[0] * (1.0 - 1e-9)


def test_limits_that_any_time_keeps_are_refused() -> None:
    with pytest.raises(InputError, match="in any time"):
        least_time(TimedMove(Problem(order=1), 1.0, MoveLimits(jerk=1.0)))


def test_windows_that_no_law_keeps_are_named() -> None:
    windows = (Window("a", low=0.6, start=0.5, stop=0.5), Window("a", high=0.4, start=0.5, stop=0.5))
    problem = Problem(order=3, windows=windows, symmetric=False)
    with pytest.raises(InfeasibleProblem, match="no time is long enough") as caught:
        least_time(TimedMove(problem, 1.0, UNEVEN))
    assert caught.value.proof is not None


def test_a_deceleration_alone_is_a_limit_of_the_end() -> None:
    """The mirror image of an acceleration alone."""
    forward = least_time(TimedMove(Problem(order=2), 1.0, MoveLimits(acceleration=2.0), 0.3, 0.5))
    backward = least_time(TimedMove(Problem(order=2), 1.0, MoveLimits(deceleration=2.0), 0.5, 0.3))
    assert backward.duration == pytest.approx(forward.duration, rel=1e-9)


@pytest.mark.sample(2)
@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("of", ["acceleration", "displacement"])
@pytest.mark.parametrize("limits", [{"acceleration": 9.0, "deceleration": 7.0}, {"velocity": 2.5}, {"jerk": 90.0}])
def test_what_a_law_keeps_in_a_time_it_keeps_in_every_box_of_that_time(
    limits: dict[str, float], of: str, seed: int
) -> None:
    """Random laws, times, frequencies and dampings: with just what is left of them, in boxes wide and narrow."""
    random = np.random.default_rng(seed)
    law = catalogue["modified sine" if seed % 2 else "3-4-5 polynomial"].law
    duration, stroke = random.uniform(0.5, 2.0), random.uniform(0.5, 2.0)
    damping = float(random.choice([0.0, 0.05, 0.3]))
    low = random.uniform(3.0, 60.0) / duration
    high = low * float(random.choice([1.0, 1.0001, 1.2]))
    left = FollowerResidual(low, high, damping, 1.0, of).limit_in(duration, stroke).constant.value(law)
    most = left * stroke / (1.0 if of == "displacement" else duration**2)
    peaks = {"velocity": B, "acceleration": C_plus, "deceleration": C_minus, "jerk": J}
    move = TimedMove(
        Problem(order=3),
        stroke,
        MoveLimits(**{each: peaks[each].value(law) * stroke / duration ** peaks[each].nu for each in limits}),
        residual=FollowerResidual(low, high, damping, most, of),
    )
    for width in (1e-12, 1e-6, 1e-3, 0.05):
        before = random.uniform(0.0, 1.0) * width
        box = move.limits_over(duration * (1.0 - before), duration * (1.0 + width - before))
        assert all(limit.constant.value(law) <= limit.bound * (1.0 + 1e-12) for limit in box)
        assert box[-1].name == f"residual {of}"
    assert box[-1].bound >= left
