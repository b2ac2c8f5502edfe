"""Rows that every law of a problem satisfies, by their names in certificates, in exact or ball arithmetic."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cache, partial
from math import isfinite
from operator import mul

from flint import acb, arb

from optlaws.errors import InputError
from optlaws.formulas.branches import switches
from optlaws.formulas.of_motion import MotionFormula
from optlaws.formulas.tree import ORDERS
from optlaws.kept import kept_property
from optlaws.mechanisms.machine.output_constants import OutputConstant, OutputRms
from optlaws.mechanisms.machine.residual import Residual
from optlaws.synthesis.families import names
from optlaws.synthesis.families.names import RowName, VariableName
from optlaws.synthesis.functionals.formula_rows import Branch, split, squared
from optlaws.synthesis.functionals.formula_rows import sides as formula_sides
from optlaws.synthesis.functionals.kinds import FormulaIntegral, FormulaPeak, FormulaRms, boxes_of
from optlaws.synthesis.problem.constants import (
    B,
    Combined,
    CombinedPeak,
    Functional,
    PeakConstant,
    PowerConstant,
    RootMeanSquare,
    facing,
)
from optlaws.synthesis.problem.expression import Expression, leaves
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.problem.ranges import Range
from optlaws.synthesis.problem.windows import Window
from optlaws.synthesis.program.writer import maxima, relaxed_power
from optlaws.synthesis.proof.certificate import RELAXED, VIOLATION, Certificate
from optlaws.synthesis.proof.duality import Number, Sublevel
from optlaws.synthesis.proof.nodes import Contact
from optlaws.synthesis.spaces.of_basis import space_of
from optlaws.synthesis.spaces.space import LawSpace
from optlaws.tolerances import BESIDE_BREAK
from optlaws.verification.enclosing.balls import ball, upper
from optlaws.verification.enclosing.space import exact_space
from optlaws.verification.exact.law import DerivativePeak, ExactLaw, OfFormula, OfMachine, known, of_derivatives
from optlaws.verification.exact.motion_formulas import (
    convex_branches,
    formula_columns,
    kinked_integral,
    norm_columns,
    tangent_columns,
    tangent_integral,
)
from optlaws.verification.machines.output_motion import of_space
from optlaws.verification.machines.outputs import OutputRows
from optlaws.verification.machines.residuals import exact_residual
from optlaws.verification.machines.transfer import floor

_NEAR = Fraction(1, 10**9)
_BESIDE = Fraction(BESIDE_BREAK) / 2
#: what makes up for the rounding of a few operations in doubles
_ROUNDED = 1 + Fraction(1, 2**40)


class NoExactRowsError(InputError):
    """There are no exact rows for a constant of a problem, whose bounds are those of doubles."""


Place = Callable[[Fraction], list[arb]]
Names = Mapping[str, float | arb]


@dataclass(frozen=True, eq=False)
class BallRow:
    """functions . (z, 1) + sum of constants + right; at most 0, or 0 for an equation, in every law of the problem."""

    functions: list[arb]
    constants: Names = field(default_factory=dict)
    right: arb | float = 0.0

    def vector(self, variables: list[str]) -> list[arb]:
        """Coefficients of z and of the named constants, then what is constant."""
        *free, base = self.functions
        return [*free, *(arb(self.constants.get(name, 0.0)) for name in variables), base + self.right]


@dataclass(frozen=True, eq=False)
class UpperLimit:
    """A sum of named constants, their signs turned, and a number, which a function of the law is at most."""

    constants: Names = field(default_factory=dict)
    high: float | arb = 0.0

    def row(self, functions: Iterable[arb], unit: arb | None = None) -> BallRow:
        """The row of a function of the law, in a unit if one is given."""
        if unit is None:
            return BallRow(list(functions), self.constants, -arb(self.high))
        constants = {name: arb(value) / unit for name, value in self.constants.items()}
        return BallRow([value / unit for value in functions], constants, -arb(self.high) / unit)


Maker = Callable[[Contact, Fraction], BallRow]


@dataclass(frozen=True, eq=False)
class WindowPart:
    """A window on k <= 1/2 (or anywhere for unsymmetric laws) in exact numbers."""

    order: int
    low: Fraction | None
    high: Fraction | None
    start: Fraction
    stop: Fraction


class ExactRows:
    """Rows that a certificate may use. Constants are variables, which every law satisfies with its own values."""

    def __init__(self, certificate: Certificate) -> None:
        self.problem = problem = certificate.problem
        self.space = exact_space(problem)
        self.tangent = ball(certificate.tangent or 0.0)
        self.relaxed = certificate.program == RELAXED
        #: the one power whose root is a variable
        self.power = relaxed_power(problem) if self.relaxed else None
        #: outputs of machines, whose contacts' k is a share of the time that counts
        self.outputs: dict[str, OutputRows] = {}
        self.names: list[str] = []
        self.cost: dict[str, float] = {}
        self._makers: dict[tuple[str, float], list[Maker]] = {}
        self.equations: list[BallRow] = []
        if certificate.program != VIOLATION:
            self._objective(problem.objective)
        if problem.peak_is_variable:
            self.names.append("B")
        if self.power is not None and _is_bounded(self.power, problem):
            self.names.append(VariableName.POWER_ROOT)
        self.names = list(dict.fromkeys(self.names))
        violated = [VariableName.VIOLATION] if certificate.program == VIOLATION else []
        #: bounds of laws below a claim
        self.sublevel = Sublevel(problem, [*self.names, *violated], self._sizes, self._floor, _exact, _root)
        self._constraints()

    @kept_property
    def _solved(self) -> LawSpace:
        """The laws in the coordinates in which they were sought, where a certificate's units come from."""
        return space_of(self.problem.basis, self.problem.conditions, symmetric=self.problem.symmetric)

    def _sizes(self, constant: Functional) -> Iterator[tuple[int, Fraction, Fraction]]:
        if constant.derivatives():
            # what a user's own constant bounds follows from what it is, whatever it says that it bounds
            peak = of_derivatives(constant)
            if len(peak.weights) == 1:
                yield peak.nu, 1 / abs(peak.weights[0]), Fraction(0)
            return
        for nu, *sizes in () if isinstance(constant, OutputConstant) else constant.sizes(self._solved):
            factor, offset = (Fraction(size) * _ROUNDED for size in sizes)
            yield nu, factor, offset

    def _floor(self, constant: Functional) -> Number:
        value = Fraction(0) if constant.derivatives() else floor(constant, self.problem.conditions)
        # above 0 doubles say it, unless it is an exact one
        return value if isinstance(value, Fraction) else min(_exact(value), Fraction(0))

    def row(self, contact: Contact) -> BallRow | None:
        """The row of a contact; None if the problem has no such constraint."""
        place = Fraction(contact.k)
        for make in self._makers.get((contact.constraint, contact.sign), ()):
            with suppress(LookupError):
                return make(contact, place)
        return None

    def _add(self, name: str, maker: Maker, signs: tuple[float, ...] = (1.0,)) -> None:
        for sign in signs:
            self._makers.setdefault((name, sign), []).append(maker)

    @kept_property
    def settled(self) -> list[list[arb]]:
        """Coefficients of z, and what is constant, of the equations of the law alone: what no moment sees."""
        return [row.vector([]) for row in self.equations if not row.constants]

    def _objective(self, expression: Expression) -> None:
        self.cost = expression.weights()
        constants = list(dict.fromkeys(leaf for _, leaf in leaves(expression)))
        largest = list(dict.fromkeys(maxima(expression)))
        self.names += [repr(term) for term in (*constants, *largest)]
        for leaf in constants:
            if not isinstance(leaf, Functional) or [repr(other) for other in constants].count(repr(leaf)) > 1:
                raise InputError(f"there are no exact rows for {leaf!r}: it is no constant, or shares its name")
            self._bounded(leaf, UpperLimit({leaf.name: -1.0}))
        for term in largest:
            for i, part in enumerate(term.parts, 1):
                self._single(names.maximum_part(i, repr(term)), {**part.weights(), repr(term): -1.0}, 0.0)

    def _bounded(self, leaf: Functional, limit: UpperLimit) -> None:
        """Rows of `leaf <= limit`."""
        constant = known(leaf)
        if isinstance(constant, Combined):
            constant.check(self._solved)
        if isinstance(constant, CombinedPeak | DerivativePeak):
            for name, weights, signs in constant.sides(symmetric=self.problem.symmetric):
                self._everywhere(name, partial(self.space.combination, constant.nu, weights), signs, limit)
        elif isinstance(constant, OfMachine):
            self._of_machine(constant, limit)
        elif isinstance(constant, OfFormula):
            self._of_formula(constant, limit)
        elif isinstance(constant, RootMeanSquare):
            self._add(constant.name, lambda contact, _: self._norm(constant.nu, contact, limit))
        elif isinstance(constant, PeakConstant):
            # one sign of a derivative that is odd about 1/2 is, over the whole interval, both signs over the half
            signs = (1.0, -1.0) if self.problem.symmetric and constant.nu % 2 == 0 else constant.signs
            self._everywhere(constant.name, partial(self.space.values, constant.nu), signs, limit)
        elif constant == self.power:
            self._power(constant, limit)
        elif self.relaxed and limit.constants:
            self._single(names.at_least(constant.name), limit.constants, 0.0)

    def _everywhere(
        self, name: str, values: Place, signs: tuple[float, ...], limit: UpperLimit, unit: arb | None = None
    ) -> None:
        self._add(name, lambda contact, k: limit.row((value * contact.sign for value in values(k)), unit), signs)

    def _of_formula(self, constant: OfFormula, limit: UpperLimit) -> None:
        symmetric = self.problem.symmetric
        if not constant.convex:
            self._beneath(constant, limit)
        elif isinstance(constant, FormulaRms | FormulaIntegral):
            self._integral(constant, limit)
        elif isinstance(constant, FormulaPeak) and constant.affine:
            for side in formula_sides(constant.motion, constant.name, constant.signs, symmetric=symmetric):
                self._part(side.name, side.motion, side.signs, limit)
        else:
            for branch in constant.branches(symmetric=symmetric):
                self._branch(branch, limit)

    def _beneath(self, constant: OfFormula, limit: UpperLimit) -> None:
        """Convex rows that underestimate non-convex constants, and lower bounds of these."""
        if isinstance(constant, FormulaPeak):
            for branch in constant.beneath(boxes_of(self.problem), symmetric=self.problem.symmetric):
                self._branch(branch, limit)
        floor = constant.floor(self.problem.conditions)
        if isfinite(floor) and limit.constants:
            self._single(names.at_least(constant.name), limit.constants, -ball(floor))

    def _branch(self, branch: Branch, limit: UpperLimit) -> None:
        """Rows of an affine formula, or the tangents of a convex one."""
        motion = branch.motion
        if motion.affine is not None:
            self._part(branch.name, motion, (branch.sign,), limit)
            return
        start, stop = Fraction(motion.start), Fraction(motion.stop)

        def make(contact: Contact, k: Fraction) -> BallRow:
            return limit.row(tangent_columns(self.space, branch, contact.direction, self._within(k, start, stop)))

        self._add(branch.name, make, (branch.sign,))

    def _integral(self, constant: FormulaRms | FormulaIntegral, limit: UpperLimit) -> None:
        motion, name = constant.motion, constant.name
        if isinstance(constant, FormulaRms) and constant.affine:
            whole = ball(Fraction(motion.stop) - Fraction(motion.start)).sqrt()
            parts = constant.parts(symmetric=self.problem.symmetric)
            columns = partial(norm_columns, self.space, parts)
            self._add(name, lambda contact, _: limit.row(value / whole for value in columns(contact.direction)))
            return
        root, kinked = isinstance(constant, FormulaRms), bool(switches(motion.formula, ORDERS))
        branches = convex_branches(motion) if kinked and not root else None
        if kinked and branches is None:
            of = "root mean square of a formula with kinks" if root else "integral of no maximum of convex formulas"
            raise NoExactRowsError(f"there are no exact rows for {name}: it is the {of}")
        unit = ball(constant.length).sqrt() if isinstance(constant, FormulaRms) else arb(1)

        def make(contact: Contact, _: Fraction) -> BallRow:
            if branches is not None:
                return limit.row(kinked_integral(self.space, motion, branches, contact.direction))
            squares = squared(motion) if root else motion
            columns = tangent_integral(self.space, squares, contact.direction, root=root)
            return limit.row(value / unit for value in columns)

        self._add(name, make)

    def _part(self, name: str, motion: MotionFormula, signs: tuple[float, ...], limit: UpperLimit) -> None:
        """Rows of an affine formula on its part of the interval."""
        start, stop = Fraction(motion.start), Fraction(motion.stop)

        def values(k: Fraction) -> list[arb]:
            return formula_columns(self.space, motion, self._within(k, start, stop))

        self._everywhere(name, values, signs, limit)

    def _single(self, name: str, constants: Names, high: float | arb) -> None:
        row = UpperLimit(constants, high).row([arb(0)] * (self.space.terms + 1))
        self._add(name, lambda _, __: row)

    def _power(self, power: PowerConstant, limit: UpperLimit) -> None:
        """b² <= 2 D k wherever b(0) = 0, b² <= 2 D (1-k) wherever b(1) = 0; 2 t r - t² <= D for r the root of D.

        For the power of a combination b is the combination; where it is not symmetric though the law is, the rows of
        its second half are those of its mirror image on the first.
        """
        start, change, _ = self.space.bounds
        weights, mirrored = power.weights, facing(power.weights)
        if start is not None and change is not None and start == 0:
            self._from_rest(RowName.FROM_START, weights, lambda k: k)
        if self.problem.symmetric and mirrored != weights:
            self._from_rest(RowName.FROM_END, mirrored, lambda k: k)
        elif start is not None and change is not None and start + change == 0:
            self._from_rest(RowName.FROM_END, weights, lambda k: 1 - k)
        constants = {VariableName.POWER_ROOT: 2 * self.tangent, **limit.constants}
        self._single(RowName.TANGENT, constants, arb(limit.high) + self.tangent**2)

    def _from_rest(self, name: str, weights: tuple[Fraction, ...], way: Callable[[Fraction], Fraction]) -> None:
        def make(contact: Contact, k: Fraction) -> BallRow:
            velocities = self.space.combination(1, weights, k)
            left = ball(2 * way(k)).sqrt()
            row = [velocity * contact.sign / left if way(k) else arb(0) for velocity in velocities]
            return BallRow(row, {VariableName.POWER_ROOT: -1.0})

        self._add(name, make, (1.0, -1.0))

    def _norm(self, nu: int, contact: Contact, limit: UpperLimit) -> BallRow:
        """A direction times the values at Gauss points, each by the root of its weight: at most the norm (Cauchy)."""
        direction = [ball(value) for value in contact.direction]
        rule = self.space.gauss(nu, len(direction))
        length = sum((component * component for component in direction), arb(0)).sqrt().max(arb(1))
        weights = [component * weight.sqrt() / length for component, (_, weight) in zip(direction, rule, strict=True)]
        columns = zip(*(column for column, _ in rule), strict=True)
        return limit.row(sum(map(mul, weights, column), arb(0)) for column in columns)

    def _of_machine(self, constant: OfMachine, limit: UpperLimit) -> None:
        if isinstance(constant, Residual):
            self._residual(constant, limit)
            return
        output = self.outputs[constant.name] = OutputRows(constant, self.space)
        unit = ball(constant.unit(self._solved))
        if not isinstance(constant, OutputRms):
            self._everywhere(constant.name, output.at, (1.0, -1.0), limit, unit)
            return

        def beside_another_law(contact: Contact, _: Fraction) -> BallRow:
            law = constant.along(self._solved, contact.direction)
            if law is None:
                raise LookupError
            return limit.row(output.beside(ExactLaw(law).polynomials), unit)

        self._add(constant.name, beside_another_law)

    def _residual(self, constant: Residual, limit: UpperLimit) -> None:
        """On each edge a direction times a complex amplitude: at most its magnitude."""
        exact, drives, sought = exact_residual(constant), of_space(self.space), bool(limit.constants)

        def make(unit: arb, amplitudes: Callable[[Fraction], list[acb]], contact: Contact, k: Fraction) -> BallRow:
            if len(contact.direction) != 2:
                raise LookupError
            real, imaginary = (ball(value) for value in contact.direction)
            length = (real**2 + imaginary**2).sqrt().max(arb(1))
            return limit.row(((value.real * real + value.imag * imaginary) / length for value in amplitudes(k)), unit)

        for i, name in enumerate(constant.part_names):
            unit = ball(constant.unit(self._solved, i, float(limit.high), sought=sought))
            self._add(name, partial(make, unit, cache(partial(exact.rows, drives, i))))

    def _constraints(self) -> None:
        problem = self.problem
        self._peak()
        self._velocity()
        if problem.monotone:
            self._everywhere(RowName.FORWARD, partial(self.space.values, 1), (-1.0,), UpperLimit())
            if self.space.divided:
                self._everywhere(RowName.RATIO, self.space.ratio, (1.0,), UpperLimit())
        for constant, limits in problem.bounded:
            self._range(constant, limits)
        for condition in self.space.conditions:
            self.equations.append(BallRow(self.space.condition(condition), {}, -ball(condition.value)))
        for i, window in enumerate(problem.windows, 1):
            self._window(i, window)
        for branch, bound in formula_windows(problem):
            if branch.convex:
                self._branch(branch, UpperLimit(high=bound))

    def _range(self, constant: Functional, limits: Range) -> None:
        name = constant.name
        if name in self.names and limits.low > 0.0:
            self._single(names.at_least(name), {name: -1.0}, -limits.low)
        if not isfinite(limits.high):
            return
        if name in self.names:
            self._single(names.at_most(name), {name: 1.0}, limits.high)
        else:
            self._bounded(constant, UpperLimit(high=limits.high))

    def _peak(self) -> None:
        """Equations that put the peak of b at one k, with B its value there."""
        problem, space, limits = self.problem, self.space, self.problem.range("B")
        fixed = limits.high if limits is not None and limits.fixed else None
        if fixed is not None and not problem.symmetric:
            self.equations.append(BallRow([arb(0)] * (space.terms + 1), {"B": 1.0}, -ball(fixed)))
        if problem.peak_at is None:
            return
        peak = Fraction(problem.peak_at)
        self._everywhere(RowName.BELOW_PEAK, partial(space.chord, peak), (1.0,), UpperLimit())
        if fixed is not None and problem.symmetric:
            self.equations.append(BallRow(space.values(1, peak), {}, -ball(fixed)))
        elif problem.peak_is_variable:
            self.equations.append(BallRow(space.values(1, peak), {"B": -1.0}))
        if not problem.symmetric:
            self.equations.append(BallRow(space.values(2, peak)))

    def _velocity(self) -> None:
        """Rows |b| <= B and the bounds of B."""
        problem, limits = self.problem, self.problem.range("B")
        if limits is None:
            return
        if problem.peak_is_variable:
            self._everywhere(RowName.VELOCITY, partial(self.space.values, 1), (1.0, -1.0), UpperLimit({"B": -1.0}))
        elif limits.fixed:
            self._add(RowName.VELOCITY, self._below_middle, (1.0, -1.0))
        else:
            self._range(B, limits)
            return
        if not limits.fixed:
            if isfinite(limits.high):
                self._single(names.at_most("B"), {"B": 1.0}, limits.high)
            self._single(names.at_least("B"), {"B": -1.0}, -limits.low)

    def _below_middle(self, contact: Contact, k: Fraction) -> BallRow:
        pairs = zip(self.space.values(1, k), self.space.values(1, Fraction(1, 2)), strict=True)
        return BallRow([velocity * contact.sign - middle for velocity, middle in pairs])

    def _window(self, number: int, window: Window) -> None:
        """The rows of a window by its number, of a formula its value alone."""
        if window.motion is None:
            halves = names.window(number), names.mirrored(names.window(number))
            for part, name in zip(parts(window, symmetric=self.problem.symmetric), halves, strict=False):
                self._window_part(name, window, part)
        elif window.value:
            for motion in _separate(self.problem, window.motion):
                columns = formula_columns(self.space, motion, Fraction(motion.start))
                self.equations.append(BallRow(columns, {}, -ball(window.high)))

    def _window_part(self, name: str, window: Window, part: WindowPart) -> None:
        if window.value:
            values = self.space.values(part.order, part.start)
            self.equations.append(BallRow(values, {}, -ball(part.high or Fraction(0))))
            return

        def make(contact: Contact, k: Fraction) -> BallRow:
            bound = part.high if contact.sign > 0.0 else part.low
            if bound is None:
                raise LookupError
            values = self.space.values(part.order, self._within(k, part.start, part.stop))
            return BallRow([value * contact.sign for value in values], {}, -contact.sign * ball(bound))

        for sign in (1.0, -1.0):
            self._add(names.window_side(name, sign), make, (sign,))

    def _within(self, k: Fraction, start: Fraction, stop: Fraction) -> Fraction:
        """A place on a part of the interval; LookupError where it is beyond the ends by more than rounding.

        What a function has beyond a break where the part ends says nothing of the part.
        """
        if start < stop and not start - _NEAR <= k <= stop + _NEAR:
            raise LookupError
        at_end = [edge for edge in self.space.breaks[1:-1] if start < edge and abs(stop - edge) <= 2 * _BESIDE]
        return min(max(k, start), at_end[0] - _BESIDE if at_end else stop)


def _exact(value: float) -> Number:
    return Fraction(value) if isfinite(value) else value


def _root(square: Number) -> Number:
    return upper(ball(square).sqrt()) if isfinite(square) else square


def formula_windows(problem: Problem) -> Iterator[tuple[Branch, float]]:
    """The smooth formulas of which the windows of formulas bound the greatest, each with what it is at most."""
    for i, window in enumerate(problem.windows, 1):
        if window.motion is None or window.value:
            continue
        halves = (names.window(i), names.mirrored(names.window(i)))
        for part, name in zip(_separate(problem, window.motion), halves, strict=False):
            for sign, bound in ((1.0, window.high), (-1.0, -window.low)):
                branches = split(part, sign, names.window_side(name, sign)) if isfinite(bound) else None
                yield from ((branch, bound) for branch in branches or [])


def _separate(problem: Problem, motion: MotionFormula) -> tuple[MotionFormula, ...]:
    """A formula on the parts of the interval that rows speak of."""
    return motion.halves() if problem.symmetric else (motion,)


def parts(window: Window, *, symmetric: bool) -> Iterator[WindowPart]:
    """The parts of a window; for symmetric laws, a(k) + a(1-k) = 1, on the first half only."""
    low, high = (Fraction(bound) if isfinite(bound) else None for bound in (window.low, window.high))
    start, stop = Fraction(window.start), Fraction(window.stop)
    half = Fraction(1, 2)
    if not symmetric or stop <= half:
        yield WindowPart(window.nu, low, high, start, stop)
        return
    if start < half:
        yield WindowPart(window.nu, low, high, start, half)
    if window.nu % 2 == 0:
        whole = 1 - window.nu // 2
        low, high = (None if bound is None else whole - bound for bound in (high, low))
    yield WindowPart(window.nu, low, high, 1 - stop, 1 - max(start, half))


def _is_bounded(power: PowerConstant, problem: Problem) -> bool:
    """Whether the constant is bounded from above, by the objective or a number: only then rows contain its root."""
    high = (constant for constant, limits in problem.bounded if isfinite(limits.high))
    return any(constant == power for constant in (*(leaf for _, leaf in leaves(problem.objective)), *high))
