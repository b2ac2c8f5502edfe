"""Exponential transforms of laws, in closed form."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from optlaws.laws import MotionLaw
from optlaws.mechanisms.checks import motion_law
from optlaws.mechanisms.follower.cam_motion import Forcing
from optlaws.mechanisms.follower.law_motion import forcings
from optlaws.mechanisms.spectrum.bessel import legendre_from_chebyshev, moments
from optlaws.numbers import Array

Complex = NDArray[np.complex128]


def velocity_transform(law: MotionLaw, w: Complex) -> Complex:
    """Integral over [0, 1] of exp(w (1 - k)) b(k) for w with real part at most 0, shape of w.

    Computed from c and from the jumps of b, the ends among them: so it is as small beside c as it should be.

    Examples
    --------
    >>> from optlaws.laws import smoothstep
    >>> velocity_transform(smoothstep(1), np.array([-1.0 + 0.0j])).real.round(6)
    array([0.632121])
    """
    return velocity_transform_of(law)(w)


def velocity_transform_of(law: MotionLaw) -> Callable[[Complex], Complex]:
    """The transform of a law's velocity as a function of w, for several w of one law.

    Examples
    --------
    >>> from optlaws.laws import smoothstep
    >>> transform = velocity_transform_of(smoothstep(1))
    >>> transform(np.array([-1.0 + 0.0j])).real.round(6)
    array([0.632121])
    """
    pieces = forcings(motion_law(law))
    ends = np.array([0.0])
    begins = float(pieces[0].derivative(ends, 1)[0])
    stops = float(pieces[-1].derivative(np.array([pieces[-1].length]), 1)[0])
    jumps = [
        (after.start, float(after.derivative(ends, 1)[0] - before.derivative(np.array([before.length]), 1)[0]))
        for before, after in pairwise(pieces)
    ]

    def transform(w: Complex) -> Complex:
        exponential = cache(lambda k: np.exp(w * (1.0 - k)))
        total = exponential(0.0) * begins
        for start, jump in jumps:
            if jump:
                total = total + jump * exponential(start)
        total = total - stops
        for piece in pieces:
            total = total + exponential(piece.start + piece.length) * _acceleration_transform(piece, w)
        return np.asarray(total / w)

    return transform


def _acceleration_transform(piece: Forcing, w: Complex) -> Complex:
    """Integral over the piece of exp(w (length - s)) c(s)."""
    transform = _polynomial(piece.acceleration, piece.length, w)
    for sine in piece.sines:
        wave = 1j * sine.frequency
        for sign in (1.0, -1.0):
            turn = np.exp(1j * sign * (sine.frequency * piece.length + sine.phase))
            transform += -0.5j * sign * sine.amplitude * turn * piece.length * _mean((w - sign * wave) * piece.length)
    return transform


def _mean(z: Complex) -> Complex:
    """(exp(z) - 1) / z, 1 at 0."""
    safe = np.where(z == 0.0, 1.0, z)
    return np.where(z == 0.0, 1.0, np.expm1(safe) / safe)


def _polynomial(acceleration: Array, length: float, w: Complex) -> Complex:
    legendre = legendre_from_chebyshev(len(acceleration)) @ acceleration
    return length * (moments(0.5 * length * w, len(acceleration)) @ legendre)
