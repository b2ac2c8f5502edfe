"""Several axes of a machine on one clock: a cycle for each axis, with common tables, plots, files and exports."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import KW_ONLY, replace
from typing import TYPE_CHECKING, Any, Literal, TypeAlias
from warnings import warn

from optlaws.cycles.axes.interlock import INTERLOCKS, Interlock
from optlaws.cycles.axes.machine_answers import AxesAnswers
from optlaws.cycles.axes.report import AxesReport, OverlapReport
from optlaws.cycles.cycle import Cycle, Plan
from optlaws.cycles.placed import with_laws
from optlaws.cycles.specification.periods import best_possible_row
from optlaws.cycles.specification.programme import is_optimal, period_of
from optlaws.cycles.specification.segments import SEGMENTS, CycleSegment, Dwell
from optlaws.cycles.usual_law import segments_with
from optlaws.echo import shortened
from optlaws.entries.declared import Declared, declared, entry, same
from optlaws.entries.value_types import Choice, Listed, Number, ReadBy, Text
from optlaws.errors import InfeasibleProblem, InputError, SolverFailure, located
from optlaws.files.reading import check_names
from optlaws.kept import kept_property
from optlaws.laws.catalogue.catalogue import USUAL
from optlaws.motion.quantities import Exact
from optlaws.numbers import NumberOrQuantity, Quantity
from optlaws.shown.report import Report
from optlaws.shown.summary import Row, Summary
from optlaws.synthesis.status import Status
from optlaws.tolerances import CLOSURE, CYCLE_OPTIMALITY

if TYPE_CHECKING:
    from optlaws.cycles.axes.overlapping import Overlapping

Goal: TypeAlias = Literal["period", "acceleration"]

FORMAT = "optlaws axes 1"


def _named(given: Any) -> dict[str, Any]:
    if not isinstance(given, Mapping) or not given:
        raise InputError("they are a table of segments by name, such as {'table': [Rise('45 deg', '0.4 s'), Dwell()]}")
    unnamed = [name for name in given if not isinstance(name, str) or not name]
    if unnamed:
        raise InputError(f"an axis has a name, such as 'table', got {shortened(unnamed[0])}")
    return dict(given)


@declared
class Axes(AxesAnswers, Declared, title="stored axes"):
    """Axes that turn with one master: cycles by their names, all of the same duration.

    Raises
    ------
    InputError
        If an axis is wrong, or its cycle has another duration; the error names the axis. If an interlock names an axis
        that is not there or a position that it does not pass.

    Examples
    --------
    >>> from optlaws import Dwell, Return, Rise
    >>> table = {"segments": [Rise("45 deg", "400 ms"), Dwell()], "advance": "45 deg"}
    >>> head = [Dwell("400 ms"), Rise("250 mm", "200 ms"), Dwell("1200 ms"), Return()]
    >>> machine = Axes({"table": table, "weld head": head}, period="2 s")
    >>> machine
    Axes({'table': Cycle([Rise, Dwell]), 'weld head': Cycle([Dwell, Rise, Dwell, Return])}, period=2 s)
    >>> machine.status.value, machine["table"].objective, machine.at_angle(90)["weld head"]
    ('optimal', 21.313898, 0.125000)
    """

    __eq__, __hash__ = Mapping.__eq__, Mapping.__hash__

    axes: Mapping[str, Sequence[CycleSegment] | Mapping[str, Any] | Cycle | Plan] = entry(
        ReadBy(
            _named,
            "a table by the names of the axes",
            lambda cycles: {name: cycle.specification.to_dict() for name, cycle in cycles.items()},
            {"type": "object", "minProperties": 1},
        ),
        'What each axis does: a list of segments, a table of what `Cycle` takes (`{"segments": [...], "limits": '
        "{...}}`), or a `Cycle` of the same duration or the `Plan` of one; where all are such neither speed nor period "
        "is needed. Lists and tables without either begin in the diagram from which `fastest` seeks the least period: "
        "moves in their least times within their limits, dwells with what is left.",
    )
    _: KW_ONLY
    speed: NumberOrQuantity | None = same(Cycle, "speed", default=None)
    period: NumberOrQuantity | None = same(Cycle, "period", default=None)
    interlocks: Sequence[Interlock | Mapping[str, Any]] = entry(
        INTERLOCKS,
        "Conditions between two axes: `After`, `Clearance`, `Forbidden`, `Synchronous`, or the plain data of such. "
        "`clearances` states which are clear and where they are nearest.",
        default=(),
    )

    def _check(self) -> None:
        cycles = self.cycles  # errors of an axis are raised at once
        for interlock in self.rules:
            interlock.check(cycles)

    def solve(self) -> Axes:
        """The axes themselves, which are solved."""
        return self

    @property
    def status(self) -> Status:
        """The worst status of the axes."""
        return Status.worst(cycle.status for cycle in self.values())

    def at(self, speed: NumberOrQuantity) -> Axes:
        """The same motions at another speed of the master, like `Cycle.at`."""
        return Axes({name: cycle.at(speed) for name, cycle in self.items()}, interlocks=self.interlocks)

    def fastest(self) -> Overlap:
        """The least period that the interlocks allow: moves overlap as far as they can, each in its least time.

        Laws that are given keep their shapes; a move without one takes its own fastest law, as of `Cycle.fastest`, from
        rest to rest. A move with limits takes the least time under these; another one keeps its time, or its angle of
        the master. Dwells last at least as long as they were given, or their `least`. The order of the segments of each
        axis stays, and all axes rest when the cycle begins.

        Raises
        ------
        InputError
            If a segment is no move from rest to rest and no dwell, or a limit is of the whole cycle, as an RMS torque.
        InfeasibleProblem
            If no instants of these laws keep all interlocks; the error names those that contradict each other.

        Examples
        --------
        >>> from optlaws import Clearance, Dwell, Return, Rise
        >>> law = {"law": "cycloidal"}
        >>> move = [
        ...     Rise("0.1 m", "0.2 s", **law),
        ...     Dwell("0.4 s", least="0 s"),
        ...     Return("0.1 m", "0.2 s", **law),
        ...     Dwell(),
        ... ]
        >>> slide = {"segments": move, "limits": {"acceleration": "20 m/s^2"}}
        >>> waits, acts = Dwell("0.2 s", least="0 s"), Dwell("0.1 s")
        >>> tool = [waits, Rise("50 mm", "0.1 s", **law), acts, Return("50 mm", "0.1 s", **law), Dwell()]
        >>> rule = Clearance("tool", over="slide", most=[("90 mm", "5 mm"), ("95 mm", "50 mm")])
        >>> best = Axes({"slide": slide, "tool": tool}, period="1 s", interlocks=[rule]).fastest()
        >>> best.status.value, round(best.objective, 6), best.axes.clearances[0].status
        ('optimal', 0.51093, 'clear')

        No period is needed:

        >>> round(Axes({"slide": slide, "tool": tool}, interlocks=[rule]).fastest().objective, 6)
        0.51093
        """
        return _overlapped(self, "period", tuple(self))

    def least_acceleration(self, *of: str) -> Overlap:
        """The least greatest acceleration in the same period: moves grow into the time that the interlocks leave.

        Laws that are given keep their shapes; a move without one takes the law of least acceleration within its limits
        in its time, from rest to rest.

        Parameters
        ----------
        of
            The axes whose moves may take longer, all unless given; moves of the others keep their times. Of several the
            greatest share of what each has now is least.

        Raises
        ------
        InputError
            If an axis is unknown, or a segment is no move from rest to rest and no dwell.
        InfeasibleProblem
            If no instants of these laws keep all interlocks; the error names those that contradict each other.

        Examples
        --------
        >>> from optlaws import After, Dwell, Return, Rise
        >>> law, on = {"law": "cycloidal"}, Dwell("0.1 s")
        >>> index = [Dwell("0.25 s"), Rise("15 deg", "0.5 s", **law), Dwell()]
        >>> die = [on, Rise("50 mm", "0.15 s", **law), Dwell(), Return("50 mm", "0.15 s", **law), on]
        >>> rules = [
        ...     After("table", "0.1 deg", of="die", above="31 mm"),
        ...     After("die", "31 mm", of="table", above="14.9 deg", way="down"),
        ... ]
        >>> axes = {"table": {"segments": index, "advance": "15 deg"}, "die": die}
        >>> best = Axes(axes, period="1 s", interlocks=rules).least_acceleration("die")
        >>> best.status.value, round(best.objective, 6)
        ('optimal', 0.175878)
        """
        check_names(of, tuple(self), "axis")
        return _overlapped(self, "acceleration", of or tuple(self))

    def gentlest(self, *of: str) -> Overlap:
        """The result of `least_acceleration`, by its former name."""
        warn("Axes.gentlest is called Axes.least_acceleration now", DeprecationWarning, stacklevel=2)
        return self.least_acceleration(*of)

    @kept_property
    def instants(self) -> Overlapping:
        """The program of the instants of the fastest laws."""
        from optlaws.cycles.axes.overlapping import program

        return program(self, self.rules, "period", (), {})

    def to_dict(self) -> dict[str, Any]:
        """The cycles of the axes and their interlocks, plain and JSON-able."""
        return {"format": FORMAT, **super(Axes, replace(self, axes=dict(self), speed=None, period=None)).to_dict()}

    @classmethod
    def _from_earlier(cls, data: dict[str, Any]) -> dict[str, Any]:
        stored = data.get("axes")
        if not isinstance(stored, Mapping) or data.pop("format", FORMAT) != FORMAT:
            raise InputError(f"stored axes have format {FORMAT!r} and a table of axes, got {shortened(data)}")
        return {**data, "axes": {str(name): Cycle.from_dict(cycle) for name, cycle in stored.items()}}

    def __repr__(self) -> str:
        shown = {name: ", ".join(segment.label for segment in cycle.segments) for name, cycle in self.items()}
        listed = ", ".join(f"{name!r}: Cycle([{labels}])" for name, labels in shown.items())
        return f"Axes({{{listed}}}, period={self.duration:.6g} s)"

    @property
    def rules(self) -> tuple[Interlock, ...]:
        """The interlocks of the axes as values."""
        return self.interlocks  # type: ignore[return-value] # values since the axes were checked

    @kept_property
    def drawn(self) -> AxesReport:
        """The report, whose parts are computed once."""
        return AxesReport(self.cycles, self.rules)

    @property
    def has_clock(self) -> bool:
        """Whether a speed, a period or a cycle says how long a turn takes."""
        cycles = any(isinstance(given, Cycle | Plan) for given in self.axes.values())
        return cycles or self.speed is not None or self.period is not None

    @kept_property
    def _begun(self) -> dict[str, Cycle]:
        """The cycles in the diagram from which a least period is sought, where no period is given."""
        from optlaws.cycles.axes.first_diagram import first_diagram

        entries, moves = dict[str, dict[str, Any]](), dict[str, Sequence[CycleSegment]]()
        for name, given in self.axes.items():
            with located(f"axis {name}"):
                entries[name] = _entries(given)
                moves[name] = SEGMENTS.read(entries[name]["segments"], "segments")

        def cycle_of(name: str, segments: Sequence[CycleSegment], period: Quantity) -> Cycle:
            return Cycle(**{**entries[name], "segments": segments}, period=period)

        timed, seconds = first_diagram(moves, cycle_of, None)
        return {name: cycle_of(name, segments, Exact(seconds, "s")) for name, segments in timed.items()}

    @kept_property
    def cycles(self) -> dict[str, Cycle]:
        """Its cycles, or plans, which have what is looked at of a cycle."""
        if not self.has_clock:
            return self._begun
        clock: dict[str, Any] = {"speed": self.speed, "period": self.period}
        cycles = dict[str, Any]()
        if not any(clock.values()) and all(isinstance(given, Cycle | Plan) for given in self.axes.values()):
            clock = {}
        duration = period_of(**clock) if clock else 0.0
        for name, given in self.axes.items():
            with located(f"axis {name}"):
                cycle = given if isinstance(given, Cycle | Plan) else Cycle(**_entries(given), **clock)
                duration = duration or cycle.duration
                if abs(cycle.duration - duration) > CLOSURE * duration:
                    raise InputError(
                        f"its cycle takes {cycle.duration:.9g} s, the machine's {duration:.9g} s: give both the same "
                        "speed or period, or take cycle.at(speed)"
                    )
                cycles[name] = cycle
        return cycles


def _axes(value: Any) -> Axes:
    return value if isinstance(value, Axes) else Axes.from_dict(value)


def _stored(axes: Axes) -> dict[str, Any]:
    """The axes as plain data, without names of formats of specifications."""
    plain = axes.to_dict()
    cycles = {name: {key: value for key, value in cycle.items() if key != "format"} for name, cycle in
              plain["axes"].items()}  # fmt: skip
    return {"axes": cycles, **({"interlocks": plain["interlocks"]} if axes.rules else {})}


@declared
class Overlap(AxesAnswers, Declared, title="axes that overlap"):
    """The plan of axes with the best overlap of the search, and the bound that no other overlap passes.

    It has the attributes of its `axes`, and is stored with the machine that was given.

    Examples
    --------
    >>> from optlaws import Dwell, Return, Rise
    >>> moves = [Rise("0.1 m", "0.2 s", law="cycloidal"), Dwell("0.4 s", least="0 s"), Return("0.1 m", "0.2 s")]
    >>> best = Axes({"slide": [*moves, Dwell()]}, period="1 s").fastest()
    >>> Overlap.from_json(best.to_json()).objective == best.objective, round(best.objective, 6)
    (True, 0.4)
    >>> round(best["slide"].peak(1), 6), [*best.report().facts][1].name
    (1.0, 'least period')
    """

    writes_defaults = True
    __eq__, __hash__ = object.__eq__, object.__hash__

    _: KW_ONLY
    goal: Goal = entry(Choice("period", "acceleration"), "What is least.")
    objective: float = entry(
        Number(above=0.0), "The period in seconds, or the greatest acceleration as a share of what it was."
    )
    lower_bound: float = entry(
        Number(above=0.0),
        "By linear programs in doubles: no instants and durations of the laws that the moves of `axes` have give less, "
        "in the order of the segments, with all axes at rest when the cycle begins and each move of an axis around one "
        "rest of the other axis. Other laws may have less.",
    )
    of: tuple[str, ...] = entry(Listed(Text()), "The axes whose moves may take other times.")
    binding: tuple[str, ...] = entry(
        Listed(Text()),
        "What binds where the objective is least: limits of moves, dwells and interlocks, by their names.",
    )
    axes: Axes = entry(
        ReadBy(_axes, "axes", _stored), "The machine with its new durations; given laws and strokes are those it had."
    )
    given: Axes = entry(ReadBy(_axes, "axes", _stored), "The machine as it was.")

    def _check(self) -> None:
        check_names(self.of, tuple(self.given), "axis")

    def solve(self) -> Axes:
        """The axes with their new durations."""
        return self.axes

    @property
    def status(self) -> Status:
        """Optimal where all interlocks are proven clear and the bound is reached, local where there is a `gap`.

        Inaccurate where an interlock is not proven clear.
        """
        if self.broken:
            return Status.INACCURATE
        near = self.objective <= self.lower_bound * (1.0 + CYCLE_OPTIMALITY)
        return Status.OPTIMAL if near else Status.LOCAL

    @property
    def gap(self) -> float:
        """The share of the objective by which another one could be better at most."""
        return max(1.0 - self.lower_bound / self.objective, 0.0)

    @property
    def gain(self) -> float | None:
        """The objective before over the objective after: the gain in speed, or the reduction of the acceleration.

        None of a period where none was given.
        """
        if self.goal != "period":
            return 1.0 / self.objective
        return self.given.duration / self.objective if self.given.has_clock else None

    @property
    def dwells(self) -> tuple[str, ...]:
        """The dwells among what is `binding`: they last as long as they were given, or their `least`."""
        from optlaws.cycles.axes.planned_axes import DWELL

        return tuple(name for name in self.binding if name.startswith(DWELL))

    @kept_property
    def without_dwells(self) -> float | None:
        """The least period in seconds if the binding `dwells` could take no time; None without such, or unknown.

        Examples
        --------
        >>> from optlaws import Dwell, Return, Rise
        >>> law = {"law": "cycloidal"}
        >>> moves = [Rise("0.1 m", "0.2 s", **law), Dwell("0.4 s"), Return("0.1 m", "0.2 s", **law)]
        >>> best = Axes({"slide": moves}, period="0.8 s").fastest()
        >>> best.dwells, round(best.objective, 6), round(best.without_dwells, 6)
        (('dwell segment 2 of slide',), 0.8, 0.4)
        """
        if self.goal != "period" or not self.dwells:
            return None
        return _least_period(lambda: self.given.instants.without_dwells(self.dwells))

    @kept_property
    def _usual_period(self) -> float | None:
        """The least period in seconds of the usual law in all moves that may have another; None where it has none."""
        return _least_period(lambda: _with_usual_law(self.given).instants)

    def summary(self) -> Summary:
        """Status, objective and bound, the gain, also over the usual law, and what binds."""
        what, unit, gain = "greatest acceleration, as a share of the given one", "", "reduction by the factor"
        if self.goal == "period":
            what, unit, gain = "least period", "s", "speed, as a multiple of that before the overlap"
        values = {what: (self.objective, unit), "lower bound": (self.lower_bound, unit)}
        if self.gain is not None:
            values[gain] = self.gain, ""
        laws = "for these laws, by linear programs in doubles"
        rows = [Row(name, *value, note=laws if name == "lower bound" else "") for name, value in values.items()]
        rows = [*rows, best_possible_row(None, self.objective)]
        if self.without_dwells is not None:
            may = 'of dwells that may be shorter give least = "0 s"'
            rows.append(Row("least period without these dwells", self.without_dwells, unit, note=may))
        usual = self._usual_period if self.goal == "period" else None
        if usual is not None and abs(saved := 1.0 - self.objective / usual) > CYCLE_OPTIMALITY:
            note = f"the least period is {100.0 * abs(saved):.1f} % {'less' if saved > 0.0 else 'more'}"
            rows.append(Row(f"least period with {USUAL}", usual, unit, note=note))
        as_given = "the dwells that bind stay as long as they are given" if self.dwells else ""
        rows = [Row("status", self.status.value, note=as_given), *rows]
        rules = {rule.label for rule in self.axes.solve().rules}
        return Summary([*rows, *(Row("bound by", name, note="interlock" * (name in rules)) for name in self.binding)])

    def report(self) -> Report:
        """What is proven of the overlap, and the report of its axes."""
        return OverlapReport(self)

    @classmethod
    def from_dict(cls, data: Any) -> Overlap:
        """The overlap that `to_dict` wrote; its objective is computed again from its axes.

        Raises
        ------
        InputError
            If an entry is missing, unknown or wrong, or states what the axes do not have.
        """
        overlap = cls.stated(data)
        if wrong := overlap.contradiction():
            raise InputError(f"{cls.named}: {wrong}")
        return overlap

    @classmethod
    def stated(cls, data: Any) -> Overlap:
        """The overlap as its data states it."""
        return super().from_dict(data)

    def contradiction(self) -> str:
        """What is stated that the axes do not have; empty where all of it agrees."""
        if tuple(self) != tuple(self.given) or self.axes.rules != self.given.rules:
            return "its axes and interlocks are not those of the given machine"
        for name, cycle in self.items():
            if _retimed(self.given[name], self._moves(name), cycle.duration).to_dict() != cycle.to_dict():
                return f"axis {name} makes other moves than the given one"
        try:
            known = self._reached()
        except InfeasibleProblem as error:
            return str(error)
        if abs(self.objective - known) > CYCLE_OPTIMALITY * known:
            return f"its objective is {self.objective!r}, and its axes have {known!r}"
        if self.lower_bound > self.objective * (1.0 + CYCLE_OPTIMALITY):
            return f"its lower bound {self.lower_bound!r} is above its objective {self.objective!r}"
        return ""

    def _reached(self) -> float:
        """The objective of the axes, whose laws keep their limits."""
        now = {name: cycle.peak(2) for name, cycle in self.items()}
        if self.goal == "period":
            return self.duration
        return max(now[name] / self.given[name].specification.unchecked().peak(2) for name in self.of)

    def bound_by(self, share: float = 1.0) -> tuple[str, ...]:
        """What binds at the instants of the axes: what leaves no time, to a share of what counts as none."""
        from optlaws.cycles.axes.overlapping import program

        times = {name: [time for time, _ in self._moves(name)] for name in self}
        given, goal = self.given, self.goal
        of_laws = given.instants if goal == "period" else program(given, given.rules, goal, self.of, times)
        return of_laws.binding(times, self.duration, share)

    def _moves(self, name: str) -> list[tuple[float, Any]]:
        """Of each given segment of an axis its duration now and its law; no time of dwells that are left out."""
        cycle, moves = self[name], []
        now = [*zip(cycle.segments, cycle.durations, strict=True), (None, 0.0)][::-1]
        for segment in self.given[name].segments:
            timed, _ = now[-1]
            gone = isinstance(segment, Dwell) and timed and replace(segment, duration=timed.duration) != timed
            timed, time = (None, 0.0) if gone or timed is None else now.pop()
            moves.append((time, getattr(timed, "law", None)))
        return moves

    def again(self) -> Overlap:
        """The overlap of the given machine, computed again."""
        return _overlapped(self.given, self.goal, self.of)

    def __repr__(self) -> str:
        what = f"period={self.objective:.6g} s" if self.goal == "period" else f"acceleration={self.objective:.6g}"
        gain = "" if self.gain is None else f", {self.gain:.4g} times better"
        return f"Overlap({what}{gain}, status={self.status.value!r}, bound by {self.binding})"


def _overlapped(given: Axes, goal: Goal, longer: Sequence[str]) -> Overlap:
    """The axes of a machine with the best overlap for a goal; of the acceleration of some axes."""
    from optlaws.cycles.axes import overlapping

    known = (
        given.instants.shortest() if goal == "period" else overlapping.least_acceleration(given, given.rules, longer)
    )
    of_laws, unknowns, bound = known
    period, times, cycles = of_laws.unit * float(unknowns[-2]), of_laws.durations(unknowns), dict[str, Cycle]()
    for plan in of_laws.plans:
        laws = (segment.law for segment in plan.segments)
        cycles[plan.name] = _retimed(given[plan.name], zip(times[plan.name], laws, strict=True), period)
    value = period if goal == "period" else 1.0 / float(unknowns[-1]) ** 2
    axes = Axes(cycles, interlocks=given.rules)
    overlap = Overlap(
        goal=goal, objective=value, lower_bound=bound, of=tuple(longer), binding=(), axes=axes, given=given
    )
    return replace(overlap, binding=overlap.bound_by())


def _with_usual_law(given: Axes) -> Axes:
    """The machine with the usual law in all moves that may have another one."""
    usual = {name: with_laws(cycle, segments_with(USUAL, cycle)) for name, cycle in given.items()}
    return Axes(usual, interlocks=given.rules)


def _least_period(instants: Callable[[], Overlapping]) -> float | None:
    """The least period in seconds of a program of instants; None where it cannot be set up or has no solution."""
    try:
        of_laws, unknowns, _ = instants().shortest()
    except (InfeasibleProblem, InputError, SolverFailure):
        return None
    return of_laws.unit * float(unknowns[-2])


def _retimed(cycle: Cycle, moves: Iterable[tuple[float, Any]], period: float) -> Cycle:
    """The cycle with other durations and laws of its moves; dwells of no time are left out."""
    segments: list[Any] = []
    for segment, (time, law) in zip(cycle.segments, moves, strict=True):
        if time > CLOSURE * period or not isinstance(segment, Dwell):
            sought: dict[str, Any] = {} if law is None or not is_optimal(segment) else {"law": law}
            segments.append(replace(segment, duration=Exact(time, "s"), **sought))  # type: ignore[type-var]
    return with_laws(cycle.specification, segments, period)


def _entries(given: Any) -> dict[str, Any]:
    if isinstance(given, list | tuple):
        return {"segments": given}
    if not isinstance(given, Mapping):
        raise InputError(f"its segments are a list such as [Rise('45 deg', '0.4 s'), Dwell()], got {shortened(given)}")
    check_names(given, Cycle.__dataclass_fields__, "key")
    for name in given.keys() & {"speed", "period"}:
        raise InputError(f"all axes have one {name}: give it to Axes(..., {name}={shortened(given[name])})")
    if "segments" not in given:
        raise InputError("it has no segments: give them, such as {'segments': [Rise('45 deg', '0.4 s'), Dwell()]}")
    return dict(given)
