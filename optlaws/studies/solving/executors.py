"""Where chunks are solved: watched processes of this machine unless another executor is given."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from typing import Any, ParamSpec, TypeVar

from optlaws.studies.solving.processes import Processes, solve_chunk
from optlaws.studies.solving.solving import in_process

_P = ParamSpec("_P")
_T = TypeVar("_T")
Rows = list[bytes]


class Serial(Executor):
    """Runs what is submitted at once, in the caller's thread, without a watch over it: no time limit.

    Examples
    --------
    >>> Serial().submit(pow, 2, 3).result()
    8
    """

    _max_workers = 1

    def submit(self, fn: Callable[_P, _T], /, *args: _P.args, **kwargs: _P.kwargs) -> Future[_T]:
        """A future that is done."""
        future: Future[_T] = Future()
        try:
            future.set_result(fn(*args, **kwargs))
        except Exception as error:  # noqa: BLE001 - the future hands it on
            future.set_exception(error)
        return future


class Crew:
    """An executor with the function that it is to run, and how many chunks it is given at a time."""

    def __init__(self, executor: Executor | None, workers: int | None) -> None:
        self._processes: Processes | None = None
        if executor is None:
            count = workers or cores()
            self._processes = Processes()
            self._executor: Executor = ThreadPoolExecutor(count, thread_name_prefix="study")
            self._solve: Callable[[Mapping[str, Any]], Rows] = self._processes.solve
        else:
            count = workers or _size(executor)
            self._executor = executor
            self._solve = in_process if isinstance(executor, Serial) else solve_chunk
        self._client: Any = getattr(executor, "_client", None)
        # one chunk more for each worker than it works on, so that none waits
        self.most = 1 if isinstance(executor, Serial) else 2 * count

    def submit(self, task: Mapping[str, Any]) -> Future[Rows]:
        """Have a chunk solved."""
        return self._executor.submit(self._solve, task)

    @property
    def empty(self) -> bool:
        """Whether it is a Dask cluster that has no worker at all; other executors say when theirs are lost."""
        workers = getattr(self._client, "ncores", None)
        return callable(workers) and not workers()

    def close(self) -> None:
        """Stop what is under way; an executor that was given stays open."""
        if self._processes is not None:
            self._processes.close()
            self._executor.shutdown(wait=True, cancel_futures=True)


def cores() -> int:
    """The processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _size(executor: Executor) -> int:
    workers = getattr(executor, "_max_workers", None)
    return workers if isinstance(workers, int) else cores()
