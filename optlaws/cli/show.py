"""Output of commands: reports, tables and lines for people, one JSON value for programs, pictures, files."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from optlaws.errors import OptlawsError

if TYPE_CHECKING:
    from threading import Event

    from matplotlib.figure import Figure
    from rich.console import Console
    from rich.table import Table

    from optlaws.exports.export import Export
    from optlaws.exports.front_export import FrontExport
    from optlaws.shown.report import Report, ReportTable
    from optlaws.shown.summary import Row, Summary

_WIDEST = 10_000
_DIGITS = 7
#: s, until a terminal shows that a command works, and between two lines that say so elsewhere
PATIENCE, BETWEEN_LINES = 1.0, 10.0
_REFRESHED = 0.2


@dataclass(frozen=True)
class Answer:
    """What a command has found: what it shows, its data for programs, what --plot draws, and an error at the end.

    `drawn` makes a figure, or artists in one. All are computed when they are used.
    """

    shown: Callable[[], Iterable[Report | Summary | ReportTable | str]]
    data: Callable[[], object]
    drawn: Callable[[], Any] | None = None
    failure: OptlawsError | None = None

    @classmethod
    def of(cls, report: Report, drawn: Callable[[], Any]) -> Self:
        """The answer of what makes a report."""
        return cls(lambda: [report], lambda: report.data, drawn)

    def give(self, picture: Path | None, *, as_json: bool, name: str = "optlaws") -> None:
        """Draw the picture into its file, where there is one, and print the rest, of a command of a name."""
        with busy(name):
            if picture is not None and self.drawn is not None:
                save_picture(picture, self.drawn)
            data = self.data() if as_json else None
        if as_json:
            print_json(data)
        else:
            for part in self.shown():
                try:
                    show(part)
                except BrokenPipeError:
                    # whoever read has seen enough; what goes into files is written all the same
                    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        if self.failure is not None:
            raise self.failure


def print_json(data: object) -> None:
    """Print one line of JSON; it has no infinity, so what has no bound is null."""
    import msgspec

    line = msgspec.json.format(msgspec.json.encode(data, enc_hook=_plain), indent=0)  # one line, blanks between items
    print(line.decode())


def _plain(value: Any) -> object:
    return str(value) if isinstance(value, str) else value.item()


def show(*parts: Report | Summary | ReportTable | str) -> None:
    """Print reports, facts and tables, and text unchanged: numbers are never cut, and no line ends with blanks."""
    from optlaws.shown.summary import Summary

    console = _answering()
    for part in parts:
        if isinstance(part, str):
            console.print(part, markup=False, highlight=False, soft_wrap=True)
        elif isinstance(part, Summary):
            for table in _tables_of(part):
                _show_table(table, console)
        elif isinstance(part, tuple):
            _show_table(_table(*part), console)
        else:
            show(part.facts, *part.tables)


def _answering() -> Console:
    """A console that leaves a closed pipe to the command: rich would end with 1."""
    from rich.console import Console

    class Answering(Console):
        def on_broken_pipe(self) -> None:
            raise BrokenPipeError

    return Answering(emoji=False)


def _table(headings: Iterable[str], rows: Iterable[Iterable[Any]], width: int = 0) -> Table:
    """A table of texts and numbers without lines; its first column is so wide at least, and never wraps."""
    from rich.table import Column, Table

    first, *others = headings
    head = any((first, *others))
    table = Table(Column(first, no_wrap=True, min_width=width), *others, show_header=head, box=None, pad_edge=False)
    for row in rows:
        table.add_row(*map(_cell, row))
    return table


def _cell(value: Any) -> str:
    return "" if value is None else value if isinstance(value, str) else f"{value:.{_DIGITS}g}"


def _tables_of(summary: Summary) -> Iterator[Table]:
    """Facts, each with its unit and its note behind it; those with places, and numbers below them, have columns."""
    from optlaws.shown.summary import Summary

    width = max((len(row.name) for row in summary), default=0)
    blocks: list[tuple[bool, list[Row]]] = []
    for row in summary:
        below = bool(blocks) and blocks[-1][0] and not isinstance(row.value, str)
        placed = row.place is not None or below
        if not blocks or blocks[-1][0] != placed:
            blocks.append((placed, []))
        blocks[-1][1].append(row)
    for placed, rows in blocks:
        if placed:
            headings, *cells = Summary(rows, summary.at).cells()
            yield _table(headings, cells, width)
        else:
            yield _table(("", ""), ((row.name, _fact(row)) for row in rows), width)


def _fact(row: Row) -> str:
    return " ".join(part for part in (row.text(), row.unit, f"({row.note})" if row.note else "") if part)


def _show_table(rows: Table, console: Console) -> None:
    """Print a table, wider than the terminal if its numbers need it; a terminal wraps words of facts alone."""
    from rich.measure import Measurement

    needs = Measurement.get(console, console.options.update(width=_WIDEST, max_width=_WIDEST), rows)
    facts = console.is_terminal and not rows.show_header
    console.width = max(console.width, needs.minimum if facts else needs.maximum)
    if console.is_terminal:
        console.print(rows, crop=False)
        return
    with console.capture() as captured:
        console.print(rows, crop=False)
    for line in captured.get().splitlines():
        print(line.rstrip())


def exported(export: Export | FrontExport, output: Path | None, drawn: Callable[[], Any]) -> Answer:
    """Write the text of an export into a file or, where it is shown, to stdout, and its report to stderr."""
    if output is not None:
        export.write(output)
        return Answer(lambda: [str(export)], lambda: export.results() | {"file": str(output)}, drawn)

    def shown() -> Iterator[str]:
        print(export.text, end="")
        print(export, file=sys.stderr)
        yield from ()

    return Answer(shown, lambda: export.results() | {"text": export.text}, drawn)


def save(file: Path | None, data: Mapping[str, Any]) -> None:
    """Write the file of --output, where there is one, with the name of its author program."""
    from optlaws.files.writing import MARK, write

    if file is not None:
        write(file, json.dumps({"about": MARK, **data}, indent=1) + "\n")


def save_picture(file: Path, drawn: Callable[[], Any]) -> None:
    """Draw a figure, or artists, into the file of --plot, in the format of its ending."""
    from optlaws.files.writing import write
    from optlaws.plots.style import plot_style, rendered

    with plot_style():
        drawing = drawn()
        figure: Figure = drawing if hasattr(drawing, "savefig") else drawing[0].get_figure(root=True)
        write(file, rendered(figure, file.suffix[1:]))


def progress() -> Console:
    """The stream for progress bars, so that stdout has the answer alone."""
    from rich.console import Console

    return Console(stderr=True)


@contextmanager
def busy(text: str) -> Iterator[None]:
    """Say on stderr what is being done: on a terminal in a line that changes, else in one every ten seconds.

    What is done within it has the same line.
    """
    from threading import Event, Thread

    from optlaws.shown.steps import shown_by, step, watches

    if watches():
        step(text.removeprefix("optlaws: "))
        yield
        return
    ended, latest = Event(), [text]

    def watcher(step: str, stays: bool) -> None:  # noqa: FBT001 - as all watchers
        latest[0] = f"{text}: {step}"
        if stays:
            print(latest[0], file=sys.stderr)

    display = _changing_line if sys.stderr is not None and sys.stderr.isatty() else _lines
    thread = Thread(target=display, args=(ended, latest), daemon=True)
    thread.start()
    try:
        with shown_by(watcher):
            yield
    finally:
        ended.set()
        thread.join()


def _changing_line(ended: Event, latest: list[str]) -> None:
    """The current step with its time, once it takes long; what else goes to stderr is above it."""
    if ended.wait(PATIENCE):
        return
    from rich.progress import Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

    columns = (SpinnerColumn(), TextColumn("{task.description}", markup=False), TimeElapsedColumn())
    with Progress(*columns, console=progress(), transient=True, redirect_stdout=False) as shown:
        task = shown.add_task(latest[0])
        while not ended.wait(_REFRESHED):
            shown.update(task, description=latest[0])


def _lines(ended: Event, latest: list[str]) -> None:
    """The current step, in a line each time."""
    for number in count(1):
        if ended.wait(BETWEEN_LINES):
            return
        print(f"{latest[0]}, {number * BETWEEN_LINES:.0f} s so far", file=sys.stderr)
