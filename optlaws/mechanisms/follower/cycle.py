"""Steady response of a follower to a cycle that repeats: rise, dwell, return, rest."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.mechanisms.checks import leads_back
from optlaws.mechanisms.follower.cam_motion import Forcing, rest
from optlaws.mechanisms.follower.chain import MassChain
from optlaws.mechanisms.follower.law_motion import forcings
from optlaws.mechanisms.follower.mass_motion import MassMotion
from optlaws.mechanisms.follower.vibration import Oscillator
from optlaws.numbers import Array
from optlaws.numerics.tolerances import RESONANCE, SHORTEST_STRETCH


@dataclass(frozen=True, repr=False)
class CycleResponse(MassMotion):
    """Periodic motion of the mass under a periodic cam; made by `Follower.cycle`.

    Call it like a law, at any k; time is in durations of the rise. Peaks, extrema, root mean squares and samples are
    those of the whole cycle.

    Parameters
    ----------
    nu, damping
        The follower's frequency and damping ratio.
    rise, fall
        Laws of the rise and of the return.
    dwell, fall_duration, rest
        Durations of what follows the rise, in durations of the rise.

    Examples
    --------
    >>> from optlaws.laws import smoothstep
    >>> from optlaws.mechanisms import Follower
    >>> Follower(nu=20, damping=0.05).cycle(smoothstep(4), dwell=0.5, rest=1.0)
    CycleResponse(nu=20, damping=0.05, period=3.5, peak acceleration=11.018)
    """

    nu: float
    damping: float
    rise: MotionLaw
    fall: MotionLaw
    dwell: float
    fall_duration: float
    rest: float

    def __post_init__(self) -> None:
        leads_back(self.rise, self.fall)
        self._initial  # noqa: B018 - a cycle in resonance is refused at once

    @property
    def period(self) -> float:
        """Duration of the cycle, in durations of the rise."""
        return 1.0 + self.dwell + self.fall_duration + self.rest

    @property
    def interval(self) -> tuple[float, float]:
        """The times at which the cycle begins and ends."""
        return 0.0, self.period

    def __repr__(self) -> str:
        return (
            f"CycleResponse(nu={self.nu:g}, damping={self.damping:g}, period={self.period:g}, "
            f"peak acceleration={self.peak(2).value:g})"
        )

    @kept_property
    def _forcings(self) -> list[Forcing]:
        low, high = float(self.rise.a(0.0)), float(self.rise.a(1.0))
        driven = list(forcings(self.rise))
        if self.dwell > SHORTEST_STRETCH:
            driven.append(rest(1.0, self.dwell, high))
        driven += forcings(self.fall, 1.0 + self.dwell, self.fall_duration, high, -1.0)
        if self.rest > SHORTEST_STRETCH:
            driven.append(rest(1.0 + self.dwell + self.fall_duration, self.rest, low))
        return driven

    @kept_property
    def _initial(self) -> tuple[float, float]:
        """State that comes back after one period."""
        oscillator = Oscillator(self.nu, self.damping)
        low = float(self.rise.a(0.0))
        forced = MassChain(oscillator, self._forcings, (low, 0.0)).end
        end = np.array([self.period])
        columns = [
            [oscillator.motion(*unit, end, order)[0] for order in (0, 1)] for unit in ((1.0, 0.0), (0.0, self.nu))
        ]
        matrix = np.eye(2) - np.array([columns[0], np.array(columns[1]) / self.nu]).T
        scaled = matrix * np.array([[1.0, self.nu], [1.0 / self.nu, 1.0]])
        if np.linalg.svd(scaled, compute_uv=False)[-1] < RESONANCE:
            raise InputError(
                f"an undamped follower of nu = {self.nu:g} is in resonance with a cycle of {self.period:g} durations "
                "of the rise (nu period / 2 pi is whole): it has no steady motion; give it damping or change the cycle"
            )
        start = np.linalg.solve(matrix, np.array([forced[0] - low, forced[1]]))
        return low + float(start[0]), float(start[1])

    @kept_property
    def _motion(self) -> MassChain:
        return MassChain(Oscillator(self.nu, self.damping), self._forcings, self._initial)

    def _derivative(self, k: Array, nu: int) -> Array:
        return self._motion.derivative(np.mod(k, self.period), nu)
