"""The job "machine laws": laws optimised for a machine beside standard and shaped laws, in a table and a plot."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import KW_ONLY, dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from optlaws.echo import shortened
from optlaws.entries.declared import Declared, FrozenTable, ValueOf, declared, entry
from optlaws.entries.value_types import Either, Listed, Number, ReadBy, Table, Text, Whole, is_list
from optlaws.errors import InfeasibleProblem, InputError, SolverFailure, located
from optlaws.files.tables import Cell
from optlaws.jobs.job_entries import ProblemFile
from optlaws.laws import MotionLaw
from optlaws.laws.catalogue.catalogue import catalogue
from optlaws.laws.making.input_shaping import Shaper, shaped_law
from optlaws.mechanisms.machine.machine import SPREAD, Machine, Measure
from optlaws.mechanisms.machine.models import mode
from optlaws.mechanisms.machine.transforms import velocity_transform_of
from optlaws.numbers import Array, bounded
from optlaws.plots.machine import laws_figure
from optlaws.results import Results
from optlaws.sentences import joined, sentence
from optlaws.shown.report import Panel, ReportTable, Section, Series
from optlaws.studies.problem_entries import gap, record
from optlaws.synthesis import Functional, Problem, Solution, at_most, synthesize
from optlaws.synthesis.problem.named_constants import named
from optlaws.synthesis.problem.problem import from_entries

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_RESIDUAL_ROUNDING = 1e-12  # of the vibration of a step: a residual that is less is rounding

_ROUNDED_UP = 1.001  # times a least value: laws are found from the printed one on

_MATRIX = Listed(Listed(Number()))
_OUTPUT = "An output of the machine."


def _list(value: Any) -> list[Any]:
    if not isinstance(value, list | tuple):
        raise InputError(f"it must be a list, got {shortened(value)}")
    return list(value)


@declared
class MachineTable(Declared, title="a machine"):
    """A machine of masses and links, of measured modes, or of matrices."""

    _: KW_ONLY
    masses: Mapping[str, float] | None = entry(Table(Number()), "Masses by name.", default=None)
    links: Sequence[Any] = entry(
        Listed(ReadBy(_list, "a list of two masses, a stiffness and perhaps a damping")),
        "Links of two masses: a stiffness, N/m, and perhaps a damping, N s/m.",
        default=(),
    )
    drive: str | Sequence[str] = entry(
        Either(Text(empty=True), Listed(Text()), which=is_list),
        "The mass that the law moves, or two: the law is the second one's distance from the first.",
        default="",
    )
    outputs: Mapping[str, str] | Sequence[str] = entry(
        Either(Listed(Text()), Table(Text()), which=lambda value: int(isinstance(value, Mapping))),
        "Outputs by the names they are to have; their names alone beside matrices.",
        default=(),
    )
    modes: Sequence[Sequence[float]] | None = entry(
        _MATRIX,
        "In place of masses: each a frequency in Hz, a damping ratio and perhaps a participation.",
        default=None,
    )
    A: Sequence[Sequence[float]] | None = entry(_MATRIX, "In place of both: the matrices of the machine.", default=None)
    B: Sequence[Sequence[float]] = entry(_MATRIX, "Of the inputs.", default=())
    C: Sequence[Sequence[float]] = entry(_MATRIX, "Of the outputs.", default=())
    D: Sequence[Sequence[float]] = entry(_MATRIX, "From inputs to outputs.", default=())
    inputs: str = entry(Text(), "The derivatives of the law that are inputs.", default="a")
    duration: float = entry(Number(), "Of the rise, s.", default=1.0)
    stroke: float = entry(Number(), "Of the rise.", default=1.0)

    def machine(self) -> Machine:
        """The machine of the table, checked."""
        if sum(given is not None for given in (self.masses, self.modes, self.A)) != 1:
            raise InputError("machine: give either masses with links and a drive, or modes, or matrices A, B, C and D")
        units = {"duration": self.duration, "stroke": self.stroke}
        outputs: Any = self.outputs if isinstance(self.outputs, Mapping) else list(self.outputs) or None
        drive: Any = self.drive
        with located("machine"):
            if self.modes is not None:
                return Machine.from_modes(self.modes, outputs=outputs, **units)
            if self.masses is not None:
                return Machine.from_masses(self.masses, self.links, drive=drive, outputs=outputs, **units)
            A, names = self.A or (), list(self.outputs)
            return Machine.from_units(A, self.B, self.C, self.D, inputs=self.inputs, outputs=names, **units)


@declared
class BoundedMeasure(Measure, title="a constant with its bound"):
    """A constant with its upper bound, of the machine, or of the law by its name."""

    _: KW_ONLY
    most: float = entry(Number(), "Its upper bound.", example=100.0)
    constant: str | None = entry(Text(), "In place of one of the machine: a constant of the law.", default=None)

    def bounded(self, machine: Machine) -> Functional:
        """The constant that is bounded."""
        return self.functional(machine) if self.constant is None else named(self.constant)


@declared
class Sought(Declared, title="a law that is sought"):
    """A sought law: its objective, its bounds, and further entries of a problem."""

    _: KW_ONLY
    name: str = entry(Text(), "What tables and pictures call it.", example="gentle")
    minimise: str | Measure = entry(
        Either(Text(), ValueOf(Measure), which=lambda value: int(isinstance(value, Mapping | Measure))),
        "A text as in a problem, or a constant of the machine.",
        default="C",
    )
    keep: tuple[BoundedMeasure, ...] = entry(
        Listed(ValueOf(BoundedMeasure)), "Constants with what each is at most.", default=()
    )
    problem: Mapping[str, Any] = entry(
        Table(ReadBy(lambda value: value, "what a problem takes")), "Any entries of a problem.", default=FrozenTable()
    )

    def stated(self, machine: Machine) -> Problem:
        """The problem of the law that is sought."""
        with located(f"sought {self.name!r}"):
            entries = from_entries({"order": 3, **self.problem})
            objective = self.minimise if isinstance(self.minimise, str) else self.minimise.functional(machine)
            limits = {bound.bounded(machine): at_most(bound.most) for bound in self.keep}
            entries["bounds"] = {**entries.get("bounds", {}), **limits}
            return Problem(**entries, minimise=objective)


SHAPERS: tuple[Shaper, ...] = ("ZV", "ZVD")
_POINTS = 401


@declared
class Vibration(Declared, title="a vibration"):
    """The output in which residual vibration counts, its modes, and the spread of their frequencies."""

    _: KW_ONLY
    output: str = entry(Text(), _OUTPUT, example="sway")
    modes: tuple[int, ...] = entry(Listed(Whole(1), least=1, most=4), "By their numbers.", default=(1,))
    shaped: int = entry(Whole(1), "The mode that laws are shaped for.", default=1)
    spread: float = entry(SPREAD, "The relative deviation of frequencies that is allowed for.", default=0.1)


@declared
class Pictured(Declared, title="a figure"):
    """The plotted output and laws, with the length of the plotted dwell."""

    _: KW_ONLY
    output: str = entry(Text(), _OUTPUT, example="sway")
    laws: tuple[str, ...] = entry(Listed(Text(), least=1, most=6), "Of which laws.", example=["modified sine"])
    dwell: float = entry(Number(least=0.0, most=5.0), "How much of the dwell, in durations.", default=0.5)
    spread: float = entry(SPREAD, "Of the frequencies.", default=0.25)


@declared
class MachineLawsProblemFile(ProblemFile, title="a problem file"):
    """The problem file of laws for a machine."""

    _: KW_ONLY
    machine: MachineTable = entry(ValueOf(MachineTable), "The machine.")
    vibration: Vibration = entry(ValueOf(Vibration), "What vibrates.")
    report: tuple[str, ...] = entry(Listed(Text()), "Outputs whose peaks are tabled.", example=["sway"])
    standard: tuple[str, ...] = entry(
        Listed(Text(), least=1, most=8), "Names of the catalogue.", example=["modified sine"]
    )
    sought: tuple[Sought, ...] = entry(
        Listed(ValueOf(Sought), least=1, most=8, each="sought", named=True), "The optimal laws."
    )
    figure: Pictured = entry(ValueOf(Pictured), "What is drawn.")
    units: Mapping[str, str] = entry(
        Table(Text()), "Units of outputs by their names, as tables and pictures show them.", default=FrozenTable()
    )

    def titled(self, output: str) -> str:
        """An output with its unit, where that is given."""
        return f"{output}, {self.units[output]}" if output in self.units else output


@dataclass(frozen=True, eq=False)
class Compared:
    """A law for the machine of a problem file; its solution if it is an optimum."""

    spec: MachineLawsProblemFile
    machine: Machine
    name: str
    law: MotionLaw
    solution: Solution | None = None

    def left(self, number: int, factors: Array) -> Array:
        """Residual amplitudes of a mode when all frequencies are multiplied by given factors."""
        vibration = self.machine.residual(number, self.spec.vibration.output)
        roots = np.asarray(mode(self.machine, number).root * factors, dtype=np.complex128)
        amplitudes = np.abs(velocity_transform_of(self.law)(roots))
        # the mode's share in the output is the same at every speed
        return np.where(amplitudes > _RESIDUAL_ROUNDING, vibration.share * amplitudes, 0.0)

    def row(self) -> dict[str, Cell]:
        """Its peaks, what is left of each mode at a low, the nominal and a high frequency and at most, its proof."""
        spec, spread, constants = self.spec, self.spec.vibration.spread, self.law.constants
        row: dict[str, Cell] = {"law": self.name, "B": constants.B.value, "C": constants.C.value}
        row["J"] = bounded(constants.J.value)
        response, percent = self.machine.response(self.law), f"{100.0 * spread:g} %"
        row |= {f"peak {spec.titled(output)}": response.rise_peak(output).value for output in spec.report}
        for number in spec.vibration.modes:
            ends = self.left(number, np.array([1.0 - spread, 1.0, 1.0 + spread])).tolist()
            greatest = self.machine.residual(number, spec.vibration.output, spread=spread).value(self.law)
            names = (f"-{percent}", "nominal", f"+{percent}", f"greatest within {percent}")
            row |= {f"mode {number} left, {name}": end for name, end in zip(names, [*ends, greatest], strict=True)}
        known = self.solution
        proof = (None,) * 3 if known is None else (known.lower_bound, gap(known), known.status.value)
        return row | dict(zip(("lower bound", "gap", "status"), proof, strict=True))

    def curve(self, at: Array, values: Array) -> Series:
        """A curve of it for pictures."""
        return Series(at, values, "known" if self.solution is None else "optimal", self.name)


def run(results: Results) -> None:
    """Put the table, its page, the laws and the picture into results."""
    spec = MachineLawsProblemFile.read(results.entries, results.file)
    results.title = spec.title
    machine = spec.machine.machine()
    _check(spec, machine)
    problems = [(sought.name, sought.stated(machine)) for sought in spec.sought]
    laws = list(compared(spec, machine, problems))
    rows = [{"law": law, "status": "no time for it"} if isinstance(law, str) else law.row() for law in laws]
    headings = list(max(rows, key=len))
    table = ReportTable(headings, [[row.get(heading) for heading in headings] for row in rows])
    results.table("table", *table)
    known = [law for law in laws if isinstance(law, Compared)]

    def draw() -> Figure:
        return laws_figure(spec.title, *_panels(spec, machine, known), 100.0 * spec.vibration.spread)

    page = results.page("table").text(spec.text).picture("figure", spec.title, draw)
    page.section(Section("The machine's modes", table=_modes(machine, spec.machine.duration)))
    page.section(Section("Laws", table=table, text=_about(spec), digits=5))
    results.records("laws.json", "laws", {law.name: record(law.solution) for law in known if law.solution is not None})


def _check(spec: MachineLawsProblemFile, machine: Machine) -> None:
    outputs = {"vibration": [spec.vibration.output], "figure": [spec.figure.output]}
    for where, names in {**outputs, "report": spec.report, "units": spec.units}.items():
        with located(where):
            for output in names:
                machine.place(output)
    with located("vibration"):
        for number in (*spec.vibration.modes, spec.vibration.shaped):
            mode(machine, number)
    shaped = [f"{name}, {shaper}" for name in spec.standard for shaper in SHAPERS]
    known = [*spec.standard, *shaped, *(sought.name for sought in spec.sought)]
    for name in spec.figure.laws:
        if name not in known:
            raise InputError(f"figure: no law is called {name!r}; there are {', '.join(known)}")


def compared(
    spec: MachineLawsProblemFile, machine: Machine, problems: Sequence[tuple[str, Problem]]
) -> Iterator[Compared | str]:
    """All laws, in the order of the table: standard ones, plain and shaped, and the optimal ones of problems.

    The name alone of a law that the vibration is too slow for.
    """
    vibration = mode(machine, spec.vibration.shaped)
    for name in spec.standard:
        law = catalogue[name].law
        yield Compared(spec, machine, name, law)
        for shaper in SHAPERS:
            called = f"{name}, {shaper}"
            try:
                shaped = shaped_law(law, vibration.frequency, vibration.damping, shaper)
            except InputError:
                yield called
            else:
                yield Compared(spec, machine, called, shaped)
    for name, problem in problems:
        with located(name):
            solution = solution_of_sought(problem)
        yield Compared(spec, machine, name, solution.law, solution)


def solution_of_sought(problem: Problem) -> Solution:
    """The solution of a problem; an error states what its limits would have to be, one at a time."""
    try:
        return synthesize(problem)
    except InfeasibleProblem as error:
        ways = [*_attainable(problem)]
        if not ways:
            raise
        text = sentence("{}. With the other limits unchanged, laws are found {}", error.args[0], joined(" or ", ways))
        raise InfeasibleProblem(text, problem=problem, tried=error.tried, proof=error.proof) from None


def _attainable(problem: Problem) -> Iterator[str]:
    """The least value of each limited constant that laws of a problem have within the other limits."""
    for constant, allowed in problem.bounds.items():
        others = {other: known for other, known in problem.bounds.items() if other is not constant}
        try:
            least = synthesize(replace(problem, minimise=constant, bounds=others)).objective
        except (InfeasibleProblem, SolverFailure, InputError):
            continue
        yield f"from {least * _ROUNDED_UP:.4g} on, in place of {allowed.high:g}, for {constant.name}"


def _about(spec: MachineLawsProblemFile) -> str:
    """Explanations of the columns of the laws' table, and the dimensionless constants in the machine's units."""
    output, stroke, duration = spec.vibration.output, spec.machine.stroke, spec.machine.duration
    unit = f" ({spec.units[output]})" if output in spec.units else ""
    units = ""
    if (stroke, duration) != (1.0, 1.0):
        units = (
            f": the peak acceleration is C times {stroke / duration**2:.6g}, the peak jerk J times "
            f"{stroke / duration**3:.6g}, in units of the stroke and seconds"
        )
    return (
        f"C and J are dimensionless{units}. The residual vibration of a mode is its amplitude in "
        f"{output!r}{unit} after the "
        "motion, with the stated frequencies, and with all of them off by the share in brackets. A "
        "law without a finite J has "
        "jumps of c."
    )


def _modes(machine: Machine, duration: float) -> ReportTable:
    """The machine's modes; in Hz too where the duration is known."""
    headings = ("mode", "radians in the rise", "periods in the rise", "damping", "frequency, Hz")
    columns, rows = len(headings) - (duration == 1.0), []
    for vibration in machine.modes:
        periods = vibration.frequency / (2.0 * np.pi)
        row = [vibration.number, vibration.frequency, periods, vibration.damping, periods / duration]
        rows.append(row[:columns])
    return ReportTable(headings[:columns], rows)


def _panels(spec: MachineLawsProblemFile, machine: Machine, laws: Sequence[Compared]) -> tuple[list[Panel], Panel]:
    """What is left of each mode over its frequency in percent, and an output over k."""
    figure, output = spec.figure, spec.vibration.output
    shown = [law for name in figure.laws for law in laws if law.name == name]
    factors = np.linspace(1.0 - figure.spread, 1.0 + figure.spread, _POINTS)
    k = np.linspace(0.0, 1.0 + figure.dwell, _POINTS)
    left = []
    for number in spec.vibration.modes:
        curves = tuple(law.curve(100.0 * (factors - 1.0), law.left(number, factors)) for law in shown)
        left.append(Panel(f"residual of mode {number} in {spec.titled(output)}", "", curves))
    moved = (law.curve(k, machine.response(law.law, dwell=figure.dwell)[figure.output](k)) for law in shown)
    return left, Panel(spec.titled(figure.output), "", tuple(moved))
