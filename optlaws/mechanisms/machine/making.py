"""Machines made from what is known of them: masses and springs, measured modes, other packages' systems, followers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.mechanisms.follower.follower import Follower
from optlaws.mechanisms.machine.masses import Assembly, Link, assembly, named_outputs
from optlaws.mechanisms.machine.modes import ModalModel, modal_model
from optlaws.mechanisms.machine.state_space import SYMBOLS, StateSpace
from optlaws.numbers import NumberOrQuantity

Matrices = tuple[Any, Any, Any, Any]


@dataclass(frozen=True, init=False, repr=False)
class MachineConstructors(StateSpace):
    """The ways to build a machine: from masses, modes, systems or followers; `Machine` has them."""

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

        Raises
        ------
        InputError
            If a name is unknown or a number out of range.

        Examples
        --------
        >>> from optlaws import Machine
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
        """The machine of vibrations that were measured: frequencies and damping ratios, and how much of each shows.

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

        Raises
        ------
        InputError
            If a number is out of range or there is no such output.

        Examples
        --------
        >>> from optlaws import Machine, smoothstep
        >>> arm = Machine.from_modes([("8.5 Hz", 0.02)], duration="0.4 s", stroke="0.3 m", outputs=["deflection"])
        >>> arm, round(arm.residual().value(smoothstep(3)), 6)
        (Machine(states=2, inputs='ac', outputs=['deflection']), 0.003...)
        """
        return cls._driven(modal_model(modes), outputs, duration=duration, stroke=stroke)

    @classmethod
    def from_system(
        cls,
        system: Any,  # noqa: ANN401 - of any package
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

        Raises
        ------
        InputError
            If it is no such system.

        Examples
        --------
        >>> from optlaws import Machine
        >>> from scipy.signal import TransferFunction
        >>> Machine.from_system(TransferFunction([400], [1, 2, 400]), outputs=["position"])
        Machine(states=2, inputs='a', outputs=['position'])
        """
        A, B, C, D = matrices(system)
        return cls.from_units(A, B, C, D, duration=duration, stroke=stroke, inputs=inputs, outputs=outputs)

    @classmethod
    def from_follower(cls, follower: Follower) -> Self:
        """The elastic follower as a machine: outputs "position", "acceleration" and "deflection" of the mass.

        The deflection is that of the spring, from the cam to the mass. `Follower` itself has closed forms of its own,
        with some more digits of the little that smooth laws leave after the motion at large nu.

        Parameters
        ----------
        follower
            The follower.

        Raises
        ------
        InputError
            If it is none.

        Examples
        --------
        >>> from optlaws import Follower, Machine, smoothstep
        >>> machine = Machine.from_follower(Follower(nu=20, damping=0.05))
        >>> machine.residual(1, "acceleration").value(smoothstep(4))
        1.650151
        """
        if not isinstance(follower, Follower):
            raise InputError(f"follower must be a Follower, got {shortened(follower)}")
        # by its deflection, which is small: the displacements of cam and mass would cancel nu² times their rounding
        square, drag = follower.nu**2, 2.0 * follower.n
        bending = [-square, -drag]
        rows, direct = [[1.0, 0.0], bending, [1.0, 0.0]], [[1.0, 0.0, 0.0], [0.0, -drag, 0.0], [0.0, 0.0, 0.0]]
        names = ["position", "acceleration", "deflection"]
        load = [[0.0, 0.0, 0.0], [0.0, -drag, -1.0]]
        return cls([[0.0, 1.0], bending], load, rows, direct, inputs="abc", outputs=names)

    @classmethod
    def _driven(
        cls,
        given: Assembly | ModalModel,
        outputs: Mapping[str, str] | Sequence[str] | None,
        *,
        duration: NumberOrQuantity,
        stroke: NumberOrQuantity,
    ) -> Self:
        """The machine of a model driven by a, b and c, without those that do not enter."""
        names = named_outputs(given, outputs)
        A, B, C, D = given.matrices(list(names.values()))
        used = [i for i in range(3) if i == 0 or B[:, i].any() or D[:, i].any()]
        inputs = "".join(SYMBOLS[i] for i in used)
        return cls.from_units(
            A, B[:, used], C, D[:, used], duration=duration, stroke=stroke, inputs=inputs, outputs=list(names)
        )


def matrices(system: Any) -> Matrices:  # noqa: ANN401 - of any package
    """A, B, C and D of a system, continuous in time: state space, transfer function, or zeros, poles and gain.

    Raises
    ------
    InputError
        If it is none, or it is discrete in time.

    Examples
    --------
    >>> from scipy.signal import TransferFunction
    >>> A, B, C, D = matrices(TransferFunction([400.0], [1.0, 2.0, 400.0]))
    >>> A.tolist()
    [[-2.0, -400.0], [1.0, 0.0]]
    """
    step = getattr(system, "dt", None)
    if step is not None and step != 0:
        raise InputError(f"a system must be continuous in time, got one with steps of {shortened(step)}")
    try:
        state_space = _state_space(system)
        A, B, C, D = (getattr(state_space, name) for name in "ABCD")
    except (AttributeError, TypeError, ValueError, NotImplementedError) as error:
        raise InputError(
            "a system must be one of scipy.signal (StateSpace, TransferFunction, ZerosPolesGain) or of python-control "
            f"(ss, tf), proper and with one input for each of the law's, got {shortened(system)}: {error}"
        ) from None
    if not np.size(A):
        raise InputError("the system has no state: a mere gain is no machine")
    return A, B, C, D


def _state_space(system: Any) -> Any:  # noqa: ANN401
    if type(system).__module__.partition(".")[0] == "control":
        import control

        return control.ss(system)
    if not all(hasattr(system, name) for name in "ABCD"):
        return system.to_ss()
    return system
