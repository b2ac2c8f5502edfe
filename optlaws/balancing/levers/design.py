"""The inverse task: lengths of the torsion lever for constants that its motion shall have."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from math import isfinite
from typing import Any

import numpy as np

from optlaws.balancing.levers.lever import TorsionLever
from optlaws.balancing.levers.sizing import LEAST_TRANSMISSION, MOST_ROCKER_SWING
from optlaws.echo import shortened
from optlaws.errors import InputError, OptlawsError
from optlaws.files.reading import check_names
from optlaws.numbers import Array, NumberOrQuantity, finite
from optlaws.numerics.roots import bisect

_LINKAGE_MET = 1e-9  # a linkage whose equations miss by less is a solution
_SAME_LINKAGE = 1e-6  # linkages nearer to each other are one

Span = float | tuple[float, float]

BETA, LAM = (0.25, 2.5), (0.5, 10.0)  # the ranges of the printed tables

QUANTITIES: Mapping[str, Callable[[TorsionLever], float]] = {
    "B1": lambda lever: lever.exact.B1,
    "B3": lambda lever: lever.exact.B3,
    "B1/B3": lambda lever: lever.exact.B1 / lever.exact.B3,
    "C1": lambda lever: lever.exact.C1,
    "C3": lambda lever: lever.exact.C3,
    "C1/C3": lambda lever: lever.exact.C1 / lever.exact.C3,
    "T": lambda lever: lever.exact.period,
    "T/T0": lambda lever: lever.exact.period / lever.T0,
    "zeta": lambda lever: lever.exact.zeta,
    "xi": lambda lever: lever.xi,
}


def find_torsion_levers(
    targets: Mapping[str, float],
    *,
    rho: float,
    nu: float,
    swing: NumberOrQuantity,
    beta: Span = BETA,
    lam: Span = LAM,
    least_transmission: NumberOrQuantity = LEAST_TRANSMISSION,
    most_rocker_swing: NumberOrQuantity = MOST_ROCKER_SWING,
) -> tuple[TorsionLever, ...]:
    """All levers whose exact motion has one constant, or two constants, of given values.

    Parameters
    ----------
    targets
        Values by name: B1, B3, B1/B3, C1, C3, C1/C3, T (in units of sqrt(I / c1)), T/T0, zeta, xi.
    rho, nu, swing
        As of `TorsionLever`.
    beta, lam
        A number, or the range in which it is sought: as many ranges as there are targets.
    least_transmission, most_rocker_swing
        Limits, as of `TorsionLever`.

    Returns
    -------
    The levers in the order of what is sought; at least one. With two targets, those that a search from several
    starts found.

    Raises
    ------
    InputError
        If a value is out of reach (the message states the reachable range), or the numbers of values and ranges differ.

    Examples
    --------
    >>> from math import radians
    >>> (lever,) = find_torsion_levers({"B1/B3": 0.99}, rho=0.15, nu=0.15, swing=radians(60), lam=1)
    >>> round(lever.beta, 6), round(lever.exact.B1 / lever.exact.B3, 9)
    (0.717435, 0.99)
    """
    for name, value in targets.items():
        check_names([name], QUANTITIES, "constant of the lever")
        finite(value, name)
    spans = {"beta": beta, "lam": lam}
    sought = {name: _span(name, span) for name, span in spans.items() if isinstance(span, tuple)}
    if len(sought) != len(targets):
        raise InputError(
            f"as many of beta and lam must be ranges as there are targets: {len(targets)} targets "
            f"({', '.join(targets) or 'none'}), {len(sought)} sought ({', '.join(sought) or 'none'})"
        )
    fixed = {name: span for name, span in spans.items() if not isinstance(span, tuple)}
    limits: dict[str, Any] = {"least_transmission": least_transmission, "most_rocker_swing": most_rocker_swing}
    make = partial(TorsionLever, rho=rho, nu=nu, swing=swing, **fixed, **limits)
    if len(targets) == 1:
        ((title, value),), ((name, span),) = targets.items(), sought.items()
        return along(make, name, span, title, value)
    return within(make, sought, {name: (QUANTITIES[name], value) for name, value in targets.items()})


def _span(name: str, span: tuple[float, ...]) -> tuple[float, float]:
    if len(span) != 2 or not 0.0 < finite(span[0], name) < finite(span[1], name):
        raise InputError(
            f"{name} must be a number above 0 or a range (least, greatest) of such numbers, got {shortened(span)}"
        )
    return float(span[0]), float(span[1])


Quantity = Callable[[TorsionLever], float]
Make = Callable[..., TorsionLever]

_TRIED, _TRIED_EACH = 33, 8  # samples along one length, and along each of two
_HALVINGS = 40
_STARTS = 4
_BAR = 1e3  # residual where there is no lever: far above any that a lever has


def along(make: Make, name: str, span: tuple[float, float], title: str, value: float) -> tuple[TorsionLever, ...]:
    """The levers whose constant has a value, in order of the length that is sought."""
    from scipy.optimize import brentq

    def constant(length: float) -> float:
        try:
            return QUANTITIES[title](make(**{name: length}))
        except OptlawsError:
            return float("nan")

    lengths, values = _samples(constant, span)
    if not len(lengths):
        middle = float(np.geomspace(*span, _TRIED)[_TRIED // 2])
        QUANTITIES[title](make(**{name: middle}))  # raises, and says which limit it is
    excess = values - value
    places = lengths[excess == 0.0].tolist()
    for i in np.flatnonzero(excess[:-1] * excess[1:] < 0.0):
        low, high = lengths[i : i + 2].tolist()
        places.append(float(brentq(lambda length: constant(length) - value, low, high, xtol=1e-14, rtol=1e-14)))
    if not places:
        low, high = int(np.argmin(values)), int(np.argmax(values))
        raise InputError(
            f"{title} = {value:.6g} is out of reach: for {name} from {lengths[0]:.5g} to {lengths[-1]:.5g}, "
            f"where all limits hold, it runs from {values[low]:.6g} (at {lengths[low]:.5g}) to {values[high]:.6g} "
            f"(at {lengths[high]:.5g}); change the other length, the swing or the pre-twists"
        )
    return tuple(make(**{name: length}) for length in sorted(places))


def _samples(constant: Callable[[float], float], span: tuple[float, float]) -> tuple[Array, Array]:
    """Lengths within all limits, up to the very limits, and the constant there."""
    lengths = np.geomspace(*span, _TRIED)
    values = np.array([constant(float(length)) for length in lengths])
    known = np.isfinite(values)
    changes = [lengths[[i, i + 1] if known[i] else [i + 1, i]] for i in np.flatnonzero(np.diff(known))]
    edges = [float(bisect(lambda length: isfinite(constant(length)), low, high, _HALVINGS)[0]) for low, high in changes]
    lengths = np.append(lengths[known], edges)
    values = np.append(values[known], [constant(edge) for edge in edges])
    order = np.argsort(lengths)
    return lengths[order], values[order]


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
    scale = np.maximum(np.ptp(reached, axis=0), _LINKAGE_MET)

    def miss(logs: Array) -> Array:
        return np.asarray(np.nan_to_num((values(logs) - targets) / scale, nan=_BAR))

    starts = grid[np.argsort(np.linalg.norm((reached - targets) / scale, axis=1), kind="stable")[:_STARTS]]
    ends = [least_squares(miss, start, bounds=(low, high), xtol=3e-16, ftol=3e-16, gtol=3e-16).x for start in starts]
    solved: list[Array] = []
    for end in ends:
        met = np.abs(miss(end)).max() <= _LINKAGE_MET
        if met and not any(np.abs(end - other).max() <= _SAME_LINKAGE for other in solved):
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
