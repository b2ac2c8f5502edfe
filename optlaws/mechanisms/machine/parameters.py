"""Spectra of machines: the effect of a law on a machine over any of its parameters."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from optlaws.errors import InputError, needed
from optlaws.laws import MotionLaw
from optlaws.laws.law import motion_law
from optlaws.mechanisms.machine.machine import Machine
from optlaws.numbers import Array, not_negative, numbers


@dataclass(frozen=True, eq=False)
class MachineSpectrum:
    """Outputs and vibrations of a machine over a parameter; computed by `machine_spectrum`.

    Attributes
    ----------
    values
        Values of the parameter, shape (m,).
    peaks
        Greatest magnitude of each output over the rise and the dwell, by its name, each of shape (m,).
    frequencies
        Frequencies of the modes, shape (m, modes); NaN where a machine has fewer.
    residuals
        Amplitudes that the modes are left with in one output, shape (m, modes).
    output
        Which output that is.
    parameter
        What the parameter is called in pictures and tables.

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
    output: str
    parameter: str = "parameter"

    def plot(self, ax: Any = None, **style: Any) -> list[Any]:
        """Draw the output's peak and what is left in it of each mode, over the parameter; return the lines.

        `ax` are axes of matplotlib, new ones unless given; `style` is what it takes for lines.

        Examples
        --------
        >>> from optlaws import smoothstep
        >>> machine = Machine([[0, 1], [-400, 0]], [[0], [400]], [[1, 0]], outputs=["position"])
        >>> lines = machine_spectrum(machine.at_speed, [0.5, 1.0], smoothstep(4), parameter="speed").plot()
        >>> [line.get_label() for line in lines]
        ['peak', 'mode 1 left']
        """
        from optlaws.plots.machine import draw_machine_spectrum

        return draw_machine_spectrum(self, ax, **style)

    def to_pandas(self) -> Any:
        """A table: peaks of all outputs, frequencies and what is left of the modes, a row for each value.

        Examples
        --------
        >>> from optlaws import smoothstep
        >>> machine = Machine([[0, 1], [-400, 0]], [[0], [400]], [[1, 0]], outputs=["position"])
        >>> table = machine_spectrum(machine.at_speed, [0.5, 1.0], smoothstep(4), parameter="speed").to_pandas()
        >>> table.columns.tolist()
        ['peak position', 'frequency of mode 1', 'mode 1 left in position']
        """
        pd = needed("pandas", "to_pandas")
        columns = {f"peak {name}": values for name, values in self.peaks.items()}
        for i, (frequency, left) in enumerate(zip(self.frequencies.T, self.residuals.T, strict=True), 1):
            columns |= {f"frequency of mode {i}": frequency, f"mode {i} left in {self.output}": left}
        return pd.DataFrame(columns, index=pd.Index(self.values, name=self.parameter))


def machine_spectrum(
    make: Callable[[float], Machine],
    values: Any,
    law: MotionLaw,
    *,
    dwell: float = 0.0,
    output: str | None = None,
    parameter: str = "parameter",
) -> MachineSpectrum:
    """The outputs and residuals of a machine under a law, over one of its parameters.

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
    output
        In which output residuals are; the first one unless given.
    parameter
        What the parameter is called in pictures and tables.

    Raises
    ------
    InputError
        If a value is no number, `make` makes no machine, or the machines' outputs differ, or there is no such output.

    Examples
    --------
    >>> from optlaws import smoothstep
    >>> machine = Machine([[0, 1], [-400, 0]], [[0], [400]], [[1, 0]], outputs=["position"])
    >>> spectrum = machine_spectrum(machine.at_speed, [1.0, 2.0], smoothstep(4))
    >>> spectrum.residuals.ravel().round(6).tolist()
    [0.00..., 0.2...]
    """
    swept = np.array(numbers(np.atleast_1d(np.asarray(values)).tolist(), "values"))
    if not len(swept):
        raise InputError("values must be at least one number")
    machines: list[Any] = [make(float(value)) for value in swept]
    for machine in machines:
        if not isinstance(machine, Machine) or machine.outputs != machines[0].outputs:
            raise InputError("make must give a Machine for every value, all with the same outputs")
    known, pause = motion_law(law), not_negative(dwell, "dwell")
    responses = [machine.response(known, dwell=pause) for machine in machines]
    names = machines[0].outputs
    output = names[machines[0].place(output)]
    peaks = {name: np.array([response.peak(name).value for response in responses]) for name in names}
    count = max((len(machine.modes) for machine in machines), default=0)
    frequencies, residuals = np.full((len(swept), count), np.nan), np.full((len(swept), count), np.nan)
    for i, machine in enumerate(machines):
        for mode in machine.modes:
            frequencies[i, mode.number - 1] = mode.frequency
            residuals[i, mode.number - 1] = machine.residual(mode.number, output).value(known)
    return MachineSpectrum(swept, peaks, frequencies, residuals, output, str(parameter))
