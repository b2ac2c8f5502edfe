"""Who may ask: pages of this server alone, on this machine; and what its pages may do: nothing beyond it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from starlette.datastructures import Headers, MutableHeaders
from starlette.responses import PlainTextResponse

if TYPE_CHECKING:
    from starlette.types import ASGIApp, Message, Receive, Scope, Send

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
    """Refuse what is not asked by a page of this server; a name of another host that leads here is none of ours.

    Examples
    --------
    >>> Guard(lambda scope, receive, send: None).refusal("evil.example:80", "", 80)
    'this server answers to 127.0.0.1:80 and localhost:80 only'
    """

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
        own = [f"{name}:{port}" for name in NAMES]
        if host not in own:
            return f"this server answers to {' and '.join(own)} only"
        if origin and origin != f"http://{host}":
            return "this server answers its own pages only"
        return ""
