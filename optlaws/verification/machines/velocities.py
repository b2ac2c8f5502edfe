"""The Laplace transform of a law's velocity in complex balls: closed forms on pieces of polynomials.

On each piece the integral of exp(w (1-k)) b(k) is, by parts, a sum over b's derivatives at both ends.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from functools import reduce
from itertools import pairwise
from typing import Any, TypeVar

from flint import acb, acb_series, arb, arb_poly, fmpq

from optlaws.verification.enclosing.balls import ball
from optlaws.verification.enclosing.pieces import PolynomialPiece
from optlaws.verification.enclosing.taylor_models import Taylor, cells, greatest_magnitude
from optlaws.verification.machines.driving import Space
from optlaws.verification.machines.taylor_cells import root

#: b and its derivatives at the start and at the end of a piece
Ends = tuple[list[fmpq], list[fmpq]]
Number = TypeVar("Number", acb, acb_series)
_HALF = Fraction(1, 2)
#: how little what is left of Taylor polynomials may be, of the function, and the shortest stretch
_NOTHING, _SHORTEST = 2.0**-80, Fraction(1, 2**20)


def ends_of(space: Space) -> list[list[Ends]]:
    """The derivatives at the ends of the pieces of every function of a space."""
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
        for column in range(len(space.derivative(0)[0]))
    ]


def ends_of_law(pieces: Sequence[PolynomialPiece]) -> tuple[list[Fraction], list[list[Ends]]]:
    """The breaks of a stored law, and the derivatives at the ends of its pieces."""
    breaks = [pieces[0].start, *(piece.stop for piece in pieces)]
    ends = []
    for piece in pieces:
        orders = range(1, piece.derivative(0).degree() + 1)
        ends.append(([piece.exact(nu, piece.start) for nu in orders], [piece.exact(nu, piece.stop) for nu in orders]))
    return breaks, [ends]


def velocity_transforms(w: Number, breaks: Sequence[Fraction], columns: Sequence[Sequence[Ends]]) -> list[Number]:
    """Integrals of exp(w (1-k)) b(k); where the breaks end at 1/2, b(1-k) = b(k)."""
    total = _between_breaks(w, breaks, columns)
    if breaks[-1] == _HALF:
        mirrored = _between_breaks(-w, breaks, columns)
        total = [transform + w.exp() * other for transform, other in zip(total, mirrored, strict=True)]
    return total


def _between_breaks(w: Number, breaks: Sequence[Fraction], columns: Sequence[Sequence[Ends]]) -> list[Number]:
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


def greatest_modulus(functions: Sequence[Callable[[Any], Any]], low: Fraction, high: Fraction) -> arb:
    """A ball that holds the greatest magnitude of complex functions of a real number, given for numbers and series."""
    if low == high:
        sizes: list[arb] = [abs(function(acb(ball(low)))) for function in functions]
        return reduce(arb.max, sizes)
    parts = [part for function in functions for part in _parts(function, low, high)]
    off = reduce(arb.max, (radius for _, radius in parts))
    size = root(greatest_magnitude([(square, arb(0)) for square, _ in parts]))
    return (size + arb(0, off)).max(arb(0))


def _parts(
    function: Callable[[acb_series], acb_series], low: Fraction, high: Fraction
) -> Iterator[tuple[arb_poly, arb]]:
    """Polynomials of which the squared magnitude is made, on short stretches, and how far the function is off."""
    several = cells(lambda nu: [function(nu)], acb_series, (low, high), 2 * _SHORTEST, _next_to_nothing)
    yield from ((_squared(centre), rest) for _, [(centre, rest)] in several)


def _next_to_nothing(parts: Sequence[Taylor], _: Fraction) -> bool:
    centre, rest = parts[0]
    return bool(rest <= _NOTHING * sum(map(abs, centre[:2]), arb(0)))


def _squared(series: list[acb]) -> arb_poly:
    """The squared magnitude of a polynomial of a real number."""
    real, imaginary = arb_poly([term.real for term in series]), arb_poly([term.imag for term in series])
    return real * real + imaginary * imaginary
