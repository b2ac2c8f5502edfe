"""Numbers and comments as programming languages write them: digits enough for the same number to come back."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

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
