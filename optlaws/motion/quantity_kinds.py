"""Kinds of quantities of a motion and its drive, which are limited and minimised."""

from __future__ import annotations

from enum import Enum


class Kind(Enum):
    """What is limited or minimised; values are the numbers that `Cycle.limits_of_segments` has for them.

    Examples
    --------
    >>> Kind.JERK.order, Kind.FORCE.order
    (3, 0)
    """

    VELOCITY = 1
    ACCELERATION = 2
    JERK = 3
    SNAP = 4
    FORCE = -1
    LOAD = -2
    POWER = -3
    ENERGY = -4
    HEAT = -5
    CURVE = -6  #: the share of a motor's curve of torque over speed
    RMS_FORCE = -7  #: over the whole cycle
    RESIDUAL = -10  #: acceleration of what vibrates on after a move
    RESIDUAL_DISPLACEMENT = -11  #: amplitude of what vibrates on after a move
    VELOCITY_ALONG = -8  #: in the direction of the motion
    ACCELERATION_ALONG = -9  #: likewise: above 0 where it speeds up

    @property
    def order(self) -> int:
        """The order of the derivative; 0 of what is no derivative."""
        along = {Kind.VELOCITY_ALONG: 1, Kind.ACCELERATION_ALONG: 2}
        return along.get(self, max(self.value, 0))

    @property
    def is_driven(self) -> bool:
        """Whether it is of a drive at each time."""
        return self in {Kind.FORCE, Kind.POWER, Kind.CURVE}
