"""Machines of masses, springs and dampers: their matrices, and the outputs that they have by themselves."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.files.reading import check_names
from optlaws.kept import kept_property
from optlaws.motion.quantities import si_number
from optlaws.numbers import Array, NumberOrQuantity, not_negative, positive

GROUND = "ground"
DRIVE_FORCE = "drive force"


@dataclass(frozen=True, init=False)
class Link:
    """A spring and a damper side by side between two masses, or between a mass and the ground.

    Parameters
    ----------
    first, second
        Names of the masses; "ground" is what stands still.
    stiffness
        With its unit, such as "3 N/mm", or a number in N/m or N m/rad, or dimensionless.
    damping
        With its unit, such as "5 N s/m", or a number in N s/m or N m s/rad, or dimensionless; not a ratio.

    Raises
    ------
    InputError
        If a number is below 0, or both names are the same.

    Examples
    --------
    >>> Link("motor", "load", stiffness="400 N/m", damping=0.4)
    Link(first='motor', second='load', stiffness=400.0, damping=0.4)
    """

    first: str
    second: str
    stiffness: float
    damping: float = 0.0

    def __init__(self, first: str, second: str, stiffness: NumberOrQuantity, damping: NumberOrQuantity = 0.0) -> None:
        for name in (first, second):
            _check_name(name)
        if first == second:
            raise InputError(f"a link joins two different masses, got {shortened(first)} twice")
        elastic = si_number(stiffness, ("stiffness", "torsional stiffness"), "stiffness")
        viscous = si_number(damping, ("viscous friction", "rotary viscous friction"), "damping")
        numbers = {"stiffness": not_negative(elastic, "stiffness"), "damping": not_negative(viscous, "damping")}
        for name, value in {"first": first, "second": second, **numbers}.items():
            object.__setattr__(self, name, value)

    @property
    def name(self) -> str:
        """The name of the link in outputs: "motor-load"."""
        return f"{self.first}-{self.second}"


class MachineModel(ABC):
    """A model of a machine in coordinates and their velocities that a, b and c of the law drive."""

    #: the name of the model in errors
    what: ClassVar[str]

    @property
    @abstractmethod
    def accelerations(self) -> Array:
        """Accelerations of the coordinates, rows over coordinates, their velocities, and a, b and c."""

    @property
    @abstractmethod
    def outputs(self) -> dict[str, Array]:
        """The outputs that it has by their names, rows over coordinates, their velocities, and a, b and c."""

    def matrices(self, outputs: Sequence[str]) -> tuple[Array, Array, Array, Array]:
        """A, B, C and D for the inputs a, b and c."""
        size = len(self.accelerations)
        velocities = np.eye(size, 2 * size + 3, k=size)
        states, rows = np.vstack([velocities, self.accelerations]), np.array([self.outputs[name] for name in outputs])
        return states[:, : 2 * size], states[:, 2 * size :], rows[:, : 2 * size], rows[:, 2 * size :]

    def named(self, outputs: Any) -> dict[str, str]:
        """The user's output names with the model's names; all outputs unless some are chosen."""
        if outputs is None:
            return {name: name for name in self.outputs}
        given = outputs.items() if isinstance(outputs, Mapping) else ((name, name) for name in _many(outputs))
        named = {str(name): output for name, output in given}
        for output in named.values():
            check_names([output], self.outputs, f"output of {self.what}")
        return named


@dataclass(frozen=True, eq=False)
class Assembly(MachineModel):
    """Masses by name, links, and the mass that a law drives: the law is its displacement from the ground or a base."""

    masses: Mapping[str, float]
    links: tuple[Link, ...]
    driven: str
    base: str

    what = "these masses"

    @kept_property
    def free(self) -> tuple[str, ...]:
        """The masses whose displacements are coordinates."""
        return tuple(name for name in self.masses if name != self.driven)

    @kept_property
    def _positions(self) -> dict[str, Array]:
        """Displacements as rows over the coordinates and the law."""
        rows = np.eye(len(self.free) + 1)
        positions = dict(zip(self.free, rows, strict=False)) | {GROUND: np.zeros(len(rows))}
        return positions | {self.driven: positions[self.base] + rows[-1]}

    def _sum(self, what: str) -> Array:
        """Stiffness or damping over the coordinates and the law."""
        total = np.zeros((len(self.free) + 1,) * 2)
        for link in self.links:
            row = self._positions[link.first] - self._positions[link.second]
            total += getattr(link, what) * np.outer(row, row)
        return total

    @kept_property
    def _parts(self) -> tuple[Array, Array, Array]:
        """Mass, damping and stiffness over the coordinates and the law."""
        rows = np.array([self._positions[name] for name in self.masses])
        inertia = rows.T @ (np.array(list(self.masses.values()))[:, None] * rows)
        return inertia, self._sum("damping"), self._sum("stiffness")

    @kept_property
    def accelerations(self) -> Array:
        size = len(self.free)
        inertia, damping, stiffness = self._parts
        right = np.zeros((size, 2 * size + 3))
        right[:, :size], right[:, size : 2 * size] = stiffness[:-1, :-1], damping[:-1, :-1]
        right[:, 2 * size :] = np.column_stack([stiffness[:-1, -1], damping[:-1, -1], inertia[:-1, -1]])
        return -np.asarray(np.linalg.solve(inertia[:-1, :-1], right))

    @kept_property
    def outputs(self) -> dict[str, Array]:
        outputs = {DRIVE_FORCE: self._drive_force()}
        for name in self.masses:
            outputs |= {f"{what} {name}": self._moved(self._positions[name], nu) for nu, what in enumerate(_MOTIONS)}
        for link in self.links:
            row = self._positions[link.first] - self._positions[link.second]
            deflection = self._moved(row, 0)
            outputs[f"deflection {link.name}"] = deflection
            outputs[f"force {link.name}"] = link.stiffness * deflection + link.damping * self._moved(row, 1)
        return outputs

    def _moved(self, row: Array, nu: int) -> Array:
        """A displacement's derivative as a row."""
        size = len(self.free)
        motion = np.zeros(2 * size + 3)
        if nu < 2:
            motion[nu * size : (nu + 1) * size] = row[:-1]
        else:
            motion += row[:-1] @ self.accelerations
        motion[2 * size + nu] += row[-1]
        return motion

    def _drive_force(self) -> Array:
        """The force of the drive, by the work of the law's displacement."""
        unit = np.eye(len(self.free) + 1)
        total = np.zeros(2 * len(self.free) + 3)
        for nu, part in zip((2, 1, 0), self._parts, strict=True):
            total += sum(weight * self._moved(row, nu) for weight, row in zip(part[-1], unit, strict=True))
        return total


_MOTIONS = ("position", "velocity", "acceleration")


def assembly(
    masses: Any,
    links: Any,
    drive: Any,
) -> Assembly:
    """Masses, links and a drive, checked.

    >>> assembly({"motor": 1.0, "load": 2.0}, [("motor", "load", 400.0)], "motor").free
    ('load',)
    """
    if not isinstance(masses, Mapping) or len(masses) < 2:
        raise InputError(f"masses must be at least two, by their names, the driven one among them, got {masses!r}")
    for name in masses:
        _check_name(name)
        if name == GROUND:
            raise InputError('"ground" is the fixed frame: it has no mass')
    pair = (GROUND, drive) if isinstance(drive, str) else tuple(drive) if isinstance(drive, Iterable) else ()
    if len(pair) != 2:
        raise InputError(
            'drive must name the mass that the law moves, "motor", or two, of which it moves the second against the '
            f'first, ("camshaft", "roller"), got {shortened(drive)}'
        )
    base, driven = pair
    joined = tuple(link if isinstance(link, Link) else _link(link) for link in _many(links))
    for name in (
        driven,
        *((base,) if base != GROUND else ()),
        *(n for link in joined for n in (link.first, link.second)),
    ):
        check_names([name], [*masses, GROUND], "mass")
    if driven in {base, GROUND}:
        raise InputError(f"drive must be a mass, moved against another one or the ground, got {shortened(drive)}")
    numbers = {
        name: si_number(mass, ("mass", "moment of inertia"), f"the mass {name}") for name, mass in masses.items()
    }
    checked = {
        name: (not_negative if name == driven else positive)(mass, f"the mass {name}") for name, mass in numbers.items()
    }
    _check_joined(checked, joined, driven, base)
    return Assembly(checked, joined, driven, base)


def _check_joined(masses: Mapping[str, float], links: Sequence[Link], driven: str, base: str) -> None:
    """Refuse masses that nothing joins to the drive: they would rest for ever."""
    reached, more = set[str](), {driven, base}
    while more:
        reached |= more
        touched = (link for link in links if {link.first, link.second} & more - {GROUND})
        more = {name for link in touched for name in (link.first, link.second)} - reached
    alone = [name for name in masses if name not in reached]
    if alone:
        raise InputError(f"the mass {alone[0]!r} is linked to nothing that the drive moves: link it, or leave it out")


def _many(values: Any) -> list[Any]:
    if isinstance(values, str) or not isinstance(values, Iterable):
        raise InputError(f"expected a list, got {shortened(values)}")
    return list(values)


def _link(values: Any) -> Link:
    parts = _many(values)
    if not 3 <= len(parts) <= 4:
        raise InputError(f"a link is two masses, a stiffness and perhaps a damping, got {shortened(values)}")
    return Link(*parts)


def _check_name(name: Any) -> None:
    if not isinstance(name, str) or not name.strip():
        raise InputError(f"a mass's name must be a text, got {shortened(name)}")
