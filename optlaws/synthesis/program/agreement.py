"""Whether a constant's rows and its value agree: those of a user's own class may not."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from optlaws.errors import InputError
from optlaws.numerics.tolerances import ROWS_AGREE
from optlaws.synthesis.problem.constants import Functional

if TYPE_CHECKING:
    from optlaws.synthesis.spaces.space import LawSpace

_LAWS = 3


def check_rows(constant: Functional, space: LawSpace) -> None:
    """See that the rows of a class that is not optlaws's own ask of laws what its value says of them.

    Raises
    ------
    InputError
        If they do not: the law found would not be the best, or its lower bound above it.
    """
    if not type(constant).__module__.startswith("optlaws."):
        _check(constant, space)


@lru_cache(maxsize=128)
def _check(constant: Functional, space: LawSpace) -> None:
    families = constant.families(space, np.zeros(space.terms), 0.0)
    numbers = np.random.default_rng(0)
    for size in range(_LAWS):
        x = 0.3 * size * numbers.normal(size=space.terms)
        rows = max(float(family.extremes(x)[2].max()) for family in families)
        value = constant.value(space.law(x))
        # what is the same for every law, such as the rounding of a peak of nothing, says nothing
        if abs(rows - value) > ROWS_AGREE * max(abs(rows), abs(value)) and max(abs(rows), abs(value)) > ROWS_AGREE:
            raise contradiction(constant, rows, value)


def contradiction(constant: Functional, rows: float, value: float) -> InputError:
    """The error of a class whose two methods say different numbers of one law."""
    kind = type(constant).__name__
    return InputError(
        f"{kind}.families and {kind}.value contradict each other: of a law the rows ask {constant.name} = "
        f"{rows:.7g}, its value is {value:.7g}. Rows must hold if and only if the value is at most slack . x + bound"
    )
