"""What the certificates of many laws prove along B, as arrays: the lines of `lower_line`, many at once."""

from __future__ import annotations

from math import inf

import numpy as np
from numpy.typing import NDArray

from optlaws.synthesis.arrays.judging.sums import sums_of_rows
from optlaws.synthesis.arrays.rows import weighted
from optlaws.synthesis.families.family import LinearFamily
from optlaws.synthesis.program.writer import Model, model_of
from optlaws.synthesis.proof.sublevel_bounds import greatest_values, least_values, moments
from optlaws.synthesis.proven.running import RunningNumber
from optlaws.synthesis.solved_parts import Part

Array = NDArray[np.float64]

_UNIT = 2.0**-53
#: roundings in a row before it is weighted, as certificates count them, and what sums are off by beyond
_IN_A_ROW, _SQUARES = 9, 2.0**-20


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
    if number.name != "B" or not all(isinstance(family, LinearFamily) for family in families):
        return None
    model = model_of(number.at(ends[1]))
    both = np.concatenate([np.maximum(part.found.multiplier, 0.0), part.found.equations], axis=1)
    every = _rows(part, model, values - ends[1])
    total = sums_of_rows(np.append(model.program.objective, 0.0), both, every)
    # nowhere between the ends is a right side greater
    sizes = np.abs(every)
    sizes[:, part.found.u.shape[1] :, -1] = np.maximum(
        sizes[:, part.found.u.shape[1] :, -1], np.abs(model.program.right)
    )
    hidden = _UNIT * (_IN_A_ROW + _SQUARES) * weighted(np.abs(both), sizes)
    # the entries of the variables are exact, and so is a sum that is zero
    slope, places = total[:, :-1], list(model.places.values())
    hidden[:, places] = 0.0
    slope[:, places] = np.where(slope[:, places] == 0.0, 0.0, np.nextafter(slope[:, places], -inf))
    plain, rise = total[:, -1], -part.found.equations[:, 0]
    claim = max(float((plain + rise * (end - values)).max()) for end in ends)
    charge = _charges(model, model.unit * claim, slope, hidden[:, :-1])
    return model.unit * np.column_stack([plain - hidden[:, -1] - charge, rise])


def _rows(part: Part, model: Model, further: Array) -> Array:
    """The rows of the contacts and of the equations, with the opposites of their right sides; of no contact 0."""
    laws, contacts, size = part.found, part.found.u.shape[1], part.model.program.size
    rows = np.zeros((len(further), contacts + len(model.program.right), size + 1))
    for i, family in enumerate(part.model.program.families):
        law, place = np.nonzero(laws.family == i)
        if len(law) and isinstance(family, LinearFamily):
            u = np.clip(laws.u[law, place], *family.domain)
            rows[law, place, :-1], right = family.rows(u, laws.sign[law, place])
            rows[law, place, -1] = -right
    rows[:, contacts:, :-1], rows[:, contacts:, -1] = model.program.equalities, -model.program.right
    # of the equations the first alone has B on its right side, and there B itself
    rows[:, contacts, -1] -= further
    return rows


def _charges(model: Model, claim: float, slope: Array, blur: Array) -> Array:
    """Most that each slope can be worth in laws of the model up to the claim, wherever it is within its blur."""
    known = greatest_values(model, max(claim, 0.0))
    greatest, least = model.in_scales(known), model.in_scales(least_values(model.problem, model.space))
    terms, beyond = model.space.terms, np.zeros(len(slope))
    for name, place in model.places.items():
        own, low = slope[:, place], least.get(name, 0.0)
        beyond += np.maximum(blur[:, place] - own, 0.0) * greatest.get(name, inf)
        beyond += np.maximum(blur[:, place] + own, 0.0) * -low if low < 0.0 else 0.0
    reaches = [
        (np.abs(slope[:, :terms] @ extension.T) + blur[:, :terms] @ np.abs(extension).T) @ most
        for most, extension in moments(model, known)
    ]
    return np.asarray(beyond + (np.min(reaches, axis=0) if reaches else inf))
