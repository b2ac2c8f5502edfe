"""Tables, pictures and pages of results, in one style, for scripts over the public names of optlaws."""

from __future__ import annotations

import json
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias, TypeVar

import msgspec

from optlaws.echo import unknown_key
from optlaws.errors import InputError, not_installed
from optlaws.files import reading, tables, writing
from optlaws.files.printed import MISPRINT, ON_GRID, REPRODUCED, PrintedNumber, compared, number, rows, same_digits
from optlaws.files.problem_file import Text, convert
from optlaws.files.tables import Cell
from optlaws.files.writing import MARK
from optlaws.kept import kept_property

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from optlaws.shown.report import Report, Section
    from optlaws.shown.summary import Row

__all__ = [
    "MARK",
    "MISPRINT",
    "ON_GRID",
    "REPRODUCED",
    "Cell",
    "Entries",
    "Page",
    "PrintedNumber",
    "Results",
    "compared",
    "number",
    "read",
    "rows",
    "same_digits",
    "unknown_key",
]


class Page:
    """A page that is written from its top to its end.

    Examples
    --------
    >>> print(Page("Laws").text("Two of them.").table(["law", "C"], [["K", 4.93], ["Co", 6.28]]), end="")
    # Laws
    <BLANKLINE>
    <!-- made by optlaws -->
    <BLANKLINE>
    Two of them.
    <BLANKLINE>
    | law | C    |
    |-----|------|
    | K   | 4.93 |
    | Co  | 6.28 |
    """

    def __init__(self, title: str, results: Results | None = None) -> None:
        self._parts = [f"# {title}\n", f"<!-- {MARK} -->\n"]
        self._results = results

    def heading(self, text: str) -> Page:
        """A heading below the title."""
        return self._add(f"## {text}")

    def text(self, text: str) -> Page:
        """A paragraph or several; none if the text is blank."""
        return self._add(text.strip()) if text.strip() else self

    def figure(self, name: str, caption: str) -> Page:
        """The picture `name`.svg beside the page."""
        return self._add(f"![{caption}]({name}.svg)")

    def picture(self, name: str, caption: str, draw: Callable[[], Figure], of: str = "a picture") -> Page:
        """A picture `name`.svg, which is drawn into the results of the page; none without matplotlib."""
        if self._results is None or self._results.draw(name, draw, of):
            self.figure(name, caption)
        return self

    def table(self, headings: Sequence[str], rows: Sequence[Sequence[Cell]], *, digits: int = 7) -> Page:
        """A table with aligned columns and a given number of digits."""
        self._parts.append(tables.to_markdown(headings, rows, digits=digits))
        return self

    def facts(self, facts: Iterable[Row], *, digits: int = 6, places: str = "") -> Page:
        """A table of facts; with their places in a unit if it is given, and with notes where there are some."""
        shown = (row.on_page() for row in facts)
        rows = [(row.name, row.text(digits), row.unit, row.place, row.note) for row in shown]
        columns = [0, 1, 2, *([3] if places else []), *([4] if any(row[4] for row in rows) else [])]
        headings = ("what", "value", "unit", f"at, {places}", "note")
        return self.table([headings[i] for i in columns], [[row[i] for i in columns] for row in rows], digits=digits)

    def report(self, report: Report) -> Page:
        """The tables of a report, and its facts but those that are columns of a table."""
        for table in report.tables:
            self.table(*table)
        columns = {heading.partition(",")[0] for table in report.tables for heading in table.headings}
        return self.facts(row for row in report.facts if row.name not in columns)

    def section(self, section: Section) -> Page:
        """A section of a report: its heading, picture, text, its table or else its facts, and its note."""
        if section.heading:
            self.heading(section.heading)
        if section.figure is not None:
            if section.draw is not None and self._results is not None:
                self.picture(*section.figure, partial(section.draw, self._results.title))
            else:
                self.figure(*section.figure)
        self.text(section.text)
        if section.table is not None:
            self.table(*section.table, digits=section.digits)
        elif section.facts:
            self.facts(section.facts, digits=section.digits)
        return self.text(section.note)

    def _add(self, line: str) -> Page:
        self._parts.append(f"{line}\n")
        return self

    @property
    def lines(self) -> list[str]:
        """Its lines for people: without remarks on the file."""
        return [line for line in str(self).splitlines() if not line.startswith("<!--")]

    def __str__(self) -> str:
        return "\n".join(self._parts)


_Content: TypeAlias = "str | Page | Figure | Callable[[Path], Path]"


class _File(NamedTuple):
    """What a file is of, and its text, its figure, or the function that writes it."""

    of: str
    content: _Content


Struct = TypeVar("Struct", bound=msgspec.Struct)
Spec = TypeVar("Spec", bound="Entries")


class Entries(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """The entries that problem files of all scripts have; a subclass adds a script's own entries.

    Attributes
    ----------
    title
        Heading of the results.
    text
        What stands below it.
    job
        "script", in the files that come with optlaws.

    Examples
    --------
    >>> class Peaks(Entries):
    ...     laws: list[str]
    >>> Peaks(title="Peaks", laws=["cycloidal"]).laws
    ['cycloidal']
    """

    title: Text
    text: str = ""
    job: str = "script"


def read(file: Path, entries: type[Struct]) -> Struct:
    """Entries of a TOML file as a typed value.

    Parameters
    ----------
    file
        The file.
    entries
        A subclass of `msgspec.Struct`.

    Raises
    ------
    InputError
        If the file cannot be read, or an entry is unknown (the nearest right one is named), missing or of another type.
    """
    return convert(reading.toml(file), entries, file)


class Results:
    r"""Tables, pictures and pages that a script computes from its problem file, written together at its end.

    Parameters
    ----------
    file
        The problem file, or the script beside it.
    digits
        How many digits of its numbers mean something: a file that differs by less is left as it is.

    Examples
    --------
    >>> from pathlib import Path
    >>> _ = Path("peaks.toml").write_text('title = "Peaks"\n', "utf-8")
    >>> results = Results("peaks.py")
    >>> results.read(Entries).title
    'Peaks'
    >>> results.table("peaks", ["law", "C"], [["cycloidal", 6.283185]])
    >>> [file.as_posix() for file in results.write()]
    ['results/peaks/peaks.csv']
    """

    def __init__(self, file: Path | str, *, digits: int | None = None) -> None:
        given = Path(file)
        self.file = given.with_suffix(".toml") if given.suffix == ".py" else given
        self.digits = digits
        self.title = given.stem
        self.stopped = ""  #: what was stopped by Ctrl-C, so that the results are not all of them
        self._files: dict[str, _File] = {}

    @property
    def about(self) -> str:
        """Title and file, as in the first line of every table."""
        return f"{self.title}; from {self.file.name}"

    @kept_property
    def entries(self) -> dict[str, Any]:
        """All entries of the problem file, unchanged."""
        return reading.toml(self.file)

    def read(self, entries: type[Spec]) -> Spec:
        """Entries of the problem file as a typed value; the title becomes the title of the results."""
        spec = convert(self.entries, entries, self.file)
        self.title = spec.title
        return spec

    def table(
        self,
        name: str,
        headings: Sequence[str],
        rows: Sequence[Sequence[Cell]],
        note: str = "",
        of: str = "a result",
    ) -> None:
        """A table `name`.csv; its first line describes its contents, with the note."""
        about = f"{self.about}; {note}" if note else self.about
        self.text(f"{name}.csv", tables.to_csv(headings, rows, about=about), of)

    def page(self, name: str, title: str | None = None) -> Page:
        """A page `name`.md, to be filled, under the title of the problem file or another."""
        page = Page(self.title if title is None else title, self)
        self._put(f"{name}.md", page, "the page")
        return page

    def data(self, name: str, content: Mapping[str, Any]) -> None:
        """Data as JSON, after an entry that describes them."""
        self.text(name, json.dumps({"about": f"{self.about}; {MARK}", **content}, indent=1) + "\n")

    def records(self, name: str, entry: str, records: Mapping[str, Any] | Sequence[Any]) -> None:
        """Data as JSON with a single entry of many records, each on a line of its own."""
        if isinstance(records, Mapping):
            ends, lines = "{}", [f"{json.dumps(key)}: {json.dumps(record)}" for key, record in records.items()]
        else:
            ends, lines = "[]", list(map(json.dumps, records))
        head = json.dumps({"about": f"{self.about}; {MARK}"})[:-1]
        self.text(name, f"{head}, {json.dumps(entry)}: {ends[0]}\n" + ",\n".join(lines) + f"\n{ends[1]}}}\n")

    def text(self, name: str, content: str | Page, of: str = "a result") -> None:
        """A file of another format; its text must hold the mark "made by optlaws" at the end of a line or an entry."""
        self._put(name, content, of)

    def picture(self, name: str, figure: Figure, of: str = "a picture") -> None:
        """A picture `name`.svg."""
        self._put(f"{name}.svg", figure, of)

    def draw(self, name: str, draw: Callable[[], Figure], of: str = "a picture") -> bool:
        """A picture `name`.svg that a function draws; False and a warning without matplotlib."""
        if find_spec("matplotlib") is None:
            missing = not_installed("the results have no pictures: drawing needs matplotlib", "matplotlib")
            warnings.warn(str(missing), stacklevel=2)
            return False
        self.picture(name, draw(), of)
        return True

    def add(self, name: str, write: Callable[[Path], Path], of: str = "a file") -> None:
        """A file that a function writes to its place."""
        self._put(name, write, of)

    def _put(self, name: str, content: _Content, of: str) -> None:
        """Keep a file under its name, which no other has on any file system.

        Raises
        ------
        InputError
            If another file has the name: `of` says what each of the two is.
        """
        twin = next((other for other in self._files if other.casefold() == name.casefold()), None)
        if twin is not None:
            raise InputError(
                f"{self.file}: {of}: another file is called {twin}, {self._files[twin].of}: give each a name of its own"
            )
        self._files[name] = _File(of, content)

    def pictures(self) -> dict[str, str]:
        """The pictures as svg, by the names of their files."""
        from optlaws.plots.style import rendered

        drawn: dict[str, Any] = {name: file.content for name, file in self._files.items()}
        return {name: rendered(each, "svg").decode() for name, each in drawn.items() if hasattr(each, "savefig")}

    def figure(self, name: str) -> Figure:
        """The figure of a picture; an error without matplotlib."""
        if f"{name}.svg" not in self._files:
            raise not_installed("drawing needs matplotlib", "matplotlib")
        figure: Figure = self._files[f"{name}.svg"].content  # type: ignore[assignment] # of a picture
        return figure

    def write(self, out: Path | None = None, *, force: bool = False) -> list[Path]:
        """Write the results into a folder, `results/NAME` in the current folder by default, and return the files.

        Files with the same contents, but for rounding, are left unchanged.

        Raises
        ------
        InputError
            If a file is there with other contents, and these are not to be replaced (`force`): then none is written.
        """
        from tempfile import TemporaryDirectory

        folder = Path("results", self.file.stem) if out is None else out
        texts = {name: str(file.content) for name, file in self._files.items() if isinstance(file.content, str | Page)}
        contents = [(folder / name, text.encode(), False) for name, text in (texts | self.pictures()).items()]
        with TemporaryDirectory() as place:
            files = [file.content(Path(place) / name) for name, file in self._files.items() if callable(file.content)]
            contents += [(folder / file.name, file.read_bytes(), True) for file in files]
        writing.check_free(contents, digits=self.digits, force=force)
        with writing.all_or_none():
            return [
                writing.write(file, data, digits=None if exact else self.digits, exact=exact, force=force)
                for file, data, exact in contents
            ]
