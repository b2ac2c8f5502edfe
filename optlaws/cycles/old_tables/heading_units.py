"""Units in the headings of tables: words, words in brackets, and shares of units, as in "stroke [1/100 mm]"."""

from __future__ import annotations

import re
from typing import NamedTuple

from optlaws.echo import shortened
from optlaws.errors import InputError, located
from optlaws.motion.quantities import either

#: a size of a unit, as in 0.01 mm, 0,01 mm or 1e-2 mm
SIZE = r"(?:\d+(?:[.,]\d*)?|[.,]\d+)(?:[eE]-?\d+)?"
#: units as headings write them
NAMES = {"degree": "deg", "degrees": "deg", "°": "deg", "sec": "s", "turns": "turn", "revs": "rev"}
#: a degree in German, 1/400 of a turn in English
GRAD = "grad"
#: what devices count, of which a heading does not say how much one is
_COUNTS = {"steps", "counts", "increments", "incr", "inc", "pulses", "ticks"}
#: a word that may be a unit, with its size before it, its share behind it, or what else it is multiplied by
_WORD = re.compile(
    rf"(?:(?<![A-Za-z0-9.,])(?P<times>[x×*]\s*)?(?P<size>{SIZE}(?:\s*/\s*[1-9]\d*)?)[\s*·]*)?"
    r"(?P<unit>°|[A-Za-zµ]+)(?:\s*/\s*(?P<over>[1-9]\d*))?(?=(?P<more>\s*(?:[/*^×·]|x\s*\d)?))"
)
_BRACKETS = re.compile(r"\[([^\]]*)\]|\(([^)]*)\)")
_FACTOR = re.compile(r"[x×*/]\s*\d")
_POWER_OF_TEN = re.compile(r"10\s*(?:\^|\*\*)\s*-\s*(\d)")


class UnitOf(NamedTuple):
    """Which units a column may have, what the option is called that gives one, and an example."""

    dimensions: tuple[str, ...]
    option: str
    example: str

    @property
    def remedy(self) -> str:
        return f"say how much a number is, such as {self.option} = {self.example!r}"


MASTER = UnitOf(("angle", "time"), "master", "0.9 deg")
SLAVE = UnitOf(("length", "angle"), "unit", "0.01 mm")


def unit_in(heading: str, column: UnitOf, grad: str | None = None) -> str | None:
    """The unit in a heading, or which share or multiple of one; None where no word of it is one.

    A unit in brackets counts before others, and the last word before those to its left. A master is a length only in
    brackets, or where the unit stands alone. `grad` is what this word means, where that is known.

    Raises
    ------
    InputError
        If square brackets hold no unit that is known, a factor has no unit, or numbers count steps of a device.

    Examples
    --------
    >>> [unit_in(text, SLAVE) for text in ("stroke [mm/10]", "lift x0.01mm", "s / mm", "hub")]
    ['1/10 mm', '0.01 mm', 'mm', None]
    """
    with located(f"the heading {shortened(heading)}"):
        text = _POWER_OF_TEN.sub(r"1e-\1", heading.replace("²", "2").replace("³", "3").replace("⁻", "^-"))
        outside, inside = _BRACKETS.sub(" ", text).strip(), list(_BRACKETS.finditer(text))
        bracketed = [match[1] or match[2] or "" for match in inside]
        with_length = (*column.dimensions, "length")
        alone = len(outside) > 1 and outside.isalpha()
        units = [_last_unit(part, with_length, column, grad, bracketed=True) for part in bracketed]
        units.append(_last_unit(outside, with_length if alone else column.dimensions, column, grad))
        for match, part, unit in zip(inside, bracketed, units, strict=False):
            if unit is None and (match[1] is not None or _FACTOR.search(part)):
                raise InputError(f"{part!r} is no unit that is known here: {column.remedy}")
        unit = next(filter(None, units), None)
        if unit is None and _COUNTS & {match["unit"].lower() for match in _WORD.finditer(text)}:
            raise InputError(f"numbers are counts: {column.remedy}")
    return unit


def _last_unit(
    text: str, dimensions: tuple[str, ...], column: UnitOf, grad: str | None, *, bracketed: bool = False
) -> str | None:
    """The last word of a text that is a unit of these dimensions, with its size."""
    words = list(_WORD.finditer(text))
    for i, word in reversed(list(enumerate(words))):
        unit = _known(word["unit"], dimensions, column, grad)
        if unit is None:
            continue
        before = words[i - 1] if i else None
        of_another = before is not None and "/" in before["more"] and _known(before["unit"], dimensions, column, grad)
        if word["more"].strip() or of_another:
            raise InputError(f"it is not clear what is counted: {column.remedy}")
        return _with_size(unit, word, column, bracketed=bracketed)
    return None


def _with_size(unit: str, word: re.Match[str], column: UnitOf, *, bracketed: bool) -> str:
    """The unit with the number of it that is counted; outside of brackets a number may belong to the name."""
    size, over = word["size"], word["over"]
    if over is not None and size is None:
        return f"1/{over} {unit}"
    if size is None:
        return unit
    number = size_of(size)
    counted = bracketed or word["times"] is not None or number < 1.0
    if over is not None or (number in {10.0, 100.0, 1000.0} and not bracketed):
        raise InputError(f"it is not clear what is counted: {column.remedy}")
    return f"{size.replace(' ', '')} {unit}" if counted and number != 1.0 else unit


def size_of(text: str) -> float:
    """A size as a number: "1/100", "0,01"."""
    number, _, share = text.replace(",", ".").partition("/")
    return float(number) / int(share or 1)


def _known(word: str, dimensions: tuple[str, ...], column: UnitOf, grad: str | None) -> str | None:
    """The unit that a word is; None where it is none of these dimensions."""
    if word.lower() == GRAD:
        if grad is None:
            raise InputError(
                f"{word} is a degree or 1/400 of a turn: say which, by {column.option} = 'deg' or {column.option} = "
                "'gon'"
            )
        return grad
    unit = NAMES.get(word.lower(), word)
    if len(unit) == 1 and unit not in {"m", "s"}:
        return None
    try:
        either(f"1 {unit}", dimensions, "heading")
    except InputError:
        return None
    return unit
