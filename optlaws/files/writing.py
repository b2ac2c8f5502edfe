"""Writing of files: completely or not at all, and over other contents only where that is allowed.

Whoever else writes the same file at the same moment: the file of one of them is there, and nothing is lost unseen.
"""

from __future__ import annotations

import os
import re
import stat
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from functools import partial
from pathlib import Path

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.files.comparison import say_the_same
from optlaws.files.reading import storable

MARK = "made by optlaws"

_DEVICES = {"con", "prn", "aux", "nul", "conin$", "conout$"} | {
    f"{port}{i}" for port in ("com", "lpt") for i in range(10)
}
_BLANK = 32
_NAMED = 5  # files in an error
#: behind the mark the version before wrote a digest of the file
_DIGEST = re.compile(MARK.encode() + rb" [0-9a-f]{16}(?=\r?$|\"|<|\)| -->)", re.MULTILINE)
_forced: ContextVar[bool] = ContextVar("_forced", default=False)


@contextmanager
def forced() -> Iterator[None]:
    """Within this every file is written over whatever is there, as by `--force`."""
    token = _forced.set(True)
    try:
        yield
    finally:
        _forced.reset(token)


def write(
    file: Path, content: str | bytes, *, digits: int | None = None, exact: bool = False, force: bool = False
) -> Path:
    """Write a file in a single step, unless its contents agree already.

    A file that says the same but for rounding (see `comparison`; `digits` is how many mean something) is left as it is,
    unless every digit counts (`exact`), as in files that a machine follows. A new file has the rights that the umask
    leaves, a replaced one those it had.

    Raises
    ------
    InputError
        If the file is there with other contents, and these are not to be replaced (`force`).
    """
    check_name(file)
    data = content.encode() if isinstance(content, str) else content
    over = force or _forced.get()
    with _named(file):
        while True:
            there = _content(file)
            if there is not None and _agree(there, data, file.suffix, digits, exact=exact):
                return file
            if there is not None and not over:
                raise _refused([file])
            if _put(file, data, over=over):
                return file


def check_free(contents: Sequence[tuple[Path, bytes, bool]], *, digits: int | None = None, force: bool = False) -> None:
    """Refuse to write several files, each exact or not, of which some are there with other contents."""
    for file, _, _ in contents:
        check_name(file)
    if force or _forced.get():
        return
    there = [(file, _content(file), data, exact) for file, data, exact in contents]
    other = [
        file
        for file, known, data, exact in there
        if known is not None and not _agree(known, data, file.suffix, digits, exact=exact)
    ]
    if other:
        raise _refused(other)


def _refused(files: Sequence[Path]) -> InputError:
    more = f" and {len(files) - _NAMED} more" if len(files) > _NAMED else ""
    named = ", ".join(str(file) for file in files[:_NAMED]) + more
    return InputError(
        f"there is {named} with other contents, and nothing is written over them: --force, or force=True in Python, "
        "replaces them; or choose another place"
    )


#: how to take back what was written within `all_or_none`
_written: ContextVar[list[Callable[[], object]] | None] = ContextVar("_written", default=None)


@contextmanager
def all_or_none(*, but: tuple[type[BaseException], ...] = ()) -> Iterator[None]:
    """Within this all files are written or, on an error other than these, none: each place is as it was before.

    Examples
    --------
    >>> try:
    ...     with all_or_none():
    ...         _ = write(Path("laws", "first.txt"), f"first; {MARK}")
    ...         raise InputError("the second has no stroke")
    ... except InputError:
    ...     Path("laws").exists()
    False
    """
    if _written.get() is not None:
        yield
        return
    undo: list[Callable[[], object]] = []
    token = _written.set(undo)
    try:
        yield
    except BaseException as error:
        if not isinstance(error, but):
            for step in reversed(undo):
                step()
        raise
    finally:
        _written.reset(token)


def _remember(file: Path) -> None:
    """Note how a place is taken back to what it is now; folders that are made for it go if they are left empty."""
    undo = _written.get()
    if undo is None:
        return
    folders = [folder for folder in reversed(file.absolute().parents) if not folder.exists()]
    undo += [partial(_remove_empty, folder) for folder in folders]
    there = file.read_bytes() if file.is_file() else None
    undo.append(partial(file.unlink, missing_ok=True) if there is None else partial(file.write_bytes, there))


def _remove_empty(folder: Path) -> None:
    with suppress(OSError):
        folder.rmdir()


@contextmanager
def _named(file: Path) -> Iterator[None]:
    """Report errors of the system with the user's file name, not with the temporary copy's."""
    try:
        yield
    except OSError as error:
        if error.errno is not None:
            error.filename = str(file)
        raise


def _agree(there: bytes, data: bytes, kind: str, digits: int | None, *, exact: bool) -> bool:
    """Whether contents are the same, or differ in rounding alone where not every digit counts."""
    plain = _DIGEST.sub(MARK.encode(), there)
    return plain == data if exact else say_the_same(plain, data, kind, digits)


def _content(file: Path) -> bytes | None:
    """Content of a file; None if there is nothing of its name."""
    try:
        return file.read_bytes()
    except FileNotFoundError:
        # a link that leads nowhere is there
        return b"" if os.path.lexists(file) else None


def _put(file: Path, data: bytes, *, over: bool) -> bool:
    """Write data to a file in a single step; False if another file has come by its name meanwhile."""
    _remember(file)
    file.parent.mkdir(parents=True, exist_ok=True)
    copy = _beside(file)
    try:
        # made as any new file is, so that the umask holds
        with copy.open("xb") as stream:
            stream.write(data)
        if not over:
            return _placed(copy, file)
        if os.path.lexists(file) and stat.S_ISREG(mode := file.lstat().st_mode):
            copy.chmod(stat.S_IMODE(mode))
        copy.replace(file)
    except BaseException:
        copy.unlink(missing_ok=True)
        raise
    return True


def _placed(copy: Path, file: Path) -> bool:
    """Give a copy its name, unless another has come by it meanwhile."""
    try:
        os.link(copy, file)
    except FileExistsError:
        copy.unlink()
        return False
    except OSError:
        # no links here
        if os.path.lexists(file):
            copy.unlink()
            return False
        copy.replace(file)
        return True
    copy.unlink()
    return True


def _beside(file: Path) -> Path:
    from secrets import token_hex

    return file.with_name(f".{file.name[:100]}.{token_hex(8)}")


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
