"""Rows that say how much a cycle takes of limits that its peaks do not show: of one side, slowing down, the snap."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

from optlaws.cycles.optimisation.motion_limits import (
    LimitKey,
    OneSided,
    amount,
    limits_of_segment,
    name_of,
    read_limits,
)
from optlaws.cycles.specification.programme import is_optimal
from optlaws.motion.piece import unit_of
from optlaws.shown.summary import Row

if TYPE_CHECKING:
    from optlaws.cycles.cycle import Cycle

_SNAP = 4


class _Taken(NamedTuple):
    """The use of a limit by a segment: the share, the row's name, and the row."""

    share: float
    name: str
    row: Row


def limit_rows(cycle: Cycle) -> list[Row]:
    """Rows of limits: the value in the segment that uses most of the limit, with its time and the limit.

    Examples
    --------
    >>> from optlaws import Cycle, Return, Rise
    >>> limits = {"deceleration": "14 m/s^2", "acceleration": "25 m/s^2"}
    >>> cycle = Cycle([Rise("35 mm", "0.1 s"), Return()], period="0.25 s", limits=limits, minimise="jerk")
    >>> [(row.name, round(row.value, 6), row.note) for row in limit_rows(cycle)][0]
    ('deceleration', 14.0, 'limit 14 m/s^2 of segment 1 (Rise)')
    """
    most: dict[str, _Taken] = {}
    for taken in _of_segments(cycle):
        if taken.name not in most or taken.share > most[taken.name].share:
            most[taken.name] = taken
    return [taken.row for taken in most.values()]


def _of_segments(cycle: Cycle) -> Iterator[_Taken]:
    of_cycle = read_limits(cycle.limits, cycle.axis, "limits")
    for i, stretch in enumerate(cycle.programme.stretches):
        limits = limits_of_segment(stretch, of_cycle, cycle.axis) if is_optimal(stretch.given) else {}
        for key, limit in limits.items():
            if isinstance(key, OneSided) or key == _SNAP:
                value, time = _greatest(cycle, i, key)
                name = name_of(key, cycle.axis)
                nu = key if isinstance(key, int) else key.nu
                note = f"limit {amount(key, limit, cycle.axis)} of {stretch.where}"
                yield _Taken(value / limit, name, Row(name, value, unit_of(cycle.axis, nu), time, note))


def _greatest(cycle: Cycle, number: int, key: LimitKey) -> tuple[float, float]:
    """The greatest magnitude in a segment on the side that a limit bounds, and its time."""
    peaks = cycle.peaks[number]
    nu = key if isinstance(key, int) else key.nu
    piece = next(piece for piece in reversed(cycle.pieces) if piece.start <= peaks.start)
    (low, first), (high, last) = piece.extremes(nu, peaks.start, peaks.start + peaks.duration)
    if isinstance(key, OneSided):
        return (high, last) if key.sign > 0.0 else (-low, first)
    return max((abs(low), first), (abs(high), last))
