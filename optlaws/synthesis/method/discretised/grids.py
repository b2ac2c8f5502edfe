"""Grids of the families: first few points, then the true extrema of the solution too."""

from __future__ import annotations

import numpy as np
from numpy.polynomial.chebyshev import chebpts2

from optlaws.numbers import Array
from optlaws.numerics.chebyshev import nodes
from optlaws.synthesis.families.curved import CurvedFamily
from optlaws.synthesis.families.family import ConstraintFamily, LinearFamily, Points, Program

_NEARLY_BINDING = 1e-2  # of a right side, or 1: extrema within this of binding join the points that are held
_CLOSER = 0.25  # of the distance to the nearest point: how far off extrema further points join
_DENSE = 6  # times as many points beside formulas that are no polynomials


def first_points(program: Program) -> list[Points]:
    """First points of each family, enough for the solution on them to show the contacts."""
    # with no peak to hold them, the velocity constraints need points enough by themselves
    share = 1.0 if any(len(family.signs) > 1 for family in program.families) else 1.5
    times = _DENSE if _dense(program) else 1
    return [_points(family, times * program.size, share) for family in program.families]


def _dense(program: Program) -> bool:
    """Whether it has a formula that is no polynomial: between few points its law is another than on all."""
    return any(isinstance(family, CurvedFamily) and family.degree is None for family in program.families)


def _points(family: ConstraintFamily, size: int, even_share: float) -> Points:
    """Points of a family, few enough to be quick; the rarer sign of a magnitude has half as many."""
    low, high = family.domain
    if low == high:
        return Points(np.repeat([low], len(family.signs)), np.array(family.signs))
    given = family.nodes()
    if given is not None:
        if not len(given):
            given = np.array([low, high])  # a window between the nodes
        return Points(np.tile(given, len(family.signs)), np.repeat(family.signs, len(given)))
    u, s = [], []
    for i, sign in enumerate(family.signs):
        if isinstance(family, LinearFamily) and family.even:
            count = int(even_share * size) + 4
            places = chebpts2(count)[::-1]
        elif low == 0.0:
            count = int((1.5, 0.75)[i] * size) + 4
            places = high * nodes(2 * count)[:count]
        else:
            count = int(1.5 * size) + 4
            places = (high + low) / 2 + (high - low) / 2 * nodes(count)
        u.append(places)
        s.append(np.full(count, sign))
    return Points(np.concatenate(u), np.concatenate(s))


def with_extrema(program: Program, points: list[Points], x: Array) -> list[Points]:
    """The points of every family, with the extrema at x that are active or nearly active."""
    beside = _dense(program)
    return [_joined(family, grid, x, beside=beside) for family, grid in zip(program.families, points, strict=True)]


def _joined(family: ConstraintFamily, points: Points, x: Array, *, beside: bool) -> Points:
    if family.domain[0] == family.domain[1]:
        return points
    u, s, residual = family.extremes(x)
    near = residual > -_NEARLY_BINDING * max(1.0, abs(family.right_side(x)))
    for sign in family.signs:
        near &= (s != sign) | ~np.isin(u, points.u[points.s == sign])
    u, s = u[near], s[near]
    if beside and len(u):
        # where nothing proves an optimum its contacts are not followed, but enclosed ever closer
        apart = np.abs(u[:, None] - points.u)
        apart[(s[:, None] != points.s) | (apart == 0.0)] = np.inf
        off = _CLOSER * np.where(np.isfinite(nearest := apart.min(axis=1)), nearest, 0.0)
        u, s = np.clip(np.concatenate([u, u - off, u + off]), *family.domain), np.tile(s, 3)
    return points.joined(Points(u, s))
