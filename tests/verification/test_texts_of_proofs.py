"""Files of proofs say in words nothing that a number could make false: names and descriptions have no quantities."""

import inspect
import json
import re
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import Any

import pytest

import optlaws
import optlaws.typing
from optlaws import Cycle, Dwell, Return, Rise, Solution
from optlaws.verification import verify_all
from tests.internals.cli import verify as command

MOVES = [Rise("35 mm", "120 deg"), Dwell("60 deg"), Return()]
LIMITS = {"acceleration": "20 m/s^2", "jerk": "2000 m/s^3"}


def cycle(segments: list[Any] = MOVES, **options: Any) -> Cycle:
    return Cycle(segments, speed="60 rpm", **options)


GIVEN = [Rise("35 mm", "180 deg", law="cycloidal"), Return(law="cycloidal")]
LOADED: dict[str, Any] = {"drive": {"mass": "10 kg"}, "limits": {"rms force": "200 N"}}
MADE: dict[str, Callable[[], dict[str, Any]]] = {
    "FastestCycle, limits": lambda: cycle(limits=LIMITS).fastest().claims(),
    "FastestCycle, rating": lambda: cycle(**LOADED).fastest().claims(),
    "FastestCycle, power": lambda: cycle(drive={"mass": "10 kg"}, limits={"power": "90 W"}).fastest().claims(),
    "TransitionCam, run-in": lambda: cycle(GIVEN).run_in("90 deg", over="120 deg").claims(),
    "TransitionCam, run-out": lambda: cycle(GIVEN).run_out("90 deg", over="120 deg").claims(),
    "TransitionCam, least": lambda: cycle(limits=LIMITS).run_in("60 deg", rest="-20 mm").claims(),
    "Advice": lambda: optlaws.advise(Rise("1 m", "1 s"), points=2).proofs(),
}

#: a number with a decimal point or an exponent, or with a unit behind it
QUANTITY = re.compile(r"\d\.\d|\de[+-]?\d|\d+ *(?:%|deg|rad|rpm|s\b|ms\b|mm|m\b|m/s|N|W|J|Hz)")


@cache
def made(name: str) -> str:
    return json.dumps(MADE[name](), allow_nan=False)


def texts(data: Any) -> Iterator[str]:
    """Names and texts around the entries that are verified."""
    if isinstance(data, dict) and not {"proof", "problem", "solution"} & data.keys():
        for key, value in data.items():
            yield key
            yield from texts(value)
    elif isinstance(data, list):
        for value in data:
            yield from texts(value)
    elif isinstance(data, str):
        yield data


def test_every_class_that_writes_proofs_is_among_them() -> None:
    known = {name.partition(",")[0] for name in MADE}
    for module in (optlaws, optlaws.typing):
        for name in module.__all__:
            one = getattr(module, name)
            writes = inspect.isclass(one) and one is not Solution
            if writes and any(inspect.isfunction(getattr(one, each, None)) for each in ("claims", "proofs")):
                assert name in known


@pytest.mark.parametrize("name", MADE)
def test_no_text_of_a_file_of_proofs_states_a_quantity(name: str) -> None:
    data = json.loads(made(name))
    found = list(texts(data))
    assert found
    assert [text for text in found if QUANTITY.search(text)] == []
    assert "about" not in data


@pytest.mark.sample(3)
@pytest.mark.parametrize("name", MADE)
def test_a_text_that_was_put_into_a_file_is_not_shown(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    data = json.loads(made(name))
    true = {place: [str(claim) for claim in one.claims] for place, one in verify_all(data).items()}
    changed = {"about": "greatest speed 987.654 rpm, least period 0.0607501 s", **data}
    assert {place: [str(claim) for claim in one.claims] for place, one in verify_all(changed).items()} == true
    file = tmp_path / "proofs.json"
    file.write_text(json.dumps(changed), "utf-8")
    command(file)
    assert "987.654" not in capsys.readouterr().out
