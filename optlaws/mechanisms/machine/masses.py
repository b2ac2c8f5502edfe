"""Machines of masses, springs and dampers: their matrices, and the outputs that they have by themselves."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Protocol

import numpy as np

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.motion.quantities import si_number
from optlaws.numbers import Array, NumberOrQuantity, not_negative, positive
from optlaws.suggest import unknown_key

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


@dataclass(frozen=True, eq=False)
class Assembly:
    """Masses, links and a drive: the law is the displacement of a mass, or its distance from another one.

    Attributes
    ----------
    masses
        Masses, or moments of inertia, by name; the driven one may have none.
    links
        What joins them.
    driven, base
        The mass that the law drives, and what its displacement is measured from.

    Examples
    --------
    >>> axis = Assembly({"motor": 1.0, "load": 2.0}, (Link("motor", "load", 400.0),), "motor", "ground")
    >>> axis.matrices(["position load"])[0].tolist()
    [[0.0, 1.0], [-200.0, 0.0]]
    """

    masses: Mapping[str, float]
    links: tuple[Link, ...]
    driven: str
    base: str

    what: ClassVar[str] = "these masses"

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
    def _accelerations(self) -> Array:
        """Accelerations of the coordinates over coordinates, their velocities, and a, b and c."""
        size = len(self.free)
        inertia, damping, stiffness = self._parts
        right = np.zeros((size, 2 * size + 3))
        right[:, :size], right[:, size : 2 * size] = stiffness[:-1, :-1], damping[:-1, :-1]
        right[:, 2 * size :] = np.column_stack([stiffness[:-1, -1], damping[:-1, -1], inertia[:-1, -1]])
        return -np.asarray(np.linalg.solve(inertia[:-1, :-1], right))

    def matrices(self, outputs: Sequence[str]) -> tuple[Array, Array, Array, Array]:
        """A, B, C and D for the inputs a, b and c."""
        size = len(self.free)
        A, B = np.zeros((2 * size, 2 * size)), np.zeros((2 * size, 3))
        A[:size, size:] = np.eye(size)
        A[size:], B[size:] = self._accelerations[:, : 2 * size], self._accelerations[:, 2 * size :]
        rows = np.array([self.outputs[name] for name in outputs])
        return A, B, rows[:, : 2 * size], rows[:, 2 * size :]

    @kept_property
    def outputs(self) -> dict[str, Array]:
        """Rows over coordinates, their velocities, and a, b and c, by the names of outputs."""
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
            motion += row[:-1] @ self._accelerations
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
    masses: Any,  # noqa: ANN401 - whatever users give
    links: Any,  # noqa: ANN401
    drive: Any,  # noqa: ANN401
) -> Assembly:
    """Masses, links and a drive, checked.

    Raises
    ------
    InputError
        If a name is unknown or a number out of range.

    Examples
    --------
    >>> assembly({"motor": 1.0, "load": 2.0}, [("motor", "load", 400.0)], "motor").free
    ('load',)
    """
    if not isinstance(masses, Mapping) or len(masses) < 2:
        raise InputError(f"masses must be at least two, by their names, the driven one among them, got {masses!r}")
    for name in masses:
        _check_name(name)
        if name == GROUND:
            raise InputError('"ground" is what stands still: it has no mass')
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
        if name not in masses and name != GROUND:
            raise InputError(unknown_key(name, [*masses, GROUND], "mass"))
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


class MachineModel(Protocol):
    """A model of a machine that has outputs of its own."""

    @property
    def what(self) -> str:
        """The name of the model in errors."""

    @property
    def outputs(self) -> Mapping[str, Any]:
        """Its outputs by their names."""


def named_outputs(given: MachineModel, outputs: Any) -> dict[str, str]:  # noqa: ANN401 - whatever users give
    """The names of outputs for users, with those of the model; all outputs unless some are chosen.

    Raises
    ------
    InputError
        If there is no such output.
    """
    if outputs is None:
        return {name: name for name in given.outputs}
    named = {str(k): v for k, v in outputs.items()} if isinstance(outputs, Mapping) else {n: n for n in _many(outputs)}
    for name in named.values():
        if name not in given.outputs:
            raise InputError(unknown_key(name, given.outputs, f"output of {given.what}"))
    return named


def _many(values: Any) -> list[Any]:  # noqa: ANN401
    if isinstance(values, str) or not isinstance(values, Iterable):
        raise InputError(f"expected a list, got {shortened(values)}")
    return list(values)


def _link(values: Any) -> Link:  # noqa: ANN401
    parts = _many(values)
    if not 3 <= len(parts) <= 4:
        raise InputError(f"a link is two masses, a stiffness and perhaps a damping, got {shortened(values)}")
    return Link(*parts)


def _check_name(name: Any) -> None:  # noqa: ANN401
    if not isinstance(name, str) or not name.strip():
        raise InputError(f"a mass's name must be a text, got {shortened(name)}")
