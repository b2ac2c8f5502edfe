"""The server's paths: the page's files, and the page's questions as JSON."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from dataclasses import replace
from functools import cache
from importlib.resources import files
from typing import TYPE_CHECKING, Any

import msgspec
from starlette.applications import Starlette
from starlette.datastructures import Headers, MutableHeaders
from starlette.middleware import Middleware
from starlette.middleware.gzip import GZipMiddleware
from starlette.requests import Request
from starlette.responses import PlainTextResponse, Response
from starlette.routing import Route

from optlaws import Drive, catalogue
from optlaws.explorer.answering import EXAMPLES, OK, QUESTIONS, message
from optlaws.explorer.start import OpenRequest, results_of
from optlaws.explorer.views import cam_view, cycle_view, law_view, machine_view, old_cam_view
from optlaws.explorer.workers import MOST, SLICE, USUAL, Workers
from optlaws.exports.format import FORMATS
from optlaws.jobs.fastest import MoveEntries
from optlaws.synthesis.problem.problem import ENTRIES

if TYPE_CHECKING:
    from starlette.types import ASGIApp, Message, Receive, Scope, Send

#: no question of the page is longer
MOST_BYTES = 400_000
_SCRIPT = "text/javascript"
_TYPES = {".html": "text/html", ".css": "text/css", ".js": _SCRIPT, ".mjs": _SCRIPT, ".svg": "image/svg+xml"}
#: entries of the laws of a move, of which the order has a default of its own
_SPACE: dict[str, Any] = {"order": {"default": 3}, "degree": {}, "monotone": {}}
#: what the page shows of the format of a controller
_FORM = ("name", "target", "takes")
#: members of Savin's families that the page offers by name
_MEMBERS = ("I(0)", "II(6)", "III(7.2)", "IV(10)")
_BAD, _TOO_LONG, _LEFT = 400, 413, 499
#: a browser looks for the icon whenever the address changes, and so with every drag: it may keep the one it has
_ICON, _KEPT = "icon.svg", {"Cache-Control": "max-age=3600"}


def application(start: dict[str, Any], workers: Workers | None = None) -> Starlette:
    """The explorer as an ASGI application; `start` is the page's initial state."""
    known = {
        "names": [*catalogue, *_MEMBERS],
        "examples": {name: example() for name, example in EXAMPLES.items()},
        "law": law_view.form(),
        "cam": cam_view.form(),
        "programme": cycle_view.form(),
        "move": MoveEntries.form()["entries"],
        "space": [replace(ENTRIES[name], **given).form for name, given in _SPACE.items()],
        "mechanisms": machine_view.kinds(),
        "drive": Drive.form()["entries"],
        "table": old_cam_view.OldCamEntries.form()["entries"],
        "formats": [{key: getattr(form, key) for key in _FORM} for _, form in sorted(FORMATS.items())],
    }
    first = msgspec.json.encode({"state": start, **known})
    answering = Workers() if workers is None else workers

    @asynccontextmanager
    async def ready(_: Starlette) -> AsyncIterator[None]:
        await answering.prepare()
        yield
        answering.close()

    packed = [Middleware(GZipMiddleware)]
    routes = [
        Route("/api/start", lambda _: _json(first), middleware=packed),
        *(Route(f"/api/{name}", _asking(name, answering), methods=["POST"]) for name in QUESTIONS),
        *(Route("/" if name == "index.html" else f"/{name}", _file(name), middleware=packed) for name in page()),
    ]
    return Starlette(routes=routes, middleware=[Middleware(Guard)], lifespan=ready)


@cache
def page() -> dict[str, bytes]:
    """The files of the page by their paths."""
    folder = files("optlaws.explorer") / "page"
    inside = {f"{path}{entry.name}": entry for path in ("", "views/") for entry in (folder / path).iterdir()}
    return {path: inside[path].read_bytes() for path in sorted(inside) if f".{path.rpartition('.')[2]}" in _TYPES}


def _file(name: str) -> Callable[[Request], Response]:
    kind = _TYPES[f".{name.rpartition('.')[2]}"]
    headers = _KEPT if name == _ICON else None
    return lambda _: Response(page()[name], media_type=kind, headers=headers)


def _asking(name: str, workers: Workers) -> Callable[[Request], Any]:
    async def respond(request: Request) -> Response:
        if request.headers.get("content-type", "").partition(";")[0] != "application/json":
            return _json(message("ask in application/json"), _BAD)
        body = b""
        async for part in request.stream():
            body += part
            if len(body) > MOST_BYTES:
                return _json(message(f"a question is at most {MOST_BYTES} bytes long"), _TOO_LONG)
        answering = asyncio.ensure_future(workers.answer(name, body, _patience(request)))
        left = asyncio.ensure_future(request.receive())  # nothing comes after the body but the end of the connection
        await asyncio.wait({answering, left}, return_when=asyncio.FIRST_COMPLETED)
        left.cancel()
        if not answering.done():
            answering.cancel()
            return Response(status_code=_LEFT)
        code, content = answering.result()
        if name == "open" and code == OK:
            file = msgspec.json.decode(body, type=OpenRequest)
            workers.results = results_of(file.name, file.text)
        return _json(content, code)

    return respond


def _patience(request: Request) -> float:
    """The time limit of the page for a question, in seconds; invalid values are replaced."""
    try:
        return min(MOST, max(SLICE, float(request.query_params.get("patience", USUAL))))
    except ValueError:
        return USUAL


def _json(content: bytes, code: int = 200) -> Response:
    return Response(content, status_code=code, media_type="application/json")


NAMES = ("127.0.0.1", "localhost")
_USUAL_PORT = 80  # browsers leave it out
HEADERS = {
    "Content-Security-Policy": (
        "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'; connect-src 'self'; "
        "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    ),
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cache-Control": "no-store",
}


class Guard:
    """Refuse requests that do not come from a page of this server, such as requests for another host name."""

    def __init__(self, app: ASGIApp) -> None:
        self.app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on, or refuse it with a reason."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        why = self.refusal(Headers(scope=scope), scope["server"][1])

        async def sent(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(scope=message)
                for name, value in HEADERS.items():
                    headers.setdefault(name, value)
            await send(message)

        await (self.app if not why else PlainTextResponse(f"{why}\n", status_code=403))(scope, receive, sent)

    @staticmethod
    def refusal(headers: Headers, port: int) -> str:
        """Why a request is refused; nothing where it is not."""
        host, origin = headers.get("host", ""), headers.get("origin", "")
        hosts = [f"{name}:{port}" for name in NAMES] + (list(NAMES) if port == _USUAL_PORT else [])
        if host not in hosts:
            return f"this server answers to {' and '.join(hosts)} only"
        foreign = headers.get("sec-fetch-site", "none") not in {"none", "same-origin"}
        if (origin and origin != f"http://{host}") or (foreign and headers.get("sec-fetch-mode") != "navigate"):
            return "this server answers its own pages only"
        return ""
