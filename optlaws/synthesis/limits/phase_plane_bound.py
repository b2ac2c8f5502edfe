"""What a potential proves of all motions in a phase plane, with every rounding counted.

For any potential q(a), any weight of the time, and prices of torques and accelerations with 2 q = the sum of price
times inertia,

    what is minimised + weight * time  >=  the integral over a of the least, over 0 < b <= B, of
        A + B1 b + (C2 - q') b² + weight / b.

For a squared torque is at least p tau b - p² b²/4, a maximum of torques at least their mean by any shares, and at a
price n a torque within |tau| <= M is at least -|n| M; what all this has of c adds up to q w', which is integrated by
parts.

In cells of s prices are affine but for one, which follows from q; with b = scale * x the integrand is f(x) = A + B1 x
+ C2 x² + L/x. With K = L/z², E = B1 + 2 C2 z - K, it is f(z) + (x - z)² (C2 + K/x) + E (x - z) for any z. An affine z
near the minimum leaves f(z), whose integral is enclosed by Taylor's formula, and what E can still lower.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import comb, fsum, inf, nextafter, pi
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from optlaws.formulas.arithmetic import horner
from optlaws.numbers import Array
from optlaws.numerics.interval import Interval, between, chosen, exact
from optlaws.numerics.taylor import Jet, variable
from optlaws.synthesis.limits.formula_jets import formula_jet
from optlaws.synthesis.limits.phase_plane import PhasePlane, PhaseTorque
from optlaws.synthesis.limits.phase_plane_velocity import InnerMinimum, entries_of
from optlaws.tolerances import AFFINE_SLACK, ROUNDOFF, SHORT_CELL, SMALLEST_SIZE, STATIONARY_SLACK, WEAK_CELL

_CELLS = 160  # in the whole, besides a few in every piece
_FEW = 3
_ORDER = 4  # of the remainder in a cell
_FAR = 4.0
_ENDS_ROUNDING = 64.0 * ROUNDOFF  # cells are a little wider than they are
#: cells of which little is proven: in how many parts they are divided, how often, how many may be, and what is little
_PARTS, _DEEPEST, _MOST_WEAK = 4, 6, 60
_NEWTON = 12
_END, _INSIDE, _NEAR_B = 0.12, 0.02, 0.9
_PI = Interval(np.array(pi), np.array(ROUNDOFF * pi))


@dataclass(frozen=True, eq=False)
class Potential:
    """A piecewise polynomial pi(s) that stands for q(a) = J(a) pi(s)/sin(pi s) where a = sin²(pi s/2).

    J is the inertia of the plane's reference.

    Attributes
    ----------
    edges
        The ends of its pieces, from 0 to 1.
    coefficients
        Bernstein coefficients, one row a piece; neighbours share those at their ends.
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

    def steeper(self, by: float) -> Potential:
        """The potential with a little more fall: by (1 - 2 s) more, divided by sin(pi s)."""
        degree = self.coefficients.shape[1] - 1
        s = self.edges[:-1, None] + np.diff(self.edges)[:, None] * np.arange(degree + 1) / degree
        more = 1.0 - 2.0 * s
        more[1:, 0] = more[:-1, -1]
        return Potential(self.edges, self.coefficients + by * more)


class Guess(NamedTuple):
    """Where inner minima are looked for; a bad guess weakens what is proven, and proves nothing false."""

    s: Array  #: places within (0, 1), ascending
    b: Array  #: velocities there
    peak: float  #: about the peak that is minimised


def proven_bound(plane: PhasePlane, potential: Potential, weight: float, guess: Guess) -> float:
    """What no motion of a phase plane can beat, by a potential.

    Parameters
    ----------
    plane
        What is minimised, and within which bounds.
    potential
        The multiplier of the equation of motion.
    weight
        The multiplier of the time, at least 0; 1 where the time is minimised.
    guess
        Near what the inner minimum is looked for.
    """
    total, price = _ProofCells(plane, potential, weight, guess).integrals()
    if plane.kind == "time":
        return total
    total = nextafter(total - weight, -inf)
    if plane.kind == "mean":
        return total
    return nextafter(total / price, -inf) if total > 0.0 and price > 0.0 else 0.0


class _Terms(NamedTuple):
    """What the integrand is made of, as jets in s."""

    s: Jet
    sine: Jet
    scale: Jet  #: of the velocity: b = scale * x
    share: Jet  #: sine over scale
    inverse: Jet  #: scale over sine
    torques: dict[PhaseTorque, tuple[Jet, Jet, Jet, Jet]]
    double: Jet  #: 2 q, times scale
    rate: Jet  #: what multiplies x² of -q' b²


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


class _ProofCells:
    """Cells of s, each within a piece of the potential, with affine prices of all torques but one."""

    def __init__(self, plane: PhasePlane, potential: Potential, weight: float, guess: Guess) -> None:
        self.plane, self.potential, self.weight, self.guess = plane, potential, weight, guess
        self.entries = entries_of(plane)
        self.reach: tuple[float, ...] | None = None
        edges = potential.edges
        counts = np.ceil(np.diff(edges) * _CELLS).astype(int) + _FEW
        piece = np.repeat(np.arange(len(counts)), counts)
        shares = np.concatenate([np.arange(count) for count in counts]) / counts[piece]
        low = edges[piece] * (1.0 - shares) + edges[piece + 1] * shares
        self._take(piece, low, np.append(low[1:], 1.0))

    def _take(self, piece: NDArray[np.intp], low: Array, high: Array) -> None:
        """The cells that are looked at."""
        self.piece, self.low, self.high = piece, low, high
        self.middle = 0.5 * (low + high)
        self.half = 0.5 * (high - low) * (1.0 + 8.0 * ROUNDOFF)
        self._choose(self.guess)
        self.at, self.over = self._terms(exact(self.middle), _ORDER - 2), self._terms(between(low, high), _ORDER)

    def _divide(self, cells: NDArray[np.bool_]) -> None:
        """A few equal parts of every given cell are looked at instead."""
        shares = np.arange(_PARTS + 1) / _PARTS
        edges = self.low[cells][:, None] * (1.0 - shares) + self.high[cells][:, None] * shares
        self._take(np.repeat(self.piece[cells], _PARTS), edges[:, :-1].ravel(), edges[:, 1:].ravel())

    def _choose(self, guess: Guess) -> None:
        """The velocities at the ends of cells near which the inner minimum is, and the prices of torques there."""
        inside = _INSIDE * (self.high - self.low)
        s = np.stack([self.low + inside, self.high - inside]).ravel()
        value, slope = (term.middle for term in self.potential.jet(np.tile(self.piece, 2), exact(s), 1).terms)
        sine, a = np.sin(np.pi * s), np.sin(np.pi * s / 2.0) ** 2
        inertia, by_a = self.plane.reference.values(a)[0], self.plane.reference.inertia_slope(a)
        by_s = slope / sine - np.pi * np.cos(np.pi * s) * value / sine**2
        q_slope = by_a * value / sine + inertia * by_s / (np.pi / 2.0 * sine)
        inner = InnerMinimum(self.plane, self.weight, a, (inertia * value / sine, q_slope), guess.peak)
        b = inner.velocity(np.interp(s, guess.s, guess.b / np.sin(np.pi * guess.s)) * sine)
        shape = (2, len(self.middle))
        known = inner.prices(b)
        distance = np.minimum(self.middle, 1.0 - self.middle)
        near = (b.reshape(shape) >= _NEAR_B * self.plane.B).any(axis=0)
        sides = self.middle < 0.5, self.middle >= 0.5
        if self.reach is None:  # up to where the bound of b may count, and at least the first cell and the last
            self.reach = tuple(
                max(float(np.min(distance[side & near], initial=_END)), 1.5 * float(distance[side].min()))
                for side in sides
            )
        self.end = np.logical_or(*(side & (distance < most) for side, most in zip(sides, self.reach, strict=True)))
        self.most = np.where(self.end, inf, self.plane.greatest_velocity)
        scale = np.where(self.end, sine.reshape(shape), 1.0)
        self.x = np.minimum(_to_ends(b.reshape(shape) / scale), self.most)
        self.prices = [_to_ends(price.reshape(shape) * scale) for price in known.prices]
        shares = (_to_ends(share.reshape(shape)) for share in known.shares)
        self.shares = [np.clip(share, AFFINE_SLACK, 1.0 - AFFINE_SLACK) for share in shares]
        self.follows = known.follows.reshape(shape)
        # in a cell the price follows from q that does so at both ends, else that of the reference
        last = len(self.entries) - 1
        self.follows = np.where(self.follows[0] == self.follows[1], self.follows[0], last)

    def integrals(self) -> tuple[float, float]:
        """What the integral of the inner minimum is at least, and that of the peak torque's price at most."""
        integrals, prices = list[float](), list[float]()
        for deep in range(_DEEPEST):
            least, price, weak = self._in_cells()
            unknown = ~np.isfinite(least)
            if unknown.any():
                self.follows = np.where(unknown, len(self.entries) - 1, self.follows)
                again, its_price, still = self._in_cells()
                better = again > least
                least, price = np.where(better, again, least), np.where(better, its_price, price)
                weak &= still
            if deep + 1 == _DEEPEST or np.count_nonzero(weak) > _MOST_WEAK:
                weak = np.zeros_like(weak)
            integrals += least[~weak].tolist()
            prices += price[~weak].tolist()
            if not weak.any():
                break
            self._divide(weak)
        if not np.isfinite(integrals).all() or not np.isfinite(prices).all():
            return -inf, inf
        rounding = _ENDS_ROUNDING * fsum(map(abs, integrals))
        greatest = nextafter(fsum(prices) * (1.0 + _ENDS_ROUNDING), inf)
        return nextafter(fsum(integrals) - rounding, -inf), greatest

    def _in_cells(self) -> tuple[Array, Array, NDArray[np.bool_]]:
        """Lower bounds of the integrals of the inner minimum over cells, upper ones of the price's, and where weak."""
        prices, prices_around = self._prices(self.at), self._prices(self.over)
        lines = self._lines_above(prices.of_entries, prices_around.of_entries)
        here, around = self._integrand(self.at, prices, lines), self._integrand(self.over, prices_around, lines)
        z, z_around = self._affine(self.x, self.at.s), self._affine(self.x, self.over.s)
        along = [f.A + f.B1 * x + f.C2 * x * x + f.L / x for f, x in ((here, z), (around, z_around))]
        ranges = [self._range(*pair) for pair in zip(here[:4], around[:4], strict=True)]
        mean, length = self._mean(*along), exact(self.half) * 2.0
        loss = self._loss(here, around, z, z_around, ranges)
        with np.errstate(invalid="ignore"):
            least = (mean - loss).low
            weak = ~(
                (loss + mean.radius) * self.half <= WEAK_CELL * np.abs(mean.middle) * np.maximum(self.half, SHORT_CELL)
            )
        least = np.fmax(np.where(np.isfinite(least), least, -inf), _least([v.low for v in ranges], self.x, self.most))
        known = np.isfinite(least) & self._within(prices, prices_around)
        total = np.where(known, (exact(np.where(known, least, 0.0)) * length).low, -inf)
        return total, (self._mean(here.price, around.price) * length).high, weak | ~known

    def _mean(self, at: Jet, over: Jet) -> Interval:
        """The mean of a function over every cell, of its jet in the middle and that over the cell."""
        square = exact(self.half) * self.half
        rest = Interval(np.zeros(len(self.half)), _greatest(over.terms[_ORDER]) / (_ORDER + 1))
        mean: Interval = at.terms[0] + at.terms[2] * square * (1.0 / 3.0) + rest * square * square
        return mean

    def _range(self, at: Jet, over: Jet) -> Interval:
        """All values of a function in every cell."""
        moved = exact(_greatest(at.terms[1])) * self.half
        bent = exact(_greatest(over.terms[2])) * self.half * self.half
        around: Interval = at.terms[0] + Interval(np.zeros(len(self.half)), moved.high + bent.high)
        return around

    def _loss(self, at: _Integrand, over: _Integrand, z: Jet, z_over: Jet, ranges: list[Interval]) -> Array:
        """By how much the inner minimum may be below its value at z; infinite where that is not known."""
        first, second = (f.B1 + f.C2 * x * 2.0 - f.L / (x * x) for f, x in ((at, z), (over, z_over)))
        K = self._range(at.L / (z * z), over.L / (z_over * z_over))
        E, C2, far = self._range(first, second), ranges[2], np.minimum(_FAR * z_over.terms[0].high, self.most)
        with np.errstate(all="ignore"):
            steep, beyond = ((C2 + np.where(np.isfinite(x), (K / exact(x)).low, 0.0)).low for x in (far, self.most))
            above = np.where((self.x == self.most).all(axis=0), np.maximum(E.high, 0.0), _greatest(E))
            # beyond far (x - z)/x is at least 3/4, and x - z at least 3 z
            safe = (C2.low >= 0.0) | (far >= self.most) | (3.0 * z_over.terms[0].low * beyond >= above)
            known = (steep > 0.0) & (beyond >= 0.0) & (K.low > 0.0) & (above <= 0.75 * K.low) & safe
            loss = above**2 / (4.0 * steep) * (1.0 + 8.0 * ROUNDOFF)
        return np.where((above == 0.0) & (beyond >= 0.0) & (K.low > 0.0), 0.0, np.where(known, loss, inf))

    def _terms(self, places: Interval, order: int) -> _Terms:
        """What the integrand is made of, up to an order."""
        s = variable(places, order + 1)
        sine, cosine = (s * _PI).waves()
        a = (1.0 - cosine) * 0.5
        unity = s * 0.0 + 1.0
        scale, share = self._chosen(self.end, sine, unity), self._chosen(self.end, unity, sine)
        inverse = 1.0 / share
        torques = [entry.torque for entry in self.entries] + [torque for pair in self.plane.maxima for torque in pair]
        jets = {torque: torque.jets(a.cut(order)) for torque in dict.fromkeys(torques)}
        potential = self.potential.jet(self.piece, places, order + 1)
        potential = potential * formula_jet(self.plane.reference.inertia, "a", a)
        turned = (inverse * inverse * potential * cosine).cut(order) * _PI
        rate = (turned - scale.cut(order) * inverse.cut(order) * potential.slope()) * (2.0 / _PI)
        sine, scale, share, inverse = (jet.cut(order) for jet in (sine, scale, share, inverse))
        return _Terms(s.cut(order), sine, scale, share, inverse, jets, potential.cut(order) * inverse * 2.0, rate)

    def _affine(self, ends: Array, s: Jet) -> Jet:
        """The affine function in every cell with given values near its ends."""
        line: Jet = (s - exact(self.low)) * ((ends[1] - ends[0]) / (self.high - self.low)) + ends[0]
        return line

    def _prices(self, terms: _Terms) -> _Prices:
        """The prices of all entries, times scale, and the torques of maxima with their shares, in every cell."""
        prices = [self._affine(price, terms.s) for price in self.prices]
        shares = [self._affine(share, terms.s) for share in self.shares]
        rest = terms.double
        for i, (price, entry) in enumerate(zip(prices, self.entries, strict=True)):
            rest = rest - self._where(self.follows != i, price) * terms.torques[entry.torque][0]
        for i, (share, (first, second)) in enumerate(zip(shares, self.plane.maxima, strict=True), len(prices)):
            others = terms.torques[first][0] - terms.torques[second][0]
            known = self._where(self.follows != i, share)
            rest = rest - (terms.torques[second][0] + known * others) * terms.scale
        for i, entry in enumerate(self.entries):
            if (self.follows == i).any():
                prices[i] = self._chosen(self.follows == i, self._ratio(rest, terms, entry.torque), prices[i])
        for i, (first, second) in enumerate(self.plane.maxima, len(prices)):
            if (self.follows == i).any():
                others = (terms.torques[first][0] - terms.torques[second][0]) * terms.scale
                shares[i - len(prices)] = self._chosen(self.follows == i, rest / others, shares[i - len(prices)])
        shared = []
        for share, (first, second) in zip(shares, self.plane.maxima, strict=True):
            shared += [(share, first), (1.0 - share, second)]
        return _Prices(prices, shared)

    def _ratio(self, rest: Jet, terms: _Terms, torque: PhaseTorque) -> Jet:
        """What is left of 2 q over an inertia; where nothing else has a price, without a division by it."""
        if len(self.entries) == 1 and not self.plane.maxima:
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
            above = np.stack([_greatest(end) + bend for end in ends]) * (1.0 + AFFINE_SLACK)
            low, high = (np.array([getattr(end, side) for end in ends]) for side in ("low", "high"))
            sign = np.where((low > bend).all(axis=0), 1.0, np.where((high < -bend).all(axis=0), -1.0, 0.0))
            lines.append((sign, above))
        return lines

    def _within(self, prices: _Prices, around: _Prices) -> NDArray[np.bool_]:
        """Where all shares of maxima are surely from 0 to 1."""
        within = np.ones(len(self.half), dtype=bool)
        for (share, _), (over_cell, _) in zip(prices.shares, around.shares, strict=True):
            ends, bend = self._ends(share, over_cell)
            within &= np.all([(end.low >= bend) & (end.high <= 1.0 - bend) for end in ends], axis=0)
        return within

    def _ends(self, at: Jet, over: Jet) -> tuple[list[Interval], Array]:
        """A function's values at the ends of every cell but for a bend, and twice that: it is so near to their line."""
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
            magnitude = self._chosen(sign != 0.0, price * sign, self._affine(above, terms.s)) * share
            if entry.role == "peak":
                price_of_peak = magnitude
            else:
                A = A - magnitude * entry.at_rest
                B1 = B1 + magnitude * scale * entry.fall
        half_pi = _PI * 0.5
        return _Integrand(*(jet * half_pi for jet in (A, B1, C2, share * self.weight, price_of_peak)))


def _least(factors: list[Array], near: Array, most: Array) -> Array:
    """What A + B1 x + C2 x² + L/x is at least where 0 < x <= most; minus infinity where that is not known."""
    A, B1, C2, L = factors
    with np.errstate(all="ignore"):
        z = np.minimum(near.mean(axis=0), most)
        for _ in range(_NEWTON):
            step = (B1 + 2.0 * C2 * z - L / z**2) / (2.0 * C2 + 2.0 * L / z**3)
            z = np.minimum(np.clip(z - np.where(np.isfinite(step), step, 0.0), 0.5 * z, 2.0 * z), most)
        bounded = np.isfinite(most)
        z = np.where(bounded, z, z * (1.0 + STATIONARY_SLACK))  # beyond the flat place it only rises
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


def _to_ends(inside: Array) -> Array:
    """The values at the ends of cells of straight lines through those a little inside."""
    beyond = (inside[1] - inside[0]) * (_INSIDE / (1.0 - 2.0 * _INSIDE))
    return np.stack([inside[0] - beyond, inside[1] + beyond])


def _greatest(values: Interval) -> Array:
    """The greatest magnitude in intervals."""
    return np.abs(values.middle) + values.radius * (1.0 + 4.0 * ROUNDOFF)
