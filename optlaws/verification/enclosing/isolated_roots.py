"""Real roots of polynomials between two places: isolated by Descartes' rule of signs, then enclosed by Newton's method.

The rule bounds the number of roots of a polynomial in (0, 1) by the changes of sign among the coefficients of
(1 + x)^n p(1 / (1 + x)), and is exact where there are none or one (Collins and Akritas, SYMSAC 1976, 272-275). That is
exact arithmetic with integers; Newton's method then narrows balls of which it is known that they hold one root each.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from flint import arb, fmpq, fmpq_poly, fmpz_poly

_ONWARD = fmpz_poly([1, 1])
#: what a step leaves of the width of a ball that the precision at work still lets narrow
_NARROWER = 0.9


def real_roots(polynomial: fmpq_poly, low: fmpq, high: fmpq) -> list[arb]:
    """Balls that contain all real roots in a range; even and odd polynomials are solved in y².

    >>> [round(float(root), 9) for root in real_roots(fmpq_poly([0, -2, 0, 1]), fmpq(-1), fmpq(2))]
    [0.0, -1.414213562, 1.414213562]
    """
    numerator = polynomial.numer()
    first, *others = [n for n, value in enumerate(numerator.coeffs()) if value != 0] or [0]
    if not others:
        return [arb(0)] if first else []
    roots = [arb(0)] if first else []
    if any((n - first) % 2 for n in others):
        return roots + _between(fmpz_poly(numerator.coeffs()[first:]), low, high)
    furthest = max(low * low, high * high)
    squares = _between(fmpz_poly(numerator.coeffs()[first::2]), fmpq(0), furthest)
    return roots + [sign * square.sqrt() for square in squares for sign in (-1, 1)]


def _between(polynomial: fmpz_poly, low: fmpq, high: fmpq) -> list[arb]:
    """The roots of a polynomial that does not vanish at 0."""
    _, factors = polynomial.factor_squarefree()
    return [root for factor, _ in factors for root in _isolated(factor, low, high)]


def _isolated(polynomial: fmpz_poly, low: fmpq, high: fmpq) -> Iterator[arb]:
    """The roots of a polynomial that has none twice, each in a ball of its own."""
    if polynomial(high) == 0:
        yield arb(high)
    # of cells from `start` to `start + width`, the polynomial by the share of the way along them
    cells = [(fmpq_poly(polynomial)(fmpq_poly([low, high - low])).numer(), low, high - low)]
    while cells:
        cell, start, width = cells.pop()
        if cell[0] == 0:
            yield arb(start)
            cell = fmpz_poly(cell.coeffs()[1:])
        changes = _changes_of_sign(fmpz_poly(cell.coeffs()[::-1])(_ONWARD))
        if changes == 1:
            yield arb(start) + arb(width) * _enclosed(cell)
        elif changes:
            degree, half = cell.degree(), width / 2
            left = fmpz_poly([value << (degree - n) for n, value in enumerate(cell.coeffs())])
            cells += [(left, start, half), (left(_ONWARD), start + half, half)]


def _changes_of_sign(polynomial: fmpz_poly) -> int:
    signs = [value > 0 for value in polynomial.coeffs() if value != 0]
    return sum(left != right for left, right in pairwise(signs))


def _enclosed(polynomial: fmpz_poly) -> arb:
    """The single root between 0, which is no root, and 1, as narrow as the working precision permits."""
    slope, rises = polynomial.derivative(), polynomial[0] < 0
    middle, half = fmpq(1, 2), fmpq(1, 2)
    # a ball may reach a little beyond what it is to hold: in one where the slope has a sign no other root is near
    while slope(root := arb(middle, arb(half).upper())).contains(0):
        value, half = polynomial(middle), half / 2
        if value == 0:
            return arb(middle)
        middle += half if (value < 0) == rises else -half
    before = arb.pos_inf()
    while root.rad() < _NARROWER * before:
        before, centre = root.rad(), root.mid()
        there, steepness = polynomial(centre), slope(root)
        # a ball within one whose slope has a sign may be evaluated more roughly
        if not steepness.contains(0):
            root = root.intersection(centre - there / steepness)
        if 2 * root.rad() > before and not there.contains(0):
            root = root.intersection(centre.union(root.upper() if (there < 0) == rises else root.lower()))
    return root
