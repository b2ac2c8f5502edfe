"""The residual vibration that a law leaves, in complex balls: closed forms on pieces of polynomials.

On each piece the integral of exp(w (1-k)) b(k) is, by parts, a sum over b's derivatives at both ends.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from fractions import Fraction
from itertools import pairwise
from math import factorial
from typing import Any, Protocol, TypeVar, runtime_checkable

from flint import acb, acb_series, arb, ctx, fmpq

from optlaws.verification.enclosing.ball_pieces import bisected
from optlaws.verification.enclosing.balls import ball
from optlaws.verification.enclosing.pieces import PolynomialPiece
from optlaws.verification.exact.space import ExactSpace

#: b and its derivatives at the start and at the end of a piece
Ends = tuple[list[fmpq], list[fmpq]]
Number = TypeVar("Number", acb, acb_series)
_I = acb(0, 1)
_HALF = Fraction(1, 2)
#: terms of a Taylor series: as many derivatives as bisection takes
_LENGTH = 7


@runtime_checkable
class ResidualConstant(Protocol):
    """What a residual over an interval of frequencies is made of (optlaws.mechanisms defines it)."""

    name: str
    low: float
    high: float
    damping: float
    design: float | None
    design_damping: float


class ExactResidual:
    """The complex amplitude, times nu², as a function of the frequency.

    Parameters
    ----------
    constant
        Which residual.
    """

    def __init__(self, constant: ResidualConstant) -> None:
        self.low, self.high = Fraction(constant.low), Fraction(constant.high)
        self.damping, self.design_damping = Fraction(constant.damping), Fraction(constant.design_damping)
        self.design = None if constant.design is None else Fraction(constant.design)

    def amplitudes(self, nu: Number, breaks: Sequence[Fraction], columns: Sequence[Sequence[Ends]]) -> list[Number]:
        """Of laws given by the ends of their pieces; where the breaks end at 1/2, b(1-k) = b(k)."""
        sine = ball((1 - self.damping) * (1 + self.damping)).sqrt()
        root = acb(ball(-self.damping), sine)
        w = nu * root
        scale = nu * nu * self._detuning(nu, w) * (-_I * acb(ball(-self.damping), -sine) / sine)
        transforms = _transforms(w, breaks, columns)
        if breaks[-1] == _HALF:
            mirrored = _transforms(-w, breaks, columns)
            transforms = [transform + w.exp() * other for transform, other in zip(transforms, mirrored, strict=True)]
        return [scale * transform for transform in transforms]

    def _detuning(self, nu: Number, w: Number) -> Number:
        """What the cam made for the design frequency leaves."""
        if self.design is None:
            return nu * 0 + 1
        square = 1 / ball(self.design**2)
        apart = nu * acb(ball(-self.damping)) + acb(ball(self.design_damping * self.design))
        return 1 - nu * nu * acb(square) + apart * w * acb(2 * square)

    def rows(self, space: ExactSpace, place: Fraction) -> list[acb]:
        """Amplitudes of a space's free functions and of its base law, at the frequency of a certificate's place."""
        nu = (1 - place) * self.low + place * self.high
        return self.amplitudes(acb(ball(nu)), space.breaks, ends_of(space))

    def peak(self, pieces: Sequence[PolynomialPiece]) -> arb:
        """A ball that holds the greatest magnitude over the interval of frequencies, at the precision at work."""
        breaks = [pieces[0].start, *(piece.stop for piece in pieces)]
        ends = [[_ends(piece) for piece in pieces]]
        if self.low == self.high:
            magnitude: arb = abs(self.amplitudes(acb(ball(self.low)), breaks, ends)[0])
            return magnitude
        jets: list[tuple[arb, list[arb]]] = []

        def derivative(i: int, nu: arb) -> arb:
            if not jets or jets[-1][0] is not nu:
                with _terms(_LENGTH):
                    series = self.amplitudes(acb_series([acb(nu), acb(1)]), breaks, ends)[0]
                jets[:] = [(nu, _squared([series[n] for n in range(_LENGTH)]))]
            return jets[-1][1][i] * factorial(i)

        return _root(bisected(derivative, self.low, self.high)[1])


def ends_of(space: ExactSpace) -> list[list[Ends]]:
    """Of every function of a space, by its pieces."""
    degree = max(polynomial.degree() for part in space.derivative(0) for polynomial in part)
    derivatives = [space.derivative(nu) for nu in range(1, degree + 1)]
    edges = [2 * fmpq(k.numerator, k.denominator) - 1 for k in space.breaks]
    return [
        [
            (
                [derivative[i][column](low) for derivative in derivatives],
                [derivative[i][column](high) for derivative in derivatives],
            )
            for i, (low, high) in enumerate(pairwise(edges))
        ]
        for column in range(space.terms + 1)
    ]


def _ends(piece: PolynomialPiece) -> Ends:
    orders = range(1, piece.derivative(0).degree() + 1)
    return [piece.exact(nu, piece.start) for nu in orders], [piece.exact(nu, piece.stop) for nu in orders]


def _transforms(w: Number, breaks: Sequence[Fraction], columns: Sequence[Sequence[Ends]]) -> list[Number]:
    """Integrals of exp(w (1-k)) b(k)."""
    inverse, powers = 1 / w, [1 / w]
    for _ in range(max(len(start) for column in columns for start, _ in column)):
        powers.append(powers[-1] * inverse)
    waves = [(w * acb(ball(1 - k))).exp() for k in breaks]
    nothing = w * 0
    transforms = []
    for column in columns:
        total = nothing
        for (start, stop), before, after in zip(column, waves, waves[1:], strict=False):
            total = total + before * _sum(powers, start, nothing) - after * _sum(powers, stop, nothing)
        transforms.append(total)
    return transforms


def _sum(powers: Sequence[Number], values: Sequence[fmpq], nothing: Number) -> Number:
    return sum((power * acb(arb(value)) for power, value in zip(powers, values, strict=False) if value != 0), nothing)


def _squared(series: list[acb]) -> list[arb]:
    """Coefficients of the squared magnitude of a series in a real number."""
    conjugates = [amplitude.conjugate() for amplitude in series]
    return [sum((series[i] * conjugates[n - i] for i in range(n + 1)), acb(0)).real for n in range(len(series))]


def _root(square: arb) -> arb:
    if square > 0:
        return square.sqrt()
    return arb(0).union(square.upper().max(arb(0)).sqrt())


@contextmanager
def _terms(count: int) -> Iterator[None]:
    before: Any = ctx.cap
    ctx.cap = count
    try:
        yield
    finally:
        ctx.cap = before
