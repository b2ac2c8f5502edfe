"""Models of machines: masses, springs and dampers, or measured modes; and the modes that a machine has."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import pi
from typing import Any

import numpy as np

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.files.reading import check_names, is_number
from optlaws.mechanisms.machine.state_space import StateSpace
from optlaws.motion.quantities import either, quantity
from optlaws.numbers import Array, NumberOrQuantity, not_negative, numbers, positive
from optlaws.tolerances import SAME_ROOT

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
        elastic = quantity(stiffness, ("stiffness", "torsional stiffness"), "stiffness", bare=True)
        viscous = quantity(damping, ("viscous friction", "rotary viscous friction"), "damping", bare=True)
        numbers = {"stiffness": not_negative(elastic, "stiffness"), "damping": not_negative(viscous, "damping")}
        for name, value in {"first": first, "second": second, **numbers}.items():
            object.__setattr__(self, name, value)

    @property
    def name(self) -> str:
        """The name of the link in outputs: "motor-load"."""
        return f"{self.first}-{self.second}"


@dataclass(frozen=True, eq=False)
class MachineModel:
    """A model of a machine: accelerations of its coordinates and its outputs, as rows.

    The rows are over the coordinates, their velocities, and a, b and c of the law; `what` is its name in errors.
    """

    accelerations: Array
    outputs: Mapping[str, Array]
    what: str

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


def assembly(masses: Any, links: Any, drive: Any) -> MachineModel:
    """The model of masses, links and a drive: the law is its displacement from the ground or a base."""
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
    for name in (driven, base, *(name for link in joined for name in (link.first, link.second))):
        check_names([name], [*masses, GROUND], "mass")
    if driven in {base, GROUND}:
        raise InputError(f"drive must be a mass, moved against another one or the ground, got {shortened(drive)}")
    checked = {}
    for name, mass in masses.items():
        number = quantity(mass, ("mass", "moment of inertia"), f"the mass {name}", bare=True)
        checked[name] = (not_negative if name == driven else positive)(number, f"the mass {name}")
    reached, more = set[str](), {driven, base}
    while more:
        reached |= more
        touched = (link for link in joined if {link.first, link.second} & more - {GROUND})
        more = {name for link in touched for name in (link.first, link.second)} - reached
    if alone := [name for name in masses if name not in reached]:
        raise InputError(f"the mass {alone[0]!r} is linked to nothing that the drive moves: link it, or leave it out")
    return _of_masses(checked, joined, driven, base)


def _of_masses(masses: Mapping[str, float], links: Sequence[Link], driven: str, base: str) -> MachineModel:
    """The model whose coordinates are the displacements of the masses that are free."""
    free = [name for name in masses if name != driven]
    size, unit = len(free), np.eye(len(free) + 1)
    # displacements as rows over the coordinates and the law
    positions = dict(zip(free, unit, strict=False)) | {GROUND: np.zeros(size + 1)}
    positions[driven] = positions[base] + unit[-1]
    bent = [positions[link.first] - positions[link.second] for link in links]
    rows = np.array([positions[name] for name in masses])
    inertia = rows.T @ (np.array(list(masses.values()))[:, None] * rows)
    damping, stiffness = (
        sum((getattr(link, what) * np.outer(row, row) for link, row in zip(links, bent, strict=True)), 0.0 * inertia)
        for what in ("damping", "stiffness")
    )
    right = np.zeros((size, 2 * size + 3))
    right[:, :size], right[:, size : 2 * size] = stiffness[:-1, :-1], damping[:-1, :-1]
    right[:, 2 * size :] = np.column_stack([stiffness[:-1, -1], damping[:-1, -1], inertia[:-1, -1]])
    accelerations = -np.asarray(np.linalg.solve(inertia[:-1, :-1], right))

    def moved(row: Array, nu: int) -> Array:
        """A displacement's derivative as a row."""
        motion = np.zeros(2 * size + 3)
        if nu < 2:
            motion[nu * size : (nu + 1) * size] = row[:-1]
        else:
            motion += row[:-1] @ accelerations
        motion[2 * size + nu] += row[-1]
        return motion

    # the force of the drive, by the work of the law's displacement
    force = np.zeros(2 * size + 3)
    for nu, part in zip((2, 1, 0), (inertia, damping, stiffness), strict=True):
        force += sum(weight * moved(row, nu) for weight, row in zip(part[-1], unit, strict=True))
    outputs = {DRIVE_FORCE: force}
    for name in masses:
        outputs |= {f"{what} {name}": moved(positions[name], nu) for nu, what in enumerate(_MOTIONS)}
    for link, row in zip(links, bent, strict=True):
        outputs[f"deflection {link.name}"] = deflection = moved(row, 0)
        outputs[f"force {link.name}"] = link.stiffness * deflection + link.damping * moved(row, 1)
    return MachineModel(accelerations, outputs, "these masses")


_MOTIONS = ("position", "velocity", "acceleration")


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


_DEFECTIVE = 1e-6  # of a root's size: by how much vectors of a mode may miss it


@dataclass(frozen=True)
class Mode:
    """A free vibration of a machine.

    Attributes
    ----------
    number
        From 1 on, the slowest first.
    frequency
        Circular frequency of the undamped vibration, the root's size, in radians in the duration of the rise.
    damping
        Ratio zeta, below 1.
    root
        The root -zeta nu + i nu sqrt(1 - zeta²).

    Examples
    --------
    >>> from optlaws import Machine
    >>> Machine([[0, 1], [-400, -2]], [[0], [400]], [[1, 0]]).modes
    (Mode(number=1, frequency=20, damping=0.05),)
    """

    number: int
    frequency: float
    damping: float
    root: complex

    def __repr__(self) -> str:
        return f"Mode(number={self.number}, frequency={self.frequency:.12g}, damping={self.damping:.12g})"


def modes(machine: StateSpace) -> tuple[Mode, ...]:
    """The vibrations of a machine; equal roots are one."""
    roots = enumerate((complex(group.mean()) for group in machine.dynamics.vibrations), 1)
    return tuple(Mode(i, abs(root), -root.real / abs(root) + 0.0, root) for i, root in roots)


def mode(machine: StateSpace, number: object) -> Mode:
    """The vibration of a machine with a given number."""
    vibrations = modes(machine)
    if not vibrations:
        raise InputError("the machine has no vibrating mode: use peaks of its outputs in the dwell instead")
    if isinstance(number, str):
        raise InputError(f"mode is a number from 1 to {len(vibrations)}, before the output: residual(1, {number!r})")
    if not is_number(number) or number not in range(1, len(vibrations) + 1):
        raise InputError(f"mode must be a whole number from 1 to {len(vibrations)}, got {number!r}")
    return vibrations[int(number) - 1]


def participation(machine: StateSpace, vibration: Mode, output: str) -> complex:
    """The complex amplitude of a mode in an output, over the integral of exp(root (1 - k)) b(k)."""
    from scipy.linalg import schur, solve_sylvester

    dynamics = machine.dynamics
    near = SAME_ROOT * max(abs(vibration.root), 1.0)
    # conjugate roots are apart, so that what is sorted first is this vibration alone
    chosen: Any = lambda root: bool(abs(root - vibration.root) <= 2.0 * near)  # noqa: E731 - the stubs know no such order
    triangle, turn, size = schur(dynamics.triangle, output="complex", sort=chosen)
    block, rest = triangle[:size, :size], triangle[size:, size:]
    root = complex(np.trace(block)) / size
    if np.abs(block - root * np.eye(size)).max() > _DEFECTIVE * max(abs(root), 1.0):
        raise InputError(
            f"mode {vibration.number} is defective: one of its {size} equal vibrations drives the next, so that there "
            "is no amplitude; ask for the peak of an output in the dwell instead"
        )
    beside = solve_sylvester(block, -rest, -triangle[:size, size:]) if len(rest) else np.zeros((size, 0))
    load = turn.conj().T @ dynamics.load
    driven = load[:, 0] / root + load[:, 1] + root * load[:, 2]
    part = driven[:size] - beside @ driven[size:]
    states, _ = machine.rows[output]
    return complex(2.0 * (states @ turn[:, :size]) @ part)


def modal_model(modes: Any) -> MachineModel:
    """The rigid motion, and what each mode adds, of frequencies in Hz, damping ratios and participations."""
    example = "such as [(8.5, 0.02)] or [(8.5, 0.02, 0.9), (31.0, 0.01, 0.1)]"
    if not isinstance(modes, list | tuple) or not modes:
        raise InputError(
            f"modes must be a list of frequencies in Hz with damping ratios, {example}, got {shortened(modes)}"
        )
    size = len(modes)
    frequencies, dampings, shares = np.array([_vibration(i, given, example) for i, given in enumerate(modes, 1)]).T
    parts = np.diag(-(frequencies**2)), np.diag(-2.0 * dampings * frequencies), np.zeros((size, 2))
    unit = np.eye(2 * size + 3)
    bent, turning = unit[:size].sum(axis=0), unit[size : 2 * size].sum(axis=0)
    bending = -shares.sum() * unit[-1]
    bending[:size], bending[size : 2 * size] = -(frequencies**2), -2.0 * dampings * frequencies
    rows_by_name = {"position": bent + unit[-3], "velocity": turning + unit[-2], "acceleration": bending + unit[-1]}
    alone = {f"deflection {i + 1}": unit[i] for i in range(size)} if size > 1 else {}
    outputs = rows_by_name | {"deflection": bent} | alone
    return MachineModel(np.column_stack([*parts, -shares]), outputs, "these modes")


def _vibration(number: int, given: Any, example: str) -> tuple[float, float, float]:
    """Circular frequency, damping ratio and participation of a mode."""
    if not isinstance(given, list | tuple) or not 2 <= len(given) <= 3:
        raise InputError(
            f"mode {number} must be a frequency in Hz, a damping ratio and perhaps a participation, {example}, "
            f"got {shortened(given)}"
        )
    hertz, name = given[0], f"the frequency of mode {number}"
    if isinstance(hertz, str) or hasattr(hertz, "units"):
        # an angular velocity, such as "53 rad/s", is the phase's rate
        dimension, rate = either(hertz, ("frequency", "angular velocity"), name)
        hertz = rate if dimension == "frequency" else rate / (2.0 * pi)
    frequency = positive(hertz, name)
    ratio = not_negative(given[1], f"the damping ratio of mode {number}")
    if ratio >= 1.0:
        raise InputError(
            f"the damping ratio of mode {number} must be below 1, such as 0.02 for 2 % of the critical damping, "
            f"got {ratio:g}"
        )
    (share,) = numbers([given[2] if len(given) == 3 else 1.0], f"the participation of mode {number}")
    return 2.0 * pi * frequency, ratio, share
