"""Constants of a combination of a law's derivatives, such as of the cam law a + 2 n b/nu² + c/nu² of a mass law."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.numbers import Array, power_of_two
from optlaws.synthesis.families.family import ConstraintFamily
from optlaws.synthesis.families.names import mirrored
from optlaws.synthesis.problem.constants import Functional, PowerConstant

if TYPE_CHECKING:
    from optlaws.synthesis.spaces.space import LawSpace


#: what a smooth law's derivative is times the one before, nearly
_STEEPER = 6.0


@dataclass(frozen=True, repr=False)
class Combined(Functional):
    """A constant of a combination, which some laws have none of: where a derivative in it jumps or is infinite."""

    @abstractmethod
    def value(self, law: MotionLaw) -> float:
        """The peak of the combination over the whole interval."""

    @abstractmethod
    def check(self, space: LawSpace) -> None:
        """Refuse laws for which the combination is beyond every bound."""


@dataclass(frozen=True, repr=False)
class CombinedPeak(Combined):
    """Peak of w0 a^(nu) + w1 a^(nu+1) + ..., magnitude or one sign only."""

    nu: int  #: order of the lowest derivative
    weights: tuple[Fraction, ...]  #: the w, exact
    signs: tuple[float, ...] = (1.0, -1.0)  #: which signs count

    @kept_property
    def scale(self) -> float:
        """The ratio of the parts to the lowest derivative in smooth laws, which grows from derivative to derivative."""
        return power_of_two(sum(abs(float(weight)) * _STEEPER**i for i, weight in enumerate(self.weights)))

    def families(self, space: LawSpace, slack: Array, bound: float) -> tuple[ConstraintFamily, ...]:
        """A single family; two for symmetric laws if the combination is not symmetric."""
        self.check(space)
        return tuple(
            space.combination(self.nu, floats(weights), name, slack, bound, signs=signs)
            for name, weights, signs in self.sides(symmetric=space.symmetric)
        )

    def sides(self, *, symmetric: bool) -> list[tuple[str, tuple[Fraction, ...], tuple[float, ...]]]:
        """Names, weights and signs of the rows that hold it: all over the interval, or over each half on the first one.

        In a symmetric law a^(i)(1-k) = (-1)^(i+1) a^(i)(k), so that odd weights change their sign on the second half.
        """
        plain = (self.name, self.weights, self.signs)
        if not symmetric:
            return [plain]
        signs = self.signs if self.nu % 2 else tuple(-sign for sign in self.signs)
        weights = facing(self.weights)
        if weights != self.weights:
            return [plain, (mirrored(self.name), weights, signs)]
        return [(self.name, self.weights, tuple(dict.fromkeys((*self.signs, *signs))))]


@dataclass(frozen=True, repr=False)
class CombinedPower(Combined, PowerConstant):
    """Peak of the product of a combination of b, c, ... and its derivative: not convex in the law."""

    def families(self, space: LawSpace, slack: Array, bound: float) -> tuple[ConstraintFamily, ...]:
        """The product's family; one for each half if laws are symmetric and the combination is not."""
        self.check(space)
        sides = [(self.name, self.weights)]
        if space.symmetric and facing(self.weights) != self.weights:
            sides.append((mirrored(self.name), facing(self.weights)))
        return tuple(space.power(name, slack, bound, floats(weights)) for name, weights in sides)


def facing(weights: tuple[Fraction, ...]) -> tuple[Fraction, ...]:
    """The weights on the first half that equal these on the second half, for symmetric laws.

    >>> facing((Fraction(1), Fraction(2), Fraction(3)))
    (Fraction(1, 1), Fraction(-2, 1), Fraction(3, 1))
    """
    return tuple(-weight if i % 2 else weight for i, weight in enumerate(weights))


def floats(weights: tuple[Fraction, ...]) -> tuple[float, ...]:
    """The weights, rounded to doubles.

    >>> floats((Fraction(1), Fraction(1, 200)))
    (1.0, 0.005)
    """
    return tuple(map(float, weights))
