"""Every view of the page against WCAG 2.2 AA, as axe-core reads it, light and dark."""

from __future__ import annotations

from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import parse_qs, urlsplit

from tests.explorer.conftest import without_browser
from tests.explorer.talk import OPTIMAL, Server
from tests.explorer.test_page import go, settle

if TYPE_CHECKING:
    from playwright.sync_api import Page

RULES = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa"]
RUN = "rules => axe.run(document, {runOnly: {type: 'tag', values: rules}, resultTypes: ['violations']})"
#: what alone the colours of the page decide
CONTRAST = "() => axe.run(document, {runOnly: ['color-contrast'], resultTypes: ['violations']})"
CUT = """() => [...document.querySelectorAll(".view:not([hidden]) :is(input[type=text], select)")].filter((one) => {
  const pen = document.createElement("canvas").getContext("2d");
  const style = getComputedStyle(one);
  pen.font = `${style.fontWeight} ${style.fontSize} ${style.fontFamily}`;
  const text = one.tagName === "SELECT" ? one.selectedOptions[0]?.textContent ?? "" : one.value || one.placeholder;
  const sides = parseFloat(style.paddingLeft) + parseFloat(style.paddingRight);
  return one.checkVisibility() && one.title !== text && pen.measureText(text).width > one.clientWidth - sides + 0.5;
}).map((one) => one.getAttribute("aria-label"))"""
#: pictures with one tick beside them, which is no scale
UNSCALED = """() => [...document.querySelectorAll(".view:not([hidden]) svg")].filter((one) =>
  one.checkVisibility() && one.querySelectorAll(".frame > .tick[text-anchor=end]").length === 1,
).map((one) => one.getAttribute("aria-label"))"""
#: fields whose border, of 3 to 1 at least, or placeholder, of 4.5 to 1, is too near to the ground that they lie on
FAINT = """() => {
  const light = (colour) => colour.match(/[\\d.]+/g).slice(0, 3).map((one) => one / 255).map((one) =>
    one <= 0.04045 ? one / 12.92 : ((one + 0.055) / 1.055) ** 2.4,
  ).reduce((sum, one, i) => sum + [0.2126, 0.7152, 0.0722][i] * one, 0.05);
  const ratio = (one, other) => Math.max(light(one) / light(other), light(other) / light(one));
  const fields = document.querySelectorAll(".view:not([hidden]) :is(input[type=text], input[type=number], select)");
  return [...fields].filter((one) => {
    const { borderTopColor, backgroundColor } = getComputedStyle(one);
    const written = getComputedStyle(one, "::placeholder").color;
    const faint = ratio(borderTopColor, backgroundColor) < 3 || ratio(written, backgroundColor) < 4.5;
    return !one.disabled && one.checkVisibility() && faint;
  }).map((one) => one.getAttribute("aria-label"));
}"""
LAWS = [OPTIMAL, {"name": "modified sine"}]


@cache
def axe() -> str:
    """The text of axe-core."""
    found = find_spec("axe_playwright_python")
    if found is None or found.origin is None:
        without_browser("no axe-core: axe-playwright-python is not installed")
    return (Path(found.origin).parent / "axe.min.js").read_text("utf-8")


def violations(page: Page, run: str = RUN) -> list[str]:
    """What axe-core finds, one line each: the rule, and the elements that break it."""
    page.evaluate(axe())
    found: list[dict[str, Any]] = page.evaluate(run, RULES)["violations"]
    return [f"{one['id']}: {node['html'][:160]} {node['failureSummary']}" for one in found for node in one["nodes"]]


def views(page: Page) -> list[str]:
    """The views that are registered."""
    names: list[str] = page.evaluate("() => import('/views.js').then(({ VIEWS }) => Object.keys(VIEWS))")
    return names


def test_every_view_keeps_wcag_cuts_no_field_and_says_the_numbers_of_its_pictures(page: Page, served: Server) -> None:
    page.emulate_media(color_scheme="light")
    go(page, f"http://{served.host}/")
    for view in views(page):
        page.locator(f"#views [data-key={view}]").click()
        settle(page)
        assert violations(page) == [], view
        assert page.evaluate(CUT) == [], view
        assert page.evaluate(UNSCALED) == [], view
        assert page.evaluate(FAINT) == [], view
        for picture in page.locator(f"#{view}-view svg[role=img]").all():
            if picture.is_visible():
                label = picture.get_attribute("aria-label") or ""
                assert any(letter.isdigit() for letter in label), (view, label)
        page.emulate_media(color_scheme="dark")
        assert violations(page, CONTRAST) == [], view
        assert page.evaluate(FAINT) == [], view
        page.emulate_media(color_scheme="light")
    # examples that were looked at and not changed are in no address
    page.wait_for_url(f"**view=%22{view}%22**")
    assert set(parse_qs(urlsplit(page.url).fragment)) <= {"view", "law", view}
    # what does not fit into a small screen is scrolled, by keys too
    page.set_viewport_size({"width": 375, "height": 800})
    for view in ("laws", "axes"):
        page.locator(f"#views [data-key={view}]").click()
        settle(page)
        assert violations(page) == [], view
