"""Bars of long work: for whoever watches, and for nobody else."""

import sys
from io import StringIO
from threading import Thread

import numpy as np
import pytest

from optlaws import Problem, ProblemArray, pareto_front, synthesize_array
from tests.internals.shown import steps
from tests.internals.studies import Bar, Silent, watching


class Terminal(StringIO):
    def isatty(self) -> bool:
        return True


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
