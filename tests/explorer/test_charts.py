"""Curves in a real browser: what a cursor reads, what is zoomed, where peaks are marked, what is dragged on them."""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING, Any

import pytest

from tests.explorer.talk import OPTIMAL, Server
from tests.explorer.test_page import go, settle
from tests.internals.explorer import cam_view, example

if TYPE_CHECKING:
    from playwright.sync_api import FloatRect, Locator, Page

STEEP = {"problem": {"order": 4, "degree": 41, "B": 1.7}}


def boxes(texts: Locator) -> list[FloatRect]:
    return [box for box in (one.bounding_box() for one in texts.all()) if box is not None]


def apart(one: FloatRect, other: FloatRect) -> bool:
    across = one["x"] + one["width"] <= other["x"] or other["x"] + other["width"] <= one["x"]
    return across or one["y"] + one["height"] <= other["y"] + 2 or other["y"] + other["height"] <= one["y"] + 2


def cursor_text(page: Page, root: str) -> str:
    return page.locator(f"{root} .dial").get_attribute("aria-valuetext") or ""


def test_the_cursor_reads_the_law_where_it_was_computed(page: Page, served: Server) -> None:
    go(page, served.link(laws=[OPTIMAL, {"name": "modified sine"}], picture="residual"))
    (view, other) = served.ask("laws", {"laws": [OPTIMAL, {"name": "modified sine"}]})["laws"]
    dial = page.locator("#curves .dial")
    dial.focus()
    page.keyboard.press("Home")
    for _ in range(4):
        page.keyboard.press("Shift+ArrowRight")
    curves = [panel["series"][0] for panel in view["panels"]]
    k = curves[0]["at"]
    assert all(curve["at"] == k for curve in curves)
    texts = [
        f"{letter} {curve['values'][40]:.6g}".replace("-", "−") for letter, curve in zip("abcdj", curves, strict=True)
    ]
    assert cursor_text(page, "#curves") == f"k = {k[40]:.6g}: {', '.join(texts)}"
    page.keyboard.press("PageDown")
    first = max(mark["at"] for panel in view["panels"] for mark in panel["peaks"] if mark["at"] < k[40])
    assert page.locator("#curves .cursor-value").inner_text() == f"k = {first:.6g}"
    box = page.locator("#curves svg").nth(1).bounding_box()
    assert box is not None
    page.mouse.move(box["x"] + 64 + 0.5 * (box["width"] - 78), box["y"] + 50)
    readings = page.locator("#curves .reading tspan").all_text_contents()
    for reading, shown in zip(readings[2:], (view, other), strict=False):
        velocity = shown["panels"][1]["series"][0]
        assert reading.strip()[2:] == f"{velocity['values'][velocity['at'].index(0.5)]:.6g}"
    page.mouse.move(5, 5)
    assert page.locator("#curves .cursor-value").inner_text() == f"k = {first:.6g}"


def test_curves_are_zoomed_moved_and_whole_again(page: Page, served: Server) -> None:
    go(page, served.link(laws=[OPTIMAL], picture="residual"))
    ticks = page.locator("#curves svg >> nth=4 >> .tick")
    whole = ticks.all_text_contents()
    box = page.locator("#curves svg >> nth=2").bounding_box()
    assert box is not None
    x, y = box["x"] + 100, box["y"] + 50
    page.mouse.move(x, y)
    for _ in range(4):
        page.mouse.wheel(0, -100)
    page.locator("#curves.zoomed").wait_for()
    zoomed = ticks.all_text_contents()
    page.mouse.down()
    page.mouse.move(x - 60, y, steps=3)
    page.mouse.up()
    assert ticks.all_text_contents() != zoomed
    page.locator("#curves").get_by_role("button", name="Show the whole curves").click()
    assert ticks.all_text_contents() == whole
    page.locator("#curves .dial").focus()
    page.keyboard.press("+")
    assert ticks.all_text_contents() != whole
    page.keyboard.press("0")
    assert ticks.all_text_contents() == whole


@pytest.mark.parametrize(("view", "root"), [("laws", "#curves"), ("cycle", "#motion"), ("cam", "#cam-curves")])
def test_what_is_written_at_peaks_never_overlaps(page: Page, served: Server, view: str, root: str) -> None:
    go(page, served.link(laws=[STEEP], view=view, picture="residual"))
    for panel in page.locator(f"{root} .curve").all():
        written = boxes(panel.locator(".peak text, .title"))
        assert all(apart(one, other) for one, other in combinations(written, 2))
    assert page.locator(f"{root} .peak circle").count() > 1


def durations(page: Page) -> list[str]:
    return [page.get_by_label(f"segment {i} duration").input_value() for i in range(3)]


def test_segments_are_dragged_inserted_reordered_and_named(page: Page, served: Server) -> None:
    go(page, served.link(view="cycle", cycle=example(), laws=[OPTIMAL]))
    joint = page.get_by_role("slider", name="Where Rise ends and Dwell begins")
    box, strip = joint.bounding_box(), page.locator("#motion .strip").bounding_box()
    assert box is not None
    assert strip is not None
    x, y = box["x"] + box["width"] / 2, box["y"] + 10
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 10 * (strip["width"] - 78) / 360, y, steps=2)
    page.mouse.up()
    settle(page)
    assert durations(page) == ["130 deg", "80 deg", "100 deg"]
    assert page.locator("#segments tbody tr >> nth=0 >> td >> nth=2").inner_text() == "130"
    joint.press("ArrowLeft")
    settle(page)
    assert durations(page)[:2] == ["129 deg", "81 deg"]
    page.get_by_label("segment 0 name").fill("lift")
    settle(page)
    assert page.locator("#segments tbody th").first.inner_text() == "lift"
    page.get_by_label("Move down segment 1").click()
    settle(page)
    assert durations(page) == ["81 deg", "129 deg", "100 deg"]
    page.get_by_label("Insert a segment after segment 1").click()
    settle(page)
    assert page.locator("#segments table").first.locator("tbody tr").count() == 6
    page.get_by_label("Take away segment 2").click()
    settle(page)
    assert page.locator("#segments table").first.locator("tbody tr").count() == 5


def test_one_cursor_goes_through_the_cam_its_curves_and_what_is_read(page: Page, served: Server) -> None:
    go(page, served.link(view="cam", laws=[OPTIMAL]))
    panels: list[dict[str, Any]] = served.ask("cam", {"study": cam_view.example()})["panels"]
    page.get_by_label("Angle of the cam, degrees").fill("165")
    shown = page.locator("#cam-reading").inner_text()
    for panel in panels:
        (curve,) = panel["series"]
        value = curve["values"][curve["at"].index(165.0)]
        assert f"{panel['name']} {value:.6g} {panel['unit']}".replace("-", "−") in shown
    box = page.locator("#cam-curves svg").first.bounding_box()
    assert box is not None
    page.mouse.move(box["x"] + 64 + 0.25 * (box["width"] - 78), box["y"] + 60)
    assert page.get_by_label("Angle of the cam, degrees").input_value() == "90"
    assert page.locator("#cam-reading").inner_text().startswith("at 90 deg")


def test_the_segment_at_the_cursor_stands_out_in_the_table(page: Page, served: Server) -> None:
    go(page, served.link(view="cycle", laws=[OPTIMAL]))
    box = page.locator("#motion .curve").first.bounding_box()
    assert box is not None
    page.mouse.move(box["x"] + 64 + 0.75 * (box["width"] - 78), box["y"] + 40)
    assert page.locator("#segments [aria-current] th").inner_text() == "Return"
