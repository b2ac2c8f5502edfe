"""A cycle asks: its entries, its plan, and the cycles and plans that come from it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import KW_ONLY, field, replace
from typing import TYPE_CHECKING, Any

from optlaws.cycles.answers import Answers, Solved
from optlaws.cycles.optimisation.optimal import span_problem
from optlaws.cycles.optimisation.shared_limits import best_of
from optlaws.cycles.placed import SegmentPeaks, refuse_beyond, retimed
from optlaws.cycles.specification.limits import MOTOR
from optlaws.cycles.specification.programme import period_of
from optlaws.cycles.specified import Specification
from optlaws.entries.declared import Declared, ValueOf, declared, entry
from optlaws.entries.value_types import Listed, Number, Text
from optlaws.errors import InputError, located
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.motion.piece import unit_of
from optlaws.motion.quantities import TURN, quantity
from optlaws.numbers import NumberOrQuantity
from optlaws.spelling import either_spelling
from optlaws.synthesis.solution import Solution
from optlaws.synthesis.spaces.bases import Basis, Pieces
from optlaws.synthesis.spaces.free_pieces import PeriodicPieces
from optlaws.tolerances import CYCLE_OPTIMALITY

if TYPE_CHECKING:
    from optlaws.cycles.fastest_cycle import FastestCycle
    from optlaws.cycles.moves.time_front import TimeFront
    from optlaws.mechanisms.drives.motor import Motor

_DIGITS = 6  # of the jerk of modified sine as a limit


class CycleAnswers(Answers):
    """What cycles and their plans make of their motion."""

    if TYPE_CHECKING:

        def solve(self) -> Plan: ...

    def at(self, speed: NumberOrQuantity) -> Cycle:
        """The same motion at another speed of the master: laws are unchanged, durations scale in proportion.

        Examples
        --------
        >>> from optlaws import Cycle, Return, Rise
        >>> cycle = Cycle([Rise("35 mm", "120 deg"), Return()], speed="200 rpm")
        >>> fast = cycle.at("400 rpm")
        >>> fast.duration, round(fast.peak(2) / cycle.peak(2), 9)
        (0.15, 4.0)
        """
        plan, period = self.solve(), period_of(speed, None)
        return retimed(plan.specification, self.peaks, period, period / plan.duration, limits={})

    def cam(self, period: NumberOrQuantity, damping: float = 0.0) -> Cycle:
        """The cycle of the cam with which an elastic follower's mass executes this cycle (1.27).

        Each move is corrected by the follower's frequency over its own duration: nu = 2 pi T / T_k. The mass comes to
        rest with each move, so that nothing vibrates in the dwells.

        Parameters
        ----------
        period
            The period T_k of the follower's free vibration, such as "12 ms".
        damping
            Its damping ratio: the share of the critical damping, between mass and ground, as of `Follower`.

        Raises
        ------
        InputError
            If a move is not from rest to rest by a law whose jerk is continuous and 0 at both ends (order 4).

        Examples
        --------
        >>> from optlaws import Cycle, Dwell, Move
        >>> moves = [Move("30 mm", "120 deg", law="III(7.2)"), Dwell("60 deg"), Move("-30 mm", law="III(7.2)")]
        >>> round(Cycle(moves, speed="300 rpm").cam("20 ms", damping=0.05).peak(2), 6)
        39.380514
        """
        from optlaws.mechanisms.machine.polydyne import polydyne

        cycle, natural = self.solve().specification, quantity(period, "time", "follower: period", above=0.0)
        if len(self.pieces) != len(self.peaks):
            raise InputError(
                "the cam of an elastic follower is computed move by move: use moves in place of adjacent free motions"
            )

        def corrected(each: SegmentPeaks) -> MotionLaw:
            with located(each.stretch.where):
                return polydyne(each.piece.law, TURN * each.duration / natural, damping)

        return retimed(cycle, self.peaks, cycle.duration, law=corrected)

    def with_motor(self, motor: Motor) -> Plan:
        """The same laws by a motor with other limits: torques and proofs stay, the margins of its sheet are new.

        Raises
        ------
        InputError
            If the cycle has no motor, its laws keep the limits of the motor, or the other motor has another inertia,
            friction or motor constant, so that other laws may be optimal.

        Examples
        --------
        >>> from optlaws import Cycle, Drive, Dwell, Mechanism, Motor, Rise
        >>> drive = Drive(Mechanism("0.8 kg m^2"), Motor("3e-4 kg m^2", rated_torque="2 N m"), ratio=20)
        >>> moves = [Rise("45 deg", "0.25 s", law="modified sine"), Dwell()]
        >>> cycle = Cycle(moves, period="0.6 s", advance="45 deg", drive=drive)
        >>> weak = cycle.with_motor(Motor("3e-4 kg m^2", rated_torque="1 N m"))
        >>> [round(each.sheet.margins[0].use, 6) for each in (cycle, weak)]
        [0.729259, 1.458518]
        """
        from optlaws.mechanisms.drives.motor import OF_TORQUE

        plan, source = self.solve(), self.geared_motor
        if plan.limits.get(MOTOR):
            raise InputError("the laws keep the limits of the motor: make the cycle anew with the other motor")
        if any(getattr(motor, name) != getattr(source.motor, name) for name in OF_TORQUE):
            raise InputError(
                f"the motor has another {', '.join(OF_TORQUE[:-1])} or {OF_TORQUE[-1]}: make the cycle anew"
            )
        return replace(plan, specification=replace(plan.specification, drive=replace(source, motor=motor)))


@declared
class Cycle(CycleAnswers, Specification):
    """A cycle that repeats: segments and the speed of the master; `solve` returns its plan with the best laws.

    Positions are lengths or angles, whichever the first displacement is. A cycle has the attributes of its plan, which
    is computed when it is first needed. Between joints that are known the cycle decouples, and each law is proven by
    itself.

    Raises
    ------
    InputError
        If durations do not sum, positions do not close or velocities do not meet; the error states the remedy, as it
        does where a method is given what is no time, speed or angle, or needs a load or drive that the cycle has not.
    InfeasibleProblem
        If a joint takes more force than a limit allows. A limit that a given law breaks, or no law satisfies, is
        reported when the motion is first needed; `fastest` finds the speed that keeps them all.

    Examples
    --------
    >>> from optlaws import Dwell, Return, Rise
    >>> rise, back = Rise("35 mm", "120 deg"), Return("35 mm", "100 deg")
    >>> cycle = Cycle([rise, Dwell("90 deg"), back, Dwell()], speed="200 rpm")
    >>> cycle.status.value, round(cycle.objective, 6), round(float(cycle(0.1)), 9)
    ('optimal', 21.883840, 0.035000)
    """

    __repr__ = Specification.__repr__

    def solve(self) -> Plan:
        """The plan with the best laws, computed once.

        Raises
        ------
        InfeasibleProblem
            If a given law breaks a limit, or no law keeps one.

        Examples
        --------
        >>> from optlaws import Return, Rise
        >>> Cycle([Rise("35 mm", "0.1 s"), Return()], period="0.25 s").solve()
        Plan(Cycle([Rise, Return], period=0.25 s, minimise='acceleration'), status='optimal')
        """
        return self._plan

    @kept_property
    def _plan(self) -> Plan:
        refuse_beyond(self)
        return replace(self.unchecked(), checked=True)

    def unchecked(self) -> Plan:
        """The plan, of which given laws that break limits are not refused but reported.

        Its `status` is then infeasible, and `limits_taken` names them.

        Examples
        --------
        >>> from optlaws import Return, Rise
        >>> moves = [Rise("35 mm", "0.1 s", law="cycloidal"), Return(law="cycloidal")]
        >>> cycle = Cycle(moves, period="0.25 s", limits={"velocity": "616 mm/s"})
        >>> cycle.peak(1)
        Traceback (most recent call last):
        optlaws.errors.InfeasibleProblem: segment 1 (Rise): it takes the velocity 700 mm/s at 72 deg of the master, ...
        >>> shown = cycle.unchecked()
        >>> shown.status.value, round(shown.peak(1), 9)
        ('infeasible', 0.7)
        """
        return self._unchecked

    @kept_property
    def _unchecked(self) -> Plan:
        best = best_of(self.layout, self.in_si, self.duration)
        solutions = tuple(solution for _, solution in best.laws)
        return Plan(self, solutions, chosen=best.remarks, bound=best.bound)

    def with_solutions(self, solutions: Sequence[Solution]) -> Plan:
        """The plan with other solutions of its motions, such as solutions of problems with further bounds.

        Objective, bound and status are recomputed from them, which are as many as `solutions`.

        Examples
        --------
        >>> from optlaws import Return, Rise, at_most, synthesize
        >>> cycle = Cycle([Rise("35 mm", "0.1 s"), Return(law="cycloidal")], period="0.3 s")
        >>> (solution,) = cycle.solutions
        >>> smooth = cycle.with_solutions([synthesize(replace(solution.problem, J=at_most(60)))])
        >>> [[round(each.peaks[0].peak(nu), 3) for nu in (2, 3)] for each in (cycle, smooth)]
        [[14.537, 20353.531], [17.073, 2100.0]]
        """
        return Plan(self, solutions)

    def fastest(self) -> FastestCycle:
        """The greatest speed at which the cycle keeps all its limits, with the proof that none is greater.

        Angles turn with the master and durations in seconds stay; free motions take their least times. Limits are of
        all segments, of laws that are given and of constant velocities too, which turn with the master.

        Raises
        ------
        InputError
            If nothing bounds the speed: no limit, durations that leave nothing free, or a free dwell that may vanish.
        InfeasibleProblem
            If no speed keeps a limit.

        Examples
        --------
        >>> from optlaws import Dwell, Return, Rise
        >>> segments = [Rise("35 mm"), Dwell("50 ms"), Return(), Dwell("90 deg")]
        >>> slide = Cycle(segments, speed="60 rpm", limits={"acceleration": "20 m/s^2", "jerk": "2000 m/s^3"})
        >>> slide.fastest()
        FastestCycle(186.397 rpm, period=0.321894 s, status='optimal', binding=('segment 1 (Rise): acceleration 20 ...
        """
        from optlaws.cycles.fastest_cycle import fastest_cycle

        return fastest_cycle(self)

    @either_spelling
    def front(
        self,
        minimise: str,
        *,
        longest: NumberOrQuantity | None = None,
        points: int = 17,
        follower: Mapping[str, Any] | None = None,
    ) -> TimeFront:
        """The least of a quantity over the time of a cycle of one move, from its least time within the limits on.

        The limits are those that `fastest` of a move takes, with a `Drive` those of its motor too; parameters, result
        and errors are those of `time_front`.

        Raises
        ------
        InputError
            If there are several segments, a known law, or a limit that is of no single move.

        Examples
        --------
        >>> from optlaws import Rise
        >>> limits = {"velocity": "1 m/s", "jerk": "300 m/s^3"}
        >>> move = Cycle([Rise("100 mm")], period="0.3 s", advance="100 mm", limits=limits)
        >>> front = move.front("rms acceleration", points=3)
        >>> round(front.fastest.duration, 6) == round(move.fastest().period, 6), round(front.values[0], 2)
        (True, 8.92)
        """
        from optlaws.cycles.moves.time_front import front_of_cycle

        return front_of_cycle(self, minimise, longest=longest, points=points, follower=follower)

    def with_modified_sine_jerk(self) -> Cycle:
        """The cycle of least acceleration among cycles whose jerk is at most modified sine's jerk.

        Raises
        ------
        InputError
            If there is no such jerk: see `modified_sine_jerk`.

        Examples
        --------
        >>> from optlaws import Dwell, Return, Rise
        >>> cycle = Cycle([Rise("35 mm", "120 deg"), Dwell("90 deg"), Return(), Dwell("50 deg")], speed="200 rpm")
        >>> gentle = cycle.with_modified_sine_jerk()
        >>> gentle.limits, [round(each.objective, 3) for each in (cycle, gentle)]
        ({'jerk': '4201.33 m/s^3'}, [21.884, 24.766])
        """
        if self.modified_sine_jerk is None:
            raise InputError(
                "modified sine's jerk is that of motions from rest to rest whose acceleration is minimised without a"
                " limit of the jerk or the snap: give the cycle such motions, or limits={'jerk': ...} of your own"
            )
        # rounded upward
        most = f"{self.modified_sine_jerk * (1.0 + 10.0**-_DIGITS):.{_DIGITS + 1}g}"
        return replace(self, limits={**self.limits, "jerk": f"{most} {unit_of(self.axis)}/s^3"})


@declared
class Plan(Solved, CycleAnswers, Declared, title="a plan"):
    """A cycle with its laws; `Cycle.solve` computes the best ones.

    Parameters
    ----------
    checked
        Whether all laws are known to keep the limits; else the status says whether they do, as of a plan that is read.

    Examples
    --------
    >>> from optlaws import Return, Rise
    >>> plan = Cycle([Rise("35 mm", "0.1 s"), Return()], period="0.25 s").solve()
    >>> plan.status.value, round(plan.objective, 6), round(plan.lower_bound, 6), len(plan.pieces)
    ('optimal', 15.197111, 15.197111, 2)
    >>> Plan.from_json(plan.to_json()).objective == plan.objective
    True
    """

    specification: Cycle = entry(
        ValueOf(Cycle), "The cycle that was specified; the plan has its entries too.", name="cycle"
    )
    solutions: Sequence[Solution] = entry(  # type: ignore[assignment] # the field in place of the answer
        Listed(ValueOf(Solution)), "Of each motion without a given law, in order, with its proof.", default=()
    )
    _: KW_ONLY
    chosen: Sequence[str] = entry(Listed(Text()), "The selection among several optimal laws, in words.", default=())
    bound: float | None = entry(
        Number(),
        "The lower bound of laws of the search space where it does not follow from the solutions: of laws that share a "
        "limit of the whole cycle, or were selected among several optimal ones.",
        default=None,
    )
    checked: bool = field(default=False, compare=False)

    def _check(self) -> None:
        spans = self.specification.layout.spans
        if len(self.solutions) != len(spans):
            raise InputError(f"the cycle has {len(spans)} optimised motions, got {len(self.solutions)} solutions")

    def contradiction(self) -> str:
        """What of its laws contradicts its cycle; empty where they meet its joints and keep its limits."""
        cycle = self.specification
        for span, _, solution in self.laws:
            known = span_problem(span, cycle.in_si)
            if solution.problem.boundary != known.boundary:
                return f"{span.where}: its solution has other ends than its joints"
        if self.bound is not None and self.bound > self.objective * (1.0 + CYCLE_OPTIMALITY):
            return f"its lower bound {self.bound!r} is above its objective {self.objective!r}"
        return "; ".join(f"{taken} is beyond its limit" for taken in self.limits_taken if not taken.is_kept)

    def of_its_problems(self) -> bool:
        """Whether its solutions are of the problems of its cycle, so that their bounds are bounds of the cycle."""
        cycle = self.specification
        for span, _, solution in self.laws:
            known, basis = span_problem(span, cycle.in_si), solution.problem.basis
            if _refines(basis, known.basis):
                known = replace(known, basis=basis)
            if solution.problem != known:
                return False
        return True

    def with_solutions(self, solutions: Sequence[Solution]) -> Plan:
        """The plan of the same cycle with other solutions, as `Cycle.with_solutions`."""
        return self.specification.with_solutions(solutions)

    def to_dict(self) -> dict[str, Any]:
        """The cycle with its solutions, plain and JSON-able, without the names of their formats."""
        data = {"solutions": [], **super().to_dict()}
        del data["cycle"]["format"]
        return data

    def __repr__(self) -> str:
        return f"Plan({self.specification!r}, status={self.status.value!r})"


def _refines(basis: Basis, known: Basis) -> bool:
    """Whether a basis has the pieces of another one, cut into more: no law of this one is below the bound of it."""
    if not isinstance(basis, Pieces) or not isinstance(known, Pieces) or type(basis) is not type(known):
        return False
    alike = (basis.degree, basis.continuity, _straight(basis)) == (known.degree, known.continuity, _straight(known))
    return alike and set(known.breaks) <= set(basis.breaks)


def _straight(basis: Pieces) -> set[tuple[float, ...]]:
    """The ends of straight pieces."""
    return {basis.breaks[i : i + 2] for i in basis.straight} if isinstance(basis, PeriodicPieces) else set()
