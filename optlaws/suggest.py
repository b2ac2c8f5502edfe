"""What to say of a name that is not known."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from difflib import get_close_matches

from optlaws.echo import shortened

#: what people call the constants of a law
CONSTANTS = {"velocity": "B", "speed": "B", "acceleration": "C", "power": "D", "jerk": "J", "snap": "jounce"}

_LONGEST_NAME = 100


def unknown_key(
    name: object, known: Iterable[str], what: str = "key", *, words: Mapping[str, str] | None = None
) -> str:
    """A sentence that names the nearest right name, or all of them; `words` are other words for some of them.

    Examples
    --------
    >>> unknown_key("monoton", ["monotone", "order"])
    "unknown key 'monoton'; did you mean 'monotone'?"
    >>> unknown_key("rms_C", ["rms_c", "rms_j"], "constant")
    "unknown constant 'rms_C'; did you mean 'rms_c'?"
    >>> unknown_key("jerk", ["C", "J"], "constant", words={"jerk": "J"})
    "unknown constant 'jerk'; did you mean 'J'?"
    """
    names = sorted(known)
    near = _nearest(name, names, words or {}) if isinstance(name, str) and len(name) <= _LONGEST_NAME else None
    if near is not None:
        return f"unknown {what} {name!r}; did you mean {near!r}?"
    return f"unknown {what} {shortened(name)}; known are {', '.join(names)}"


def _nearest(name: str, names: list[str], words: Mapping[str, str]) -> str | None:
    """The name but for its case, one that another word stands for, or one that is written alike."""
    folded = name.casefold()
    same = [known for known in names if known.casefold() == folded]
    meant = [known for word, known in words.items() if word in folded.split("_") and known in names]
    return next(iter([*same, *meant, *get_close_matches(name, names, n=1)]), None)
