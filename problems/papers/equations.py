"""Printed equations, several with ; between them: sides in the grammar of formulas, and how far they are apart."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache

from optlaws import InputError
from optlaws.formulas import NUMPY, Formula, evaluate, read


def difference(text: str, values: Mapping[str, float], where: str) -> float:
    """How far the sides of equations are apart, as a share of the greater one; values are by name.

    Raises
    ------
    InputError
        If the text is no equation, or has names without values.

    Examples
    --------
    >>> difference("C = B^2/(B - 1)", {"B": 1.5, "C": 4.5}, "a limit")
    0.0
    """
    return max(_apart(*(_value(side, values, where) for side in _sides(part, where))) for part in text.split(";"))


#: sides below it are held to be 0
_NOTHING = 1e-3


def _apart(left: float, right: float) -> float:
    return abs(left - right) / max(abs(left), abs(right), _NOTHING)


@lru_cache(maxsize=1024)
def _sides(text: str, where: str) -> tuple[Formula, Formula]:
    sides = text.split("=")
    if len(sides) != 2:
        raise InputError(f"{where}: an equation has one =, got {text!r}")
    try:
        left, right = (read(side.strip()) for side in sides)
    except InputError as error:
        raise InputError(f"{where}: {error}") from None
    return left, right


def _value(side: Formula, values: Mapping[str, float], where: str) -> float:
    missing = sorted(side.names() - values.keys() - {"pi"})
    if missing:
        raise InputError(f"{where}: the computation has no {missing[0]}; it has {', '.join(sorted(values))}")
    return float(evaluate(side, values, NUMPY))
