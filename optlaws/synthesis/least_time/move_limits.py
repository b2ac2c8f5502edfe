"""Limits of velocity, acceleration, jerk and snap of a move."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

from optlaws.entries.declared import Declared, declared, entry
from optlaws.entries.value_types import Number
from optlaws.synthesis.problem.constants import B, C, C_minus, C_plus, Functional, J, snap


class RateLimit(NamedTuple):
    """A limit of one derivative: its name, the constant of the law, the order of the derivative and the limit."""

    name: str
    constant: Functional
    nu: int
    rate: float


class TimedLimit(NamedTuple):
    """A limit of a law in a time: its name, the constant of the law and the greatest allowed value."""

    name: str
    constant: Functional
    bound: float


_LIMIT = Number(above=0.0)


@declared
class MoveLimits(Declared, title="limits of a move"):
    """Limits of a move, in units of the stroke and seconds.

    Examples
    --------
    >>> MoveLimits(velocity=1.0, acceleration=12.0, deceleration=8.0).symmetric
    False
    """

    velocity: float | None = entry(_LIMIT, "The greatest magnitude.", default=None)
    acceleration: float | None = entry(_LIMIT, "The greatest in the direction of the stroke.", default=None)
    deceleration: float | None = entry(_LIMIT, "The greatest against it.", default=None)
    jerk: float | None = entry(_LIMIT, "The greatest magnitude.", default=None)
    snap: float | None = entry(_LIMIT, "The greatest magnitude.", default=None)

    @property
    def symmetric(self) -> bool:
        """Whether a law and its mirror image keep the limits alike."""
        return self.acceleration == self.deceleration

    def rates(self, stroke: float) -> tuple[RateLimit, ...]:
        """The limits of the law with stroke 1, in 1/s^nu, the lowest derivative first.

        Examples
        --------
        >>> [
        ...     (limit.name, limit.constant, limit.rate)
        ...     for limit in MoveLimits(velocity=1.0, deceleration=8.0).rates(0.5)
        ... ]
        [('velocity', B, 2.0), ('deceleration', C_minus, 16.0)]
        """
        both = self.symmetric
        known = (
            ("velocity", B, 1, self.velocity),
            ("acceleration", C if both else C_plus, 2, self.acceleration),
            ("deceleration", C_minus, 2, None if both else self.deceleration),
            ("jerk", J, 3, self.jerk),
            ("snap", snap, 4, self.snap),
        )
        return tuple(RateLimit(name, of, nu, limit / stroke) for name, of, nu, limit in known if limit is not None)

    def scaled(self, name: str, factor: float) -> MoveLimits:
        """The limits with one of them multiplied by a factor; both sides of a common acceleration limit are scaled.

        Examples
        --------
        >>> MoveLimits(acceleration=8.0, deceleration=8.0).scaled("acceleration", 2.0).deceleration
        16.0
        """
        names = ("acceleration", "deceleration") if name == "acceleration" and self.symmetric else (name,)
        return replace(self, **{each: factor * getattr(self, each) for each in names})
