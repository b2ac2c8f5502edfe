"""Upper bounds of the violations of a problem's conditions by a law."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from math import inf, isfinite
from typing import NamedTuple

from flint import arb, ctx, fmpq_poly, fmpz_poly

from optlaws.numerics.exact import rounded_up
from optlaws.synthesis.families import names
from optlaws.synthesis.problem.constants import Functional
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.problem.ranges import Range
from optlaws.synthesis.problem.windows import Window
from optlaws.synthesis.spaces.bases import Basis, Pieces, PiecewiseBasis, PolynomialBasis
from optlaws.synthesis.spaces.free_pieces import PeriodicPieces
from optlaws.tolerances import BOUND_FEASIBILITY, COEFFICIENT_ROUNDING
from optlaws.verification.enclosing.balls import Extremes, ball, rational, upper
from optlaws.verification.enclosing.pieces import PolynomialPiece
from optlaws.verification.enclosing.space import unknown_basis
from optlaws.verification.enclosing.taylor_models import between, least_and_greatest
from optlaws.verification.exact.law import ExactLaw

_BREAK_ROUNDING = 2.0**-50  # of k: by so much rounding moves a break to its mirror image


@dataclass(frozen=True)
class Excess:
    """The greatest violation of a condition (0 or less: none), and the part that rounding explains.

    Nothing is known of it where its enclosure has no end.
    """

    name: str
    by: float
    allowed: float
    known: bool = True

    @property
    def holds(self) -> bool:
        """Whether the condition holds up to rounding."""
        return self.by <= self.allowed


def excesses(problem: Problem, law: ExactLaw) -> list[Excess]:
    """Every condition of the problem, at the law."""
    with ctx.workprec(law.precision):
        return [
            *_shape(problem, law),
            *_ends(problem, law),
            *_repeated(problem, law),
            *_velocity(problem, law),
            *(excess for constant, limits in problem.bounded for excess in _constant(law, constant, limits)),
            *_windows(problem, law),
        ]


def _of(name: str, value: arb, scale: float = 1.0, tolerance: float = BOUND_FEASIBILITY, least: float = 1.0) -> Excess:
    """`scale` is of the condition's numbers; `least` of its quantity in smooth laws, for numbers that are 0."""
    by = rounded_up(upper(value)) + 0.0 if value.is_finite() else inf
    return Excess(name, by, tolerance * max(least, scale), value.is_finite())


def _ends(problem: Problem, law: ExactLaw) -> Iterator[Excess]:
    conditions = problem.conditions
    for k, values in ((0, conditions.start), (1, conditions.end)):
        for nu, value in enumerate(values):
            off = arb(abs(law.value(nu, Fraction(k)) - rational(Fraction(value))))
            yield _of(f"derivative {nu} at k = {k}", off, _size(law, nu), COEFFICIENT_ROUNDING)
    if problem.symmetric:
        a = law.polynomials
        low, high = least_and_greatest([extreme for pair in _facing(a) for extreme in _uneven(*pair)])
        yield _of("a(k) + a(1-k) = 1", law.magnitude((low, high)), _size(law, 0), COEFFICIENT_ROUNDING)


def _repeated(problem: Problem, law: ExactLaw) -> Iterator[Excess]:
    """Conditions of a repeating law: it ends as it begins, and has no acceleration on straight pieces."""
    basis, pieces = problem.basis, law.polynomials
    if not isinstance(basis, PeriodicPieces) or len(pieces) != len(basis.breaks) - 1:
        return
    for nu in range(1, basis.continuity + 1):
        jump = abs(pieces[-1].exact(nu, pieces[-1].stop) - pieces[0].exact(nu, pieces[0].start))
        yield _of(f"derivative {nu} at the end as at the start", arb(jump), _size(law, nu), COEFFICIENT_ROUNDING)
    for i in basis.straight:
        yield _of(
            f"acceleration on piece {i}", ball(sum(map(abs, pieces[i].stored))), _size(law, 2), COEFFICIENT_ROUNDING
        )


def _shape(problem: Problem, law: ExactLaw) -> Iterator[Excess]:
    """The law's degree, and where it is piecewise its breaks and how smooth it is there."""
    shape = _shape_of(problem.basis, problem.order)
    beyond = [abs(term) for piece in law.polynomials for term in piece.stored[max(shape.degree - 1, 0) :]]
    yield _of("terms above the degree", arb(sum(beyond)), _size(law, 0), COEFFICIENT_ROUNDING)
    if len(shape.breaks) != len(law.breaks):
        detail = f"{len(law.breaks) - 1} pieces instead of {len(shape.breaks) - 1}"
        yield Excess(detail, inf, 0.0)
        return
    if len(shape.breaks) == 2:
        return
    breaks = _folded(shape.breaks) if problem.symmetric else shape.breaks
    apart = max(abs(place - other) for place, other in zip(breaks, law.breaks, strict=True))
    yield _of("breaks", ball(apart), 1.0, _BREAK_ROUNDING)
    for nu in range(1, shape.continuity + 1):
        sides = ((left.exact(nu, left.stop), right.exact(nu, right.start)) for left, right in pairwise(law.polynomials))
        jump = max(abs(after - before) for before, after in sides)
        yield _of(f"continuity of derivative {nu}", arb(jump), _size(law, nu), COEFFICIENT_ROUNDING)


def _folded(breaks: list[Fraction]) -> list[Fraction]:
    """Breaks of symmetric laws: those beyond 1/2, given as rounded numbers, are mirror images of the others."""
    half = [k for k in breaks if 2 * k <= 1]
    return [*half, *(1 - k for k in reversed(half) if 2 * k < 1)]


def _facing(pieces: list[PolynomialPiece]) -> Iterator[tuple[PolynomialPiece, PolynomialPiece, Fraction, Fraction]]:
    """Pieces, with those that their mirror images meet, and from where to where."""
    for piece in pieces:
        for other in reversed(pieces):
            low, high = max(piece.start, 1 - other.stop), min(piece.stop, 1 - other.start)
            if low < high:
                yield piece, other, low, high


def _uneven(piece: PolynomialPiece, other: PolynomialPiece, low: Fraction, high: Fraction) -> tuple[arb, arb]:
    """Least and greatest a(k) + a(1-k) - 1."""
    # the y of the other piece at 1 - k, as a function of this one's
    slope = -other.rate / piece.rate
    mirrored = fmpq_poly([other.local(1 - low) - slope * piece.local(low), slope])
    return between(piece.derivative(0) + other.derivative(0)(mirrored) - 1, piece.local(low), piece.local(high))


def _size(law: ExactLaw, nu: int) -> float:
    """A bound of the derivative's rounding, where every coefficient of c is rounded."""
    return max(_size_of(piece, nu) for piece in law.polynomials)


def _size_of(piece: PolynomialPiece, nu: int) -> float:
    size = 1.0 + sum(map(abs, piece.stored))
    top = fmpz_poly.chebyshev_t(len(piece.stored))
    for _ in range(nu - 2):
        top = 2 * top.derivative()
    return size * float(top(1)) / float(piece.stop - piece.start) ** max(nu - 2, 0)


def _velocity(problem: Problem, law: ExactLaw) -> Iterator[Excess]:
    limits = problem.range("B")
    least, greatest = law.extremes(1)
    speed, reached = (-least).max(greatest), (-least).max(greatest)
    if problem.peak_at is not None:
        peak = Fraction(problem.peak_at)
        reached = arb(law.value(1, peak))
        scale = max(1.0, rounded_up(upper(speed)))
        yield _of(f"b <= {names.at('b', problem.peak_at)}", greatest - reached, scale)
        if problem.inflexion is not None and not problem.symmetric:
            yield _of(names.acceleration_at_peak(problem.peak_at), arb(abs(law.value(2, peak))), scale)
        if problem.peak_is_variable:
            yield _of(f"-b <= {names.at('b', problem.peak_at)}", -least - reached, scale)
    if limits is not None:
        if isfinite(limits.high):
            yield _of("|b| <= B", speed - ball(limits.high), limits.high)
        if limits.fixed and problem.peak_at is not None:
            yield _of(names.velocity_at_peak(problem.peak_at), abs(reached - ball(limits.high)), limits.high)
        elif limits.low > 0.0:
            yield _of(names.at_least("B"), ball(limits.low) - reached, limits.low)
    if problem.monotone:
        yield _of("b >= 0", -least)


def _constant(law: ExactLaw, constant: Functional, limits: Range) -> Iterator[Excess]:
    value, scale = law.term(constant), constant.scale
    if isfinite(limits.high):
        yield _of(names.at_most(constant.name), value - ball(limits.high), limits.high, least=scale)
    if limits.low > 0.0:
        yield _of(names.at_least(constant.name), ball(limits.low) - value, limits.low, least=scale)


def _extremes(window: Window, law: ExactLaw) -> Extremes:
    """Least and greatest value of the quantity that a window bounds, over its range."""
    if window.motion is None:
        return law.extremes(window.nu, Fraction(window.start), Fraction(window.stop))
    greatest = law.greatest_of(window.motion, 1.0) if isfinite(window.high) else arb(0)
    least = -law.greatest_of(window.motion, -1.0) if isfinite(window.low) else arb(0)
    return least, greatest


def _windows(problem: Problem, law: ExactLaw) -> Iterator[Excess]:
    for i, window in enumerate(problem.windows, 1):
        (least, greatest), scale = _extremes(window, law), window.scale
        if isfinite(window.high):
            yield _of(
                names.window_side(names.window(i), 1.0), greatest - ball(window.high), abs(window.high), least=scale
            )
        if isfinite(window.low):
            yield _of(names.window_side(names.window(i), -1.0), ball(window.low) - least, abs(window.low), least=scale)


class _Shape(NamedTuple):
    """Degree of a(k) on each piece, the breaks, and up to which order its derivatives are continuous there."""

    degree: int
    breaks: list[Fraction]
    continuity: int


def _shape_of(basis: Basis, order: int) -> _Shape:
    if isinstance(basis, PolynomialBasis):
        # without a Z there are 2l conditions, with one l more powers at either end
        return _Shape(2 * order + basis.degree, [Fraction(0), Fraction(1)], 0)
    if isinstance(basis, PiecewiseBasis | Pieces):
        # of pieces the end conditions are equations
        beside = 0 if isinstance(basis, Pieces) else 2 * order
        return _Shape(beside + basis.degree, [Fraction(k) for k in basis.breaks], basis.continuity)
    raise unknown_basis(basis)
