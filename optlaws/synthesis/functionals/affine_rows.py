"""Rows of formulas that are affine in the law: their factors may depend on k."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from optlaws.formulas.convexity import degree
from optlaws.formulas.of_motion import MotionFormula
from optlaws.numbers import Array
from optlaws.numerics.chebyshev import from_values, interpolated, nodes
from optlaws.numerics.chebyshev import gauss as gauss_rule
from optlaws.synthesis.families.family import LinearFamily
from optlaws.synthesis.families.names import mirrored
from optlaws.synthesis.families.piece_series import PieceSeries
from optlaws.tolerances import VALUE_ROUNDING

if TYPE_CHECKING:
    from optlaws.formulas.tree import Formula
    from optlaws.synthesis.spaces.space import LawSpace


_PLACES = 7


@dataclass(frozen=True)
class Side:
    """A formula on the part of the interval that a space's rows cover."""

    name: str
    motion: MotionFormula
    signs: tuple[float, ...]


def sides(motion: MotionFormula, name: str, signs: tuple[float, ...], *, symmetric: bool) -> list[Side]:
    """Formulas for the rows: the formula itself, or for symmetric laws each half on the first one.

    Where the second half says the same as the first, or its opposite, one side says both.
    """
    if not symmetric:
        return [Side(name, motion, signs)]
    first, *second = motion.halves()
    if not second:
        return [Side(name, first, signs)]
    [other] = second
    if (first.start, first.stop) == (other.start, other.stop):
        here, there = sampled(first), sampled(other)
        size = VALUE_ROUNDING * float(np.abs(here).max())
        with np.errstate(invalid="ignore"):
            even, odd = (float(np.abs(part).max()) <= size for part in (here - there, here + there))
        if even:
            return [Side(name, first, signs)]
        if odd:
            return [Side(name, first, tuple(dict.fromkeys((*signs, *(-sign for sign in signs)))))]
    # the first sign is that which laws reach more often, and gets more points: c changes its own at the middle
    turned = signs[::-1] if max(motion.orders) % 2 == 0 else signs
    return [Side(name, first, signs), Side(mirrored(name), other, turned)]


def sampled(motion: MotionFormula) -> Array:
    """Its values in motions at random."""
    numbers = np.random.default_rng(0)
    names = {name: numbers.normal(size=_PLACES) for name in "abcj"}
    k = motion.start + (motion.stop - motion.start) * numbers.random(_PLACES)
    return np.broadcast_to(motion.values({**names, "k": k}), (_PLACES,))


def columns(space: LawSpace, motion: MotionFormula, u: Array) -> Array:
    """An affine formula at places u = 1 - 2k: of the free functions, then of the base law with what is left."""
    k = (1.0 - u) / 2.0
    total = np.zeros((len(u), space.terms + 1))
    for nu, factor in motion.weights.items():
        total += _at(factor, k)[:, None] * space.columns(nu, u)
    total[:, -1] += _at(motion.rest, k)
    return total


def _at(factor: Formula, k: Array) -> Array:
    return np.broadcast_to(MotionFormula(factor).values({"k": k}), k.shape)


def rows(space: LawSpace, side: Side, slack: Array, bound: float) -> LinearFamily:
    """Rows s f <= slack . x + bound on the side's part of the interval."""
    motion, domain = side.motion, space.part(side.motion.start, side.motion.stop, side.motion.orders)
    plain = motion.constant_weights()
    if plain is not None and not plain[1] and plain[0]:
        weights, lowest = plain[0], min(plain[0])
        combined = tuple(weights.get(nu, 0.0) for nu in range(lowest, max(weights) + 1))
        family = space.combination(lowest, combined, side.name, slack, bound, signs=side.signs)
        return replace(family, domain=(max(domain[0], family.domain[0]), min(domain[1], family.domain[1])))
    edges = edges_of(space, motion)
    places = [_between(ends, nodes(count_of(space, motion, ends))) for ends in pairwise(edges)]
    series = [from_values(columns(space, motion, u)) for u in places]
    stacked = np.zeros((len(series), max(map(len, series)), space.terms + 1))
    for i, coefficients in enumerate(series):
        stacked[i, : len(coefficients)] = coefficients
    table, jumps = PieceSeries(np.array(edges), stacked).widened(len(slack)), any(map(space.jumps, motion.orders))
    return LinearFamily(side.name, slack, bound, side.signs, domain, table=table, jumps=jumps)


def edges_of(space: LawSpace, motion: MotionFormula) -> tuple[float, ...]:
    """The u between which an affine formula is smooth in every law, descending."""
    return tuple(sorted({*space.edges, *(1.0 - 2.0 * k for k in motion.kinks)}, reverse=True))


def count_of(space: LawSpace, motion: MotionFormula, ends: tuple[float, float]) -> int:
    """How many Chebyshev coefficients an affine formula needs between two u, for every law."""

    def length(factor: Formula) -> int:
        known = degree(factor, {"k": 1})
        if known is not None:
            return known
        return len(interpolated(lambda x: _at(factor, (1.0 - _between(ends, x)) / 2.0), str(factor)))

    lengths = [length(factor) + space.degree_of(nu) for nu, factor in motion.weights.items()]
    return 1 + max([*lengths, length(motion.rest)])


def _between(ends: tuple[float, float], x: Array) -> Array:
    """The u of places from -1 to 1."""
    high, low = ends
    return np.asarray(low + (x + 1.0) * (high - low) / 2.0)


def gauss(space: LawSpace, motion: MotionFormula) -> tuple[Array, Array]:
    """Places u in the formula's part and weights that add up to its length in k; exact for squares of the formula."""
    places, weights = [], []
    for ends, count in gauss_parts(space, motion):
        x, weight = gauss_rule(count)
        places.append(_between(ends, x))
        weights.append(weight * (ends[0] - ends[1]) / 4.0)
    return np.concatenate(places), np.concatenate(weights)


def gauss_parts(space: LawSpace, motion: MotionFormula) -> list[tuple[tuple[float, float], int]]:
    """Between which u, descending, how many places of Gauss's rule are."""
    low, high = 1.0 - 2.0 * motion.stop, 1.0 - 2.0 * motion.start
    inner = [u for u in edges_of(space, motion) if low < u < high]
    return [(ends, count_of(space, motion, ends) + 1) for ends in pairwise([high, *inner, low])]
