"""Pictures of interlocked axes, and what a problem file's results say of them."""

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.figure import Figure

from optlaws import After, Axes, Clearance, Cycle, Dwell, Forbidden, InputError, Return, Rise, Synchronous
from optlaws.results import Results
from tests.documents import ROOT
from tests.internals.files import reading
from tests.internals.jobs import cycle_job
from tests.internals.jobs import read_of_cycle_entries as read

X = [
    Dwell("0.1 s"),
    Rise("300 mm", "0.3 s", law="cycloidal"),
    Dwell("0.2 s"),
    Return(None, "0.3 s", law="345"),
    Dwell(),
]
Z = [Rise("80 mm", "0.15 s", law="345", name="lift"), Dwell("0.35 s"), Return(None, "0.15 s", law="345"), Dwell()]
BOX = [("100 mm", "0 mm"), ("200 mm", "0 mm"), ("200 mm", "40 mm"), ("100 mm", "40 mm")]
RULES = [
    After("x", "100 mm", of="z", above="40 mm", way="up"),
    After("x", "100 mm", of="z", above="40 mm", way="down", name="back"),
    Forbidden("x", "z", BOX),
    Clearance("z", over="x", least=[("90 mm", "0 mm"), ("120 mm", "40 mm")]),
    Synchronous("x", "z", during=("0.9 s", "1.1 s"), within="1 m/s"),
]
PAIR = Axes({"x": X, "z": Z}, period="1.2 s", interlocks=RULES)


def test_a_timing_diagram_has_a_bar_for_each_move_and_an_arrow_for_each_pass() -> None:
    panel = PAIR.plot(what="timing")[0].axes
    assert [label.get_text() for label in panel.get_yticklabels()] == ["x", "z"]
    bars = [(round(bar.get_x(), 6), round(bar.get_width(), 6)) for bar in panel.patches]
    assert bars == [(30.0, 90.0), (180.0, 90.0), (0.0, 45.0), (150.0, 45.0)]
    arrows = [text for text in panel.texts if getattr(text, "arrow_patch", None) is not None]
    assert len(arrows) == 2
    texts = {text.get_text() for text in panel.texts}
    assert {"lift 45°", "90°"} <= texts


def test_a_plane_shows_the_path_and_what_is_forbidden() -> None:
    artists = PAIR.plot(what="plane", interlock=2)
    panel = artists[0].axes
    assert (panel.get_xlabel(), panel.get_ylabel()) == ("x, mm", "z, mm")
    across, up = artists[0].get_data()
    times = PAIR.report().panels[0].series[0].at
    assert np.allclose(across, 1e3 * PAIR["x"](times))
    assert np.allclose(up, 1e3 * PAIR["z"](times))
    corners = next(artist.get_xy() for artist in artists if hasattr(artist, "get_xy") and len(artist.get_xy()) == 5)
    assert {tuple(map(round, corner)) for corner in corners} == {(100, 0), (200, 0), (200, 40), (100, 40)}
    turned = Axes(dict(PAIR), interlocks=[Clearance("x", over="z", most="400 + x", units=("mm", "mm"))])
    assert turned.plot(Figure().subplots(), what="plane")[0].axes.get_xlabel() == "z, mm"


def test_clearances_are_drawn_over_the_master() -> None:
    artists = PAIR.plot(what="clearance")
    panels = artists[0].figure.axes
    assert len(panels) == len(RULES)
    assert panels[1].get_title() == "back: how far z is beyond its position"
    for panel, least in zip(panels[2:], PAIR.clearances[2:], strict=True):
        drawn = panel.lines[0].get_ydata()
        assert np.nanmin(drawn) == pytest.approx(1e3 * least.clearance, abs=1e-2 * np.nanmax(np.abs(drawn)))


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: PAIR.plot(what="timeing"), "unknown picture 'timeing'; did you mean 'timing'"),  # type: ignore[arg-type]
        (lambda: PAIR.plot(what="plane", interlock="bak"), "unknown interlock 'bak'; did you mean 'back'"),
        (lambda: PAIR.plot(what="plane", interlock=9), "interlock must be from 0 to 4"),
        (lambda: Axes(dict(PAIR), interlocks=RULES[4:]).plot(what="plane"), "velocities, which have no plane"),
        (lambda: PAIR.plot([1], what="clearance"), "5 interlocks are drawn into as many axes, got 1"),
        (lambda: Axes(dict(PAIR)).plot(what="plane"), "axes without interlocks have no picture of the plane"),
    ],
)
def test_pictures_that_are_none_are_refused(make: Any, says: str) -> None:
    with pytest.raises(InputError, match=says):
        make()


FILE = ROOT / "problems" / "cycle_die_and_table.toml"


def test_a_problem_file_overlaps_its_axes_and_says_what_is_clear() -> None:
    answer = cycle_job.answer(reading.toml(FILE), FILE)
    assert answer["overlap"]["status"] == "optimal"
    assert answer["overlap"]["gain"] == pytest.approx(5.157464, rel=1e-6)
    assert [row["status"] for row in answer["interlocks"]] == ["clear", "clear"]
    stored = json.loads((ROOT / "results" / "cycle_die_and_table" / "cycle.json").read_text("utf-8"))
    assert stored["overlap"]["objective"] == pytest.approx(answer["overlap"]["objective"], rel=1e-9)


def test_axes_with_interlocks_are_a_problem_file(tmp_path: Path) -> None:
    file = tmp_path / "machine.toml"
    file.write_text(PAIR.to_toml("Pair"), "utf-8")
    _, axes = read(reading.toml(file), file)
    assert axes.rules == PAIR.rules
    file.write_text(PAIR.to_toml("Pair").replace("40 mm", "40 deg"), "utf-8")
    with pytest.raises(InputError, match=r"machine\.toml: interlock .*must be a length"):
        read(reading.toml(file), file)


@pytest.mark.sample(2)
@pytest.mark.parametrize("without", [[], ["overlap"], ["overlap", "interlocks"]])
def test_a_page_names_the_pictures_that_are_drawn(tmp_path: Path, without: list[str]) -> None:
    results = Results(FILE)
    for name in without:
        del results.entries[name]
    cycle_job.run(results)
    results.write(tmp_path)
    page = (tmp_path / "cycle.md").read_text("utf-8")
    assert set(re.findall(r"\]\((.*?)\)", page)) == {file.name for file in tmp_path.glob("*.svg")}


def test_the_report_of_axes_says_which_limits_they_break() -> None:
    slow = Cycle(X, period="1.2 s", limits={"velocity": "1 m/s", "acceleration": "90 m/s^2"})
    machine = Axes({"x": slow.unchecked(), "z": Cycle(Z, period="1.2 s")}, interlocks=RULES[2:4])
    (row,) = (row for row in machine.report().facts if "limit exceeded" in row.name)
    (broken,) = (taken for taken in machine["x"].limits_taken if not taken.is_kept)
    assert (row.name, row.value) == ("x: limit exceeded", str(broken))
    assert not any("limit exceeded" in row.name for row in PAIR.report().facts)
