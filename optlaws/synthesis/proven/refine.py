"""Proven fronts: certified laws are put between others until upper and lower side are near everywhere.

Of these the fewest are chosen whose chords stay within a gap, with what the ends of a front prove of all laws.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from math import inf

import numpy as np
from numpy.typing import NDArray

from optlaws.echo import shortened
from optlaws.errors import InfeasibleProblem, InputError, OptlawsError, SolverFailure
from optlaws.laws import MotionLaw
from optlaws.numbers import Array, positive, real, whole
from optlaws.synthesis.families.family import LinearFamily
from optlaws.synthesis.pareto import least_value, where_it_pays
from optlaws.synthesis.problem.constants import FUNCTIONALS
from optlaws.synthesis.problem.fields import CONSTANTS
from optlaws.synthesis.problem.named_constants import apart
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.program.writer import Model, model_of
from optlaws.synthesis.proof.duality import bounds_below, charge, summed
from optlaws.synthesis.proven.front import LazySequence, ProvenFront
from optlaws.synthesis.proven.swept_parameter import SweptParameter, bounds_beside, gap_bounds
from optlaws.synthesis.solution import Solution
from optlaws.synthesis.solution_array import SolutionArray, SolvedPart
from optlaws.synthesis.solve import synthesize
from optlaws.synthesis.solve_many import SolvedLine
from optlaws.synthesis.status import Status, measure

_NARROWEST = 1e-12  # of a front's range: laws nearer to each other than this are one
_PROVEN_GAP = 1e-10  # of the objective: laws of a front whose own gap is greater are looked at alone

_FIRST, _MOST_PIECES = 17, 8
#: the target as a share of the required gap: widths are whole parts of others
_AIM = 0.9
#: shares of the objective and of the required gap: laws whose own gap exceeds both are solved singly
_LEFT = 0.4
_CHUNK = 4096

#: by how much above its least value a number begins, where nearer to it too little is proven
_ABOVE = (1e-6, 1e-5, 1e-4, 1e-3)

_Law = Solution | tuple[SolutionArray, int]


def proven_front(
    problem: Problem,
    over: str | Sequence[str] = ("B", "C"),
    *,
    between: tuple[float, float] | None = None,
    gap: float = 1e-9,
) -> ProvenFront:
    """A front that gives a law, its objective and a proven lower bound at every value of a number, not at points.

    Certified laws are put between others until the gap is at most `gap` everywhere, which is proven by convexity:
    the weighted mean of two laws keeps every constraint of the problems between, and a certificate bounds the
    objective of all of them. Halving the gap takes 1.4 times as many laws.

    Parameters
    ----------
    problem
        The rest of the problem.
    over
        What runs, and what is minimised, such as ("B", "C") or ("rms_c", "J"); of one name alone the problem's own
        objective is. B is given as a number and taken at the middle, "at_most.B" and other constants are bounded from
        above; "weight of C" is the weight of a term of the objective.
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
        If the search of a certified law fails, or its own gap exceeds `gap`.

    Examples
    --------
    >>> front = proven_front(Problem(order=4), between=(1.6, 1.65), gap=1e-6)
    >>> point = front(1.6180339887)
    >>> round(point.objective, 6), point.certificate.bound <= point.objective, front.gap <= 1e-6
    (5.182381, True, True)
    """
    number = _number(problem, over)
    greatest_gap = positive(gap, "gap")
    if between is not None:
        return _Refined(number, _checked(between)).until(greatest_gap)
    low, high = _where_it_pays(number)
    for above in _ABOVE:
        # near the least feasible value multipliers are large, and proofs may miss the required gap
        with suppress(SolverFailure):
            return _Refined(number, (low, high)).until(greatest_gap)
        low = _least(number) * (1.0 + above)
    return _Refined(number, (low, high)).until(greatest_gap)


class _Refined:
    """The certified laws, with the known upper and lower bound at each."""

    def __init__(self, number: SweptParameter, ends: tuple[float, float]) -> None:
        self.number, self.ends = number, ends
        self.line = SolvedLine(number.problem, number.name, number.at, *ends)
        self.values = np.array(ends)
        self.laws: list[_Law] = [_at_end(number, end) for end in ends]
        self.known = np.array([self._known(value, law) for value, law in zip(ends, self.laws, strict=True)])

    def until(self, gap: float) -> ProvenFront:
        """Put laws between others until every gap is small enough."""
        parts = np.array([_FIRST - 1])
        while (parts > 1).any():
            self._insert(parts, gap)
            self._check(gap)
            gaps = gap_bounds(self.values, self.known, self._scale, concave=self.number.concave)
            pieces = np.clip(np.ceil(np.sqrt(np.maximum(gaps, gap) / (_AIM * gap))), 2, _MOST_PIECES)
            parts = np.where(gaps <= gap, 1, pieces).astype(int)
        count, solution = len(self.laws), self._solution
        return ProvenFront.of_known(
            self.number,
            self.values,
            LazySequence(count, lambda i: solution(i).law),
            LazySequence(count, lambda i: solution(i).certificate),
            self.known,
        )

    def _solution(self, place: int) -> Solution:
        law = self.laws[place]
        solution = law if isinstance(law, Solution) else law[0].result(law[1])
        assert isinstance(solution, Solution)  # noqa: S101 - others are solved again
        return solution

    def _insert(self, parts: NDArray[np.int_], gap: float) -> None:
        """Cut each interval into a number of parts."""
        new = np.concatenate(
            [
                np.linspace(low, high, count + 1)[1:-1]
                for low, high, count in zip(self.values[:-1], self.values[1:], parts.tolist(), strict=True)
                if count > 1
            ]
        )
        laws, known = self._solved(new, max(_PROVEN_GAP, _LEFT * gap))
        together = np.concatenate([self.values, new])
        order = np.argsort(together)
        every = self.laws + laws
        self.laws = [every[i] for i in order.tolist()]
        self.values, self.known = together[order], np.concatenate([self.known, known])[order]

    def _solved(self, values: Array, most: float) -> tuple[list[_Law], Array]:
        # laws at some values, with their known bounds; from arrays where their gap is small enough
        laws: list[_Law] = []
        known = np.full((len(values), 3), np.nan)
        for begin in range(0, len(values), _CHUNK):
            some = values[begin : begin + _CHUNK]
            solutions = self.line.at(some)
            for part in solutions.parts:
                lines = lower_lines(part, some[part.places], self.number, self.ends)
                if lines is not None:
                    known[begin + part.places] = np.column_stack([part.optima.objective, lines])
            laws += [(solutions, i) for i in range(len(some))]
        for i in np.flatnonzero(~(known[:, 0] - known[:, 1] <= most * known[:, 0])).tolist():
            laws[i] = self._alone(float(values[i]), laws[i])
            known[i] = self._known(float(values[i]), laws[i])
        return laws, known

    def _alone(self, value: float, law: _Law) -> Solution:
        # solved again without a neighbour that may have led it astray
        solution = law if isinstance(law, Solution) else law[0].result(law[1])
        if isinstance(solution, Solution) and solution.status is Status.OPTIMAL:
            return solution
        try:
            return synthesize(self.number.at(value))
        except OptlawsError as error:
            raise SolverFailure(
                f"no law was found at {self.number.name} = {value!r}, though there is one between those beside it: "
                f"give another range. {error}",
                problem=self.number.at(value),
            ) from error

    def _known(self, value: float, law: _Law) -> tuple[float, float, float]:
        assert isinstance(law, Solution)  # noqa: S101 - as it came from `_alone`
        return bounds_beside(self.number, self.ends, value, law.law, law.certificate)

    @property
    def _scale(self) -> float:
        return self.number.problem.objective.scale

    def _check(self, gap: float) -> None:
        """Refuse a gap below those of the certified laws, which further laws could not reduce."""
        top, bottom, _ = self.known.T
        gaps = np.asarray((top - bottom) / measure(top, self._scale))
        worst = int(np.argmax(gaps))
        narrow = np.diff(self.values).min() <= _NARROWEST * float(np.ptp(self.values))
        if gaps[worst] <= gap and not narrow:
            return
        value = float(self.values[worst])
        raise SolverFailure(
            f"the law at {self.number.name} = {value!r} has a gap of {gaps[worst]:.1e} itself: a front cannot be "
            f"proven to {gap:g}; give a greater gap, or another range",
            problem=self.number.at(value),
        )


def _number(problem: object, over: str | Sequence[str]) -> SweptParameter:
    if not isinstance(problem, Problem):
        raise InputError(f"proven_front takes a Problem, got {type(problem).__name__}")
    listed = apart(over) if isinstance(over, str) else list(over)
    if len(listed) not in {1, 2} or not all(isinstance(name, str) for name in listed):
        raise InputError(f"over must name what runs and what is minimised, such as ('B', 'C'), got {shortened(over)}")
    return SweptParameter(problem if len(listed) == 1 else replace(problem, minimise=listed[1]), listed[0])


def _checked(between: tuple[float, float]) -> tuple[float, float]:
    pair = [real(value) for value in between]
    if len(pair) != 2 or None in pair or not 0.0 < pair[0] < pair[1] < inf:  # type: ignore[operator]
        raise InputError(f"between must be two numbers above 0 in ascending order, got {shortened(between)}")
    return float(between[0]), float(between[1])


def _where_it_pays(number: SweptParameter) -> tuple[float, float]:
    terms = number.problem.objective.terms
    if number.concave or len(terms) > 1 or number.constant not in CONSTANTS:
        raise InputError(f"give between: where {number.name} pays is known for B, C or J and one constant alone")
    if number.name in CONSTANTS:
        return where_it_pays(number.problem, (number.name, repr(terms[0][1])))
    best = FUNCTIONALS[number.constant].value(synthesize(number.problem).law)
    return min(_least(number) * (1.0 + _ABOVE[0]), best), best


def _least(number: SweptParameter) -> float:
    if number.name in CONSTANTS:
        return least_value(number.problem, number.name)
    return synthesize(replace(number.problem, minimise=number.constant)).objective


def _at_end(number: SweptParameter, value: float) -> Solution:
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


def _least_known(number: SweptParameter) -> str:
    try:
        return f"; the least {number.constant} of these problems is {_least(number):.9g}"
    except OptlawsError:
        return ""


def lower_lines(part: SolvedPart, values: Array, number: SweptParameter, ends: tuple[float, float]) -> Array | None:
    """Value and slope of the certificates' bounds between the ends of a part; None where a row is not linear."""
    families = part.model.program.families
    if number.name != "B" or not all(isinstance(family, LinearFamily) for family in families):
        return None
    model = model_of(number.at(ends[1]))
    both = np.concatenate([np.maximum(part.optima.multiplier, 0.0), part.optima.equations], axis=1)
    every = _rows(part, model, values - ends[1])
    # nowhere between the ends is a right side greater
    sizes, contacts = np.abs(every), part.optima.u.shape[1]
    sizes[:, contacts:, -1] = np.maximum(sizes[:, contacts:, -1], np.abs(model.program.right))
    cost = np.broadcast_to(model.program.objective, (len(both), model.program.size))
    slope, blur, plain, hidden = summed(cost, both, every, sizes)
    rise = -part.optima.equations[:, 0]
    claim = max(float((plain + rise * (end - values)).max()) for end in ends)
    below = bounds_below(model, model.unit * claim)
    lost = charge(model, below, slope, blur)
    return model.unit * np.column_stack([plain - hidden - lost, rise])


def _rows(part: SolvedPart, model: Model, further: Array) -> Array:
    # of the contacts and of the equations, with the opposites of their right sides; of no contact 0
    laws, contacts, size = part.optima, part.optima.u.shape[1], part.model.program.size
    rows = np.zeros((len(further), contacts + len(model.program.right), size + 1))
    for i, family in enumerate(part.model.program.families):
        law, place = np.nonzero(laws.family == i)
        if len(law) and isinstance(family, LinearFamily):
            u = np.clip(laws.u[law, place], *family.domain)
            rows[law, place, :-1], right = family.rows(u, laws.sign[law, place])
            rows[law, place, -1] = -right
    rows[:, contacts:, :-1], rows[:, contacts:, -1] = model.program.equalities, -model.program.right
    # of the equations the first alone has B on its right side, and there B itself
    rows[:, contacts, -1] -= further
    return rows


_STEPS = 24


class ChordSelection:
    """Certified laws above, the corners of all that is proven below, and chords that leave laws out.

    The values are of a number in which the objective, of some scale, is convex; the sides are `ProvenFront.sides`.

    Examples
    --------
    >>> from optlaws import proven_front
    >>> front = proven_front(Problem(order=4), between=(1.6, 1.9), gap=1e-5)
    >>> chords = ChordSelection(np.array(front.values), front.sides, front.problem.objective.scale)
    >>> places, gap = chords.fewest(1e-3)
    >>> len(places), len(front) > 5 * len(places), gap <= 1e-3
    (6, True, True)
    """

    def __init__(self, values: Array, sides: Array, scale: float) -> None:
        self.values, self.scale = values, scale
        self.tops, low, slopes = sides.T
        offsets = low - slopes * values
        with np.errstate(divide="ignore", invalid="ignore"):
            cross = (offsets[:-1] - offsets[1:]) / np.diff(slopes)
        inside = np.where(np.isfinite(cross), np.clip(cross, values[:-1], values[1:]), values[:-1])
        below = np.maximum(offsets[:-1] + slopes[:-1] * inside, offsets[1:] + slopes[1:] * inside)
        order = np.argsort(np.concatenate([values, inside]), kind="stable")
        self.corners = np.concatenate([values, inside])[order]
        self.below = np.concatenate([low, below])[order]

    def fewest(self, gap: float, points: int | None = None) -> tuple[list[int], float]:
        """Places of laws, each as far from its predecessor as the gap allows, and the greatest gap between them."""
        greatest = positive(gap, "gap")
        most = None if points is None else whole(points, "points", least=2)
        finest = self._places(0.0)[1]
        if finest > greatest:
            raise InputError(
                f"gap: the front is proven to {finest:.1e}, not to {greatest:g}: make it with proven_front(..., "
                f"gap={greatest:g}) or less; a finer front needs fewer laws in the table"
            )
        places, reached = self._places(greatest)
        if most is not None and len(places) > most:
            near = self._reached(most)
            raise InputError(
                f"gap: {greatest:g} needs {len(places)} laws, but points allows {most}, whose gap is {near:.2g}"
            )
        return places, reached

    def _gap(self, first: int, last: int) -> float:
        # of the chord between two laws: greatest at a corner of what is proven below
        t = self.values
        low, high = np.searchsorted(self.corners, [t[first], t[last]])
        at = slice(low, high + 1)
        share = (self.corners[at] - t[first]) / (t[last] - t[first])
        chord: Array = (1.0 - share) * self.tops[first] + share * self.tops[last]
        return float(((chord - self.below[at]) / measure(chord, self.scale)).max())

    def _places(self, gap: float) -> tuple[list[int], float]:
        places, reached, last = [0], 0.0, len(self.values) - 1
        while places[-1] < last:
            after = places[-1] + 1
            while after < last and self._gap(places[-1], after + 1) <= gap:
                after += 1
            reached = max(reached, self._gap(places[-1], after))
            places.append(after)
        return places, reached

    def _reached(self, points: int) -> float:
        low, high = 0.0, 1.0
        for _ in range(_STEPS):
            middle = 0.5 * (low + high)
            low, high = (low, middle) if len(self._places(middle)[0]) <= points else (middle, high)
        return high


def proven_ends(problem: Problem, first: MotionLaw, last: MotionLaw, gap: float) -> tuple[bool, bool]:
    """Whether the first law of a front of B is within a gap of the least B of all laws, the last of the least C.

    Examples
    --------
    >>> from optlaws import smoothstep
    >>> proven_ends(Problem(order=4), smoothstep(4), synthesize(Problem(order=4)).law, 1e-3)
    (False, True)
    """
    return (
        _proven_least(problem, "B") >= first.constants.B.value * (1.0 - gap),
        _proven_least(problem, "C") >= last.constants.C.value * (1.0 - gap),
    )


def _proven_least(problem: Problem, name: str) -> float:
    try:
        return synthesize(replace(problem, minimise=name)).lower_bound
    except OptlawsError:
        return 0.0
