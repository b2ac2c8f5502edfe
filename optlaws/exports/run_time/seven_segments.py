"""Jerk-limited moves from rest to rest in the least time, by seven segments in closed form, for controllers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import cbrt, sqrt
from pathlib import Path

from optlaws.exports.run_time.front_export import function_format
from optlaws.exports.run_time.segment_sources import segments_block, segments_header
from optlaws.files import writing
from optlaws.motion.polynomials import PiecewiseMotion
from optlaws.numbers import finite, positive
from optlaws.tolerances import OPERATIONS_ROUNDING

_WRITERS: dict[str, Callable[[str, Sequence[str]], str]] = {"c99": segments_header, "iec-st": segments_block}
_HEADING = (
    "the least time from rest to rest within velocity, acceleration and jerk, by seven segments",
    "units: any that fit each other, such as mm, mm/s, mm/s^2, mm/s^3 and s",
    "closed form: no iteration, at most one square root and one cube root in each branch",
    "limits are narrowed by 2^-48 of them, so that they are kept whatever is rounded in LREAL",
    "rounding in LREAL, proven, at most 2^-45 of the stroke in position; in the derivatives 2^-45 of",
    "velocity + acceleration * duration and of acceleration + jerk * duration, the limits: a time is rounded itself",
)


@dataclass(frozen=True)
class SegmentTimes:
    """The durations of a move's segments: four with jerk, two of constant acceleration, one of constant velocity.

    Attributes
    ----------
    jerk
        In the first segment, with the sign of the stroke.
    jerk_time, acceleration_time, cruise_time
        In the unit of time of the limits.
    """

    jerk: float
    jerk_time: float
    acceleration_time: float
    cruise_time: float

    @property
    def duration(self) -> float:
        """The time of the whole move."""
        return 4.0 * self.jerk_time + 2.0 * self.acceleration_time + self.cruise_time

    def motion(self) -> PiecewiseMotion:
        """The move as polynomials of time; segments that last no time are left out.

        Examples
        --------
        >>> motion = segment_times(10.0, 5.0, 10.0, 30.0).motion()
        >>> (
        ...     len(motion.coefficients),
        ...     round(motion.stop, 6),
        ...     round(motion(motion.stop), 6),
        ...     round(motion.peak(2).value, 6),
        ... )
        (7, 2.833333, 10.0, 10.0)
        """
        tj, ta, tc, j = self.jerk_time, self.acceleration_time, self.cruise_time, self.jerk
        times = ((tj, j), (ta, 0.0), (tj, -j), (tc, 0.0), (tj, -j), (ta, 0.0), (tj, j))
        breaks, rows, state = [0.0], [], (0.0, 0.0, 0.0)
        for time, jerk in times:
            if time <= 0.0:
                continue
            y, v, a = state
            rows.append([y, v, 0.5 * a, jerk / 6.0])
            breaks.append(breaks[-1] + time)
            state = (
                y + time * (v + time * (0.5 * a + time * jerk / 6.0)),
                v + time * (a + 0.5 * time * jerk),
                a + time * jerk,
            )
        return PiecewiseMotion(breaks, rows)


def segment_times(stroke: float, velocity: float, acceleration: float, jerk: float) -> SegmentTimes:
    """The segments of the least time within limits, in one system of units.

    The ramp to a velocity w lasts w/a + a/j where w >= a²/j, else 2 sqrt(w/j), and the stroke is w times it plus what
    is cruised. Where the stroke is less than the limit of the velocity takes, w is the root of a quadratic or a cubic.
    The times are sums and roots of positive terms, but for differences of times no longer than the move. A time that is
    off by the share e of the duration T moves the position by at most w T e, and w T is at most twice the stroke; each
    value consists of fewer than 128 rounded operations, so that 2^-45, 256 unit roundoffs, bounds what is rounded.

    Raises
    ------
    InputError
        If a limit is not positive, or the stroke is 0.

    Examples
    --------
    >>> [round(segment_times(h, 1.0, 1.0, 1.0).duration, 7) for h in (1.0, 2.0)]
    [3.1748021, 4.0]
    """
    way = positive(abs(finite(stroke, "stroke")), "stroke")
    narrow = 1.0 - OPERATIONS_ROUNDING
    limits = (("velocity", velocity), ("acceleration", acceleration), ("jerk", jerk))
    v, a, j = (narrow * positive(value, name) for name, value in limits)
    signed = j if stroke > 0.0 else -j
    reached = v >= a * (a / j)
    ramp = v / a + a / j if reached else 2.0 * sqrt(v / j)
    if way >= v * ramp:
        times = (a / j, max(v / a - a / j, 0.0)) if reached else (sqrt(v / j), 0.0)
        return SegmentTimes(signed, *times, way / v - ramp)
    if way >= 2.0 * a * (a / j) * (a / j):
        rate = 2.0 * (way / a) / (a / j + sqrt(a / j * (a / j) + 4.0 * (way / a)))
        return SegmentTimes(signed, a / j, max(rate - a / j, 0.0), 0.0)
    return SegmentTimes(signed, cbrt(0.5 * (way / j)), 0.0, 0.0)


@dataclass(frozen=True)
class SegmentExport:
    """Functions of a controller that plan and evaluate jerk-limited moves.

    Attributes
    ----------
    format
        "c99" or "iec-st".
    text
        The file.
    """

    format: str
    text: str

    def least_time(self, *, stroke: float, velocity: float, acceleration: float, jerk: float) -> SegmentTimes:
        """The segments of a move, as the controller plans it.

        Raises
        ------
        InputError
            If a limit is not positive, or the stroke is 0.
        """
        return segment_times(stroke, velocity, acceleration, jerk)

    def write(self, file: str | Path) -> Path:
        """Write the file, completely or not at all; an existing file with other contents is kept as NAME.orig."""
        return writing.write_any(Path(file), self.text)


def jerk_limited_move(to: str, *, name: str = "Move") -> SegmentExport:
    """Functions for a controller: the least time from rest to rest within velocity, acceleration and jerk.

    Nothing is faster within these limits: with jerks alone limited the law has seven segments, and all is closed form.
    `ProvenFront.export` gives smoother laws, whose jerk is continuous.

    Parameters
    ----------
    to
        "c99" or "iec-st".
    name
        Before every name of a header, or of the function block.

    Raises
    ------
    InputError
        If the format has no functions, or the name is none.

    Examples
    --------
    >>> export = jerk_limited_move("c99", name="axis")
    >>> move = export.least_time(stroke=10.0, velocity=5.0, acceleration=10.0, jerk=30.0)
    >>> round(move.duration, 7), round(move.cruise_time, 7)
    (2.8333333, 1.1666667)
    """
    form = function_format(to)
    return SegmentExport(form, _WRITERS[form](name, _HEADING))
