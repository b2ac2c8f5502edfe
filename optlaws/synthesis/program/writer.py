"""Problem -> semi-infinite program: which variables, which rows, which equations."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from math import isfinite, nextafter

import numpy as np
from numpy.typing import NDArray

from optlaws.synthesis.families.family import Family, LinearFamily, Program
from optlaws.synthesis.problem.constants import B, Functional, Power
from optlaws.synthesis.problem.expression import Expression, Maximum, leaves
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.problem.ranges import Range
from optlaws.synthesis.problem.windows import Window
from optlaws.synthesis.spaces.of_basis import space_of
from optlaws.synthesis.spaces.space import LawSpace

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Model:
    """A program with the space it is written over and the places of its variables beyond the coordinates.

    `places` has the variables that bound the objective's constants from above, by their names, those of maxima, and
    "B" where the peak velocity that is asked is a variable. `equation_names` says what each equation is; the
    program's objective is the problem's divided by `unit`.
    """

    space: LawSpace
    program: Program
    places: dict[str, int]
    equation_names: tuple[str, ...]
    unit: float = 1.0


def model(problem: Problem) -> Model:
    """The program of a problem. Built once per shape: a fixed B only enters the right side of an equation."""
    if isinstance(problem.B, float):
        shape = _model(problem.shape)
        right = shape.program.right.copy()
        right[0] += problem.B - 2.0
        return replace(shape, program=replace(shape.program, right=right))
    return _model(problem)


ROOT = "root of D"
_REST = 1e-15
_ABOVE_MEAN = nextafter(1.0, 2.0)
_ANY = 2.0
_LEAST_WEIGHT, _GREATEST_WEIGHT = 1e-3, 1e3
_SIDES = {1.0: "above", -1.0: "below"}


@lru_cache(maxsize=256)
def _model(problem: Problem) -> Model:
    space = _space(problem)
    names = [repr(leaf) for _, leaf in leaves(problem.objective)]
    names += [repr(term) for term in maxima(problem.objective)]
    writer = _Writer(space, names, problem)
    writer.objective(problem.objective)
    writer.constraints(problem)
    return writer.model()


def relaxed(problem: Problem, tangent: float) -> Model:
    """A convex program whose least value bounds that of a problem with D from below.

    From (b²/2)' = d follows b² <= 2 D min(k, 1-k). With r for the root of D that is b <= r sqrt(2k), linear; and
    D >= r² >= 2 t r - t² for any t, best where the tangent t is the root of D itself.
    """
    return _relaxed(problem, tangent)


@lru_cache(maxsize=64)
def _relaxed(problem: Problem, tangent: float) -> Model:
    names = [repr(leaf) for _, leaf in leaves(problem.objective)]
    names += [repr(term) for term in maxima(problem.objective)]
    writer = _Writer(_space(problem), names, problem, extra=ROOT)
    writer.tangent = tangent
    writer.objective(problem.objective)
    writer.constraints(problem)
    return writer.model()


def relaxed_power(problem: Problem) -> Power | None:
    """The power that the relaxed program bounds; of several the first by name, the others are left out."""
    powers = sorted((one for one in problem.constants if isinstance(one, Power)), key=lambda one: one.name)
    return powers[0] if powers else None


def least_violation(problem: Problem) -> Model:
    """Minimise t so that every constraint holds but for t: above 0 if and only if they contradict."""
    writer = _Writer(_space(problem), [], problem, extra="t")
    writer.spare = writer.unit("t")
    writer.cost = writer.unit("t")
    # laws with no bound to their size may have any room to spare; more than this is none of our business
    writer.row("to spare", -writer.unit("t"), 1.0)
    writer.constraints(problem)
    return writer.model()


def extreme_velocity(problem: Problem, *, greatest: bool) -> Model:
    """The least or the greatest B for which the constraints do not contradict; B is a variable.

    The peak is where a fixed B puts it. Where that is nowhere, there is no greatest B.
    """
    placed = replace(problem, B=_ANY).peak_at
    free = replace(problem, B=Range(low=_ABOVE_MEAN), inflexion=placed)
    writer = _Writer(_space(problem), ["B"], free)
    writer.cost = writer.unit("B", -1.0 if greatest else 1.0)
    if free.peak_at is None:
        writer.families += B.families(writer.space, writer.unit("B"), 0.0)
    writer.constraints(free)
    return writer.model()


def _space(problem: Problem) -> LawSpace:
    return space_of(problem.basis, problem.conditions, symmetric=problem.symmetric)


def maxima(expression: Expression) -> list[Maximum]:
    """The maxima of an expression, those within parts of others too."""
    found = []
    for _, term in expression.terms:
        if isinstance(term, Maximum):
            found.append(term)
            for part in term.parts:
                found += maxima(part)
    return found


class _Writer:
    def __init__(self, space: LawSpace, names: list[str], problem: Problem, extra: str | None = None) -> None:
        if problem.peak_is_variable:
            names = [*names, "B"]
        if extra is not None:
            names = [*names, extra]
        self.space, self.conditions, self.power = space, problem.conditions, relaxed_power(problem)
        self.places = {name: space.terms + i for i, name in enumerate(dict.fromkeys(names))}
        self.size = space.terms + len(self.places)
        self.spare = np.zeros(self.size)
        self.cost = np.zeros(self.size)
        self.tangent = 0.0
        self.cost_unit = 1.0
        self.families: list[Family] = []
        self.equalities: list[Array] = []
        self.right: list[float] = []
        self.equation_names: list[str] = []

    def unit(self, name: str, weight: float = 1.0) -> Array:
        row = np.zeros(self.size)
        row[self.places[name]] = weight
        return row

    def sum(self, expression: Expression) -> Array:
        return np.asarray(sum(self.unit(repr(term), weight) for weight, term in expression.terms))

    def objective(self, expression: Expression) -> None:
        self.cost = self.sum(expression)
        size = float(self.cost.max())
        if not _LEAST_WEIGHT < size < _GREATEST_WEIGHT:
            # tolerances are made for objectives near 1
            self.cost /= size
            self.cost_unit = size
        for leaf in dict.fromkeys(leaf for _, leaf in leaves(expression)):
            if isinstance(leaf, Power) and ROOT in self.places:
                self._power(leaf, self.unit(leaf.name), 0.0)
            elif isinstance(leaf, Functional):
                self.families += leaf.families(self.space, self.unit(repr(leaf)), 0.0)
        for term in dict.fromkeys(maxima(expression)):
            for i, part in enumerate(term.parts, 1):
                self.row(f"part {i} of {term!r}", self.sum(part) - self.unit(repr(term)), 0.0)

    def row(self, name: str, row: Array, bound: float) -> None:
        """One row, row . x <= bound."""
        series = np.append(row, 0.0)[None, :]
        self.families.append(LinearFamily(name, self.spare, bound, (1.0,), (1.0, 1.0), series=series))

    def constraints(self, problem: Problem) -> None:
        self._peak(problem)
        wanted = problem.range("B")
        if wanted is not None:
            self._velocity(wanted, problem)
        if problem.monotone:
            self.families.append(self.space.forward(self.spare))
        for constant, asked in problem.bounded:
            self._bounded(constant, asked)
        for one in self.space.equations():
            row = np.zeros(self.size)
            row[: self.space.terms] = one.row
            self.equation(row, one.right, one.name)
        for i, window in enumerate(problem.windows, 1):
            parts = window.first_half() if problem.symmetric else (window,)
            for part, side in zip(parts, ("", " mirrored"), strict=False):
                self._window(f"window {i}{side}", part)

    def _peak(self, problem: Problem) -> None:
        """What makes b greatest at one k, and B its value there."""
        wanted, peak = problem.range("B"), problem.peak_at
        fixed = wanted is not None and wanted.fixed
        if wanted is not None and fixed and not problem.symmetric:
            self.equation(self.unit("B"), wanted.high)
        if peak is None:
            return
        at = "1/2" if peak == 0.5 else f"{peak:g}"
        self.families.append(self.space.below(self.spare, peak))
        if wanted is not None and fixed and problem.symmetric:
            self._value(1, wanted.high, "", f"b({at}) = B", peak)
        elif problem.peak_is_variable:
            self._value(1, 0.0, "B", f"b({at}) = B", peak)
        if not problem.symmetric:
            self._value(2, 0.0, "", f"c({at}) = 0", peak)

    def _velocity(self, wanted: Range, problem: Problem) -> None:
        """Rows |b| <= B, but for what others say already, and the bounds of B."""
        if not problem.peak_is_variable and not wanted.fixed:
            self._bounded(B, wanted)
            return
        slack, bound = (self.unit("B"), 0.0) if problem.peak_is_variable else self._middle()
        if problem.peak_at is None:
            signs = (1.0,) if problem.monotone else (1.0, -1.0)
            self.families.append(self.space.derivative(1, "b", slack + self.spare, bound, signs))
        elif not problem.monotone:
            self.families.append(self.space.backward(slack + self.spare, bound))
        if not wanted.fixed:
            if isfinite(wanted.high):
                self.row("B at most", self.unit("B"), wanted.high)
            self.row("B at least", -self.unit("B"), -wanted.low)

    def _middle(self) -> tuple[Array, float]:
        """b(1/2) as a row and its constant part: a fixed B of symmetric laws, whatever its value."""
        row = self.space.widened(self.space.row(1, 0.5)[None, :], self.size)[0]
        return row[:-1], float(row[-1])

    def _value(self, nu: int, right: float, variable: str, name: str, k: float) -> None:
        """The derivative of order nu at k is `right`, or the variable."""
        *free, base = self.space.row(nu, k).tolist()
        row = np.zeros(self.size)
        row[: self.space.terms] = free
        if variable:
            row -= self.unit(variable)
        self.equation(row, right - base, name)

    def _bounded(self, constant: Functional, wanted: Range) -> None:
        name = constant.name
        if name in self.places and wanted.low > 0.0:
            # its own constant is a law's best choice of the variable
            self.row(f"{name} at least", -self.unit(name), -wanted.low)
        if not isfinite(wanted.high):
            return
        if name in self.places:
            self.row(f"{name} at most", self.unit(name), wanted.high)
        elif isinstance(constant, Power) and ROOT in self.places:
            self._power(constant, np.zeros(self.size), wanted.high)
        else:
            self.families += constant.families(self.space, self.spare, wanted.high)

    def _window(self, name: str, window: Window) -> None:
        ends = (1.0 - 2.0 * window.stop, 1.0 - 2.0 * window.start)
        if window.value:
            row = self.space.widened(self.space.row(window.order, window.start)[None, :], self.size)[0]
            self.equation(row[:-1], window.high - float(row[-1]), repr(window))
            return
        for sign, bound in ((1.0, window.high), (-1.0, -window.low)):
            if isfinite(bound):
                family = self.space.derivative(window.order, f"{name}, {_SIDES[sign]}", self.spare, bound, (sign,))
                self.families.append(replace(family, domain=ends))

    def _power(self, power: Power, slack: Array, bound: float) -> None:
        """Rows b <= r sqrt(2k), b >= -r sqrt(2k) from either end, and 2 t r - t² <= D."""
        if self.conditions.order == 1 or power != self.power:
            if power != self.power and slack.any():
                self.row(f"{power.name} at least", -slack, 0.0)
            return
        weights = tuple(map(float, power.weights))
        root, end_velocity = self.unit(ROOT), self.space.start_velocity + self.space.velocity_change
        # each row counts on rest at its end
        if self.space.start_velocity == 0.0:
            self.families.append(self.space.from_rest("b / sqrt(2k)", root, weights=weights))
        if self.space.symmetric and any(weights[1::2]):
            facing = tuple(-w if i % 2 else w for i, w in enumerate(weights))
            self.families.append(self.space.from_rest("b / sqrt(2 - 2k)", root, weights=facing))
        if not self.space.symmetric and abs(end_velocity) < _REST:
            self.families.append(self.space.from_rest("b / sqrt(2 - 2k)", root, backward=True, weights=weights))
        self.row("tangent", 2.0 * self.tangent * root - slack, bound + self.tangent**2)

    def equation(self, row: Array, right: float, name: str = "b(1/2) = B") -> None:
        self.equation_names.append(name)
        self.equalities.append(row)
        self.right.append(right)

    def model(self) -> Model:
        equalities = np.array(self.equalities).reshape(-1, self.size)
        program = Program(tuple(self.families), equalities, np.array(self.right), self.cost)
        return Model(self.space, program, self.places, tuple(self.equation_names), self.cost_unit)
