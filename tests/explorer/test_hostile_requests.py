"""Mutated questions of every kind: each has an answer that is none of the server's faults, and soon."""

import json
import re
from copy import deepcopy
from random import Random
from typing import Any

import pytest

from optlaws import smoothstep
from tests.explorer.talk import OPTIMAL, Server
from tests.internals.explorer import (
    QUESTIONS,
    axes_view,
    cam_view,
    example,
    fastest_view,
    machine_view,
    old_cam_view,
)

CYCLE = {"study": example()}
CAM = {"study": cam_view.example()}
OLD = {"study": old_cam_view.example()}
AXES = {"study": axes_view.example()}
MACHINE = {"study": machine_view.example() | {"axis": machine_view.example()["axis"][1:]}}
BEFORE = {"study": machine_view.example(), "laws": [[smoothstep(3).to_dict()], []]}
LAWS = [
    OPTIMAL,
    {"name": "modified sine"},
    {"problem": {"start": [0, 0], "end": [1, 0.5], "degree": 7, "symmetric": False}},
]
TOML = '[problem]\norder = 4\n[[sweep]]\nB = [1.6, "free"]\n'
SEEDS: dict[str, list[Any]] = {
    "laws": [{"laws": LAWS}],
    "law-machine": [{"laws": [OPTIMAL], "stroke": "35 mm", "time": "0.1 s", "mass": "2 kg"}],
    "front": [{"laws": [OPTIMAL], "over": ["B", "C"]}],
    "nearest": [{"laws": [{"problem": {"order": 4, "degree": 9, "B": 1.7, "J": [0, 20]}}]}],
    "advice": [CYCLE | {"follower": {"frequency": ["20 Hz", "24 Hz"], "damping": 0.05}, "minimise": "jerk"}],
    "advice-standard": [CYCLE],
    "axes": [AXES],
    "axes-clearances": [AXES],
    "axes-together": [{"study": axes_view.example() | {"overlap": {"goal": "acceleration", "of": ["die"]}}}],
    "old": [OLD],
    "old-move": [OLD | {"axis": 0}],
    "cam": [CAM],
    "cam-loads": [{"study": cam_view.example() | {"forces": {"width": "20 mm"}}}],
    "cam-sizes": [CAM],
    "fastest": [{"study": fastest_view.example(), "time": 0.36}],
    "fastest-front": [{"study": fastest_view.example()}],
    "machine": [MACHINE, BEFORE],
    "machine-limits": [MACHINE],
    "machine-ratios": [MACHINE | {"low": 5.0, "high": 20.0}],
    "cycle": [CYCLE],
    "cycle-nearest": [CYCLE],
    "export": [
        {"kind": "csv", "view": "laws", "request": {"laws": [OPTIMAL]}, "points": 9},
        {"kind": "csv", "view": "old", "request": OLD | {"laws": [[{}]]}, "points": 9},
    ],
    "save": [
        {"kind": "python", "view": "laws", "request": {"laws": [OPTIMAL]}},
        {"kind": "proof", "view": "laws", "request": {"laws": [OPTIMAL]}},
        {"kind": "proof", "view": "fastest", "request": {"study": fastest_view.example()}},
        {"kind": "problem", "view": "cycle", "request": CYCLE},
    ],
    "open": [{"name": "a.toml", "text": TOML}, {"name": "a.csv", "text": "0;0\n1;0.2\n2;0.7\n3;1\n"}],
    "residual": [
        {"laws": [OPTIMAL], "frequency": 12.0},
        {"laws": [OPTIMAL], "band": [18.0, 22.0], "spectrum": [[16.0, 0.1], [20.0, 1.0], [24.0, 0.2]]},
    ],
    "spectrum": [{"laws": [OPTIMAL], "spectrum": [[30.0, 0.2], [32.0, 1.0]], "duration": "0.1 s"}],
}
ODD: list[Any] = [
    None, True, 0, -1, 1e308, -1e-308, 9e15, 1e6, float("nan"), "", "x", "é\u202e", "9e15", "1e-400 mm", "inf deg", [],
    {}, [[]], {"": ""}, "peak(cos(c))", "../../etc/passwd", "0/0", "1 " * 100, 41, 12, 2.5, "sin(1e9*k)", ["1", 2],
]  # fmt: skip


def places(value: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """The paths of all parts of a value."""
    inner = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    return [path, *(below for key, part in inner for below in places(part, (*path, key)))]


def mutated(question: Any, random: Random) -> bytes:
    """A question with one to three parts replaced, copied, dropped or renamed, or with bytes that are none of JSON."""
    changed = {"whole": deepcopy(question)}
    for _ in range(random.randint(1, 3)):
        *way, last = random.choice([path for path in places(changed) if path])
        holder: Any = changed
        for key in way:
            holder = holder[key]
        kind = random.randrange(4)
        if kind == 0 and isinstance(holder, dict) and way:
            holder[random.choice(["", "B", "law", "windows", "basis", "kind", last])] = holder.pop(last)
        elif kind == 1 and isinstance(holder, list):
            holder.extend(deepcopy(holder))
        else:
            holder[last] = deepcopy(random.choice(ODD))
    text = json.dumps(changed["whole"]).encode()
    if random.random() < 0.1 and text:
        at = random.randrange(len(text))
        text = text[:at] + bytes([random.randrange(256)]) + text[at + 1 :]
    return text


def answers(served: Server, count: int, seed: int) -> list[tuple[int, str, bytes]]:
    """The codes of so many mutated questions, with what was asked."""
    random = Random(seed)  # noqa: S311 - the same questions each time
    names = sorted(SEEDS)
    answered = []
    for _ in range(count):
        name = random.choice(names)
        body = mutated(random.choice(SEEDS[name]), random)
        response, answer = served.send("POST", f"/api/{name}?patience=1", body, Content_Type="application/json")
        assert isinstance(json.loads(answer), dict)
        answered.append((response.status, name, body))
    return answered


def test_every_question_has_mutations() -> None:
    assert set(SEEDS) == set(QUESTIONS)


@pytest.mark.parametrize("count", [60, pytest.param(20_000, marks=pytest.mark.long)])
def test_no_mutated_question_is_a_fault_of_the_server(served: Server, count: int) -> None:
    faults = [asked for asked in answers(served, count, seed=29) if asked[0] not in {200, 422}]
    assert not faults, faults[:5]


def test_no_duration_is_a_fault_of_the_server(served: Server) -> None:
    time = re.compile(r"[\d.]+ m?s")
    counted = 0
    for name, question in ((name, question) for name, several in SEEDS.items() for question in several):
        timed = [path for path in places(question) if path and time.fullmatch(str(part_of(question, path)))]
        for path, given in (
            (path, given) for path in timed for given in ("1e-300 s", "1e300 s", "0 s", "-1 s", "nan s")
        ):
            changed = deepcopy(question)
            part_of(changed, path[:-1])[path[-1]] = given
            response, answer = served.send(
                "POST", f"/api/{name}?patience=1", json.dumps(changed).encode(), Content_Type="application/json"
            )
            assert response.status in {200, 422}, (name, path, given, answer)
            counted += 1
    assert counted > 50


def part_of(value: Any, path: tuple[Any, ...]) -> Any:
    """A part of a value by its path."""
    for key in path:
        value = value[key]
    return value


def test_text_that_is_none_is_refused(served: Server) -> None:
    assert "cannot be read" in served.ask("laws", b'{"laws": [{"name": "\xff\xfe"}]}', 422)["error"]
    assert "cannot be read" in served.ask("cycle", b'{"study": {"title": "\xc3("}}', 422)["error"]
