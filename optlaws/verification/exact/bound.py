"""The bounds that a certificate and closed forms prove, with every rounding enclosed.

The rows that a certificate names are added up with its multipliers as they are written. What the sum still depends on
is charged: by how much it can lower the sum in laws that contradict the claim, whose constants, and with them the mean
magnitudes of derivatives, are bounded. Where nothing bounds such laws, or the charge is not small beside the sum, the
multipliers are repaired: changed as little as makes the sum depend on nothing, which balls enclose.

Closed forms prove for laws of any degree a lower bound of what is minimised, and a time that none is faster than. A
phase that gains a velocity takes no less than its segments, and both phases with the greatest velocity between them
cover the stroke (docs/how-to/least-time.md). A velocity with which they cover less is below the greatest of the fastest
motion, whose phases therefore take more: so roots that are rounded down bound its time from below.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import partial
from math import factorial, inf, isfinite, isqrt
from typing import NamedTuple

from flint import arb, arb_mat, ctx

from optlaws.errors import InputError
from optlaws.numerics.exact import rounded_up
from optlaws.synthesis.least_time.move_limits import phase
from optlaws.synthesis.least_time.timed_move import TimedMove
from optlaws.synthesis.limits.of_problem import limit_of_sum
from optlaws.synthesis.problem.constants import Combined, Functional, PeakConstant
from optlaws.synthesis.problem.expression import leaves
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.proof.certificate import VIOLATION, Certificate
from optlaws.synthesis.proof.duality import Number, Sublevel
from optlaws.synthesis.proof.nodes import Contact, Leaf, Node, PlaceRange, closes
from optlaws.synthesis.proof.peak_rows import CLAIM, peak_of, roots_of
from optlaws.verification.enclosing.balls import ball, lower, upper
from optlaws.verification.exact.boxes import tree_holds
from optlaws.verification.exact.law import known
from optlaws.verification.exact.rows import BallRow, ExactRows
from optlaws.verification.machines.transfer import floor

Vector = list[arb]


def summed(weights: Sequence[arb], vectors: Sequence[Vector]) -> Vector:
    """Weighted vectors, added up."""
    return list((arb_mat([list(weights)]) * arb_mat(list(vectors))).entries())


def charge(sublevel: Sublevel, rows: ExactRows, total: Vector, claim: Fraction) -> arb | None:
    """The most by which a sum's slopes can lower it in laws below the claim; None where nothing bounds it."""
    greatest, least = sublevel.greatest_values(claim), sublevel.least_values()
    terms, beyond = rows.space.terms, arb(0)
    for name, slope in zip(rows.names, total[terms:-1], strict=True):
        # a rising slope lowers the sum most where the constant is least, a falling one where it is greatest
        low = Fraction(0) if bool(slope <= 0) else least.get(name, Fraction(0))
        high = Fraction(0) if bool(slope >= 0) else greatest.get(name, inf)
        if not (isfinite(low) and isfinite(high)):
            return None
        beyond -= slope.max(arb(0)) * ball(low) + slope.min(arb(0)) * ball(high)
    slopes = total[:terms]
    if all(slope.is_zero() for slope in slopes):
        return beyond
    bounded = sublevel.means(greatest)
    known = [(rows.space.moments(nu), ball(mean)) for nu, mean in bounded.items()]
    if not bounded:
        # an output may determine the law where nothing else says how large it is
        sized = [
            name for name, output in rows.outputs.items() if output.exact.both and isfinite(greatest.get(name, inf))
        ]
        known = [([rows.outputs[name].moments()], ball(greatest[name])) for name in sized]
    priced = [(worth(moments, rows.settled, slopes), mean) for moments, mean in known]
    worths = [value.known + value.by_mean * mean for value, mean in priced if value is not None]
    if not known:
        worths = list(_paid(sublevel, rows, total, least))
    return beyond + min(worths, key=upper) if worths else None


def _paid(sublevel: Sublevel, rows: ExactRows, total: Vector, least: Mapping[str, Number]) -> Iterator[arb]:
    """The worth of slopes where a constant that bounds a mean in proportion, however great it is, outweighs them."""
    terms = rows.space.terms
    for name, slope in zip(rows.names, total[terms:-1], strict=True):
        pays = bool(slope > 0) and least.get(name, 0) >= 0
        for nu, none, growth in sublevel.means_by(name) if pays else ():
            value = worth(rows.space.moments(nu), rows.settled, total[:terms])
            if value is not None and bool(value.by_mean * ball(growth) <= slope):
                yield value.known + value.by_mean * ball(none)


class Worth(NamedTuple):
    """The most by which slopes can lower a sum: what is known, and how much for each unit of a mean magnitude."""

    known: arb
    by_mean: arb


def worth(pieces: Sequence[Sequence[Vector]], settled: Sequence[Vector], slopes: Vector) -> Worth | None:
    """What slopes in the coordinates are worth; None where the moments do not determine the law.

    Parameters
    ----------
    pieces
        Of each piece of the interval, moments of the function with functions that are at most 1 in magnitude.
    settled
        Rows that are 0 in every law: of what no moment sees.
    slopes
        One for each coordinate.
    """
    rows = [row for piece in pieces for row in piece] + list(settled)
    matrix = arb_mat([row[:-1] for row in rows])
    try:
        # the plain elimination loses balls that are narrow enough by far
        solution = (matrix.transpose() * matrix).solve(arb_mat(len(slopes), 1, slopes), algorithm="precond")
    except ZeroDivisionError:
        return None
    weights = (matrix * solution).entries()
    known, first, most = arb(0), 0, arb(0)
    for weight, row in zip(weights, rows, strict=True):
        known += weight * arb(row[-1])
    for piece in pieces:
        most = most.max(sum((abs(weight) for weight in weights[first : first + len(piece)]), arb(0)))
        first += len(piece)
    return Worth(known, most) if known.is_finite() and most.is_finite() else None


class PlaceSteps:
    """The nodes of a certificate's tree, applied again."""

    def __init__(self, certificate: Certificate, peak: PeakConstant) -> None:
        self.rows, self.peak, limits = ExactRows(certificate), peak, certificate.problem.range(peak.name)
        self.claim, self.low = Fraction(certificate.claim or 0), Fraction(0 if limits is None else limits.low)
        self.means = self.rows.sublevel.means(self.rows.sublevel.greatest_values(self.claim))

    def after(self, here: PlaceRange, node: Node) -> list[PlaceRange] | None:
        """The ranges that remain of a range after a node; None if it is no node of places."""
        if type(node) is Leaf:
            most = self.upper(here, node)
            low = ball(self.low)
            return [] if most is not None and bool(most + self.remainder(here) < low) else [here]
        return here.after(node)

    def upper(self, here: PlaceRange, leaf: Leaf) -> arb | None:
        """Most that sign times the derivative in the middle can be below the claim; None if nothing is known."""
        rows = self.rows
        derivative = BallRow([-ball(here.sign) * value for value in self._values(0, here)])
        below = BallRow([arb(0)] * (rows.space.terms + 1), rows.cost, -ball(self.claim))
        weighed = [(arb(1), derivative)]
        for contact in leaf.contacts:
            row = below if contact.constraint == CLAIM else rows.row(contact)
            if row is not None and contact.multiplier > 0.0:
                weighed.append((ball(contact.multiplier), row))
        weighed += zip(map(ball, leaf.equations), rows.equations, strict=False)
        total = summed([weight for weight, _ in weighed], [row.vector(rows.names) for _, row in weighed])
        lost = charge(rows.sublevel, rows, total, self.claim)
        return None if lost is None else lost - total[-1]

    def remainder(self, here: PlaceRange) -> arb:
        """Most by which a peak in the range, where the slope is 0, can be above the value in its middle: by Taylor."""
        reach, highest = ball((Fraction(here.high) - Fraction(here.low)) / 2), self.rows.space.degree_of(0)
        if here.low == here.high:
            return arb(0)
        sizes = (
            self._magnitude(self._values(2 + i, here)) * reach**i / factorial(i)
            for i in range(highest - self.peak.nu - 1)
        )
        return sum(sizes, arb(0)) * reach * reach / 2

    def _values(self, further: int, here: PlaceRange) -> list[arb]:
        return self.rows.space.values(self.peak.nu + further, (Fraction(here.low) + Fraction(here.high)) / 2)

    def _magnitude(self, row: list[arb]) -> arb:
        """Most that the magnitude of a function of the law, a row of its coordinates, can be below the claim."""
        space, settled = self.rows.space, self.rows.settled
        known = [(worth(space.moments(nu), settled, row[:-1]), ball(mean)) for nu, mean in self.means.items()]
        sizes = [abs(row[-1] - value.known) + value.by_mean * mean for value, mean in known if value is not None]
        return min(sizes, key=lambda size: float(size.upper()), default=arb.pos_inf())


def places_hold(certificate: Certificate, bits: int) -> bool:
    """Whether the tree of a certificate over the places of a peak leaves none with every rounding enclosed."""
    peak = peak_of(certificate.problem, certificate.peak)
    if peak is None:
        return False
    with ctx.workprec(bits):
        roots = roots_of(certificate.problem, peak.name)
        return closes(certificate.tree, roots, PlaceSteps(certificate, peak).after)


_MORE_BITS = (1, 4, 16)
_DEAR = 1e-10  # of a sum: what a charge that is more takes, repaired multipliers may not


@dataclass(frozen=True)
class Proof:
    """The bound that a certificate proves."""

    #: the lower bound; of a proof that no law exists, by how much the constraints contradict each other. None if
    #: nothing is proven
    value: Fraction | None
    charge: float = 0.0  #: what was taken off for what the sum still depends on
    #: negative, unknown: numbers of contacts with a negative multiplier, and of those the problem does not ask for:
    #: they do not count
    negative: int = 0
    unknown: int = 0
    #: by how much the bound rises with a number on the right side of rows, between two floats, where that was asked
    slope: tuple[Fraction, Fraction] = (Fraction(0), Fraction(0))
    #: whether the rows prove it; otherwise what is minimised is never less, and multipliers do not count
    by_rows: bool = True
    #: why there are no exact rows, so that nothing is proven and nothing is refuted
    no_rows: str = ""


@dataclass(frozen=True)
class Along:
    """A number on the right side of rows, or a weight of the objective, along which a bound is computed."""

    #: the problem with the number greater by `width`; None for a weight, along which bounds are averaged
    step: Problem | None
    width: Fraction  #: by how much
    widest: Problem  #: the problem, of all that are asked about, whose laws may be greatest
    claim: float  #: the greatest objective that is asked about


def prove(certificate: Certificate, along: Along | None = None) -> Proof:
    """The bound that a certificate proves: of one leaf its sum less the charge, of boxes and of places its claim.

    Along a number it is what the contacts prove for all its values: the bound here, and its slope.

    >>> from optlaws import Chebyshev, Problem, synthesize
    >>> solution = synthesize(Problem(B=1.859, order=4, basis=Chebyshev(9)))
    >>> proof = prove(solution.certificate)
    >>> round(float(proof.value), 9), proof.charge < 1e-10
    (4.647776025, True)
    """
    if certificate.points is not None:
        return Proof(Fraction(certificate.claim or 0) if tree_holds(certificate) else None)
    if certificate.peak:
        return Proof(Fraction(certificate.claim or 0) if places_hold(certificate, 4 * _bits(certificate)) else None)
    for times in _MORE_BITS:
        with ctx.workprec(_bits(certificate) * times):
            rows = ExactRows(certificate)
            best, width = _proof(rows, certificate, along)
        # balls that are too wide show nothing, or are charged, or lie far below
        if best.value is not None and arb(best.charge) + width <= ball(_DEAR) * ball(abs(best.value)):
            break
    if certificate.program == VIOLATION or along is not None:
        return best
    values, terms = rows.sublevel.least_values(), certificate.problem.objective.terms
    least = sum((Fraction(weight) * values[repr(term)] for weight, term in terms), Fraction(0))
    if isinstance(least, Fraction) and (best.value is None or best.value <= least):
        return replace(best, value=least, charge=0.0, by_rows=False)
    return best


def _bits(certificate: Certificate) -> int:
    return 96 + 4 * (2 * certificate.problem.order + int(getattr(certificate.problem.basis, "degree", 0)))


def _proof(rows: ExactRows, certificate: Certificate, along: Along | None) -> tuple[Proof, arb]:
    """The proof at the precision at work, at which a linear system may be too wide to be solved; its sum's width."""
    leaf = _Leaf(rows, certificate)
    total = leaf.sum()
    claim = along.claim if along is not None else rounded_up(upper(total[-1])) if total[-1].is_finite() else inf
    sublevel = rows.sublevel if along is None else replace(rows.sublevel, problem=along.widest)
    beyond = charge(sublevel, rows, total, Fraction(claim)) if isfinite(claim) else None
    weights, value = leaf.weights, total[-1]
    if beyond is None or bool(beyond > ball(_DEAR) * abs(value)):
        repaired = leaf.repaired(total[:-1])
        if repaired is not None and (beyond is None or bool(repaired[1] > value - beyond)):
            (weights, value), beyond, claim = repaired, arb(0), inf
    if beyond is None or not value.is_finite():
        return Proof(None, 0.0, leaf.negative, leaf.unknown), arb(0)
    # a law either contradicts the claim, and then the charge covers it, or it does not
    proven = lower(value - beyond)
    if along is None and isfinite(claim):
        proven = min(proven, Fraction(claim))
    slope = sum((m * rate for m, rate in zip(weights, leaf.rates(along), strict=False)), arb(0))
    bounds = (lower(slope), upper(slope))
    return Proof(proven, rounded_up(upper(beyond)) + 0.0, leaf.negative, leaf.unknown, bounds), value.rad()


class _Leaf:
    """The rows that a leaf adds up: coefficients of the coordinates and of constants, then what is constant."""

    def __init__(self, rows: ExactRows, certificate: Certificate) -> None:
        self.rows, self.certificate = rows, certificate
        self.contacts: list[Contact] = []
        self.vectors: list[Vector] = []
        self.negative = self.unknown = 0
        for contact in certificate.contacts:
            row = rows.row(contact)
            if contact.multiplier < 0.0:
                self.negative += 1
            elif row is None:
                self.unknown += 1
            elif contact.multiplier > 0.0:
                self.contacts.append(contact)
                self.vectors.append(row.vector(rows.names))
        self.weights = [ball(contact.multiplier) for contact in self.contacts]
        for row, weight in zip(rows.equations, certificate.equations, strict=False):
            self.vectors.append(row.vector(rows.names))
            self.weights.append(ball(weight))

    def sum(self) -> Vector:
        """The objective and the weighted rows, added up."""
        cost = [ball(self.rows.cost.get(name, 0.0)) for name in self.rows.names]
        start = [*[arb(0)] * self.rows.space.terms, *cost, arb(0)]
        return summed([arb(1), *self.weights], [start, *self.vectors])

    def rates(self, along: Along | None) -> Vector:
        """The rate of each row's constant with respect to the swept number."""
        if along is None or along.step is None:
            return []
        certificate = replace(self.certificate, problem=along.step)
        there = _Leaf(ExactRows(certificate), certificate)
        pairs = list(zip(self.vectors, there.vectors, strict=True))
        if any(bool(a != b) for here, other in pairs for a, b in zip(here[:-1], other[:-1], strict=True)):
            raise InputError("the number changes coefficients of constraints, so there is no proof along it")
        return [(other[-1] - here[-1]) / ball(along.width) for here, other in pairs]

    def repaired(self, slopes: Vector) -> tuple[Vector, arb] | None:
        """Multipliers near these with which the sum loses its slopes, and its value; None where there are none."""
        count = len(self.contacts)
        greatest = max((abs(weight) for weight in self.weights), default=arb(1), key=float)
        freedom = [*self.weights[:count], *[greatest] * (len(self.weights) - count)]
        changes = _changes(self.vectors, [weight * weight for weight in freedom], slopes)
        if changes is None:
            return None
        corrected = [weight + change for weight, change in zip(self.weights, changes, strict=True)]
        if not all(bool(weight >= 0) for weight in corrected[:count]):
            return None
        value = summed(corrected, [[vector[-1]] for vector in self.vectors])[0]
        return (corrected, value) if value.is_finite() else None


def _changes(vectors: list[Vector], weights: Vector, slopes: Vector) -> Vector | None:
    """Changes with sum(change * vector) = -slopes, least in the weighted mean square; balls around the exact ones."""
    size = len(slopes)
    if not vectors or not size:
        return None if size else []
    matrix = arb_mat([vector[:size] for vector in vectors])
    weighted = arb_mat([[w * entry for entry in vector[:size]] for w, vector in zip(weights, vectors, strict=True)])
    try:
        solution = (matrix.transpose() * weighted).solve(arb_mat(size, 1, [-slope for slope in slopes]))
    except ZeroDivisionError:
        return None
    return list((weighted * solution).entries())


def exact_limit(problem: Problem) -> Fraction | None:
    """A lower bound of the objective for all laws of the problem; None where no closed form exists.

    Only C, D, J and the RMS of c count, and C and D of its cam; every other constant is to be at least 0.

    >>> exact_limit(Problem(B=1.5, order=4, minimise="D"))
    Fraction(9, 4)
    """
    constants = [leaf for _, leaf in leaves(problem.objective) if isinstance(leaf, Functional)]
    if problem.boundary is not None or any(floor(constant, problem.conditions) < 0 for constant in constants):
        return None
    for constant in constants:
        if isinstance(constant, Combined):
            known(constant)
    return limit_of_sum(problem, problem.objective, exact=True) or None


_BITS = 128
#: the order of laws whose acceleration may jump at the ends, and the least of laws that have a snap
_AT_REST, _SMOOTH = 2, 4
_SNAP = 384  # the least peak of the fourth derivative from rest to rest: 3! 4³

#: a least and a greatest value
Bounds = tuple[Fraction, Fraction]
#: a limit, or infinity
Limit = Fraction | float


class _Sides(NamedTuple):
    """Limits of the acceleration forward and backward, and of the jerk."""

    up: Limit
    down: Limit
    jerk: Limit


def least_time_of_any_law(move: TimedMove) -> Fraction | None:
    """A time that no law keeps the limits of the motion in less than; None where none is proven."""
    limits, order = move.limits, move.problem.order
    up, down, jerk, snap, velocity = (
        inf if most is None else Fraction(most)
        for most in (limits.acceleration, limits.deceleration, limits.jerk, limits.snap, limits.velocity)
    )
    if order < _AT_REST:
        up = down = jerk = inf
    if order == _AT_REST and not move.at_rest:
        jerk = inf
    stroke, known = Fraction(move.stroke), list[Fraction]()
    if move.concave and min(up, down, jerk, velocity) < inf:
        ends = (Fraction(move.start_velocity), Fraction(move.end_velocity))
        known.append(_by_segments(stroke, ends, _Sides(up, down, jerk), velocity, order))
    if move.at_rest and order >= _SMOOTH and isinstance(snap, Fraction):
        known.append(_root(_root(_SNAP * stroke / snap)))
    return max(known, default=None)


def _by_segments(
    stroke: Fraction, ends: tuple[Fraction, Fraction], sides: _Sides, velocity: Limit, order: int
) -> Fraction:
    way = sides.up if ends[1] > ends[0] else sides.down
    times, straight = _phase(abs(ends[1] - ends[0]), way, sides.jerk, order)
    if min(min(ends) * time for time in times) + straight[0] > stroke:
        # it is slower between, or goes back: so does its image, which is faster between; both take the same time
        stroke, ends, sides = -stroke, (-ends[0], -ends[1]), _Sides(sides.down, sides.up, sides.jerk)

    def phases(above: Fraction) -> list[tuple[Bounds, Bounds]]:
        return [
            _phase(max(ends) - end + above, side, sides.jerk, order)
            for end, side in zip(ends, (sides.up, sides.down), strict=True)
        ]

    def covered(above: Fraction) -> Fraction:
        """No less than what the phases cover."""
        known = zip(ends, phases(above), strict=True)
        return sum((max(end * time for time in times) + far[1] for end, (times, far) in known), Fraction(0))

    above, cruise = Fraction(0), Fraction(0)
    if isinstance(velocity, Fraction) and velocity > 0 and covered(velocity - max(ends)) < stroke:
        above = velocity - max(ends)
        cruise = (stroke - covered(above)) / velocity
    else:
        above = _below_crossing(covered, stroke)
    return cruise + sum(times[0] for times, _ in phases(above))


def _below_crossing(covered: Callable[[Fraction], Fraction], stroke: Fraction) -> Fraction:
    """A velocity with which the phases cover less than the stroke, near the greatest; 0 where there is none."""
    low, high = Fraction(0), Fraction(1)
    if covered(low) >= stroke:
        return low
    while covered(high) < stroke:
        low, high = high, 2 * high
    while low == 0 and covered(high / 2) >= stroke:
        high /= 2
    for _ in range(_BITS // 2):
        middle = (low + high) / 2
        low, high = (middle, high) if covered(middle) < stroke else (low, middle)
    return low


def _phase(gain: Fraction, limit: Limit, jerk: Limit, order: int) -> tuple[Bounds, Bounds]:
    """The time of the fastest gain of a velocity from a standstill, and what it covers."""
    known = (phase(gain, limit, jerk, order, partial(_root, above=above)) for above in (0, 1))
    (fewest, near), (most, far) = known
    return (sum(fewest, Fraction(0)), sum(most, Fraction(0))), (near, far)


def _root(square: Fraction, above: int = 0) -> Fraction:
    """A fraction below a root, or above it, which differs in the last of many bits."""
    shift = max(0, _BITS + square.denominator.bit_length() - square.numerator.bit_length())
    whole = isqrt((square.numerator << 2 * shift) // square.denominator)
    return Fraction(whole + above, 1 << shift)
