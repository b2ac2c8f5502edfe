"""Locks of the whole process, for libraries that only one thread may use at a time."""

from __future__ import annotations

import os
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
    if hasattr(os, "register_at_fork"):
        os.register_at_fork(before=lock.acquire, after_in_parent=lock.release, after_in_child=lock.release)
    return lock


#: neither CasADi's counts of references, nor a solver's memory, nor MUMPS stand two threads
casadi_lock = process_lock()
