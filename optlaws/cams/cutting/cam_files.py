"""Files that cut a cam: its profile, its pitch curve or the path of a cutter, in any format."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from optlaws.cams.curves.plane_curve import PlaneCurve
from optlaws.cams.cutting.formats import export, format_of
from optlaws.cams.disc import DiscCam
from optlaws.errors import InputError
from optlaws.suggest import unknown_key

CURVES = ("profile", "pitch", "cutter")


def export_cam(
    cam: DiscCam,
    file: str | Path,
    as_: str | None = None,
    *,
    curve: str | None = None,
    cutter_radius: str | None = None,
    **options: Any,  # noqa: ANN401 - entries of Cutting
) -> Path:
    """Write a cam to a file, whole or not at all, and return its path.

    Parameters
    ----------
    cam
        The cam, of a motion over a whole turn.
    file
        Where; its ending says the format unless `as_` does.
    as_
        A format: "dxf spline", "dxf polyline", "dxf arcs", "svg", "csv", "csv polar", "g-code" or "g-code arcs".
    curve
        "profile", "pitch" (the way of the roller's centre) or "cutter", the way of a cutter's centre, where its radius
        is given; the profile unless said.
    cutter_radius
        Of the cutter, such as "10 mm".
    asked
        Of the file: tolerance, decimals, points, degree, feed, about.

    Raises
    ------
    InputError
        If something is unknown or out of its range, the cam's motion is no whole turn, or the file cannot be written.
    """
    format_of(Path(file), as_)
    return export(curve_of(cam, curve, cutter_radius), file, as_, **options)


def curve_of(cam: DiscCam, curve: str | None, cutter_radius: str | None) -> PlaneCurve:
    """The curve that is cut.

    Raises
    ------
    InputError
        If it is unknown, or a cutter has no radius.
    """
    chosen = curve or ("profile" if cutter_radius is None else "cutter")
    if chosen not in CURVES:
        raise InputError(unknown_key(chosen, CURVES, "curve"))
    if (chosen == "cutter") != (cutter_radius is not None):
        raise InputError("cutter_radius and curve='cutter' go together: give the radius, such as cutter_radius='10 mm'")
    if chosen == "cutter":
        return cam.cutter_path(cutter_radius)
    return cam.profile if chosen == "profile" else cam.pitch_curve
