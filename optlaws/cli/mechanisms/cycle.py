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
        A problem file whose job is "cycle".
    out
        Folder for the table, the pictures and the laws; otherwise results/NAME beside the folder of the problem file.
    as_json
        Print one JSON object on stdout and write nothing.
    """
    from optlaws.files import reading
    from optlaws.jobs.cycle.cycle import answer
    from optlaws.jobs.cycle.entries import read

    data = reading.toml(file)
    if not as_json:
        run(file, out=out)
        return
    with busy(f"{file}"):
        _, cycles = read(data, file)
        told = answer(cycles)
    print_json(told)
