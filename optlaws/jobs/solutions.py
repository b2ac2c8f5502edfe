"""The job "solutions": a table of problems, each solved, with its bound, the best possible and laws to compare with."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import KW_ONLY
from itertools import product
from pathlib import Path
from typing import Any, TypeAlias

from optlaws.entries.declared import Declared, ValueOf, declared, entry
from optlaws.entries.value_types import Choice, Listed, Text
from optlaws.errors import InfeasibleProblem, InputError, SolverFailure, located
from optlaws.files import printed, tables
from optlaws.files.reading import check_names
from optlaws.jobs.job_entries import ProblemFile
from optlaws.results import Results
from optlaws.shown.report import ReportTable
from optlaws.studies.problem_entries import gap, problem, record, shown
from optlaws.synthesis import FUNCTIONALS, Certificate, Problem, Solution, Status, synthesize
from optlaws.synthesis.method.exchange import Method
from optlaws.synthesis.problem.fields import CONSTANTS
from optlaws.synthesis.problem.problem import ENTRIES, PROBLEM, SWEPT
from optlaws.synthesis.solve import Bound

#: the columns of what was found beside the constants of its law
RESULTS: dict[str, Callable[[Solution], tables.Cell]] = {
    "objective": lambda solution: solution.objective,
    "lower bound": lambda solution: solution.lower_bound,
    "gap": gap,
    "best possible": lambda solution: solution.best_possible,
    "above best possible, %": lambda solution: (
        None if solution.best_possible is None else f"{100.0 * (solution.objective / solution.best_possible - 1.0):.2f}"
    ),
    "status": lambda solution: solution.status.value,
}
COLUMNS = (*FUNCTIONALS, *RESULTS)
#: columns that problem files of version 1.0 name otherwise
_FORMER_COLUMNS = {"limit": "best possible", "above limit, %": "above best possible, %"}


class ColumnName(Text):
    """The name of a column."""

    def read(self, value: Any, name: str) -> str:
        text = super().read(value, name)
        return _FORMER_COLUMNS.get(text, text)


_NAMES = Listed(ColumnName(), least=1)


@declared
class Compare(Declared, title="a comparison"):
    """Another problem for each row, and which of its columns to show."""

    name: str = entry(Text(), "What headings call it.", example="law of least C")
    columns: tuple[str, ...] = entry(_NAMES, "Of `columns`, those that are shown.", example=["C"])
    problem: Mapping[str, Any] = entry(PROBLEM, "What differs in each row, as in `problem`.", example={"minimise": "C"})


@declared
class Beside(Declared, title="printed data"):
    """Printed data to stand beside."""

    file: str = entry(Text(), "A CSV file beside this one.", example="printed.csv")
    name: str = entry(Text(), "What headings call it.", example="printed")
    match: str = entry(Choice(*CONSTANTS), "The swept entry that finds its row.", example="B")
    columns: tuple[str, ...] = entry(_NAMES, "Which of its columns are shown.", example=["C"])


@declared
class SolutionsProblemFile(ProblemFile, title="a problem file"):
    """The problem file of a table of solutions."""

    _: KW_ONLY
    problem: Mapping[str, Any] = entry(PROBLEM, "What all rows share.", example={"minimise": "J", "order": 4})
    sweep: tuple[Mapping[str, Any], ...] = entry(
        Listed(SWEPT, least=1),
        "Tables of lists that go together, each of one length; the last table varies fastest.",
        example=[{"B": [1.6, 1.8, "free"]}],
    )
    bound: Bound = entry(Choice("quick", "tight"), "The argument of `synthesize`.", default="quick")
    method: Method = entry(Choice("auto", "ipopt"), "The argument of `synthesize`.", default="auto")
    columns: tuple[str, ...] = entry(
        _NAMES, "Constants of the law, or of what was found.", default=(*CONSTANTS, *tuple(RESULTS)[1:])
    )
    compare: tuple[Compare, ...] = entry(
        Listed(ValueOf(Compare), named=True), "Other problems in the same rows.", default=()
    )
    beside: Beside | None = entry(ValueOf(Beside), "Printed data in the same rows.", default=None)


#: a problem, its solution and the reason where there is none, and the proof of that
Tried: TypeAlias = tuple[Problem, Solution | None, Status, Certificate | None]


def run(results: Results) -> None:
    """Put the table, its page and the laws with their proofs into results."""
    spec = SolutionsProblemFile.read(results.entries, results.file)
    results.title = spec.title
    check_names([*spec.columns, *(name for compared in spec.compare for name in compared.columns)], COLUMNS, "column")
    entries = list(swept_entries(spec))
    beside = _beside(spec, results.file, entries)
    problems = [_problems(spec, i, entry) for i, entry in enumerate(entries, 1)]
    rows = [
        (_tried(first, spec.bound, spec.method), [_tried(other, method=spec.method)[1] for other in others])
        for first, *others in problems
    ]
    table = _table(spec, entries, rows, beside)
    results.table("table", *table)
    results.page("table").text(spec.text).table(*table)
    results.records("laws.json", "rows", [_data(*tried) for tried, _ in rows])


def _data(stated: Problem, solution: Solution | None, status: Status, proof: Certificate | None) -> dict[str, Any]:
    """A row for programs."""
    solved = None if solution is None else record(solution)
    known = {"asked": stated.to_dict(), "status": status, "solution": solved}
    return known if proof is None else {**known, "proof": proof.to_dict()}


def swept_entries(spec: SolutionsProblemFile) -> Iterator[dict[str, Any]]:
    """The swept entries of each row; the last table of `sweep` varies fastest."""
    parts = []
    names: list[str] = []
    for i, values in enumerate(spec.sweep):
        lengths = {len(value) for value in values.values()}
        if len(lengths) != 1:
            raise InputError(f"sweep[{i}]: needs one or more lists of one length, got lengths {sorted(lengths)}")
        for name in values:
            if name in names:
                raise InputError(f"sweep[{i}], {name}: it is swept twice")
            names.append(name)
        parts.append([dict(zip(values, some, strict=True)) for some in zip(*values.values(), strict=True)])
    for chosen in product(*parts):
        yield {name: value for part in chosen for name, value in part.items()}


def _problems(spec: SolutionsProblemFile, number: int, entries: Mapping[str, Any]) -> list[Problem]:
    """The problem of a row, and those that are compared with it."""
    row, others = f"row {number}", spec.compare
    others_stated = [problem(f"compare, {each.name}, {row}", spec.problem, entries, each.problem) for each in others]
    return [problem(row, spec.problem, entries), *others_stated]


def _tried(stated: Problem, bound: Bound = "quick", method: Method = "auto") -> Tried:
    """The solution of a problem; None where there is none, with the proof of that if it is one of this problem."""
    try:
        solution = synthesize(stated, bound=bound, method=method)
    except (InfeasibleProblem, SolverFailure) as error:
        proof = getattr(error, "proof", None)
        proves = isinstance(proof, Certificate) and proof.problem == stated
        return stated, None, Status.of(error), proof if proves else None
    return stated, solution, solution.status, None


def _beside(spec: SolutionsProblemFile, file: Path, entries: Sequence[Mapping[str, Any]]) -> list[list[tables.Cell]]:
    """The printed cells of each row, as printed."""
    if spec.beside is None:
        return [[] for _ in entries]
    source = file.parent / spec.beside.file
    lines = printed.rows(source)
    if not lines:
        raise InputError(f"beside: {source} has no rows")
    with located(f"beside: {source}"):
        check_names((spec.beside.match, *spec.beside.columns), lines[0], "column")
    by_value = {printed.number(line[spec.beside.match], str(source)): line for line in lines}
    values = (row.get(spec.beside.match) for row in entries)
    beside = (by_value.get(value, {}) if isinstance(value, float) else {} for value in values)
    return [[line.get(name) for name in spec.beside.columns] for line in beside]


def _table(
    spec: SolutionsProblemFile,
    entries: Sequence[Mapping[str, Any]],
    rows: Sequence[tuple[Tried, Sequence[Solution | None]]],
    beside: Sequence[Sequence[tables.Cell]],
) -> ReportTable:
    swept = list(entries[0])
    headings = [*(ENTRIES[name].label for name in swept), *spec.columns]
    headings += [f"{column}, {compared.name}" for compared in spec.compare for column in compared.columns]
    if spec.beside is not None:
        headings += [f"{column}, {spec.beside.name}" for column in spec.beside.columns]
    cells = []
    for row, ((_, solution, status, _), others), aside in zip(entries, rows, beside, strict=True):
        line: list[tables.Cell] = [shown(name, row[name]) for name in swept]
        line += [status if name == "status" else _cell(solution, name) for name in spec.columns]
        for compared, other in zip(spec.compare, others, strict=True):
            line += [_cell(other, name) for name in compared.columns]
        cells.append([*line, *aside])
    return ReportTable(headings, cells)


def _cell(solution: Solution | None, name: str) -> tables.Cell:
    if solution is None:
        return None
    return FUNCTIONALS[name].value(solution.law) if name in FUNCTIONALS else RESULTS[name](solution)
