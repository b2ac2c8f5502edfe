"""A symmetric optimum for the unsymmetric problem, if the mean of a law and its mirror image is no worse."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from optlaws.laws import MotionLaw
from optlaws.numbers import Array
from optlaws.numerics.chebyshev import nodes
from optlaws.synthesis.families.active_set import ActiveSet, Contact
from optlaws.synthesis.families.family import ConstraintFamily, Program
from optlaws.synthesis.families.names import RowName
from optlaws.synthesis.problem.constants import PeakConstant
from optlaws.synthesis.program.writer import Model


def unfolded(model: Model, half: Model, optimum: ActiveSet) -> ActiveSet:
    """The optimum of symmetric laws as a point of the program of all laws, with matching multipliers.

    Each contact is there twice, at k and at 1 - k, with half its multiplier. The equations' multipliers are those that
    leave least of the sum of rows; what the whole proves is for a certificate to say.
    """
    names = {family.name: i for i, family in enumerate(model.program.families)}
    odd = {peak.name for peak in model.problem.constants if isinstance(peak, PeakConstant) and peak.nu % 2 == 0}
    contacts: list[Contact] = []
    for i, family in enumerate(half.program.families):
        if family.name in names:
            target, sign = names[family.name], -1.0 if family.name in odd else 1.0
            for j in np.flatnonzero(optimum.family == i):
                row = (float(optimum.u[j]), float(optimum.s[j]), False, float(optimum.multipliers[j]))
                contacts += _both(model.program.families[target], family, (target, *row), sign)
    return _with_equations(model.program, _unfolded_point(model, half, optimum.x), contacts)


def coordinates(model: Model, law: MotionLaw) -> Array:
    """The coordinates of a law of the space, from its velocity at places that determine it."""
    family = model.space.derivative(1, RowName.VELOCITY, np.zeros(model.program.size))
    u = family.nodes()
    if u is None:
        u = nodes(2 * model.space.terms + 16)
    columns = family.columns(u)[0]
    velocities = np.array([float(law.b(k)) for k in np.clip(family.k(u), 0.0, 1.0).tolist()]) - columns[:, -1]
    solution = np.linalg.lstsq(columns[:, : model.space.terms], velocities, rcond=None)[0]
    return np.asarray(solution, dtype=np.float64)


def _unfolded_point(model: Model, half: Model, x: Array) -> Array:
    point = np.zeros(model.program.size)
    law = half.law(x)
    point[: model.space.terms] = coordinates(model, law)
    for name, place in model.places.items():
        # where B is given it is a variable of unsymmetric laws alone
        point[place] = x[half.places[name]] if name in half.places else law.peak(1).value
    return point


def _both(family: ConstraintFamily, half: ConstraintFamily, contact: Contact, sign: float) -> list[Contact]:
    target, u, s, free, multiplier = contact
    if family.domain[0] == family.domain[1]:
        return [(target, family.domain[0], s, free, multiplier)]
    k = half.k(np.array([u]))
    here, there = (float(np.clip(family.u(place), *family.domain)[0]) for place in (k, 1.0 - k))
    return [(target, here, s, free, multiplier / 2.0), (target, there, s * sign, free, multiplier / 2.0)]


def _with_equations(program: Program, x: Array, contacts: list[Contact]) -> ActiveSet:
    state = ActiveSet.of_contacts(x, contacts, np.empty(0))
    slope = program.objective.copy()
    for i, rows in enumerate(program.families):
        here = state.family == i
        if here.any():
            slope += state.multipliers[here] @ rows.jet(x, state.u[here], state.s[here]).gradient
    weights = np.linalg.lstsq(program.equalities.T, -slope, rcond=None)[0] if len(program.right) else np.empty(0)
    return replace(state, equality_multipliers=np.asarray(weights, dtype=np.float64))
