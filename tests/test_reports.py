"""Reports: every kind of result makes one, its curves go through the peaks of the law, and every output renders it."""

from typing import Any

import numpy as np
import pytest

import optlaws
from optlaws import Cycle, DiscCam, Drive, Dwell, Mechanism, Motor, Return, Rise, TranslatingRoller
from optlaws.results import Page
from tests.internals.explorer import fact_sentences, panel_data
from tests.internals.plots import draw_panels, empty_figure
from tests.internals.shown import Section, report_page

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
        assert words.startswith(f"{row.name} {row.value[0]:.7g} {row.unit}")
        assert words.endswith("deg")
    assert page.index(section.text[:20]) < page.index("| what")
    assert str(Page("a result").section(Section())) == str(Page("a result"))
    named = Section("Sizes", section.facts[:1], figure=("cam", "A cam"), note="That is all.", digits=3)
    parts = [part for part in str(Page("a result").section(named)).split("\n\n")[2:] if part]
    assert [part.partition(" ")[0] for part in parts] == ["##", "![A", "|", "That"]
