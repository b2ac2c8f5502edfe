"""What the certificates of many laws prove along B, as arrays: the lines of `lower_line`, many at once."""

from __future__ import annotations

from math import inf

import numpy as np
from numpy.typing import NDArray

from optlaws.synthesis.families.family import LinearFamily
from optlaws.synthesis.program.writer import Model, model_of
from optlaws.synthesis.proof.below_claim import greatest_values, least_values, moments
from optlaws.synthesis.proven.running import RunningNumber
from optlaws.synthesis.solved_parts import Part

Array = NDArray[np.float64]

_UNIT = 2.0**-53
#: roundings in a row before it is weighted, as certificates count them, and in the sum beside one for each term
_IN_A_ROW, _IN_THE_SUM = 9, 4


def lower_lines(part: Part, values: Array, number: RunningNumber, ends: tuple[float, float]) -> Array | None:
    """Value and slope of what the certificates of a part prove between the ends; None where a row is not linear.

    Parameters
    ----------
    part, values
        Laws that were found together, and the B of each.
    number, ends
        B, and between which values.
    """
    families = part.model.program.families
    if number.name != "B" or not all(isinstance(one, LinearFamily) for one in families):
        return None
    model = model_of(number.at(ends[1]))
    weights, equations = np.maximum(part.found.multiplier, 0.0), part.found.equations
    rows, bounds = _rows(part)
    # of the equations the first alone has B on its right side, and there B itself
    right = np.tile(model.program.right, (len(values), 1))
    right[:, 0] += values - ends[1]
    sides = np.abs(model.program.equalities)
    count = _UNIT * (_IN_A_ROW + _IN_THE_SUM + weights.shape[1] + len(sides))
    slope = model.program.objective + _weighted(weights, rows) + equations @ model.program.equalities
    blur = count * (np.abs(model.program.objective) + _weighted(weights, np.abs(rows)) + np.abs(equations) @ sides)
    plain = -(weights * bounds).sum(axis=1) - (equations * right).sum(axis=1)
    widest = np.maximum(np.abs(right), np.abs(model.program.right))
    hidden = count * ((weights * np.abs(bounds)).sum(axis=1) + (np.abs(equations) * widest).sum(axis=1))
    rise = -equations[:, 0]
    claim = max(float((plain + rise * (end - values)).max()) for end in ends)
    charge = _charges(model, model.unit * claim, slope, blur)
    return model.unit * np.column_stack([plain - hidden - charge, rise])


def _rows(part: Part) -> tuple[Array, Array]:
    """The rows of the contacts of each law, and their right sides; those of no contact are 0."""
    found, size = part.found, part.model.program.size
    rows, bounds = np.zeros((*found.u.shape, size)), np.zeros(found.u.shape)
    for i, family in enumerate(part.model.program.families):
        own = found.family == i
        if own.any() and isinstance(family, LinearFamily):
            rows[own], bounds[own] = family.rows(np.clip(found.u[own], *family.domain), found.sign[own])
    return rows, bounds


def _weighted(weights: Array, rows: Array) -> Array:
    return np.asarray(np.matmul(weights[:, None, :], rows)[:, 0])


def _charges(model: Model, claim: float, slope: Array, blur: Array) -> Array:
    """Most that each slope can be worth in laws of the model up to the claim, wherever it is within its blur."""
    greatest, least = greatest_values(model, max(claim, 0.0)), least_values(model.problem, model.space)
    terms, beyond = model.space.terms, np.zeros(len(slope))
    for name, place in model.places.items():
        own, low = slope[:, place], least.get(name, 0.0)
        beyond += np.maximum(blur[:, place] - own, 0.0) * greatest.get(name, inf)
        beyond += np.maximum(blur[:, place] + own, 0.0) * -low if low < 0.0 else 0.0
    reaches = [
        (np.abs(slope[:, :terms] @ extension.T) + blur[:, :terms] @ np.abs(extension).T) @ most
        for most, extension in moments(model, greatest)
    ]
    return np.asarray(beyond + (np.min(reaches, axis=0) if reaches else inf))
