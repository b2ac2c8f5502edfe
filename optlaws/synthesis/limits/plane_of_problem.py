"""The phase plane of a problem: the torque of its objective within its bounds, and within what its jerk implies."""

from __future__ import annotations

from dataclasses import replace
from math import inf
from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np

from optlaws.errors import InputError
from optlaws.formulas.slopes import constant
from optlaws.formulas.tree import Call, Exponentiation, Formula, Number, Product, Sum, product
from optlaws.synthesis.functionals.kinds import FormulaIntegral, FormulaPeak, FormulaRms, OfFormula
from optlaws.synthesis.limits.phase_plane import (
    ACCELERATION,
    AnyTorque,
    PhasePlane,
    PhaseTorque,
    TorqueLimit,
    greater_power,
    torque_of,
)

if TYPE_CHECKING:
    from optlaws.synthesis.problem.problem import Problem

#: what a drive is to take as little of
DriveObjective: TypeAlias = Literal["peak torque", "rms torque", "energy", "time"]

#: from which acceleration to which bounds are taken that the jerk implies, and how many: of fewer and weaker ones less
#: is proven, but more often
_TANGENTS = ((1.2, 12.0, 5), (1.6, 14.0, 4))
_SMOOTH, _ABOVE = 3, 1e-14  # the least order of laws that begin without acceleration, and what rounding may add


def within_jerk(plane: PhasePlane, problem: Problem) -> list[PhasePlane]:
    """Planes with bounds of the acceleration by the velocity, which the jerk J implies of laws from order 3 on.

    Such a law has no acceleration at its ends. While c > 0, c² has risen by no more than 2 J b since c was 0, and while
    c < 0 it still has to fall by as much: |c| <= (2 J b)^(1/2), below its tangents t/2 + J b/t, one for each c = t.
    """
    jerk = problem.range("J")
    if jerk is None or not 0.0 < jerk.high < inf or problem.order < _SMOOTH:
        return []
    return [
        replace(plane, limits=(*plane.limits, *(_tangent(jerk.high, float(t)) for t in np.geomspace(*several))))
        for several in _TANGENTS
    ]


def _tangent(jerk: float, at: float) -> TorqueLimit:
    return TorqueLimit(ACCELERATION, 0.5 * at * (1.0 + _ABOVE), -jerk / at * (1.0 + _ABOVE))


def plane_of(problem: Problem) -> tuple[PhasePlane, DriveObjective, float] | None:
    """The phase plane of a problem's objective within its bounds of B, C and torques, what is minimised and its unit.

    Other bounds and windows are left out: what holds without them holds with them. None where the objective is no
    drive's, as where an inertia is below 0.
    """
    try:
        return _plane_of(problem)
    except InputError:
        return None


def _plane_of(problem: Problem) -> tuple[PhasePlane, DriveObjective, float] | None:
    [(weight, term), *others] = problem.objective.terms
    if others or weight != 1.0 or not problem.monotone or problem.boundary is not None or problem.order < 2:
        return None
    if not isinstance(term, OfFormula) or (term.motion.start, term.motion.stop) != (0.0, 1.0):
        return None
    unit, plane = _objective(term)
    if plane is None:
        return None
    limits = []
    for limited, bounds in problem.bounded:
        if isinstance(limited, FormulaPeak) and limited.of_magnitude and bounds.high < inf:
            form = torque_of(limited.motion.formula)
            if form is not None and (limited.motion.start, limited.motion.stop) == (0.0, 1.0):
                limits.append(TorqueLimit(form.scaled(1.0 / unit), bounds.high / unit))
    B, C = (inf if (known := problem.range(name)) is None else known.high for name in ("B", "C"))
    minimise: DriveObjective = "energy" if isinstance(term, FormulaIntegral) else "rms torque"
    minimise = "peak torque" if plane.peak is not None else minimise
    return replace(plane, limits=tuple(limits), B=B, C=C), minimise, unit


def _objective(term: OfFormula) -> tuple[float, PhasePlane | None]:
    """The unit of a constant from a formula, and the phase plane of its minimum; None if it is no such constant."""
    formula = term.motion.formula
    if isinstance(term, FormulaIntegral):
        return _of_integral(formula)
    form = torque_of(formula)
    if form is None:
        return 1.0, None
    scaled = form.scaled(1.0 / form.size)
    if isinstance(term, FormulaRms):
        return form.size, PhasePlane(squared=scaled)
    if isinstance(term, FormulaPeak) and term.of_magnitude:
        return form.size, PhasePlane(peak=scaled)
    return 1.0, None


def _of_integral(formula: Formula) -> tuple[float, PhasePlane | None]:
    """The plane of a sum of powers, each the greater of two, and of one squared torque, each with a factor."""
    powers: list[tuple[AnyTorque, AnyTorque]] = []
    squares: list[tuple[float, AnyTorque]] = []
    for part in formula.terms if isinstance(formula, Sum) else (formula,):
        factors = part.factors if isinstance(part, Product) else (part,)
        last, weight = factors[-1], constant(product([Number(1.0), *factors[:-1]]))
        if weight is None or weight <= 0.0:
            return 1.0, None
        if isinstance(last, Exponentiation) and constant(last.exponent) == 2.0:
            form = torque_of(last.base)
            squares += [] if form is None else [(weight, form)]
        elif isinstance(last, Call) and last.function == "max":
            pair = greater_power(last.arguments)
            powers += [] if pair is None else [(pair[0].scaled(weight), pair[1].scaled(weight))]
    parts = formula.terms if isinstance(formula, Sum) else (formula,)
    if len(powers) + len(squares) != len(parts) or len(squares) > 1:
        return 1.0, None
    torques = [*(form for _, form in squares), *(form for pair in powers for form in pair)]
    # what braking gives back may be no torque at all
    unit = max((torque.size for torque in torques if torque != PhaseTorque(Number(0.0))), default=1.0)
    maxima = tuple((first.scaled(1.0 / unit), second.scaled(1.0 / unit)) for first, second in powers)
    if not squares:
        return unit, PhasePlane(maxima=maxima)
    [(weight, form)] = squares
    return unit, PhasePlane(squared=form.scaled(1.0 / unit), maxima=maxima, heat=weight * unit)
