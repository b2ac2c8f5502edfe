"""Corrections of a guess of the contacts by what Newton's answer on it says."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.families.family import Program

#: of a right side, or 1: a residual beyond this is an excess
EXCESS = 1e-10
_PULL = 1e-10
_SAME = 1e-6


def settled(program: Program, state: ActiveSet) -> ActiveSet:
    """Drop the contact that pulls most, or put contacts that left the interval on its end; the same object if none."""
    held = np.array([program.families[i].held for i in state.family], dtype=np.bool_)
    pushing = np.where(held, 0.0, state.multipliers)
    if np.any(pushing < -_PULL * np.abs(state.multipliers).max(initial=0.0)):
        return _without(state, int(np.argmin(pushing)))
    low, high = np.array([program.families[i].domain for i in state.family]).reshape(-1, 2).T
    outside = (state.u < low) | (state.u > high)
    if outside.any():
        return replace(state, u=np.clip(state.u, low, high), free=state.free & ~outside)
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


def completed(program: Program, state: ActiveSet) -> ActiveSet:
    """Add the extrema that stick out by more than EXCESS of the right side; the same object if none does.

    Where the nearest contact is pinned to an end, its residual grows inward and it is let go instead.
    """
    better = state
    for i, family in enumerate(program.families):
        if family.held:
            continue
        u, s, residual = family.extremes(state.x)
        low, high = family.domain
        for j in np.flatnonzero(residual > EXCESS * max(1.0, abs(family.room(state.x)))):
            mine = (better.family == i) & (better.s == s[j])
            if np.any(mine & (np.abs(better.u - u[j]) < _SAME)):
                continue
            pinned = np.flatnonzero(mine & ~better.free & _nothing_between(better, mine, float(u[j])))
            if len(pinned):
                better = better.moved(int(pinned[0]), float(u[j]))
            else:
                better = better.joined(
                    i, float(u[j]), float(s[j]), free=bool(low < u[j] < high and not family.pinned(u[j : j + 1])[0])
                )
    return better


def _nothing_between(state: ActiveSet, mine: NDArray[np.bool_], u: float) -> NDArray[np.bool_]:
    # the contacts of `mine` that are neighbours of u: no other lies between
    distance = np.where(mine, np.abs(state.u - u), np.inf)
    same_side = [
        bool(mine[i]) and not np.any(mine & ((state.u - u) * (state.u[i] - u) > 0) & (distance < distance[i]))
        for i in range(len(state.u))
    ]
    return np.array(same_side, dtype=np.bool_)
