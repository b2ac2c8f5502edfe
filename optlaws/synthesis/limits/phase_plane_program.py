"""The optimum of a phase plane as a conic program on few places, refined where what is active changes.

The position is a = sin²(pi s/2), so that velocities, which begin and end with the root of a, are smooth in s. The
equation of motion w' = 2 c is tested with functions J phi(s)/sin(pi s), phi piecewise polynomials; its multipliers are
the potential q(a) = J(a) pi(s)/sin(pi s), J the inertia of the plane's reference, from which every bound follows.

Behind a gear with losses |torque| <= s is that neither branch is above s, and that one of both is not below -s: the one
in which the last motion was. So the resulting motion satisfies the bounds, but need not be the best.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from math import inf
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from optlaws.errors import SolverFailure
from optlaws.numbers import Array
from optlaws.numerics.chebyshev import gauss
from optlaws.numerics.cones import conic_optimum, usable
from optlaws.synthesis.limits.elements import Elements
from optlaws.synthesis.limits.phase_plane import (
    AnyTorque,
    GearTorque,
    PhasePlane,
    PhaseTorque,
    TorqueLimit,
    VelocityLimit,
)
from optlaws.synthesis.limits.standing import Standing
from optlaws.tolerances import SMALLEST_SIZE

_PHASE_SOLVER = 1e-8  # what the solver of cones is told to leave of gap and feasibility
_PHASE_ACTIVE = 1e-4  # of a bound: places of a conic program so near to it have it active
_SMALLEST_ELEMENT = 1e-7  # of the move: elements of a potential are not cut further
_PHASE_TIGHT = 1e-7  # of a bound: by so much narrower is what the motion of a limit keeps to
_PHASE_PACE = 1e-5  # of what is minimised: the least price of the time

DEGREE = 4
_ELEMENTS = 8
_ROUNDS = 3
_VARIABLES = 4
#: the first Bernstein coefficient of degree 4 by the others, where the degree is 3
_LOWER = (4.0, -6.0, 4.0, -1.0)
#: where the solver stopped without an answer
_STOPPED = {"InsufficientProgress", "MaxIterations", "NumericalError"}


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
    driven
        Behind a gear with losses: places, and whether the power of a motor that brakes flows to the load before each of
        them and after the last.
    beyond
        Whether w is beyond the square of the greatest velocity, where only b is bounded.
    """

    edges: Array
    potential: Array
    weight: float
    s: Array
    b: Array
    c: Array
    objective: float
    driven: tuple[tuple[float, ...], tuple[bool, ...]]
    beyond: bool

    @property
    def velocities(self) -> Array:
        """The velocities at the places that the accelerations there make; those of the places where they make none."""
        w, _ = Elements(self.edges).squares(self.c)
        return np.asarray(np.sqrt(w) if np.all(w > 0.0) else self.b)


def optimum(standing: Standing, rounds: int = _ROUNDS, more: int = 1) -> PhaseOptimum:
    """The optimum of a phase plane, on elements that end where bounds become active or inactive.

    Parameters
    ----------
    standing
        The plane, with what is minimised and within which bounds, and the level about which a torque is squared.
    rounds
        How often the program is solved, each time on finer elements around every change.
    more
        How many times as many elements it has at first.

    Raises
    ------
    SolverFailure
        If no motion keeps the bounds, or the program was not solved.
    """
    plane = standing.shifted
    kinks = _in_s(plane.kinks)
    edges = np.union1d(np.linspace(0.0, 1.0, more * _ELEMENTS + 1), kinks)
    solved, pace = _first(standing, edges), 0.0
    strict = False
    if solved.beyond:
        other = _Program(standing, edges, pace, solved.driven, strict=True).solved()
        strict = other.objective > solved.objective * (1.0 + _PHASE_ACTIVE)
        solved = other if strict else solved
    if plane.kind != "time" and solved.weight < _PHASE_PACE * abs(solved.objective):
        # where the time costs nothing, velocities are not determined: it is given a little price
        pace = _PHASE_PACE * abs(solved.objective)
        solved = _Program(standing, edges, pace, _driven(plane, solved), strict=strict).solved()
    for _ in range(rounds - 1):
        finer, driven = _refined(plane, solved), _driven(plane, solved)
        if len(finer) == len(solved.edges) and driven == solved.driven:
            break
        try:
            solved = _Program(standing, finer, pace, driven, strict=strict).solved()
        except SolverFailure:
            if plane.gear_load is None:
                raise
            break
    if solved.beyond and not strict:  # the prices are right, but the motion is not
        with suppress(SolverFailure):
            other = _Program(standing, solved.edges, pace, solved.driven, strict=True).solved()
            solved = replace(solved, b=other.b, c=other.c)
    return solved


def _in_s(positions: Sequence[float]) -> Array:
    return np.asarray(2.0 / np.pi * np.arcsin(np.sqrt(np.array(positions))))


#: where power flows to the load: places, and whether it does so up to the next place
_Driven: TypeAlias = tuple[tuple[float, ...], tuple[bool, ...]]


def _first(standing: Standing, edges: Array) -> PhaseOptimum:
    """The optimum as if power flowed back wherever a motor brakes or, where that fails, nowhere."""
    try:
        return _Program(standing, edges, 0.0, ((0.5,), (False, False))).solved()
    except SolverFailure:
        if standing.plane.gear_load is None:
            raise
        return _Program(standing, edges, 0.0, ((0.5,), (True, True))).solved()


def _driven(plane: PhasePlane, solved: PhaseOptimum) -> _Driven:
    """Places where the power of a braking motor changes its direction, and the intervals between them."""
    if plane.gear_load is None:
        return solved.driven
    torque = next(torque for torque in plane.torques if isinstance(torque, GearTorque))
    value = _along(torque, solved)
    # where it does not brake it would as hard as it drives or, where a bound counts, as hard as anywhere
    most = np.abs(value) if plane.squared is not None else float(np.abs(value).max())
    a = np.sin(np.pi * solved.s / 2.0) ** 2
    least = []
    for inertia, square, drag, load in (branch.values(a) for branch in torque.branches):
        least.append((-most - (square * solved.b + drag) * solved.b - load) / np.maximum(inertia, SMALLEST_SIZE))
    positive = np.where(value < 0.0, _along(plane.gear_load, solved) > 0.0, least[0] < least[1])
    changes = np.flatnonzero(positive[1:] != positive[:-1])
    places = 0.5 * (solved.s[changes] + solved.s[changes + 1])
    return tuple(places.tolist()), tuple(positive[np.append(changes, len(positive) - 1)].tolist())


#: factors of variables at the places, by variable: w = b², c, b and 1/b, then slacks
_Parts: TypeAlias = dict[int, Array]
Places: TypeAlias = NDArray[np.intp]
_SQUARE, _ACCELERATION, _VELOCITY, _PACE = range(_VARIABLES)


class _Program:
    """The conic program on given elements: variables at every place, and the peak."""

    def __init__(self, standing: Standing, edges: Array, pace: float, driven: _Driven, *, strict: bool = False) -> None:
        self.standing, self.plane = standing, standing.shifted
        plane = self.plane
        self.edges, self.pace, self.driven, self.strict = edges, pace, driven, strict
        x, share = gauss(DEGREE)
        lengths = np.diff(edges)
        self.s = (edges[:-1, None] + lengths[:, None] * (x + 1.0) / 2.0).ravel()
        self.a, self.sine = np.sin(np.pi * self.s / 2.0) ** 2, np.sin(np.pi * self.s)
        self.count = len(self.s)
        self.weights = (lengths[:, None] * share / 2.0).ravel() * np.pi / 2.0 * self.sine
        self.drives = np.array(driven[1])[np.searchsorted(np.array(driven[0]), self.s)]
        slacks = len(plane.maxima) + (len(plane.squared.branches) if plane.squared is not None else 0)
        #: ends of elements at which the potential may jump, and before every element how many there were
        self.jumps = np.flatnonzero(np.isin(edges, _in_s(plane.jumps)))
        self.before = np.searchsorted(self.jumps, np.arange(len(edges) - 1), side="right")
        self.columns = (_VARIABLES + slacks) * self.count
        self.width = self.columns + len(self.jumps) + 1
        self.height = 0
        self.entries: list[tuple[Places, Places, Array]] = []
        self.right: list[Array] = []
        self.cones: list[Any] = []
        self.costs = np.zeros(self.width)
        self.constant = 0.0
        self._write_motion((x + 1.0) / 2.0)
        self._write()

    def solved(self) -> PhaseOptimum:
        import clarabel
        from scipy.sparse import csc_matrix, vstack

        rows, columns, values = (np.concatenate(several) for several in zip(*self.entries, strict=True))
        matrix = csc_matrix((values, (rows, columns)), shape=(self.height, self.width))
        unit = float(np.abs(self.costs).max() / self.weights.max()) or 1.0
        right = np.concatenate(self.right)
        tests = self.count + 1 + len(self.jumps)
        smooth = self._smooth_tests(tests)
        if len(self.jumps):
            matrix, right = vstack([smooth.T @ matrix[:tests], matrix[tests:]], format="csc"), right[len(self.jumps) :]
            self.cones[0] = clarabel.ZeroConeT(self.count + 1)
        result = conic_optimum(None, self.costs / unit, matrix, right, self.cones, tolerance=_PHASE_SOLVER)
        x, z = np.array(result.x), np.array(result.z)
        # where it stopped early what it has is no optimum, but a motion and a potential that are checked without it
        stopped = str(result.status) in _STOPPED and np.isfinite(x).all() and np.isfinite(z).all()
        if not (usable(result) or stopped):
            raise SolverFailure(f"no motion in the phase plane was found within the bounds: {result.status}")
        places = self._tests(np.arange(len(self.edges) - 1))
        weight = unit * float(z[self.count + 1]) + self.pace if self.plane.kind != "time" else 1.0
        time = float(self.weights @ x[_PACE * self.count : (_PACE + 1) * self.count])
        c, b = (x[i * self.count : (i + 1) * self.count] for i in (_ACCELERATION, _VELOCITY))
        # where the time costs little b may be below the root of w, which is what accelerations change
        b = np.maximum(
            b, np.minimum(np.sqrt(np.maximum(x[: self.count], 0.0)), self.plane.velocity_bound(self.a, self.a))
        )
        potential = -unit * (smooth @ z[: self.count + 1])[places]
        beyond = bool(np.any(x[: self.count] > (self.plane.B * (1.0 + _PHASE_ACTIVE)) ** 2))
        objective = unit * float(result.obj_val) - self.pace * time + self.constant
        weight = max(weight, 0.0)
        return PhaseOptimum(self.edges, potential, weight, self.s, b, c, objective, self.driven, beyond)

    def _write_motion(self, x: Array) -> None:
        """The equation of motion, tested with functions J phi/sin(pi s), as equality constraints of the program."""
        import clarabel

        values, slopes = _bernstein(x)
        lengths = np.diff(self.edges)
        inertia, by_a = self.plane.reference.values(self.a)[0], self.plane.reference.inertia_slope(self.a)
        element, place = np.divmod(np.arange(self.count), DEGREE)
        phi, by_s = values[place], slopes[place] / lengths[element][:, None]
        sine, cosine = self.sine[:, None], np.cos(np.pi * self.s)[:, None]
        rate = inertia[:, None] / (np.pi / 2.0 * sine) * (by_s / sine - np.pi * cosine / sine**2 * phi)
        rate += (by_a / self.sine)[:, None] * phi
        row = self._tests(element)
        column = np.broadcast_to(np.arange(self.count)[:, None], row.shape)
        weights = self.weights[:, None]
        for variable, factor in ((_SQUARE, rate), (_ACCELERATION, 2.0 * (inertia[:, None] / sine) * phi)):
            self.entries.append((row.ravel(), (variable * self.count + column).ravel(), (weights * factor).ravel()))
        self._write_jumps()
        tests = self.count + 1 + len(self.jumps)
        self._close(np.zeros(tests), [clarabel.ZeroConeT(tests)])

    def _tests(self, elements: Places) -> Places:
        """The rows of the functions of elements with which the equation is tested."""
        return (elements * DEGREE + self.before[elements])[:, None] + np.arange(DEGREE + 1)

    def _smooth_tests(self, tests: int) -> Any:
        """The elements' test functions by the program's, of lower degree after a jump, so that they match the places.

        Of degree 4 there is one that vanishes at all places of an element, and nothing would hold it.
        """
        from scipy.sparse import csc_matrix

        first = self._tests(self.jumps)[:, 0] if len(self.jumps) else np.zeros(0, dtype=np.intp)
        others = np.setdiff1d(np.arange(tests), first)
        column = np.full(tests, -1)
        column[others] = np.arange(len(others))
        parts = column[first[:, None] + np.arange(1, DEGREE + 1)]
        rows = np.concatenate([others, np.repeat(first, DEGREE)])
        shares = np.concatenate([np.ones(len(others)), np.tile(_LOWER, len(first))])
        return csc_matrix((shares, (rows, np.concatenate([column[others], parts.ravel()]))), shape=(tests, len(others)))

    def _write_jumps(self) -> None:
        """Jumps of w between neighbouring functions, each with a variable."""
        for i, edge in enumerate(self.jumps):
            s = self.edges[edge : edge + 1]
            size = self.plane.reference.values(np.sin(np.pi * s / 2.0) ** 2)[0] / np.sin(np.pi * s)
            left, right = self._tests(np.array([edge - 1, edge]))
            rows, column = np.array([left[-1], right[0]]), np.full(2, self.columns + i)
            self.entries.append((rows, column, np.concatenate([-size, size])))

    def _write(self) -> None:
        """All other rows with their cones, and the objective."""
        import clarabel

        plane, ones, tight = self.plane, np.ones(self.count), 1.0 - _PHASE_TIGHT
        if plane.kind == "time":
            self._cost(_PACE, 1.0)
        else:
            self._cost(_PACE, self.pace)
            places = _PACE * self.count + np.arange(self.count)
            self.entries.append((np.full(self.count, self.height), places, self.weights))
            self._close(np.full(1, tight), [clarabel.NonnegativeConeT(1)])
        if inf > plane.B:
            # of both the first has the more accurate prices, but where energy would be stored beyond it
            self._at_most(
                {_SQUARE: ones} if self.strict else {_VELOCITY: ones}, (tight * plane.B) ** (1 + self.strict) * ones
            )
        self._bound_jumps()
        for limit in plane.velocities:
            self._at_most({_SQUARE: ones}, (tight * limit.B) ** 2 * ones, self._within(limit))
        for bound in plane.bounds:
            sides, size = self._sides(bound.torque)
            for parts, load in sides:
                falling = {**parts, _VELOCITY: parts[_VELOCITY] + tight * bound.fall / size}
                self._at_most(falling, tight * bound.at_rest / size - load, self._within(bound))
        # b² <= w and 1 <= b y
        self._cone(({_SQUARE: ones}, ones), ({_VELOCITY: 2.0 * ones}, 0.0 * ones), ({_SQUARE: ones}, -ones))
        ways = {_VELOCITY: ones, _PACE: ones}, {_VELOCITY: -ones, _PACE: ones}
        self._cone((ways[0], 0.0 * ones), ({}, 2.0 * ones), (ways[1], 0.0 * ones))
        if plane.squared is not None:
            self._write_squared(plane.squared)
            self._cost_mean()
        for i, torques in enumerate(plane.maxima, self.columns // self.count - len(plane.maxima)):
            self._write_maximum([branch for torque in torques for branch in torque.branches], i)
        if plane.peak is not None:
            sides, self.costs[-1] = self._sides(plane.peak)
            for parts, load in sides:
                self.entries.append((self.height + np.arange(self.count), np.full(self.count, self.width - 1), -ones))
                self._at_most(parts, -load)

    def _cost_mean(self) -> None:
        """What the mean torque of a level adds to the objective."""
        A, B1, L = (term * self.weights for term in self.standing.values(0, self.a))
        for variable, values in ((_VELOCITY, B1), (_PACE, np.maximum(L, 0.0))):
            self.costs[variable * self.count : (variable + 1) * self.count] += values
        self.constant = float(A.sum() + self.standing.offset.middle)

    def _write_squared(self, torque: AnyTorque) -> None:
        """The rows of a squared torque; behind a gear with losses of what is at least its magnitude."""
        ones, slack = np.ones(self.count), _VARIABLES
        sides, size = self._sides(torque)
        parts, load = sides[0]
        if len(torque.branches) > 1:
            for side, more in sides:
                self._at_most({**side, slack + 1: -ones}, -more)
            parts, load = {slack + 1: ones}, 0.0 * ones
        double = {variable: 2.0 * part for variable, part in parts.items()}
        ways = {_VELOCITY: ones, slack: ones}, {_VELOCITY: -ones, slack: ones}
        self._cone((ways[0], 0.0 * ones), (double, 2.0 * load), (ways[1], 0.0 * ones))
        self._cost(slack, self.plane.heat * size**2)

    def _write_maximum(self, branches: list[PhaseTorque], slack: int) -> None:
        """The rows of a variable that is at least several torques."""
        size = max(self._torque(branch)[2] for branch in branches)
        for branch in branches:
            parts, load, scale = self._torque(branch)
            scaled = {variable: scale / size * part for variable, part in parts.items()}
            self._at_most({**scaled, slack: -np.ones(self.count)}, -scale / size * load)
        self._cost(slack, size)

    def _bound_jumps(self) -> None:
        """Rows that keep w within its bounds where the potential may jump."""
        import clarabel

        count = len(self.jumps)
        if count:
            a = np.sin(np.pi * self.edges[self.jumps] / 2.0) ** 2
            self.entries.append((self.height + np.arange(count), self.columns + np.arange(count), np.ones(count)))
            self._close(self.plane.velocity_bound(a, a) ** 2, [clarabel.NonnegativeConeT(count)])

    def _cost(self, variable: int, size: float) -> None:
        self.costs[variable * self.count : (variable + 1) * self.count] = size * self.weights

    def _torque(self, torque: PhaseTorque) -> tuple[_Parts, Array, float]:
        """A torque's factors by variable, its load, and the size by which all are divided."""
        inertia, square, drag, load = torque.values(self.a)
        size = float(np.max(4.0 * np.abs(inertia) + 4.0 * np.abs(square) + 2.0 * np.abs(drag) + np.abs(load))) or 1.0
        return {_SQUARE: square / size, _ACCELERATION: inertia / size, _VELOCITY: drag / size}, load / size, size

    def _sides(self, torque: AnyTorque) -> tuple[list[tuple[_Parts, Array]], float]:
        """Torques, divided by a scale, whose greatest one is the magnitude of a torque, with their loads."""
        branches = [self._torque(branch) for branch in torque.branches]
        size = branches[0][2]
        scaled = [
            ({variable: scale / size * part for variable, part in parts.items()}, scale / size * load)
            for parts, load, scale in branches
        ]
        (first, first_load), (last, last_load) = scaled[0], scaled[-1]
        braking = {variable: -np.where(self.drives, first[variable], last[variable]) for variable in first}
        return [*scaled, (braking, -np.where(self.drives, first_load, last_load))], size

    def _within(self, limit: TorqueLimit | VelocityLimit) -> Places:
        """The places within the window of a bound."""
        return np.flatnonzero((self.a >= limit.start) & (self.a <= limit.stop))

    def _at_most(self, parts: _Parts, right: Array, places: Places | None = None) -> None:
        import clarabel

        at = np.arange(self.count) if places is None else places
        rows = self.height + np.arange(len(at))
        for variable, part in parts.items():
            self.entries.append((rows, variable * self.count + at, part[at]))
        self._close(right[at], [clarabel.NonnegativeConeT(len(at))])

    def _cone(self, *sides: tuple[_Parts, Array]) -> None:
        """Rows for a cone: the first side is at least the norm of the two others, at every place."""
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
    ends = np.sort(_in_s([end for limit in plane.windows for end in (limit.start, limit.stop)]))
    # at the end of a window there is an end already
    changes = changes[np.searchsorted(ends, solved.s[changes]) == np.searchsorted(ends, solved.s[changes + 1])]
    before, after = solved.s[changes], solved.s[changes + 1]
    edges = np.unique(np.concatenate([solved.edges, before, after, 0.5 * (before + after)]))
    far = np.append(True, np.diff(edges) > _SMALLEST_ELEMENT)
    return np.asarray(edges[far | np.isin(edges, _in_s(plane.jumps))])


def _along(torque: AnyTorque, solved: PhaseOptimum) -> Array:
    """A torque at the places of a motion."""
    a, b, c = np.sin(np.pi * solved.s / 2.0) ** 2, solved.b, solved.c

    def of(branch: PhaseTorque) -> Array:
        inertia, square, drag, load = branch.values(a)
        return np.asarray(inertia * c + square * b**2 + drag * b + load)

    return np.asarray(np.max([of(branch) for branch in torque.branches], axis=0))


def _active(plane: PhasePlane, solved: PhaseOptimum) -> Array:
    """A mask of active bounds at every place, with a row for each bound and sign."""
    near, a = 1.0 - _PHASE_ACTIVE, np.sin(np.pi * solved.s / 2.0) ** 2
    rows = [solved.b > near * np.minimum(plane.B, plane.velocity_bound(a, a))]
    bounds = []
    for bound in plane.bounds:
        within = (a >= bound.start) & (a <= bound.stop)
        most = np.where(within, bound.at_rest - bound.fall * solved.b, inf)
        bounds.append((_along(bound.torque, solved), most))
    if plane.peak is not None:
        bounds.append((_along(plane.peak, solved), np.full(len(solved.b), solved.objective)))
    for torque, most in bounds:
        rows += [torque > near * most, torque < -near * most]
    for torques in plane.maxima:
        values = np.array([_along(torque, solved) for torque in torques])
        top = values.max(axis=0)
        rows += list(values > top - _PHASE_ACTIVE * float(np.abs(values).max()))
    if plane.gear_load is not None:  # what its direction is counts where torques have prices
        load = _along(plane.gear_load, solved)
        counts = np.any(rows[1:], axis=0) | (plane.squared is not None)
        rows += [counts & (sign * load > _PHASE_ACTIVE * float(np.abs(load).max())) for sign in (1.0, -1.0)]
    return np.array(rows)
