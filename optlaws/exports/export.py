"""An export: what was written, what the controller will run, and the law beside it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import isfinite
from pathlib import Path
from typing import Any

from optlaws.cycles.cycle import Cycle
from optlaws.exporting import exports
from optlaws.exports.at_task import AtTask, at_task
from optlaws.exports.format import Format, Written, format_of
from optlaws.exports.motion import Motion, motion_of_cycle, motion_of_law
from optlaws.exports.polynomials import PiecewiseMotion
from optlaws.exports.report import QUANTITIES, Report, as_run
from optlaws.files import writing
from optlaws.laws import MotionLaw
from optlaws.synthesis.solution import Solution

Row = tuple[str, float | None, float | None, float | None]

_NAMES = [quantity.lower() for quantity in QUANTITIES]


@dataclass(frozen=True)
class Export:
    """A motion in the format of a controller, with what the controller will run.

    Parameters
    ----------
    format
        The format.
    motion
        What was exported.
    written
        The text, and the motion as the controller interpolates it.
    report
        Peaks, leaps and deviation of that motion, beside the law's.
    task
        What a drive hears of it once in a task, where one is given.

    Examples
    --------
    >>> from optlaws.laws import smoothstep
    >>> made = smoothstep(3).export("codesys-xyva", stroke="35 mm", master="120 deg", time="0.1 s", points=7)
    >>> made.text.splitlines()[6:8]
    ['        (dX := 0.0, dY := 0.0, dV := 0.0, dA := 0.0),', '        (dX := 20.0, dY := 1.24228395...
    >>> round(made.report.ratio(2), 6)
    1.0
    """

    format: Format
    motion: Motion
    written: Written
    report: Report
    task: AtTask | None = None

    @property
    def text(self) -> str:
        """What the file holds."""
        return self.written.text

    @property
    def run(self) -> PiecewiseMotion:
        """The motion as the controller interpolates it, by the master."""
        return self.written.run

    @property
    def points(self) -> int:
        """How many points or segments there are."""
        return self.written.points

    def write(self, file: str | Path) -> Path:
        """Write the file, whole or not at all; one that is there and says something else is kept as NAME.orig.

        Raises
        ------
        InputError
            If the name is none for a file.
        """
        return writing.write_any(Path(file), self.text)

    def to_dict(self) -> dict[str, Any]:
        """What the command tells a program: everything but the text."""
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
            **self.report.to_dict(),
            "task": None
            if self.task is None
            else {"seconds": self.task.seconds, "acceleration": self.task.acceleration},
        }

    def rows(self) -> list[Row]:
        """The report as rows: what it is with its unit, of the run, of the law, and the ratio; None for none."""
        run, law, units = self.report.run, self.report.law, self._units()
        means = run.mean_absolute_velocity, law.mean_absolute_velocity
        effective = run.effective_acceleration, law.effective_acceleration
        where = "where it repeats" if self.motion.repeats else "from and to rest"
        moving = [(nu, f"{_NAMES[nu]}", units[nu]) for nu in (1, 2, 3)]
        rows: list[Row] = [
            *(
                (f"peak of {name}, {unit}", run.peak(nu), law.peak(nu), self.report.ratio(nu))
                for nu, name, unit in moving
            ),
            (f"effective acceleration, {units[2]}", *effective, _ratio(*effective)),
            (f"mean absolute velocity, {units[1]}", *means, _ratio(*means)),
            *(
                (f"leap of {name} inside, {unit}", run.leaps[nu - 1].value, law.leaps[nu - 1].value, None)
                for nu, name, unit in moving
            ),
            *(
                (f"leap of {name} {where}, {unit}", run.leaps_at_ends[nu - 1], law.leaps_at_ends[nu - 1], None)
                for nu, name, unit in moving
            ),
            *(
                (f"greatest deviation of {_NAMES[nu]}, {units[nu]}", extreme.value, None, None)
                for nu, extreme in enumerate(self.report.deviation)
            ),
        ]
        if self.report.bound:
            rows.append((f"roundings may add, {units[2]}", self.report.bound, None, None))
        if self.task is not None:
            heard, whole = self.task.acceleration, law.peak(2)
            rows.append(
                (
                    f"acceleration heard every {1e3 * self.task.seconds:g} ms, {units[2]}",
                    heard,
                    whole,
                    _ratio(heard, whole),
                )
            )
        return [(name, _finite(of_run), _finite(of_law), _finite(ratio)) for name, of_run, of_law, ratio in rows]

    def _units(self) -> list[str]:
        units = self.motion.units
        per = units.master if units.rate is None else "s"
        return [units.slave, *(f"{units.slave}/{per}{power}" for power in ("", "²", "³"))]

    def __str__(self) -> str:
        written = self.written
        lines = [
            f"{self.format.target}: {written.points} {written.counted}, {written.model}",
            *self.motion.proof,
            *written.notes,
        ]
        width = max(len(name) for name, *_ in self.rows())
        lines.append(f"{'':{width}}  {'run':>14}  {'law':>14}  {'run/law':>9}")
        for name, run, law, ratio in self.rows():
            cells = [_cell(run, 14), _cell(law, 14), _cell(ratio, 9)]
            lines.append(f"{name:{width}}  {'  '.join(cells)}".rstrip())
        return "\n".join(lines)


@exports("motion")
def export_motion(motion: Motion, to: Any, *, task: Any = None, **asked: Any) -> Export:  # noqa: ANN401
    """A motion in a format, which checks what is asked; `task` is the time of a drive's task, such as "1 ms".

    Raises
    ------
    InputError
        If there is no such format, it takes no such option, or it cannot hold the motion.
    """
    chosen = format_of(to)
    written = chosen.write(motion, chosen.request(**asked))
    heard = None if task is None else at_task(written.run, motion, task)
    return Export(chosen, motion, written, as_run(written.run, motion, written.bound, written.roundings), heard)


@exports("law")
def export_law(law: MotionLaw, to: Any, said: dict[str, Any], **asked: Any) -> Export:  # noqa: ANN401
    """A law with its stroke, time and master, as `motion_of_law` takes them, in a format."""
    chosen = format_of(to)
    return export_motion(motion_of_law(law, **said), chosen.name, **asked)


@exports("solution")
def export_solution(solution: Solution, to: Any, said: dict[str, Any], **asked: Any) -> Export:  # noqa: ANN401
    """A solution's law as `export_law` takes one; the file and the report say what is proven of it."""
    best = f"least {solution.problem.minimise} = {solution.objective:.9g}"
    proof = f"law: {best}, none below {solution.lower_bound:.9g} in its space; status {solution.status.value}"
    chosen = format_of(to)
    return export_motion(replace(motion_of_law(solution.law, **said), proof=(proof,)), chosen.name, **asked)


@exports("cycle")
def export_cycle(cycle: Cycle, to: Any, said: dict[str, Any], **asked: Any) -> Export:  # noqa: ANN401
    """A cycle with its master, as `motion_of_cycle` takes it, in a format."""
    chosen = format_of(to)
    return export_motion(motion_of_cycle(cycle, **said), chosen.name, **asked)


def _finite(value: float | None) -> float | None:
    return value if value is not None and isfinite(value) else None


def _ratio(run: float, law: float) -> float | None:
    return run / law if law > 0.0 else None


def _cell(value: float | None, width: int) -> str:
    return f"{'-' if value is None else format(value, '.7g'):>{width}}"
