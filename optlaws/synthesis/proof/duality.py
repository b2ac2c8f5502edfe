"""Rows of contacts, and their weighted sum in doubles: the bound by weak duality, less what their rounding may hide.

What rounding leaves of the sum's dependence on the law is charged, for which laws that contradict the claim must be
bounded: the quick bound by which searches decide and arrays are proven. That of a single certificate is exact.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import inf, isfinite
from typing import NamedTuple

import numpy as np

from optlaws.numbers import Array
from optlaws.synthesis.families.cone import ConeFamily
from optlaws.synthesis.families.curved import FormulaFamily
from optlaws.synthesis.families.energy import EnergyFamily
from optlaws.synthesis.families.family import ConstraintFamily, LinearFamily, NormFamily, Program
from optlaws.synthesis.program.writer import Model
from optlaws.synthesis.proof.nodes import Contact, Leaf
from optlaws.synthesis.proof.sublevel_bounds import Sublevel, moments
from optlaws.tolerances import ROUNDOFF

_IN_A_ROW = 9  # roundings in a row before it is weighted
_SQUARED = 2.0**-20  # of a rounding: more than products of roundings are

#: a multiplier, a row and its right side
Line = tuple[float, Array, float]

_FACING = {"C_plus": "C_minus", "C_minus": "C_plus"}
#: bounds of the variables above and below, and those of moments with their matrices
AprioriBounds = tuple[dict[str, float], dict[str, float], list[tuple[Array, Array]]]


def lines_of(program: Program, leaf: Leaf) -> list[Line]:
    """Contacts and the program's equations as weights, rows and right sides; negative multipliers of contacts are 0."""
    lines = [(max(contact.multiplier, 0.0), *row_of(program, contact)) for contact in leaf.contacts]
    weights = program.multipliers_of_equations(leaf.equations).tolist()
    return [*lines, *zip(weights, program.equalities, program.right.tolist(), strict=False)]


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
    total = sum_of_lines(model, lines)
    most = model.unit * float(total.value[0]) if claim is None else claim
    below = bounds_below(model, most)
    return float((total.value - total.hidden - charge(model, below, total.slope, total.blur))[0])


def sum_of_lines(model: Model, lines: list[Line]) -> RowSums:
    """The objective and the weighted rows of one law, added up."""
    weights = np.array([weight for weight, _, _ in lines])[None]
    rows = np.array([[*row, -right] for _, row, right in lines]).reshape(1, -1, model.program.size + 1)
    return summed(model.program.objective[None], weights, rows, np.abs(rows))


class RowSums(NamedTuple):
    """Sums of weighted rows, one for each law: slopes by the variables and values, each with what rounding hides."""

    slope: Array
    blur: Array
    value: Array
    hidden: Array


def summed(cost: Array, weights: Array, rows: Array, sizes: Array) -> RowSums:
    """The cost and the weighted rows of each law, added up.

    Parameters
    ----------
    cost
        What is minimised, shape (laws, variables), or one for all.
    weights, rows
        Shapes (laws, rows) and (laws, rows, variables + 1), with the opposites of the right sides last.
    sizes
        How great the rows' entries may be.
    """
    start = np.concatenate([cost, np.zeros((len(cost), 1))], axis=1)
    total = start + weighted(weights, rows)
    hidden = roundings(rows.shape[1]) * (weighted(np.abs(weights), sizes) + np.abs(start))
    return RowSums(total[:, :-1], hidden[:, :-1], total[:, -1], hidden[:, -1])


def weighted(weights: Array, rows: Array) -> Array:
    """The sum of the rows of each law, weighted."""
    return np.asarray(np.matmul(weights[:, None, :], rows)[:, 0])


def roundings(count: int) -> float:
    """What rounding hides of a start and so many weighted rows, as a share of the sum of magnitudes.

    Each is rounded as a product once, and in as many additions as there are rows.
    """
    return ROUNDOFF * (_IN_A_ROW + 1 + count + _SQUARED)


def bounds_below(model: Model, claim: float) -> AprioriBounds:
    """A priori bounds of the variables, above and below, and of the coordinates, in laws below a claim."""
    return bounds_within(model, Sublevel.of(model).greatest_values(max(claim, 0.0)))


def bounds_within(model: Model, greatest: dict[str, float]) -> AprioriBounds:
    """The same of laws whose constants are bounded from above."""
    scales = model.in_scales
    return scales(greatest), scales(Sublevel.of(model).least_values()), moments(model, greatest)


def charge(model: Model, below: AprioriBounds, slope: Array, blur: Array) -> Array:
    """The most by which slopes, and what rounding hides of them, lower sums in laws with known a priori bounds."""
    greatest, least, sizes = below
    terms, beyond = model.space.terms, np.zeros(len(slope))
    for name, place in model.places.items():
        share, unknown = slope[:, place], blur[:, place]
        # of the two one-sided peaks one is at least the other's opposite
        low = max(min(-least.get(name, 0.0), greatest.get(_FACING.get(name, ""), inf)), 0.0)
        for pull, most in ((unknown - share, greatest.get(name, inf)), (unknown + share, low)):
            beyond += np.where(pull > 0.0, pull, 0.0) * most if isfinite(most) else np.where(pull > 0.0, inf, 0.0)
    reaches = [
        (np.abs(slope[:, :terms] @ extension.T) + blur[:, :terms] @ np.abs(extension).T) @ most
        for most, extension in sizes
    ]
    free = np.where((slope[:, :terms] != 0.0).any(axis=1) | (blur[:, :terms] != 0.0).any(axis=1), inf, 0.0)
    return np.asarray(beyond + (np.min(reaches, axis=0) if reaches else free))
