"""A relaxation of all laws whose instants lie in a box: a linear program in positions at times; its value is a bound.

Divided differences of positions are means of derivatives with B-splines as weights (Curry and Schoenberg 1966), so
that a limit of a derivative is one of them, of every law, however smooth. Where an axis surely rests a knot counts
several times.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import factorial, inf, sqrt
from typing import Any

import numpy as np

from optlaws.cycles.coordination.passages import Bent, Visit
from optlaws.cycles.coordination.rows_of_program import Rows, Solved
from optlaws.cycles.coordination.timeline import Stand
from optlaws.numbers import Array
from optlaws.tolerances import SAME_NODE

_MOST_SHARE = 1e4


@dataclass(frozen=True, eq=False)
class InstantBox:
    """Between which shares of the period each instant is, and on which side of each region the other axis is."""

    low: Array
    high: Array
    sides: tuple[int | None, ...]


@dataclass(frozen=True)
class Goal:
    """The objective: the greatest share of all limits, or the accelerations of axes as shares of their former values.

    `references` are these accelerations in SI units, none where the share is of the limits; greater shares than `most`
    are of no use.
    """

    references: Mapping[str, float]
    most: float = inf


@dataclass(frozen=True)
class Relaxed:
    """Positions of the axes at times, as shares of period and strokes, and the share that no laws are below."""

    times: Array
    positions: Mapping[str, Array]
    bound: float


def relaxed(bent: Bent, box: InstantBox, goal: Goal, period: float, pieces: int) -> Relaxed | None:
    """The relaxation over a box in a period; None where it is proven that no laws have their instants there."""
    spans = {name: chain.times(box.low, box.high, period) for name, chain in bent.chains.items()}
    if any((first > last + SAME_NODE).any() for first, last in spans.values()):
        return None
    times = _times(spans, pieces)
    stands = {name: Stand.at(chain, *spans[name], times) for name, chain in bent.chains.items()}
    free = [name for name, chain in bent.chains.items() if chain.timeline.bends]
    offsets = {name: i * len(times) for i, name in enumerate(free)}
    # positions, instants from the last on, and the share
    size = len(free) * len(times) + bent.count + 1
    rows = Rows(size, np.zeros(size), np.ones(size))
    instants = size - 2 - np.arange(bent.count)
    rows.low[instants], rows.high[instants] = box.low, box.high
    rows.high[-1] = _MOST_SHARE
    positions: dict[str, InstantPlaces] = {}
    for name, stand in stands.items():
        if name not in offsets:
            line = bent.chains[name].timeline
            positions[name] = InstantPlaces(
                None, (line.cycle(np.minimum(times, 1.0 - 1e-15) * period) - line.low) / line.stroke
            )
            positions[name].known[-1] = stand.chain.places[-1]  # type: ignore[index]
            continue
        place = offsets[name]
        positions[name] = InstantPlaces(place, None)
        hulls = np.array([stand.hull(j) for j in range(len(times))])
        rows.low[place : place + len(times)], rows.high[place : place + len(times)] = hulls.T
        _ways(rows, stand, place, len(times))
        _limits(rows, stand, place, times, goal.references.get(name), period)
        _near_rests(rows, stand, place, times, box, goal, period)
    for visit, side in zip(bent.visits, box.sides, strict=True):
        if side is not None and not _beyond(rows, visit, side, positions, stands, spans, times):
            return None
    solved = rows.solve(size - 1)
    if solved is None:
        return None
    if not solved.unknowns.size:
        return Relaxed(np.empty(0), {}, solved.bound)
    return Relaxed(times, {name: place.values(solved, len(times)) for name, place in positions.items()}, solved.bound)


@dataclass(frozen=True, eq=False)
class InstantPlaces:
    """Indices of an axis's positions among the unknowns, or their values where they are known."""

    first: int | None
    known: Array | None

    def entry(self, j: int, weight: float) -> tuple[list[int], list[float], float]:
        """Indices and coefficients of a multiple of a position in a row, and its part of the right side."""
        if self.first is None:
            assert self.known is not None  # noqa: S101 - one of both
            return [], [], -weight * float(self.known[j])
        return [self.first + j], [weight], 0.0

    def values(self, solved: Solved, count: int) -> Array:
        """The positions of a solution; an empty tuple without a solution."""
        if self.first is None:
            assert self.known is not None  # noqa: S101 - one of both
            return self.known
        return solved.unknowns[self.first : self.first + count]


def _times(spans: Mapping[str, tuple[Array, Array]], pieces: int) -> Array:
    """Times of the nodes, with further times evenly spaced between distant nodes."""
    of_nodes = [
        time for first, last in spans.values() for times in (first, last, 0.5 * (first + last)) for time in times
    ]
    nodes = np.unique(np.clip(np.array(of_nodes), 0.0, 1.0))
    nodes = nodes[np.concatenate([[True], np.diff(nodes) > 10.0 * SAME_NODE])]
    even = np.linspace(0.0, 1.0, pieces + 1)
    apart = np.abs(even[:, None] - nodes[None, :]).min(axis=1) > 0.35 / pieces
    return np.sort(np.concatenate([nodes, even[apart]]))


def _ways(rows: Rows, stand: Stand, place: int, count: int) -> None:
    ways = np.array([stand.way(j, j + 1) for j in range(count - 1)])
    steps = np.diff(np.eye(count), axis=0)
    for sign, other in ((1.0, ~ways[:, 1]), (-1.0, ~ways[:, 0])):
        if other.any():
            rows.block(sign * steps[other], place, None, np.zeros(int(other.sum())))


def _limits(rows: Rows, stand: Stand, place: int, times: Array, reference: float | None, period: float) -> None:
    """Divided differences within the limits of the moves that may be on where they are."""
    line = stand.chain.timeline
    order = max([2 * (reference is not None), *(nu for move in line.moves for nu in move.limits)])
    rests = [stand.rest(j) for j in range(len(times))]
    knots = [j for j in range(len(times)) for _ in range(order if rests[j] is not None else 1)]
    at, table = times[knots], np.eye(len(times))[knots]
    for nu in range(1, order + 1):
        width = at[nu:] - at[:-nu]
        steps = np.diff(table, axis=0)
        table = np.divide(steps, width[:, None], out=np.zeros_like(steps), where=width[:, None] > 0.0)
        ends = [(knots[i], knots[i + nu]) for i in range(len(table))]
        moves = np.array([rests[i] is None or rests[i] != rests[j] for i, j in ends]) & (width > 0.0)
        moves &= np.abs(table).max(axis=1) > 0.0
        among = factorial(nu) * line.stroke / period**nu * table[moves]
        ones = np.ones(len(among))
        if nu == 2 and reference is not None:
            for sign in (1.0, -1.0):
                rows.block(sign * among / reference, place, ones, 0.0 * ones)
        sides = [stand.limits(*ends[i]).get(nu, (-inf, inf)) for i in np.flatnonzero(moves)]
        for sign, most in zip((1.0, -1.0), np.array(sides).reshape(-1, 2).T * [[-1.0], [1.0]], strict=True):
            limited = most < inf
            if limited.any():
                share = ones[limited] if reference is None else None
                side = 0.0 * ones[limited] if reference is None else -ones[limited]
                rows.block(sign * among[limited] / most[limited, None], place, share, side)


def _near_rests(rows: Rows, stand: Stand, place: int, times: Array, box: InstantBox, goal: Goal, period: float) -> None:
    """Rows that bound the remaining way to a dwell, or the way since a dwell, by the limits and the elapsed time.

    The greatest way from rest is convex in the time, and so below its chord over a box: linear in the instant.
    """
    chain, line = stand.chain, stand.chain.timeline
    owners = chain.owners
    for i, node in enumerate(chain.nodes):
        before = i > 0 and owners[i - 1] is not None
        move = owners[i - 1] if before else owners[i] if i < len(owners) else None
        if node.rest is None or move is None:
            continue
        start, stop = line.ways()[move]
        sign = (1.0 if stop > start else -1.0) * (1.0 if before else -1.0)
        after = node.after[0] / period + node.after[1]
        first, last = (
            after + (0.0 if node.instant is None else float(side[node.instant])) for side in (box.low, box.high)
        )
        reach = _Reach.of(line.moves[move].limits, goal.references.get(line.name), goal.most)
        off = (first - times, last - times) if before else (times - last, times - first)
        near, far = (reach.way(np.maximum(period * side, 0.0)) / line.stroke for side in off)
        for j in np.flatnonzero((off[0] >= -SAME_NODE) & (far < 1.0)):
            width = last - first
            slope = (far[j] - near[j]) / width if width > SAME_NODE else 0.0
            if node.instant is None or slope == 0.0:
                rows.add([place + int(j)], [sign], sign * node.place - far[j])
            else:
                # at the near end of the box there is less to go
                at, turn = (first, 1.0) if before else (last, -1.0)
                side = sign * node.place - near[j] + turn * slope * (at - after)
                rows.add([place + int(j), rows.size - 2 - node.instant], [sign, turn * slope], side)


@dataclass(frozen=True)
class _Reach:
    """The greatest distance from rest within limits of velocity, acceleration and jerk; infinite without a limit."""

    velocity: float
    acceleration: float
    jerk: float

    @classmethod
    def of(cls, limits: Mapping[int, tuple[float, float]], reference: float | None, most: float) -> _Reach:
        velocity, acceleration, jerk = (
            max(-low, high) for low, high in (limits.get(nu, (-inf, inf)) for nu in (1, 2, 3))
        )
        if reference is not None:
            return cls(velocity, min(acceleration, most * reference), jerk)
        return cls(most * velocity, most * acceleration, most * jerk)

    def way(self, time: Array) -> Array:
        """The way after times: by the jerk, then the acceleration, then the velocity."""
        if self.acceleration == self.jerk == inf:
            return np.where(time > 0.0, self.velocity * time if self.velocity < inf else inf, 0.0)
        ramp = self.acceleration / self.jerk if self.jerk < inf else 0.0
        first = np.minimum(time, ramp)
        rest = np.maximum(time - ramp, 0.0)
        speed = 0.5 * self.jerk * first**2 if self.jerk < inf else 0.0 * time
        way = (self.jerk * first**3 / 6.0 if self.jerk < inf else 0.0) + speed * rest
        steady = self.acceleration if self.acceleration < inf else 0.0
        way = way + 0.5 * steady * rest**2
        if self.velocity == inf:
            return way
        # from when it is as fast as it may be
        at = self._fastest()
        return np.where(time <= at, way, self._until(at) + self.velocity * (time - at))

    def _fastest(self) -> float:
        """When the velocity is the greatest."""
        if self.jerk == inf:
            return self.velocity / self.acceleration
        ramp = self.acceleration / self.jerk
        if 0.5 * self.jerk * ramp**2 >= self.velocity:
            return sqrt(2.0 * self.velocity / self.jerk)
        return ramp + (self.velocity - 0.5 * self.jerk * ramp**2) / self.acceleration

    def _until(self, time: float) -> float:
        unlimited = _Reach(inf, self.acceleration, self.jerk)
        ways: Array = unlimited.way(np.array([time]))
        return float(ways[0])


def _beyond(
    rows: Rows,
    visit: Visit,
    side: int,
    positions: Mapping[str, InstantPlaces],
    stands: Mapping[str, Stand],
    spans: Mapping[str, tuple[Array, Array]],
    times: Array,
) -> bool:
    """The rows of a visit; False where the other axis is surely not beyond a level when a node is reached."""
    profile, (start, stop) = visit.sides[side], visit.between
    over, stand = stands[visit.over], stands[visit.axis]
    x, y = positions[visit.over], positions[visit.axis]
    for j in range(len(times)):
        if over.after[j] >= start and over.before[j] <= stop:
            for slope, value in profile.edges(*over.hull(j)):
                _add(rows, (y.entry(j, profile.sign), x.entry(j, -profile.sign * slope)), profile.sign * value)
    first, last = spans[visit.over]
    for i in range(start, stop + 1):
        level = profile.sign * profile.level(float(over.chain.places[i]))
        ends = [int(np.abs(times - time).argmin()) for time in (first[i], last[i])]
        rises, falls = stand.way(*ends)
        if profile.sign < 0.0:
            rises, falls = falls, rises
        if rises and falls:
            among = stand.chain.places[stand.after[ends[0]] : stand.before[ends[1]] + 1]
            if (profile.sign * among).max() < level - SAME_NODE:
                return False
        else:
            _add(rows, (y.entry(ends[1] if rises else ends[0], profile.sign),), level)
    return True


def _add(rows: Rows, entries: Any, side: float) -> None:  # noqa: ANN401 - what `InstantPlaces.entry` gives
    places, values = [p for entry in entries for p in entry[0]], [v for entry in entries for v in entry[1]]
    rows.add(places, values, side + sum(entry[2] for entry in entries))
