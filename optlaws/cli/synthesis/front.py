"""The command `optlaws front`: exchanges between two or three constants."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

from cyclopts import Parameter

import optlaws
from optlaws.cli.options import AsJson, Plot, Whole, check_files, save_picture
from optlaws.cli.problem_options import asks_for_a_problem
from optlaws.cli.show import busy, print_json, show, table
from optlaws.errors import InputError
from optlaws.numbers import positive, whole
from optlaws.synthesis.problem.named_constants import apart


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class ProofOptions:
    """How a front is proven: at its points, or at every value between them.

    Parameters
    ----------
    bound
        Where D is in the front: tight searches all laws at each point, for a bound that usually meets the objective.
    gap
        Prove the front of two constants at every value between, to this gap relative to the objective; points are then
        values that are shown, and --json is what `optlaws verify` proves.
    """

    bound: Literal["quick", "tight"] = "quick"
    gap: float | None = None

    def check(self) -> None:
        """Refuse proofs of points and of all values at once."""
        if self.gap is not None and self.bound != "quick":
            raise InputError("--bound tight proves the points of a front, --gap every value between: give one of them")


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class FileOptions:
    """Files to write of a front: a table, a picture, or functions of a controller, which choose a law at run time.

    Parameters
    ----------
    csv
        Write the constants of all laws to this file.
    plot
        Draw the front into this file, PNG or SVG.
    to
        The language of functions, for a front of B and C. They go to --output or, without it, to stdout, and what is
        proven of them to stderr.
    within
        The greatest gap of C at run time; the front is proven to a tenth of it unless --gap says otherwise.
    name
        Before every name of a C header, or of the function block.
    output
        The file to write.
    """

    csv: Path | None = None
    plot: Plot = None
    to: Literal["c99", "iec-st"] | None = None
    within: float = 1e-3
    name: str = "Front"
    output: Path | None = None


_AT_POINTS, _NO_FILES = ProofOptions(), FileOptions()


@asks_for_a_problem(
    given={"degree": 9, "basis": "chebyshev"}, refused={"minimise": "the last constant of --over is minimised"}
)
def front(
    entries: dict[str, Any],
    *,
    over: str | None = None,
    points: Whole = 50,
    between: tuple[float, float] | None = None,
    proof: ProofOptions = _AT_POINTS,
    files: FileOptions = _NO_FILES,
    as_json: AsJson = False,
) -> None:
    """Find the laws that exchange constants for one another: each the best of its own problem.

    Parameters
    ----------
    over
        Two or three constants, separated by commas, such as "residual(frequency=20),C"; the last is minimised at given
        values of the others. "B,C" unless given, with --to "at_most.B,C".
    points
        How many laws.
    between
        Least and greatest value of the first constant; where it pays unless given.
    as_json
        Print one JSON object on stdout and nothing else.
    """
    check_files(files.csv, files.output, plot=files.plot)
    proof.check()
    if files.output is not None and files.to is None:
        raise InputError("--output is where functions of a controller go: say --to c99 or --to iec-st")
    proven_to = positive(files.within, "within") / 10.0 if files.to and proof.gap is None else proof.gap
    problem, names = optlaws.Problem.from_dict(entries), tuple(apart(over or ("at_most.B,C" if files.to else "B,C")))
    front: optlaws.Front | optlaws.ProvenFront
    if proven_to is None:  # which shows its steps itself
        front = optlaws.pareto_front(problem, names, points=points, between=between, bound=proof.bound)
    else:
        with busy("solving"):
            front = optlaws.proven_front(problem, names, between=between, gap=proven_to)
    headings, rows = _table(front, whole(points, "points", least=2))
    if files.csv is not None:
        _save_table(front, files.csv, headings, rows)
    if files.plot is not None:
        save_picture(files.plot, front)
    if isinstance(front, optlaws.ProvenFront) and files.to is not None:
        _export(front, files, as_json=as_json)
    elif as_json:
        print_json(front.to_dict())
    else:
        _show(front, headings, rows)


def _export(front: optlaws.ProvenFront, files: FileOptions, *, as_json: bool) -> None:
    """Write functions to their file or to stdout, and report their proof."""
    assert files.to is not None  # noqa: S101 - that is what it is called for
    export = front.export(files.to, files.within, name=files.name)
    if files.output is not None:
        export.write(files.output)
    if as_json:
        file = {"text": export.text} if files.output is None else {"file": str(files.output)}
        print_json(export.results() | file)
    elif files.output is None:
        print(export.text, end="")
        print(export, file=sys.stderr)
    else:
        show(str(export))


Rows = list[list[Any]]


def _table(front: optlaws.Front | optlaws.ProvenFront, points: int) -> tuple[tuple[str, ...], Rows]:
    if isinstance(front, optlaws.Front):
        return front.headings, front.rows
    low, high = front.between
    values = [low + (high - low) * i / (points - 1) for i in range(points - 1)]
    some = [front(value) for value in [*values, high]]
    return (*front.over, "lower bound", "gap"), [
        [point.value, point.objective, point.lower_bound, point.gap] for point in some
    ]


def _show(front: optlaws.Front | optlaws.ProvenFront, headings: tuple[str, ...], lines: Rows) -> None:
    def text(cell: Any, heading: str) -> str:
        if cell is None or isinstance(cell, str):
            return cell or ""
        return format(cell, ".0e" if heading == "gap" else ".7g")

    show(table(*headings, rows=(map(text, line, headings) for line in lines)))
    if isinstance(front, optlaws.ProvenFront):
        show(f"{front!r}")
        return
    if front.failed:
        values = ", ".join(f"{value:.6g}" for value in front.failed)
        show(f"no law was found at {front.over[0]} = {values}")


def _save_table(front: optlaws.Front | optlaws.ProvenFront, file: Path, headings: tuple[str, ...], lines: Rows) -> None:
    from optlaws.files import tables, writing

    problem = front[0].problem if isinstance(front, optlaws.Front) else front.problem
    about = f"{' and '.join(front.over)} exchanged: {problem!r}"
    writing.write(file, tables.to_csv(headings, lines, about=about))
