from __future__ import annotations

import json
import shutil
from collections.abc import Awaitable, Callable, Iterator
from dataclasses import dataclass, field
from functools import wraps
from os import environ
from threading import Thread
from typing import TYPE_CHECKING, NoReturn
from unittest.mock import patch
from urllib.parse import urlsplit

import pytest

from tests.explorer.talk import Server
from tests.internals.explorer import ADDRESS, Workers, opened, server, start

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page, Request

NAMES = ("chromium-headless-shell", "chromium", "chromium-browser", "google-chrome")
CHROMIUM = next(filter(None, map(shutil.which, NAMES)), None)
FLAGS = (
    "--no-sandbox --disable-gpu --disable-quic --no-first-run --disable-background-networking "
    "--disable-component-update --disable-sync"
)
#: questions that take long and that pages ask whenever they are opened; laws are computed anew each time
HEAVY = {"advice", "cam-sizes", "fastest", "front", "machine", "machine-limits", "old"}


def remembering(answer: Callable[..., Awaitable[tuple[int, bytes]]]) -> Callable[..., Awaitable[tuple[int, bytes]]]:
    """What answers a heavy question as it was answered before."""
    known: dict[tuple[str, str], tuple[int, bytes]] = {}

    @wraps(answer)
    async def remembered(workers: Workers, name: str, body: bytes, *patience: float) -> tuple[int, bytes]:
        if name not in HEAVY:
            return await answer(workers, name, body, *patience)
        try:
            question = name, json.dumps(json.loads(body))
        except (ValueError, RecursionError):  # which the explorer refuses
            return await answer(workers, name, body, *patience)
        if question not in known:
            reply = await answer(workers, name, body, *patience)
            if reply[1].startswith(b'{"error"'):
                return reply
            known[question] = reply
        return known[question]

    return remembered


@pytest.fixture(scope="session")
def served() -> Iterator[Server]:
    """A running explorer."""
    with opened(0) as listening, patch.object(Workers, "answer", remembering(Workers.answer)):
        running = server(start(None))
        thread = Thread(target=running.run, kwargs={"sockets": [listening]}, daemon=True)
        thread.start()
        yield Server(ADDRESS, listening.getsockname()[1])
        running.should_exit = True
        thread.join(10.0)


def without_browser(why: str) -> NoReturn:
    """Skip, or fail where a browser is promised."""
    if environ.get("OPTLAWS_NEEDS_BROWSER"):
        pytest.fail(f"{why}, but OPTLAWS_NEEDS_BROWSER says there is one")
    pytest.skip(why)


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    """One browser for all tests."""
    if CHROMIUM is None:
        without_browser("no browser: there is no chromium on the path")
    try:
        from playwright.sync_api import sync_playwright
    except ModuleNotFoundError:
        without_browser("no browser: playwright is not installed")
    with sync_playwright() as playwright:
        found = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS.split())
        yield found
        found.close()


@dataclass
class Watch:
    """What a page asked of the network and what it complained of."""

    hosts: set[str] = field(default_factory=set)
    paths: list[str] = field(default_factory=list)
    complaints: list[str] = field(default_factory=list)


@pytest.fixture
def watch() -> Watch:
    """What the page of this test does; see `page`."""
    return Watch()


@pytest.fixture
def page(browser: Browser, served: Server, watch: Watch) -> Iterator[Page]:
    """A page of the explorer that asks nothing of any other host and complains of nothing."""
    context = browser.new_context(viewport={"width": 1280, "height": 800}, accept_downloads=True)
    opened_page = context.new_page()

    def asked(request: Request) -> None:
        if urlsplit(request.url).scheme != "blob":
            watch.hosts.add(urlsplit(request.url).netloc)
            watch.paths.append(urlsplit(request.url).path)

    opened_page.on("request", asked)
    opened_page.on("pageerror", lambda error: watch.complaints.append(str(error)))
    opened_page.on(
        "console", lambda said: watch.complaints.append(said.text) if said.type in {"error", "warning"} else None
    )
    yield opened_page
    context.close()
    assert watch.hosts <= {served.host}
    assert watch.complaints == []
