"""Laws as forcings: polynomials and sines as they are, everything else as Chebyshev series on short stretches."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from optlaws.laws import MotionLaw, PolynomialLaw
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.laws.segments.segment import Segment, Wave, Waves
from optlaws.mechanisms.follower.cam_motion import Forcing
from optlaws.numbers import Array
from optlaws.numerics import chebyshev
from optlaws.numerics.panels import Panels, resolved
from optlaws.numerics.tolerances import VELOCITY_ABSORBED, VELOCITY_RESOLVED

COUNT = 41


def forcings(
    law: MotionLaw, start: float = 0.0, length: float = 1.0, a0: float | None = None, stroke: float = 1.0
) -> tuple[Forcing, ...]:
    """Pieces of a0 + stroke (law(k) - law(0)), k = (time - start) / length.

    Parameters
    ----------
    law
        Any law.
    start, length
        When it begins, and how long it takes.
    a0
        Displacement at its start; the law's own unless given.
    stroke
        Factor of the displacement, -1 for a return.

    Examples
    --------
    >>> from optlaws.laws import smoothstep
    >>> [forcing.derivative(np.array([2.0]), 0).tolist() for forcing in forcings(smoothstep(3), 1.0, 2.0, 1.0, -1.0)]
    [[0.0]]
    """
    return _Frame(law, start, length, float(law.a(0.0)) if a0 is None else a0, stroke).pieces()


@dataclass(frozen=True)
class _Frame:
    """A law in units of time."""

    law: MotionLaw
    start: float
    length: float
    a0: float
    stroke: float

    def pieces(self) -> tuple[Forcing, ...]:
        law = self.law
        if isinstance(law, PolynomialLaw):
            return (self._forcing(Waves(law.acceleration or (0.0,), law.b0), 0.0, 1.0),)
        if isinstance(law, PiecewiseLaw):
            stretches = zip(law.segments, pairwise(law.breaks), strict=True)
            return tuple(piece for segment, (low, high) in stretches for piece in self._segment(segment, low, high))
        return tuple(self._interpolated(lambda k: np.asarray(law.b(k)), 0.0, 1.0))

    def _segment(self, segment: Segment, low: float, high: float) -> list[Forcing]:
        if (waves := segment.waves(high - low)) is not None:
            return [self._forcing(waves, low, high)]
        return self._interpolated(lambda k: segment.derivative((k - low) / (high - low), high - low, 1), low, high)

    def _place(self, low: float, high: float) -> tuple[float, float, float]:
        a0 = self.a0 + self.stroke * (float(self.law.a(low)) - float(self.law.a(0.0)))
        return self.start + self.length * low, self.length * (high - low), a0

    def _forcing(self, waves: Waves, low: float, high: float) -> Forcing:
        scale = self.stroke / self.length**2
        sines = (Wave(scale * sine.amplitude, sine.frequency / self.length, sine.phase) for sine in waves.sines)
        c = scale * np.array(waves.acceleration)
        return Forcing(*self._place(low, high), self.stroke / self.length * waves.b0, c, tuple(sines))

    def _interpolated(self, velocity: Callable[[Array], Array], low: float, high: float) -> list[Forcing]:
        ends = 0.5 * (low + high) + 0.5 * (high - low) * chebyshev.nodes(COUNT)
        size = float(np.abs(velocity(ends)).max()) or 1.0

        def short(b: Array, length: float) -> bool:
            missed = float(np.abs(b[-4:]).max()) / size
            return missed <= VELOCITY_RESOLVED or 0.5 * missed * length <= VELOCITY_ABSORBED

        panels, series = resolved(velocity, Panels((low, high), COUNT), short)
        pieces = []
        for (first, last), b in zip(pairwise(panels.edges), series.T, strict=True):
            c = tuple((chebyshev.derivative(b) / (last - first)).tolist())
            pieces.append(self._forcing(Waves(c, float(chebyshev.value(b, -1.0))), first, last))
        return pieces
