"""Writing of files: completely or not at all, and over other contents only where that is allowed.

Whoever else writes the same file at the same moment: the file of one of them is there, and nothing is lost unseen.
"""

from __future__ import annotations

import json
import os
import re
import stat
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from decimal import Decimal
from functools import partial
from pathlib import Path
from typing import Any

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.files.reading import is_number, storable
from optlaws.tolerances import SHOWN_DIGITS

_FILE_NOISE = 1e-9  # numbers of two files that differ by less say the same: a gap of 1e-10 is as good as one of 1e-9
_PEAK_PLACE = 1e-6  # of k: the place of a smooth peak is known to the root of rounding alone

# a printed number of so many digits was rounded, one of fewer is meant so
ROUNDED = 6
# in units of a picture, which is some 500 wide
PICTURE = 0.05

_NUMBER = re.compile(r"(?<![\w#.])-?\d+(?:\.\d+)?(?:[eE][+-]?\d+)?(?!\w)")
_PROOFS = {"certificate", "power_certificate"}
# names that matplotlib makes of a digest of what they name
_NAME = re.compile(r"\b[mp][0-9a-f]{10}\b")
# a path of a picture that is straight between its places
_LINES = re.compile(r' d="M ([-\d.e\s]+(?:L[-\d.e\s]+)+)"')
# where each start of a search led: which of them were lost is rounding
_WORKING = {"starts"}


def say_the_same(first: bytes, second: bytes, kind: str, digits: int | None = None) -> bool:
    """Whether two contents of a file differ in rounding alone; the kind is the ending of the file's name.

    In JSON numbers must be equal in eight digits, or as many as mean something, within a list in those of its greatest,
    and places of peaks may differ by 1e-6; a proof is the same if it proves the same, whatever the multipliers behind
    it. In tables the last of six or more digits may differ by one, in pictures places by 0.05, and a line may have more
    places on its way. Others must be equal.

    Examples
    --------
    >>> say_the_same(b"C = 5.5721384", b"C = 5.5721385", ".md"), say_the_same(b"C = 5.57", b"C = 5.58", ".md")
    (True, False)
    """
    if first == second:
        return True
    if kind not in {".json", ".csv", ".md", ".svg"}:
        return False
    try:
        texts = [content.decode() for content in (first, second)]
        if kind == ".json":
            values = [json.loads(text) for text in texts]
            return _same_values(*values, relative=SHOWN_DIGITS if digits is None else 10.0**-digits)
    except ValueError:
        return False
    if kind == ".svg":
        return _same_pictures(*map(_renamed, texts))
    return _same_texts(*texts, digits=digits)


def _same_pictures(first: str, second: str) -> bool:
    lines = [[_places(path[1]) for path in _LINES.finditer(text)] for text in (first, second)]
    return (
        len(lines[0]) == len(lines[1])
        and all(_on_line(a, b) and _on_line(b, a) for a, b in zip(*lines, strict=True))
        and _same_texts(*(_LINES.sub("", text) for text in (first, second)), picture=True)
    )


def _places(path: str) -> list[complex]:
    return [complex(float(x), float(y)) for x, y in map(str.split, path.split("L"))]


def _on_line(places: list[complex], line: list[complex]) -> bool:
    """Whether places lie, one after the other, on the straight pieces between those of a line."""
    piece = 0
    for place in places:
        while _distance(place, line[piece], line[min(piece + 1, len(line) - 1)]) > PICTURE:
            piece += 1
            if piece == len(line):
                return False
    return abs(places[0] - line[0]) <= PICTURE and abs(places[-1] - line[-1]) <= PICTURE


def _distance(place: complex, start: complex, stop: complex) -> float:
    along = stop - start
    share = ((place - start) * along.conjugate()).real / abs(along) ** 2 if along else 0.0
    return abs(place - start - min(max(share, 0.0), 1.0) * along)


def _renamed(picture: str) -> str:
    order = {name: f"name-{i}-" for i, name in enumerate(dict.fromkeys(_NAME.findall(picture)))}
    return _NAME.sub(lambda match: order[match[0]], picture)


def _same_texts(first: str, second: str, *, picture: bool = False, digits: int | None = None) -> bool:
    if _words(first) != _words(second):
        return False
    numbers = zip(_NUMBER.findall(first), _NUMBER.findall(second), strict=True)
    return all(a == b or _same_printed(Decimal(a), Decimal(b), picture=picture, digits=digits) for a, b in numbers)


def _words(text: str) -> list[str]:
    # a table is as wide as its numbers
    return re.sub(r"-{2,}", "--", _NUMBER.sub("#", text)).split()


def _same_printed(first: Decimal, second: Decimal, *, picture: bool, digits: int | None) -> bool:
    off = abs(first - second)
    parts = [number.as_tuple() for number in (first, second)]
    last = min(int(part.exponent) for part in parts)
    if off <= _FILE_NOISE or last >= 0 or max(len(part.digits) for part in parts) < min(ROUNDED, digits or ROUNDED):
        return off <= _FILE_NOISE
    allowed = Decimal(1).scaleb(last)
    if picture:
        allowed = max(allowed, Decimal(str(PICTURE)))
    if digits is not None:
        allowed = max(allowed, max(abs(first), abs(second)).scaleb(-digits))
    return off <= allowed


def _same_values(first: Any, second: Any, *, relative: float, key: str = "", scale: float = 0.0) -> bool:
    if isinstance(first, dict) and isinstance(second, dict):
        return first.keys() == second.keys() and all(
            _same_values(first[name], second[name], relative=relative, key=name)
            for name in first
            if not (name in _WORKING or (key in _PROOFS and isinstance(first[name], list)))
        )
    if isinstance(first, list) and isinstance(second, list):
        scale = max((abs(value) for value in [*first, *second] if is_number(value)), default=0.0)
        return len(first) == len(second) and all(
            _same_values(a, b, relative=relative, key=key, scale=scale) for a, b in zip(first, second, strict=True)
        )
    if is_number(first) and is_number(second):
        allowed = max(_FILE_NOISE, relative * max(scale, abs(first), abs(second)), _PEAK_PLACE if key == "k" else 0.0)
        return bool(first == second or abs(first - second) <= allowed)
    if isinstance(first, str) and isinstance(second, str):
        return _same_texts(first, second)
    return first is second


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
        f"there is {named} with other contents, which are not overwritten: --force, or force=True in Python, "
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
