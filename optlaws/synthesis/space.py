"""The symmetric rest-to-rest laws of eq. 8 as a linear space with well-conditioned coordinates.

With x = 1 - 2k the velocities of eq. 8 are b = (k(1-k))^(l-1) times a polynomial. Gegenbauer polynomials of index
l - 1/2 are orthogonal for that weight, the stroke is carried by the first alone, and both Z(k) and c(k) are again
Gegenbauer series (of index l + 1/2 and l - 3/2): every function below has a closed form and nothing is expanded.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from optlaws.laws import PolynomialLaw

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class SymmetricSpace:
    """Laws of order l whose Z is odd about k = 1/2 and has `terms` free coefficients.

    Columns of each matrix are the base law S_l (first) and the free functions, scaled so that each has peak
    acceleration 1. Rows are Chebyshev coefficients in x = 1 - 2k for the acceleration, in t = 2x² - 1 for the
    even functions. Dimensionless.

    Attributes
    ----------
    acceleration
        c, odd in x.
    ratio
        b / (k(1-k))^(l-1), divided by the base law's constant value.
    ratio_scale
        What multiplies the Gegenbauer polynomials in `ratio`.
    chord
        (b(1/2) - b) / (1-2k)².
    middle
        b(1/2), one row.
    free_function
        Chebyshev series in 2k - 1 of Z, for the free functions only.
    base_ratio
        b / (k(1-k))^(l-1) of the base law.

    Examples
    --------
    >>> round(float(symmetric_space(4, 2).middle[0]), 12)
    2.1875
    """

    order: int
    terms: int
    acceleration: Array
    ratio: Array
    ratio_scale: Array
    chord: Array
    middle: Array
    free_function: Array
    base_ratio: float

    def law(self, coordinates: Array) -> PolynomialLaw:
        """The law with the given coordinates (one for each free function)."""
        series = self.acceleration[:, 0] + self.acceleration[:, 1:] @ coordinates
        series[::2] = 0.0
        series[1::2] *= -1.0
        if self.order == 1:
            ends = self.ratio.sum(axis=0)
            return PolynomialLaw(series, b0=float(ends[0] + ends[1:] @ coordinates))
        return PolynomialLaw(series)

    def z_series(self, coordinates: Array) -> Array:
        """Chebyshev series in 2k - 1 of Z."""
        series: Array = self.free_function @ coordinates
        return series


@lru_cache(maxsize=256)
def symmetric_space(order: int, terms: int) -> SymmetricSpace:
    """Build the space of order `order` with `terms` free functions (kept for the next call)."""
    count = 2 * (order + terms) + 2
    angle = (np.arange(count) + 0.5) * np.pi / count
    x = np.cos(angle)
    weight = 1.0 - x * x
    index = 2 * np.arange(terms + 1)

    polynomials = gegenbauer(order - 0.5, int(index[-1]), x)[index]
    velocity = weight ** (order - 1) * polynomials
    if order == 1:
        slopes = np.zeros_like(velocity)
        slopes[1:] = gegenbauer(1.5, int(index[-1]), x)[index[1:] - 1]
    else:
        factor = -(index + 1) * (index + 2 * order - 2) / (2 * order - 3)
        slopes = factor[:, None] * weight ** (order - 2) * gegenbauer(order - 1.5, int(index[-1]) + 1, x)[index + 1]
    acceleration = -2.0 * slopes

    scale = np.ones(terms + 1)
    scale[1:] = 1.0 / np.abs(acceleration[1:]).max(axis=1)
    scale[0] = _smoothstep_factor(order) / 4.0 ** (order - 1)
    ratio_scale = scale / scale[0]
    velocity_series = chebyshev_series((velocity * scale[:, None]).T, angle)
    velocity_even = velocity_series[::2]

    n = index[1:] - 1
    to_z = (scale[1:] / 2) * (2 * order - 1) / ((n + 1) * (n + 2 * order)) * (-4.0) ** order
    free = -gegenbauer(order + 0.5, max(int(index[-1]) - 1, 0), x)[n] * to_z[:, None]
    return SymmetricSpace(
        order=order,
        terms=terms,
        acceleration=_frozen(chebyshev_series((acceleration * scale[:, None]).T, angle)),
        ratio=_frozen(chebyshev_series((polynomials * ratio_scale[:, None]).T, angle)[::2]),
        ratio_scale=_frozen(ratio_scale),
        chord=_frozen(_chord(velocity_even)),
        middle=_frozen((-1.0) ** np.arange(len(velocity_even)) @ velocity_even),
        free_function=_frozen(chebyshev_series(free.T, angle)[: 2 * terms]),
        base_ratio=float(scale[0]) * 4.0 ** (order - 1),
    )


def gegenbauer(index: float, degree: int, x: Array) -> Array:
    """Gegenbauer polynomials of the given index, degrees 0 to `degree`, one row each, by their recurrence.

    Examples
    --------
    >>> gegenbauer(0.5, 2, np.array([1.0]))[:, 0].tolist()
    [1.0, 1.0, 1.0]
    """
    rows = np.empty((degree + 1, len(x)))
    rows[0] = 1.0
    if degree:
        rows[1] = 2.0 * index * x
    for m in range(1, degree):
        rows[m + 1] = (2 * (m + index) * x * rows[m] - (m + 2 * index - 1) * rows[m - 1]) / (m + 1)
    return rows


def even_gegenbauer_jet(index: float, terms: int, t: Array) -> Array:
    """Gegenbauer polynomials of degrees 0, 2, ..., 2 `terms` in x with t = 2x² - 1, and two derivatives by t.

    Shape (3, points, terms + 1). By recurrence, so that the relative error stays small where the values are small
    beside those at x = 1, which no series in a fixed basis can give.
    """
    square = (t + 1.0) / 2.0
    rows = np.zeros((terms + 1, 3, len(t)))
    rows[0, 0] = 1.0
    shift = np.zeros((3, len(t)))
    for m in range(terms):
        n = 2 * m
        up, up2 = ((n + i + 1) / (2 * (n + i + index)) for i in (0, 1))
        down2 = (n + 2 * index) / (2 * (n + 1 + index))
        shift[1:] = rows[m, :2]
        shift[1] /= 2.0
        following = square * rows[m] + shift
        if n:
            down = (n + 2 * index - 1) / (2 * (n + index))
            before = n / (2 * (n - 1 + index))
            down0 = (n + 2 * index - 2) / (2 * (n - 1 + index))
            following -= (up * down2 + down * before) * rows[m] + down * down0 * rows[m - 1]
        else:
            following -= up * down2 * rows[m]
        rows[m + 1] = following / (up * up2)
    return rows.transpose(1, 2, 0)


def chebyshev_series(values: Array, angle: Array) -> Array:
    """Chebyshev coefficients of functions known at x = cos(angle), the Chebyshev points; one column a function."""
    count = len(angle)
    transform = np.cos(np.outer(np.arange(count), angle)) * (2.0 / count)
    transform[0] /= 2.0
    series: Array = transform @ values
    return series


def _chord(even: Array) -> Array:
    # T_2m(x) - T_2m(0) = -2 (-1)^m sin²(m p) with x = sin p: the division by x² has a closed form
    rows = len(even)
    angle = (np.arange(rows) + 0.5) * np.pi / rows
    p = np.arcsin(np.cos(angle / 2))
    m = np.arange(rows)
    kernel = 2.0 * (-1.0) ** m * (np.sin(np.outer(p, m)) / np.sin(p)[:, None]) ** 2
    return chebyshev_series(kernel @ even, angle)


def _smoothstep_factor(order: int) -> float:
    factor = 1.0
    for i in range(1, order):
        factor *= 2.0 * (2 * i + 1) / i
    return factor


def _frozen(values: Array) -> Array:
    values.setflags(write=False)
    return values
