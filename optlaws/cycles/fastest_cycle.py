"""The fastest cycle: the greatest speed under its limits, the active limit there, and the proof of optimality."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any, Self

from optlaws.cycles.answers import Answers
from optlaws.cycles.greatest_speed.fastest_search import FastestSearch
from optlaws.cycles.greatest_speed.timed_spans import TimedSpan
from optlaws.cycles.optimisation.objectives import check_rating
from optlaws.cycles.placed import retimed, segments_in_place
from optlaws.cycles.specification.limits import FORCE_UNITS, amount, word_of
from optlaws.cycles.specification.periods import best_possible_row
from optlaws.entries.declared import Declared, FrozenTable, ValueOf, declared, entry
from optlaws.entries.value_types import Choice, Listed, Number, ReadBy, Switch, Table, Text
from optlaws.errors import InputError
from optlaws.files.reading import renamed_entries
from optlaws.kept import former_name, kept_property
from optlaws.lazy import imported
from optlaws.motion.quantities import TURN, Kind
from optlaws.sentences import Amount, joined, quantity_name, sentence
from optlaws.shown.report import Report
from optlaws.shown.summary import Row, Summary
from optlaws.synthesis.proof.certificate import VIOLATION, Certificate
from optlaws.synthesis.status import Status
from optlaws.tolerances import FASTER

_MORE = 0.1  # of a limit, by which it is raised to see what that gives


@declared
class LeastDuration(Declared, title="a least time"):
    """The least time that a motion needs, and its time at the greatest speed.

    Examples
    --------
    >>> from optlaws import Cycle, Return, Rise
    >>> slide = Cycle([Rise("35 mm", "120 deg"), Return()], speed="60 rpm", limits={"velocity": "1 m/s"})
    >>> rise, back = slide.fastest().segments
    >>> rise.binding, back.binding, round(back.duration / back.least, 6), rise.limits
    (True, False, 2.0, ('velocity 1000 mm/s',))
    """

    writes_defaults = True

    name: str = entry(Text(), "The segment, or the segments that are one law.")
    least: float = entry(Number(above=0.0), "The least time in seconds.")
    duration: float = entry(Number(above=0.0), "Its time in the cycle in seconds.")
    limits: tuple[str, ...] = entry(
        Listed(Text()), "The limits that the fastest law takes to the full, each with its value."
    )
    binding: bool = entry(
        Switch(), "Whether the motion has no more than it needs, so that the speed is greatest by it."
    )

    @property
    def row(self) -> Row:
        """What it needs, beside what it has."""
        limits = ", ".join(self.limits)
        spare = f"{100.0 * (self.duration / self.least - 1.0):.3g} % to spare before {limits}"
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
        limit, faster = quantity_name(self.limit), 100.0 * (self.ratio - 1.0)
        return f"10 % more {limit}: {60.0 * self.speed / TURN:.6g} rpm, {faster:.3g} % faster"


def _cycle(value: Any) -> Any:
    """A cycle, or its plain data."""
    # which knows this module
    of = imported("optlaws.cycles.cycle").Cycle
    return value if isinstance(value, of) else of.from_dict(value)


@declared
class FastestCycle(Answers, Declared, title="a fastest cycle"):
    """The greatest speed of the master at which a cycle keeps its limits, as `Cycle.fastest` finds it, and its plan.

    A stored one is read without a search: the period is that of the cycle, whose laws keep the limits; `optlaws verify`
    proves by its `claims` that no period is less.

    Examples
    --------
    >>> from optlaws import Cycle, Dwell, Return, Rise
    >>> limits = {"velocity": "1 m/s", "acceleration": "20 m/s^2", "jerk": "2000 m/s^3"}
    >>> slide = Cycle([Rise("35 mm", "120 deg"), Dwell("60 deg"), Return()], speed="60 rpm", limits=limits)
    >>> fastest = slide.fastest()
    >>> fastest.status.value, round(fastest.rpm, 4), fastest.binding
    ('optimal', 208.9637, ('segment 1 (Rise): acceleration 20 m/s^2, jerk 2000 m/s^3',))
    >>> FastestCycle.from_json(fastest.to_json()) == fastest
    True
    """

    writes_defaults = True

    specification: Any = entry(
        ReadBy(_cycle, "a cycle", Declared.to_dict), "The cycle whose greatest speed was sought.", name="given"
    )
    cycle: Any = entry(
        ReadBy(_cycle, "a cycle", Declared.to_dict),
        "The cycle at that speed, its laws given: the fastest where a motion has no time left, else those that are "
        "best within the limits.",
    )
    segments: tuple[LeastDuration, ...] = entry(
        Listed(ValueOf(LeastDuration)), "The least time of every motion that a limit bounds."
    )
    status: Status = entry(
        ReadBy(lambda value: Status(Choice(*Status).read(value, "status")), "a status", str),
        "Optimal where no law of the search space keeps the limits in a period that is shorter by a millionth, proven "
        "by `proofs` or, of laws that are given, by their closed form; else local.",
    )
    period: float = entry(Number(above=0.0), "The least period in seconds.")
    binding: tuple[str, ...] = entry(
        Listed(Text()), "What has no time left, each with the limits that it takes to the full."
    )
    proofs: Mapping[str, Certificate] = entry(
        Table(ValueOf(Certificate), keep=FrozenTable),
        "By the name of a motion: no law keeps its limits in a millionth less time than the motion has.",
    )
    _raised: Mapping[str, Callable[[], float]] | None = field(default=None, compare=False, repr=False)
    best_possible: float | None = entry(
        Number(above=0.0),
        "The period in seconds that no laws of any degree beat, by the segments of greatest jerk, acceleration and "
        "velocity; None where it is not known, as within limits of a drive and of ends that accelerate.",
        default=None,
    )

    limit = former_name("limit", "best_possible")

    @classmethod
    def _from_earlier(cls, data: dict[str, Any]) -> dict[str, Any]:
        return renamed_entries(data)

    def _check(self) -> None:
        if self.cycle.limits != self.specification.limits:
            raise InputError(f"{self.named} keeps other limits than its cycle")
        if self.period != self.cycle.duration:
            raise InputError(f"{self.named} has a period of {self.period!r} s, but its laws {self.cycle.duration!r} s")

    @classmethod
    def from_dict(cls, data: Any) -> Self:
        """The fastest cycle that `to_dict` wrote.

        Raises
        ------
        InputError
            If an entry is missing, unknown or wrong, or the laws have another period.
        InfeasibleProblem
            If a law breaks a limit.
        """
        read = super().from_dict(data)
        read.solve()
        return read

    def solve(self) -> Any:
        """The plan of the cycle at the greatest speed."""
        return self.cycle.solve()

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
        raised = self._raised or _raised(FastestSearch(self.specification.programme, self.specification.in_si, {}))
        periods = {name: period() for name, period in raised.items()}
        return tuple(LimitGain(name, TURN / period, self.period / period) for name, period in periods.items())

    def report(self) -> Report:
        """The speed and the period, the active limit, the gain from a limit raised by a tenth, and the motions' times.

        Examples
        --------
        >>> from optlaws import Cycle, Return, Rise
        >>> slide = Cycle([Rise("35 mm", "180 deg"), Return()], speed="60 rpm", limits={"acceleration": "20 m/s^2"})
        >>> [row.name for row in slide.fastest().summary()][:4]
        ['status', 'greatest speed', 'least period', 'lower bound (proven)']
        """
        from optlaws.cycles.report import FastestReport

        return FastestReport(self)

    def proof_rows(self) -> Summary:
        """The speed and the period, with what is proven of them, and what binds."""
        rows = [Row("greatest speed", self.rpm, "rpm"), Row("least period", self.period, "s")]
        if self.lower_bound is not None:
            rows.append(Row("lower bound (proven)", self.lower_bound, "s"))
        rows.append(best_possible_row(self.best_possible, self.period))
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
    limited = retimed(cycle, segments_in_place(search.programme, laws.starts, laws.pieces), search.period)
    segments = tuple(_least_duration(search, span) for span in search.spans)
    proven = search.status, search.period, _binding(search, segments), search.proofs
    return FastestCycle(cycle, limited, segments, *proven, _raised(search), search.best_possible)


def _raised(search: FastestSearch) -> dict[str, Callable[[], float]]:
    """The least period with a tenth more of each active limit, which is sought when it is called."""
    more = {name: replace(search, more={name: 1.0 + _MORE}) for name in search.binding_limits}
    return {name: partial(getattr, raised, "period") for name, raised in more.items()}


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
    rating = search.binding_rating
    if rating is not None:
        most = Amount(rating.most, FORCE_UNITS[search.programme.axis])
        return (sentence("the whole cycle: {} {}", quantity_name(rating.name), most),)
    return tuple(sentence("{}: {}", each.name, joined(", ", each.limits)) for each in segments if each.binding)
