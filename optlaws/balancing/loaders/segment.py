"""The inertial loader's law on a stretch of the executive law, as a segment of a piecewise law."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from optlaws.balancing.loaders.stretch import LoaderStretch, stretch
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.laws.segments.segment import Segment
from optlaws.numbers import Array


@dataclass(frozen=True)
class LoaderSegment(Segment, kind="loader"):
    """b = scale sqrt(B² - b_ex²) between two places of an executive law, smooth inside.

    Parameters
    ----------
    executive
        The executive law, or its plain data.
    start, end
        The places.
    scale
        Y, negative where the loader moves back.
    top
        "start" or "end" where the executive velocity has its peak there, else "".

    Examples
    --------
    >>> from optlaws.laws import smoothstep
    >>> segment = LoaderSegment(smoothstep(2), 0.0, 0.5, scale=1.0, top="end")
    >>> segment.derivative(np.array([0.0, 1.0]), 0.5, 1)
    array([1.5, 0. ])
    """

    executive: MotionLaw
    start: float
    end: float
    scale: float
    top: str = ""

    def __post_init__(self) -> None:
        given: Any = self.executive
        if not isinstance(given, MotionLaw):
            object.__setattr__(self, "executive", MotionLaw.from_dict(given))

    def derivative(self, u: Array, length: float, nu: int) -> Array:  # noqa: ARG002, D102
        flat = np.atleast_1d(u)
        if nu == 0:
            from_origin = self._stretch.integral(self._times(flat))
            values = self._stretch.integral(self._times(np.zeros(1))) - from_origin if self._back else from_origin
        else:
            values = self._stretch.value(self._times(flat), nu - 1)
            if self._back and nu % 2 == 0:
                values = -values
        return np.asarray(self.scale * values.reshape(np.shape(u)))

    def candidates(self, length: float, nu: int) -> Array:  # noqa: ARG002, D102
        return self._places(self._stretch.roots(nu)) if nu else np.empty(0)

    def power_candidates(self, length: float) -> Array:  # noqa: ARG002, D102
        return self._places(self._stretch.power_roots())

    def square(self, length: float, nu: int) -> float:  # noqa: ARG002, D102
        return self.scale**2 * self._stretch.square(nu - 1)

    @property
    def _back(self) -> bool:
        return self.top == "end"

    @kept_property
    def _stretch(self) -> LoaderStretch:
        ends = (self.end, self.start) if self._back else (self.start, self.end)
        B = self.executive.peak(1).value
        return stretch(self.executive, B, *ends, top=bool(self.top))

    def _times(self, u: Array) -> Array:
        span = self.end - self.start
        return span * (1.0 - u) if self._back else span * u

    def _places(self, t: Array) -> Array:
        u = np.clip(t / (self.end - self.start), 0.0, 1.0)
        return 1.0 - u if self._back else u
