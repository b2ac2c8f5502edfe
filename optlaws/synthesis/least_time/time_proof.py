"""Proofs that no law keeps the limits of a move in any time of an interval: one set of multipliers for all of them.

Multipliers m of rows |a^(nu)(k)| <= limit T^nu / h leave of every law f(T) = A + V T - sum m limit T^nu / h, in which V
comes from the velocities at the ends: no law keeps the limits where f > 0. It is concave, so that f > 0 at two times is
f > 0 between them; where both ends are at rest it falls, so that f > 0 at a time is f > 0 at every shorter one.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

from optlaws.errors import InputError, SolverFailure
from optlaws.files.reading import JsonText, all_entries_of
from optlaws.numbers import not_negative, positive
from optlaws.synthesis.families import names
from optlaws.synthesis.least_time.move_limits import TimedMove, power
from optlaws.synthesis.proof.certificate import VIOLATION, Certificate
from optlaws.synthesis.proof.nodes import Contact
from optlaws.synthesis.solution import Solution
from optlaws.tolerances import LEAST_TIME_GAP

_KEYS = ("shortest", "longest", "certificate")
#: how much of the overlap of two intervals is left to the one before
_OVERLAP = 0.25
_DOUBLINGS = 1000


@dataclass(frozen=True)
class TimeProof(JsonText):
    """The proof that no law keeps the limits in any time from the shortest to the longest.

    Attributes
    ----------
    shortest, longest
        The ends of the interval, s; the shortest is 0 where limits that are kept stay so in every longer time.
    certificate
        That no law keeps the limits in the longest time. The same multipliers prove it of the shortest. Where a
        vibration that is left is limited: that no law keeps what every law keeps that keeps the limits in some time
        of the interval.
    """

    shortest: float
    longest: float
    certificate: Certificate

    _json_name = "a proof of a least time"

    def stands(self, move: TimedMove) -> bool:
        """Whether the multipliers prove it of the move, by numpy alone."""
        certificates = self.certificates(move)
        return bool(certificates) and all(proof.proves_infeasible for proof in certificates)

    def certificates(self, move: TimedMove) -> list[Certificate]:
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
        return [self.certificate, replace(self.certificate, problem=move.within(self.shortest))]

    def to_dict(self) -> dict[str, Any]:
        """The proof as plain data."""
        return {"shortest": self.shortest, "longest": self.longest, "certificate": self.certificate.to_dict()}

    @classmethod
    def from_dict(cls, data: Any) -> TimeProof:  # noqa: ANN401 - it is checked here
        """The proof that `to_dict` described.

        Raises
        ------
        InputError
            If an entry is missing or wrong.
        """
        entries = all_entries_of(data, _KEYS, cls._json_name)
        shortest, longest = not_negative(entries["shortest"], "shortest"), positive(entries["longest"], "longest")
        if shortest > longest:
            raise InputError(f"the shortest time, {shortest!r}, is above the longest, {longest!r}")
        return cls(shortest, longest, Certificate.from_dict(entries["certificate"]))


@dataclass(frozen=True)
class Multipliers:
    """What the multipliers of one optimum say of all times.

    Attributes
    ----------
    certificate
        The optimum's.
    weights
        Of the limits in f(T) = constant + slope T - sum of weight T^nu, by the order nu.
    constant, slope
        Of what the ends leave.
    """

    certificate: Certificate
    weights: tuple[tuple[int, float], ...]
    constant: float
    slope: float

    @classmethod
    def of(cls, move: TimedMove, duration: float, solution: Solution) -> Multipliers:
        """Those of the least greatest share of the limits in a time."""
        proof = solution.certificate
        weights = _weights(move, duration, proof.contacts)
        bound = solution.lower_bound
        if move.at_rest:
            return cls(proof, weights, bound, 0.0)
        further = replace(proof, problem=move.shares(duration, ends=2.0 * duration)).bound
        slope = (further - bound) / duration
        return cls(proof, weights, bound - slope * duration, slope)

    def of_stroke(self, ratio: float) -> Multipliers:
        """The same multipliers for a stroke that is so many times as long, from rest to rest: the limits weigh less."""
        return replace(self, weights=tuple((nu, weight / ratio) for nu, weight in self.weights))

    def above(self, duration: float) -> float:
        """The value f at a time: above 0 no law keeps the limits."""
        return self.constant + self.slope * duration - sum(weight * power(duration, nu) for nu, weight in self.weights)

    def longest(self, duration: float) -> float:
        """The time up to which f stays above 0, from one at which it is, or back to which it is not."""
        low = high = duration
        if self.above(duration) > 0.0:
            for _ in range(_DOUBLINGS):
                low, high = high, 2.0 * high
                if self.above(high) <= 0.0:
                    break
        else:
            for _ in range(_DOUBLINGS):
                low, high = 0.5 * low, low
                if self.above(low) > 0.0:
                    break
        return self._crossing(low, high)

    def shortest(self, duration: float) -> float:
        """The time down to which f stays above 0, from one at which it is; 0 where it is above at once."""
        if self.above(0.0) > 0.0:
            return 0.0
        return self._crossing(duration, 0.0)

    def _crossing(self, inside: float, outside: float) -> float:
        """The last time at which f is above 0, between one at which it is and one at which it is not."""
        while (middle := 0.5 * (inside + outside)) not in {inside, outside}:
            inside, outside = (middle, outside) if self.above(middle) > 0.0 else (inside, middle)
        return inside

    def proof(self, move: TimedMove, shortest: float, longest: float) -> TimeProof:
        """The proof of an interval, by the multipliers of the limits alone."""
        return proof_by(self.certificate, move, shortest, longest)


def proof_by(certificate: Certificate, move: TimedMove, shortest: float, longest: float) -> TimeProof:
    """The proof of an interval by the multipliers of an optimum, without those of the parts of the greatest share."""
    problem = move.within(longest, shortest if shortest and move.residual is not None else None)
    # rows of an amplitude are in units of its bound, where it has one
    units = {constant.name: bound.high for constant, bound in problem.bounds.items() if constant.normalised}
    of_rows = [
        replace(contact, multiplier=contact.multiplier * units.get(contact.constraint, 1.0))
        for contact in certificate.contacts
        if names.part_number(contact.constraint) is None
    ]
    total = sum(contact.multiplier for contact in of_rows)
    contacts = [replace(contact, multiplier=contact.multiplier / total) for contact in of_rows]
    equations = [multiplier / total for multiplier in certificate.equations]
    return TimeProof(shortest, longest, Certificate.of_leaf(problem, contacts, equations, VIOLATION))


def covering(move: TimedMove, known: Sequence[tuple[float, Multipliers]], duration: float) -> tuple[TimeProof, ...]:
    """Few proofs that cover every time that is conceivable and shorter than a duration, the shortest times first.

    Raises
    ------
    SolverFailure
        If they leave times between them.
    """
    least = move.least_conceivable()
    ranges = [(each.shortest(at), each.longest(at), each) for at, each in known]
    proofs: list[TimeProof] = []
    upper = duration
    while upper > least:
        reaching = [(low, i) for i, (low, high, _) in enumerate(ranges) if low < upper <= high]
        if not reaching:
            raise SolverFailure(f"no multipliers speak of the time {upper!r}", problem=move.problem)
        low, i = min(reaching)
        lower = 0.0 if move.at_rest else least
        if low > lower:
            before = max((high for start, high, _ in ranges if start < low), default=low)
            lower = low + _OVERLAP * (min(before, upper) - low)
        proofs.append(ranges[i][2].proof(move, lower, upper))
        upper = lower
    return tuple(reversed(proofs))


def _weights(move: TimedMove, duration: float, contacts: Sequence[Contact]) -> tuple[tuple[int, float], ...]:
    """What the limits weigh: the multipliers of the parts of the greatest share, over the powers of the time."""
    rates = move.rates
    if len(rates) == 1:
        return ((rates[0].nu, 1.0 / power(duration, rates[0].nu)),)
    shares = [0.0] * len(rates)
    for contact in contacts:
        part = names.part_number(contact.constraint)
        if part is not None:
            shares[part - 1] += contact.multiplier
    return tuple((limit.nu, share / power(duration, limit.nu)) for limit, share in zip(rates, shares, strict=True))


def covers(move: TimedMove, proofs: Sequence[TimeProof], duration: float) -> bool:
    """Whether proofs speak of every time that is conceivable and shorter than a duration, but for the gap allowed."""
    least = duration * (1.0 - LEAST_TIME_GAP)
    if not proofs and move.torque is not None:
        return True  # nothing is claimed but the limit of all laws
    if not proofs:
        return least <= move.least_conceivable()
    first = 0.0 if move.at_rest else move.least_conceivable()
    joined = all(proof.longest == after.shortest for proof, after in pairwise(proofs))
    return joined and proofs[0].shortest <= first and proofs[-1].longest >= least
