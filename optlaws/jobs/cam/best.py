"""What the job "cam" says of laws that are best for their cam: least acceleration under its limits, or least size."""

from __future__ import annotations

from typing import Any

from optlaws.cams.best_laws import BestCam
from optlaws.cams.least_sizes import LeastBaseCircle, least_base_circle
from optlaws.cycles.summary import objective_unit
from optlaws.errors import InfeasibleProblem
from optlaws.files import tables
from optlaws.jobs.cam.extreme_rows import Limits
from optlaws.jobs.cam.schema import CamProblemFile, Cams
from optlaws.motion.quantities import quantity
from optlaws.results.page import Page

_MILLI = 1e3
_DIGITS = 6
_MET = 1e-7  # of a base circle, where bound and size are said to meet
_HEADINGS = ("what", "value", "no laws are below", "unit", "status")


def to_data(cams: Cams) -> dict[str, Any]:
    """The data of the best laws for programs, in SI units; nothing where the laws are those of the cycle."""
    best = cams.best
    if best is None:
        return {}
    if isinstance(best, BestCam):
        entries = {"minimise": cams.cycle.minimise, "objective": best.objective, "status": best.status.value}
        return {"best": entries | {"lower_bound": best.lower_bound}}
    radius = {"minimise": "base circle", "objective": best.least.radius, "status": _status_of_size(cams)}
    return {"best": radius | {"lower_bound": best.lower_bound}}


def limits_of(cams: Cams, spec: CamProblemFile) -> Limits:
    """The limits that the laws were made for; none where they are those of the cycle."""
    if cams.best is None:
        return Limits()
    pressure, radius = spec.pressure_angle, spec.radius_of_curvature
    return Limits(
        None if pressure is None else quantity(pressure, "angle", "pressure_angle"),
        None if radius is None else quantity(radius, "length", "radius_of_curvature"),
    )


def add(page: Page, cams: Cams, spec: CamProblemFile) -> None:
    """Put what was found on the page."""
    best = cams.best
    if best is None:
        return
    page.heading("Laws for the cam")
    if isinstance(best, BestCam):
        page.table(_HEADINGS, _law_rows(cams, best), digits=_DIGITS)
        return
    least = best.least
    rows: list[list[tables.Cell]] = [
        [
            "least base circle of all laws",
            _MILLI * least.radius,
            _MILLI * best.lower_bound,
            "mm",
            _status_of_size(cams),
        ]
    ]
    of_cycle = _own(cams, spec)
    if of_cycle is not None:
        rows.append([f"of the laws of least {cams.cycle.minimise}", _MILLI * of_cycle.radius, None, "mm", None])
    page.table(_HEADINGS, rows, digits=_DIGITS)


def _law_rows(cams: Cams, best: BestCam) -> list[list[tables.Cell]]:
    name, unit = cams.cycle.minimise, objective_unit(cams.cycle)
    return [
        [f"least {name} under the limits of the cam", best.objective, best.lower_bound, unit, best.status.value],
        [f"least {name} without them", cams.cycle.objective, cams.cycle.lower_bound, unit, cams.cycle.status.value],
    ]


def _status_of_size(cams: Cams) -> str:
    best = cams.best
    assert best is not None  # noqa: S101 - it was asked for
    if isinstance(best, BestCam):
        return best.status.value
    met = best.least.radius - best.lower_bound <= _MET * best.least.radius
    return "optimal" if met else "local"


def _own(cams: Cams, spec: CamProblemFile) -> LeastBaseCircle | None:
    """The least base circle of the cycle's own laws."""
    try:
        return least_base_circle(cams.cycle, cams.first.follower, **spec.limits)
    except InfeasibleProblem:
        return None
