"""The command `optlaws cycle`: whole cycles of a machine, from problem files."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path

from optlaws.cli.options import AsJson
from optlaws.cli.show import busy, print_json
from optlaws.cli.synthesis.run import run


def cycle(file: Path, /, *, out: Path | None = None, as_json: AsJson = False) -> None:
    """Whole cycles of a machine in physical units, optimal as a whole: peaks, joints, drives, tables and pictures.

    Parameters
    ----------
    file
        A problem file whose job is "cycle", or the name of one that comes with optlaws, such as cycle_press.
    out
        Folder for the table, the pictures and the laws; otherwise where `optlaws run` puts them.
    as_json
        Print one JSON object on stdout and write nothing.
    """
    do_job("cycle", file, out, as_json=as_json)


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
