"""Segments of a cycle as a person gives them: dwells, constant velocities, moves by laws, and free motions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields
from typing import Any

from optlaws.cycles.specification.frozen import frozen
from optlaws.laws import MotionLaw
from optlaws.motion.quantities import written
from optlaws.numbers import Quantity

OPTIMAL = "optimal"


class CycleSegment:
    """A stretch of a cycle; its duration is an angle of the master or a time.

    `duration` is "120 deg" or "0.1 s"; two of them, or None, where it is free between them: what is left of the cycle
    if one segment alone is free, else what is best. `name` is what tables call it.
    """

    duration: Quantity | Sequence[Quantity] | None
    name: str

    def __post_init__(self) -> None:
        for entry in fields(self):  # type: ignore[arg-type] # its heirs are dataclasses
            object.__setattr__(self, entry.name, frozen(written(getattr(self, entry.name))))

    @property
    def label(self) -> str:
        """The name of the segment, or of its kind."""
        return self.name or type(self).__name__


@dataclass(frozen=True)
class Dwell(CycleSegment):
    """A rest of the follower or the axis.

    Parameters
    ----------
    duration
        As of every segment.
    least
        What `Axes.fastest` and `Axes.gentlest` leave of it at least: "0 ms" of one that only waits. All of its duration
        unless given, and nothing where the duration is left out.

    Examples
    --------
    >>> Dwell("90 deg").label
    'Dwell'
    """

    duration: Quantity | Sequence[Quantity] | None = None
    least: Quantity | None = field(default=None, kw_only=True)
    name: str = field(default="", kw_only=True)


@dataclass(frozen=True)
class ConstantVelocity(CycleSegment):
    """A motion of constant velocity, such as "300 mm/s".

    Examples
    --------
    >>> ConstantVelocity("300 mm/s", "60 deg").velocity
    '300 mm/s'
    """

    velocity: Quantity
    duration: Quantity | Sequence[Quantity] | None = None
    name: str = field(default="", kw_only=True)


@dataclass(frozen=True)
class Move(CycleSegment):
    """A motion by a displacement or to a position.

    Parameters
    ----------
    by
        Displacement, such as "35 mm" or "-45 deg".
    duration
        As of every segment.
    to
        Position instead of a displacement.
    law
        A law, the name of one in the catalogue, a formula of k such as "formula: k^2*(3 - 2*k)", a JSON or CSV file
        that holds one, or "optimal". Half segments ("C1", "H2") move at one end, where their neighbour must be as fast.
    limits
        Of its law, in machine units: `{"velocity": "616 mm/s", "acceleration": "90 m/s^2", "jerk": ...}`; two are the
        least and the greatest value, a "deceleration" is of slowing down.
    start_velocity, end_velocity
        Of an optimal law; those of its neighbours, or rest, unless given.

    Examples
    --------
    >>> Move("35 mm", "120 deg", law="modified sine").law
    'modified sine'
    """

    by: Quantity | None = None
    duration: Quantity | Sequence[Quantity] | None = None
    to: Quantity | None = field(default=None, kw_only=True)
    law: str | MotionLaw = field(default=OPTIMAL, kw_only=True)
    limits: Mapping[str, Any] = field(default_factory=dict, kw_only=True)
    start_velocity: Quantity | None = field(default=None, kw_only=True)
    end_velocity: Quantity | None = field(default=None, kw_only=True)
    name: str = field(default="", kw_only=True)


@dataclass(frozen=True)
class Rise(Move):
    """A move whose displacement is given as a positive one and added.

    Examples
    --------
    >>> Rise("35 mm", "120 deg").by
    '35 mm'
    """


@dataclass(frozen=True)
class Return(Move):
    """A move whose displacement is given as a positive one and taken back; to where the cycle began unless given.

    Examples
    --------
    >>> Return(duration="100 deg").by is None
    True
    """


@dataclass(frozen=True)
class Free(CycleSegment):
    """An optimal motion of which only the end and points on the way are given.

    Between free motions that follow each other velocity and acceleration are free too; beside others they are those of
    the neighbour.

    Parameters
    ----------
    by, duration, to, limits
        As of a move.
    via
        Points on the way: pairs of a time or angle since the start of the segment and a position.

    Examples
    --------
    >>> Free("60 mm", "0.3 s", via=[("0.1 s", "50 mm")]).label
    'Free'
    """

    by: Quantity | None = None
    duration: Quantity | Sequence[Quantity] | None = None
    to: Quantity | None = field(default=None, kw_only=True)
    via: Sequence[tuple[Quantity, Quantity]] = field(default=(), kw_only=True)
    limits: Mapping[str, Any] = field(default_factory=dict, kw_only=True)
    name: str = field(default="", kw_only=True)
