"""Limits of a motion whose time is sought: along a span as functions of its time, and those of a single move."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from optlaws.entries.declared import Declared, declared, entry
from optlaws.entries.value_types import Number
from optlaws.laws import MotionLaw
from optlaws.synthesis.problem.constants import B, C, C_minus, C_plus, Functional, J, snap


class TimedLimit(NamedTuple):
    """A limit of a law in a time: its name, the constant of the law and the greatest allowed value."""

    name: str
    constant: Functional
    bound: float

    def share(self, law: MotionLaw) -> float:
        """The share of the limit that a law takes."""
        return float(self.constant.value(law) / self.bound)


@dataclass(frozen=True)
class SpanLimit:
    """A limit along a span as a function of its time, or of a scale of its time.

    Attributes
    ----------
    name, most
        What is limited, and how much of it is allowed in SI units.
    term
        The limited constant of the law and its greatest allowed value, in a time.
    nu
        The order of the derivative that is limited, of which so high a power of the time is allowed; 0 of others.
    scales
        Whether a law that keeps the limit keeps it in every longer time.
    key
        What the caller knows it by.
    """

    name: str
    most: float
    term: Callable[[float], tuple[Functional, float]]
    nu: int = 0
    scales: bool = True
    key: Any = None

    def at(self, duration: float) -> TimedLimit:
        """The limit in a time."""
        return TimedLimit(self.name, *self.term(duration))

    @property
    def rate(self) -> float:
        return self.term(1.0)[1]


def derivative_limit(name: str, most: float, constant: Functional, nu: int, rate: float, key: Any = None) -> SpanLimit:
    """The limit of a derivative of the law, in 1/s^nu."""
    return SpanLimit(name, most, lambda duration: (constant, rate * power(duration, nu)), nu, key=key)


def power(duration: float, nu: int) -> float:
    """A time to a whole power by products, which every machine rounds alike.

    >>> power(1.5, 3)
    3.375
    """
    product = duration
    for _ in range(nu - 1):
        product *= duration
    return product


_LIMIT = Number(above=0.0)


@declared
class MoveLimits(Declared, title="limits of a move"):
    """Limits of a move, in units of the stroke and seconds.

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

    def along(self, stroke: float) -> tuple[SpanLimit, ...]:
        """The limits of the law with stroke 1, the lowest derivative first.

        >>> [limit.at(2.0) for limit in MoveLimits(velocity=1.0, deceleration=8.0).along(0.5)][1]
        TimedLimit(name='deceleration', constant=C_minus, bound=64.0)
        """
        both = self.symmetric
        known = (
            ("velocity", B, 1, self.velocity),
            ("acceleration", C if both else C_plus, 2, self.acceleration),
            ("deceleration", C_minus, 2, None if both else self.deceleration),
            ("jerk", J, 3, self.jerk),
            ("snap", snap, 4, self.snap),
        )
        return tuple(
            derivative_limit(name, most, of, nu, most / stroke) for name, of, nu, most in known if most is not None
        )

    def scaled(self, name: str, factor: float) -> MoveLimits:
        """The limits with one of them multiplied by a factor; both sides of a common acceleration limit are scaled.

        >>> MoveLimits(acceleration=8.0, deceleration=8.0).scaled("acceleration", 2.0).deceleration
        16.0
        """
        names = ("acceleration", "deceleration") if name == "acceleration" and self.symmetric else (name,)
        return replace(self, **{each: factor * getattr(self, each) for each in names})
