"""The table of a study: its rows in the order of the points, as an Arrow table and a Parquet file."""

from __future__ import annotations

import hashlib
import json
import os
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from functools import lru_cache
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np

from optlaws.errors import InputError
from optlaws.files import writing
from optlaws.files.writing import MARK
from optlaws.studies.points.axes import Axis, kind_of
from optlaws.studies.points.points import Points
from optlaws.studies.solving.solving import Row
from optlaws.studies.store.directory import StudyDirectory
from optlaws.studies.store.journal import Journal, StoreFailure
from optlaws.synthesis.problem.fields import Kind

if TYPE_CHECKING:
    import pyarrow as pa

NUMBERS = ("objective", "lower_bound", "gap", "limit", "B", "C", "D", "J", "rms_c", "seconds")
OTHERS = ("index", "key", "status", "iterations", "law", "error")
_COLUMNS = {Kind.WHOLE: "whole", Kind.TEXT: "text", Kind.BASIS: "text", Kind.SWITCH: "switch"}
#: rows of one group in the Parquet file
GROUP = 4096
#: rows of the journal that are in memory at a time
_IN_MEMORY = 1024
_NONE = b"null"


class DamagedTable(InputError):  # noqa: N818 - as SolverFailure
    """The table of a study is not what was written.

    Examples
    --------
    >>> from pathlib import Path
    >>> raise DamagedTable(Path("rows.parquet"), "it is empty")
    Traceback (most recent call last):
    optlaws.studies.store.table.DamagedTable: rows.parquet is damaged: it is empty; put a whole copy in its place, or
    remove it and rows.sha256 and run the same study again: its points are then solved anew
    """

    def __init__(self, file: Path, reason: str) -> None:
        super().__init__(
            f"{file} is damaged: {reason}; put a whole copy in its place, or remove it and rows.sha256 "
            "and run the same study again: its points are then solved anew"
        )


def column(name: str) -> str:
    """The column of an entry that varies; what was asked of B is not what the law's B came out as.

    Examples
    --------
    >>> column("B"), column("order")
    ('B asked', 'order')
    """
    return f"{name} asked" if name in (*NUMBERS, *OTHERS) else name


class StoredRow(msgspec.Struct):
    """A row of the journal, whose law stays the text that it is."""

    index: int
    key: str
    inputs: dict[str, Any]
    status: str
    objective: float | None
    lower_bound: float | None
    gap: float | None
    limit: float | None
    B: float | None
    C: float | None
    D: float | None
    J: float | None
    rms_c: float | None
    iterations: int | None
    seconds: float
    law: msgspec.Raw
    error: str | None


_stored = msgspec.json.Decoder(StoredRow)


def rows_in_order(journal: Journal, points: Points) -> Iterator[StoredRow]:
    """The rows that a journal has, in the order of the points; a few chunks are in memory at a time."""

    @lru_cache(maxsize=max(3, _IN_MEMORY // points.chunk))
    def chunk(number: int) -> dict[int, StoredRow]:
        return {row.index: row for row in map(_stored.decode, journal.rows(number))}

    for begin in range(0, len(points), GROUP):
        indices = np.arange(begin, min(begin + GROUP, len(points)))
        for index, number in zip(indices.tolist(), points.chunks_of(indices).tolist(), strict=True):
            if number in journal.done:
                yield chunk(number)[index]


def compact(directory: StudyDirectory, points: Points) -> None:
    """Write the Parquet file of a finished study, whole or not at all; without pyarrow the journal stays the store."""
    try:
        import pyarrow.parquet as pq
    except ImportError:
        return
    shape = schema(points, about={"optlaws": directory.about.read_bytes()})
    copy = directory.table.with_suffix(".unfinished")
    journal = Journal(directory.journal)
    try:
        with pq.ParquetWriter(copy, shape, compression="zstd", write_page_checksum=True) as writer:
            rows = rows_in_order(journal, points)
            while some := list(islice(rows, GROUP)):
                writer.write_table(arrow(some, shape))
        with copy.open("rb+") as stream:
            os.fsync(stream.fileno())
        # read again before the journal goes
        check_rows(copy, len(points), journal.counts)
        writing.write(directory.checksum, f"{digest(copy)}  {directory.table.name}\n# {MARK}\n")
        copy.replace(directory.table)
    except OSError as error:
        copy.unlink(missing_ok=True)
        raise StoreFailure(
            f"cannot write {directory.table}: {error.strerror or error}; every row is safe in {directory.journal}: "
            "make room and run the same command again"
        ) from error


def check(directory: StudyDirectory, points: int) -> None:
    """Refuse a table that is not what was written: by its checksum, or one without by reading all of it.

    Raises
    ------
    DamagedTable
        If it is another file, or no table of so many rows.
    """
    try:
        stated = directory.checksum.read_text(encoding="utf-8").split()[:1]
    except FileNotFoundError:
        stated = []
    except (OSError, ValueError) as error:
        raise DamagedTable(directory.checksum, f"it cannot be read: {error}") from None
    try:
        same = not stated or stated[0] == digest(directory.table)
    except OSError as error:
        raise DamagedTable(directory.table, f"it cannot be read: {error.strerror}") from None
    if not same:
        raise DamagedTable(directory.table, f"its content is not what {directory.checksum.name} says was written")
    if not stated:
        # without pyarrow there is nothing to read it with, which whoever reads it is told
        with suppress(ImportError):
            check_rows(directory.table, points)


def check_rows(file: Path, points: int, counts: Mapping[str, int] | None = None) -> None:
    """Read a table and see that it has every point, in order, and as many of each status as were counted.

    Raises
    ------
    DamagedTable
        Saying what is not right.
    """
    import pyarrow as pa
    import pyarrow.parquet as pq

    try:
        with pq.ParquetFile(file, page_checksum_verification=True) as table:
            missing = [name for name in ("index", "key", "status", "law", "error") if name not in table.schema.names]
            if missing:
                raise DamagedTable(file, f"it has no column {missing[0]!r}")
            counted: Counter[str] = Counter()
            count = 0
            for batch in table.iter_batches(batch_size=GROUP):
                if batch["index"].to_pylist() != list(range(count, count + len(batch))):
                    raise DamagedTable(file, f"its rows from {count} on are not in the order of the points")
                counted.update(batch["status"].to_pylist())
                count += len(batch)
    except (pa.ArrowException, OSError, ValueError, TypeError) as error:
        if isinstance(error, DamagedTable):
            raise
        raise DamagedTable(file, f"it cannot be read: {' '.join(str(error).split())[:200]}") from None
    if count != points or (counts is not None and counted != counts):
        raise DamagedTable(file, f"it has {count} rows of {points} points, {dict(counted)}")


def digest(file: Path) -> str:
    """The SHA-256 of a file."""
    with file.open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()


def schema(points: Points, about: Mapping[str, bytes] | None = None) -> pa.Schema:
    """The columns: what was asked, what came out, and the law as JSON that `MotionLaw.from_json` reads."""
    import pyarrow as pa

    kinds = {"number": pa.float64(), "whole": pa.int64(), "text": pa.string(), "switch": pa.bool_()}
    fields = [("index", pa.int64()), ("key", pa.string())]
    fields += [(column(name), kinds[kind(axis, name)]) for axis in points.axes for name in axis.names]
    fields += [("status", pa.string()), *((name, pa.float64()) for name in NUMBERS)]
    fields += [("iterations", pa.int64()), ("law", pa.string()), ("error", pa.string())]
    return pa.schema(fields, metadata={**(about or {}), "made by": MARK})


def kind(axis: Axis, name: str) -> str:
    """What the values of an entry are; numbers among texts, or pairs, are text too: JSON."""
    values = axis.columns[axis.names.index(name)]
    known = _COLUMNS.get(kind_of(name))
    if known is not None:
        return known
    if isinstance(values, list) and not all(isinstance(value, float) for value in values):
        return "text"
    return "number"


def arrow(rows: Sequence[StoredRow], shape: pa.Schema) -> pa.Table:
    """Rows as an Arrow table."""
    import pyarrow as pa

    inputs = {column(name): name for name in (rows[0].inputs if rows else ())}
    columns: dict[str, list[Any]] = {}
    for name in shape.names:
        if name in inputs:
            asked = inputs[name]
            columns[name] = [row.inputs[asked] for row in rows]
            if str(shape.field(name).type) == "string":
                columns[name] = [value if isinstance(value, str) else json.dumps(value) for value in columns[name]]
        elif name == "law":
            columns[name] = [None if row.law == _NONE else bytes(row.law).decode() for row in rows]
        else:
            columns[name] = [getattr(row, name) for row in rows]
    return pa.table(columns, schema=shape)


def plain(row: StoredRow) -> Row:
    """A row of the journal as plain data."""
    return {**msgspec.structs.asdict(row), "law": msgspec.json.decode(row.law)}


def unflat(row: Row, points: Points) -> Row:
    """A row of the Parquet file as the journal had it."""
    kept = {name: value for name, value in row.items() if name in (*NUMBERS, *OTHERS)}
    law = None if row["law"] is None else json.loads(row["law"])
    return {**kept, "inputs": points.inputs(row["index"]), "law": law}
