"""Tables of old cams as the page shows them: noise, seams, moves with their standard laws, better laws near them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import lru_cache
from math import floor, log10
from pathlib import Path
from typing import Annotated, Any

import msgspec
import numpy as np

from optlaws import Cycle, MotionLaw, Solution
from optlaws.cycles.old_tables.better_moves import better, gain, law_of_move
from optlaws.cycles.old_tables.reading import points_in
from optlaws.cycles.old_tables.stretches import Stretch
from optlaws.cycles.old_tables.table import OldTable, table_of
from optlaws.errors import InputError
from optlaws.explorer.views.law_view import digits, refusing
from optlaws.explorer.views.panel_data import drawn
from optlaws.explorer.views.requests import Question
from optlaws.laws.catalogue.catalogue import catalogue
from optlaws.motion.quantities import QUANTITIES
from optlaws.numbers import Array, bounded
from optlaws.plots.old_table import curve, curve_of_part
from optlaws.sentences import Amount
from optlaws.tolerances import AGREEMENT, NO_MARK

_EACH = 120  # samples in a move
_MOST_DRAWN = 1500  # points
_MOST_MOVES = 100
_ORDER, _DEGREE = 3, 15
_OLD = {"law": 0, "name": "old law"}
_PARTS = 500.0  # of a stroke: one is the tolerance where none was given
Name = Annotated[str, msgspec.Meta(max_length=200)]
Word = Annotated[str, msgspec.Meta(max_length=60)]


class OldCamEntries(msgspec.Struct, kw_only=True, forbid_unknown_fields=True, frozen=True):
    """The text of a table with its reading options, a tolerance in its units, and the speed of the master."""

    text: str
    file: Name = "table"
    unit: Word | None = None
    master: Word | None = None
    columns: Word | None = None
    cam: Word | None = None
    room: Annotated[float, msgspec.Meta(gt=0.0)] | None = None
    within: Annotated[float, msgspec.Meta(gt=0.0)] | None = None
    speed: Word | None = None


class OldCamRequest(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """The table of an old cam, a move of it, and the laws that its moves are to have; None where one keeps its own."""

    study: OldCamEntries
    move: Annotated[int, msgspec.Meta(ge=0, lt=_MOST_MOVES)] = 0
    laws: Annotated[list[dict[str, Any] | None], msgspec.Meta(max_length=_MOST_MOVES)] = []


def table(entries: OldCamEntries) -> OldTable:
    """The table of a study.

    Raises
    ------
    InputError
        If the text holds no table, is damaged, or makes no cycle of dwells and moves from rest to rest.
    """
    return _table(msgspec.json.encode(msgspec.structs.replace(entries, within=None, speed=None)))


@lru_cache(maxsize=16)
def _table(question: bytes) -> OldTable:
    entries = msgspec.json.decode(question, type=OldCamEntries)
    columns = None if entries.columns is None else [name.strip() for name in entries.columns.split(",")]
    path = Path(entries.file or "table")
    points = points_in(entries.text, path, columns, unit=entries.unit, master=entries.master, cam=entries.cam)
    return table_of(points, path, entries.room)


@refusing("not read")
def answer(request: OldCamRequest) -> dict[str, Any]:
    """The recognised moves of the table, or the reason why it cannot be read."""
    old = table(request.study)
    within = _within(old, request.study)
    first, last = float(old.places[0]), float(old.places[-1])
    stride = max(1, len(old.places) // _MOST_DRAWN)
    places, heights = old.places[::stride], old.heights[::stride]
    points = {"at": drawn(places, 6), "law": 2, "name": "points", "dots": True}
    off = points | {"values": drawn(heights - old.at(places), 8)}
    limits = [{"from": first, "to": last, "value": within}]
    return {
        "across": f"master, {old.master}",
        "range": [first, last],
        "symbol": old.master,
        "within": within,
        "stroke": float(np.ptp(old.heights)),
        "unit": old.unit,
        "drawn": "" if stride == 1 else f"every {stride}th point is drawn",
        "panels": [
            _panel(old, 0, [_drawn(curve(old, 0, _EACH)) | _OLD, points | {"values": drawn(heights, 8)}]),
            {"name": "off the old law", "unit": old.unit, "series": [off], "limits": limits, "peaks": []},
            *(_panel(old, nu, [_drawn(curve(old, nu, _EACH)) | _OLD]) for nu in (1, 2, 3)),
        ],
        "segments": [{"name": part.kind, "at": [part.start, part.stop]} for part in old.stretches],
        "rows": [
            [part.kind, digits(part.start, 6), digits(part.stop, 6), *_words(old, part)] for part in old.stretches
        ],
        "moves": [index for index, part in enumerate(old.stretches) if part.law is not None],
        "trust": _trust(old),
    }


def _drawn(places_and_values: tuple[Array, Array]) -> dict[str, Any]:
    places, values = places_and_values
    return {"at": drawn(places, 6), "values": drawn(values, 8)}


def _within(old: OldTable, entries: OldCamEntries) -> float:
    """The tolerance in units of the table; by default, a round share of the stroke above the points' scatter."""
    if entries.within is not None:
        return entries.within
    least = max(2.0 * old.room, float(np.ptp(old.heights)) / _PARTS)
    power = 10.0 ** floor(log10(least))
    return round(least / power) * power


def _words(old: OldTable, part: Stretch) -> list[str]:
    if part.law is None:
        return ["", ""]
    return [Amount(part.stroke, old.unit), old.law_in_words(part)]


def _panel(old: OldTable, nu: int, series: list[dict[str, Any]]) -> dict[str, Any]:
    peaks = [mark for part in old.moves for mark in _peak(part, nu)] if nu else []
    return {"name": QUANTITIES[nu], "unit": old.unit_of(nu), "series": series, "peaks": peaks}


def _peak(part: Stretch, nu: int) -> Iterator[dict[str, Any]]:
    """The greatest magnitude of a derivative by the master within a move, where it is finite."""
    law, length = law_of_move(part), part.stop - part.start
    peak = max(law.extrema(nu), key=lambda extreme: abs(extreme.value))
    value = part.stroke / length**nu * peak.value
    if np.isfinite(value) and abs(value) > NO_MARK:
        yield {"at": round(part.start + length * peak.k, 6), "value": value}


def _trust(old: OldTable) -> dict[str, Any]:
    """How near the laws are to the points, and what of these is seen."""
    near, named = old.off[0] <= old.room * (1.0 + AGREEMENT), sum(isinstance(part.law, str) for part in old.moves)
    return {
        "status": "given" if near else "local",
        "word": "read" if near else "off a point",
        "advice": f"{old.layout}, {len(old.places)} points: {len(old.moves)} moves, {named} of them standard laws.",
        "gap": "",
        "facts": old.remarks,
    }


@refusing("no better law")
def move(request: OldCamRequest) -> dict[str, Any]:
    """A law of least acceleration within the tolerance of a move's old law, and its gain; or a reason."""
    return _better(msgspec.json.encode(request.study), request.move)


_LAST: dict[bytes, Solution] = {}


@lru_cache(maxsize=128)
def _better(study: bytes, number: int) -> dict[str, Any]:
    entries = msgspec.json.decode(study, type=OldCamEntries)
    old = table(entries)
    if number >= len(old.moves):
        raise InputError(f"the table has {len(old.moves)} moves, and no move {number}")
    part = old.moves[number]
    # while a tolerance is dragged each problem is next to the last one of the move
    key = msgspec.json.encode((msgspec.structs.replace(entries, within=None, speed=None), number))
    new = better(part, _within(old, entries), _ORDER, _DEGREE, _LAST.pop(key, None))
    if new.solution is not None:
        _LAST[key] = new.solution
    while len(_LAST) > _MOST_MOVES:
        del _LAST[next(iter(_LAST))]
    if new.law is part.law:
        return {"law": None, "curves": [], "kept": "keeps its law: none of degree 15 so near has less acceleration"}
    result = gain(new, part)
    assert isinstance(new.law, MotionLaw)  # noqa: S101 - a better law has no name
    places, heights = curve_of_part(new, 0, _EACH)
    curves = [(places, heights), (places, heights - old.at(places))]
    curves += [curve_of_part(new, nu, _EACH) for nu in (1, 2, 3)]
    return {
        "law": None if new.solution is None else new.solution.to_dict(),
        "curves": [*map(_drawn, curves)],
        "peaks": [list(_peak(new, nu)) for nu in (1, 2, 3)],
        "gains": [
            [bounded(result.old[nu - 1]), bounded(result.new[nu - 1]), _share(result.share(nu))] for nu in (1, 2, 3)
        ],
        "off": Amount(result.deviation, old.unit, 3),
    }


def _share(share: float) -> str:
    return "" if np.isnan(share) else f" ({100.0 * share:+.1f} %)".replace("-", "−")


def cycle(request: OldCamRequest) -> Cycle:
    """The cycle of the table with the laws that are given, at the speed of the study or of the file.

    Raises
    ------
    InputError
        If there are more laws than moves, or the speed of the master is not known.
    """
    old = with_laws(request)
    if request.study.speed is None and old.rate is None and old.master not in {"s", "ms"}:
        raise InputError('speed: say the speed of the master, such as "200 rpm": the file has none')
    return old.cycle(speed=request.study.speed)


def with_laws(request: OldCamRequest) -> OldTable:
    """The table with the laws that are given in place of its own."""
    old, laws = table(request.study), request.laws
    if len(laws) > len(old.moves):
        raise InputError(f"the table has {len(old.moves)} moves, and {len(laws)} laws are given")
    chosen = iter([*laws, *[None] * len(old.moves)])
    stretches = []
    for part in old.stretches:
        law = None if part.law is None else next(chosen)
        stretches.append(part if law is None else replace(part, law=_law_of(law)))
    return replace(old, stretches=tuple(stretches))


def _law_of(entries: dict[str, Any]) -> MotionLaw:
    """A law as it is stored, or that of a stored solution."""
    return Solution.from_dict(entries).law if "certificate" in entries else MotionLaw.from_dict(entries)


def example() -> dict[str, Any]:
    """The table that the page shows where none was given: 35 mm up in 120 deg, down in 100 deg, with two decimals."""
    turn = np.arange(0.0, 361.0, 3.0)
    up, down = catalogue["modified sine"].law, catalogue["cycloidal"].law
    lift = 35.0 * (up(np.clip(turn / 120.0, 0.0, 1.0)) - down(np.clip((turn - 210.0) / 100.0, 0.0, 1.0)))
    lines = [f"{angle:.0f};{height:.2f}" for angle, height in zip(turn, np.abs(lift), strict=True)]
    return {"file": "turn.csv", "text": "\n".join(["degree;mm", *lines]) + "\n", "speed": "200 rpm"}


QUESTIONS: dict[str, Question] = {"old": (OldCamRequest, answer), "old-move": (OldCamRequest, move)}
