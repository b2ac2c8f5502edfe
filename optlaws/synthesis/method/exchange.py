"""The solution of a program: the exchange of points, in units, without redundant equations.

A program on few points is solved, by Clarabel if its rows are linear or cones, else by steps of quadratic programs, or
by IPOPT. The contacts that the answer shows lead to the optimum by Newton's method; where they do not, the extrema of
the answer join the points. An optimum may be so flat that no exact contacts show: then the answer itself is one, once
it exceeds nothing between the points.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Literal, TypeAlias, get_args

import numpy as np

from optlaws.numbers import Array
from optlaws.numerics.cones import INFEASIBLE, NEARLY_SOLVED
from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.families.cone import ConeFamily
from optlaws.synthesis.families.energy import EnergyFamily
from optlaws.synthesis.families.family import LinearFamily, Points, Program
from optlaws.synthesis.families.kinked import KinkedIntegralFamily
from optlaws.synthesis.method.discretised.on_points import (
    Answer,
    first_points,
    of_cones,
    optimum_on_points,
    vertex_on_points,
    with_extrema,
)
from optlaws.synthesis.method.newton import as_answered, identified, polished
from optlaws.synthesis.method.presolve import (
    amplitudes,
    at_apex,
    contradiction,
    independent,
    nearly_vanished,
    units_of,
    vanishing,
)
from optlaws.tolerances import BOUND_FEASIBILITY, EXCESS, STEP_SETTLED

_STEP_SHOWS_CONTACTS = 1e-4  # of a law: after a quadratic step that is less Newton's method may find the contacts
_LOST = 1e7  # coordinates beyond this are no law of the field: the solver has lost its way

#: how programs are solved: by what suits their rows, or every one as a nonlinear program of CasADi by IPOPT
Method: TypeAlias = Literal["auto", "ipopt"]
METHODS = get_args(Method)
IPOPT: Method = "ipopt"

ROUNDS = 40
_CURVED_ROUNDS = 14
#: rounds after the one whose answer exceeded least: what they leave is the solver's own tolerance
_PATIENCE = 5
#: rounds after which an answer on points tells whether a start leads to a better law: more points only cost more
_SETTLED_BY = 4
#: by how much the room of a start exceeds what its base law needs
_AMPLE = 1.2
#: places of an integral in a linear program that shows its kinks, and in one more where that does not
_PLACES = (160, 640)
_WORSE = "no better than a law that is known, on few points already"
_STALLED = "and what answers exceed between the points falls no more"


@dataclass(frozen=True, eq=False)
class Outcome:
    """The result of a program's solution: the optimum (or None), the solver's iterations and message, the rounds.

    Where there is no optimum `tried` are the answers to the program on points, whose laws may be of use.
    """

    optimum: ActiveSet | None
    iterations: int
    rounds: int
    status: str
    tried: tuple[ActiveSet, ...] = ()

    def mapped(self, change: Callable[[ActiveSet], ActiveSet]) -> Outcome:
        """The same outcome for a program in other variables or equations."""
        optimum = None if self.optimum is None else change(self.optimum)
        return replace(self, optimum=optimum, tried=tuple(change(answer) for answer in self.tried))


@dataclass(frozen=True)
class _Options:
    """How a program is solved.

    `holds` may decide from x alone, and more quickly than the families do, whether every constraint holds.
    """

    start: Array | None
    holds: Callable[[Array], bool] | None
    rounds: int
    method: Method
    worse: Callable[[Array], bool] | None = None


def solve(
    program: Program,
    warm: ActiveSet | None = None,
    *,
    start: Array | None = None,
    holds: Callable[[Array], bool] | None = None,
    rounds: int = ROUNDS,
    method: Method = "auto",
    worse: Callable[[Array], bool] | None = None,
) -> Outcome:
    """Solve a semi-infinite program; a neighbour's optimum as `warm` is tried first, and the solver begins at `start`.

    `holds` may decide from x alone, and more quickly than the families do, whether every constraint holds, and `worse`
    whether a law that is known is better than any that it may lead to. It is solved in units in which its numbers are
    near 1.
    """
    units = units_of(program)
    if units is None:
        return _in_own_units(program, warm, _Options(start, holds, rounds, method, worse))
    within = _Options(
        None if start is None else start / units.variables,
        None if holds is None else lambda x: holds(x * units.variables),
        rounds,
        method,
        None if worse is None else lambda x: worse(x * units.variables),
    )
    return _in_own_units(units.program, None if warm is None else units.inward(warm), within).mapped(units.outward)


def _in_own_units(program: Program, warm: ActiveSet | None, options: _Options) -> Outcome:
    """The solution of a program whose numbers are near 1."""
    if warm is not None:
        optimum = polished(program, warm, options.holds)
        if optimum is not None:
            return Outcome(optimum, 0, 0, "continued from a neighbour")
    chosen = independent(program.equalities)
    if chosen.all():
        return _solved(program, options)
    if contradiction(program.equalities, program.right) is not None:
        return Outcome(None, 0, 0, "equations that contradict each other")
    fewer = replace(program, equalities=program.equalities[chosen], right=program.right[chosen])

    def of_all(state: ActiveSet) -> ActiveSet:
        multipliers = np.zeros(len(chosen))
        multipliers[chosen] = state.equality_multipliers
        return replace(state, equality_multipliers=multipliers)

    return _solved(fewer, options).mapped(of_all)


def _solved(program: Program, options: _Options) -> Outcome:
    """The solution of a program whose equations are independent."""
    if options.start is None and program.curved and options.method != IPOPT:
        nothing_left = vanishing(program)
        if nothing_left is not None:
            return Outcome(nothing_left, 0, 0, "nothing left")
    return _Exchange(program, options).outcome()


class _Exchange:
    """The rounds of a program whose equations are independent."""

    def __init__(self, program: Program, options: _Options) -> None:
        self.program, self.options = program, options
        self.convex = all(map(of_cones, program.families))
        self.rounds = options.rounds if options.method != IPOPT else min(options.rounds, _CURVED_ROUNDS)
        self.points = first_points(program)
        self.start = options.start
        if self.start is None and program.curved:
            self.start = initial_guess(program, self.points)
        self.x = np.zeros(program.size) if self.start is None else self.start
        self.least, self.least_at = np.inf, 0
        self.vanished: list[int] = []
        self.tried = [] if options.start is None else [of_variables(program, options.start)]
        self.iterations, self.count, self.status, self.lost = 0, 0, "", False

    def outcome(self) -> Outcome:
        """The optimum, or the answers of all rounds."""
        optimum: ActiveSet | None = None
        onward = True
        while optimum is None and onward and self.count < self.rounds:
            self.count += 1
            optimum, onward = self._round()
        left = () if optimum is not None else tuple(self.tried)
        return Outcome(optimum, self.iterations, self.count, self.status, left)

    def _round(self) -> tuple[ActiveSet | None, bool]:
        """The optimum, or whether the extrema of the answer have joined the points."""
        for answer in self._answers():
            self.iterations, self.status, self.x = self.iterations + answer.iterations, answer.status, answer.x
            # the optimum of a convex program on points has its proof, however great its numbers
            far = float(np.abs(answer.x).max()) > _LOST and not (self.convex and answer.success)
            astray = far or not np.isfinite(answer.x).all()
            self.lost = astray or not answer.usable
            optimum = None if self.lost else self._near(answer)
            if optimum is None and not astray:
                self.tried.append(as_answered(self.points, answer))
            if optimum is not None or self.lost:
                break
        optimum = optimum or self._without_amplitudes()
        if optimum is not None or self.lost:
            return optimum, False
        excess = _excess(self.program, self.x)
        if excess <= EXCESS and answer.success:
            # the optimum may be so flat that no exact contacts show: those on the points are then an answer
            return as_answered(self.points, answer), False
        if self.count >= _SETTLED_BY and self.options.worse is not None and self.options.worse(self.x):
            self.status, self.tried = _WORSE, []
            return None, False
        if excess < self.least:
            self.least, self.least_at = excess, self.count
        if self.count > self.least_at + _PATIENCE:
            self.status = f"{self.status}, {_STALLED}"
            return None, False
        points = with_extrema(self.program, self.points, self.x)
        known = all(len(new.u) == len(old.u) for new, old in zip(points, self.points, strict=True))
        self.points = points
        return None, not known

    def _near(self, answer: Answer) -> ActiveSet | None:
        """The optimum that the contacts of an answer lead to, where it exceeds nothing, not even beside a contact."""
        holds = self.options.holds
        optimum = polished(self.program, identified(self.program, self.points, answer), holds)
        if optimum is None or (holds is not None and holds(optimum.x)):
            return optimum
        return None if _excess(self.program, optimum.x) > BOUND_FEASIBILITY else optimum

    def _answers(self) -> Iterator[Answer]:
        """The answers on the points: where a program is curved each is finer than the one before."""
        program, points = self.program, self.points
        if self.options.method == IPOPT:
            # what its method alone needs
            from optlaws.synthesis.method.discretised.ipopt import solve_on_points

            kinds = (LinearFamily, ConeFamily, EnergyFamily)
            fine = self.count > 1 and all(isinstance(family, kinds) for family in program.families)
            answer = solve_on_points(program, points, self.start, fine=fine)
            yield answer if answer.usable or not fine else solve_on_points(program, points, self.start)
        elif self.convex:
            answer = answer_on_points(program, points, self.start)
            yield answer
            if answer.status == NEARLY_SOLVED and not program.curved:
                yield vertex_on_points(program, points) or answer
        else:
            if self.count == 1:
                yield from self._straight()
            for settled in (_STEP_SHOWS_CONTACTS, STEP_SETTLED):
                yield answer_on_points(program, points, self.x, settled)

    def _straight(self) -> Iterator[Answer]:
        """Answers of linear programs that show where integrals have their kinks, each with more places."""
        if not any(isinstance(family, KinkedIntegralFamily) for family in self.program.families):
            return
        from optlaws.synthesis.method.discretised.quadratic_steps import straight_optimum

        for places in _PLACES:
            answer = straight_optimum(self.program, self.points, self.x, places)
            if answer is None:
                return
            yield answer

    def _without_amplitudes(self) -> ActiveSet | None:
        """The optimum in which amplitudes vanish that are next to nothing and hide it."""
        vanished = amplitudes(self.program) if self.lost else nearly_vanished(self.program, self.x)
        if not vanished or vanished == self.vanished:
            return None
        self.vanished = vanished
        options = replace(self.options, holds=None)
        optimum = at_apex(self.program, vanished, lambda others: _in_own_units(others, None, options).optimum)
        self.status = self.status if optimum is None else "amplitudes that vanish"
        return optimum


def answer_on_points(
    program: Program, points: list[Points], start: Array | None, settled: float = STEP_SETTLED
) -> Answer:
    """Clarabel's solution of a linear or conic program; of any other, or where it has none, the end of quadratic steps.

    Rows that meet in next to no interior leave Clarabel short of its accuracy, or without an answer. The simplex method
    needs none, and ends linear programs there; quadratic steps end those with cones of constants in very different
    units.
    """
    if all(map(of_cones, program.families)):
        answer = optimum_on_points(program, points)
        if answer.success or answer.status == INFEASIBLE:
            return answer
        if not program.curved:
            return vertex_on_points(program, points) or answer
    from optlaws.synthesis.method.discretised.quadratic_steps import stepwise_on_points

    return stepwise_on_points(program, points, np.zeros(program.size) if start is None else start, settled)


def _excess(program: Program, x: Array) -> float:
    """The greatest residual over all places, in the units of each family's right side."""
    sizes = (
        float(family.extremes(x)[2].max()) / max(1.0, abs(family.right_side(x)))
        for family in program.families
        if not family.as_equation
    )
    return max(sizes, default=0.0)


def of_variables(program: Program, x: Array) -> ActiveSet:
    """An active set of these variables without any contact."""
    return ActiveSet.of_contacts(x, (), np.zeros(len(program.right)))


def initial_guess(program: Program, points: list[Points]) -> Array:
    """The base law with slack for its constants: curved programs are hard to enter from infeasible values."""
    x = np.zeros(program.size)
    for family, grid in zip(program.families, points, strict=True):
        needed = float((grid.s * family.value(np.zeros(program.size), grid.u)).max()) - family.bound
        if isinstance(family, ConeFamily):
            needed = max(needed, 1.0)  # a cone's rows need room
        raised = family.slack > 0.0
        x[raised] = np.maximum(x[raised], _AMPLE * needed / family.slack[raised])
    return x
