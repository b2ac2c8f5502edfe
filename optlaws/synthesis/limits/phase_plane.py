"""The phase plane of a move from rest to rest: torques over position and velocity, and what is minimised and bounded.

A law that never turns back is a velocity b over the position a. With w = b², the acceleration is c = w'/2, so that a
torque I(a) c + S(a) b² + R(a) b + T(a) is affine in w and w' but for R, and its peak, its mean square, energies and the
time are convex in w. What is minimised over the plane is what no law from rest to rest that never turns back can beat.
"""

from __future__ import annotations

from dataclasses import astuple, dataclass, replace
from math import inf, nextafter, sqrt
from typing import Any, Literal, TypeAlias

import numpy as np

from optlaws.echo import shortened
from optlaws.entries.declared import Declared, declared, entry
from optlaws.entries.value_types import Listed, Number, ReadBy, Together
from optlaws.errors import InputError
from optlaws.formulas.arithmetic import NUMPY, evaluate
from optlaws.formulas.reading import read
from optlaws.formulas.tree import Formula
from optlaws.kept import kept_property
from optlaws.numbers import Array, finite, positive
from optlaws.synthesis.limits.phase_torque import ACCELERATION, AnyTorque, GearTorque, PhaseTorque, torque_from
from optlaws.tolerances import VALUE_ROUNDING, WINDOW_EDGE

#: what is least: the mean over time of a torque's square and of powers, the peak of a torque, or the time itself
PhasePlaneKind: TypeAlias = Literal["mean", "peak", "time"]


@dataclass(frozen=True)
class TorqueLimit:
    """The bound |torque| <= at_rest - fall * b: a peak torque, or a straight part of a motor's curve.

    Where `side` is 1 only torque <= at_rest - fall * b is meant, and where it is -1 only -torque. It holds at the
    positions from `start` to `stop`.

    Examples
    --------
    >>> TorqueLimit(ACCELERATION, 9.0).fall
    0.0
    """

    torque: AnyTorque
    at_rest: float
    fall: float = 0.0
    side: Literal[-1, 0, 1] = 0
    start: float = 0.0
    stop: float = 1.0

    def __post_init__(self) -> None:
        _check_window(self.start, self.stop)

    @property
    def everywhere(self) -> bool:
        """Whether the limit holds in the whole stroke."""
        return (self.start, self.stop) == (0.0, 1.0)

    def to_data(self) -> list[Any]:
        """Its torque and numbers as plain data."""
        numbers = [self.at_rest, self.fall] if self.everywhere else [self.at_rest, self.fall, self.start, self.stop]
        return [self.torque.to_data(), *numbers]

    @classmethod
    def from_data(cls, data: Any) -> TorqueLimit:
        """The limit that `to_data` described."""
        if not isinstance(data, list | tuple) or len(data) not in {3, 5}:
            raise InputError(f"a limit is a torque, a value at rest, a fall, and a window, got {shortened(data)}")
        at_rest, fall, *window = (finite(value, "a limit") for value in data[1:])
        return cls(torque_from(data[0]), at_rest, fall, 0, *window)


@dataclass(frozen=True)
class VelocityLimit:
    """The bound b <= B at the positions from `start` to `stop`.

    Examples
    --------
    >>> VelocityLimit(0.2, 0.4, 1.1).B
    1.1
    """

    start: float
    stop: float
    B: float

    def __post_init__(self) -> None:
        _check_window(self.start, self.stop)
        positive(self.B, "B")


def _check_window(start: float, stop: float) -> None:
    if not 0.0 <= start < stop <= 1.0:
        raise InputError(f"a window has two positions that ascend from 0 to 1, got {start!r} and {stop!r}")


def _torque(value: Any) -> AnyTorque:
    return value if isinstance(value, PhaseTorque | GearTorque) else torque_from(value)


def _torque_limit(value: Any) -> TorqueLimit:
    return value if isinstance(value, TorqueLimit) else TorqueLimit.from_data(value)


def _velocity_limit(value: Any) -> VelocityLimit:
    if isinstance(value, VelocityLimit):
        return value
    numbers = Together(Number(), Number(), Number(), names=("start", "stop", "B"))
    return VelocityLimit(*numbers.read(value, "a limit of the velocity"))


def _formula(value: Any) -> Formula:
    return value if isinstance(value, Formula) else read(value, ("a",))


_TORQUE = ReadBy(_torque, "a torque, as the texts of I, S, R and T", lambda torque: torque.to_data())


@declared
class PhasePlane(Declared, title="a phase plane"):
    """An objective with bounds over all motions from rest to rest that never turn back.

    With nothing to minimise it is the time that is least.

    Examples
    --------
    >>> plane = PhasePlane(peak=ACCELERATION, B=1.8)
    >>> plane.kind, PhasePlane.from_dict(plane.to_dict()) == plane
    ('peak', True)
    """

    writes_defaults = True

    squared: AnyTorque | None = entry(_TORQUE, "A torque whose mean square is minimised.", default=None)
    maxima: tuple[tuple[AnyTorque, AnyTorque], ...] = entry(
        Listed(Together(_TORQUE, _TORQUE)),
        "Powers that are minimised in the mean: each is b times the greater of two torques.",
        default=(),
    )
    peak: AnyTorque | None = entry(_TORQUE, "A torque whose greatest magnitude is minimised; alone.", default=None)
    limits: tuple[TorqueLimit, ...] = entry(
        Listed(ReadBy(_torque_limit, "a torque, a value at rest, a fall, and a window", TorqueLimit.to_data)),
        "Bounds of torques.",
        default=(),
    )
    B: float = entry(Number(above=0.0, absent=inf), "The greatest velocity; infinite where it is free.", default=inf)
    C: float = entry(Number(above=0.0, absent=inf), "The greatest acceleration, likewise.", default=inf)
    heat: float = entry(Number(above=0.0), "The factor of the mean square.", default=1.0)
    velocities: tuple[VelocityLimit, ...] = entry(
        Listed(ReadBy(_velocity_limit, "two positions and a velocity", lambda limit: list(astuple(limit)))),
        "Bounds of the velocity over parts of the stroke.",
        default=(),
    )
    holding: Formula | None = entry(
        ReadBy(_formula, "a formula of a", str),
        "The torque that holds the load at rest; that of a slow motion unless given.",
        default=None,
    )

    def _check(self) -> None:
        if self.peak is not None and (self.squared is not None or self.maxima):
            raise InputError("a peak is minimised alone: leave out what else is minimised")
        if self.kind != "time" and self.B <= 1.0:
            raise InputError(f"B must be above 1, the mean velocity, got {self.B!r}")
        if len({torque.load for torque in self.torques if isinstance(torque, GearTorque)}) > 1:
            raise InputError("torques behind a gear with losses must be those of one load")
        for formula in (branch.inertia for torque in self.torques for branch in torque.branches):
            least = float(np.min(evaluate(formula, {"a": np.linspace(0.0, 1.0, 1025)}, NUMPY)))
            if least < 0.0:
                raise InputError(f"an inertia must be at least 0 at every position, got {least:.6g} of {formula}")

    @property
    def kind(self) -> PhasePlaneKind:
        """Whether a mean, a peak or the time is minimised."""
        if self.peak is not None:
            return "peak"
        return "mean" if self.squared is not None or self.maxima else "time"

    @property
    def torques(self) -> tuple[AnyTorque, ...]:
        first = [torque for torque in (self.squared, self.peak) if torque is not None]
        several = [torque for torques in self.maxima for torque in torques]
        return (*first, *several, *(limit.torque for limit in self.limits))

    @property
    def bounds(self) -> tuple[TorqueLimit, ...]:
        """The limits: limits over parts of the stroke first, the limit of the acceleration last."""
        limits = sorted(self.limits, key=lambda limit: limit.everywhere)
        return (*limits, *([TorqueLimit(ACCELERATION, self.C)] if inf > self.C else []))

    @property
    def within_jerk(self) -> bool:
        """Whether bounds rise with the velocity, as those of the acceleration do that a bound of the jerk implies."""
        return any(limit.fall < 0.0 for limit in self.limits)

    @property
    def greatest_velocity(self) -> float:
        """A velocity that no motion within the bounds exceeds: to reach it and stop takes less than the stroke."""
        return min(self.B, nextafter(sqrt(self.C), inf)) if inf > self.C else self.B

    @property
    def gear_load(self) -> PhaseTorque | None:
        """The load whose sign gives the direction of power through a gear with losses; None without such a gear."""
        geared = [torque for torque in self.torques if isinstance(torque, GearTorque)]
        return geared[0].load if geared else None

    @kept_property
    def branches(self) -> tuple[PhasePlane, ...]:
        """Planes with torques of a single form; at every position, every motion is in one of them.

        Behind a gear with losses that is one with a load of at least 0, and one with a load of at most 0.
        """
        load = self.gear_load
        return (self,) if load is None else (self._branch(0, load), self._branch(1, load))

    def _branch(self, i: int, load: PhaseTorque) -> PhasePlane:
        def of(torque: AnyTorque) -> PhaseTorque:
            return torque.branches[min(i, len(torque.branches) - 1)]

        limits = [replace(limit, torque=of(limit.torque)) for limit in self.limits]
        return replace(
            self,
            squared=None if self.squared is None else of(self.squared),
            maxima=tuple((of(first), of(second)) for first, second in self.maxima),
            peak=None if self.peak is None else of(self.peak),
            limits=(TorqueLimit(load, 0.0, side=1 if i else -1), *limits),
        )

    @kept_property
    def reference(self) -> PhaseTorque:
        """The torque whose price follows from the potential and all other prices: of what is bounded or squared.

        Raises
        ------
        InputError
            If nothing keeps the acceleration finite.
        """
        bounds = [bound.torque for bound in self.bounds if bound.side == 0 and bound.everywhere]
        several = bounds[-1] if bounds else self.peak or self.squared
        if several is None:
            raise InputError("nothing keeps the acceleration finite: bound C or a torque")
        torque = several.branches[0]
        a = np.linspace(0.0, 1.0, 1025)
        inertia = torque.values(a)[0]
        if (least := int(np.argmin(inertia))) >= 0 and inertia[least] <= VALUE_ROUNDING * float(inertia.max()):
            raise InputError(
                f"the inertia {torque.inertia} vanishes at a = {a[least]:.4g}, where nothing keeps the acceleration "
                "finite: bound C"
            )
        return torque

    @kept_property
    def kinks(self) -> tuple[float, ...]:
        """The positions strictly between 0 and 1 at which a torque is not smooth, ascending."""
        branches = [branch for torque in self.torques for branch in torque.branches]
        ends = {place for branch in branches for place in branch.kinks}
        # a little within windows, so that what is nearest to an end surely is
        ends |= {limit.start + WINDOW_EDGE for limit in self.windows if limit.start > 0.0}
        ends |= {limit.stop - WINDOW_EDGE for limit in self.windows if limit.stop < 1.0}
        return tuple(sorted(ends))

    @property
    def jumps(self) -> tuple[float, ...]:
        """The positions at which the potential may jump: where a bounded velocity begins and ends, ascending."""
        ends = {limit.start + WINDOW_EDGE for limit in self.velocities if limit.start > 0.0}
        return tuple(sorted(ends | {limit.stop - WINDOW_EDGE for limit in self.velocities if limit.stop < 1.0}))

    @property
    def windows(self) -> tuple[TorqueLimit | VelocityLimit, ...]:
        """The bounds that hold over parts of the stroke."""
        return (*self.velocities, *(limit for limit in self.limits if not limit.everywhere))

    def velocity_bound(self, low: Array, high: Array) -> Array:
        """The greatest velocity in parts of the stroke, each from one position to another."""
        most = np.full(low.shape, self.greatest_velocity)
        for limit in self.velocities:
            most = np.where((low >= limit.start) & (high <= limit.stop), np.minimum(most, limit.B), most)
        return most

    def slowed(self, time: float) -> PhasePlane:
        """The plane of the least time, measured in another unit."""
        limits = tuple(
            replace(limit, torque=limit.torque.slowed(time), fall=limit.fall / time) for limit in self.limits
        )
        velocities = tuple(replace(limit, B=limit.B * time) for limit in self.velocities)
        return PhasePlane(limits=limits, B=self.B * time, C=self.C * time**2, velocities=velocities)
