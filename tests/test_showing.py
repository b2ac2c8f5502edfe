"""Small drawings and bars: where their lines are, and when a bar appears."""

import re
import sys
from math import nan

import pytest

from tests.internals.shown import showing, steps


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
