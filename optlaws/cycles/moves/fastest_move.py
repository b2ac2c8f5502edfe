"""The least time of a single move in machine units: `fastest` and what it returns."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, NamedTuple, Unpack

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.files.reading import JsonText, entries_of
from optlaws.laws import MotionLaw
from optlaws.laws.exporting import ExportOptions, LawExport
from optlaws.motion.piece import factor, unit_of
from optlaws.motion.quantities import either, positive_quantity, quantity, table
from optlaws.numbers import Quantity
from optlaws.shown.summary import Row, Summary
from optlaws.suggest import keywords_of, unknown_key
from optlaws.synthesis.least_time.least_time import LeastTime
from optlaws.synthesis.least_time.move_limits import MoveLimits, RateLimit, TimedMove
from optlaws.synthesis.least_time.time_search import least_time
from optlaws.synthesis.problem.problem import Problem

_EXAMPLE = '{"velocity": "1 m/s", "acceleration": ("-8 m/s^2", "12 m/s^2"), "jerk": "300 m/s^3"}'
_NAMES = ("velocity", "acceleration", "deceleration", "jerk", "snap")
_AXES = {"m": "length", "rad": "angle"}
_DEGREES = 57.29577951308232
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
    >>> move = fastest(
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
        """The least time, s."""
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

        From rest to rest, under limits of velocity, acceleration and jerk, it is that of the seven segments. A limit
        of the snap adds a bound of its own: then laws need not come near.
        """
        return self.least.limit

    @property
    def limit_breaks(self) -> tuple[float, ...] | None:
        """Breaks of `Pieces(breaks, degree=3, continuity=2)` that reach the limit; None where none are known.

        Examples
        --------
        >>> import optlaws
        >>> limits = {"velocity": "1 m/s", "jerk": "300 m/s^3"}
        >>> move = fastest(optlaws.Problem(order=3), stroke="100 mm", limits=limits)
        >>> pieces = optlaws.Pieces(move.limit_breaks, degree=3, continuity=2)
        >>> round(fastest(optlaws.Problem(order=3, basis=pieces), stroke="100 mm", limits=limits).price, 9)
        0.0
        """
        return self.least.limit_breaks

    @property
    def price(self) -> float | None:
        """By which share the laws of the problem's space are slower than all laws; None without a limit."""
        return self.least.price

    @property
    def none_below(self) -> float:
        """The time up to which it is proven that no law of the space keeps the limits, s."""
        return self.least.none_below

    @property
    def gap(self) -> float:
        """By which share of itself the least time is above the longest that is proven to be too short."""
        return self.least.gap

    @property
    def binding(self) -> tuple[str, ...]:
        """The limits that the law reaches and that keep it from being faster."""
        return self.least.binding

    def gains(self, more: float = _MORE) -> dict[str, float]:
        """The share of the time that a share more of each limit saves, by its multiplier; exact for small shares.

        Examples
        --------
        >>> import optlaws
        >>> move = fastest(optlaws.Problem(order=3), stroke="100 mm", limits={"jerk": "300 m/s^3"})
        >>> round(move.gains(0.03)["jerk"], 9)
        0.01
        """
        return self.least.gains(more)

    @property
    def notes(self) -> tuple[str, ...]:
        """Which limits bind, and what a tenth more of each would save, in words."""
        gains = self.gains()
        binding = [f"{name}: 10 % more saves about {100.0 * gains[name]:.2g} % of the time" for name in self.binding]
        return tuple(binding)

    def summary(self) -> Summary:
        """The least time, what no law beats, and each limit with its use, as rows.

        Examples
        --------
        >>> import optlaws
        >>> move = fastest(optlaws.Problem(order=3), stroke="100 mm", limits={"velocity": "1 m/s", "jerk": "300 m/s^3"})
        >>> [(row.name, row.text(5), row.unit) for row in move.summary()][:3]
        [('least time', '0.22533', 's'), ('limit', '0.22013', 's'), ('velocity', '0.88481', 'm/s')]
        """
        proven = f"proven: none of {_space(self.least.move.problem)} takes {self.none_below:.9g} s or less"
        rows = [Row("least time", self.duration, "s", note=proven)]
        if self.limit is not None and self.price is not None:
            note = f"that no law of any degree beats: the space costs {100.0 * max(self.price, 0.0):.2g} %"
            rows.append(Row("limit", self.limit, "s", note=note))
        gains, axis = self.gains(), _AXES[self.unit]
        for limit in self.least.move.rates:
            peak = limit.constant.value(self.law) * factor(self.stroke, self.duration, limit.nu)
            rows.append(Row(limit.name, peak, unit_of(axis, limit.nu), note=self._use(limit, gains[limit.name])))
        return Summary(rows)

    def _use(self, limit: RateLimit, gain: float) -> str:
        """How much of a limit the law uses, and what more of it would save."""
        if limit.name in self.binding:
            return f"binds: 10 % more saves about {100.0 * gain:.2g} % of the time"
        return f"{100.0 * self.least.used(limit):.3g} % of the limit"

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
    ) -> Any:  # noqa: ANN401 - an export
        """The move in the format of a controller, with its stroke and its least time unless others are given.

        Raises
        ------
        InputError
            As `MotionLaw.export`.

        Examples
        --------
        >>> import optlaws
        >>> move = fastest(optlaws.Problem(order=3), stroke="100 mm", limits={"jerk": "300 m/s^3"})
        >>> move.export("csv", points=3).text.splitlines()[-1].split(",")[1]
        '100'
        """
        whole = f"{self.stroke * 1e3!r} mm" if self.unit == "m" else f"{self.stroke * _DEGREES!r} deg"
        return super().export(
            to,
            stroke=whole if stroke is None else stroke,
            duration=f"{self.duration!r} s" if duration is None else duration,
            master=master,
            start=start,
            **options,
        )

    def _exported(self) -> tuple[MotionLaw, tuple[str, ...]]:
        proven = f"none of {_space(self.least.move.problem)} takes {self.none_below:.9g} s or less"
        return self.law, (f"law: least time {self.duration:.9g} s within the limits, {proven}",)

    def to_dict(self) -> dict[str, Any]:
        """Plain JSON-able dict in SI units: law and proofs in one, which `optlaws verify` checks."""
        return {"unit": self.unit, **self.least.to_dict()}

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> FastestMove:
        """Read what `to_dict` wrote; the law and the proofs are held against the move and its limits.

        Raises
        ------
        InputError
            If an entry is missing or wrong, or states what does not follow from the law and the proofs.
        """
        if entries_of(data, ["unit"], cls._json_name)["unit"] not in tuple(_AXES):
            raise InputError(f"{cls._json_name} has a unit, 'm' or 'rad', got {shortened(data)}")
        return cls(LeastTime.from_dict({key: data[key] for key in data if key != "unit"}), data["unit"])

    def _repr_html_(self) -> str:
        from optlaws.laws.html import drawings
        from optlaws.shown.showing import page

        return page("FastestMove", self.summary()._repr_html_(), drawings(self.law))

    def __repr__(self) -> str:
        limit = "" if self.limit is None else f", limit={self.limit:.9g}"
        return f"FastestMove(duration={self.duration:.9g}{limit}, binding={self.binding!r})"


def fastest(
    problem: Problem,
    *,
    stroke: Quantity,
    limits: Mapping[str, Any],
    start_velocity: Quantity | None = None,
    end_velocity: Quantity | None = None,
) -> FastestMove:
    """The least time of a single move within limits in machine units, and the proof that no law is faster.

    Parameters
    ----------
    problem
        The space of laws: order, basis, windows, monotone, symmetric. Its B, C, D and J are free, and it minimises
        nothing. Where limits or ends are not the same both ways its laws need not be symmetric.
    stroke
        How far, above 0: "100 mm" or "90 deg".
    limits
        By name: "velocity", "acceleration", "deceleration", "jerk", "snap", such as "1 m/s", of both signs. The
        acceleration may be a pair of the least and the greatest, the velocity a pair that begins with 0 for a move
        that never turns back. "deceleration" is the greatest acceleration against the stroke.
    start_velocity, end_velocity
        Velocities at the ends, such as "0.2 m/s"; rest unless given. The acceleration is 0 there from order 3 on.

    Returns
    -------
    FastestMove
        The least time, its law, which limits bind, the proof, and the limit of all laws.

    Raises
    ------
    InputError
        If a quantity is wrong, or the limits are kept in any time.
    InfeasibleProblem
        If no law keeps the problem's windows, however long it takes.
    SolverFailure
        If the steps of the time do not settle.

    Examples
    --------
    >>> import optlaws
    >>> limits = {"velocity": "1 m/s", "acceleration": ("-8 m/s^2", "12 m/s^2"), "jerk": "300 m/s^3"}
    >>> move = fastest(optlaws.Problem(order=3), stroke="100 mm", limits=limits)
    >>> round(move.duration, 6), round(move.limit, 6), move.binding
    (0.243994, 0.240161, ('acceleration', 'deceleration', 'jerk'))
    """
    dimension, far = either(stroke, tuple(_AXES.values()), "stroke")
    if not far > 0.0:
        raise InputError(f"stroke must be above 0, got {shortened(stroke)}: turn the axis and its limits round")
    angular = "angular " if dimension == "angle" else ""
    read = _read_limits(limits, angular)
    if not isinstance(problem, Problem):
        raise InputError(f"fastest takes a Problem, got {type(problem).__name__}")
    ends = {
        name: 0.0 if value is None else quantity(value, f"{angular}velocity", name)
        for name, value in (("start_velocity", start_velocity), ("end_velocity", end_velocity))
    }
    space = replace(problem, monotone=True) if read.forward else problem
    unit = next(unit for unit, axis in _AXES.items() if axis == dimension)
    return FastestMove(least_time(TimedMove(space, far, read.limits, **ends)), unit)


class _Read(NamedTuple):
    limits: MoveLimits
    forward: bool  #: whether the move must never turn back


def _read_limits(given: Any, angular: str) -> _Read:  # noqa: ANN401 - it is checked here
    """Limits in SI units."""
    entries = table(given, "limits", _EXAMPLE)
    for name in entries:
        if name not in _NAMES:
            raise InputError(unknown_key(name, _NAMES, "limit"))
    read: dict[str, float] = {}
    forward = False
    for name, value in entries.items():
        dimension, where = f"{angular}{name.replace('deceleration', 'acceleration')}", f"limits: {name}"
        if not isinstance(value, list | tuple):
            read[name] = positive_quantity(value, dimension, where)
            continue
        low, high = _pair(value, dimension, where)
        read[name] = high
        if name == "acceleration":
            if "deceleration" in entries:
                raise InputError("limits: the acceleration is a pair, so that deceleration is given twice")
            read["deceleration"] = -low
        elif name == "velocity" and low == 0.0:
            forward = True
        elif low != -high:
            remedy = " or begin with 0" if name == "velocity" else ""
            raise InputError(f"{where}: its two values must be opposite{remedy}, got {shortened(value)}")
    if "acceleration" in read:
        read.setdefault("deceleration", read["acceleration"])
    return _Read(MoveLimits(**read), forward)


def _pair(value: Any, dimension: str, where: str) -> tuple[float, float]:  # noqa: ANN401
    """The least and the greatest value of a pair."""
    if len(value) != 2:
        raise InputError(f"{where} must be one quantity or two, the least and the greatest, got {shortened(value)}")
    low, high = (quantity(each, dimension, where) for each in value)
    if not (low < 0.0 < high or (low == 0.0 < high and "velocity" in dimension)):
        raise InputError(f"{where}: the least value must be below 0 and the greatest above, got {shortened(value)}")
    return low, high


def _space(problem: Problem) -> str:
    """The laws of a problem in words."""
    return f"the laws of order {problem.order} in {problem.basis!r}"
