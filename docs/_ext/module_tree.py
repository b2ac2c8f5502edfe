"""The rooms in docs/architecture.md: the folders of the package with the first lines of their docstrings.

The tree comes into the page when it is built.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from sphinx.application import Sphinx

ROOT = Path(__file__).resolve().parents[2]
MARK = "<!-- the tree -->\n"
_INDENT = "  "
_COLUMN = 30


def summary(file: Path) -> str:
    """The first line of a module's docstring."""
    return (ast.get_docstring(ast.parse(file.read_text("utf-8"))) or "").partition("\n")[0]


def lines(folder: Path, depth: int = 0) -> Iterator[str]:
    """A line for each folder of Python modules, those within it below it."""
    yield _line(depth, f"{folder.name}/", summary(folder / "__init__.py"))
    for package in sorted(path.parent for path in folder.glob("*/__init__.py")):
        yield from lines(package, depth + 1)


def _line(depth: int, name: str, sentence: str) -> str:
    return f"{_INDENT * depth + name:<{_COLUMN}}{sentence}"


def tree() -> str:
    """All rooms as a block of text."""
    return "\n".join(["```text", *lines(ROOT / "optlaws"), "```", ""])


def _fill(_app: Sphinx, page: str, source: list[str]) -> None:
    if page == "architecture":
        source[0] = source[0].replace(MARK, tree())


def setup(app: Sphinx) -> dict[str, bool]:
    """Fill the page as it is read."""
    app.connect("source-read", _fill)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
