"""The table of a study: its rows in the order of the points, as an Arrow table and a Parquet file."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Iterator, Mapping
from functools import lru_cache
from itertools import islice
from typing import TYPE_CHECKING

import msgspec

from optlaws.errors import InputError
from optlaws.export.files import MARK
from optlaws.studies.sweeps.axes import SWITCHES, TEXTS, WHOLE, Axis
from optlaws.studies.sweeps.directory import StudyDirectory
from optlaws.studies.sweeps.journal import Journal, StoreFailure
from optlaws.studies.sweeps.points import Points
from optlaws.studies.sweeps.solving import Row

if TYPE_CHECKING:
    import pyarrow as pa

NUMBERS = ("objective", "lower_bound", "gap", "limit", "B", "C", "D", "J", "rms_c", "seconds")
OTHERS = ("index", "key", "status", "iterations", "law", "error")
#: rows of one group in the Parquet file
GROUP = 4096


class NotInstalled(InputError, ImportError):  # noqa: N818 - as SolverFailure
    """A library is missing that an extra of optlaws brings.

    Examples
    --------
    >>> raise NotInstalled("to_pandas needs pandas: pip install optlaws[studies]")
    Traceback (most recent call last):
    optlaws.studies.sweeps.table.NotInstalled: to_pandas needs pandas: pip install optlaws[studies]
    """


def column(name: str) -> str:
    """The column of an entry that varies; what was asked of B is not what the law's B came out as.

    Examples
    --------
    >>> column("B"), column("order")
    ('B asked', 'order')
    """
    return f"{name} asked" if name in (*NUMBERS, *OTHERS) else name


def rows_in_order(journal: Journal, points: Points) -> Iterator[Row]:
    """The rows that a journal has, in the order of the points; a few chunks are in memory at a time."""

    @lru_cache(maxsize=16)
    def chunk(number: int) -> dict[int, Row]:
        return {row["index"]: row for row in map(msgspec.json.decode, journal.rows(number))}

    for index in range(len(points)):
        number = points.chunk_of(index)
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
        with pq.ParquetWriter(copy, shape, compression="zstd") as writer:
            rows = rows_in_order(journal, points)
            while some := list(islice(rows, GROUP)):
                writer.write_table(arrow(some, shape))
        with copy.open("rb+") as stream:
            os.fsync(stream.fileno())
        copy.replace(directory.table)
    except OSError as error:
        copy.unlink(missing_ok=True)
        raise StoreFailure(
            f"cannot write {directory.table}: {error.strerror or error}; every row is safe in {directory.journal}: "
            "make room and run the same command again"
        ) from error


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
    if name in WHOLE:
        return "whole"
    if name in TEXTS:
        return "text"
    if name in SWITCHES:
        return "switch"
    if isinstance(values, list) and not all(isinstance(value, float) for value in values):
        return "text"
    return "number"


def arrow(rows: Iterable[Row], shape: pa.Schema) -> pa.Table:
    """Rows as an Arrow table."""
    import pyarrow as pa

    flat = [_flat(row, shape) for row in rows]
    return pa.table({name: [row.get(name) for row in flat] for name in shape.names}, schema=shape)


def _flat(row: Row, shape: pa.Schema) -> Row:
    found = {name: value for name, value in row.items() if name not in {"inputs", "law"}}
    for name, value in row["inputs"].items():
        plain = isinstance(value, str) or str(shape.field(column(name)).type) != "string"
        found[column(name)] = value if plain else json.dumps(value)
    return found | {"law": None if row["law"] is None else json.dumps(row["law"])}


def unflat(row: Row, points: Points) -> Row:
    """A row of the Parquet file as the journal had it."""
    kept = {name: value for name, value in row.items() if name in (*NUMBERS, *OTHERS)}
    law = None if row["law"] is None else json.loads(row["law"])
    return {**kept, "inputs": points.inputs(row["index"]), "law": law}
