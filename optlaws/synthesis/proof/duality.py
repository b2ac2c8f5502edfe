"""Rows of contacts, and their weighted sum in doubles: the bound by weak duality, less what their rounding may hide.

What rounding leaves of the sum's dependence on the law is charged: the quick bound by which searches decide and arrays
are proven. That of a single certificate is exact. A law that contradicts the claim has a small objective, so small
constants, which bound moments of its derivatives and its coordinates.
"""

from __future__ import annotations

from collections.abc import Callable, Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import inf, isfinite, sqrt
from typing import Any, NamedTuple

import numpy as np

from optlaws.kept import kept_property
from optlaws.numbers import Array
from optlaws.synthesis.families.cone import ConeFamily
from optlaws.synthesis.families.curved import FormulaFamily
from optlaws.synthesis.families.energy import EnergyFamily
from optlaws.synthesis.families.family import ConstraintFamily, LinearFamily, NormFamily, Program
from optlaws.synthesis.families.names import VariableName
from optlaws.synthesis.problem.constants import Functional, PeakConstant, PowerConstant
from optlaws.synthesis.problem.expression import Expression, Maximum, Term, leaves
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.program.writer import Model, maxima, relaxed_power
from optlaws.synthesis.proof.nodes import Contact, Leaf
from optlaws.synthesis.spaces.space import LawSpace
from optlaws.tolerances import ROUNDOFF

_SUBLEVEL_RANK = 1e-15  # of the greatest singular value: less is rounding

_ACCELERATION = 2

#: a float; or, where all is to be exact, a Fraction or an infinite float
Number = Any


@dataclass(frozen=True, eq=False)
class Sublevel:
    """The laws of a problem that contradict a claim, in floats or in exact numbers.

    Attributes
    ----------
    problem, variables
        The problem, and the names of its program's variables.
    sizes
        Orders, factors and offsets of a constant: the mean of |a^(order)| is at most factor times it plus the offset.
    floor
        A lower bound of a constant.
    number, root
        A float as such a number, and the root of such a number, rounded up where it is to be exact.
    """

    problem: Problem
    variables: Container[str]
    sizes: Callable[[Functional], Iterable[tuple[int, Number, Number]]]
    floor: Callable[[Functional], Number]
    number: Callable[[float], Number] = float
    root: Callable[[Number], Number] = sqrt

    @classmethod
    def of(cls, model: Model) -> Sublevel:
        """In floats, with the variables of a program."""
        space = model.space
        return cls(model.problem, model.places, lambda c: c.sizes(space), lambda c: c.floor(space.boundary))

    @kept_property
    def ends(self) -> tuple[Number | None, Number | None, Number]:
        """What every law has: b(0), b(1) - b(0), None where it is free, and the stroke."""
        conditions = self.problem.conditions
        start, end = ([self.number(value) for value in part] for part in (conditions.start, conditions.end))
        if len(start) > 1:
            return start[1], end[1] - start[1], end[0] - start[0]
        return None, self.number(0.0) if self.problem.symmetric else None, end[0] - start[0]

    def least_values(self) -> dict[str, Number]:
        """Lower bounds of the objective's constants and maxima.

        The mean of c is the change of the velocity, which c exceeds somewhere, and is below somewhere; where the order
        leaves it free, what is less at a change of either sign may be anything.
        """
        objective, (_, change, _) = self.problem.objective, self.ends
        terms = [*(leaf for _, leaf in leaves(objective)), *maxima(objective)]
        if change is not None:
            return {repr(term): self._least(term, change) for term in terms}
        still = {term: self._least(term, self.number(0.0)) for term in terms}
        falling = {term for term in terms if min(self._least(term, change) for change in (1.0, -1.0)) < still[term]}
        return {repr(term): -inf if term in falling else low for term, low in still.items()}

    def _least(self, term: Term, change: Number) -> Number:
        """A lower bound of a term in laws whose velocity changes by `change`."""
        if isinstance(term, Maximum):
            parts = ([self.number(w) * self._least(inner, change) for w, inner in part.terms] for part in term.parts)
            return max(sum(part, self.number(0.0)) for part in parts)
        if isinstance(term, PeakConstant) and len(term.signs) == 1:
            return self.number(term.signs[0]) * change if term.nu == _ACCELERATION else -inf
        return self.floor(term) if isinstance(term, Functional) else self.number(0.0)

    def greatest_values(self, claim: Number) -> dict[str, Number]:
        """Upper bounds of the objective's constants, of bounded ones, and of the program's own variables."""
        problem, greatest = self.problem, dict[str, Number]()
        if VariableName.VIOLATION in self.variables:
            greatest[VariableName.VIOLATION] = self.number(0.0)
        else:
            spread(problem.objective, claim, greatest, self.least_values(), self.number)
        for name in ("B", *(constant.name for constant, _ in problem.bounded)):
            limits = problem.range(name)
            if limits is not None:
                greatest[name] = min(greatest.get(name, inf), self.number(limits.high))
        power = relaxed_power(problem)
        if power is not None and VariableName.POWER_ROOT in self.variables and power.name in greatest:
            greatest[VariableName.POWER_ROOT] = self.root(greatest[power.name])
        if "B" in self.variables and not isfinite(greatest.get("B", inf)):
            greatest["B"] = self.greatest_velocity(greatest)
        return greatest

    def greatest_velocity(self, greatest: Mapping[str, Number]) -> Number:
        """A bound of |b|: it is nowhere further from b(0), nor from its mean, the stroke, than the integral of |c|.

        As c is nowhere further from its mean than the integral of |j|.
        """
        known, (start, change, stroke) = self.means(greatest), self.ends
        swing = known.get(2, inf)
        if 3 in known and change is not None:
            swing = min(swing, known[3] + abs(change))
        return min(abs(stroke), inf if start is None else abs(start)) + swing

    def means(self, greatest: Mapping[str, Number]) -> dict[int, Number]:
        """Bounds of the integral of a derivative's magnitude, by order of derivative, in every such law."""
        start, change, stroke = self.ends
        # a peak of one side may be below 0: then nothing is above
        sizes = {name: max(most, self.number(0.0)) for name, most in greatest.items() if isfinite(most)}
        plain = ((2, "C"), (2, "rms_c"), (3, "J"), (3, "rms_j"), (4, "snap"))
        known = [(nu, sizes[name]) for nu, name in plain if name in sizes]
        if change is not None:
            # what is above 0 less what is below is the change, and one of them is at most the peak
            sides = (("C_plus", change), ("C_minus", -change))
            known += [(2, 2 * sizes[name] - turn) for name, turn in sides if name in sizes]
        elif sizes.keys() >= {"C_plus", "C_minus"}:
            known.append((2, max(sizes["C_plus"], sizes["C_minus"])))
        if "D" in sizes and start == 0:
            # b² <= 2 D k from rest
            known.append((1, self.root(sizes["D"])))
        if "B" in sizes:
            known.append((1, 2 * sizes["B"] - stroke))
        if self.problem.monotone:
            known.append((1, abs(stroke)))
        for constant in self.problem.constants:
            if constant.name in sizes:
                size = sizes[constant.name]
                size = self.root(size) if isinstance(constant, PowerConstant) else size
                known += [(nu, factor * size + offset) for nu, factor, offset in self.sizes(constant)]
        least: dict[int, Number] = {}
        for nu, mean in known:
            if isfinite(mean):
                least[nu] = min(least.get(nu, inf), mean)
        return least

    def means_by(self, name: str) -> Iterator[tuple[int, Number, Number]]:
        """Orders of derivatives whose mean a constant bounds in proportion: with the bound at 0, and how fast it grows.

        Of several bounds the least is nowhere above a line that it touches at three places.
        """
        none, some, more = (self.means({name: self.number(times)}) for times in (0.0, 1.0, 2.0))
        for nu in none.keys() & some.keys() & more.keys():
            growth = some[nu] - none[nu]
            if more[nu] - some[nu] == growth:
                yield nu, none[nu], growth


def spread(
    expression: Expression,
    claim: Number,
    greatest: dict[str, Number],
    least: Mapping[str, Number],
    number: Callable[[float], Number] = float,
) -> None:
    """Record in `greatest` the upper bounds of an expression's terms, from its value below the claim."""
    lowest = [number(weight) * least[repr(term)] for weight, term in expression.terms]
    for i, (weight, term) in enumerate(expression.terms):
        name, others = repr(term), sum([*lowest[:i], *lowest[i + 1 :]], number(0.0))
        most = max((claim - others) / number(weight), least[name])
        greatest[name] = min(greatest.get(name, inf), most)
        if isinstance(term, Maximum):
            for part in term.parts:
                spread(part, most, greatest, least, number)


def moments(model: Model, greatest: Mapping[str, Number]) -> list[tuple[Array, Array]]:
    """Bounds of the moments of a derivative relative to the base law's, one for each known constant.

    Beside each the matrix from a functional's values on the free functions to weights of these moments.
    """
    space = model.space
    known = Sublevel.of(model).means(greatest).items()
    return [(float(mean) + _base_moments(space, nu), _extension(space, nu)) for nu, mean in known]


def _base_moments(space: LawSpace, nu: int) -> Array:
    """Magnitudes of the base law's moments, to which the coordinates' moments are added."""

    def computed() -> Array:
        rule = space.quadrature(nu)
        return np.asarray(np.abs(rule.moments.T @ (rule.weights * rule.values[:, -1])), dtype=np.float64)

    return space.cached(("moments", nu), computed)


def _extension(space: LawSpace, nu: int) -> Array:
    """Matrix from a functional's values on the free functions to weights of moments of the derivative of order nu.

    A moment is the integral of the derivative times a function that is nowhere above 1 in magnitude, so at most its
    mean magnitude; for polynomials these are Legendre's.
    """

    def computed() -> Array:
        rule = space.quadrature(nu)
        moments = rule.moments.T @ (rule.weights[:, None] * rule.values[:, :-1])
        functions, sizes, weights = np.linalg.svd(moments.T, full_matrices=False)
        # what has no such derivative would be told from it by rounding alone
        sizes = sizes[: max(len(moments.T) - space.vanishing(nu), 0)]
        sizes = sizes[sizes > _SUBLEVEL_RANK * sizes.max(initial=0.0)]
        return np.asarray(weights[: len(sizes)].T @ (functions[:, : len(sizes)] / sizes).T, dtype=np.float64)

    return space.cached(("extension", nu), computed)


_IN_A_ROW = 9  # roundings in a row before it is weighted
_SQUARED = 2.0**-20  # of a rounding: more than products of roundings are

#: a multiplier, a row and its right side
Line = tuple[float, Array, float]

_FACING = {"C_plus": "C_minus", "C_minus": "C_plus"}
#: bounds of the variables above and below, and those of moments with their matrices
AprioriBounds = tuple[dict[str, float], dict[str, float], list[tuple[Array, Array]]]


def lines_of(program: Program, leaf: Leaf) -> list[Line]:
    """Contacts and the program's equations as weights, rows and right sides; negative multipliers of contacts are 0."""
    lines = [(max(contact.multiplier, 0.0), *row_of(program, contact)) for contact in leaf.contacts]
    weights = program.multipliers_of_equations(leaf.equations).tolist()
    return [*lines, *zip(weights, program.equalities, program.right.tolist(), strict=False)]


def row_of(program: Program, contact: Contact) -> tuple[Array, float]:
    """The row of a contact and its right side: row . x <= right for every law of the problem.

    It is the problem's own row, in the program's variables and in units of its objective.
    """
    for family in program.families:
        if family.name != contact.constraint or contact.sign not in family.signs:
            continue
        share = family.unit / program.unit
        u = np.clip(family.u(np.array([contact.k])), *family.domain)
        if isinstance(family, LinearFamily):
            rows, right = family.rows(u, np.array([contact.sign]))
            return rows[0] * share, float(right[0]) * share
        row = _tangent(program, family, contact, u)
        if row is not None:
            return share * (row[:-1] - family.slack), share * (family.bound - float(row[-1]))
    return np.zeros(program.size), 0.0


def _tangent(program: Program, family: ConstraintFamily, contact: Contact, u: Array) -> Array | None:
    """A row below a nonlinear family, by the contact's direction; None where it has no meaning."""
    if isinstance(family, NormFamily) and len(contact.direction) == len(family.matrix):
        return _at_most_one(contact.direction) @ family.matrix
    if isinstance(family, ConeFamily) and len(contact.direction) == 2:
        return family.tangent(float(u[0]), _at_most_one(contact.direction))
    if isinstance(family, FormulaFamily):
        return family.tangent_row(float(u[0]), contact.sign, contact.direction)
    if isinstance(family, EnergyFamily) and family.convex and len(contact.direction) <= program.size:
        return family.minorant(_on_equations(program, np.array(contact.direction)))
    return None


def _at_most_one(direction: Sequence[float]) -> Array:
    """A direction of length at most 1, as a bound of a norm needs; a direction that overflows becomes 0."""
    given = np.array(direction)
    with np.errstate(over="ignore"):
        return np.asarray(given / max(float(np.linalg.norm(given)), 1.0))


def _on_equations(program: Program, coordinates: Array) -> Array:
    """Variables with these coordinates, or the nearest that keep the program's equations."""
    x = np.zeros(program.size)
    x[: len(coordinates)] = coordinates
    for _ in range(2):
        off = program.right - program.equalities @ x
        x += np.linalg.lstsq(program.equalities, off, rcond=None)[0]
    return x


def sum_of_rows(model: Model, lines: list[Line], claim: float | None = None) -> float:
    """A lower bound of the program's objective by weighted rows, in laws with an objective up to the claim.

    Parameters
    ----------
    model
        The program, with the problem whose laws are spoken of.
    lines
        Weights, rows and right sides of row . x <= right (weights of at least 0) or row . x = right (of any sign).
    claim
        Without it what the sum itself says.
    """
    total = sum_of_lines(model, lines)
    most = model.unit * float(total.value[0]) if claim is None else claim
    below = bounds_below(model, most)
    return float((total.value - total.hidden - charge(model, below, total.slope, total.blur))[0])


def sum_of_lines(model: Model, lines: list[Line]) -> RowSums:
    """The objective and the weighted rows of one law, added up."""
    weights = np.array([weight for weight, _, _ in lines])[None]
    rows = np.array([[*row, -right] for _, row, right in lines]).reshape(1, -1, model.program.size + 1)
    return summed(model.program.objective[None], weights, rows, np.abs(rows))


class RowSums(NamedTuple):
    """Sums of weighted rows, one for each law: slopes by the variables and values, each with what rounding hides."""

    slope: Array
    blur: Array
    value: Array
    hidden: Array


def summed(cost: Array, weights: Array, rows: Array, sizes: Array) -> RowSums:
    """The cost and the weighted rows of each law, added up.

    Parameters
    ----------
    cost
        What is minimised, shape (laws, variables), or one for all.
    weights, rows
        Shapes (laws, rows) and (laws, rows, variables + 1), with the opposites of the right sides last.
    sizes
        How great the rows' entries may be.
    """
    start = np.concatenate([cost, np.zeros((len(cost), 1))], axis=1)
    total = start + weighted(weights, rows)
    hidden = roundings(rows.shape[1]) * (weighted(np.abs(weights), sizes) + np.abs(start))
    return RowSums(total[:, :-1], hidden[:, :-1], total[:, -1], hidden[:, -1])


def weighted(weights: Array, rows: Array) -> Array:
    """The sum of the rows of each law, weighted."""
    return np.asarray(np.matmul(weights[:, None, :], rows)[:, 0])


def roundings(count: int) -> float:
    """What rounding hides of a start and so many weighted rows, as a share of the sum of magnitudes.

    Each is rounded as a product once, and in as many additions as there are rows.
    """
    return ROUNDOFF * (_IN_A_ROW + 1 + count + _SQUARED)


def bounds_below(model: Model, claim: float) -> AprioriBounds:
    """A priori bounds of the variables, above and below, and of the coordinates, in laws below a claim."""
    return bounds_within(model, Sublevel.of(model).greatest_values(max(claim, 0.0)))


def bounds_within(model: Model, greatest: dict[str, float]) -> AprioriBounds:
    """The same of laws whose constants are bounded from above."""
    scales = model.in_scales
    return scales(greatest), scales(Sublevel.of(model).least_values()), moments(model, greatest)


def charge(model: Model, below: AprioriBounds, slope: Array, blur: Array) -> Array:
    """The most by which slopes, and what rounding hides of them, lower sums in laws with known a priori bounds."""
    greatest, least, sizes = below
    terms, beyond = model.space.terms, np.zeros(len(slope))
    for name, place in model.places.items():
        share, unknown = slope[:, place], blur[:, place]
        # of the two one-sided peaks one is at least the other's opposite
        low = max(min(-least.get(name, 0.0), greatest.get(_FACING.get(name, ""), inf)), 0.0)
        for pull, most in ((unknown - share, greatest.get(name, inf)), (unknown + share, low)):
            beyond += np.where(pull > 0.0, pull, 0.0) * most if isfinite(most) else np.where(pull > 0.0, inf, 0.0)
    reaches = [
        (np.abs(slope[:, :terms] @ extension.T) + blur[:, :terms] @ np.abs(extension).T) @ most
        for most, extension in sizes
    ]
    free = np.where((slope[:, :terms] != 0.0).any(axis=1) | (blur[:, :terms] != 0.0).any(axis=1), inf, 0.0)
    return np.asarray(beyond + (np.min(reaches, axis=0) if reaches else free))
