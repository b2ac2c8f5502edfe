"""Derivatives of formulas, themselves formulas, and their values as arrays."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from optlaws.errors import InputError
from optlaws.formulas.arithmetic import NUMPY, Together, evaluate
from optlaws.formulas.tree import (
    Call,
    Exponentiation,
    Formula,
    Name,
    Negative,
    Number,
    Product,
    Reciprocal,
    Sum,
    Table,
    number,
    product,
    total,
)
from optlaws.kept import kept_property
from optlaws.numbers import Array

_ZERO, _ONE = Number(0.0), Number(1.0)


def derivative(formula: Formula, name: str) -> Formula:
    """The derivative of a formula by a name.

    Raises
    ------
    InputError
        If a part has none everywhere: abs, max, min, and tables of straight lines.

    Examples
    --------
    >>> from optlaws.formulas.reading import read
    >>> derivative(read("c*b + sin(3*b)"), "b")
    c + 3*cos(3*b)
    """
    slopes: list[Formula] = []
    for part, places, _ in formula.steps:
        moving = name in part.names()
        slopes.append(_slope(part, [slopes[place] for place in places], name) if moving else _ZERO)
    return slopes[-1]


def _slope(formula: Formula, slopes: list[Formula], name: str) -> Formula:
    """The derivative of a formula that contains the name, from the derivatives of its parts."""
    if isinstance(formula, Name):
        return _ONE
    if isinstance(formula, Negative):
        return opposite(slopes[0])
    if isinstance(formula, Sum):
        return added(slopes)
    if isinstance(formula, Product):
        return _of_product(formula, slopes)
    if isinstance(formula, Reciprocal):
        square = Reciprocal(Exponentiation(formula.of, Number(2.0)))
        return opposite(multiplied([slopes[0], square]))
    if isinstance(formula, Exponentiation):
        return _of_power(formula, slopes, name)
    if isinstance(formula, Table):
        return multiplied([_of_table(formula), slopes[0]])
    assert isinstance(formula, Call)  # noqa: S101 - there are no others
    return _of_call(formula, slopes)


def _of_product(formula: Product, slopes: list[Formula]) -> Formula:
    terms = []
    for i, slope in enumerate(slopes):
        others = (*formula.factors[:i], *formula.factors[i + 1 :])
        terms.append(multiplied([slope, *others]))
    return added(terms)


def _of_power(formula: Exponentiation, slopes: list[Formula], name: str) -> Formula:
    base, exponent, slope = formula.base, formula.exponent, slopes[0]
    known = constant(exponent)
    if known is not None:
        lower = base if known == 2.0 else Exponentiation(base, number(known - 1.0))
        return multiplied([number(known), lower if known != 1.0 else _ONE, slope])
    if name not in exponent.names():
        return multiplied([exponent, Exponentiation(base, added([exponent, opposite(_ONE)])), slope])
    turned = added([multiplied([slopes[1], Call("log", (base,))]), multiplied([exponent, slope, Reciprocal(base)])])
    return multiplied([formula, turned])


_SLOPES: dict[str, Callable[[Formula], Formula]] = {
    "sin": lambda of: Call("cos", (of,)),
    "cos": lambda of: opposite(Call("sin", (of,))),
    "tan": lambda of: added([_ONE, Exponentiation(Call("tan", (of,)), Number(2.0))]),
    "atan": lambda of: Reciprocal(added([_ONE, Exponentiation(of, Number(2.0))])),
    "tanh": lambda of: added([_ONE, opposite(Exponentiation(Call("tanh", (of,)), Number(2.0)))]),
    "exp": lambda of: Call("exp", (of,)),
    "log": Reciprocal,
    "sqrt": lambda of: Reciprocal(multiplied([Number(2.0), Call("sqrt", (of,))])),
}


def _of_call(formula: Call, slopes: list[Formula]) -> Formula:
    if formula.function == "norm":
        terms = [multiplied([part, slope]) for part, slope in zip(formula.arguments, slopes, strict=True)]
        return multiplied([added(terms), Reciprocal(formula)])
    if formula.function not in _SLOPES:
        raise InputError(f"{formula} has no derivative everywhere")
    [of] = formula.arguments
    return multiplied([_SLOPES[formula.function](of), slopes[0]])


def _of_table(formula: Table) -> Formula:
    """The slope of a table, which jumps at the places of straight lines."""
    return replace(formula, order=formula.order + 1) if formula.smooth or not formula.order else _ZERO


def constant(formula: Formula) -> float | None:
    """The value of a formula without names; None where it has some, or tables.

    >>> from optlaws.formulas.reading import read
    >>> constant(read("-1/2")), constant(read("b"))
    (-0.5, None)
    """
    if formula.names() - {"pi"}:
        return None
    with np.errstate(all="ignore"):
        return float(evaluate(formula, {}, NUMPY))


def opposite(formula: Formula) -> Formula:
    """The opposite, without two signs."""
    if isinstance(formula, Negative):
        return formula.of
    return formula if formula == _ZERO else Negative(formula)


def added(terms: list[Formula]) -> Formula:
    """The sum without what is 0."""
    nonzero = [term for term in terms if term != _ZERO]
    return total(nonzero) if nonzero else _ZERO


def scaled(formula: Formula, factor: float) -> Formula:
    """A factor above 0 times a formula, taken into its sums, absolute values, maxima, minima and norms.

    >>> from optlaws.formulas.reading import read
    >>> scaled(read("max(c, 2*b) - sqrt(k)"), 4.0)
    max(4*c, 8*b) - 4*sqrt(k)
    """
    if isinstance(formula, Negative):
        return Negative(scaled(formula.of, factor))
    if isinstance(formula, Sum):
        return total([scaled(term, factor) for term in formula.terms])
    if isinstance(formula, Call) and formula.function in {"abs", "max", "min", "norm"}:
        return Call(formula.function, tuple(scaled(argument, factor) for argument in formula.arguments))
    factors = formula.factors if isinstance(formula, Product) else (formula,)
    return multiplied([Number(factor), *factors])


def multiplied(factors: list[Formula]) -> Formula:
    """The product without what is 1; 0 where a factor is; numbers first, as one."""
    value, others, minus = 1.0, [], False
    for factor in factors:
        bare = factor.of if isinstance(factor, Negative) else factor
        minus ^= bare is not factor
        if isinstance(bare, Number):
            value *= bare.value
        else:
            others.append(bare)
    if value == 0.0:
        return _ZERO
    result = product(others if value == 1.0 and others else [Number(value), *others])
    return Negative(result) if minus else result


@dataclass(frozen=True, eq=False)
class Slopes:
    """A formula with its first and second derivatives by some of its names, at places that have a k.

    >>> from optlaws.formulas.reading import read
    >>> at = {"b": np.array([2.0, 3.0]), "c": np.array([1.0, 1.0]), "k": np.array([0.0, 1.0])}
    >>> value, gradient, hessian = Slopes(read("b^2*c"), ("b", "c")).derivatives(at)
    >>> value.tolist(), gradient.tolist(), hessian[:, :, 0].tolist()
    ([4.0, 9.0], [[4.0, 6.0], [4.0, 9.0]], [[2.0, 4.0], [4.0, 0.0]])
    """

    formula: Formula
    names: tuple[str, ...]

    @kept_property
    def _first(self) -> tuple[Formula, ...]:
        return tuple(derivative(self.formula, name) for name in self.names)

    @kept_property
    def _second(self) -> tuple[Formula, ...]:
        """By two names, by the second one up to the first: the others are the same."""
        return tuple(derivative(slope, name) for i, slope in enumerate(self._first, 1) for name in self.names[:i])

    @kept_property
    def _itself(self) -> Together:
        return Together((self.formula,))

    @kept_property
    def _up_to_first(self) -> Together:
        return Together((self.formula, *self._first))

    @kept_property
    def _up_to_second(self) -> Together:
        return Together((self.formula, *self._first, *self._second))

    def second(self, i: int, j: int) -> Formula:
        """The formula of the second derivative by two of the names."""
        later, sooner = max(i, j), min(i, j)
        return self._second[later * (later + 1) // 2 + sooner]

    def value(self, at: Mapping[str, Array]) -> Array:
        """Values of the formula at the places."""
        return np.asarray(_arrays(self._itself, at)[0])

    def value_and_gradient(self, at: Mapping[str, Array]) -> tuple[Array, Array]:
        """Values of the formula, and its derivatives, shape (names, *places)."""
        values = _arrays(self._up_to_first, at)
        return values[0], _without_tips(values[1:])

    def derivatives(self, at: Mapping[str, Array]) -> tuple[Array, Array, Array]:
        """The same, and second derivatives, shape (names, names, *places)."""
        count = len(self.names)
        values = _arrays(self._up_to_second, at)
        rows, columns = np.tril_indices(count)
        bends = np.empty((count, count, *values.shape[1:]))
        bends[rows, columns] = bends[columns, rows] = _without_tips(values[1 + count :])
        return values[0], _without_tips(values[1 : 1 + count]), bends


def _arrays(formulas: Together, at: Mapping[str, Array]) -> Array:
    values = np.empty((len(formulas.formulas), *np.shape(at["k"])))
    with np.errstate(all="ignore"):
        for i, value in enumerate(formulas.values(at, NUMPY)):
            values[i] = value
    return values


def _without_tips(slopes: Array) -> Array:
    """The values of slopes; 0 at the tip of a norm, where 0 is the slope of a valid tangent."""
    return np.where(np.isnan(slopes), 0.0, slopes)
