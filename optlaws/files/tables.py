"""Tables as CSV and Markdown; the same cells give the same bytes."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence

from optlaws.files.writing import MARK

Cell = str | float | int | None


def to_csv(columns: Sequence[str], rows: Sequence[Sequence[Cell]], *, about: str, digits: int = 8) -> str:
    """CSV with a first comment line; numbers to so many significant digits, nothing for None."""
    stream = io.StringIO()
    stream.write(f"# {about}; {MARK}\n")
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows([_text(cell, digits) for cell in row] for row in rows)
    return stream.getvalue()


def to_markdown(columns: Sequence[str], rows: Sequence[Sequence[Cell]], *, digits: int = 7) -> str:
    """A Markdown table with aligned columns."""
    cells = [list(columns), *([_text(cell, digits) for cell in row] for row in rows)]
    widths = [max(len(row[i]) for row in cells) for i in range(len(columns))]
    lines = ["| " + " | ".join(c.ljust(w) for c, w in zip(row, widths, strict=True)) + " |" for row in cells]
    lines.insert(1, "|" + "|".join("-" * (w + 2) for w in widths) + "|")
    return "\n".join(lines) + "\n"


def _text(cell: Cell, digits: int) -> str:
    if cell is None:
        return ""
    if isinstance(cell, float):
        return f"{cell:.{digits}g}"
    return str(cell)
