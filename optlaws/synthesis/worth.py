"""What a law is worth to a problem, recomputed from the law over the whole interval."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite

from optlaws.laws import MotionLaw
from optlaws.synthesis.expression import Expression, Maximum
from optlaws.synthesis.functionals import FUNCTIONALS, Functional
from optlaws.synthesis.problem import Problem

_SHORT = 1e-9


@dataclass(frozen=True)
class Worth:
    """The objective of a law, and by how much it breaks a constraint, relative to the constraint's bound."""

    objective: float
    excess: float


def worth(problem: Problem, law: MotionLaw) -> Worth:
    """Objective and greatest excess over the constraints."""
    values: dict[str, float] = {}
    objective = _total(problem.objective, law, values)
    excess = 0.0
    wanted = problem.range("B")
    if wanted is not None or problem.monotone:
        lowest, highest = law.extrema(1)
        if wanted is not None:
            excess = max(excess, highest.value / wanted.high - 1.0)
            if problem.boundary is None and wanted.low > 0.0:
                excess = max(excess, 1.0 - highest.value / wanted.low)
        if problem.monotone:
            excess = max(excess, -lowest.value)
        elif wanted is not None and not problem.symmetric:
            excess = max(excess, -lowest.value / wanted.high - 1.0)
    for name in ("C", "D", "J"):
        wanted = problem.range(name)
        if wanted is not None and isfinite(wanted.high):
            value = values[name] if name in values else FUNCTIONALS[name].value(law)
            excess = max(excess, value / wanted.high - 1.0)
    for window in problem.windows:
        lowest, highest = law.extrema(window.order, within=(window.start, window.stop))
        excess = max(excess, highest.value - window.high, window.low - lowest.value)
    return Worth(objective, excess)


def shortfalls(problem: Problem, law: MotionLaw) -> dict[str, float]:
    """Constants that are below their lower bound, with that bound: a peak can be held down by rows, but not up."""
    # at rest at both ends an equation makes b(1/2) the asked B
    names = ("C", "D", "J") if problem.boundary is None else ("B", "C", "D", "J")
    asked = {name: problem.range(name) for name in names}
    return {
        name: wanted.low
        for name, wanted in asked.items()
        if wanted is not None and wanted.low > 0.0 and FUNCTIONALS[name].value(law) < wanted.low * (1.0 - _SHORT)
    }


def _total(expression: Expression, law: MotionLaw, values: dict[str, float]) -> float:
    total = 0.0
    for weight, term in expression.terms:
        if isinstance(term, Maximum):
            total += weight * max(_total(part, law, values) for part in term.parts)
        elif isinstance(term, Functional):
            if term.name not in values:
                values[term.name] = term.value(law)
            total += weight * values[term.name]
    return total
