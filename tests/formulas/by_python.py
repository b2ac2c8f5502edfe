"""Formulas by Python's own grammar: of texts that the tests themselves wrote."""

import ast
import re
from functools import reduce
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

_FUNCTIONS: dict[str, Any] = {
    **{name: getattr(np, name) for name in ("sin", "cos", "tan", "tanh", "exp", "log", "sqrt", "pi", "abs")},
    "atan": np.arctan,
    "max": lambda *parts: reduce(np.maximum, parts),
    "min": lambda *parts: reduce(np.minimum, parts),
    "norm": lambda *parts: reduce(np.hypot, parts),
    "table": lambda x, *pairs: np.interp(x, np.array(pairs)[:, 0], np.array(pairs)[:, 1]),
    "spline": lambda x, *pairs: CubicSpline(np.array(pairs)[:, 0], np.array(pairs)[:, 1])(x),
}


def by_python(text: str, values: dict[str, Any]) -> Any:
    """The value of a formula, with pairs x:y as tuples."""
    number = r"-?[\d.]+(?:e-?\d+)?"
    python = re.sub(rf"({number}):({number})", r"(\1, \2)", text).replace("^", "**")
    code = compile(ast.parse(python, mode="eval"), "formula", "eval")
    return eval(code, {"__builtins__": {}}, {**_FUNCTIONS, **values})  # noqa: S307
