"""Summaries: rows of every kind of result, recomputed from it, and the same wherever they are shown."""

from math import degrees
from typing import Any

import numpy as np
import pytest

from optlaws import (
    Cycle,
    DiscCam,
    Problem,
    ProblemArray,
    Return,
    Rise,
    TranslatingRoller,
    smoothstep,
    synthesize,
    synthesize_array,
)
from tests.internals.shown import Row, Summary

CYCLE = Cycle(
    [Rise("25 mm", "150 deg", law="3-4-5"), Return(law="3-4-5")],
    speed="300 rpm",
    drive={"mass": "2 kg", "stiffness": "3 N/mm", "preload": "60 N"},
)
RESULTS: dict[str, Any] = {
    "constants": smoothstep(3).constants,
    "solution": synthesize(Problem(B=1.8, order=4)),
    "array": synthesize_array(ProblemArray(B=np.array([1.05, 1.7, 1.8]), order=4)),
    "cycle": CYCLE,
    "cam": DiscCam(CYCLE, "60 mm", TranslatingRoller("12 mm")),
    "export": smoothstep(3).export("codesys-xyva", stroke="35 mm", master="120 deg", duration="0.1 s", points=7),
}


@pytest.mark.parametrize("kind", RESULTS)
def test_a_result_has_rows_that_print_and_show_in_a_notebook(kind: str) -> None:
    summary = RESULTS[kind].summary()
    assert isinstance(summary, Summary)
    assert all(isinstance(row, Row) for row in summary)
    lines, html = repr(summary).splitlines(), RESULTS[kind]._repr_html_()
    assert len(lines) == 1 + len(summary)
    for row, line in zip(summary, lines[1:], strict=True):
        assert line.startswith(row.name)
        assert row.text() in line
        assert f"<td>{row.name}</td>" in html.replace("&#x27;", "'")


def test_numbers_of_a_summary_are_those_of_the_law() -> None:
    solution = RESULTS["solution"]
    rows = {row.name: row for row in solution.summary()}
    for name, nu in (("B", 1), ("J", 3)):
        peak = solution.law.peak(nu)
        assert (rows[name].value, rows[name].place) == (peak.value, peak.k)
    assert rows["lower bound"].value == solution.lower_bound
    peaks = {row.name: row for row in CYCLE.summary()}
    for nu, name in enumerate(("velocity", "acceleration", "jerk"), 1):
        row = peaks[f"peak {name}"]
        assert row.value == CYCLE.peak(nu)
        assert abs(float(CYCLE(row.place, nu))) == pytest.approx(row.value, rel=1e-9)
    assert peaks["peak of force"].value == CYCLE.effort.peak_force


def test_extremes_of_a_cam_are_enclosed_at_their_places() -> None:
    cam = RESULTS["cam"]
    rows = {row.name: row for row in cam.summary()}
    low, high = rows["greatest pressure angle"].value
    place = np.radians(rows["greatest pressure angle"].place)
    assert low <= high
    assert abs(degrees(cam.pressure_angle(place))) == pytest.approx(high, rel=1e-6)
    assert rows["contact force, least"].value < rows["contact force, greatest"].value


def test_an_array_counts_its_laws() -> None:
    rows = {row.name: row.value for row in RESULTS["array"].summary()}
    assert (rows["problems"], rows["infeasible"], rows["optimal"]) == (3, 1, 2)
