"""Trees over boxes with every rounding enclosed: boxes with sides rounded outward, sums of rows in balls.

Nothing has to be corrected. What the multipliers leave of a coordinate costs its least value in the box, so that the
nodes prove what they prove, whatever they are.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from fractions import Fraction
from math import isfinite

from flint import arb, arb_mat

from optlaws.synthesis.proof.certificate import Certificate
from optlaws.synthesis.proof.nodes import Contact, Leaf, Split, Tightening
from optlaws.verification.enclosing.balls import ball
from optlaws.verification.exact.rows import ExactRows
from optlaws.verification.exact.sublevel_bounds import greatest_values

Vector = list[arb]


@dataclass(frozen=True, eq=False)
class BallBox:
    """Points that are nowhere above the least values, and nowhere below the greatest."""

    low: Vector
    high: Vector

    def cut(self, variable: int, *, low: arb | None = None, high: arb | None = None) -> BallBox:
        """With a side of a variable moved."""
        sides = [list(self.low), list(self.high)]
        for values, value in zip(sides, (low, high), strict=True):
            if value is not None:
                values[variable] = value
        return BallBox(*sides)

    def least(self, row: Vector) -> arb:
        """What a row, its constant last, is at least."""
        total = row[-1]
        for weight, low, high in zip(row, self.low, self.high, strict=False):
            total += (weight * low).min(weight * high)
        return total.lower()


class BoxSteps(ABC):
    """The nodes of a certificate's tree, applied again.

    Parameters
    ----------
    certificate
        Whose tree.

    Raises
    ------
    ZeroDivisionError
        If the points do not determine the law.
    """

    def __init__(self, certificate: Certificate) -> None:
        self.tree, self.problem, self.claim = certificate.tree, certificate.problem, certificate.claim or 0.0
        self.rows = ExactRows(certificate)
        self.points = [Fraction(k) for k in certificate.points or ()]
        velocities = [self.rows.space.values(1, k) for k in self.points]
        if len(velocities) != self.rows.space.terms:
            raise ZeroDivisionError
        self.inverse = arb_mat([row[:-1] for row in velocities]).inv()
        self.base = arb_mat(len(velocities), 1, [row[-1] for row in velocities])
        sublevel = greatest_values(certificate, self.rows, self.claim)
        self.greatest = {name: Fraction(most) for name, most in sublevel.items() if isfinite(most)}
        start, change, stroke = self.rows.space.bounds
        self.stroke = abs(arb(stroke))
        self.ends = [
            ball(0) if start is None else arb(start),
            arb(0) if start is None or change is None else arb(start + change),
        ]
        self.B = self.greatest_velocity()

    @abstractmethod
    def greatest_velocity(self) -> arb:
        """What |b| is at most."""

    @abstractmethod
    def own_sides(self, name: str) -> tuple[arb, arb]:
        """Least and greatest values of one of the program's own variables but B."""

    @abstractmethod
    def outer(self, k: Fraction) -> tuple[arb, arb]:
        """Between what values b(k) is in every law below the claim."""

    @abstractmethod
    def curved(self, contact: Contact, box: BallBox) -> Vector | None:
        """The row of a contact that depends on the box; None where it is no such row, or says nothing there."""

    def holds(self) -> bool:
        """Whether the tree leaves no box."""
        boxes = [self.root()]
        for node in self.tree:
            if not boxes:
                return False
            if isinstance(node, Split | Tightening) and not 0 <= node.variable < len(boxes[-1].low):
                return False
            box = boxes.pop()
            if isinstance(node, Split):
                at = ball(node.at)
                boxes += [box.cut(node.variable, low=at), box.cut(node.variable, high=at)]
            else:
                boxes += self.moved(box, node)
        return not boxes

    def root(self) -> BallBox:
        """The box of all laws of the problem whose objective is below the claim."""
        brackets = [self.outer(k) for k in self.points]
        asked = self.problem.range("B")
        of_B = ball(0 if asked is None else asked.low), self.B
        own = [of_B if name == "B" else self.own_sides(name) for name in self.rows.names]
        sides = [*brackets, *own]
        return BallBox([low.lower() for low, _ in sides], [high.upper() for _, high in sides])

    def moved(self, box: BallBox, node: Leaf) -> list[BallBox]:
        """The box after a sum of rows, none if it is empty."""
        total = [arb(0)] * (len(box.low) + 1)
        if isinstance(node, Tightening):
            total[node.variable] = arb(node.side)
        parts = [(max(contact.multiplier, 0.0), self.contact(contact, box)) for contact in node.contacts]
        equations = [self.mapped(row.vector(self.rows.names)) for row in self.rows.equations]
        parts += zip(node.equations, equations, strict=False)
        cost = [ball(self.rows.cost.get(name, 0.0)) for name in self.rows.names]
        parts.append((max(node.claim, 0.0), [*[arb(0)] * len(self.points), *cost, -ball(self.claim)]))
        for weight, row in parts:
            total = [x + ball(weight) * y for x, y in zip(total, row, strict=True)]
        least = box.least(total)
        if not isinstance(node, Tightening):
            return [] if least > 0 else [box]
        low, high = box.low[node.variable], box.high[node.variable]
        if node.side > 0:
            return [] if least > high else [box.cut(node.variable, low=low.max(least))]
        return [] if -least < low else [box.cut(node.variable, high=high.min(-least))]

    def mapped(self, vector: Vector) -> Vector:
        """A row over the coordinates as one over the variables of a box."""
        terms = len(self.points)
        weights = arb_mat(1, terms, vector[:terms]) * self.inverse
        shift = (weights * self.base).entries()[0]
        return [*weights.entries(), *vector[terms:-1], vector[-1] - shift]

    def derivative(self, nu: int, k: Fraction) -> Vector:
        """The law's derivative at k over the variables of a box."""
        *free, base = self.rows.space.values(nu, k)
        return self.mapped([*free, *[arb(0)] * len(self.rows.names), base])

    def contact(self, contact: Contact, box: BallBox) -> Vector:
        """The row of a contact, at most 0; zeros where the problem asks for nothing of the kind."""
        curved = self.curved(contact, box)
        row = self.rows.row(contact) if curved is None else None
        if row is not None:
            return self.mapped(row.vector(self.rows.names))
        return [arb(0)] * (len(box.low) + 1) if curved is None else curved
