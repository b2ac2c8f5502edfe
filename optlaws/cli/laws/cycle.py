"""The command `optlaws cycle`: whole cycles of a machine, from problem files."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

from optlaws.cli.app import NotProven
from optlaws.cli.law_options import COLUMNS
from optlaws.cli.old_cam import old_cam
from optlaws.cli.options import AsJson, Plot, Signed, Written, given, options, save_figure, takes
from optlaws.cli.show import busy, print_json, show
from optlaws.cli.synthesis.run import done
from optlaws.cycles.old_tables.table import read_cycle_table
from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.synthesis.status import Status

if TYPE_CHECKING:
    from optlaws.results import Results

_GROUP = "The table of an old cam"


@takes(table=options(read_cycle_table, "unit", "master", "cam", "tolerance", group=_GROUP, columns=COLUMNS))
def cycle(
    file: Path,
    /,
    *,
    out: Path | None = None,
    fastest: bool = False,
    plot: Plot = None,
    table: Mapping[str, Any],
    speed: Annotated[Signed, Parameter(group=_GROUP)] = None,
    modernise: Annotated[str | None, Parameter(group=_GROUP)] = None,
    export: Annotated[str | None, Parameter(group=_GROUP)] = None,
    save: Annotated[Written, Parameter(group=_GROUP)] = None,
    as_json: AsJson = False,
) -> None:
    """Whole cycles of a machine in physical units, optimal as a whole; or the table of an old cam, and a better one.

    Parameters
    ----------
    file
        A problem file whose job is "cycle", or the name of one that comes with optlaws, such as cycle_press; or the
        table of an old cam: columns of text, or a file of a controller.
    out
        Folder for the table, the pictures and the laws; otherwise where `optlaws run` puts them. Of an old cam for the
        file of --export; otherwise where you are.
    fastest
        The greatest speed of the master at which every axis keeps its limits, what binds there, and the proof: a table,
        and with `--out` all results at that speed with fastest.json for `optlaws verify`. The exit code is 1 where none
        faster is not proven to be impossible.
    plot
        Draw all axes, the points and laws of an old cam, or with `--fastest` the motion at that speed, into this file,
        PNG or SVG.
    speed
        Of the master, such as "200 rpm"; what the file says unless given. --save and --export need it where the master
        is an angle.
    modernise
        How far better laws may be off the old ones, such as 0.05mm: the laws of least acceleration within it.
    export
        A format of `optlaws export --list`: the cycle is written in it, modernised where --modernise is given.
    save
        Write the cycle as a problem file (.toml), its laws beside it.
    as_json
        Print one line of JSON on stdout and nothing else; of all files only that of --plot is written.
    """
    cam: dict[str, Any] = {"speed": speed, "modernise": modernise, "export": export, "save": save}
    if file.suffix and file.suffix.lower() != ".toml":
        if fastest:
            raise InputError(
                "--fastest needs a problem file: --save writes one from the table, in which you enter the limits"
            )
        old_cam(file, table, **cam, out=out, plot=plot, as_json=as_json)
        return
    for name, value in given({**table, **cam}).items():
        raise InputError(f"--{name} is of the table of an old cam, got {shortened(value)} with a problem file")
    if fastest:
        _greatest_speed(file, out, plot, as_json=as_json)
    else:
        _job(file, out, plot, as_json=as_json)


def _greatest_speed(file: Path, out: Path | None, plot: Path | None, *, as_json: bool) -> None:
    """The greatest speed of each axis of a problem file."""
    from optlaws.files.packaged import problem_of_job
    from optlaws.jobs import cycle as job
    from optlaws.jobs.axes.fastest_page import fastest_facts, fastest_of, fastest_page
    from optlaws.jobs.cycle_entries import read
    from optlaws.results import Results

    source, _, entries = problem_of_job(file, "cycle")
    with busy(f"{file}"):
        spec, cycles = read(entries, source)
        speeds = fastest_of(cycles, source)
        if out is not None:
            results = Results(source)
            results.entries["fastest"] = True
            job.run(results)
            results.write(out)
    if plot is not None:
        from optlaws.plots.cycle import axes_figure, cycle_figure

        at_best = {name: speed.cycle for name, speed in speeds.items()}
        alone = next(iter(at_best.values())) if len(at_best) == 1 else None
        save_figure(plot, axes_figure(at_best, spec.title) if alone is None else cycle_figure(alone, spec.title))
    if as_json:
        print_json({name: fastest_facts(speed) for name, speed in speeds.items()})
    else:
        show(*(line for line in str(fastest_page(spec.title, speeds)).splitlines() if not line.startswith("<!--")))
    unproven = [name for name, speed in speeds.items() if speed.status != Status.OPTIMAL]
    if unproven:
        raise NotProven(f"axis {', '.join(unproven)}: that no law is faster is not proven")


def _job(file: Path, out: Path | None, plot: Path | None, *, as_json: bool) -> None:
    """The job of a problem file, with its main picture in the file of --plot too; or its data for programs."""
    from optlaws.files import writing
    from optlaws.files.packaged import problem_of_job
    from optlaws.jobs import job as jobs
    from optlaws.jobs.cycle import answer

    source, folder, entries = problem_of_job(file, "cycle")
    if not as_json:
        if out is not None or folder is not None:
            writing.check_place((out or folder or Path()) / "results.md")
        results = done(source, out=out or folder)
        if plot is not None:
            writing.write(plot, _main_picture(entries, results, plot.suffix))
        return
    with busy(f"{file}"):
        if plot is not None:
            writing.write(plot, _main_picture(entries, jobs.done(source), plot.suffix))
        data = answer(entries, source)
    print_json(data)


def _main_picture(entries: Mapping[str, Any], results: Results, suffix: str) -> bytes:
    """The most informative picture among the results of a cycle: the single axis, or all axes."""
    from optlaws.jobs.cycle import TOGETHER, plain_name

    names = [plain_name(axis["name"]) for axis in entries["axis"]]
    return results.drawn(names[0] if len(names) == 1 else TOGETHER, suffix[1:])
