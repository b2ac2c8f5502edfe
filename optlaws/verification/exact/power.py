"""A power certificate with every rounding enclosed: boxes with sides rounded outward, sums of rows in balls.

Nothing has to be corrected. What the multipliers leave of a coordinate costs its least value in the box, so that the
steps prove what they prove, whatever they are.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from flint import arb, arb_mat, ctx

from optlaws.synthesis.families.names import RowName
from optlaws.synthesis.problem.expression import Expression, Maximum
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.proof.certificate import Certificate, Contact
from optlaws.synthesis.proof.power.certificate import Cut, PowerCertificate, Step
from optlaws.synthesis.proof.power.rows import POWER_ROWS, applies
from optlaws.verification.enclosing.balls import ball
from optlaws.verification.exact.known_constants import known
from optlaws.verification.exact.rows import ExactRows

Vector = list[arb]
_BITS = 256


@dataclass(frozen=True, eq=False)
class _Box:
    """Points that are nowhere above the least values, and nowhere below the greatest."""

    low: Vector
    high: Vector

    def cut(self, variable: int, *, low: arb | None = None, high: arb | None = None) -> _Box:
        sides = [list(self.low), list(self.high)]
        for values, value in zip(sides, (low, high), strict=True):
            if value is not None:
                values[variable] = value
        return _Box(*sides)

    def least(self, row: Vector) -> arb:
        """What a row, its constant last, is at least."""
        total = row[-1]
        for weight, low, high in zip(row, self.low, self.high, strict=False):
            total += (weight * low).min(weight * high)
        return total.lower()


def prove_power(certificate: PowerCertificate) -> Fraction | None:
    """The claim of a power certificate if its steps prove it with every rounding enclosed, else None.

    Raises
    ------
    InputError
        If the problem has a constant that nobody has put into exact arithmetic, such as one of a loader.

    Examples
    --------
    >>> from optlaws import Problem, synthesize
    >>> solution = synthesize(Problem(B=1.641, order=4, minimise="D"), bound="tight")
    >>> float(prove_power(solution.power_certificate)) == solution.lower_bound
    True
    """
    for constant in sorted(certificate.problem.constants, key=repr):
        known(constant)
    if not applies(certificate.problem):
        return None
    with ctx.workprec(_BITS):
        try:
            proven = _Proof(certificate).holds()
        except ZeroDivisionError:
            # the points do not determine the law
            proven = False
    return Fraction(certificate.claim) if proven else None


class _Proof:
    def __init__(self, certificate: PowerCertificate) -> None:
        self.certificate, self.problem = certificate, certificate.problem
        self.rows = ExactRows(Certificate(certificate.problem, (), ()))
        self.points = [Fraction(k) for k in certificate.points]
        velocities = [self.rows.space.values(1, k) for k in self.points]
        if len(velocities) != self.rows.space.terms:
            raise ZeroDivisionError
        self.inverse = arb_mat([row[:-1] for row in velocities]).inv()
        self.base = arb_mat(len(velocities), 1, [row[-1] for row in velocities])
        self.greatest = _greatest(self.problem, Fraction(certificate.claim))
        start, change, _ = self.rows.space.bounds
        ends = [
            ball(0) if start is None else arb(start),
            arb(0) if start is None or change is None else arb(start + change),
        ]
        self.D = ball(self.greatest["D"])
        reach = (max(ends, key=lambda end: float(abs(end))) ** 2 + self.D).sqrt()
        self.B = ball(self.greatest["B"]).min(reach) if "B" in self.greatest else reach
        self.anchors = [(Fraction(0), ends[0], ends[0]), (Fraction(1), ends[1], ends[1])]
        asked, peak = self.problem.range("B"), self.problem.peak_at
        if asked is not None and asked.low > 0.0 and peak is not None:
            self.anchors.append((Fraction(peak), ball(asked.low), self.B))

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

    def root(self) -> _Box:
        """The box of all laws of the problem whose objective is below the claim."""
        brackets = [self.outer(k) for k in self.points]
        asked = self.problem.range("B")
        low = [ball(asked.low) if name == "B" and asked is not None else arb(0) for name in self.rows.names]
        high = [self.B if name == "B" else ball(self.greatest[name]) for name in self.rows.names]
        return _Box(
            [least.lower() for least, _ in brackets] + low,
            [most.upper() for _, most in brackets] + [x.upper() for x in high],
        )

    def moved(self, box: _Box, step: Step) -> list[_Box]:
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

    def outer(self, k: Fraction, anchors: Sequence[tuple[Fraction, arb, arb]] | None = None) -> tuple[arb, arb]:
        """Between what values b(k) is: b |b| changes no faster than 2 D."""
        low = high = None
        for at, least, most in self.anchors if anchors is None else anchors:
            change = 2 * self.D * ball(abs(k - at))
            below, above = _signed_root(least * abs(least) - change), _signed_root(most * abs(most) + change)
            low = below if low is None else low.max(below)
            high = above if high is None else high.min(above)
        assert low is not None  # noqa: S101 - both ends are there
        assert high is not None  # noqa: S101
        return (low.max(arb(0)) if self.problem.monotone else low), high.min(self.B)

    def contact(self, contact: Contact, box: _Box) -> Vector:
        """The row of a contact, at most 0; zeros where the problem asks for nothing of the kind."""
        nothing = [arb(0)] * (len(box.low) + 1)
        if contact.constraint in POWER_ROWS:
            return self.power(contact, box) or nothing
        row = self.rows.row(contact)
        return nothing if row is None else self.mapped(row.vector(self.rows.names))

    def power(self, contact: Contact, box: _Box) -> Vector | None:
        """S c <= D / |b| by the chord of 1 / |b|; None where the box does not keep b from zero."""
        k = Fraction(contact.k)
        velocity = self.derivative(1, k)
        known = [*self.anchors, *zip(self.points, box.low, box.high, strict=False)]
        low, high = self.outer(k, known)
        low, high = low.max(box.least(velocity)).lower(), high.min(-box.least([-x for x in velocity])).upper()
        forth = 1 if low > 0 else -1
        near, far = (low, high) if forth > 0 else (-high, -low)
        if not near > 0 or not far >= near:
            return None
        place = len(self.points) + self.rows.names.index("D") if "D" in self.rows.names else None
        least = contact.constraint == RowName.POWER_FROM_LEAST
        D = self.D if place is None else (box.low if least else box.high)[place]
        row = [ball(contact.sign) * x for x in self.derivative(2, k)]
        row = [x + forth * D / (near * far) * y for x, y in zip(row, velocity, strict=True)]
        row[-1] -= D / near + D / far
        if place is not None:
            other = near if least else far
            row[place] -= 1 / other
            row[-1] += D / other
        return row


def _signed_root(square: arb) -> arb:
    if square >= 0:
        return square.sqrt()
    if square < 0:
        return -(-square).sqrt()
    return abs(square).sqrt().union(-abs(square).sqrt())


def _greatest(problem: Problem, claim: Fraction) -> dict[str, Fraction]:
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
