"""Formulas from functions of Python: the arithmetic that a function does with a symbol, as a tree."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, NoReturn, TypeAlias

import numpy as np

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.formulas.slopes import added, multiplied, opposite
from optlaws.formulas.tree import SMOOTH_FUNCTIONS, Call, Exponentiation, Formula, Name, Number, Reciprocal, Sum, number
from optlaws.numbers import finite, real

_HALF = Number(0.5)


class Traced:
    """A formula that is computed with as a number is: what is done with it is a formula again.

    >>> x = Traced(Name("x"))
    >>> np.sqrt(1.0 - (0.5 * np.sin(x)) ** 2).formula
    sqrt(1 - (0.5*sin(x))^2)
    """

    __slots__ = ("formula",)

    def __init__(self, formula: Formula) -> None:
        self.formula = formula

    def __repr__(self) -> str:
        return str(self.formula)

    def __add__(self, other: Any) -> Traced:
        return Traced(added([self.formula, _formula(other)]))

    def __radd__(self, other: Any) -> Traced:
        return Traced(added([_formula(other), self.formula]))

    def __sub__(self, other: Any) -> Traced:
        return Traced(added([self.formula, _opposite(_formula(other))]))

    def __rsub__(self, other: Any) -> Traced:
        return Traced(added([_formula(other), _opposite(self.formula)]))

    def __mul__(self, other: Any) -> Traced:
        return Traced(multiplied([self.formula, _formula(other)]))

    def __rmul__(self, other: Any) -> Traced:
        return Traced(multiplied([_formula(other), self.formula]))

    def __truediv__(self, other: Any) -> Traced:
        by = real(other)
        if by == 0.0:
            raise ZeroDivisionError("the function divides by 0")
        return Traced(multiplied([self.formula, Reciprocal(_formula(other)) if by is None else number(1.0 / by)]))

    def __rtruediv__(self, other: Any) -> Traced:
        return Traced(multiplied([_formula(other), Reciprocal(self.formula)]))

    def __pow__(self, other: Any) -> Traced:
        power = _formula(other)
        if power == Number(1.0):
            return self
        return Traced(Call("sqrt", (self.formula,)) if power == _HALF else Exponentiation(self.formula, power))

    def __rpow__(self, other: Any) -> Traced:
        return Traced(Exponentiation(_formula(other), self.formula))

    def __neg__(self) -> Traced:
        return Traced(_opposite(self.formula))

    def __pos__(self) -> Traced:
        return self

    def __abs__(self) -> Traced:
        return Traced(Call("abs", (self.formula,)))

    def __bool__(self) -> NoReturn:  # noqa: PLE0304 - it has no truth
        _refuse("asks for the truth of a value, as `if` and `while` do")

    def _compare(self, _: object) -> NoReturn:
        _refuse("compares a value with another")

    __lt__ = __le__ = __gt__ = __ge__ = _compare

    def __float__(self) -> NoReturn:
        _refuse("needs a plain number, as functions of `math` do: take those of numpy")

    __int__ = __index__ = __float__

    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, **keywords: Any) -> Traced:
        known = _UFUNCS.get(ufunc.__name__)
        if method != "__call__" or known is None or keywords:
            _refuse(f"uses numpy.{ufunc.__name__}, which formulas have not")
        if any(isinstance(value, np.ndarray) and value.ndim for value in inputs):
            _refuse("computes with arrays: compute with numbers, and return several coordinates as a list")
        return known(*(value if isinstance(value, Traced) else Traced(_formula(value)) for value in inputs))


def _refuse(what: str) -> NoReturn:
    raise InputError(
        f"the function cannot be written down as a formula: it {what}; write it without that, or give a table of its "
        "values"
    )


def _formula(value: Any) -> Formula:
    if isinstance(value, Traced):
        return value.formula
    plain = value.item() if isinstance(value, np.ndarray) and value.ndim == 0 else value
    if real(plain) is None:
        _refuse(f"computes with {shortened(value)}")
    return number(finite(plain, "a number in the function"))


def _opposite(formula: Formula) -> Formula:
    """The opposite, of sums term by term."""
    return added([opposite(term) for term in formula.terms]) if isinstance(formula, Sum) else opposite(formula)


def _call(name: str) -> Callable[[Traced], Traced]:
    return lambda of: Traced(Call(name, (of.formula,)))


def _several(name: str) -> Callable[[Traced, Traced], Traced]:
    return lambda of, other: Traced(Call(name, (of.formula, other.formula)))


def _arcsine(of: Traced) -> Traced:
    """The angle between -90 and 90 degrees of a sine."""
    return Traced(Call("atan", ((of / (1.0 - of * of) ** 0.5).formula,)))


def _arctangent(y: Traced, x: Traced) -> Traced:
    """The angle of a point, which must not come to the negative half of the first axis."""
    return 2.0 * Traced(Call("atan", ((y / (x + (x * x + y * y) ** 0.5)).formula,)))


_UFUNCS: dict[str, Callable[..., Traced]] = {
    **{function.numpy.__name__: _call(name) for name, function in SMOOTH_FUNCTIONS.items()},
    "add": lambda x, y: x + y,
    "subtract": lambda x, y: x - y,
    "multiply": lambda x, y: x * y,
    "divide": lambda x, y: x / y,
    "power": lambda x, y: x**y,
    "float_power": lambda x, y: x**y,
    "negative": lambda x: -x,
    "positive": lambda x: x,
    "square": lambda x: x * x,
    "reciprocal": lambda x: 1.0 / x,
    "absolute": abs,
    "hypot": _several("norm"),
    "maximum": _several("max"),
    "minimum": _several("min"),
    "arcsin": _arcsine,
    "arccos": lambda x: np.pi / 2.0 - _arcsine(x),
    "arctan2": _arctangent,
    "deg2rad": lambda x: x * (np.pi / 180.0),
    "radians": lambda x: x * (np.pi / 180.0),
}

#: a number for one coordinate, several in a list or by their names
Coordinates: TypeAlias = "Any | Sequence[Any] | Mapping[str, Any]"


def traced(function: Callable[[Any], Any], name: str = "x") -> dict[str, Formula]:
    """The formulas of the coordinates that a function gives of one number, by name; of a list they are q1, q2, ...

    Raises
    ------
    InputError
        If the function does what formulas cannot say, such as branches on values; the error states the remedy.

    Examples
    --------
    >>> traced(lambda x: {"slide": 0.1 * np.cos(x) + np.sqrt(0.16 - (0.1 * np.sin(x)) ** 2)})
    {'slide': 0.1*cos(x) + sqrt(0.16 - (0.1*sin(x))^2)}
    >>> traced(lambda x: x if x > 0 else 0.0)
    Traceback (most recent call last):
    optlaws.errors.InputError: the function cannot be written down as a formula: it compares a value with another; write it without that, or give a table of its values
    """  # noqa: E501 - a line of output
    try:
        given = function(Traced(Name(name)))
    except InputError:
        raise
    except (TypeError, ValueError, AttributeError, ZeroDivisionError) as error:
        raise InputError(f"the function cannot be written down as a formula: {error}") from None
    if isinstance(given, Mapping):
        return {str(key): _formula(value) for key, value in given.items()}
    several = given if isinstance(given, list | tuple) else [given]
    return {f"q{i}": _formula(value) for i, value in enumerate(several, 1)}
