"""What is a formula, what is none and where that shows, and that nothing in one is ever executed."""

from random import Random
from typing import Literal

import pytest

from optlaws import InputError
from tests.formulas.trees import text
from tests.internals.formulas import DEEPEST, LONGEST, Formula, Name, Table, read


@pytest.mark.parametrize(
    ("written", "printed"),
    [
        ("c+0.2*b", "c + 0.2*b"),
        (" c\t- b ", "c - b"),
        ("-b^2", "-b^2"),
        ("(-b)^2", "(-b)^2"),
        ("2^-1", "2^(-1)"),
        ("b**2", "b^2"),
        ("b^2^3", "b^(2^3)"),
        ("a-(b-c)", "a - (b - c)"),
        ("a*(b/c)/2", "a*b/c/2"),
        ("a/(b*c)", "a/(b*c)"),
        ("+c", "c"),
        ("--c", "-(-c)"),
        ("max(a,b,-c)", "max(a, b, -c)"),
        ("table(k, 0:1, 0.5:-2, 1:.5)", "table(k, 0:1, 0.5:-2, 1:0.5)"),
        ("1e-3*c + 1.5e3", "0.001*c + 1500"),
        ("sin(2*pi*k)", "sin(2*pi*k)"),
    ],
)
def test_a_formula_is_printed_as_it_is_read(written: str, printed: str) -> None:
    content = read(written)
    assert str(content) == printed
    assert str(read(printed)) == printed


def test_printing_and_reading_random_formulas_changes_nothing() -> None:
    numbers = Random(3)  # noqa: S311
    for _ in range(300):
        once = read(text(numbers, 4))
        assert read(str(once)) == once


@pytest.mark.parametrize(
    ("written", "message", "place"),
    [
        ("c + ", "expected a number, a name, a function or (", 4),
        ("c b", "expected + - * / ^ or the end", 2),
        ("c + (b", "expected )", 6),
        ("c)", "expected + - * / ^ or the end", 1),
        ("velocity", "unknown name 'velocity'", 0),
        ("c + sine(b)", "unknown function 'sine'; did you mean 'sin'?", 4),
        ("c + sin", "sin needs what it is of, in brackets", 4),
        ("sin(b, c)", "sin takes one part, got 2", 0),
        ("max(b)", "max takes 2 to 12 parts, got 1", 0),
        ("table(k, 0:1)", "table needs 2 to 400 pairs", 0),
        ("table(k, 0:1, 0:2)", "must ascend", 0),
        ("spline(k, 0:1, 1:2)", "spline needs 4 to 400 pairs", 0),
        ("table(k, b:1, 1:2)", "expected a number", 9),
        ("1e999*c", "1e+100 at most", 0),
        ("c @ b", "'@' is not understood", 2),
        ("c.b", "'.' is not understood", 1),
        ("c[0]", "'[' is not understood", 1),
        ("c\x00", "is not understood", 1),
        ("", "expected a number, a name, a function or (", 0),
        ("__import__('os').system('true')", "'.' is not understood", 16),
        ("exec(c)", "unknown function 'exec'", 0),
        ("lambda: c", "unknown name 'lambda'", 0),
        ("c; b", "';' is not understood", 1),
        ("c = b", "expected + - * / ^ or the end", 2),
    ],
)
def test_an_error_points_at_the_character(written: str, message: str, place: int) -> None:
    with pytest.raises(InputError) as caught:
        read(written, "abcjk")
    complaint = str(caught.value)
    assert message in complaint
    *_, pointer = complaint.splitlines()
    assert pointer == " " * (2 + place) + "^"


@pytest.mark.parametrize(
    "written",
    [
        "(" * 200 + "c" + ")" * 200,
        "-" * 5000 + "c",
        "c^" * 3000 + "c",
        "abs(" * 100 + "c" + ")" * 100,
        "c + " * LONGEST,
        "2^" * (DEEPEST + 2) + "2",
    ],
)
def test_what_is_too_long_or_too_deep_is_refused(written: str) -> None:
    with pytest.raises(InputError, match=r"nested 40 deep|1000000 characters"):
        read(written)


@pytest.mark.sample(2)
@pytest.mark.parametrize("sign", ["+", "-", "*", "/"])
def test_a_long_formula_is_not_deep(sign: str) -> None:
    content = read(sign.join(["c"] * 2000))
    assert len(str(content)) >= 2000
    assert hash(content) == hash(read(str(content)))
    assert content.names() == {"c"}


def test_only_texts_are_read() -> None:
    for wrong in (None, 3, b"c", ["c"]):
        with pytest.raises(InputError, match="must be a text"):
            read(wrong)  # type: ignore[arg-type]
    assert isinstance(read("c"), Formula)


@pytest.mark.parametrize(
    ("kind", "order"), [("spline", 1), ("spline", 2), ("monotone", 1), ("monotone", 2), ("table", 1)]
)
def test_the_slope_of_a_table_is_read_as_it_is_written(
    kind: Literal["table", "spline", "monotone"], order: int
) -> None:
    table = Table(Name("a"), (0.0, 0.3, 0.7, 1.0), (1.0, 1.1, 1.4, 1.3), kind, order)
    assert read(str(table), ("a",)) == table
