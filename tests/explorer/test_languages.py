"""The page in other languages and units: all its texts, decimal signs in and out, numbers in the reader's units."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING

import pytest

from tests.explorer.conftest import Watch
from tests.explorer.talk import OPTIMAL, Server
from tests.explorer.test_accessible import views, violations
from tests.explorer.test_page import go, settle, told
from tests.internals.explorer import example

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

LOCALES = {"de": "de-DE", "fr": "fr-FR", "uk": "uk-UA"}
#: what the page itself says: buttons, headings, names of fields, in its forms and tools
SAID = (
    ":is(#tools, #views, .view:not([hidden])) :is(button, legend, summary, th, .field-name, .hint, .title, option, h2)"
)
#: names of formats and of the language of files
TARGETS = {"Python"}
NAMES = "[translate=no], .chip, .row-name, #study-rows td, #study-about, optgroup"


@pytest.fixture
def spoken(browser: Browser, served: Server, request: pytest.FixtureRequest) -> Iterator[Page]:
    """The page of a reader whose browser speaks another language."""
    context = browser.new_context(viewport={"width": 1280, "height": 800}, locale=LOCALES[request.param])
    page = context.new_page()
    watch = Watch()
    page.on("pageerror", lambda error: watch.complaints.append(str(error)))
    go(page, f"http://{served.host}/")
    yield page
    context.close()
    assert watch.complaints == []


def texts_of(page: Page) -> set[str]:
    script = """([said, names]) => [...document.querySelectorAll(said)]
      .filter((one) => !one.closest(names) && one.checkVisibility())
      .flatMap((one) => [...one.childNodes].filter((node) => node.nodeType === 3).map((node) => node.data.trim()))"""
    return {text for text in page.evaluate(script, [SAID, NAMES]) if re.search(r"[A-Za-zА-я]{4,}", text)}


@pytest.mark.parametrize("spoken", LOCALES, indirect=True)
def test_the_page_speaks_the_language_of_its_reader(spoken: Page, served: Server) -> None:
    assert spoken.evaluate("() => document.documentElement.lang") in LOCALES
    # names that a study gives stand as they are
    given = set(re.findall(r'"name": ?"([^"]+)"', served.send("GET", "/api/start")[1].decode())) | TARGETS
    for view in views(spoken):
        spoken.locator(f"#views [data-key={view}]").click()
        spoken.locator(f"#{view}-view :is(aside, .panel)").first.wait_for(state="attached")
        settle(spoken)
        missed = set(spoken.evaluate("() => import('/language.js').then(({ missed }) => [...missed])"))
        lacking = {text for text in texts_of(spoken) & missed if text.split(", ")[0] not in given}
        assert not lacking, f"page/texts.js lacks texts of the view {view}"


@pytest.mark.parametrize("spoken", LOCALES, indirect=True)
def test_an_advice_is_said_in_the_language_of_the_page(spoken: Page, served: Server) -> None:
    spoken.locator("#views [data-key=advice]").click()
    spoken.locator("#advice-words .advice").wait_for()
    settle(spoken)
    english = served.ask("advice", {"study": example()})["sentences"]
    sentences = spoken.locator("#advice-words p").all_inner_texts()[:2]
    for sentence, said in zip(english, sentences, strict=True):
        numbers = [text.rstrip(".") for text in re.findall(r"\d[\d.]*", sentence)]
        # every number of a sentence, and none of its words
        assert sorted(re.findall(r"\d[\d,]*\d|\d", said)) == sorted(text.replace(".", ",") for text in numbers)
        assert not re.search(r"\b(?:than|takes|none|less|limit)\b", said)
    assert violations(spoken) == []


@pytest.mark.parametrize("spoken", ["de"], indirect=True)
def test_numbers_have_the_decimal_sign_of_the_language_in_and_out(spoken: Page, served: Server) -> None:
    def constants() -> list[str]:
        return spoken.locator("#table tbody tr >> nth=0 >> [data-constant]").all_inner_texts()

    assert constants() == [text.replace(".", ",") for text in told(served, OPTIMAL)]
    field = spoken.locator("#ask .field", has_text="B").locator("input.numeric").first
    assert field.input_value() == "1,7"
    field.fill("1,85")
    settle(spoken)
    law = {"problem": OPTIMAL["problem"] | {"B": 1.85}, "weights": {"C": 1}}
    assert constants() == [text.replace(".", ",") for text in told(served, law)]
    spoken.locator("#views [data-key=cycle]").click()
    settle(spoken)
    spoken.locator("#programme .entry", has_text="Geschwin\u00addig\u00adkeit").locator("input").fill("700,5 mm/s")
    settle(spoken)
    assert "bewiesen optimal" in spoken.locator("#cycle-trust").inner_text()
    assert violations(spoken) == []


def test_numbers_are_shown_in_the_units_of_the_reader(page: Page, served: Server) -> None:
    go(page, served.link(view="cycle", laws=[OPTIMAL]))
    page.get_by_text("Settings").click()
    page.get_by_label("length").select_option("in")
    page.wait_for_load_state()
    settle(page)
    shown = served.ask("cycle", {"study": example()})
    peak = shown["panels"][1]["peaks"][-1]
    mark = page.locator("#motion svg >> nth=1 >> .peak text").last.text_content() or ""
    assert float(mark) == pytest.approx(peak["value"] / 25.4, rel=1e-3)
    assert page.locator("#motion .title").all_text_contents()[1] == "velocity, in/s"
    cell = page.locator("#segments tbody tr >> nth=0 >> td >> nth=4").inner_text()
    assert float(cell) == pytest.approx(616 / 25.4, rel=1e-3)
    least = float(re.findall(r"least acceleration = ([\d.]+) in/s²", page.locator("#cycle-trust").inner_text())[0])
    assert least == pytest.approx(26.51039 / 0.0254, rel=1e-6)
    page.locator("#views [data-key=advice]").click()
    settle(page)
    assert "acceleration, in/s²" in " ".join(page.locator("#advice-table thead").inner_text().split())
    advised = served.ask("advice", {"study": example()})["rows"][0]["cells"]
    cell = page.locator("#advice-table tbody tr >> nth=0 >> td >> nth=1").inner_text()
    assert float(cell) == pytest.approx(1000.0 * float(advised[1]) / 25.4, rel=1e-4)
    page.locator("#views [data-key=fastest]").click()
    settle(page)
    assert "velocity, in/s" in page.locator("#fastest-table").inner_text()
    page.locator("#views [data-key=old]").click()
    settle(page)
    assert "velocity, in/deg" in page.locator("#old-curves .title").all_text_contents()
