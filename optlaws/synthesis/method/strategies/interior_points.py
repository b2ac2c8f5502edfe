"""Few points by Clarabel or IPOPT, then the exact active set by Newton's method; or extrema join.

A linear or conic program that this does not end is ended by vertices.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from optlaws.numbers import Array
from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.families.cone import ConeFamily
from optlaws.synthesis.families.energy import EnergyFamily
from optlaws.synthesis.families.family import ConstraintFamily, LinearFamily, Points, Program
from optlaws.synthesis.families.kinked import KinkedIntegralFamily
from optlaws.synthesis.method.discretised.answer import Answer
from optlaws.synthesis.method.discretised.conic import INFEASIBLE, conic, of_cones, optimum_on_points
from optlaws.synthesis.method.discretised.grids import with_extrema
from optlaws.synthesis.method.discretised.quadratic_steps import stepwise_on_points
from optlaws.synthesis.method.identified import as_answered, optimum_near
from optlaws.synthesis.method.strategies.strategy import Strategy, cutting_plane_loop
from optlaws.synthesis.method.strategies.vertices import ByVertices
from optlaws.synthesis.method.units import ProgramUnits, units_near
from optlaws.synthesis.method.vanishing import amplitudes, nearly_vanished
from optlaws.tolerances import EXCESS

_LOST = 1e7  # coordinates beyond this are no law of the field: the solver has lost its way

_LINEAR_ROUNDS = 6
_KINKED_ROUNDS = 3
#: after so many rounds a small objective is made 1, and amplitudes of a conic program may vanish
_COARSE = 4
#: beyond so many variables a round of IPOPT costs more than all vertices together
_LARGE = 24


@dataclass(eq=False)
class ByInteriorPoints(Strategy[list[Points], ActiveSet]):
    """IPOPT's optimum on the points, round by round.

    Attributes
    ----------
    program
        What is solved.
    start
        Where IPOPT begins; None leaves that to it.
    holds
        Checks from x alone, faster than the families do, whether every constraint holds.
    rounds
        How many at most; a linear program is given fewer.
    only_ipopt
        Whether IPOPT solves conic programs too, and no vertices are computed.
    units
        Of the program: where its objective is small, rounds that show no optimum are followed by ones in its units.
    count, iterations, status
        The rounds so far, those of vertices included where they ended it, IPOPT's iterations, and its last word.
    apex
        Whether it ends early where amplitudes next to nothing hide the optimum.
    vanished
        Which families they are: those that may vanish.
    sound
        The least answer that breaks no constraint anywhere, with its multipliers on the points: what is left where no
        round shows an exact active set.
    tried
        All answers, with their multipliers on the points: the law of one may satisfy all rows although its variables
        do not, where these are the objective's, or the solver's last word is that it failed.
    """

    program: Program
    start: Array | None
    holds: Callable[[Array], bool] | None
    rounds: int
    only_ipopt: bool = False
    apex: bool = True
    vanished: tuple[int, ...] = ()
    units: ProgramUnits | None = None
    count: int = 0
    iterations: int = 0
    status: str = ""
    sound: ActiveSet | None = None
    tried: list[ActiveSet] = field(default_factory=list)

    def __post_init__(self) -> None:
        if not self.program.curved:
            self.rounds = min(self.rounds, _LINEAR_ROUNDS)
        if any(isinstance(family, KinkedIntegralFamily) for family in self.program.families):
            self.rounds = min(self.rounds, _KINKED_ROUNDS)

    def answered(self, points: list[Points]) -> tuple[ActiveSet | None, list[Points] | None]:
        """The optimum, or the points with the extrema of IPOPT's answer; neither where IPOPT has lost its way."""
        optimum, onward = self._round(points)
        return optimum if optimum is None or self.units is None else self.units.outward(optimum), onward

    def _round(self, points: list[Points]) -> tuple[ActiveSet | None, list[Points] | None]:
        self.count += 1
        answer = self._answer(self.program, points)
        lost = _lost(answer)
        if not _astray(answer.x):
            last = as_answered(points, answer)
            self.tried.append(last if self.units is None else self.units.outward(last))
        optimum = None if lost else optimum_near(self.program, self.holds, points, answer)
        if optimum is None and self._vertices_help(lost=lost):
            optimum = self._by_vertices(points)
        if optimum is not None:
            return optimum, None
        if self.apex and (lost or self.count == _COARSE or not conic(self.program)):
            self.vanished = tuple(amplitudes(self.program) if lost else nearly_vanished(self.program, answer.x))
            if self.vanished:
                return None, None
        if lost:
            return self.sound, None
        # an optimum may be so flat that no exact active set shows: the contacts on the points are then an answer
        whole = all(of_cones(family) or isinstance(family, KinkedIntegralFamily) for family in self.program.families)
        if whole and self.program.violation(answer.x) <= EXCESS and self._is_less(answer.x):
            self.sound = as_answered(points, answer)
        if self.count == self.rounds:
            flat = _only(self.program, LinearFamily, ConeFamily, KinkedIntegralFamily)
            return self.sound or (as_answered(points, answer) if flat else None), None
        onward = with_extrema(self.program, points, answer.x)
        if self.count == _COARSE and self.program.curved:
            self._zoom(answer.x)
        return None, onward

    def _zoom(self, x: Array) -> None:
        """Go on in units in which the objective is 1, if it is small near x."""
        self.units = units_near(self.program, x)
        if self.units is not None:
            units = self.units
            self.program = units.program
            self.start = x / units.variables
            self.sound = None if self.sound is None else units.inward(self.sound)
            holds = self.holds
            self.holds = None if holds is None else lambda x: holds(x * units.variables)

    def _is_less(self, x: Array) -> bool:
        """Whether an answer is better than the sound one so far."""
        return self.sound is None or bool(self.program.objective @ (x - self.sound.x) < 0.0)

    def _answer(self, program: Program, points: list[Points]) -> Answer:
        """The answer of what suits the rows, or IPOPT's."""
        if self.only_ipopt:
            return self._by_ipopt(program, points)
        return self._noted(answer_on_points(program, points, self.start))

    def _by_ipopt(self, program: Program, points: list[Points]) -> Answer:
        # what its method alone needs
        from optlaws.synthesis.method.discretised.ipopt import solve_on_points

        fine = self.count > 1 and _only(program, LinearFamily, ConeFamily, EnergyFamily)
        answer = self._noted(solve_on_points(program, points, self.start, fine=fine))
        return self._noted(solve_on_points(program, points, self.start)) if fine and not answer.usable else answer

    def _noted(self, answer: Answer) -> Answer:
        """The answer itself, its iterations counted."""
        self.iterations += answer.iterations
        self.status = answer.status
        return answer

    def _vertices_help(self, *, lost: bool) -> bool:
        """Whether vertices are computed on the same points."""
        if self.only_ipopt:
            return False
        large = not self.program.curved and self.program.size > _LARGE
        return (not self.program.curved or conic(self.program)) and (large or lost or self.count == self.rounds)

    def _by_vertices(self, points: list[Points]) -> ActiveSet | None:
        optimum, count = cutting_plane_loop(ByVertices(self.program, self.holds), points)
        if optimum is None and not self.program.curved:
            optimum, count = cutting_plane_loop(ByVertices(self.program, self.holds, central=True), points)
        if optimum is not None:
            self.count += count
            self.status = "vertices"
        return optimum


def answer_on_points(program: Program, points: list[Points], start: Array | None) -> Answer:
    """Clarabel's solution of a linear or conic program; of any other, or where it has none, the end of quadratic steps.

    These need no interior, which cones of constants in very different units may leave next to none.
    """
    if all(map(of_cones, program.families)):
        answer = optimum_on_points(program, points)
        if answer.success or not program.curved or answer.status == INFEASIBLE:
            return answer
    return stepwise_on_points(program, points, np.zeros(program.size) if start is None else start)


def _only(program: Program, *kinds: type[ConstraintFamily]) -> bool:
    """Whether every family is of one of these kinds."""
    return all(isinstance(family, kinds) for family in program.families)


def _lost(answer: Answer) -> bool:
    return not answer.usable or _astray(answer.x)


def _astray(x: Array) -> bool:
    return not np.isfinite(x).all() or float(np.abs(x).max()) > _LOST
