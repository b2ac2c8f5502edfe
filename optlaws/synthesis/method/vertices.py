"""Linear programs with many pieces, by vertices alone: the true extrema of each join the points of the next.

With many pieces an optimum is flat somewhere: c is constant on some pieces and free on others, so no exact active set
exists. The values of the vertices rise to the optimum's, each a bound of its own, and their laws keep the constraints
better each time; what is left is under the tolerance after some 15 of them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.families.family import Points, Program
from optlaws.synthesis.method.contacts import EXCESS
from optlaws.synthesis.method.on_points.conic import conic, optimum_on_points
from optlaws.synthesis.method.on_points.flat import Table
from optlaws.synthesis.method.on_points.grids import exchanged
from optlaws.synthesis.method.on_points.highs import vertex_on_points
from optlaws.synthesis.method.on_points.ipopt import Answer
from optlaws.synthesis.spaces.pieces.rows import PieceFamily

Array = NDArray[np.float64]

_ROUNDS = 40
_PIECES = 12
_NEAR = 1e-3
_CLOSER, _SMALL = 30.0, 60
_FINE = 1e-6
_NOTHING = 1e-13
_SLACK = 10.0  # what a vertex is allowed that does not get better any more


def many_pieces(program: Program) -> bool:
    """Whether a program is linear or conic and has so many pieces that its optimum is flat."""
    counts = [len(family.pieces.breaks) - 1 for family in program.families if isinstance(family, PieceFamily)]
    return (not program.curved or conic(program)) and max(counts, default=0) >= _PIECES


def by_vertices(
    program: Program, points: list[Points], finished: Callable[[list[Points], Answer], ActiveSet | None]
) -> tuple[ActiveSet | None, int]:
    """The optimum of a linear program by exchange of the true extrema of vertices, and the number of vertices.

    Parameters
    ----------
    program
        A program whose families are all linear.
    points
        Where they are held first.
    finished
        May tell the optimum from a vertex that is near it.
    """
    exchange = _Exchange(program, points)
    near = _NEAR
    for count in range(1, _ROUNDS + 1):
        answer = exchange.vertex()
        if answer is None:
            return None, count
        if exchange.excess <= near:
            near = exchange.excess / _CLOSER if program.size <= _SMALL else 0.0
            optimum = finished(exchange.points, answer)
            if optimum is not None:
                return optimum, count
        if exchange.ended(answer):
            return _binding(program, exchange.points, answer), count
    return None, _ROUNDS


@dataclass(eq=False)
class _Exchange:
    """Where the families are held, what the last vertex exceeds elsewhere and the least of that; a near vertex."""

    program: Program
    points: list[Points]
    excess: float = np.inf
    least: float = np.inf
    near: Array | None = None

    def vertex(self) -> Answer | None:
        """The vertex on the points, exact where it is near the optimum."""
        if self.program.curved:
            answer = optimum_on_points(self.program, self.points)
        else:
            answer = vertex_on_points(self.program, self.points, self.near)
        if answer is not None:
            self.excess = _excess(self.program, answer.x)
            if self.excess <= _FINE and not self.program.curved:
                answer, self.excess = _exact(self.program, self.points, answer, self.excess)
        return answer

    def ended(self, answer: Answer) -> bool:
        """Whether the vertex is the optimum; if not, its extrema join the points."""
        families = zip(self.program.families, self.points, strict=True)
        points = [exchanged(family, mine, answer.x) for family, mine in families]
        known = all(len(new.u) == len(old.u) for new, old in zip(points, self.points, strict=True))
        last = known and (self.near is not None or self.program.curved)
        if self.excess <= EXCESS or last or self.least <= self.excess <= _SLACK * EXCESS:
            return True
        self.points, self.least = points, min(self.least, self.excess)
        if self.excess <= _FINE:
            self.near = answer.x
        return False


def _excess(program: Program, x: Array) -> float:
    """The greatest residual over all places, in the units of each family's right side."""
    sizes = (
        float(family.extremes(x)[2].max()) / max(1.0, abs(family.room(x)))
        for family in program.families
        if not family.held
    )
    return max(sizes, default=0.0)


def _exact(program: Program, points: list[Points], answer: Answer, excess: float) -> tuple[Answer, float]:
    """The vertex with what binds and the equations held, and the multipliers balanced, as exactly as numbers do.

    The solver's tolerance is one of rows of length 1: in a jounce it is far from what the law needs.
    """
    table = Table(program, points)
    weights = np.concatenate(answer.multipliers[:-1]) * table.length
    binding = weights > 0.0
    x = table.held(binding, answer.x)
    if x is None or _excess(program, x) > max(EXCESS, excess):
        x = table.held(np.zeros_like(binding), answer.x)
    balanced = table.balanced(binding, weights, answer.multipliers[-1])
    if balanced is not None:
        weights[binding], equations = balanced
        answer = replace(answer, multipliers=[*_split(weights / table.length, points), equations])
    return (answer, excess) if x is None else (replace(answer, x=x), _excess(program, x))


def _split(weights: Array, points: list[Points]) -> list[Array]:
    return np.split(weights, np.cumsum([len(mine.u) for mine in points])[:-1])


def _binding(program: Program, points: list[Points], answer: Answer) -> ActiveSet:
    kept = [np.flatnonzero(weights > _NOTHING * weights.max(initial=0.0)) for weights in answer.multipliers[:-1]]
    return ActiveSet(
        x=answer.x,
        family=np.repeat(np.arange(len(program.families)), [len(mine) for mine in kept]),
        u=np.concatenate([mine.u[j] for mine, j in zip(points, kept, strict=True)]),
        s=np.concatenate([mine.s[j] for mine, j in zip(points, kept, strict=True)]),
        free=np.zeros(sum(map(len, kept)), dtype=np.bool_),
        multipliers=np.concatenate([w[j] for w, j in zip(answer.multipliers[:-1], kept, strict=True)]),
        equality_multipliers=answer.multipliers[-1],
    )
