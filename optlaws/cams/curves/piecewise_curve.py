"""Curves made of polynomials between knots, with their Taylor terms at places or in intervals of places."""

from __future__ import annotations

from dataclasses import dataclass
from math import comb
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from optlaws.series import chebyshev
from optlaws.series.enclosures.interval_arrays import ROUNDING, Interval
from optlaws.series.enclosures.jets import Jet

Array = NDArray[np.float64]

_BLUR = (
    128.0 * ROUNDING
)  # of the greatest control point: values are means of these, and the polynomials go through them


@dataclass(frozen=True, eq=False)
class PiecewiseCurve:
    """Polynomials between knots, a row of coordinates each: what is enclosed are these, which are splines to rounding.

    Parameters
    ----------
    knots
        Increasing, shape (n + 1,).
    powers
        Coefficients of ascending powers of t, |t| <= 1, between two knots, shape (degree + 1, n, coordinates).
    blur
        How far coordinates may be from those of the spline that it was made of, for rounding.

    Examples
    --------
    >>> curve = PiecewiseCurve(np.array([0.0, 2.0]), np.array([[[1.0]], [[2.0]]]), 0.0)
    >>> [float(term) for term in curve.jets(np.array(1.5), 1)[0].terms]
    [2.0, 2.0]
    """

    knots: Array
    powers: Array
    blur: float

    @classmethod
    def of_spline(cls, knots: Array, controls: Array, degree: int) -> Self:
        """The pieces of a B-spline, control points of shape (count, coordinates)."""
        from scipy.interpolate import BSpline

        places = np.unique(knots)
        t = chebyshev.nodes(degree + 1)
        values = BSpline(knots, controls, degree)(
            0.5 * (places[1:] + places[:-1]) + np.multiply.outer(t, 0.5 * np.diff(places))
        )
        powers = np.einsum("kt,tnd->knd", np.linalg.inv(np.vander(t, increasing=True)), values)
        return cls(places, powers, _BLUR * float(np.abs(controls).max()))

    def jets(self, places: Array | Interval, order: int) -> list[Jet]:
        """The Taylor terms of each coordinate; intervals must lie between two knots."""
        middle = places.middle if isinstance(places, Interval) else np.asarray(places)
        which = np.clip(np.searchsorted(self.knots, middle, side="right") - 1, 0, len(self.knots) - 2)
        half = 0.5 * np.diff(self.knots)[which]
        t = (places - 0.5 * (self.knots[1:] + self.knots[:-1])[which]) / half
        return [
            Jet(tuple(self._term(which, t, half, nu, i) for nu in range(order + 1)))
            for i in range(self.powers.shape[2])
        ]

    def _term(self, which: Any, t: Any, half: Array, nu: int, coordinate: int) -> Any:  # noqa: ANN401 - arrays or intervals
        total = t * 0.0
        for k in range(len(self.powers) - 1, nu - 1, -1):
            total = total * t + comb(k, nu) * self.powers[k, which, coordinate]
        return total / half**nu
