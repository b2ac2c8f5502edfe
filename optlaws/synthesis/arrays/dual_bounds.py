"""Bounds that contacts and multipliers prove of many objectives at once, as certificates do, rounded outward."""

from __future__ import annotations

from dataclasses import replace
from math import ceil, log

import numpy as np

from optlaws.numbers import Array
from optlaws.synthesis.arrays.newton_steps import States, Structure
from optlaws.synthesis.arrays.programs import Numbers, Path
from optlaws.synthesis.program.writer import Model
from optlaws.synthesis.proof.duality import AprioriBounds, bounds_within, charge, roundings, weighted
from optlaws.synthesis.proof.sublevel_bounds import Sublevel

#: claims are taken from a geometric row, upward: what is known of laws below them is known of all before
_CLAIMS, _ABOVE = 1.01, 1.0 + 2.0**-40


def lower_bounds(path: Path, structure: Structure, numbers: Numbers, states: States, value: Array) -> Array:
    """Lower bounds of the objectives; negative multipliers count as zero.

    Parameters
    ----------
    path, structure, numbers, states
        The laws' programs and their states; one state may stand for all, if its contacts and multipliers are theirs
        and their costs are one.
    value
        The rows of the contacts, less the right sides' variables, shape (laws, contacts, variables + 1).
    """
    program = path.model.program
    weights, equations = np.maximum(states.weights, 0.0), states.equations
    cost = numbers.cost[: len(states)]
    rows = value[:, :, :-1]
    slope = cost + weighted(weights, rows) + equations @ program.equalities
    right = value[:, :, -1] - numbers.bounds[:, structure.family]
    plain = (weights * right).sum(axis=1) - (equations * numbers.right).sum(axis=1)
    count = roundings(structure.count + len(program.equalities))
    sizes = np.abs(equations)
    blur = weighted(weights, np.abs(rows)) + sizes @ np.abs(program.equalities) + np.abs(cost)
    unseen = structure.rounding_errors(states.x, states.u, weights)
    blur = count * blur + unseen[:, :-1]
    hidden = (weights * np.abs(right)).sum(axis=1) + (sizes * np.abs(numbers.right)).sum(axis=1)
    hidden = count * hidden + unseen[:, -1]
    claim = path.model.unit * float(plain.max(initial=0.0))
    return np.asarray(path.model.unit * (plain - hidden - charge(path.model, _below(path, claim), slope, blur)))


def _below(path: Path, claim: float) -> AprioriBounds:
    """Bounds of constants in laws of the path below the claim, or below one slightly above it."""
    step = ceil(log(claim) / log(_CLAIMS)) if claim > 0.0 else None
    if step not in path.bounds_below_claim:
        greatest: dict[str, float] = {}
        for problem in path.problems:
            model: Model = replace(path.model, problem=problem)
            most = 0.0 if step is None else _CLAIMS**step * _ABOVE
            for name, value in Sublevel.of(model).greatest_values(most).items():
                greatest[name] = max(greatest.get(name, 0.0), value)
        path.bounds_below_claim[step] = bounds_within(path.model, greatest)
    below: AprioriBounds = path.bounds_below_claim[step]
    return below
