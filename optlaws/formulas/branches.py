"""Formulas with kinks as the maximum of smooth formulas."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from itertools import combinations
from itertools import product as every
from math import prod

import numpy as np
from numpy.typing import NDArray

from optlaws.formulas.arithmetic import NUMPY, pieces, step_value
from optlaws.formulas.slopes import added, multiplied, opposite
from optlaws.formulas.tree import (
    SMOOTH_FUNCTIONS,
    Call,
    Exponentiation,
    Formula,
    Negative,
    Number,
    Product,
    Reciprocal,
    Sum,
    Table,
    number,
    rebuilt,
)
from optlaws.numbers import Array

_MOST = 16
_RISING = frozenset(name for name, function in SMOOTH_FUNCTIONS.items() if function.rising)

#: whether a formula is nowhere below 0 (1) or above (-1), or neither is known (0)
Sign = Callable[[Formula], int]


def branches(formula: Formula, names: Collection[str], sign: Sign) -> list[Formula] | None:
    """Smooth formulas of which it is the greatest; itself where it is smooth, None where it is no such maximum.

    >>> from optlaws.formulas.reading import read
    >>> branches(read("abs(c) + 2*max(b, 0)"), "bc", lambda part: 1)
    [c + 2*b, c, -c + 2*b, -c]
    >>> branches(read("-abs(c)"), "bc", lambda part: 1) is None
    True
    """
    parts = _Branches(frozenset(names), sign).of(formula, greatest=True)
    return None if parts is None or len(parts) > _MOST else list(dict.fromkeys(parts))


def smooth(formula: Formula, names: Collection[str]) -> bool:
    """Whether the formula has no kinks in these names.

    >>> from optlaws.formulas.reading import read
    >>> smooth(read("b*c + abs(k)"), "bc"), smooth(read("abs(b)"), "bc")
    (True, False)
    """
    return not formula.kinked_names & set(names)


def switches(formula: Formula, names: Collection[str]) -> list[Formula]:
    """Formulas that all keep their signs between the given formula's kinks; switches of inner parts come first.

    >>> from optlaws.formulas.reading import read
    >>> switches(read("max(abs(b) - 1, c, 0)"), "bc")
    [b, abs(b) - 1 - c, abs(b) - 1, c]
    >>> switches(read("spline(a, 0:1, 0.25:2, 0.75:3, 1:3)*c"), "ac")
    [a - 0.25, a - 0.75]
    """
    formulas: list[Formula] = []
    for part in _inner_first(formula):
        if (not part.kinked and not isinstance(part, Table)) or not part.names() & set(names):
            continue
        if isinstance(part, Table):
            formulas += [added([part.of, opposite(number(place))]) for place in part.places[1:-1]]
        elif len(part.parts) == 1:
            formulas += part.parts
        else:
            formulas += [added([first, opposite(other)]) for first, other in combinations(part.parts, 2)]
    return [fromkey for fromkey in dict.fromkeys(formulas) if fromkey.names() & set(names)]


def _inner_first(formula: Formula) -> list[Formula]:
    """All parts of a formula before the formulas that they are parts of, the last ones first."""
    seen: dict[Formula, None] = {}

    def see(part: Formula) -> None:
        for inner in reversed(part.parts):
            if inner not in seen:
                see(inner)
        seen[part] = None

    see(formula)
    return list(seen)


def corners(formula: Formula, names: Collection[str]) -> list[Formula]:
    """Formulas that are 0 where tables of straight lines bend.

    >>> from optlaws.formulas.reading import read
    >>> corners(read("table(x, 0:0, 1:1, 3:0) + spline(x, 0:1, 1:2, 2:3, 3:3)"), "x")
    [x - 1]
    """
    bent = (part for part in formula.different if isinstance(part, Table) and part.kinked)
    return [switch for table in dict.fromkeys(bent) for switch in switches(table, names)]


def knots(formula: Formula, names: Collection[str]) -> tuple[list[Formula], list[Formula]]:
    """The switches that have none themselves, and the others.

    >>> from optlaws.formulas.reading import read
    >>> knots(read("max(abs(b) - 1, c, 0)"), "bc")
    ([b, c], [abs(b) - 1 - c, abs(b) - 1])
    """
    several = switches(formula, names)
    inner = {switch: bool(switches(switch, names)) for switch in several}
    return [switch for switch in several if not inner[switch]], [switch for switch in several if inner[switch]]


def branches_at(formula: Formula, names: Mapping[str, Array], count: int) -> list[Formula]:
    """The smooth formulas that it is at as many places, where its names have arrays of values.

    >>> from optlaws.formulas.reading import read
    >>> branches_at(read("abs(b) + max(c, 2*b)"), {"b": np.array([-1.0, 2.0]), "c": 3.0}, 2)
    [-b + c, b + 2*b]
    >>> branches_at(read("table(a, 0:0, 0.5:2, 1:3)"), {"a": np.array([0.75])}, 1)
    [2 + 2*(a - 0.5)]
    """
    values: list[Array] = []
    choices: list[NDArray[np.intp]] = []
    for part, places, _ in formula.steps:
        of = [values[place] for place in places]
        values.append(np.broadcast_to(step_value(part, of, names, NUMPY), (count,)))
        if isinstance(part, Table) or part.kinked:
            choices.append(_choice(part, of))
    keys = np.array(choices, dtype=np.intp).reshape(len(choices), count).T.tolist()
    for key in map(tuple, keys):
        if key not in formula.known_branches:
            formula.known_branches[key] = _chosen(formula, key)
    return [formula.known_branches[tuple(key)] for key in keys]


def _choice(part: Formula, values: Sequence[Array]) -> NDArray[np.intp]:
    """The smooth formula that a part with a kink equals for given values of its parts."""
    if isinstance(part, Table):
        return np.clip(np.searchsorted(part.places, values[0], side="right") - 1, 0, len(part.places) - 2)
    if len(values) == 1:
        return np.asarray(values[0] < 0.0, dtype=np.intp)
    greatest = isinstance(part, Call) and part.function == "max"
    return np.asarray(np.argmax(values, axis=0) if greatest else np.argmin(values, axis=0))


def _chosen(formula: Formula, choices: Sequence[int]) -> Formula:
    """The smooth formula of one choice for each part with a kink."""
    built: list[Formula] = []
    left = iter(choices)
    for part, places, _ in formula.steps:
        parts = [built[place] for place in places]
        if isinstance(part, Table):
            i = next(left)
            start = added([parts[0], opposite(number(part.places[i]))])
            built.append(_in_powers(pieces(part)[i].tolist(), start))
        elif not part.kinked:
            same = all(new is old for new, old in zip(parts, part.parts, strict=True))
            built.append(part if same else rebuilt(part, parts))
        elif len(parts) == 1:
            built.append(opposite(parts[0]) if next(left) else parts[0])
        else:
            built.append(parts[next(left)])
    return built[-1]


def _in_powers(coefficients: Sequence[float], of: Formula) -> Formula:
    """The polynomial with these coefficients, ascending."""
    powers = [Number(1.0), of, *(Exponentiation(of, Number(float(m))) for m in range(2, len(coefficients)))]
    return added([multiplied([number(value), power]) for value, power in zip(coefficients, powers, strict=False)])


class _Branches:
    def __init__(self, names: frozenset[str], sign: Sign) -> None:
        self.names, self.sign = names, sign

    def of(self, formula: Formula, *, greatest: bool) -> list[Formula] | None:
        """The smooth formulas of which a formula is the greatest or the least; None where it is neither.

        Between the places of its tables a formula without other kinks is smooth as well.
        """
        if smooth(formula, self.names):
            return [formula]
        known = self._maximum(formula, greatest=greatest)
        return [formula] if known is None and self._has_corners_alone(formula) else known

    def _has_corners_alone(self, formula: Formula) -> bool:
        """Whether all kinks are those of tables of straight lines."""
        kinked = (part for part in formula.different if not isinstance(part, Table) and part.kinked)
        return not any(part.names() & self.names for part in kinked)

    def _maximum(self, formula: Formula, *, greatest: bool) -> list[Formula] | None:
        if isinstance(formula, Negative):
            return _each(self.of(formula.of, greatest=not greatest), opposite)
        if isinstance(formula, Sum):
            return self._sum(formula, greatest=greatest)
        if isinstance(formula, Product):
            return self._product(formula, greatest=greatest)
        if isinstance(formula, Exponentiation):
            return self._power(formula)
        if isinstance(formula, Table):
            return self._table(formula, greatest=greatest)
        return self._call(formula, greatest=greatest) if isinstance(formula, Call) else None

    def _sum(self, formula: Sum, *, greatest: bool) -> list[Formula] | None:
        terms = [self.of(term, greatest=greatest) for term in formula.terms]
        known = [term for term in terms if term is not None]
        if len(known) < len(terms) or prod(map(len, known)) > _MOST:
            return None
        return [added(list(choice)) for choice in every(*known)]

    def _product(self, formula: Product, *, greatest: bool) -> list[Formula] | None:
        moving = [factor for factor in formula.factors if factor.names() & self.names]
        if len(moving) > 1 or isinstance(moving[0], Reciprocal):
            return None
        others = [factor for factor in formula.factors if factor is not moving[0]]
        sign = self.sign(multiplied(others))
        inner = self.of(moving[0], greatest=greatest == (sign > 0)) if sign else None
        return _each(inner, lambda branch: multiplied([*others, branch]))

    def _power(self, formula: Exponentiation) -> list[Formula] | None:
        """An even power of a magnitude is smooth."""
        exponent = formula.exponent
        even = isinstance(exponent, Number) and exponent.value % 2.0 == 0.0
        if even and isinstance(formula.base, Call) and formula.base.function == "abs":
            return [Exponentiation(formula.base.arguments[0], exponent)]
        return None

    def _table(self, formula: Table, *, greatest: bool) -> list[Formula] | None:
        """Its lines, where it bends one way."""
        lines = pieces(formula).tolist()
        slopes = [line[1] for line in lines]
        if not smooth(formula.of, self.names):
            return None
        if slopes != sorted(slopes, reverse=not greatest):
            return None
        return [
            added([number(start - slope * place), multiplied([number(slope), formula.of])])
            for place, (start, slope) in zip(formula.places, lines, strict=False)
        ]

    def _call(self, formula: Call, *, greatest: bool) -> list[Formula] | None:
        if formula.function == "abs" and greatest:
            [part] = formula.arguments
            both = [self.of(part, greatest=True), self.of(opposite(part), greatest=True)]
        elif formula.function == ("max" if greatest else "min"):
            both = [self.of(part, greatest=greatest) for part in formula.arguments]
        elif formula.function in _RISING:
            [part] = formula.arguments
            return _each(self.of(part, greatest=greatest), lambda branch: Call(formula.function, (branch,)))
        else:
            return None
        known = [branch for group in both if group is not None for branch in group]
        return None if any(group is None for group in both) else known


def _each(parts: list[Formula] | None, change: Callable[[Formula], Formula]) -> list[Formula] | None:
    return None if parts is None else [change(branch) for branch in parts]
