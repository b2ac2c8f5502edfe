"""The use of limits by a cycle, whatever its laws; the refusal of given laws beyond them; and rows of limits."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from math import inf, isfinite
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

from optlaws.cycles.optimisation.span_values import along
from optlaws.cycles.placed import SegmentPeaks, segments_in_place
from optlaws.cycles.specification.limits import (
    FORCE_UNITS,
    FORCES,
    MOTOR,
    Limits,
    LimitTaken,
    Side,
    amount,
    name_of,
    read_limits,
)
from optlaws.cycles.specification.programme import TimedSegment, is_optimal
from optlaws.cycles.specification.segments import Dwell, Move
from optlaws.errors import InfeasibleProblem
from optlaws.motion.piece import Piece, jump_beside, unit_of
from optlaws.motion.quantities import Kind
from optlaws.numerics.peaks import is_kept
from optlaws.sentences import Amount, joined, sentence
from optlaws.tolerances import AGREEMENT

if TYPE_CHECKING:
    from optlaws.mechanisms.drives.drive_train import Drive
    from optlaws.shown.summary import Row

#: a `Cycle`, and its `Plan`, which know this module
Cycle: TypeAlias = Any
Plan: TypeAlias = Any

_JERK = 3
_OF_MOTOR = {"speed": "rad/s", "torque-speed curve": ""}


class _Taken(NamedTuple):
    """The use of a limit by a segment, with the key of the limit and the time."""

    key: Side
    taken: LimitTaken
    time: float | None
    stretch: TimedSegment


def limits_taken(plan: Plan, limited: Cycle | None = None) -> tuple[LimitTaken, ...]:
    """The use of every limit of a plan's cycle, or of another cycle with the same segments, by all its laws.

    Of each limit the segment that takes most of it counts. A motor's limits are those of the sheet.
    """
    given = plan.specification if limited is None else limited
    of_cycle = _limits(given)
    segments = _of_segments(plan.peaks, plan.specification, of_cycle, given.programme.stretches)
    return (*(taken.taken for taken in _most(segments)), *_of_whole(plan, given))


def broken_limits(plan: Plan) -> Sequence[str]:
    """What its laws take beyond its limits, and beyond those of its motor."""
    broken = [sentence("{}", taken) for taken in plan.limits_taken if not taken.is_kept]
    if hasattr(plan.specification.drive, "motor") and not plan.specification.limits.get(MOTOR):
        weak = (margin for margin in plan.sheet.margins if not margin.is_kept)
        uses = ((each.name, f"{100.0 * each.use:.4g}".replace("inf", "∞")) for each in weak)
        broken += [sentence("the motor's {}, {} % of it", *use) for use in uses]
    return broken


def refuse_beyond(cycle: Cycle) -> None:
    """Refuse given laws that break a limit of the cycle or of their segments.

    Where no law is optimised, the limits of the whole are looked at as well.

    Raises
    ------
    InfeasibleProblem
        If a limit is broken: by how much, and what helps; its `proof` is every `LimitTaken` that is.
    """
    placed = segments_in_place(cycle.programme, cycle.layout.starts, cycle.layout.pieces)
    taken = list(_of_segments(placed, cycle, cycle.in_si.limits, cycle.programme.stretches))
    broken = [each for each in taken if not each.taken.is_kept]
    if not any(is_optimal(segment) for segment in cycle.segments):
        # limits of the motor but its rating are among those of the segments
        known = {f"motor's {name}" for name in ("peak torque", "torque-speed curve", "speed")}
        whole = _of_whole(cycle.unchecked(), cycle)
        of_whole = [each for each in whole if not each.is_kept and each.name not in known]
    else:
        of_whole = []
    proof = (*(each.taken for each in broken), *of_whole)
    if proof:
        others = "" if len(proof) == 1 else sentence("; beyond a limit is also {}", joined("; ", proof[1:]))
        reason = _reason(broken[0], cycle) if broken else sentence(
            "limits: the {} over the cycle is {}, but its limit is {}: allow more, give the cycle more time, or give "
            "its moves other laws",
            proof[0].name, proof[0].value_text, proof[0].text,
        )  # fmt: skip
        raise InfeasibleProblem(sentence("{}{}", reason, others), proof=proof)


def _reason(broken: _Taken, cycle: Cycle) -> str:
    """The limit that a given law breaks, and what helps."""
    key, taken, time, stretch = broken
    nu = key.kind.order
    at = "" if time is None else sentence(" at {} of the master", Amount(360.0 * time / cycle.duration, "deg"))
    if not isfinite(taken.value):
        return sentence(
            "{}: its {} jumps{}, so that no time keeps the {} {}: take a smoother law, or leave that limit out",
            taken.where, "acceleration" if nu == _JERK else "law", at, taken.name, taken.text,
        )  # fmt: skip
    if key.kind is Kind.VELOCITY_ALONG:
        return sentence(
            "{}: it goes back at {}{}, which its velocity must not: give it another law, or a least velocity below 0",
            taken.where, taken.value_text, at,
        )  # fmt: skip
    longer = f"{taken.share ** (1.0 / nu):.6g} times as much time" if nu else "more time"
    remedy = f"give it {longer}, a wider limit{', or another law' * isinstance(stretch.given, Move)}"
    if isinstance(stretch.given, Dwell):
        remedy = "allow more, or change the drive's spring, preload, gravity or friction"
    return sentence(
        "{}: it takes the {} {}{}, but its limit is {}: {}",
        taken.where, taken.name, taken.value_text, at, taken.text, remedy,
    )  # fmt: skip


def limit_rows(plan: Plan) -> list[Row]:
    """Rows of limits: the value in the segment that uses most of the limit, with its time and the limit."""
    from optlaws.shown.summary import Row

    limits = _limits(plan.specification)
    taken_of = _of_segments(
        plan.peaks,
        plan.specification,
        limits,
        plan.programme.stretches,
        # peaks of a cycle do not show what is limited there
        keys=lambda key: bool(key.sign) or key.kind is Kind.SNAP,
    )
    return [
        Row(taken.name, taken.value, unit_of(plan.axis, key.kind.order), time, f"limit {taken.text} of {taken.where}")
        for key, taken, time, _ in _most(taken_of)
    ]


def _most(taken: Iterable[_Taken]) -> list[_Taken]:
    """For each limit, by name, the quantity that uses most of it."""
    most: dict[str, _Taken] = {}
    for each in taken:
        if each.taken.name not in most or each.taken.share > most[each.taken.name].taken.share:
            most[each.taken.name] = each
    return list(most.values())


def _of_segments(
    placed: Sequence[SegmentPeaks],
    cycle: Cycle,
    of_cycle: Limits,
    limited: Sequence[TimedSegment],
    *,
    keys: Callable[[Side], bool] = lambda _: True,
) -> Iterator[_Taken]:
    """The use of limits by segments, whose own are those of `limited`; rests take of those of a drive alone."""
    axis, pieces = cycle.axis, [each.piece for each in placed]
    for each in placed:
        limits = limited[each.stretch.number - 1].sides(of_cycle)
        for key, limit in limits.items():
            if keys(key) and (key.kind.is_driven or not isinstance(each.stretch.given, Dwell)):
                if key.kind.is_driven:
                    value, time = _greatest_of_drive(each, key.kind, cycle.in_si.drive)
                else:
                    value, time = _greatest(each, key, pieces, cycle.duration)
                texts = (amount(key, size, axis) for size in (limit, value))
                yield _Taken(
                    key, LimitTaken(name_of(key, axis), each.stretch.where, value, limit, *texts), time, each.stretch
                )


def _greatest(placed: SegmentPeaks, key: Side, pieces: Sequence[Piece], period: float) -> tuple[float, float | None]:
    """The greatest magnitude in a segment on the side that a limit bounds, and its time where it has one."""
    piece, nu = placed.piece, key.kind.order
    if placed.moves and not is_optimal(placed.stretch.given):
        if not isfinite(piece.law.peak(nu).value):
            return inf, piece.start + piece.law.peak(nu).k * piece.duration
        jump = jump_beside(piece, pieces, period) if nu >= _JERK else None
        if jump is not None:
            return inf, jump
    (low, first), (high, last) = placed.ends(nu)
    if key.sign:
        value, time = (high, last) if key.sign > 0.0 else (-low, first)
        still = key.kind is Kind.VELOCITY_ALONG and value <= AGREEMENT * max(high, -low)
        return 0.0 if still else value, time
    before, after = sorted([(first, abs(low)), (last, abs(high))])
    return (before if is_kept(after[1], before[1]) else after)[::-1]


def _greatest_of_drive(placed: SegmentPeaks, kind: Kind, drive: Drive | None) -> tuple[float, float | None]:
    """The greatest force or power in a segment, or share of the motor's curve of torque over speed."""
    taken = along(drive, placed.piece, (placed.start, placed.stop))
    if kind is Kind.POWER:
        return max(taken.powers), None
    if kind is Kind.FORCE:
        return taken.peak_force
    return taken.parts.greatest(taken.use)


def _of_whole(plan: Plan, limited: Cycle) -> Iterator[LimitTaken]:
    """The use of limits of the whole: of means and sums, of the motor, of the load."""
    of_cycle = _limits(limited)
    force, unit = FORCES[plan.axis], FORCE_UNITS[plan.axis]
    if Kind.RMS_FORCE in of_cycle:
        yield _of_cycle(f"rms {force}", plan.effort.rms_force, of_cycle[Kind.RMS_FORCE][1], unit)
    if Kind.ENERGY in of_cycle:
        yield _of_cycle("energy", plan.effort.energy, of_cycle[Kind.ENERGY][1], "J")
    for margin in plan.sheet.margins if limited.limits.get(MOTOR) else ():
        unit = _OF_MOTOR.get(margin.name, "N m")
        yield _of_cycle(f"motor's {margin.name}", margin.needed, margin.limit, unit)
    for (output, rms), limit in limited.in_si.loaded.items():
        value = plan.load_motion.rms(output) if rms else plan.load_motion.peak(output).value
        yield _of_cycle(f"{'rms ' * rms}load {output}", value, limit, "")


def _limits(cycle: Cycle) -> Limits:
    """The limits of a cycle itself, without those of its motor."""
    return read_limits(cycle.limits, cycle.axis, "limits", cycle.in_si.load)


def _of_cycle(name: str, value: float, limit: float, unit: str) -> LimitTaken:
    return LimitTaken(name, "", value, limit, *(Amount(size, unit) for size in (limit, value)))
