"""Times and heights of the laws that attain the limits, in closed form (derivations: docs/theory/limit-laws.md)."""

from __future__ import annotations

from math import acos, acosh, cos, cosh, sqrt


def back_velocity(B: float) -> float:
    """Speed u of the motion back in the law of least D, B >= 3/2: 2u³ + 3u² = B²(B - 3/2).

    With v = u + 1/2 this is 4v³ - 3v = 2B²(B - 3/2) - 1, and the left side is the Chebyshev polynomial T_3.

    Examples
    --------
    >>> round(back_velocity(3.0), 9)
    1.5
    """
    value = 2.0 * B * B * (B - 1.5) - 1.0
    return (cos(acos(value) / 3.0) if value <= 1.0 else cosh(acosh(value) / 3.0)) - 0.5


def run_in(B: float) -> float:
    """Time r/2 of positive jerk at either end in the law of least J with free end accelerations, B >= 3/2: r.

    Examples
    --------
    >>> run_in(1.5), round(run_in(2.0), 12)
    (0.0, 0.5)
    """
    share = sqrt((B - 1.5) / (B - 1.0))
    return share / (2.0 * cos(acos(-0.5 * B / (B - 1.0) * share) / 3.0))


def back_time(B: float, J: float) -> float:
    """Time of the motion back with jerk ±J in two equal parts, B >= 2.

    Examples
    --------
    >>> back_time(2.0, 32.0)
    0.0
    """
    return (B - 2.0) / (B + sqrt(B * B + 0.25 * J * (B - 2.0)))


def trapezoid(rise: float, time: float, J: float) -> float:
    """Height C of a trapezoid of acceleration with slopes ±J that raises b by `rise` in `time`.

    Examples
    --------
    >>> trapezoid(2.0, 0.5, 32.0)
    8.0
    """
    return 2.0 * rise / (time + sqrt(max(time * time - 4.0 * rise / J, 0.0)))
