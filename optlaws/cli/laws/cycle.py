"""The command `optlaws cycle`: whole cycles of a machine, from problem files."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path

from optlaws.cli.app import NotProven
from optlaws.cli.options import AsJson
from optlaws.cli.show import busy, print_json, show
from optlaws.cli.synthesis.run import run
from optlaws.synthesis.status import Status


def cycle(file: Path, /, *, out: Path | None = None, fastest: bool = False, as_json: AsJson = False) -> None:
    """Whole cycles of a machine in physical units, optimal as a whole: peaks, joints, drives, tables and pictures.

    Parameters
    ----------
    file
        A problem file whose job is "cycle", or the name of one that comes with optlaws, such as cycle_press.
    out
        Folder for the table, the pictures and the laws; otherwise where `optlaws run` puts them.
    fastest
        The greatest speed of the master at which every axis keeps its limits, what binds there, and the proof: a table,
        and with `--out` all results at that speed with fastest.json for `optlaws verify`. The exit code is 1 where none
        faster is not proven to be impossible.
    as_json
        Print one JSON object on stdout and write nothing.
    """
    if fastest:
        _greatest_speed(file, out, as_json=as_json)
    else:
        do_job("cycle", file, out, as_json=as_json)


def _greatest_speed(file: Path, out: Path | None, *, as_json: bool) -> None:
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
    if as_json:
        print_json({name: fastest_facts(speed) for name, speed in speeds.items()})
    else:
        show(*(line for line in str(fastest_page(spec.title, speeds)).splitlines() if not line.startswith("<!--")))
    unproven = [name for name, speed in speeds.items() if speed.status != Status.OPTIMAL]
    if unproven:
        raise NotProven(f"axis {', '.join(unproven)}: that no law is faster is not proven")


def do_job(job: str, file: Path, out: Path | None, *, as_json: bool) -> None:
    """The job of a problem file, or its data for programs."""
    from optlaws.files.packaged import problem_of_job

    source, folder, entries = problem_of_job(file, job)
    if not as_json:
        run(source, out=out or folder)
        return
    with busy(f"{file}"):
        data = import_module(f"optlaws.jobs.{job}").answer(entries, source)
    print_json(data)
