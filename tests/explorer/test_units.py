"""Units of the page: decimal commas are read, numbers are shown in the units of the reader."""

from __future__ import annotations

import json
import re
from math import pi
from typing import TYPE_CHECKING

import pytest

from tests.explorer.talk import OPTIMAL, Server
from tests.explorer.test_page import go, settle, told
from tests.internals.explorer import example

if TYPE_CHECKING:
    from playwright.sync_api import Page


def test_decimal_commas_are_read(page: Page, served: Server) -> None:
    go(page, f"http://{served.host}/")
    field = page.locator("#ask .field", has_text="B").locator("input.numeric").first
    assert field.input_value() == "1.7"
    field.fill("1,85")
    settle(page)
    law = {"problem": OPTIMAL["problem"] | {"B": 1.85}}
    assert page.locator("#table tbody tr >> nth=0 >> [data-constant]").all_inner_texts() == told(served, law)
    page.locator("#views [data-key=cycle]").click()
    settle(page)
    page.locator("#programme .entry").get_by_label("limit velocity", exact=True).fill("700,5 mm/s")
    settle(page)
    assert "proven optimal" in page.locator("#cycle-trust").inner_text()
    # what stands in brackets is a formula, whose commas part its arguments
    script = "([text]) => import('/units.js').then(({ plain }) => plain(text))"
    texts = ["700,5 mm/s", "max(1,2)", ",5", "12, 14"]
    assert [page.evaluate(script, [text]) for text in texts] == ["700.5 mm/s", "max(1,2)", "0.5", "12, 14"]


def test_numbers_are_shown_in_the_units_of_the_reader(page: Page, served: Server) -> None:
    go(page, served.link(view="cycle", laws=[OPTIMAL]))
    page.get_by_text("Settings").click()
    with page.expect_navigation():
        page.get_by_label("length").select_option("in")
    settle(page)
    shown = served.ask("cycle", {"study": example()})
    peak = shown["panels"][1]["peaks"][-1]
    mark = page.locator("#motion .curve >> nth=1 >> .peak text").last.text_content() or ""
    assert float(mark) == pytest.approx(peak["value"] / 25.4, rel=1e-3)
    assert page.locator("#motion .title").all_text_contents()[1] == "velocity, in/s"
    cell = page.locator("#segments tbody tr >> nth=0 >> td >> nth=4").inner_text()
    assert float(cell) == pytest.approx(616 / 25.4, rel=1e-3)
    least = float(re.findall(r"least acceleration ([\d.]+) in/s²", page.locator("#cycle-trust").inner_text())[0])
    assert least == float(f"{26.51039 / 0.0254:.6g}")
    page.locator("#views [data-key=advice]").click()
    settle(page)
    assert "acceleration, in/s²" in " ".join(page.locator("#advice-table thead").inner_text().split())
    advised = served.ask("advice", {"study": example()})["rows"][0]["values"]
    cell = page.locator("#advice-table tbody tr >> nth=0 >> td >> nth=1").inner_text()
    assert float(cell) == pytest.approx(1000.0 * advised[1] / 25.4, rel=1e-4)
    page.locator("#views [data-key=fastest]").click()
    settle(page)
    speed = page.locator("#fastest-table tbody tr >> nth=0 >> td >> nth=0").inner_text()
    assert float(speed.removesuffix(" in/s")) == pytest.approx(616.0 / 25.4, rel=1e-5)
    page.locator("#views [data-key=old]").click()
    settle(page)
    assert "velocity, in/deg" in page.locator("#old-curves .title").all_text_contents()


SHOWN = r"[−-]?\d+(?:\.\d+)? (?:mm(?:/s)?|m/s[²³]?|deg(?:/s)?|rpm)(?![\w/²³^·])"
OTHER_VIEWS = ["laws", "cycle", "axes", "old", "advice"]
ALL_TEXTS = """() => [...document.querySelectorAll(".view:not([hidden]) > :not(aside)")].flatMap((root) => [
  root.innerText, ...[...root.querySelectorAll("[aria-label], [title], [aria-valuetext]")].flatMap((one) =>
    ["aria-label", "title", "aria-valuetext"].map((name) => one.getAttribute(name) ?? "")),
  ...[...root.querySelectorAll("svg text, svg title")].map((one) => one.textContent),
])"""


@pytest.mark.parametrize(
    "view",
    ["machine", "fastest", "cam", *(pytest.param(view, marks=pytest.mark.long) for view in OTHER_VIEWS)],
)
def test_no_text_of_a_view_has_a_number_in_a_unit_that_the_reader_left(page: Page, served: Server, view: str) -> None:
    units = json.dumps({"length": "in", "angle": "rad", "speed": "1/min"})
    page.add_init_script(f"localStorage.setItem('optlaws-units', {units!r})")
    go(page, served.link(view=view, laws=[OPTIMAL]))
    settle(page)
    assert [text for text in page.evaluate(ALL_TEXTS) if re.search(SHOWN, text)] == []
    named = page.locator("svg :is(.name, .title)").all_text_contents()
    assert [text for text in named if re.search(r", (mm|deg|rpm)\b", text)] == []


def test_numbers_are_written_to_their_digits_in_every_unit(page: Page, served: Server) -> None:
    page.add_init_script(
        """localStorage.setItem("optlaws-units", '{"length": "in", "angle": "rad", "speed": "1/min"}')"""
    )
    page.goto(f"http://{served.host}/")
    script = "(all) => import('/units.js').then(({ number }) => all.map(([value, unit]) => number(value, unit, 6)))"
    sizes = {
        "": 1.0,
        "N": 1.0,
        "mm": 1 / 25.4,
        "m/s²": 1 / 0.0254,
        "deg": pi / 180,
        "rpm": 1.0,
        "mm/deg²": (180 / pi) ** 2 / 25.4,
    }
    values = [
        sign * value * 10.0**power for sign in (1, -1) for value in (1.0, 6.1600000001) for power in range(-12, 13, 3)
    ]
    given = [(value, unit) for value in values for unit in sizes]
    for (value, unit), text in zip(given, page.evaluate(script, given), strict=True):
        assert float(text.replace("−", "-")) == pytest.approx(sizes[unit] * value, rel=5e-6)
        assert len(re.sub(r"e.*|\D", "", text).strip("0")) <= 6
    assert page.evaluate(script, [[None, "mm"], [0, "mm"]]) == ["∞", "0"]
