"""Formulas in Taylor arithmetic: the value of a formula with its derivatives, at places or over cells of intervals."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import reduce
from math import factorial, pi
from operator import truediv
from typing import Any

import numpy as np

from optlaws.formulas.arithmetic import Arithmetic, evaluate
from optlaws.formulas.convexity import Endpoints, enclosed
from optlaws.formulas.tree import Call, Formula, Name, Table
from optlaws.numerics.interval import Interval, between
from optlaws.numerics.taylor import Jet
from optlaws.tolerances import ROUNDOFF

_PLACE = Name("x")


def formula_jet(formula: Formula, name: str, at: Jet) -> Jet:
    """A formula of one name as a jet of intervals, where that name is a jet of intervals.

    >>> import numpy as np
    >>> from optlaws.formulas.reading import read
    >>> from optlaws.numerics.interval import exact
    >>> jet = formula_jet(read("exp(2*x)"), "x", Jet((exact(np.array([0.0])), exact(np.array([1.0])))))
    >>> [round(float(term.middle[0]), 12) for term in jet.terms]
    [1.0, 2.0]
    """

    def as_jet(value: Any) -> Jet:
        return value if isinstance(value, Jet) else _constant(value, at)

    def on_jets(function: Callable[..., Jet]) -> Callable[..., Jet]:
        return lambda *arguments: function(*map(as_jet, arguments))

    def power(base: Any, exponent: Any) -> Any:
        return _power(as_jet(base), exponent)

    functions = {known: on_jets(function) for known, function in _FUNCTIONS.items()}
    arithmetic = Arithmetic(float, functions, power, lambda table, place: _table(table, as_jet(place)))
    names = {"pi": as_jet(Interval(np.array(pi), np.array(ROUNDOFF * pi))), name: at}
    return as_jet(evaluate(formula, names, arithmetic))


def _constant(value: Interval | float, like: Jet) -> Jet:
    return like * 0.0 + value


def _of_enclosures(outer: Callable[[int, Endpoints], Endpoints], at: Jet) -> Jet:
    """A function of a jet, of whose derivatives of each order enclosures over intervals are known."""
    first = at.terms[0]
    ends = Endpoints(first.low, first.high)
    slopes = [outer(nu, ends) for nu in range(at.order + 1)]
    terms = [between(slope.low, slope.high) / factorial(nu) for nu, slope in enumerate(slopes)]
    step = Jet((first * 0.0, *at.terms[1:]))
    return reduce(lambda total, term: total * step + term, terms[-2::-1], _constant(terms[-1], at))


def _by_rate(function: str, x: Jet, rate: Callable[[Jet, Jet], Jet]) -> Jet:
    """A function known by its values and by the differential equation y' = rate(y, x) x' that it solves."""
    first = x.terms[0]
    value = enclosed(Call(function, (_PLACE,)), {"x": Endpoints(first.low, first.high)})
    y = Jet((between(value.low, value.high),))
    for i in range(x.order):
        slope = (rate(y, x.cut(i)) * x.slope().cut(i)).terms[i]
        y = Jet((*y.terms, slope / (i + 1)))
    return y


def _power(base: Jet, exponent: Jet | float) -> Jet:
    if isinstance(exponent, Jet):
        return _exponential(_logarithm(base) * exponent)
    if exponent == int(exponent):
        if exponent == 0.0:
            return _constant(1.0, base)
        whole = reduce(lambda product, _: product * base, range(int(abs(exponent)) - 1), base)
        return whole if exponent > 0.0 else 1.0 / whole
    if 2.0 * exponent == int(2.0 * exponent):
        return _power(base.root(), 2.0 * exponent)
    return _exponential(_logarithm(base) * exponent)


def _table(table: Table, at: Jet) -> Jet:
    def outer(nu: int, ends: Endpoints) -> Endpoints:
        return enclosed(replace(table, of=_PLACE, order=table.order + nu), {"x": ends})

    return _of_enclosures(outer, at)


def _logarithm(x: Jet) -> Jet:
    return _by_rate("log", x, lambda _, argument: 1.0 / argument)


def _exponential(x: Jet) -> Jet:
    return _by_rate("exp", x, lambda y, _: y)


_FUNCTIONS: dict[str, Callable[..., Jet]] = {
    "sin": lambda x: x.waves()[0],
    "cos": lambda x: x.waves()[1],
    "tan": lambda x: truediv(*x.waves()),
    "atan": Jet.arctangent,
    "sqrt": Jet.root,
    "exp": _exponential,
    "log": _logarithm,
    "tanh": lambda x: _by_rate("tanh", x, lambda y, _: 1.0 - y * y),
    "abs": Jet.magnitude,
    "max": Jet.maximum,
    "min": lambda first, second: -(-first).maximum(-second),
    "norm": lambda first, second: (first * first + second * second).root(),
}
