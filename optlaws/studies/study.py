"""A study that was run, or is being run: its rows, as tables and as laws."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec

from optlaws.errors import InputError
from optlaws.extras import needed
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.studies.point import CONSTANTS, StudyPoint, study_point
from optlaws.studies.points.points import Points
from optlaws.studies.points.study_file import entries
from optlaws.studies.solving.solving import STATUSES, Row
from optlaws.studies.store import table
from optlaws.studies.store.directory import StudyDirectory
from optlaws.studies.store.journal import Journal
from optlaws.suggest import unknown_key

if TYPE_CHECKING:
    import pandas as pd
    import pyarrow as pa
    import xarray as xr

_SHOWN = 12


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
        self._checked: tuple[int, int] | None = None
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
    def _points(self) -> Points:
        """The points, by index."""
        points = Points.of(self.file, self._about["chunk"])
        if len(points) != len(self):
            raise InputError(
                f"{self._directory.about} is damaged: it says {len(self)} points, its study has {len(points)}"
            )
        return points

    @property
    def counts(self) -> dict[str, int]:
        """How many points are done, by status."""
        counted = self._counted()
        return {status: counted[status] for status in STATUSES if counted[status]}

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
        return (self._point(row) for row in self._rows())

    def __getitem__(self, index: int) -> StudyPoint:
        """One point, by its index."""
        if not 0 <= index < len(self):
            raise IndexError(f"{self.path} has the points 0 to {len(self) - 1}, not {index}")
        if self._directory.table.exists():
            file = self._parquet()
            group = file.read_row_group(index // table.GROUP)
            return self._point(table.unflat(group.slice(index % table.GROUP, 1).to_pylist()[0], self._points))
        number, journal = self._points.chunk_of(index), self._journal()
        if number not in journal.done:
            raise InputError(f"point {index} of {self.path} is not solved yet")
        return self._point(next(r for r in map(msgspec.json.decode, journal.rows(number)) if r["index"] == index))

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
        known = (*CONSTANTS, "objective")
        if constant not in known:
            raise InputError(unknown_key(constant, known, "constant"))
        wanted = dict(where or {})
        for name in wanted:
            if name not in self.file.names():
                raise InputError(unknown_key(name, self.file.names(), "entry that varies"))
        rows = (
            row
            for row in self._rows()
            if row[constant] is not None and all(row["inputs"][name] == value for name, value in wanted.items())
        )
        best = min(rows, key=lambda row: (row[constant], row["index"]), default=None)
        if best is None:
            raise InputError(f"{self.path} has no law{f' with {wanted}' if wanted else ''}")
        return self._point(best)

    def to_arrow(self) -> pa.Table:
        """All rows that are done as an Arrow table.

        Raises
        ------
        NotInstalled
            If pyarrow is missing.
        """
        needed("pyarrow", "to_arrow")
        if self._directory.table.exists():
            return self._parquet().read()
        return table.arrow(list(table.rows_in_order(self._journal(), self._points)), table.schema(self._points))

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
        from optlaws.studies.store.dataset import dataset

        return dataset(self._rows(), self._points, self.about)

    def _repr_html_(self) -> str:
        from optlaws.shown.showing import facts, page, table

        first = [[*row["inputs"].values(), row["status"], *(row[name] for name in CONSTANTS)] for row in self._first()]
        done = {"done": f"{sum(self.counts.values())} of {len(self)}", **self.counts}
        return page(self.about["title"], facts(done), table((*self.file.names(), "status", *CONSTANTS), first))

    def _first(self) -> list[Row]:
        rows = self._rows()
        return [row for row, _ in zip(rows, range(_SHOWN), strict=False)]

    def __repr__(self) -> str:
        counts = ", ".join(f"{number} {status}" for status, number in self.counts.items())
        return f"Study({str(self.path)!r}, {len(self)} points: {counts or 'none done'})"

    def _rows(self) -> Iterator[Row]:
        if not self._directory.table.exists():
            yield from map(table.plain, table.rows_in_order(self._journal(), self._points))
            return
        for batch in self._parquet().iter_batches(batch_size=table.GROUP):
            for row in batch.to_pylist():
                yield table.unflat(row, self._points)

    def _counted(self) -> Counter[str]:
        if not self._directory.table.exists():
            return self._journal().counts
        return Counter(self._parquet().read(columns=["status"])["status"].to_pylist())

    def _journal(self) -> Journal:
        """The journal as far as it is written; it is read again when it has grown."""
        file = self._directory.journal
        try:
            state_of_file = file.stat()
        except FileNotFoundError:
            return Journal(file)
        state = (state_of_file.st_ino, state_of_file.st_mtime_ns, state_of_file.st_size)
        if self._scanned is None or self._scanned[0] != state:
            self._scanned = (state, Journal(file))
        return self._scanned[1]

    def _parquet(self) -> Any:  # noqa: ANN401 - pyarrow has no types
        needed("pyarrow", f"reading {self._directory.table}")
        import pyarrow.parquet as pq

        state_of_file = self._directory.table.stat()
        state = (state_of_file.st_mtime_ns, state_of_file.st_size)
        if state != self._checked:
            table.check(self._directory, len(self))
            self._checked = state
        return pq.ParquetFile(self._directory.table)

    def _point(self, row: Row) -> StudyPoint:
        return study_point(row, entries(self.file.problem.given(), row["inputs"]))


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
