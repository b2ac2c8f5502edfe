"""The rooms in docs/architecture.md: the folders of the package with the first lines of their docstrings.

`python docs/_ext/module_tree.py` writes it again; tests/test_documents.py holds the page to it.
"""

import ast
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "architecture.md"
BEGIN, END = "<!-- the tree, made by docs/_ext/module_tree.py -->\n", "<!-- end of the tree -->\n"
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


def page_with_tree(page: str) -> str:
    """The page with the rooms of today."""
    before, _, rest = page.partition(BEGIN)
    _, _, after = rest.partition(END)
    return f"{before}{BEGIN}\n{tree()}\n{END}{after}"


if __name__ == "__main__":
    PAGE.write_text(page_with_tree(PAGE.read_text("utf-8")), "utf-8")
