"""The interface of every motion of a follower's mass: that of a law, over an interval of its own."""

from __future__ import annotations

from abc import abstractmethod
from typing import Any

from optlaws.laws.curve import Curve, Sides
from optlaws.mechanisms.follower.chain import MassChain
from optlaws.numbers import Array, real_times


class MassMotion(Curve):
    """Displacement a_m of the mass with its derivatives, dimensionless like a law; k in durations of the rise.

    Examples
    --------
    >>> from optlaws.laws import smoothstep
    >>> from optlaws.mechanisms import Follower
    >>> motion = Follower(nu=20, damping=0.05).cycle(smoothstep(4), dwell=0.5, rest=1.0)
    >>> isinstance(motion, MassMotion), motion.interval
    (True, (0.0, 3.5))
    """

    @property
    @abstractmethod
    def _motion(self) -> MassChain:
        """The motion over the interval."""

    @property
    def _breaks(self) -> tuple[float, ...]:
        return self._motion.breaks

    def _before_breaks(self, nu: int) -> Array:
        return self._motion.before_breaks(nu)

    def _repr_html_(self) -> str:
        from optlaws.laws.html import drawings
        from optlaws.shown.showing import page

        return page(repr(self), drawings(self))

    def _times(self, k: Any) -> Array:  # noqa: ANN401 - whatever users give
        return real_times(k)

    def _sides(self, nu: int) -> Sides:
        return self._motion.candidates(nu)

    def _power_sides(self) -> Sides:
        return self._motion.power_candidates()

    def _mean_square(self, nu: int) -> float:
        return self._motion.mean_square(nu)
