"""The number that runs along a proven front: whether laws between two values are known, and what is proven there.

A certificate proves something not of its own problem alone but of all whose right sides differ by one number; how far
both sides of a front are apart follows from that.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import inf, isfinite
from typing import Any

import numpy as np

from optlaws.echo import unknown_key
from optlaws.errors import InputError
from optlaws.files.reading import check_names
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.numbers import Array
from optlaws.synthesis.problem.constants import ALIASES, FUNCTIONALS, MAKERS, Functional
from optlaws.synthesis.problem.expression import Expression, Term
from optlaws.synthesis.problem.fields import CONSTANTS
from optlaws.synthesis.problem.named_constants import named
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.problem.ranges import Range
from optlaws.synthesis.program.writer import evaluate
from optlaws.synthesis.proof.certificate import Certificate, weighted_rows
from optlaws.synthesis.proof.duality import bounds_below, charge, sum_of_lines
from optlaws.synthesis.status import measure

_PRODUCT_ROUNDING = 2.0**-50  # of a product: what rounding of it and of its factors can be

Ends = tuple[float, float]

#: before the name of a term of the objective: its weight runs
WEIGHT = "weight of "
#: before B: it is bounded from above, wherever it is reached
AT_MOST = "at_most."


@dataclass(frozen=True)
class SweptParameter:
    """A peak velocity, an upper bound of a constant or a weight of the objective, in a problem that is convex in it.

    B and bounds stand on the right side of rows, so that the least objective is convex in them: laws between two laws
    keep the bounds between, and a certificate bounds the objective at every value. Weights stand in the objective, so
    that it is the other way round: a law is one at every weight, and certificates may be averaged.

    Parameters
    ----------
    problem
        The rest of the problem.
    name
        "B", which is given as a number; "at_most.B", "C", "J", "rms_c" or another constant, which is bounded from
        above; or "weight of C", the weight of a term of the objective.

    Raises
    ------
    InputError
        If there is no such number, the problem gives it already, or it is not convex.

    Examples
    --------
    >>> number = SweptParameter(Problem(order=4), "rms_c")
    >>> number.at(3.7)
    Problem(B=None, order=4, basis=Chebyshev(degree=9), minimise='C', bounds={'rms_c': at_most(3.7)})
    """

    problem: Problem
    name: str

    def __post_init__(self) -> None:
        known = None if self.concave else self.problem.range(self.constant)
        if known is not None:
            given = getattr(self.problem, self.constant) if self.constant in CONSTANTS else known
            raise InputError(f"{self.constant} runs: leave it out of the problem, got {given!r}")
        _check_convex(self.at(2.0))

    @property
    def concave(self) -> bool:
        """Whether the least objective is concave in the number: of weights."""
        return self.name.startswith(WEIGHT)

    def at(self, value: float) -> Problem:
        """The problem at a value of the number."""
        if self.concave:
            changed = list(self.problem.objective.terms)
            changed[self._place] = (value, self.weighted)
            return replace(self.problem, minimise=Expression(tuple(changed)))
        if self.name == "B":
            return self._at_two.at_velocity(value)
        if self._constant.name == "B":
            return replace(self.problem, B=Range(0.0, value))
        bounds: Mapping[Any, Any] = {**self.problem.bounds, self._constant: Range(0.0, value)}
        return replace(self.problem, bounds=bounds)

    @kept_property
    def _at_two(self) -> Problem:
        return replace(self.problem, B=2.0)

    @property
    def weighted(self) -> Term:
        """The term of the objective whose weight runs."""
        return self.problem.objective.terms[self._place][1]

    @property
    def constant(self) -> str:
        """The constant that is given or bounded, by name."""
        return self._constant.name

    @property
    def _constant(self) -> Functional:
        known = FUNCTIONALS | ALIASES
        if self.name == f"{AT_MOST}B":
            return known["B"]
        if "(" in self.name:
            return named(self.name)
        if self.name not in known:
            raise InputError(unknown_key(self.name, (*known, *MAKERS), "constant"))
        return known[self.name]

    @property
    def _place(self) -> int:
        name = self.name.removeprefix(WEIGHT)
        known = [repr(term) for _, term in self.problem.objective.terms]
        if len(known) < 2:
            raise InputError(f"a weight runs in an objective of several terms, got {self.problem.objective!r}")
        check_names([name], known, "term of the objective")
        return known.index(name)


def _check_convex(problem: Problem) -> None:
    """Refuse problems whose laws between two laws may be none of it: with D, or with peaks bounded from below."""
    for constant in sorted(problem.constants, key=repr):
        if not constant.convex:
            raise InputError(
                f"{constant.title} is not convex, so that two laws prove nothing of the laws between: pareto_front "
                "exchanges it point by point"
            )
        limits = problem.range(constant.name)
        if constant.name != "B" and limits is not None and limits.low > 0.0:
            raise InputError(
                f"{constant.title} is bounded from below, which laws between two need not keep: bound it from above"
            )
    velocity = problem.range("B")
    if velocity is not None and velocity.low > 0.0 and problem.peak_at is None:
        raise InputError(
            f"B = {problem.B!r} says nothing of the place of the peak velocity, and laws between two laws need not "
            "have it: give inflexion, or at_most"
        )


def bounds_beside(
    number: SweptParameter, ends: Ends, value: float, law: MotionLaw, certificate: Certificate
) -> tuple[float, float, float]:
    """The least objective at a value by a law and its certificate: above, below, and the slope of the line there.

    Of a number on right sides the line is below, affine between the ends; of a weight it is above, and what is below
    holds at the value alone. What rounding hides is charged as much as it can be worth anywhere between the ends: it
    grows with every bound, with the objective that is claimed, and as a weight falls.
    """
    top, claim, rise = evaluate(certificate.problem, law).objective, -inf, 0.0
    if number.concave:
        rise = evaluate(replace(number.problem, minimise=number.weighted), law).objective
        claim = max(top + rise * (end - value) for end in ends)
    model, lines = weighted_rows(certificate)
    there = [weighted_rows(replace(certificate, problem=number.at(end))) for end in ends]
    total, weights = sum_of_lines(model, lines), np.array([weight for weight, _, _ in lines])
    rates, rounding = _rates(number, ends, *(rows for _, rows in there))
    low, slope = model.unit * float((total.value - total.hidden)[0]), -float(model.unit * (weights @ rates))
    most = max(claim, *(low + slope * (end - value) for end in ends))
    hidden = max(float(charge(moved, bounds_below(moved, most), total.slope, total.blur)[0]) for moved, _ in there)
    lost = model.unit * (hidden + float(np.abs(weights) @ rounding))
    return top, low - lost if isfinite(lost) else -inf, rise if number.concave else slope


def _rates(number: SweptParameter, ends: Ends, *rows: list[tuple[float, Array, float]]) -> tuple[Array, Array]:
    # how fast each row's right side runs, and what rounding does to it between the ends
    first, last = rows
    if number.concave:
        return np.zeros(len(first)), np.zeros(len(first))
    if any((values != other).any() for (_, values, _), (_, other, _) in zip(first, last, strict=True)):
        raise InputError(f"{number.name} changes coefficients of constraints, so there is no proof between its values")
    low, high = (np.array([right for _, _, right in some]) for some in rows)
    rates = (high - low) / (ends[1] - ends[0])
    return rates, np.where(rates == 0.0, 0.0, _PRODUCT_ROUNDING * np.maximum(np.abs(low), np.abs(high)))


def gap_bounds(t: Array, known: Array, scale: float, *, concave: bool) -> Array:
    """The greatest gap between each two values t: between a chord and two lines, it is greatest where these cross.

    At each value `known` are what is above and below the least objective, and the slope of the line through the lower
    value or, where the objective is concave, through the upper one.
    """
    top, bottom, slopes = known.T
    width = np.diff(t)
    first = np.stack([top[:-1] - bottom[:-1], np.zeros_like(width)])
    last = np.stack([np.zeros_like(width), top[1:] - bottom[1:]])
    if concave:
        first[1] = top[:-1] + slopes[:-1] * width - bottom[1:]
        last[0] = top[1:] - slopes[1:] * width - bottom[:-1]
    else:
        first[1] = top[1:] - (bottom[:-1] + slopes[:-1] * width)
        last[0] = top[:-1] - (bottom[1:] - slopes[1:] * width)
    turn = first[1] - first[0] + last[0] - last[1]
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.clip(np.where(turn > 0.0, (last[0] - first[0]) / turn, 0.0), 0.0, 1.0)
    crossing = np.minimum((1.0 - share) * first[0] + share * first[1], (1.0 - share) * last[0] + share * last[1])
    greatest = np.maximum(crossing, np.minimum(first, last).max(axis=0))
    least = np.minimum(top[:-1], top[1:])
    return np.asarray(greatest / measure(least, scale))
