"""Steps of long work as a bar, for whoever watches: on a terminal or in a notebook, and only where it takes long."""

from __future__ import annotations

import sys
from collections.abc import Iterator
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

_hidden = False


def watched() -> bool:
    """Whether someone sees a bar: stderr is a terminal, or this is a notebook that can show one."""
    if _hidden or current_thread() is not main_thread():
        return False
    notebook = "ipykernel" in sys.modules and find_spec("ipywidgets") is not None
    return notebook or (sys.stderr is not None and sys.stderr.isatty())


@contextmanager
def without_bars() -> Iterator[None]:
    """Hide progress bars for the time of a `with` block, as another display reports the progress."""
    global _hidden  # noqa: PLW0603 - of the one terminal that a process has
    before, _hidden = _hidden, True
    try:
        yield
    finally:
        _hidden = before


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
