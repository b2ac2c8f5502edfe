"""Items of the ledger: what a paper prints, and what is declared of it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec

from optlaws import InputError, catalogue, results
from optlaws.results import unknown_key

Text = Annotated[str, msgspec.Meta(min_length=1)]
Kind = Literal["formula", "number", "cell", "figure", "claim", "procedure"]
Confidence = Literal["certain", "likely", "inference"]
Argument = float | str | list[float | str]
#: the data of cells that are no csv file
CATALOGUE = "catalogue"


class Verdict(StrEnum):
    """What is said of an item once it has been computed again.

    Examples
    --------
    >>> Verdict("on the paper's grid")
    <Verdict.ON_GRID: "on the paper's grid">
    """

    REPRODUCED = "reproduced to its digits"
    ON_GRID = "on the paper's grid"
    PERCENT = "to p percent"
    MISPRINT = "misprint"
    MISREAD = "misread"
    AGREES = "agrees"
    CONFIRMED = "confirmed"
    CONTRADICTED = "contradicted"
    UNDECIDABLE = "undecidable"


_OF_NUMBERS = {
    Verdict.REPRODUCED,
    Verdict.ON_GRID,
    Verdict.PERCENT,
    Verdict.MISPRINT,
    Verdict.MISREAD,
    Verdict.CONTRADICTED,
    Verdict.UNDECIDABLE,
}
_OF_CLAIMS = {Verdict.CONFIRMED, Verdict.CONTRADICTED, Verdict.UNDECIDABLE}
#: what can be said of each kind
VERDICTS: Mapping[str, frozenset[Verdict]] = {
    "formula": frozenset({Verdict.AGREES, Verdict.MISPRINT, Verdict.MISREAD, Verdict.UNDECIDABLE}),
    "number": frozenset(_OF_NUMBERS),
    "cell": frozenset(_OF_NUMBERS),
    "figure": frozenset({Verdict.AGREES, Verdict.UNDECIDABLE}),
    "claim": frozenset(_OF_CLAIMS),
    "procedure": frozenset(_OF_CLAIMS),
}
#: what each verdict must come with
_NEEDS: Mapping[Verdict, tuple[str, ...]] = {
    Verdict.PERCENT: ("within",),
    Verdict.MISPRINT: ("means", "reason"),
    Verdict.MISREAD: ("as_read", "reason"),
    Verdict.CONTRADICTED: ("reason",),
    Verdict.UNDECIDABLE: ("lost",),
}


class Item(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """One printed number, formula, figure, claim or procedure.

    `printed` is what stands in print, `as_read` what the scan shows where that is something else, and `means` what a
    misprint should read. `compute` names a computation of `computing`; a figure names the job, the file and the curves
    that show it instead. `within` is in percent; of a formula whose series is cut it is what the rest may be worth.
    `source` is where it is printed if that is not the paper's.
    """

    id: Text
    kind: Kind
    printed: Text
    verdict: Verdict
    as_read: str = ""
    compute: str = ""
    arguments: dict[str, Argument] = {}
    means: str = ""
    within: Annotated[float, msgspec.Meta(ge=0)] = 0.0
    reason: str = ""
    confidence: Confidence = "certain"
    lost: str = ""
    job: str = ""
    file: str = ""
    curves: list[str] = []
    source: str = ""


class Changed(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """What is declared of one cell otherwise than of its table; `printed` where the data are mended."""

    verdict: Verdict
    printed: str = ""
    as_read: str = ""
    means: str = ""
    within: Annotated[float, msgspec.Meta(ge=0)] = 0.0
    reason: str = ""
    confidence: Confidence = "certain"
    lost: str = ""


class Cells(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """A printed table: an item for each row of its data, whose columns stand in braces in `id` and `arguments`.

    `data` is a csv file, or "catalogue" for what its laws' entries say is published, with the columns law, by, constant
    and printed. With `each` the column has several numbers, each is an item, and {i} counts them from 0. Cells with
    another verdict than the table's stand in `but`; those that only differ in it in `reproduced`, `on_grid`, `percent`
    and `contradicted`.
    """

    id: Text
    data: Text
    printed: Text
    compute: Text
    arguments: dict[str, Argument] = {}
    where: dict[str, str] = {}
    each: bool = False
    verdict: Verdict = Verdict.REPRODUCED
    reproduced: list[str] = []
    on_grid: list[str] = []
    percent: dict[str, float] = {}
    contradicted: list[str] = []
    reason: str = ""
    but: dict[str, Changed] = {}

    def changed(self) -> dict[str, Changed]:
        """What is declared of single cells."""
        plain = {name: Changed(verdict=Verdict.REPRODUCED) for name in self.reproduced}
        plain |= {name: Changed(verdict=Verdict.ON_GRID) for name in self.on_grid}
        off = {
            name: Changed(verdict=Verdict.PERCENT, within=within, reason=self.reason)
            for name, within in self.percent.items()
        }
        plain |= {name: Changed(verdict=Verdict.CONTRADICTED, reason=self.reason) for name in self.contradicted}
        return plain | off | self.but


class Paper(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """The ledger of one paper: items one by one, and tables of cells."""

    title: Text
    source: Text
    item: list[Item] = []
    cells: list[Cells] = []


def read(file: Path) -> tuple[Paper, list[Item]]:
    """A paper and all its items, the cells of its tables among them, in the file's order.

    Raises
    ------
    InputError
        If the file cannot be read, has unknown entries, an item twice, or one that lacks what its verdict needs.
    """
    paper = results.read(file, Paper)
    items = [*paper.item, *(item for cells in paper.cells for item in _expanded(cells, file))]
    twice = [name for name, count in Counter(item.id for item in items).items() if count > 1]
    if twice:
        raise InputError(f"{file}: the item {twice[0]} is there twice")
    for item in items:
        _check(item, f"{file}: item {item.id}")
    return paper, items


def _expanded(cells: Cells, file: Path) -> Iterator[Item]:
    left = cells.changed()
    for row in _rows(file.parent / cells.data, cells):
        name = _filled(cells.id, row, file)
        declared = msgspec.structs.asdict(left.pop(name, Changed(verdict=cells.verdict)))
        declared["printed"] = declared["printed"] or row[cells.printed]
        arguments = {key: _argument(value, row, file) for key, value in cells.arguments.items()}
        yield Item(id=name, kind="cell", compute=cells.compute, arguments=arguments, **declared)
    if left:
        known = [_filled(cells.id, row, file) for row in _rows(file.parent / cells.data, cells)]
        raise InputError(f"{file}, cells {cells.id}: {unknown_key(next(iter(left)), known, 'cell')}")


def _rows(data: Path, cells: Cells) -> Sequence[Mapping[str, str]]:
    rows = _of_catalogue() if cells.data == CATALOGUE else results.rows(data)
    columns = rows[0] if rows else {}
    for column in (cells.printed, *cells.where):
        if column not in columns:
            raise InputError(f"{data}: {unknown_key(column, columns, 'column')}")
    chosen = [row for row in rows if all(row[column] == value for column, value in cells.where.items())]
    if not cells.each:
        return chosen
    parts = [(row, i, part) for row in chosen for i, part in enumerate(row[cells.printed].split())]
    return [{**row, "i": str(i), cells.printed: part} for row, i, part in parts]


def _of_catalogue() -> list[Mapping[str, str]]:
    """The constants that others have published of the laws of the catalogue."""
    return [
        {"law": entry.name, "by": published.by, "constant": constant, "printed": text}
        for entry in catalogue.values()
        for published in entry.published
        for constant, text in published.printed
    ]


def _argument(value: Argument, row: Mapping[str, str], file: Path) -> Argument:
    return _filled(value, row, file) if isinstance(value, str) else value


def _filled(text: str, row: Mapping[str, Any], file: Path) -> str:
    try:
        return text.format_map(row)
    except (KeyError, ValueError, IndexError, AttributeError):
        raise InputError(f"{file}: {text} must name columns in braces; they are {', '.join(row)}") from None


def _check(item: Item, where: str) -> None:
    if item.verdict not in VERDICTS[item.kind]:
        may = ", ".join(sorted(VERDICTS[item.kind]))
        raise InputError(f"{where}: a {item.kind} cannot be {item.verdict!s}; it can be {may}")
    needs = list(_NEEDS.get(item.verdict, ()))
    if item.verdict is not Verdict.UNDECIDABLE:
        needs += ["job", "file"] if item.kind == "figure" else ["compute"]
    for name in needs:
        if not getattr(item, name):
            raise InputError(f"{where}: a {item.kind} that is {item.verdict!s} needs the entry {name}")
