"""A motor that drives a mechanism through a gear: torque and power at the motor, as numbers and as formulas."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any, TypeAlias

import numpy as np

from optlaws.entries.declared import Declared, ValueOf, declared, entry
from optlaws.entries.value_types import Either, InSI, Kept, Number, SINumber, Together, is_list
from optlaws.errors import InputError
from optlaws.formulas.tree import Formula
from optlaws.laws import MotionLaw, smoothstep
from optlaws.mechanisms.drives.effort import PieceEffort, bends
from optlaws.mechanisms.drives.motor import Motor, Train
from optlaws.mechanisms.drives.sheet import BestRatio, DriveSheet, TorqueByRatio, best_ratio, sheet_of
from optlaws.mechanisms.linkages.mechanism import DIMENSIONS, Mechanism, duration_of
from optlaws.mechanisms.linkages.mechanism_kinds import MECHANISM
from optlaws.mechanisms.linkages.move_limit import (
    MOVED,
    LimitedMove,
    MoveBounds,
    MoveCosts,
    MovedKind,
    MoveLimit,
    MoveScales,
    PhaseMove,
    move_limit,
)
from optlaws.motion.piece import Piece, named_law
from optlaws.motion.quantities import check_scale, si_number
from optlaws.numbers import Array, NumberOrQuantity, positive
from optlaws.synthesis.limits.drive_limits import DriveObjective
from optlaws.tolerances import CLOSURE


@dataclass(frozen=True)
class DimensionlessDrive:
    """A drive over one stroke without dimensions: texts in a, b and c, with the units of their numbers.

    They are those of laws that never turn back.

    Attributes
    ----------
    torque
        At the motor, above 0 in the direction of the stroke. Where a gear loses power, its magnitude is no maximum of
        smooth formulas: `peak` takes it with side="high", and the last branch with side="low", which braking never
        passes.
    branches
        The torques of which it is the greatest: where a gear loses power, that of power to the load and that of power
        back.
    power
        Of the motor, above 0 where it drives: torque times b.
    energy
        Of which the integral is the energy of the move: braking counts by the share that is fed back.
    heat
        Of which the integral is the copper heat and the braking energy that is not fed back; empty of a motor without
        a motor constant.
    unit
        Of the torque, N m.
    power_unit, energy_unit
        W, and J for an integral over k.
    """

    torque: str
    branches: tuple[str, ...]
    power: str
    energy: str
    heat: str
    unit: float
    power_unit: float
    energy_unit: float


_SHARE = Number(above=0.0, most=1.0)
Efficiency: TypeAlias = Kept[tuple[float, float], "float | tuple[float, float]"]


@declared
class Drive(Declared, title="a drive"):
    """A motor that drives a mechanism through a gear or a belt.

    The torque at the motor is J i x'' + friction + X/(i eta) while power flows to the load, and X eta/i while it flows
    back: X is the torque at the mechanism's input, i the ratio, J the inertia of motor and gear.

    Raises
    ------
    InputError
        If a number is out of its range, or the mechanism's input slides.

    Examples
    --------
    >>> table = Mechanism("0.8 kg m^2")
    >>> drive = Drive(table, Motor("3e-4 kg m^2"), ratio=20, efficiency=0.85)
    >>> sheet = drive.sheet("modified sine", "0 deg", "45 deg", "0.25 s", period="0.6 s")
    >>> [round(value, 3) for value in (sheet.peak_torque, sheet.rms_torque, sheet.peak_speed * 30 / np.pi)]
    [3.686, 1.49, 1055.762]
    """

    writes_defaults = True
    newer = ("no_load_torque",)

    mechanism: Mechanism = entry(MECHANISM, "Whose input the gear turns: one whose input turns too.", shown=False)
    motor: Motor = entry(
        ValueOf(Motor),
        "Its inertia, ratings and curves.",
        example={
            "inertia": "3e-4 kg m^2",
            "rated_torque": "2 N m",
            "peak_torque": "6 N m",
            "greatest_speed": "3000 rpm",
        },
    )
    ratio: float = entry(
        Number(above=0.0), "i, turns of the motor with a turn of the mechanism's input.", default=1.0, example=10
    )
    efficiency: Efficiency = entry(
        Either(_SHARE, Together(_SHARE, _SHARE, names=("to the load", "back")), which=is_list),
        "eta of the gear: one for both directions of the power, or a pair, to the load and back.",
        default=1.0,
        example=0.95,
    )
    inertia: SINumber = entry(
        InSI("moment of inertia", least=0.0),
        "Of gear, brake and coupling at the motor's shaft.",
        default=0.0,
        example="1e-5 kg m^2",
    )
    regeneration: float = entry(
        Number(least=0.0, most=1.0),
        "The share of the braking energy that is fed back: 0 with a brake resistor, 1 where nothing is lost.",
        default=0.0,
        example=0.5,
    )
    no_load_torque: SINumber = entry(
        InSI("torque", least=0.0),
        "What the gear takes to turn without load, at the motor's shaft and against the motion.",
        default=0.0,
        example="0.05 N m",
    )

    def _check(self) -> None:
        if self.mechanism.axis != "angle":
            raise InputError(
                "mechanism: the motor turns, and the mechanism's input slides: take rack(), belt() or screw(), or a "
                "mechanism over the angle of its input"
            )
        check_scale(self.ratio, "", "ratio", self.ratio)
        shares: Any = self.efficiency
        object.__setattr__(self, "efficiency", shares if isinstance(shares, tuple) else (shares, shares))

    @property
    def efficiencies(self) -> tuple[float, float]:
        """The gear's efficiency while power flows to the load, and while it flows back."""
        return self.efficiency

    @property
    def train(self) -> Train:
        """Motor and gear in numbers."""
        turning = self.motor.inertia + self.inertia
        return Train(turning, self.motor.viscous, self.motor.coulomb + self.no_load_torque, *self.efficiencies)

    def with_ratio(self, ratio: float) -> Drive:
        """The drive with another ratio."""
        return replace(self, ratio=ratio)

    def torque(
        self,
        position: Any,
        velocity: Any,
        acceleration: Any,
        process: Any = 0.0,
        *,
        direction: Any = None,
    ) -> Any:
        """The torque at the motor, N m, from position, velocity and acceleration of the mechanism's input, SI units.

        A process adds to the load at that input. Unless the `direction` is given, 1, -1 or 0, it moves the way of its
        velocity, and from rest that of its acceleration; at rest the motor holds the load without help of the gear's
        losses.
        """
        v, w = np.asarray(velocity, dtype=np.float64), np.asarray(acceleration, dtype=np.float64)
        way = np.where(v == 0.0, np.sign(w), np.sign(v)) if direction is None else np.asarray(direction)
        turning, dry, load = self._torques((position, v, w), way, process)
        values = self.ratio * turning + dry + load / self.ratio
        return values if np.ndim(values) else float(values)

    def _torques(self, motion: tuple[Any, Array, Array], way: Array, process: Any = 0.0) -> tuple[Array, Array, Array]:
        """P, Q and Y of the torque i P + Q + Y/i at the motor with a ratio i: inertia and viscous friction, dry, load.

        The motion is position, velocity and acceleration of the mechanism's input, the way its direction.
        """
        train, (_, v, w) = self.train, motion
        load = np.asarray(self.mechanism.torque(*motion, way)) + process
        through = np.where(way == 0.0, load, train.through_gear(load * way) * way)
        return train.inertia * w + train.viscous * v, train.coulomb * way, through

    def dimensionless(
        self,
        start: NumberOrQuantity,
        stroke: NumberOrQuantity,
        duration: NumberOrQuantity,
        *,
        process: Formula | None = None,
    ) -> DimensionlessDrive:
        """The drive over a stroke of the mechanism's input: formulas of a law for `peak`, `rms` and `integral`.

        Parameters
        ----------
        start, stroke, duration, process
            As `Mechanism.dimensionless` takes them.

        Raises
        ------
        InputError
            If the stroke leaves the range of the mechanism, or is 0.

        Examples
        --------
        >>> from optlaws import integral, rms, smoothstep
        >>> drive = Drive(Mechanism("0.8 kg m^2"), Motor("3e-4 kg m^2"), ratio=20, efficiency=0.85)
        >>> moved = drive.dimensionless("0 deg", "45 deg", "0.25 s")
        >>> round(rms(moved.torque).value(smoothstep(3)) * moved.unit, 6)
        2.444632

        The greatest torque of a gear that loses power has a branch for each side:

        >>> from optlaws import Problem, maximum, peak, synthesize
        >>> both = maximum(peak(moved.torque, side="high"), peak(moved.branches[-1], side="low"))
        >>> least = synthesize(Problem(order=3, minimise=both, monotone=True))
        >>> round(least.objective * moved.unit, 6), round(drive.sheet(least.law, 0.0, np.pi / 4.0, 0.25).peak_torque, 6)
        (2.514189, 2.514189)
        """
        moved = self.mechanism.dimensionless(start, stroke, duration, process=process)
        unit, i = moved.unit / self.ratio, self.ratio
        speed = abs(moved.stroke) / moved.duration
        train = self.train
        parts = {"c": train.inertia * i * speed / moved.duration, "b": train.viscous * i * speed, "1": train.coulomb}
        to_load, back = self.efficiencies
        motor = [
            f"{size / unit!r}*{name}" if name != "1" else repr(size / unit) for name, size in parts.items() if size
        ]
        shares = (1.0,) if to_load == back == 1.0 else (1.0 / to_load, back)
        through = [f"{share!r}*({moved.torque})" if share != 1.0 else moved.torque for share in shares]
        torque = " + ".join([*motor, through[0] if len(through) == 1 else f"max({', '.join(through)})"])
        branches = tuple(" + ".join([*motor, load]) for load in through)
        powers = [f"({branch})*b" for branch in branches]
        fed_back = [f"{self.regeneration!r}*{power}" for power in powers] if self.regeneration else ["0"]
        several = powers if self.regeneration == 1.0 else [*powers, *fed_back]
        power, energy = (some[0] if len(some) == 1 else f"max({', '.join(some)})" for some in (powers, several))
        units = (unit, unit * i * speed, unit * i * abs(moved.stroke))
        copper = unit * moved.duration / (self.motor.constant**2 * i * abs(moved.stroke))
        heat = f"{copper!r}*({torque})^2 + {self._burnt(powers)}" if copper else ""
        return DimensionlessDrive(torque, branches, power, energy, heat, *units)

    def _burnt(self, powers: list[str]) -> str:
        """The braking power that is not fed back, from the powers of which the greatest is the motor's."""
        share = 1.0 - self.regeneration
        if len(powers) == 1:
            return f"{share!r}*(max({powers[0]}, 0) - {powers[0]})"
        return f"{share!r}*(max({', '.join(powers)}, 0) - max({', '.join(powers)}))"

    def limit(
        self,
        minimise: DriveObjective,
        start: NumberOrQuantity,
        stroke: NumberOrQuantity,
        duration: NumberOrQuantity | None = None,
        *,
        limits: Mapping[str, Any] | None = None,
        heat: float = 0.0,
    ) -> MoveLimit:
        """A proven lower bound at the motor for motions from rest to rest that never turn back, in SI units.

        It is the limit within the motor's greatest speed, peak torque and curve; for the peak torque within its speed.
        A curve that is not concave counts by its concave hull. What the gear loses is in it.

        Parameters
        ----------
        minimise
            "peak torque", "rms torque", "energy" (without what is fed back) or "time", all at the motor.
        start, stroke, duration
            Of the mechanism's input; the least time has no duration.
        limits
            Greatest "velocity" and "acceleration" of the mechanism's input, and "torque" of the motor, each a quantity,
            or a list of parts of the way such as [("10 deg", "20 deg", "2 rad/s")].
        heat
            Copper heat, in W a squared N m, that is minimised together with the energy.

        Raises
        ------
        InputError
            If the stroke leaves the range, or nothing keeps the acceleration finite.
        InfeasibleProblem
            If the motor is too weak; the error states what is reachable, and its `proof` proves it.

        Examples
        --------
        >>> motor = Motor("3e-4 kg m^2", peak_torque="6 N m", greatest_speed="3000 rpm")
        >>> drive = Drive(Mechanism("0.8 kg m^2"), motor, ratio=20, efficiency=0.85)
        >>> print(drive.limit("rms torque", "0 deg", "45 deg", "0.25 s"))
        rms torque at least 2.02548 N m
        """
        way = self.mechanism.dimensionless(start, stroke, duration_of(minimise, duration))
        dimensions = DIMENSIONS[self.mechanism.axis]
        bounds = MoveBounds.read(limits, dimensions).plain(dimensions["load"])
        time = None if duration is None else way.duration
        return move_limit(LimitedMove(self, minimise, way.start, way.stroke, time, bounds, heat=heat))

    def sheet(
        self,
        law: str | MotionLaw,
        start: NumberOrQuantity,
        stroke: NumberOrQuantity,
        duration: NumberOrQuantity,
        *,
        period: NumberOrQuantity | None = None,
    ) -> DriveSheet:
        """The sheet that sizes the drive for a move by a law: torques, speed, powers, energies, and margins.

        Parameters
        ----------
        law
            A law, or a name of the catalogue.
        start, stroke, duration
            Of the mechanism's input.
        period
            From one move to the next, over which root mean squares and mean powers are taken: for the rest of it the
            motor holds the load; that of the move unless given.

        Raises
        ------
        InputError
            If the stroke leaves the range of the mechanism, or the period is shorter than the move.

        Examples
        --------
        >>> drive = Drive(Mechanism("0.8 kg m^2"), Motor("3e-4 kg m^2", rated_torque="2 N m"), ratio=20)
        >>> drive.sheet("modified sine", "0 deg", "45 deg", "0.25 s", period="0.6 s").summary()
                                          value        unit  at k
        peak torque                       3.195452435  N m   0.125
        RMS torque                        1.458517817  N m
        holding torque                    0            N m
        peak speed                        1055.762032  rpm
        greatest power, motoring          198.2263673  W
        greatest power, braking           198.2263673  W
        energy of a move, motoring        14.05682231  J
        energy of a move, braking         14.05682231  J
        energy of a cycle                 14.05682231  J
        mean power of the brake resistor  23.42803719  W
        inertia of load by motor          6.666666667
        RMS torque, used                  72.92589084  %
        """
        piece, time = self._move(law, start, stroke, duration, period)
        along = [PieceEffort(MotorTorque(self), each) for each in _with_rest(piece, time)]
        sheet = sheet_of(along, time, self.mechanism, self.motor, self.train)
        places = {
            name: float(piece.places(np.array(getattr(sheet, name)))) for name in ("peak_torque_at", "curve_use_at")
        }
        holding = float(np.sign(piece.stroke)) * self._load_after(piece) / self.ratio
        return DriveSheet(**{**vars(sheet), **places, "holding_torque": holding})

    def best_ratio(
        self,
        law: str | MotionLaw,
        start: NumberOrQuantity,
        stroke: NumberOrQuantity,
        duration: NumberOrQuantity,
        *,
        period: NumberOrQuantity | None = None,
    ) -> BestRatio:
        """The ratio of the least root mean square of the torque at the motor that the motor's limits allow.

        The mean square is J² i² mean(x''²) + mean(Y²)/i² and a constant, Y the torque through the gear: convex in i².

        Parameters
        ----------
        law, start, stroke, duration, period
            As `sheet` takes them.

        Raises
        ------
        InputError
            If the limits of the motor leave no ratio; the error names them.

        Examples
        --------
        >>> drive = Drive(Mechanism("0.8 kg m^2"), Motor("3e-4 kg m^2"))
        >>> best = drive.best_ratio("modified sine", "0 deg", "45 deg", "0.25 s")
        >>> round(best.ratio, 6), round((0.8 / 3e-4) ** 0.5, 6)
        (51.639778, 51.639778)
        """
        piece, time = self._move(law, start, stroke, duration, period)
        times, weights = PieceEffort(MotorTorque(self.with_ratio(1.0)), piece).parts.places
        x, v, w = (piece.values(times, nu) for nu in range(3))
        turning, dry, load = self._torques((x, v, w), piece.direction(times))
        holding = (1.0 - piece.duration / time) * self._load_after(piece) ** 2
        return best_ratio(TorqueByRatio(turning, dry, load, v, weights / time, holding), self.motor)

    def plot(
        self,
        law: str | MotionLaw,
        start: NumberOrQuantity,
        stroke: NumberOrQuantity,
        duration: NumberOrQuantity,
        ax: Any = None,
        **style: Any,
    ) -> list[Any]:
        """Draw torque over speed at the motor during a move, with the motor's curves; return the artists of matplotlib.

        Parameters
        ----------
        law, start, stroke, duration
            As `sheet` takes them.
        ax
            Axes of matplotlib; a new figure unless given.
        style
            What `Axes.plot` takes, for the move.
        """
        from optlaws.plots.machine import draw_move

        piece, _ = self._move(law, start, stroke, duration, None)
        return draw_move(PieceEffort(MotorTorque(self), piece), self.motor, ax, **style)

    def _load_after(self, piece: Piece) -> float:
        return float(self.mechanism.load(np.clip(piece.offset + piece.stroke, *self.mechanism.over)))

    def _move(
        self,
        law: str | MotionLaw,
        start: NumberOrQuantity,
        stroke: NumberOrQuantity,
        duration: NumberOrQuantity,
        period: NumberOrQuantity | None,
    ) -> tuple[Piece, float]:
        """The move, and the period."""
        moved = self.mechanism.dimensionless(start, stroke, duration)
        time = moved.duration if period is None else positive(si_number(period, ("time",), "period"), "period")
        if time < moved.duration * (1.0 - CLOSURE):
            raise InputError(f"period must be at least the duration of the move, {moved.duration:g} s, got {time:g} s")
        piece = Piece(0.0, moved.duration, moved.start, moved.stroke, named_law(law, "drive"))
        return piece, max(time, moved.duration)


def _with_rest(piece: Piece, period: float) -> list[Piece]:
    """A move and the rest after it until the next one."""
    rest = period - piece.duration
    if rest <= CLOSURE * period:
        return [piece]
    return [piece, Piece(piece.stop, rest, piece.offset + piece.stroke, 0.0, smoothstep(1))]


@dataclass(frozen=True)
class MotorTorque:
    """The torque at the motor of a drive along pieces of its mechanism's motion."""

    source: Drive
    breaks: tuple[float, ...] = ()

    @property
    def speed_ratio(self) -> float:
        """The ratio of the gear."""
        return self.source.ratio

    @property
    def regeneration(self) -> float:
        """The share of the braking energy that is fed back."""
        return self.source.regeneration

    @property
    def copper(self) -> float:
        """The copper heat of the motor by its squared torque."""
        return self.source.motor.constant**-2

    def along(self, piece: Piece, times: Array) -> Array:
        """The torque at times in a piece, above 0 towards greater positions."""
        x, v, w = (piece.values(times, nu) for nu in range(3))
        return np.asarray(self.source.torque(x, v, w, direction=piece.direction(times)))

    def kinks(self, piece: Piece) -> list[Callable[[Array], Array]]:
        """Functions of the time at whose zeros the torque has kinks: bends of the load, and where it turns."""

        def load(times: Array) -> Array:
            x, v, w = (piece.values(times, nu) for nu in range(3))
            return np.asarray(self.source.mechanism.torque(x, v, w, piece.direction(times)))

        return [*bends([self.source.mechanism.load_formula], piece), load]


def phase_move_of(move: LimitedMove) -> PhaseMove:
    """A move of a drive without dimensions, within what its motor allows."""
    drive = move.driven
    assert isinstance(drive, Drive)  # noqa: S101 - it is a drive's
    time = duration_of(move.minimise, move.duration)
    moved = drive.dimensionless(move.start, move.stroke, time)
    way = drive.mechanism.dimensionless(move.start, move.stroke, time)
    scales = MoveScales(moved.unit, moved.energy_unit, abs(way.stroke) / way.duration, way.duration)
    lines = [] if move.minimise == "peak torque" else drive.motor.peak_lines
    bounds = MoveBounds.read(dict(move.limits), DIMENSIONS[drive.mechanism.axis]).over(way.start, way.stroke)
    bounds = bounds.within(drive.motor.greatest_speed / drive.ratio, [(top, fall * drive.ratio) for top, fall in lines])
    return PhaseMove(moved.torque, scales, bounds, MoveCosts(drive.regeneration, move.heat), way.holding)


MOVED["drive"] = MovedKind(Drive, phase_move_of)
