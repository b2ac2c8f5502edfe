"""The least time of a single move in machine units, as `fastest` returns it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Unpack

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.files.reading import JsonText, entries_of
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.laws.exporting import ExportOptions, LawExport
from optlaws.motion.display_units import DEGREES
from optlaws.motion.quantities import positive_quantity
from optlaws.numbers import Quantity, positive
from optlaws.shown.report import Report
from optlaws.shown.summary import Row, Summary
from optlaws.suggest import keywords_of
from optlaws.synthesis.least_time.least_time import LeastTime
from optlaws.synthesis.least_time.time_search import least_time
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.status import Status
from optlaws.tolerances import SAME_TIME

#: what the unit of a stroke measures
AXES = {"m": "length", "rad": "angle"}
_MORE = 0.1


@dataclass(frozen=True, repr=False)
class FastestMove(LawExport, JsonText):
    """The least time of a single move within limits, with the law that takes it and the proof that none is faster.

    Attributes
    ----------
    least
        The same in SI units, with the move and the proofs.
    unit
        That of the stroke, "m" or "rad".

    Examples
    --------
    >>> import optlaws
    >>> move = optlaws.fastest(
    ...     optlaws.Problem(order=3), stroke="100 mm", limits={"acceleration": "8 m/s^2", "jerk": "300 m/s^3"}
    ... )
    >>> round(move.duration, 6), round(move.limit, 6), move.binding
    (0.255736, 0.251858, ('acceleration', 'jerk'))
    """

    least: LeastTime
    unit: str = "m"

    _json_name = "a fastest move"

    @property
    def duration(self) -> float:
        """The least time of the move, s."""
        return self.least.duration

    @property
    def stroke(self) -> float:
        """The stroke, in m or rad."""
        return self.least.move.stroke

    @property
    def law(self) -> MotionLaw:
        """The law that takes the least time."""
        return self.least.law

    @property
    def limit(self) -> float | None:
        """The time that no law of any degree is faster than, s; None where no closed form is known.

        Under limits of velocity, acceleration and jerk it is that of the seven segments, whose ends have the move's
        velocities. A limit of the snap adds a bound of its own from rest to rest: then laws need not come near, nor at
        order 2 with a limit of the jerk where an end moves.
        """
        return self.least.limit

    @property
    def limit_breaks(self) -> tuple[float, ...]:
        """Breaks of `Pieces(breaks, degree=3, continuity=2)` that reach the limit; empty where none are known.

        Examples
        --------
        >>> import optlaws
        >>> limits = {"velocity": "1 m/s", "jerk": "300 m/s^3"}
        >>> move = optlaws.fastest(optlaws.Problem(order=3), stroke="100 mm", limits=limits)
        >>> pieces = optlaws.Pieces(move.limit_breaks, degree=3, continuity=2)
        >>> round(optlaws.fastest(optlaws.Problem(order=3, basis=pieces), stroke="100 mm", limits=limits).price, 9)
        0.0
        """
        return self.least.limit_breaks

    @property
    def price(self) -> float | None:
        """The share by which laws of the problem's space are slower than all laws; None without a limit."""
        return self.least.price

    @property
    def none_below(self) -> float:
        """The time up to which it is proven that no law of the space keeps the limits, s."""
        return self.least.none_below

    @property
    def gap(self) -> float:
        """The relative difference between the least time and the longest time that is proven to be too short."""
        return self.least.gap

    @property
    def status(self) -> Status:
        """`optimal` where the least time is proven, `local` where a torque is not convex in the law."""
        return self.least.status

    @property
    def binding(self) -> tuple[str, ...]:
        """The limits that the law reaches and that keep it from being faster."""
        return self.least.binding

    def gains(self, more: float = _MORE) -> dict[str, float]:
        """The share of the time that a share more of each limit saves: the least time with it is computed again.

        Empty where a torque or what vibrates is limited.

        Examples
        --------
        >>> import optlaws
        >>> move = optlaws.fastest(optlaws.Problem(order=3), stroke="100 mm", limits={"jerk": "300 m/s^3"})
        >>> round(move.gains(0.1)["jerk"], 6), round(1 - 1.1 ** (-1 / 3), 6)
        (0.03127, 0.03127)
        """
        more = positive(more, "more")
        if more not in self._gains:
            self._gains[more] = {name: self._gain(name, more) for name in self.least.slopes}
        return dict(self._gains[more])

    @kept_property
    def _gains(self) -> dict[float, dict[str, float]]:
        return {}

    def _gain(self, name: str, more: float) -> float:
        if name not in self.binding:
            return 0.0
        move = self.least.move
        raised = replace(move, limits=move.limits.scaled(name, 1.0 + more))
        return 1.0 - least_time(raised, self.least).duration / self.duration

    def within(self, duration: Quantity) -> Problem:
        """The problem of the laws that keep every limit in a longer time, such as "0.3 s", to minimise something else.

        Raises
        ------
        InputError
            If it is no time, or shorter than the least.

        Examples
        --------
        >>> from dataclasses import replace
        >>> import optlaws
        >>> move = optlaws.fastest(optlaws.Problem(order=3), stroke="100 mm", limits={"jerk": "300 m/s^3"})
        >>> slower = optlaws.synthesize(replace(move.within("0.3 s"), minimise="rms_c"))
        >>> round(slower.objective * move.stroke / 0.3**2, 6)
        4.202626
        """
        time = positive_quantity(duration, "time", "duration")
        if time < self.duration * (1.0 - SAME_TIME):
            raise InputError(
                f"duration must be at least the least time, {self.duration:.9g} s, got {shortened(duration)}"
            )
        return self.least.move.within(max(time, self.duration))

    @property
    def notes(self) -> tuple[str, ...]:
        """The active limits, and the time that a tenth more of each would save, in words."""
        gains = self.gains()
        return tuple(
            f"{name}: 10 % more saves {100.0 * gains[name]:.2g} % of the time" if name in gains else f"{name} binds"
            for name in self.binding
        )

    def summary(self) -> Summary:
        """Rows with the least time, the limit for all laws, and the use of each limit.

        Examples
        --------
        >>> import optlaws
        >>> move = optlaws.fastest(
        ...     optlaws.Problem(order=3), stroke="100 mm", limits={"velocity": "1 m/s", "jerk": "300 m/s^3"}
        ... )
        >>> [(row.name, row.text(5), row.unit) for row in move.summary()][:3]
        [('least time', '0.22533', 's'), ('limit', '0.22013', 's'), ('velocity', '0.88481', 'm/s')]
        """
        return self.report().facts

    def proof_rows(self) -> Summary:
        """The least time and the limit of all laws, with what is proven of them."""
        rows = [Row("least time", self.duration, "s", note=f"{self._word}: {self._proven}")]
        laws = "of any degree" if self.least.move.torque is None else "that never turns back"
        return Summary([*rows, limit_row(self.limit, self.duration, laws)])

    @keywords_of(ExportOptions)
    def export(
        self,
        to: str,
        *,
        stroke: Quantity | None = None,
        duration: Quantity | None = None,
        master: Quantity | None = None,
        start: Quantity | None = None,
        **options: Unpack[ExportOptions],
    ) -> Any:
        """The move in the format of a controller, with its stroke and its least time unless others are given.

        Raises
        ------
        InputError
            As `MotionLaw.export`.

        Examples
        --------
        >>> import optlaws
        >>> move = optlaws.fastest(optlaws.Problem(order=3), stroke="100 mm", limits={"jerk": "300 m/s^3"})
        >>> round(float(move.export("csv", points=3).text.splitlines()[-1].split(",")[1]), 9)
        100.0
        """
        whole = f"{self.stroke * 1e3!r} mm" if self.unit == "m" else f"{self.stroke * DEGREES!r} deg"
        return super().export(
            to,
            stroke=whole if stroke is None else stroke,
            duration=f"{self.duration!r} s" if duration is None else duration,
            master=master,
            start=start,
            **options,
        )

    def _exported(self) -> tuple[MotionLaw, tuple[str, ...]]:
        return self.law, (f"law: least time {self.duration:.9g} s within the limits, {self._word}: {self._proven}",)

    @property
    def _word(self) -> str:
        return "proven" if self.status is Status.OPTIMAL else "the least that was found, and proven"

    @property
    def _proven(self) -> str:
        """The statement on all laws of the space that is proven."""
        return f"none of {_space(self.least.move.problem)} takes {self.none_below:.9g} s or less"

    def to_dict(self) -> dict[str, Any]:
        """Plain JSON-able dict in SI units: law and proofs in one, which `optlaws verify` checks."""
        return {"unit": self.unit, **self.least.to_dict()}

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> FastestMove:
        """Read the output of `to_dict`; the law and the proofs are checked against the move and its limits.

        Raises
        ------
        InputError
            If an entry is missing or wrong, or states what does not follow from the law and the proofs.
        """
        if entries_of(data, ["unit"], cls._json_name)["unit"] not in tuple(AXES):
            raise InputError(f"{cls._json_name} has a unit, 'm' or 'rad', got {shortened(data)}")
        return cls(LeastTime.from_dict({key: data[key] for key in data if key != "unit"}), data["unit"])

    def report(self) -> Report:
        """The facts of the move, and its motion over time within its limits.

        Examples
        --------
        >>> import optlaws
        >>> move = optlaws.fastest(optlaws.Problem(order=3), stroke="100 mm", limits={"jerk": "300 m/s^3"})
        >>> [(panel.title, round(panel.peak, 6)) for panel in move.report().panels][3]
        ('jerk, m/s³', 300.0)
        """
        from optlaws.cycles.moves.report import MoveReport

        return MoveReport(self, self.law, self.duration)

    def _repr_html_(self) -> str:
        from optlaws.shown.report import report_page

        return report_page("FastestMove", self.report())

    def __repr__(self) -> str:
        limit = "" if self.limit is None else f", limit={self.limit:.9g}"
        return f"FastestMove(duration={self.duration:.9g}{limit}, binding={self.binding!r})"


def limit_row(limit: float | None, least: float, laws: str = "of any degree") -> Row:
    """What is known of the time of all laws, beside the least time of those of a space.

    >>> limit_row(None, 0.2).text(), limit_row(0.2, 0.21).note
    ('not known', 'that no law of any degree beats: the space costs 5 %')
    """
    if limit is None:
        return Row("limit", "not known", note=f"of what no law {laws} beats")
    price = 100.0 * max(least / limit - 1.0, 0.0)
    return Row("limit", limit, "s", note=f"that no law {laws} beats: the space costs {price:.2g} %")


def _space(problem: Problem) -> str:
    """The laws of a problem in words."""
    return f"the laws of order {problem.order} in {problem.basis!r}"
