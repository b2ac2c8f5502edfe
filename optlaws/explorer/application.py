"""The server's paths: the page's files, and the questions that the page asks as JSON."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from importlib.resources import files
from typing import TYPE_CHECKING, Any

import msgspec
from starlette.applications import Starlette
from starlette.concurrency import run_in_threadpool
from starlette.datastructures import Headers, MutableHeaders
from starlette.middleware import Middleware
from starlette.requests import Request
from starlette.responses import PlainTextResponse, Response
from starlette.routing import Route

from optlaws import catalogue
from optlaws.echo import cut
from optlaws.errors import InputError, OptlawsError
from optlaws.explorer import cam_view, cycle_view, downloads, front_view, law_view
from optlaws.explorer.requests import LawRequest, LawsRequest, read, ready
from optlaws.jobs.cam_entries import CamProblemFile
from optlaws.jobs.cycle_entries import CycleProblemFile

if TYPE_CHECKING:
    from starlette.types import ASGIApp, Message, Receive, Scope, Send

#: no question of the page is longer
MOST_BYTES = 400_000
_SCRIPT = "text/javascript"
_TYPES = {".html": "text/html", ".css": "text/css", ".js": _SCRIPT, ".mjs": _SCRIPT, ".svg": "image/svg+xml"}
#: members of Savin's families that the page offers by name
_MEMBERS = ("I(0)", "II(6)", "III(7.2)", "IV(10)")
_BAD, _TOO_LONG, _WRONG = 400, 413, 422

Answer = Callable[[Any], dict[str, Any]]
#: by the last part of the path: what a question is read as, and what answers it
QUESTIONS: dict[str, tuple[type[msgspec.Struct], Answer]] = {
    "laws": (LawsRequest, law_view.answer),
    "front": (front_view.FrontRequest, front_view.answer),
    "nearest": (LawRequest, law_view.nearest),
    "cam": (cam_view.CamRequest, cam_view.answer),
    "cam-loads": (cam_view.CamRequest, cam_view.loads),
    "cam-sizes": (cam_view.CamRequest, cam_view.sizes),
    "cycle": (cycle_view.CycleRequest, cycle_view.answer),
    "cycle-nearest": (cycle_view.CycleRequest, cycle_view.nearest),
    "export": (downloads.ExportRequest, downloads.exported),
    "save": (downloads.FileRequest, downloads.answer),
    "residual": (law_view.ResidualRequest, law_view.residuals),
}


def application(start: dict[str, Any]) -> Starlette:
    """The explorer as an application of ASGI; `start` is what the page shows first."""
    known = {
        "names": [*catalogue, *_MEMBERS],
        "cycle": cycle_view.example(),
        "cam": cam_view.example(),
        "followers": cam_view.followers(),
        "formats": downloads.formats(),
    }
    first = msgspec.json.encode({"state": start, **known})
    ready(*(kind for kind, _ in QUESTIONS.values()), CycleProblemFile, CamProblemFile)
    routes = [
        Route("/api/start", lambda _: _json(first)),
        *(Route(f"/api/{name}", _asking(*question), methods=["POST"]) for name, question in QUESTIONS.items()),
        *(Route("/" if name == "index.html" else f"/{name}", _file(name)) for name in page()),
    ]
    return Starlette(routes=routes, middleware=[Middleware(Guard)])


@cache
def page() -> dict[str, bytes]:
    """The files of the page by their names."""
    folder = files("optlaws.explorer") / "page"
    shown = [entry for entry in folder.iterdir() if f".{entry.name.rpartition('.')[2]}" in _TYPES]
    return {entry.name: entry.read_bytes() for entry in sorted(shown, key=lambda entry: entry.name)}


def _file(name: str) -> Callable[[Request], Response]:
    kind = _TYPES[f".{name.rpartition('.')[2]}"]
    return lambda _: Response(page()[name], media_type=kind)


def _asking(kind: type[msgspec.Struct], answer: Answer) -> Callable[[Request], Any]:
    async def respond(request: Request) -> Response:
        if request.headers.get("content-type", "").partition(";")[0] != "application/json":
            return _message("ask in application/json", _BAD)
        body = b""
        async for part in request.stream():
            body += part
            if len(body) > MOST_BYTES:
                return _message(f"a question is at most {MOST_BYTES} bytes long", _TOO_LONG)
        return await run_in_threadpool(_answered, body, kind, answer)

    return respond


def _answered(body: bytes, kind: type[msgspec.Struct], answer: Answer) -> Response:
    """The answer; where what is asked does not exist, that is one too, and only what cannot be read is an error."""
    try:
        question = read(body, kind)
    except InputError as error:
        return _message(str(error), _WRONG)
    try:
        return _json(msgspec.json.encode(answer(question)))
    except OptlawsError as error:
        return _message(str(error.args[0]))


def _message(text: str, code: int = 200) -> Response:
    return _json(msgspec.json.encode({"error": cut(text)}), code)


def _json(content: bytes, code: int = 200) -> Response:
    return Response(content, status_code=code, media_type="application/json")


NAMES = ("127.0.0.1", "localhost")
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
    """Refuse what is not asked by a page of this server; a name of another host that leads here is none of ours."""

    def __init__(self, app: ASGIApp) -> None:
        self.app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer, or say why not."""
        if scope["type"] != "http":
            return
        headers = Headers(scope=scope)
        why = self.refusal(headers.get("host", ""), headers.get("origin", ""), scope["server"][1])

        async def sent(message: Message) -> None:
            if message["type"] == "http.response.start":
                MutableHeaders(scope=message).update(HEADERS)
            await send(message)

        await (self.app if not why else PlainTextResponse(f"{why}\n", status_code=403))(scope, receive, sent)

    @staticmethod
    def refusal(host: str, origin: str, port: int) -> str:
        """Why a request is refused; nothing where it is not."""
        hosts = [f"{name}:{port}" for name in NAMES]
        if host not in hosts:
            return f"this server answers to {' and '.join(hosts)} only"
        if origin and origin != f"http://{host}":
            return "this server answers its own pages only"
        return ""
