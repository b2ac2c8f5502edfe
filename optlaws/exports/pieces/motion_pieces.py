"""Motions as polynomials in machine units: exact where laws are made of such, else within a certified deviation."""

from __future__ import annotations

from functools import reduce
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from optlaws.errors import InputError
from optlaws.exports.pieces.fitting import LawSection
from optlaws.exports.pieces.law_pieces import is_polynomial, polynomials_of_law
from optlaws.laws import MotionLaw
from optlaws.motion.motion import Motion, motion_of_law
from optlaws.motion.piece import Piece
from optlaws.motion.polynomials import PiecewiseMotion
from optlaws.numbers import positive

Array = NDArray[np.float64]

TOLERANCE = 1e-9
_ORDERS = 4  # derivatives at both ends, so that pieces have the degree 7
_MOST = 4096
_ROUNDING = 2.0**-50
_LEAST = 16.0  # terms that sum up to so many strokes are no cause to halve pieces


def pieces_of_motion(motion: Motion, tolerance: float = TOLERANCE) -> PiecewiseMotion:
    """The polynomials of a motion between breaks, in units of its master and slave.

    Parameters
    ----------
    motion
        The motion.
    tolerance
        How far the position may be from the law's, as a share of the stroke, where laws are not made of polynomials:
        over the whole interval, no grid. Polynomials whose powers lose more digits than that are halved, which
        changes no value.

    Raises
    ------
    InputError
        If derivatives are infinite, or too many pieces would be needed.

    Examples
    --------
    >>> from optlaws.laws import smoothstep
    >>> motion = motion_of_law(smoothstep(2), stroke="35 mm", time="0.1 s")
    >>> [round(coefficient, 6) for coefficient in pieces_of_motion(motion).coefficients[0]]
    [0.0, 0.0, 10500.0, -70000.0]
    """
    share = positive(tolerance, "tolerance")
    parts = [_of_piece(piece, share * motion.stroke) for piece in motion.pieces]
    breaks = [x for part in parts for x in part.breaks[:-1]]
    return PiecewiseMotion([*breaks, motion.stop], [row for part in parts for row in part.coefficients])


def pieces_of_law(law: MotionLaw, tolerance: float = TOLERANCE, **placement: Any) -> PiecewiseMotion:  # noqa: ANN401
    """The polynomials of a law with its stroke, time and master, as `motion_of_law` takes them."""
    return pieces_of_motion(motion_of_law(law, **placement), tolerance)


def _of_piece(piece: Piece, tolerance: float) -> PiecewiseMotion:
    if piece.stroke == 0.0:
        return PiecewiseMotion([piece.start, piece.stop], [[piece.offset]])
    if is_polynomial(piece.law):
        cancelled = max(tolerance / (_ROUNDING * abs(piece.stroke)), _LEAST)
        return _moved(polynomials_of_law(piece.law, piece.stroke, piece.duration, cancelled=cancelled), piece)
    stretches = [LawSection(piece.law, ends) for ends in pairwise(piece.law.breaks)]
    near = reduce(PiecewiseMotion.then, (_near(stretch, tolerance / abs(piece.stroke)) for stretch in stretches))
    return _moved(near.in_units(piece.duration, piece.stroke), piece)


def _moved(motion: PiecewiseMotion, piece: Piece) -> PiecewiseMotion:
    """The motion where its piece lies: laws begin at 0 and with their own displacement."""
    height = piece.offset - piece.stroke * float(piece.law.a(0.0))
    rows = [(row[0] + height, *row[1:]) for row in motion.coefficients]
    return PiecewiseMotion([piece.start + x for x in motion.breaks], rows)


def _near(stretch: LawSection, tolerance: float) -> PiecewiseMotion:
    """So many of Hermite's polynomials of degree 7 on a stretch, each time twice as many, that they are near enough."""
    count = 1
    while count <= _MOST:
        run = stretch.hermite(np.linspace(*stretch.ends, count + 1), _ORDERS)
        if stretch.off(run, 0) <= tolerance:
            return run
        count *= 2
    raise InputError(
        f"{_MOST} polynomials do not come within {tolerance:.3g} of the law near k = {stretch.ends[0]:.6g}: take a "
        "greater tolerance, a law of polynomials, or a format of points"
    )
