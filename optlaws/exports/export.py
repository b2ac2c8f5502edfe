"""An export: the written file, the executed motion, and the law beside it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from math import isfinite
from pathlib import Path
from typing import Any, Protocol

from optlaws.errors import InputError, located
from optlaws.exports.format import Format, Written, format_of
from optlaws.exports.report import Report, TaskSampling, as_run, task_sampling
from optlaws.exports.text import variable_names
from optlaws.files import writing
from optlaws.laws import MotionLaw
from optlaws.motion.motion import Motion, motion_of_law
from optlaws.motion.polynomials import PiecewiseMotion
from optlaws.motion.quantities import QUANTITIES
from optlaws.numbers import Quantity
from optlaws.shown.summary import Row, Summary

Comparison = tuple[str, float | None, float | None, float | None]


class _HasMotion(Protocol):
    """A value whose motion in machine units can be exported, as a cycle is."""

    def motion(self, master: Quantity | None = "360 deg", unit: str | None = None) -> Motion:
        """The exact motion over its master, in units of both."""


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
        run, law, units = self.report.run, self.report.law, self._units()
        means = run.mean_absolute_velocity, law.mean_absolute_velocity
        effective = run.effective_acceleration, law.effective_acceleration
        where = "where it repeats" if self.motion.repeats else "from and to rest"
        moving = list(enumerate(QUANTITIES))[1:]
        rows: list[tuple[str, int, float | None, float | None, float | None]] = [
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
        return [
            (f"{name}, {units[nu]}", _finite(of_run), _finite(of_law), _finite(ratio))
            for name, nu, of_run, of_law, ratio in rows
        ]

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

    def _units(self) -> list[str]:
        units = self.motion.units
        per = units.master if units.rate is None else "s"
        return [units.slave, *(f"{units.slave}/{per}{power}" for power in ("", "²", "³"))]

    def __str__(self) -> str:
        written, rows = self.written, self.rows()
        head = f"{self.format.target}: {written.points} {written.counted}, {written.model}"
        width = max(len(name) for name, *_ in rows)
        table = [("", "run", "law", "run/law"), *((name, *map(_cell, values)) for name, *values in rows)]
        lines = (f"{name:{width}}  {run:>14}  {law:>14}  {ratio:>9}".rstrip() for name, run, law, ratio in table)
        return "\n".join([head, *self.motion.proof, *written.notes, *lines])


def _export(form: Format, motion: Motion, written: Written, task: Quantity | None) -> Export:
    """An export with its reports; `task` is the time of a drive's task, such as "1 ms"."""
    sampling = None if task is None else task_sampling(written.run, motion, task)
    return Export(form, motion, written, as_run(written.run, motion, written.bound, written.roundings), sampling)


def export_motion(motion: Motion, to: Any, *, task: Quantity | None = None, **options: Any) -> Export:
    """A motion in a format, which checks its options."""
    form = format_of(to)
    return _export(form, motion, form.write(motion, form.request(**options)), task)


def export_law(
    law: MotionLaw, to: Any, placement: dict[str, Any], proof: tuple[str, ...] = (), **options: Any
) -> Export:
    """A law with its stroke, time and master, as `motion_of_law` takes them, in a format; `proof` heads it."""
    form = format_of(to)
    return export_motion(replace(motion_of_law(law, **placement), proof=proof), form.name, **options)


def export_cycle(cycle: _HasMotion, to: Any, placement: dict[str, Any], **options: Any) -> Export:
    """A cycle with its master and unit, as `Cycle.motion` takes them, in a format, which is checked before laws are."""
    form = format_of(to)
    return export_motion(cycle.motion(**placement), form.name, **options)


def export_axes(
    axes: Mapping[str, _HasMotion], to: Mapping[str, Any], placement: dict[str, Any], **options: Any
) -> dict[str, Export]:
    """Axes in formats by their names, each under a name of its own."""
    names, exports = variable_names(axes), {}
    for axis, form in to.items():
        with located(f"axis {axis}"):
            exports[axis] = export_cycle(axes[axis], form, placement, **options, name=names[axis])
    return exports


def export_together(
    axes: Mapping[str, _HasMotion], to: Any, placement: dict[str, Any], *, task: Quantity | None = None, **options: Any
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
    return {axis: _export(form, motions[name], written[name], task) for axis, name in names.items()}


def _finite(value: float | None) -> float | None:
    return value if value is not None and isfinite(value) else None


def _ratio(run: float, law: float) -> float | None:
    return run / law if law > 0.0 else None


def _cell(value: float | None) -> str:
    return "-" if value is None else format(value, ".7g")
