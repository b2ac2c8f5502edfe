"""The search for a power certificate: boxes are shrunk by linear programs, and cut in two where that stalls.

The rows of a box at finitely many places, scaled to the box, are the linear program.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.polynomial.chebyshev import chebpts2
from numpy.typing import NDArray

from optlaws.errors import InputError
from optlaws.numbers import Array
from optlaws.synthesis.families.curved import IntegralFamily
from optlaws.synthesis.families.family import ConstraintFamily, LinearFamily, NormFamily
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.program.writer import model_of
from optlaws.synthesis.proof.certificate import Certificate
from optlaws.synthesis.proof.nodes import Contact, Leaf, Node, Split, Tightening
from optlaws.synthesis.proof.power.box import Box, BoxRows, Places
from optlaws.synthesis.proof.power.rows import rows_of
from optlaws.tolerances import TINY

_ROW_BROKEN = 1e-11  # of a row: what is broken by less is kept
_PIVOT_LEAST = 1e-8  # of a row: what a row of the basis must have of one that it leaves to
_TIE_BROKEN = 1e-9  # of a goal: what is added so that multipliers differ

#: steps, for each variable
_STEPS = 8


def multipliers_in_cube(goals: Array, rows: Array, right: Array) -> tuple[Array, Array]:
    """Multipliers of the rows for each goal that is minimised where rows . z <= right and no |z| exceeds 1.

    Parameters
    ----------
    goals, rows, right
        Shapes (goals, variables), (rows, variables), (rows,); rows whose magnitudes sum up to about 1.

    Returns
    -------
    multipliers
        Shape (goals, rows), none below 0. Where no z keeps the rows they are those of a sum that is above 0 everywhere.
    points
        The minimisers, shape (goals, variables); NaN where no z keeps the rows.

    Examples
    --------
    >>> weights, points = multipliers_in_cube(np.array([[-1.0, 0.0]]), np.array([[0.5, 0.5]]), np.array([-0.25]))
    >>> weights.round(6).tolist(), points.round(6).tolist()
    ([[2.0]], [[0.5, -1.0]])
    >>> weights, points = multipliers_in_cube(np.array([[-1.0, 0.0]]), np.array([[0.5, 0.5]]), np.array([-1.5]))
    >>> weights.round(6).tolist(), bool(np.isnan(points).all())
    ([[2.0]], True)
    """
    count, size = goals.shape
    every = np.vstack([rows, np.eye(size), -np.eye(size)])
    most = np.concatenate([right, np.ones(2 * size)])
    # what is minimised is not quite the goal: of multipliers that are 0 none would be the first to leave
    broken = goals + np.where(goals < 0.0, -_TIE_BROKEN, _TIE_BROKEN) * (1.0 + np.arange(size) / size)
    basis = len(rows) + np.arange(size) + np.where(broken > 0.0, size, 0)
    weights, points = np.zeros((count, len(every))), np.full((count, size), np.nan)
    left = np.arange(count)
    for step in range(_STEPS * size + 1):
        inverse = _inverses(every[basis[left]])
        z = (inverse @ most[basis[left], None])[:, :, 0]
        excess = z @ every.T - most
        entering = excess.argmax(axis=1)
        ended = excess[np.arange(len(left)), entering] <= _ROW_BROKEN
        if step == _STEPS * size:
            ended[:] = True
        if ended.any():
            at = left[ended]
            weights[at[:, None], basis[at]] = np.maximum(-(goals[at, None] @ inverse[ended])[:, 0], 0.0)
            points[at] = z[ended]
            left, inverse, entering = left[~ended], inverse[~ended], entering[~ended]
        if not len(left):
            break
        share = (every[entering, None] @ inverse)[:, 0]
        now = np.maximum(-(broken[left, None] @ inverse)[:, 0], 0.0)
        ratio = np.full(now.shape, np.inf)
        np.divide(now, share, out=ratio, where=share > _PIVOT_LEAST)
        leaving = ratio.argmin(axis=1)
        empty = np.isinf(ratio[np.arange(len(left)), leaving])
        if empty.any():
            # the rows of the basis can do nothing against the one that enters
            at = left[empty]
            weights[at[:, None], basis[at]] = np.maximum(-share[empty], 0.0)
            weights[at, entering[empty]] = 1.0
            points[at] = np.nan
            left, leaving, entering = left[~empty], leaving[~empty], entering[~empty]
        basis[left, leaving] = entering
    return weights[:, : len(rows)], points


def _inverses(matrices: Array) -> Array:
    """Inverses of matrices; zeros, which show nothing, of those that have none."""
    try:
        return np.asarray(np.linalg.inv(matrices))
    except np.linalg.LinAlgError:
        regular = np.linalg.matrix_rank(matrices) == matrices.shape[-1]
        inverses = np.zeros_like(matrices)
        inverses[regular] = np.linalg.inv(matrices[regular])
        return inverses


_GRID_NEAR = 1e-3  # of a right side: rows nearer to binding join the grid
_GRID_EMPTY = 1e-9  # of the greatest entry: a row that is shorter says nothing
_GRID_ROUNDING = 1e-13  # of a row's size: what is less is nothing
_GRID_LIGHT = 1e-13  # of the greatest multiplier: what is less is rounding

_PLACES = 16


@dataclass(frozen=True, eq=False)
class Linear:
    """Rows A z <= h and E z = f over the unit cube of a scaled box, with the original rows."""

    matrix: Array
    right: Array
    length: Array
    which: NDArray[np.intp]
    equal: Array
    equal_right: Array
    equal_length: Array


class Grid:
    """The places k at which rows are enforced, for every family of the program and for the power."""

    def __init__(self, rows: BoxRows, x: Array) -> None:
        self.rows = rows
        self.contacts: list[Contact] = []
        self.fixed = np.empty((0, rows.size + 1))
        self.places: Places | None = None
        self._seen: dict[str, list[float]] = {}
        self._beside: list[Contact] = []
        last = 0.5 if rows.space.symmetric else 1.0
        count = _PLACES + 2 * rows.terms
        k = last * (1.0 + chebpts2(count + 2)[1:-1]) / 2.0
        for family in rows.model.program.families:
            if isinstance(family, NormFamily):
                self._norm(family, x)
            elif isinstance(family, IntegralFamily):
                self._fix([Contact(family.name, 1.0, 0.0, 0.0, family.touching(x, 1.0))])
            elif family.domain[0] == family.domain[1]:
                self._join(family, family.k(np.array(family.domain[:1])))
            else:
                low, high = np.sort(family.k(np.array(family.domain)))
                self._join(family, np.concatenate([k[(k > low) & (k < high)], [low, high]]))
        self._curve(np.append(k, last))
        self.exchange(x, 0.0)

    def exchange(self, x: Array, spacing: float) -> None:
        """Take in the places where the law with variables x is near a bound, but none within the spacing of others."""
        for family in self.rows.model.program.families:
            if isinstance(family, NormFamily) or family.domain[0] == family.domain[1]:
                continue
            u, _, residual = family.extremes(x)
            near = family.k(u[residual > -_GRID_NEAR * max(self.rows.units[family.name], abs(family.right_side(x)))])
            seen = self._seen.setdefault(family.name, [])
            new = [k for k in near.tolist() if not seen or min(abs(k - place) for place in seen) > spacing]
            if new:
                self._join(family, np.array(new))

    def _join(self, family: ConstraintFamily, k: Array) -> None:
        self._seen.setdefault(family.name, []).extend(k.tolist())
        if self.rows.is_curved(family):
            self._curve(k)
        elif isinstance(family, LinearFamily):
            joined = [Contact(family.name, sign, place, 0.0) for sign in family.signs for place in k.tolist()]
            self._fix(joined)

    def _fix(self, contacts: Sequence[Contact]) -> None:
        rows = self.rows.of_contacts(contacts, self.rows.root())
        units = np.array([self.rows.units.get(contact.constraint, 0.0) for contact in contacts])
        # at an end that is given rows are nothing but rounding
        some = np.abs(rows * self.rows.sizes).max(axis=1) > _GRID_ROUNDING * units
        self.contacts += [contact for contact, keep in zip(contacts, some.tolist(), strict=True) if keep]
        self.fixed = np.vstack([self.fixed, rows[some]])

    def _norm(self, family: NormFamily, x: Array) -> None:
        image = family.matrix @ np.append(x, 1.0)
        length = float(np.linalg.norm(image))
        if length > 0.0:
            self._fix([Contact(family.name, 1.0, 0.0, 0.0, tuple((image / length).tolist()))])

    def _curve(self, k: Array) -> None:
        new = self.rows.places(k)
        self.places = new if self.places is None else self.places.joined(new)

    def _constraint_rows(self, box: Box) -> Array:
        """All rows of a box except the objective's: linear rows, curved rows at places, and what has no place."""
        parts = [self.fixed]
        if self.places is not None:
            count = len(self.places.k)
            parts += [
                self.rows.curved(box, self.places, name, np.full(count, sign)) for name, sign in self.rows.kinds(box)
            ]
        beside = self.rows.beside(box)
        self._beside = [contact for contact, _ in beside]
        return np.vstack([*parts, *(row[None] for _, row in beside)])

    def _contact(self, box: Box, row: int, multiplier: float) -> Contact | None:
        """The contact of a row by its number, with a multiplier; None for the objective's."""
        if row < len(self.contacts):
            return replace(self.contacts[row], multiplier=multiplier)
        k = np.empty(0) if self.places is None else self.places.k
        kinds, rest = self.rows.kinds(box), row - len(self.contacts)
        if rest < len(kinds) * len(k):
            name, sign = kinds[rest // len(k)]
            return Contact(name, sign, float(k[rest % len(k)]), multiplier)
        rest -= len(kinds) * len(k)
        return replace(self._beside[rest], multiplier=multiplier) if rest < len(self._beside) else None

    def scaled(self, box: Box) -> Linear:
        """The rows that may cut something off the box."""
        rows = self.rows
        every = np.vstack([self._constraint_rows(box), rows.objective()])
        centre, half = (box.low + box.high) / 2.0, (box.high - box.low) / 2.0
        matrix, right = every[:, :-1] * half, -every[:, -1] - every[:, :-1] @ centre
        length = np.abs(matrix).sum(axis=1)
        which = np.flatnonzero((length > right) & (length > _GRID_EMPTY * np.abs(every * rows.sizes).max(axis=1)))
        equations = rows.equations()
        equal, equal_right = equations[:, :-1] * half, -equations[:, -1] - equations[:, :-1] @ centre
        equal_length = np.abs(equal).sum(axis=1)
        divisor = np.where(
            equal_length > _GRID_EMPTY * np.minimum(1.0, np.abs(equations * rows.sizes).max(axis=1, initial=0.0)),
            equal_length,
            np.inf,
        )
        return Linear(
            matrix[which] / length[which, None],
            right[which] / length[which],
            length[which],
            which,
            equal / divisor[:, None],
            np.where(np.isfinite(divisor), equal_right / divisor, 0.0),
            divisor,
        )

    def nodes(self, box: Box, variables: Sequence[int]) -> tuple[list[Leaf], list[Array]]:
        """The tightenings of both sides of variables that linear programs prove, and their answers; or one leaf.

        A leaf shows that the box is empty; there are no answers then.
        """
        linear, half = self.scaled(box), (box.high - box.low) / 2.0
        goals = np.zeros((2 * len(variables), self.rows.size))
        each, sides = np.repeat(variables, 2), np.tile([1.0, -1.0], len(variables))
        goals[np.arange(len(goals)), each] = sides
        matrix = np.vstack([linear.matrix, linear.equal, -linear.equal])
        right = np.concatenate([linear.right, linear.equal_right, -linear.equal_right])
        weights, points = multipliers_in_cube(goals, matrix, right)
        empty = np.flatnonzero(np.isnan(points[:, 0]))
        if len(empty):
            return [self._leaf(box, linear, weights[empty[0]])], []
        leaves = (self._leaf(box, linear, row * half[i]) for row, i in zip(weights, each.tolist(), strict=True))
        nodes: list[Leaf] = [
            Tightening(leaf.contacts, leaf.equations, leaf.claim, variable=i, side=int(side))
            for leaf, i, side in zip(leaves, each.tolist(), sides.tolist(), strict=True)
        ]
        return nodes, list((box.low + box.high) / 2.0 + half * points)

    def _leaf(self, box: Box, linear: Linear, weights: Array) -> Leaf:
        """The sum of rows with weights, in which an equation is two rows."""
        count, equal = len(linear.matrix), len(linear.equal)
        multipliers = weights[:count] / linear.length
        contacts = []
        objective = 0.0
        for i in np.flatnonzero(multipliers > _GRID_LIGHT * multipliers.max(initial=0.0)).tolist():
            contact = self._contact(box, int(linear.which[i]), float(multipliers[i]))
            if contact is None:
                objective = float(multipliers[i])
            else:
                contacts.append(contact)
        pulls = (weights[count : count + equal] - weights[count + equal :]) / linear.equal_length
        return Leaf(tuple(contacts), tuple(pulls.tolist()), objective)


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
