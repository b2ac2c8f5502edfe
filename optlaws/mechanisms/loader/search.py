"""The search for executive laws with gentle loaders: sequential quadratic programs on a growing set of places.

B of the loader is convex in the executive law: tangents and a linear program bound it from below.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import inf
from typing import Any

import numpy as np
from numpy.typing import NDArray

from optlaws.mechanisms.loader.space import LoaderSpace, Rows

Array = NDArray[np.float64]

FINE, _FIRST = 1200, 30
_ROUNDS, _STEPS = 14, 300
_SHARP = 1e-9
_NEAR = 1e-4
_SAME = 1e-14
_SCALE, _LAST = 1e4, 60
_FAR = 40.0  # coordinates are peak accelerations: further away the search has lost its way
_SINGLE = 1e-4  # B - b is at least this share of what t² B is: one top


@dataclass(frozen=True, eq=False)
class Task:
    """Minimise the sum of weights times C, C_loader and B_loader over the laws of a space, C at most `most`."""

    space: LoaderSpace
    weights: Mapping[str, float]
    most: float = inf

    @property
    def names(self) -> tuple[str, ...]:
        """The peaks that have a variable of their own."""
        return tuple(name for name in ("C", "C_loader") if name in self.weights)

    def value(self, y: Array, peaks: Array) -> float:
        """The objective."""
        found = sum(self.weights[name] * float(peak) for name, peak in zip(self.names, peaks, strict=True))
        if "B_loader" in self.weights:
            found += self.weights["B_loader"] * self.space.B * float(self.space.Y(y).value[0])
        return found

    def tangent(self, y: Array) -> Array:
        """What B of the loader contributes to the objective, by the coordinates."""
        weight = self.weights.get("B_loader", 0.0)
        found: Array = weight * self.space.B * self.space.Y(y).gradient[0]
        return found

    def gradient(self, y: Array) -> Array:
        """By the coordinates, then by the peaks."""
        return np.append(self.tangent(y), [self.weights[name] for name in self.names])

    def constraints(self, at: Rows, x: Array) -> tuple[Array, Array]:
        """What must be at least 0 at the places, and its gradients: b <= B, b >= 0, |c| <= C, |c_l| <= C_l."""
        size = self.space.size
        y, extra = x[:size], len(self.names)
        values = [at.q @ np.append(y, 1.0) / self.space.B - _SINGLE, at.ratio @ np.append(y, 1.0)]
        gradients = [_wide(at.q[:, :-1] / self.space.B, extra), _wide(at.ratio[:, :-1], extra)]
        curves = {}
        if "C" in self.names or self.most < inf:
            curves["C"] = self.space.acceleration(at, y)
        if "C_loader" in self.names:
            curves["C_loader"] = self.space.loader_acceleration(at, y)
        for name, curve in curves.items():
            for sign in (1.0, -1.0):
                bounds = [x[size + self.names.index(name)]] if name in self.names else []
                bounds += [self.most] if name == "C" and self.most < inf else []
                for i, bound in enumerate(bounds):
                    values.append(bound - sign * curve.value)
                    gradient = _wide(-sign * curve.gradient, extra)
                    if i == 0 and name in self.names:
                        gradient[:, size + self.names.index(name)] = 1.0
                    gradients.append(gradient)
        return np.concatenate(values), np.vstack(gradients)


def search(task: Task, start: Array) -> tuple[Array, float]:
    """Coordinates y of a law that no neighbour beats, and by how much it breaks a constraint somewhere."""
    size = task.space.size
    fine = task.space.rows(np.linspace(0.0, 1.0, FINE))
    places = np.linspace(0.0, 1.0, _FIRST)
    x = np.append(start, peaks(task, fine, start))
    violation = inf
    for _ in range(_ROUNDS):
        x = _at_places(task, task.space.rows(places), x, start)
        broken = lowest(task, fine, x)
        violation = max(0.0, -float(task.constraints(task.space.rows(broken), x)[0].min()))
        if violation <= _SHARP:
            break
        places = np.union1d(places, broken)
    if "C_loader" in task.weights:
        return x[:size], violation
    # a proof by tangents needs more digits of the law than of its objective
    y = _at_places(task, task.space.rows(np.union1d(places, broken)), x, start, _SCALE)[:size]
    return y, violation


def _at_places(task: Task, at: Rows, x: Array, centre: Array, scale: float = 1.0) -> Array:
    """The optimum where the constraints hold at some places only."""
    from scipy.optimize import minimize

    size = task.space.size

    def value(x: Array) -> float:
        return scale * task.value(x[:size], x[size:])

    def gradient(x: Array) -> Array:
        return scale * task.gradient(x[:size])

    inside: Any = {
        "type": "ineq",
        "fun": lambda x: task.constraints(at, x)[0],
        "jac": lambda x: task.constraints(at, x)[1],
    }
    answer = minimize(
        value,
        x,
        jac=gradient,
        method="SLSQP",
        bounds=[*zip(centre - _FAR, centre + _FAR, strict=True), *[(0.0, None)] * len(task.names)],
        constraints=[inside],
        options={"maxiter": _STEPS if scale == 1.0 else _LAST, "ftol": _SAME},
    )
    found: Array = answer.x
    return found


def peaks(task: Task, fine: Rows, y: Array) -> Array:
    """The greatest values at the places of the peaks that have a variable."""
    curves = {"C": task.space.acceleration, "C_loader": task.space.loader_acceleration}
    return np.array([np.abs(curves[name](fine, y).value).max() for name in task.names])


def lowest(task: Task, fine: Rows, x: Array) -> Array:
    """Where a constraint is least beside its neighbours and broken or nearly so, by parabolas through three places."""
    blocks = task.constraints(fine, x)[0].reshape(-1, FINE)
    step = fine.t[1]
    found = [0.0, 1.0]
    for values in blocks:
        left, here, right = values[:-2], values[1:-1], values[2:]
        i = np.flatnonzero((here <= left) & (here <= right) & (here < _NEAR))
        bend = left[i] - 2.0 * here[i] + right[i]
        shift = np.where(bend > 0.0, 0.5 * (left[i] - right[i]) / np.where(bend > 0.0, bend, 1.0), 0.0)
        found.extend((fine.t[i + 1] + step * shift).tolist())
    return np.unique(np.array(found))


def _wide(gradient: Array, extra: int) -> Array:
    return np.column_stack([gradient, np.zeros((len(gradient), extra))])


_EVERY = 4


def tangent_bound(task: Task, y: Array) -> float:
    """What no law of the task's space is below: weights of B_loader and C only; y is the law of the tangent.

    The multipliers come from a linear program over finitely many places; the bound is recomputed from them alone.
    """
    from scipy.optimize import linprog

    space, size = task.space, task.space.size
    even = np.linspace(0.0, 1.0, FINE)
    fine = space.rows(even)
    at = space.rows(np.union1d(even[::_EVERY], lowest(task, fine, np.append(y, peaks(task, fine, y)))))
    slope = 4.0 * at.t[:, None] * at.p
    slope = np.vstack([slope, -slope])
    parts = [-at.q, -at.ratio]  # b <= B, b >= 0
    if task.most < inf:
        parts.append(slope - np.append(np.zeros(size), task.most))
    fixed = sum(map(len, parts))
    weight = task.weights.get("C", 0.0)
    if weight:
        parts.append(slope)  # at most the variable C
    every = np.vstack(parts)
    peak = np.where(np.arange(len(every)) < fixed, 0.0, -1.0)
    goal = task.tangent(y)
    matrix = np.column_stack([every[:, :-1], peak])
    size_of_goal = max(float(np.abs(goal).max()), weight)
    answer = linprog(
        np.append(goal, weight) / size_of_goal,
        A_ub=matrix,
        b_ub=-every[:, -1],
        bounds=[(None, None)] * size + [(None, None) if weight else (0.0, 0.0)],
        method="highs",
    )
    constant = task.weights["B_loader"] * space.B * float(space.Y(y).value[0]) - float(goal @ y)
    extent = _extent(task, at.t)

    def proven(multipliers: Array) -> float:
        left = np.abs(goal + every[:, :-1].T @ multipliers)
        return constant + float(multipliers @ every[:, -1]) - float(left @ extent)

    found = -inf if weight else proven(np.zeros(len(every)))
    if answer.x is None:
        return found
    multipliers = _refined(size_of_goal * -answer.ineqlin.marginals, matrix, np.append(goal, weight))
    total = float(multipliers[fixed:].sum())
    if weight:
        multipliers[fixed:] *= weight / total if total > 0.0 else 0.0
    return max(found, proven(multipliers))


def _refined(multipliers: Array, matrix: Array, goal: Array) -> Array:
    """Multipliers that take up the goal to rounding, not only to the tolerance of the linear program."""
    found = np.maximum(multipliers, 0.0)
    active = np.flatnonzero(found > 0.0)
    left = goal + matrix[active].T @ found[active]
    found[active] += np.linalg.lstsq(matrix[active].T, -left, rcond=None)[0]
    return np.maximum(found, 0.0)


def _extent(task: Task, t: Array) -> Array:
    """What |y| is at most: 0 <= b <= B at places determines y, and makes what rounding leaves of the gradient cheap."""
    fall = t[:, None] ** 2 * task.space.rows(t).q
    found: Array = np.abs(np.linalg.pinv(fall[:, :-1])) @ (task.space.B + np.abs(fall[:, -1]))
    return found
