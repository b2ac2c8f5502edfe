"""Panels and facts of reports as the page shows them."""

from __future__ import annotations

from collections.abc import Iterable
from math import isfinite
from typing import Any

import numpy as np

from optlaws.motion.display_units import MILLI
from optlaws.numbers import Array, bounded
from optlaws.sentences import Amount, Sentence, joined, sentence
from optlaws.shown.report import Panel
from optlaws.shown.summary import Row

_DRAWN = 6  # decimals of what is drawn; what is read is a text of its own
_PLACES = 4  # decimals of where


def drawn(values: Array, decimals: int = _DRAWN) -> list[float | None]:
    """Values to draw: rounded, None where they are missing.

    Examples
    --------
    >>> drawn(np.array([1.23456789, np.inf]))
    [1.234568, None]
    """
    return [value if isfinite(value) else None for value in np.round(values, decimals).tolist()]


def fact_sentences(facts: Iterable[Row], digits: int = 7) -> list[Sentence]:
    """Facts in words: the name of each, its value or both its ends, and where it is, which is in degrees.

    Examples
    --------
    >>> fact_sentences([Row("contact force", (78.0, 151.5), "N"), Row("radius", (5.0, 5.0), "mm", 30.0)])
    ['contact force 78 N to 151.5 N', 'radius 5 mm at 30 deg']
    """
    sentences = []
    for row in facts:
        ends = row.value if isinstance(row.value, tuple) else (row.value,)
        values = joined(" to ", dict.fromkeys(Amount(end, row.unit, digits) for end in ends if end is not None))
        place = "" if row.place is None else sentence(" at {}", Amount(round(row.place, _DRAWN) + 0.0, "deg", 5))
        sentences.append(sentence("{}{}{}{}", row.name, " " if values else "", values, place))
    return sentences


def panel_data(panel: Panel, per: float = MILLI) -> dict[str, Any]:
    """A panel as JSON, over so many units of time a second: its peaks or, where none are marked, its ends in words."""
    places = _DRAWN if per == 1.0 else _PLACES  # dimensionless, from 0 to 1
    shown: dict[str, Any] = {
        "name": panel.name,
        "unit": panel.unit,
        "series": [
            {"law": law, "at": drawn(per * at, places), "values": drawn(values)} | ({"name": name} if name else {})
            for at, values, law, name in panel.series
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
