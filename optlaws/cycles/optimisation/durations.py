"""Free durations with a fixed total: the least peak is level, the least sum of squares has equal slopes.

The least peak of a move falls as its duration grows, so that the greatest of them is least where all are equal, but for
those at a bound. The mean square of a move of one shape is h² r²/T^(2n-1) in its own time, which is convex, so that
their sum is least where the slopes are equal. Moves of one law thus take T ~ h^(1/n) for the peak of the n-th
derivative, and T ~ h^(2/(2n)) = h^(1/n) for its root mean square.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from math import inf, log2

import numpy as np
from numpy.typing import NDArray

from optlaws.cycles.optimisation.objectives import CycleObjective
from optlaws.cycles.optimisation.optimal import span_problem, unlimited
from optlaws.cycles.specification.joints import LawSpan, State
from optlaws.cycles.specification.limits import greatest
from optlaws.cycles.specification.programme import Programme, TimedSegment, is_optimal
from optlaws.cycles.specification.segments import ConstantVelocity, Dwell, Free, Move
from optlaws.errors import InfeasibleProblem, InputError
from optlaws.laws import MotionLaw
from optlaws.motion.piece import factor, named_law
from optlaws.motion.quantities import Kind
from optlaws.numerics.roots import bisect
from optlaws.synthesis.problem.constants import FUNCTIONALS
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.solution import Solution
from optlaws.synthesis.solve import synthesize
from optlaws.tolerances import AGREEMENT, CLOSURE, DURATION_STEP, SAME_TIME

_SHORTEST_MOVE = 1e-6  # of a period: no shorter move is tried

_REST = State(0.0, 0.0)
_ROUNDS = 30
_TOO_FAST = "no durations of the free moves keep the limits: slow the cycle down or widen limits"


@dataclass(frozen=True)
class Share:
    """A move whose duration is free: its peak, or the integral of the square, over its duration, in SI units.

    No law that keeps the limit of the velocity is shorter than `quickest`.
    """

    stretch: TimedSegment
    cost: Callable[[float], float]
    quickest: float


def durations(programme: Programme, objective: CycleObjective) -> tuple[float, ...]:
    """The durations of all stretches: given ones, and optimal ones where they are free."""
    free = [i for i, stretch in enumerate(programme.stretches) if not stretch.fixed]
    if not free:
        return tuple(stretch.least for stretch in programme.stretches)
    left = programme.period - sum(stretch.least for stretch in programme.stretches if stretch.fixed)
    for i in free:
        _check_rest(programme, i)
    kind, mean = objective.kind, objective.mean
    if not all(isinstance(each, Kind) and each.order for each in (kind, *objective.limits)):
        raise InputError(
            "free durations are shared by velocity, acceleration or jerk, not by a force, power or a load: "
            "give durations"
        )
    shares = [
        Share(
            programme.stretches[i],
            _cost(programme, i, objective, kind.order, mean=mean),
            _quickest(programme, i, objective),
        )
        for i in free
    ]
    level = _slopes(shares, kind.order) if mean else [share.cost for share in shares]
    given = dict(zip(free, _levelled(shares, level, left, programme.period), strict=True))
    return tuple(given.get(i, stretch.least) for i, stretch in enumerate(programme.stretches))


def _check_rest(programme: Programme, i: int) -> None:
    stretch, last = programme.stretches[i], len(programme.stretches) - 1
    for neighbour, side in ((programme.stretches[i - 1], 1), (programme.stretches[i + 1 if i < last else 0], 0)):
        if isinstance(neighbour.given, ConstantVelocity | Free) or _moves(neighbour, side):
            raise InputError(
                f"{stretch.where}: give it a duration: it is free only between dwells and moves, and {neighbour.where} "
                "does not rest where they meet"
            )
    if _moves(stretch, 0) or _moves(stretch, 1):
        raise InputError(f"{stretch.where}: give it a duration, or a law and no velocities that move at its ends")
    if isinstance(stretch.given, Dwell) or stretch.displacement == 0.0:
        raise InputError(f"{stretch.where}: give it a duration: it has nothing to move")


def _moves(stretch: TimedSegment, side: int) -> bool:
    """Whether a move is to have a velocity at its start (side 0) or its end, by itself or by its law."""
    given = stretch.given
    if not isinstance(given, Move):
        return False
    if is_optimal(given):
        return (given.start_velocity, given.end_velocity)[side] is not None
    return abs(float(named_law(given.law, stretch.where).b(float(side)))) > CLOSURE


def _cost(programme: Programme, i: int, objective: CycleObjective, nu: int, *, mean: bool) -> Callable[[float], float]:
    shape = _shape(programme, i, objective, nu, mean=mean)
    size = abs(programme.stretches[i].displacement)

    def cost(duration: float) -> float:
        value = factor(size, duration, nu) * shape(duration)
        return value * value * duration if mean else value

    return cost


def _quickest(programme: Programme, i: int, objective: CycleObjective) -> float:
    stretch = programme.stretches[i]
    limits = stretch.sides(objective.limits) if is_optimal(stretch.given) else {}
    return abs(stretch.displacement) / greatest(limits, Kind.VELOCITY, -1.0 if stretch.displacement < 0.0 else 1.0)


def _shape(programme: Programme, i: int, objective: CycleObjective, nu: int, *, mean: bool) -> Callable[[float], float]:
    """The constant of a move's law as a function of its duration; inf where no law keeps the limits."""
    stretch = programme.stretches[i]
    if not is_optimal(stretch.given) and isinstance(stretch.given, Move):
        law = named_law(stretch.given.law, stretch.where)
        value = _constant(law, nu, mean=mean)
        return lambda _: value
    offset = programme.start + sum(other.displacement for other in programme.stretches[:i])
    unbound: list[MotionLaw] = []
    nearest: list[Solution] = []

    def shape(duration: float) -> float:
        span = LawSpan((stretch,), (0.0,), duration, offset, stretch.displacement, _REST, _REST, ())
        try:
            problem = span_problem(span, objective)
            if not unbound:
                unbound.append(synthesize(unlimited(problem)).law)
            if _keeps_limits(unbound[0], problem):
                return _constant(unbound[0], nu, mean=mean)
            nearest[:] = [synthesize(problem, start=nearest[0] if nearest else None)]
            return _constant(nearest[0].law, nu, mean=mean)
        except InfeasibleProblem:
            return inf

    return shape


def _keeps_limits(law: MotionLaw, problem: Problem) -> bool:
    limits = [*problem.bounded, (FUNCTIONALS["B"], problem.range("B"))]
    return all(limit is None or constant.value(law) <= limit.high for constant, limit in limits)


def _constant(law: MotionLaw, nu: int, *, mean: bool) -> float:
    return law.rms(nu) if mean else law.peak(nu).value


def _slopes(shares: Sequence[Share], nu: int) -> list[Callable[[float], float]]:
    """How fast each mean square falls: exact where the shape stays, else by differences."""

    def slope(share: Share) -> Callable[[float], float]:
        def fall(duration: float) -> float:
            here = share.cost(duration)
            step = DURATION_STEP * duration
            before, after = share.cost(duration - step), share.cost(duration + step)
            power = 2 * nu - 1
            stays = abs(after * (1.0 + DURATION_STEP) ** power - here) <= 1e-10 * here
            if stays and abs(before * (1.0 - DURATION_STEP) ** power - here) <= 1e-10 * here:
                return power * here / duration
            return inf if before == inf else (before - after) / (2.0 * step)

        return fall

    return [slope(share) for share in shares]


def _levelled(
    shares: Sequence[Share], level: Sequence[Callable[[float], float]], left: float, period: float
) -> list[float]:
    """Durations at which what falls with each is equal, within their bounds, with the given sum."""
    bounds = [
        (max(part.stretch.least, part.quickest, _SHORTEST_MOVE * period), min(part.stretch.most, left))
        for part in shares
    ]
    if sum(low for low, _ in bounds) >= left or any(low > high for low, high in bounds):
        raise InfeasibleProblem(_TOO_FAST)
    level = [cache(fall) for fall in level]
    times = _by_powers(level, bounds, left) or _by_halves(level, bounds, left)
    inside = [low < time < high for time, (low, high) in zip(times, bounds, strict=True)]
    share = (left - sum(times)) / max(sum(inside), 1)
    return [time + share if within else time for time, within in zip(times, inside, strict=True)]


def _by_powers(
    level: Sequence[Callable[[float], float]], bounds: Sequence[tuple[float, float]], left: float
) -> list[float] | None:
    """Each taken for a power of its duration, through its last two values, until they are equal; None if that fails."""
    low, high = np.array(bounds).T
    times = np.clip(left / len(level), low, high)
    powers = np.ones(len(level))
    before: tuple[NDArray[np.float64], NDArray[np.float64]] | None = None
    for _ in range(_ROUNDS):
        values = np.log([fall(time) for fall, time in zip(level, times.tolist(), strict=True)])
        if not np.isfinite(values).all():
            return None
        if before is not None:
            moved = np.abs(np.log(times) - before[0]) > 1e-13
            steps = np.where(moved, np.log(times) - before[0], 1.0)
            powers = np.where(moved, np.clip(-(values - before[1]) / steps, 0.3, 60.0), powers)
        nearer = _shared(np.log(times), values, powers, low, high, left=left)
        if np.abs(nearer - times).max() <= SAME_TIME * left:
            return [float(time) for time in nearer]
        before, times = (np.log(times), values), nearer
    return None


def _shared(
    logs: NDArray[np.float64],
    values: NDArray[np.float64],
    powers: NDArray[np.float64],
    low: NDArray[np.float64],
    high: NDArray[np.float64],
    *,
    left: float,
) -> NDArray[np.float64]:
    """Durations within their bounds at which the powers are equal, with the given sum."""

    def at(height: float) -> NDArray[np.float64]:
        return np.clip(np.exp(np.clip(logs + (values - height) / powers, -300.0, 300.0)), low, high)

    first, last = float(values.min()) - 1.0, float(values.max()) + 1.0
    while at(first).sum() < left * (1.0 - SAME_TIME) and first > -1e4:
        first -= 10.0
    while at(last).sum() > left * (1.0 + SAME_TIME) and last < 1e4:
        last += 10.0
    return at(0.5 * sum(bisect(lambda height: bool(at(height).sum() > left), first, last)))


def _by_halves(
    level: Sequence[Callable[[float], float]], bounds: Sequence[tuple[float, float]], left: float
) -> list[float]:
    """The durations by bisection, for tight limits: slow, and reliable."""
    from scipy.optimize import brentq

    def at(height: float) -> list[float]:
        return [_inverse(fall, height, *ends) for fall, ends in zip(level, bounds, strict=True)]

    even = left / len(level)
    heights = [fall(max(low, min(high, even))) for fall, (low, high) in zip(level, bounds, strict=True)]
    known = [height for height in heights if height != inf]
    lowest, highest = 0.9 * min(known, default=1.0), 1.1 * max(known, default=1.0)
    while sum(at(lowest)) < left and lowest > 1e-300:
        lowest /= 4.0
    shortest = at(inf)
    if sum(shortest) > left:
        raise InfeasibleProblem(_TOO_FAST)
    while sum(at(highest)) > left:
        highest *= 4.0
    height = brentq(lambda log: sum(at(2.0**log)) - left, log2(lowest), log2(highest), xtol=1e-12, rtol=1e-12)
    return at(2.0**height)


def _inverse(fall: Callable[[float], float], height: float, low: float, high: float) -> float:
    """The duration at which what falls is at a height, or the nearest that is within bounds and keeps limits."""
    from scipy.optimize import brentq

    if fall(high) >= height:
        return high
    least = low if fall(low) < inf else _shortest(fall, low, high)
    if fall(least) <= height:
        return least
    return float(brentq(lambda time: log2(fall(time)) - log2(height), least, high, xtol=1e-15, rtol=1e-12))


def _shortest(fall: Callable[[float], float], low: float, high: float) -> float:
    """The shortest duration that keeps the limits; `high` where none does."""
    while high - low > AGREEMENT * high:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if fall(middle) == inf else (low, middle)
    return high
