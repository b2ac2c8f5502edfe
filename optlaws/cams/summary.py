"""Rows that summarise a disc cam: enclosed pressure angles and radii, undercut and, with a drive, its forces."""

from __future__ import annotations

from math import degrees
from typing import TYPE_CHECKING, Generic, NamedTuple, TypeVar

from optlaws.cams.followers.follower import positive
from optlaws.cams.forces import CamForces
from optlaws.cycles.cycle import Cycle
from optlaws.shown.summary import Row, Summary

if TYPE_CHECKING:
    from optlaws.cams.curves.extremes import EnclosedExtreme
    from optlaws.cams.disc import DiscCam
    from optlaws.numerics.branch_and_bound import Extremes

_SMALLEST_ANGLE = 1e-100  # a pressure angle below it is none

T = TypeVar("T")


class Labelled(NamedTuple, Generic[T]):
    """Enclosed extremes with their name, their unit for display, and the factor from that unit to the SI unit."""

    name: str
    extremes: T
    unit: str
    factor: float


def geometry(cam: DiscCam) -> list[Labelled[EnclosedExtreme]]:
    """Extreme pressure angles, where there are any but 0, least radii of curvature, and sizes of the follower."""
    extremes = cam.extremes
    angles = {
        "greatest pressure angle": extremes.greatest_pressure_angle,
        "pressure angle, least": extremes.pressure_angles[0],
        "pressure angle, greatest": extremes.pressure_angles[1],
    }
    seen = extremes.greatest_pressure_angle.value > _SMALLEST_ANGLE
    radii = {"bulging": extremes.least_convex_radius, "hollow": extremes.least_concave_radius}
    return [
        *(Labelled(name, extreme, "deg", degrees(1.0)) for name, extreme in angles.items() if seen),
        *(
            Labelled(f"least radius of curvature, {name}", extreme, "mm", 1e3)
            for name, extreme in radii.items()
            if extreme is not None
        ),
        *(Labelled(size.name, size.extreme, "mm", 1e3) for size in extremes.sizes),
    ]


def named_forces(forces: CamForces) -> list[Labelled[Extremes]]:
    """Contact force, torque at the shaft and, where the contact has a width, Hertz's pressure."""
    named = [
        Labelled("contact force", forces.contact, "N", 1.0),
        Labelled("torque at the shaft", forces.torque, "N m", 1.0),
    ]
    pressure = [] if forces.width is None else [Labelled("Hertz's pressure", forces.pressure, "MPa", 1e-6)]
    return [*named, *pressure]


def summary(cam: DiscCam) -> Summary:
    """The rows of a cam: intervals enclose an extreme, places are degrees of the cam."""
    undercut = cam.extremes.undercut
    rows = [
        *(Row("beyond what is allowed", str(broken)) for broken in cam.extremes.beyond),
        Row("undercut", undercut.status, note=str(undercut)),
        Row("radius of the prime circle", 1e3 * positive(cam.prime_radius, "prime_radius"), "mm"),
        Row("radius of the base circle", 1e3 * cam.base_radius, "mm"),
    ]
    for name, extreme, unit, factor in geometry(cam):
        ends = factor * extreme.low, factor * extreme.high
        rows.append(Row(name, ends, unit, degrees(extreme.angle)))
    if isinstance(cam.motion, Cycle) and cam.motion.drive is not None:
        for name, extremes, unit, factor in named_forces(CamForces(cam)):
            rows.append(Row(f"{name}, least", factor * extremes.least, unit, degrees(extremes.least_at)))
            rows.append(Row(f"{name}, greatest", factor * extremes.most, unit, degrees(extremes.most_at)))
    return Summary(rows, at="deg")
