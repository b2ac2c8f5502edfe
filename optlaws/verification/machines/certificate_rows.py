"""Rows of certificates in balls, for machines too: outputs at a time, their mean squares, amplitudes of modes."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import partial

from flint import acb, arb

from optlaws.mechanisms.machine.residual import Residual
from optlaws.synthesis.proof.nodes import Contact
from optlaws.synthesis.spaces.space import LawSpace
from optlaws.verification.enclosing.balls import ball
from optlaws.verification.machines.output_motion import DrivenStretch
from optlaws.verification.machines.residuals import exact_residual

Names = Mapping[str, float | arb]


@dataclass(frozen=True, eq=False)
class BallRow:
    """functions . (z, 1) + sum of constants + right; at most 0, or 0 for an equation, in every law of the problem."""

    functions: list[arb]
    constants: Names = field(default_factory=dict)
    right: arb | float = 0.0

    def vector(self, variables: list[str]) -> list[arb]:
        """Coefficients of z and of the named constants, then what is constant."""
        *free, base = self.functions
        return [*free, *(arb(self.constants.get(name, 0.0)) for name in variables), base + self.right]


@dataclass(frozen=True, eq=False)
class UpperLimit:
    """A sum of named constants, their signs turned, and a number, which a function of the law is at most."""

    constants: Names = field(default_factory=dict)
    high: float | arb = 0.0

    def row(self, functions: Iterable[arb], unit: arb | None = None) -> BallRow:
        """The row of a function of the law, in a unit if one is given."""
        if unit is None:
            return BallRow(list(functions), self.constants, -arb(self.high))
        constants = {name: arb(value) / unit for name, value in self.constants.items()}
        return BallRow([value / unit for value in functions], constants, -arb(self.high) / unit)


Maker = Callable[[Contact, Fraction], BallRow]


def cone(amplitudes: Callable[[Fraction], list[acb]], limit: UpperLimit, unit: arb) -> Maker:
    """A direction times a complex amplitude is at most its magnitude."""
    known: dict[Fraction, list[acb]] = {}

    def make(contact: Contact, k: Fraction) -> BallRow:
        if len(contact.direction) != 2:
            raise LookupError
        if k not in known:
            known[k] = amplitudes(k)
        real, imaginary = (ball(value) for value in contact.direction)
        length = (real**2 + imaginary**2).sqrt().max(arb(1))
        return limit.row(((value.real * real + value.imag * imaginary) / length for value in known[k]), unit)

    return make


def residual_cones(
    constant: Residual, drives: Sequence[DrivenStretch], solved: LawSpace, limit: UpperLimit
) -> dict[str, Maker]:
    """A cone for each edge of a residual by its name, in the units of the certificate."""
    exact, sought = exact_residual(constant), bool(limit.constants)
    units = [constant.unit(solved, i, float(limit.high), sought=sought) for i in range(len(constant.part_names))]
    return {
        name: cone(partial(exact.rows, drives, i), limit, ball(unit))
        for i, (name, unit) in enumerate(zip(constant.part_names, units, strict=True))
    }
