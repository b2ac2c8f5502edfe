"""Panels and facts of reports as the page shows them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import floor, isfinite, log10
from typing import Any

import numpy as np

from optlaws.motion.quantities import MILLI
from optlaws.numbers import Array, bounded
from optlaws.sentences import Amount, Sentence, joined, sentence
from optlaws.shown.report import Panel, ReportSegment, ReportTable
from optlaws.shown.summary import Row

_DRAWN = 6  # decimals of what is drawn; what is read is a text of its own
_PLACES = 4  # decimals of where


def _decimals(values: Sequence[Array], usual: int) -> int:
    """So many decimals of values, more where all are small."""
    size = max(float(np.abs(each[np.isfinite(each)]).max(initial=0.0)) for each in values)
    return usual - min(0, floor(log10(size))) if size else usual


def _rounded(values: Array, decimals: int) -> list[float | None]:
    return [value if isfinite(value) else None for value in np.round(values, decimals).tolist()]


def drawn(values: Array, decimals: int = _DRAWN) -> list[float | None]:
    """Values to draw: rounded, small ones to more decimals, None where they are missing."""
    return _rounded(values, _decimals([values], decimals))


def fact_sentences(facts: Iterable[Row], digits: int = 6) -> list[Sentence]:
    """Facts in words: the name of each, its value or both its ends, where it is, which is in degrees, and its note."""
    sentences = []
    for row in facts:
        ends = row.value if isinstance(row.value, tuple) else (row.value,)
        known = [end if isinstance(end, str) else Amount(end, row.unit, digits) for end in ends if end is not None]
        between = ": " if isinstance(row.value, str) else " " if known else ""
        place = "" if row.place is None else sentence(" at {}", Amount(round(row.place, _DRAWN) + 0.0, "deg", 5))
        note = sentence(": {}", row.note) if row.note else ""
        sentences.append(sentence("{}{}{}{}{}", row.name, between, joined(" to ", dict.fromkeys(known)), place, note))
    return sentences


def panel_data(panel: Panel) -> dict[str, Any]:
    """A panel as JSON: its peaks or, where none are marked, its ends in words."""
    per = panel.per
    places = _decimals([per * curve.at for curve in panel.series], _DRAWN if per == 1.0 else _PLACES)
    digits = _decimals([curve.values for curve in panel.series], _DRAWN)
    shown: dict[str, Any] = {
        "name": panel.name,
        "unit": panel.unit,
        "series": [
            {"law": law, "at": _rounded(per * at, places), "values": _rounded(values, digits)}
            | ({"name": name} if name else {})
            | ({"dots": True} if dots else {})
            for at, values, law, name, dots in panel.series
        ],
        "limits": [
            {
                "from": round(per * start, places),
                "to": round(per * stop, places),
                "value": bounded(high),
                "least": bounded(low),
            }
            for start, stop, low, high, _ in panel.limits
        ],
        "peaks": [{"at": round(per * at, places), "value": value} for at, value in panel.peaks],
    }
    return (
        shown if panel.peaks or not any(panel.ends) or not isfinite(panel.peak) else shown | {"ends": list(panel.ends)}
    )


def segments_data(segments: Iterable[ReportSegment], panel: Panel) -> list[dict[str, Any]]:
    """Segments as JSON, over what a panel is over."""
    return [{"name": name, "at": [round(panel.per * end, 9) for end in ends]} for name, *ends in segments]


def table_data(table: ReportTable) -> dict[str, Any]:
    """A table as JSON; the numbers of a row with a unit have it with them."""
    headings = list(table.headings)
    rows: list[list[Any]] = [[bounded(cell) if isinstance(cell, float) else cell for cell in row] for row in table.rows]
    if "unit" in headings:
        at = headings.index("unit")
        del headings[at]
        for row in rows:
            unit = row.pop(at)
            row[:at] = [Amount(cell, unit) if isinstance(cell, float) else cell for cell in row[:at]]
    return {"headings": headings, "rows": rows}


def over_time(panels: Sequence[dict[str, Any]], duration: float, of: str = "") -> dict[str, Any]:
    """Panels as JSON over the time in milliseconds, and what they are of."""
    return {
        "across": "time",
        "unit": "ms",
        "note": of,
        "symbol": "t",
        "range": [0.0, MILLI * duration],
        "panels": panels,
    }


def beside_each_other(shown: Sequence[Panel], laws: Sequence[tuple[int, Sequence[Panel]]]) -> list[Panel]:
    """The panels of what is shown, each with the curves of all laws in their colours."""
    return [panel.with_curves([(law, panels[i]) for law, panels in laws]) for i, panel in enumerate(shown)]
