"""Interlocks as conditions on chains: when an axis passes a position, and while it is between two positions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

from optlaws.cycles.coordination.timeline import Chain, Node, Timeline
from optlaws.cycles.interlocks.after import After
from optlaws.cycles.interlocks.clearance import Clearance, TableBound, bound_of
from optlaws.cycles.interlocks.forbidden_region import Forbidden, polygon_of
from optlaws.cycles.interlocks.interlock import Interlock
from optlaws.errors import InputError
from optlaws.tolerances import INSIDE_POLYGON_PART, PASS_WIDTH, SHARE_AT_REST

#: a straight part of a bound: from where to where, and its values there
Straight = tuple[float, float, float, float]


@dataclass(frozen=True, eq=False)
class Profile:
    """A bound of one axis's position over another axis's position, piecewise linear; positions as shares of strokes.

    `sign` is 1 where it is the least position, -1 where the greatest.
    """

    sign: float
    parts: tuple[Straight, ...]

    def level(self, place: float) -> float:
        """The bound at a place: the stricter of two where it jumps, and the nearest beyond its ends."""
        place = min(max(place, self.parts[0][0]), self.parts[-1][1])
        met = [self.sign * _along(part, place) for part in self.parts if part[0] <= place <= part[1]]
        return self.sign * max(met)

    def edges(self, start: float, stop: float) -> list[tuple[float, float]]:
        """Slopes and intercepts of lines that bound the other axis between two positions.

        They are the edges of its convex hull there: where it is convex it is the greatest of them.
        """
        cut = [(max(low, start), min(high, stop), part) for part in self.parts for low, high in [part[:2]]]
        points = sorted(
            {(x, self.sign * _along(part, x)) for low, high, part in cut if low <= high for x in (low, high)}
        )
        if not points:
            return []
        hull: list[tuple[float, float]] = []
        for point in points:
            if hull and point[0] == hull[-1][0]:
                continue
            while len(hull) > 1 and _turn(hull[-2], hull[-1], point) <= 0.0:
                hull.pop()
            hull.append(point)
        if len(hull) == 1:
            return [(0.0, self.sign * max(value for _, value in points))]
        slopes = [((up - low) / (high - left), left, low) for (left, low), (high, up) in pairwise(hull)]
        return [(self.sign * slope, self.sign * (low - slope * left)) for slope, left, low in slopes]

    @property
    def bends(self) -> list[float]:
        """Instants at which the chain is not convex, so that one line does not bound both sides."""
        places = []
        for (_, here, *_), (there, *_) in pairwise(self.parts):
            before, after = (part for part in self.parts if here in part[:2])
            slopes = [self.sign * (part[3] - part[2]) / (part[1] - part[0]) for part in (before, after)]
            if slopes[1] < slopes[0] or before[3] != after[2]:
                places.append(there)
        return places


@dataclass(frozen=True, eq=False)
class Visit:
    """A condition: while an axis is between two of its nodes, another axis is beyond one of its profiles.

    `between` are the nodes; of an `After` it is one node alone, and the profile has one value.
    """

    rule: Interlock
    over: str
    axis: str
    between: tuple[int, int]
    sides: tuple[Profile, ...]


@dataclass(frozen=True)
class Bent:
    """The problem: chains by the names of their axes, visits, and how many instants there are."""

    chains: Mapping[str, Chain]
    visits: tuple[Visit, ...]
    count: int


def bent(timelines: Mapping[str, Timeline], rules: Sequence[Interlock]) -> Bent:
    """The chains of axes, with a node wherever an interlock refers to an instant.

    Raises
    ------
    InputError
        If an interlock is `Synchronous`, or the bound of a `Clearance` is a formula.
    """
    profiles = [_profiles(rule, timelines) for rule in rules]
    marks: dict[str, list[list[float]]] = {name: [[] for _ in line.moves] for name, line in timelines.items()}
    for rule, sides in zip(rules, profiles, strict=True):
        over = _over(rule)
        for marked, (start, stop) in zip(marks[over], timelines[over].ways(), strict=True):
            marked.extend(place for place in _places(rule, sides, start, stop) if place not in marked)
    chains, count = dict[str, Chain](), 0
    for name, line in timelines.items():
        chains[name], count = _chain(line, marks[name], count)
    visits = [visit for rule, sides in zip(rules, profiles, strict=True) for visit in _visits(rule, sides, chains)]
    return Bent(chains, tuple(visits), count)


def _over(rule: Interlock) -> str:
    """The axis on whose position an interlock depends."""
    first, second = rule.axes
    return second if isinstance(rule, Clearance) else first


def _profiles(rule: Interlock, timelines: Mapping[str, Timeline]) -> tuple[Profile, ...]:
    first, second = (timelines[name] for name in rule.axes)
    kinds = [line.cycle.axis for line in (first, second)]
    if isinstance(rule, After):
        place, level = rule.positions({name: timelines[name].cycle for name in rule.axes})
        x, y = first.share(place), second.share(level)
        return (Profile(rule.sign, ((x, x, y, y),)),)
    if isinstance(rule, Clearance):
        bound = bound_of(rule, *kinds)
        if not isinstance(bound, TableBound):
            raise InputError(
                f"interlock {rule.label}: where laws are optimised the bound must be given as pairs, "
                "such as [('0 deg', '20 mm'), ('45 deg', '60 mm')]: give pairs, or give the moves laws"
            )
        xs, ys = [second.share(x) for x in bound.places], [first.share(y) for y in bound.values]
        xs, ys = [min(xs[0], 0.0) - 1.0, *xs, max(xs[-1], 1.0) + 1.0], [ys[0], *ys, ys[-1]]
        return (Profile(rule.sign, tuple(zip(xs, xs[1:], ys, ys[1:], strict=False))),)
    if not isinstance(rule, Forbidden):
        raise InputError(f"interlock {rule.label}: only After, Clearance and Forbidden are put together anew")
    polygon = polygon_of(rule, *kinds)
    parts: tuple[list[Straight], list[Straight]] = [], []
    for low, high in pairwise(sorted({x for x, _ in polygon.corners})):
        at = low + INSIDE_POLYGON_PART * (high - low), high - INSIDE_POLYGON_PART * (high - low)
        for known, values in zip(parts, zip(*(polygon.section(x) for x in at), strict=True), strict=True):
            slope = (values[1] - values[0]) / (at[1] - at[0])
            ends = values[0] - slope * (at[0] - low), values[1] + slope * (high - at[1])
            known.append((first.share(low), first.share(high), second.share(ends[0]), second.share(ends[1])))
    return Profile(1.0, tuple(parts[1])), Profile(-1.0, tuple(parts[0]))


def _places(rule: Interlock, sides: Sequence[Profile], start: float, stop: float) -> list[float]:
    """Nodes of a move: positions that it passes, and for a region its edge if the move leaves a dwell there."""
    low, high = min(start, stop), max(start, stop)
    if isinstance(rule, After):
        place = sides[0].parts[0][0]
        on_way = rule.way in {None, "up" if stop > start else "down"}
        return [place] if low < place < high and on_way else []
    inner = {place for side in sides for place in side.bends if low < place < high}
    if isinstance(rule, Forbidden):
        ends = sides[0].parts[0][0], sides[0].parts[-1][1]
        inner |= {place for place in ends if low <= place <= high}
    return sorted(inner)


def _chain(line: Timeline, marks: Sequence[Sequence[float]], count: int) -> tuple[Chain, int]:
    """The nodes of an axis, and the number of instants up to and including this axis."""
    if not line.bends:
        return _known_chain(line, marks), count
    last = line.rests[-1]
    places = [line.share(rest.position) for rest in line.rests]
    nodes = [Node(None, (0.0, 0.0), places[0], 0), Node(None, line.rests[0].least, places[0], 0)]
    for i, (start, stop) in enumerate(line.ways()):
        for place in sorted(marks[i], reverse=stop < start):
            nodes.append(Node(count, (0.0, 0.0), place, None))
            count += 1
        if i + 1 < len(line.moves):
            least = line.rests[i + 1].least
            nodes += [Node(count, (0.0, 0.0), stop, i + 1), Node(count, least, stop, i + 1)]
            count += 1
    end = len(line.moves)
    nodes += [
        Node(None, (-last.least[0], 1.0 - last.least[1]), places[-1], end),
        Node(None, (0.0, 1.0), places[-1], end),
    ]
    return Chain(line, tuple(nodes)), count


def _known_chain(line: Timeline, marks: Sequence[Sequence[float]]) -> Chain:
    """The nodes of an axis that moves as it did: it passes places when it does."""
    from scipy.optimize import brentq

    cycle, nodes = line.cycle, [Node(None, (0.0, 0.0), line.ways()[0][0], 0)]
    for i, (move, (start, stop)) in enumerate(zip(line.moves, line.ways(), strict=True)):
        peaks = cycle.peaks[move.segment]
        begin, end = peaks.start, peaks.start + peaks.duration
        least, most = (side[0] for side in next(p for p in cycle.pieces if p.start == begin).extremes(1, begin, end))
        if min(least * (stop - start), most * (stop - start)) < -SHARE_AT_REST * max(-least, most):
            raise InputError(f"axis {line.name}: {move.name} turns back on its way: give it a law that does not")
        nodes.append(Node(None, (begin, 0.0), start, i))
        for place in sorted(marks[i], reverse=stop < start):
            if place in {start, stop}:
                time = begin if place == start else end
            else:
                height = line.low + place * line.stroke
                time = float(brentq(lambda t, height=height: float(cycle(t)) - height, begin, end, xtol=PASS_WIDTH))
            nodes.append(Node(None, (time, 0.0), place, None))
        nodes.append(Node(None, (end, 0.0), stop, i + 1))
    return Chain(line, (*nodes, Node(None, (0.0, 1.0), nodes[-1].place, len(line.moves))))


def _visits(rule: Interlock, sides: tuple[Profile, ...], chains: Mapping[str, Chain]) -> list[Visit]:
    over = _over(rule)
    axis = next(name for name in rule.axes if name != over)
    chain = chains[over]
    if isinstance(rule, Clearance):
        return [Visit(rule, over, axis, (0, len(chain.nodes) - 1), sides)]
    passes = [i for i, node in enumerate(chain.nodes) if node.rest is None]
    if isinstance(rule, After):
        place, ways = sides[0].parts[0][0], chain.timeline.ways()
        met = []
        for i in passes:
            move = chain.owners[i]
            rises = move is not None and ways[move][1] > ways[move][0]
            if chain.places[i] == place and rule.way in {None, "up" if rises else "down"}:
                met.append(Visit(rule, over, axis, (i, i), sides))
        return met
    low, high = sides[0].parts[0][0], sides[0].parts[-1][1]
    inside = [low < (here + there) / 2.0 < high and low <= min(here, there) and max(here, there) <= high
              for here, there in pairwise(chain.places)]  # fmt: skip
    visits, start = list[Visit](), None
    for i, within in enumerate([*inside, False]):
        if within and start is None:
            start = i
        elif not within and start is not None:
            visits.append(Visit(rule, over, axis, (start, i), sides))
            start = None
    return visits


def _along(part: Straight, place: float) -> float:
    start, stop, first, last = part
    return max(first, last) if start == stop else first + (last - first) * (place - start) / (stop - start)


def _turn(first: tuple[float, float], second: tuple[float, float], third: tuple[float, float]) -> float:
    return (second[0] - first[0]) * (third[1] - first[1]) - (second[1] - first[1]) * (third[0] - first[0])
