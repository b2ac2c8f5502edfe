"""What a formula is along a stored law, with every rounding enclosed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise

from flint import arb, arb_series, fmpq, fmpq_poly

from optlaws.formulas.affine import degree
from optlaws.formulas.arithmetic import evaluate
from optlaws.formulas.of_motion import MotionFormula
from optlaws.formulas.tree import Call, Formula, Table
from optlaws.formulas.vocabulary import ORDERS
from optlaws.synthesis.functionals.curved_rows import squared
from optlaws.verification.enclosing.ball_extremes import extremes
from optlaws.verification.enclosing.ball_formulas import BALLS, POLYNOMIALS, composed, series_of
from optlaws.verification.enclosing.balls import ball, rational
from optlaws.verification.enclosing.integrals import integrals
from optlaws.verification.enclosing.on_parts import kinks, on_part
from optlaws.verification.enclosing.pieces import Extremes, PolynomialPiece, between, least_and_greatest

#: binary places of an integral that count: more than a float has
_BITS = 80


def extremes_of(motion: MotionFormula, pieces: Sequence[PolynomialPiece]) -> Extremes:
    """Balls that hold the least and the greatest value of a formula on its part of the interval."""
    if motion.start == motion.stop:
        value = value_of(motion, pieces)
        return value, value
    if isinstance(motion.formula, Call) and motion.formula.function == "norm":
        # where a norm vanishes it has no derivative, but its square has
        least, greatest = extremes_of(squared(motion), pieces)
        return least.max(arb(0)).sqrt(), greatest.max(arb(0)).sqrt()
    return least_and_greatest([value for part in _parts(motion, pieces) for value in part.extremes()])


def integral_of(motion: MotionFormula, pieces: Sequence[PolynomialPiece]) -> arb:
    """A ball that holds the integral of a formula over its part: exact where it is a polynomial of k along the law."""
    total = arb(0)
    for part in _parts(motion, pieces):
        composed = part.polynomial()
        if composed is None:
            total += sum(integrals(part.series, [[fmpq_poly([1])]], (part.low, part.high), _BITS), arb(0))
        else:
            whole = composed.integral()
            total += arb((whole(fmpq(1)) - whole(fmpq(-1))) * rational((part.high - part.low) / 2))
    return total


def value_of(motion: MotionFormula, pieces: Sequence[PolynomialPiece]) -> arb:
    """A ball that holds the formula's value where its part begins."""
    k = Fraction(motion.start)
    piece = [started for started in pieces if started.start <= k][-1]
    names = {name: arb(piece.exact(nu, k)) for name, nu in ORDERS.items()}
    value: arb = evaluate(motion.formula, {**names, "k": ball(k)}, BALLS)
    return value


@dataclass(frozen=True)
class _FormulaPart:
    """A formula along a piece of a law, between two k without kinks of what depends on k alone."""

    formula: Formula
    piece: PolynomialPiece
    low: Fraction
    high: Fraction

    def polynomial(self) -> fmpq_poly | None:
        """The formula as a polynomial of what runs from -1 to 1 between the two k; None where it is none."""
        if _bent(self.formula) or degree(self.formula, {"k": 1, **dict.fromkeys(ORDERS, 1)}) is None:
            return None
        k = fmpq_poly([rational((self.low + self.high) / 2), rational((self.high - self.low) / 2)])
        y = self.piece.rate * (k - rational(self.piece.start)) - 1
        names = {name: self.piece.derivative(nu)(y) for name, nu in ORDERS.items() if name in self.formula.names()}
        polynomial: fmpq_poly = evaluate(self.formula, {**names, "k": k}, POLYNOMIALS)
        return polynomial

    def extremes(self) -> Extremes:
        """Balls that hold the least and the greatest value between the two k."""
        composed = self.polynomial()
        if composed is not None:
            return between(composed, fmpq(-1), fmpq(1))
        return extremes(lambda k: self.series(k)[0], self.low, self.high)

    def series(self, k: arb_series) -> tuple[arb_series]:
        """Its Taylor series, to as many terms as series have."""
        y = (k - ball(self.piece.start)) * arb(self.piece.rate) - 1
        used = self.formula.names() & ORDERS.keys()
        names = {name: composed(self.piece.derivative(ORDERS[name]), y) for name in used}
        return (series_of(self.formula, {**names, "k": k}),)


def _bent(formula: Formula) -> bool:
    """Whether functions of what varies are in it, or tables over what moves with the law."""
    calls = any(isinstance(part, Call) and part.names() for part in formula.walk())
    return calls or any(isinstance(part, Table) and not part.names() <= {"k"} for part in formula.walk())


def _parts(motion: MotionFormula, pieces: Sequence[PolynomialPiece]) -> Iterator[_FormulaPart]:
    """The pieces of the law within the formula's part, cut where what depends on k alone has kinks."""
    places = kinks(motion)
    for piece in pieces:
        low, high = max(piece.start, Fraction(motion.start)), min(piece.stop, Fraction(motion.stop))
        edges = sorted({low, high, *(k for k in places if low < k < high)}) if low < high else []
        for ends in pairwise(edges):
            yield _FormulaPart(on_part(motion.formula, *ends), piece, *ends)
