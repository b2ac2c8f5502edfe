"""What the job "cam" finds beside the cams: extremes, least sizes, forces, a spring, peaks as manufactured."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from math import degrees
from typing import Any

import msgspec
import numpy as np

from optlaws.cams.as_manufactured import AsMade, UnreachedProfileError, as_made, with_profile_error
from optlaws.cams.best_laws import BestBaseCircle
from optlaws.cams.curves.extremes import EnclosedExtreme
from optlaws.cams.disc import DiscCam
from optlaws.cams.forces import CamForces
from optlaws.cams.least_sizes import GreatestRoller, LeastBaseCircle, greatest_roller, least_base_circle
from optlaws.cams.springs import Spring, least_spring
from optlaws.cams.summary import geometry
from optlaws.errors import InfeasibleProblem
from optlaws.files import tables
from optlaws.jobs.cam_entries import CamProblemFile, Cams
from optlaws.kept import kept_property
from optlaws.motion.quantities import quantity
from optlaws.tolerances import CAM_FEASIBILITY, RADIUS_ROUNDING

EXTREMES = ("what", "at least", "at most", "unit", "at, deg")
#: units of forces and of stiffness by what the follower's way is
FORCE = {"length": "N", "angle": "N m"}
STIFFNESS = {"length": "N/m", "angle": "N m/rad"}


@dataclass(frozen=True)
class Limits:
    """Limits that laws were made for, in SI units: they touch them at several angles, of which none is the one."""

    pressure: float | None = None
    radius: float | None = None


@dataclass(frozen=True)
class Findings:
    """The results beside the cams of a problem file, each computed once."""

    spec: CamProblemFile
    cams: Cams

    @kept_property
    def limits(self) -> Limits:
        """The limits that the laws were made for; none where they are those of the cycle."""
        if self.cams.best is None:
            return Limits()
        pressure, radius = self.spec.pressure_angle, self.spec.radius_of_curvature
        return Limits(
            None if pressure is None else quantity(pressure, "angle", "pressure_angle"),
            None if radius is None else quantity(radius, "length", "radius_of_curvature"),
        )

    def angle(self, angle: float) -> float | None:
        """An angle where a limit gives a size: laws that were made for it touch it at several."""
        return angle if self.cams.best is None else None

    @kept_property
    def least(self) -> LeastBaseCircle | str | None:
        """The least base circle, why there is none, or None where no limit is given."""
        if not (self.spec.pressure_angle or self.spec.radius_of_curvature):
            return None
        if isinstance(self.cams.best, BestBaseCircle):
            return self.cams.best.least
        cam = self.cams.first
        try:
            return least_base_circle(cam.motion, cam.follower, **self.spec.limits)
        except InfeasibleProblem as error:
            return str(error)

    @kept_property
    def least_of_cycle(self) -> LeastBaseCircle | None:
        """The least base circle of the cycle's own laws; None where there is none."""
        try:
            return least_base_circle(self.cams.cycle, self.cams.first.follower, **self.spec.limits)
        except InfeasibleProblem:
            return None

    @kept_property
    def roller(self) -> GreatestRoller | None:
        """The greatest roller; None under a flat face."""
        if not self.cams.first.contact.roller:
            return None
        return greatest_roller(self.cams.first, radius_of_curvature=self.spec.radius_of_curvature or "0 mm")

    @kept_property
    def forces(self) -> CamForces | None:
        """The forces of the cam, if the file asks for them."""
        return self.cams.forces(self.spec.forces)

    @kept_property
    def spring(self) -> Spring | None:
        """The least spring; mass, gravity and friction are those of the motion's drive."""
        if self.spec.spring is None:
            return None
        given = self.cams.cycle.drive or {}
        load = {key: value for key, value in given.items() if key not in {"stiffness", "preload"}}
        return least_spring(self.cams.first, drive=load, **msgspec.structs.asdict(self.spec.spring))

    @kept_property
    def as_made(self) -> dict[str, AsMade | None]:
        """Peaks of the cam as manufactured; None where its follower does not reach all of it."""
        options, cam = self.spec.as_made, self.cams.first
        if options is None:
            return {}
        peaks_by_name: dict[str, AsMade | None] = {}
        for points in options.points:
            for decimals in options.decimals:
                table: dict[str, Any] = {"curve": options.curve, "points": points, "decimals": decimals}
                name = f"{points} points of the {options.curve}, {decimals} decimals of a mm"
                peaks_by_name[name] = _tried(partial(as_made, cam, "csv", **table))
        error = options.error or ""
        for waves in options.waves if error else ():
            peaks_by_name[f"error of {error}, {waves} waves a turn"] = _tried(
                partial(with_profile_error, cam, error, waves)
            )
        return peaks_by_name

    def to_data(self) -> dict[str, Any]:
        """Sizes, forces, the spring and peaks as manufactured as data for programs, in SI units."""
        data: dict[str, Any] = {}
        if self.forces is not None:
            data["forces"] = self.forces.results()
        if self.spring is not None:
            data["spring"] = self.spring.to_dict()
        if self.as_made:
            data["as_made"] = {name: None if peaks is None else peaks.to_dict() for name, peaks in self.as_made.items()}
        return data


def _tried(run: Callable[[], AsMade]) -> AsMade | None:
    try:
        return run()
    except UnreachedProfileError:
        return None


def extreme_rows(cam: DiscCam, limits: Limits) -> list[list[tables.Cell]]:
    """Rows of a table of extreme pressure angles and radii of curvature."""
    touched, concave = {"deg": limits.pressure, "mm": limits.radius}, cam.extremes.least_concave_radius
    return [
        extreme_row(name, extreme, factor, unit, None if extreme is concave else touched[unit])
        for name, extreme, unit, factor in geometry(cam)
    ]


def extreme_row(
    name: str, extreme: EnclosedExtreme, factor: float, unit: str, limit: float | None = None
) -> list[tables.Cell]:
    """The row of an extreme, in a unit of so many to the SI unit; without its angle where laws touch it as a limit.

    Examples
    --------
    >>> extreme_row("radius", EnclosedExtreme(0.01, 0.01, 0.0), 1e3, "mm")
    ['radius', 10.0, 10.0, 'mm', 0.0]
    """
    low, high = (plain(factor * value) for value in (extreme.low, extreme.high))
    angle = _angle(extreme, limit)
    return [name, low, high if np.isfinite(high) else None, unit, None if angle is None else degrees(angle)]


def enclosure(extreme: EnclosedExtreme, limit: float | None = None) -> dict[str, float | None]:
    """The enclosure of an extreme for programs, in SI units."""
    high = extreme.high if np.isfinite(extreme.high) else None
    return {"low": extreme.low, "high": high, "angle": _angle(extreme, limit)}


def _angle(extreme: EnclosedExtreme, limit: float | None) -> float | None:
    """The angle of an extreme; None where its value is that of a limit."""
    reached = limit is not None and abs(abs(extreme.value) - limit) <= CAM_FEASIBILITY * limit
    return None if reached else extreme.angle


def plain(value: float) -> float:
    """The value, or 0 where it is rounding."""
    return 0.0 if abs(value) < RADIUS_ROUNDING else value
