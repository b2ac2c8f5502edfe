"""The spelling of names: a name may be written as in British or in American English, and is known by one of them."""

from __future__ import annotations

import re
from collections.abc import Callable, Container, Mapping
from functools import wraps
from inspect import signature
from typing import Any, ParamSpec, TypeVar

P = ParamSpec("P")
R = TypeVar("R")

_OTHER = {"iz": "is", "center": "centre", "catalog": "catalogue", "synthesis": "synthesiz"}
_SPELLED = re.compile(r"(?<=minim)iz|(?<=modern)iz|(?<=optim)iz|center|catalog(?!ue)|synthesis(?=e)")


def other_spelling(name: str) -> str:
    """The name in its other spelling; unchanged where it has one alone."""
    return _SPELLED.sub(lambda part: _OTHER[part[0]], name)


def known_spelling(name: str, known: Container[str]) -> str:
    """The name as it is known, where it is so in its other spelling alone; else unchanged.

    >>> [known_spelling(name, ["minimise", "synthesize"]) for name in ("minimize", "synthesise", "jerk")]
    ['minimise', 'synthesize', 'jerk']
    """
    other = other_spelling(name)
    return other if other in known and name not in known else name


def known_spellings(given: Mapping[Any, Any], known: Container[str]) -> dict[str, Any]:
    """Entries by their names as they are known; one that is there in both spellings keeps its own."""
    spelled = {name: known_spelling(name, known) for name in given if isinstance(name, str)}
    return {(name if (other := spelled.get(name, name)) in given else other): value for name, value in given.items()}


def either_spelling(function: Callable[P, R]) -> Callable[P, R]:
    """A function whose keywords are taken in either spelling.

    >>> either_spelling(lambda *, minimise: minimise)(minimize="jerk")
    'jerk'
    """
    names = signature(function).parameters

    @wraps(function)
    def spelled(*args: P.args, **given: P.kwargs) -> R:
        return function(*args, **known_spellings(given, names))

    return spelled
