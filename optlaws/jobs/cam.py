"""The job "cam": a cam with enclosed pressure angles and curvatures, proof of no undercut, least sizes, its curves."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from math import ceil, degrees, floor, inf, log10
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from optlaws.cams.barrel import BarrelCam
from optlaws.cams.best_laws import (
    BestCam,
    BestPrimeCircle,
    best_cam,
    best_prime_circle,
    bounds_are_of_all,
    bounds_hold,
    cam_of_laws,
    prime_circle_of_laws,
)
from optlaws.cams.cam_values import (
    SPRING_UNITS,
    Values,
    cam_differences,
    force_values,
    known_values,
    motion_values,
    objective_name,
    objective_value,
    spring_values,
)
from optlaws.cams.conjugate import conjugate_cam
from optlaws.cams.curves.cam_files import CutFile
from optlaws.cams.curves.extremes import UNDERCUT
from optlaws.cams.disc import DiscCam
from optlaws.cams.followers.follower import positive
from optlaws.cams.followers.rollers import TranslatingRoller
from optlaws.cams.forces import CamForces, Surfaces
from optlaws.cams.least_sizes import (
    BestOffset,
    LeastPrimeCircle,
    best_offset,
    greatest_roller,
    least_prime_circle,
)
from optlaws.cams.report import (
    DIGITS,
    CamReport,
    barrel_coordinates,
    barrel_differences,
    barrel_section,
    forces_section,
    leaves_at,
)
from optlaws.cams.springs_and_flywheels import (
    CONTACT,
    GREATEST,
    EnergyFluctuation,
    Spring,
    energy_fluctuation,
    least_spring,
)
from optlaws.cycles.cycle import Cycle, Plan
from optlaws.cycles.optimisation.objectives import kind_of
from optlaws.cycles.placed import broken_limits, limits_reached
from optlaws.cycles.report import objective_unit
from optlaws.cycles.specification.limits import LimitTaken
from optlaws.cycles.specification.programme import is_optimal
from optlaws.cycles.specification.segments import OPTIMAL
from optlaws.cycles.usual_law import usual_cycle
from optlaws.echo import shortened
from optlaws.entries.declared import entries_of
from optlaws.errors import InfeasibleProblem, InputError, OptlawsError, located
from optlaws.jobs.cam_entries import BarrelProblemFile, CamOfMotion, CamProblemFile
from optlaws.kept import kept_property
from optlaws.laws.catalogue.catalogue import USUAL
from optlaws.motion.quantities import MICRO, MILLI, TURN, TURN_DEG, Exact
from optlaws.numbers import chop
from optlaws.plots.cam import animated, barrel_figure, cam_figure, forces_figure, pair_figure
from optlaws.results import Results
from optlaws.sentences import Amount, capital, quantity_name, sentence
from optlaws.shown.report import ReportTable, Section
from optlaws.shown.summary import Row
from optlaws.studies.problem_entries import steady
from optlaws.synthesis.solution import Solution
from optlaws.tolerances import FORCE_ROUNDING

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_SIZE_MET = 1e-7  # of a radius: a size that is proven to so much is the least one
_SPRINGS = 12  # how often laws and the spring that they need are sought in turn, each to four digits
_STIFFER = 0.5  # per cent: what a spring is stiffer than with the usual law, from which on that is said
#: before the names of the files of the return cam
_RETURN = "return-"
#: what a spring adds to a drive
_SPRING = {"stiffness", "preload"}
#: cams whose laws were optimised for them
OPTIMISED = (BestCam, BestPrimeCircle)


def run(results: Results) -> None:
    """Put the cam's page, data, table, pictures and files into results."""
    result = read(results.entries, results.file)
    title = results.title = result.spec.title
    page = (
        results.page("cam")
        .text(result.warning)
        .text(result.spec.text)
        .picture("cam", title, partial(result.drawn, title))
    )
    for section in result.sections:
        page.section(section)
    results.data("cam.json", result.data)
    results.table("cam", *result.table)
    if isinstance(result, CamResult):
        if result.spec.animation:
            results.text("animation.svg", animated(result.cam))
        for name, (each, cam) in result.files.items():
            write = replace(each, about=results.about).write
            results.add(name, partial(write, cam.outline(each.curve, each.cutter_radius)))


def _entries(data: Mapping[str, Any], file: Path) -> CamProblemFile | BarrelProblemFile:
    return (BarrelProblemFile if "barrel" in data else CamProblemFile).read(data, file)


def motion_of(data: Mapping[str, Any], file: Path) -> dict[str, Cycle]:
    """The motion of a file's follower by its name; an error names the file."""
    spec = _entries(data, file)
    with located(str(file)):
        return {spec.motion.name: spec.cycle}


def read(data: Mapping[str, Any], file: Path) -> CamResult | BarrelResult:
    """The result of a file's entries; an error names the file."""
    spec = _entries(data, file)
    with located(str(file)):
        if isinstance(spec, CamProblemFile):
            for each in spec.file:
                each.check_writer()
            return CamResult.of_file(spec)
        return BarrelResult.of_file(spec)


def stored(data: Mapping[str, Any]) -> CamResult | BarrelResult:
    """The result that `cam.json` holds, computed again from its entries and the solutions of its laws.

    No laws are sought. A lower bound under limits that are not linear in the laws is that of the data.
    """
    entries = data["cam"]
    spec = (BarrelProblemFile if "barrel" in entries else CamProblemFile).from_dict(entries)
    plan = spec.cycle.with_solutions([Solution.from_dict(each) for each in data["solutions"]])
    if isinstance(spec, BarrelProblemFile):
        return BarrelResult.of_file(spec, plan)
    return CamResult(spec, plan, (data.get("best") or {}).get("lower_bound"))


class BarrelResult(NamedTuple):
    """The barrel cam of a problem file, with what `CamResult` has."""

    spec: BarrelProblemFile
    plan: Plan
    sections: tuple[Section, ...]
    data: dict[str, Any]
    table: ReportTable
    drawn: Callable[[str], Figure]
    warning: str = ""  #: a groove leads its roller both ways

    @classmethod
    def of_file(cls, spec: BarrelProblemFile, known: Plan | None = None) -> BarrelResult:
        """The cam of a problem file, or of laws of its motion that are known."""
        plan = known or _within(spec)
        cam = BarrelCam(plan, **spec.barrel.to_dict(), turning=spec.turning)
        sections, table = (
            (barrel_section(cam, spec.limits), _laws_section(plan, allowed=_allowed(spec)), barrel_differences(cam)),
            barrel_coordinates(cam, spec.rows, spec.cutter_radius),
        )
        data = _proven(spec, plan) | {name: value for each in sections for name, value in each.data.items()}
        return cls(spec, plan, sections, data, table, partial(barrel_figure, cam))


def _within(spec: BarrelProblemFile) -> Plan:
    """The laws of a barrel cam within its pressure angle; an error without any says what would help."""
    try:
        return spec.cycle.solve()
    except InfeasibleProblem as error:
        if spec.pressure_angle is None:
            raise
        remedy = "make the cylinder larger, the groove shallower or the motion slower, or allow more"
        raise InfeasibleProblem(sentence("{} ({}: {})", error.args[0], _allowed(spec), remedy)) from error


def _allowed(spec: BarrelProblemFile) -> str:
    """The velocity that the pressure angle of a barrel cam allows; blank without a limit of it."""
    if spec.pressure_angle is None:
        return ""
    allowed = Amount(MILLI * spec.allowed_velocity, "mm/s", DIGITS)
    return sentence("the pressure_angle of {} at the bottom of the groove allows {}", spec.pressure_angle, allowed)


@dataclass(frozen=True)
class CamResult:
    """The disc cam of a problem file with what is sought of it; a section is empty of what the file does not ask.

    The laws of its motion are sought unless they are `known`, such as those of a file, with the `bound` stated of them.
    """

    spec: CamProblemFile
    known: Plan | None = None
    bound: float | None = None
    counted: bool = False  #: whether the spring of the drive is the least one of these laws
    circle: Any = None  #: the prime radius of the best laws, where the file gives none, if it is known

    @classmethod
    def of_file(cls, spec: CamProblemFile) -> CamResult:
        """The cam of a problem file, with its return cam, its forces and its cutters checked."""
        result = cls(spec).with_spring
        result.second, result.loads  # noqa: B018 - they are computed
        if spec.cutter_radius is not None:
            result.cam.cutter_path(spec.cutter_radius)
        for each in spec.file:
            result.cam.outline(each.curve, each.cutter_radius)
        return result

    @property
    def with_spring(self) -> CamResult:
        """The cam of the laws that have least force or power with the least spring that these laws need, where one is.

        That of the usual law comes first; then that of the laws that are best with the last one, until it is the same.
        Where two springs take turns, one that is as strong as both presses the follower.
        """
        spec, units = self.spec, SPRING_UNITS[self.spec.cycle.axis][::-1]
        sought = any(map(is_optimal, spec.cycle.segments)) and kind_of(spec.cycle.minimise)[0].is_driven
        if not sought or not self._needs_spring:
            return self
        best, pressing, last = self, self if self.usual is None else self.usual, (-inf, -inf)
        circle = self._usual_radius if spec.best == "laws" and spec.radius is None else None
        for turns in range(_SPRINGS):
            spring = pressing.least_spring
            needed = _rounded_up(spring.stiffness), _rounded_up(spring.preload)
            sizes = needed if turns < _SPRINGS // 2 else (max(needed[0], last[0]), max(needed[1], last[1]))
            if sizes == last:
                break
            last, texts = sizes, (f"{size:.{DIGITS}g} {unit}" for size, unit in zip(sizes, units, strict=True))
            drive = {**self._linear_drive, **dict(zip(("stiffness", "preload"), texts, strict=True))}
            best = pressing = CamResult(replace(spec, motion=replace(spec.motion, drive=drive)), circle=circle)
        return replace(best, counted=all(each >= 0.99 * size for each, size in zip(needed, last, strict=True)))

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
            return cam_of_laws(self.known, cam, None if bounds_are_of_all(cam.contact, spec.limits) else self.bound)
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
        if self.minimises_over_cycle:
            return bounds_hold(self.plan, self.cam, self.spec.limits)
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
        return Exact(radius * (1.0 + _SIZE_MET), "m")

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
        cams = {"": self.cam} if self.second is None else {"": self.cam, _RETURN: self.second}
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
        return CamForces(self.cam, process=self.spec.process, **options, **beside)

    @kept_property
    def plan(self) -> Plan:
        """The motion with the cam's laws, which says what they take of the limits."""
        best = self.sought
        return self.spec.cycle.with_solutions(best.solutions) if isinstance(best, OPTIMISED) else self.motion.solve()

    @kept_property
    def usual(self) -> CamResult | None:
        """The cam of the same file with the usual law in its moves; None where it has no other laws."""
        spec, cycle = self.spec, usual_cycle(self.spec.cycle)
        if cycle is None:
            return None
        motion = replace(spec.motion, segment=tuple(cycle.segments), limits={})
        return CamResult(replace(spec, motion=motion, best="offset" if spec.best == "offset" else None))

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

    @kept_property
    def differences(self) -> Section:
        """The cam beside the one with the usual law; nothing where it has no other laws."""
        usual, chosen = self.usual, dict(self.values)
        if self.spec.radius is None and self.spec.best != "laws":
            chosen.pop("least prime circle", None)  # it is the prime circle
        if usual is None:
            return Section()
        if self.spec.best == "prime circle":
            return cam_differences(USUAL, usual.values, chosen, "prime circle", self._broken_by_usual).section()
        least = objective_name(self.plan)
        both = usual.values | objective_value(usual.plan, least), chosen | objective_value(self.plan, least)
        return cam_differences(USUAL, *both, least, self._broken_by_usual).section()

    def _broken_by_usual(self) -> list[str]:
        """What the cam with the usual law takes beyond the limits of the cycle and of the cam."""
        if self.usual is None:
            return []
        of_cam = self.spec.limits.broken(self.usual.cam.extremes)
        return [*broken_limits(self.usual.plan, self.plan.specification), *of_cam.values()]

    @kept_property
    def laws(self) -> Section:
        """What is least, with its bound and its status, among which laws it was found, and what is taken of limits."""
        return replace(_laws_section(self.plan, self._best), data=self.of_laws)

    @kept_property
    def of_laws(self) -> dict[str, Any]:
        """The quality of the laws for programs."""
        best, name = self.sought, self.spec.cycle.minimise
        data = {"laws": _of_laws(self.plan)}
        if isinstance(best, BestCam):
            objective, status = best.objective, best.status.value
        elif isinstance(best, BestPrimeCircle):
            name, objective = "prime circle", best.least.radius
            status = "optimal" if objective - best.lower_bound <= _SIZE_MET * objective else "local"
        else:
            return data
        best_of = {"minimise": name, "objective": objective, "status": status, "lower_bound": best.lower_bound}
        return {"best": best_of, **data}

    @property
    def _best(self) -> list[Row]:
        """The quality of the laws that were optimised for the cam; nothing where they are the cycle's own."""
        best, cycle, rows = self.sought, self.spec.cycle, list[Row]()
        name, unit = quantity_name(cycle.minimise), objective_unit(cycle)
        if isinstance(best, BestCam):
            rows = [
                Row(f"least {name} under the limits of the cam", (best.objective, best.lower_bound), unit),
                Row(f"least {name} without them", (cycle.objective, cycle.lower_bound), unit, note=cycle.status.value),
            ]
        elif isinstance(best, BestPrimeCircle):
            of_cycle = self._least_prime_circle(cycle)
            sizes = MILLI * best.least.radius, MILLI * best.lower_bound
            rows = [Row("least prime circle of all laws", sizes, "mm")]
            if isinstance(of_cycle, LeastPrimeCircle):
                rows.append(Row(f"of the laws of least {name}", (MILLI * of_cycle.radius, None), "mm"))
        return [row._replace(note=row.note or self.of_laws["best"]["status"]) for row in rows[:1]] + rows[1:]

    @kept_property
    def report(self) -> CamReport:
        """The report of the cam by itself."""
        return CamReport(self.cam, self.spec.limits, isinstance(self.sought, BestCam | BestPrimeCircle))

    @kept_property
    def offset(self) -> Section:
        """The best offset of the slide; nothing where the cam has the offset of the file."""
        best = self.sought
        if not isinstance(best, BestOffset):
            return Section()
        status = "optimal" if best.proven else "local"
        angles = degrees(best.pressure_angle), degrees(best.lower_bound)
        rows = [
            Row("best offset", (MILLI * best.offset, None), "mm", note=status),
            Row("greatest pressure angle with it", angles, "deg", note=status),
        ]
        table = ReportTable.of_pairs(rows, "value", "lower bound", "status")
        data = {name: value for name, value in vars(best).items() if name != "cam"}
        return Section("Offset", rows, table, {"best_offset": data}, digits=DIGITS)

    def _least_prime_circle(self, motion: Any) -> LeastPrimeCircle | str:
        """The least prime circle of a motion under the limits, or why there is none."""
        try:
            return least_prime_circle(motion, self.cam.follower, **self.spec.constraints)
        except InfeasibleProblem as error:
            reason: str = error.args[0]
            return reason

    @kept_property
    def sizes(self) -> Section:
        """The least prime circle where there are limits, or the reason why none exists; and the greatest roller."""
        rows, data, reason = list[Row](), dict[str, Any](), ""

        def add(name: str, size: float, beyond: float, angle: float) -> dict[str, float | None]:
            rows.append(Row(name, (MILLI * size, MILLI * beyond), "mm", self._at(degrees(angle))))
            return {"angle": self._at(angle)}

        if isinstance(least := self.least, LeastPrimeCircle):
            angle = add(f"least prime circle, by the {least.limit}", least.radius, least.too_small, least.angle)
            sizes = {"radius": least.radius, "base_radius": least.cam.base_radius, "too_small": least.too_small}
            data["least_prime_circle"] = {**sizes, "proven": least.proven, "limit": least.limit, **angle}
        elif least is not None:
            data["least_prime_circle"], reason = None, capital(f"{least}.")
        if self.cam.contact.roller:
            roller = greatest_roller(self.cam, radius_of_curvature=self.spec.radius_of_curvature or "0 mm")
            angle = add("greatest roller", roller.radius, roller.too_large, roller.angle)
            data["greatest_roller"] = {"radius": roller.radius, "too_large": roller.too_large, **angle}
        table = ReportTable.of_pairs(rows, "satisfied with", "violated with") if rows else None
        return Section("Sizes" if rows else "", rows, table, data, note=reason, digits=DIGITS)

    @kept_property
    def least(self) -> LeastPrimeCircle | str | None:
        """The least prime circle, the reason why none exists, or None where no limit is given."""
        if not self.spec.limits.in_si:
            return None
        known = self.sought.least if isinstance(self.sought, BestPrimeCircle) else self.sought
        return known if isinstance(known, LeastPrimeCircle) else self._least_prime_circle(self.cam.motion)

    def _at(self, angle: float) -> float | None:
        """The angle at which a limit determines a size; None for laws that reach the limit at several angles."""
        return None if self.report.reached else angle

    @property
    def pair(self) -> Section:
        """The return cam of a pair."""
        if self.second is None:
            return Section()
        section = CamReport(self.second).section
        names = ("prime_radius", "base_radius", "greatest_pressure_angle", "convex_radius", "undercut")
        data = {"return_cam": {name: section.data[name] for name in names}}
        figure = ("pair", "Both cams on one shaft, with their followers at the start")
        note = "\n\n".join([section.note, self._links(_RETURN)])
        draw = partial(pair_figure, self.cam, self.second)
        return replace(section, heading="Return cam", data=data, figure=figure, note=note, draw=draw)

    def _links(self, prefix: str = "") -> str:
        return "\n".join(f"- [{prefix}{entry.name}]({prefix}{entry.name})" for entry in self.spec.file)

    @kept_property
    def loads(self) -> tuple[Section, ...]:
        """The forces, and with an irregularity of the shaft its energy, where the file has them."""
        given, forces = self.spec.forces, self.forces
        if given is None or forces is None:
            return ()
        sections = [
            replace(forces_section(forces, self.pressed), draw=partial(forces_figure, forces, usual=self._usual_forces))
        ]
        if given.irregularity is not None:
            sections.append(_energy_section(energy_fluctuation(forces), given.irregularity))
        if self.cam.extremes.undercut.status == UNDERCUT:
            doubt = "These forces assume the motion as specified, which an undercut cam cannot give."
            sections.append(Section(note=doubt))
        return tuple(sections)

    @property
    def _needs_spring(self) -> bool:
        """Whether the drive has no spring of its own, so that the least one presses the follower on the cam."""
        return self.spec.spring is not None and not self._linear_drive.keys() & _SPRING

    @property
    def _linear_drive(self) -> dict[str, Any]:
        """The constants of the drive; none where it has none."""
        drive = self.spec.cycle.drive
        return dict(drive) if isinstance(drive, Mapping) else {}

    @property
    def _usual_forces(self) -> tuple[str, CamForces] | None:
        """The forces of the cam with the usual law, where it has them."""
        usual = self.usual
        if usual is None or usual.cam.extremes.undercut.status == UNDERCUT:
            return None
        try:
            return None if usual.forces is None else (USUAL, usual.forces)
        except OptlawsError:
            return None

    @property
    def pressed(self) -> str:
        """The sentence on the spring with which the forces are computed; empty where none is looked for."""
        if self.spec.spring is None:
            return ""
        if self._needs_spring or self.counted:
            return "The least spring, which stands below, presses the follower on the cam here."
        return "The spring of the drive presses the follower on the cam here, not the least one, which stands below."

    @kept_property
    def least_spring(self) -> Spring:
        """The least spring; mass, gravity and friction are taken from the motion's drive."""
        entries = self.spec.spring
        if entries is None:
            raise InputError("spring: no spring is looked for: give its speeds")
        load = {key: value for key, value in self._linear_drive.items() if key not in _SPRING}
        return least_spring(self.cam, drive=load, process=self.spec.process, **entries.to_dict())

    @kept_property
    def spring(self) -> Section:
        """The least spring, where the file looks for one."""
        entries = self.spec.spring
        if entries is None:
            return Section()
        spring = self.least_spring
        force, stiffness = SPRING_UNITS[self.cam.displacement.axis]
        contact = entries.greatest == CONTACT
        greatest = "greatest contact force" if contact else "greatest force on the follower"
        sought = greatest if spring.objective in GREATEST.values() else spring.objective
        rows = [
            Row("stiffness", spring.stiffness, stiffness),
            Row("preload", spring.preload, force),
            Row(f"{greatest}, any speed", spring.greatest, "N" if contact else force),
            Row(f"lower bound of the {sought}", spring.lower_bound, stiffness if sought == "stiffness" else force),
            Row("least reserve of the spring force", spring.margin, force),
        ]
        rows = [rows[0], *(row._replace(value=chop(row.value, spring.greatest, FORCE_ROUNDING)) for row in rows[1:])]
        rows.append(Row("reserve is least at", chop(spring.critical[0], TURN_DEG, FORCE_ROUNDING), "deg"))
        note = " ".join(filter(None, [capital(f"{spring.remark}.") if spring.remark else "", self._spring_costs]))
        return Section("Spring", rows, data={"spring": spring.to_dict()}, note=note, digits=DIGITS)

    @property
    def _spring_costs(self) -> str:
        """What the reserve costs in these laws beside the usual one; blank where their spring is not stiffer."""
        name = "stiffness of the least spring"
        usual = None if self.usual is None else self.usual.values.get(name)
        if usual is None or not usual[0]:
            return ""
        stiffer = 100.0 * (self.least_spring.stiffness / usual[0] - 1.0)
        if stiffer < _STIFFER:
            return ""
        return (
            f"The reserve takes a spring that is {stiffer:.1f} % stiffer than with {USUAL}: limit the deceleration to "
            "need less."
        )

    @kept_property
    def manufactured(self) -> Section:
        """Peaks of the cam as manufactured; none where its follower does not reach all of it."""
        peaks = {} if self.spec.as_made is None else self.spec.as_made.of(self.cam)
        if not peaks:
            return Section()
        columns = {
            "what": peaks,
            f"deviation, {'um' if self.cam.displacement.axis == 'length' else 'urad'}": [
                each and MICRO * each.deviation for each in peaks.values()
            ],
            "peak acceleration, ratio": [each and each.acceleration_ratio for each in peaks.values()],
            "peak jerk, ratio": [each and each.jerk_ratio for each in peaks.values()],
        }
        hollow = "Where nothing stands the follower does not reach all of the cam, which is concave there."
        data = {name: None if each is None else each.to_dict() for name, each in peaks.items()}
        note = hollow if None in peaks.values() else ""
        return Section(
            "As made", table=ReportTable.of_columns(columns), data={"as_made": data}, note=note, digits=DIGITS
        )

    @property
    def warning(self) -> str:
        """That the follower leaves the cam, which stands before everything else; blank where it does not."""
        return "" if self.forces is None else leaves_at(self.forces)

    @property
    def sections(self) -> tuple[Section, ...]:
        """The parts of its page."""
        turning = Section("Turning", figure=("animation", "The cam turns under its follower"))
        files = Section("Files", note=self._links())
        sized = (self.differences, self.laws, self.report.section, self.offset, self.sizes, self.pair)
        last = ([turning] if self.spec.animation else []) + ([files] if self.spec.file else [])
        return *sized, *self.loads, self.spring, self.manufactured, *last

    @property
    def data(self) -> dict[str, Any]:
        """The cam for programs, in metres and radians: enclosures as pairs, with the angle of the cam."""
        data = {**_proven(self.spec, self.plan), "prime_radius": None, "base_radius": None, **self.of_laws}
        sized = (self.report.section, self.sizes, self.pair, self.differences)
        for section in (*sized, *self.loads, self.offset, self.spring, self.manufactured):
            data |= section.data
        return data

    @property
    def table(self) -> ReportTable:
        """Its curves over the turn."""
        return self.report.coordinates(self.spec.rows, self.spec.cutter_radius, self.second)

    def drawn(self, title: str) -> Figure:
        """The picture of the cam."""
        return cam_figure(self.cam, title, None if self.usual is None else (USUAL, self.usual.cam))


def _proven(spec: CamOfMotion, plan: Plan) -> dict[str, Any]:
    """The entries of a cam with the solutions of its laws and their proofs, from which its numbers follow."""
    return {"unit": "SI", "cam": spec.to_dict(), "solutions": steady([each.to_dict() for each in plan.solutions])}


def _rounded_up(value: float) -> float:
    """The least number of four digits that is no less."""
    steps = 10.0 ** (3 - floor(log10(value))) if value > 0.0 else 1.0
    return ceil(value * steps) / steps


def _laws_section(plan: Plan, best: Sequence[Row] = (), allowed: str = "") -> Section:
    """What is least with its bound and its status, or rows that are `best`, the search space, given laws and limits.

    Limits are followed by what is `allowed` by those of the cam.
    """
    laws = {each.name: getattr(each.stretch.given, "law", OPTIMAL) for each in plan.peaks}
    given = [f"{name} {shortened(law)}" for name, law in laws.items() if law != OPTIMAL]
    reached = limits_reached(plan)
    known = [
        *([f"Search space: {plan.search_space}."] if plan.search_space else []),
        *([f"Given laws: {'; '.join(given)}."] if given else []),
        *([f"Limits: {'; '.join(map(_rounded, reached))}."] if reached else []),
        *([f"{capital(allowed)}."] if allowed else []),
    ]
    rows = list(best)
    if not rows and plan.solutions:
        least = f"least {quantity_name(plan.minimise)}"
        rows = [Row(least, (plan.objective, plan.lower_bound), objective_unit(plan), note=plan.status.value)]
    rows = [row._replace(note=_with_gap(row)) for row in rows]
    table = ReportTable.of_pairs(rows, "value", "lower bound", "status") if rows else None
    return Section("Laws for the cam", rows, table, note="\n\n".join(known), digits=DIGITS)


def _with_gap(row: Row) -> str:
    """The status of an objective, and by what share its bound is below it where it is not optimal."""
    value, bound = row.value
    return f"{row.note}, gap {100.0 * (1.0 - bound / value):.2g} %" if bound and row.note == "local" else row.note


def _rounded(taken: LimitTaken) -> str:
    """The use of a limit, as pages show numbers."""
    texts = (text.on_page(DIGITS) if isinstance(text, Amount) else text for text in (taken.text, taken.value_text))
    limit, value = texts
    return str(taken._replace(text=limit, value_text=value))


def _of_laws(plan: Plan) -> dict[str, Any]:
    """The laws for programs, in SI units: what is least, its bound and status, and what is taken of each limit."""
    solved = bool(plan.solutions)
    return {
        "minimise": plan.minimise,
        "objective": plan.objective if solved else None,
        "lower_bound": plan.lower_bound if solved else None,
        "status": plan.status.value,
        "search_space": plan.search_space,
        "limits": [
            {"name": taken.name, "where": taken.where, "value": taken.value, "limit": taken.limit}
            for taken in limits_reached(plan)
        ],
    }


def _least_value(least: LeastPrimeCircle | str | None) -> Values:
    """The least prime circle among the values of a cam that has a greater one."""
    return {"least prime circle": (MILLI * least.radius, "mm")} if isinstance(least, LeastPrimeCircle) else {}


def _energy_section(energy: EnergyFluctuation, irregularity: float) -> Section:
    """Mean power and the work above the mean, with the flywheel of the shaft."""
    flywheel = energy.flywheel(irregularity)
    rows = [
        Row("mean power", energy.mean_power, "W"),
        Row("mean torque", energy.mean_torque, "N m"),
        Row("work above the mean torque", energy.energy, "J"),
        Row("the shaft is fastest at", degrees(energy.fastest_at), "deg"),
        Row("the shaft is slowest at", degrees(energy.slowest_at), "deg"),
        Row(f"flywheel for an irregularity of {irregularity:g}", flywheel, "kg m²"),
    ]
    return Section("Energy", rows, data={"energy": {**energy.to_dict(), "flywheel": flywheel}}, digits=DIGITS)
