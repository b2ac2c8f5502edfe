"""Rows of contacts, and their weighted sum: the bound by weak duality, with every rounding against it.

What rounding leaves of the sum's dependence on the law is charged, for which laws that contradict the claim must be
bounded.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import fsum, inf

import numpy as np

from optlaws.numbers import Array
from optlaws.synthesis.families.cone import ConeFamily
from optlaws.synthesis.families.curved import FormulaFamily
from optlaws.synthesis.families.energy import EnergyFamily
from optlaws.synthesis.families.family import ConstraintFamily, LinearFamily, NormFamily, Program
from optlaws.synthesis.program.writer import Model
from optlaws.synthesis.proof.nodes import Contact, Leaf
from optlaws.synthesis.proof.sublevel_bounds import Sublevel, means_by, moments
from optlaws.tolerances import ROUNDOFF

_WEIGHTED_ROUNDING = 9 * ROUNDOFF  # roundings in a row before it is weighted, and of the sum

#: a multiplier, a row and its right side
Line = tuple[float, Array, float]

_FACING = {"C_plus": "C_minus", "C_minus": "C_plus"}
_SPLIT = 2.0**27 + 1.0
#: from so many positions on that a law passes, they are summed up as bends
_MANY_POSITIONS = 8
_WIDER = 1.001  # than what rounding in sums of reaches could hide


def lines_of(program: Program, leaf: Leaf) -> list[Line]:
    """Contacts and the program's equations as weights, rows and right sides; negative multipliers of contacts are 0."""
    lines = [(max(contact.multiplier, 0.0), *row_of(program, contact)) for contact in leaf.contacts]
    weights = program.multipliers_of_equations(leaf.equations).tolist()
    return [*lines, *zip(weights, program.equalities, program.right.tolist(), strict=False)]


def by_bends(model: Model, lines: list[Line]) -> list[Line]:
    """The lines with equations of many positions as equations of bends between them: exactly the same sum.

    Rows of positions reach back to the start, and their great multipliers cancel; what rounding hides in each does not.
    Bends are local. With the multipliers y of positions at k, that of the first is the sum of y k / k_1, and that of
    the bend at k_(j-1) the sum of y_i (k_i - k_(j-1)) over all i from j on.

    Parameters
    ----------
    model
        The program of the lines.
    lines
        As of `lines_of`, the program's equations last.
    """
    first = len(lines) - len(model.positions)
    known = sorted((*position, i) for i, position in enumerate(model.positions, first) if position is not None)
    places = tuple(k for k, _, _ in known)
    regular = len(set(places)) == len(places) >= _MANY_POSITIONS and first >= 0 and places[0] > 0.0
    rows = model.space.bends(places) if regular else None
    if rows is None:
        return lines
    ends = [Fraction(0), *map(Fraction, places)]
    ways = [Fraction(model.space.boundary.start[0]), *(Fraction(value) for _, value, _ in known)]
    slopes = [(ways[i + 1] - ways[i]) / (ends[i + 1] - ends[i]) for i in range(len(known))]
    wide = model.space.widened(rows, model.program.size)
    turned, weight, moment = list(lines), Fraction(0), Fraction(0)
    for j in range(len(known) - 1, 0, -1):
        place = known[j][2]
        multiplier = Fraction(float(lines[place][0]))
        weight, moment = weight + multiplier, moment + multiplier * ends[j + 1]
        right = float(slopes[j] - slopes[j - 1]) - float(wide[j - 1, -1])
        turned[place] = (float(moment - ends[j] * weight), wide[j - 1, :-1], right)
    place = known[0][2]
    whole = moment + Fraction(float(lines[place][0])) * ends[1]
    turned[place] = (float(whole / ends[1]), *lines[place][1:])
    return turned


def row_of(program: Program, contact: Contact) -> tuple[Array, float]:
    """The row of a contact and its right side: row . x <= right for every law of the problem.

    It is the problem's own row, in the program's variables and in units of its objective.
    """
    for family in program.families:
        if family.name != contact.constraint or contact.sign not in family.signs:
            continue
        share = family.unit / program.unit
        u = np.clip(family.u(np.array([contact.k])), *family.domain)
        if isinstance(family, LinearFamily):
            rows, right = family.rows(u, np.array([contact.sign]))
            return rows[0] * share, float(right[0]) * share
        row = _tangent(program, family, contact, u)
        if row is not None:
            return share * (row[:-1] - family.slack), share * (family.bound - float(row[-1]))
    return np.zeros(program.size), 0.0


def _tangent(program: Program, family: ConstraintFamily, contact: Contact, u: Array) -> Array | None:
    """A row below a nonlinear family, by the contact's direction; None where it has no meaning."""
    if isinstance(family, NormFamily) and len(contact.direction) == len(family.matrix):
        return _at_most_one(contact.direction) @ family.matrix
    if isinstance(family, ConeFamily) and len(contact.direction) == 2:
        return family.tangent(float(u[0]), _at_most_one(contact.direction))
    if isinstance(family, FormulaFamily):
        return family.tangent_row(float(u[0]), contact.sign, contact.direction)
    if isinstance(family, EnergyFamily) and family.convex and len(contact.direction) <= program.size:
        return family.minorant(_on_equations(program, np.array(contact.direction)))
    return None


def _at_most_one(direction: Sequence[float]) -> Array:
    """A direction of length at most 1, as a bound of a norm needs; a direction that overflows becomes 0."""
    given = np.array(direction)
    with np.errstate(over="ignore"):
        return np.asarray(given / max(float(np.linalg.norm(given)), 1.0))


def _on_equations(program: Program, coordinates: Array) -> Array:
    """Variables with these coordinates, or the nearest that keep the program's equations."""
    x = np.zeros(program.size)
    x[: len(coordinates)] = coordinates
    for _ in range(2):
        off = program.right - program.equalities @ x
        x += np.linalg.lstsq(program.equalities, off, rcond=None)[0]
    return x


def sum_of_rows(model: Model, lines: list[Line], claim: float | None = None) -> float:
    """A lower bound of the program's objective by weighted rows, in laws with an objective up to the claim.

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
    return total.value - rounding_error_bound(model, total, model.unit * total.value if claim is None else claim)


@dataclass(frozen=True, eq=False)
class RowSum:
    """The sum of weighted rows: its slope, exact in the variables beyond the coordinates, and what rounding hides.

    `value` is rounded down, the slope by each coordinate is off by its `blur` at most.
    """

    slope: Array
    value: float
    blur: Array


def summed(model: Model, lines: list[Line]) -> RowSum:
    """The objective and the weighted rows, added up."""
    lines = [line for line in lines if line[0] != 0.0]
    weights = np.array([weight for weight, _, _ in lines])
    rows = np.array([[*row, -right] for _, row, right in lines]).reshape(-1, model.program.size + 1)
    total = _weighted(weights, rows, np.append(model.program.objective, 0.0))
    hidden = _WEIGHTED_ROUNDING * (np.abs(weights) @ np.abs(rows))
    slope = total[:-1]
    variables = list(model.places.values())
    # the entries of the variables are exact, and so is a sum that is zero
    slope[variables] = np.where(slope[variables] == 0.0, 0.0, np.nextafter(slope[variables], -inf))
    return RowSum(slope, float(total[-1] - hidden[-1]), hidden[: model.space.terms])


def _weighted(weights: Array, rows: Array, start: Array) -> Array:
    """Start + weights . rows, rounded once: the great multipliers of laws at the edge of what exists cancel."""
    columns = np.vstack([start[None, :], *product_with_rest(weights[:, None], rows)])
    # fsum refuses what overflows
    return np.array([fsum(column) for column in columns.T.tolist()]) if np.isfinite(columns).all() else start * np.nan


def product_with_rest(first: Array, second: Array) -> tuple[Array, Array]:
    """A product, and what rounding took from it (Dekker 1971)."""
    product = first * second
    (a, b), (c, d) = _halves(first), _halves(second)
    return product, b * d - (((product - a * c) - b * c) - a * d)


def _halves(values: Array) -> tuple[Array, Array]:
    """Each value as a sum of two whose products are exact."""
    scaled = _SPLIT * values
    high = scaled - (scaled - values)
    return high, values - high


def rounding_error_bound(model: Model, total: RowSum, claim: float) -> float:
    """The greatest effect of rounding in the slope, over all laws that contradict the claim."""
    terms, slope = model.space.terms, total.slope
    sublevel = Sublevel.of(model)
    known = sublevel.greatest_values(max(claim, 0.0))
    greatest, least = model.in_scales(known), model.in_scales(sublevel.least_values())
    beyond = 0.0
    for name, place in model.places.items():
        # a positive slope can only help where the constant is at least 0
        if slope[place] < 0.0:
            beyond += -slope[place] * greatest.get(name, inf)
        elif slope[place] > 0.0:
            # of the two one-sided peaks one is at least the other's opposite
            facing = greatest.get(_FACING.get(name, ""), inf)
            beyond += slope[place] * max(min(-least.get(name, 0.0), facing), 0.0)
    if not slope[:terms].any() and not total.blur.any():
        return beyond
    reaches = (float(_reach(extension, slope[:terms], total.blur) @ most) for most, extension in moments(model, known))
    return beyond + min(reaches, default=_paid_by_variables(model, total, least))


def _paid_by_variables(model: Model, total: RowSum, least: Mapping[str, float]) -> float:
    """The cost of the slope with respect to the coordinates, where a variable with positive slope bounds the law.

    Where laws may be as great as they like, so is the constant, and what the sum leaves of it outweighs the rounding.
    """
    terms, beyond = model.space.terms, inf
    for name, place in model.places.items():
        if total.slope[place] > 0.0 and least.get(name, -inf) >= 0.0:
            for most, extension, growth in means_by(model, name):
                reach = _reach(extension, total.slope[:terms], total.blur)
                if _WIDER * growth * float(reach.sum()) <= total.slope[place]:
                    beyond = min(beyond, max(float(reach @ most), 0.0))
    return beyond


def _reach(extension: Array, slope: Array, blur: Array) -> Array:
    """The greatest magnitudes of the slope's weights of moments, wherever it is within its blur."""
    return np.asarray(np.abs(extension @ slope) + np.abs(extension) @ blur)
