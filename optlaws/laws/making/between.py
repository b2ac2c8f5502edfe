"""Laws between two laws: their weighted means, derivative by derivative."""

from __future__ import annotations

from optlaws.errors import InputError
from optlaws.laws.law import MotionLaw
from optlaws.laws.polynomial import PolynomialLaw
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.laws.segments.segment import PolynomialSegment


def law_between(first: MotionLaw, last: MotionLaw, share: float) -> MotionLaw:
    """The law (1 - share) first + share last, of two that are polynomials, or polynomials between the same breaks.

    Raises
    ------
    InputError
        If they are of different kinds or breaks, or no polynomials.

    Examples
    --------
    >>> from optlaws.laws.polynomial import smoothstep
    >>> law_between(smoothstep(2), smoothstep(3), 0.5).b(0.5)
    1.6875
    """
    if isinstance(first, PolynomialLaw) and isinstance(last, PolynomialLaw):
        mean = _mean(first.acceleration, last.acceleration, share)
        return PolynomialLaw(mean, *_mean((first.a0, first.b0), (last.a0, last.b0), share))
    if isinstance(first, PiecewiseLaw) and isinstance(last, PiecewiseLaw) and first.breaks == last.breaks:
        segments = [
            _segment(segment, other, share) for segment, other in zip(first.segments, last.segments, strict=True)
        ]
        return PiecewiseLaw(first.breaks, segments, *_mean((first.a0,), (last.a0,), share))
    raise InputError(
        f"laws between two laws need polynomials, or polynomials with the same breaks, got {first!r} and {last!r}"
    )


def _segment(first: object, last: object, share: float) -> PolynomialSegment:
    if not isinstance(first, PolynomialSegment) or not isinstance(last, PolynomialSegment):
        raise InputError(f"laws between two laws need polynomial segments, got {first!r} and {last!r}")
    return PolynomialSegment(
        tuple(_mean(first.acceleration, last.acceleration, share)), *_mean((first.b0,), (last.b0,), share)
    )


def _mean(first: tuple[float, ...], last: tuple[float, ...], share: float) -> list[float]:
    longest = max(len(first), len(last))
    padded = (series + (0.0,) * (longest - len(series)) for series in (first, last))
    return [(1.0 - share) * low + share * high for low, high in zip(*padded, strict=True)]
