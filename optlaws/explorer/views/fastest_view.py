"""Least times as the page shows them: the proven least, the law of any longer time, which limit binds at each time."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import groupby
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np

from optlaws import Cycle, FastestCycle, FastestMove, Problem, Solution, Status, fastest
from optlaws.cycles.moves.report import MoveReport
from optlaws.cycles.report import CycleReport
from optlaws.cycles.summary import objective_unit
from optlaws.errors import InputError, OptlawsError
from optlaws.explorer.views import cycle_view
from optlaws.explorer.views.cycle_view import CycleRequest, packaged_study
from optlaws.explorer.views.law_view import digits, gap_text, refusing, verdict
from optlaws.explorer.views.panel_data import drawn, fact_sentences, over_time, panel_data
from optlaws.explorer.views.requests import check_size, without_files
from optlaws.jobs.cycle_entries import AxisEntries, CycleProblemFile
from optlaws.jobs.fastest import FastestProblemFile, MoveEntries, arguments_of, front_of
from optlaws.motion.display_units import MILLI
from optlaws.motion.quantities import si_number
from optlaws.numbers import Array, Quantity, bounded
from optlaws.sentences import Amount
from optlaws.shown.summary import Row
from optlaws.studies.problem_entries import problem
from optlaws.synthesis.least_time.follower_residual import RESIDUAL
from optlaws.synthesis.least_time.move_objective import AT_MOTOR, OBJECTIVES
from optlaws.tolerances import AGREEMENT, LEAST_TIME_GAP

_WHERE = Path("the study")
_POINTS = 11
_CYCLE_POINTS = 6
_LONGEST = 2.0
_SLOWER = 1.0001
#: a limit is taken to the full from this share of it
_FULL = 0.999

#: a motion in a time: its report, how far it can be trusted, and the solutions beside those of the least time
Motion: TypeAlias = tuple[MoveReport | CycleReport, dict[str, Any], list[Solution]]
#: what is least over the time: times, values and lower bounds, its name and unit, and whether it is proven
Front: TypeAlias = tuple[Sequence[tuple[float, float | None, float | None]], str, str, bool]


@refusing()
def answer(request: CycleRequest) -> dict[str, Any]:
    """The motion in its time with its limits, or the reason why there is none."""
    search = _search(request)
    report, trust, _ = search.motion(request.time)
    # the places of the curves, through all their extremes
    times = np.unique(np.concatenate([panel.series[0].at for panel in report.panels]))
    shares = report.shares(times)
    return {
        **over_time(list(map(panel_data, report.panels)), report.duration),
        "segments": list(_stretches(times, shares)),
        "shares": [_use(name, float(share.max())) for name, share in shares.items()],
        "rows": [
            *(
                _use(each.name, each.share) | {"value": each.value_text or Amount(each.value, each.unit)}
                for each in report.limits_taken
            ),
            *({"name": row.name, "value": Amount(row.value, row.unit), "text": ""} for row in report.demands),
        ],
        "time": report.duration,
        "least": {"time": search.time, "text": digits(MILLI * search.time), "limit": search.limit},
        "objectives": search.objectives,
        "minimise": search.minimise,
        "trust": trust,
        "note": search.note,
    }


def front(request: CycleRequest) -> dict[str, Any]:
    """The least objective over the time, from the proven least time on, with its lower bound in the law space."""
    search = _search(request)
    if search.minimise is None:
        return {"points": [], "words": "choose what is to be least in longer times"}
    points, name, unit, proven = search.front()
    proof = "proven at every point" if proven else "local, with its bound"
    words = f"least {name} in each {search.word}: {proof}"
    return {"points": points, "name": name, "unit": unit, "proven": proven, "words": words}


def proof_of(request: CycleRequest) -> dict[str, Any]:
    """The stored proof of a least time, and of the laws in the displayed time."""
    search = _search(request)
    solutions = [solution.to_dict() for solution in search.motion(request.time)[2]]
    if isinstance(search, _CycleSearch):
        return search.least.claims() | {"solutions": solutions}
    return search.least.to_dict() | ({"in_this_time": solutions[0]} if solutions else {})


def fastest_of(request: CycleRequest) -> FastestMove:
    """The least time of the move that is shown, with its proof."""
    search = _search(request)
    if isinstance(search, _CycleSearch):
        raise InputError("a least period is saved as a problem file")
    return search.least


def _search(request: CycleRequest) -> _MoveSearch | _CycleSearch:
    """The search of the least time of what is shown."""
    if request.study.get("job") == "cycle":
        return _cycle_search(*cycle_view.read(request))
    without_files(request.study)
    spec = FastestProblemFile.read(request.study, _WHERE)
    space = spec.problem or {}
    if space.get("bounds"):
        raise InputError("problem: it gives no limits of its own: limits are those of the move")
    return _move_search(spec.move[min(request.axis, len(spec.move) - 1)], json.dumps(space))


@lru_cache(maxsize=64)
def _move_search(move: MoveEntries, entries: str) -> _MoveSearch:
    space: Problem = problem("problem", {"order": 3}, json.loads(entries))
    check_size(space.order, space.basis.to_dict().get("degree"))
    given = arguments_of(move, _WHERE)
    stroke: Quantity = move.stroke[0] if isinstance(move.stroke, tuple) else move.stroke
    return _MoveSearch(move, given, fastest(space, stroke=stroke, **given))


@dataclass(frozen=True)
class _MoveSearch:
    """A single move: its entries, the arguments of its search, and its least time."""

    move: MoveEntries
    given: dict[str, Any]
    least: FastestMove
    word = "time"

    @property
    def time(self) -> float:
        return self.least.duration

    @property
    def limit(self) -> float | None:
        return self.least.limit

    @property
    def minimise(self) -> str | None:
        return None if self.move.front is None else self.move.front.minimise[0]

    @property
    def objectives(self) -> list[str]:
        names = [name for name in OBJECTIVES if name not in AT_MOTOR and name != RESIDUAL]
        names += list(AT_MOTOR) if "drive" in self.given else []
        return names + ([RESIDUAL] if self.move.follower is not None else [])

    @property
    def note(self) -> str:
        return f"the first of {len(self.move.stroke)} strokes" if isinstance(self.move.stroke, tuple) else ""

    def motion(self, time: float | None) -> Motion:
        """The fastest law, or in a longer time that of the least objective."""
        least, law, duration = self.least, self.least.law, self.time
        solutions, facts = list[Solution](), fact_sentences(least.proof_rows())
        if self.minimise is None or time is None or time <= duration * (1.0 + LEAST_TIME_GAP) ** 2:
            words = "No law of this order and degree is faster within the limits."
            trust = verdict(least.status, gap_text(least.gap), [*facts, *least.notes], words)
        else:
            line = front_of(least, self.move, self.minimise, self.given, (f"{time!r} s", 2))
            solution, point = line.solutions[1], line[1]
            solutions, law, duration = [solution], point.law, point.duration
            rows = [Row(f"least {self.minimise} in this time", point.value, line.unit)]
            if bounded(point.lower_bound) is not None:
                rows.append(Row("none below", point.lower_bound, line.unit))
            trust = verdict(solution.status, gap_text(solution.gap), [*fact_sentences(rows), *facts])
        start = float(si_number(self.given["start"], ("angle",), "start")) if "drive" in self.given else 0.0
        return MoveReport(least, law, duration, self.given.get("drive"), start), trust, solutions

    def front(self) -> Front:
        extent = None if self.move.front is None else self.move.front.longest
        line = front_of(self.least, self.move, self.minimise or "", self.given, (extent, _POINTS))
        points = [(point.duration, point.value, bounded(point.lower_bound)) for point in line]
        return points, line.minimise, line.unit, line.status is Status.OPTIMAL


@lru_cache(maxsize=32)
def _cycle_search(spec: CycleProblemFile, axis: AxisEntries) -> _CycleSearch:
    return _CycleSearch(spec, axis, cycle_view.stored(spec, axis).fastest())


@dataclass(frozen=True)
class _CycleSearch:
    """A whole cycle: its entries, and its greatest speed."""

    spec: CycleProblemFile
    axis: AxisEntries
    least: FastestCycle
    word, note = "period", ""
    objectives = ()

    @property
    def time(self) -> float:
        return self.least.period

    @property
    def limit(self) -> float | None:
        return self.least.limit

    @property
    def minimise(self) -> str:
        return self.axis.minimise

    def _cycle(self, time: float | None) -> Cycle:
        """The cycle at its greatest speed, or in a longer period with the laws of its objective."""
        if time is None or time <= self.least.period * (1.0 + AGREEMENT):
            cycle: Cycle = self.least.cycle
            return cycle
        return cycle_view.stored(replace(self.spec, speed=None, period=f"{time!r} s"), self.axis)

    def motion(self, time: float | None) -> Motion:
        cycle = self._cycle(time)
        trust = None if cycle is self.least.cycle else cycle_view.trust(cycle)
        if trust is None:
            words = "No law of this order and degree lets the cycle run faster."
            trust = verdict(self.least.status, "", [], words, proof=bool(self.least.proofs))
        trust["facts"] += fact_sentences(self.least.proof_rows())
        return CycleReport(cycle), trust, list(cycle.solutions)

    def front(self) -> Front:
        points, proven = list[tuple[float, float | None, float | None]](), True
        for time in np.geomspace(_SLOWER * self.least.period, _LONGEST * self.least.period, _CYCLE_POINTS).tolist():
            try:
                cycle = self._cycle(time)
                bound = None if cycle.lower_bound is None else bounded(cycle.lower_bound)
                points.append((time, cycle.objective, bound))
                proven = proven and cycle.status is Status.OPTIMAL
            except OptlawsError:
                points.append((time, None, None))
        return points, self.minimise, objective_unit(self.least.specification), proven


def _use(name: str, share: float) -> dict[str, Any]:
    """A limit with the share of it that is taken, in percent."""
    return {"name": name, "text": digits(100.0 * share, 4), "full": share >= _FULL}


def _stretches(times: Array, shares: Mapping[str, Array]) -> Iterator[dict[str, Any]]:
    """The limiting quantity at each time: stretches with the limit of greatest use, and whether it is reached."""
    names, at, start = list(shares), drawn(MILLI * times, 4), 0
    nearest = np.argmax(np.array(list(shares.values())), axis=0).tolist() if shares else []
    for i, places in groupby(nearest):
        stop = start + len(list(places))
        most = float(shares[names[i]][start:stop].max())
        ends = [at[start], at[min(stop, len(times) - 1)]]
        yield {"name": names[i] if most else "rest", "at": ends, "law": i, "full": most >= _FULL}
        start = stop


def example() -> dict[str, Any]:
    """The moves that the page shows where none were given: a gripper, and a rotary table with its motor."""
    study = packaged_study("fastest_pick")
    table, gripper, _ = study["move"]
    return study | {"move": [gripper, table]}
