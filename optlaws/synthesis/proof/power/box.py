"""Boxes that hold laws, and the rows of a problem over their variables.

A box bounds the velocity at as many places as the laws have coordinates, so it bounds every linear function of the
law.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from optlaws.kept import kept_property
from optlaws.numbers import Array
from optlaws.synthesis.families.family import ConstraintFamily
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.program.writer import model_of
from optlaws.synthesis.proof.duality import row_of
from optlaws.synthesis.proof.nodes import Contact, Leaf, Node, Split, Tightening
from optlaws.tolerances import ENERGY_ROUNDING

_WORST = 1e10


@dataclass(frozen=True, eq=False)
class Box:
    """Least and greatest values of the variables: velocities at the points, then the program's own variables."""

    low: Array
    high: Array

    def cut(self, variable: int, side: int, value: float) -> Box:
        """The box with one side moved: from below (side 1) or from above (-1)."""
        name = "low" if side > 0 else "high"
        values = getattr(self, name).copy()
        values[variable] = value
        return replace(self, **{name: values})

    def extent(self, rows: Array) -> tuple[Array, Array]:
        """Least and greatest values in the box of affine functions, a row each with the constant last."""
        rising, falling = np.maximum(rows[:, :-1], 0.0), np.minimum(rows[:, :-1], 0.0)
        least = rising @ self.low + falling @ self.high + rows[:, -1]
        return least, rising @ self.high + falling @ self.low + rows[:, -1]


@dataclass(frozen=True, eq=False)
class Places:
    """Places k with rows over a box's variables, a matrix for each quantity in the curved rows."""

    k: Array
    rows: tuple[Array, ...]

    def joined(self, other: Places) -> Places:
        """The places with others joined to them."""
        rows = tuple(np.vstack(pair) for pair in zip(self.rows, other.rows, strict=True))
        return Places(np.append(self.k, other.k), rows)


class BoxRows(ABC):
    """The rows of a problem under a claim, over the velocities at some points and the program's own variables.

    Parameters
    ----------
    problem
        Whose laws are spoken of.
    claim
        Laws with an objective below it.
    points
        As many k in [0, 1] as the laws have coordinates, at which the velocities determine the law.
    """

    #: variables beyond the program's own
    extra = 0

    def __init__(self, problem: Problem, claim: float, points: Sequence[float]) -> None:
        self.problem, self.claim, self.points = problem, claim, np.array(points, dtype=np.float64)
        self.model = model_of(problem, scaled=False)
        scaled = model_of(problem)
        #: of what size the rows of each family are, and each variable of a box and the number 1
        self.units = {family.name: family.unit for family in scaled.program.families}
        self.sizes = np.concatenate([scaled.variable_scales, np.ones(self.extra + 1)])
        self.space = self.model.space
        self.terms, self.variables = self.space.terms, self.model.program.size
        self.size = self.variables + self.extra
        self._families = {nu: self.space.derivative(nu, "", np.zeros(self.variables)) for nu in (1, 2)}
        self._of_places: dict[float, tuple[Array, ...]] = {}
        self._of_contacts: dict[tuple[object, ...], Array] = {}

    @abstractmethod
    def root(self) -> Box:
        """The box of all laws of the problem whose objective is below the claim."""

    def roots(self) -> list[Box]:
        """The regions at the root of a tree: that box alone."""
        return [self.root()]

    @abstractmethod
    def brackets_at(self, k: Array) -> tuple[Array, Array]:
        """Least and greatest velocity at the places k in all laws below the claim."""

    @abstractmethod
    def is_curved(self, family: ConstraintFamily) -> bool:
        """Whether a family's rows depend on the box."""

    @abstractmethod
    def places(self, k: Array) -> Places:
        """Coefficients of the curved rows at places k."""

    @abstractmethod
    def kinds(self, box: Box) -> list[tuple[str, float]]:
        """Names and signs of the curved rows that are useful in a box."""

    @abstractmethod
    def curved(self, box: Box, places: Places, name: str, signs: Array) -> Array:
        """Rows of a name in a box, each at most 0 with its constant; zeros where they are useless."""

    @property
    @abstractmethod
    def names(self) -> tuple[str, ...]:
        """Names of all possible curved rows."""

    @property
    def tightens(self) -> bool:
        """Whether all rows are at least as good in a part of the box; not where they touch at laws of the box."""
        return False

    @property
    def alone(self) -> tuple[str, ...]:
        """Names of the rows without a place."""
        return ()

    def beside(self, box: Box) -> list[tuple[Contact, Array]]:
        """Further rows of a box, each at most 0 with its constant, by contacts without multipliers."""
        del box
        return []

    @property
    def branched(self) -> list[int]:
        """The variables, besides the velocities, for which a split is useful."""
        return []

    @property
    def regular(self) -> bool:
        """Whether the velocities at the points determine the law, with digits to spare."""
        if len(self.points) != self.terms:
            return False
        return float(np.linalg.cond(self.rows(1, self.points)[:, : self.terms])) < _WORST

    @kept_property
    def _map(self) -> tuple[Array, Array]:
        """The matrix from velocities at the points to coordinates, and the negative coordinates of zero velocities."""
        columns = self.rows(1, self.points)[:, [*range(self.terms), -1]]
        inverse: Array = np.linalg.inv(columns[:, :-1]).astype(np.float64)
        return inverse, inverse @ columns[:, -1]

    def coordinates(self, values: Array) -> Array:
        """The coordinates of the law whose velocities at the points are the first of the values."""
        inverse, base = self._map
        coordinates: Array = inverse @ values[: self.terms] - base
        return coordinates

    def mapped(self, rows: Array) -> Array:
        """Rows over the program's variables, the constant last, converted to rows over a box's variables."""
        inverse, base = self._map
        free, nothing = rows[:, : self.terms], np.zeros((len(rows), self.extra))
        variables = rows[:, self.terms : -1]
        return np.column_stack([free @ inverse, variables, nothing, rows[:, -1] - free @ base])

    def rows(self, nu: int, k: Array) -> Array:
        """The law's derivative at the places k over the program's variables, the constant last."""
        family = self._families[nu]
        values: Array = family.columns(family.u(k))[0]
        return values

    def derivative(self, nu: int, k: Array) -> Array:
        """Rows of a derivative at places, over the variables of a box."""
        return self.mapped(self.rows(nu, k))

    def of_contacts(self, contacts: Sequence[Contact], box: Box) -> Array:
        """The rows of contacts, each at most 0 with its constant: zeros where the problem does not have it."""
        stacked, beside = np.zeros((len(contacts), self.size + 1)), dict[str, Array]()
        if any(contact.constraint in self.alone for contact in contacts):
            beside = {contact.constraint: row for contact, row in self.beside(box)}
        for name in self.names:
            mine = [i for i, contact in enumerate(contacts) if contact.constraint == name]
            if mine:
                places = self._places_at([contacts[i].k for i in mine])
                stacked[mine] = self.curved(box, places, name, np.array([contacts[i].sign for i in mine]))
        for i, contact in enumerate(contacts):
            if contact.constraint in self.alone:
                stacked[i] = beside[contact.constraint]
            elif contact.constraint not in self.names:
                stacked[i] = self._fixed_row(contact)
        return stacked

    def _places_at(self, k: Sequence[float]) -> Places:
        """Coefficients of the curved rows at places, of which a proof speaks again and again."""
        new = [place for place in dict.fromkeys(k) if place not in self._of_places]
        if new:
            rows = zip(*self.places(np.array(new)).rows, strict=True)
            self._of_places |= zip(new, rows, strict=True)
        together = zip(*(self._of_places[place] for place in k), strict=True)
        return Places(np.array(k), tuple(map(np.array, together)))

    def _fixed_row(self, contact: Contact) -> Array:
        """The row of a contact that does not depend on the box."""
        key = (contact.constraint, contact.sign, contact.k, contact.direction)
        if key not in self._of_contacts:
            row, right = row_of(self.model.program, contact)
            self._of_contacts[key] = self.mapped(np.append(row, -right)[None])[0]
        return self._of_contacts[key]

    def equations(self) -> Array:
        """The program's equations, each 0 with its constant."""
        return self._sums[:-1]

    def objective(self) -> Array:
        """The objective less the claim, at most 0."""
        return np.asarray(self._sums[-1])

    @kept_property
    def _sums(self) -> Array:
        """The equations, and the objective less the claim, over the variables of a box."""
        program, nothing = self.model.program, np.zeros(self.extra)
        equations = self.mapped(np.column_stack([program.equalities, -program.right]))
        return np.vstack([equations, np.concatenate([program.objective, nothing, [-self.claim / self.model.unit]])])

    def after(self, box: Box, node: Node) -> list[Box] | None:
        """The boxes that a node leaves of one; None where it speaks of no variable of theirs."""
        if isinstance(node, Split | Tightening) and not 0 <= node.variable < self.size:
            return None
        if isinstance(node, Split):
            return [box.cut(node.variable, 1, node.at), box.cut(node.variable, -1, node.at)]
        return self.moved(box, node)

    def moved(self, box: Box, node: Leaf, *, rounded: int = -1) -> list[Box]:
        """The box after a sum of rows, rounded as by `least_sum`, has moved its side; none if it is empty.

        Rows that the problem does not have, and negative multipliers of rows, count as zero.
        """
        value = self.least_sum(box, node, rounded=rounded)
        if not isinstance(node, Tightening):
            return [] if value > 0.0 else [box]
        side = node.side * value
        low, high = float(box.low[node.variable]), float(box.high[node.variable])
        if (node.side > 0 and side > high) or (node.side < 0 and side < low):
            return []
        return [box.cut(node.variable, node.side, side)] if low < side < high else [box]

    def least_sum(self, box: Box, node: Leaf, *, rounded: int = -1) -> float:
        """A lower bound of side times the variable in the box, by the sum of the rows, which is at most 0.

        It is not above what exact arithmetic gives; with `rounded` 1 it is not below that, and proves nothing.
        """
        equations = self.equations()[: len(node.equations)]
        joined = np.vstack([self.of_contacts(node.contacts, box), equations, self.objective()])
        multipliers = [max(contact.multiplier, 0.0) for contact in node.contacts]
        weights = np.array([*multipliers, *node.equations[: len(equations)], max(node.claim, 0.0)])
        moved = np.zeros(self.size + 1)
        if isinstance(node, Tightening):
            moved[node.variable] = float(node.side)
        total = moved + weights @ joined
        size = np.abs(moved) + np.abs(weights) @ np.abs(joined)
        greatest = np.append(np.maximum(np.abs(box.low), np.abs(box.high)), 1.0)
        return float(box.extent(total[None])[0][0]) + rounded * ENERGY_ROUNDING * float(size @ greatest)
