"""Few points by IPOPT, then the exact active set by Newton; where that fails, the true extrema join the points."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from optlaws.synthesis.active_set import ActiveSet, newton
from optlaws.synthesis.contacts import completed, settled
from optlaws.synthesis.rows import Family, Points, Program
from optlaws.synthesis.transcription import Answer, solve_rows

Array = NDArray[np.float64]

VIOLATION = 1e-10
_ROUNDS = 12
_CORRECTIONS = 8
_WEIGHTLESS = 1e-7


@dataclass(frozen=True, eq=False)
class Outcome:
    """How a program ended: the optimum (None where there is none), IPOPT's iterations and last word, the rounds."""

    optimum: ActiveSet | None
    iterations: int
    rounds: int
    status: str


def solve(
    program: Program,
    right: float,
    warm: ActiveSet | None = None,
    *,
    holds: Callable[[Array], bool] | None = None,
    rounds: int = _ROUNDS,
) -> Outcome:
    """Solve a semi-infinite linear program; a neighbour's optimum as `warm` is tried before IPOPT.

    `holds` may tell from x alone, and more quickly than the families do, whether every constraint holds.
    """
    if warm is not None:
        optimum = _polished(program, warm, right, holds)
        if optimum is not None:
            return Outcome(optimum, 0, 0, "continued from a neighbour")
    points = _first_points(program)
    iterations = 0
    status = ""
    for attempt in range(1, rounds + 1):
        answer = _on_points(program, points, right)
        iterations += answer.iterations
        if not answer.usable:
            answer = _on_points(program, points, right, careful=True)
            iterations += answer.iterations
            if not answer.usable:
                return Outcome(None, iterations, attempt, answer.status)
        status = answer.status
        if not np.isfinite(answer.x).all() or np.abs(answer.x).max() > 1e7:
            return Outcome(None, iterations, attempt, status)
        optimum = _polished(program, _identified(program, points, answer), right, holds)
        if optimum is not None:
            return Outcome(optimum, iterations, attempt, status)
        points = [_exchanged(family, mine, answer.x) for family, mine in zip(program.families, points, strict=True)]
    return Outcome(None, iterations, rounds, status)


def _polished(
    program: Program, start: ActiveSet, right: float, holds: Callable[[Array], bool] | None
) -> ActiveSet | None:
    """Newton on a guess of the contacts, which is corrected a few times by what the answer says."""
    guess = start
    for _ in range(_CORRECTIONS):
        optimum = newton(program, guess, right)
        if optimum is None:
            return None
        guess = settled(program, optimum)
        if guess is optimum and (holds is None or not holds(optimum.x)):
            guess = completed(program, optimum, VIOLATION * max(1.0, abs(float(optimum.x[-1]))))
        if guess is optimum:
            return optimum
    return None


def _on_points(program: Program, points: list[Points], right: float, *, careful: bool = False) -> Answer:
    parts = [family.rows(mine.u, mine.s) for family, mine in zip(program.families, points, strict=True)]
    rows = np.vstack([*(a for a, _ in parts), program.equality])
    uppers = np.concatenate([*(h for _, h in parts), [right - program.equality_offset]])
    return solve_rows(rows, uppers, 1, program.objective, careful=careful)


def _first_points(program: Program) -> list[Points]:
    # with no peak to hold them, the velocity constraints need points enough by themselves
    share = 0.75 if any(family.odd for family in program.families) else 1.5
    return [_points(family, program.size, share) for family in program.families]


def _points(family: Family, size: int, even_share: float) -> Points:
    """As many points as make IPOPT quick and the contacts plain; the rarer sign of a magnitude gets half as many."""
    if family.odd:
        u, s = [], []
        for sign, share in zip(family.signs, (1.5, 0.75), strict=False):
            count = int(share * size) + 4
            u.append(np.cos((np.arange(count) + 0.5) * np.pi / (2 * count)))
            s.append(np.full(count, sign))
        return Points(np.concatenate(u), np.concatenate(s))
    count = int(even_share * size) + 4
    return Points(np.cos(np.arange(count) * np.pi / (count - 1)), np.ones(count))


def _exchanged(family: Family, points: Points, x: Array) -> Points:
    u, s, residual = family.extremes(x)
    near = residual > -1e-2 * max(1.0, abs(float(x[-1])))
    return points.joined(Points(u[near], s[near]))


def _identified(program: Program, points: list[Points], answer: Answer) -> ActiveSet:
    """Give each point's multiplier to the extremum that its hill leads to; those are the contacts."""
    family_of: list[int] = []
    u_of: list[float] = []
    s_of: list[float] = []
    free_of: list[bool] = []
    weight_of: list[float] = []
    first = 0
    for i, (family, mine) in enumerate(zip(program.families, points, strict=True)):
        weights = answer.multipliers[first : first + len(mine.u)]
        first += len(mine.u)
        u, s, residual = family.extremes(answer.x)
        here = mine.s * family.residual(answer.x, mine.u) - float(family.slack @ answer.x)
        gathered = np.zeros(len(u))
        for j in np.flatnonzero(_binding(family.rows(mine.u, mine.s)[0], weights, here)):
            higher = (s == mine.s[j]) & (residual >= here[j] - 1e-9)
            distance = np.where(higher, np.abs(u - mine.u[j]), np.inf)
            gathered[np.argmin(distance)] += weights[j]
        ends = (u <= family.lowest) | (u >= 1.0)
        for j in np.flatnonzero(gathered):
            family_of.append(i)
            u_of.append(float(u[j]))
            s_of.append(float(s[j]))
            free_of.append(not ends[j])
            weight_of.append(float(gathered[j]))
    return ActiveSet(
        x=answer.x,
        family=np.asarray(family_of, dtype=np.intp),
        u=np.asarray(u_of),
        s=np.asarray(s_of),
        free=np.asarray(free_of, dtype=np.bool_),
        multipliers=np.asarray(weight_of),
        equality_multiplier=float(answer.multipliers[-1]),
    )


def _binding(rows: Array, weights: Array, residual: Array) -> NDArray[np.bool_]:
    # complementarity, in units in which each row has length 1: a contact's multiplier exceeds its distance
    squared = np.einsum("ij,ij->i", rows, rows)
    binding: NDArray[np.bool_] = weights * squared > -residual
    binding &= weights * np.sqrt(squared) > _WEIGHTLESS
    return binding
