"""The report of an executed motion beside its law: peaks, jumps, deviation, travel, effect of the drive's cycle."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import floor, inf, isfinite, nan
from typing import Any

import numpy as np

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.motion.motion import Motion
from optlaws.motion.polynomials import Extreme, PiecewiseMotion
from optlaws.motion.quantities import quantity
from optlaws.numbers import MOST_VALUES, Array, Quantity
from optlaws.numerics import bernstein

_NAMES = ("Position", "Velocity", "Acceleration", "Jerk")
ORDERS = range(4)
#: of a motion that is sampled: its second differences need some
_FEWEST_TASKS = 4
ROUNDING = 1e-9, 2.0**-46  # jumps below these shares, of the peak and of what positions leave, are rounding


@dataclass(frozen=True)
class Characteristics:
    """Characteristics of a cam, those that TwinCAT computes (CamCharacteristics) and its jumps beside them.

    Slave values are by the second where it is known how fast the master goes, else by the master's unit.

    Parameters
    ----------
    start, end
        Position, velocity, acceleration and jerk at both ends, inside the motion.
    least, greatest
        Of each of the four, with the master's position; no impulses: `jumps` has them.
    mean_absolute_velocity, effective_acceleration
        Mean magnitude of the velocity; root mean square of the acceleration.
    jumps, jumps_at_ends
        The greatest jumps of velocity, acceleration and jerk: inside; and where the motion begins again or, if it does
        not, where rest comes before and after it.
    """

    start: tuple[float, ...]
    end: tuple[float, ...]
    least: tuple[Extreme, ...]
    greatest: tuple[Extreme, ...]
    mean_absolute_velocity: float
    effective_acceleration: float
    jumps: tuple[Extreme, ...]
    jumps_at_ends: tuple[float, ...]

    def peak(self, nu: int) -> float:
        """The greatest magnitude of the derivative of order nu; inf where a lower one jumps inside."""
        if any(jump.value for jump in self.jumps[: max(nu - 1, 0)]):
            return inf
        return max(abs(self.least[nu].value), abs(self.greatest[nu].value))

    def results(self) -> dict[str, Any]:
        """The characteristics by TwinCAT's names, as plain data; what is infinite is null."""
        data: dict[str, Any] = {"StartPoint": _end(self.start), "EndPoint": _end(self.end)}
        for side, extremes in (("Min", self.least), ("Max", self.greatest)):
            for name, extreme in zip(_NAMES, extremes, strict=True):
                data[f"PointAt{side}Slave{name}"] = _point(name, extreme)
        data["SlaveMeanAbsoluteVelocity"] = self.mean_absolute_velocity
        data["SlaveEffectiveAcceleration"] = finite_or_none(self.effective_acceleration)
        for name, extreme, end in zip(_NAMES[1:], self.jumps, self.jumps_at_ends, strict=True):
            data[f"Jump{name}"] = _point(name, extreme)
            data[f"JumpAtEnds{name}"] = finite_or_none(end)
        return data


@dataclass(frozen=True)
class Report:
    """The motion that the controller runs beside the law, both in machine units.

    Parameters
    ----------
    run, law
        Their characteristics.
    deviation
        The greatest difference of position, velocity and acceleration, each with the master's position; inf for a
        derivative that one of the two does not have everywhere.
    rate
        Units of the master that pass in a second; 1 where it is not known, and slave values are by the master.
    bound
        What the rounding of positions may add to the peak of the acceleration.

    Examples
    --------
    >>> from optlaws.numerics.splines import spline_powers
    >>> from optlaws.motion.motion import motion_of_law
    >>> from optlaws import smoothstep
    >>> motion = motion_of_law(smoothstep(3), stroke="35 mm", duration="0.1 s")
    >>> x = np.linspace(0.0, 0.1, 13)
    >>> report = as_run(PiecewiseMotion(x, spline_powers(x, motion(x))), motion)
    >>> round(report.ratio(2), 4), round(report.deviation[0].value, 6), round(report.run.jumps_at_ends[1], 3)
    (0.9923, 0.00154, 701.101)
    """

    run: Characteristics
    law: Characteristics
    deviation: tuple[Extreme, ...]
    rate: float
    bound: float

    def ratio(self, nu: int) -> float:
        """Peak of the run over the law's; inf where a lower derivative of the run jumps, nan where the law has none."""
        whole = self.law.peak(nu)
        return self.run.peak(nu) / whole if whole > 0.0 and isfinite(whole) else nan

    def results(self) -> dict[str, Any]:
        """The report as plain data; what is infinite or unknown is null."""
        return {
            "NominalMasterVelocity": self.rate,
            "run": self.run.results(),
            "law": self.law.results(),
            "ratio": {name: finite_or_none(self.ratio(nu)) for nu, name in enumerate(_NAMES) if nu},
            "deviation": {name: _point(name, extreme) for name, extreme in zip(_NAMES, self.deviation, strict=False)},
            "rounding_bound_acceleration": self.bound,
        }


def as_run(run: PiecewiseMotion, motion: Motion, bound: float = 0.0, roundings: tuple[float, ...] = ()) -> Report:
    """The report of an execution by the master: every number is an extreme over the whole motion, not over a grid.

    Roundings may add `bound` to the acceleration; jumps of velocity, acceleration and jerk up to `roundings` are such.
    """
    rate = motion.units.rate or 1.0
    law = _characteristics(motion, motion, rate, (0.0,) * 4)
    height, step = run.peak(0).value, float(run.lengths.min())
    known = (0.0, *(roundings or (0.0,) * 3))
    floors = [max(ROUNDING[1] * height * (rate / step) ** nu, known[nu] * rate**nu) for nu in ORDERS]

    def meant(x: Array, nu: int) -> Array:
        # beyond its ends, which the master may pass by rounding, the motion continues
        return np.asarray(motion(np.clip(x, motion.start, motion.stop), nu))

    deviation = tuple(
        _sized(run.deviation(meant, nu, motion.breaks), rate**nu)
        if isfinite(law.peak(nu))
        else Extreme(inf, motion.start)
        for nu in ORDERS[:3]
    )
    return Report(_characteristics(run, motion, rate, floors), law, deviation, rate, bound * rate**2)


def _characteristics(
    side: Motion | PiecewiseMotion, motion: Motion, rate: float, floors: Sequence[float]
) -> Characteristics:
    """The characteristics of the law, which is the motion, or of its run; jumps up to floors are rounding."""
    pairs = [side.extrema(nu) if isinstance(side, Motion) else side.extremes(nu) for nu in ORDERS]
    extremes = [tuple(_sized(each, rate**nu) for each in pair) for nu, pair in enumerate(pairs)]
    start, end = (tuple(rate**nu * float(np.ravel(side.ends(nu)[i])[-i]) for nu in ORDERS) for i in (0, 1))
    small = [
        max(ROUNDING[0] * max(abs(low.value), abs(high.value)), least)
        for (low, high), least in zip(extremes, floors, strict=True)
    ]
    if isinstance(side, Motion):
        jumps, travel = tuple(_sized(side.jump(nu), rate**nu) for nu in ORDERS[1:]), travel_of_law(side)
    else:
        jumps, travel = tuple(_jump(side, nu, rate, small[nu]) for nu in ORDERS[1:]), travel_of_run(side)
    low, high = (tuple(pair[i] for pair in extremes) for i in (0, 1))
    changes = (abs(b - a) if motion.repeats else max(abs(a), abs(b)) for a, b in zip(start, end, strict=True))
    _, *at_ends = (change if change > least else 0.0 for change, least in zip(changes, small, strict=True))
    effective = inf if jumps[0].value else rate**2 * side.rms(2)
    return Characteristics(
        start, end, low, high, rate * travel / (side.stop - side.start), effective, jumps, tuple(at_ends)
    )


def _jump(run: PiecewiseMotion, nu: int, rate: float, small: float) -> Extreme:
    jumps = np.abs(run.jumps(nu)) * rate**nu
    if not jumps.size or jumps.max() <= small:
        return Extreme(0.0, run.start)
    return Extreme(float(jumps.max()), run.breaks[1 + int(jumps.argmax())])


def _sized(extreme: tuple[float, float], factor: float) -> Extreme:
    return Extreme(extreme[0] * factor, extreme[1])


def finite_or_none(value: float | None) -> float | None:
    """A number, which is null in plain data where it is infinite."""
    return value if value is not None and isfinite(value) else None


def _point(name: str, extreme: Extreme) -> dict[str, float | None]:
    return {"MasterPosition": extreme.x, f"Slave{name}": finite_or_none(extreme.value)}


def _end(values: tuple[float, ...]) -> dict[str, float | None]:
    return {f"Slave{name}": finite_or_none(value) for name, value in zip(_NAMES, values, strict=True)}


_CUTS = 9  # in eight: the way is of second order in the length that is left


def travel_of_run(run: PiecewiseMotion) -> float:
    """The total travel of a motion of polynomials, cut where the velocity may change its sign.

    Where all Bernstein coefficients of it have one sign it does not.
    """
    table, lengths, way = run.powers(1), run.lengths, 0.0
    control = bernstein.from_powers(table * lengths[:, None] ** np.arange(table.shape[1]))
    for cut in range(_CUTS + 1):
        turning = (control.min(axis=1) < 0.0) & (control.max(axis=1) > 0.0) & (cut < _CUTS)
        way += float(np.abs(control.mean(axis=1) * lengths)[~turning].sum())
        if not turning.any():
            break
        control = bernstein.in_parts(control[turning])
        lengths = np.repeat(lengths[turning] / bernstein.PARTS, bernstein.PARTS)
    return way


def travel_of_law(motion: Motion) -> float:
    """The total travel of a motion of laws, which turn where their direction changes."""
    turns = ([piece.start, *piece.turns, piece.stop] for piece in motion.pieces)
    ways = (np.diff(piece.values(np.array(x), 0)) for piece, x in zip(motion.pieces, turns, strict=True))
    return float(sum(np.abs(way).sum() for way in ways))


@dataclass(frozen=True)
class TaskSampling:
    """The sampled run: the time of a task in seconds, and the greatest second difference of positions over it."""

    seconds: float
    acceleration: float


def task_sampling(run: PiecewiseMotion, motion: Motion, task: Quantity) -> TaskSampling:
    """The run sampled once in a task, such as "1 ms": second differences of the positions, both ends included.

    Before and after a motion of one shot there is rest; a cycle goes on with itself.
    """
    seconds = quantity(task, "time", "task")
    if motion.units.rate is None:
        raise InputError("task: how fast the master goes is not known: say how long the motion takes, duration='0.1 s'")
    step = seconds * motion.units.rate
    if not _FEWEST_TASKS * step <= motion.length <= MOST_VALUES * step:
        longest, shortest = (motion.length / motion.units.rate / count for count in (_FEWEST_TASKS, MOST_VALUES))
        raise InputError(
            f"task must be between {shortest:.3g} s and {longest:.3g} s, so that the motion has {_FEWEST_TASKS} to "
            f"{MOST_VALUES} of them, got {shortened(task)}"
        )
    count = floor(motion.length / step * (1.0 + 1e-12))
    y = np.asarray(run(np.minimum(run.start + step * np.arange(count + 1), run.stop)))
    last = float(run.ends(0)[1][-1])
    if motion.repeats:
        again = motion.advance + run(np.clip(step * np.arange(count + 1, count + 3) - motion.length, 0.0, None))
        sampled = np.concatenate([y, again])
    else:
        sampled = np.concatenate([y[:1], y[:1], y, [last, last]])
    return TaskSampling(seconds, float(np.abs(np.diff(sampled, 2)).max()) / seconds**2)
