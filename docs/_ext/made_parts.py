"""Parts of pages that are made of what the code declares when the pages are built, each in place of its mark."""

from __future__ import annotations

import re
from functools import partial
from inspect import getdoc
from typing import TYPE_CHECKING, Any, Literal, get_args, get_origin

from docs._ext.entry_tables import TABLES
from docs._ext.module_tree import tree
from docs._ext.option_tables import option_tables
from optlaws import catalogue, typing
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


def _types() -> dict[str, Any]:
    """The types of optlaws.typing by their names."""
    return {name: getattr(typing, name) for name in sorted(vars(typing)["__all__"])}


def choices() -> str:
    """The types of strings with a few choices, and their words."""
    words = {name: get_args(kind) for name, kind in _types().items() if get_origin(kind) is Literal}
    rows = [f"| `{name}` | {', '.join(f'`{word}`' for word in some)} |" for name, some in words.items()]
    return "\n".join(["| Name | Words |", "|---|---|", *rows])


def values() -> str:
    """The classes that annotations name, with the first sentence of each."""
    classes = {name: kind for name, kind in _types().items() if isinstance(kind, type) and kind is not Any}
    rows = [f"| `{name}` | {str(getdoc(kind)).partition(chr(10))[0]} |" for name, kind in classes.items()]
    return "\n".join(["| Name | What it is |", "|---|---|", *rows])


#: by the page the parts, and by the mark of each what makes it
PARTS: Mapping[str, Mapping[str, Callable[[], str]]] = {
    "architecture": {"<!-- the tree -->": tree},
    "how-to/catalogue": {"<!-- the catalogue -->": catalogue_table},
    "reference/api/results": {"<!-- the choices -->": choices, "<!-- the values -->": values},
    "reference/problem-files": {f"<!-- entries of {name} -->": made for name, made in TABLES.items()},
    "reference/command-line": {f"<!-- options of {name} -->": partial(option_tables, name) for name in COMMANDS},
}


def with_parts(page: str, text: str) -> str:
    """The text of a page with its parts."""
    for mark, made in PARTS.get(page, {}).items():
        if mark not in text:
            raise ValueError(f"{page} has no mark {mark}")
        text = text.replace(mark, made())
    if left := re.findall(r"<!-- (?:entries|options) of .*? -->", text):
        raise ValueError(f"{page} has marks of no part: {', '.join(left)}")
    return text


def _fill(_app: Sphinx, page: str, source: list[str]) -> None:
    source[0] = with_parts(page, source[0])


def setup(app: Sphinx) -> dict[str, bool]:
    """Fill pages as they are read."""
    app.connect("source-read", _fill)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
