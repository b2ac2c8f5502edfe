"""The explorer's server: on this machine alone, until it is interrupted."""

from __future__ import annotations

import os
import socket
import webbrowser
from threading import Thread
from typing import Any

import uvicorn

from optlaws.errors import InputError
from optlaws.explorer.application import application
from optlaws.explorer.workers import Workers

ADDRESS = "127.0.0.1"
#: the explorer's default port, the same every day, so that links stay valid
PORT = 8337
_MOST_PORT = 65535
_GRACE = 2  # seconds for answers that are being written


def opened(port: int | None) -> socket.socket:
    """A socket that listens on this machine alone; any free port where the usual one is taken."""
    if port is not None and not 0 <= port <= _MOST_PORT:
        raise InputError(f"--port is a number from 0 (any free one) to {_MOST_PORT}, got {port}")
    try:
        listening = socket.create_server((ADDRESS, PORT if port is None else port))
    except OSError as error:
        if port is not None:
            raise InputError(
                f"--port {port}: {os.strerror(error.errno or 0)}; take another, or 0 for any free one"
            ) from None
        listening = socket.create_server((ADDRESS, 0))
    # asyncio does so for sockets of its own alone; without it an answer waits 40 ms between its head and its body
    listening.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    return listening


def server(start: dict[str, Any], results: str = "") -> uvicorn.Server:
    """The server, ready to run on a socket; `results` is the text of the file of results that the page shows first."""
    workers = Workers(results)

    class Server(uvicorn.Server):
        """A server that stops its computations before it waits for answers."""

        async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
            """End all answers at once, and the server with them."""
            workers.close()
            await super().shutdown(sockets)

    quiet: Any = {"log_level": "warning", "access_log": False, "ws": "none", "lifespan": "on", "http": "h11"}
    return Server(
        uvicorn.Config(application(start, workers), loop="asyncio", timeout_graceful_shutdown=_GRACE, **quiet)
    )


def explore(start: dict[str, Any], results: str = "", port: int | None = None, *, browser: bool = True) -> None:
    """Serve the page until interrupted, and show it in the user's browser."""
    serving = server(start, results)
    with opened(port) as listening:
        address = f"http://{ADDRESS}:{listening.getsockname()[1]}/"
        print(f"optlaws explorer: {address}  (Ctrl-C ends it)", flush=True)  # noqa: T201 - the address
        if browser:
            # the socket listens already, so that the browser may come before the server does
            Thread(target=webbrowser.open, args=(address,), daemon=True).start()
        try:
            serving.run(sockets=[listening])
        except KeyboardInterrupt:
            print()  # noqa: T201 - Ctrl-C is how it ends
