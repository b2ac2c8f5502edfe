"""The jerk that modified sine has in the motions of a cycle, as a reference and as a limit."""

from __future__ import annotations

from collections.abc import Iterable

from optlaws.cycles.optimisation.objectives import CycleObjective, limits_of_stretch
from optlaws.cycles.specification.joints import LawSpan, State
from optlaws.laws.catalogue.catalogue import catalogue
from optlaws.motion.piece import unit_of

_REST = State(0.0, 0.0)
_JERK = 3
_DIGITS = 6  # of the jerk that a limit names, rounded upward by the last one


def usual_jerk(spans: Iterable[LawSpan], objective: CycleObjective, axis: str) -> float | None:
    """The greatest peak jerk of modified sine in the same motions, in SI units; None as `Cycle.modified_sine_jerk`."""
    if objective.minimise != "acceleration":
        return None
    greatest = 0.0
    for span in spans:
        limits = limits_of_stretch(span.stretches[0], objective, axis)
        bounded = any(side.kind.order >= _JERK for side in limits)
        if bounded or span.via or len(span.stretches) > 1 or (span.first, span.last) != (_REST, _REST):
            return None
        jerk = catalogue["modified sine"].law.constants.J.value * abs(span.displacement) / span.duration**_JERK
        greatest = max(greatest, jerk)
    return greatest or None


def jerk_limit(jerk: float, axis: str) -> str:
    """A limit of so much jerk, in SI units, rounded upward."""
    return f"{jerk * (1.0 + 10.0**-_DIGITS):.{_DIGITS + 1}g} {unit_of(axis)}/s^{_JERK}"
