"""Machines on the page: numbers against the library, mechanisms to scale, a gear, a motor and laws that are changed."""

from __future__ import annotations

import tomllib
from copy import deepcopy
from math import hypot, pi
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from optlaws import Cycle, Drive, InputError
from tests.explorer.talk import OPTIMAL, Server, written
from tests.explorer.test_page import go, saves, settle
from tests.internals.explorer import cycle_view, example, law_view, machine_view, start
from tests.internals.jobs import read_of_cycle_entries

if TYPE_CHECKING:
    from playwright.sync_api import Page, Request

PROBLEMS = Path(__file__).parents[2] / "problems"


def study(file: str) -> dict[str, Any]:
    found: dict[str, Any] = start(str(PROBLEMS / f"{file}.toml"))
    assert found["view"] == "machine"
    machine: dict[str, Any] = found["machine"]
    return machine


def known(file: str) -> dict[str, Cycle]:
    path = PROBLEMS / f"{file}.toml"
    return dict(read_of_cycle_entries(tomllib.loads(path.read_text("utf-8")), path)[1])


@pytest.mark.parametrize("file", ["cycle_geared_table", "cycle_belt_lift"])
def test_the_sheet_and_the_curves_are_those_of_the_library(served: Server, file: str) -> None:
    answer = served.ask("machine", {"study": study(file), "axis": 1})
    cycles = list(known(file).values())
    for i, cycle in enumerate(cycles):
        values = {row["name"]: row["values"][i] for row in answer["rows"]}
        # a weight gives back what it takes; the table has no load
        assert values.pop("work against the load in a cycle", 0.0) == 0.0
        assert values == {row.name: row.value for row in cycle.sheet.summary()}
        torque = answer["panels"][0]["series"][i]
        inner = [n for n, at in enumerate(torque["at"]) if torque["at"].count(at) == 1][1:-1:17]
        assert [torque["values"][n] for n in inner] == pytest.approx(
            cycle.force([1e-3 * torque["at"][n] for n in inner]).tolist(), abs=2e-3
        )
        # the greatest torque lies on its curve
        assert max(map(abs, torque["values"])) == pytest.approx(cycle.effort.peak_force, abs=1e-6)
    assert answer["trust"]["word"] == ("local" if file == "cycle_geared_table" else "proven optimal")
    # what is said to be greatest is not the greatest of the drawn places
    efforts = [cycle.effort for cycle in cycles]
    braking, motoring = (
        max(each) for each in zip(*((e.braking_power, e.motoring_power) for e in efforts), strict=True)
    )
    assert answer["panels"][1]["ends"] == [-braking, motoring]
    if answer["over_speed"] is not None:
        assert answer["over_speed"]["greatest"] == {
            "torque": max(effort.peak_force for effort in efforts),
            "speed": pytest.approx(max(cycle.sheet.peak_speed for cycle in cycles) * 30.0 / pi, rel=1e-9),
        }


def test_a_smooth_table_of_forces_has_none_where_the_table_has_none(served: Server) -> None:
    """The same in the file's cycles and in the picture: from rest to 280 deg the press moves as without its load."""
    path = PROBLEMS / "cycle_crank_press.toml"
    pressed, free = (tomllib.loads(path.read_text("utf-8")) for _ in range(2))
    for given in (pressed, free):
        for axis in given["axis"]:
            axis.pop("minimise", None)
            axis["segment"][0]["law"] = "modified sine"
    for axis in pressed["axis"]:
        axis["mechanism"]["loads"]["interpolation"] = "spline"
    for axis in free["axis"]:
        del axis["mechanism"]["loads"]
    times = np.linspace(0.0, 0.3, 200)
    loaded, plain = (list(dict(read_of_cycle_entries(given, path)[1]).values())[1] for given in (pressed, free))
    assert np.degrees(loaded(times)).max() < 280.0
    assert loaded.force(times) == pytest.approx(plain.force(times), abs=1e-9)
    assert (
        np.abs(loaded.force(0.5 * np.linspace(0.6, 1.0, 200)) - plain.force(0.5 * np.linspace(0.6, 1.0, 200))).max()
        > 30.0
    )
    torque = served.ask("machine", {"study": pressed, "axis": 1})["panels"][0]["series"][1]
    at, values = np.array(torque["at"]) * 1e-3, np.array(torque["values"])
    here = at < 0.3
    assert values[here] == pytest.approx(plain.force(at[here]), abs=2e-3)


def test_torques_at_two_shafts_say_of_which_they_are(page: Page, served: Server) -> None:
    timed = study("cycle_crank_press")
    timed["axis"] = [timed["axis"][1]]
    asked = {name: value for name, value in timed.items() if name != "period"} | {"speed": f"{60.0 / 0.7} rpm"}
    rows = {row["name"]: row for row in served.ask("machine", {"study": asked, "axis": 0})["rows"]}
    without_master = {row["name"] for row in served.ask("machine", {"study": timed, "axis": 0})["rows"]}
    assert rows.keys() - without_master == {"peak torque at the master's shaft"}
    at_input, at_master = rows["peak torque"], rows["peak torque at the master's shaft"]
    driven = "the crank"
    assert at_input["note"] == rows["RMS torque"]["note"] == f"at {driven}"
    by_shaft = f"a shaft that turns evenly and drives {driven}"
    assert at_master["note"] == f"of {by_shaft}: peak power over the master's speed"
    assert at_master["values"] == pytest.approx([rows["peak power"]["values"][0] * 0.7 / (2.0 * pi)])
    assert at_master["values"] != pytest.approx(at_input["values"], rel=0.1)
    go(page, served.link(machine=asked, view="machine", axis=0))
    row = page.locator("tr", has_text="peak torque at the master's shaft")
    assert row.get_attribute("title") == at_master["note"]


def test_greatest_values_are_said_as_the_library_has_them(page: Page, served: Server) -> None:
    greatest = served.ask("machine", {"study": study("cycle_geared_table"), "axis": 1})["over_speed"]["greatest"]
    go(page, served.link(machine=study("cycle_geared_table"), view="machine", axis=1))
    words = page.locator("[aria-label^='Torque over speed']").first.get_attribute("aria-label") or ""
    assert f"greatest torque is {greatest['torque']:.6g} N m, the greatest speed {greatest['speed']:.6g} rpm" in words


def test_what_no_law_beats_is_proven_by_the_drive(served: Server) -> None:
    (move,) = served.ask("machine-limits", {"study": study("cycle_geared_table"), "axis": 1})["moves"]
    cycle = known("cycle_geared_table")["least RMS torque"]
    assert isinstance(cycle.drive, Drive)
    for name, least in (("peak torque", move["peak"]), ("rms torque", move["rms"])):
        assert least[1] == cycle.drive.limit(name, "0 deg", "45 deg", "0.25 s").value  # type: ignore[arg-type]
    assert move["rms"][0] == cycle.efforts[0].rms_force
    assert move["rms"][1] < move["rms"][0]


def test_torque_over_the_ratio_is_that_of_the_cycle_at_each_ratio(served: Server) -> None:
    asked = study("cycle_geared_table")
    found = served.ask("machine-ratios", {"study": asked, "axis": 0, "low": 20.0, "high": 60.0})
    cycle = known("cycle_geared_table")["modified sine"]
    assert isinstance(cycle.drive, Drive)
    move = ("modified sine", "0 deg", "45 deg", "0.25 s")
    for ratio, rms, peak, fits in zip(
        found["ratios"], found["laws"][0]["rms"], found["laws"][0]["peak"], found["fits"], strict=True
    ):
        sheet = cycle.drive.with_ratio(ratio).sheet(*move, period="0.6 s")
        assert (rms, peak) == pytest.approx((sheet.rms_torque, sheet.peak_torque), rel=1e-9)
        assert fits is sheet.fits
    bound = served.ask("machine-ratios", {"study": asked, "axis": 1, "low": 20.0, "high": 60.0})
    assert all(low <= rms for low, rms in zip(bound["bound"], bound["laws"][1]["rms"], strict=True))


def test_links_are_drawn_to_scale(served: Server) -> None:
    drawing = served.ask("machine", {"study": study("cycle_crank_press")})["drawing"]
    _, (pivot, pin, joint), _ = drawing["chains"]
    for (x, y), (u, v), (s, t) in zip(pivot, pin, joint, strict=True):
        assert (hypot(u - x, v - y), hypot(s - u, t - v), t) == pytest.approx((100.0, 400.0, 0.0), abs=2e-3)
    assert drawing["input"][0] == 0.0
    assert drawing["input"][-1] == 360.0


@pytest.mark.parametrize("kind", [kind for kind in machine_view.kinds() if kind != "toggle"])
def test_every_kind_begins_with_a_machine_that_moves(served: Server, kind: str) -> None:
    example = machine_view.kinds()[kind]
    axis = {"name": "one", "mechanism": {"kind": kind, **example["mechanism"]}, **deepcopy(example["axis"])}
    for segment in axis["segment"]:
        if segment["kind"] in {"rise", "return"}:
            segment["law"] = "modified sine"
    asked = {"job": "cycle", "title": kind, "period": example.get("period", "0.7 s"), "axis": [axis]}
    answer = served.ask("machine", {"study": asked})
    assert "refused" not in answer
    assert len(answer["drawing"]["input"]) == 181


def test_a_motor_that_is_too_weak_is_no_verdict_of_the_law(served: Server) -> None:
    asked = study("cycle_geared_table")
    for axis in asked["axis"]:
        axis["drive"]["motor"]["curve"] = [["0 rpm", "1.9 N m"], ["3000 rpm", "1.9 N m"]]
    answer = served.ask("machine", {"study": asked, "axis": 1})
    assert answer["trust"]["word"] == "beyond a limit"
    assert "the motor's torque-speed curve" in answer["trust"]["advice"]


def test_laws_stay_while_a_limit_of_the_motor_is_dragged() -> None:
    asked = study("cycle_geared_table")
    before = cycle_view.cycle(cycle_view.CycleRequest(study=asked, axis=1))
    for axis in asked["axis"]:
        axis["drive"]["motor"]["rated_torque"] = "1.1 N m"
    after = cycle_view.cycle(cycle_view.CycleRequest(study=asked, axis=1))
    assert after.solutions == before.solutions
    anew = dict(read_of_cycle_entries(asked, PROBLEMS / "cycle_geared_table.toml")[1])["least RMS torque"]
    assert (after.drive, after.effort, after.lower_bound) == (anew.drive, anew.effort, anew.lower_bound)
    assert after.sheet == anew.sheet
    asked["axis"][1]["drive"]["motor"]["rated_torque"] = "1.1 s"
    with pytest.raises(InputError, match="drive: motor: rated_torque"):
        cycle_view.cycle(cycle_view.CycleRequest(study=asked, axis=1))


def test_a_law_of_the_previous_value_is_evaluated_and_never_passed_off_as_optimal(served: Server) -> None:
    asked = study("cycle_geared_table")
    optima = served.ask("machine", {"study": asked, "axis": 1})["optima"]
    assert [len(laws) for laws in optima] == [0, 1]
    for axis in asked["axis"]:
        axis["drive"]["ratio"] = 24
    now = served.ask("machine", {"study": asked, "axis": 1, "laws": optima})
    cycle = known("cycle_geared_table")["least RMS torque"]
    assert isinstance(cycle.drive, Drive)
    law = cycle.solutions[0].law
    sheet = cycle.drive.with_ratio(24).sheet(law, "0 deg", "45 deg", "0.25 s", period="0.6 s")
    values = {row["name"]: row["values"][1] for row in now["rows"]}
    assert values["RMS torque"] == pytest.approx(sheet.rms_torque, rel=1e-6)
    assert values["peak torque"] == pytest.approx(sheet.peak_torque, rel=1e-6)
    assert (now["trust"]["word"], now["optima"]) == ("law of the previous value", None)
    assert not {"proof"} & now["trust"].keys()
    beside = served.ask("machine", {"study": asked, "axis": 0, "laws": optima})["trust"]
    assert beside["word"] == "given"
    assert beside["facts"] == ["least RMS torque: law of the previous value, the optimum follows"]
    best = served.ask("machine", {"study": asked, "axis": 1})
    (least,) = (row["values"] for row in best["rows"] if row["name"] == "RMS torque")
    assert least[1] < sheet.rms_torque
    wrong: list[list[list[Any]]] = [[], [[], [{}]], [[], [*optima[1], *optima[1]]]]
    for laws in wrong:
        assert "refused" in served.ask("machine", {"study": asked, "axis": 1, "laws": laws})


def test_while_the_gear_is_dragged_the_page_shows_the_law_before_and_then_the_optimum(
    page: Page, served: Server
) -> None:
    asked = study("cycle_geared_table")
    go(page, served.link(view="machine", machine=asked, axis=1))
    assert "local" in page.locator("#machine-trust .word").inner_text()
    ratio = page.locator("#machine-form input[type=range]").first
    sent: list[Request] = []

    def sends(request: Request) -> None:
        sent.append(request)

    page.on("request", sends)
    page.locator("#machine-trust").evaluate("""(words) => {
      window.seen = [];
      const watched = { subtree: true, childList: true, characterData: true };
      new MutationObserver(() => window.seen.push(words.textContent)).observe(words, watched);
    }""")
    for _ in range(8):
        ratio.press("ArrowRight")
    settle(page)
    seen = page.evaluate("() => window.seen")
    assert any("law of the previous value The optimum follows." in text for text in seen)
    assert "local" in page.locator("#machine-trust .word").inner_text()
    value = float(page.get_by_label("Ratio of the gear", exact=True).locator("visible=true").first.input_value())
    for one in asked["axis"]:
        one["drive"]["ratio"] = value
    best = served.ask("machine", {"study": asked, "axis": 1})
    shown = page.locator("#machine-table tr", has_text="RMS torque, N m").locator("td").nth(1).inner_text()
    assert [shown] == [law_view.digits(row["values"][1], 6) for row in best["rows"] if row["name"] == "RMS torque"]
    # each step is answered by the law before; the optimum is looked for where the drag rests
    bodies = [each.post_data or "" for each in sent if each.url.endswith("api/machine")]
    assert '"laws":' in bodies[0]
    assert '"laws":' not in bodies[-1]


def test_a_gear_a_motor_and_laws_are_changed_in_the_page(page: Page, served: Server) -> None:
    asked = study("cycle_geared_table")
    go(page, served.link(view="machine", machine=asked, axis=1))

    def torque(axis: int, ratio: float) -> str:
        changed = deepcopy(asked)
        for one in changed["axis"]:
            one["drive"]["ratio"] = ratio
        rows = served.ask("machine", {"study": changed, "axis": axis})["rows"]
        return next(law_view.digits(row["values"][axis], 6) for row in rows if row["name"] == "RMS torque")

    def shown(column: int) -> str:
        row = page.locator("#machine-table tr", has_text="RMS torque, N m")
        return row.locator("td").nth(column).inner_text()

    assert (shown(0), shown(1)) == (torque(0, 20), torque(1, 20))
    assert page.locator("#machine-curves .law-limit").count() == 2
    page.get_by_role("tab", name="over the ratio").click()
    settle(page)
    page.locator("#machine-chart .handle").focus()
    page.keyboard.press("ArrowRight")
    settle(page)
    ratio = float(page.get_by_label("Ratio of the gear", exact=True).locator("visible=true").first.input_value())
    assert ratio > 20
    assert (shown(0), shown(1)) == (torque(0, ratio), torque(1, ratio))
    page.get_by_role("button", name="Undo").click()
    settle(page)
    assert shown(1) == torque(1, 20)
    page.get_by_role("tab", name="torque over speed").click()
    handle = page.get_by_role("slider", name="Rated torque of the motor")
    handle.focus()
    page.keyboard.press("ArrowUp")
    settle(page)
    assert page.get_by_label("drive motor rated torque").input_value() == "2.1 N m"
    field = page.get_by_label("Add a standard law to the machine")
    field.fill("cycloidal")
    field.press("Enter")
    settle(page)
    assert page.locator("#machine-tray .chip").count() == 3
    assert page.locator("#machine-curves .curve").first.locator(".line").count() >= 3
    assert 'name = "cycloidal"' in saves(page, "problem")
    assert page.locator("#machine-drawing svg").count() == 1
    page.get_by_label("Time in the cycle, thousandths").fill("500")
    assert "300 ms · 45 deg" in page.locator("#machine-turning").inner_text()


def test_each_entry_that_a_mechanism_and_a_drive_declare_has_a_field(page: Page, served: Server) -> None:
    asked = study("cycle_geared_table")
    asked["axis"] = [axis | {"minimise": "velocity"} for axis in asked["axis"][:1]]
    go(page, served.link(view="machine", machine=asked, axis=0))
    page.get_by_label("drive no load torque").fill("0.05 N m")
    page.get_by_label("kind of mechanism", exact=True).select_option("slider crank")
    page.get_by_label("mechanism bodies rod mass").fill("2 kg")
    page.get_by_label("mechanism loads over").select_option("input")
    (saved,) = tomllib.loads(saves(page, "problem"))["axis"]
    assert saved["drive"]["no_load_torque"] == "0.05 N m"
    assert (saved["mechanism"]["bodies"]["rod"], saved["mechanism"]["loads"]) == ({"mass": "2 kg"}, {"over": "input"})
    page.get_by_label("kind of mechanism", exact=True).select_option("cam")
    page.get_by_label("kind of mechanism follower").select_option("translating flat")
    (saved,) = tomllib.loads(saves(page, "problem"))["axis"]
    assert saved["mechanism"]["follower"] == {"kind": "translating flat"}


def test_an_objective_that_is_no_choice_of_the_page_is_shown(page: Page, served: Server) -> None:
    study = example()
    study["axis"][0]["minimise"] = "rms load acceleration"
    study["axis"][0]["load"] = {"period": "0.03 s", "damping": 0.02, "mass": "2 kg"}
    page.goto(served.link(laws=[OPTIMAL], view="cycle", machine=study))
    page.get_by_label("minimise", exact=True).wait_for()
    assert page.get_by_label("minimise", exact=True).input_value() == "rms load acceleration"


def test_remarks_on_the_drive_are_read_and_are_no_numbers(served: Server) -> None:
    asked = study("cycle_geared_table")
    asked["axis"] = [asked["axis"][0] | {"drive": {**asked["axis"][0]["drive"], "ratio": 3.0}}]
    asked["axis"][0].pop("limits", None)
    answer = served.ask("machine", {"study": asked})
    assert "remark" not in [row["name"] for row in answer["rows"]]
    facts = [written(fact) for fact in answer["trust"]["facts"]]
    assert any("the motor is overloaded" in fact for fact in facts)
