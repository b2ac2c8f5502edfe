"""What problem files say of a machine and of the laws that are sought for it."""

from __future__ import annotations

from typing import Annotated, Any, Literal

import msgspec

from optlaws.errors import InputError
from optlaws.files.problem_file import Text
from optlaws.mechanisms.machine.machine import Machine
from optlaws.synthesis import Functional, Problem, at_most
from optlaws.synthesis.problem.fields import from_entries
from optlaws.synthesis.problem.named_constants import named

Pair = tuple[float, float]
Spread = Annotated[float, msgspec.Meta(ge=0.0, lt=1.0)]


class MachineTable(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """A machine of masses and links, of measured modes, or of matrices."""

    masses: dict[str, float] | None = None
    links: list[list[Any]] = []
    drive: str | list[str] = ""
    outputs: dict[str, str] | list[str] = []
    modes: list[list[float]] | None = None
    A: list[list[float]] | None = None
    B: list[list[float]] = []
    C: list[list[float]] = []
    D: list[list[float]] = []
    inputs: str = "a"
    duration: float = 1.0
    stroke: float = 1.0

    def machine(self) -> Machine:
        """The machine, checked.

        Raises
        ------
        InputError
            If it is none; the message begins with the table's name.
        """
        if sum(given is not None for given in (self.masses, self.modes, self.A)) != 1:
            raise InputError("machine: give either masses with links and a drive, or modes, or matrices A, B, C and D")
        try:
            if self.modes is not None:
                return Machine.from_modes(
                    self.modes, duration=self.duration, stroke=self.stroke, outputs=self.outputs or None
                )
            return self._of_masses(self.masses) if self.masses is not None else self._of_matrices()
        except InputError as error:
            raise InputError(f"machine: {error}") from None

    def _of_masses(self, masses: dict[str, float]) -> Machine:
        drive = self.drive if isinstance(self.drive, str) else tuple(self.drive)
        outputs = self.outputs or None
        units = {"duration": self.duration, "stroke": self.stroke}
        return Machine.from_masses(masses, self.links, drive=drive, outputs=outputs, **units)  # type: ignore[arg-type]

    def _of_matrices(self) -> Machine:
        names = list(self.outputs)
        units = {"duration": self.duration, "stroke": self.stroke}
        assert self.A is not None  # noqa: S101 - as the caller saw
        return Machine.from_units(self.A, self.B, self.C, self.D, inputs=self.inputs, outputs=names, **units)


class Measure(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """A constant of the machine: the peak or the RMS of an output, or what a mode is left with in one."""

    peak: Text | None = None
    rms: Text | None = None
    residual: int | None = None
    output: Text | None = None
    within: Pair = (0.0, 1.0)
    cycle: Pair | None = None
    dwell: float = 0.0
    spread: Spread = 0.0
    damping: Pair | None = None
    side: Literal["both", "high", "low"] = "both"
    offset: float = 0.0

    def constant(self, machine: Machine) -> Functional:
        """The constant of this machine.

        Raises
        ------
        InputError
            If it is none of the three, or more than one.
        """
        if sum(wish is not None for wish in (self.peak, self.rms, self.residual)) != 1:
            raise InputError(
                "a constant of the machine is one of peak and rms, each of an output, and residual of a mode"
            )
        if self.peak is not None:
            return machine.peak(self.peak, within=self.within, cycle=self.cycle, side=self.side, offset=self.offset)
        if self.rms is not None:
            return machine.rms(self.rms, dwell=self.dwell, cycle=self.cycle, offset=self.offset)
        return machine.residual(self.residual or 0, self.output, spread=self.spread, damping=self.damping)


class Kept(Measure, kw_only=True, forbid_unknown_fields=True):
    """A constant with what it is at most; of the machine, or of the law by its name."""

    most: float
    constant_name: Text | None = msgspec.field(default=None, name="constant")

    def bounded(self, machine: Machine) -> Functional:
        """What is bounded."""
        return self.constant(machine) if self.constant_name is None else named(self.constant_name)


class Sought(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """A law that is sought: what is minimised, what is kept, and any entry of a problem."""

    name: Text
    minimise: Text | Measure = "C"
    keep: list[Kept] = []
    problem: dict[str, Any] = {}

    def asked(self, machine: Machine) -> Problem:
        """The problem.

        Raises
        ------
        InputError
            If an entry is wrong; the message begins with the law's name.
        """
        try:
            entries = from_entries({"order": 3, **self.problem})
            wanted = self.minimise if isinstance(self.minimise, str) else self.minimise.constant(machine)
            kept = {bound.bounded(machine): at_most(bound.most) for bound in self.keep}
            entries["bounds"] = {**entries.get("bounds", {}), **kept}
            return Problem(**entries, minimise=wanted)
        except InputError as error:
            raise InputError(f"sought {self.name!r}: {error}") from None
