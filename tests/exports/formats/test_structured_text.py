"""Function blocks in Structured Text and templates of programs, as grammars and compilers take them."""

import re
import subprocess
from fractions import Fraction
from itertools import product
from math import perm

import numpy as np
import pytest

from optlaws import InputError, Pieces, PiecewiseMotion, Problem, smoothstep, synthesize
from tests.documents import ROOT
from tests.exports.motions import random_motion
from tests.exports.moves import COMPILER, STRICT, exported
from tests.exports.structured_text import Block, parsed, without_comments
from tests.internals.exports import (
    DOUBLE,
    IEC_KEYWORDS,
    SINGLE,
    Labels,
    as_stored,
    error_bounds,
    filled,
    function_block,
    real,
    template,
)

OUTPUTS = ("position", "velocity", "acceleration", "jerk")


def test_the_grammar_of_the_standard_takes_it() -> None:
    source = function_block(random_motion(1, pieces=1, degree=2), "FB_Press", Labels(notes=("a (* comment *) in it",)))
    tree = parsed(source)
    [block] = tree.items
    assert block.name == "FB_Press"
    kinds = [type(declaration).__name__ for declaration in block.declarations]
    assert kinds == ["InputDeclarations", "OutputDeclarations", "VariableDeclarations", "VariableDeclarations"]
    with pytest.raises(Exception, match="_END_WHILE"):
        parsed(source.replace("END_WHILE", "END_FOR", 1))


@pytest.mark.parametrize("single", [False, True])
def test_evaluated_it_keeps_its_bounds_forwards_backwards_and_beyond(single: bool) -> None:  # noqa: FBT001
    arithmetic = SINGLE if single else DOUBLE
    law = synthesize(Problem(B=1.859, order=4, basis=Pieces(6, 7, 3))).law
    for motion in (law.pieces("35 mm", "0.12 s"), smoothstep(5).pieces("1 m", "1 s"), random_motion(2, degree=3)):
        block, bounds = Block(function_block(motion, "FB_Press", single=single)), error_bounds(motion, arithmetic)
        breaks = as_stored(motion, arithmetic).breaks
        places = np.concatenate([np.linspace(breaks[0], breaks[-1], 41), breaks, breaks[::-1], breaks[1:2]])
        for x in np.clip(places.astype(np.float32 if single else np.float64), breaks[0], breaks[-1]).tolist():
            found = block(x)
            piece = int(np.searchsorted(breaks[1:-1], x, side="right"))
            assert found["piece"] == piece
            assert found["inside"]
            for nu, name in enumerate(OUTPUTS):
                assert isinstance(found[name], np.float32 if single else np.float64)
                s = Fraction(x) - Fraction(motion.breaks[piece])
                row = enumerate(motion.coefficients[piece])
                exact = sum((Fraction(c) * perm(n, nu) * s ** (n - nu) for n, c in row if n >= nu), Fraction(0))
                assert abs(Fraction(float(found[name])) - exact) <= Fraction(bounds[nu])
        after, last = block(breaks[-1] + 1.0)["position"], block(breaks[-1])["position"]
        assert after == last
        assert not block(breaks[0] - 1.0)["inside"]


@pytest.mark.parametrize("block", ["motion", "front"])
def test_statements_end_with_semicolons_and_variables_are_called_like_nothing_of_the_standard(block: str) -> None:
    """The standard's own grammar wants both, though the parser above takes a block without."""
    source = without_comments(
        {
            "motion": lambda: function_block(random_motion(1, pieces=2, degree=2), "FB_Press"),
            "front": lambda: exported("lift", "iec-st").text,
        }[block]()
    )
    assert "END_IF;" in source or "END_WHILE;" in source
    assert re.findall(r"END_(?:IF|WHILE|FOR)\b(?!;)", source) == []
    names = {name.lower() for name in re.findall(r"^ +(\w+) : ", source, re.MULTILINE)}
    assert len(names) > 8
    assert names & IEC_KEYWORDS == set()


def test_numbers_are_literals_of_the_standard_and_come_back() -> None:
    for value in (1e-7, -1e22, 0.1, 5.0, 1.5e300, 5e-324, 1e16):
        assert float(real(value)) == value
        mantissa = real(value).partition("E")[0]
        assert "." in mantissa
    assert np.float32(real(0.1, single=True)) == np.float32(0.1)


@pytest.mark.parametrize("name", ["1st", "FUNCTION", "two words", "a__b", None])
def test_what_the_target_refuses_as_a_name_is_refused(name: object) -> None:
    with pytest.raises(InputError, match=r"takes no variable called .*; take '"):
        function_block(PiecewiseMotion([0, 1], [[0, 1]]), name)  # type: ignore[arg-type]


# --- templates ---


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
