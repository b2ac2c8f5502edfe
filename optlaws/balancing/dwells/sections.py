"""The motion of a balancing rocker section by section, and the whole cycle as one piecewise law."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import accumulate, pairwise

from optlaws.balancing.dwells.parts import PartSegment
from optlaws.errors import InputError
from optlaws.laws import MotionLaw
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.laws.segments.segment import PolynomialSegment, Segment
from optlaws.numerics.tolerances import CLOSURE

Pair = tuple[float, float]


@dataclass(frozen=True)
class Section:
    """One section of the balancing cam.

    Attributes
    ----------
    name
        What happens: "rise", "return" (of the executive link), "dwell", "clutch", "run-out", "reverse", "standstill"
        or "run-up".
    angle
        Cam angle, radians.
    travel
        Way of the rocker, in strokes S of the executive link.
    law
        The law run; None at uniform speed.
    start, end
        Where the law begins and ends on this section.
    scale
        Stroke of the whole law, in S.
    """

    name: str
    angle: float
    travel: float
    law: MotionLaw | None = None
    start: float = 0.0
    end: float = 1.0
    scale: float = 0.0

    @classmethod
    def run(
        cls, name: str, angle: float, law: MotionLaw, scale: float, part: tuple[float, float] = (0.0, 1.0)
    ) -> Section:
        """A section that runs a part of a law."""
        start, end = part
        return cls(name, angle, scale * _travel(law, start, end), law, start, end, scale)

    @property
    def extent(self) -> tuple[float, float]:
        """Least and greatest displacement since the section's start, in S."""
        if self.law is None:
            return min(0.0, self.travel), max(0.0, self.travel)
        least, most = _extent(self.law, self.start, self.end)
        return min(self.scale * least, self.scale * most), max(self.scale * least, self.scale * most)


@lru_cache(maxsize=256)
def _travel(law: MotionLaw, start: float, end: float) -> float:
    return law.a(end) - law.a(start)


@lru_cache(maxsize=256)
def _extent(law: MotionLaw, start: float, end: float) -> Pair:
    least, most = law.extrema(0, (start, end))
    first = law.a(start)
    return least.value - first, most.value - first


def excursion(sections: Sequence[Section]) -> float:
    """The way between the extremes of the rocker over a cycle, in S."""
    places = accumulate((section.travel for section in sections), initial=0.0)
    extents = [
        (place + low, place + high)
        for place, (low, high) in zip(places, (section.extent for section in sections), strict=False)
    ]
    return max(high for _, high in extents) - min(low for low, _ in extents)


def composed(sections: Sequence[Section]) -> PiecewiseLaw:
    """The motion over the cycle as a law of k = cam angle / angle of the cycle; displacement in S."""
    net = sum(section.travel for section in sections)
    if abs(net) > CLOSURE:
        raise InputError(f"the rocker is {net:.6g} S off its start after the cycle; dwells or laws do not match")
    whole = sum(section.angle for section in sections)
    places, segments = [0.0], list[Segment]()
    angle = 0.0
    for section in sections:
        for share, segment in _segments(section, whole):
            segments.append(segment)
            angle += share * section.angle
            places.append(angle / whole)
    places[-1] = 1.0
    return PiecewiseLaw(places, segments)


def _segments(section: Section, whole: float) -> list[tuple[float, Segment]]:
    if section.law is None:
        return [(1.0, PolynomialSegment((), section.travel * whole / section.angle))]
    inside = [k for k in section.law.breaks if section.start < k < section.end]
    span = section.end - section.start
    return [
        ((end - start) / span, PartSegment(section.law, start, end, section.scale))
        for start, end in pairwise([section.start, *inside, section.end])
    ]
