"""Equal parts of a formula are computed once, and functions of Python become formulas."""

import os
import pickle
import subprocess
import sys

import numpy as np
import pytest

from optlaws import InputError
from tests.internals.formulas import NUMPY, Formula, Name, Table, Traced, derivative, evaluate, read, traced


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
    for i, text in enumerate(texts):
        for j, other in enumerate(texts):
            assert (read(text) == read(other)) == (i == j)
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
