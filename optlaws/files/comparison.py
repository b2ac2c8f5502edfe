"""Whether two files agree: the same words, and the same numbers up to the rounding of different machines."""

from __future__ import annotations

import json
import re
from decimal import Decimal
from typing import Any

from optlaws.tolerances import SHOWN_DIGITS

_FILE_NOISE = 1e-9  # numbers of two files that differ by less say the same: a gap of 1e-10 is as good as one of 1e-9
_PEAK_PLACE = 1e-6  # of k: the place of a smooth peak is known to the root of rounding alone

# a printed number of so many digits was rounded, one of fewer is meant so
ROUNDED = 6
# in units of a picture, which is some 500 wide
PICTURE = 0.05

_NUMBER = re.compile(r"(?<![\w#.])-?\d+(?:\.\d+)?(?:[eE][+-]?\d+)?(?!\w)")
_PROOFS = {"certificate", "power_certificate"}
# names that matplotlib makes of a digest of what they name
_NAME = re.compile(r"\b[mp][0-9a-f]{10}\b")
# where each start of a search led: which of them were lost is rounding
_WORKING = {"starts"}


def say_the_same(first: bytes, second: bytes, kind: str, digits: int | None = None) -> bool:
    """Whether two contents of a file differ in rounding alone; the kind is the ending of the file's name.

    In JSON numbers must be equal in eight digits, or as many as mean something, within a list in those of its greatest,
    and places of peaks may differ by 1e-6; a proof is the same if it proves the same, whatever the multipliers behind
    it. In tables the last of six or more digits may differ by one, in pictures places by 0.05. Others must be equal.

    Examples
    --------
    >>> say_the_same(b"C = 5.5721384", b"C = 5.5721385", ".md"), say_the_same(b"C = 5.57", b"C = 5.58", ".md")
    (True, False)
    """
    if first == second:
        return True
    if kind not in {".json", ".csv", ".md", ".svg"}:
        return False
    try:
        texts = [content.decode() for content in (first, second)]
        if kind == ".json":
            values = [json.loads(text) for text in texts]
            return _same_values(*values, relative=SHOWN_DIGITS if digits is None else 10.0**-digits)
    except ValueError:
        return False
    if kind == ".svg":
        texts = [_renamed(text) for text in texts]
    return _same_texts(*texts, picture=kind == ".svg", digits=digits)


def _renamed(picture: str) -> str:
    order = {name: f"name-{i}-" for i, name in enumerate(dict.fromkeys(_NAME.findall(picture)))}
    return _NAME.sub(lambda match: order[match[0]], picture)


def _same_texts(first: str, second: str, *, picture: bool = False, digits: int | None = None) -> bool:
    if _words(first) != _words(second):
        return False
    numbers = zip(_NUMBER.findall(first), _NUMBER.findall(second), strict=True)
    return all(a == b or _same_printed(Decimal(a), Decimal(b), picture=picture, digits=digits) for a, b in numbers)


def _words(text: str) -> list[str]:
    # a table is as wide as its numbers
    return re.sub(r"-{2,}", "--", _NUMBER.sub("#", text)).split()


def _same_printed(first: Decimal, second: Decimal, *, picture: bool, digits: int | None) -> bool:
    off = abs(first - second)
    parts = [number.as_tuple() for number in (first, second)]
    last = min(int(part.exponent) for part in parts)
    if off <= _FILE_NOISE or last >= 0 or max(len(part.digits) for part in parts) < min(ROUNDED, digits or ROUNDED):
        return off <= _FILE_NOISE
    allowed = Decimal(1).scaleb(last)
    if picture:
        allowed = max(allowed, Decimal(str(PICTURE)))
    if digits is not None:
        allowed = max(allowed, max(abs(first), abs(second)).scaleb(-digits))
    return off <= allowed


def _same_values(first: Any, second: Any, *, relative: float, key: str = "", scale: float = 0.0) -> bool:
    if isinstance(first, dict) and isinstance(second, dict):
        return first.keys() == second.keys() and all(
            _same_values(first[name], second[name], relative=relative, key=name)
            for name in first
            if not (name in _WORKING or (key in _PROOFS and isinstance(first[name], list)))
        )
    if isinstance(first, list) and isinstance(second, list):
        scale = max((abs(value) for value in [*first, *second] if _is_number(value)), default=0.0)
        return len(first) == len(second) and all(
            _same_values(a, b, relative=relative, key=key, scale=scale) for a, b in zip(first, second, strict=True)
        )
    if _is_number(first) and _is_number(second):
        allowed = max(_FILE_NOISE, relative * max(scale, abs(first), abs(second)), _PEAK_PLACE if key == "k" else 0.0)
        return bool(first == second or abs(first - second) <= allowed)
    if isinstance(first, str) and isinstance(second, str):
        return _same_texts(first, second)
    return first is second


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)
