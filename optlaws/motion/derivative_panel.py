"""A derivative of a motion as a panel of a report: its curve through its extremes, with its limits and its peaks."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from optlaws.motion.piece import Piece, unit_of
from optlaws.motion.quantities import DEGREES, QUANTITIES, UNITS
from optlaws.numbers import Array, chop
from optlaws.shown.curve_points import away_from, refined
from optlaws.shown.report import Panel, PanelLimit, Series
from optlaws.tolerances import CYCLE_ROUNDING

_EACH = 60  # samples of a piece, to which those are added that its curve needs

Place = tuple[float, float]
#: the names of derivatives by their order
DERIVATIVES = (*QUANTITIES, "snap")


def display_unit(axis: str, nu: int) -> tuple[str, float]:
    """The unit in which a derivative is shown, and how many of it are one of SI."""
    return UNITS[axis][nu] if nu < len(QUANTITIES) else (unit_of(axis, nu), 1.0)


def picture_unit(axis: str, nu: int) -> tuple[str, float]:
    """The unit of a derivative in pictures of all: degrees of an angle, by whatever time, as its position has them.

    >>> picture_unit("angle", 2)[0], picture_unit("length", 2)[0]
    ('deg/s²', 'm/s²')
    """
    if axis == "length":
        return display_unit(axis, nu)
    return unit_of(axis, nu).replace("rad", "deg"), DEGREES


def motion_panel(
    pieces: Sequence[Piece],
    nu: int,
    unit: tuple[str, float],
    extremes: Sequence[Place],
    limits: Sequence[PanelLimit] = (),
) -> Panel:
    """The derivative of order nu of pieces; extremes are values with their times, limits are in SI units."""
    name, factor = unit
    places = [times_in(piece, _EACH) for piece in pieces]
    times = np.concatenate(places)
    values = np.concatenate([piece.values(at, nu) for piece, at in zip(pieces, places, strict=True)])

    def inside(at: Array) -> Array:
        number = np.searchsorted([piece.start for piece in pieces[1:]], at, side="right")
        parts = [piece.values(at, nu) for piece in pieces]
        return np.asarray(np.choose(number, parts)) if len(parts) > 1 else parts[0]

    times, (values,) = refined(times, [values], [inside], np.array([time for _, time in extremes]))
    least, most = (end(extremes, key=lambda place: place[0]) for end in (min, max))
    size = max(-least[0], most[0])
    peaks = tuple((time, value * factor) for value, time in (least, most) if chop(value, size, CYCLE_ROUNDING))
    shown = tuple(limit._replace(low=factor * limit.low, high=factor * limit.high) for limit in limits)
    ends = factor * least[0], factor * most[0]
    return Panel(DERIVATIVES[nu], name, (Series(times, factor * values),), shown, peaks, ends)


def times_in(piece: Piece, count: int) -> Array:
    """Times at equal steps in a piece, and its breaks."""
    breaks = piece.start + piece.duration * np.array(piece.law.breaks)
    even = np.linspace(piece.start, piece.stop, count)
    return np.sort(np.concatenate([away_from(even, breaks), breaks]))
