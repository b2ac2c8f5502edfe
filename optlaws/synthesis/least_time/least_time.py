"""The least time of a move as a value: the law that takes it, the proof that none is faster, and what would help."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from optlaws.errors import InputError
from optlaws.files.reading import JsonText, entries_of, of_known_format
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.numbers import finite, listed, positive, real
from optlaws.synthesis.least_time.follower_residual import FollowerResidual
from optlaws.synthesis.least_time.motor_torque import MotorTorque
from optlaws.synthesis.least_time.move_limits import MoveLimits, power
from optlaws.synthesis.least_time.time_proof import Multipliers, TimeProof, covers
from optlaws.synthesis.least_time.timed_move import TimedMove
from optlaws.synthesis.problem.constants import meant
from optlaws.synthesis.proof.data import problem_of
from optlaws.synthesis.solution import Solution
from optlaws.synthesis.status import Status
from optlaws.tolerances import BOUND_FEASIBILITY, LEAST_TIME_GAP, MIRROR, PHASE_GAP, STORED_VALUE

_LIMIT_REACHED = 1e-6  # of a limit of a move: where no more of it is left, the law reaches it

_MOST_PROOFS = 100


@dataclass(frozen=True)
class LeastTime(JsonText):
    """The least time of a move within its limits, in units of the stroke and seconds.

    Attributes
    ----------
    move
        The space of laws, the stroke, the limits and the velocities at the ends.
    duration
        The least time, s.
    solution
        The law that takes it: that of the least greatest share of the limits in this time, which is 1.
    proofs
        That no law keeps the limits in a time that is shorter by a millionth or more.

    >>> from optlaws import Problem
    >>> from optlaws.synthesis.least_time.time_search import least_time
    >>> least = least_time(TimedMove(Problem(order=3), 1.0, MoveLimits(jerk=1.0)))
    >>> round(least.duration, 6), round(least.limit, 6), least.binding
    (3.249852, 3.174802, ('jerk',))
    """

    move: TimedMove  #: or a span of a cycle, which is not stored
    duration: float
    solution: Solution
    proofs: tuple[TimeProof, ...]

    _json_name = "a least time"

    @property
    def law(self) -> MotionLaw:
        """The law that takes the least time."""
        return self.solution.law

    @property
    def none_below(self) -> float:
        """The time up to which it is proven that no law of the space keeps the limits, s."""
        if self.proofs:
            return self.proofs[-1].longest
        return max(self.move.least_conceivable(), self.limit or 0.0)

    @property
    def gap(self) -> float:
        """The relative difference between the least time and the longest time that is proven to be too short."""
        return 1.0 - self.none_below / self.duration

    @property
    def status(self) -> Status:
        """Whether the least time is proven, or the least of the search: where a torque is not convex in the law."""
        return Status.OPTIMAL if self.gap <= 2.0 * LEAST_TIME_GAP else Status.LOCAL

    @property
    def limit(self) -> float | None:
        """The time that no law of any degree is faster than, s; None where no closed form is known."""
        return self.move.limit

    @property
    def limit_breaks(self) -> tuple[float, ...]:
        """Breaks of pieces of degree 3 that reach the limit, 1/2 among them; empty where no segments are known."""
        segments = self.move.segments
        if segments is None or not segments.are_reached or self.move.torque is not None:
            return ()
        return tuple(sorted([0.5, *(k for k in segments.breaks if abs(k - 0.5) > MIRROR)]))

    @property
    def price(self) -> float | None:
        """The share by which laws of the problem's space are slower than all laws; None without a limit."""
        return None if self.limit is None else self.duration / self.limit - 1.0

    @kept_property
    def used(self) -> dict[str, float]:
        """The share of each limit that the law uses, 1 where it reaches it."""
        return {limit.name: limit.share(self.law) for limit in self.move.limits_in(self.duration)}

    @property
    def binding(self) -> tuple[str, ...]:
        """The limits that the law reaches and that keep it from being faster."""
        slopes = self.slopes
        return tuple(
            name for name, used in self.used.items() if slopes.get(name, 1.0) > 0.0 and used > 1.0 - _LIMIT_REACHED
        )

    @property
    def slopes(self) -> dict[str, float]:
        """The share of the time that is saved by the share that is added to a limit, of little more, by its multiplier.

        Empty where a torque or what vibrates is limited: the multipliers speak of one time alone.
        """
        if not self.move.of_rates:
            return {}
        multipliers = Multipliers.of(self.move, self.duration, self.solution)
        weighed, left = (
            [(nu, weight * power(self.duration, nu)) for nu, weight in parts]
            for parts in (multipliers.weights, multipliers.ends)
        )
        steep = sum(nu * share for nu, share in weighed) - sum(nu * share for nu, share in left)
        names = (limit.name for limit in self.move.rates)
        return {name: share / steep for name, (_, share) in zip(names, weighed, strict=True)}

    def to_dict(self) -> dict[str, Any]:
        """Plain JSON-able dict: law and proofs in one, which `optlaws verify` checks."""
        move = self.move
        timed = {"torque": move.torque, "residual": move.residual}
        ends = {name: getattr(move, name) for name in _MOVING if getattr(move, name)}
        return (
            {name: limit.to_dict() for name, limit in timed.items() if limit is not None}
            | ends
            | {
                "stroke": move.stroke,
                "limits": move.limits.to_dict(),
                "start_velocity": move.start_velocity,
                "end_velocity": move.end_velocity,
                "duration": self.duration,
                "limit": self.limit,
                "space": move.problem.to_dict(),
                "solution": self.solution.to_dict(),
                "proofs": [proof.to_dict() for proof in self.proofs],
            }
        )

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> LeastTime:
        """Read the output of `to_dict`; the law and the proofs are checked against the move and its limits.

        Raises
        ------
        InputError
            If an entry is missing or wrong, or states what does not follow from the law and the proofs.
        """
        entries = entries_of(data, KEYS, cls._json_name)
        data = of_known_format(data, cls._json_name)
        torque, residual = data.get("torque"), data.get("residual")
        ends = {name: finite(data[name], name) for name in _MOVING if name in data}
        if len(data) > len(KEYS) + (torque is not None) + (residual is not None) + len(ends):
            raise InputError(f"{cls._json_name} has the entries {', '.join(KEYS)} and no other")
        move = TimedMove(
            problem_of(entries["space"]),
            positive(entries["stroke"], "stroke"),
            MoveLimits.from_dict(entries["limits"]),
            finite(entries["start_velocity"], "start_velocity"),
            finite(entries["end_velocity"], "end_velocity"),
            None if torque is None else MotorTorque.from_dict(torque),
            None if residual is None else FollowerResidual.from_dict(residual),
            **ends,
        )
        proofs = tuple(map(TimeProof.from_dict, listed(entries["proofs"], "proofs", _MOST_PROOFS)))
        with meant():
            solution = Solution.from_dict(entries["solution"])
        read = cls(move, positive(entries["duration"], "duration"), solution, proofs)
        read._check(entries["limit"])
        return read

    def _check(self, limit: Any) -> None:
        """Refuse what does not follow from the move."""
        wrong = self.contradiction
        if wrong:
            raise InputError(wrong)
        if not all(proof.stands(self.move) for proof in self.proofs):
            raise InputError("a proof that no law is faster does not show that of its times")
        known, stated = self.limit, real(limit)
        # that in the phase plane is a conic program's
        share = STORED_VALUE if self.move.torque is None else PHASE_GAP
        same = limit is None if known is None else stated is not None and abs(stated - known) <= share * known
        # none was known of ends that move
        same = same or (limit is None and not self.move.at_rest)
        if not same:
            raise InputError(f"the limit of all laws is {limit!r}, but it is {known!r}")

    @property
    def contradiction(self) -> str:
        """Contradictions between the stored values and the law or its proofs; empty if there are none."""
        if self.solution.problem != self.move.shares(self.duration):
            return f"the law is not of the move in {self.duration!r} s"
        if not self.solution.objective <= 1.0 + BOUND_FEASIBILITY:
            return f"the law exceeds a limit {self.solution.objective!r} times"
        claimed = self.duration if self.move.residual is None else self.none_below
        if not covers(self.move, self.proofs, claimed):
            return f"the proofs leave out times that are shorter than the least by more than {LEAST_TIME_GAP:g}"
        return ""


#: of a file, where the end moves so
_MOVING = ("end_acceleration", "end_jerk")
#: of a file
KEYS = ("stroke", "limits", "start_velocity", "end_velocity", "duration", "limit", "space", "solution", "proofs")
