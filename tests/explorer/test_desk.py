"""The document of a tab: files that are opened and written, name and notes, in a real browser."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from optlaws import __version__
from tests.documents import ROOT
from tests.explorer.talk import OPTIMAL, Server
from tests.explorer.test_page import at_velocity, go, saves, settle, velocity

if TYPE_CHECKING:
    from playwright.sync_api import Page


def test_a_document_has_a_name_and_notes_and_is_there_another_day(page: Page, served: Server) -> None:
    go(page, f"http://{served.host}/")
    page.get_by_label("Peak velocity B, number").fill("1.8")
    settle(page)
    page.get_by_role("button", name="Notes", exact=True).click()
    page.get_by_label("Name of the document").fill("Feeder")
    page.get_by_label("Notes", exact=True).fill("first shift")
    page.get_by_role("button", name="Done").click()
    assert page.title() == "Feeder - optlaws"
    page.wait_for_timeout(200)
    page.goto("about:blank")
    go(page, f"http://{served.host}/")
    assert page.title() == "Feeder - optlaws"
    assert velocity(page) == 1.8


def test_what_is_opened_is_a_step_that_can_be_undone(page: Page, served: Server) -> None:
    go(page, f"http://{served.host}/")
    page.get_by_label("Peak velocity B, number").fill("1.8")
    settle(page)
    page.get_by_label("Files to open").set_input_files(ROOT / "problems" / "cam_rocker.toml")
    page.locator("#cam-view").wait_for()
    settle(page)
    page.get_by_label("Files to open").set_input_files(ROOT / "problems" / "mixed.toml")
    page.get_by_text("`optlaws run` does what this file says").wait_for()
    page.evaluate("hash => (location.hash = hash)", served.link(laws=[at_velocity(1.9)]).partition("#")[2])
    page.locator("#laws-view").wait_for()
    settle(page)
    assert velocity(page) == 1.9
    page.get_by_role("button", name="Undo").click()
    page.locator("#cam-view").wait_for()
    page.get_by_role("button", name="Undo").click()
    settle(page)
    assert velocity(page) == 1.8


def test_two_tabs_of_the_browser_keep_their_own_studies(page: Page, served: Server) -> None:
    go(page, f"http://{served.host}/")
    other = page.context.new_page()
    go(other, f"http://{served.host}/")
    for tab, value in ((page, "1.81"), (other, "1.92")):
        tab.get_by_label("Peak velocity B, number").fill(value)
        settle(tab)
        tab.wait_for_timeout(300)
    for tab, known in ((page, 1.81), (other, 1.92)):
        tab.reload()
        settle(tab)
        assert velocity(tab) == known


FULL = """() => {
  const key = "optlaws-document-broken";
  for (let size = 4e6; size >= 1; size /= 2) {
    try {
      localStorage.setItem(key, (localStorage.getItem(key) ?? "{") + " ".repeat(size));
    } catch {}
  }
}"""


def test_documents_of_an_earlier_version_are_not_lost(page: Page, served: Server) -> None:
    go(page, f"http://{served.host}/")
    address = "#" + served.link(laws=[at_velocity(1.77)]).partition("#")[2]
    kept = json.dumps({"title": "Feeder", "address": address, "closed": 1})
    page.evaluate("text => localStorage.setItem('optlaws-document-abc', text)", kept)
    page.evaluate(FULL)
    page.reload()
    settle(page)
    page.get_by_label("Peak velocity B, number").fill("1.8")
    page.locator("#notice", has_text="The store of this browser is full").wait_for()
    page.get_by_role("button", name="Notes", exact=True).click()
    # one that cannot be read hides none of the others, and what is not needed can be deleted
    page.get_by_role("button", name="Delete optlaws-document-broken").click()
    assert page.evaluate("() => localStorage.getItem('optlaws-document-broken')") is None
    with page.context.expect_page() as opened:
        page.get_by_role("link", name="Feeder").click()
    settle(opened.value)
    assert velocity(opened.value) == 1.77


def test_a_document_is_written_and_opened_again(page: Page, served: Server, tmp_path: Path) -> None:
    go(page, served.link(laws=[at_velocity(1.859)], picture="residual", name="Feeder", notes="first shift"))
    text = saves(page, "document")
    assert json.loads(text)["state"]["notes"] == "first shift"
    file = tmp_path / "feeder.json"
    file.write_text(text, "utf-8")
    go(page, served.link(laws=[OPTIMAL]))
    page.get_by_label("Files to open").set_input_files(file)
    page.wait_for_function("() => document.title.startsWith('Feeder')")
    settle(page)
    assert velocity(page) == 1.859


def test_a_file_that_cannot_be_opened_says_why(page: Page, served: Server, tmp_path: Path) -> None:
    go(page, served.link(laws=[OPTIMAL], picture="residual"))
    for name, text, why in (
        ("wrong.toml", "[problem]\nordre = 4\n", "ordre"),
        ("fastest.toml", 'job = "fastest"\n', "Least time needs moves"),
        ("cam.toml", 'job = "cam"\n', "Cam needs a follower and a motion with its segments"),
        ("study.json", '{"about": "optlaws document", "state": 5}', "holds no study"),
        (
            "laws.json",
            '{"about": "optlaws document", "state": {"laws": [5]}}',
            "a law needs a problem, a name or its pieces",
        ),
        ("words.json", '{"words": "optlaws document"}', "format of a law must be 1"),
    ):
        file = tmp_path / name
        file.write_text(text, "utf-8")
        page.get_by_label("Files to open").set_input_files(file)
        page.locator("#notice", has_text=why).wait_for()
    assert page.locator("#laws-view").is_visible()


def test_a_law_is_read_in_the_units_of_its_machine(page: Page, served: Server) -> None:
    go(page, served.link(laws=[OPTIMAL, {"name": "modified sine"}], picture="residual"))
    for name, value in (("stroke", "35 mm"), ("time", "0.1 s"), ("mass", "2 kg")):
        page.get_by_label(f"{name} of the machine").fill(value)
    settle(page)
    rows = page.locator("#table .in-units")
    (view, _) = served.ask("laws", {"laws": [OPTIMAL, {"name": "modified sine"}]})["laws"]
    B, C, D, J, rms = (one["value"] for one in view["constants"])
    for row, values in ((0, [350 * B, 3.5 * C, 35 * J, 3.5 * rms]), (1, [7 * C, 2.45 * D, 7 * rms])):
        units = [text.split()[0] for text in rows.nth(row).locator("td").all_inner_texts() if text]
        assert [float(text) for text in units] == pytest.approx(values, rel=1e-4)
    page.get_by_label("stroke of the machine").fill("35 kg")
    settle(page)
    assert "35 kg" in rows.first.inner_text()


def test_a_report_has_the_name_and_the_notes_of_the_document(page: Page, served: Server) -> None:
    go(page, served.link(laws=[OPTIMAL], view="cycle", name="Feeder", notes="first shift"))
    report = saves(page, "report")
    page.get_by_text("Save", exact=True).click()
    with page.expect_download() as download:
        page.locator("[data-kind=table]").click()
    assert download.value.suggested_filename == "Feeder.csv"
    for text in ("<h1>Feeder</h1>", "<p>first shift</p>", f"<p>optlaws {__version__}</p>", "616"):
        assert text in report


def focused(page: Page) -> str:
    return str(
        page.evaluate("() => document.activeElement.getAttribute('aria-label') ?? document.activeElement.tagName")
    )


def test_the_focus_stays_where_the_reader_is(page: Page, served: Server) -> None:
    none = {"problem": {"order": 4, "degree": 9, "B": 1.7, "J": [0, 20]}}
    go(page, served.link(laws=[none, OPTIMAL], picture="residual"))
    for name in ("+ copy", "raise the bound of J from 20 to"):
        page.get_by_role("button", name=name).focus()
        page.keyboard.press("Enter")
        settle(page)
        assert focused(page) != "BODY"
    page.get_by_label("Take", exact=False).last.focus()
    page.keyboard.press("Enter")
    settle(page)
    assert focused(page) != "BODY"
    page.get_by_role("tab", name="C over B").click()
    settle(page)
    known = page.get_by_role("button", name="modified sine: B")
    known.focus()
    name = focused(page)
    page.keyboard.press("Enter")
    settle(page)
    assert focused(page) == name


def test_two_keys_lead_to_the_law_in_the_plane(page: Page, served: Server) -> None:
    go(page, f"http://{served.host}/")
    page.keyboard.press("Tab")
    page.keyboard.press("Enter")
    assert focused(page) == "The law in the plane: B"
    page.keyboard.press("ArrowRight")
    settle(page)
    assert velocity(page) == 1.71


def test_words_are_explained_in_every_view_that_has_its_own(page: Page, served: Server) -> None:
    for view, words in (("laws", "peak jerk"), ("cam", "less the radius of the roller"), ("cycle", "drag the joints")):
        go(page, served.link(view=view, laws=[OPTIMAL]))
        page.get_by_text("What is shown").locator("visible=true").click()
        assert page.get_by_text(words).locator("visible=true").first.is_visible()
