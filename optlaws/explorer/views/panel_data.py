"""Panels of reports as the page draws them."""

from __future__ import annotations

from math import isfinite
from typing import Any

import numpy as np

from optlaws.motion.display_units import MILLI
from optlaws.numbers import Array, bounded
from optlaws.shown.report import Panel

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
