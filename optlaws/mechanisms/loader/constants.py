"""The peaks of a law's inertial loader as constants of the law, which `balanced_law` minimises."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, NoReturn

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.laws import MotionLaw
from optlaws.mechanisms.loader.loader import loader
from optlaws.synthesis.problem.constants import C, Functional
from optlaws.synthesis.problem.expression import Expression, Term
from optlaws.synthesis.problem.grammar import parse

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from optlaws.synthesis.spaces.space import LawSpace

    Array = NDArray[np.float64]


@dataclass(frozen=True, repr=False)
class LoaderPeak(Functional):
    """Peak of the inertial loader that balances a law.

    Not convex in the law; B of the loader is among laws of one peak velocity, as `balanced_law` seeks them.

    Examples
    --------
    >>> from optlaws.laws import smoothstep
    >>> round(C_loader.value(smoothstep(2)), 6), round(B_loader.value(smoothstep(2)), 6)
    (4.640754, 1.640754)
    """

    of: str

    def value(self, law: MotionLaw) -> float:
        """The peak over the whole interval."""
        return float(getattr(loader(law), self.of))

    def families(self, space: LawSpace, slack: Array, bound: float) -> NoReturn:  # noqa: ARG002 - the engine's call
        """There are none: it is not linear in the law."""
        raise InputError(f"{self.name} depends on the law by its loader: minimise it with balanced_law")


C_loader = LoaderPeak("C_loader", 4.0, convex=False, of="C")
B_loader = LoaderPeak("B_loader", 1.0, convex=False, of="B")

NAMES: Mapping[str, Functional] = {one.name: one for one in (C, C_loader, B_loader)}


def objective(minimise: str | Term | Expression) -> Expression:
    """What to minimise: a sum of C, C_loader and B_loader, one of the loader's among them.

    Raises
    ------
    InputError
        If it is something else.

    Examples
    --------
    >>> objective("0.5*C/4 + 0.5*C_loader/4")
    0.125*C + 0.125*C_loader
    """
    if isinstance(minimise, str):
        found = parse(minimise, NAMES)
    elif isinstance(minimise, Term | Expression):
        found = minimise.expression()
    else:
        raise InputError(f"minimise must be a sum of {', '.join(NAMES)}, got {shortened(minimise)}")
    for _, term in found.terms:
        if term not in NAMES.values():
            raise InputError(f"a balanced law minimises a sum of {', '.join(NAMES)}, got {shortened(term)} in it")
    if [term for _, term in found.terms] == [C]:
        raise InputError("C alone has no loader in it: minimise it with synthesize, or add C_loader or B_loader")
    return found
