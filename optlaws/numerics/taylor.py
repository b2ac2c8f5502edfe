"""Taylor arithmetic: functions with all their derivatives at many places, by the chain rule and no differences."""

from __future__ import annotations

from dataclasses import dataclass
from math import factorial
from typing import Any, TypeAlias

import numpy as np

from optlaws.numerics.interval import Interval, between, chosen, dot, exact, hull

#: an array of numbers, intervals, or a number
Term: TypeAlias = Any


@dataclass(frozen=True, eq=False)
class Jet:
    """A function around many places at once: `terms[i]` is its i-th derivative over i!, an array of numbers.

    Sums, products, quotients and roots of jets are jets of the sums, products, quotients and roots. Terms may also be
    intervals that hold the numbers: then all that comes out holds what it should.

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
        return Jet(tuple(dot(self.terms[: i + 1], other.terms[i::-1]) for i in range(length)))

    def __truediv__(self, other: Jet | Term) -> Jet:
        if not isinstance(other, Jet):
            return Jet(tuple(term / other for term in self.terms))
        terms: list[Term] = []
        inverse = 1.0 / other.terms[0]
        for i in range(min(len(self.terms), len(other.terms))):
            rest = self.terms[i] - dot(other.terms[1 : i + 1], terms[::-1]) if i else self.terms[0]
            terms.append(rest * inverse)
        return Jet(tuple(terms))

    __radd__, __rmul__ = __add__, __mul__

    def __rsub__(self, other: Term) -> Jet:
        return (-self).__add__(other)

    def __rtruediv__(self, other: float) -> Jet:
        return (self * 0.0 + other) / self

    def root(self) -> Jet:
        """The square root of a positive function."""
        terms = [np.sqrt(self.terms[0])]
        inverse = 0.5 / terms[0] if len(self.terms) > 1 else None
        for i in range(1, len(self.terms)):
            rest = self.terms[i] - dot(terms[1:], terms[:0:-1]) if i > 1 else self.terms[1]
            terms.append(rest * inverse)
        return Jet(tuple(terms))

    def waves(self) -> tuple[Jet, Jet]:
        """Its sine and its cosine."""
        sines, cosines = [np.sin(self.terms[0])], [np.cos(self.terms[0])]
        for i in range(1, len(self.terms)):
            steps = [self.terms[j] * j / i for j in range(1, i + 1)]  # j/i itself is rounded
            sine, cosine = dot(steps, cosines[::-1]), dot(steps, sines[::-1])
            sines.append(sine)
            cosines.append(-cosine)
        return Jet(tuple(sines)), Jet(tuple(cosines))

    def maximum(self, other: Jet | float) -> Jet:
        """The greater of two functions; where intervals leave open which, the slopes of both, and any bend."""
        two = other if isinstance(other, Jet) else self._constant(other)
        first, second = self.terms[0], two.terms[0]
        pairs = list(zip(self.terms, two.terms, strict=False))
        if not isinstance(first, Interval):
            return Jet(tuple(np.where(first >= second, left, right) for left, right in pairs))
        over, under = first.low >= second.high, second.low >= first.high
        either = [between(np.maximum(first.low, second.low), np.maximum(first.high, second.high))]
        either += [hull(left, right) for left, right in pairs[1:2]]
        either += [Interval(left.middle, np.full(left.middle.shape, np.inf)) for left, _ in pairs[2:]]
        return Jet(
            tuple(
                chosen(over, left, chosen(under, right, open_one))
                for (left, right), open_one in zip(pairs, either, strict=True)
            )
        )

    def _constant(self, value: float) -> Jet:
        # not self * 0: what is unbounded would make it unknown
        first = self.terms[0]
        zero = exact(np.zeros(first.middle.shape)) if isinstance(first, Interval) else np.zeros(np.shape(first))
        return Jet((zero + value, *(zero,) * self.order))

    def clipped(self, low: float, high: float) -> Jet:
        """The function where it is between two values, and else the nearer one; between them where it is unbounded."""
        inside = -(-self.maximum(low)).maximum(-high)
        first = inside.terms[0]
        if not isinstance(first, Interval):
            return inside
        whole = between(np.full(first.middle.shape, low), np.full(first.middle.shape, high))
        return Jet((chosen(np.isfinite(first.radius), first, whole), *inside.terms[1:]))

    def magnitude(self) -> Jet:
        """The absolute value of the function."""
        return self.maximum(-self)

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

    >>> [float(term) for term in variable(np.float64(2.0), 2).terms]
    [2.0, 1.0, 0.0]
    """
    return Jet((at, *(0.0 * at + (1.0 if i == 1 else 0.0) for i in range(1, order + 1))))


def turned(pair: Pair, by: Jet) -> Pair:
    """Two coordinates turned by an angle, counterclockwise.

    >>> quarter = turned((Jet((1.0,)), Jet((0.0,))), Jet((np.pi / 2,)))
    >>> [round(float(jet.terms[0]), 12) for jet in quarter]
    [0.0, 1.0]
    """
    sine, cosine = by.waves()
    x, y = pair
    return x * cosine - y * sine, x * sine + y * cosine
