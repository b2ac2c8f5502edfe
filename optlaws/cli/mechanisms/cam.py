"""The command `optlaws cam`: cams of cycles, from a problem file."""

from __future__ import annotations

from pathlib import Path

from optlaws.cli.options import AsJson
from optlaws.cli.show import busy, print_json
from optlaws.cli.synthesis.run import run


def cam(file: Path, /, *, out: Path | None = None, as_json: AsJson = False) -> None:
    """Cams of cycles: curves, enclosed pressure angles and curvatures, proof of no undercut, least sizes.

    Parameters
    ----------
    file
        A problem file whose job is "cam".
    out
        Folder for the tables; otherwise results/NAME beside the folder of the problem file.
    as_json
        Print one JSON object on stdout and write nothing.
    """
    from optlaws.files import reading
    from optlaws.jobs.cam.cam import answer
    from optlaws.jobs.cam.wishes import read

    data = reading.toml(file)
    if not as_json:
        run(file, out=out)
        return
    with busy(f"{file}"):
        told = answer(*read(data, file))
    print_json(told)
