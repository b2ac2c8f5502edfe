"""Few points by IPOPT, then the exact active set by Newton; where that fails, the true extrema join the points.

A linear program that this does not end is ended by vertices.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.families.cone import ConeFamily
from optlaws.synthesis.families.family import Family, LinearFamily, NormFamily, Points, ProductFamily, Program
from optlaws.synthesis.method.contacts import EXCESS, completed, settled
from optlaws.synthesis.method.equations import contradiction, independent
from optlaws.synthesis.method.newton import newton
from optlaws.synthesis.method.on_points.conic import conic
from optlaws.synthesis.method.on_points.flat import sharpened
from optlaws.synthesis.method.on_points.grids import exchanged, first_points
from optlaws.synthesis.method.on_points.ipopt import Answer, solve_on_points
from optlaws.synthesis.method.units import units_of
from optlaws.synthesis.method.vertices import by_vertices, many_pieces

Array = NDArray[np.float64]

_ROUNDS = 12
_LINEAR_ROUNDS = 6
_LARGE = 24
_CORRECTIONS = 8
_WEIGHTLESS = 1e-7
_LOST = 1e7
_SAME = 1e-6
_AMPLE = 1.2
_VANISHED = 1e-13


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
    rounds: int = _ROUNDS,
) -> Outcome:
    """Solve a semi-infinite program; a neighbour's optimum as `warm` is tried before IPOPT, which begins at `start`.

    `holds` may tell from x alone, and more quickly than the families do, whether every constraint holds.
    """
    units = units_of(program)
    if units is None:
        return _in_own_units(program, warm, start, holds, rounds)
    outcome = _in_own_units(
        units.program,
        None if warm is None else units.inward(warm),
        None if start is None else start / units.variables,
        None if holds is None else lambda x: holds(x * units.variables),
        rounds,
    )
    return outcome if outcome.optimum is None else replace(outcome, optimum=units.outward(outcome.optimum))


def _in_own_units(
    program: Program,
    warm: ActiveSet | None,
    start: Array | None,
    holds: Callable[[Array], bool] | None,
    rounds: int,
) -> Outcome:
    """The same for a program whose numbers are near 1."""
    if warm is not None:
        optimum = polished(program, warm, holds)
        if optimum is not None:
            return Outcome(optimum, 0, 0, "continued from a neighbour")
    kept = independent(program.equalities)
    if kept.all():
        return _solved(program, start, holds, rounds)
    if contradiction(program.equalities, program.right) is not None:
        return Outcome(None, 0, 0, "equations that contradict each other")
    fewer = replace(program, equalities=program.equalities[kept], right=program.right[kept])
    outcome = _solved(fewer, start, holds, rounds)
    if outcome.optimum is None:
        return outcome
    multipliers = np.zeros(len(kept))
    multipliers[kept] = outcome.optimum.equality_multipliers
    return replace(outcome, optimum=replace(outcome.optimum, equality_multipliers=multipliers))


def _solved(program: Program, start: Array | None, holds: Callable[[Array], bool] | None, rounds: int) -> Outcome:
    """The same for a program whose equations are independent."""
    points = first_points(program)
    if start is None and program.curved:
        vanishing = _vanishing(program)
        if vanishing is not None:
            return Outcome(vanishing, 0, 0, "nothing left")
        start = _lifted(program, points)
        guess = _norms_only(program, start)
        optimum = polished(program, guess, holds) if guess is not None else None
        if optimum is not None:
            return Outcome(optimum, 0, 0, "least squares")
    if many_pieces(program):
        optimum, count = by_vertices(program, points, partial(_finished, program, holds))
        if optimum is not None:
            return Outcome(optimum, 0, count, "vertices")
    return _exchange(program, points, start, holds, rounds)


def _finished(
    program: Program, holds: Callable[[Array], bool] | None, points: list[Points], answer: Answer
) -> ActiveSet | None:
    """The optimum of a linear program from an answer near to it; None where the contacts are not plain yet."""
    optimum = polished(program, _identified(program, points, answer), holds)
    sharp = _sharpened(program, points, answer) if optimum is None else None
    return sharp if sharp is not None and completed(program, sharp) is sharp else optimum


def _exchange(
    program: Program, points: list[Points], start: Array | None, holds: Callable[[Array], bool] | None, rounds: int
) -> Outcome:
    iterations = 0
    finished = partial(_finished, program, holds)
    exact = not program.curved or conic(program)
    rounds = rounds if program.curved else min(rounds, _LINEAR_ROUNDS)
    for attempt in range(1, rounds + 1):
        answer, spent = _answer(program, points, start, attempt)
        iterations += spent
        optimum = None if _lost(answer) else finished(points, answer)
        if optimum is not None:
            return Outcome(optimum, iterations, attempt, answer.status)
        # with many variables a round of IPOPT costs more than all vertices together
        large = not program.curved and program.size > _LARGE
        if exact and (large or _lost(answer) or attempt == rounds):
            optimum, count = by_vertices(program, points, finished)
            if optimum is not None:
                return Outcome(optimum, iterations, attempt + count, "vertices")
        if _lost(answer):
            return Outcome(None, iterations, attempt, answer.status)
        asked, x = points, answer.x
        points = [exchanged(family, mine, x) for family, mine in zip(program.families, points, strict=True)]
    optimum = as_answered(asked, answer) if not program.curved or _only_cones(program) else None
    return Outcome(optimum, iterations, rounds, answer.status)


def _lost(answer: Answer) -> bool:
    return not answer.usable or not np.isfinite(answer.x).all() or float(np.abs(answer.x).max()) > _LOST


def _answer(program: Program, points: list[Points], start: Array | None, attempt: int) -> tuple[Answer, int]:
    """IPOPT's answer, asked in other ways until one is usable, and the iterations that this took."""
    iterations = 0
    for way in _ways(program, attempt):
        answer = solve_on_points(program, points, start, **way)
        iterations += answer.iterations
        if answer.usable:
            break
    return answer, iterations


def _ways(program: Program, attempt: int) -> list[dict[str, bool]]:
    """How to ask IPOPT, until an answer is usable."""
    if program.curved:
        return [{"fine": True}, {}] if attempt > 1 and _only_cones(program) else [{}]
    return [{"fine": True}, {}] if attempt > 1 else [{}]


def polished(program: Program, start: ActiveSet, holds: Callable[[Array], bool] | None) -> ActiveSet | None:
    """Newton on a guess of the contacts, which is corrected a few times by what the answer says."""
    guess = start
    for _ in range(_CORRECTIONS):
        optimum = newton(program, guess)
        if optimum is None:
            optimum = newton(program, guess, deficient=True)
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


def _vanishing(program: Program) -> ActiveSet | None:
    """A law in which all amplitudes that are minimised vanish: many may have none, and then no contact shows one."""
    weighed = [one for one in program.families if (program.objective * one.slack).any()]
    cones = [one for one in weighed if isinstance(one, ConeFamily) and one.domain[0] == one.domain[1]]
    costs = np.flatnonzero(program.objective)
    if not cones or len(cones) < len(weighed) or any(not sum(one.slack[i] for one in cones) for i in costs):
        return None
    columns = [one.columns(np.array(one.domain[:1]))[0, 0] for one in cones]
    rows = np.vstack([np.array([one.real, one.imag]) for one in columns])
    held = np.concatenate([rows[:, :-1], program.equalities])
    right = np.concatenate([-rows[:, -1], program.right])
    # what is minimised is to be nothing
    held[:, costs] = 0.0
    x = np.linalg.lstsq(held, right, rcond=None)[0]
    if np.abs(held @ x - right).max() > _VANISHED or program.violation(x) > EXCESS:
        return None
    nothing, equations = np.empty(0), np.zeros(len(program.right))
    places = np.empty(0, dtype=np.intp)
    return ActiveSet(x, places, nothing, nothing, places.astype(np.bool_), nothing, equations)


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
        if isinstance(family, ConeFamily):
            needed = max(needed, 1.0)  # a cone's rows need room
        places = family.slack > 0.0
        x[places] = np.maximum(x[places], _AMPLE * needed / family.slack[places])
    return x


def _only_cones(program: Program) -> bool:
    """Whether cones alone are not affine: amplitudes may be so flat that no exact active set shows."""
    return all(isinstance(family, LinearFamily | ConeFamily) for family in program.families)


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
        _merge(family, u, s, gathered)
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


def _merge(family: Family, u: Array, s: Array, gathered: Array) -> None:
    """Give an end what belongs to an extremum that IPOPT's tolerance alone sets apart from it."""
    for end in np.flatnonzero(np.isin(u, family.domain)):
        same = (s == s[end]) & (np.abs(u - u[end]) < _SAME)
        total = gathered[same].sum()
        gathered[same] = 0.0
        gathered[end] = total


def _sharpened(program: Program, points: list[Points], answer: Answer) -> ActiveSet | None:
    """The optimum on the points; None where it is not convex there or the answer does not show it."""
    if not program.curved:
        return sharpened(program, points, answer)
    products = [isinstance(family, ProductFamily) for family in program.families]
    if any((w > _WEIGHTLESS).any() for w, one in zip(answer.multipliers, products, strict=False) if one):
        return None
    found = newton(program, as_answered(points, answer), deficient=True)
    return found if found is not None and (found.multipliers >= 0.0).all() else None


def as_answered(points: list[Points], answer: Answer) -> ActiveSet:
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
    length = np.linalg.norm(rows, axis=1)
    sizes = weights * length
    greatest = max(1.0, float(sizes.max(initial=0.0)))
    binding: NDArray[np.bool_] = (sizes * length > -residual * greatest) & (sizes > _WEIGHTLESS * greatest)
    return binding
