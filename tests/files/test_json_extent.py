"""JSON that holds more than anything of ours: refused by every door before it is parsed."""

import json
import tracemalloc
from collections.abc import Callable
from pathlib import Path
from time import process_time
from typing import Any

import pytest

from optlaws import Axes, Cycle, InputError, Machine, MotionLaw, Problem, at_least, open_study, read_law
from optlaws.verification import verify, verify_all
from tests.internals.files import reading
from tests.internals.mechanisms import output_peak

READERS: list[Callable[[Path], Any]] = [verify, verify_all, read_law, lambda file: open_study(file.parent)]
TEXTS: list[Callable[[str], Any]] = [
    MotionLaw.from_json,
    Cycle.from_json,
    Axes.from_json,
    lambda text: output_peak(of=text),
]
#: what takes much more memory than its text, by the unit that is repeated
UNITS = {"numbers": "1,", "lists": "[],", "tables": '{"a":1},', "escapes": None, "deep": None}


def text_of(kind: str, size: int) -> str:
    if kind == "escapes":
        return f'{{"law":"{chr(92)}u1234{f"{chr(92)}u1234" * (size // 6)}"}}'
    if kind == "deep":
        return "[" * size
    unit = UNITS[kind] or ""
    return f'{{"law":[{unit * (size // len(unit))}1]}}'


@pytest.mark.parametrize("read", READERS)
def test_a_file_of_99_mb_is_not_even_read(tmp_path: Path, read: Callable[[Path], Any]) -> None:
    file = tmp_path / "study.json"
    with file.open("wb") as stream:
        stream.truncate(99_000_000)
    began = process_time()
    tracemalloc.start()
    with pytest.raises(InputError, match="larger than 64000000 bytes"):
        read(file)
    assert tracemalloc.get_traced_memory()[1] < 5e6
    tracemalloc.stop()
    assert process_time() - began < 2.0


@pytest.mark.parametrize("kind", UNITS)
def test_a_text_with_too_many_values_is_refused_before_it_is_parsed(
    kind: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = text_of(kind, 24_000_000)
    file = tmp_path / "law.json"
    file.write_text(text, "utf-8")
    parsed: list[str] = []
    monkeypatch.setattr(json, "loads", lambda content, **_: parsed.append(content))
    began = process_time()
    for read in TEXTS:
        with pytest.raises(InputError, match="are more than 3600000 and 600000: give it in parts"):
            read(text)
    with pytest.raises(InputError, match="are more than 3600000 and 600000"):
        read_law(file)
    assert process_time() - began < 2.0 * (len(TEXTS) + 1)
    assert parsed == []


@pytest.mark.long
def test_as_much_as_ten_thousand_solutions_are_read() -> None:
    text = json.dumps([{"k": [0.1] * 2, "multiplier": 0.5}] * 280_000)
    assert len(reading.parsed(text, "a text")) == 280_000


def test_a_text_says_nothing_twice_and_no_number_that_is_none() -> None:
    with pytest.raises(InputError, match="a law: the key 'kind' comes twice"):
        MotionLaw.from_json('{"kind": "polynomial", "kind": "polynomial"}')
    with pytest.raises(InputError, match="a stored cycle: NaN is no JSON number"):
        Cycle.from_json('{"segments": [], "order": NaN}')
    assert reading.parsed(b'{"a": 1}', "bytes") == {"a": 1}
    with pytest.raises(InputError, match="bytes must be JSON text and is not JSON"):
        reading.parsed(b"\xff\xfe", "bytes")


@pytest.mark.parametrize("name", ["x" * 300, "x" * 300 + ".json", "x" * 300 + ".csv", "a\0b", "x/" * 3000])
def test_a_name_that_no_file_can_have_is_no_law(name: str) -> None:
    with pytest.raises(InputError):
        read_law(name)
    assert not reading.is_file(Path(name))


def test_certificates_whose_numbers_leave_double_precision_are_refused() -> None:
    from optlaws import Certificate

    with pytest.raises(InputError, match="tangent of a certificate must be finite"):
        Certificate.of_leaf(Problem(B=1.6, order=2, minimise="D"), (), (), "relaxed", 1.6e300)
    peak = {"problem": Problem(B=at_least(2.2), order=3, minimise="rms_c").to_dict(), "constant": "B", "claim": 1.0}
    cell = {"k": 0.5, "reach": 1.6e300, "sign": 1.0, "contacts": [], "equations": []}
    with pytest.raises(InputError, match="its cells"):
        Certificate.from_dict({**peak, "cells": [cell]})


@pytest.mark.parametrize("duration", [1e-320, 1e-200])
def test_a_duration_whose_square_is_no_number_is_refused(duration: float) -> None:
    with pytest.raises(InputError, match="duration must be a time in s"):
        Machine.from_units(
            [[0, 1], [-1, -1]], [[0], [1]], [[1, 0]], [[0]], inputs="c", outputs=["p"], duration=duration
        )
