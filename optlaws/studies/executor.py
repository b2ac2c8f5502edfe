"""Executors of chunks: watched processes of this machine unless another executor is given.

Any executor may run `solve_chunk`, in processes or in threads, on this machine or on others: the solver, which holds
the interpreter's lock, works in processes of its own. One that dies or takes too long costs one point, never the study.
"""

from __future__ import annotations

import atexit
import os
import signal
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from contextlib import contextmanager, suppress
from dataclasses import replace
from queue import Empty, SimpleQueue
from threading import Lock, Thread
from time import monotonic
from typing import IO, Any, ParamSpec, TypeVar, cast

import msgspec

from optlaws.errors import SolverFailure
from optlaws.files.problem_file import typed
from optlaws.studies.chunk import Task, failed, in_process
from optlaws.studies.worker import DONE, ERROR, READY
from optlaws.synthesis import Status

#: how often a point may lose its process before the point itself is blamed
STRIKES = 3
_STARTS = 10
_START_SECONDS = 300.0
_END_SECONDS = 5.0
_LOOK_SECONDS = 0.25
_READ_BYTES = 1 << 20
#: how long a cluster may be without workers; whoever has to wait for them does so before the study
_LOST_SECONDS = 120.0
# more threads than one would change the order of summation, and with it the last digits
_THREADS = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")

_P = ParamSpec("_P")
_T = TypeVar("_T")
Rows = list[bytes]
_decode = msgspec.json.Decoder(list[msgspec.Raw]).decode


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


class WorkerPool:
    """An executor with the function that it is to run, and how many chunks it is given at a time."""

    def __init__(self, executor: Executor | None, workers: int | None) -> None:
        serial = isinstance(executor, Serial)
        count = workers or getattr(executor, "_max_workers", None)
        count = count if isinstance(count, int) else cores()
        self._processes = Processes() if executor is None else None
        self._executor = executor or ThreadPoolExecutor(count, thread_name_prefix="study")
        self._solve = self._processes.solve if self._processes else in_process if serial else solve_chunk
        self._client: Any = getattr(executor, "_client", None)
        self._empty_since: float | None = None
        # one chunk more for each worker than it works on, so that none waits
        self.most = 1 if serial else 2 * count

    def submit(self, task: Mapping[str, Any]) -> Future[Rows]:
        """The chunk's rows to come."""
        return self._executor.submit(self._solve, task)

    def check(self) -> None:
        """Refuse to wait for a Dask cluster without workers; other executors report lost workers themselves."""
        workers = getattr(self._client, "ncores", None)
        if not callable(workers) or workers():
            self._empty_since = None
            return
        now = monotonic()
        self._empty_since = self._empty_since or now
        if now - self._empty_since >= _LOST_SECONDS:
            raise SolverFailure(
                f"the cluster has had no worker for {_LOST_SECONDS:g} s; what is solved is safe: start workers, wait "
                "for them by client.wait_for_workers(1), and run the same study again"
            )

    def close(self) -> None:
        """Stop what is under way; an executor that was given stays open."""
        if self._processes is not None:
            self._processes.close()
            self._executor.shutdown(wait=True, cancel_futures=True)


def cores() -> int:
    """The processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


class Stopped(Exception):  # noqa: N818 - what happened, not an error
    """The processes were closed while a chunk was being solved."""


class Lost(Exception):  # noqa: N818 - as above
    """A process that ended before it answered, or whose row did not come in time (`late`)."""

    def __init__(self, reason: str = "", *, late: bool = False) -> None:
        super().__init__(reason)
        self.late = late


class Processes:
    """Solver processes of one run; a thread takes one for the time of a chunk."""

    def __init__(self) -> None:
        self._lock = Lock()
        self._idle: list[SolverProcess] = []
        self._busy: set[SolverProcess] = set()
        self._closed = False

    def solve(self, data: Mapping[str, Any]) -> Rows:
        """The rows of a chunk.

        A point that takes longer than the time limit is given up, and its process with it. A chunk whose process dies
        is begun again, so that its rows come out as they would have; a point that has lost three processes is given up.
        Points that are solved together have a time limit together; where they exceed it, or lose three processes, each
        is solved alone. `Stopped` if `close` came in between, SolverFailure where no process starts or imports.
        """
        task = typed(data, Task)
        rows: Rows = []
        strikes: Counter[int] = Counter()
        begin = 0
        while len(rows) < len(task.points):
            lost = self._advance(task, begin, rows)
            place = len(rows)
            if lost is None or place == len(task.points):
                continue
            strikes[place] += 1
            if not lost.late and strikes[place] < STRIKES:
                continue
            if not task.alone:
                # of points that are solved together nobody knows which one it was
                task, strikes = replace(task, alone=True), Counter()
                continue
            if lost.late:
                row = failed(task, place, Status.TIME_LIMIT, f"no answer within {task.time_limit:g} s", task.time_limit)
            else:
                row = failed(task, place, Status.DIED, f"its process died {STRIKES} times: {lost}", 0.0)
            rows.append(row)
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

    def _advance(self, task: Task, begin: int, rows: Rows) -> Lost | None:
        """Add rows to those there until the chunk or its process ends; the rows before them are known and pass by."""
        seen = begin
        try:
            with self._process() as process:
                for block in process.blocks(task, begin):
                    if seen == len(rows):
                        rows += block
                    seen += len(block)
        except Lost as lost:
            # a row that came in time before is not to blame for a machine that has become slow
            return Lost("slow") if lost.late and seen < len(rows) else lost
        return None

    @contextmanager
    def _process(self) -> Iterator[SolverProcess]:
        """A process that is ready, idle again afterwards unless it failed."""
        process, usable = self._ready(), False
        try:
            yield process
            usable = True
        finally:
            self._return(process, usable=usable)

    def _ready(self) -> SolverProcess:
        with self._lock:
            if self._closed:
                raise Stopped
            if self._idle:
                process = self._idle.pop()
                self._busy.add(process)
                return process
        for _ in range(_STARTS):
            process, ready = SolverProcess(), False
            with self._lock:
                self._busy.add(process)
                closed = self._closed
            try:
                if not closed:
                    process.wait_ready()
                    ready = True
                    return process
            except Lost:
                continue
            finally:
                if not ready:
                    self._return(process, usable=False)
        raise SolverFailure(f"solver processes are killed before they start, {_STARTS} times in turn")

    def _return(self, process: SolverProcess, *, usable: bool) -> None:
        with self._lock:
            self._busy.discard(process)
            closed = self._closed
            if usable and not closed:
                self._idle.append(process)
                return
        process.clear()
        if closed:
            raise Stopped


class SolverProcess:
    """A process that solves chunks, and the pipes to it; worker.py is its side."""

    def __init__(self) -> None:
        environment = {**os.environ, **_THREADS, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
        self._complaints = tempfile.TemporaryFile()  # noqa: SIM115 - it lives as long as the process
        self._process = subprocess.Popen(
            [sys.executable, "-m", "optlaws.studies.worker"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._complaints,
            env=environment,
            start_new_session=True,  # Ctrl-C is for the run, which then ends its processes
        )
        self._input, self._output = cast("tuple[IO[bytes], IO[bytes]]", (self._process.stdin, self._process.stdout))
        self._cleared = False
        self._lines: SimpleQueue[bytes] = SimpleQueue()
        self._reader = Thread(target=self._read, daemon=True)
        self._reader.start()

    def wait_ready(self) -> None:
        """Wait until the process has imported its modules; SolverFailure with its message if it cannot."""
        try:
            first = self._line(_START_SECONDS)
        except Lost as lost:
            self._complaints.seek(0)
            complaint = self._complaints.read().decode(errors="replace").strip().splitlines()
            if not lost.late and not complaint:
                raise
            raise SolverFailure(
                f"a solver process did not start: {complaint[-1] if complaint else 'it does not answer'}"
            ) from None
        if first != READY:
            raise SolverFailure(f"a solver process did not start: it wrote {first!r}")

    def blocks(self, task: Task, begin: int) -> Iterator[Rows]:
        """The rows of a chunk from a point on, in blocks as they come; SolverFailure where more than a point fails."""
        try:
            self._input.write(msgspec.json.encode((begin, task)) + b"\n")
            self._input.flush()
        except OSError:
            raise self._end() from None
        while (line := self._line(task.time_limit)) != DONE:
            if line.startswith(ERROR):
                raise SolverFailure(line.removeprefix(ERROR).decode())
            yield list(map(bytes, _decode(line)))

    def kill(self) -> None:
        """End it at once, with all that it started; whoever waits for a row meets `Lost`."""
        if sys.platform == "win32":
            self._process.kill()
            return
        # it leads a group of its own; the group may be there when the process is gone
        with suppress(ProcessLookupError, PermissionError):
            os.killpg(self._process.pid, signal.SIGKILL)

    def clear(self) -> None:
        """End the process and release its resources."""
        self.kill()
        self._cleared = True
        with suppress(subprocess.TimeoutExpired):
            self._process.wait(_END_SECONDS)
        # a process that left the group may hold the pipe open: the reader is then left to end with it
        self._reader.join(_END_SECONDS)
        for stream in (self._input, self._output, self._complaints):
            # what was still to be written has no reader any more
            with suppress(OSError):
                stream.close()

    def _read(self) -> None:
        # without the stream's buffer, whose lock would keep `clear` from closing it
        parts: Rows = []
        while not self._cleared and (more := os.read(self._output.fileno(), _READ_BYTES)):
            *lines, rest = more.split(b"\n")
            for line in lines:
                self._lines.put(b"".join([*parts, line]))
                parts.clear()
            parts.append(rest)
        self._lines.put(b"")

    def _line(self, seconds: float) -> bytes:
        until = monotonic() + seconds
        while True:
            gone = self._process.poll() is not None
            left = until - monotonic()
            try:
                if line := self._lines.get(timeout=min(max(left, 0.0), _LOOK_SECONDS)):
                    return line
                raise self._end()
            except Empty:
                if gone:
                    # its pipe is held open by a process that it started
                    raise self._end() from None
                if left <= _LOOK_SECONDS:
                    raise Lost(late=True) from None

    def _end(self) -> Lost:
        try:
            status = self._process.wait(_END_SECONDS)
        except subprocess.TimeoutExpired:
            return Lost("its output was closed")
        return Lost(f"signal {-status}" if status < 0 else f"exit status {status}")


_shared = Processes()
atexit.register(_shared.close)


def solve_chunk(task: Mapping[str, Any]) -> Rows:
    """The rows of a chunk, by a watched process of this process; for executors of any kind."""
    return _shared.solve(task)
