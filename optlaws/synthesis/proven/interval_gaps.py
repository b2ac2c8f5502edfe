"""How far upper and lower side of a front are apart between two certified laws."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from optlaws.synthesis.solution import measure

Array = NDArray[np.float64]


def interval_gaps(t: Array, known: Array, scale: float | Array, *, concave: bool) -> Array:
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
