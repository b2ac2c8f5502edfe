"""How far a slave goes back and forth in all: the integral of the velocity's magnitude."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from optlaws.motion.motion import Motion
from optlaws.motion.polynomials import PiecewiseMotion
from optlaws.series import bernstein

Array = NDArray[np.float64]

_EACH = 257
_HALVINGS = 60
_CUTS = 9  # in eight: the way is of second order in the length that is left


def travel_of_run(run: PiecewiseMotion) -> float:
    """The way of polynomials.

    Examples
    --------
    >>> round(travel_of_run(PiecewiseMotion([0, 2], [[0, 2, -1]])), 12)
    2.0
    """
    first, last = run.ends(0)
    moved = np.abs(last - first)
    table = run.powers(1)
    control = bernstein.from_powers(table * run.lengths[:, None] ** np.arange(table.shape[1]))
    # where all Bernstein coefficients of the velocity have one sign it does not change it
    rows = np.flatnonzero(_turns(control))
    moved[rows] = _back_and_forth(control[rows], run.lengths[rows])
    return float(moved.sum())


def travel_of_law(motion: Motion) -> float:
    """The way of an exact motion, turned where its velocity changes its sign.

    Examples
    --------
    >>> from optlaws.motion.motion import motion_of_law
    >>> from optlaws.laws import smoothstep
    >>> travel_of_law(motion_of_law(smoothstep(3), stroke="-35 mm", time="0.1 s"))
    35.0
    """
    grids = [np.linspace(low, high, _EACH) for low, high in pairwise(motion.breaks)]
    x = np.concatenate([[motion.start], *(grid[1:] for grid in grids)])
    signs = np.sign(motion(x, 1))
    which = np.flatnonzero(signs[1:] * signs[:-1] < 0.0)
    turns = _halved(motion, x[which], x[which + 1], signs[which]) if which.size else x[which]
    return float(np.abs(np.diff(motion(np.sort(np.concatenate([x, turns]))))).sum())


def _halved(motion: Motion, low: Array, high: Array, sign: Array) -> Array:
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        before = motion(middle, 1) * sign > 0.0
        low, high = np.where(before, middle, low), np.where(before, high, middle)
    return low


def _turns(control: Array) -> NDArray[np.bool_]:
    return np.asarray((control.min(axis=1) < 0.0) & (control.max(axis=1) > 0.0))


def _back_and_forth(control: Array, lengths: Array) -> Array:
    """The ways of pieces given by Bernstein coefficients of their velocities, cut where they may turn."""
    ways, rows = np.zeros(len(control)), np.arange(len(control))
    for cut in range(_CUTS + 1):
        turning = _turns(control) if cut < _CUTS else np.zeros(len(control), dtype=np.bool_)
        np.add.at(ways, rows[~turning], np.abs(control.mean(axis=1) * lengths)[~turning])
        if not turning.any():
            break
        control, rows = bernstein.in_parts(control[turning]), np.repeat(rows[turning], bernstein.PARTS)
        lengths = np.repeat(lengths[turning] / bernstein.PARTS, bernstein.PARTS)
    return ways
