"""The page, the data and the table of a cam of a problem file."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from math import degrees
from typing import TYPE_CHECKING, Any, Self

from optlaws.cams.best_laws import BestCam, BestPrimeCircle
from optlaws.cams.cam_values import SPRING_UNITS, WITHOUT_FRICTION, cam_differences, objective_name, objective_value
from optlaws.cams.curves.extremes import UNDERCUT
from optlaws.cams.followers.follower import positive
from optlaws.cams.forces import CamForces
from optlaws.cams.least_sizes import BestOffset, LeastPrimeCircle, greatest_roller
from optlaws.cams.report import DIGITS, CamReport, forces_section, leaves_at
from optlaws.cams.springs_and_flywheels import CONTACT, GREATEST, EnergyFluctuation, energy_fluctuation
from optlaws.cycles.cycle import Plan
from optlaws.cycles.optimisation.objectives import kind_of
from optlaws.cycles.placed import limits_reached
from optlaws.cycles.report import objective_unit
from optlaws.cycles.specification.limits import LimitTaken
from optlaws.cycles.specification.segments import OPTIMAL
from optlaws.cycles.usual_law import why_without_usual_law
from optlaws.echo import shortened
from optlaws.errors import OptlawsError
from optlaws.jobs.cam_entries import CamOfMotion, CamProblemFile
from optlaws.jobs.sought_cam import RETURN, SIZE_MET, SoughtCam
from optlaws.kept import kept_property
from optlaws.laws.catalogue.catalogue import USUAL
from optlaws.motion.quantities import MICRO, MILLI, TURN, TURN_DEG, Kind
from optlaws.numbers import chop
from optlaws.plots.cam import cam_figure, forces_figure, pair_figure
from optlaws.sentences import Amount, Sentence, capital, quantity_name, sentence
from optlaws.shown.report import ReportTable, Section
from optlaws.shown.summary import Row
from optlaws.studies.problem_entries import steady
from optlaws.synthesis.status import Status
from optlaws.tolerances import FORCE_ROUNDING

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: in files the solutions whose bounds are those of laws under limits that are not linear in them
BOUNDING = "bounding_solutions"
_BY_RUN = "its bound is computed by optlaws run"
_KNOWN = 1e-6  # m: what a machine knows of a size
_LARGE = 2.0  # m: a larger prime circle is likelier one whose unit is missing
_STIFFER = 0.5  # per cent: what a spring is stiffer than with the usual law, from which on that is said


class CamResult(SoughtCam):
    """The disc cam of a problem file with its sections, which are empty of what the file does not ask."""

    @classmethod
    def of_file(cls, spec: CamProblemFile) -> Self:
        """The cam of a problem file, with its return cam, its forces and its cutters checked."""
        result = cls(spec).with_spring
        result.second, result.loads  # noqa: B018 - they are computed
        if spec.cutter_radius is not None:
            result.cam.cutter_path(spec.cutter_radius)
        for each in spec.file:
            result.cam.outline(each.curve, each.cutter_radius)
        return result

    @kept_property
    def differences(self) -> Section:
        """The cam beside the one with the usual law; its own values where it has no other laws."""
        usual, chosen = self.usual, dict(self.values)
        if self.spec.radius is None and self.spec.best != "laws":
            chosen.pop("least prime circle", None)  # it is the prime circle
        if usual is None:
            rows = [Row(quantity_name(name), *value).on_page() for name, value in chosen.items()]
            table = ReportTable(["what", "value", "unit"], [[row.name, row.value, row.unit] for row in rows])
            why = why_without_usual_law(self.spec.cycle) if self.plan.solutions else ""
            return Section("Peaks and sizes", rows, table, note=capital(f"{why}.") if why else "", digits=DIGITS)
        if self.spec.best == "prime circle":
            return cam_differences(USUAL, usual.values, chosen, "prime circle", self._broken_by_usual).section()
        least = objective_name(self.plan) + f" {WITHOUT_FRICTION}" * self._leaves_friction_out
        both = usual.values | objective_value(usual.plan, least), chosen | objective_value(self.plan, least)
        section = cam_differences(USUAL, *both, least, self._broken_by_usual).section()
        if "least prime circle" not in chosen or not isinstance(usual.least, str):
            return section
        none = capital(f"{USUAL} has no least prime circle: {usual.least}.")
        return replace(section, note="\n\n".join(filter(None, [section.note, none])))

    @kept_property
    def laws(self) -> Section:
        """What is least, with its bound and its status, among which laws it was found, and what is taken of limits."""
        section = laws_section(self.plan, self._best)
        note = "\n\n".join(filter(None, [section.note, self._friction_left_out]))
        return replace(section, note=note, data=self.of_laws)

    @property
    def _leaves_friction_out(self) -> bool:
        """Whether the power that is least is another than that of the shaft."""
        friction = None if self.spec.forces is None else self.spec.forces.friction
        power = isinstance(self.sought, BestCam) and kind_of(self.plan.minimise)[0] is Kind.POWER
        return power and friction is not None and bool(friction.contact or friction.guide)

    @property
    def _friction_left_out(self) -> Sentence | str:
        """What the least power leaves out, and what to do; blank where it is that of the shaft."""
        if self.forces is None or not self._leaves_friction_out:
            return ""
        taken = Amount(self.forces.torque.peak * self.forces.rate, "W", DIGITS)
        return sentence(
            "The power that is least is that which moves the follower: friction at the cam and in the guide has no "
            "part in it. With this friction the shaft takes up to {}: compare the torque at the shaft with that of "
            "laws of least force, or of narrower limits of the acceleration.",
            taken,
        )

    @kept_property
    def of_laws(self) -> dict[str, Any]:
        """The quality of the laws for programs."""
        best, name = self.sought, self.spec.cycle.minimise
        data = {"laws": _of_laws(self.plan)}
        if isinstance(best, BestCam):
            objective, status = best.objective, best.status.value
            # the bounds of laws below lines within the limits are none of all laws
            data["laws"] |= {"lower_bound": best.lower_bound, "status": status}
        elif isinstance(best, BestPrimeCircle):
            name, objective = "prime circle", best.least.radius
            status = "optimal" if objective - best.lower_bound <= SIZE_MET * objective else "local"
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
            free = self.plan if self.plan.of_its_problems() else cycle
            under, without = "under the limits of the cam", "without them"
            if self._leaves_friction_out:
                under, without = (f"{WITHOUT_FRICTION}, {limits} its limits" for limits in ("under", "without"))
            rows = [
                Row(f"least {name} {under}", (best.objective, best.lower_bound or None), unit),
                Row(f"least {name} {without}", (free.objective, free.lower_bound), unit, note=free.status.value),
            ]
            if self.bound_is_open:
                rows = [row._replace(value=(row.value[0], None), note=_BY_RUN) for row in rows]
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

    @kept_property
    def sizes(self) -> Section:
        """The least prime circle where there are limits, or the reason why none exists; and the greatest roller."""
        rows, data, notes, off = list[Row](), dict[str, Any](), list[str](), 0.0

        def add(name: str, size: float, beyond: float, angle: float) -> dict[str, float | None]:
            nonlocal off
            rows.append(Row(name, MILLI * size, "mm", self._at(degrees(angle))))
            off = max(off, abs(beyond - size))
            return {"angle": self._at(angle)}

        if isinstance(least := self.least, LeastPrimeCircle):
            angle = add(f"least prime circle, by the {least.limit}", least.radius, least.too_small, least.angle)
            sizes = {"radius": least.radius, "base_radius": least.cam.base_radius, "too_small": least.too_small}
            data["least_prime_circle"] = {**sizes, "proven": least.proven, "limit": least.limit, **angle}
        elif least is not None:
            data["least_prime_circle"], notes = None, [capital(f"{least}.")]
        if self.cam.contact.roller:
            roller = greatest_roller(self.cam, radius_of_curvature=self.spec.radius_of_curvature or "0 mm")
            angle = add("greatest roller", roller.radius, roller.too_large, roller.angle)
            data["greatest_roller"] = {"radius": roller.radius, "too_large": roller.too_large, **angle}
        if not rows:
            return Section(data=data, note=" ".join(notes), digits=DIGITS)
        further = Amount(MICRO * max(off, _KNOWN), "um").on_page(DIGITS)
        notes.append(f"Each size is proven: it satisfies the limits, and one beyond it by {further} violates them.")
        table = ReportTable(["what", "size", "unit", "at, deg"], [[r.name, r.value, r.unit, r.place] for r in rows])
        return Section("Sizes", rows, table, data, note=" ".join(notes), digits=DIGITS)

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
        note = "\n\n".join([section.note, self._links(RETURN)])
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
        if self._has_least_spring:
            return "The least spring, which stands below, presses the follower on the cam here."
        return "The spring of the drive presses the follower on the cam here, not the least one, which stands below."

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
        """What stands before everything else: that the follower leaves the cam, or that the cam is of metres."""
        radius = positive(self.cam.prime_radius, "prime_radius")
        large = f"The prime circle has a radius of {radius:.{DIGITS}g} m: a length without a unit is in metres."
        left = "" if self.forces is None else leaves_at(self.forces, sought=self._has_least_spring)
        return " ".join(filter(None, [large if radius > _LARGE else "", left]))

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
        data = {**proven_entries(self.spec, self.plan), "prime_radius": None, "base_radius": None, **self.of_laws}
        best = self.sought
        if isinstance(best, BestCam) and best.bounding and best.bounding != tuple(self.plan.solutions):
            data[BOUNDING] = steady([each.to_dict() for each in best.bounding])
        sized = (self.report.section, self.sizes, self.pair, self.differences)
        for section in (*sized, *self.loads, self.offset, self.spring, self.manufactured):
            data |= section.data
        return data

    @property
    def table(self) -> ReportTable:
        """Its curves over the turn."""
        return self.table_of(self.spec.rows, self.forces)

    def table_of(self, count: int, forces: CamForces | None) -> ReportTable:
        """Its motion, curves and forces at so many equal steps of the turn."""
        rate = TURN / self.motion.duration
        return self.report.coordinates(count, rate, forces, self.spec.cutter_radius, self.second)

    def drawn(self, title: str) -> Figure:
        """The picture of the cam."""
        return cam_figure(self.cam, title, None if self.usual is None else (USUAL, self.usual.cam))


def proven_entries(spec: CamOfMotion, plan: Plan) -> dict[str, Any]:
    """The entries of a cam with the solutions of its laws and their proofs, from which its numbers follow."""
    return {"unit": "SI", "cam": spec.to_dict(), "solutions": steady([each.to_dict() for each in plan.solutions])}


def laws_section(plan: Plan, best: Sequence[Row] = (), allowed: str = "") -> Section:
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
    facts = [row._replace(value=row.value[0]) for row in rows]  # the gap says where the bound is
    return Section("Laws for the cam", facts, table, note="\n\n".join(known), digits=DIGITS)


def _with_gap(row: Row) -> str:
    """The status of an objective, and by what share its bound is below it where it is not optimal."""
    value, bound = row.value
    if row.note != Status.LOCAL.value:
        return row.note
    return f"{row.note}, gap {100.0 * (1.0 - bound / value):.2g} %" if bound else f"{row.note}, no bound is known"


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
