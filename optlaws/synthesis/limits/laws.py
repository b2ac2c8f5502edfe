"""The laws that attain the limits: constant acceleration, constant power, jerk in steps (docs/theory/limits.md)."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import sqrt
from typing import TypeVar

from optlaws.laws.segments.constant_power import PowerSegment
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.laws.segments.segment import PolynomialSegment, Segment
from optlaws.synthesis.limits.closed_forms import back_time, back_velocity, best_velocity, limit, run_in

_STANDSTILL = 1e-6  # a motion back so slow that its times, of the square of this, would be lost in rounding

Pair = tuple[float, float]
Piece = TypeVar("Piece")


def limit_law(
    constant: str, B: float | None = None, *, order: int = 3, monotone: bool = False, J: float | None = None
) -> PiecewiseLaw:
    """The symmetric law that attains `limit` of the same arguments, exact and built without any search.

    Its derivatives jump where those of smooth laws only come near: for C the jerk is infinite, for D, which runs up
    from rest with constant power, C too.

    Parameters
    ----------
    constant
        "C", "D", "J" or "RMS" (of c).
    B
        Peak velocity b(1/2), above 1; without it the least over all B.
    order
        Number l of boundary conditions at each end. All orders from 3 have the same laws.
    monotone
        Whether b >= 0 is required.
    J
        For "C" alone: the peak jerk that is allowed; end accelerations are zero then.

    Returns
    -------
    A law with a(0) = 0, a(1) = 1, b(1/2) = B = max |b|, and zero end velocities unless order is 1.

    Raises
    ------
    InputError
        If the constant is unknown, a value is out of range, or there is no such limit.

    Examples
    --------
    >>> limit_law("C", B=1.6)
    PiecewiseLaw(segments=3, B=1.6, C=4.26667, D=6.82667, J=inf)
    >>> limit_law("D")
    PiecewiseLaw(segments=2, B=1.5, C=inf, D=2.25, J=inf)
    >>> limit_law("J", B=1.6)
    PiecewiseLaw(segments=5, B=1.6, C=8.53333, D=7.43193, J=45.5111)
    >>> limit_law("C", B=1.6, J=200.0)
    PiecewiseLaw(segments=7, B=1.6, C=4.54169, D=7.03251, J=200)
    """
    least = limit(constant, B, order=order, monotone=monotone, J=J)
    peak = float(best_velocity(constant, order) if B is None else B)
    if constant == "D":
        return _constant_power(peak, least, monotone=monotone)
    if constant == "RMS":
        return _parabolas(peak, monotone=monotone)
    if constant == "J":
        return _jerk_steps(peak, least, monotone=monotone, free=order == 2)
    if J is not None:
        return _trapezoids(peak, least, float(J), monotone=monotone)
    return _constant_acceleration(peak, least, monotone=monotone, free=order == 1)


def _constant_acceleration(B: float, C: float, *, monotone: bool, free: bool) -> PiecewiseLaw:
    if free and (B <= 2.0 or not monotone):
        return _levels([0.5], [(C, C)], b0=2.0 - B)
    if B <= 2.0:
        return _levels([(B - 1.0) / B, 0.5], [(C, C), (0.0, 0.0)])
    if monotone:
        return _levels([0.5 - 1.0 / B, 0.5], [(0.0, 0.0), (C, C)])
    return _levels([0.25 - 0.5 * B / C, 0.5], [(-C, -C), (C, C)])


def _parabolas(B: float, *, monotone: bool) -> PiecewiseLaw:
    if B <= 1.5:
        time = 1.5 * (B - 1.0) / B
        return _levels([time, 0.5], [(2.0 * B / time, 0.0), (0.0, 0.0)])
    if monotone and B >= 3.0:
        time = 1.5 / B
        return _levels([0.5 - time, 0.5], [(0.0, 0.0), (0.0, 2.0 * B / time)])
    return _levels([0.5], [(4.0 * (3.0 - B), 8.0 * B - 12.0)])


def _trapezoids(B: float, C: float, J: float, *, monotone: bool) -> PiecewiseLaw:
    ramp = C / J
    if B <= 2.0:
        time = (B - 1.0) / B
        return _levels([ramp, time - ramp, time, 0.5], [(0.0, C), (C, C), (C, 0.0), (0.0, 0.0)])
    if monotone:
        start = 0.5 - 1.0 / B
        return _levels([start, start + ramp, 0.5 - ramp, 0.5], [(0.0, 0.0), (0.0, C), (C, C), (C, 0.0)])
    back = back_time(B, J)
    lowest = 0.5 * J * back
    if lowest > C:
        lowest, back = C, 0.25 - 0.5 * B / C
    first = lowest / J
    forth = [(0.0, C), (C, C), (C, 0.0)]
    return _levels(
        [first, back - first, back, back + ramp, 0.5 - ramp, 0.5],
        [(0.0, -lowest), (-lowest, -lowest), (-lowest, 0.0), *forth],
    )


def _jerk_steps(B: float, J: float, *, monotone: bool, free: bool) -> PiecewiseLaw:
    if monotone and B >= 2.0:
        return _steps([0.5 - 1.0 / B, 0.5 - 0.5 / B, 0.5], [0.0, J, -J])
    if free and B <= 1.5:
        time = 1.5 * (B - 1.0) / B
        return _steps([time, 0.5], [-J, 0.0], c0=J * time)
    if free:
        time = 0.5 * run_in(B)
        return _steps([time, 0.5], [J, -J], c0=J * (0.5 - 2.0 * time))
    if B <= 2.0:
        time = (B - 1.0) / B
        return _steps([0.5 * time, time, 0.5], [J, -J, 0.0])
    time = 0.125 - 2.0 * B / J
    return _steps([time, time + 0.25, 0.5], [-J, J, -J])


def _constant_power(B: float, D: float, *, monotone: bool) -> PiecewiseLaw:
    if B <= 1.5:
        return _straight_squares([1.5 * (B - 1.0) / B, 0.5], [(0.0, B), (B, B)], D)
    speed = back_velocity(B)
    if monotone or speed < _STANDSTILL:
        return _straight_squares([0.5 - 0.75 / B, 0.5], [(0.0, 0.0), (0.0, B)], D)
    time = speed * speed / D
    return _straight_squares([0.5 * time, time, 0.5], [(0.0, -speed), (-speed, 0.0), (0.0, B)], D)


def _levels(times: Sequence[float], ends: Sequence[Pair], b0: float = 0.0) -> PiecewiseLaw:
    """The symmetric law whose c runs straight between `ends` on each stretch of [0, 1/2], which end at `times`."""
    c = ends[-1][0]
    middle = (c, -c) if ends[-1][1] == 0.0 else None
    breaks, both = _mirrored(times, ends, [(-last, -first) for first, last in reversed(ends)], middle)
    return _linear(breaks, [(0.5 * (first + last), 0.5 * (last - first)) for first, last in both], b0)


def _steps(times: Sequence[float], jerks: Sequence[float], c0: float = 0.0) -> PiecewiseLaw:
    """The symmetric law with constant `jerks` on the stretches of [0, 1/2], which end at `times`; c(1/2) = 0.

    Accelerations follow from the jerks and the rounded times, for it is the jerk that must come out exactly.
    """
    breaks, both = _mirrored(times, jerks, jerks[::-1], jerks[-1])
    series = []
    for (start, end), j in zip(pairwise(breaks), both, strict=True):
        half = 0.5 * j * (end - start)
        series.append((c0 + half, half))
        c0 += 2.0 * half
    return _linear(breaks, series, 0.0)


def _straight_squares(times: Sequence[float], ends: Sequence[Pair], D: float) -> PiecewiseLaw:
    """The symmetric law whose b² runs straight between the squares of `ends` on each stretch of [0, 1/2].

    The speed on the way back follows from D and the rounded times, for it is D that must come out exactly.
    """
    middle = ends[-1] if ends[-1][0] == ends[-1][1] else None
    breaks, both = _mirrored(times, ends, [(last, first) for first, last in reversed(ends)], middle)
    segments: list[Segment] = []
    for (start, end), (b0, b1) in zip(pairwise(breaks), both, strict=True):
        if b0 == b1:
            segments.append(PolynomialSegment((), b0))
        elif min(b0, b1) < 0.0:
            back = -sqrt(2.0 * D * (end - start))
            segments.append(PowerSegment(back if b0 else 0.0, back if b1 else 0.0))
        else:
            segments.append(PowerSegment(b0, b1))
    return PiecewiseLaw(breaks, segments)


def _linear(breaks: Sequence[float], series: Sequence[Pair], b: float) -> PiecewiseLaw:
    segments = []
    for (start, end), acceleration in zip(pairwise(breaks), series, strict=True):
        segments.append(PolynomialSegment(acceleration, b))
        b += acceleration[0] * (end - start)
    return PiecewiseLaw(breaks, segments)


def _mirrored(
    times: Sequence[float], first: Sequence[Piece], second: Sequence[Piece], middle: Piece | None
) -> tuple[list[float], list[Piece]]:
    """Breaks and pieces on [0, 1] from their first halves; `middle` is a piece across 1/2, if there is one.

    Stretches without length, of which the limits between two forms of law have some, are left out.
    """
    ends = [*times, *(1.0 - time for time in reversed(times[:-1])), 1.0]
    pieces = [*first, *second]
    if middle is not None:
        half = len(first)
        ends[half - 1 : half] = []
        pieces[half - 1 : half + 1] = [middle]
    breaks, lasting = [0.0], []
    for end, piece in zip(ends, pieces, strict=True):
        if end > breaks[-1]:
            breaks.append(end)
            lasting.append(piece)
    return breaks, lasting
