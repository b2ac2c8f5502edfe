"""The questions of the page and their handlers; also the loop of a process that answers them one after another."""

from __future__ import annotations

import os
import signal
import traceback
from collections.abc import Callable
from multiprocessing import parent_process
from multiprocessing.connection import Connection, wait
from threading import Thread
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
from optlaws.explorer.views.cycle_view import CycleRequest
from optlaws.explorer.views.opened_results import OPENED
from optlaws.explorer.views.requests import LawsRequest, read
from optlaws.sentences import parts_of

_OF_LAWS: dict[str, Callable[[LawsRequest], dict[str, Any]]] = {
    "laws": law_view.answer,
    "law-machine": law_view.in_machine_units,
    "nearest": law_view.nearest,
    "residual": law_view.residuals,
    "spectrum": law_view.spectrum,
    "front": front_view.answer,
}
_OF_STUDIES: dict[str, Callable[[CycleRequest], dict[str, Any]]] = {
    "advice": advice_view.answer,
    "advice-standard": advice_view.standard,
    "axes": axes_view.answer,
    "axes-clearances": axes_view.clearances,
    "axes-together": axes_view.together,
    "cam": cam_view.answer,
    "cam-loads": cam_view.loads,
    "cam-sizes": cam_view.sizes,
    "cycle": cycle_view.answer,
    "cycle-nearest": cycle_view.nearest,
    "fastest": fastest_view.answer,
    "fastest-front": fastest_view.front,
    "machine": machine_view.answer,
    "machine-limits": machine_view.limits,
    "machine-ratios": machine_view.ratios,
    "old": old_cam_view.answer,
    "old-move": old_cam_view.move,
}
#: by the last part of the path: what a question is read as, and what answers it
QUESTIONS: dict[str, tuple[type[msgspec.Struct], Callable[[Any], dict[str, Any]]]] = {
    **{name: (LawsRequest, answer) for name, answer in _OF_LAWS.items()},
    **{name: (CycleRequest, answer) for name, answer in _OF_STUDIES.items()},
    "export": (downloads.FileRequest, downloads.exported),
    "save": (downloads.FileRequest, downloads.answer),
    "open": (start.OpenRequest, start.opened),
}
#: by a view's name in the page what it shows where nothing was given: a machine, or a part of its own; and moves
EXAMPLES: dict[str, Callable[[], dict[str, Any]]] = {
    "axes": axes_view.example,
    "cam": cam_view.example,
    "cycle": cycle_view.example,
    "machine": machine_view.example,
    "moves": fastest_view.example,
    "old": old_cam_view.example,
}
OK, UNREADABLE, FAULT = 200, 422, 500
#: bytes that a process may take for its data, where the system can limit it
_MOST_DATA = 1 << 30


def answered(name: str, body: bytes) -> tuple[int, bytes]:
    """The code and the JSON of an answer; only a question that cannot be read is an error."""
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
    """A sentence for the page, as JSON."""
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
            name, body, seconds, results = connection.recv()
            OPENED.text = OPENED.text if results is None else results
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
