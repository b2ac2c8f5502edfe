"""A study that was run, or is being run: its rows, as tables and as laws."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any

from optlaws.errors import InputError
from optlaws.extras import needed
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.studies import tables
from optlaws.studies.chunk import StudyRow
from optlaws.studies.journal import Journal
from optlaws.studies.points import StudyPoints
from optlaws.studies.specification import entries
from optlaws.studies.store import StudyDirectory
from optlaws.suggest import unknown_key
from optlaws.synthesis import Problem, Status

if TYPE_CHECKING:
    import pandas as pd
    import pyarrow as pa
    import xarray as xr

CONSTANTS = ("B", "C", "D", "J", "rms_c")
_SHOWN = 12


@dataclass(frozen=True)
class StudyPoint:
    """One row of a study, with its law and its problem.

    Attributes
    ----------
    index, key
        Its number in the study, and a hash of its problem.
    inputs
        What varies, at this point.
    problem
        The whole problem.
    status
        How far the law can be trusted or, where there is none, why; `error` says more.
    objective, lower_bound, gap, limit
        As in `Solution`; None where there is no law.
    constants
        B, C, D, J and rms_c of the law; empty where there is none, None for one without bound.
    law
        The law; None where there is none.
    seconds
        Wall time.
    """

    index: int
    key: str
    inputs: Mapping[str, Any]
    status: Status
    objective: float | None
    lower_bound: float | None
    gap: float | None
    limit: float | None
    constants: Mapping[str, float | None]
    seconds: float
    error: str | None
    entries: Mapping[str, Any] = field(repr=False)
    stored: Mapping[str, Any] | None = field(repr=False)

    @kept_property
    def law(self) -> MotionLaw | None:
        """The law."""
        return None if self.stored is None else MotionLaw.from_dict(self.stored)

    @kept_property
    def problem(self) -> Problem:
        """The problem; InputError where the point asks for none."""
        return Problem.from_dict(self.entries)


class Study:
    """A study's directory, read as far as it is there.

    Parameters
    ----------
    path
        The directory.

    Raises
    ------
    InputError
        If there is no study.
    """

    def __init__(self, path: Path | str) -> None:
        self._directory = StudyDirectory(Path(path))
        self._about, self.file = self._directory.read()
        self._checked: tuple[int, ...] = ()
        self._scanned: tuple[tuple[int, ...], Journal] | None = None

    @property
    def path(self) -> Path:
        """The directory."""
        return self._directory.path

    @property
    def about(self) -> dict[str, Any]:
        """Title, format, hash of the study file, versions of the libraries, number of points."""
        return {name: value for name, value in self._about.items() if name != "study"}

    @kept_property
    def _points(self) -> StudyPoints:
        """The points, by index."""
        points = StudyPoints.of(self.file, self._about["chunk"])
        if len(points) != len(self):
            raise InputError(
                f"{self._directory.about} is damaged: it says {len(self)} points, its study has {len(points)}"
            )
        return points

    @property
    def counts(self) -> dict[Status, int]:
        """How many points are done, by status."""
        if self._tabled:
            counts = Counter(self._parquet().read(columns=["status"])["status"].to_pylist())
        else:
            counts = self._journal().counts
        known = Counter[Status]()
        for word, count in counts.items():
            known[Status(word)] += count
        return {status: known[status] for status in Status if known[status]}

    @property
    def finished(self) -> bool:
        """Whether every point is done."""
        return sum(self.counts.values()) == len(self)

    @property
    def running(self) -> bool:
        """Whether a run is writing into it now."""
        return self._directory.in_use()

    def __len__(self) -> int:
        return int(self._about["points"])

    def __iter__(self) -> Iterator[StudyPoint]:
        """The points that are done, in their order; few of them are in memory at a time."""
        return map(self._point, self._rows())

    def __getitem__(self, index: int) -> StudyPoint:
        """One point, by its index."""
        if not 0 <= index < len(self):
            raise IndexError(f"{self.path} has the points 0 to {len(self) - 1}, not {index}")
        if self._tabled:
            group = self._parquet().read_row_group(index // tables.GROUP)
            return self._point(tables.row_of(group.slice(index % tables.GROUP, 1).to_pylist()[0], self._points))
        number, journal = self._points.chunk_of(index), self._journal()
        if number not in journal.done:
            raise InputError(f"point {index} of {self.path} is not solved yet")
        return self._point(tables.rows_of_chunk(journal, number)[index])

    def law(self, index: int) -> MotionLaw:
        """The law of one point.

        Raises
        ------
        InputError
            If the point has none.
        """
        point = self[index]
        if point.law is None:
            raise InputError(f"point {index} of {self.path} has no law: {point.status}: {point.error}")
        return point.law

    def best(self, constant: str = "objective", where: Mapping[str, Any] | None = None) -> StudyPoint:
        """The point with the least value of a constant, or of the objective.

        Parameters
        ----------
        constant
            "B", "C", "D", "J", "rms_c" or "objective".
        where
            Values that entries must have, such as `{"order": 4}`.

        Raises
        ------
        InputError
            If the constant or an entry is unknown, or no point with a law has these values.
        """
        known, condition = (*CONSTANTS, "objective"), dict(where or {})
        if constant not in known:
            raise InputError(unknown_key(constant, known, "constant"))
        for name in condition:
            if name not in self.file.names():
                raise InputError(unknown_key(name, self.file.names(), "entry that varies"))
        rows = (
            row
            for row in self._rows()
            if getattr(row, constant) is not None
            and all(row.inputs[name] == value for name, value in condition.items())
        )
        best = min(rows, key=lambda row: (getattr(row, constant), row.index), default=None)
        if best is None:
            raise InputError(f"{self.path} has no law{f' with {condition}' if condition else ''}")
        return self._point(best)

    def to_arrow(self) -> pa.Table:
        """All rows that are done as an Arrow table.

        Raises
        ------
        NotInstalled
            If pyarrow is missing.
        """
        needed("pyarrow", "to_arrow")
        return self._parquet().read() if self._tabled else tables.arrow(list(self._rows()), tables.schema(self._points))

    def to_pandas(self) -> pd.DataFrame:
        """All rows that are done as a data frame.

        Raises
        ------
        NotInstalled
            If pandas or pyarrow is missing.
        """
        needed("pandas", "to_pandas")
        return self.to_arrow().to_pandas()

    def to_xarray(self) -> xr.Dataset:
        """The rows over the dimensions of the study; NaN and "" where a point is not done or has no law.

        Raises
        ------
        NotInstalled
            If xarray is missing.
        """
        needed("xarray", "to_xarray")
        return tables.dataset(self._rows(), self._points, self.about)

    def _repr_html_(self) -> str:
        from optlaws.shown.showing import facts, page, table

        lines = [
            [*row.inputs.values(), row.status, *(getattr(row, name) for name in CONSTANTS)]
            for row in islice(self._rows(), _SHOWN)
        ]
        done = {"done": f"{sum(self.counts.values())} of {len(self)}", **self.counts}
        return page(self.about["title"], facts(done), table((*self.file.names(), "status", *CONSTANTS), lines))

    def __repr__(self) -> str:
        counts = ", ".join(f"{number} {status}" for status, number in self.counts.items())
        return f"Study({str(self.path)!r}, {len(self)} points: {counts or 'none done'})"

    @property
    def _tabled(self) -> bool:
        """Whether the rows are in the table, as those of a finished study are."""
        return self._directory.table.exists()

    def _rows(self) -> Iterator[StudyRow]:
        if not self._tabled:
            yield from tables.rows_in_order(self._journal(), self._points)
            return
        for batch in self._parquet().iter_batches(batch_size=tables.GROUP):
            for line in batch.to_pylist():
                yield tables.row_of(line, self._points)

    def _journal(self) -> Journal:
        """The journal as far as it is written; it is read again when it has grown."""
        file = self._directory.journal
        try:
            there = file.stat()
        except FileNotFoundError:
            return Journal(file)
        state = (there.st_ino, there.st_mtime_ns, there.st_size)
        if self._scanned is None or self._scanned[0] != state:
            self._scanned = (state, Journal(file))
        return self._scanned[1]

    def _parquet(self) -> Any:  # noqa: ANN401 - pyarrow has no types
        needed("pyarrow", f"reading {self._directory.table}")
        import pyarrow.parquet as pq

        there = self._directory.table.stat()
        state = (there.st_mtime_ns, there.st_size)
        if state != self._checked:
            tables.check(self._directory, len(self))
            self._checked = state
        return pq.ParquetFile(self._directory.table)

    def _point(self, row: StudyRow) -> StudyPoint:
        law = row.stored_law()
        names = ("index", "key", "inputs", "objective", "lower_bound", "gap", "limit", "seconds", "error")
        return StudyPoint(
            **{name: getattr(row, name) for name in names},
            status=Status(row.status),
            constants={} if law is None else {name: getattr(row, name) for name in CONSTANTS},
            entries=entries(self.file.problem.given(), row.inputs),
            stored=law,
        )


def open_study(path: Path | str) -> Study:
    """A study that was run, or is being run, from its directory.

    Parameters
    ----------
    path
        The directory.

    Raises
    ------
    InputError
        If the directory holds no study.

    Examples
    --------
    >>> open_study("nowhere")
    Traceback (most recent call last):
    optlaws.errors.InputError: nowhere holds no study; optlaws study FILE --out nowhere makes one
    """
    return Study(path)
