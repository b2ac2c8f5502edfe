"""Where smooth functions may be extreme between two places."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from optlaws.errors import InputError
from optlaws.series.chebyshev import derivative, from_values, interpolated, nodes, real_parts_of_roots

Array = NDArray[np.float64]

_DEEPEST, _DENSE = 12, 129
#: of the greatest value: quotients of small numbers are rounded more than others
_BLUR = 1e-8


def series_between(
    function: Callable[[Array], Array], ends: tuple[float, float], count: int | None = None
) -> Array | None:
    """Chebyshev series of a function in what runs from -1 to 1 between two places; None where it is not smooth.

    Parameters
    ----------
    function
        Of an array of places.
    ends
        The two places.
    count
        How many coefficients it has, where that is known.

    Examples
    --------
    >>> series_between(lambda x: x * x, (0.0, 2.0)).round(12)
    array([1.5, 2. , 0.5])
    """
    low, high = ends

    def of_local(x: Array) -> Array:
        return function(low + (high - low) * (x + 1.0) / 2.0)

    if count is not None:
        return from_values(of_local(nodes(count)))
    try:
        return interpolated(of_local, "the function", _BLUR)
    except InputError:
        return None


def candidates(
    function: Callable[[Array], Array], ends: tuple[float, float], count: int | None = None, depth: int = 0
) -> Array:
    """Places among which every stationary point of a function is; parts that are not smooth are cut in two.

    Examples
    --------
    >>> candidates(lambda x: (x - 0.25) ** 2, (0.0, 1.0)).round(12)
    array([0.25])
    """
    series = series_between(function, ends, count)
    low, high = ends
    if series is not None:
        places: Array = low + (high - low) * (real_parts_of_roots(derivative(series)) + 1.0) / 2.0
        return places
    if depth >= _DEEPEST:
        return low + (high - low) * (np.cos(np.linspace(0.0, np.pi, _DENSE)) + 1.0) / 2.0
    middle = (low + high) / 2.0
    halves = [candidates(function, half, None, depth + 1) for half in ((low, middle), (middle, high))]
    return np.concatenate([*halves, [middle]])
