"""Instants of moves that overlap as far as interlocks let them: linear programs, branched over who waits for whom.

With laws that keep their shape, the time at which an axis passes a position is the sum of the durations before it and a
known share of its move's. So an interlock that says around which rest of the other axis a pass lies is linear in the
durations. What is left open, around which rest and on which side, is branched over: programs without a choice are
relaxations, and bound all choices. Regions and bounds that are functions hold at every position: rows are added where a
solution breaks them, until none does.
"""

from __future__ import annotations

import heapq
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import count
from math import inf
from typing import Any

import numpy as np

from optlaws.cycles.axes.enclosed import SimplePolygon, at_positions
from optlaws.cycles.axes.interlock import After, Clearance, Forbidden, Interlock
from optlaws.cycles.axes.planned_axes import NOTHING, AxisPlan, PlannedSegment, Way, planned
from optlaws.cycles.cycle import Cycle
from optlaws.errors import InfeasibleProblem, InputError, SolverFailure
from optlaws.formulas.tree import Table
from optlaws.kept import kept_property
from optlaws.numbers import Array

_BROKEN_INSTANT = 1e-11  # of a period: by so much an instant may come too early, as programs are solved

_LP_FEASIBILITY = 1e-10  # of a period: by so much the solver of programs of instants may break a row
_BROKEN_PLACE = 3e-10  # of a period: the same between the places that programs know
_INSTANT_MARGIN = 1e-9  # of a period: instants are so much apart from where they touch, which pays for the others
_PLACE_WIDTH = 1e-9  # of a segment: how near a place comes to where instants are broken most
_TIGHT_INSTANT = 1e-7  # of a period: what leaves no more binds


_NODES = 4000
_LONGEST = 10.0
#: in which laws of least acceleration follow the times that they leave
_ROUNDS = 12
_OVERLAP_GAP = 1e-9  # of the objective: by so much a least period is longer than the one of its program
_CUTS = 40
_PLACES = 65


@dataclass(frozen=True, eq=False)
class LevelSide:
    """On which side of a level, a function of the position of the axis that passes, the other axis is to be.

    `bends` are positions at which the function is not smooth.
    """

    sign: float
    level: Callable[[Array], Array]
    bends: tuple[float, ...] = ()


#: a side, and a joint of the other axis around which it stays there
Option = tuple[LevelSide, int]
#: durations of all segments by axes
Times = Mapping[str, Sequence[float]]
#: the options of requirements by their numbers
Choices = Mapping[int, Option]


@dataclass(frozen=True, eq=False)
class Requirement:
    """A condition: while a segment of an axis goes between two positions, the other axis is on one of several sides."""

    rule: Interlock
    axis: AxisPlan
    segment: int
    other: AxisPlan
    sides: tuple[LevelSide, ...]
    places: tuple[float, float]
    _rows: dict[tuple[Option, int], Array] = field(default_factory=dict)

    @property
    def passing(self) -> PlannedSegment:
        return self.axis.segments[self.segment]

    @property
    def extended(self) -> bool:
        """Whether the requirement covers more than one position."""
        return self.passing.law is not None and self.places[0] != self.places[1]

    @kept_property
    def cuts(self) -> list[float]:
        """Shares of the segment at which programs know it: where it begins, ends, or a level bends, and those added."""
        if self.passing.law is None:
            return [0.0]
        low, high = sorted(self.places)
        inner = {place for side in self.sides for place in side.bends if low < place < high}
        return [float(share) for share in np.sort(self.passing.shares(np.array([*{low, high, *inner}])))]

    @kept_property
    def shares(self) -> Array:
        """Shares of the segment at which it is at positions where the requirement holds: many, with all bends."""
        bends = self.cuts
        return np.union1d(np.linspace(bends[0], bends[-1], _PLACES), bends) if self.extended else np.array(bends[:1])

    @kept_property
    def options(self) -> list[Option]:
        """Joints of the other axis that are on a side wherever the segment passes."""
        positions, options = self.passing.positions(self.shares), list[Option]()
        for side in self.sides:
            levels = side.level(positions)
            for joint in range(len(self.other.positions)):
                repeated = joint > 0 and self.other.segments[joint - 1].law is None
                if not repeated and self.other.beyond(joint, levels, side.sign).all():
                    options.append((side, joint))
        return options

    def rows(self, option: Option, shares: Array) -> Array:
        """Rows over the unknowns that are not negative where the requirement holds after shares of the segment.

        Those of the first rest before the pass, then those of its end after it; NaN where there is no such end.
        """
        side, joint = option
        levels = side.level(self.passing.positions(shares))
        early = late = self.axis.events(self.segment, shares)
        if self.passing.law is None:
            late = self.axis.events(self.segment, np.ones(len(shares)))
        before, after = (self.other.leaves(joint, levels, side.sign, way) for way in (-1, 1))
        return np.concatenate([early - before, after - late])

    def known_rows(self, option: Option) -> Array:
        """The rows of an option at the cuts."""
        place = option, len(self.cuts)
        if place not in self._rows:
            rows = self.rows(option, np.array(self.cuts))
            self._rows[place] = rows[~np.isnan(rows[:, 0])]
        return self._rows[place]

    def room(self, option: Option, unknowns: Array, shares: Array) -> Array:
        """The time that an option leaves after shares of the segment."""
        values = self.rows(option, shares) @ unknowns
        return np.asarray(np.where(np.isnan(values), np.inf, values).reshape(2, -1).min(axis=0))

    def least_near(self, option: Option, unknowns: Array, place: int) -> tuple[float, float]:
        """The share around one of `shares` at which an option leaves the least time, and that time."""
        places = self.shares[max(place - 1, 0) : place + 2]
        while True:
            rooms = self.room(option, unknowns, places)
            at = int(np.argmin(rooms))
            low, high = float(places[max(at - 1, 0)]), float(places[min(at + 1, len(places) - 1)])
            if high - low <= _PLACE_WIDTH:
                return float(places[at]), float(rooms[at])
            places = np.unique([*np.linspace(low, high, _PLACES), places[at]])

    def cut(self, option: Option, unknowns: Array) -> bool:
        """Put shares at which an option is broken more than nearby among the cuts; whether there are any."""
        most, known = _BROKEN_PLACE * float(unknowns[-2]), len(self.cuts)
        values = -self.room(option, unknowns, self.shares if self.extended else np.empty(0))
        for place, value in enumerate(values):
            beside = values[max(place - 1, 0) : place + 2]
            # between two places it may be broken by no more than what it changes from one to the next
            if -np.inf < value == beside.max() and value > most - 2.0 * (value - beside.min()):
                at, room = self.least_near(option, unknowns, place)
                self.cuts.extend([at] if -room > most else [])
        return len(self.cuts) > known

    def least_room(self, option: Option, unknowns: Array) -> float:
        """The least time that an option leaves anywhere in the segment."""
        return self.least_near(option, unknowns, int(np.argmin(self.room(option, unknowns, self.shares))))[1]


def requirements(
    rules: Sequence[Interlock], plans: Mapping[str, AxisPlan], cycles: Mapping[str, Cycle]
) -> list[Requirement]:
    """All conditions of interlocks on the instants of planned axes."""
    known, sides = list[Requirement](), tuple[LevelSide, ...]()
    for rule in rules:
        (axis, other), given, ends = (plans[name] for name in rule.axes), rule.in_si(cycles), (-inf, inf)
        if isinstance(rule, After):
            ends, sides = (given[0], given[0]), (LevelSide(rule.sign, partial(np.full_like, fill_value=given[1])),)
        elif isinstance(rule, Clearance):
            bends = given.places if isinstance(given, Table) else ()
            axis, other, sides = other, axis, (LevelSide(rule.sign, partial(at_positions, given), bends),)
        elif isinstance(rule, Forbidden):
            bends = tuple(x for x, _ in given.corners)
            ends = min(bends), max(bends)
            sides = tuple(LevelSide(sign, partial(_edge, given, end), bends) for sign, end in ((1.0, 1), (-1.0, 0)))
        else:
            raise InputError(f"interlock {rule.label}: only After, Clearance and Forbidden are put together anew")
        for i, segment in enumerate(axis.segments):
            low, high = sorted((segment.start, segment.stop))
            places, way = (max(ends[0], low), min(ends[1], high)), "up" if low == segment.start else "down"
            if places[0] <= places[1] and getattr(rule, "way", None) in {None, way}:
                known.append(Requirement(rule, axis, i, other, sides, places))
    return known


def _edge(polygon: SimplePolygon, end: int, places: Array) -> Array:
    return np.array([polygon.section(x)[end] for x in places])


#: the unknowns of a program, and a bound below its value
Optimum = tuple[Array, float]


@dataclass(frozen=True, eq=False)
class Overlapping:
    """The problem: plans of axes, what interlocks demand, and which of period (least) and pace (greatest) is sought."""

    plans: Sequence[AxisPlan]
    requirements: Sequence[Requirement]
    period: float | None  #: the period that is given, None where the least is sought
    longest: float  #: a period that is not passed
    unit: float  #: of the unknown times, in seconds: programs are solved in shares of it

    @kept_property
    def efforts(self) -> Array:
        """Of each unknown duration the least at the pace 1; 0 of those that do not change with it."""
        return np.array([segment.effort for plan in self.plans for segment in plan.segments])

    @kept_property
    def base(self) -> tuple[Array, Array, list[str]]:
        """Rows, right sides and names of the conditions without choices: row @ unknowns >= right side."""
        known, of = list[tuple[Array, float, str]](), np.eye(len(self.efforts) + 2)
        for plan in self.plans:
            for here, segment in enumerate(plan.segments, plan.first):
                least, most, name = segment.least, segment.most, segment.binds
                known.append((of[here] - least.share * of[-2], least.time / self.unit, name))
                if segment.effort > 0.0:
                    known.append((of[here] - segment.effort / self.unit * of[-1], 0.0, ""))
                if most is not None:
                    known.append((most.share * of[-2] - of[here], -most.time / self.unit, name))
            whole = of[-2] - of[plan.first : plan.first + len(plan.segments)].sum(axis=0)
            known += [(whole, 0.0, ""), (-whole, 0.0, "")]
        rows, sides, names = zip(*known, strict=True)
        return np.array(rows), np.array(sides), list(names)

    def best(self) -> Optimum:
        """The best instants over all choices, with a bound that no other instants pass."""
        forced: dict[int, Option] = {}
        for i, needed in enumerate(self.requirements):
            if not needed.options:
                raise InfeasibleProblem(
                    f"interlock {needed.rule.label}: while {needed.axis.name} passes, {needed.other.name} would have to"
                    " be where it never rests: change a position, or the strokes"
                )
            if len(needed.options) == 1:
                forced[i] = needed.options[0]
        for _ in range(_CUTS):
            (unknowns, bound), choices = self._searched(forced)
            added = [self.requirements[i].cut(option, unknowns) for i, option in choices.items()]
            if not any(added):
                return (self._solved(choices, _INSTANT_MARGIN) or (unknowns, bound))[0], bound
        raise SolverFailure("instants that keep a region clear were not found: give its bound fewer bends")

    def _searched(self, forced: Choices) -> tuple[Optimum, Choices]:
        """Branch and bound over the choices: the node of the least bound first."""
        number, root = count(), self._solved(forced)
        heap: list[tuple[float, int, Array, Choices]] = []
        if root is not None:
            heap.append((root[1], next(number), root[0], forced))
        while heap:
            bound, node, unknowns, choices = heapq.heappop(heap)
            broken, worst, further = _BROKEN_INSTANT * float(unknowns[-2]), None, dict(choices)
            for i, requirement in enumerate(self.requirements):
                if i not in choices:
                    rows = [requirement.known_rows(option) for option in requirement.options]
                    off = [float(-(row @ unknowns).min(initial=0.0)) for row in rows]
                    further[i] = requirement.options[int(np.argmin(off))]
                    broken, worst = (min(off), i) if min(off) > broken else (broken, worst)
            if worst is None:
                return (unknowns, bound), further
            if node > _NODES:
                raise SolverFailure(f"who waits for whom has more than {_NODES} ways: give fewer moves or interlocks")
            for option in self.requirements[worst].options:
                solved = self._solved({**choices, worst: option})
                if solved is not None:
                    way = {**choices, worst: option}
                    heapq.heappush(heap, (max(bound, solved[1]), next(number), solved[0], way))
        raise InfeasibleProblem(self._contradiction(forced))

    def _solved(self, choices: Choices, margin: float = 0.0) -> Optimum | None:
        """The program with the rows of a choice; None where it has no solution."""
        from scipy.optimize import linprog

        matrix, right, _ = self.base
        for i, option in choices.items():
            rows = self.requirements[i].known_rows(option)
            matrix = np.vstack([matrix, rows])
            right = np.append(right, np.full(len(rows), margin if self.requirements[i].extended else 0.0))
        goal, low = np.zeros((2, matrix.shape[1]))
        most, paced = np.full(len(low), self.longest / self.unit), self.efforts[self.efforts > 0.0]
        if self.period is None:
            goal[-2], low[-1], most[-1] = 1.0, 1.0, 1.0
        else:
            goal[-1], low[-2], most[-1] = -1.0, self.period / self.unit, self.longest / min(paced, default=self.longest)
        solve: Any = linprog
        answer = solve(
            goal,
            A_ub=-matrix,
            b_ub=-right,
            bounds=np.column_stack([low, most]),
            method="highs",
            options={"primal_feasibility_tolerance": _LP_FEASIBILITY},
        )
        if answer.status != 0:
            return None
        prices = np.maximum(-answer.ineqlin.marginals, 0.0)
        rest = goal - prices @ matrix
        # weak duality, whatever the prices are worth
        return np.asarray(answer.x), float(prices @ right + np.minimum(rest * low, rest * most).sum())

    def shortest(self) -> tuple[Overlapping, Array, float]:
        """The instants of least period, longer by what programs are solved to, so that limits are met; its bound."""
        unknowns, bound = self.best()
        if unknowns[-2] <= _LP_FEASIBILITY:
            raise InputError(
                "nothing bounds the period: every move takes an angle of the master, and so ever less time: give axes "
                'limits, such as limits = { acceleration = "20 m/s^2" }, or moves durations in s'
            )
        return self, unknowns * (1.0 + _OVERLAP_GAP), bound * self.unit

    def without_dwells(self, names: Sequence[str]) -> Overlapping:
        """The problem in which dwells, by what their least durations are named, may take no time."""
        plans = [
            replace(plan, segments=[replace(s, least=NOTHING) if s.binds in names else s for s in plan.segments])
            for plan in self.plans
        ]
        return replace(self, plans=plans)

    def durations(self, unknowns: Array) -> dict[str, list[float]]:
        """The durations of the segments of each axis in seconds."""
        ends = {plan.name: (plan.first, plan.first + len(plan.segments)) for plan in self.plans}
        return {name: [self.unit * float(time) for time in unknowns[slice(*end)]] for name, end in ends.items()}

    def binding(self, durations: Times, period: float, share: float) -> tuple[str, ...]:
        """What leaves no time, to a share of what counts as none: limits of moves, dwells and interlocks, by names.

        It is a matter of the instants alone: an interlock leaves what its most favourable option does, at the place of
        the segment where that is least.
        """
        times = [value for plan in self.plans for value in durations[plan.name]]
        unknowns, room = np.array([*times, period, self.unit]) / self.unit, share * _TIGHT_INSTANT * period / self.unit
        rows, sides, names = self.base
        near = [name for name, left in zip(names, rows @ unknowns - sides, strict=True) if name and left <= room]
        near += [
            requirement.rule.label
            for requirement in self.requirements
            if all(requirement.least_room(option, unknowns) <= room for option in requirement.options)
        ]
        return tuple(dict.fromkeys(near))

    def _contradiction(self, forced: Choices) -> str:
        """The interlocks without any of which there are instants."""
        if self._solved({}) is None:
            return "the moves and dwells alone take longer than the period: give a longer one, or less of a dwell"
        of = {i: self.requirements[i].rule for i in range(len(self.requirements))}
        rules = list(dict.fromkeys(of.values()))
        alone = [self._solved({i: forced[i] for i in forced if of[i] is not rule}) for rule in rules]
        named = [rule.label for rule, solved in zip(rules, alone, strict=True) if solved]
        return (
            f"no instants of these laws keep all interlocks: {'; '.join(named or [rule.label for rule in rules])}: "
            "change a position of one of them, or give a longer period"
        )


def program(
    cycles: Mapping[str, Cycle], rules: Sequence[Interlock], goal: str, longer: Sequence[str], times: Times
) -> Overlapping:
    """The program of the instants of laws of least acceleration in some times, or of the fastest laws."""
    first, plans, size = 0, dict[str, AxisPlan](), sum(len(cycle.programme.stretches) for cycle in cycles.values()) + 2
    for name, cycle in cycles.items():
        way: Way = "fastest" if goal == "period" else "least acceleration" if name in longer else "kept"
        plans[name] = AxisPlan(name, planned(name, cycle, way, times.get(name)), first, size)
        first += len(plans[name].segments)
    duration = next(iter(cycles.values())).duration
    demands = requirements(rules, plans, cycles)
    if goal != "period":
        return Overlapping(list(plans.values()), demands, duration, duration, duration)
    least = sum(segment.least.time for plan in plans.values() for segment in plan.segments)
    # the answer may be far shorter than what was given, and programs are as exact as their unit
    unit = max(map(_least_period, plans.values())) or duration
    return Overlapping(list(plans.values()), demands, None, _LONGEST * (duration + least), unit)


def least_acceleration(
    cycles: Mapping[str, Cycle], rules: Sequence[Interlock], longer: Sequence[str]
) -> tuple[Overlapping, Array, float]:
    """The program, the instants and the bound of the least acceleration of some axes in the period that they have.

    Laws of least acceleration are those for the times that they had before, in rounds, while the acceleration falls.
    """

    def instants(times: Times) -> tuple[Overlapping, Array, float]:
        of_laws = program(cycles, rules, "acceleration", longer, times)
        unknowns, bound = of_laws.best()
        shortest = min(of_laws.efforts[of_laws.efforts > 0.0], default=of_laws.unit)
        if -bound * shortest <= _LP_FEASIBILITY * of_laws.unit:
            labels = "; ".join(rule.label for rule in rules)
            raise InfeasibleProblem(
                f"no instants of these laws keep all interlocks: {labels}: at least one move would have no time left"
            )
        return of_laws, unknowns, 1.0 / bound**2

    times: Times = {name: cycle.durations for name, cycle in cycles.items()}
    try:
        best = instants(times)
    except InfeasibleProblem:
        # the fastest laws leave the most room
        best, times = instants({}), {}
    step = 1.0
    for _ in range(_ROUNDS if any(any(cycles[name].limits_of_segments) for name in longer) else 0):
        further = {
            name: [before + step * (after - before) for before, after in zip(times.get(name, now), now, strict=True)]
            for name, now in best[0].durations(best[1]).items()
        }
        try:
            rearranged = instants(further)
        except InfeasibleProblem:
            step *= 0.5
            continue
        faster = rearranged[1][-1] / best[1][-1] - 1.0
        if abs(faster) <= _OVERLAP_GAP:
            break
        if faster > 0.0:
            best, times = rearranged, further
        else:
            step *= 0.5
    return best


def _least_period(plan: AxisPlan) -> float:
    """The period that an axis takes by itself; 0 where that is not known."""
    shares, seconds = (sum(each) for each in zip(*(segment.least for segment in plan.segments), strict=True))
    return seconds / (1.0 - shares) if shares < 1.0 else 0.0
