"""The optimum of a phase plane as a conic program on few places, refined where what is active changes.

The position is a = sin²(pi s/2), so that velocities, which begin and end with the root of a, are smooth in s. The
equation of motion w' = 2 c is tested with functions J phi(s)/sin(pi s), phi piecewise polynomials; its multipliers are
the potential q(a) = J(a) pi(s)/sin(pi s), J the inertia of the plane's reference, of which every bound is made.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from optlaws.errors import SolverFailure
from optlaws.numbers import Array
from optlaws.numerics.chebyshev import gauss
from optlaws.synthesis.limits.phase_plane import PhasePlane, PhaseTorque
from optlaws.tolerances import PHASE_ACTIVE, PHASE_PACE, SMALLEST_ELEMENT

DEGREE = 4
_ELEMENTS = 8
_ROUNDS = 3
_VARIABLES = 4


@dataclass(frozen=True, eq=False)
class PhaseOptimum:
    """The optimum of a phase plane on some elements.

    Attributes
    ----------
    edges
        The ends of the elements in s, from 0 to 1.
    potential
        Bernstein coefficients of pi(s), shape (elements, DEGREE + 1); neighbours share those at their ends.
    weight
        The multiplier of the time.
    s, b, c
        Places, and velocity and acceleration there.
    objective
        What is minimised, as the places see it.
    """

    edges: Array
    potential: Array
    weight: float
    s: Array
    b: Array
    c: Array
    objective: float


def optimum(plane: PhasePlane, rounds: int = _ROUNDS) -> PhaseOptimum:
    """The optimum of a phase plane, on elements that end where bounds become active or inactive.

    Parameters
    ----------
    plane
        What is minimised, and within which bounds.
    rounds
        How often the program is solved, each time on finer elements around every change.

    Raises
    ------
    SolverFailure
        If no motion keeps the bounds, or the program was not solved.
    """
    kinks = 2.0 / np.pi * np.arcsin(np.sqrt(np.array(plane.kinks)))
    edges = np.union1d(np.linspace(0.0, 1.0, _ELEMENTS + 1), kinks)
    solved, pace = _Program(plane, edges).solved(), 0.0
    if plane.kind != "time" and solved.weight < PHASE_PACE * abs(solved.objective):
        # where the time costs nothing, velocities are not determined: it is given a little price
        pace = PHASE_PACE * abs(solved.objective)
        solved = _Program(plane, edges, pace).solved()
    for _ in range(rounds - 1):
        finer = _refined(plane, solved)
        if len(finer) == len(solved.edges):
            break
        solved = _Program(plane, finer, pace).solved()
    return solved


#: factors of variables at the places, by variable: w = b², c, b and 1/b, then slacks
_Parts: TypeAlias = dict[int, Array]
Places: TypeAlias = NDArray[np.intp]
_SQUARE, _ACCELERATION, _VELOCITY, _PACE = range(_VARIABLES)


class _Program:
    """The conic program on given elements: variables at every place, and the peak."""

    def __init__(self, plane: PhasePlane, edges: Array, pace: float = 0.0) -> None:
        self.plane, self.edges, self.pace = plane, edges, pace
        x, share = gauss(DEGREE)
        lengths = np.diff(edges)
        self.s = (edges[:-1, None] + lengths[:, None] * (x + 1.0) / 2.0).ravel()
        self.a, self.sine = np.sin(np.pi * self.s / 2.0) ** 2, np.sin(np.pi * self.s)
        self.count = len(self.s)
        self.weights = (lengths[:, None] * share / 2.0).ravel() * np.pi / 2.0 * self.sine
        slacks = int(plane.squared is not None) + len(plane.maxima)
        self.width = (_VARIABLES + slacks) * self.count + 1
        self.height = 0
        self.entries: list[tuple[Places, Places, Array]] = []
        self.right: list[Array] = []
        self.cones: list[Any] = []
        self.costs = np.zeros(self.width)
        self._write_motion((x + 1.0) / 2.0)
        self._write()

    def solved(self) -> PhaseOptimum:
        """The optimum with its multipliers."""
        import clarabel
        from scipy.sparse import csc_matrix

        rows, columns, values = (np.concatenate(several) for several in zip(*self.entries, strict=True))
        matrix = csc_matrix((values, (rows, columns)), shape=(self.height, self.width))
        unit = float(np.abs(self.costs).max() / self.weights.max()) or 1.0
        settings = clarabel.DefaultSettings()
        settings.verbose = False
        nothing, right = csc_matrix((self.width, self.width)), np.concatenate(self.right)
        result = clarabel.DefaultSolver(nothing, self.costs / unit, matrix, right, self.cones, settings).solve()
        if str(result.status) not in {"Solved", "AlmostSolved"}:
            raise SolverFailure(f"no motion in the phase plane was found within the bounds: {result.status}")
        x, z = np.array(result.x), np.array(result.z)
        places = np.arange(len(self.edges) - 1)[:, None] * DEGREE + np.arange(DEGREE + 1)
        weight = unit * float(z[self.count + 1]) + self.pace if self.plane.kind != "time" else 1.0
        time = float(self.weights @ x[_PACE * self.count : (_PACE + 1) * self.count])
        c, b = (x[i * self.count : (i + 1) * self.count] for i in (_ACCELERATION, _VELOCITY))
        potential = -unit * z[: self.count + 1][places]
        return PhaseOptimum(
            self.edges, potential, weight, self.s, b, c, unit * float(result.obj_val) - self.pace * time
        )

    def _write_motion(self, x: Array) -> None:
        """The equation of motion, tested with J phi/sin(pi s), whose slope by a is that of w, and twice itself of c."""
        import clarabel

        values, slopes = _bernstein(x)
        lengths = np.diff(self.edges)
        inertia, by_a = self.plane.reference.values(self.a)[0], self.plane.reference.inertia_slope(self.a)
        element, place = np.divmod(np.arange(self.count), DEGREE)
        phi, by_s = values[place], slopes[place] / lengths[element][:, None]
        sine, cosine = self.sine[:, None], np.cos(np.pi * self.s)[:, None]
        rate = inertia[:, None] / (np.pi / 2.0 * sine) * (by_s / sine - np.pi * cosine / sine**2 * phi)
        rate += (by_a / self.sine)[:, None] * phi
        row = element[:, None] * DEGREE + np.arange(DEGREE + 1)
        column = np.broadcast_to(np.arange(self.count)[:, None], row.shape)
        weights = self.weights[:, None]
        for variable, factor in ((_SQUARE, rate), (_ACCELERATION, 2.0 * (inertia[:, None] / sine) * phi)):
            self.entries.append((row.ravel(), (variable * self.count + column).ravel(), (weights * factor).ravel()))
        self._close(np.zeros(self.count + 1), [clarabel.ZeroConeT(self.count + 1)])

    def _write(self) -> None:
        """All other rows with their cones, and what is minimised."""
        import clarabel

        plane, ones, slack = self.plane, np.ones(self.count), _VARIABLES
        if plane.kind == "time":
            self._cost(_PACE, 1.0)
        else:
            self._cost(_PACE, self.pace)
            places = _PACE * self.count + np.arange(self.count)
            self.entries.append((np.full(self.count, self.height), places, self.weights))
            self._close(np.ones(1), [clarabel.NonnegativeConeT(1)])
        if inf > plane.B:
            self._at_most({_VELOCITY: ones}, plane.B * ones)
        for bound in plane.bounds:
            parts, load, size = self._torque(bound.torque)
            for sign in (1.0, -1.0):
                signed = {variable: sign * part for variable, part in parts.items()}
                signed[_VELOCITY] = signed[_VELOCITY] + bound.fall / size
                self._at_most(signed, bound.at_rest / size - sign * load)
        # b² <= w and 1 <= b y
        self._cone(({_SQUARE: ones}, ones), ({_VELOCITY: 2.0 * ones}, 0.0 * ones), ({_SQUARE: ones}, -ones))
        ways = {_VELOCITY: ones, _PACE: ones}, {_VELOCITY: -ones, _PACE: ones}
        self._cone((ways[0], 0.0 * ones), ({}, 2.0 * ones), (ways[1], 0.0 * ones))
        if plane.squared is not None:
            parts, load, size = self._torque(plane.squared)
            double = {variable: 2.0 * part for variable, part in parts.items()}
            ways = {_VELOCITY: ones, slack: ones}, {_VELOCITY: -ones, slack: ones}
            self._cone((ways[0], 0.0 * ones), (double, 2.0 * load), (ways[1], 0.0 * ones))
            self._cost(slack, plane.heat * size**2)
            slack += 1
        for torques in plane.maxima:
            size = max(self._torque(torque)[2] for torque in torques)
            for torque in torques:
                parts, load, scale = self._torque(torque)
                scaled = {variable: scale / size * part for variable, part in parts.items()}
                self._at_most({**scaled, slack: -ones}, -scale / size * load)
            self._cost(slack, size)
            slack += 1
        if plane.peak is not None:
            parts, load, self.costs[-1] = self._torque(plane.peak)
            for sign in (1.0, -1.0):
                signed = {variable: sign * part for variable, part in parts.items()}
                self.entries.append((self.height + np.arange(self.count), np.full(self.count, self.width - 1), -ones))
                self._at_most(signed, -sign * load)

    def _cost(self, variable: int, size: float) -> None:
        self.costs[variable * self.count : (variable + 1) * self.count] = size * self.weights

    def _torque(self, torque: PhaseTorque) -> tuple[_Parts, Array, float]:
        """A torque's factors by variable, its load, and the size by which all are divided."""
        inertia, square, drag, load = torque.values(self.a)
        size = float(np.max(4.0 * np.abs(inertia) + 4.0 * np.abs(square) + 2.0 * np.abs(drag) + np.abs(load))) or 1.0
        return {_SQUARE: square / size, _ACCELERATION: inertia / size, _VELOCITY: drag / size}, load / size, size

    def _at_most(self, parts: _Parts, right: Array) -> None:
        import clarabel

        self._put(parts, self.height + np.arange(self.count), 1.0)
        self._close(right, [clarabel.NonnegativeConeT(self.count)])

    def _cone(self, *sides: tuple[_Parts, Array]) -> None:
        """That the first side is at least the size of the two others, at every place."""
        import clarabel

        for i, (parts, _) in enumerate(sides):
            self._put(parts, self.height + 3 * np.arange(self.count) + i, -1.0)
        right = np.stack([right for _, right in sides]).T.ravel()
        self._close(right, [clarabel.SecondOrderConeT(3)] * self.count)

    def _put(self, parts: _Parts, rows: Places, sign: float) -> None:
        for variable, part in parts.items():
            self.entries.append((rows, variable * self.count + np.arange(self.count), sign * part))

    def _close(self, right: Array, cones: list[Any]) -> None:
        """The rows that were written since the last cones belong to these."""
        self.right.append(right)
        self.cones += cones
        self.height += len(right)


def _bernstein(x: Array) -> tuple[Array, Array]:
    """Values and slopes of the Bernstein polynomials on [0, 1], one row a place."""
    from scipy.special import comb

    def values(degree: int) -> Array:
        i = np.arange(degree + 1)
        return np.asarray(comb(degree, i) * x[:, None] ** i * (1.0 - x[:, None]) ** (degree - i))

    lower = np.pad(values(DEGREE - 1), ((0, 0), (1, 1)))
    return values(DEGREE), DEGREE * (lower[:, :-1] - lower[:, 1:])


def _refined(plane: PhasePlane, solved: PhaseOptimum) -> Array:
    """The elements with further ends around every change of what is active."""
    active = _active(plane, solved)
    changes = np.flatnonzero((active[:, 1:] != active[:, :-1]).any(axis=0))
    before, after = solved.s[changes], solved.s[changes + 1]
    edges = np.unique(np.concatenate([solved.edges, before, after, 0.5 * (before + after)]))
    return np.asarray(edges[np.append(True, np.diff(edges) > SMALLEST_ELEMENT)])


def _active(plane: PhasePlane, solved: PhaseOptimum) -> Array:
    """Which bounds are active at every place, one row a bound and sign."""
    a, b, c = np.sin(np.pi * solved.s / 2.0) ** 2, solved.b, solved.c

    def along(torque: PhaseTorque) -> Array:
        inertia, square, drag, load = torque.values(a)
        return inertia * c + square * b**2 + drag * b + load

    near, rows = 1.0 - PHASE_ACTIVE, [b > plane.B * (1.0 - PHASE_ACTIVE)]
    bounds = [(along(bound.torque), bound.at_rest - bound.fall * b) for bound in plane.bounds]
    if plane.peak is not None:
        bounds.append((along(plane.peak), np.full(len(b), solved.objective)))
    for torque, most in bounds:
        rows += [torque > near * most, torque < -near * most]
    for torques in plane.maxima:
        values = np.array([along(torque) for torque in torques])
        top = values.max(axis=0)
        rows += list(values > top - PHASE_ACTIVE * float(np.abs(values).max()))
    return np.array(rows)
