"""The least period within a limit of the root mean square of the force over the whole cycle, as motors are rated.

At a period the motions take least where each takes its least mean square; the cycle is too fast where their sum is
above the limit. Run slower, the force is between the static one and the one before, and so is its root mean square: a
cycle that keeps the limit keeps it at every lower speed, where the static force does. Lower bounds of the mean squares
a little faster, each by its certificate, prove that no laws keep it there.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from math import inf, log, sqrt

from optlaws.cycles.greatest_speed.timed_spans import falling_root, static_force
from optlaws.cycles.optimisation.bounds import span_bound
from optlaws.cycles.optimisation.objectives import CycleObjective
from optlaws.cycles.optimisation.optimal import solve
from optlaws.cycles.specification.joints import LawSpan, Layout
from optlaws.cycles.specification.limits import FORCES, of_segments
from optlaws.errors import InfeasibleProblem, InputError, SolverFailure
from optlaws.kept import kept_property
from optlaws.mechanisms.drives.drive_train import Drive
from optlaws.mechanisms.drives.effort import PieceEffort
from optlaws.motion.piece import Piece
from optlaws.synthesis.proof.certificate import Certificate
from optlaws.synthesis.solution import Solution
from optlaws.tolerances import AGREEMENT, FASTER, LEAST_SCALE_MET


@dataclass(frozen=True)
class ForceRating:
    """Motions that turn with the master and share a limit of the root mean square of their force.

    `placed` are they at a period, `fastest` the laws that keep all other limits where no least force is known.
    """

    objective: CycleObjective
    axis: str
    most: float
    least: float
    given: float
    placed: Callable[[float], Layout]
    fastest: Callable[[LawSpan], Piece | None]

    @kept_property
    def drive(self) -> Drive:
        if self.objective.drive is None:
            raise InputError("limits: an rms force or torque is of a drive: give one, such as drive={'mass': '2 kg'}")
        return self.objective.drive

    @property
    def name(self) -> str:
        return f"rms {FORCES[self.axis]}"

    @kept_property
    def period(self) -> float:
        if self.least and self._over(self.least) <= 0.0:
            return self.least
        period = falling_root(self._over, self.least or self.given, 1.5, LEAST_SCALE_MET)
        if period == inf:
            raise InfeasibleProblem(
                f"limits: no speed keeps the {self.name} of {self.most:.9g}: the static load alone needs more: "
                "allow more, or change the drive's spring, preload, gravity or friction"
            )
        return period * (1.0 + 2.0 * LEAST_SCALE_MET)

    @property
    def binds(self) -> bool:
        """Whether the cycle is slower by it than by its other limits."""
        return self.period > self.least * (1.0 + AGREEMENT)

    def keeps(self, pieces: Sequence[Piece], period: float) -> bool:
        """Whether laws keep the limit."""
        taken = sum(PieceEffort(self.drive, piece).square for piece in pieces)
        return taken <= self.most**2 * period * (1.0 + AGREEMENT)

    def laws(self, period: float) -> list[Piece]:
        """The laws of least mean square of the force at a period, within the other limits."""
        return [self._law(span)[0] for span in self.placed(period).spans]

    @kept_property
    def proofs(self) -> dict[str, Certificate] | None:
        """The certificates of lower bounds a little faster, whose sum is above the limit; None where it is not."""
        period = self.period * (1.0 - FASTER)
        placed = self.placed(period)
        laws = [self._law(span) for span in placed.spans]
        square = sum(PieceEffort(self.drive, piece).square for piece in placed.pieces)
        proofs = {}
        for span, (_, solution) in zip(placed.spans, laws, strict=True):
            if solution is None:
                return None
            square += span.duration * span_bound(span, solution, self._of_force) ** 2
            proofs[f"{span.where}, least {self.name}"] = solution.certificate
        return proofs if square > self.most**2 * period else None

    @property
    def scales(self) -> bool:
        """Whether a cycle that keeps the limit keeps it at every lower speed."""
        drive = self.drive.linear
        if drive is None or (drive.viscous and (drive.stiffness or drive.constant)):
            return False
        return all(static_force(span, self.drive)[1] <= self.most for span in self.placed(self.given).spans)

    @property
    def _of_force(self) -> CycleObjective:
        return replace(self.objective, minimise="rms force", limits=of_segments(self.objective.limits))

    def _over(self, period: float) -> float:
        """The logarithm of the ratio of the root mean square to its limit."""
        pieces = [*self.placed(period).pieces, *self.laws(period)]
        square = sum(PieceEffort(self.drive, piece).square for piece in pieces)
        return log(sqrt(square / period) / self.most)

    def _law(self, span: LawSpan) -> tuple[Piece, Solution | None]:
        """The law of a span in its place, with its solution where it was looked for there."""
        try:
            return solve(span, self._of_force)
        except (InfeasibleProblem, SolverFailure):
            piece = self.fastest(span)
            if piece is None:
                raise
            return piece, None
