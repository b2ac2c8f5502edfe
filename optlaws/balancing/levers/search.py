"""The search for lengths of a torsion lever: along one length by sign changes, in two by least squares."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import NamedTuple

import numpy as np

from optlaws.balancing.levers.lever import TorsionLever
from optlaws.errors import InputError, OptlawsError
from optlaws.numbers import Array
from optlaws.numerics.bisection import bisect
from optlaws.numerics.tolerances import LINKAGE_MET, SAME_LINKAGE

Quantity = Callable[[TorsionLever], float]
Make = Callable[..., TorsionLever]

_TRIED, _TRIED_EACH = 33, 8  # samples along one length, and along each of two
_HALVINGS = 40
_STARTS = 4
_BAR = 1e3  # residual where there is no lever: far above any that a lever has


class LengthSearch(NamedTuple):
    """One constant of the lever as a function of one length."""

    make: Make
    name: str
    span: tuple[float, float]
    title: str
    quantity: Quantity

    def lever(self, length: float) -> TorsionLever:
        """The lever of this length."""
        return self.make(**{self.name: length})

    def value(self, length: float) -> float:
        """The constant at this length; nan beyond the limits."""
        try:
            return self.quantity(self.lever(length))
        except OptlawsError:
            return float("nan")


def along(line: LengthSearch, value: float) -> tuple[TorsionLever, ...]:
    """The levers whose constant has a value, in order of their length."""
    from scipy.optimize import brentq

    lengths, values = _samples(line)
    excess = values - value
    places = lengths[excess == 0.0].tolist()
    for i in np.flatnonzero(excess[:-1] * excess[1:] < 0.0):
        low, high = lengths[i : i + 2].tolist()
        places.append(float(brentq(lambda length: line.value(length) - value, low, high, xtol=1e-14, rtol=1e-14)))
    if not places:
        low, high = int(np.argmin(values)), int(np.argmax(values))
        raise InputError(
            f"{line.title} = {value:.6g} is out of reach: for {line.name} from {lengths[0]:.5g} to {lengths[-1]:.5g}, "
            f"where all limits hold, it runs from {values[low]:.6g} (at {lengths[low]:.5g}) to {values[high]:.6g} "
            f"(at {lengths[high]:.5g}); change the other length, the swing or the pre-twists"
        )
    return tuple(line.lever(length) for length in sorted(places))


def _samples(line: LengthSearch) -> tuple[Array, Array]:
    """Lengths within all limits, up to the very limits, and the constant there."""
    lengths = np.geomspace(*line.span, _TRIED)
    values = np.array([line.value(float(length)) for length in lengths])
    known = np.isfinite(values)
    if not known.any():
        line.quantity(line.lever(float(lengths[_TRIED // 2])))  # raises, and says which limit it is
    edges = [_edge(line, *lengths[[i, i + 1] if known[i] else [i + 1, i]]) for i in np.flatnonzero(np.diff(known))]
    lengths = np.append(lengths[known], edges)
    values = np.append(values[known], [line.value(edge) for edge in edges])
    order = np.argsort(lengths)
    return lengths[order], values[order]


def _edge(line: LengthSearch, inside: float, outside: float) -> float:
    return float(bisect(lambda length: bool(np.isfinite(line.value(length))), inside, outside, _HALVINGS)[0])


def within(
    make: Make, spans: Mapping[str, tuple[float, float]], goals: Mapping[str, tuple[Quantity, float]]
) -> tuple[TorsionLever, ...]:
    """Levers with several constants of given values, searched from the best of a grid of lengths."""
    from scipy.optimize import least_squares

    names = list(spans)
    low, high = np.log(np.array(list(spans.values()))).T
    targets = np.array([value for _, value in goals.values()])

    def lever(logs: Array) -> TorsionLever:
        return make(**dict(zip(names, np.exp(logs).tolist(), strict=True)))

    def values(logs: Array) -> Array:
        try:
            return np.array([quantity(lever(logs)) for quantity, _ in goals.values()])
        except OptlawsError:
            return np.full(len(targets), np.nan)

    grid = np.stack(np.meshgrid(*np.linspace(low, high, _TRIED_EACH).T), axis=-1).reshape(-1, len(names))
    reached = np.array([values(point) for point in grid])
    known = np.isfinite(reached).all(axis=1)
    if not known.any():
        next(iter(goals.values()))[0](lever(0.5 * (low + high)))  # raises, and says which limit it is
    grid, reached = grid[known], reached[known]
    scale = np.maximum(np.ptp(reached, axis=0), LINKAGE_MET)

    def miss(logs: Array) -> Array:
        return np.asarray(np.nan_to_num((values(logs) - targets) / scale, nan=_BAR))

    starts = grid[np.argsort(np.linalg.norm((reached - targets) / scale, axis=1), kind="stable")[:_STARTS]]
    ends = [least_squares(miss, start, bounds=(low, high), xtol=3e-16, ftol=3e-16, gtol=3e-16).x for start in starts]
    solved: list[Array] = []
    for end in ends:
        met = np.abs(miss(end)).max() <= LINKAGE_MET
        if met and not any(np.abs(end - other).max() <= SAME_LINKAGE for other in solved):
            solved.append(end)
    if not solved:
        best = min(ends, key=lambda end: float(np.abs(miss(end)).max()))
        near = ", ".join(f"{name} = {value:.6g}" for name, value in zip(goals, values(best), strict=True))
        at = ", ".join(f"{name} = {length:.5g}" for name, length in zip(names, np.exp(best), strict=True))
        reach = ", ".join(
            f"{name} from {least:.6g} to {most:.6g}"
            for name, least, most in zip(goals, reached.min(axis=0), reached.max(axis=0), strict=True)
        )
        raise InputError(
            f"no lever has {' and '.join(f'{name} = {value:.6g}' for name, (_, value) in goals.items())}: the nearest "
            f"has {near} at {at}; alone each reaches about: {reach}"
        )
    return tuple(lever(point) for point in sorted(solved, key=lambda point: float(point[0])))
