"""Cams that bring an axis from rest into its cycle, or from its cycle to rest, while the master turns."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from math import sqrt
from typing import Any, Literal, get_args

import numpy as np

from optlaws.cycles.moves.fastest_move import AXES, FastestMove, MovePlan, panels_of
from optlaws.cycles.moves.timed_moves import move_limits
from optlaws.cycles.optimisation.objectives import CycleObjective
from optlaws.cycles.optimisation.optimal import solved, span_problem
from optlaws.cycles.specification.limits import along_motion, of_segments
from optlaws.cycles.specification.periods import best_possible_row, extent
from optlaws.cycles.specification.programme import REST, LawSpan, Programme, State, TimedSegment
from optlaws.cycles.specification.segments import Move, Transition
from optlaws.entries.declared import Declared, ValueOf, declared, entry
from optlaws.entries.value_types import Choice, Number, ReadBy, Together
from optlaws.errors import InputError
from optlaws.files.reading import check_names
from optlaws.kept import kept_property
from optlaws.laws.making.transform import mirrored_law
from optlaws.motion.motion import MASTERS, Motion
from optlaws.motion.piece import Piece, factor, unit_of, values_of_pieces
from optlaws.motion.quantities import QUANTITIES, Exact, given_quantity, quantity
from optlaws.numbers import Quantity
from optlaws.sentences import quantity_name
from optlaws.shown.report import PlainReport, Report, ReportSegment
from optlaws.shown.summary import Row, Summary
from optlaws.synthesis.least_time.time_search import least_time
from optlaws.synthesis.least_time.timed_move import TimedMove
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.solution import Solution
from optlaws.synthesis.spaces.bases import Chebyshev
from optlaws.synthesis.spaces.end_conditions import BoundaryConditions
from optlaws.synthesis.status import Status
from optlaws.tolerances import CLOSURE, INSIDE_PIECE, JUMP, STORED_VALUE

TransitionKind = Literal["run-in", "run-out"]
_POSITIVE, _NUMBER = Number(above=0.0), Number()
_DEGREE = 15  # of Z at least, as of the motions of cycles whose ends move


def _axis(value: Any) -> str:
    check_names([value], [*AXES, *AXES.values()], "unit of positions")
    return str(AXES.get(value, value))


@declared
class TransitionCam(MovePlan, Declared, title="a transition cam"):
    """A cam beside a cycle's cam: it starts the axis from rest, or stops it, while the master keeps turning.

    Where it meets the cycle position, velocity and acceleration are those of the cycle, from order 4 on the jerk too.
    Call it for the motion in SI units over the time since it began.

    Examples
    --------
    >>> from optlaws import Cycle, Return, Rise
    >>> cycle = Cycle([Rise("35 mm", "180 deg", law="cycloidal"), Return(law="cycloidal")], speed="60 rpm")
    >>> cam = cycle.run_in("90 deg", over="120 deg")
    >>> cam
    TransitionCam('run-in', -30 to 90 deg of the master, 0.333333 s, status='optimal')
    >>> round(cam(cam.duration), 9) == round(cycle.at_angle(90), 9), round(cam(cam.duration, 1), 9), cam(0.0, 1)
    (True, 0.14, 0.0)
    """

    writes_defaults = True

    kind: TransitionKind = entry(
        Choice(*get_args(TransitionKind)), "From rest into the cycle, or from the cycle to rest."
    )
    axis: str = entry(ReadBy(_axis, '"m" or "rad"', unit_of), 'Positions are a "length" or an "angle".', name="unit")
    period: float = entry(_POSITIVE, "Of the cycle, s.")
    at: float = entry(_NUMBER, "The time in the cycle at which it meets the cycle, s.")
    rest: float = entry(_NUMBER, "The position of rest, m or rad.")
    state: tuple[float, float, float, float] = entry(
        Together(*(_NUMBER,) * len(QUANTITIES), names=QUANTITIES), "Of the cycle where they meet, in SI units."
    )
    duration: float = entry(_POSITIVE, "How long it takes, s.")
    solution: Solution = entry(
        ValueOf(Solution),
        "The law from rest to this state, dimensionless, with its proof; that of a run-out runs backwards in time.",
        name="best",
        default=None,
    )
    least: FastestMove | None = entry(
        ValueOf(FastestMove), "The proof that no law of its space takes less time, where none was given.", default=None
    )

    @property
    def status(self) -> Status:
        """Status of the law: proven to be the best in its time, or to take the least time."""
        return self.solution.status if self.least is None else self.least.status

    @property
    def master(self) -> tuple[float, float]:
        """The angles of the cycle's master at which it begins and ends, in degrees; below 0 in the turn before."""
        share = 360.0 / self.period
        at, over = share * self.at, share * self.duration
        return (at - over, at) if self.kind == "run-in" else (at, at + over)

    @kept_property
    def piece(self) -> Piece:
        """The law in its place over the time since the cam began."""
        law, position, velocity = self.solution.law, *self.state[:2]
        # a law that ends where it begins is one of the way that its last velocity would take it
        stroke = position - self.rest or abs(velocity) * self.duration
        if self.kind == "run-in":
            return Piece(0.0, self.duration, self.rest, stroke, law)
        return Piece(0.0, self.duration, position, stroke, mirrored_law(law))

    @property
    def jumps(self) -> dict[str, float]:
        """Jumps of position, velocity, acceleration and jerk where cam and cycle meet; 0 if they are rounding."""
        side = 1 if self.kind == "run-in" else 0
        jumps = {}
        for nu, name in enumerate(QUANTITIES):
            jump = self.piece.end(nu, side) - self.state[nu]
            jumps[name] = 0.0 if abs(jump) <= JUMP * self._size(nu) else jump
        return jumps

    def _size(self, nu: int) -> float:
        """The greatest magnitude of a derivative in the cam and where it meets the cycle."""
        return max(self.peak(nu), abs(self.state[nu]))

    def motion(self, master: Quantity | None = "360 deg", unit: str | None = None) -> Motion:
        """The exact motion in machine units, as `Cycle.motion`, which does not repeat; its master begins at 0.

        The `master` is how far that of the cycle goes in a turn: it goes less in the cam as this takes less time.
        """
        if master is not None:
            turn = given_quantity(master, MASTERS, "master")
            master = Exact(turn.number * self.duration / self.period, turn.unit)
        return super().motion(master, unit)

    @property
    def _proof(self) -> tuple[str, ...]:
        return (f"{self.kind}: its master at 0 is that of the cycle at {self.master[0]:.9g} deg",)

    def plot(self, ax: Any = None, *, cycle: Any = None, **style: Any) -> list[Any]:
        """Draw position, velocity, acceleration and jerk over the master; return the artists.

        `ax` are four axes of matplotlib, new ones unless given; the `cycle` is drawn beside if it is given; `style` is
        what `Axes.plot` takes, for the cam.

        Examples
        --------
        >>> from optlaws import Cycle, Return, Rise
        >>> cycle = Cycle([Rise("35 mm", "180 deg", law="cycloidal"), Return(law="cycloidal")], speed="60 rpm")
        >>> artists = cycle.run_in("90 deg", over="120 deg").plot(cycle=cycle)
        >>> artists[0].axes.get_ylabel()
        'position, mm'
        """
        from optlaws.plots.moves import draw_transition

        return draw_transition(self, ax, cycle=cycle, **style)

    def report(self) -> Report:
        """The place, the duration, the peaks and the jumps of the cam, and its motion over time.

        Examples
        --------
        >>> from optlaws import Cycle, Return, Rise
        >>> cycle = Cycle([Rise("35 mm", "180 deg", law="cycloidal"), Return(law="cycloidal")], speed="60 rpm")
        >>> facts = cycle.run_in("90 deg", over="120 deg").report().facts
        >>> [f"{row.name} {row.text(5)} {row.unit}" for row in facts[:3]]
        ['master -30 to 90 deg', 'time 0.33333 s', 'status optimal ']
        """
        data = {
            "kind": self.kind,
            "master": list(self.master),
            "duration": self.duration,
            "rest": self.rest,
            "status": self.status.value,
            "none_below": None if self.least is None else self.least.none_below,
            **{name: self.peak(nu) for nu, name in enumerate(QUANTITIES) if nu},
            "jumps": self.jumps,
        }
        segments = (ReportSegment(self.kind, 0.0, self.duration),)
        return PlainReport(self._facts(), (), panels_of(self.piece, self.axis, {}), lambda: data, segments)

    def _facts(self) -> Summary:
        rows = [Row("master", self.master, "deg"), Row("time", self.duration, "s"), Row("status", self.status.value)]
        if self.least is not None:
            binding = ", ".join(map(quantity_name, self.least.binding))
            rows.append(Row("lower bound (proven)", self.least.none_below, "s", note=f"{binding} binds"))
            rows.append(best_possible_row(self.least.best_possible, self.duration))
        elif self.solution.best_possible is None:
            rows.append(best_possible_row(None, self.duration))
        else:
            note = f"least {self.solution.problem.minimise} of any degree, as a share of that of the law"
            rows.append(Row("best possible", self.solution.best_possible / self.solution.objective, note=note))
        for nu, name in enumerate(QUANTITIES[1:], start=1):
            value, place = max(self.piece.extremes(nu, 0.0, self.duration), key=lambda each: abs(each[0]))
            rows.append(Row(f"peak {name}", abs(value), unit_of(self.axis, nu), place))
        for nu, (name, jump) in enumerate(self.jumps.items()):
            rows.append(Row(f"jump of {name} where they meet", jump, unit_of(self.axis, nu)))
        return Summary(rows, "s")

    def to_dict(self) -> dict[str, Any]:
        """Plain JSON-able dict in SI units, with the law and its proof."""
        return super().to_dict() | ({} if self.least is None else {"best": None})

    def claims(self) -> dict[str, Any]:
        """The law and its proof as `optlaws verify` takes them; of a run-out it runs backwards in time."""
        value = self.solution if self.least is None else self.least
        return {"law": value.to_dict()}

    @classmethod
    def _from_earlier(cls, data: dict[str, Any]) -> dict[str, Any]:
        least = data.get("least")
        if (least is None) == (data.get("best") is None):
            raise InputError(f"{cls.named} has either the best law of its time or a least time")
        if least is None:
            return data
        read = FastestMove.from_dict(least)
        return data | {"least": read, "best": read.least.solution}

    def _check(self) -> None:
        """Refuse a law that does not meet the cycle, or a least time of another move."""
        side = 1 if self.kind == "run-in" else 0
        for nu, jump in enumerate(list(self.jumps.values())[: self.solution.problem.order]):
            still = abs(self.piece.end(nu, 1 - side) - (self.rest if nu == 0 else 0.0))
            if max(abs(jump), still) > sqrt(STORED_VALUE) * self._size(nu):
                raise InputError(f"the law of {self.named} does not meet its state or its rest")
        if self.least is not None and self.least.duration != self.duration:
            raise InputError(f"{self.named} takes {self.duration!r} s, but its least time is another")

    def contradiction(self, cycle: Any) -> str:
        """What differs where it meets the motion of a cycle; empty of the cycle that it belongs to."""
        if abs(cycle.duration - self.period) > STORED_VALUE * self.period:
            return f"its cycle takes {self.period!r} s, not {cycle.duration!r} s"
        known = _state(self.kind, cycle.specification.programme, cycle.pieces, self.at)
        for nu, (name, stated, value) in enumerate(zip(QUANTITIES, self.state, known, strict=True)):
            if abs(stated - value) > sqrt(STORED_VALUE) * self._size(nu):
                return f"{name} {stated!r} stated where it meets the cycle, which has {value!r} there"
        return ""

    def __repr__(self) -> str:
        first, last = self.master
        return (
            f"TransitionCam({self.kind!r}, {first:.6g} to {last:.6g} deg of the master, {self.duration:.6g} s, "
            f"status={self.status.value!r})"
        )


def transition_cam(
    kind: TransitionKind, programme: Programme, pieces: Sequence[Piece], objective: CycleObjective, given: Transition
) -> TransitionCam:
    """The cam from rest into a cycle, or out of it to rest, in a given time or the least within its limits."""
    period, axis = programme.period, programme.axis
    at = extent(given.at, "at").at(period)
    if not 0.0 <= at <= period:
        raise InputError(f"at must be within the cycle, from 0 to 360 deg, got {given.at!r}")
    state = _state(kind, programme, pieces, at)
    rest = programme.start if given.rest is None else quantity(given.rest, axis, "rest")
    way = max(abs(stretch.displacement) for stretch in programme.stretches)
    if abs(state[0] - rest) <= CLOSURE * way:
        rest = state[0]
    moved, (velocity, acceleration, jerk), shown = state[0] - rest, state[1:], f"{360.0 * at / period:.6g} deg"
    if kind == "run-out":
        velocity, jerk = -velocity, -jerk  # its law is reversed in time
    of_motion = replace(
        objective,
        minimise=objective.minimise if objective.kind.order else "acceleration",
        order=given.order or objective.order,
        limits=of_segments(objective.limits),
        load=None,
    )
    # as a segment it has the name that errors give it; a run-out moves the other way than its law
    stretch = partial(TimedSegment, 1, Move(name=kind), displacement=moved if kind == "run-in" else -moved)
    cam = partial(TransitionCam, kind, axis, period, at, rest, state)
    if given.over is not None:
        duration = extent(given.over, "over").at(period)
        if moved == 0.0 and velocity == 0.0:
            raise InputError(f"the cycle is in the place of rest at {shown}, and rests: it needs no {kind}")
        last, timed = State(velocity, acceleration), stretch(duration, duration)
        span = LawSpan((timed,), (0.0,), duration, rest, moved, REST, last, ())
        stroke, count = span.stroke, of_motion.order - 1
        rates = [rate / factor(stroke, duration, nu) for nu, rate in enumerate((velocity, acceleration, jerk), start=1)]
        ends = (*rates, *(0.0,) * count)[:count]
        problem = replace(
            span_problem(span, of_motion),
            basis=Chebyshev(max(of_motion.degree, _DEGREE)),
            symmetric=False,
            boundary=BoundaryConditions((0.0, *(0.0,) * count), (moved / stroke, *ends)),
        )
        return cam(duration, solved(problem, span))
    if moved == 0.0:
        raise InputError(
            f"the place of rest is that of the cycle at {shown}: its least time is not sought; "
            "give `over`, or another place"
        )
    limits = stretch(period, period).sides(of_motion.limits)
    if not limits:
        raise InputError("nothing limits the least time: give the cycle limits, or say the time or angle as `over`")
    if not all(key.kind.order for key in limits):
        raise InputError("the least time is sought within limits of the motion, not of a drive: give `over`")
    sign = 1.0 if moved > 0.0 else -1.0
    problem = Problem(
        order=of_motion.order,
        basis=Chebyshev(max(of_motion.degree, _DEGREE)),
        symmetric=False,
        monotone=along_motion(limits),
    )
    move = TimedMove(
        problem,
        abs(moved),
        move_limits(limits, sign, axis),
        end_velocity=sign * velocity,
        end_acceleration=sign * acceleration if of_motion.order > 2 else 0.0,
        end_jerk=sign * jerk if of_motion.order > 3 else 0.0,
    )
    least = least_time(move)
    return cam(least.duration, least.solution, FastestMove(least, unit_of(axis)))


def _state(
    kind: TransitionKind, programme: Programme, pieces: Sequence[Piece], time: float
) -> tuple[float, float, float, float]:
    """The state of the cycle at a time: after a joint for a run-in, before it for a run-out."""
    period = programme.period
    # what jumps at a joint has the value of the side that the cam joins
    inside, side = (time % period, 1.0) if kind == "run-in" else (time or period, -1.0)
    near = inside + side * INSIDE_PIECE * period
    position, *rates = (
        float(values_of_pieces(pieces, np.array([at]), nu)[0]) for nu, at in enumerate((inside, inside, near, near))
    )
    sizes = [
        max(piece.law.peak(nu).value * abs(factor(piece.stroke, piece.duration, nu)) for piece in pieces)
        for nu in (1, 2, 3)
    ]
    velocity, acceleration, jerk = (
        0.0 if abs(rate) <= CLOSURE * size else rate for rate, size in zip(rates, sizes, strict=True)
    )
    return position + programme.advance * round((time - inside) / period), velocity, acceleration, jerk
