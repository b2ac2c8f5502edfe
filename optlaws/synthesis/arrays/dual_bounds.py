"""Bounds that contacts and multipliers prove of many objectives at once, as certificates do, rounded outward."""

from __future__ import annotations

from dataclasses import replace
from math import ceil, inf, log

import numpy as np

from optlaws.numbers import Array
from optlaws.synthesis.arrays.newton_steps import States, Structure, weighted
from optlaws.synthesis.arrays.programs import Numbers, Path
from optlaws.synthesis.families.family import LinearFamily
from optlaws.synthesis.program.writer import Model
from optlaws.synthesis.proof.duality import product_with_rest
from optlaws.synthesis.proof.sublevel_bounds import Sublevel, moments
from optlaws.tolerances import ROUNDOFF

_SQUARED_SUMS = 2.0**-20  # of the roundings in a row: what sums of many are off by beyond them

#: roundings in a row before it is weighted, as certificates count them, and what sums are off by beyond
_IN_A_ROW = 9
#: claims are taken from a geometric row, upward: what is known of laws below them is known of all before
_CLAIMS, _ABOVE = 1.01, 1.0 + 2.0**-40

AprioriBounds = tuple[dict[str, float], dict[str, float], list[tuple[Array, Array]]]


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
    count = ROUNDOFF * (_IN_A_ROW + structure.count + len(program.equalities) + 2)
    sizes = np.abs(equations)
    blur = weighted(weights, np.abs(rows)) + sizes @ np.abs(program.equalities) + np.abs(cost)
    unseen = structure.rounding_errors(states.x, states.u, weights)
    blur = count * blur + unseen[:, :-1]
    hidden = (weights * np.abs(right)).sum(axis=1) + (sizes * np.abs(numbers.right)).sum(axis=1)
    hidden = count * hidden + unseen[:, -1]
    claim = path.model.unit * float(plain.max(initial=0.0))
    return np.asarray(
        path.model.unit * (plain - hidden - rounding_charge(path.model, _below(path, claim), slope, blur))
    )


def sharp_bounds(path: Path, structure: Structure, numbers: Numbers, states: States) -> Array:
    """Lower bounds of programs with affine rows, whose sums are rounded once: less is lost with great multipliers."""
    program = path.model.program
    rows = _with_right_sides(structure, numbers, states)
    sides = np.broadcast_to(program.equalities, (len(rows), *program.equalities.shape))
    every = np.concatenate([rows, np.concatenate([sides, -numbers.right[:, :, None]], axis=2)], axis=1)
    both = np.concatenate([np.maximum(states.weights, 0.0), states.equations], axis=1)
    slope, blur, value, hidden = sharp_sums(path.model, numbers.cost, both, every, np.abs(every))
    plain = value - hidden
    claim = path.model.unit * float(plain.max(initial=0.0))
    return np.asarray(path.model.unit * (plain - rounding_charge(path.model, _below(path, claim), slope, blur)))


def sharp_sums(
    model: Model, cost: Array, multipliers: Array, rows: Array, sizes: Array
) -> tuple[Array, Array, Array, Array]:
    """Sums of the cost and the weighted rows of many laws as slopes and values, each with its rounding bound.

    Parameters
    ----------
    model, cost
        The program, and what is minimised in each law.
    multipliers, rows
        Of all rows, with the opposites of their right sides last, and of the equations.
    sizes
        How great the rows' entries may be.
    """
    places = list(model.places.values())
    total = sums_of_rows(np.concatenate([cost, np.zeros((len(cost), 1))], axis=1), multipliers, rows)
    hidden = ROUNDOFF * (_IN_A_ROW + _SQUARED_SUMS) * weighted(np.abs(multipliers), sizes)
    # the entries of the variables are exact, and so is a sum that is zero
    slope, blur = total[:, :-1], hidden[:, :-1]
    blur[:, places] = 0.0
    slope[:, places] = np.where(slope[:, places] == 0.0, 0.0, np.nextafter(slope[:, places], -inf))
    return slope, blur, total[:, -1], hidden[:, -1]


def _with_right_sides(structure: Structure, numbers: Numbers, states: States) -> Array:
    """The rows of the contacts with the opposites of their right sides."""
    laws, size = states.x.shape
    rows = np.zeros((laws, structure.count, size + 1))
    for i, (family, contacts) in enumerate(zip(structure.model.program.families, structure.of_families, strict=True)):
        u = states.u[:, contacts]
        if u.size and isinstance(family, LinearFamily):
            rows[:, contacts] = family.columns(u.reshape(-1))[0].reshape(*u.shape, size + 1)
            rows[:, contacts] *= structure.sign[contacts, None]
            rows[:, contacts, :-1] -= family.slack
            rows[:, contacts, -1] -= numbers.bounds[:, i, None]
    return rows


def rounding_charge(model: Model, below: AprioriBounds, slope: Array, blur: Array) -> Array:
    """The greatest effect of rounding in the slopes on the bound, for laws with known a priori bounds."""
    greatest, least, sizes = below
    terms, beyond = model.space.terms, np.zeros(len(slope))
    for name, place in model.places.items():
        share, low = slope[:, place], least.get(name, 0.0)
        beyond += np.maximum(blur[:, place] - share, 0.0) * greatest.get(name, inf)
        beyond += np.maximum(share + blur[:, place], 0.0) * -low if low < 0.0 else 0.0
    reaches = [
        (np.abs(slope[:, :terms] @ extension.T) + blur[:, :terms] @ np.abs(extension).T) @ most
        for most, extension in sizes
    ]
    return np.asarray(beyond + (np.min(reaches, axis=0) if reaches else inf))


def bounds_below(model: Model, greatest: dict[str, float]) -> AprioriBounds:
    """A priori bounds of the variables, above and below, and of the coordinates, where constants are known above."""
    scales = model.in_scales
    least = Sublevel.of(model).least_values()
    return scales(greatest), scales(least), moments(model, greatest)


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
        path.bounds_below_claim[step] = bounds_below(path.model, greatest)
    below: AprioriBounds = path.bounds_below_claim[step]
    return below


def sums_of_rows(start: Array, weights: Array, rows: Array) -> Array:
    """Sums of a start and each law's weighted rows, rounded only once up to second-order errors.

    Parameters
    ----------
    start
        To which they are added, shape (laws, numbers) or one for all.
    weights, rows
        Shapes (laws, rows) and (laws, rows, numbers), or rows that are those of all laws.

    Examples
    --------
    >>> sums_of_rows(np.array([1.0]), np.array([[1e17, -1e17]]), np.array([[1.0], [1.0]])).tolist()
    [[1.0]]
    """
    total = np.broadcast_to(start, (len(weights), rows.shape[-1])).copy()
    rest = np.zeros_like(total)
    for i, weight in enumerate(weights.T):
        product, beside = product_with_rest(weight[:, None], rows[..., i, :])
        further = total + product
        moved = further - total
        rest += beside + ((total - (further - moved)) + (product - moved))
        total = further
    return np.asarray(total + rest)
