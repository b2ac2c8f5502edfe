"""Enclosed extremes as pages and programs are told them."""

from __future__ import annotations

from dataclasses import dataclass
from math import degrees

import numpy as np

from optlaws.cams.curves.extremes import EnclosedExtreme
from optlaws.cams.disc import DiscCam
from optlaws.cams.summary import geometry
from optlaws.files import tables

EXTREMES = ("what", "at least", "at most", "unit", "at, deg")
_REACHED = 1e-7


@dataclass(frozen=True)
class Limits:
    """Limits that laws were made for, in SI units: they touch them at several angles, of which none is the one.

    Examples
    --------
    >>> Limits.reached(0.0100000000001, 0.01), Limits.reached(0.01, None)
    (True, False)
    """

    pressure: float | None = None
    radius: float | None = None

    @staticmethod
    def reached(value: float, limit: float | None) -> bool:
        """Whether a value is that of a limit."""
        return limit is not None and abs(abs(value) - limit) <= _REACHED * limit


def extreme_rows(cam: DiscCam, limits: Limits) -> list[list[tables.Cell]]:
    """Rows of a table of extreme pressure angles and radii of curvature."""
    touched, concave = {"deg": limits.pressure, "mm": limits.radius}, cam.extremes.least_concave_radius
    return [
        extreme_row(name, extreme, factor, unit, None if extreme is concave else touched[unit])
        for name, extreme, unit, factor in geometry(cam)
    ]


def extreme_row(
    name: str, extreme: EnclosedExtreme, factor: float, unit: str, limit: float | None = None
) -> list[tables.Cell]:
    """The row of an extreme, in a unit of so many to the SI unit; without its angle where laws touch it as a limit.

    Examples
    --------
    >>> extreme_row("radius", EnclosedExtreme(0.01, 0.01, 0.0), 1e3, "mm")
    ['radius', 10.0, 10.0, 'mm', 0.0]
    """
    low, high = (plain(factor * value) for value in (extreme.low, extreme.high))
    return [name, low, high if np.isfinite(high) else None, unit, _angle(extreme, limit, degrees(extreme.angle))]


def enclosure(extreme: EnclosedExtreme, limit: float | None = None) -> dict[str, float | None]:
    """The enclosure of an extreme for programs, in SI units."""
    high = extreme.high if np.isfinite(extreme.high) else None
    return {"low": extreme.low, "high": high, "angle": _angle(extreme, limit, extreme.angle)}


def _angle(extreme: EnclosedExtreme, limit: float | None, angle: float) -> float | None:
    return None if Limits.reached(extreme.value, limit) else angle


def plain(value: float) -> float:
    """The value, or 0 where it is rounding.

    Examples
    --------
    >>> plain(-3e-17), plain(0.5)
    (0.0, 0.5)
    """
    return 0.0 if abs(value) < 1e-12 else value
