"""How commands answer: tables and lines for a person, one JSON value for a program."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

    import optlaws


def print_json(data: object) -> None:
    """Print one line of JSON; it has no infinity, so what has no bound is null."""
    import msgspec

    line = msgspec.json.format(msgspec.json.encode(data, enc_hook=_plain), indent=0)  # one line, blanks between items
    print(line.decode())  # noqa: T201


def _plain(value: Any) -> object:  # noqa: ANN401 - a number of numpy
    return value.item()


def table(*headings: str) -> Table:
    """A table without lines; one without headings tells facts by their names."""
    from rich.table import Table

    return Table(*headings, show_header=bool(headings), box=None, pad_edge=False)


def show(*parts: Table | str) -> None:
    """Print tables as wide as the terminal, and text as it is."""
    from rich.console import Console

    console = Console()
    for part in parts:
        if isinstance(part, str):
            console.print(part, markup=False, highlight=False, soft_wrap=True)
        else:
            console.print(part)


def progress() -> Console:
    """Where progress is shown, so that stdout holds the answer alone."""
    from rich.console import Console

    return Console(stderr=True)


@contextmanager
def busy(text: str) -> Iterator[None]:
    """Say what is under way while someone watches."""
    console = progress()
    if console.is_terminal:
        with console.status(text):
            yield
    else:
        yield


def constants_table(constants: optlaws.Constants) -> Table:
    """Constants with their places."""
    found = table("constant", "value", "at k")
    for name in ("B", "C", "D", "J"):
        peak: Any = getattr(constants, name)
        found.add_row(name, f"{peak.value:.10g}", f"{peak.k:.6g}")
    found.add_row("RMS of c", f"{constants.rms_c:.10g}", "")
    return found
