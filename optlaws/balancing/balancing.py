"""The torque at the shaft of a cycle, alone and with the inertial loader that balances it, in N m."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import sqrt
from typing import Any, NamedTuple

import numpy as np

from optlaws.balancing.loaders.loader import Loader
from optlaws.cams.curves.motion_by_angle import CamMotion
from optlaws.cycles.cycle import Cycle
from optlaws.cycles.specification.drive import read_linear_drive
from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.mechanisms.drives.drive_train import Drive
from optlaws.mechanisms.drives.effort import PieceEffort
from optlaws.mechanisms.linkages.mechanism_formulas import LinearForce
from optlaws.motion.piece import Piece
from optlaws.motion.quantities import TURN, either
from optlaws.numbers import Array, Quantity, finite, number_or_array, real_times
from optlaws.numerics.branch_and_bound import Extremes, extremes, integral
from optlaws.numerics.interval import Interval
from optlaws.numerics.taylor import Jet
from optlaws.tolerances import AGREEMENT

_BALANCING_EXTREMES = 1e-7  # torques of a machine that is balanced

_PARTS = 12


class TorqueOverTurn(NamedTuple):
    """A torque at a shaft over the turn: extremes, enclosed, and its root mean square, N m."""

    extremes: Extremes
    rms: float

    @property
    def peak(self) -> float:
        """The greatest magnitude of the torque."""
        return self.extremes.peak


@dataclass(frozen=True)
class Balancing:
    """A cycle whose moves are balanced by inertial loaders, with the shaft's torque before and after.

    Each move from rest to rest has the loader of its law, which takes up the kinetic energy that the link gives off
    (eq. 1, 2 of the paper on inertial loaders). Between moves the loader stands still or runs on at uniform speed, as
    that of a dwell mechanism of type I does, and takes no torque.

    Parameters
    ----------
    cycle
        The executive cycle, with its drive: mass or inertia, and what else it moves, which no loader balances.
    share
        The loader's mass over the mass that balances the inertia in full.

    Raises
    ------
    InputError
        If the cycle has no drive, its moves have different peak speeds, so that the loader would have to change its
        own in the dwells, or a move is not from rest to rest.

    Examples
    --------
    >>> from optlaws import Cycle, Dwell, Return, Rise
    >>> moves = [Rise("40 mm", "90 deg", law="K"), Dwell("90 deg"), Return(duration="90 deg", law="K"), Dwell()]
    >>> balancing = Balancing(Cycle(moves, speed="120 rpm", drive={"mass": "3 kg"}))
    >>> round(balancing.before.peak, 6), balancing.after.peak < 1e-12 * balancing.before.peak
    (0.757986, True)
    """

    cycle: Cycle
    share: float = 1.0

    def __post_init__(self) -> None:
        if finite(self.share, "share") < 0.0:
            raise InputError(f"share must be at least 0, got {self.share!r}")
        self.load, self._loaders  # noqa: B018 - what is wrong is refused at once

    @property
    def load(self) -> LinearForce:
        """The load that the cycle drives."""
        return self._drive[1]

    @kept_property
    def _drive(self) -> tuple[Drive, LinearForce]:
        if self.cycle.drive is None:
            raise InputError("the cycle has no drive: give one, such as drive={'mass': '3 kg'}")
        return read_linear_drive(self.cycle.drive, self.cycle.axis)

    @property
    def rate(self) -> float:
        """The shaft's angular velocity, rad/s."""
        return TURN / self.cycle.duration

    @kept_property
    def before(self) -> TorqueOverTurn:
        """The torque at the shaft without loaders."""
        return self._over_turn(0.0)

    @kept_property
    def after(self) -> TorqueOverTurn:
        """The torque with the loaders: each loader takes its share of the inertia's torque, d_l = -Y² d."""
        return self._over_turn(self.share)

    def torque(self, degrees: Any, *, balanced: bool = True) -> Any:
        """The torque at an angle of the shaft in degrees, with the loaders or without, N m."""
        times = np.mod(real_times(degrees), 360.0) * (self.cycle.duration / 360.0)
        return number_or_array(self._executive(times) + (self._loader(times) if balanced else 0.0))

    def loader_motion(self, stroke: Quantity) -> CamMotion:
        """The loader's motion over the turn, for its own cam: out and back with each move, by the loader's stroke.

        Parameters
        ----------
        stroke
            Of the loader between its extremes, such as "30 mm" or "25 deg"; its mass is that of `Loader.mass`.

        Raises
        ------
        InputError
            If the cycle dwells (take `dwell_machine`), its moves are not an even number of symmetric laws, or the
            stroke is no quantity above 0.
        """
        axis, way = either(stroke, ("length", "angle"), "stroke")
        if way <= 0.0:
            raise InputError(f"stroke must be above 0, got {shortened(stroke)}")
        moving = [
            (piece, loader)
            for piece, loader in zip(self.cycle.pieces, self._loaders, strict=True)
            if loader is not None
        ]
        if len(moving) < len(self._loaders):
            raise InputError("the loader of a cycle that dwells has a clutch or runs on: take dwell_machine")
        if len(moving) % 2 or not all(loader.symmetric for _, loader in moving):
            raise InputError("the loader comes back over an even number of moves by symmetric laws")
        # it goes out by half of its stroke and comes back with each move
        pieces = [
            Piece(piece.start, piece.duration, 0.0, way * (-1.0) ** i, loader.law.piecewise)
            for i, (piece, loader) in enumerate(moving)
        ]
        return CamMotion.of_pieces(pieces, self.cycle.duration, axis)

    @kept_property
    def _loaders(self) -> tuple[Loader | None, ...]:
        """The loader of each piece that moves."""
        moving = [piece for piece in self.cycle.pieces if piece.stroke]
        for piece in moving:
            if max(abs(piece.end(1, side)) for side in (0, 1)) > AGREEMENT * self.cycle.peak(1):
                raise InputError("an inertial loader balances moves from rest to rest: let each begin and end so")
        speeds = [abs(piece.stroke) / piece.duration * piece.law.peak(1).value for piece in moving]
        if max(speeds) - min(speeds) > AGREEMENT * max(speeds):
            raise InputError(
                "the moves have different peak speeds, from "
                f"{min(speeds):.6g} to {max(speeds):.6g} in SI units, and the loader's energy would not suit them all: "
                "choose durations that make them equal"
            )
        return tuple(Loader(piece.law) if piece.stroke else None for piece in self.cycle.pieces)

    def _over_turn(self, share: float) -> TorqueOverTurn:
        """The torque over the turn where loaders take a share of the inertia's torque."""
        load, rate = self.load, self.rate
        motion = CamMotion.of_pieces(self.cycle.pieces, self.cycle.duration, self.cycle.axis)

        def torque(angle: Interval, order: int) -> Jet:
            s = motion.jet(angle, order + 1)
            slope = s.slope()
            resisted = (s * load.stiffness + load.constant) * slope + slope * slope * (load.viscous * rate)
            moved = motion.power(angle, order) * (load.inertia * (1.0 - share) * rate**2)
            return moved + resisted + slope.magnitude() * load.dry

        def squared(angle: Interval, order: int) -> Jet:
            jet = torque(angle, order)
            return jet * jet

        known = extremes(torque, motion.breaks, share=_BALANCING_EXTREMES, parts=_PARTS)
        times = known._replace(least_at=known.least_at / rate, most_at=known.most_at / rate)
        _, square = integral(squared, motion.breaks, share=_BALANCING_EXTREMES)
        return TorqueOverTurn(times, sqrt(max(square, 0.0) / TURN))

    def _executive(self, time: Array) -> Array:
        return self._by_piece(time, lambda piece, _, at: PieceEffort(self._drive[0], piece).power(at) / self.rate)

    def _loader(self, time: Array) -> Array:
        return self._by_piece(time, self._of_loader)

    def _of_loader(self, piece: Piece, loader: Loader | None, time: Array) -> Array:
        """Its power over the shaft's speed: its own velocity times its own acceleration."""
        if loader is None:
            return np.zeros(time.shape)
        # mass times stroke squared, in full: eq. (2)
        moved = self.share * self.load.inertia * (piece.stroke / loader.Y) ** 2
        return np.asarray(moved / piece.duration**3 * loader.law.d(piece.places(time)) / self.rate)

    def _by_piece(self, time: Array, values: Callable[[Piece, Loader | None, Array], Array]) -> Array:
        pieces = self.cycle.pieces
        which = np.searchsorted([piece.start for piece in pieces[1:]], time, side="right")
        values_by_piece = np.empty(np.shape(time))
        for i in np.unique(which):
            here = which == i
            values_by_piece[here] = values(pieces[i], self._loaders[i], np.asarray(time)[here])
        return values_by_piece
