"""The job "cam": a cam with enclosed pressure angles and curvatures, proof of no undercut, least sizes, its curves."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import KW_ONLY, dataclass, replace
from functools import partial
from math import degrees
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from optlaws.cams.as_manufactured import PeaksAsMade
from optlaws.cams.barrel import BarrelCam, Groove
from optlaws.cams.best_laws import BestCam, BestPrimeCircle, best_cam, best_prime_circle
from optlaws.cams.conjugate import ReturnFollower, conjugate_cam
from optlaws.cams.curves.cam_files import CutFile
from optlaws.cams.curves.extremes import UNDERCUT
from optlaws.cams.disc import TURNINGS, DiscCam, Turning
from optlaws.cams.followers.follower import CamFollower, stated_prime_radius
from optlaws.cams.followers.rollers import TranslatingRoller
from optlaws.cams.forces import CamForces, Surfaces
from optlaws.cams.least_sizes import (
    BestOffset,
    CamLimits,
    LeastPrimeCircle,
    best_offset,
    greatest_roller,
    least_prime_circle,
)
from optlaws.cams.report import CamReport, barrel_coordinates, barrel_section, forces_section
from optlaws.cams.springs_and_flywheels import (
    CONTACT,
    GREATEST,
    EnergyFluctuation,
    SoughtSpring,
    energy_fluctuation,
    least_spring,
)
from optlaws.cycles.cycle import Cycle
from optlaws.cycles.report import objective_unit
from optlaws.cycles.specification.drive import ProcessEntries
from optlaws.entries.declared import ValueOf, declared, entries_of, entry, same
from optlaws.entries.value_types import Choice, Listed, Measured, Number, Switch, Whole
from optlaws.errors import InfeasibleProblem, InputError, located
from optlaws.jobs.cycle_entries import AxisEntries, cycle_of
from optlaws.jobs.job_entries import ProblemFile
from optlaws.kept import kept_property
from optlaws.motion.quantities import MICRO, MILLI, TURN, TURN_DEG, Exact
from optlaws.numbers import Quantity, chop
from optlaws.plots.cam import animated, barrel_figure, cam_figure, forces_figure, pair_figure
from optlaws.results import Results
from optlaws.sentences import capital
from optlaws.shown.report import ReportTable, Section
from optlaws.shown.summary import Row
from optlaws.tolerances import FORCE_ROUNDING

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_SIZE_MET = 1e-7  # of a radius: a size that is proven to so much is the least one
#: before the names of the files of the return cam
_RETURN = "return-"
#: units of forces and of stiffness by what the follower's way is
_SPRING_UNITS = {"length": ("N", "N/m"), "angle": ("N m", "N m/rad")}

_LENGTH = Measured("length", above=0.0)


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
    speed: Quantity | None = same(Cycle, "speed")
    period: Quantity | None = same(Cycle, "period")
    turning: Turning = entry(Choice(*TURNINGS), "How the cam turns.", default="counterclockwise")
    cutter_radius: str | None = entry(
        _LENGTH,
        "Of the cutter or grinding wheel, whose path is part of the table then.",
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
        "lowest; without one the least that keeps pressure_angle and radius_of_curvature is taken, or what best finds.",
        default=None,
        label="prime circle",
        example="60 mm",
    )
    #: the name that earlier files have for `prime_radius`
    base_radius: Quantity | None = entry(_LENGTH, "That of earlier files.", default=None, shown=False)
    pressure_angle: Quantity | None = same(CamLimits, "pressure_angle")
    radius_of_curvature: Quantity | None = same(CamLimits, "radius_of_curvature")
    best: str | None = entry(
        Choice("laws", "prime circle", "offset"),
        "What is optimised: the laws of the motion under the limits of the cam, at the given prime circle; the laws "
        "with the least prime circle; or the offset of a slide with a roller whose greatest pressure angle is least.",
        default=None,
    )
    pair: ReturnFollower | None = entry(ValueOf(ReturnFollower), "A return cam.", default=None)
    process: Any = entry(
        ValueOf(ProcessEntries), "A process force on the follower, in forces and spring.", default=None
    )
    forces: CamForcesEntries | None = entry(
        ValueOf(CamForcesEntries), "Contact forces under the drive of the motion.", default=None
    )
    spring: SoughtSpring | None = entry(
        ValueOf(SoughtSpring), "The least spring that keeps the follower on the cam.", default=None
    )
    as_made: PeaksAsMade | None = entry(ValueOf(PeaksAsMade), "Peaks as made.", default=None)
    file: tuple[CutFile, ...] = entry(Listed(ValueOf(CutFile), most=50), "Files that cut the cam.", default=())
    animation: bool = entry(Switch(), "Whether animation.svg is written, in which the cam turns.", default=False)

    @classmethod
    def _from_earlier(cls, data: dict[str, Any]) -> dict[str, Any]:
        """The best "base circle" of earlier files is the prime circle."""
        return data | {"best": "prime circle"} if data.get("best") == "base circle" else data

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


@declared
class BarrelProblemFile(CamOfMotion, title="a barrel cam"):
    """The problem file of a barrel cam."""

    _: KW_ONLY
    barrel: Groove = entry(ValueOf(Groove), "The cylinder, its groove and the roller.")


def run(results: Results) -> None:
    """Put the cam's page, data, table, pictures and files into results."""
    result = read(results.entries, results.file)
    title = results.title = result.spec.title
    page = results.page("cam").text(result.spec.text).picture("cam", title, result.drawn(title))
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
            return CamResult.of_file(spec)
        cam = BarrelCam(spec.cycle, **spec.barrel.to_dict(), turning=spec.turning)
        section, table = barrel_section(cam), barrel_coordinates(cam, spec.rows, spec.cutter_radius)
        return BarrelResult(spec, (section,), {"unit": "SI", **section.data}, table, partial(barrel_figure, cam))


class BarrelResult(NamedTuple):
    """The barrel cam of a problem file, with what `CamResult` has."""

    spec: BarrelProblemFile
    sections: tuple[Section, ...]
    data: dict[str, Any]
    table: ReportTable
    drawn: Callable[[str], Figure]


@dataclass(frozen=True)
class CamResult:
    """The disc cam of a problem file with what is sought of it; a section is empty of what the file does not ask."""

    spec: CamProblemFile

    @classmethod
    def of_file(cls, spec: CamProblemFile) -> CamResult:
        """The cam of a problem file, with its return cam, its forces and its cutters checked."""
        result = cls(spec)
        result.second, result.loads  # noqa: B018 - they are computed
        if spec.cutter_radius is not None:
            result.cam.cutter_path(spec.cutter_radius)
        for each in spec.file:
            result.cam.outline(each.curve, each.cutter_radius)
        return result

    @kept_property
    def sought(self) -> BestCam | BestPrimeCircle | BestOffset | LeastPrimeCircle | None:
        """What determines the cam where the file does not give all of it."""
        spec, follower, radius, limits = self.spec, self.spec.follower, self.spec.radius, self.spec.constraints
        if spec.best == "prime circle":
            if radius is not None:
                raise InputError("best = 'prime circle' computes prime_radius: leave it out, or give best = 'laws'")
            return best_prime_circle(spec.cycle, follower, **limits)
        if radius is None and (spec.best is not None or not spec.limits.in_si):
            raise InputError(
                "prime_radius is missing: give it, such as '60 mm'; or give pressure_angle or radius_of_curvature, and "
                "the least one that keeps them is taken; or give best = 'prime circle'"
            )
        if spec.best == "laws":
            return best_cam(spec.cycle, radius, follower, **limits)
        if spec.best is None:
            return None if radius is not None else least_prime_circle(spec.cycle, follower, **limits)
        if not isinstance(follower, TranslatingRoller):
            raise InputError(f"best = 'offset' is of a translating roller, got a {follower.kind}")
        if "offset" in follower.to_dict():
            raise InputError("follower: best = 'offset' computes the offset: leave it out")
        return best_offset(spec.cycle, radius, follower, turning=spec.turning)

    @kept_property
    def cam(self) -> DiscCam:
        """The cam, with what is sought."""
        spec, sought = self.spec, self.sought
        if sought is None:
            return DiscCam(spec.cycle, spec.radius, spec.follower, turning=spec.turning)
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
        cycle, beside = self.spec.cycle, dict[str, Any]()
        if self.cam.motion is not cycle:  # laws that were found for a cam are no cycle, but go as fast
            beside = {"speed": Exact(TURN / cycle.duration, "rad/s"), "drive": cycle.drive}
        options = {name: getattr(surfaces, name) for name in entries_of(Surfaces)}
        return CamForces(self.cam, process=self.spec.process, **options, **beside)

    @kept_property
    def laws(self) -> Section:
        """The quality of the laws for the cam; nothing where they are the cycle's own."""
        best, cycle = self.sought, self.spec.cycle
        name, unit = cycle.minimise, objective_unit(cycle)
        if isinstance(best, BestCam):
            objective, status = best.objective, best.status.value
            rows = [
                Row(f"least {name} under the limits of the cam", (objective, best.lower_bound), unit, note=status),
                Row(f"least {name} without them", (cycle.objective, cycle.lower_bound), unit, note=cycle.status.value),
            ]
        elif isinstance(best, BestPrimeCircle):
            objective, of_cycle = best.least.radius, self._least_prime_circle(cycle)
            status = "optimal" if objective - best.lower_bound <= _SIZE_MET * objective else "local"
            sizes = MILLI * objective, MILLI * best.lower_bound
            rows = [Row("least prime circle of all laws", sizes, "mm", note=status)]
            if isinstance(of_cycle, LeastPrimeCircle):
                rows.append(Row(f"of the laws of least {name}", (MILLI * of_cycle.radius, None), "mm"))
            name = "prime circle"
        else:
            return Section()
        table = ReportTable.of_pairs(rows, "value", "no laws are below", "status")
        data = {"minimise": name, "objective": objective, "status": status, "lower_bound": best.lower_bound}
        return Section("Laws for the cam", rows, table, {"best": data}, digits=6)

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
        table = ReportTable.of_pairs(rows, "value", "no offset is below", "status")
        data = {name: value for name, value in vars(best).items() if name != "cam"}
        return Section("Offset", rows, table, {"best_offset": data}, digits=6)

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
        table = ReportTable.of_pairs(rows, "kept with", "broken with") if rows else None
        return Section("Sizes" if rows else "", rows, table, data, note=reason)

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
        names = ("prime_radius", "base_radius", "greatest_pressure_angle", "bulging_radius", "undercut")
        data = {"return_cam": {name: section.data[name] for name in names}}
        figure = ("pair", "Both cams on one shaft, with their followers at the start")
        note = "\n\n".join([section.note, self._links(_RETURN)])
        draw = partial(pair_figure, self.cam, self.second)
        return Section("Return cam", section.facts, section.table, data, figure, section.text, note, draw=draw)

    def _links(self, prefix: str = "") -> str:
        return "\n".join(f"- [{prefix}{entry.name}]({prefix}{entry.name})" for entry in self.spec.file)

    @kept_property
    def loads(self) -> tuple[Section, ...]:
        """The forces, and with an irregularity of the shaft its energy, where the file has them."""
        given, forces = self.spec.forces, self.forces
        if given is None or forces is None:
            return ()
        sections = [replace(forces_section(forces), draw=partial(forces_figure, forces))]
        if given.irregularity is not None:
            sections.append(_energy_section(energy_fluctuation(forces), given.irregularity))
        if self.cam.extremes.undercut.status == UNDERCUT:
            doubt = "That is so if the follower moves as asked, which it cannot on a cam that is undercut."
            sections.append(Section(note=doubt))
        return tuple(sections)

    @kept_property
    def spring(self) -> Section:
        """The least spring; mass, gravity and friction are taken from the motion's drive."""
        entries = self.spec.spring
        if entries is None:
            return Section()
        given = self.spec.cycle.drive if isinstance(self.spec.cycle.drive, Mapping) else {}
        load = {key: value for key, value in given.items() if key not in {"stiffness", "preload"}}
        spring = least_spring(self.cam, drive=load, process=self.spec.process, **entries.to_dict())
        force, stiffness = _SPRING_UNITS[self.cam.displacement.axis]
        contact = entries.greatest == CONTACT
        greatest = "greatest contact force" if contact else "greatest force on the follower"
        sought = greatest if spring.objective in GREATEST.values() else spring.objective
        rows = [
            Row("stiffness", spring.stiffness, stiffness),
            Row("preload", spring.preload, force),
            Row(f"{greatest}, any speed", spring.greatest, "N" if contact else force),
            Row(f"lower bound of the {sought}", spring.lower_bound, stiffness if sought == "stiffness" else force),
            Row("least force left along the follower's way", spring.margin, force),
        ]
        rows = [rows[0], *(row._replace(value=chop(row.value, spring.greatest, FORCE_ROUNDING)) for row in rows[1:])]
        rows.append(Row("it is left at", chop(spring.critical[0], TURN_DEG, FORCE_ROUNDING), "deg"))
        note = capital(f"{spring.remark}.") if spring.remark else ""
        return Section("Spring", rows, data={"spring": spring.to_dict()}, note=note, digits=6)

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
        hollow = "Where nothing stands the follower does not reach all of the cam: it has hollows."
        data = {name: None if each is None else each.to_dict() for name, each in peaks.items()}
        note = hollow if None in peaks.values() else ""
        return Section("As made", table=ReportTable.of_columns(columns), data={"as_made": data}, note=note, digits=5)

    @property
    def sections(self) -> tuple[Section, ...]:
        """The parts of its page."""
        turning = Section("Turning", figure=("animation", "The cam turns under its follower"))
        files = Section("Files", note=self._links())
        sized = (self.laws, self.report.section, self.offset, self.sizes, self.pair)
        last = ([turning] if self.spec.animation else []) + ([files] if self.spec.file else [])
        return *sized, *self.loads, self.spring, self.manufactured, *last

    @property
    def data(self) -> dict[str, Any]:
        """The cam for programs, in metres and radians: enclosures as pairs, with the angle of the cam."""
        data: dict[str, Any] = {"unit": "SI", "prime_radius": None, "base_radius": None}
        sized = (self.laws, self.report.section, self.sizes, self.pair)
        for section in (*sized, *self.loads, self.offset, self.spring, self.manufactured):
            data |= section.data
        return data

    @property
    def table(self) -> ReportTable:
        """Its curves over the turn."""
        return self.report.coordinates(self.spec.rows, self.spec.cutter_radius, self.second)

    def drawn(self, title: str) -> Figure:
        """The picture of the cam."""
        return cam_figure(self.cam, title)


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
    return Section("Energy", rows, data={"energy": {**energy.to_dict(), "flywheel": flywheel}}, digits=6)
