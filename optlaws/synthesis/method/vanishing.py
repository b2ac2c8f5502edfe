"""Optima in which amplitudes vanish: cones at their apex, where no interior point is near and no direction shows.

There an amplitude is 0 in both of its parts, which are equations that any method can keep. Their multipliers are the
direction that the cone would have: it is an optimum of the program with cones if that is nowhere longer than 1.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from optlaws.numbers import Array
from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.families.cone import ConeFamily
from optlaws.synthesis.families.family import Program
from optlaws.tolerances import EXCESS

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
