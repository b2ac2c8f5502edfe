"""The command `optlaws export`: a law or a cycle in a controller's format, and the executed motion."""

from __future__ import annotations

import sys
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

from optlaws.cli.options import (
    WHOLE_TABLE,
    AsJson,
    Duration,
    Plot,
    Signed,
    TableOptions,
    Whole,
    check_files,
    read_law,
    save_picture,
)
from optlaws.cli.show import print_json, show, table
from optlaws.errors import InputError

if TYPE_CHECKING:
    from optlaws.exports.export import Export
    from optlaws.motion.motion import Motion

BEST = "best"


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class MotionOptions:
    """The motion of a law in its machine, or the axis of a problem file.

    Parameters
    ----------
    stroke
        How far the slave moves, such as "35 mm" or "-20 deg": positions are in its unit. Of a law alone.
    duration
        How long it takes, such as "0.1 s". Of a law alone.
    master
        How far the master goes, "120 deg"; without it the master of a law is time in seconds, that of a cycle 360 deg.
    start
        Position of the slave at the start; 0 unless given. Of a law alone.
    axis
        Which axis of a problem file with several.
    """

    stroke: Signed = None
    duration: Duration = None
    master: str | None = None
    start: str | None = None
    axis: str | None = None


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class FormatOptions:
    """Options of exports; each format accepts some of them.

    Parameters
    ----------
    points
        How many points or pieces; chosen unless given: of points, as with "best", for the least peak acceleration of
        the run, of polynomials the fewest that are near enough.
    counts
        Steps of the slave's encoder over the stroke, to which positions are rounded.
    digits
        Digits behind the decimal sign, of tables as text.
    decimal
        The decimal sign of tables as text: "." or ",".
    interpolation
        The interpolation of the controller, where the format can state it.
    task
        Time of the drive's task, such as "1 ms": the report gives what the drive reads in each.
    name
        Of the variable, the table or the joint.
    plot
        Draw the motion and what the controller runs into this file, PNG or SVG.
    """

    points: str | None = None
    counts: Whole | None = None
    digits: Whole | None = None
    decimal: str | None = None
    interpolation: str | None = None
    task: str | None = None
    name: str | None = None
    plot: Plot = None


_MOTION, _FORMAT = MotionOptions(), FormatOptions()


def export(
    law: str | None = None,
    /,
    *,
    to: str | None = None,
    listed: Annotated[bool, Parameter(name="--list")] = False,
    motion: MotionOptions = _MOTION,
    options: FormatOptions = _FORMAT,
    points: TableOptions = WHOLE_TABLE,
    output: Path | None = None,
    as_json: AsJson = False,
) -> None:
    """Write a law or a cycle in the format of a controller, and report the motion that the controller executes.

    The file goes to --output or, without it, to stdout and the report to stderr.

    Parameters
    ----------
    law
        A law by its name or file, or a problem file of the job "cycle" (.toml).
    to
        The format; --list shows all formats.
    listed
        List the formats: who takes them, how it interpolates, what it cannot hold.
    output
        The file to write.
    as_json
        Print one JSON object on stdout and nothing else: the report, and the text without --output.
    """
    if listed:
        _list(as_json=as_json)
        return
    check_files(output, plot=options.plot)
    if law is None or to is None:
        raise InputError("say what is exported and to which format: optlaws export LAW --to FORMAT; --list lists them")
    from optlaws.exports.export import export_motion
    from optlaws.exports.format import format_of

    chosen = format_of(to)
    request: dict[str, Any] = {**asdict(options), "points": _points(options.points)}
    task, plot = request.pop("task"), request.pop("plot")
    chosen.request(**request)
    written = export_motion(_motion(law, motion, points), to, task=task, **request)
    if plot is not None:
        save_picture(plot, written)
    _answer(written, output, as_json=as_json)


def _points(text: str | None) -> int | str | None:
    if text is None or text == BEST:
        return text
    try:
        return int(text)
    except ValueError:
        raise InputError(f"--points takes a whole number or {BEST}, got {text}") from None


def _motion(law: str, options: MotionOptions, points: TableOptions) -> Motion:
    from optlaws.files.packaged import is_problem
    from optlaws.motion.motion import motion_of_law

    given: dict[str, Any] = asdict(options)
    axis = given.pop("axis")
    if not is_problem(law):
        if axis is not None:
            raise InputError("--axis is one of a problem file with several; a law has none")
        return motion_of_law(read_law(law, points=points), **given)
    for option, value in {**given, **asdict(points), "master": None}.items():
        if value is not None:
            raise InputError(f"--{option} is of a law alone: a cycle has its own")
    cycle = _cycle(Path(law), axis)
    of_cycle: Motion = cycle.motion() if options.master is None else cycle.motion(master=options.master)
    return of_cycle


def _cycle(file: Path, axis: str | None) -> Any:
    from optlaws.files.packaged import problem_of_job
    from optlaws.jobs.cycle_entries import read

    source, _, entries = problem_of_job(file, "cycle")
    _, cycles = read(entries, source)
    if axis is None and len(cycles) > 1:
        raise InputError(f"{file} has several axes, say which by --axis: {', '.join(cycles)}")
    chosen = next(iter(cycles)) if axis is None else axis
    if chosen not in cycles:
        raise InputError(f"--axis: {file} has no axis {chosen}; it has {', '.join(cycles)}")
    return cycles[chosen]


def _answer(export: Export, output: Path | None, *, as_json: bool) -> None:
    if output is not None:
        export.write(output)
    if as_json:
        print_json(export.results() | ({"text": export.text} if output is None else {"file": str(output)}))
    elif output is None:
        print(export.text, end="")
        print(export, file=sys.stderr)
    else:
        show(str(export))


def _list(*, as_json: bool) -> None:
    from optlaws.exports.format import FORMATS

    formats = [FORMATS[name] for name in sorted(FORMATS)]
    if as_json:
        keys = ("name", "target", "contents", "model", "limits", "extension", "takes")
        print_json([{key: getattr(file_format, key) for key in keys} for file_format in formats])
        return
    rows = ([form.name, form.target, form.contents, form.model, form.limits] for form in formats)
    show(table("format", "target", "holds", "runs", "limits", rows=rows))
