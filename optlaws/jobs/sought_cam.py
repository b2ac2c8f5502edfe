"""A cam of a problem file: its laws, its spring and its sizes where the file leaves them open, and its forces."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from math import inf
from typing import Any, Self

from optlaws.cams.best_laws import (
    BestCam,
    BestPrimeCircle,
    best_cam,
    best_prime_circle,
    bounds_are_of_all,
    bounds_hold,
    cam_of_laws,
    prime_circle_of_laws,
    with_tight_bounds,
)
from optlaws.cams.cam_values import SPRING_UNITS, Values, force_values, known_values, motion_values, spring_values
from optlaws.cams.conjugate import conjugate_cam
from optlaws.cams.curves.cam_files import CutFile
from optlaws.cams.disc import DiscCam
from optlaws.cams.followers.follower import positive
from optlaws.cams.followers.rollers import TranslatingRoller
from optlaws.cams.forces import CamForces, Surfaces
from optlaws.cams.least_sizes import BestOffset, LeastPrimeCircle, best_offset, least_prime_circle
from optlaws.cams.pair_forces import PairForces
from optlaws.cams.report import DIGITS
from optlaws.cams.springs_and_flywheels import Spring, least_spring
from optlaws.cycles.cycle import Cycle, Plan
from optlaws.cycles.optimisation.objectives import kind_of
from optlaws.cycles.placed import broken_limits
from optlaws.cycles.specification.programme import is_optimal
from optlaws.cycles.usual_law import usual_cycle
from optlaws.entries.declared import entries_of
from optlaws.errors import InfeasibleProblem, InputError, located
from optlaws.jobs.cam_entries import CamProblemFile
from optlaws.kept import kept_property
from optlaws.laws.catalogue.catalogue import USUAL
from optlaws.motion.quantities import MILLI, TURN, Exact, Kind, quantity
from optlaws.numbers import rounded_up
from optlaws.shown.steps import step
from optlaws.synthesis.solution import Solution

SIZE_MET = 1e-7  # of a radius: a size that is proven to so much is the least one
_SEARCHED = 15  # the degree up to which a search for the bound of a power mostly succeeds
_SPRINGS = 12  # how often laws and the spring that they need are sought in turn
_SPRING_DIGITS = 4
#: before the names of the files of the return cam
RETURN = "return-"
#: what a spring adds to a drive, with its dimensions
_SPRING = {"stiffness": ("stiffness", "torsional stiffness"), "preload": ("force", "torque")}
#: cams whose laws were optimised for them
OPTIMISED = (BestCam, BestPrimeCircle)


@dataclass(frozen=True)
class SoughtCam:
    """The disc cam of a problem file, with what is sought of it.

    The laws of its motion are sought unless they are `known`, such as those of a file, with the `bound` stated of them.
    """

    spec: CamProblemFile
    known: Plan | None = None
    bound: float | None = None
    bounding: tuple[Solution, ...] = ()  #: the solutions whose bounds are those of the laws, unless these are
    searched: bool = False  #: whether the search for the bound of a power is over, be it found or not
    circle: Any = None  #: the prime radius of the best laws, where the file gives none, if it is known

    @property
    def with_spring(self) -> Self:
        """The cam of the laws that have least force or power with the least spring that these laws need, where one is.

        That of the usual law comes first; then that of the laws that are best with the last one, until it is the same.
        Where two springs take turns, one that is as strong as both presses the follower.
        """
        spec = self.spec
        sought = any(map(is_optimal, spec.cycle.segments)) and kind_of(spec.cycle.minimise)[0].is_driven
        if not sought or not self._needs_spring:
            return self
        best, pressing, last = self, self if self.usual is None else self.usual, (-inf, -inf)
        circle = self._usual_radius if spec.best == "laws" and spec.radius is None else None
        for turns in range(_SPRINGS):
            spring = pressing.least_spring
            needed = rounded_up(spring.stiffness, _SPRING_DIGITS), rounded_up(spring.preload, _SPRING_DIGITS)
            sizes = needed if turns < _SPRINGS // 2 else (max(needed[0], last[0]), max(needed[1], last[1]))
            if sizes == last:
                break
            last, pressing = sizes, type(self)(self.pressed_by(*sizes), circle=circle)
            best = pressing
        return best

    def pressed_by(self, *sizes: float) -> CamProblemFile:
        """The file with a stiffness and a preload, rounded up, of a spring that was sought."""
        spec, units = self.spec, SPRING_UNITS[self.spec.cycle.axis][::-1]
        texts = (
            f"{rounded_up(size, _SPRING_DIGITS):.{DIGITS}g} {unit}" for size, unit in zip(sizes, units, strict=True)
        )
        drive = {**self._linear_drive, **dict(zip(_SPRING, texts, strict=True))}
        return replace(spec, motion=replace(spec.motion, drive=drive), spring_sought=True)

    @kept_property
    def counted(self) -> bool:
        """Whether the spring of the drive is the least one of these laws."""
        if not self.spec.spring_sought:
            return False
        spring, drive = self.least_spring, self._linear_drive
        return all(
            rounded_up(getattr(spring, name), _SPRING_DIGITS) >= 0.99 * quantity(drive[name], dimensions, name)
            for name, dimensions in _SPRING.items()
        )

    @property
    def with_proof(self) -> Self:
        """The cam with its laws of least power proven by a search over boxes, up to degrees of 15 or so.

        The search takes some ten seconds, a few minutes where it fails. Stopped by Ctrl-C, it leaves the cam as it is.
        """
        if not self.bound_is_open:
            return self
        step("proving that no law takes less power; Ctrl-C leaves the quick bound, if there is one")
        try:
            return replace(self, known=with_tight_bounds(self.plan), circle=self.cam.prime_radius, searched=True)
        except KeyboardInterrupt:
            step("the search for a proof was stopped: the bound is the quick one, if there is one", stays=True)
            return replace(self, searched=True)

    @property
    def bound_is_open(self) -> bool:
        """Whether a search that takes some time finds the bound of a power, and has not yet been made."""
        cycle, exact = self.spec.cycle, bounds_are_of_all(self.cam.contact, self.spec.limits)
        power = kind_of(cycle.minimise)[0] is Kind.POWER and cycle.degree <= _SEARCHED
        return power and exact and isinstance(self.sought, BestCam) and not self.searched

    @kept_property
    def sought(self) -> BestCam | BestPrimeCircle | BestOffset | LeastPrimeCircle | None:
        """What determines the cam where the file does not give all of it."""
        spec, follower, radius, limits = self.spec, self.spec.follower, self.spec.radius, self.spec.constraints
        if spec.best == "prime circle":
            if radius is not None:
                raise InputError("best = 'prime circle' computes prime_radius: leave it out, or give best = 'laws'")
            if self.known is not None:
                return prime_circle_of_laws(self.known, follower, **limits)
            return best_prime_circle(spec.cycle, follower, **limits)
        if radius is None and (spec.best == "offset" or not spec.limits.in_si):
            raise InputError(
                "prime_radius is missing: give it, such as '60 mm'; or give pressure_angle or radius_of_curvature, and "
                "the least one that keeps them is taken; or give best = 'prime circle'"
            )
        if spec.best == "laws":
            radius = self._usual_radius if radius is None else radius
            if self.known is None:
                return best_cam(spec.cycle, radius, follower, **limits)
            cam = DiscCam(self.known, radius, follower, turning=spec.turning)
            exact = self.bounding or bounds_are_of_all(cam.contact, spec.limits)
            return cam_of_laws(self.known, cam, self.bounding, None if exact else self.bound)
        if spec.best is None:
            return None if radius is not None else least_prime_circle(self.motion, follower, **limits)
        if not isinstance(follower, TranslatingRoller):
            raise InputError(f"best = 'offset' is of a translating roller, got a {follower.kind}")
        if "offset" in follower.to_dict():
            raise InputError("follower: best = 'offset' computes the offset: leave it out")
        return best_offset(self.motion, radius, follower, turning=spec.turning)

    @property
    def motion(self) -> Cycle | Plan:
        """The motion of the file, with the laws that are known."""
        return self.spec.cycle if self.known is None else self.known

    @property
    def minimises_over_cycle(self) -> bool:
        """Whether the laws that are best for the cam have the least of what the cycle minimises."""
        return isinstance(self.sought, BestCam)

    @property
    def bounds_hold(self) -> bool:
        """Whether the bounds of the laws are those of all laws of the cycle, where limits of the cam keep them."""
        if isinstance(self.sought, BestCam):
            return bounds_hold(self.plan, self.sought.bounding, self.cam, self.spec.limits)
        return self.plan.of_its_problems()

    @property
    def _usual_radius(self) -> Any:
        """The least prime circle of the usual law, on which the best laws are sought where the file gives none."""
        if self.circle is not None:
            return self.circle
        if self.usual is None:
            raise InputError(
                f"prime_radius is missing, and the motion cannot have {USUAL}, whose least one could be taken: give "
                "it, such as '60 mm'"
            )
        radius = positive(self.usual.cam.prime_radius, "prime_radius")
        return Exact(radius * (1.0 + SIZE_MET), "m")

    @kept_property
    def cam(self) -> DiscCam:
        """The cam, with what is sought."""
        spec, sought = self.spec, self.sought
        if sought is None:
            return DiscCam(self.motion, spec.radius, spec.follower, turning=spec.turning)
        return sought.least.cam if isinstance(sought, BestPrimeCircle) else sought.cam

    @kept_property
    def second(self) -> DiscCam | None:
        """The return cam of a pair."""
        cam, entries = self.cam, self.spec.pair
        if entries is None:
            return None
        with located("pair"):
            return conjugate_cam(cam, entries.follower, distance=entries.distance, angle=entries.angle)

    @property
    def files(self) -> dict[str, tuple[CutFile, DiscCam]]:
        """The files that cut the cams by their names, each with its cam."""
        cams = {"": self.cam} if self.second is None else {"": self.cam, RETURN: self.second}
        return {f"{way}{each.name}": (each, cam) for way, cam in cams.items() for each in self.spec.file}

    @kept_property
    def forces(self) -> CamForces | None:
        """The forces of the cam, if the file has them."""
        return None if self.spec.forces is None else self.forces_of(self.spec.forces)

    def forces_of(self, surfaces: Surfaces) -> CamForces:
        """The cam's forces at the speed of its cycle."""
        cycle, beside = self.motion, dict[str, Any]()
        if not isinstance(self.cam.motion, Cycle | Plan):  # a motion by angle has neither
            beside = {"speed": Exact(TURN / cycle.duration, "rad/s"), "drive": cycle.drive}
        if self._needs_spring:
            force, stiffness = SPRING_UNITS[self.cam.displacement.axis]
            spring = self.least_spring
            pressing = {"stiffness": Exact(spring.stiffness, stiffness), "preload": Exact(spring.preload, force)}
            beside["drive"] = {**self._linear_drive, **pressing}
        options = {name: getattr(surfaces, name) for name in entries_of(Surfaces)}
        options |= {"process": self.spec.process, **beside}
        if self.second is None:
            return CamForces(self.cam, **options)
        return PairForces(self.cam, **options, second=self.second)

    @kept_property
    def plan(self) -> Plan:
        """The motion with the cam's laws, which says what they take of the limits."""
        best = self.sought
        return self.spec.cycle.with_solutions(best.solutions) if isinstance(best, OPTIMISED) else self.motion.solve()

    @kept_property
    def usual(self) -> Self | None:
        """The cam of the same file with the usual law in its moves; None where it has no other laws.

        Where the spring of the drive was sought with the laws, the usual law has its own least one.
        """
        spec, cycle = self.spec, usual_cycle(self.spec.cycle)
        if cycle is None:
            return None
        motion = replace(spec.motion, segment=tuple(cycle.segments), limits={})
        usual = replace(spec, motion=motion, best="offset" if spec.best == "offset" else None)
        if not spec.spring_sought:
            return type(self)(usual)
        drive = {name: value for name, value in self._linear_drive.items() if name not in _SPRING}
        bare = type(self)(replace(usual, motion=replace(motion, drive=drive), spring_sought=False))
        return type(self)(bare.pressed_by(bare.least_spring.stiffness, bare.least_spring.preload))

    @kept_property
    def values(self) -> Values:
        """What a designer weighs in the cam, by its names."""
        parts: list[Callable[[], Values]] = [lambda: motion_values(self.cam, TURN / self.spec.cycle.duration)]
        if self.spec.limits.in_si:
            parts.append(lambda: _least_value(self.least))
        if self.spec.forces is not None:
            surfaces = self.spec.forces
            parts.append(lambda: force_values(self.forces_of(surfaces)))
        if self.spec.spring is not None:
            parts.append(lambda: spring_values(self.least_spring, self.cam.displacement.axis))
        return known_values(*parts)

    def _broken_by_usual(self) -> list[str]:
        """What the cam with the usual law takes beyond the limits of the cycle and of the cam."""
        if self.usual is None:
            return []
        of_cam = self.spec.limits.broken(self.usual.cam.extremes)
        return [*broken_limits(self.usual.plan, self.plan.specification), *of_cam.values()]

    def _least_prime_circle(self, motion: Any) -> LeastPrimeCircle | str:
        """The least prime circle of a motion under the limits, or why there is none."""
        try:
            return least_prime_circle(motion, self.cam.follower, **self.spec.constraints)
        except InfeasibleProblem as error:
            reason: str = error.args[0]
            return reason

    @kept_property
    def least(self) -> LeastPrimeCircle | str | None:
        """The least prime circle, the reason why none exists, or None where no limit is given."""
        if not self.spec.limits.in_si:
            return None
        known = self.sought.least if isinstance(self.sought, BestPrimeCircle) else self.sought
        return known if isinstance(known, LeastPrimeCircle) else self._least_prime_circle(self.cam.motion)

    @property
    def _needs_spring(self) -> bool:
        """Whether the drive has no spring of its own, so that the least one presses the follower on the cam."""
        return self.spec.spring is not None and not self._linear_drive.keys() & _SPRING.keys()

    @property
    def _has_least_spring(self) -> bool:
        """Whether the least spring of these laws is the one that presses the follower on the cam."""
        return self._needs_spring or self.counted

    @property
    def _linear_drive(self) -> dict[str, Any]:
        """The constants of the drive; none where it has none."""
        drive = self.spec.cycle.drive
        return dict(drive) if isinstance(drive, Mapping) else {}

    @kept_property
    def least_spring(self) -> Spring:
        """The least spring; mass, gravity and friction are taken from the motion's drive."""
        entries = self.spec.spring
        if entries is None:
            raise InputError("spring: no spring is looked for: give its speeds")
        load = {key: value for key, value in self._linear_drive.items() if key not in _SPRING}
        return least_spring(self.cam, drive=load, process=self.spec.process, **entries.to_dict())


def _least_value(least: LeastPrimeCircle | str | None) -> Values:
    """The least prime circle among the values of a cam that has a greater one."""
    return {"least prime circle": (MILLI * least.radius, "mm")} if isinstance(least, LeastPrimeCircle) else {}
