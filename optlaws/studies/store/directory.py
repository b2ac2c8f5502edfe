"""The directory of a study: what it is, who writes in it, and where its parts are."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from importlib.metadata import version
from pathlib import Path
from typing import IO, Annotated, Any

import msgspec

from optlaws.errors import InputError
from optlaws.files import writing
from optlaws.files.typed import typed
from optlaws.studies.points.points import Points
from optlaws.studies.points.study_file import StudyFile, read_study

FORMAT = 1
_LIBRARIES = ("optlaws", "casadi", "numpy", "scipy")


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
        """What the study is: all that `study.json` says, and the study itself.

        Raises
        ------
        InputError
            If there is no study, or one of another format.
        """
        try:
            about = msgspec.json.decode(self.about.read_bytes(), strict=True)
        except (FileNotFoundError, NotADirectoryError):
            raise InputError(f"{self.path} holds no study; optlaws study FILE --out {self.path} makes one") from None
        except OSError as error:
            raise InputError(f"{self.about} cannot be read: {error.strerror}") from None
        except (ValueError, RecursionError) as error:
            raise InputError(f"{self.about} is damaged: {error}") from None
        if isinstance(about, dict) and about.get("format") != FORMAT:
            raise InputError(f"{self.about}: the format is {about.get('format')!r}, this version reads {FORMAT}")
        try:
            typed(about, _About)
        except msgspec.ValidationError as error:
            raise InputError(f"{self.about} is damaged: {error}; put a whole copy in its place") from None
        return about, read_study(about["study"])

    def claim(self, study: StudyFile, points: Points) -> int:
        """Make the directory this study's, or see that it is, and return the number of points of its chunks.

        Raises
        ------
        InputError
            If it holds another study, or an unfinished one of other versions of the libraries.
        """
        mine: dict[str, Any] = {"format": FORMAT, "hash": digest(study), "versions": versions()}
        if not self.about.exists():
            about = {"about": writing.MARK, "title": study.title, **mine, "points": len(points), "chunk": points.chunk}
            writing.write(self.about, json.dumps({**about, "study": msgspec.to_builtins(study)}, indent=1) + "\n")
            return points.chunk
        about, _ = self.read()
        if about["hash"] != mine["hash"]:
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
        """Keep other runs out; the system frees the lock of a process that ended, however it ended.

        Raises
        ------
        InputError
            If another run has it, or the directory holds other files and no study.
        """
        with self._lock_file() as stream:
            try:
                locked = _lock(stream)
            except OSError as error:
                raise InputError(
                    f"{self.lock} cannot be locked: {error.strerror}; put the study on a file system with locks"
                ) from None
            if not locked:
                raise InputError(f"{self.path} is in use by another run{self._owner(stream)}")
            stream.truncate(0)
            stream.write(str(os.getpid()).encode())
            stream.flush()
            yield

    def _owner(self, stream: IO[bytes]) -> str:
        # some systems let nobody read what another process has locked
        with suppress(OSError):
            stream.seek(0)
            if owner := stream.read().decode(errors="replace").strip():
                return f", process {owner}"
        return ""

    def _lock_file(self) -> IO[bytes]:
        writing.check_name(self.path)
        try:
            self.path.mkdir(parents=True, exist_ok=True)
            if not self.about.exists() and any(not self._own(file.name) for file in self.path.iterdir()):
                raise InputError(f"{self.path} holds no study but other files; choose an empty or a new directory")
            return self.lock.open("a+b")
        except OSError as error:
            raise InputError(
                f"{self.path} cannot be written: {error.strerror}; a study there can be read and asked for its status, "
                "not run"
            ) from None

    def _own(self, name: str) -> bool:
        # a run may have been killed while it wrote the first of its files
        return name == self.lock.name or name.startswith(f".{self.about.name}")

    def in_use(self) -> bool:
        """Whether a run writes in it now."""
        # whoever may only read can see it as well; what cannot be asked is not in use by this user
        for mode in ("r+b", "rb"):
            with suppress(OSError), self.lock.open(mode) as stream:
                return not _lock(stream)
        return False


def digest(study: StudyFile) -> str:
    """A hash of what a study says, whatever its file looks like.

    Examples
    --------
    >>> first = read_study({"problem": {"order": 4}, "vary": {"B": [1.6]}})
    >>> digest(first) == digest(read_study({"vary": {"B": [1.6]}, "problem": {"order": 4}}))
    True
    """
    return hashlib.sha256(json.dumps(msgspec.to_builtins(study), sort_keys=False).encode()).hexdigest()


def versions() -> dict[str, str]:
    """Versions of the libraries that shape the results."""
    return {name: version(name) for name in _LIBRARIES}


def _listed(numbers: dict[str, str]) -> str:
    return ", ".join(f"{name} {number}" for name, number in numbers.items())


def _lock(stream: IO[bytes]) -> bool:
    """Whether the file is this process's alone until it is closed."""
    from filelock import lock_descriptor

    return lock_descriptor(stream.fileno(), blocking=False)
