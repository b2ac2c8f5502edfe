"""The directory of a study: its definition, its writer, its finished chunks, and its table when all are finished."""

from __future__ import annotations

import hashlib
import json
import os
import re
import shutil
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from functools import lru_cache
from itertools import islice
from pathlib import Path
from typing import IO, Annotated, Any

import msgspec
import numpy as np

from optlaws.errors import InputError, located
from optlaws.files import reading, writing
from optlaws.files.problem_file import typed
from optlaws.studies.points import StudyPoints
from optlaws.studies.specification import StudyFile, read_study
from optlaws.studies.tables import StudyPoint, arrow, schema
from optlaws.synthesis.solution import versions

FORMAT = 1
#: rows of one group in the Parquet file
GROUP = 4096
#: columns of texts of which each is another
_UNIQUE = ("key", "law")
#: rows of chunks that are in memory at a time
_IN_MEMORY = 1024
_DIGEST = re.compile(rf"{writing.MARK} [0-9a-f]{{16}}")
_decode = msgspec.json.Decoder(StudyPoint).decode


class StoreFailure(InputError, OSError):  # noqa: N818 - beside SolverFailure
    """The store of a study cannot be written; what was written before stands.

    Examples
    --------
    >>> raise StoreFailure("no space left on device")
    Traceback (most recent call last):
    optlaws.studies.store.StoreFailure: no space left on device
    """


class DamagedTable(InputError):  # noqa: N818 - as SolverFailure
    """The table of a study is not what was written.

    Examples
    --------
    >>> raise DamagedTable(Path("rows.parquet"), "it is empty")
    Traceback (most recent call last):
    optlaws.studies.store.DamagedTable: rows.parquet is damaged: it is empty; put a whole copy in its place, or
    remove it and rows.sha256 and run the same study again: its points are then solved anew
    """

    def __init__(self, file: Path, reason: str) -> None:
        super().__init__(
            f"{file} is damaged: {reason}; put a whole copy in its place, or remove it and rows.sha256 "
            "and run the same study again: its points are then solved anew"
        )


class Chunks:
    """The chunks of a study under way, a file each: `done` has the numbers of those that are whole.

    A file is there whole or not at all: its first line is the checksum of the others, one line of JSON a point. One
    whose checksum does not fit is no part of the study, and its chunk is solved again.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.done: set[int] = set()
        self.counts: Counter[str] = Counter()
        self.refresh()

    def refresh(self) -> None:
        """Take in the chunks that were added since."""
        names = [entry.name for entry in os.scandir(self.folder)] if self.folder.exists() else []
        for number in sorted({int(name) for name in names if name.isdecimal()} - self.done):
            with suppress(ValueError, FileNotFoundError):
                self._add(number, self.lines(number))

    def lines(self, number: int) -> list[bytes]:
        """The rows of a chunk as JSON; ValueError where they are not as they were written."""
        with (self.folder / str(number)).open("rb") as stream:
            checksum, text = stream.readline(), stream.read()
        if checksum != _checksum(text):
            raise ValueError(f"chunk {number} is damaged")
        return text.split(b"\n")

    def rows(self, number: int) -> dict[int, StudyPoint]:
        """The rows of a chunk that is done, by their indices."""
        return {row.index: row for row in map(_decode, self.lines(number))}

    def in_order(self, points: StudyPoints) -> Iterator[StudyPoint]:
        """The rows that are there, in the order of the points; a few chunks are in memory at a time."""
        rows = lru_cache(maxsize=max(3, _IN_MEMORY // points.chunk))(self.rows)
        for begin in range(0, len(points), GROUP):
            indices = np.arange(begin, min(begin + GROUP, len(points)))
            for index, number in zip(indices.tolist(), points.chunks_of(indices).tolist(), strict=True):
                if number in self.done:
                    yield rows(number)[index]

    def write(self, number: int, rows: Sequence[bytes]) -> None:
        """Write a chunk and have it on the disk when this returns."""
        text = b"\n".join(rows)
        copy = self.folder / f".{number}"
        try:
            self.folder.mkdir(exist_ok=True)
            with copy.open("wb") as stream:
                stream.write(_checksum(text) + text)
            _flush(copy)
            copy.replace(self.folder / str(number))
            _flush(self.folder)
        except OSError as error:
            with suppress(OSError):
                copy.unlink(missing_ok=True)
            raise StoreFailure(
                f"cannot write {self.folder}: {error.strerror or error}; {len(self.done)} chunks are safe: "
                "make room and run the same command again"
            ) from error
        self._add(number, rows)

    def write_all(self, chunks: Mapping[int, Sequence[bytes]]) -> None:
        """Write chunks by their numbers."""
        for number, rows in chunks.items():
            self.write(number, rows)

    def _add(self, number: int, rows: Sequence[bytes]) -> None:
        self.counts.update(_decode(row).status for row in rows)
        self.done.add(number)


@dataclass(frozen=True)
class _About:
    """Required entries of `study.json`."""

    title: str
    hash: str
    versions: dict[str, str]
    points: Annotated[int, msgspec.Meta(ge=1)]
    chunk: Annotated[int, msgspec.Meta(ge=1)]
    study: dict[str, Any]


class StudyDirectory:
    """The parts of a study's directory: `study.json`, the lock, the chunks under way, the table in Parquet."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.about = path / "study.json"
        self.chunks = path / "chunks"
        self.table = path / "rows.parquet"
        self.checksum = path / "rows.sha256"
        self.lock = path / "lock"

    def read(self) -> tuple[dict[str, Any], StudyFile]:
        """The content of `study.json` and the study itself; refused for another format or a changed file."""
        try:
            there = self.about.exists()
        except OSError as error:
            raise InputError(f"{self.about} cannot be read: {error.strerror}") from None
        if not there:
            raise InputError(f"{self.path} contains no study; optlaws study FILE --out {self.path} begins one")
        text = reading.text(self.about)
        with located(f"{self.about} is damaged"):
            about = reading.json_text(text, str(self.about))
        if isinstance(about, dict) and about.get("format") != FORMAT:
            raise InputError(f"{self.about}: the format is {about.get('format')!r}, this version reads {FORMAT}")
        try:
            typed(about, _About)
        except msgspec.ValidationError as error:
            raise InputError(f"{self.about} is damaged: {error}; put a whole copy in its place") from None
        if not _is_as_written(text):
            raise InputError(
                f"{self.about} is damaged: it is not as it was written, and its points may be others; put a whole copy "
                "in its place"
            )
        return about, read_study(about["study"])

    def claim(self, study: StudyFile, points: StudyPoints) -> int:
        """The number of points of a chunk, in a directory that is this study's and of these versions, or becomes so."""
        mine: dict[str, Any] = {"format": FORMAT, "hash": digest(study), "versions": versions()}
        if not self.about.exists():
            about = {"about": writing.MARK, "title": study.title, **mine, "points": len(points), "chunk": points.chunk}
            text = json.dumps({**about, "study": study.to_dict()}, indent=1) + "\n"
            writing.write(self.about, _with_digest(text), exact=True, force=True)
            return points.chunk
        about, known = self.read()
        if not mine["hash"] == about["hash"] == digest(known):
            raise InputError(
                f"{self.path} holds the study {about['title']!r} as it was before its file was changed: "
                "give the changed one another directory, or remove this one"
            )
        if about["versions"] != mine["versions"] and not self.table.exists():
            raise InputError(
                f"{self.path} was begun with {_listed(about['versions'])}; now there are {_listed(versions())}: "
                "finish it with the former, or give the study another directory"
            )
        return int(about["chunk"])

    @contextmanager
    def locked(self) -> Iterator[None]:
        """The directory, locked against other runs; the system frees the lock when the process ends."""
        with self._lock_file() as stream:
            try:
                locked = _lock(stream)
            except OSError as error:
                raise InputError(
                    f"{self.lock} cannot be locked: {error.strerror}; put the study on a file system with locks"
                ) from None
            if not locked:
                raise InputError(f"{self.path} is in use by another run{_owner(stream)}")
            stream.truncate(0)
            stream.write(str(os.getpid()).encode())
            stream.flush()
            yield

    def in_use(self) -> bool:
        """Whether a run writes in it now."""
        # whoever may only read can see it as well; what cannot be asked is not in use by this user
        for mode in ("r+b", "rb"):
            with suppress(OSError), self.lock.open(mode) as stream:
                return not _lock(stream)
        return False

    def write_table(self, points: StudyPoints, chunks: Chunks) -> None:
        """Write the table of a finished study, whole or not at all; without pyarrow its chunks stay the store."""
        try:
            import pyarrow.parquet as pq
        except ImportError:
            return
        shape = schema(points, about={"optlaws": self.about.read_bytes()})
        copy = self.table.with_suffix(".unfinished")
        # numbers, keys and laws hardly repeat: dictionaries of them would be built and dropped
        repeating = [field.name for field in shape if str(field.type) == "string" and field.name not in _UNIQUE]
        try:
            with pq.ParquetWriter(
                copy, shape, compression="zstd", write_page_checksum=True, use_dictionary=repeating
            ) as writer:
                rows = chunks.in_order(points)
                while group := list(islice(rows, GROUP)):
                    writer.write_table(arrow(group, shape))
            _flush(copy)
            # read again before the chunks go
            _check_rows(copy, len(points), chunks.counts)
            text = f"{_digest(copy)}  {self.table.name}\n# {writing.MARK}\n"
            writing.write(self.checksum, text, exact=True, force=True)
            copy.replace(self.table)
        except OSError as error:
            copy.unlink(missing_ok=True)
            raise StoreFailure(
                f"cannot write {self.table}: {error.strerror or error}; every row is safe in {self.chunks}: "
                "make room and run the same command again"
            ) from error

    def check_table(self, points: int) -> None:
        """Refuse a table that is not what was written: by its checksum, or one without by reading all of it."""
        file = self.checksum
        try:
            stated = file.read_text(encoding="utf-8").split()[:1] if file.exists() else []
            file = self.table
            changed = bool(stated) and stated[0] != _digest(file)
        except (OSError, ValueError) as error:
            raise DamagedTable(file, f"it cannot be read: {getattr(error, 'strerror', error)}") from None
        if changed:
            raise DamagedTable(self.table, f"its content is not what {self.checksum.name} says was written")
        if not stated:
            # without pyarrow the table cannot be read, and reading it raises the error
            with suppress(ImportError):
                _check_rows(self.table, points)

    def finished(self, points: int) -> bool:
        """Whether the table exists and is complete; a damaged table is rewritten from the remaining chunks."""
        if not self.table.exists():
            return False
        try:
            self.check_table(points)
        except DamagedTable:
            if self.chunks.exists():
                return False
            raise
        return True

    def remove_chunks(self) -> None:
        """Remove chunks that are in the table already; a run may have been killed between the two steps."""
        if self.table.exists():
            shutil.rmtree(self.chunks, ignore_errors=True)

    def _lock_file(self) -> IO[bytes]:
        writing.check_name(self.path)
        try:
            self.path.mkdir(parents=True, exist_ok=True)
            if not self.about.exists() and not all(map(self._begun, self.path.iterdir())):
                raise InputError(f"{self.path} contains other files and no study; choose an empty or a new directory")
            return self.lock.open("a+b")
        except OSError as error:
            raise InputError(
                f"{self.path} cannot be written: {error.strerror}; a study there can be read, and its status shown, "
                "not run"
            ) from None

    def _begun(self, file: Path) -> bool:
        # a run may have been killed while it wrote the first of its files
        return file.name == self.lock.name or file.name.startswith(f".{self.about.name}")


def _with_digest(text: str) -> str:
    """A text with a digest of it behind its mark, by which an edit shows."""
    return text.replace(writing.MARK, f"{writing.MARK} {hashlib.sha256(text.encode()).hexdigest()[:16]}", 1)


def _is_as_written(text: str) -> bool:
    """Whether a text is what was written, whatever its line ends."""
    plain = text.replace("\r\n", "\n")
    # a text without a mark would be its own
    return writing.MARK in plain and plain == _with_digest(_DIGEST.sub(writing.MARK, plain, count=1))


def _checksum(text: bytes) -> bytes:
    """The checksum that is the first line of a chunk's file."""
    return hashlib.sha256(text).hexdigest().encode() + b"\n"


def _flush(file: Path) -> None:
    """Have a file, or the names in a folder, on the disk."""
    if os.name == "nt" and file.is_dir():
        return
    place = os.open(file, os.O_RDONLY if file.is_dir() else os.O_RDWR)
    try:
        os.fsync(place)
    finally:
        os.close(place)


def _owner(stream: IO[bytes]) -> str:
    # some systems let nobody read what another process has locked
    with suppress(OSError):
        stream.seek(0)
        if owner := stream.read().decode(errors="replace").strip():
            return f", process {owner}"
    return ""


def _lock(stream: IO[bytes]) -> bool:
    """Whether the file is this process's alone until it is closed."""
    from filelock import lock_descriptor

    return lock_descriptor(stream.fileno(), blocking=False)


def digest(study: StudyFile) -> str:
    """A hash of the definition of a study, independent of its file's form.

    Examples
    --------
    >>> first = read_study({"problem": {"order": 4}, "vary": {"B": [1.6]}})
    >>> digest(first) == digest(read_study({"vary": {"B": [1.6]}, "problem": {"order": 4}}))
    True
    """
    return hashlib.sha256(json.dumps(study.to_dict()).encode()).hexdigest()


def _listed(numbers: dict[str, str]) -> str:
    return ", ".join(f"{name} {number}" for name, number in numbers.items())


def _check_rows(file: Path, points: int, counts: Mapping[str, int] | None = None) -> None:
    """Refuse a table without every point, in order, or without as many of each status as were counted."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    counted: Counter[str] = Counter()
    count = 0
    try:
        with pq.ParquetFile(file, page_checksum_verification=True, pre_buffer=False) as table:
            missing = [name for name in ("index", "key", "status", "law", "error") if name not in table.schema.names]
            if missing:
                raise DamagedTable(file, f"it has no column {missing[0]!r}")
            for batch in table.iter_batches(batch_size=GROUP, use_threads=False):
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
