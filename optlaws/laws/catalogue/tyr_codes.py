"""Coded laws of Tyr's catalogue: mmnn(p), straight ramp, plateau and a fall like x^p, and KCmm, ramp and cosine."""

from __future__ import annotations

import re
from math import pi

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.laws.making.trapezoids import from_half, trapezoid
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.laws.segments.segment import Segment
from optlaws.laws.segments.sine import SineSegment

_TRAPEZOID = re.compile(r"(\d\d)(\d\d)(?:\((\d+(?:[.,]\d+)?)\))?")
_COSINE = re.compile(r"KC(\d\d)", re.IGNORECASE)


def canonical(text: str) -> str | None:
    """A code as printed, with a decimal comma and without an exponent of 1; None where a text is no code.

    Examples
    --------
    >>> canonical("0317 (1.50)"), canonical("0510(1)"), canonical("kc05"), canonical("K")
    ('0317(1,5)', '0510', 'KC05', None)
    """
    plain = text.replace(" ", "")
    if match := _TRAPEZOID.fullmatch(plain):
        power = float((match[3] or "1").replace(",", "."))
        return match[1] + match[2] + ("" if power == 1.0 else f"({power:.15g})".replace(".", ","))
    return plain.upper() if _COSINE.fullmatch(plain) else None


def coded(code: str) -> PiecewiseLaw:
    """The law of a code.

    `mmnn(p)`: c rises straight for mm hundredths of the motion, is constant for nn and falls to zero at k = 1/2 like
    x^p, x the time to it (p = 1 without brackets; decimal comma or point). `KCmm`: c rises along a quarter sine for mm
    hundredths and falls along a raised cosine. c is odd about k = 1/2.

    Parameters
    ----------
    code
        The code, for example "0510", "0317(1,5)" or "KC05".

    Raises
    ------
    InputError
        If it is no code, ramp and plateau exceed half the motion, or p is zero.

    Examples
    --------
    >>> coded("0510")
    PiecewiseLaw(segments=6, B=1.62162, C=5.40541, D=4.41741, J=108.108)
    >>> coded("KC00").constants.B
    Peak(value=1.423199, k=0.5)
    """
    plain = code.replace(" ", "")
    if match := _TRAPEZOID.fullmatch(plain):
        ramp, plateau = int(match[1]), int(match[2])
        _check_room(code, ramp + plateau)
        return trapezoid(ramp / 100, plateau / 100, exponent=float((match[3] or "1").replace(",", ".")))
    if match := _COSINE.fullmatch(plain):
        _check_room(code, int(match[1]))
        return _cosine(int(match[1]) / 100)
    raise InputError(f"a law code is mmnn, mmnn(p) or KCmm, for example 0317(1,5) or KC05; got {shortened(code)}")


def _check_room(code: str, hundredths: int) -> None:
    if hundredths > 50:
        raise InputError(f"code {code!r}: the accelerating half has 50 hundredths of the motion, not {hundredths}")


def _cosine(ramp: float) -> PiecewiseLaw:
    fall = 0.5 - ramp
    pieces: list[tuple[float, Segment]] = []
    if ramp:
        pieces.append((ramp, SineSegment(1.0, 0.5 * pi / ramp)))
    if fall:
        pieces.append((fall, SineSegment(0.5, pi / fall, 0.5 * pi, powers=(0.5,))))
    return from_half(pieces)
