"""Several axes in the page: bars that are dragged, interlocks that are proven, moves that are put together."""

from __future__ import annotations

from copy import deepcopy
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from tests.documents import ROOT
from tests.explorer.talk import Server, written
from tests.explorer.test_page import go, settle
from tests.internals.explorer import axes_view, start
from tests.internals.jobs import read_given

if TYPE_CHECKING:
    from playwright.sync_api import Page

    from optlaws import Axes

FILE = ROOT / "problems" / "cycle_die_and_table.toml"
BOX = {
    "kind": "forbidden",
    "name": "box",
    "axis": "x",
    "across": "z",
    "corners": [["20 mm", "0 mm"], ["280 mm", "0 mm"], ["280 mm", "30 mm"], ["20 mm", "30 mm"]],
}
LIMITS = {"acceleration": "20 m/s^2"}
ACROSS = [
    {"kind": "dwell", "duration": "0.2 s"},
    {"kind": "rise", "by": "300 mm", "duration": "0.4 s", "law": "cycloidal"},
    {"kind": "dwell", "duration": "0.4 s"},
    {"kind": "return", "by": "300 mm", "duration": "0.4 s", "law": "cycloidal"},
    {"kind": "dwell"},
]
LIFT = [
    {"kind": "rise", "by": "80 mm", "duration": "0.2 s", "law": "cycloidal"},
    {"kind": "dwell"},
    {"kind": "return", "by": "80 mm", "duration": "0.2 s", "law": "cycloidal"},
]


def robot() -> dict[str, Any]:
    axes = [{"name": "x", "limits": LIMITS, "segment": ACROSS}, {"name": "z", "limits": LIMITS, "segment": LIFT}]
    return {"job": "cycle", "title": "A robot", "period": "1.6 s", "interlocks": [BOX], "axis": axes}


def axes_of(study: dict[str, Any]) -> Axes:
    return read_given(study, Path("study"))[1]


@pytest.mark.parametrize("study", [axes_view.example(), robot()])
def test_what_is_drawn_and_proven_of_axes_is_the_library_s(served: Server, study: dict[str, Any]) -> None:
    axes = axes_of(study)
    shown = served.ask("axes", {"study": study})
    seconds = np.array(shown["at"]) * axes.duration / 360.0
    for row, (name, cycle) in zip(shown["rows"], axes.items(), strict=True):
        assert row["name"] == name
        assert row["values"] == pytest.approx(1e3 * cycle(seconds), abs=1e-3)
        assert [bar["from"] for bar in row["bars"]] == pytest.approx(
            [360.0 * peaks.start / axes.duration for peaks in cycle.peaks]
        )
        assert row["cells"][2] == {"value": pytest.approx(cycle.peak(2), rel=1e-5), "unit": "m/s²", "digits": 6}
    for panel, rule in zip(shown["panels"], axes.rules, strict=True):
        rooms = 1e3 * rule.room(axes, np.array(panel["series"][0]["at"]) * axes.duration / 360.0)
        assert panel["series"][0]["values"] == pytest.approx(rooms, abs=2e-3)
    proven = served.ask("axes-clearances", {"study": study})
    for results, least in zip(proven["rows"], axes.clearances, strict=True):
        assert (results["status"], results["at"]) == (least.status, least.angle)
        # whole thousandths of a millimetre, none of them too many
        value, clearance = results["value"]["value"], 1e3 * least.clearance
        assert value == round(value, 3)
        assert -1e-3 < value - clearance <= 1e-9
    for panel, least in zip(proven["panels"], axes.clearances, strict=True):
        (peak,) = panel["peaks"]
        (curve,) = panel["series"]
        assert curve["values"][curve["at"].index(peak["at"])] == pytest.approx(1e3 * least.clearance, abs=1e-6)
    assert proven["trust"]["word"].startswith("interlocks clear" if not axes.broken else "interlock broken")


def test_moves_are_put_together_as_the_library_does(served: Server) -> None:
    study = axes_view.example() | {"overlap": {"goal": "acceleration", "of": ["die"]}}
    best = axes_of(study).least_acceleration("die")
    made = served.ask("axes-together", {"study": study})
    assert f"{best.objective:.6g}" in made["facts"][1]
    again = axes_of(made["study"])
    assert again.broken == ()
    assert again["die"].peak(2) == pytest.approx(best.axes["die"].peak(2), rel=1e-9)
    quick = robot() | {"overlap": {"goal": "period"}}
    period = served.ask("axes-together", {"study": quick})["study"]["period"]
    assert float(period.split()[0]) == pytest.approx(axes_of(quick).fastest().objective, rel=1e-9)
    free = deepcopy(quick)
    for segment in (segment for axis in free["axis"] for segment in axis["segment"]):
        segment.pop("law", None)
    sought = axes_of(served.ask("axes-together", {"study": free})["study"])
    assert sought.broken == ()
    # the fastest laws keep the limits of their axes
    assert max(cycle.peak(2) for cycle in sought.values()) == pytest.approx(20.0, rel=1e-6)
    assert "say what" in served.ask("axes-together", {"study": robot()})["refused"]["reason"]


def test_axes_are_saved_as_python_that_makes_them(served: Server) -> None:
    found = start(str(FILE))
    assert found["view"] == "axes"
    shown = axes_of(found["machine"])
    made: dict[str, Any] = {}
    asked = {"kind": "python", "view": "axes", "request": {"study": found["machine"]}}
    text = served.ask("save", asked)["text"]
    exec("\n".join(text.splitlines()[:-1]), made)  # noqa: S102 - all but its picture
    assert [least.clearance for least in made["axes"].clearances] == [least.clearance for least in shown.clearances]
    assert {name: cycle.peak(2) for name, cycle in made["axes"].items()} == {
        name: cycle.peak(2) for name, cycle in shown.items()
    }


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (lambda study: study["axis"][1].update(name="table"), "two axes are called table"),
        (lambda study: study["interlocks"][0].update(of="dye"), "unknown axis 'dye'"),
        (lambda study: study["axis"][1].update(mechanism={"kind": "rack"}), "mechanism"),
        (lambda study: study["axis"][1]["segment"][1].update(law="x.json"), "x.json names a file"),
    ],
)
def test_axes_that_are_none_say_why(served: Server, change: Any, reason: str) -> None:
    study = axes_view.example()
    change(study)
    for name in ("axes", "axes-clearances", "axes-together"):
        assert reason in served.ask(name, {"study": study})["refused"]["reason"]


# --- in the browser ---


def drag(page: Page, key: str, by: float) -> None:
    """Drag a bar by so many degrees of the master."""
    box = page.locator(f'[data-key="{key}"]').bounding_box()
    frame = page.locator("#axes-timing .grid").first.bounding_box()
    last = page.locator("#axes-timing .grid").nth(8).bounding_box()
    assert box is not None
    assert frame is not None
    assert last is not None
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] - 10
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + by * (last["x"] - frame["x"]) / 360.0, y, steps=12)
    page.mouse.up()
    settle(page)


def test_bars_are_dragged_until_an_interlock_breaks(page: Page, served: Server) -> None:
    go(page, served.link(view="axes"))
    bar = page.locator('[data-key="bar 1 0"]')
    assert bar.get_attribute("aria-valuetext") == "from 50 deg to 105 deg"
    drag(page, "bar 1 0", 45.0)
    assert bar.get_attribute("aria-valuetext") == "from 95 deg to 150 deg"
    assert "interlock broken" in page.locator("#axes-trust").inner_text()
    assert page.locator("#axes-timing .interlock.broken").count() > 0
    page.get_by_role("button", name="Undo").click()
    settle(page)
    assert bar.get_attribute("aria-valuetext") == "from 50 deg to 105 deg"
    bar.focus()
    for key in ("ArrowRight", "ArrowRight", "Shift+ArrowUp"):
        page.keyboard.press(key)
    settle(page)
    assert bar.get_attribute("aria-valuetext") == "from 52 deg to 117 deg"
    assert page.evaluate("() => document.activeElement.dataset.key") == "bar 1 0"
    page.get_by_label("put the moves together for").select_option("acceleration")
    page.get_by_role("checkbox", name="of table").uncheck()
    page.get_by_role("checkbox", name="of die").check()
    page.get_by_role("button", name="Put the moves together").click()
    settle(page)
    assert "interlocks clear" in page.locator("#axes-trust").inner_text()
    page.get_by_role("button", name="Run").click()
    page.wait_for_function("() => Number(document.querySelector('#axes-run input').value) > 2")
    page.get_by_role("button", name="Pause").click()
    assert "die" in page.locator("#axes-reading").inner_text()


def test_the_corner_of_a_forbidden_region_is_moved(page: Page, served: Server) -> None:
    go(page, served.link(view="axes", axes=robot()))
    corner = page.get_by_label("box: corner 3")
    corner.focus()
    page.keyboard.press("Shift+ArrowUp")
    settle(page)
    assert page.get_by_label("interlocks 0 corners").input_value().split(", ")[2] == "280 mm: 31 mm"
    changed = robot()
    changed["interlocks"] = [BOX | {"corners": [*BOX["corners"][:2], ["280 mm", "31 mm"], BOX["corners"][3]]}]
    (results,) = served.ask("axes-clearances", {"study": changed})["rows"]
    assert written(results["value"]) in page.locator("#axes-table").inner_text()


def test_axes_are_added_renamed_and_removed_with_what_names_them(page: Page, served: Server) -> None:
    go(page, served.link(view="axes"))
    assert "die 0 mm" in page.locator("#axes-reading").inner_text()
    page.get_by_label("put the moves together for").select_option("acceleration")
    page.get_by_label("name of axis 1").fill("turret")
    page.keyboard.press("Tab")
    settle(page)
    assert "interlocks clear" in page.locator("#axes-trust").inner_text()
    assert page.get_by_label("interlocks 1 of").input_value() == "turret"
    page.get_by_role("button", name="+ axis").click()
    settle(page)
    assert page.get_by_label("Axes with their peaks").locator("tbody th").all_inner_texts() == [
        "turret",
        "die",
        "axis 3",
    ]
    page.get_by_label("name of axis 3").fill("die")  # which another one is called
    page.keyboard.press("Tab")
    assert page.get_by_label("name of axis 3").input_value() == "axis 3"
    page.get_by_role("button", name="Remove axis 1").click()
    settle(page)
    assert page.get_by_label("Axes with their peaks").locator("tbody th").all_inner_texts() == ["die", "axis 3"]
    assert "no interlocks" in page.locator("#axes-trust").inner_text()
    page.get_by_role("button", name="Undo").click()
    settle(page)
    assert "interlocks clear" in page.locator("#axes-trust").inner_text()


def test_an_interlock_of_another_kind_has_the_fields_that_it_declares(page: Page, served: Server) -> None:
    go(page, served.link(view="axes", axes=robot()))
    page.get_by_label("interlocks 0 kind").select_option("clearance")
    page.get_by_label("interlocks 0 least").fill("")
    page.get_by_label("interlocks 0 most").fill("0 mm: 5 mm, 300 mm: 90 mm")
    page.get_by_label("interlocks 0 most").press("Tab")
    settle(page)
    changed = robot()
    bound = [["0 mm", "5 mm"], ["300 mm", "90 mm"]]
    changed["interlocks"] = [{"kind": "clearance", "name": "box", "axis": "x", "over": "z", "most": bound}]
    (results,) = served.ask("axes-clearances", {"study": changed})["rows"]
    assert written(results["value"]) in page.locator("#axes-table").inner_text()
    assert page.get_by_label("interlocks 0 corners").count() == 0
    page.get_by_label("interlocks 0 kind").select_option("synchronous")
    settle(page)
    assert page.get_by_label("interlocks 0 during").input_value() == "60 deg, 120 deg"
    assert page.get_by_label("interlocks 0 to", exact=True).input_value() == "z"
