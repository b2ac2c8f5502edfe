"""Tables that cannot be changed, for values that are compared, hashed and solved once."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NoReturn, Self

from optlaws.motion.quantities import written


class FrozenTable(dict[str, Any]):
    """A table whose entries cannot be set, added or removed; it is equal to a plain one, and hashed by its entries.

    Examples
    --------
    >>> limits = FrozenTable(velocity="1 m/s")
    >>> limits["velocity"] = "2 m/s"
    Traceback (most recent call last):
    TypeError: a value is not changed once it is there: make another, as with dataclasses.replace
    >>> limits == {"velocity": "1 m/s"}, {**limits, "jerk": "90 m/s^3"}
    (True, {'velocity': '1 m/s', 'jerk': '90 m/s^3'})
    """

    def __hash__(self) -> int:  # type: ignore[override] # a dict has none
        return hash(frozenset(self.items()))

    def _refuse(self, *_: object, **__: object) -> NoReturn:
        """Refused: a value is not changed."""
        raise TypeError("a value is not changed once it is there: make another, as with dataclasses.replace")

    __setitem__ = __delitem__ = __ior__ = _refuse
    clear = pop = popitem = setdefault = update = _refuse

    def __copy__(self) -> Self:
        return self

    def __deepcopy__(self, _: object) -> Self:
        return self

    def __reduce__(self) -> tuple[type[Self], tuple[dict[str, Any]]]:
        return type(self), (dict(self),)


#: no entry has tables or lists within each other so often: what has is refused by whoever reads it
_DEEPEST = 20


def frozen(value: Any, depth: int = 0) -> Any:
    """A value with its tables frozen and its lists as tuples, as far down as entries go; other values unchanged.

    >>> frozen({"acceleration": ["-8 m/s^2", "12 m/s^2"], "motor": True})
    {'acceleration': ('-8 m/s^2', '12 m/s^2'), 'motor': True}
    """
    if depth > _DEEPEST:
        return value
    if isinstance(value, Mapping):
        return FrozenTable({name: frozen(entry, depth + 1) for name, entry in value.items()})
    return tuple(frozen(entry, depth + 1) for entry in value) if type(value) in {list, tuple} else value


def thawed(value: Any) -> Any:
    """A value with its frozen tables and tuples as plain tables and lists, which can be changed and stored.

    >>> thawed(frozen({"motor": {"ratio": (1, 2)}}))
    {'motor': {'ratio': [1, 2]}}
    """
    if isinstance(value, Mapping):
        return {name: thawed(entry) for name, entry in value.items()}
    return [thawed(entry) for entry in value] if type(value) in {list, tuple} else written(value)
