"""Programs of large laws in units of their size: tolerances are meant for numbers near 1.

A law with B = 1e6 has coordinates and peaks of that size, and a power of its square. Divided by these the program is
that of a law of stroke 1e-6 with B = 1, and its multipliers are the same but for what the rows were divided by.

Of a very long move the shares of the limits have weights as 4e-10 J. What such a weight adds to an optimality condition
is less than what a solver leaves there: the constant is then in units in which its weight is near 1.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from optlaws.numbers import Array, power_of_two
from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.families.curved import FormulaFamily
from optlaws.synthesis.families.energy import EnergyFamily
from optlaws.synthesis.families.family import ConstraintFamily, LinearFamily, ProductFamily, Program

#: smaller laws are solved as they are
_GREAT = 100.0
#: weights of constants that are greater are solved as they are
_LIGHT = 1e-5


@dataclass(frozen=True, eq=False)
class ProgramUnits:
    """A program in other units, and the way there and back.

    Attributes
    ----------
    program
        The program in these units.
    variables, rows
        What its variables are divided by, and the rows of each family.
    equations, objective
        What its equations and its objective are divided by.
    """

    program: Program
    variables: Array
    rows: Array
    equations: float
    objective: float

    def inward(self, state: ActiveSet) -> ActiveSet:
        """A state of the program itself in these units."""
        rows = np.append(self.rows, 1.0)[np.minimum(state.family, len(self.rows))]
        return replace(
            state,
            x=state.x / self.variables,
            multipliers=state.multipliers * rows / self.objective,
            equality_multipliers=state.equality_multipliers * (self.equations / self.objective),
        )

    def outward(self, state: ActiveSet) -> ActiveSet:
        """A state in these units as a state of the program itself."""
        rows = np.append(self.rows, 1.0)[np.minimum(state.family, len(self.rows))]
        return replace(
            state,
            x=state.x * self.variables,
            multipliers=state.multipliers * self.objective / rows,
            equality_multipliers=state.equality_multipliers * (self.objective / self.equations),
        )


def units_of(program: Program) -> ProgramUnits | None:
    """The units that suit a program's numbers; None where they are near 1.

    Its equations and the constants that it bounds from below show how great its laws are.
    """
    limits = [-family.bound for family in program.families if family.domain[0] == family.domain[1]]
    size = max([float(np.abs(program.right).max(initial=0.0)), *limits])
    size, constants = size if size > _GREAT else 1.0, _units_of_constants(program)
    if size == constants.max() == 1.0:
        return None
    powers = np.zeros(program.size, dtype=np.bool_)
    for family in program.families:
        if isinstance(family, ProductFamily):
            powers |= family.slack != 0.0
    variables = np.where(powers, size * size, size) * constants
    # linear families are in units of the constants that they are bounded by
    bounding = [isinstance(family, LinearFamily) & (family.slack > 0.0) for family in program.families]
    units = [size * float(constants[chosen].max(initial=1.0)) for chosen in bounding]
    cost = program.objective * variables
    objective = float(np.abs(cost).max()) or 1.0
    scaled = Program(
        tuple(family.in_units(variables, unit) for family, unit in zip(program.families, units, strict=True)),
        program.equalities * variables / size,
        program.right / size,
        cost / objective,
    )
    rows = np.array([_row_unit(family, unit) for family, unit in zip(program.families, units, strict=True)])
    return ProgramUnits(scaled, variables, rows, size, objective)


def _units_of_constants(program: Program) -> Array:
    """A power of two for each variable: above 1 for constants of linear families that have light weights alone."""
    weights = np.abs(program.objective)
    for family in program.families:
        if isinstance(family, LinearFamily) and family.domain[0] == family.domain[1]:
            weights = np.maximum(weights, np.abs(family.rows(np.array(family.domain[:1]), np.ones(1))[0][0]))
    units = np.ones(program.size)
    for family in program.families:
        light = (family.slack > 0.0) & (weights > 0.0) & (weights < _LIGHT)
        if isinstance(family, LinearFamily):
            units[light] = [power_of_two(1.0 / weight) for weight in weights[light].tolist()]
    return units


def _row_unit(family: ConstraintFamily, size: float) -> float:
    if isinstance(family, EnergyFamily | FormulaFamily):
        return 1.0
    return size**2 if isinstance(family, ProductFamily) else size
