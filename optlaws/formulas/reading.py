"""The grammar of formulas. Nothing is ever evaluated as Python, and size and depth are bounded.

::

    sum    = [sign] product { ("+" | "-") product }
    product = signed { ("*" | "/") signed }
    signed = [sign] power
    power  = atom [ ("^" | "**") signed ]
    atom   = number | name | function "(" sum { "," sum } ")" | "(" sum ")"
             | ("table" | "spline") "(" sum "," place ":" value { "," place ":" value } ")"
"""

from __future__ import annotations

import re
from collections.abc import Collection
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import NoReturn

from optlaws.echo import shortened, unknown_key
from optlaws.errors import InputError
from optlaws.formulas.tree import (
    SMOOTH_FUNCTIONS,
    Call,
    Exponentiation,
    Formula,
    Name,
    Negative,
    Number,
    Reciprocal,
    Table,
    TableJoin,
    product,
    total,
)
from optlaws.numbers import MAGNITUDE_LIMIT

_TOKEN = re.compile(
    r"""\s*(?:(?P<number>\d+\.?\d*(?:[eE][+-]?\d+)?|\.\d+(?:[eE][+-]?\d+)?)|(?P<name>[A-Za-z_]\w*)"""
    r"""|'(?P<table>\{[^']*\})'|(?P<sign>[-+*/(),=^:"']))"""
)
_BLANK = re.compile(r"\s*")
_SHOWN = 120


@dataclass(frozen=True)
class Token:
    """A number, name, table (in JSON, a machine) or sign with its place in the text; an empty text ends the list."""

    kind: str
    text: str
    place: int


class FormulaError(InputError):
    """An error in the text of a formula, with its place.

    Parameters
    ----------
    what
        What is wrong.
    text
        The whole text.
    place
        The index of the character.

    Examples
    --------
    >>> print(FormulaError("expected a number", "c + ?", 4))
    expected a number
      c + ?
          ^
    """

    def __init__(self, what: str, text: str, place: int) -> None:
        self.what, self.text, self.place = what, text, place
        first = max(0, place - _SHOWN // 2)
        before, after = "..." if first else "", "..." if first + _SHOWN < len(text) else ""
        shown = f"{before}{text[first : first + _SHOWN]}{after}"
        super().__init__(f"{what}\n  {shown}\n  {' ' * (len(before) + place - first)}^")

    def __reduce__(self) -> tuple[type[FormulaError], tuple[str, str, int]]:
        return FormulaError, (self.what, self.text, self.place)


class Scanner:
    """The tokens of a text, one after the other; what reads a grammar derives from it.

    >>> scanner = Scanner("c + 2")
    >>> scanner.take().text, scanner.token.text, scanner.following.text
    ('c', '+', '2')
    """

    def __init__(self, text: str, signs: frozenset[str] | None = None) -> None:
        self.text, self._signs = text, signs
        self.tokens = self._read()
        self._at = 0

    def _read(self) -> list[Token]:
        tokens, place, end = [], 0, len(self.text.rstrip())
        while place < end:
            match = _TOKEN.match(self.text, place)
            if match is None:
                place = _BLANK.match(self.text, place).end()  # type: ignore[union-attr] # blanks may be none
                raise FormulaError(f"{self.text[place]!r} is not understood", self.text, place)
            kind = str(match.lastgroup)
            tokens.append(Token(kind, match.group(kind), match.start(kind)))
            place = match.end()
        return [*tokens, Token("end", "", len(self.text))]

    @property
    def token(self) -> Token:
        """The next token of the text."""
        return self.tokens[self._at]

    @property
    def following(self) -> Token:
        """The token after the next one."""
        return self.tokens[min(self._at + 1, len(self.tokens) - 1)]

    def take(self) -> Token:
        """The next token, which is then done with."""
        token = self.token
        self._at = min(self._at + 1, len(self.tokens) - 1)
        return token

    def refuse(self, what: str, place: int | None = None) -> NoReturn:
        """Raise the error that points at a place, the next token's unless given."""
        token = self.token
        if place is None and token.kind == "sign" and self._signs is not None and token.text not in self._signs:
            what = f"{token.text!r} is not understood"
        raise FormulaError(what, self.text, token.place if place is None else place)

    def close(self, sign: str = ")") -> None:
        """Take a sign that must come next."""
        if self.token.text != sign:
            self.refuse(f"expected {sign}")
        self.take()


#: functions by name, with the fewest and the most parts that they take
FUNCTIONS = {
    **dict.fromkeys((*SMOOTH_FUNCTIONS, "abs"), (1, 1)),
    **dict.fromkeys(("max", "min", "norm"), (2, 12)),
}
#: with the derivatives of those that are smooth, as they are printed
TABLES = ("monotone", "monotone1", "monotone2", "spline", "spline1", "spline2", "table", "table1")
CONSTANTS = ("pi",)
LONGEST = 1_000_000
DEEPEST = 40
_FEWEST = {"table": 2, "monotone": 2, "spline": 4}
_MOST_PLACES = 400
_SMOOTH: dict[str, TableJoin] = {"spline": "spline", "monotone": "monotone"}


def read(text: str, names: Collection[str] | None = None) -> Formula:
    """Read a formula such as `c + 0.2*b` or `(1 + sin(2*pi*k))*c^2`.

    Parameters
    ----------
    text
        The formula: + - * / ^, brackets, numbers, pi, sin cos tan atan tanh exp log sqrt abs, max min norm of several
        parts, and tables: `table(k, 0:1, 0.5:2, 1:1)` of straight lines, `spline(...)` of a cubic
        spline, `monotone(...)` of cubics that never leave the range of their neighbours.
    names
        The names that may be in it; any unless given.

    Raises
    ------
    InputError
        If the text is no formula; the message shows it and points at the character.

    Examples
    --------
    >>> read("c+0.2*b"), read("-(b + 1)^2/2")
    (c + 0.2*b, -(b + 1)^2/2)
    >>> read("c + 0.2*v", names="abcjk")
    Traceback (most recent call last):
    optlaws.formulas.reading.FormulaError: unknown name 'v'; known are a, b, c, j, k
      c + 0.2*v
              ^
    """
    if not isinstance(text, str):
        raise InputError(f"a formula must be a text, got {shortened(text)}")
    if len(text) > LONGEST:
        raise InputError(f"a formula may have {LONGEST} characters, got {len(text)}")
    return _whole(text, None if names is None else tuple(names))


@lru_cache(maxsize=64)
def _whole(text: str, names: tuple[str, ...] | None) -> Formula:
    scanner = Scanner(text)
    formula = parse(scanner, names)
    if scanner.token.kind != "end":
        scanner.refuse("expected + - * / ^ or the end")
    return formula


def parse(scanner: Scanner, names: Collection[str] | None = None) -> Formula:
    """The formula that comes next in a text.

    Raises
    ------
    FormulaError
        If there is none.
    """
    return _Parser(scanner, names).sum(0)


class _Parser:
    def __init__(self, scanner: Scanner, names: Collection[str] | None) -> None:
        self.scanner, self.names = scanner, names
        self._known: dict[Formula, Formula] = {}

    def _once(self, formula: Formula) -> Formula:
        """The formula that stands first in the text of those that are equal: what is computed of it is kept with it."""
        return self._known.setdefault(formula, formula)

    def sum(self, depth: int) -> Formula:
        place = self._deeper(depth)
        terms = [self._term(depth)]
        while self.scanner.token.text in {"+", "-"}:
            terms.append(self._term(depth))
        return self._once(total(terms, place))

    def _term(self, depth: int) -> Formula:
        """A product with the sign before it."""
        place, minus = self.scanner.token.place, False
        if self.scanner.token.text in {"+", "-"}:
            minus = self.scanner.take().text == "-"
        product = self._product(depth)
        return self._once(Negative(product, place=place)) if minus else product

    def _product(self, depth: int) -> Formula:
        place = self.scanner.token.place
        factors = [self._signed(depth)]
        while self.scanner.token.text in {"*", "/"}:
            sign = self.scanner.take()
            factor = self._signed(depth)
            factors.append(self._once(Reciprocal(factor, place=sign.place)) if sign.text == "/" else factor)
        return self._once(product(factors, place))

    def _signed(self, depth: int) -> Formula:
        place = self._deeper(depth)
        if self.scanner.token.text in {"+", "-"}:
            minus = self.scanner.take().text == "-"
            factor = self._signed(depth + 1)
            return self._once(Negative(factor, place=place)) if minus else factor
        base = self._atom(depth)
        if not self._raises():
            return base
        return self._once(Exponentiation(base, self._signed(depth + 1), place=place))

    def _raises(self) -> bool:
        """Take the sign of a power, ^ or **, if it comes next."""
        token, following = self.scanner.token, self.scanner.following
        twice = token.text == following.text == "*" and following.place == token.place + 1
        if token.text != "^" and not twice:
            return False
        for _ in range(1 + twice):
            self.scanner.take()
        return True

    def _atom(self, depth: int) -> Formula:
        token = self.scanner.token
        if token.kind == "number":
            return self._once(Number(self._magnitude(), place=token.place))
        if token.text == "(":
            self.scanner.take()
            inner = self.sum(depth + 1)
            self.scanner.close()
            return inner
        if token.kind != "name":
            self.scanner.refuse("expected a number, a name, a function or (")
        if self.scanner.following.text == "(":
            return self._call(depth)
        if self.names is not None and token.text not in self.names and token.text not in CONSTANTS:
            if token.text in FUNCTIONS or token.text in TABLES:
                self.scanner.refuse(f"{token.text} needs what it is of, in brackets")
            self.scanner.refuse(unknown_key(token.text, self.names, "name"))
        self.scanner.take()
        return self._once(Name(token.text, place=token.place))

    def _call(self, depth: int) -> Formula:
        token = self.scanner.token
        if token.text not in FUNCTIONS and token.text not in TABLES:
            self.scanner.refuse(unknown_key(token.text, (*FUNCTIONS, *TABLES), "function"))
        self.scanner.take()
        self.scanner.take()
        arguments = [self.sum(depth + 1)]
        if token.text in TABLES:
            return self._once(self._table(token.text, arguments[0], token.place))
        while self.scanner.token.text == ",":
            self.scanner.take()
            arguments.append(self.sum(depth + 1))
        self.scanner.close()
        fewest, most = FUNCTIONS[token.text]
        if not fewest <= len(arguments) <= most:
            parts = "one part" if most == 1 else f"{fewest} to {most} parts"
            self.scanner.refuse(f"{token.text} takes {parts}, got {len(arguments)}", token.place)
        return self._once(Call(token.text, tuple(arguments), place=token.place))

    def _table(self, kind: str, of: Formula, place: int) -> Formula:
        pairs: list[tuple[float, float]] = []
        while self.scanner.token.text == ",":
            self.scanner.take()
            where = self._number()
            self.scanner.close(":")
            pairs.append((where, self._number()))
        self.scanner.close()
        joined = kind.rstrip("12")
        fewest = _FEWEST[joined]
        if not fewest <= len(pairs) <= _MOST_PLACES:
            self.scanner.refuse(f"{kind} needs {fewest} to {_MOST_PLACES} pairs such as 0:1, got {len(pairs)}", place)
        if any(x >= y for (x, _), (y, _) in pairwise(pairs)):
            self.scanner.refuse(f"the places of {kind} must ascend", place)
        places, values = zip(*pairs, strict=True)
        return Table(of, places, values, _SMOOTH.get(joined, "table"), int(kind[len(joined) :] or 0), place=place)

    def _number(self) -> float:
        minus = self.scanner.token.text == "-"
        if minus:
            self.scanner.take()
        if self.scanner.token.kind != "number":
            self.scanner.refuse("expected a number")
        value = self._magnitude()
        return -value if minus else value

    def _magnitude(self) -> float:
        token = self.scanner.token
        value = float(token.text)
        if value > MAGNITUDE_LIMIT:
            self.scanner.refuse(f"numbers may be {MAGNITUDE_LIMIT:g} at most", token.place)
        self.scanner.take()
        return value

    def _deeper(self, depth: int) -> int:
        if depth > DEEPEST:
            self.scanner.refuse(f"a formula may be nested {DEEPEST} deep", self.scanner.token.place)
        return self.scanner.token.place


def refused(what: str, text: str, part: Formula) -> FormulaError:
    """The error that points at a part of a formula.

    Examples
    --------
    >>> print(refused("no", "c + b", read("c + b").parts[1]))
    no
      c + b
          ^
    """
    return FormulaError(what, text, part.place)
