"""Constraints from formulas: rows where they are affine in the law, curved ones and their lower bounds where not."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from itertools import pairwise
from itertools import product as every
from typing import TYPE_CHECKING

import numpy as np

from optlaws.formulas.branches import switches
from optlaws.formulas.convexity import Judge, degree, quadratic
from optlaws.formulas.of_motion import MotionFormula
from optlaws.formulas.tree import ORDERS, Call, Exponentiation, Formula, Name, Negative, Number, number, product, total
from optlaws.numbers import Array
from optlaws.numerics.chebyshev import from_values, gauss, interpolated, nodes
from optlaws.synthesis.families import names
from optlaws.synthesis.families.curved import CurvedFamily, IntegralFamily
from optlaws.synthesis.families.family import ConstraintFamily, LinearFamily
from optlaws.synthesis.families.kinked import KinkedIntegralFamily
from optlaws.synthesis.families.names import mirrored
from optlaws.synthesis.families.piece_series import PieceSeries, widened
from optlaws.tolerances import RULES_AGREE, VALUE_ROUNDING

if TYPE_CHECKING:
    from optlaws.synthesis.spaces.space import LawSpace

_PLACES = 7


@dataclass(frozen=True)
class Side:
    """A formula on the part of the interval that a space's rows cover."""

    name: str
    motion: MotionFormula
    signs: tuple[float, ...]


def sides(motion: MotionFormula, name: str, signs: tuple[float, ...], *, symmetric: bool) -> list[Side]:
    """Formulas for the rows: the formula itself, or for symmetric laws each half on the first one.

    Where the second half says the same as the first, or its opposite, one side says both.
    """
    if not symmetric:
        return [Side(name, motion, signs)]
    first, *second = motion.halves()
    if not second:
        return [Side(name, first, signs)]
    [other] = second
    if (first.start, first.stop) == (other.start, other.stop):
        here, there = sampled(first), sampled(other)
        size = VALUE_ROUNDING * float(np.abs(here).max())
        with np.errstate(invalid="ignore"):
            even, odd = (float(np.abs(part).max()) <= size for part in (here - there, here + there))
        if even:
            return [Side(name, first, signs)]
        if odd:
            return [Side(name, first, tuple(dict.fromkeys((*signs, *(-sign for sign in signs)))))]
    # the first sign is that which laws reach more often, and gets more points: c changes its own at the middle
    turned = signs[::-1] if max(motion.orders) % 2 == 0 else signs
    return [Side(name, first, signs), Side(mirrored(name), other, turned)]


def sampled(motion: MotionFormula) -> Array:
    """Its values in motions at random."""
    numbers = np.random.default_rng(0)
    names = {name: numbers.normal(size=_PLACES) for name in "abcj"}
    k = motion.start + (motion.stop - motion.start) * numbers.random(_PLACES)
    return np.broadcast_to(motion.values({**names, "k": k}), (_PLACES,))


def columns(space: LawSpace, motion: MotionFormula, u: Array) -> Array:
    """An affine formula at places u = 1 - 2k: of the free functions, then of the base law with what is left."""
    k = (1.0 - u) / 2.0
    total = np.zeros((len(u), space.terms + 1))
    for nu, factor in motion.weights.items():
        total += _at(factor, k)[:, None] * space.columns(nu, u)
    total[:, -1] += _at(motion.rest, k)
    return total


def _at(factor: Formula, k: Array) -> Array:
    return np.broadcast_to(MotionFormula(factor).values({"k": k}), k.shape)


def rows(space: LawSpace, side: Side, slack: Array, bound: float) -> LinearFamily:
    """Rows s f <= slack . x + bound on the side's part of the interval."""
    motion, domain = side.motion, space.part(side.motion.start, side.motion.stop, side.motion.orders)
    plain = motion.constant_weights()
    if plain is not None and not plain[1] and plain[0]:
        weights, lowest = plain[0], min(plain[0])
        combined = tuple(weights.get(nu, 0.0) for nu in range(lowest, max(weights) + 1))
        family = space.combination(lowest, combined, side.name, slack, bound, signs=side.signs)
        return replace(family, domain=(max(domain[0], family.domain[0]), min(domain[1], family.domain[1])))
    edges = edges_of(space, motion)
    places = [_between(ends, nodes(count_of(space, motion, ends))) for ends in pairwise(edges)]
    series = [from_values(columns(space, motion, u)) for u in places]
    stacked = np.zeros((len(series), max(map(len, series)), space.terms + 1))
    for i, coefficients in enumerate(series):
        stacked[i, : len(coefficients)] = coefficients
    table, jumps = PieceSeries(np.array(edges), stacked).widened(len(slack)), any(map(space.jumps, motion.orders))
    return LinearFamily(side.name, slack, bound, side.signs, domain, table=table, jumps=jumps)


def edges_of(space: LawSpace, motion: MotionFormula) -> tuple[float, ...]:
    """The u between which an affine formula is smooth in every law, descending."""
    return tuple(sorted({*space.edges, *(1.0 - 2.0 * k for k in motion.kinks)}, reverse=True))


def count_of(space: LawSpace, motion: MotionFormula, ends: tuple[float, float]) -> int:
    """How many Chebyshev coefficients an affine formula needs between two u, for every law."""

    def length(factor: Formula) -> int:
        known = degree(factor, {"k": 1})
        if known is not None:
            return known
        return len(interpolated(lambda x: _at(factor, (1.0 - _between(ends, x)) / 2.0), str(factor)))

    lengths = [length(factor) + space.degree_of(nu) for nu, factor in motion.weights.items()]
    return 1 + max([*lengths, length(motion.rest)])


def _between(ends: tuple[float, float], x: Array) -> Array:
    """The u of places from -1 to 1."""
    high, low = ends
    return np.asarray(low + (x + 1.0) * (high - low) / 2.0)


def gauss_places(space: LawSpace, motion: MotionFormula) -> tuple[Array, Array]:
    """Places u in the formula's part and weights that add up to its length in k; exact for squares of the formula."""
    places, weights = [], []
    for ends, count in gauss_parts(space, motion):
        x, weight = gauss(count)
        places.append(_between(ends, x))
        weights.append(weight * (ends[0] - ends[1]) / 4.0)
    return np.concatenate(places), np.concatenate(weights)


def gauss_parts(space: LawSpace, motion: MotionFormula) -> list[tuple[tuple[float, float], int]]:
    """Between which u, descending, how many places of Gauss's rule are."""
    low, high = 1.0 - 2.0 * motion.stop, 1.0 - 2.0 * motion.start
    inner = [u for u in edges_of(space, motion) if low < u < high]
    return [(ends, count_of(space, motion, ends) + 1) for ends in pairwise([high, *inner, low])]


_SPARE = 40
#: how often parts are cut in two, at most
_MOST_POWER = 5
#: along how many laws rules must agree, and how much greater the acceleration of the others is
_LAWS, _GREATER = 4, 2.0
#: formulas beneath one
_MOST = 8

#: between which values derivatives are, by name
Boxes = Mapping[str, tuple[float, float]]


@dataclass(frozen=True)
class Branch:
    """A smooth formula that a sign of another is at least, with the signs with which its tangents bound it."""

    motion: MotionFormula
    sign: float
    name: str

    @property
    def convex(self) -> bool:
        """Whether the formula is convex, with its sign."""
        kind = self.motion.curvature
        return kind.convex if self.sign > 0.0 else kind.concave


def split(motion: MotionFormula, sign: float, name: str) -> list[Branch] | None:
    """The smooth formulas of which `sign` times the formula is the greatest; None where it is no such maximum."""
    formulas = motion.branches(sign)
    if formulas is None:
        return None
    if len(formulas) == 1:
        return [Branch(motion, sign, name)]
    return [
        Branch(replace(motion, formula=formula), 1.0, names.branch(i, name)) for i, formula in enumerate(formulas, 1)
    ]


def branch_rows(space: LawSpace, branch: Branch, slack: Array, bound: float) -> ConstraintFamily:
    """Rows of one branch on a part of the space's part of the interval."""
    motion = branch.motion
    if motion.affine is not None:
        return rows(space, Side(branch.name, motion, (branch.sign,)), slack, bound)
    nothing = np.zeros(len(slack))
    degrees = _degrees(space, motion)
    sides = {name: Side(name, MotionFormula(Name(name), motion.start, motion.stop), (1.0,)) for name in sorted(degrees)}
    parts = tuple((name, rows(space, side, nothing, 0.0)) for name, side in sides.items())
    return CurvedFamily(
        branch.name,
        slack,
        bound,
        (branch.sign,),
        space.part(motion.start, motion.stop, motion.orders),
        formula=motion.formula,
        parts=parts,
        tangents=(branch.sign,) if branch.convex else (),
        degree=motion.degree(degrees),
        edges=edges_of(space, motion),
    )


def integral_rows(
    space: LawSpace, motion: MotionFormula, name: str, slack: Array, bound: float, *, root: bool, convex: bool
) -> IntegralFamily:
    """The row that the integral of a formula over its part, or its root, is at most slack . x + bound."""
    used = tuple(sorted(_degrees(space, motion)))
    # exact where the formula is a polynomial of k
    k, weights = _rule(rule_edges(space, motion), rule_length(space, motion))
    columns = np.stack([widened(columns_of(space, ORDERS[symbol], k), len(slack)) for symbol in used])
    plain = IntegralFamily(
        name,
        slack,
        bound,
        formula=motion.formula,
        names=used,
        columns=columns,
        places=k,
        weights=weights,
        root=root,
        convex=convex,
    )
    return plain if not switches(motion.formula, ORDERS) else _kinked(space, motion, plain)


def _kinked(space: LawSpace, motion: MotionFormula, plain: IntegralFamily) -> KinkedIntegralFamily:
    """The family of a formula with kinks in the law, by its smooth formulas between them."""

    def rows(turn: int, k: Array) -> Array:
        several = (columns_of(space, ORDERS[name] + turn, k) for name in plain.names)
        return np.array([widened(columns, len(plain.slack)) for columns in several])

    given = {field.name: getattr(plain, field.name) for field in fields(plain)}
    length = rule_length(space, motion, between_kinks=True)
    edges = tuple(_known_edges(space, motion))
    return KinkedIntegralFamily(**given, rows=rows, units=np.ones(len(plain.slack) + 1), edges=edges, length=length)


def _rule(edges: list[float], count: int) -> tuple[Array, Array]:
    """Places k of Gauss's rule between edges, and their weights."""
    x, share = gauss(count)
    low, width = np.array(edges[:-1])[:, None], np.diff(edges)[:, None]
    return (low + width * (1.0 + x) / 2.0).ravel(), (share * width / 2.0).ravel()


def _degrees(space: LawSpace, motion: MotionFormula) -> dict[str, int]:
    """The degrees of the derivatives that a formula has, by their names."""
    return {name: space.degree_of(nu) for name, nu in ORDERS.items() if name in motion.formula.names()}


def rule_length(space: LawSpace, motion: MotionFormula, *, between_kinks: bool = False) -> int:
    """How many places a piece needs."""
    degrees = _degrees(space, motion)
    degree = motion.degree(degrees, between_kinks=between_kinks)
    return _SPARE + max(degrees.values(), default=0) if degree is None else degree // 2 + 1


def rule_edges(space: LawSpace, motion: MotionFormula) -> list[float]:
    """Edges in k of the quadrature rule: between them the formula is smooth for every law.

    Where it is no polynomial they are as near as the space's own law requires, and nearer, for others are less smooth.
    """
    edges = _known_edges(space, motion)
    if motion.degree(dict.fromkeys(ORDERS, 1)) is not None:
        return edges
    cells = space.cached(("cells", motion), lambda: np.array(_cells(space, motion, edges)))
    return _cut(edges, int(cells))


def _known_edges(space: LawSpace, motion: MotionFormula) -> list[float]:
    """The k between which derivatives and factors are smooth along every law, over the formula's part."""
    edges = [(1.0 - u) / 2.0 for u in space.edges]
    both = {*edges, *(1.0 - k for k in edges)} if space.symmetric else set(edges)
    inner = {k for k in (*both, *motion.kinks) if motion.start < k < motion.stop}
    return sorted({motion.start, motion.stop, *inner})


def _cells(space: LawSpace, motion: MotionFormula, edges: list[float]) -> int:
    """The numbers of cells between edges, doubled until the values along some laws no longer change."""
    count, before, laws = rule_length(space, motion), np.full(_LAWS, np.nan), _some_laws(space)
    for power in range(_MOST_POWER + 1):
        k, weights = _rule(_cut(edges, 1 << power), count)
        names = {name: laws @ columns_of(space, ORDERS[name], k).T for name in _degrees(space, motion)}
        values = np.broadcast_to(motion.values({**names, "k": k}), (_LAWS, len(k)))
        integrals = values @ weights
        if (np.abs(integrals - before) <= RULES_AGREE * (np.abs(values) @ weights)).all():
            return max(1 << power - 1, 1)
        before = integrals
    return 1 << _MOST_POWER


def _some_laws(space: LawSpace) -> Array:
    """Coordinates with 1 beside them: of the space's own law, and of others at random whose c is greater."""
    rule, moments = space.quadrature(2), np.zeros((_LAWS, space.terms + 1))
    moments[:, -1] = 1.0
    moments[1:, :-1] = np.random.default_rng(0).normal(size=(_LAWS - 1, space.terms))
    for law in moments[1:]:
        moved = float(np.sqrt(rule.weights @ (rule.values[:, :-1] @ law[:-1]) ** 2))
        law[:-1] *= _GREATER * float(np.sqrt(rule.weights @ rule.values[:, -1] ** 2)) / moved if moved else 0.0
    return moments


def _cut(edges: list[float], cells: int) -> list[float]:
    inner = (low + (high - low) * i / cells for low, high in pairwise(edges) for i in range(cells))
    return [*inner, edges[-1]]


def columns_of(space: LawSpace, nu: int, k: Array) -> Array:
    """The derivative of order nu at places in [0, 1]: of symmetric laws the second half is the first's mirror image."""
    if not space.symmetric:
        return space.columns(nu, 1.0 - 2.0 * k)
    columns = space.columns(nu, np.abs(1.0 - 2.0 * k))
    if nu % 2 == 0:
        later = k > 0.5
        columns[later] *= -1.0
        if nu == 0:
            columns[later, -1] += 1.0
    return columns


def envelopes(motion: MotionFormula, boxes: Boxes) -> list[Formula]:
    """Convex lower bounds of a quadratic formula while derivatives are in their boxes (McCormick 1976).

    None where the formula is not quadratic, a factor changes its sign or a derivative in a product has no bounds.

    Examples
    --------
    >>> from optlaws.formulas.of_motion import of_text
    >>> envelopes(of_text("b*c + b"), {"b": (0.0, 2.0), "c": (-4.0, 4.0)})
    [1*(0*c + (-4)*b - 0*(-4)) + 1*b, 1*(2*c + 4*b - 2*4) + 1*b]
    """
    terms = quadratic(motion.formula, ORDERS)
    judge = Judge(frozenset(ORDERS), motion.start, motion.stop)
    choices: list[list[Formula]] = []
    for key, factor in (terms or {}).items():
        plain = product([factor, *map(Name, key)]) if key else factor
        if len(key) < 2 or (key[0] == key[1] and judge.sign(factor) > 0):
            choices.append([plain])
            continue
        sign = judge.sign(factor)
        if not sign or not all(name in boxes for name in key):
            return []
        choices.append([product([factor, bound]) for bound in _bounds(key, boxes, above=sign < 0)])
    count = int(np.prod([len(choice) for choice in choices])) if choices else 0
    return [total(list(chosen)) for chosen in every(*choices)] if 0 < count <= _MOST else []


def _bounds(names_of: tuple[str, ...], boxes: Boxes, *, above: bool) -> list[Formula]:
    """Affine bounds of a product."""
    first, second = map(Name, names_of)
    (l1, u1), (l2, u2) = (boxes[name] for name in names_of)
    corners = [(u1, l2), (l1, u2)] if above else [(l1, l2), (u1, u2)]
    numbers = [(number(factor), number(other)) for factor, other in corners[: 1 if above and first == second else 2]]
    return [
        total([product([factor, second]), product([other, first]), Negative(product([factor, other]))])
        for factor, other in numbers
    ]


def squared(motion: MotionFormula) -> MotionFormula:
    """The square of a formula; of norm(b, 2*c) it is b^2 + (2*c)^2, which has no root in it."""
    formula, two = motion.formula, Number(2.0)
    sizes = formula.arguments if isinstance(formula, Call) and formula.function in {"abs", "norm"} else (formula,)
    return replace(motion, formula=total([Exponentiation(part, two) for part in sizes]))
