"""The report of a disc cam: its facts, and over its angle its motion, pressure angle, curvature and forces."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise
from math import degrees
from typing import TYPE_CHECKING, Any

import numpy as np

from optlaws.cams.followers.follower import positive
from optlaws.cams.summary import geometry, named_forces, summary
from optlaws.motion.display_units import DEGREES, MILLI, TURN_DEG, UNITS
from optlaws.motion.quantities import TURN
from optlaws.numbers import Array, chop
from optlaws.shown.curve_points import refined
from optlaws.shown.report import Panel, PanelLimit, ReportSegment, ReportTable, Series
from optlaws.shown.summary import Summary
from optlaws.tolerances import CAM_FEASIBILITY, FORCE_ROUNDING, RADIUS_ROUNDING

if TYPE_CHECKING:
    from optlaws.cams.curves.extremes import EnclosedExtreme
    from optlaws.cams.disc import DiscCam
    from optlaws.cams.forces import CamForces
    from optlaws.numerics.branch_and_bound import Extremes

_INSIDE = 1e-9  # of a smooth part: so near to its ends it is drawn
_FAR = 4.0  # a radius of curvature beyond so many prime circles is a straight edge

Values = Callable[[Array], Array]


EXTREMES = ("what", "at least", "at most", "unit", "at, deg")


@dataclass(frozen=True)
class Limits:
    """Limits that the laws were optimised for, in SI units: the laws reach them at several angles."""

    pressure: float | None = None
    radius: float | None = None


@dataclass(frozen=True)
class CamReport:
    """The report of a cam; its panels are over the cam's angle in radians, of which a page shows degrees.

    Attributes
    ----------
    cam
        The cam.
    pressure
        The limit of its pressure angle, rad; None without one.
    reached
        Limits that its laws were optimised for.
    """

    cam: DiscCam
    pressure: float | None = None
    reached: Limits = Limits()

    @property
    def facts(self) -> Summary:
        """The summary of the cam."""
        return summary(self.cam)

    @property
    def tables(self) -> tuple[ReportTable, ...]:
        """Extreme pressure angles, radii of curvature, and sizes of the follower."""
        touched = {"deg": self.reached.pressure, "mm": self.reached.radius}
        extremes = self.cam.extremes
        others = [extremes.least_concave_radius, *(size.extreme for size in extremes.sizes)]
        rows = [
            extreme_row(
                name, extreme, factor, unit, None if any(extreme is other for other in others) else touched[unit]
            )
            for name, extreme, unit, factor in geometry(self.cam)
        ]
        return (ReportTable(EXTREMES, rows),)

    @property
    def data(self) -> dict[str, Any]:
        """The cam for programs, in metres and radians: enclosures as pairs, with the angle of the cam."""
        cam, extremes, limits = self.cam, self.cam.extremes, self.reached
        hollow = extremes.least_concave_radius
        return {
            "prime_radius": positive(cam.prime_radius, "prime_radius"),
            "base_radius": cam.base_radius,
            "greatest_pressure_angle": enclosure(extremes.greatest_pressure_angle, limits.pressure),
            "least_pressure_angle": enclosure(extremes.pressure_angles[0], limits.pressure),
            "largest_pressure_angle": enclosure(extremes.pressure_angles[1], limits.pressure),
            "bulging_radius": enclosure(extremes.least_convex_radius, limits.radius),
            "hollow_radius": None if hollow is None else enclosure(hollow),
            "undercut": {"status": extremes.undercut.status, "simple": extremes.undercut.simple},
            **{size.name.replace(" ", "_"): enclosure(size.extreme) | _limit(size) for size in extremes.sizes},
        }

    @property
    def segments(self) -> tuple[ReportSegment, ...]:
        """The smooth parts of the displacement."""
        return tuple(ReportSegment("", *ends) for ends in pairwise(self.cam.displacement.breaks))

    @property
    def panels(self) -> tuple[Panel, ...]:
        """Displacement, pressure angle, curvature and radius of curvature, each with its greatest or least value."""
        cam, pressed = self.cam, self.cam.extremes.greatest_pressure_angle
        unit, factor = UNITS[cam.displacement.axis][0]
        steepest = None if self.pressure is None else DEGREES * self.pressure
        limits = () if steepest is None else (PanelLimit(0.0, TURN, -steepest, steepest),)
        bulging = _mark(cam.extremes.least_convex_radius, MILLI)
        steep = _mark(pressed, float(np.copysign(DEGREES, cam.pressure_angle(pressed.angle))))
        far = _FAR * positive(cam.prime_radius, "prime_radius")

        def pressure(at: Array) -> Array:
            return DEGREES * np.asarray(cam.pressure_angle(at))

        def radius(at: Array) -> Array:
            values = np.asarray(cam.radius_of_curvature(at))
            return MILLI * np.where(np.abs(values) < far, values, np.nan)

        return (
            self._panel("displacement", unit, lambda at: factor * np.asarray(cam.displacement(at))),
            replace(
                self._panel("pressure angle", "deg", lambda at: np.degrees(cam.pressure_angle(at)), steep),
                limits=limits,
            ),
            self._panel("curvature", "1/mm", lambda at: np.asarray(cam.profile.curvature(at)) / MILLI),
            self._panel("radius of curvature", "mm", radius, bulging),
        )

    def loads(self, forces: CamForces) -> tuple[Panel, ...]:
        """Contact force, torque at the shaft and, where the contact has a width, Hertz's pressure."""
        curves: tuple[Values, ...] = (forces.contact_force, forces.shaft_torque, forces.contact_pressure)
        return tuple(
            self._panel(name, unit, partial(_scaled, curve, size), _ends(each, size), forces.edges)
            for (name, each, unit, size), curve in zip(named_forces(forces), curves, strict=False)
        )

    def process(self, forces: CamForces) -> tuple[Panel, ...]:
        """The force of the process; none where there is no process."""
        if forces.process is None:
            return ()
        unit, process = "N" if self.cam.displacement.axis == "length" else "N m", forces.process_force
        return (self._panel("process force", unit, lambda at: process.jet(at, 0).terms[0], edges=process.edges),)

    def _panel(
        self,
        name: str,
        unit: str,
        values: Values,
        peaks: tuple[tuple[float, float], ...] = (),
        edges: Sequence[float] | Array = (),
    ) -> Panel:
        """A function that may jump at edges, where its line is drawn upright, at every degree and through its peaks."""
        ends = np.union1d(self.cam.displacement.breaks, edges)
        whole = np.radians(np.arange(TURN_DEG + 1.0))
        parts = [
            np.concatenate([[low + room], whole[(whole > low + room) & (whole < high - room)], [high - room]])
            for low, high in pairwise(ends.tolist())
            for room in [_INSIDE * (high - low)]
        ]
        at = np.concatenate(parts)
        at, (curve,) = refined(at, [np.asarray(values(at))], [values], np.array([place for place, _ in peaks]))
        sizes = [value for _, value in peaks]
        return Panel(
            name, unit, (Series(at, curve),), peaks=peaks, ends=(min(sizes, default=0.0), max(sizes, default=0.0))
        )


def _limit(size: Any) -> dict[str, Any]:
    return {} if size.limit is None else {"limit": size.limit, "kept": size.within}


def _scaled(curve: Values, size: float, at: Array) -> Array:
    return size * np.asarray(curve(at))


def _mark(extreme: EnclosedExtreme, factor: float) -> tuple[tuple[float, float], ...]:
    return ((extreme.angle, factor * extreme.value),)


def _ends(extremes: Extremes, factor: float) -> tuple[tuple[float, float], ...]:
    """The least and the greatest value with their angles, but what is rounding."""
    ends = (extremes.least_at, extremes.least), (extremes.most_at, extremes.most)
    return tuple((at, factor * value) for at, value in ends if chop(value, extremes.peak, FORCE_ROUNDING))


def extreme_row(name: str, extreme: EnclosedExtreme, factor: float, unit: str, limit: float | None = None) -> list[Any]:
    """The row of an extreme, with a factor from the SI unit; without its angle where laws reach it as a limit.

    Examples
    --------
    >>> from optlaws.cams.curves.extremes import EnclosedExtreme
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
    """The angle of an extreme; None where its value is a limit that laws reach at several angles."""
    reached = limit is not None and abs(abs(extreme.value) - limit) <= CAM_FEASIBILITY * limit
    return None if reached else extreme.angle


def plain(value: float) -> float:
    """The value, or 0 where it is rounding."""
    return 0.0 if abs(value) < RADIUS_ROUNDING else value
