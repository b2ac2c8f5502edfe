"""A law beside others: its value of every compared measure, its use of every limit, and its proven bounds."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

from optlaws.cycles.optimisation.motion_limits import LimitTaken
from optlaws.errors import InputError
from optlaws.laws import MotionLaw
from optlaws.numbers import bounded
from optlaws.shown.report import Report
from optlaws.synthesis.solution import Solution
from optlaws.synthesis.status import Status

if TYPE_CHECKING:
    from optlaws.cycles.cycle import Plan

#: a law of the catalogue, the laws that a cycle has, or one that was looked for
LawKind = Literal["standard", "given", "optimal"]


class LawMeasure(NamedTuple):
    """A quantity by which laws are compared: its name and its unit.

    Examples
    --------
    >>> LawMeasure("acceleration", "m/s²").heading, LawMeasure("inertia ratio", "").heading
    ('acceleration, m/s²', 'inertia ratio')
    """

    name: str
    unit: str

    @property
    def heading(self) -> str:
        """The heading of a column of it."""
        return f"{self.name}, {self.unit}" if self.unit else self.name


class ProvenLeast(NamedTuple):
    """The proof of an optimal law in numbers, in SI units.

    Attributes
    ----------
    minimise
        What is least.
    lower_bound
        What no law of the space that keeps the same limits takes less than; None where nothing is known.
    limit
        What no law of any degree does; None where none is known.
    space
        The laws of which none is better, in words.
    status
        Of the solutions.
    """

    minimise: str
    lower_bound: float | None
    limit: float | None
    space: str
    status: Status


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
        return all(taken.is_kept for taken in self.limits)

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

    @property
    def data(self) -> dict[str, Any]:
        """The law's part of the advice for programs, in SI units, with whole solutions."""
        proof = self.proof
        optimal = {} if proof is None else {
            "minimise": proof.minimise,
            "lower_bound": proof.lower_bound,
            "limit": proof.limit,
            "space": proof.space,
            "status": proof.status.value,
            "solutions": [solution.to_dict() for solution in self.solutions],
        }  # fmt: skip
        return {
            "name": self.name,
            "kind": self.kind,
            "values": {name: bounded(value) for name, value in self.values.items()},
            "keeps_limits": self.keeps_limits,
            "limits": [
                {"name": taken.name, "where": taken.where, "value": bounded(taken.value), "limit": taken.limit}
                for taken in self.limits
            ],
            **optimal,
        }
