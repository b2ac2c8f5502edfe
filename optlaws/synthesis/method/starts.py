"""Starts for problems that are not convex, and laws of problems with hardly any interior.

Starts are a few laws, the same at every run. Where a constant is bounded by its own least value, or nearly, the little
by which a solver breaks a bound grows to its square root in the objective, and the law looks better than any law is.
With the bounds loosened there is room; on the way from the optimum then to the law with most room there is one that
satisfies every given bound, and is hardly worse.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from math import inf, isfinite
from typing import TYPE_CHECKING

import numpy as np

from optlaws.numbers import Array
from optlaws.numerics.roots import bisect
from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.families.family import NormFamily, Program
from optlaws.synthesis.functionals.formula_rows import columns_of
from optlaws.synthesis.method.exchange import Method, solve
from optlaws.synthesis.problem.constants import PowerConstant
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.program.writer import Model, evaluate, least_violation, model_of

if TYPE_CHECKING:
    from optlaws.synthesis.limits.drive_limits import DriveLimit

_AMPLE = 1.2


def points(model: Model, method: Method = "auto") -> Iterator[Array]:
    """Coordinates of the laws of least RMS of c and of least C; D follows from the law."""
    problem = model.problem
    bounds = {name: limits for name, limits in problem.bounds.items() if name.convex}
    for constant in ("rms_c", "C"):
        smooth = model_of(replace(problem, minimise=constant, D=None, bounds=bounds))
        optimum = solve(smooth.program, method=method).optimum
        if optimum is not None:
            yield _completed(model, model.coordinates(optimum.x))


def in_phase_plane(model: Model, limit: DriveLimit) -> Array:
    """The variables of the law whose velocity is nearest to the motion that is a drive's limit."""
    # it takes as long to import as all of optlaws that a law needs
    from scipy.linalg import null_space

    k, a, b = limit.motion()
    space = model.space
    share = np.sqrt(np.gradient(k))[:, None]
    rows = np.vstack([share * columns_of(space, 1, k), share * columns_of(space, 0, k)])
    right = np.concatenate([share[:, 0] * b, share[:, 0] * a]) - rows[:, -1]
    equations = space.equations()
    fixed = np.array([equation.row for equation in equations]).reshape(-1, space.terms)
    to = np.array([equation.right for equation in equations])
    least = np.linalg.lstsq(fixed, to, rcond=None)[0]
    free = null_space(fixed) if len(fixed) else np.eye(space.terms)
    moved = np.linalg.lstsq(rows[:, :-1] @ free, right - rows[:, :-1] @ least, rcond=None)[0]
    return _completed(model, least + free @ moved)


def _completed(model: Model, coordinates: Array) -> Array:
    """The start completed with values of the variables beyond the coordinates that leave slack."""
    x = np.zeros(model.program.size)
    x[: model.space.terms] = coordinates
    law = model.space.law(coordinates)
    constants = {
        constant.name: constant
        for constant in model.problem.constants
        if not (constant.convex or isinstance(constant, PowerConstant))
    }
    for name, place in model.places.items():
        value = constants[name].value(law) if name in constants else inf
        if isfinite(value):
            x[place] = _AMPLE * value / model.scales.get(name, 1.0)
        else:
            x[place] = law.peak(1).value if name == "B" else 2.0 * law.power_peak().value
    return x


_LEAST_INTERIOR = 1e-11  # the most by which the law with most room may break a bound
_EQUATIONS_RANK = 1e-12  # of a law: by so much it may miss equations that are met

#: the shares by which bounds are loosened, one after the other; a norm's optimum moves with the square root
_LOOSENED = (1e-8, 1e-10, 1e-12)
_CLOSER = 0.1
_HALVINGS = 50


def fallbacks_without_interior(model: Model) -> Iterator[tuple[ActiveSet, Array]]:
    """Optima with the bounds loosened less and less, whose contacts prove, each with a law that keeps the bounds.

    None where the constraints contradict each other, or where they are not convex.
    """
    problem = model.problem
    bounded = [limits for _, limits in problem.bounded if isfinite(limits.high)]
    if not bounded or not all(constant.convex for constant, _ in problem.bounded):
        return

    def excess(coordinates: Array) -> float:
        return evaluate(problem, model.space.law(coordinates)).excess

    elastic = least_violation(problem)
    anchor = solve(elastic.program).optimum
    if anchor is None:
        return
    roomy = model.coordinates(on_equations(elastic.program, anchor.x))
    if excess(roomy) > _LEAST_INTERIOR:
        return
    state: ActiveSet | None = None
    for share in _LOOSENED:
        program = model_of(_loosened(problem, share)).program
        state = solve(program, None if state is None else _closer(program, state, roomy)).optimum
        if state is not None:
            near = model.coordinates(on_equations(model.program, state.x))
            yield state, _inward(near, roomy, excess)


def _loosened(problem: Problem, share: float) -> Problem:
    bounds = {constant: replace(limits, high=limits.high * (1.0 + share)) for constant, limits in problem.bounded}
    return replace(problem, C=None, D=None, J=None, bounds=bounds)


def _closer(program: Program, state: ActiveSet, roomy: Array) -> ActiveSet:
    """A guess of the optimum at a hundredth of the slack, with a tenth of a norm's distance and ten times its price."""
    x = state.x.copy()
    x[: len(roomy)] = roomy + _CLOSER * (x[: len(roomy)] - roomy)
    norms = [isinstance(family, NormFamily) and not family.slack.any() for family in program.families]
    bounding = np.array([norms[i] for i in state.family], dtype=np.bool_)
    return replace(state, x=x, multipliers=np.where(bounding, state.multipliers / _CLOSER, state.multipliers))


def on_equations(program: Program, x: Array) -> Array:
    """The nearest x that keeps the equations to rounding; x itself if it does."""
    off = program.right - program.equalities @ x
    # each by what its own sum is made of: the objective's variables may be great
    if (np.abs(off) <= _EQUATIONS_RANK * np.maximum(1.0, np.abs(program.equalities) @ np.abs(x))).all():
        return x
    return np.asarray(x + np.linalg.lstsq(program.equalities, off, rcond=_EQUATIONS_RANK)[0])


def _inward(near: Array, roomy: Array, excess: Callable[[Array], float]) -> Array:
    """The nearest to `near`, on the way to `roomy`, that breaks no bound by more than `roomy` does."""
    allowed = excess(roomy)
    share, _ = bisect(lambda share: excess(roomy + share * (near - roomy)) <= allowed, 0.0, 1.0, _HALVINGS)
    return np.asarray(roomy + share * (near - roomy))
