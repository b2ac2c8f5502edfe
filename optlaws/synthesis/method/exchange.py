"""The solution of a program: in units, without redundant equations, by several strategies in order.

A neighbour's optimum or a guess leads to the exact contacts by Newton's method; else IPOPT on few points does, and what
is linear or conic may need vertices. All are rounds of answers, and what one violates is imposed in the next round.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal, TypeAlias, get_args

import numpy as np

from optlaws.numbers import Array
from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.families.cone import ConeFamily
from optlaws.synthesis.families.family import LinearFamily, Points, Program
from optlaws.synthesis.method.contacts import polished
from optlaws.synthesis.method.discretised.grids import first_points
from optlaws.synthesis.method.equations import contradiction, independent
from optlaws.synthesis.method.few_families import binding_few
from optlaws.synthesis.method.strategies.strategy import cutting_plane_loop
from optlaws.synthesis.method.units import units_of
from optlaws.synthesis.method.vanishing import at_apex, vanishing

if TYPE_CHECKING:
    from optlaws.synthesis.method.strategies.interior_points import ByInteriorPoints


#: by how much the room of a start exceeds what its base law needs
_AMPLE = 1.2

#: how programs are solved: by what suits their rows, or every one as a nonlinear program of CasADi by IPOPT
Method: TypeAlias = Literal["auto", "ipopt"]
METHODS = get_args(Method)
IPOPT: Method = "ipopt"
_VERTICES = "vertices"
#: the same of one program, or at vertices alone
_Method: TypeAlias = Method | Literal["vertices"]

ROUNDS = 12
_DIVERGING = ("Diverging_Iterates", "DualInfeasible")
_CONTINUED = "continued from a neighbour"
DEPTH = 1e5  # beyond what laws of the field have


@dataclass(frozen=True, eq=False)
class Outcome:
    """The result of a program's solution: the optimum (or None), IPOPT's iterations and message, the rounds.

    Where there is no optimum `tried` are the answers to the program on points, whose laws may be of use.
    """

    optimum: ActiveSet | None
    iterations: int
    rounds: int
    status: str
    tried: tuple[ActiveSet, ...] = ()

    @property
    def continued(self) -> bool:
        """Whether the contacts of a neighbour's optimum, or of a guess, led to it."""
        return self.status == _CONTINUED

    def mapped(self, change: Callable[[ActiveSet], ActiveSet]) -> Outcome:
        """The same outcome for a program in other variables or equations."""
        optimum = None if self.optimum is None else change(self.optimum)
        return replace(self, optimum=optimum, tried=tuple(change(answer) for answer in self.tried))


def solve(
    program: Program,
    warm: ActiveSet | None = None,
    *,
    start: Array | None = None,
    holds: Callable[[Array], bool] | None = None,
    rounds: int = ROUNDS,
    method: _Method = "auto",
) -> Outcome:
    """Solve a semi-infinite program; a neighbour's optimum as `warm` is tried before IPOPT, which begins at `start`.

    `holds` may decide from x alone, and more quickly than the families do, whether every constraint holds. With no
    `rounds` of interior points quadratic programs lead on from a start, which they do not leave for a worse law.
    At `vertices` a linear program is solved where contacts lie close together: interior points may end near an optimum
    without showing it. Of very many families those that bind are found by exchange: a law that none of the others
    excludes is the optimum of all.
    """
    few = binding_few(program)
    if few is None:
        return _in_units(program, warm, start, holds, rounds, method)
    while True:
        outcome = _in_units(few.program, few.inward(warm), start, None, rounds, method)
        warm = None if outcome.optimum is None else few.outward(outcome.optimum)
        more = None if warm is None else few.joined_beyond(warm.x)
        if more is None:
            return outcome.mapped(few.outward)
        few = more


def _in_units(
    program: Program,
    warm: ActiveSet | None,
    start: Array | None,
    holds: Callable[[Array], bool] | None,
    rounds: int,
    method: _Method,
) -> Outcome:
    """The solution of a program in units in which its numbers are near 1."""
    units = units_of(program)
    if units is None:
        return _in_own_units(program, warm, start, holds, rounds, method)
    outcome = _in_own_units(
        units.program,
        None if warm is None else units.inward(warm),
        None if start is None else start / units.variables,
        None if holds is None else lambda x: holds(x * units.variables),
        rounds,
        method,
    )
    return outcome.mapped(units.outward)


def _in_own_units(
    program: Program,
    warm: ActiveSet | None,
    start: Array | None,
    holds: Callable[[Array], bool] | None,
    rounds: int,
    method: _Method,
) -> Outcome:
    """The solution of a program whose numbers are near 1."""
    if warm is not None:
        optimum = polished(program, warm, holds)
        if optimum is not None:
            return Outcome(optimum, 0, 0, _CONTINUED)

    def solved(independently: Program) -> Outcome:
        if method == IPOPT:
            return _by_ipopt(independently, start, holds)
        return _solved(independently, start, holds, rounds, method)

    chosen = independent(program.equalities)
    if chosen.all():
        return solved(program)
    if contradiction(program.equalities, program.right) is not None:
        return Outcome(None, 0, 0, "equations that contradict each other")
    fewer = replace(program, equalities=program.equalities[chosen], right=program.right[chosen])

    def of_all(state: ActiveSet) -> ActiveSet:
        multipliers = np.zeros(len(chosen))
        multipliers[chosen] = state.equality_multipliers
        return replace(state, equality_multipliers=multipliers)

    return solved(fewer).mapped(of_all)


def _by_ipopt(program: Program, start: Array | None, holds: Callable[[Array], bool] | None) -> Outcome:
    """The solution by nonlinear programs of CasADi alone."""
    from optlaws.synthesis.method.strategies.interior_points import ByInteriorPoints

    points = first_points(program)
    if start is None and program.curved:
        start = initial_guess(program, points)
    return _by_interior_points(ByInteriorPoints(program, start, holds, ROUNDS, only_ipopt=True), points)


def _solved(
    program: Program, start: Array | None, holds: Callable[[Array], bool] | None, rounds: int, method: _Method
) -> Outcome:
    """The solution of a program whose equations are independent."""
    # what knows its contacts needs none of them
    from optlaws.synthesis.method.strategies.interior_points import ByInteriorPoints
    from optlaws.synthesis.method.strategies.quadratics import ByQuadratics, bends_both_ways
    from optlaws.synthesis.method.strategies.vertices import ByVertices, many_pieces

    points = first_points(program)
    if start is None and program.curved:
        nothing_left = vanishing(program)
        if nothing_left is not None:
            return Outcome(nothing_left, 0, 0, "nothing left")
        start = initial_guess(program, points)
    if start is not None and not rounds:
        stepwise = ByQuadratics(program, start, holds, straight=False)
        optimum, count = cutting_plane_loop(stepwise, points)
        return Outcome(optimum, stepwise.iterations, count, "quadratic programs")
    if method == _VERTICES or many_pieces(program):
        optimum, count = cutting_plane_loop(ByVertices(program, holds), points)
        if optimum is not None or method == _VERTICES:
            return Outcome(optimum, 0, count, "vertices")
    if bends_both_ways(program):
        stepwise = ByQuadratics(program, initial_guess(program, points) if start is None else start, holds)
        optimum, count = cutting_plane_loop(stepwise, points)
        if optimum is not None:
            return Outcome(optimum, stepwise.iterations, count, "quadratic programs")
    return _by_interior_points(ByInteriorPoints(program, start, holds, rounds), points)


def _by_interior_points(way: ByInteriorPoints, points: list[Points]) -> Outcome:
    """The solution on few points, with vanishing amplitudes as equations, and a bounded objective if it diverges."""
    program, start, rounds = way.program, way.start, way.rounds
    tried = [] if start is None else [of_variables(program, start)]
    optimum, _ = cutting_plane_loop(way, points)
    if way.vanished:

        def without_cones(others: Program) -> ActiveSet | None:
            return _in_own_units(others, None, start, None, rounds, IPOPT if way.only_ipopt else "auto").optimum

        optimum = at_apex(program, way.vanished, without_cones)
        if optimum is not None:
            return Outcome(optimum, way.iterations, way.count, "amplitudes that vanish")
        way = replace(way, apex=False, vanished=(), count=0)
        optimum, _ = cutting_plane_loop(way, points)
    tried += way.tried
    if optimum is None and way.status in _DIVERGING:
        bounded = grounded(program)
        way = type(way)(bounded, start, None, rounds, only_ipopt=way.only_ipopt)
        optimum, _ = cutting_plane_loop(way, first_points(bounded))
        # the row that held the objective up is none of the program's
        optimum = None if optimum is None or (optimum.family == len(program.families)).any() else optimum
    left = () if optimum is not None else tuple(tried)
    return Outcome(optimum, way.iterations, way.count, way.status, left)


def grounded(program: Program) -> Program:
    """The program with a lower bound on its objective from the law space, without which IPOPT may diverge."""
    row = np.append(-program.objective, 0.0)[None, :]
    ground = LinearFamily("objective at least", np.zeros(program.size), DEPTH, (1.0,), (1.0, 1.0), series=row)
    return replace(program, families=(*program.families, ground))


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
