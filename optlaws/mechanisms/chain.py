"""Motion of the mass over a chain of stretches: values, and extremes over the whole of it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import ceil, log2

import numpy as np

from optlaws.kept import kept_property
from optlaws.mechanisms.forcing import Forcing
from optlaws.mechanisms.particular import RADIANS, ForcedStretch, stretches
from optlaws.mechanisms.vibration import Oscillator
from optlaws.numbers import Array
from optlaws.numerics import chebyshev
from optlaws.numerics.panels import Panels, equal, resolved

_MOTION_RESOLVED = 1e-9  # of the whole motion: what a series misses where roots are looked for; Newton does the rest
_STRETCH_RESOLVED = 1e-14  # of a stretch: the same where squares are integrated

State = tuple[float, float]
#: of a slope on a stretch by its number, at times since its start: the slope itself, or its derivative
Slope = Callable[[int, Array, int], Array]

DEEPEST = 5
MANY = 64
COUNT = 41
SAMPLES = 0.5 - 0.5 * chebyshev.nodes(17)


@dataclass(frozen=True, eq=False)
class MassChain:
    """The motion of the mass over consecutive forcings without gaps, from displacement and velocity at their start."""

    oscillator: Oscillator
    forcings: Sequence[Forcing]
    initial: State

    @kept_property
    def stretches(self) -> list[ForcedStretch]:
        """The forcings with their particular solutions."""
        return [stretch for forcing in self.forcings for stretch in stretches(forcing, self.oscillator)]

    @kept_property
    def _joints(self) -> tuple[list[State], State]:
        """State of the free part at the start of every stretch, and the mass off its cam at the end."""
        starts: list[State] = []
        end = np.zeros(1)
        before: Forcing | None = None
        u, v = 0.0, 0.0
        for stretch in self.stretches:
            if stretch.forcing is not before:
                cam = [float(stretch.cam(end, nu)[0]) for nu in (0, 1)]
                if before is None:
                    u, v = self.initial[0] - cam[0], self.initial[1] - cam[1]
                else:  # displacement and velocity of the mass are continuous, whatever the cam does
                    last = np.array([before.length])
                    u += float(before.derivative(last, 0)[0]) - cam[0]
                    v += float(before.derivative(last, 1)[0]) - cam[1]
                before = stretch.forcing
            free = (
                u - float(stretch.particular.derivative(end, 0)[0]),
                v - float(stretch.particular.derivative(end, 1)[0]),
            )
            starts.append(free)
            last = np.array([stretch.length])
            u, v = (
                float(stretch.particular.derivative(last, nu)[0] + self.oscillator.motion(*free, last, nu)[0])
                for nu in (0, 1)
            )
        return starts, (u, v)

    @property
    def breaks(self) -> tuple[float, ...]:
        """The times at which one forcing ends and the next begins, both ends of the chain included."""
        last = self.forcings[-1]
        return (*(forcing.start for forcing in self.forcings), last.start + last.length)

    def before_breaks(self, nu: int) -> Array:
        """The derivative of order `nu` of a_m just before every break inside."""
        pairs = zip(self.stretches, self.stretches[1:], strict=False)
        last = [i for i, (before, after) in enumerate(pairs) if after.forcing is not before.forcing]
        return np.array([float(self._values(i, np.array([self.stretches[i].length]), nu)[0]) for i in last])

    @property
    def off_at_end(self) -> State:
        """Displacement and velocity of the mass relative to the cam at the end."""
        return self._joints[1]

    @kept_property
    def end(self) -> State:
        """Displacement and velocity of the mass at the end."""
        last = self.stretches[-1]
        cam = [float(last.cam(np.array([last.length]), nu)[0]) for nu in (0, 1)]
        return cam[0] + self.off_at_end[0], cam[1] + self.off_at_end[1]

    def derivative(self, time: Array, nu: int) -> Array:
        """Derivative of order `nu` of a_m at times of any shape within the chain."""
        starts = np.array([stretch.start for stretch in self.stretches])
        places = np.clip(np.searchsorted(starts, time, side="right") - 1, 0, len(starts) - 1)
        values = np.empty(np.shape(time))
        for i in np.unique(places):
            here = places == i
            s = np.clip(np.asarray(time)[here] - starts[i], 0.0, self.stretches[i].length)
            values[here] = self._values(int(i), s, nu)
        return values

    def candidates(self, nu: int) -> tuple[Array, Array]:
        """Times, and values there, among which the extremes of the derivative of order `nu` are."""
        return self._gathered(
            lambda i, s: self._values(i, s, nu), lambda i, s, further: self._values(i, s, nu + 1 + further)
        )

    def power_candidates(self) -> tuple[Array, Array]:
        """Times, and values there, among which the extremes of the kinetic power d = b c are."""

        def slope(i: int, s: Array, further: int) -> Array:
            b, c, j = (self._values(i, s, nu) for nu in (1, 2, 3))
            return 3.0 * c * j + b * self._values(i, s, 4) if further else c * c + b * j

        return self._gathered(lambda i, s: self._values(i, s, 1) * self._values(i, s, 2), slope)

    def mean_square(self, nu: int) -> float:
        """Mean of the square of the derivative of order `nu` over the chain."""
        total = sum(self._square(i, stretch.length, nu) for i, stretch in enumerate(self.stretches))
        return total / sum(stretch.length for stretch in self.stretches)

    def _square(self, i: int, length: float, nu: int) -> float:
        """The integral over a stretch, halved until the series of the product is accurate to rounding."""
        negligible = _STRETCH_RESOLVED * float(np.abs(self._values(i, length * SAMPLES, nu)).max())
        panels, series = self._resolved(lambda s: self._values(i, s, nu), length, negligible)
        pieces = zip(np.diff(panels.edges).tolist(), series.T, strict=True)
        return float(sum(span * chebyshev.mean_product(column, column) for span, column in pieces))

    def _gathered(self, values: Callable[[int, Array], Array], slope: Slope) -> tuple[Array, Array]:
        """Both ends of every stretch and its roots of a slope, with the values there."""
        slopes = [slope(i, stretch.length * SAMPLES, 0) for i, stretch in enumerate(self.stretches)]
        negligible = _MOTION_RESOLVED * float(max(np.abs(steepness).max() for steepness in slopes))
        times, heights = [], []
        for i, stretch in enumerate(self.stretches):
            s = np.concatenate([[0.0], self._stops(i, slope, negligible), [stretch.length]])
            times.append(stretch.start + s)
            heights.append(values(i, s))
        return np.concatenate(times), np.concatenate(heights)

    def _values(self, i: int, s: Array, nu: int) -> Array:
        """a + u where u is small beside a; else, from a_m'' on, the equation of motion, which cancels less."""
        stretch, free = self.stretches[i], self._joints[0][i]

        def off(nu: int) -> Array:
            return np.asarray(stretch.particular.derivative(s, nu) + self.oscillator.motion(*free, s, nu))

        if nu < 2 or stretch.closed:
            return stretch.cam(s, nu) + off(nu)
        twice, square = 2.0 * self.oscillator.n, self.oscillator.frequency**2
        value = stretch.cam(s, 1) + off(1)
        for m in range(nu - 1):
            value = -twice * value - square * off(m)
        return value

    def _stops(self, i: int, slope: Slope, negligible: float) -> Array:
        """Points of a stretch where a slope is zero, each from a Chebyshev series there."""
        panels, series = self._resolved(lambda s: slope(i, s, 0), self.stretches[i].length, negligible)
        return panels.roots_of(series, lambda s: slope(i, s, 0), lambda s: slope(i, s, 1))

    def _resolved(self, f: Callable[[Array], Array], length: float, negligible: float) -> tuple[Panels, Array]:
        """Panels of a stretch on which a function is known up to a negligible error, with its series there."""
        count, deepest = max(1, ceil(self.oscillator.fastest * length / RADIANS)), DEEPEST
        if count > MANY:  # a vibration that has died out needs no short panels
            count, deepest = 1, DEEPEST + ceil(log2(count))
        shortest = 1.5 * length / count / 2**deepest

        def short(series: Array, span: float) -> bool:
            return bool(np.abs(series[-3:]).max() <= negligible) or span < shortest

        return resolved(f, equal(0.0, length, count, COUNT), short)
