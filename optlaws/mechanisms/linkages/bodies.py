"""Bodies of a linkage and what acts on it: their inertia and load at the input, as formulas."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from math import cos, sin
from typing import Any, Literal, get_args

import numpy as np

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.formulas.slopes import added, multiplied
from optlaws.formulas.tracing import Traced
from optlaws.formulas.tree import Exponentiation, Formula, Number, number, substituted
from optlaws.mechanisms.linkages.entries import TableKind, formula_of
from optlaws.motion.quantities import quantity, si_number
from optlaws.numbers import NumberOrQuantity, finite, not_negative
from optlaws.suggest import unknown_key
from optlaws.tolerances import WAVE_ROUNDING

GRAVITY = 9.80665
LoadPlace = Literal["driven", "input"]


@dataclass(frozen=True, init=False)
class Body:
    """The mass of a link: how great, where its centre is, and its moment of inertia about that.

    Parameters
    ----------
    mass
        A quantity such as "5 kg", or a number in kg.
    centre
        Of mass, from the link's first joint: along the link towards its second joint, and across it, to the left.
    inertia
        Moment of inertia about the centre of mass, such as "0.002 kg m^2", or a number in kg m².

    Raises
    ------
    InputError
        If mass or inertia is below 0, or a quantity is of another dimension.

    Examples
    --------
    >>> Body("2 kg", centre=("0.1 m", "20 mm"))
    Body(mass=2.0, centre=(0.1, 0.02), inertia=0.0)
    """

    mass: float
    centre: tuple[float, float]
    inertia: float

    def __init__(
        self,
        mass: NumberOrQuantity = 0.0,
        *,
        centre: tuple[NumberOrQuantity, NumberOrQuantity] = (0.0, 0.0),
        inertia: NumberOrQuantity = 0.0,
    ) -> None:
        place: Any = centre
        if not isinstance(place, list | tuple) or len(place) != 2:
            raise InputError(f"centre must be two lengths, along the link and across it, got {shortened(place)}")
        along, across = (finite(si_number(value, ("length",), "centre"), "centre") for value in centre)
        object.__setattr__(self, "mass", not_negative(si_number(mass, ("mass",), "mass"), "mass"))
        object.__setattr__(self, "centre", (along, across))
        turning = si_number(inertia, ("moment of inertia",), "inertia")
        object.__setattr__(self, "inertia", not_negative(turning, "inertia"))

    def about(self, distance_squared: float) -> float:
        """The moment of inertia about a point at a distance from the centre of mass."""
        return self.inertia + self.mass * distance_squared

    @property
    def about_joint(self) -> float:
        """The moment of inertia about the link's first joint."""
        return self.about(self.centre[0] ** 2 + self.centre[1] ** 2)


@dataclass(frozen=True)
class Loads:
    """Loads on a mechanism: a process force and a spring on its driven link, and gravity on all its links.

    Parameters
    ----------
    force
        On the driven link, above 0 where it pushes to greater positions: a quantity such as "-200 N", a formula of the
        position s of the link (or of x, the input's) in SI units, or a table of places and forces; torques for a link
        that turns.
    over
        "driven" where the force is over the position of the driven link, "input" where it is over the input's.
    interpolation
        Of a table: straight "lines", or "spline", a smooth curve that rises and falls as the values do and is nowhere
        beyond its two neighbours.
    stiffness
        Of a spring between the driven link and the frame, such as "3 N/mm", or "5 N m/rad".
    free
        The position of the driven link at which the spring is without force.
    gravity
        The direction in which it acts in the plane of the mechanism, such as "-90 deg"; none unless given.

    Examples
    --------
    >>> Loads({"0.3 m": "0 N", "0.31 m": "-400 N", "0.5 m": "-400 N"}, gravity="180 deg").over
    'driven'
    """

    force: Any = 0.0
    over: LoadPlace = "driven"
    interpolation: TableKind = field(default="lines", kw_only=True)
    stiffness: NumberOrQuantity = field(default=0.0, kw_only=True)
    free: NumberOrQuantity = field(default=0.0, kw_only=True)
    gravity: NumberOrQuantity | None = field(default=None, kw_only=True)

    def __post_init__(self) -> None:
        if self.over not in tuple(get_args(LoadPlace)):
            raise InputError(unknown_key(self.over, get_args(LoadPlace), "over of loads"))
        if self.interpolation not in tuple(get_args(TableKind)):
            raise InputError(unknown_key(self.interpolation, get_args(TableKind), "interpolation"))
        self.weight  # noqa: B018 - what is wrong is refused at once

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
        stiffness = not_negative(si_number(self.stiffness, (forces[1],), "stiffness"), "stiffness")
        free = finite(si_number(self.free, (link.axis,), "free"), "free")
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
    """A link that does the work: its name, its position and velocity by the input, and whether it slides or turns.

    The position of one that turns very far has no formula without a jump.
    """

    name: str
    position: Formula | None
    velocity: Formula
    axis: str


@dataclass(frozen=True)
class Moving:
    """Something that the input moves: its velocity by x, and its mass or inertia."""

    weight: float
    velocity: Any

    @property
    def inertia(self) -> Formula:
        """Its part of the inertia at the input."""
        velocity = formula_from(self.velocity)
        constant = number(self.weight)
        if velocity == Number(1.0):
            return constant
        return multiplied([constant, Exponentiation(velocity, Number(2.0))])


def formula_from(value: Any) -> Formula:
    """The formula of what was computed with traced numbers."""
    if isinstance(value, Traced):
        return value.formula
    return value if isinstance(value, Formula) else number(float(value))


def bodies_of(given: Any, pivoted: Sequence[str], coupled: Sequence[str], sliding: Sequence[str]) -> dict[str, Body]:
    """The bodies of a linkage by the names of its links; those that are not given have no mass.

    Links on a pivot may be given as a moment of inertia about it, those that slide as a mass.
    """
    names = (*pivoted, *coupled, *sliding)
    if not isinstance(given, Mapping):
        raise InputError(f"bodies must be a table such as {{'{names[0]}': '0.02 kg m^2'}}, got {shortened(given)}")
    for name in given:
        if name not in names:
            raise InputError(unknown_key(name, names, "body"))
    bodies = dict.fromkeys(names, Body())
    for name, value in given.items():
        bodies[name] = _body(value, name, "mass" if name in sliding else "moment of inertia", name in coupled)
    return bodies


def _body(value: Any, name: str, dimension: str, is_coupled: bool) -> Body:  # noqa: FBT001
    if isinstance(value, Body):
        return value
    if is_coupled:
        raise InputError(
            f"bodies: {name} is on no pivot and needs a Body with its mass and centre, such as Body('2 kg', "
            f"centre=('0.1 m', '0 m')), got {shortened(value)}"
        )
    number_ = not_negative(si_number(value, (dimension,), f"bodies: {name}"), f"bodies: {name}")
    return Body(number_) if dimension == "mass" else Body(inertia=number_)


def weight_load(mass: float, gravity: tuple[float, float], velocity: tuple[Any, Any]) -> list[Formula]:
    """The terms of the load at the input by the weight of a mass whose velocity by x is given."""
    return [
        multiplied([number(-mass * part), formula_from(speed)])
        for part, speed in zip(gravity, velocity, strict=True)
        if mass * part != 0.0
    ]


def length(value: Any, name: str) -> float:
    """A length above 0 in metres, from a number or a quantity."""
    metres = finite(si_number(value, ("length",), name), name)
    if metres <= 0.0:
        raise InputError(f"{name} must be above 0, got {shortened(value)}")
    return metres


def ends_of(over: Any) -> tuple[float, float]:
    """The ends of a range of the input's angle, rad."""
    if not isinstance(over, list | tuple) or len(over) != 2:
        raise InputError(f"over must be two angles such as ('0 deg', '360 deg'), got {shortened(over)}")
    low, high = (finite(si_number(value, ("angle",), "over"), "over") for value in over)
    if not low < high:
        raise InputError(f"over must be two angles that ascend, got {shortened(over)}")
    return low, high
