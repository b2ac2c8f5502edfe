"""Processes that answer the page's questions: a question that is dropped or takes too long ends with its process.

A question begins at once in a process for new ones, the newest question first. Where it takes more than a slice of the
processor's time it goes on among the long ones, which give way: however many heavy questions wait, a light one is
answered soon.
"""

from __future__ import annotations

import asyncio
import multiprocessing
import os
import signal
import time
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from typing import Any

import msgspec

from optlaws.explorer.answering import FAULT, OK, answer_from, message

#: seconds of the processor after which a question is a long one, that it has, and that it can be given
SLICE, USUAL, MOST = 0.15, 4.0, 300.0
_SOON = 0.02  # between two looks at what a question has had
_WAITED = 4.0  # a busy machine may take so many times as long in all
_LONG = max(1, min(3, (os.cpu_count() or 2) - 1))
_IDLE, _YIELDING = 2, 5  # processes that wait for a question; how far a long one gives way to others
_METHODS = multiprocessing.get_all_start_methods()
#: where it can, a process is a copy of one that has loaded everything already
_KIND = "forkserver" if "forkserver" in _METHODS else "spawn"
_OUT_OF_TIME = -signal.SIGPROF if hasattr(signal, "SIGPROF") else None
Reply = tuple[int, bytes]
_ENDED: Reply = FAULT, message("the process that computed this ended before its answer")


class Worker:
    """A process that answers one question at a time."""

    def __init__(self) -> None:
        context: Any = multiprocessing.get_context(_KIND)
        if _KIND == "forkserver":
            context.set_forkserver_preload(["optlaws.explorer.answering", "optlaws.verification.exact.bound", "casadi"])
        self._connection, its_own = context.Pipe()
        self._process = context.Process(target=answer_from, args=(its_own,), daemon=True)
        self._process.start()
        its_own.close()
        self._ended = False
        self._results = ""  # the file of results that the process knows

    @property
    def alive(self) -> bool:
        """Whether the process can be given a question."""
        return not self._ended and self._process.is_alive()

    @property
    def spent(self) -> float:
        """Seconds of the processor that the process has had; of the clock where the system does not count them."""
        try:
            return time.clock_gettime(~(self._process.pid or 0) << 3 | 2)  # the clock of a process, as POSIX numbers it
        except (AttributeError, OSError):
            return time.monotonic()

    def give_way(self) -> None:
        """Let all other processes go before this one, which is used up by its question."""
        if hasattr(os, "setpriority") and self.alive:
            os.setpriority(os.PRIO_PROCESS, self._process.pid or 0, _YIELDING)

    def answer(self, name: str, body: bytes, patience: float, results: str) -> Reply:
        """Wait for the answer to a question; if the process ends first, it is a sentence that reports it."""
        try:
            self._connection.send((name, body, patience, None if results == self._results else results))
            self._results = results
            reply: Reply = self._connection.recv()
        except (EOFError, OSError):
            self._process.join()
            in_time = self._process.exitcode != _OUT_OF_TIME
            self.end()
            reply = _ENDED if in_time else (OK, late(patience))
        return reply

    def end(self) -> None:
        """End the process, whatever it does."""
        self._ended = True
        self._process.kill()


class Workers:
    """The processes of a server, and the text of the file of results that its page opened last."""

    def __init__(self, results: str = "") -> None:
        self.results = results
        self._idle: list[Worker] = []
        self._all: set[Worker] = set()
        self._busy = False
        self._newcomers: list[asyncio.Future[None]] = []
        self._long = asyncio.Semaphore(_LONG)
        self._closed = asyncio.Event()
        self._beginning = asyncio.Lock()

    async def prepare(self, count: int = _IDLE) -> None:
        """Begin so many processes before there is a question for them."""
        async with self._beginning:
            while len(self._idle) < count:
                worker = await asyncio.to_thread(Worker)
                self._all.add(worker)
                self._idle.append(worker)
                if self._closed.is_set():
                    break
        if self._closed.is_set():  # meanwhile
            self.close()

    def close(self) -> None:
        """End all processes; questions under way are answered with a sentence."""
        self._closed.set()
        for worker in self._all:
            worker.end()

    async def answer(self, name: str, body: bytes, patience: float = USUAL) -> Reply:
        """The answer to a question within a number of seconds; its process ends if the answer is cancelled."""
        async with self._turn():
            if self._closed.is_set():
                return _ENDED
            worker, reply = await self._begun(name, body, patience)
            begun = worker.spent
            while not reply.done() and worker.spent - begun < SLICE:
                await self._wait(worker, reply, _SOON, end=False)
            if self._long.locked() and not reply.done():
                worker.end()
        light = reply.done()
        if not light:
            await self.prepare()
            async with self._long:
                if self._closed.is_set():
                    return _ENDED
                if not worker.alive:
                    worker, reply = await self._begun(name, body, patience)
                worker.give_way()
                await self._wait(worker, reply, _WAITED * patience, end=True)
        if worker.alive and light and len(self._idle) < _IDLE:
            self._idle.append(worker)
        else:
            worker.end()
        return reply.result() if reply.done() else (OK, late(patience))

    async def _begun(self, name: str, body: bytes, patience: float) -> tuple[Worker, asyncio.Task[Reply]]:
        self._all = {worker for worker in self._all if worker.alive}
        self._idle = [worker for worker in self._idle if worker.alive]
        while not self._idle:
            await self.prepare(1)
        worker = self._idle.pop()
        return worker, asyncio.create_task(asyncio.to_thread(worker.answer, name, body, patience, self.results))

    @staticmethod
    async def _wait(worker: Worker, reply: asyncio.Task[Reply], seconds: float, *, end: bool) -> None:
        """Wait for an answer; without one in time, or without anybody waiting, its process may end."""
        try:
            await asyncio.wait({reply}, timeout=seconds)
        except asyncio.CancelledError:
            worker.end()
            raise
        if end and not reply.done():
            worker.end()

    @asynccontextmanager
    async def _turn(self) -> AsyncIterator[None]:
        """The right to begin a question: the last to come is the first to have it."""
        turn = asyncio.get_running_loop().create_future()
        self._newcomers.append(turn)
        self._pass_on()
        try:
            await turn
            yield
        finally:
            if not turn.cancelled():
                self._busy = False
                self._pass_on()

    def _pass_on(self) -> None:
        self._newcomers = [turn for turn in self._newcomers if not turn.done()]
        if self._newcomers and not self._busy:
            self._busy = True
            self._newcomers.pop().set_result(None)


def late(patience: float) -> bytes:
    """A sentence about a question that had no answer in time, with the seconds that it had."""
    return msgspec.json.encode({"error": f"this takes more than {patience:g} s", "late": patience})
