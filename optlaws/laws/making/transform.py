"""Laws from laws: with an end velocity (eq. 1.17), reversed in time, mirrored, between two laws, a part of one."""

from __future__ import annotations

from itertools import pairwise

from optlaws.errors import InputError
from optlaws.laws.law import MotionLaw
from optlaws.laws.polynomial import PolynomialLaw
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.laws.segments.segment import PolynomialSegment
from optlaws.numbers import finite
from optlaws.numerics import chebyshev


def with_end_velocity(law: MotionLaw, b0: float) -> MotionLaw:
    """The law (1 - b0) a + b0 k (eq. 1.17): a rest-to-rest law then begins and ends with the velocity b0.

    C becomes |1 - b0| C and, for 0 <= b0 <= 1, B becomes (1 - b0) B + b0. A polynomial law stays one, a piecewise
    law keeps its segments in closed form; any other law becomes a polynomial, to machine accuracy.

    Parameters
    ----------
    law
        The law a, as a rule from rest to rest.
    b0
        Velocity at both ends, relative to the mean velocity.

    Raises
    ------
    InputError
        If `b0` is not a finite real number, or a law of another kind is not smooth.

    Examples
    --------
    >>> from optlaws import smoothstep
    >>> with_end_velocity(smoothstep(3), 0.25).b([0.0, 0.5, 1.0]).round(12).tolist()
    [0.25, 1.65625, 0.25]
    """
    velocity = finite(b0, "b0")
    return _scaled(law, 1.0 - velocity, velocity)


def reversed_law(law: MotionLaw) -> MotionLaw:
    """The law run backwards in time and in displacement, 1 - a(1 - k): a rise again, with the ends exchanged.

    A law that does not begin at 0 and end at 1 keeps its own ends. One whose graph is symmetric about its middle
    point is its own reverse.

    Parameters
    ----------
    law
        Any law; the result is of the same representation, as for `with_end_velocity`.

    Raises
    ------
    InputError
        If a law of another kind is not smooth.

    Examples
    --------
    >>> law = PolynomialLaw.from_powers([0, 0, 0, 4, -3])
    >>> reversed_law(law).c([0.0, 1.0]).tolist(), law.c([0.0, 1.0]).tolist()
    ([12.0, 0.0], [0.0, -12.0])
    """
    if isinstance(law, PolynomialLaw):
        turned = [coefficient if n % 2 else -coefficient for n, coefficient in enumerate(law.acceleration)]
        return PolynomialLaw(turned, law.a0, law.b(1.0))
    if isinstance(law, PiecewiseLaw):
        lengths = [end - start for start, end in pairwise(law.breaks)]
        turned_pieces = [segment.backwards(length) for segment, length in zip(law.segments, lengths, strict=True)]
        return PiecewiseLaw([1.0 - k for k in law.breaks[::-1]], turned_pieces[::-1], law.a0)
    return reversed_law(as_polynomial(law))


def mirrored_law(law: MotionLaw) -> MotionLaw:
    """The law reversed in time, a(1 - k): a fall whose flank is the mirror image of the rise's flank.

    The fall that runs like the rise, 1 - a(k), is the mirrored law of the reversed one.

    Parameters
    ----------
    law
        Any law; the result is of the same representation, as for `with_end_velocity`.

    Raises
    ------
    InputError
        If a law of another kind is not smooth.

    Examples
    --------
    >>> law = PolynomialLaw.from_powers([0, 0, 0, 4, -3])
    >>> mirrored_law(law)([0.0, 0.25, 1.0]).tolist() == law([1.0, 0.75, 0.0]).tolist()
    True
    >>> round(mirrored_law(reversed_law(law))(0.25) + law(0.25), 12)
    1.0
    """
    turned = _scaled(reversed_law(law), -1.0, 0.0)
    height = law.a(1.0) - turned.a(0.0)
    if isinstance(turned, PiecewiseLaw):
        return PiecewiseLaw(turned.breaks, turned.segments, turned.a0 + height)
    return PolynomialLaw(turned.acceleration, turned.a0 + height, turned.b0)


def as_polynomial(law: MotionLaw) -> PolynomialLaw:
    """A smooth law of any kind as a polynomial one, its acceleration interpolated to machine accuracy.

    Raises
    ------
    InputError
        If the acceleration is not smooth.

    Examples
    --------
    >>> from optlaws.laws.segments import SineSegment
    >>> as_polynomial(PiecewiseLaw([0, 1], [SineSegment(6.28, 6.28)])).degree > 15
    True
    """
    series = chebyshev.interpolated(lambda x: law.c(0.5 * (x + 1.0)), f"c of {type(law).__name__}")
    return PolynomialLaw(series, law.a(0.0), law.b(0.0))


def _scaled(law: MotionLaw, scale: float, drift: float) -> PolynomialLaw | PiecewiseLaw:
    if isinstance(law, PolynomialLaw):
        acceleration = [scale * coefficient for coefficient in law.acceleration]
        return PolynomialLaw(acceleration, scale * law.a0, scale * law.b0 + drift)
    if isinstance(law, PiecewiseLaw):
        lengths = [end - start for start, end in pairwise(law.breaks)]
        segments = [segment.scaled(length, scale, drift) for segment, length in zip(law.segments, lengths, strict=True)]
        return PiecewiseLaw(law.breaks, segments, scale * law.a0)
    return _scaled(as_polynomial(law), scale, drift)


def law_between(first: MotionLaw, last: MotionLaw, share: float) -> MotionLaw:
    """The law (1 - share) first + share last, of two that are polynomials, or polynomials between the same breaks.

    Raises
    ------
    InputError
        If they are of different kinds or breaks, or no polynomials.

    Examples
    --------
    >>> from optlaws import smoothstep
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


def section(law: PiecewiseLaw, first: int, last: int) -> PiecewiseLaw:
    """The part of a law of polynomials between two of its breaks, its displacement and its duration scaled to 1.

    Parameters
    ----------
    law
        Made of polynomial segments.
    first, last
        The numbers of the breaks.

    Raises
    ------
    InputError
        If a segment is no polynomial, or it ends where it begins.

    Examples
    --------
    >>> law = PiecewiseLaw([0, 0.5, 1], [PolynomialSegment([4.0]), PolynomialSegment([-4.0], b0=2.0)])
    >>> half = section(law, 0, 1)
    >>> half(1.0), half(1.0, 1), half(0.0, 2)
    (1.0, 2.0, 2.0)
    """
    start, stop = law.breaks[first], law.breaks[last]
    moved = float(law(stop)) - float(law(start))
    length = stop - start
    if moved == 0.0:
        raise InputError(f"the part of the law from {start:g} to {stop:g} ends where it begins")
    parts = []
    for segment in law.segments[first:last]:
        if not isinstance(segment, PolynomialSegment):
            raise InputError("a part can be taken of a law of polynomial segments only")
        bent = tuple(length * length / moved * value for value in segment.acceleration)
        parts.append(PolynomialSegment(bent, length / moved * segment.b0))
    inner = [(place - start) / length for place in law.breaks[first + 1 : last]]
    return PiecewiseLaw([0.0, *inner, 1.0], parts)
