"""Convexity of a formula in some of its names, by the rules of disciplined convex programming, with the reason.

A part's curvature follows from its own parts: sums of convex parts are convex, a convex function that rises takes
convex parts, one that falls takes concave ones (Grant, Boyd, Ye 2006). Beyond that, quadratic forms are looked at as a
whole.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, replace
from enum import Enum
from itertools import pairwise

import numpy as np

from optlaws.formulas.affine import affine, semidefinite
from optlaws.formulas.arithmetic import pieces
from optlaws.formulas.functions import SMOOTH_FUNCTIONS
from optlaws.formulas.intervals import Endpoints, enclosed
from optlaws.formulas.slopes import constant
from optlaws.formulas.tree import Call, Exponentiation, Formula, Negative, Product, Reciprocal, Sum, Table

_PARTS = 256


class Curvature(Enum):
    """The curvature of a formula in its names.

    >>> Curvature.CONVEX.opposite
    <Curvature.CONCAVE: 'concave'>
    """

    CONSTANT = "constant"
    AFFINE = "affine"
    CONVEX = "convex"
    CONCAVE = "concave"
    UNKNOWN = "not known to be convex"

    @property
    def opposite(self) -> Curvature:
        """The curvature of the formula with its sign turned."""
        return {Curvature.CONVEX: Curvature.CONCAVE, Curvature.CONCAVE: Curvature.CONVEX}.get(self, self)

    @property
    def convex(self) -> bool:
        """Whether the formula is convex, affine and constant included."""
        return self in {Curvature.CONSTANT, Curvature.AFFINE, Curvature.CONVEX}

    @property
    def concave(self) -> bool:
        """Whether the formula is concave, affine and constant included."""
        return self.opposite.convex


@dataclass(frozen=True)
class Verdict:
    """The curvature of a formula, the rule that shows it, and the part to which the rule applies.

    >>> from optlaws.formulas.reading import read
    >>> verdict = judge(read("c^2 + b*c"), "bc")
    >>> verdict.curvature.value, verdict.why, verdict.part
    ('not known to be convex', 'b*c is a product of parts that both vary', b*c)
    """

    curvature: Curvature
    why: str
    part: Formula


@dataclass(frozen=True)
class Judge:
    """The rules for formulas in some names, the other name `k` being between two values."""

    names: frozenset[str]  #: in which the curvature is asked
    #: start, stop: between which values k is
    start: float = 0.0
    stop: float = 1.0

    def verdict(self, formula: Formula) -> Verdict:
        """The verdict on a formula, by the rules first, then as a quadratic form."""
        verdict = self.by_rules(formula)
        if verdict.curvature is not Curvature.UNKNOWN:
            return verdict
        for sign in (1, -1):
            if semidefinite(formula, self.names, self._interval, sign):
                kind = Curvature.CONVEX if sign > 0 else Curvature.CONCAVE
                return Verdict(kind, f"{formula} is a {kind.value} quadratic form at every k", formula)
        return verdict

    def by_rules(self, formula: Formula) -> Verdict:
        """The verdict of the rules alone, part by part."""
        if not formula.names() & self.names:
            return Verdict(Curvature.CONSTANT, f"{formula} does not depend on the law", formula)
        if affine(formula, self.names) is not None:
            return Verdict(Curvature.AFFINE, f"{formula} is affine in the law", formula)
        if isinstance(formula, Negative):
            verdict = self.by_rules(formula.of)
            return replace(verdict, curvature=verdict.curvature.opposite)
        if isinstance(formula, Sum):
            return self._sum(formula)
        if isinstance(formula, Product):
            return self._product(formula)
        if isinstance(formula, Reciprocal):
            return self._power(formula, formula.of, -1.0)
        if isinstance(formula, Exponentiation):
            return self._of_power(formula)
        if isinstance(formula, Table):
            return self._table(formula)
        assert isinstance(formula, Call)  # noqa: S101 - there are no others
        return self._call(formula)

    @property
    def _interval(self) -> dict[str, Endpoints]:
        edges = np.linspace(self.start, self.stop, _PARTS + 1)
        whole = Endpoints(np.array(-np.inf), np.array(np.inf))
        return {**dict.fromkeys(self.names, whole), "k": Endpoints(edges[:-1], edges[1:])}

    def sign(self, formula: Formula) -> int:
        """1 where the value is nowhere negative, -1 where nowhere positive, 0 where neither is known."""
        interval = enclosed(formula, self._interval)
        if float(np.min(interval.low)) >= 0.0:
            return 1
        return -1 if float(np.max(interval.high)) <= 0.0 else 0

    def _sum(self, formula: Sum) -> Verdict:
        verdicts = [self.by_rules(term) for term in formula.terms]
        for kind, fits in ((Curvature.CONVEX, "convex"), (Curvature.CONCAVE, "concave")):
            if all(getattr(verdict.curvature, fits) for verdict in verdicts):
                return Verdict(kind, f"every term of {formula} is {fits}", formula)
        unknown = [verdict for verdict in verdicts if verdict.curvature is Curvature.UNKNOWN]
        return unknown[0] if unknown else _unknown(f"{formula} adds convex and concave terms", formula)

    def _product(self, formula: Product) -> Verdict:
        moving = [factor for factor in formula.factors if factor.names() & self.names]
        if len(moving) > 1:
            return _unknown(f"{formula} is a product of parts that both vary", formula)
        verdict = self.by_rules(moving[0])
        others = [factor for factor in formula.factors if factor is not moving[0]]
        sign = 1
        for factor in others:
            sign *= self.sign(factor)
        if sign == 0 and verdict.curvature is not Curvature.AFFINE:
            return _unknown(f"the factor of {moving[0]} in {formula} changes its sign", formula)
        kind = verdict.curvature if sign > 0 else verdict.curvature.opposite
        return Verdict(kind, f"{formula} is {moving[0]} times what does not change its sign; {verdict.why}", formula)

    def _of_power(self, formula: Exponentiation) -> Verdict:
        exponent = constant(formula.exponent)
        if exponent is not None:
            return self._power(formula, formula.base, exponent)
        base = constant(formula.base)
        if base is None or not base > 0.0:
            return _unknown(f"both parts of {formula} vary", formula)
        inner = self.by_rules(formula.exponent).curvature
        return _when(inner.convex if base >= 1.0 else inner.concave, Curvature.CONVEX, formula, "an exponential")

    def _power(self, formula: Formula, of: Formula, exponent: float) -> Verdict:
        inner, sign = self.by_rules(of), self.sign(of)
        even = exponent > 0.0 and exponent % 2.0 == 0.0
        kind = inner.curvature
        if exponent == 1.0:
            return inner
        if even and (kind in {Curvature.AFFINE, Curvature.CONSTANT} or (kind.concave and sign < 0)):
            return Verdict(Curvature.CONVEX, f"{formula} is an even power of what is affine", formula)
        if exponent > 1.0 and kind.convex and sign > 0:
            return Verdict(Curvature.CONVEX, f"{formula} rises with {of}, which is convex and not negative", formula)
        if exponent > 1.0 and exponent % 2.0 == 1.0 and kind.concave and sign < 0:
            return Verdict(Curvature.CONCAVE, f"{formula} rises with {of}, which is concave and not positive", formula)
        if 0.0 < exponent < 1.0:
            return _when(kind.concave, Curvature.CONCAVE, formula, f"a root of {of}")
        if exponent < 0.0 and kind.concave and sign > 0:
            return Verdict(Curvature.CONVEX, f"{formula} falls with {of}, which is concave and positive", formula)
        if exponent == -1.0 and kind.convex and sign < 0:
            return Verdict(Curvature.CONCAVE, f"{formula} falls with {of}, which is convex and negative", formula)
        return _unknown(f"no rule says what the power {formula} of a part that is {kind.value} is", formula)

    def _table(self, formula: Table) -> Verdict:
        inner = self.by_rules(formula.of).curvature
        bend = _bend(formula)
        if inner is not Curvature.AFFINE or not bend:
            return _unknown(f"{formula} bends both ways, or is of a part that is not affine", formula)
        kind = Curvature.CONVEX if bend > 0 else Curvature.CONCAVE
        return Verdict(kind, f"{formula} bends one way and is of an affine part", formula)

    def _call(self, formula: Call) -> Verdict:
        name, kinds = formula.function, [self.by_rules(argument).curvature for argument in formula.arguments]
        function = SMOOTH_FUNCTIONS.get(name)
        rising = function.curvature if function is not None and function.rising else None
        if name == "max" or rising == "convex":
            return _when(
                all(kind.convex for kind in kinds), Curvature.CONVEX, formula, f"{name}, which rises, of parts"
            )
        if name == "min" or rising == "concave":
            return _when(
                all(kind.concave for kind in kinds), Curvature.CONCAVE, formula, f"{name}, which rises, of parts"
            )
        if name in {"abs", "norm"}:
            fits = all(self._size_is_convex(argument) for argument in formula.arguments)
            return _when(fits, Curvature.CONVEX, formula, f"{name} of parts")
        return _unknown(f"{name} bends both ways: {formula} is not convex", formula)

    def _size_is_convex(self, part: Formula) -> bool:
        kind, sign = self.by_rules(part).curvature, self.sign(part)
        plain = kind in {Curvature.AFFINE, Curvature.CONSTANT}
        return plain or (kind.convex and sign > 0) or (kind.concave and sign < 0)


def judge(formula: Formula, names: Collection[str]) -> Verdict:
    """The verdict on a formula in some of its names, k being between 0 and 1.

    >>> from optlaws.formulas.reading import read
    >>> judge(read("c^2 + (1 + k)*b^2"), "bc").curvature, judge(read("c^2 + b*c + b^2"), "bc").why
    (<Curvature.CONVEX: 'convex'>, 'c^2 + b*c + b^2 is a convex quadratic form at every k')
    """
    return Judge(frozenset(names)).verdict(formula)


def _unknown(why: str, part: Formula) -> Verdict:
    return Verdict(Curvature.UNKNOWN, why, part)


def _when(fits: bool, kind: Curvature, formula: Formula, what: str) -> Verdict:  # noqa: FBT001 - the rule's answer
    if fits:
        return Verdict(kind, f"{formula} is {what} that keep it {kind.value}", formula)
    return _unknown(f"{formula} is {what} that do not keep it {kind.value}", formula)


def _bend(table: Table) -> int:
    """1 where a table is convex everywhere, -1 where it is concave, else 0."""
    rows = pieces(table)
    if not table.smooth:
        steps = [after - before for before, after in pairwise(rows[:, 1].tolist())]
    elif table.order or rows.shape[1] < 4:
        return 0
    else:
        lengths = np.diff(table.places)
        ends = [*(2.0 * rows[:, 2]).tolist(), float(2.0 * rows[-1, 2] + 6.0 * rows[-1, 3] * lengths[-1])]
        steps = [*ends, -float(rows[0, 3]), float(rows[-1, 3])]
    if all(step >= 0.0 for step in steps):
        return 1
    return -1 if all(step <= 0.0 for step in steps) else 0
