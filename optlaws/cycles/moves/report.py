"""The report of a fastest move: its facts, its motion over time within its limits, and what it takes of each limit."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf, isfinite
from typing import TYPE_CHECKING, Any

import numpy as np

from optlaws.cycles.moves.fastest_move import AXES, FastestMove
from optlaws.cycles.optimisation.motion_limits import LimitTaken
from optlaws.kept import kept_property
from optlaws.mechanisms.drives.drive_train import Drive
from optlaws.mechanisms.drives.effort import DriveSheet, PieceEffort
from optlaws.motion.derivative_panel import DERIVATIVES, display_unit, motion_panel
from optlaws.motion.piece import Piece, unit_of
from optlaws.motion.quantities import QUANTITIES
from optlaws.numbers import Array
from optlaws.shown.curve_points import refined
from optlaws.shown.report import Panel, PanelLimit, ReportSegment, ReportTable, Series
from optlaws.shown.summary import Row, Summary
from optlaws.synthesis.least_time.follower_residual import RESIDUAL
from optlaws.synthesis.least_time.motor_torque import CURVE_LIMIT

if TYPE_CHECKING:
    from optlaws.laws import MotionLaw

_STEPS = 241  # of a torque, to which those are added that its curve needs


@dataclass(frozen=True)
class MoveReport:
    """The report of a least time, with its law or another one in a longer time.

    Attributes
    ----------
    move
        The least time.
    law, duration
        The law and its time, s.
    drive, start
        The motor whose torque is shown, if any, and the position of its mechanism's input where the move begins, rad.
    """

    move: FastestMove
    law: MotionLaw
    duration: float
    drive: Drive | None = None
    start: float = 0.0

    tables: tuple[ReportTable, ...] = ()
    segments: tuple[ReportSegment, ...] = ()

    @property
    def facts(self) -> Summary:
        """The least time with its proof, and the use of each limit with the time that a higher one saves."""
        rows = (Row(each.name, each.value, each.unit, note=self._note(each)) for each in self.limits_taken)
        return Summary([*self.move.proof_rows(), *rows])

    def _note(self, taken: LimitTaken) -> str:
        if taken.name not in self.move.binding:
            return f"{100.0 * taken.share:.3g} % of the limit"
        gain = self.move.gains().get(taken.name)
        return "binds" if gain is None else f"binds: 10 % more saves {100.0 * gain:.2g} % of the time"

    @property
    def data(self) -> dict[str, Any]:
        """The move with its proofs."""
        return self.move.to_dict()

    @kept_property
    def piece(self) -> Piece:
        """The law in its place."""
        return Piece(0.0, self.duration, self.start, self.move.stroke, self.law)

    @kept_property
    def limits(self) -> dict[int, tuple[float, float]]:
        """The least and the greatest allowed value of each derivative with a limit, by its order, in SI units."""
        known = self.move.least.move.limits
        sides = {1: (known.velocity,) * 2, 2: (known.deceleration, known.acceleration), 3: (known.jerk,) * 2}
        sides[4] = (known.snap,) * 2
        return {
            nu: (-inf if low is None else -low, inf if high is None else high)
            for nu, (low, high) in sides.items()
            if low is not None or high is not None
        }

    @kept_property
    def limits_taken(self) -> tuple[LimitTaken, ...]:
        """The use of each limit of the move, in SI units."""
        axis, others = AXES[self.move.unit], {CURVE_LIMIT: "", RESIDUAL: unit_of(AXES[self.move.unit], 2)}
        return tuple(
            LimitTaken(
                limit.name,
                "",
                limit.at(self.duration).share(self.law) * limit.most,
                limit.most,
                "",
                unit=unit_of(axis, limit.nu) if limit.nu else others.get(limit.name, "N m"),
            )
            for limit in self.move.least.move.along
        )

    def shares(self, times: Array) -> dict[str, Array]:
        """The share of each limit of the motion and of the motor that is taken at each time, 0 to 1."""
        taken, torque = {}, self.move.least.move.torque
        for nu, (low, high) in self.limits.items():
            values, name = self.piece.values(times, nu), DERIVATIVES[nu]
            if low == -high:
                taken[name] = np.abs(values) / high
            else:
                sides = {name: high, "deceleration": low}
                taken |= {side: np.maximum(values / end, 0.0) for side, end in sides.items() if isfinite(end)}
        if self.drive is not None and self._along is not None and torque is not None:
            torques = np.abs(self._along.force(times))
            if torque.peak is not None:
                taken["torque"] = torques / torque.peak
            if torque.curve:
                taken[CURVE_LIMIT] = self._along.use(times)
        return taken

    @property
    def demands(self) -> list[Row]:
        """What the move takes of its motor; nothing without one."""
        return [] if self.sheet is None else list(self.sheet.summary())

    @kept_property
    def sheet(self) -> DriveSheet | None:
        """What the move takes of its motor; None without one."""
        if self.drive is None:
            return None
        return self.drive.sheet(self.law, self.start, self.move.stroke, self.duration)

    @kept_property
    def panels(self) -> tuple[Panel, ...]:
        """Position, velocity, acceleration and jerk; the snap where it is limited, and the torque of a motor."""
        piece, axis = replace(self.piece, offset=0.0), AXES[self.move.unit]
        panels = []
        for nu in range(1 + max((len(QUANTITIES) - 1, *self.limits))):
            limits = [PanelLimit(0.0, self.duration, *self.limits[nu])] if nu in self.limits else ()
            extremes = piece.extremes(nu, 0.0, self.duration)
            panels.append(motion_panel([piece], nu, display_unit(axis, nu), extremes, limits))
        return (*panels, *self._torque_panel())

    @kept_property
    def _along(self) -> PieceEffort | None:
        return None if self.drive is None else PieceEffort(self.drive, self.piece)

    def _torque_panel(self) -> tuple[Panel, ...]:
        """The torque at the motor through its peak, and within its limit."""
        if self._along is None or self.sheet is None:
            return ()
        torque, law, limited = self._along.force, self.law, self.move.least.move.torque
        marks = self.duration * np.array([self.sheet.peak_torque_at, self.sheet.curve_use_at])
        times = np.unique(self.duration * np.array([*np.linspace(0.0, 1.0, _STEPS), *law.breaks]))
        times, (values,) = refined(times, [torque(times)], [torque], marks)
        most = None if limited is None else limited.peak
        limits = () if most is None else (PanelLimit(0.0, self.duration, -most, most),)
        peaks = ((float(marks[0]), float(torque(marks[:1])[0])),)
        return (Panel("torque", "N m", (Series(times, values),), limits, peaks),)
