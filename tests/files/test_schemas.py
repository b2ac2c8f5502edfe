"""JSON Schemas: what is stored and what is written obeys the one of its kind, and what is damaged does not."""

import json
from collections.abc import Iterator
from collections.abc import Set as AbstractSet
from copy import deepcopy
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator

import optlaws
from optlaws import InputError
from tests.documents import ROOT
from tests.laws.examples import EXAMPLES

RESULTS = sorted((ROOT / "results").rglob("*.json"))
KINDS = {"cam": "cam_results", "cycle": "cycle_results", "fastest": "fastest_results", "fronts": "fronts_results"}
#: entries whose contents are those of problems, or of the solver
OPEN = {"problems", "minimise", "space"}
LAWS = {"loader_optimal": "loader_results", "optimal_table": "table_results"}


@cache
def validator(kind: str) -> Draft202012Validator:
    schema = optlaws.json_schema(kind)
    Draft202012Validator.check_schema(schema)
    return Draft202012Validator(schema)


def kind_of(file: Path) -> str:
    """The kind of a stored file, by its name and its folder."""
    folder = file.parent.name
    laws = "machine_laws_results" if folder.startswith("machine") else "solutions_results"
    return KINDS.get(file.stem) or LAWS.get(folder, laws)


def damaged(data: dict[str, Any], optional: AbstractSet[str]) -> Iterator[Any]:
    """Copies with one thing wrong: an entry too many or too few, a number that is a text, a text that is a number."""
    yield [data]
    yield {**data, "further": 1}
    for key in data.keys() - optional:
        yield {name: value for name, value in data.items() if name != key}
    for path in paths(data):
        copy = deepcopy(data)
        inner: Any = copy
        for step in path[:-1]:
            inner = inner[step]
        value = inner[path[-1]]
        inner[path[-1]] = {"nothing": []} if isinstance(value, str | int | float) else True
        yield copy


def paths(data: object, depth: int = 3) -> Iterator[list[Any]]:
    """Paths to entries, to the first of each list, and to none of what schemas leave open."""
    steps: Any = data if isinstance(data, dict) else range(min(len(data), 1)) if isinstance(data, list) else ()
    for step in steps:
        if step in OPEN:
            continue
        yield [step]
        if depth > 1:
            yield from ([step, *path] for path in paths(data[step], depth - 1))  # type: ignore[index]


@pytest.mark.parametrize("file", RESULTS, ids=lambda file: f"{file.parent.name}/{file.name}")
def test_every_stored_file_obeys_the_schema_of_its_kind(file: Path) -> None:
    data = json.loads(file.read_text("utf-8"))
    if file.stat().st_size > 2e5:  # the rest of a large file is of the same kind
        data = {name: value[:3] if isinstance(value, list) else value for name, value in data.items()}
    assert [(list(error.absolute_path), error.message) for error in validator(kind_of(file)).iter_errors(data)] == []
    others = {*KINDS.values(), *LAWS.values(), "law", "solution", "cycle", "study"} - {kind_of(file)}
    assert [kind for kind in others if validator(kind).is_valid(data)] == []


@cache
def written() -> dict[str, Any]:
    """A value of each kind as it is written."""
    space = optlaws.Problem(order=3, basis=optlaws.Chebyshev(3))
    move = optlaws.fastest(space, stroke="100 mm", limits={"jerk": "300 m/s^3"})
    slide = optlaws.Cycle(
        [optlaws.Rise("35 mm", "120 deg", law=optlaws.smoothstep(3)), optlaws.Dwell("90 deg"), optlaws.Return()],
        speed="200 rpm",
        limits={"velocity": "1 m/s", "acceleration": ("-80 m/s^2", "90 m/s^2")},
        drive={"mass": "2 kg"},
    )
    table = optlaws.Cycle(
        [optlaws.Rise("90 deg", "120 deg", law="cycloidal"), optlaws.Dwell("90 deg"), optlaws.Return()],
        speed="200 rpm",
        drive=optlaws.Drive(
            optlaws.Mechanism(axis="angle", inertia="0.2 kg m^2", over=("0 deg", "360 deg")),
            optlaws.Motor(inertia="1e-4 kg m^2", peak_torque="9 N m"),
            ratio=10.0,
        ),
        load={"period": "20 ms", "damping": 0.05, "inertia": "0.2 kg m^2"},
    )
    values: dict[str, Any] = {
        "law": optlaws.inertial_loader(optlaws.catalogue["cycloidal"].law).law,
        "solution": optlaws.synthesize(
            optlaws.Problem(order=2, basis=optlaws.Powers(3), B=1.8, minimise="D"), bound="tight"
        ),
        "array": optlaws.synthesize_array(optlaws.ProblemArray(B=[1.05, float("nan"), 1.7, 1.8], order=4)),
        "front": optlaws.pareto_front(space, points=2),
        "proven_front": optlaws.proven_front(space, "B", between=(1.6, 1.61), gap=1e-4),
        "fastest_move": move,
        "time_front": optlaws.time_front(move, "rms jerk", points=2),
        "cycle": slide,
        "axes": optlaws.Axes({"table": table, "slide": slide}),
    }
    plain = {kind: json.loads(value.to_json()) for kind, value in values.items()}
    plain["certificate"] = plain["solution"]["certificate"]
    return plain


#: entries that may be left out, of kinds in which it is not all that are not required
OPTIONAL: dict[str, set[str]] = {"law": set(), "certificate": {"bound", "about", "format"}}


@pytest.mark.sample(3)
@pytest.mark.parametrize(
    "kind",
    ["law", "solution", "array", "front", "proven_front", "fastest_move", "time_front", "cycle", "axes", "certificate"],
)
def test_what_is_written_obeys_and_what_is_damaged_does_not(kind: str) -> None:
    data = written()[kind]
    assert [(list(error.absolute_path), error.message) for error in validator(kind).iter_errors(data)] == []
    required = optlaws.json_schema(kind)["$defs"][kind].get("required")
    optional = OPTIONAL[kind] if required is None else data.keys() - set(required)
    for copy in damaged(data, optional):
        assert not validator(kind).is_valid(copy)


@pytest.mark.parametrize("name", EXAMPLES)
def test_laws_of_every_kind_obey(name: str) -> None:
    assert validator("law").is_valid(json.loads(json.dumps(EXAMPLES[name].to_dict())))


def test_a_study_obeys(tmp_path: Path) -> None:
    optlaws.run_study({"problem": {"order": 3, "degree": 3}, "vary": {"B": [1.7]}}, tmp_path / "study")
    data = json.loads((tmp_path / "study" / "study.json").read_text("utf-8"))
    assert validator("study").is_valid(data)
    for copy in ({**data, "format": 2}, {**data, "points": 0}, {**data, "hash": "1"}, {**data, "study": {}}):
        assert not validator("study").is_valid(copy)


def test_an_unknown_kind_is_refused() -> None:
    with pytest.raises(InputError, match="did you mean 'solution'"):
        optlaws.json_schema("solutoin")


@pytest.mark.parametrize(
    ("file", "way"),
    [
        ("cycle_motor/cycle.json", ("axes", "effort")),
        ("cycle_belt_lift/cycle.json", ("axes", "motor")),
        ("cam_assignment/cam.json", ("spring",)),
        ("cam_assignment/cam.json", ("energy",)),
        ("cam_press/cam.json", ("as_made",)),
    ],
)
def test_numbers_of_results_are_those_that_their_classes_declare(file: str, way: tuple[str, ...]) -> None:
    data = json.loads((ROOT / "results" / file).read_text("utf-8"))
    numbers = data[way[0]]
    if way[0] in {"axes", "as_made"}:
        numbers = next(value for value in numbers.values() if value is not None)
    numbers = numbers if len(way) == 1 else numbers[way[1]]
    schema = validator(KINDS[Path(file).stem])
    assert schema.is_valid(data)
    for name in [*numbers]:
        kept = numbers.pop(name)
        assert not schema.is_valid(data), name
        numbers[name] = kept
    numbers["further"] = 1.0
    assert not schema.is_valid(data)
