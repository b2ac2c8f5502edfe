"""The server's paths: the page's files, and the questions that the page asks as JSON."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from importlib.resources import files
from typing import Any

import msgspec
from starlette.applications import Starlette
from starlette.concurrency import run_in_threadpool
from starlette.middleware import Middleware
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from optlaws import catalogue
from optlaws.echo import cut
from optlaws.errors import InfeasibleProblem, InputError, OptlawsError, SolverFailure
from optlaws.explorer.answers import (
    cam_loads_view,
    cam_view,
    cycle_view,
    front_view,
    handed,
    law_view,
    nearest,
    residual_view,
    saved,
)
from optlaws.explorer.answers.asked import AskedLaw, AskedLaws, read, ready
from optlaws.explorer.guard import Guard
from optlaws.jobs.cam import schema
from optlaws.jobs.cycle_entries import CycleProblemFile

#: no question of the page is longer
MOST_BYTES = 400_000
_TYPES = {".html": "text/html", ".css": "text/css", ".js": "text/javascript", ".svg": "image/svg+xml"}
#: members of Savin's families that the page offers by name
_MEMBERS = ("I(0)", "II(6)", "III(7.2)", "IV(10)")
_BAD, _TOO_LONG, _WRONG = 400, 413, 422

Answer = Callable[[Any], dict[str, Any]]
#: by the last part of the path: what a question is read as, and what answers it
QUESTIONS: dict[str, tuple[type[msgspec.Struct], Answer]] = {
    "laws": (AskedLaws, law_view.answer),
    "front": (front_view.AskedFront, front_view.answer),
    "nearest": (AskedLaw, nearest.answer),
    "cam": (cam_view.AskedCam, cam_view.answer),
    "cam-loads": (cam_view.AskedCam, cam_loads_view.answer),
    "cam-sizes": (cam_view.AskedCam, cam_view.sizes),
    "cycle": (cycle_view.AskedCycle, cycle_view.answer),
    "cycle-nearest": (cycle_view.AskedCycle, cycle_view.nearest),
    "export": (handed.AskedExport, handed.answer),
    "save": (saved.AskedFile, saved.answer),
    "residual": (residual_view.AskedResidual, residual_view.answer),
}


def application(start: dict[str, Any]) -> Starlette:
    """The explorer as an application of ASGI; `start` is what the page shows first.

    Examples
    --------
    >>> sorted(route.path for route in application({}).routes)[:3]
    ['/', '/api/cam', '/api/cam-loads']
    """
    known = {
        "names": [*catalogue, *_MEMBERS],
        "cycle": cycle_view.example(),
        "cam": cam_view.example(),
        "followers": cam_view.followers(),
        "formats": handed.formats(),
    }
    first = msgspec.json.encode({"state": start, **known})
    ready(*(kind for kind, _ in QUESTIONS.values()), CycleProblemFile, schema.CamProblemFile)
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
    kept = [entry for entry in folder.iterdir() if f".{entry.name.rpartition('.')[2]}" in _TYPES]
    return {entry.name: entry.read_bytes() for entry in sorted(kept, key=lambda entry: entry.name)}


def _file(name: str) -> Callable[[Request], Response]:
    kind = _TYPES[f".{name.rpartition('.')[2]}"]
    return lambda _: Response(page()[name], media_type=kind)


def _asking(kind: type[msgspec.Struct], answer: Answer) -> Callable[[Request], Any]:
    async def asked(request: Request) -> Response:
        if request.headers.get("content-type", "").partition(";")[0] != "application/json":
            return _told("ask in application/json", _BAD)
        body = b""
        async for part in request.stream():
            body += part
            if len(body) > MOST_BYTES:
                return _told(f"a question is at most {MOST_BYTES} bytes long", _TOO_LONG)
        return await run_in_threadpool(_answered, body, kind, answer)

    return asked


def _answered(body: bytes, kind: type[msgspec.Struct], answer: Answer) -> Response:
    """The answer; where what is asked does not exist, that is one too, and only what cannot be read is an error."""
    try:
        question = read(body, kind)
    except InputError as error:
        return _told(str(error), _WRONG)
    try:
        return _json(msgspec.json.encode(answer(question)))
    except (InfeasibleProblem, SolverFailure) as error:
        return _told(str(error.args[0]))
    except OptlawsError as error:
        return _told(str(error))


def _told(text: str, code: int = 200) -> Response:
    return _json(msgspec.json.encode({"error": cut(text)}), code)


def _json(content: bytes, code: int = 200) -> Response:
    return Response(content, status_code=code, media_type="application/json")
