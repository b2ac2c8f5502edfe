"""Mechanisms by their kinds: each declares its entries, from which its function, files, forms and errors are made."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import KW_ONLY
from functools import cache, wraps
from importlib import import_module
from inspect import signature
from pathlib import Path
from pkgutil import iter_modules
from typing import Any, ClassVar, ParamSpec, Self, TypeAlias

from optlaws.entries.declared import Kinded, ValueOf, declared, entry
from optlaws.entries.value_types import InSI, Kept, ReadBy, SINumber, Span
from optlaws.formulas.slopes import added
from optlaws.formulas.tree import Formula
from optlaws.mechanisms.linkages.bodies import NO_LOADS, Body, DrivenLink, Link, Loads, Slide, formula_from
from optlaws.mechanisms.linkages.mechanism import LinkGeometry, Mechanism, MechanismEntries
from optlaws.numbers import NumberOrQuantity

P = ParamSpec("P")
Ends: TypeAlias = Kept[tuple[float, float], "tuple[NumberOrQuantity, NumberOrQuantity]"]
OptionalEnds: TypeAlias = Kept["tuple[float, float] | None", "tuple[NumberOrQuantity, NumberOrQuantity] | None"]
BodiesByLink: TypeAlias = Kept[dict[str, Body], "Mapping[str, Any]"]
LENGTH = InSI("length", above=0.0)


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
        """The kinds of mechanisms by their names in problem files, those of this folder among them."""
        _load()
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
        return Mechanism(
            added(list(inertia)),
            added(list(load)),
            coulomb=self.coulomb,
            viscous=self.viscous,
            over=over,
            axis="angle",
            name=self.kind.replace(" ", "-"),
            linkage=linkage,
        )


@declared
class LinkageKind(MechanismKind):
    """A linkage in a plane, which a crank drives."""

    _: KW_ONLY
    loads: Loads = entry(
        ValueOf(Loads), "What acts on the driven link, and the direction of gravity.", default=NO_LOADS
    )
    over: Ends = entry(Span(InSI("angle")), "The range of x, the crank's angle.", default=("0 deg", "360 deg"))

    @property
    def ends(self) -> tuple[float, float]:
        """The ends of the range of x, rad."""
        return self.over

    def _linkage(
        self,
        links: Mapping[str, Link | Slide],
        bodies: Mapping[str, Body],
        driven: DrivenLink,
        chains: Sequence[Sequence[tuple[Any, Any]]],
    ) -> Mechanism:
        """The mechanism of links with bodies, one of which does the work, and of points that a picture joins."""
        moved = [link.moved(bodies[name], self.loads.weight) for name, link in links.items()]
        inertia, load = ([term for terms in side for term in terms] for side in zip(*moved, strict=True))
        positions = () if driven.position is None else ((driven.name, driven.position),)
        points = tuple(tuple((formula_from(x), formula_from(y)) for x, y in chain) for chain in chains)
        acting = self.loads.on(driven, "angle")
        return self._mechanism(inertia, [*load, *acting], self.ends, LinkGeometry(positions, points))


@declared
class MechanismTable(MechanismEntries, MechanismKind, kind="table"):
    """A mechanism by its inertia and load over the position of its input."""


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


@cache
def _load() -> None:
    """Import the modules of the folder, by which their kinds are known."""
    for module in iter_modules([str(Path(__file__).parent)]):
        import_module(f"{__package__}.{module.name}")
