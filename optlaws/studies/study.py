"""A study that was run, or is being run: its rows, as tables and as laws."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec

from optlaws.errors import InputError, needed
from optlaws.files.reading import check_names
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.shown.report import PlainReport, Report, ReportTable, report_page
from optlaws.shown.summary import Row, Summary
from optlaws.studies.points import StudyPoints
from optlaws.studies.store import GROUP, Chunks, StudyDirectory
from optlaws.studies.tables import CONSTANTS, StudyPoint, arrow, dataset, row_of, schema
from optlaws.synthesis import Status

if TYPE_CHECKING:
    import pandas as pd
    import pyarrow as pa
    import xarray as xr

_SHOWN = 12


class Study:
    """A study's directory, read as far as it is complete.

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
        self._shared = dict(self.file.problem)
        self._checked: tuple[int, ...] = ()

    @property
    def path(self) -> Path:
        """The directory of the study."""
        return self._directory.path

    @property
    def about(self) -> dict[str, Any]:
        """Title, format, hash of the study file, versions of the libraries, number of points."""
        return {name: value for name, value in self._about.items() if name != "study"}

    @kept_property
    def _points(self) -> StudyPoints:
        """The points of the study by index."""
        points = StudyPoints.of(self.file, self._about["chunk"])
        if len(points) != len(self):
            raise InputError(
                f"{self._directory.about} is damaged: it states {len(self)} points, its study has {len(points)}"
            )
        return points

    @property
    def counts(self) -> dict[Status, int]:
        """Numbers of solved points by status."""
        if self._tabled:
            counts = Counter(self._parquet().read(columns=["status"])["status"].to_pylist())
        else:
            counts = self._chunks().counts
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
        if not self._tabled:
            yield from map(self._whole, self._chunks().in_order(self._points))
            return
        for batch in self._parquet().iter_batches(batch_size=GROUP):
            yield from map(self._of_line, batch.to_pylist())

    def __getitem__(self, index: int) -> StudyPoint:
        """A single point, by its index."""
        if not 0 <= index < len(self):
            raise IndexError(f"{self.path} has the points 0 to {len(self) - 1}, not {index}")
        if self._tabled:
            return self._of_line(self._parquet().read_row_group(index // GROUP).slice(index % GROUP, 1).to_pylist()[0])
        number, chunks = self._points.chunk_of(index), self._chunks()
        if number not in chunks.done:
            raise InputError(f"point {index} of {self.path} is not solved yet")
        return self._whole(chunks.rows(number)[index])

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
        check_names([constant], known, "constant")
        check_names(condition, self.file.names(), "entry that varies")
        points = (
            point
            for point in self
            if getattr(point, constant) is not None
            and all(point.inputs[name] == value for name, value in condition.items())
        )
        best = min(points, key=lambda point: (getattr(point, constant), point.index), default=None)
        if best is None:
            raise InputError(f"{self.path} has no law{f' with {condition}' if condition else ''}")
        return best

    def to_arrow(self) -> pa.Table:
        """All finished rows as an Arrow table.

        Raises
        ------
        NotInstalled
            If pyarrow is missing.
        """
        needed("pyarrow", "to_arrow")
        if self._tabled:
            return self._parquet().read()
        import pyarrow as pa

        shape, rows = schema(self._points), iter(self)
        groups = iter(lambda: list(islice(rows, GROUP)), [])
        return pa.concat_tables([shape.empty_table(), *(arrow(group, shape) for group in groups)])

    def to_pandas(self) -> pd.DataFrame:
        """All finished rows as a data frame.

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
        return dataset(self, self._points, self.about)

    def report(self) -> Report:
        """How many points are done, by status, and the first of them."""
        counts, total, running = self.counts, len(self), self.running
        done = sum(counts.values())
        state = "finished" if done == total else "under way" if running else "interrupted: run the same command again"
        facts = [Row(str(self.path), f"{done} of {total} points", note=state)]
        facts += [Row(status.value, float(count)) for status, count in counts.items()]
        lines = [
            [*point.inputs.values(), point.status.value, *(getattr(point, name) for name in CONSTANTS)]
            for point in islice(self, _SHOWN)
        ]
        table = ReportTable((*self.file.names(), "status", *CONSTANTS), lines)
        known = {"path": str(self.path), "points": total, "done": done, "running": running, "counts": counts}
        return PlainReport(Summary(facts), [table], (), lambda: {**self.about, **known})

    def _repr_html_(self) -> str:
        return report_page(self.about["title"], self.report())

    def __repr__(self) -> str:
        counts = ", ".join(f"{number} {status}" for status, number in self.counts.items())
        return f"Study({str(self.path)!r}, {len(self)} points: {counts or 'none done'})"

    @property
    def _tabled(self) -> bool:
        """Whether the rows are in the table, as for a finished study."""
        return self._directory.table.exists()

    @kept_property
    def _known_chunks(self) -> Chunks:
        return Chunks(self._directory.chunks)

    def _chunks(self) -> Chunks:
        """The finished chunks of the study."""
        self._known_chunks.refresh()
        return self._known_chunks

    def _parquet(self) -> Any:
        pq = needed("pyarrow.parquet", f"reading {self._directory.table}")
        there = self._directory.table.stat()
        state = (there.st_mtime_ns, there.st_size)
        if state != self._checked:
            self._directory.check_table(len(self))
            self._checked = state
        return pq.ParquetFile(self._directory.table)

    def _of_line(self, line: Mapping[str, Any]) -> StudyPoint:
        return self._whole(row_of(line, self._points.inputs(line["index"])))

    def _whole(self, row: StudyPoint) -> StudyPoint:
        """A row with what all points share."""
        return msgspec.structs.replace(row, shared=self._shared)


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
    optlaws.errors.InputError: nowhere contains no study; optlaws study FILE --out nowhere begins one
    """
    return Study(path)
