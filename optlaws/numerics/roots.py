"""Roots of functions: places where they may be extreme, change their sign or take a value; and bisection.

Series of smooth parts have them all; bisection finds one between two places.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from optlaws.errors import InputError
from optlaws.numbers import Array
from optlaws.numerics.chebyshev import derivative, from_values, interpolated, nodes, real_parts_of_roots, shortened
from optlaws.tolerances import EPSILON, ROUNDOFF, TOUCHING, VALUE_ROUNDING

_NEAR_NOTHING = 0.5  # of the least value looked at beside it: a turning point nearer to 0 is looked at itself
_QUOTIENT_BLUR = 1e-8  # of the greatest value: quotients of small numbers are rounded more than others

_DEEPEST = 12
#: how often parabolas lead to a turning point
_TURNS = 3
#: more than roots between places that are near each other need
_CHANDRUPATLA = 100
#: how near its ends, in shares of a bracket, the first place is
_EDGE = 0.05
#: for parts so short that nothing is smooth on them
_CLOSE = np.cos(np.linspace(0.0, np.pi, 129))


def series_between(
    function: Callable[[Array], Array], ends: tuple[float, float], count: int | None = None
) -> Array | None:
    """Chebyshev series of a function in what runs from -1 to 1 between two places; None where it is not smooth.

    >>> series_between(lambda x: x * x, (0.0, 2.0)).round(12)
    array([1.5, 2. , 0.5])
    """
    low, high = ends

    def of_local(x: Array) -> Array:
        return function(low + (high - low) * (x + 1.0) / 2.0)

    if count is not None:
        return from_values(of_local(nodes(count)))
    try:
        return interpolated(of_local, "the function", _QUOTIENT_BLUR)
    except InputError:
        return None


def candidates(function: Callable[[Array], Array], ends: tuple[float, float], count: int | None = None) -> Array:
    """Places among which every stationary point of a function is; parts that are not smooth are cut in two.

    >>> candidates(lambda x: (x - 0.25) ** 2, (0.0, 1.0)).round(12)
    array([0.25])
    """
    places: list[Array] = []
    for low, high, series in _parts(function, ends, count):
        x = _CLOSE if series is None else real_parts_of_roots(derivative(series))
        places += [low + (high - low) * (x + 1.0) / 2.0, np.array([high])]
    return np.concatenate(places[:-1])


def roots_between(function: Callable[[Array], Array], ends: tuple[float, float]) -> Array:
    """Places strictly between two among which every change of sign of a function is; kinks are cut at.

    >>> roots_between(lambda x: x * x - 0.25, (0.0, 2.0)).round(12)
    array([0.5])
    """
    places: list[Array] = []
    for low, high, series in _parts(function, ends):
        x = np.empty(0) if series is None else real_parts_of_roots(series)
        roots = low + (high - low) * (x + 1.0) / 2.0
        places += [np.unique(roots[(roots > low) & (roots < high)]), np.array([high])]
    return np.concatenate(places[:-1])


def _parts(
    function: Callable[[Array], Array], ends: tuple[float, float], count: int | None = None, depth: int = 0
) -> Iterator[tuple[float, float, Array | None]]:
    """Ends of parts in which a function is smooth, with its series there; None where no short part is smooth."""
    series, (low, high) = series_between(function, ends, count), ends
    if series is not None or depth >= _DEEPEST:
        yield low, high, series
        return
    middle = (low + high) / 2.0
    yield from _parts(function, (low, middle), None, depth + 1)
    yield from _parts(function, (middle, high), None, depth + 1)


def cut_at_roots(function: Callable[[float, float], Callable[[Array], Array]], edges: list[float]) -> list[float]:
    """The edges and, between them, the sign changes of functions, except for nearly coincident ones.

    >>> cut_at_roots(lambda low, high: np.cos, [0.0, 2.0, 3.0])
    [0.0, 1.570796..., 2.0, 3.0]
    """
    edge = edges[:1]
    for low, high in pairwise(edges):
        of = function(low, high)
        edge += [*_changes(of, np.array([low, *roots_between(of, (low, high)), high])), high]
    return edge


def cut_at_all(functions: Iterable[Callable[[Array], Array]], edges: list[float]) -> list[float]:
    """The edges, and between them the places where any of several functions, smooth there, changes its sign.

    >>> cut_at_all([np.cos, np.sin], [1.0, 4.0])
    [1.0, 1.570796..., 3.141592..., 4.0]
    """
    places = {*edges}
    for function in functions:
        places.update(cut_at_roots(lambda low, high: function, edges))  # noqa: ARG005, B023 - it is called at once
    return sorted(places)


def sign_changes(functions: Callable[[Array], Array], edges: Sequence[float], count: int) -> Array:
    """Places between edges where any of several smooth functions changes its sign, ascending.

    Looked at where a series of as many terms is fixed, where these series turn, and where parabolas come near 0 between
    these: no change of a polynomial of a degree below the count is missed, however near others are. A root is known to
    rounding, or to what rounding of the greatest value makes of it.

    Parameters
    ----------
    functions
        Of places, the values of all functions, one row each.
    edges
        Ascending; at none of them a change is looked for.
    count
        The terms of each series between two edges.

    Examples
    --------
    >>> sign_changes(lambda x: np.array([np.cos(x), np.sin(x)]), [1.0, 2.5, 4.0], 8).round(12)
    array([1.57079633, 3.14159265])
    """
    low, width = np.array(edges[:-1])[:, None], np.diff(edges)[:, None]
    places = (low + width * (1.0 - nodes(count)) / 2.0).ravel()
    values = functions(places)
    for turn in range(_TURNS + 1):
        stationary = _turning_points(places, values) if turn else _where_series_turn(values, low, width)
        turning = np.setdiff1d(stationary, places)
        if not len(turning):
            continue
        places = np.concatenate([places, turning])
        order = np.argsort(places, kind="stable")
        places, values = places[order], np.hstack([values, functions(turning)])[:, order]
    brackets: list[tuple[int, int, int]] = []
    piece = np.searchsorted(edges, places)
    for row, of in enumerate(values):
        plain = np.flatnonzero(np.abs(of) > VALUE_ROUNDING * np.abs(of).max(initial=0.0))
        first, second = plain[:-1], plain[1:]
        turns = (np.sign(of[first]) != np.sign(of[second])) & (piece[first] == piece[second])
        brackets += [(row, int(i), int(j)) for i, j in zip(first[turns], second[turns], strict=True)]
    if not brackets:
        return np.empty(0)
    rows, before, after = np.array(brackets).T
    columns = np.arange(len(rows))
    return np.unique(
        bracketed_roots(
            lambda x: functions(x)[rows, columns],
            (places[before], places[after]),
            (values[rows, before], values[rows, after]),
            ROUNDOFF * np.abs(values).max(axis=1)[rows],
        )
    )


def _where_series_turn(values: Array, low: Array, width: Array) -> Array:
    """Places where the series through values at the nodes between edges, a row each, are stationary, and their ends."""
    # beside the edges too, on whose far sides the functions may be others
    places = [(low + ROUNDOFF * width)[:, 0], (low + (1.0 - 2.0 * ROUNDOFF) * width)[:, 0]]
    for of in values:
        noise = VALUE_ROUNDING * float(np.abs(of).max())
        for piece, start, length in zip(of.reshape(len(low), -1), low[:, 0], width[:, 0], strict=True):
            if np.isfinite(noise) and np.abs(piece).max() > noise:
                x = real_parts_of_roots(derivative(shortened(from_values(piece[::-1]), noise)))
                places.append(start + length * (x[np.abs(x) < 1.0] + 1.0) / 2.0)
    return np.concatenate(places)


def _turning_points(places: Array, values: Array) -> Array:
    """Places where parabolas through three values of one sign come near 0 or cross it."""
    x, y, z = places[:-2], places[1:-1], places[2:]
    f, g, h = values[:, :-2], values[:, 1:-1], values[:, 2:]
    rise, fall = (g - f) / (y - x), (h - g) / (z - y)
    bend = (fall - rise) / (z - x)
    with np.errstate(all="ignore"):
        slope = rise + bend * (y - x)
        at = y - slope / (2.0 * bend)
        height = g - slope**2 / (4.0 * bend)
    near = (np.sign(f) == np.sign(g)) & (np.sign(g) == np.sign(h)) & (height * np.sign(g) < _NEAR_NOTHING * np.abs(g))
    return np.unique(at[near & (x < at) & (at < z)])


def bracketed_roots(
    function: Callable[[Array], Array],
    ends: tuple[Array, Array],
    values: tuple[Array, Array],
    nothing: Array | float = 0.0,
) -> Array:
    """Roots many at once, each between two places where a function has values of different signs, or nearly `nothing`.

    Inverse quadratic interpolation where it is safe, and halving (Chandrupatla, Advances in Engineering Software 28
    (1997) 145).

    >>> ends = np.array([1.0, 1.0]), np.array([2.0, 2.0])
    >>> bracketed_roots(lambda x: x * x - [2.0, 3.0], ends, (np.array([-1.0, -2.0]), np.array([2.0, 1.0])))
    array([1.41421356, 1.73205081])
    """
    (a, b), (fa, fb) = ends, values
    c, fc, share = a, fa, np.clip(fa / (fa - fb), _EDGE, 1.0 - _EDGE)
    for _ in range(_CHANDRUPATLA):
        x = a + share * (b - a)
        fx = function(x)
        same = np.sign(fx) == np.sign(fa)
        c, fc = np.where(same, a, b), np.where(same, fa, fb)
        b, fb = np.where(same, b, a), np.where(same, fb, fa)
        a, fa = x, fx
        width = np.abs(b - a)
        least = 2.0 * EPSILON * np.maximum(np.abs(a), np.abs(b))
        done = (width <= 2.0 * least) | (np.abs(fa) <= nothing)
        if done.all():
            break
        with np.errstate(all="ignore"):
            xi, phi = (a - b) / (c - b), (fa - fb) / (fc - fb)
            smooth = (phi**2 < xi) & ((1.0 - phi) ** 2 < 1.0 - xi)
            inverse = fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb)
            nearest = np.minimum(least / width, 0.5)
        share = np.where(smooth & np.isfinite(inverse), np.clip(inverse, nearest, 1.0 - nearest), 0.5)
        share = np.where(done, 0.0, share)
    return np.where(np.abs(fa) <= np.abs(fb), a, b)


def bracketed_root(function: Callable[[float], float], low: float, high: float) -> float:
    """The root between two places where a function has different signs, as `bracketed_roots` finds many.

    >>> bracketed_root(lambda x: x * x - 2.0, 1.0, 2.0)
    1.41421356...
    """
    ends = np.array([low]), np.array([high])
    values = np.array([function(low)]), np.array([function(high)])
    return float(bracketed_roots(lambda x: np.array([function(float(x[0]))]), ends, values)[0])


def _changes(function: Callable[[Array], Array], places: Array) -> list[float]:
    """Inner places at which a function changes its sign by more than rounding."""
    values = function((places[1:] + places[:-1]) / 2.0)
    plain = np.flatnonzero(np.abs(values) > VALUE_ROUNDING * np.abs(values).max())
    turns = np.sign(values[plain[1:]]) != np.sign(values[plain[:-1]])
    return [float(place) for place in places[plain[1:]][turns]]


def bisect(holds: Callable[[float], bool], inside: float, outside: float, halvings: int = 200) -> tuple[float, float]:
    """Neighbours after a number of halvings: a condition holds at the first and fails at the second.

    For conditions; where a function's sign changes, `bracketed_root` needs fewer steps.

    >>> last, first = bisect(lambda x: x * x <= 2.0, 0.0, 2.0)
    >>> last * last <= 2.0 < first * first, first - last < 1e-15
    (True, True)
    """
    for _ in range(halvings):
        middle = 0.5 * (inside + outside)
        if middle in (inside, outside):
            break
        if holds(middle):
            inside = middle
        else:
            outside = middle
    return inside, outside


def holds_throughout(holds: Callable[[float, float], bool], low: float, high: float, deepest: int = 60) -> bool:
    """Whether a condition on ranges holds on a partition of the whole range, halved where it fails.

    >>> holds_throughout(lambda low, high: high - low < 0.3, 0.0, 1.0)
    True
    """
    waiting = [(low, high, 0)]
    while waiting:
        first, last, depth = waiting.pop()
        if holds(first, last):
            continue
        if depth == deepest:
            return False
        middle = 0.5 * (first + last)
        waiting += [(first, middle, depth + 1), (middle, last, depth + 1)]
    return True


def bisect_each(
    holds: Callable[[Array], NDArray[np.bool_]], inside: Array, outside: Array, halvings: int = 60
) -> tuple[Array, Array]:
    """Pairs of places many at once: a condition on arrays holds at the first of each pair, not at the second.

    >>> bisect_each(lambda x: x * x <= np.array([2.0, 9.0]), np.zeros(2), np.full(2, 4.0))[0].round(12)
    array([1.41421356, 3.        ])
    """
    for _ in range(halvings):
        middle = 0.5 * (inside + outside)
        within = holds(middle)
        inside, outside = np.where(within, middle, inside), np.where(within, outside, middle)
    return inside, outside


def crossings(f: Callable[[float], float], places: Array, after: Array, before: Array, value: float) -> Array:
    """All places, ascending, where a function has a value; for a stretch of constant value, both ends.

    A jump over the value is no place that has it.

    Parameters
    ----------
    f
        The function.
    places
        Ascending places; it is monotone between neighbours.
    after, before
        Its values just after and just before each of them, which differ where it jumps.
    value
        The value.

    Examples
    --------
    >>> ends, heights = np.array([0.0, 0.5, 1.0]), np.array([1.0, 0.0, 1.0])
    >>> crossings(lambda x: (2 * x - 1) ** 2, ends, heights, heights, 0.25).round(12).tolist()
    [0.25, 0.75]
    """
    heights = np.array([after, before])
    size = np.abs(heights[np.isfinite(heights)]).max(initial=abs(value))
    signs = np.where(np.abs(heights - value) <= TOUCHING * size, 0.0, np.sign(heights - value))
    touched = places[(signs == 0.0).any(axis=0)]
    passed = np.flatnonzero(signs[0, :-1] * signs[1, 1:] < 0.0)
    crossed = [_crossing(f, float(places[i]), float(places[i + 1]), value, signs[0, i] > 0.0) for i in passed]
    return np.sort(np.concatenate([touched, crossed]))


def _crossing(f: Callable[[float], float], left: float, right: float, value: float, falling: bool) -> float:  # noqa: FBT001
    """The place where a monotone function passes a value; nothing is evaluated at its two ends."""
    return bisect(lambda k: (f(k) > value) == falling, left, right)[0]
