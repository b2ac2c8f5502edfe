"""Trees over boxes in exact arithmetic: of D, and of peaks of formulas that are not convex."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import reduce
from itertools import combinations_with_replacement, product
from math import isfinite

from flint import arb, arb_mat, ctx

from optlaws.formulas.arithmetic import evaluate
from optlaws.formulas.slopes import derivative
from optlaws.formulas.tree import ORDERS, Formula, Reciprocal
from optlaws.kept import kept_property
from optlaws.synthesis.families import names
from optlaws.synthesis.families.names import RowName
from optlaws.synthesis.functionals.formula_rows import Branch
from optlaws.synthesis.functionals.kinds import FormulaPeak, FormulaValue
from optlaws.synthesis.problem.constants import Functional
from optlaws.synthesis.problem.expression import leaves
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.proof.certificate import Certificate
from optlaws.synthesis.proof.nodes import Contact, Leaf, Node, Split, Tightening, closes
from optlaws.synthesis.proof.power.rows import PEAKS, POWER_ROWS, Way, applies, applies_to_formulas
from optlaws.verification.enclosing.balls import BALLS, ball
from optlaws.verification.exact.law import known
from optlaws.verification.exact.rows import ExactRows, formula_windows
from optlaws.verification.machines.transfer import floor

Vector = list[arb]


@dataclass(frozen=True, eq=False)
class BallBox:
    """Points between the least and the greatest values, which are balls."""

    low: Vector
    high: Vector

    def cut(self, variable: int, *, low: arb | None = None, high: arb | None = None) -> BallBox:
        """The box with one side of a variable moved."""
        sides = [list(self.low), list(self.high)]
        for values, value in zip(sides, (low, high), strict=True):
            if value is not None:
                values[variable] = value
        return BallBox(*sides)

    def least(self, row: Vector) -> arb:
        """A lower bound of a row in the box, its constant last."""
        total = row[-1]
        for weight, low, high in zip(row, self.low, self.high, strict=False):
            total += (weight * low).min(weight * high)
        return total.lower()


class BoxSteps(ABC):
    """The nodes of a certificate's tree, applied again."""

    def __init__(self, certificate: Certificate) -> None:
        self.tree, self.problem, self.claim = certificate.tree, certificate.problem, certificate.claim or 0.0
        self.rows = ExactRows(certificate)
        self.points = [Fraction(k) for k in certificate.points or ()]
        velocities = [self.rows.space.values(1, k) for k in self.points]
        if len(velocities) != self.rows.space.terms:
            raise ZeroDivisionError
        self.inverse = arb_mat([row[:-1] for row in velocities]).inv()
        self.base = arb_mat(len(velocities), 1, [row[-1] for row in velocities])
        sublevel = self.rows.sublevel.greatest_values(Fraction(self.claim))
        self.greatest = {name: most for name, most in sublevel.items() if isinstance(most, Fraction)}
        start, change, stroke = self.rows.space.bounds
        self.stroke = abs(arb(stroke))
        self.ends = [
            ball(0) if start is None else arb(start),
            arb(0) if start is None or change is None else arb(start + change),
        ]
        self.B = self.greatest_velocity()

    @abstractmethod
    def greatest_velocity(self) -> arb:
        """An upper bound of |b| in the box."""

    @abstractmethod
    def own_sides(self, name: str) -> tuple[arb, arb]:
        """Least and greatest values of one of the program's own variables except B."""

    @abstractmethod
    def outer(self, k: Fraction) -> tuple[arb, arb]:
        """The range of b(k) in all laws below the claim."""

    @abstractmethod
    def curved(self, contact: Contact, box: BallBox) -> Vector | None:
        """The row of a contact that depends on the box; None for any other contact, or where it is useless."""

    def holds(self) -> bool:
        """Whether the tree leaves no box."""
        return closes(self.tree, [self.root()], self.after)

    def after(self, box: BallBox, node: Node) -> list[BallBox] | None:
        """The boxes that remain of a box after a node; None if it is no node of such boxes."""
        if isinstance(node, Split | Tightening) and not 0 <= node.variable < len(box.low):
            return None
        if isinstance(node, Split):
            at = ball(node.at)
            return [box.cut(node.variable, low=at), box.cut(node.variable, high=at)]
        return self.moved(box, node)

    def root(self) -> BallBox:
        """The box of all laws of the problem whose objective is below the claim."""
        brackets = [self.outer(k) for k in self.points]
        limits = self.problem.range("B")
        of_B = ball(0 if limits is None else limits.low), self.B
        constants = [of_B if name == "B" else self.own_sides(name) for name in self.rows.names]
        sides = [*brackets, *constants]
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
        """The row of a contact, at most 0; zeros where the problem has no such constraint."""
        curved = self.curved(contact, box)
        row = self.rows.row(contact) if curved is None else None
        if row is not None:
            return self.mapped(row.vector(self.rows.names))
        return [arb(0)] * (len(box.low) + 1) if curved is None else curved


_BITS = 256
_DEEPEST = 5


def tree_holds(certificate: Certificate) -> bool:
    """Whether the tree of a certificate over boxes leaves none with every rounding enclosed."""
    for constant in sorted(certificate.problem.constants, key=repr):
        known(constant)
    kind = _kind(certificate.problem)
    if kind is None:
        return False
    with ctx.workprec(_BITS):
        try:
            steps = kind(certificate)
            least = steps.rows.sublevel.least_values().values()
            # of a sum the nodes count on constants of at least 0
            return (len(least) == 1 or min(least) >= 0) and steps.holds()
        except ZeroDivisionError:
            # the points do not determine the law
            return False


def _kind(problem: Problem) -> type[BoxSteps] | None:
    if applies(problem):
        return _PowerProof
    return _FormulaProof if applies_to_formulas(problem) else None


class _PowerProof(BoxSteps):
    """The proof over boxes of a problem with D."""

    def greatest_velocity(self) -> arb:
        """Also b b changes by no more than 2 D."""
        reach = (max(self.ends, key=lambda end: float(abs(end))) ** 2 + self.D).sqrt()
        return ball(self.greatest["B"]).min(reach) if "B" in self.greatest else reach

    @kept_property
    def D(self) -> arb:
        """An upper bound of D in the box."""
        return ball(self.greatest["D"])

    @kept_property
    def anchors(self) -> list[tuple[Fraction, arb, arb]]:
        """Places at which the velocity is known to lie between two values."""
        known_at = [(Fraction(i), end, end) for i, end in enumerate(self.ends)]
        limits, peak = self.problem.range("B"), self.problem.peak_at
        if limits is not None and limits.low > 0.0 and peak is not None:
            known_at.append((Fraction(peak), ball(limits.low), self.B))
        return known_at

    def own_sides(self, name: str) -> tuple[arb, arb]:
        """Constants are at least 0."""
        return arb(0), ball(self.greatest[name])

    def outer(self, k: Fraction, anchors: Sequence[tuple[Fraction, arb, arb]] | None = None) -> tuple[arb, arb]:
        """The range of b(k), as b |b| changes no faster than 2 D."""
        low = high = None
        for at, least, most in self.anchors if anchors is None else anchors:
            change = 2 * self.D * ball(abs(k - at))
            below, above = _signed_root(least * abs(least) - change), _signed_root(most * abs(most) + change)
            low = below if low is None else low.max(below)
            high = above if high is None else high.min(above)
        assert low is not None  # noqa: S101 - both ends are there
        assert high is not None  # noqa: S101 - as above
        return (low.max(arb(0)) if self.problem.monotone else low), high.min(self.B)

    def curved(self, contact: Contact, box: BallBox) -> Vector | None:
        """The row of the power at a contact, zeros where it is useless."""
        if contact.constraint not in POWER_ROWS:
            return None
        return self.power(contact, box) or [arb(0)] * (len(box.low) + 1)

    def power(self, contact: Contact, box: BallBox) -> Vector | None:
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


class _FormulaProof(BoxSteps):
    """The proof over boxes of a problem with peaks of formulas that are not convex."""

    def greatest_velocity(self) -> arb:
        """An upper bound of the velocity: B, or bounds by the mean of |c| or |j| and the distance from the mean."""
        bounds = [ball(self.greatest["B"])] if "B" in self.greatest else []
        bounds += [self.stroke + ball(self.greatest[name]) for name in ("C", "rms_c") if name in self.greatest]
        drop = abs(self.ends[1] - self.ends[0])
        bounds += [self.stroke + drop + ball(self.greatest[name]) for name in ("J", "rms_j") if name in self.greatest]
        return reduce(lambda low, other: low.min(other), bounds) if bounds else arb.pos_inf()

    def own_sides(self, name: str) -> tuple[arb, arb]:
        """Bounds of a constant from its formula's values at the ends."""
        constants = (leaf for _, leaf in leaves(self.problem.objective) if isinstance(leaf, Functional))
        floors = {leaf.name: floor(leaf, self.problem.conditions) for leaf in constants}
        return ball(floors[name]), ball(self.greatest[name])

    def outer(self, k: Fraction) -> tuple[arb, arb]:
        """Within B, and where C is bounded within reach of the ends."""
        low, high = (arb(0) if self.problem.monotone else -self.B), self.B
        if "C" in self.greatest:
            for place, velocity in zip((Fraction(0), Fraction(1)), self.ends, strict=True):
                reach = ball(self.greatest["C"] * abs(k - place))
                low, high = low.max(velocity - reach), high.min(velocity + reach)
        return low, high

    def curved(self, contact: Contact, box: BallBox) -> Vector | None:
        """A plane that is nowhere above the formula."""
        branch_there = self._branches.get((contact.constraint, contact.sign))
        if branch_there is None:
            return None
        branch, way, slack, high = branch_there
        k = Fraction(contact.k)
        if not branch.motion.start <= k <= branch.motion.stop:
            return [arb(0)] * (len(box.low) + 1)
        names_of = sorted(branch.motion.formula.names() & ORDERS.keys())
        rows = [self.derivative(ORDERS[name], k) for name in names_of]
        ranges = [self._range(name, row, box, k) for name, row in zip(names_of, rows, strict=True)]
        plane = _plane(branch, way, dict(zip(names_of, ranges, strict=True)), k)
        if plane is None:
            return [arb(0)] * (len(box.low) + 1)
        slopes, height = plane
        row = [_dot(slopes, column) for column in zip(*rows, strict=True)]
        row[-1] += height - ball(high)
        for name, weight in slack.items():
            row[len(self.points) + self.rows.names.index(name)] += weight
        return row

    @kept_property
    def _branches(self) -> dict[tuple[str, float], tuple[Branch, Way, dict[str, float], float]]:
        """Formulas with the contact points of their planes and their bounds, by the names and signs of rows."""
        sought = (leaf for _, leaf in leaves(self.problem.objective) if isinstance(leaf, Functional))
        bounded: list[tuple[Functional, dict[str, float], float]] = [(leaf, {leaf.name: -1.0}, 0.0) for leaf in sought]
        bounded += [(constant, {}, limits.high) for constant, limits in self.problem.bounded if isfinite(limits.high)]
        curved = list[tuple[Branch, dict[str, float], float]]()
        curved += [(branch, {}, high) for branch, high in formula_windows(self.problem)]
        for constant, slack, high in bounded:
            if isinstance(constant, FormulaPeak | FormulaValue):
                curved += [(branch, slack, high) for branch in constant.branches(symmetric=self.problem.symmetric)]
        branches = {}
        for branch, slack, high in curved:
            count = len(branch.motion.formula.names() & ORDERS.keys())
            for i, way in enumerate([None, *product((-1, 1), repeat=count)]):
                branches[names.plane(i, branch.name), branch.sign] = (branch, way, slack, high)
        return branches

    def _range(self, name: str, row: Vector, box: BallBox, k: Fraction) -> tuple[arb, arb]:
        low, high = box.least(row), -box.least([-x for x in row])
        bound = self.outer(k) if name == "b" else None
        if bound is None and (most := self.greatest.get(PEAKS.get(name, ""))) is not None:
            bound = -ball(most), ball(most)
        if bound is not None:
            low, high = low.max(bound[0]), high.min(bound[1])
        return low.lower(), high.upper()


def _plane(branch: Branch, way: Way, ranges: dict[str, tuple[arb, arb]], k: Fraction) -> tuple[Vector, arb] | None:
    """Slopes by the derivatives and height of a plane below sign times the formula in the ranges.

    None where it has none. What Taylor's formula leaves is half the form of second derivatives somewhere in the ranges.
    """
    sides, sign, formula = list(ranges.values()), ball(branch.sign), branch.motion.formula
    if way is None:
        touch = [((low + high) / 2).mid() for low, high in sides]
    else:
        touch = [high if end > 0 else low for end, (low, high) in zip(way, sides, strict=True)]
    at = dict(zip(ranges, touch, strict=True)) | {"k": ball(k)}
    first = {name: derivative(formula, name) for name in ranges}
    slopes = [sign * evaluate(slope, at, BALLS) for slope in first.values()]
    height = sign * evaluate(formula, at, BALLS) - _dot(slopes, touch)
    if not branch.convex:
        for left, right in combinations_with_replacement(ranges, 2):
            bend = sign * _over(derivative(first[left], right), ranges, k)
            away = [[end - at[name] for end in ranges[name]] for name in (left, right)]
            # products of ends, for balls around products of ranges that begin at 0 would be wider by a half
            ends = [x * y for x, y in product(*away)] if left != right else [arb(0), *(x * x / 2 for x in away[0])]
            height += _least([bend.lower() * end for end in ends] + [bend.upper() * end for end in ends])
    finite = height.is_finite() and all(slope.is_finite() for slope in slopes)
    return (slopes, height) if finite else None


def _over(formula: Formula, ranges: dict[str, tuple[arb, arb]], k: Fraction, depth: int = 0) -> arb:
    """A ball that holds a formula in the ranges: by parts of those that divide, for balls of quotients are wide."""
    divisors = (part for part in formula.different if isinstance(part, Reciprocal))
    dividing = {name for divisor in divisors for name in divisor.names()} & ranges.keys()
    if depth == (_DEEPEST if dividing else 0):
        within = {name: low.union(high) for name, (low, high) in ranges.items()} | {"k": ball(k)}
        whole: arb = evaluate(formula, within, BALLS)
        return whole
    widest = max(sorted(dividing), key=lambda name: float(ranges[name][1] - ranges[name][0]))
    low, high = ranges[widest]
    middle = ((low + high) / 2).mid()
    halves = (_over(formula, ranges | {widest: half}, k, depth + 1) for half in ((low, middle), (middle, high)))
    return reduce(arb.union, halves)


def _least(values: Sequence[arb]) -> arb:
    return reduce(lambda value, other: value.min(other), values).lower()


def _dot(row: Sequence[arb], other: Sequence[arb]) -> arb:
    return sum((x * y for x, y in zip(row, other, strict=True)), arb(0))


def _signed_root(square: arb) -> arb:
    if square >= 0:
        return square.sqrt()
    if square < 0:
        return -(-square).sqrt()
    return abs(square).sqrt().union(-abs(square).sqrt())
