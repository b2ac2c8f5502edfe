"""Steps of long work, for whoever watches: to the command that runs, or as a bar on a terminal or in a notebook."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from threading import current_thread, main_thread
from time import monotonic
from types import TracebackType
from typing import TYPE_CHECKING, Self

if TYPE_CHECKING:
    from rich.progress import Progress, TaskID

#: seconds; what ends before them needs no bar
PATIENCE = 2.0

#: what a command shows of its work: the current step, or a line that stays
Watcher = Callable[[str, bool], None]
_watcher: Watcher | None = None


def watched() -> bool:
    """Whether someone sees a bar: stderr is a terminal, or this is a notebook that can show one."""
    if watches() or current_thread() is not main_thread():
        return False
    notebook = "ipykernel" in sys.modules and find_spec("ipywidgets") is not None
    return notebook or (sys.stderr is not None and sys.stderr.isatty())


def watches() -> bool:
    """Whether a command shows the steps of its work."""
    return _watcher is not None


@contextmanager
def shown_by(watcher: Watcher) -> Iterator[None]:
    """Give a watcher all steps for the time of a `with` block, in place of bars."""
    global _watcher  # noqa: PLW0603 - of the one terminal that a process has
    before, _watcher = _watcher, watcher
    try:
        yield
    finally:
        _watcher = before


def step(text: str, *, stays: bool = False) -> None:
    """Say what is being done, or in a line that stays what has been found, to the command that runs, if one does."""
    if _watcher is not None and current_thread() is main_thread():
        _watcher(text, stays)


class Steps:
    """Progress of one piece of work; a bar appears on stderr if it takes longer than `PATIENCE`.

    Examples
    --------
    >>> with Steps("laws", 3) as steps:
    ...     for done in range(3):
    ...         steps.reach(done + 1)
    """

    def __init__(self, what: str, total: int) -> None:
        self._what = what
        self._total = total
        self._began = monotonic()
        self._bar: tuple[Progress, TaskID] | None = None

    def reach(self, done: int) -> None:
        """Set the number of steps that are done."""
        step(f"{self._what}, {done} of {self._total}")
        if self._bar is None and done < self._total and monotonic() - self._began >= PATIENCE and watched():
            self._bar = self._started()
        if self._bar is not None:
            progress, task = self._bar
            progress.update(task, completed=done)

    def _started(self) -> tuple[Progress, TaskID]:
        from rich.console import Console
        from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

        columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
        progress = Progress(*columns, console=Console(stderr=True), transient=True)
        task = progress.add_task(self._what, total=self._total)
        progress.start()
        return progress, task

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._bar is not None:
            self._bar[0].stop()
            self._bar = None
