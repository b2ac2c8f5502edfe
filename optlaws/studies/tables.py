"""The table of a study: its rows in the order of the points, for Arrow, Parquet and xarray."""

from __future__ import annotations

import hashlib
import json
import os
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
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
from optlaws.studies.chunk import StudyRow
from optlaws.studies.journal import Journal, StoreFailure
from optlaws.studies.points import StudyPoints, kind_of
from optlaws.studies.store import StudyDirectory
from optlaws.synthesis.problem.fields import Kind

if TYPE_CHECKING:
    import pyarrow as pa
    import xarray as xr

NUMBERS = ("objective", "lower_bound", "gap", "limit", "B", "C", "D", "J", "rms_c", "seconds")
OTHERS = ("index", "key", "status", "iterations", "law", "error")
_COLUMNS = {Kind.WHOLE: "int64", Kind.TEXT: "string", Kind.BASIS: "string", Kind.SWITCH: "bool"}
#: rows of one group in the Parquet file
GROUP = 4096
#: rows of the journal that are in memory at a time
_IN_MEMORY = 1024
_NONE = b"null"
_decode = msgspec.json.Decoder(StudyRow).decode


class DamagedTable(InputError):  # noqa: N818 - as SolverFailure
    """The table of a study is not what was written.

    Examples
    --------
    >>> from pathlib import Path
    >>> raise DamagedTable(Path("rows.parquet"), "it is empty")
    Traceback (most recent call last):
    optlaws.studies.tables.DamagedTable: rows.parquet is damaged: it is empty; put a whole copy in its place, or
    remove it and rows.sha256 and run the same study again: its points are then solved anew
    """

    def __init__(self, file: Path, reason: str) -> None:
        super().__init__(
            f"{file} is damaged: {reason}; put a whole copy in its place, or remove it and rows.sha256 "
            "and run the same study again: its points are then solved anew"
        )


def rows_of_chunk(journal: Journal, number: int) -> dict[int, StudyRow]:
    """The rows of a chunk that a journal has, by their indices."""
    return {row.index: row for row in map(_decode, journal.rows(number))}


def rows_in_order(journal: Journal, points: StudyPoints) -> Iterator[StudyRow]:
    """The rows that a journal has, in the order of the points; a few chunks are in memory at a time."""

    @lru_cache(maxsize=max(3, _IN_MEMORY // points.chunk))
    def chunk(number: int) -> dict[int, StudyRow]:
        return rows_of_chunk(journal, number)

    for begin in range(0, len(points), GROUP):
        indices = np.arange(begin, min(begin + GROUP, len(points)))
        for index, number in zip(indices.tolist(), points.chunks_of(indices).tolist(), strict=True):
            if number in journal.done:
                yield chunk(number)[index]


def row_of(line: Mapping[str, Any], points: StudyPoints) -> StudyRow:
    """The row that a line of the Parquet file was."""
    law = msgspec.Raw((line["law"] or "null").encode())
    results = {name: line[name] for name in (*NUMBERS, *OTHERS) if name in line}
    return StudyRow(**{**results, "inputs": points.inputs(line["index"]), "law": law})


def compact(directory: StudyDirectory, points: StudyPoints) -> None:
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
            while group := list(islice(rows, GROUP)):
                writer.write_table(arrow(group, shape))
        with copy.open("rb+") as stream:
            os.fsync(stream.fileno())
        # read again before the journal goes
        _check_rows(copy, len(points), journal.counts)
        writing.write(directory.checksum, f"{_digest(copy)}  {directory.table.name}\n# {MARK}\n")
        copy.replace(directory.table)
    except OSError as error:
        copy.unlink(missing_ok=True)
        raise StoreFailure(
            f"cannot write {directory.table}: {error.strerror or error}; every row is safe in {directory.journal}: "
            "make room and run the same command again"
        ) from error


def check(directory: StudyDirectory, points: int) -> None:
    """Refuse a table that is not what was written: by its checksum, or one without by reading all of it."""
    file = directory.checksum
    try:
        stated = file.read_text(encoding="utf-8").split()[:1] if file.exists() else []
        file = directory.table
        changed = bool(stated) and stated[0] != _digest(file)
    except (OSError, ValueError) as error:
        raise DamagedTable(file, f"it cannot be read: {getattr(error, 'strerror', error)}") from None
    if changed:
        raise DamagedTable(directory.table, f"its content is not what {directory.checksum.name} says was written")
    if not stated:
        # without pyarrow there is nothing to read it with, which whoever reads it is told
        with suppress(ImportError):
            _check_rows(directory.table, points)


def _check_rows(file: Path, points: int, counts: Mapping[str, int] | None = None) -> None:
    """Refuse a table without every point, in order, or without as many of each status as were counted."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    counted: Counter[str] = Counter()
    count = 0
    try:
        with pq.ParquetFile(file, page_checksum_verification=True) as table:
            missing = [name for name in ("index", "key", "status", "law", "error") if name not in table.schema.names]
            if missing:
                raise DamagedTable(file, f"it has no column {missing[0]!r}")
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


def _digest(file: Path) -> str:
    with file.open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()


def column(name: str) -> str:
    """The column of an entry that varies; what was asked of B is not what the law's B came out as.

    Examples
    --------
    >>> column("B"), column("order")
    ('B asked', 'order')
    """
    return f"{name} asked" if name in (*NUMBERS, *OTHERS) else name


def _kind(name: str, values: Sequence[Any]) -> str:
    """What the values of an entry are; numbers among texts, or pairs, are text too: JSON."""
    numbers = not isinstance(values, list) or all(isinstance(value, float) for value in values)
    return _COLUMNS.get(kind_of(name), "float64" if numbers else "string")


def _texts(values: Iterable[Any]) -> list[str]:
    return [value if isinstance(value, str) else json.dumps(value) for value in values]


def schema(points: StudyPoints, about: Mapping[str, bytes] | None = None) -> pa.Schema:
    """The columns: what was asked, what came out, and the law as JSON that `MotionLaw.from_json` reads."""
    import pyarrow as pa

    kinds = {"index": "int64", "key": "string"}
    kinds |= {column(name): _kind(name, values) for name, values in points.columns.items()}
    kinds |= {"status": "string", **dict.fromkeys(NUMBERS, "float64")}
    kinds |= {"iterations": "int64", "law": "string", "error": "string"}
    fields = [(name, pa.type_for_alias(kind)) for name, kind in kinds.items()]
    return pa.schema(fields, metadata={**(about or {}), "made by": MARK})


def arrow(rows: Sequence[StudyRow], shape: pa.Schema) -> pa.Table:
    """Rows as an Arrow table."""
    import pyarrow as pa

    inputs = {column(name): name for name in (rows[0].inputs if rows else ())}
    columns: dict[str, list[Any]] = {}
    for name in shape.names:
        if name in inputs:
            values = [row.inputs[inputs[name]] for row in rows]
            columns[name] = _texts(values) if shape.field(name).type == pa.string() else values
        elif name == "law":
            columns[name] = [None if row.law == _NONE else bytes(row.law).decode() for row in rows]
        else:
            columns[name] = [getattr(row, name) for row in rows]
    return pa.table(columns, schema=shape)


def dataset(rows: Iterable[StudyRow], points: StudyPoints, about: Mapping[str, Any]) -> xr.Dataset:
    """One dimension for each factor of the product; one variable for each number, and the status.

    What varies alone is a coordinate of its dimension; what varies together shares one, "together 1" or "sample 1".
    """
    import xarray as xr

    variables: dict[str, Any] = {name: np.full(len(points), np.nan) for name in NUMBERS}
    status = np.full(len(points), "", dtype=object)
    for row in rows:
        status[row.index] = row.status
        for name, values in variables.items():
            if (value := getattr(row, name)) is not None:
                values[row.index] = value
    dimensions = [column(axis.label) for axis in points.axes]
    coordinates = {
        column(name): (dimension, _texts(values) if _kind(name, values) == "string" else list(values))
        for axis, dimension in zip(points.axes, dimensions, strict=True)
        for name, values in axis.columns.items()
    }
    shaped = {
        name: (dimensions, values.reshape(points.shape)) for name, values in {**variables, "status": status}.items()
    }
    attributes = {name: json.dumps(value) if isinstance(value, dict) else value for name, value in about.items()}
    return xr.Dataset(shaped, coordinates, attributes)
