"""What a page of the reference shows of a module: its public names, which are those of the stubs.

`:members:` of an `automodule` stands for them; names that follow it, which functions return or extensions use, are
shown as well. A module without a name in a stub is shown as autodoc does.
"""

from __future__ import annotations

import ast
import re
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from sphinx.application import Sphinx

ROOT = Path(__file__).resolve().parents[2]
_MEMBERS = re.compile(r"^(\.\. automodule:: (\S+)\n   :members:)(.*)$", re.MULTILINE)


@cache
def public_names() -> dict[str, list[str]]:
    """The names of all stubs by the module that has them."""
    names: dict[str, list[str]] = {}
    for stub in sorted((ROOT / "optlaws").rglob("*.pyi")):
        package = ".".join(stub.parent.relative_to(ROOT).parts)
        for node in ast.parse(stub.read_text("utf-8")).body:
            if isinstance(node, ast.ImportFrom) and node.module:
                names.setdefault(f"{package}.{node.module}", []).extend(alias.name for alias in node.names)
    return names


def with_names(page: str) -> str:
    r"""A page with the public names of its modules.

    >>> print(with_names(".. automodule:: optlaws.cams.conjugate\n   :members: Pair"))
    .. automodule:: optlaws.cams.conjugate
       :members: conjugate_cam, Pair
    """

    def listed(found: re.Match[str]) -> str:
        names = dict.fromkeys(public_names().get(found[2], []))
        names |= dict.fromkeys(name.strip() for name in found[3].split(",") if name.strip())
        return f"{found[1]} {', '.join(names)}".rstrip()

    return _MEMBERS.sub(listed, page)


def _fill(_app: Sphinx, page: str, source: list[str]) -> None:
    if page.startswith("reference/api/"):
        source[0] = with_names(source[0])


def setup(app: Sphinx) -> dict[str, bool]:
    """Fill pages as they are read."""
    app.connect("source-read", _fill)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
