"""The search for the least period: the least time of every motion, the period that they need, and the laws in it.

A motion between rests that keeps its limits in a time keeps them in every longer one: run slower, each derivative is
less. So does a whole cycle whose durations all turn with the master. The least period is then that of the motion that
needs most, or what free motions, dwells in seconds and angles sum to; a period that is shorter by a little leaves one
motion less than its least time, in which no law keeps its limits.

Within a limit of the root mean square of the force over the whole cycle, as motors are rated, the motions take least
where each takes its least mean square; the cycle is too fast where their sum is above the limit. Run slower, the force
is between the static one and the one before, and so is its root mean square: a cycle that keeps the limit keeps it at
every lower speed, where the static force does. Lower bounds of the mean squares a little faster, each by its
certificate, prove that no laws keep it there.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import exp, inf, isfinite, log, sqrt

from optlaws.cycles.greatest_speed.timed_spans import (
    TimedSpan,
    least_scale,
    limits_of_span,
    slower,
    static_force,
)
from optlaws.cycles.optimisation.objectives import CycleObjective
from optlaws.cycles.optimisation.optimal import forward_windows, joint_windows, solve, span_problem, unlimited
from optlaws.cycles.optimisation.span_values import known_drive, span_bound
from optlaws.cycles.specification.limits import (
    FORCES,
    Sides,
    in_units,
    of_segments,
    raised,
    word_of,
)
from optlaws.cycles.specification.periods import DurationRange, duration_ranges, durations_at, least_period
from optlaws.cycles.specification.programme import LawSpan, Layout, Programme, State, TimedSegment, layout
from optlaws.cycles.specification.segments import Dwell
from optlaws.errors import InfeasibleProblem, InputError, SolverFailure
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.mechanisms.drives.drive_train import Drive
from optlaws.mechanisms.drives.effort import PieceEffort
from optlaws.motion.piece import Piece, factor, jump_beside
from optlaws.motion.quantities import Kind
from optlaws.numerics.roots import falling_root
from optlaws.sentences import quantity_name, sentence
from optlaws.synthesis.least_time.move_limits import SpanLimit
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.proof.certificate import VIOLATION, Certificate
from optlaws.synthesis.solution import Solution
from optlaws.synthesis.status import Status
from optlaws.tolerances import AGREEMENT, BINDING_LIMIT, CLOSURE, FASTER, LEAST_SCALE_MET, SAME_TIME

#: so many times slower every limit of a derivative is kept
_SLOW = 1e4
_JERK = 3


@dataclass(frozen=True)
class FastestSearch:
    """A cycle whose least period is sought; `more` maps limit names to the factors that raise them."""

    programme: Programme
    objective: CycleObjective
    more: Mapping[str, float]

    @kept_property
    def ranges(self) -> tuple[DurationRange, ...]:
        return duration_ranges([stretch.given for stretch in self.programme.stretches])

    @property
    def turning(self) -> bool:
        return all(given.turns for given in self.ranges)

    @kept_property
    def spans(self) -> tuple[TimedSpan, ...]:
        """The motions that have limits, each with its least time."""
        spans = [*map(self._of_piece, self._layout.pieces), *map(self.fastest, self._layout.spans)]
        for span in spans:
            self._check(span)
        limited = [span for span in spans if span.along]
        if not limited and self.objective.mean_force is None:
            raise InputError(
                "no limit bounds the motions, so that every speed is possible: give limits of the cycle or of its "
                "segments, such as limits={'acceleration': '12 m/s^2'}"
            )
        return tuple(sorted(limited, key=lambda span: span.places))

    @kept_property
    def period(self) -> float:
        return self.unrated if self.rating is None else self.rating.period

    @kept_property
    def rating(self) -> ForceRating | None:
        """The limit of the root mean square of the force over the cycle; None without such a limit."""
        if self.objective.mean_force is None:
            return None
        if not self.turning:
            raise InputError(
                "limits: an RMS force or torque of a cycle that is to be fastest is of one that turns as a whole: give "
                "all durations as angles"
            )
        return ForceRating(self)

    @kept_property
    def binding_rating(self) -> ForceRating | None:
        """That limit where the cycle is slower by it than by its other limits."""
        slower_by_it = self.rating is not None and self.rating.period > self.unrated * (1.0 + AGREEMENT)
        return self.rating if slower_by_it else None

    @kept_property
    def unrated(self) -> float:
        """The least period by the limits of the segments, in seconds."""
        period, turned = self._summed([span.scale for span in self.spans])
        if period > turned and not self.turning:
            durations = durations_at(self.ranges, self.needed, period)
            for stretch, time in zip(self.programme.stretches, durations, strict=True):
                if time <= SAME_TIME * self.programme.period:
                    raise InputError(
                        f"{stretch.where} has no duration of its own, and would vanish at the greatest speed: "
                        "give it a least duration, such as duration=('20 ms', '10 s')"
                    )
        return period

    @property
    def best_possible(self) -> float | None:
        """A period that no laws of any degree beat, in seconds; None where it is not known of a motion that binds."""
        if self.binding_rating is not None or any(span.best_possible is None for span in self.binding):
            return None
        return self._summed([span.best_possible or 0.0 for span in self.spans])[0]

    def _summed(self, scales: Sequence[float]) -> tuple[float, float]:
        """The least period at which motions have such scales of their times, and that of those which turn alone."""
        turning = [scale for span, scale in zip(self.spans, scales, strict=True) if self._turns(span)]
        turned = max(turning, default=0.0) * self.programme.period
        return max(turned, least_period(self.ranges, self._alone(scales))), turned

    def _alone(self, scales: Sequence[float]) -> tuple[float, ...]:
        # the least duration of each segment in seconds, by its own limits; 0 without any
        timed = zip(self.spans, scales, strict=True)
        alone = {span.places[0]: span.duration * scale for span, scale in timed if len(span.places) == 1}
        return tuple(alone.get(i, 0.0) for i in range(len(self.ranges)))

    @property
    def needed(self) -> tuple[float, ...]:
        return self._alone([span.scale for span in self.spans])

    @kept_property
    def durations(self) -> tuple[float, ...]:
        """The durations of the segments at the least period."""
        return durations_at(self.ranges, self.needed, self.period)

    @property
    def binding(self) -> tuple[TimedSpan, ...]:
        """The motions that have no more than their least time."""
        return tuple(
            span
            for span in self.spans
            if span.needed >= self.time_of(span) * (1.0 - BINDING_LIMIT) and not self._stays(span)
        )

    @property
    def status(self) -> Status:
        """Optimal where it is proven that no shorter period will do.

        Of motions that turn with the master one that has no time left is enough. Where free motions sum to the period,
        one of them would have less than its least time, and any of them may be it.
        """
        if not all(row.scales for span in self.spans for row in span.along):
            return Status.LOCAL
        if (rating := self.binding_rating) is not None:
            return Status.OPTIMAL if rating.scales and rating.proofs is not None else Status.LOCAL
        binding = self.binding
        proven = [span.problem is None or span.proof is not None for span in binding]
        turning = any(self._turns(span) and known for span, known in zip(binding, proven, strict=True))
        return Status.OPTIMAL if turning or all(proven) else Status.LOCAL

    @property
    def binding_limits(self) -> tuple[str, ...]:
        """The keys of the limits by which the speed is greatest."""
        if self.binding_rating is not None:
            return (self.binding_rating.name,)
        rows = (row for span in self.binding for row in span.binding)
        return tuple(dict.fromkeys(word_of(row.key, self.programme.axis) for row in rows))

    @property
    def proofs(self) -> dict[str, Certificate]:
        """The certificates that the motions have no laws a little faster, by their names."""
        if self.binding_rating is not None:
            return self.binding_rating.proofs or {}
        known = ((span.where, span.proof) for span in self.binding if span.proof is not None)
        return {where + ("" if proof.program == VIOLATION else ", least power"): proof for where, proof in known}

    def alone(self, i: int) -> LawSpan:
        """A move by itself, from rest to rest whatever is beside it."""
        starts = self._layout.starts
        return LawSpan.of(self.programme.stretches[i], starts[i], starts[i + 1], self.programme.offsets[i])

    def of_law(self, span: LawSpan, law: MotionLaw) -> TimedSpan:
        """A span with a law within its limits."""
        self._check_way(span.stretches[0], span.by(law))
        return TimedSpan(span, span.duration, self._limits(span), given=law)

    def fastest(self, span: LawSpan) -> TimedSpan:
        """A span with its limits and all laws; without a law where nothing limits it."""
        limits = self._limits(span)
        return TimedSpan(span, span.duration, limits, self._base(span) if limits else None)

    def time_of(self, span: TimedSpan) -> float:
        """The time that a motion has at the least period."""
        return sum(self.durations[i] for i in span.places)

    def laws(self) -> Layout:
        """The laws at the least period: the fastest where there is no time left, else the best within the limits."""
        placed, rating, rated = self.placed(self.period), self.rating, self.binding_rating
        pieces = [] if rated else [*placed.pieces, *map(self._law, placed.spans)]
        if rating is not None and (rated or rating.square(pieces) > rating.most**2 * self.period * (1.0 + AGREEMENT)):
            # the best laws share the limit as the fastest cycle does: each takes least of it
            pieces = [*placed.pieces, *rating.laws(self.period)]
        return Layout(placed.starts, tuple(sorted(pieces, key=lambda piece: piece.start)), ())

    def _law(self, span: LawSpan) -> Piece:
        known = self._known(span)
        if known is None or known.law is None or known.needed < span.duration * (1.0 - BINDING_LIMIT):
            return self.solved(span, self.objective)[0]
        return span.by(known.law)

    def solved(self, span: LawSpan, objective: CycleObjective) -> tuple[Piece, Solution | None]:
        """The best law of a span in its place; without a solution the fastest, where none is found."""
        try:
            return solve(span, objective)
        except (InfeasibleProblem, SolverFailure):
            known = self._known(span)
            if known is None or known.law is None:
                raise
            return span.by(known.law), None

    def _known(self, span: LawSpan) -> TimedSpan | None:
        return next((known for known in self.spans if known.span.stretches == span.stretches), None)

    def placed(self, period: float) -> Layout:
        """The pieces and spans at a period."""
        if not self.turning:
            return layout(self.programme, durations_at(self.ranges, self.needed, period))
        share, given = period / self.programme.period, self._layout
        pieces = (replace(piece, start=piece.start * share, duration=piece.duration * share) for piece in given.pieces)
        starts, spans = (start * share for start in given.starts), (slower(span, share) for span in given.spans)
        return Layout(tuple(starts), tuple(pieces), tuple(spans))

    @kept_property
    def _layout(self) -> Layout:
        """The pieces and spans at the given period, where free segments have equal shares of the remaining time."""
        given = self.programme.stretches
        left = self.programme.period - sum(stretch.least for stretch in given if stretch.fixed)
        free = sum(not stretch.fixed for stretch in given)
        placed = layout(self.programme, [stretch.least if stretch.fixed else left / free for stretch in given])
        return replace(placed, spans=tuple(map(_at_rest, placed.spans)))

    def _of_piece(self, piece: Piece) -> TimedSpan:
        i = next(
            i
            for i, start in enumerate(self._layout.starts)
            if abs(start - piece.start) <= SAME_TIME * self.programme.period
        )
        stretch = self.programme.stretches[i]
        first, last = (State(piece.end(1, side) if piece.leaves(side) else 0.0, 0.0) for side in (0, 1))
        span = LawSpan.of(stretch, piece.start, piece.stop, piece.offset, first, last)
        still = isinstance(stretch.given, Dwell) or piece.stroke == 0.0
        if not still:
            self._check_way(stretch, piece)
        timed = TimedSpan(span, piece.duration, () if still else self._limits(span), given=piece.law)
        jerked = [limit for limit in timed.along if limit.nu >= _JERK]
        jumps = jerked and jump_beside(piece, self._layout.pieces, self.programme.period) is not None
        if jumps or not isfinite(timed.scale):
            endless = (limit for limit in timed.along if not isfinite(least_scale(limit, piece.law)))
            limit = jerked[0] if jumps else next(endless)
            raise InfeasibleProblem(
                sentence(
                    "{}: its law jumps, so that no speed keeps {}: take a smoother law, or leave that limit out",
                    stretch.where, in_units(limit.key, limit.most, self.programme.axis),
                )
            )  # fmt: skip
        return timed

    def _check_way(self, stretch: TimedSegment, piece: Piece) -> None:
        (low, _), (high, _) = piece.extremes(1, piece.start, piece.stop)
        for key in stretch.sides(self.objective.limits):
            back = high if key.sign > 0.0 else -low
            if key.kind is Kind.VELOCITY_ALONG and back > AGREEMENT * max(high, -low):
                raise InfeasibleProblem(
                    f"{stretch.where}: its law goes back, which its velocity must not at any speed: take another law, "
                    "or a least velocity below 0"
                )

    def _limits(self, span: LawSpan) -> tuple[SpanLimit, ...]:
        axis, limits = self.programme.axis, list[Sides]()
        for stretch in span.stretches:
            given = stretch.sides(self.objective.limits)
            limits.append({key: most * self.more.get(word_of(key, axis), 1.0) for key, most in given.items()})
        return tuple(limits_of_span(span, limits, self.objective))

    def _base(self, span: LawSpan) -> Problem:
        limited = span_problem(slower(span, _SLOW), self.objective)
        several = span.turns or len(span.stretches) > 1 or span.via
        windows = (
            [*joint_windows(span, self.objective.order), *forward_windows(span, span.sides(self.objective.limits))]
            if several
            else ()
        )
        return replace(unlimited(limited), windows=tuple(windows), minimise="C")

    def _turns(self, span: TimedSpan) -> bool:
        return all(self.ranges[i].turns for i in span.places)

    def _stays(self, span: TimedSpan) -> bool:
        return all(self.ranges[i].fixed and not self.ranges[i].turns for i in span.places)

    def _check(self, span: TimedSpan) -> None:
        if self.turning:
            return
        if len(span.places) > 1 and not self._turns(span):
            raise InputError(f"{span.where} are one law: give all their durations as angles, so that it turns as one")
        if any((*span.span.first, *span.span.last)):
            raise InputError(
                f"{span.where} moves where it begins or ends, which fits its neighbours at one speed alone: give all "
                "durations as angles, so that velocities turn with the master"
            )
        if self._stays(span) and span.scale > 1.0 + CLOSURE:
            raise InfeasibleProblem(
                f"{span.where} takes {span.duration:.9g} s at any speed, but within its limits no law takes less than "
                f"{span.needed:.9g} s: give it more time, wider limits, or an angle of the master"
            )


def _at_rest(span: LawSpan) -> LawSpan:
    # end states that differ from rest by rounding only are exact rest: proofs assume it
    way = abs(span.stroke) * SAME_TIME
    first, last = (
        State(*(0.0 if abs(value) <= factor(way, span.duration, nu) else value for nu, value in enumerate(state, 1)))
        for state in (span.first, span.last)
    )
    return replace(span, first=first, last=last)


@dataclass(frozen=True)
class ForceRating:
    """The limit of the root mean square of the force over a cycle whose motions all turn with the master."""

    search: FastestSearch

    @property
    def drive(self) -> Drive:
        return known_drive(self.search.objective.drive)

    @property
    def name(self) -> str:
        return f"rms {FORCES[self.search.programme.axis]}"

    @property
    def most(self) -> float:
        return (self.search.objective.mean_force or inf) * self.search.more.get(self.name, 1.0)

    @kept_property
    def period(self) -> float:
        least = self.search.unrated
        if least and self._over(least) <= 0.0:
            return least
        begin = log(least or self.search.programme.period)
        period = exp(falling_root(lambda logarithm: self._over(exp(logarithm)), begin, log(1.5), LEAST_SCALE_MET))
        if period == inf:
            raise InfeasibleProblem(
                f"limits: no speed keeps the {quantity_name(self.name)} of {self.most:.9g}: the static load alone "
                "needs more: allow more, or change the drive's spring, preload, gravity or friction"
            )
        return period * (1.0 + 2.0 * LEAST_SCALE_MET)

    def square(self, pieces: Sequence[Piece]) -> float:
        """The integral of the squared force over pieces."""
        return sum(PieceEffort(self.drive, piece).square for piece in pieces)

    def laws(self, period: float) -> list[Piece]:
        """The laws of least mean square of the force at a period, within the other limits."""
        return [self.search.solved(span, self._objective)[0] for span in self.search.placed(period).spans]

    @kept_property
    def proofs(self) -> dict[str, Certificate] | None:
        """The certificates of lower bounds a little faster, whose sum is above the limit; None where it is not."""
        period = self.period * (1.0 - FASTER)
        placed = self.search.placed(period)
        square, proofs = self.square(placed.pieces), {}
        for span in placed.spans:
            solution = self.search.solved(span, self._objective)[1]
            if solution is None:
                return None
            square += span.duration * span_bound(span, solution, self._objective) ** 2
            proofs[f"{span.where}, least {self.name}"] = solution.certificate
        return proofs if square > self.most**2 * period else None

    @property
    def scales(self) -> bool:
        """Whether a cycle that keeps the limit keeps it at every lower speed."""
        drive, given = self.drive.linear, self.search.placed(self.search.programme.period)
        if drive is None or (drive.viscous and (drive.stiffness or drive.constant)):
            return False
        return all(static_force(span, self.drive)[1] <= self.most for span in given.spans)

    @kept_property
    def _objective(self) -> CycleObjective:
        objective, axis = self.search.objective, self.search.programme.axis
        limits = of_segments(raised(objective.limits, self.search.more, axis))
        return replace(objective, minimise="rms force", limits=limits)

    def _over(self, period: float) -> float:
        pieces = [*self.search.placed(period).pieces, *self.laws(period)]
        return log(sqrt(self.square(pieces) / period) / self.most)
