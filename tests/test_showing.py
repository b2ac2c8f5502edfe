"""What is shown of laws and results: drawings, steps, reports and summaries."""

import re
import sys
from dataclasses import replace
from html.parser import HTMLParser
from io import StringIO
from math import degrees, nan
from threading import Thread
from typing import Any

import numpy as np
import pytest

import optlaws
from optlaws import (
    Cycle,
    DiscCam,
    Drive,
    Dwell,
    Mechanism,
    Motor,
    Problem,
    ProblemArray,
    Return,
    Rise,
    TranslatingRoller,
    pareto_front,
    smoothstep,
    synthesize,
    synthesize_array,
)
from optlaws.results import Page
from tests.cli.test_show import Terminal
from tests.internals.explorer import fact_sentences, panel_data, table_data
from tests.internals.plots import draw_panels, empty_figure
from tests.internals.shown import ReportTable, Row, Section, Summary, facts, page, report_page, showing, steps
from tests.internals.studies import Bar, Silent, watching


def curve(svg: str) -> str:
    found = re.search(r'<path d="([^"]*)"', svg)
    assert found is not None
    return found[1]


def test_a_curve_fills_the_drawing_but_for_its_margins() -> None:
    svg = showing.drawing("c", [1.0, 2.0, 5.0], [-1.0, 3.0, 1.0])
    assert curve(svg) == "M4.0,56.0 L39.5,4.0 L146.0,30.0"
    assert '<line x1="4" x2="146" y1="43.0" y2="43.0" ' in svg
    assert 'viewBox="0 0 150 60"' in svg
    assert '<text x="146" y="12" ' in svg


def test_what_has_one_sign_begins_at_0_and_what_is_0_is_drawn_at_the_bottom() -> None:
    assert curve(showing.drawing("b", [0.0, 1.0], [2.0, 4.0])) == "M4.0,30.0 L146.0,4.0"
    assert curve(showing.drawing("c", [0.0, 1.0], [-2.0, -4.0])) == "M4.0,30.0 L146.0,56.0"
    assert curve(showing.drawing("d", [0.0, 1.0], [0.0, 0.0])) == "M4.0,56.0 L146.0,56.0"
    assert curve(showing.drawing("a", [3.0], [1.0])) == "M4.0,4.0"


def test_a_curve_is_broken_where_it_is_not_finite() -> None:
    assert curve(showing.drawing("j", [0.0, 0.5, 0.5, 0.5, 1.0], [1.0, 1.0, nan, 2.0, 2.0])) == (
        "M4.0,30.0 L75.0,30.0 M75.0,4.0 L146.0,4.0"
    )
    assert "M" not in showing.drawing("none", [0.0, 1.0], [nan, nan])


def test_names_and_texts_are_escaped() -> None:
    svg = showing.drawing('<"c">', [0.0, 1.0], [0.0, 1.0])
    assert 'aria-label="&lt;&quot;c&quot;&gt;"' in svg
    assert ">&lt;&quot;c&quot;&gt;</text></svg>" in svg
    assert showing.table(["<"], [[1 / 3, None], ["&", 2]]) == (
        "<table><tr><th>&lt;</th></tr><tr><td>0.3333333</td><td></td></tr><tr><td>&amp;</td><td>2</td></tr></table>"
    )


class Clock:
    now = 100.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    clock = Clock()
    monkeypatch.setattr(steps, "monotonic", clock)
    monkeypatch.setattr(steps, "watched", lambda: True)
    return clock


def test_a_bar_appears_once_the_work_has_taken_its_time_and_goes(
    clock: Clock, capsys: pytest.CaptureFixture[str]
) -> None:
    with steps.Steps("laws", 3) as work:
        clock.now += steps.PATIENCE - 0.1
        work.reach(1)
        before = work._bar
        clock.now += 0.1
        work.reach(2)
        assert before is None
        assert work._bar is not None
        progress, task = work._bar
        assert progress.live.transient
        shown = progress.tasks[task]
        assert (shown.description, shown.completed, shown.total) == ("laws", 2, 3)
        work.reach(3)
        assert shown.completed == 3
    assert progress.finished
    assert capsys.readouterr().out == ""
    assert work._bar is None


def test_no_bar_appears_for_what_is_done_or_not_watched(clock: Clock, monkeypatch: pytest.MonkeyPatch) -> None:
    work = steps.Steps("laws", 3)
    clock.now += 2 * steps.PATIENCE
    work.reach(3)
    assert work._bar is None
    monkeypatch.setattr(steps, "watched", lambda: False)
    work.reach(1)
    assert work._bar is None


@pytest.mark.parametrize(("kernel", "widgets"), [(True, True), (True, False), (False, True), (False, False)])
def test_a_notebook_watches_if_it_has_widgets(*, kernel: bool, widgets: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.stderr.isatty", lambda: False, raising=False)
    monkeypatch.setattr(steps, "find_spec", lambda _: object() if widgets else None)
    modules = {name: module for name, module in sys.modules.items() if name != "ipykernel"}
    monkeypatch.setattr(sys, "modules", modules | ({"ipykernel": sys} if kernel else {}))
    assert steps.watched() is bool(kernel and widgets)


def test_a_terminal_watches_unless_it_is_told_otherwise(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(steps, "find_spec", lambda _: None)
    monkeypatch.setattr("sys.stderr.isatty", lambda: True, raising=False)
    assert steps.watched()
    outer, inner = list[tuple[str, bool]](), list[tuple[str, bool]]()
    with steps.shown_by(lambda *said: outer.append(said)):
        assert not steps.watched()
        steps.step("first")
        with steps.shown_by(lambda *said: inner.append(said)):
            steps.step("second", stays=True)
        with steps.Steps("laws", 3) as laws:
            laws.reach(2)
    assert (outer, inner) == ([("first", False), ("laws, 2 of 3", False)], [("second", True)])
    steps.step("nobody hears it")
    assert steps.watched()


# --- steps ---


def watched_by(monkeypatch: pytest.MonkeyPatch) -> Terminal:
    """A terminal in place of stderr; a fixture's would be replaced by pytest's before the test."""
    made = Terminal()
    monkeypatch.setattr(sys, "stderr", made)
    monkeypatch.setattr(steps, "PATIENCE", 0.0)
    monkeypatch.setenv("TERM", "xterm")
    return made


def test_a_terminal_sees_the_steps_of_a_front_and_of_an_array(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal = watched_by(monkeypatch)
    pareto_front(Problem(order=3), points=5, between=(1.6, 1.8))
    assert "least C over B" in terminal.getvalue()
    terminal.truncate(0)
    minimise = np.array(["C", "0.5*C/4 + 0.5*J/32"])
    synthesize_array(ProblemArray(B=1.7, order=3, minimise=minimise))
    assert "laws" in terminal.getvalue()


def test_nobody_sees_what_is_quick_or_said_otherwise(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal = watched_by(monkeypatch)
    with steps.shown_by(lambda *_: None):
        pareto_front(Problem(order=3), points=4, between=(1.6, 1.8))
        assert type(watching()) is Silent
    assert isinstance(watching(), Bar)
    monkeypatch.setattr(steps, "PATIENCE", 60.0)
    pareto_front(Problem(order=3), points=4, between=(1.6, 1.8))
    seen: list[bool] = []
    thread = Thread(target=lambda: seen.append(steps.watched()))
    thread.start()
    thread.join()
    assert seen == [False]
    assert terminal.getvalue() == ""


def test_a_file_gets_no_bar(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stderr", StringIO())
    assert not steps.watched()
    monkeypatch.setattr(sys, "stderr", None)
    assert not steps.watched()


def test_a_bar_is_taken_away_where_work_fails(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal = watched_by(monkeypatch)
    shown = steps.Steps("laws", 3)

    def fail() -> None:
        with shown:
            shown.reach(1)
            raise ValueError("wrong")

    with pytest.raises(ValueError, match="wrong"):
        fail()
    assert shown._bar is None
    assert "laws" in terminal.getvalue()


# --- reports ---


CYCLE = Cycle(
    [Rise("25 mm", "150 deg", law="3-4-5"), Dwell("30 deg"), Return(law="modified trapezoid")],
    speed="300 rpm",
    limits={"velocity": "2 m/s", "acceleration": ["-90 m/s^2", "80 m/s^2"]},
    drive={"mass": "2 kg", "stiffness": "3 N/mm", "preload": "60 N"},
).unchecked()
DRIVEN = Cycle(
    [Rise("45 deg", "0.25 s", law="modified sine"), Dwell()],
    period="0.8 s",
    advance="45 deg",
    drive=Drive(Mechanism("0.8 kg m^2"), Motor("3e-4 kg m^2", peak_torque="4 N m"), ratio=20),
)
RESULTS: dict[str, Any] = {
    "cycle": CYCLE,
    "driven": DRIVEN,
    "cam": DiscCam(Cycle(CYCLE.segments, speed="300 rpm"), "60 mm", TranslatingRoller("12 mm", offset="6 mm")),
    "law": optlaws.catalogue["modified trapezoid"].law,
    # their jerks swing at places that samples at equal distances never meet
    "law of degree 41": synthesize(Problem(B=1.7, order=4, basis=optlaws.Chebyshev(41))).law,
    "cycle of degree 25": Cycle([Rise("25 mm", "150 deg"), Return()], speed="300 rpm", order=4, degree=25),
    "solution": optlaws.synthesize(
        optlaws.Problem(
            order=4,
            B=1.7,
            D=optlaws.at_most(8.0),
            symmetric=False,
            windows=(
                optlaws.Window("b", high=1.2, start=0.1, stop=0.3),
                optlaws.Window("c + 2*b", high=7.0, start=0.6, stop=0.9),
                optlaws.via("a", 0.45, at=0.45),
            ),
        )
    ),
    "move": optlaws.fastest(
        optlaws.Problem(order=4), stroke="300 mm", limits={"acceleration": "12 m/s^2", "snap": "60000 m/s^4"}
    ),
    "front": optlaws.pareto_front(optlaws.Problem(order=4), over=("B", "C"), points=5, between=(1.5, 1.8)),
    "proven front": optlaws.proven_front(optlaws.Problem(order=4), between=(1.6, 1.7), gap=1e-3),
    "residual": optlaws.response_spectrum(optlaws.catalogue["cycloidal"].law, np.linspace(4.0, 40.0, 101), 0.03),
}


@pytest.mark.parametrize("kind", RESULTS)
def test_curves_go_through_the_peaks_of_the_law_and_not_beyond_its_ends(kind: str) -> None:
    for panel in RESULTS[kind].report().panels:
        curve = panel.series[0]
        assert len(curve.at) < 1000
        assert (np.diff(curve.at) >= 0.0).all()
        for at, value in panel.peaks:
            assert np.abs(curve.values[np.isclose(curve.at, at, rtol=1e-9)] - value).min() <= 1e-6 * abs(value)
        if any(panel.ends) and kind != "cam":
            low, high = panel.ends
            room = 1e-6 * panel.peak
            assert low - room <= curve.values.min() <= low + 1e3 * room
            assert high - 1e3 * room <= curve.values.max() <= high + room


@pytest.mark.parametrize("kind", RESULTS)
def test_every_output_renders_the_same_report(kind: str) -> None:
    report = RESULTS[kind].report()
    page, html = str(Page("a result").report(report)), report_page("a result", report)
    columns = [heading.partition(",")[0] for table in report.tables for heading in table.headings]
    for row in report.facts:
        assert f"| {row.name} " in page or row.name in columns
        assert row.name in html.replace("&#x27;", "'")
    figure = empty_figure()
    axes = list(figure.subplots(len(report.panels), 1, squeeze=False)[:, 0])
    draw_panels(report.panels, report.segments, axes)
    assert html.count("<svg") == len(report.panels)
    for panel, each in zip(report.panels, axes, strict=True):
        data = panel_data(panel)
        assert panel.title == each.get_ylabel() == ", ".join(filter(None, (data["name"], data["unit"])))
        drawn = np.array(data["series"][0]["values"], dtype=float)
        assert drawn == pytest.approx(np.asarray(each.lines[0].get_ydata()), rel=1e-6, abs=1e-6, nan_ok=True)
        # over what the panel says, on the page as in the picture
        across = np.asarray(each.lines[0].get_xdata())
        assert across == pytest.approx(panel.per * panel.series[0].at)
        assert data["series"][0]["at"] == pytest.approx(across, rel=1e-3, abs=1e-4)
    assert axes[-1].get_xlabel() == report.panels[0].across


def test_limits_of_a_problem_are_those_of_its_curves_and_not_of_its_formulas() -> None:
    shown = {
        panel.name: [(limit.name, limit.low, limit.high) for limit in panel.limits]
        for panel in RESULTS["solution"].report().panels
    }
    assert shown == {
        "displacement a": [("via point", 0.45, 0.45)],
        "velocity b": [("B = 1.7", -1.7, 1.7), ("window", -np.inf, 1.2)],
        "acceleration c": [],
        "power d": [("D at most 8", -8.0, 8.0)],
        "jerk j": [],
    }
    labels = [artist.get_label() for artist in RESULTS["solution"].plot()]
    assert {"B = 1.7", "via point", "window"} <= set(labels)


def test_a_limit_far_from_what_is_used_on_its_side_is_not_drawn() -> None:
    velocity, acceleration = RESULTS["move"].report().panels[1:3]
    figure = empty_figure()
    axes = list(figure.subplots(2, 1))
    draw_panels([velocity, acceleration], [], axes)
    assert [line.get_ydata()[0] for line in axes[1].lines[1:]] == [-12.0, 12.0]
    assert len(axes[0].lines) == 1


def test_a_section_is_a_part_of_a_page_and_a_list_of_sentences() -> None:
    section = RESULTS["cam"].report().section
    page, sentences = str(Page("a result").section(section)), fact_sentences(section.facts)
    for row, words in zip(section.facts, sentences, strict=True):
        assert f"| {row.name} " in page
        assert words.startswith(f"{row.name} {row.value[0]:.6g} {row.unit}")
        assert words.endswith("deg")
    assert page.index(section.text[:20]) < page.index("| what")
    assert str(Page("a result").section(Section())) == str(Page("a result"))
    named = Section("Sizes", section.facts[:1], figure=("cam", "A cam"), note="That is all.", digits=3)
    parts = [part for part in str(Page("a result").section(named)).split("\n\n")[2:] if part]
    assert [part.partition(" ")[0] for part in parts] == ["##", "![A", "|", "That"]


def test_numbers_of_a_table_have_their_units_with_them_on_the_page() -> None:
    table = ReportTable(["what", "least", "unit"], [["radius", 5.0, "mm"], ["turn", np.inf, ""]])
    assert table_data(table) == {"headings": ["what", "least"], "rows": [["radius", "5 mm"], ["turn", None]]}


# --- summaries ---


SUMMED = Cycle(
    [Rise("25 mm", "150 deg", law="3-4-5"), Return(law="3-4-5")],
    speed="300 rpm",
    drive={"mass": "2 kg", "stiffness": "3 N/mm", "preload": "60 N"},
)
SUMMARIES: dict[str, Any] = {
    "constants": smoothstep(3).constants,
    "solution": synthesize(Problem(B=1.8, order=4)),
    "array": synthesize_array(ProblemArray(B=np.array([1.05, 1.7, 1.8]), order=4)),
    "cycle": SUMMED,
    "cam": DiscCam(SUMMED, "60 mm", TranslatingRoller("12 mm")),
    "export": smoothstep(3).export("codesys-xyva", stroke="35 mm", master="120 deg", duration="0.1 s", points=7),
}


@pytest.mark.parametrize("kind", SUMMARIES)
def test_a_result_has_rows_that_print_and_show_in_a_notebook(kind: str) -> None:
    summary = SUMMARIES[kind].summary()
    assert isinstance(summary, Summary)
    assert all(isinstance(row, Row) for row in summary)
    lines, html = repr(summary).splitlines(), SUMMARIES[kind]._repr_html_()
    assert len(lines) == 1 + len(summary)
    for row, line in zip(summary, lines[1:], strict=True):
        assert line.startswith(row.name)
        assert row.text() in line
        assert f"<td>{row.name}</td>" in html.replace("&#x27;", "'")


def test_numbers_of_a_summary_are_those_of_the_law() -> None:
    solution = SUMMARIES["solution"]
    rows = {row.name: row for row in solution.summary()}
    for name, nu in (("B", 1), ("J", 3)):
        peak = solution.law.peak(nu)
        assert (rows[name].value, rows[name].place) == (peak.value, peak.k)
    assert rows["lower bound"].value == solution.lower_bound
    peaks = {row.name: row for row in SUMMED.summary()}
    for nu, name in enumerate(("velocity", "acceleration", "jerk"), 1):
        row = peaks[f"peak {name}"]
        assert row.value == SUMMED.peak(nu)
        assert abs(float(SUMMED(row.place, nu))) == pytest.approx(row.value, rel=1e-9)
    assert peaks["peak force"].value == SUMMED.effort.peak_force


def test_extremes_of_a_cam_are_enclosed_at_their_places() -> None:
    cam = SUMMARIES["cam"]
    rows = {row.name: row for row in cam.summary()}
    low, high = rows["greatest pressure angle"].value
    place = np.radians(rows["greatest pressure angle"].place)
    assert low <= high
    assert abs(degrees(cam.pressure_angle(place))) == pytest.approx(high, rel=1e-6)
    assert rows["contact force, least"].value < rows["contact force, greatest"].value


def test_an_array_counts_its_laws() -> None:
    rows = {row.name: row.value for row in SUMMARIES["array"].summary()}
    assert (rows["problems"], rows["infeasible"], rows["optimal"]) == (3, 1, 2)


# --- notebooks ---


class Checked(HTMLParser):
    """Elements that are closed in order, without scripts; and their text."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.text = ""

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        assert tag != "script"
        assert not any(name.startswith("on") or name in {"href", "src"} for name, _ in attrs)
        self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:  # noqa: ARG002 - its face
        assert tag in {"path", "line"}

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.text += data


SLOW = Cycle(
    [Rise("35 mm", "120 deg"), Dwell("90 deg", name="wait <here>"), Return()],
    speed="200 rpm",
    limits={"velocity": "100 mm/s"},
)
#: a value with how many pictures it shows, and with parts of its text
SHOWN: dict[str, tuple[Any, int, tuple[str, ...]]] = {
    "solution": (SUMMARIES["solution"], 5, ("optimal", f"{SUMMARIES['solution'].objective:.7g}", "lower bound")),
    "problem": (Problem(B=1.8, order=4, minimise="0.5*C/4 + J/32"), 0, ("1.8", "minimise")),
    "catalogue": (optlaws.catalogue, len(optlaws.catalogue), ("modified sine",)),
    "entry": (optlaws.catalogue["modified sine"], 5, ("modsine",)),
    "follower": (optlaws.Follower(20, 1.5), 1, ("damping ratio",)),
    "response": (optlaws.Follower(20, 0.05).response(smoothstep(4)), 5, ("residual acceleration",)),
    "comparison": (optlaws.compare_laws("modified sine", "cycloidal"), 10, ("cycloidal",)),
    "cycle": (replace(SLOW, limits={}), 4, ("wait <here>",)),
    "cycle without laws": (SLOW, 0, ("it more time or a wider limit",)),
    "front": (RESULTS["front"], 1, ()),
    "surface": (pareto_front(Problem(order=3), over=("B", "C", "J"), points=4, between=(1.6, 1.8)), 0, ()),
    "array": (SUMMARIES["array"], 1, ("infeasible",)),
}


@pytest.mark.parametrize("kind", SHOWN)
def test_a_notebook_gets_whole_elements_without_scripts(kind: str) -> None:
    value, pictures, parts = SHOWN[kind]
    html, parser = value._repr_html_(), Checked()
    parser.feed(html)
    assert parser.open == []
    assert not re.search(r"\b(?:nan|inf)\b", "".join(re.findall(r'd="([^"]*)"', html)))
    assert html.count("<svg") == pictures
    for part in parts:
        assert part in parser.text
    assert "<i>" not in page("<i>", facts({"<i>": "<i>"}))
