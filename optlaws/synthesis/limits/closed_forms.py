"""Peak constants that no law of an order can beat, in closed form, and the laws that attain them.

The constants (derivations: docs/theory/limits.md) are the infima over all laws from rest to rest with stroke 1,
b(1/2) = B and b <= B, dimensionless (at order 1 with free end velocities; J from order 3 on, and C at a given J, with
c = 0 at the ends); smooth laws come as near as one likes. For D the bound holds for unsymmetric laws too, for the
others they can do no better. Doubles are rounded down: none is above the exact value at the given double B. The laws
have constant acceleration, constant power, or jerk in steps.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise
from math import acos, acosh, cos, cosh, inf, sqrt
from typing import Any, TypeVar

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.laws.segments.fractional import PowerSegment
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.laws.segments.segment import PolynomialSegment, Segment
from optlaws.numbers import MOST_ORDER, MOST_VELOCITY, real, whole
from optlaws.numerics.exact import not_above, root_rounded_down, rounded_down

CONSTANTS = ("C", "D", "J", "RMS")


def acceleration_limit(B: float, *, monotone: bool = False, order: int = 2) -> float:
    """Infimum of C over all laws with b <= B, b(1/2) = B, zero end positions (dimensionless).

    Rest-to-rest laws (order >= 2) may come as near as they like; where `monotone`, b >= 0 is required too. With order 1
    the end velocities are free and the infimum is lower.

    Parameters
    ----------
    B
        Peak velocity, above 1.
    monotone
        Whether b >= 0 is required.
    order
        Number l of boundary conditions at each end.

    Raises
    ------
    InputError
        If B is not a finite number above 1, or order is not an integer of at least 1.

    Examples
    --------
    >>> acceleration_limit(2.0)
    4.0
    >>> acceleration_limit(3.0, monotone=True)
    9.0
    """
    peak_velocity(B)
    b = Fraction(B)
    if whole(order, "order", least=1, most=MOST_ORDER) == 1:
        return rounded_down(b * b if monotone and B > 2.0 else 4 * (b - 1))
    if B <= 2.0:
        return rounded_down(b * b / (b - 1))
    if monotone:
        return rounded_down(b * b)
    return root_rounded_down(2 * (b - 2), Fraction(2), (b - 2) ** 2 + b * b)


def power_limit(B: float, *, monotone: bool = False) -> float:
    """Infimum of D at given B: constant speed and constant power. The least of all is 9/4, at B = 3/2.

    B³/(3(B-1)) for B <= 3/2; above, 2B³/3 where b >= 0 is required, else B² + 2u² with 2u³ + 3u² = B²(B - 3/2).

    Parameters
    ----------
    B
        Peak velocity, above 1.
    monotone
        Whether b >= 0 is required.

    Raises
    ------
    InputError
        If B is not a finite number above 1.

    Examples
    --------
    >>> power_limit(1.5), power_limit(3.0, monotone=True)
    (2.25, 18.0)
    >>> round(power_limit(3.0), 6)
    13.5
    """
    peak_velocity(B)
    b = Fraction(B)
    if B <= 1.5 or monotone:
        return rounded_down(b**3 / (3 * (b - 1)) if B <= 1.5 else 2 * b**3 / 3)

    def below(D: Fraction) -> bool:
        # with v = u², 2u³ + 3u² rises: 2 sqrt(v³) <= B²(B - 3/2) - 3v if and only if u is not above its root
        v = (D - b * b) / 2
        rest = b * b * (b - Fraction(3, 2)) - 3 * v
        return v <= 0 or (rest >= 0 and 4 * v**3 <= rest**2)

    return not_above(float(B) ** 2 + 2.0 * back_velocity(float(B)) ** 2, below)


def rms_limit(B: float, *, monotone: bool = False) -> float:
    """Infimum of the RMS of c at given B: parabolas of velocity. The least of all is sqrt 12, at B = 3/2.

    (4B/3) sqrt(B/(B-1)) for B <= 3/2 and 4 sqrt(B² - 3B + 3) above; if b >= 0 is required, (4/3) sqrt(B³) for B >= 3.

    Parameters
    ----------
    B
        Peak velocity, above 1.
    monotone
        Whether b >= 0 is required.

    Raises
    ------
    InputError
        If B is not a finite number above 1.

    Examples
    --------
    >>> round(rms_limit(1.5) ** 2, 12)
    12.0
    >>> rms_limit(4.0, monotone=True) > rms_limit(4.0)
    True
    """
    peak_velocity(B)
    b, nothing = Fraction(B), Fraction(0)
    if B <= 1.5:
        return root_rounded_down(nothing, 4 * b / 3, b / (b - 1))
    if monotone and B >= 3.0:
        return root_rounded_down(nothing, 4 * b / 3, b)
    return root_rounded_down(nothing, Fraction(4), b * b - 3 * b + 3)


def jerk_limit(B: float, *, monotone: bool = False, order: int = 3) -> float:
    """Infimum of J at given B: jerk in steps. The least of all is 12 at B = 3/2 (order 2), 32 at B = 2 (order >= 3).

    End accelerations zero (order >= 3): 4B³/(B-1)² for B <= 2 and 16 (2(B-2) + sqrt(4(B-2)² + B²)) above. End
    accelerations free (order 2): 8B³/(9(B-1)²) for B <= 3/2 and 8B/(1 - 2r²) above, with the root r of
    2B r³ - 6(B-1) r² + 2B - 3 = 0 in [0, 1/sqrt 2). Where b >= 0 is required, 4B³ for B >= 2 at either order.

    Parameters
    ----------
    B
        Peak velocity, above 1.
    monotone
        Whether b >= 0 is required.
    order
        Number l of boundary conditions at each end, at least 2.

    Raises
    ------
    InputError
        If B is not a finite number above 1, or order is not an integer of at least 2.

    Examples
    --------
    >>> jerk_limit(2.0), round(jerk_limit(1.5, order=2), 12)
    (32.0, 12.0)
    >>> jerk_limit(3.0, monotone=True)
    108.0
    """
    peak_velocity(B)
    free = whole(order, "order", least=2, most=MOST_ORDER) == 2
    b = Fraction(B)
    if monotone and B >= 2.0:
        return rounded_down(4 * b**3)
    if free:
        return rounded_down(8 * b**3 / (9 * (b - 1) ** 2)) if B <= 1.5 else _jerk_of_free_ends(float(B))
    if B <= 2.0:
        return rounded_down(4 * b**3 / (b - 1) ** 2)
    return root_rounded_down(32 * (b - 2), Fraction(16), 4 * (b - 2) ** 2 + b * b)


def _jerk_of_free_ends(B: float) -> float:
    b = Fraction(B)

    def below(J: Fraction) -> bool:
        # with q = r² from J = 8B/(1 - 2r²): the cubic falls with r, and is at least 0 up to its root
        q = (1 - 8 * b / J) / 2
        rest = 6 * (b - 1) * q - (2 * b - 3)
        return q <= 0 or rest <= 0 or 4 * b * b * q**3 >= rest**2

    return not_above(8.0 * B / (1.0 - 2.0 * run_in(B) ** 2), below)


def acceleration_limit_at_jerk(B: float, J: float, *, monotone: bool = False) -> float:
    """Infimum of C at given B over laws with |j| <= J and zero end accelerations: trapezoids of acceleration.

    2B/(w + sqrt(w² - 4B/J)) with w = (B-1)/B for B <= 2, and w = 1/B for B >= 2 where b >= 0 is required. Else, for
    B > 2, a law that first moves back: the root above `acceleration_limit` of 4C³/J = C² - 4(B-2) C - 4B², or a closed
    form where the motion back is so short that its acceleration has no constant part.

    Parameters
    ----------
    B
        Peak velocity, above 1.
    J
        Peak jerk that is allowed, at least `jerk_limit(B, monotone=monotone)`.
    monotone
        Whether b >= 0 is required.

    Raises
    ------
    InputError
        If B is not a finite number above 1, or no law has so small a J.

    Examples
    --------
    >>> acceleration_limit_at_jerk(2.0, 32.0)
    8.0
    >>> round(acceleration_limit_at_jerk(1.5, 1e9), 6)
    4.5
    """
    peak_velocity(B)
    least = jerk_limit(B, monotone=monotone)
    number = real(J)
    if number is None or not least * (1.0 - 1e-14) <= number < inf:
        raise InputError(
            f"J must be a finite number of at least {least!r} (no law has less at B = {B!r}), got {shortened(J)}"
        )
    b, j = Fraction(B), Fraction(number)
    if B <= 2.0 or monotone:
        return _trapezoid_rounded_down(b, (b - 1) / b if B <= 2.0 else 1 / b, j)
    # a longer way back costs more: a shorter one bounds C from below
    back = Fraction(not_above(back_time(B, J), lambda t: (j * t / 4 + b) ** 2 <= b * b + j * (b - 2) / 4))
    C = _trapezoid_rounded_down(b + j * back * back / 4, Fraction(1, 2) - back, j)
    if j * back <= 2 * C:
        return C
    return not_above(_three_parts(float(B), float(J)), lambda x: x * x - 4 * (b - 2) * x - 4 * b * b <= 4 * x**3 / j)


def _trapezoid_rounded_down(rise: Fraction, time: Fraction, J: Fraction) -> float:
    """The smaller root of C²/J - time C + rise, not above it."""
    value = trapezoid(float(rise), float(time), float(J))
    return not_above(value, lambda C: J * time >= 2 * C and C * C / J - time * C + rise >= 0)


def _three_parts(B: float, J: float) -> float:
    # in 1/C the cubic is convex and rises at its largest root: Newton's method comes down to it from the limit's 1/C
    inverse = 1.0 / acceleration_limit(B)
    while True:
        value = ((4.0 * B * B * inverse + 4.0 * (B - 2.0)) * inverse - 1.0) * inverse + 4.0 / J
        slope = (12.0 * B * B * inverse + 8.0 * (B - 2.0)) * inverse - 1.0
        lower = inverse - value / slope
        if not lower < inverse * (1.0 - 1e-16):
            return 1.0 / inverse
        inverse = lower


def limit(
    constant: str, B: float | None = None, *, order: int = 3, monotone: bool = False, J: float | None = None
) -> float:
    """Infimum of a constant over all laws from rest to rest, at a given B or over all B.

    Parameters
    ----------
    constant
        "C", "D", "J" or "RMS" (of c).
    B
        Peak velocity b(1/2), above 1; without it the least over all B.
    order
        Number l of boundary conditions at each end. All orders from 3 (zero end accelerations) have the same limits;
        J is lower at order 2 (free end accelerations), C at order 1 (free end velocities).
    monotone
        Whether b >= 0 is required.
    J
        For "C" alone: the peak jerk that is allowed; end accelerations are zero then (order >= 3).

    Raises
    ------
    InputError
        If the constant is unknown, a value is out of range, or there is no such limit.

    Examples
    --------
    >>> limit("C", 1.6), limit("D"), limit("J"), round(limit("J", order=2), 9)
    (4.266667, 2.25, 32.0, 12.0)
    >>> limit("C", 1.6, J=200.0)
    4.541693
    """
    if constant not in tuple(CONSTANTS):
        raise InputError(f"constant {shortened(constant)} is unknown; known are {', '.join(CONSTANTS)}")
    least = 1 if constant == "C" and J is None else 3 if constant == "C" else 2
    number = whole(order, "order", least=least, most=MOST_ORDER)
    if B is None:
        B = best_velocity(constant, number)
    if J is not None:
        if constant != "C":
            raise InputError(f"J is given for the constant 'C' only, not for {constant!r}")
        return acceleration_limit_at_jerk(B, J, monotone=monotone)
    if constant == "C":
        return acceleration_limit(B, monotone=monotone, order=number)
    if constant == "J":
        return jerk_limit(B, monotone=monotone, order=number)
    return power_limit(B, monotone=monotone) if constant == "D" else rms_limit(B, monotone=monotone)


def best_velocity(constant: str, order: int) -> float:
    """The B at which the limit of a constant is least.

    Raises
    ------
    InputError
        If there is none: at order 1 the least C is 0, in uniform motion.

    Examples
    --------
    >>> best_velocity("D", 3)
    1.5
    """
    if order == 1:
        raise InputError("B must be given at order 1: C falls to 0 as B falls to 1")
    return 2.0 if constant == "C" or (constant == "J" and order > 2) else 1.5


def peak_velocity(B: Any) -> None:
    """Refuse a B that no law can have.

    Raises
    ------
    InputError
        If B is not a finite number above 1.
    """
    number = real(B)
    if number is None or not 1.0 < number < inf:
        raise InputError(f"B must be a finite number above 1 (the mean velocity is 1), got {shortened(B)}")
    if number > MOST_VELOCITY:
        raise InputError(f"B must not exceed {MOST_VELOCITY:g}, got {shortened(number)}")


def back_velocity(B: float) -> float:
    """Speed u of the motion back in the law of least D, B >= 3/2: 2u³ + 3u² = B²(B - 3/2).

    With v = u + 1/2 this is 4v³ - 3v = 2B²(B - 3/2) - 1, and the left side is the Chebyshev polynomial T_3.

    >>> round(back_velocity(3.0), 9)
    1.5
    """
    value = 2.0 * B * B * (B - 1.5) - 1.0
    return (cos(acos(value) / 3.0) if value <= 1.0 else cosh(acosh(value) / 3.0)) - 0.5


def run_in(B: float) -> float:
    """Time r/2 of positive jerk at either end in the law of least J with free end accelerations, B >= 3/2: r.

    >>> run_in(1.5), round(run_in(2.0), 12)
    (0.0, 0.5)
    """
    share = sqrt((B - 1.5) / (B - 1.0))
    return share / (2.0 * cos(acos(-0.5 * B / (B - 1.0) * share) / 3.0))


def back_time(B: float, J: float) -> float:
    """Time of the motion back with jerk ±J in two equal parts, B >= 2.

    >>> back_time(2.0, 32.0)
    0.0
    """
    return (B - 2.0) / (B + sqrt(B * B + 0.25 * J * (B - 2.0)))


def trapezoid(rise: float, time: float, J: float) -> float:
    """Height C of a trapezoid of acceleration with slopes ±J that raises b by `rise` in `time`.

    >>> trapezoid(2.0, 0.5, 32.0)
    8.0
    """
    return 2.0 * rise / (time + sqrt(max(time * time - 4.0 * rise / J, 0.0)))


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
