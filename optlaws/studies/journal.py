"""The journal of a study under way: one line a point, each with its checksum, chunk after chunk."""

from __future__ import annotations

import os
import re
import zlib
from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path

import msgspec

from optlaws.errors import InputError


class StoreFailure(InputError, OSError):  # noqa: N818 - beside SolverFailure
    """The store of a study cannot be written; what was written before stands.

    Examples
    --------
    >>> raise StoreFailure("no space left on device")
    Traceback (most recent call last):
    optlaws.studies.journal.StoreFailure: no space left on device
    """


class _Status(msgspec.Struct):
    status: str


_HEAD = b"chunk "
_LAST_HEAD = re.compile(rb"[0-9a-f]{8} chunk \d+ \d+\n\Z")
_decode = msgspec.json.Decoder(_Status).decode


class Journal:
    """An append-only file; `done` has the chunks that are whole, by number, with their place in the file.

    A chunk is one head line and a line for each of its points, written at once. What is behind the last whole chunk,
    and any chunk with a line that its checksum does not fit, is no part of the journal: it is cut away when the
    journal is opened for writing, and the chunk is solved again.
    """

    def __init__(self, file: Path) -> None:
        self.file = file
        self.done: dict[int, tuple[int, int]] = {}
        self.counts: Counter[str] = Counter()
        self._end = 0
        self._broken = False
        self._stream: int | None = None
        if file.exists():
            self._scan()

    def open(self) -> None:
        """Make it ready for writing: cut away what is torn."""
        try:
            if self._broken:
                self._rewrite()
            self._stream = os.open(self.file, os.O_RDWR | os.O_CREAT | getattr(os, "O_BINARY", 0), 0o644)
            self._cut()
        except OSError as error:
            raise self._failure(error) from error

    def append(self, chunks: Iterable[tuple[int, Sequence[bytes]]]) -> None:
        """Write chunks and have them on the disk when this returns; the journal is as it was where they cannot be."""
        if self._stream is None:
            raise StoreFailure(f"{self.file} is not open for writing")
        text, places = b"", {}
        added: Counter[str] = Counter()
        for number, rows in chunks:
            places[number] = (self._end + len(text), len(rows))
            text += _block(number, rows)
            added.update(_decode(row).status for row in rows)
        try:
            left = memoryview(text)
            while left:
                left = left[os.write(self._stream, left) :]
            os.fsync(self._stream)
        except OSError as error:
            self._cut()
            raise self._failure(error) from error
        self._end += len(text)
        self.done |= places
        self.counts += added

    def close(self) -> None:
        """Give the file back."""
        if self._stream is not None:
            os.close(self._stream)
            self._stream = None

    def rows(self, number: int) -> list[bytes]:
        """The rows of a chunk that is done."""
        with self.file.open("rb") as stream:
            place, count = self.done[number]
            stream.seek(place)
            stream.readline()
            return [stream.readline()[9:-1] for _ in range(count)]

    def _cut(self) -> None:
        """Cut away all behind the last whole chunk."""
        if self._stream is not None:
            os.ftruncate(self._stream, self._end)
            os.lseek(self._stream, self._end, os.SEEK_SET)

    def _scan(self) -> None:
        """Find the whole chunks; one that comes twice, which only a file edited by hand can have, counts once."""
        place = length = 0
        begun: tuple[int, int, int] | None = None
        statuses: list[str] = []
        with self.file.open("rb") as stream:
            for line in stream:
                data = _checked(line)
                if data is None and (head := _LAST_HEAD.search(line)) is not None:
                    # the end of the line before it was hit
                    place, line, data = place + head.start(), head[0], _checked(head[0])  # noqa: PLW2901
                if data is None:
                    begun = None
                elif data.startswith(_HEAD):
                    number, count = map(int, data.removeprefix(_HEAD).split())
                    begun, statuses = (number, count, place), []
                elif begun is not None:
                    statuses.append(_decode(data).status)
                place += len(line)
                if begun is not None and len(statuses) == begun[1] and begun[0] not in self.done:
                    self.done[begun[0]] = (begun[2], begun[1])
                    self.counts.update(statuses)
                    self._end, length, begun = place, length + place - begun[2], None
        # a torn end is cut away; damage before it takes a new file
        self._broken = length != self._end

    def _rewrite(self) -> None:
        """Replace the file by one of the whole chunks alone."""
        copy = self.file.with_suffix(".mending")
        places: dict[int, tuple[int, int]] = {}
        with copy.open("wb") as target:
            for number, (_, count) in self.done.items():
                places[number] = (target.tell(), count)
                target.write(_block(number, self.rows(number)))
            self._end = target.tell()
            target.flush()
            os.fsync(target.fileno())
        copy.replace(self.file)
        self.done, self._broken = places, False

    def _failure(self, error: OSError) -> StoreFailure:
        return StoreFailure(
            f"cannot write {self.file}: {error.strerror or error}; {len(self.done)} chunks are safe: "
            "make room and run the same command again"
        )


def _block(number: int, rows: Sequence[bytes]) -> bytes:
    return b"".join(map(_line, (b"%b%d %d" % (_HEAD, number, len(rows)), *rows)))


def _line(data: bytes) -> bytes:
    return b"%08x %b\n" % (zlib.crc32(data), data)


def _checked(line: bytes) -> bytes | None:
    """What a line holds; None where the checksum does not fit or the line is torn."""
    data = line[9:-1]
    return data if line == _line(data) else None
