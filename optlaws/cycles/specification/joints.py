"""The states where segments meet, and the spans between known joints whose law is optimised."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import accumulate
from typing import NamedTuple

from optlaws.cycles.specification.limits import AXES
from optlaws.cycles.specification.programme import Programme, TimedSegment, is_optimal, time_of
from optlaws.cycles.specification.segments import ConstantVelocity, Dwell, Free, Move
from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.laws import smoothstep
from optlaws.motion.piece import Piece, named_law
from optlaws.motion.quantities import in_small_units, quantity
from optlaws.sentences import sentence
from optlaws.tolerances import CLOSURE

UNIFORM = smoothstep(1)


class State(NamedTuple):
    """Velocity and acceleration at a joint, in SI units."""

    velocity: float
    acceleration: float


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

    @property
    def origin(self) -> float:
        """The position at which the law is 0: the span's start, or 0 for a law of positions over a whole cycle."""
        return 0.0 if self.absolute else self.offset

    @property
    def turns(self) -> bool:
        """Whether the span is a whole cycle, which ends in its initial state."""
        return bool(self.states)

    @property
    def times(self) -> tuple[float, float]:
        """When it begins, and how long it takes."""
        return self.start, self.duration

    @property
    def start(self) -> float:
        """The time at which it begins."""
        return self.starts[0]

    @property
    def duration(self) -> float:
        """How long it takes."""
        return self.stop - self.start

    @property
    def timed(self) -> Iterator[tuple[TimedSegment, float, float]]:
        """The segments, each with the times at which it begins and ends."""
        return zip(self.stretches, self.starts, (*self.starts[1:], self.stop), strict=True)

    @property
    def where(self) -> str:
        """The name that errors give it."""
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
    offsets = tuple(accumulate((stretch.displacement for stretch in programme.stretches), initial=programme.start))
    pieces = {
        i: _piece(stretch, starts[i], durations[i], offsets[i])
        for i, stretch in enumerate(programme.stretches)
        if not is_optimal(stretch.given)
    }
    joints = [_joint(programme, pieces, i) for i in range(len(programme.stretches))]
    if whole or joints[0] is None:
        return Layout(starts, (), (replace(_whole(programme, starts, offsets, joints), absolute=absolute),))
    return Layout(starts, tuple(pieces.values()), _spans(programme, starts, offsets, joints))


def _piece(stretch: TimedSegment, start: float, duration: float, offset: float) -> Piece:
    if isinstance(stretch.given, Dwell):
        return Piece(start, duration, offset, 0.0, UNIFORM)
    if isinstance(stretch.given, Move):
        return Piece(start, duration, offset, stretch.displacement, named_law(stretch.given.law, stretch.where))
    return Piece(start, duration, offset, stretch.displacement, UNIFORM)


def _joint(programme: Programme, pieces: dict[int, Piece], i: int) -> State | None:
    """The known state where segment i begins; None where segment i and its predecessor are free."""
    before, after = (i - 1) % len(programme.stretches), i
    ended, begun = _known(programme, pieces, before, 1), _known(programme, pieces, after, 0)
    if ended is not None and begun is not None:
        _check_velocities(programme, before, after, ended, begun)
        return ended if before in pieces else begun
    if ended is not None or begun is not None:
        return ended if begun is None else begun
    both = isinstance(programme.stretches[before].given, Free) and isinstance(programme.stretches[after].given, Free)
    return None if both else State(0.0, 0.0)


def _known(programme: Programme, pieces: dict[int, Piece], i: int, side: int) -> State | None:
    if i in pieces:
        velocity, acceleration = (pieces[i].end(nu, side) for nu in (1, 2))
        # rounding would turn what follows back
        return State(velocity if pieces[i].leaves(side) else 0.0, acceleration)
    stretch = programme.stretches[i].given
    given = (stretch.start_velocity, stretch.end_velocity)[side] if isinstance(stretch, Move) else None
    if given is None:
        return None
    name = f"{programme.stretches[i].where}: {('start', 'end')[side]}_velocity"
    return State(quantity(given, AXES[programme.axis][1], name), 0.0)


def _check_velocities(programme: Programme, before: int, after: int, ended: State, begun: State) -> None:
    size = max((abs(stretch.displacement) for stretch in programme.stretches), default=0.0) / programme.period
    if abs(ended.velocity - begun.velocity) <= CLOSURE * max(size, abs(ended.velocity), abs(begun.velocity)):
        return
    first, second = programme.stretches[before], programme.stretches[after]
    velocities = (ended.velocity, begun.velocity)
    shown = [in_small_units(v, programme.axis, "/s") for v in (*velocities, begun.velocity - ended.velocity)]
    meant = second if not isinstance(second.given, Dwell | ConstantVelocity) else first
    raise InputError(
        sentence(
            "{} ends with {} and {} starts with {}, a jump of {}: put a motion between them, or give {} law='optimal', "
            "which takes the velocities of its neighbours{}",
            first.where, shown[0], second.where, shown[1], shown[2], meant.where,
            _meeting(programme, (first, second), velocities),
        )
    )  # fmt: skip


def _meeting(
    programme: Programme, stretches: tuple[TimedSegment, TimedSegment], velocities: tuple[float, float]
) -> str:
    """The stroke at which a half segment would meet its neighbour, as a remedy; nothing where none would."""
    for stretch, velocity, other in zip(reversed(stretches), reversed(velocities), velocities, strict=True):
        if isinstance(stretch.given, Move) and not is_optimal(stretch.given) and velocity * other > 0.0:
            stroke = in_small_units(abs(stretch.displacement * other / velocity), programme.axis)
            return sentence("; moving by {} in the same time, {} would meet its neighbour", stroke, stretch.where)
    return ""


def _whole(
    programme: Programme, starts: Sequence[float], offsets: Sequence[float], joints: Sequence[State | None]
) -> LawSpan:
    """The cycle as a single span; its stretches with given laws must be straight."""
    for stretch in programme.stretches:
        if isinstance(stretch.given, Move) and not is_optimal(stretch.given):
            raise InputError(
                f"{stretch.where}: give it law='optimal': the cycle is sought as one law; or begin it where velocity "
                "and acceleration are known, after a Dwell, a ConstantVelocity or a Move"
            )
    last = len(programme.stretches) - 1
    passed = [
        (starts[j], offsets[j])
        for j in range(1, last + 1)
        # what is straight brings its position on, and the last stretch ends where the cycle does
        if is_optimal(programme.stretches[j - 1].given) and (j < last or is_optimal(programme.stretches[j].given))
    ]
    inside = [point for j in range(last + 1) for point in _via(programme, j, starts[j], starts[j + 1])]
    rest = State(0.0, 0.0)
    via = tuple(sorted(passed + inside))
    return LawSpan(programme.stretches, tuple(starts[:-1]), starts[-1], offsets[0], _forward(offsets), rest, rest, via,
                tuple(joints))  # fmt: skip


def _forward(offsets: Sequence[float]) -> float:
    """The net advance of a cycle or a span; positions are sums, which return up to rounding."""
    moved = offsets[-1] - offsets[0]
    return moved if abs(moved) > CLOSURE * max(abs(offset - offsets[0]) for offset in offsets) else 0.0


def _spans(
    programme: Programme, starts: Sequence[float], offsets: Sequence[float], joints: Sequence[State | None]
) -> tuple[LawSpan, ...]:
    spans: list[LawSpan] = []
    i = 0
    while i < len(programme.stretches):
        stop = i + 1
        if is_optimal(programme.stretches[i].given):
            while stop < len(joints) and joints[stop] is None:
                stop += 1
            spans.append(_span(programme, starts, offsets, joints, i=i, stop=stop))
        i = stop
    return tuple(spans)


def _span(
    programme: Programme,
    starts: Sequence[float],
    offsets: Sequence[float],
    joints: Sequence[State | None],
    *,
    i: int,
    stop: int,
) -> LawSpan:
    first, last = joints[i], joints[stop % len(joints)]
    if first is None or last is None:
        raise AssertionError  # spans begin and end where joints are known
    inner = [(starts[j], offsets[j]) for j in range(i + 1, stop)]
    inside = [point for j in range(i, stop) for point in _via(programme, j, starts[j], starts[j + 1])]
    return LawSpan(
        programme.stretches[i:stop],
        tuple(starts[i:stop]),
        starts[stop],
        offsets[i],
        _forward(offsets[i : stop + 1]),
        first,
        last,
        tuple(sorted(inner + inside)),
    )


def _via(programme: Programme, j: int, start: float, stop: float) -> list[tuple[float, float]]:
    stretch = programme.stretches[j]
    points = []
    given = stretch.given.via if isinstance(stretch.given, Free) else ()
    for i, point in enumerate(given, 1):
        name = f"{stretch.where}: via {i}"
        place = start + time_of(point[0], programme.period, f"{name}, when")
        if not start < place < stop:
            raise InputError(
                f"{name} must be within the segment, which takes {stop - start:.9g} s, got {shortened(point[0])}"
            )
        points.append((place, quantity(point[1], programme.axis, f"{name}, position")))
    return points
