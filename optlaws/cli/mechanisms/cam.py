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
        A problem file whose job is "cam", or the name of one that comes with optlaws, such as cam_press.
    out
        Folder for the tables; otherwise where `optlaws run` puts them.
    as_json
        Print one JSON object on stdout and write nothing.
    """
    from optlaws.files.packaged import problem_of_job
    from optlaws.jobs.cam import answer

    source, results, data = problem_of_job(file, "cam")
    if not as_json:
        run(source, out=out or results)
        return
    with busy(f"{file}"):
        data_of_cam = answer(data, source)
    print_json(data_of_cam)
