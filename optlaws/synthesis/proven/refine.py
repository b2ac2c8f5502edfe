"""Proven fronts: certified laws are put between others until upper and lower side are near everywhere."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import inf

import numpy as np
from numpy.typing import NDArray

from optlaws.echo import shortened
from optlaws.errors import InfeasibleProblem, InputError, OptlawsError, SolverFailure
from optlaws.numbers import positive, real
from optlaws.synthesis.pareto import least_value, where_it_pays
from optlaws.synthesis.problem.fields import CONSTANTS
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.proven.front import ProvenFront, interval_gaps, weighted_value
from optlaws.synthesis.proven.line import lower_line
from optlaws.synthesis.proven.running import RunningNumber
from optlaws.synthesis.solution import NOTHING, Solution, Status
from optlaws.synthesis.solve import synthesize
from optlaws.synthesis.solve_many import synthesize_many

Array = NDArray[np.float64]

_FIRST, _MOST_PIECES = 17, 8
#: of the wanted gap, what is aimed at: widths are whole parts of others
_AIM = 0.9
#: of the range: laws nearer to each other than this are one
_NARROWEST = 1e-12


def proven_front(
    problem: Problem,
    over: str | Sequence[str] = ("B", "C"),
    *,
    between: tuple[float, float] | None = None,
    gap: float = 1e-9,
) -> ProvenFront:
    """A front that gives a law, its objective and a proven lower bound at every value of a number, not at points.

    Certified laws are put between others until the gap is at most as asked everywhere, which is proven by convexity:
    the weighted mean of two laws keeps every constraint of the problems between, and a certificate bounds the
    objective of all of them. Halving the gap takes 1.4 times as many laws.

    Parameters
    ----------
    problem
        What else is asked.
    over
        What runs, and what is minimised, such as ("B", "C") or ("rms_c", "J"); of one name alone the problem's own
        objective is. B is given as a number, other constants are bounded from above; "weight of C" is the weight of a
        term of the objective.
    between
        Least and greatest value; where it pays unless given, as of `pareto_front`. Weights need it.
    gap
        The greatest gap, relative to the objective.

    Returns
    -------
    ProvenFront
        Call it with a value.

    Raises
    ------
    InputError
        If the number is unknown or not convex, or the values or the gap are none.
    InfeasibleProblem
        If there is no law at an end; the message names the least or greatest value that has one.
    SolverFailure
        If a certified law was not found, or its own gap is above what is asked.

    Examples
    --------
    >>> front = proven_front(Problem(order=4), between=(1.6, 1.65), gap=1e-6)
    >>> point = front(1.6180339887)
    >>> round(point.objective, 6), point.certificate.bound <= point.objective, front.gap <= 1e-6
    (5.182381, True, True)
    """
    number = _number(problem, over)
    wanted = positive(gap, "gap")
    ends = _ends(number, between)
    first = [_at_end(number, end) for end in ends]
    return _Refined(number, ends, first).until(wanted)


class _Refined:
    """The certified laws found so far, and what is known above and below at each."""

    def __init__(self, number: RunningNumber, ends: tuple[float, float], first: list[Solution]) -> None:
        self.number, self.ends = number, ends
        self.values = np.array(ends)
        self.solutions = list(first)
        self.known = np.array([self._known(value, one) for value, one in zip(ends, first, strict=True)])

    def until(self, gap: float) -> ProvenFront:
        """Put laws between others until every gap is small enough."""
        parts = np.array([_FIRST - 1])
        while (parts > 1).any():
            self._insert(parts)
            self._check(gap)
            gaps = interval_gaps(self.values, self.known, concave=self.number.concave)
            parts = np.where(gaps <= gap, 1, np.clip(np.ceil(np.sqrt(gaps / (_AIM * gap))), 2, _MOST_PIECES)).astype(
                int
            )
        return ProvenFront(
            self.number,
            tuple(self.values.tolist()),
            tuple(one.law for one in self.solutions),
            tuple(one.certificate for one in self.solutions),
        )

    def _insert(self, parts: NDArray[np.int_]) -> None:
        """Cut each interval into so many parts."""
        new = np.concatenate(
            [
                np.linspace(low, high, count + 1)[1:-1]
                for low, high, count in zip(self.values[:-1], self.values[1:], parts.tolist(), strict=True)
            ]
        )
        solutions = self._solved(new)
        known = np.array([self._known(value, one) for value, one in zip(new.tolist(), solutions, strict=True)])
        together = np.concatenate([self.values, new])
        order = np.argsort(together)
        every = self.solutions + solutions
        self.solutions = [every[i] for i in order.tolist()]
        self.values, self.known = together[order], np.concatenate([self.known, known])[order]

    def _solved(self, values: Array) -> list[Solution]:
        found = synthesize_many((self.number.at(value) for value in values.tolist()), errors="return")
        return [
            one if isinstance(one, Solution) and one.status is Status.OPTIMAL else self._again(value)
            for value, one in zip(values.tolist(), found, strict=True)
        ]

    def _again(self, value: float) -> Solution:
        """Without the neighbour that may have led astray; between two values with a law there is one."""
        try:
            return synthesize(self.number.at(value))
        except OptlawsError as error:
            raise SolverFailure(
                f"no law was found at {self.number.name} = {value!r}, though there is one between those beside it: "
                f"give another range. {error}",
                problem=self.number.at(value),
            ) from error

    def _known(self, value: float, one: Solution) -> tuple[float, float, float]:
        """What is known of the least objective: above and below, and the slope of the line that goes on from there."""
        top, claim, slope = one.objective, -inf, 0.0
        if self.number.concave:
            slope = weighted_value(self.number, one.law)
            claim = max(top + slope * (end - value) for end in self.ends)
        line = lower_line(one.certificate, value, self.number, self.ends, claim)
        return top, line.value, slope if self.number.concave else line.slope

    def _check(self, gap: float) -> None:
        """Refuse a gap that certified laws have themselves: no law between them would mend it."""
        top, bottom, _ = self.known.T
        own = (top - bottom) / np.where(top > NOTHING, top, 1.0)
        worst = int(np.argmax(own))
        narrow = np.diff(self.values).min() <= _NARROWEST * float(np.ptp(self.values))
        if own[worst] <= gap and not narrow:
            return
        value = float(self.values[worst])
        raise SolverFailure(
            f"the law at {self.number.name} = {value!r} has a gap of {own[worst]:.1e} itself: a front cannot be proven "
            f"to {gap:g}; ask a greater gap, or another range",
            problem=self.number.at(value),
        )


def _number(problem: object, over: str | Sequence[str]) -> RunningNumber:
    if not isinstance(problem, Problem):
        raise InputError(f"proven_front takes a Problem, got {type(problem).__name__}")
    names = [over] if isinstance(over, str) and "," not in over else over
    listed = [name.strip() for name in names.split(",")] if isinstance(names, str) else list(names)
    if len(listed) not in {1, 2} or not all(isinstance(name, str) for name in listed):
        raise InputError(f"over must name what runs and what is minimised, such as ('B', 'C'), got {shortened(over)}")
    return RunningNumber(problem if len(listed) == 1 else replace(problem, minimise=listed[1]), listed[0])


def _ends(number: RunningNumber, between: tuple[float, float] | None) -> tuple[float, float]:
    if between is not None:
        pair = [real(value) for value in between]
        if len(pair) != 2 or None in pair or not 0.0 < pair[0] < pair[1] < inf:  # type: ignore[operator]
            raise InputError(f"between must be two numbers above 0 in ascending order, got {shortened(between)}")
        return float(between[0]), float(between[1])
    terms = number.problem.objective.terms
    if number.concave or len(terms) > 1 or number.name not in CONSTANTS:
        raise InputError(f"give between: where {number.name} pays is known for B, C or J and one constant alone")
    return where_it_pays(number.problem, (number.name, repr(terms[0][1])))


def _at_end(number: RunningNumber, value: float) -> Solution:
    problem = number.at(value)
    try:
        return synthesize(problem)
    except InfeasibleProblem as error:
        raise InfeasibleProblem(
            f"no law has {number.name} = {value!r}, an end of the range{_least_known(number)}: give another range",
            problem=problem,
            tried=str(error).splitlines()[0],
            proof=error.proof,
        ) from error


def _least_known(number: RunningNumber) -> str:
    try:
        return f"; the least {number.name} of these problems is {least_value(number.problem, number.name):.9g}"
    except OptlawsError:
        return ""
