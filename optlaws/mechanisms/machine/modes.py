"""Vibrations of a machine: its modes, and how much of each a law leaves in an output."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from optlaws.errors import InputError
from optlaws.mechanisms.machine.dynamics import SAME
from optlaws.mechanisms.machine.state_space import StateSpace

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

DEFECTIVE = 1e-6


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
    """The vibrations of a machine; equal roots are one.

    Examples
    --------
    >>> modes(StateSpace([[-3.0]], [[3.0]], [[1.0]]))
    ()
    """
    return tuple(_mode(i, group) for i, group in enumerate(machine.dynamics.vibrations, 1))


def mode(machine: StateSpace, number: object) -> Mode:
    """One of them.

    Raises
    ------
    InputError
        If the machine has no such mode.

    Examples
    --------
    >>> mode(StateSpace([[0.0, 5.0], [-5.0, 0.0]], [[3.0], [0.0]], [[1.0, 0.0]]), 1).frequency
    5.0
    """
    found = modes(machine)
    if not found:
        raise InputError("the machine has no mode that vibrates: ask for peaks of its outputs in the dwell instead")
    if not isinstance(number, int | float) or isinstance(number, bool) or number not in range(1, len(found) + 1):
        raise InputError(f"mode must be a whole number from 1 to {len(found)}, got {number!r}")
    return found[int(number) - 1]


def participation(machine: StateSpace, wanted: Mode, output: str) -> complex:
    """The complex amplitude of a mode in an output, over the integral of exp(root (1 - k)) b(k).

    Raises
    ------
    InputError
        If the mode is defective: its vibration has no amplitude, but grows at first.
    """
    from scipy.linalg import schur, solve_sylvester

    dynamics = machine.dynamics
    near = SAME * max(abs(wanted.root), 1.0)
    # conjugate roots are apart, so that what is sorted first is this vibration alone
    chosen: Any = lambda root: bool(abs(root - wanted.root) <= 2.0 * near)  # noqa: E731 - the stubs know no such order
    triangle, turn, size = schur(dynamics.triangle, output="complex", sort=chosen)
    own, rest = triangle[:size, :size], triangle[size:, size:]
    root = complex(np.trace(own)) / size
    if np.abs(own - root * np.eye(size)).max() > DEFECTIVE * max(abs(root), 1.0):
        raise InputError(
            f"mode {wanted.number} is defective: one of its {size} equal vibrations drives the next, so that there is "
            "no amplitude; ask for the peak of an output in the dwell instead"
        )
    beside = solve_sylvester(own, -rest, -triangle[:size, size:]) if len(rest) else np.zeros((size, 0))
    load = turn.conj().T @ dynamics.load
    driven = load[:, 0] / root + load[:, 1] + root * load[:, 2]
    part = driven[:size] - beside @ driven[size:]
    states, _ = machine.output_rows(output)
    return complex(2.0 * (states @ turn[:, :size]) @ part)


def _mode(number: int, group: Complex) -> Mode:
    root = complex(group.mean())
    return Mode(number, abs(root), -root.real / abs(root) + 0.0, root)
