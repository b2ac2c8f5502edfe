"""Names and kinds that are imported at their first use, so that importing a package costs nothing."""

from __future__ import annotations

import sys
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, MutableMapping
from importlib import import_module
from types import ModuleType
from typing import Any, TypeVar

from optlaws.locks import process_lock

T = TypeVar("T")

_MODULES: defaultdict[str, dict[str, str]] = defaultdict(dict)


#: modules of libraries that import each other in circles, which two threads must not begin at different ends
_IN_CIRCLES = ("numpy", "numpy.polynomial")
_circles = process_lock()


def imported(module: str) -> ModuleType:
    """A module of optlaws, imported at the first use, in whichever thread.

    Modules of optlaws import each other in no circle, and none from its package while that imports it, so that threads
    may import several at once. numpy is not so, and comes first and whole. The lock is for it alone: for
    modules of optlaws, it would wait for one that waits for the lock.

    Examples
    --------
    >>> imported("optlaws.numbers").__name__
    'optlaws.numbers'
    """
    with _circles:
        for library in _IN_CIRCLES:
            import_module(library)
    return import_module(module)


def face(
    package: str, modules: Mapping[str, str], *, removed: Mapping[str, str] | None = None
) -> tuple[Callable[[str], Any], Callable[[], list[str]], list[str]]:
    """`__getattr__`, `__dir__` and `__all__` of a package or module whose names live in other modules (PEP 562).

    Type checkers read the same names in the `.pyi` beside it, which `python -m tests.contracts.faces` writes.

    Parameters
    ----------
    package
        Its dotted name.
    modules
        Names, separated by blanks, by the module that has them.
    removed
        What to use in place of names of the version before.

    Examples
    --------
    >>> __getattr__, __dir__, names = face("optlaws", {"optlaws.numbers": "deg", "math": "pi PI"})
    >>> names
    ['PI', 'deg', 'pi']
    >>> __getattr__("deg")(180.0)
    3.141592653589793
    >>> __getattr__, __dir__, names = face("optlaws", {"math": "tau"}, removed={"pi": "take tau / 2"})
    >>> __getattr__("pi")
    Traceback (most recent call last):
    ImportError: optlaws has no pi any more: take tau / 2
    """
    homes = {name: module for module, names in modules.items() for name in names.split()}

    def load(name: str) -> Any:
        if removed and name in removed:
            # no AttributeError, whose words `from package import name` leaves out
            raise ImportError(f"{package} has no {name} any more: {removed[name]}", name=package)
        if name not in homes:
            raise AttributeError(f"module {package!r} has no attribute {name!r}", name=name, obj=sys.modules[package])
        value = getattr(imported(homes[name]), name)
        setattr(sys.modules[package], name, value)
        return value

    # tables, whose names are in capitals, come first
    names = sorted(homes, key=lambda name: (len(name) == 1 or not name.isupper(), name))
    return load, lambda: sorted({*vars(sys.modules[package]), *names}), names


def declare(subject: str, modules: Mapping[str, str]) -> None:
    """Declare the module that registers the given names of a subject, separated by blanks."""
    _MODULES[subject].update({name: module for module, names in modules.items() for name in names.split()})


class Registry(MutableMapping[str, T]):
    """Registry of the names of a subject; declared names are imported when they are first used.

    Examples
    --------
    >>> from optlaws.laws.storage import StoredLaw
    >>> sorted(StoredLaw.kinds), StoredLaw.kinds["piecewise"].__name__
    (['loader', 'piecewise', 'polynomial'], 'PiecewiseLaw')
    """

    def __init__(self, subject: str) -> None:
        self._modules = _MODULES[subject]
        self._values: dict[str, T] = {}

    def __getitem__(self, name: str) -> T:
        module = self._modules.get(name)
        # a class is registered before the rest of its module has run: another thread's import is waited for
        if module is not None and (module in sys.modules or name not in self._values):
            imported(module)
        return self._values[name]

    def __setitem__(self, name: str, value: T) -> None:
        self._values[name] = value

    def __delitem__(self, name: str) -> None:
        del self._values[name]

    def __contains__(self, name: object) -> bool:
        return name in self._values or name in self._modules

    def __iter__(self) -> Iterator[str]:
        return iter({**self._modules, **self._values})

    def __len__(self) -> int:
        return len({**self._modules, **self._values})
