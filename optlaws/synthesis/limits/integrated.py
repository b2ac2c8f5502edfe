"""The value of a motion in a phase plane, by integration; nothing of it is taken from a solver.

A velocity over the position is a cap. From both ends the motion is integrated as fast as all bounds allow and as the
cap allows; the lower of both is a motion that keeps them. It is as long as it should be where the cap is scaled or,
where a peak is minimised or the time, where the peak or nothing is chosen so.

Integrals are taken by Gauss's rule in cells of one arc, that ascends, follows the cap or brakes; where arcs meet within
a cell, or one of them changes from one bound to another, it is divided into parts. A part of one arc has the arc's
acceleration in its middle: the mean between its ends breaks a bound of which one form of two must be kept, where the
forms change places. Other parts have a constant acceleration.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cache, partial
from math import exp, inf, isfinite, nan, sqrt
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from optlaws.formulas.arithmetic import NUMPY, evaluate
from optlaws.kept import kept_property
from optlaws.numbers import Array
from optlaws.numerics.chebyshev import gauss
from optlaws.numerics.roots import falling_root
from optlaws.synthesis.limits.elements import Elements
from optlaws.synthesis.limits.phase_plane import AnyTorque, PhasePlane, TorqueLimit, VelocityLimit
from optlaws.tolerances import INTEGRATION

_BOUND_KEPT = 1e-7  # of a bound: a motion that is beyond it by so little keeps it
_AT_CAP = 1e-13  # of a cap: a motion that is nearer to it is at it
_SHORTEST = 1e-12  # of the move: nodes that are nearer are one

_CELLS = 320
_PLACES, _PARTS = 4, 32
_WIDER = (1.0001, 1.001, 1.01)  # of a cap's squared velocity: motions below it take a little less than the time
_X, _SHARES = gauss(_PLACES)
#: where in a cell a motion is known: at its start, at the places of Gauss's rule, its end, and its middle
_PLACES_OF_CELL = np.concatenate([[0.0], 0.5 * (_X + 1.0), [1.0, 0.5]])
_INNER = slice(1, 1 + _PLACES)
_START, _END, _MIDDLE = 0, _PLACES + 1, _PLACES + 2
#: values in the middles of the parts of a cell, and at their ends, by those at its places
_HALVES_OF_PARTS = np.vander(0.5 * np.arange(2 * _PARTS + 1) / _PARTS, _PLACES + 2) @ np.linalg.inv(
    np.vander(_PLACES_OF_CELL[:_MIDDLE], _PLACES + 2)
)
_IN_PARTS, _OF_PARTS = _HALVES_OF_PARTS[1::2], _HALVES_OF_PARTS[::2]
#: integrals from a cell's start to its places, of its length, by values at its places
_RISES = (np.vander(_PLACES_OF_CELL, _PLACES + 3)[:, :-1] / np.arange(_PLACES + 2, 0, -1)) @ np.linalg.inv(
    np.vander(_PLACES_OF_CELL[:_MIDDLE], _PLACES + 2)
)

#: an acceleration by the factors of bounds at a place of a cell and the squared velocity, and the number of its bound
_Limit: TypeAlias = Callable[[list[Any], int, float], tuple[float, int]]


class _Motion(NamedTuple):
    """A motion: squared velocities and accelerations in cells of one arc, and squared velocities in all others."""

    w: Array
    c: Array
    mixed: NDArray[np.intp]  #: cells in which arcs meet, or bounds
    parts: Array  #: the squared velocities at the ends of their parts
    rates: Array  #: the accelerations in the middles of these


class _Arcs(NamedTuple):
    """A motion from one end: its squared velocities without the cap, and its accelerations, at the places of cells."""

    w: Array
    c: Array
    even: NDArray[np.bool_]  #: cells in which it follows one bound
    in_parts: Callable[[NDArray[np.intp]], Array]  #: the squared velocities at the ends of parts of cells


@dataclass(frozen=True, eq=False)
class MotionCells:
    """Cells of s over which motions of a phase plane are integrated.

    Attributes
    ----------
    plane
        With what is minimised, and the bounds.
    edges
        The ends of elements in which the acceleration of the cap is a polynomial.
    s, b
        The places of the elements within (0, 1), and velocities there: the cap, but for a factor.
    """

    plane: PhasePlane
    edges: tuple[float, ...]
    s: tuple[float, ...]
    b: tuple[float, ...]
    _factors: dict[AnyTorque, list[tuple[Array, Array, Array, Array]]] = field(default_factory=dict)
    #: what `_Sides` finds of a torque's forms in cells
    in_halves: dict[AnyTorque, dict[int, list[list[list[float]]]]] = field(default_factory=dict)

    @kept_property
    def elements(self) -> Elements:
        """The elements over which the cap is given."""
        return Elements(np.array(self.edges))

    @kept_property
    def ends(self) -> Array:
        """The ends of cells: even ones, ends of elements, and where torques or bounds are not smooth."""
        places = [end for limit in self.plane.windows for end in (limit.start, limit.stop)]
        places = 2.0 / np.pi * np.arcsin(np.sqrt(np.array([*places, *self.plane.kinks])))
        ends = np.unique(np.concatenate([np.linspace(0.0, 1.0, _CELLS + 1), self.edges, places]))
        return np.append(ends[:-1][np.diff(ends) > _SHORTEST], 1.0)

    @kept_property
    def lengths(self) -> Array:
        return np.asarray(np.diff(self.ends))

    @kept_property
    def places(self) -> Array:
        """The places of all cells, one row a cell."""
        return np.asarray(self.ends[:-1, None] + self.lengths[:, None] * _PLACES_OF_CELL)

    @kept_property
    def a(self) -> Array:
        """The positions at the places of cells."""
        return np.asarray(np.sin(0.5 * np.pi * self.places) ** 2)

    @kept_property
    def rate(self) -> Array:
        """The derivative of the position by s."""
        return np.asarray(0.5 * np.pi * np.sin(np.pi * self.places))

    @kept_property
    def shares(self) -> Array:
        """The weights of integrals over the position, at the Gauss places of cells."""
        return np.asarray(self.rate[:, _INNER] * 0.5 * self.lengths[:, None] * _SHARES)

    def within(self, bound: TorqueLimit | VelocityLimit) -> NDArray[np.bool_]:
        """The cells in the window of a bound."""
        middle = self.a[:, _MIDDLE]
        return np.asarray((middle > bound.start) & (middle < bound.stop))

    @kept_property
    def greatest(self) -> Array:
        """The greatest squared velocity in cells."""
        most = np.full(len(self.a), self.plane.B)
        for limit in self.plane.velocities:
            most = np.where(self.within(limit), np.minimum(most, limit.B), most)
        return np.asarray(most**2)

    @kept_property
    def cap(self) -> tuple[Array, Array]:
        """The squared velocities and accelerations of the elements' motion, at the places of cells."""
        motion = self.elements.accelerations(np.array(self.b) ** 2)
        piece = np.searchsorted(self.elements.edges, self.places[:, _MIDDLE], side="right") - 1
        w, c = self.elements.at(piece, self.places, motion)
        w = np.maximum(w, 0.0)
        w[0, _START], w[-1, _END] = 0.0, 0.0
        return w, c

    def factors(self, torque: AnyTorque) -> list[tuple[Array, Array, Array, Array]]:
        """The factors of a torque's forms at the places of cells."""
        if torque not in self._factors:
            self._factors[torque] = [branch.values(self.a) for branch in torque.branches]
        return self._factors[torque]

    def motion(self, scale: float, bounds: tuple[TorqueLimit, ...]) -> _Motion | None:
        """The fastest motion below the scaled cap within bounds; None where there is none.

        Parameters
        ----------
        scale
            Of the cap's squared velocity; infinite where there is no cap.
        bounds
            Of torques and the acceleration.
        """
        most = np.broadcast_to(self.greatest[:, None], self.a.shape)
        w, c = (self.cap[0] * scale, self.cap[1] * scale) if isfinite(scale) else (most, np.zeros_like(most))
        below = w < most * (1.0 - INTEGRATION)
        cap, c = np.where(below, w, most), np.where(below, c, 0.0)
        nothing = np.zeros(0, dtype=np.intp)
        if not bounds:
            none = np.zeros((0, _PARTS + 1))
            return _Motion(cap, c, nothing, none, none[:, 1:]) if np.isfinite(cap).all() else None
        sides = _Sides(self, bounds, cap, c)
        forward, back = sides.arcs(ahead=True), sides.arcs(ahead=False)
        if forward is None or back is None:
            return None
        several = np.array([cap, forward.w, back.w])
        lowest = several.min(axis=0)
        alone = (several <= lowest * (1.0 + _AT_CAP)).all(axis=2)
        alone[1:] &= [forward.even, back.even]
        fits, bends = np.asarray(sides.fits.all(axis=0)), below.any(axis=1) & ~below.all(axis=1)
        alone[0] &= fits & ~bends
        arc, here = np.argmax(alone, axis=0), np.arange(len(cap))
        w, c = (np.array(values)[arc, here] for values in ((cap, forward.w, back.w), (c, forward.c, back.c)))
        mixed = np.flatnonzero(~alone.any(axis=0))
        capped = np.repeat(self.greatest[mixed, None], _PARTS + 1, axis=1)
        if isfinite(scale):
            capped = np.minimum(capped, scale * (self.cap[0][mixed, :_MIDDLE] @ _OF_PARTS.T))
        both = forward.in_parts(mixed), back.in_parts(mixed)
        parts = np.minimum(np.minimum(*both), capped)
        first, last = (lowest[mixed, place, None] for place in (_START, _END))
        # where the cap winds too much about the motion, that has one acceleration
        winds = (~fits | bends)[mixed] & (several[0] <= lowest).any(axis=1)[mixed]
        winds |= self._breaks(sides, mixed, capped, capped <= parts)
        ways = np.cumsum(self._ways(mixed), axis=1)
        parts = np.where(winds[:, None], np.append(first, first + (last - first) * ways / ways[:, -1:], axis=1), parts)
        parts[:, :1], parts[:, -1:] = first, last
        parts = np.maximum(parts, 0.0)
        with np.errstate(all="ignore"):
            rates = 0.5 * np.diff(parts, axis=1) / self._ways(mixed)
        for several, ahead in zip(both, (True, False), strict=True):
            at = several <= parts * (1.0 + _AT_CAP)
            alone = at[:, 1:] & at[:, :-1] & ~winds[:, None]
            rates = np.where(alone, sides.in_middles(mixed, parts, ahead=ahead), rates)
        return _Motion(w, c, mixed, parts, rates)

    def _breaks(self, sides: _Sides, mixed: NDArray[np.intp], cap: Array, lowest: NDArray[np.bool_]) -> Array:
        """The cells in parts of which the cap is the motion, and breaks a bound between the places of the cell."""
        with np.errstate(all="ignore"):
            c = 0.5 * np.diff(cap, axis=1) / self._ways(mixed)
            most, least = (sides.in_middles(mixed, cap, ahead=ahead) for ahead in (True, False))
            beyond = (c > most + _BOUND_KEPT * np.abs(most)) | (c < least - _BOUND_KEPT * np.abs(least))
        return np.asarray((beyond & lowest[:, 1:] & lowest[:, :-1]).any(axis=1))

    def keeps(self, motion: _Motion) -> bool:
        """Whether a motion keeps the bounds at all places of cells, and in the middles of their parts."""
        more = 1.0 + _BOUND_KEPT
        whole = self._whole(motion)
        if np.any(motion.w[whole] > self.greatest[whole, None] * more) or not np.all(motion.w[whole, _INNER] > 0.0):
            return False
        if np.any(motion.parts > self.greatest[motion.mixed, None] * more) or not np.all(motion.parts[:, 1:-1] > 0.0):
            return False
        for bound in self.plane.bounds:
            within = self.within(bound)
            b = np.sqrt(motion.w)
            size = np.abs(self.torque(bound.torque, motion))
            beyond = size > (bound.at_rest - bound.fall * b) * more
            if np.any(beyond[whole & within]):
                return False
            size, b = np.abs(self.torque_in_parts(bound.torque, motion)), np.sqrt(_middles(motion.parts))
            if np.any((size > (bound.at_rest - bound.fall * b) * more)[within[motion.mixed]]):
                return False
        return True

    def _whole(self, motion: _Motion) -> NDArray[np.bool_]:
        """The cells of one arc."""
        whole = np.ones(len(self.a), dtype=bool)
        whole[motion.mixed] = False
        return whole

    def torque(self, torque: AnyTorque, motion: _Motion) -> Array:
        """A torque at the places of cells, of those of one arc."""
        return _greatest(self.factors(torque), motion.w, motion.c)

    def torque_in_parts(self, torque: AnyTorque, motion: _Motion) -> Array:
        """A torque in the middles of parts of the other cells."""
        forms = [
            tuple(factor[motion.mixed][:, :_MIDDLE] @ _IN_PARTS.T for factor in form) for form in self.factors(torque)
        ]
        return _greatest(forms, _middles(motion.parts), motion.rates)

    def _ways(self, cells: NDArray[np.intp]) -> Array:
        """The lengths of parts of cells over the position."""
        s = self.ends[cells, None] + self.lengths[cells, None] * np.arange(_PARTS + 1) / _PARTS
        half = 0.25 * np.pi * (s[:, 1:] - s[:, :-1])
        return np.asarray(np.sin(0.5 * np.pi * (s[:, 1:] + s[:, :-1])) * np.sin(2.0 * half))

    def _pace(self, motion: _Motion) -> tuple[Array, Array]:
        """The times of the places of cells of one arc, and of parts of the others."""
        whole = self._whole(motion)
        b = np.sqrt(motion.parts)
        times = self.shares[whole] / np.sqrt(motion.w[whole, _INNER])
        return times, np.asarray(2.0 * self._ways(motion.mixed) / (b[:, 1:] + b[:, :-1]))

    def time(self, motion: _Motion) -> float:
        """The time of a motion."""
        return float(sum(np.sum(times) for times in self._pace(motion)))

    def square(self, torque: AnyTorque, motion: _Motion) -> float:
        """The integral of a squared torque over the time."""
        times, in_parts = self._pace(motion)
        at_places = self.torque(torque, motion)[self._whole(motion), _INNER]
        return float(np.sum(at_places**2 * times) + np.sum(self.torque_in_parts(torque, motion) ** 2 * in_parts))

    def work_of_greater(self, first: AnyTorque, second: AnyTorque, motion: _Motion) -> float:
        """The integral over the position of the greater of two torques."""
        whole = self._whole(motion)
        at_places = np.maximum(self.torque(first, motion), self.torque(second, motion))[whole, _INNER]
        parts = np.maximum(self.torque_in_parts(first, motion), self.torque_in_parts(second, motion))
        return float(np.sum(at_places * self.shares[whole]) + np.sum(parts * self._ways(motion.mixed)))

    def peak(self, torque: AnyTorque, motion: _Motion) -> float:
        """The greatest magnitude of a torque."""
        several = [self.torque(torque, motion)[self._whole(motion)], self.torque_in_parts(torque, motion)]
        return max(float(np.max(np.abs(values), initial=0.0)) for values in several)


def _middles(parts: Array) -> Array:
    """The squared velocities in the middles of parts."""
    return np.asarray(0.5 * (parts[:, 1:] + parts[:, :-1]))


def _greatest(forms: Sequence[tuple[Array, ...]], w: Array, c: Array) -> Array:
    """The greatest of several forms of a torque."""
    b = np.sqrt(w)
    return np.asarray(
        np.max([inertia * c + square * w + drag * b + load for inertia, square, drag, load in forms], axis=0)
    )


class _Sides:
    """The greatest and the least acceleration within bounds, and motions by them from both ends, below a cap."""

    def __init__(self, cells: MotionCells, bounds: tuple[TorqueLimit, ...], cap: Array, c: Array) -> None:
        self.cells, self.cap, self.steps = cells, cap, cells.lengths.tolist()
        self.at = [cells.rate[:, place].tolist() for place in (_START, _MIDDLE, _END)]
        self.forms: list[list[tuple[Array, ...]]] = []
        for bound in bounds:
            most = np.where(cells.within(bound), bound.at_rest, inf)[:, None] + np.zeros_like(cap)
            fall = np.full_like(cap, bound.fall)
            self.forms.append([(most, fall, *form) for form in cells.factors(bound.torque)])
        with np.errstate(all="ignore"):
            fits = (c <= _limit(self.forms, cap, ahead=True)), (c >= _limit(self.forms, cap, ahead=False))
        #: cells in which the cap does not ascend too fast, and does not brake too hard
        self.fits: NDArray[np.bool_] = np.array([(fit | (cap == 0.0)).all(axis=1) for fit in fits])
        self.rows = [
            [[np.stack([factor[:, place] for factor in form]).T.tolist() for form in forms] for forms in self.forms]
            for place in (_START, _MIDDLE, _END)
        ]
        self.falls = [bound.fall for bound in bounds]
        #: the factors of forms at the ends and in the middles of the parts of cells, where they were asked for
        self.in_halves = [cells.in_halves.setdefault(bound.torque, {}) for bound in bounds]

    def in_middles(self, cells: NDArray[np.intp], parts: Array, *, ahead: bool) -> Array:
        """The greatest acceleration in the middles of parts of cells, or the least."""
        forms = [
            [
                (most[cells, :1], fall[cells, :1], *(factor[cells, :_MIDDLE] @ _IN_PARTS.T for factor in factors))
                for most, fall, *factors in several
            ]
            for several in self.forms
        ]
        return _limit(forms, _middles(parts), ahead=ahead)

    def _greatest(self, rows: list[Any], i: int, w: float) -> tuple[float, int]:
        """The greatest acceleration at a place of a cell, and the number of the bound that it is of."""
        b, greatest, by, number = sqrt(w), inf, -1, 0
        for forms in rows:
            for form in forms:
                most, fall, inertia, square, drag, load = form[i]
                if inertia > 0.0 and (c := (most - load - (fall + drag) * b - square * w) / inertia) < greatest:
                    greatest, by = c, number
                number += 1
        return greatest, by

    def _least(self, rows: list[Any], i: int, w: float) -> tuple[float, int]:
        """The least acceleration, and its bound; behind a gear with losses one of both forms may brake."""
        b, least, by, number = sqrt(w), -inf, -1, 0
        for forms in rows:
            either, form_of = inf, -1
            for form in forms:
                most, fall, inertia, square, drag, load = form[i]
                c = (fall * b - most - load - drag * b - square * w) / inertia if inertia > 0.0 else -inf
                if c < either:
                    either, form_of = c, number
                number += 1
            if either > least:
                least, by = either, form_of
        return least, by

    def arcs(self, *, ahead: bool) -> _Arcs | None:
        """The fastest motion from the first end, or the fastest that comes to rest at the last; None where it stops."""
        count, inner = len(self.steps), dict[int, tuple[list[float], bool]]()
        known = self._integrated(inner, ahead=ahead)
        if known is None:
            return None
        h, x = self.cells.lengths[:, None], _PLACES_OF_CELL
        # squared velocities and their slopes, at the starts and at the ends of cells
        w0, w1, c0, c1 = np.array(known).T[:, :, None]
        d0, d1 = 2.0 * h * c0 * self.cells.rate[:, [_START]], 2.0 * h * c1 * self.cells.rate[:, [_END]]

        bulges = np.zeros((count, 1))
        for cell, (several, _) in inner.items():  # by the value in the middle
            bulges[cell] = 16.0 * several[len(several) // 2] - 8.0 * (w0 + w1)[cell] - 2.0 * (d0 - d1)[cell]
        by_slopes = (d0 - w1 + w0) * (1.0 - x) + (w1 - w0 - d1) * x
        w = w0 + (w1 - w0) * x + x * (1.0 - x) * (by_slopes + x * (1.0 - x) * bulges)
        # the slopes that belong to these are more exact than their own
        rises = (2.0 * h * self.cells.rate * self._limit(w, ahead=ahead))[:, :_MIDDLE] @ _RISES.T
        w = w0 + rises if ahead else w1 - rises[:, [_END]] + rises
        c = self._limit(w, ahead=ahead)
        w = np.where(np.isnan(w), inf, w)
        uneven = [cell for cell, (_, changes) in inner.items() if changes]

        def in_parts(cells: NDArray[np.intp]) -> Array:
            several = w[cells, :_MIDDLE] @ _OF_PARTS.T
            for row, cell in enumerate(cells.tolist()):
                if cell in uneven:
                    several[row] = inner[cell][0]
            return np.where(np.isnan(several), inf, several)

        even = np.ones(count, dtype=bool)
        even[uneven] = False
        return _Arcs(w, c, even, in_parts)

    def _limit(self, w: Array, *, ahead: bool) -> Array:
        """The greatest acceleration at all places, or the least; at rest where no squared velocity is known."""
        with np.errstate(all="ignore"):
            return _limit(self.forms, np.where(np.isfinite(w), np.maximum(w, 0.0), 0.0), ahead=ahead)

    def _integrated(
        self, inner: dict[int, tuple[list[float], bool]], *, ahead: bool
    ) -> list[tuple[float, float, float, float]] | None:
        """Squared velocities and accelerations at both ends of cells, by Runge and Kutta's method of order 4.

        They are not numbers in cells where the motion follows the cap. The squared velocities at the ends of steps in
        cells of several are `inner`, and whether the motion changes from one bound to another there.
        """
        limit, way = (self._greatest, 1.0) if ahead else (self._least, -1.0)
        cap = self.cap if ahead else self.cap[::-1]
        begin, end = (_START, _END) if ahead else (_END, _START)
        follows, caps = (cap[:, begin] * (1.0 - _AT_CAP)).tolist(), cap[:, end].copy()
        caps[:-1] = np.minimum(caps[:-1], cap[1:, begin])
        most, fits = caps.tolist(), (self.fits[0] if ahead else self.fits[1][::-1]).tolist()
        first, middle, last = (0, 1, 2) if ahead else (2, 1, 0)
        rates = [self.at[place] for place in (first, middle, last)]
        near_rest = _steps_near_rest(self.cells.lengths if ahead else self.cells.lengths[::-1])
        w, known, count = 0.0, list[tuple[float, float, float, float]](), len(most)
        not_known = (nan,) * 4
        for k in range(count):
            i = k if ahead else count - 1 - k
            if fits[k] and w >= follows[k]:
                known.append(not_known)
                w = most[k]
                continue
            rows = self.rows[first], self.rows[middle], self.rows[last]
            more, c, several = _step(limit, rows, i, w, [2.0 * way * self.steps[i] * rate[i] for rate in rates])
            if (steps := _PARTS if several else near_rest[k]) > 1:
                in_parts = self._in_parts(limit, i, w, steps, ahead=ahead)
                inner[i], more = (in_parts if ahead else in_parts[::-1], several), in_parts[-1]
            if not more > (0.0 if k + 1 < count else -INTEGRATION * w):
                return None
            more = max(more, 0.0)
            beyond, _ = limit(self.rows[last], i, more)
            known.append((w, more, c, beyond) if ahead else (more, w, beyond, c))
            w = min(more, most[k])
        return known if ahead else known[::-1]

    def _in_parts(self, limit: _Limit, i: int, w: float, steps: int, *, ahead: bool) -> list[float]:
        """The squared velocities at the ends of steps in a cell, in the order in which it is integrated."""
        places = range(0, 2 * _PARTS + 1, _PARTS // steps)
        s = self.cells.ends[i] + self.cells.lengths[i] * np.array(places) / (2 * _PARTS)
        slopes = (np.pi * np.sin(np.pi * s) * (1.0 if ahead else -1.0) * self.cells.lengths[i] / steps).tolist()
        factors = [self._factors(number, i) for number in range(len(self.forms))]
        rows = [[[[form[place]] for form in forms] for forms in factors] for place in places]
        if not ahead:
            rows, slopes = rows[::-1], slopes[::-1]
        several = [w]
        for step in range(0, 2 * steps, 2):
            more, _, _ = _step(limit, rows[step : step + 3], 0, several[-1], slopes[step : step + 3])
            several.append(max(more, 0.0))
        return several

    def _factors(self, number: int, i: int) -> list[list[list[float]]]:
        """The factors of a bound's forms at the ends and in the middles of the parts of a cell."""
        known = self.in_halves[number]
        if i not in known:
            known[i] = [
                (_HALVES_OF_PARTS @ np.stack([factor[i, :_MIDDLE] for factor in form[2:]], axis=1)).tolist()
                for form in self.forms[number]
            ]
        most = float(self.forms[number][0][0][i, 0])
        return [[[most, self.falls[number], *factors] for factors in form] for form in known[i]]


def _limit(forms: Sequence[Sequence[tuple[Array, ...]]], w: Array, *, ahead: bool) -> Array:
    """The greatest acceleration by the forms of bounds, or the least."""
    b, limit = np.sqrt(w), np.full_like(w, inf)
    for several in forms:
        by_forms = []
        for most, fall, inertia, square, drag, load in several:
            with np.errstate(all="ignore"):
                free = drag * b + square * w + load
                by = (most - fall * b - free) / inertia if ahead else (fall * b - most - free) / inertia
            by_forms.append(np.where(inertia > 0.0, by, inf if ahead else -inf))
        either = np.min(by_forms, axis=0)
        limit = np.minimum(limit, either if ahead else -either)
    return np.asarray(limit if ahead else -limit)


def _steps_near_rest(lengths: Array) -> list[int]:
    """How many steps cells have, from one at rest on, a power of 2: each is short beside its distance from there.

    Near rest the relative error of a squared velocity counts, which is as small as the velocity.
    """
    gone = np.concatenate([[_SHORTEST], np.cumsum(lengths[:-1])])
    steps = 0.5 * _PARTS * lengths / gone
    return [int(count) for count in 2.0 ** np.ceil(np.log2(np.clip(steps, 1.0, _PARTS)))]


def _step(
    limit: _Limit, rows: Sequence[list[Any]], i: int, w: float, slopes: Sequence[float]
) -> tuple[float, float, bool]:
    """A squared velocity a step on, the acceleration before it, and whether bounds change places in it.

    Parameters
    ----------
    limit
        The acceleration at a place, and the number of its bound.
    rows
        The factors of the bounds at the first place, in the middle and at the last place.
    i, w
        The cell, and the squared velocity at the first place.
    slopes
        Twice the derivatives of the position at these places, times the step.
    """
    c, by = limit(rows[0], i, w)
    rises, several = [slopes[0] * c], False
    for share, place in ((0.5, 1), (0.5, 1), (1.0, 2)):
        rate, other = limit(rows[place], i, max(w + share * rises[-1], 0.0))
        rises.append(slopes[place] * rate)
        several |= other != by
    return w + (rises[0] + 2.0 * (rises[1] + rises[2]) + rises[3]) / 6.0, c, several


def value_of(plane: PhasePlane, edges: tuple[float, ...], s: tuple[float, ...], b: tuple[float, ...]) -> float:
    """What is minimised, of a motion in the time 1 that keeps all bounds; infinite where none is found.

    Parameters
    ----------
    plane
        With what is minimised, and the bounds.
    edges
        The ends of elements.
    s, b
        The places of the elements, and velocities near those of the motion.
    """
    cells = MotionCells(plane, edges, s, b)
    with np.errstate(all="ignore"):
        if plane.kind == "time":
            motion = cells.motion(inf, plane.bounds)
            return cells.time(motion) if motion is not None and cells.keeps(motion) else inf
        if plane.peak is not None:
            return _of_peak(cells)
        if len(s) != len(cells.elements.s) or not np.allclose(s, cells.elements.s, rtol=0.0, atol=_SHORTEST):
            return inf
        return _of_mean(cells)


def _of_mean(cells: MotionCells) -> float:
    """The least mean of motions by the scaled cap: in the whole time, and at rest for some of it."""

    @cache
    def motion(by: float) -> _Motion | None:
        return cells.motion(exp(2.0 * by), cells.plane.bounds)

    known = [motion(by) for by in (0.0, *_root(partial(_excess, cells, motion)))]
    return min((_mean(cells, each) for each in known if each is not None), default=inf)


def _excess(cells: MotionCells, motion: Callable[[float], _Motion | None], by: float) -> float:
    """By how much a motion takes more than the time 1; infinite where there is none."""
    known = motion(by)
    return inf if known is None else cells.time(known) - 1.0


def _mean(cells: MotionCells, motion: _Motion) -> float:
    """The mean of a motion that rests for what is left of the time; infinite where it breaks a bound."""
    plane = cells.plane
    rest = 1.0 - cells.time(motion)
    if rest < -INTEGRATION or not cells.keeps(motion):
        return inf
    total = 0.0
    if plane.squared is not None:
        hold = min(abs(torque) for torque in _holding(plane))
        total += plane.heat * (cells.square(plane.squared, motion) + max(rest, 0.0) * hold**2)
    for first, second in plane.maxima:
        total += cells.work_of_greater(first, second, motion)
    return total


def _of_peak(cells: MotionCells) -> float:
    """The least peak of a motion in the whole time, or with a rest in it: as fast as bounds allow, or below the cap."""
    best, exceeded = _least_peak(cells, inf)
    if exceeded and len(cells.s) == len(cells.elements.s):
        best = min([best, *(_least_peak(cells, scale)[0] for scale in _WIDER)])
    return best


def _least_peak(cells: MotionCells, scale: float) -> tuple[float, bool]:
    """The least peak of motions below a scaled cap, and whether it is above the bound within which it was found.

    Where bounds leave no acceleration, the fastest motion breaks one of them, which slower motions may keep.
    """
    plane = cells.plane
    assert plane.peak is not None  # noqa: S101 - it is minimised
    torque = plane.peak

    @cache
    def motion(by: float) -> _Motion | None:
        known = cells.motion(scale, (*plane.bounds, TorqueLimit(torque, torque.size * exp(by))))
        return known if known is not None and cells.keeps(known) else None

    for by in _root(partial(_excess, cells, motion)):
        known = motion(by)
        if known is None:
            continue
        peak, rest = cells.peak(torque, known), 1.0 - cells.time(known)
        exceeded = peak > torque.size * exp(by) * (1.0 + _BOUND_KEPT)
        if rest > INTEGRATION:
            peak = max(peak, min(abs(holding) for holding in _holding(plane)))
        if rest >= -INTEGRATION:
            return peak, exceeded
    return inf, True


def _root(excess: Callable[[float], float]) -> tuple[float, ...]:
    """The logarithm at which a falling excess is not above 0; at most one."""
    root = falling_root(excess, 0.0, 0.5, 0.1 * INTEGRATION)
    return (root,) if root < inf else ()


def _holding(plane: PhasePlane) -> list[float]:
    """The torques that hold the load at both ends."""
    torque, ends = plane.squared or plane.peak, np.array([0.0, 1.0])
    if plane.holding is not None:
        values = np.asarray(evaluate(plane.holding, {"a": ends}, NUMPY), dtype=np.float64)
        return [float(value) for value in np.broadcast_to(values, 2)]
    assert torque is not None  # noqa: S101 - what holds is of a torque
    return [float(value) for value in np.max([branch.values(ends)[3] for branch in torque.branches], axis=0)]
