"""Vibrations of a machine: its modes, the residual of each in an output, and machines of measured modes."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import Any

import numpy as np

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.mechanisms.machine.masses import MachineModel
from optlaws.mechanisms.machine.state_space import StateSpace
from optlaws.motion.quantities import either
from optlaws.numbers import Array, Complex, not_negative, numbers, positive
from optlaws.tolerances import SAME_ROOT

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
    return tuple(_mode(i, group) for i, group in enumerate(machine.dynamics.vibrations, 1))


def mode(machine: StateSpace, number: object) -> Mode:
    """The vibration of a machine with a given number."""
    vibrations = modes(machine)
    if not vibrations:
        raise InputError("the machine has no vibrating mode: use peaks of its outputs in the dwell instead")
    if isinstance(number, str):
        raise InputError(f"mode is a number from 1 to {len(vibrations)}, before the output: residual(1, {number!r})")
    if not isinstance(number, int | float) or isinstance(number, bool) or number not in range(1, len(vibrations) + 1):
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


def _mode(number: int, group: Complex) -> Mode:
    root = complex(group.mean())
    return Mode(number, abs(root), -root.real / abs(root) + 0.0, root)


@dataclass(frozen=True, eq=False)
class ModalModel(MachineModel):
    """Modes by circular frequency, damping ratio and participation: the rigid motion, and what each mode adds."""

    what = "these modes"

    modes: tuple[tuple[float, float, float], ...]

    @property
    def accelerations(self) -> Array:
        frequencies, dampings, shares = np.array(self.modes).T
        parts = np.diag(-(frequencies**2)), np.diag(-2.0 * dampings * frequencies), np.zeros((len(shares), 2))
        return np.column_stack([*parts, -shares])

    @property
    def outputs(self) -> dict[str, Array]:
        size = len(self.modes)
        frequencies, dampings, shares = np.array(self.modes).T
        unit = np.eye(2 * size + 3)
        bent, turning = unit[:size].sum(axis=0), unit[size : 2 * size].sum(axis=0)
        bending = -shares.sum() * unit[-1]
        bending[:size], bending[size : 2 * size] = -(frequencies**2), -2.0 * dampings * frequencies
        rows_by_name = {"position": bent + unit[-3], "velocity": turning + unit[-2], "acceleration": bending + unit[-1]}
        alone = {f"deflection {i + 1}": unit[i] for i in range(size)} if size > 1 else {}
        return rows_by_name | {"deflection": bent} | alone


def modal_model(modes: Any) -> ModalModel:
    """Vibrations from frequencies in Hz, damping ratios and participations, checked."""
    example = "such as [(8.5, 0.02)] or [(8.5, 0.02, 0.9), (31.0, 0.01, 0.1)]"
    if not isinstance(modes, list | tuple) or not modes:
        raise InputError(
            f"modes must be a list of frequencies in Hz with damping ratios, {example}, got {shortened(modes)}"
        )
    return ModalModel(tuple(_vibration(i, given, example) for i, given in enumerate(modes, 1)))


def _vibration(number: int, given: Any, example: str) -> tuple[float, float, float]:
    if not isinstance(given, list | tuple) or not 2 <= len(given) <= 3:
        raise InputError(
            f"mode {number} must be a frequency in Hz, a damping ratio and perhaps a participation, {example}, "
            f"got {shortened(given)}"
        )
    frequency = _hertz(given[0], f"the frequency of mode {number}")
    ratio = not_negative(given[1], f"the damping ratio of mode {number}")
    if ratio >= 1.0:
        raise InputError(
            f"the damping ratio of mode {number} must be below 1, such as 0.02 for 2 % of the critical damping, "
            f"got {ratio:g}"
        )
    (share,) = numbers([given[2] if len(given) == 3 else 1.0], f"the participation of mode {number}")
    return 2.0 * pi * frequency, ratio, share


def _hertz(value: Any, name: str) -> float:
    """A frequency in Hz; an angular velocity, such as "53 rad/s", is the phase's rate."""
    if isinstance(value, str) or hasattr(value, "units"):
        dimension, number = either(value, ("frequency", "angular velocity"), name)
        value = number if dimension == "frequency" else number / (2.0 * pi)
    return positive(value, name)
