"""Formulas that are affine in some of their names, and of which degree they are in them."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass

from optlaws.formulas.quadratic import quadratic
from optlaws.formulas.slopes import constant
from optlaws.formulas.tree import Call, Exponentiation, Formula, Name, Negative, Number, Product, Sum, Table


@dataclass(frozen=True)
class Affine:
    """The sum of factors times names, plus what is left; neither has any of the names."""

    factors: tuple[tuple[str, Formula], ...]  #: by name, those that are not 0
    rest: Formula


def affine(formula: Formula, names: Collection[str]) -> Affine | None:
    """The formula as an affine one of these names; None where it is not.

    Examples
    --------
    >>> from optlaws.formulas.reading import read
    >>> affine(read("2*(c + k*b) - c + k^2"), "bc")
    Affine(factors=(('c', 2 - 1), ('b', 2*k)), rest=k^2)
    >>> affine(read("b*c"), "bc") is None
    True
    """
    form = quadratic(formula, names, most=1)
    if form is None:
        return None
    return Affine(tuple((key[0], factor) for key, factor in form.items() if key), form.get((), Number(0.0)))


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
    if isinstance(formula, Exponentiation):
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
    if isinstance(formula, Table) and formula.names() <= {"k"}:
        return known[0] * (max(3 - formula.order, 0) if formula.smooth else 1)
    kinks = isinstance(formula, Call) and formula.function in {"abs", "max", "min"} and formula.names() <= {"k"}
    return max(known) if kinks else None
