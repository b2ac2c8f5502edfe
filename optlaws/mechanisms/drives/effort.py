"""The effort of a drive along a motion: forces, powers and energies, the sheet of a motor, and its best ratio."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import inf, isfinite, sqrt
from typing import Any, ClassVar, NamedTuple, Self, TypeAlias

import numpy as np

from optlaws.errors import InfeasibleProblem
from optlaws.formulas.arithmetic import NUMPY, evaluate
from optlaws.formulas.branches import corners
from optlaws.formulas.tree import Formula, table_places
from optlaws.kept import kept_property
from optlaws.laws.storage import PlainNumbers
from optlaws.mechanisms.drives.motor import Motor
from optlaws.motion.derivative_panel import times_in
from optlaws.motion.piece import Piece
from optlaws.motion.quantities import RPM
from optlaws.motion.smooth_parts import Greatest, SmoothParts
from optlaws.numbers import Array
from optlaws.numerics.peaks import is_kept
from optlaws.shown.summary import Row, Summary
from optlaws.tolerances import AGREEMENT, VALUE_ROUNDING

#: a `Drive`, which knows this module
AnyDrive: TypeAlias = Any

_LIMIT_USED = 1e-6  # of a motor's limit: so much of it is left, as peaks are looked for at places alone
_RATIOS = 121
_DECADES = 0.7
_FAR = 10.0


@dataclass(frozen=True)
class Effort(PlainNumbers):
    """The force and power of a drive over a cycle, in SI units.

    Attributes
    ----------
    peak_force, peak_force_at
        The greatest magnitude of the force, or of the torque of a table, at the follower, or at the motor; and its
        time.
    rms_force
        Its root mean square over the cycle.
    peak_power
        The greatest magnitude of the power; divided by the master's angular velocity it is the greatest torque that
        the motion requires of the master's shaft.
    mean_power
        What friction takes.
    motoring_power, braking_power
        The greatest power that the drive gives, and that it takes back, both at least 0.
    motoring_energy, braking_energy
        Of a cycle, J, both at least 0.
    energy
        Of a cycle: what is fed back is subtracted.
    """

    peak_force: float
    peak_force_at: float
    rms_force: float
    peak_power: float
    mean_power: float
    motoring_power: float
    braking_power: float
    motoring_energy: float
    braking_energy: float
    energy: float

    @classmethod
    def of(cls, along: Sequence[PieceEffort], duration: float, **more: Any) -> Self:
        """The force and power of a drive over a duration, from its values along each piece."""
        peak = Greatest.of(*map(np.array, zip(*(each.peak_force for each in along), strict=True)))
        given, taken = (max(powers) for powers in zip(*(each.powers for each in along), strict=True))
        driving, braking = (sum(energies) for energies in zip(*(each.energies for each in along), strict=True))
        power, mean = max(given, taken), (driving - braking) / duration
        return cls(
            *(peak.value, peak.place, sqrt(sum(each.square for each in along) / duration)),
            *(power, mean if abs(mean) > VALUE_ROUNDING * power else 0.0),
            *(given, taken, driving, braking, driving - along[0].drive.regeneration * braking),
            **more,
        )

    def shaft_torque(self, angular_velocity: float) -> float:
        """The greatest torque at a shaft of constant angular velocity, rad/s."""
        return self.peak_power / angular_velocity


@dataclass(frozen=True)
class SegmentEffort(Effort):
    """The drive's force, power and energy in a segment of a cycle, in SI units, with the `name` of the segment."""

    name: str


@dataclass(frozen=True, eq=False)
class PieceEffort:
    """The drive's force, power and energy along a piece, or between two times in it, in SI units."""

    drive: AnyDrive
    piece: Piece
    ends: tuple[float, float] | None = None

    def force(self, times: Array) -> Array:
        """The force or torque."""
        motion, direction = (self.piece.values(times, nu) for nu in range(3)), self.piece.direction(times)
        return np.asarray(self.drive.torque(*motion, direction=direction, time=times), dtype=np.float64)

    def power(self, times: Array) -> Array:
        """Force times velocity: at the motor, torque times its speed."""
        return self.force(times) * self.speed(times)

    def speed(self, times: Array) -> Array:
        """The velocity at which the force acts: at the motor, its speed."""
        return np.asarray(self.drive.ratio * self.piece.values(times, 1))

    def use(self, times: Array) -> Array:
        """The share of the motor's peak torque at its speed."""
        return _share(np.abs(self.force(times)), self.drive.motor.peak_at(self.speed(times)))

    @kept_property
    def parts(self) -> SmoothParts:
        """Parts of the piece on which force and power are smooth and of one sign."""
        piece, load = self.piece, self.drive.mechanism.load_formula

        def bend(switch: Formula) -> Callable[[Array], Array]:
            def value(times: Array) -> Array:
                values = evaluate(switch, {"x": piece.values(times, 0), "t": times}, NUMPY)
                return np.broadcast_to(np.asarray(values, dtype=np.float64), np.shape(times))

            return value

        def before_gear(times: Array) -> Array:
            motion = (piece.values(times, nu) for nu in range(3))
            return np.asarray(self.drive.mechanism.torque(*motion, piece.direction(times), time=times))

        places = (piece.start + piece.duration * place for place in piece.law.breaks)
        breaks = [*places, *piece.turns, *table_places(load, "t")]
        signs: list[Callable[[Array], Array]] = []
        if piece.stroke:
            signs = [bend(switch) for switch in corners(load, "xt")]
            signs += [*([before_gear] if self.drive.train.loses else []), self.force]
        start, stop = self.ends or (piece.start, piece.stop)
        inside = [time for time in breaks if start < time < stop]
        return SmoothParts.between(start, stop, breaks=inside, signs=signs)

    @kept_property
    def peak_force(self) -> Greatest:
        """The greatest magnitude of the force, and its time."""
        return self.parts.greatest(lambda times: np.abs(self.force(times)))

    @kept_property
    def powers(self) -> tuple[float, float]:
        """The greatest power that is given, and that is taken back, both at least 0."""
        given, taken = self.parts.greatest(self.power), self.parts.greatest(lambda times: -self.power(times))
        return max(0.0, given.value), max(0.0, taken.value)

    @kept_property
    def energies(self) -> tuple[float, float]:
        """The energy that is given, and that is taken back, both at least 0, J."""
        times, weights = self.parts.places
        powers = self.power(times)
        return float(weights @ np.maximum(powers, 0.0)), float(weights @ np.maximum(-powers, 0.0))

    @kept_property
    def load_works(self) -> tuple[float, float]:
        """The work that is done against the load of the mechanism, and that the load gives back, both at least 0, J."""
        piece, load = self.piece, self.drive.mechanism.load_formula

        def power(times: Array) -> Array:
            values = evaluate(load, {"x": piece.values(times, 0), "t": times}, NUMPY)
            return np.asarray(values * piece.values(times, 1), dtype=np.float64)

        edges = self.parts.edges
        parts = SmoothParts.between(edges[0], edges[-1], breaks=edges[1:-1], signs=[power] if piece.stroke else [])
        against = parts.integral(lambda times: np.maximum(power(times), 0.0))
        return against, parts.integral(lambda times: np.maximum(-power(times), 0.0))

    @property
    def energy(self) -> float:
        """The energy that is given less the share of it that is fed back, J."""
        given, taken = self.energies
        return given - float(self.drive.regeneration) * taken

    @property
    def heat(self) -> float:
        """The copper heat and the energy that is taken back and not fed back, J."""
        train = self.drive.train
        return float(train.copper * self.square + (1.0 - train.regeneration) * self.energies[1])

    @property
    def square(self) -> float:
        """The integral of the square of the force."""
        return self.parts.integral(lambda times: self.force(times) ** 2)


def over_speed(along: Sequence[PieceEffort], count: int) -> tuple[Array, Array]:
    """Speeds of the motor, rad/s, and torques, N m, at points in each piece and at its breaks."""
    times = [times_in(each.piece, count) for each in along]
    values = [(each.speed(inside), each.force(inside)) for each, inside in zip(along, times, strict=True)]
    return np.concatenate([speeds for speeds, _ in values]), np.concatenate([torques for _, torques in values])


class Margin(NamedTuple):
    """A limit of the motor: what is needed and what it has, in SI units, and their ratio, above 1 of one too weak."""

    name: str
    needed: float
    limit: float
    use: float

    @property
    def is_kept(self) -> bool:
        """Whether the motor is strong enough, up to rounding: a limit that is reached is kept."""
        return is_kept(self.use, 1.0)


@dataclass(frozen=True)
class DriveSheet(PlainNumbers):
    """Requirements of a move on a motor, in SI units; torques are above 0 in the direction of the stroke.

    Attributes
    ----------
    peak_torque, peak_torque_at
        The greatest magnitude, and the k at which it is: 1 where holding the load between moves takes most.
    rms_torque
        Over the period, holding included.
    holding_torque
        Between the moves.
    peak_speed, mean_speed
        rad/s; the mean is over the period.
    motoring_power, braking_power
        The greatest power that the motor gives, and that it takes back, both at least 0.
    motoring_energy, braking_energy
        Of a move, J, both at least 0.
    energy
        Of a cycle: what is fed back is subtracted.
    braking_heat, copper_heat
        The mean powers of the brake resistor and of the winding over the period, W; the one of the winding is 0 of a
        motor without a motor constant.
    inertia_match
        The greatest inertia of the load at the motor's shaft by that of motor and gear.
    curve_use, curve_use_at
        The greatest torque by the motor's curve of peak torque at that speed, and its k.
    rated_use
        The root mean square of the torque by the motor's continuous torque at the mean speed.
    peak_limit, rated_limit, speed_limit
        Of the motor; None where it has none.
    """

    _of: ClassVar[str] = "move"
    _at: ClassVar[str] = "k"

    peak_torque: float
    peak_torque_at: float
    rms_torque: float
    holding_torque: float
    peak_speed: float
    mean_speed: float
    motoring_power: float
    braking_power: float
    motoring_energy: float
    braking_energy: float
    energy: float
    braking_heat: float
    copper_heat: float
    inertia_match: float
    curve_use: float
    curve_use_at: float
    rated_use: float
    peak_limit: float
    rated_limit: float
    speed_limit: float

    @classmethod
    def of(cls, along: Sequence[PieceEffort], period: float) -> Self:
        """The sheet of a motor, from its torque along each piece of a motion that is repeated with a period."""
        drive, total = along[0].drive, Effort.of(along, period)
        motor, train, rms = drive.motor, drive.train, total.rms_force
        uses = (each.parts.greatest(each.use) for each in along)
        use, use_at = max(uses, key=lambda peak: peak.value) if motor.curve else (0.0, 0.0)
        speeds = [(each.parts, lambda times, speed=each.speed: np.abs(speed(times))) for each in along]
        mean_speed = sum(parts.integral(speed) for parts, speed in speeds) / period
        rests = (float(each.force(np.array([each.peak_force.place]))[0]) for each in along if not each.piece.stroke)
        holding = max(rests, key=abs, default=0.0)
        rated = float(motor.continuous_at(mean_speed))
        reached = [value for each in along for value, _ in each.piece.extremes(0, each.piece.start, each.piece.stop)]
        low, high = np.clip([min(reached), max(reached)], *drive.mechanism.over).tolist()
        inertia = drive.mechanism.greatest_inertia(low, high) / train.ratio**2
        return cls(
            *(total.peak_force, total.peak_force_at, rms),
            holding if abs(holding) > VALUE_ROUNDING * total.peak_force else 0.0,
            *(max(parts.greatest(speed).value for parts, speed in speeds), mean_speed),
            *(total.motoring_power, total.braking_power),
            *(total.motoring_energy, total.braking_energy, total.energy),
            *((1.0 - train.regeneration) * total.braking_energy / period, rms**2 * train.copper),
            *(inertia / train.inertia if train.inertia else inf, use, use_at),
            float(_share(np.array(rms), np.array(rated))),
            *(motor.peak_torque, rated, motor.greatest_speed),
        )

    @property
    def margins(self) -> tuple[Margin, ...]:
        """The limits of the motor, with the move's use of them."""
        known = (
            Margin("peak torque", self.peak_torque, self.peak_limit, self.peak_torque / self.peak_limit),
            Margin("torque-speed curve", self.curve_use, 1.0, self.curve_use),
            Margin("RMS torque", self.rms_torque, self.rated_limit, self.rated_use),
            Margin("speed", self.peak_speed, self.speed_limit, self.peak_speed / self.speed_limit),
        )
        return tuple(margin for margin in known if margin.use > 0.0 and isfinite(margin.limit))

    @property
    def fits(self) -> bool:
        """Whether the motor satisfies all requirements of the move."""
        return all(margin.is_kept for margin in self.margins)

    def summary(self) -> Summary:
        """The sheet as rows: values, units, and the k of those that are reached somewhere."""
        rows = [
            Row("peak torque", self.peak_torque, "N m", self.peak_torque_at),
            Row("RMS torque", self.rms_torque, "N m"),
            Row("holding torque", self.holding_torque, "N m"),
            Row("peak speed", self.peak_speed * RPM, "rpm"),
            Row("greatest power, motoring", self.motoring_power, "W"),
            Row("greatest power, braking", self.braking_power, "W"),
            Row(f"energy of a {self._of}, motoring", self.motoring_energy, "J"),
            Row(f"energy of a {self._of}, braking", self.braking_energy, "J"),
            *([Row("energy of a cycle", self.energy, "J")] if self.energy < self.motoring_energy else []),
            Row("mean power of the brake resistor", self.braking_heat, "W"),
            *([Row("mean power of the copper heat", self.copper_heat, "W")] if self.copper_heat else []),
            Row("inertia of load by motor", self.inertia_match),
        ]
        rows += [
            Row(f"{margin.name}, used", 100.0 * margin.use, "%", note="" if margin.is_kept else "too weak")
            for margin in self.margins
        ]
        return Summary(rows, at=self._at)

    def __str__(self) -> str:
        return str(self.summary())

    def _repr_html_(self) -> str:
        return self.summary()._repr_html_()


@dataclass(frozen=True)
class CycleSheet(DriveSheet):
    """The motor's duty in a cycle, in SI units: a `DriveSheet` of all its motions, with places as times.

    Torques are above 0 towards greater positions; the holding torque is the greatest of all rests.

    Examples
    --------
    >>> from optlaws import Cycle, Drive, Dwell, Mechanism, Motor, Rise
    >>> drive = Drive(Mechanism("0.8 kg m^2"), Motor("3e-4 kg m^2", rated_torque="2 N m"), ratio=20)
    >>> moves = [Rise("45 deg", "0.25 s", law="modified sine"), Dwell()]
    >>> sheet = Cycle(moves, period="0.6 s", advance="45 deg", drive=drive).sheet
    >>> round(sheet.rms_torque, 6), sheet.fits, {margin.name: round(margin.use, 6) for margin in sheet.margins}
    (1.458518, True, {'RMS torque': 0.729259})
    """

    _of: ClassVar[str] = "cycle"
    _at: ClassVar[str] = "s"


@dataclass(frozen=True, eq=False)
class BestRatio:
    """The ratio of the least root mean square torque at the motor, and the curve around it.

    Attributes
    ----------
    ratio
        The best one that the motor's limits allow.
    rms_torque
        At that ratio, N m.
    unlimited
        The best one without limits.
    ratios, rms_torques, peak_torques, peak_speeds
        The curve: N m and rad/s.
    """

    ratio: float
    rms_torque: float
    unlimited: float
    ratios: Array
    rms_torques: Array
    peak_torques: Array
    peak_speeds: Array

    def plot(self, ax: Any = None, **style: Any) -> list[Any]:
        """Draw the root mean square and the peak of the torque over the ratio, with the best one marked."""
        from optlaws.plots.machine import draw_best_ratio

        return draw_best_ratio(self, ax, **style)


def _share(torque: Array, limit: Array) -> Array:
    """The use of a limit by a torque; infinite where the limit leaves nothing."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(torque == 0.0, 0.0, torque / limit)


@dataclass(frozen=True, eq=False)
class TorqueByRatio:
    """The torque of a motion at a ratio i: i P + Q + Y/i, P of inertia and viscous friction, Q dry friction, Y load."""

    turning: Array  #: P at some places, N m
    dry: Array
    load: Array
    speed: Array  #: of the mechanism's input there, rad/s
    weights: Array  #: of the places in a mean over the period
    holding: float  #: the share of the mean square of Y that is held between the moves

    def torques(self, ratio: Any) -> Array:
        """The torque at all places, a row for each ratio."""
        i = np.asarray(ratio, dtype=np.float64)[..., None]
        return i * self.turning + self.dry + self.load / i

    def rms(self, ratio: Any) -> Array:
        """The root mean square over the period."""
        return np.asarray(np.sqrt(self.torques(ratio) ** 2 @ self.weights + self.holding / np.asarray(ratio) ** 2))

    def peak(self, ratio: Any) -> Array:
        """The greatest magnitude of values."""
        return np.asarray(np.abs(self.torques(ratio)).max(axis=-1))

    def use(self, ratio: Any, motor: Motor) -> Array:
        """The greatest share of the motor's peak torque, at its speed."""
        speeds = np.asarray(ratio, dtype=np.float64)[..., None] * self.speed
        return np.asarray(_share(np.abs(self.torques(ratio)), motor.peak_at(speeds)).max(axis=-1))

    def best(self, motor: Motor) -> BestRatio:
        """The ratio of the least root mean square torque that the motor allows, and the curve around it.

        The mean square is convex in the logarithm of the ratio, as its powers are, whose factors are not below 0 but
        for those of dry friction.
        """
        from scipy.optimize import minimize_scalar

        squares = (self.turning**2 @ self.weights, self.load**2 @ self.weights + self.holding)
        if not all(squares):
            raise InfeasibleProblem(
                "no ratio is best: without inertia of motor and gear a greater ratio is always better, and without "
                "load a smaller one"
            )
        unlimited = float((squares[1] / squares[0]) ** 0.25)
        if self.dry.any():
            optimum = minimize_scalar(
                lambda log: float(self.rms(unlimited * np.exp(log))), bounds=(-_FAR, _FAR), method="bounded",
                options={"xatol": AGREEMENT},
            )  # fmt: skip
            unlimited *= float(np.exp(optimum.x))
        ratios, best = unlimited * np.logspace(-_DECADES, _DECADES, _RATIOS), self._within(motor, unlimited)
        speeds = ratios * np.abs(self.speed).max()
        return BestRatio(best, float(self.rms(best)), unlimited, ratios, self.rms(ratios), self.peak(ratios), speeds)

    def _within(self, motor: Motor, unlimited: float) -> float:
        """The ratio nearest to the best one, in its logarithm, at which speed and peak torque are the motor's."""
        from scipy.optimize import brentq

        def excess(ratio: float) -> float:
            return min(float(self.use(ratio, motor)), _FAR) - (1.0 - _LIMIT_USED)

        fastest = motor.greatest_speed / float(np.abs(self.speed).max()) * (1.0 - _LIMIT_USED)
        start = min(unlimited, fastest)
        if excess(start) <= 0.0:
            return start
        tried = start * np.logspace(-1.0, 1.0, 2 * _RATIOS - 1)
        tried = tried[tried <= fastest]
        allowed = np.flatnonzero(self.use(tried, motor) <= 1.0 - _LIMIT_USED)
        if not len(allowed):
            speed = f"its speed allows a ratio of {fastest:.6g} at most, and " if isfinite(fastest) else ""
            raise InfeasibleProblem(
                f"no ratio lets the {motor.name} make this move: {speed}the least peak torque there is "
                f"{self.peak(tried).min():.6g} N m; take a stronger motor, or more time"
            )
        i = int(allowed[np.argmin(np.abs(np.log(tried[allowed] / start)))])
        beyond = tried[i + 1 if tried[i] < start else i - 1]
        if excess(tried[i]) >= -_LIMIT_USED:
            return float(tried[i])
        exact = _LIMIT_USED * tried[i] / 10.0
        return float(brentq(lambda ratio: excess(ratio) + _LIMIT_USED, tried[i], beyond, xtol=exact))
