"""Exponential transforms of laws in closed form, by exponential moments of Legendre polynomials."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, lru_cache
from itertools import pairwise
from math import ceil

import numpy as np

from optlaws.laws import MotionLaw
from optlaws.laws.law import motion_law
from optlaws.mechanisms.forcing import Forcing, forcings
from optlaws.numbers import Array, Complex
from optlaws.numerics import chebyshev
from optlaws.tolerances import TINY


def moments(sigma: Complex, count: int) -> Complex:
    """Half the integral over |x| <= 1 of P_n(x) exp(sigma (1 - x)), n = 0 ... count - 1, shape (m, count).

    It is (-1)^n exp(sigma) i_n(sigma), and for imaginary sigma a spherical Bessel function j_n. The ratios of
    consecutive n come from their recurrence run downwards, which is stable for every argument: not 0, real part at most
    0.

    >>> moments(np.array([-0.5 + 0.0j]), 2).real.round(9).tolist()
    [[0.632120559, 0.103638324]]
    """
    table = np.empty((len(sigma), max(count, 2)), dtype=np.complex128)
    size = np.abs(sigma)
    order = np.argsort(size)
    low = 0
    while low < len(order):  # arguments of like size share the length of their recurrence
        high = max(low + 1, int(np.searchsorted(size[order], max(8.0, 1.5 * size[order[low]]), side="right")))
        some = order[low:high]
        table[some] = _alike(sigma[some], table.shape[1], float(size[order[high - 1]]))
        low = high
    return table[:, :count]


def _alike(sigma: Complex, count: int, largest: float) -> Complex:
    ratio = np.zeros(len(sigma), dtype=np.complex128)
    ratios = np.empty((len(sigma), count), dtype=np.complex128)
    top = max(count, ceil(largest)) + 20 + ceil(8.0 * largest ** (1.0 / 3.0))
    inverse = 1.0 / sigma
    for n in range(top, 0, -1):
        below = ratio - (2.0 * n + 1.0) * inverse
        below[below == 0.0] = TINY
        ratio = 1.0 / below
        if n < count:
            ratios[:, n] = ratio
    decay = np.exp(2.0 * sigma)
    first = np.expm1(2.0 * sigma) * (0.5 * inverse)
    second = (first - 0.5 * (decay + 1.0)) * inverse
    # the larger of the two is known without cancellation
    from_second = np.abs(second) > np.abs(first)
    table = np.empty_like(ratios)
    table[:, 0] = first
    table[:, 1] = np.where(from_second, second, first * ratios[:, 1])
    for n in range(2, count):
        table[:, n] = table[:, n - 1] * ratios[:, n]
    return table


@lru_cache(maxsize=64)
def legendre_from_chebyshev(count: int) -> Array:
    """Matrix that turns `count` Chebyshev coefficients into Legendre ones.

    >>> legendre_from_chebyshev(3).round(6).tolist()
    [[1.0, 0.0, -0.333333], [0.0, 1.0, 0.0], [0.0, 0.0, 1.333333]]
    """
    x, weights = np.polynomial.legendre.leggauss(count)
    values = np.polynomial.legendre.legvander(x, count - 1)
    scale = np.arange(count) + 0.5
    table: Array = scale[:, None] * (values.T @ (weights[:, None] * chebyshev.basis_values(x, count)))
    table = np.triu(table)
    table[np.add.outer(np.arange(count), np.arange(count)) % 2 == 1] = 0.0
    return table


def velocity_transform(law: MotionLaw, w: Complex) -> Complex:
    """Integral over [0, 1] of exp(w (1 - k)) b(k) for w with real part at most 0, shape of w.

    Computed from c and from the jumps of b, the ends among them: so it is as small beside c as it should be.
    """
    return velocity_transform_of(law)(w)


def velocity_transform_of(law: MotionLaw) -> Callable[[Complex], Complex]:
    """The transform of a law's velocity as a function of w, for several w of one law."""
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
