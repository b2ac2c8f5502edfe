"""A formula along a law: its extremes and its integrals over a part of the interval."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from itertools import pairwise

import numpy as np

from optlaws.formulas.branches import knots
from optlaws.formulas.of_motion import MotionFormula
from optlaws.formulas.tree import ORDERS
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw, PolynomialLaw
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.laws.segments.segment import PolynomialSegment
from optlaws.numbers import Array
from optlaws.numerics.chebyshev import gauss, value
from optlaws.numerics.panels import candidates, cut_at_roots, series_between
from optlaws.numerics.peaks import Peak, extremes
from optlaws.tolerances import BESIDE_BREAK

_INTEGRAL_SETTLED = 1e-14  # of an integral: what twice as many places may change of the whole, where no cut is needed
_PIECE_SETTLED = 1e-6  # of an integral: what twice as many places may change of the last pieces

_LARGEST = 400
#: how often a piece that is not smooth is cut in two, and how many places of Gauss's rule the last ones have
_DEEPEST, _DENSE = 12, 32


def extremes_along(motion: MotionFormula, law: MotionLaw) -> tuple[Peak, Peak]:
    """The least and the greatest value of a formula in a law, each with its place; infinite where it has no bound."""
    pieces = [_candidates(motion, law, ends) for ends in pairwise(_smooth_edges(motion, law))]
    if not pieces:
        k = np.array([motion.start])
        return extremes(k, _values(motion, law, k))
    k, values = (np.concatenate(several) for several in zip(*pieces, strict=True))
    if not np.isfinite(values).all():
        worst = float(k[~np.isfinite(values)][0])
        return Peak(-np.inf, worst), Peak(np.inf, worst)
    return extremes(k, values)


def integral_along(motion: MotionFormula, law: MotionLaw, *, square: bool = False) -> float:
    """The integral over the part of a formula in a law, or of its square; infinite where it seems to have none."""
    integral = _Integral(motion, law, square=square)
    return sum(integral.over(ends) for ends in integral.pieces)


def value_along(motion: MotionFormula, law: MotionLaw) -> float:
    """The formula's value in a law where its part begins."""
    return float(_values(motion, law, np.array([motion.start]))[0])


def _values(motion: MotionFormula, law: MotionLaw, k: Array) -> Array:
    names = {name: law(k, ORDERS[name]) for name in motion.formula.names() if name in ORDERS}
    return np.broadcast_to(motion.values({**names, "k": k}), k.shape).astype(np.float64)


def _smooth_edges(motion: MotionFormula, law: MotionLaw) -> list[float]:
    """The k between which the formula is smooth along the law, with kinks and knots of splines that the law passes."""
    breaks = law.breaks if isinstance(law, PiecewiseLaw) else ()
    inner = {k for k in (*breaks, *motion.breaks) if motion.start < k < motion.stop}
    edges = sorted({motion.start, motion.stop, *inner})
    plain, bent = knots(motion.formula, ORDERS)
    if plain:
        values = [partial(_values, MotionFormula(switch), law) for switch in plain]
        cut = (cut_at_roots(lambda *_: of, edges) for of in values)  # noqa: B023 - called at once
        edges = sorted({place for places in cut for place in places})
    for switch in bent:
        edges = cut_at_roots(partial(_inside, MotionFormula(switch), law), edges)
    return edges


def _inside(motion: MotionFormula, law: MotionLaw, low: float, high: float) -> Callable[[Array], Array]:
    """The values on a piece, its ends taken just within it."""
    return lambda k: _on(motion, law, (low, high), k)[1]


def _on(motion: MotionFormula, law: MotionLaw, ends: tuple[float, float], k: Array) -> tuple[Array, Array]:
    """Places of a piece, its ends just within it, and the values there."""
    low, high = ends
    # kinks that meet at an end may leave a piece shorter than that
    beside = min(BESIDE_BREAK, 0.25 * (high - low))
    inside = np.clip(k, low + beside * (low > 0.0), high - beside * (high < 1.0))
    return inside, _values(motion, law, inside)


def _count(motion: MotionFormula, law: MotionLaw, ends: tuple[float, float]) -> int | None:
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


def _candidates(motion: MotionFormula, law: MotionLaw, ends: tuple[float, float]) -> tuple[Array, Array]:
    """Candidates for extremes of the formula on a piece, and its values there."""
    inner = candidates(_inside(motion, law, *ends), ends, _count(motion, law, ends))
    return _on(motion, law, ends, np.concatenate([np.array(ends), inner]))


class _Integral:
    """The integral of a formula along a law, by Gauss's rule: exact where the formula is a polynomial."""

    def __init__(self, motion: MotionFormula, law: MotionLaw, *, square: bool) -> None:
        self.motion, self.law, self.square = motion, law, square
        self.pieces = list(pairwise(_smooth_edges(motion, law)))

    @kept_property
    def size(self) -> float:
        """The approximate size of the formula when no terms cancel."""
        return sum(abs(self._by_rule(ends, _DENSE, sizes=True)) for ends in self.pieces)

    def over(self, ends: tuple[float, float]) -> float:
        """The integral over a piece."""
        series = series_between(_inside(self.motion, self.law, *ends), ends, _count(self.motion, self.law, ends))
        if series is None:
            return self._in_parts(ends, 0)
        x, weights = gauss(len(series) + 1)
        values = np.asarray(value(series, x))
        return float(weights @ (values**2 if self.square else values)) * (ends[1] - ends[0]) / 2.0

    def _in_parts(self, ends: tuple[float, float], depth: int) -> float:
        """Over a piece that is not smooth: a kink that a law comes near and turns is known to some digits alone."""
        rough, fine = (self._by_rule(ends, count) for count in (_DENSE, 2 * _DENSE))
        off = abs(fine - rough)
        if off <= _INTEGRAL_SETTLED * self.size:
            return fine
        if depth == _DEEPEST:
            return fine if off <= _PIECE_SETTLED * abs(fine) else float("inf")
        middle = (ends[0] + ends[1]) / 2.0
        return sum(self._in_parts(half, depth + 1) for half in ((ends[0], middle), (middle, ends[1])))

    def _by_rule(self, ends: tuple[float, float], count: int, *, sizes: bool = False) -> float:
        x, weights = gauss(count)
        half = (ends[1] - ends[0]) / 2.0
        values = _on(self.motion, self.law, ends, ends[0] + half * (x + 1.0))[1]
        with np.errstate(invalid="ignore", over="ignore"):
            shown = values**2 if self.square else np.abs(values) if sizes else values
            return float(weights @ shown) * half
