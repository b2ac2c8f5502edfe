"""Proven bounds of the error of Chebyshev series and their derivatives summed in floating point."""

from __future__ import annotations

from math import comb, prod

import numpy as np

from optlaws.numbers import Array
from optlaws.tolerances import ROUNDOFF, TINY

_BOUND_ROUNDING = 2.0**-30  # of a bound of roundings: more than its own sum of positive numbers is rounded by

ORDERS = 4
#: roundings of a step, of a mixed coefficient with its own, and of a place in [-1, 1] less what its scale adds
_STEP, _MIXED, _PLACE = 4, 8, 6


def summation_bounds(magnitudes: Array, scale: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Bounds of the error and of the value of a series and its three derivatives by k, for every x in [-1, 1].

    Clenshaw's recurrence b_n = c_n + 2 x b_(n+1) - b_(n+2) is run with its derivatives, of which the order m has
    2 m b_(n+1) of the order m - 1 in place of c_n. What a step is rounded by counts as a change of c_n: at n and of the
    order s it changes the derivative m by comb(m, s) times the derivative m - s of T_n, which is greatest at x = 1. A
    step is rounded at most four times, each by a unit roundoff of its terms; they are bounded by the derivatives at 1
    of the Chebyshev polynomials of the second kind. Fused operations round less.

    Parameters
    ----------
    magnitudes
        Of the coefficients, shape (n,); of several series that are mixed by weights from 0 to 1, the greatest each.
    scale
        dx/dk, by which each derivative is multiplied.

    Examples
    --------
    >>> errors, values = summation_bounds(np.array([0.5, 0.5]), 2.0)
    >>> [f"{error:.1e}" for error in errors], [round(value, 12) for value in values]
    (['2.8e-15', '3.1e-15', '1.0e-300', '1.0e-300'], [1.0, 1.0, 0.0, 0.0])
    """
    last = len(magnitudes) - 1
    first_kind = np.array([[_at_end(n, m) for n in range(last + 2)] for m in range(ORDERS + 2)])
    rounded = magnitudes * (1.0 + _gamma(_MIXED))
    changes = _changes(rounded, first_kind)
    errors, values = [], []
    for m in range(ORDERS):
        value = float(first_kind[m, : last + 1] @ rounded)
        moved = ((2.0 * scale + _PLACE) * ROUNDOFF) * float(first_kind[m + 1, : last + 1] @ rounded)
        total = _gamma(_MIXED) * value + moved
        total += sum(comb(m, s) * float(changes[s] @ first_kind[m - s, : last + 1]) for s in range(m + 1))
        factor = scale**m * (1.0 + _BOUND_ROUNDING)
        errors.append(factor * (total + _gamma(4 * m + 4) * (value + total)) + TINY)
        values.append(scale**m * value)
    return tuple(errors), tuple(values)


def _changes(rounded: Array, first_kind: Array) -> Array:
    """Rounding bounds of each step of each order, shape (orders, n); the last sum is the step of n = 0."""
    count = len(rounded)
    changes, terms = np.zeros((ORDERS, count)), np.zeros((ORDERS, count + 2))
    # U_n is the derivative of T_(n+1), divided by n + 1
    second_kind = first_kind[1:, 1:] / np.arange(1, first_kind.shape[1])
    for n in range(count - 1, -1, -1):
        for m in range(ORDERS):
            given = rounded[n] if m == 0 else 2.0 * m * terms[m - 1, n + 1]
            changes[m, n] = _gamma(_STEP) * (given + 2.0 * terms[m, n + 1] + terms[m, n + 2])
            by_order = [changes[s, n:] + (rounded[n:] if s == 0 else 0.0) for s in range(m + 1)]
            terms[m, n] = sum(
                comb(m, s) * float(given_there @ second_kind[m - s, : count - n])
                for s, given_there in enumerate(by_order)
            )
    return changes


def _at_end(n: int, m: int) -> float:
    """The derivative of order m of T_n at 1."""
    return float(prod((n * n - i * i) / (2 * i + 1) for i in range(m)))


def _gamma(count: int) -> float:
    return count * ROUNDOFF / (1.0 - count * ROUNDOFF)
