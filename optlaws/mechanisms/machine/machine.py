"""Linear machines driven by a law, from matrices, masses, modes or systems; their constants, and over parameters."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import KW_ONLY, dataclass
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from optlaws.echo import shortened
from optlaws.entries.declared import Declared, declared, documented_by, entry
from optlaws.entries.value_types import Choice, Number, Text, Together, Whole
from optlaws.errors import InputError, needed
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.laws.law import motion_law
from optlaws.mechanisms.machine.follower import Follower
from optlaws.mechanisms.machine.models import Link, MachineModel, Mode, assembly, modal_model, modes
from optlaws.mechanisms.machine.over_time import MachineMotion, RiseReturnCycle
from optlaws.mechanisms.machine.state_space import SYMBOLS, StateSpace
from optlaws.numbers import Array, NumberOrQuantity, not_negative, numbers, positive

if TYPE_CHECKING:
    from optlaws.mechanisms.machine.output_constants import OutputPeak, OutputRms
    from optlaws.mechanisms.machine.residual import ModeResidual
    from optlaws.synthesis import Functional
    from optlaws.synthesis.functionals.makers import PeakSide

_PAIR = Together(Number(), Number())
SPREAD = Number(least=0.0, most=1.0)


@declared
class Measure(Declared, title="a constant of the machine"):
    """A constant of a machine: the peak or the RMS of an output, or the residual amplitude of a mode in one."""

    _: KW_ONLY
    peak: str | None = entry(Text(), "The output whose peak it is.", default=None)
    rms: str | None = entry(Text(), "The output whose root mean square it is.", default=None)
    residual: int | None = entry(Whole(), "The mode whose amplitude after the motion it is.", default=None)
    output: str | None = entry(Text(), "Of a residual: in which output.", default=None)
    within: tuple[float, float] = entry(
        _PAIR,
        "The first and the last time that count, in durations of the rise: (0, 1) the rise, (1, 1.5) a dwell after it, "
        "(0, 1.5) both.",
        default=(0.0, 1.0),
    )
    cycle: tuple[float, float] | None = entry(
        _PAIR,
        "The dwell and the rest of a cycle of rise, dwell, return and rest that repeats; then all of it counts.",
        default=None,
    )
    dwell: float = entry(
        Number(), "Of an RMS: how much of the dwell counts too, in durations of the rise.", default=0.0
    )
    spread: float = entry(SPREAD, "Relative deviation of frequencies in both directions: 0.1 for 10 %.", default=0.0)
    damping: tuple[float, float] | None = entry(
        _PAIR, "The least and the greatest damping ratio; the mode's own unless given.", default=None
    )
    side: PeakSide = entry(Choice("both", "high", "low"), "The greatest magnitude, value, or opposite.", default="both")
    offset: float = entry(Number(), "A constant load in the output's units, which is added to it.", default=0.0)

    def functional(self, machine: Machine) -> Functional:
        """The constant of this machine."""
        if sum(wish is not None for wish in (self.peak, self.rms, self.residual)) != 1:
            raise InputError(
                "a constant of the machine is one of peak and rms, each of an output, and residual of a mode"
            )
        if self.peak is not None:
            return machine.peak(self.peak, within=self.within, cycle=self.cycle, side=self.side, offset=self.offset)
        if self.rms is not None:
            return machine.rms(self.rms, dwell=self.dwell, cycle=self.cycle, offset=self.offset)
        return machine.residual(self.residual or 0, self.output, spread=self.spread, damping=self.damping)


class Machine(StateSpace):
    """A linear machine that a law drives: x' = A x + B w, y = C x + D w, in durations of the rise.

    The machine is at rest before the law begins. Made from matrices as here, from matrices in seconds (`from_units`),
    from masses, springs and dampers (`from_masses`), from measured frequencies (`from_modes`) or from a system of
    scipy.signal or python-control (`from_system`). Equal where the matrices and the names are.

    Parameters
    ----------
    A, B, C, D
        Matrices by rows, shapes (states, states), (states, inputs), (outputs, states) and (outputs, inputs); D is 0
        unless given.
    inputs
        What of the law the columns of B and D belong to: "a" displacement, "b" velocity, "c" acceleration, or several.
    outputs
        Names of the outputs; the first one is what counts where none is named.

    Raises
    ------
    InputError
        If the matrices do not fit each other, a number is not finite, or the machine is unstable; in its methods, if an
        argument is out of range or names no output.

    Examples
    --------
    >>> from optlaws import smoothstep
    >>> machine = Machine([[0, 1], [-400, -2]], [[0], [400]], [[1, 0]], outputs=["position"])
    >>> machine
    Machine(states=2, inputs='a', outputs=['position'])
    >>> machine.response(smoothstep(4))["position"](0.5)
    0.489570
    """

    @classmethod
    def from_masses(
        cls,
        masses: Mapping[str, NumberOrQuantity],
        links: Sequence[Link | Sequence[Any]],
        *,
        drive: str | tuple[str, str],
        outputs: Mapping[str, str] | Sequence[str] | None = None,
        duration: NumberOrQuantity = 1.0,
        stroke: NumberOrQuantity = 1.0,
    ) -> Self:
        """The machine of masses, springs and dampers.

        Parameters
        ----------
        masses
            Masses, "2.5 kg", or moments of inertia, "0.02 kg m^2", by name; numbers are in kg or kg m². That of the
            driven one may be 0.
        links
            Springs with dampers: `Link("motor", "load", stiffness="400 N/m", damping="0.4 N s/m")`, or such a tuple;
            numbers are in N/m and N s/m, no ratio. "ground" is what stands still.
        drive
            The mass whose displacement is the law; or two, the law being the second one's distance from the first:
            ("camshaft", "roller").
        outputs
            Outputs by the names they are to have, or a list of them; all there are unless given: "drive force";
            "position", "velocity" and "acceleration" of a mass, such as "position load"; "deflection" and "force" of a
            link, such as "force motor-load".
        duration, stroke
            Duration of the rise, "0.2 s", and its stroke, "35 mm" or "20 deg"; numbers are in s, and in m or rad; 1
            where all numbers are dimensionless.

        Examples
        --------
        >>> axis = Machine.from_masses(
        ...     {"motor": "1 kg", "load": "2 kg"},
        ...     [Link("motor", "load", stiffness="0.8 N/mm", damping="2 N s/m")],
        ...     drive="motor",
        ...     outputs={"motor torque": "drive force", "belt force": "force motor-load"},
        ... )
        >>> axis
        Machine(states=2, inputs='abc', outputs=['motor torque', 'belt force'])
        """
        return cls._driven(assembly(masses, links, drive), outputs, duration=duration, stroke=stroke)

    @classmethod
    def from_modes(
        cls,
        modes: Sequence[Sequence[NumberOrQuantity]],
        *,
        duration: NumberOrQuantity,
        stroke: NumberOrQuantity = 1.0,
        outputs: Mapping[str, str] | Sequence[str] | None = None,
    ) -> Self:
        """The machine of measured vibrations: frequencies, damping ratios, and the amplitude of each in an output.

        What the drive carries moves by the law and bends by the sum of its modes, each of which the acceleration of the
        drive excites.

        Parameters
        ----------
        modes
            For each vibration its frequency, the undamped one, "8.5 Hz", "510 1/min", or a number in Hz; its damping
            ratio, the share of the critical damping of what moves relative to the drive (that of a `Follower` is
            relative to the ground); and its participation: the share of the drive's displacement with which it moves at
            the place that counts, 1 unless given.
        duration, stroke
            Duration of the rise and its stroke, as of `from_masses`.
        outputs
            Outputs by the names they are to have, or a list of them; all there are unless given: "position",
            "velocity" and "acceleration" of that place, "deflection", by how much it is away from where it would be if
            all were rigid; of several modes also "deflection 1" and so on.

        Examples
        --------
        >>> from optlaws import smoothstep
        >>> arm = Machine.from_modes([("8.5 Hz", 0.02)], duration="0.4 s", stroke="0.3 m", outputs=["deflection"])
        >>> arm, round(arm.residual().value(smoothstep(3)), 6)
        (Machine(states=2, inputs='ac', outputs=['deflection']), 0.003...)
        """
        return cls._driven(modal_model(modes), outputs, duration=duration, stroke=stroke)

    @classmethod
    def from_system(
        cls,
        system: Any,
        *,
        inputs: str = "a",
        outputs: Sequence[str] = (),
        duration: NumberOrQuantity = 1.0,
        stroke: NumberOrQuantity = 1.0,
    ) -> Self:
        """The machine of a system of scipy.signal or python-control, continuous in time.

        Parameters
        ----------
        system
            `scipy.signal.StateSpace`, `TransferFunction` or `ZerosPolesGain`, or `control.ss`, `control.tf`.
        inputs
            What of the law its inputs are, in their order: "a" displacement, "b" velocity, "c" acceleration.
        outputs
            Names of its outputs.
        duration, stroke
            Duration of the rise in the system's unit of time, and its stroke, as of `from_units`.

        Examples
        --------
        >>> from scipy.signal import TransferFunction
        >>> Machine.from_system(TransferFunction([400], [1, 2, 400]), outputs=["position"])
        Machine(states=2, inputs='a', outputs=['position'])
        """
        A, B, C, D = _matrices(system)
        return cls.from_units(A, B, C, D, duration=duration, stroke=stroke, inputs=inputs, outputs=outputs)

    @classmethod
    def from_follower(cls, follower: Follower) -> Self:
        """The elastic follower as a machine: outputs "position", "acceleration" and "deflection" of the mass.

        The deflection is that of the spring, from the cam to the mass. `Follower` computes the same motion from states
        that damping keeps smaller.

        Examples
        --------
        >>> from optlaws import smoothstep
        >>> machine = Machine.from_follower(Follower(frequency=20, damping=0.05))
        >>> machine.residual(1, "acceleration").value(smoothstep(4))
        1.650151
        """
        if not isinstance(follower, Follower):
            raise InputError(f"follower must be a Follower, got {shortened(follower)}")
        # by its deflection, which is small: the displacements of cam and mass would cancel nu² times their rounding
        square, drag = follower.frequency**2, 2.0 * follower.n
        bending = [-square, -drag]
        rows, direct = [[1.0, 0.0], bending, [1.0, 0.0]], [[1.0, 0.0, 0.0], [0.0, -drag, 0.0], [0.0, 0.0, 0.0]]
        names = ["position", "acceleration", "deflection"]
        load = [[0.0, 0.0, 0.0], [0.0, -drag, -1.0]]
        return cls([[0.0, 1.0], bending], load, rows, direct, inputs="abc", outputs=names)

    @classmethod
    def _driven(
        cls,
        given: MachineModel,
        outputs: Mapping[str, str] | Sequence[str] | None,
        *,
        duration: NumberOrQuantity,
        stroke: NumberOrQuantity,
    ) -> Self:
        """The machine of a model driven by a, b and c, without those that do not enter."""
        names = given.named(outputs)
        A, B, C, D = given.matrices(list(names.values()))
        used = [i for i in range(3) if i == 0 or B[:, i].any() or D[:, i].any()]
        inputs = "".join(SYMBOLS[i] for i in used)
        return cls.from_units(
            A, B[:, used], C, D[:, used], duration=duration, stroke=stroke, inputs=inputs, outputs=list(names)
        )

    def at_speed(self, factor: float) -> Self:
        """The same machine `factor` times as fast: the rise takes 1/factor of its duration.

        Examples
        --------
        >>> Machine([[-2.0]], [[2.0]], [[1.0]]).at_speed(2.0).A
        ((-1.0,),)
        """
        duration = 1.0 / positive(factor, "factor")
        A, B, C, D = (np.array(matrix) for matrix in (self.A, self.B, self.C, self.D))
        return self.from_units(A, B, C, D, duration=duration, inputs=self.inputs, outputs=self.outputs)

    @kept_property
    def modes(self) -> tuple[Mode, ...]:
        """The machine's free vibrations, the slowest first; equal roots are one mode."""
        return modes(self)

    def response(self, law: MotionLaw, *, dwell: float = 0.0) -> MachineMotion:
        """The response of the machine during a rise and the dwell after it.

        Parameters
        ----------
        dwell
            How much of the dwell is looked at, in durations of the rise; the machine is at rest before the law.

        Examples
        --------
        >>> from optlaws import smoothstep
        >>> machine = Machine([[0, 1], [-400, 0]], [[0], [400]], [[1, 0]], outputs=["position"])
        >>> machine.response(smoothstep(4), dwell=1.0).dwell_peak("position")
        Peak(value=1.004147, k=1.128319)
        """
        return MachineMotion.of_law(self, motion_law(law), not_negative(dwell, "dwell"))

    def cycle(
        self, rise: MotionLaw, fall: MotionLaw | None = None, *, dwell: float, fall_duration: float = 1.0, rest: float
    ) -> MachineMotion:
        """The steady motion of the machine when the law rises, dwells, returns and rests, as `Follower.cycle` takes it.

        Raises
        ------
        InputError
            If a duration is out of range, the return does not lead back, or the machine is in resonance with the
            cycle.

        Examples
        --------
        >>> from optlaws import smoothstep
        >>> machine = Machine([[0, 1], [-400, -2]], [[0], [400]], [[1, 0]], outputs=["position"])
        >>> machine.cycle(smoothstep(4), dwell=0.5, rest=1.0).peak("position")
        Peak(value=1.00..., k=...)
        """
        cycle = RiseReturnCycle(rise, rise if fall is None else fall, dwell, fall_duration, rest)
        return MachineMotion.of_cycle(self.dynamics, self.rows, cycle)

    @documented_by(Measure)
    def peak(
        self,
        output: str | None = None,
        *,
        within: tuple[float, float] = (0.0, 1.0),
        cycle: tuple[float, float] | None = None,
        side: PeakSide = "both",
        offset: float = 0.0,
    ) -> OutputPeak:
        """The peak of an output as a constant of the law, to be minimised or bounded; convex.

        Parameters
        ----------
        output
            Which output; the first one unless given.

        Examples
        --------
        >>> from optlaws import Chebyshev, Problem, synthesize
        >>> axis = Machine.from_masses(
        ...     {"motor": 1.0, "load": 2.0}, [("motor", "load", 800.0, 2.0)], drive="motor", outputs=["drive force"]
        ... )
        >>> solution = synthesize(Problem(order=3, basis=Chebyshev(7), minimise=axis.peak(), symmetric=False))
        >>> solution.status.value, solution.objective, axis.response(solution.law).peak("drive force").value
        ('optimal', 12.652585, 12.652585)
        """
        from optlaws.mechanisms.machine.output_constants import output_peak

        return output_peak(of=self, within=within, cycle=cycle, output=output, side=side, offset=offset)

    @documented_by(Measure)
    def rms(
        self,
        output: str | None = None,
        *,
        dwell: float = 0.0,
        cycle: tuple[float, float] | None = None,
        offset: float = 0.0,
    ) -> OutputRms:
        """The root mean square of an output as a constant of the law, to be minimised or bounded; convex.

        Parameters
        ----------
        output
            Which output; the first one unless given.

        Examples
        --------
        >>> from optlaws import smoothstep
        >>> round(Machine([[-2.0]], [[2.0]], [[1.0]]).rms().value(smoothstep(4)), 6)
        0.3
        """
        from optlaws.mechanisms.machine.output_constants import output_rms

        return output_rms(of=self, dwell=dwell, cycle=cycle, output=output, offset=offset)

    @documented_by(Measure)
    def residual(
        self,
        mode: int = 1,
        output: str | None = None,
        *,
        spread: float = 0.0,
        damping: tuple[float, float] | float | None = None,
    ) -> ModeResidual:
        """The amplitude that a mode is left with after the motion, as a constant of the law; convex.

        Of the free vibration in the output at k = 1, its envelope where damped. With `spread` or `damping` the greatest
        over a box of frequencies and damping ratios; the mode's share in the output stays as it is, as it does when the
        whole machine runs faster or slower.

        Parameters
        ----------
        mode
            Number of the mode, as in `modes`.
        output
            Which output; the first one unless given.

        Examples
        --------
        >>> from optlaws import smoothstep
        >>> machine = Machine([[0, 1], [-400, -2]], [[0], [400]], [[-400, -2]], [[400]], outputs=["acceleration"])
        >>> machine.residual().value(smoothstep(4)), machine.residual(spread=0.1).value(smoothstep(4))
        (1.650151, 4.516368)
        """
        from optlaws.mechanisms.machine.residual import mode_residual

        return mode_residual(of=self, mode=mode, spread=spread, damping=damping, output=output)


def _matrices(system: Any) -> tuple[Any, Any, Any, Any]:
    """A, B, C and D of a system, continuous in time: state space, transfer function, or zeros, poles and gain."""
    step = getattr(system, "dt", None)
    if step is not None and step != 0:
        raise InputError(f"a system must be continuous in time, got one with steps of {shortened(step)}")
    try:
        if type(system).__module__.partition(".")[0] == "control":
            import control

            known = control.ss(system)
        else:
            known = system if all(hasattr(system, name) for name in "ABCD") else system.to_ss()
        A, B, C, D = (getattr(known, name) for name in "ABCD")
    except (AttributeError, TypeError, ValueError, NotImplementedError) as error:
        raise InputError(
            "a system must be one of scipy.signal (StateSpace, TransferFunction, ZerosPolesGain) or of python-control "
            f"(ss, tf), proper and with one input for each of the law's, got {shortened(system)}: {error}"
        ) from None
    if not np.size(A):
        raise InputError("the system has no state: a mere gain is no machine")
    return A, B, C, D


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
    >>> spectrum.to_pandas().columns.tolist(), [line.get_label() for line in spectrum.plot()]
    (['peak drive force', 'frequency of mode 1', 'mode 1 left in drive force'], ['peak', 'mode 1 left'])
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
        """
        from optlaws.plots.machine import draw_machine_spectrum

        return draw_machine_spectrum(self, ax, **style)

    def to_pandas(self) -> Any:
        """A table: peaks of all outputs, frequencies and what is left of the modes, a row for each value."""
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
