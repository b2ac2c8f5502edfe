"""The search for a power certificate: boxes are shrunk by linear programs, and cut in two where that stalls."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from optlaws.errors import InputError
from optlaws.numbers import Array
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.program.writer import model_of
from optlaws.synthesis.proof.certificate import Certificate
from optlaws.synthesis.proof.nodes import Leaf, Node, Split
from optlaws.synthesis.proof.power.box import Box, BoxRows
from optlaws.synthesis.proof.power.grid import Grid
from optlaws.synthesis.proof.power.rows import rows_of
from optlaws.tolerances import TINY

_NARROW_RANGE = 1e-3  # added to widths by which rows are weighted
_GIVEN_VARIABLE = 1e-9  # a variable whose range is narrower is given

#: tells from the variables of some law whether its neighbourhood has a better one than the best known
Explore = Callable[[Array], bool]

#: how far below the best objective a claim is, and how many linear programs its proof may take
_CLAIMS = ((2e-9, 4000), (8e-9, 2000), (1e-7, 1000), (1e-4, 300), (1e-2, 200), (1e-1, 100))
#: up to so many coordinates; beyond, the programs grow and their number shrinks
_COORDINATES = 11
_CANDIDATES = 60
_STALLED = 0.8
_SPACING = 1e-2
_ROUNDS = 30


def tightened(problem: Problem, objective: float, x: Array, explore: Explore) -> Certificate | None:
    """The certificate of the highest claim that can be proven; None if none can, or if there is a better law.

    Parameters
    ----------
    problem, objective, x
        What is solved, the best objective known, and the variables of its law.
    explore
        Called with the variables of laws in boxes that resist; True ends the search.
    """
    if rows_of(problem, objective, ()) is None or objective <= 0.0:
        return None
    share = min(1.0, (_COORDINATES / model_of(problem).space.terms) ** 3)
    for gap, budget in _CLAIMS:
        search = searched(problem, objective * (1.0 - gap), x, int(budget * share), explore)
        if search.certificate is not None or search.overtaken:
            return search.certificate
    return None


def searched(problem: Problem, claim: float, x: Array, budget: int, explore: Explore) -> BoxSearch:
    """The search for the proof of one claim, done; x are the variables of a law with an objective above it."""
    rows = rows_of(problem, claim, _points(problem, claim))
    if rows is None:
        raise InputError(f"nothing of {problem!r} can be bounded by boxes")
    search = BoxSearch(rows, Grid(rows, x), budget, explore)
    search.run()
    return search


@dataclass(frozen=True, eq=False)
class Region:
    """What nodes leave of a box with sums rounded down, and rounded up: exact arithmetic leaves a box between."""

    box: Box
    inner: Box

    def cut(self, variable: int, side: int, value: float) -> Region:
        """Both boxes with one side moved."""
        return Region(self.box.cut(variable, side, value), self.inner.cut(variable, side, value))

    def moved(self, rows: BoxRows, node: Leaf) -> Region | None:
        """The region after a node, None where it is empty; the region itself where rounding decides whether it is.

        A tree with such a node closes the box earlier in exact arithmetic, and its next node finds another one or none.
        """
        left = rows.moved(self.box, node)
        if left == [self.box]:
            return self
        if not rows.tightens:
            return Region(left[0], left[0]) if left else None
        inner = rows.moved(self.inner, node, rounded=1)
        if bool(left) != bool(inner):
            return self
        return Region(left[0], inner[0]) if left else None


@dataclass(eq=False)
class BoxSearch:
    """A search for the proof of one claim."""

    rows: BoxRows
    grid: Grid
    left: int  #: how many linear programs it may still solve
    explore: Explore
    certificate: Certificate | None = None  #: None before it is found, and where the programs do not suffice
    overtaken: bool = False  #: whether a law was found that makes the claim worthless

    def __post_init__(self) -> None:
        root = self.rows.root()
        self._tree: list[Node] = []
        self._root_width = np.maximum(root.high - root.low, TINY)
        wide = [i for i in range(self.rows.terms) if self._root_width[i] > _GIVEN_VARIABLE]
        # where the rows leave one law alone, one coordinate shows that it is not better
        self._variables = [*wide, *self.rows.branched] or [0]

    def run(self) -> None:
        """Empty one box after the other."""
        regions = [Region(self.rows.root(), self.rows.root())]
        while regions:
            region = self._shrunk(regions.pop())
            if region is None:
                continue
            box = region.box
            self.overtaken = self.explore(self._variables_of((box.low + box.high) / 2.0))
            if self.overtaken or self.left <= 0:
                return
            width = (box.high - box.low) / self._root_width
            variable = max(self._variables, key=width.__getitem__)
            at = float(region.inner.low[variable] + region.inner.high[variable]) / 2.0
            self._tree.append(Split(variable, at))
            regions += [region.cut(variable, 1, at), region.cut(variable, -1, at)]
        points = tuple(self.rows.points.tolist())
        proof = Certificate(self.rows.problem, self.rows.claim, tuple(self._tree), points=points)
        self.certificate = proof if proof.proven else None

    def _shrunk(self, region: Region) -> Region | None:
        """The region with its sides moved as long as that goes on; None where it is empty."""
        for _ in range(_ROUNDS):
            if self.left <= 0:
                break
            box = region.box
            before = (box.high - box.low)[self._variables]
            nodes, points = self.grid.nodes(box, [self._variables[i] for i in np.argsort(-before)])
            self.left -= len(nodes)
            self._exchange(box, points)
            for node in nodes:
                moved = region.moved(self.rows, node)
                if moved is not region:
                    self._tree.append(node)
                if moved is None:
                    return None
                region = moved
            after = (region.box.high - region.box.low)[self._variables]
            ratio = np.maximum(after, TINY) / np.maximum(before, TINY)
            if float(np.exp(np.log(ratio).mean())) > _STALLED:
                break
        return region

    def _exchange(self, box: Box, points: Sequence[Array]) -> None:
        """Add rows to the grid that the solutions of linear programs violate, by the mean solution of each side."""
        width = float((box.high - box.low)[: self.rows.terms].max())
        for side in (points[::2], points[1::2]) if points else ():
            self.grid.exchange(self._variables_of(np.mean(side, axis=0)), _SPACING * width)

    def _variables_of(self, values: Array) -> Array:
        return np.append(self.rows.coordinates(values), values[self.rows.terms : self.rows.variables])


def _points(problem: Problem, claim: float) -> list[float]:
    """Places at which velocities determine the law well, and at which they are known well beforehand."""
    space = model_of(problem).space
    k = (0.5 if space.symmetric else 1.0) * np.sin(np.pi / 2 * np.arange(1, _CANDIDATES + 1) / _CANDIDATES)
    from scipy.linalg import qr

    rows = rows_of(problem, claim, ())
    if rows is None:
        return []
    low, high = rows.brackets_at(k)
    weighted = rows.rows(1, k)[:, : space.terms] / (high - low + _NARROW_RANGE)[:, None]
    chosen = qr(weighted.T, pivoting=True, mode="r")[1][: space.terms]
    return sorted(k[chosen].tolist())
