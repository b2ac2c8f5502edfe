"""The motion of a balancing rocker section by section: laws on sections, their parts, the cycle as one law."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import accumulate, pairwise
from math import inf
from typing import Any

import numpy as np

from optlaws.balancing.loaders.loader import Loader
from optlaws.balancing.loaders.tops import tops
from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.laws import MotionLaw
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.laws.segments.segment import PolynomialSegment, Segment
from optlaws.numbers import Array
from optlaws.tolerances import AGREEMENT, CLOSURE

#: the loader of a law, kept
loader_of = lru_cache(maxsize=64)(Loader)


@lru_cache(maxsize=64)
def top(law: MotionLaw) -> float:
    """The place where a law is cut into a run-up and a run-out: the middle of the top of its velocity.

    Examples
    --------
    >>> from optlaws import smoothstep
    >>> top(smoothstep(2))
    0.5
    """
    places = tops(law)
    middle = places[len(places) // 2]
    return 0.5 * (middle.first + middle.last)


def law_of(given: Any) -> Any:
    """The law of a catalogue entry or of a solution; any other value is returned unchanged."""
    law = getattr(given, "law", None)
    return law if isinstance(law, MotionLaw) and not isinstance(given, MotionLaw) else given


def check_law(name: str, law: Any) -> None:
    """Refuse what is no law from rest to rest over a stroke of 1."""
    if not isinstance(law, MotionLaw):
        raise InputError(f"{name} must be a MotionLaw, or what has one in `law`, got {shortened(law)}")
    (a0, b0), (a1, b1) = law.boundary_values(2)
    if max(abs(b0), abs(b1)) > AGREEMENT * law.constants.B.value or abs(a1 - a0 - 1.0) > AGREEMENT:
        raise InputError(
            f"{name} must run from rest to rest over a stroke of 1; it begins with a = {a0:g}, b = {b0:g}, ends with "
            f"a = {a1:g}, b = {b1:g}"
        )
    tops(law)


@dataclass(frozen=True)
class PartSegment(Segment, kind="part"):
    """A law from one k to another, without a break of its own in between, as a segment of any length.

    The scale is the stroke of the whole law in the composed motion, negative for a motion back.

    Examples
    --------
    >>> from optlaws import smoothstep
    >>> half = PartSegment(smoothstep(2), 0.0, 0.5, scale=-4.0)
    >>> half.derivative(np.array([0.0, 1.0]), 0.25, 0), half.derivative(np.array([0.0, 1.0]), 0.25, 1)
    (array([-0., -2.]), array([ -0., -12.]))
    """

    law: MotionLaw
    start: float
    end: float
    scale: float

    def __post_init__(self) -> None:
        given: Any = self.law
        if not isinstance(given, MotionLaw):
            object.__setattr__(self, "law", MotionLaw.from_dict(given))

    def derivative(self, u: Array, length: float, nu: int) -> Array:
        span = self.end - self.start
        k = np.clip(self.start + span * u, self.start, self.end)
        values = self.law(k, nu)
        if self.end < 1.0:
            # at a break a law has its right-hand value; what grows without limit there does so on both sides
            inner = self.law(np.minimum(k, np.nextafter(self.end, self.start)), nu)
            values = np.where(np.isfinite(values), inner, values)
        if nu == 0:
            return np.asarray(self.scale * (values - self.law.a(self.start)))
        return np.asarray(self.scale * (span / length) ** nu * values)

    def candidates(self, length: float, nu: int) -> Array:  # noqa: ARG002 - what others of its kind need
        return self._places(np.array([extreme.k for extreme in self.law.extrema(nu, (self.start, self.end))]))

    def power_candidates(self, length: float) -> Array:  # noqa: ARG002 - what others of its kind need
        return self._places(np.array([extreme.k for extreme in self.law.power_extrema((self.start, self.end))]))

    def scaled(self, length: float, scale: float, drift: float = 0.0) -> Segment:
        return super().scaled(length, scale, drift) if drift else replace(self, scale=scale * self.scale)

    def square(self, length: float, nu: int) -> float:
        from scipy.integrate import quad

        # with the full output it says what is wrong there and warns nobody: filters of warnings are the process's
        whole, _, _, *wrong = quad(
            lambda k: self.law(k, nu) ** 2, self.start, self.end, epsabs=0.0, epsrel=1e-12, full_output=1
        )
        if wrong:
            return inf
        span = self.end - self.start
        return float(self.scale**2 * (span / length) ** (2 * nu - 1) * whole)

    def _places(self, k: Array) -> Array:
        return np.clip((k - self.start) / (self.end - self.start), 0.0, 1.0)


Pair = tuple[float, float]


@dataclass(frozen=True)
class Section:
    """One section of the balancing cam's profile.

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
