"""Instants of moves that overlap as far as interlocks let them: linear programs, branched over who waits for whom.

With laws that keep their shape, the time at which an axis passes a position is the sum of the durations before it and a
known share of its move's. So an interlock that says around which rest of the other axis a pass lies is linear in the
durations. What is left open, around which rest and on which side, is branched over: programs without a choice are
relaxations, and bound all choices. Regions and bounds that are functions hold at every position: rows are added where a
solution breaks them, until none does.
"""

from __future__ import annotations

import heapq
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import count
from math import sqrt
from typing import Any

import numpy as np

from optlaws.cycles.axes.axis_plan import AxisPlan, OwnLaws
from optlaws.cycles.axes.interlock import Interlock
from optlaws.cycles.axes.requirements import Requirement, WaitOption, requirements
from optlaws.errors import InfeasibleProblem, SolverFailure
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.numbers import Array

_BROKEN_INSTANT = 1e-11  # of a period: by so much an instant may come too early, as programs are solved
_OVERLAP_GAP = 1e-9  # of the objective: by so much a least period is longer than the one of its program
_LP_FEASIBILITY = 1e-10  # of a period: by so much the solver of programs of instants may break a row
_BROKEN_PLACE = 3e-10  # of a period: the same between the places that programs know
_INSTANT_MARGIN = 1e-9  # of a period: instants are so much apart from where they touch, which pays for the others
_PLACE_WIDTH = 1e-9  # of a segment: how near a place comes to where instants are broken most
TIGHT_INSTANT = 1e-7  # of a period: what leaves no more binds

_NODES = 4000
_CUTS = 40
_LONGEST = 10.0
#: in which laws of least acceleration follow the times that they leave
_ROUNDS = 12

Choices = Mapping[int, WaitOption]
#: durations of all segments by axes
_Times = Mapping[str, Sequence[float]]


@dataclass(frozen=True)
class Optimum:
    """A solution of a program: unknowns, its value, and a bound below it."""

    unknowns: Array
    value: float
    bound: float


@dataclass(frozen=True)
class BestInstants:
    """Durations and laws of all segments, the period, the pace, and the proven bound of the objective."""

    durations: dict[str, list[float]]
    laws: dict[str, list[MotionLaw | None]]
    period: float
    pace: float
    bound: float
    nodes: int


@dataclass(frozen=True)
class Overlapping:
    """The problem: plans of axes, what interlocks demand, and which of period (least) and pace (greatest) is sought.

    Attributes
    ----------
    efforts
        Of each unknown duration the least at the pace 1; 0 of those that do not change with it.
    period
        The period that is given, None where the least is sought.
    longest
        A period that is not passed.
    unit
        Of the unknown times, in seconds: programs are solved in shares of it.
    """

    plans: tuple[AxisPlan, ...]
    requirements: tuple[Requirement, ...]
    efforts: Array
    period: float | None
    longest: float
    unit: float
    cuts: dict[int, list[float]] = field(default_factory=dict)
    met: dict[tuple[int, WaitOption, float], list[Array]] = field(default_factory=dict)

    @property
    def size(self) -> int:
        """How many unknowns there are: durations, the period and the pace."""
        return len(self.efforts) + 2

    @kept_property
    def options(self) -> list[list[WaitOption]]:
        """The choices that each requirement leaves."""
        return [requirement.options() for requirement in self.requirements]

    @kept_property
    def base(self) -> tuple[list[Array], list[float], list[str]]:
        """Rows, right sides and names of the conditions without choices: row @ unknowns >= right side."""
        rows: list[Array] = []
        sides: list[float] = []
        names: list[str] = []

        def add(row: Array, side: float, name: str) -> None:
            rows.append(row)
            sides.append(side)
            names.append(name)

        for plan in self.plans:
            for i, segment in enumerate(plan.segments):
                here = plan.first + i
                (least, share), kind = segment.least, "move" if segment.moves else "dwell"
                free = segment.most is None and least + share > 0.0
                # of a time that cannot change there is nothing to say
                name = segment.limit or (f"{kind} {segment.name} of {plan.name}" if free else "")
                add(self._row({here: 1.0, -2: -share}), least / self.unit, name)
                if self.efforts[here] > 0.0:
                    add(self._row({here: 1.0, -1: -float(self.efforts[here]) / self.unit}), 0.0, "")
                if segment.most is not None:
                    add(self._row({here: -1.0, -2: segment.most[1]}), -segment.most[0] / self.unit, name)
            whole = plan.instant(len(plan.segments))
            for sign in (1.0, -1.0):
                add(sign * (self._row({-2: 1.0}) - whole), 0.0, "")
        return rows, sides, names

    def best(self) -> BestInstants:
        """The best instants over all choices, with a bound that no other instants pass."""
        missing = [i for i, options in enumerate(self.options) if not options]
        if missing:
            needed = self.requirements[missing[0]]
            raise InfeasibleProblem(
                f"interlock {needed.rule.label}: while {needed.axis.name} passes, {needed.other.name} would have to be "
                "where it never rests: change a position, or the strokes"
            )
        for i, requirement in enumerate(self.requirements):
            self.cuts[i] = requirement.bends()
        forced: dict[int, WaitOption] = {i: options[0] for i, options in enumerate(self.options) if len(options) == 1}
        for _ in range(_CUTS):
            optimum, choices, nodes, bound = self._searched(forced)
            if not self._added(optimum.unknowns, choices):
                return self._result(optimum, choices, nodes, bound)
        raise SolverFailure("instants that keep a region clear were not found: give its bound fewer bends")

    def _searched(self, forced: Choices) -> tuple[Optimum, Choices, int, float]:
        """Branch and bound over the choices: the node of the least bound first."""
        number, root = count(), self._solved(forced)
        if root is None:
            raise InfeasibleProblem(self._contradiction(forced))
        heap: list[tuple[float, int, Optimum, Choices]] = [(root.bound, next(number), root, dict(forced))]
        nodes = 1
        while heap:
            bound, _, optimum, choices = heapq.heappop(heap)
            broken = self._most_broken(optimum.unknowns, choices)
            if broken is None:
                return optimum, self._completed(optimum.unknowns, choices), nodes, bound
            if nodes > _NODES:
                heapq.heappush(heap, (bound, next(number), optimum, choices))
                break
            for option in self.options[broken]:
                nodes += 1
                further = {**choices, broken: option}
                solved = self._solved(further)
                if solved is not None:
                    heapq.heappush(heap, (max(bound, solved.bound), next(number), solved, further))
        if nodes > _NODES:
            optimum, instants = self._dived([(node[2], node[3]) for node in sorted(heap)])
            return optimum, dict(instants), nodes, bound
        raise InfeasibleProblem(self._contradiction(forced))

    def _dived(self, open_nodes: Sequence[tuple[Optimum, Choices]]) -> tuple[Optimum, Choices]:
        """Instants that keep all interlocks, from the first open node that leads to such by its least choices."""
        for optimum, choices in open_nodes:
            here: tuple[Optimum, Choices] | None = (optimum, choices)
            while here is not None:
                broken = self._most_broken(here[0].unknowns, here[1])
                if broken is None:
                    return here[0], self._completed(here[0].unknowns, here[1])
                ways = [{**here[1], broken: option} for option in self.options[broken]]
                solved = [(best, way) for best, way in zip(map(self._solved, ways), ways, strict=True) if best]
                here = min(solved, key=lambda pair: pair[0].value, default=None)
        raise SolverFailure(f"who waits for whom has more than {_NODES} ways: give fewer moves or interlocks")

    def _solved(self, choices: Choices, rules: Sequence[Any] | None = None, margin: float = 0.0) -> Optimum | None:
        """The program with the rows of a choice; None where it has no solution."""
        from scipy.optimize import linprog

        rows, sides, _ = self._rows(choices, rules, margin)
        goal, most = self._row({-2: 1.0} if self.period is None else {-1: -1.0}), self._most()
        low = np.zeros(self.size)
        if self.period is not None:
            low[-2] = self.period / self.unit
        else:
            low[-1] = 1.0
        matrix, right = np.array(rows), np.array(sides)
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
        bound = float(prices @ right + np.minimum(rest * low, rest * most).sum())
        return Optimum(np.asarray(answer.x), float(goal @ answer.x), bound)

    def _rows_of(self, i: int, option: WaitOption, share: float) -> list[Array]:
        if (i, option, share) not in self.met:
            self.met[i, option, share] = self.requirements[i].rows(option, share)
        return self.met[i, option, share]

    def _rows(
        self, choices: Choices, rules: Sequence[Any] | None = None, margin: float = 0.0
    ) -> tuple[list[Array], list[float], list[str]]:
        rows, sides, names = list(self.base[0]), list(self.base[1]), list(self.base[2])
        for i, option in choices.items():
            requirement = self.requirements[i]
            if rules is None or requirement.rule in rules:
                for share in self.cuts[i]:
                    for row in self._rows_of(i, option, share):
                        rows.append(row)
                        sides.append(margin if requirement.extended else 0.0)
                        names.append(requirement.rule.label)
        return rows, sides, names

    def _most(self) -> Array:
        """Upper bounds of the unknowns."""
        most = np.full(self.size, self.longest / self.unit)
        active = self.efforts[self.efforts > 0.0]
        most[-1] = self.longest / float(active.min()) if self.period is not None and active.size else 1.0
        return most

    def _broken_by(self, i: int, option: WaitOption, unknowns: Array) -> float:
        """The time by which an option is violated at the sampled places."""
        rows = [row for share in self.cuts[i] for row in self._rows_of(i, option, share)]
        return max((-float(row @ unknowns) for row in rows), default=0.0)

    def _most_broken(self, unknowns: Array, choices: Choices) -> int | None:
        """The requirement without alternatives whose best option is violated most; None without such a requirement."""
        worst, which = _BROKEN_INSTANT * float(unknowns[-2]), None
        for i, options in enumerate(self.options):
            if i not in choices:
                off = min(self._broken_by(i, option, unknowns) for option in options)
                if off > worst:
                    worst, which = off, i
        return which

    def _completed(self, unknowns: Array, choices: Choices) -> dict[int, WaitOption]:
        """The choices, completed by the choices that the solution itself implies."""
        others = {
            i: min(options, key=lambda option: self._broken_by(i, option, unknowns))
            for i, options in enumerate(self.options)
            if i not in choices
        }
        return {**choices, **others}

    def _added(self, unknowns: Array, choices: Choices) -> bool:
        """Whether places of violations of a choice were added to the sampled places."""
        added = False
        for i, option in choices.items():
            if self.requirements[i].extended:
                for share in self._worst(i, option, unknowns):
                    self.cuts[i].append(share)
                    added = True
        return added

    def _worst(self, i: int, option: WaitOption, unknowns: Array) -> list[float]:
        """The shares of a segment at which a choice is broken more than nearby."""
        requirement, most = self.requirements[i], _BROKEN_PLACE * float(unknowns[-2])
        shares = requirement.shares()
        values = [max((-float(row @ unknowns) for row in self._rows_of(i, option, share)), default=-np.inf)
                  for share in shares]  # fmt: skip
        met = []
        for place, value in enumerate(values):
            beside = values[max(place - 1, 0) : place + 2]
            # between two places it may be broken by no more than what it changes from one to the next
            if value < max(beside) or value <= most - 2.0 * (value - min(beside)):
                continue
            at, room = _least_near(requirement, option, unknowns, shares, place)
            if -room > most:
                met.append(at)
        return met

    def _result(self, optimum: Optimum, choices: Choices, nodes: int, bound: float) -> BestInstants:
        solved = self._solved(choices, margin=_INSTANT_MARGIN) or optimum
        x = solved.unknowns
        durations = {
            plan.name: [self.unit * float(value) for value in x[plan.first : plan.first + len(plan.segments)]]
            for plan in self.plans
        }
        return BestInstants(
            durations,
            {plan.name: [segment.law for segment in plan.segments] for plan in self.plans},
            self.unit * float(x[-2]),
            float(x[-1]),
            bound * (self.unit if self.period is None else 1.0),
            nodes,
        )

    def binding(self, unknowns: Array, tight: float = TIGHT_INSTANT) -> tuple[str, ...]:
        """What leaves no more than a share of a period: limits of moves, dwells and interlocks, by their names.

        It is a matter of the instants alone: an interlock leaves what its most favourable option does, at the place of
        the segment where that is least.
        """
        rows, sides, names = self.base
        room = tight * float(unknowns[-2])
        near = [
            name for row, side, name in zip(rows, sides, names, strict=True) if name and row @ unknowns - side <= room
        ]
        near += [
            requirement.rule.label
            for requirement in self.requirements
            if all(_least_room(requirement, option, unknowns) <= room for option in requirement.options())
        ]
        return tuple(dict.fromkeys(near))

    def unknowns_of(self, durations: Mapping[str, Sequence[float]], period: float) -> Array:
        """The unknowns of durations of all segments by axes, in seconds; the pace, of which no name depends, is 1."""
        times = [value for plan in self.plans for value in durations[plan.name]]
        return np.array([*(value / self.unit for value in times), period / self.unit, 1.0])

    def _contradiction(self, forced: Choices) -> str:
        """The interlocks without any of which there are instants."""
        rules = list(dict.fromkeys(requirement.rule for requirement in self.requirements))
        alone = self._solved(forced, rules=())
        if alone is None:
            return "the moves and dwells alone take longer than the period: give a longer one, or less of a dwell"
        named = [rule.label for rule in rules if self._solved(forced, [each for each in rules if each is not rule])]
        listed = "; ".join(named or [rule.label for rule in rules])
        return (
            f"no instants of these laws keep all interlocks: {listed}: change a position of one of them, or give a "
            "longer period"
        )

    def _row(self, entries: Mapping[int, float]) -> Array:
        row = np.zeros(self.size)
        for place, value in entries.items():
            row[place] += value
        return row


def _room(requirement: Requirement, option: WaitOption, unknowns: Array, share: float) -> float:
    """The time that an option leaves after a share of its segment."""
    return min((float(row @ unknowns) for row in requirement.rows(option, share)), default=np.inf)


def _least_near(
    requirement: Requirement, option: WaitOption, unknowns: Array, shares: Array, place: int
) -> tuple[float, float]:
    """The share around one of some shares at which an option leaves the least time, and that time."""
    from scipy.optimize import minimize_scalar

    solve: Any = minimize_scalar
    at, known = float(shares[place]), _room(requirement, option, unknowns, float(shares[place]))
    ends = shares[max(place - 1, 0)], shares[min(place + 1, len(shares) - 1)]
    if ends[0] == ends[1]:
        return at, known
    lowest = solve(
        lambda share: _room(requirement, option, unknowns, share),
        bounds=ends,
        method="bounded",
        options={"xatol": _PLACE_WIDTH},
    )
    return (float(lowest.x), float(lowest.fun)) if lowest.fun < known else (at, known)


def _least_room(requirement: Requirement, option: WaitOption, unknowns: Array) -> float:
    """The least time that an option leaves anywhere in its segment."""
    shares = requirement.shares()
    place = int(np.argmin([_room(requirement, option, unknowns, float(share)) for share in shares]))
    return _least_near(requirement, option, unknowns, shares, place)[1]


def binding_of(
    cycles: Mapping[str, Any],
    rules: Sequence[Interlock],
    goal: str,
    longer: Sequence[str],
    durations: _Times,
    period: float,
    tight: float = TIGHT_INSTANT,
) -> tuple[str, ...]:
    """What leaves no room at given instants, however these were found; see `Overlapping.binding`."""
    problem = _problem(_own_laws(cycles, goal, longer), rules, {} if goal == "period" else durations)
    return problem.binding(problem.unknowns_of(durations, period), tight)


def _own_laws(cycles: Mapping[str, Any], goal: str, longer: Sequence[str]) -> list[OwnLaws]:
    if goal == "period":
        return [OwnLaws(cycle, name, "fastest") for name, cycle in cycles.items()]
    return [OwnLaws(cycle, name, "gentlest" if name in longer else "kept") for name, cycle in cycles.items()]


def best_instants(
    cycles: Mapping[str, Any], rules: Sequence[Interlock], goal: str, longer: Sequence[str]
) -> BestInstants:
    """The instants of least period, or of the least acceleration of some axes in the period that they have.

    Where the period is least the answer is longer by what programs are solved to, so that all limits are met. Laws of
    least acceleration are those for the times that they had before, in rounds, while the acceleration falls.
    """
    axes = _own_laws(cycles, goal, longer)
    if goal == "period":
        return _instants(axes, rules, {})
    times: _Times = {name: cycle.durations for name, cycle in cycles.items()}
    try:
        best = _instants(axes, rules, times)
    except InfeasibleProblem:
        # the fastest laws leave the most room
        best, times = _instants(axes, rules, {}), {}
    step = 1.0
    for _ in range(_ROUNDS if any(axis.follows_times for axis in axes) else 0):
        further = {
            name: [before + step * (after - before) for before, after in zip(times.get(name, now), now, strict=True)]
            for name, now in best.durations.items()
        }
        try:
            rearranged = _instants(axes, rules, further)
        except InfeasibleProblem:
            step *= 0.5
            continue
        if abs(rearranged.pace - best.pace) <= _OVERLAP_GAP * best.pace:
            break
        if rearranged.pace > best.pace:
            best, times = rearranged, further
        else:
            step *= 0.5
    return best


def _problem(axes: Sequence[OwnLaws], rules: Sequence[Interlock], times: _Times) -> Overlapping:
    """The program of the instants of laws in some times, or of the fastest laws."""
    cycles = {axis.name: axis.cycle for axis in axes}
    count_of_unknowns = sum(len(cycle.programme.stretches) for cycle in cycles.values()) + 2
    first, plans = 0, dict[str, AxisPlan]()
    efforts = np.zeros(count_of_unknowns - 2)
    for axis in axes:
        plan = axis.plan(first, count_of_unknowns, times.get(axis.name))
        if axis.way == "gentlest":
            now = axis.cycle.unchecked().peak(2)  # limits bind the laws in the times that are sought
            for i, segment in enumerate(plan.segments):
                efforts[first + i] = sqrt(segment.acceleration / now) if segment.moves else 0.0
        plans[axis.name], first = plan, first + len(plan.segments)
    duration, shortest = next(iter(cycles.values())).duration, axes[0].way == "fastest"
    least = sum(segment.least[0] for plan in plans.values() for segment in plan.segments)
    return Overlapping(
        tuple(plans.values()),
        tuple(requirements(rules, plans, cycles)),
        efforts,
        None if shortest else duration,
        _LONGEST * (duration + least) if shortest else duration,
        # the answer may be far shorter than what was given, and programs are as exact as their unit
        max(map(_least_period, plans.values())) or duration if shortest else duration,
    )


def _instants(axes: Sequence[OwnLaws], rules: Sequence[Interlock], times: _Times) -> BestInstants:
    """The best instants of laws in some times, or of the fastest laws."""
    best = _problem(axes, rules, times).best()
    if axes[0].way != "fastest":
        if not best.bound < 0.0:
            labels = "; ".join(rule.label for rule in rules)
            raise InfeasibleProblem(
                f"no instants of these laws keep all interlocks: {labels}: moves would have to take no time"
            )
        return replace(best, bound=1.0 / best.bound**2)
    longer_by = 1.0 + _OVERLAP_GAP
    durations = {name: [longer_by * value for value in values] for name, values in best.durations.items()}
    return replace(best, durations=durations, period=longer_by * best.period)


def _least_period(plan: AxisPlan) -> float:
    """The period that an axis takes by itself; 0 where that is not known."""
    seconds, shares = (sum(segment.least[i] for segment in plan.segments) for i in (0, 1))
    return seconds / (1.0 - shares) if shares < 1.0 else 0.0
