"""Programs with many pieces, by vertices alone: the true extrema of each join the points of the next.

With many pieces an optimum is flat somewhere: c is constant on some pieces and free on others, so no exact active set
exists. The values of the vertices rise to the optimum's, each a bound of its own, and their laws keep the constraints
better each time; what is left is under the tolerance after some 15 of them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from optlaws.numbers import Array
from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.families.family import LinearFamily, Points, Program
from optlaws.synthesis.method.discretised.answer import Answer
from optlaws.synthesis.method.discretised.conic import conic, optimum_on_points
from optlaws.synthesis.method.discretised.grids import with_extrema
from optlaws.synthesis.method.discretised.linear import LinearTable, vertex_on_points
from optlaws.synthesis.method.identified import of_vertex, optimum_near
from optlaws.synthesis.method.strategies.strategy import Strategy
from optlaws.tolerances import EXCESS

_VERTEX_NEAR = 1e-3  # the excess under which a vertex may show the optimum's contacts
_VERTEX_FINE = 1e-6  # the excess under which the next vertex is sought from this one, as tolerances count

_ROUNDS = 40
_PIECES = 12
#: the excess under which a vertex may show the optimum's contacts, and how many times less it must be at the next try
_CLOSER = 30.0
#: beyond so many variables a try costs more than the vertices that are left: there is one
_SMALL = 60
#: what a vertex may exceed that does not get better any more, in EXCESS
_SLACK = 10.0


def many_pieces(program: Program) -> bool:
    """Whether a program is linear or conic with so many pieces that its optimum is flat."""
    counts = [len(family.pieces.series) for family in program.families if isinstance(family, LinearFamily)]
    return (not program.curved or conic(program)) and max(counts, default=0) >= _PIECES


@dataclass(eq=False)
class ByVertices(Strategy[list[Points], ActiveSet]):
    """The optimum on the points, exact, round by round.

    Attributes
    ----------
    program
        A program that is linear or conic.
    holds
        Checks from x alone, faster than the families do, whether every constraint holds.
    central
        Whether the middle of all optima on the points is taken, by Clarabel: where the optimum is flat, vertices of it
        stick out between the points, here and there, however many there are.
    excess, least
        What the last vertex exceeds between the points, and the least of that before.
    promising
        The excess under which a vertex may show the contacts of the optimum.
    near
        A vertex near the optimum.
    """

    program: Program
    holds: Callable[[Array], bool] | None = None
    rounds: int = _ROUNDS
    central: bool = False
    excess: float = np.inf
    least: float = np.inf
    promising: float = _VERTEX_NEAR
    near: Array | None = None

    def answered(self, points: list[Points]) -> tuple[ActiveSet | None, list[Points] | None]:
        """The optimum, or the points with the vertex's extrema."""
        vertex = self._vertex(points)
        if vertex is None:
            return None, None
        optimum = self._shown(points, vertex)
        if optimum is not None:
            return optimum, None
        onward = with_extrema(self.program, points, vertex.x)
        known = all(len(new.u) == len(old.u) for new, old in zip(onward, points, strict=True))
        last = known and (self.near is not None or self.program.curved or self.central)
        if self.excess <= EXCESS or last or self.least <= self.excess <= _SLACK * EXCESS:
            return of_vertex(points, vertex), None
        self.least = min(self.least, self.excess)
        if self.excess <= _VERTEX_FINE:
            self.near = vertex.x
        return None, onward

    def _vertex(self, points: list[Points]) -> Answer | None:
        """The vertex on the points, exact where it is near the optimum."""
        vertex: Answer | None
        if self.program.curved or self.central:
            vertex = optimum_on_points(self.program, points, self.near if self.program.curved else None)
            vertex = vertex if vertex.success else None
        else:
            vertex = vertex_on_points(self.program, points, self.near)
        if vertex is not None:
            self.excess = _excess(self.program, vertex.x)
            if self.excess <= _VERTEX_FINE and not self.program.curved:
                vertex, self.excess = _exact(self.program, points, vertex, self.excess)
        return vertex

    def _shown(self, points: list[Points], vertex: Answer) -> ActiveSet | None:
        """The optimum by its contacts, where a vertex near it shows them; of many variables the vertex itself."""
        if self.excess <= EXCESS and self.program.size > _SMALL:
            return of_vertex(points, vertex)
        if self.excess > self.promising:
            return None
        self.promising = self.excess / _CLOSER if self.program.size <= _SMALL else 0.0
        return optimum_near(self.program, self.holds, points, vertex)


def _excess(program: Program, x: Array) -> float:
    """The greatest residual over all places, in the units of each family's right side."""
    sizes = (
        float(family.extremes(x)[2].max()) / max(1.0, abs(family.right_side(x)))
        for family in program.families
        if not family.as_equation
    )
    return max(sizes, default=0.0)


def _exact(program: Program, points: list[Points], vertex: Answer, excess: float) -> tuple[Answer, float]:
    """The vertex that satisfies active rows and equations, with balanced multipliers, to machine precision.

    The solver's tolerance is that of rows of length 1, which for a snap is far from what the law needs.
    """
    table = LinearTable(program, points)
    binding = np.concatenate(vertex.multipliers[:-1]) > 0.0
    x = table.vertex_at(binding, vertex.x)
    if x is None or _excess(program, x) > max(EXCESS, excess):
        x = table.vertex_at(np.zeros_like(binding), vertex.x)
    vertex = table.sharp(vertex, points)
    return (vertex, excess) if x is None else (replace(vertex, x=x), _excess(program, x))
