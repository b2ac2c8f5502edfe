"""Standard laws in the moves of samples: a chain of moves between places and heights that are found with them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import product
from math import log
from typing import Any

import numpy as np

from optlaws.laws import MotionLaw
from optlaws.laws.catalogue.catalogue import catalogue
from optlaws.numbers import Array

_ROUGH_FIT = 1e-4  # of the last step of a fit: enough where laws are only ranked by how near they come
_CLOSE_FIT = 1e-12  # the same where the ends of moves are to have all digits
#: rows by which laws are ranked, and how many of the best are compared at all rows, of a single move and of several
_RANKED_BY, _COMPARED, _COMBINED = 60, 4, 3
#: moves of a chain of which every combination of the best laws is tried
_MOST_COMBINED = 3
#: steps to which places are rounded where the rows allow it, in parts of a turn
_ROUND = (1.0 / 36.0, 1.0 / 72.0, 1.0 / 360.0, 1.0 / 720.0, 1.0 / 3600.0)
#: a master that is longer is no turn in radians or turns
_RADIANS = 12.0
#: by how much the sum of squares may grow for each place that is rounded
_AS_LIKELY = 4.0
#: of the last digit: rows that are no farther off are the law's own
_ROUNDED = 0.5001


@dataclass(frozen=True, eq=False)
class Chain:
    """Standard laws one after another, from rest to rest each or as their law has it.

    Attributes
    ----------
    names
        Of the laws, n of them; "" of a rest between two moves.
    places, heights
        Where they meet, arrays of shape (n + 1,).
    squares
        The sum of squares of the rows about them, over the variance of the noise.
    free
        The number of parameters that were found.
    deviations
        The standard deviations of places, shape (n + 1,), and of heights behind these, for the noise of the rows.
    """

    names: tuple[str, ...]
    places: Array
    heights: Array
    squares: float
    free: int
    deviations: Array

    def __call__(self, x: Array) -> Array:
        """The positions at places; those at its ends beyond them."""
        return _positions(self.names, self.places, self.heights, x)

    def rounded(self, x: Array, y: Array, noise: Array, digit: float, bounds: tuple[float, float]) -> Chain:
        """The chain with places as round, and heights, as the rows allow; it ends in the bounds."""
        turn = 360.0 if np.ptp(x) > _RADIANS else 1.0
        count = len(self.places)
        for share in (*_ROUND, 0.0):
            places, heights = self.places, self.heights.copy()
            if share:
                places = np.round(places / (share * turn)) * share * turn
                if digit:
                    free = self.deviations[count:] > 0.0
                    heights = np.where(free, np.round(heights / digit) * digit, heights)
                for i, name in enumerate(self.names):
                    if not name:
                        heights[i + 1] = heights[i]
            places = np.clip(places, *bounds)
            if np.all(np.diff(places) > 0.0):
                off = _positions(self.names, places, heights, x) - y
                squares = float(((off / noise) ** 2).sum())
                rounded = 0.0 < float(np.abs(off).max()) <= _ROUNDED * digit
                if squares <= self.squares + _AS_LIKELY * count or rounded or not share:
                    return replace(self, places=places, heights=heights, squares=squares)
        return self

    def peak(self, move: int, nu: int) -> float:
        """The greatest magnitude of a derivative in a move, by the master."""
        length = self.places[move + 1] - self.places[move]
        stroke = abs(self.heights[move + 1] - self.heights[move])
        return float(stroke / length**nu * catalogue[self.names[move]].law.peak(nu).value)

    def uncertainty(self, move: int, nu: int) -> float:
        """The share of a peak by which it may be wrong, one standard deviation."""
        count = len(self.places)
        length = self.places[move + 1] - self.places[move]
        stroke = abs(self.heights[move + 1] - self.heights[move])
        ends = self.deviations[[move, move + 1]]
        levels = self.deviations[[count + move, count + move + 1]]
        return float(nu * np.hypot(*ends) / length + np.hypot(*levels) / stroke)


def _positions(names: Sequence[str], places: Array, heights: Array, x: Array) -> Array:
    y = np.full(x.shape, heights[0], dtype=np.float64)
    y[x > places[-1]] = heights[-1]
    for i, name in enumerate(names):
        low, high = places[i], places[i + 1]
        inside = (x > low) & (x <= high)
        if not name:
            y[inside] = heights[i]
        elif inside.any():
            law = catalogue[name].law
            y[inside] = heights[i] + (heights[i + 1] - heights[i]) * np.asarray(law((x[inside] - low) / (high - low)))
    return y


def chain_of(
    x: Array,
    y: Array,
    noise: Array,
    places: Array,
    heights: Array,
    known: Sequence[bool],
    bounds: tuple[float, float],
    resting: float = 0.0,
) -> list[Chain]:
    """Chains of standard laws near rows, the nearest first.

    Parameters
    ----------
    x, y, noise
        Rows, arrays of shape (n,).
    places, heights
        About where the moves meet.
    known
        Which heights are known, as those of rests are.
    bounds
        Between which places the chain is.
    resting
        About how long the motion rests where it turns.
    """
    if resting:
        inner = np.repeat(np.arange(1, len(places) - 1), 2)
        each = [0, *inner.tolist(), len(places) - 1]
        places = places[each] + np.array([0.0, *np.tile([-0.5, 0.5], len(inner) // 2), 0.0]) * resting
        heights, known = heights[each], [known[i] for i in each]
    moves = range(0, len(places) - 1, 2 if resting else 1)
    ranked = [_ranked(x, y, (places[i], places[i + 1]), (heights[i], heights[i + 1])) for i in moves]
    rests = [""] * (len(ranked) - 1) if resting else []
    compared = _COMPARED if len(ranked) == 1 else _COMBINED if len(ranked) <= _MOST_COMBINED else 1
    best = [names[:compared] for names in ranked]
    chains = [
        _fitted(tuple(_woven(names, rests)), x, y, noise, places, heights, known, bounds) for names in product(*best)
    ]
    return sorted(chains, key=lambda chain: chain.squares)


def _woven(names: Sequence[str], rests: Sequence[str]) -> Iterator[str]:
    """The names of moves, with rests between them where there are such."""
    for i, name in enumerate(names):
        yield name
        if i < len(rests):
            yield rests[i]


def _ranked(x: Array, y: Array, ends: tuple[float, float], levels: tuple[float, float]) -> list[str]:
    """The names of laws by how near they come to the rows of a move, of which start and stop are about known."""
    from scipy.optimize import least_squares

    inside = np.flatnonzero((x >= ends[0]) & (x <= ends[1]))
    some = inside[:: max(1, len(inside) // _RANKED_BY)]
    k, a = x[some], (y[some] - levels[0]) / (levels[1] - levels[0])
    length = ends[1] - ends[0]
    costs = []
    for name in catalogue:
        law = catalogue[name].law
        solution = least_squares(
            lambda at, law=law: _shape(law, k, ends[0] + length * at[0], ends[1] + length * at[1]) - a,  # type: ignore[misc]  # a default binds the law of the loop
            [0.0, 0.0],
            xtol=_ROUGH_FIT,
            ftol=_ROUGH_FIT,
            gtol=_ROUGH_FIT,
            bounds=([-0.4, -0.4], [0.4, 0.4]),
            max_nfev=12,
        )
        costs.append((float(solution.cost), name))
    return [name for _, name in sorted(costs)]


def _shape(law: MotionLaw, x: Array, start: float, stop: float) -> Array:
    return np.asarray(law(np.clip((x - start) / (stop - start), 0.0, 1.0)))


def _fitted(
    names: tuple[str, ...],
    x: Array,
    y: Array,
    noise: Array,
    places: Array,
    heights: Array,
    known: Sequence[bool],
    bounds: tuple[float, float],
) -> Chain:
    """The chain of given laws whose places, and heights that are not known, are nearest the rows."""
    from scipy.optimize import least_squares

    count, free = len(places), ~np.array(known)
    scale = np.ptp(places) / (count - 1)
    size = float(np.ptp(heights))

    def parts(unknown: Array) -> tuple[Array, Array]:
        at = np.sort(np.clip(places + scale * unknown[:count], *bounds))
        at = at + 1e-9 * scale * np.arange(count)
        levels = np.array(heights, dtype=np.float64)
        levels[free] += size * unknown[count:]
        for i, name in enumerate(names):
            if not name:
                levels[i + 1] = levels[i]
        return at, levels

    def missed(unknown: Array) -> Array:
        return np.asarray((_positions(names, *parts(unknown), x) - y) / noise)

    stops: dict[str, Any] = {"xtol": _CLOSE_FIT, "ftol": _CLOSE_FIT, "gtol": _CLOSE_FIT, "max_nfev": 40}
    solution = least_squares(missed, np.zeros(count + int(free.sum())), **stops)
    at, levels = parts(solution.x)
    squares = float(2.0 * solution.cost)
    slopes = np.asarray(solution.jac, dtype=np.float64)
    normal = np.linalg.pinv(slopes.T @ slopes)
    spread = np.sqrt(np.maximum(np.diag(normal), 0.0) * max(squares / max(len(x) - len(solution.x), 1), 1.0))
    deviations = np.zeros(2 * count)
    deviations[:count] = scale * spread[:count]
    deviations[count:][free] = size * spread[count:]
    return Chain(names, at, levels, squares, len(solution.x) - names.count(""), deviations)


def criterion(squares: float, free: int, rows: int) -> float:
    """Schwarz's criterion, least for the model that rows make likeliest."""
    return rows * log(max(squares, 1e-300) / rows) + log(rows) * free
