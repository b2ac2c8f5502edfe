"""Writing of results: completely or not at all, never over a user's file, and only where contents have changed.

Whoever else writes the same file at the same moment: the file of one of them is there, and what a user had is kept.
Every file carries the mark "made by optlaws" with a seal, a digest of all else that it holds, so that an edit shows.
"""

from __future__ import annotations

import os
import re
import stat
import struct
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from itertools import count
from pathlib import Path
from zlib import crc32

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.files.comparison import say_the_same
from optlaws.files.reading import storable

MARK = "made by optlaws"

_DEVICES = {"con", "prn", "aux", "nul", "conin$", "conout$"} | {
    f"{port}{i}" for port in ("com", "lpt") for i in range(10)
}
_BLANK = 32
_PNG = b"\x89PNG"
_SEALED = MARK.encode() + rb"(?: ([0-9a-f]{16}))?"
_IN_TEXT = re.compile(_SEALED + rb"(?=\r?$|\"|<|\)| -->)", re.MULTILINE)
_IN_PNG = re.compile(rb"(?<=tEXtSoftware\0)" + _SEALED)


def write(file: Path, content: str | bytes, *, digits: int | None = None, exact: bool = False) -> Path:
    """Replace a file in a single step, unless its contents agree already.

    A file that is there and was not written by optlaws, or was changed since, is kept as `name.orig`; one that says the
    same but for rounding (see `comparison`; `digits` is how many mean something) is left as it is, unless every digit
    counts (`exact`), as in files that a machine follows. A new file has the rights that the umask leaves, a replaced
    one those it had.

    Every content passed must hold the mark "made by optlaws", at the end of a line, a text or an entry; the seal is
    put behind it.
    """
    check_name(file)
    data = content.encode() if isinstance(content, str) else content
    with _named(file):
        there = _content(file)
        plain = _unsealed(there)[0]
        same = plain == data if exact else say_the_same(plain, data, file.suffix, digits)
        if not (is_sealed(there) and same):
            _put(file, sealed(data))
    return file


def write_any(file: Path, content: str) -> Path:
    """Replace a file at once by a text that may have no mark, as formats of controllers have no place for one.

    A file with other contents is kept as `name.orig`, unless its seal shows that optlaws wrote all of it.
    """
    if MARK in content:
        return write(file, content, exact=True)
    check_name(file)
    with _named(file):
        if _content(file) != content.encode():
            _put(file, content.encode())
    return file


@contextmanager
def _named(file: Path) -> Iterator[None]:
    """Report errors of the system with the user's file name, not with the temporary copy's."""
    try:
        yield
    except OSError as error:
        if error.errno is not None:
            error.filename = str(file)
        raise


def is_current(file: Path, content: bytes, *, digits: int | None = None) -> bool:
    """Whether a file was written by optlaws, is unchanged, and agrees with given contents up to rounding."""
    there = _content(file)
    return is_sealed(there) and say_the_same(_unsealed(there)[0], content, file.suffix, digits)


def is_own(file: Path) -> bool:
    """Whether a file was written by optlaws and is unchanged: its seal matches its contents.

    Line ends count for nothing: some systems change them on their own.
    """
    return is_sealed(_content(file))


def _content(file: Path) -> bytes:
    """Content of a file; empty if there is no such file."""
    try:
        return file.read_bytes() if file.is_file() else b""
    except FileNotFoundError:
        return b""


def is_sealed(content: bytes) -> bool:
    """Whether contents carry a matching seal."""
    plain, seal = _unsealed(content)
    return seal is not None and seal == _seal(plain)


def sealed(content: bytes) -> bytes:
    """The content with the seal behind its mark.

    Examples
    --------
    >>> sealed(b"# about; made by optlaws")
    b'# about; made by optlaws a554eb6dcb07b0e4'
    """
    plain, _ = _unsealed(content)
    mark = _mark(plain)
    if mark is None:
        raise ValueError(f"what is written must hold the mark {MARK!r}")
    return _with_mark(plain, mark, f"{MARK} {_seal(plain)}".encode())


def _unsealed(data: bytes) -> tuple[bytes, str | None]:
    """The content as it was passed, and its seal, if it has one."""
    mark = _mark(data)
    if mark is None or mark[1] is None:
        return data, None
    return _with_mark(data, mark, MARK.encode()), mark[1].decode()


def _mark(data: bytes) -> re.Match[bytes] | None:
    return (_IN_PNG if data.startswith(_PNG) else _IN_TEXT).search(data)


def _with_mark(data: bytes, mark: re.Match[bytes], new: bytes) -> bytes:
    if data.startswith(_PNG):
        return data.replace(_chunk(mark[0]), _chunk(new), 1)
    return data[: mark.start()] + new + data[mark.end() :]


def _seal(content: bytes) -> str:
    from hashlib import sha256

    plain = content if content.startswith(_PNG) else content.replace(b"\r\n", b"\n")
    return sha256(plain).hexdigest()[:16]


def _chunk(mark: bytes) -> bytes:
    """The part of a PNG file that names its author program."""
    text = b"tEXtSoftware\0" + mark
    return struct.pack(">I", len(text) - 4) + text + struct.pack(">I", crc32(text))


def _put(file: Path, data: bytes) -> None:
    """Write data to a file in a single step, even with concurrent writers: a user's existing file is kept."""
    file.parent.mkdir(parents=True, exist_ok=True)
    copy = _beside(file)
    try:
        # made as any new file is, so that the umask holds
        with copy.open("xb") as stream:
            stream.write(data)
        while not (_replaced(copy, file) if os.path.lexists(file) else _placed(copy, file)):
            pass
    except BaseException:
        copy.unlink(missing_ok=True)
        raise


def _placed(copy: Path, file: Path) -> bool:
    """Give a copy its name, unless another has come by it meanwhile."""
    try:
        os.link(copy, file)
    except FileExistsError:
        return False
    except OSError:
        # no links here
        copy.replace(file)
        return True
    copy.unlink()
    return True


def _replaced(copy: Path, file: Path) -> bool:
    """Put a copy in the place of a file; a user's file is kept first, unless it has vanished meanwhile."""
    try:
        mode = file.lstat().st_mode
        _keep(file)
    except FileNotFoundError:
        return False
    if stat.S_ISREG(mode):
        copy.chmod(stat.S_IMODE(mode))
    # what is there now is what was kept, or what another process of ours has put there
    copy.replace(file)
    return True


def _keep(file: Path) -> None:
    """Keep a foreign file as `name.orig`, through a second name, so that it exists at all times."""
    seen = _beside(file)
    try:
        os.link(file, seen, follow_symlinks=False)
    except FileNotFoundError:
        raise
    except OSError:
        _keep_copy(file)
        return
    try:
        if is_own(seen):
            return
        for copy in _free_names(file):
            try:
                os.link(seen, copy, follow_symlinks=False)
            except FileExistsError:
                if not os.path.samestat(copy.lstat(), seen.lstat()):
                    continue
            return
    finally:
        seen.unlink(missing_ok=True)


def _keep_copy(file: Path) -> None:
    """A copy of the user's file where a file cannot have two names."""
    content = file.read_bytes()
    if is_sealed(content):
        return
    for copy in _free_names(file):
        with suppress(FileExistsError), copy.open("xb") as stream:
            stream.write(content)
            return


def _beside(file: Path) -> Path:
    from secrets import token_hex

    return file.with_name(f".{file.name[:100]}.{token_hex(8)}")


def _free_names(file: Path) -> Iterator[Path]:
    yield file.with_name(f"{file.name}.orig")
    yield from (file.with_name(f"{file.name}.orig{number}") for number in count(1))


def check_place(file: Path) -> None:
    """Refuse a file that could not be written, before the work whose result it shall hold; nothing is left behind.

    Examples
    --------
    >>> check_place(Path("/dev/null/law.json"))
    Traceback (most recent call last):
    optlaws.errors.InputError: cannot write /dev/null/law.json: /dev/null is not a folder
    """
    from tempfile import TemporaryFile

    check_name(file)
    if file.is_dir():
        raise InputError(f"cannot write {file}: it is a folder")
    folder = next(parent for parent in file.absolute().parents if parent.exists())
    if not folder.is_dir():
        raise InputError(f"cannot write {file}: {folder} is not a folder")
    try:
        with TemporaryFile(dir=folder):
            pass
    except OSError as error:
        raise InputError(f"cannot write {file}: {error.strerror or error}") from None


def check_name(file: Path) -> None:
    """Refuse a name that a system or a command would take for something else.

    Examples
    --------
    >>> check_name(Path("con.csv"))
    Traceback (most recent call last):
    optlaws.errors.InputError: 'con.csv' cannot be the name of a file: it is that of a device; choose another
    """
    name = file.name
    why = ""
    if not storable(str(file)) or any(ord(character) < _BLANK for character in name):
        why = "it holds NUL, surrogates or control characters"
    elif name.startswith("-"):
        why = "a command would take it for an option"
    elif name.endswith((" ", ".")):
        why = "it ends with a blank or a dot"
    elif name.partition(".")[0].rstrip().lower() in _DEVICES:
        why = "it is that of a device"
    if why:
        raise InputError(f"{shortened(name)} cannot be the name of a file: {why}; choose another")
