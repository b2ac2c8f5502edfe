"""The residual vibration of a follower that a law leaves, in complex balls."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Protocol, TypeVar, runtime_checkable

from flint import acb, acb_series, arb

from optlaws.verification.enclosing.balls import ball
from optlaws.verification.enclosing.pieces import PolynomialPiece
from optlaws.verification.machines.driving import Space
from optlaws.verification.machines.velocity_transforms import (
    Ends,
    ends_of,
    ends_of_law,
    greatest_modulus,
    transforms,
)

Number = TypeVar("Number", acb, acb_series)
_I = acb(0, 1)


@runtime_checkable
class ResidualConstant(Protocol):
    """What a residual over an interval of frequencies is made of (optlaws.mechanisms defines it)."""

    name: str
    low: float
    high: float
    damping: float
    design: float | None
    design_damping: float


class ExactResidual:
    """The complex amplitude, times nu², as a function of the frequency.

    Parameters
    ----------
    constant
        Which residual.
    """

    def __init__(self, constant: ResidualConstant) -> None:
        self.low, self.high = Fraction(constant.low), Fraction(constant.high)
        self.damping, self.design_damping = Fraction(constant.damping), Fraction(constant.design_damping)
        self.design = None if constant.design is None else Fraction(constant.design)

    def amplitudes(self, nu: Number, breaks: Sequence[Fraction], columns: Sequence[Sequence[Ends]]) -> list[Number]:
        """Of laws given by the ends of their pieces; where the breaks end at 1/2, b(1-k) = b(k)."""
        sine = ball((1 - self.damping) * (1 + self.damping)).sqrt()
        root = acb(ball(-self.damping), sine)
        w = nu * root
        scale = nu * nu * self._detuning(nu, w) * (-_I * acb(ball(-self.damping), -sine) / sine)
        return [scale * transform for transform in transforms(w, breaks, columns)]

    def _detuning(self, nu: Number, w: Number) -> Number:
        """What the cam made for the design frequency leaves."""
        if self.design is None:
            return nu * 0 + 1
        square = 1 / ball(self.design**2)
        apart = nu * acb(ball(-self.damping)) + acb(ball(self.design_damping * self.design))
        return 1 - nu * nu * acb(square) + apart * w * acb(2 * square)

    def rows(self, space: Space, place: Fraction) -> list[acb]:
        """Amplitudes of a space's free functions and of its base law, at the frequency of a certificate's place."""
        nu = (1 - place) * self.low + place * self.high
        return self.amplitudes(acb(ball(nu)), space.breaks, ends_of(space))

    def peak(self, pieces: Sequence[PolynomialPiece]) -> arb:
        """A ball that holds the greatest magnitude over the interval of frequencies, at the precision at work."""
        breaks, ends = ends_of_law(pieces)
        return greatest_modulus([lambda nu: self.amplitudes(nu, breaks, ends)[0]], self.low, self.high)
