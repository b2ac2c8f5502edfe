"""Advice on the page: its numbers against the library, the law that is taken, in a real browser."""

from __future__ import annotations

import json
import tomllib
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from optlaws import Advice, Cycle, Plan, advise
from tests.explorer.talk import OPTIMAL, Server, written
from tests.explorer.test_page import go, settle
from tests.internals.explorer import CycleRequest, cycle_view, example, machine_view, start
from tests.internals.jobs import read_of_cycle_entries

if TYPE_CHECKING:
    from playwright.sync_api import Page

PROBLEMS = Path(__file__).parents[2] / "problems"
FOLLOWER = {"frequency": ["20 Hz", "24 Hz"], "damping": 0.05}


def known(data: dict[str, Any]) -> Cycle:
    return next(iter(read_of_cycle_entries(data, Path("known"))[1].values()))


def advised(study: dict[str, Any], **entries: Any) -> Advice:
    return advise(known(study), points=0, **entries)


def changed(study: dict[str, Any], take: dict[str, Any]) -> Plan:
    """The cycle with a law that the page takes."""
    axis = study["axis"][0]
    pairs = zip(axis["segment"], take["laws"], strict=True)
    segments = [segment if law is None else {**segment, "law": law} for segment, law in pairs]
    others = {name: take[name] for name in ("minimise", "limits", "degree") if name in take}
    return known({**study, "axis": [{**axis, **others, "segment": segments}]}).unchecked()


@pytest.mark.parametrize("follower", [None, FOLLOWER])
def test_the_rows_are_the_library_s_and_each_law_can_be_taken(served: Server, follower: dict[str, Any] | None) -> None:
    study = example() | {"speed": "150 rpm"}
    answer = served.ask("advice", {"study": study, "follower": follower} if follower else {"study": study})
    of = None if follower is None else {"frequency": ("20 Hz", "24 Hz"), "damping": 0.05}
    advice = advised(study, follower=of)
    assert [f"{each['name']}, {each['unit']}" for each in answer["measures"]] == [
        measure.heading for measure in advice.measures
    ]
    assert [row["name"] for row in answer["rows"]] == [law.name for law in advice]
    assert answer["chosen"] == advice.recommendation.law.name
    sentences = [said.replace("^2", "²").replace("^3", "³") for said in advice.recommendation.sentences]
    assert [written(said) for said in answer["sentences"]] == sentences
    assert answer["rule"] == advice.recommendation.rule
    for row, law in zip(answer["rows"], advice, strict=True):
        assert row["values"] == [law.values[measure.name] for measure in advice.measures]
        taken = changed(study, row["take"])
        for name in ("velocity", "acceleration", "jerk"):
            assert taken.value(name) == pytest.approx(law.values[name], rel=1e-6)
        # laws that were sought within limits are proven by the cycle itself
        assert bool(taken.solutions) == (follower is None and law.kind == "optimal")
    (curves,) = answer["picture"]["front"]
    points, reached, below = (curve["values"] for curve in curves)
    assert len(points) > 1
    assert all(bound <= value * (1.0 + 1e-7) for value, bound in zip(reached, below, strict=True))


def test_a_machine_is_advised_by_its_torque(served: Server) -> None:
    found = start(str(PROBLEMS / "cycle_geared_table.toml"))
    machine = found["machine"]
    answer = served.ask("advice", {"study": machine, "axis": 0, "minimise": "acceleration", "points": 0})
    file = PROBLEMS / "cycle_geared_table.toml"
    cycles = dict(read_of_cycle_entries(tomllib.loads(file.read_text("utf-8")), file)[1])
    advice = advise(next(iter(cycles.values())), minimise="acceleration", points=0)
    assert [row["values"] for row in answer["rows"]] == [
        [law.values[measure.name] for measure in advice.measures] for law in advice
    ]
    assert [measure["name"] for measure in answer["measures"]][3:6] == ["RMS acceleration", "torque", "RMS torque"]
    for row in answer["rows"]:
        del row["take"]  # entries of a file
    assert "rms " not in json.dumps(answer)


@pytest.mark.long
def test_starts_of_a_flat_optimum_agree_as_soon_as_they_are_known_to() -> None:
    cycle = cycle_view.cycle(CycleRequest(study=machine_view.example(), axis=1))
    for solution in advise(cycle.specification, points=0)["least torque"].solutions:
        least, *others = solution.starts
        assert len(others) <= 1  # none where the limit of the drive leaves little slack
        assert all(other <= least * (1.0 + 1e-3) for other in others)


def test_what_cannot_be_advised_says_why(served: Server) -> None:
    study = example()
    for entries, reason in (
        ({"minimise": "beauty"}, "beauty"),
        ({"minimise": "residual acceleration"}, "follower"),
        ({"follower": {"frequency": ["3 mm", "4 Hz"]}}, "frequency"),
    ):
        assert reason in served.ask("advice", {"study": study, **entries})["refused"]["reason"]
    study["axis"][0]["limits"] = {"acceleration": "5 m/s^2"}
    assert served.ask("advice", {"study": study})["refused"]["word"] == "no such law"
    assert "error" in served.ask("advice", {"study": study, "follower": 3}, code=422)


def test_the_law_to_take_is_taken_by_a_click(page: Page, served: Server) -> None:
    go(page, served.link(laws=[OPTIMAL], view="advice", cycle=example() | {"speed": "150 rpm"}))
    answer = served.ask("advice", {"study": example() | {"speed": "150 rpm"}})
    words = page.locator("#advice-words").inner_text()
    assert all(written(said) in words for said in answer["sentences"])
    assert page.locator("#advice-table tbody tr[aria-current] .row-name").inner_text() == answer["chosen"]
    cells = page.locator("#advice-table tbody tr >> nth=0 >> td.number").all_inner_texts()
    scales = [1e3 if measure["unit"] == "m/s" else 1.0 for measure in answer["measures"]]  # the page is in mm/s
    values = [scale * value for scale, value in zip(scales, answer["rows"][0]["values"], strict=True)]
    assert [float(cell) for cell in cells[: len(values)]] == pytest.approx(values, rel=1e-4)
    assert answer["chosen"] in (page.locator("#advice-chart [role=img]").get_attribute("aria-label") or "")
    page.get_by_role("button", name="Take this law").click()
    assert page.evaluate("() => document.activeElement.dataset.key") == "cycle"
    settle(page)
    assert "proven optimal" in page.locator("#cycle-trust").inner_text()
    (row,) = [row for row in answer["rows"] if row["name"] == answer["chosen"]]
    peaks = page.locator("#segments tbody tr >> nth=0 >> td.number").all_inner_texts()
    jerks = [float(text) for text in peaks[-1:]]
    jerk = [measure["name"] for measure in answer["measures"]].index("jerk")
    assert jerks[0] <= row["values"][jerk] * (1.0 + 1e-4)
    page.get_by_role("button", name="Undo").click()
    settle(page)
    assert page.locator("#advice-view").is_visible()
    page.get_by_role("button", name="Take cycloidal").click()
    settle(page)
    assert page.get_by_label("segment 0 law").input_value() == "cycloidal"


def test_a_follower_is_switched_on(page: Page, served: Server) -> None:
    go(page, served.link(laws=[OPTIMAL], view="advice"))
    assert page.get_by_label("follower, from").is_disabled()
    page.get_by_label("an elastic follower").check()
    settle(page)
    page.get_by_label("follower, from").fill("20 Hz")
    page.get_by_label("follower, to").fill("24 Hz")
    settle(page)
    head = page.locator("#advice-table thead").inner_text()
    assert "residual acceleration, m/s²" in " ".join(head.split())
    answer = served.ask("advice", {"study": example(), "follower": FOLLOWER})
    assert written(answer["sentences"][1]) in page.locator("#advice-words").inner_text()
    page.get_by_label("least", exact=True).select_option("jerk")
    settle(page)
    assert "its jerk is" in page.locator("#advice-words").inner_text()


def test_standard_laws_are_there_before_those_that_are_searched_for(page: Page, served: Server) -> None:
    machine = start(str(PROBLEMS / "cycle_rocker.toml"))["machine"]
    quick = served.ask("advice-standard", {"study": machine})
    page.goto(served.link(laws=[OPTIMAL], view="advice", machine=machine))
    page.locator("#advice-words").get_by_role("button", name="Stop").click()
    page.locator("#advice-words").get_by_role("button", name="Go on").wait_for()
    settle(page)
    names = page.locator("#advice-table .row-name").all_inner_texts()
    assert names[: len(quick["rows"])] == [row["name"] for row in quick["rows"]]
    assert page.get_by_label("steps of the advice").get_attribute("max") == "3"


@pytest.mark.long
def test_the_laws_of_a_driven_machine_fit_beside_their_picture(page: Page, served: Server) -> None:
    go(page, served.link(view="machine", machine=machine_view.example(), axis=1))
    page.get_by_role("tab", name="Advice").click()
    page.locator("#advice-table [data-ends=proof]").first.wait_for(timeout=120_000)
    width, room = page.locator("#advice-table").evaluate("(one) => [one.scrollWidth, one.clientWidth]")
    assert width <= room
