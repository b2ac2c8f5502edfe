"""The degree of formulas that are polynomials."""

from __future__ import annotations

from collections.abc import Mapping

from optlaws.formulas.slopes import constant
from optlaws.formulas.tree import Call, Formula, Name, Negative, Power, Product, Sum, Table


def degree(formula: Formula, names: Mapping[str, int]) -> int | None:
    """The greatest degree that a formula can have where its names are polynomials of these degrees.

    Tables, and sizes and maxima of what depends on k alone, count as what they are on each of their pieces. None where
    the formula is no polynomial.

    Examples
    --------
    >>> from optlaws.formulas.reading import read
    >>> degree(read("k^2*c + b"), {"k": 1, "c": 5, "b": 6}), degree(read("sin(k)"), {"k": 1})
    (7, None)
    """
    if not formula.names() & names.keys():
        return 0
    if isinstance(formula, Name):
        return names[formula.name]
    if isinstance(formula, Power):
        base, exponent = degree(formula.base, names), constant(formula.exponent)
        whole = exponent is not None and exponent >= 0.0 and exponent % 1.0 == 0.0
        return int(exponent) * base if whole and exponent is not None and base is not None else None
    parts = [degree(part, names) for part in formula.parts]
    known = [part for part in parts if part is not None]
    if len(known) < len(parts):
        return None
    if isinstance(formula, Negative | Sum):
        return max(known)
    if isinstance(formula, Product):
        return sum(known)
    if isinstance(formula, Table):
        return known[0] * (max(3 - formula.order, 0) if formula.smooth else 1)
    kinks = isinstance(formula, Call) and formula.function in {"abs", "max", "min"} and formula.names() <= {"k"}
    return max(known) if kinks else None
