"""Locks of the whole process, for libraries that only one thread may use at a time."""

from __future__ import annotations

import os
from collections import deque
from threading import RLock
from typing import TYPE_CHECKING

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
