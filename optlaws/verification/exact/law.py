"""A stored law as exact numbers, and rigorous enclosures of its constants."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import reduce
from itertools import pairwise
from math import isfinite
from typing import Any, TypeVar

from flint import arb, ctx, fmpq

from optlaws.errors import InputError
from optlaws.formulas.of_motion import MotionFormula
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw, PolynomialLaw
from optlaws.laws.segments.fractional import PowerSegment
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.laws.segments.segment import PolynomialSegment, Segment
from optlaws.laws.segments.sine import HarmonicSegment, SineSegment
from optlaws.mechanisms.machine.output_constants import OutputPeak, OutputRms
from optlaws.mechanisms.machine.residual import Residual
from optlaws.synthesis.functionals.formula_rows import split, squared
from optlaws.synthesis.functionals.kinds import FormulaIntegral, FormulaPeak, FormulaRms, FormulaValue
from optlaws.synthesis.problem.constants import (
    CombinedPeak,
    CombinedPower,
    Functional,
    PeakConstant,
    PeakJerk,
    PowerConstant,
    RootMeanSquare,
)
from optlaws.synthesis.problem.expression import Expression, Maximum, Term
from optlaws.synthesis.problem.named_constants import is_named
from optlaws.verification.enclosing.balls import Extremes, ball, enclosed, rational
from optlaws.verification.enclosing.pieces import ExactPiece, PolynomialPiece, PowerPiece, SinePiece
from optlaws.verification.enclosing.taylor_models import least_and_greatest
from optlaws.verification.exact.motion_formulas import extremes_of, integral_of
from optlaws.verification.machines.outputs import ExactOutput
from optlaws.verification.machines.residuals import exact_residual

OfFormula = FormulaIntegral | FormulaPeak | FormulaRms | FormulaValue
_OF_FORMULAS = {FormulaIntegral, FormulaPeak, FormulaRms, FormulaValue}
OfMachine = Residual | OutputPeak | OutputRms


@dataclass(frozen=True)
class DerivativePeak:
    """The peak magnitude of w0 a^(nu) + w1 a^(nu+1) + ..., which a user's own constant is."""

    name: str
    nu: int
    weights: tuple[Fraction, ...]

    def sides(self, *, symmetric: bool) -> list[tuple[str, tuple[Fraction, ...], tuple[float, ...]]]:  # noqa: ARG002 - as of a CombinedPeak
        """Names, weights and signs of its rows, those of half of a symmetric law too."""
        return [(self.name, self.weights, (1.0, -1.0))]


OfDerivatives = PeakConstant | PowerConstant | RootMeanSquare | CombinedPeak | DerivativePeak
Known = OfDerivatives | OfMachine | OfFormula

_OF_CAMS = tuple(f"{name}_cam(" for name in ("B", "C", "C_plus", "C_minus", "D", "J"))
_BY_NAME = (*_OF_CAMS, "residual(", "mode_residual(", "output_peak(", "output_rms(")


def known(term: Term) -> Known:
    """The constant, if optlaws itself defines it, for a law, a cam, a machine, or a formula, or derivatives do.

    Raises
    ------
    InputError
        If it is any other: what a subclass means, nobody has put into exact arithmetic.

    Examples
    --------
    >>> from optlaws import C
    >>> known(C).nu
    2
    """
    if type(term) in {PeakConstant, PeakJerk, RootMeanSquare} and isinstance(term, PeakConstant | RootMeanSquare):
        return term
    if type(term) is PowerConstant and tuple(term.weights) == (Fraction(1),):
        return term
    if (
        isinstance(term, CombinedPeak | CombinedPower | OfMachine)
        and repr(term).startswith(_BY_NAME)
        and is_named(term)
    ):
        return term
    if type(term) in _OF_FORMULAS and isinstance(term, OfFormula) and is_named(term):
        return term
    if isinstance(term, Functional) and term.derivatives():
        return of_derivatives(term)
    raise InputError(
        "exact verification knows peaks, power and RMS of derivatives, constants of cams, of machines and "
        f"of formulas as optlaws defines them, not {term!r}: what bounds it is checked in doubles, by "
        "Certificate.bound. A peak of derivatives is known by its method derivatives"
    )


def of_derivatives(constant: Functional) -> DerivativePeak:
    """The peak that a user's own constant says it is by its `derivatives`.

    Raises
    ------
    InputError
        If an order is no whole number from 1 on or comes twice, or a weight is not finite or is 0.
    """
    pairs = constant.derivatives()
    weights = dict(pairs)
    sound = all(type(nu) is int and nu > 0 and weight and isfinite(weight) for nu, weight in pairs)
    if not sound or len(weights) < len(pairs):
        raise InputError(
            f"derivatives of {constant!r} must be pairs of a whole number from 1 on, each once, and a finite weight "
            f"other than 0, got {pairs!r}"
        )
    low, high = min(weights), max(weights)
    exact = tuple(Fraction(weights.get(nu, 0)) for nu in range(low, high + 1))
    return DerivativePeak(constant.name, low, exact)


Enclosure = TypeVar("Enclosure")


class ExactLaw:
    """The very function that a law's floats describe, piece by piece.

    Where a derivative jumps by more than rounding, by `PiecewiseLaw.jumps`, those above it are infinite.
    """

    def __init__(self, law: MotionLaw) -> None:
        self.law = law
        if isinstance(law, PolynomialLaw):
            segments: tuple[Segment, ...] = (PolynomialSegment(law.acceleration, law.b0),)
            breaks = [0.0, 1.0]
        elif isinstance(law, PiecewiseLaw):
            segments, breaks = law.segments, list(law.breaks)
        else:
            raise InputError(f"exact verification knows polynomial and piecewise laws, got {type(law).__name__}")
        longest = max(len(piece.acceleration) if isinstance(piece, PolynomialSegment) else 0 for piece in segments)
        #: bits that leave every enclosure much narrower than a float's rounding, whatever the degree
        self.precision = 256 + 6 * longest
        self.start = Fraction(law.a0)
        self.breaks = [Fraction(k) for k in breaks]
        with ctx.workprec(self.precision):
            places = zip(segments, pairwise(self.breaks), strict=True)
            self.pieces = [_piece(segment, low, high) for segment, (low, high) in places]
        self._raise()
        self._extremes: dict[tuple[int, Fraction, Fraction], Extremes] = {}
        self._of_motions: dict[tuple[Any, MotionFormula], Any] = {}

    def _raise(self) -> None:
        """Let each polynomial begin at the end value of its predecessor."""
        height = rational(self.start)
        for piece in self.pieces:
            if not isinstance(piece, PolynomialPiece):
                return
            piece.raised(height)
            height = piece.exact(0, piece.stop)

    @property
    def polynomials(self) -> list[PolynomialPiece]:
        """The pieces of a law that consists of polynomials alone."""
        polynomials = [piece for piece in self.pieces if isinstance(piece, PolynomialPiece)]
        if len(polynomials) < len(self.pieces):
            raise InputError("the law of a solution must be piecewise polynomial")
        return polynomials

    def value(self, nu: int, k: Fraction) -> fmpq:
        """The derivative of order nu at k, exact; at a break, the later piece's value."""
        return [piece for piece in self.polynomials if piece.start <= k][-1].exact(nu, k)

    def extremes(self, nu: int, start: Fraction = Fraction(0), stop: Fraction = Fraction(1)) -> Extremes:
        """Balls that hold the least and the greatest value of the derivative of order nu between two k."""
        key = (nu, start, stop)
        if key not in self._extremes:
            with ctx.workprec(self.precision):
                self._extremes[key] = self._enclosed(nu, start, stop)
        return self._extremes[key]

    def _enclosed(self, nu: int, start: Fraction, stop: Fraction) -> Extremes:
        if start == stop:
            value = arb(self.value(nu, start))
            return value, value
        values: list[arb] = []
        for piece in self.pieces:
            low, high = max(start, piece.start), min(stop, piece.stop)
            if low < high:
                values += piece.extremes(nu, low, high)
        return least_and_greatest(values)

    def peak(self, nu: int) -> arb:
        """A ball that holds the peak of the magnitude of the derivative of order nu."""
        return arb.pos_inf() if self._impulses(nu) else self.magnitude(self.extremes(nu))

    @kept_property
    def power(self) -> arb:
        """A ball that holds the peak of |b c|."""
        if self._impulses(2):
            return arb.pos_inf()
        with ctx.workprec(self.precision):
            return self.magnitude(least_and_greatest([value for piece in self.pieces for value in piece.power()]))

    def rms(self, nu: int) -> arb:
        """A ball that holds the RMS of the derivative of order nu."""
        if self._impulses(nu):
            return arb.pos_inf()
        with ctx.workprec(self.precision):
            squares = [piece.square(nu) for piece in self.pieces]
            return sum(squares, arb(0)).sqrt() if all(square.is_finite() for square in squares) else arb.pos_inf()

    def constants(self) -> dict[str, arb]:
        """Balls that hold B, C, D, J and rms_c."""
        peaks = {"B": self.peak(1), "C": self.peak(2), "D": self.power, "J": self.peak(3)}
        return {**peaks, "rms_c": self.rms(2)}

    def enclosures(self) -> dict[str, tuple[float, float]]:
        """Floats below and above these."""
        return {name: enclosed(value) for name, value in self.constants().items()}

    def greatest_of(self, motion: MotionFormula, sign: float) -> arb:
        """A ball that holds the greatest value of a formula, times a sign, over its part."""
        with ctx.workprec(self.precision):
            tops = []
            for branch in split(motion, sign, "") or []:
                least, greatest = self._of_motion(extremes_of, branch.motion)
                tops.append(greatest if branch.sign > 0 else -least)
            return reduce(arb.max, tops)

    def _of_motion(
        self, enclosed_of: Callable[[MotionFormula, Sequence[PolynomialPiece]], Enclosure], motion: MotionFormula
    ) -> Enclosure:
        """The integral or the extremes of a formula along the law, which several conditions may ask for."""
        key = enclosed_of, motion
        if key not in self._of_motions:
            self._of_motions[key] = enclosed_of(motion, self.polynomials)
        enclosure: Enclosure = self._of_motions[key]
        return enclosure

    def term(self, term: Term) -> arb:
        """A ball that holds the value of a constant or a maximum."""
        with ctx.workprec(self.precision):
            if isinstance(term, Maximum):
                return reduce(arb.max, map(self.sum, term.parts))
            constant = known(term)
            if isinstance(constant, OfMachine):
                return self._of_machine(constant)
            return self._of_formula(constant) if isinstance(constant, OfFormula) else self._of_derivatives(constant)

    def _of_machine(self, constant: OfMachine) -> arb:
        with ctx.workprec(2 * self.precision):
            if isinstance(constant, Residual):
                return exact_residual(constant).peak(self.polynomials)
            exact = ExactOutput(constant)
            if exact.impulsive and self._impulses(2):
                return arb.pos_inf()
            return (exact.rms if isinstance(constant, OutputRms) else exact.peak)(self.polynomials)

    def _of_formula(self, constant: OfFormula) -> arb:
        motion = constant.motion
        if self._impulses(max(motion.orders, default=0)):
            return arb.pos_inf()
        if isinstance(constant, FormulaIntegral):
            return self._of_motion(integral_of, motion)
        if isinstance(constant, FormulaRms):
            whole = ball(Fraction(motion.stop) - Fraction(motion.start))
            return (self._of_motion(integral_of, squared(motion)) / whole).sqrt()
        signs = constant.counted if isinstance(constant, FormulaPeak) else (1.0,)
        return reduce(arb.max, [self.greatest_of(motion, sign) for sign in signs])

    def _of_derivatives(self, constant: OfDerivatives) -> arb:
        if isinstance(constant, CombinedPeak | CombinedPower | DerivativePeak):
            return self._combined(constant)
        if isinstance(constant, PowerConstant):
            return self.power
        if isinstance(constant, RootMeanSquare):
            return self.rms(constant.nu)
        return arb.pos_inf() if self._impulses(constant.nu) else _peak(self.extremes(constant.nu), constant.signs)

    def _combined(self, constant: CombinedPeak | CombinedPower | DerivativePeak) -> arb:
        nu, weights = 2 if isinstance(constant, CombinedPower) else constant.nu, constant.weights
        if self._impulses(nu + len(weights) - 1):
            return arb.pos_inf()
        if not isinstance(constant, CombinedPower):
            values = [value for piece in self.polynomials for value in piece.combined(nu, weights)]
            signs = constant.signs if isinstance(constant, CombinedPeak) else (1.0, -1.0)
            return _peak(least_and_greatest(values), signs)
        products = [value for piece in self.polynomials for value in piece.combined_power(weights)]
        return self.magnitude(least_and_greatest(products))

    def sum(self, expression: Expression) -> arb:
        """A ball that holds the value of an objective."""
        with ctx.workprec(self.precision):
            total = arb(0)
            for weight, term in expression.terms:
                total += ball(weight) * self.term(term)
            return total

    def magnitude(self, extremes: Extremes) -> arb:
        """A ball that holds the greater magnitude of two extremes."""
        with ctx.workprec(self.precision):
            return (-extremes[0]).max(extremes[1])

    def _impulses(self, nu: int) -> bool:
        return any(self.law.jumps(lower) for lower in range(1, nu))


def _peak(extremes: Extremes, signs: Sequence[float]) -> arb:
    return reduce(arb.max, (extremes[1] if sign > 0 else -extremes[0] for sign in signs))


def _piece(segment: Segment, start: Fraction, stop: Fraction) -> ExactPiece:
    if isinstance(segment, PolynomialSegment):
        return PolynomialPiece(start, stop, segment)
    if isinstance(segment, SineSegment):
        return SinePiece(start, stop, (segment,))
    if isinstance(segment, HarmonicSegment):
        return SinePiece(start, stop, segment.sines)
    if isinstance(segment, PowerSegment):
        return PowerPiece(start, stop, segment)
    raise InputError(f"exact verification knows no {segment.kind} segments")
