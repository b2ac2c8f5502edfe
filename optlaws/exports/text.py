"""Numbers, comments and headings in the files of controllers."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from decimal import ROUND_CEILING, Context

import numpy as np

from optlaws.exports.error_bounds import FloatingPoint, error_bounds
from optlaws.files.writing import MARK
from optlaws.motion.motion import Motion
from optlaws.motion.polynomials import PiecewiseMotion

WIDTH = 110


def real(value: float, *, single: bool = False) -> str:
    """A number with a point, as IEC 61131-3 and C both read it; for REAL32 the fewest digits that give it back.

    Examples
    --------
    >>> real(1e-7), real(0.1), real(-35.0), real(0.1, single=True)
    ('1.0E-7', '0.1', '-35.0', '0.1')
    """
    text = str(np.float32(value)) if single else repr(float(value))
    mantissa, _, exponent = text.partition("e")
    mantissa = mantissa if "." in mantissa else f"{mantissa}.0"
    return f"{mantissa}E{int(exponent)}" if exponent else mantissa


def wrapped(items: Sequence[str], indent: str) -> list[str]:
    """Items with commas between them, in lines of bearable length.

    Examples
    --------
    >>> wrapped(["1.0", "2.0"], "  ")
    ['  1.0, 2.0']
    """
    lines: list[str] = []
    line = indent
    for i, item in enumerate(items):
        piece = item + (", " if i + 1 < len(items) else "")
        if len(line) + len(piece) > WIDTH and line != indent:
            lines.append(line.rstrip())
            line = indent
        line += piece
    return [*lines, line.rstrip()]


def safe(lines: Iterable[str]) -> list[str]:
    """Lines of a comment that cannot end it, nor nest one: in no language that is written here.

    Examples
    --------
    >>> safe(["a */ b (* c *)", "two" + chr(10) + "lines"])
    ['a * / b ( * c * )', 'two', 'lines']
    """
    printable: list[str] = []
    for line in lines:
        for part in line.splitlines() or [""]:
            text = part
            for mark in ("*/", "/*", "(*", "*)", "//", "??"):
                text = text.replace(mark, f"{mark[0]} {mark[1]}")
            printable.append("".join(c if c.isprintable() else "?" for c in text.rstrip("\\ ")))
    return printable


QUANTITIES = ("position", "velocity", "acceleration", "jerk")


@dataclass(frozen=True)
class Labels:
    """Units of master and slave as comments write them, and whatever else a program shall say.

    Examples
    --------
    >>> Labels("s", "mm").unit(2)
    'mm/s^2'
    """

    master: str = "s"
    slave: str = "mm"
    notes: tuple[str, ...] = ()

    def unit(self, nu: int) -> str:
        """The unit of a derivative."""
        return self.slave if nu == 0 else f"{self.slave}/{self.master}" + (f"^{nu}" if nu > 1 else "")


def program_heading(motion: PiecewiseMotion, labels: Labels, arithmetics: Sequence[FloatingPoint]) -> list[str]:
    """Lines that say what a program evaluates, its peaks, and the bound of its rounding errors.

    Examples
    --------
    >>> program_heading(PiecewiseMotion([0, 1], [[0, 0, 3, -2]]), Labels("s", "mm"), [])[0]
    'y(x) in mm for x from 0.0 to 1.0 s: 1 polynomial of degree 3'
    """
    count = len(motion.coefficients)
    plural = "s" if count > 1 else ""
    interval = f"for x from {motion.start!r} to {motion.stop!r} {labels.master}"
    lines = [
        f"y(x) in {labels.slave} {interval}: {count} polynomial{plural} of degree {motion.degree}",
        *labels.notes,
        *(_peaks(motion, nu, labels.unit(nu)) for nu in range(len(QUANTITIES))),
    ]
    for arithmetic in arithmetics:
        bounds = error_bounds(motion, arithmetic)
        bounds_in_words = ", ".join(f"{rounded_up(bound)} {labels.unit(nu)}" for nu, bound in enumerate(bounds))
        lines += [f"rounding in {arithmetic.name}, proven, at most: {bounds_in_words}"]
    return lines


def rounded_up(bound: float) -> str:
    """A bound in three digits, none below it.

    Examples
    --------
    >>> rounded_up(2.7101e-5)
    '2.72e-05'
    """
    return f"{Context(prec=3, rounding=ROUND_CEILING).create_decimal_from_float(bound):.2e}"


def _peaks(motion: PiecewiseMotion, nu: int, unit: str) -> str:
    low, high = motion.extremes(nu)
    return f"{QUANTITIES[nu]} from {low.value:.9g} at x = {low.x:.9g} to {high.value:.9g} at x = {high.x:.9g} {unit}"


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


def table_heading(motion: Motion, target: str) -> tuple[str, ...]:
    """The lines at the head of a file; the mark is at the end of the last."""
    units = motion.units
    rate = "" if units.rate is None or units.master == "s" else f", {units.rate:.9g} {units.master}/s"
    master = f"master in {units.master} from {motion.start:.9g} to {motion.stop:.9g}{rate}"
    return (f"{target}: {master}, slave in {units.slave}", *motion.proof, MARK)


def iec_comment(lines: tuple[str, ...]) -> str:
    """Lines as a comment of IEC 61131-3."""
    return "\n".join(["(*", *(f"   {line}" for line in safe(lines)), "*)", ""])
