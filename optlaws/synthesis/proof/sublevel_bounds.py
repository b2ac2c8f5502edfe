"""A priori bounds of laws whose objective is below a claim: of their constants, and of moments of derivatives.

A law that contradicts the claim has a small objective, so small constants, and they bound its coordinates.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import inf, isfinite

import numpy as np

from optlaws.numbers import Array
from optlaws.synthesis.families.names import VariableName
from optlaws.synthesis.problem.constants import Functional, PeakConstant, PowerConstant
from optlaws.synthesis.problem.expression import Expression, Maximum, Term, leaves
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.program.writer import Model, maxima, relaxed_power
from optlaws.synthesis.spaces.end_conditions import BoundaryConditions
from optlaws.synthesis.spaces.space import LawSpace
from optlaws.tolerances import VALUE_ROUNDING

_SUBLEVEL_RANK = 1e-15  # of the greatest singular value: less is rounding

_ACCELERATION = 2


def greatest_constants(model: Model, claim: float) -> dict[str, float]:
    """Upper bounds of the objective's constants, and of bounded ones, in laws below the claim."""
    problem = model.problem
    bounds: dict[str, float] = {}
    if VariableName.VIOLATION not in model.places:
        spread(problem.objective, claim, bounds, least_values(problem, model.space))
    for name in ("B", *(constant.name for constant, _ in problem.bounded)):
        limits = problem.range(name)
        if limits is not None:
            bounds[name] = min(bounds.get(name, inf), limits.high)
    return bounds


def greatest_values(model: Model, claim: float) -> dict[str, float]:
    """Greatest values of the program's variables in a law that contradicts the claim."""
    problem, space = model.problem, model.space
    bounds = greatest_constants(model, claim)
    if VariableName.VIOLATION in model.places:
        bounds[VariableName.VIOLATION] = 0.0
    power = relaxed_power(problem)
    if power is not None and power.name in bounds:
        bounds[VariableName.POWER_ROOT] = bounds[power.name] ** 0.5
    if "B" in model.places and not isfinite(bounds["B"]):
        # b is nowhere further from its mean, the stroke, than the integral of |c|
        bounds["B"] = abs(space.stroke) + _mean_of_acceleration(problem, space, bounds)
    return bounds


def _mean_of_acceleration(problem: Problem, space: LawSpace, greatest: Mapping[str, float]) -> float:
    """A bound of the integral of |c|: c differs from its mean by at most the integral of |j|."""
    known = dict(means(problem, space, greatest))
    if problem.conditions.order == 1:
        return known.get(2, inf)
    return min(known.get(2, inf), abs(space.velocity_change) + known.get(3, inf))


def moments(model: Model, greatest: Mapping[str, float]) -> list[tuple[Array, Array]]:
    """Bounds of the moments of a derivative relative to the base law's, one for each known constant.

    Beside each the matrix from a functional's values on the free functions to weights of these moments.
    """
    space = model.space
    return [
        (mean + _base_moments(space, nu), _extension(space, nu)) for nu, mean in means(model.problem, space, greatest)
    ]


def means_by(model: Model, name: str) -> list[tuple[Array, Array, float]]:
    """Bounds of means of derivatives as affine functions of a constant's variable.

    For each derivative whose mean the constant bounds in proportion: bounds of its moments where the constant is 0,
    but for the base law, the matrix of `moments`, and by how much the bounds grow with the variable.
    """
    scale, space = model.scales.get(name, 1.0), model.space
    none, some, more = (dict(means(model.problem, space, {name: size})) for size in (0.0, scale, 2.0 * scale))
    bounds = []
    for nu in none.keys() & some.keys() & more.keys():
        growth = some[nu] - none[nu]
        if abs(more[nu] - some[nu] - growth) <= VALUE_ROUNDING * abs(more[nu]):
            bounds.append((none[nu] + _base_moments(space, nu), _extension(space, nu), growth))
    return bounds


def _from_one_sign(problem: Problem, space: LawSpace, greatest: Mapping[str, float]) -> tuple[float, float]:
    """Bounds of the integral of |c| from the peaks of one sign: what is above 0 less what is below is b(1) - b(0)."""
    if problem.conditions.order == 1:
        return (max(greatest.get("C_plus", inf), greatest.get("C_minus", inf)),) * 2
    drop = abs(space.velocity_change)
    return 2.0 * greatest.get("C_plus", inf) + drop, 2.0 * greatest.get("C_minus", inf) + drop


def spread(expression: Expression, claim: float, bounds: dict[str, float], least: Mapping[str, float]) -> None:
    """Record in `bounds` the upper bounds of an expression's constants, from its value below the claim."""
    for weight, term in expression.terms:
        name = repr(term)
        others = sum(share * least[repr(other)] for share, other in expression.terms if other is not term)
        most = (claim - others) / weight
        bounds[name] = min(bounds.get(name, inf), most)
        if isinstance(term, Maximum):
            for part in term.parts:
                spread(part, most, bounds, least)


def least_values(problem: Problem, space: LawSpace) -> dict[str, float]:
    """Lower bounds of the objective's constants and maxima: 0, except for one-sided peaks.

    The mean of c is the change of the velocity, which c exceeds somewhere, and is below somewhere; where the order
    leaves it free, what is positive at a change of either sign is at least 0.
    """
    terms = [*(leaf for _, leaf in leaves(problem.objective)), *maxima(problem.objective)]
    if problem.symmetric or problem.order > 1:
        change = 0.0 if problem.symmetric else space.velocity_change
        return {repr(term): _at_least(term, change, space.boundary) for term in terms}
    lows = {repr(term): min(_at_least(term, change, space.boundary) for change in (1.0, -1.0)) for term in terms}
    return {name: 0.0 if low >= 0.0 else -inf for name, low in lows.items()}


def _at_least(term: Term, change: float, ends: BoundaryConditions) -> float:
    """A lower bound of a term in laws whose velocity changes by `change`."""
    if isinstance(term, Maximum):
        sums = (sum(weight * _at_least(inner, change, ends) for weight, inner in part.terms) for part in term.parts)
        return max(sums)
    if not isinstance(term, PeakConstant) or len(term.signs) != 1:
        return term.floor(ends) if isinstance(term, Functional) else 0.0
    return term.signs[0] * change if term.nu == _ACCELERATION else -inf


def means(problem: Problem, space: LawSpace, greatest: Mapping[str, float]) -> list[tuple[int, float]]:
    """Orders of derivatives whose mean magnitude is bounded, with the bound."""
    known = [(2, greatest.get("C", inf)), (2, greatest.get("rms_c", inf)), (3, greatest.get("J", inf))]
    known += [(2, mean) for mean in _from_one_sign(problem, space, greatest)]
    known += [(3, greatest.get("rms_j", inf)), (4, greatest.get("snap", inf))]
    stroke = abs(space.stroke)
    if "D" in greatest and problem.order > 1 and space.start_velocity == 0.0:
        # b² <= 2 D k from rest
        known += [(1, greatest["D"] ** 0.5)]
    known += [(1, 2.0 * greatest.get("B", inf) + stroke)]
    if problem.monotone:
        known += [(1, stroke)]
    for constant in problem.constants:
        size = greatest.get(constant.name, inf)
        # a peak of one side may be below 0: then nothing is above
        root = size**0.5 if isinstance(constant, PowerConstant) else max(size, 0.0)
        known += [(nu, factor * root + offset) for nu, factor, offset in constant.sizes(space)]
    least: dict[int, float] = {}
    for nu, mean in known:
        if isfinite(mean):
            least[nu] = min(least.get(nu, inf), mean)
    return list(least.items())


def _base_moments(space: LawSpace, nu: int) -> Array:
    """Magnitudes of the base law's moments, to which the coordinates' moments are added."""

    def computed() -> Array:
        rule = space.quadrature(nu)
        return np.asarray(np.abs(rule.moments.T @ (rule.weights * rule.values[:, -1])), dtype=np.float64)

    return space.cached(("moments", nu), computed)


def _extension(space: LawSpace, nu: int) -> Array:
    """Matrix from a functional's values on the free functions to weights of moments of the derivative of order nu.

    A moment is the integral of the derivative times a function that is nowhere above 1 in magnitude, so at most its
    mean magnitude; for polynomials these are Legendre's.
    """

    def computed() -> Array:
        rule = space.quadrature(nu)
        moments = rule.moments.T @ (rule.weights[:, None] * rule.values[:, :-1])
        functions, sizes, weights = np.linalg.svd(moments.T, full_matrices=False)
        # what has no such derivative would be told from it by rounding alone
        sizes = sizes[: max(len(moments.T) - space.vanishing(nu), 0)]
        sizes = sizes[sizes > _SUBLEVEL_RANK * sizes.max(initial=0.0)]
        return np.asarray(weights[: len(sizes)].T @ (functions[:, : len(sizes)] / sizes).T, dtype=np.float64)

    return space.cached(("extension", nu), computed)
