"""What all laws must do whose instants lie in a box: a linear program in positions at times, whose value is a bound.

Divided differences of positions are means of derivatives with B-splines as weights (Curry and Schoenberg 1966), so that a
limit of a derivative is one of them, of every law, however smooth. Where an axis surely rests, a knot counts several times.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import factorial, inf
from typing import Any

import numpy as np

from optlaws.cycles.coordination.passages import Bent, Visit
from optlaws.cycles.coordination.rows_of_program import Rows, Solved
from optlaws.cycles.coordination.timeline import Chain, Stand
from optlaws.numbers import Array
from optlaws.tolerances import SAME_NODE

_MOST_SHARE = 1e4


@dataclass(frozen=True, eq=False)
class Box:
    """Between which shares of the period each instant is, and on which side of each region the other axis is."""

    low: Array
    high: Array
    sides: tuple[int | None, ...]


@dataclass(frozen=True)
class Goal:
    """What is least: the greatest share of all limits, or the accelerations of axes as shares of those they had.

    `references` are these accelerations in SI units, none where the share is of the limits.
    """

    references: Mapping[str, float]


@dataclass(frozen=True)
class Relaxed:
    """Positions of the axes at times, as shares of period and strokes, and the share that no laws are below."""

    times: Array
    positions: Mapping[str, Array]
    bound: float


def relaxed(bent: Bent, box: Box, goal: Goal, period: float, pieces: int) -> Relaxed | None:
    """The relaxation over a box in a period; None where it is proven that no laws have their instants there."""
    spans = {name: chain.times(box.low, box.high, period) for name, chain in bent.chains.items()}
    if any((first > last + SAME_NODE).any() for first, last in spans.values()):
        return None
    times = _times(bent.chains, spans, pieces)
    stands = {name: Stand.at(chain, *spans[name], times) for name, chain in bent.chains.items()}
    free = [name for name, chain in bent.chains.items() if chain.timeline.bends]
    offsets = {name: i * len(times) for i, name in enumerate(free)}
    size = len(free) * len(times) + 1
    rows = Rows(size, np.zeros(size), np.ones(size))
    rows.high[-1] = _MOST_SHARE
    positions: dict[str, Places] = {}
    for name, stand in stands.items():
        if name not in offsets:
            line = bent.chains[name].timeline
            positions[name] = Places(None, (line.cycle(np.minimum(times, 1.0 - 1e-15) * period) - line.low) / line.stroke)
            positions[name].known[-1] = stand.chain.places[-1]  # type: ignore[index]
            continue
        place = offsets[name]
        positions[name] = Places(place, None)
        hulls = np.array([stand.hull(j) for j in range(len(times))])
        rows.low[place : place + len(times)], rows.high[place : place + len(times)] = hulls.T
        _ways(rows, stand, place, len(times))
        _limits(rows, stand, place, times, goal.references.get(name), period)
        _near_rests(rows, stand, place, times, spans[name], goal.references.get(name), period)
    for visit, side in zip(bent.visits, box.sides, strict=True):
        if side is not None and not _beyond(rows, visit, side, positions, stands, spans, times):
            return None
    solved = rows.solve(size - 1)
    if solved is None:
        return None
    return Relaxed(times, {name: place.values(solved, len(times)) for name, place in positions.items()}, solved.bound)


@dataclass(frozen=True, eq=False)
class Places:
    """Where the positions of an axis stand among the unknowns, or what they are."""

    first: int | None
    known: Array | None

    def entry(self, j: int, weight: float) -> tuple[list[int], list[float], float]:
        """Places and values of a row, and what goes to the right side, of a multiple of a position."""
        if self.first is None:
            assert self.known is not None  # noqa: S101 - one of both
            return [], [], -weight * float(self.known[j])
        return [self.first + j], [weight], 0.0

    def values(self, solved: Solved, count: int) -> Array:
        """The positions of a solution; none of one that was not found."""
        if self.first is None:
            assert self.known is not None  # noqa: S101 - one of both
            return self.known
        return solved.unknowns[self.first : self.first + count]


def _times(chains: Mapping[str, Chain], spans: Mapping[str, tuple[Array, Array]], pieces: int) -> Array:
    """Times of the nodes, and others evenly between them where there are none near by."""
    of_nodes = [time for first, last in spans.values() for times in (first, last, 0.5 * (first + last)) for time in times]
    nodes = np.unique(np.clip(np.array(of_nodes), 0.0, 1.0))
    nodes = nodes[np.concatenate([[True], np.diff(nodes) > 10.0 * SAME_NODE])]
    even = np.linspace(0.0, 1.0, pieces + 1)
    apart = np.abs(even[:, None] - nodes[None, :]).min(axis=1) > 0.35 / pieces
    return np.sort(np.concatenate([nodes, even[apart]]))


def _ways(rows: Rows, stand: Stand, place: int, count: int) -> None:
    for j in range(count - 1):
        rises, falls = stand.way(j, j + 1)
        if not falls:
            rows.add([place + j + 1, place + j], [1.0, -1.0], 0.0)
        if not rises:
            rows.add([place + j + 1, place + j], [-1.0, 1.0], 0.0)


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
        for i in np.flatnonzero(np.abs(table).max(axis=1) > 0.0):
            first, last = knots[i], knots[i + nu]
            if rests[first] is not None and rests[first] == rests[last]:
                continue
            filled = np.flatnonzero(table[i])
            scale = factorial(nu) * line.stroke / period**nu
            row = scale * table[i, filled]
            if nu == 2 and reference is not None:
                for sign in (1.0, -1.0):
                    rows.add([*(place + filled), rows.size - 1], [*(sign * row / reference), 1.0], 0.0)
            low, high = stand.limits(first, last).get(nu, (-inf, inf))
            for sign, most in ((1.0, -low), (-1.0, high)):
                if most < inf and reference is None:
                    rows.add([*(place + filled), rows.size - 1], [*(sign * row / most), 1.0], 0.0)
                elif most < inf:
                    rows.add(place + filled, sign * row / most, -1.0)


def _near_rests(
    rows: Rows, stand: Stand, place: int, times: Array, span: tuple[Array, Array], reference: float | None, period: float
) -> None:  # fmt: skip
    """Near an instant at which it rests an axis is as near to the rest as its acceleration allows."""
    line, (first, last) = stand.chain.timeline, span
    for i, node in enumerate(stand.chain.nodes):
        if node.rest is None or last[i] - first[i] <= SAME_NODE:
            continue
        for j in np.flatnonzero((times >= first[i] - SAME_NODE) & (times <= last[i] + SAME_NODE)):
            if stand.rest(int(j)) is not None:
                continue
            off = max(times[j] - first[i], last[i] - times[j])
            ends = [int(k) for k in (np.searchsorted(times, first[i] - SAME_NODE), np.searchsorted(times, last[i] + SAME_NODE, side="right") - 1)]
            low, high = stand.limits(ends[0], ends[1]).get(2, (-inf, inf))
            rises = node.place >= max(stand.chain.places[max(i - 1, 0)], node.place)
            most = max(-low, high) if reference is None else reference
            if most == inf:
                continue
            reach = 0.5 * (off * period) ** 2 * most / line.stroke
            for sign in (1.0, -1.0):
                # sign (p - place) >= -share reach
                rows.add([place + j, rows.size - 1], [sign, reach], sign * node.place)
            del rises


def _beyond(
    rows: Rows,
    visit: Visit,
    side: int,
    positions: Mapping[str, Places],
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


def _add(rows: Rows, entries: Any, side: float) -> None:  # noqa: ANN401 - what `Places.entry` gives
    places, values = [p for entry in entries for p in entry[0]], [v for entry in entries for v in entry[1]]
    rows.add(places, values, side + sum(entry[2] for entry in entries))
