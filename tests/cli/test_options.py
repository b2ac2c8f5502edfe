"""Options made from functions and declared values: their names, sentences and values, as a command has them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import pytest
from cyclopts import App

from optlaws import (
    Follower,
    InputError,
    Response,
    advise,
    compare_laws,
    fastest,
    pareto_front,
    read_cycle_table,
    read_law,
)
from tests.internals.cli import Option, _head, _of_object, options, takes
from tests.internals.cycles import ElasticFollower
from tests.internals.entries import entries_of
from tests.internals.motion import motion_of_law

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
        ("optlaws.cycles.old_tables.table:read_cycle_table", read_cycle_table),
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
