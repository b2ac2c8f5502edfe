"""A solver process and the pipes to it."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import tempfile
from collections import deque
from collections.abc import Iterator
from contextlib import suppress
from queue import Empty, SimpleQueue
from threading import Thread
from time import monotonic
from typing import IO

import msgspec

from optlaws.errors import SolverFailure
from optlaws.studies.solving.solving import Task
from optlaws.studies.solving.worker_process import DONE, ERROR, READY

_START_SECONDS = 300.0
_END_SECONDS = 5.0
_LOOK_SECONDS = 0.25
_READ_BYTES = 1 << 20
_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


class Died(Exception):  # noqa: N818 - what happened, not an error of this program
    """The process ended before it answered."""


class TookTooLong(Exception):  # noqa: N818 - as above
    """A row did not come in time."""


class SolverProcess:
    """One process that serves chunks; see worker_process.py for its side."""

    def __init__(self) -> None:
        # more threads than one would change the order of summation, and with it the last digits
        environment = os.environ | dict.fromkeys(_THREADS, "1")
        environment["PYTHONPATH"] = os.pathsep.join(path for path in sys.path if path)
        self._complaints = tempfile.TemporaryFile()  # noqa: SIM115 - it lives as long as the process
        self._process = subprocess.Popen(
            [sys.executable, "-m", "optlaws.studies.solving.worker_process"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._complaints,
            env=environment,
            start_new_session=True,  # Ctrl-C is for the run, which then ends its processes
        )
        self._input, self._output = _pipes(self._process)
        self._cleared = False
        self._came: SimpleQueue[list[bytes]] = SimpleQueue()
        self._waiting: deque[bytes] = deque()
        self._reader = Thread(target=self._read, daemon=True)
        self._reader.start()

    def wait_ready(self) -> None:
        """Wait until it has imported what it needs.

        Raises
        ------
        SolverFailure
            If it cannot, with its complaint.
        Died
            If it was killed.
        """
        try:
            first = self._line(_START_SECONDS)
        except (Died, TookTooLong) as reason:
            self._complaints.seek(0)
            complaint = self._complaints.read().decode(errors="replace").strip().splitlines()
            if isinstance(reason, Died) and not complaint:
                raise
            raise SolverFailure(
                f"a solver process did not start: {complaint[-1] if complaint else 'it does not answer'}"
            ) from None
        if first != READY:
            raise SolverFailure(f"a solver process did not start: it wrote {first!r}")

    def rows(self, task: Task, begin: int) -> Iterator[bytes]:
        """The rows of a chunk from a point on, as they come.

        Raises
        ------
        Died
            If the process ends before its chunk does.
        TookTooLong
            If a row takes longer than the time limit.
        SolverFailure
            If something other than a point fails, such as an import.
        """
        try:
            self._input.write(msgspec.json.encode((begin, task)) + b"\n")
            self._input.flush()
        except OSError:
            raise Died(self._end()) from None
        while (line := self._line(task.time_limit)) != DONE:
            if line.startswith(ERROR):
                raise SolverFailure(line.removeprefix(ERROR).decode())
            yield line

    def kill(self) -> None:
        """End it at once, with all that it started; whoever waits for a row meets `Died`."""
        if sys.platform == "win32":
            self._process.kill()
            return
        # it leads a group of its own; the group may be there when the process is gone
        with suppress(ProcessLookupError, PermissionError):
            os.killpg(self._process.pid, signal.SIGKILL)

    def clear(self) -> None:
        """End it and give back what it held."""
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
        text = b""
        while not self._cleared and (more := os.read(self._output.fileno(), _READ_BYTES)):
            *lines, text = (text + more).split(b"\n")
            if lines:
                self._came.put(lines)
        self._came.put([b""])

    def _line(self, seconds: float) -> bytes:
        until = monotonic() + seconds
        while not self._waiting:
            gone = self._process.poll() is not None
            left = until - monotonic()
            try:
                self._waiting.extend(self._came.get(timeout=min(max(left, 0.0), _LOOK_SECONDS)))
            except Empty:
                if gone:
                    # its pipe is held open by a process that it started
                    raise Died(self._end()) from None
                if left <= _LOOK_SECONDS:
                    raise TookTooLong from None
        line = self._waiting.popleft()
        if not line:
            raise Died(self._end())
        return line

    def _end(self) -> str:
        try:
            status = self._process.wait(_END_SECONDS)
        except subprocess.TimeoutExpired:
            return "its output was closed"
        return f"signal {-status}" if status < 0 else f"exit status {status}"


def _pipes(process: subprocess.Popen[bytes]) -> tuple[IO[bytes], IO[bytes]]:
    if process.stdin is None or process.stdout is None:
        raise SolverFailure("a solver process has no pipes")
    return process.stdin, process.stdout
