"""The report of a fastest move: its facts, and its motion over time within its limits."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf
from typing import TYPE_CHECKING, Any

from optlaws.cycles.moves.fastest_move import AXES, FastestMove
from optlaws.motion.derivative_panel import display_unit, motion_panel
from optlaws.motion.piece import Piece
from optlaws.shown.report import Panel, PanelLimit, ReportSegment, ReportTable
from optlaws.shown.summary import Summary

if TYPE_CHECKING:
    from optlaws.laws import MotionLaw


@dataclass(frozen=True)
class MoveReport:
    """The report of a least time, with its law or another one in a longer time.

    Attributes
    ----------
    move
        The least time.
    law, duration
        The law and its time, s.
    """

    move: FastestMove
    law: MotionLaw
    duration: float

    tables: tuple[ReportTable, ...] = ()
    segments: tuple[ReportSegment, ...] = ()

    @property
    def facts(self) -> Summary:
        """The summary of the move."""
        return self.move.summary()

    @property
    def data(self) -> dict[str, Any]:
        """The move with its proofs."""
        return self.move.to_dict()

    @property
    def panels(self) -> tuple[Panel, ...]:
        """Position, velocity, acceleration and jerk; and the snap where it is limited."""
        piece = Piece(0.0, self.duration, 0.0, self.move.stroke, self.law)
        limits = self.move.least.move.limits
        bounds = [(None, None), (limits.velocity, limits.velocity), (limits.deceleration, limits.acceleration)]
        bounds += [(limits.jerk, limits.jerk), *([] if limits.snap is None else [(limits.snap, limits.snap)])]
        panels = []
        for nu, (low, high) in enumerate(bounds):
            ends = -inf if low is None else -low, inf if high is None else high
            limited = () if low is None and high is None else (PanelLimit(0.0, self.duration, *ends),)
            unit = display_unit(AXES[self.move.unit], nu)
            panels.append(motion_panel([piece], nu, unit, piece.extremes(nu, 0.0, self.duration), limited))
        return tuple(panels)
