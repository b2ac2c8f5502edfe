"""Problem -> semi-infinite program: which variables, which rows, which equations; and a law's own values of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import lru_cache
from math import inf, isfinite, nextafter
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from optlaws.errors import InputError
from optlaws.formulas.of_motion import MotionFormula
from optlaws.laws import MotionLaw
from optlaws.numbers import Array
from optlaws.synthesis.families import names
from optlaws.synthesis.families.family import ConstraintFamily, LinearFamily, Program
from optlaws.synthesis.families.names import RowName, VariableName
from optlaws.synthesis.families.piece_series import widened
from optlaws.synthesis.problem.constants import B, Functional, PowerConstant, facing, floats
from optlaws.synthesis.problem.expression import Expression, Maximum, Term, leaves
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.problem.ranges import Range
from optlaws.synthesis.problem.windows import Window
from optlaws.synthesis.spaces.of_basis import space_of
from optlaws.synthesis.spaces.space import LawSpace
from optlaws.tolerances import BESIDE_BREAK, BOUND_FEASIBILITY

if TYPE_CHECKING:
    from optlaws.synthesis.spaces.space import LawSpace

_ROWS_AGREE = 1e-5  # of a value: what rows and values computed in different ways may be apart
_BOUND_SHORT = 1e-9  # of a lower bound: a constant that is short by more is too small

#: along how many laws the rows of a user's class are compared with its values
_LAWS = 3


@dataclass(frozen=True)
class LawEvaluation:
    """The objective of a law, and its greatest violation of a constraint, relative to the constraint's bound."""

    objective: float
    excess: float

    @property
    def sound(self) -> bool:
        """Whether the law keeps its constraints and its objective is a number."""
        return self.excess <= BOUND_FEASIBILITY and isfinite(self.objective)


def evaluate(problem: Problem, law: MotionLaw) -> LawEvaluation:
    """Objective and greatest excess over the constraints."""
    values: dict[str, float] = {}
    objective = _total(problem.objective, law, values)
    excess = _velocity_excess(problem, law)
    for constant, limits in problem.bounded:
        if isfinite(limits.high):
            value = values[constant.name] if constant.name in values else constant.value(law)
            excess = max(excess, value / limits.high - 1.0)
    for window in problem.windows:
        excess = max(excess, *_window_excess(window, law))
    return LawEvaluation(objective, excess)


def _window_excess(window: Window, law: MotionLaw) -> tuple[float, float]:
    """Excess of a law above and below a window, in units of its scale."""
    if window.motion is None:
        # what the law has beyond breaks where the window begins and ends says nothing of the window
        off, inner = 0.0 if window.value else BESIDE_BREAK / 2.0, law.breaks[1:-1]
        start, stop = window.start + off * (window.start in inner), window.stop - off * (window.stop in inner)
        lowest, highest = law.extrema(window.nu, within=(start, stop))
        return highest.value - window.high, window.low - lowest.value
    from optlaws.synthesis.functionals.kinds import greatest_along

    bounds = ((1.0, window.high), (-1.0, -window.low))
    above, below = (
        greatest_along(window.motion, sign, law) - bound if isfinite(bound) else -inf for sign, bound in bounds
    )
    return above / window.scale, below / window.scale


def _velocity_excess(problem: Problem, law: MotionLaw) -> float:
    velocity, peak = problem.range("B"), problem.peak_at
    if velocity is None and peak is None and not problem.monotone:
        return 0.0
    lowest, highest = law.extrema(1)
    greatest = max(highest.value, -lowest.value)
    excess = max(-lowest.value, 0.0) if problem.monotone else 0.0
    if velocity is not None and isfinite(velocity.high):
        excess = max(excess, greatest / velocity.high - 1.0)
    if peak is not None:
        # b at the peak may be 0 or negative: what is above it is measured by the law's speed
        at_peak = float(law.b(peak))
        excess = max(excess, (highest.value - at_peak) / max(greatest, 1.0))
        if velocity is not None and velocity.low > 0.0:
            excess = max(excess, 1.0 - at_peak / velocity.low, (greatest - at_peak) / max(greatest, 1.0))
    return excess


def shortfalls(problem: Problem, law: MotionLaw) -> dict[Functional, float]:
    """Constants below their lower bound, with that bound: rows limit a peak from above only."""
    # where the place of the peak is prescribed, rows bound it from below
    velocity = problem.range("B") if problem.peak_at is None else None
    ranges = [*problem.bounded, *([] if velocity is None else [(B, velocity)])]
    return {
        constant: limits.low
        for constant, limits in ranges
        if limits.low > 0.0 and not reaches(law, constant, limits.low)
    }


def reaches(law: MotionLaw, constant: Functional, low: float) -> bool:
    """Whether a constant of a law is at least its lower bound, up to rounding."""
    return constant.value(law) >= low * (1.0 - _BOUND_SHORT)


def _total(expression: Expression, law: MotionLaw, values: dict[str, float]) -> float:
    total = 0.0
    for weight, term in expression.terms:
        if isinstance(term, Maximum):
            total += weight * max(_total(part, law, values) for part in term.parts)
        elif isinstance(term, Functional):
            if term.name not in values:
                values[term.name] = term.value(law)
            total += weight * values[term.name]
    return total


def check_rows(constant: Functional, space: LawSpace) -> None:
    """Refuse a user's class whose rows contradict its value: its laws and bounds could not be trusted."""
    if not type(constant).__module__.startswith("optlaws."):
        _check(constant, space)


@lru_cache(maxsize=128)
def _check(constant: Functional, space: LawSpace) -> None:
    families = constant.families(space, np.zeros(space.terms), 0.0)
    numbers = np.random.default_rng(0)
    for size in range(_LAWS):
        x = 0.3 * size * numbers.normal(size=space.terms)
        rows = max(float(family.extremes(x)[2].max()) for family in families)
        value = constant.value(space.law(x))
        # what is the same for every law, such as the rounding of a peak of nothing, says nothing
        if abs(rows - value) > _ROWS_AGREE * max(abs(rows), abs(value)) and max(abs(rows), abs(value)) > _ROWS_AGREE:
            kind = type(constant).__name__
            raise InputError(
                f"{kind}.families and {kind}.value contradict each other: of a law the rows ask {constant.name} = "
                f"{rows:.7g}, its value is {value:.7g}. Rows must hold if and only if the value is at most "
                "slack . x + bound"
            )


_REST_VELOCITY = 1e-15  # a velocity at an end that is less is rest


@dataclass(frozen=True, eq=False)
class Model:
    """The program of a problem, over the coordinates of a linear space of laws and variables beyond them."""

    problem: Problem
    space: LawSpace
    program: Program
    #: the variables beyond the coordinates by their names: those that bound the objective's constants and maxima from
    #: above, and "B" where the peak velocity is a variable
    places: dict[str, int]
    equation_names: tuple[str, ...]
    #: what these variables have been divided by, powers of 2 by name, so that they are near 1
    scales: Mapping[str, float] = field(default_factory=dict)

    @property
    def unit(self) -> float:
        """The factor from the program's objective to the problem's objective."""
        return self.program.unit

    @property
    def variable_scales(self) -> Array:
        """Units of the program's variables."""
        scales = np.ones(self.program.size)
        for name, place in self.places.items():
            scales[place] = self.scales.get(name, 1.0)
        return scales

    def in_scales(self, bounds: Mapping[str, float]) -> dict[str, float]:
        """Numbers by the names of variables as the program has them."""
        return {name: value / self.scales.get(name, 1.0) for name, value in bounds.items()}

    def coordinates(self, x: Array) -> Array:
        """The coordinates of a law among all the program's variables."""
        return x[: self.space.terms]

    def law(self, x: Array) -> MotionLaw:
        """The law that the program's variables describe."""
        return self.space.law(self.coordinates(x))


def model_of(problem: Problem, *, scaled: bool = True) -> Model:
    """The program of a problem. Built once per shape: a fixed B only enters the right side of an equation.

    Its objective, rows and variables are divided by what they are in smooth laws, unless it is to be as it is written.
    """
    if isinstance(problem.B, float):
        shape = _model(problem.shape, scaled=scaled)
        right = shape.program.right.copy()
        right[0] += problem.B - 2.0
        return replace(shape, problem=problem, program=replace(shape.program, right=right))
    return replace(_model(problem, scaled=scaled), problem=problem)


_ABOVE_MEAN = nextafter(1.0, 2.0)
_ANY = 2.0


@lru_cache(maxsize=256)
def _model(problem: Problem, *, scaled: bool) -> Model:
    writer = _Writer(problem, _objective_names(problem), scaled=scaled)
    writer.objective(problem.objective)
    return writer.model()


def relaxed(problem: Problem, tangent: float) -> Model:
    """A convex program whose least value is a lower bound for a problem with D.

    From (b²/2)' = d follows b² <= 2 D min(k, 1-k). With r for the root of D that is b <= r sqrt(2k), linear; and
    D >= r² >= 2 t r - t² for any t, best where the tangent t is the root of D itself.
    """
    return replace(_relaxed(problem, tangent), problem=problem)


@lru_cache(maxsize=64)
def _relaxed(problem: Problem, tangent: float) -> Model:
    powers = relaxed_power(problem) is not None
    writer = _Writer(problem, _objective_names(problem), extra=VariableName.POWER_ROOT if powers else None)
    writer.tangent, writer.convex = tangent, True
    writer.objective(problem.objective)
    return writer.model()


def _objective_terms(expression: Expression) -> tuple[list[Term], list[Maximum]]:
    """The constants and the maxima in an objective, without duplicates, in its order."""
    return list(dict.fromkeys(leaf for _, leaf in leaves(expression))), list(dict.fromkeys(maxima(expression)))


def _objective_names(problem: Problem) -> list[str]:
    return [repr(term) for terms in _objective_terms(problem.objective) for term in terms]


def relaxed_power(problem: Problem) -> PowerConstant | None:
    """The power that the relaxed program bounds; of several the first by name, the others are left out."""
    powers = (constant for constant in problem.constants if isinstance(constant, PowerConstant))
    return min(powers, key=lambda power: power.name, default=None)


def least_violation(problem: Problem) -> Model:
    """Minimise t so that every constraint holds up to t: it is positive if and only if they contradict each other."""
    writer = _Writer(problem, [], extra=VariableName.VIOLATION)
    writer.spare = writer.cost = writer.unit(VariableName.VIOLATION)
    # laws with no bound to their size may have any room to spare; more than this is none of our business
    writer.row(RowName.TO_SPARE, -writer.unit(VariableName.VIOLATION), 1.0)
    return writer.model()


def extreme_velocity(problem: Problem, *, greatest: bool) -> Model:
    """The least or the greatest B for which the constraints do not contradict; B is a variable.

    The peak is where a fixed B puts it. Where that is nowhere, there is no greatest B.
    """
    placed = replace(problem, B=_ANY).peak_at
    free = replace(problem, B=Range(low=_ABOVE_MEAN), inflexion=placed)
    writer = _Writer(free, ["B"])
    writer.cost = writer.unit("B", -1.0 if greatest else 1.0)
    if free.peak_at is None:
        writer.families += B.families(writer.space, writer.unit("B"), 0.0)
    return writer.model()


def maxima(expression: Expression) -> list[Maximum]:
    """The maxima of an expression, those within parts of others too."""
    inner: list[Maximum] = []
    for _, term in expression.terms:
        if isinstance(term, Maximum):
            inner.append(term)
            for part in term.parts:
                inner += maxima(part)
    return inner


class _Equation(NamedTuple):
    """Row . x = right, both divided by the unit."""

    name: str
    row: Array
    right: float
    unit: float


class _Writer:
    def __init__(
        self, problem: Problem, variables: list[str], extra: str | None = None, *, scaled: bool = True
    ) -> None:
        variables = [*variables, *(["B"] if problem.peak_is_variable else []), *([] if extra is None else [extra])]
        self.problem, self.power, self.scaled = problem, relaxed_power(problem), scaled
        self.scales: dict[str, float] = {}
        self.convex = False
        self.space = space_of(problem.basis, problem.conditions, symmetric=problem.symmetric)
        self.places = {name: self.space.terms + i for i, name in enumerate(dict.fromkeys(variables))}
        self.size = self.space.terms + len(self.places)
        self.spare = np.zeros(self.size)
        self.cost = np.zeros(self.size)
        self.tangent = 0.0
        self.cost_unit = 1.0
        self.families: list[ConstraintFamily] = []
        self.equations: list[_Equation] = []

    def scale(self, of: Term | Expression | Window) -> float:
        """Units of rows and variables."""
        return of.scale if self.scaled else 1.0

    def unit(self, name: str, weight: float = 1.0) -> Array:
        row = np.zeros(self.size)
        row[self.places[name]] = weight
        return row

    def sum(self, expression: Expression) -> Array:
        return np.asarray(sum(self.unit(repr(term), weight * self.scale(term)) for weight, term in expression.terms))

    def objective(self, expression: Expression) -> None:
        constants, greatest = _objective_terms(expression)
        self.scales = {repr(term): self.scale(term) for term in (*constants, *greatest)}
        self.cost_unit = self.scale(expression)
        self.cost = self.sum(expression) / self.cost_unit
        for leaf in constants:
            if isinstance(leaf, PowerConstant) and VariableName.POWER_ROOT in self.places:
                self._power(leaf, self.unit(leaf.name), 0.0)
            elif isinstance(leaf, Functional):
                self.families += self._rows(leaf, self.unit(repr(leaf)), 0.0)
        for term in greatest:
            scale = self.scale(term)
            for i, part in enumerate(term.parts, 1):
                self.row(names.maximum_part(i, repr(term)), self.sum(part) - self.unit(repr(term), scale), 0.0, scale)

    def row(self, name: str, row: Array, bound: float, unit: float = 1.0) -> None:
        """A row, row . x <= bound, divided by its unit."""
        self.families.append(LinearFamily.of_row(name, row, bound, unit=unit, slack=self.spare))

    def _constraints(self) -> None:
        problem = self.problem
        self._peak()
        velocity = problem.range("B")
        if velocity is not None:
            self._velocity(velocity)
        if problem.monotone:
            self.families.append(self.space.forward(self.spare))
        for constant, limits in problem.bounded:
            self._bounded(constant, limits)
        for condition in self.space.equations():
            self.equation(condition.name, self._widened(condition.row), condition.right)
        for i, window in enumerate(problem.windows, 1):
            halves = (names.window(i), names.mirrored(names.window(i)))
            if window.motion is not None:
                self._formula_window(window, window.motion, halves)
                continue
            parts = window.first_half() if problem.symmetric else (window,)
            for part, name in zip(parts, halves, strict=False):
                self._window(name, part)

    def _peak(self) -> None:
        """Equations that put the peak of b at one k, with B its value there."""
        problem, peak = self.problem, self.problem.peak_at
        velocity = problem.range("B")
        given = velocity.high if velocity is not None and velocity.fixed else None
        if given is not None and not problem.symmetric:
            self.equation(names.velocity_at_peak(peak), self.unit("B"), given)
        if peak is None:
            return
        self.families.append(self.space.below(self.spare, peak))
        if given is not None and problem.symmetric:
            self._value(names.velocity_at_peak(peak), 1, peak, given)
        elif problem.peak_is_variable:
            self._value(names.velocity_at_peak(peak), 1, peak, "B")
        if not problem.symmetric:
            self._value(names.acceleration_at_peak(peak), 2, peak, 0.0)

    def _velocity(self, velocity: Range) -> None:
        """Rows |b| <= B that other rows do not imply, and the bounds of B."""
        problem = self.problem
        if not problem.peak_is_variable and not velocity.fixed:
            self._bounded(B, velocity)
            return
        slack, bound = (self.unit("B"), 0.0) if problem.peak_is_variable else self._derivative(1, 0.5)
        if problem.peak_at is None:
            signs = (1.0,) if problem.monotone else (1.0, -1.0)
            self.families.append(self.space.derivative(1, RowName.VELOCITY, slack + self.spare, bound, signs))
        elif not problem.monotone:
            self.families.append(self.space.backward(slack + self.spare, bound))
        if not velocity.fixed:
            if isfinite(velocity.high):
                self.row(names.at_most("B"), self.unit("B"), velocity.high)
            self.row(names.at_least("B"), -self.unit("B"), -velocity.low)

    def _widened(self, coefficients: Array) -> Array:
        """A row over all variables, from a row over the coordinates."""
        return np.append(coefficients, np.zeros(self.size - self.space.terms))

    def _derivative(self, nu: int, k: float) -> tuple[Array, float]:
        """The derivative of order nu at k as a row and its constant part."""
        row = self.space.row(nu, k)
        return self._widened(row[:-1]), float(row[-1])

    def _value(self, name: str, nu: int, k: float, value: float | str) -> None:
        """The derivative of order nu at k is a number, or the variable of this name."""
        row, base = self._derivative(nu, k)
        if isinstance(value, str):
            self.equation(name, row - self.unit(value), -base)
        else:
            self.equation(name, row, value - base)

    def _bounded(self, constant: Functional, limits: Range) -> None:
        name = constant.name
        unit = self.scales.get(name, 1.0)
        if name in self.places and limits.low > 0.0:
            # its own constant is a law's best choice of the variable
            self.row(names.at_least(name), self.unit(name, -unit), -limits.low, unit)
        if not isfinite(limits.high):
            return
        if name in self.places:
            self.row(names.at_most(name), self.unit(name, unit), limits.high, unit)
        elif isinstance(constant, PowerConstant) and VariableName.POWER_ROOT in self.places:
            self._power(constant, np.zeros(self.size), limits.high)
        else:
            self.families += self._rows(constant, self.spare, limits.high)

    def _rows(self, constant: Functional, slack: Array, bound: float) -> tuple[ConstraintFamily, ...]:
        constant.check_problem(self.problem)
        scale = self.scale(constant)
        check_rows(constant, self.space)
        if self.convex:
            families = constant.convex_families(self.space, scale * slack, bound, self.problem)
        else:
            families = constant.families(self.space, scale * slack, bound)
        return families if constant.normalised else tuple(family.scaled_down(scale) for family in families)

    def _formula_window(self, window: Window, motion: MotionFormula, halves: tuple[str, str]) -> None:
        from optlaws.synthesis.functionals.formula_rows import branch_rows, split
        from optlaws.synthesis.functionals.formula_rows import columns as formula_columns

        parts, unit = motion.halves() if self.problem.symmetric else (motion,), self.scale(window)
        for part, name in zip(parts, halves, strict=False):
            if window.value:
                columns = formula_columns(self.space, part, np.array([1.0 - 2.0 * part.start]))
                row = widened(columns, self.size)[0]
                self.equation(repr(window), row[:-1], window.high - float(row[-1]), unit)
                continue
            for sign, bound in ((1.0, window.high), (-1.0, -window.low)):
                branches = split(part, sign, names.window_side(name, sign)) if isfinite(bound) else None
                for branch in branches or []:
                    if branch.convex or not self.convex:
                        rows = branch_rows(self.space, branch, unit * self.spare, bound)
                        self.families.append(rows.scaled_down(unit))

    def _window(self, name: str, window: Window) -> None:
        if window.value:
            self._value(repr(window), window.nu, window.start, window.high)
            return
        for sign, bound in ((1.0, window.high), (-1.0, -window.low)):
            if isfinite(bound):
                side = names.window_side(name, sign)
                family = self.space.derivative(window.nu, side, self.spare, bound, (sign,))
                part = self.space.part(window.start, window.stop, (window.nu,))
                self.families.append(replace(family, domain=part))

    def _power(self, power: PowerConstant, slack: Array, bound: float) -> None:
        """Rows b <= r sqrt(2k), b >= -r sqrt(2k) from either end, and 2 t r - t² <= D."""
        if self.problem.order == 1 or power != self.power:
            if power != self.power and slack.any():
                self.row(names.at_least(power.name), -slack, 0.0)
            return
        weights, mirrored = floats(power.weights), facing(power.weights)
        root, end_velocity = self.unit(VariableName.POWER_ROOT), self.space.start_velocity + self.space.velocity_change
        # each row counts on rest at its end
        if self.space.start_velocity == 0.0:
            self.families.append(self.space.from_rest(RowName.FROM_START, root, weights=weights))
        if self.space.symmetric and mirrored != power.weights:
            self.families.append(self.space.from_rest(RowName.FROM_END, root, weights=floats(mirrored)))
        if not self.space.symmetric and abs(end_velocity) < _REST_VELOCITY:
            self.families.append(self.space.from_rest(RowName.FROM_END, root, backward=True, weights=weights))
        self.row(RowName.TANGENT, 2.0 * self.tangent * root - slack, bound + self.tangent**2)

    def equation(self, name: str, row: Array, right: float, unit: float = 1.0) -> None:
        self.equations.append(_Equation(name, row / unit, right / unit, unit))

    def model(self) -> Model:
        """The program with the problem's constraints."""
        self._constraints()
        equalities = np.array([equation.row for equation in self.equations]).reshape(-1, self.size)
        right = np.array([equation.right for equation in self.equations])
        units = np.array([equation.unit for equation in self.equations])
        scaled = units if (units != 1.0).any() else None
        program = Program(tuple(self.families), equalities, right, self.cost, self.cost_unit, scaled)
        equation_names = tuple(equation.name for equation in self.equations)
        return Model(self.problem, self.space, program, self.places, equation_names, self.scales)
