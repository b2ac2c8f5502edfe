"""Results of the job "cam" beside the cams: extremes, least sizes, forces, a spring, peaks as manufactured."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

from optlaws.cams.as_manufactured import AsMade
from optlaws.cams.best_laws import BestCam, BestPrimeCircle, best_cam, best_prime_circle
from optlaws.cams.best_offset import BestOffset, best_offset
from optlaws.cams.conjugate import conjugate_cam
from optlaws.cams.disc import DiscCam
from optlaws.cams.followers.follower import stated_prime_radius
from optlaws.cams.followers.translating_roller import TranslatingRoller
from optlaws.cams.forces import CamForces, Surfaces
from optlaws.cams.least_sizes import GreatestRoller, LeastPrimeCircle, greatest_roller, least_prime_circle
from optlaws.cams.report import Limits
from optlaws.cams.sizing.energy_fluctuation import EnergyFluctuation, energy_fluctuation
from optlaws.cams.sizing.springs import Spring, least_spring
from optlaws.cycles.cycle import Cycle
from optlaws.entries.declared import entries_of
from optlaws.errors import InfeasibleProblem, InputError, located
from optlaws.jobs.cam_entries import CamProblemFile
from optlaws.kept import kept_property
from optlaws.motion.quantities import TURN

#: units of forces and of stiffness by what the follower's way is
FORCE = {"length": "N", "angle": "N m"}
STIFFNESS = {"length": "N/m", "angle": "N m/rad"}


@dataclass(frozen=True)
class Findings:
    """The cams of a problem file and the results beside them, each computed once."""

    spec: CamProblemFile

    @classmethod
    def read(cls, data: Mapping[str, Any], file: Path) -> Self:
        """Results that the entries of a file require, checked; an error names the file."""
        findings = cls(CamProblemFile.read(data, file))
        with located(str(file)):
            findings.second, findings.forces, findings.fluctuation  # noqa: B018 - what is wrong is refused at once
            if findings.spec.cutter_radius is not None:
                findings.cam.cutter_path(findings.spec.cutter_radius)
            for entry in findings.spec.file:
                findings.cam.outline(entry.curve, entry.cutter_radius)
        return findings

    @property
    def cycle(self) -> Cycle:
        """The motion as the file gives it."""
        return self.spec.cycle

    @kept_property
    def sought(self) -> BestCam | BestPrimeCircle | BestOffset | LeastPrimeCircle | None:
        """What determines the cam where the file does not give all of it."""
        spec, follower, cycle = self.spec, self.spec.follower, self.cycle
        radius = stated_prime_radius(spec.prime_radius, spec.base_radius, follower)
        if spec.best == "prime circle":
            if radius is not None:
                raise InputError("best = 'prime circle' computes prime_radius: leave it out, or give best = 'laws'")
            return best_prime_circle(cycle, follower, **spec.limits)
        if radius is None and (spec.best is not None or not spec.limited):
            raise InputError(
                "prime_radius is missing: give it, such as '60 mm'; or give pressure_angle or radius_of_curvature, and "
                "the least one that keeps them is taken; or give best = 'prime circle'"
            )
        if spec.best == "laws":
            return best_cam(cycle, radius, follower, **spec.limits)
        if spec.best is None:
            return None if radius is not None else least_prime_circle(cycle, follower, **spec.limits)
        if not isinstance(follower, TranslatingRoller):
            raise InputError(f"best = 'offset' is of a translating roller, got a {follower.kind}")
        if "offset" in follower.to_dict():
            raise InputError("follower: best = 'offset' computes the offset: leave it out")
        return best_offset(cycle, radius, follower, turning=spec.turning)

    @property
    def best(self) -> BestCam | BestPrimeCircle | None:
        """The quality of the laws for the cam, and the proof; None where they are the cycle's own."""
        return self.sought if isinstance(self.sought, BestCam | BestPrimeCircle) else None

    @property
    def offset(self) -> BestOffset | None:
        """The best offset of the slide; None where the cam has the offset of the file."""
        return self.sought if isinstance(self.sought, BestOffset) else None

    @kept_property
    def cam(self) -> DiscCam:
        """The cam, with what is sought."""
        spec, sought = self.spec, self.sought
        if sought is None:
            radius = stated_prime_radius(spec.prime_radius, spec.base_radius, spec.follower)
            return DiscCam(self.cycle, radius, spec.follower, turning=spec.turning)
        return sought.least.cam if isinstance(sought, BestPrimeCircle) else sought.cam

    @kept_property
    def second(self) -> DiscCam | None:
        """The return cam of a pair."""
        cam, entries = self.cam, self.spec.pair
        if entries is None:
            return None
        with located("pair"):
            return conjugate_cam(cam, entries.follower, distance=entries.distance, angle=entries.angle)

    @kept_property
    def limits(self) -> Limits:
        """The limits that the laws were optimised for; none where the laws are the cycle's own."""
        return Limits() if self.best is None else Limits(self.spec.steepest, self.spec.least_radius)

    def angle(self, angle: float) -> float | None:
        """The angle at which a limit determines a size; None for laws that reach the limit at several angles."""
        return angle if self.best is None else None

    @kept_property
    def least(self) -> LeastPrimeCircle | str | None:
        """The least prime circle, the reason why none exists, or None where no limit is given."""
        if not self.spec.limited:
            return None
        if isinstance(self.sought, BestPrimeCircle | LeastPrimeCircle):
            return self.sought.least if isinstance(self.sought, BestPrimeCircle) else self.sought
        try:
            return least_prime_circle(self.cam.motion, self.cam.follower, **self.spec.limits)
        except InfeasibleProblem as error:
            reason: str = error.args[0]
            return reason

    @kept_property
    def least_of_cycle(self) -> LeastPrimeCircle | None:
        """The least prime circle of the cycle's own laws; None if none exists."""
        try:
            return least_prime_circle(self.cycle, self.cam.follower, **self.spec.limits)
        except InfeasibleProblem:
            return None

    @kept_property
    def roller(self) -> GreatestRoller | None:
        """The greatest roller; None under a flat face."""
        if not self.cam.contact.roller:
            return None
        return greatest_roller(self.cam, radius_of_curvature=self.spec.radius_of_curvature or "0 mm")

    @kept_property
    def forces(self) -> CamForces | None:
        """The forces of the cam, if the file requests them."""
        return None if self.spec.forces is None else self.forces_with(self.spec.forces)

    @property
    def _process(self) -> dict[str, Any] | None:
        return None if self.spec.process is None else self.spec.process.to_dict()

    def forces_with(self, surfaces: Surfaces) -> CamForces:
        """The cam's forces at the speed of its cycle."""
        # laws that were found for a cam are no cycle, but go as fast
        beside: dict[str, Any] = {}
        if self.cam.motion is not self.cycle:
            beside = {"speed": f"{TURN / self.cycle.duration!r} rad/s", "drive": self.cycle.drive}
        options = {name: getattr(surfaces, name) for name in entries_of(Surfaces)}
        return CamForces(self.cam, process=self._process, **options, **beside)

    @kept_property
    def fluctuation(self) -> EnergyFluctuation | None:
        """Mean power and work above the mean, if the file requests an irregularity, which is checked."""
        if self.forces is None or self.spec.forces is None or self.spec.forces.irregularity is None:
            return None
        fluctuation = energy_fluctuation(self.forces)
        fluctuation.flywheel(self.spec.forces.irregularity)
        return fluctuation

    @kept_property
    def spring(self) -> Spring | None:
        """The least spring; mass, gravity and friction are taken from the motion's drive."""
        if self.spec.spring is None:
            return None
        given = self.cycle.drive if isinstance(self.cycle.drive, Mapping) else {}
        load = {key: value for key, value in given.items() if key not in {"stiffness", "preload"}}
        return least_spring(self.cam, drive=load, process=self._process, **self.spec.spring.to_dict())

    @kept_property
    def as_made(self) -> dict[str, AsMade | None]:
        """Peaks of the cam as manufactured; None where its follower does not reach all of it."""
        return {} if self.spec.as_made is None else self.spec.as_made.peaks(self.cam)

    def to_data(self) -> dict[str, Any]:
        """Sizes, forces, the spring and peaks as manufactured as data for programs, in SI units."""
        data: dict[str, Any] = {}
        if self.forces is not None:
            data["forces"] = self.forces.results()
        if self.fluctuation is not None and self.spec.forces is not None:
            inertia = self.fluctuation.flywheel(self.spec.forces.irregularity or 0.0)
            data["energy"] = {**self.fluctuation.to_dict(), "flywheel": inertia}
        if self.offset is not None:
            known = ("offset", "pressure_angle", "lower_bound", "proven")
            best = {name: getattr(self.offset, name) for name in known}
            data["best_offset"] = {**best, "angles": list(self.offset.angles)}
        if self.spring is not None:
            data["spring"] = self.spring.to_dict()
        if self.as_made:
            data["as_made"] = {name: None if peaks is None else peaks.to_dict() for name, peaks in self.as_made.items()}
        return data
