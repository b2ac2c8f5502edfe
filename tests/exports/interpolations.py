"""Interpolations of points as motions, made of the powers that controllers lay between points."""

import numpy as np
from numpy.typing import NDArray

from optlaws import PiecewiseMotion
from tests.internals.exports import akima_powers
from tests.internals.numerics import Ends, hermite_powers, linear_powers, spline_powers

Array = NDArray[np.float64]


def linear(x: Array, y: Array) -> PiecewiseMotion:
    return PiecewiseMotion(x, linear_powers(x, y))


def cubic_spline(
    x: Array, y: Array, ends: Ends = "clamped", slopes: tuple[float, float] = (0.0, 0.0)
) -> PiecewiseMotion:
    return PiecewiseMotion(x, spline_powers(x, y, ends, slopes))


def hermite(x: Array, values: Array) -> PiecewiseMotion:
    return PiecewiseMotion(x, hermite_powers(x, values))


def akima(x: Array, y: Array) -> PiecewiseMotion:
    return PiecewiseMotion(x, akima_powers(x, y))


def sampled(motion: PiecewiseMotion, ticks: int) -> PiecewiseMotion:
    """A motion as a task samples it so many times: straight lines between equal steps."""
    x = np.linspace(motion.start, motion.stop, ticks + 1)
    return linear(x, motion(x))
