"""Kinds of followers by their names: every module of this folder may bring one."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import MISSING, fields
from functools import cache
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules
from typing import Any

from optlaws.cams.followers.follower import Follower
from optlaws.errors import InputError
from optlaws.suggest import unknown_key


def follower_kinds() -> dict[str, type[Follower]]:
    """The kinds of followers by their names in problem files.

    Examples
    --------
    >>> "translating roller" in follower_kinds()
    True
    """
    _load()
    # slides before arms, whichever was imported first
    return dict(sorted(Follower.kinds.items(), reverse=True))


def follower_names() -> str:
    """Names of the classes, as an error lists them.

    Examples
    --------
    >>> follower_names().split()[:2]
    ['TranslatingRoller,', 'TranslatingFlat,']
    """
    *names, last = [kind.__name__ for kind in follower_kinds().values()]
    return f"{', '.join(names)} or {last}"


def read_follower(entries: Mapping[str, Any]) -> Follower:
    """A follower from entries of a problem file.

    Raises
    ------
    InputError
        If its kind is unknown, or it has an entry that its kind does not take, or lacks one.

    Examples
    --------
    >>> read_follower({"kind": "translating roller", "radius": "12 mm"})
    TranslatingRoller(radius='12 mm', offset='0 mm')
    """
    kinds = follower_kinds()
    if "kind" not in entries:
        raise InputError(f"follower: kind is missing: give one of {', '.join(kinds)}")
    if entries["kind"] not in kinds:
        raise InputError(f"follower: {unknown_key(entries['kind'], kinds, 'kind')}")
    kind = kinds[entries["kind"]]
    given = {name: value for name, value in entries.items() if name != "kind"}
    named = f"{'an' if kind.kind[0] in 'aeiou' else 'a'} {kind.kind}"
    taken: dict[str, Any] = {field.name: field.default for field in fields(kind)}  # type: ignore[arg-type]
    for name in given:
        if name not in taken:
            raise InputError(f"follower: {named} takes no {name}; it takes {', '.join(taken) or 'no entries'}")
    for name, default in taken.items():
        if name not in given and default is MISSING:
            raise InputError(f"follower: {named} needs its {name}, such as {name} = '{kind.examples[name]}'")
    follower: Follower = kind(**given)
    return follower


@cache
def _load() -> None:
    """Import the modules of the folder, by which their kinds are known."""
    for module in iter_modules([str(Path(__file__).parent)]):
        import_module(f"{__package__}.{module.name}")
