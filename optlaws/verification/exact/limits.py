"""What closed forms prove for laws of any degree: a lower bound of what is minimised, a time that none is faster than.

A phase that gains a velocity takes no less than its segments, and both phases with the greatest velocity between them
cover the stroke (docs/how-to/least-time.md). A velocity with which they cover less is below the greatest of the fastest
motion, whose phases therefore take more: so roots that are rounded down bound its time from below.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from functools import partial
from math import inf, isqrt
from typing import NamedTuple

from optlaws.synthesis.least_time.move_limits import phase
from optlaws.synthesis.least_time.timed_move import TimedMove
from optlaws.synthesis.limits.of_problem import limit_of_sum
from optlaws.synthesis.problem.constants import Combined, Functional
from optlaws.synthesis.problem.expression import leaves
from optlaws.synthesis.problem.problem import Problem
from optlaws.verification.exact.law import known
from optlaws.verification.machines.transfer import floor


def exact_limit(problem: Problem) -> Fraction | None:
    """A lower bound of the objective for all laws of the problem; None where no closed form exists.

    Only C, D, J and the RMS of c count, and C and D of its cam; every other constant is to be at least 0.

    >>> exact_limit(Problem(B=1.5, order=4, minimise="D"))
    Fraction(9, 4)
    """
    constants = [leaf for _, leaf in leaves(problem.objective) if isinstance(leaf, Functional)]
    if problem.boundary is not None or any(floor(constant, problem.conditions) < 0 for constant in constants):
        return None
    for constant in constants:
        if isinstance(constant, Combined):
            known(constant)
    return limit_of_sum(problem, problem.objective, exact=True) or None


_BITS = 128
#: the order of laws whose acceleration may jump at the ends, and the least of laws that have a snap
_AT_REST, _SMOOTH = 2, 4
_SNAP = 384  # the least peak of the fourth derivative from rest to rest: 3! 4³

#: a least and a greatest value
Bounds = tuple[Fraction, Fraction]
#: a limit, or infinity
Limit = Fraction | float


class _Sides(NamedTuple):
    """Limits of the acceleration forward and backward, and of the jerk."""

    up: Limit
    down: Limit
    jerk: Limit


def least_time_of_any_law(move: TimedMove) -> Fraction | None:
    """A time that no law keeps the limits of the motion in less than; None where none is proven."""
    limits, order = move.limits, move.problem.order
    up, down, jerk, snap, velocity = (
        inf if most is None else Fraction(most)
        for most in (limits.acceleration, limits.deceleration, limits.jerk, limits.snap, limits.velocity)
    )
    if order < _AT_REST:
        up = down = jerk = inf
    if order == _AT_REST and not move.at_rest:
        jerk = inf
    stroke, known = Fraction(move.stroke), list[Fraction]()
    if move.concave and min(up, down, jerk, velocity) < inf:
        ends = (Fraction(move.start_velocity), Fraction(move.end_velocity))
        known.append(_by_segments(stroke, ends, _Sides(up, down, jerk), velocity, order))
    if move.at_rest and order >= _SMOOTH and isinstance(snap, Fraction):
        known.append(_root(_root(_SNAP * stroke / snap)))
    return max(known, default=None)


def _by_segments(
    stroke: Fraction, ends: tuple[Fraction, Fraction], sides: _Sides, velocity: Limit, order: int
) -> Fraction:
    way = sides.up if ends[1] > ends[0] else sides.down
    times, straight = _phase(abs(ends[1] - ends[0]), way, sides.jerk, order)
    if min(min(ends) * time for time in times) + straight[0] > stroke:
        # it is slower between, or goes back: so does its image, which is faster between; both take the same time
        stroke, ends, sides = -stroke, (-ends[0], -ends[1]), _Sides(sides.down, sides.up, sides.jerk)

    def phases(above: Fraction) -> list[tuple[Bounds, Bounds]]:
        return [
            _phase(max(ends) - end + above, side, sides.jerk, order)
            for end, side in zip(ends, (sides.up, sides.down), strict=True)
        ]

    def covered(above: Fraction) -> Fraction:
        """No less than what the phases cover."""
        known = zip(ends, phases(above), strict=True)
        return sum((max(end * time for time in times) + far[1] for end, (times, far) in known), Fraction(0))

    above, cruise = Fraction(0), Fraction(0)
    if isinstance(velocity, Fraction) and velocity > 0 and covered(velocity - max(ends)) < stroke:
        above = velocity - max(ends)
        cruise = (stroke - covered(above)) / velocity
    else:
        above = _below_crossing(covered, stroke)
    return cruise + sum(times[0] for times, _ in phases(above))


def _below_crossing(covered: Callable[[Fraction], Fraction], stroke: Fraction) -> Fraction:
    """A velocity with which the phases cover less than the stroke, near the greatest; 0 where there is none."""
    low, high = Fraction(0), Fraction(1)
    if covered(low) >= stroke:
        return low
    while covered(high) < stroke:
        low, high = high, 2 * high
    while low == 0 and covered(high / 2) >= stroke:
        high /= 2
    for _ in range(_BITS // 2):
        middle = (low + high) / 2
        low, high = (middle, high) if covered(middle) < stroke else (low, middle)
    return low


def _phase(gain: Fraction, limit: Limit, jerk: Limit, order: int) -> tuple[Bounds, Bounds]:
    """The time of the fastest gain of a velocity from a standstill, and what it covers."""
    known = (phase(gain, limit, jerk, order, partial(_root, above=above)) for above in (0, 1))
    (fewest, near), (most, far) = known
    return (sum(fewest, Fraction(0)), sum(most, Fraction(0))), (near, far)


def _root(square: Fraction, above: int = 0) -> Fraction:
    """A fraction below a root, or above it, which differs in the last of many bits."""
    shift = max(0, _BITS + square.denominator.bit_length() - square.numerator.bit_length())
    whole = isqrt((square.numerator << 2 * shift) // square.denominator)
    return Fraction(whole + above, 1 << shift)
