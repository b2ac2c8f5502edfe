"""The directory of a study: what it is, who writes in it, and where its parts are."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO, Annotated, Any

import msgspec

from optlaws.errors import InputError
from optlaws.files import reading, writing
from optlaws.files.typed import typed
from optlaws.studies.points import StudyPoints
from optlaws.studies.specification import StudyFile, read_study
from optlaws.synthesis.solution import versions

FORMAT = 1


class _About(msgspec.Struct):
    """What `study.json` has at least."""

    title: str
    hash: str
    versions: dict[str, str]
    points: Annotated[int, msgspec.Meta(ge=1)]
    chunk: Annotated[int, msgspec.Meta(ge=1)]
    study: dict[str, Any]


class StudyDirectory:
    """The parts of a study's directory: `study.json`, the journal, the table in Parquet, and the lock."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.about = path / "study.json"
        self.journal = path / "journal"
        self.table = path / "rows.parquet"
        self.checksum = path / "rows.sha256"
        self.lock = path / "lock"

    def read(self) -> tuple[dict[str, Any], StudyFile]:
        """All that `study.json` says, and the study itself, unless it is of another format or not as it was written."""
        try:
            there = self.about.exists()
        except OSError as error:
            raise InputError(f"{self.about} cannot be read: {error.strerror}") from None
        if not there:
            raise InputError(f"{self.path} holds no study; optlaws study FILE --out {self.path} makes one")
        text = reading.text(self.about)
        try:
            about = reading.json_text(text, str(self.about))
        except InputError as error:
            raise InputError(f"{self.about} is damaged: {error}") from None
        if isinstance(about, dict) and about.get("format") != FORMAT:
            raise InputError(f"{self.about}: the format is {about.get('format')!r}, this version reads {FORMAT}")
        try:
            typed(about, _About)
        except msgspec.ValidationError as error:
            raise InputError(f"{self.about} is damaged: {error}; put a whole copy in its place") from None
        if not writing.is_sealed(text.encode()):
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
            writing.write(self.about, json.dumps({**about, "study": msgspec.to_builtins(study)}, indent=1) + "\n")
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
        """The directory with other runs kept out; the system frees the lock of a process, however it ended."""
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

    def _lock_file(self) -> IO[bytes]:
        writing.check_name(self.path)
        try:
            self.path.mkdir(parents=True, exist_ok=True)
            if not self.about.exists() and not all(map(self._begun, self.path.iterdir())):
                raise InputError(f"{self.path} holds no study but other files; choose an empty or a new directory")
            return self.lock.open("a+b")
        except OSError as error:
            raise InputError(
                f"{self.path} cannot be written: {error.strerror}; a study there can be read and asked for its status, "
                "not run"
            ) from None

    def _begun(self, file: Path) -> bool:
        # a run may have been killed while it wrote the first of its files
        return file.name == self.lock.name or file.name.startswith(f".{self.about.name}")


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
    """A hash of what a study says, whatever its file looks like.

    Examples
    --------
    >>> first = read_study({"problem": {"order": 4}, "vary": {"B": [1.6]}})
    >>> digest(first) == digest(read_study({"vary": {"B": [1.6]}, "problem": {"order": 4}}))
    True
    """
    return hashlib.sha256(json.dumps(msgspec.to_builtins(study), sort_keys=False).encode()).hexdigest()


def _listed(numbers: dict[str, str]) -> str:
    return ", ".join(f"{name} {number}" for name, number in numbers.items())
