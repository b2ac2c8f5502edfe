"""The limits of a span as shares: by how many times its law, run slower by a scale, takes what is allowed.

A motion that is run `scale` times slower has its velocity divided by the scale, its acceleration by the square of it.
A share of a derivative of order nu so falls with the power nu of the scale, whatever the law: a law that keeps such a
limit keeps it at every lower speed.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Protocol

from optlaws.cycles.greatest_speed.drive_limits_of_span import DrivenLimit, driven_limits
from optlaws.cycles.optimisation.motion_limits import CURVE, FORCE, POWER, LimitKey, Limits
from optlaws.cycles.optimisation.objectives import CycleObjective
from optlaws.cycles.optimisation.optimal import limited_by
from optlaws.cycles.optimisation.search_spaces import place
from optlaws.cycles.specification.joints import LawSpan
from optlaws.errors import InputError
from optlaws.laws import MotionLaw
from optlaws.synthesis.functionals.makers import peak
from optlaws.synthesis.problem.constants import Functional


class SpanLimit(Protocol):
    """A limit of a span as a share of its allowed value; the limit is satisfied where the share is at most 1."""

    @property
    def key(self) -> LimitKey:
        """The quantity that is limited, or one side of it."""

    @property
    def most(self) -> float:
        """The limit in SI units."""

    @property
    def scales(self) -> bool:
        """Whether a law that satisfies the limit satisfies it at every lower speed."""

    def term(self, scale: float) -> tuple[Functional, float]:
        """The limited constant of the law, and the share that one unit of it takes at a scale of the time."""

    def slope(self, law: MotionLaw, scale: float) -> float:
        """The exponent with which the share of a law falls with the scale."""

    def least_scale(self, law: MotionLaw) -> float:
        """The least scale of the time at which a law keeps it."""


@dataclass(frozen=True)
class DerivativeLimit:
    """A limit of a derivative, or of its positive or negative part, in a span or a part of it; `unit` is SI."""

    key: LimitKey
    most: float
    constant: Functional
    unit: float

    @property
    def nu(self) -> int:
        """The order of the derivative."""
        return self.key if isinstance(self.key, int) else self.key.nu

    @property
    def scales(self) -> bool:
        """True: a slower motion also keeps both sides of the limit."""
        return True

    def term(self, scale: float) -> tuple[Functional, float]:
        """The limited constant of the law, and the share that one unit of it takes."""
        return self.constant, self.unit / (self.most * scale**self.nu)

    def slope(self, law: MotionLaw, scale: float) -> float:  # noqa: ARG002 - that of every law
        """The order of the derivative."""
        return float(self.nu)

    def least_scale(self, law: MotionLaw) -> float:
        """The least scale of the time, in closed form: the root of the share at scale 1."""
        share = self.constant.value(law) * self.unit / self.most
        return float(max(share, 0.0) ** (1.0 / self.nu))


def limits_of_span(
    span: LawSpan, limits: Sequence[Limits], objective: CycleObjective, stroke: float, axis: str
) -> list[SpanLimit]:
    """The limits of a span, from the limits of each of its segments."""
    parts = list(_parts(span, limits))
    rows: list[SpanLimit] = []
    for key in dict.fromkeys(key for _, of_part in parts for key in of_part):
        limited = [(ends, of_part[key]) for ends, of_part in parts if key in of_part]
        first, everywhere = limited[0][1], len(limited) == len(parts)
        alike = everywhere and all(most == first for _, most in limited)
        if key in (FORCE, POWER, CURVE):
            rows += _of_drive(key, first, span, objective, stroke, axis, whole=alike)
            continue
        known = limited_by(span, objective, stroke, key)
        if not alike:
            constants = (_of_part(key, stroke, (place(span, low), place(span, high))) for (low, high), _ in limited)
            rows += [
                DerivativeLimit(key, most, constant, known.unit)
                for constant, (_, most) in zip(constants, limited, strict=True)
            ]
        if everywhere:
            # beside those of parts it says nothing new, but bounds laws as wholes, without which nothing is proven
            greatest = max(most for _, most in limited)
            rows.append(DerivativeLimit(key, greatest, known.constants[0], known.unit))
    return rows


def _of_drive(
    key: LimitKey, most: float, span: LawSpan, objective: CycleObjective, stroke: float, axis: str, *, whole: bool
) -> list[DrivenLimit]:
    if not isinstance(key, int) or not whole:
        raise InputError(f"{span.where} are one law: give the force or power of all of them the same limit")
    if objective.drive is None:
        raise InputError("force, torque and power are of a drive: give one, such as drive={'mass': '2 kg'}")
    return driven_limits(key, most, span, objective.drive, stroke, axis)


def _parts(span: LawSpan, limits: Sequence[Limits]) -> Iterator[tuple[tuple[float, float], Limits]]:
    """Each part of a span that has limits of its own, from where to where."""
    times = (*span.starts, span.stop)
    begun = 0
    for i in range(1, len(limits) + 1):
        if i == len(limits) or limits[i] != limits[begun]:
            yield (times[begun], times[i]), limits[begun]
            begun = i


def _of_part(key: LimitKey, stroke: float, ends: tuple[float, float]) -> Functional:
    nu = key if isinstance(key, int) else key.nu
    if not 1 <= nu <= 3:
        raise AssertionError  # those of the snap and of forces are of whole spans
    if isinstance(key, int):
        return peak("abcj"[nu], start=ends[0], stop=ends[1])
    return peak("abcj"[nu], side="high" if key.sign * stroke > 0.0 else "low", start=ends[0], stop=ends[1])


def least_scale(rows: Sequence[SpanLimit], law: MotionLaw) -> float:
    """The least scale of the time at which a law keeps all limits; 0 without limits."""
    return max((row.least_scale(law) for row in rows), default=0.0)
