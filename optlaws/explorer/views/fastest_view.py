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
from optlaws.cycles.summary import drive_rows, objective_unit, peak_rows
from optlaws.errors import InputError, OptlawsError
from optlaws.explorer.views import cycle_view
from optlaws.explorer.views.cycle_view import CycleRequest, packaged_study
from optlaws.explorer.views.law_view import digits, gap_text, refusing, verdict
from optlaws.explorer.views.panel_data import drawn, fact_sentences, over_time, panel_data
from optlaws.explorer.views.requests import MOST_DEGREE, MOST_ORDER, Question, without_files
from optlaws.jobs.cycle_entries import AxisEntries, CycleProblemFile
from optlaws.jobs.fastest import FastestProblemFile, MoveEntries, arguments_of, front_of
from optlaws.motion.display_units import MILLI
from optlaws.motion.quantities import si_number
from optlaws.numbers import Array, Quantity, bounded, whole
from optlaws.sentences import Amount
from optlaws.shown.report import Panel, Series
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

Points: TypeAlias = Sequence[Sequence[float | None]]


@dataclass(frozen=True)
class _Motion:
    """A motion in a time: its report, what is proven of it, and what its drive takes."""

    report: MoveReport | CycleReport
    duration: float
    trust: dict[str, Any]
    rows: Sequence[Row]
    solutions: Sequence[Solution]


@dataclass(frozen=True)
class _Front:
    """What is least over the time: times, values and lower bounds."""

    points: Points
    name: str
    unit: str
    proven: bool


@refusing()
def answer(request: CycleRequest) -> dict[str, Any]:
    """The motion in its time with its limits, or the reason why there is none."""
    search = _search(request)
    motion = search.motion(request.time)
    panels = motion.report.panels
    # the places of the curves, through all their extremes
    times = np.unique(np.concatenate([panel.series[0].at for panel in panels]))
    shares = motion.report.shares(times)
    return {
        **over_time([_coloured(panel, motion.report) for panel in panels], motion.duration),
        "segments": _stretches(times, shares),
        "names": list(shares),
        "shares": [_use(name, float(share.max())) for name, share in shares.items()],
        "rows": [
            *(
                _use(each.name, each.share) | {"value": each.value_text or Amount(each.value, each.unit)}
                for each in motion.report.limits_taken
            ),
            *({"name": row.name, "value": Amount(row.value, row.unit), "text": ""} for row in motion.rows),
        ],
        "time": motion.duration,
        "least": search.times,
        "objectives": search.objectives,
        "minimise": search.minimise,
        "trust": motion.trust,
        "note": search.note,
    }


def front(request: CycleRequest) -> dict[str, Any]:
    """The least objective over the time, from the proven least time on, with its lower bound in the law space."""
    search = _search(request)
    if search.minimise is None:
        return {"points": [], "words": "choose what is to be least in longer times"}
    line = search.front()
    proof = "proven at every point" if line.proven else "local, with its bound"
    return {**vars(line), "words": f"least {line.name} in each {search.word}: {proof}"}


def proof_of(request: CycleRequest) -> dict[str, Any]:
    """The stored proof of a least time, and of the laws in the displayed time."""
    search = _search(request)
    return search.proof(search.motion(request.time).solutions)


def fastest_of(request: CycleRequest) -> FastestMove:
    """The least time of the move that is shown, with its proof."""
    search = _search(request)
    if not isinstance(search, _MoveSearch):
        raise InputError("a least period is saved as a problem file")
    return search.least


def _search(request: CycleRequest) -> _MoveSearch | _CycleSearch:
    """The search of the least time of what is shown."""
    if request.study.get("job") == "cycle":
        return _cycle_search(*cycle_view.read(request))
    spec = FastestProblemFile.read(request.study, _WHERE)
    move = spec.move[min(request.axis, len(spec.move) - 1)]
    cycle_view.check_drive(move.drive)
    without_files(request.study.get("problem"))
    space = spec.problem or {}
    if space.get("bounds"):
        raise InputError("problem: it gives no limits of its own: limits are those of the move")
    return _move_search(move, json.dumps(space))


def _times(least: float, limit: float | None) -> dict[str, Any]:
    return {"time": least, "text": digits(MILLI * least), "limit": limit}


@lru_cache(maxsize=64)
def _move_search(move: MoveEntries, entries: str) -> _MoveSearch:
    space: Problem = problem("problem", {"order": 3}, json.loads(entries))
    whole(space.order, "order", least=1, most=MOST_ORDER)
    degree = space.basis.to_dict().get("degree")
    if isinstance(degree, int):
        whole(degree, "degree", most=MOST_DEGREE)
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
    def times(self) -> dict[str, Any]:
        """The least time, and the limit of all laws."""
        return _times(self.least.duration, self.least.limit)

    @property
    def minimise(self) -> str | None:
        """The objective in longer times."""
        return None if self.move.front is None else self.move.front.minimise[0]

    @property
    def objectives(self) -> list[str]:
        """The possible objectives in longer times."""
        names = [name for name in OBJECTIVES if name not in AT_MOTOR and name != RESIDUAL]
        names += list(AT_MOTOR) if "drive" in self.given else []
        return names + ([RESIDUAL] if self.move.follower is not None else [])

    @property
    def note(self) -> str:
        """Which of several strokes is shown."""
        return f"the first of {len(self.move.stroke)} strokes" if isinstance(self.move.stroke, tuple) else ""

    def motion(self, time: float | None) -> _Motion:
        """The fastest law, or in a longer time that of the least objective."""
        least, law, duration, solution = self.least, self.least.law, self.least.duration, None
        facts = fact_sentences(least.proof_rows())
        if self.minimise is None or time is None or time <= duration * (1.0 + LEAST_TIME_GAP) ** 2:
            words = "No law of this order and degree is faster within the limits."
            trust = verdict(least.status, gap_text(least.gap), [*facts, *least.notes], words)
        else:
            line = front_of(least, self.move, self.minimise, self.given, (f"{time!r} s", 2))
            solution, point = line.solutions[1], line[1]
            law, duration = point.law, point.duration
            rows = [Row(f"least {self.minimise} in this time", point.value, line.unit)]
            if bounded(point.lower_bound) is not None:
                rows.append(Row("none below", point.lower_bound, line.unit))
            trust = verdict(solution.status, gap_text(solution.gap), [*fact_sentences(rows), *facts])
        start = float(si_number(self.given["start"], ("angle",), "start")) if "drive" in self.given else 0.0
        report = MoveReport(least, law, duration, self.given.get("drive"), start)
        rows = [] if report.sheet is None else list(report.sheet.summary())
        return _Motion(report, duration, trust, rows, [] if solution is None else [solution])

    def front(self) -> _Front:
        """The front up to the longest time."""
        extent = None if self.move.front is None else self.move.front.longest
        line = front_of(self.least, self.move, self.minimise or "", self.given, (extent, _POINTS))
        points = [[point.duration, point.value, bounded(point.lower_bound)] for point in line]
        return _Front(points, line.minimise, line.unit, line.status is Status.OPTIMAL)

    def proof(self, solutions: Sequence[Solution]) -> dict[str, Any]:
        """The least time with its proofs, and the law in the displayed time."""
        return self.least.to_dict() | ({"in_this_time": solutions[0].to_dict()} if solutions else {})


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
    def times(self) -> dict[str, Any]:
        """The least period, without a limit of all laws."""
        return _times(self.least.period, None)

    @property
    def minimise(self) -> str:
        """What is least in longer periods."""
        return self.axis.minimise

    def _cycle(self, time: float | None) -> Cycle:
        """The cycle at its greatest speed, or in a longer period with the laws of its objective."""
        if time is None or time <= self.least.period * (1.0 + AGREEMENT):
            cycle: Cycle = self.least.cycle
            return cycle
        return cycle_view.stored(replace(self.spec, speed=None, period=f"{time!r} s"), self.axis)

    def motion(self, time: float | None) -> _Motion:
        """The motion of a period, and what its drive takes."""
        cycle, facts = self._cycle(time), fact_sentences(self.least.proof_rows())
        trust = None if cycle is self.least.cycle else cycle_view.trust(cycle)
        if trust is None:
            words = "No law of this order and degree lets the cycle run faster."
            trust = verdict(self.least.status, "", [], words, proof=bool(self.least.proofs))
        trust["facts"] += facts
        rows = [*peak_rows(cycle), *drive_rows(cycle)]
        return _Motion(CycleReport(cycle), cycle.duration, trust, rows, cycle.solutions)

    def front(self) -> _Front:
        """The least objectives of longer periods."""
        points: list[list[float | None]] = []
        proven = True
        for time in np.geomspace(_SLOWER * self.least.period, _LONGEST * self.least.period, _CYCLE_POINTS).tolist():
            try:
                cycle = self._cycle(time)
                bound = None if cycle.lower_bound is None else bounded(cycle.lower_bound)
                points.append([time, cycle.objective, bound])
                proven = proven and cycle.status is Status.OPTIMAL
            except OptlawsError:
                points.append([time, None, None])
        return _Front(points, self.minimise, objective_unit(self.least.specification), proven)

    def proof(self, solutions: Sequence[Solution]) -> dict[str, Any]:
        """The proofs of the greatest speed, and the laws in the displayed period."""
        return self.least.claims() | {"solutions": [solution.to_dict() for solution in solutions]}


def _use(name: str, share: float) -> dict[str, Any]:
    """A limit with the share of it that is taken, in percent."""
    return {"name": name, "text": digits(100.0 * share, 4), "full": share >= _FULL}


def _runs(shares: Mapping[str, Array]) -> Iterator[tuple[int, int, int]]:
    """Stretches with the limit of which most is taken: its number, the first place, and where the next one begins."""
    start = 0
    nearest = np.argmax(np.array(list(shares.values())), axis=0).tolist() if shares else []
    for number, places in groupby(nearest):
        stop = start + len(list(places))
        yield number, start, stop
        start = stop


def _coloured(panel: Panel, report: MoveReport | CycleReport) -> dict[str, Any]:
    """The curve of a panel, and a series of it for each limit, which is drawn where most is taken of that one."""
    (curve,) = panel.series
    shares = report.shares(curve.at)
    parts: dict[int, list[tuple[Array, Array]]] = {}
    for i, start, stop in _runs(shares):
        # on to the first place of the next, so that the curve is whole
        at, values = curve.at[start : stop + 1], curve.values[start : stop + 1]
        parts.setdefault(i, []).append((np.append(at, at[-1]), np.append(values, np.nan)))
    limited = []
    for i, name in enumerate(shares):
        if i in parts:
            at, values = (np.concatenate(part) for part in zip(*parts[i], strict=True))
            limited.append(Series(at, values, f"bind-{i}", name))
    return panel_data(replace(panel, series=(curve, *limited)))


def _stretches(times: Array, shares: Mapping[str, Array]) -> list[dict[str, Any]]:
    """The limiting quantity at each time: stretches with the limit of greatest use, and whether it is reached."""
    names, at, stretches = list(shares), drawn(MILLI * times, 4), []
    for i, start, stop in _runs(shares):
        most = float(shares[names[i]][start:stop].max())
        ends = [at[start], at[min(stop, len(times) - 1)]]
        stretches.append({"name": names[i] if most else "rest", "at": ends, "law": i, "full": most >= _FULL})
    return stretches


def example() -> dict[str, Any]:
    """The moves that the page shows where none were given: a gripper, and a rotary table with its motor."""
    study = packaged_study("fastest_pick")
    table, gripper, _ = study["move"]
    return study | {"move": [gripper, table]}


QUESTIONS: dict[str, Question] = {"fastest": (CycleRequest, answer), "fastest-front": (CycleRequest, front)}
