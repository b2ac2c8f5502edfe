"""Objectives and constants as text: 0.6*C/4 + rms_c, C_cam(frequency=20, damping=0.05). Nothing is evaluated as Python.

sum     = product { "+" product }
product = factor { ("*" | "/") factor }
factor  = number | constant | "max" "(" sum { "," sum } ")" | "(" sum ")"
constant = name [ "(" argument { "," argument } ")" ]
argument = name "=" value, or first a formula, whose grammar is that of optlaws.formulas, perhaps in quotes
value   = ["-"] number | name | "(" value "," value ")" | "'{" anything but a quote "}'"
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from functools import lru_cache

from optlaws.echo import CONSTANTS, unknown_key
from optlaws.errors import InputError
from optlaws.formulas.reading import LONGEST, FormulaError, Scanner, Token
from optlaws.formulas.reading import parse as parse_formula
from optlaws.formulas.tree import VOCABULARY
from optlaws.synthesis.problem.constants import FUNCTIONALS, MAKERS, PLAIN, WITHOUT_ARGUMENTS, Functional
from optlaws.synthesis.problem.expression import Expression, Term, maximum

Value = float | Expression
Argument = float | str | tuple[float, float]

_DEPTH = 40
_LONGEST_WITH_TABLES = 1_000_000
#: machines, which are numbers for the greatest part
_TABLE = re.compile(r"'\{[^']*\}'")
_SIGNS = frozenset("+-*/(),=")
#: what makes a constant of a formula, which comes first among its arguments
OF_FORMULAS = frozenset({"integral", "peak", "rms", "value"})

Makers = Mapping[str, Callable[..., Term]]


def parse(text: str, names: Mapping[str, Term], makers: Makers | None = None) -> Expression:
    """Read an objective such as `0.6*C/4 + 0.4*D/2.25` or `max(C/4, D/2.25)`.

    >>> from optlaws import FUNCTIONALS
    >>> parse("0.5*C/4 + 0.5*D/2", FUNCTIONALS)
    0.125*C + 0.25*D
    """
    length = len(_TABLE.sub("", text))
    if length > LONGEST or len(text) > _LONGEST_WITH_TABLES:
        most = f"{LONGEST} characters, {_LONGEST_WITH_TABLES} with its machines"
        raise InputError(f"an objective may have {most}, got {length} and {len(text)}")
    try:
        return _objective(text, names, makers or {})
    except FormulaError as error:
        raise InputError(str(error)) from None


def _objective(text: str, names: Mapping[str, Term], makers: Makers) -> Expression:
    reader = _Reader(text, names, makers)
    depth = greatest = 0
    for character in text:
        depth += (character == "(") - (character == ")")
        greatest = max(greatest, depth)
    if greatest > _DEPTH:
        raise InputError(f"an objective may have {_DEPTH} brackets within each other, got {greatest}")
    value = reader.sum()
    if reader.token.kind != "end":
        reader.refuse("expected + * / or the end")
    if isinstance(value, float):
        reader.refuse("an objective needs at least one constant such as C or D", 0)
    if value.vanishes:
        reader.refuse("a weight must be above 0", reader.zero)
    return value


class _Reader(Scanner):
    def __init__(self, text: str, names: Mapping[str, Term], makers: Makers) -> None:
        super().__init__(text, _SIGNS)
        if not any(token.text in OF_FORMULAS for token in self.tokens):
            for token in self.tokens:
                if token.kind == "sign" and token.text not in _SIGNS:
                    self.refuse(f"{token.text!r} is not understood", token.place)
        self.names, self.makers = names, makers
        self.zero = 0  # where the last weight of 0 stands

    def sum(self) -> Value:
        value = self.product()
        while self.token.text == "+":
            place = self.take().place
            other = self.product()
            if isinstance(value, float) != isinstance(other, float):
                self.refuse("a number cannot be added to a constant of the law", place)
            value = value + other  # type: ignore[operator] # both are numbers or both are not
        if self.token.text == "-":
            self.refuse("terms can only be added: a constant that is subtracted has no least value")
        return value

    def product(self) -> Value:
        value = self.factor()
        while self.token.text in {"*", "/"}:
            sign = self.take()
            place = self.token.place
            other = self.factor()
            value = self._multiplied(value, other, place) if sign.text == "*" else self._divided(value, other, place)
        return value

    def _multiplied(self, first: Value, second: Value, place: int) -> Value:
        if isinstance(second, float):
            return first * second
        if isinstance(first, float):
            return self._scaled(second, first, place)
        return self.refuse("two constants of the law cannot be multiplied", place)

    def _divided(self, first: Value, second: Value, place: int) -> Value:
        if not isinstance(second, float):
            self.refuse("the divisor must be a number", place)
        if second == 0.0:
            self.refuse("division by 0", place)
        return first / second

    def _scaled(self, expression: Expression, factor: float, place: int) -> Expression:
        if factor < 0.0:
            self.refuse("a weight must be at least 0", place)
        if factor == 0.0:
            self.zero = place
        return expression * factor

    def factor(self) -> Value:
        token = self.token
        if token.kind == "number":
            return float(self.take().text)
        if token.text == "(":
            self.take()
            value = self.sum()
            self.close()
            return value
        if token.text == "max":
            return self._maximum()
        if token.kind == "name":
            return self._named()
        return self.refuse("expected a number, a constant, max or (")

    def _named(self) -> Expression:
        token = self.token
        if token.text not in self.names and token.text not in self.makers:
            self.refuse(unknown_key(token.text, {*self.names, *self.makers}, "constant", words=CONSTANTS))
        self.take()
        if token.text in self.names and not (token.text in self.makers and self.token.text == "("):
            return self.names[token.text].expression()
        return self._maker(token).expression()

    def _maker(self, token: Token) -> Term:
        formulas = token.text in OF_FORMULAS
        if self.token.text != "(":
            example = "(c + 0.2*b)" if formulas else "(frequency=20)"
            self.refuse(f"{token.text} needs its arguments, such as {token.text}{example}")
        begin, formula = self.token.place, []
        if formulas:
            self.take()
            begin, text = self._formula()
            formula = [text]
        given = self._arguments(token)
        self.take()
        try:
            return self.makers[token.text](*formula, **given)
        except FormulaError as error:
            self.refuse(error.what, begin + error.place)
        except InputError as error:
            self.refuse(str(error), token.place)
        except TypeError:
            self.refuse(f"{token.text} does not take the arguments {', '.join(given)}", token.place)

    def _formula(self) -> tuple[int, str]:
        """The start of the next formula, and its text, which may be in quotes."""
        quote = self.take().text if self.token.text in {'"', "'"} else ""
        begin = self.token.place
        parse_formula(self, VOCABULARY)
        end = self.token.place
        if quote:
            self.close(quote)
        if self.token.text not in {",", ")"}:
            self.refuse("expected + - * / ^ , or )")
        return begin, self.text[begin:end].rstrip()

    def _arguments(self, token: Token) -> dict[str, Argument]:
        """Named arguments up to the closing bracket."""
        given: dict[str, Argument] = {}
        while self.token.text != ")":
            self.take()
            name = self.take()
            if name.kind != "name" or self.token.text != "=":
                example = "start=0.1" if token.text in OF_FORMULAS else "frequency=20"
                self.refuse(f"expected an argument of {token.text} such as {example}", name.place)
            if name.text in given:
                self.refuse(f"{name.text} is given twice", name.place)
            self.take()
            given[name.text] = self._value()
            if self.token.text not in {",", ")"}:
                self.refuse("expected , or )")
        return given

    def _value(self) -> Argument:
        if self.token.kind in {"name", "table"}:
            return self.take().text
        if self.token.text != "(":
            return self._number()
        self.take()
        low = self._number()
        if self.token.text != ",":
            self.refuse("expected , between two numbers")
        self.take()
        high = self._number()
        self.close()
        return low, high

    def _number(self) -> float:
        negative = self.token.text == "-"
        if negative:
            self.take()
        if self.token.kind != "number":
            self.refuse("expected a number")
        size = float(self.take().text)
        return -size if negative else size

    def _maximum(self) -> Expression:
        self.take()
        if self.token.text != "(":
            self.refuse("expected ( after max")
        self.take()
        parts = [self._part()]
        while self.token.text == ",":
            self.take()
            parts.append(self._part())
        self.close()
        if len(parts) < 2:
            self.refuse("max needs at least two parts")
        return maximum(*parts).expression()

    def _part(self) -> Expression:
        place = self.token.place
        value = self.sum()
        if isinstance(value, float):
            self.refuse("a part of max needs a constant of the law", place)
        if value.vanishes:
            self.refuse("a weight must be above 0", self.zero)
        return value


@lru_cache(maxsize=256)
def expression(text: str) -> Expression:
    """The objective of a text, such as "C + 0.1*J".

    >>> expression("0.5*C/4 + C_cam(frequency=20)")
    0.125*C + C_cam(frequency=20.0)
    """
    return parse(text, WITHOUT_ARGUMENTS, MAKERS)


def named(text: str) -> Functional:
    """The constant that a text names.

    >>> named("rms_c"), named("residual(frequency=(18, 22))")
    (rms_c, residual(frequency=(18.0, 22.0)))
    """
    terms = expression(text).terms
    (weight, constant), *others = terms
    if others or weight != 1.0 or not isinstance(constant, Functional):
        raise InputError(f"{text!r} is no constant of a law but an expression")
    return constant


def title_of(name: str) -> str:
    """Title in messages and tables of a constant, by its name.

    >>> title_of("rms_c"), title_of("peak(c + 3*b)")
    ('rms_c', 'peak(c + 3*b)')
    """
    if name in WITHOUT_ARGUMENTS:
        return name
    try:
        return named(name).title
    except InputError:
        return name


def is_named(term: Term) -> bool:
    """Whether the constant's name identifies it, so that text can stand for it.

    >>> from optlaws import C
    >>> is_named(C)
    True
    """
    text = repr(term)
    if FUNCTIONALS.get(text) == term or PLAIN.get(text) == term:
        return True
    if text.partition("(")[0] not in MAKERS:
        return False
    try:
        return named(text) == term
    except InputError:
        return False


def apart(text: str) -> list[str]:
    """Parts of a text between commas outside brackets.

    >>> apart("residual(frequency=(18, 22)), C")
    ['residual(frequency=(18, 22))', 'C']
    """
    parts, depth = [""], 0
    for character in text:
        depth += (character == "(") - (character == ")")
        if character == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += character
    return [part.strip() for part in parts]
