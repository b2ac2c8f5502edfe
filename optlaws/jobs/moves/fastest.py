"""The job "fastest": least times of moves, over their strokes, and what less speed saves; tabled, drawn and proven."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from optlaws.cycles.moves.fastest_move import AXES, FastestMove
from optlaws.cycles.moves.time_front import TimeFront
from optlaws.errors import InputError
from optlaws.files import writing
from optlaws.files.tables import Cell
from optlaws.jobs.cycle import plain_name
from optlaws.jobs.moves.move_entries import FastestProblemFile, SoughtMove, sought
from optlaws.motion.display_units import UNITS
from optlaws.plots.moves import fronts_figure, motion_figure, strokes_figure
from optlaws.results import Page, Results
from optlaws.studies.problem_entries import gap
from optlaws.synthesis.solution import Solution
from optlaws.synthesis.status import Status

HEADINGS = ("move", "stroke", "least time, s", "no law below, s", "limit of all laws, s", "above it, %", "status")
_FEW = 7
_PERCENT = 100.0


def run(results: Results) -> None:
    """Put the tables, the page, the pictures, and laws with their proofs into results."""
    spec = FastestProblemFile.read(results.entries, results.file)
    results.title = spec.title
    files = [plain_name(move.name) for move in spec.move]
    if len(set(files)) < len(files) or {"about", "fastest"} & set(files):
        raise InputError(
            f"move: names must differ as files have them, and none is about or fastest: {', '.join(files)}"
        )
    moves = sought(spec, results.file)
    results.table("fastest", (*HEADINGS, "binds"), [_line(each.name, move) for each in moves for move in each.moves])
    page = results.page("fastest").text(spec.text)
    for each in moves:
        _fill(page, each)
        name = plain_name(each.name)
        for front in each.fronts:
            results.table(f"{name}_{plain_name(front.minimise)}", front.headings, _points(front))
        if len(each.moves) > 1:
            results.picture(name, strokes_figure(each.moves, f"{spec.title}: {each.name}"))
        else:
            results.picture(name, motion_figure(each.moves[0], f"{spec.title}: {each.name}"))
        if each.fronts:
            results.picture(f"{name}_front", fronts_figure(each.fronts, f"{spec.title}: {each.name}"))
    results.text("fastest.json", _json(results.about, moves))


def _line(name: str, move: FastestMove) -> list[Cell]:
    unit, factor = UNITS[AXES[move.unit]][0]
    # what is sought time by time is known to six digits, and where it is proven the bound is a millionth below
    below = move.none_below if move.status is Status.OPTIMAL else float(f"{move.none_below:.5g}")
    limit = move.limit if move.limit is None or move.least.move.torque is None else float(f"{move.limit:.5g}")
    price = None if limit is None else f"{_PERCENT * (move.duration / limit - 1.0):.2f}"
    stroke = f"{factor * move.stroke:.9g} {unit}"
    return [name, stroke, move.duration, below, limit, price, move.status.value, ", ".join(move.binding)]


def _fill(page: Page, each: SoughtMove) -> None:
    """The part of the page of one move."""
    name = plain_name(each.name)
    page.heading(each.name)
    if len(each.moves) > 1:
        page.figure(name, f"{each.name}: least time over the stroke")
        last = len(each.moves) - 1
        few = sorted({round(last * step / (_FEW - 1)) for step in range(_FEW)})
        page.table((*HEADINGS[1:], "binds"), [_line(each.name, each.moves[i])[1:] for i in few], digits=6)
        return
    move = each.moves[0]
    page.figure(name, f"{each.name}: the fastest motion")
    page.facts(move.summary(), digits=6)
    if each.fronts:
        page.figure(f"{name}_front", f"{each.name}: what is least over the time")
    for front in each.fronts:
        page.text(_in_words(front)).table(front.headings, _points(front), digits=6)


def _in_words(front: TimeFront) -> str:
    """The saving from a tenth more time, in words."""
    first, last = front[0], front[-1]
    later = next((point for point in front if point.duration >= 1.1 * first.duration), last)
    saved = 1.0 - later.value / first.value if first.value else 0.0
    more = later.duration / first.duration - 1.0
    proven = (
        "Every point is proven." if front.status is Status.OPTIMAL else "The bounds hold for all laws of the space."
    )
    return (
        f"The least {front.minimise}: {_PERCENT * more:.0f} % more time than the least saves {_PERCENT * saved:.0f} % "
        f"of it. {proven}"
    )


def _points(front: TimeFront) -> list[list[Cell]]:
    rows: list[list[Cell]] = []
    for point, solution in zip(front, front.solutions, strict=True):
        # what of a search or of a phase plane differs between machines is not shown
        sure = solution.status is Status.OPTIMAL
        bound = point.lower_bound if sure else float(f"{point.lower_bound:.3g}")
        rows.append([point.duration, point.value, bound, gap(solution) if sure else None, solution.status.value])
    return rows


def _json(about: str, moves: Sequence[SoughtMove]) -> str:
    """Laws and proofs, a line for each least time or front."""
    head = json.dumps({"about": f"{about}; {writing.MARK}"})[:-1]
    parts = []
    for each in moves:
        ((kind, rows),) = _stored(each).items()
        lines = ",\n".join(map(json.dumps, rows))
        parts.append(f"{json.dumps(each.name)}: {{{json.dumps(kind)}: [\n{lines}\n]}}")
    return f"{head},\n" + ",\n".join(parts) + "}\n"


def _stored(each: SoughtMove) -> dict[str, list[dict[str, Any]]]:
    """Laws and proofs for `optlaws verify`, without what differs from run to run."""
    if not each.fronts:
        return {"moves": [_move(move) for move in each.moves]}
    return {"fronts": [_front(front) for front in each.fronts]}


def _move(move: FastestMove) -> dict[str, Any]:
    return {**move.to_dict(), "solution": _solution(move.least.solution)}


def _front(front: TimeFront) -> dict[str, Any]:
    whole = front.to_dict()
    points = [
        {**point, "solution": _solution(solution)}
        for point, solution in zip(whole["points"], front.solutions, strict=True)
    ]
    return {**whole, "fastest": _move(front.fastest), "points": points}


def _solution(solution: Solution) -> dict[str, Any]:
    """The parts of a solution's stored form that do not depend on its computation."""
    whole = replace(solution, seconds=0.0, iterations=0).to_dict()
    return {name: whole[name] for name in whole if name != "versions"}
