"""Segments of a cycle as a person gives them: dwells, moves by laws, free motions; and cams into it and out of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from optlaws.cycles.specification.limits import LIMITS_OF_SEGMENT
from optlaws.echo import shortened
from optlaws.entries.declared import Declared, FrozenTable, Kinded, ValueOf, declared, entry
from optlaws.entries.value_types import Either, Listed, Measured, ReadBy, Text, Together, Whole, is_list
from optlaws.errors import InputError
from optlaws.laws import MotionLaw
from optlaws.numbers import Quantity

OPTIMAL = "optimal"
_PLACE = Measured("length", "angle")
_RATE = Measured("velocity", "angular velocity")


def _read_law(value: Any) -> MotionLaw:
    if isinstance(value, MotionLaw):
        return value
    if not isinstance(value, Mapping):
        raise InputError(
            "it must be a name of the catalogue, a formula, a JSON or CSV file, 'optimal', or a law or its plain data, "
            f"got {shortened(value)}"
        )
    return MotionLaw.from_dict(value)


_FROM_TO = Listed(Measured("angle", "time", least=0.0), least=2, most=2)
_DURATION = Either(Measured("angle", "time", above=0.0), _FROM_TO, which=is_list)
_HOW_LONG = (
    "An angle of the master or a time; two are the least and the greatest duration. Without it the segment takes the "
    "rest of the cycle or, if several are without, the best share of it."
)


class _RestTime(Measured):
    """How long a dwell lasts: of none, free motions beside it would rest there all the same, and axes wait there."""

    def in_range(self, number: float, name: str, value: Any) -> float:
        if number == 0.0:
            raise InputError(
                f"{name} must be above 0, got {shortened(value)}: leave a dwell of no time out; one that only waits "
                'for another axis has least = "0 s" and no duration'
            )
        return super().in_range(number, name, value)


_REST = Either(_RestTime("angle", "time", above=0.0), _FROM_TO, which=is_list)


class _LawName(Text):
    """A law by its name, which is written by its plain data where it is that of a file."""

    def plain(self, value: Any) -> Any:
        from optlaws.laws.catalogue.reading import with_files

        return with_files({"law": value}, Path())["law"]


_LAW = Either(
    _LawName(),
    ReadBy(_read_law, "a `MotionLaw`", MotionLaw.to_dict, {"type": "object", "required": ["kind"]}),
    which=lambda value: int(not isinstance(value, str)),
)
_NAMED = "What tables call it."
_LIMITED = "Limits of this motion, in addition to those of the cycle."
_MOVED = "Displacement."
_REACHED = "Position instead of a displacement."


class CycleSegment(Kinded, title="a segment"):
    """A stretch of a cycle; its duration is an angle of the master or a time.

    `duration` is "120 deg" or "0.1 s"; two of them, or None, where it is free between them: what is left of the cycle
    if one segment alone is free, else what is best. `name` is what tables call it.
    """

    duration: Quantity | Sequence[Quantity] | None
    name: str

    @property
    def label(self) -> str:
        """The name of the segment, or of its kind."""
        return self.name or type(self).__name__


@declared
class Dwell(CycleSegment, kind="dwell"):
    """A rest of the follower or the axis.

    Examples
    --------
    >>> Dwell("90 deg").label
    'Dwell'
    """

    duration: Quantity | Sequence[Quantity] | None = entry(_REST, _HOW_LONG, default=None, example="120 deg")
    least: Quantity | None = entry(
        Measured("angle", "time", least=0.0),
        'The least duration in `Axes.fastest` and `Axes.least_acceleration`: "0 ms" of a dwell that only waits. Unless '
        "given its duration, or 0 if it has none.",
        default=None,
        kw_only=True,
        example="0 ms",
    )
    name: str = entry(Text(empty=True), _NAMED, default="", kw_only=True)


@declared
class ConstantVelocity(CycleSegment, kind="constant velocity"):
    """A motion of constant velocity, such as "300 mm/s".

    Examples
    --------
    >>> ConstantVelocity("300 mm/s", "60 deg").velocity
    '300 mm/s'
    """

    velocity: Quantity = entry(_RATE, "Of the axis.", example="300 mm/s")
    duration: Quantity | Sequence[Quantity] | None = entry(_DURATION, _HOW_LONG, default=None, example="120 deg")
    name: str = entry(Text(empty=True), _NAMED, default="", kw_only=True)


@declared
class Move(CycleSegment, kind="move"):
    """A motion by a displacement or to a position.

    Examples
    --------
    >>> Move("35 mm", "120 deg", law="modified sine").law
    'modified sine'
    """

    by: Quantity | None = entry(_PLACE, _MOVED, default=None, example="35 mm")
    duration: Quantity | Sequence[Quantity] | None = entry(_DURATION, _HOW_LONG, default=None, example="120 deg")
    to: Quantity | None = entry(_PLACE, _REACHED, default=None, kw_only=True, example="0 mm")
    law: str | MotionLaw = entry(
        _LAW,
        'A law, the name of one in the catalogue, a formula of k such as "formula: k^2*(3 - 2*k)", a JSON or CSV file '
        'that holds one, or "optimal". Half segments ("C1", "H2") move at one end, where their neighbour must be as '
        "fast.",
        default=OPTIMAL,
        kw_only=True,
    )
    limits: Mapping[str, Any] = entry(LIMITS_OF_SEGMENT, _LIMITED, default=FrozenTable(), kw_only=True)
    start_velocity: Quantity | None = entry(
        _RATE, "Of an optimal law; that of its neighbour, or rest, unless given.", default=None, kw_only=True
    )
    end_velocity: Quantity | None = entry(_RATE, "As `start_velocity`, at its end.", default=None, kw_only=True)
    name: str = entry(Text(empty=True), _NAMED, default="", kw_only=True)


@declared
class Rise(Move, kind="rise"):
    """A move whose displacement is given as a positive one and added.

    Examples
    --------
    >>> Rise("35 mm", "120 deg").by
    '35 mm'
    """


@declared
class Return(Move, kind="return"):
    """A move whose displacement is given as a positive one and taken back; to where the cycle began unless given.

    Examples
    --------
    >>> Return(duration="100 deg").by is None
    True
    """


@declared
class Free(CycleSegment, kind="free", title="a free motion"):
    """An optimal motion of which only the end and points on the way are given.

    Between free motions that follow each other velocity and acceleration are free too; beside others they are those of
    the neighbour.

    Examples
    --------
    >>> Free("60 mm", "0.3 s", via=[("0.1 s", "50 mm")]).label
    'Free'
    """

    by: Quantity | None = entry(_PLACE, _MOVED, default=None, example="35 mm")
    duration: Quantity | Sequence[Quantity] | None = entry(_DURATION, _HOW_LONG, default=None, example="120 deg")
    to: Quantity | None = entry(_PLACE, _REACHED, default=None, kw_only=True, example="0 mm")
    via: Sequence[tuple[Quantity, Quantity]] = entry(
        Listed(Together(Measured("angle", "time"), _PLACE)),
        "Points on the way: pairs of a time or angle since the start of the segment and a position.",
        default=(),
        kw_only=True,
        example=[["40 deg", "20 mm"]],
    )
    limits: Mapping[str, Any] = entry(LIMITS_OF_SEGMENT, _LIMITED, default=FrozenTable(), kw_only=True)
    name: str = entry(Text(empty=True), _NAMED, default="", kw_only=True)


@declared
class Transition(Declared, title="a run-in or run-out"):
    """A cam from rest into a cycle, or out of it."""

    at: Quantity = entry(
        Measured("angle", "time"), "The angle of the master, or time, at which it meets the cycle.", example="60 deg"
    )
    rest: Quantity | None = entry(_PLACE, "The position of rest; where the cycle starts unless given.", default=None)
    over: Quantity | None = entry(
        Measured("angle", "time", above=0.0),
        "The angle of the master, or time, that it takes; the least within the limits of the cycle, which is proven, "
        "unless given.",
        default=None,
    )
    order: int | None = entry(
        Whole(2, 10),
        "How much is continuous where they meet: 3 the acceleration, 4 the jerk too; that of the cycle unless given.",
        default=None,
    )


#: the segments of a cycle, which errors call by their numbers
SEGMENTS = Listed(ValueOf(CycleSegment), least=1, most=1000, each="segment")
