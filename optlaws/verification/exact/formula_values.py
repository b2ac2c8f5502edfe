"""What a formula is along a stored law, with every rounding enclosed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise
from math import factorial
from typing import Any

from flint import arb, arb_series, ctx, fmpq, fmpq_poly

from optlaws.errors import InputError
from optlaws.formulas.arithmetic import evaluate
from optlaws.formulas.of_motion import Motion
from optlaws.formulas.tree import Call, Number, Power, Table, total
from optlaws.formulas.vocabulary import ORDERS
from optlaws.verification.enclosing.ball_formulas import BALLS, POLYNOMIALS
from optlaws.verification.enclosing.ball_pieces import bisected
from optlaws.verification.enclosing.balls import ball, rational
from optlaws.verification.enclosing.pieces import Extremes, PolynomialPiece, between, least_and_greatest

#: terms of a Taylor series: as many derivatives as bisection takes
_LENGTH = 7


def extremes_of(motion: Motion, pieces: Sequence[PolynomialPiece]) -> Extremes:
    """Balls that hold the least and the greatest value of a formula on its part of the interval."""
    if motion.start == motion.stop:
        value = value_of(motion, pieces)
        return value, value
    if isinstance(motion.formula, Call) and motion.formula.function == "norm":
        squares = total([Power(part, Number(2.0)) for part in motion.formula.arguments])
        # where a norm vanishes it has no derivative, but its square has
        least, greatest = extremes_of(replace(motion, formula=squares), pieces)
        return least.max(arb(0)).sqrt(), greatest.max(arb(0)).sqrt()
    found: list[arb] = []
    for piece, low, high in _parts(motion, pieces):
        composed = _polynomial(motion, piece, low, high)
        if composed is not None:
            found += between(composed, fmpq(-1), fmpq(1))
        else:
            found += bisected(_Derivatives(motion, piece), low, high)
    return least_and_greatest(found)


def square_of(motion: Motion, pieces: Sequence[PolynomialPiece]) -> arb:
    """A ball that holds the integral of the square of a formula over its part.

    Raises
    ------
    InputError
        If the formula is no polynomial of k along the law.
    """
    return _integral(motion, pieces, square=True)


def integral_of(motion: Motion, pieces: Sequence[PolynomialPiece]) -> arb:
    """A ball that holds the integral of a formula over its part.

    Raises
    ------
    InputError
        If the formula is no polynomial of k along the law.
    """
    return _integral(motion, pieces, square=False)


def _integral(motion: Motion, pieces: Sequence[PolynomialPiece], *, square: bool) -> arb:
    whole_integral = fmpq(0)
    for piece, low, high in _parts(motion, pieces):
        composed = _polynomial(motion, piece, low, high)
        if composed is None:
            raise InputError(
                f"exact verification integrates formulas that are polynomials of k along a law, not {motion.formula}"
            )
        whole = (composed * composed if square else composed).integral()
        whole_integral += (whole(fmpq(1)) - whole(fmpq(-1))) * rational((high - low) / 2)
    return arb(whole_integral)


def value_of(motion: Motion, pieces: Sequence[PolynomialPiece]) -> arb:
    """A ball that holds the formula's value where its part begins."""
    k = Fraction(motion.start)
    piece = [one for one in pieces if one.start <= k][-1]
    names = {name: arb(piece.exact(nu, k)) for name, nu in ORDERS.items()}
    found: arb = evaluate(motion.formula, {**names, "k": ball(k)}, BALLS)
    return found


def _parts(motion: Motion, pieces: Sequence[PolynomialPiece]) -> list[tuple[PolynomialPiece, Fraction, Fraction]]:
    """The pieces of the law within the formula's part, cut where its tables change."""
    kinks = list(map(Fraction, motion.kinks))
    found = []
    for piece in pieces:
        low, high = max(piece.start, Fraction(motion.start)), min(piece.stop, Fraction(motion.stop))
        edges = sorted({low, high, *(k for k in kinks if low < k < high)}) if low < high else []
        found += [(piece, one, other) for one, other in pairwise(edges)]
    return found


def _polynomial(motion: Motion, piece: PolynomialPiece, low: Fraction, high: Fraction) -> fmpq_poly | None:
    """The formula as a polynomial of what runs from -1 to 1 between two k; None where it is none."""
    if any(isinstance(part, Call) and part.names() for part in motion.formula.walk()):
        if any(isinstance(part, Call) and part.function in {"abs", "max", "min"} for part in motion.formula.walk()):
            raise InputError(f"exact verification knows no abs, max or min of what changes with k: {motion.formula}")
        return None
    if any(isinstance(part, Table) and not part.names() <= {"k"} for part in motion.formula.walk()):
        raise InputError(f"exact verification knows tables over k, not over what moves with the law: {motion.formula}")
    if motion.degree(dict.fromkeys(ORDERS, 1)) is None:
        return None
    k = fmpq_poly([rational((low + high) / 2), rational((high - low) / 2)])
    y = piece.rate * (k - rational(piece.start)) - 1
    names = {name: piece.derivative(nu)(y) for name, nu in ORDERS.items()}
    found: fmpq_poly = evaluate(motion.formula, {**names, "k": k}, POLYNOMIALS)
    return found


class _Derivatives:
    """Derivatives of a formula along a piece, by Taylor series in balls."""

    def __init__(self, motion: Motion, piece: PolynomialPiece) -> None:
        self.motion, self.piece = motion, piece
        self._last: tuple[arb, arb_series] | None = None

    def __call__(self, i: int, k: arb) -> arb:
        if self._last is None or self._last[0] is not k:
            self._last = (k, self._series(k))
        found: arb = self._last[1][i] * factorial(i)
        return found

    def _series(self, k: arb) -> arb_series:
        y = (k - ball(self.piece.start)) * arb(self.piece.rate) - 1
        names: dict[str, Any] = {}
        before: Any = ctx.cap
        ctx.cap = _LENGTH
        try:
            for name, nu in ORDERS.items():
                values = [self.piece.derivative(nu + i) for i in range(_LENGTH)]
                names[name] = arb_series(
                    [one.numer()(y) / arb(one.denom()) / factorial(i) for i, one in enumerate(values)]
                )
            names["k"] = arb_series([k, arb(1)])
            found: arb_series = evaluate(self.motion.formula, names, BALLS)
        except ValueError:
            # a divisor may be 0 somewhere in the ball
            return arb_series([arb.nan()] * _LENGTH)
        finally:
            ctx.cap = before
        return found
