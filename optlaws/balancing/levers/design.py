"""The inverse task: lengths of the torsion lever for wanted constants of its motion."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

from optlaws.balancing.levers.lever import TorsionLever
from optlaws.balancing.levers.limits import LEAST_TRANSMISSION, MOST_ROCKER_SWING
from optlaws.balancing.levers.search import LengthSearch, along, within
from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.numbers import NumberOrQuantity, finite
from optlaws.suggest import unknown_key

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
    """All levers whose exact motion has a constant of a given value, or two of them.

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
        If a value is out of reach (the message says what is within reach), or the numbers of values and ranges differ.

    Examples
    --------
    >>> from math import radians
    >>> (lever,) = find_torsion_levers({"B1/B3": 0.99}, rho=0.15, nu=0.15, swing=radians(60), lam=1)
    >>> round(lever.beta, 6), round(lever.exact.B1 / lever.exact.B3, 9)
    (0.717435, 0.99)
    """
    for name, value in targets.items():
        if name not in QUANTITIES:
            raise InputError(unknown_key(name, QUANTITIES, "wanted constant"))
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
        ((quantity, value),), ((name, span),) = targets.items(), sought.items()
        return along(LengthSearch(make, name, span, quantity, QUANTITIES[quantity]), value)
    return within(make, sought, {name: (QUANTITIES[name], value) for name, value in targets.items()})


def _span(name: str, span: tuple[float, ...]) -> tuple[float, float]:
    if len(span) != 2 or not 0.0 < finite(span[0], name) < finite(span[1], name):
        raise InputError(
            f"{name} must be a number above 0 or a range (least, greatest) of such numbers, got {shortened(span)}"
        )
    return float(span[0]), float(span[1])
