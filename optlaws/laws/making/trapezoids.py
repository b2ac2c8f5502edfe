"""Laws by the shape of c while it accelerates: sine-constant-cosine acceleration (SCCA), trapezoids and S-curves."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate, pairwise
from math import pi

from optlaws.errors import InputError
from optlaws.laws.segments.fractional import FractionalSegment
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.laws.segments.segment import PolynomialSegment, Segment
from optlaws.laws.segments.sine import SineSegment
from optlaws.numbers import finite
from optlaws.numerics.exact import chebyshev_from_powers
from optlaws.tolerances import SHORTEST_STRETCH

Piece = tuple[float, Segment]


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
    lasting = [piece for piece in pieces if abs(piece[0]) > SHORTEST_STRETCH]
    places = list(accumulate((length for length, _ in lasting), initial=0.0))
    if not lasting or min(length for length, _ in lasting) < 0.0 or places[-1] > 0.5 + SHORTEST_STRETCH:
        lengths = ", ".join(f"{length:.6g}" for length, _ in pieces)
        raise InputError(
            f"lengths of a half cycle must be at least 0, not all 0, and at most 1/2 in all, got {lengths}"
        )
    if places[-1] > 0.5 - SHORTEST_STRETCH:
        places[-1] = 0.5
    rise = _joined([(b - a, segment) for (a, b), (_, segment) in zip(pairwise(places), lasting, strict=True)])
    unit = [segment for _, segment in rise]
    if places[-1] < 0.5:
        unit.append(PolynomialSegment((), rise[-1][1].velocity(rise[-1][0], last=True)))
    unit += [segment.backwards(length) for length, segment in reversed(rise)]
    breaks = sorted({*places, *(1.0 - place for place in places)})
    scale = 1.0 / PiecewiseLaw(breaks, unit).a(1.0)
    return PiecewiseLaw(
        breaks, [segment.scaled(b - a, scale) for (a, b), segment in zip(pairwise(breaks), unit, strict=True)]
    )


def _joined(pieces: Sequence[Piece]) -> list[Piece]:
    velocity = 0.0
    joined: list[Piece] = []
    for length, segment in pieces:
        joined.append((length, segment.scaled(length, 1.0, velocity - segment.velocity(length))))
        velocity = joined[-1][1].velocity(length, last=True)
    return joined


HIGHEST_POWER = 12  # of a fall that is kept as a polynomial; above it a power of time is the more exact


def scca(a: float, b: float, c: float) -> PiecewiseLaw:
    """Sine-constant-cosine acceleration: sine ramp, constant, cosine fall, uniform velocity, and the mirror image.

    The modified trapezoid is (1/4, 1/2, 1/4), the modified sine (1/4, 0, 3/4), the cycloid (1/2, 0, 1/2), the simple
    harmonic (0, 0, 1), constant acceleration (0, 1, 0).

    Parameters
    ----------
    a, b, c
        Shares of the motion in which c runs along a sine, is constant and runs along a cosine, each counted over both
        halves; what is missing to 1 is run at a uniform velocity.

    Raises
    ------
    InputError
        If a share is negative, or their sum is zero or above 1.

    Examples
    --------
    >>> scca(1 / 4, 1 / 2, 1 / 4)
    PiecewiseLaw(segments=6, B=2, C=4.88812, D=8.08998, J=61.426)
    >>> scca(1 / 8, 0, 3 / 8).constants.B
    Peak(value=1.275258, k=0.25)
    """
    shares = finite(a, "a"), finite(b, "b"), finite(c, "c")
    if min(shares) < 0.0 or not 0.0 < sum(shares) <= 1.0 + SHORTEST_STRETCH:
        raise InputError(f"shares a, b, c must be at least 0, not all 0, and at most 1 in all, got {a}, {b}, {c}")
    sine, constant, cosine = shares
    pieces: list[tuple[float, Segment]] = []
    if sine > SHORTEST_STRETCH:
        pieces.append((0.5 * sine, SineSegment(1.0, pi / sine)))
    pieces.append((0.5 * constant, PolynomialSegment((1.0,))))
    if cosine > SHORTEST_STRETCH:
        pieces.append((0.5 * cosine, SineSegment(1.0, pi / cosine, 0.5 * pi)))
    return from_half(pieces)


def trapezoid(ramp: float, plateau: float, fall: float | None = None, *, exponent: float = 1.0) -> PiecewiseLaw:
    """Trapezoidal acceleration: straight ramp, plateau, fall like a power of time, uniform velocity, mirror image.

    With a straight fall it is an S-curve of constant jerks; without ramp and fall the velocity is a trapezoid.

    Parameters
    ----------
    ramp, plateau, fall
        Lengths within the accelerating half of the motion, [0, 1/2]; the fall reaches to k = 1/2 unless given.
    exponent
        The fall is (x / fall)^exponent, x the time to its end; above 0.

    Raises
    ------
    InputError
        If a length is negative, their sum is zero or above 1/2, or the exponent is not above 0.

    Examples
    --------
    >>> trapezoid(1 / 4, 0)
    PiecewiseLaw(segments=4, B=2, C=8, D=8.7093, J=32)
    >>> trapezoid(0, 1 / 3, 0)
    PiecewiseLaw(segments=3, B=1.5, C=4.5, D=6.75, J=inf)
    >>> trapezoid(0.03, 0.17, exponent=1.5).constants.C
    Peak(value=5.083146, k=0.03)
    """
    first, flat = finite(ramp, "ramp"), finite(plateau, "plateau")
    last = 0.5 - first - flat if fall is None else finite(fall, "fall")
    power = finite(exponent, "exponent")
    if power <= 0.0:
        raise InputError(f"exponent must be above 0, got {exponent}")
    pieces = [(first, PolynomialSegment((0.5, 0.5))), (flat, PolynomialSegment((1.0,))), (last, _fall(power))]
    return from_half(pieces)


def _fall(power: float) -> Segment:
    if power == int(power) and power <= HIGHEST_POWER:
        rise = [0] * int(power) + [1]
        turned = (-coefficient if n % 2 else coefficient for n, coefficient in enumerate(chebyshev_from_powers(rise)))
        return PolynomialSegment(tuple(turned))
    return FractionalSegment(power, 1.0, 0.0, (1.0,))
