"""What to say of a name that is not known."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches

from optlaws.echo import shortened

_LONGEST_NAME = 100


def unknown_key(name: object, known: Iterable[str], what: str = "key") -> str:
    """A sentence that names the nearest right name, or all of them.

    Examples
    --------
    >>> unknown_key("monoton", ["monotone", "order"])
    "unknown key 'monoton'; did you mean 'monotone'?"
    """
    names = sorted(known)
    near = get_close_matches(name, names, n=1) if isinstance(name, str) and len(name) <= _LONGEST_NAME else []
    if near:
        return f"unknown {what} {name!r}; did you mean {near[0]!r}?"
    return f"unknown {what} {shortened(name)}; known are {', '.join(names)}"
