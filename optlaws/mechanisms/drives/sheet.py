"""The sheet that sizes a drive for a move or a cycle, and the ratio of the least root mean square torque."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from math import inf, isfinite
from typing import Any, ClassVar, NamedTuple

import numpy as np

from optlaws.errors import InfeasibleProblem
from optlaws.laws.storage import PlainNumbers
from optlaws.mechanisms.drives.effort import PieceEffort, effort
from optlaws.mechanisms.drives.motor import Motor
from optlaws.motion.display_units import RPM
from optlaws.motion.smooth_parts import Greatest
from optlaws.numbers import Array
from optlaws.numerics.peaks import is_kept
from optlaws.shown.summary import Row, Summary
from optlaws.tolerances import AGREEMENT, VALUE_ROUNDING

_LIMIT_USED = 1e-6  # of a motor's limit: so much of it is left, as peaks are looked for at places alone

_RATIOS = 121
_DECADES = 0.7
_FAR = 10.0


class Margin(NamedTuple):
    """A limit of the motor: the required value, the limit, and their ratio.

    Attributes
    ----------
    name
        Of the limit.
    needed, limit
        In SI units.
    use
        needed/limit: above 1 the motor is too weak.
    """

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
            Row("energy of a cycle", self.energy, "J"),
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


def sheet_of(along: Sequence[PieceEffort], period: float) -> CycleSheet:
    """The sheet of a motor, from its torque along each piece of a motion that is repeated with a period."""
    drive, total = along[0].drive, effort(along, period)
    mechanism, motor, train = drive.mechanism, drive.motor, drive.train
    speed, use = _greatest(along, _speed), _greatest(along, _use)
    mean_speed = sum(each.parts.integral(partial(_speed, each)) for each in along) / period
    rests = [_holding(each) for each in along if not each.piece.stroke]
    holding = max(rests, key=abs, default=0.0)
    rated = float(motor.continuous_at(mean_speed))
    reached = [value for each in along for value, _ in each.piece.extremes(0, each.piece.start, each.piece.stop)]
    low, high = np.clip([min(reached), max(reached)], *mechanism.over).tolist()
    inertia = mechanism.greatest_inertia(low, high) / train.ratio**2
    rms = total.rms_force
    return CycleSheet(
        *(total.peak_force, total.peak_force_at, rms),
        *(holding if abs(holding) > VALUE_ROUNDING * total.peak_force else 0.0, speed.value, mean_speed),
        *(total.motoring_power, total.braking_power),
        *(total.motoring_energy, total.braking_energy, total.energy),
        *((1.0 - train.regeneration) * total.braking_energy / period, rms**2 * train.copper),
        inertia / train.inertia if train.inertia else inf,
        *((use.value, use.place) if motor.curve else (0.0, 0.0)),
        float(share_used(np.array(rms), np.array(rated))),
        *(motor.peak_torque, rated, motor.greatest_speed),
    )


def _greatest(along: Sequence[PieceEffort], function: Callable[[PieceEffort, Array], Array]) -> Greatest:
    return max((each.parts.greatest(partial(function, each)) for each in along), key=lambda peak: peak.value)


def _holding(along: PieceEffort) -> float:
    """The torque of the greatest magnitude in a rest."""
    place = along.peak_force.place
    return float(along.force(np.array([place]))[0])


def _speed(along: PieceEffort, times: Array) -> Array:
    return np.abs(along.speed(times))


def _use(along: PieceEffort, times: Array) -> Array:
    """The share of the motor's peak torque at its speed."""
    return share_used(np.abs(along.force(times)), along.drive.motor.peak_at(along.speed(times)))


def share_used(torque: Array, limit: Array) -> Array:
    """The use of a limit by a torque; infinite where the limit leaves nothing."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(torque == 0.0, 0.0, torque / limit)


@dataclass(frozen=True, eq=False)
class TorqueByRatio:
    """The torque of a motion at any ratio i: i P + Q + Y/i, P of inertia and viscous friction, Q dry friction, Y load.

    Attributes
    ----------
    turning, dry, load
        P, Q and Y at some places, N m.
    speed
        Of the mechanism's input there, rad/s.
    weights
        Of the places in a mean over the period.
    holding
        The share of the mean square of Y that is held between the moves.
    """

    turning: Array
    dry: Array
    load: Array
    speed: Array
    weights: Array
    holding: float

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
        return np.asarray(share_used(np.abs(self.torques(ratio)), motor.peak_at(speeds)).max(axis=-1))

    @property
    def unlimited(self) -> float:
        """The ratio of the least root mean square."""
        from scipy.optimize import minimize_scalar

        squares = (self.turning**2 @ self.weights, self.load**2 @ self.weights + self.holding)
        if not all(squares):
            raise InfeasibleProblem(
                "no ratio is best: without inertia of motor and gear a greater ratio is always better, and without "
                "load a smaller one"
            )
        near = float((squares[1] / squares[0]) ** 0.25)
        if not self.dry.any():
            return near
        optimum = minimize_scalar(
            lambda log: float(self.rms(near * np.exp(log))), bounds=(-_FAR, _FAR), method="bounded",
            options={"xatol": AGREEMENT},
        )  # fmt: skip
        return near * float(np.exp(optimum.x))


def best_ratio(by_ratio: TorqueByRatio, motor: Motor) -> BestRatio:
    """The ratio of the least root mean square torque, and the curve around it.

    The mean square is convex in the logarithm of the ratio, as its powers are, whose factors are not below 0 but for
    those of dry friction.
    """
    unlimited = by_ratio.unlimited
    ratios = unlimited * np.logspace(-_DECADES, _DECADES, _RATIOS)
    best = _within_limits(by_ratio, motor, unlimited)
    speeds = ratios * np.abs(by_ratio.speed).max()
    rms = float(by_ratio.rms(best))
    return BestRatio(best, rms, unlimited, ratios, by_ratio.rms(ratios), by_ratio.peak(ratios), speeds)


def _within_limits(by_ratio: TorqueByRatio, motor: Motor, unlimited: float) -> float:
    """The ratio nearest to the best one, in its logarithm, at which speed and peak torque are within the motor's."""
    from scipy.optimize import brentq

    def excess(ratio: float) -> float:
        return min(float(by_ratio.use(ratio, motor)), _FAR) - (1.0 - _LIMIT_USED)

    fastest = motor.greatest_speed / float(np.abs(by_ratio.speed).max()) * (1.0 - _LIMIT_USED)
    start = min(unlimited, fastest)
    if excess(start) <= 0.0:
        return start
    tried = start * np.logspace(-1.0, 1.0, 2 * _RATIOS - 1)
    tried = tried[tried <= fastest]
    allowed = np.flatnonzero(by_ratio.use(tried, motor) <= 1.0 - _LIMIT_USED)
    if not len(allowed):
        speed = f"its speed allows a ratio of {fastest:.6g} at most, and " if isfinite(fastest) else ""
        raise InfeasibleProblem(
            f"no ratio lets the {motor.name} make this move: {speed}the least peak torque there is "
            f"{by_ratio.peak(tried).min():.6g} N m; take a stronger motor, or more time"
        )
    i = int(allowed[np.argmin(np.abs(np.log(tried[allowed] / start)))])
    beyond = tried[i + 1 if tried[i] < start else i - 1]
    if excess(tried[i]) >= -_LIMIT_USED:
        return float(tried[i])
    return float(
        brentq(lambda ratio: excess(ratio) + _LIMIT_USED, tried[i], beyond, xtol=_LIMIT_USED * tried[i] / 10.0)
    )
