"""How far b stays below its peak at a given k, divided by what that vanishes like there: undivided it is ill posed."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.polynomial import legendre

from optlaws.numbers import Array


def chord(jerk: Callable[[Array], Array], u: Array, centre: float, degree: int) -> Array:
    """(b - b0) / (u - u0)² at points u where b has the value b0 and no slope at u0; by an integral, so nothing cancels.

    Parameters
    ----------
    jerk
        Columns of j at points u = 1 - 2k, shape (points, columns); polynomials of a degree.
    u, centre
        The points and u0.
    degree
        The degree of b.

    Examples
    --------
    >>> chord(lambda u: np.full((len(u), 1), 8.0), np.array([0.25]), 0.5, 2)  # b = 1 + (u - 0.5)²
    array([[1.]])
    """
    # by Taylor the mean of b'' with the weight 1 - s, and b'' by u is j/4
    return _mean(jerk, u, centre, degree, lambda share: 1.0 - share) / 4.0


def kink(acceleration: Callable[[Array], Array], u: Array, centre: float, degree: int) -> Array:
    """(b - b0) / |u - u0| on one side of u0 where b has a kink; otherwise as `chord`.

    Examples
    --------
    >>> kink(lambda u: np.full((len(u), 1), -4.0), np.array([0.75]), 0.5, 1)  # b = 1 + 2 (u - 0.5)
    array([[2.]])
    """
    side = np.sign(u - centre)[:, None]
    return -side * _mean(acceleration, u, centre, degree, np.ones_like) / 2.0


def _mean(
    values: Callable[[Array], Array], u: Array, centre: float, degree: int, weight: Callable[[Array], Array]
) -> Array:
    x, weights = legendre.leggauss(degree // 2 + 2)
    share = (1.0 + x) / 2.0
    places = centre + np.outer(u - centre, share)
    columns = values(places.reshape(-1)).reshape(len(u), len(share), -1)
    return np.asarray(np.einsum("psc,s->pc", columns, weights * weight(share) / 2.0))
