"""Exponential transforms of laws in closed form, and the vibration that they leave."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, lru_cache
from itertools import pairwise
from math import ceil
from typing import Any

import numpy as np

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.laws import MotionLaw
from optlaws.laws.law import motion_law
from optlaws.mechanisms.machine.drives import Forcing, forcings
from optlaws.numbers import Array, Complex, circular_frequency, not_negative, numbers, whole
from optlaws.numerics import chebyshev
from optlaws.synthesis.families.cone import stationary_places
from optlaws.synthesis.functionals.formula_rows import columns_of
from optlaws.synthesis.spaces.space import LawSpace
from optlaws.tolerances import NEGLIGIBLE_TERM, TINY

#: points of Gauss's rule beside those that the degree and the frequency need
_GAUSS_SPARE = 40
#: integrals of exp(w (1 - k)) b(k) for roots w, of one law or a column for each
Transform = Callable[[Complex], Complex]


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


def velocity_transform_of(law: MotionLaw) -> Transform:
    """Integral over [0, 1] of exp(w (1 - k)) b(k) as a function of w with real parts of at most 0.

    Computed from c and from the jumps of b, the ends among them: so it is as small beside c as it should be.
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
    transform = piece.length * _polynomial(piece.acceleration, piece.length, w)
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
    """The mean over a length of exp(w (length - s)) times a Chebyshev series, or of each column of several."""
    legendre = legendre_from_chebyshev(len(acceleration)) @ acceleration
    return np.asarray(moments(0.5 * length * w, len(acceleration)) @ legendre)


def phasor_share(w: Complex, damped: Array, size: Array | float = 1.0) -> Complex:
    """The complex amplitude after a motion, times a size, over the integral of exp(w (1 - k)) b(k)."""
    return np.asarray(-1j * size * w.conj() / damped)


def residual_phasor(law: MotionLaw, frequency: Any, damping: float = 0.0) -> Complex:
    """Complex amplitude Z of the free vibration after a law, the mass at rest at first; linear in the law.

    For k >= 1 the mass moves by a_m = a(1) + Re(Z exp(w (k - 1))), w = -n + i lambda, lambda = nu sqrt(1 - zeta²). |Z|
    is the residual displacement and nu² |Z| the residual acceleration. With wbar the conjugate of w,
    Z = -i wbar/lambda times the integral of exp(w (1 - k)) b(k), in closed form for polynomials and sines.

    Parameters
    ----------
    law
        Motion of the cam.
    frequency
        Frequencies nu, above 0; a number or shape (m,).
    damping
        Ratio zeta, below 1.

    Returns
    -------
    Complex array, shape (m,).

    Raises
    ------
    InputError
        If a number is out of range.

    Examples
    --------
    >>> from optlaws import savin
    >>> 18**2 * abs(residual_phasor(savin("III", 7.2), 18)).round(12)
    array([7.204401])
    """
    _, w, damped = roots(frequency, damping)
    return phasor_share(w, damped) * velocity_transform_of(law)(w)


def residual_functional(count: int, frequency: Any, damping: float = 0.0) -> tuple[Complex, Complex]:
    """The rows that turn a polynomial law's coefficients into the complex amplitude of its free vibration.

    With ``rows, start = residual_functional(len(law.acceleration), frequency, damping)`` the residual acceleration is
    ``abs(rows @ law.acceleration + start * law.b0)``: nu² times `residual_phasor`, affine in whatever the law is
    affine in, so that a bound on it is a second-order cone for each frequency.

    Parameters
    ----------
    count
        Number of Chebyshev coefficients of c.
    frequency, damping
        As of `residual_phasor`.

    Returns
    -------
    Complex arrays of shape (m, count) and (m,).

    Examples
    --------
    >>> from optlaws import smoothstep
    >>> law = smoothstep(4)
    >>> rows, start = residual_functional(len(law.acceleration), [20.0], 0.05)
    >>> abs(rows @ law.acceleration + start * law.b0).round(6)
    array([1.650151])
    """
    frequencies, w, damped = roots(frequency, damping)
    terms = whole(count, "count", least=1)
    share = phasor_share(w, damped, frequencies**2) / w
    # by parts: less what the velocity at the end is, the mean of each series
    gained = np.array([chebyshev.integral(series, 0.0).sum() for series in np.eye(terms)])
    return share[:, None] * (_polynomial(np.eye(terms), 1.0, w) - gained), share * np.expm1(w)


def roots(frequency: Any, damping: float) -> tuple[Array, Complex, Array]:
    """Frequencies nu, roots w = -n + i lambda and lambda of followers below critical damping."""
    frequencies = np.array(numbers(np.atleast_1d(np.asarray(frequency)).tolist(), "frequency"))
    ratio = not_negative(damping, "damping")
    if not (frequencies > 0.0).all():
        raise InputError(f"frequency must be above 0, got {float(frequencies.min())!r}")
    if frequencies.size:
        circular_frequency(frequencies.max())
    if ratio >= 1.0:
        raise InputError(
            f"damping must be below 1, got {shortened(damping)}: from the critical damping on nothing vibrates; "
            "Follower.response shows how the mass comes to rest"
        )
    damped = frequencies * np.sqrt((1.0 - ratio) * (1.0 + ratio))
    return frequencies, -ratio * frequencies + 1j * damped, damped


@lru_cache(maxsize=256)
def terms_of_exponential(half: float) -> int:
    """The number of coefficients of exp(w t) that count, w over a line of twice that length, 0 <= t <= 1.

    Where |exp(w t)| is at most 1 on the line the coefficient n is at most 2 (half / 2)^n / n!.

    >>> terms_of_exponential(0.01), terms_of_exponential(10.0)
    (7, 38)
    """
    n, size = 0, 2.0
    while size > NEGLIGIBLE_TERM or n < half:
        n += 1
        size *= 0.5 * half / n
    return n + 1


def greatest_modulus(amplitude: Callable[[Array], Complex], nodes: Array) -> tuple[float, float]:
    """The greatest magnitude of an analytic amplitude from -1 to 1, by nodes that resolve it, and its place.

    >>> greatest_modulus(lambda u: 1.0 + 1j * u * u, np.ones(1))
    (1.414214, 1.0)
    """
    places = nodes
    if len(nodes) > 1:
        places = np.concatenate([[-1.0, 1.0], stationary_places(chebyshev.from_values(amplitude(nodes)))])
    sizes = np.abs(amplitude(places))
    best = int(np.argmax(sizes))
    return float(sizes[best]), float(places[best])


def velocity_transforms(space: LawSpace, w: Complex, highest: float) -> Complex:
    """Integrals of exp(w (1 - k)) b(k), a row for each root w, for the free functions and the base law of a space.

    Roots have real parts of at most 0 and magnitudes of at most `highest`.
    """
    k, weights = _gauss_rule(space, highest)
    # by parts: beside b what a fast vibration leaves would be lost in rounding
    moved = np.exp(w[:, None] * (1.0 - k)) @ (weights[:, None] * columns_of(space, 2, k))
    begun, ended = columns_of(space, 1, np.array([0.0, 1.0]))
    return np.asarray((moved + np.exp(w)[:, None] * begun - ended) / w[:, None])


def _gauss_rule(space: LawSpace, highest: float) -> tuple[Array, Array]:
    """Gauss points on every piece of the law, enough for a vibration of the highest frequency, and weights."""
    breaks = np.array(space.breaks)
    degree = 1 + space.degree_of(1)
    x, weights = np.polynomial.legendre.leggauss(degree + ceil(0.5 * highest) + _GAUSS_SPARE)
    lengths = np.diff(breaks)
    k = breaks[:-1, None] + lengths[:, None] * (1.0 + x) / 2.0
    return k.ravel(), (lengths[:, None] * weights / 2.0).ravel()
