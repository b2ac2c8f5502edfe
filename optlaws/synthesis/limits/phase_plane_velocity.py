"""The inner minimum in a phase plane: velocity and acceleration of least Lagrangian at positions, and its prices."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf
from typing import Literal, NamedTuple

import numpy as np

from optlaws.numbers import Array
from optlaws.synthesis.limits.phase_plane import PhasePlane, PhaseTorque
from optlaws.tolerances import INNER_SHARE, PHASE_TIE

_GOLD = (5.0**0.5 - 1.0) / 2.0
_SEARCH = 48
_AROUND = 2.5  # of the logarithm


@dataclass(frozen=True)
class PricedTorque:
    """A torque that has a price: squared, minimised by its peak, or bounded by at_rest - fall * b."""

    torque: PhaseTorque
    role: Literal["squared", "peak", "bound"]
    at_rest: float = inf
    fall: float = 0.0


def entries_of(plane: PhasePlane) -> list[PricedTorque]:
    """The torques that have prices; the last one is the plane's reference.

    >>> from optlaws.synthesis.limits.phase_plane import ACCELERATION
    >>> [entry.role for entry in entries_of(PhasePlane(squared=ACCELERATION, C=9.0))]
    ['squared', 'bound']
    """
    entries = [PricedTorque(plane.squared, "squared")] if plane.squared is not None else []
    entries += [PricedTorque(plane.peak, "peak")] if plane.peak is not None else []
    return entries + [PricedTorque(bound.torque, "bound", bound.at_rest, bound.fall) for bound in plane.bounds]


class Prices(NamedTuple):
    """Prices at places: of every entry, and the shares of the first torques of maxima."""

    prices: list[Array]
    shares: list[Array]
    follows: Array  #: the entry, or after these the maximum, whose price follows from q and all others


class InnerMinimum:
    """The least of Lagrangians over velocity and acceleration, at many positions at once, in doubles.

    The Lagrangian is that of an element of length: what is minimised per b, + weight/b - q' b² - 2 q c.
    """

    def __init__(self, plane: PhasePlane, weight: float, a: Array, potential: tuple[Array, Array], peak: float) -> None:
        self.plane, self.weight, (self.q, self.slope) = plane, weight, potential
        self.entries = [
            PricedTorque(entry.torque, entry.role, peak) if entry.role == "peak" else entry
            for entry in entries_of(plane)
        ]
        torques = dict.fromkeys([entry.torque for entry in self.entries] + [t for ts in plane.maxima for t in ts])
        self.factors = {torque: torque.values(a) for torque in torques}

    def velocity(self, near: Array) -> Array:
        """The velocities of least Lagrangian around given ones, by golden sections of their logarithms."""
        B = self.plane.greatest_velocity
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
        if inf == B:
            return best
        at_bound = np.full_like(best, B)
        return np.where(self._value(best) <= self._value(at_bound), best, at_bound)

    def prices(self, b: Array) -> Prices:
        """The prices of all torques at velocities, and the shares of the first torque in every maximum."""
        c, _ = self._acceleration(b)
        nothing, last = np.zeros_like(b), len(self.entries) - 1
        rest, prices = 2.0 * self.q, list[Array]()
        follows = np.full(b.shape, 0 if self.entries[0].role in {"squared", "peak"} else last)
        if self.plane.squared is not None:
            price = 2.0 * self.plane.heat * self._torque(self.plane.squared, b, c) / b
            rest = rest - price * self.factors[self.plane.squared][0]
            prices.append(price)
        shares = []
        for i, (first, second) in enumerate(self.plane.maxima, len(self.entries)):
            more = self._torque(first, b, c) - self._torque(second, b, c)
            tie = np.abs(more) <= PHASE_TIE * (1.0 + np.abs(self._torque(first, b, c)))
            inertia, other = self.factors[first][0], self.factors[second][0]
            with np.errstate(all="ignore"):
                share = np.clip((rest - other) / (inertia - other), 0.0, 1.0)
            share = np.where(tie & np.isfinite(share), share, more > 0.0)
            shares.append(share)
            rest = rest - share * inertia - (1.0 - share) * other
            within = (share > INNER_SHARE) & (share < 1.0 - INNER_SHARE) & (self.plane.squared is None)
            follows = np.where(within, i, follows)
        open_ones = np.ones(b.shape, dtype=bool)
        for i, entry in enumerate(self.entries[len(prices) :], len(prices)):
            size = np.abs(self._torque(entry.torque, b, c))
            active = open_ones & (size >= (entry.at_rest - entry.fall * b) * (1.0 - PHASE_TIE))
            with np.errstate(all="ignore"):
                price = np.where(active, rest / self.factors[entry.torque][0], nothing)
            prices.append(np.where(np.isfinite(price), price, nothing))
            follows, open_ones = np.where(active, i, follows), open_ones & ~active
        return Prices(prices, shares, follows)

    def _torque(self, torque: PhaseTorque, b: Array, c: Array) -> Array:
        inertia, square, drag, load = self.factors[torque]
        return np.asarray(inertia * c + (square * b + drag) * b + load)

    def _value(self, b: Array) -> Array:
        """The least Lagrangian at velocities; infinite where no acceleration is within the bounds."""
        _, value = self._acceleration(b)
        return value + self.weight / b - self.slope * b * b

    def _acceleration(self, b: Array) -> tuple[Array, Array]:
        """The accelerations of least Lagrangian at velocities, and its parts that depend on them."""
        low, high = np.full_like(b, -inf), np.full_like(b, inf)
        with np.errstate(all="ignore"):
            for entry in self.entries:
                if entry.role == "squared":
                    continue
                inertia, square, drag, load = self.factors[entry.torque]
                free, most = (square * b + drag) * b + load, entry.at_rest - entry.fall * b
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
            for torques in self.plane.maxima:
                here = [(self.factors[t][0], self._torque(t, b, nothing)) for t in torques]
                for i, (slope, value) in enumerate(here):
                    candidates += [(value - other) / (steeper - slope) for steeper, other in here[i + 1 :]]
                lines = [(slope + more, value + other) for slope, value in lines for more, other in here]
            if self.plane.squared is not None:
                inertia, free = self.factors[self.plane.squared][0], self._torque(self.plane.squared, b, nothing)
                pace = b / (self.plane.heat * inertia)
                candidates += [((self.q - 0.5 * slope) * pace - free) / inertia for slope, _ in lines]
        clipped = [np.fmin(np.fmax(candidate, low), high) for candidate in candidates]
        return [np.where(np.isfinite(c), c, 0.0) for c in clipped]

    def _cost(self, b: Array, c: Array) -> Array:
        total = -2.0 * self.q * c
        if self.plane.squared is not None:
            total = total + self.plane.heat * self._torque(self.plane.squared, b, c) ** 2 / b
        for torques in self.plane.maxima:
            total = total + np.max([self._torque(torque, b, c) for torque in torques], axis=0)
        return np.asarray(total)
