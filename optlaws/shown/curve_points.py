"""Places at which curves are sampled, so that what is drawn is the curve: denser at bends, and at each extreme."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from optlaws.numbers import Array

_DRAWN_DEVIATION = 2e-3  # of a curve's range: a line between two of its places is the curve to the eye
_SAME = 1e-7  # of the range: nearer places are one, for so far rounding moves an extreme beside an end at rest

_ROUNDS = 9
_MOST = 4000


def refined(
    places: Array, values: Sequence[Array], functions: Sequence[Callable[[Array], Array]], extremes: Array
) -> tuple[Array, list[Array]]:
    """Curves over common places, with those added that straight lines between them need, and the places of extremes.

    A place that comes twice is a jump, with the values on its two sides; nothing is added between them. Places are
    halved wherever a curve leaves the line between its neighbours by more than a 500th of its range.

    Examples
    --------
    >>> k = np.linspace(0.0, 1.0, 5)
    >>> narrow = lambda x: np.exp(-((40.0 * (x - 0.3)) ** 2))
    >>> places, (drawn,) = refined(k, [narrow(k)], [narrow], np.array([0.3]))
    >>> round(float(drawn.max()), 12), 20 < len(places) < 200
    (1.0, True)
    """
    inside = extremes[(extremes > places[0]) & (extremes < places[-1])]
    places, curves = _with(places, list(values), functions, inside)
    added = [_added(places, curve, function) for curve, function in zip(curves, functions, strict=True)]
    return _with(places, curves, functions, np.concatenate(added))


def _with(
    places: Array, values: Sequence[Array], functions: Sequence[Callable[[Array], Array]], more: Array
) -> tuple[Array, list[Array]]:
    """Curves with places in between, in their order."""
    new = np.unique(away_from(more, places))
    if not new.size:
        return places, list(values)
    order = np.argsort(np.concatenate([places, new]), kind="stable")
    curves = [np.concatenate([curve, f(new)])[order] for curve, f in zip(values, functions, strict=True)]
    return np.concatenate([places, new])[order], curves


def _added(places: Array, values: Array, function: Callable[[Array], Array]) -> Array:
    finite = values[np.isfinite(values)]
    allowed = _DRAWN_DEVIATION * float(np.ptp(finite)) if finite.size else 0.0
    left, right, at_left, at_right = places[:-1], places[1:], values[:-1], values[1:]
    added: list[Array] = []
    for _ in range(_ROUNDS):
        middle = 0.5 * (left + right)
        there = (middle > left) & (middle < right) & np.isfinite(at_left) & np.isfinite(at_right)
        left, middle, right, at_left, at_right = (each[there] for each in (left, middle, right, at_left, at_right))
        if not len(middle) or sum(map(len, added)) > _MOST:
            break
        at_middle = function(middle)
        far = np.abs(at_middle - 0.5 * (at_left + at_right)) > allowed
        added.append(middle[far])
        left, right = np.concatenate([left[far], middle[far]]), np.concatenate([middle[far], right[far]])
        at_left, at_right = (
            np.concatenate([at_left[far], at_middle[far]]),
            np.concatenate([at_middle[far], at_right[far]]),
        )
    return np.concatenate([np.empty(0), *added])


def away_from(more: Array, places: Array) -> Array:
    """Those that are none of the ordered places but for rounding, so that a curve in other units has as many places."""
    right = np.searchsorted(places, more)
    near = [np.abs(more - places[np.clip(right + side, 0, len(places) - 1)]) for side in (-1, 0)]
    return np.asarray(more[np.minimum(*near) > _SAME * (places[-1] - places[0])])
