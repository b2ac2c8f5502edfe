"""The reports of cams: their facts, and over their angle motion, pressure angle, curvature and forces."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise
from math import degrees, radians, tan
from typing import TYPE_CHECKING, Any

import numpy as np

from optlaws.cams.barrel import SIDES, BarrelCam
from optlaws.cams.cam_values import (
    SMALLEST_ANGLE,
    barrel_values,
    cam_differences,
    force_values,
    known_values,
    motion_values,
    objective_name,
    objective_value,
)
from optlaws.cams.cam_values import Values as ValuesByName
from optlaws.cams.curves.motion_by_angle import CamMotion
from optlaws.cams.curves.plane_curve import CurveByAngle
from optlaws.cams.followers.follower import positive
from optlaws.cams.forces import CamForces, Surfaces
from optlaws.cams.least_sizes import CamLimits
from optlaws.cams.pair_forces import PairForces
from optlaws.cycles.cycle import Cycle, Plan
from optlaws.cycles.placed import broken_limits
from optlaws.cycles.report import motion_columns
from optlaws.cycles.usual_law import usual_cycle
from optlaws.kept import kept_property
from optlaws.laws.catalogue.catalogue import USUAL
from optlaws.motion.quantities import DEGREES, MILLI, QUANTITIES, TURN, TURN_DEG, UNITS, in_degrees
from optlaws.numbers import Array, NumberOrQuantity, bounded, chop
from optlaws.numerics.peaks import is_kept
from optlaws.sentences import Amount, Sentence, capital, joined, sentence
from optlaws.shown.curve_points import refined
from optlaws.shown.difference import Differences
from optlaws.shown.report import Panel, PanelLimit, ReportSegment, ReportTable, Section, Series
from optlaws.shown.summary import Row, Summary
from optlaws.tolerances import CAM_FEASIBILITY, FORCE_ROUNDING, RADIUS_ROUNDING

if TYPE_CHECKING:
    from optlaws.cams.curves.extremes import EnclosedExtreme
    from optlaws.cams.disc import DiscCam

#: of numbers on pages; files have all
DIGITS = 5
_MOTION = ("displacement", *QUANTITIES[1:])
_RESERVES = {"length": "20 N", "angle": "1 N m"}  # examples of the least force that a spring is to keep
_INSIDE = 1e-9  # of a smooth part: so near to its ends it is drawn
_USUAL_PRESSURE = 30.0  # deg: what the roller of a slide is led by at most without a reason
_FAR = 4.0  # a radius of curvature beyond so many prime circles is a straight edge

Values = Callable[[Array], Array]


@dataclass(frozen=True)
class CamReport:
    """The report of a disc cam; its panels are over the cam's angle in radians, of which a page shows degrees.

    Attributes
    ----------
    cam
        The cam.
    limits
        Limits that it is to keep.
    reached
        Whether its laws were optimised for these, so that they reach them at several angles.
    """

    cam: DiscCam
    limits: CamLimits = CamLimits()  # noqa: RUF009 - it is frozen
    reached: bool = False

    @property
    def facts(self) -> Summary:
        """Undercut, sizes, enclosed extremes and, with a drive, forces; places are degrees of the cam."""
        cam, undercut = self.cam, self.cam.extremes.undercut
        rows = [
            *(Row("beyond what is allowed", broken) for broken in self.beyond),
            Row("undercut", undercut.status, note=str(undercut)),
            Row("radius of the prime circle", MILLI * positive(cam.prime_radius, "prime_radius"), "mm"),
            Row("radius of the base circle", MILLI * cam.base_radius, "mm"),
            *self.extremes,
        ]
        if isinstance(cam.motion, Cycle | Plan) and cam.motion.drive is not None:
            for name, _, extremes, unit, factor in CamForces(cam).curves:
                rows.append(Row(f"{name}, least", factor * extremes.least, unit, degrees(extremes.least_at)))
                rows.append(Row(f"{name}, greatest", factor * extremes.most, unit, degrees(extremes.most_at)))
        beside = {} if self.beside is None else {row.name: row for row in self.beside.rows}
        beside.pop("prime circle", None)  # it is the same
        noted = [row._replace(note=beside.pop(row.name).note) if row.name in beside else row for row in rows]
        worse = [] if self.beside is None else self.beside.remark_rows
        return Summary([*noted, *beside.values(), *worse], at="deg")

    @kept_property
    def beside(self) -> Differences | None:
        """What the cam takes beside one with modified sine on the same prime circle; None where that has no sense."""
        cam, both = self.cam, _usual_and_chosen(self.cam.motion)
        if both is None:
            return None
        (usual, chosen), least = both, objective_name(both[1])
        rate, driven = TURN / usual.duration, usual.drive is not None

        def values(motion: Cycle | Plan) -> ValuesByName:
            placed = replace(cam, motion=motion)
            parts: list[Callable[[], ValuesByName]] = [lambda: motion_values(placed, rate)]
            parts.append(lambda: objective_value(motion, least))
            return known_values(*parts, *([lambda: force_values(CamForces(placed))] if driven else []))

        def broken() -> list[str]:
            of_cam = self.limits.broken(replace(cam, motion=usual).extremes)
            return [*broken_limits(usual.solve(), chosen.specification), *of_cam.values()]

        return cam_differences(USUAL, values(usual), values(chosen), least, broken)

    @property
    def beyond(self) -> list[Sentence]:
        """What of the cam is beyond its limits or those of its follower."""
        extremes = self.cam.extremes
        return [*(sentence("{}", size) for size in extremes.beyond), *self.limits.broken(extremes).values()]

    @property
    def _enclosed(self) -> list[tuple[str, str, EnclosedExtreme | None, str, float | None]]:
        """Extremes by their names in tables and for programs, with their units and the limits that laws reach.

        The least and the greatest pressure angle are together for programs.
        """
        limits, extremes = self.limits if self.reached else CamLimits(), self.cam.extremes
        (least, most), greatest = extremes.pressure_angles, extremes.greatest_pressure_angle
        return [
            ("greatest pressure angle", "greatest_pressure_angle", greatest, "deg", limits.pressure),
            ("pressure angle, least", "", least, "deg", limits.pressure),
            ("pressure angle, greatest", "", most, "deg", limits.pressure),
            ("least radius of curvature, convex", "convex_radius", extremes.least_convex_radius, "mm", limits.radius),
            ("least radius of curvature, concave", "concave_radius", extremes.least_concave_radius, "mm", None),
        ]

    @property
    def pressed(self) -> bool:
        """Whether the follower has a pressure angle anywhere."""
        return bool(self.cam.extremes.greatest_pressure_angle.value > SMALLEST_ANGLE)

    @kept_property
    def extremes(self) -> list[Row]:
        """Extreme pressure angles, where there are any but 0, least radii of curvature, and sizes of the follower."""
        rows = [
            extreme_row(name, extreme, unit, limit)
            for name, _, extreme, unit, limit in self._enclosed
            if extreme is not None and (self.pressed or unit != "deg")
        ]
        return rows + [extreme_row(size.name, size.extreme, "mm") for size in self.cam.extremes.sizes]

    @property
    def section(self) -> Section:
        """The circles of the cam, its undercut, its enclosed extremes, and what is beyond a limit."""
        base, roller = MILLI * self.cam.base_radius, MILLI * self.cam.contact.roller
        return Section(
            text=f"The radius of the prime circle is {base + roller:.{DIGITS}g} mm, that of the base circle "
            f"{base:.{DIGITS}g} mm.\n\nUndercut: {self.cam.extremes.undercut}.",
            facts=self.extremes,
            table=self.tables[0],
            note="\n".join(f"Limits exceeded: {broken}." for broken in self.beyond),
            data=self.data,
            digits=DIGITS,
        )

    @property
    def tables(self) -> tuple[ReportTable, ...]:
        """Extreme pressure angles, radii of curvature, and sizes of the follower."""
        return (ReportTable.of_pairs(self.extremes, "at least", "at most"),)

    @property
    def data(self) -> dict[str, Any]:
        """The cam for programs, in metres and radians: enclosures as pairs, with the angle of the cam."""
        cam, extremes = self.cam, self.cam.extremes
        enclosed = {key: each and enclosure(each, limit) for _, key, each, _, limit in self._enclosed if key}
        reached = self.limits.pressure if self.reached else None
        sizes = {
            size.name.replace(" ", "_"): enclosure(size.extreme)
            | ({} if size.limit is None else {"limit": size.limit, "kept": size.within})
            for size in extremes.sizes
        }
        return {
            "prime_radius": positive(cam.prime_radius, "prime_radius"),
            "base_radius": cam.base_radius,
            "pressure_angles": signed_angles(extremes.pressure_angles, reached),
            **enclosed,
            "undercut": {"status": extremes.undercut.status, "simple": extremes.undercut.simple},
            **sizes,
        }

    def coordinates(
        self,
        count: int,
        rate: float,
        forces: CamForces | None = None,
        cutter: NumberOrQuantity | None = None,
        second: DiscCam | None = None,
    ) -> ReportTable:
        """Motion at a speed in rad/s, points of the curves, pressure angle and curvature at equal steps of the turn.

        With forces, with the path of a cutter of a radius, and with the curves of a second cam.
        """
        cam, curves, turns = self.cam, dict[str, CurveByAngle](), np.linspace(0.0, TURN_DEG, count)
        for name, disc in {"": cam, "return ": second}.items():
            if disc is not None:
                curves |= {f"{name}pitch": disc.pitch_curve, f"{name}profile": disc.profile}
                curves |= {} if cutter is None else {f"{name}cutter": disc.cutter_path(cutter)}
        angles = np.radians(turns)
        after = {
            "pressure angle, deg": np.degrees(cam.pressure_angle(angles)),
            "curvature, 1/mm": cam.profile.curvature(angles) / MILLI,
        }
        after |= {
            f"{each.name}, {each.unit}": each.values(angles) for each in ([] if forces is None else forces.curves)
        }
        return _coordinates(turns, _motion(cam.displacement, angles, rate), curves, after)

    @property
    def segments(self) -> tuple[ReportSegment, ...]:
        """The smooth parts of the displacement."""
        return tuple(ReportSegment("", *ends) for ends in pairwise(self.cam.displacement.breaks))

    @property
    def panels(self) -> tuple[Panel, ...]:
        """Displacement, pressure angle, curvature and radius of curvature, each with its greatest or least value.

        A flat face that is square to its way has no pressure angle.
        """
        cam, (unit, factor) = self.cam, UNITS[self.cam.displacement.axis][0]
        steepest, bulging = cam.extremes.greatest_pressure_angle, cam.extremes.least_convex_radius
        limit = np.inf if self.limits.pressure is None else DEGREES * self.limits.pressure
        steep = DEGREES * float(np.copysign(steepest.value, cam.pressure_angle(steepest.angle)))
        far = _FAR * positive(cam.prime_radius, "prime_radius")

        def radius(at: Array) -> Array:
            values = np.asarray(cam.radius_of_curvature(at))
            return MILLI * np.where(np.abs(values) < far, values, np.nan)

        pressure = self._panel(
            "pressure angle", "deg", lambda at: np.degrees(cam.pressure_angle(at)), ((steepest.angle, steep),)
        )
        limited = replace(pressure, limits=(PanelLimit(0.0, TURN, -limit, limit),) if limit < np.inf else ())
        return (
            self._panel("displacement", unit, lambda at: factor * np.asarray(cam.displacement(at))),
            *([limited] if self.pressed else []),
            self._panel("curvature", "1/mm", lambda at: np.asarray(cam.profile.curvature(at)) / MILLI),
            self._panel("radius of curvature", "mm", radius, ((bulging.angle, MILLI * bulging.value),)),
        )

    def loads(self, forces: CamForces) -> tuple[Panel, ...]:
        """Contact force, torque at the shaft and, where the contact has a width, Hertz's pressure."""
        panels = []
        for force in forces.curves:
            # the least and the greatest value, but what is rounding
            ends, most = force.extremes, force.extremes.peak
            places = (ends.least_at, ends.least), (ends.most_at, ends.most)
            peaks = tuple((at, force.factor * value) for at, value in places if chop(value, most, FORCE_ROUNDING))
            panels.append(self._panel(force.name, force.unit, force.values, peaks, forces.edges))
        return tuple(panels)

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
        ends_of = min(sizes, default=0.0), max(sizes, default=0.0)
        return Panel(name, unit, (Series(at, curve),), (), peaks, ends_of, across="cam, deg", per=DEGREES)


def _usual_and_chosen(motion: Any) -> tuple[Cycle, Plan] | None:
    """The cycle of a cam with modified sine in its moves, and with its laws; None where none of them was optimised."""
    if not isinstance(motion, Cycle | Plan) or not motion.solve().solutions:
        return None
    usual: Cycle | None = usual_cycle(motion.solve().specification)
    return None if usual is None else (usual, motion.solve())


def barrel_differences(cam: BarrelCam) -> Section:
    """The motion and the pressure angle of a barrel cam beside those with modified sine; empty where that is none."""
    both = _usual_and_chosen(cam.motion)
    if both is None:
        return Section()
    least = objective_name(both[1])
    usual, chosen = (
        barrel_values(replace(cam, motion=motion), TURN / motion.duration) | objective_value(motion, least)
        for motion in both
    )
    broken = partial(broken_limits, both[0].solve(), both[1].specification)
    return cam_differences(USUAL, usual, chosen, least, broken).section()


#: what is known of the cusps of a flank by the status of its undercut
_CUSPS = {
    "free": "no flank has a cusp, at any depth",
    "undercut": "a flank has a cusp: make the roller smaller, the cylinder larger or the motion slower",
    "undecided": "whether a flank has a cusp is not decided",
}


def barrel_section(cam: BarrelCam, limits: CamLimits = CamLimits()) -> Section:  # noqa: B008 - it is frozen
    """The undercut of a barrel cam, its enclosed extremes, and where its pressure angle is more than is allowed."""
    least, greatest = cam.pressure_angles
    facts = [
        extreme_row("pressure angle at the bottom, least", least, "deg"),
        extreme_row("pressure angle at the bottom, greatest", greatest, "deg"),
        extreme_row("travel of a flank per radian, least", cam.margin, "mm"),
    ]
    data = {
        "pressure_angles": signed_angles((least, greatest)),
        "margin": enclosure(cam.margin),
        "undercut": {"status": cam.undercut},
    }
    table = ReportTable.of_pairs(facts, "at least", "at most")
    steep = _steep(cam, limits)
    return Section(
        text=f"Undercut: {_CUSPS[cam.undercut]}.", facts=facts, table=table, data=data, note=steep, digits=DIGITS
    )


def _steep(cam: BarrelCam, limits: CamLimits) -> str:
    """A sentence on pressure angles above the limit, or without one above the usual 30 deg; blank within it."""
    allowed = radians(_USUAL_PRESSURE) if limits.pressure is None else limits.pressure
    steep = [each for each in cam.pressure_angles if not is_kept(tan(abs(each.value)), tan(allowed), CAM_FEASIBILITY)]
    if not steep:
        return ""
    known = [
        sentence(
            "{} at {} where the roller moves {}",
            Amount(degrees(abs(each.value)), "deg", DIGITS),
            Amount(degrees(each.angle), "deg", DIGITS),
            "back" if each.value < 0.0 else "forwards",
        )
        for each in steep
    ]
    usual = "the usual " if limits.pressure is None else "the allowed "
    text = "The pressure angle at the bottom of the groove is {}, more than {}{}: make the cylinder larger{}."
    remedy = ", or give pressure_angle, within which the laws are sought then" if limits.pressure is None else ""
    return str(sentence(text, joined(" and ", known), usual, in_degrees(allowed), remedy))


def barrel_coordinates(cam: BarrelCam, count: int, rate: float, cutter: NumberOrQuantity | None = None) -> ReportTable:
    """Motion at a speed in rad/s, points of the roller's axis and the flanks, and pressure angles, at equal steps."""
    turns, places = np.linspace(0.0, TURN_DEG, count), dict(zip(("outside", "at the bottom"), cam.radii, strict=True))
    curves = {"axis of the roller": cam.pitch_curve}
    curves |= {f"{side} flank {place}": cam.flank(side, radius) for place, radius in places.items() for side in SIDES}
    if cutter is not None:
        curves |= {f"cutter, {side} flank": cam.cutter_path(cutter, side) for side in SIDES}
    pressure = {
        f"pressure angle {place}, deg": np.degrees(cam.pressure_angle(np.radians(turns), radius=radius))
        for place, radius in places.items()
    }
    return _coordinates(turns, _motion(cam.displacement, np.radians(turns), rate), curves, pressure)


def _motion(motion: CamMotion, angles: Array, rate: float) -> dict[str, Array]:
    """Displacement, velocity, acceleration and jerk of a follower at a speed of the cam; what is rounding is 0."""
    values = [rate**nu * np.asarray(motion(angles, nu)) for nu in range(len(_MOTION))]
    return motion_columns(values, [float(np.abs(each).max()) for each in values], motion.axis, _MOTION)


def _coordinates(
    turns: Array, before: Mapping[str, Array], curves: Mapping[str, CurveByAngle], after: Mapping[str, Array]
) -> ReportTable:
    """A table over the cam's angle of points of curves in millimetres, between other columns."""
    points = {
        f"{name} {axis}, mm": column
        for name, curve in curves.items()
        for axis, column in zip("xyz", MILLI * curve(np.radians(turns)).T, strict=False)
    }
    columns = {"cam, deg": turns, **before, **points, **after}
    return ReportTable.of_columns({name: map(plain, values.tolist()) for name, values in columns.items()})


def forces_section(forces: CamForces, pressed: str = "") -> Section:
    """The forces of a cam over its turn, with a sentence on what presses the follower on it."""
    mean = chop(0.5 * sum(forces.mean_torque), forces.torque.peak, FORCE_ROUNDING)
    table, facts, mean_square = [], [], forces.rms_torque[1]
    for name, _, curve, unit, factor in forces.curves:
        least, most = (chop(factor * value, factor * curve.peak, FORCE_ROUNDING) for value in (curve.least, curve.most))
        first, last = (chop(degrees(at), TURN_DEG, FORCE_ROUNDING) for at in (curve.least_at, curve.most_at))
        table.append([name, least, first, most, last, unit])
        facts.append(Row(name, (least, most), unit))
    facts.append(Row("RMS torque", mean_square, "N m"))
    left = leaves(forces)
    if left:
        facts.insert(0, Row(left, place=_least_contact_at(forces)))
    return Section(
        "Forces",
        facts=facts,
        table=ReportTable(("what", "least", "at, deg", "greatest", "at, deg", "unit"), table),
        data={"forces": forces.results()},
        figure=("forces", "Forces over the turn"),
        note=joined(
            " ",
            [
                f"Torque at the shaft: RMS {mean_square:.{DIGITS}g} N m, mean {mean:.{DIGITS}g} N m.",
                *([] if left else [_pressing(forces)]),
                *([pressed] if pressed else []),
                *([] if forces.width is None else [Surfaces(materials=forces.materials).assumed]),
            ],
        ),
        digits=DIGITS,
    )


def _pressing(forces: CamForces) -> str:
    """Which cam presses its follower, and from where to where."""
    if not isinstance(forces, PairForces):
        return "The follower stays on the cam."
    parts = [f"{degrees(low):.{DIGITS}g} to {degrees(high):.{DIGITS}g} deg" for low, high in forces.pressed_by_return]
    if not parts:
        return "The return cam presses its follower nowhere."
    return f"The return cam presses its follower from {joined(' and from ', parts)}, the other cam elsewhere."


def leaves_at(forces: CamForces, *, sought: bool = False) -> str:
    """The sentence of it for the head of a page, with where and the remedy; blank where the follower stays pressed.

    The remedy is another one where its spring was sought.
    """
    left = leaves(forces)
    if not left:
        return ""
    remedy = "give its spring more preload or stiffness, or reduce the speed"
    if sought:
        force = _RESERVES[forces.cam.displacement.axis]
        remedy = f'its spring is the least one; for a reserve give [spring] a least force, such as force = "{force}"'
    return f"{capital(left)} at {_least_contact_at(forces):.{DIGITS}g} deg: {remedy}."


def _least_contact_at(forces: CamForces) -> float:
    return chop(degrees(forces.contact.least_at), TURN_DEG, FORCE_ROUNDING)


def leaves(forces: CamForces) -> str:
    """That the follower lifts off, or that nothing presses it somewhere; blank where it is pressed all over."""
    if forces.lifts_off:
        return "the follower lifts off"
    pressed = isinstance(forces, PairForces) or chop(forces.contact.least, forces.contact.peak, FORCE_ROUNDING) > 0.0
    return "" if pressed else "the follower touches without force"


def extreme_row(name: str, extreme: EnclosedExtreme, unit: str, limit: float | None = None) -> Row:
    """The row of an extreme, in degrees or millimetres; without its angle where laws reach it as a limit.

    Examples
    --------
    >>> from optlaws.cams.curves.extremes import EnclosedExtreme
    >>> extreme_row("radius", EnclosedExtreme(0.01, 0.01, 0.0), "mm")
    Row(name='radius', value=(10.0, 10.0), unit='mm', place=0.0, note='')
    """
    factor, angle = {"deg": DEGREES, "mm": MILLI}[unit], _angle(extreme, limit)
    ends = plain(factor * extreme.low), plain(factor * extreme.high)
    return Row(name, ends, unit, None if angle is None else degrees(angle))


def enclosure(extreme: EnclosedExtreme, limit: float | None = None) -> dict[str, float | None]:
    """The enclosure of an extreme for programs, in SI units."""
    return {"low": extreme.low, "high": bounded(extreme.high), "angle": _angle(extreme, limit)}


def signed_angles(
    angles: tuple[EnclosedExtreme, EnclosedExtreme], limit: float | None = None
) -> dict[str, dict[str, float | None]]:
    """The enclosures of the least and the greatest pressure angle for programs."""
    return {name: enclosure(each, limit) for name, each in zip(("least", "greatest"), angles, strict=True)}


def _angle(extreme: EnclosedExtreme, limit: float | None) -> float | None:
    """The angle of an extreme; None where its value is a limit that laws reach at several angles."""
    reached = limit is not None and abs(abs(extreme.value) - limit) <= CAM_FEASIBILITY * limit
    return None if reached else extreme.angle


def plain(value: float) -> float:
    """The value, or 0 where it is rounding."""
    return 0.0 if abs(value) < RADIUS_ROUNDING else value
