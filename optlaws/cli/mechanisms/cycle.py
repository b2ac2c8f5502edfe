"""The command `optlaws cycle`: whole cycles of a machine in physical units, from a problem file."""

from __future__ import annotations

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
    from optlaws.files.packaged import problem_of_job
    from optlaws.jobs.cycle import answer
    from optlaws.jobs.cycle_entries import read

    source, results, data = problem_of_job(file, "cycle")
    if not as_json:
        run(source, out=out or results)
        return
    with busy(f"{file}"):
        _, cycles = read(data, source)
        data_of_cycles = answer(cycles)
    print_json(data_of_cycles)
