"""Laws given by the shape of c while it accelerates: the rest is its mirror image, and the stroke sets the scale."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate

from optlaws.errors import InputError
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.laws.segments.segment import PolynomialSegment, Segment

Piece = tuple[float, Segment]

SHORTEST = 1e-12  # a shorter stretch is none: its ends would be one number, or nearly


def from_half(pieces: Sequence[Piece]) -> PiecewiseLaw:
    """The law of stroke 1 whose acceleration has a shape at first, is zero about k = 1/2 and then mirrors the shape.

    Parameters
    ----------
    pieces
        Lengths with segments, of any size of acceleration and any velocity at their start. Lengths below 1e-12 are
        left out; their sum is at most 1/2, and what is missing is run at a uniform velocity.

    Raises
    ------
    InputError
        If a length is negative, all are zero or their sum exceeds 1/2.

    Examples
    --------
    >>> from_half([(0.5, PolynomialSegment((1.0,)))])
    PiecewiseLaw(segments=2, B=2, C=4, D=8, J=inf)
    """
    kept = [piece for piece in pieces if abs(piece[0]) > SHORTEST]
    places = list(accumulate((length for length, _ in kept), initial=0.0))
    if not kept or min(length for length, _ in kept) < 0.0 or places[-1] > 0.5 + SHORTEST:
        lengths = ", ".join(f"{length:.6g}" for length, _ in pieces)
        raise InputError(
            f"lengths of a half cycle must be at least 0, not all 0, and at most 1/2 in all, got {lengths}"
        )
    if places[-1] > 0.5 - SHORTEST:
        places[-1] = 0.5
    rise = _joined([(b - a, segment) for a, b, (_, segment) in zip(places, places[1:], kept, strict=False)])
    top = rise[-1][1].velocity(rise[-1][0], last=True)
    coast: list[Piece] = [] if places[-1] == 0.5 else [(1.0 - 2.0 * places[-1], PolynomialSegment((), top))]
    fall = [(length, segment.backwards(length)) for length, segment in rise[::-1]]
    unit = [*rise, *coast, *fall]
    breaks = places + ([] if places[-1] == 0.5 else [1.0 - places[-1]]) + [1.0 - place for place in places[-2::-1]]
    scale = 1.0 / PiecewiseLaw(breaks, [segment for _, segment in unit]).a(1.0)
    return PiecewiseLaw(breaks, [segment.scaled(length, scale) for length, segment in unit])


def _joined(pieces: Sequence[Piece]) -> list[Piece]:
    velocity = 0.0
    joined: list[Piece] = []
    for length, segment in pieces:
        joined.append((length, segment.scaled(length, 1.0, velocity - segment.velocity(length))))
        velocity = joined[-1][1].velocity(length, last=True)
    return joined
