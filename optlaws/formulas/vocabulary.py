"""The names that formulas may have: of the motion, and of smooth functions."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

#: orders of the derivatives of the law, by name
ORDERS = {"a": 0, "b": 1, "c": 2, "j": 3}
#: these, the power d = b c and the dimensionless time k
VOCABULARY = ("a", "b", "c", "d", "j", "k")


@dataclass(frozen=True)
class SmoothFunction:
    """A function of one number that is smooth wherever it has a value.

    Attributes
    ----------
    numpy
        Its values on arrays; CasADi, mpmath and balls have it under its name.
    rising
        Whether it rises everywhere.
    curvature
        "convex" or "concave" if it is so everywhere.
    from_zero
        Whether it has values from 0 on alone.
    """

    numpy: Callable[..., Any]
    rising: bool = False
    curvature: Literal["convex", "concave"] | None = None
    from_zero: bool = False


SMOOTH_FUNCTIONS = {
    "sin": SmoothFunction(np.sin),
    "cos": SmoothFunction(np.cos),
    "tan": SmoothFunction(np.tan),
    "atan": SmoothFunction(np.arctan, rising=True),
    "tanh": SmoothFunction(np.tanh, rising=True),
    "exp": SmoothFunction(np.exp, rising=True, curvature="convex"),
    "log": SmoothFunction(np.log, rising=True, curvature="concave", from_zero=True),
    "sqrt": SmoothFunction(np.sqrt, rising=True, curvature="concave", from_zero=True),
}
