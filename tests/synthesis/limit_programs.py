"""Independent programs whose optima approach the limits from above: steps of jerk and straight velocities."""

from math import inf, sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linprog, minimize
from scipy.sparse import coo_array

Array = NDArray[np.float64]


def least_by_steps(
    constant: str, B: float, cells: int, *, monotone: bool, order: int = 3, J: float | None = None
) -> float:
    """Least J, or C at given J, of laws with constant jerk on equal cells: a linear program, symmetric or not.

    Variables are c and b at the nodes and the constant. b <= B (and b >= 0) is asked of the Bernstein coefficients
    of b on each cell, so the answer belongs to a law: it can only be above the limit.
    """
    n, h = cells + 1, 1.0 / cells
    last = 2 * n
    rows: list[tuple[list[int], list[float], float, bool]] = []  # columns, coefficients, right side, equality
    for i in range(cells):
        c0, c1, b0, b1 = i, i + 1, n + i, n + i + 1
        rows.append(([b1, b0, c0, c1], [1.0, -1.0, -h / 2, -h / 2], 0.0, True))
        rows.append(([b0, c0], [1.0, h / 2], B, False))
        if monotone:
            rows.append(([b0, c0], [-1.0, -h / 2], 0.0, False))
        for sign in (1.0, -1.0):
            if constant == "J":
                rows.append(([c1, c0, last], [sign / h, -sign / h, -1.0], 0.0, False))
            else:
                assert J is not None
                rows.append(([c1, c0], [sign / h, -sign / h], J, False))
    if constant == "C":
        rows += [([i, last], [sign, -1.0], 0.0, False) for i in range(n) for sign in (1.0, -1.0)]
    stroke = np.zeros(last + 1)
    for i in range(cells):
        stroke[[n + i, i, i + 1]] += [h, h * h / 3, h * h / 6]
    rows.append((list(range(last)), stroke[:last].tolist(), 1.0, True))
    rows.append(([n + cells // 2], [1.0], B, True))
    bounds: list[tuple[float, float]] = [(-inf, inf)] * n + [(0.0 if monotone else -inf, B)] * n + [(0.0, inf)]
    for node in (n, last - 1):
        bounds[node] = (0.0, 0.0)
    if order > 2:
        bounds[0] = bounds[n - 1] = (0.0, 0.0)

    def table(equality: bool) -> dict[str, Any]:  # noqa: FBT001
        kept = [row for row in rows if row[3] is equality]
        i = np.concatenate([[place] * len(row[0]) for place, row in enumerate(kept)])
        j = np.concatenate([row[0] for row in kept])
        v = np.concatenate([row[1] for row in kept])
        name = "eq" if equality else "ub"
        return {
            f"A_{name}": coo_array((v, (i, j)), (len(kept), last + 1)).tocsr(),
            f"b_{name}": [row[2] for row in kept],
        }

    answer: Any = linprog(
        np.append(np.zeros(last), 1.0), bounds=bounds, method="highs", **table(equality=True), **table(equality=False)
    )
    assert answer.status == 0, answer.message
    return float(answer.fun)


def least_by_velocities(constant: str, B: float, cells: int, *, monotone: bool, start: Array) -> float:
    """Least RMS or D over laws with piecewise linear velocity on [0, 1/2], mirrored: sequential quadratic programs."""
    h = 0.5 / cells
    weights = np.full(cells + 1, h)
    weights[[0, -1]] = h / 2

    def velocity(x: Array) -> Array:
        return np.concatenate([[0.0], x[: cells - 1], [B]])

    def rise(x: Array) -> Array:
        return np.diff(velocity(x)) / h

    def power_room(x: Array) -> Array:
        b, c = velocity(x), rise(x)
        d = np.concatenate([b[:-1] * c, b[1:] * c])
        return np.concatenate([x[-1] - d, x[-1] + d])

    def power_slope(x: Array) -> Array:
        b, c = velocity(x), rise(x)
        full = np.zeros((2, cells, cells + 1))
        i = np.arange(cells)
        full[0, i, i] = c - b[:-1] / h
        full[0, i, i + 1] = b[:-1] / h
        full[1, i, i] = -b[1:] / h
        full[1, i, i + 1] = c + b[1:] / h
        inner = full.reshape(2 * cells, cells + 1)[:, 1:-1]
        ones = np.ones((2 * cells, 1))
        return np.vstack([np.hstack([-inner, ones]), np.hstack([inner, ones])])

    bounds: Any = [(0.0 if monotone else -B, B)] * (cells - 1)
    stroke: Any = {
        "type": "eq",
        "fun": lambda x: weights @ velocity(x) - 0.5,
        "jac": lambda x: np.concatenate([weights[1:-1], np.zeros(len(x) - cells + 1)]),
    }
    solve: Any = minimize
    options: Any = {"maxiter": 300, "ftol": 1e-12}
    if constant == "RMS":
        answer = solve(
            lambda x: 2 * h * float(rise(x) @ rise(x)),
            start,
            jac=lambda x: -4 * np.diff(rise(x)),
            bounds=bounds,
            constraints=[stroke],
            method="SLSQP",
            options=options,
        )
        assert answer.success, answer.message
        value = sqrt(answer.fun)
    else:
        room: Any = {"type": "ineq", "fun": power_room, "jac": power_slope}
        first = np.append(start, 20.0)
        goal = np.eye(cells)[-1]
        answer = solve(
            lambda x: float(x[-1]),
            first,
            jac=lambda _: goal,
            bounds=[*bounds, (0.0, None)],
            constraints=[stroke, room],
            method="SLSQP",
            options=options,
        )
        # not convex, and the method may stall: what counts is the law it stopped at
        b, c = velocity(answer.x), rise(answer.x)
        value = float(max(np.abs(b[:-1] * c).max(), np.abs(b[1:] * c).max()))
        if abs(weights @ velocity(answer.x) - 0.5) > 1e-9 or b.max() > B + 1e-9:
            return inf
    assert abs(weights @ velocity(answer.x) - 0.5) < 1e-9
    return value
