"""The questions of the page and their handlers; also the loop of a process that answers them one after another."""

from __future__ import annotations

import os
import signal
import traceback
from collections.abc import Callable
from multiprocessing import parent_process
from multiprocessing.connection import Connection, wait
from threading import Thread
from types import ModuleType
from typing import Any

import msgspec

from optlaws.echo import cut
from optlaws.errors import InputError, OptlawsError
from optlaws.explorer import downloads, start
from optlaws.explorer.views import (
    advice_view,
    axes_view,
    cam_view,
    cycle_view,
    fastest_view,
    front_view,
    law_view,
    machine_view,
    old_cam_view,
)
from optlaws.explorer.views.requests import Question, read
from optlaws.sentences import parts_of

#: the views that show a study, by their names in the page; where none is given each shows its example
_VIEWS: dict[str, ModuleType] = {
    "cycle": cycle_view,
    "cam": cam_view,
    "axes": axes_view,
    "machine": machine_view,
    "fastest": fastest_view,
    "old": old_cam_view,
    "advice": advice_view,
}
#: by the last part of the path: what a question is read as, and what answers it; each view names its own
QUESTIONS: dict[str, Question] = {
    name: question
    for each in (law_view, front_view, start, downloads, *_VIEWS.values())
    for name, question in each.QUESTIONS.items()
}
#: by a view's name in the page: the study that it shows where none was given
EXAMPLES: dict[str, Callable[[], dict[str, Any]]] = {name: view.example for name, view in _VIEWS.items()}
OK, UNREADABLE, FAULT = 200, 422, 500
#: bytes that a process may take for its data, where the system can limit it
_MOST_DATA = 1 << 30


def answered(name: str, body: bytes) -> tuple[int, bytes]:
    """The code and the JSON of an answer; only a question that cannot be read is an error.

    >>> answered("laws", b'{"laws": []}')
    (422, b'{"error":"the question cannot be read: Expected `array` of length >= 1 - at `$.laws`"}')
    """
    kind, answer = QUESTIONS[name]
    try:
        question = read(body, kind)
    except InputError as error:
        return UNREADABLE, message(str(error))
    try:
        return OK, msgspec.json.encode(answer(question), enc_hook=parts_of)
    except OptlawsError as error:
        return OK, message(str(error.args[0]))
    except MemoryError:
        return OK, message("this needs more memory than the explorer takes: ask for less")
    except Exception:  # noqa: BLE001 - the process lives on, and the page says that the fault is ours
        traceback.print_exc()
        return FAULT, message("this is a fault of optlaws: its server printed where")


def message(text: str) -> bytes:
    """A sentence for the page, as JSON.

    >>> message("no such law")
    b'{"error":"no such law"}'
    """
    return msgspec.json.encode({"error": cut(text)})


def _limit_memory() -> None:
    try:
        import resource
    except ModuleNotFoundError:  # no such limit on this system
        return
    resource.setrlimit(resource.RLIMIT_DATA, (_MOST_DATA, _MOST_DATA))


def answer_from(connection: Connection) -> None:
    """Answer the questions that come over a connection, until it ends or the server is gone."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is the server's
    _limit_memory()
    Thread(target=_end_with_the_server, daemon=True).start()
    while True:
        try:
            name, body, seconds = connection.recv()
            _end_after(seconds)
            reply = answered(name, body)
            _end_after(0.0)
            connection.send(reply)
        except (EOFError, ConnectionError):
            return


def _end_after(seconds: float) -> None:
    """Let the system end this process after so much processor time, wherever it is then; 0 is never."""
    if hasattr(signal, "setitimer"):
        signal.setitimer(signal.ITIMER_PROF, seconds)


def _end_with_the_server() -> None:
    server = parent_process()
    if server is not None:
        wait([server.sentinel])
        os._exit(1)
