"""The job "force loaded": laws of least drive torque under given loads, beside known laws, tabled and drawn."""

from __future__ import annotations

from collections.abc import Mapping
from decimal import ROUND_FLOOR, Context
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import msgspec
import numpy as np

from optlaws.errors import InputError, located
from optlaws.files import tables
from optlaws.files.problem_file import Text
from optlaws.formulas.of_motion import of_text
from optlaws.jobs.axes.drive_entries import drive_of
from optlaws.jobs.job import JobFile
from optlaws.laws import MotionLaw
from optlaws.laws.catalogue.catalogue import catalogue
from optlaws.mechanisms.drives.drive_train import Drive
from optlaws.mechanisms.linkages.mechanism import Mechanism
from optlaws.plots.style import BLUES, GREY, empty_figure, plot_style
from optlaws.results import Results
from optlaws.studies.problem_entries import ProblemEntries, gap, problem
from optlaws.synthesis import Solution, synthesize
from optlaws.synthesis.functionals.makers import drive_torque, peak, rms

if TYPE_CHECKING:
    from matplotlib.figure import Figure

HEADINGS = ("case", "law", "peak torque", "RMS torque", "B", "C", "lower bound", "gap", "status")
_POINTS = 401


class StrokeEntries(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """A stroke of a mechanism's input."""

    start: str
    stroke: str
    duration: str


class Case(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """A machine: its inertia over a, its friction, and the load over k or a; or a mechanism and its stroke."""

    name: Text
    inertia: Text | None = None
    friction: Text | None = None
    load: Text | None = None
    mechanism: dict[str, Any] | None = None
    drive: dict[str, Any] | None = None
    move: StrokeEntries | None = None

    def machine(self, folder: Path) -> CaseTorque:
        """The torque that drives it; paths of catalogues of motors are relative to a folder."""
        formulas = (self.inertia, self.friction, self.load)
        if self.mechanism is None and self.drive is None and self.move is None:
            inertia, friction, load = (
                formula if formula is not None else default
                for formula, default in zip(formulas, ("1", "0", "0"), strict=True)
            )
            torque = drive_torque(inertia=inertia, friction=friction, load=load)
            return CaseTorque(torque, 1.0, "", f"torque = {torque}")
        with located(f"case {self.name}"):
            if any(formula is not None for formula in formulas):
                raise InputError("a case has either inertia, friction and load, or a mechanism and its move")
            if self.mechanism is None or self.move is None:
                raise InputError(
                    "a mechanism has a move, such as move = { start = '0 deg', stroke = '180 deg', duration = '0.3 s' }"
                    ", and a move has a mechanism"
                )
            source = drive_of(self.mechanism, self.drive, folder)
            assert isinstance(source, Mechanism | Drive)  # noqa: S101 - as there is a mechanism
            moved = source.dimensionless(self.move.start, self.move.stroke, self.move.duration)
            turns = isinstance(source, Drive) or source.axis == "angle"
            place = "at the motor" if isinstance(source, Drive) else f"at the input of the {source.name}"
            where = f"{self.move.stroke} from {self.move.start} in {self.move.duration}"
            return CaseTorque(moved.torque, moved.unit, ", N m" if turns else ", N", f"torque {place}, {where}")


class CaseTorque(NamedTuple):
    """The torque of a case as a formula of a law, its unit, what stands behind its name in tables, and its text."""

    formula: str
    unit: float
    suffix: str
    about: str


class ForceLoadedProblemFile(JobFile, kw_only=True, forbid_unknown_fields=True):
    """The problem file of laws under loads."""

    problem: ProblemEntries
    case: Annotated[list[Case], msgspec.Meta(min_length=1, max_length=4)]
    catalogue: Annotated[list[Text], msgspec.Meta(max_length=4)] = msgspec.field(default_factory=list)


Laws = dict[str, tuple[MotionLaw, Solution | None]]


def run(results: Results) -> None:
    """Put the table, its page and the picture into results."""
    spec = results.read(ForceLoadedProblemFile)
    if len({case.name for case in spec.case}) < len(spec.case):
        raise InputError("case: names must differ")
    machines = {case.name: case.machine(results.file.parent) for case in spec.case}
    cases = {name: (machine, _laws(spec, name, machine)) for name, machine in machines.items()}
    lines = [
        _line(case, machine, name, *of_law) for case, (machine, laws) in cases.items() for name, of_law in laws.items()
    ]
    results.table("table", HEADINGS, lines)
    page = results.page("table").text(spec.text).figure("figure", spec.title).table(HEADINGS, lines, digits=7)
    texts = (f"{case}: {machine.about}; peak {peak(machine.formula).convexity}" for case, machine in machines.items())
    page.text("\n".join(texts))
    results.picture("figure", draw(spec.title, cases))


def _laws(spec: ForceLoadedProblemFile, case: str, machine: CaseTorque) -> Laws:
    """Known laws, the law of least peak acceleration, and the laws of least peak and least RMS torque."""
    laws: Laws = {name: (catalogue[name].law, None) for name in spec.catalogue}
    objectives = {
        "least C": "C",
        "least peak torque": peak(machine.formula).name,
        "least RMS torque": rms(machine.formula).name,
    }
    for name, minimise in objectives.items():
        solution = synthesize(problem(f"case {case}", spec.problem.given(), {"minimise": minimise}))
        laws[name] = (solution.law, solution)
    return laws


def _line(case: str, machine: CaseTorque, name: str, law: MotionLaw, solution: Solution | None) -> list[tables.Cell]:
    proof: list[tables.Cell] = [None, None, None]
    if solution is not None:
        unit = machine.unit if name != "least C" else 1.0
        proof = [_shown(solution, unit), gap(solution), solution.status.value]
    constants = law.constants
    torques = [machine.unit * constant(machine.formula).value(law) for constant in (peak, rms)]
    return [f"{case}{machine.suffix}", name, *torques, constants.B.value, constants.C.value, *proof]


def _shown(solution: Solution, unit: float) -> float:
    """The lower bound; of the phase plane six digits, rounded down, for more depend on the machine."""
    bound = unit * solution.lower_bound
    if solution.drive_limit is None:
        return bound
    return float(Context(prec=6, rounding=ROUND_FLOOR).create_decimal_from_float(bound))


def draw(title: str, cases: Mapping[str, tuple[CaseTorque, Laws]]) -> Figure:
    """A figure of the torque of every law over k, with a panel for each case."""
    with plot_style():
        figure = empty_figure(9.2, 3.2 * len(cases) + 0.6)
        panels = figure.subplots(len(cases), 1, sharex=True, squeeze=False)[:, 0]
        k = np.linspace(0.0, 1.0, _POINTS)
        for axes, (case, (machine, laws)) in zip(panels, cases.items(), strict=True):
            torque = of_text(machine.formula)
            for i, (name, (law, solution)) in enumerate(laws.items()):
                values = torque.values({"k": k, "a": law.a(k), "b": law.b(k), "c": law.c(k)})
                shade = GREY if solution is None else BLUES[-1 - (len(laws) - 1 - i)]
                style = "-" if solution is not None else (0, (1 + 2 * i, 2))
                label = name if axes is panels[0] else None
                axes.plot(k, np.broadcast_to(machine.unit * values, k.shape), color=shade, linestyle=style, label=label)
            axes.set_title(case, loc="left", fontsize=9.5)
            axes.set_ylabel(f"torque{machine.suffix}")
            axes.axhline(0.0, color=GREY, linewidth=0.6)
        panels[-1].set_xlabel("k")
        figure.suptitle(title, x=0.01, ha="left", fontsize=11.0)
        figure.legend(loc="outside lower center", ncols=3)
        return figure
