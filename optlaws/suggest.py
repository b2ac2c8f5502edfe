"""What to say of a name that is not known."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches


def unknown_key(name: str, known: Iterable[str], what: str = "key") -> str:
    """A sentence that names the nearest right name, or all of them.

    Examples
    --------
    >>> unknown_key("monoton", ["monotone", "order"])
    "unknown key 'monoton'; did you mean 'monotone'?"
    """
    names = sorted(known)
    near = get_close_matches(name, names, n=1)
    if near:
        return f"unknown {what} {name!r}; did you mean {near[0]!r}?"
    return f"unknown {what} {name!r}; known are {', '.join(names)}"
