"""One table of a problem's entries: every door takes every entry, or says why not; errors name the entry."""

import dataclasses
import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest

import optlaws
from optlaws import BSplines, InputError, Problem, SolverFailure, Window, via
from optlaws.results import Results
from tests.internals.cli import exit_code, options_of
from tests.internals.entries import entries_of
from tests.internals.jobs import solutions
from tests.internals.studies import StudyPoints, read_study
from tests.internals.studies import entries as entries_of_point
from tests.internals.synthesis import ENTRIES, _neighbours, read_window

SPLINES = {"basis": "bsplines", "breaks": 4, "degree": 3}
ENDS = {"start": [0, 0.5], "end": [1, 0.25], "symmetric": False, "order": 2}
TURNS = {"basis": "periodic", "breaks": 6, "degree": 5, "symmetric": False, "order": 1}
TURNS |= {"start": [0], "end": [1]}
#: by entry: what else is asked, a right value, a wrong one, and the options that give the right one
EXAMPLES: dict[str, tuple[dict[str, Any], Any, Any, list[str]]] = {
    "minimise": ({}, "D", 3, ["--minimise", "D"]),
    "B": ({}, 1.8, "1.8", ["--peak-velocity", "1.8"]),
    "C": ({}, [0, 9], "9", ["--most-acceleration", "9"]),
    "D": ({}, [0, 9], -1, ["--most-power", "9"]),
    "J": ({}, [0, 99], "99", ["--most-jerk", "99"]),
    "order": ({}, 4, 2.5, ["--order", "4"]),
    "bounds": ({}, {"rms_c": [3, 4]}, 3, ["--most", "rms_c=4", "--least", "rms_c=3"]),
    "inflexion": ({"symmetric": False}, 0.4, 1.5, ["--inflexion", "0.4"]),
    "basis": ({}, "bernstein", "splines", ["--basis", "bernstein"]),
    "degree": ({}, 7, 3.5, ["--degree", "7"]),
    "breaks": (SPLINES, 8, "many", ["--breaks", "8"]),
    "continuity": (SPLINES, 1, -1, ["--continuity", "1"]),
    "straight": (TURNS, [0, 2], [7], ["--straight", "0, 2"]),
    "monotone": ({}, True, "yes", ["--monotone"]),
    "symmetric": ({}, False, "no", ["--unsymmetric"]),
    "start": (ENDS, [0, -0.25], "x", ["--start", "0,-0.25"]),
    "end": (ENDS, [1, -0.25], "x", ["--end", "1 -.25"]),
    "windows": ({}, ["b <= 1.9 @ 0.2..0.3"], 3, ["--window", "b <= 1.9 @ 0.2..0.3"]),
}


def base(name: str, others: Mapping[str, Any]) -> dict[str, Any]:
    """What is asked beside an entry."""
    return {key: value for key, value in {"order": 3, "degree": 5, **others}.items() if key != name}


class Caught(Exception):  # noqa: N818 - not an error: it carries what a door asks for
    """Raised in place of solving a problem."""


Catch = Callable[[], Problem]


@pytest.fixture
def caught(monkeypatch: pytest.MonkeyPatch) -> list[Problem]:
    """The problems that doors ask to be solved."""
    asked: list[Problem] = []

    def catches(problem: Problem, *_: object, **__: object) -> None:
        asked.append(problem)
        raise SolverFailure("caught", problem=problem)

    for module, name in ((solutions, "synthesize"), (optlaws, "synthesize")):
        monkeypatch.setattr(module, name, catches)
    monkeypatch.setattr(optlaws, "pareto_front", catches)
    return asked


def from_a_dict(base: Mapping[str, Any], one: Mapping[str, Any], asked: list[Problem], _: Path) -> None:
    asked.append(Problem.from_dict({**base, **one}))


def results_of(data: Mapping[str, Any]) -> Results:
    """Results of a problem file that holds these entries."""
    results = Results("a.toml")
    vars(results)["entries"] = data
    return results


def solved(data: Mapping[str, Any], asked: list[Problem], _: Path) -> None:
    solutions.run(results_of({"job": "solutions", "title": "t", **data}))
    assert asked


def in_a_problem_file(base: Mapping[str, Any], one: Mapping[str, Any], asked: list[Problem], out: Path) -> None:
    solved({"problem": {**base, **one}, "sweep": [{"monotone": [one.get("monotone", False)]}]}, asked, out)


def in_a_sweep(base: Mapping[str, Any], one: Mapping[str, Any], asked: list[Problem], out: Path) -> None:
    solved({"problem": base, "sweep": [{name: [value] for name, value in one.items()}]}, asked, out)


def studied(data: Mapping[str, Any], asked: list[Problem]) -> None:
    study = read_study(data)
    inputs = StudyPoints.of(study).inputs(0)
    asked.append(Problem.from_dict(entries_of_point(study.problem, inputs)))


def in_a_study(base: Mapping[str, Any], one: Mapping[str, Any], asked: list[Problem], _: Path) -> None:
    studied({"problem": {**base, **one}, "vary": {"monotone": [one.get("monotone", False)]}}, asked)


def along_an_axis(base: Mapping[str, Any], one: Mapping[str, Any], asked: list[Problem], _: Path) -> None:
    studied({"problem": base, "vary": {name: [value] for name, value in one.items()}}, asked)


DOORS = (from_a_dict, in_a_problem_file, in_a_sweep, in_a_study, along_an_axis)
REFUSED = {(along_an_axis, "bounds"): "bounds vary one by one: name the constant"}


def unlisted(problem: type[Problem]) -> set[str]:
    """Fields of a problem that the table lacks."""
    return {field.name for field in dataclasses.fields(problem)} - entries_of(problem).keys()


def test_the_table_has_every_field_of_a_problem() -> None:
    assert unlisted(Problem) == set()
    assert unlisted(
        dataclasses.make_dataclass("More", [("novelty", float, 0.0)], bases=(Problem,), frozen=True, kw_only=True)
    ) == {"novelty"}
    assert EXAMPLES.keys() == ENTRIES.keys()


def test_defaults_are_those_of_a_problem() -> None:
    defaults = {name: entry.default for name, entry in ENTRIES.items() if entry.default is not None}
    assert Problem(order=4).to_dict() == {"order": 4, **defaults}


@pytest.mark.parametrize("door", DOORS)
def test_every_door_takes_every_entry(door: Any, caught: list[Problem], tmp_path: Path) -> None:
    for name, (others, value, _, _) in EXAMPLES.items():
        caught.clear()
        asked = base(name, others)
        if (door, name) in REFUSED:
            with pytest.raises(InputError, match=REFUSED[door, name]):
                door(asked, {name: value}, caught, tmp_path)
            continue
        door(asked, {name: value}, caught, tmp_path)
        assert caught == [Problem.from_dict({**asked, name: value})]
        assert Problem.from_dict(caught[0].to_dict()) == caught[0]


@pytest.mark.parametrize("name", EXAMPLES)
def test_an_example_asks_something(name: str) -> None:
    others, value, _, _ = EXAMPLES[name]
    entries = {"order": 3, "degree": 5, **others}
    assert Problem.from_dict({**entries, name: value}) != Problem.from_dict(entries)


@pytest.mark.parametrize("door", DOORS)
def test_wrong_values_and_misspelt_names_are_told(door: Any, caught: list[Problem], tmp_path: Path) -> None:
    for name, (others, value, wrong, _) in EXAMPLES.items():
        asked = base(name, others)
        with pytest.raises(InputError, match=rf"\b{name}\b"):
            door(asked, {name: wrong}, caught, tmp_path)
        near = "bounds.NAME" if (door, name) in REFUSED else name
        with pytest.raises(InputError, match=f"unknown .*'{name}x'; did you mean '{near}'"):
            door(asked, {f"{name}x": value}, caught, tmp_path)
        assert caught == []


def line(name: str) -> list[str]:
    """The options that ask for an example."""
    others, _, _, options = EXAMPLES[name]
    plain = {"order": "3", "degree": "5", "basis": "chebyshev"}
    shape = {key: str(value) for key, value in others.items() if key in {"breaks", "basis", "degree"}}
    ends = {key: " ".join(map(str, others[key])) for key in ("start", "end") if key in others}
    given: dict[str, str] = plain | shape | ends
    left_out = {name, "order"} if ends else {name}
    return [part for key, value in given.items() if key not in left_out for part in (f"--{key}", value)] + options


@pytest.mark.parametrize("name", EXAMPLES)
def test_the_command_solve_takes_every_entry(name: str, caught: list[Problem]) -> None:
    others, value, _, _ = EXAMPLES[name]
    assert exit_code(["solve", *line(name)]) == 4
    assert caught == [Problem.from_dict({**base(name, others), name: value})]


@pytest.mark.sample(2)
@pytest.mark.parametrize("name", EXAMPLES)
def test_the_command_front_takes_every_entry_but_the_objective(
    name: str, caught: list[Problem], capsys: pytest.CaptureFixture[str]
) -> None:
    others, value, _, _ = EXAMPLES[name]
    if name == "minimise":
        assert exit_code(["front", *line(name)]) == 2
        assert "--minimise is not for this command: the last constant of --over is" in capsys.readouterr().err
        return
    assert exit_code(["front", *line(name)]) == 4
    assert caught == [Problem.from_dict({**base(name, others), name: value})]


@pytest.mark.parametrize("name", EXAMPLES)
def test_the_commands_tell_of_misspelt_options(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    option = options_of(ENTRIES[name])[0].name
    assert exit_code(["solve", "--order", "4", "--degree", "5", f"{option}x", "1"]) == 2
    assert option in capsys.readouterr().err


def test_nobody_is_told_of_an_order_that_nobody_gave() -> None:
    with pytest.raises(InputError, match=r"B must be a finite number above 1 .*, got '1\.8'"):
        Problem(B="1.8")  # type: ignore[arg-type]
    cases: tuple[dict[str, Any], ...] = ({}, {"B": 1.8})
    for lacking in cases:
        with pytest.raises(InputError, match=r"lacks order.*give order=4"):
            Problem(**lacking)
        with pytest.raises(InputError, match=r"lacks order.*give order=4"):
            Problem.from_dict(lacking)
    with pytest.raises(InputError, match="order must be an integer of at least 1, got 0"):
        Problem(order=0)


@pytest.mark.parametrize(
    ("text", "window"),
    [
        ("b<=1.2@0.2..0.3", Window("b", high=1.2, start=0.2, stop=0.3)),
        (" a = 0.3 @ 0.4 ", via("a", 0.3, at=0.4)),
        ("-20 <= j <= 2e1 @ 0", Window("j", -20.0, 20.0, 0.0, 0.0)),
        ("c >= -4", Window("c", low=-4.0)),
        ("0.1 <= b", Window("b", low=0.1)),
        ("b <= 1.5 @ 0..1", Window("b", high=1.5)),
        ("a = .5 @ .5", via("a", 0.5, at=0.5)),
    ],
)
def test_windows_are_read_from_text(text: str, window: Window) -> None:
    assert read_window(text) == window
    assert Problem.from_dict({"order": 3, "windows": [text]}).windows == (window,)


@pytest.mark.parametrize(
    "text", ["", "b", "b 1", "1 <= b >= 0", "1 <= b = 2", "b <= x", "b <= 1 @", "b <= 1 @ 0..", "b <= 1 " + " " * 500]
)
def test_texts_that_are_no_windows_are_refused(text: str) -> None:
    with pytest.raises(InputError, match="a window is written as"):
        read_window(text)


@pytest.mark.parametrize(
    ("entries", "near"),
    [
        ({"B": 1.7}, True),
        ({"B": [0, 1.8]}, False),
        ({"minimise": "0.5*C + 0.5*D"}, True),
        ({"minimise": "J"}, False),
        ({"order": 4}, False),
        ({"basis": "powers"}, True),
        ({"degree": 11}, False),
        ({"monotone": True}, False),
        ({"symmetric": False}, False),
        ({"bounds": {"rms_c": [0, 5]}}, True),
        ({"bounds": {"rms_c": [3, None]}}, False),
        ({"bounds": {"rms_j": [0, 5]}}, False),
        ({"C": [0, 8]}, True),
        ({"C": [1, None]}, False),
        ({"C": 8.0}, False),
        ({"windows": ["b <= 1.1 @ 0.1..0.3"]}, True),
        ({"windows": []}, False),
    ],
)
def test_warm_starts_run_along_numbers(entries: dict[str, Any], near: bool) -> None:  # noqa: FBT001
    first = {"order": 3, "B": 1.8, "minimise": "0.6*C + 0.4*D", "bounds": {"rms_c": [0, 4]}, "C": [0, 9]}
    first["windows"] = ["b <= 1.2 @ 0.1..0.2"]
    assert _neighbours(Problem.from_dict(first), Problem.from_dict({**first, **entries})) == near


def test_a_study_takes_a_basis_of_ones_own() -> None:
    study = read_study({"problem": {"order": 3, "basis": "my own"}, "vary": {"B": [1.8]}})
    assert study.problem["basis"] == "my own"


def test_a_sweep_over_numbers_of_pieces(caught: list[Problem]) -> None:
    studied({"problem": {"order": 3, "basis": "bsplines", "degree": 3}, "vary": {"breaks": [4, [0, 0.5, 1]]}}, caught)
    assert caught[0].basis == BSplines(4, 3)


def test_the_order_is_3_unless_it_or_the_ends_are_given(capsys: pytest.CaptureFixture[str]) -> None:
    objectives = []
    for options in ([], ["--order", "3"], ["--start", "0, 0.5", "--end", "1, 0.5"]):
        assert exit_code(["solve", "--degree", "3", "--peak-velocity", "1.6", *options, "--json"]) == 0
        objectives.append(json.loads(capsys.readouterr().out)["objective"])
    assert objectives[0] == objectives[1] > objectives[2]
