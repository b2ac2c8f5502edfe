"""Who is answered, what pages may do, and that no question ends in anything but an answer."""

import json
import re
import socket
from typing import Any
from unittest.mock import patch
from urllib.parse import urljoin

import pytest
from hypothesis import given
from hypothesis import strategies as st

from optlaws import InputError
from tests.explorer.talk import OPTIMAL, Server
from tests.internals.explorer import MOST_BYTES, QUESTIONS, opened, page
from tests.sampling import examples

ANSWERS = {200, 400, 413, 422}
PLAIN = st.none() | st.booleans() | st.integers(-9, 9) | st.floats(-3, 3) | st.text(max_size=6)
KEYS = st.sampled_from(["laws", "law", "problem", "weights", "order", "B", "J", "name", "over", "minimise", "windows"])
VALUES = st.recursive(PLAIN, lambda inner: st.lists(inner, max_size=3) | st.dictionaries(KEYS, inner, max_size=3))


@pytest.mark.parametrize(
    "host", ["evil.example", "evil.example:{port}", "127.0.0.1", "localhost:1", "127.0.0.1.nip.io:{port}"]
)
def test_another_host_is_refused(served: Server, host: str) -> None:
    response, answer = served.send("GET", "/", Host=host.format(port=served.port))
    assert response.status == 403
    assert b"only" in answer


def test_the_pages_of_others_are_refused(served: Server) -> None:
    body = json.dumps({"laws": [OPTIMAL]}).encode()
    for origin in ("https://evil.example", "null", f"http://localhost:{served.port}"):
        response, _ = served.send("POST", "/api/laws", body, Content_Type="application/json", Origin=origin)
        assert response.status == 403
    response, _ = served.send("POST", "/api/laws", body, Content_Type="text/plain")
    assert response.status == 400


def test_every_answer_forbids_what_the_page_does_not_need(served: Server) -> None:
    for path in ("/", "/main.js", "/style.css", "/api/start", "/nothing"):
        response, _ = served.send("GET", path)
        policy = response.headers["Content-Security-Policy"]
        assert policy.startswith("default-src 'none';")
        assert "unsafe" not in policy
        assert "http" not in policy
        assert response.headers["X-Content-Type-Options"] == "nosniff"


def test_a_browser_keeps_the_icon_and_nothing_else(served: Server) -> None:
    for path in ("/", "/main.js", "/style.css", "/api/start", "/nothing"):
        assert served.send("GET", path)[0].headers["Cache-Control"] == "no-store"
    assert served.send("GET", "/icon.svg")[0].headers["Cache-Control"] == "max-age=3600"


def test_the_page_is_whole_and_names_nothing_beyond_it(served: Server) -> None:
    for name, content in page().items():
        response, answer = served.send("GET", f"/{name}" if name != "index.html" else "/")
        assert (response.status, answer) == (200, content)
        text = content.decode()
        assert set(re.findall(r"https?://[\w.]+", text)) <= {"http://www.w3.org"}  # the name of SVG, asked of nobody
        for line in text.splitlines():
            if name.endswith(".js") and line.startswith("import "):
                assert urljoin(name, line.split('"')[1]) in page()


@pytest.mark.parametrize(
    "path", ["/../pyproject.toml", "/%2e%2e/server.py", "/asked.py", "/api/nothing", "/page/main.js"]
)
def test_no_other_file_is_given(served: Server, path: str) -> None:
    assert served.send("GET", path)[0].status == 404


@pytest.mark.parametrize("body", [b"", b"{", b"[]", b'{"laws": []}', b'{"laws": [{"nme": "x"}]}', b"\xff", b"[" * 5000])
def test_what_cannot_be_read_is_refused_in_words(served: Server, body: bytes) -> None:
    assert "cannot be read" in served.ask("laws", body, 422)["error"]


def test_a_long_question_is_refused(served: Server) -> None:
    assert str(MOST_BYTES) in served.ask("laws", b" " * (MOST_BYTES + 1), 413)["error"]


@examples(60)
@given(name=st.sampled_from(sorted(QUESTIONS)), question=VALUES | st.binary(max_size=12))
def test_any_question_has_an_answer(served: Server, name: str, question: object) -> None:
    body = question if isinstance(question, bytes) else json.dumps(question).encode()
    response, answer = served.send("POST", f"/api/{name}", body, Content_Type="application/json")
    assert response.status in ANSWERS
    assert isinstance(json.loads(answer), dict)


@examples(60)
@given(
    entries=st.dictionaries(
        st.sampled_from(["B", "C", "J", "order", "degree", "minimise", "bounds", "windows", "start", "basis"]),
        VALUES,
        max_size=3,
    )
)
def test_any_problem_has_a_view(served: Server, entries: dict[str, Any]) -> None:
    (view,) = served.ask("laws", {"laws": [{"problem": {"order": 3, "degree": 5} | entries}]})["laws"]
    assert ("panels" in view) != ("refused" in view)


def test_a_port_that_is_taken_is_refused_by_its_number_and_one_of_this_machine_alone_is_opened() -> None:
    with opened(0) as listening:
        name, port = listening.getsockname()
        assert name == "127.0.0.1"
        with pytest.raises(InputError, match=f"--port {port}: .*take another, or 0"):
            opened(port)
    with pytest.raises(InputError, match="--port is a number from 0"):
        opened(70_000)


def test_the_usual_port_gives_way_to_any_free_one() -> None:
    with opened(0) as taken, patch("optlaws.explorer.server.PORT", taken.getsockname()[1]), opened(None) as other:
        assert other.getsockname()[1] != taken.getsockname()[1]


def test_answers_are_sent_at_once() -> None:
    with opened(0) as listening, socket.create_connection(listening.getsockname()), listening.accept()[0] as accepted:
        assert accepted.getsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY)


def test_the_first_page_is_small_where_it_is_packed(served: Server) -> None:
    # other views are loaded when they are shown
    loaded = ["main.js", "views/laws.js"]
    for name in loaded:
        imports = re.findall(r'^import [^;]*?"(\.[^"]+)";$', page()[name].decode(), re.MULTILINE)
        loaded += {urljoin(name, path) for path in imports} - set(loaded)
    first = {"index.html", "style.css", "icon.svg", *loaded}
    assert {"panels.js", "state.js"} < first < set(page())
    packed = 0
    for path in ("api/start", *(name.replace("index.html", "") for name in first)):
        response, answer = served.send("GET", f"/{path}", Accept_Encoding="gzip")
        packed += len(answer)
        assert response.headers["Content-Encoding"] == "gzip" or len(answer) < 500
    assert packed < 100_000
