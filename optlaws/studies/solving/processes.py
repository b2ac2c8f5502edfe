"""Processes that solve chunks, watched: one that dies or takes too long costs one point, never the study.

Any executor may run `solve_chunk`, in processes or in threads, on this machine or on others: the solver, which holds
the interpreter's lock, works in processes of its own.
"""

from __future__ import annotations

import atexit
from collections import Counter
from collections.abc import Mapping
from threading import Lock
from typing import Any

import msgspec

from optlaws.errors import SolverFailure
from optlaws.files.typed import typed
from optlaws.studies.solving.solving import DIED, TIME_LIMIT, Task, failed
from optlaws.studies.solving.worker import Died, SolverProcess, TookTooLong

#: how often a point may lose its process before the point itself is blamed
STRIKES = 3
_STARTS = 10


class Stopped(Exception):  # noqa: N818 - what happened, not an error
    """The processes were closed while a chunk was being solved."""


class Processes:
    """Solver processes of one run; a thread takes one for the time of a chunk."""

    def __init__(self) -> None:
        self._lock = Lock()
        self._idle: list[SolverProcess] = []
        self._busy: set[SolverProcess] = set()
        self._closed = False

    def solve(self, data: Mapping[str, Any]) -> list[bytes]:
        """The rows of a chunk.

        A point that takes longer than the time limit is given up, and its process with it. A chunk whose process dies
        is begun again, so that its rows come out as they would have; a point that has lost three processes is given up.
        Points that are solved together have a time limit together; where they exceed it, or lose three processes, each
        is solved alone.

        Raises
        ------
        Stopped
            If `close` came in between.
        SolverFailure
            If no process can be started, or a module to be imported is not there.
        """
        task = typed(data, Task)
        rows: list[bytes] = []
        strikes: Counter[int] = Counter()
        begin = 0
        while len(rows) < len(task.points):
            reason = self._advance(task, begin, rows)
            place = len(rows)
            if reason is None or place == len(task.points):
                continue
            strikes[place] += 1
            if not task.alone and (isinstance(reason, TookTooLong) or strikes[place] == STRIKES):
                # of points that are solved together nobody knows which one it was
                task, strikes = msgspec.structs.replace(task, alone=True), Counter()
            elif isinstance(reason, TookTooLong):
                rows.append(failed(task, place, TIME_LIMIT, f"no answer within {task.time_limit:g} s", task.time_limit))
                begin = len(rows)
            elif strikes[place] == STRIKES:
                rows.append(failed(task, place, DIED, f"its process died {STRIKES} times: {reason}", 0.0))
                begin = len(rows)
        return rows

    def close(self) -> None:
        """End all processes; chunks under way raise `Stopped`."""
        with self._lock:
            self._closed = True
            idle, self._idle = self._idle, []
            for process in self._busy:
                process.kill()
        for process in idle:
            process.clear()

    def _advance(self, task: Task, begin: int, rows: list[bytes]) -> Died | TookTooLong | None:
        """Add rows to those found until the chunk or its process ends; the rows before them are known and pass by."""
        process, seen, done = self._taken(), begin, False
        try:
            for row in process.rows(task, begin):
                if seen == len(rows):
                    rows.append(row)
                seen += 1
            done = True
        except Died as reason:
            return reason
        except TookTooLong as reason:
            # a row that came in time before is not to blame for a machine that has become slow
            return reason if seen == len(rows) else Died("slow")
        finally:
            self._given_back(process, usable=done)
        return None

    def _taken(self) -> SolverProcess:
        with self._lock:
            if self._closed:
                raise Stopped
            if self._idle:
                process = self._idle.pop()
                self._busy.add(process)
                return process
        for _ in range(_STARTS):
            process = SolverProcess()
            with self._lock:
                self._busy.add(process)
                closed = self._closed
            ready = False
            try:
                if not closed:
                    process.wait_ready()
                    ready = True
                    return process
            except Died:
                continue
            finally:
                if not ready:
                    self._given_back(process, usable=False)
        raise SolverFailure(f"solver processes are killed before they start, {_STARTS} times in turn")

    def _given_back(self, process: SolverProcess, *, usable: bool) -> None:
        with self._lock:
            self._busy.discard(process)
            closed = self._closed
            if usable and not closed:
                self._idle.append(process)
                return
        process.clear()
        if closed:
            raise Stopped


_own = Processes()
atexit.register(_own.close)


def solve_chunk(task: Mapping[str, Any]) -> list[bytes]:
    """The rows of a chunk, by a watched process of this process; for executors of any kind."""
    return _own.solve(task)
