"""A limit of the residual vibration after a move, in a follower that vibrates more often in longer times."""

from __future__ import annotations

from math import inf, nextafter, sqrt

from optlaws.entries.declared import Declared, declared, entry
from optlaws.entries.value_types import Choice, Number
from optlaws.errors import InputError
from optlaws.synthesis.least_time.move_limits import SpanLimit, TimedLimit
from optlaws.synthesis.problem.named_constants import named
from optlaws.tolerances import LIMIT_ROUNDING

#: the names of the limits
RESIDUAL = "residual acceleration"
RESIDUAL_DISPLACEMENT = "residual displacement"
RESIDUALS = (RESIDUAL, RESIDUAL_DISPLACEMENT)


_POSITIVE = Number(above=0.0)


@declared
class FollowerResidual(Declared, title="the residual vibration of a move"):
    """The residual acceleration or displacement of an elastic follower after a move, with its limit.

    >>> FollowerResidual(95.0, 105.0, 0.05, most=0.4).limit_in(0.2, stroke=0.1)
    TimedLimit(name='residual acceleration', constant=residual(frequency=(19.0, 21.0), damping=0.05), bound=0.16)
    >>> FollowerResidual(95.0, 105.0, 0.05, 4e-5, of="displacement").limit_in(0.2, stroke=0.1).bound
    0.0004
    """

    newer = ("of",)

    lowest: float = entry(_POSITIVE, "Its least natural circular frequency, rad/s.")
    highest: float = entry(_POSITIVE, "The greatest.")
    damping: float = entry(Number(least=0.0), "Its damping ratio, below 1.")
    most: float = entry(
        _POSITIVE,
        "The greatest amplitude after the move: of its acceleration, in units of the stroke a square second, or of its "
        "displacement, in those of the stroke.",
    )
    of: str = entry(Choice("acceleration", "displacement"), "What of the vibration is limited.", default="acceleration")

    def _check(self) -> None:
        if self.lowest > self.highest or self.damping >= 1.0:
            raise InputError("the frequencies of a follower must be in order, and its damping below 1")

    @property
    def name(self) -> str:
        """The name of the limit."""
        return f"residual {self.of}"

    def along(self, stroke: float) -> SpanLimit:
        """The limit of a law with the stroke 1 over the time."""
        return SpanLimit(self.name, self.most, lambda duration: self.limit_in(duration, stroke)[1:])

    def limit_in(self, duration: float, stroke: float) -> TimedLimit:
        """The limit of a law with the stroke 1 in a time."""
        low, high = (frequency * duration for frequency in (self.lowest, self.highest))
        unit = 1.0 if self.of == "displacement" else duration * duration
        return self._limit(low, high, self.most * unit / stroke)

    def limit_over(
        self, shortest: float, longest: float, stroke: float, velocity: float, acceleration: float
    ) -> TimedLimit:
        """A limit of every law that keeps the residual's in some time from the shortest to the longest.

        The frequencies nu = omega T that all these times have in common are limited by what is allowed in the longest.
        Where there are none, the middle between them is: there the amplitude is greater by its slope times the
        distance at most, which is bounded by the integrals of |k - 1/2| |b| and |k - 1/2| |c| in any such law:
        `velocity` and `acceleration`. The limit is infinite where these are.

        >>> FollowerResidual(95.0, 105.0, 0.05, most=0.4).limit_over(0.199, 0.2, 0.1, 0.5, 2.0).constant
        residual(frequency=(19.000000000000004, 20.894999999999996), damping=0.05)
        >>> certain = FollowerResidual(100.0, 100.0, 0.0, most=0.4)
        >>> round(certain.limit_over(0.1998, 0.2, 0.1, 0.5, 2.0).bound, 6)
        0.55972
        """
        low, high = nextafter(self.lowest * longest, inf), nextafter(self.highest * shortest, 0.0)
        wider = 1.0 + LIMIT_ROUNDING
        displaced = self.of == "displacement"
        most = self.most / stroke * wider if displaced else self.most * longest / stroke * wider
        if low <= high:
            return self._limit(low, high, most if displaced else most * longest)
        # |P| = nu/s |integral of exp(nu u (1 - k)) c|: half of the wave is taken out, so that its slope has |k - 1/2|
        nu, apart = 0.5 * (low + high), 0.5 * (low - high) * wider
        damped, share = sqrt((1.0 - self.damping) * (1.0 + self.damping)), 1.0 - 0.5 * self.damping * apart
        if share <= 0.0:
            return self._limit(nu, nu, inf)
        # of the place nearest to the middle at which a limit is kept: its |P| / nu and |P| / nu^2
        slope = most * low if displaced else most / self.lowest
        amplitude = most if displaced else self.most / stroke / self.lowest**2
        by_acceleration = nu * (slope + apart * acceleration / damped)
        by_velocity = nu * nu * (amplitude + apart * velocity / damped)
        unit = nu * nu if displaced else 1.0
        return self._limit(nu, nu, min(by_acceleration, by_velocity) / unit / share * wider)

    def _limit(self, low: float, high: float, bound: float) -> TimedLimit:
        spread = repr(low) if low == high else f"({low!r}, {high!r})"
        of = ", of=displacement" if self.of == "displacement" else ""
        return TimedLimit(self.name, named(f"residual(frequency={spread}, damping={self.damping!r}{of})"), bound)
