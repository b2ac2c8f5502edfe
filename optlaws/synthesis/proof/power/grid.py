"""The rows of a box at finitely many places, scaled to the box, as a linear program."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import inf
from typing import Any

import numpy as np
from numpy.polynomial.chebyshev import chebpts2
from numpy.typing import NDArray

from optlaws.numbers import Array
from optlaws.synthesis.families.family import ConstraintFamily, LinearFamily, NormFamily
from optlaws.synthesis.proof.nodes import Contact, Leaf, Tightening
from optlaws.synthesis.proof.power.box import Box, BoxRows, Places
from optlaws.tolerances import GRID_EMPTY, GRID_LIGHT, GRID_NEAR

_PLACES = 16
_INFEASIBLE = 2
_TOLERANCES = {"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10}


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


def _solved(goal: Array, rows: tuple[Array, Array], equations: tuple[Array, Array], last: float = 1.0) -> Any:  # noqa: ANN401
    # scipy's result, imported late; its types know nothing of the tolerances
    from scipy.optimize import linprog

    solve: Any = linprog
    return solve(
        goal,
        A_ub=rows[0],
        b_ub=rows[1],
        A_eq=equations[0],
        b_eq=equations[1],
        bounds=[(-1.0, 1.0)] * (len(goal) - 1) + [(-1.0, last)],
        method="highs-ds",
        options=_TOLERANCES,
    )


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
            near = family.k(u[residual > -GRID_NEAR * max(self.rows.units[family.name], abs(family.right_side(x)))])
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
        self.contacts += contacts
        self.fixed = np.vstack([self.fixed, self.rows.of_contacts(contacts, self.rows.root())])

    def _norm(self, family: NormFamily, x: Array) -> None:
        image = family.matrix @ np.append(x, 1.0)
        length = float(np.linalg.norm(image))
        if length > 0.0:
            self._fix([Contact(family.name, 1.0, 0.0, 0.0, tuple((image / length).tolist()))])

    def _curve(self, k: Array) -> None:
        new = self.rows.places(k)
        self.places = new if self.places is None else self.places.joined(new)

    def _held(self, box: Box) -> Array:
        """All rows of a box except the objective's: linear rows, curved rows at places, rows of integrals."""
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
        every = np.vstack([self._held(box), rows.objective()])
        centre, half = (box.low + box.high) / 2.0, (box.high - box.low) / 2.0
        matrix, right = every[:, :-1] * half, -every[:, -1] - every[:, :-1] @ centre
        length = np.abs(matrix).sum(axis=1)
        which = np.flatnonzero((length > right) & (length > GRID_EMPTY * np.abs(every * rows.sizes).max(axis=1)))
        equations = rows.equations()
        equal, equal_right = equations[:, :-1] * half, -equations[:, -1] - equations[:, :-1] @ centre
        equal_length = np.abs(equal).sum(axis=1)
        divisor = np.where(
            equal_length > GRID_EMPTY * np.minimum(1.0, np.abs(equations * rows.sizes).max(axis=1, initial=0.0)),
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

    def node(self, box: Box, variable: int, side: int) -> tuple[Leaf | None, Array | None]:
        """The tightening that a linear program proves, and its answer; a leaf where it has none."""
        linear, size = self.scaled(box), self.rows.size
        goal = np.zeros(size)
        goal[variable] = side
        answer = _solved(goal, (linear.matrix, linear.right), (linear.equal, linear.equal_right))
        if answer.status == _INFEASIBLE:
            return self._empty(box, linear), None
        if answer.x is None:
            return None, None
        half = (box.high - box.low) / 2.0
        weights = (-answer.ineqlin.marginals * half[variable], -answer.eqlin.marginals * half[variable])
        point = (box.low + box.high) / 2.0 + half * answer.x
        leaf = self._leaf(box, linear, weights)
        return Tightening(leaf.contacts, leaf.equations, leaf.claim, variable=variable, side=side), point

    def _empty(self, box: Box, linear: Linear) -> Leaf | None:
        """Multipliers of the least common violation of the rows."""
        count, size = linear.matrix.shape
        goal = np.append(np.zeros(size), 1.0)
        matrix = np.column_stack([linear.matrix, -np.ones(count)])
        equal = np.column_stack([linear.equal, np.zeros(len(linear.equal))])
        answer = _solved(goal, (matrix, linear.right), (equal, linear.equal_right), inf)
        if answer.x is None:
            return None
        return self._leaf(box, linear, (-answer.ineqlin.marginals, -answer.eqlin.marginals))

    def _leaf(self, box: Box, linear: Linear, weights: tuple[Array, Array]) -> Leaf:
        multipliers = np.maximum(weights[0], 0.0) / linear.length
        least = GRID_LIGHT * float(multipliers.max(initial=0.0))
        contacts = []
        objective = 0.0
        for i, weight in zip(linear.which.tolist(), multipliers.tolist(), strict=True):
            if weight > least:
                contact = self._contact(box, i, weight)
                if contact is None:
                    objective = weight
                else:
                    contacts.append(contact)
        equations = tuple((weights[1] / linear.equal_length).tolist())
        return Leaf(tuple(contacts), equations, objective)
