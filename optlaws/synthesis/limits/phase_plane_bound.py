"""Bounds that a potential proves of all motions in a phase plane, with every rounding counted.

For any potential q(a), any weight of the time, and prices of torques and accelerations with 2 q = the sum of price
times inertia,

    what is minimised + weight * time  >=  the integral over a of the least, over 0 < b <= B, of
        A + B1 b + (C2 - q') b² + weight / b.

For a squared torque is at least p tau b - p² b²/4, a maximum of torques at least their mean by any shares, and at a
price n a torque within |tau| <= M is at least -|n| M; what all this has of c adds up to q w', which is integrated by
parts.

Where the velocity is bounded from a position on, the potential may jump there: by the squared velocity times the jump.

The time is the one that is given, neither more nor less: see `limits.standing` for what follows of the mean
torque, where the weight is that of the time above what standing still costs at least.

Behind a gear with losses torques have one form while power flows to the load, x >= 0, and another while it flows back,
x <= 0, and what is least is the lower of two inner minima, with prices of their own and a price of x >= 0 or of x <= 0.
"""

from __future__ import annotations

from math import comb, fsum, inf, nextafter

import numpy as np
from numpy.typing import NDArray

from optlaws.formulas.jets import formula_jet
from optlaws.numbers import Array
from optlaws.numerics.interval import Interval, between, exact
from optlaws.numerics.taylor import Jet
from optlaws.synthesis.limits.phase_plane import AnyTorque, PhasePlane
from optlaws.synthesis.limits.phase_plane_cells import PI, CellBounds, Guess, Potential, ProofCells, positions
from optlaws.synthesis.limits.standing import Standing
from optlaws.tolerances import ROUNDOFF, SMALLEST_SIZE

_EVEN_FALL = 1e-3  # of a potential by which a torque has one price everywhere: its fall, so that no velocity pays

__all__ = ["Guess", "Potential", "even_price", "proven_bound"]

_CELLS = 160  # in the whole, besides a few in every piece
_FEW = 3
_ENDS_ROUNDING = 64.0 * ROUNDOFF  # cells are a little wider than they are
#: pieces of a potential that gives a torque the same price everywhere, and their degree
_EVEN, _DEGREE = 256, 4
#: cells of which little is proven: in how many parts they are divided, how often, how many may be
_PARTS, _DEEPEST, _MOST_WEAK = 4, 6, 60


def proven_bound(standing: Standing, potential: Potential, weight: float, guess: Guess) -> float:
    """A lower bound for all motions of a phase plane, by a potential; minus infinity where it proves nothing.

    Parameters
    ----------
    standing
        The plane, with what is minimised and within which bounds, and the part of its mean torque.
    potential
        The multiplier of the equation of motion.
    weight
        The multiplier of the time above what standing still costs, at least 0; 1 where the time is minimised.
    guess
        Near what the inner minimum is looked for.
    """
    if not standing.holds:
        return -inf
    plane = standing.plane
    total, free = _sums(standing, potential, weight, guess)
    if plane.kind == "time":
        return total
    total = nextafter(total + (standing.offset - weight).low, -inf)
    if plane.kind == "mean":
        return total
    # what is proven is at most 0 of a peak that a motion has, and concave in it: at least the line from its value at 0
    free = nextafter(free + (standing.offset - weight).low, -inf)
    total = nextafter(total - nextafter(abs(standing.price) * guess.peak, inf), -inf)
    if not 0.0 < free < inf or not np.isfinite(total):
        return -inf
    return guess.peak * free / (free - min(total, 0.0)) * (1.0 - 4.0 * ROUNDOFF)


def _sums(standing: Standing, potential: Potential, weight: float, guess: Guess) -> tuple[float, float]:
    """A lower bound of the integral of the inner minimum, for a guessed peak and without its price."""
    plane = standing.plane
    first, *others = (ProofCells(standing, side, potential, weight, guess) for side in range(len(plane.branches)))
    piece, low, high = _whole(potential)
    sums, free = list[float](), list[float]()
    for deep in range(_DEEPEST):
        first.take(piece, low, high)
        known = _proven(first, others[0] if others else None)
        weak = known.weak > 0.0
        if deep + 1 == _DEEPEST or np.count_nonzero(np.isinf(known.weak)) > _MOST_WEAK:
            weak = np.zeros_like(weak)
        elif np.count_nonzero(weak) > _MOST_WEAK:
            weak &= known.weak >= np.sort(known.weak)[-_MOST_WEAK]
        length = exact(first.half) * 2.0
        sums += _times(known.least, length)[~weak].tolist()
        free += _times(known.free, length)[~weak].tolist()
        if not weak.any():
            break
        shares = np.arange(_PARTS + 1) / _PARTS
        edges = low[weak][:, None] * (1.0 - shares) + high[weak][:, None] * shares
        piece, low, high = np.repeat(piece[weak], _PARTS), edges[:, :-1].ravel(), edges[:, 1:].ravel()
    jumps = _jumps(plane, potential)
    return nextafter(_sum(sums) - jumps, -inf), nextafter(_sum(free) - jumps, -inf)


def even_price(plane: PhasePlane, torque: AnyTorque, price: float, start: float = 0.0, stop: float = 1.0) -> Potential:
    """The potential by which a torque has the same price at all positions: its mean over the way is what is bounded.

    Parameters
    ----------
    plane, torque
        A torque of a plane.
    price
        Of the torque; above 0 from the first position on, below 0 up to the last.
    start, stop
        The positions between which it has the price.
    """
    kinks = 2.0 / np.pi * np.arcsin(np.sqrt(np.array([start, *plane.kinks, stop])))
    ends, x = np.union1d(np.linspace(0.0, 1.0, _EVEN + 1), kinks), np.linspace(0.0, 1.0, _DEGREE + 1)
    places = ends[:-1, None] + np.diff(ends)[:, None] * x
    a = np.sin(0.5 * np.pi * places) ** 2
    inertia, reference = (form.values(a)[0] for form in (torque.branches[0], plane.reference))
    shapes = np.stack([comb(_DEGREE, i) * x**i * (1.0 - x) ** (_DEGREE - i) for i in range(_DEGREE + 1)], axis=1)
    rows = np.linalg.solve(shapes, (0.5 * price * inertia / reference * np.sin(np.pi * places)).T).T
    rows[1:, 0] = rows[:-1, -1]
    potential = Potential(ends, np.asarray(rows, dtype=np.float64)).steeper(_EVEN_FALL * float(np.abs(rows).max()))
    potential.coefficients[(a[:, 0] < start) | (a[:, -1] > stop)] = 0.0
    return potential


def _jumps(plane: PhasePlane, potential: Potential) -> float:
    """The greatest cost of jumps of the potential: each times the greatest squared velocity there, if it rises."""
    rises = exact(potential.coefficients[1:, 0]) - potential.coefficients[:-1, -1]
    places = np.flatnonzero(rises.high > ROUNDOFF * SMALLEST_SIZE)
    places = places[potential.coefficients[1:, 0][places] != potential.coefficients[:-1, -1][places]]
    if not len(places):
        return 0.0
    s = exact(potential.edges[1:-1][places])
    low, high = positions(s)
    sine, a = (s * PI).sine(), between(low, high)
    size = formula_jet(plane.reference.inertia, "a", Jet((a,))).terms[0] / sine
    most = plane.velocity_bound(low, high)
    with np.errstate(invalid="ignore", over="ignore"):
        return nextafter(fsum((rises[places] * size * exact(most) * most).high) * (1.0 + _ENDS_ROUNDING), inf)


def _times(values: Array, lengths: Interval) -> Array:
    known = np.isfinite(values)
    return np.where(known, (exact(np.where(known, values, 0.0)) * lengths).low, -inf)


def _sum(values: list[float]) -> float:
    if not np.isfinite(values).all():
        return -inf
    return nextafter(fsum(values) - _ENDS_ROUNDING * fsum(map(abs, values)), -inf)


def _whole(potential: Potential) -> tuple[NDArray[np.intp], Array, Array]:
    """Cells of the whole move: the piece of the potential that each is in, and its ends."""
    edges = potential.edges
    counts = np.ceil(np.diff(edges) * _CELLS).astype(int) + _FEW
    piece = np.repeat(np.arange(len(counts)), counts)
    shares = np.concatenate([np.arange(count) for count in counts]) / counts[piece]
    low = edges[piece] * (1.0 - shares) + edges[piece + 1] * shares
    return piece, low, np.append(low[1:], 1.0)


def _proven(first: ProofCells, other: ProofCells | None) -> CellBounds:
    """Bounds of the inner minimum in cells, in both directions of the power."""
    known = first.bounds()
    open_ones = ~known.shared | first.beside
    if other is None or not open_ones.any():
        return known
    other.reach = first.reach
    other.take(first.piece[open_ones], first.low[open_ones], first.high[open_ones])
    driving, braking = known.only(open_ones), other.bounds()
    mean, weak = _lower_of(driving, braking, other)
    for each in (driving, braking):
        better = each.shared & (each.least > mean)
        mean, weak = np.where(better, each.least, mean), np.where(better, each.weak, weak)
    changed = {
        "mean": mean,
        "weak": weak,
        "floor": np.full_like(mean, -inf),
        "free": np.minimum(driving.free, braking.free),
    }
    arrays = {name: getattr(known, name).copy() for name in changed}
    for name, values in changed.items():
        arrays[name][open_ones] = values
    return known._replace(**arrays)


def _lower_of(driving: CellBounds, braking: CellBounds, cells: ProofCells) -> tuple[Array, Array]:
    """A lower bound of the mean of the minimum of two inner minima, and of its further possible loss."""
    at, over = (first - second for first, second in zip(driving.below, braking.below, strict=True))
    with np.errstate(invalid="ignore"):
        more = exact(braking.loss) - driving.loss
        above = cells.range(at, over) + more  # by how much the first is above the second, and its mean
        mean = cells.mean(at, over) + more
        low, high = above.low, above.high
        tops = [(cells.range(*known.below) - known.loss).high for known in (driving, braking)]
        # a part above 0 is below the line through its ends
        part = high * (mean.high - low) / (high - low) + 8.0 * ROUNDOFF * (np.abs(low) + np.abs(high))
        crossing = np.where(np.isfinite(part), (exact(driving.mean) - part).low, -inf)
        first = (high <= 0.0) | (braking.floor >= tops[0])
        second = (low >= 0.0) | (driving.floor >= tops[1])
        likely = np.where(first, driving.mean, np.where(second, braking.mean, crossing))
        best = np.fmax(np.minimum(driving.floor, braking.floor), likely)
        lost = cells.weakness((np.minimum(driving.mean, braking.mean) - best) * cells.half, driving.size)
        either = np.maximum(np.maximum(driving.weak, braking.weak), lost)
    return best, np.where(first, driving.weak, np.where(second, braking.weak, either))
