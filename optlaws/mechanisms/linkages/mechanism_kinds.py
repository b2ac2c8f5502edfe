"""Mechanisms by their kinds: bodies and loads reduced to the input as formulas, slides, and motions.

Functions, files, forms and errors are made from the entries of a kind.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import KW_ONLY, dataclass
from functools import wraps
from importlib import import_module
from inspect import signature
from math import cos, sin
from typing import Any, ClassVar, Literal, ParamSpec, Self, TypeAlias, cast, get_args

import numpy as np

from optlaws.echo import shortened
from optlaws.entries.declared import Declared, Kinded, TableOf, ValueOf, declared, entry
from optlaws.entries.value_types import Choice, InSI, Kept, Measured, ReadBy, SINumber, Span, Together, ValueType
from optlaws.errors import InputError
from optlaws.files.reading import check_names
from optlaws.formulas.slopes import added, derivative, multiplied
from optlaws.formulas.tracing import Traced, traced
from optlaws.formulas.tree import Exponentiation, Formula, Name, Number, number, substituted
from optlaws.mechanisms.linkages.mechanism import LinkGeometry, Mechanism
from optlaws.mechanisms.linkages.mechanism_formulas import OverPlace, TableKind, formula_of
from optlaws.motion.quantities import TURN, either, quantity
from optlaws.numbers import NumberOrQuantity, finite, not_negative
from optlaws.tolerances import WAVE_ROUNDING

GRAVITY = 9.80665
LoadPlace = Literal["driven", "input"]
Centre: TypeAlias = Kept[tuple[float, float], "tuple[NumberOrQuantity, NumberOrQuantity]"]
P = ParamSpec("P")
OptionalEnds: TypeAlias = Kept["tuple[float, float] | None", "tuple[NumberOrQuantity, NumberOrQuantity] | None"]
LENGTH, MASS = InSI("length", above=0.0), InSI("mass", above=0.0)


@declared
class Body(Declared, title="a body"):
    """The mass of a link: how great, where its centre is, and its moment of inertia about that.

    Raises
    ------
    InputError
        If mass or inertia is below 0, or a quantity is of another dimension.

    Examples
    --------
    >>> Body("2 kg", centre=("0.1 m", "20 mm"))
    Body(mass=2.0, centre=(0.1, 0.02), inertia=0.0)
    """

    mass: SINumber = entry(InSI("mass", least=0.0), "Its mass.", default=0.0, example="2 kg")
    _: KW_ONLY
    centre: Centre = entry(
        Together(InSI("length"), InSI("length"), names=("along", "across")),
        "Of mass, from the link's first joint: along the link towards its second joint, and across it, to the left.",
        default=(0.0, 0.0),
        example=["0.1 m", "0 m"],
    )
    inertia: SINumber = entry(
        InSI("moment of inertia", least=0.0),
        "Moment of inertia about the centre of mass.",
        default=0.0,
        example="0.002 kg m^2",
    )

    def about(self, distance_squared: float) -> float:
        """The moment of inertia about a point at a distance from the centre of mass."""
        return self.inertia + self.mass * distance_squared

    @property
    def about_joint(self) -> float:
        """The moment of inertia about the link's first joint."""
        return self.about(self.centre[0] ** 2 + self.centre[1] ** 2)


@declared
class Loads(Declared, title="loads"):
    """Loads on a mechanism: a process force and a spring on its driven link, and gravity on all its links.

    Examples
    --------
    >>> Loads({"0.3 m": "0 N", "0.31 m": "-400 N", "0.5 m": "-400 N"}, gravity="180 deg").over
    'driven'
    """

    force: Any = entry(
        OverPlace("s (the position of the link) or x (the input's)"),
        "On the driven link, above 0 where it pushes to greater positions; a torque for a link that turns.",
        default=0.0,
        example="-200 N",
    )
    over: LoadPlace = entry(
        Choice(*get_args(LoadPlace)),
        "Whether the force is over the position of the driven link or over the input's.",
        default="driven",
        label="force over",
    )
    _: KW_ONLY
    interpolation: TableKind = entry(
        Choice(*get_args(TableKind)),
        "Of a table: straight lines, or a spline, a smooth curve that rises and falls as the values do and is nowhere "
        "beyond its two neighbours.",
        default="lines",
    )
    stiffness: NumberOrQuantity = entry(
        Measured("stiffness", "torsional stiffness", bare=True, least=0.0),
        "Of a spring between the driven link and the frame.",
        default=0.0,
        example="3 N/mm",
    )
    free: NumberOrQuantity = entry(
        Measured("length", "angle", bare=True),
        "The position of the driven link at which the spring is without force.",
        default=0.0,
        example="10 mm",
    )
    gravity: NumberOrQuantity | None = entry(
        Measured("angle"),
        "The direction in which gravity acts in the plane of the mechanism; none unless given.",
        default=None,
        example="-90 deg",
    )

    @property
    def weight(self) -> tuple[float, float]:
        """Gravity in the plane of the mechanism, m/s²."""
        if self.gravity is None:
            return 0.0, 0.0
        angle = quantity(self.gravity, "angle", "gravity")
        vector = GRAVITY * np.array([cos(angle), sin(angle)])
        across, down = np.where(np.abs(vector) < WAVE_ROUNDING * GRAVITY, 0.0, vector).tolist()
        return across, down

    def on(self, link: DrivenLink, input_axis: str) -> list[Formula]:
        """The terms of the load at the input by what acts on the driven link."""
        forces = ("force", "stiffness") if link.axis == "length" else ("torque", "torsional stiffness")
        variable, axis = ("s", link.axis) if self.over == "driven" else ("x", input_axis)
        force = formula_of(self.force, (axis, forces[0]), "force", variable=variable, interpolation=self.interpolation)
        stiffness = not_negative(quantity(self.stiffness, forces[1], "stiffness", bare=True), "stiffness")
        free = finite(quantity(self.free, link.axis, "free", bare=True), "free")
        if link.position is None:
            if stiffness or "s" in force.names():
                raise InputError(
                    f"loads: the {link.name} turns so far in this range that its position has no formula: give a "
                    "torque over='input', or a shorter range"
                )
            return [multiplied([number(-1.0), force, link.velocity])]
        acting = substituted(force, {"s": link.position})
        terms = [] if acting == Number(0.0) else [multiplied([number(-1.0), acting, link.velocity])]
        if stiffness:
            terms.append(multiplied([number(stiffness), added([link.position, number(-free)]), link.velocity]))
        return terms


NO_LOADS = Loads()


@dataclass(frozen=True)
class DrivenLink:
    """A link that does the work: its name, its position and velocity by the input, and whether it slides or turns."""

    name: str
    position: Formula | None  #: one that turns very far has none without a jump
    velocity: Formula
    axis: str


@dataclass(frozen=True)
class Link:
    """A link that turns in the plane of a mechanism: where it lies, and how it moves with the input's position x."""

    way: tuple[Any, Any]  #: from its first joint to its second, which is `length` long
    turning: Any  #: its angular velocity by x
    length: float
    carrier: Link | None = None  #: on whose second joint its first one is; without one it turns about a pivot
    axis: float = 0.0  #: the direction of the coordinates, rad from the first one of the mechanism's

    def moved(self, body: Body, gravity: tuple[float, float]) -> tuple[list[Formula], list[Formula]]:
        """The terms of inertia and load at the input by a body on the link."""
        (u, w), (p, q) = self.way, (place / self.length for place in body.centre)
        dx, dy = p * u - q * w, p * w + q * u
        inertia, velocity = [reduced_inertia(body.about_joint, self.turning)], (-self.turning * dy, self.turning * dx)
        if self.carrier is not None:
            (x, y), carried = self.carrier.way, self.carrier.turning
            velocity = -carried * y + velocity[0], carried * x + velocity[1]
            both = self.carrier.length**2 * carried + 2.0 * self.turning * (x * dx + y * dy)
            inertia = [multiplied([number(body.mass), formula_from(carried * both)]), *inertia]
        c, s = cos(self.axis), sin(self.axis)
        weights = body.mass * (gravity[0] * c + gravity[1] * s), body.mass * (gravity[1] * c - gravity[0] * s)
        load = [multiplied([number(-f), formula_from(v)]) for f, v in zip(weights, velocity, strict=True)]
        return inertia, load


@dataclass(frozen=True)
class Slide:
    """A link that slides in a direction, rad, with a velocity by the input's position x."""

    velocity: Any
    axis: float = 0.0

    def moved(self, body: Body, gravity: tuple[float, float]) -> tuple[list[Formula], list[Formula]]:
        """The terms of inertia and load at the input by a body on the link."""
        along = gravity[0] * cos(self.axis) + gravity[1] * sin(self.axis)
        load = multiplied([number(-body.mass * along), formula_from(self.velocity)])
        return [reduced_inertia(body.mass, self.velocity)], [load]


def reduced_inertia(weight: float, velocity: Any) -> Formula:
    """What a mass or a moment of inertia adds to the inertia at the input, by its velocity by x."""
    speed = formula_from(velocity)
    if isinstance(speed, Number):
        return number(weight * speed.value**2)
    return multiplied([number(weight), Exponentiation(speed, Number(2.0))])


def formula_from(value: Any) -> Formula:
    """The formula of what was computed with traced numbers."""
    return value.formula if isinstance(value, Traced) else value if isinstance(value, Formula) else number(float(value))


@dataclass(frozen=True)
class BodyOf(ValueType):
    """A body, its table, or the mass or moment of inertia that it is alone; nothing alone where no dimension is given.

    >>> BodyOf("mass").read("5 kg", "slider")
    Body(mass=5.0, centre=(0.0, 0.0), inertia=0.0)
    """

    dimension: str = ""

    def read(self, value: Any, name: str) -> Body:
        if isinstance(value, Body | Mapping):
            return cast("Body", ValueOf(Body).read(value, name))
        if not self.dimension:
            raise InputError(
                f"{name} is on no pivot and needs a Body with its mass and centre, such as Body('2 kg', "
                f"centre=('0.1 m', '0 m')), got {shortened(value)}"
            )
        number_ = InSI(self.dimension, least=0.0).number(value, name)
        return Body(number_) if self.dimension == "mass" else Body(inertia=number_)

    def plain(self, value: Any) -> Any:
        return value.to_dict()

    @property
    def words(self) -> str:
        return f"a {self.dimension}, or a body" if self.dimension else "a body"

    def schema(self) -> dict[str, Any]:
        alone = [InSI(self.dimension, least=0.0).schema()] if self.dimension else []
        return {"anyOf": [*alone, Body.json_schema()]}

    def form(self) -> dict[str, Any]:
        return {} if self.dimension else Body.form()


def bodies_of(pivoted: Sequence[str], coupled: Sequence[str], sliding: Sequence[str]) -> TableOf:
    """The bodies of a linkage by the names of its links; those that are not given have no mass."""
    turning, alone, moved = BodyOf("moment of inertia"), BodyOf(), BodyOf("mass")
    types = {**dict.fromkeys(pivoted, turning), **dict.fromkeys(coupled, alone), **dict.fromkeys(sliding, moved)}
    usual = {turning: "0.01 kg m^2", moved: "5 kg", alone: None}
    links = {
        name: entry(
            each,
            f"Of the {name}{' link' * (name in {'upper', 'lower'})}.",
            default=None,
            label=f"{name} body",
            example=usual[each],
        )
        for name, each in types.items()
    }
    return TableOf("body", links, keep=lambda given: {name: given.get(name, Body()) for name in links})


@declared
class MechanismKind(Kinded, ABC, title="a mechanism"):
    """The entries of a mechanism of one kind, as a file has them; friction at the input is one of all kinds."""

    #: whether its input usually turns at a constant velocity
    turns_steadily: ClassVar[bool] = False

    _: KW_ONLY
    coulomb: SINumber = entry(
        InSI("torque", least=0.0),
        "Friction that does not depend on the speed, at the input.",
        default=0.0,
        example="0.5 N m",
    )
    viscous: SINumber = entry(
        InSI("rotary viscous friction", least=0.0),
        "Friction in proportion to the speed, at the input.",
        default=0.0,
        example="0.02 N m s/rad",
    )

    @classmethod
    def kinds(cls) -> dict[str, type[Self]]:
        import_module(f"{__package__}.plane_linkages")
        return dict(sorted(super().kinds().items()))

    @classmethod
    def form(cls) -> dict[str, Any]:
        shown = super().form()
        if cls.kind:
            shown["entries"].sort(key=lambda each: each["name"] in {"coulomb", "viscous"})
        return shown

    @property
    @abstractmethod
    def mechanism(self) -> Mechanism:
        """The mechanism of these entries."""

    def _mechanism(
        self,
        inertia: list[Formula],
        load: list[Formula],
        over: tuple[float, float] | None,
        linkage: LinkGeometry,
    ) -> Mechanism:
        """A mechanism whose input turns, of the terms of its inertia and load."""
        friction, name = {"coulomb": self.coulomb, "viscous": self.viscous}, self.kind.replace(" ", "-")
        return Mechanism(added(inertia), added(load), **friction, over=over, axis="angle", name=name, linkage=linkage)


class MechanismTable(Mechanism, MechanismKind, kind="table"):
    """A mechanism by its inertia and load over the position of its input."""

    @property
    def mechanism(self) -> Mechanism:
        return self._changed()


def _read(value: Any) -> Mechanism:
    if isinstance(value, Mechanism):
        return value
    if isinstance(value, Mapping) and "kind" in value:
        return MechanismKind.from_dict(value).mechanism
    return Mechanism.from_dict(value)


#: a mechanism, its table with its kind, or what `Mechanism.to_dict` writes
MECHANISM = ReadBy(_read, "a mechanism", Mechanism.to_dict, {"type": "object"})


def function_of(kind: Callable[P, MechanismKind]) -> Callable[P, Mechanism]:
    """The function that makes the mechanism of a kind from its entries."""

    @wraps(kind, updated=())
    def make(*args: P.args, **entries: P.kwargs) -> Mechanism:
        return kind(*args, **entries).mechanism

    name = kind.kind.replace(" ", "_")  # type: ignore[attr-defined] # it is a class
    make.__name__ = make.__qualname__ = name
    vars(make)["__signature__"] = signature(kind).replace(return_annotation="Mechanism")
    return make


def mechanism_of_motion(
    function: Callable[[Any], Any],
    masses: Mapping[str, NumberOrQuantity],
    *,
    loads: Mapping[str, Loads] | None = None,
    over: tuple[NumberOrQuantity, NumberOrQuantity],
    name: str = "mechanism",
) -> Mechanism:
    """The mechanism whose driven links move by a Python function; the function is traced for exact derivatives.

    Parameters
    ----------
    function
        Of the input's position in rad or m: the positions of driven links in m or rad by their names, or one number
        alone, which is called "q1". It is called once, with a symbol: arithmetic and functions of numpy such as
        `np.sin`, `np.sqrt` and `np.arctan`; no branches on values.
    masses
        Of the links, by the same names: "5 kg" for one that slides, "0.1 kg m^2" for one that turns.
    loads
        What acts on the links, by their names.
    over
        The range of x.
    name
        What pictures and texts call it.

    Raises
    ------
    InputError
        If the function does what formulas cannot say, or a link has no mass of its name.

    Examples
    --------
    >>> import numpy as np
    >>> press = mechanism_of_motion(
    ...     lambda x: {"ram": 0.1 * np.cos(x) + np.sqrt(0.16 - (0.1 * np.sin(x)) ** 2)},
    ...     {"ram": "5 kg"},
    ...     over=("0 deg", "180 deg"),
    ... )
    >>> round(press.inertia("90 deg"), 9), round(press.inertia("90 deg", nu=1), 9)
    (0.05, -0.025819889)
    """
    acting = loads or {}
    positions = traced(function)
    check_names((*masses, *acting), positions, "driven link")
    axis = Mechanism(over=over).axis
    inertia, load = [], []
    for key, position in positions.items():
        if key not in masses:
            raise InputError(f"masses: what moves as {key!r} needs a mass, such as '5 kg', or '0 kg' if it has none")
        if not isinstance(masses[key], str) and not hasattr(masses[key], "units"):
            raise InputError(
                f"masses: {key} must be a mass such as '5 kg' for a link that slides, or a moment of inertia such as "
                f"'0.1 kg m^2' for one that turns, got {shortened(masses[key])}"
            )
        dimension, weight = either(masses[key], ("mass", "moment of inertia"), f"masses: {key}")
        link = DrivenLink(key, position, derivative(position, "x"), "length" if dimension == "mass" else "angle")
        inertia.append(reduced_inertia(not_negative(weight, f"masses: {key}"), link.velocity))
        load += acting.get(key, NO_LOADS).on(link, axis)
        if acting.get(key, NO_LOADS).gravity is not None:
            raise InputError(
                f"loads: {key}: a function has no plane for gravity: give weight as a force, such as '-49 N'"
            )
    return Mechanism(added(inertia), added(load), over=over, name=name, linkage=LinkGeometry(tuple(positions.items())))


@declared
class SlideKind(MechanismKind):
    """A slide that moves in proportion to the angle of the input."""

    #: the entry by which it moves, and with what angle
    moved_by: ClassVar[tuple[str, float]] = ("radius", 1.0)

    _: KW_ONLY
    inertia: SINumber = entry(
        InSI("moment of inertia", least=0.0), "Of what turns with the input.", default=0.0, example="1e-4 kg m^2"
    )
    loads: Loads = entry(
        ValueOf(Loads),
        "What acts on the slide; gravity's direction is from the slide's way, \"180 deg\" for one that goes straight "
        "up.",
        default=NO_LOADS,
    )
    over: OptionalEnds = entry(
        Span(InSI("angle")), "The range of x; without bound unless given.", default=None, example=["0 turn", "9 turn"]
    )

    @property
    def mechanism(self) -> Mechanism:
        way, angle = self.moved_by
        ratio, mass = getattr(self, way) / angle, vars(self)["mass"]
        position: Formula = multiplied([number(ratio), Name("x")])
        slide = DrivenLink("slide", position, number(ratio), "length")
        load = [number(-mass * self.loads.weight[0] * ratio), *self.loads.on(slide, "angle")]
        inertia = number(self.inertia + mass * ratio**2)
        return self._mechanism([inertia], load, self.over, LinkGeometry((("slide", position),)))


@declared
class Rack(SlideKind, kind="rack"):
    """The mechanism of a pinion that drives a rack; x is the pinion's angle, and the slide is at s = radius x.

    Examples
    --------
    >>> rack("20 mm", "12 kg", inertia="1e-4 kg m^2").inertia(0.0)
    0.0049
    """

    radius: SINumber = entry(LENGTH, "Of the pitch circle of the pinion that drives.", example="20 mm")
    mass: SINumber = entry(MASS, "Of the slide and what it carries.", example="12 kg")


@declared
class Belt(SlideKind, kind="belt"):
    """The mechanism of a pulley that drives a carriage by a belt; x is the pulley's angle, s = radius x.

    Examples
    --------
    >>> lift = belt("30 mm", "8 kg", loads=Loads(gravity="180 deg"))
    >>> round(lift.load(0.0), 6)
    2.353596
    """

    radius: SINumber = entry(LENGTH, "Of the driven pulley.", example="30 mm")
    mass: SINumber = entry(MASS, "Of the carriage and the belt.", example="8 kg")


@declared
class Screw(SlideKind, kind="screw"):
    """The mechanism of a screw that drives a nut; x is the screw's angle, s = lead x/(2 pi).

    Examples
    --------
    >>> axis = screw("10 mm", "80 kg", inertia="3e-4 kg m^2", loads=Loads(force="-500 N"))
    >>> round(axis.load(0.0), 6), round(axis.driven_position("slide", "1 turn"), 6)
    (0.795775, 0.01)
    """

    moved_by = ("lead", TURN)

    lead: SINumber = entry(LENGTH, "The travel of the nut per turn of the screw.", example="10 mm")
    mass: SINumber = entry(MASS, "Of the nut and what it carries.", example="80 kg")


rack, belt, screw = function_of(Rack), function_of(Belt), function_of(Screw)
