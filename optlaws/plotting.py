"""How values come to be drawn: each asks for its drawing by name; pictures, a layer above, say how it is made."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

from optlaws.lazy import Registry

Draw = TypeVar("Draw", bound=Callable[..., list[Any]])

_DRAWINGS: Registry[Callable[..., list[Any]]] = Registry("drawing")


def draws(name: str) -> Callable[[Draw], Draw]:
    """Register a function that draws a value into axes, new ones where it is given None, and returns the artists.

    Examples
    --------
    >>> @draws("a point")
    ... def draw_point(value, axes=None):
    ...     return [value]
    >>> plotted("a point", 3)
    [3]
    """

    def registered(function: Draw) -> Draw:
        _DRAWINGS[name] = function
        return function

    return registered


def plotted(name: str, value: Any, ax: Any = None, **style: Any) -> list[Any]:  # noqa: ANN401 - matplotlib is not known here
    """The artists of a value, drawn as its name says; what draws it is imported now."""
    return _DRAWINGS[name](value, ax, **style)
