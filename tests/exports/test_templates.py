"""Templates of programs as compilers of their languages take them, before anything is filled in."""

import re
import subprocess
from itertools import product

import pytest

from tests.documents import ROOT
from tests.exports.moves import COMPILER, STRICT
from tests.exports.structured_text import parsed
from tests.internals.exports import filled, template

FOLDER = ROOT / "optlaws" / "exports" / "templates"
NUMBERS: dict[str, object] = {
    "LAST": 1,
    "LAST_PIECE": 1,
    "DEGREE": 3,
    "COUNT": 2,
    "BEFORE": 0,
    "HIGHEST": 1,
    "AT_FIRST": 0,
    "AT_LAST": 0,
}
NUMBERS |= {"WIDENED": "1.0", "LEAST": "1.0e-30", "MOST": "1.0e30"}
ARRAYS = ("b[2]", "c[2]", "j[2]", "breaks[3]", "scales[2]")


@pytest.mark.skipif(COMPILER is None, reason="there is no C compiler")
@pytest.mark.parametrize(
    ("file", "rows", "choice"),
    [
        ("motion.h", "coefficients[2][4]", None),
        ("front.h", "series[2][2]", None),
        ("front.h", "series[2][2]", "ODD"),
        ("front.h", "series[2][2][2]", "PIECES"),
    ],
)
def test_a_c_compiler_takes_the_template_itself(file: str, rows: str, choice: str | None) -> None:
    tables = " ".join(f"static const double name_{array} = {{0}};" for array in (*ARRAYS, rows))
    defined = {**NUMBERS, "TABLES": tables, **({choice: 1} if choice else {})}
    command = [str(COMPILER), *STRICT, "-fsyntax-only", *(f"-D{name}={value}" for name, value in defined.items())]
    subprocess.run([*command, "-x", "c", str(FOLDER / file)], check=True)
    broken = template(file).replace("return low", "return lower").replace("low -= 1", "lower -= 1")
    run = subprocess.run([*command, "-x", "c", "-"], input=broken, text=True, capture_output=True, check=False)
    assert "lower" in run.stderr


@pytest.mark.sample(4)
@pytest.mark.parametrize("choices", [set(some) for some in product(["ODD", ""], ["PIECES", ""])])
@pytest.mark.parametrize("file", ["motion.st", "front.st", "codesys.st"])
def test_the_grammar_of_the_standard_takes_the_template_itself(file: str, choices: set[str]) -> None:
    [block] = parsed(
        filled(template(file), {"TABLES": ["    widened : LREAL := 1.0;"], "SEGMENTS": [], "COUNT": 1}, choices)
    ).items
    assert block.name == "NAME"


def test_every_template_is_the_source_of_a_program() -> None:
    sources = "".join(path.read_text("utf-8") for path in (ROOT / "optlaws" / "exports").rglob("*.py"))
    assert set(re.findall(r'template\("([\w.]+)"\)', sources)) == {path.name for path in FOLDER.iterdir()}
