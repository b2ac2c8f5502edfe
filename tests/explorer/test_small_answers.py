"""What each small part of the explorer answers, with the numbers and words that the page shows."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from optlaws import InputError, Problem, at_most
from tests.internals.explorer import (
    CycleRequest,
    LawRequest,
    LawsRequest,
    OpenRequest,
    advice_view,
    answering,
    axes_view,
    cam_view,
    cycle_view,
    drawn,
    fact_sentences,
    front_view,
    given_law,
    law_view,
    machine_view,
    opened,
    opened_file,
    requests,
    start,
    table_data,
    workers,
)
from tests.internals.shown import ReportTable, Row

PROBLEM = Problem(B=1.7, order=4)


def test_a_question_that_cannot_be_read_says_where() -> None:
    unread = b'{"error":"the question cannot be read: Expected `array` of length >= 1 - at `$.laws`"}'
    assert answering.answered("laws", b'{"laws": []}') == (422, unread)
    assert answering.message("no such law") == b'{"error":"no such law"}'
    assert workers.late(4.0) == b'{"error":"this takes more than 4 s","late":4.0}'
    assert requests.read(b'{"laws": [{"name": "cycloidal"}]}', LawsRequest).laws[0].name == "cycloidal"


def test_the_server_listens_on_this_machine_alone() -> None:
    with opened(0) as listening:
        assert listening.getsockname()[0] == "127.0.0.1"


def test_what_is_given_is_shown_first() -> None:
    assert start("cycloidal") == {"view": "laws", "laws": [{"name": "cycloidal"}]}
    file = OpenRequest(name="one.toml", text="[problem]\norder = 4\nB = 1.7")
    assert opened_file(file)["state"]["laws"][0]["problem"]["B"] == 1.7


@pytest.mark.parametrize(
    ("shown", "text"),
    [
        (law_view.digits(1.7), "1.7"),
        (law_view.digits(float("-inf")), "−∞"),
        (law_view.digits(-0.25), "−0.25"),
        (law_view.title(Problem(B=1.7, order=4, minimise="J")), "least J, B = 1.7, order 4, degree 9"),
        (law_view.objective_title(Problem(order=4, minimise="C/4 + D/2.25")), "0.25*C + 0.4444*D"),
    ],
)
def test_numbers_and_problems_in_words(shown: str, text: str) -> None:
    assert shown == text


def test_facts_and_tables_in_words() -> None:
    facts = [
        Row("contact force", (78.0, 151.5), "N"),
        Row("radius", (5.0, 5.0), "mm", 30.0),
        Row("least time", 0.25, "s", note="proven"),
        Row("binds", "jerk"),
    ]
    words = ["contact force 78 N to 151.5 N", "radius 5 mm at 30 deg", "least time 0.25 s: proven", "binds: jerk"]
    assert fact_sentences(facts) == words
    table = ReportTable(["what", "least", "unit"], [["radius", 5.0, "mm"], ["turn", np.inf, ""]])
    assert table_data(table) == {"headings": ["what", "least"], "rows": [["radius", "5 mm"], ["turn", None]]}
    assert drawn(np.array([1.23456789, np.inf])) == [1.234568, None]
    assert drawn(np.array([1.23456789e-9])) == [1.234568e-09]


def test_a_constant_is_freed_and_run() -> None:
    bounded = Problem(B=1.7, order=4, bounds={"rms_c": [0, 4]})
    assert requests.without(bounded, "rms_c", minimise="rms_c") == Problem(B=1.7, order=4, minimise="rms_c")
    assert front_view.swept_problem(PROBLEM, "C", "D") == Problem(B=1.7, order=4, minimise="D")
    shown = front_view.front(Problem(order=4), "B", "C")
    assert shown["words"] == "least C at each B: proven at every point"
    assert len(shown["series"][0]["at"]) > 30
    (way,) = (way for way in law_view.ways(Problem(B=1.7, order=4, J=at_most(20.0))) if way["entry"] == "J")
    assert way["text"] == "raise the bound of J from 20 to 47.504"


def test_laws_are_given_by_name_and_no_file_is_read() -> None:
    assert given_law(LawRequest(name="III(7.2)")).constants.B.value == 1.859375
    with pytest.raises(InputError, match="names a file, and the page reads none: drop it onto the page"):
        requests.without_files({"bounds": {"residual(spectrum='{shaker.csv}')": [0, 1]}})


def test_a_law_in_the_units_of_a_machine() -> None:
    press = LawsRequest(laws=[LawRequest(name="cubic")], stroke="40 mm", time="0.2 s", mass="3 kg")
    motion, force = law_view.in_machine_units(press)["rows"]
    cells = {"B": "300 mm/s", "C": "6 m/s²", "J": "60 m/s³", "rms_c": "3.4641 m/s²"}
    assert motion == {"name": "40 mm in 0.2 s", "cells": cells}
    assert force == {"name": "3 kg", "cells": {"C": "18 N", "D": "2.0785 W", "rms_c": "10.392 N"}}


def test_forms_have_the_entries_of_what_they_make() -> None:
    form: dict[str, Any] = cycle_view.form()
    assert [limit["name"] for limit in form["limits"]["motion"]] == [
        "velocity", "acceleration", "deceleration", "jerk", "snap",
    ]  # fmt: skip
    assert form["segments"]["dwell"][0]["name"] == "duration"
    assert cam_view.form()["axes"]["inclined flat"] == "length"
    assert form["drive"]["length"][0]["placeholder"] == "none, or 2.5 kg"
    assert sorted(machine_view.kinds()["table"]) == ["axis", "fields", "mechanism"]
    assert machine_view.kinds()["rack"]["mechanism"] == {"radius": "20 mm", "mass": "12 kg"}


def test_examples_are_answered() -> None:
    rows = advice_view.standard(CycleRequest(study=cycle_view.example()))["rows"]
    assert [row["name"] for row in rows][:2] == ["modified sine", "modified trapezoid"]
    axes = axes_view.example()
    assert axes_view.clearances(CycleRequest(study=axes))["trust"]["word"] == "interlocks clear"
    gained = axes_view.together(CycleRequest(study=axes | {"overlap": {"goal": "acceleration", "of": ["die"]}}))
    assert gained["facts"][1] == "greatest acceleration, as a share of the given one 0.193894"
    facts = cam_view.sizes(CycleRequest(study=cam_view.example()))["facts"]
    least = next(str(fact) for fact in facts if str(fact).startswith("least prime circle, by"))
    assert least == "least prime circle, by the pressure angle 58.608 mm at 264.38 deg"
