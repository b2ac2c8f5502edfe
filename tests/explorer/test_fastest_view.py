"""Least times on the page: held against the library, what binds at each time, a time that is given and its front."""

from __future__ import annotations

import json
import tomllib
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest

from optlaws import Problem, fastest, time_front
from optlaws.verification import verify
from tests.explorer.talk import Server, written
from tests.explorer.test_page import go, saves, settle
from tests.internals.explorer import fastest_view, law_view, start

if TYPE_CHECKING:
    from playwright.sync_api import Page

PROBLEMS = Path(__file__).parents[2] / "problems"
STUDY = fastest_view.example()
GRIPPER = {name: STUDY["move"][0][name] for name in ("stroke", "limits")}
FOLLOWER = STUDY["move"][0]["follower"]


def test_the_least_time_and_what_is_least_in_longer_ones_are_the_library_s(served: Server) -> None:
    move = fastest(Problem.from_dict(STUDY["problem"]), **GRIPPER)
    answer = served.ask("fastest", {"study": STUDY})
    assert answer["time"] == answer["least"]["time"] == move.duration
    assert answer["least"]["best_possible"] == move.best_possible
    # the limits that bind are those of which all is taken somewhere
    assert {share["name"] for share in answer["shares"] if share["full"]} == set(move.binding)
    assert all(float(share["text"]) <= 100.0 for share in answer["shares"])
    ends = [stretch["at"] for stretch in answer["segments"]]
    assert [ends[0][0], ends[-1][1]] == [0.0, pytest.approx(1e3 * move.duration, abs=1e-4)]
    assert all(first[1] == second[0] for first, second in pairwise(ends))
    front = served.ask("fastest-front", {"study": STUDY})
    line = time_front(move, "residual acceleration", longest="0.41 s", points=11, follower=FOLLOWER)
    assert front["points"] == [[point.duration, point.value, point.lower_bound] for point in line]
    slower = served.ask("fastest", {"study": STUDY, "time": 0.36})
    point = time_front(move, "residual acceleration", longest="0.36 s", points=2, follower=FOLLOWER)[1]
    assert written(slower["trust"]["facts"][0]).split()[-2] == f"{point.value:.6g}"
    assert slower["panels"][1]["series"][0]["values"] != answer["panels"][1]["series"][0]["values"]


def test_the_curve_is_drawn_once_by_the_limit_of_which_most_is_taken(served: Server) -> None:
    table = STUDY["move"][1] | {"front": {"minimise": ["rms torque"]}}
    answer = served.ask("fastest", {"study": STUDY | {"move": [table]}, "time": 0.3})
    assert [share["name"] for share in answer["shares"]] == ["velocity", "torque"]
    ends = [part["at"] for part in answer["segments"]]
    assert [ends[0][0], *(end for _, end in ends)] == [*(start for start, _ in ends), 300.0]
    places = {at for panel in answer["panels"] for at in panel["series"][0]["at"]}
    assert {at for part in ends for at in part} <= places  # so that each curve is drawn from end to end
    motor = {row["name"]: row for row in answer["rows"]}
    assert motor["torque"]["text"] == "92.23"
    assert {share["name"]: share["text"] for share in answer["shares"]} == {
        name: motor[name]["text"] for name in ("velocity", "torque")
    }
    # the curve goes through its greatest value
    torque = [abs(value) for value in answer["panels"][4]["series"][0]["values"]]
    assert law_view.digits(max(torque), 5) == law_view.digits(motor["torque"]["value"]["value"], 5)
    least = f"least RMS torque in this time {motor['RMS torque']['value']['value']:.6g}"
    assert written(answer["trust"]["facts"][0]).startswith(least)


def test_a_cycle_stops_at_its_greatest_speed(served: Server) -> None:
    found = start(str(PROBLEMS / "cycle_fastest.toml"))
    assert found["view"] == "fastest"
    answer = served.ask("fastest", {"study": found["machine"]})
    # the least period within these limits, as the page of results says it
    assert answer["least"]["text"] == "384.355"
    assert written(answer["trust"]["facts"][0]) == "greatest speed 156.106 rpm"
    slower = served.ask("fastest", {"study": found["machine"], "time": 0.45})
    assert slower["time"] == 0.45
    assert slower["trust"]["word"] == "proven optimal"
    values = [value for _, value, _ in served.ask("fastest-front", {"study": found["machine"]})["points"]]
    assert values == sorted(values, reverse=True)


def test_no_time_below_the_least_is_given_and_limits_that_nothing_keeps_say_why(served: Server) -> None:
    assert (
        served.ask("fastest", {"study": STUDY, "time": 0.1})["time"] == served.ask("fastest", {"study": STUDY})["time"]
    )
    free = {"job": "fastest", "title": "free", "move": [{"name": "free", "stroke": "1 mm", "limits": {}}]}
    assert "limits must name one" in served.ask("fastest", {"study": free})["refused"]["reason"]
    named = {"study": free | {"move": [STUDY["move"][1] | {"drive": {"motor": "x", "motors": "motors.toml"}}]}}
    assert "reads no catalogue" in served.ask("fastest", named)["refused"]["reason"]


def test_a_time_is_given_by_slider_picture_and_number_and_stops_at_the_least(page: Page, served: Server) -> None:
    go(page, served.link(view="fastest", fastest=STUDY))
    least = served.ask("fastest", {"study": STUDY})["least"]["text"]
    time = page.get_by_label("Time of the motion, ms")
    assert time.input_value() == least
    handle = page.locator("#fastest-chart .handle")
    handle.focus()
    page.keyboard.press("ArrowLeft")
    settle(page)
    assert time.input_value() == least
    page.keyboard.press("Shift+ArrowRight")
    settle(page)
    given = float(time.input_value())
    assert given == pytest.approx(float(least) + 10.0, abs=0.1)
    expected = served.ask("fastest", {"study": STUDY, "time": given / 1e3})
    assert written(expected["trust"]["facts"][0]) in page.locator("#fastest-trust").inner_text()
    page.get_by_role("button", name="Undo").click()
    settle(page)
    assert time.input_value() == least
    page.get_by_label("Motions a minute").fill("150")
    page.keyboard.press("Tab")
    settle(page)
    assert time.input_value() == "400"
    page.get_by_label("what is least in longer times").select_option("jerk")
    settle(page)
    assert "least jerk in each time: proven" in page.locator("#fastest-words").inner_text()
    assert page.locator("#fastest-legend .limit-key").count() == 4
    for name in ("start velocity", "limits snap", "follower frequency", "follower damping", "front longest"):
        assert page.get_by_label(name, exact=True).count() == 1
    assert page.get_by_label("limits torque").count() == 0  # of a motor, which it has not
    page.get_by_label("limits jerk").fill("1200 m/s^3")
    page.get_by_role("button", name="least", exact=True).click()
    settle(page)
    assert float(time.input_value()) < float(least)
    saved = tomllib.loads(saves(page, "problem"))
    assert saved["move"][0]["limits"]["jerk"] == "1200 m/s^3"
    assert saved["move"][0]["front"]["minimise"] == ["jerk", "residual acceleration"]
    assert verify(json.loads(saves(page, "proof"))).proven


@pytest.mark.parametrize("unit", [1e-12, 1e9])
def test_curves_of_any_size_are_drawn(served: Server, unit: float) -> None:
    limits = {"velocity": f"{1.5 * unit!r} m/s", "jerk": f"{600.0 * unit!r} m/s^3"}
    plain, scaled = (
        served.ask("fastest", {"study": {"job": "fastest", "title": "one", "move": [move]}})["panels"]
        for move in (
            {"name": "one", "stroke": "300 mm", "limits": {"velocity": "1.5 m/s", "jerk": "600 m/s^3"}},
            {"name": "one", "stroke": f"{300.0 * unit!r} mm", "limits": limits},
        )
    )
    for one, other in zip(plain, scaled, strict=True):
        values, drawn = (np.array(panel["series"][0]["values"]) for panel in (one, other))
        assert drawn / unit == pytest.approx(values, abs=1e-5 * np.abs(values).max())
