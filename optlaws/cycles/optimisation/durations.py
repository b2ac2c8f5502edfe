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
from math import inf

import numpy as np

from optlaws.cycles.optimisation.objectives import CycleObjective
from optlaws.cycles.optimisation.optimal import span_problem, unlimited
from optlaws.cycles.specification.limits import greatest
from optlaws.cycles.specification.programme import LawSpan, Programme, TimedSegment, is_optimal
from optlaws.cycles.specification.segments import ConstantVelocity, Dwell, Free, Move
from optlaws.errors import InfeasibleProblem, InputError, SolverFailure
from optlaws.laws import MotionLaw
from optlaws.motion.piece import factor, moves_at, named_law
from optlaws.motion.quantities import Kind
from optlaws.numbers import Array
from optlaws.numerics.roots import bisect
from optlaws.synthesis.problem.constants import FUNCTIONALS
from optlaws.synthesis.solution import Solution
from optlaws.synthesis.solve import synthesize
from optlaws.tolerances import AGREEMENT, DURATION_STEP, SAME_TIME

_SHORTEST_MOVE = 1e-6  # of a period: no shorter move is tried
_SAME_SHAPE = 1e-10  # of a mean square: so near to that of the same law in another duration

_ROUNDS = 60
_TOO_FAST = "no durations of the free moves keep the limits: slow the cycle down or widen limits"


def durations(programme: Programme, objective: CycleObjective) -> tuple[float, ...]:
    """The durations of all stretches: given ones, and optimal ones where they are free."""
    stretches = programme.stretches
    free = [i for i, stretch in enumerate(stretches) if not stretch.fixed]
    for i in free:
        _check_rest(programme, i)
    if free and not all(isinstance(kind, Kind) and kind.order for kind in (objective.kind, *objective.limits)):
        raise InputError(
            "free durations are shared by velocity, acceleration or jerk, not by a force, power or a load: "
            "give durations"
        )
    left = programme.period - sum(stretch.least for stretch in stretches if stretch.fixed)
    shared = _levelled([_FreeMove(programme, i, objective) for i in free], left) if free else []
    given = dict(zip(free, shared, strict=True))
    return tuple(given.get(i, stretch.least) for i, stretch in enumerate(stretches))


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
    return moves_at(named_law(given.law, stretch.where), side)


@dataclass
class _FreeMove:
    """A move whose duration is free, and what falls as it grows."""

    programme: Programme
    i: int
    objective: CycleObjective
    best: MotionLaw | None = None  #: without limits
    nearest: Solution | None = None

    @property
    def stretch(self) -> TimedSegment:
        return self.programme.stretches[self.i]

    @property
    def bounds(self) -> tuple[float, float]:
        """The least and the greatest duration: no law that keeps the limit of the velocity is shorter."""
        stretch, sought = self.stretch, is_optimal(self.stretch.given)
        direction = -1.0 if stretch.displacement < 0.0 else 1.0
        fastest = greatest(stretch.sides(self.objective.limits), Kind.VELOCITY, direction) if sought else inf
        return max(
            stretch.least, abs(stretch.displacement) / fastest, _SHORTEST_MOVE * self.programme.period
        ), stretch.most

    def level(self, duration: float) -> float:
        """Its peak, or how fast its mean square falls: exact where the shape stays, else by differences."""
        here, step, power = self._value(duration), DURATION_STEP * duration, 2 * self.objective.kind.order - 1
        if not self.objective.mean:
            return here
        before, after = self._value(duration - step), self._value(duration + step)
        if all(
            abs(value * share**power - here) <= _SAME_SHAPE * here
            for value, share in ((before, 1.0 - DURATION_STEP), (after, 1.0 + DURATION_STEP))
        ):
            return power * here / duration
        return inf if before == inf else (before - after) / (2.0 * step)

    def _value(self, duration: float) -> float:
        """The peak, or the integral of the square over the duration, in SI units; inf where no law keeps the limits."""
        try:
            law = self._law(duration)
        except InfeasibleProblem:
            return inf
        nu, mean = self.objective.kind.order, self.objective.mean
        value = factor(abs(self.stretch.displacement), duration, nu) * (law.rms(nu) if mean else law.peak(nu).value)
        return value * value * duration if mean else value

    def _law(self, duration: float) -> MotionLaw:
        stretch = self.stretch
        if isinstance(stretch.given, Move) and not is_optimal(stretch.given):
            return named_law(stretch.given.law, stretch.where)
        span = LawSpan.of(stretch, 0.0, duration, self.programme.offsets[self.i])
        problem = span_problem(span, self.objective)
        self.best = self.best or synthesize(unlimited(problem)).law
        limits = [*problem.bounded, (FUNCTIONALS["B"], problem.range("B"))]
        if all(limit is None or constant.value(self.best) <= limit.high for constant, limit in limits):
            return self.best
        self.nearest = synthesize(problem, start=self.nearest)
        return self.nearest.law


def _levelled(moves: Sequence[_FreeMove], left: float) -> list[float]:
    """Durations within their bounds, with the given sum, at which what falls with each is equal.

    Each is taken for a power of its duration, through its last two values, until they are. Where no law keeps the
    limits, the shortest duration in which one does is the least.
    """
    low, high = np.array([move.bounds for move in moves]).T
    high, levels = np.minimum(high, left), [cache(move.level) for move in moves]
    times, powers = np.clip(left / len(moves), low, high), np.ones(len(moves))
    before: tuple[Array, Array] | None = None
    for _ in range(_ROUNDS):
        if low.sum() >= left or (low > high).any():
            break
        with np.errstate(over="ignore"):
            values = np.log([level(time) for level, time in zip(levels, times.tolist(), strict=True)])
        short = np.flatnonzero(np.isinf(values))
        if short.size:
            for i in short:
                low[i] = _shortest(levels[i], float(times[i]), float(high[i]))
            times, before = np.clip(times, low, high), None
            continue
        if before is not None:
            steps = np.log(times) - before[0]
            moved = np.abs(steps) > 1e-13
            falls = -(values - before[1]) / np.where(moved, steps, 1.0)
            powers = np.where(moved, np.clip(falls, 0.3, 60.0), powers)
        nearer = _shared(np.log(times), values, powers, (low, high), left)
        if np.abs(nearer - times).max() <= SAME_TIME * left:
            inside = (low < nearer) & (nearer < high)
            return [*np.where(inside, nearer + (left - nearer.sum()) / max(inside.sum(), 1), nearer).tolist()]
        before, times = (np.log(times), values), nearer
    else:
        raise SolverFailure("no durations of the free moves were found: give one of them a duration")
    raise InfeasibleProblem(_TOO_FAST)


def _shared(logs: Array, values: Array, powers: Array, ends: tuple[Array, Array], left: float) -> Array:
    """Durations within their ends at which the powers are equal, with the given sum."""
    low, high = ends

    def at(height: float) -> Array:
        return np.clip(np.exp(np.clip(logs + (values - height) / powers, -300.0, 300.0)), low, high)

    first, last = ((values + powers * (logs - np.log(end))) for end in (high, low))
    return at(0.5 * sum(bisect(lambda height: bool(at(height).sum() > left), first.min(), last.max())))


def _shortest(level: Callable[[float], float], low: float, high: float) -> float:
    """The shortest duration that keeps the limits, between one that does not and one that may."""
    if level(high) == inf:
        raise InfeasibleProblem(_TOO_FAST)
    while high - low > AGREEMENT * high:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if level(middle) == inf else (low, middle)
    return high
