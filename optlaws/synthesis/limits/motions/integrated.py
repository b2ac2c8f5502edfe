"""The value of a motion in a phase plane, by integration on fine nodes; nothing of it is taken from a solver.

A velocity over the position is a cap. From both ends the motion is integrated as fast as all bounds allow and as the
cap allows; the lower of both is a motion that keeps them. It is as long as it should be where the cap is scaled or,
where a peak is minimised or the time, where the peak or nothing is chosen so.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from math import exp, inf, isfinite, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from optlaws.formulas.arithmetic import NUMPY, evaluate
from optlaws.kept import kept_property
from optlaws.numbers import Array
from optlaws.synthesis.limits.phase_plane import PhasePlane, TorqueLimit, VelocityLimit
from optlaws.synthesis.limits.phase_torque import ACCELERATION, AnyTorque
from optlaws.tolerances import INTEGRATION, SMALLEST_SIZE, WINDOW_EDGE

_BOUND_KEPT = 1e-6  # of a bound: a motion integrated at nodes that is beyond it by so little keeps it

_NODES, _STEPS, _WIDEST = 1200, 40, 60.0


class _Motion(NamedTuple):
    """A motion at nodes: squared velocities, and accelerations; without these they are constant in cells."""

    w: Array
    c: Array | None


@dataclass(frozen=True)
class MotionNodes:
    """Nodes of s at which motions of a phase plane are integrated.

    Attributes
    ----------
    plane
        With what is minimised, and the bounds.
    s, b
        Places within (0, 1), and velocities there: the cap, but for a factor.
    """

    plane: PhasePlane
    s: tuple[float, ...]
    b: tuple[float, ...]

    @kept_property
    def nodes(self) -> Array:
        """The nodes from 0 to 1: even ones, given places, and where windows begin and end."""
        ends = np.array([end for limit in self.plane.windows for end in (limit.start, limit.stop)])
        ends = 2.0 / np.pi * np.arcsin(np.sqrt(ends))
        return np.unique(np.concatenate([np.linspace(0.0, 1.0, _NODES + 1), self.s, ends]))

    @kept_property
    def a(self) -> Array:
        """The positions of the nodes."""
        return np.asarray(np.sin(0.5 * np.pi * self.nodes) ** 2)

    @kept_property
    def rate(self) -> Array:
        """The derivative of the position by s."""
        return np.asarray(0.5 * np.pi * np.sin(np.pi * self.nodes) * (self.nodes < 1.0))

    def within(self, bound: TorqueLimit | VelocityLimit) -> NDArray[np.bool_]:
        """The nodes in the window of a bound, its ends among them."""
        return np.asarray((self.a >= bound.start - WINDOW_EDGE) & (self.a <= bound.stop + WINDOW_EDGE))

    @kept_property
    def greatest(self) -> Array:
        """The greatest squared velocity at nodes."""
        most = np.full(len(self.a), self.plane.B)
        for limit in self.plane.velocities:
            most = np.where(self.within(limit), np.minimum(most, limit.B), most)
        return np.asarray(most**2)

    @kept_property
    def cap(self) -> Array:
        """The squared velocity of the given places."""
        from scipy.interpolate import PchipInterpolator

        if self.plane.squared is None:  # a motion that is fast and even, with corners
            shape = PchipInterpolator([0.0, *self.s, 1.0], [0.0, *self.b, 0.0])
            cap = np.maximum(shape(self.nodes), SMALLEST_SIZE) ** 2
        else:  # a smooth one
            places = np.array(self.s)
            shape = PchipInterpolator(places, np.array(self.b) / np.sin(np.pi * places), extrapolate=True)
            cap = (np.maximum(shape(self.nodes), SMALLEST_SIZE) * np.sin(np.pi * self.nodes)) ** 2
        cap[[0, -1]] = 0.0
        return np.asarray(cap)

    def torque(self, torque: AnyTorque, w: Array, c: Array) -> Array:
        """A torque at nodes."""
        several = []
        for inertia, square, drag, load in self.factors(torque):
            several.append(inertia * c + square * w + drag * np.sqrt(w) + load)
        return np.asarray(np.max(several, axis=0))

    def factors(self, torque: AnyTorque) -> list[tuple[Array, Array, Array, Array]]:
        """The factors of a torque's forms at nodes."""
        if torque not in self._factors:
            self._factors[torque] = [branch.values(self.a) for branch in torque.branches]
        return self._factors[torque]

    @kept_property
    def _factors(self) -> dict[AnyTorque, list[tuple[Array, Array, Array, Array]]]:
        return {}

    def motion(self, scale: float, bounds: tuple[TorqueLimit, ...]) -> _Motion | None:
        """The fastest motion below the scaled cap within bounds; None where there is none.

        Parameters
        ----------
        scale
            Of the cap's squared velocity; infinite where there is no cap.
        bounds
            Of torques and the acceleration.
        """
        capped = isfinite(scale)
        cap = np.minimum(self.greatest, self.cap * scale) if capped else self.greatest
        if not bounds:
            return _Motion(cap, None) if np.isfinite(cap).all() else None
        if all(bound == TorqueLimit(ACCELERATION, bound.at_rest) for bound in bounds):
            return self._by_acceleration(cap, min(bound.at_rest for bound in bounds))
        sides = _Sides(self, bounds)
        forward, back = sides.forward(cap), sides.backward(cap)
        if forward is None or back is None:
            return None
        modes = np.array([cap, forward, back])
        mode, here = np.argmin(modes, axis=0), np.arange(len(cap))
        c = None if capped else np.array([np.zeros_like(cap), sides.fastest, sides.slowest])[mode, here]
        return _Motion(modes[mode, here], c)

    def _by_acceleration(self, cap: Array, most: float) -> _Motion:
        """The fastest motion below a cap within an acceleration: from any node before, and to any after."""
        rise, left = 2.0 * most * self.a, 2.0 * most * np.cos(0.5 * np.pi * self.nodes) ** 2
        cap = cap.copy()
        cap[[0, -1]] = 0.0
        forward = np.minimum.accumulate(cap - rise) + rise
        back = np.minimum.accumulate((cap - left)[::-1])[::-1] + left
        return _Motion(np.minimum(forward, back), None)

    def keeps(self, motion: _Motion) -> bool:
        """Whether a motion keeps the bounds at all nodes, and its acceleration those in the middle of cells."""
        w, more = motion.w, 1.0 + _BOUND_KEPT
        if np.any(w > self.greatest * more) or not np.all(w[1:-1] > 0.0):
            return False
        for bound in self.plane.bounds:
            within = self.within(bound)
            most = (bound.at_rest - bound.fall * np.sqrt(w)) * more
            if motion.c is not None:
                size = np.abs(self.torque(bound.torque, w, motion.c))
            else:
                size, within = np.abs(self.middle(bound.torque, motion)), within[1:] & within[:-1]
                most = 0.5 * (most[1:] + most[:-1])
            if np.any(within & (size > most)):
                return False
        return True

    def middle(self, torque: AnyTorque, motion: _Motion) -> Array:
        """A torque in the middles of cells of a motion whose acceleration is constant in each."""
        w, c = 0.5 * (motion.w[1:] + motion.w[:-1]), self.accelerations(motion)
        several = []
        for form in self.factors(torque):
            inertia, square, drag, load = (0.5 * (factor[1:] + factor[:-1]) for factor in form)
            several.append(inertia * c + square * w + drag * np.sqrt(w) + load)
        return np.asarray(np.max(several, axis=0))

    def accelerations(self, motion: _Motion) -> Array:
        """The accelerations in cells, where each has one."""
        return np.asarray(0.5 * np.diff(motion.w) / np.diff(self.a))

    def times(self, motion: _Motion) -> Array:
        """The times of cells in which the acceleration is constant."""
        b = np.sqrt(motion.w)
        return np.asarray(2.0 * np.diff(self.a) / (b[1:] + b[:-1]))

    def time(self, motion: _Motion) -> float:
        """The time of a motion."""
        return float(np.sum(self.times(motion)))

    def square(self, torque: AnyTorque, motion: _Motion) -> float:
        """The integral of a squared torque over the time."""
        return float(np.sum(self.over_cells(torque, motion, lambda *values: values[0] ** 2) * self.times(motion)))

    def over_cells(
        self, torque: AnyTorque, motion: _Motion, of: Callable[..., Array], other: AnyTorque | None = None
    ) -> Array:
        """The means in cells of a function of one torque or two, by Simpson's rule."""
        torques = [torque] if other is None else [torque, other]
        c = self.accelerations(motion)
        ends = [[self._at_end(each, motion, c, end) for each in torques] for end in (slice(None, -1), slice(1, None))]
        middles = [self.middle(each, motion) for each in torques]
        return np.asarray((of(*ends[0]) + 4.0 * of(*middles) + of(*ends[1])) / 6.0)

    def _at_end(self, torque: AnyTorque, motion: _Motion, c: Array, end: slice) -> Array:
        w = motion.w[end]
        several = []
        for form in self.factors(torque):
            inertia, square, drag, load = (factor[end] for factor in form)
            several.append(inertia * c + square * w + drag * np.sqrt(w) + load)
        return np.asarray(np.max(several, axis=0))


class _Sides:
    """The greatest and the least acceleration at nodes within bounds, and motions by them from both ends."""

    def __init__(self, nodes: MotionNodes, bounds: tuple[TorqueLimit, ...]) -> None:
        self.nodes, self.steps, self.rate = nodes, np.diff(nodes.nodes).tolist(), nodes.rate.tolist()
        self.bounds = []
        for bound in bounds:
            within = nodes.within(bound)
            most = np.where(within, bound.at_rest, inf)
            forms = [np.stack([most, np.full_like(most, bound.fall), *form]).T for form in nodes.factors(bound.torque)]
            self.bounds.append([form.tolist() for form in forms])
        count = len(nodes.a)
        self.fastest, self.slowest = np.zeros(count), np.zeros(count)

    def _greatest(self, i: int, w: float) -> float:
        """The greatest acceleration at a node."""
        b, greatest = sqrt(w), inf
        for forms in self.bounds:
            for form in forms:
                most, fall, inertia, square, drag, load = form[i]
                if inertia > 0.0:
                    greatest = min(greatest, (most - load - (fall + drag) * b - square * w) / inertia)
        return greatest

    def _least(self, i: int, w: float) -> float:
        """The least acceleration at a node; behind a gear with losses one of both forms may brake."""
        b, least = sqrt(w), -inf
        for forms in self.bounds:
            either = inf
            for form in forms:
                most, fall, inertia, square, drag, load = form[i]
                by_form = (fall * b - most - load - drag * b - square * w) / inertia if inertia > 0.0 else -inf
                either = min(either, by_form)
            least = max(least, either)
        return least

    def forward(self, cap: Array) -> Array | None:
        """The squared velocities of the fastest motion from the first node; None where it stops."""
        known = self._integrated(cap.tolist(), range(len(cap)), self._greatest, 1.0, self.fastest)
        return None if known is None else np.array(known)

    def backward(self, cap: Array) -> Array | None:
        """Those of the fastest motion that comes to rest at the last node."""
        places = range(len(cap) - 1, -1, -1)
        known = self._integrated(cap.tolist(), places, self._least, -1.0, self.slowest)
        return None if known is None else np.array(known[::-1])

    def _integrated(
        self, cap: list[float], places: range, bound: Callable[[int, float], float], way: float, bounds_at: Array
    ) -> list[float] | None:
        """Squared velocities by Heun's method at nodes one after another, and the accelerations by bounds there."""
        w, values = 0.0, [0.0]
        c = bound(places[0], 0.0)
        bounds_at[places[0]] = c
        for i, j in pairwise(places):
            step = 2.0 * way * self.steps[min(i, j)]
            first = step * c * self.rate[i]
            ahead = bound(j, min(max(w + first, 0.0), cap[j]))
            w += 0.5 * (first + step * ahead * self.rate[j])
            if not w > 0.0 and 0 < j < len(cap) - 1:
                return None
            w = min(max(w, 0.0), cap[j])
            c = bound(j, w)
            bounds_at[j] = c
            values.append(w)
        return values


def value_of(plane: PhasePlane, s: tuple[float, ...], b: tuple[float, ...]) -> float:
    """What is minimised, of a motion in the time 1 that keeps all bounds; infinite where none is found.

    Parameters
    ----------
    plane
        With what is minimised, and the bounds.
    s, b
        Places within (0, 1), and velocities near those of the motion.
    """
    nodes = MotionNodes(plane, s, b)
    with np.errstate(all="ignore"):
        if plane.kind == "time":
            motion = nodes.motion(inf, plane.bounds)
            return nodes.time(motion) if motion is not None and nodes.keeps(motion) else inf
        return _of_peak(nodes) if plane.peak is not None else _of_mean(nodes)


def _of_mean(nodes: MotionNodes) -> float:
    """The least mean of motions by the scaled cap: in the whole time, and at rest for some of it."""
    plane = nodes.plane

    def excess(by: float) -> float:
        motion = nodes.motion(exp(2.0 * by), plane.bounds)
        return inf if motion is None else nodes.time(motion) - 1.0

    known = [nodes.motion(exp(2.0 * by), plane.bounds) for by in (0.0, *_root(excess))]
    return min((_mean(nodes, motion) for motion in known if motion is not None), default=inf)


def _mean(nodes: MotionNodes, motion: _Motion) -> float:
    """The mean of a motion that rests for what is left of the time; infinite where it breaks a bound."""
    plane = nodes.plane
    rest = 1.0 - nodes.time(motion)
    if rest < -INTEGRATION or not nodes.keeps(motion):
        return inf
    total = 0.0
    if plane.squared is not None:
        hold = min(abs(torque) for torque in _holding(plane))
        total += plane.heat * (nodes.square(plane.squared, motion) + max(rest, 0.0) * hold**2)
    for first, second in plane.maxima:
        total += float(np.sum(nodes.over_cells(first, motion, np.maximum, second) * np.diff(nodes.a)))
    return total


def _of_peak(nodes: MotionNodes) -> float:
    """The least peak of a motion in the whole time, or with a rest in it."""
    plane = nodes.plane
    assert plane.peak is not None  # noqa: S101 - it is minimised
    torque = plane.peak
    size = torque.size

    def motion(by: float) -> _Motion | None:
        return nodes.motion(inf, (*plane.bounds, TorqueLimit(torque, size * exp(by))))

    def excess(by: float) -> float:
        known = motion(by)
        return inf if known is None else nodes.time(known) - 1.0

    best = inf
    for by in _root(excess):
        known = motion(by)
        if known is None or not nodes.keeps(known):
            continue
        assert known.c is not None  # noqa: S101 - without a cap there are accelerations
        peak = float(np.max(np.abs(nodes.torque(torque, known.w, known.c))))
        rest = 1.0 - nodes.time(known)
        if rest > INTEGRATION:
            peak = max(peak, min(abs(torque) for torque in _holding(plane)))
        best = min(best, peak) if rest >= -INTEGRATION else best
    return best


def _root(excess: Callable[[float], float]) -> tuple[float, ...]:
    """The logarithm at which a falling excess, perhaps infinite, is not above 0; at most one."""
    high, step = 0.0, 0.5
    while excess(high) > 0.0:
        high, step = high + step, 2.0 * step
        if high > _WIDEST:
            return ()
    low, step = high - 0.5, 0.5
    while excess(low) <= 0.0:
        high, low, step = low, low - step, 2.0 * step
        if low < -_WIDEST:
            return (high,)
    above, below = excess(low), excess(high)
    for _ in range(_STEPS):
        if high - low <= INTEGRATION * 1e-3 or below == 0.0:
            break
        middle = 0.5 * (low + high)
        if isfinite(above):  # by the secant, and a little beyond it
            middle = high - below * (high - low) / (below - above)
            middle = min(max(middle, low + 1e-3 * (high - low)), high - 1e-3 * (high - low))
        value = excess(middle)
        if value > 0.0:
            low, above, below = middle, value, below * 0.5
        else:
            high, below, above = middle, value, above * 0.5
    return (high,)


def _holding(plane: PhasePlane) -> list[float]:
    """The torques that hold the load at both ends."""
    torque, ends = plane.squared or plane.peak, np.array([0.0, 1.0])
    if plane.holding is not None:
        values = np.asarray(evaluate(plane.holding, {"a": ends}, NUMPY), dtype=np.float64)
        return [float(value) for value in np.broadcast_to(values, 2)]
    assert torque is not None  # noqa: S101 - what holds is of a torque
    return [float(value) for value in np.max([branch.values(ends)[3] for branch in torque.branches], axis=0)]
