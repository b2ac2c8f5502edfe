"""Properties that are computed at their first use and cached, without a lock, and former names of properties."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import nullcontext
from functools import cached_property
from typing import Any, TypeVar
from warnings import warn

_T = TypeVar("_T")


class kept_property(cached_property[_T]):  # noqa: N801 - as the one of functools
    """A `functools.cached_property` without a lock, as in Python 3.12, for Python 3.11 too.

    There one lock serves all objects of a class while the value of one is computed: two threads whose properties
    need each other's wait for ever, and so does the child of a fork by another thread. Without it a value may be
    computed twice, which does no harm: it is the same.

    Examples
    --------
    >>> class Circle:
    ...     radius = 2.0
    ...
    ...     @kept_property
    ...     def area(self) -> float:
    ...         return 3.0 * self.radius**2
    >>> Circle().area
    12.0
    """

    def __init__(self, func: Callable[[Any], _T]) -> None:
        super().__init__(func)
        self.lock = nullcontext()


def former_name(name: str, of: str) -> Any:
    """A property by the name that it had in the version before: it reads the present one, with a DeprecationWarning.

    Examples
    --------
    >>> class Circle:
    ...     diameter = 4.0
    ...     width = former_name("width", "diameter")
    >>> import warnings
    >>> with warnings.catch_warnings(record=True, action="always") as caught:
    ...     print(Circle().width, caught[0].message)
    4.0 Circle.width is called Circle.diameter now
    """

    def read(self: Any) -> Any:
        kind = type(self).__name__
        warn(f"{kind}.{name} is called {kind}.{of} now", DeprecationWarning, stacklevel=2)
        return getattr(self, of)

    return property(read)
