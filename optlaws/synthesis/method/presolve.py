"""Programs before they are solved: in units of their size, of independent equations, without amplitudes that vanish.

A law with B = 1e6 has coordinates and peaks of that size, and a power of its square: tolerances are meant for numbers
near 1. Divided by these the program is that of a law of stroke 1e-6 with B = 1, and its multipliers are the same but
for what the rows were divided by. Of a very long move the shares of the limits have weights as 4e-10 J. What such a
weight adds to an optimality condition is less than what a solver leaves there: the constant is then in units in which
its weight is near 1.

Where amplitudes vanish cones are at their apex: no interior point is near, and no direction shows. There an amplitude
is 0 in both of its parts, which are equations that any method can keep. Their multipliers are the direction that the
cone would have: it is an optimum of the program with cones if that is nowhere longer than 1.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from optlaws.numbers import Array, power_of_two
from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.families.cone import ConeFamily
from optlaws.synthesis.families.curved import FormulaFamily
from optlaws.synthesis.families.energy import EnergyFamily
from optlaws.synthesis.families.family import ConstraintFamily, LinearFamily, ProductFamily, Program
from optlaws.tolerances import DEPENDENT_ROWS, EMPTY_ROW, EXCESS

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


_EQUATION_OFF = 1e-9  # of a right side, or 1: by so much an equation may be missed
_NO_MULTIPLIER = 1e-12  # a multiplier that is less is none


def contradiction(rows: Array, right: Array) -> Array | None:
    """Multipliers y with y . rows = 0 and y . right < 0, the greatest of size 1; None where the equations agree.

    As few equations as may be have a multiplier: an equation of no variable, two for one value, else those
    that the least squares of the residuals weigh.

    Parameters
    ----------
    rows, right
        The equations rows . x = right, shapes (equations, variables) and (equations,).

    Examples
    --------
    >>> contradiction(np.array([[1.0, 1.0], [2.0, 2.0]]), np.array([1.0, 4.0])).tolist()
    [1.0, -0.5]
    """
    length = np.linalg.norm(rows, axis=1)
    empty = length < EMPTY_ROW
    for i in np.flatnonzero(empty & (np.abs(right) > _EQUATION_OFF)):
        return _unit(len(right), int(i), -float(np.sign(right[i])))
    length[empty] = 1.0
    rows, right = np.where(empty[:, None], 0.0, rows / length[:, None]), right / length
    multipliers = _of_one_value(rows, right)
    if multipliers is None:
        residual = right - rows @ np.linalg.lstsq(rows, right, rcond=DEPENDENT_ROWS)[0]
        if np.abs(residual).max(initial=0.0) <= _EQUATION_OFF * max(1.0, float(np.abs(right).max(initial=0.0))):
            return None
        multipliers = -residual
    multipliers = multipliers / length
    multipliers = multipliers / np.abs(multipliers).max()
    multipliers[np.abs(multipliers) < _NO_MULTIPLIER] = 0.0
    return np.asarray(multipliers, dtype=np.float64)


def independent(rows: Array) -> NDArray[np.bool_]:
    """Indices of independent rows, the earlier ones first; the other rows depend on them.

    Examples
    --------
    >>> independent(np.array([[1.0, 0.0], [2.0, 0.0], [1.0, 1.0]])).tolist()
    [True, False, True]
    """
    chosen = np.zeros(len(rows), dtype=np.bool_)
    directions = np.empty((0, rows.shape[1]))
    for i, row in enumerate(rows):
        size = float(np.linalg.norm(row))
        if size < EMPTY_ROW:
            continue
        left = row / size
        for _ in range(2):
            left = left - directions.T @ (directions @ left)
        new = float(np.linalg.norm(left))
        if new > DEPENDENT_ROWS:
            chosen[i] = True
            directions = np.vstack([directions, left / new])
    return chosen


def _of_one_value(rows: Array, right: Array) -> Array | None:
    """Two equations with different values of the same sum."""
    for i in range(len(rows)):
        for j in range(i):
            for sign in (1.0, -1.0):
                off = right[i] - sign * right[j]
                same = np.abs(rows[i] - sign * rows[j]).max(initial=0.0) < EMPTY_ROW
                if same and abs(off) > _EQUATION_OFF * max(1.0, abs(right[i])):
                    size = float(np.sign(off))
                    return _unit(len(right), j, size * sign) + _unit(len(right), i, -size)
    return None


def _unit(count: int, place: int, size: float) -> Array:
    unit = np.zeros(count)
    unit[place] = size
    return unit


_NEARLY_APEX = 1e-5  # of what the base law leaves: an amplitude that is less may vanish
_VANISHED = 1e-13  # amplitudes that are minimised vanish if their sum is less
_APEX_DIRECTION = 1e-9  # of a multiplier: by so much the parts of an amplitude that vanishes may pull more than it does


def amplitudes(program: Program) -> list[int]:
    """The families that are cones of one place, each with a variable of its own for its right side."""
    return [
        i
        for i, family in enumerate(program.families)
        if isinstance(family, ConeFamily)
        and family.domain[0] == family.domain[1]
        and np.count_nonzero(family.slack) == 1
        and family.slack.max() > 0.0
        and not any(other.slack[np.argmax(family.slack)] for other in program.families if other is not family)
    ]


def nearly_vanished(program: Program, x: Array) -> list[int]:
    """Amplitudes that nearly vanish, relative to the amplitudes of a law that ignores them."""
    return [i for i in amplitudes(program) if program.families[i].right_side(x) < _NEARLY_APEX]


def at_apex(
    program: Program, vanished: Sequence[int], solve: Callable[[Program], ActiveSet | None]
) -> ActiveSet | None:
    """The optimum of a program in which some amplitudes vanish; None where that is none.

    Parameters
    ----------
    program
        The program with its cones.
    vanished
        Which of its families are amplitudes that vanish, as `amplitudes` has them.
    solve
        How a program without these cones is solved.
    """
    others = np.array([i for i in range(len(program.families)) if i not in vanished], dtype=np.intp)
    blocks, right = [program.equalities], [program.right]
    for i in vanished:
        rows, most = _equations(program, i)
        blocks.append(rows)
        right.append(most)
    without = replace(
        program,
        families=tuple(program.families[i] for i in others),
        equalities=np.vstack(blocks),
        right=np.concatenate(right),
        equation_units=None,
    )
    optimum = solve(without)
    if optimum is None:
        return None
    count = len(program.right)
    multipliers, places = [], []
    for part, i in zip(optimum.equality_multipliers[count:].reshape(-1, 3), vanished, strict=True):
        real, imaginary, raised = part
        # what the right side costs is what the amplitude may pull with
        if not np.hypot(real, imaginary) <= -raised * (1.0 + _APEX_DIRECTION):
            return None
        multipliers.append(-raised)
        places.append(program.families[i].domain[0])
    return replace(
        optimum,
        family=np.append(others[optimum.family], np.array(vanished, dtype=np.intp)),
        u=np.append(optimum.u, places),
        s=np.append(optimum.s, np.ones(len(places))),
        free=np.append(optimum.free, np.zeros(len(places), dtype=np.bool_)),
        multipliers=np.append(optimum.multipliers, multipliers),
        equality_multipliers=optimum.equality_multipliers[:count],
    )


def _equations(program: Program, i: int) -> tuple[Array, Array]:
    """Both parts of an amplitude are 0, and so is its right side."""
    family = program.families[i]
    if not isinstance(family, ConeFamily):
        raise TypeError(f"{type(family).__name__} is no cone")
    column = family.columns(np.array(family.domain[:1]))[0, 0]
    rows = np.vstack([column.real[:-1], column.imag[:-1], family.slack])
    return rows, np.array([-column.real[-1], -column.imag[-1], -family.bound])


def vanishing(program: Program) -> ActiveSet | None:
    """A law in which all amplitudes that are minimised vanish: many may have none, and then no contact shows one."""
    minimised = [family for family in program.families if (program.objective * family.slack).any()]
    cones = [family for family in minimised if isinstance(family, ConeFamily) and family.domain[0] == family.domain[1]]
    costs = np.flatnonzero(program.objective)
    bounded = all(sum(cone.slack[i] for cone in cones) for i in costs)
    if not cones or len(cones) < len(minimised) or not bounded:
        return None
    columns = [cone.columns(np.array(cone.domain[:1]))[0, 0] for cone in cones]
    rows = np.vstack([np.array([column.real, column.imag]) for column in columns])
    conditions = np.concatenate([rows[:, :-1], program.equalities])
    right = np.concatenate([-rows[:, -1], program.right])
    # what is minimised is to be nothing
    conditions[:, costs] = 0.0
    x = np.linalg.lstsq(conditions, right, rcond=None)[0]
    if np.abs(conditions @ x - right).max() > _VANISHED or program.violation(x) > EXCESS:
        return None
    return ActiveSet.of_contacts(x, (), np.zeros(len(program.right)))
