"""The inner minimum in a phase plane: velocity and acceleration of least Lagrangian at positions, and its prices."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from optlaws.numbers import Array
from optlaws.synthesis.limits.phase_plane import PhasePlane, PhaseTorque, TorqueLimit
from optlaws.synthesis.limits.standing import Standing

_PHASE_TIE = 1e-7  # of a bound or of two torques: nearer values are equal, and the potential says at what price
_INNER_SHARE = 1e-3  # shares of two equal torques that are so far from 0 and 1 follow from the potential

_GOLD = (5.0**0.5 - 1.0) / 2.0
_SEARCH = 48
_AROUND = 2.5  # of the logarithm
_STEEP = 8.0  # of the price of a torque: what a load is priced at most on the side of 0 where it may not be


@dataclass(frozen=True)
class PricedTorque(TorqueLimit):
    """A torque of one form with a price: squared, minimised by its peak, or bounded; on one side with its sign."""

    torque: PhaseTorque
    at_rest: float = inf
    role: Literal["squared", "peak", "bound"] = "bound"


def entries_of(plane: PhasePlane) -> list[PricedTorque]:
    """The torques that have prices, each of one form; the last one is the reference.

    >>> from optlaws.synthesis.limits.phase_plane import ACCELERATION
    >>> [entry.role for entry in entries_of(PhasePlane(squared=ACCELERATION, C=9.0))]
    ['squared', 'bound']
    """
    bounds = [
        PricedTorque(bound.torque.branches[0], bound.at_rest, bound.fall, bound.side, bound.start, bound.stop)
        for bound in plane.bounds
    ]
    entries = [entry for entry in bounds if entry.side != 0]
    entries += [] if plane.squared is None else [PricedTorque(plane.squared.branches[0], role="squared")]
    entries += [] if plane.peak is None else [PricedTorque(plane.peak.branches[0], role="peak")]
    return entries + [entry for entry in bounds if entry.side == 0]


class Prices(NamedTuple):
    """Prices at places: of every entry, and the shares of the first torques of maxima."""

    prices: list[Array]
    shares: list[Array]
    follows: Array  #: the entry, or after these the maximum, whose price follows from q and all others
    beside: Array  #: where a bound of one side is active


class InnerMinimum:
    """The least of Lagrangians over velocity and acceleration, at many positions at once, in doubles.

    The Lagrangian is that of an element of length: what is minimised per b, + weight/b - q' b² - 2 q c. Torques of the
    plane have one form each.
    """

    def __init__(
        self, branch: tuple[Standing, int], weight: float, a: Array, potential: tuple[Array, Array], peak: float
    ) -> None:
        standing, side = branch
        self.plane = plane = standing.branch(side)
        self.q, self.slope = potential
        self.of_mean, self.drag_of_mean, waiting = standing.values(side, a)
        self.weight = weight + waiting  # of the time
        self.entries = [replace(entry, at_rest=peak) if entry.role == "peak" else entry for entry in entries_of(plane)]
        self.most_velocity = plane.velocity_bound(a, a)
        self.outside = {
            entry: np.where((a >= entry.start) & (a <= entry.stop), 0.0, inf)
            for entry in self.entries
            if not entry.everywhere
        }
        self.maxima = [(first.branches[0], second.branches[0]) for first, second in plane.maxima]
        torques = dict.fromkeys([entry.torque for entry in self.entries] + [t for ts in self.maxima for t in ts])
        self.factors = {torque: torque.values(a) for torque in torques}
        self.squared = next((entry.torque for entry in self.entries if entry.role == "squared"), None)
        with np.errstate(all="ignore"):
            self.steep = 2.0 * _STEEP * np.abs(self.q) / self.factors[self.entries[-1].torque][0]

    def velocity(self, near: Array) -> Array:
        """The velocities of least Lagrangian around given ones, by golden sections of their logarithms."""
        B = self.most_velocity
        start = np.log(np.minimum(near, B))
        low, high = start - _AROUND, np.minimum(start + _AROUND, np.log(B))
        inner = [high - _GOLD * (high - low), low + _GOLD * (high - low)]
        values = [self._value(np.exp(x)) for x in inner]
        for _ in range(_SEARCH):
            left = values[0] < values[1]
            low, high = np.where(left, low, inner[0]), np.where(left, inner[1], high)
            first = np.where(left, high - _GOLD * (high - low), inner[1])
            second = np.where(left, inner[0], low + _GOLD * (high - low))
            known = np.where(left, values[0], values[1])
            new = self._value(np.exp(np.where(left, first, second)))
            inner, values = [first, second], [np.where(left, new, known), np.where(left, known, new)]
        best = np.exp(0.5 * (low + high))
        if np.isinf(B).all():
            return best
        at_bound = np.where(np.isfinite(B), B, best)
        return np.where(self._value(best) <= self._value(at_bound), best, at_bound)

    def _most(self, entry: PricedTorque, b: Array) -> Array:
        """The bound of a torque at velocities, infinite outside its window."""
        return np.asarray(entry.at_rest - entry.fall * b + self.outside.get(entry, 0.0))

    def prices(self, b: Array) -> Prices:
        """The prices of all torques at velocities, and the shares of the first torque in every maximum."""
        c, _ = self._acceleration(b)
        last = len(self.entries) - 1
        rest, prices = 2.0 * self.q, [np.zeros_like(b)] * len(self.entries)
        first = next(i for i, entry in enumerate(self.entries) if entry.side == 0)
        follows = np.full(b.shape, first if self.entries[first].role in {"squared", "peak"} else last)
        if self.squared is not None:
            prices[first] = 2.0 * self.plane.heat * self._torque(self.squared, b, c) / b
            rest = rest - prices[first] * self.factors[self.squared][0]
        shares, follows, rest = self._shares(b, c, follows, rest)
        beside = np.zeros(b.shape, dtype=bool)
        for i, entry in enumerate(self.entries):
            if entry.side:
                over = self._beyond(entry, b, c) / entry.torque.size
                beside |= over >= -_PHASE_TIE
                prices[i] = np.where(over > _PHASE_TIE, entry.side * self.steep, 0.0)
                rest = rest - prices[i] * self.factors[entry.torque][0]
        open_ones = follows < len(self.entries)  # where no share follows
        for i, entry in sorted(enumerate(self.entries), key=lambda pair: pair[1].side != 0):
            if entry.role == "squared":
                continue
            active = open_ones & self._is_active(entry, b, c)
            with np.errstate(all="ignore"):
                price = np.where(active, rest / self.factors[entry.torque][0], 0.0)
            price = np.where(np.isfinite(price), price, 0.0)
            side = entry.side * np.clip(entry.side * price, 0.0, self.steep)
            prices[i] = price if entry.side == 0 else np.where(active, side, prices[i])
            follows, open_ones = np.where(active, i, follows), open_ones & ~active
        return Prices(prices, shares, follows, beside)

    def _shares(self, b: Array, c: Array, follows: Array, rest: Array) -> tuple[list[Array], Array, Array]:
        """The shares of first torques in maxima, the values that follow from q, and the sum of the remaining prices."""
        shares = []
        for i, (torque, other) in enumerate(self.maxima, len(self.entries)):
            more = self._torque(torque, b, c) - self._torque(other, b, c)
            tie = np.abs(more) <= _PHASE_TIE * (1.0 + np.abs(self._torque(torque, b, c)))
            inertia, second = self.factors[torque][0], self.factors[other][0]
            with np.errstate(all="ignore"):
                share = np.clip((rest - second) / (inertia - second), 0.0, 1.0)
            share = np.where(tie & np.isfinite(share), share, more > 0.0)
            shares.append(share)
            rest = rest - share * inertia - (1.0 - share) * second
            within = (share > _INNER_SHARE) & (share < 1.0 - _INNER_SHARE) & (self.squared is None)
            follows = np.where(within, i, follows)
        return shares, follows, rest

    def _is_active(self, entry: PricedTorque, b: Array, c: Array) -> NDArray[np.bool_]:
        if entry.side:
            return np.asarray(np.abs(self._beyond(entry, b, c)) <= _PHASE_TIE * entry.torque.size)
        return np.asarray(np.abs(self._torque(entry.torque, b, c)) >= self._most(entry, b) * (1.0 - _PHASE_TIE))

    def _beyond(self, entry: PricedTorque, b: Array, c: Array) -> Array:
        """The excess of a torque over its bound on one side."""
        return np.asarray(entry.side * self._torque(entry.torque, b, c) - entry.at_rest + entry.fall * b)

    def _torque(self, torque: PhaseTorque, b: Array, c: Array) -> Array:
        inertia, square, drag, load = self.factors[torque]
        return np.asarray(inertia * c + (square * b + drag) * b + load)

    def _value(self, b: Array) -> Array:
        """The least Lagrangian at velocities; infinite where no acceleration is within the bounds."""
        _, value = self._acceleration(b)
        return value + self.weight / b + self.of_mean + (self.drag_of_mean - self.slope * b) * b

    def _acceleration(self, b: Array) -> tuple[Array, Array]:
        """The accelerations of least Lagrangian at velocities, and its parts that depend on them."""
        low, high = np.full_like(b, -inf), np.full_like(b, inf)
        with np.errstate(all="ignore"):
            for entry in self.entries:
                if entry.role == "squared" or entry.side:
                    continue
                inertia, square, drag, load = self.factors[entry.torque]
                free, most = (square * b + drag) * b + load, self._most(entry, b)
                low = np.fmax(low, (-most - free) / inertia)
                high = np.fmin(high, (most - free) / inertia)
        candidates = self._candidates(b, low, high)
        values = [self._cost(b, c) for c in candidates]
        best = np.nanargmin(np.where(np.isfinite(values), values, inf), axis=0)
        here = np.arange(len(b))
        c, value = np.array(candidates)[best, here], np.array(values)[best, here]
        return c, np.where(low <= high, np.where(np.isfinite(value), value, inf), inf)

    def _candidates(self, b: Array, low: Array, high: Array) -> list[Array]:
        """Accelerations among which the best is: at bounds, where torques of a maximum meet, and where it is flat."""
        nothing = np.zeros_like(b)
        lines: list[tuple[Array, Array]] = [(nothing, nothing)]  # slopes and values at c = 0 of sums of torques
        candidates = [low, high]
        with np.errstate(all="ignore"):
            candidates += [self._at_side(entry, b) for entry in self.entries if entry.side]
            for torques in self.maxima:
                here = [(self.factors[t][0], self._torque(t, b, nothing)) for t in torques]
                for i, (slope, value) in enumerate(here):
                    candidates += [(value - other) / (steeper - slope) for steeper, other in here[i + 1 :]]
                lines = [(slope + more, value + other) for slope, value in lines for more, other in here]
            if self.squared is not None:
                inertia, free = self.factors[self.squared][0], self._torque(self.squared, b, nothing)
                pace = b / (self.plane.heat * inertia)
                candidates += [((self.q - 0.5 * slope) * pace - free) / inertia for slope, _ in lines]
        clipped = [np.fmin(np.fmax(candidate, low), high) for candidate in candidates]
        return [np.where(np.isfinite(c), c, 0.0) for c in clipped]

    def _at_side(self, entry: PricedTorque, b: Array) -> Array:
        """The acceleration at which a bound of one side is active."""
        inertia, square, drag, load = self.factors[entry.torque]
        return np.asarray((entry.side * (entry.at_rest - entry.fall * b) - (square * b + drag) * b - load) / inertia)

    def _cost(self, b: Array, c: Array) -> Array:
        total = -2.0 * self.q * c
        if self.squared is not None:
            total = total + self.plane.heat * self._torque(self.squared, b, c) ** 2 / b
        for torques in self.maxima:
            total = total + np.max([self._torque(torque, b, c) for torque in torques], axis=0)
        for entry in self.entries:
            if entry.side:  # a load beyond it has the highest price
                total = total + self.steep * np.maximum(self._beyond(entry, b, c), 0.0)
        return np.asarray(total)
