"""The layout of results on a terminal, and options made from functions and declared values."""

from __future__ import annotations

import re
import sys
from collections.abc import Mapping
from io import StringIO
from pathlib import Path
from time import sleep
from typing import TYPE_CHECKING, Any

import pytest
from cyclopts import App

from optlaws import (
    Follower,
    InfeasibleProblem,
    InputError,
    Response,
    advise,
    compare_laws,
    fastest,
    pareto_front,
    read_cycle_table,
    read_law,
    smoothstep,
)
from tests.internals.cli import Answer, Option, _head, _of_object, options, output, show, takes
from tests.internals.cycles import ElasticFollower
from tests.internals.entries import entries_of
from tests.internals.motion import motion_of_law
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


# --- options ---


if TYPE_CHECKING:
    from optlaws.typing import Quantity


def spin(*, speed: Quantity, turns: int = 3, share: float | None = None) -> None:
    """Turn a shaft.

    Parameters
    ----------
    speed
        How fast it turns, such as "200 rpm",
        in any unit.
    turns, share
        How often, or how far.
    """


SPIN = options(spin, "speed", "turns", share={"name": "--part", "read": lambda share: 100.0 * share})


def called(*words: str) -> dict[str, Any]:
    """The table that a command gets of words."""
    tables: list[Mapping[str, Any]] = []

    @takes(motion=SPIN)
    def command(law: str, /, *, motion: Mapping[str, Any], times: int = 1) -> None:
        tables.append({"law": law, "times": times, **motion})

    app = App(result_action="return_none")
    app.default(command)
    app(["cubic", *words], exit_on_error=False, print_error=False)
    return dict(tables[0])


def test_a_function_says_what_its_options_are() -> None:
    about = {name: (each.name, each.about, each.default) for name, each in SPIN.items()}
    assert about == {
        "speed": ("--speed", 'How fast it turns, such as "200 rpm", in any unit.', None),
        "turns": ("--turns", "How often, or how far.", 3),
        "share": ("--part", "How often, or how far.", None),
    }


@pytest.mark.parametrize(
    ("place", "function"),
    [
        ("optlaws.cycles.moves.timed_moves:fastest", fastest),
        ("optlaws.motion.motion:motion_of_law", motion_of_law),
        ("optlaws.cycles.law_comparison:compare_laws", compare_laws),
        ("optlaws.cycles.advising.advice:advise", advise),
        ("optlaws.laws.catalogue.reading:read_law", read_law),
        ("optlaws.cycles.old_tables.splitting:read_cycle_table", read_cycle_table),
        ("optlaws.synthesis.pareto:pareto_front", pareto_front),
        ("optlaws.mechanisms.machine.follower:from_vibration", Follower.from_vibration),
        ("optlaws.mechanisms.machine.response:in_units", Response.in_units),
    ],
)
def test_a_function_is_read_as_text_as_it_is_when_imported(place: str, function: Any) -> None:
    (parameters, text), (known, said) = _head(place), _of_object(function)
    assert text.strip() == said.strip()
    assert known.keys() <= parameters.keys() | {"laws"}
    for name, (kind, default) in known.items():
        if name in parameters and name != "self":
            assert parameters[name] == (kind, default if isinstance(default, str | int | float) else None), name


def test_a_declared_value_is_given_by_its_options() -> None:
    period = options(ElasticFollower, "period", "damping")
    entries = entries_of(ElasticFollower)
    assert {name: each.about for name, each in period.items()} == {name: entries[name].about for name in period}
    assert period["period"].signed
    assert period["damping"].default == entries["damping"].default
    typed = {name: each.value(text) for (name, each), text in zip(period.items(), ["20 ms", 0.05], strict=True)}
    assert ElasticFollower(**typed).to_dict() == {"period": "20 ms", "damping": 0.05}


@pytest.mark.parametrize(
    ("words", "table"),
    [
        ([], {"speed": None, "turns": 3, "share": None, "times": 1}),
        (["--speed", "-5 rpm"], {"speed": "-5 rpm", "turns": 3}),
        (["--turns", "4", "--part", "0.5", "--times", "2"], {"turns": 4, "share": 50.0, "times": 2}),
    ],
)
def test_a_command_takes_the_values_of_its_options_as_a_table(words: list[str], table: dict[str, Any]) -> None:
    assert table.items() <= called(*words).items()


@pytest.mark.parametrize("words", [["--turns", "2.5"], ["--share", "0.5"], ["--turns"]])
def test_a_value_that_is_none_is_refused(words: list[str]) -> None:
    with pytest.raises(Exception, match=words[0]):
        called(*words)


def test_an_option_reads_what_is_typed_once() -> None:
    def refuse(text: str) -> None:
        raise InputError(f"--limit {text}: no")

    option = Option("--limit", str, "A limit.", read=refuse)
    assert option.value(None) is None
    with pytest.raises(InputError, match="--limit x: no"):
        option.value("x")
