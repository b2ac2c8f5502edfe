"""Least times as the page shows them: the proven least, the law of any longer time, which limit binds at each time."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from itertools import groupby
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np

from optlaws import FastestCycle, FastestMove, Plan, Problem, Solution, Status, fastest
from optlaws.cycles.moves.fastest_move import MoveReport
from optlaws.cycles.moves.time_front import TimeFront
from optlaws.cycles.report import CycleReport, objective_unit
from optlaws.errors import InputError, OptlawsError
from optlaws.explorer.views import cycle_view
from optlaws.explorer.views.cycle_view import CycleRequest, packaged_study
from optlaws.explorer.views.law_view import digits, refusing, verdict
from optlaws.explorer.views.panel_data import drawn, fact_sentences, over_time, panel_data
from optlaws.explorer.views.requests import check_size, without_files
from optlaws.jobs.cycle_entries import AxisEntries, CycleProblemFile
from optlaws.jobs.fastest import FastestProblemFile, MoveEntries, arguments_of, front_of
from optlaws.motion.quantities import MILLI, Exact, quantity
from optlaws.numbers import Array, NumberOrQuantity, bounded
from optlaws.sentences import Amount, quantity_name
from optlaws.shown.summary import Row
from optlaws.studies.problem_entries import problem
from optlaws.synthesis.least_time.move_limits import RESIDUALS
from optlaws.synthesis.least_time.timed_move import AT_MOTOR, OBJECTIVES
from optlaws.synthesis.status import gap_text
from optlaws.tolerances import AGREEMENT, LEAST_TIME_GAP

_WHERE = Path("the study")
_POINTS = 11
_CYCLE_POINTS = 6
_LONGEST = 2.0
_SLOWER = 1.0001
#: a limit is taken to the full from this share of it
_FULL = 0.999

_Motion: TypeAlias = tuple[MoveReport | CycleReport, dict[str, Any], list[Solution]]
_Points: TypeAlias = tuple[Sequence[tuple[float, float | None, float | None]], str, bool]


@dataclass(frozen=True)
class _Search:
    """A least time in seconds, by a law or a cycle, and how it goes on in longer times.

    `motion` is, in a time, the report of the motion, how far it can be trusted, and the solutions beside the least
    time's; `points` are those of the front: times, values and lower bounds, the unit, and whether all are proven.
    """

    least: FastestMove | FastestCycle
    time: float
    minimise: str | None
    motion: Callable[[float | None], _Motion]
    points: Callable[[], _Points]
    word: str = "period"
    objectives: Sequence[str] = ()
    note: str = ""


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
        "least": {
            "time": search.time,
            "text": digits(MILLI * search.time),
            "best_possible": search.least.best_possible,
        },
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
    points, unit, proven = search.points()
    proof = "proven at every point" if proven else "local, with its bound"
    words = f"least {quantity_name(search.minimise)} in each {search.word}: {proof}"
    return {"points": points, "name": search.minimise, "unit": unit, "proven": proven, "words": words}


def proof_of(request: CycleRequest) -> dict[str, Any]:
    """The stored proof of a least time, and of the laws in the displayed time."""
    search = _search(request)
    solutions = [solution.to_dict() for solution in search.motion(request.time)[2]]
    if isinstance(search.least, FastestCycle):
        return search.least.claims() | {"solutions": solutions}
    return search.least.to_dict() | ({"in_this_time": solutions[0]} if solutions else {})


def fastest_of(request: CycleRequest) -> FastestMove | FastestCycle:
    """The least time of the move or of the cycle that is shown, with its proof."""
    return _search(request).least


def export_of(request: CycleRequest) -> Callable[..., Any]:
    """What writes the motion in the displayed time for a controller."""
    report, _, _ = _search(request).motion(request.time)
    if isinstance(report, CycleReport):
        return report.plan.export
    if report.law is report.move.law:
        return report.move.export
    return partial(
        report.law.export, stroke=Exact(report.move.stroke, report.move.unit), duration=Exact(report.duration, "s")
    )


def _search(request: CycleRequest) -> _Search:
    """The search of the least time of what is shown."""
    if request.study.get("job") == "cycle":
        return _of_cycle(*cycle_view.read(request))
    without_files(request.study)
    spec = FastestProblemFile.read(request.study, _WHERE)
    space = spec.problem or {}
    if space.get("bounds"):
        raise InputError("problem: it gives no limits of its own: limits are those of the move")
    return _of_move(spec.move[min(request.axis, len(spec.move) - 1)], json.dumps(space))


@lru_cache(maxsize=64)
def _of_move(move: MoveEntries, entries: str) -> _Search:
    """The least time of a single move, with laws of the space that has such entries."""
    space: Problem = problem("problem", {"order": 3}, json.loads(entries))
    check_size(space.order, space.basis.to_dict().get("degree"))
    given, strokes = arguments_of(move), move.stroke if isinstance(move.stroke, tuple) else (move.stroke,)
    least = fastest(space, stroke=strokes[0], **given)
    drive, minimise = given.get("drive"), None if move.front is None else move.front.minimise[0]
    start = 0.0 if drive is None else float(quantity(given["start"], "angle", "start", bare=True))

    usual = [] if least.beside is None else least.beside.rows[:1]

    def line(longest: NumberOrQuantity | None, points: int) -> TimeFront:
        return front_of(least, move, minimise or "", given, (longest, points))

    def points() -> _Points:
        front = line(None if move.front is None else move.front.longest, _POINTS)
        known = [(point.duration, point.value, bounded(point.lower_bound)) for point in front]
        return known, front.unit, front.status is Status.OPTIMAL

    def motion(time: float | None) -> _Motion:
        facts = fact_sentences([*least.proof_rows(), *usual])
        if minimise is None or time is None or time <= least.duration * (1.0 + LEAST_TIME_GAP) ** 2:
            words = "No law of this order and degree is faster within the limits."
            trust = verdict(least.status, gap_text(least.gap), [*facts, *least.notes], words)
            return MoveReport(least, least.law, least.duration, drive, start), trust, []
        front = line(Exact(time, "s"), 2)
        solution, point = front.solutions[1], front[1]
        rows = [Row(f"least {quantity_name(minimise)} in this time", point.value, front.unit)]
        if bounded(point.lower_bound) is not None:
            rows.append(Row("lower bound", point.lower_bound, front.unit))
        trust = verdict(solution.status, gap_text(solution.gap), [*fact_sentences(rows), *facts])
        return MoveReport(least, point.law, point.duration, drive, start), trust, [solution]

    objectives = [name for name in OBJECTIVES if name not in {*AT_MOTOR, *RESIDUALS}]
    objectives += [*(() if drive is None else AT_MOTOR), *(() if move.follower is None else RESIDUALS)]
    note = f"the first of {len(strokes)} strokes" if len(strokes) > 1 else ""
    return _Search(least, least.duration, minimise, motion, points, "time", objectives, note)


@lru_cache(maxsize=32)
def _of_cycle(spec: CycleProblemFile, axis: AxisEntries) -> _Search:
    """The least period of a whole cycle."""
    least = cycle_view.stored(spec, axis).specification.fastest()

    def slower(time: float) -> Plan:
        return cycle_view.stored(replace(spec, speed=None, period=Exact(time, "s")), axis)

    def motion(time: float | None) -> _Motion:
        cycle = least.cycle.solve() if time is None or time <= least.period * (1.0 + AGREEMENT) else slower(time)
        trust = None if cycle is least.cycle.solve() else cycle_view.trust(cycle)
        if trust is None:
            words = "No law of this order and degree lets the cycle run faster."
            trust = verdict(least.status, "", [], words, proof=bool(least.proofs))
        trust["facts"] += fact_sentences(least.proof_rows())
        return CycleReport(cycle), trust, list(cycle.solutions)

    def points() -> _Points:
        known, proven = list[tuple[float, float | None, float | None]](), True
        for time in np.geomspace(_SLOWER * least.period, _LONGEST * least.period, _CYCLE_POINTS).tolist():
            try:
                cycle = slower(time)
                known.append((time, cycle.objective, cycle.lower_bound and bounded(cycle.lower_bound)))
                proven = proven and cycle.status is Status.OPTIMAL
            except OptlawsError:
                known.append((time, None, None))
        return known, objective_unit(least.specification), proven

    return _Search(least, least.period, axis.minimise, motion, points)


def _use(name: str, share: float) -> dict[str, Any]:
    """A limit with the share of it that is taken, in percent."""
    return {"name": quantity_name(name), "text": digits(100.0 * share, 4), "full": share >= _FULL}


def _stretches(times: Array, shares: Mapping[str, Array]) -> Iterator[dict[str, Any]]:
    """The limiting quantity at each time: stretches with the limit of greatest use, and whether it is reached."""
    names, at, start = list(shares), drawn(MILLI * times, 4), 0
    nearest = np.argmax(np.array(list(shares.values())), axis=0).tolist() if shares else []
    for i, places in groupby(nearest):
        stop = start + len(list(places))
        most = float(shares[names[i]][start:stop].max())
        ends = [at[start], at[min(stop, len(times) - 1)]]
        yield {"name": quantity_name(names[i]) if most else "rest", "at": ends, "law": i, "full": most >= _FULL}
        start = stop


def example() -> dict[str, Any]:
    """The moves that the page shows where none were given: a gripper, and a rotary table with its motor."""
    study = packaged_study("fastest_pick")
    table, gripper, _ = study["move"]
    return study | {"move": [gripper, table]}
