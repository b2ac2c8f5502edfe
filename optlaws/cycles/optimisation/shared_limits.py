"""The best laws of a cycle, also where they share a limit of the whole, and what no law changes at known joints.

Motors are rated by the root mean square. Each motion is a problem of its own; the limit of a sum joins them. Where a
peak is minimised, the least sum of laws that keep a peak falls with the peak: the least peak is where that sum meets
the limit, and no lower peak is possible where even the lower bounds sum to more. Where a root mean square or a sum is
minimised, a multiplier of the limit separates the motions: their least sum with the multiplier, less multiplier times
limit, is a lower bound.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import accumulate
from math import copysign, exp, inf, log, sqrt
from operator import itemgetter

from optlaws.cycles.optimisation.objectives import SUMS, CycleObjective
from optlaws.cycles.optimisation.optimal import (
    limit_of_drive_holds,
    refuse_too_weak,
    solve,
    solved,
    span_problem,
    with_least_limit,
    with_places,
    with_share,
)
from optlaws.cycles.optimisation.span_values import (
    Laws,
    SpanValue,
    bound_of,
    is_exact,
    size_of,
    span_bound,
    sum_along,
    torque_limit,
    total,
)
from optlaws.cycles.specification.limits import (
    DECELERATION,
    FORCES,
    SPEEDING_UP,
    Side,
    Sides,
    greatest,
    in_units,
    tightest,
)
from optlaws.cycles.specification.programme import REST, LawSpan, Layout, State
from optlaws.errors import InfeasibleProblem, InputError, SolverFailure
from optlaws.kept import kept_property
from optlaws.motion.piece import Piece
from optlaws.motion.quantities import TURN_DEG, Kind, in_small_units
from optlaws.sentences import Amount, joined, sentence
from optlaws.synthesis.functionals.makers import integral
from optlaws.synthesis.least_time.move_limits import MoveLimits, segment_times
from optlaws.synthesis.solution import Solution
from optlaws.tolerances import AGREEMENT, FEASIBILITY

_ACCELERATION_KNOWN = 3
_FORCE = Side(Kind.FORCE)

_LEAST_PEAK_SLACK = 1e-6  # of a least peak, given to problems that are not convex
_PEAK_BRACKET = 1e-11  # of a peak: where a limit is met

_ROUNDS = 8
_FARTHEST = 30.0  # logarithm of a limit's greatest multiplier
#: times the greatest of what is minimised without the limit: up to there the least energy is looked for
_HIGHEST = 8.0
_NONE = 1.0  # by how much a limit counts as missed where there is no law
#: shares of a peak below which it is tried whether none is possible
_BELOW = (2e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2)


@dataclass(frozen=True)
class _End:
    """An end of a stretch with an optimised law, where velocity and acceleration are known."""

    limits: Sides
    name: str
    time: float
    position: float
    state: State
    direction: float

    def demand(self, objective: CycleObjective, kind: Kind) -> float:
        """The velocity or the force there, in SI units; 0 where it is not known."""
        if kind is Kind.VELOCITY:
            return abs(self.state.velocity)
        drive = objective.drive
        if kind is not Kind.FORCE or drive is None:
            return 0.0
        if (drive.linear is None or drive.linear.inertia) and objective.order < _ACCELERATION_KNOWN:
            return 0.0
        velocity = self.state.velocity
        way = copysign(1.0, velocity) if velocity else self.direction
        return abs(float(drive.torque(self.position, *self.state, direction=way, time=self.time)))


def check_limits_at_joints(layout: Layout, objective: CycleObjective, period: float) -> None:
    """Refuse a limit that no law keeps: of slowing down where it turns, of force less than a joint takes."""
    for span in layout.spans:
        of_each = span.sides(objective.limits)
        _check_direction(span, of_each)
        for end in _ends(span, of_each):
            needed = end.demand(objective, Kind.FORCE)
            most = end.limits.get(_FORCE, needed)
            if needed > most * (1.0 + AGREEMENT):
                taken, allowed = (in_units(_FORCE, force, objective.axis) for force in (needed, most))
                raise InfeasibleProblem(
                    sentence(
                        "{}, at {} and {} of the master, every law takes {}, but its limit is {}: allow more, or "
                        "change the drive's spring, preload, gravity or friction",
                        end.name, in_small_units(end.position, objective.axis),
                        Amount(360.0 * end.time / period, "deg"), taken, allowed,
                    )
                )  # fmt: skip


def _check_direction(span: LawSpan, of_each: Sequence[Sides | None]) -> None:
    """Refuse a limit of slowing down where the velocities at the ends turn the motion back."""
    keys = [key for limits in of_each for key in limits or ()]
    against = any(state.velocity * span.displacement < 0.0 for state in (span.first, span.last))
    if against and any(key.kind is Kind.VELOCITY_ALONG for key in keys):
        raise InfeasibleProblem(
            f"{span.where} begins or ends against its way, so that it turns back, which its velocity must not"
        )
    if span.may_turn and any(key.name in {DECELERATION, SPEEDING_UP} for key in keys):
        raise InputError(
            f"{span.where} begins or ends against its way, so that slowing down is of no one direction: give its "
            "acceleration as the least and the greatest, such as ('-8 m/s^2', '12 m/s^2'), in place of a deceleration"
        )


def _ends(span: LawSpan, of_each: Sequence[Sides | None]) -> Iterator[_End]:
    """The ends of stretches of a span at which its motion is known."""
    inner = (None,) * (len(span.stretches) - 1)
    states = (*span.states, span.states[0]) if span.turns else (span.first, *inner, span.last)
    positions = list(accumulate((stretch.displacement for stretch in span.stretches), initial=span.offset))
    times = (*span.starts, span.stop)
    direction = 0.0 if span.may_turn else 1.0 if span.displacement > 0.0 else -1.0
    for i, limits in enumerate(of_each):
        for j, name in ((i, "start"), (i + 1, "end")) if limits is not None else ():
            where, state = f"{span.stretches[i].where}: at its {name}", states[j]
            if state is not None:
                yield _End(limits or {}, where, times[j], positions[j], state, direction)


def ties_broken(layout: Layout, objective: CycleObjective, laws: Laws, period: float) -> tuple[Laws, tuple[str, ...]]:
    """The laws of least acceleration among laws of least peak, where the peak is at a joint or in a given segment.

    There no law changes the peak of the velocity or force, so that many take no more elsewhere. Beside the laws: a
    remark that says so.
    """
    kind = objective.kind
    if objective.mean or kind not in {Kind.VELOCITY, Kind.FORCE} or not laws:
        return laws, ()
    known = [(size_of(piece, kind, objective.drive), piece.start) for piece in layout.pieces]
    ends = (end for span in layout.spans for end in _ends(span, span.sides(objective.limits)))
    known += [(end.demand(objective, kind), end.time) for end in ends]
    greatest, time = max(known, key=itemgetter(0), default=(0.0, 0.0))
    if max(size_of(piece, kind, objective.drive) for piece, _ in laws) > greatest * (1.0 + AGREEMENT):
        return laws, ()
    limits = tightest(objective.limits, {kind: (-greatest, greatest)})
    calm = replace(objective, minimise="acceleration", limits=limits)
    remark = sentence(
        "the {} is greatest at {} of the master, where no law changes it: of the laws that take no more elsewhere, "
        "those of least acceleration",
        objective.minimise, Amount(360.0 * time / period, "deg"),
    )  # fmt: skip

    def calmer(span: LawSpan, law: tuple[Piece, Solution]) -> tuple[Piece, Solution]:
        try:
            return solve(span, calm)
        except (InfeasibleProblem, SolverFailure):
            return law

    return tuple(map(calmer, layout.spans, laws)), (remark,)


@dataclass(frozen=True)
class Best:
    """The best laws of a cycle with their solutions, and the choice among equals.

    The lower bound in their spaces stands beside them where it does not follow from their own bounds.
    """

    laws: Laws
    remarks: tuple[str, ...]
    bound: float | None


def best_of(layout: Layout, objective: CycleObjective, period: float) -> Best:
    """The best laws of all spans; of none, without a bound of what is given."""
    if not layout.spans:
        return Best((), (), None)
    for span in layout.spans:
        refuse_too_weak(span, objective)
    if objective.shares and objective.drive is None:
        raise InputError(
            "limits: the RMS force and the energy of a cycle are of a drive: give one, such as drive={'mass': '2 kg'}"
        )
    try:
        if objective.shares:
            return _SharedLimit(layout, objective, period).best()
        laws = tuple(_solved(span, objective, period) for span in layout.spans)
    except InfeasibleProblem as error:
        raise _with_least_times(error, layout.spans, objective, period) from None
    chosen, remarks = ties_broken(layout, objective, laws, period)
    return Best(chosen, remarks, bound_of(layout, laws, objective, period) if remarks else None)


def _solved(span: LawSpan, objective: CycleObjective, period: float) -> tuple[Piece, Solution]:
    try:
        return solve(span, objective)
    except InfeasibleProblem as error:
        wider = with_least_limit(error, span, objective)
        wider.tried = with_places(wider.tried, span.starts[0], span.stop, period)
        raise wider from None


def _with_least_times(
    error: InfeasibleProblem, spans: Sequence[LawSpan], objective: CycleObjective, period: float
) -> InfeasibleProblem:
    """The error of one move, saying of all moves between rests that are too short how long any law takes."""
    times = [text for span in spans if (text := _least_time(span, objective, period))]
    error.args = (joined("; ", [error.args[0], *times]),)
    return error


def _least_time(span: LawSpan, objective: CycleObjective, period: float) -> str:
    """A sentence on the time that laws of any degree take within limits of derivatives, where the span has less."""
    if span.turns or span.via or len(span.stretches) > 1 or (span.first, span.last) != (REST, REST):
        return ""
    (sides,), way = span.sides(objective.limits), copysign(1.0, span.stroke)
    limits = (
        greatest(sides or {}, kind, direction)
        for kind, direction in (
            (Kind.VELOCITY, way),
            (Kind.ACCELERATION, way),
            (Kind.ACCELERATION, -way),
            (Kind.JERK, 0.0),
        )
    )
    known = MoveLimits(*(None if most == inf else most for most in limits))
    fastest = segment_times(abs(span.stroke), known, objective.order)
    if fastest is None or fastest.duration <= span.duration * (1.0 + AGREEMENT):
        return ""
    least, available = (
        sentence("{} ({})", Amount(time, "s"), Amount(TURN_DEG * time / period, "deg"))
        for time in (fastest.duration, span.duration)
    )
    return sentence(
        "{}: within its limits any law takes {} or more, and it has {}", span.stretches[0].where, least, available
    )


@dataclass(frozen=True)
class _SharedLimit:
    """Spans that share a limit of a sum over their motions: the squared force, or the energy."""

    layout: Layout
    objective: CycleObjective
    period: float

    def best(self) -> Best:
        """The best laws of all spans."""
        if self.left <= 0.0:
            raise self._too_much(self._given, "what is given takes")
        self._refuse_too_little()
        if len(self.layout.spans) == 1:
            return self._alone()
        laws = self._laws(self.objective)
        bound = bound_of(self.layout, laws, self.objective, self.period)
        if self._taken(laws) <= self.left * (1.0 + FEASIBILITY):
            return Best(laws, (), bound)
        summed = self.objective.mean or self.objective.kind in SUMS
        if summed and self._kind is Kind.ENERGY:
            # the least energy has no bound without one of the acceleration
            return self._by_multiplier(laws, bound or 0.0)
        least = self._least(inf if self._kind is Kind.FORCE else _HIGHEST * self._greatest(laws))
        if self._least_taken(least) > self.left:
            raise self._too_much(self._given + self._least_taken(least), "no law takes less than")
        return self._by_multiplier(laws, bound or 0.0) if summed else self._by_peak(laws, least, bound or 0.0)

    @property
    def _kind(self) -> Kind:
        """The summed and limited quantity."""
        return Kind.FORCE if self.objective.mean_force is not None else Kind.ENERGY

    @property
    def most(self) -> float:
        """The limit of the sum: of the squared force, or of the energy in J."""
        if self.objective.mean_force is not None:
            return self.objective.mean_force**2 * self.period
        return self.objective.energy or 0.0

    @property
    def left(self) -> float:
        return self.most - self._given

    @kept_property
    def _given(self) -> float:
        """The share of the sum that dwells and given laws take."""
        return total(self.layout.pieces, self._kind, self.objective.drive)

    def _too_much(self, taken: float, why: str) -> InfeasibleProblem:
        energy = self._kind is Kind.ENERGY
        most, least = (value if energy else sqrt(value / self.period) for value in (self.most, taken))
        what = "energy" if energy else f"RMS {FORCES[self.objective.axis]}"
        return InfeasibleProblem(
            f"limits: the {what} over the cycle is to be at most {most:.9g}, but {why} {least:.9g}: allow more, or "
            "give the cycle more time"
        )

    def _refuse_too_little(self) -> None:
        """Refuse an RMS force that no law has, by the limits of all laws, where the usual law has more of it."""
        from optlaws.laws.catalogue.catalogue import USUAL, catalogue

        spans, objective, usual = self.layout.spans, self._of_sum(), catalogue[USUAL].law
        if self._kind is not Kind.FORCE or not all(limit_of_drive_holds(span, objective) for span in spans):
            return
        if total([span.by(usual) for span in spans], Kind.FORCE, objective.drive) <= self.left:
            return
        known = [(span.duration, torque_limit(span, objective, "rms torque")) for span in spans]
        least = sum(duration * limit.value**2 for duration, limit in known if limit is not None)
        if least > self.left:
            raise self._too_much(self._given + least, "no law, of whatever degree, takes less than")

    @property
    def _exact(self) -> bool:
        """Whether the sought laws are optimised and judged by the same quantity."""
        return all(is_exact(span, self.objective) for span in self.layout.spans)

    def _laws(self, objective: CycleObjective) -> Laws:
        return tuple(solve(span, objective) for span in self.layout.spans)

    def _alone(self) -> Best:
        """The only span takes the whole remainder; the limit is lowered where friction takes more than estimated."""
        (span,) = self.layout.spans
        allowed, bound = self.left, inf
        for _ in range(_ROUNDS):
            laws = (self._within(span, allowed),)
            bound = min(bound, bound_of(self.layout, laws, self.objective, self.period) or 0.0)
            over = self._taken(laws) - self.left
            if over <= FEASIBILITY * self.left:
                return Best(laws, (), bound)
            allowed -= over
        raise SolverFailure(f"{span.where}: no law was found whose RMS force with dry friction keeps its limit")

    def _within(self, span: LawSpan, allowed: float) -> tuple[Piece, Solution]:
        try:
            return solve(span, self.objective, allowed)
        except InfeasibleProblem:
            if self._kind is Kind.FORCE and (least := self._least_taken(self._least(inf))) > self.left:
                raise self._too_much(self._given + least, "no law takes less than") from None
            raise

    def _taken(self, laws: Laws) -> float:
        """The laws' contribution to the sum."""
        return total([piece for piece, _ in laws], self._kind, self.objective.drive)

    def _least_taken(self, laws: Laws) -> float:
        """The lower bound of the sum, from laws that take the least of it."""
        spans = zip(self.layout.spans, laws, strict=True)
        bounds = [(span.duration, span_bound(span, solution, self._of_sum())) for span, (_, solution) in spans]
        return sum(bound if self._kind is Kind.ENERGY else duration * bound**2 for duration, bound in bounds)

    def _of_sum(self, peak: float = inf) -> CycleObjective:
        """The objective of the least sum, where what is minimised is at most a peak."""
        limits, kind = self.objective.limits, self.objective.kind
        if not self.objective.mean and kind not in SUMS and peak < inf:
            limits = tightest(limits, {kind: (-peak, peak)})
        return replace(self.objective, minimise="energy" if self._kind is Kind.ENERGY else "rms force", limits=limits)

    def _least(self, peak: float) -> Laws:
        return self._laws(self._of_sum(peak))

    def _by_peak(self, laws: Laws, least: Laws, bound: float) -> Best:
        """The least peak at which laws keep the limit, and one below it at which none do."""
        from scipy.optimize import brentq

        tried: dict[float, Laws] = {}

        def over(peak: float) -> float:
            try:
                tried[peak] = self._least(peak)
            except (InfeasibleProblem, SolverFailure):
                # so near the least peak that no law is found any more
                return _NONE
            return log(self._taken(tried[peak]) / self.left)

        convex = all(solution.problem.convex for _, solution in laws)
        low = self._greatest(laws) * (1.0 + (_BELOW[0] if convex else _LEAST_PEAK_SLACK))
        high = self._greatest(least)
        if over(low) > 0.0:
            brentq(over, low, high, xtol=_PEAK_BRACKET * high, rtol=_PEAK_BRACKET)
            tried.setdefault(high, least)
        least_peak = min(peak for peak, laws in tried.items() if self._taken(laws) <= self.left * (1.0 + FEASIBILITY))
        return Best(tried[least_peak], (), max(bound, self._impossible(least_peak, bound)))

    def _impossible(self, peak: float, bound: float) -> float:
        """A peak just below the optimum for which no laws satisfy the shared limit."""
        for lower in (peak * (1.0 - share) for share in _BELOW if self._exact):
            if lower <= bound:
                return bound
            try:
                laws = self._least(lower)
            except InfeasibleProblem:
                return lower
            except SolverFailure:
                continue
            if self._least_taken(laws) > self.left:
                return lower
        return bound

    def _greatest(self, laws: Laws) -> float:
        """The greatest value of the objective over the whole cycle, for any laws."""
        pieces = [*(piece for piece, _ in laws), *self.layout.pieces]
        return max(size_of(piece, self.objective.kind, self.objective.drive) for piece in pieces)

    def _by_multiplier(self, laws: Laws, bound: float) -> Best:
        """The least root mean square or sum, by the limit's multiplier; `bound` is the bound without the limit."""
        from scipy.optimize import brentq

        tried: dict[float, Laws] = {}
        kind, drive = self.objective.kind, self.objective.drive

        def over(multiplier: float) -> float:
            tried[multiplier] = tuple(self._with_multiplier(span, exp(multiplier)) for span in self.layout.spans)
            return log(self._taken(tried[multiplier]) / self.left)

        first = log(abs(total([piece for piece, _ in laws], kind, drive)) / self._taken(laws))
        low, high = first - 2.0, first + 2.0
        while over(low) < 0.0:
            low -= 4.0
        while over(high) > 0.0:
            if high > first + _FARTHEST:
                raise SolverFailure(
                    "limits: the limit over the whole cycle cannot be met as near as it is possible: allow more"
                )
            high += 4.0
        brentq(over, low, high, xtol=_PEAK_BRACKET, rtol=_PEAK_BRACKET)
        least = min(
            multiplier for multiplier, laws in tried.items() if self._taken(laws) <= self.left * (1.0 + FEASIBILITY)
        )
        attained = total([*self.layout.pieces, *(piece for piece, _ in tried[least])], kind, drive)
        # the laws may miss the limit by a rounding, the bound is of those that keep it: it is no better than they are
        proven = max(self._bound_with_multiplier(tried[least], exp(least)), bound)
        return Best(tried[least], (), min(proven, self._of_total(attained)))

    def _with_multiplier(self, span: LawSpan, multiplier: float) -> tuple[Piece, Solution]:
        """The law of a span that minimises the objective plus a multiple of the limited quantity."""
        minimised, limited = self._sums(span)
        weight = multiplier * limited.unit / minimised.unit
        formula = f"{minimised.formula} + ({weight!r})*({limited.formula})"
        plain = replace(span_problem(span, self.objective), minimise=integral(formula))
        # the limit as if the others took nothing: it only says how great laws may be
        solution = solved(with_share(plain, span, self.objective, self.left), span)
        return span.by(solution.law), solution

    def _bound_with_multiplier(self, laws: Laws, multiplier: float) -> float:
        """The lower bound for laws that keep the limit: the bound with the multiplier, less multiplier times limit."""
        if not self._exact:
            return 0.0 if self.objective.kind not in SUMS else -inf
        least = -multiplier * self.left + total(self.layout.pieces, self.objective.kind, self.objective.drive)
        for span, (_, solution) in zip(self.layout.spans, laws, strict=True):
            minimised, limited = self._sums(span)
            least += minimised.unit * solution.lower_bound + minimised.constant + multiplier * limited.constant
        return self._of_total(least)

    def _sums(self, span: LawSpan) -> Sequence[SpanValue]:
        """The objective and the limited quantity over a span."""
        return [sum_along(span, self.objective.drive, kind) for kind in (self.objective.kind, self._kind)]

    def _of_total(self, taken: float) -> float:
        """A sum in the form of the objective: a root mean square, or an energy."""
        return taken if self.objective.kind in SUMS else sqrt(max(taken, 0.0) / self.period)
