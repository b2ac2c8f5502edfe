"""Proven fronts with every rounding enclosed: single laws and certificates, and the bounds between by convexity."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise

from optlaws.synthesis.limits.rounding import rounded_up
from optlaws.synthesis.proven.front import FrontPoint, ProvenFront
from optlaws.synthesis.proven.swept_parameter import SweptParameter
from optlaws.tolerances import CORRECTED_MULTIPLIER, NO_OBJECTIVE
from optlaws.verification.conditions import Excess, excesses
from optlaws.verification.enclosing.balls import enclosed
from optlaws.verification.exact.bound import Along, Proof, prove_along
from optlaws.verification.exact.law import ExactLaw
from optlaws.verification.result import Claim, Verification

_STATED_GAP = 1e-12  # by how much a gap that was computed in doubles may be below the proven one


@dataclass(frozen=True)
class _Known:
    """Proven data of one certified law: bounds of the least objective, their slopes, and violations."""

    at: Fraction
    top: Fraction
    top_slope: Fraction
    proof: Proof
    broken: tuple[Excess, ...]
    worst: float


def proven_front(front: ProvenFront, stated: float) -> Verification:
    """Check every law and certificate of a front, and its gap at every value between."""
    number, (low, high) = front.number, front.between
    points = list(front)
    laws = [ExactLaw(point.law) for point in points]
    claim = 2.0 * float(front.sides[:, 0].max())
    known = [_known(front, point, law, claim) for point, law in zip(points, laws, strict=True)]
    gap = _gap(known, number)
    claims = [*_laws(number, known), *_certificates(number, known)]
    where = f"the gap at every {number.name} from {low!r} to {high!r}"
    shown = "not known" if gap is None else f"{gap:.3e}"
    claims.append(Claim(where, gap is not None and gap <= stated + _STATED_GAP, f"{stated:.3e} stated, {shown} proven"))
    return Verification(problem=number.at(low), bound=None, gap=gap, claims=tuple(claims))


def _known(front: ProvenFront, point: FrontPoint, law: ExactLaw, claim: float) -> _Known:
    number = front.number
    excess_of_laws = excesses(point.problem, law)
    top = Fraction(enclosed(law.sum(point.problem.objective))[1])
    slope = Fraction(enclosed(law.term(number.weighted))[1]) if number.concave else Fraction(0)
    proof = prove_along(point.certificate, _along(front, point, claim))
    broken = tuple(excess for excess in excess_of_laws if not excess.holds)
    return _Known(
        Fraction(point.value), top, slope, proof, broken, max((excess.by for excess in excess_of_laws), default=0.0)
    )


def _along(front: ProvenFront, point: FrontPoint, claim: float) -> Along:
    number, (low, high) = front.number, front.between
    if number.concave:
        return Along(None, Fraction(1), number.at(low), claim)
    other = high if point.value < high else low
    return Along(number.at(other), Fraction(other) - Fraction(point.value), number.at(high), claim)


def _laws(number: SweptParameter, known: list[_Known]) -> Iterator[Claim]:
    wrong = [point for point in known if point.broken]
    if wrong:
        first = wrong[0]
        detail = f"{first.broken[0].name} is broken by {first.broken[0].by:.1e} at {number.name} = {float(first.at)!r}"
        yield Claim("laws", proven=False, detail=f"{len(wrong)} of {len(known)} break conditions: {detail}")
        return
    worst = max(point.worst for point in known)
    yield Claim("laws", proven=True, detail=f"{len(known)} keep every condition, off by at most {max(worst, 0.0):.1e}")


def _certificates(number: SweptParameter, known: list[_Known]) -> Iterator[Claim]:
    wrong = [point for point in known if point.proof.value is None or point.proof.negative or point.proof.unknown]
    changed = max(point.proof.correction for point in known)
    detail = (
        f"{len(known)} prove a bound, corrected by at most {changed:.1e} of the greatest multiplier"
        if not wrong
        else (
            f"{len(wrong)} of {len(known)} prove nothing or have contacts that do not count, the first at "
            f"{number.name} = {float(wrong[0].at)!r}"
        )
    )
    yield Claim("certificates", not wrong and changed <= CORRECTED_MULTIPLIER, detail)


def _gap(known: list[_Known], number: SweptParameter) -> float | None:
    """The greatest gap of any value, relative as of a solution, rounded up."""
    gaps = [_between(point, other, number) for point, other in pairwise(known)]
    return None if None in gaps else rounded_up(max(gap for gap in gaps if gap is not None))


def _between(point: _Known, other: _Known, number: SweptParameter) -> Fraction | None:
    """The greatest difference of a chord and two lines, each an affine function: at the ends or where they cross."""
    if point.proof.value is None or other.proof.value is None:
        return None
    width = other.at - point.at
    if number.concave:
        differences = [
            (point.top - point.proof.value, point.top + point.top_slope * width - other.proof.value),
            (other.top - other.top_slope * width - point.proof.value, other.top - other.proof.value),
        ]
    else:
        rise, fall = point.proof.slope[0] * width, other.proof.slope[1] * width
        differences = [
            (point.top - point.proof.value, other.top - point.proof.value - rise),
            (point.top - other.proof.value + fall, other.top - other.proof.value),
        ]
    (first, last), (second, end) = differences
    turn = (last - first) - (end - second)
    shares = [Fraction(0), Fraction(1), *([(second - first) / turn] if turn else [])]
    gaps = [min(first + (last - first) * s, second + (end - second) * s) for s in shares if 0 <= s <= 1]
    least = min(point.top, other.top)
    scale = Fraction(number.problem.objective.scale)
    return max(gaps) / (least if least > Fraction(NO_OBJECTIVE) * scale else scale)
