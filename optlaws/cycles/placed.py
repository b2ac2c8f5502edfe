"""Segments with their laws in their places: their extremes, the limits that they take, and the same otherwise timed."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import inf, isfinite
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias, TypeVar

from optlaws.cycles.optimisation.objectives import kind_of
from optlaws.cycles.optimisation.span_values import along
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
from optlaws.cycles.specification.programme import Programme, TimedSegment, is_optimal
from optlaws.cycles.specification.segments import ConstantVelocity, CycleSegment, Dwell, Free, Move
from optlaws.cycles.specified import Specification
from optlaws.errors import InfeasibleProblem, InputError
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.motion.piece import Piece, jump_beside, unit_of
from optlaws.motion.quantities import QUANTITIES, Exact, Kind
from optlaws.numerics.peaks import is_kept
from optlaws.sentences import Amount, joined, sentence
from optlaws.tolerances import AGREEMENT, BINDING_LIMIT, CLOSURE, SAME_TIME, VALUE_ROUNDING

if TYPE_CHECKING:
    from optlaws.mechanisms.drives.effort import Margin
    from optlaws.shown.summary import Row

#: a `Cycle`, and its `Plan`, which know this module
Cycle: TypeAlias = Any
Plan: TypeAlias = Any

Place = tuple[float, float]
T = TypeVar("T", bound=Specification)
_JERK = 3
_OF_MOTOR = {"speed": "rad/s", "torque-speed curve": ""}


@dataclass(frozen=True)
class SegmentPeaks:
    """A segment in its place: its least and greatest position, velocity, acceleration and jerk; SI units.

    Attributes
    ----------
    stretch
        The segment in numbers.
    piece
        Its law in its place, which may be that of its neighbours too.
    start, stop
        When it begins and ends.
    """

    stretch: TimedSegment
    piece: Piece
    start: float
    stop: float

    @property
    def name(self) -> str:
        """The name of the segment, or of its kind."""
        return self.stretch.given.label

    @property
    def duration(self) -> float:
        """How long it takes."""
        return self.stop - self.start

    @property
    def moves(self) -> bool:
        """Whether it has a law; else it is straight."""
        return isinstance(self.stretch.given, Move | Free)

    def ends(self, nu: int) -> tuple[Place, Place]:
        """The least and the greatest value of a derivative over the whole of it, each with its time."""
        if nu not in self._ends:
            # straight: what its law has beside is rounding
            velocity = self.stretch.displacement / self.duration if nu == 1 else 0.0
            known = self.moves or nu == 0
            self._ends[nu] = self.piece.extremes(nu, self.start, self.stop) if known else ((velocity, self.start),) * 2
        return self._ends[nu]

    @property
    def extremes(self) -> tuple[tuple[Place, Place], ...]:
        """The least and the greatest value of the position and of its derivatives up to the jerk, with their times."""
        return tuple(map(self.ends, range(len(QUANTITIES))))

    @kept_property
    def _ends(self) -> dict[int, tuple[Place, Place]]:
        return {}

    def peak(self, nu: int) -> float:
        """The greatest magnitude of the derivative of order nu."""
        return max(abs(value) for value, _ in self.ends(nu))


def segments_in_place(
    programme: Programme, starts: Sequence[float], pieces: Sequence[Piece]
) -> tuple[SegmentPeaks, ...]:
    """The segments whose laws are among the pieces."""
    placed = []
    for stretch, (start, stop) in zip(programme.stretches, pairwise(starts), strict=True):
        at = [piece for piece in pieces if piece.start <= start < piece.stop]
        placed += [SegmentPeaks(stretch, piece, start, stop) for piece in at[-1:]]
    return tuple(placed)


def with_laws(cycle: T, segments: Sequence[CycleSegment], period: float | None = None, **others: Any) -> T:
    """The cycle with other segments, whose laws are known, and other entries; in another period if that is given.

    Laws that are known leave nothing of a load to look for.
    """
    if kind_of(cycle.minimise)[0] is Kind.LOAD:
        others["minimise"] = "acceleration"
    if period is not None:
        others |= {"speed": None, "period": Exact(period, "s")}
    return replace(cycle, segments=segments, **others)


def retimed(
    cycle: T,
    placed: Sequence[SegmentPeaks],
    period: float,
    share: float = 1.0,
    law: Callable[[SegmentPeaks], MotionLaw] | None = None,
    **others: Any,
) -> T:
    """The cycle in a period, with durations multiplied by `share`, by their own laws, joint ones in parts, or others.

    Its limits are kept unless others are given.
    """
    axis, segments, same_time = cycle.axis, list[CycleSegment](), SAME_TIME * placed[-1].stop
    for each in placed:
        time, moved = Exact(each.duration * share, "s"), each.stretch.displacement
        if isinstance(each.stretch.given, Dwell):
            segments.append(Dwell(time, name=each.name))
        elif isinstance(each.stretch.given, ConstantVelocity) and law is None:
            velocity = Exact(moved / each.duration / share, f"{unit_of(axis)}/s")
            segments.append(ConstantVelocity(velocity, time, name=each.name))
        else:
            parts = _parts(each, same_time) if law is None else [(moved, each.duration, law(each))]
            segments += [
                Move(Exact(way, unit_of(axis)), Exact(part * share, "s"), law=known, name=each.name)
                for way, part, known in parts
            ]
    return with_laws(cycle, segments, period, **others)


def _parts(placed: SegmentPeaks, same_time: float) -> list[tuple[float, float, MotionLaw]]:
    """Stroke, time and law of a segment: of one move, or of two where it ends at its starting position."""
    moved, piece, law, times = placed.stretch.displacement, placed.piece, placed.piece.law, (placed.start, placed.stop)
    alone = abs(piece.start - placed.start) <= same_time and abs(piece.stop - placed.stop) <= same_time
    if alone and abs(piece.stroke - moved) <= CLOSURE * abs(moved):
        return [(moved, placed.duration, law)]
    if not isinstance(law, PiecewiseLaw):
        raise InputError(
            f"{placed.stretch.where} ends where it begins: give it to a Cycle of its own at the other speed"
        )
    from optlaws.laws.making.transform import section

    joints = [piece.start + place * piece.duration for place in law.breaks]
    first, last = (min(range(len(joints)), key=lambda i: abs(joints[i] - time)) for time in times)
    ends = [first, last]
    if abs(moved) <= CLOSURE * abs(piece.stroke):
        heights = [abs(float(law(place)) - float(law(law.breaks[first]))) for place in law.breaks[first : last + 1]]
        ends.insert(1, first + heights.index(max(heights)))
    parts, left = list[tuple[float, float, MotionLaw]](), moved
    for low, high in pairwise(ends):
        way = left if high == last else piece.stroke * (float(law(law.breaks[high])) - float(law(law.breaks[low])))
        parts.append((way, piece.duration * (law.breaks[high] - law.breaks[low]), section(law, low, high)))
        left -= way
    return parts


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
    return (*(each.taken for each in _most(plan, given)), *_of_whole(plan, given))


def limits_reached(plan: Plan) -> tuple[LimitTaken, ...]:
    """The use of every limit as `limits_taken` has it, and by every other segment that takes it to the full."""
    given = plan.specification
    most = {each.taken for each in _most(plan, given)}
    each = (known.taken for known in _taken(plan, given))
    full = (taken for taken in each if taken in most or taken.share >= 1.0 - BINDING_LIMIT)
    return (*full, *_of_whole(plan, given))


def broken_limits(plan: Plan, limited: Cycle | None = None) -> Sequence[str]:
    """What its laws take beyond its limits and those of its motor, or beyond those of another cycle like it."""
    broken = [sentence("{}", taken) for taken in limits_taken(plan, limited) if not taken.is_kept]
    overloaded = overloads(plan) if limited is None else []
    uses = ((each.name, f"{100.0 * each.use:.4g}".replace("inf", "∞")) for each in overloaded)
    return [*broken, *(sentence("the motor's {}, {} % of it", *use) for use in uses)]


def overloads(plan: Plan) -> list[Margin]:
    """The limits of its motor that it goes beyond; none where its laws are to keep them."""
    if not hasattr(plan.specification.drive, "motor") or plan.specification.limits.get(MOTOR):
        return []
    return [margin for margin in plan.sheet.margins if not margin.is_kept]


def refuse_beyond(cycle: Cycle) -> None:
    """Refuse given laws that break a limit of the cycle or of their segments.

    Where no law is optimised, the limits of the whole are looked at as well.

    Raises
    ------
    InfeasibleProblem
        If a limit is broken: by how much, and what helps; its `proof` is every `LimitTaken` that is.
    """
    placed = segments_in_place(cycle.programme, cycle.layout.starts, cycle.layout.pieces)
    taken = _of_segments(placed, cycle, cycle.in_si.limits, cycle.programme.stretches)
    broken = [each for each in taken if not each.taken.is_kept]
    # limits of the motor but its rating are among those of the segments
    known = {f"motor's {name}" for name in ("peak torque", "torque-speed curve", "speed")}
    whole = [] if any(map(is_optimal, cycle.segments)) else _of_whole(cycle.unchecked(), cycle)
    of_whole = (each for each in whole if not each.is_kept and each.name not in known)
    # what needs the most time first: with that, the others of its motion are kept as well
    broken.sort(key=lambda each: each.taken.share ** (1.0 / max(each.key.kind.order, 1)), reverse=True)
    proof = (*(each.taken for each in broken), *of_whole)
    if proof:
        others = "" if len(proof) == 1 else sentence("; also beyond its limit: {}", joined("; ", proof[1:]))
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

    return [
        Row(taken.name, taken.value, unit_of(plan.axis, key.kind.order), time, f"limit {taken.text} of {taken.where}")
        for key, taken, time, _ in _most(plan, plan.specification)
        # peaks of a cycle show the others
        if key.sign or key.kind is Kind.SNAP
    ]


def _most(plan: Plan, given: Cycle) -> list[_Taken]:
    """For each limit of segments, by name, the quantity that uses most of it."""
    most: dict[str, _Taken] = {}
    for each in _taken(plan, given):
        # of segments that take the same, but for rounding, the first
        known = most.get(each.taken.name)
        if known is None or each.taken.share > known.taken.share + VALUE_ROUNDING * abs(known.taken.share):
            most[each.taken.name] = each
    return list(most.values())


def _taken(plan: Plan, given: Cycle) -> Iterator[_Taken]:
    """The use of the limits of segments, each by the laws of a plan in it."""
    return _of_segments(plan.peaks, plan.specification, _limits(given), given.programme.stretches)


def _of_segments(
    placed: Sequence[SegmentPeaks], cycle: Cycle, of_cycle: Limits, limited: Sequence[TimedSegment]
) -> Iterator[_Taken]:
    """The use of limits by segments, whose own are those of `limited`; rests take of those of a drive alone."""
    axis, pieces = cycle.axis, [each.piece for each in placed]
    for each in placed:
        for key, limit in limited[each.stretch.number - 1].sides(of_cycle).items():
            if key.kind.is_driven or not isinstance(each.stretch.given, Dwell):
                value, time = _greatest(each, key, pieces, cycle)
                texts = (amount(key, size, axis) for size in (limit, value))
                taken = LimitTaken(name_of(key, axis), each.stretch.where, value, limit, *texts)
                yield _Taken(key, taken, time, each.stretch)


def _greatest(placed: SegmentPeaks, key: Side, pieces: Sequence[Piece], cycle: Cycle) -> tuple[float, float | None]:
    """The greatest value in a segment on the side that a limit bounds, and its time where it has one."""
    piece, nu = placed.piece, key.kind.order
    if key.kind.is_driven:
        taken = along(cycle.in_si.drive, piece, (placed.start, placed.stop))
        if key.kind is Kind.POWER:
            return max(taken.powers), None
        return taken.peak_force if key.kind is Kind.FORCE else taken.parts.greatest(taken.use)
    if placed.moves and not is_optimal(placed.stretch.given):
        if not isfinite(piece.law.peak(nu).value):
            return inf, piece.start + piece.law.peak(nu).k * piece.duration
        jump = jump_beside(piece, pieces, cycle.duration) if nu >= _JERK else None
        if jump is not None:
            return inf, jump
    (low, first), (high, last) = placed.ends(nu)
    if key.sign:
        value, time = (high, last) if key.sign > 0.0 else (-low, first)
        still = key.kind is Kind.VELOCITY_ALONG and value <= AGREEMENT * max(high, -low)
        return 0.0 if still else value, time
    before, after = sorted([(first, abs(low)), (last, abs(high))])
    return (before if is_kept(after[1], before[1]) else after)[::-1]


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
