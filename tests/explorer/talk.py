"""Questions to a running explorer, as a program asks them."""

import json
from collections.abc import Sequence
from dataclasses import dataclass
from http.client import HTTPConnection, HTTPResponse
from typing import Any
from urllib.parse import urlencode

#: seconds of the processor that a question has: what an answer is does not depend on how busy the machine is
PATIENCE = 60.0
OPTIMAL = {"problem": {"order": 4, "degree": 9, "B": 1.7}}


@dataclass(frozen=True)
class Server:
    """Where an explorer is."""

    name: str
    port: int

    @property
    def host(self) -> str:
        return f"{self.name}:{self.port}"

    def link(self, laws: Sequence[object] = (), **state: object) -> str:
        """The address of a study."""
        shown = [("law", json.dumps(law)) for law in laws]
        parts = [(name, json.dumps(value)) for name, value in state.items()]
        return f"http://{self.host}/#{urlencode(shown + parts)}"

    def send(self, method: str, path: str, body: bytes | None = None, **headers: str) -> tuple[HTTPResponse, bytes]:
        """An answer with its body; headers by their names with _ for -."""
        connection = HTTPConnection(self.name, self.port, timeout=300)
        try:
            named = {name.replace("_", "-"): value for name, value in headers.items()}
            connection.request(method, path, body=body, headers=named)
            response = connection.getresponse()
            return response, response.read()
        finally:
            connection.close()

    def ask(self, name: str, question: object, code: int = 200, *, patience: float = PATIENCE) -> Any:
        """The answer to a question of the page."""
        body = question if isinstance(question, bytes) else json.dumps(question).encode()
        response, answer = self.send("POST", f"/api/{name}?patience={patience}", body, Content_Type="application/json")
        assert response.status == code, answer
        return json.loads(answer)

    def get_start(self) -> Any:
        """What the page shows first."""
        response, answer = self.send("GET", "/api/start")
        assert response.status == 200
        return json.loads(answer)["state"]


def written(said: Any) -> str:
    """What a server says as the page writes it where no unit is changed: a text, a quantity, or a list of both."""
    if isinstance(said, list):
        return "".join(map(written, said))
    if isinstance(said, dict):
        return f"{said['value']:.{said['digits']}g} {said['unit']}".replace("-", "−")
    assert isinstance(said, str)
    return said
