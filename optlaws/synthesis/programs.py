"""The semi-infinite programs of the synthesis: least acceleration, and the elastic one that tells infeasibility."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from optlaws.synthesis.rows import Family, Program, RatioFamily
from optlaws.synthesis.space import SymmetricSpace, symmetric_space

Array = NDArray[np.float64]

ACCELERATION = "acceleration"
BELOW_PEAK = "below peak"
FORWARD = "forward"


@lru_cache(maxsize=256)
def least_acceleration(order: int, terms: int, *, monotone: bool) -> Program:
    """Minimise C over coordinates and C: |c| <= C, b <= b(1/2), b >= 0 if monotone, b(1/2) = B (eq. 10)."""
    space = symmetric_space(order, terms)
    peak = _last(terms + 1)
    acceleration = Family(
        ACCELERATION, _widened(space.acceleration), space.acceleration[:, 0], peak, two_sided=True, odd=True
    )
    families = (acceleration, *_velocity_families(space, np.zeros(terms + 1), monotone=monotone))
    return _program(space, families)


@lru_cache(maxsize=256)
def least_violation(order: int, terms: int, *, monotone: bool) -> Program:
    """Minimise t so that the velocity constraints hold with t to spare: above 0 if and only if they contradict."""
    space = symmetric_space(order, terms)
    return _program(space, _velocity_families(space, _last(terms + 1), monotone=monotone))


@lru_cache(maxsize=256)
def extreme_velocity(order: int, terms: int, *, monotone: bool, greatest: bool) -> Program:
    """The least or greatest B for which the velocity constraints do not contradict; B is the last variable."""
    space = symmetric_space(order, terms)
    families = _velocity_families(space, np.zeros(terms + 1), monotone=monotone)
    equality = np.append(space.middle[1:], -1.0)
    objective = _last(terms + 1) * (-1.0 if greatest else 1.0)
    return Program(families, equality, float(space.middle[0]), objective)


def _velocity_families(space: SymmetricSpace, slack: Array, *, monotone: bool) -> tuple[Family, ...]:
    below = Family(BELOW_PEAK, -_widened(space.chord), -space.chord[:, 0], slack)
    if not monotone:
        return (below,)
    forward = RatioFamily(
        FORWARD,
        -_widened(space.ratio),
        -space.ratio[:, 0],
        slack,
        index=space.order - 0.5,
        scale=np.append(-space.ratio_scale[1:], -space.ratio_scale[0]),
    )
    return below, forward


def _program(space: SymmetricSpace, families: tuple[Family, ...]) -> Program:
    size = space.terms + 1
    equality = np.append(space.middle[1:], 0.0)
    return Program(families, equality, float(space.middle[0]), _last(size))


def _widened(matrix: Array) -> Array:
    return np.column_stack([matrix[:, 1:], np.zeros(len(matrix))])


def _last(size: int) -> Array:
    unit = np.zeros(size)
    unit[-1] = 1.0
    return unit
