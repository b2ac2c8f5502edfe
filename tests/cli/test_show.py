"""The one layout of results on a terminal: facts with notes behind them, columns for places, tables, lines."""

from __future__ import annotations

import re
import sys
from io import StringIO
from pathlib import Path
from time import sleep
from typing import Any

import pytest

from optlaws import InfeasibleProblem, smoothstep
from tests.internals.cli import Answer, output, show
from tests.internals.shown import PlainReport, ReportTable, Row, Summary, steps

Capture = pytest.CaptureFixture[str]

FACTS = Summary(
    [
        Row("status", "optimal", note="nothing is better"),
        Row("time", 0.25, "s", note="proven"),
        Row("C", 5.5, place=0.125),
        Row("RMS of c", 3.9),
        Row("", "3 iterations"),
        Row("a remark alone"),
    ],
    at="k",
)
SHOWN = """\
status          optimal (nothing is better)
time            0.25 s (proven)
                value  at k
C               5.5    0.125
RMS of c        3.9
                3 iterations
a remark alone
"""
TABLE = ReportTable(("law", "C", "status"), [["K", 4.93480220054, "optimal"], ["Co", None, "local"]])


def closed(text: str) -> str:
    """The text with two blanks between columns: older versions of rich make the first column wider by one."""
    return re.sub(" {2,}", "  ", text)


def test_facts_have_units_and_notes_behind_them_and_places_columns(capsys: Capture) -> None:
    show(FACTS)
    assert closed(capsys.readouterr().out) == closed(SHOWN)


def test_a_report_is_its_facts_and_its_tables_below_and_texts_stay_as_they_are(capsys: Capture) -> None:
    show(PlainReport(FACTS, [TABLE], (), dict), "[a text] of\n  two lines")
    table = "law  C         status\nK    4.934802  optimal\nCo             local\n"
    assert closed(capsys.readouterr().out) == closed(f"{SHOWN}{table}[a text] of\n  two lines\n")


def test_a_narrow_window_cuts_nothing(capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "8")
    show(FACTS, TABLE)
    out = capsys.readouterr().out
    assert closed(out).startswith(closed(SHOWN))
    assert all(line == line.rstrip() for line in out.splitlines())


def test_an_answer_computes_what_it_gives_and_no_more(capsys: Capture, tmp_path: Path) -> None:
    def never(*_: Any) -> Any:
        raise AssertionError("nobody wants it")

    Answer(never, lambda: {"C": 4.0}, never).give(None, as_json=True)
    assert capsys.readouterr().out == '{"C": 4.0}\n'
    Answer(lambda: ["four"], never, smoothstep(3).plot).give(tmp_path / "law.svg", as_json=False)
    assert capsys.readouterr().out == "four\n"
    assert "<svg" in (tmp_path / "law.svg").read_text("utf-8")


def test_an_answer_that_fails_is_given_first(capsys: Capture) -> None:
    answer = Answer(lambda: ["four"], dict, failure=InfeasibleProblem("no law"))
    with pytest.raises(InfeasibleProblem, match="no law"):
        answer.give(None, as_json=False)
    assert capsys.readouterr().out == "four\n"


class Terminal(StringIO):
    """A terminal in place of stderr."""

    def isatty(self) -> bool:
        return True


@pytest.mark.parametrize("stream", [StringIO, Terminal])
def test_a_command_that_takes_long_says_what_it_is_doing(
    stream: type[StringIO], monkeypatch: pytest.MonkeyPatch
) -> None:
    said = stream()
    monkeypatch.setattr(sys, "stderr", said)
    monkeypatch.setenv("TERM", "xterm")
    for name in ("PATIENCE", "_REFRESHED", "BETWEEN_LINES"):
        monkeypatch.setattr(output, name, 0.01)
    with output.busy("optlaws: slide.toml"):
        steps.step("axis slide")
        steps.step("drive.ratio = 20: optimal", stays=True)
        steps.step("drive.ratio = 30")
        while "drive.ratio = 30" not in said.getvalue():
            sleep(0.01)
    assert "optlaws: slide.toml: drive.ratio = 20: optimal\n" in said.getvalue()
    before = said.getvalue()
    sleep(0.05)
    assert said.getvalue() == before
    with output.busy("optlaws cycle"), output.busy("optlaws: table.toml"):
        while "optlaws cycle: table.toml" not in said.getvalue():
            sleep(0.01)
    assert "optlaws: table.toml" not in said.getvalue()
    before = said.getvalue()
    monkeypatch.setattr(output, "PATIENCE", 60.0)
    monkeypatch.setattr(output, "BETWEEN_LINES", 60.0)
    with output.busy("quick"):
        steps.step("axis slide")
    assert said.getvalue() == before
