"""The limits of a span, and of parts of it, as shares of what is allowed at any scale of the time."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from optlaws.cycles.greatest_speed.drive_limits_of_span import driven_limits
from optlaws.cycles.greatest_speed.scaling import SpanLimit
from optlaws.cycles.optimisation.motion_limits import Side, Sides
from optlaws.cycles.optimisation.objectives import CycleObjective
from optlaws.cycles.optimisation.optimal import limited_by
from optlaws.cycles.optimisation.search_spaces import place
from optlaws.cycles.specification.joints import LawSpan
from optlaws.errors import InputError
from optlaws.laws import MotionLaw
from optlaws.motion.quantity_kinds import Kind
from optlaws.synthesis.functionals.makers import peak
from optlaws.synthesis.problem.constants import Functional


def limits_of_span(
    span: LawSpan, limits: Sequence[Sides], objective: CycleObjective, stroke: float, axis: str
) -> list[SpanLimit]:
    """The limits of a span, from the limits of each of its segments."""
    parts = list(_parts(span, limits))
    rows: list[SpanLimit] = []
    for key in dict.fromkeys(key for _, of_part in parts for key in of_part):
        if key.kind is Kind.VELOCITY_ALONG:
            continue  # of the laws that are looked for, at every speed
        limited = [(ends, of_part[key]) for ends, of_part in parts if key in of_part]
        first, everywhere = limited[0][1], len(limited) == len(parts)
        alike = everywhere and all(most == first for _, most in limited)
        if key.kind.is_driven:
            rows += _of_drive(key, first, span, objective, stroke, axis, whole=alike)
            continue
        known = limited_by(span, objective, stroke, key)
        if not alike:
            constants = (_of_part(key, stroke, (place(span, low), place(span, high))) for (low, high), _ in limited)
            rows += [
                _of_derivative(key, most, constant, known.unit)
                for constant, (_, most) in zip(constants, limited, strict=True)
            ]
        if everywhere:
            # beside those of parts it says nothing new, but bounds laws as wholes, without which nothing is proven
            greatest = max(most for _, most in limited)
            rows.append(_of_derivative(key, greatest, known.constants[0], known.unit))
    return rows


def _of_derivative(key: Side, most: float, constant: Functional, unit: float) -> SpanLimit:
    """A limit of a derivative, or of one side of it, in a span or a part of it; the unit is SI."""
    return SpanLimit(key, most, lambda scale: (constant, unit / (most * scale**key.kind.order)))


def _of_drive(
    key: Side, most: float, span: LawSpan, objective: CycleObjective, stroke: float, axis: str, *, whole: bool
) -> list[SpanLimit]:
    if not whole:
        raise InputError(f"{span.where} are one law: give the force or power of all of them the same limit")
    if objective.drive is None:
        raise InputError("force, torque and power are of a drive: give one, such as drive={'mass': '2 kg'}")
    return driven_limits(key, most, span, objective.drive, stroke, axis)


def _parts(span: LawSpan, limits: Sequence[Sides]) -> Iterator[tuple[tuple[float, float], Sides]]:
    """Each part of a span that has limits of its own, from where to where."""
    times = (*span.starts, span.stop)
    begun = 0
    for i in range(1, len(limits) + 1):
        if i == len(limits) or limits[i] != limits[begun]:
            yield (times[begun], times[i]), limits[begun]
            begun = i


def _of_part(key: Side, stroke: float, ends: tuple[float, float]) -> Functional:
    nu = key.kind.order
    if not 1 <= nu <= 3:
        raise AssertionError  # those of the snap and of forces are of whole spans
    if not key.sign:
        return peak("abcj"[nu], start=ends[0], stop=ends[1])
    return peak("abcj"[nu], side="high" if key.sign * stroke > 0.0 else "low", start=ends[0], stop=ends[1])


def least_scale(rows: Sequence[SpanLimit], law: MotionLaw) -> float:
    """The least scale of the time at which a law keeps all limits; 0 without limits."""
    return max((row.least_scale(law) for row in rows), default=0.0)
