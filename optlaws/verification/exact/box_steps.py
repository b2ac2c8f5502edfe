"""Steps of power certificates with every rounding enclosed: boxes with sides rounded outward, sums of rows in balls.

Nothing has to be corrected. What the multipliers leave of a coordinate costs its least value in the box, so that the
steps prove what they prove, whatever they are.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from fractions import Fraction

from flint import arb, arb_mat

from optlaws.synthesis.problem.expression import Expression, Maximum
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.proof.certificate import Certificate, Contact
from optlaws.synthesis.proof.power.certificate import Cut, PowerCertificate, Step
from optlaws.verification.enclosing.balls import ball
from optlaws.verification.exact.rows import ExactRows

Vector = list[arb]


@dataclass(frozen=True, eq=False)
class Box:
    """Points that are nowhere above the least values, and nowhere below the greatest."""

    low: Vector
    high: Vector

    def cut(self, variable: int, *, low: arb | None = None, high: arb | None = None) -> Box:
        """With a side of a variable moved."""
        sides = [list(self.low), list(self.high)]
        for values, value in zip(sides, (low, high), strict=True):
            if value is not None:
                values[variable] = value
        return Box(*sides)

    def least(self, row: Vector) -> arb:
        """What a row, its constant last, is at least."""
        total = row[-1]
        for weight, low, high in zip(row, self.low, self.high, strict=False):
            total += (weight * low).min(weight * high)
        return total.lower()


class BoxSteps(ABC):
    """The steps of a certificate, done again.

    Parameters
    ----------
    certificate
        Whose steps.

    Raises
    ------
    ZeroDivisionError
        If the points do not determine the law.
    """

    def __init__(self, certificate: PowerCertificate) -> None:
        self.certificate, self.problem = certificate, certificate.problem
        self.rows = ExactRows(Certificate(certificate.problem, (), ()))
        self.points = [Fraction(k) for k in certificate.points]
        velocities = [self.rows.space.values(1, k) for k in self.points]
        if len(velocities) != self.rows.space.terms:
            raise ZeroDivisionError
        self.inverse = arb_mat([row[:-1] for row in velocities]).inv()
        self.base = arb_mat(len(velocities), 1, [row[-1] for row in velocities])
        self.greatest = greatest_of(self.problem, Fraction(certificate.claim))
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
    def curved(self, contact: Contact, box: Box) -> Vector | None:
        """The row of a contact that depends on the box; None where it is no such row, or says nothing there."""

    def holds(self) -> bool:
        """Whether the steps empty every box."""
        boxes = [self.root()]
        for step in self.certificate.steps:
            if not boxes or not -1 <= step.variable < len(boxes[-1].low):
                return False
            box = boxes.pop()
            if isinstance(step, Cut):
                if step.variable < 0:
                    return False
                at = ball(step.at)
                boxes += [box.cut(step.variable, low=at), box.cut(step.variable, high=at)]
            else:
                boxes += self.moved(box, step)
        return not boxes

    def root(self) -> Box:
        """The box of all laws of the problem whose objective is below the claim."""
        brackets = [self.outer(k) for k in self.points]
        asked = self.problem.range("B")
        of_B = ball(0 if asked is None else asked.low), self.B
        own = [of_B if name == "B" else self.own_sides(name) for name in self.rows.names]
        sides = [*brackets, *own]
        return Box([low.lower() for low, _ in sides], [high.upper() for _, high in sides])

    def moved(self, box: Box, step: Step) -> list[Box]:
        """The box after a step, none if it is empty."""
        total = [arb(0)] * (len(box.low) + 1)
        if step.variable >= 0:
            total[step.variable] = arb(step.side)
        parts = [(max(contact.multiplier, 0.0), self.contact(contact, box)) for contact in step.contacts]
        equations = [self.mapped(row.vector(self.rows.names)) for row in self.rows.equations]
        parts += zip(step.equations, equations, strict=False)
        cost = [ball(self.rows.cost.get(name, 0.0)) for name in self.rows.names]
        parts.append((max(step.claim, 0.0), [*[arb(0)] * len(self.points), *cost, -ball(self.certificate.claim)]))
        for weight, row in parts:
            total = [x + ball(weight) * y for x, y in zip(total, row, strict=True)]
        least = box.least(total)
        if step.variable < 0:
            return [] if least > 0 else [box]
        low, high = box.low[step.variable], box.high[step.variable]
        if step.side > 0:
            return [] if least > high else [box.cut(step.variable, low=low.max(least))]
        return [] if -least < low else [box.cut(step.variable, high=high.min(-least))]

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

    def contact(self, contact: Contact, box: Box) -> Vector:
        """The row of a contact, at most 0; zeros where the problem asks for nothing of the kind."""
        curved = self.curved(contact, box)
        row = self.rows.row(contact) if curved is None else None
        if row is not None:
            return self.mapped(row.vector(self.rows.names))
        return [arb(0)] * (len(box.low) + 1) if curved is None else curved


def greatest_of(problem: Problem, claim: Fraction) -> dict[str, Fraction]:
    """What the constants of the objective, and those that are bounded, are at most in laws below the claim."""
    greatest: dict[str, Fraction] = {}

    def spread(expression: Expression, most: Fraction) -> None:
        for weight, term in expression.terms:
            share = most / Fraction(weight)
            greatest[repr(term)] = min(greatest.get(repr(term), share), share)
            if isinstance(term, Maximum):
                for part in term.parts:
                    spread(part, share)

    spread(problem.objective, claim)
    for name in ("B", *(constant.name for constant, _ in problem.bounded)):
        asked = problem.range(name)
        if asked is not None and asked.high < float("inf"):
            high = Fraction(asked.high)
            greatest[name] = min(greatest.get(name, high), high)
    return greatest
