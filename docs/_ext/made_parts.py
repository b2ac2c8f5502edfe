"""Parts of pages that are made of what the code declares when the pages are built, each in place of its mark."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from docs._ext.entry_tables import TABLES
from docs._ext.module_tree import tree
from docs._ext.option_tables import option_tables
from optlaws import catalogue
from optlaws.cli.app import COMMANDS

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from sphinx.application import Sphinx


def catalogue_table() -> str:
    """The standard laws with their constants, names and sources."""
    headings = ("law", "built", "B", "C", "D", "J", "continuous to", "other names", "source")
    lines = [headings, ["---"] * len(headings)]
    for entry in catalogue.values():
        numbers = [f"{getattr(entry.constants, name).value:.7g}" for name in "BCDJ"]
        names = "; ".join(f"{language}: {', '.join(some)}" for language, some in entry.names if language != "short")
        source = entry.source + (" (**from memory**)" if entry.from_memory else "")
        order = ("a", "b", "c", "j", "j'")[entry.continuity]
        lines.append([entry.name, entry.formula, *numbers, order, names.replace("english: ", ""), source])
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


#: by the page the parts, and by the mark of each what makes it
PARTS: Mapping[str, Mapping[str, Callable[[], str]]] = {
    "architecture": {"<!-- the tree -->": tree},
    "how-to/catalogue": {"<!-- the catalogue -->": catalogue_table},
    "reference/problem-files": {f"<!-- entries of {name} -->": made for name, made in TABLES.items()},
    "reference/command-line": {f"<!-- options of {name} -->": partial(option_tables, name) for name in COMMANDS},
}


def with_parts(page: str, text: str) -> str:
    """The text of a page with its parts."""
    for mark, made in PARTS.get(page, {}).items():
        if mark not in text:
            raise ValueError(f"{page} has no mark {mark}")
        text = text.replace(mark, made())
    return text


def _fill(_app: Sphinx, page: str, source: list[str]) -> None:
    source[0] = with_parts(page, source[0])


def setup(app: Sphinx) -> dict[str, bool]:
    """Fill pages as they are read."""
    app.connect("source-read", _fill)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
