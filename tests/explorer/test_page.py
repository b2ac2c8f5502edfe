"""The page in a real browser: what is dragged, typed and linked, and what it shows."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import parse_qs, urlsplit
from xml.etree import ElementTree as ET

import pytest

from tests.explorer.conftest import Watch
from tests.explorer.talk import OPTIMAL, Server, written
from tests.internals.explorer import cam_view, cycle_view

if TYPE_CHECKING:
    from playwright.sync_api import Page, Route

CONSTANTS = ("B", "C", "D", "J", "rms_c")
NONE = {"problem": {"order": 4, "degree": 9, "B": 1.7, "J": [0, 20]}}


def settle(page: Page) -> None:
    """Wait until every question is answered."""
    page.locator("body[data-work=settled]").wait_for(timeout=60_000)


def go(page: Page, address: str) -> None:
    page.goto(address)
    settle(page)


def texts(page: Page, row: int = 0) -> list[str]:
    """The constants of a law as the page prints them."""
    return [page.locator(f"#table tbody tr >> nth={row} >> [data-constant={name}]").inner_text() for name in CONSTANTS]


def told(served: Server, law: dict[str, Any]) -> list[str]:
    """The constants of a law as the server prints them."""
    (view,) = served.ask("laws", {"laws": [law]})["laws"]
    return [one["text"] for one in view["constants"]]


def at_velocity(B: float) -> dict[str, Any]:
    return {"problem": OPTIMAL["problem"] | {"B": B}}


def velocity(page: Page) -> float:
    return float(page.get_by_label("Peak velocity B, number").input_value())


def test_the_first_page_shows_an_optimal_law_with_the_digits_of_the_server(page: Page, served: Server) -> None:
    go(page, f"http://{served.host}/")
    assert texts(page) == told(served, OPTIMAL)
    assert "proven optimal" in page.locator("#trust").inner_text()
    assert page.locator("#curves svg").count() == 5
    assert page.locator("#words").inner_text().endswith("proven at every point")


def test_fifty_drags_end_on_the_last_value(page: Page, served: Server, watch: Watch) -> None:
    go(page, f"http://{served.host}/")
    box = page.locator(".handle").bounding_box()
    assert box is not None
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    before = watch.paths.count("/api/laws")
    in_flight: list[Route] = []

    def hold(route: Route) -> None:
        in_flight.append(route)

    page.route("**/api/laws", hold)
    page.mouse.move(x, y)
    page.mouse.down()
    for step in range(1, 51):
        page.mouse.move(x + 2 * step, y)
    page.mouse.up()
    assert in_flight
    page.unroute("**/api/laws")  # what is held goes on
    settle(page)
    last = velocity(page)
    assert last > 1.9
    assert texts(page) == told(served, at_velocity(last))
    # while one question is not answered, of those after it only the last is kept
    assert watch.paths.count("/api/laws") - before < 10
    page.get_by_role("button", name="Undo").click()
    settle(page)
    assert velocity(page) == 1.7


def test_keys_move_the_law_and_undo_takes_it_back(page: Page, served: Server) -> None:
    go(page, f"http://{served.host}/")
    page.locator(".handle").focus()
    page.keyboard.press("ArrowRight")
    page.keyboard.press("Shift+ArrowRight")
    settle(page)
    assert velocity(page) == 1.81
    assert texts(page) == told(served, at_velocity(1.81))
    page.keyboard.press("Control+z")
    settle(page)
    assert velocity(page) == 1.7
    page.keyboard.press("Control+Shift+z")
    settle(page)
    assert velocity(page) == 1.81


def test_a_number_that_is_cleared_stands_again_and_a_look_is_no_step(page: Page, served: Server) -> None:
    go(page, served.link(laws=[OPTIMAL], picture="residual"))
    field = page.get_by_label("Peak velocity B, number")
    field.fill("")
    field.press("Tab")
    assert velocity(page) == 1.7
    page.get_by_role("tab", name="Motion").click()
    settle(page)
    assert page.get_by_role("button", name="Undo").is_disabled()


def test_a_problem_without_a_law_says_why_and_how_far_to_go_back(page: Page, served: Server) -> None:
    go(page, served.link(laws=[NONE], picture="residual"))
    assert "no such law" in page.locator("#trust").inner_text()
    assert "J <= 20" in page.locator("#trust .reason").inner_text()
    assert texts(page) == ["—"] * 5
    assert page.locator("#curves .line").count() == 0
    page.get_by_role("button", name="raise the bound of J from 20 to").click()
    settle(page)
    assert "proven optimal" in page.locator("#trust").inner_text()
    assert page.locator("#curves .line").count() == 5


def test_a_link_is_a_study(page: Page, served: Server) -> None:
    laws = [at_velocity(1.859), {"name": "modified sine"}, {"name": "III(7.2)"}]
    go(page, served.link(laws=laws, active=1, picture="residual", frequency=15.5, damping=0.02))
    assert page.locator("#table tbody tr").count() == 3
    assert texts(page, 1) == told(served, laws[1])
    left = served.ask("residual", {"laws": laws, "frequency": 15.5, "damping": 0.02})["laws"]
    words = ", ".join(f"{name} {one['text']}" for name, one in zip("ABC", left, strict=True))
    assert page.locator("#words").inner_text().endswith(words)
    assert page.get_by_label("Frequency nu of the follower, number").input_value() == "15.5"
    address = page.url
    page.goto("about:blank")
    go(page, address)
    assert page.url == address
    assert [texts(page, row) for row in range(3)] == [told(served, law) for law in laws]


@pytest.mark.sample(3)
@pytest.mark.parametrize(
    "fragment",
    [
        "law=%7B",
        "law=3&active=9&picture=7",
        "view=%22nothing%22&frequency=%22x%22",
        "%%%",
        "law=%7B%22name%22%3A%22nobody%22%7D",
        "view=%22constructor%22",
        "axis=7&view=%22machine%22",
        "laws=5",
        "cam=%7B%7D&view=%22cam%22",
        "cycle=%7B%22axis%22%3A3%7D&view=%22cycle%22",
    ],
)
def test_an_odd_address_shows_what_can_be_read_and_a_page_that_lives(page: Page, served: Server, fragment: str) -> None:
    go(page, f"http://{served.host}/#{fragment}")
    page.get_by_role("tab", name="Laws").click()
    settle(page)
    assert page.locator("#table tbody tr").count() == 1
    assert ("proven optimal" in page.locator("#trust").inner_text()) == ("nobody" not in fragment)


def test_a_standard_law_of_the_picture_is_compared(page: Page, served: Server) -> None:
    go(page, f"http://{served.host}/")
    point = page.get_by_role("button", name="modified sine: B")
    point.focus()
    assert "C = 5.52796" in (page.locator(".tip").text_content() or "")
    page.keyboard.press("Enter")
    settle(page)
    assert texts(page, 1) == told(served, {"name": "modified sine"})
    assert page.locator("#words").inner_text().startswith("least C at each B")
    assert page.locator("#curves svg").first.locator(".line").count() == 2
    for name in ("cycloidal", "cubic"):
        page.get_by_label("Add a standard law by its name").fill(name)
        page.get_by_label("Add a standard law by its name").press("Enter")
        settle(page)
    page.get_by_role("button", name="3-4-5 polynomial: B").press("Enter")
    settle(page)
    assert page.locator("#words").inner_text() == "4 laws are compared: take one away before 3-4-5 polynomial is added"
    for name in ("cubic", "cycloidal"):
        page.get_by_label(f"Take {name} away").click()
    page.locator('[data-key="law 1"]').click()
    page.get_by_role("button", name="least C at its peak velocity").click()
    settle(page)
    assert "proven optimal" in page.locator("#trust").inner_text()
    page.get_by_label("Take least C, B").first.click()
    settle(page)
    assert page.locator("#table tbody tr").count() == 1


def test_bounds_and_weights_are_asked(page: Page, served: Server) -> None:
    go(page, served.link(picture="residual"))
    page.get_by_label("Greatest peak jerk: bounded").check()
    settle(page)
    page.get_by_label("Greatest peak jerk, number").fill("80")
    page.get_by_label("Weight of peak power in the objective, number").fill("0.5")
    settle(page)
    law = {"problem": OPTIMAL["problem"] | {"J": [0, 80], "minimise": "C/4 + 0.5*D/2.25"}}
    assert texts(page) == told(served, law)
    assert page.locator("#trust .word").inner_text() == "local"
    # links of earlier versions have the weights beside the problem
    go(page, served.link(laws=[{"problem": OPTIMAL["problem"] | {"J": [0, 80]}, "weights": {"C": 1, "D": 0.5}}]))
    assert texts(page) == told(served, law)


def test_dragging_over_another_constant_bounds_it(page: Page, served: Server) -> None:
    go(page, f"http://{served.host}/")
    page.get_by_role("tab", name="C over J").click()
    settle(page)
    page.locator(".handle").focus()
    page.keyboard.press("PageDown")
    settle(page)
    bound = float(page.get_by_label("Greatest peak jerk, number").input_value())
    assert texts(page) == told(served, {"problem": OPTIMAL["problem"] | {"J": [0, bound]}})


def test_nothing_overflows(page: Page, served: Server) -> None:
    for width, height in ((1280, 800), (900, 800)):
        page.set_viewport_size({"width": width, "height": height})
        go(page, served.link(laws=[at_velocity(1.859), {"name": "modified sine"}, {"name": "III(7.2)"}]))
        assert page.evaluate("() => document.documentElement.scrollWidth") <= width
        if width == 1280:
            assert page.evaluate("() => document.documentElement.scrollHeight") <= height
        cells = "[...document.querySelectorAll('#table td')]"
        assert page.evaluate(f"() => {cells}.every((one) => one.scrollWidth <= one.clientWidth)")


def test_dark_and_light_are_the_readers_choice(page: Page, served: Server) -> None:
    go(page, f"http://{served.host}/")
    ground = "() => getComputedStyle(document.body).color"
    light = page.evaluate(ground)
    page.get_by_role("button", name="◐").click()
    assert page.evaluate(ground) != light


def saves(page: Page, kind: str) -> str:
    """The text of a file that the reader saves."""
    page.get_by_text("Save", exact=True).click()
    with page.expect_download() as download:
        page.locator(f"[data-kind={kind}]").click()
    return Path(download.value.path()).read_text("utf-8")


def test_views_and_units_chosen_while_the_server_is_away_are_shown_when_it_is_back(
    page: Page, served: Server, watch: Watch
) -> None:
    def back() -> None:
        page.locator("#work", has_text="The server does not answer").wait_for()
        assert all("ERR_INTERNET_DISCONNECTED" in text for text in watch.complaints)
        watch.complaints.clear()
        page.context.set_offline(False)

    go(page, f"http://{served.host}/")
    page.context.set_offline(True)
    page.get_by_role("tab", name="Motion").click()
    back()
    page.locator("#motion .title", has_text="mm/s").wait_for()
    settle(page)
    assert not page.locator("#work").is_visible()
    page.context.set_offline(True)
    page.get_by_text("Settings", exact=True).click()
    page.get_by_label("length", exact=True).select_option("in")
    back()
    page.locator("#motion .title", has_text="in/s").first.wait_for()


def test_what_is_saved_is_what_is_seen(page: Page, served: Server) -> None:
    go(page, served.link(laws=[at_velocity(1.859), {"name": "modified sine"}], picture="residual"))
    assert "Problem(B=1.859, order=4" in saves(page, "python")
    assert saves(page, "problem").startswith('job = "solutions"')
    assert "<title>least C, B = 1.859" in saves(page, "report")
    picture = ET.fromstring(saves(page, "picture"))  # noqa: S314 - our own
    lines = [one for one in picture.iter("{http://www.w3.org/2000/svg}path") if one.get("fill") == "none"]
    assert len(lines) == 10
    assert all(line.get("stroke", "").startswith("rgb") for line in lines)


def test_a_cycle_is_shown_changed_and_refused(page: Page, served: Server) -> None:
    go(page, served.link(view="cycle"))
    cell = page.locator("#segments tbody tr >> nth=0 >> td >> nth=4")
    assert cell.inner_text() == "616"
    assert page.locator("#motion .curve").count() == 4
    page.get_by_label("limit velocity").fill("300 mm/s")
    settle(page)
    assert "no such law" in page.locator("#cycle-trust").inner_text()
    assert page.locator("#motion .line").count() == 0
    page.get_by_role("button", name="raise the limit of velocity").click()
    settle(page)
    assert "proven optimal" in page.locator("#cycle-trust").inner_text()
    page.get_by_label("limit velocity").fill("300 mil/s")
    settle(page)
    assert "velocity" in page.locator("#cycle-trust").inner_text()
    page.get_by_label("limit velocity").fill("300 kg")
    settle(page)
    assert page.get_by_label("limit velocity").get_attribute("aria-invalid") == "true"
    assert page.locator("[aria-invalid]").count() == 1
    assert page.locator("#motion .line").count() == 0
    page.get_by_label("limit velocity").fill("500 mm/s")
    for segment in (0, 2):
        page.get_by_label(f"segment {segment} law").fill("modified sine")
    settle(page)
    assert page.locator("[aria-invalid]").count() == 0
    assert page.locator("#segments .over").count() == 2
    assert page.locator("#motion .beyond").count() == 1
    # an optimal return that reaches the limit keeps it
    page.get_by_label("segment 2 law").fill("")
    settle(page)
    assert page.locator("#segments .over").count() == 1
    assert len({zone.get_attribute("x") for zone in page.locator("#motion clipPath[id^=beyond] rect").all()}) == 1


def test_what_a_cycle_declares_is_in_its_form(page: Page, served: Server) -> None:
    """A limit of the snap has a panel of its own, and a free motion its points on the way."""
    study = cycle_view.example()
    study["axis"][0]["segment"] = [
        {"kind": "free", "by": "35 mm", "duration": "160 deg"},
        {"kind": "free", "by": "-35 mm"},
    ]
    go(page, served.link(view="cycle", cycle=study))
    page.get_by_label("limit snap").fill("60000 m/s^4")
    page.get_by_label("segment 0 via").fill("80 deg: 20 mm, 120 deg: 31 mm")
    page.get_by_label("segment 0 via").press("Tab")
    settle(page)
    axis = study["axis"][0]
    axis["limits"]["snap"] = "60000 m/s^4"
    axis["segment"][0]["via"] = [["80 deg", "20 mm"], ["120 deg", "31 mm"]]
    answer = served.ask("cycle", {"study": study})
    assert [panel["name"] for panel in answer["panels"]] == ["position", "velocity", "acceleration", "jerk", "snap"]
    position, snap = (answer["panels"][nu]["series"][0] for nu in (0, 4))
    assert position["values"][position["at"].index(80.0)] == pytest.approx(20.0, abs=1e-6)
    assert max(map(abs, snap["values"])) <= 60000.0 * (1.0 + 1e-6)
    assert answer["panels"][4]["limits"][0]["value"] == 60000.0
    assert page.locator("#motion .curve").count() == 5
    assert page.locator("#segments thead th").last.inner_text().startswith("peak snap")
    shown = page.locator("#segments tbody tr >> nth=0 >> td").last.inner_text()
    assert shown.replace("\u202f", "") == f"{answer['table']['rows'][0][-1]:.6g}"


def test_an_export_says_what_the_controller_will_run(page: Page, served: Server) -> None:
    go(page, served.link(laws=[at_velocity(1.859)], picture="residual"))
    page.get_by_role("button", name="Export", exact=True).click()
    page.get_by_label("format").select_option("twincat-table")
    page.get_by_label("points").fill("361")
    page.get_by_label("encoder counts a stroke").fill("65536")
    settle(page)
    row = page.locator(".report tr", has_text="peak of acceleration")
    asked = {"kind": "twincat-table", "view": "laws", "request": {"laws": [at_velocity(1.859)]}}
    rows = served.ask("export", asked | {"points": 361, "counts": 65536})["rows"]
    told_row = next(one for one in rows if one[0].startswith("peak of acceleration"))
    assert row.locator("td").all_inner_texts() == told_row[1:]
    assert float(told_row[3]) > 2.0
    with page.expect_download() as download:
        page.get_by_role("button", name="Save Cam.st").click()
    assert "ARRAY" in Path(download.value.path()).read_text("utf-8")
    page.get_by_role("dialog").get_by_label("stroke", exact=True).fill("35 kg")
    settle(page)
    assert "stroke" in page.locator(".report").inner_text()
    assert page.locator(".report table").count() == 0
    page.wait_for_url("**controller=**")


def test_a_cam_is_changed_by_the_fields_that_its_values_declare(page: Page, served: Server) -> None:
    go(page, served.link(view="cam"))
    page.get_by_label("kind of follower").select_option("translating flat")
    page.get_by_label("face length").fill("9,5 mm")
    settle(page)
    assert "of 9.5 mm" in page.locator("#cam-trust").inner_text()
    page.get_by_label("turning", exact=True).select_option("clockwise")
    page.get_by_label("spring speeds").fill("0 rpm, 300 rpm")
    page.get_by_label("spring speeds").blur()
    page.wait_for_url("**speeds**")
    study = json.loads(parse_qs(urlsplit(page.url).fragment)["cam"][0])
    assert study["follower"] == {"kind": "translating flat", "face_length": "9.5 mm"}
    assert study["spring"] == {"speeds": ["0 rpm", "300 rpm"]}
    assert study["turning"] == "clockwise"
    page.get_by_label("turning", exact=True).select_option("counterclockwise")
    page.get_by_label("face length").fill("")
    page.wait_for_url(lambda address: "face_length" not in address)
    study = json.loads(parse_qs(urlsplit(page.url).fragment)["cam"][0])
    assert study["follower"] == {"kind": "translating flat"}
    assert "turning" not in study
    for _ in range(2):
        page.get_by_role("button", name="Undo").click()
    settle(page)
    assert page.get_by_label("turning", exact=True).input_value() == "clockwise"
    assert page.get_by_label("face length").input_value() == "9.5 mm"


def lift(page: Page) -> float:
    """How far the roller of 12 mm is drawn above the shaft, in mm."""
    (roller, radius), (shaft, _) = (
        [float(page.locator(name).first.get_attribute(of) or "nan") for of in ("cy", "r")]
        for name in (".roller", ".shaft")
    )
    return (shaft - roller) * 12.0 / radius


def test_a_cam_turns_and_is_refused_where_there_is_none(page: Page, served: Server) -> None:
    go(page, served.link(view="cam"))
    assert "no undercut" in page.locator("#cam-trust").inner_text()
    assert page.locator("#cam-curves svg").count() == 3
    head, *rows = page.locator("#cam-trust table.sizes tr").all_inner_texts()
    assert head.split("\t")[1:3] == ["modified sine", "this law"]
    assert rows[0].startswith("peak acceleration\t27.8609 m/s²\t21.8838 m/s²")
    lowest = lift(page)
    page.get_by_label("Angle of the cam, degrees").fill("165")
    assert lift(page) == pytest.approx(lowest + 35.0, abs=1e-3)
    page.get_by_role("button", name="Run").click()
    page.wait_for_timeout(150)
    page.get_by_role("button", name="Pause").click()
    assert float(page.get_by_label("Angle of the cam, degrees").input_value()) > 165
    page.get_by_label("mass", exact=True).fill("2 kg")
    settle(page)
    assert page.locator("#cam-trust .word").all_inner_texts() == ["lifts off", "no undercut"]
    for name, value in (("preload", "300 N"), ("width", "20 mm"), ("friction contact", "0.05")):
        page.get_by_label(name, exact=True).fill(value)
    settle(page)
    asked = cam_view.example() | {"forces": {"width": "20 mm", "friction": {"contact": 0.05}}}
    asked["motion"]["drive"] = {"mass": "2 kg", "preload": "300 N"}
    loads = served.ask("cam-loads", {"study": asked})
    assert page.locator(".loads").inner_text() == " · ".join(map(written, loads["facts"]))
    titles = [f"{load['name']}, {load['unit']}" for load in loads["panels"]]
    assert page.locator("#cam-curves .title").all_text_contents()[3:] == titles
    assert (
        page.locator("#cam-curves .peak text").all_text_contents()[-1]
        == f"{loads['panels'][-1]['peaks'][0]['value']:.6g}"
    )
    page.get_by_label("radius", exact=True).fill("59 mm")
    settle(page)
    assert "undercut at" in page.locator("#cam-trust").inner_text().lower()
    page.get_by_label("prime radius").fill("18 kg")
    settle(page)
    assert "prime_radius" in page.locator("#cam-trust").inner_text()
    assert page.get_by_label("prime radius").get_attribute("aria-invalid") == "true"
    assert page.locator("#cam-drawing svg, #cam-curves .line").count() == 0
    page.get_by_label("prime radius").fill("60 mm")
    page.get_by_label("kind of follower").select_option("oscillating roller")
    settle(page)
    assert page.locator(".arm").count() == 1
    page.get_by_label("kind of follower").select_option("translating roller")
    assert page.get_by_label("offset", exact=True).input_value() == "6 mm"
    page.get_by_label("kind of follower").select_option("oscillating flat")
    settle(page)
    assert "no undercut" in page.locator("#cam-trust").inner_text()


def test_a_question_that_takes_long_can_be_stopped_and_undone(page: Page, served: Server) -> None:
    go(page, served.link(laws=[at_velocity(1.7)], picture="residual"))
    page.get_by_label("Objective as a formula").fill("peak(cos(7*c)*sin(3*b))")
    settle(page)
    plane = page.locator("#plane").bounding_box()
    page.get_by_label("Objective as a formula").press("Enter")
    page.locator("#work", has_text=re.compile(r"optimal laws and their bounds · \d+ s")).wait_for(timeout=60_000)
    # the notice moves nothing; how high the picture is depends on what it shows
    now = page.locator("#plane").bounding_box()
    assert plane is not None
    assert now is not None
    assert (now["x"], now["y"]) == (plane["x"], plane["y"])
    page.get_by_role("button", name="Stop").click()
    settle(page)
    assert "no answer" in page.locator("#trust").inner_text()
    assert page.locator("#curves .line").count() == 0
    page.get_by_role("button", name="Undo").click()
    settle(page)
    assert "proven optimal" in page.locator("#trust").inner_text()


SLOW_ANSWERS = """async () => {
  window.fetch = (path, { body, signal }) => new Promise((resolve, reject) => {
    setTimeout(() => resolve({ json: async () => JSON.parse(body) }), 1300);
    signal.addEventListener("abort", () => reject(new DOMException("", "AbortError")));
  });
  const { Latest } = await import("/latest.js");
  window.answers = [];
  const latest = new Latest("slow", (answer) => window.answers.push(answer), (error) => { throw error; });
  for (let i = 1; i <= 20; i += 1) setTimeout(() => latest.ask(i), 100 * i);
}"""


def test_amid_a_drag_slow_answers_are_shown_and_once_it_rests_the_last(page: Page, served: Server) -> None:
    page.clock.install()
    page.goto(f"http://{served.host}/style.css")  # the page itself asks nothing
    page.evaluate(SLOW_ANSWERS)
    shown = []
    for _ in range(45):
        page.clock.run_for(100)
        shown.append(page.evaluate("() => [...window.answers]"))
    # the first is answered after 1.3 s, amid the drag; the one after it gives way 0.4 s after the drag, at 2.4 s
    assert shown[20] == [1]
    assert shown[-1] == [1, 20]
    assert shown[39] == [1, 20]


def test_a_click_on_the_law_itself_changes_nothing(page: Page, served: Server) -> None:
    go(page, served.link(laws=[at_velocity(1.6321)], picture="C-D"))
    page.locator(".handle .dot").click()
    settle(page)
    assert page.get_by_role("button", name="Undo").is_disabled()


def test_the_hint_of_a_first_visit_is_where_the_blue_point_is(page: Page, served: Server) -> None:
    go(page, f"http://{served.host}/")
    assert page.locator("#first").is_visible()
    page.get_by_role("tab", name="Timing").click()
    settle(page)
    assert page.locator("#first").is_hidden()


def test_kinds_and_times_keep_what_was_given(page: Page, served: Server) -> None:
    go(page, served.link(view="cycle"))
    page.get_by_label("timing", exact=True).select_option("period")
    assert page.get_by_label("timing value").input_value() == "0.3 s"
    page.get_by_label("timing", exact=True).select_option("speed")
    assert page.get_by_label("timing value").input_value() == "200 rpm"
    page.get_by_label("segment 0 kind").focus()
    page.get_by_label("segment 0 kind").select_option("move")
    assert page.get_by_label("segment 0 by").input_value() == "35 mm"
    assert page.evaluate("() => document.activeElement.getAttribute('aria-label')") == "segment 0 kind"
    for kind in ("dwell", "move"):
        page.get_by_label("segment 0 kind").select_option(kind)
    assert page.get_by_label("segment 0 by").input_value() == "35 mm"
    page.get_by_label("limit velocity").fill("none")
    settle(page)
    assert "not understood" not in page.locator("#cycle-trust").inner_text()


@pytest.mark.sample(2)
@pytest.mark.parametrize("width", [390, 800])
def test_small_screens_show_the_curves_beside_what_is_dragged(page: Page, served: Server, width: int) -> None:
    page.set_viewport_size({"width": width, "height": 844})
    go(page, f"http://{served.host}/")
    assert page.evaluate("() => document.documentElement.scrollWidth") <= width
    curves, handle = page.locator("#curves").bounding_box(), page.locator(".handle").bounding_box()
    assert curves is not None
    assert handle is not None
    assert handle["y"] < 500
    assert curves["y"] < 560
    for view in ("Motion", "Cam"):
        page.get_by_role("tab", name=view, exact=True).click()
        settle(page)
        assert page.evaluate("() => document.documentElement.scrollWidth") <= width
