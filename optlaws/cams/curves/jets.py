"""Taylor arithmetic: functions of the cam's angle with all their derivatives, by the chain rule and no differences."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import factorial
from typing import Any, TypeAlias

import numpy as np

#: an array of numbers or of enclosures, or a number
Term: TypeAlias = Any


@dataclass(frozen=True, eq=False)
class Jet:
    """A function around many places at once: `terms[i]` is its i-th derivative over i!, an array of numbers.

    Sums, products, quotients and roots of jets are jets of the sums, products, quotients and roots. Terms may also be
    enclosures that hold the numbers: then all that comes out holds what it should.

    Examples
    --------
    >>> square = Jet((np.array([3.0]), np.array([1.0]), np.array([0.0])))
    >>> square = square * square
    >>> [square.derivative(nu).tolist() for nu in range(3)]
    [[9.0], [6.0], [2.0]]
    """

    terms: tuple[Term, ...]

    @property
    def order(self) -> int:
        """The highest derivative that is known."""
        return len(self.terms) - 1

    def derivative(self, nu: int) -> Term:
        """The derivative of order nu."""
        return factorial(nu) * self.terms[nu]

    def slope(self) -> Jet:
        """The jet of the derivative, one order shorter."""
        return Jet(tuple(i * term for i, term in enumerate(self.terms))[1:])

    def cut(self, order: int) -> Jet:
        """The jet up to an order."""
        return Jet(self.terms[: order + 1])

    def __neg__(self) -> Jet:
        return Jet(tuple(-term for term in self.terms))

    def __add__(self, other: Jet | Term) -> Jet:
        if isinstance(other, Jet):
            return Jet(tuple(term + two for term, two in zip(self.terms, other.terms, strict=False)))
        return Jet((self.terms[0] + other, *self.terms[1:]))

    def __sub__(self, other: Jet | Term) -> Jet:
        return self + (-other)

    def __mul__(self, other: Jet | Term) -> Jet:
        if not isinstance(other, Jet):
            return Jet(tuple(term * other for term in self.terms))
        length = min(len(self.terms), len(other.terms))
        return Jet(tuple(_convolved(self.terms, other.terms, i) for i in range(length)))

    def __truediv__(self, other: Jet | Term) -> Jet:
        if not isinstance(other, Jet):
            return Jet(tuple(term / other for term in self.terms))
        terms: list[Term] = []
        for i in range(min(len(self.terms), len(other.terms))):
            rest = self.terms[i]
            for j in range(1, i + 1):
                rest = rest - other.terms[j] * terms[i - j]
            terms.append(rest / other.terms[0])
        return Jet(tuple(terms))

    def root(self) -> Jet:
        """The square root of a positive function."""
        terms = [np.sqrt(self.terms[0])]
        for i in range(1, len(self.terms)):
            rest = self.terms[i]
            for j in range(1, i):
                rest = rest - terms[j] * terms[i - j]
            terms.append(rest / (2.0 * terms[0]))
        return Jet(tuple(terms))

    def waves(self) -> tuple[Jet, Jet]:
        """Its sine and its cosine."""
        sines, cosines = [np.sin(self.terms[0])], [np.cos(self.terms[0])]
        for i in range(1, len(self.terms)):
            steps = [(j / i) * self.terms[j] for j in range(1, i + 1)]
            sines.append(_total([step * cosines[i - j] for j, step in enumerate(steps, start=1)]))
            cosines.append(-_total([step * sines[i - j] for j, step in enumerate(steps, start=1)]))
        return Jet(tuple(sines)), Jet(tuple(cosines))

    def arctangent(self) -> Jet:
        """The angle whose tangent it is."""
        first = np.arctan(self.terms[0])
        if self.order == 0:
            return Jet((first,))
        rates = (self.slope() / (self * self + 1.0)).terms
        return Jet((first, *(rate / (i + 1) for i, rate in enumerate(rates))))


Pair: TypeAlias = tuple[Jet, Jet]


def variable(at: Term, order: int) -> Jet:
    """The jet of the angle itself.

    Examples
    --------
    >>> [float(term) for term in variable(np.float64(2.0), 2).terms]
    [2.0, 1.0, 0.0]
    """
    return Jet((at, *(0.0 * at + (1.0 if i == 1 else 0.0) for i in range(1, order + 1))))


def turned(pair: Pair, by: Jet) -> Pair:
    """Two coordinates turned by an angle, counterclockwise.

    Examples
    --------
    >>> quarter = turned((Jet((1.0,)), Jet((0.0,))), Jet((np.pi / 2,)))
    >>> [round(float(jet.terms[0]), 12) for jet in quarter]
    [0.0, 1.0]
    """
    sine, cosine = by.waves()
    x, y = pair
    return x * cosine - y * sine, x * sine + y * cosine


def _convolved(first: Sequence[Term], second: Sequence[Term], i: int) -> Term:
    return _total([first[j] * second[i - j] for j in range(i + 1)])


def _total(parts: Sequence[Term]) -> Term:
    total = parts[0]
    for part in parts[1:]:
        total = total + part
    return total
