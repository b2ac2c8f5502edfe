"""The rooms in docs/architecture.md: the folders of the package with the first lines of their docstrings."""

import ast
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
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
