"""Corrections of a guess of the contacts by what Newton's answer on it says."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from optlaws.synthesis.active_set import ActiveSet
from optlaws.synthesis.rows import Program

_PULL = 1e-10
_SAME = 1e-6


def settled(program: Program, state: ActiveSet) -> ActiveSet:
    """Drop the contact that pulls most, or put contacts that left the interval on its end; the same object if none."""
    if np.any(state.multipliers < -_PULL * np.abs(state.multipliers).max(initial=0.0)):
        return _without(state, int(np.argmin(state.multipliers)))
    lowest = np.array([program.families[i].lowest for i in state.family])
    outside = (state.u < lowest) | (state.u > 1.0)
    if outside.any():
        return replace(state, u=np.clip(state.u, lowest, 1.0), free=state.free & ~outside)
    return state


def _without(state: ActiveSet, contact: int) -> ActiveSet:
    kept = np.arange(len(state.u)) != contact
    return replace(
        state,
        family=state.family[kept],
        u=state.u[kept],
        s=state.s[kept],
        free=state.free[kept],
        multipliers=state.multipliers[kept],
    )


def completed(program: Program, state: ActiveSet, allowed: float) -> ActiveSet:
    """Add the extrema that stick out by more than `allowed`; the same object if none does.

    Where the nearest contact is pinned to an end, its residual grows inward and it is let go instead.
    """
    better = state
    for i, family in enumerate(program.families):
        u, s, residual = family.extremes(state.x)
        for j in np.flatnonzero(residual > allowed):
            mine = (better.family == i) & (better.s == s[j])
            if np.any(mine & (np.abs(better.u - u[j]) < _SAME)):
                continue
            pinned = np.flatnonzero(mine & ~better.free & _nothing_between(better, mine, float(u[j])))
            if len(pinned):
                better = better.moved(int(pinned[0]), float(u[j]))
            else:
                better = better.joined(i, float(u[j]), float(s[j]), free=bool(family.lowest < u[j] < 1.0))
    return better


def _nothing_between(state: ActiveSet, mine: np.ndarray, u: float) -> np.ndarray:
    # the contacts of `mine` that are neighbours of u: no other lies between
    distance = np.where(mine, np.abs(state.u - u), np.inf)
    same_side = [
        bool(mine[i]) and not np.any(mine & ((state.u - u) * (state.u[i] - u) > 0) & (distance < distance[i]))
        for i in range(len(state.u))
    ]
    return np.array(same_side)
