"""Selection of a move's law from a front, and its duration: the formulas of a controller, in Python."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from dataclasses import dataclass
from enum import IntEnum
from math import cbrt, sqrt
from typing import Any

import numpy as np

from optlaws.exports.run_time.front_table import FrontTable
from optlaws.numbers import Array
from optlaws.tolerances import RUN_TIME_RANGE


class MoveStatus(IntEnum):
    """Status codes of a function block at run time.

    Attributes
    ----------
    PROVEN
        The limits hold, and no law of the front's problem within them takes less time, or less acceleration in this
        time, by more than the gap.
    AT_END
        The limits hold for the law at an end of the front; a law beyond may be better.
    JERK
        The limits hold; the jerk decides the time, which is least among the laws of the table.
    TOO_SHORT
        No law of the front moves so far in this time within the velocity: there is no motion.
    REFUSED
        A stroke, a time or a limit is not finite, not positive or out of all proportion: there is no motion.
    """

    PROVEN = 0
    AT_END = 1
    JERK = 2
    TOO_SHORT = 3
    REFUSED = 4

    @property
    def moves(self) -> bool:
        """Whether there is a motion."""
        return self <= MoveStatus.JERK


@dataclass(frozen=True)
class RunTimeMove:
    """A move as a controller plans it: a weighted mean of two neighbouring laws, a stroke and a time.

    Attributes
    ----------
    status
        What is proven of it.
    law, share
        The mean of this law of the table and the next one, which has the weight `share`.
    stroke, duration
        In the units that were given.
    velocity, acceleration, jerk
        Bounds that no magnitude of the motion exceeds, in these units.
    """

    status: MoveStatus
    law: int = 0
    share: float = 0.0
    stroke: float = 0.0
    duration: float = 0.0
    velocity: float = 0.0
    acceleration: float = 0.0
    jerk: float = 0.0


def least_time(table: FrontTable, stroke: float, velocity: float, acceleration: float, jerk: float) -> RunTimeMove:
    """The move of least time within limits of velocity, acceleration and jerk, in one system of units.

    With z = v T/h, which is B at the limit of the velocity, the acceleration is at its limit where z² = (v²/(a h)) C,
    and the jerk where z³ = (v³/(j h²)) J. Along the front B ascends, C and J do not: the interval is searched by
    halving, and C and J being linear in it, the roots of a quadratic and of a cubic are the place.

    Examples
    --------
    >>> from optlaws.exports.run_time.front_table import front_table
    >>> from optlaws import smoothstep
    >>> table = front_table((1.5, 1.875), (smoothstep(2), smoothstep(3)), 1.0, (False, False))
    >>> move = least_time(table, 2.0, 1.0, 1.0, 1e3)
    >>> move.status.name, round(move.duration, 4), round(move.acceleration, 9)
    ('PROVEN', 3.4267, 1.0)
    """
    if not all(map(_in_range, (velocity, acceleration, jerk))) or not (stroke == 0.0 or _in_range(abs(stroke))):
        return RunTimeMove(MoveStatus.REFUSED)
    if stroke == 0.0:
        return RunTimeMove(MoveStatus.PROVEN)
    rate = velocity / abs(stroke)
    status, i, share, z = _fastest(table, velocity / acceleration * rate, velocity / jerk * rate * rate)
    return _move(table, (status, i, share), stroke, z / rate * (1.0 + table.slack))


def in_time(table: FrontTable, stroke: float, duration: float, velocity: float) -> RunTimeMove:
    """The move of least acceleration in a given time within a limit of the velocity, in one system of units.

    Examples
    --------
    >>> from optlaws.exports.run_time.front_table import front_table
    >>> from optlaws import smoothstep
    >>> table = front_table((1.5, 1.875), (smoothstep(2), smoothstep(3)), 1.0, (False, False))
    >>> move = in_time(table, 2.0, 4.0, 0.8)
    >>> move.status.name, move.law, round(move.share, 6), in_time(table, 2.0, 2.0, 1.0).status.name
    ('PROVEN', 0, 0.266667, 'TOO_SHORT')
    """
    if not all(map(_in_range, (duration, velocity))) or not (stroke == 0.0 or _in_range(abs(stroke))):
        return RunTimeMove(MoveStatus.REFUSED)
    if stroke == 0.0:
        return RunTimeMove(MoveStatus.PROVEN, duration=duration)
    of_b = table.velocities
    z = velocity * duration / abs(stroke) / (1.0 + table.slack)
    if z < of_b[0]:
        return RunTimeMove(MoveStatus.TOO_SHORT)
    last = len(table) - 1
    if z >= of_b[last]:
        return _move(table, (_at_end(table, last=True), last - 1, 1.0), stroke, duration)
    low = bisect_right(of_b, z) - 1
    return _move(table, (MoveStatus.PROVEN, low, _share(table, low, z)), stroke, duration)


def motion_at(table: FrontTable, move: RunTimeMove, times: Any) -> Array:
    """Position, velocity, acceleration and jerk of a move at times, shape (4, ...); at rest before it and after it.

    Examples
    --------
    >>> from optlaws.exports.run_time.front_table import front_table
    >>> from optlaws import smoothstep
    >>> table = front_table((1.5, 1.875), (smoothstep(2), smoothstep(3)), 1.0, (False, False))
    >>> motion_at(table, in_time(table, 2.0, 4.0, 1.0), [0.0, 2.0, 5.0])[0].round(9).tolist()
    [0.0, 1.0, 2.0]
    """
    t = np.asarray(times, dtype=np.float64)
    values = np.zeros((4, *t.shape))
    if not move.status.moves or move.stroke == 0.0:
        return values
    inside = (t >= 0.0) & (t <= move.duration)
    values[0] = np.where(t > move.duration, move.stroke, 0.0)
    k = np.clip(np.where(inside, t, 0.0) / move.duration, 0.0, 1.0)
    edges = np.array(table.breaks)
    piece = np.clip(np.searchsorted(edges, k, side="right") - 1, 0, len(edges) - 2)
    scale = 2.0 / np.diff(edges)[piece]
    x = np.clip(scale * (k - edges[piece]) - 1.0, -1.0, 1.0)
    first, following = table.series[move.law][piece], table.series[move.law + 1][piece]
    for nu, value in enumerate(_summed(table, first + move.share * (following - first), x)):
        values[nu] = np.where(inside, move.stroke * (scale / move.duration) ** nu * value, values[nu])
    return values


def _summed(table: FrontTable, mixed: Array, x: Array) -> list[Array]:
    """The series and its three derivatives by x, by Clenshaw's recurrence and its derivatives."""
    now, before = ([np.zeros_like(x) for _ in range(4)] for _ in range(2))
    for n in range(table.degree, 0, -1):
        given = mixed[..., n // 2 if table.odd else n] if n % 2 or not table.odd else np.zeros_like(x)
        lower = [given, *(2.0 * m * now[m - 1] for m in (1, 2, 3))]
        now, before = [2.0 * x * p - q + c for p, q, c in zip(now, before, lower, strict=True)], now
    first = np.full_like(x, 0.5) if table.odd else mixed[..., 0]
    lower = [first, *(m * now[m - 1] for m in (1, 2, 3))]
    return [x * p - q + c for p, q, c in zip(now, before, lower, strict=True)]


def _fastest(table: FrontTable, of_c: float, of_j: float) -> tuple[MoveStatus, int, float, float]:
    """What is proven of the first place where the velocity decides, z = B, for z² >= of_c C and z³ >= of_j J.

    With it the law before that place, the next one's weight, and z.
    """
    b, c, j = table.velocities, table.accelerations, table.jerks
    count = len(table)
    low = bisect_left(range(count), x=True, key=lambda i: b[i] * b[i] >= of_c * c[i] and b[i] ** 3 >= of_j * j[i])
    if low == 0:
        return _at_end(table, last=False), 0, 0.0, b[0]
    if low == count:
        by_acceleration, by_jerk = sqrt(of_c * c[-1]), cbrt(of_j * j[-1])
        status = MoveStatus.JERK if by_jerk > by_acceleration else _at_end(table, last=True)
        return status, low - 2, 1.0, max(by_acceleration, by_jerk)
    i = low - 1
    by_acceleration, by_jerk = _of_quadratic(of_c, b, c, i), _of_cubic(of_j, b, j, i)
    z = min(max(by_acceleration, by_jerk, b[i]), b[low])
    return MoveStatus.JERK if by_jerk > by_acceleration else MoveStatus.PROVEN, i, _share(table, i, z), z


def _line(factor: float, b: tuple[float, ...], peak: tuple[float, ...], i: int) -> tuple[float, float]:
    """Value at B = 0 and fall of factor times a peak that is linear in B between two laws."""
    fall = factor * ((peak[i] - peak[i + 1]) / (b[i + 1] - b[i]))
    return factor * peak[i] + fall * b[i], fall


def _of_quadratic(factor: float, b: tuple[float, ...], c: tuple[float, ...], i: int) -> float:
    """z > 0 of z² + m z = n, without a difference."""
    n, m = _line(factor, b, c, i)
    return 2.0 * n / (m + sqrt(m * m + 4.0 * n))


def _of_cubic(factor: float, b: tuple[float, ...], j: tuple[float, ...], i: int) -> float:
    """z > 0 of z³ + m z = n, without a difference."""
    n, m = _line(factor, b, j, i)
    third = m / 3.0
    u = cbrt(0.5 * n + sqrt(0.25 * n * n + third * third * third))
    v = third / u
    return n / (u * u + third + v * v)


def _share(table: FrontTable, i: int, z: float) -> float:
    b = table.velocities
    return min(max((z - b[i]) / (b[i + 1] - b[i]), 0.0), 1.0)


def _move(table: FrontTable, place: tuple[MoveStatus, int, float], stroke: float, duration: float) -> RunTimeMove:
    """The move by a law and the weight of the next one, with what is proven of it."""
    _, i, share = place
    bounds = (
        (p[i] + share * (p[i + 1] - p[i])) * (1.0 + table.slack) * (abs(stroke) / duration**nu)
        for nu, p in enumerate((table.velocities, table.accelerations, table.jerks), start=1)
    )
    return RunTimeMove(*place, stroke, duration, *bounds)


def _at_end(table: FrontTable, *, last: bool) -> MoveStatus:
    return MoveStatus.PROVEN if table.ends[last] else MoveStatus.AT_END


def _in_range(value: float) -> bool:
    return RUN_TIME_RANGE <= value <= 1.0 / RUN_TIME_RANGE
