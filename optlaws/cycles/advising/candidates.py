"""The compared laws: catalogue laws, optimal laws, and the front between two measures."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from math import inf

from optlaws.cycles.advising.advised_cycle import AdvisedCycle
from optlaws.cycles.advising.advised_law import AdvisedLaw
from optlaws.errors import OptlawsError
from optlaws.synthesis.least_time.follower_residual import RESIDUAL
from optlaws.tolerances import BOUND_SLACK, EQUALLY_GOOD, SHOWN_DIGITS

_FRONT_END = 0.01  # of what is exchanged: a front goes no further, as some of it can vanish

#: what all laws can be bounded by from the start, as it is convex and quick; and what else is not to grow
_OF_MOTION = ("velocity", "acceleration", "jerk", RESIDUAL)
_OF_DRIVE = ("force", "torque", "rms force", "rms torque")
_ROUNDS = 3


@dataclass
class Candidates:
    """The laws of a motion in the order of their computation, and the reasons for missing ones.

    Attributes
    ----------
    motion
        Whose laws they are.
    laws
        By their names, in the order in which they were computed.
    errors
        Why there is no law of a name.
    usual
        The standard law that others are compared with; None where none fits.
    guarding
        Whether nothing is to grow beyond the usual law: not where that breaks limits, and others would take more.
    proven
        The law whose proof says how good any could be.
    """

    motion: AdvisedCycle
    laws: dict[str, AdvisedLaw] = field(default_factory=dict)
    errors: dict[str, OptlawsError] = field(default_factory=dict)
    usual: AdvisedLaw | None = None
    guarding: bool = True
    proven: AdvisedLaw | None = None

    @property
    def minimise(self) -> str:
        """The measure that is to be least."""
        return self.motion.minimise

    @property
    def second(self) -> str:
        """The measure that decides between laws that are equally good: the residual, the jerk, or the acceleration."""
        names = [measure.name for measure in self.motion.measures]
        return next(name for name in (RESIDUAL, "jerk", "acceleration") if name in names and name != self.minimise)

    def most(self, *but: str) -> dict[str, float]:
        """The usual law's values of most measures without a limit, which no other law should exceed."""
        if self.usual is None or not self.guarding:
            return {}
        left = {self.minimise, *self.motion.limited, *but}
        return {
            name: value
            for name, value in self.usual.values.items()
            if name not in left and 0.0 < value < inf and name in (*_OF_MOTION, *_OF_DRIVE)
        }

    def add_standard(self, names: Sequence[str]) -> None:
        """Add the motion's own laws and the laws of the catalogue.

        The usual one is the first of them, or where it breaks a limit and others do not the least of these.
        """
        given = self.motion.given()
        for name in names:
            self._add(name, partial(self.motion.standard, name))
        if given is not None and self.motion.usual not in self.laws:
            self.laws = {given.name: given, **self.laws}
        fit = [law for law in self.laws.values() if law.keeps_limits]
        first = next(iter(self.laws.values()), None)
        self.usual = first if first in fit else min(fit, key=self._objective, default=first)

    def add_optimal(self) -> None:
        """Add the laws that are least in the objective and the second measure; the first of them must exist.

        Raises
        ------
        InfeasibleProblem, SolverFailure
            If no law satisfies every limit, or the search fails.
        """
        minimise, second, motion = self.minimise, self.second, self.motion
        name = f"least {minimise}"
        best = self.laws[name] = motion.least(name, minimise, {})
        beside = "" if self.usual is None else f", no worse than {self.usual.name}"
        most = self.most()
        if most and self.usual is not None:
            name = f"least {minimise}{beside}"
            calm = self._add(name, partial(self._within, name, minimise, most))
            best = calm or best
            # a law that breaks limits guards nothing where that would cost more than it takes itself
            bettered = calm is not None and self._objective(calm) <= self._objective(self.usual)
            self.guarding = bettered or self.usual.keeps_limits
        self.proven = best if self.guarding else self.laws[f"least {minimise}"]
        name = f"nearly least {minimise}, least {second}"
        self._add(name, partial(motion.near, name, self.proven, second, EQUALLY_GOOD))
        for other in motion.objectives:
            if other not in {minimise, RESIDUAL}:
                name = f"least {other}"
                self._add(name, partial(motion.least, name, other, {}))
                self._drop_equal(name)
        if RESIDUAL in motion.objectives and minimise != RESIDUAL:
            most = self.most(RESIDUAL, *_OF_DRIVE)
            name = f"least {RESIDUAL}{beside if most else f' at twice the least {minimise}'}"
            if minimise in _OF_MOTION:
                fits = self.usual is not None and self.usual.keeps_limits and bool(most)
                most[minimise] = self.usual.values[minimise] if self.usual and fits else self._twice
            self._add(name, partial(motion.least, name, RESIDUAL, most))

    def front(self, points: int) -> tuple[AdvisedLaw, ...]:
        """Laws that exchange the minimised measure for the second one, from the least value of each.

        None takes more of the others than the usual law, nor more than twice the least of what is minimised.
        """
        minimise, second = self.minimise, self.second
        most = self.most(second, *_OF_DRIVE)
        try:
            beside = {**most, minimise: self._twice} if minimise in _OF_MOTION else most
            ends = [
                self.motion.least(f"least {name}", name, limits)
                for name, limits in ((minimise, most), (second, beside))
            ]
        except OptlawsError as error:
            self.errors["front"] = error
            return ()
        high, low = (end.values[second] for end in ends)
        low = max(low * (1.0 + BOUND_SLACK), _FRONT_END * high)
        points_of_front = [ends[0]]
        for i in range(1, points if low < high else 0):
            value = high * (low / high) ** (i / (points - 1))
            name = f"least {minimise} at a {second} of {value:.4g}"
            try:
                points_of_front.append(self.motion.least(name, minimise, {**most, second: value}))
            except OptlawsError as error:
                self.errors[name] = error
        return tuple(points_of_front)

    @property
    def _twice(self) -> float:
        """Twice the least objective, as the greatest acceptable price."""
        best = self.proven or self.laws[f"least {self.minimise}"]
        return 2.0 * best.values[self.minimise]

    def _objective(self, law: AdvisedLaw) -> float:
        return law.values[self.minimise]

    def _within(self, name: str, minimise: str, most: Mapping[str, float]) -> AdvisedLaw:
        """The law that is least in a measure without exceeding others; drive measures are bounded only if necessary."""
        bounds = {other: value for other, value in most.items() if other in _OF_MOTION}
        for _ in range(_ROUNDS):
            law = self.motion.least(name, minimise, bounds)
            beyond = exceeded(law, most)
            if not beyond:
                break
            bounds |= {other: most[other] for other in beyond}
        return law

    def _drop_equal(self, name: str) -> None:
        """Remove a law that equals another law in all measures."""
        law = self.laws.get(name)
        others = [other for other in self.laws.values() if other is not law]
        if law is not None and any(_is_equal(law, other) for other in others):
            del self.laws[name]

    def _add(self, name: str, make: Callable[[], AdvisedLaw]) -> AdvisedLaw | None:
        """Add a law under its name, or the error with the reason for its absence."""
        try:
            self.laws[name] = make()
        except OptlawsError as error:
            self.errors[name] = error
            return None
        return self.laws[name]


def _is_equal(law: AdvisedLaw, other: AdvisedLaw) -> bool:
    """Whether two laws take the same of everything, as far as a table shows it."""
    return all(abs(value - other.values[name]) <= SHOWN_DIGITS * abs(value) for name, value in law.values.items())


def exceeded(law: AdvisedLaw, most: Mapping[str, float]) -> list[str]:
    """The measures in which a law exceeds given values by more than rounding."""
    return [name for name, value in most.items() if not law.values[name] <= value * (1.0 + BOUND_SLACK)]
