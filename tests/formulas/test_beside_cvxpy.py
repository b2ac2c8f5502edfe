"""Beside cvxpy: what its rules say of random formulas, and the least values that it finds on grids."""

import ast
import warnings
from collections import Counter
from collections.abc import Callable, Iterator
from random import Random
from types import SimpleNamespace
from typing import Any

import cvxpy as cp
import numpy as np
import pytest

from optlaws import Chebyshev, PolynomialLaw, Problem, synthesize
from tests.formulas.trees import convex_text
from tests.internals.formulas import NUMPY, Judge, evaluate, read
from tests.internals.synthesis import space_of
from tests.sampling import sampled
from tests.synthesis.judge import Judged

RULES = Judge(frozenset("bc"))


@pytest.fixture(autouse=True)
def quiet() -> Iterator[None]:
    """It warns of much."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        yield


def by_cvxpy(written: str) -> str:
    """The curvature that cvxpy tells of the same text, which this file wrote."""
    functions: dict[str, Any] = {
        "exp": cp.exp,
        "abs": cp.abs,
        "sqrt": cp.sqrt,
        "log": cp.log,
        "max": cp.maximum,
        "min": cp.minimum,
        "norm": lambda x, y: cp.norm(cp.hstack([x, y])),
        "b": cp.Variable(),
        "c": cp.Variable(),
        "Number": cp.Constant,
    }

    def power(base: Any, exponent: int) -> Any:
        return cp.power(base, exponent)

    functions["power"] = power

    class Powers(ast.NodeTransformer):
        def visit_BinOp(self, node: ast.BinOp) -> ast.AST:
            self.generic_visit(node)
            if isinstance(node.op, ast.Pow):
                return ast.Call(ast.Name("power", ast.Load()), [node.left, node.right], [])
            if isinstance(node.op, ast.Div):
                return ast.Call(ast.Name("power", ast.Load()), [node.right, ast.Constant(-1)], [])
            return node

        def visit_Constant(self, node: ast.Constant) -> ast.AST:
            return ast.Call(ast.Name("Number", ast.Load()), [node], [])

    tree = ast.fix_missing_locations(Powers().visit(ast.parse(written.replace("^", "**"), mode="eval")))
    expression = eval(compile(tree, "formula", "eval"), {"__builtins__": {}}, functions)  # noqa: S307
    known = {"CONSTANT", "AFFINE", "CONVEX", "CONCAVE"}
    return str(expression.curvature) if expression.curvature in known else "UNKNOWN"


def compared(seed: int, count: int) -> Counter[tuple[str, str]]:
    """How often we and cvxpy say what; whatever it knows we know, and what we alone know is so."""
    table: Counter[tuple[str, str]] = Counter()
    numbers = Random(seed)  # noqa: S311
    for _ in range(count):
        written = convex_text(numbers, 3)
        ours = RULES.by_rules(read(written)).curvature.name
        theirs = by_cvxpy(written)
        table[ours, theirs] += 1
        if theirs != "UNKNOWN":
            # what cancels to an affine formula or to nothing we may say too
            assert ours in {theirs, "AFFINE", "CONSTANT"}, f"{written}: we say {ours}, cvxpy {theirs}"
        elif ours != "UNKNOWN":
            assert bends(written, 1.0 if ours == "CONVEX" else -1.0), f"we say that {written} is {ours}"
    return table


def bends(written: str, sign: float) -> bool:
    """Whether a formula is nowhere above, with this sign, the middle between two of its values."""
    numbers = np.random.default_rng(0)
    ends = numbers.normal(size=(2, 2, 500)) * numbers.choice([0.3, 2.0, 8.0], size=500)
    with np.errstate(all="ignore"):
        first, last, middle = (
            sign * np.broadcast_to(evaluate(read(written), {"b": at[0], "c": at[1]}, NUMPY), 500)
            for at in (ends[0], ends[1], ends.mean(axis=0))
        )
        bend = (first + last) / 2.0 - middle
        size = 1e-9 * (1.0 + np.abs(first) + np.abs(last) + np.abs(middle))
    known = np.isfinite(bend) & np.isfinite(size)
    return bool((bend >= -size)[known].all())


def test_whatever_cvxpy_knows_we_know() -> None:
    assert compared(1, 60).total() == 60


@pytest.mark.long
def test_whatever_cvxpy_knows_we_know_of_ten_thousand() -> None:
    table = compared(2, 10_000)
    assert table.total() == 10_000
    assert table["CONVEX", "CONVEX"] + table["CONCAVE", "CONCAVE"] > 2_000


#: texts, and what they are of a motion for cvxpy: of k, the weights w of a mean, a, b and c
OPTIMA: dict[str, Callable[[SimpleNamespace], Any]] = {
    "peak(c + 0.2*b)": lambda m: cp.max(cp.abs(m.c + 0.2 * m.b)),
    "peak((1 + k)*c, side=high)": lambda m: cp.max(cp.multiply(1 + m.k, m.c)),
    "peak(norm(c, 3*b))": lambda m: cp.max(cp.norm(cp.vstack([m.c, 3 * m.b]), 2, axis=0)),
    "peak(abs(c) + 2*abs(b))": lambda m: cp.max(cp.abs(m.c) + 2 * cp.abs(m.b)),
    "peak(exp(c/5), side=high)": lambda m: cp.max(cp.exp(m.c / 5)),
    "peak(max(c, 2*b - a), side=high)": lambda m: cp.max(cp.maximum(m.c, 2 * m.b - m.a)),
    "integral(c^2 + (1 + k)*b^2)": lambda m: m.w @ (cp.square(m.c) + cp.multiply(1 + m.k, cp.square(m.b))),
    "rms(c^2 + b^2)": lambda m: _rms(m, cp.square(m.c) + cp.square(m.b)),
    "rms((1 + k)*c + 3*b)": lambda m: _rms(m, cp.multiply(1 + m.k, m.c) + 3 * m.b),
    "max(peak(c + 3*b), 2*rms(c)) + 0.5*integral(b^2)": lambda m: (
        cp.maximum(cp.max(cp.abs(m.c + 3 * m.b)), 2 * _rms(m, m.c)) + 0.5 * m.w @ cp.square(m.b)
    ),
}


def _rms(motion: SimpleNamespace, of: Any) -> Any:
    return cp.norm(cp.multiply(np.sqrt(motion.w), of))


@pytest.mark.parametrize("text", sampled(OPTIMA, 2))
def test_least_values_are_those_of_cvxpy_on_a_grid_and_never_beaten(text: str) -> None:
    problem = Problem(B=1.8, order=4, basis=Chebyshev(7), minimise=text, symmetric=True)
    solution = synthesize(problem)
    assert solution.status.value == "optimal"
    space = space_of(problem.basis, problem.conditions, symmetric=True)
    x, weights = np.polynomial.legendre.leggauss(160)
    k, weights = (1.0 + x) / 2.0, weights / 2.0
    half = [space.columns(nu, np.abs(1.0 - 2.0 * k)) for nu in (0, 1, 2)]
    later = np.where(k > 0.5, -1.0, 1.0)[:, None]
    half[0], half[2] = half[0] * later, half[2] * later
    half[0][k > 0.5, -1] += 1.0
    z = cp.Variable(space.terms)
    a, b, c = (columns[:, :-1] @ z + columns[:, -1] for columns in half)
    middle = space.row(1, 0.5)
    kept = [middle[:-1] @ z + middle[-1] == 1.8, cp.abs(b) <= 1.8]
    theirs = cp.Problem(cp.Minimize(OPTIMA[text](SimpleNamespace(k=k, w=weights, a=a, b=b, c=c))), kept)
    least = float(theirs.solve(solver="CLARABEL"))
    # the grid asks less than the whole interval does, and hardly less
    assert least <= solution.objective * (1.0 + 1e-6)
    assert solution.objective <= least * (1.0 + 2e-3)
    law = space.law(np.asarray(z.value))
    assert isinstance(law, PolynomialLaw)
    worth = Judged(law).worth(problem.objective)
    over = max(law.constants.B.value / 1.8 - 1.0, 0.0)
    assert solution.lower_bound <= worth * (1.0 + 1e-6 + 10.0 * over)
