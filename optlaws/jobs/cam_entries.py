"""The problem file of the job "cam": a disc cam or a barrel cam under its motion, with what is sought of it."""

from __future__ import annotations

from dataclasses import KW_ONLY, replace
from math import inf, tan
from typing import Any

from optlaws.cams.as_manufactured import PeaksAsMade
from optlaws.cams.barrel import Groove
from optlaws.cams.conjugate import ReturnFollower
from optlaws.cams.curves.cam_files import CutFile
from optlaws.cams.disc import TURNINGS, Turning
from optlaws.cams.followers.follower import CamFollower, stated_prime_radius
from optlaws.cams.forces import Surfaces
from optlaws.cams.least_sizes import (
    CamLimits,
)
from optlaws.cams.springs_and_flywheels import (
    SoughtSpring,
)
from optlaws.cycles.cycle import Cycle
from optlaws.cycles.optimisation.objectives import SUMS, kind_of
from optlaws.cycles.specification.drive import ProcessEntries
from optlaws.cycles.specification.load import is_process
from optlaws.cycles.specification.programme import is_optimal
from optlaws.cycles.specification.segments import CycleSegment, Move
from optlaws.entries.declared import ValueOf, declared, entry, same
from optlaws.entries.value_types import Choice, Listed, Measured, Number, Switch, Whole
from optlaws.errors import InputError, located
from optlaws.jobs.cycle_entries import AxisEntries, cycle_of
from optlaws.jobs.job_entries import ProblemFile
from optlaws.kept import kept_property
from optlaws.motion.quantities import TURN, Exact, quantity
from optlaws.numbers import NumberOrQuantity, Quantity

_LENGTH = Measured("length", above=0.0)
#: limits of the drive of a motion
_OF_DRIVE = {"force", "torque", "power", "rms force", "rms torque", "energy"}


@declared
class CamForcesEntries(Surfaces, title="forces"):
    """Forces of the cam under the drive of its motion."""

    irregularity: float | None = entry(
        Number(above=0.0),
        "Of the shaft's speed, for mean power, the work above the mean and the flywheel.",
        default=None,
        example=0.04,
    )


@declared
class CamOfMotion(ProblemFile, title="a cam"):
    """What the problem files of disc cams and of barrel cams have."""

    _: KW_ONLY
    motion: AxisEntries = entry(ValueOf(AxisEntries), 'One axis with its segments, as in the job "cycle".')
    speed: NumberOrQuantity | None = same(Cycle, "speed")
    period: NumberOrQuantity | None = same(Cycle, "period")
    turning: Turning = entry(Choice(*TURNINGS), "How the cam turns.", default="counterclockwise")
    cutter_radius: str | None = entry(
        _LENGTH,
        "Radius of the cutter or grinding wheel, whose path is then part of the table.",
        default=None,
        label="cutter",
        example="10 mm",
    )
    rows: int = entry(Whole(2, 100_000), "Lines of the table.", default=361)

    @kept_property
    def cycle(self) -> Cycle:
        """The motion of the follower."""
        return cycle_of(self.motion, self.speed, self.period)

    def _check(self) -> None:
        super()._check()
        if self.motion.mechanism is not None:
            raise InputError(
                "motion: a cam's follower has no mechanism: an axis of a cycle has one, and the kind 'cam' of it is "
                "what this cam's shaft feels"
            )


@declared
class CamProblemFile(CamOfMotion, title="a cam"):
    """The problem file of a disc cam."""

    _: KW_ONLY
    follower: CamFollower = entry(ValueOf(CamFollower), "What the cam moves.")
    prime_radius: str | None = entry(
        _LENGTH,
        "Radius of the prime circle, from the cam's centre to the roller's, or to the face, where the follower is "
        "lowest; unless given the least within pressure_angle and radius_of_curvature, or the result of best.",
        default=None,
        label="prime circle",
        example="60 mm",
    )
    #: the name that earlier files have for `prime_radius`
    base_radius: Quantity | None = entry(_LENGTH, "That of earlier files.", default=None, shown=False)
    pressure_angle: NumberOrQuantity | None = same(CamLimits, "pressure_angle")
    radius_of_curvature: NumberOrQuantity | None = same(CamLimits, "radius_of_curvature")
    best: str | None = entry(
        Choice("laws", "prime circle", "offset"),
        "What is optimised: the laws of the motion under the limits of the cam, at the given prime circle or at the "
        "least one of modified sine; the laws with the least prime circle; or the offset of a slide with a roller "
        "whose greatest pressure angle is least.",
        default=None,
    )
    pair: ReturnFollower | None = entry(ValueOf(ReturnFollower), "A return cam.", default=None)
    process: Any = entry(
        ValueOf(ProcessEntries),
        "A process force on the follower. It counts in forces and spring, and in objectives and limits of the drive.",
        default=None,
    )
    forces: CamForcesEntries | None = entry(
        ValueOf(CamForcesEntries), "Contact forces under the drive of the motion.", default=None
    )
    spring: SoughtSpring | None = entry(
        ValueOf(SoughtSpring), "The least spring that keeps the follower on the cam.", default=None
    )
    #: in results of laws that were sought with their least spring, each laws having their own
    spring_sought: bool = entry(
        Switch(), "Whether the spring of the drive was sought with the laws.", default=False, shown=False
    )
    as_made: PeaksAsMade | None = entry(
        ValueOf(PeaksAsMade),
        "The peaks of the motion on a cam that is cut by tables of few points and digits.",
        default=None,
    )
    file: tuple[CutFile, ...] = entry(Listed(ValueOf(CutFile), most=50), "Files that cut the cam.", default=())
    animation: bool = entry(Switch(), "Whether animation.svg is written, in which the cam turns.", default=False)

    @classmethod
    def _from_earlier(cls, data: dict[str, Any]) -> dict[str, Any]:
        """The best "base circle" of earlier files is the prime circle."""
        return data | {"best": "prime circle"} if data.get("best") == "base circle" else data

    @kept_property
    def cycle(self) -> Cycle:
        """The motion of the follower, with the process force as its load where the motion speaks of its drive."""
        cycle = cycle_of(self.motion, self.speed, self.period)
        if self.process is None or not _speaks_of_drive(self.motion):
            return cycle
        with located("process"):
            loaded = replace(cycle, load=self.process.to_dict())
            _ = loaded.in_si  # which reads its table
        return loaded

    @kept_property
    def limits(self) -> CamLimits:
        """The limits of the cam."""
        return CamLimits(self.pressure_angle, self.radius_of_curvature)

    @property
    def constraints(self) -> dict[str, Any]:
        """The limits, and how the cam turns, as those take them who look for a cam."""
        return {**self.limits.to_dict(), "turning": self.turning}

    @property
    def radius(self) -> Any:
        """The radius of the prime circle, if it is given."""
        return stated_prime_radius(self.prime_radius, self.base_radius, self.follower)

    def _check(self) -> None:
        super()._check()
        _ = self.limits  # which checks them together
        load = None if self.process is None else self.motion.load
        if load is not None and (is_process(load) or _speaks_of_drive(self.motion)):
            raise InputError(
                "motion: load: beside [process] the motion takes no load: leave one of them out, and give the force "
                "of a process as [process]"
            )
        if self.best in {"laws", "prime circle"} and not any(map(is_optimal, self.cycle.segments)):
            raise InputError(
                f"best = {self.best!r} looks for laws, and each motion has a given one: leave best out, or the law of "
                "a segment"
            )


def _speaks_of_drive(motion: AxisEntries) -> bool:
    """Whether what a motion minimises or limits is of its drive."""
    least = kind_of(motion.minimise)[0]
    limited = [*(motion.limits or {}), *(name for each in motion.segment for name in getattr(each, "limits", {}))]
    return least.is_driven or least in SUMS or bool(_OF_DRIVE.intersection(limited))


@declared
class BarrelProblemFile(CamOfMotion, title="a barrel cam"):
    """The problem file of a barrel cam."""

    _: KW_ONLY
    barrel: Groove = entry(ValueOf(Groove), "The cylinder, its groove and the roller.")
    pressure_angle: NumberOrQuantity | None = same(CamLimits, "pressure_angle")

    @kept_property
    def limits(self) -> CamLimits:
        """The limits of the cam."""
        return CamLimits(self.pressure_angle)

    @kept_property
    def allowed_velocity(self) -> float:
        """The velocity in m/s at which the pressure angle at the bottom of the groove is the greatest allowed."""
        slope = inf if self.limits.pressure is None else tan(self.limits.pressure)
        return slope * self.barrel.radii[1] * TURN / cycle_of(self.motion, self.speed, self.period).duration

    @kept_property
    def cycle(self) -> Cycle:
        """The motion of the roller; laws that are sought keep the pressure angle by their velocity."""
        axis, most = self.motion, self.allowed_velocity
        if most == inf:
            return cycle_of(axis, self.speed, self.period)

        def limited(segment: CycleSegment) -> CycleSegment:
            if not isinstance(segment, Move) or not is_optimal(segment):
                return segment
            given = segment.limits.get("velocity", (axis.limits or {}).get("velocity"))
            if given is not None and quantity(given, "velocity", "velocity") <= most:
                return segment
            return replace(segment, limits={**segment.limits, "velocity": Exact(most, "m/s")})

        return cycle_of(replace(axis, segment=tuple(map(limited, axis.segment))), self.speed, self.period)

    def _check(self) -> None:
        super()._check()
        _ = self.limits  # which checks it
