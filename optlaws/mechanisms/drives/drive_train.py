"""A motor that drives a mechanism through a gear: torque and power at the motor, as numbers and as formulas."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from optlaws.entries.declared import Declared, ValueOf, declared, entry
from optlaws.entries.value_types import Either, InSI, Kept, Number, SINumber, Together, is_list
from optlaws.errors import InputError
from optlaws.formulas.tree import Formula
from optlaws.formulas.tree import Number as Constant
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw, smoothstep
from optlaws.mechanisms.drives.motor import NO_MOTOR, Motor
from optlaws.mechanisms.linkages.mechanism import Mechanism
from optlaws.mechanisms.linkages.mechanism_formulas import MOVED, LinearForce, StrokeTorque, Train
from optlaws.mechanisms.linkages.mechanism_kinds import MECHANISM
from optlaws.motion.piece import Piece, named_law
from optlaws.motion.quantities import check_scale, quantity
from optlaws.numbers import Array, NumberOrQuantity, positive
from optlaws.tolerances import CLOSURE

if TYPE_CHECKING:
    from optlaws.mechanisms.drives.effort import BestRatio, DriveSheet
    from optlaws.mechanisms.linkages.move_limit import MoveLimit
    from optlaws.synthesis.limits.plane_of_problem import DriveObjective

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

    @classmethod
    def of_input(cls, mechanism: Mechanism, regeneration: float = 0.0) -> Drive:
        """The drive of a mechanism at its input, without motor and gear.

        >>> Drive.of_input(Mechanism("2 kg", axis="length")).torque(0.0, 0.0, 3.0)
        6.0
        """
        return cls(mechanism, NO_MOTOR, regeneration=regeneration)

    def _check(self) -> None:
        if self.has_motor and self.mechanism.axis != "angle":
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
    def has_motor(self) -> bool:
        """Whether a motor drives, and not the mechanism's input itself."""
        return self.motor != NO_MOTOR

    @kept_property
    def train(self) -> Train:
        """Motor and gear in numbers."""
        motor, turning = self.motor, self.motor.inertia + self.inertia
        rubbing = motor.coulomb + self.no_load_torque
        known = (turning, motor.viscous, rubbing, *self.efficiencies)
        return Train(*known, self.ratio, self.regeneration, motor.constant**-2)

    @kept_property
    def linear(self) -> LinearForce | None:
        """The torque over the mechanism's motion where it is affine in that; None of others, and where a gear loses."""
        at_input, train, i = self.mechanism.linear, self.train, self.ratio
        if at_input is None or train.loses:
            return None
        of_motor = (i * train.inertia, i * train.viscous, 0.0, 0.0, train.coulomb)
        return LinearForce(*(force / i + each for force, each in zip(at_input, of_motor, strict=True)))

    @property
    def dry(self) -> float:
        """The greatest friction that changes sign with the velocity; 0 without friction."""
        return self.mechanism.coulomb + self.train.coulomb

    @property
    def brakes_as_it_drives(self) -> bool:
        """Whether motor and load are braked together: the torque of power back is then never greater than the torque.

        So it is where nothing but constant inertia is moved, and where motor and gear take no torque themselves.
        """
        train, mechanism = self.train, self.mechanism
        if not (train.inertia or train.viscous or train.coulomb):
            return True
        rubs = mechanism.viscous or mechanism.coulomb or train.viscous or train.coulomb
        return not rubs and isinstance(mechanism.inertia_formula, Constant) and mechanism.load_formula == Constant(0.0)

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
        time: Any = 0.0,
    ) -> Any:
        """The torque at the motor, N m, from position, velocity and acceleration of the mechanism's input, SI units.

        A process adds to the load at that input. Unless the `direction` is given, 1, -1 or 0, it moves the way of its
        velocity, and from rest that of its acceleration; at rest the motor holds the load without help of the gear's
        losses. The time, in s, is that of a load that depends on it.
        """
        v, w = np.asarray(velocity, dtype=np.float64), np.asarray(acceleration, dtype=np.float64)
        way = np.where(v == 0.0, np.sign(w), np.sign(v)) if direction is None else np.asarray(direction)
        turning, dry, load = self._torques((position, v, w), way, process, time)
        values = self.ratio * turning + dry + load / self.ratio
        return values if np.ndim(values) else float(values)

    def _torques(
        self, motion: tuple[Any, Array, Array], way: Array, process: Any = 0.0, time: Any = 0.0
    ) -> tuple[Array, Array, Array]:
        """P, Q and Y of the torque i P + Q + Y/i at the motor with a ratio i: inertia and viscous friction, dry, load.

        The motion is position, velocity and acceleration of the mechanism's input, the way its direction.
        """
        train, (_, v, w) = self.train, motion
        load = np.asarray(self.mechanism.torque(*motion, way, time=time)) + process
        driving = load * way  # as the other side of the gear feels it
        through = np.where(way == 0.0, load, np.maximum(driving / train.to_load, driving * train.back) * way)
        return train.inertia * w + train.viscous * v, train.coulomb * way, through

    def dimensionless(
        self,
        start: NumberOrQuantity,
        stroke: NumberOrQuantity,
        duration: NumberOrQuantity,
        *,
        process: Formula | None = None,
        begins: float = 0.0,
    ) -> StrokeTorque:
        """The drive over a stroke of the mechanism's input: formulas of a law for `peak`, `rms` and `integral`.

        It takes what `Mechanism.dimensionless` takes, and raises what that raises.

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
        moved = self.mechanism.dimensionless(start, stroke, duration, process=process, begins=begins)
        return replace(moved, unit=moved.unit / self.ratio, train=self.train)

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

        It takes what `Mechanism.limit` takes, of the mechanism's input, but what is minimised, a limit of the "torque"
        and the heat are at the motor; of the energy what is fed back is left out.

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
        RMS torque at least 2.02548 N m
        """
        from optlaws.mechanisms.linkages.move_limit import limit_of

        return limit_of(self, minimise, (start, stroke), duration, limits, heat=heat)

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
        >>> sheet = drive.sheet("modified sine", "0 deg", "45 deg", "0.25 s", period="0.6 s")
        >>> round(sheet.peak_torque, 9), sheet.peak_torque_at, round(sheet.braking_heat, 8)
        (3.195452435, 0.125, 23.42803719)
        >>> {margin.name: round(margin.use, 8) for margin in sheet.margins}
        {'RMS torque': 0.72925891}
        """
        from optlaws.mechanisms.drives.effort import DriveSheet, PieceEffort

        piece, time = self._move(law, start, stroke, duration, period)
        rest = Piece(piece.stop, time - piece.duration, piece.offset + piece.stroke, 0.0, smoothstep(1))
        pieces = [piece, rest] if rest.duration > CLOSURE * time else [piece]
        sheet = DriveSheet.of([PieceEffort(self, each) for each in pieces], time)
        peak_at, use_at = piece.places(np.array([sheet.peak_torque_at, sheet.curve_use_at])).tolist()
        holding = float(np.sign(piece.stroke)) * self._load_after(piece) / self.ratio
        return replace(sheet, peak_torque_at=peak_at, curve_use_at=use_at, holding_torque=holding)

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

        The move is as `sheet` takes it.

        Raises
        ------
        InfeasibleProblem
            If the limits of the motor leave no ratio; the error names them.

        Examples
        --------
        >>> drive = Drive(Mechanism("0.8 kg m^2"), Motor("3e-4 kg m^2"))
        >>> best = drive.best_ratio("modified sine", "0 deg", "45 deg", "0.25 s")
        >>> round(best.ratio, 6), round((0.8 / 3e-4) ** 0.5, 6)
        (51.639778, 51.639778)
        """
        from optlaws.mechanisms.drives.effort import PieceEffort, TorqueByRatio

        piece, time = self._move(law, start, stroke, duration, period)
        times, weights = PieceEffort(self.with_ratio(1.0), piece).parts.places
        x, v, w = (piece.values(times, nu) for nu in range(3))
        turning, dry, load = self._torques((x, v, w), piece.direction(times))
        holding = (1.0 - piece.duration / time) * self._load_after(piece) ** 2
        return TorqueByRatio(turning, dry, load, v, weights / time, holding).best(self.motor)

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

        The move is as `sheet` takes it; `ax` are axes of matplotlib, a new figure unless given, and `style` is what
        `Axes.plot` takes, for the move.
        """
        from optlaws.mechanisms.drives.effort import PieceEffort
        from optlaws.plots.machine import draw_torque_over_speed

        piece, _ = self._move(law, start, stroke, duration, None)
        shown = {"way": np.sign(piece.stroke), "label": "move", **style}
        return draw_torque_over_speed([PieceEffort(self, piece)], ax, **shown)

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
        moved = self.mechanism.dimensionless(start, stroke, duration)
        time = moved.duration if period is None else positive(quantity(period, "time", "period", bare=True), "period")
        if time < moved.duration * (1.0 - CLOSURE):
            raise InputError(f"period must be at least the duration of the move, {moved.duration:g} s, got {time:g} s")
        piece = Piece(0.0, moved.duration, moved.start, moved.stroke, named_law(law, "drive"))
        return piece, max(time, moved.duration)


MOVED["drive"] = Drive
