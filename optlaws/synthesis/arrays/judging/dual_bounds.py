"""What contacts and multipliers prove of many objectives at once, as certificates reckon it, rounded outward."""

from __future__ import annotations

from dataclasses import replace
from math import ceil, inf, log

import numpy as np
from numpy.typing import NDArray

from optlaws.synthesis.arrays.judging.sums import sums_of_rows
from optlaws.synthesis.arrays.newton_steps import States
from optlaws.synthesis.arrays.programs import Numbers, Path
from optlaws.synthesis.arrays.rows import Structure, weighted
from optlaws.synthesis.families.family import LinearFamily
from optlaws.synthesis.program.writer import Model
from optlaws.synthesis.proof.below_claim import greatest_values, least_values, moments

Array = NDArray[np.float64]

_UNIT = 2.0**-53
#: roundings in a row before it is weighted, as certificates count them, and what sums are off by beyond
_IN_A_ROW, _SQUARES = 9, 2.0**-20
#: claims are taken from a geometric row, upward: what is known of laws below them is known of all before
_CLAIMS, _ABOVE = 1.01, 1.0 + 2.0**-40

_Below = tuple[dict[str, float], dict[str, float], list[tuple[Array, Array]]]


def lower_bounds(path: Path, structure: Structure, numbers: Numbers, states: States, value: Array) -> Array:
    """What no law of each problem is below; negative multipliers count as zero.

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
    count = _UNIT * (_IN_A_ROW + structure.count + len(program.equalities) + 2)
    sizes = np.abs(equations)
    blur = weighted(weights, np.abs(rows)) + sizes @ np.abs(program.equalities) + np.abs(cost)
    unseen = structure.rounding_errors(states.x, states.u, weights)
    blur = count * blur + unseen[:, :-1]
    hidden = (weights * np.abs(right)).sum(axis=1) + (sizes * np.abs(numbers.right)).sum(axis=1)
    hidden = count * hidden + unseen[:, -1]
    claim = path.model.unit * float(plain.max(initial=0.0))
    return np.asarray(path.model.unit * (plain - hidden - _charge(path, slope, blur, claim)))


def sharp_bounds(path: Path, structure: Structure, numbers: Numbers, states: States) -> Array:
    """The same of programs of affine rows, whose sums are rounded once: less is lost where multipliers are great."""
    program, places = path.model.program, list(path.model.places.values())
    weights = np.maximum(states.weights, 0.0)
    rows = _with_right_sides(structure, numbers, states)
    sides = np.broadcast_to(program.equalities, (len(rows), *program.equalities.shape))
    every = np.concatenate([rows, np.concatenate([sides, -numbers.right[:, :, None]], axis=2)], axis=1)
    both = np.concatenate([weights, states.equations], axis=1)
    total = sums_of_rows(np.concatenate([numbers.cost, np.zeros((len(rows), 1))], axis=1), both, every)
    hidden = _UNIT * (_IN_A_ROW + _SQUARES) * weighted(np.abs(both), np.abs(every))
    # the entries of the variables are exact, and so is a sum that is zero
    slope, blur = total[:, :-1], hidden[:, :-1]
    blur[:, places] = 0.0
    slope[:, places] = np.where(slope[:, places] == 0.0, 0.0, np.nextafter(slope[:, places], -inf))
    plain = total[:, -1] - hidden[:, -1]
    claim = path.model.unit * float(plain.max(initial=0.0))
    return np.asarray(path.model.unit * (plain - _charge(path, slope, blur, claim)))


def _with_right_sides(structure: Structure, numbers: Numbers, states: States) -> Array:
    """The rows of the contacts with the opposites of their right sides."""
    laws, size = states.x.shape
    rows = np.zeros((laws, structure.count, size + 1))
    for i, (family, own) in enumerate(zip(structure.model.program.families, structure.of_families, strict=True)):
        u = states.u[:, own]
        if u.size and isinstance(family, LinearFamily):
            rows[:, own] = family.columns(u.reshape(-1))[0].reshape(*u.shape, size + 1)
            rows[:, own] *= structure.sign[own, None]
            rows[:, own, :-1] -= family.slack
            rows[:, own, -1] -= numbers.bounds[:, i, None]
    return rows


def _charge(path: Path, slope: Array, blur: Array, claim: float) -> Array:
    """Most that the slope can be worth in laws up to the claim, as a certificate charges it, for each law."""
    greatest, least, sizes = _below(path, claim)
    terms, beyond = path.model.space.terms, np.zeros(len(slope))
    for name, place in path.model.places.items():
        own = slope[:, place]
        down = np.maximum(blur[:, place] - own, 0.0) * greatest.get(name, inf)
        low = least.get(name, 0.0)
        up = np.maximum(own + blur[:, place], 0.0) * max(-low, 0.0) if low < 0.0 else 0.0
        beyond += down + up
    reaches = [
        (np.abs(slope[:, :terms] @ extension.T) + blur[:, :terms] @ np.abs(extension).T) @ most
        for most, extension in sizes
    ]
    return beyond + (np.min(reaches, axis=0) if reaches else inf)


def _below(path: Path, claim: float) -> _Below:
    """What is known of laws of the path below the claim, or one that is a little above it."""
    step = ceil(log(claim) / log(_CLAIMS)) if claim > 0.0 else None
    if step not in path.kept:
        greatest: dict[str, float] = {}
        for problem in path.problems:
            model: Model = replace(path.model, problem=problem)
            for name, value in greatest_values(model, 0.0 if step is None else _CLAIMS**step * _ABOVE).items():
                greatest[name] = max(greatest.get(name, 0.0), value)
        least = least_values(path.model.problem, path.model.space)
        scales = path.model.in_scales
        path.kept[step] = (scales(greatest), scales(least), moments(path.model, greatest))
    below: _Below = path.kept[step]
    return below
