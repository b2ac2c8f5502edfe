"""Mechanisms by their kinds, from whose entries functions, files, forms and errors are made; slides, and motions."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Mapping
from dataclasses import KW_ONLY
from functools import wraps
from importlib import import_module
from inspect import signature
from typing import Any, ClassVar, ParamSpec, Self, TypeAlias

from optlaws.echo import shortened
from optlaws.entries.declared import Kinded, ValueOf, declared, entry
from optlaws.entries.value_types import InSI, Kept, ReadBy, SINumber, Span
from optlaws.errors import InputError
from optlaws.files.reading import check_names
from optlaws.formulas.slopes import added, derivative, multiplied
from optlaws.formulas.tracing import traced
from optlaws.formulas.tree import Formula, Name, number
from optlaws.mechanisms.linkages.bodies import NO_LOADS, DrivenLink, Loads, reduced_inertia
from optlaws.mechanisms.linkages.mechanism import LinkGeometry, Mechanism
from optlaws.motion.quantities import TURN, either
from optlaws.numbers import NumberOrQuantity, not_negative

P = ParamSpec("P")
OptionalEnds: TypeAlias = Kept["tuple[float, float] | None", "tuple[NumberOrQuantity, NumberOrQuantity] | None"]
LENGTH, MASS = InSI("length", above=0.0), InSI("mass", above=0.0)


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
        """The kinds of mechanisms by their names in problem files, those of linkages among them."""
        import_module(f"{__package__}.plane_linkages")
        return dict(sorted(super().kinds().items()))

    @classmethod
    def form(cls) -> dict[str, Any]:
        """Its entries as a form shows them, friction last."""
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
        inertia: Iterable[Formula],
        load: Iterable[Formula],
        over: tuple[float, float] | None,
        linkage: LinkGeometry,
    ) -> Mechanism:
        """A mechanism whose input turns, of the terms of its inertia and load."""
        friction, name = {"coulomb": self.coulomb, "viscous": self.viscous}, self.kind.replace(" ", "-")
        terms = added(list(inertia)), added(list(load))
        return Mechanism(*terms, **friction, over=over, axis="angle", name=name, linkage=linkage)


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

    def _slide(self, ratio: float, mass: float) -> Mechanism:
        """The mechanism whose slide is at the ratio times the input's angle."""
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

    @property
    def mechanism(self) -> Mechanism:
        return self._slide(self.radius, self.mass)


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

    @property
    def mechanism(self) -> Mechanism:
        return self._slide(self.radius, self.mass)


@declared
class Screw(SlideKind, kind="screw"):
    """The mechanism of a screw that drives a nut; x is the screw's angle, s = lead x/(2 pi).

    Examples
    --------
    >>> axis = screw("10 mm", "80 kg", inertia="3e-4 kg m^2", loads=Loads(force="-500 N"))
    >>> round(axis.load(0.0), 6), round(axis.driven_position("slide", "1 turn"), 6)
    (0.795775, 0.01)
    """

    lead: SINumber = entry(LENGTH, "The way of the nut with a turn of the screw.", example="10 mm")
    mass: SINumber = entry(MASS, "Of the nut and what it carries.", example="80 kg")

    @property
    def mechanism(self) -> Mechanism:
        return self._slide(self.lead / TURN, self.mass)


rack, belt, screw = function_of(Rack), function_of(Belt), function_of(Screw)
