"""The exact swing: I chi'' + M_R(chi) = 0 between the extremes of equal potential energy, to rounding."""

from __future__ import annotations

from collections.abc import Callable
from math import pi

import numpy as np

from optlaws.balancing.levers.motion import LeverMotion
from optlaws.errors import InputError, SolverFailure
from optlaws.numbers import Array

_SWING_SETTLED = 1e-14  # of a swing: a step of Newton's method that is the last
_SWING_RESOLVED = 1e-15  # of a swing: what its last amplitudes leave
_SWING_INTEGRATED = 1e-9  # of a swing: amplitudes that are integrated at first

Function = Callable[[Array], Array]

POINTS = (96, 256, 768)  # of the quadrature: more where fewer do not resolve the motion
MOST = 400  # cosines

_STEPS = 12
_TRIED = 65


def upper_extreme(potential: Function, swing: float, reach: tuple[float, float], guess: float) -> float:
    """The extreme chi01, nearest to a guess, from which the link swings to chi01 - swing at the same potential energy.

    The linkage can move between the deviations `reach`; angles in radians.
    """
    from scipy.optimize import brentq

    def excess(chi: Array) -> Array:
        return potential(chi) - potential(chi - swing)

    low, high = max(0.0, reach[0] + swing), min(swing, reach[1])
    tried = np.linspace(low, max(low, high), _TRIED)
    values = excess(tried)
    crossings = np.flatnonzero((values[:-1] < 0.0) & (values[1:] >= 0.0))
    if not len(crossings):
        raise InputError(
            f"no swing of {np.degrees(swing):.6g} deg: the linkage can move from {np.degrees(reach[0]):.6g} to "
            f"{np.degrees(reach[1]):.6g} deg about rest, to its dead points, and the bars do not bring it to rest "
            "twice on so long a way; reduce swing"
        )
    first = crossings[np.argmin(np.abs(tried[crossings] - guess))]
    return float(brentq(lambda chi: float(excess(chi)), tried[first], tried[first + 1], xtol=4e-16, rtol=1e-15))


def swung(
    potential: Function, moment: Callable[[Array], tuple[Array, Array]], chi01: float, swing: float
) -> LeverMotion:
    """The motion between the extremes chi01 and chi01 - swing.

    The time on the way is integrated over the phase of a cosine, which gives the amplitudes; a few steps of Newton's
    method on the equation of motion itself, at as many points as there are amplitudes, take them to rounding. `moment`
    gives M_R with its derivative.
    """
    for points in POINTS:
        amplitudes, frequency = _integrated(potential, chi01, swing, points)
        last = int(np.flatnonzero(np.abs(amplitudes) > _SWING_INTEGRATED * swing)[-1])
        if 4 * last < points:
            break
    count = 16 + 2 * last
    while count <= MOST:
        start = np.zeros(count + 1)
        start[: len(amplitudes)] = amplitudes[: count + 1]
        amplitudes, frequency = _settled(moment, start, frequency, swing)
        if np.abs(amplitudes[-3:]).max() <= _SWING_RESOLVED * swing:
            known = np.flatnonzero(np.abs(amplitudes) > 0.01 * _SWING_RESOLVED * swing)
            return LeverMotion(tuple(amplitudes[: known[-1] + 1].tolist()), float(2.0 * pi / np.sqrt(frequency)))
        count = 3 * count // 2
    raise SolverFailure(
        f"the swing needs more than {MOST} cosines: it nearly comes to rest on its way; reduce swing",
        problem={"chi01": chi01, "swing": swing},
    )


def _integrated(potential: Function, chi01: float, swing: float, points: int) -> tuple[Array, float]:
    """Amplitudes and squared frequency by quadrature over chi = middle + swing/2 cos(phase)."""
    phase = (np.arange(points) + 0.5) * pi / points
    chi = chi01 - swing * np.sin(0.5 * phase) ** 2
    square = 2.0 * (potential(np.array(chi01)) - potential(chi))
    if not square.min() > 0.0:
        raise InputError(
            f"the link does not reach {np.degrees(chi01 - swing):.6g} deg from {np.degrees(chi01):.6g} deg: it comes "
            "to rest on its way, for the moment is not restoring everywhere; reduce swing"
        )
    pace = 0.5 * swing * np.sin(phase) / np.sqrt(square)
    order = np.arange(1, points)
    mean = float(pace.mean())
    share = 2.0 / points * (np.cos(np.multiply.outer(order, phase)) @ pace) / mean
    turned = phase + np.sin(np.multiply.outer(phase, order)) @ (share / order)
    # at higher orders the uneven points alias
    amplitudes = 2.0 / points * (np.cos(np.multiply.outer(np.arange(points // 3), turned)) @ (chi * pace / mean))
    amplitudes[0] *= 0.5
    return amplitudes, mean**-2


def _settled(
    moment: Callable[[Array], tuple[Array, Array]], amplitudes: Array, frequency: float, swing: float
) -> tuple[Array, float]:
    """Newton's method on -w² sum i² a_i cos(i phi) + M_R = 0 at equally spaced phi, and on the swing."""
    count = len(amplitudes)
    order = np.arange(count)
    cosines = np.cos(np.multiply.outer(np.arange(count) * pi / (count - 1), order))
    second = cosines * order**2
    ends = 2.0 * (order % 2)
    jacobian = np.zeros((count + 1, count + 1))
    jacobian[-1, :-1] = ends
    for _ in range(_STEPS):
        value, slope = moment(cosines @ amplitudes)
        curve = second @ amplitudes
        jacobian[:-1, :-1] = slope[:, None] * cosines - frequency * second
        jacobian[:-1, -1] = -curve
        step = np.linalg.solve(jacobian, np.append(value - frequency * curve, ends @ amplitudes - swing))
        amplitudes = amplitudes - step[:-1]
        frequency -= float(step[-1])
        if np.abs(step[:-1]).max() <= _SWING_SETTLED * swing:
            return amplitudes, frequency
    raise SolverFailure(
        "the equation of motion did not settle; reduce swing",
        problem={"chi01": float(amplitudes.sum()), "swing": swing},
    )
