"""Machines that a law drives: made from matrices, masses or systems, and asked for responses and constants."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Self

import numpy as np

from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.mechanisms.checks import motion_law
from optlaws.mechanisms.machine.making import MachineConstructors
from optlaws.mechanisms.machine.modes import Mode, modes
from optlaws.mechanisms.machine.over_time import MachineCycle, MachineResponse
from optlaws.numbers import not_negative, positive

if TYPE_CHECKING:
    from optlaws.mechanisms.machine.output_constants import OutputPeak, OutputRms
    from optlaws.mechanisms.machine.residual_boxes import ModeResidual
    from optlaws.synthesis.functionals.makers import PeakSide


@dataclass(frozen=True, init=False, repr=False)
class Machine(MachineConstructors):
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
        If the matrices do not fit each other, a number is not finite, or the machine is unstable.

    Examples
    --------
    >>> from optlaws import smoothstep
    >>> machine = Machine([[0, 1], [-400, -2]], [[0], [400]], [[1, 0]], outputs=["position"])
    >>> machine
    Machine(states=2, inputs='a', outputs=['position'])
    >>> machine.response(smoothstep(4))["position"](0.5)
    0.489570
    """

    def at_speed(self, factor: float) -> Self:
        """The same machine run `factor` times as fast: the rise takes 1/factor of its duration.

        Raises
        ------
        InputError
            If the factor is not above 0.

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
        """The machine's free vibrations, the slowest first; equal roots are one mode.

        Examples
        --------
        >>> Machine([[0, 1], [-400, -2]], [[0], [400]], [[1, 0]]).modes
        (Mode(number=1, frequency=20, damping=0.05),)
        """
        return modes(self)

    def response(self, law: MotionLaw, *, dwell: float = 0.0) -> MachineResponse:
        """The response of the machine during a rise and the dwell after it.

        Parameters
        ----------
        law
            The law that drives it; the machine is at rest before.
        dwell
            Duration of the dwell that is looked at, in durations of the rise.

        Raises
        ------
        InputError
            If `law` is no motion law or the dwell is below 0.

        Examples
        --------
        >>> from optlaws import smoothstep
        >>> machine = Machine([[0, 1], [-400, 0]], [[0], [400]], [[1, 0]], outputs=["position"])
        >>> machine.response(smoothstep(4), dwell=1.0).dwell_peak("position")
        Peak(value=1.004147, k=1.128319)
        """
        return MachineResponse(self, motion_law(law), not_negative(dwell, "dwell"))

    def cycle(
        self, rise: MotionLaw, fall: MotionLaw | None = None, *, dwell: float, fall_duration: float = 1.0, rest: float
    ) -> MachineCycle:
        """The steady motion of the machine when the law rises, dwells, returns and rests again and again.

        Parameters
        ----------
        rise
            Law of the rise.
        fall
            Law of the return, run from its end of the rise as a(1) - (fall(k) - fall(0)); the rise's own unless given.
        dwell, rest
            Durations of the upper and of the lower dwell, in durations of the rise; 0 or more.
        fall_duration
            Duration of the return, in durations of the rise.

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
        return MachineCycle(
            self,
            motion_law(rise, "rise"),
            motion_law(rise if fall is None else fall, "fall"),
            not_negative(dwell, "dwell"),
            positive(fall_duration, "fall_duration"),
            not_negative(rest, "rest"),
        )

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
        within
            The first and the last time that count, in durations of the rise: (0, 1) the rise, (1, 1.5) a dwell after
            it, (0, 1.5) both.
        cycle
            The dwell and the rest of a cycle of rise, dwell, return and rest that repeats; then all of it counts.
        side
            "both" for the greatest magnitude, "high" for the greatest value, "low" for the greatest opposite.
        offset
            What is added to the output, in its units: a constant load, such as the weight that the drive holds.

        Raises
        ------
        InputError
            If there is no such output or side, or a number is out of range.

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
        dwell
            How much of the dwell after the rise counts too, in durations of the rise.
        cycle
            The dwell and the rest of a cycle of rise, dwell, return and rest that repeats; then all of it counts.
        offset
            What is added to the output, in its units: a constant load.

        Raises
        ------
        InputError
            If there is no such output, or a number is out of range.

        Examples
        --------
        >>> from optlaws import smoothstep
        >>> round(Machine([[-2.0]], [[2.0]], [[1.0]]).rms().value(smoothstep(4)), 6)
        0.3
        """
        from optlaws.mechanisms.machine.output_constants import output_rms

        return output_rms(of=self, dwell=dwell, cycle=cycle, output=output, offset=offset)

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
        spread
            Share by which the mode's frequency may be off, either way: 0.1 for 10 %.
        damping
            The least and the greatest damping ratio; the mode's own unless given.

        Raises
        ------
        InputError
            If there is no such mode or output, or a number is out of range.

        Examples
        --------
        >>> from optlaws import smoothstep
        >>> machine = Machine([[0, 1], [-400, -2]], [[0], [400]], [[-400, -2]], [[400]], outputs=["acceleration"])
        >>> machine.residual().value(smoothstep(4)), machine.residual(spread=0.1).value(smoothstep(4))
        (1.650151, 4.516368)
        """
        from optlaws.mechanisms.machine.residual_boxes import mode_residual

        return mode_residual(of=self, mode=mode, spread=spread, damping=damping, output=output)
