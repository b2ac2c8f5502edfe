"""Tables of old cams as the page shows them: noise, seams, moves with their standard laws, better laws near them."""

from __future__ import annotations

from dataclasses import KW_ONLY, replace
from functools import lru_cache
from math import floor, log10
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from optlaws import Cycle
from optlaws.cycles.old_tables.better_laws import bettered
from optlaws.cycles.old_tables.reading import points_in
from optlaws.cycles.old_tables.report import OldTableReport
from optlaws.cycles.old_tables.splitting import table_of
from optlaws.cycles.old_tables.stretches import Stretch
from optlaws.cycles.old_tables.table import OldTable
from optlaws.entries.declared import Declared, declared, entry
from optlaws.entries.value_types import Number, Text, Whole
from optlaws.errors import InputError
from optlaws.explorer.views.cycle_view import CycleRequest
from optlaws.explorer.views.law_view import refusing
from optlaws.explorer.views.panel_data import panel_data, segments_data, table_data
from optlaws.explorer.views.requests import stored_law
from optlaws.laws.catalogue.catalogue import catalogue
from optlaws.sentences import sentence
from optlaws.shown.report import Panel
from optlaws.tolerances import AGREEMENT

_MOST_DRAWN = 1500  # points
_ORDER, _DEGREE = 3, 15
_PARTS = 500.0  # of a stroke: one is the tolerance where none was given


@declared
class OldCamEntries(Declared, title="the table of an old cam"):
    """The text of a table with its reading options, a tolerance in its units, and the speed of the master."""

    _: KW_ONLY
    text: str = entry(Text(empty=True), "The file.", example="0;0")
    file: str = entry(Text(), "Its name.", default="table")
    unit: str | None = entry(Text(), "That of the positions.", default=None, label="positions in", example="mm")
    master: str | None = entry(Text(), "The unit of the master.", default=None, label="master in", example="deg")
    columns: str | None = entry(Text(), "Numbers or headings of columns.", default=None, example="1, 2")
    cam: str | None = entry(Text(), "One of a file with several.", default=None)
    room: float | None = entry(
        Number(above=0.0), "How far a law may be from the points.", default=None, label="points within"
    )
    within: float | None = entry(Number(above=0.0), "How far better laws may be from the old ones.", default=None)
    turn: str | None = entry(Text(), "How much of the master is a turn.", default=None, example="720 deg")
    advance: str | None = entry(Text(), "What the position advances by in a turn.", default=None, example="360 deg")
    rows: int | None = entry(Whole(2), "How many rows count.", default=None, label="rows that count")
    lobes: int = entry(Whole(1), "How often the rows follow each other in a turn.", default=1, label="lobes of a turn")
    begin: str | None = entry(Text(), "Where the cycle begins on the master.", default=None, example="220 deg")
    speed: str | None = entry(Text(), "That of the master.", default=None, example="200 rpm")


def table(entries: OldCamEntries) -> OldTable:
    """The table of a study."""
    return _table(replace(entries, within=None, speed=None))


@lru_cache(maxsize=16)
def _table(entries: OldCamEntries) -> OldTable:
    columns = None if entries.columns is None else [name.strip() for name in entries.columns.split(",")]
    path = Path(entries.file)
    points = points_in(entries.text, path, columns, unit=entries.unit, master=entries.master, cam=entries.cam)
    frame = {name: getattr(entries, name) for name in ("turn", "advance", "rows", "lobes", "begin")}
    return table_of(points, path, entries.room, **frame)


@refusing("not read")
def answer(request: CycleRequest) -> dict[str, Any]:
    """The recognised moves of the table, with the better ones that are given, or the reason why it cannot be read."""
    entries = OldCamEntries.from_dict(request.study)
    old, new = table(entries), with_laws(request)
    report = OldTableReport(old, None if new.stretches == old.stretches else new)
    within = _within(old, entries)
    ends = float(old.places[0]), float(old.places[-1])
    stride = max(1, len(old.places) // _MOST_DRAWN)
    panels = [panel_data(_thinned(panel, stride)) for panel in report.panels]
    panels[1]["limits"] = [{"from": ends[0], "to": ends[1], "value": within}]
    return {
        "across": "master",
        "range": ends,
        "symbol": "master",
        "within": within,
        "stroke": float(np.ptp(old.heights)),
        "unit": old.master,
        "heights": old.unit,
        "drawn": "" if stride == 1 else f"every {stride}th point is drawn",
        "panels": panels,
        "segments": segments_data(report.segments, report.panels[0]),
        "tables": list(map(table_data, report.tables)),
        "moves": [f"{part.kind} from {part.start:g}" for part in old.moves],
        "trust": _trust(old),
    }


def _thinned(panel: Panel, stride: int) -> Panel:
    """A panel with every so many of its points."""
    series = (
        curve._replace(at=curve.at[::stride], values=curve.values[::stride]) if curve.dots else curve
        for curve in panel.series
    )
    return replace(panel, series=tuple(series))


def _within(old: OldTable, entries: OldCamEntries) -> float:
    """The tolerance in units of the table; by default, a round share of the stroke above the points' scatter."""
    if entries.within is not None:
        return entries.within
    least = max(2.0 * old.room, float(np.ptp(old.heights)) / _PARTS)
    power = 10.0 ** floor(log10(least))
    return round(least / power) * power


def _trust(old: OldTable) -> dict[str, Any]:
    """How near the laws are to the points, and what of these is seen."""
    near, named = old.off[0] <= old.room * (1.0 + AGREEMENT), sum(isinstance(part.law, str) for part in old.moves)
    return {
        "status": "given" if near else "local",
        "word": "read" if near else "off a point",
        "advice": f"{old.layout}, {len(old.places)} points: {len(old.moves)} moves, {named} of them standard laws.",
        "facts": old.remarks,
    }


@refusing("no better law")
def move(request: CycleRequest) -> dict[str, Any]:
    """A law of least acceleration within the tolerance of a move's old law, as its solution; or the reason for none."""
    entries, number = OldCamEntries.from_dict(request.study), request.axis
    old = table(entries)
    if number >= len(old.moves):
        raise InputError(f"the table has {len(old.moves)} moves, and no move {number}")
    new = [part for part in _bettered(replace(entries, speed=None)) if part.law is not None][number]
    if new.solution is None:
        return {"law": None, "kept": sentence("keeps its law: {}", old.reason_in_words(new))}
    return {"law": new.solution.to_dict()}


@lru_cache(maxsize=16)
def _bettered(entries: OldCamEntries) -> list[Stretch]:
    old = table(entries)
    return bettered(old.stretches, _within(old, entries), _ORDER, _DEGREE)


def cycle(request: CycleRequest) -> Cycle:
    """The cycle of the table with the laws that are given, at the speed of the study or of the file."""
    return with_laws(request).cycle(speed=OldCamEntries.from_dict(request.study).speed)


def laws_of(request: CycleRequest) -> list[dict[str, Any]]:
    """The laws that the moves are to have in place of their own; empty tables where they keep it."""
    return next(iter(request.laws or []), [])


def with_laws(request: CycleRequest) -> OldTable:
    """The table with the laws that are given in place of its own."""
    old, laws = table(OldCamEntries.from_dict(request.study)), laws_of(request)
    if len(laws) > len(old.moves):
        raise InputError(f"the table has {len(old.moves)} moves, and {len(laws)} laws are given")
    chosen = iter([*laws, *({} for _ in old.moves)])
    stretches = []
    for part in old.stretches:
        law = {} if part.law is None else next(chosen)
        stretches.append(replace(part, law=stored_law(msgspec.json.encode(law))) if law else part)
    return replace(old, stretches=tuple(stretches))


def example() -> dict[str, Any]:
    """The table that the page shows where none was given: 35 mm up in 120 deg, down in 100 deg, with two decimals."""
    turn = np.arange(0.0, 361.0, 3.0)
    up, down = catalogue["modified sine"].law, catalogue["cycloidal"].law
    lift = 35.0 * (up(np.clip(turn / 120.0, 0.0, 1.0)) - down(np.clip((turn - 210.0) / 100.0, 0.0, 1.0)))
    lines = [f"{angle:.0f};{height:.2f}" for angle, height in zip(turn, np.abs(lift), strict=True)]
    return {"file": "turn.csv", "text": "\n".join(["degree;mm", *lines]) + "\n", "speed": "200 rpm"}
