"""The use of limits by a cycle, whatever its laws; and rows of those limits that its peaks do not show."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, NamedTuple

from optlaws.cycles.optimisation.motion_limits import (
    FORCE,
    FORCES,
    POWER,
    LimitKey,
    OneSided,
    amount,
    limits_of_segment,
    name_of,
    read_limits,
)
from optlaws.cycles.optimisation.motor_limits import MOTOR
from optlaws.cycles.optimisation.objectives import read_energy, read_load_limits, read_mean_force
from optlaws.cycles.specification.load import read_load
from optlaws.cycles.specification.process import is_process
from optlaws.cycles.specification.programme import is_optimal
from optlaws.cycles.specification.segments import Free, Move
from optlaws.motion.piece import unit_of
from optlaws.shown.summary import Row
from optlaws.tolerances import AGREEMENT

if TYPE_CHECKING:
    from optlaws.cycles.cycle import Cycle

_SNAP = 4
_OF_MOTOR = {"speed": "rad/s", "torque-speed curve": ""}


class LimitTaken(NamedTuple):
    """The use of a limit by a motion, in SI units.

    Attributes
    ----------
    name
        What is limited, such as "velocity".
    where
        The segment that takes most of it; empty of a limit of the whole.
    value, limit
        What is taken, and what is allowed.
    text
        The limit in the unit that machines have it in.
    """

    name: str
    where: str
    value: float
    limit: float
    text: str

    @property
    def share(self) -> float:
        """The share that is taken: above 1 where the limit is broken."""
        return self.value / self.limit

    @property
    def is_kept(self) -> bool:
        """Whether the limit is satisfied, up to rounding."""
        return self.share <= 1.0 + AGREEMENT


class _Taken(NamedTuple):
    """The use of a limit by a segment, with the key of the limit and the time."""

    key: LimitKey
    taken: LimitTaken
    time: float | None


def limits_taken(cycle: Cycle, limited: Cycle | None = None) -> tuple[LimitTaken, ...]:
    """The use of every limit of a cycle, or of another cycle with the same segments, by all its laws.

    Of each limit the segment that takes most of it counts. A motor's limits are those of the sheet.

    Examples
    --------
    >>> from optlaws import Cycle, Return, Rise
    >>> moves = [Rise("35 mm", "0.1 s", law="cycloidal"), Return(law="cycloidal")]
    >>> (taken,) = limits_taken(Cycle(moves, period="0.25 s", limits={"velocity": "616 mm/s"}))
    >>> taken.name, taken.where, round(taken.share, 4), taken.is_kept
    ('velocity', 'segment 1 (Rise)', 1.1364, False)
    """
    given = cycle if limited is None else limited
    return (*(taken.taken for taken in _most(_of_segments(cycle, given, every=True))), *_of_whole(cycle, given))


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
    return [
        Row(
            taken.name,
            taken.value,
            unit_of(cycle.axis, key if isinstance(key, int) else key.nu),
            time,
            f"limit {taken.text} of {taken.where}",
        )
        for key, taken, time in _most(_of_segments(cycle, cycle, every=False))
        if isinstance(key, OneSided) or key == _SNAP
    ]


def _most(taken: Iterable[_Taken]) -> list[_Taken]:
    """For each limit, by name, the quantity that uses most of it."""
    most: dict[str, _Taken] = {}
    for each in taken:
        if each.taken.name not in most or each.taken.share > most[each.taken.name].taken.share:
            most[each.taken.name] = each
    return list(most.values())


def _of_segments(cycle: Cycle, limited: Cycle, *, every: bool) -> Iterator[_Taken]:
    """The use of the limits of `limited` by segments with an optimal law, or by every moving one."""
    of_cycle = read_limits(limited.limits, cycle.axis, "limits")
    for i, (stretch, given) in enumerate(zip(cycle.programme.stretches, limited.programme.stretches, strict=True)):
        has_limits = isinstance(stretch.given, Move | Free) if every else is_optimal(stretch.given)
        limits = limits_of_segment(given, of_cycle, cycle.axis) if has_limits else {}
        for key, limit in limits.items():
            value, time = _greatest(cycle, i, key)
            name = name_of(key, cycle.axis)
            yield _Taken(key, LimitTaken(name, stretch.where, value, limit, amount(key, limit, cycle.axis)), time)


def _greatest(cycle: Cycle, number: int, key: LimitKey) -> tuple[float, float | None]:
    """The greatest magnitude in a segment on the side that a limit bounds, and its time where it has one."""
    if key in {FORCE, POWER}:
        effort = cycle.efforts[number]
        return (effort.peak_force if key == FORCE else max(effort.motoring_power, effort.braking_power)), None
    peaks = cycle.peaks[number]
    nu = key if isinstance(key, int) else key.nu
    piece = next(piece for piece in reversed(cycle.pieces) if piece.start <= peaks.start)
    (low, first), (high, last) = piece.extremes(nu, peaks.start, peaks.start + peaks.duration)
    if isinstance(key, OneSided):
        return (high, last) if key.sign > 0.0 else (-low, first)
    return max((abs(low), first), (abs(high), last))


def _of_whole(cycle: Cycle, limited: Cycle) -> Iterator[LimitTaken]:
    """The use of limits of the whole: of means and sums, of the motor, of the load."""
    mean, energy = read_mean_force(limited.limits, cycle.axis), read_energy(limited.limits)
    force, unit = FORCES[cycle.axis], "N" if cycle.axis == "length" else "N m"
    if mean is not None:
        yield LimitTaken(f"rms {force}", "", cycle.effort.rms_force, mean, f"{mean:.6g} {unit}")
    if energy is not None:
        yield LimitTaken("energy", "", cycle.effort.energy, energy, f"{energy:.6g} J")
    for margin in cycle.sheet.margins if limited.limits.get(MOTOR) else ():
        text = f"{margin.limit:.6g} {_OF_MOTOR.get(margin.name, 'N m')}".strip()
        yield LimitTaken(f"motor's {margin.name}", "", margin.needed, margin.limit, text)
    load = None if limited.load is None or is_process(limited.load) else read_load(limited.load, cycle.axis)
    for (output, rms), limit in read_load_limits(limited.limits, load).items():
        value = cycle.load_motion.rms(output) if rms else cycle.load_motion.peak(output).value
        yield LimitTaken(f"{'rms ' * rms}load {output}", "", value, limit, f"{limit:.6g}")
