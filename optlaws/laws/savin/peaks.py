"""Peaks of Savin's laws in closed form; theory in docs/theory/savin.md.

With p = k (1 - k), y = 1 + alpha (M - p) and q = 1/4 - p the laws are c = H p^u sqrt(q) y and
b = H/2 p^(u+1) F with F = (1 + alpha M)/(u+1) - alpha p/(u+2).
"""

from __future__ import annotations

from fractions import Fraction
from math import sqrt

from numpy.polynomial import Polynomial

from optlaws.series.panels import Panels
from optlaws.series.peaks import Peak

_p, _q = Polynomial([0.0, 1.0]), Polynomial([0.25, -1.0])
_TERMS = 5  # of a quartic: the cubics are of less


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
    roots = [constant / half if half else 0.0, half / square if square else 0.0]
    return [z for z in roots if z > 0.0]


def power_peak(u: int, H: int, M: Fraction, alpha: Fraction) -> Peak:
    """Peak of d: the stationary points solve a cubic in p.

    Examples
    --------
    >>> power_peak(0, 12, Fraction(1, 10), Fraction(0))
    Peak(value=3.464102, k=0.211325)
    """
    first = float(1 + alpha * M)
    slope = float(alpha)
    y, F = Polynomial([first, -slope]), Polynomial([first / (u + 1), -slope / (u + 2)])
    cubic = -_p * y * F + (4 * u + 2) * _q * y * F - 2.0 * slope * _p * _q * F - 2.0 * slope / (u + 2) * _p * _q * y

    def d(p: float) -> float:
        q = max(0.25 - p, 0.0)
        return 0.5 * H * H * sqrt(q) * p ** (2 * u + 1) * float(y(p)) * float(F(p))

    return max(
        (Peak(d(p), 0.5 - sqrt(max(0.25 - p, 0.0))) for p in _roots(cubic, 0.0, 0.25)), key=lambda peak: peak.value
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
    above, below = Polynomial([high, -1.0]), Polynomial([-low, 1.0])
    cubic = -0.5 * _p * above * below + (2 * u + 3) * _q * above * below + _p * _q * below - _p * _q * above
    # the cubic is negative at M and positive at M'; among the candidates are real parts of its complex roots
    root = min(_roots(cubic, low, high), key=lambda place: abs(float(cubic(place))))
    rest = low / (u + 1) - root / (u + 2)
    return -((low - root) / (u + 1) + rest) / (2.0 * (low - root) * rest)


def _roots(polynomial: Polynomial, low: float, high: float) -> list[float]:
    """Every place in [low, high] among which is each root."""
    return [float(place) for place in Panels((low, high), _TERMS).roots(polynomial, polynomial.deriv())]
