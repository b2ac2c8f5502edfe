"""Numbers and headings as tables of controllers have them."""

from __future__ import annotations

from collections.abc import Iterable

from optlaws.exports.code.literals import safe
from optlaws.files.writing import MARK
from optlaws.motion.motion import Motion


def plain(value: float, digits: int | None = None, decimal: str = ".") -> str:
    """A number without an exponent: all digits that a double needs, or so many behind the decimal sign.

    Examples
    --------
    >>> plain(1e-05), plain(2.5, 3, ","), plain(-1e-9, 3), plain(120.0)
    ('0.00001', '2,500', '0.000', '120')
    """
    return plain_column([value], digits, decimal)[0]


def plain_column(values: Iterable[float], digits: int | None = None, decimal: str = ".") -> list[str]:
    """Many numbers as `plain` writes one."""
    if digits is None:
        texts = [repr(value + 0.0) for value in values]
        texts = [_positional(text) if "e" in text else text.removesuffix(".0") for text in texts]
    else:
        texts = [f"{value:.{digits}f}" for value in values]
        texts = [text[1:] if text.startswith("-") and not text.strip("-0.") else text for text in texts]
    return texts if decimal == "." else [text.replace(".", decimal) for text in texts]


def _positional(text: str) -> str:
    from numpy import format_float_positional

    return format_float_positional(float(text), trim="-")


def heading(motion: Motion, target: str) -> tuple[str, ...]:
    """What the head of a file says, line by line; the mark is at the end of the last."""
    units = motion.units
    rate = "" if units.rate is None or units.master == "s" else f", {units.rate:.9g} {units.master}/s"
    master = f"master in {units.master} from {motion.start:.9g} to {motion.stop:.9g}{rate}"
    return (f"{target}: {master}, slave in {units.slave}", *motion.proof, MARK)


def iec_comment(lines: tuple[str, ...]) -> str:
    """Lines as a comment of IEC 61131-3."""
    return "\n".join(["(*", *(f"   {line}" for line in safe(lines)), "*)", ""])
