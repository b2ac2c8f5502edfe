"""Exported programs as others' compilers take and run them: C99 by clang, Structured Text by blark and matiec."""

import re
import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from optlaws import Cycle, MotionLaw
from tests.exports.formats.test_structured_text import OUTPUTS
from tests.exports.moves import SHARES, answers, drawn, exported, program
from tests.exports.samples import SAID, optimal, press
from tests.exports.structured_text import Block, parsed
from tests.external import matiec

pytestmark = pytest.mark.long
needs_both = pytest.mark.skipif(
    any(shutil.which(name) is None for name in ("gcc", "clang")), reason="there are not both gcc and clang"
)
needs_matiec = pytest.mark.skipif(matiec.MISSING is not None, reason=matiec.MISSING or "")


@needs_both
@pytest.mark.parametrize("name", ["lift", "pieces", "skew"])
def test_fronts_answer_alike_under_gcc_and_clang(name: str, tmp_path: Path) -> None:
    """With sanitizers, and with all warnings as errors."""
    moves, found = drawn(exported(name), 500, 51), []
    for compiler in ("gcc", "clang"):
        folder = tmp_path / compiler
        folder.mkdir()
        found.append(answers(program(folder, name, exported(name).text, compiler), moves))
    for one, other in zip(*found, strict=True):
        assert one.plan == other.plan
        assert one.motion.tolist() == other.motion.tolist()


#: programs in Structured Text that hold data for a library of the vendor's
PROGRAMS = [
    *("codesys-xyva", "rockwell-cam", "rockwell-cam-extended", "twincat-table", "codesys-cambuilder", "twincat-nc2"),
    *("twincat-mc3", "siemens-points", "siemens-elements", "siemens-polynomials", "br-acp10"),
]


def in_a_frame(to: str, text: str) -> str:
    """What blark parses: lines of a program in one, and variables of a configuration or a file as global ones."""
    if to.startswith("rockwell"):
        return f"PROGRAM Main\nVAR\n    Press : ARRAY[0..99] OF CAM;\nEND_VAR\n{text}\nEND_PROGRAM\n"
    if to.startswith("siemens"):
        return re.sub(r"^(USING .*|CONFIGURATION .*|END_CONFIGURATION)$", "", text, flags=re.MULTILINE)
    return re.sub(r"^VAR$", "VAR_GLOBAL", text, flags=re.MULTILINE) if to == "br-acp10" else text


@pytest.mark.parametrize("to", PROGRAMS)
def test_blark_parses_what_is_written_for_a_vendors_library(to: str) -> None:
    few = 12 if to.startswith("rockwell") or to == "twincat-table" else None
    text = in_a_frame(to, press().export(to, name="Press", points=few).text)
    assert parsed(text).items
    with pytest.raises(Exception, match=r"."):
        parsed(text.replace(":=", "=:", 1))


@needs_matiec
@pytest.mark.parametrize("to", ["iec-st", "iec-st-real"])
@pytest.mark.parametrize("motion", [optimal, press])
def test_matiec_compiles_a_law_to_what_the_report_says_to_the_last_bit(
    motion: Callable[[], MotionLaw | Cycle], to: str, tmp_path: Path
) -> None:
    source = motion().export(to, name="FB_Cam", **({} if isinstance(motion(), Cycle) else SAID)).text
    x = np.linspace(-5.0, 365.0, 741).astype(np.float32).astype(np.float64)
    x = np.concatenate([x, x[::-1]])
    seen = matiec.outputs(tmp_path, source, "FB_Cam", {"x": x.tolist()}, [*OUTPUTS, "inside"])
    block = Block(source)
    expected = [[float(values[name]) for name in (*OUTPUTS, "inside")] for values in map(block, x.tolist())]
    assert seen.tolist() == expected


@needs_matiec
@pytest.mark.parametrize("name", ["lift", "pieces", "skew"])
def test_matiec_compiles_a_front_to_what_is_planned_in_python(name: str, tmp_path: Path) -> None:
    export = exported(name, "iec-st")
    moves = drawn(export, 60, 53)
    # every move is planned at the elapsed time 0, and then evaluated at shares of the time that it takes
    columns: dict[str, list[float]] = {
        key: []
        for key in (
            "plan",
            "leastTime",
            "stroke",
            "givenTime",
            "velocityLimit",
            "accelerationLimit",
            "jerkLimit",
            "elapsed",
        )
    }
    block, expected = Block(export.text), []
    for move in moves:
        inputs = {"leastTime": not move.time, "stroke": move.stroke, "givenTime": move.time}
        inputs |= {"velocityLimit": move.velocity, "accelerationLimit": move.acceleration, "jerkLimit": move.jerk}
        total = 0.0
        for at in (None, *SHARES):
            call = {"plan": at is None, **inputs, "elapsed": 0.0 if at is None else at * total}
            values = block(**call)
            total = total if at is not None else float(values["moveTime"])
            for key, value in call.items():
                columns[key].append(float(value))
            expected.append([float(values[key]) for key in ("status", "moveTime", *OUTPUTS)])
    seen = matiec.outputs(tmp_path, export.text, f"FB_{name}", columns, ["status", "moveTime", *OUTPUTS])
    expected_motion = np.array(expected)
    assert seen[:, 0].tolist() == expected_motion[:, 0].tolist()
    assert seen[:, 1] == pytest.approx(expected_motion[:, 1], rel=1e-13)
    sizes = np.abs(expected_motion[:, 2:]).reshape(len(moves), -1, 4).max(axis=1).repeat(1 + len(SHARES), axis=0)
    assert (np.abs(seen[:, 2:] - expected_motion[:, 2:]) <= 1e-10 * sizes).all()
