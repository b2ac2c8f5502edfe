"""Parts of laws, stretched and scaled, as segments of a composed motion."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf
from typing import Any

import numpy as np

from optlaws.laws import MotionLaw
from optlaws.laws.segments.segment import Segment
from optlaws.numbers import Array


@dataclass(frozen=True)
class PartSegment(Segment, kind="part"):
    """A law from one k to another, without a break of its own in between, as a segment of any length.

    Parameters
    ----------
    law
        The law, or its plain data.
    start, end
        The two k.
    scale
        Stroke of the whole law in the composed motion; negative for a motion back.

    Examples
    --------
    >>> from optlaws.laws import smoothstep
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

    def derivative(self, u: Array, length: float, nu: int) -> Array:  # noqa: D102
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

    def candidates(self, length: float, nu: int) -> Array:  # noqa: ARG002, D102
        return self._places(np.array([extreme.k for extreme in self.law.extrema(nu, (self.start, self.end))]))

    def power_candidates(self, length: float) -> Array:  # noqa: ARG002, D102
        return self._places(np.array([extreme.k for extreme in self.law.power_extrema((self.start, self.end))]))

    def scaled(self, length: float, scale: float, drift: float = 0.0) -> Segment:  # noqa: D102
        return super().scaled(length, scale, drift) if drift else replace(self, scale=scale * self.scale)

    def square(self, length: float, nu: int) -> float:  # noqa: D102
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
