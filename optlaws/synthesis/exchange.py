"""Few points by IPOPT, then the exact active set by Newton; where that fails, the true extrema join the points."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from optlaws.synthesis.active_set import ActiveSet, newton
from optlaws.synthesis.contacts import completed, settled
from optlaws.synthesis.rows import EvenFamily, Family, NormFamily, Points, Program
from optlaws.synthesis.transcription import Answer, solve_on_points

Array = NDArray[np.float64]

_ROUNDS = 12
_CORRECTIONS = 8
_WEIGHTLESS = 1e-7
_LOST = 1e7
_AMPLE = 1.2


@dataclass(frozen=True, eq=False)
class Outcome:
    """How a program ended: the optimum (None where there is none), IPOPT's iterations and last word, the rounds."""

    optimum: ActiveSet | None
    iterations: int
    rounds: int
    status: str


def solve(
    program: Program,
    warm: ActiveSet | None = None,
    *,
    start: Array | None = None,
    holds: Callable[[Array], bool] | None = None,
) -> Outcome:
    """Solve a semi-infinite program; a neighbour's optimum as `warm` is tried before IPOPT, which begins at `start`.

    `holds` may tell from x alone, and more quickly than the families do, whether every constraint holds.
    """
    if warm is not None:
        optimum = polished(program, warm, holds)
        if optimum is not None:
            return Outcome(optimum, 0, 0, "continued from a neighbour")
    points = _first_points(program)
    if start is None and program.curved:
        start = _lifted(program, points)
        guess = _norms_only(program, start)
        optimum = polished(program, guess, holds) if guess is not None else None
        if optimum is not None:
            return Outcome(optimum, 0, 0, "least squares")
    iterations = 0
    status = ""
    for attempt in range(1, _ROUNDS + 1):
        answer = solve_on_points(program, points, start)
        iterations += answer.iterations
        if not answer.usable and not program.curved:
            answer = solve_on_points(program, points, start, careful=True)
            iterations += answer.iterations
        if not answer.usable:
            return Outcome(None, iterations, attempt, answer.status)
        status = answer.status
        if not np.isfinite(answer.x).all() or np.abs(answer.x).max() > _LOST:
            return Outcome(None, iterations, attempt, status)
        optimum = polished(program, _identified(program, points, answer), holds)
        if optimum is not None:
            return Outcome(optimum, iterations, attempt, status)
        asked = points
        points = [_exchanged(family, mine, answer.x) for family, mine in zip(program.families, points, strict=True)]
    rough = _as_answered(asked, answer) if not program.curved else None
    return Outcome(rough, iterations, _ROUNDS, status)


def polished(program: Program, start: ActiveSet, holds: Callable[[Array], bool] | None) -> ActiveSet | None:
    """Newton on a guess of the contacts, which is corrected a few times by what the answer says."""
    guess = start
    for _ in range(_CORRECTIONS):
        optimum = newton(program, guess)
        if optimum is None:
            return None
        guess = settled(program, optimum)
        if guess is optimum and (holds is None or not holds(optimum.x)):
            guess = completed(program, optimum)
        if guess is optimum:
            return optimum
    return None


def _norms_only(program: Program, x: Array) -> ActiveSet | None:
    """A guess in which RMS alone bind, where they alone are minimised: it may need no IPOPT, which dislikes norms."""
    norms = [i for i, one in enumerate(program.families) if isinstance(one, NormFamily)]
    weighed = {int(place) for i in norms for place in np.flatnonzero(program.families[i].slack)}
    if weighed != set(np.flatnonzero(program.objective).tolist()):
        return None
    family = np.array(norms, dtype=np.intp)
    ones = np.ones(len(family))
    x = x + _least_squares(program, [one for one in program.families if isinstance(one, NormFamily)])
    free = np.zeros(len(family), dtype=np.bool_)
    return ActiveSet(x, family, ones, ones, free, ones, np.zeros(len(program.right)))


def _least_squares(program: Program, norms: list[NormFamily]) -> Array:
    """Coordinates that make the sum of the squares of the norms least under the equations."""
    if not norms:
        return np.zeros(program.size)
    matrix = np.vstack([one.matrix for one in norms])
    square = matrix[:, :-1].T @ matrix[:, :-1]
    count = len(program.right)
    system = np.block([[square, program.equalities.T], [program.equalities, np.zeros((count, count))]])
    right = np.concatenate([-matrix[:, :-1].T @ matrix[:, -1], program.right])
    return np.asarray(np.linalg.lstsq(system, right, rcond=None)[0][: program.size], dtype=np.float64)


def _lifted(program: Program, points: list[Points]) -> Array:
    """The base law with room for its own constants: from below them curved programs are hard to enter."""
    x = np.zeros(program.size)
    for family, mine in zip(program.families, points, strict=True):
        needed = float((mine.s * family.value(np.zeros(program.size), mine.u)).max()) - family.bound
        places = family.slack > 0.0
        x[places] = np.maximum(x[places], _AMPLE * needed / family.slack[places])
    return x


def _first_points(program: Program) -> list[Points]:
    # with no peak to hold them, the velocity constraints need points enough by themselves
    share = 0.75 if any(len(family.signs) > 1 for family in program.families) else 1.5
    return [_points(family, program.size, share) for family in program.families]


def _points(family: Family, size: int, even_share: float) -> Points:
    """As many points as make IPOPT quick and the contacts plain; the rarer sign of a magnitude gets half as many."""
    low, high = family.domain
    if low == high:
        return Points(np.repeat([low], len(family.signs)), np.array(family.signs))
    own = family.nodes()
    if own is not None:
        return Points(np.tile(own, len(family.signs)), np.repeat(family.signs, len(own)))
    u, s = [], []
    for i, sign in enumerate(family.signs):
        if isinstance(family, EvenFamily):
            count = int(even_share * size) + 4
            places = np.cos(np.arange(count) * np.pi / (count - 1))
        elif low == 0.0:
            count = int((1.5, 0.75)[i] * size) + 4
            places = high * np.cos((np.arange(count) + 0.5) * np.pi / (2 * count))
        else:
            count = int(1.5 * size) + 4
            places = (high + low) / 2 + (high - low) / 2 * np.cos((np.arange(count) + 0.5) * np.pi / count)
        u.append(places)
        s.append(np.full(count, sign))
    return Points(np.concatenate(u), np.concatenate(s))


def _exchanged(family: Family, points: Points, x: Array) -> Points:
    if family.domain[0] == family.domain[1]:
        return points
    u, s, residual = family.extremes(x)
    near = residual > -1e-2 * max(1.0, abs(family.room(x)))
    return points.joined(Points(u[near], s[near]))


def _identified(program: Program, points: list[Points], answer: Answer) -> ActiveSet:
    """Give each point's multiplier to the extremum that its hill leads to; those are the contacts."""
    found: list[tuple[int, float, float, bool, float]] = []
    for i, (family, mine) in enumerate(zip(program.families, points, strict=True)):
        weights = answer.multipliers[i]
        u, s, residual = family.extremes(answer.x)
        jet = family.jet(answer.x, mine.u, mine.s)
        gathered = np.zeros(len(u))
        for j in np.flatnonzero(_binding(jet.gradient, weights, jet.value)):
            higher = (s == mine.s[j]) & (residual >= jet.value[j] - 1e-9)
            distance = np.where(higher, np.abs(u - mine.u[j]), np.inf)
            gathered[np.argmin(distance)] += weights[j]
        inside = (u > family.domain[0]) & (u < family.domain[1]) & ~family.pinned(u)
        found += [(i, u[j], s[j], inside[j], gathered[j]) for j in np.flatnonzero(gathered)]
    family_of, places, signs, free, multipliers = zip(*found, strict=True) if found else ((),) * 5
    return ActiveSet(
        x=answer.x,
        family=np.asarray(family_of, dtype=np.intp),
        u=np.asarray(places, dtype=np.float64),
        s=np.asarray(signs, dtype=np.float64),
        free=np.asarray(free, dtype=np.bool_),
        multipliers=np.asarray(multipliers, dtype=np.float64),
        equality_multipliers=answer.multipliers[-1],
    )


def _as_answered(points: list[Points], answer: Answer) -> ActiveSet:
    """IPOPT's own contacts, for optima that are flat somewhere, where no exact active set exists."""
    weights = answer.multipliers
    kept = [np.flatnonzero(w > _WEIGHTLESS * max(1.0, float(w.max(initial=0.0)))) for w in weights[:-1]]
    return ActiveSet(
        x=answer.x,
        family=np.concatenate([np.full(len(j), i, dtype=np.intp) for i, j in enumerate(kept)]),
        u=np.concatenate([mine.u[j] for mine, j in zip(points, kept, strict=True)]),
        s=np.concatenate([mine.s[j] for mine, j in zip(points, kept, strict=True)]),
        free=np.zeros(sum(map(len, kept)), dtype=np.bool_),
        multipliers=np.concatenate([w[j] for w, j in zip(weights[:-1], kept, strict=True)]),
        equality_multipliers=weights[-1],
    )


def _binding(rows: Array, weights: Array, residual: Array) -> NDArray[np.bool_]:
    # complementarity, in units in which each row has length 1: a contact's multiplier exceeds its distance
    squared = np.einsum("ij,ij->i", rows, rows)
    binding: NDArray[np.bool_] = weights * squared > -residual
    binding &= weights * np.sqrt(squared) > _WEIGHTLESS
    return binding
