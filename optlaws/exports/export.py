"""An export: the written file, the executed motion, and the law beside it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, astuple, dataclass, replace
from pathlib import Path
from typing import Any, cast

from optlaws.errors import InputError, located
from optlaws.exports.format import Format, Written, format_of
from optlaws.exports.report import Report, TaskSampling, as_run, finite_or_none, task_sampling
from optlaws.exports.text import variable_names
from optlaws.files import writing
from optlaws.laws import MotionLaw
from optlaws.motion.motion import Motion, motion_of_law
from optlaws.motion.polynomials import PiecewiseMotion
from optlaws.motion.quantities import QUANTITIES
from optlaws.numbers import Quantity
from optlaws.shown.summary import Row, Summary

Comparison = tuple[str, float | None, float | None, float | None]


@dataclass(frozen=True)
class Export:
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

    def write(self, file: str | Path, *, force: bool = False) -> Path:
        """Write the file, completely or not at all.

        Raises
        ------
        InputError
            If it is there with other contents, and these are not to be replaced (`force`).
        """
        return writing.write(Path(file), self.text, exact=True, force=force)

    def plot(self, ax: Any = None, **style: Any) -> list[Any]:
        """Draw the motion and the executed motion over the master, down to the jerk; return the artists.

        `ax` are four axes of matplotlib, new ones unless given; `style` is what `Axes.plot` takes, for the run.

        Examples
        --------
        >>> from optlaws import smoothstep
        >>> export = smoothstep(3).export("codesys-xy", stroke="35 mm", master="120 deg", duration="0.1 s", points=9)
        >>> [artist.get_label() for artist in export.plot()[:2]]
        ['as designed', 'as run']
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
            "notes": [*self.motion.proof, *written.notes],
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
        where = "where it repeats" if self.motion.repeats else "from and to rest"
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
            rows.append(("roundings may add", 2, self.report.bound, None, None))
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
        return Summary([*rows, *(Row("note", note) for note in (*self.motion.proof, *written.notes))])

    def _repr_html_(self) -> str:
        return self.summary()._repr_html_()

    def __str__(self) -> str:
        written, rows = self.written, self.rows()
        head = f"{self.format.target}: {written.points} {written.counted}, {written.model}"
        width = max(len(name) for name, *_ in rows)
        table = [
            ("", "run", "law", "run/law"),
            *((name, *("-" if value is None else format(value, ".7g") for value in values)) for name, *values in rows),
        ]
        lines = (f"{name:{width}}  {run:>14}  {law:>14}  {ratio:>9}".rstrip() for name, run, law, ratio in table)
        return "\n".join([head, *self.motion.proof, *written.notes, *lines])


def export_motion(
    motion: Motion, to: Any, *, task: Quantity | None = None, written: Written | None = None, **options: Any
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
    axes: Mapping[str, Any], to: Any, placement: dict[str, Any], *, task: Quantity | None = None, **options: Any
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
