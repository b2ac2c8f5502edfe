"""Forces of a cam at a speed and of a process: contact force, Hertz's pressure and torque, over the turn, enclosed."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from math import degrees, pi, sqrt
from typing import Any, NamedTuple

import numpy as np

from optlaws.cams.curves.extremes import UNDERCUT
from optlaws.cams.curves.motion_by_angle import CamMotion
from optlaws.cams.disc import DiscCam
from optlaws.cams.followers.contact import Friction, Transmission
from optlaws.cycles.cycle import Cycle, Plan
from optlaws.cycles.specification.drive import ProcessEntries, read_linear_drive
from optlaws.cycles.specification.limits import FORCES
from optlaws.cycles.specification.load import is_process
from optlaws.echo import unknown_key
from optlaws.entries.declared import Declared, ValueOf, declared, documented_by, entry
from optlaws.entries.value_types import Measured, Number, ReadBy, Together
from optlaws.errors import InputError
from optlaws.formulas.arithmetic import pieces
from optlaws.formulas.jets import formula_jet
from optlaws.formulas.slopes import added, multiplied
from optlaws.formulas.tree import Formula, Name, Table, number, rebuilt, table_places
from optlaws.kept import kept_property
from optlaws.mechanisms.linkages.mechanism_formulas import LinearForce, TableKind, formula_of, rescaled, table_numbers
from optlaws.motion.quantities import TURN, in_degrees, quantity
from optlaws.motion.smooth_stretches import jet_of_parts
from optlaws.numbers import Array, NumberOrQuantity, chopped, number_or_array, real_times
from optlaws.numerics.branch_and_bound import Extremes, Function, extremes, integral
from optlaws.numerics.interval import Interval, exact, highest, middle
from optlaws.numerics.roots import bisect
from optlaws.numerics.taylor import Jet, variable
from optlaws.sentences import sentence
from optlaws.tolerances import CLOSURE, FORCE_EXTREMES, FORCE_ROUNDING

#: megapascals of a pascal
MPA = 1e-6


@declared
class Material(Declared, title="a material"):
    """A material of a cam or its follower."""

    young: NumberOrQuantity = entry(Measured("pressure", above=0.0), "Young's modulus.", example="210 GPa")
    poisson: float = entry(Number(above=-1.0, most=0.5), "Poisson's ratio.", example=0.3)


#: within the ranges of J. M. Gere, Mechanics of Materials, 5th edition, appendix H (steel 190 to 210 GPa and 0.27 to
#: 0.30, cast iron 83 to 170 and 0.2 to 0.3, bronze 96 to 120 and 0.34, aluminium 6061-T6 70 and 0.33); 210 GPa and 0.30
#: are those of EN 1993-1-1
MATERIALS = {
    "steel": Material("210 GPa", 0.30),
    "cast iron": Material("110 GPa", 0.26),
    "bronze": Material("110 GPa", 0.34),
    "aluminium": Material("70 GPa", 0.33),
}


def _material(given: Any) -> Any:
    """The name of a material, or one of one's own."""
    if isinstance(given, str) and given not in MATERIALS:
        raise InputError(
            f"{unknown_key(given, MATERIALS, 'material')}; one of your own is {{'young': '3 GPa', 'poisson': 0.4}}"
        )
    return given if isinstance(given, str | Material) else Material.from_dict(given)


_MATERIAL = ReadBy(
    _material,
    f"{', '.join(MATERIALS)}, or a table of young and poisson",
    lambda material: material if isinstance(material, str) else material.to_dict(),
)


@declared
class Surfaces(Declared, title="forces"):
    """The surfaces of a cam and its follower, from which friction and pressure follow."""

    friction: Friction = entry(
        ValueOf(Friction), "Friction of the surfaces, and of a slide in its guide.", default=Friction()
    )
    width: NumberOrQuantity | None = entry(
        Measured("length", above=0.0), "Of the contact, for Hertz's pressure.", default=None, example="20 mm"
    )
    materials: tuple[Any, Any] = entry(
        Together(_MATERIAL, _MATERIAL, names=("cam", "follower")),
        "Of the cam and of the follower, for Hertz's pressure.",
        default=("steel", "steel"),
    )

    @property
    def assumed(self) -> str:
        """The sentence that names the materials of which Hertz's pressure is computed.

        >>> Surfaces(materials=("cast iron", {"young": "3 GPa", "poisson": 0.4})).assumed
        "Hertz's pressure assumes a cam of cast iron (110 GPa, Poisson's ratio 0.26) and a follower of 3 GPa, ..."
        """
        named = []
        for part, given in zip(("cam", "follower"), self.materials, strict=True):
            material = MATERIALS[given] if isinstance(given, str) else given
            poisson = f"Poisson's ratio {material.poisson:g}"
            of = f"{given} ({material.young}, {poisson})" if isinstance(given, str) else f"{material.young}, {poisson}"
            named.append(f"a {part} of {of}")
        return f"Hertz's pressure assumes {' and '.join(named)}."

    def line(self, roller: float) -> LineContact | None:
        """The contact along a line with a follower of a radius in m, 0 for a face; None where it has no width."""
        if self.width is None:
            return None
        materials = [MATERIALS.get(material, material) for material in self.materials]
        yielding = sum(
            (1.0 - material.poisson**2) / quantity(material.young, "pressure", "young") for material in materials
        )
        width = quantity(self.width, "length", "width", above=0.0)
        return LineContact(width, 1.0 / yielding, 1.0 / roller if roller else 0.0)


@dataclass(frozen=True)
class LineContact:
    """A contact along a line: p = sqrt(N E / (pi width R)) with 1/E the sum of (1 - nu²)/E of both bodies, SI units.

    >>> contact = LineContact(0.02, 210e9 / (2.0 * (1.0 - 0.3**2)), 1.0 / 0.012)
    >>> round(float(contact.squared(Jet((1000.0,)), Jet((1.0 / 0.08,))).terms[0]) ** 0.5 / 1e6, 3)
    419.51
    """

    width: float
    modulus: float
    roller_curvature: float

    def squared(self, force: Jet, curvature: Jet) -> Jet:
        """The square of it where the cam has a curvature: smooth where the follower lifts off, and below 0 beyond."""
        both = curvature + self.roller_curvature
        if np.any(highest(both.terms[0]) < 0.0):
            raise InputError("the cam is concave where a flat face or a roller that is wider would touch it elsewhere")
        return force * both * (self.modulus / (pi * self.width))


_PARTS = 12


class ForceCurve(NamedTuple):
    """A force, torque or pressure of a cam in SI units over the cam's angle, and the unit of tables."""

    name: str
    function: Callable[[Array], Any]
    extremes: Extremes
    unit: str
    factor: float = 1.0

    def values(self, angles: Array) -> Array:
        """The values of tables at angles in radians, 0 where they are rounding."""
        return self.factor * chopped(np.asarray(self.function(angles)), self.extremes.peak, FORCE_ROUNDING)


@documented_by(Surfaces)
@dataclass(frozen=True)
class CamForces:
    """The forces of a cam and its follower at a speed, over the cam's angle in radians; N, N m, Pa.

    Parameters
    ----------
    cam
        The cam.
    speed
        Of the cam, such as "300 rpm"; that of its cycle unless given.
    drive
        What the follower moves: entries of a cycle's drive, mass (or inertia), stiffness, preload, gravity, viscous and
        dry; the drive of its cycle unless given. Spring and preload press the follower on the cam.
    process
        The force of a process on the follower, with the entries of a cycle's: `{"force": [("0 deg", "0 N"), ("90 deg",
        "-300 N"), ("360 deg", "0 N")], "over": "master"}`, above 0 where it pushes to greater displacements; over the
        "time" t, the "master", which is the cam's angle m, or the displacement s of the "driven" follower. A table over
        time or angle jumps where a place is given twice. The process force of its cycle unless given.

    Raises
    ------
    InputError
        If there is no speed or no drive, or an entry is unknown or of another dimension.

    Examples
    --------
    >>> from optlaws import Cycle, Dwell, Return, Rise
    >>> from optlaws import TranslatingRoller
    >>> moves = [Rise("40 mm", "120 deg", law="3-4-5"), Dwell("60 deg"), Return(law="3-4-5")]
    >>> cam = DiscCam(Cycle(moves, speed="200 rpm"), prime_radius="80 mm", follower=TranslatingRoller("12 mm"))
    >>> forces = CamForces(cam, drive={"mass": "2 kg", "stiffness": "3 N/mm", "preload": "60 N"}, width="20 mm")
    >>> round(forces.contact.most, 3), round(forces.torque.most, 3), round(forces.rms_torque[1], 3)
    (180.0, 4.299, 2.05)
    >>> forces.lifts_off, abs(forces.mean_torque[1]) < 1e-7, round(forces.pressure.most / 1e6, 2)
    (False, True, 174.95)
    """

    cam: DiscCam
    speed: NumberOrQuantity | None = None
    drive: Mapping[str, Any] | None = None
    friction: Mapping[str, Any] = field(default_factory=dict)
    width: NumberOrQuantity | None = None
    materials: Any = ("steel", "steel")
    process: Mapping[str, Any] | None = None

    def __post_init__(self) -> None:
        self.rate, self.load, self.process_force, self._surfaces.friction, self._line  # noqa: B018 - what is wrong is refused at once

    @kept_property
    def rate(self) -> float:
        """The cam's angular velocity, rad/s."""
        if self.speed is not None:
            return quantity(self.speed, "angular velocity", "speed", above=0.0)
        if not isinstance(self.cam.motion, Cycle | Plan):
            raise InputError("forces need the cam's speed: give one, such as speed='300 rpm'")
        return TURN / self.cam.motion.duration

    @kept_property
    def load(self) -> LinearForce:
        """The inertia, spring and friction that the follower moves, in SI units."""
        motion = self.cam.motion
        given = motion.drive if self.drive is None and isinstance(motion, Cycle | Plan) else self.drive
        if given is None:
            raise InputError("forces need what the follower moves: give a drive, such as drive={'mass': '2 kg'}")
        return read_linear_drive(given, self.cam.displacement.axis)[1]

    @kept_property
    def process_force(self) -> ProcessByAngle:
        """The force of the process on the follower over the cam's angle."""
        return read_process_by_angle(process_on(self.cam, self.process), self.cam.displacement, self.rate)

    @kept_property
    def edges(self) -> Array:
        """Angles between which forces are smooth, rad: of motion and process, and where the follower turns back."""
        return np.unique(np.concatenate([self.cam.displacement.monotone_edges, self.process_force.edges]))

    def follower_force(self, angle: Any) -> Any:
        """The force on the follower along its way, N, or the torque about its pivot, N m."""
        jet = self.cam.displacement.jet
        return self._given(lambda at, order: self._taken(jet(at, order + 2), at), angle)

    def contact_force(self, angle: Any) -> Any:
        """The force between cam and follower along their normal, N; below 0 where the follower would lift off."""
        return self._given(self._contact_force, angle)

    def shaft_torque(self, angle: Any) -> Any:
        """The torque that turns the cam, N m; below 0 where the follower drives it."""
        return self._given(self._torque, angle)

    def contact_pressure(self, angle: Any) -> Any:
        """Hertz's greatest pressure in the contact, Pa."""
        return self._root(self._squared_pressure, angle)

    @kept_property
    def contact(self) -> Extremes:
        """Least and greatest contact force, enclosed over the turn."""
        return self._enclosed(self._contact_force)

    @property
    def lifts_off(self) -> bool:
        """Whether the contact force is below 0 somewhere, by more than the width of its enclosure."""
        return self.contact.low < -FORCE_EXTREMES * self.contact.peak

    @kept_property
    def torque(self) -> Extremes:
        """Least and greatest torque at the shaft, enclosed over the turn."""
        return self._enclosed(self._torque)

    @kept_property
    def pressure(self) -> Extremes:
        """Least and greatest of Hertz's pressure, enclosed over the turn; 0 where the follower lifts off.

        Of a pair it is that of the first cam, 0 where the return cam presses.
        """
        return roots(self._enclosed(self._squared_pressure))

    @property
    def curves(self) -> list[ForceCurve]:
        """Contact force, torque at the shaft and, where the contact has a width, Hertz's pressure."""
        curves = [
            ForceCurve("contact force", self.contact_force, self.contact, "N"),
            ForceCurve("torque at the shaft", self.shaft_torque, self.torque, "N m"),
        ]
        if self.width is not None:
            curves.append(ForceCurve("Hertz's pressure", self.contact_pressure, self.pressure, "MPa", MPA))
        return curves

    @kept_property
    def mean_torque(self) -> tuple[float, float]:
        """The interval of the mean torque, 0 over a turn without friction and process force."""
        low, high = integral(self._torque, self.edges, share=FORCE_EXTREMES)
        return low / self._angle, high / self._angle

    @kept_property
    def rms_torque(self) -> tuple[float, float]:
        """The interval of the root mean square of the torque."""

        def square(angle: Array | Interval, order: int) -> Jet:
            torque = self._torque(angle, order)
            return torque * torque

        low, high = integral(square, self.edges, share=FORCE_EXTREMES)
        return sqrt(max(low, 0.0) / self._angle), sqrt(max(high, 0.0) / self._angle)

    def results(self) -> dict[str, Any]:
        """Peaks with their places in degrees, and means, as plain data in SI units."""
        extremes = {name: plain_extremes(getattr(self, name)) for name in ("contact", "torque")}
        pressed = {} if self.width is None else {"pressure": plain_extremes(self.pressure)}
        return {
            "speed": self.rate,
            **extremes,
            **pressed,
            "rms_torque": self.rms_torque[1],
            "mean_torque": 0.5 * sum(self.mean_torque),
            "lifts_off": self.lifts_off,
        }

    @property
    def _angle(self) -> float:
        return float(self.edges[-1] - self.edges[0])

    @kept_property
    def _surfaces(self) -> Surfaces:
        given: Any = self.friction
        surfaces = Surfaces(given, self.width, self.materials)
        if surfaces.friction.guide and self.cam.displacement.axis == "angle":
            raise InputError("friction: guide is that of a slide, and needs overhang and length of its guide")
        return surfaces

    @kept_property
    def _line(self) -> LineContact | None:
        return self._surfaces.line(self.cam.contact.roller)

    @kept_property
    def _directions(self) -> Array:
        """1, -1 or 0 between edges: whether the follower goes up, down, or rests."""
        middles = 0.5 * (self.edges[1:] + self.edges[:-1])
        slopes = np.asarray(self.cam.displacement(middles, 1))
        return np.where(np.abs(slopes) > 1e-12 * np.abs(slopes).max(), np.sign(slopes), 0.0)

    def direction(self, angle: Array | Interval) -> Array:
        """1 where the follower goes up, -1 where it goes down, 0 where it rests."""
        which = np.searchsorted(self.edges[1:-1], self.cam.displacement.within(middle(angle)), side="right")
        return np.asarray(self._directions[which])

    def _given(self, function: Callable[[Any, int], Jet], angle: Any) -> Any:
        return number_or_array(np.asarray(function(real_times(angle), 0).terms[0]))

    def _root(self, squared: Callable[[Any, int], Jet], angle: Any) -> Any:
        return number_or_array(np.sqrt(np.maximum(self._given(squared, angle), 0.0)))

    def _enclosed(self, function: Function) -> Extremes:
        return extremes(function, self.edges, share=FORCE_EXTREMES, parts=_PARTS)

    def _taken(self, s: Jet, angle: Array | Interval) -> Jet:
        rate, load, slope = self.rate, self.load, s.slope()
        moved = slope.slope() * (load.inertia * rate**2) + slope * (load.viscous * rate) + s * load.stiffness
        return moved + (load.constant + load.dry * self.direction(angle)) - self.process_force.jet(angle, moved.order)

    def _contact_force(self, angle: Array | Interval, order: int) -> Jet:
        return self._pressed(angle, order)[-1]

    def lever(self, angle: Array | Interval, order: int) -> Jet:
        """The force that drives the follower for a contact force of 1 N, N, or the torque, N m; friction included."""
        return self._driven(self.cam.displacement.jet(angle, order + 2), angle)[1]

    def _driven(self, s: Jet, angle: Array | Interval) -> tuple[Transmission, Jet]:
        unit = self.cam.contact.transmission(s)
        lever = unit.lever_with(self._surfaces.friction.contact)
        if self._surfaces.friction.guide:
            lever = lever - self._surfaces.friction.in_guide(unit) * self.direction(angle)
        sure = highest(lever.terms[0])
        if np.any(sure <= 0.0):
            place = in_degrees(float(middle(angle).flat[int(np.argmin(sure))]))
            raise InputError(
                sentence(
                    "the follower jams in its guide at {} of the cam: lessen the pressure angle, the friction of the "
                    "guide or its overhang, or make the guide longer",
                    place,
                )
            )
        return unit, lever

    def _pressed(self, angle: Array | Interval, order: int) -> tuple[Jet, Transmission, Jet]:
        """The displacement, the effect of a force of 1 N, and the contact force."""
        s = self.cam.displacement.jet(angle, order + 2)
        unit, lever = self._driven(s, angle)
        return s, unit, self._taken(s, angle) / lever

    def _torque(self, angle: Array | Interval, order: int) -> Jet:
        s, unit, force = self._pressed(angle, order)
        driven = force * unit.lever_with(self._surfaces.friction.contact) * s.slope()
        if not self._surfaces.friction.contact:
            return driven
        return driven + unit.sliding * force.maximum(0.0) * self._surfaces.friction.contact

    def _squared_pressure(self, angle: Array | Interval, order: int) -> Jet:
        if self._line is None:
            raise InputError("the pressure needs the width of the contact: give one, such as width='20 mm'")
        s, _, force = self._pressed(angle, order)
        try:
            return self._line.squared(force, self.cam.contact.profile_curvature(s))
        except InputError:
            undercut = self.cam.extremes.undercut
            if undercut.status != UNDERCUT:
                raise
            raise InputError(f"the follower cannot follow the cam, so that there is no pressure: {undercut}") from None


def roots(square: Extremes) -> Extremes:
    """The square roots of extremes, 0 where the square, which is as the force, is below 0 or rounding."""
    sizes = {name: getattr(square, name) for name in ("least", "low", "most", "high")}
    least = max(FORCE_ROUNDING * square.most, 0.0)
    return square._replace(**{name: sqrt(size) if size > least else 0.0 for name, size in sizes.items()})


def plain_extremes(enclosure: Extremes) -> dict[str, float]:
    """An enclosure as plain data, with its places in degrees."""
    return {
        "least": enclosure.least,
        "least_at": degrees(enclosure.least_at),
        "most": enclosure.most,
        "most_at": degrees(enclosure.most_at),
        "low": enclosure.low,
        "high": enclosure.high,
    }


def process_on(cam: DiscCam, given: Any) -> Any:
    """The entries of a process force on the follower of a cam: those given, or else those of the load of its cycle."""
    motion = cam.motion
    if given is not None or not isinstance(motion, Cycle | Plan) or not is_process(motion.load):
        return given
    load = dict(motion.load)
    return load | {"over": "driven"} if load.get("over") == "input" else load  # the follower is the input


#: what a force may be over, with the name in formulas
VARIABLES = {"time": "t", "master": "m", "driven": "s"}


class ForceStretch(NamedTuple):
    """A range of the cam's angle, rad, in which the force is a smooth formula."""

    start: float
    stop: float
    formula: Formula


@dataclass(frozen=True)
class ProcessByAngle:
    """The force of a process on a follower over the cam's angle, N; a torque in N m on a follower that swings.

    It is above 0 where it pushes the follower along its way, off the cam.

    Parameters
    ----------
    motion
        Of the follower.
    stretches
        One after the other, over the whole motion; none where there is no process.
    name
        Of the variable in their formulas: "m", the cam's angle, or "s", the displacement.
    """

    motion: CamMotion
    stretches: tuple[ForceStretch, ...] = ()
    name: str = "m"

    @kept_property
    def edges(self) -> Array:
        """Angles between which it is smooth, rad."""
        return np.unique([place for stretch in self.stretches for place in stretch[:2]])

    def jet(self, angle: Array | Interval, order: int) -> Jet:
        """The force with its Taylor terms, taken from the stretch that contains an angle or an interval's midpoint."""
        if not isinstance(angle, Interval):
            return Jet(tuple(term.middle for term in self.jet(exact(self.motion.within(angle)), order).terms))
        if not self.stretches:
            return variable(angle, order) * 0.0

        def along(stretch: ForceStretch, at: Interval) -> Jet:
            place = variable(at, order) if self.name == "m" else self.motion.jet(at, order)
            return formula_jet(stretch.formula, self.name, place)

        return jet_of_parts(self.stretches, along, angle)


def read_process_by_angle(
    given: ProcessEntries | Mapping[str, Any] | None, motion: CamMotion, rate: float | None
) -> ProcessByAngle:
    """A process force from its entries, as cycles have it on mechanisms; none without entries.

    `force`, or `torque` on a follower that swings, is a table, a formula or a quantity, above 0 where it pushes to
    greater displacements; `over` the "time" t from the beginning of the motion, the "master", which is the cam's angle
    m, or the displacement s of the "driven" follower. Over time and angle a table jumps where a place is given twice.

    Parameters
    ----------
    given
        The entries.
    motion
        Of the follower.
    rate
        The angular velocity of the cam, rad/s; None where there is a range of them, and then no force is over time.

    Raises
    ------
    InputError
        If an entry is unknown or wrong, or a table ends within the motion.
    """
    if given is None:
        return ProcessByAngle(motion)
    process = ValueOf(ProcessEntries).read(given, "process")
    kind, over, interpolation = process.kind, process.over, process.interpolation
    right = FORCES[motion.axis]
    if kind != right:
        raise InputError(f"process: on this follower acts a {right}: give {right} in place of {kind}")
    if over == "time" and rate is None:
        raise InputError(
            "process: a force over time is another at each speed: give it over the 'master', the cam's angle"
        )
    name, dimension = VARIABLES[over], {"time": "time", "master": "angle"}.get(over, motion.axis)
    runs = _runs(process.given, (dimension, kind), f"process: {kind}", name, interpolation)
    if over == "driven":
        if len(runs) > 1:
            raise InputError(f"process: {kind}: over the follower's way its table gives a place twice: give it once")
        return ProcessByAngle(motion, tuple(_over_way(runs[0], motion)), "s")
    if over == "time":
        runs = [rescaled(run, "t", "m", (0.0, 1.0 / (rate or 1.0))) for run in runs]
    return ProcessByAngle(motion, tuple(_over_angle(runs, motion, kind)))


def _runs(
    given: Any,
    dimensions: tuple[str, str],
    name: str,
    variable_name: str,
    interpolation: TableKind,
) -> list[Formula]:
    """The formula, or the tables between jumps, where a place is given twice."""
    pairs = list(given.items()) if isinstance(given, Mapping) else given
    if not isinstance(pairs, list | tuple):
        return [formula_of(given, dimensions, name, variable=variable_name, interpolation=interpolation)]
    runs: list[list[tuple[float, float]]] = [[]]
    for place, value in table_numbers(list(pairs), dimensions, name):
        if runs[-1] and place == runs[-1][-1][0]:
            runs.append([])
        runs[-1].append((place, value))
    return [formula_of(run, dimensions, name, variable=variable_name, interpolation=interpolation) for run in runs]


def _over_angle(runs: list[Formula], motion: CamMotion, kind: str) -> list[ForceStretch]:
    """Smooth stretches of formulas of the cam's angle."""
    (first, last), breaks = motion.interval, np.array(motion.breaks)
    stretches: list[ForceStretch] = []
    for run in runs:
        places = [_snapped(place, breaks) for place in table_places(run, "m")]
        ends = (places[0], places[-1]) if isinstance(run, Table) else (first, last)
        within = [ends[0], *(place for place in places if ends[0] < place < ends[1]), ends[1]]
        stretches += [ForceStretch(*cell, _smooth_at(run, "m", 0.5 * sum(cell))) for cell in pairwise(within)]
    inside = [stretch for stretch in stretches if stretch.stop > first and stretch.start < last]
    whole = bool(inside) and inside[0].start <= first and inside[-1].stop >= last
    if not whole or any(each.stop != following.start for each, following in pairwise(inside)):
        shown = (f"{degrees(place):.6g}" for place in (stretches[0].start, stretches[-1].stop, first, last))
        raise InputError(
            "process: {}: its table goes from {} to {} deg of the cam, and the motion from {} to {} deg: give a table "
            "that ascends over the whole motion".format(kind, *shown)
        )
    return [each._replace(start=max(each.start, first), stop=min(each.stop, last)) for each in inside]


def _over_way(force: Formula, motion: CamMotion) -> list[ForceStretch]:
    """Smooth stretches of a formula of the displacement: between the angles at which it is at a place of a table."""
    edges: list[float] = []
    places = table_places(force, "s")
    for low, high in pairwise(motion.monotone_edges.tolist()):
        first, last = float(motion(low)), float(motion.jet(np.array(high), 0, before=True).terms[0])
        within = [place for place in places if min(first, last) < place < max(first, last)]
        edges += [
            low,
            *(
                _reached(motion, place, (low, high), rises=last > first)
                for place in within[:: 1 if last > first else -1]
            ),
        ]
    edges.append(motion.interval[1])
    middles = [0.5 * (low + high) for low, high in pairwise(edges)]
    formulas = (_smooth_at(force, "s", float(motion(middle))) for middle in middles)
    return [ForceStretch(*cell, formula) for cell, formula in zip(pairwise(edges), formulas, strict=True)]


def _reached(motion: CamMotion, place: float, ends: tuple[float, float], *, rises: bool) -> float:
    """The angle in a range of monotone motion at which the follower is at a position."""
    return bisect(lambda at: bool((motion(at) < place) == rises), *ends)[0]


def _snapped(place: float, breaks: Array) -> float:
    """A place, moved to a break of the motion if it differs from it by rounding only."""
    nearest = float(breaks[np.argmin(np.abs(breaks - place))])
    return nearest if abs(nearest - place) <= CLOSURE * TURN else place


def _smooth_at(formula: Formula, name: str, at: float) -> Formula:
    """A formula in which the polynomial that it is at a place stands for each table of a name."""
    if isinstance(formula, Table) and formula.of == Name(name):
        piece = int(np.clip(np.searchsorted(formula.places, at, side="right") - 1, 0, len(formula.places) - 2))
        step = added([Name(name), number(-formula.places[piece])])
        polynomial: Formula = number(0.0)
        for coefficient in pieces(formula)[piece, ::-1].tolist():
            polynomial = added([number(coefficient), multiplied([polynomial, step])])
        return polynomial
    if name not in formula.names():
        return formula
    return rebuilt(formula, [_smooth_at(part, name, at) for part in formula.parts])
