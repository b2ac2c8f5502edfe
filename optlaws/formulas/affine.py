"""Formulas that are affine or quadratic in some of their names, and of which degree they are in them."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from optlaws.formulas.intervals import Endpoints, enclosed
from optlaws.formulas.slopes import added, constant, multiplied, opposite
from optlaws.formulas.tree import Call, Exponentiation, Formula, Name, Negative, Number, Product, Sum, Table
from optlaws.tolerances import OPERATIONS_ROUNDING

#: factors of products of names: none, one or two of them, sorted
Terms = dict[tuple[str, ...], Formula]
_MOST = 2


def quadratic(formula: Formula, names: Collection[str], most: int = _MOST) -> Terms | None:
    """The factors of products of up to `most` names; None where the formula has others, or is no polynomial of them.

    >>> from optlaws.formulas.reading import read
    >>> quadratic(read("(c + k*b)*b - 3"), "bc")
    {('b', 'c'): 1, ('b', 'b'): k, (): -3}
    """
    if not formula.names() & set(names):
        return {(): formula}
    if isinstance(formula, Name):
        return {(formula.name,): Number(1.0)}
    if isinstance(formula, Negative):
        form = quadratic(formula.of, names, most)
        return None if form is None else {key: opposite(coefficient) for key, coefficient in form.items()}
    if isinstance(formula, Sum):
        return _sum([quadratic(term, names, most) for term in formula.terms])
    if isinstance(formula, Product):
        return _product(formula, names, most)
    if isinstance(formula, Exponentiation) and most > 1:
        exponent = constant(formula.exponent)
        if exponent is None or not 0.0 <= exponent <= most or exponent % 1.0:
            return None
        return _multiplied([{(): Number(1.0)}, *[quadratic(formula.base, names, most)] * int(exponent)], most)
    return None


def semidefinite(formula: Formula, names: Collection[str], within: Mapping[str, Endpoints], sign: int) -> bool:
    """Whether the formula, times the sign, is a quadratic form that is nonnegative at every k.

    >>> from optlaws.formulas.reading import read
    >>> semidefinite(read("c^2 + 2*b*c + b^2"), "bc", {}, 1), semidefinite(read("c^2 + 3*b*c + b^2"), "bc", {}, 1)
    (True, False)
    """
    form = quadratic(formula, names)
    if form is None:
        return False
    variables = sorted({name for key in form if len(key) == _MOST for name in key})
    entries = {
        (i, j): form.get((first, other), Number(0.0))
        for i, first in enumerate(variables)
        for j, other in enumerate(variables)
        if i <= j
    }
    values = {place: constant(entry) for place, entry in entries.items()}
    if None not in values.values():
        return _exactly({place: sign * Fraction(value or 0.0) for place, value in values.items()}, len(variables))
    return _widely({place: enclosed(entry, within) for place, entry in entries.items()}, len(variables), sign)


def _exactly(entries: Mapping[tuple[int, int], Fraction], size: int) -> bool:
    """The test by elimination in exact arithmetic; off-diagonal entries combine both sides."""
    matrix = [[entries[min(i, j), max(i, j)] / (1 if i == j else 2) for j in range(size)] for i in range(size)]
    for i in range(size):
        if matrix[i][i] < 0 or (matrix[i][i] == 0 and any(matrix[i][j] for j in range(i + 1, size))):
            return False
        for j in range(i + 1, size if matrix[i][i] else 0):
            share = matrix[j][i] / matrix[i][i]
            for column in range(i, size):
                matrix[j][column] -= share * matrix[i][column]
    return True


def _widely(entries: Mapping[tuple[int, int], Endpoints], size: int, sign: int) -> bool:
    """The test by eigenvalues at the midpoints of many parts, less the variation of the entries."""
    count = max(np.size(entry.low) for entry in entries.values())
    middles, reach = np.zeros((count, size, size)), np.zeros((count, size, size))
    for (i, j), entry in entries.items():
        half = 1.0 if i == j else 0.5
        with np.errstate(invalid="ignore"):  # of an entry without bounds
            middles[:, i, j] = middles[:, j, i] = sign * half * (entry.low + entry.high) / 2.0
        reach[:, i, j] = reach[:, j, i] = half * (entry.high - entry.low) / 2.0
    if not np.isfinite(middles).all() or not np.isfinite(reach).all():
        return False
    sizes = np.linalg.norm(middles, axis=(1, 2)) + np.linalg.norm(reach, axis=(1, 2))
    least = np.linalg.eigvalsh(middles)[:, 0] - np.linalg.norm(reach, axis=(1, 2)) - OPERATIONS_ROUNDING * sizes
    return bool(least.min() > 0.0)


def _sum(terms: list[Terms | None]) -> Terms | None:
    gathered: dict[tuple[str, ...], list[Formula]] = {}
    for term in terms:
        if term is None:
            return None
        for key, factor in term.items():
            gathered.setdefault(key, []).append(factor)
    return {key: added(factors) for key, factors in gathered.items()}


def _product(formula: Product, names: Collection[str], most: int) -> Terms | None:
    """The factors without names times the product of the others."""
    moving = [factor for factor in formula.factors if factor.names() & set(names)]
    still = multiplied([factor for factor in formula.factors if factor not in moving])
    form = _multiplied([quadratic(factor, names, most) for factor in moving], most)
    return None if form is None else {key: multiplied([still, factor]) for key, factor in form.items()}


def _multiplied(factors: list[Terms | None], most: int) -> Terms | None:
    terms: Terms = {(): Number(1.0)}
    for factor in factors:
        if factor is None:
            return None
        products: list[Terms | None] = [
            {tuple(sorted((*name, *other))): multiplied([first, second])}
            for name, first in terms.items()
            for other, second in factor.items()
        ]
        together = _sum(products)
        if together is None or any(len(key) > most for key in together):
            return None
        terms = together
    return terms


@dataclass(frozen=True)
class Affine:
    """The sum of factors times names, plus what is left; neither has any of the names."""

    factors: tuple[tuple[str, Formula], ...]  #: by name, those that are not 0
    rest: Formula


def affine(formula: Formula, names: Collection[str]) -> Affine | None:
    """The formula as an affine function of these names; None where it is not affine.

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

    >>> from optlaws.formulas.reading import read
    >>> degree(read("k^2*c + b"), {"k": 1, "c": 5, "b": 6}), degree(read("sin(k)"), {"k": 1})
    (7, None)
    """
    degrees: list[int | None] = []
    for part, places, _ in formula.steps:
        degrees.append(_degree(part, [degrees[place] for place in places], names))
    return degrees[-1]


def _degree(formula: Formula, parts: list[int | None], names: Mapping[str, int]) -> int | None:
    if not formula.names() & names.keys():
        return 0
    if isinstance(formula, Name):
        return names[formula.name]
    if isinstance(formula, Exponentiation):
        base, exponent = parts[0], constant(formula.exponent)
        whole = exponent is not None and exponent >= 0.0 and exponent % 1.0 == 0.0
        return int(exponent) * base if whole and exponent is not None and base is not None else None
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
