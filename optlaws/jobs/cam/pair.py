"""What the job "cam" says of the return cam of a pair: its extremes, its picture and its files."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from optlaws.cams.followers.follower import positive
from optlaws.jobs.cam.extreme_rows import EXTREMES, Limits, enclosure, extreme_rows
from optlaws.jobs.cam.forces_and_files import FileEntries
from optlaws.jobs.cam.schema import Cams
from optlaws.plots.cam import pair_figure
from optlaws.results.page import Page

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_PREFIX = "return-"


def to_data(cams: Cams) -> dict[str, Any]:
    """The data of the second cam for programs, in metres and radians; nothing where there is none."""
    if cams.second is None:
        return {}
    extremes = cams.second.extremes
    return {
        "return_cam": {
            "base_radius": positive(cams.second.base_radius, "base_radius"),
            "greatest_pressure_angle": enclosure(extremes.greatest_pressure_angle),
            "bulging_radius": enclosure(extremes.least_convex_radius),
            "undercut": {"status": extremes.undercut.status, "simple": extremes.undercut.simple},
        }
    }


def add(page: Page, cams: Cams, entries: Sequence[FileEntries]) -> Page:
    """The page with the second cam."""
    if cams.second is None:
        return page
    page.heading("Return cam").figure("pair", "Both cams on one shaft, with their followers at the start")
    page.text(f"Undercut: {cams.second.extremes.undercut}.")
    page.table(EXTREMES, extreme_rows(cams.second, Limits()), digits=7)
    return page.text("\n".join(f"- [{name_of(entry)}]({name_of(entry)})" for entry in entries))


def figures(cams: Cams, title: str) -> dict[str, Figure]:
    """The picture of both."""
    return {} if cams.second is None else {"pair": pair_figure(cams.first, cams.second, title)}


def files(cams: Cams, entries: Sequence[FileEntries], out: Path, about: str) -> list[Path]:
    """Write the files that cut the second cam: as those of the first."""
    second = cams.second
    if second is None:
        return []
    return [entry.cut(second, out, about, prefix=_PREFIX) for entry in entries]


def name_of(entries: FileEntries) -> str:
    """The name of the second cam's file beside that of the first.

    Examples
    --------
    >>> name_of(FileEntries(name="cam.dxf"))
    'return-cam.dxf'
    """
    return f"{_PREFIX}{entries.name}"
