"""An export: the written file, the executed motion, and its peaks, jumps, deviation and travel beside the law."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, astuple, dataclass, replace
from math import floor, inf, isfinite, nan
from typing import Any, cast

import numpy as np

from optlaws.echo import shortened
from optlaws.errors import InputError, located
from optlaws.exports.format import Format, Written, format_of
from optlaws.exports.text import TextFile, variable_names
from optlaws.laws import MotionLaw
from optlaws.motion.motion import Motion, motion_of_law
from optlaws.motion.polynomials import Extreme, PiecewiseMotion
from optlaws.motion.quantities import QUANTITIES, quantity
from optlaws.numbers import MOST_VALUES, Array, NumberOrQuantity
from optlaws.numerics import bernstein
from optlaws.shown.summary import Row, Summary

_NAMES = ("Position", "Velocity", "Acceleration", "Jerk")
ORDERS = range(4)
#: of a motion that is sampled: its second differences need some
_FEWEST_TASKS = 4
#: of the stroke, and of the acceleration of the law: an executed motion that is farther off or has more is warned of
_FAR_OFF, _FAR_MORE = 0.01, 1.2
ROUNDING = 1e-9, 2.0**-46  # jumps below these shares, of the peak and of what positions leave, are rounding


@dataclass(frozen=True)
class Characteristics:
    """Characteristics of a cam, those that TwinCAT computes (CamCharacteristics) and its jumps beside them.

    Slave values are by the second where it is known how fast the master goes, else by the master's unit.

    Parameters
    ----------
    start, end
        Position, velocity, acceleration and jerk at both ends, inside the motion.
    least, greatest
        Of each of the four, with the master's position; no impulses: `jumps` has them.
    mean_absolute_velocity, effective_acceleration
        Mean magnitude of the velocity; root mean square of the acceleration.
    jumps, jumps_at_ends
        The greatest jumps of velocity, acceleration and jerk: inside; and where the motion begins again or, if it does
        not, where rest comes before and after it.
    """

    start: tuple[float, ...]
    end: tuple[float, ...]
    least: tuple[Extreme, ...]
    greatest: tuple[Extreme, ...]
    mean_absolute_velocity: float
    effective_acceleration: float
    jumps: tuple[Extreme, ...]
    jumps_at_ends: tuple[float, ...]

    def peak(self, nu: int) -> float:
        """The greatest magnitude of the derivative of order nu; inf where a lower one jumps inside."""
        if any(jump.value for jump in self.jumps[: max(nu - 1, 0)]):
            return inf
        return max(abs(self.least[nu].value), abs(self.greatest[nu].value))

    def results(self) -> dict[str, Any]:
        """The characteristics by TwinCAT's names, as plain data; what is infinite is null."""
        data: dict[str, Any] = {"StartPoint": _end(self.start), "EndPoint": _end(self.end)}
        for side, extremes in (("Min", self.least), ("Max", self.greatest)):
            for name, extreme in zip(_NAMES, extremes, strict=True):
                data[f"PointAt{side}Slave{name}"] = _point(name, extreme)
        data["SlaveMeanAbsoluteVelocity"] = self.mean_absolute_velocity
        data["SlaveEffectiveAcceleration"] = finite_or_none(self.effective_acceleration)
        for name, extreme, end in zip(_NAMES[1:], self.jumps, self.jumps_at_ends, strict=True):
            data[f"Jump{name}"] = _point(name, extreme)
            data[f"JumpAtEnds{name}"] = finite_or_none(end)
        return data


@dataclass(frozen=True)
class Report:
    """The motion that the controller runs beside the law, both in machine units.

    Parameters
    ----------
    run, law
        Their characteristics.
    deviation
        The greatest difference of position, velocity and acceleration, each with the master's position; inf for a
        derivative that one of the two does not have everywhere.
    rate
        Units of the master that pass in a second; 1 where it is not known, and slave values are by the master.
    bound
        What the rounding of positions may add to the peak of the acceleration.

    Examples
    --------
    >>> from optlaws.numerics.splines import spline_powers
    >>> from optlaws.motion.motion import motion_of_law
    >>> from optlaws import smoothstep
    >>> motion = motion_of_law(smoothstep(3), stroke="35 mm", duration="0.1 s")
    >>> x = np.linspace(0.0, 0.1, 13)
    >>> report = as_run(PiecewiseMotion(x, spline_powers(x, motion(x))), motion)
    >>> round(report.ratio(2), 4), round(report.deviation[0].value, 6), round(report.run.jumps_at_ends[1], 3)
    (0.9923, 0.00154, 701.101)
    """

    run: Characteristics
    law: Characteristics
    deviation: tuple[Extreme, ...]
    rate: float
    bound: float

    def ratio(self, nu: int) -> float:
        """Peak of the run over the law's; inf where a lower derivative of the run jumps, nan where the law has none."""
        whole = self.law.peak(nu)
        return self.run.peak(nu) / whole if whole > 0.0 and isfinite(whole) else nan

    def results(self) -> dict[str, Any]:
        """The report as plain data; what is infinite or unknown is null."""
        return {
            "NominalMasterVelocity": self.rate,
            "run": self.run.results(),
            "law": self.law.results(),
            "ratio": {name: finite_or_none(self.ratio(nu)) for nu, name in enumerate(_NAMES) if nu},
            "deviation": {name: _point(name, extreme) for name, extreme in zip(_NAMES, self.deviation, strict=False)},
            "rounding_bound_acceleration": self.bound,
        }


def as_run(run: PiecewiseMotion, motion: Motion, bound: float = 0.0, roundings: tuple[float, ...] = ()) -> Report:
    """The report of an execution by the master: every number is an extreme over the whole motion, not over a grid.

    Roundings may add `bound` to the acceleration; jumps of velocity, acceleration and jerk up to `roundings` are such
    where the law has none.
    """
    rate = motion.units.rate or 1.0
    law = _characteristics(motion, motion, rate, ((0.0,) * 4,) * 2)
    height, step = run.peak(0).value, float(run.lengths.min())
    floors = [ROUNDING[1] * height * (rate / step) ** nu for nu in ORDERS]
    known = [limit * rate**nu for nu, limit in enumerate((0.0, *(roundings or (0.0,) * 3)))]
    of_inside, of_ends = (
        [max(least, 0.0 if jump else most) for least, jump, most in zip(floors, (0.0, *jumps), known, strict=True)]
        for jumps in ([jump.value for jump in law.jumps], law.jumps_at_ends)
    )

    def meant(x: Array, nu: int) -> Array:
        # beyond its ends, which the master may pass by rounding, the motion continues
        return np.asarray(motion(np.clip(x, motion.start, motion.stop), nu))

    deviation = tuple(
        _sized(run.deviation(meant, nu, motion.breaks), rate**nu)
        if isfinite(law.peak(nu))
        else Extreme(inf, motion.start)
        for nu in ORDERS[:3]
    )
    return Report(_characteristics(run, motion, rate, (of_inside, of_ends)), law, deviation, rate, bound * rate**2)


def _characteristics(
    side: Motion | PiecewiseMotion, motion: Motion, rate: float, floors: tuple[Sequence[float], Sequence[float]]
) -> Characteristics:
    """The characteristics of the law, which is the motion, or of its run; jumps up to floors are rounding."""
    extremes = [tuple(_sized(each, rate**nu) for each in side.extremes(nu)) for nu in ORDERS]
    start, end = (tuple(rate**nu * float(np.ravel(side.ends(nu)[i])[-i]) for nu in ORDERS) for i in (0, 1))
    inside, at_ends = (
        [
            max(ROUNDING[0] * max(abs(low.value), abs(high.value)), least)
            for (low, high), least in zip(extremes, of_place, strict=True)
        ]
        for of_place in floors
    )
    if isinstance(side, Motion):
        jumps, travel = tuple(_sized(side.jump(nu), rate**nu) for nu in ORDERS[1:]), travel_of_law(side)
    else:
        jumps, travel = tuple(_jump(side, nu, rate, inside[nu]) for nu in ORDERS[1:]), travel_of_run(side)
    low, high = (tuple(pair[i] for pair in extremes) for i in (0, 1))
    changes = (abs(b - a) if motion.repeats else max(abs(a), abs(b)) for a, b in zip(start, end, strict=True))
    _, *changed = (change if change > least else 0.0 for change, least in zip(changes, at_ends, strict=True))
    effective = inf if jumps[0].value else rate**2 * side.rms(2)
    return Characteristics(
        start, end, low, high, rate * travel / (side.stop - side.start), effective, jumps, tuple(changed)
    )


def _jump(run: PiecewiseMotion, nu: int, rate: float, small: float) -> Extreme:
    jumps = np.abs(run.jumps(nu)) * rate**nu
    if not jumps.size or jumps.max() <= small:
        return Extreme(0.0, run.start)
    return Extreme(float(jumps.max()), run.breaks[1 + int(jumps.argmax())])


def _sized(extreme: tuple[float, float], factor: float) -> Extreme:
    return Extreme(extreme[0] * factor, extreme[1])


def finite_or_none(value: float | None) -> float | None:
    """A number, which is null in plain data where it is infinite."""
    return value if value is not None and isfinite(value) else None


def _point(name: str, extreme: Extreme) -> dict[str, float | None]:
    return {"MasterPosition": extreme.x, f"Slave{name}": finite_or_none(extreme.value)}


def _end(values: tuple[float, ...]) -> dict[str, float | None]:
    return {f"Slave{name}": finite_or_none(value) for name, value in zip(_NAMES, values, strict=True)}


_CUTS = 9  # in eight: the way is of second order in the length that is left


def travel_of_run(run: PiecewiseMotion) -> float:
    """The total travel of a motion of polynomials, cut where the velocity may change its sign.

    Where all Bernstein coefficients of it have one sign it does not.
    """
    table, lengths, way = run.powers(1), run.lengths, 0.0
    control = bernstein.from_powers(table * lengths[:, None] ** np.arange(table.shape[1]))
    for cut in range(_CUTS + 1):
        turning = (control.min(axis=1) < 0.0) & (control.max(axis=1) > 0.0) & (cut < _CUTS)
        way += float(np.abs(control.mean(axis=1) * lengths)[~turning].sum())
        if not turning.any():
            break
        control = bernstein.in_parts(control[turning])
        lengths = np.repeat(lengths[turning] / bernstein.PARTS, bernstein.PARTS)
    return way


def travel_of_law(motion: Motion) -> float:
    """The total travel of a motion of laws, which turn where their direction changes."""
    turns = ([piece.start, *piece.turns, piece.stop] for piece in motion.pieces)
    ways = (np.diff(piece.values(np.array(x), 0)) for piece, x in zip(motion.pieces, turns, strict=True))
    return float(sum(np.abs(way).sum() for way in ways))


@dataclass(frozen=True)
class TaskSampling:
    """The sampled run: the time of a task in seconds, and the greatest second difference of positions over it."""

    seconds: float
    acceleration: float


def task_sampling(run: PiecewiseMotion, motion: Motion, task: NumberOrQuantity) -> TaskSampling:
    """The run sampled once in a task, such as "1 ms": second differences of the positions, both ends included.

    Before and after a motion of one shot there is rest; a cycle goes on with itself.
    """
    seconds = quantity(task, "time", "task")
    if motion.units.rate is None:
        raise InputError("task: how fast the master goes is not known: say how long the motion takes, duration='0.1 s'")
    step = seconds * motion.units.rate
    if not _FEWEST_TASKS * step <= motion.length <= MOST_VALUES * step:
        longest, shortest = (motion.length / motion.units.rate / count for count in (_FEWEST_TASKS, MOST_VALUES))
        raise InputError(
            f"task must be between {shortest:.3g} s and {longest:.3g} s, so that the motion has {_FEWEST_TASKS} to "
            f"{MOST_VALUES} of them, got {shortened(task)}"
        )
    count = floor(motion.length / step * (1.0 + 1e-12))
    y = np.asarray(run(np.minimum(run.start + step * np.arange(count + 1), run.stop)))
    last = float(run.ends(0)[1][-1])
    if motion.repeats:
        again = motion.advance + run(np.clip(step * np.arange(count + 1, count + 3) - motion.length, 0.0, None))
        sampled = np.concatenate([y, again])
    else:
        sampled = np.concatenate([y[:1], y[:1], y, [last, last]])
    return TaskSampling(seconds, float(np.abs(np.diff(sampled, 2)).max()) / seconds**2)


Comparison = tuple[str, float | None, float | None, float | None]


@dataclass(frozen=True)
class Export(TextFile):
    """A motion in the format of a controller, with a report of the executed motion.

    Parameters
    ----------
    format
        The format.
    motion
        What was exported.
    written
        The text, and the motion as the controller interpolates it.
    report
        Peaks, jumps and deviation of that motion, beside the law's.
    task
        The run as the drive samples it, where the time of a task is given.

    Examples
    --------
    >>> from optlaws import smoothstep
    >>> export = smoothstep(3).export("codesys-xyva", stroke="35 mm", master="120 deg", duration="0.1 s", points=7)
    >>> export.text.splitlines()[6:8]
    ['        (dX := 0.0, dY := 0.0, dV := 0.0, dA := 0.0),', '        (dX := 20.0, dY := 1.24228395...
    >>> round(export.report.ratio(2), 6)
    1.0
    """

    format: Format
    motion: Motion
    written: Written
    report: Report
    task: TaskSampling | None = None

    @property
    def text(self) -> str:
        """The text of the exported file."""
        return self.written.text

    @property
    def run(self) -> PiecewiseMotion:
        """The motion as the controller interpolates it, by the master."""
        return self.written.run

    @property
    def points(self) -> int:
        """How many points or segments there are."""
        return self.written.points

    @property
    def warnings(self) -> tuple[str, ...]:
        """That the executed motion is far off the law, or accelerates far more, and what to do; empty where it is not.

        Examples
        --------
        >>> from optlaws import smoothstep
        >>> smoothstep(3).export("codesys-xy", stroke="35 mm", master="120 deg", points=3).warnings
        ('the executed motion is up to 1.88 mm off the law, 5.4 % of its stroke: take more points, or a format ...',)
        """
        off, stroke, more = self.report.deviation[0].value, self.motion.stroke, self.report.ratio(2)
        far = []
        if off > _FAR_OFF * stroke:
            share = f"{off:.3g} {self.motion.units.slave} off the law, {100.0 * off / stroke:.2g} % of its stroke"
            far.append(f"is up to {share}")
        if _FAR_MORE < more < inf:
            far.append(f"has {more:.3g} times the acceleration of the law")
        remedy = "take more points, or a format whose points are the joints of the motion, such as codesys-xyva"
        if self.report.bound > (_FAR_MORE - 1.0) * self.report.law.peak(2):
            remedy = "take fewer points, whose rounding is less, or leave out how many"
        return (f"the executed motion {' and '.join(far)}: {remedy}",) if far else ()

    def plot(self, ax: Any = None, **style: Any) -> list[Any]:
        """Draw the motion and the executed motion over the master, down to the jerk, and the difference beside them.

        `ax` are four axes of matplotlib for the motions alone, or four rows of two, new ones unless given; `style` is
        what `Axes.plot` takes, for the run. Returns the artists.

        Examples
        --------
        >>> from optlaws import smoothstep
        >>> export = smoothstep(3).export("codesys-xy", stroke="35 mm", master="120 deg", duration="0.1 s", points=9)
        >>> [artist.get_label() for artist in export.plot()[:2]]
        ['as designed', 'as executed']
        """
        from optlaws.plots.moves import draw_export

        return draw_export(self, ax, **style)

    def results(self) -> dict[str, Any]:
        """The export as plain data: everything but the text."""
        written = self.written
        return {
            "format": self.format.name,
            "target": self.format.target,
            "model": written.model,
            written.counted: written.points,
            "resolution": written.resolution,
            "notes": [*self.warnings, *self.motion.proof, *written.notes],
            "units": {"master": self.motion.units.master, "slave": self.motion.units.slave},
            "IsPeriodic": self.motion.repeats,
            **self.report.results(),
            "task": None if self.task is None else asdict(self.task),
        }

    def rows(self) -> list[Comparison]:
        """The report as rows: a quantity with its unit, its executed value, the law's value, and their ratio."""
        run, law, (master, slave, rate) = self.report.run, self.report.law, astuple(self.motion.units)
        units = [slave, *(f"{slave}/{master if rate is None else 's'}{power}" for power in ("", "²", "³"))]
        means = run.mean_absolute_velocity, law.mean_absolute_velocity
        effective = run.effective_acceleration, law.effective_acceleration
        where = "at the repeat" if self.motion.repeats else "at the ends"
        moving = list(enumerate(QUANTITIES))[1:]
        rows: list[tuple[Any, ...]] = [
            *((f"peak of {name}", nu, run.peak(nu), law.peak(nu), self.report.ratio(nu)) for nu, name in moving),
            ("effective acceleration", 2, *effective, _ratio(*effective)),
            ("mean absolute velocity", 1, *means, _ratio(*means)),
            *((f"jump of {q} inside", n, run.jumps[n - 1].value, law.jumps[n - 1].value, None) for n, q in moving),
            *((f"jump of {q} {where}", n, run.jumps_at_ends[n - 1], law.jumps_at_ends[n - 1], None) for n, q in moving),
            *(
                (f"greatest deviation of {QUANTITIES[n]}", n, d.value, None, None)
                for n, d in enumerate(self.report.deviation)
            ),
        ]
        if self.report.bound:
            rows.append(("rounding adds at most", 2, self.report.bound, None, None))
        if self.task is not None:
            sampled = self.task.acceleration, law.peak(2)
            name = f"acceleration by positions every {1e3 * self.task.seconds:g} ms"
            rows.append((name, 2, *sampled, _ratio(*sampled)))
        finite = [(f"{name}, {units[nu]}", *map(finite_or_none, values)) for name, nu, *values in rows]
        return cast("list[Comparison]", finite)

    def summary(self) -> Summary:
        """The executed motion as rows, with the law's values as notes.

        Examples
        --------
        >>> from optlaws import smoothstep
        >>> export = smoothstep(3).export("codesys-xyva", stroke="35 mm", master="120 deg", duration="0.1 s", points=7)
        >>> row = export.summary()[3]
        >>> row.name, row.text(5), row.unit, row.note
        ('peak of acceleration', '20207', 'mm/s²', 'of the law 20207.26')
        """
        written = self.written
        rows = [Row("format", self.format.name, note=written.model), Row(written.counted, written.points)]
        for text, run, law, _ in self.rows():
            name, unit = text.rsplit(", ", 1)
            rows.append(Row(name, run, unit, note="" if law is None else f"of the law {law:.7g}"))
        notes = [("warning", self.warnings), ("note", (*self.motion.proof, *written.notes))]
        return Summary([*rows, *(Row(kind, text) for kind, texts in notes for text in texts)])

    def __str__(self) -> str:
        written, rows = self.written, self.rows()
        head = f"{self.format.target}: {written.points} {written.counted}, {written.model}"
        width = max(len(name) for name, *_ in rows)
        table = [
            ("", "run", "law", "run/law"),
            *((name, *("-" if value is None else format(value, ".7g") for value in values)) for name, *values in rows),
        ]
        lines = (f"{name:{width}}  {run:>14}  {law:>14}  {ratio:>9}".rstrip() for name, run, law, ratio in table)
        warnings = [f"warning: {warning}" for warning in self.warnings]
        return "\n".join([head, *warnings, *self.motion.proof, *written.notes, *lines])


def export_motion(
    motion: Motion, to: Any, *, task: NumberOrQuantity | None = None, written: Written | None = None, **options: Any
) -> Export:
    """A motion in a format, which checks its options, with its reports; `task` is the time of a drive's task."""
    form = format_of(to)
    written = form.write(motion, form.request(**options)) if written is None else written
    sampling = None if task is None else task_sampling(written.run, motion, task)
    return Export(form, motion, written, as_run(written.run, motion, written.bound, written.roundings), sampling)


def export_law(
    law: MotionLaw, to: Any, placement: dict[str, Any], proof: tuple[str, ...] = (), **options: Any
) -> Export:
    """A law with its stroke, time and master, as `motion_of_law` takes them, in a format; `proof` heads it."""
    format_of(to)  # is checked before the motion is
    return export_motion(replace(motion_of_law(law, **placement), proof=proof), to, **options)


def export_cycle(cycle: Any, to: Any, placement: dict[str, Any], **options: Any) -> Export:
    """A cycle, or what else has a motion, with its master and unit as `Cycle.motion` takes them, in a format."""
    format_of(to)  # is checked before laws are
    return export_motion(cycle.motion(**placement), to, **options)


def export_axes(
    axes: Mapping[str, Any], to: Mapping[str, Any], placement: dict[str, Any], **options: Any
) -> dict[str, Export]:
    """Axes in formats by their names, each under a name of its own."""
    names, exports = variable_names(axes), {}
    for axis, form in to.items():
        with located(f"axis {axis}"):
            exports[axis] = export_cycle(axes[axis], form, placement, **options, name=names[axis])
    return exports


def export_together(
    axes: Mapping[str, Any], to: Any, placement: dict[str, Any], *, task: NumberOrQuantity | None = None, **options: Any
) -> dict[str, Export]:
    """Axes in a single file, for formats that hold several: all exports share the text."""
    form = format_of(to)
    if form.write_joints is None:
        raise InputError(
            f"a file of the format {form.name} holds one axis: leave `together` out, or take 'ros2' or 'csv'"
        )
    names = variable_names(axes)
    motions = {names[axis]: cycle.motion(**placement) for axis, cycle in axes.items()}
    written = form.write_joints(motions, form.request(**options))
    return {axis: export_motion(motions[name], to, task=task, written=written[name]) for axis, name in names.items()}


def _ratio(run: float, law: float) -> float | None:
    return run / law if law > 0.0 else None
