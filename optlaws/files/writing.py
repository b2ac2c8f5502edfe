"""Writing results: whole or not at all, and never over a file that was not made here."""

from __future__ import annotations

from pathlib import Path
from secrets import token_hex

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.files.reading import storable

MARK = "made by optlaws"

_DEVICES = {"con", "prn", "aux", "nul", "conin$", "conout$"} | {
    f"{port}{i}" for port in ("com", "lpt") for i in range(10)
}
_BLANK = 32


def write(file: Path, content: str | bytes) -> Path:
    """Replace a file at once. A file already there without the mark "made by optlaws" is kept as `name.orig`.

    Every content passed must hold the mark, so that the next run knows its own files. A new file has the rights that
    the umask leaves, a replaced one those it had.

    Raises
    ------
    InputError
        If the name is none for a file: see `check_name`.
    """
    check_name(file)
    data = content.encode() if isinstance(content, str) else content
    file.parent.mkdir(parents=True, exist_ok=True)
    if file.exists() and MARK.encode() not in file.read_bytes():
        file.replace(_free_name(file))
    mode = file.stat().st_mode & 0o777 if file.exists() else None
    copy = file.with_name(f".{file.name[:100]}.{token_hex(8)}")
    try:
        # made as any new file is, so that the umask holds
        with copy.open("xb") as stream:
            stream.write(data)
        if mode is not None:
            copy.chmod(mode)
        copy.replace(file)
    except BaseException:
        copy.unlink(missing_ok=True)
        raise
    return file


def check_name(file: Path) -> None:
    """Refuse a name that a system or a command would take for something else.

    Raises
    ------
    InputError
        If the name holds NUL, a surrogate or another control character, begins with "-", ends with a blank or a dot,
        or is that of a device such as con, nul or com1, whatever its ending.

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


def _free_name(file: Path) -> Path:
    kept = file.with_name(f"{file.name}.orig")
    count = 1
    while kept.exists():
        kept = file.with_name(f"{file.name}.orig{count}")
        count += 1
    return kept
