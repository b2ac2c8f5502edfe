"""Constants of a law that can be minimised or bounded, each with its NLP form and its exact value.

One more constant is one class: say how it reads off a law (`value`), which rows make a variable at least as great
(`families`), and, if known, what no law can beat (`limit`). Some are of a combination of a law's derivatives, such as
of the cam law a + 2 n b/nu² + c/nu² of a mass law.
"""

from __future__ import annotations

import re
import warnings
from abc import ABC, abstractmethod
from collections import ChainMap
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field
from fractions import Fraction
from math import isnan
from typing import TYPE_CHECKING, ClassVar, Protocol

import numpy as np

from optlaws.errors import NotNormalised, OptlawsError
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw, smoothstep
from optlaws.lazy import Registry
from optlaws.numbers import Array, power_of_two
from optlaws.synthesis.families.family import ConstraintFamily
from optlaws.synthesis.families.names import mirrored
from optlaws.synthesis.problem.expression import Expression, Term, leaves

if TYPE_CHECKING:
    from optlaws.synthesis.spaces.end_conditions import BoundaryConditions
    from optlaws.synthesis.spaces.space import LawSpace

_SMOOTH = 4  # the order of the law that scales are taken from
_NO_ACCELERATION = 3  # the order from which laws begin and end without acceleration


class ProblemView(Protocol):
    """Protocol of a problem, as far as a constant may need to know it."""

    @property
    def B(self) -> object:
        """The bound or value of the peak velocity."""

    @property
    def symmetric(self) -> bool:
        """Whether a(k) + a(1-k) = 1."""

    @property
    def monotone(self) -> bool:
        """Whether b >= 0 throughout the motion."""

    @property
    def peak_at(self) -> float | None:
        """The place of the peak velocity, if it is given."""


@dataclass(frozen=True, repr=False)
class Functional(Term, ABC):
    """A constant of a law, at least 0 (dimensionless).

    Attributes
    ----------
    name
        Its name in expressions, problem files and results.
    reference
        The least value that laws from rest to rest of any order can have; NaN where it is not known.
    convex
        Whether it is convex in the law; then optima are proven, otherwise only bounded.

    Examples
    --------
    >>> C.name, C.reference, D.convex
    ('C', 4.0, False)
    """

    name: str
    reference: float = field(compare=False)
    convex: bool

    def least(self, order: int) -> float:  # noqa: ARG002 - a constant may depend on it
        """The least value that laws from rest to rest of this order can have, by which mixtures are normalised.

        Examples
        --------
        >>> C.least(4), J.least(2), J.least(4)
        (4.0, 12.0, 32.0)
        """
        return self.reference

    def curbs(self) -> tuple[tuple[int, float], ...]:
        """Pairs of an order and a factor: the mean of |a^(order)| is at most factor times the constant, in every law.

        For a power it is the constant's root. A certificate needs such a bound of the law's size;
        constants of optlaws itself have theirs.
        """
        return ()

    def derivatives(self) -> tuple[tuple[int, float], ...]:
        """Pairs of an order and a weight: the constant is the peak magnitude of the weighted sum of these derivatives.

        Exact verification evaluates a constant of your own by them, and refuses one that has none.
        """
        return ()

    def sizes(self, space: LawSpace) -> tuple[tuple[int, float, float], ...]:  # noqa: ARG002 - some depend on it
        """Bounds of means in every law of a space: at most factor times the constant plus the offset.

        A constant below 0, as a peak of one side may be, counts as 0.
        """
        return tuple((nu, factor, 0.0) for nu, factor in self.curbs())

    def floor(self, conditions: BoundaryConditions) -> float:  # noqa: ARG002 - a constant may depend on them
        """A lower bound in every law with these end conditions; minus infinity if nothing is known."""
        return 0.0

    @kept_property
    def scale(self) -> float:
        """The size of the constant in smooth laws, a power of 2, never 0, by which rows and gaps are divided.

        Examples
        --------
        >>> C.scale
        1.0
        """
        return _scale_along_smooth_law(self)

    #: whether its rows are in units of their own size already
    normalised: ClassVar[bool] = False

    @property
    def even(self) -> bool:
        """Whether a law and its mirror image, 1 - a(1-k), have the same value, so that symmetric laws may be best."""
        return True

    @property
    def remarks(self) -> tuple[str, ...]:
        """Remarks for users whose problem with this constant has no law."""
        return ()

    @property
    def title(self) -> str:
        """Title in messages and tables: the name, or a few words if the name is long.

        Examples
        --------
        >>> C.title
        'C'
        """
        return self.name

    @property
    def why(self) -> str:
        """Why it is convex or not."""
        return f"{self.title} is {'convex' if self.convex else 'not convex'} in the law"

    @property
    def convexity(self) -> str:
        """Whether the constant is known to be convex in the law, in words, and the rule behind it.

        Examples
        --------
        >>> C.convexity
        'convex: C is convex in the law'
        """
        return f"{'convex' if self.convex else 'not known to be convex'}: {self.why}"

    @property
    def part_names(self) -> tuple[str, ...]:
        """Names of its rows in certificates: one, unless it is the greatest of several parts."""
        return (self.name,)

    def where(self, k: float, part: int = 0) -> str:  # noqa: ARG002 - most have one
        """The place of a certificate's contact in words."""
        return f"k = {k:.4g}"

    def check_problem(self, problem: ProblemView) -> None:
        """Refuse a problem in whose laws the constant cannot be optimised; the error states the remedy."""

    def limit(self, problem: ProblemView) -> Fraction | None:  # noqa: ARG002 - what it is may depend on it
        """A limit for laws of the problem of any degree, if it is more than the constant's least value."""
        return None

    def convex_families(
        self,
        space: LawSpace,
        slack: Array,
        bound: float,
        problem: ProblemView,  # noqa: ARG002 - a constant that is not convex may need it
    ) -> tuple[ConstraintFamily, ...]:
        """Convex rows that hold if the constant is at most slack . x + bound, for a bound of all laws."""
        return self.families(space, slack, bound)

    @abstractmethod
    def value(self, law: MotionLaw) -> float:
        """The constant of a law, over the whole interval."""

    @abstractmethod
    def families(self, space: LawSpace, slack: Array, bound: float) -> tuple[ConstraintFamily, ...]:
        """Rows that hold if and only if the constant is at most slack . x + bound."""

    def __repr__(self) -> str:
        return self.name


def _scale_along_smooth_law(constant: Functional) -> float:
    try:
        return power_of_two(abs(constant.value(smoothstep(_SMOOTH))))
    except (ArithmeticError, AttributeError, LookupError, OptlawsError, RuntimeError, TypeError, ValueError):
        return 1.0  # not every constant has a value along every law


@dataclass(frozen=True, repr=False)
class _InUnitsOfLaws(Functional):
    """A constant in the units of the law: stroke and duration are 1."""

    @property
    def scale(self) -> float:
        """One, as the law itself has this scale."""
        return 1.0


@dataclass(frozen=True, repr=False)
class PeakConstant(_InUnitsOfLaws):
    """Peak of a derivative: magnitude, or one sign only.

    >>> from optlaws import smoothstep
    >>> C.value(smoothstep(2)), C_plus.value(smoothstep(2))
    (6.0, 6.0)
    """

    nu: int
    signs: tuple[float, ...] = (1.0, -1.0)

    def value(self, law: MotionLaw) -> float:
        """The peak, by the roots of the next derivative."""
        if len(self.signs) == 2:
            return law.peak(self.nu).value
        lowest, highest = law.extrema(self.nu)
        return highest.value if self.signs[0] > 0 else -lowest.value

    def families(self, space: LawSpace, slack: Array, bound: float) -> tuple[ConstraintFamily, ...]:
        """The family of rows of the derivative."""
        # over the whole interval one sign of a derivative that is odd about k = 1/2 is both over the half
        signs = (1.0, -1.0) if space.symmetric and self.nu % 2 == 0 else self.signs
        return (space.derivative(self.nu, self.name, slack, bound, signs),)


@dataclass(frozen=True, repr=False)
class PeakJerk(PeakConstant):
    """Peak of the jerk, which costs more where the acceleration must begin and end with 0.

    >>> from optlaws import smoothstep
    >>> J.value(smoothstep(3)), J.least(3)
    (60.0, 32.0)
    """

    from_no_acceleration: float = 32.0

    def least(self, order: int) -> float:
        """The reference with order 2, 32 from order 3 on."""
        return self.reference if order < _NO_ACCELERATION else self.from_no_acceleration


@dataclass(frozen=True, repr=False)
class PowerConstant(_InUnitsOfLaws):
    """Peak D of the kinetic power d = b c: not convex in the law.

    >>> from optlaws import smoothstep
    >>> round(D.value(smoothstep(2)), 6)
    3.464102
    """

    weights: tuple[Fraction, ...] = (Fraction(1),)

    def value(self, law: MotionLaw) -> float:
        """The peak, b and c evaluated separately."""
        return law.power_peak().value

    def families(self, space: LawSpace, slack: Array, bound: float) -> tuple[ConstraintFamily, ...]:
        """The family of rows of the product."""
        return (space.power(self.name, slack, bound),)


@dataclass(frozen=True, repr=False)
class RootMeanSquare(_InUnitsOfLaws):
    """RMS of a derivative over the interval.

    >>> from optlaws import smoothstep
    >>> round(rms_c.value(smoothstep(2)) ** 2, 9)
    12.0
    """

    nu: int

    def curbs(self) -> tuple[tuple[int, float], ...]:
        """The mean magnitude of a derivative is at most its RMS."""
        return ((self.nu, 1.0),)

    def value(self, law: MotionLaw) -> float:
        """The root of the mean square, by Gauss-Legendre quadrature exact for the law's degree."""
        return law.rms(self.nu)

    def families(self, space: LawSpace, slack: Array, bound: float) -> tuple[ConstraintFamily, ...]:
        """A norm of the coordinates."""
        return (space.norm(self.nu, self.name, slack, bound),)


B = PeakConstant("B", 1.0, convex=True, nu=1)
C = PeakConstant("C", 4.0, convex=True, nu=2)
C_plus = PeakConstant("C_plus", 2.0, convex=True, nu=2, signs=(1.0,))
C_minus = PeakConstant("C_minus", 2.0, convex=True, nu=2, signs=(-1.0,))
D = PowerConstant("D", 2.25, convex=False)
J = PeakJerk("J", 12.0, convex=True, nu=3)
snap = PeakConstant("snap", np.nan, convex=True, nu=4)
rms_c = RootMeanSquare("rms_c", 12.0**0.5, convex=True, nu=2)
rms_j = RootMeanSquare("rms_j", np.nan, convex=True, nu=3)
rms_snap = RootMeanSquare("rms_snap", np.nan, convex=True, nu=4)

FUNCTIONALS: dict[str, Functional] = {f.name: f for f in (B, C, C_plus, C_minus, D, J, snap, rms_c, rms_j, rms_snap)}
#: names that texts may use besides; earlier files call the snap jounce
ALIASES: dict[str, Functional] = {"rms": rms_c, "jounce": snap, "rms_jounce": rms_snap}
#: constants of other subjects without arguments, by their names: `C_loader`
PLAIN: Registry[Functional] = Registry("plain constant")
#: every constant that a name alone stands for
WITHOUT_ARGUMENTS: Mapping[str, Functional] = ChainMap(FUNCTIONALS, ALIASES, PLAIN)
#: what makes a constant from arguments, by the name that text calls it by: `C_cam(frequency=20)`
MAKERS: Registry[Callable[..., Functional]] = Registry("constant")


_SPREAD = 8.0
_MOST_WARNINGS = 1024
_warned: set[tuple[str, int]] = set()
_silent: ContextVar[bool] = ContextVar("mixtures are meant", default=False)


@contextmanager
def meant() -> Iterator[None]:
    """Have no mixture warned of, in this thread alone: filters of warnings are the process's.

    >>> from optlaws import C, J
    >>> with meant():
    ...     warn_of_mixture(C + 3 * J, 4)
    """
    before = _silent.set(True)
    try:
        yield
    finally:
        _silent.reset(before)


def warn_of_mixture(objective: Expression, order: int) -> None:
    """Warn, once for each objective, if a part of a mixture outweighs another many times over.

    Parts are compared at the constants' least values for laws of the order: C counts 4, D 2.25, J 32 from order 3 on.
    An objective such as C + 3*J is hardly a mixture; 0.5*C/4 + 0.5*J/32 is.

    >>> from optlaws import C, D
    >>> warn_of_mixture(0.6 * C / 4 + 0.4 * D / 2.25, 4)
    """
    text = repr(objective)
    if _silent.get() or (text, order) in _warned:
        return
    shares = {leaf: weight * leaf.least(order) for weight, leaf in leaves(objective) if isinstance(leaf, Functional)}
    known = [share for share in shares.values() if not isnan(share)]
    if len(known) > 1 and max(known) > _SPREAD * min(known):
        if len(_warned) >= _MOST_WARNINGS:
            _warned.clear()
        _warned.add((text, order))
        parts = ", ".join(f"{leaf!r} {share:.3g}" for leaf, share in shares.items() if not isnan(share))
        message = f"the objective {text} is not normalised: at the constants' least values its parts are {parts}"
        warnings.warn(f"{message}; divide each constant by such a value", NotNormalised, stacklevel=3)


def present_name(name: str) -> str:
    """The current name of a constraint: earlier files call the snap jounce.

    >>> present_name("rms_jounce at most"), present_name("C")
    ('rms_snap at most', 'C')
    """
    return re.sub(r"\b(rms_)?jounce\b", r"\1snap", name)


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
