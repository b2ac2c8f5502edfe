"""The fastest cycle: the greatest speed under its limits, the active limit there, and the proof of optimality."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

from optlaws.cycles.greatest_speed.fastest_search import FastestSearch
from optlaws.cycles.greatest_speed.timed_spans import TimedSpan
from optlaws.cycles.moves.fastest_move import limit_row
from optlaws.cycles.optimisation.objectives import check_rating
from optlaws.cycles.placed import retimed_segments, segments_in_place
from optlaws.cycles.specification.limits import FORCE_UNITS, amount, word_of
from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.motion.exportable import Exportable
from optlaws.motion.motion import Motion
from optlaws.motion.quantities import TURN, Exact, Kind
from optlaws.numbers import Quantity
from optlaws.sentences import Amount, joined, sentence
from optlaws.shown.report import Report
from optlaws.shown.summary import Row, Summary
from optlaws.synthesis.proof.certificate import VIOLATION, Certificate
from optlaws.synthesis.status import Status
from optlaws.tolerances import FASTER

_MORE = 0.1  # of a limit, by which it is raised to see what that gives


@dataclass(frozen=True)
class LeastDuration:
    """The least time that a motion needs, and its time at the greatest speed.

    Attributes
    ----------
    name
        The segment, or the segments that are one law.
    least, duration
        The least time and its time in the cycle, in seconds.
    limits
        The limits that the fastest law takes to the full, each with its value.
    binding
        Whether the motion has no more than it needs, so that the speed is greatest by it.

    Examples
    --------
    >>> from optlaws import Cycle, Return, Rise
    >>> slide = Cycle([Rise("35 mm", "120 deg"), Return()], speed="60 rpm", limits={"velocity": "1 m/s"})
    >>> rise, back = slide.fastest().segments
    >>> rise.binding, back.binding, round(back.duration / back.least, 6), rise.limits
    (True, False, 2.0, ('velocity 1000 mm/s',))
    """

    name: str
    least: float
    duration: float
    limits: tuple[str, ...]
    binding: bool

    @property
    def row(self) -> Row:
        """What it needs, beside what it has."""
        limits = ", ".join(self.limits)
        spare = f"{100.0 * (self.duration / self.least - 1.0):.3g} % to spare, then {limits}"
        margin = f"no time left, by {limits}" if self.binding else spare
        return Row(f"{self.name} needs", self.least, "s", note=f"has {self.duration:.9g} s: {margin}")


@dataclass(frozen=True)
class LimitGain:
    """The gain in speed from a tenth more of a limit.

    Attributes
    ----------
    limit
        The key of the limit.
    speed
        The greatest speed of the master with it, in rad/s.
    ratio
        How many times it is greater than without.

    Examples
    --------
    >>> print(LimitGain("acceleration", 20.0, 1.05))
    10 % more acceleration: 190.986 rpm, 5 % faster
    """

    limit: str
    speed: float
    ratio: float

    def __str__(self) -> str:
        return f"10 % more {self.limit}: {60.0 * self.speed / TURN:.6g} rpm, {100.0 * (self.ratio - 1.0):.3g} % faster"


@dataclass(frozen=True, repr=False)
class FastestCycle(Exportable):
    """The greatest speed of the master at which a cycle keeps its limits, as `Cycle.fastest` finds it, and its motion.

    Attributes
    ----------
    specification
        The cycle whose greatest speed was sought.
    cycle
        The cycle at that speed, its laws given: the fastest where a motion has no time left, else those that are best
        within the limits.
    segments
        The least time of every motion that a limit bounds.
    period
        The least period in seconds.
    binding
        What has no time left, each with the limits that it takes to the full.
    status
        Optimal where no law of the search space keeps the limits in a period that is shorter by a millionth, proven by
        `proofs` or, of laws that are given, by their closed form; else local.
    proofs
        By the name of a motion: no law keeps its limits in a millionth less time than the motion has.
    limit
        The period in seconds that no laws of any degree beat, by the segments of greatest jerk, acceleration and
        velocity; None where it is not known, as within limits of a drive and of ends that accelerate.

    Examples
    --------
    >>> from optlaws import Cycle, Dwell, Return, Rise
    >>> limits = {"velocity": "1 m/s", "acceleration": "20 m/s^2", "jerk": "2000 m/s^3"}
    >>> slide = Cycle([Rise("35 mm", "120 deg"), Dwell("60 deg"), Return()], speed="60 rpm", limits=limits)
    >>> fastest = slide.fastest()
    >>> fastest.status.value, round(fastest.rpm, 4), fastest.binding
    ('optimal', 208.9637, ('segment 1 (Rise): acceleration 20 m/s^2, jerk 2000 m/s^3',))
    """

    specification: Any  # a Cycle, which knows this module
    cycle: Any
    segments: tuple[LeastDuration, ...]
    status: Status
    period: float
    binding: tuple[str, ...]
    proofs: Mapping[str, Certificate] = field(compare=False)
    _raised: Mapping[str, Callable[[], float]] = field(compare=False)
    limit: float | None = None

    @property
    def speed(self) -> float:
        """The greatest speed of the master in rad/s."""
        return TURN / self.period

    @property
    def rpm(self) -> float:
        """The greatest speed of the master in revolutions per minute."""
        return 60.0 / self.period

    @property
    def lower_bound(self) -> float | None:
        """The period in seconds in which no laws of the search space keep the limits; None where that is not proven."""
        return self.period * (1.0 - FASTER) if self.status == Status.OPTIMAL else None

    @kept_property
    def gains(self) -> tuple[LimitGain, ...]:
        """The gain in speed from a tenth more of each active limit, in all segments that have it; solved again."""
        periods = {name: period() for name, period in self._raised.items()}
        return tuple(LimitGain(name, TURN / period, self.period / period) for name, period in periods.items())

    def motion(self, master: Quantity | None = "360 deg", unit: str | None = None) -> Motion:
        """The exact motion at the greatest speed, as `Cycle.motion`."""
        return self.cycle.motion(master, unit)  # type: ignore[no-any-return]

    def plot(self, ax: Any = None, **style: Any) -> list[Any]:
        """Draw the motion at the greatest speed, as `Cycle.plot`; return the artists."""
        return list(self.cycle.plot(ax, **style))

    def report(self) -> Report:
        """The speed and the period, the active limit, the gain from a limit raised by a tenth, and the motions' times.

        Examples
        --------
        >>> from optlaws import Cycle, Return, Rise
        >>> slide = Cycle([Rise("35 mm", "180 deg"), Return()], speed="60 rpm", limits={"acceleration": "20 m/s^2"})
        >>> [row.name for row in slide.fastest().summary()][:4]
        ['status', 'greatest speed', 'least period', 'proven: none below']
        """
        from optlaws.cycles.report import FastestReport

        return FastestReport(self)

    def proof_rows(self) -> Summary:
        """The speed and the period, with what is proven of them, and what binds."""
        rows = [Row("greatest speed", self.rpm, "rpm"), Row("least period", self.period, "s")]
        if self.lower_bound is not None:
            rows.append(Row("proven: none below", self.lower_bound, "s"))
        rows.append(limit_row(self.limit, self.period))
        return Summary([*rows, *(Row("binds", text) for text in self.binding)])

    def claims(self) -> dict[str, Any]:
        """The proofs as `optlaws verify` takes them: each problem with the certificate that it has no law.

        The problems are without dimensions: neither the speed nor the period is in them.
        """
        return {
            name: {"asked": proof.problem.to_dict(), "status": "infeasible", "proof": proof.to_dict()}
            if proof.program == VIOLATION
            else proof.to_dict()
            for name, proof in self.proofs.items()
        }

    def __repr__(self) -> str:
        return (
            f"FastestCycle({self.rpm:.6g} rpm, period={self.period:.6g} s, status={self.status.value!r}, "
            f"binding={self.binding!r})"
        )


def fastest_cycle(cycle: Any) -> FastestCycle:
    """The greatest speed of a cycle."""
    objective = cycle.in_si
    if objective.of_load:
        raise InputError(
            "the greatest speed is not computed with a load that is minimised or limited, whose vibration follows its "
            "own period: limit the cycle's own quantities, and look at load_motion of the cycle at that speed"
        )
    if objective.energy is not None:
        raise InputError(
            "the greatest speed is not computed with a limit of the energy of a cycle: limit the power or the force or "
            "torque, and look at effort.energy of the cycle at that speed"
        )
    check_rating(cycle.limits, objective.drive)
    search = FastestSearch(cycle.programme, objective, {})
    laws = search.laws()
    known = retimed_segments(segments_in_place(search.programme, laws.starts, laws.pieces), cycle.axis)
    limited = replace(cycle, segments=known, speed=None, period=Exact(search.period, "s"))
    segments = tuple(_least_duration(search, span) for span in search.spans)
    more = {name: replace(search, more={name: 1.0 + _MORE}) for name in search.binding_limits}
    raised = {name: partial(getattr, search, "period") for name, search in more.items()}
    proven = search.status, search.period, _binding(search, segments), search.proofs
    return FastestCycle(cycle, limited, segments, *proven, raised, search.limit)


def _least_duration(search: FastestSearch, span: TimedSpan) -> LeastDuration:
    axis = search.programme.axis
    limits = (
        "motor's curve"
        if row.key.kind is Kind.CURVE
        else sentence("{} {}", word_of(row.key, axis), amount(row.key, row.most, axis))
        for row in span.binding
    )
    return LeastDuration(
        span.where, span.needed, search.time_of(span), tuple(dict.fromkeys(limits)), binding=span in search.binding
    )


def _binding(search: FastestSearch, segments: Sequence[LeastDuration]) -> tuple[str, ...]:
    rating = search.rating
    if rating is not None and rating.binds:
        most = Amount(rating.most, FORCE_UNITS[search.programme.axis])
        return (sentence("the whole cycle: {} {}", rating.name, most),)
    return tuple(sentence("{}: {}", each.name, joined(", ", each.limits)) for each in segments if each.binding)
