"""Output of commands: tables and lines for people, one JSON value for programs."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING, Any

from optlaws.tolerances import VALUE_ROUNDING

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

    from optlaws.exports.export import Export
    from optlaws.exports.run_time.front_export import FrontExport
    from optlaws.shown.summary import Summary

_WIDEST = 10_000


def print_json(data: object) -> None:
    """Print one line of JSON; it has no infinity, so what has no bound is null."""
    import msgspec

    line = msgspec.json.format(msgspec.json.encode(data, enc_hook=_plain), indent=0)  # one line, blanks between items
    print(line.decode())


def _plain(value: Any) -> object:
    return str(value) if isinstance(value, str) else value.item()


def table(*headings: str, rows: Iterable[Iterable[str | float | None]] = (), digits: int = 7) -> Table:
    """A table of texts and of numbers to some digits, without lines; without headings its first column never wraps."""
    from rich.table import Table

    new_table = Table(*headings, show_header=bool(headings), box=None, pad_edge=False)
    if not headings:
        new_table.add_column(no_wrap=True)
    for row in rows:
        new_table.add_row(
            *("" if cell is None else cell if isinstance(cell, str) else f"{cell:.{digits}g}" for cell in row)
        )
    return new_table


def summary_table(summary: Summary, what: str = "") -> Table:
    """The rows of a summary as a table; `what` they are heads their names."""
    headings, *rows = summary.cells()
    return table(what, *headings[1:], rows=rows)


def show(*parts: Summary | Table | str) -> None:
    """Print tables, and text unchanged: numbers are never cut, and lines end without blanks except on a terminal."""
    console = _answering()
    for part in parts:
        if isinstance(part, str):
            console.print(part, markup=False, highlight=False, soft_wrap=True)
        elif isinstance(part, tuple):
            _show_table(summary_table(part), console)
        else:
            _show_table(part, console)


def _answering() -> Console:
    """A console that leaves a closed pipe to the command: rich would end with 1."""
    from rich.console import Console

    class Answering(Console):
        def on_broken_pipe(self) -> None:
            raise BrokenPipeError

    return Answering(emoji=False)


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


def show_export(export: Export | FrontExport, output: Path | None, *, as_json: bool) -> None:
    """Write the text of an export into a file or to stdout, and report it: to stderr beside the text."""
    if output is not None:
        export.write(output)
    if as_json:
        print_json(export.results() | ({"text": export.text} if output is None else {"file": str(output)}))
    elif output is None:
        print(export.text, end="")
        print(export, file=sys.stderr)
    else:
        show(str(export))


def number(value: float, size: float, form: str = ".10g") -> str:
    """A number in readable form: rounding errors relative to its kind's size become 0.

    Examples
    --------
    >>> number(-6.77e-16, size=5.528), number(1.5, size=2.0)
    ('0', '1.5')
    """
    return format(0.0 if abs(value) <= VALUE_ROUNDING * size < inf else value, form)


def progress() -> Console:
    """The stream for progress bars, so that stdout has the answer alone."""
    from rich.console import Console

    return Console(stderr=True)


@contextmanager
def busy(text: str) -> Iterator[None]:
    """Show the current step while a terminal displays the output."""
    console = progress()
    if console.is_terminal:
        from optlaws.shown.steps import without_bars

        with console.status(text), without_bars():
            yield
    else:
        yield
