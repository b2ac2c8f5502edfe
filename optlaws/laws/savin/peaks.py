"""Peaks of Savin's laws in closed form; theory in docs/theory/savin.md.

With p = k (1 - k), y = 1 + alpha (M - p) and q = 1/4 - p the laws are c = H p^u sqrt(q) y and
b = H/2 p^(u+1) F with F = (1 + alpha M)/(u+1) - alpha p/(u+2).
"""

from __future__ import annotations

from fractions import Fraction
from math import sqrt

import numpy as np
from numpy.typing import NDArray

from optlaws.series import chebyshev
from optlaws.series.peaks import Peak, polished

Array = NDArray[np.float64]
Polynomial = tuple[float, ...]  # ascending powers of p


def acceleration_peak(u: int, H: int, M: float, alpha: Fraction) -> Peak:
    """Peak of c: the stationary points solve a quadratic in z = (1/2 - k)².

    Examples
    --------
    >>> acceleration_peak(0, 12, 0.1, Fraction(0))
    Peak(value=6.0, k=0.0)
    """
    slope = float(alpha)
    middle = float(1 + alpha * (Fraction(u + 1, 2 * (2 * u + 5)) - Fraction(1, 4)))  # y at k = 1/2
    quadratic = (-0.25 * middle, (2 * u + 1) * middle - 0.75 * slope, (2 * u + 3) * slope)
    start = 6.0 * (1.0 + slope * M) if u == 0 else 0.0
    best = Peak(start, 0.0)
    for z in _positive_roots(*quadratic):
        if z < 0.25:
            value = H * (0.25 - z) ** u * sqrt(z) * (middle + slope * z)
            if value > best.value:
                best = Peak(value, 0.5 - sqrt(z))
    return best


def _positive_roots(constant: float, linear: float, square: float) -> list[float]:
    """Positive roots of a quadratic that has real ones, without loss where it is nearly linear."""
    half = -0.5 * (
        linear + (1.0 if linear >= 0.0 else -1.0) * sqrt(max(linear * linear - 4.0 * constant * square, 0.0))
    )
    found = [constant / half if half else 0.0, half / square if square else 0.0]
    return [z for z in found if z > 0.0]


def power_peak(u: int, H: int, M: Fraction, alpha: Fraction) -> Peak:
    """Peak of d: the stationary points solve a cubic in p.

    Examples
    --------
    >>> power_peak(0, 12, Fraction(1, 10), Fraction(0))
    Peak(value=3.464102, k=0.211325)
    """
    first = float(1 + alpha * M)
    slope = float(alpha)
    y: Polynomial = (first, -slope)
    F: Polynomial = (first / (u + 1), -slope / (u + 2))
    p, q = (0.0, 1.0), (0.25, -1.0)
    both = _product(y, F)
    parts = [
        _product((0.0, -1.0), both),
        _product((4.0 * u + 2.0,), _product(q, both)),
        _product((-2.0 * slope,), _product(_product(p, q), F)),
        _product((-2.0 * slope / (u + 2),), _product(_product(p, q), y)),
    ]
    cubic = np.sum([np.pad(one, (0, 4 - len(one))) for one in parts], axis=0)

    def d(p: float) -> float:
        q = max(0.25 - p, 0.0)
        return 0.5 * H * H * sqrt(q) * p ** (2 * u + 1) * (first - slope * p) * (F[0] + F[1] * p)

    return max(
        (Peak(d(p), 0.5 - sqrt(max(0.25 - p, 0.0))) for p in _roots(cubic, 0.0, 0.25)), key=lambda one: one.value
    )


def least_power(u: int, M: Fraction) -> float:
    """The alpha of least D: d is stationary in p and in alpha at the root of a cubic between M and M'.

    Stationary in alpha gives alpha as a function of p; then -1/(2q) + (2u+3)/p + 1/(M'-p) - 1/(p-M) = 0 with
    M' = M (u+2)/(u+1).

    Examples
    --------
    >>> round(least_power(0, Fraction(1, 10)), 9)
    2.286235382
    """
    low, high = float(M), float(M * Fraction(u + 2, u + 1))
    p, q, above, below = (0.0, 1.0), (0.25, -1.0), (high, -1.0), (-low, 1.0)
    cubic = (
        -0.5 * np.array(_product(p, _product(above, below)))
        + (2 * u + 3) * np.array(_product(q, _product(above, below)))
        + np.array(_product(p, _product(q, below)))
        - np.array(_product(p, _product(q, above)))
    )
    # the cubic is negative at M and positive at M'; among the candidates are real parts of its complex roots
    root = min(_roots(cubic, low, high), key=lambda one: abs(float(np.polynomial.polynomial.polyval(one, cubic))))
    rest = low / (u + 1) - root / (u + 2)
    return -((low - root) / (u + 1) + rest) / (2.0 * (low - root) * rest)


def _product(first: Polynomial, second: Polynomial) -> Polynomial:
    return tuple(np.convolve(first, second).tolist())


def _roots(powers: Array, low: float, high: float) -> list[float]:
    """Roots of a polynomial in [low, high]; leading coefficients that are nearly zero do no harm."""
    half, middle = 0.5 * (high - low), 0.5 * (high + low)
    inner = np.polynomial.Polynomial(powers)(np.polynomial.Polynomial([middle, half]))
    slope = inner.deriv()
    found = chebyshev.real_parts_of_roots(np.polynomial.chebyshev.poly2cheb(inner.coef).astype(np.float64))
    x = polished(found, lambda x: (np.asarray(inner(x)), np.asarray(slope(x))))
    return [float(one) for one in np.clip(middle + half * x, low, high)]
