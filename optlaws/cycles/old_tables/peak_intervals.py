"""Intervals that hold the peaks of a motion with noisy samples: from below by the rows, from above by models."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf
from typing import NamedTuple

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from optlaws.cycles.old_tables.curve_fit import DEGREE, CurveFit
from optlaws.cycles.old_tables.fitting import SIMPLE
from optlaws.cycles.old_tables.samples import window_polynomials
from optlaws.numbers import Array

#: standard deviations by which estimates in bands are off at most, and in windows beyond what as many, squared, have
_ABOVE, _BEYOND = 3.0, 0.6
#: of a peak, by which a spline may be off a smooth motion where the samples have all digits
_APPROXIMATION = 1e-3
#: of a jump of the next derivative by the length of pieces: what the peak of a velocity or an acceleration at a kink is
#: less in the nearest spline of even pieces of degree 5, wherever its knots are
_KINK = 0.14
#: of that jump by powers of this length: what that spline is off the position, in the mean of squares beside the kink
#: of a velocity or an acceleration; and by how many deviations of a fit rows would show it, so that pieces were more
_OFF_KINK, _SHOWN = (0.0, 0.0104, 0.0031), 6.0
#: windows have so many rows, and each begins so many parts of its length behind the last one
_LONGER, _OVERLAP = 1.35, 6
#: places of each piece of degree 5 at which a band is looked at, and of a move
_PLACES, _FEWEST_PLACES = 24, 192


class PeakInterval(NamedTuple):
    """Between which values the peak of a derivative is, by a table, in units of the table.

    Attributes
    ----------
    low
        No motion through the samples with the noise that they show has less.
    high
        The motions that the samples do not exclude have no more; inf where a peak cannot be known from the table.

    Examples
    --------
    >>> PeakInterval(0.0125, 0.0131).is_known, 0.0128 in PeakInterval(0.0125, 0.0131)
    (True, False)
    >>> PeakInterval(0.0125, 0.0131).holds(0.0128)
    True
    """

    low: float
    high: float

    @property
    def is_known(self) -> bool:
        """Whether the table bounds the peak from above."""
        return self.high < inf

    def holds(self, value: float) -> bool:
        """Whether a value is within the interval."""
        return self.low <= value <= self.high


def least_peak(places: Array, heights: Array, noise: Array, digit: float, nu: int) -> float:
    """What the peak of a derivative, 1 to 3, is at least: the mean of the derivative over windows, less its error.

    A polynomial of degree nu through the rows of a window by least squares has a derivative that is a mean of the
    motion's, weighted by a kernel that is nowhere negative, whatever the motion is.

    Examples
    --------
    >>> x = np.linspace(0.0, np.pi, 181)
    >>> round(least_peak(x, np.round(np.sin(x), 4), np.full(181, 3e-5), 1e-4, 2), 2)
    0.99
    """
    count, best = len(places), 0.0
    rows = nu + 2
    while rows <= count:
        starts = slice(None, None, max(1, rows // _OVERLAP))
        x = sliding_window_view(places, rows)[starts]
        y = sliding_window_view(heights, rows)[starts]
        sizes = sliding_window_view(noise, rows)[starts]
        span = 0.5 * (x[:, -1] - x[:, 0])
        weights = window_polynomials(x, nu)[:, :, nu]
        # the derivative of what is in proportion to the highest polynomial
        u = (x - 0.5 * (x[:, -1] + x[:, 0])[:, None]) / span[:, None]
        weights = weights * (_FACTORIALS[nu] / (weights * u**nu).sum(axis=1))[:, None]
        values = np.abs((weights * y).sum(axis=1))
        # short windows are many and tell little: theirs is the smaller share of the chance to be wrong
        errors = (2.0 * np.sqrt(np.log(len(x) + 1.0)) + _BEYOND) * np.sqrt(((weights * sizes) ** 2).sum(axis=1))
        if digit > 0.0:
            # rounding repeats itself where the motion is slow: then errors do not cancel
            coarse = sizes.max(axis=1) < digit
            errors = np.where(coarse, np.maximum(errors, 0.5 * digit * np.abs(weights).sum(axis=1)), errors)
        best = max(best, float(((values - errors) / span**nu).max()))
        rows = max(rows + 1, int(rows * _LONGER))
    return best


_FACTORIALS = (1.0, 1.0, 2.0, 6.0)


def most_peak(fits: Sequence[CurveFit], nu: int, low: float, high: float) -> float:
    """The greatest magnitude of a derivative in the bands about fits between two places; inf without a fit."""
    most, peaks = 0.0, []
    if nu > 2 and fits and fits[0].jumps and (low <= fits[0].start or fits[0].stop <= high):
        return inf
    for fit in fits:
        start, stop = max(low, fit.start), min(high, fit.stop)
        if not start < stop:
            continue
        # a velocity is known where a move leaves a line at a corner, and not about one within
        joints = [joint.place for joint in fit.joints if joint.continuity < nu]
        if any(start <= at <= stop and (nu > 1 or fit.start < at < fit.stop) for at in joints):
            return inf
        inner = fit.breaks[(fit.breaks > start) & (fit.breaks < stop)]
        edges = np.concatenate([[start], inner, [stop]])
        places = max(_PLACES, _FEWEST_PLACES // (len(edges) - 1))
        share = np.linspace(0.0, 1.0, places * fit.degree // DEGREE, endpoint=False)
        at = np.append((edges[:-1, None] + np.diff(edges)[:, None] * share).ravel(), stop)
        # one-sided values before jumps too
        at = np.unique(np.concatenate([at, np.nextafter(inner, -inf)]))
        values = np.abs(fit.values(at, nu))
        peaks.append(float(values.max()))
        parts = max(fit.pieces, len(fit.breaks) - 1, fit.degree - DEGREE)
        if nu <= 2 and parts > SIMPLE:
            values += _smoothed_kink(fit, nu, at, (fit.stop - fit.start) / parts)
        most = max(most, float((values + _ABOVE * fit.deviation(at, nu)).max()))
    return most * (1.0 + _APPROXIMATION) + max(peaks) - min(peaks) if peaks else inf


def _smoothed_kink(fit: CurveFit, nu: int, at: Array, length: float) -> Array:
    """What a velocity or an acceleration is more at a kink that pieces of a fit smooth: of its jump by their length.

    The next derivative of a smooth motion changes twice as much over twice as far, and that of a kink as much.
    """
    near, far = (fit.values(at + apart, nu + 1) - fit.values(at - apart, nu + 1) for apart in (length, 2.0 * length))
    jump = np.maximum(np.minimum(2.0 * np.abs(near) - np.abs(far), np.abs(far)), 0.0)
    hidden = _SHOWN * fit.deviation(at, 0) / (_OFF_KINK[nu] * length ** (nu + 1))
    return np.asarray(_KINK * length * np.minimum(jump, hidden))
