"""Names and kinds that are imported at their first use, so that importing a package costs nothing; and locks.

A lock is of the whole process, for libraries that only one thread may use at a time.
"""

from __future__ import annotations

import os
import sys
from collections import defaultdict, deque
from collections.abc import Callable, Iterator, Mapping, MutableMapping
from importlib import import_module
from threading import RLock
from types import ModuleType
from typing import TYPE_CHECKING, Any, TypeVar

from lazy_loader import attach_stub

if TYPE_CHECKING:
    from _thread import RLock as Lock


def process_lock() -> Lock:
    """A lock that is free in a forked child, with its data in a consistent state.

    A fork waits until no thread holds it: a child has none of its parent's other threads, so that one of them could
    neither finish its work nor give the lock back there.
    """
    lock = RLock()
    _locks.append(lock)
    return lock


_locks: list[Lock] = []


def _acquire_all() -> None:
    """Acquire every lock, waiting for one only while none of the others is held.

    A thread may hold one lock and wait for another, in whatever order: to wait with one in hand could be for ever.
    """
    waiting = deque(_locks)
    while True:
        waiting[0].acquire()
        busy = next((i for i in range(1, len(waiting)) if not waiting[i].acquire(blocking=False)), None)
        if busy is None:
            return
        for i in range(busy):
            waiting[i].release()
        waiting.rotate(-busy)


def _release_all() -> None:
    for lock in _locks:
        lock.release()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(before=_acquire_all, after_in_parent=_release_all, after_in_child=_release_all)

#: neither CasADi's counts of references, nor a solver's memory, nor MUMPS stand two threads
casadi_lock = process_lock()


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
    _import_circles()
    return import_module(module)


def _import_circles() -> None:
    with _circles:
        for library in _IN_CIRCLES:
            import_module(library)


def face(
    module: str, file: str, *, removed: Mapping[str, str] | None = None
) -> tuple[Callable[[str], Any], Callable[[], list[str]], list[str]]:
    """`__getattr__`, `__dir__` and `__all__` of a package or module whose names live in other modules (PEP 562).

    The `.pyi` beside it says which, to type checkers as well: `from .numbers import deg as deg`, from its package.

    Parameters
    ----------
    module, file
        Its `__name__` and `__file__`.
    removed
        What to use in place of names of the version before.

    Examples
    --------
    >>> import optlaws
    >>> __getattr__, __dir__, names = face("optlaws", optlaws.__file__, removed={"pi": "take math.pi"})
    >>> names[:4]
    ['FUNCTIONALS', 'Advice', 'AdvisedLaw', 'After']
    >>> __getattr__("deg")(180.0)
    3.141592653589793
    >>> __getattr__("pi")
    Traceback (most recent call last):
    ImportError: optlaws has no pi any more: take math.pi
    """
    namespace = vars(sys.modules[module])
    package = namespace["__package__"]
    load, _, names = attach_stub(package, file)
    # tables, whose names are in capitals, come first
    names.sort(key=lambda name: (len(name) == 1 or not name.isupper(), name))

    def load_as_own(name: str) -> Any:
        if removed and name in removed:
            # no AttributeError, whose words `from package import name` leaves out
            raise ImportError(f"{module} has no {name} any more: {removed[name]}", name=module)
        if name not in names:
            from optlaws.spelling import known_spelling

            other = known_spelling(name, names)
            if other != name:
                return load_as_own(other)
            raise AttributeError(f"module {module!r} has no attribute {name!r}", name=name, obj=sys.modules[module])
        _import_circles()
        namespace[name] = load(name)
        if package != module:
            # the stub's loader has kept it as a name of the package, which has others
            vars(sys.modules[package]).pop(name, None)
        return namespace[name]

    return load_as_own, lambda: sorted({*namespace, *names}), names


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
