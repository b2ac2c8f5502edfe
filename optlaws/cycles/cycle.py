"""A whole cycle of a machine: its segments in machine units, evaluated, peaked, driven, and optimal as a whole."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import reduce
from itertools import pairwise
from math import hypot
from typing import Any

import numpy as np
from numpy.typing import NDArray

from optlaws.cycles.asked.conversion import Piece
from optlaws.cycles.asked.joints import Layout, layout
from optlaws.cycles.asked.programme import TURN, Programme, Stretch, is_optimal, period_of, programme
from optlaws.cycles.asked.quantities import quantity
from optlaws.cycles.asked.segments import ConstantVelocity, CycleSegment, Dwell, Free, Move
from optlaws.cycles.drive import Drive, read_drive
from optlaws.cycles.durations import durations
from optlaws.cycles.effort import Effort, effort
from optlaws.cycles.load import LOAD, Load, read_load
from optlaws.cycles.optimal import (
    LOADED,
    Wanted,
    check_objective,
    force_unit,
    kind_of,
    limits_of_stretch,
    read_limits,
    read_load_limits,
    solve,
)
from optlaws.cycles.stored import Stated
from optlaws.errors import InputError
from optlaws.exporting import exported
from optlaws.kept import kept_property
from optlaws.mechanisms.cam.polydyne import polydyne
from optlaws.mechanisms.machine.over_time import RepeatedMotion
from optlaws.numbers import MOST_DEGREE, derivative, real_times, whole
from optlaws.plotting import plotted
from optlaws.synthesis.solution import Solution, Status

Array = NDArray[np.float64]
Place = tuple[float, float]

JOINED = 1e-9  # a leap below this share of the derivative's greatest value is rounding


@dataclass(frozen=True)
class SegmentPeaks:
    """Least and greatest position, velocity, acceleration and jerk in a segment, each with its time; SI units."""

    name: str
    start: float
    duration: float
    extremes: tuple[tuple[tuple[float, float], tuple[float, float]], ...]

    def peak(self, nu: int) -> float:
        """The greatest magnitude of the derivative of order nu."""
        return max(abs(value) for value, _ in self.extremes[nu])


@dataclass(frozen=True, repr=False)
class Cycle(Stated):
    """A cycle that repeats: segments, and how fast the master turns; call it for motion in SI units over time.

    Positions are lengths or angles, whichever the first displacement is. Laws that are to be optimal are looked for
    when they are first needed; between joints that are known the cycle decouples, and each law is proven by itself.

    Parameters
    ----------
    segments
        What happens, in order: `Rise`, `Return`, `Move`, `Dwell`, `ConstantVelocity`, `Free`.
    speed, period
        Of the master, "200 rpm", or the duration of the cycle, "0.3 s": one of them.
    minimise
        "acceleration", "velocity", "jerk", "rms acceleration", "rms jerk", "force" or "rms force" of optimal segments.
    limits
        Of all optimal segments: `{"velocity": "616 mm/s"}`.
    start
        Position at the start, 0 unless given.
    advance
        How far each cycle goes on from the one before; 0 unless given.
    drive
        What the motion drives: `{"mass": "2 kg", "stiffness": "3 N/mm", "viscous": ..., "dry": ..., "gravity": ...}`,
        with inertia in place of mass for tables.
    load
        What the motion drives elastically, over the whole cycle: `{"period": "20 ms", "damping": 0.05, "mass": "2 kg"}`
        for a follower's mass on its spring, or a `Machine` in seconds and SI units. Its outputs may be minimised and
        bounded: "load acceleration", "rms load deflection", "load force"; the cycle is then one problem.
    order, degree
        Number of end conditions of optimal laws, and the degree of their Z.

    Raises
    ------
    InputError
        If durations do not sum, positions do not close or velocities do not meet; the error says the remedy.

    Examples
    --------
    >>> from optlaws.cycles.asked.segments import Dwell, Return, Rise
    >>> rise, back = Rise("35 mm", "120 deg"), Return("35 mm", "100 deg")
    >>> cycle = Cycle([rise, Dwell("90 deg"), back, Dwell()], speed="200 rpm")
    >>> cycle.status.value, round(cycle.objective, 6), round(float(cycle(0.1)), 9)
    ('optimal', 21.883840, 0.035000)
    """

    segments: Sequence[CycleSegment]
    speed: Any = field(default=None, kw_only=True)
    period: Any = field(default=None, kw_only=True)
    minimise: str = field(default="acceleration", kw_only=True)
    limits: Mapping[str, Any] = field(default_factory=dict, kw_only=True)
    start: Any = field(default=None, kw_only=True)
    advance: Any = field(default=None, kw_only=True)
    drive: Mapping[str, Any] | None = field(default=None, kw_only=True)
    load: Any = field(default=None, kw_only=True)
    order: int = field(default=3, kw_only=True)
    degree: int = field(default=9, kw_only=True)

    def __post_init__(self) -> None:
        if not isinstance(self.segments, list | tuple) or not self.segments:
            raise InputError("a cycle is a list of segments such as [Rise('35 mm', '120 deg'), Dwell(), ...]")
        object.__setattr__(self, "segments", tuple(self.segments))
        check_objective(self.minimise, self._load)
        if all(one.fixed for one in self.programme.stretches):
            self._layout  # noqa: B018 - velocities that do not meet are refused at once
        self.limits_of_segments  # noqa: B018 - and so are limits and drives

    @kept_property
    def programme(self) -> Programme:
        """The cycle as numbers in SI units."""
        return programme(self.segments, period_of(self.speed, self.period), self.start, self.advance)

    @property
    def axis(self) -> str:
        """Whether positions are a "length" or an "angle"."""
        return self.programme.axis

    @property
    def duration(self) -> float:
        """Duration of the cycle in seconds."""
        return self.programme.period

    @kept_property
    def durations(self) -> tuple[float, ...]:
        """Durations of the segments in seconds; the best ones where they are free."""
        return durations(self.programme, self._wanted)

    @kept_property
    def solutions(self) -> tuple[Solution, ...]:
        """The solution of each motion that was looked for, in order, with its proof; dimensionless."""
        return tuple(solution for _, solution in self._solved)

    @kept_property
    def pieces(self) -> tuple[Piece, ...]:
        """The laws in their places, in order."""
        found = [*self._layout.pieces, *(piece for piece, _ in self._solved)]
        return tuple(sorted(found, key=lambda piece: piece.start))

    @property
    def status(self) -> Status:
        """The worst status of the solutions; optimal where nothing was to be looked for."""
        ranks = (Status.OPTIMAL, Status.LOCAL, Status.INACCURATE)
        return max((one.status for one in self.solutions), key=ranks.index, default=Status.OPTIMAL)

    @kept_property
    def objective(self) -> float:
        """What is minimised, over the whole cycle, in SI units; recomputed from the laws."""
        nu, mean = kind_of(self.minimise)
        if nu == LOADED:
            output = self.minimise.removeprefix("rms ").removeprefix(LOAD)
            return self.load_motion.rms(output) if mean else self.load_motion.peak(output).value
        if nu < 0:
            return self.effort.rms_force if mean else self.effort.peak_force
        if mean:
            squares = sum(piece.duration * piece.mean_square(nu) for piece in self.pieces)
            return float(np.sqrt(squares / self.duration))
        return max(one.peak(nu) for one in self.peaks)

    @kept_property
    def lower_bound(self) -> float | None:
        """What no other optimal laws in the same times can beat; with dry friction, that never turn back."""
        nu, mean = kind_of(self.minimise)
        if nu == LOADED:
            ((piece, solution),) = self._solved
            return solution.lower_bound * abs(piece.stroke)
        if nu < 0:
            return self._force_bound(mean=mean)
        sizes = [(piece.duration, self._bound(piece, solution, nu)) for piece, solution in self._solved]
        known = [(piece.duration, self._size(piece, nu, mean=mean)) for piece in self._layout.pieces]
        if not mean:
            return max(bound for _, bound in sizes + known)
        return reduce(hypot, (bound * float(np.sqrt(time / self.duration)) for time, bound in sizes + known), 0.0)

    def _force_bound(self, *, mean: bool) -> float:
        """The same of forces: those of each law that was looked for, and what other pieces take."""
        drive = self._drive
        if drive is None:
            return 0.0
        spans = zip(self._layout.spans, self._solved, strict=True)
        sizes = [
            (piece.duration, solution.lower_bound * force_unit(span, drive, piece.stroke))
            for span, (piece, solution) in spans
        ]
        for piece in self._layout.pieces:
            taken = effort(drive, [piece], piece.duration)
            sizes.append((piece.duration, taken.rms_force if mean else taken.peak_force))
        if not mean:
            return max(bound for _, bound in sizes)
        return reduce(hypot, (bound * float(np.sqrt(time / self.duration)) for time, bound in sizes), 0.0)

    @kept_property
    def peaks(self) -> tuple[SegmentPeaks, ...]:
        """Least and greatest values in every segment."""
        return tuple(
            SegmentPeaks(one.given.label, start, stop - start, self._extremes(one, start, stop))
            for one, (start, stop) in zip(self.programme.stretches, pairwise(self._layout.starts), strict=True)
        )

    def peak(self, nu: int) -> float:
        """The greatest magnitude of the derivative of order nu over the cycle, up to the jerk, in SI units."""
        order = derivative(nu)
        if order > 3:
            raise InputError(f"nu must be at most 3, the jerk, got {order}")
        return max(one.peak(order) for one in self.peaks)

    @property
    def joints(self) -> tuple[dict[str, Any], ...]:
        """Every joint: its time, and by how much velocity, acceleration and jerk leap there; 0 where they do not."""
        found = []
        for start in self._layout.starts[:-1]:
            leaps = [self._leap(start, nu) for nu in (1, 2, 3)]
            kept = [0.0 if abs(leap) <= JOINED * self.peak(nu) else leap for nu, leap in enumerate(leaps, start=1)]
            found.append({"time": start, "velocity": kept[0], "acceleration": kept[1], "jerk": kept[2]})
        return tuple(found)

    def _leap(self, start: float, nu: int) -> float:
        """By how much a derivative leaps where a segment starts: between pieces, or inside one of several segments."""
        for i, piece in enumerate(self.pieces):
            if piece.start == start:
                return piece.end(nu, 0) - self.pieces[i - 1].end(nu, 1)
        return next(piece.leap(start, nu) for piece in self.pieces if piece.start < start < piece.stop)

    @kept_property
    def load_motion(self) -> RepeatedMotion:
        """What the load does steadily, over time in seconds: its outputs by their names, in SI units.

        Raises
        ------
        InputError
            If the cycle has no load, or it is in resonance with the cycle.

        Examples
        --------
        >>> from optlaws.cycles.asked.segments import Dwell, Return, Rise
        >>> segments = [Rise("30 mm", "120 deg", law="modified sine"), Dwell("60 deg"), Return(law="modified sine")]
        >>> cycle = Cycle(segments, speed="300 rpm", load={"period": "20 ms", "damping": 0.05})
        >>> cycle.load_motion.peak("acceleration").value, cycle.peak(2)
        (70.889663, 37.313710)
        """
        if self._load is None:
            raise InputError("the cycle has no load: give one, such as load={'period': '20 ms', 'damping': 0.05}")
        return self._load.motion(self.pieces)

    @kept_property
    def effort(self) -> Effort:
        """Force or torque and power that the drive takes.

        Raises
        ------
        InputError
            If the cycle has no drive.
        """
        if self._drive is None:
            raise InputError("the cycle has no drive: give one, such as drive={'mass': '2 kg', 'gravity': '20 N'}")
        return effort(self._drive, self.pieces, self.duration)

    def __call__(self, time: Any, nu: int = 0) -> Any:  # noqa: ANN401 - a number for a number, an array for arrays
        """Position (nu 0), velocity, acceleration, jerk at a time in seconds, in SI units; the cycle repeats.

        Raises
        ------
        InputError
            If a time is no finite number.
        """
        times, order = real_times(time), derivative(nu)
        turns = np.floor(times / self.duration)
        within = np.clip(times - turns * self.duration, 0.0, self.duration)
        starts = np.array([piece.start for piece in self.pieces])
        which = np.maximum(np.searchsorted(starts, within, side="right") - 1, 0)
        values = np.empty(times.shape)
        for i, piece in enumerate(self.pieces):
            here = which == i
            values[here] = piece.values(within[here], order)
        moved = sum(one.displacement for one in self.programme.stretches)
        values = values + turns * moved if order == 0 else values
        return values if np.ndim(values) else float(values)

    def at_angle(self, degrees: Any, nu: int = 0) -> Any:  # noqa: ANN401 - as for times
        """The same at an angle of the master, in degrees or a text such as "0.5 rad"; derivatives are by time."""
        turns = quantity(degrees, "angle", "angle") / TURN if isinstance(degrees, str) else real_times(degrees) / 360.0
        return self(turns * self.duration, nu)

    def at(self, speed: Any) -> Cycle:  # noqa: ANN401 - a quantity
        """The same motion at another speed of the master: every law as it is, every duration in proportion.

        Raises
        ------
        InputError
            If the speed is not above 0, or no angular velocity.

        Examples
        --------
        >>> from optlaws.cycles.asked.segments import Return, Rise
        >>> cycle = Cycle([Rise("35 mm", "120 deg"), Return()], speed="200 rpm")
        >>> fast = cycle.at("400 rpm")
        >>> fast.duration, round(fast.peak(2) / cycle.peak(2), 9)
        (0.15, 4.0)
        """
        share = period_of(speed, None) / self.duration
        made: list[CycleSegment] = []
        for one, given, piece in self._by_segment("another speed is given to laws of single segments"):
            time, name = f"{piece.duration * share!r} s", given.label
            if isinstance(given, ConstantVelocity):
                made.append(ConstantVelocity(self._shown(piece.end(1, 0) / share) + "/s", time, name=name))
            elif piece.stroke == 0.0:
                made.append(Dwell(time, name=name))
            elif piece.stroke == one.displacement:
                made.append(Move(self._shown(piece.stroke), time, law=piece.law, name=name))
            else:
                raise InputError(f"{one.where} ends where it begins: give it to a Cycle of its own at the other speed")
        return replace(self, segments=made, speed=None, period=f"{self.duration * share!r} s", limits={})

    def _by_segment(self, why: str) -> Iterator[tuple[Stretch, CycleSegment, Piece]]:
        """Segments with their pieces, where each has one."""
        if len(self.pieces) != len(self.segments):
            raise InputError(f"{why}: take moves in place of free motions that meet")
        return zip(self.programme.stretches, self.segments, self.pieces, strict=True)

    def per_angle(self, degrees: Any, nu: int = 0) -> Any:  # noqa: ANN401 - as for times
        """Derivatives by the master's angle in radians, as cams and controllers take them."""
        return self.at_angle(degrees, nu) * (self.duration / TURN) ** nu

    def cam(self, period: Any, damping: float = 0.0) -> Cycle:  # noqa: ANN401 - a quantity
        """The cycle of the cam that makes an elastic follower's mass move as this cycle says (1.27).

        Each move is corrected by the follower's frequency over its own duration: nu = 2 pi T / T_k. The mass comes to
        rest with each move, so that nothing vibrates in the dwells.

        Parameters
        ----------
        period
            The period T_k of the follower's free vibration, such as "12 ms".
        damping
            Its damping ratio.

        Raises
        ------
        InputError
            If a move is not from rest to rest by a law whose jerk is continuous and 0 at both ends (order 4).

        Examples
        --------
        >>> from optlaws.cycles.asked.segments import Dwell, Move
        >>> moves = [Move("30 mm", "120 deg", law="III(7.2)"), Dwell("60 deg"), Move("-30 mm", law="III(7.2)")]
        >>> round(Cycle(moves, speed="300 rpm").cam("20 ms", damping=0.05).peak(2), 6)
        39.380514
        """
        natural = quantity(period, "time", "follower: period")
        if natural <= 0.0:
            raise InputError(f"follower: period must be above 0, got {period!r}")
        made: list[CycleSegment] = []
        for one, given, piece in self._by_segment("the cam of an elastic follower is made move by move"):
            time = f"{piece.duration!r} s"
            if piece.stroke == 0.0:
                made.append(Dwell(time, name=given.label))
                continue
            try:
                law = polydyne(piece.law, TURN * piece.duration / natural, damping)
            except InputError as error:
                raise InputError(f"{one.where}: {error}") from None
            made.append(Move(self._shown(one.displacement), time, law=law, name=given.label))
        return replace(self, segments=made, speed=None, period=f"{self.duration!r} s")

    def _repr_html_(self) -> str:
        from optlaws.cycles.notebook import cycle_page

        return cycle_page(self)

    @property
    def limits_of_segments(self) -> tuple[dict[int, float], ...]:
        """The limits that each segment was asked to keep, in SI units, by the order of the derivative."""
        return tuple(
            limits_of_stretch(one, self._wanted, self.axis) if is_optimal(one.given) else {}
            for one in self.programme.stretches
        )

    def _shown(self, displacement: float) -> str:
        return f"{displacement!r} {'m' if self.axis == 'length' else 'rad'}"

    def export(
        self,
        to: str,
        *,
        master: Any = "360 deg",  # noqa: ANN401 - a quantity
        unit: str | None = None,
        points: int | str | None = None,
        counts: int | None = None,
        digits: int | None = None,
        decimal: str | None = None,
        interpolation: str | None = None,
        task: str | None = None,
        name: str | None = None,
    ) -> Any:  # noqa: ANN401 - made a layer above
        """The cycle in the format of a controller, with what the controller will run.

        Parameters
        ----------
        to
            The format: `optlaws export --list` names them.
        master
            How far the master goes in a cycle; None for a master that is time in seconds.
        unit
            Of positions; "mm" for lengths and "deg" for angles unless given.
        points, counts, digits, decimal, interpolation, task, name
            As in `MotionLaw.export`.

        Returns
        -------
        An `Export`: its `text`, its `report`, its `run`; `write(file)` writes it.

        Raises
        ------
        InputError
            If there is no such format, it takes no such option, or it cannot hold the motion.

        Examples
        --------
        >>> from optlaws.cycles.asked.segments import Return, Rise
        >>> cycle = Cycle([Rise("35 mm", "0.1 s", law="cycloidal"), Return(law="cycloidal")], period="0.3 s")
        >>> made = cycle.export("rockwell-cam", points=61)
        >>> made.points, round(made.report.ratio(2), 3)
        (61, 1.008)
        """
        said = {"master": master, "unit": unit}
        asked = {"points": points, "counts": counts, "digits": digits, "decimal": decimal}
        return exported("cycle", self, to, said, **asked, interpolation=interpolation, task=task, name=name)

    def polynomials(self, *, master: Any = None, unit: str | None = None, tolerance: float = 1e-9) -> Any:  # noqa: ANN401
        """Times and polynomial coefficients of the cycle, as a `PiecewiseMotion`: `breaks` and `coefficients`.

        Over time in seconds unless a master is given; exact where laws are made of polynomials, else within
        `tolerance`, a share of the greatest stroke, over the whole cycle.

        Raises
        ------
        InputError
            If a quantity is wrong, or a law's derivatives grow without limit.

        Examples
        --------
        >>> from optlaws.cycles.asked.segments import Return, Rise
        >>> cycle = Cycle([Rise("1 m", "1 s", law="cubic"), Return(law="cubic")], period="3 s")
        >>> pieces = cycle.polynomials(unit="m")
        >>> pieces.breaks, [[round(one, 9) for one in row] for row in pieces.coefficients]
        ((0.0, 1.0, 3.0), [[0.0, 0.0, 3.0, -2.0], [1.0, 0.0, -0.75, 0.25]])
        """
        return exported("pieces_of_cycle", self, tolerance, master=master, unit=unit)

    def plot(self, ax: Any = None, **style: Any) -> list[Any]:  # noqa: ANN401 - matplotlib's
        """Draw position, velocity, acceleration and jerk over time, with segments and limits, by matplotlib.

        Parameters
        ----------
        ax
            Four axes, or one for all, where every curve is divided by its peak; a new figure unless given.
        style
            What `Axes.plot` takes, for the curves.

        Returns
        -------
        The artists; `[0].figure` is the figure.

        Raises
        ------
        InputError
            If there are neither one nor four axes.

        Examples
        --------
        >>> from optlaws.cycles.asked.segments import Return, Rise
        >>> cycle = Cycle([Rise("35 mm", "0.1 s", law="cycloidal"), Return(law="cycloidal")], period="0.3 s")
        >>> [one.axes.get_ylabel() for one in cycle.plot()][2]
        'acceleration, m/s²'
        """
        return plotted("cycle", self, ax, **style)

    @kept_property
    def _drive(self) -> Drive | None:
        return None if self.drive is None else read_drive(self.drive, self.axis)

    @kept_property
    def _wanted(self) -> Wanted:
        return Wanted(
            self.minimise,
            read_limits(self.limits, self.axis, "limits"),
            whole(self.order, "order", least=2, most=10),
            whole(self.degree, "degree", most=MOST_DEGREE),
            self._drive,
            self._load,
            read_load_limits(self.limits, self._load),
        )

    @kept_property
    def _load(self) -> Load | None:
        return None if self.load is None else read_load(self.load, self.axis)

    @kept_property
    def _layout(self) -> Layout:
        absolute = self._load is not None and self._load.absolute
        return layout(self.programme, self.durations, whole=self._wanted.of_load, absolute=absolute)

    @kept_property
    def _solved(self) -> tuple[tuple[Piece, Solution], ...]:
        return tuple(solve(span, self._wanted, self.axis) for span in self._layout.spans)

    def _extremes(self, one: Stretch, start: float, stop: float) -> tuple[tuple[Place, Place], ...]:
        piece = next(one for one in reversed(self.pieces) if one.start <= start)
        if isinstance(one.given, Move | Free):
            return tuple(piece.extremes(nu, start, stop) for nu in range(4))
        # straight: what its law has beside is rounding
        low, high = sorted((float(piece.values(np.array([time]), 0)[0]), time) for time in (start, stop))
        speed = (one.displacement / (stop - start), start)
        return (low, high), (speed, speed), ((0.0, start),) * 2, ((0.0, start),) * 2

    def _bound(self, piece: Piece, solution: Solution, nu: int) -> float:
        return solution.lower_bound * self._factor(piece, nu)

    def _size(self, piece: Piece, nu: int, *, mean: bool) -> float:
        constant = piece.law.rms(nu) if mean else piece.law.peak(nu).value
        return constant * self._factor(piece, nu) if piece.stroke else 0.0

    @staticmethod
    def _factor(piece: Piece, nu: int) -> float:
        return abs(piece.stroke) / piece.duration**nu
