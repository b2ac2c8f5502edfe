"""Laws of all axes at given instants: cubic splines by one linear program, as laws of their moves.

Control points of each cubic, of its velocity and of its distance from what it must not touch bound them between knots.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import inf

import numpy as np

from optlaws.cycles.coordination.passages import Bent
from optlaws.cycles.coordination.relaxation import Goal, InstantBox
from optlaws.cycles.coordination.rows_of_program import Rows
from optlaws.cycles.coordination.timeline import Chain, Stand
from optlaws.laws import MotionLaw
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.laws.segments.segment import PolynomialSegment
from optlaws.numbers import Array
from optlaws.tolerances import BENT_MARGIN, SAME_NODE, SAME_TIME, SHARE_AT_REST

#: places and values of a row over the unknowns, and a constant
Linear = tuple[list[int], list[float], float]


@dataclass(frozen=True)
class BentAxis:
    """Durations of all segments of an axis in seconds, and the laws of those that move, by their numbers."""

    durations: list[float]
    laws: dict[int, MotionLaw]

    def slower(self, factor: float) -> BentAxis:
        """The same laws over longer times."""
        return BentAxis([factor * duration for duration in self.durations], self.laws)


@dataclass(frozen=True)
class BentLaws:
    """The greatest share of limits or of accelerations in the program, and the motions of the axes."""

    share: float
    axes: Mapping[str, BentAxis]
    instants: Array
    sides: tuple[int, ...]


@dataclass(frozen=True, eq=False)
class _Cubics:
    """The unknowns of an axis: position, velocity and acceleration at all knots."""

    first: int
    count: int

    def at(self, nu: int, j: int) -> int:
        return self.first + nu * self.count + j

    def controls(self, j: int, length: float) -> list[Linear]:
        """The control points of the position over a piece."""
        start, stop = self.at(0, j), self.at(0, j + 1)
        return [
            ([start], [1.0], 0.0),
            ([start, self.at(1, j)], [1.0, length / 3.0], 0.0),
            ([stop, self.at(1, j + 1)], [1.0, -length / 3.0], 0.0),
            ([stop], [1.0], 0.0),
        ]


def bent_laws(
    bent: Bent, instants: Array, sides: tuple[int, ...], goal: Goal, period: float, pieces: int
) -> BentLaws | None:
    """The laws of least use of the limits at instants in a period; None where none exist."""
    box = InstantBox(instants, instants, sides)
    nodes = {name: chain.times(box.low, box.high, period)[0] for name, chain in bent.chains.items()}
    if any(_at_once(chain, nodes[name]) for name, chain in bent.chains.items()):
        return None
    knots = _knots(nodes, pieces)
    stands = {name: Stand.at(chain, nodes[name], nodes[name], knots) for name, chain in bent.chains.items()}
    free = [name for name, chain in bent.chains.items() if chain.timeline.bends]
    cubics = {name: _Cubics(3 * i * len(knots), len(knots)) for i, name in enumerate(free)}
    size = 3 * len(free) * len(knots) + 1
    rows = Rows(size, np.full(size, -inf), np.full(size, inf))
    rows.low[-1] = 0.0
    for name in free:
        _spline(rows, stands[name], cubics[name], knots)
        _limited(rows, stands[name], cubics[name], knots, goal.references.get(name), period)
    for visit, side in zip(bent.visits, sides, strict=True):
        profile, (start, stop) = visit.sides[side], visit.between
        over, axis = stands[visit.over], stands[visit.axis]
        for j in range(len(knots) - 1):
            inside = over.after[j] >= start and over.before[j + 1] <= stop and over.after[j] < over.before[j + 1]
            pairs = zip(
                _controls(axis.chain, cubics.get(visit.axis), knots, j, period),
                _controls(over.chain, cubics.get(visit.over), knots, j, period),
                strict=True,
            )
            places = over.chain.places[int(over.after[j]) : int(over.before[j + 1]) + 1] if inside else ()
            edges = profile.edges(min(places), max(places)) if inside else []
            for number, (y, x) in enumerate(pairs):
                for slope, value in edges:
                    _keep(rows, y, x, profile.sign, slope, value)
                if number == 0 and stop >= over.before[j] and start <= over.after[j] >= over.before[j]:
                    level = profile.level(over.hull(j)[0])
                    # what is as far as the axis goes has no room beyond
                    apart = BENT_MARGIN if BENT_MARGIN < level < 1.0 - BENT_MARGIN else 0.0
                    _keep(rows, y, x, profile.sign, 0.0, level + profile.sign * apart)
    solved = rows.optimum(size - 1)
    if solved is None:
        return None
    axes = {name: _axis(stands[name], cubics[name], knots, solved, period) for name in free}
    return BentLaws(float(solved[-1]), axes, instants, sides)


def _at_once(chain: Chain, times: Array) -> bool:
    """Whether the axis would be at two places at one time."""
    return bool((np.diff(times)[np.diff(chain.places) != 0.0] <= SAME_TIME).any() or times[-1] > 1.0 + SAME_NODE)


def _knots(nodes: Mapping[str, Array], pieces: int) -> Array:
    given = np.unique(np.clip(np.concatenate(list(nodes.values())), 0.0, 1.0))
    given = given[np.concatenate([[True], np.diff(given) > 10.0 * SAME_NODE])]
    even = np.linspace(0.0, 1.0, pieces + 1)
    apart = np.abs(even[:, None] - given[None, :]).min(axis=1) > 0.5 / pieces
    return np.sort(np.concatenate([given, even[apart]]))


def _spline(rows: Rows, stand: Stand, cubics: _Cubics, knots: Array) -> None:
    """Velocity and acceleration are continuous, the axis rests and passes where it does, and goes one way between."""
    for j, length in enumerate(np.diff(knots)):
        p, v, a = ([cubics.at(nu, j), cubics.at(nu, j + 1)] for nu in (0, 1, 2))
        rows.add([v[1], v[0], *a], [1.0, -1.0, -0.5 * length, -0.5 * length], 0.0, equal=True)
        rows.add([p[1], p[0], v[0], *a], [1.0, -1.0, -length, -(length**2) / 3.0, -(length**2) / 6.0], 0.0, equal=True)
        rises, falls = stand.way(j, j + 1)
        sign = 1.0 if rises else -1.0
        if rises != falls:
            rows.add([v[0], a[0]], [sign, 0.5 * sign * length], 0.0)
    for j in range(len(knots)):
        rest = stand.rest(j)
        if rest is not None:
            place = stand.hull(j)[0]
            for nu, value in enumerate((place, 0.0, 0.0)):
                rows.low[cubics.at(nu, j)] = rows.high[cubics.at(nu, j)] = value
        elif stand.after[j] >= stand.before[j]:
            rows.low[cubics.at(0, j)] = rows.high[cubics.at(0, j)] = stand.hull(j)[0]
        if rest is None:
            rises, falls = stand.way(max(j - 1, 0), min(j + 1, len(knots) - 1))
            if rises != falls:
                edge = rows.low if rises else rows.high
                edge[cubics.at(1, j)] = 0.0


def _limited(rows: Rows, stand: Stand, cubics: _Cubics, knots: Array, reference: float | None, period: float) -> None:
    stroke, last = stand.chain.timeline.stroke, len(rows.low) - 1
    for j, length in enumerate(np.diff(knots)):
        limits = stand.limits(j, j + 1)
        v, a = ([cubics.at(nu, j), cubics.at(nu, j + 1)] for nu in (1, 2))
        terms: list[tuple[int, list[int], list[float]]] = [
            (1, v[:1], [1.0]),
            (1, [v[0], a[0]], [1.0, 0.5 * length]),
            (1, v[1:], [1.0]),
            (2, a[:1], [1.0]),
            (2, a[1:], [1.0]),
            (3, a, [-1.0 / length, 1.0 / length]),
        ]
        for nu, places, values in terms:
            row = np.array(values) * stroke / period**nu
            if nu == 2 and reference is not None:
                for sign in (1.0, -1.0):
                    rows.add([*places, last], [*(-sign * row / reference), 1.0], 0.0)
            low, high = limits.get(nu, (-inf, inf))
            for sign, most in ((-1.0, -low), (1.0, high)):
                if most < inf and reference is None:
                    rows.add([*places, last], [*(-sign * row / most), 1.0], 0.0)
                elif most < inf:
                    rows.add(places, [*(-sign * row / most)], -1.0)


def _controls(chain: Chain, cubics: _Cubics | None, knots: Array, j: int, period: float) -> list[Linear]:
    """Control points of the position over a piece, of a motion that is known by its values and slopes at the ends."""
    length = float(knots[j + 1] - knots[j])
    if cubics is not None:
        return cubics.controls(j, length)
    line = chain.timeline
    at = np.minimum(knots[j : j + 2], 1.0 - SAME_NODE) * period
    p = (line.cycle(at) - line.low) / line.stroke
    v = line.cycle(at, 1) * period / line.stroke
    values = p[0], p[0] + length * v[0] / 3.0, p[1] - length * v[1] / 3.0, p[1]
    return [([], [], float(value)) for value in values]


def _keep(rows: Rows, y: Linear, x: Linear, sign: float, slope: float, value: float) -> None:
    """sign (y - slope x - value) is not below 0."""
    places = [*y[0], *x[0]]
    values = [*(sign * weight for weight in y[1]), *(-sign * slope * weight for weight in x[1])]
    rows.add(places, values, sign * (value - y[2] + slope * x[2]))


def _axis(stand: Stand, cubics: _Cubics, knots: Array, solved: Array, period: float) -> BentAxis:
    """The solution as durations and laws: what stands still beside a dwell is part of it."""
    line = stand.chain.timeline
    accelerations = solved[cubics.at(2, 0) : cubics.at(2, cubics.count)].copy()
    rests = [stand.rest(j) for j in range(len(knots))]
    slack = SHARE_AT_REST * float(np.abs(accelerations).max())
    laws, ends = dict[int, MotionLaw](), [0.0]
    for i, (move, (start, stop)) in enumerate(zip(line.moves, line.ways(), strict=True)):
        first = max(j for j, rest in enumerate(rests) if rest == i)
        last = min(j for j, rest in enumerate(rests) if rest == i + 1)
        if line.rests[i].dwells:
            while first < last - 1 and abs(accelerations[first + 1]) <= slack:
                first += 1
        if line.rests[i + 1].dwells:
            while last > first + 1 and abs(accelerations[last - 1]) <= slack:
                last -= 1
        laws[move.segment] = _law(knots[first : last + 1], accelerations[first : last + 1], stop - start)
        ends += [float(knots[first]), float(knots[last])]
    ends.append(1.0)
    durations = [0.0] * len(line.cycle.programme.stretches)
    for i, move in enumerate(line.moves):
        durations[move.segment] = period * (ends[2 * i + 2] - ends[2 * i + 1])
    for i, rest in enumerate(line.rests):
        for dwell in rest.dwells:
            durations[dwell] = period * (ends[2 * i + 1] - ends[2 * i]) / len(rest.dwells)
    return BentAxis(durations, laws)


def _law(knots: Array, accelerations: Array, stroke: float) -> MotionLaw:
    """The law of a move whose acceleration is a broken line, from rest to rest to the last digit."""
    k = (knots - knots[0]) / (knots[-1] - knots[0])
    c = accelerations * (knots[-1] - knots[0]) ** 2 / stroke
    c[0] = c[-1] = 0.0
    lengths = np.diff(k)
    # the velocity and the position at the end as sums over the accelerations at knots
    speeds, ways = np.zeros(len(k)), np.zeros(len(k))
    speeds[:-1] += 0.5 * lengths
    speeds[1:] += 0.5 * lengths
    ways[:-1] += lengths * (0.5 * (1.0 - k[:-1]) - lengths / 6.0)
    ways[1:] += lengths * (0.5 * (1.0 - k[1:]) + lengths / 6.0)
    inner = np.array([speeds, ways])[:, 1:-1]
    for _ in range(2):
        off = np.array([-speeds @ c, 1.0 - ways @ c])
        c[1:-1] += np.linalg.lstsq(inner, off, rcond=None)[0]
    b = np.concatenate([[0.0], np.cumsum(0.5 * lengths * (c[:-1] + c[1:]))])
    segments = [
        PolynomialSegment((0.5 * (low + high), 0.5 * (high - low)), float(start))
        for low, high, start in zip(c[:-1].tolist(), c[1:].tolist(), b[:-1], strict=True)
    ]
    k[-1] = 1.0
    return PiecewiseLaw(k, segments)
