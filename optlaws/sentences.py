"""Sentences that keep the quantities in them: they print as text, and a page writes the numbers in its own units."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite
from typing import Any, Self

_POWERS = {ord("^"): None, ord("2"): "²", ord("3"): "³", ord("4"): "⁴"}  # as a page writes them


class Amount(str):
    """A number with its unit as text, "616 mm/s", which is known as both."""

    __slots__ = ("digits", "unit", "value")

    value: float
    unit: str
    digits: int

    def __new__(cls, value: float, unit: str, digits: int = 6) -> Self:
        """Write a number in a unit, to so many digits."""
        written = super().__new__(cls, f"{value:.{digits}g} {unit}".rstrip())
        written.value, written.unit, written.digits = float(value), unit, digits
        return written

    def __getnewargs__(self) -> tuple[float, str, int]:  # type: ignore[override] # of a copy
        return self.value, self.unit, self.digits

    def on_page(self, digits: int) -> Amount:
        """The amount to other digits, with its unit as a page writes it.

        >>> Amount(21.31600001, "m/s^2").on_page(5)
        '21.316 m/s²'
        """
        return Amount(self.value, self.unit.translate(_POWERS), digits)

    def to_dict(self) -> Any:
        """Its value, None where it is not finite, its unit and digits; the text alone of what has no unit."""
        value = self.value if isfinite(self.value) else None
        unit = self.unit.translate(_POWERS)
        return {"value": value, "unit": unit, "digits": self.digits} if unit else str(self)


class Sentence(str):
    """A text with the parts of which it is made: pieces of text and quantities."""

    __slots__ = ("parts",)

    parts: tuple[str, ...]

    def __new__(cls, *parts: str) -> Self:
        """Put texts and amounts together to one."""
        text = super().__new__(cls, "".join(parts))
        text.parts = parts
        return text

    def __getnewargs__(self) -> tuple[str, ...]:  # type: ignore[override] # of a copy
        return self.parts


def sentence(template: str, *values: object) -> Sentence:
    """A template with values in place of its braces; quantities stay quantities, also those of sentences in it.

    Examples
    --------
    >>> taken = sentence("velocity, {} of {}", Amount(840.0, "mm/s"), "616 mm/s")
    >>> whole = sentence("beyond what is allowed: {}", taken)
    >>> whole
    'beyond what is allowed: velocity, 840 mm/s of 616 mm/s'
    >>> whole.parts
    ('beyond what is allowed: velocity, ', '840 mm/s', ' of 616 mm/s')
    >>> whole.parts[1].value
    840.0
    """
    first, *rest = template.split("{}")
    parts = [first]
    for value, text in zip(values, rest, strict=True):
        whole = value if isinstance(value, str) else str(value)
        parts += whole.parts if isinstance(whole, Sentence) else (whole,)
        parts.append(text)
    merged: list[str] = []
    for part in parts:
        if merged and not isinstance(part, Amount) and not isinstance(merged[-1], Amount):
            merged[-1] += part
        elif part:
            merged.append(part)
    return Sentence(*merged)


def joined(separator: str, sentences: Any) -> Sentence:
    """Sentences as one, with a text between them.

    Examples
    --------
    >>> joined("; ", [sentence("up to {}", Amount(2.0, "mm")), "then down"]).parts
    ('up to ', '2 mm', '; then down')
    """
    every = tuple(sentences)
    return sentence(separator.join(["{}"] * len(every)), *every)


def capital(text: str) -> Sentence:
    """A sentence with a capital at its start.

    Examples
    --------
    >>> capital("no undercut.")
    'No undercut.'
    """
    first, *rest = text.parts if isinstance(text, Sentence) else (text,)
    return Sentence(first[:1].upper() + first[1:], *rest)


def parts_of(text: object) -> Any:
    """A sentence as JSON has it: a text, or a list of texts and {value, unit, digits} where there are quantities.

    Examples
    --------
    >>> parts_of(sentence("up to {}", Amount(2.0, "mm"))), parts_of(sentence("{} laws", 3))
    (['up to ', {'value': 2.0, 'unit': 'mm', 'digits': 6}], '3 laws')
    """
    if isinstance(text, Amount):
        return text.to_dict()
    if isinstance(text, str) and not isinstance(text, Sentence):
        return str(text)  # a quantity that is known, which a page has as text
    if not isinstance(text, Sentence):
        raise TypeError(f"{type(text).__name__} is no sentence")
    parts = [part.to_dict() if isinstance(part, Amount) else part for part in text.parts]
    return parts if any(isinstance(part, dict) for part in parts) else "".join(text.parts)


def quantity_name(name: str) -> str:
    """The name of a quantity in texts, from that of files.

    >>> quantity_name("rms torque"), quantity_name("root mean square of the torque"), quantity_name("torque")
    ('RMS torque', 'RMS torque', 'torque')
    """
    for word in ("rms ", "root mean square of the "):
        if name.startswith(word):
            return f"RMS {name.removeprefix(word)}"
    return name


def listed(names: Sequence[str], word: str = "and") -> str:
    """Names in a sentence.

    Examples
    --------
    >>> listed(["velocity", "jerk", "force"], "or")
    'velocity, jerk or force'
    """
    *first, last = names
    return sentence("{} {} {}", joined(", ", first), word, last) if first else last
