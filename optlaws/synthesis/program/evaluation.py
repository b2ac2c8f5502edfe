"""Evaluation of a law for a problem, recomputed from the law, and agreement of rows with such values."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import inf, isfinite
from typing import TYPE_CHECKING

import numpy as np

from optlaws.errors import InputError
from optlaws.laws import MotionLaw
from optlaws.synthesis.problem.constants import B, Functional
from optlaws.synthesis.problem.expression import Expression, Maximum
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.problem.windows import Window
from optlaws.tolerances import BESIDE_BREAK, BOUND_FEASIBILITY

if TYPE_CHECKING:
    from optlaws.synthesis.spaces.space import LawSpace

_ROWS_AGREE = 1e-5  # of a value: what rows and values computed in different ways may be apart
_BOUND_SHORT = 1e-9  # of a lower bound: a constant that is short by more is too small

#: along how many laws the rows of a user's class are compared with its values
_LAWS = 3


@dataclass(frozen=True)
class LawEvaluation:
    """The objective of a law, and its greatest violation of a constraint, relative to the constraint's bound."""

    objective: float
    excess: float

    @property
    def sound(self) -> bool:
        """Whether the law keeps its constraints and its objective is a number."""
        return self.excess <= BOUND_FEASIBILITY and isfinite(self.objective)


def evaluate(problem: Problem, law: MotionLaw) -> LawEvaluation:
    """Objective and greatest excess over the constraints."""
    values: dict[str, float] = {}
    objective = _total(problem.objective, law, values)
    excess = _velocity_excess(problem, law)
    for constant, limits in problem.bounded:
        if isfinite(limits.high):
            value = values[constant.name] if constant.name in values else constant.value(law)
            excess = max(excess, value / limits.high - 1.0)
    for window in problem.windows:
        excess = max(excess, *_window_excess(window, law))
    return LawEvaluation(objective, excess)


def _window_excess(window: Window, law: MotionLaw) -> tuple[float, float]:
    """Excess of a law above and below a window, in units of its scale."""
    if window.motion is None:
        # what the law has beyond breaks where the window begins and ends says nothing of the window
        off, inner = 0.0 if window.value else BESIDE_BREAK / 2.0, law.breaks[1:-1]
        start, stop = window.start + off * (window.start in inner), window.stop - off * (window.stop in inner)
        lowest, highest = law.extrema(window.nu, within=(start, stop))
        return highest.value - window.high, window.low - lowest.value
    from optlaws.synthesis.functionals.kinds import greatest_along

    bounds = ((1.0, window.high), (-1.0, -window.low))
    above, below = (
        greatest_along(window.motion, sign, law) - bound if isfinite(bound) else -inf for sign, bound in bounds
    )
    return above / window.scale, below / window.scale


def _velocity_excess(problem: Problem, law: MotionLaw) -> float:
    velocity, peak = problem.range("B"), problem.peak_at
    if velocity is None and peak is None and not problem.monotone:
        return 0.0
    lowest, highest = law.extrema(1)
    greatest = max(highest.value, -lowest.value)
    excess = max(-lowest.value, 0.0) if problem.monotone else 0.0
    if velocity is not None and isfinite(velocity.high):
        excess = max(excess, greatest / velocity.high - 1.0)
    if peak is not None:
        # b at the peak may be 0 or negative: what is above it is measured by the law's speed
        at_peak = float(law.b(peak))
        excess = max(excess, (highest.value - at_peak) / max(greatest, 1.0))
        if velocity is not None and velocity.low > 0.0:
            excess = max(excess, 1.0 - at_peak / velocity.low, (greatest - at_peak) / max(greatest, 1.0))
    return excess


def shortfalls(problem: Problem, law: MotionLaw) -> dict[Functional, float]:
    """Constants below their lower bound, with that bound: rows limit a peak from above only."""
    # where the place of the peak is prescribed, rows bound it from below
    velocity = problem.range("B") if problem.peak_at is None else None
    ranges = [*problem.bounded, *([] if velocity is None else [(B, velocity)])]
    return {
        constant: limits.low
        for constant, limits in ranges
        if limits.low > 0.0 and not reaches(law, constant, limits.low)
    }


def reaches(law: MotionLaw, constant: Functional, low: float) -> bool:
    """Whether a constant of a law is at least its lower bound, up to rounding."""
    return constant.value(law) >= low * (1.0 - _BOUND_SHORT)


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


def check_rows(constant: Functional, space: LawSpace) -> None:
    """Refuse a user's class whose rows contradict its value: its laws and bounds could not be trusted."""
    if not type(constant).__module__.startswith("optlaws."):
        _check(constant, space)


@lru_cache(maxsize=128)
def _check(constant: Functional, space: LawSpace) -> None:
    families = constant.families(space, np.zeros(space.terms), 0.0)
    numbers = np.random.default_rng(0)
    for size in range(_LAWS):
        x = 0.3 * size * numbers.normal(size=space.terms)
        rows = max(float(family.extremes(x)[2].max()) for family in families)
        value = constant.value(space.law(x))
        # what is the same for every law, such as the rounding of a peak of nothing, says nothing
        if abs(rows - value) > _ROWS_AGREE * max(abs(rows), abs(value)) and max(abs(rows), abs(value)) > _ROWS_AGREE:
            kind = type(constant).__name__
            raise InputError(
                f"{kind}.families and {kind}.value contradict each other: of a law the rows ask {constant.name} = "
                f"{rows:.7g}, its value is {value:.7g}. Rows must hold if and only if the value is at most "
                "slack . x + bound"
            )
