"""Where a law goes forwards, backwards, or rests: decided by its extremes, not by the sign of a rounded velocity."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

import numpy as np

from optlaws.laws.law import MotionLaw
from optlaws.numbers import Array
from optlaws.tolerances import VALUE_ROUNDING

_HALVES = 60


@dataclass(frozen=True, eq=False)
class Direction:
    """The direction of a law: 1 forwards, -1 backwards, 0 at rest, constant between ascending edges from 0 to 1.

    Examples
    --------
    >>> from optlaws import catalogue, smoothstep
    >>> law = catalogue["4-5-6-7 polynomial"].law
    >>> k = np.array([1.0749790817499163e-08])
    >>> law.b(k).tolist(), direction_of(law)(k).tolist()
    ([-1.1102230246251565e-16], [1.0])
    >>> direction_of(smoothstep(2)).edges
    array([0., 1.])
    """

    edges: Array
    signs: Array

    def __call__(self, k: Array) -> Array:
        """The direction at places, at an edge just after it, at the end just before it."""
        return np.asarray(self.signs[np.searchsorted(self.edges[1:-1], k, side="right")])

    @property
    def turns(self) -> Array:
        """The places inside where the direction changes."""
        return self.edges[1:-1]


@lru_cache(maxsize=256)
def direction_of(law: MotionLaw) -> Direction:
    """The direction of a law.

    Between neighbouring extremes the velocity is monotone, so that the direction follows from its values there; one
    that is rounding beside the greatest velocity has none of its own. A law rests where its velocity is no more than
    that between two breaks.
    """
    k, b = law._sides(1)  # noqa: SLF001 - one package
    order = np.argsort(k, kind="stable")
    k, b = k[order], b[order]
    size = float(np.max(np.abs(b), where=np.isfinite(b), initial=0.0))
    signs = np.where(np.abs(b) <= VALUE_ROUNDING * size, 0.0, np.sign(b))
    edges, ways = [0.0], list[float]()
    for start, stop in pairwise(law.breaks):
        inner = (k > start) & (k < stop)
        first, last = np.flatnonzero(k == start)[-1], np.flatnonzero(k == stop)[0]
        which = np.concatenate([[first], np.flatnonzero(inner), [last]])
        for place, sign in _ways(law, k[which], signs[which]):
            edges.append(place)
            ways.append(sign)
    return _joined(np.array(edges), np.array(ways))


def _ways(law: MotionLaw, k: Array, signs: Array) -> list[tuple[float, float]]:
    """The directions between two breaks, each with the place where it ends."""
    known = np.flatnonzero(signs)
    if not len(known):
        return [(float(k[-1]), 0.0)]
    turns = [(_zero(law, k[i : j + 1], signs[i]), float(signs[i])) for i, j in pairwise(known) if signs[i] != signs[j]]
    return [*turns, (float(k[-1]), float(signs[known[-1]]))]


def _zero(law: MotionLaw, k: Array, sign: float) -> float:
    """The place between the first and the last where the velocity leaves a sign; halfway where it rests meanwhile."""
    if len(k) > 2:
        return float(0.5 * (k[1] + k[-2]))
    low, high = float(k[0]), float(k[1])
    for _ in range(_HALVES):
        middle = 0.5 * (low + high)
        if law.b(middle) * sign > 0.0:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


def _joined(edges: Array, ways: Array) -> Direction:
    """The directions with those that are alike and neighbours as one."""
    changed = np.flatnonzero(np.diff(ways)) + 1
    edges = np.concatenate([edges[:1], edges[changed], edges[-1:]])
    signs = np.concatenate([ways[:1], ways[changed]])
    edges.flags.writeable = signs.flags.writeable = False
    return Direction(edges, signs)
