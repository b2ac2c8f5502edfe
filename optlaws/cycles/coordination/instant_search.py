"""The search for the instants of laws that bend: boxes of instants, each with its bound, parted where it says most."""

from __future__ import annotations

import heapq
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import count
from math import inf
from typing import Any

import numpy as np

from optlaws.cycles.coordination.bent_laws import BentAxis, BentLaws, bent_laws
from optlaws.cycles.coordination.passages import Bent, Visit, bent
from optlaws.cycles.coordination.relaxation import Box, Goal, Relaxed, relaxed
from optlaws.cycles.coordination.timeline import Chain, timeline_of
from optlaws.cycles.interlocks.interlock import Interlock
from optlaws.errors import InfeasibleProblem, InputError
from optlaws.numbers import Array
from optlaws.tolerances import BENT_GAP, BROKEN_RULE, NARROWEST_INSTANT

_PIECES, _FINE = 32, 96
_NODES = 400
_LEAST_STEP = 1e-4


@dataclass(frozen=True)
class BestBent:
    """What the axes do by the laws found, the period, the bound of the objective, and how many boxes were looked at."""

    axes: Mapping[str, BentAxis]
    period: float
    bound: float
    nodes: int


@dataclass(frozen=True)
class _Node:
    box: Box
    bound: float
    relaxed: Relaxed | None


@dataclass(eq=False)
class _Search:
    """The objective is the period, where none is given, or the greatest share of accelerations."""

    bent: Bent
    goal: Goal
    period: float | None
    scale: float
    best: tuple[float, float, BentLaws] | None = None

    def nodes(self) -> tuple[int, float]:
        """Part boxes, that of the least bound first; how many were looked at, and the bound of all."""
        number = count()
        whole = Box(np.zeros(self.bent.count), np.ones(self.bent.count), self._sides())
        root = self._node(whole, 0.0 if self.period is not None else self._shortest(whole))
        if root is None:
            return 0, inf
        heap, looked_at, closed = [(root.bound, next(number), root)], 1, inf
        while heap:
            bound, _, node = heapq.heappop(heap)
            if self.best is not None and bound >= self.best[0] * (1.0 - BENT_GAP):
                return looked_at, min(bound, closed)
            self._try(node)
            parts = list(self._parts(node))
            if not parts:
                closed = min(closed, node.bound)
            for part in parts:
                looked_at += 1
                inner = self._node(part, node.bound)
                if inner is not None:
                    heapq.heappush(heap, (inner.bound, next(number), inner))
            if looked_at > _NODES:
                return looked_at, min([closed, *(open_[0] for open_ in heap)])
        return looked_at, closed

    def _sides(self) -> tuple[int | None, ...]:
        return tuple(0 if len(visit.sides) == 1 else None for visit in self.bent.visits)

    def _shortest(self, box: Box) -> float:
        """A period that no laws keep: a quarter of those that the relaxation allows, again and again."""
        period = self.scale
        while True:
            known = relaxed(self.bent, box, self.goal, period, _PIECES)
            if known is None or known.bound > 1.0:
                return period
            period *= 0.5 * max(known.bound, 1e-6) ** 0.5

    def _node(self, box: Box, bound: float) -> _Node | None:
        """The box with its bound, at least that of the box it is part of; None where it has no laws."""
        if self.period is not None:
            known = relaxed(self.bent, box, self.goal, self.period, _PIECES)
            return None if known is None else _Node(box, max(bound, known.bound), known)
        period, known, power = bound, None, 2.0
        for _ in range(8):
            here = relaxed(self.bent, box, self.goal, period * (1.0 + _LEAST_STEP), _PIECES)
            if here is not None and here.bound <= 1.0:
                return _Node(box, period, here)
            # laws need more than this period
            period *= 1.0 + _LEAST_STEP
            longer = 2.0 if here is None else here.bound ** (1.0 / power)
            while True:
                known = relaxed(self.bent, box, self.goal, period * longer, _PIECES)
                if known is None or known.bound > 1.0:
                    period *= longer
                    break
                if longer < 1.0 + _LEAST_STEP:
                    break
                longer = 1.0 + 0.5 * (longer - 1.0)
            if period > 1e3 * self.scale:
                return None
        return _Node(box, period, known)

    def _try(self, node: _Node) -> None:
        """Laws at the instants that the relaxation suggests, if they are better than those known."""
        if node.relaxed is None or not all(len(p) for p in node.relaxed.positions.values()):
            return
        instants = self._suggested(node)
        sides = tuple(self._side(visit, node, i) for i, visit in enumerate(self.bent.visits))
        if self.period is not None:
            laws = bent_laws(self.bent, instants, sides, self.goal, self.period, _FINE)
            if laws is not None and (self.best is None or laws.share < self.best[0]):
                self.best = laws.share, self.period, laws
            return
        period = node.bound
        for _ in range(6):
            laws = bent_laws(self.bent, instants, sides, self.goal, period, _FINE)
            if laws is None:
                period *= 1.2
                continue
            if laws.share <= 1.0 + _LEAST_STEP:
                if self.best is None or period < self.best[0]:
                    self.best = period, period, laws
                return
            period *= min(laws.share, 4.0) ** 0.5
            if self.best is not None and period > self.best[0]:
                return

    def _suggested(self, node: _Node) -> Array:
        """When the positions of the relaxation pass each node, within the box."""
        assert node.relaxed is not None  # noqa: S101 - its caller looked
        box, times = node.box, node.relaxed.times
        period = self.period or node.bound
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
        """The side that is chosen, or the one that the relaxation breaks less."""
        chosen = node.box.sides[i]
        if chosen is not None:
            return chosen
        off = [max(self._broken(visit, side, node), default=(0.0, 0, 0.0))[0] for side in range(len(visit.sides))]
        return int(np.argmin(off))

    def _broken(self, visit: Visit, side: int, node: _Node) -> Iterator[tuple[float, int, float]]:
        """By how much the positions of the relaxation break a visit when each node is reached, and between nodes."""
        assert node.relaxed is not None  # noqa: S101 - its caller looked
        times, profile = node.relaxed.times, visit.sides[side]
        x, y = (node.relaxed.positions[name] for name in (visit.over, visit.axis))
        chain = self.bent.chains[visit.over]
        first, last = chain.times(node.box.low, node.box.high, self.period or node.bound)
        places, spans = chain.places, []
        for i in range(visit.between[0], visit.between[1] + 1):
            time = _reached(x, times, float(places[i]), first[i], last[i])
            spans.append(time)
            level = profile.level(float(places[i]))
            yield profile.sign * (level - float(np.interp(time, times, y))), i, time
        for i, (start, stop) in enumerate(zip(spans, spans[1:], strict=False)):
            k = visit.between[0] + i
            for j in np.flatnonzero((times > start) & (times < stop)):
                for slope, value in profile.edges(*sorted((float(places[k]), float(places[k + 1])))):
                    off = profile.sign * (slope * x[j] + value - y[j])
                    wider = k if last[k] - first[k] > last[k + 1] - first[k + 1] else k + 1
                    yield off, wider, float(times[j])

    def _parts(self, node: _Node) -> Iterator[Box]:
        """The box parted: by the side of a region, or at an instant that says most."""
        if node.relaxed is None or not all(len(p) for p in node.relaxed.positions.values()):
            yield from self._halved(node.box, int(np.argmax(node.box.high - node.box.low)), None)
            return
        box, worst = node.box, (BROKEN_RULE, -1, 0.0)
        undecided, most = -1, BROKEN_RULE
        for i, visit in enumerate(self.bent.visits):
            if box.sides[i] is None:
                off = max(self._broken(visit, self._side(visit, node, i), node), default=(0.0, 0, 0.0))[0]
                if off > most:
                    undecided, most = i, off
        if undecided >= 0:
            for side in range(len(self.bent.visits[undecided].sides)):
                sides = (*box.sides[:undecided], side, *box.sides[undecided + 1 :])
                yield replace(box, sides=sides)
            return
        for i, visit in enumerate(self.bent.visits):
            for off, place, time in self._broken(visit, self._side(visit, node, i), node):
                for instant in self._near(visit, place, time, box):
                    if off > worst[0]:
                        worst = off, instant, time
        for off, instant, time in self._restless(node):
            if off > worst[0] and box.high[instant] - box.low[instant] > NARROWEST_INSTANT:
                worst = off, instant, time
        if worst[1] >= 0:
            yield from self._halved(box, worst[1], worst[2])

    def _near(self, visit: Visit, place: int, time: float, box: Box) -> list[int]:
        """The instant to part where a node is reached too early or too late: of the axis, or of the other's rest."""
        known = [self.bent.chains[visit.over].nodes[place].instant]
        wide = [i for i in known if i is not None and box.high[i] - box.low[i] > NARROWEST_INSTANT]
        if wide:
            return wide
        others = {node.instant for node in self.bent.chains[visit.axis].nodes if node.instant is not None}
        wide = [i for i in others if box.high[i] - box.low[i] > NARROWEST_INSTANT]
        return sorted(wide, key=lambda i: abs(0.5 * (box.low[i] + box.high[i]) - time))[:1]

    def _restless(self, node: _Node) -> Iterator[tuple[float, int, float]]:
        """By how much the positions of the relaxation miss each rest, or do not stay there."""
        assert node.relaxed is not None  # noqa: S101 - its caller looked
        times, period = node.relaxed.times, self.period or node.bound
        for name, chain in self.bent.chains.items():
            positions = node.relaxed.positions[name]
            first, last = chain.times(node.box.low, node.box.high, period)
            for i, (here, after) in enumerate(zip(chain.nodes, chain.nodes[1:], strict=False)):
                if here.instant is None or here.rest is None or after.rest != here.rest:
                    continue
                time = _reached(positions, times, here.place, first[i], last[i])
                stay = np.linspace(time, time + after.after[0] / period + after.after[1], 5)
                off = float(np.abs(np.interp(stay, times, positions) - here.place).max())
                yield off, here.instant, time

    def _halved(self, box: Box, instant: int, time: float | None) -> Iterator[Box]:
        low, high = float(box.low[instant]), float(box.high[instant])
        if high - low <= NARROWEST_INSTANT:
            return
        cut = 0.5 * (low + high)
        if time is not None and low + 0.1 * (high - low) < time < high - 0.1 * (high - low):
            cut = time
        for start, stop in ((low, cut), (cut, high)):
            lows, highs = box.low.copy(), box.high.copy()
            lows[instant], highs[instant] = start, stop
            yield Box(lows, highs, box.sides)


def _reached(positions: Array, times: Array, place: float, first: float, last: float) -> float:
    """When a motion first is at a place between two times, or is nearest to it."""
    inner = (times > first) & (times < last)
    at = np.concatenate([[first], times[inner], [last]])
    off = np.interp(at, times, positions) - place
    crossed = np.flatnonzero(off[:-1] * off[1:] <= 0.0)
    if not crossed.size:
        return float(at[np.abs(off).argmin()])
    j = int(crossed[0])
    width = abs(off[j]) + abs(off[j + 1])
    return float(at[j] + (at[j + 1] - at[j]) * (abs(off[j]) / width if width > 0.0 else 0.0))


def best_bent(cycles: Mapping[str, Any], rules: Sequence[Interlock], goal: str, longer: Sequence[str]) -> BestBent:
    """Laws and instants of the least period, or of the least acceleration of some axes in the period they have.

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

    def search(of: Sequence[Interlock]) -> tuple[_Search, int, float]:
        known = _Search(bent(timelines, of), Goal(references), None if goal == "period" else duration, duration)
        return known, *known.nodes()

    found, nodes, bound = search(rules)
    if found.best is None:
        raise InfeasibleProblem(_contradiction(rules, search))
    _, period, laws = found.best
    return BestBent(laws.axes, period, min(bound, found.best[0]), nodes)


def _contradiction(rules: Sequence[Interlock], search: Any) -> str:  # noqa: ANN401 - a function
    """The interlocks without any of which there are laws."""
    if search(())[0].best is None:
        return "the moves and dwells alone take longer than the period: give a longer one, or looser limits"
    named = [rule.label for rule in rules if search([each for each in rules if each is not rule])[0].best is not None]
    listed = "; ".join(named or [rule.label for rule in rules])
    return f"no laws keep all interlocks: {listed}: change a position of one of them, or give a longer period"
