"""The least time of a move as a value, with the proofs that no law is faster: the same multipliers for all times.

Multipliers m of rows |a^(nu)(k)| <= limit T^nu / h leave of every law f(T) = A + V T - sum m limit T^nu / h, in which V
comes from the velocities at the ends: no law keeps the limits where f > 0. It is concave, so that f > 0 at two times is
f > 0 between them; where both ends are at rest it falls, so that f > 0 at a time is f > 0 at every shorter one. With an
acceleration or a jerk at the end it is a polynomial of higher degree, positive where its Bernstein coefficients are.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import inf
from typing import Any, Generic, Self

from numpy.polynomial.polynomial import polyroots

from optlaws.entries.declared import Declared, ValueOf, declared, entry
from optlaws.entries.value_types import Number
from optlaws.errors import InputError, SolverFailure
from optlaws.files.reading import JsonText, entries_of, of_known_format
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.numbers import listed, positive, real
from optlaws.numerics.roots import bisect
from optlaws.synthesis.families import names
from optlaws.synthesis.least_time.move_limits import power
from optlaws.synthesis.least_time.timed_move import Timed, TimedMove, TimedT, control_point, powers_of
from optlaws.synthesis.problem.constants import meant
from optlaws.synthesis.proof.certificate import VIOLATION, Certificate
from optlaws.synthesis.solution import Solution
from optlaws.synthesis.status import Status
from optlaws.tolerances import AGREEMENT, BOUND_FEASIBILITY, LEAST_TIME_GAP, PHASE_GAP, STORED_VALUE

#: how much of the overlap of two intervals is left to the one before
_OVERLAP = 0.25
_DOUBLINGS, _MOST_PROOFS = 1000, 100
_LIMIT_REACHED = 1e-6  # of a limit of a move: where no more of it is left, the law reaches it


@declared
class TimeProof(Declared, title="a proof of a least time"):
    """The proof that no law keeps the limits in any time from the shortest to the longest."""

    shortest: float = entry(Number(least=0.0), "In s; 0 where limits that hold in a time hold in every longer one.")
    longest: float = entry(Number(above=0.0), "In s.")
    certificate: Certificate = entry(
        ValueOf(Certificate),
        "That no law keeps the limits in the longest time. The same multipliers prove it of all others. Where a "
        "vibration that is left is limited: that no law keeps what every law keeps that keeps the limits in some time "
        "of the interval.",
    )

    def _check(self) -> None:
        if self.shortest > self.longest:
            raise InputError(f"the shortest time, {self.shortest!r}, is above the longest, {self.longest!r}")

    def stands(self, move: Timed) -> bool:
        """Whether the multipliers prove the stated time of the move."""
        certificates = self.certificates(move)
        return bool(certificates) and all(proof.proves_infeasible for proof in certificates)

    def certificates(self, move: Timed) -> list[Certificate]:
        """The certificates at the ends of the interval; none where they are not of the move.

        What is proven without the limit of the vibration that is left holds with it.
        """
        if move.residual is not None and self.shortest > 0.0:
            over = move.within(self.longest, self.shortest) if move.stays_possible else None
            proves = self.certificate.problem == over and self.certificate.program == VIOLATION
            return [self.certificate] if proves else []
        move = move.without_residual
        if self.certificate.problem != move.within(self.longest) or self.certificate.program != VIOLATION:
            return []
        if move.stays_possible or self.shortest == self.longest:
            return [self.certificate]
        if move.at_rest:
            return []
        if not move.concave:
            between = move.within_control_points(self.shortest, self.longest)[:-1]
            return [self.certificate, *(replace(self.certificate, problem=problem) for problem in between)]
        return [self.certificate, replace(self.certificate, problem=move.within(self.shortest))]


@dataclass(frozen=True)
class Multipliers:
    """Bounds for all times by the multipliers of one optimum: f(T) = constant + sum of ends T^nu - sum of weights T^nu.

    The weights are those of the limits, constant and ends of what the ends leave, by the order nu.
    """

    certificate: Certificate
    weights: tuple[tuple[int, float], ...]
    constant: float
    ends: tuple[tuple[int, float], ...]

    @classmethod
    def of(cls, move: Timed, duration: float, solution: Solution) -> Multipliers:
        """The multipliers of the least greatest share of the limits in a time."""
        proof, bound, powers = solution.certificate, solution.lower_bound, powers_of(duration)
        shares = [1.0 if len(move.rates) == 1 else 0.0] * len(move.rates)
        for contact in proof.contacts:
            part = names.part_number(contact.constraint)
            if part is not None and len(shares) > 1:
                shares[part - 1] += contact.multiplier
        weights = tuple(
            (limit.nu, share / power(duration, limit.nu)) for limit, share in zip(move.rates, shares, strict=True)
        )
        ends, constant = [], bound
        for i in (i for i, rates in enumerate(move.moving) if any(rates)):
            doubled = tuple(2.0 * each if i == j else each for j, each in enumerate(powers))
            # the sums themselves: a bound would be raised to what no law is below
            share = replace(proof, problem=move.shares(duration, ends=doubled)).estimate - proof.estimate
            ends.append((i + 1, share / powers[i]))
            constant -= share
        return cls(proof, weights, constant, tuple(ends))

    def of_stroke(self, ratio: float) -> Multipliers:
        """These multipliers for a longer or shorter stroke, from rest to rest: the limits are scaled accordingly."""
        return replace(self, weights=tuple((nu, weight / ratio) for nu, weight in self.weights))

    def above(self, duration: float) -> float:
        """The value f at a time: above 0 no law keeps the limits."""
        left = self.constant + sum(end * power(duration, nu) for nu, end in self.ends)
        return left - sum(weight * power(duration, nu) for nu, weight in self.weights)

    @property
    def steepness(self) -> dict[int, float]:
        """The coefficients of f by the order nu, without the constant."""
        steep = dict.fromkeys(sorted({nu for nu, _ in (*self.ends, *self.weights)}), 0.0)
        for nu, end in self.ends:
            steep[nu] += end
        for nu, weight in self.weights:
            steep[nu] -= weight
        return steep

    def longest(self, duration: float) -> float:
        """The time up to which f stays positive, from a time at which it is, or back to a time at which it is not."""
        if self.above(duration) > 0.0:
            high = next(iter(self._roots(duration, 1.0)), inf)
            if high < inf:
                return self._crossing(duration, high)
        factor = 2.0 if self.above(duration) > 0.0 else 0.5
        near = far = duration
        for _ in range(_DOUBLINGS):
            near, far = far, factor * far
            if (self.above(far) > 0.0) == (factor < 1.0):
                break
        return self._crossing(min(near, far), max(near, far))

    def shortest(self, duration: float) -> float:
        """The time down to which f stays positive, from a time at which it is; 0 where it is positive throughout."""
        low = next(iter(self._roots(duration, -1.0)), 0.0)
        if low == 0.0 and self.above(0.0) > 0.0:
            return 0.0
        return self._crossing(duration, low)

    def _roots(self, duration: float, sign: float) -> list[float]:
        """Where f, if not concave, may cross 0 after a time (sign 1) or before it (-1), the nearest first."""
        if all(nu < 2 for nu, _ in self.ends):
            return []
        series = [self.constant, *(self.steepness.get(nu, 0.0) * power(duration, nu) for nu in range(1, 5))]
        known = (duration * float(root.real) for root in polyroots(series) if abs(root.imag) <= AGREEMENT)
        beyond = [root * (1.0 + sign * AGREEMENT) for root in known if root > 0.0 and sign * (root - duration) > 0.0]
        return sorted((root for root in beyond if self.above(root) <= 0.0), key=lambda root: sign * root)

    def _crossing(self, inside: float, outside: float) -> float:
        return bisect(lambda time: self.above(time) > 0.0, inside, outside, _DOUBLINGS)[0]

    def above_between(self, shortest: float, longest: float) -> bool:
        """Whether the Bernstein coefficients of f between two times show that it is above 0 there."""
        steep = self.steepness
        degree = max(steep)
        points = (control_point(shortest, longest, i, degree) for i in range(degree + 1))
        return all(self.constant + sum(a * point[nu - 1] for nu, a in steep.items()) > 0.0 for point in points)


def proof_by(certificate: Certificate, move: Timed, shortest: float, longest: float) -> TimeProof:
    """The proof of an interval by the multipliers of an optimum, without multipliers of the share's parts."""
    problem = move.within(longest, shortest if shortest and move.residual is not None else None)
    # rows of an amplitude are in units of its bound, where it has one, and else of its scale
    units = {
        constant.name: bound.high / constant.scale for constant, bound in problem.bounds.items() if constant.normalised
    }
    of_rows = [
        replace(contact, multiplier=contact.multiplier * units.get(contact.constraint, 1.0))
        for contact in certificate.contacts
        if names.part_number(contact.constraint) is None
    ]
    total = sum(contact.multiplier for contact in of_rows)
    contacts = [replace(contact, multiplier=contact.multiplier / total) for contact in of_rows]
    equations = [multiplier / total for multiplier in certificate.equations]
    return TimeProof(shortest, longest, Certificate.of_leaf(problem, contacts, equations, VIOLATION))


def covering(move: Timed, known: Sequence[tuple[float, Multipliers]], duration: float) -> tuple[TimeProof, ...]:
    """Few proofs that cover every time that is conceivable and shorter than a duration, the shortest times first."""
    least = move.least_conceivable()
    ranges = [(each.shortest(at), each.longest(at), each) for at, each in known]
    proofs: list[TimeProof] = []
    upper = duration
    while upper > least:
        reaching = [(low, -high, i) for i, (low, high, _) in enumerate(ranges) if low < upper <= high]
        if not reaching:
            raise SolverFailure(f"no multipliers speak of the time {upper!r}", problem=move.problem)
        low, _, i = min(reaching)
        lower = 0.0 if move.at_rest else least
        if low > lower:
            before = max((high for start, high, _ in ranges if start < low), default=low)
            lower = low + _OVERLAP * (min(before, upper) - low)
        proofs += _in_parts(ranges[i][2], move, lower, upper)
        upper = lower
    return tuple(reversed(proofs))


def _in_parts(multipliers: Multipliers, move: Timed, shortest: float, longest: float) -> list[TimeProof]:
    middle = 0.5 * (shortest + longest)
    if move.concave or multipliers.above_between(shortest, longest) or not shortest < middle < longest:
        return [proof_by(multipliers.certificate, move, shortest, longest)]
    parts = ((middle, longest), (shortest, middle))
    return [proof for low, high in parts for proof in _in_parts(multipliers, move, low, high)]


@dataclass(frozen=True)
class LeastTime(JsonText, Generic[TimedT]):
    """The least time of a move, or of a span of a cycle, within its limits, in units of the stroke and seconds.

    That of a move alone is stored.

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
    >>> from optlaws.synthesis.least_time.move_limits import MoveLimits
    >>> from optlaws.synthesis.least_time.time_search import least_time
    >>> least = least_time(TimedMove(Problem(order=3), 1.0, MoveLimits(jerk=1.0)))
    >>> round(least.duration, 6), round(least.best_possible, 6), least.binding
    (3.249852, 3.174802, ('jerk',))
    """

    move: TimedT
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
        return max(self.move.least_conceivable(), self.best_possible or 0.0)

    @property
    def gap(self) -> float:
        """The relative difference between the least time and the longest time that is proven to be too short."""
        return 1.0 - self.none_below / self.duration

    @property
    def status(self) -> Status:
        """Whether the least time is proven, or the least of the search: where a torque is not convex in the law."""
        return Status.OPTIMAL if self.gap <= 2.0 * LEAST_TIME_GAP else Status.LOCAL

    @property
    def best_possible(self) -> float | None:
        """The time that no law of any degree is faster than, s; None where no closed form is known."""
        return self.move.best_possible

    @property
    def price(self) -> float | None:
        """The share by which laws of the problem's space are slower than all laws; None where `best_possible` is."""
        return None if self.best_possible is None else self.duration / self.best_possible - 1.0

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

    def to_dict(self: LeastTime[TimedMove]) -> dict[str, Any]:
        """Plain JSON-able dict: law and proofs in one, which `optlaws verify` checks."""
        plain = self.move.to_dict() | {
            "duration": self.duration,
            "best_possible": self.best_possible,
            "solution": self.solution.to_dict(),
            "proofs": [proof.to_dict() for proof in self.proofs],
        }
        return {name: plain[name] for name in (*TimedMove.newer, *KEYS) if name in plain}

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Self:
        """Read the output of `to_dict`; the law and the proofs are checked against the move and its limits.

        Raises
        ------
        InputError
            If an entry is missing or wrong, or states what does not follow from the law and the proofs.
        """
        if isinstance(data, Mapping):
            data = of_known_format(data, cls._json_name)
        entries = entries_of(data, KEYS, cls._json_name)
        if data.keys() - {*KEYS, *TimedMove.newer}:
            raise InputError(f"{cls._json_name} has the entries {', '.join(KEYS)} and no other")
        of_move = TimedMove.tables()[""]
        move: Any = TimedMove.from_dict({name: value for name, value in data.items() if name in of_move})
        proofs = tuple(map(TimeProof.from_dict, listed(entries["proofs"], "proofs", _MOST_PROOFS)))
        with meant():
            solution = Solution.from_dict(entries["solution"])
        read = cls(move, positive(entries["duration"], "duration"), solution, proofs)
        read._check(entries["best_possible"])
        return read

    def _check(self, given: Any) -> None:
        """Refuse what does not follow from the move."""
        wrong = self.contradiction
        if wrong:
            raise InputError(wrong)
        if not all(proof.stands(self.move) for proof in self.proofs):
            raise InputError("the proof that no law is faster does not apply to its times")
        known, stated = self.best_possible, real(given)
        # that in the phase plane is a conic program's
        share = PHASE_GAP if isinstance(self.move, TimedMove) and self.move.torque is not None else STORED_VALUE
        same = given is None if known is None else stated is not None and abs(stated - known) <= share * known
        # none was known of ends that move
        same = same or (given is None and not self.move.at_rest)
        if not same:
            raise InputError(f"best_possible is {given!r}, but the best possible time is {known!r}")

    @property
    def contradiction(self) -> str:
        """Contradictions between the stored values and the law or its proofs; empty if there are none."""
        if self.solution.problem != self.move.shares(self.duration):
            return f"the law is not of the move in {self.duration!r} s"
        if not self.solution.objective <= 1.0 + BOUND_FEASIBILITY:
            return f"the law exceeds a limit {self.solution.objective!r} times"
        move, proofs, conceivable = self.move, self.proofs, self.move.least_conceivable()
        claimed = (self.duration if move.residual is None else self.none_below) * (1.0 - LEAST_TIME_GAP)
        if proofs:
            joined = all(proof.longest == after.shortest for proof, after in pairwise(proofs))
            first = proofs[0].shortest <= (0.0 if move.at_rest else conceivable)
            covered = joined and first and proofs[-1].longest >= claimed
        else:
            # with a torque nothing is claimed but the limit of all laws
            covered = not move.without_residual.of_rates or claimed <= conceivable
        if covered:
            return ""
        return f"the proofs leave out times that are shorter than the least by more than {LEAST_TIME_GAP:g}"


#: of a file
KEYS = (
    "stroke",
    "limits",
    "start_velocity",
    "end_velocity",
    "duration",
    "best_possible",
    "space",
    "solution",
    "proofs",
)
