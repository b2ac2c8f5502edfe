"""Numbers and headings as tables of controllers have them."""

from __future__ import annotations

from optlaws.exports.code.literals import safe
from optlaws.exports.motion import Motion
from optlaws.files.writing import MARK


def plain(value: float, digits: int | None = None, decimal: str = ".") -> str:
    """A number without an exponent: all digits that a double needs, or so many behind the decimal sign.

    Examples
    --------
    >>> plain(1e-05), plain(2.5, 3, ","), plain(-1e-9, 3), plain(120.0)
    ('0.00001', '2,500', '0.000', '120')
    """
    from numpy import format_float_positional

    text = format_float_positional(value + 0.0, trim="-") if digits is None else f"{value:.{digits}f}"
    text = text[1:] if text.startswith("-") and not text.strip("-0.") else text
    return text.replace(".", decimal)


def heading(motion: Motion, target: str) -> tuple[str, ...]:
    """What the head of a file says, line by line; the mark is at the end of the last."""
    units = motion.units
    rate = "" if units.rate is None or units.master == "s" else f", {units.rate:.9g} {units.master}/s"
    master = f"master in {units.master} from {motion.start:.9g} to {motion.stop:.9g}{rate}"
    return (f"{target}: {master}, slave in {units.slave}", *motion.proof, MARK)


def iec_comment(lines: tuple[str, ...]) -> str:
    """Lines as a comment of IEC 61131-3."""
    return "\n".join(["(*", *(f"   {line}" for line in safe(lines)), "*)", ""])
