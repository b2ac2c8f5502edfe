"""Cells of the move in which the inner minimum of a phase plane is enclosed, with every rounding counted.

In a cell of s prices are affine but for one, which follows from q; with b = scale * x the integrand is f(x) = A + B1 x
+ C2 x² + L/x. With K = L/z², E = B1 + 2 C2 z - K, it is f(z) + (x - z)² (C2 + K/x) + E (x - z) for any z. An affine z
near the minimum leaves f(z), whose integral is enclosed by Taylor's formula, and what E can still lower.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import reduce
from itertools import pairwise
from math import comb, inf, nextafter, pi, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from optlaws.formulas.arithmetic import horner
from optlaws.formulas.jets import formula_jet
from optlaws.numbers import Array
from optlaws.numerics.interval import Interval, between, chosen, exact
from optlaws.numerics.taylor import Jet, variable
from optlaws.synthesis.limits.phase_plane import GearTorque, PhasePlane, PhaseTorque
from optlaws.synthesis.limits.phase_plane_velocity import InnerMinimum, entries_of
from optlaws.synthesis.limits.standing import Standing
from optlaws.tolerances import ROUNDOFF, SMALLEST_SIZE

_AFFINE_SLACK = 1e-12  # of a price: keeps affine shares within 0 and 1 and magnitudes below their lines after rounding
_STATIONARY_SLACK = 1e-10  # of a velocity: beyond the flat place of a function without a bound it only rises
_WEAK_CELL = 5e-7  # of what a cell adds to a bound: a cell that may lose more is divided
_SHORT_CELL = 1e-3  # of the move: of shorter cells what is lost is measured by this length

_ORDER = 4  # of the remainder in a cell
_FAR = 4.0
_NEWTON = 12
_END, _INSIDE, _NEAR_B = 0.12, 0.02, 0.9
PI = Interval(np.array(pi), np.array(ROUNDOFF * pi))


@dataclass(frozen=True, eq=False)
class Potential:
    """A piecewise polynomial pi(s) that stands for q(a) = J(a) pi(s)/sin(pi s) where a = sin²(pi s/2).

    J is the inertia of the plane's reference, behind a gear with losses that of its first branch.

    Attributes
    ----------
    edges
        The ends of its pieces, from 0 to 1.
    coefficients
        Bernstein coefficients, one row a piece; neighbours share those at their ends, but where it jumps.
    """

    edges: Array
    coefficients: Array

    def jet(self, piece: NDArray[np.intp], s: Interval, order: int) -> Jet:
        """The jet of pi(s) by s at one place, or over one cell, of each given piece."""
        start, length = exact(self.edges[piece]), exact(self.edges[piece + 1]) - self.edges[piece]
        degree = self.coefficients.shape[1] - 1
        x = variable((exact(s.middle) - start) * (1.0 / length), degree)
        x = Jet((x.terms[0], 1.0 / length, *x.terms[2:]))
        rows = [(x * 0.0) + row for row in self.coefficients[piece].T]
        while len(rows) > 1:  # de Casteljau
            rows = [left + (right - left) * x for left, right in pairwise(rows)]
        around = Interval(np.zeros(len(piece)), s.radius)
        terms = [
            horner([comb(j, i) * rows[0].terms[j] for j in range(i, degree + 1)], around)
            for i in range(order + 1)
            if i <= degree
        ]
        return Jet((*terms, *(0.0 * terms[0] for _ in range(order - degree))))

    def to_data(self) -> tuple[tuple[float, ...], tuple[tuple[float, ...], ...]]:
        """The ends and the rows of coefficients."""
        return tuple(self.edges.tolist()), tuple(map(tuple, self.coefficients.tolist()))

    def steeper(self, by: float) -> Potential:
        """The potential with a little more fall: by (1 - 2 s) more, divided by sin(pi s)."""
        degree = self.coefficients.shape[1] - 1
        s = self.edges[:-1, None] + np.diff(self.edges)[:, None] * np.arange(degree + 1) / degree
        more = 1.0 - 2.0 * s
        more[1:, 0] = more[:-1, -1]
        return Potential(self.edges, self.coefficients + by * more)


class Guess(NamedTuple):
    """Starting values for inner minima; a bad guess weakens the bound, and proves nothing false."""

    s: Array  #: places within (0, 1), ascending
    b: Array  #: velocities there
    peak: float  #: about the peak that is minimised


class _Terms(NamedTuple):
    """Terms of the integrand as jets in s."""

    s: Jet
    sine: Jet
    scale: Jet  #: of the velocity: b = scale * x
    share: Jet  #: sine over scale
    inverse: Jet  #: scale over sine
    torques: dict[PhaseTorque, tuple[Jet, Jet, Jet, Jet]]
    double: Jet  #: 2 q, times scale
    rate: Jet  #: what multiplies x² of -q' b²
    mean: tuple[Jet, Jet, Jet] | None  #: of the mean torque: factors of 1, x and 1/x


class _Prices(NamedTuple):
    """Prices in every cell, as jets in s."""

    of_entries: list[Jet]  #: times scale
    shares: list[tuple[Jet, PhaseTorque]]  #: of the torques of maxima


class _Integrand(NamedTuple):
    """The factors of 1, x, x² and 1/x, and the price of the peak torque."""

    A: Jet
    B1: Jet
    C2: Jet
    L: Jet
    price: Jet


class CellBounds(NamedTuple):
    """Bounds of the inner minimum in every cell, for a guessed value of a minimised peak."""

    mean: Array  #: what the mean is at least, by a function that the minimum is nowhere below
    floor: Array  #: what it is at least everywhere
    below: tuple[Jet, Jet]  #: that function and the loss above it, in the middles of cells and over cells
    loss: Array
    free: Array  #: what it is at least everywhere without the price of a peak
    size: Array  #: of the numbers whose sum it is
    weak: Array  #: by how much more may be lost than is little; above 0 in weak cells
    shared: NDArray[np.bool_]  #: where it is proven of the other direction of the power too

    @property
    def least(self) -> Array:
        """A lower bound of the mean."""
        return np.fmax(self.mean, self.floor)

    def only(self, cells: NDArray[np.bool_]) -> CellBounds:
        """The bounds in some of the cells."""
        jets = (Jet(tuple(term[cells] for term in jet.terms)) for jet in self.below)
        known = {name: getattr(self, name)[cells] for name in self._fields if name != "below"}
        return self._replace(below=(next(jets), next(jets)), **known)

    def where(self, cells: NDArray[np.bool_], other: CellBounds) -> CellBounds:
        """The bounds of this in some cells, and other bounds in all others."""
        jets = [
            Jet(tuple(chosen(cells, left, right) for left, right in zip(first.terms, second.terms, strict=True)))
            for first, second in zip(self.below, other.below, strict=True)
        ]
        arrays = {
            name: np.where(cells, getattr(self, name), getattr(other, name)) for name in self._fields if name != "below"
        }
        return self._replace(below=(jets[0], jets[1]), **arrays)


class ProofCells:
    """Cells of s, each within a piece of the potential, with affine prices of all torques but one.

    They are those of one direction of the power: torques have one form each.
    """

    def __init__(self, standing: Standing, side: int, potential: Potential, weight: float, guess: Guess) -> None:
        plane, self.standing, self.side = standing.plane, standing, side
        self.plane, self.potential, self.weight, self.guess = standing.branch(side), potential, weight, guess
        self.inertia = plane.reference
        self.entries = entries_of(self.plane)
        self.maxima = [(first.branches[0], second.branches[0]) for first, second in self.plane.maxima]
        self.spreads = _spreads(plane, side) if standing.same else []
        self.peak = guess.peak if plane.kind == "peak" else 0.0
        self.reach: tuple[float, ...] | None = None

    def take(self, piece: NDArray[np.intp], low: Array, high: Array) -> None:
        """The cells that a mask selects."""
        self.piece, self.low, self.high = piece, low, high
        self.middle = 0.5 * (low + high)
        self.half = 0.5 * (high - low) * (1.0 + 8.0 * ROUNDOFF)
        self._choose(self.guess)
        self.at, self.over = self._terms(exact(self.middle), _ORDER - 2), self._terms(between(low, high), _ORDER)

    def _choose(self, guess: Guess) -> None:
        """The velocities at the ends of cells near which the inner minimum is, and the prices of torques there."""
        inside = _INSIDE * (self.high - self.low)
        s = np.stack([self.low + inside, self.high - inside]).ravel()
        value, slope = (term.middle for term in self.potential.jet(np.tile(self.piece, 2), exact(s), 1).terms)
        sine, a = np.sin(np.pi * s), np.sin(np.pi * s / 2.0) ** 2
        inertia, by_a = self.inertia.values(a)[0], self.inertia.inertia_slope(a)
        by_s = slope / sine - np.pi * np.cos(np.pi * s) * value / sine**2
        q_slope = by_a * value / sine + inertia * by_s / (np.pi / 2.0 * sine)
        branch = self.standing, self.side
        inner = InnerMinimum(branch, self.weight, a, (inertia * value / sine, q_slope), guess.peak)
        b = inner.velocity(np.interp(s, guess.s, guess.b / np.sin(np.pi * guess.s)) * sine)
        shape = (2, len(self.middle))
        known = inner.prices(b)
        distance = np.minimum(self.middle, 1.0 - self.middle)
        near = (b.reshape(shape) >= _NEAR_B * self.plane.velocity_bound(a, a).reshape(shape)).any(axis=0)
        sides = self.middle < 0.5, self.middle >= 0.5
        if self.reach is None:  # up to where the bound of b may count, and at least the first cell and the last
            self.reach = tuple(
                max(float(np.min(distance[side & near], initial=_END)), 1.5 * float(distance[side].min()))
                for side in sides
            )
        self.end = np.logical_or(*(side & (distance < most) for side, most in zip(sides, self.reach, strict=True)))
        self.most = np.where(self.end, self._most_at_ends(), self.plane.velocity_bound(*self._positions()))
        scale = np.where(self.end, sine.reshape(shape), 1.0)
        self.x = np.minimum(_to_ends(b.reshape(shape) / scale), self.most)
        self.prices = [
            _of_side(_to_ends(price.reshape(shape) * scale), entry.side)
            for price, entry in zip(known.prices, self.entries, strict=True)
        ]
        shares = (_to_ends(share.reshape(shape)) for share in known.shares)
        self.shares = [np.clip(share, _AFFINE_SLACK, 1.0 - _AFFINE_SLACK) for share in shares]
        self.follows, self.beside = known.follows.reshape(shape), known.beside.reshape(shape).any(axis=0)
        # in a cell the price follows from q that does so at both ends, else that of the reference
        last = len(self.entries) - 1
        self._keep_to_windows()
        self.mixed = self.follows[0] != self.follows[1]
        self.follows = np.where(self.mixed, last, self.follows[0])

    def _most_at_ends(self) -> Array:
        """The greatest velocity within the acceleration's bound, over sin(pi s), in cells near rest."""
        if inf == self.plane.C:
            return np.full(len(self.low), inf)
        far = exact(np.minimum(self.high, 1.0 - self.low))
        # b² <= 2 C sin²(pi s/2), also with the distance from the last end
        steepest = nextafter(sqrt(0.5 * self.plane.C), inf)
        return np.asarray((exact(np.full(len(self.low), steepest)) / (far * PI * 0.5).cosine()).high)

    def _positions(self) -> tuple[Array, Array]:
        """The least and the greatest position in every cell, rounded outward."""
        return positions(exact(self.low))[0], positions(exact(self.high))[1]

    def _keep_to_windows(self) -> None:
        """Bounds over a part of the stroke have no price in cells that are not wholly in it."""
        last, (low, high) = len(self.entries) - 1, self._positions()
        for i, entry in enumerate(self.entries):
            if not entry.everywhere:
                inside = (low >= entry.start) & (high <= entry.stop)
                self.prices[i] = np.where(inside, self.prices[i], 0.0)
                self.follows = np.where((self.follows == i) & ~inside, last, self.follows)

    def bounds(self) -> CellBounds:
        """Bounds of the inner minimum in every cell."""
        known, last = self._in_cells(), len(self.entries) - 1
        squared = [i for i, entry in enumerate(self.entries) if entry.role == "squared" and len(self.plane.limits) > 1]
        for i in dict.fromkeys([*squared, last]):
            unknown = ~np.isfinite(known.least)
            if unknown.any():
                self.follows = np.where(unknown, i, self.follows)
                again = self._in_cells()
                weak = np.minimum(known.weak, again.weak)
                known = again.where(again.least > known.least, known)._replace(weak=weak)
        return known

    def _paid(self, terms: _Terms, prices: _Prices) -> Array:
        """The cost of the reference in the middles of cells, if it is bounded."""
        entry = self.entries[-1]
        if entry.role != "bound":
            return np.zeros_like(self.half)
        price = prices.of_entries[-1].terms[0].middle * terms.share.terms[0].middle
        return np.asarray(price * entry.at_rest)

    def weakness(self, lost: Array, size: Array) -> Array:
        """The loss in cells beyond what is negligible."""
        more = lost - _WEAK_CELL * size * np.maximum(self.half, _SHORT_CELL)
        return np.where(np.isnan(more), inf, more)

    def _in_cells(self) -> CellBounds:
        prices, prices_around = self._prices(self.at), self._prices(self.over)
        lines = self._lines_above(prices.of_entries, prices_around.of_entries)
        here, around = self._integrand(self.at, prices, lines), self._integrand(self.over, prices_around, lines)
        z, z_around = self._affine(self.x, self.at.s), self._affine(self.x, self.over.s)
        along = [f.A + f.B1 * x + f.C2 * x * x + f.L / x for f, x in ((here, z), (around, z_around))]
        ranges = [self.range(*pair) for pair in zip(here[:4], around[:4], strict=True)]
        mean, price = self.mean(*along), self.mean(here.price, around.price)
        loss = self._loss(here, around, z, z_around, ranges)
        size = np.abs(mean.middle) + self.peak * np.abs(price.middle)
        with np.errstate(invalid="ignore"):
            least = (mean - loss).low
            paid = np.where(self.mixed, np.abs(self._paid(self.at, prices)), 0.0)
            weak = self.weakness((loss + mean.radius + paid) * self.half, size)
        known = self._within(prices, prices_around) & np.isfinite(price.high)
        free = self.peak * np.maximum(self.range(here.price, around.price).low, 0.0)
        least = np.where(np.isfinite(least) & known, least, -inf)
        floor = np.where(known, _least([v.low for v in ranges], self.x, self.most), -inf)
        weak = np.where(known & np.isfinite(np.fmax(least, floor)), weak, inf)
        shared = self._shared(prices, prices_around)
        loss = np.where(known, loss, inf)
        return CellBounds(least, floor, (along[0], along[1]), loss, floor + free, size, weak, shared)

    def mean(self, at: Jet, over: Jet) -> Interval:
        """The mean of a function over every cell, of its jet in the middle and that over the cell."""
        square = exact(self.half) * self.half
        rest = Interval(np.zeros(len(self.half)), _greatest(over.terms[_ORDER]) / (_ORDER + 1))
        mean: Interval = at.terms[0] + at.terms[2] * square * (1.0 / 3.0) + rest * square * square
        return mean

    def range(self, at: Jet, over: Jet) -> Interval:
        """The range of a function in every cell."""
        moved = exact(_greatest(at.terms[1])) * self.half
        bent = exact(_greatest(over.terms[2])) * self.half * self.half
        around: Interval = at.terms[0] + Interval(np.zeros(len(self.half)), moved.high + bent.high)
        return around

    def _loss(self, at: _Integrand, over: _Integrand, z: Jet, z_over: Jet, ranges: list[Interval]) -> Array:
        """The greatest difference of the inner minimum from its value at z; infinite if it is not known."""
        first, second = (f.B1 + f.C2 * x * 2.0 - f.L / (x * x) for f, x in ((at, z), (over, z_over)))
        K = self.range(at.L / (z * z), over.L / (z_over * z_over))
        E, C2, far = self.range(first, second), ranges[2], np.minimum(_FAR * z_over.terms[0].high, self.most)
        with np.errstate(all="ignore"):
            steep, beyond = ((C2 + np.where(np.isfinite(x), (K / exact(x)).low, 0.0)).low for x in (far, self.most))
            above = np.where((self.x == self.most).all(axis=0), np.maximum(E.high, 0.0), _greatest(E))
            # beyond far (x - z)/x is at least 3/4, and x - z at least 3 z
            safe = (C2.low >= 0.0) | (far >= self.most) | (3.0 * z_over.terms[0].low * beyond >= above)
            known = (steep > 0.0) & (beyond >= 0.0) & (K.low > 0.0) & (above <= 0.75 * K.low) & safe
            loss = above**2 / (4.0 * steep) * (1.0 + 8.0 * ROUNDOFF)
        return np.where((above == 0.0) & (beyond >= 0.0) & (K.low > 0.0), 0.0, np.where(known, loss, inf))

    def _terms(self, places: Interval, order: int) -> _Terms:
        """Terms of the integrand up to an order."""
        s = variable(places, order + 1)
        sine, cosine = (s * PI).waves()
        a = (1.0 - cosine) * 0.5
        unity = s * 0.0 + 1.0
        scale, share = self._chosen(self.end, sine, unity), self._chosen(self.end, unity, sine)
        inverse = 1.0 / share
        torques = [entry.torque for entry in self.entries] + [torque for pair in self.maxima for torque in pair]
        jets = {torque: torque.jets(a.cut(order)) for torque in dict.fromkeys(torques)}
        potential = self.potential.jet(self.piece, places, order + 1)
        potential = potential * formula_jet(self.inertia.inertia, "a", a)
        turned = (inverse * inverse * potential * cosine).cut(order) * PI
        rate = (turned - scale.cut(order) * inverse.cut(order) * potential.slope()) * (2.0 / PI)
        sine, scale, share, inverse = (jet.cut(order) for jet in (sine, scale, share, inverse))
        mean = self._mean_torque(a, sine, scale)
        return _Terms(s.cut(order), sine, scale, share, inverse, jets, potential.cut(order) * inverse * 2.0, rate, mean)

    def _mean_torque(self, a: Jet, sine: Jet, scale: Jet) -> tuple[Jet, Jet, Jet] | None:
        """The factors of the mean torque, from jets of which that of a has one order more."""
        if self.standing.torque is None:
            return None
        at = a.cut(sine.order)
        terms = self.standing.terms(self.side, lambda formula: formula_jet(formula, "a", at))
        steep = formula_jet(terms.inertia, "a", a).slope() * (terms.slope * 2.0 / PI)
        return terms.A * sine, (terms.B1 * sine - steep) * scale, terms.L

    def _affine(self, ends: Array, s: Jet) -> Jet:
        """The affine function in every cell with given values near its ends."""
        with np.errstate(invalid="ignore"):  # prices without end, where an inertia vanishes: nothing is proven by them
            rise, width = ends[1] - ends[0], self.high - self.low
        # of a cell that is cut to nothing the value at its end is all
        slope = np.divide(rise, width, where=width > 0.0, out=np.zeros(np.broadcast_shapes(rise.shape, width.shape)))
        line: Jet = (s - exact(self.low)) * slope + ends[0]
        return line

    def _prices(self, terms: _Terms) -> _Prices:
        """The prices of all entries, times scale, and the torques of maxima with their shares, in every cell."""
        prices = [self._affine(price, terms.s) for price in self.prices]
        shares = [self._affine(share, terms.s) for share in self.shares]
        rest = terms.double
        for i, (price, entry) in enumerate(zip(prices, self.entries, strict=True)):
            rest = rest - self._where(self.follows != i, price) * terms.torques[entry.torque][0]
        for i, (share, (first, second)) in enumerate(zip(shares, self.maxima, strict=True), len(prices)):
            others = terms.torques[first][0] - terms.torques[second][0]
            known = self._where(self.follows != i, share)
            rest = rest - (terms.torques[second][0] + known * others) * terms.scale
        for i, entry in enumerate(self.entries):
            if (self.follows == i).any():
                prices[i] = self._chosen(self.follows == i, self._ratio(rest, terms, entry.torque), prices[i])
        for i, (first, second) in enumerate(self.maxima, len(prices)):
            if (self.follows == i).any():
                others = (terms.torques[first][0] - terms.torques[second][0]) * terms.scale
                shares[i - len(prices)] = self._chosen(self.follows == i, rest / others, shares[i - len(prices)])
        shared = []
        for share, (first, second) in zip(shares, self.maxima, strict=True):
            shared += [(share, first), (1.0 - share, second)]
        return _Prices(prices, shared)

    def _ratio(self, rest: Jet, terms: _Terms, torque: PhaseTorque) -> Jet:
        """The remainder of 2 q over an inertia; without a division if nothing else has a price."""
        if len(self.entries) == 1 and not self.maxima:
            return self.potential.jet(self.piece, terms.s.terms[0], terms.s.order) * terms.inverse * 2.0
        return rest / terms.torques[torque][0]

    def _where(self, mask: Array, jet: Jet) -> Jet:
        return self._chosen(mask, jet, jet * 0.0)

    def _chosen(self, mask: Array, first: Jet, second: Jet) -> Jet:
        return Jet(tuple(chosen(mask, p, q) for p, q in zip(first.terms, second.terms, strict=True)))

    def _lines_above(self, prices: list[Jet], around: list[Jet]) -> list[tuple[Array, Array]]:
        """The sign of every entry's price, 0 where it is not sure, and ends of a line that is above its magnitude."""
        lines = []
        for price, over_cell in zip(prices, around, strict=True):
            ends, bend = self._ends(price, over_cell)
            above = np.stack([_greatest(end) + bend for end in ends]) * (1.0 + _AFFINE_SLACK)
            low, high = (np.array([getattr(end, side) for end in ends]) for side in ("low", "high"))
            sign = np.where((low > bend).all(axis=0), 1.0, np.where((high < -bend).all(axis=0), -1.0, 0.0))
            lines.append((sign, above))
        return lines

    def _within(self, prices: _Prices, around: _Prices) -> NDArray[np.bool_]:
        """A mask of cells in which all shares of maxima are certainly from 0 to 1."""
        within = np.ones(len(self.half), dtype=bool)
        for (share, _), (over_cell, _) in zip(prices.shares, around.shares, strict=True):
            ends, bend = self._ends(share, over_cell)
            within &= np.all([(end.low >= bend) & (end.high <= 1.0 - bend) for end in ends], axis=0)
        for i, entry in enumerate(self.entries):
            if entry.side:  # a price that is affine has its sign at both ends
                within &= (self.follows != i) | self._positive(prices.of_entries[i], around.of_entries[i], entry.side)
        return within

    def _positive(self, at: Jet, over: Jet, sign: float = 1.0) -> NDArray[np.bool_]:
        """A mask of cells in which a function times a sign is certainly at least 0."""
        ends, bend = self._ends(at * sign, over * sign)
        return np.asarray(np.all([end.low >= bend for end in ends], axis=0))

    def _shared(self, prices: _Prices, around: _Prices) -> NDArray[np.bool_]:
        """A mask of cells whose prices, with the load's changed by all others, suit the other direction of power."""
        if not self.spreads:
            return np.zeros(len(self.half), dtype=bool)
        changed = []
        for known, terms in ((prices, self.at), (around, self.over)):
            parts = [*known.of_entries, *(share * terms.scale for share, _ in known.shares)]
            changed.append(reduce(Jet.__add__, [part * size for part, size in zip(parts, self.spreads, strict=True)]))
        return self._positive(changed[0], changed[1])

    def _ends(self, at: Jet, over: Jet) -> tuple[list[Interval], Array]:
        """A function's values at the ends of every cell up to its curvature, and its distance from their line."""
        ends = [at.terms[0] + at.terms[1] * (sign * self.half) for sign in (-1.0, 1.0)]
        return ends, 2.0 * _greatest(over.terms[2]) * self.half**2

    def _integrand(self, terms: _Terms, prices: _Prices, lines: list[tuple[Array, Array]]) -> _Integrand:
        """The factors of the integrand, and the price of the peak torque."""
        scale, share = terms.scale, terms.share
        zero = terms.s * 0.0
        A, B1, C2, price_of_peak = zero, zero, terms.rate, zero
        priced = [(price * share, entry.torque) for price, entry in zip(prices.of_entries, self.entries, strict=True)]
        priced += [(part * terms.sine, torque) for part, torque in prices.shares]
        for price, torque in priced:
            _, square, drag, load = terms.torques[torque]
            A, B1, C2 = A + price * load, B1 + price * drag * scale, C2 + price * square * scale * scale
        for price, (sign, above), entry in zip(prices.of_entries, lines, self.entries, strict=True):
            if entry.role == "squared":
                B1 = B1 - share * price * price * 0.25 / self.plane.heat
                continue
            if entry.side and not entry.at_rest and not entry.fall:
                continue
            magnitude = self._chosen(sign != 0.0, price * sign, self._affine(above, terms.s)) * share
            if entry.role == "peak":
                price_of_peak = magnitude
            A = A - magnitude * (self.peak if entry.role == "peak" else entry.at_rest)
            B1 = B1 + magnitude * scale * entry.fall
        L = share * self.weight
        if terms.mean is not None:
            A, B1, L = A + terms.mean[0], B1 + terms.mean[1], L + share * terms.mean[2]
        half_pi = PI * 0.5
        return _Integrand(*(jet * half_pi for jet in (A, B1, C2, L, price_of_peak)))


def positions(s: Interval) -> tuple[Array, Array]:
    """The least and the greatest position a = sin²(pi s/2) at places s, rounded outward."""
    sine = (s * PI * 0.5).sine()
    square = sine * sine
    return np.maximum(square.low, 0.0), np.minimum(square.high, 1.0)


def _least(factors: list[Array], near: Array, most: Array) -> Array:
    """A lower bound of A + B1 x + C2 x² + L/x for 0 < x <= most; minus infinity if none is known."""
    A, B1, C2, L = factors
    with np.errstate(all="ignore"):
        z = np.minimum(near.mean(axis=0), most)
        for _ in range(_NEWTON):
            step = (B1 + 2.0 * C2 * z - L / z**2) / (2.0 * C2 + 2.0 * L / z**3)
            z = np.minimum(np.clip(z - np.where(np.isfinite(step), step, 0.0), 0.5 * z, 2.0 * z), most)
        bounded = np.isfinite(most)
        z = np.where(bounded, z, z * (1.0 + _STATIONARY_SLACK))  # beyond the flat place it only rises
        place, largest = exact(z), exact(np.where(bounded, most, 1.0))
        K = exact(L) / (place * place)
        E = exact(B1) + exact(C2) * place * 2.0 - K
        value = exact(A) + exact(B1) * place + exact(C2) * place * place + exact(L) / place
        rising = np.where(bounded, (E * (largest - place)).low, np.where(E.low < 0.0, -inf, 0.0))
        steepest = np.where(bounded, (exact(C2) + K / largest).low, C2)
        least = (value + np.minimum(np.minimum((-(E * place)).low, rising), 0.0)).low
        least = np.where((steepest >= 0.0) & (L >= 0.0) & np.isfinite(least), least, -inf)
        falls = exact(np.minimum(B1, 0.0)) * largest + exact(np.minimum(C2, 0.0)) * largest * largest
        each = np.where(bounded, (falls + exact(A) + exact(np.maximum(L, 0.0)) / largest).low, -inf)
        still = (B1 >= -SMALLEST_SIZE) & (C2 >= -SMALLEST_SIZE)  # zeros, rounded outward
        each = np.where(still, np.fmax(each, A), each)
    return np.fmax(least, np.where((L >= 0.0) & np.isfinite(each), each, -inf))


def _spreads(plane: PhasePlane, side: int) -> list[float]:
    """The change of the load's price per unit of every torque in the other direction; empty without a gear.

    It has the sign of its side, here taken above 0. In the order of the prices of a branch: the load, all other
    torques, and those of maxima.
    """
    if plane.gear_load is None:
        return []
    bounds = plane.bounds
    torques = [bound.torque for bound in bounds if bound.side]
    torques += [torque for torque in (plane.squared, plane.peak) if torque is not None]
    torques += [bound.torque for bound in bounds if not bound.side]
    torques += [torque for pair in plane.maxima for torque in pair]
    return [
        -1.0 if side else 1.0,
        *(torque.to_load - torque.back if isinstance(torque, GearTorque) else 0.0 for torque in torques),
    ]


def _of_side(ends: Array, side: int) -> Array:
    """Prices at the ends of cells; a one-sided bound's prices have its sign in the whole cell."""
    if side == 0:
        return ends
    sizes = np.maximum(side * ends, 0.0)
    return np.asarray(side * np.maximum(sizes, _AFFINE_SLACK * sizes.max(axis=0)))


def _to_ends(inside: Array) -> Array:
    """The values at the ends of cells of straight lines through those a little inside."""
    beyond = (inside[1] - inside[0]) * (_INSIDE / (1.0 - 2.0 * _INSIDE))
    return np.stack([inside[0] - beyond, inside[1] + beyond])


def _greatest(values: Interval) -> Array:
    """The greatest magnitude in intervals."""
    return np.abs(values.middle) + values.radius * (1.0 + 4.0 * ROUNDOFF)
