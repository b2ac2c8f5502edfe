"""Newton's method on the optimality conditions of the exact active set, which an answer on points shows.

At the optimum a few contacts carry the whole program: points where a constraint binds, each at an extremum of its
residual. Unknown are the variables x, the free positions u and the multipliers. The system is square, so convergence
is quadratic, and fewer contacts than variables are no difficulty (the curvature of the contacts closes it).

What is near the optimum is rounded to few digits, and the last steps begin there: from whatever guess an optimum was
met, its last digit is the same.

Of an integral with kinks the places of these are unknowns too, each a root of the formula that changes its sign there:
as a function of the law alone the integral bends without bound where two kinks are about to vanish, as a function of
both it is smooth there.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from optlaws.formulas.tree import Formula
from optlaws.numbers import Array, power_of_two
from optlaws.synthesis.families.active_set import ActiveSet, Contact
from optlaws.synthesis.families.family import Points, Program
from optlaws.synthesis.families.kinked import AtKinks, FreeKinks, KinkedIntegralFamily, SmoothStretch
from optlaws.synthesis.method.discretised.on_points import Answer
from optlaws.tolerances import AT_END, BARRIER, DEPENDENT_ROWS, EXCESS, SAME_PLACE

_NEWTON_CONVERGED = 1e-13  # of a law: a step of Newton's method that is the last
_NEWTON_NEAR = 1e-7  # of a law: after a step that changes less a state is rounded
_NEWTON_SAME = 1e-5  # of a law: nearer than this a state and what it is led to after rounding are one optimum
_NEWTON_STALLED = 1e-10  # of a law: steps below it that shrink no more are rounding
_NEWTON_FULFILLED = 1e-9  # of a right side: by so much the equations of Newton's method may be missed
_NEWTON_STILL = 1e-6  # of a law: a step that is longer wanders

_STEPS = 14
_STEPS_WITH_KINKS = 40
#: of a stretch between two kinks, what a step leaves of it
_STRETCH_LEFT = 0.2
_FAR = 1.05
_WILD = 1e6
#: of a state that is rounded, of 1 or of the greatest number
_DIGITS = 2.0**20


@dataclass(frozen=True, eq=False)
class _Kinked:
    """An integral with kinks that binds, over stretches whose ends Newton's method moves."""

    family: KinkedIntegralFamily
    stretches: list[SmoothStretch]
    switches: list[Formula]  #: each 0 at its kink

    @property
    def kinks(self) -> Array:
        return self.family.kinks_of(self.stretches)

    @property
    def lengths(self) -> Array:
        return np.array([stretch.high - stretch.low for stretch in self.stretches])

    def at(self, x: Array) -> FreeKinks:
        return self.family.free_kinks(x, self.stretches)

    def switches_at(self, x: Array) -> AtKinks:
        return self.family.at_kinks(x, self.stretches, self.switches)

    def moved(self, step: Array) -> _Kinked:
        kinks = self.kinks + step
        # one that comes to an end of all stretches has vanished there
        pairs = zip(self.switches, kinks.tolist(), strict=True)
        left = [switch for switch, k in pairs if self.family.movable_kink(k)]
        return replace(self, stretches=self.family.with_kinks(self.stretches, kinks), switches=left)


#: the integrals with kinks that bind, by the numbers of their families
_Integrals = dict[int, _Kinked]


def newton(program: Program, start: ActiveSet, *, deficient: bool = False) -> ActiveSet | None:
    """Solve the optimality conditions from `start`; None where that does not converge.

    `deficient` says that they are known to have no unique solution.
    """
    if deficient:
        optimum, _ = _iterated(program, start, {}, deficient=True)
        # of a contact that is there twice the multipliers of both are open: it is one
        once = None if optimum is None else optimum.merged(SAME_PLACE)
        return optimum if once is None or once is optimum else newton(program, once) or optimum
    integrals = _integrals(program, start)
    near, integrals = _iterated(program, start, integrals, enough=_NEWTON_NEAR)
    if near is None:
        return None
    optimum, _ = _iterated(program, _rounded(program, near), integrals)
    if optimum is None or np.abs(near.x - optimum.x).max() > _NEWTON_SAME * max(1.0, np.abs(near.x).max()):
        optimum, _ = _iterated(program, near, integrals)
    return optimum


def _integrals(program: Program, state: ActiveSet) -> _Integrals:
    """The integrals with kinks that bind at a law, over its stretches."""
    families = [(i, program.families[i]) for i in sorted(set(state.family.tolist()))]
    kinked = [(i, family) for i, family in families if isinstance(family, KinkedIntegralFamily)]
    split = [(i, family, family.split(state.x).stretches) for i, family in kinked]
    return {i: _Kinked(family, stretches, family.switches_of(state.x, stretches)) for i, family, stretches in split}


def _iterated(
    program: Program,
    start: ActiveSet,
    integrals: _Integrals,
    *,
    enough: float = 0.0,
    deficient: bool = False,
) -> tuple[ActiveSet | None, _Integrals]:
    """The end of Newton's method, its fixed point or a state after which a step changes less than needed; the kinks."""
    conditions = _Conditions(program, start)
    y = conditions.unknowns(start)
    size, previous = program.size, np.inf
    for _ in range(_STEPS_WITH_KINKS if integrals else _STEPS):
        system, defect = conditions.at(y, integrals)
        step = _step(system, defect, deficient=deficient)
        if not np.isfinite(step).all():
            return None, integrals
        share, integrals = _with_moved_kinks(integrals, step) if integrals else (1.0, integrals)
        before, y = y, y + share * step[: len(y)]
        scale = max(1.0, float(np.abs(y[:size]).max()))
        steps, defects = np.abs(step), np.abs(defect)
        longest, moved = float(steps.max()), float(steps[:size].max()) / scale
        if longest < enough * scale:
            return conditions.state(y), integrals
        # x may stand still where the conditions do not hold: in a deficient system, or where the optimum is flat
        off = max(float(defects[:size].max()), float(defects[size:].max(initial=0.0)) / scale)
        if off < _NEWTON_FULFILLED and (
            moved < _NEWTON_CONVERGED or (moved < _NEWTON_STALLED and moved > previous / 4)
        ):
            wandering = longest > _NEWTON_STILL
            if not wandering or off < _NEWTON_STALLED:
                return conditions.state(before if wandering else y), integrals
        if conditions.far(y):
            return None, integrals
        previous = moved
    return None, integrals


def _with_moved_kinks(integrals: _Integrals, step: Array) -> tuple[float, _Integrals]:
    """The kinks after a share of a step, such that none comes too near to another, and that share."""
    counts = [len(integral.kinks) for integral in integrals.values()]
    parts = np.split(step[len(step) - sum(counts) :], np.cumsum(counts)[:-1])
    share = 1.0
    for integral, part in zip(integrals.values(), parts, strict=False):
        room = (1.0 - _STRETCH_LEFT) * integral.lengths
        shorter = integral.lengths - integral.moved(part).lengths
        much = shorter > np.maximum(room, 0.0)
        share = min([share, *(room[much] / shorter[much]).tolist()])
    return share, {
        i: integral.moved(share * part) for (i, integral), part in zip(integrals.items(), parts, strict=False)
    }


def _rounded(program: Program, state: ActiveSet) -> ActiveSet:
    """The state with few digits of all that Newton's method moves, its contacts in order, each once and at rest.

    A contact that may move, but came to an end, stays there.
    """
    state = state.merged(SAME_PLACE)
    order = np.lexsort((state.s, state.u, state.family))
    u, family, free = state.u[order], state.family[order], state.free[order]
    for end in np.array([program.families[i].domain for i in family]).reshape(-1, 2).T:
        at_end = free & (np.abs(u - end) < AT_END)
        u, free = np.where(at_end, end, u), free & ~at_end
    multipliers = _with_few_digits(np.concatenate([state.multipliers[order], state.equality_multipliers]))
    return ActiveSet(
        x=_with_few_digits(state.x),
        family=family,
        u=np.where(free, np.round(u * _DIGITS) / _DIGITS, u),
        s=state.s[order],
        free=free,
        multipliers=multipliers[: len(u)],
        equality_multipliers=multipliers[len(u) :],
    )


def _with_few_digits(numbers: Array) -> Array:
    grid = _DIGITS / power_of_two(float(np.abs(numbers).max(initial=1.0)))
    return np.asarray(np.round(numbers * grid) / grid)


class _Conditions:
    """The optimality conditions of contacts in the variables, the places that move, and the multipliers, in turn."""

    def __init__(self, program: Program, contacts: ActiveSet) -> None:
        self.program, self.contacts = program, contacts
        self.free = np.flatnonzero(contacts.free)
        self.families = [(i, np.flatnonzero(contacts.family == i)) for i in sorted(set(contacts.family.tolist()))]
        n = program.size
        self.places = slice(n, n + len(self.free))
        self.rows = slice(self.places.stop, self.places.stop + len(contacts.u))
        self.equations = slice(self.rows.stop, self.rows.stop + len(program.right))

    def unknowns(self, state: ActiveSet) -> Array:
        """All that Newton's method moves but kinks."""
        return np.concatenate([state.x, state.u[self.free], state.multipliers, state.equality_multipliers])

    def state(self, y: Array) -> ActiveSet:
        """The contacts with these unknowns."""
        u = self.contacts.u.copy()
        u[self.free] = y[self.places]
        return replace(
            self.contacts,
            x=y[: self.places.start],
            u=u,
            multipliers=y[self.rows],
            equality_multipliers=y[self.equations],
        )

    def far(self, y: Array) -> bool:
        """Whether a place has left the interval."""
        return bool(np.any(np.abs(y[self.places]) > _FAR))

    def at(self, y: Array, integrals: _Integrals) -> tuple[Array, Array]:
        """Their defect and its derivative; those of kinks come last."""
        program, free, places, equations = self.program, self.free, self.places, self.equations
        n, p = program.size, len(self.contacts.u)
        x, multipliers = y[:n], y[self.rows]
        u = self.contacts.u.copy()
        u[free] = y[places]
        value, slope, curvature = np.empty((3, p))
        rows, slopes = np.empty((2, p, n))
        begin = equations.stop
        system = np.zeros((begin + sum(len(integral.kinks) for integral in integrals.values()),) * 2)
        defect = np.empty(len(system))
        for i, contacts in self.families:
            family, s = program.families[i], self.contacts.s[contacts]
            weights = multipliers[contacts] * s
            if i in integrals:
                integral = integrals[i].at(x)
                value[contacts] = s * integral.value - family.right_side(x)
                rows[contacts] = s[:, None] * integral.slope - family.slack
                slope[contacts] = curvature[contacts] = slopes[contacts] = 0.0
                system[:n, :n] += weights.sum() * integral.bend
                here = slice(begin, begin + len(integral.rise))
                system[:n, here] = weights.sum() * integral.share * integral.across.T
                system[self.rows.start + contacts, here] = s[:, None] * integral.share * integral.rise
                switches = integrals[i].switches_at(x)
                system[here, :n], system[here, here] = switches.across, np.diag(switches.along)
                defect[here] = switches.value
                begin = here.stop
                continue
            jet = family.jet(x, u[contacts], s)
            value[contacts], slope[contacts], curvature[contacts] = jet.value, jet.slope, jet.curvature
            rows[contacts], slopes[contacts] = jet.gradient, jet.slope_gradient
            bent = family.hessian(x, u[contacts], weights)
            if bent is not None:
                system[:n, :n] += bent

        turning, moved = slopes[free], np.arange(places.start, places.stop)
        system[:n, places] = (turning * multipliers[free, None]).T
        system[:n, self.rows] = rows.T
        system[:n, equations] = program.equalities.T
        system[equations, :n] = program.equalities
        system[places, :n] = turning
        system[moved, moved] = curvature[free]
        system[self.rows, :n] = rows
        system[self.rows.start + free, moved] = slope[free]

        defect[:n] = program.objective + rows.T @ multipliers + program.equalities.T @ y[equations]
        defect[places] = slope[free]
        defect[self.rows] = value
        defect[equations] = program.equalities @ x - program.right
        return system, defect


def _step(system: Array, defect: Array, *, deficient: bool) -> Array:
    """Newton's step; where the system has not full rank, the shortest of the best steps."""
    if not deficient:
        with suppress(np.linalg.LinAlgError):
            step: Array = np.linalg.solve(system, -defect).astype(np.float64, copy=False)
            if np.abs(step).max(initial=0.0) < _WILD:
                return step
    # where the optimum is not unique the shortest step leads to one of them
    return np.linalg.lstsq(system, -defect, rcond=DEPENDENT_ROWS)[0].astype(np.float64, copy=False)


_PULLING = 1e-10  # of the greatest multiplier: one that is more negative pulls, and its contact is dropped

_CORRECTIONS = 8


def polished(program: Program, guess: ActiveSet, holds: Callable[[Array], bool] | None) -> ActiveSet | None:
    """The optimum that a guess of its contacts leads to; None where Newton's method does not find it.

    `holds` checks from x alone, faster than the families do, whether every constraint holds.
    """
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


def settled(program: Program, state: ActiveSet) -> ActiveSet:
    """Drop the contact that pulls most, or put contacts that left the interval on its end; the same object if none."""
    as_equation = np.array([program.families[i].as_equation for i in state.family], dtype=np.bool_)
    pushing = np.where(as_equation, 0.0, state.multipliers)
    if np.any(pushing < -_PULLING * np.abs(state.multipliers).max(initial=0.0)):
        return state.only(np.arange(len(state.u)) != np.argmin(pushing))
    low, high = np.array([program.families[i].domain for i in state.family]).reshape(-1, 2).T
    outside = (state.u < low) | (state.u > high)
    if outside.any():
        return replace(state, u=np.clip(state.u, low, high), free=state.free & ~outside)
    return state


def completed(program: Program, state: ActiveSet) -> ActiveSet:
    """Add the extrema that stick out by more than EXCESS of the right side; the same object if none does."""
    better = state
    for i, family in enumerate(program.families):
        if family.as_equation:
            continue
        u, s, residual = family.extremes(state.x)
        for j in np.flatnonzero(residual > EXCESS * max(1.0, abs(family.right_side(state.x)))):
            alike = (better.family == i) & (better.s == s[j])
            if np.any(alike & (np.abs(better.u - u[j]) < SAME_PLACE)):
                continue
            free = bool(family.movable(u[j : j + 1])[0])
            better = better.joined(i, float(u[j]), float(s[j]), free=free)
    return better


_SAME_HEIGHT = 1e-9  # what an extremum's residual may be below that of a point on its hill: rounding of a series


def as_answered(points: list[Points], answer: Answer) -> ActiveSet:
    """The answer's own contacts, for optima that are flat somewhere, where no exact active set exists."""
    *weights, equations = answer.multipliers
    active = [np.flatnonzero(w > answer.weightless * w.max(initial=0.0)) for w in weights]
    return ActiveSet(
        x=answer.x,
        family=np.repeat(np.arange(len(active), dtype=np.intp), [len(rows) for rows in active]),
        u=np.concatenate([grid.u[rows] for grid, rows in zip(points, active, strict=True)]),
        s=np.concatenate([grid.s[rows] for grid, rows in zip(points, active, strict=True)]),
        free=np.zeros(sum(map(len, active)), dtype=np.bool_),
        multipliers=np.concatenate([w[rows] for w, rows in zip(weights, active, strict=True)]),
        equality_multipliers=equations,
    )


def identified(program: Program, points: list[Points], answer: Answer) -> ActiveSet:
    """The contacts near an answer: each point's multiplier is given to the extremum that its hill leads to."""
    contacts: list[Contact] = []
    for i, (family, grid) in enumerate(zip(program.families, points, strict=True)):
        jet = family.jet(answer.x, grid.u, grid.s)
        binding = _binding(jet.gradient, answer.multipliers[i], jet.value)
        if not binding.any():
            continue
        u, s, residual = family.extremes(answer.x)
        higher = (s == grid.s[binding, None]) & (residual >= jet.value[binding, None] - _SAME_HEIGHT)
        distance = np.where(higher, np.abs(u - grid.u[binding, None]), np.inf)
        weights = answer.multipliers[i][binding]
        gathered = np.bincount(distance.argmin(axis=1), weights, len(u)).astype(np.float64)
        movable = family.movable(u)
        contacts += [(i, u[j], s[j], movable[j], gathered[j]) for j in np.flatnonzero(gathered)]
    return ActiveSet.of_contacts(answer.x, contacts, answer.multipliers[-1])


def _binding(rows: Array, weights: Array, residual: Array) -> NDArray[np.bool_]:
    # complementarity, in units in which each row has length 1: a contact's multiplier exceeds its distance
    length = np.linalg.norm(rows, axis=1)
    sizes = weights * length
    greatest = max(1.0, float(sizes.max(initial=0.0)))
    binding: NDArray[np.bool_] = (sizes * length > -residual * greatest) & (sizes > BARRIER * greatest)
    return binding
