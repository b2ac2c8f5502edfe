"""What is a formula, what is none and where that shows; equal parts are computed once; functions become formulas."""

import os
import pickle
import subprocess
import sys
from random import Random
from typing import Literal

import numpy as np
import pytest

from optlaws import InputError
from tests.formulas.trees import text
from tests.internals.formulas import (
    DEEPEST,
    LONGEST,
    NUMPY,
    Formula,
    Name,
    Table,
    Traced,
    derivative,
    evaluate,
    read,
    traced,
)


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


# --- equal parts and traced functions ---


def test_parts_that_are_alike_are_one_step() -> None:
    formula = read("sqrt(1 - (0.3*sin(k))^2)*b + cos(k)/sqrt(1 - (0.3*sin(k))^2)")
    texts = [str(step.formula) for step in formula.steps]
    assert len(texts) == len(set(texts))
    assert texts.count("sqrt(1 - (0.3*sin(k))^2)") == 1
    # what is done with is not computed with again
    done: set[int] = set()
    for step in formula.steps:
        assert not done & set(step.parts)
        done |= set(step.done)
    assert len(done) == len(texts) - 1


def test_a_formula_that_doubles_forty_times_is_quick() -> None:
    # as a tree it has more than a million million parts
    x = Traced(Name("x"))
    y = 0.5 * x
    for _ in range(40):
        y = np.sin(y) * (1.0 + 0.01 * y)
    formula, at = y.formula, np.array([0.3, 0.7])

    def by_python(x: np.ndarray) -> np.ndarray:
        y = 0.5 * x
        for _ in range(40):
            y = np.sin(y) * (1.0 + 0.01 * y)
        return y

    step = 1e-6
    assert formula.names() == {"x"}
    assert evaluate(formula, {"x": at}, NUMPY) == pytest.approx(by_python(at), rel=1e-14)
    slope = (by_python(at + step) - by_python(at - step)) / (2.0 * step)
    assert evaluate(derivative(formula, "x"), {"x": at}, NUMPY) == pytest.approx(slope, rel=1e-8)
    assert formula == (y + 0.0).formula


def test_equal_formulas_are_equal_and_others_are_not() -> None:
    texts = ["a + b", "b + a", "a*b", "a^b", "-a", "1/a", "sin(a)", "cos(a)", "2", "3", "max(a, b)", "min(a, b)"]
    texts += ["table(a, 0:1, 1:2)", "table(a, 0:1, 1:3)", "spline(a, 0:1, 1:2, 2:3, 3:5)", "table(b, 0:1, 1:2)"]
    for i, one in enumerate(texts):
        for j, other in enumerate(texts):
            assert (read(one) == read(other)) == (i == j)
    assert len({read(text) for text in texts + texts}) == len(texts)
    assert read("a") != "a"


def test_formulas_go_to_processes_whose_hashes_differ() -> None:
    formula = read("sin(2*a)*c + max(b, 0)")
    assert hash(formula) == hash(read(str(formula)))
    assert len(formula.steps) == 10
    reader = (
        "import pickle, sys; from optlaws.formulas.reading import read;"
        "formula = pickle.loads(sys.stdin.buffer.read());"
        "sys.exit(not {formula: 1}.get(read('sin(2*a)*c + max(b, 0)')))"
    )
    for seed in ("1", "2"):
        environment = {**os.environ, "PYTHONHASHSEED": seed}
        run = subprocess.run([sys.executable, "-c", reader], input=pickle.dumps(formula), env=environment, check=False)
        assert run.returncode == 0


@pytest.mark.parametrize(
    "function",
    [
        lambda x: np.arctan2(np.sin(x), 2.0 + np.cos(x)),
        lambda x: np.arcsin(0.3 * np.sin(x)) - np.arccos(0.2 * x),
        lambda x: (x**2 + 1.0) ** 0.5 / (3.0 - x) + 2.0**x - abs(-x),
        lambda x: np.hypot(x, 1.0 - x) * np.tanh(x) - np.log(2.0 + x) * np.exp(-x),
        lambda x: np.square(np.radians(30.0 * x)) + np.reciprocal(1.0 + x) - np.maximum(x, 0.4) + np.tan(x / 3),
        lambda x: np.float64(0.7) * x - np.array(0.1) / (1 + x),
    ],
)
def test_traced_functions_have_their_values(function: object) -> None:
    [formula] = traced(function).values()  # type: ignore[arg-type]
    assert isinstance(formula, Formula)
    x = np.linspace(0.05, 0.95, 19)
    expected = [float(function(float(at))) for at in x]  # type: ignore[operator]
    assert evaluate(formula, {"x": x}, NUMPY) == pytest.approx(expected, rel=1e-14)
    assert read(str(formula)).names() == {"x"}


@pytest.mark.parametrize(
    ("function", "message"),
    [
        (lambda x: x or 0.0, "asks for the truth"),
        (lambda x: 1.0 if x < 2.0 else 0.0, "compares a value"),
        (lambda x: __import__("math").sin(x), "functions of `math`"),
        (np.floor, "numpy.floor"),
        (lambda x: x * np.arange(3.0), r"computes with \[0.0, 1.0, 2.0\]"),
        (lambda x: x / 0.0, "divides by 0"),
        (lambda x: x + "a", "computes with 'a'"),
        (lambda x: x.real, "real"),
        (range, "plain number"),
    ],
)
def test_functions_that_are_no_formula_are_refused(function: object, message: str) -> None:
    with pytest.raises(InputError, match=f"cannot be written down as a formula: .*{message}"):
        traced(function)  # type: ignore[arg-type]


def test_names_of_coordinates() -> None:
    assert list(traced(lambda x: [x, 2.0])) == ["q1", "q2"]
    assert list(traced(lambda y: {"ram": y}, "y")) == ["ram"]
    assert Table(Name("x"), (0.0, 1.0), (1.0, 2.0)) == read("table(x, 0:1, 1:2)")
