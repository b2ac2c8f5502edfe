"""Spectra of machines: what a law does to a machine over any of its parameters."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from optlaws.errors import InputError
from optlaws.laws import MotionLaw
from optlaws.mechanisms.checks import motion_law
from optlaws.mechanisms.machine.machine import Machine
from optlaws.numbers import not_negative, numbers

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class MachineSpectrum:
    """Outputs and vibrations of a machine over a parameter; made by `machine_spectrum`.

    Attributes
    ----------
    values
        Values of the parameter, shape (m,).
    peaks
        Greatest magnitude of each output over the rise and the dwell, by its name, each of shape (m,).
    frequencies
        Frequencies of the modes, shape (m, modes); NaN where a machine has fewer.
    residuals
        Amplitudes that the modes are left with in the first output, shape (m, modes).

    Examples
    --------
    >>> from optlaws import smoothstep
    >>> def axis(stiffness):
    ...     masses = {"motor": 1.0, "load": 2.0}
    ...     return Machine.from_masses(masses, [("motor", "load", stiffness)], drive="motor", outputs=["drive force"])
    >>> spectrum = machine_spectrum(axis, [200.0, 800.0], smoothstep(3))
    >>> spectrum.frequencies.ravel().round(9).tolist(), spectrum.peaks["drive force"].round(4).tolist()
    ([10.0, 20.0], [32.8861, 24.4058])
    """

    values: Array
    peaks: dict[str, Array]
    frequencies: Array
    residuals: Array


def machine_spectrum(
    make: Callable[[float], Machine],
    values: Any,  # noqa: ANN401 - numbers of any kind
    law: MotionLaw,
    *,
    dwell: float = 0.0,
) -> MachineSpectrum:
    """What a law does to a machine over one of its parameters.

    Parameters
    ----------
    make
        The machine of a value: its speed, a mass, a stiffness, whatever varies. All have the same outputs.
    values
        Values of the parameter, shape (m,).
    law
        The law that drives it.
    dwell
        How much of the dwell the peaks count too, in durations of the rise.

    Raises
    ------
    InputError
        If a value is no number, `make` makes no machine, or the machines' outputs differ.

    Examples
    --------
    >>> from optlaws import smoothstep
    >>> machine = Machine([[0, 1], [-400, 0]], [[0], [400]], [[1, 0]], outputs=["position"])
    >>> spectrum = machine_spectrum(machine.at_speed, [1.0, 2.0], smoothstep(4))
    >>> spectrum.residuals.ravel().round(6).tolist()
    [0.00..., 0.2...]
    """
    asked = np.array(numbers(np.atleast_1d(np.asarray(values)).tolist(), "values"))
    machines: list[Any] = [make(float(one)) for one in asked]
    for one in machines:
        if not isinstance(one, Machine) or one.outputs != machines[0].outputs:
            raise InputError("make must give a Machine for every value, all with the same outputs")
    known, pause = motion_law(law), not_negative(dwell, "dwell")
    responses = [one.response(known, dwell=pause) for one in machines]
    names = machines[0].outputs if machines else ()
    peaks = {name: np.array([one.peak(name).value for one in responses]) for name in names}
    count = max((len(one.modes) for one in machines), default=0)
    frequencies, residuals = np.full((len(asked), count), np.nan), np.full((len(asked), count), np.nan)
    for i, one in enumerate(machines):
        for mode in one.modes:
            frequencies[i, mode.number - 1] = mode.frequency
            residuals[i, mode.number - 1] = one.residual(mode.number).value(known)
    return MachineSpectrum(asked, peaks, frequencies, residuals)
