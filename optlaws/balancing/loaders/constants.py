"""The peaks of the inertial loader that balances a symmetric law of one peak velocity, as constants of the law."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from math import inf
from typing import TYPE_CHECKING

import numpy as np
from numpy.polynomial import chebyshev

from optlaws.balancing.loaders.limits import LIMITS
from optlaws.balancing.loaders.loader import inertial_loader
from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.laws import MotionLaw
from optlaws.numbers import Array
from optlaws.numerics.chebyshev import product
from optlaws.synthesis.families import names
from optlaws.synthesis.families.energy import Energy, EnergyFamily
from optlaws.synthesis.families.family import ConstraintFamily, LinearFamily
from optlaws.synthesis.families.piece_series import PieceSeries, widened
from optlaws.synthesis.problem.constants import PLAIN, C, Functional, ProblemView
from optlaws.synthesis.problem.expression import Expression, Term
from optlaws.synthesis.problem.named_constants import parse
from optlaws.synthesis.spaces.of_basis import PolynomialSpace

if TYPE_CHECKING:
    from optlaws.synthesis.spaces.space import LawSpace


_AT_REST, _MIDDLE = 2, 0.5
#: of a limit: more than its rounding errors
_ROUNDING = Fraction(1, 10**12)


@dataclass(frozen=True, repr=False)
class LoaderPeak(Functional):
    """Peak velocity, acceleration or power of the inertial loader that balances a law.

    Not convex in the law; B of the loader is among laws of one peak velocity.

    Attributes
    ----------
    of
        "B", "C" or "D".

    Examples
    --------
    >>> from optlaws import smoothstep
    >>> [round(functional.value(smoothstep(2)), 6) for functional in (B_loader, C_loader, D_loader)]
    [1.640754, 4.640754, 4.144721]
    """

    of: str
    #: as of the law's own peaks
    scale = 1.0

    def value(self, law: MotionLaw) -> float:
        """The peak over the whole interval; inf where the law has no loader."""
        try:
            return float(getattr(inertial_loader(law), self.of))
        except InputError:
            return inf

    def check_problem(self, problem: ProblemView) -> None:
        """Refuse problems whose laws need not have their peak velocity at k = 1/2, where their loaders reverse."""
        if not problem.symmetric or problem.peak_at != _MIDDLE:
            raise InputError(
                f"{self.name} is sought among symmetric laws with their peak velocity in the middle: give B as a "
                f"number above 1, or inflexion=0.5, and leave symmetric=True; got {shortened(problem)}"
            )

    def limit(self, problem: ProblemView) -> Fraction | None:
        """The lower limit for laws with the problem's B; with any B where that is free."""
        if not problem.symmetric or (self.of != "B" and not problem.monotone):
            return None
        if not isinstance(problem.B, float) or problem.B <= 1.0:
            return Fraction(self.reference)
        return Fraction(LIMITS[self.of](problem.B)) * (1 - _ROUNDING)

    def families(self, space: LawSpace, slack: Array, bound: float) -> tuple[ConstraintFamily, ...]:
        """The rows |peak of the loader| <= slack . x + bound, on the first half."""
        if not isinstance(space, PolynomialSpace) or not space.symmetric or not space.at_rest or space.order < _AT_REST:
            raise InputError(
                f"{self.name} needs symmetric laws from rest to rest, order at least {_AT_REST}, with a basis of "
                "polynomials such as Chebyshev(9)"
            )
        shared, size = _energy(space, len(slack)), len(slack)
        signs = (1.0, -1.0)
        if self.of == "B":
            top = LinearFamily(self.name, slack, table=PieceSeries.whole(space.row(1, 0.5)[None]).widened(size))
            return (EnergyFamily(self.name, slack, bound, domain=(1.0, 1.0), factors=(top,), energy=shared),)
        if self.of == "C":
            factors = (_velocity(space, size), _fall(shared.below))
            return (
                EnergyFamily(self.name, slack, bound, signs, factors=factors, energy=shared, divided=True, scale=4.0),
            )
        product_of = space.power(self.name, slack)
        both = (product_of.first, product_of.second)
        return (EnergyFamily(self.name, slack, bound, signs, space.domain, factors=both, energy=shared, degree=2),)

    def convex_families(
        self, space: LawSpace, slack: Array, bound: float, problem: ProblemView
    ) -> tuple[ConstraintFamily, ...]:
        """B of the loader itself, which is convex at a fixed B of the law; lower bounds of its other peaks."""
        if self.of == "B" and isinstance(problem.B, float):
            families = self.families(space, slack, bound)
            return tuple(replace(family, convex=True) for family in families if isinstance(family, EnergyFamily))
        least = self.limit(problem)
        if least is None or not slack.any():
            return ()
        return (LinearFamily.of_row(names.at_least(self.name), -slack, bound - float(least)),)


def _even(name: str, series: Array) -> LinearFamily:
    """A function with a series in u = 2 t² - 1."""
    return LinearFamily(name, np.zeros(series.shape[1] - 1), table=PieceSeries.whole(series), even=True)


def _velocity(space: PolynomialSpace, size: int) -> LinearFamily:
    return _even("b", widened(space.series(1)[::2], size))


def _energy(space: PolynomialSpace, size: int) -> Energy:
    chord, above = space.below(np.zeros(size)), _velocity(space, size).series.copy()
    if not isinstance(chord, LinearFamily) or not chord.even:
        raise InputError("a loader needs laws whose peak velocity is in the middle")
    above[0] += widened(space.row(1, 0.5), size)
    return Energy(_even("below", -chord.series), _even("above", above))


def _fall(below: LinearFamily) -> LinearFamily:
    """p = q + u dq/du over u = t², of which the acceleration is 4 t p."""
    series = below.series
    fallen = np.zeros_like(series)
    fallen[: len(series) - 1] = chebyshev.chebder(series)
    # u = (1 + v)/2 and dq/du = 2 dq/dv
    for column in fallen.T:
        column[:] = product(np.array([1.0, 1.0]), column.copy())[: len(column)]
    return _even("fall", series + fallen)


B_loader = LoaderPeak("B_loader", 1.0, convex=False, of="B")
C_loader = LoaderPeak("C_loader", 4.0, convex=False, of="C")
D_loader = LoaderPeak("D_loader", 2.25, convex=False, of="D")

NAMES: Mapping[str, Functional] = {functional.name: functional for functional in (C, B_loader, C_loader, D_loader)}
PLAIN.update({functional.name: functional for functional in (B_loader, C_loader, D_loader)})


def objective(minimise: str | Term | Expression) -> Expression:
    """The objective to minimise: a sum of C and peaks of the loader, with at least one peak of the loader.

    Examples
    --------
    >>> objective("0.5*C/4 + 0.5*C_loader/4")
    0.125*C + 0.125*C_loader
    """
    if isinstance(minimise, str):
        expression = parse(minimise, NAMES)
    elif isinstance(minimise, Term | Expression):
        expression = minimise.expression()
    else:
        raise InputError(f"minimise must be a sum of {', '.join(NAMES)}, got {shortened(minimise)}")
    for _, term in expression.terms:
        if term not in NAMES.values():
            raise InputError(f"a balanced law minimises a sum of {', '.join(NAMES)}, got {shortened(term)} in it")
    if [term for _, term in expression.terms] == [C]:
        raise InputError("C alone has no loader in it: minimise it with synthesize, or add C_loader or B_loader")
    return expression
