"""Texts as tokens with their places, and errors that point at the character."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import NoReturn

from optlaws.errors import InputError

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
