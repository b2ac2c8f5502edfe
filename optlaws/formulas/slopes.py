"""Derivatives of formulas, themselves formulas."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from optlaws.errors import InputError
from optlaws.formulas.arithmetic import NUMPY, evaluate
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
    if name not in formula.names():
        return _ZERO
    if isinstance(formula, Name):
        return _ONE
    if isinstance(formula, Negative):
        return opposite(derivative(formula.of, name))
    if isinstance(formula, Sum):
        return added([derivative(term, name) for term in formula.terms])
    if isinstance(formula, Product):
        return _of_product(formula, name)
    if isinstance(formula, Reciprocal):
        square = Reciprocal(Exponentiation(formula.of, Number(2.0)))
        return opposite(multiplied([derivative(formula.of, name), square]))
    if isinstance(formula, Exponentiation):
        return _of_power(formula, name)
    if isinstance(formula, Table):
        return multiplied([_of_table(formula), derivative(formula.of, name)])
    assert isinstance(formula, Call)  # noqa: S101 - there are no others
    return _of_call(formula, name)


def _of_product(formula: Product, name: str) -> Formula:
    terms = []
    for i, factor in enumerate(formula.factors):
        others = (*formula.factors[:i], *formula.factors[i + 1 :])
        terms.append(multiplied([derivative(factor, name), *others]))
    return added(terms)


def _of_power(formula: Exponentiation, name: str) -> Formula:
    base, exponent = formula.base, formula.exponent
    slope = derivative(base, name)
    known = constant(exponent)
    if known is not None:
        lower = base if known == 2.0 else Exponentiation(base, number(known - 1.0))
        return multiplied([number(known), lower if known != 1.0 else _ONE, slope])
    if name not in exponent.names():
        return multiplied([exponent, Exponentiation(base, added([exponent, opposite(_ONE)])), slope])
    turned = added(
        [
            multiplied([derivative(exponent, name), Call("log", (base,))]),
            multiplied([exponent, slope, Reciprocal(base)]),
        ]
    )
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


def _of_call(formula: Call, name: str) -> Formula:
    if formula.function == "norm":
        terms = [multiplied([part, derivative(part, name)]) for part in formula.arguments]
        return multiplied([added(terms), Reciprocal(formula)])
    if formula.function not in _SLOPES:
        raise InputError(f"{formula} has no derivative everywhere")
    [of] = formula.arguments
    return multiplied([_SLOPES[formula.function](of), derivative(of, name)])


def _of_table(formula: Table) -> Formula:
    """The slope of a spline; of straight lines only where they are over k, whose places are known beforehand."""
    if not formula.smooth and not formula.of.names() <= {"k"}:
        raise InputError(f"{formula} has no derivative at its places; spline(...) has one everywhere")
    return replace(formula, order=formula.order + 1)


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
