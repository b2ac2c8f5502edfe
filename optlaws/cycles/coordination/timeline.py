"""An axis as a chain of nodes in time: rests and passes of positions, between which it moves one way."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from optlaws.cycles.interlocks.axis_plan import Spell, dwell_spell
from optlaws.cycles.interlocks.interlock import joint_positions
from optlaws.cycles.optimisation.motion_limits import both_sides, limits_of_segment, read_limits
from optlaws.cycles.specification.programme import TimedSegment, is_optimal
from optlaws.cycles.specification.segments import Dwell, Move
from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.numbers import Array
from optlaws.tolerances import SAME_NODE

#: the least and the greatest value of derivatives, by their order
Sides = Mapping[int, tuple[float, float]]

_HIGHEST = 3


@dataclass(frozen=True)
class Rest:
    """A position at which an axis rests, for how long at least, and which of its segments are dwells there."""

    position: float
    least: Spell
    dwells: tuple[int, ...]


@dataclass(frozen=True)
class BentMove:
    """A move with an optimised law: the number of its segment, its name, and its limits in SI units."""

    segment: int
    name: str
    limits: Sides


@dataclass(frozen=True)
class Timeline:
    """An axis as rests with moves between them; one more rest than moves, and at rest at both ends of the cycle.

    Attributes
    ----------
    cycle
        The cycle as it was.
    bends
        Whether laws and instants are looked for; else it moves as it did.
    """

    name: str
    cycle: Any
    rests: tuple[Rest, ...]
    moves: tuple[BentMove, ...]
    bends: bool

    @property
    def low(self) -> float:
        """The least position at which it rests."""
        return min(rest.position for rest in self.rests)

    @property
    def stroke(self) -> float:
        """Between the least and the greatest position."""
        return max(rest.position for rest in self.rests) - self.low

    def share(self, position: float) -> float:
        """A position as a share of the stroke."""
        return (position - self.low) / self.stroke

    def ways(self) -> list[tuple[float, float]]:
        """Start and end of each move, as shares of the stroke."""
        places = [self.share(rest.position) for rest in self.rests]
        return list(pairwise(places))


def timeline_of(cycle: Any, name: str, *, bends: bool) -> Timeline:  # noqa: ANN401 - a cycle
    """The timeline of a cycle of moves from rest to rest and dwells.

    Raises
    ------
    InputError
        If a segment is another one, or has a limit that is no bound of velocity, acceleration or jerk.
    """
    positions, stretches = joint_positions(cycle), cycle.programme.stretches
    rests = [Rest(positions[0], (0.0, 0.0), ())]
    moves: list[BentMove] = []
    for i, stretch in enumerate(stretches):
        where = f"axis {name}: {stretch.where}"
        if not isinstance(stretch.given, Move | Dwell):
            raise InputError(f"{where}: only moves from rest to rest and dwells are put together anew")
        if isinstance(stretch.given, Dwell):
            (seconds, share), _ = dwell_spell(stretch, where)
            last = rests[-1]
            rests[-1] = Rest(last.position, (last.least[0] + seconds, last.least[1] + share), (*last.dwells, i))
        elif stretch.displacement != 0.0:
            label = stretch.given.name or f"segment {stretch.number}"
            moves.append(BentMove(i, label, _limits(cycle, stretch, where) if bends else {}))
            rests.append(Rest(positions[i + 1], (0.0, 0.0), ()))
    if not moves:
        raise InputError(f"axis {name}: it has no move: leave it out")
    return Timeline(name, cycle, tuple(rests), tuple(moves), bends)


def bends_at(cycle: Any) -> bool:  # noqa: ANN401 - a cycle
    """Whether the laws of all moves of a cycle are optimised, each from rest to rest."""
    moves = [stretch.given for stretch in cycle.programme.stretches if isinstance(stretch.given, Move)]
    still = all(move.start_velocity is None and move.end_velocity is None for move in moves)
    known = all(isinstance(stretch.given, Move | Dwell) for stretch in cycle.programme.stretches)
    return known and still and bool(moves) and all(map(is_optimal, moves))


def _limits(cycle: Any, stretch: TimedSegment, where: str) -> Sides:  # noqa: ANN401
    limits = both_sides(limits_of_segment(stretch, read_limits(cycle.limits, cycle.axis, "limits"), cycle.axis))
    for nu in limits:
        if not 0 < nu <= _HIGHEST:
            raise InputError(
                f"{where}: where laws are optimised, limits must be those of velocity, acceleration and "
                "jerk: leave other limits out, or give the moves laws"
            )
    return limits


@dataclass(frozen=True)
class Node:
    """A time of a chain: a duration after an unknown instant, or after the start of the cycle.

    `rest` is the number of the rest that begins or ends there, None where a position is passed.
    """

    instant: int | None
    after: Spell
    place: float
    rest: int | None


@dataclass(frozen=True, eq=False)
class Chain:
    """The nodes of an axis in the order of time, positions as shares of the stroke; each rest has two."""

    timeline: Timeline
    nodes: tuple[Node, ...]

    @kept_property
    def places(self) -> Array:
        """Positions of the nodes as shares of the stroke."""
        return np.array([node.place for node in self.nodes])

    @kept_property
    def owners(self) -> tuple[int | None, ...]:
        """The move between each node and the next; none within a rest."""
        pairs, owners, move = zip(self.nodes, self.nodes[1:], strict=False), list[int | None](), -1
        for here, after in pairs:
            if here.rest is not None and here.rest == after.rest:
                owners.append(None)
                continue
            move += here.rest is not None
            owners.append(move)
        return tuple(owners)

    def times(self, low: Array, high: Array, period: float) -> tuple[Array, Array]:
        """The earliest and the latest time of each node as shares of the period, of instants within a box."""
        after = np.array([node.after[0] / period + node.after[1] for node in self.nodes])
        places = [node.instant for node in self.nodes]
        first = after + [0.0 if place is None else low[place] for place in places]
        last = after + [0.0 if place is None else high[place] for place in places]
        return np.maximum.accumulate(first), np.minimum.accumulate(last[::-1])[::-1]


@dataclass(frozen=True, eq=False)
class Stand:
    """Between which nodes an axis may be at each of some times: the last that is over, the first to come."""

    chain: Chain
    after: Array
    before: Array

    @classmethod
    def at(cls, chain: Chain, first: Array, last: Array, times: Array) -> Stand:
        """Positions of the axis at given times, with nodes at their earliest and at their latest."""
        after = np.searchsorted(last, times + SAME_NODE, side="right") - 1
        before = np.searchsorted(first, times - SAME_NODE, side="left")
        return cls(chain, np.clip(after, 0, len(first) - 1), np.clip(before, 0, len(first) - 1))

    def hull(self, j: int) -> tuple[float, float]:
        """The least and the greatest position at a time."""
        start, stop = int(self.after[j]), int(self.before[j])
        among = self.chain.places[start : stop + 1] if start < stop else self.chain.places[start : start + 1]
        return float(among.min()), float(among.max())

    def way(self, i: int, j: int) -> tuple[bool, bool]:
        """Whether the axis may rise, and whether it may fall, between two times."""
        steps = np.diff(self.chain.places[self.after[i] : max(self.before[j], self.after[i]) + 1])
        return bool((steps > 0.0).any()), bool((steps < 0.0).any())

    def rest(self, j: int) -> int | None:
        """The rest at which the axis surely is at a time."""
        here, there = (self.chain.nodes[int(places[j])].rest for places in (self.after, self.before))
        return here if here == there else None

    def limits(self, i: int, j: int) -> Sides:
        """The widest limits of the moves that may be on between two times; none where the axis rests."""
        owners = self.chain.owners[int(self.after[i]) : max(int(self.before[j]), int(self.after[i]))]
        given = [self.chain.timeline.moves[move].limits for move in dict.fromkeys(owners) if move is not None]
        orders = set[int].intersection(*(set(limits) for limits in given)) if given else set[int]()
        return {nu: (min(each[nu][0] for each in given), max(each[nu][1] for each in given)) for nu in orders}
