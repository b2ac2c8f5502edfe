"""Newton's method on the active contacts: an initial guess, corrected after each answer."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from optlaws.numbers import Array
from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.families.family import ConstraintFamily, Program
from optlaws.synthesis.method.newton import newton
from optlaws.tolerances import EXCESS, SAME_PLACE

_PULLING = 1e-10  # of the greatest multiplier: one that is more negative pulls, and its contact is dropped

_CORRECTIONS = 8


def polished(program: Program, guess: ActiveSet, holds: Callable[[Array], bool] | None) -> ActiveSet | None:
    """The optimum that a guess of its contacts leads to; None where Newton's method does not find it.

    `holds` checks from x alone, faster than the families do, whether every constraint holds.
    """
    for _ in range(_CORRECTIONS):
        optimum = newton(program, guess)
        if optimum is None:
            optimum = newton(program, guess, deficient=True)
        if optimum is None:
            return None
        guess = settled(program, optimum)
        if guess is optimum and (holds is None or not holds(optimum.x)):
            guess = completed(program, optimum)
        if guess is optimum:
            return optimum
    return None


def settled(program: Program, state: ActiveSet) -> ActiveSet:
    """Drop the contact that pulls most, or put contacts that left the interval on its end; the same object if none."""
    as_equation = np.array([program.families[i].as_equation for i in state.family], dtype=np.bool_)
    pushing = np.where(as_equation, 0.0, state.multipliers)
    if np.any(pushing < -_PULLING * np.abs(state.multipliers).max(initial=0.0)):
        return state.only(np.arange(len(state.u)) != np.argmin(pushing))
    low, high = np.array([program.families[i].domain for i in state.family]).reshape(-1, 2).T
    outside = (state.u < low) | (state.u > high)
    if outside.any():
        return replace(state, u=np.clip(state.u, low, high), free=state.free & ~outside)
    return state


def completed(program: Program, state: ActiveSet) -> ActiveSet:
    """Add the extrema that stick out by more than EXCESS of the right side; the same object if none does.

    Where the nearest contact is pinned to an end, its residual grows inward and it is let go instead.
    """
    better = state
    for i, family in enumerate(program.families):
        if family.as_equation:
            continue
        u, s, residual = family.extremes(state.x)
        for j in np.flatnonzero(residual > EXCESS * max(1.0, abs(family.right_side(state.x)))):
            alike = (better.family == i) & (better.s == s[j])
            near = alike & (np.abs(better.u - u[j]) < SAME_PLACE)
            if near.any():
                if _across_a_jump(family, better.u[near], float(u[j])):
                    better = better.joined(i, float(u[j]), float(s[j]), free=False)
                continue
            pinned = np.flatnonzero(alike & ~better.free & _nothing_between(better, alike, float(u[j])))
            if len(pinned):
                better = better.moved(int(pinned[0]), float(u[j]))
            else:
                free = bool(family.movable(u[j : j + 1])[0])
                better = better.joined(i, float(u[j]), float(s[j]), free=free)
    return better


def _across_a_jump(family: ConstraintFamily, contacts: Array, u: float) -> bool:
    """Whether a place and contacts next to it are sides of a break, of which each has a value of its own."""
    places = np.append(contacts, u)
    return bool(family.pinned(places).all() and (contacts != u).all())


def _nothing_between(state: ActiveSet, alike: NDArray[np.bool_], u: float) -> NDArray[np.bool_]:
    # the contacts of `alike` that are neighbours of u: no other lies between
    distance = np.where(alike, np.abs(state.u - u), np.inf)
    same_side = [
        bool(alike[i]) and not np.any(alike & ((state.u - u) * (state.u[i] - u) > 0) & (distance < distance[i]))
        for i in range(len(state.u))
    ]
    return np.array(same_side, dtype=np.bool_)
