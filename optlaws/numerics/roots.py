"""Places where functions change their sign or take a value, and bisection."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import inf, isfinite

import numpy as np

from optlaws.numbers import Array
from optlaws.numerics.chebyshev import derivative, from_values, nodes, real_parts_of_roots, shortened
from optlaws.tolerances import EPSILON, ROUNDOFF, TOUCHING, VALUE_ROUNDING

_NEAR_NOTHING = 0.5  # of the least value looked at beside it: a turning point nearer to 0 is looked at itself

#: how often parabolas lead to a turning point
_TURNS = 3
#: more than roots between places that are near each other need
_CHANDRUPATLA = 100
#: how near its ends, in shares of a bracket, the first place is
_EDGE = 0.05
#: steps of a secant to a falling root
_FALLING = 40


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
        above = height * np.sign(g)
    near = (np.sign(f) == np.sign(g)) & (np.sign(g) == np.sign(h)) & (above < _NEAR_NOTHING * np.abs(g))
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


def falling_root(
    excess: Callable[[float], float], begin: float, step: float, met: float, widest: float = 60.0
) -> float:
    """A place at which a falling excess is not above 0, at most `met` beyond one at which it is; infinite without one.

    Sought from a place on in growing steps, then by the secant, at least half of `met` from either end; an infinite
    excess halves the bracket. So far from the first place as `widest`, the last place is what is known.

    >>> (
    ...     round(float(falling_root(lambda x: np.exp(-x) - 2.0, 0.0, 0.5, 1e-12)), 9),
    ...     falling_root(lambda x: 1.0, 0.0, 0.5, 1e-12),
    ... )
    (-0.693147181, inf)
    """
    high, wider = begin, step
    while excess(high) > 0.0:
        high, wider = high + wider, 2.0 * wider
        if high > begin + widest:
            return inf
    low, wider = high - step, step
    while excess(low) <= 0.0:
        high, low, wider = low, low - wider, 2.0 * wider
        if low < begin - widest:
            return high
    above, below, stayed = excess(low), excess(high), ""
    for _ in range(_FALLING):
        if high - low <= met or below == 0.0:
            break
        middle = 0.5 * (low + high)
        if isfinite(above):
            middle = high - below * (high - low) / (below - above)
            middle = min(max(middle, low + 0.5 * met), high - 0.5 * met)
        value = excess(middle)
        # an end that stays twice counts half (Illinois)
        if value > 0.0:
            low, above, below, stayed = middle, value, below * (0.5 if stayed == "high" else 1.0), "high"
        else:
            high, below, above, stayed = middle, value, above * (0.5 if stayed == "low" else 1.0), "low"
    return high


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
    crossed = []
    for i in passed:
        falling = bool(signs[0, i] > 0.0)  # nothing is evaluated at the two ends
        low, high = float(places[i]), float(places[i + 1])
        crossed.append(bisect(lambda k: (f(k) > value) == falling, low, high)[0])  # noqa: B023 - called at once
    return np.sort(np.concatenate([touched, crossed]))
