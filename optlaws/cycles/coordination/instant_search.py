"""The search for instants of laws that bend: boxes of instants with bounds, split where the split is most useful."""

from __future__ import annotations

import heapq
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import count, pairwise
from math import inf
from typing import Any

import numpy as np

from optlaws.cycles.coordination.bent_laws import BentAxis, BentLaws, bent_laws
from optlaws.cycles.coordination.passages import Bent, Visit, bent
from optlaws.cycles.coordination.relaxation import Goal, InstantBox, Relaxed, relaxed
from optlaws.cycles.coordination.timeline import Timeline, timeline_of
from optlaws.cycles.interlocks.interlock import Interlock
from optlaws.errors import InfeasibleProblem, InputError
from optlaws.numbers import Array
from optlaws.tolerances import (
    BENT_GAP,
    BROKEN_RULE,
    LAST_STEP_OF_INSTANTS,
    NARROW_BOX,
    NARROWEST_INSTANT,
    NEAR_NODE,
    OVERLAP_GAP,
    SAME_NODE,
)

#: pieces of the cycle by the width of the widest instant
_PIECES = ((4e-3, 96), (3e-2, 64), (2.0, 32))
_ROUGH, _FINE, _FINEST = 48, 96, 288
_NODES = 60
_PERIODS, _STEPS = 6, 12
_ROUGH_NODES = 30  # where laws are looked for without one of the interlocks
_FIRST_STEP = 0.02  # of a period: by how much instants are first moved to find better ones
_PLACES = 4001
_TRIED_CUTS = 2
_SAME = BENT_GAP


@dataclass(frozen=True)
class BestBent:
    """The best motions of the axes, their period, the bound of the objective, and the number of boxes examined."""

    axes: Mapping[str, BentAxis]
    period: float
    bound: float
    nodes: int


@dataclass(frozen=True)
class _Node:
    """A box of instants, the proven lower bound of the share in it, and the relaxation that proves the bound."""

    box: InstantBox
    bound: float
    relaxed: Relaxed
    pieces: int


@dataclass(eq=False)
class _BoxSearch:
    """Laws of the least share, of limits or of accelerations, in a period.

    `enough` is a share from which on boxes are of no use.
    """

    bent: Bent
    goal: Goal
    period: float
    enough: float = inf
    gap: float = BENT_GAP
    best: BentLaws | None = None
    nodes: int = 0
    tried: list[tuple[Array, tuple[int, ...]]] = field(default_factory=list)

    @property
    def most(self) -> float:
        """The share that laws have to be below."""
        return min(self.enough, inf if self.best is None else self.best.share * (1.0 - self.gap))

    def search(self, most: int) -> float:
        """Split boxes, the box of least bound first, and return the bound of the share over all boxes."""
        number, heap, closed = count(), list[tuple[float, int, _Node]](), inf
        sides = tuple(0 if len(visit.sides) == 1 else None for visit in self.bent.visits)
        root = self._node(InstantBox(np.zeros(self.bent.count), np.ones(self.bent.count), sides), 0.0)
        if root is not None:
            heap.append((root.bound, next(number), root))
        while heap and heap[0][0] < self.most and self.nodes < most:
            bound, _, node = heapq.heappop(heap)
            self._try(node)
            parts = self._parts(node)
            if parts is None:
                closed = min(closed, bound)
                continue
            for part in parts:
                heapq.heappush(heap, (part.bound, next(number), part))
        return min([closed, self.most, *(open_[0] for open_ in heap[:1])])

    def _node(self, box: InstantBox, bound: float, pieces: int = 0) -> _Node | None:
        """The box with its bound, at least the bound of its parent box; None where the box has no laws."""
        self.nodes += 1
        pieces = max(pieces, next(pieces for most, pieces in _PIECES if (box.high - box.low).max(initial=0.0) <= most))
        known = relaxed(self.bent, box, replace(self.goal, most=self.most), self.period, pieces)
        return None if known is None else _Node(box, max(bound, known.bound), known, pieces)

    def _try(self, node: _Node) -> None:
        """Laws at the instants that the relaxation suggests, if they are better than those known."""
        if not node.relaxed.times.size:
            return
        instants = self._suggested(node)
        sides = tuple(self._side(visit, node, i) for i, visit in enumerate(self.bent.visits))
        if any(
            way == sides and np.abs(instants - known).max(initial=0.0) < LAST_STEP_OF_INSTANTS
            for known, way in self.tried
        ):
            return
        self.tried.append((instants, sides))
        laws = self.at(instants, sides, self.period, _ROUGH)
        if laws is not None and (self.best is None or laws.share < self.best.share):
            self.best = self._nearby(laws)

    def at(self, instants: Array, sides: tuple[int, ...], period: float, pieces: int) -> BentLaws | None:
        """The laws at instants in a period."""
        return bent_laws(self.bent, instants, sides, self.goal, period, pieces)

    def begin(self, cycles: Mapping[str, Any]) -> None:
        """Start from the instants of cycles that keep all interlocks, and from better instants nearby."""
        self.period = next(iter(cycles.values())).duration
        instants = np.full(self.bent.count, 0.5)
        times = np.linspace(0.0, 1.0, _PLACES)
        positions = {}
        for name, chain in self.bent.chains.items():
            line, cycle = chain.timeline, cycles[name]
            positions[name] = (cycle(np.minimum(times, 1.0 - SAME_NODE) * self.period) - line.low) / line.stroke
            before = 0.0
            for node, after in zip(chain.nodes, chain.nodes[1:], strict=False):
                if node.instant is not None and (node.rest is None or node.rest == after.rest):
                    instants[node.instant] = before = _reached(positions[name], times, node.place, before, 1.0)
        sides = []
        for visit in self.bent.visits:
            first, last = self.bent.chains[visit.over].times(instants, instants, self.period)
            middle = 0.5 * (first[visit.between[0]] + last[visit.between[1]])
            x, y = (float(np.interp(middle, times, positions[name])) for name in (visit.over, visit.axis))
            off = [each.sign * (each.level(x) - y) for each in visit.sides]
            sides.append(int(np.argmin(off)))
        laws = self.at(instants, tuple(sides), self.period, _ROUGH)
        self.best = None if laws is None else self._nearby(laws)

    def _nearby(self, laws: BentLaws) -> BentLaws:
        """Better laws at instants near given ones: each instant is moved by smaller and smaller steps."""
        step = _FIRST_STEP
        while step > LAST_STEP_OF_INSTANTS:
            before = laws.share
            for i in range(self.bent.count):
                for way in (step, -step):
                    instants = laws.instants.copy()
                    instants[i] += way
                    other = self.at(instants, laws.sides, self.period, _ROUGH)
                    if other is not None and other.share < laws.share:
                        laws = other
                        break
            if laws.share > before * (1.0 - BENT_GAP):
                step *= 0.4
        fine = self.at(laws.instants, laws.sides, self.period, _FINE)
        return laws if fine is None or fine.share > laws.share else fine

    def _suggested(self, node: _Node) -> Array:
        """When the positions of the relaxation pass each node, within the box."""
        box, times = node.box, node.relaxed.times
        period = self.period
        instants = 0.5 * (box.low + box.high)
        for name, chain in self.bent.chains.items():
            positions = node.relaxed.positions[name]
            first, last = chain.times(box.low, box.high, period)
            before = 0.0
            for i, each in enumerate(chain.nodes):
                spell = each.after[0] / period + each.after[1]
                if each.instant is None or (each.rest is not None and i and chain.nodes[i - 1].instant == each.instant):
                    before = max(before, spell if each.instant is None else instants[each.instant] + spell)
                    continue
                time = _reached(positions, times, each.place, max(first[i], before), last[i])
                instants[each.instant] = before = min(max(time, before, first[i]), last[i])
        return instants

    def _side(self, visit: Visit, node: _Node, i: int) -> int:
        """The chosen side, or the side that the relaxation violates less."""
        chosen = node.box.sides[i]
        if chosen is not None:
            return chosen
        off = [max(self._broken(visit, side, node), default=(0.0, 0, 0.0))[0] for side in range(len(visit.sides))]
        return int(np.argmin(off))

    def _broken(self, visit: Visit, side: int, node: _Node) -> Iterator[tuple[float, int, float]]:
        """The amount by which positions of the relaxation violate a visit, at nodes and between them."""
        times, profile = node.relaxed.times, visit.sides[side]
        x, y = (node.relaxed.positions[name] for name in (visit.over, visit.axis))
        chain = self.bent.chains[visit.over]
        first, last = chain.times(node.box.low, node.box.high, self.period)
        places, spans = chain.places, []
        for i in range(visit.between[0], visit.between[1] + 1):
            time = _reached(x, times, float(places[i]), first[i], last[i])
            spans.append(time)
            level = profile.level(float(places[i]))
            yield profile.sign * (level - float(np.interp(time, times, y))), i, time
        for i, (start, stop) in enumerate(pairwise(spans)):
            k = visit.between[0] + i
            for j in np.flatnonzero((times > start) & (times < stop)):
                for slope, value in profile.edges(*sorted((float(places[k]), float(places[k + 1])))):
                    off = profile.sign * (slope * x[j] + value - y[j])
                    wider = k if last[k] - first[k] > last[k + 1] - first[k + 1] else k + 1
                    yield off, wider, float(times[j])

    def _parts(self, node: _Node) -> list[_Node] | None:
        """The box split by the side of a region, or at the most useful instant; None if no split helps."""
        box = node.box
        if not node.relaxed.times.size:
            widest = int(np.argmax(box.high - box.low))
            return self._nodes(_halved(box, widest, None), node.bound)
        for i, visit in enumerate(self.bent.visits):
            off = max(self._broken(visit, self._side(visit, node, i), node), default=(0.0, 0, 0.0))[0]
            if box.sides[i] is None and off > BROKEN_RULE:
                ways = [(*box.sides[:i], side, *box.sides[i + 1 :]) for side in range(len(visit.sides))]
                return self._nodes([replace(box, sides=way) for way in ways], node.bound)
        worst: dict[int, tuple[float, float]] = {}
        for off, instant, time in (*self._late(node), *self._restless(node)):
            if off > max(BROKEN_RULE, worst.get(instant, (0.0, 0.0))[0]):
                worst[instant] = off, time
        widths = box.high - box.low
        first = sorted(worst, key=lambda instant: -widths[instant] * worst[instant][0])[:_TRIED_CUTS]
        cuts = [self._nodes(_halved(box, instant, worst[instant][1]), node.bound) for instant in first]
        if not cuts:
            # nothing is broken: what is left is owed to the pieces, then to the width of the box
            widest = int(np.argmax(widths)) if widths.size else -1
            if node.pieces < _FINE:
                return self._nodes([box], node.bound, 2 * node.pieces)
            if widest < 0 or widths[widest] <= NARROW_BOX:
                return None
            return self._nodes(_halved(box, widest, None), node.bound, node.pieces)
        # where the bound of the worse part is greatest, then that of the better one
        return max(cuts, key=lambda parts: sorted([*(part.bound for part in parts), inf, inf])[:2])

    def _nodes(self, boxes: Iterable[InstantBox], bound: float, pieces: int = 0) -> list[_Node]:
        return [node for node in (self._node(box, bound, pieces) for box in boxes) if node is not None]

    def _late(self, node: _Node) -> Iterator[tuple[float, int, float]]:
        """The amounts by which visits are violated, with the instant at which to split the box."""
        for i, visit in enumerate(self.bent.visits):
            for off, place, time in self._broken(visit, self._side(visit, node, i), node):
                yield from ((off, instant, time) for instant in self._near(visit, place, time, node.box))

    def _near(self, visit: Visit, place: int, time: float, box: InstantBox) -> list[int]:
        """The instant to part where a node is reached too early or too late: of the axis, or of the other's rest."""
        known = [self.bent.chains[visit.over].nodes[place].instant]
        wide = [i for i in known if i is not None and box.high[i] - box.low[i] > NARROWEST_INSTANT]
        if wide:
            return wide
        others = {node.instant for node in self.bent.chains[visit.axis].nodes if node.instant is not None}
        wide = [i for i in others if box.high[i] - box.low[i] > NARROWEST_INSTANT]
        return sorted(wide, key=lambda i: abs(0.5 * (box.low[i] + box.high[i]) - time))[:1]

    def _restless(self, node: _Node) -> Iterator[tuple[float, int, float]]:
        """The amount by which positions of the relaxation miss each dwell, or leave it too early."""
        times, period = node.relaxed.times, self.period
        for name, chain in self.bent.chains.items():
            positions = node.relaxed.positions[name]
            first, last = chain.times(node.box.low, node.box.high, period)
            for i, (here, after) in enumerate(zip(chain.nodes, chain.nodes[1:], strict=False)):
                if here.instant is None or here.rest is None or after.rest != here.rest:
                    continue
                time = _reached(positions, times, here.place, first[i], last[i])
                stay = np.linspace(time, time + after.after[0] / period + after.after[1], 5)
                off = float(np.abs(np.interp(stay, times, positions) - here.place).max())
                if node.box.high[here.instant] - node.box.low[here.instant] > NARROWEST_INSTANT:
                    yield off, here.instant, time


def _halved(box: InstantBox, instant: int, time: float | None) -> Iterator[InstantBox]:
    """The box split at a given time of an instant, or in its middle where the time is near an end."""
    low, high = float(box.low[instant]), float(box.high[instant])
    cut = 0.5 * (low + high)
    if time is not None and low + 0.2 * (high - low) < time < high - 0.2 * (high - low):
        cut = time
    for start, stop in ((low, cut), (cut, high)):
        lows, highs = box.low.copy(), box.high.copy()
        lows[instant], highs[instant] = start, stop
        yield InstantBox(lows, highs, box.sides)


def _reached(positions: Array, times: Array, place: float, first: float, last: float) -> float:
    """When a motion first is at a place between two times, or is nearest to it."""
    inner = (times > first) & (times < last)
    at = np.concatenate([[first], times[inner], [last]])
    off = np.interp(at, times, positions) - place
    crossed = np.flatnonzero(off[:-1] * off[1:] <= 0.0)
    if not crossed.size:
        near = np.abs(off) <= np.abs(off).min() + NEAR_NODE
        return float(0.5 * (at[near][0] + at[near][-1]))
    j = int(crossed[0])
    width = abs(off[j]) + abs(off[j + 1])
    return float(at[j] + (at[j + 1] - at[j]) * (abs(off[j]) / width if width > 0.0 else 0.0))


def best_bent(
    cycles: Mapping[str, Any],
    rules: Sequence[Interlock],
    goal: str,
    longer: Sequence[str],
    start: Mapping[str, Any] | None,
) -> BestBent:
    """Laws and instants of the least period, or of the least acceleration of some axes in the period they have.

    The search begins with the instants of cycles that keep the interlocks, where such are known.

    Raises
    ------
    InputError
        If a segment or a limit is of another kind, or nothing limits the least period.
    InfeasibleProblem
        If no laws keep all interlocks; the error names those that contradict each other.
    """
    timelines = {name: timeline_of(cycle, name, bends=name in longer) for name, cycle in cycles.items()}
    duration = next(iter(cycles.values())).duration
    references = {name: cycles[name].peak(2) for name in longer} if goal == "acceleration" else {}
    if goal == "period":
        for line in timelines.values():
            for move in line.moves:
                if not {2, 3} & set(move.limits):
                    raise InputError(f"axis {line.name}: {move.name} needs a limit of its acceleration or its jerk")

    known = _BoxSearch(bent(timelines, rules), Goal(references), duration)
    if start is not None:
        known.begin(start)
    if goal == "period":
        limited = {nu for line in timelines.values() for move in line.moves for nu in move.limits}
        best = _shortest(known, min(limited))
    else:
        bound = known.search(_NODES)
        laws = None if known.best is None else _polished(known, known.best)
        best = None if laws is None else BestBent(laws.axes, duration, min(bound, laws.share), known.nodes)
    if best is None:
        raise InfeasibleProblem(_contradiction(timelines, rules, known))
    return best


def _shortest(first: _BoxSearch, slowest: int) -> BestBent | None:
    """Laws of the least period, and a bound of it; None where the search has none.

    Of the instants that are known the period is shortened until the limits are met. Then all laws in a period that is
    shorter by the gap are looked for: none keep the limits, or a law played slower by a factor, which has less of every
    limit by the factor to the power of the slowest at least, says by how much the period may be less.
    """
    nodes, search = 0, first
    for _ in range(_PERIODS):
        if search.best is not None:
            search = _met(search)
        short = 1.0 - BENT_GAP if search.best is not None and search.best.share <= 1.0 else 1.0
        most = inf if search.best is None else 1.0
        proof = replace(search, period=search.period * short, enough=most, best=None, nodes=0, tried=[])
        share = proof.search(_NODES)
        nodes += proof.nodes
        if proof.best is not None and proof.best.share <= most:
            search = proof
        elif search.best is not None:
            bound = proof.period * min(share, 1.0) ** (1.0 / slowest)
            finest = _met(replace(search, best=_polished(search, search.best)), _FINEST)
            best = finest if finest.best is not None and finest.best.share <= 1.0 else search
            assert best.best is not None  # noqa: S101 - of laws that are known
            # where no shorter laws were met within the limits, those that are known are played slower until they are
            slower = (1.0 + OVERLAP_GAP) * max(1.0, best.best.share) ** (1.0 / slowest)
            axes = {name: axis.slower(slower) for name, axis in best.best.axes.items()}
            return BestBent(axes, best.period * slower, min(bound, best.period), nodes)
        else:
            search = replace(first, period=2.0 * search.period, tried=[])
    return None


def _polished(search: _BoxSearch, laws: BentLaws) -> BentLaws:
    """The laws at the same instants in more pieces."""
    finest = search.at(laws.instants, laws.sides, search.period, _FINEST)
    return laws if finest is None or finest.share > laws.share else finest


def _met(search: _BoxSearch, pieces: int = 0) -> _BoxSearch:
    """The search in the period in which the laws at the best instants just keep the limits."""
    best, low, high = search, 0.0, inf
    feasible: _BoxSearch | None = None
    for _ in range(_STEPS):
        share = inf if best.best is None else best.best.share
        if share <= 1.0:
            feasible, high = best, best.period
        else:
            low = best.period
        if 1.0 - 0.5 * _SAME <= share <= 1.0 or high - low <= 0.1 * BENT_GAP * high:
            break
        known = best if best.best is not None else feasible or search
        assert known.best is not None  # noqa: S101 - of laws that are known
        period = known.period * (known.best.share * (1.0 + 0.3 * BENT_GAP)) ** 0.45
        if not low < period < high:
            period = 0.5 * (low + high) if high < inf else 1.5 * low
        laws = best.at(known.best.instants, known.best.sides, period, pieces or _FINE)
        if laws is not None and not pieces:
            laws = replace(best, period=period)._nearby(laws)  # noqa: SLF001
        best = replace(best, period=period, best=laws or None)
    return feasible or search


def _contradiction(timelines: Mapping[str, Timeline], rules: Sequence[Interlock], known: _BoxSearch) -> str:
    """The interlocks without any of which there are laws."""

    def has_laws(of: Sequence[Interlock]) -> bool:
        other = replace(known, bent=bent(timelines, of), best=None, nodes=0, gap=1.0, tried=[])
        other.search(_ROUGH_NODES)
        return other.best is not None

    if not has_laws(()):
        return "the moves and dwells alone take longer than the period: give a longer one, or looser limits"
    named = [rule.label for rule in rules if has_laws([each for each in rules if each is not rule])]
    listed = "; ".join(named or [rule.label for rule in rules])
    return f"no laws keep all interlocks: {listed}: change a position of one of them, or give a longer period"
