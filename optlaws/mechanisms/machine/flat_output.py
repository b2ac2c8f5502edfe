"""The flat output of a machine: an output whose law determines the law that drives it, by derivatives alone.

Where the transfer function from the law to the output is a number over a polynomial, as from a cam to the last mass of
a chain without dampers between its masses, the law is that polynomial of derivatives of the output.
"""

from __future__ import annotations

import numpy as np

from optlaws.errors import InputError
from optlaws.laws import MotionLaw, PolynomialLaw
from optlaws.laws.law import motion_law
from optlaws.mechanisms.machine.state_space import StateSpace
from optlaws.numbers import Array
from optlaws.numerics import chebyshev

_FLAT_OUTPUT_JUMP = 1e-7  # the same of the derivatives from which a machine's input is computed
_FEEDTHROUGH = 1e-9  # of what a coefficient is computed from: less is rounding


def flat_output(machine: StateSpace, output: str | None = None) -> tuple[float, ...]:
    """The weights w0, w1, ... of the law that drives the machine: a = w0 y + w1 y' + w2 y'' + ..., y being the output.

    Parameters
    ----------
    machine
        The machine.
    output
        Which output; the first one unless given.

    Raises
    ------
    InputError
        If the output is not flat; the error states why.

    Examples
    --------
    >>> from optlaws import Machine
    >>> flat_output(Machine([[0, 1], [-400, -2]], [[0], [400]], [[1, 0]], outputs=["position"]))
    (1.0, 0.005, 0.0025)
    """
    place = machine.place(output)
    name = machine.outputs[place]
    A, load, direct = np.array(machine.A), machine.load, machine.direct[place]
    row, column = np.array(machine.C[place]), load[:, 0] + A @ (load[:, 1] + A @ load[:, 2])
    feeds = [direct[2], direct[1] + row @ load[:, 2], direct[0] + row @ (load[:, 1] + A @ load[:, 2])]
    size, fastest = len(A), max(1.0, float(np.abs(machine.dynamics.roots).max()))
    if any(abs(coefficient) > _FEEDTHROUGH * fastest**i for i, coefficient in enumerate(feeds)):
        raise InputError(f"{name!r} is not flat: the law enters it directly, so that it has as many zeros as roots")
    reach, most = row, np.abs(row)
    for order in range(1, size + 1):
        gain, scale = float(reach @ column), float(most @ np.abs(column))
        if abs(gain) > _FEEDTHROUGH * scale and order < size:
            raise InputError(f"{name!r} is not flat: {_zeros(A, column, row)}")
        if order < size:
            reach, most = reach @ A, most @ np.abs(A)
    if abs(gain) <= _FEEDTHROUGH * scale:
        raise InputError(f"{name!r} is not flat: the law does not move it, or a vibration does not show in it")
    return tuple((np.poly(A)[::-1] / gain).tolist())


def driving_law(machine: StateSpace, law: MotionLaw, output: str | None = None) -> PolynomialLaw:
    """The law that drives a machine so that its flat output moves by a given law; `polydyne` for any machine.

    Parameters
    ----------
    machine
        The machine.
    law
        The output's law, a polynomial; for a machine of n states its derivatives 1 to n + 1 vanish at both ends.
    output
        Which output; the first one unless given.

    Raises
    ------
    InputError
        If the output is not flat, or the law is no polynomial or not smooth enough at its ends.

    Examples
    --------
    >>> from optlaws import Machine, smoothstep
    >>> machine = Machine([[0, 1], [-400, -2]], [[0], [400]], [[1, 0]], outputs=["position"])
    >>> cam = driving_law(machine, smoothstep(4))
    >>> round(machine.response(cam)["position"](0.3) - smoothstep(4)(0.3), 12)
    0.0
    """
    moves = motion_law(law)
    if not isinstance(moves, PolynomialLaw):
        raise InputError(
            "the output's law must be a polynomial: one whose pieces join does not let the drive be smooth"
        )
    weights = flat_output(machine, output)
    for order in range(1, len(weights) + 1):
        ends = np.abs(moves([0.0, 1.0], order))
        if ends.max() > _FLAT_OUTPUT_JUMP * moves.peak(order).value:
            raise InputError(
                f"the output's law must be of order {len(weights) + 1} at least, its derivatives 1 to {len(weights)} "
                f"zero at both ends, for the driving law not to jump: that of order {order} is {float(ends.max()):.6g}"
            )
    series = np.array(moves.acceleration or (0.0,))
    total = weights[0] * series
    for weight in weights[1:]:
        series = chebyshev.derivative(series)
        total[: len(series)] += weight * series
    return PolynomialLaw(total, a0=weights[0] * moves.a0)


def _zeros(A: Array, column: Array, row: Array) -> str:
    from scipy.linalg import eigvals

    size = len(A)
    pencil = np.block([[A, column[:, None]], [row[None, :], np.zeros((1, 1))]])
    zeros = eigvals(pencil, np.diag([*np.ones(size), 0.0]))
    finite = zeros[np.isfinite(zeros) & (np.abs(zeros) < 1e6 * max(1.0, float(np.linalg.norm(A, 2))))]
    listed = ", ".join(
        f"{machine.real:.4g}{machine.imag:+.4g}i" if machine.imag else f"{machine.real:.4g}" for machine in finite
    )
    return (
        f"its transfer function has zeros ({listed}), such as dampers between masses make, so that the law that drives "
        "it would move on after the output has come to rest"
    )
