"""References and first files from declared entries: tables of Markdown, examples, and commented TOML."""

from __future__ import annotations

import json
from collections.abc import Collection, Iterator

from optlaws.entries.declared import Declared, Entry, TableOf, entries_of


def markdown_table(
    of: type[Declared] | TableOf,
    heading: str = "meaning",
    apart: Collection[str] = (),
    without: type[Declared] | None = None,
) -> str:
    """The entries of a declared class, or of a table, as one of Markdown: a row for each, and for those of its tables.

    Those of the entries `apart` have tables of their own elsewhere, and so have those of the class `without`.

    >>> from optlaws.entries.declared import ValueOf, declared, entry
    >>> from optlaws.entries.value_types import Number
    >>> @declared
    ... class Damper(Declared, title="a damper"):
    ...     damping: float = entry(Number(least=0.0), "The damping ratio.", default=0.0)
    >>> @declared
    ... class Door(Declared, title="a door"):
    ...     damper: Damper | None = entry(ValueOf(Damper), "What slows it.", default=None)
    >>> print(markdown_table(Door))
    | entry | meaning |
    |---|---|
    | `damper` | What slows it. A damper, a table. |
    | `damper.damping` | The damping ratio. A number from 0 on; 0.0 unless given. |
    """
    left = {} if without is None else entries_of(without)
    entries = of.entries if isinstance(of, TableOf) else entries_of(of)
    shown = [each for each in entries.values() if each.shown and each.name not in left]
    rows = [row for each in shown for row in _rows(each, "", apart)]
    return "\n".join([f"| entry | {heading} |", "|---|---|", *rows])


def _rows(each: Entry, place: str, apart: Collection[str], of: str = "") -> Iterator[str]:
    """The row of an entry, and those of the entries of its table, which say the kinds that have them."""
    name = f"{place}{each.name}"
    yield f"| `{name}`{of} | {_sentence(each)} |"
    tables = {} if name in apart else each.type.tables()
    if kinds := ", ".join(f'"{kind}"' for kind in tables if kind):
        yield f"| `{name}.kind` | One of {kinds}. |"
    having: dict[int, tuple[Entry, list[str]]] = {}
    for kind, entries in tables.items():
        for inner in (inner for inner in entries.values() if inner.shown):
            same = next((key for key, (known, _) in having.items() if known == inner), len(having))
            having.setdefault(same, (inner, []))[1].append(f'"{kind}"')
    for inner, owners in having.values():
        yield from _rows(inner, f"{name}.", apart, f" of {', '.join(owners)}" if len(owners) < len(tables) else "")


def _sentence(each: Entry) -> str:
    words = each.type.words
    default = each.default if isinstance(each.default, str | tuple) and each.default else each.plain_default
    usual = "needed" if each.needed else "" if default is None else f"{json.dumps(default)} unless given"
    such = "" if each.example is None else f", such as `{json.dumps(each.example)}`"
    return f"{each.about} {words[:1].upper()}{words[1:]}{such}{'; ' if usual else ''}{usual}."


def sentences(cls: type[Declared]) -> dict[str, str]:
    """What the entries of a declared class say, by their names, and those of its tables; of one name its own."""
    known = entries_of(cls).values()
    texts = {each.name: each.about for each in known}
    for each in known:
        for entries in each.type.tables().values():
            texts |= {name: below.about for name, below in entries.items() if name not in texts}
    return texts
