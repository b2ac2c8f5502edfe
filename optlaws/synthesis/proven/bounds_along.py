"""What certificates prove not of their own problems alone but of all whose right sides differ by one number.

How far both sides of a front are apart follows from these lines.
"""

from __future__ import annotations

from dataclasses import replace
from math import inf, isfinite
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from optlaws.errors import InputError
from optlaws.synthesis.proof.certificate import Certificate, weighted_rows
from optlaws.synthesis.proof.duality import charge, summed
from optlaws.synthesis.proven.running import RunningNumber
from optlaws.synthesis.solution import measure

Array = NDArray[np.float64]
Ends = tuple[float, float]

#: of a product, what rounding of it and of its factors can be
_ROUNDED = 2.0**-50


class Line(NamedTuple):
    """An affine function of the running number: its value where the certificate was made, and its slope."""

    value: float
    slope: float


def lower_line(certificate: Certificate, at: float, number: RunningNumber, ends: Ends, claim: float = -inf) -> Line:
    """An affine function that is nowhere above the least objective between two ends of the running number.

    Of a weight it is a bound at the certificate's own problem, with slope 0. What rounding hides is charged as much as
    it can be worth anywhere between the ends: it grows with every bound, with the objective that is claimed, and as a
    weight falls.

    Parameters
    ----------
    certificate, at
        A certificate, and the value of the running number in its problem.
    number, ends
        The number, and between which values.
    claim
        The greatest objective that is asked about; what the line itself comes to unless that is less.
    """
    model, lines = weighted_rows(certificate)
    there = [weighted_rows(replace(certificate, problem=number.at(end))) for end in ends]
    total, weights = summed(model, lines), np.array([weight for weight, _, _ in lines])
    rates, rounding = _rates(number, ends, *(rows for _, rows in there))
    value, slope = model.unit * total.value, -float(model.unit * (weights @ rates))
    most = max(claim, *(value + slope * (end - at) for end in ends))
    hidden = max(charge(moved, total, most) for moved, _ in there)
    lost = model.unit * (hidden + float(np.abs(weights) @ rounding))
    return Line(value - lost if isfinite(lost) else -inf, slope)


def _rates(number: RunningNumber, ends: Ends, *rows: list[tuple[float, Array, float]]) -> tuple[Array, Array]:
    """How fast each row's right side runs, and what rounding does to it between the ends."""
    first, last = rows
    if number.concave:
        return np.zeros(len(first)), np.zeros(len(first))
    if any((values != other).any() for (_, values, _), (_, other, _) in zip(first, last, strict=True)):
        raise InputError(f"{number.name} changes more than right sides of rows, so that nothing is proven between")
    low, high = (np.array([right for _, _, right in some]) for some in rows)
    rates = (high - low) / (ends[1] - ends[0])
    return rates, np.where(rates == 0.0, 0.0, _ROUNDED * np.maximum(np.abs(low), np.abs(high)))


def gap_bounds(t: Array, known: Array, scale: float | Array, *, concave: bool) -> Array:
    """The greatest gap in each interval: between a chord and two lines, the difference is greatest where these cross.

    Parameters
    ----------
    t
        Values.
    known
        At each value what is known above and below the least objective, and a slope: of the line through the lower
        value or, where the objective is concave, through the upper one.
    scale
        Of the objective; one number, or one for each interval.
    concave
        Whether it is.
    """
    top, bottom, slopes = known.T
    width = np.diff(t)
    first = np.stack([top[:-1] - bottom[:-1], np.zeros_like(width)])
    last = np.stack([np.zeros_like(width), top[1:] - bottom[1:]])
    if concave:
        first[1] = top[:-1] + slopes[:-1] * width - bottom[1:]
        last[0] = top[1:] - slopes[1:] * width - bottom[:-1]
    else:
        first[1] = top[1:] - (bottom[:-1] + slopes[:-1] * width)
        last[0] = top[:-1] - (bottom[1:] - slopes[1:] * width)
    turn = first[1] - first[0] + last[0] - last[1]
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.clip(np.where(turn > 0.0, (last[0] - first[0]) / turn, 0.0), 0.0, 1.0)
    crossing = np.minimum((1.0 - share) * first[0] + share * first[1], (1.0 - share) * last[0] + share * last[1])
    greatest = np.maximum(crossing, np.minimum(first, last).max(axis=0))
    least = np.minimum(top[:-1], top[1:])
    return np.asarray(greatest / measure(least, scale))
