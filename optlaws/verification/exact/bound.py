"""The bound that a certificate proves, with every rounding enclosed.

The multipliers are corrected a little so that the sum of the rows does not depend on the law at all. The corrections
solve a linear system whose solution is enclosed by balls; that it exists, and that no multiplier becomes negative, is
all the proof needs. Each contact lends a little of its multiplier to two neighbours, which stand for its place: place
and multiplier together have as much freedom as the law. Where that is not so (a mean square is minimised, or contacts
coincide) moments of a derivative join in, which the claim itself bounds: they are charged.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from fractions import Fraction
from math import inf, isfinite

from flint import arb, arb_mat, ctx

from optlaws.errors import InputError
from optlaws.synthesis.limits.rounding import rounded_up
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.proof.certificate import VIOLATION, Certificate
from optlaws.synthesis.proof.nodes import Contact
from optlaws.verification.enclosing.balls import ball, lower, upper
from optlaws.verification.exact.boxes import tree_holds
from optlaws.verification.exact.rows import ExactRows
from optlaws.verification.exact.sublevel_bounds import greatest_values, least_objective, least_values, means
from optlaws.verification.machines.certificate_rows import BallRow, together

_PAYING_SCALE = 2.0**-40  # of the scale of a constant: in such shares is counted what a sum leaves of it alone
_ROUNDED_MULTIPLIER = 1e-7  # of the greatest multiplier: a correction that nothing but rounding need explain
_BOUND_ENCLOSED = 2.0**-80  # of the objective's scale: in a wider ball a bound gains from more bits

Vector = list[arb]

#: more than what rounding of bounds of means makes of how fast they grow
_WIDER = 1.0 + 2.0**-20
_TRIES = 3
#: how readily moments take part, beside the squares of the multipliers
_READINESS = (2.0**-60, 1.0)
#: bounds that differ by less are one bound
_SAME = Fraction(1, 10**13)
#: how far from a contact its neighbours are, and how much of its multiplier each takes
_NEAR, _SHARE = Fraction(1, 2**20), Fraction(1, 2**22)


@dataclass(frozen=True)
class Proof:
    """The bound that a certificate proves, and the corrections of its multipliers."""

    #: the lower bound; of a proof that no law exists, by how much the constraints contradict each other. None if
    #: nothing is proven
    value: Fraction | None
    charge: float = 0.0  #: what was taken off for moments that had to join in; 0 where corrected multipliers do without
    correction: float = 0.0  #: the greatest change of a multiplier, in units of the greatest one
    #: negative, unknown: numbers of contacts with a negative multiplier, and of those the problem does not ask for:
    #: they do not count
    negative: int = 0
    unknown: int = 0
    #: by how much the bound rises with a number on the right side of rows, between two floats, where that was asked
    slope: tuple[Fraction, Fraction] = (Fraction(0), Fraction(0))
    #: whether the rows prove it; otherwise what is minimised is never less, and multipliers do not count
    by_rows: bool = True


def prove(certificate: Certificate) -> Proof:
    """The greatest bound that a certificate proves: of one leaf with corrected multipliers, of boxes its claim.

    Places of a peak are not checked: such a tree proves nothing here.

    >>> from optlaws import Chebyshev, Problem, synthesize
    >>> solution = synthesize(Problem(B=1.859, order=4, basis=Chebyshev(9)))
    >>> proof = prove(solution.certificate)
    >>> round(float(proof.value), 9), proof.charge
    (4.647776025, 0.0)
    """
    if certificate.points is not None:
        return Proof(Fraction(certificate.claim or 0) if tree_holds(certificate) else None)
    if certificate.peak:
        return Proof(None)
    best = _proof(certificate, None)
    least = least_objective(certificate.problem, ExactRows(certificate))
    if certificate.program != VIOLATION and least is not None and (best.value is None or best.value <= least):
        return replace(best, value=least, charge=0.0, correction=0.0, by_rows=False)
    return best


@dataclass(frozen=True)
class Along:
    """A number on the right side of rows, or a weight of the objective, along which a bound is computed."""

    #: the problem with the number greater by `width`; None for a weight, along which bounds are averaged
    step: Problem | None
    width: Fraction  #: by how much
    widest: Problem  #: the problem, of all that are asked about, whose laws may be greatest
    claim: float  #: the greatest objective that is asked about


def prove_along(certificate: Certificate, along: Along) -> Proof:
    """The bound that the certificate's contacts prove for all values of the number: its value here, and its slope."""
    return _proof(certificate, along)


def _proof(certificate: Certificate, along: Along | None) -> Proof:
    basis = certificate.problem.basis
    bits = 384 + 16 * (2 * certificate.problem.order + int(getattr(basis, "degree", 0)))
    best: Proof | None = None
    for _ in range(_TRIES):
        with ctx.workprec(bits):
            system = _System(certificate, along)
            proof, narrow = system.best()
            if proof.value is None or proof.charge > _SAME * max(system.unit, abs(proof.value)):
                # rows that are one another's multiples balance where they are, and beside it they do not
                plain, plain_narrow = _System(certificate, along, beside=False).best()
                if proof.value is None or (plain.value is not None and plain.value > proof.value):
                    proof, narrow = plain, plain_narrow
        if best is None or best.value is None or (proof.value is not None and proof.value > best.value):
            best = proof
        if narrow:
            break
        bits *= 2
    assert best is not None  # noqa: S101 - there is at least one try
    return best


@dataclass(frozen=True, eq=False)
class _Helper:
    """A moment or a constant that joins in: its row, and bounds of its value in laws that contradict the claim.

    Where nothing bounds a constant that bounds the law, both are bounds where it is 0, which widen with it at a rate:
    then the constant joins in too, and `pays` for that.
    """

    vector: Vector
    low: arb
    high: arb
    scale: float = 1.0
    rate: arb | None = None
    pays: bool = False


class _System:
    def __init__(self, certificate: Certificate, along: Along | None = None, *, beside: bool = True) -> None:
        self.certificate, self.along, self.beside = certificate, along, beside
        self.rows = rows = ExactRows(certificate)
        #: the objective's, in which it is reckoned
        self.unit = Fraction(1 if certificate.program == VIOLATION else certificate.problem.objective.scale)
        self.vectors: list[Vector] = []
        self.multipliers: list[arb] = []
        self.negative = self.unknown = 0
        for contact in together(certificate.contacts, rows.corners):
            row = rows.row(contact)
            if contact.multiplier < 0.0:
                self.negative += 1
            elif row is None:
                self.unknown += 1
            elif contact.multiplier > 0.0:
                self._take(contact, row)
        self.contacts = len(self.vectors)
        for row, weight in zip(rows.equations, certificate.equations, strict=False):
            self.vectors.append(row.vector(rows.names))
            self.multipliers.append(ball(Fraction(weight) / self.unit))
        self.size = rows.space.terms + len(rows.names)
        self.cost = [arb(0)] * rows.space.terms + [
            ball(Fraction(rows.cost.get(name, 0.0)) / self.unit) for name in rows.names
        ]

        self.rates = self._rates()

    def _rates(self) -> list[arb]:
        """The rate of each row's right side with respect to the swept number."""
        if self.along is None or self.along.step is None:
            return []
        there = _System(replace(self.certificate, problem=self.along.step), beside=self.beside)
        together = zip(self.vectors, there.vectors, strict=True)
        if any(
            bool(a != b)
            for here, other in zip(self.vectors, there.vectors, strict=True)
            for a, b in zip(here[:-1], other[:-1], strict=True)
        ):
            raise InputError("the number changes more than right sides of rows: nothing is proven along it")
        return [(other[-1] - here[-1]) / ball(self.along.width) for here, other in together]

    def _take(self, contact: Contact, row: BallRow) -> None:
        whole = weight = Fraction(contact.multiplier) / self.unit
        for near, k in self._neighbours(contact) if self.beside else ():
            moved = self.rows.row(near, k)
            if moved is not None:
                self.vectors.append(moved.vector(self.rows.names))
                self.multipliers.append(ball(whole * _SHARE))
                weight -= whole * _SHARE
        self.vectors.append(row.vector(self.rows.names))
        self.multipliers.append(ball(weight))

    def _neighbours(self, contact: Contact) -> Iterator[tuple[Contact, Fraction]]:
        """Neighbours of a contact's place, and of the direction of a complex number."""
        k, cone = Fraction(contact.k), contact.constraint in self.rows.cones
        if cone and len(contact.direction) == 2:
            real, imaginary = contact.direction
            for turn in (float(_NEAR), -float(_NEAR)):
                yield replace(contact, direction=(real - turn * imaginary, imaginary + turn * real)), k
        placed = cone or contact.constraint in self.rows.tangents or not contact.direction
        if _NEAR < k < 1 - _NEAR and placed:
            for near in (k - _NEAR, k + _NEAR):
                if cone or self._share_a_piece(contact.constraint, near, k):
                    yield contact, near

    def _share_a_piece(self, name: str, near: Fraction, k: Fraction) -> bool:
        piece = self.rows.space.piece
        with suppress(LookupError):
            if name in self.rows.outputs:
                return self.rows.outputs[name].share_a_stretch(near, k)
            return piece(near) == piece(k)
        return False

    def best(self) -> tuple[Proof, bool]:
        """The best proof, and whether a higher precision could hardly better it."""
        best = self._corrected([], 1.0)
        claim = self._claim()
        if best is not None and self._is_whole(best[0], claim):
            return best
        joining = list(self._helpers(claim)) if isfinite(claim) else []
        for readiness in _READINESS:
            for helpers in joining:
                corrected = self._corrected(helpers, readiness, claim)
                if corrected is not None and (best is None or _better(corrected[0], best[0], self.unit)):
                    best = corrected
        return best if best is not None else (Proof(None, 0.0, 0.0, self.negative, self.unknown), False)

    def _is_whole(self, proof: Proof, claim: float) -> bool:
        """Whether a proof without helpers is all that they could prove, with multipliers changed by rounding alone."""
        if self.along is not None or proof.value is None or proof.correction > _ROUNDED_MULTIPLIER:
            return False
        return isfinite(claim) and proof.value >= Fraction(claim) - _SAME * max(self.unit, abs(proof.value))

    def _claim(self) -> float:
        if self.along is not None:
            return self.along.claim
        total = sum((m * vector[-1] for m, vector in zip(self.multipliers, self.vectors, strict=True)), arb(0))
        return rounded_up(upper(total) * self.unit) if total.is_finite() else inf

    def _corrected(self, helpers: list[_Helper], readiness: float, claim: float = inf) -> tuple[Proof, bool] | None:
        vectors = self.vectors + [helper.vector for helper in helpers]
        weights = [m * m for m in self.multipliers[: self.contacts]]
        weights += [1 / ball(scale) ** 2 for scale in self.rows.equation_scales[: len(self.vectors) - self.contacts]]
        weights += [readiness / ball(helper.scale) ** 2 for helper in helpers]
        changes = _changes(vectors, weights, self._slopes())
        if changes is None:
            return None
        multipliers = [m + change for m, change in zip(self.multipliers, changes, strict=False)]
        if not all(bool(m >= 0) for m in multipliers[: self.contacts]):
            return None
        value = sum((m * vector[-1] for m, vector in zip(multipliers, self.vectors, strict=True)), arb(0))
        charge = drawn = arb(0)
        for helper, weight in zip(helpers, changes[len(self.vectors) :], strict=True):
            # the multipliers' sum plus the helpers' is the constant `value`: without them it is that minus their worth
            value += weight * helper.vector[-1]
            if not helper.pays:
                charge += (weight * helper.low).max(weight * helper.high)
            # the constant that pays is at least 0
            drawn += weight if helper.pays else arb(0) if helper.rate is None else abs(weight) * helper.rate
        if not bool(drawn <= 0):
            return None
        if not value.is_finite() or not charge.is_finite():
            return None
        total = lower(value - charge) * self.unit
        greatest = max((rounded_up(upper(abs(m))) for m in self.multipliers), default=0.0) or 1.0
        moved = max((rounded_up(upper(abs(c))) for c in changes[: len(self.vectors)]), default=0.0)
        # a law either contradicts the claim, and then the helpers are bounded, or it does not
        proven = min(total, Fraction(claim)) if helpers and self.along is None else total
        slope = sum((m * rate for m, rate in zip(multipliers, self.rates, strict=False)), arb(0))
        bounds = (lower(slope) * self.unit, upper(slope) * self.unit)
        proof = Proof(
            proven, rounded_up(upper(charge) * self.unit) + 0.0, moved / greatest, self.negative, self.unknown, bounds
        )
        return proof, bool(value.rad() < _BOUND_ENCLOSED)

    def _slopes(self) -> Vector:
        slopes = list(self.cost)
        for weight, vector in zip(self.multipliers, self.vectors, strict=True):
            for i in range(self.size):
                slopes[i] += weight * vector[i]
        return slopes

    def _helpers(self, claim: float) -> Iterator[list[_Helper]]:
        """Constants, and moments of one derivative, or of an output, whose mean magnitude is bounded."""
        widest = self.certificate if self.along is None else replace(self.certificate, problem=self.along.widest)
        rows, greatest = self.rows, greatest_values(widest, self.rows, claim)
        least = least_values(self.certificate.problem, rows)
        constants = []
        for i, name in enumerate(rows.names):
            if isfinite(greatest.get(name, inf)) and isfinite(least.get(name, 0)):
                unit = [arb(0)] * (self.size + 1)
                unit[rows.space.terms + i] = arb(1)
                constants.append(
                    _Helper(unit, ball(least.get(name, 0)), ball(greatest[name]), rows.scales.get(name, 1.0))
                )
        bounded = means(widest.problem, rows, greatest)
        for nu, mean in bounded.items():
            moments = [[arb(entry) for entry in row] for row in rows.space.moments(nu)]
            yield constants + [self._moment(moment, mean) for moment in moments]
        if bounded:
            return
        yield from self._paid_helpers(constants, least)
        # an output may determine the law where nothing else says how large it is
        for name, output in rows.outputs.items():
            if output.exact.both and isfinite(greatest.get(name, inf)):
                size = ball(greatest[name])
                scale = output.exact.constant.scale
                yield constants + [self._moment(moment, size, scale) for moment in output.moments()]

    def _paid_helpers(self, constants: list[_Helper], least: Mapping[str, Fraction | float]) -> Iterator[list[_Helper]]:
        """Moments that a constant bounds in proportion, however great it is, with the constant itself."""
        rows, problem = self.rows, self.certificate.problem
        for i, name in enumerate(rows.names):
            if least.get(name, 0) < 0:
                continue
            size = rows.scales.get(name, 1.0)
            none, some, more = (means(problem, rows, {name: times * size}) for times in (0.0, 1.0, 2.0))
            unit = [arb(0)] * (self.size + 1)
            unit[rows.space.terms + i] = arb(1)
            payer = _Helper(unit, arb(0), arb(0), size * _PAYING_SCALE, pays=True)
            others = [constant for constant in constants if not bool(constant.vector[rows.space.terms + i] == 1)]
            for nu in none.keys() & some.keys() & more.keys():
                growth = (some[nu] - none[nu]) * _WIDER
                # of several bounds the least is nowhere above a line that it touches at three places
                if bool(more[nu] - some[nu] <= growth) and bool(some[nu] - none[nu] <= (more[nu] - some[nu]) * _WIDER):
                    moments = [[arb(entry) for entry in row] for row in rows.space.moments(nu)]
                    joined = (self._moment(moment, none[nu]) for moment in moments)
                    rate = growth / ball(size)
                    yield [*others, payer, *(replace(helper, rate=rate) for helper in joined)]

    def _moment(self, moment: Vector, size: arb, scale: float = 1.0) -> _Helper:
        *free, base = moment
        return _Helper([*free, *[arb(0)] * len(self.rows.names), base], -size, size, scale)


def _better(proof: Proof, than: Proof, scale: Fraction) -> bool:
    """Whether a proof gives a greater bound, or an equal one up to rounding with smaller corrections."""
    if proof.value is None or than.value is None:
        return proof.value is not None
    rounding = _SAME * max(scale, abs(than.value))
    if proof.correction <= _ROUNDED_MULTIPLIER < than.correction:
        return proof.value > than.value - rounding
    if than.correction <= _ROUNDED_MULTIPLIER < proof.correction:
        return proof.value > than.value + rounding
    return proof.value > than.value


def _changes(vectors: list[Vector], weights: Vector, slopes: Vector) -> Vector | None:
    """Changes with sum(change * vector) = -slopes, least in the weighted mean square; balls around the exact ones."""
    size = len(slopes)
    if not vectors:
        return None
    if all(bool(slope == 0) for slope in slopes):
        # rows that are the same but for their right sides: their difference is exact, and nothing need change
        return [arb(0)] * len(vectors)
    matrix = arb_mat([vector[:size] for vector in vectors])
    weighted = arb_mat([[w * entry for entry in vector[:size]] for w, vector in zip(weights, vectors, strict=True)])
    try:
        solution = (matrix.transpose() * weighted).solve(arb_mat(size, 1, [-slope for slope in slopes]))
    except ZeroDivisionError:
        return None
    return list((weighted * solution).entries())
