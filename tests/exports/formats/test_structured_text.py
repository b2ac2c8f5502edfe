"""Function blocks in Structured Text: parsed by a grammar of IEC 61131-3, and evaluated against exact arithmetic."""

import re
from fractions import Fraction
from math import perm

import numpy as np
import pytest

from optlaws import InputError, Pieces, PiecewiseMotion, Problem, smoothstep, synthesize
from tests.exports.motions import random_motion
from tests.exports.moves import exported
from tests.exports.structured_text import Block, parsed, without_comments
from tests.internals.exports import (
    DOUBLE,
    IEC_KEYWORDS,
    SINGLE,
    Labels,
    as_stored,
    error_bounds,
    function_block,
    real,
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
