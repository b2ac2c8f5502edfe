"""The values of a law as a table: k, a, b, c, j and d at equal steps of k."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from optlaws.files import tables
from optlaws.laws.law import MotionLaw
from optlaws.numbers import MOST_VALUES, whole
from optlaws.tolerances import VALUE_ROUNDING

LETTERS = ("a", "b", "c", "j", "d")
#: the default number of lines
SAMPLES = 201
_DIGITS = 15


def sizes(law: MotionLaw) -> tuple[float, ...]:
    """The greatest values of a, b, c, j and d."""
    constants = law.constants
    return law.peak(0).value, constants.B.value, constants.C.value, constants.J.value, constants.D.value


def values(law: MotionLaw, k: NDArray[np.float64]) -> list[NDArray[np.float64]]:
    """The values of a, b, c, j and d; what is rounding beside the greatest is 0.

    >>> from optlaws import smoothstep
    >>> [float(column[0]) for column in values(smoothstep(3), np.array([0.5]))]
    [0.5, 1.875, 0.0, -30.0, 0.0]
    """
    columns = [getattr(law, letter)(k) for letter in LETTERS]
    return [
        np.where(np.abs(column) <= VALUE_ROUNDING * size, 0.0, column)
        for column, size in zip(columns, sizes(law), strict=True)
    ]


def table_of_values(law: MotionLaw, name: str, count: int = SAMPLES) -> str:
    """The values as CSV, a line for each k.

    Raises
    ------
    InputError
        If `count` is not an integer of at least 2.

    Examples
    --------
    >>> from optlaws import smoothstep
    >>> print(table_of_values(smoothstep(3), "3-4-5", 3), end="")
    # law 3-4-5: dimensionless; after a jump its value there; made by optlaws
    k,a,b,c,j,d
    0,0,0,0,60,0
    0.5,0.5,1.875,0,-30,0
    1,1,0,0,60,0
    """
    k = np.linspace(0.0, 1.0, whole(count, "samples", least=2, most=MOST_VALUES))
    about = f"law {' '.join(name.split())}: dimensionless; after a jump its value there"
    rows = np.column_stack([k, *values(law, k)]).tolist()
    return tables.to_csv(("k", *LETTERS), rows, about=about, digits=_DIGITS)
