"""The job "cam": a cam with enclosed pressure angles and curvatures, proof of no undercut, least sizes, its curves."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import Any

from optlaws.errors import located
from optlaws.jobs.cam_entries import BarrelProblemFile, CamProblemFile
from optlaws.jobs.cam_result import BarrelResult, CamResult
from optlaws.plots.cam import animated
from optlaws.results import Results


def run(results: Results) -> None:
    """Put the cam's page, data, table, pictures and files into results."""
    result = read(results.entries, results.file)
    spec = result.spec
    results.title = spec.title
    page = results.page("cam").text(spec.text).figure("cam", spec.title)
    for section in result.sections:
        page.section(section)
    results.data("cam.json", result.data)
    results.table("cam", *result.table)
    for name, draw in result.pictures.items():
        results.picture(name, draw(spec.title))
    if isinstance(result, CamResult):
        if result.spec.animation:
            results.text("animation.svg", animated(result.cam))
        for name, write in result.files.items():
            results.add(name, partial(write, about=results.about))


def answer(data: Mapping[str, Any], file: Path) -> dict[str, Any]:
    """The data of the cam for programs, in metres and radians: enclosures as pairs, with the angle of the cam."""
    return read(data, file).data


def read(data: Mapping[str, Any], file: Path) -> CamResult | BarrelResult:
    """The result of a file's entries; an error names the file."""
    spec = (BarrelProblemFile if "barrel" in data else CamProblemFile).read(data, file)
    with located(str(file)):
        return CamResult.of_file(spec) if isinstance(spec, CamProblemFile) else BarrelResult.of_file(spec)
