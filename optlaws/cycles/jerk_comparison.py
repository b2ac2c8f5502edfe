"""The jerk that modified sine has in the motions of a cycle, as a reference and as a limit."""

from __future__ import annotations

from collections.abc import Iterable

from optlaws.cycles.optimisation.objectives import CycleObjective, limits_of_stretch
from optlaws.cycles.specification.joints import LawSpan, State
from optlaws.laws.catalogue.catalogue import catalogue

_USUAL = "modified sine"
_REST = State(0.0, 0.0)
_JERK = 3
#: the digits of the jerk that a limit names, rounded upward by the last one
_DIGITS = 6


def usual_jerk(spans: Iterable[LawSpan], objective: CycleObjective, axis: str) -> float | None:
    """The greatest peak jerk of modified sine in the same motions, in SI units.

    None where no law is looked for, a motion does not go from rest to rest by one law, a limit bounds the jerk or the
    snap already, or something else than the acceleration is minimised.
    """
    greatest = 0.0
    for span in spans:
        keys = limits_of_stretch(span.stretches[0], objective, axis)
        bounded = any(key.kind.order >= _JERK for key in keys)
        if bounded or span.via or len(span.stretches) > 1 or (span.first, span.last) != (_REST, _REST):
            return None
        stroke = abs(span.displacement)
        greatest = max(greatest, catalogue[_USUAL].law.constants.J.value * stroke / span.duration**_JERK)
    return greatest if greatest and objective.minimise == "acceleration" else None


def jerk_limit(jerk: float, axis: str) -> str:
    """A limit of so much jerk, in SI units, rounded upward.

    >>> jerk_limit(4201.3253, "length")
    '4201.33 m/s^3'
    """
    return f"{jerk * (1.0 + 10.0**-_DIGITS):.{_DIGITS + 1}g} {'rad' if axis == 'angle' else 'm'}/s^3"
