"""What bounds a law in which the integral of a convex formula, or its root, is small: sums of tangents.

A convex function is nowhere below its tangents. Tangents on all sides of the least value, added up with weights, leave
one coordinate of the law alone: it is at most so much times the function, and so much more.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from optlaws.numbers import Array
from optlaws.numerics.tolerances import BALANCED, FLAT_INTEGRAL, POSITIVE_SHARES, REACH_SETTLED
from optlaws.synthesis.families.curved import IntegralFamily
from optlaws.synthesis.functionals.sizes import kept_directions

if TYPE_CHECKING:
    from optlaws.synthesis.spaces.space import LawSpace


_ORDER = 2
_ROUNDED = 1.0 + 1e-6
_STEPS, _HALVINGS = 30, 20
#: how far from the least value tangents touch, by what would double it; nearer, they are more alike on all sides
_NEARER = (1.0, 0.25, 0.0625, 0.015625)


def tangent_reach(space: LawSpace, plain: IntegralFamily, family: IntegralFamily) -> tuple[int, float, float] | None:
    """An order of derivative, a factor and an offset: its mean magnitude is at most the factor times f plus the offset.

    None where the tangents do not show that the law is bounded.

    Parameters
    ----------
    space
        Of the laws; the families' variables are its coordinates.
    plain, family
        The integral, and the same or its root: f, which is convex.
    """
    fixed, free = kept_directions(space)
    if not free.size:
        # one law is all there is
        rule = space.quadrature(_ORDER)
        return _ORDER, 0.0, _ROUNDED * float(rule.weights @ np.abs(rule.values @ np.append(fixed, 1.0)))
    with np.errstate(all="ignore"):
        lowest = _lowest(plain, fixed, free)
        bend = free.T @ _hessian(plain, lowest) @ free
    if not np.isfinite(bend).all() or not np.isfinite(lowest).all():
        return None
    sizes, turned = np.linalg.eigh(bend)
    if sizes[0] <= FLAT_INTEGRAL * sizes[-1]:
        return None
    steps = free @ (turned / np.sqrt(sizes))
    far = float(np.sqrt(2.0 * abs(_value(plain, lowest)))) or 1.0
    for reach in (far * nearer for nearer in _NEARER):
        heights, slopes = _tangents(family, lowest, reach * np.hstack([steps, -steps]).T, steps)
        shares = _shares(slopes) if np.isfinite(heights).all() else None
        if shares is not None:
            return _summed(space, lowest, steps, heights, shares)
    return None


def _summed(space: LawSpace, lowest: Array, steps: Array, heights: Array, shares: Array) -> tuple[int, float, float]:
    """The bound that weighted tangents say, of |c| in the mean."""
    rule = space.quadrature(_ORDER)
    means = rule.weights @ np.abs(rule.values[:, :-1] @ steps)
    offset = float(rule.weights @ np.abs(rule.values @ np.append(lowest, 1.0)))
    factors = shares.sum(axis=1).reshape(2, -1).max(axis=0)
    beside = -(shares @ heights).reshape(2, -1).min(axis=0)
    return _ORDER, _ROUNDED * float(factors @ means), _ROUNDED * (float(beside @ means) + offset)


def _value(family: IntegralFamily, x: Array) -> float:
    return float(family.value(x, np.ones(1))[0])


def _gradient(family: IntegralFamily, x: Array) -> Array:
    return np.asarray(family.jet(x, np.ones(1), np.ones(1)).gradient[0])


def _hessian(family: IntegralFamily, x: Array) -> Array:
    bent = family.hessian(x, np.ones(1), np.ones(1))
    return np.zeros((len(x), len(x))) if bent is None else bent


def _lowest(family: IntegralFamily, x: Array, free: Array) -> Array:
    """Nearly where the integral is least, by Newton's method with steps that are halved."""
    value = _value(family, x)
    for _ in range(_STEPS):
        bend, slope = free.T @ _hessian(family, x) @ free, free.T @ _gradient(family, x)
        if not np.isfinite(bend).all():
            return x
        step = free @ np.linalg.lstsq(bend, -slope, rcond=None)[0]
        for _ in range(_HALVINGS):
            there = _value(family, x + step)
            if there <= value:
                break
            step = step / 2.0
        else:
            return x
        x, before, value = x + step, value, there
        if before - value <= REACH_SETTLED * abs(value):
            return x
    return x


def _tangents(family: IntegralFamily, lowest: Array, ways: Array, steps: Array) -> tuple[Array, Array]:
    """Heights at the lowest place, and slopes along the steps, of tangents there and on all sides."""
    rows = [family.tangent_row(1.0, 1.0, family.touching(lowest + way, 1.0)) for way in (0.0 * ways[0], *ways)]
    stacked = np.array([row for row in rows if row is not None])
    # tangents that touch very far away overflow: nearer ones are tried then
    with np.errstate(over="ignore", invalid="ignore"):
        return stacked @ np.append(lowest, 1.0), stacked[:, :-1] @ steps


def _shares(slopes: Array) -> Array | None:
    """Weights of tangents, all at least 0, that leave each coordinate in turn, then each with its sign turned."""
    count = slopes.shape[1]
    wanted = np.vstack([np.eye(count), -np.eye(count)])
    if len(slopes) < 2 * count + 1 or not np.isfinite(slopes).all():
        return None
    inverse = np.linalg.pinv(slopes.T)
    level = np.ones(len(slopes)) - inverse @ slopes.sum(axis=0)
    if level.min() < POSITIVE_SHARES:
        return None
    shares = wanted @ inverse.T
    shares = shares + np.maximum((-shares / level).max(axis=1), 0.0)[:, None] * level
    return shares if np.abs(shares @ slopes - wanted).max() <= BALANCED else None
