"""What a sum of rows still depends on, charged: by how much that can lower it in laws below a claim."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from math import inf, isfinite
from typing import NamedTuple

from flint import arb, arb_mat

from optlaws.synthesis.proof.sublevel_bounds import Number, Sublevel
from optlaws.verification.enclosing.balls import ball, upper
from optlaws.verification.exact.rows import ExactRows

Vector = list[arb]


def summed(weights: Sequence[arb], vectors: Sequence[Vector]) -> Vector:
    """Weighted vectors, added up."""
    return list((arb_mat([list(weights)]) * arb_mat(list(vectors))).entries())


def charge(sublevel: Sublevel, rows: ExactRows, total: Vector, claim: Fraction) -> arb | None:
    """The most by which a sum's slopes can lower it in laws below the claim; None where nothing bounds it."""
    greatest, least = sublevel.greatest_values(claim), sublevel.least_values()
    terms, beyond = rows.space.terms, arb(0)
    for name, slope in zip(rows.names, total[terms:-1], strict=True):
        # a rising slope lowers the sum most where the constant is least, a falling one where it is greatest
        low = Fraction(0) if bool(slope <= 0) else least.get(name, Fraction(0))
        high = Fraction(0) if bool(slope >= 0) else greatest.get(name, inf)
        if not (isfinite(low) and isfinite(high)):
            return None
        beyond -= slope.max(arb(0)) * ball(low) + slope.min(arb(0)) * ball(high)
    slopes = total[:terms]
    if all(slope.is_zero() for slope in slopes):
        return beyond
    bounded = sublevel.means(greatest)
    known = [(rows.space.moments(nu), ball(mean)) for nu, mean in bounded.items()]
    if not bounded:
        # an output may determine the law where nothing else says how large it is
        sized = [
            name for name, output in rows.outputs.items() if output.exact.both and isfinite(greatest.get(name, inf))
        ]
        known = [([rows.outputs[name].moments()], ball(greatest[name])) for name in sized]
    priced = [(worth(moments, rows.settled, slopes), mean) for moments, mean in known]
    worths = [value.known + value.by_mean * mean for value, mean in priced if value is not None]
    if not known:
        worths = list(_paid(sublevel, rows, total, least))
    return beyond + min(worths, key=upper) if worths else None


def _paid(sublevel: Sublevel, rows: ExactRows, total: Vector, least: Mapping[str, Number]) -> Iterator[arb]:
    """The worth of slopes where a constant that bounds a mean in proportion, however great it is, outweighs them."""
    terms = rows.space.terms
    for name, slope in zip(rows.names, total[terms:-1], strict=True):
        pays = bool(slope > 0) and least.get(name, 0) >= 0
        for nu, none, growth in sublevel.means_by(name) if pays else ():
            value = worth(rows.space.moments(nu), rows.settled, total[:terms])
            if value is not None and bool(value.by_mean * ball(growth) <= slope):
                yield value.known + value.by_mean * ball(none)


class Worth(NamedTuple):
    """The most by which slopes can lower a sum: what is known, and how much for each unit of a mean magnitude."""

    known: arb
    by_mean: arb


def worth(pieces: Sequence[Sequence[Vector]], settled: Sequence[Vector], slopes: Vector) -> Worth | None:
    """What slopes in the coordinates are worth; None where the moments do not determine the law.

    Parameters
    ----------
    pieces
        Of each piece of the interval, moments of the function with functions that are at most 1 in magnitude.
    settled
        Rows that are 0 in every law: of what no moment sees.
    slopes
        One for each coordinate.
    """
    rows = [row for piece in pieces for row in piece] + list(settled)
    matrix = arb_mat([row[:-1] for row in rows])
    try:
        # the plain elimination loses balls that are narrow enough by far
        solution = (matrix.transpose() * matrix).solve(arb_mat(len(slopes), 1, slopes), algorithm="precond")
    except ZeroDivisionError:
        return None
    weights = (matrix * solution).entries()
    known, first, most = arb(0), 0, arb(0)
    for weight, row in zip(weights, rows, strict=True):
        known += weight * arb(row[-1])
    for piece in pieces:
        most = most.max(sum((abs(weight) for weight in weights[first : first + len(piece)]), arb(0)))
        first += len(piece)
    return Worth(known, most) if known.is_finite() and most.is_finite() else None
