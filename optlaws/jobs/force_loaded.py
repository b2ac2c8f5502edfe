"""The job "force loaded": laws of least drive torque under given loads, beside known laws, tabled and drawn."""

from __future__ import annotations

from collections.abc import Sequence
from decimal import ROUND_FLOOR, Context
from typing import TYPE_CHECKING, Annotated

import msgspec
import numpy as np

from optlaws.errors import InputError
from optlaws.files import tables
from optlaws.files.problem_file import Text
from optlaws.formulas.of_motion import of_text
from optlaws.jobs.job import JobFile
from optlaws.laws import MotionLaw
from optlaws.laws.catalogue.catalogue import catalogue
from optlaws.plots.style import BLUES, GREY, empty_figure, plot_style
from optlaws.results import Results
from optlaws.studies.problem_entries import ProblemEntries, gap, problem
from optlaws.synthesis import Solution, synthesize
from optlaws.synthesis.functionals.makers import drive_torque, peak, rms

if TYPE_CHECKING:
    from matplotlib.figure import Figure

HEADINGS = ("case", "law", "peak torque", "RMS torque", "B", "C", "lower bound", "gap", "status")
_POINTS = 401


class Case(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """A machine: its inertia over a, its friction, and the load over k or a."""

    name: Text
    inertia: Text = "1"
    friction: Text = "0"
    load: Text = "0"

    @property
    def torque(self) -> str:
        """The torque that drives it."""
        return drive_torque(inertia=self.inertia, friction=self.friction, load=self.load)


class ForceLoadedProblemFile(JobFile, kw_only=True, forbid_unknown_fields=True):
    """The problem file of laws under loads."""

    problem: ProblemEntries
    case: Annotated[list[Case], msgspec.Meta(min_length=1, max_length=4)]
    catalogue: Annotated[list[Text], msgspec.Meta(max_length=4)] = msgspec.field(default_factory=list)


Laws = dict[str, tuple[MotionLaw, Solution | None]]


def run(results: Results) -> None:
    """Put the table, its page and the picture into results."""
    spec = results.read(ForceLoadedProblemFile)
    cases = {case.name: (case, _laws(spec, case)) for case in spec.case}
    if len(cases) < len(spec.case):
        raise InputError("case: names must differ")
    lines = [_line(case, name, *of_law) for case, laws in cases.values() for name, of_law in laws.items()]
    results.table("table", HEADINGS, lines)
    page = results.page("table").text(spec.text).figure("figure", spec.title).table(HEADINGS, lines, digits=7)
    texts = (f"{case.name}: torque = {case.torque}; peak {peak(case.torque).convexity}" for case in spec.case)
    page.text("\n".join(texts))
    results.picture("figure", draw(spec.title, list(cases.values())))


def _laws(spec: ForceLoadedProblemFile, case: Case) -> Laws:
    """Known laws, the law of least peak acceleration, and those of least peak and least RMS torque."""
    laws: Laws = {name: (catalogue[name].law, None) for name in spec.catalogue}
    objectives = {
        "least C": "C",
        "least peak torque": peak(case.torque).name,
        "least RMS torque": rms(case.torque).name,
    }
    for name, minimise in objectives.items():
        solution = synthesize(problem(f"case {case.name}", spec.problem.given(), {"minimise": minimise}))
        laws[name] = (solution.law, solution)
    return laws


def _line(case: Case, name: str, law: MotionLaw, solution: Solution | None) -> list[tables.Cell]:
    proof: list[tables.Cell] = [None, None, None]
    if solution is not None:
        proof = [_shown(solution), gap(solution), solution.status.value]
    constants = law.constants
    measures = [peak(case.torque).value(law), rms(case.torque).value(law), constants.B.value, constants.C.value]
    return [case.name, name, *measures, *proof]


def _shown(solution: Solution) -> float:
    """The lower bound; of the phase plane six digits, rounded down, for more depend on the machine."""
    if solution.drive_limit is None:
        return solution.lower_bound
    return float(Context(prec=6, rounding=ROUND_FLOOR).create_decimal_from_float(solution.lower_bound))


def draw(title: str, cases: Sequence[tuple[Case, Laws]]) -> Figure:
    """The torque of every law over k, one panel a case."""
    with plot_style():
        figure = empty_figure(9.2, 3.2 * len(cases) + 0.6)
        panels = figure.subplots(len(cases), 1, sharex=True, squeeze=False)[:, 0]
        k = np.linspace(0.0, 1.0, _POINTS)
        for axes, (case, laws) in zip(panels, cases, strict=True):
            torque = of_text(case.torque)
            for i, (name, (law, solution)) in enumerate(laws.items()):
                values = torque.values({"k": k, "a": law.a(k), "b": law.b(k), "c": law.c(k)})
                shade = GREY if solution is None else BLUES[-1 - (len(laws) - 1 - i)]
                style = "-" if solution is not None else (0, (1 + 2 * i, 2))
                label = name if axes is panels[0] else None
                axes.plot(k, np.broadcast_to(values, k.shape), color=shade, linestyle=style, label=label)
            axes.set_title(case.name, loc="left", fontsize=9.5)
            axes.set_ylabel("torque")
            axes.axhline(0.0, color=GREY, linewidth=0.6)
        panels[-1].set_xlabel("k")
        figure.suptitle(title, x=0.01, ha="left", fontsize=11.0)
        figure.legend(loc="outside lower center", ncols=3)
        return figure
