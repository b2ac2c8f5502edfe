"""The sum of weighted rows: what it proves of an objective by weak duality, every rounding counted against it.

What rounding leaves of the sum's dependence on the law is charged, for which laws that contradict the claim must be
bounded.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import fsum, inf

import numpy as np
from numpy.typing import NDArray

from optlaws.synthesis.program.writer import Model
from optlaws.synthesis.proof.below_claim import greatest_values, least_values, moments

Array = NDArray[np.float64]

_FACING = {"C_plus": "C_minus", "C_minus": "C_plus"}
#: roundings in a row before it is weighted, and of the sum
_UNIT = 9 * 2.0**-53
_SPLIT = 2.0**27 + 1.0


def sum_of_rows(model: Model, lines: list[tuple[float, Array, float]], claim: float | None = None) -> float:
    """What the program's objective cannot be below by weighted rows, in laws of an objective up to the claim.

    Parameters
    ----------
    model
        The program, with the problem whose laws are spoken of.
    lines
        Weights, rows and right sides of row . x <= right (weights of at least 0) or row . x = right (of any sign).
    claim
        Without it what the sum itself says.
    """
    total = summed(model, lines)
    return total.value - charge(model, total, model.unit * total.value if claim is None else claim)


@dataclass(frozen=True, eq=False)
class Sum:
    """The sum of weighted rows: its slope, exact in the variables beyond the coordinates, and what rounding hides.

    `value` is rounded down, the slope by each coordinate is off by its `blur` at most.
    """

    slope: Array
    value: float
    blur: Array


def summed(model: Model, lines: list[tuple[float, Array, float]]) -> Sum:
    """The objective and the weighted rows, added up."""
    lines = [line for line in lines if line[0] != 0.0]
    weights = np.array([weight for weight, _, _ in lines])
    rows = np.array([[*row, -right] for _, row, right in lines]).reshape(-1, model.program.size + 1)
    total = _weighted(weights, rows, np.append(model.program.objective, 0.0))
    hidden = _UNIT * (np.abs(weights) @ np.abs(rows))
    slope = total[:-1]
    variables = list(model.places.values())
    # the entries of the variables are exact, and so is a sum that is zero
    slope[variables] = np.where(slope[variables] == 0.0, 0.0, np.nextafter(slope[variables], -inf))
    return Sum(slope, float(total[-1] - hidden[-1]), hidden[: model.space.terms])


def _weighted(weights: Array, rows: Array, start: Array) -> Array:
    """Start + weights . rows, rounded once: the great multipliers of laws at the edge of what exists cancel."""
    products = weights[:, None] * rows
    high, low = _halves(weights[:, None])
    upper, lower = _halves(rows)
    rest = low * lower - (((products - high * upper) - low * upper) - high * lower)
    columns = np.vstack([start[None, :], products, rest])
    # fsum refuses what overflows
    return np.array([fsum(column) for column in columns.T.tolist()]) if np.isfinite(columns).all() else start * np.nan


def _halves(values: Array) -> tuple[Array, Array]:
    """Each value as a sum of two whose products are exact (Dekker 1971)."""
    scaled = _SPLIT * values
    high = scaled - (scaled - values)
    return high, values - high


def charge(model: Model, total: Sum, claim: float) -> float:
    """Most that rounding in the slope can be worth, over all laws that contradict the claim."""
    terms, slope = model.space.terms, total.slope
    known = greatest_values(model, max(claim, 0.0))
    greatest, least = model.in_scales(known), model.in_scales(least_values(model.problem, model.space))
    beyond = 0.0
    for name, place in model.places.items():
        # a positive slope can only help where the constant is at least 0
        if slope[place] < 0.0:
            beyond += -slope[place] * greatest.get(name, inf)
        elif slope[place] > 0.0:
            # of the two one-sided peaks one is at least the other's opposite
            facing = greatest.get(_FACING.get(name, ""), inf)
            beyond += slope[place] * max(min(-least.get(name, 0.0), facing), 0.0)
    reaches = (float(_reach(extension, slope[:terms], total.blur) @ most) for most, extension in moments(model, known))
    return beyond + min(reaches, default=0.0 if not slope[:terms].any() and not total.blur.any() else inf)


def _reach(extension: Array, slope: Array, blur: Array) -> Array:
    """The greatest magnitudes of the slope's weights of moments, wherever it is within its blur."""
    return np.asarray(np.abs(extension @ slope) + np.abs(extension) @ blur)
