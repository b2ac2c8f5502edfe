"""A cycle as numbers: durations that sum, positions that close, velocities that meet; errors state the remedy.

The states where segments meet are its joints; between known ones are the spans whose law is optimised.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import accumulate
from typing import Any, NamedTuple

from optlaws.cycles.specification.limits import AXES, Limits, Sides, read_limits, sides, tightest
from optlaws.cycles.specification.periods import duration_range, extent
from optlaws.cycles.specification.segments import (
    OPTIMAL,
    ConstantVelocity,
    CycleSegment,
    Dwell,
    Free,
    Move,
    Return,
    Rise,
)
from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw, smoothstep
from optlaws.motion.piece import Piece, factor, named_law
from optlaws.motion.quantities import TURN, Kind, check_scale, either, in_small_units, quantity
from optlaws.sentences import Amount, sentence
from optlaws.tolerances import CLOSURE, SAME_TIME

UNIFORM = smoothstep(1)


@dataclass(frozen=True)
class TimedSegment:
    """A segment in SI units: least and greatest duration, displacement and its own limits, and the user's segment."""

    number: int
    given: CycleSegment
    least: float
    most: float
    displacement: float
    limits: Limits = field(default_factory=dict, hash=False)

    @property
    def fixed(self) -> bool:
        return self.least == self.most

    @property
    def where(self) -> str:
        return f"segment {self.number} ({self.given.label})"

    def sides(self, of_cycle: Limits) -> Sides:
        """The limited sides of the segment: by its own limits and the cycle's, whichever are lower.

        Raises
        ------
        InputError
            If slowing down has a limit where the motion may turn back, or what ends where it begins must not turn back.
        """
        limits = tightest(of_cycle, self.limits)
        if isinstance(self.given, Free) and Kind.ACCELERATION_ALONG in limits:
            raise InputError(
                f"{self.where} may turn back, where speeding up and slowing down are of no one direction: give its "
                "acceleration as the least and the greatest, such as ('-8 m/s^2', '12 m/s^2'), in place of a "
                "deceleration"
            )
        if isinstance(self.given, Free) and Kind.VELOCITY_ALONG in limits and not self.displacement:
            raise InputError(
                f"{self.where} ends where it begins, so that it must turn back: give the limit of its velocity as "
                "one quantity, or as a least one below 0"
            )
        return sides(limits, -1.0 if self.displacement < 0.0 else 1.0)


@dataclass(frozen=True)
class Programme:
    """A cycle as numbers in SI units: its period, its stretches, and the position at its start."""

    period: float
    axis: str
    stretches: tuple[TimedSegment, ...]
    start: float

    @property
    def advance(self) -> float:
        """How far a cycle is beyond the one before."""
        return sum(stretch.displacement for stretch in self.stretches)

    @kept_property
    def offsets(self) -> tuple[float, ...]:
        """The positions where segments begin, and where the last one ends."""
        return tuple(accumulate((stretch.displacement for stretch in self.stretches), initial=self.start))


def period_of(speed: Any, period: Any) -> float:
    """Duration of a cycle in seconds, from the master's speed or given."""
    if (speed is None) == (period is None):
        raise InputError('a cycle has either a speed such as "200 rpm" or a period such as "0.3 s"')
    if speed is None:
        return quantity(period, "time", "period", above=0.0)
    turn = TURN / quantity(speed, "angular velocity", "speed", above=0.0)
    check_scale(turn, "s", "speed: a turn", speed)
    return turn


def axis_of(segments: Sequence[CycleSegment]) -> str:
    """Whether positions are lengths or angles, by the first that is given; lengths if none is."""
    for i, segment in enumerate(segments, 1):
        where = f"segment {i} ({segment.label})"
        for value in (getattr(segment, "by", None), getattr(segment, "to", None)):
            if value is not None:
                return either(value, ("length", "angle"), f"{where}: displacement")[0]
        if isinstance(segment, ConstantVelocity):
            kind = either(segment.velocity, ("velocity", "angular velocity"), f"{where}: velocity")[0]
            return "length" if kind == "velocity" else "angle"
    return "length"


def programme(segments: Sequence[CycleSegment], period: float, start: Any, advance: Any) -> Programme:
    """A cycle as numbers."""
    axis = axis_of(segments)
    ends = ((start, "start"), (advance, "advance"))
    first, forward = (0.0 if value is None else quantity(value, axis, name) for value, name in ends)
    names = [f"segment {i} ({segment.label})" for i, segment in enumerate(segments, 1)]
    durations = _durations(segments, names, period)
    stretches, position = list[TimedSegment](), first
    for segment, where, (least, most) in zip(segments, names, durations, strict=True):
        moved = _displacement(segment, axis, where, here=position, last=first + forward, duration=least)
        limits = read_limits(segment.limits if isinstance(segment, Move | Free) else {}, axis, f"{where}: limits")
        stretches.append(TimedSegment(len(stretches) + 1, segment, least, most, moved, limits))
        position += moved
    size = max((abs(stretch.displacement) for stretch in stretches), default=0.0)
    if abs(position - first - forward) > CLOSURE * max(size, abs(forward)):
        shown, due, more = (
            in_small_units(moved, axis) for moved in (position - first, forward, forward - (position - first))
        )
        raise InputError(
            sentence(
                "the positions do not close: the cycle ends {} from its start, not {}: change a displacement by {}, "
                "end with Return(duration=...), or give advance={} if each cycle goes on from there",
                shown, due, more, repr(str(shown)),
            )
        )  # fmt: skip
    return Programme(period, axis, tuple(stretches), first)


def _durations(segments: Sequence[CycleSegment], names: Sequence[str], period: float) -> list[tuple[float, float]]:
    bounds = [_bounds(segment, period, f"{name}: duration") for segment, name in zip(segments, names, strict=True)]
    low, high = (sum(side) for side in zip(*bounds, strict=True))
    free = [i for i, (least, most) in enumerate(bounds) if least != most]
    if low > period * (1.0 + CLOSURE) or high < period * (1.0 - CLOSURE):
        total = low if low > period else high
        share = 360.0 * total / period
        turns = round(share / 360.0)
        if turns > 1 and abs(share - 360.0 * turns) <= CLOSURE * share:
            raise InputError(
                f"the durations sum to {360 * turns} deg, and a cycle is one turn of its master: divide the angles and "
                f"the speed by {turns} where the master turns {turns} times in a cycle"
            )
        raise InputError(
            sentence(
                "the durations sum to {} ({} s), not to {} ({} s): {} segments by {} in all, or leave out the duration "
                "of one of them: it then has the rest of the time",
                Amount(share, "deg", 9), f"{total:.9g}", Amount(360.0, "deg"), f"{period:.9g}",
                "shorten" if total > period else "lengthen", Amount(abs(share - 360.0), "deg", 9),
            )
        )  # fmt: skip
    if len(free) == 1:
        left = period - (low - bounds[free[0]][0])
        if left <= CLOSURE * period:
            raise InputError(f"{names[free[0]]}: the other segments leave no time for it")
        bounds[free[0]] = (left, left)
    for i in free if len(free) > 1 else ():
        if not isinstance(segments[i], Move):
            raise InputError(f"{names[i]}: give it a duration; with several free ones only moves share what is left")
    return bounds


def _bounds(segment: CycleSegment, period: float, name: str) -> tuple[float, float]:
    least, most = (end.at(period) for end in duration_range(segment.duration, name))
    if not 0.0 < least <= most and not (least == 0.0 < most):
        raise InputError(f"{name} must be above 0, the least first, got {shortened(segment.duration)}")
    if most <= SAME_TIME * period:
        raise InputError(
            f"{name} is too short beside the cycle's {period:.6g} s, got {shortened(segment.duration)}: leave the "
            "segment out"
        )
    return least, most


def _displacement(segment: CycleSegment, axis: str, where: str, *, here: float, last: float, duration: float) -> float:
    if isinstance(segment, ConstantVelocity):
        return quantity(segment.velocity, AXES[axis][1], f"{where}: velocity") * duration
    if isinstance(segment, Dwell):
        return 0.0
    assert isinstance(segment, Move | Free)  # noqa: S101 - there are no other kinds
    if (segment.by is None) == (segment.to is None):
        if segment.by is None and isinstance(segment, Return):
            return last - here
        raise InputError(f"{where}: give it either a displacement `by` or a position `to`")
    if segment.to is not None:
        return quantity(segment.to, axis, f"{where}: to") - here
    moved = quantity(segment.by, axis, f"{where}: by")
    if moved == 0.0 and isinstance(segment, Rise | Return):
        raise InputError(f"{where}: `by` must not be 0, got {shortened(segment.by)}: what does not move is a Dwell")
    if moved < 0.0 and isinstance(segment, Rise | Return):
        raise InputError(
            f"{where}: `by` is given as a positive displacement, got {shortened(segment.by)}; or take a Move"
        )
    return -moved if isinstance(segment, Return) else moved


def is_optimal(segment: CycleSegment) -> bool:
    """Whether the segment's law is optimised."""
    return isinstance(segment, Free) or (
        isinstance(segment, Move) and isinstance(segment.law, str) and segment.law == OPTIMAL
    )


class State(NamedTuple):
    """Velocity and acceleration at a joint, in SI units."""

    velocity: float
    acceleration: float


REST = State(0.0, 0.0)


@dataclass(frozen=True)
class LawSpan:
    """The segments that one optimal law covers, with their times: a single segment, or consecutive free ones.

    `first` and `last` are the states at both ends, `via` pairs of time and position on the way. Of a whole cycle in
    one, `states` say what is known where each segment begins; its law is one of positions where it is `absolute`.
    """

    stretches: tuple[TimedSegment, ...]
    starts: tuple[float, ...]
    stop: float
    offset: float
    displacement: float
    first: State
    last: State
    via: tuple[tuple[float, float], ...]
    states: tuple[State | None, ...] = ()
    absolute: bool = False

    @classmethod
    def of(
        cls, stretch: TimedSegment, start: float, stop: float, offset: float, first: State = REST, last: State = REST
    ) -> LawSpan:
        """The span of a single segment, from rest to rest unless states are given."""
        return cls((stretch,), (start,), stop, offset, stretch.displacement, first, last, ())

    @property
    def origin(self) -> float:
        """The position at which the law is 0: the span's start, or 0 for a law of positions over a whole cycle."""
        return 0.0 if self.absolute else self.offset

    @property
    def turns(self) -> bool:
        """Whether it is a whole cycle, which ends in its initial state."""
        return bool(self.states)

    @kept_property
    def stroke(self) -> float:
        """The scale of its law: its displacement or, if that is zero, the greatest distance on the way."""
        known = (state for state in (self.first, self.last, *self.states) if state is not None)
        ways = [abs(state.velocity) * self.duration for state in known]
        return self.displacement or max(ways + [abs(position - self.offset) for _, position in self.via])

    @property
    def may_turn(self) -> bool:
        """Whether its law may go back on its way."""
        if self.turns or len(self.stretches) > 1 or self.via or not self.displacement:
            return True
        return any(state.velocity * self.displacement < 0.0 for state in (self.first, self.last))

    def unit(self, nu: int) -> float:
        """The unit of a derivative of its law."""
        return abs(factor(self.stroke, self.duration, nu))

    def place(self, time: float) -> float:
        """The k of a time in it; its ends are 0 and 1 exactly."""
        return 1.0 if time == self.stop else (time - self.start) / self.duration

    def by(self, law: MotionLaw) -> Piece:
        """A law in its place."""
        return Piece(self.start, self.duration, self.offset, self.stroke, law)

    @property
    def start(self) -> float:
        return self.starts[0]

    @property
    def duration(self) -> float:
        return self.stop - self.start

    @property
    def timed(self) -> Iterator[tuple[TimedSegment, float, float]]:
        """The segments, each with the times at which it begins and ends."""
        return zip(self.stretches, self.starts, (*self.starts[1:], self.stop), strict=True)

    def sides(self, of_cycle: Limits) -> tuple[Sides | None, ...]:
        """The limited sides of each segment whose law is optimised; None of the others."""
        return tuple(each.sides(of_cycle) if is_optimal(each.given) else None for each in self.stretches)

    @property
    def where(self) -> str:
        return " and ".join(stretch.where for stretch in self.stretches)


@dataclass(frozen=True)
class Layout:
    """A cycle with known durations: pieces with known laws, and spans with optimised laws."""

    starts: tuple[float, ...]
    pieces: tuple[Piece, ...]
    spans: tuple[LawSpan, ...]


def layout(programme: Programme, durations: Sequence[float], *, whole: bool = False, absolute: bool = False) -> Layout:
    """The known laws, and the spans with optimised laws.

    Where nothing is known at the start of the cycle, or `whole` is true, its motions are one law that repeats; of
    positions if it is to be `absolute`.
    """
    starts = tuple(accumulate(durations, initial=0.0))
    offsets, pieces = programme.offsets, dict[int, Piece]()
    for i, stretch in enumerate(programme.stretches):
        if not is_optimal(stretch.given):
            law = named_law(stretch.given.law, stretch.where) if isinstance(stretch.given, Move) else UNIFORM
            pieces[i] = Piece(starts[i], durations[i], offsets[i], stretch.displacement, law)
    placed = _Placed(programme, starts, pieces)
    joints = [placed.joint(i) for i in range(len(programme.stretches))]
    if whole or joints[0] is None:
        return Layout(starts, (), (placed.whole(joints, absolute=absolute),))
    return Layout(starts, tuple(pieces.values()), tuple(placed.spans(joints)))


@dataclass(frozen=True)
class _Placed:
    """The segments of a cycle in their times and positions, with the pieces of those whose laws are known."""

    programme: Programme
    starts: tuple[float, ...]
    pieces: dict[int, Piece]

    def joint(self, i: int) -> State | None:
        """The known state where segment i begins; None where segment i and its predecessor are free."""
        before = (i - 1) % len(self.programme.stretches)
        ended, begun = self._known(before, 1), self._known(i, 0)
        if ended is not None and begun is not None:
            self._check_velocities(before, i, ended.velocity, begun.velocity)
        if ended is not None or begun is not None:
            return begun if ended is None or (begun is not None and before not in self.pieces) else ended
        free = all(isinstance(self.programme.stretches[j].given, Free) for j in (before, i))
        return None if free else REST

    def _known(self, i: int, side: int) -> State | None:
        if i in self.pieces:
            velocity, acceleration = (self.pieces[i].end(nu, side) for nu in (1, 2))
            # rounding would turn what follows back
            return State(velocity if self.pieces[i].leaves(side) else 0.0, acceleration)
        stretch = self.programme.stretches[i].given
        given = (stretch.start_velocity, stretch.end_velocity)[side] if isinstance(stretch, Move) else None
        if given is None:
            return None
        name = f"{self.programme.stretches[i].where}: {('start', 'end')[side]}_velocity"
        return State(quantity(given, AXES[self.programme.axis][1], name), 0.0)

    def _check_velocities(self, before: int, after: int, ended: float, begun: float) -> None:
        programme = self.programme
        size = max((abs(stretch.displacement) for stretch in programme.stretches), default=0.0) / programme.period
        if abs(ended - begun) <= CLOSURE * max(size, abs(ended), abs(begun)):
            return
        first, second = programme.stretches[before], programme.stretches[after]
        shown = [in_small_units(velocity, programme.axis, "/s") for velocity in (ended, begun, begun - ended)]
        meant = first if isinstance(second.given, Dwell | ConstantVelocity) else second
        raise InputError(
            sentence(
                "{} ends with {} and {} starts with {}, a jump of {}: put a motion between them, or give {} "
                "law='optimal', which takes the velocities of its neighbours{}",
                first.where, shown[0], second.where, shown[1], shown[2], meant.where,
                self._meeting((second, first), (begun, ended)),
            )
        )  # fmt: skip

    def _meeting(self, stretches: tuple[TimedSegment, TimedSegment], velocities: tuple[float, float]) -> str:
        """The stroke at which a half segment would meet its neighbour, as a remedy; nothing where none would."""
        for stretch, velocity, other in zip(stretches, velocities, reversed(velocities), strict=True):
            if isinstance(stretch.given, Move) and not is_optimal(stretch.given) and velocity * other > 0.0:
                stroke = in_small_units(abs(stretch.displacement * other / velocity), self.programme.axis)
                return sentence("; moving by {} in the same time, {} would meet its neighbour", stroke, stretch.where)
        return ""

    def whole(self, joints: Sequence[State | None], *, absolute: bool) -> LawSpan:
        """The cycle as a single span; its stretches with given laws must be straight."""
        for stretch in self.programme.stretches:
            if isinstance(stretch.given, Move) and not is_optimal(stretch.given):
                raise InputError(
                    f"{stretch.where}: give it law='optimal': the cycle is sought as one law; or begin it where "
                    "velocity and acceleration are known, after a Dwell, a ConstantVelocity or a Move"
                )
        return replace(self._span(0, len(joints), REST, REST), states=tuple(joints), absolute=absolute)

    def spans(self, joints: Sequence[State | None]) -> Iterator[LawSpan]:
        """The spans of stretches whose law is optimised, from one known joint to the next."""
        i = 0
        while i < len(joints):
            stop = i + 1
            if is_optimal(self.programme.stretches[i].given):
                while stop < len(joints) and joints[stop] is None:
                    stop += 1
                first, last = joints[i], joints[stop % len(joints)]
                if first is None or last is None:
                    raise AssertionError  # spans begin and end where joints are known
                yield self._span(i, stop, first, last)
            i = stop

    def _span(self, i: int, stop: int, first: State, last: State) -> LawSpan:
        stretches, starts, offsets = self.programme.stretches, self.starts, self.programme.offsets
        via = [
            (starts[j], offsets[j])
            for j in range(i + 1, stop)
            # what is straight brings its position on, and the last stretch ends where the span does
            if is_optimal(stretches[j - 1].given) and (j < stop - 1 or is_optimal(stretches[j].given))
        ]
        via += [point for j in range(i, stop) for point in self._via(j)]
        # positions are sums, which return up to rounding
        moved = offsets[stop] - offsets[i]
        near = CLOSURE * max(abs(offset - offsets[i]) for offset in offsets[i : stop + 1])
        forward = moved if abs(moved) > near else 0.0
        return LawSpan(
            stretches[i:stop], starts[i:stop], starts[stop], offsets[i], forward, first, last, tuple(sorted(via))
        )

    def _via(self, j: int) -> Iterator[tuple[float, float]]:
        stretch, (start, stop) = self.programme.stretches[j], self.starts[j : j + 2]
        for i, point in enumerate(stretch.given.via if isinstance(stretch.given, Free) else (), 1):
            name = f"{stretch.where}: via {i}"
            place = start + extent(point[0], f"{name}, when").at(self.programme.period)
            if not start < place < stop:
                raise InputError(
                    f"{name} must be within the segment, which takes {stop - start:.9g} s, got {shortened(point[0])}"
                )
            yield place, quantity(point[1], self.programme.axis, f"{name}, position")
