"""The rows of a study for Arrow and xarray: a row for each point, with its varied entries and its results."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np

from optlaws.entries.value_types import Switch, Text, Whole
from optlaws.files.reading import renamed_entries
from optlaws.files.writing import MARK
from optlaws.kept import former_name, kept_property
from optlaws.laws import MotionLaw
from optlaws.studies.points import StudyPoints, type_of
from optlaws.studies.specification import entries
from optlaws.synthesis import Problem, Status

if TYPE_CHECKING:
    import pyarrow as pa
    import xarray as xr

CONSTANTS = ("B", "C", "D", "J", "rms_c")
NUMBERS = ("objective", "lower_bound", "gap", "best_possible", *CONSTANTS, "seconds")
OTHERS = ("index", "key", "status", "iterations", "law", "error")
#: a law stays the JSON text that it is until it is read
NO_LAW = msgspec.Raw(b"null")
_COLUMNS = {Whole: "int64", Text: "string", Switch: "bool"}


class StudyPoint(msgspec.Struct, kw_only=True, omit_defaults=True, dict=True):
    """A row of a study, with its law and its problem.

    Attributes
    ----------
    index, key
        Its number in the study, and a hash of its problem.
    inputs
        What varies, at this point.
    problem
        The whole problem; InputError where the point describes none.
    status
        How far the law can be trusted or, where there is none, why; `error` has the details.
    objective, lower_bound, gap, best_possible
        As in `Solution`; None where there is no law.
    constants
        B, C, D, J and rms_c of the law; empty where there is none, None for one without bound.
    law
        The law; None where there is none.
    iterations, seconds
        Iterations of the solver, and wall time.
    """

    index: int
    key: str
    inputs: dict[str, Any]
    status: Status = Status.ERROR
    objective: float | None = None
    lower_bound: float | None = None
    gap: float | None = None
    best_possible: float | None = None
    B: float | None = None
    C: float | None = None
    D: float | None = None
    J: float | None = None
    rms_c: float | None = None
    iterations: int | None = None
    seconds: float = 0.0
    stored: msgspec.Raw = msgspec.field(default=NO_LAW, name="law")
    error: str | None = None
    #: entries of the study's problem that all points share
    shared: dict[str, Any] = {}

    limit = former_name("limit", "best_possible")

    @property
    def constants(self) -> dict[str, float | None]:
        """Constants of the law by name."""
        return {} if self.stored == NO_LAW else {name: getattr(self, name) for name in CONSTANTS}

    @kept_property
    def law(self) -> MotionLaw | None:
        """The law as a value."""
        return None if self.stored == NO_LAW else MotionLaw.from_dict(msgspec.json.decode(self.stored))

    @kept_property
    def problem(self) -> Problem:
        """The problem as a value."""
        return Problem.from_dict(entries(self.shared, self.inputs))

    def __repr__(self) -> str:
        return f"StudyPoint(index={self.index}, inputs={self.inputs}, status={self.status.value!r})"


def row_of(line: Mapping[str, Any], inputs: dict[str, Any]) -> StudyPoint:
    """The row that a line of the Parquet file was."""
    line = renamed_entries(line)
    results = {name: line[name] for name in (*NUMBERS, *OTHERS) if name in line}
    law, status = results.pop("law"), Status(results.pop("status"))
    return StudyPoint(
        **results, status=status, inputs=inputs, stored=NO_LAW if law is None else msgspec.Raw(law.encode())
    )


def column(name: str) -> str:
    """The column of a varied entry; the prescribed B has another column than the law's B.

    Examples
    --------
    >>> column("B"), column("order")
    ('B asked', 'order')
    """
    return f"{name} asked" if name in (*NUMBERS, *OTHERS) else name


def _kind(name: str, values: Sequence[Any]) -> str:
    """The type of a column: mixed numbers and texts, or pairs, become text (JSON)."""
    numbers = not isinstance(values, list) or all(isinstance(value, float) for value in values)
    return _COLUMNS.get(type(type_of(name)), "float64" if numbers else "string")


def _texts(values: Iterable[Any]) -> list[str]:
    return [value if isinstance(value, str) else json.dumps(value) for value in values]


def schema(points: StudyPoints, about: Mapping[str, bytes] | None = None) -> pa.Schema:
    """The columns: varied entries, results, and the law as JSON that `MotionLaw.from_json` reads."""
    import pyarrow as pa

    kinds = {"index": "int64", "key": "string"}
    kinds |= {column(name): _kind(name, values) for name, values in points.columns.items()}
    kinds |= {"status": "string", **dict.fromkeys(NUMBERS, "float64")}
    kinds |= {"iterations": "int64", "law": "string", "error": "string"}
    fields = [(name, pa.type_for_alias(kind)) for name, kind in kinds.items()]
    return pa.schema(fields, metadata={**(about or {}), "made by": MARK})


def arrow(rows: Sequence[StudyPoint], shape: pa.Schema) -> pa.Table:
    """Rows as an Arrow table."""
    import pyarrow as pa

    inputs = {column(name): name for name in (rows[0].inputs if rows else ())}
    columns: list[pa.Array] = []
    for name, kind in zip(shape.names, shape.types, strict=True):
        if name in inputs:
            values = [row.inputs[inputs[name]] for row in rows]
            columns.append(_array(_texts(values) if kind == pa.string() else values, kind))
        elif name == "law":
            columns.append(_array([None if row.stored == NO_LAW else bytes(row.stored).decode() for row in rows], kind))
        else:
            columns.append(_array([getattr(row, name) for row in rows], kind))
    return pa.Table.from_arrays(columns, schema=shape)


def _array(values: Sequence[Any], kind: pa.DataType) -> pa.Array:
    """Values, None among them, as an Arrow array, from its buffers: `pyarrow.array` loads pandas, of some 55 MB."""
    import pyarrow as pa

    count, known = len(values), np.array([value is not None for value in values], dtype=bool)
    buffers: list[Any] = [np.packbits(known, bitorder="little")]
    if kind == pa.string():
        texts = [b"" if value is None else str(value).encode() for value in values]
        buffers += [np.cumsum([0, *map(len, texts)]).astype(np.int32), b"".join(texts)]
    elif kind == pa.bool_():
        buffers.append(np.packbits(np.array([bool(value) for value in values], dtype=bool), bitorder="little"))
    else:
        filled = [0 if value is None else value for value in values]
        buffers.append(np.array(filled, dtype=np.int64 if kind == pa.int64() else np.float64))
    return pa.Array.from_buffers(kind, count, [pa.py_buffer(buffer) for buffer in buffers])


def dataset(rows: Iterable[StudyPoint], points: StudyPoints, about: Mapping[str, Any]) -> xr.Dataset:
    """A dimension for each factor of the product; a variable for each number, and the status.

    What varies alone is a coordinate of its dimension; what varies together shares one, "together 1" or "sample 1".
    """
    import xarray as xr

    variables: dict[str, Any] = {name: np.full(len(points), np.nan) for name in NUMBERS}
    variables["status"] = np.full(len(points), "", dtype=object)
    for row in rows:
        for name, values in variables.items():
            if (value := getattr(row, name)) is not None:
                values[row.index] = value
    dimensions = [column(axis.label) for axis in points.axes]
    coordinates = {
        column(name): (dimension, _texts(values) if _kind(name, values) == "string" else list(values))
        for axis, dimension in zip(points.axes, dimensions, strict=True)
        for name, values in axis.columns.items()
    }
    shaped = {name: (dimensions, values.reshape(points.shape)) for name, values in variables.items()}
    attributes = {name: json.dumps(value) if isinstance(value, dict) else value for name, value in about.items()}
    return xr.Dataset(shaped, coordinates, attributes)
