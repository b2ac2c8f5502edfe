"""The command `optlaws cam`: cams of cycles, from problem files."""

from __future__ import annotations

from pathlib import Path

from optlaws.cli.laws.cycle import do_job
from optlaws.cli.options import AsJson, Plot


def cam(file: Path, /, *, out: Path | None = None, plot: Plot = None, as_json: AsJson = False) -> None:
    """Cams of cycles: curves, enclosed pressure angles and curvatures, proof of no undercut, least sizes.

    Parameters
    ----------
    file
        A problem file whose job is "cam", or the name of one that comes with optlaws, such as cam_press.
    out
        Folder for the tables; otherwise where `optlaws run` puts them.
    plot
        Draw the cam into this file, PNG or SVG.
    as_json
        Print one JSON object on stdout; of all files only that of --plot is written.
    """
    do_job("cam", file, out, plot, as_json=as_json)
