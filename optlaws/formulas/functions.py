"""The smooth functions that formulas may have: all that arithmetics, ranges and rules of convexity know of them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np


@dataclass(frozen=True)
class SmoothFunction:
    """A function of one number that is smooth wherever it has a value.

    Attributes
    ----------
    numpy
        Its values on arrays; CasADi and balls have it under its name.
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
