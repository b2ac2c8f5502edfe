"""A cycle whose laws are compared: its moves with each law, the demands on the machine, and the optimal laws."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from math import inf
from typing import Any

from optlaws.cycles.advising.advised_law import AdvisedLaw, LawMeasure, ProvenLeast
from optlaws.cycles.advising.further_bounds import least_near, with_most
from optlaws.cycles.cycle import Cycle, Plan
from optlaws.cycles.limit_rows import limits_taken
from optlaws.cycles.optimisation.motion_limits import (
    DECELERATION,
    LIMITS,
    LimitTaken,
    Side,
    limits_of_segment,
    read_limits,
    word_of,
)
from optlaws.cycles.optimisation.objectives import OBJECTIVES, kind_of
from optlaws.cycles.specification.load import LOAD
from optlaws.cycles.specification.process import is_process
from optlaws.cycles.specification.programme import AXES, is_optimal
from optlaws.cycles.specification.segments import OPTIMAL, CycleSegment, Free, Move
from optlaws.cycles.summary import force_name, force_unit, load_unit, objective_unit
from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.motion.piece import Piece, factor, named_law, unit_of
from optlaws.motion.quantities import quantity
from optlaws.motion.quantity_kinds import Kind
from optlaws.synthesis.least_time.follower_residual import RESIDUAL, FollowerResidual
from optlaws.synthesis.problem.constants import FUNCTIONALS, Functional
from optlaws.synthesis.solution import Solution
from optlaws.synthesis.solve import synthesize
from optlaws.synthesis.status import Status
from optlaws.tolerances import JUMP

_OF_MOTION = ("velocity", "acceleration", "jerk", "rms acceleration")
#: constants of a law that may be least beside something else
CONSTANT_OF = {"velocity": "B", "acceleration": "C", "jerk": "J"}
_POWERED = ("power", "energy", "heat")
#: units of SI as quantities have them, of what may be bounded further
_ASCII = {"m/s²": "m/s^2", "m/s³": "m/s^3", "rad/s²": "rad/s^2", "rad/s³": "rad/s^3"}


@dataclass(frozen=True)
class AdvisedCycle:
    """A cycle, with the follower that its moves leave vibrating; laws of its moves are compared.

    Attributes
    ----------
    cycle
        As it stands.
    minimise
        The measure that is to be least: that of the cycle, or the residual acceleration of its follower.
    follower
        The follower whose residual acceleration is listed, or None; its limit is `most`.
    most
        The limit of the residual acceleration in SI units, infinite where it has none.
    """

    cycle: Cycle
    minimise: str
    follower: FollowerResidual | None = None
    most: float = inf

    @kept_property
    def measures(self) -> tuple[LawMeasure, ...]:
        """Everything that laws are compared by, in SI units."""
        cycle, force = self.cycle, force_name(self.cycle)
        measures = [LawMeasure(name, unit_of(cycle.axis, kind_of(name)[0].order)) for name in _OF_MOTION]
        if self.follower is not None:
            measures.append(LawMeasure(RESIDUAL, unit_of(cycle.axis, 2)))
        if cycle.load is not None and not is_process(cycle.load):
            outputs = self._standing.load_motion.machine.outputs
            measures += [LawMeasure(f"{LOAD}{name}", load_unit(cycle, name)) for name in outputs]
        if cycle.drive is not None:
            measures += [LawMeasure(name, force_unit(cycle)) for name in (force, f"rms {force}")]
            measures += [LawMeasure("power", "W"), LawMeasure("energy", "J")]
        if all(measure.name != self.minimise for measure in measures):
            measures.append(LawMeasure(self.minimise, objective_unit(cycle, self.minimise)))
        return tuple(measures)

    @kept_property
    def limited(self) -> frozenset[str]:
        """The measures that have a limit, of the cycle or of a segment."""
        of_cycle = read_limits(self.cycle.limits, self.cycle.axis, "limits")
        names = set(self.cycle.limits)
        for stretch in self.cycle.programme.stretches:
            for key in limits_of_segment(stretch, of_cycle, self.cycle.axis):
                names.add(word_of(Side(key.kind), self.cycle.axis))
        if self.cycle.limits.get("motor"):
            names |= {"velocity", "torque", "rms torque"}
        if self.most < inf:
            names.add(RESIDUAL)
        return frozenset(names)

    @property
    def objectives(self) -> tuple[str, ...]:
        """The measures that can be minimised; power and sums are excluded, as they have no lower bound."""
        names = (measure.name for measure in self.measures if measure.name not in (*_POWERED, "velocity"))
        return tuple(name for name in names if name in (*OBJECTIVES, RESIDUAL, self.minimise))

    def given(self) -> AdvisedLaw | None:
        """The cycle with its given laws; None where all of its moves are optimised."""
        if all(is_optimal(self.cycle.segments[i]) for i in self._compared):
            return None
        return self._advised("as it stands", "given", self._standing)

    @property
    def usual(self) -> str | None:
        """The common law name of its moves; None where they have several, or are optimised."""
        laws = [getattr(self.cycle.segments[i], "law", OPTIMAL) for i in self._compared]
        first = laws[0]
        return first if isinstance(first, str) and first != OPTIMAL and all(law == first for law in laws) else None

    def standard(self, name: str) -> AdvisedLaw:
        """The cycle with a law of the catalogue in all its moves.

        Raises
        ------
        InputError
            If that law does not fit: velocities do not meet, points on the way are given, or it has none of what is
            minimised, as its velocity jumps.
        """
        cycle = self._known(self._segments(partial(_with_law, name)))
        advised = self._advised(name, "standard", cycle)
        if self.minimise != RESIDUAL and not advised.values[self.minimise] > 0.0:
            raise InputError(
                f"the {self.minimise} of {name} is 0 between its ends, where its velocity jumps, so that no law can be "
                "compared with it: take a law from rest to rest"
            )
        return advised

    def least(self, name: str, minimise: str, most: Mapping[str, float]) -> AdvisedLaw:
        """The cycle whose laws are least in a measure and take no more of others, within all limits.

        Raises
        ------
        InfeasibleProblem, SolverFailure
            If no law satisfies all of that, or the search fails.
        """
        of_cycle = self.cycle.minimise if minimise == RESIDUAL else minimise
        limits = dict(self.cycle.limits)
        for other, value in most.items():
            if other != RESIDUAL:
                limits |= self._tighter(limits, other, value)
        cycle = replace(self.cycle, segments=self._segments(_optimal), minimise=of_cycle, limits=limits).solve()
        if self.follower is not None:
            residual = min(self.most, most.get(RESIDUAL, inf))
            if minimise == RESIDUAL or self._residual(cycle) > residual:
                cycle = cycle.with_solutions(self._calmer(cycle, minimise, residual))
        return self._optimal(name, minimise, cycle)

    def near(self, name: str, best: AdvisedLaw, minimise: str, share: float) -> AdvisedLaw:
        """The cycle with the least peak or residual among laws whose other measure is within a share of the optimum.

        Raises
        ------
        InfeasibleProblem, SolverFailure
            If the search fails.
        """
        if self.follower is None and kind_of(self.minimise)[0].order and self.minimise in LIMITS:
            # what is near is a limit of the cycle, so that the law is one of a cycle too
            most = self._tighter(best.motion.limits, self.minimise, (1.0 + share) * best.values[self.minimise])
            limits = {**best.motion.limits, **most}
            cycle = replace(best.motion.specification, minimise=minimise, limits=limits)
            return self._optimal(name, minimise, cycle.solve())
        solutions = [
            synthesize(least_near(solution, self._constant_of(minimise, piece), share))
            if minimise != RESIDUAL or _rests(piece)
            else solution
            for piece, solution in _solved(best.motion)
        ]
        return self._optimal(name, minimise, best.motion.with_solutions(solutions))

    @kept_property
    def _compared(self) -> tuple[int, ...]:
        """The numbers of the segments whose laws are compared: all moves except moves that end in motion."""
        numbers = tuple(i for i, segment in enumerate(self.cycle.segments) if _may_change(segment))
        if not numbers:
            raise InputError("the cycle has no move whose law could be another: laws are compared from rest to rest")
        return numbers

    def _segments(self, changed: Any) -> list[CycleSegment]:
        return [changed(each) if i in self._compared else each for i, each in enumerate(self.cycle.segments)]

    def _known(self, segments: Sequence[CycleSegment]) -> Plan:
        """A cycle of known laws, without limits and without an objective of the load."""
        minimise = "acceleration" if kind_of(self.cycle.minimise)[0] is Kind.LOAD else self.cycle.minimise
        return replace(self.cycle, segments=segments, minimise=minimise, limits={}).unchecked()

    @kept_property
    def _standing(self) -> Plan:
        return self.cycle.unchecked() if self.usual is None else self._known(self.cycle.segments)

    def _advised(self, name: str, kind: Any, cycle: Plan, proof: ProvenLeast | None = None) -> AdvisedLaw:
        values = {measure.name: self._value(cycle, measure.name) for measure in self.measures}
        limits = list(limits_taken(cycle, self.cycle))
        if self.most < inf:
            text = f"{self.most:.6g} {_ASCII[unit_of(cycle.axis, 2)]}"
            limits.append(LimitTaken(RESIDUAL, "", values[RESIDUAL], self.most, text))
        return AdvisedLaw(name, kind, cycle, values, tuple(limits), tuple(cycle.solutions) if proof else (), proof)

    def _value(self, cycle: Plan, name: str) -> float:
        if name == RESIDUAL:
            return self._residual(cycle)
        if name.startswith(LOAD) and cycle.load is not None:
            return cycle.load_motion.peak(name.removeprefix(LOAD)).value
        if name == "jerk" and any(joint["acceleration"] for joint in cycle.joints):
            return inf  # the peaks of segments are those inside
        return cycle.value(name)

    def _residual(self, cycle: Plan) -> float:
        """The greatest residual acceleration that a move from rest to rest leaves, each by itself."""
        moves = [piece for piece in cycle.pieces if _rests(piece)]
        if not moves:
            raise InputError("follower: no motion of the cycle is from rest to rest, after which it would vibrate on")
        return max(
            float(constant.value(piece.law)) * abs(factor(piece.stroke, piece.duration, 2))
            for piece, constant in ((piece, self._constant(piece)) for piece in moves)
        )

    def _constant(self, piece: Piece) -> Functional:
        assert self.follower is not None  # noqa: S101 - as it is asked of one
        return self.follower.limit_in(piece.duration, abs(piece.stroke)).constant

    def _constant_of(self, minimise: str, piece: Piece) -> Functional:
        return self._constant(piece) if minimise == RESIDUAL else FUNCTIONALS[CONSTANT_OF[minimise]]

    def _calmer(self, cycle: Plan, minimise: str, residual: float) -> list[Solution]:
        """Solutions whose moves from rest to rest leave no more vibrating than is allowed, or the least."""
        calmer = []
        for piece, solution in _solved(cycle):
            problem = solution.problem
            if _rests(piece):
                constant = self._constant(piece)
                if residual < inf:
                    problem = with_most(problem, constant, residual / abs(factor(piece.stroke, piece.duration, 2)))
                if minimise == RESIDUAL:
                    problem = replace(problem, minimise=constant, symmetric=problem.symmetric and constant.even)
            calmer.append(solution if problem == solution.problem else synthesize(problem))
        return calmer

    def _optimal(self, name: str, minimise: str, cycle: Plan) -> AdvisedLaw:
        return self._advised(name, "optimal", cycle, self._proof(cycle, minimise))

    def _proof(self, cycle: Plan, minimise: str) -> ProvenLeast:
        """The proof that belongs to the objective of its solutions."""
        space, solutions = cycle.search_space or "", cycle.solutions
        if minimise == cycle.minimise:
            return ProvenLeast(minimise, cycle.lower_bound, _of_any_degree(cycle), space, cycle.status)
        nu = kind_of("acceleration" if minimise == RESIDUAL else minimise)[0].order
        moves = [each for each in _solved(cycle) if minimise != RESIDUAL or _rests(each[0])]
        scaled = [solution.lower_bound * abs(factor(piece.stroke, piece.duration, nu)) for piece, solution in moves]
        proven = all(solution.status is Status.OPTIMAL for solution in solutions)
        return ProvenLeast(minimise, max(scaled), None, space, Status.OPTIMAL if proven else Status.LOCAL)

    def _tighter(self, limits: Mapping[str, Any], name: str, most: float) -> dict[str, Any]:
        """A limit that is no wider than a value in SI units, in addition to existing limits."""
        axis, unit = self.cycle.axis, objective_unit(self.cycle, name)
        text = f"{most!r} {_ASCII.get(unit, unit)}"
        if name.startswith(LOAD):
            return {name: most if unit == "SI" else text}
        given = limits.get(name)
        order = LIMITS[name].order if name in LIMITS else 0
        dimension = AXES[axis][order] if order else None
        if dimension is None:
            return {name: text}
        apart = {DECELERATION: limits[DECELERATION]} if name == "acceleration" and DECELERATION in limits else {}
        tighter = {other: text if quantity(value, dimension, other) > most else value for other, value in apart.items()}
        if isinstance(given, list | tuple):
            low, high = (quantity(each, dimension, name) for each in given)
            sides = (max(low, -most), min(high, most))
            return {name: tuple(f"{side!r} {_ASCII.get(unit, unit)}" for side in sides)}
        if given is not None and quantity(given, dimension, name) <= most:
            text = given
        return {name: text, **tighter}


def _may_change(segment: CycleSegment) -> bool:
    """Whether a segment's law may be replaced: it is optimised, or goes from rest to rest."""
    if is_optimal(segment):
        return True
    if not isinstance(segment, Move):
        return False
    return _is_at_rest(named_law(segment.law, segment.label))


def _with_law(law: str, segment: CycleSegment) -> CycleSegment:
    """A segment with a law of the catalogue."""
    if isinstance(segment, Free):
        if segment.via:
            raise InputError(f"{segment.label}: a law of the catalogue passes no points that are given")
        return Move(segment.by, segment.duration, to=segment.to, law=law, limits=segment.limits, name=segment.label)
    if isinstance(segment, Move) and (segment.start_velocity, segment.end_velocity) != (None, None):
        raise InputError(f"{segment.label}: a law of the catalogue has no velocity at its ends")
    return replace(segment, law=law)  # type: ignore[type-var] # a dataclass


def _optimal(segment: CycleSegment) -> CycleSegment:
    return replace(segment, law=OPTIMAL) if isinstance(segment, Move) else segment


def _rests(piece: Piece) -> bool:
    """Whether a piece moves from rest to rest."""
    return bool(piece.stroke) and _is_at_rest(piece.law)


def _is_at_rest(law: MotionLaw) -> bool:
    """Whether a law's velocity is 0 at both ends, up to rounding."""
    return max(abs(float(law.b(end))) for end in (0.0, 1.0)) <= JUMP * law.peak(1).value


def _solved(cycle: Plan) -> list[tuple[Piece, Solution]]:
    """The solutions with their pieces."""
    pieces = {id(piece.law): piece for piece in cycle.pieces}
    return [(pieces[id(solution.law)], solution) for solution in cycle.solutions]


def _of_any_degree(cycle: Plan) -> float | None:
    """The least value for laws of any degree, where it is known of a peak of the motion."""
    kind, mean = kind_of(cycle.minimise)
    nu = kind.order
    if not nu or mean:
        return None
    limits = [
        solution.limit * abs(factor(piece.stroke, piece.duration, nu))
        for piece, solution in _solved(cycle)
        if solution.limit is not None
    ]
    return max(limits, default=None)
