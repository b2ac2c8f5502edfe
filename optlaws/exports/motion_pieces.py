"""Motions as polynomials in machine units: exact where laws are made of such, else within a certified deviation."""

from __future__ import annotations

from itertools import pairwise
from math import factorial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from optlaws.cycles.asked.conversion import Piece
from optlaws.cycles.cycle import Cycle
from optlaws.errors import InputError
from optlaws.exporting import exports
from optlaws.exports.interpolation import hermite
from optlaws.exports.law_pieces import is_polynomial, polynomials_of_law
from optlaws.exports.motion import Motion, motion_of_cycle, motion_of_law
from optlaws.exports.polynomials import PiecewiseMotion
from optlaws.laws import MotionLaw
from optlaws.numbers import positive

Array = NDArray[np.float64]

TOLERANCE = 1e-9
_ORDERS = 4  # derivatives at both ends, so that pieces have the degree 7
_MOST = 4096
_ROUNDING = 2.0**-50


def pieces_of_motion(motion: Motion, tolerance: float = TOLERANCE) -> PiecewiseMotion:
    """The polynomials of a motion between breaks, in units of its master and slave.

    Parameters
    ----------
    motion
        The motion.
    tolerance
        How far the position may be from the law's, as a share of the stroke, where laws are not made of polynomials
        or of ones whose powers lose more digits than that: certified by the law's eighth derivative.

    Raises
    ------
    InputError
        If that derivative grows without limit, or too many pieces would be needed.

    Examples
    --------
    >>> from optlaws.laws import smoothstep
    >>> motion = motion_of_law(smoothstep(2), stroke="35 mm", time="0.1 s")
    >>> [round(one, 6) for one in pieces_of_motion(motion).coefficients[0]]
    [0.0, 0.0, 10500.0, -70000.0]
    """
    share = positive(tolerance, "tolerance")
    parts = [_of_piece(piece, share * motion.stroke) for piece in motion.pieces]
    breaks = [x for part in parts for x in part.breaks[:-1]]
    return PiecewiseMotion([*breaks, motion.stop], [row for part in parts for row in part.coefficients])


@exports("pieces_of_law")
def pieces_of_law(law: MotionLaw, tolerance: float = TOLERANCE, **said: Any) -> PiecewiseMotion:  # noqa: ANN401
    """The polynomials of a law with its stroke, time and master, as `motion_of_law` takes them."""
    return pieces_of_motion(motion_of_law(law, **said), tolerance)


@exports("pieces_of_cycle")
def pieces_of_cycle(cycle: Cycle, tolerance: float = TOLERANCE, **said: Any) -> PiecewiseMotion:  # noqa: ANN401
    """The polynomials of a cycle with its master, as `motion_of_cycle` takes it."""
    return pieces_of_motion(motion_of_cycle(cycle, **said), tolerance)


def _of_piece(piece: Piece, tolerance: float) -> PiecewiseMotion:
    if piece.stroke == 0.0:
        return PiecewiseMotion([piece.start, piece.stop], [[piece.offset]])
    if is_polynomial(piece.law):
        exact = polynomials_of_law(piece.law, piece.stroke, piece.duration)
        sizes = np.abs(exact.powers()) * exact.lengths[:, None] ** np.arange(exact.degree + 1)
        if _ROUNDING * float(sizes.sum(axis=1).max()) <= tolerance:
            return _moved(exact, piece)
    breaks = _fine(piece, tolerance)
    values = np.array([piece.stroke * piece.law(breaks, nu) / piece.duration**nu for nu in range(_ORDERS)])
    return _moved(hermite(piece.duration * breaks, values), piece)


def _moved(motion: PiecewiseMotion, piece: Piece) -> PiecewiseMotion:
    """The motion where its piece lies: laws begin at 0 and with their own displacement."""
    height = piece.offset - piece.stroke * float(piece.law.a(0.0))
    rows = [(row[0] + height, *row[1:]) for row in motion.coefficients]
    return PiecewiseMotion([piece.start + x for x in motion.breaks], rows)


def _fine(piece: Piece, tolerance: float) -> Array:
    """Places k between which Hermite's polynomials of degree 7 are near enough.

    They are off by (h/2)^8 / 8! times the greatest eighth derivative between their ends, at most.
    """
    order = 2 * _ORDERS
    found: list[float] = [0.0]
    waiting = list(pairwise(piece.law.breaks))[::-1]
    while waiting:
        low, high = waiting.pop()
        steepest = max(abs(one.value) for one in piece.law.extrema(order, within=(low, high)))
        off = abs(piece.stroke) * (0.5 * (high - low)) ** order / factorial(order) * steepest
        if off <= tolerance:
            found.append(high)
        elif len(found) + len(waiting) > _MOST or not np.isfinite(off):
            raise InputError(
                f"the law does not become polynomials within {tolerance:.3g}: its derivatives grow without limit near "
                f"k = {low:.6g}; take a greater tolerance, a law of polynomials, or a format of points"
            )
        else:
            middle = 0.5 * (low + high)
            waiting += [(middle, high), (low, middle)]
    return np.array(found)
