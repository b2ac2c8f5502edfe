"""Formulas with kinks as the greatest of smooth ones."""

from __future__ import annotations

from collections.abc import Callable, Collection
from itertools import product as every

from optlaws.formulas.arithmetic import pieces
from optlaws.formulas.slopes import added, multiplied, opposite
from optlaws.formulas.tree import Call, Formula, Negative, Number, Power, Product, Reciprocal, Sum, Table, number

_MOST = 16
_RISING = frozenset({"exp", "log", "sqrt", "atan", "tanh"})

#: whether a formula is nowhere below 0 (1) or above (-1), or neither is known (0)
Sign = Callable[[Formula], int]


def branches(formula: Formula, names: Collection[str], sign: Sign) -> list[Formula] | None:
    """Smooth formulas of which it is the greatest; itself where it is smooth, None where it is no such maximum.

    Examples
    --------
    >>> from optlaws.formulas.reading import read
    >>> branches(read("abs(c) + 2*max(b, 0)"), "bc", lambda part: 1)
    [c + 2*b, c, -c + 2*b, -c]
    >>> branches(read("-abs(c)"), "bc", lambda part: 1) is None
    True
    """
    found = _Branches(frozenset(names), sign).of(formula, greatest=True)
    return None if found is None or len(found) > _MOST else list(dict.fromkeys(found))


def smooth(formula: Formula, names: Collection[str]) -> bool:
    """Whether it has no kinks in these names.

    Examples
    --------
    >>> from optlaws.formulas.reading import read
    >>> smooth(read("b*c + abs(k)"), "bc"), smooth(read("abs(b)"), "bc")
    (True, False)
    """
    kinked = (part for part in formula.walk() if not smooth_itself(part))
    return not any(part.names() & set(names) for part in kinked)


def smooth_itself(part: Formula) -> bool:
    """Whether a part has no kinks but those of what it is made of."""
    if isinstance(part, Table):
        return part.smooth
    return not (isinstance(part, Call) and part.function in {"abs", "max", "min"})


class _Branches:
    def __init__(self, names: frozenset[str], sign: Sign) -> None:
        self.names, self.sign = names, sign

    def of(self, formula: Formula, *, greatest: bool) -> list[Formula] | None:
        """As the greatest, or the least, of smooth formulas."""
        if smooth(formula, self.names):
            return [formula]
        if isinstance(formula, Negative):
            return _each(self.of(formula.of, greatest=not greatest), opposite)
        if isinstance(formula, Sum):
            return self._sum(formula, greatest=greatest)
        if isinstance(formula, Product):
            return self._product(formula, greatest=greatest)
        if isinstance(formula, Power):
            return self._power(formula)
        if isinstance(formula, Table):
            return self._table(formula, greatest=greatest)
        return self._call(formula, greatest=greatest) if isinstance(formula, Call) else None

    def _sum(self, formula: Sum, *, greatest: bool) -> list[Formula] | None:
        terms = [self.of(term, greatest=greatest) for term in formula.terms]
        known = [term for term in terms if term is not None]
        count = 1
        for term in known:
            count *= len(term)
        if len(known) < len(terms) or count > _MOST:
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

    def _power(self, formula: Power) -> list[Formula] | None:
        """An even power of a magnitude is smooth."""
        exponent = formula.exponent
        even = isinstance(exponent, Number) and exponent.value % 2.0 == 0.0
        if even and isinstance(formula.base, Call) and formula.base.function == "abs":
            return [Power(formula.base.arguments[0], exponent)]
        return None

    def _table(self, formula: Table, *, greatest: bool) -> list[Formula] | None:
        """Its lines, where it bends one way."""
        lines = pieces(formula).tolist()
        slopes = [line[1] for line in lines]
        if not smooth(formula.of, self.names) or slopes != sorted(slopes, reverse=not greatest):
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


def _each(found: list[Formula] | None, change: Callable[[Formula], Formula]) -> list[Formula] | None:
    return None if found is None else [change(branch) for branch in found]
