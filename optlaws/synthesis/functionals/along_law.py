"""What a formula is along a law: its extremes and its integrals over the whole of a part of the interval."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from optlaws.formulas.branches import switches
from optlaws.formulas.of_motion import Motion
from optlaws.formulas.vocabulary import ORDERS
from optlaws.laws import MotionLaw, PolynomialLaw
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.laws.segments.segment import PolynomialSegment
from optlaws.series.candidates import candidates, cut_at_roots, series_between
from optlaws.series.chebyshev import gauss, value
from optlaws.series.peaks import Peak, extremes

Array = NDArray[np.float64]

_BESIDE = 2.0**-50
_LARGEST = 400


def extremes_along(motion: Motion, law: MotionLaw) -> tuple[Peak, Peak]:
    """The least and the greatest value of a formula in a law, each with its place; infinite where it has no bound."""
    candidates = [_candidates(motion, law, ends) for ends in pairwise(_edges(motion, law))]
    if not candidates:
        k = np.array([motion.start])
        return extremes(k, _values(motion, law, k))
    k, values = (np.concatenate(several) for several in zip(*candidates, strict=True))
    if not np.isfinite(values).all():
        worst = float(k[~np.isfinite(values)][0])
        return Peak(-np.inf, worst), Peak(np.inf, worst)
    return extremes(k, values)


def mean_square_along(motion: Motion, law: MotionLaw) -> float:
    """The integral over the part of the square of a formula in a law."""
    return sum(_integral(motion, law, ends, square=True) for ends in pairwise(_smooth_edges(motion, law)))


def integral_along(motion: Motion, law: MotionLaw) -> float:
    """The integral over the part of a formula in a law."""
    return sum(_integral(motion, law, ends, square=False) for ends in pairwise(_smooth_edges(motion, law)))


def value_along(motion: Motion, law: MotionLaw) -> float:
    """The formula's value in a law where its part begins."""
    return float(_values(motion, law, np.array([motion.start]))[0])


def _values(motion: Motion, law: MotionLaw, k: Array) -> Array:
    names = {name: law(k, ORDERS[name]) for name in motion.formula.names() if name in ORDERS}
    return np.broadcast_to(motion.values({**names, "k": k}), k.shape).astype(np.float64)


def _edges(motion: Motion, law: MotionLaw) -> list[float]:
    """The k between which the formula is smooth along the law."""
    breaks = law.breaks if isinstance(law, PiecewiseLaw) else ()
    inner = {k for k in (*breaks, *motion.breaks) if motion.start < k < motion.stop}
    return sorted({motion.start, motion.stop, *inner})


def _smooth_edges(motion: Motion, law: MotionLaw) -> list[float]:
    """These, and the kinks that the law makes."""
    edges = _edges(motion, law)
    for switch in switches(motion.formula, ORDERS):
        edges = cut_at_roots(partial(_inside, Motion(switch), law), edges)
    return edges


def _inside(motion: Motion, law: MotionLaw, low: float, high: float) -> Callable[[Array], Array]:
    return lambda k: _on(motion, law, (low, high), k)[1]


def _on(motion: Motion, law: MotionLaw, ends: tuple[float, float], k: Array) -> tuple[Array, Array]:
    """Places of a piece, its ends just within it, and the values there."""
    low, high = ends
    inside = np.clip(k, low + _BESIDE * (low > 0.0), high - _BESIDE * (high < 1.0))
    return inside, _values(motion, law, inside)


def _count(motion: Motion, law: MotionLaw, ends: tuple[float, float]) -> int | None:
    """How many coefficients the formula has on a piece; None where it is no polynomial."""
    longest = None
    if isinstance(law, PolynomialLaw):
        longest = len(law.acceleration)
    elif isinstance(law, PiecewiseLaw):
        segment = law.segments[int(np.searchsorted(law.breaks, sum(ends) / 2.0)) - 1]
        longest = len(segment.acceleration) if isinstance(segment, PolynomialSegment) else None
    if longest is None:
        return None
    degree = motion.degree({name: max(longest + 1 - nu, 0) for name, nu in ORDERS.items()})
    return None if degree is None or degree > _LARGEST else degree + 1


def _candidates(motion: Motion, law: MotionLaw, ends: tuple[float, float]) -> tuple[Array, Array]:
    """Where the formula may be extreme on a piece, and its values there."""
    inner = candidates(lambda k: _on(motion, law, ends, k)[1], ends, _count(motion, law, ends))
    return _on(motion, law, ends, np.concatenate([np.array(ends), inner]))


def _integral(motion: Motion, law: MotionLaw, ends: tuple[float, float], *, square: bool) -> float:
    """Over a piece by Gauss's rule, exact where the formula is a polynomial."""
    series = series_between(lambda k: _on(motion, law, ends, k)[1], ends, _count(motion, law, ends))
    if series is None:
        return float("inf")
    x, weights = gauss(len(series) + 1)
    values = np.asarray(value(series, x))
    return float(weights @ (values**2 if square else values)) * (ends[1] - ends[0]) / 2.0
