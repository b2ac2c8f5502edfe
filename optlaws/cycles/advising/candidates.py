"""The laws that are compared for a motion: standard and optimal ones, what each takes, and the front between two."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from math import inf
from typing import Any, Literal, NamedTuple

from optlaws.cycles.answers import PROVEN_BOUND
from optlaws.cycles.cycle import Cycle, Plan
from optlaws.cycles.optimisation.objectives import OBJECTIVES, kind_of
from optlaws.cycles.placed import limits_taken, with_laws
from optlaws.cycles.report import objective_unit
from optlaws.cycles.specification.limits import (
    AXES,
    DECELERATION,
    FORCES,
    LIMITS,
    LOAD,
    MOTOR,
    LimitTaken,
    Side,
    amount,
)
from optlaws.cycles.specification.load import is_process
from optlaws.cycles.specification.programme import is_optimal
from optlaws.cycles.specification.segments import OPTIMAL, CycleSegment, Move
from optlaws.cycles.usual_law import comparable_moves, segments_with
from optlaws.errors import InputError, OptlawsError
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.motion.piece import Piece, factor, moves_at, unit_of
from optlaws.motion.quantities import Exact, Kind, in_small_units, quantity
from optlaws.sentences import quantity_name
from optlaws.shown.report import Report
from optlaws.shown.steps import step
from optlaws.synthesis.least_time.move_limits import RESIDUALS, FollowerResidual
from optlaws.synthesis.problem.constants import FUNCTIONALS, Functional
from optlaws.synthesis.problem.expression import Maximum, leaves
from optlaws.synthesis.problem.fields import CONSTANTS
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.problem.ranges import Range
from optlaws.synthesis.solution import Solution
from optlaws.synthesis.solve import synthesize
from optlaws.synthesis.status import Status
from optlaws.tolerances import BOUND_SLACK, EQUALLY_GOOD, SHOWN_DIGITS

_FRONT_END = 0.01  # of what is exchanged: a front goes no further, as some of it can vanish

#: what all laws can be bounded by from the start, as it is convex and quick
_OF_MOTION = ("velocity", "acceleration", "jerk", *RESIDUALS)
#: no law is looked for that is least in these beside the objective: power and sums have no lower bound
_NOT_LEAST = ("power", "energy", "heat", "velocity")
_ROUNDS = 3


#: a law of the catalogue, the laws that a cycle has, or one that was looked for
LawKind = Literal["standard", "given", "optimal"]


class LawMeasure(NamedTuple):
    """A quantity by which laws are compared: its name and its unit.

    Examples
    --------
    >>> LawMeasure("rms acceleration", "m/s²").heading, LawMeasure("inertia ratio", "").heading
    ('RMS acceleration, m/s²', 'inertia ratio')
    """

    name: str
    unit: str

    @property
    def heading(self) -> str:
        """The heading of a column of it."""
        return f"{quantity_name(self.name)}, {self.unit}" if self.unit else quantity_name(self.name)


class ProvenLeast(NamedTuple):
    """The proof of an optimal law in numbers, in SI units.

    Attributes
    ----------
    minimise
        What is least.
    lower_bound
        What no law of the space that keeps the same limits takes less than; None where nothing is known.
    best_possible
        What no law of any degree does; None where none is known.
    space
        The laws of which none is better, in words.
    status
        Of the solutions.
    certified
        Whether the certificates of its laws alone prove the lower bound; else it is computed in doubles from more.
    """

    minimise: str
    lower_bound: float | None
    best_possible: float | None
    space: str
    status: Status
    certified: bool = True


@dataclass(frozen=True)
class AdvisedLaw:
    """A law of an advice, with everything that it takes.

    Attributes
    ----------
    name
        Of the catalogue, or what is least in it.
    kind
        "standard", "given" or "optimal".
    motion
        The plan with this law in its moves; its `specification` is the cycle.
    values
        What it takes of every measure by its name, recomputed from the law; in SI units.
    limits
        What it takes of every limit.
    solutions
        Of an optimal law: the solution of every motion, with its certificate.
    proof
        Of an optimal law: what no other law is better in.

    Examples
    --------
    >>> import optlaws
    >>> advice = optlaws.advise(optlaws.Rise("1 m", "1 s"), points=0)
    >>> sine = advice["modified sine"]
    >>> sine.kind, round(sine.values["acceleration"], 4), sine.keeps_limits, sine.law.constants.C
    ('standard', 5.528, True, Peak(value=5.527957, k=0.125))
    """

    name: str
    kind: LawKind
    motion: Plan = field(repr=False)
    values: Mapping[str, float]
    limits: tuple[LimitTaken, ...] = field(default=(), repr=False)
    solutions: tuple[Solution, ...] = field(default=(), repr=False)
    proof: ProvenLeast | None = field(default=None, repr=False)

    @property
    def keeps_limits(self) -> bool:
        """Whether every limit is satisfied, up to rounding."""
        return not self.broken

    @property
    def broken(self) -> tuple[LimitTaken, ...]:
        """The limits that it breaks."""
        return tuple(taken for taken in self.limits if not taken.is_kept)

    @property
    def laws(self) -> tuple[MotionLaw, ...]:
        """The law of every motion, in order."""
        return tuple(piece.law for piece in self.motion.pieces if piece.stroke)

    @property
    def law(self) -> MotionLaw:
        """The law, where all motions have the same.

        Raises
        ------
        InputError
            If motions have laws of their own.
        """
        first, *others = self.laws
        if any(law != first for law in others):
            raise InputError(f"{self.name}: its {len(others) + 1} motions have laws of their own: they are in laws")
        return first

    @property
    def solution(self) -> Solution | None:
        """The solution with its certificate; None for a law that was not optimised.

        Raises
        ------
        InputError
            If there are several.
        """
        if len(self.solutions) > 1:
            raise InputError(f"{self.name}: its {len(self.solutions)} motions have solutions of their own")
        return self.solutions[0] if self.solutions else None

    def report(self) -> Report:
        """The report of the motion with this law."""
        return self.motion.report()


def least(measure: str) -> str:
    """The name of a law that is least in a measure.

    Examples
    --------
    >>> least("rms torque"), least("jerk")
    ('least RMS torque', 'least jerk')
    """
    return f"least {quantity_name(measure)}"


@dataclass
class Candidates:
    """A cycle whose moves have one law after another, in the order of their computation."""

    cycle: Cycle  #: as it stands
    minimise: str  #: an objective of a cycle, or the residual of the follower
    follower: FollowerResidual | None = None  #: what moves leave vibrating
    calm: float = inf  #: the limit of the residual in SI units
    given_degree: int | None = None  #: that of the laws of a cycle before the advice; None of a single move
    laws: dict[str, AdvisedLaw] = field(default_factory=dict)
    errors: dict[str, OptlawsError] = field(default_factory=dict)  #: why there is no law of a name
    usual: AdvisedLaw | None = None  #: the standard law that others are compared with; None where none fits
    #: whether nothing is to grow beyond the usual law: not where that breaks limits, and others would take more
    guarding: bool = True
    proven: AdvisedLaw | None = None  #: whose proof says how good any could be
    exchanged: list[AdvisedLaw] = field(default_factory=list)  #: the laws of the front so far

    @kept_property
    def measures(self) -> tuple[LawMeasure, ...]:
        """Everything that laws are compared by, in SI units."""
        cycle, force = self.cycle, FORCES[self.cycle.axis]
        names = ["velocity", "acceleration", "jerk", "rms acceleration"]
        names += [] if self.follower is None else [self.follower.name]
        if cycle.load is not None and not is_process(cycle.load):
            names += [f"{LOAD}{name}" for name in self._standing.load_motion.outputs]
        names += [force, f"rms {force}", "power", "energy"] if cycle.drive is not None else []
        return tuple(LawMeasure(name, self._unit(name)) for name in dict.fromkeys([*names, self.minimise]))

    @property
    def _left(self) -> str:
        return "" if self.follower is None else self.follower.name

    @property
    def _order(self) -> int:
        """Of the derivative of the displacement that vibrates on."""
        return 0 if self.follower is not None and self.follower.of == "displacement" else 2

    @property
    def second(self) -> str:
        """The measure that decides between laws that are equally good: the residual, the jerk, or the acceleration."""
        names = [measure.name for measure in self.measures]
        return next(name for name in (self._left, "jerk", "acceleration") if name in names and name != self.minimise)

    @kept_property
    def own_law(self) -> str | None:
        """The common law name of the moves; None where they have several, or are optimised."""
        laws = [getattr(self.cycle.segments[i], "law", OPTIMAL) for i in self._compared]
        first = laws[0]
        return first if isinstance(first, str) and first != OPTIMAL and all(law == first for law in laws) else None

    def most(self, *but: str) -> dict[str, float]:
        """The usual law's values of most measures without a limit, which no other law should exceed."""
        if self.usual is None or not self.guarding:
            return {}
        limited = {name for each in (self.cycle, *self.cycle.segments) for name in getattr(each, "limits", ())}
        limited |= {"velocity", "torque", "rms torque"} if self.cycle.limits.get(MOTOR) else set()
        limited |= {self._left} if self.calm < inf else set()
        return {
            name: value
            for name, value in self.usual.values.items()
            if name not in {self.minimise, *limited, *but} and 0.0 < value < inf and name in self._guards
        }

    @kept_property
    def _guards(self) -> tuple[str, ...]:
        """The measures of which no law should take more than the usual one.

        The force of a mass alone is its acceleration, which is one of them; an RMS counts where a motor is rated by it.
        """
        drive = self.cycle.in_si.drive
        if drive is None:
            return _OF_MOTION
        force, linear = FORCES[self.cycle.axis], drive.linear
        peak = () if linear is not None and not any(linear[1:]) else (force,)
        mean = (f"rms {force}",) if drive.motor.rated_torque < inf or drive.motor.continuous else ()
        return (*_OF_MOTION, *peak, *mean)

    def add_standard(self, names: Sequence[str]) -> None:
        """Add the motion's own laws and the laws of the catalogue.

        The usual one is the first of them, or where it breaks a limit and others do not the least of these.
        """
        for name in names:
            self._add(name, partial(self._standard, name))
        given = any(not is_optimal(self.cycle.segments[i]) for i in self._compared)
        if given and self.own_law not in self.laws:
            name = "as it stands"
            self.laws = {name: self._advised(name, "given", self._standing), **self.laws}
        fit = [law for law in self.laws.values() if law.keeps_limits]
        first = next(iter(self.laws.values()), None)
        self.usual = first if first in fit else min(fit, key=self._objective, default=first)

    def add_optimal(self) -> None:
        """Add the laws that are least in the objective and the second measure; the first of them must exist.

        Raises
        ------
        InfeasibleProblem, SolverFailure
            If no law satisfies every limit, or the search fails.
        """
        minimise, second = self.minimise, self.second
        name = least(minimise)
        step(name)
        best = self.laws[name] = self._least(name, minimise, {})
        beside = "" if self.usual is None else f", no worse than {self.usual.name}"
        most = self.most()
        if most and self.usual is not None:
            name = f"{least(minimise)}{beside}"
            calm = self._add(name, partial(self._within, name, minimise, most))
            best = calm or best
            # a law that breaks limits guards nothing where that would cost more than it takes itself
            bettered = calm is not None and self._objective(calm) <= self._objective(self.usual)
            self.guarding = bettered or self.usual.keeps_limits
        self.proven = best if self.guarding else self.laws[least(minimise)]
        name = f"nearly {least(minimise)}, {least(second)}"
        self._add(name, partial(self._near, name, self.proven, second))
        others = [name for name, _ in self.measures if name not in {minimise, *_NOT_LEAST}]
        for other in others:
            if other in OBJECTIVES:
                name = least(other)
                law = self._add(name, partial(self._least, name, other, {}))
                if law is not None and any(_is_equal(law, each) for each in self.laws.values() if each is not law):
                    del self.laws[name]
        if (left := self._left) in others:
            most = self.most(left)
            name = f"{least(left)}{beside if most else f' at twice the {least(minimise)}'}"
            if minimise in _OF_MOTION:
                fits = self.usual is not None and self.usual.keeps_limits and bool(most)
                most[minimise] = self.usual.values[minimise] if self.usual and fits else self._twice
            self._add(name, partial(self._within, name, left, most))

    def front(self, points: int) -> tuple[AdvisedLaw, ...]:
        """Laws that exchange the minimised measure for the second one, from the least value of each.

        None takes more of the others than the usual law, nor more than twice the least of what is minimised.
        """
        minimise, second = self.minimise, self.second
        most = self.most(second)
        step(f"front, its ends; {points} points in all")
        try:
            beside = {**most, minimise: self._twice} if minimise in _OF_MOTION else most
            ends = [self._within(least(name), name, less) for name, less in ((minimise, most), (second, beside))]
        except OptlawsError as error:
            self.errors["front"] = error
            return ()
        high, low = (end.values[second] for end in ends)
        low = max(low * (1.0 + BOUND_SLACK), _FRONT_END * high)
        self.exchanged = [ends[0]]
        for i in range(1, points if low < high else 0):
            value = high * (low / high) ** (i / (points - 1))
            name = f"{least(minimise)} at a {second} of {value:.4g}"
            step(f"front, point {i + 1} of {points}")
            try:
                self.exchanged.append(self._within(name, minimise, {**most, second: value}))
            except OptlawsError as error:
                self.errors[name] = error
        return tuple(self.exchanged)

    @property
    def _twice(self) -> float:
        """Twice the least objective, as the greatest acceptable price."""
        return 2.0 * self._objective(self.proven or self.laws[least(self.minimise)])

    def _objective(self, law: AdvisedLaw) -> float:
        return law.values[self.minimise]

    def _add(self, name: str, make: Callable[[], AdvisedLaw]) -> AdvisedLaw | None:
        """Add a law under its name, or the error with the reason for its absence."""
        step(name)
        try:
            self.laws[name] = make()
        except OptlawsError as error:
            self.errors[name] = error
            return None
        return self.laws[name]

    def _standard(self, name: str) -> AdvisedLaw:
        """The cycle with a law of the catalogue in all its moves; refused where it does not fit."""
        advised = self._advised(name, "standard", self._known(segments_with(name, self.cycle)))
        if self.minimise != self._left and not self._objective(advised) > 0.0:
            raise InputError(
                f"the {quantity_name(self.minimise)} of {name} is 0 between its ends, where its velocity jumps, so "
                "that no law can be compared with it: take a law from rest to rest"
            )
        return advised

    def _within(self, name: str, minimise: str, most: Mapping[str, float]) -> AdvisedLaw:
        """The least law without exceeding others; drive measures are bounded only if necessary."""
        bounds = {other: value for other, value in most.items() if other in _OF_MOTION}
        for _ in range(_ROUNDS):
            law = self._least(name, minimise, bounds)
            beyond = exceeded(law, most)
            if not beyond:
                break
            bounds |= {other: most[other] for other in beyond}
        return law

    def _least(self, name: str, minimise: str, most: Mapping[str, float]) -> AdvisedLaw:
        """The cycle whose laws are least in a measure and take no more of others, within all limits."""
        of_cycle = self.cycle.minimise if minimise == self._left else minimise
        limits = dict(self.cycle.limits)
        for other, value in most.items():
            if other != self._left:
                limits |= self._tighter(limits, other, value)
        plan = replace(self.cycle, segments=self._segments(_optimal), minimise=of_cycle, limits=limits).solve()
        if self.follower is not None:
            residual = min(self.calm, most.get(self._left, inf))
            if minimise == self._left or self._residual(plan) > residual:
                plan = plan.with_solutions(list(self._calmer(plan, minimise, residual)))
        return self._optimal(name, minimise, plan)

    def _near(self, name: str, best: AdvisedLaw, minimise: str) -> AdvisedLaw:
        """The cycle with the least peak or residual among laws that are equally good beside the best one."""
        if self.follower is None and kind_of(self.minimise)[0].order and self.minimise in LIMITS:
            # what is near is a limit of the cycle, so that the law is one of a cycle too
            limits = best.motion.limits
            most = self._tighter(limits, self.minimise, (1.0 + EQUALLY_GOOD) * self._objective(best))
            cycle = replace(best.motion.specification, minimise=minimise, limits={**limits, **most})
            return self._optimal(name, minimise, cycle.solve())
        solutions = [
            synthesize(_least_near(solution, self._constant_of(minimise, piece)))
            if minimise != self._left or _rests(piece)
            else solution
            for _, piece, solution in best.motion.laws
        ]
        return self._optimal(name, minimise, best.motion.with_solutions(solutions))

    @kept_property
    def _compared(self) -> tuple[int, ...]:
        """The numbers of the segments whose laws are compared: all moves except moves that end in motion."""
        numbers = comparable_moves(self.cycle)
        if not numbers:
            raise InputError("the cycle has no move whose law could be another: laws are compared from rest to rest")
        return numbers

    def _segments(self, changed: Callable[[CycleSegment], CycleSegment]) -> list[CycleSegment]:
        return [changed(each) if i in self._compared else each for i, each in enumerate(self.cycle.segments)]

    def _known(self, segments: Sequence[CycleSegment]) -> Plan:
        """A cycle of known laws, without limits."""
        return with_laws(self.cycle, segments, limits={}).unchecked()

    @kept_property
    def _standing(self) -> Plan:
        return self.cycle.unchecked() if self.own_law is None else self._known(self.cycle.segments)

    def _advised(self, name: str, kind: LawKind, plan: Plan, proof: ProvenLeast | None = None) -> AdvisedLaw:
        values = {measure.name: self._value(plan, measure.name) for measure in self.measures}
        limits = limits_taken(plan, self.cycle)
        if self.calm < inf:
            of_motion = amount(Side(Kind.ACCELERATION), self.calm, plan.axis)
            text = of_motion if self._order else in_small_units(self.calm, plan.axis)
            limits = (*limits, LimitTaken(self._left, "", values[self._left], self.calm, text))
        return AdvisedLaw(name, kind, plan, values, limits, tuple(plan.solutions) if proof else (), proof)

    def _value(self, plan: Plan, name: str) -> float:
        if name == self._left:
            return self._residual(plan)
        if name == "jerk" and any(joint["acceleration"] for joint in plan.joints):
            return inf  # the peaks of segments are those inside
        return plan.value(name)

    def _residual(self, plan: Plan) -> float:
        """The greatest residual that a move from rest to rest leaves, each by itself."""
        moves = [piece for piece in plan.pieces if _rests(piece)]
        if not moves:
            raise InputError("follower: no motion of the cycle is from rest to rest, after which it would vibrate on")
        return max(float(self._constant_of(self._left, piece).value(piece.law)) * self._size(piece) for piece in moves)

    def _size(self, piece: Piece) -> float:
        """Of a residual of 1 of the law of a piece."""
        return abs(factor(piece.stroke, piece.duration, self._order))

    def _constant_of(self, minimise: str, piece: Piece) -> Functional:
        """The constant of a law whose least is that of a measure."""
        if self.follower is not None and minimise == self._left:
            return self.follower.limit_in(piece.duration, abs(piece.stroke)).constant
        return FUNCTIONALS[{"acceleration": "C", "jerk": "J"}[minimise]]

    def _calmer(self, plan: Plan, minimise: str, residual: float) -> Iterator[Solution]:
        """Solutions whose moves from rest to rest leave no more vibrating than is allowed, or the least."""
        for _, piece, solution in plan.laws:
            problem = solution.problem
            if _rests(piece):
                constant = self._constant_of(self._left, piece)
                if residual < inf:
                    problem = _with_most(problem, constant, residual / self._size(piece))
                if minimise == self._left:
                    problem = replace(problem, minimise=constant, symmetric=problem.symmetric and constant.even)
            yield solution if problem == solution.problem else synthesize(problem)

    def _optimal(self, name: str, minimise: str, plan: Plan) -> AdvisedLaw:
        """An optimal law with the proof that belongs to the objective of its solutions."""
        space, solutions = plan.search_space or "", plan.solutions
        kind, mean = kind_of("acceleration" if minimise == self._left else minimise)
        order = self._order if minimise == self._left else kind.order
        moves = [
            (solution, abs(factor(piece.stroke, piece.duration, order)))
            for _, piece, solution in plan.laws
            if minimise != self._left or _rests(piece)
        ]
        if minimise == plan.minimise:
            # of a peak of the motion alone is known what no degree betters
            known = moves if kind.order and not mean else []
            best = max(
                (each.best_possible * scale for each, scale in known if each.best_possible is not None), default=None
            )
            certified = plan.lower_bound_name == PROVEN_BOUND
            proof = ProvenLeast(minimise, plan.lower_bound, best, space, plan.status, certified)
        else:
            bound = max(solution.lower_bound * scale for solution, scale in moves)
            proven = all(solution.status is Status.OPTIMAL for solution in solutions)
            proof = ProvenLeast(minimise, bound, None, space, Status.OPTIMAL if proven else Status.LOCAL)
        return self._advised(name, "optimal", plan, proof)

    def _unit(self, name: str) -> str:
        return unit_of(self.cycle.axis, self._order) if name == self._left else objective_unit(self.cycle, name)

    def _tighter(self, limits: Mapping[str, Any], name: str, most: float) -> dict[str, Any]:
        """Entries of limits by which a measure is no greater than a value in SI units, nor wider than they are."""
        unit = self._unit(name).replace("²", "^2").replace("³", "^3")
        tighter: dict[str, Any] = {}
        apart = (DECELERATION,) if name == "acceleration" and DECELERATION in limits else ()
        for each in (name, *apart):
            order = LIMITS[name].order if name in LIMITS else 0
            given, known = limits.get(each), partial(quantity, dimension=AXES[self.cycle.axis][order], name=each)
            if unit == "SI":
                tighter[each] = most
            elif isinstance(given, list | tuple):
                tighter[each] = tuple(Exact(min(max(known(side), -most), most), unit) for side in given)
            else:
                tighter[each] = Exact(most, unit) if given is None or known(given) > most else given
        return tighter


def _optimal(segment: CycleSegment) -> CycleSegment:
    return replace(segment, law=OPTIMAL) if isinstance(segment, Move) else segment


def _rests(piece: Piece) -> bool:
    """Whether a piece moves from rest to rest."""
    return bool(piece.stroke) and not moves_at(piece.law, 0, 1)


def _is_equal(law: AdvisedLaw, other: AdvisedLaw) -> bool:
    """Whether two laws take the same of everything, as far as a table shows it."""
    return all(abs(value - other.values[name]) <= SHOWN_DIGITS * abs(value) for name, value in law.values.items())


def exceeded(law: AdvisedLaw, most: Mapping[str, float]) -> list[str]:
    """The measures in which a law exceeds given values by more than rounding."""
    return [name for name, value in most.items() if not law.values[name] <= value * (1.0 + BOUND_SLACK)]


def _with_most(problem: Problem, constant: Functional, most: float) -> Problem:
    """A problem with an upper bound of a constant; a fixed constant stays unchanged.

    >>> from optlaws import at_most
    >>> J = FUNCTIONALS["J"]
    >>> _with_most(Problem(order=3, J=at_most(80)), J, 60.0).J, _with_most(Problem(order=3, J=50), J, 60.0).J
    (at_most(60.0), 50.0)
    """
    known = problem.range(constant.name)
    if known is not None and (known.fixed or known.high <= most):
        return problem
    limits = Range(0.0 if known is None else known.low, most)
    entries: dict[str, Any] = {constant.name: limits}
    if constant.name not in CONSTANTS:
        entries = {"bounds": {**problem.bounds, constant: limits}}
    return replace(problem, symmetric=problem.symmetric and constant.even, **entries)


def _least_near(solution: Solution, minimise: Functional) -> Problem:
    """The problem of the best law in another constant, among laws that are equally good as a solution.

    >>> from optlaws import Problem, synthesize
    >>> least = synthesize(Problem(order=3))
    >>> near = synthesize(_least_near(least, FUNCTIONALS["J"]))
    >>> round(near.constants.C.value / least.objective, 6), near.objective < 0.9 * least.constants.J.value
    (1.01, True)
    """
    problem = solution.problem
    terms = problem.objective.terms
    inside = [part for _, term in terms if isinstance(term, Maximum) for part in term.parts]
    if len(terms) > 1 or any(len(part.terms) > 1 for part in inside):
        raise InputError(f"{problem.minimise} is a sum of constants, and no single one is near its least value")
    for weight, constant in leaves(problem.objective):
        if isinstance(constant, Functional):
            problem = _with_most(problem, constant, (1.0 + EQUALLY_GOOD) * solution.objective / weight)
    return replace(problem, minimise=minimise, symmetric=problem.symmetric and minimise.even)
