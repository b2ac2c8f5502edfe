"""Newton's method on the optimality conditions of the exact active set.

At the optimum a few contacts carry the whole program: points where a constraint binds, each at an extremum of its
residual. Unknown are the variables x, the free positions u and the multipliers. The system is square, so convergence
is quadratic, and fewer contacts than variables are no difficulty (the curvature of the contacts closes it).

What is near the optimum is rounded to few digits, and the last steps begin there: from whatever guess an optimum was
met, its last digit is the same.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace

import numpy as np

from optlaws.numbers import Array, power_of_two
from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.families.family import Program
from optlaws.tolerances import AT_END, DEPENDENT_ROWS, SAME_PLACE

_NEWTON_CONVERGED = 1e-13  # of a law: a step of Newton's method that is the last
_NEWTON_NEAR = 1e-7  # of a law: after a step that changes less a state is rounded
_NEWTON_SAME = 1e-5  # of a law: nearer than this a state and what it is led to after rounding are one optimum
_NEWTON_STALLED = 1e-10  # of a law: steps below it that shrink no more are rounding
_NEWTON_FULFILLED = 1e-9  # of a right side: by so much the equations of Newton's method may be missed
_NEWTON_STILL = 1e-6  # of a law: a step that is longer wanders

_STEPS = 14
_FAR = 1.05
_WILD = 1e6
#: of a state that is rounded, of 1 or of the greatest number
_DIGITS = 2.0**20


def newton(program: Program, start: ActiveSet, *, deficient: bool = False) -> ActiveSet | None:
    """Solve the optimality conditions from `start`; None where that does not converge.

    `deficient` says that they are known to have no unique solution.
    """
    if deficient:
        optimum = _iterated(program, start, deficient=True)
        # of a contact that is there twice the multipliers of both are open: it is one
        once = None if optimum is None else optimum.merged(SAME_PLACE)
        return optimum if once is None or once is optimum else newton(program, once) or optimum
    near = _iterated(program, start, enough=_NEWTON_NEAR)
    if near is None:
        return None
    optimum = _iterated(program, _rounded(program, near))
    if optimum is not None and _distance(near, optimum) <= _NEWTON_SAME:
        return optimum
    return _iterated(program, near)


def _iterated(program: Program, start: ActiveSet, *, enough: float = 0.0, deficient: bool = False) -> ActiveSet | None:
    """The end of Newton's method: its fixed point, or a state after which a step changes less than needed."""
    state = start
    previous = np.inf
    for _ in range(_STEPS):
        system, defect = _conditions(program, state)
        step = _step(system, defect, deficient=deficient)
        if not np.isfinite(step).all():
            return None
        before, state = state, _moved(state, step)
        scale = max(1.0, float(np.abs(state.x).max()))
        steps, defects = np.abs(step), np.abs(defect)
        if float(steps.max()) < enough * scale:
            return state
        size = float(steps[: program.size].max()) / scale
        # x may stand still where the conditions do not hold: in a deficient system, or where the optimum is flat
        off = max(float(defects[: program.size].max()), float(defects[program.size :].max(initial=0.0)) / scale)
        if off < _NEWTON_FULFILLED and (size < _NEWTON_CONVERGED or (size < _NEWTON_STALLED and size > previous / 4)):
            wandering = float(steps.max()) > _NEWTON_STILL
            if not wandering or off < _NEWTON_STALLED:
                return before if wandering else state
        if np.any(np.abs(state.u) > _FAR):
            return None
        previous = size
    return None


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


def _distance(first: ActiveSet, last: ActiveSet) -> float:
    """The distance of the variables of two optima, as a share of the greatest."""
    return float(np.abs(first.x - last.x).max() / max(1.0, np.abs(first.x).max()))


def _conditions(program: Program, state: ActiveSet) -> tuple[Array, Array]:
    """The optimality conditions' defect and its derivative."""
    n, p = program.size, len(state.u)
    value, slope, curvature = np.empty((3, p))
    rows, slopes = np.empty((2, p, n))
    free = state.free
    m = int(free.sum())
    last = n + m + p
    system = np.zeros((last + len(program.right),) * 2)
    for i in sorted(set(state.family.tolist())):
        contacts, family = state.family == i, program.families[i]
        u, s = state.u[contacts], state.s[contacts]
        jet = family.jet(state.x, u, s)
        value[contacts], slope[contacts], curvature[contacts] = jet.value, jet.slope, jet.curvature
        rows[contacts], slopes[contacts] = jet.gradient, jet.slope_gradient
        bent = family.hessian(state.x, u, state.multipliers[contacts] * s)
        if bent is not None:
            system[:n, :n] += bent

    turning, moved = slopes[free], np.arange(n, n + m)
    system[:n, n : n + m] = (turning * state.multipliers[free, None]).T
    system[:n, n + m : last] = rows.T
    system[:n, last:] = program.equalities.T
    system[last:, :n] = program.equalities
    system[n : n + m, :n] = turning
    system[moved, moved] = curvature[free]
    system[n + m : last, :n] = rows
    system[n + m + np.flatnonzero(free), moved] = slope[free]

    defect = np.empty(len(system))
    defect[:n] = program.objective + rows.T @ state.multipliers + program.equalities.T @ state.equality_multipliers
    defect[n : n + m] = slope[free]
    defect[n + m : last] = value
    defect[last:] = program.equalities @ state.x - program.right
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


def _moved(state: ActiveSet, step: Array) -> ActiveSet:
    n, p, m = len(state.x), len(state.u), int(state.free.sum())
    u = state.u.copy()
    u[state.free] += step[n : n + m]
    return replace(
        state,
        x=state.x + step[:n],
        u=u,
        multipliers=state.multipliers + step[n + m : n + m + p],
        equality_multipliers=state.equality_multipliers + step[n + m + p :],
    )
