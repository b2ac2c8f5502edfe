"""How values are handed to controllers: each asks for it by name; exports, a layer above, say how it is done."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

from optlaws.lazy import Registry

Hand = TypeVar("Hand", bound=Callable[..., Any])

_WAYS: Registry[Callable[..., Any]] = Registry("exporting")


def exports(name: str) -> Callable[[Hand], Hand]:
    """Register a function that makes of a value what a controller takes.

    Examples
    --------
    >>> @exports("a point")
    ... def point(value, to):
    ...     return f"{value} for {to}"
    >>> exported("a point", 3, to="csv")
    '3 for csv'
    """

    def registered(function: Hand) -> Hand:
        _WAYS[name] = function
        return function

    return registered


def exported(way: str, value: Any, /, *given: Any, **said: Any) -> Any:  # noqa: ANN401 - made a layer above
    """What is made of a value; what makes it is imported now."""
    return _WAYS[way](value, *given, **said)
