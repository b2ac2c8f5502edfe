"""Writing results: whole or not at all, and never over a file that was not made here."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

MARK = "made by optlaws"


def write(file: Path, content: str | bytes) -> Path:
    """Replace a file at once. A file already there without the mark "made by optlaws" is kept as `name.orig`.

    Every content passed must hold the mark, so that the next run knows its own files.
    """
    data = content.encode() if isinstance(content, str) else content
    file.parent.mkdir(parents=True, exist_ok=True)
    if file.exists() and MARK.encode() not in file.read_bytes():
        file.replace(_free_name(file))
    handle, name = tempfile.mkstemp(dir=file.parent, prefix=f".{file.name}.")
    try:
        with os.fdopen(handle, "wb") as stream:
            stream.write(data)
        Path(name).chmod(0o644)
        Path(name).replace(file)
    except BaseException:
        Path(name).unlink(missing_ok=True)
        raise
    return file


def _free_name(file: Path) -> Path:
    kept = file.with_name(f"{file.name}.orig")
    count = 1
    while kept.exists():
        kept = file.with_name(f"{file.name}.orig{count}")
        count += 1
    return kept
