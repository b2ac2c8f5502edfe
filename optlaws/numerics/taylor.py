"""Taylor arithmetic: functions with all their derivatives at many places, by the chain rule and no differences."""

from __future__ import annotations

from collections.abc import Sequence
from math import factorial
from typing import Any, TypeAlias

import numpy as np

from optlaws.numerics.interval import Interval, between, chosen, convolved, dot, dot_of_rows, exact, hull, stacked

#: an array of numbers, intervals, or a number
Term: TypeAlias = Any


class Jet:
    """A function around many places at once: `terms[i]` is its i-th derivative over i!, an array of numbers.

    Sums, products, quotients and roots of jets are jets of the sums, products, quotients and roots. Terms may also be
    intervals that hold the numbers: then all that comes out holds what it should. Intervals of one shape are computed
    with as the rows of one, `block`, in a step for all orders.

    >>> square = Jet((np.array([3.0]), np.array([1.0]), np.array([0.0])))
    >>> square = square * square
    >>> [square.derivative(nu).tolist() for nu in range(3)]
    [[9.0], [6.0], [2.0]]
    """

    __slots__ = ("_block", "_terms")

    def __init__(self, terms: Sequence[Term]) -> None:
        self._terms: tuple[Term, ...] | None = tuple(terms)
        self._block: Interval | None = None

    @classmethod
    def of_rows(cls, block: Interval) -> Jet:
        """The jet whose terms are the rows of an interval."""
        jet = cls(())
        jet._block, jet._terms = block, None
        return jet

    @property
    def terms(self) -> tuple[Term, ...]:
        """The Taylor terms, from the value on."""
        if self._terms is None:
            block = self._rows
            self._terms = tuple(map(Interval, block.middle, block.radius))
        return self._terms

    @property
    def block(self) -> Interval | None:
        """The terms as rows of one interval; None where they are numbers, or of several shapes."""
        if self._block is None:
            first = self.terms[0]
            if not isinstance(first, Interval):
                return None
            shape = first.middle.shape
            if not all(isinstance(term, Interval) and term.middle.shape == shape for term in self.terms):
                return None
            self._block = stacked(self.terms)
        return self._block

    @property
    def _rows(self) -> Interval:
        assert self._block is not None  # noqa: S101 - a jet has terms or rows
        return self._block

    @property
    def order(self) -> int:
        """The highest derivative that is known."""
        return len(self._rows.middle if self._terms is None else self._terms) - 1

    def derivative(self, nu: int) -> Term:
        """The derivative of order nu."""
        return factorial(nu) * self.terms[nu]

    def slope(self) -> Jet:
        """The jet of the derivative, one order shorter."""
        block = self.block
        if block is None:
            return Jet(tuple(i * term for i, term in enumerate(self.terms))[1:])
        rows = np.arange(1.0, len(block.middle)).reshape(-1, *(1,) * (block.middle.ndim - 1))
        return Jet.of_rows(block[1:] * rows)

    def cut(self, order: int) -> Jet:
        """The jet up to an order."""
        return Jet.of_rows(self._rows[: order + 1]) if self._terms is None else Jet(self._terms[: order + 1])

    def __neg__(self) -> Jet:
        block = self.block
        return Jet(tuple(-term for term in self.terms)) if block is None else Jet.of_rows(-block)

    def __add__(self, other: Jet | Term) -> Jet:
        if isinstance(other, Jet):
            pair = _alike(self, other)
            if pair is None:
                return Jet(tuple(term + two for term, two in zip(self.terms, other.terms, strict=False)))
            return Jet.of_rows(pair[0] + pair[1])
        block = self._broad(other)
        if block is None:
            return Jet((self.terms[0] + other, *self.terms[1:]))
        first, block = block[0] + other, Interval(block.middle.copy(), block.radius.copy())
        block.middle[0], block.radius[0] = first.middle, first.radius
        return Jet.of_rows(block)

    def __sub__(self, other: Jet | Term) -> Jet:
        return self + (-other)

    def __mul__(self, other: Jet | Term) -> Jet:
        if not isinstance(other, Jet):
            block = self._broad(other)
            return Jet(tuple(term * other for term in self.terms)) if block is None else Jet.of_rows(block * other)
        pair = _alike(self, other)
        if pair is None:
            length = min(self.order, other.order) + 1
            return Jet(tuple(dot(self.terms[: i + 1], other.terms[i::-1]) for i in range(length)))
        with np.errstate(invalid="ignore"):
            return Jet.of_rows(convolved(*pair))

    @np.errstate(invalid="ignore")  # 0 times infinity: no bound
    def __truediv__(self, other: Jet | Term) -> Jet:
        if not isinstance(other, Jet):
            block = self._broad(other)
            return Jet(tuple(term / other for term in self.terms)) if block is None else Jet.of_rows(block / other)
        pair = _alike(self, other)
        inverse = 1.0 / other.terms[0]
        if pair is not None:
            rows = TermRows(pair[0])
            for i in range(len(rows)):
                above = pair[0][i]
                rows[i] = (above - dot_of_rows(pair[1][1 : i + 1], rows.back(i)) if i else above) * inverse
            return Jet.of_rows(rows.block)
        terms: list[Term] = []
        for i in range(min(self.order, other.order) + 1):
            rest = self.terms[i] - dot(other.terms[1 : i + 1], terms[::-1]) if i else self.terms[0]
            terms.append(rest * inverse)
        return Jet(tuple(terms))

    def _broad(self, other: Term) -> Interval | None:
        """The rows, where a number or an array is none that makes them larger."""
        block = self.block
        if block is None or np.ndim(other.middle if isinstance(other, Interval) else other) >= block.middle.ndim:
            return None
        return block

    __radd__, __rmul__ = __add__, __mul__

    def __rsub__(self, other: Term) -> Jet:
        return (-self).__add__(other)

    def __rtruediv__(self, other: float) -> Jet:
        return (self * 0.0 + other) / self

    @np.errstate(invalid="ignore")  # 0 times infinity: no bound
    def root(self) -> Jet:
        """The square root of a positive function."""
        block = self.block
        terms = [np.sqrt(self.terms[0])]
        inverse = 0.5 / terms[0] if self.order else None
        if block is not None and inverse is not None:
            rows = TermRows(block)
            rows[0] = terms[0]
            for i in range(1, len(rows)):
                rest = block[i] - dot_of_rows(rows.block[1:i], rows.back(i)[:-1]) if i > 1 else block[1]
                rows[i] = rest * inverse
            return Jet.of_rows(rows.block)
        for i in range(1, self.order + 1):
            rest = self.terms[i] - dot(terms[1:], terms[:0:-1]) if i > 1 else self.terms[1]
            terms.append(rest * inverse)
        return Jet(tuple(terms))

    @np.errstate(invalid="ignore")  # 0 times infinity: no bound
    def waves(self) -> tuple[Jet, Jet]:
        """Its sine and its cosine."""
        block = self.block
        sines, cosines = [np.sin(self.terms[0])], [np.cos(self.terms[0])]
        if block is not None and self.order:
            sine_rows, cosine_rows, steps = TermRows(block), TermRows(block), self.slope().block
            assert steps is not None  # noqa: S101 - the slope of rows has rows
            sine_rows[0], cosine_rows[0] = sines[0], cosines[0]
            for i in range(1, len(sine_rows)):
                sine, cosine = (dot_of_rows(steps[:i], rows.back(i)) / i for rows in (cosine_rows, sine_rows))
                sine_rows[i], cosine_rows[i] = sine, -cosine
            return Jet.of_rows(sine_rows.block), Jet.of_rows(cosine_rows.block)
        for i in range(1, self.order + 1):
            terms = [self.terms[j] * j / i for j in range(1, i + 1)]  # j/i itself is rounded
            sine, cosine = dot(terms, cosines[::-1]), dot(terms, sines[::-1])
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


class TermRows:
    """Rows of an interval that are filled one after the other, as many and of the shape as another one has.

    >>> rows = TermRows(exact(np.zeros((2, 1))))
    >>> rows[0], rows[1] = exact(np.array([1.0])), exact(np.array([2.0]))
    >>> rows.back(2).middle.ravel().tolist()
    [2.0, 1.0]
    """

    __slots__ = ("block",)

    def __init__(self, like: Interval) -> None:
        self.block = Interval(np.empty_like(like.middle), np.empty_like(like.radius))

    def __len__(self) -> int:
        return len(self.block.middle)

    def __setitem__(self, row: int, value: Interval) -> None:
        self.block.middle[row], self.block.radius[row] = value.middle, value.radius

    def back(self, count: int) -> Interval:
        """The first rows, in the opposite order."""
        return self.block[count - 1 :: -1]


def _alike(first: Jet, second: Jet) -> tuple[Interval, Interval] | None:
    """The rows of two jets, as many of each; None where they have none, or of several shapes."""
    left, right = first.block, second.block
    if left is None or right is None or left.middle.shape[1:] != right.middle.shape[1:]:
        return None
    length = min(len(left.middle), len(right.middle))
    return left[:length], right[:length]


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
