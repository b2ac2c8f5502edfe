"""An axis over its clock, enclosed in intervals of time: where it is, and when it passes a position."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np

from optlaws.cycles.cycle import Cycle
from optlaws.kept import kept_property
from optlaws.motion.smooth_stretches import EnclosedStretch, jet_of_parts, smooth_parts
from optlaws.numbers import Array
from optlaws.numerics.branch_and_bound import Extremes, extremes
from optlaws.numerics.interval import Interval, exact
from optlaws.numerics.taylor import Jet
from optlaws.tolerances import INTERLOCK, PASS_WIDTH

Way: TypeAlias = Literal["up", "down"]

_ROUNDS = 60


@dataclass(frozen=True, eq=False)
class EnclosedAxis:
    """The position of an axis over the time of a cycle, in SI units, with enclosures of it and its derivatives.

    >>> from optlaws import Cycle, Return, Rise
    >>> axis = EnclosedAxis(Cycle([Rise("40 mm", "0.1 s", law="cycloidal"), Return(law="cycloidal")], period="0.3 s"))
    >>> [round(0.5 * (low + high), 9) for low, high in axis.passes(0.02)]
    [0.05, 0.2]
    """

    cycle: Cycle

    @kept_property
    def stretches(self) -> tuple[EnclosedStretch, ...]:
        """Smooth parts, one after the other."""
        return tuple(part for piece in self.cycle.pieces for part in smooth_parts(piece, EnclosedStretch))

    @kept_property
    def breaks(self) -> tuple[float, ...]:
        """Times between which the motion is smooth, both ends included."""
        return (*(stretch.start for stretch in self.stretches), self.stretches[-1].stop)

    @kept_property
    def stroke(self) -> float:
        """Between the least and the greatest position."""
        lows, highs = zip(*(stretch.extremes(0) for stretch in self.stretches), strict=True)
        return float(max(highs) - min(lows))

    def jet(self, at: Interval, order: int) -> Jet:
        """The position with its Taylor terms in intervals of time, each within two neighbouring breaks."""
        return jet_of_parts(self.stretches, lambda stretch, some: stretch.jet(some, order), at)

    def between(self, start: float, stop: float) -> tuple[float, float]:
        """Bounds of the position over a short while, breaks in it or not."""
        lows, highs = [], []
        for stretch in self.stretches:
            low, high = max(start, stretch.start), min(stop, stretch.stop)
            if low <= high:
                place = Interval(np.array([0.5 * (low + high)]), np.array([0.5 * (high - low)]))
                value = stretch.jet(place, 0).terms[0]
                lows.append(float(value.low[0]))
                highs.append(float(value.high[0]))
        return min(lows), max(highs)

    def passes(self, position: float, way: Way | None = None) -> list[tuple[float, float]]:
        """When it passes a position at which it does not rest, on its way up, down, or any: enclosures of the times.

        There are no other passes: what is left out is proven to be above or below the position.
        """
        low, high = np.array(self.breaks[:-1]), np.array(self.breaks[1:])
        for _ in range(_ROUNDS):
            if (high - low <= PASS_WIDTH * self.cycle.duration).all():
                break
            low, high = self._narrowed(low, high, position)
        joined = list[tuple[float, float]]()
        for start, stop in sorted(zip(low.tolist(), high.tolist(), strict=True)):
            if joined and start <= joined[-1][1] + PASS_WIDTH * self.cycle.duration:
                joined[-1] = joined[-1][0], max(stop, joined[-1][1])
            else:
                joined.append((start, stop))
        sign = {"up": 1.0, "down": -1.0, None: 0.0}[way]
        return [(start, stop) for start, stop in joined if sign * self.cycle(0.5 * (start + stop), 1) >= 0.0]

    def entries(self, position: float, way: Way) -> list[float]:
        """When it passes a position on its way up or down, or comes to rest at it from there."""
        near = INTERLOCK * self.stroke
        still = [each.stroke == 0.0 and abs(each.offset - position) <= near for each in self.stretches]
        if not any(still):
            return [0.5 * (low + high) for low, high in self.passes(position, way)]
        sign = 1.0 if way == "up" else -1.0
        pairs = zip(self.stretches, self.stretches[1:], still[1:], strict=False)
        return [after.start for before, after, rests in pairs if rests and sign * before.stroke > 0.0]

    def _narrowed(self, low: Array, high: Array, position: float) -> tuple[Array, Array]:
        """Cells in which it may be at a position: by Newton's method where the velocity has one sign, else halved."""
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        whole, at = self.jet(Interval(middle, half), 1), self.jet(exact(middle), 0).terms[0]
        met = (whole.terms[0].low <= position) & (whole.terms[0].high >= position)
        with np.errstate(divide="ignore", invalid="ignore"):
            steps = (position - at) / whole.terms[1]
            first = np.where(np.isfinite(steps.radius), np.maximum(low, middle + steps.low), low)
            last = np.where(np.isfinite(steps.radius), np.minimum(high, middle + steps.high), high)
        met &= first <= last
        first, last, low, high = first[met], last[met], low[met], high[met]
        wide = (last - first > 0.5 * (high - low)) & (last - first > PASS_WIDTH * self.cycle.duration)
        cut = 0.5 * (first + last)
        lows = np.concatenate([first, cut[wide]])
        highs = np.concatenate([np.where(wide, cut, last), last[wide]])
        return lows, highs


def least(
    function: Callable[[Interval, int], Jet],
    axes: Sequence[EnclosedAxis],
    share: float,
    within: tuple[float, float] | None = None,
) -> Extremes:
    """Least and greatest value of a function of axis motions, proven over a cycle or a window of it."""
    start, stop = within or (0.0, axes[0].cycle.duration)
    breaks = sorted({place for axis in axes for place in axis.breaks if start < place < stop})
    return extremes(function, [start, *breaks, stop], share=share, parts=2)
