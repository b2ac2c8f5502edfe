"""The limits of loaders of symmetric laws with b >= 0 and a given B: least peak velocity, acceleration, power."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import asin, cos, pi, sin, sqrt

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.numbers import positive

_ANGLE_SHARP = 1e-13  # rad: to so much the place of a loader's peak is found

HARMLESS = 4.0 / pi  # here the loader can run at constant acceleration, with C = 4
EVEN_POWER = 1.5  # here it can run at constant power, with D = 9/4


def loader_velocity_limit(B: float) -> float:
    """Least peak velocity B_l of a loader: 1/B² + 1/B_l² < 1 for every symmetric law with one top.

    Parameters
    ----------
    B
        Peak velocity of the executive law, above 1 (dimensionless).

    Raises
    ------
    InputError
        If B is not above 1.

    Examples
    --------
    >>> round(loader_velocity_limit(1.25), 12)
    1.666666666667
    """
    velocity = _velocity(B)
    return velocity / sqrt(velocity * velocity - 1.0)


def loader_acceleration_limit(B: float) -> float:
    """Least peak acceleration C_l of a loader whose executive link does not go back (b >= 0).

    From B = 4/pi on it is (pi B/2)² / (pi B/2 - 1); for smaller B the loader has to slow down, run evenly for a
    while, and slow down again.

    Parameters
    ----------
    B
        Peak velocity of the executive law, above 1 (dimensionless); the law is symmetric with one top.

    Raises
    ------
    InputError
        If B is not above 1.

    Examples
    --------
    >>> from math import pi
    >>> round(loader_acceleration_limit(4 / pi), 9), round(loader_acceleration_limit(1.875), 6)
    (4.0, 4.459318)
    """
    velocity = _velocity(B)
    if velocity >= HARMLESS:
        rate = 0.5 * pi * velocity
        return rate * rate / (rate - 1.0)

    def peak(angle: float) -> float:
        rate = _rate(velocity, angle, 0.5 * pi)
        return rate * rate / (1.0 + cos(angle) * (rate - 2.0))

    return _least(velocity, peak)


def loader_power_limit(B: float) -> float:
    """Least peak power D_l of a loader whose executive link does not go back (b >= 0).

    From B = 3/2 on it is r³ / (2 (r - 2/3)²) with r = 4B/3; for smaller B the loader has to slow down, run evenly for a
    while, and slow down again, at constant power.

    Parameters
    ----------
    B
        Peak velocity of the executive law, above 1 (dimensionless); the law is symmetric with one top.

    Raises
    ------
    InputError
        If B is not above 1.

    Examples
    --------
    >>> round(loader_power_limit(1.5), 12), round(loader_power_limit(1.875), 6)
    (2.25, 2.32438)
    """
    velocity = _velocity(B)
    if velocity >= EVEN_POWER:
        rate = 4.0 * velocity / 3.0
        return 0.5 * rate**3 / (rate - 2.0 / 3.0) ** 2

    def peak(angle: float) -> float:
        rate = _rate(velocity, angle, 4.0 / 3.0)
        return 0.5 * rate**3 / (4.0 / 3.0 + cos(angle) * (rate - 2.0)) ** 2

    return _least(velocity, peak)


LIMITS: Mapping[str, Callable[[float], float]] = {
    "B": loader_velocity_limit,
    "C": loader_acceleration_limit,
    "D": loader_power_limit,
}


def _rate(B: float, angle: float, slopes: float) -> float:
    """The steepness of two equal slopes between which the loader runs evenly at cos(angle) of its peak velocity."""
    return (2.0 * sin(angle) - slopes) / (sin(angle) - 1.0 / B)


def _least(B: float, peak: Callable[[float], float]) -> float:
    """The least peak over the angles at which the loader may run evenly."""
    from scipy.optimize import minimize_scalar

    # the angle has to keep a distance from the end at which the rate is infinite
    start = asin(1.0 / B)
    bounds = (start + 1e-9 * (0.5 * pi - start), 0.5 * pi)
    best = minimize_scalar(peak, bounds=bounds, options={"xatol": _ANGLE_SHARP})
    return float(min(best.fun, peak(0.5 * pi)))


def _velocity(B: float) -> float:
    velocity = positive(B, "B")
    if velocity <= 1.0:
        raise InputError(
            f"B must be above 1, for the stroke is 1 and the law starts and ends at rest; got {shortened(B)}"
        )
    return velocity
